!> What a solved scene amounts to: how it ended, its window, class and regime.
module scene_result
   use certificate, only: certificate_t
   use certify_scene, only: certify
   use fine_window, only: classify_window, solve_fine_window, window_t
   use integrate_motion, only: motion_end_t
   use kinds, only: dp
   use lane_scenes, only: lane_ending_t, lane_scene_t
   use newmark, only: motion_count_t
   use periodic_orbit, only: periodic_orbit_t
   use rattle_class, only: note_orbit, rattle_verdict_t
   use regime_check, only: check_regime, regime_verdict_t
   use resolved_scene, only: resolved_scene_t
   use sample_recorder, only: sample_recorder_t
   use scene_lane, only: lane_of_scene
   use scene_status, only: is_success
   use scene_types, only: method_newmark, scene_t
   implicit none(type, external)
   private

   !> Result of a scene. The window and what is judged from it exist only after a complete run.
   type, public :: scene_result_t
      type(motion_end_t) :: ending
      logical :: judged = .false.
      !> Extremes over the samples of the window [m], [m/s2]
      real(dp) :: film_minimum = 0.0_dp, film_maximum = 0.0_dp
      real(dp) :: acceleration_minimum = 0.0_dp, acceleration_maximum = 0.0_dp
      !> Whole periods of the window, and samples of each
      integer :: window_periods = 0, samples_per_period = 0
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
   subroutine judge(scene, resolved, recorder, result)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What follows from it
      type(resolved_scene_t), intent(in) :: resolved
      !> Its samples
      type(sample_recorder_t), intent(in) :: recorder
      !> Result with its ending, completed
      type(scene_result_t), intent(inout) :: result
      type(lane_scene_t) :: lane
      type(lane_ending_t) :: ending
      type(window_t) :: window

      result%judged = is_success(result%ending%status)
      if (.not. result%judged) return
      window%samples_per_period = scene%solver%samples_per_period()
      window%periods = size(recorder%films)/window%samples_per_period
      allocate (window%films, source=recorder%films)
      allocate (window%velocities, source=recorder%velocities)
      allocate (window%accelerations, source=recorder%accelerations)
      lane = lane_of_scene(scene, resolved%film, resolved%initial_film, scene%film%initial_velocity)
      call classify_window(scene, window, resolved%noise_floor, result%rattle)
      ! The samples of an error-controlled motion that repeats are free to be as many as its lines need.
      if (result%ending%orbit > 0 .and. scene%solver%method /= method_newmark .and. &
          .not. result%rattle%lines%sampling_sufficient) &
         call solve_fine_window(scene, lane, scene%solver%accuracy, result%ending%periods, resolved%noise_floor, window, &
                                result%rattle, ending)
      call note_orbit(result%rattle, result%ending%orbit)
      result%window_periods = window%periods
      result%samples_per_period = window%samples_per_period
      result%film_minimum = minval(window%films)
      result%film_maximum = maxval(window%films)
      result%acceleration_minimum = minval(window%accelerations)
      result%acceleration_maximum = maxval(window%accelerations)
      result%regime = check_regime(resolved%film, scene%film%law, window%films, window%velocities)
      if (scene%spectrum%certify) call certify(scene, resolved, lane, result%ending%periods, window, result%rattle, &
                                               result%certificate, result%orbit)
   end subroutine judge

   !> Evaluations of the film per step of a motion, 0 without a step.
   pure real(dp) function passes_per_step(count)
      !> Cost of the motion
      type(motion_count_t), intent(in) :: count

      passes_per_step = 0.0_dp
      if (count%steps > 0) passes_per_step = real(count%evaluations, dp)/real(count%steps, dp)
   end function passes_per_step

end module scene_result
