!> Tests of the displacements that implicit steps carry along: they are the differences of neighbouring motions, and what they show
!> of periodic and irregular motions is what neighbours show.
module test_elastic_tangents
   use canonical_scenes, only: canonical_scene, loose_gear, scene_g
   use carried_loads, only: counts_as, sizes_of_state
   use checks, only: check_list_t
   use engine, only: ending_t, motion_state_t, request_t, start_of
   use irregular_statistics, only: is_enough
   use kinds, only: dp
   use linear_equations, only: eigenvalues
   use lyapunov, only: follow_neighbours, parting_t, path_t
   use many_motions, only: has_tangents, solve_motions
   use neighbouring_motions, only: beside_neighbours, neighbouring_motions_t
   use periodic_orbit, only: find_periodic_orbit, map_states, periodic_orbit_t
   use problem, only: problem_of, problem_t, state_size
   use scene_status, only: status_complete
   use scene_types, only: law_iso_viscous, law_piezo_viscous, model_published, scene_t, viscosity_barus
   implicit none(type, external)
   private

   public :: run_elastic_tangents_tests

contains

   !> Runs every test of this topic.
   subroutine run_elastic_tangents_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('elastic_tangents')
      call against_neighbours(checks, 'one flank', on_one_flank(law_iso_viscous))
      call against_neighbours(checks, 'one flank, oil that thickens', on_one_flank(law_piezo_viscous))
      call against_neighbours(checks, 'two flanks', on_two_flanks())
      call against_neighbours(checks, 'flanks that bend', problem_of(scene_g(viscosity_barus)))
      call against_neighbours(checks, 'damped, one flank', on_one_flank(law_iso_viscous, 0.05_dp))
      call against_neighbours(checks, 'damped, one flank, oil that thickens', on_one_flank(law_piezo_viscous, 0.05_dp))
      call against_neighbours(checks, 'damped, two flanks', on_two_flanks(0.05_dp))
      call against_neighbours(checks, 'damped, flanks that bend', damped_and_bent())
      call test_repeating(checks)
      call test_returning(checks)
      call test_who(checks)
   end subroutine run_elastic_tangents_tests

   !> The canonical scene on elastic teeth.
   type(problem_t) function on_one_flank(law, damping_ratio)
      !> Code of scene_types
      integer, intent(in) :: law
      !> Of the teeth; absent: 0 [-]
      real(dp), intent(in), optional :: damping_ratio
      type(scene_t) :: scene

      scene = canonical_scene(law, 256)
      scene%film%model = model_published
      scene%contact%stiffness = 3.0e8_dp
      if (present(damping_ratio)) scene%contact%damping_ratio = damping_ratio
      on_one_flank = problem_of(scene)
   end function on_one_flank

   !> A loose gear on springs, its oil of constant viscosity.
   type(problem_t) function on_two_flanks(damping_ratio)
      !> Of the teeth; absent: 0 [-]
      real(dp), intent(in), optional :: damping_ratio
      type(scene_t) :: scene

      scene = loose_gear()
      scene%contact%stiffness = 5.0e7_dp
      if (present(damping_ratio)) scene%contact%damping_ratio = damping_ratio
      on_two_flanks = problem_of(scene)
   end function on_two_flanks

   !> Damped teeth whose flanks bend and flatten beside their damping.
   type(problem_t) function damped_and_bent()
      type(scene_t) :: scene

      scene = scene_g(viscosity_barus)
      scene%contact%stiffness = 3.0e8_dp
      scene%contact%damping_ratio = 0.05_dp
      scene%contact%flattening_included = .false.
      damped_and_bent = problem_of(scene)
   end function damped_and_bent

   !> Displacements of every number of a state through a period, against central differences of motions that start beside it. Steps
   !> of 1e-4 of what a number counts as leave an error of some 1e-8 of the largest slope, which impacts make a hundred times as
   !> large, and rounding over the steps of a period one of some 1e-14 of what a number counts as: up to 1e-13 of damped flanks that
   !> bend, of which twelve steps from 0.8e-4 to 1.3e-4 were tried.
   subroutine against_neighbours(checks, name, problem)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      character(*), intent(in) :: name
      type(problem_t), intent(in) :: problem
      real(dp), parameter :: share = 1.0e-4_dp, agreement = 1.0e-5_dp, floor = 1.2e-13_dp
      type(request_t) :: request
      type(ending_t) :: ending(1)
      type(ending_t), allocatable :: beside(:)
      type(motion_state_t) :: start
      type(motion_state_t), allocatable :: neighbours(:)
      real(dp), allocatable :: sizes(:), displacements(:, :, :), slopes(:, :), none(:, :, :)
      integer :: n, i

      n = state_size(problem)
      ! From within a motion, whose springs and films move.
      allocate (none(0, 2, 2*n))
      start = start_of(problem)
      start%implicit = .true.
      call solve_motions([problem], [start], request_t(accuracy=1.0e-10_dp, periods=3), none(:, :, :1), ending)
      start = motion_state_t(numbers=ending(1)%numbers, implicit=.true.)
      sizes = share*sizes_of_state(problem, start%numbers, counts_as(problem, start%numbers))
      request = request_t(accuracy=1.0e-12_dp, periods=1)
      allocate (displacements(n, n, 1), source=0.0_dp)
      allocate (neighbours(2*n), source=start)
      allocate (beside(2*n), slopes(n, n))
      do i = 1, n
         displacements(i, i, 1) = sizes(i)
         neighbours(i)%numbers(i) = start%numbers(i) + sizes(i)
         neighbours(n + i)%numbers(i) = start%numbers(i) - sizes(i)
      end do
      call solve_motions([problem], [start], request, none(:, :, :1), ending, displacements=displacements)
      call solve_motions([(problem, i=1, 2*n)], neighbours, request, none, beside)
      call checks%check(ending(1)%status == status_complete .and. all(beside%status == status_complete), name//': solved')
      do i = 1, n
         slopes(:, i) = 0.5_dp*(beside(i)%numbers - beside(n + i)%numbers)
      end do
      sizes = sizes_of_state(problem, ending(1)%numbers, counts_as(problem, ending(1)%numbers))
      slopes = slopes/spread(sizes, 2, n)
      displacements(:, :, 1) = displacements(:, :, 1)/spread(sizes, 2, n)
      do i = 1, n
         call checks%check(maxval(abs(displacements(:, i, 1) - slopes(:, i))) <= agreement*maxval(abs(slopes(:, i))) + floor, &
                           name//': displacements')
      end do
   end subroutine against_neighbours

   !> A motion that repeats: its multipliers are those of differences, and its exponent is the logarithm of the largest.
   subroutine test_repeating(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(problem_t) :: problem
      type(ending_t) :: endings(1)
      type(periodic_orbit_t) :: orbit
      type(parting_t) :: partings(1)
      type(path_t) :: paths(1)
      type(neighbouring_motions_t) :: followed
      complex(dp), allocatable :: multipliers(:)
      real(dp) :: none(0, 2, 1)

      problem = problem_of(scene_g(viscosity_barus))
      call solve_motions([problem], [start_of(problem)], request_t(accuracy=1.0e-8_dp, periods=60), none, endings)
      call checks%check(has_tangents(problem, endings(1)%motion_state_t, 1.0e-8_dp), 'followed by implicit steps')
      orbit = find_periodic_orbit(problem, endings(1)%numbers, 0.02_dp)
      call checks%check(orbit%period == 1, 'the motion repeats')
      if (orbit%period /= 1) return
      ! Motions that are known to 1e-12, 1e-4 beside each other.
      multipliers = multipliers_of_differences(problem, orbit%state)
      call checks%check(maxval(abs(orbit%multipliers - multipliers)) <= 1.0e-7_dp, 'its multipliers')
      followed = beside_neighbours([problem], [endings(1)%motion_state_t])
      call follow_neighbours(followed, is_enough, partings, paths)
      call checks%check_close(partings(1)%exponent, log(abs(orbit%multipliers(1))), 1.0e-3_dp, 'its exponent')
   end subroutine test_repeating

   !> A tooth at rest returns to the last bit, so that nothing of it is left to be computed but its displacements: over several
   !> periods they are what as many single ones make of them.
   subroutine test_returning(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      integer, parameter :: periods = 4
      type(scene_t) :: scene
      type(problem_t) :: problem
      type(motion_state_t) :: start
      type(ending_t) :: ending(1)
      real(dp), allocatable :: together(:, :, :), one_by_one(:, :, :)
      real(dp) :: none(0, 2, 1)
      integer :: i

      scene = canonical_scene(law_iso_viscous, 256)
      scene%contact%stiffness = 1.0e7_dp
      scene%film%initial_film = 0.0_dp
      scene%excitation%force_amplitude = 0.0_dp
      problem = problem_of(scene)
      start = start_of(problem)
      start%implicit = .true.
      call solve_motions([problem], [start], request_t(accuracy=1.0e-8_dp, periods=20), none, ending)
      start = motion_state_t(numbers=ending(1)%numbers, implicit=.true.)
      call solve_motions([problem], [start], request_t(accuracy=1.0e-8_dp, periods=1), none, ending)
      call checks%check(all(abs(ending(1)%numbers - start%numbers) <= 0.0_dp), 'returns to the last bit')
      allocate (together(3, 1, 1), source=0.0_dp)
      together(:, 1, 1) = 1.0e-4_dp*sizes_of_state(problem, start%numbers, counts_as(problem, start%numbers))
      allocate (one_by_one, source=together)
      call solve_motions([problem], [start], request_t(accuracy=1.0e-8_dp, periods=periods), none, ending, displacements=together)
      do i = 1, periods
         call solve_motions([problem], [start], request_t(accuracy=1.0e-8_dp, periods=1), none, ending, displacements=one_by_one)
      end do
      call checks%check(maxval(abs(together - one_by_one)) <= 1.0e-12_dp*maxval(abs(one_by_one)), &
                        'displacements of a motion that returns to the last bit')
   end subroutine test_returning

   !> Multipliers of a motion that repeats after a period, by central differences.
   function multipliers_of_differences(problem, state) result(multipliers)
      type(problem_t), intent(in) :: problem
      !> At the start of the period
      real(dp), intent(in) :: state(:)
      complex(dp), allocatable :: multipliers(:)
      real(dp), parameter :: share = 1.0e-4_dp
      real(dp) :: states(size(state), 2*size(state)), sizes(size(state)), slopes(size(state), size(state))
      logical :: mapped
      integer :: n, i

      n = size(state)
      sizes = sizes_of_state(problem, state, counts_as(problem, state))
      states = spread(state, 2, 2*n)
      do i = 1, n
         states(i, i) = state(i) + share*sizes(i)
         states(i, n + i) = state(i) - share*sizes(i)
      end do
      call map_states(problem, 1, 1.0e-12_dp, states, mapped)
      do i = 1, n
         slopes(:, i) = (states(:, i) - states(:, n + i))/(2.0_dp*share*sizes(i))*sizes(i)/sizes
      end do
      multipliers = eigenvalues(slopes)
   end function multipliers_of_differences

   !> Who has tangents: motions that go by implicit steps on springs; none that goes by series, or on rigid teeth.
   subroutine test_who(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(problem_t) :: problem, rigid
      type(motion_state_t) :: start

      problem = on_one_flank(law_iso_viscous)
      start = start_of(problem)
      call checks%check(.not. has_tangents(problem, start, 1.0e-8_dp), 'not by series')
      start%implicit = .true.
      call checks%check(has_tangents(problem, start, 1.0e-8_dp), 'by implicit steps')
      rigid = problem_of(canonical_scene(law_iso_viscous, 256))
      start = start_of(rigid)
      start%implicit = .true.
      call checks%check(.not. has_tangents(rigid, start, 1.0e-8_dp), 'not on rigid teeth')
   end subroutine test_who

end module test_elastic_tangents
