!> Tests of typed input values: defaults, assignments, overrides, and every kind of wrong value.
module test_scene_input
   use, intrinsic :: ieee_arithmetic, only: ieee_get_halting_mode, ieee_overflow
   use checks, only: check_list_t
   use errors, only: fault_list_t
   use key_table, only: find_key, keys
   use kinds, only: dp
   use namelist_text, only: assignment_t, scan_namelists
   use scene_input, only: new_scene_input, scene_input_t, value_text
   use scene_types, only: law_piezo_viscous, predictor_previous
   implicit none(type, external)
   private

   public :: run_scene_input_tests

contains

   !> Runs every test of this topic.
   subroutine run_scene_input_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('scene_input')
      call test_defaults(checks)
      call test_values(checks)
      call test_numbers(checks)
      call test_faults(checks)
      call test_override(checks)
      call test_value_text(checks)
   end subroutine run_scene_input_tests

   !> Values that nobody set.
   subroutine test_defaults(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(scene_input_t) :: input
      integer :: i
      logical :: right

      input = new_scene_input('f')
      right = .true.
      do i = 1, size(keys)
         right = right .and. .not. input%entries(i)%given .and. .not. input%entries(i)%faulty .and. &
            (input%entries(i)%present .eqv. (keys(i)%default /= '' .and. keys(i)%default /= 'required'))
      end do
      call checks%check(right, 'defaults: present where the table has one')
      call checks%check_close(input%number('load', 'gravity'), 9.80665_dp, 0.0_dp, 'default number')
      call checks%check_close(input%number('solver', 'tolerance'), 1.0e-14_dp, 0.0_dp, 'default tolerance')
      call checks%check(input%count('solver', 'steps_per_period') == 512, 'default count')
      call checks%check(input%flag('output', 'series') .and. .not. input%flag('output', 'overwrite'), &
         'default flags')
      call checks%check(input%word('film', 'rupture') == 'half-pi', 'default word')
      call checks%check(input%words('output', &
         'columns') == 'time applied_force film_thickness acceleration', 'default list')
   end subroutine test_defaults

   !> Values of a text.
   subroutine test_values(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(scene_input_t) :: input
      type(fault_list_t) :: faults

      input = new_scene_input('f')
      call take(input, "&load mass=2.5 steady_force = -1d1/ "// &
         "&solver steps_per_period=4096 predictor='previous'/ "// &
         "&film law='piezo-viscous' / &output series=F, columns='time','film_load' directory='a b' /", &
         .false., faults)
      call checks%check(faults%count() == 0, 'values: no fault')
      call checks%check_close(input%number('load', 'mass'), 2.5_dp, 0.0_dp, 'number')
      call checks%check_close(input%number('load', 'steady_force'), -10.0_dp, 0.0_dp, &
         'd as the exponent letter')
      call checks%check(input%count('solver', 'steps_per_period') == 4096, 'count')
      call checks%check(input%choice('solver', 'predictor') == predictor_previous, 'choice of a predictor')
      call checks%check(input%choice('film', 'law') == law_piezo_viscous, 'choice of a law')
      call checks%check(.not. input%flag('output', 'series'), 'flag')
      call checks%check(input%words('output', 'columns') == 'time film_load', 'list')
      call checks%check(input%word('output', 'directory') == 'a b', 'text with a blank')
      call checks%check(input%is_given('load', 'mass') .and. .not. input%is_given('load', 'gravity'), &
         'what was given')
   end subroutine test_values

   !> Spellings of numbers, right and wrong.
   subroutine test_numbers(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      character(8), parameter :: right(8) = [character(8) :: '1', '+1.', '.5', '1e3', '1.5E+03', '1.5d-03', &
         '0.25', '007']
      real(dp), parameter :: values(8) = [1.0_dp, 1.0_dp, 0.5_dp, 1.0e3_dp, 1.5e3_dp, 1.5e-3_dp, 0.25_dp, &
         7.0_dp]
      character(8), parameter :: wrong(17) = [character(8) :: '.', 'e5', '1e', '1e5.5', '1.2.3', 'nan', &
         'inf', '-1', '0', '1e999', &
         '0x10', '1*3', '3;', '1.0_dp', '--1', '1e+-3', '1 2']
      type(scene_input_t) :: input
      type(fault_list_t) :: faults
      integer :: i, before
      logical :: halting

      do i = 1, size(right)
         input = new_scene_input('f')
         before = faults%count()
         call take(input, '&load mass = '//trim(right(i))//' /', .false., faults)
         call checks%check(faults%count() == before, 'number '//trim(right(i)))
         call checks%check_close(input%number('load', 'mass'), values(i), 0.0_dp, 'value of '//trim(right(i)))
      end do
      ! 1e999 is infinite to the runtime's reader: a build with traps would stop there.
      call ieee_get_halting_mode(ieee_overflow, halting)
      do i = 1, size(wrong)
         if (halting .and. wrong(i) == '1e999') cycle
         input = new_scene_input('f')
         before = faults%count()
         call take(input, '&load mass = '//trim(wrong(i))//' /', .false., faults)
         call checks%check(faults%count() > before, 'no mass: '//trim(wrong(i)))
         call checks%check(input%entries(find_key('load', 'mass'))%faulty, &
            'marked as faulty: '//trim(wrong(i)))
      end do
   end subroutine test_numbers

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
      call expect("&output columns(2)='time' /", 'f:1: &output columns: elements must be given', &
         'index beyond 1')
      call expect('&load mass(1)=3.0 /', 'f:1: &load mass: takes no index', 'index of a number')
      call expect('&load mass=3.0 4.0 /', 'f:1: &load mass: takes one value, 2', 'two values')
      call expect('&load mass=3.0 mass=3.0 /', 'f:1: &load mass: this key is set in line 1', 'key twice')
      call expect('&load mas=3.0 /', 'f:1: &load mas: unknown key; the nearest known key is mass', &
         'unknown key')
      call expect('&loud mass=3.0 frequency=6 /', &
         'f:1: &loud: unknown group; the nearest known group is &load', &
         'unknown group, told once')

   contains

      !> One text, one fault that begins so.
      subroutine expect(text, beginning, message)
         character(*), intent(in) :: text       !> Text to read
         character(*), intent(in) :: beginning  !> Of the fault
         character(*), intent(in) :: message    !> What is wrong with the text

         type(scene_input_t) :: input
         type(fault_list_t) :: faults

         input = new_scene_input('f')
         call take(input, text, .false., faults)
         call checks%check(faults%count() == 1, message//': one fault')
         if (faults%count() > 0) call checks%check(index(faults%sentence(1), beginning) == 1, &
            message//': '//faults%sentence(1))
      end subroutine expect

   end subroutine test_faults

   !> A later source replaces, and mends, an earlier value.
   subroutine test_override(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(scene_input_t) :: input
      type(fault_list_t) :: faults

      input = new_scene_input('f')
      call take(input, "&load mass=3.0 / &output columns='time','film_load' /", .false., faults)
      call take(input, "&load mass=4.0 / &output columns='acceleration' /", .true., faults)
      call checks%check(faults%count() == 0, 'override: no fault')
      call checks%check_close(input%number('load', 'mass'), 4.0_dp, 0.0_dp, 'override: number')
      call checks%check(input%words('output', 'columns') == 'acceleration', &
         'override: list replaced, not appended')
   end subroutine test_override

   !> The text of a value reads back to it.
   subroutine test_value_text(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(scene_input_t) :: input, again
      type(fault_list_t) :: faults
      character(:), allocatable :: text
      integer :: i
      logical :: same

      input = new_scene_input('f')
      call take(input, "&load mass=3.3333333333333335 frequency=1e-300 / "// &
         "&scene name='x''y' / &solver periods=17 /", &
         .false., faults)
      text = ''
      do i = 1, size(keys)
         if (input%entries(i)%present) text = text//'&'//trim(keys(i)%group)//' '//trim(keys(i)%name)// &
            ' = '// &
            value_text(keys(i), input%entries(i))//' /'//new_line('a')
      end do
      again = new_scene_input('f')
      ! Each key stands in a group of its own here, and a group may stand only once: scan them one by one.
      do while (len(text) > 0)
         call take(again, text(:index(text, new_line('a'))), .true., faults)
         text = text(index(text, new_line('a')) + 1:)
      end do
      call checks%check(faults%count() == 0, 'text of values: no fault')
      same = .true.
      do i = 1, size(keys)
         same = same .and. abs(input%entries(i)%number - again%entries(i)%number) <= 0.0_dp .and. &
            input%entries(i)%count == again%entries(i)%count &
            .and. (input%entries(i)%flag .eqv. again%entries(i)%flag) .and. &
            input%entries(i)%word == again%entries(i)%word &
            .and. input%entries(i)%words == again%entries(i)%words
      end do
      call checks%check(same, 'text of values reads back')
   end subroutine test_value_text

   !> Scan a text and take its assignments.
   subroutine take(input, text, overriding, faults)
      type(scene_input_t), intent(inout) :: input  !> Takes the values
      character(*), intent(in) :: text             !> Namelist text
      logical, intent(in) :: overriding            !> Whether values may be replaced
      type(fault_list_t), intent(inout) :: faults  !> Faults are appended

      type(assignment_t), allocatable :: assignments(:)

      call scan_namelists(text, 'f', 1, assignments, faults)
      call input%set_all(assignments, 'f', overriding, faults)
   end subroutine take

end module test_scene_input
