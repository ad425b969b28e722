!> Judges a solved scene: its window, class and regime, and how far they can be trusted.
module judge_scene
   use verify_scene, only: verify_in_nodes, verify_motion
   use controlled_engine, only: solve_window
   use engine, only: ending_t
   use errors, only: error_t
   use finer_windows, only: may_be_finer
   use force_signal, only: has_enough_samples, signal_of_window
   use fine_window, only: judge_window, window_t
   use irregular_motion, only: follow_irregular
   use judged_scene, only: judged_scene_t
   use vibration_severity, only: severity_of_record, severity_of_samples
   use kinds, only: dp
   use memory_need, only: expect_window_memory
   use node_extremes, only: seen_pressure
   use lyapunov, only: parting_t
   use nodal_orbit, only: find_nodal_orbit, follow_nodal_neighbours
   use periodic_orbit, only: attracting_period
   use carried_loads, only: thinnest_film
   use problem, only: of_velocity
   use rattle_class, only: class_irregular_so_far, classify_steps, note_orbit, note_parting, rattle_verdict_t
   use regime_check, only: check_regime
   use sample_recorder, only: sample_recorder_t
   use scene_orbit, only: orbit_nearness
   use scene_status, only: is_success, status_steady
   use scene_types, only: model_resolved, scene_t
   use signals, only: must_stop
   use text_output, only: lock_texts, unlock_texts
   use window_class, only: classify_window
   use window_extremes, only: extremes_of_record, extremes_of_samples
   use window_impacts, only: impacts_of_record, impacts_of_samples
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   public :: note_ending, judge, note_record, note_regime, follow_one

contains

   !> Note how a motion ended.
   pure subroutine note_ending(ending, judged)
      type(ending_t), intent(in) :: ending
      type(judged_scene_t), intent(inout) :: judged

      judged%status = ending%status
      judged%time = ending%time
      judged%film = ending%film
      judged%lost_film = ending%lost_film
      judged%lost_load = ending%lost_load
      judged%periods = ending%periods
      judged%repeats_after = ending%orbit
      judged%count = ending%count
   end subroutine note_ending

   !> Judge the window of a motion.
   subroutine judge(scene, recorder, record, ending, judged, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Samples of the window
      type(sample_recorder_t), intent(in) :: recorder
      !> What the steps tell of it; no periods: the samples are all that is known
      type(window_record_t), intent(in) :: record
      !> How the motion ended
      type(ending_t), intent(in) :: ending
      !> With what follows from the scene and how it ended; the verdict is added
      type(judged_scene_t), intent(inout) :: judged
      !> Set if there is not enough memory; nothing is judged then
      type(error_t), allocatable, intent(out) :: error
      type(window_t) :: window

      judged%judged = is_success(judged%status)
      if (.not. judged%judged) return
      window%samples_per_period = scene%solver%samples_per_period()
      window%periods = size(recorder%accelerations)/window%samples_per_period
      window%classified_by = window%samples_per_period
      allocate (window%states, source=recorder%states)
      allocate (window%accelerations, source=recorder%accelerations)
      window%record = record
      call classify_window(scene%spectrum, judged%resolved%problem, window%periods, window%accelerations, window%record, &
                           judged%resolved%noise_floor, judged%rattle)
      ! A signal ends the verdict on a long window here, between two stretches of some seconds.
      judged%judged = .not. must_stop()
      if (.not. judged%judged) return
      judged%series_coarse = .not. judged%rattle%spectrum%sampling_sufficient
      ! What the error-controlled engine has solved can be solved again, sampled finer, from where the window begins.
      if (judged%series_coarse .and. scene%film%model == model_resolved) then
         call classify_steps(window%record, judged%resolved%problem%frequency, scene%spectrum, judged%resolved%noise_floor, &
                             judged%rattle)
         window%classified_by = 0
      else if (judged%series_coarse .and. window%record%periods > 0) then
         call judge_window(scene, judged%resolved%problem, scene%solver%accuracy, judged%resolved%noise_floor, window, &
                           judged%rattle, error)
      end if
      judged%judged = .not. allocated(error)
      if (.not. judged%judged) return
      call note_orbit(judged%rattle, judged%repeats_after)
      if (scene%film%model == model_resolved) then
         call follow_in_nodes(scene%spectrum%verify, ending, judged)
      else
         call follow_one(ending, judged)
      end if
      judged%judged = .not. must_stop()
      if (.not. judged%judged) return
      judged%window_periods = window%periods
      judged%harmonics_by_integrals = window%classified_by == 0
      judged%samples_per_period = merge(window%samples_per_period, window%classified_by, judged%harmonics_by_integrals)
      if (window%record%periods > 0) then
         call note_record(record, judged)
      else
         judged%extremes = extremes_of_samples(judged%resolved%problem, window%states, &
                                               window%accelerations)
         judged%severity = severity_of_samples(judged%resolved%problem, window%samples_per_period, window%states(:, of_velocity), &
                                               window%accelerations)
         judged%impacts = impacts_of_samples(judged%resolved%problem, scene%spectrum%impact_limit, window%samples_per_period, &
                                             window%states)
      end if
      if (scene%gearbox /= '') call note_film_force(scene, window, judged)
      call note_regime(judged)
      if (scene%spectrum%verify .and. scene%film%model == model_resolved) then
         call verify_in_nodes(scene, judged%resolved, judged%nodal, judged%periods, judged%repeats_after, window, &
                              judged%extremes, judged%severity, judged%impacts, judged%rattle, judged%verification)
      else if (scene%spectrum%verify) then
         call verify_motion(scene, judged%resolved, ending, judged%repeats_after, window, judged%extremes, judged%severity, &
                            judged%impacts, judged%rattle, judged%verification, judged%orbit, error)
      end if
      judged%judged = .not. allocated(error)
   end subroutine judge

   !> Note what the steps of a window tell.
   pure subroutine note_record(record, judged)
      !> Record of the window
      type(window_record_t), intent(in) :: record
      !> With what follows from the scene; extremes, severity and impacts are added
      type(judged_scene_t), intent(inout) :: judged

      associate (frequency => judged%resolved%problem%frequency)
         judged%extremes = extremes_of_record(record)
         judged%severity = severity_of_record(record, frequency)
         judged%impacts = impacts_of_record(record, frequency)
      end associate
   end subroutine note_record

   !> Note the force of a pair of a gearbox, from as many samples as have the power that the steps tell, where there may be so many.
   subroutine note_film_force(scene, window, judged)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Its window
      type(window_t), intent(in) :: window
      !> With severity and class; the force is added
      type(judged_scene_t), intent(inout) :: judged
      type(window_record_t) :: record
      type(ending_t) :: ending
      type(error_t), allocatable :: short_of_memory
      real(dp), allocatable :: states(:, :), accelerations(:)
      !> Share of the power of a force by which its samples may miss that of the steps
      real(dp), parameter :: missed_power = 1.0e-6_dp
      integer :: samples_per_period

      accelerations = window%accelerations
      samples_per_period = window%samples_per_period
      do
         judged%film_force = signal_of_window(judged%resolved%problem, accelerations, window%periods, judged%periods, &
                                              judged%status == status_steady, judged%severity%film_force_rms)
         if (has_enough_samples(judged%film_force, missed_power) .or. scene%film%model == model_resolved) return
         if (.not. may_be_finer(window%record, window%periods, samples_per_period)) return
         samples_per_period = 2*samples_per_period
         call expect_window_memory(samples_per_period*window%periods, short_of_memory)
         if (allocated(short_of_memory)) return
         call unlock_texts()
         call solve_window(judged%resolved%problem, window%record%start, scene%solver%accuracy, samples_per_period, &
                           window%periods, window%periods, states, accelerations, ending, record)
         call lock_texts()
         if (.not. is_success(ending%status)) return
      end do
   end subroutine note_film_force

   !> Note whether the film law held where the pressure was highest.
   pure subroutine note_regime(judged)
      !> With the extremes of its window
      type(judged_scene_t), intent(inout) :: judged

      associate (pressure => judged%extremes%highest(seen_pressure), problem => judged%resolved%problem)
         judged%regime = check_regime(problem%contact%film, pressure%value, thinnest_film(problem, pressure%state))
      end associate
   end subroutine note_regime

   !> Learn more of a motion, if it is irregular.
   subroutine follow_one(ending, judged)
      !> How it ended
      type(ending_t), intent(in) :: ending
      !> Its verdict and the periods after which it repeats are renewed
      type(judged_scene_t), intent(inout) :: judged
      type(rattle_verdict_t), allocatable :: verdicts(:)
      integer :: repeat_after(1)

      allocate (verdicts(1), source=judged%rattle)
      repeat_after = judged%repeats_after
      call follow_irregular([judged%resolved%problem], [ending], verdicts, repeat_after)
      judged%rattle = verdicts(1)
      judged%repeats_after = repeat_after(1)
   end subroutine follow_one

   !> Learn of the periodic motion that a motion in nodes ends near, and of one that is off its harmonics whether it repeats or
   !> neighbours part from it.
   subroutine follow_in_nodes(asked, ending, judged)
      !> Whether the periodic motion is asked for
      logical, intent(in) :: asked
      !> How it ended
      type(ending_t), intent(in) :: ending
      !> Its verdict, its periodic motion and the periods after which it repeats are renewed
      type(judged_scene_t), intent(inout) :: judged
      type(parting_t) :: parting

      if (.not. asked .and. judged%rattle%class /= class_irregular_so_far) return
      associate (problem => judged%resolved%problem, orbit => judged%orbit)
         call unlock_texts()
         call find_nodal_orbit(problem, judged%nodal, ending%nodal, orbit_nearness, orbit, judged%orbit_outcome)
         if (judged%rattle%class == class_irregular_so_far .and. orbit%period > 0) judged%repeats_after = orbit%period
         call note_orbit(judged%rattle, attracting_period(orbit))
         if (judged%rattle%class == class_irregular_so_far) then
            call follow_nodal_neighbours(problem, judged%nodal, ending%nodal, parting)
            call note_parting(judged%rattle, parting)
         end if
         call lock_texts()
      end associate
   end subroutine follow_in_nodes

end module judge_scene
