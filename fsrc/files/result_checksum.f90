!> The checksum that binds a summary to its result: that of all bytes before the first row, among which stand the checksums of
!> the rows. So it knows every byte of the file, and is had without reading the rows.
module result_checksum
   use byte_file, only: new_path
   use checksum, only: checksum_of
   use errors, only: error_t
   use file_system, only: path_exists
   use kinds, only: int64
   use random_access_file, only: random_access_file_t
   use result_header, only: read_result_header, result_header_t
   implicit none(type, external)
   private

   public :: checksum_of_new_result

contains

   !> Checksum of a result file, 0 if none can be read.
   integer(int64) function checksum_of_result(path) result(sum_of_head)
      character(*), intent(in) :: path
      type(random_access_file_t) :: file
      type(result_header_t) :: header
      type(error_t), allocatable :: error, ignored
      character(:), allocatable :: head
      logical :: complete

      sum_of_head = 0_int64
      call file%open_to_read(path, error)
      if (allocated(error)) return
      call read_result_header(file, path, header, error)
      if (.not. allocated(error)) then
         allocate (character(header%header_bytes) :: head)
         call file%read_at(0_int64, head, complete)
         if (complete) sum_of_head = checksum_of(head)
      end if
      call file%close(ignored)
   end function checksum_of_result

   !> Checksum of the result that this run has written, beside its place or there; 0 if none can be read.
   integer(int64) function checksum_of_new_result(path) result(sum_of_head)
      !> Its place
      character(*), intent(in) :: path
      logical :: is_beside

      is_beside = path_exists(new_path(path))
      if (is_beside) then
         sum_of_head = checksum_of_result(new_path(path))
      else
         sum_of_head = checksum_of_result(path)
      end if
   end function checksum_of_new_result

end module result_checksum
