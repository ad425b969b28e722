!> A single scene whose films are solved in nodes of pressure: how it is followed, the periodic motion next to its end, and its
!> verification by twice as many nodes and a tighter tolerance.
module nodal_judgement
   use carried_loads, only: films_of
   use classify_group, only: classify_windows, follow_beside_neighbours, integral_record
   use clock, only: wall_seconds
   use constants, only: pi
   use controlled_engine, only: solve_window
   use doubt, only: doubt_second_ending, doubt_t
   use engine, only: checkpoint_t, ending_t, motion_watcher_t, start_of, unwatched_t
   use errors, only: error_t
   use kinds, only: dp
   use nodal_engine, only: solve_in_nodes
   use nodal_neighbours, only: beside_nodal_neighbour, nodal_neighbours_t
   use nodal_orbit, only: find_nodal_orbit
   use nodal_profiles, only: nodal_profiles_t
   use nodal_step, only: is_late, nodal_choice_t
   use node_extremes, only: seen_films, seen_loads, seen_net_load, seen_pressure
   use periodic_orbit, only: attracting_period
   use prepared_scene, only: prepared_scene_t
   use problem, only: largest_applied_force, problem_t
   use rattle_class, only: class_irregular_so_far, classify_steps, note_known, note_orbit
   use scene_group, only: scene_group_t, take_window
   use scene_orbit, only: orbit_nearness
   use scene_status, only: is_success, status_time_limit
   use text_output, only: lock_texts, unlock_texts
   use verification, only: compare_windows, no_verification, note_impact_errors, note_severity_errors, &
      verification_t
   use vibration_severity, only: severity_of_record
   use window_extremes, only: extremes_of_record
   use window_impacts, only: agreement_of, impacts_of_record
   use window_keeper, only: window_keeper_t
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Share of the accuracy that is the tolerance of a step, which errors of flights grow from, and the least tolerance
   real(dp), parameter :: tolerance_share = 0.005_dp, least_tolerance = 2.0e-7_dp
   !> Bound of bending, beyond which films are solved in nodes: the accuracy, but no more than one percent (ten of alpha p), and no
   !> less than what some nodes resolve
   real(dp), parameter :: largest_bound = 1.0e-2_dp, nodes_of_that = 32.0_dp
   !> S of the grid over the width of the widest contact, sqrt(2 H + 8 M/pi)
   real(dp), parameter :: width_factor = 1.6_dp
   !> Motion by the closure that gives the widest contact: its accuracy, and most periods of it
   real(dp), parameter :: closure_accuracy = 1.0e-5_dp
   integer, parameter :: closure_periods = 12, closure_samples = 64
   !> How much finer a verification is: nodes, and the tolerance
   integer, parameter :: more_nodes = 2
   real(dp), parameter :: tighter = 0.3_dp
   !> Error of a finer solution in nodes, in the unit that module verification multiplies by ten, over the accuracy of the scene
   real(dp), parameter :: finer_share = 0.03_dp

   public :: choice_of, solve_nodal_scene, solve_finer, follow_in_nodes, verify_in_nodes

contains

   !> How a scene is followed. A motion by the closure shows how wide its contacts become.
   subroutine choice_of(scene, choice)
      type(prepared_scene_t), intent(in) :: scene
      type(nodal_choice_t), intent(out) :: choice
      type(problem_t) :: by_closure
      type(ending_t) :: ending
      type(window_record_t) :: record
      real(dp), allocatable :: states(:, :), values(:)
      real(dp) :: film, load
      integer :: periods

      associate (problem => scene%resolved%problem, request => scene%request, oil => scene%resolved%problem%contact%film%closure)
         if (request%time_limit > 0.0_dp) choice%ends_at = wall_seconds() + request%time_limit
         choice%nodes = scene%nodes
         choice%tolerance = max(tolerance_share*request%accuracy, least_tolerance)
         choice%bound = min(largest_bound, max(request%accuracy, largest_bound*(nodes_of_that/real(choice%nodes, dp))**3))
         by_closure = problem
         by_closure%contact%film%in_nodes = .false.
         ! As many of any run, so that one that is carried on has the same grid.
         periods = closure_periods
         film = problem%initial_film
         load = largest_applied_force(problem)
         call solve_window(by_closure, start_of(by_closure), closure_accuracy, closure_samples, periods, periods, states, values, &
                           ending, record)
         if (is_success(ending%status)) then
            film = record%lowest(seen_films(1))%value
            ! The net load is as far below zero as the other film pushes back.
            load = max(record%highest(seen_loads(1))%value, -record%lowest(seen_net_load)%value)
         end if
         choice%scale = width_factor*sqrt(2.0_dp*film/oil%film_unit + 8.0_dp/pi*load/oil%load_unit)
      end associate
   end subroutine choice_of

   !> Solve a scene; its window, with Fourier integrals, becomes that of the group: samples would have to be solved for once more.
   subroutine solve_nodal_scene(scene, choice, keeper, watcher, checkpoint, group, error, profiles)
      type(prepared_scene_t), intent(in) :: scene
      !> How it is followed
      type(nodal_choice_t), intent(in) :: choice
      !> Takes the samples
      class(window_keeper_t), intent(inout) :: keeper
      !> Informed of progress
      class(motion_watcher_t), intent(inout) :: watcher
      !> State to carry on from, and then the one from which the run can be extended
      type(checkpoint_t), intent(inout) :: checkpoint
      type(scene_group_t), intent(inout) :: group
      !> Set if the samples could not be kept
      type(error_t), allocatable, intent(out) :: error
      !> What is asked for of pressures and films over the contact, and then those of the window
      type(nodal_profiles_t), intent(inout), optional :: profiles
      type(ending_t) :: ending
      type(window_record_t) :: record

      record = integral_record(scene%spectrum)
      record%wants = .true.
      record%loads%impact_limit = scene%request%impact_limit
      call solve_in_nodes(scene%resolved%problem, choice, scene%request, keeper, watcher, checkpoint, ending, record, error, &
                          profiles)
      call take_window(keeper%states, keeper%accelerations, ending, record, group)
   end subroutine solve_nodal_scene

   !> The last periods of a scene, solved finer, unless the time of the scene is over. Without it the group has no window.
   subroutine solve_finer(scene, choice, group)
      type(prepared_scene_t), intent(in) :: scene
      !> How it was followed
      type(nodal_choice_t), intent(in) :: choice
      !> The finer solution
      type(scene_group_t), intent(inout) :: group
      type(prepared_scene_t) :: again
      type(checkpoint_t) :: state
      type(nodal_choice_t) :: finer
      type(window_keeper_t) :: keeper
      type(unwatched_t) :: unwatched
      type(error_t), allocatable :: error

      if (is_late(choice)) then
         call take_window(keeper%states, keeper%accelerations, ending_t(status=status_time_limit), window_record_t(), &
                          group)
         return
      end if
      finer = choice
      finer%nodes = more_nodes*choice%nodes
      finer%tolerance = tighter*choice%tolerance
      finer%bound = tighter*choice%bound
      again = scene
      again%request%until_steady = .false.
      call keeper%keep_windows_of(scene%resolved%problem)
      call unlock_texts()
      call solve_nodal_scene(again, finer, keeper, unwatched, state, group, error)
      call lock_texts()
   end subroutine solve_finer

   !> Find the periodic motion that a motion in nodes ends near, and of one that is off its harmonics whether it repeats or neighbours
   !> part from it.
   subroutine follow_in_nodes(scene, choice, group, outcome)
      type(prepared_scene_t), intent(in) :: scene
      !> How it was followed
      type(nodal_choice_t), intent(in) :: choice
      !> The classified scene
      type(scene_group_t), intent(inout) :: group
      !> Whether a periodic motion was found, and why not, as of module nodal_orbit
      integer, intent(out) :: outcome
      type(nodal_neighbours_t) :: followed

      associate (problem => scene%resolved%problem, orbit => group%orbits(1), verdict => group%verdicts(1), &
                 ending => group%endings(1))
         call unlock_texts()
         call find_nodal_orbit(problem, choice, ending%nodal, orbit_nearness, orbit, outcome)
         if (verdict%class == class_irregular_so_far .and. orbit%period > 0) group%repeat_after(1) = orbit%period
         call note_orbit(verdict, attracting_period(orbit))
         call lock_texts()
         if (verdict%class /= class_irregular_so_far) return
         followed = beside_nodal_neighbour(problem, choice, ending%nodal)
         call follow_beside_neighbours([scene], [1], followed, group)
      end associate
   end subroutine follow_in_nodes

   !> Verification of a scene that is not irregular by twice as many nodes and a tighter tolerance. Its window need not close to the
   !> last digits, as its steps are of third order.
   subroutine verify_in_nodes(scene, choice, group, tight, verification, error)
      type(prepared_scene_t), intent(in) :: scene
      !> How it was followed
      type(nodal_choice_t), intent(in) :: choice
      !> The scene with its class
      type(scene_group_t), intent(in) :: group
      !> Work space: the finer solution
      type(scene_group_t), intent(inout) :: tight
      type(verification_t), intent(out) :: verification
      !> Set if there is no memory for the samples that a class needs
      type(error_t), allocatable, intent(out) :: error
      real(dp) :: accuracy, pressures(2)

      call solve_finer(scene, choice, tight)
      if (.not. is_success(tight%endings(1)%status)) then
         verification = no_verification(doubt_t(doubt_second_ending, counts=[tight%endings(1)%status, 0]))
         return
      end if
      call classify_windows([scene], tight, error)
      if (allocated(error)) return
      associate (problem => scene%resolved%problem, verdict => group%verdicts(1), finer_verdict => tight%verdicts(1), &
                 record => group%records(1), finer => tight%records(1))
         if (group%classified_by(1) == 0 .and. tight%classified_by(1) > 0) &
            call classify_steps(finer, problem%frequency, scene%spectrum, scene%resolved%noise_floor, finer_verdict)
         call note_orbit(finer_verdict, group%repeat_after(1))
         call note_known(finer_verdict, verdict)
         accuracy = finer_share*scene%request%accuracy
         ! Of the films their extremes count: where one falls by decades in an impact, a millionth of a period is a third of it.
         call compare_windows(spread(minval(films_of(problem, group%states(:, :, 1)), dim=1), 1, 1), &
                              spread(minval(films_of(problem, tight%states(:, :, 1)), dim=1), 1, 1), extremes_of_record(record), &
                              extremes_of_record(finer), verdict, finer_verdict, doubt_t(), scene%spectrum, &
                              scene%spectrum%verification_tolerance, accuracy, 0.0_dp, verification)
         verification%impacts = agreement_of(problem, extremes_of_record(record), impacts_of_record(record, problem%frequency), &
                                             extremes_of_record(finer), impacts_of_record(finer, problem%frequency), &
                                             group%repeat_after(1) > scene%request%sampled_periods)
         call note_severity_errors(severity_of_record(record, problem%frequency), &
                                   severity_of_record(finer, problem%frequency), accuracy, verification)
         call note_impact_errors(impacts_of_record(record, problem%frequency), impacts_of_record(finer, problem%frequency), &
                                 verification)
         pressures = [record%highest(seen_pressure)%value, finer%highest(seen_pressure)%value]
         verification%pressure_error = 2.0_dp*abs(pressures(1) - pressures(2))/minval(pressures)
      end associate
   end subroutine verify_in_nodes

end module nodal_judgement
