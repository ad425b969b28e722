!> Tests of the value of one key: every kind of right and wrong value, and the text of a value.
module test_input_entry
   use, intrinsic :: ieee_arithmetic, only: ieee_get_halting_mode, ieee_overflow
   use checks, only: check_list_t
   use errors, only: fault_list_t
   use input_entry, only: close_list, entry_t, new_entry, set_entry, value_text
   use input_key, only: key_t
   use key_table, only: find_key, keys
   use kinds, only: dp
   use namelist_text, only: assignment_t, scan_namelists
   implicit none(type, external)
   private

   public :: run_input_entry_tests

contains

   !> Runs every test of this topic.
   subroutine run_input_entry_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('input_entry')
      call test_numbers(checks)
      call test_lists(checks)
      call test_faults(checks)
      call test_value_text(checks)
   end subroutine run_input_entry_tests

   !> Spellings of numbers, right and wrong.
   subroutine test_numbers(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      character(8), parameter :: right(13) = [character(8) :: '1', '+1.', '.5', '1e3', '1.5E+03', '1.5d-03', &
         '0.25', '007', '1.0q-8', '5Q2', '1.0-8', '1.+3', '1*3']
      real(dp), parameter :: values(13) = [1.0_dp, 1.0_dp, 0.5_dp, 1.0e3_dp, 1.5e3_dp, 1.5e-3_dp, 0.25_dp, &
         7.0_dp, 1.0e-8_dp, 500.0_dp, 1.0e-8_dp, 1.0e3_dp, 3.0_dp]
      character(8), parameter :: wrong(21) = [character(8) :: '.', 'e5', '1e', '1e5.5', '1.2.3', 'nan', &
         'inf', '-1', '0', '1e999', &
         '0x10', '2*3', '3;', '1+5', '1.0q', '1.0-', '.-3', '1.0_dp', '--1', '1e+-3', '1 2']
      type(entry_t) :: entry
      type(fault_list_t) :: faults
      integer :: i, before
      logical :: halting

      do i = 1, size(right)
         before = faults%count()
         call read_entry('&load mass = '//trim(right(i))//' /', entry, faults)
         call checks%check(faults%count() == before, 'number '//trim(right(i)))
         call checks%check_close(entry%number, values(i), 0.0_dp, 'value of '//trim(right(i)))
      end do
      ! 1e999 is infinite to the runtime's reader: a build with traps would stop there.
      call ieee_get_halting_mode(ieee_overflow, halting)
      do i = 1, size(wrong)
         if (halting .and. wrong(i) == '1e999') cycle
         before = faults%count()
         call read_entry('&load mass = '//trim(wrong(i))//' /', entry, faults)
         call checks%check(faults%count() > before, 'no mass: '//trim(wrong(i)))
         call checks%check(entry%faulty, &
            'marked as faulty: '//trim(wrong(i)))
      end do
   end subroutine test_numbers

   !> Lists and tables that are given in one go or piece by piece.
   subroutine test_lists(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(entry_t) :: entry
      type(fault_list_t) :: faults

      call read_entry('&campaign first=1 2.5, 3 /', entry, faults)
      call checks%check(size(entry%numbers) == 3, 'three numbers in one go')
      call read_entry('&campaign first(1)=1 first(2)=2.5, 3 /', entry, faults)
      call checks%check(size(entry%numbers) == 3, 'three numbers, piece by piece')
      if (size(entry%numbers) == 3) call checks%check_close(entry%numbers(2), 2.5_dp, 0.0_dp, 'the second number')
      call read_entry('&campaign values(:, 1)=1 2 values(:, 2)=3 4 5 /', entry, faults)
      call checks%check(size(entry%columns) == 2, 'two columns')
      if (size(entry%columns) == 2) call checks%check(size(entry%columns(1)%numbers) == 2 .and. &
         size(entry%columns(2)%numbers) == 3, 'columns of two and three numbers')
      call read_entry("&output columns(1)='time' columns(2)='film_load' /", entry, faults)
      call checks%check(entry%words == 'time film_load', 'words, piece by piece; the default is no beginning')
      call read_entry("&points squeeze_ratios=-1 1 /", entry, faults)
      call checks%check(size(entry%numbers) == 2, 'numbers that replace a default')
      call read_entry('&campaign first=1 2 3 4 first(2)=8 9 /', entry, faults)
      call checks%check(size(entry%numbers) == 4, 'two elements replaced: four numbers')
      if (size(entry%numbers) == 4) call checks%check(maxval(abs(entry%numbers - [1.0_dp, 8.0_dp, 9.0_dp, 4.0_dp])) <= 0.0_dp, &
                                                      'two elements replaced')
      call read_entry('&campaign first=1 2 first(1)=8 /', entry, faults)
      call checks%check(size(entry%numbers) == 2, 'the first element replaced, the second stays')
      call read_entry('&campaign first=1 2 first(2)=8 9 /', entry, faults)
      call checks%check(size(entry%numbers) == 3, 'the last element replaced, one more behind it')
      call read_entry('&campaign first=1 2 first=8 /', entry, faults)
      call checks%check(size(entry%numbers) == 1, 'the whole list replaced')
      call read_entry('&campaign values(:, 1)=1 2 values(:, 2)=3 4 5 values(:, 1)=6 /', entry, faults)
      call checks%check(size(entry%columns) == 2, 'one column replaced')
      if (size(entry%columns) == 2) call checks%check(size(entry%columns(1)%numbers) == 1 .and. &
         size(entry%columns(2)%numbers) == 3, 'the other column stays')
      call read_entry("&output columns='time' 'acceleration' 'film_load' columns(2)='applied_force' /", entry, faults)
      call checks%check(entry%words == 'time applied_force film_load', 'one word replaced')
      call checks%check(faults%count() == 0, 'lists: no fault')
      entry = new_entry(keys(find_key('points.squeeze_ratios')), 'f')
      call checks%check(size(entry%numbers) == 1, 'default of a list of numbers')
   end subroutine test_lists

   !> Every other wrong assignment, one fault each.
   subroutine test_faults(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call expect("&load mass='3.0' /", 'f:1: &load mass: ''3.0'' is not allowed', 'number in quotes')
      call expect('&solver periods=1.5 /', 'f:1: &solver periods: 1.5', 'fraction for an integer')
      call expect('&solver periods=99999999999 /', 'f:1: &solver periods:', 'integer too large')
      call expect('&solver steps_per_period=7 /', 'f:1: &solver steps_per_period: 7', 'too few steps')
      call expect('&output series=yes /', 'f:1: &output series: yes', 'no logical')
      call expect("&output series='T' /", 'f:1: &output series:', 'logical in quotes')
      call expect('&film law=iso-viscous /', 'f:1: &film law:', 'word without quotes')
      call expect("&film law='iso' /", 'f:1: &film law:', 'part of a word')
      call expect("&film law='iso-viscous piezo-viscous' /", 'f:1: &film law:', 'two words in one')
      call expect("&output directory='' /", 'f:1: &output directory:', 'empty text')
      call expect("&output directory='"//repeat('x', 513)//"' /", 'f:1: &output directory:', 'text too long')
      call expect("&output columns='time','times' /", 'f:1: &output columns: ''times''', 'unknown column')
      call expect("&output columns(2)='time' /", 'f:1: &output columns: element 1 is not set, but element 2 is;', &
         'element left unset')
      call expect('&load mass(1)=3.0 /', 'f:1: &load mass: takes no index', 'index of a number')
      call expect('&load mass=3.0 4.0 /', 'f:1: &load mass: takes one value, 2', 'two values')
      call expect('&campaign values=1 2 /', 'f:1: &campaign values: give it as values(:, 1) = ..., values(:, 2) = ...', &
         'table without a column')
      call expect("&output columns(:, 1)='time' /", 'f:1: &output columns: takes no (:, i)', 'column of a list')

   contains

      !> One text, one fault that begins so.
      subroutine expect(text, beginning, message)
         character(*), intent(in) :: text       !> Text to read
         character(*), intent(in) :: beginning  !> Of the fault
         character(*), intent(in) :: message    !> What is wrong with the text

         type(entry_t) :: entry
         type(fault_list_t) :: faults

         call read_entry(text, entry, faults)
         call checks%check(faults%count() == 1, message//': one fault')
         if (faults%count() > 0) call checks%check(index(faults%sentence(1), beginning) == 1, &
            message//': '//faults%sentence(1))
      end subroutine expect

   end subroutine test_faults

   !> The text of a value reads back to it, for every key that has one.
   subroutine test_value_text(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(entry_t) :: entry
      type(fault_list_t) :: faults
      integer :: i

      call read_entry('&load mass=3.3333333333333335 /', entry, faults)
      call expect_back(keys(find_key('load.mass')), entry)
      call read_entry('&load frequency=1e-300 /', entry, faults)
      call expect_back(keys(find_key('load.frequency')), entry)
      call read_entry("&scene name='x''y' /", entry, faults)
      call expect_back(keys(find_key('scene.name')), entry)
      call read_entry('&solver periods=17 /', entry, faults)
      call expect_back(keys(find_key('solver.periods')), entry)
      do i = 1, size(keys)
         entry = new_entry(keys(i), 'f')
         if (entry%present) call expect_back(keys(i), entry)
      end do
      call checks%check(faults%count() == 0, 'text of values: no fault')

   contains

      !> One value and its text.
      subroutine expect_back(key, entry)
         type(key_t), intent(in) :: key      !> Its key
         type(entry_t), intent(in) :: entry  !> The value

         type(entry_t) :: again

         call read_entry('&'//trim(key%group)//' '//trim(key%name)//' = '//value_text(key, entry)//' /'// &
            new_line('a'), again, faults)
         call checks%check(abs(entry%number - again%number) <= 0.0_dp .and. entry%count == again%count .and. &
            (entry%flag .eqv. again%flag) .and. entry%word == again%word .and. entry%words == again%words &
            .and. size(entry%numbers) == size(again%numbers), &
            trim(key%group)//' '//trim(key%name)//': text of its value reads back')
      end subroutine expect_back

   end subroutine test_value_text

   !> Read the assignments of one key into its entry, from its default on.
   subroutine read_entry(text, entry, faults)
      character(*), intent(in) :: text             !> Namelist text of one group that sets one key
      type(entry_t), intent(out) :: entry          !> Its value
      type(fault_list_t), intent(inout) :: faults  !> Faults are appended

      type(assignment_t), allocatable :: assignments(:)
      integer :: i, position

      call scan_namelists(text, 'f', 1, assignments, faults)
      position = find_key(assignments(2)%group//'.'//assignments(2)%key)
      entry = new_entry(keys(position), 'f')
      do i = 2, size(assignments)
         call set_entry(keys(position), assignments(i), .true., entry, 'f', faults)
      end do
      call close_list(keys(position), entry, faults)
   end subroutine read_entry

end module test_input_entry
