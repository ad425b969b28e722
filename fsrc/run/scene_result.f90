!> What a solved scene amounts to: how it ended, its window, class and regime.
module scene_result
   use certificate, only: certificate_t
   use certify_scene, only: certify
   use errors, only: error_t
   use fine_window, only: classify_window, judge_window, window_t
   use integrate_motion, only: motion_end_t
   use kinds, only: dp
   use lane_scenes, only: lane_scene_t
   use newmark, only: motion_count_t
   use node_extremes, only: seen_film, seen_pressure
   use periodic_orbit, only: periodic_orbit_t
   use rattle_class, only: note_orbit, rattle_verdict_t
   use regime_check, only: check_regime, model_limit, regime_verdict_t, within_model
   use resolved_scene, only: resolved_scene_t
   use sample_recorder, only: sample_recorder_t
   use scene_lane, only: lane_of_scene
   use scene_status, only: is_success
   use scene_types, only: scene_t
   use signals, only: must_stop
   use window_extremes, only: extremes_of_record, extremes_of_samples, window_extremes_t
   implicit none(type, external)
   private

   !> Result of a scene. The window and what is judged from it exist only after a complete run.
   type, public :: scene_result_t
      type(motion_end_t) :: ending
      logical :: judged = .false.
      !> Extremes of the window
      type(window_extremes_t) :: extremes
      !> Code of model_limits
      integer :: model_limit = within_model
      !> Whole periods of the window, samples of each, and whether its lines are integrals over the steps
      integer :: window_periods = 0, samples_per_period = 0
      logical :: lines_by_integrals = .false.
      !> Whether the samples of the scene are too few for its motion
      logical :: series_coarse = .false.
      type(rattle_verdict_t) :: rattle
      type(regime_verdict_t) :: regime
      type(certificate_t) :: certificate
      type(periodic_orbit_t) :: orbit
      !> Cost of solving and of judging [s]
      real(dp) :: solve_seconds = 0.0_dp, judge_seconds = 0.0_dp
   end type scene_result_t

   public :: judge, passes_per_step

contains

   !> Judge the window of a motion.
   subroutine judge(scene, resolved, recorder, result, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What follows from it
      type(resolved_scene_t), intent(in) :: resolved
      !> Its samples
      type(sample_recorder_t), intent(in) :: recorder
      !> Result with its ending, completed
      type(scene_result_t), intent(inout) :: result
      !> Set if there is not enough memory; nothing is judged then
      type(error_t), allocatable, intent(out) :: error
      type(lane_scene_t) :: lane
      type(window_t) :: window

      result%judged = is_success(result%ending%status)
      if (.not. result%judged) return
      window%samples_per_period = scene%solver%samples_per_period()
      window%periods = size(recorder%films)/window%samples_per_period
      allocate (window%films, source=recorder%films)
      allocate (window%velocities, source=recorder%velocities)
      allocate (window%accelerations, source=recorder%accelerations)
      lane = lane_of_scene(scene, resolved%film, resolved%initial_film, scene%film%initial_velocity)
      window%record = result%ending%record
      call classify_window(scene, lane, window%periods, window%accelerations, window%record, resolved%noise_floor, result%rattle)
      ! A signal ends the verdict on a long window here, between two stretches of some seconds.
      result%judged = .not. must_stop()
      if (.not. result%judged) return
      result%series_coarse = .not. result%rattle%lines%sampling_sufficient
      ! What the error-controlled engine has solved can be solved again, sampled finer, from where the window begins.
      if (result%series_coarse .and. window%record%periods > 0) &
         call judge_window(scene, lane, scene%solver%accuracy, resolved%noise_floor, window, result%rattle, error)
      result%judged = .not. allocated(error)
      if (.not. result%judged) return
      call note_orbit(result%rattle, result%ending%orbit)
      result%window_periods = window%periods
      result%samples_per_period = window%samples_per_period
      result%lines_by_integrals = window%by_integrals
      if (window%record%periods > 0) then
         result%extremes = extremes_of_record(result%ending%record)
      else
         result%extremes = extremes_of_samples(resolved%film, window%films, window%velocities, window%accelerations)
      end if
      associate (lowest => result%extremes%lowest, highest => result%extremes%highest)
         result%model_limit = model_limit(lowest(seen_film)%value, highest(seen_film)%value, resolved%film%radius)
         result%regime = check_regime(resolved%film, highest(seen_pressure)%value, highest(seen_pressure)%film)
      end associate
      if (scene%spectrum%certify) call certify(scene, resolved, lane, result%ending%periods, window, result%extremes, &
                                               result%rattle, result%certificate, error, result%orbit)
      result%judged = .not. allocated(error)
   end subroutine judge

   !> Evaluations of the film per step of a motion, 0 without a step.
   pure real(dp) function passes_per_step(count)
      !> Cost of the motion
      type(motion_count_t), intent(in) :: count

      passes_per_step = 0.0_dp
      if (count%steps > 0) passes_per_step = real(count%evaluations, dp)/real(count%steps, dp)
   end function passes_per_step

end module scene_result
