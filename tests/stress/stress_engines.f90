!> Every engine on a group of scenes, with the outcomes.
module stress_engines
   use engine, only: ending_t, motion_state_t, request_t, start_of
   use kinds, only: dp
   use many_motions, only: solve_motions
   use problem, only: of_film, of_velocity
   use random_scenes, only: drawn_scene_t, group_t
   use scene_types, only: method_taylor, scene_t, until_periods, until_steady
   use stress_outcomes, only: judge_controlled, outcome_t
   use stress_references, only: compared_periods, compared_samples, comparisons, reference_t
   implicit none(type, external)
   private

   integer, parameter, public :: engines = 3
   character(*), parameter, public :: engine_names(engines) = [character(20) :: 'taylor', 'collocation', 'taylor until steady']

   public :: run_engine, set_solver

contains

   !> Solve a group by one engine.
   subroutine run_engine(engine, group, drawn, references, results)
      !> Place in `engine_names`
      integer, intent(in) :: engine
      !> The group
      type(group_t), intent(in) :: group
      !> Its scenes
      type(drawn_scene_t), intent(in) :: drawn(:)
      !> What they are compared with
      type(reference_t), intent(in) :: references(:)
      !> How they came out
      type(outcome_t), intent(out) :: results(:)
      type(request_t) :: request
      type(ending_t) :: endings(size(drawn))
      type(motion_state_t) :: starts(size(drawn))
      real(dp) :: states(comparisons, 2, size(drawn))
      integer :: i

      starts = start_of(drawn%resolved%problem)
      starts%implicit = engine == 2
      request%accuracy = group%accuracy
      request%periods = group%periods
      request%sampled_periods = compared_periods
      request%samples_per_period = compared_samples
      request%until_steady = engine == 3
      states(:, of_film, :) = -1.0_dp
      states(:, of_velocity, :) = 0.0_dp
      call solve_motions(drawn%resolved%problem, starts, request, states, endings)
      do i = 1, size(drawn)
         results(i) = judge_controlled(references(i), group%periods, group%accuracy, states(:, of_film, i), endings(i))
      end do
   end subroutine run_engine

   !> The solver of an engine.
   pure subroutine set_solver(engine, scene)
      !> Place in `engine_names`
      integer, intent(in) :: engine
      !> Gets it
      type(scene_t), intent(inout) :: scene

      associate (solver => scene%solver)
         solver%method = method_taylor
         solver%until = merge(until_steady, until_periods, engine == 3)
      end associate
   end subroutine set_solver

end module stress_engines
