!> Tests of neighbours of motions in nodes of pressure, of the periodic motion next to one and of its Floquet multipliers. That
!> multipliers are what deviations from a motion decay by is tested through the program, tests/user/test_resolved.py.
module test_nodal_orbit
   use canonical_scenes, only: canonical_scene, counting_watcher_t, scene_g
   use checks, only: check_list_t
   use clock, only: wall_seconds
   use doubt, only: doubt_parting, doubt_sentence, doubt_t
   use engine, only: checkpoint_t, ending_t
   use errors, only: error_t
   use classify_group, only: integral_record
   use kinds, only: dp
   use irregular_statistics, only: is_enough
   use lyapunov, only: follow_neighbours, parting_t, path_t
   use nodal_engine, only: solve_in_nodes
   use nodal_orbit, only: find_nodal_orbit, orbit_found, orbit_none_near, orbit_out_of_time, &
      orbit_sentence
   use nodal_judgement, only: choice_of, solve_finer
   use nodal_neighbours, only: beside_nodal_neighbour, nodal_neighbours_t
   use nodal_state, only: unpack_motion
   use nodal_step, only: gear_t, motion_t, nodal_choice_t, set_up, take_step
   use nodal_tangent, only: displace, nodal_tangent_t, start_tangent
   use periodic_orbit, only: periodic_orbit_t
   use problem, only: problem_of, problem_t
   use prepared_scene, only: request_of, prepare
   use scene_status, only: status_complete, status_time_limit
   use scene_types, only: law_elastohydrodynamic, model_resolved, scene_t, until_periods, viscosity_constant, viscosity_roelands
   use window_record, only: window_record_t
   use scene_group, only: scene_group_t
   use window_keeper, only: window_keeper_t
   implicit none(type, external)
   private

   public :: run_nodal_orbit_tests

contains

   !> Runs every test of this topic.
   subroutine run_nodal_orbit_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('nodal_orbit')
      call test_neighbours(checks)
      call test_periodic_motion(checks)
      call test_none_near(checks)
      call test_out_of_time(checks)
   end subroutine run_nodal_orbit_tests

   !> Solve some periods of a scene in nodes.
   subroutine solve(scene, problem, choice, ending)
      type(scene_t), intent(in) :: scene
      type(problem_t), intent(out) :: problem
      type(nodal_choice_t), intent(out) :: choice
      type(ending_t), intent(out) :: ending
      type(window_keeper_t) :: keeper
      type(window_record_t) :: record
      type(counting_watcher_t) :: watcher
      type(checkpoint_t) :: start
      type(error_t), allocatable :: error

      problem = problem_of(scene)
      call choice_of(prepare(scene), choice)
      call keeper%keep_windows_of(problem)
      record = integral_record(scene%spectrum)
      record%wants = .true.
      record%loads%impact_limit = scene%spectrum%impact_limit
      call solve_in_nodes(problem, choice, request_of(scene), keeper, watcher, start, ending, record, error)
   end subroutine solve

   !> Scene G, some periods of it.
   type(scene_t) function gear_scene(law, periods)
      !> Of the viscosity
      integer, intent(in) :: law
      integer, intent(in) :: periods

      gear_scene = scene_g(law)
      gear_scene%film%model = model_resolved
      gear_scene%film%nodes = 32
      gear_scene%solver%accuracy = 1.0e-2_dp
      gear_scene%solver%kept_per_period = 16
      gear_scene%solver%until = until_periods
      gear_scene%solver%periods = periods
      gear_scene%spectrum%periods = 1
   end function gear_scene

   !> A neighbour is as far from its motion after a period with impacts, in and out of nodes, as one that was followed by itself by
   !> the same steps.
   subroutine test_neighbours(checks)
      type(check_list_t), intent(inout) :: checks
      !> Distance of the neighbours over the unit of films: the last correction of Newton's iterations is at most 1e-7 of a film
      real(dp), parameter :: apart = 3.0e-4_dp
      integer, parameter :: laws(2) = [viscosity_constant, viscosity_roelands]
      type(problem_t) :: problem
      type(nodal_choice_t) :: choice
      type(gear_t) :: gear
      type(nodal_tangent_t) :: tangent
      type(motion_t) :: motion, other
      type(ending_t) :: ending
      real(dp) :: shares(2), largest, worst
      integer :: i, flank, steps, changes
      logical :: alike, in_nodes(2)

      do i = 1, size(laws)
         call solve(gear_scene(laws(i), 2), problem, choice, ending)
         call checks%check(ending%status == status_complete, 'scene G is solved')
         ! So that steps are allowed to a neighbour as far away as well
         choice%tolerance = apart
         call set_up(problem, choice, gear)
         call unpack_motion(problem, choice%nodes, ending%nodal, motion)
         call start_tangent(gear%contact, motion%flanks(:gear%flanks), motion%time*gear%period, tangent)
         shares = [apart, 0.0_dp]
         other = motion
         other%position(1:) = motion%position(1:) + matmul(tangent%position(1:, :), shares)
         other%velocity(1:) = motion%velocity(1:) + matmul(tangent%velocity(1:, :), shares)
         do flank = 1, gear%flanks
            call displace(gear%contact, shares, tangent%flanks(flank), other%flanks(flank))
         end do
         ending%status = status_complete
         alike = .true.
         worst = 0.0_dp
         largest = 0.0_dp
         changes = 0
         steps = 0
         do while (motion%time(1) < 1.0_dp .and. alike .and. ending%status == status_complete)
            in_nodes = motion%flanks%in_nodes
            call take_step(gear, motion, ending, tangent)
            other%step = motion%time(1) - motion%time(2)
            call take_step(gear, other, ending)
            alike = abs(motion%time(1) - other%time(1)) <= 1.0e-13_dp .and. all(motion%flanks%in_nodes .eqv. other%flanks%in_nodes)
            if (any(in_nodes .neqv. motion%flanks%in_nodes)) changes = changes + 1
            steps = steps + 1
            largest = max(largest, abs(tangent%position(1, 1)))
            worst = max(worst, abs(other%position(1) - motion%position(1) - apart*tangent%position(1, 1)))
         end do
         call checks%check(alike .and. changes >= 4 .and. steps > 200, 'neighbours are followed by the same steps')
         ! Of what the impacts leave, two hundredths of the distance at first: as exact as the distance is small and passes end
         call checks%check(worst <= 4.0e-5_dp*apart*largest, 'a neighbour is where its own steps lead to')
         call checks%check_close((other%velocity(1) - motion%velocity(1))/apart, tangent%velocity(1, 1), &
                                 1.0e-3_dp*abs(tangent%velocity(1, 1)), 'and as fast')
      end do
   end subroutine test_neighbours

   !> A motion that still settles, by a fifth a period, leads to the periodic motion, whose multipliers are near those of the closure.
   subroutine test_periodic_motion(checks)
      type(check_list_t), intent(inout) :: checks
      !> Modulus of the closure's, and how far off it may be: its errors of films and loads are per cents
      real(dp), parameter :: modulus = 0.8208_dp, off = 0.02_dp
      type(scene_t) :: scene
      type(problem_t) :: problem
      type(nodal_choice_t) :: choice
      type(ending_t) :: ending
      type(periodic_orbit_t) :: orbit, later
      integer :: outcome

      scene = canonical_scene(law_elastohydrodynamic, 16)
      scene%contact%young_modulus = 2.2e11_dp*(1.0_dp - 0.3_dp**2)
      scene%contact%stiffness = 1.0e8_dp
      scene%contact%flattening_included = .false.
      scene%lubricant%viscosity_law = viscosity_constant
      scene%film%model = model_resolved
      scene%film%nodes = 32
      scene%solver%accuracy = 1.0e-2_dp
      scene%solver%until = until_periods
      scene%spectrum%periods = 1
      scene%solver%periods = 42
      call solve(scene, problem, choice, ending)
      call find_nodal_orbit(problem, choice, ending%nodal, 0.05_dp, orbit, outcome)
      call checks%check(outcome == orbit_found .and. orbit%period == 1 .and. size(orbit%multipliers) == 2, 'it is found')
      if (outcome /= orbit_found) return
      call checks%check_close(abs(orbit%multipliers(1)), modulus, off*modulus, 'its multipliers are near the closure''s')
      call checks%check(orbit%distance > 1.0e-3_dp, 'the motion was not there yet')
      scene%solver%periods = 60
      call solve(scene, problem, choice, ending)
      call find_nodal_orbit(problem, choice, ending%nodal, 0.05_dp, later, outcome)
      call checks%check(outcome == orbit_found, 'it is found later too')
      if (outcome /= orbit_found) return
      call checks%check_close(abs(orbit%multipliers(1) - later%multipliers(1)), 0.0_dp, 0.01_dp, 'with the same multipliers')
      call checks%check_close(orbit%state(1)/later%state(1), 1.0_dp, 1.0e-3_dp, 'and the same film')
   end subroutine test_periodic_motion

   !> A motion that has only begun is near no periodic one.
   subroutine test_none_near(checks)
      type(check_list_t), intent(inout) :: checks
      type(problem_t) :: problem
      type(nodal_choice_t) :: choice
      type(ending_t) :: ending
      type(periodic_orbit_t) :: orbit
      integer :: outcome

      call solve(gear_scene(viscosity_constant, 1), problem, choice, ending)
      call find_nodal_orbit(problem, choice, ending%nodal, 1.0e-7_dp, orbit, outcome)
      call checks%check(outcome == orbit_none_near .and. orbit%period == 0, 'none is nearer than steps are exact')
   end subroutine test_none_near

   !> Once the time of a scene is over, no period is begun any more to learn of its motion, and it is said so.
   subroutine test_out_of_time(checks)
      type(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene
      type(problem_t) :: problem
      type(nodal_choice_t) :: choice
      type(ending_t) :: ending, again
      type(periodic_orbit_t) :: orbit
      type(nodal_neighbours_t) :: followed
      type(parting_t) :: parting(1)
      type(path_t) :: path(1)
      type(scene_group_t) :: group
      type(window_keeper_t) :: keeper
      type(window_record_t) :: record
      type(counting_watcher_t) :: watcher
      type(checkpoint_t) :: checkpoint
      type(error_t), allocatable :: error
      integer :: outcome

      scene = gear_scene(viscosity_constant, 1)
      call solve(scene, problem, choice, ending)
      call checks%check(.not. choice%ends_at < huge(1.0_dp), 'without a limit there is no end')
      scene%solver%time_limit = 1.0e6_dp
      call solve(scene, problem, choice, ending)
      call checks%check(abs(choice%ends_at - wall_seconds() - 1.0e6_dp) < 1.0e5_dp, 'the end is the limit from now')
      choice%ends_at = wall_seconds() - 1.0_dp
      call find_nodal_orbit(problem, choice, ending%nodal, 1.0e-2_dp, orbit, outcome)
      call checks%check(outcome == orbit_out_of_time .and. orbit%period == 0, 'no periodic motion is looked for')
      call checks%check(index(orbit_sentence(outcome), 'solver.time_limit was over') > 0, 'and it is said why')
      followed = beside_nodal_neighbour(problem, choice, ending%nodal)
      call follow_neighbours(followed, is_enough, parting, path)
      call checks%check(parting(1)%out_of_time .and. parting(1)%periods == 0 .and. .not. parting(1)%for_good, &
                        'no neighbour is followed')
      call checks%check(index(doubt_sentence(doubt_t(doubt_parting, parting=parting(1))), 'solver.time_limit was over') > 0, &
                        'and it is said of an irregular motion')
      call solve_finer(prepare(scene), choice, group)
      call checks%check(group%endings(1)%status == status_time_limit .and. group%endings(1)%periods == 0, 'nor is it solved again')
      scene%solver%periods = 2
      scene%solver%time_limit = 0.0_dp
      call keeper%keep_windows_of(problem)
      call solve_in_nodes(problem, choice, request_of(scene), keeper, watcher, checkpoint, again, record, error)
      call checks%check(again%status == status_time_limit .and. again%periods == 1, 'nor goes another solution on')
   end subroutine test_out_of_time

end module test_nodal_orbit
