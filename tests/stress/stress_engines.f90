!> Every engine on a group of scenes, with the outcomes.
module stress_engines
   use film_law, only: film_load
   use kinds, only: dp
   use lane_motions, only: solve_motions
   use lane_scenes, only: lane_ending_t, lane_request_t, lane_scene_t
   use newmark, only: motion_count_t, motion_state_t, start_motion
   use newmark_extrapolated, only: advance_extrapolated, extrapolation_t, new_extrapolation
   use newmark_lanes, only: newmark_lane_scene_t
   use newmark_lanes_extrapolated, only: extrapolated_ending_t, solve_lanes_extrapolated
   use random_scenes, only: drawn_scene_t, group_t
   use scene_status, only: status_complete
   use scene_types, only: iteration_newton, method_newmark_extrapolated, method_taylor, predictor_extrapolated, scene_t, &
                          until_periods, until_steady
   use stress_outcomes, only: judge_controlled, outcome_t
   use stress_references, only: compared_periods, compared_samples, comparisons, reference_t
   implicit none(type, external)
   private

   !> The first three are solved in long runs too.
   integer, parameter, public :: engines = 5, long_engines = 3
   character(*), parameter, public :: engine_names(engines) = [character(30) :: &
      'taylor', 'collocation', 'taylor until steady', 'newmark-extrapolated', 'newmark-extrapolated, lanes']
   integer, parameter :: extrapolated = 4, lanes_extrapolated = 5

   public :: newmark_scene, run_engine, set_solver, takes_part

contains

   !> Whether an engine solves a group: the extrapolated ones cost so much that they solve some.
   pure logical function takes_part(engine, group)
      !> Place in `engine_names`
      integer, intent(in) :: engine
      !> The group
      type(group_t), intent(in) :: group

      takes_part = group%extrapolated .or. (engine /= extrapolated .and. engine /= lanes_extrapolated)
   end function takes_part

   !> Solve a group by one engine.
   subroutine run_engine(engine, group, drawn, references, results)
      !> Place in `engine_names`
      integer, intent(in) :: engine
      !> The group
      type(group_t), intent(in) :: group
      !> Its scenes
      type(drawn_scene_t), intent(in) :: drawn(:)
      !> What they are held against
      type(reference_t), intent(in) :: references(:)
      !> How they came out
      type(outcome_t), intent(out) :: results(:)

      if (engine <= long_engines) then
         call run_controlled(engine, group, drawn, references, results)
      else if (engine == extrapolated) then
         call run_extrapolated(group, drawn, references, results)
      else
         call run_lanes_extrapolated(group, drawn, references, results)
      end if
   end subroutine run_engine

   !> The error-controlled engines.
   subroutine run_controlled(engine, group, drawn, references, results)
      integer, intent(in) :: engine
      type(group_t), intent(in) :: group
      type(drawn_scene_t), intent(in) :: drawn(:)
      type(reference_t), intent(in) :: references(:)
      type(outcome_t), intent(out) :: results(:)
      type(lane_request_t) :: request
      type(lane_ending_t) :: endings(size(drawn))
      type(lane_scene_t) :: scenes(size(drawn))
      real(dp), dimension(comparisons, size(drawn)) :: films, velocities
      integer :: i

      scenes = drawn%lane
      scenes%implicit = engine == 2
      request%accuracy = group%accuracy
      request%periods = group%periods
      request%sampled_periods = compared_periods
      request%samples_per_period = compared_samples
      request%until_steady = engine == 3
      films = -1.0_dp
      velocities = 0.0_dp
      call solve_motions(scenes, request, films, velocities, endings)
      do i = 1, size(drawn)
         results(i) = judge_controlled(references(i), group%periods, group%accuracy, films(:, i), endings(i))
      end do
   end subroutine run_controlled

   !> Newmark's method extrapolated interval by interval, scene by scene.
   subroutine run_extrapolated(group, drawn, references, results)
      type(group_t), intent(in) :: group
      type(drawn_scene_t), intent(in) :: drawn(:)
      type(reference_t), intent(in) :: references(:)
      type(outcome_t), intent(out) :: results(:)
      type(newmark_lane_scene_t) :: scene
      type(extrapolation_t) :: extrapolation
      type(motion_state_t) :: state
      type(motion_count_t) :: count
      type(lane_ending_t) :: ending
      real(dp) :: films(comparisons)
      real(dp), dimension(compared_samples) :: velocities, accelerations
      integer :: i, period, first, done

      do i = 1, size(drawn)
         scene = newmark_scene(drawn(i))
         extrapolation = new_extrapolation(group%accuracy, compared_samples)
         count = motion_count_t()
         ending = lane_ending_t()
         call start_motion(film_load, scene%film, scene%method, scene%thickness, scene%velocity, state, &
                           count, ending%status)
         films = -1.0_dp
         do period = 1, group%periods
            if (ending%status /= status_complete) exit
            first = max(0, period - 1 - group%periods + compared_periods)*compared_samples + 1
            call advance_extrapolated(film_load, scene%film, scene%method, extrapolation, state, count, &
                                      films(first:first + compared_samples - 1), velocities, accelerations, &
                                      done, &
                                      ending%status)
         end do
         ending%film = state%film
         ending%velocity = state%velocity
         ending%steps = count%steps
         ending%samples = comparisons
         results(i) = judge_controlled(references(i), group%periods, group%accuracy, films, ending)
      end do
   end subroutine run_extrapolated

   !> Newmark's method extrapolated over whole motions, in lanes.
   subroutine run_lanes_extrapolated(group, drawn, references, results)
      type(group_t), intent(in) :: group
      type(drawn_scene_t), intent(in) :: drawn(:)
      type(reference_t), intent(in) :: references(:)
      type(outcome_t), intent(out) :: results(:)
      type(newmark_lane_scene_t) :: scenes(size(drawn))
      type(extrapolated_ending_t) :: endings(size(drawn))
      type(lane_ending_t) :: ending
      real(dp), dimension(comparisons, size(drawn)) :: films, velocities, accelerations
      integer :: i

      do i = 1, size(drawn)
         scenes(i) = newmark_scene(drawn(i))
      end do
      films = -1.0_dp
      velocities = 0.0_dp
      accelerations = 0.0_dp
      call solve_lanes_extrapolated(scenes, group%accuracy, group%periods, compared_periods, &
                                    compared_samples, films, &
                                    velocities, accelerations, endings)
      do i = 1, size(drawn)
         ending = lane_ending_t(status=endings(i)%status, film=films(comparisons, i), &
                                velocity=velocities(comparisons, i), &
                                samples=comparisons, steps=endings(i)%steps)
         results(i) = judge_controlled(references(i), group%periods, group%accuracy, films(:, i), ending)
      end do
   end subroutine run_lanes_extrapolated

   !> A scene for Newmark's method.
   pure function newmark_scene(drawn) result(scene)
      !> The scene
      type(drawn_scene_t), intent(in) :: drawn
      type(newmark_lane_scene_t) :: scene

      scene%film = drawn%resolved%film
      scene%thickness = drawn%lane%initial_film
      scene%velocity = drawn%lane%initial_velocity
      scene%method%mass = drawn%lane%mass
      scene%method%weight = drawn%lane%weight
      scene%method%steady_force = drawn%lane%steady_force
      scene%method%force_amplitude = drawn%lane%force_amplitude
      scene%method%frequency = drawn%lane%frequency
      associate (solver => drawn%scene%solver)
         scene%method%tolerance = solver%tolerance
         scene%method%iteration_limit = solver%iteration_limit
         scene%method%by_newton = solver%iteration == iteration_newton
         scene%method%extrapolate = solver%predictor == predictor_extrapolated
      end associate
   end function newmark_scene

   !> The solver of an engine.
   pure subroutine set_solver(engine, scene)
      !> Place in `engine_names`
      integer, intent(in) :: engine
      !> Gets it
      type(scene_t), intent(inout) :: scene

      associate (solver => scene%solver)
         solver%method = merge(method_taylor, method_newmark_extrapolated, engine <= long_engines)
         solver%until = merge(until_steady, until_periods, engine == 3)
      end associate
   end subroutine set_solver

end module stress_engines
