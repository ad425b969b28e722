!> From solved scenes to judged ones: classes, extremes, severity, impacts, regime, and how far they can be trusted. A single scene is
!> a group of one.
module judge_group
   use carried_loads, only: thinnest_film
   use classify_group, only: classify_windows, follow_irregular, may_be_finer
   use controlled_engine, only: solve_window
   use engine, only: ending_t
   use errors, only: error_t
   use force_signal, only: has_enough_samples, signal_of_window
   use judged_scene, only: judged_scene_t
   use kinds, only: dp
   use known_motions, only: are_near, near_states
   use memory_need, only: expect_window_memory
   use nodal_judgement, only: follow_in_nodes, verify_in_nodes
   use nodal_step, only: nodal_choice_t
   use node_extremes, only: seen_pressure
   use periodic_orbit, only: attracting_period, find_periodic_orbit
   use prepared_scene, only: prepared_scene_t
   use problem, only: of_velocity
   use quantities, only: needs_film_force, needs_multipliers, needs_orbit, needs_regime, needs_spectrum, needs_starts, &
      needs_verification, needs_verified_impacts
   use rattle_class, only: class_irregular, class_irregular_so_far, note_orbit
   use regime_check, only: check_regime
   use scene_group, only: goes_beyond, has_window, judged_record, scene_group_t
   use scene_orbit, only: nearby_orbit
   use scene_status, only: is_success, status_steady
   use signals, only: must_stop
   use text_output, only: lock_texts, unlock_texts
   use verification, only: verification_t
   use verify_group, only: verified_windows_t, verify_windows
   use vibration_severity, only: severity_of_record, severity_of_samples, vibration_severity_t
   use window_extremes, only: extremes_of_record, extremes_of_samples, misses_extremes
   use window_impacts, only: impacts_of_record, impacts_of_samples, list_impacts_of
   use window_motion, only: note_own_motion
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> A periodic motion farther away than this from the end of a motion is another one [-].
   real(dp), parameter :: end_nearness = 1.0e-3_dp
   !> Share of the power of a force by which its samples may miss that of the steps [-]
   real(dp), parameter :: missed_power = 1.0e-6_dp

   !> Solved scenes with their tighter solutions; the arrays serve the next ones. How a single scene is followed in nodes of pressure.
   type, public :: judgement_space_t
      type(scene_group_t) :: group, tight
      type(nodal_choice_t) :: nodal
   end type judgement_space_t

   public :: judge_scenes

contains

   !> Judge solved scenes. After a signal to stop, those that are not judged are of no use.
   subroutine judge_scenes(scenes, needed, space, judged, error)
      !> With what was asked of the engine; in nodes, a single one
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> What is to be found, by the codes of module quantities
      logical, intent(in) :: needed(:)
      !> With the solved scenes
      type(judgement_space_t), intent(inout) :: space
      type(judged_scene_t), intent(out) :: judged(:)
      !> Set if there is no memory for the samples of a scene
      type(error_t), allocatable, intent(out) :: error
      integer :: i

      do i = 1, size(scenes)
         judged(i)%resolved = scenes(i)%resolved
         judged(i)%nodal = space%nodal
         judged(i)%ending = space%group%endings(i)
         judged(i)%status = judged(i)%ending%status
         judged(i)%repeats_after = judged(i)%ending%orbit
      end do
      if (.not. any(is_success(judged%status))) return
      if (needed(needs_orbit) .or. needed(needs_multipliers)) call find_orbits(scenes, needed, space%group)
      if (needed(needs_spectrum)) then
         call find_classes(scenes, needed, space, judged(1)%orbit_outcome, error)
      else
         call find_irregular(scenes, space%group, error)
      end if
      if (must_stop() .or. allocated(error)) return
      do i = 1, size(scenes)
         judged(i)%repeats_after = space%group%repeat_after(i)
         if (is_success(judged(i)%status)) call judge_window(scenes(i), needed, i, space%group, judged(i))
      end do
      if (needed(needs_verification)) call verify_scenes(scenes, needed, space, judged, error)
      judged%judged = judged%judged .and. .not. allocated(error)
      if (must_stop() .or. allocated(error)) return
      do i = 1, size(scenes)
         judged(i)%orbit = space%group%orbits(i)
         if (.not. (needed(needs_starts) .and. judged(i)%judged)) cycle
         if (.not. scenes(i)%resolved%problem%contact%film%in_nodes) call note_own_motion(scenes(i), i, space%group, judged(i))
      end do
   end subroutine judge_scenes

   !> Look for the periodic motions at the ends of the scenes: with their multipliers, or how long they are. Where scenes are verified,
   !> multipliers are those at the ends of their tighter solutions.
   subroutine find_orbits(scenes, needed, group)
      type(prepared_scene_t), intent(in) :: scenes(:)
      logical, intent(in) :: needed(:)
      type(scene_group_t), intent(inout) :: group
      integer :: i

      do i = 1, size(scenes)
         if (must_stop()) return
         associate (ending => group%endings(i), orbit => group%orbits(i), problem => scenes(i)%resolved%problem)
            if (.not. is_success(ending%status)) cycle
            if (needed(needs_multipliers) .and. .not. needed(needs_verification)) then
               call unlock_texts()
               orbit = find_periodic_orbit(problem, ending%numbers, end_nearness)
               call lock_texts()
            else if (needed(needs_orbit) .and. ending%orbit /= 1) then
               ! One that was seen to repeat after every period needs no search.
               orbit = nearby_orbit(problem, ending)
               if (orbit%period > 0) group%repeat_after(i) = orbit%period
            end if
         end associate
      end do
   end subroutine find_orbits

   !> Classes of the scenes, and what becomes of those that are off their harmonics.
   subroutine find_classes(scenes, needed, space, outcome, error)
      type(prepared_scene_t), intent(in) :: scenes(:)
      logical, intent(in) :: needed(:)
      type(judgement_space_t), intent(inout) :: space
      !> Of films in nodes: whether a periodic motion was found, and why not
      integer, intent(inout) :: outcome
      !> Set if there is no memory for the samples of a scene
      type(error_t), allocatable, intent(out) :: error
      integer :: i

      call classify_windows(scenes, space%group, error)
      if (must_stop() .or. allocated(error)) return
      associate (group => space%group)
         if (.not. scenes(1)%resolved%problem%contact%film%in_nodes) then
            do i = 1, size(scenes)
               call note_orbit(group%verdicts(i), attracting_period(group%orbits(i)))
            end do
            call follow_irregular(scenes, group)
         else if (needed(needs_verification) .or. group%verdicts(1)%class == class_irregular_so_far) then
            call follow_in_nodes(scenes(1), space%nodal, group, outcome)
         end if
      end associate
   end subroutine find_classes

   !> Find the irregular motions where no classes are asked for: what they amount to is not that of their windows. A motion that was
   !> seen to repeat, or whose window ends where it begins, is none.
   subroutine find_irregular(scenes, group, error)
      type(prepared_scene_t), intent(in) :: scenes(:)
      type(scene_group_t), intent(inout) :: group
      !> Set if there is no memory for the samples of a scene
      type(error_t), allocatable, intent(out) :: error
      logical :: is_open(size(scenes))
      integer :: i

      is_open = .false.
      do i = 1, size(scenes)
         associate (problem => scenes(i)%resolved%problem, record => group%records(i), ending => group%endings(i))
            if (.not. has_window(ending) .or. ending%orbit > 0 .or. record%periods == 0 .or. problem%contact%film%in_nodes) cycle
            is_open(i) = .not. are_near(problem, near_states(problem), record%start%numbers, ending%numbers)
         end associate
      end do
      if (.not. any(is_open)) return
      call classify_windows(scenes, group, error, is_open)
      if (must_stop() .or. allocated(error)) return
      call follow_irregular(scenes, group, is_open)
   end subroutine find_irregular

   !> Extremes, severity, impacts and regime of a window, or of the periods that a motion was followed beyond it.
   subroutine judge_window(scene, needed, place, group, judged)
      type(prepared_scene_t), intent(in) :: scene
      logical, intent(in) :: needed(:)
      !> Place of the scene in the group
      integer, intent(in) :: place
      !> With its class; where samples are all there is of a window, its extremes are added to its record
      type(scene_group_t), intent(inout) :: group
      type(judged_scene_t), intent(inout) :: judged

      type(window_record_t) :: record

      record = judged_record(group, place)
      judged%statistics = group%statistics(place)
      associate (samples => group%endings(place)%samples, verdict => group%verdicts(place), &
                 problem => scene%resolved%problem, samples_per_period => scene%request%samples_per_period)
         judged%window_periods = samples/samples_per_period
         if (needed(needs_spectrum)) then
            judged%rattle = verdict
            associate (classified_by => group%classified_by(place))
               judged%series_coarse = classified_by /= samples_per_period .or. .not. verdict%spectrum%sampling_sufficient
               judged%harmonics_by_integrals = classified_by == 0 .or. goes_beyond(group, place)
               judged%samples_per_period = merge(samples_per_period, classified_by, judged%harmonics_by_integrals)
            end associate
            ! Campaigns have no series.
            if (judged%series_coarse .and. group%records(place)%periods > 0 .and. allocated(group%accelerations)) &
               judged%series_misses_extremes = misses_extremes( &
               extremes_of_samples(problem, group%states(:samples, :, place), group%accelerations), &
               extremes_of_record(group%records(place)))
         end if
         if (record%periods > 0) then
            judged%extremes = extremes_of_record(record)
            judged%severity = severity_of_record(record, problem%frequency)
            judged%impacts = impacts_of_record(record, problem%frequency)
            if (goes_beyond(group, place)) call list_impacts_of(impacts_of_record(group%records(place), problem%frequency), &
                                                                    judged%impacts)
         else
            associate (states => group%states(:samples, :, place))
               judged%extremes = extremes_of_samples(problem, states, group%accelerations)
               judged%severity = severity_of_samples(problem, samples_per_period, states(:, of_velocity), group%accelerations)
               judged%impacts = impacts_of_samples(problem, scene%spectrum%impact_limit, samples_per_period, states)
            end associate
            group%records(place)%lowest = judged%extremes%lowest
            group%records(place)%highest = judged%extremes%highest
         end if
         if (needed(needs_film_force) .and. scene%in_gearbox) call note_film_force(scene, group, judged)
         if (needed(needs_regime)) then
            associate (pressure => judged%extremes%highest(seen_pressure))
               judged%regime = check_regime(problem%contact%film, pressure%value, thinnest_film(problem, pressure%state))
            end associate
         end if
      end associate
      judged%judged = .true.
   end subroutine judge_window

   !> Note the force of a pair of a gearbox, from as many samples as have the power that the steps give, where there may be so many.
   subroutine note_film_force(scene, group, judged)
      type(prepared_scene_t), intent(in) :: scene
      !> A group of one
      type(scene_group_t), intent(in) :: group
      !> With severity and class; the force is added
      type(judged_scene_t), intent(inout) :: judged
      type(window_record_t) :: record
      type(ending_t) :: ending
      type(error_t), allocatable :: short_of_memory
      type(vibration_severity_t) :: severity
      real(dp), allocatable :: states(:, :), accelerations(:)
      real(dp) :: force_rms
      integer :: samples_per_period

      force_rms = judged%severity%film_force_rms
      if (goes_beyond(group, 1)) then
         severity = severity_of_record(group%records(1), scene%resolved%problem%frequency)
         force_rms = severity%film_force_rms
      end if
      accelerations = group%accelerations
      samples_per_period = scene%request%samples_per_period
      associate (problem => scene%resolved%problem, periods => judged%window_periods, window => group%records(1))
         do
            judged%film_force = signal_of_window(problem, accelerations, periods, judged%ending%periods, &
                                                 judged%status == status_steady, force_rms)
            if (has_enough_samples(judged%film_force, missed_power) .or. problem%contact%film%in_nodes) return
            if (.not. may_be_finer(window, periods, samples_per_period)) return
            samples_per_period = 2*samples_per_period
            call expect_window_memory(samples_per_period*periods, short_of_memory)
            if (allocated(short_of_memory)) return
            call unlock_texts()
            call solve_window(problem, window%start, scene%request%accuracy, samples_per_period, periods, periods, states, &
                              accelerations, ending, record)
            call lock_texts()
            if (.not. is_success(ending%status)) return
         end do
      end associate
   end subroutine note_film_force

   !> Verify the scenes.
   subroutine verify_scenes(scenes, needed, space, judged, error)
      type(prepared_scene_t), intent(in) :: scenes(:)
      logical, intent(in) :: needed(:)
      type(judgement_space_t), intent(inout) :: space
      !> With their windows
      type(judged_scene_t), intent(inout) :: judged(:)
      !> Set if there is no memory for the samples of a scene
      type(error_t), allocatable, intent(out) :: error
      type(verification_t) :: verifications(size(scenes))
      type(verified_windows_t) :: windows

      if (scenes(1)%resolved%problem%contact%film%in_nodes .and. space%group%verdicts(1)%class /= class_irregular) then
         call verify_in_nodes(scenes(1), space%nodal, space%group, space%tight, verifications(1), error)
      else
         windows%severities = judged%severity
         if (needed(needs_verified_impacts)) windows%impacts = judged%impacts
         windows%with_orbits = needed(needs_multipliers)
         call verify_windows(scenes, windows, space%group, space%tight, verifications, error)
      end if
      verifications%exists = .true.
      judged%verification = verifications
   end subroutine verify_scenes

end module judge_group
