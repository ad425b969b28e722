!> Reads result files that this program wrote, see result_format.
module result_reader
   use errors, only: error_t, exit_bad_input, raise
   use kinds, only: dp, int64
   use random_access_file, only: random_access_file_t
   use result_format, only: column_name_bytes
   use result_header, only: read_result_header, result_header_t
   implicit none(type, external)
   private

   !> An open result file.
   type, public :: result_reader_t
      !> Resolved input as namelist text
      character(:), allocatable :: input_text
      integer :: columns = 0
      !> Names of the columns
      character(column_name_bytes), allocatable :: names(:)
      integer(int64), private :: header_bytes = 0_int64
      type(random_access_file_t), private :: file
      character(:), allocatable, private :: path
   contains
      procedure :: open => open_result
      procedure :: read_rows
      procedure :: close => close_result
   end type result_reader_t

contains

   !> Open a file and read its header.
   subroutine open_result(self, path, error)
      class(result_reader_t), intent(inout) :: self
      !> Path of the file
      character(*), intent(in) :: path
      !> Set if it is no result file of this format
      type(error_t), allocatable, intent(out) :: error
      type(result_header_t) :: header

      self%path = path
      call self%file%open_to_read(path, error)
      if (allocated(error)) then
         error%exit_code = exit_bad_input
         return
      end if
      call read_result_header(self%file, path, header, error)
      if (allocated(error)) return
      self%columns = size(header%names)
      self%header_bytes = header%header_bytes
      call move_alloc(header%names, self%names)
      call move_alloc(header%input_text, self%input_text)
   end subroutine open_result

   !> Read consecutive rows.
   subroutine read_rows(self, first, rows, error)
      class(result_reader_t), intent(in) :: self
      !> First row, counted from 1
      integer(int64), intent(in) :: first
      !> One column of this array is one row of the file
      real(dp), contiguous, intent(out) :: rows(:, :)
      !> Set if the file ends before
      type(error_t), allocatable, intent(out) :: error
      logical :: complete

      call self%file%read_at(self%header_bytes + (first - 1_int64)*8_int64*int(self%columns, int64), rows, complete)
      if (.not. complete) call raise(error, exit_bad_input, self%path//' ends before its rows do')
   end subroutine read_rows

   !> Close the file.
   subroutine close_result(self)
      class(result_reader_t), intent(inout) :: self
      type(error_t), allocatable :: ignored

      call self%file%close(ignored)
   end subroutine close_result

end module result_reader
