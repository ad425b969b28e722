!> Tests of the reading of a recorded signal: what is taken, and every fault with its line, which quotes nothing of the file.
module test_csv_signal
   use checks, only: check_list_t
   use csv_signal, only: read_csv_signal, recording_t
   use errors, only: fault_list_t
   use file_system, only: delete_file
   use kinds, only: dp
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
      call test_dialects(checks)
      call test_jitter(checks)
      call test_columns(checks)
      call test_faults(checks)
      call test_foreign_files(checks)
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
      call take(checks, lines('"t","force"', '"0","1"', '"1","3"', '"2","2"', '"3","0"'), '', 'force', 'numbers in quotes')
      call take(checks, lines('time,angle,force', '0,0,1', '1,9,3', '2,10,2', '3,12,0'), '', 'force', 'two axes')
      call take(checks, lines('time,time_lag', '0,1', '1,3', '2,2', '3,0'), 'time_lag', 'time_lag', 'a signal called a time')
      call take(checks, lines('a,b', '9,1', '9,3', '9,2', '9,0'), 'b', 'b', 'a column of several')
      call take(checks, lines('time,force', '0,1', '0.033,3', '0.067,2', '0.1,0'), '', 'force', 'times that were rounded')
   end subroutine test_sound_files

   !> Semicolons separate, decimal commas with them, and a row below the heads holds units.
   subroutine test_dialects(checks)
      type(check_list_t), intent(inout) :: checks

      call take(checks, lines('time;force', '0;1', '1;3', '2;2', '3;0'), '', 'force', 'semicolons')
      call take(checks, lines('# a, comment', 'time;force', '0,0;1,0', '0,5;3,0', '1,0;2,0', '1,5;0,0'), '', 'force', &
                'decimal commas')
      call take(checks, lines('"time";"force"', '"0,0";"1,0"', '"0,5";"3,0"', '"1,0";"2,0"', '"1,5";"0,0"'), '', 'force', &
                'quoted decimal commas')
      call take(checks, lines('time,"force, left"', '0,1', '1,3', '2,2', '3,0'), '', 'force, left', 'a comma in quotes')
      call take(checks, lines('time,force', 's,N', '0,1', '1,3', '2,2', '3,0'), '', 'force', 'a row of units')
      call take(checks, lines('X,Y', '[ms],[kN]', '0,0.001', '1,0.003', '2,0.002', '3,0'), '', 'Y', 'units in brackets')
      call take(checks, lines('time_ms,force_kN', '0,1e-3', '1,3e-3', '2,2e-3', '3,0'), '', 'force_kN', 'units in names')
      call take(checks, lines('F / kN', '1e-3', '3e-3', '2e-3', '0')//achar(26), '', 'F / kN', 'an end of file of old')
      call take(checks, lines('force_min', '1', '3', '2', '0'), '', 'force_min', 'an ending that is no unit')
      call refuse(checks, lines('torque_Nm', '1', '3', '2', '0'), '', ':1: column 1: it is in N m; N is needed')
      call refuse(checks, lines('load_V', '1', '3', '2', '0'), '', ':1: column 1: it is in V; N is needed')
      call refuse(checks, lines('force [kips]', '1', '3', '2', '0'), '', ':1: column 1: its unit is not known; N is needed')
      call refuse(checks, lines('force_kN', 'N', '1', '3', '2', '0'), '', ':1: column 1: its unit is not known')
   end subroutine test_dialects

   !> A tenth of a step is no fault of an axis, a gap is one.
   subroutine test_jitter(checks)
      type(check_list_t), intent(inout) :: checks
      type(fault_list_t) :: faults
      type(recording_t) :: recording

      call write_file(lines('time,force', '0.00,1', '1.07,3', '1.94,2', '3.02,0', '3.97,1', '5.00,3'))
      call read_csv_signal(path, '', 'N', '', recording, faults)
      ! The straight line through these has the slope 17.39/17.5; 1.94 is 0.063143 off it.
      call checks%check(faults%count() == 0 .and. abs(recording%step - 17.39_dp/17.5_dp) < 1.0e-12_dp, 'jitter is taken')
      call checks%check(abs(recording%jitter - 0.063543_dp) < 1.0e-5_dp, 'its size')
      call refuse(checks, lines('time,force', '0.00,1', '1.30,3', '1.94,2', '3.02,0', '3.97,1', '5.00,3'), '', &
                  ':4: the samples are not uniform: after 1.300000 comes 1.94')
   end subroutine test_jitter

   !> Which column is meant.
   subroutine test_columns(checks)
      type(check_list_t), intent(inout) :: checks

      call refuse(checks, lines('time,a,b', '0,1,2'), '', ':1: signal_column must name one of its columns: time, a, b')
      call refuse(checks, lines('# head', 'time,a', '0,1'), 'c', ":2: there is no column 'c'; its columns are time, a")
      call refuse(checks, lines('a,a', '0,1'), 'a', ":1: two columns are named 'a'")
      call refuse(checks, lines('0,1', '1,2'), '', ':1: the first line holds numbers; it must name the columns')
   end subroutine test_columns

   !> Files that are no signal.
   subroutine test_faults(checks)
      type(check_list_t), intent(inout) :: checks

      call refuse(checks, '', '', 'the file is empty')
      call refuse(checks, lines('# nothing', '', '# else'), '', 'the file is empty')
      call refuse(checks, lines('force', '1', '2', '3'), '', 'it has 3 samples; a cycle needs at least 4')
      call refuse(checks, lines('force', '1', 'two', '3', '1'), '', ":3: column 1: this is not a number")
      call refuse(checks, lines('force', '1', 'nan', '3', '1'), '', ":3: column 1: this is not a number")
      call refuse(checks, lines('time,force', '0,1', '1,', '2,3', '3,1'), '', ":3: column 2: a number is missing")
      call refuse(checks, lines('time,force', '0,1', '1,3', '2', '3,1'), '', ':4: the line has 1 columns, the header 2')
      call refuse(checks, lines('time,force', '0,1', '1,3', '2,2', '4,0'), '', ':5: the samples are not uniform (or the axis')
      call refuse(checks, lines('time,force', '3,1', '2,3', '1,2', '0,0'), '', ':3: the axis descends: after 3.0')
   end subroutine test_faults

   !> Of a file that is no table of numbers nothing is reported; one cause has one fault.
   subroutine test_foreign_files(checks)
      type(check_list_t), intent(inout) :: checks
      character(*), parameter :: tab = achar(9), decimal_comma = ': decimal commas are read only where semicolons'

      call refuse(checks, lines('root:x:0', 'daemon:x:1'), '', ':2: column 1: this is not a number')
      call refuse(checks, lines('user,word', 'bob,secret', 'eve,more'), 'c', &
                  ":1: there is no column 'c'; its columns are which are not known")
      call refuse(checks, lines('user,word', 'bob,secret'), '', &
                  ':1: signal_column must name one of its columns: which are not known')
      call refuse(checks, lines('time,force', '0;1', '1;3', '2;2', '3;0'), '', &
                  ':2: the line has 1 columns, the header 2: semicolons')
      call refuse(checks, lines('force', '1;', '3;', '2;', '0;'), '', ':2: semicolons separate the columns')
      call refuse(checks, lines('time'//tab//'force', '0'//tab//'1'), '', ':1: tabs separate the columns')
      call refuse(checks, lines('time,force', '0,017', '1,017,2', '2,1'), '', ':3: the line has 3 columns, the header 2'// &
                  decimal_comma)
      call refuse(checks, lines('time,force', '"0,0","1,5"', '"1,0","2,5"', '"2,0","1,5"'), '', decimal_comma)
      call refuse(checks, lines('force', '0,017', '1,5', '2,5', '3,5'), '', decimal_comma)
      call refuse(checks, lines('time,force', 'old,new', '0,1', '1,3', '2,1', '3,0'), 'force', &
                  ':2: column 2: this is not a number; below the names')
   call refuse(checks, lines('time,force', 's,N', 's,N', '0,1', '1,3', '2,1', '3,0'), 'force', ':3: column 2: this is not a number')
      call refuse(checks, lines('time;force', '0;1,5', '1;3', '2;2.5', '3;0'), '', ':4: some numbers have a decimal point')
      call refuse(checks, lines('time;force', '0;1.234,5', '1;3', '2;2', '3;0'), '', ':2: column 2: this is not a number')
      call refuse(checks, 'force'//achar(13)//'1'//achar(13)//'2', '', ':1: carriage returns alone')
      call refuse(checks, 'f'//achar(0)//'o'//achar(0), '', ':1: it is not plain text')
      call refuse(checks, lines('time,force', '0,1', '1,3', '2,2', '1,0'), '', ':5: the axis descends: after 2.0')
      call refuse(checks, lines('time,force', '0,1', '1e31,3', '2e31,2', '3e31,0'), '', 'that is no axis')
      call accept(checks, lines('"force; left","t"', '1,0', '3,1', '2,2', '0,3'), 'a semicolon in a name')
      call accept(checks, lines('time,force,', '0,1,', '1,3,', '2,2,', '3,1,'), 'a comma at the end of every line')
   end subroutine test_foreign_files

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
      type(recording_t) :: recording

      call write_file(content)
      call read_csv_signal(path, column, 'N', '', recording, faults)
      call checks%check(faults%count() == 0 .and. recording%column == expected .and. size(recording%samples) == 4, 'taken: '//what)
      if (size(recording%samples) /= 4) return
      call checks%check(all(abs(recording%samples - [1.0_dp, 3.0_dp, 2.0_dp, 0.0_dp]) <= 0.0_dp), 'its samples: '//what)
   end subroutine take

   !> Whether a file is taken.
   subroutine accept(checks, content, what)
      type(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: content
      character(*), intent(in) :: what
      type(fault_list_t) :: faults
      type(recording_t) :: recording

      call write_file(content)
      call read_csv_signal(path, '', 'N', '', recording, faults)
      call checks%check(faults%count() == 0, 'taken: '//what)
   end subroutine accept

   !> Whether a file has one fault with these words; none is written for empty content at the end.
   subroutine refuse(checks, content, column, words)
      type(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: content
      character(*), intent(in) :: column
      character(*), intent(in) :: words
      type(fault_list_t) :: faults
      type(recording_t) :: recording
      character(:), allocatable :: found

      if (words /= 'there is no such file') call write_file(content)
      call read_csv_signal(path, column, 'N', '', recording, faults)
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
