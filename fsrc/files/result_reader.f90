!> Reads result files that this program wrote, see result_format.
module result_reader
   use byte_file, only: new_path
   use checksum, only: checksum_of, checksum_t
   use errors, only: error_t, exit_bad_input, raise
   use file_system, only: path_exists
   use kinds, only: dp, int64
   use random_access_file, only: random_access_file_t
   use result_format, only: column_name_bytes, series_table_magic
   use result_header, only: read_result_header, result_header_t
   use signals, only: must_stop
   use text, only: integer_text
   use version, only: program_version
   implicit none(type, external)
   private

   !> Rows that are verified at once.
   integer(int64), parameter :: block_rows = 4096_int64

   !> An open result file.
   type, public :: result_reader_t
      !> Resolved input as namelist text
      character(:), allocatable :: input_text
      integer :: columns = 0
      !> Rows of a closed file
      integer(int64) :: row_count = 0_int64
      !> Checksum of the CSV file that the rows follow from; 0: none
      integer(int64) :: source_checksum = 0_int64
      !> Names of the columns
      character(column_name_bytes), allocatable :: names(:)
      !> Whether another version of the program wrote it, and which
      logical :: from_another_version = .false.
      character(:), allocatable :: version
      type(result_header_t), private :: header
      type(random_access_file_t), private :: file
      character(:), allocatable, private :: path
   contains
      procedure :: open => open_result
      procedure :: verify_rows
      procedure :: read_rows
      procedure :: close => close_result
   end type result_reader_t

   public :: checksum_of_new_result

contains

   !> Open a file and read its header.
   subroutine open_result(self, path, error)
      class(result_reader_t), intent(inout) :: self
      character(*), intent(in) :: path
      !> Set if it is no result file of this format, or its header is damaged
      type(error_t), allocatable, intent(out) :: error

      self%path = path
      call self%file%open_to_read(path, error)
      if (allocated(error)) then
         error%exit_code = exit_bad_input
         return
      end if
      call read_result_header(self%file, path, self%header, error)
      if (allocated(error)) return
      if (self%header%table_magic /= series_table_magic) then
         call raise(error, exit_bad_input, path//' is the result of a campaign')
         return
      end if
      self%columns = size(self%header%names)
      self%row_count = self%header%row_count
      self%source_checksum = self%header%source_checksum
      self%names = self%header%names
      self%input_text = self%header%input_text
      self%version = trim(self%header%version)
      self%from_another_version = self%header%version /= program_version
   end subroutine open_result

   !> See that the first rows are what their checksums say. A chunk is verified as a whole. Where the work must stop, not all
   !> of them are looked at.
   subroutine verify_rows(self, count, error)
      class(result_reader_t), intent(in) :: self
      !> Rows that are needed
      integer(int64), intent(in) :: count
      !> Set if they are not, or if there are fewer
      type(error_t), allocatable, intent(out) :: error
      type(checksum_t) :: found
      real(dp), allocatable :: rows(:, :)
      integer(int64) :: chunk, first, last, start, part, stored(1)
      logical :: sound

      associate (header => self%header)
         if (header%seal%rows < count) then
            call raise(error, exit_bad_input, self%path//' holds '//integer_text(header%seal%rows)//' rows, fewer than the '// &
                       integer_text(count)//' that are needed')
            return
         end if
         allocate (rows(self%columns, block_rows))
         do chunk = 1_int64, (count - 1_int64)/header%chunk_rows + 1_int64
            if (must_stop()) return
            first = (chunk - 1_int64)*header%chunk_rows + 1_int64
            last = min(first + header%chunk_rows - 1_int64, header%seal%rows)
            stored = header%seal%rest_checksum
            sound = .true.
            if (last - first + 1_int64 == header%chunk_rows) call header%read_checksums(self%file, chunk, stored, sound)
            found = checksum_t()
            do start = first, last, block_rows
               part = min(block_rows, last - start + 1_int64)
               if (sound) call self%file%read_at(header%row_place(start), rows(:, :part), sound)
               if (sound) call found%add(rows(:, :part))
            end do
            if (sound) sound = found%value() == stored(1)
            if (sound) cycle
            call raise(error, exit_bad_input, self%path//' is damaged: rows '//integer_text(first)//' to '// &
                       integer_text(last)//' are not what their checksum says')
            return
         end do
      end associate
   end subroutine verify_rows

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

      call self%file%read_at(self%header%row_place(first), rows, complete)
      if (.not. complete) call raise(error, exit_bad_input, self%path//' ends before its rows do')
   end subroutine read_rows

   !> Close the file.
   subroutine close_result(self)
      class(result_reader_t), intent(inout) :: self
      type(error_t), allocatable :: ignored

      call self%file%close(ignored)
   end subroutine close_result

   !> The checksum that binds a summary to its result, 0 if none can be read: that of all bytes before the first row, among which
   !> stand the checksums of the rows. So it knows every byte of the file, and is had without reading the rows.
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

end module result_reader
