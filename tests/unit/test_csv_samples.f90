!> Tests of the reading of CSV files: what is taken, and every fault with its line and column.
module test_csv_samples
   use checks, only: check_list_t
   use csv_samples, only: csv_samples_t, read_csv_samples
   use errors, only: fault_list_t
   use file_system, only: delete_file
   use key_table, only: find_key
   use kinds, only: dp
   use number_text, only: read_strict_integer, read_strict_real
   use text, only: real_text
   implicit none(type, external)
   private

   character(*), parameter :: path = 'unit_test_samples.tmp'
   character(*), parameter :: line_feed = achar(10), both_ends = achar(13)//achar(10)

   public :: run_csv_samples_tests

contains

   !> Runs every test of this topic.
   subroutine run_csv_samples_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks

      call checks%start('number_text')
      call test_numbers(checks)
      call checks%start('csv_samples')
      call test_sound_files(checks)
      call test_large_file(checks)
      call test_headers(checks)
      call test_rows(checks)
      call delete_file(path)
      call refuse(checks, '', 'there is no such file')
   end subroutine run_csv_samples_tests

   !> The same bits as the runtime reads, for numbers that take the short way and others.
   subroutine test_numbers(checks)
      type(check_list_t), intent(inout) :: checks
      character(*), parameter :: good(18) = [character(26) :: '1', '-1.5', '+.5', '5.', '1e3', '1.0E-22', &
                                             '123456789012345e22', &
                                             '0.1', '2.2250738585072014e-300', '1.7976931348623157e306', &
                                                '0.30000000000000004', &
                                             '9007199254740993', '-0.0', '0e99', '0000001.50', '1d-3', &
                                                '123456789012345678901', &
                                             '.000000000000000000001']
      character(*), parameter :: bad(22) = [character(13) :: '', ' ', '.', 'e5', '1e', '1e+', '1.2.3', &
                                            '--1', '1-2', '1e5.0', &
                                            'nan', 'inf', '0x10', '1,5', '1 2', '1_dp', '1e400', '1e-400', &
                                               '1e99999999999', &
                                            '+', '3/4', '2*3']
      character(26) :: word
      real(dp) :: number, expected
      integer :: i, whole
      logical :: sound

      do i = 1, size(good)
         word = good(i)
         read (word, *) expected
         call read_strict_real(trim(good(i)), number, sound)
         call checks%check(sound .and. abs(number - expected) <= 0.0_dp, 'read '//trim(good(i)))
      end do
      do i = 1, size(bad)
         call read_strict_real(trim(bad(i)), number, sound)
         call checks%check(.not. sound, 'refuse '//trim(bad(i)))
      end do
      call test_round_trip(checks)
      call read_strict_integer('-17', whole, sound)
      call checks%check(sound .and. whole == -17, 'integer')
      call read_strict_integer('99999999999', whole, sound)
      call checks%check(.not. sound, 'an integer that is too large')
      call read_strict_integer('1.0', whole, sound)
      call checks%check(.not. sound, 'a point in an integer')
   end subroutine test_numbers

   subroutine test_round_trip(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp) :: number, expected
      integer :: i, differing
      logical :: sound

      differing = 0
      do i = 1, 3000
         expected = (1.0_dp + sin(real(i, dp)))*10.0_dp**(modulo(i, 60) - 30)
         call read_strict_real(real_text(expected), number, sound)
         if (.not. sound .or. abs(number - expected) > 0.0_dp) differing = differing + 1
      end do
      call checks%check(differing == 0, 'shortest texts read back')
   end subroutine test_round_trip

   subroutine test_sound_files(checks)
      type(check_list_t), intent(inout) :: checks

      call accept(checks, 'load.mass,solver.periods'//line_feed//'1.5,20'//line_feed//'2.5,30'//line_feed, &
                  'Unix ends')
      call accept(checks, 'load.mass,solver.periods'//both_ends//'1.5,20'//both_ends//'2.5,30'//both_ends, &
                  'Windows ends')
      call accept(checks, 'load.mass,solver.periods'//line_feed//'1.5,20'//line_feed//'2.5,30', &
                  'no end of the last line')
      call accept(checks, '"load.mass", "Solver.Periods"'//line_feed//' 1.50 , +20'//line_feed//achar(9)// &
                  '25e-1,30 '// &
                  line_feed, 'quotes, blanks, tabs, upper case')
      call accept(checks, char(239)//char(187)//char(191)//'load.mass,solver.periods'//line_feed//'1.5,20'// &
                  line_feed// &
                  '2.5,30'//line_feed, 'byte-order mark')
      call accept(checks, 'load.mass,solver.periods'//line_feed//'"1.5","20"'//line_feed//'"2.5","30"', 'numbers in quotes')
      call accept(checks, 'load.mass;solver.periods'//line_feed//'1,5;20'//line_feed//'2,5;30', 'semicolons, decimal commas')
      call accept(checks, 'load.mass_g,solver.periods'//line_feed//'1500,20'//line_feed//'2500,30', 'a unit behind a key')
      call accept(checks, 'load.mass [g];solver.periods'//line_feed//'1500;20'//line_feed//'2500;30', 'a unit in brackets')
      call accept(checks, 'load.mass,solver.periods'//line_feed//'g,-'//line_feed//'1500,20'//line_feed//'2500,30', &
                  'a row of units')
   end subroutine test_sound_files

   subroutine accept(checks, content, message)
      type(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: content
      character(*), intent(in) :: message
      type(csv_samples_t) :: samples
      type(fault_list_t) :: faults

      call write_file(content)
      call read_csv_samples(path, samples, faults)
      call checks%check(faults%count() == 0, message//': no fault')
      if (faults%count() > 0) print '(a)', faults%sentence(1)
      call checks%check(size(samples%positions) == 2 .and. size(samples%values) == 4, message//': size')
      if (size(samples%values) /= 4) return
      call checks%check(all(samples%positions == [find_key('load.mass'), find_key('solver.periods')]), &
                        message//': keys')
      call checks%check(maxval(abs(samples%values - reshape([1.5_dp, 20.0_dp, 2.5_dp, 30.0_dp], &
                                                            [2, 2]))) <= 0.0_dp, &
                        message//': numbers')
   end subroutine accept

   !> A file of many blocks.
   subroutine test_large_file(checks)
      type(check_list_t), intent(inout) :: checks
      integer, parameter :: rows = 20000
      type(csv_samples_t) :: samples
      type(fault_list_t) :: faults
      integer :: unit, i

      open (newunit=unit, file=path, status='replace', action='write')
      write (unit, '(a)') 'load.mass,load.frequency'
      do i = 1, rows
         write (unit, '(i0, a, f0.3)') i, ',', 0.001_dp*i
      end do
      close (unit)
      call read_csv_samples(path, samples, faults)
      call checks%check(faults%count() == 0, 'many rows: no fault')
      call checks%check(size(samples%values, 2) == rows, 'many rows: count')
      if (size(samples%values, 2) /= rows) return
      call checks%check(maxval(abs(samples%values(1, :) - [(real(i, dp), i=1, rows)])) <= 0.0_dp, &
                        'many rows: first column')
      call checks%check(maxval(abs(samples%values(2, :) - [(0.001_dp*i, i=1, rows)])) < 1.0e-14_dp, &
                        'many rows: second column')
   end subroutine test_large_file

   subroutine test_headers(checks)
      type(check_list_t), intent(inout) :: checks
      character(*), parameter :: row = line_feed//'1'//line_feed

      call write_file('')
      call refuse(checks, path, 'the file is empty')
      call refuse_text(checks, 'load.mass'//line_feed, ':1: there is no line of numbers')
      call refuse_text(checks, 'load.mas'//row, &
                       ":1: column 1: 'load.mas': unknown key; the nearest known key is mass")
      call refuse_text(checks, 'lod.mass'//row, 'nearest known group is load')
      call refuse_text(checks, 'mass'//row, 'named as group.key')
      call refuse_text(checks, 'film.law'//row, 'not a number, so it cannot be varied')
      call refuse_text(checks, 'scene.name'//row, 'not a number, so it cannot be varied')
      call refuse_text(checks, 'output.stride'//row, 'does not describe the motion')
      call refuse_text(checks, 'load.mass,Load.Mass'//line_feed//'1,2'//line_feed, &
                       "column 2: 'Load.Mass': this key is already in column 1")
      call refuse_text(checks, 'load.mass,'//line_feed//'1,2'//line_feed, &
                       'column 2: a key must be named here')
      call refuse_text(checks, '# a comment'//line_feed//'load.mass'//row, 'comments are not allowed')
      call refuse_text(checks, '1.0,2.0'//row, "column 1: '1.0': unknown group")
      call refuse_text(checks, achar(0)//achar(7)//row, "column 1: '??'")
      call refuse_text(checks, repeat('x', 500)//row, "column 1: 'xxxxxxxx")
      call refuse_text(checks, repeat(',', 100)//row, 'more than 32 columns')
      call refuse_text(checks, 'load.mass_mm'//row, ":1: column 1: 'load.mass_mm': it is in mm; kg is needed")
      call refuse_text(checks, 'load.mass [stone]'//row, 'its unit is not known; kg is needed')
      call refuse_text(checks, 'load.mass'//achar(9)//'load.frequency'//row, 'tabs separate the columns')
      call refuse_text(checks, 'shaft.speed_rpm,shaft.speed_rpm [Hz]'//row, 'this key is already in column 1')
      call refuse_text(checks, 'load.mass'//line_feed//'g'//line_feed, ':2: there is no line of numbers')
   end subroutine test_headers

   subroutine test_rows(checks)
      type(check_list_t), intent(inout) :: checks
      character(*), parameter :: header = 'load.mass,solver.periods'//line_feed

      call refuse_text(checks, header//'1,2'//line_feed//'1'//line_feed, &
                       ':3: the line has 1 columns, the header 2')
      call refuse_text(checks, header//'1,2,3'//line_feed, ':2: the line has 3 columns, the header 2')
      call refuse_text(checks, header//'1,2'//line_feed//line_feed//'1,2'//line_feed, ':3: the line is empty')
      call refuse_text(checks, header//'1,2'//line_feed//' '//both_ends, ':3: the line is empty')
      call refuse_text(checks, header//'1,2'//line_feed//'abc,2'//line_feed, &
                       ":3: column 1 (load.mass): 'abc' is not a number")
      call refuse_text(checks, header//'1,2.5'//line_feed, &
                       ":2: column 2 (solver.periods): '2.5' is not an integer")
      call refuse_text(checks, header//'1,'//line_feed, ':2: column 2 (solver.periods): a number is missing')
      call refuse_text(checks, header//'nan,2'//line_feed, "'nan' is not a number")
      call refuse_text(checks, header//'1;2,2'//line_feed, "'1;2' is not a number")
      call refuse_text(checks, header//'# 1,2'//line_feed, "'# 1' is not a number")
      call refuse_text(checks, header//repeat('1', 81)//',2'//line_feed, "...' is not a number")
      call refuse_text(checks, header//'1'//achar(13)//'1,2'//line_feed, "'1?1' is not a number")
   end subroutine test_rows

   subroutine refuse_text(checks, content, words)
      type(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: content
      character(*), intent(in) :: words

      call write_file(content)
      call refuse(checks, path, words)
   end subroutine refuse_text

   !> A fault says what is expected, and all start with the name of the file.
   subroutine refuse(checks, name, words)
      type(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: name
      character(*), intent(in) :: words
      type(csv_samples_t) :: samples
      type(fault_list_t) :: faults
      integer :: i

      call read_csv_samples(name, samples, faults)
      call checks%check(faults%count() > 0, 'refused: '//words)
      if (faults%count() == 0) return
      call checks%check(any([(index(faults%sentence(i), words) > 0, i=1, faults%count())]), &
                        'refused: '//words//' (got: '//faults%sentence(1)//')')
      call checks%check(all([(index(faults%sentence(i), name) == 1, i=1, faults%count())]), &
                        'name of the file: '//words)
   end subroutine refuse

   subroutine write_file(content)
      character(*), intent(in) :: content
      integer :: unit

      open (newunit=unit, file=path, status='replace', access='stream', form='unformatted', action='write')
      write (unit) content
      close (unit)
   end subroutine write_file

end module test_csv_samples
