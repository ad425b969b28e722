!> Tests of the keys of one scene: defaults, assignments, overrides, and keys that do not exist.
module test_scene_input
   use checks, only: check_list_t
   use errors, only: fault_list_t
   use key_table, only: keys
   use kinds, only: dp
   use namelist_text, only: assignment_t, scan_namelists
   use scene_input, only: new_scene_input, scene_input_t
   use scene_types, only: law_iso_viscous, law_piezo_viscous, predictor_previous
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
      call test_faults(checks)
      call test_override(checks)
   end subroutine run_scene_input_tests

   !> Values that no one set.
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
      call checks%check_close(input%number('load.gravity'), 9.80665_dp, 0.0_dp, 'default number')
      call checks%check_close(input%number('solver.tolerance'), 1.0e-14_dp, 0.0_dp, 'default tolerance')
      call checks%check(input%count('solver.steps_per_period') == 512, 'default count')
      call checks%check(input%flag('output.series') .and. .not. input%flag('output.overwrite'), &
         'default flags')
      call checks%check(input%word('film.rupture') == 'half-pi', 'default word')
      call checks%check(input%words('output.columns') == 'time applied_force film_thickness acceleration', 'default list')
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
      call checks%check_close(input%number('load.mass'), 2.5_dp, 0.0_dp, 'number')
      call checks%check_close(input%number('load.steady_force'), -10.0_dp, 0.0_dp, &
         'd as the exponent letter')
      call checks%check(input%count('solver.steps_per_period') == 4096, 'count')
      call checks%check(input%choice('solver.predictor') == predictor_previous, 'choice of a predictor')
      call checks%check(input%choice('film.law') == law_piezo_viscous, 'choice of a law')
      call checks%check(.not. input%flag('output.series'), 'flag')
      call checks%check(input%words('output.columns') == 'time film_load', 'list')
      call checks%check(input%word('output.directory') == 'a b', 'text with a blank')
      call checks%check(input%is_given('load.mass') .and. .not. input%is_given('load.gravity'), &
         'what was given')
      input = new_scene_input('f')
      call take(input, "&film law='iso-viscous  ' /", .false., faults)
      call checks%check(faults%count() == 0 .and. input%choice('film.law') == law_iso_viscous, &
         'a word with blanks behind it is that word')
   end subroutine test_values

   !> Assignments that have no place among the keys, one fault each.
   subroutine test_faults(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call expect('&load mass=3.0 mass=3.0 /', 'f:1: &load mass: this key is set in line 1', 'key twice')
      call expect('&load mas=3.0 /', 'f:1: &load mas: unknown key; the nearest known key is mass', &
         'unknown key')
      call expect('&loud mass=3.0 frequency=6 /', &
         'f:1: &loud: unknown group; the nearest known group is &load', &
         'unknown group, reported once')

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
      call checks%check_close(input%number('load.mass'), 4.0_dp, 0.0_dp, 'override: number')
      call checks%check(input%words('output.columns') == 'acceleration', &
         'override: list replaced, not appended')
   end subroutine test_override

   !> Scan a text and take its assignments.
   subroutine take(input, text, overriding, faults)
      type(scene_input_t), intent(inout) :: input  !> Takes the values
      character(*), intent(in) :: text             !> Namelist text
      logical, intent(in) :: overriding            !> Whether values may be replaced
      type(fault_list_t), intent(inout) :: faults  !> Faults are appended

      type(assignment_t), allocatable :: assignments(:)

      call scan_namelists(text, 'f', 1, assignments, faults)
      call input%set_all(assignments, 'f', overriding)
      call input%close_lists()
      call faults%take(input%faults)
   end subroutine take

end module test_scene_input
