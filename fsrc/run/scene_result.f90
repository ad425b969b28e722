!> What a solved scene amounts to: how it ended, its window, class and regime.
module scene_result
   use integrate_motion, only: motion_end_t
   use kinds, only: dp
   use rattle_class, only: classify, rattle_verdict_t
   use regime_check, only: check_regime, regime_verdict_t
   use resolved_scene, only: resolved_scene_t
   use sample_recorder, only: sample_recorder_t
   use scene_status, only: is_success
   use scene_types, only: scene_t
   implicit none(type, external)
   private

   !> Result of a scene. The window and what is judged from it exist only after a complete run.
   type, public :: scene_result_t
      type(motion_end_t) :: ending
      logical :: judged = .false.
      !> Extremes over the samples of the window [m], [m/s2]
      real(dp) :: film_minimum = 0.0_dp, film_maximum = 0.0_dp
      real(dp) :: acceleration_minimum = 0.0_dp, acceleration_maximum = 0.0_dp
      type(rattle_verdict_t) :: rattle
      type(regime_verdict_t) :: regime
      !> Cost of solving and of judging [s]
      real(dp) :: solve_seconds = 0.0_dp, judge_seconds = 0.0_dp
   end type scene_result_t

   public :: judge

contains

   !> Judge the window of a motion.
   subroutine judge(scene, resolved, recorder, result)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What follows from it
      type(resolved_scene_t), intent(in) :: resolved
      !> Its samples
      type(sample_recorder_t), intent(in) :: recorder
      !> Result with its ending, completed
      type(scene_result_t), intent(inout) :: result

      result%judged = is_success(result%ending%status)
      if (.not. result%judged) return
      result%film_minimum = minval(recorder%films)
      result%film_maximum = maxval(recorder%films)
      result%acceleration_minimum = minval(recorder%accelerations)
      result%acceleration_maximum = maxval(recorder%accelerations)
      call classify(recorder%accelerations, scene%spectrum, resolved%noise_floor, result%rattle)
      result%regime = check_regime(resolved%film, scene%film%law, recorder%films, recorder%velocities)
   end subroutine judge

end module scene_result
