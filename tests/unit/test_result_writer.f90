!> Tests of the bytes of a result file, read back by stream access.
module test_result_writer
   use checks, only: check_list_t
   use checksum, only: checksum_of
   use byte_file, only: new_path, put_in_place
   use errors, only: error_t, exit_bad_input, exit_system
   use file_system, only: delete_file, path_exists
   use kinds, only: dp, int32, int64
   use result_reader, only: result_reader_t
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
      integer(int64) :: table_place, covered, sums(3), table(4)
      integer(int32) :: counts(2)
      character(8) :: table_magic
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
      ! Texts that end before, at and behind a multiple of 64 bytes: 128 + 2*48 bytes stand before them.
      do length = 0_int64, 64_int64, 8_int64
         call test_file(checks, long_text(:length))
      end do
      call test_file(checks, repeat('y', 31))
      call test_file(checks, repeat('y', 33))
      call test_chunks(checks)
      call test_places(checks)
      call test_failure(checks)
   end subroutine run_result_writer_tests

   !> Header, rows and count of a file with two columns, before and after it is closed.
   subroutine test_file(checks, text)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      character(*), intent(in) :: text             !> Resolved input

      real(dp), parameter :: rows(2, 3) = reshape([1.0_dp, 2.0_dp, 3.0_dp, 4.0_dp, 5.0_dp, 1.0e-300_dp], &
         [2, 3])
      real(dp), parameter :: extreme_rows(2, 2) = reshape([1.5_dp, 9.0_dp, 4.5_dp, -9.0_dp], [2, 2])
      type(result_writer_t) :: writer
      type(error_t), allocatable :: error
      type(content_t) :: content

      call writer%open(path, text, [character(16) :: 'time', 'film_thickness'], [character(4) :: 's', 'm'], 3_int64, .true., &
                       error)
      call checks%check(.not. allocated(error), 'open')
      if (allocated(error)) return
      call read_back(content)
      call checks%check(content%magic == 'RATTLE'//achar(13)//achar(10), 'magic')
      call checks%check(content%format_version == 2, 'format version')
      call checks%check(content%byte_order == 16909060, 'byte-order mark')
      call checks%check(content%column_count == 2, 'count of columns')
      call checks%check(content%text_bytes == len(text), 'bytes of the text')
      call checks%check(content%version == program_version, 'program version')
      call checks%check(content%columns(1) == 'time'//repeat(' ', 28)//'s', 'first column')
      call checks%check(content%columns(2) == 'film_thickness'//repeat(' ', 18)//'m', 'second column')
      call checks%check(content%text == text, 'text')
      call checks%check(modulo(content%header_bytes, 64_int64) == 0, 'rows start at a multiple of 64')
      call checks%check(content%table_place == ((224 + len(text) + 63)/64)*64, 'table at the next multiple of 64')
      call checks%check(content%header_bytes == content%table_place + 64, 'no more padding than needed')
      call checks%check(verify(content%padding, achar(0)) == 0, 'padding of zeros')
      call checks%check(content%table_magic == 'BLOCKTAB', 'magic of the table')
      call checks%check(all(content%table == [262144_int64, 1_int64, 3_int64, 0_int64]), 'table of one chunk')
      call checks%check(content%row_count == -1, 'unknown count while the file is open')
      call checks%check(content%file_bytes == content%header_bytes, 'an open file has its whole header')

      call writer%write_rows(rows(:, 1:2), error)
      call checks%check(.not. allocated(error), 'write two rows')
      call writer%write_rows(rows(:, 3:3), error)
      call checks%check(.not. allocated(error), 'write one more')
      call writer%write_extremes(extreme_rows)
      call writer%mark_coarse()
      call writer%close(error)
      call checks%check(.not. allocated(error), 'close')
      call read_back(content)
      call checks%check(content%row_count == 3, 'count of rows')
      call checks%check(content%file_bytes == content%header_bytes + 5*2*8, 'size of the file')
      call checks%check(size(content%rows, 2) == 5, 'rows read back')
      if (size(content%rows, 2) /= 5) return
      call checks%check(maxval(abs(content%rows(:, :3) - rows)) <= 0.0_dp, 'values of the rows')
      call checks%check(maxval(abs(content%rows(:, 4:) - extreme_rows)) <= 0.0_dp, 'extreme rows behind them')
      call checks%check(content%covered == 3_int64 .and. all(content%counts == [2, 1]), 'counts and flag of the seal')
      call checks%check(content%sums(1) == checksum_of(rows), 'checksum of the rows')
      call checks%check(content%sums(2) == checksum_of(extreme_rows), 'checksum of the extreme rows')
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
      content%table_place = ((128 + 48*count_ + content%text_bytes + 63)/64)*64
      allocate (character(content%table_place - 128 - 48*count_ - content%text_bytes) :: content%padding)
      read (unit, pos=81) content%covered, content%counts, content%sums
      read (unit, pos=129) content%columns
      read (unit, pos=129 + 48*count_) content%text
      if (len(content%padding) > 0) read (unit) content%padding
      read (unit) content%table_magic, content%table
      allocate (content%rows(count_, int(content%file_bytes - content%header_bytes)/(8*count_)))
      if (size(content%rows) > 0) read (unit, pos=content%header_bytes + 1) content%rows
      close (unit)
   end subroutine read_back

   !> Rows of several chunks are verified when they are read back; a damaged one is named with its place.
   subroutine test_chunks(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: count = 300, columns = 4096
      real(dp), allocatable :: rows(:, :)
      type(result_writer_t) :: writer
      type(result_reader_t) :: reader
      type(error_t), allocatable :: error
      character(32) :: names(columns)
      integer :: i, unit, first
      integer(int64) :: file_bytes

      ! Chunks of 128 rows, written in pieces that do not fit them.
      allocate (rows(columns, count))
      do i = 1, count
         rows(:, i) = sqrt(real(i, dp))
      end do
      rows(7, :) = -rows(7, :)
      do i = 1, columns
         write (names(i), '(a, i0)') 'column_', i
      end do
      call writer%open(path, 'x', names, spread('m', 1, columns), int(count, int64), .true., error)
      do first = 1, count, 77
         call writer%write_rows(rows(:, first:min(count, first + 76)), error)
      end do
      call writer%write_extremes(rows(:, :2))
      call writer%close(error)
      call checks%check(.not. allocated(error), 'chunks: written')
      call reader%open(path, error)
      call checks%check(.not. allocated(error), 'chunks: opened')
      call reader%verify_rows(int(count, int64), error)
      call checks%check(.not. allocated(error), 'chunks: sound')
      call reader%verify_rows(count + 1_int64, error)
      call checks%check(allocated(error), 'chunks: the extreme rows are none of the rows')
      if (allocated(error)) call checks%check(index(error%message, 'holds 300 rows, fewer than the 301') > 0, 'chunks: fewer rows')
      inquire (file=path, size=file_bytes)
      open (newunit=unit, file=path, access='stream', form='unformatted', action='write', status='old')
      ! The second number from the end of row 200.
      write (unit, pos=file_bytes - 8_int64*columns*(count + 2 - 200) - 15) 7.0_dp
      close (unit)
      call reader%verify_rows(128_int64, error)
      call checks%check(.not. allocated(error), 'chunks: the first is sound')
      call reader%verify_rows(129_int64, error)
      call checks%check(allocated(error), 'chunks: the second is not')
      if (allocated(error)) call checks%check(error%message == path//' is damaged: rows 129 to 256 are not what their '// &
                                              'checksum says' .and. error%exit_code == exit_bad_input, 'chunks: place of damage')
      call reader%close()
      call delete_file(path)
   end subroutine test_chunks

   !> Where a file stands, a new one is written beside it; where none stands, it is shown at once or not.
   subroutine test_places(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(result_writer_t) :: writer
      type(error_t), allocatable :: error
      real(dp), parameter :: row(1, 1) = 1.0_dp

      call writer%open(path, 'first', ['time'], ['s'], 1_int64, .false., error)
      call checks%check(stands(new_path(path), path), 'hidden: beside its place')
      call writer%write_rows(row, error)
      call writer%close(error)
      call checks%check(stands(new_path(path), path), 'hidden: still beside its place')
      call put_in_place(path, error)
      call checks%check(stands(path, new_path(path)), 'put in its place')
      call writer%open(path, 'second', ['time'], ['s'], 1_int64, .true., error)
      call writer%close(error)
      call checks%check(text_of(path) == 'first', 'what stands stays')
      call checks%check(text_of(new_path(path)) == 'second', 'the new one beside it')
      call put_in_place(path, error)
      call checks%check(text_of(path) == 'second', 'replaced in one step')
      call delete_file(path)
      call put_in_place(path, error)
      call checks%check(allocated(error), 'nothing to put in place')
   end subroutine test_places

   !> Whether one file stands, and another does not.
   logical function stands(one, other)
      character(*), intent(in) :: one
      character(*), intent(in) :: other
      logical :: other_stands

      other_stands = path_exists(other)
      stands = path_exists(one)
      stands = stands .and. .not. other_stands
   end function stands

   !> Input text of a result file.
   function text_of(name) result(text)
      character(*), intent(in) :: name
      character(:), allocatable :: text
      type(result_reader_t) :: reader
      type(error_t), allocatable :: error

      text = ''
      call reader%open(name, error)
      if (.not. allocated(error)) text = reader%input_text
      call reader%close()
   end function text_of

   !> A file that cannot be made is an error of the system, reported with its path.
   subroutine test_failure(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(result_writer_t) :: writer
      type(error_t), allocatable :: error

      call writer%open('no_such_folder_here/x.rattle', '', ['time'], ['s'], 1_int64, .true., error)
      call checks%check(allocated(error), 'no folder: an error')
      if (.not. allocated(error)) return
      call checks%check(error%exit_code == exit_system, 'no folder: exit code')
      call checks%check(index(error%message, 'no_such_folder_here/x.rattle') == 1, &
         'no folder: the path is reported')
   end subroutine test_failure

end module test_result_writer
