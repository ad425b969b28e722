!> Tests of the reading of a cycle of a signal: what is taken, and every fault with its line.
module test_csv_signal
   use checks, only: check_list_t
   use constants, only: two_pi
   use csv_signal, only: read_csv_signal
   use errors, only: fault_list_t
   use file_system, only: delete_file
   use kinds, only: dp
   use text, only: real_text
   implicit none(type, external)
   private

   character(*), parameter :: path = 'unit_test_signal.tmp', line_feed = achar(10), both_ends = achar(13)//achar(10)

   public :: run_csv_signal_tests

contains

   !> Runs every test of this topic.
   subroutine run_csv_signal_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks

      call checks%start('csv_signal')
      call test_sound_files(checks)
      call test_columns(checks)
      call test_faults(checks)
      call test_cycles(checks)
      call delete_file(path)
      call refuse(checks, '', '', 'there is no such file')
   end subroutine run_csv_signal_tests

   !> Comments, empty lines, quotes and ends of lines of both kinds.
   subroutine test_sound_files(checks)
      type(check_list_t), intent(inout) :: checks

      call take(checks, lines('force', '1', '3', '2', '0'), '', 'force', 'one column')
      call take(checks, lines('# from, a bench', '', 'time,force', '0,1', '# here', '1,3', '2,2', '', '3,0'), '', 'force', &
                'comments and empty lines')
      call take(checks, '"Time [s]", "force"'//both_ends//'0, 1'//both_ends//'0.1,3'//both_ends//'0.2,2'//both_ends//'0.3,0', '', &
                'force', 'quotes, blanks, both ends and none')
      call take(checks, lines('t,a,b', '0,9,1', '1,x,3', '2,,2', '3,9,0'), 'b', 'b', 'a column beside one of words')
      call take(checks, lines('a,b', '9,1', '9,3', '9,2', '9,0'), 'b', 'b', 'a column of several')
      call take(checks, lines('time,force', '0,1', '0.033,3', '0.067,2', '0.1,0'), '', 'force', 'times that were rounded')
   end subroutine test_sound_files

   !> Which column is meant.
   subroutine test_columns(checks)
      type(check_list_t), intent(inout) :: checks

      call refuse(checks, lines('time,a,b', '0,1,2'), '', ':1: signal_column must name one of its columns: time, a, b')
      call refuse(checks, lines('# head', 'time,a', '0,1'), 'c', ":2: there is no column 'c'; its columns are time, a")
      call refuse(checks, lines('a,a', '0,1'), 'a', ":1: two columns are named 'a'")
      call refuse(checks, lines('0,1', '1,2'), '', ":1: '0' is a number; the first line must name the columns")
   end subroutine test_columns

   !> Files that are no signal.
   subroutine test_faults(checks)
      type(check_list_t), intent(inout) :: checks

      call refuse(checks, '', '', 'the file is empty')
      call refuse(checks, lines('# nothing', '', '# else'), '', 'the file is empty')
      call refuse(checks, lines('force', '1', '2', '3'), '', 'it has 3 samples; a cycle needs at least 4')
      call refuse(checks, lines('force', '1', 'two', '3', '1'), '', ":3: column 'force': 'two' is not a number")
      call refuse(checks, lines('force', '1', 'nan', '3', '1'), '', ":3: column 'force': 'nan' is not a number")
      call refuse(checks, lines('time,force', '0,1', '1,', '2,3', '3,1'), '', ":3: column 'force': a number is missing")
      call refuse(checks, lines('time,force', '0,1', '1,3', '2', '3,1'), '', ':4: the line has 1 columns, the header 2')
      call refuse(checks, lines('time,force', '0,1', '1,3', '2,2', '4,0'), '', ':3: the samples are not uniform: after 0 comes 1')
      call refuse(checks, lines('time,force', '3,1', '2,3', '1,2', '0,0'), '', ':3: the samples are not uniform')
      call refuse(checks, lines('force', '7', '7', '7', '7'), '', ':5: all samples are 7')
   end subroutine test_faults

   !> Cycles that repeat their first sample or jump at their end, and some that only look so.
   subroutine test_cycles(checks)
      type(check_list_t), intent(inout) :: checks
      integer :: n

      do n = 8, 100, 23
         call accept(checks, wave(n, 0, 0.0_dp, 0.0_dp), 'a cosine')
         call accept(checks, wave(n, 0, 0.5_dp, 0.0_dp), 'a cosine whose ends are alike by symmetry')
         call accept(checks, wave(n, 0, 0.3_dp, 0.0_dp), 'a cosine between')
         call refuse(checks, wave(n, 1, 0.0_dp, 0.0_dp), '', 'the last sample repeats the first')
         call refuse(checks, wave(n, 1, 0.3_dp*real(n, dp), 0.0_dp), '', 'the last sample repeats the first')
      end do
      call refuse(checks, wave(100, 0, 0.0_dp, 1.0_dp), '', ':101: the cycle does not close')
      call accept(checks, lines('force', '0', '0', '0', '1', '1', '1'), 'a rectangle')
      call accept(checks, lines('force', '0', '0', '5', '0', '0', '0'), 'a pulse')
   end subroutine test_cycles

   !> A cosine of n samples and some more, that begins behind its crest, with a drift in its cycle.
   function wave(n, more, shift, drift) result(content)
      integer, intent(in) :: n
      integer, intent(in) :: more
      !> [samples]
      real(dp), intent(in) :: shift
      real(dp), intent(in) :: drift
      character(:), allocatable :: content
      integer :: i

      content = 'force'//line_feed
      do i = 0, n + more - 1
         content = content//real_text(cos(two_pi*(real(i, dp) + shift)/real(n, dp)) + drift*real(i, dp)/real(n, dp))//line_feed
      end do
   end function wave

   !> Lines of a file.
   pure function lines(a, b, c, d, e, f, g, h, i) result(content)
      character(*), intent(in) :: a, b
      character(*), intent(in), optional :: c, d, e, f, g, h, i
      character(:), allocatable :: content

      content = a//line_feed//b//line_feed
      if (present(c)) content = content//c//line_feed
      if (present(d)) content = content//d//line_feed
      if (present(e)) content = content//e//line_feed
      if (present(f)) content = content//f//line_feed
      if (present(g)) content = content//g//line_feed
      if (present(h)) content = content//h//line_feed
      if (present(i)) content = content//i//line_feed
   end function lines

   !> Whether the samples of a file are 1, 3, 2, 0.
   subroutine take(checks, content, column, expected, what)
      type(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: content
      character(*), intent(in) :: column
      character(*), intent(in) :: expected
      character(*), intent(in) :: what
      type(fault_list_t) :: faults
      character(:), allocatable :: name
      real(dp), allocatable :: samples(:)

      call write_file(content)
      call read_csv_signal(path, column, name, samples, faults)
      call checks%check(faults%count() == 0 .and. name == expected .and. size(samples) == 4, 'taken: '//what)
      if (size(samples) /= 4) return
      call checks%check(all(abs(samples - [1.0_dp, 3.0_dp, 2.0_dp, 0.0_dp]) <= 0.0_dp), 'its samples: '//what)
   end subroutine take

   !> Whether a file is taken.
   subroutine accept(checks, content, what)
      type(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: content
      character(*), intent(in) :: what
      type(fault_list_t) :: faults
      character(:), allocatable :: name
      real(dp), allocatable :: samples(:)

      call write_file(content)
      call read_csv_signal(path, '', name, samples, faults)
      call checks%check(faults%count() == 0, 'taken: '//what)
   end subroutine accept

   !> Whether a file has one fault with these words; none is written for empty content at the end.
   subroutine refuse(checks, content, column, words)
      type(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: content
      character(*), intent(in) :: column
      character(*), intent(in) :: words
      type(fault_list_t) :: faults
      character(:), allocatable :: name, found
      real(dp), allocatable :: samples(:)

      if (words /= 'there is no such file') call write_file(content)
      call read_csv_signal(path, column, name, samples, faults)
      found = 'no fault'
      if (faults%count() > 0) found = faults%sentence(1)
      call checks%check(faults%count() == 1 .and. index(found, path) == 1 .and. index(found, words) > 0, &
                        'refused: '//words//'; found: '//found)
   end subroutine refuse

   subroutine write_file(content)
      character(*), intent(in) :: content
      integer :: unit

      open (newunit=unit, file=path, access='stream', form='unformatted', status='replace', action='write')
      write (unit) content
      close (unit)
   end subroutine write_file

end module test_csv_signal
