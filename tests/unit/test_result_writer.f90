!> Tests of the bytes of a result file, read back by stream access.
module test_result_writer
   use checks, only: check_list_t
   use errors, only: error_t, exit_system
   use file_system, only: delete_file
   use kinds, only: dp, int32, int64
   use result_writer, only: result_writer_t
   use version, only: program_version
   implicit none(type, external)
   private

   character(*), parameter :: path = 'unit_test_result.tmp'

   !> What stands in a file.
   type :: content_t
      character(8) :: magic
      integer(int32) :: format_version, byte_order, column_count, text_bytes
      integer(int64) :: header_bytes, row_count, file_bytes
      character(24) :: version
      character(48), allocatable :: columns(:)
      character(:), allocatable :: text
      character(:), allocatable :: padding
      real(dp), allocatable :: rows(:, :)
   end type content_t

   public :: run_result_writer_tests

contains

   !> Runs every test of this topic.
   subroutine run_result_writer_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      character(*), parameter :: long_text = repeat('&', 64)
      integer(int64) :: length

      call checks%start('result_writer')
      ! Texts that end before, at and behind a multiple of 64 bytes: 64 + 2*48 bytes stand before them.
      do length = 0_int64, 64_int64, 8_int64
         call test_file(checks, long_text(:length))
      end do
      call test_file(checks, repeat('y', 31))
      call test_file(checks, repeat('y', 33))
      call test_failure(checks)
   end subroutine run_result_writer_tests

   !> Header, rows and count of a file with two columns, before and after it is closed.
   subroutine test_file(checks, text)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      character(*), intent(in) :: text             !> Resolved input

      real(dp), parameter :: rows(2, 3) = reshape([1.0_dp, 2.0_dp, 3.0_dp, 4.0_dp, 5.0_dp, 1.0e-300_dp], &
         [2, 3])
      type(result_writer_t) :: writer
      type(error_t), allocatable :: error
      type(content_t) :: content

      call writer%open(path, text, [character(16) :: 'time', 'film_thickness'], [character(4) :: 's', 'm'], &
         error)
      call checks%check(.not. allocated(error), 'open')
      if (allocated(error)) return
      call read_back(content)
      call checks%check(content%magic == 'RATTLE'//achar(13)//achar(10), 'magic')
      call checks%check(content%format_version == 1, 'format version')
      call checks%check(content%byte_order == 16909060, 'byte-order mark')
      call checks%check(content%column_count == 2, 'count of columns')
      call checks%check(content%text_bytes == len(text), 'bytes of the text')
      call checks%check(content%version == program_version, 'program version')
      call checks%check(content%columns(1) == 'time'//repeat(' ', 28)//'s', 'first column')
      call checks%check(content%columns(2) == 'film_thickness'//repeat(' ', 18)//'m', 'second column')
      call checks%check(content%text == text, 'text')
      call checks%check(modulo(content%header_bytes, 64_int64) == 0, 'rows start at a multiple of 64')
      call checks%check(int(content%header_bytes) >= 160 + len(text) .and. int(content%header_bytes) < 224 &
         + len(text), &
         'no more padding than needed')
      call checks%check(verify(content%padding, achar(0)) == 0, 'padding of zeros')
      call checks%check(content%row_count == -1, 'unknown count while the file is open')
      call checks%check(content%file_bytes == content%header_bytes, 'an open file has its whole header')

      call writer%write_rows(rows(:, 1:2), error)
      call checks%check(.not. allocated(error), 'write two rows')
      call writer%write_rows(rows(:, 3:3), error)
      call checks%check(.not. allocated(error), 'write one more')
      call writer%close(error)
      call checks%check(.not. allocated(error), 'close')
      call read_back(content)
      call checks%check(content%row_count == 3, 'count of rows')
      call checks%check(content%file_bytes == content%header_bytes + 3*2*8, 'size of the file')
      call checks%check(size(content%rows, 2) == 3, 'rows read back')
      if (size(content%rows, 2) == 3) call checks%check(maxval(abs(content%rows - rows)) <= 0.0_dp, &
         'values of the rows')
      call writer%close(error)
      call checks%check(.not. allocated(error), 'closing twice does nothing')
      call delete_file(path)
   end subroutine test_file

   !> Read the file at the documented places.
   subroutine read_back(content)
      type(content_t), intent(out) :: content  !> What stands in it

      integer :: unit, count_

      open (newunit=unit, file=path, access='stream', form='unformatted', action='read', status='old')
      inquire (unit, size=content%file_bytes)
      read (unit, pos=1) content%magic
      read (unit, pos=9) content%format_version
      read (unit, pos=13) content%byte_order
      read (unit, pos=17) content%header_bytes
      read (unit, pos=25) content%row_count
      read (unit, pos=33) content%column_count
      read (unit, pos=37) content%text_bytes
      read (unit, pos=41) content%version
      count_ = int(content%column_count)
      allocate (content%columns(count_))
      allocate (character(int(content%text_bytes)) :: content%text)
      allocate (character(int(content%header_bytes) - 64 - 48*count_ &
         - int(content%text_bytes)) :: content%padding)
      read (unit, pos=65) content%columns
      read (unit, pos=65 + 48*count_) content%text
      if (len(content%padding) > 0) read (unit) content%padding
      allocate (content%rows(count_, int(content%file_bytes - content%header_bytes)/(8*count_)))
      if (size(content%rows) > 0) read (unit, pos=content%header_bytes + 1) content%rows
      close (unit)
   end subroutine read_back

   !> A file that cannot be made is an error of the system, told with its path.
   subroutine test_failure(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(result_writer_t) :: writer
      type(error_t), allocatable :: error

      call writer%open('no_such_folder_here/x.rattle', '', ['time'], ['s'], error)
      call checks%check(allocated(error), 'no folder: an error')
      if (.not. allocated(error)) return
      call checks%check(error%exit_code == exit_system, 'no folder: exit code')
      call checks%check(index(error%message, 'no_such_folder_here/x.rattle') == 1, &
         'no folder: the path is told')
   end subroutine test_failure

end module test_result_writer
