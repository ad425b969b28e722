!> The motion that a window shows: as it is reported, and by the states that others are compared with.
module window_motion
   use coexisting_motions, only: motion_summary_t
   use judged_scene, only: judged_scene_t
   use kinds, only: dp
   use known_motions, only: are_near, known_motions_t, near_states, settled_motion_t
   use motion_start, only: one_start_reason, start_is_given
   use node_extremes, only: seen_films
   use periodic_orbit, only: attracting_period, map_states, periodic_orbit_t
   use prepared_scene, only: prepared_scene_t
   use problem, only: problem_t, state_size
   use rattle_class, only: class_irregular, class_irregular_so_far, class_subharmonic
   use scene_group, only: judged_record, scene_group_t
   use text_output, only: lock_texts, unlock_texts
   use vibration_severity, only: severity_of_record, vibration_severity_t
   use window_extremes, only: extremes_of_record
   use window_impacts, only: impacts_of_record, verdict_of
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Accuracy that is enough to distinguish motions [-]
   real(dp), parameter, public :: enough_accuracy = 1.0e-6_dp

   public :: note_own_motion, motion_of_window, summary_of_window

contains

   !> Note the motion of a judged scene as the first of its motions.
   subroutine note_own_motion(scene, place, group, judged)
      type(prepared_scene_t), intent(in) :: scene
      !> Place of the scene in its group
      integer, intent(in) :: place
      !> With its class
      type(scene_group_t), intent(in) :: group
      type(judged_scene_t), intent(inout) :: judged
      type(settled_motion_t) :: own
      type(periodic_orbit_t) :: orbit

      associate (problem => scene%resolved%problem, coexisting => judged%coexisting)
         own = motion_of_window(problem, scene%request%samples_per_period, place, group)
         own%acceleration_rms = judged%severity%acceleration_rms
         orbit = judged%orbit
         ! Of an irregular motion the tighter solution may have come to a motion that repeats; this one has not.
         if (judged%rattle%class == class_irregular) orbit = periodic_orbit_t()
         if (attracting_period(orbit) > 0 .and. attracting_period(orbit) /= own%period) then
            own%states(:, size(own%states, 2)) = orbit%state
            call follow_periods(problem, orbit%period, own)
            if (own%period > 0) own%rms_is_rough = modulo(judged%window_periods, own%period) > 0
         end if
         coexisting%motions = [motion_summary_t(class=group%verdicts(place)%class, from_own_start=.true., starts=1, &
                                                period=reported_period(own, group%verdicts(place)%class), &
                                                acceleration_rms=judged%severity%acceleration_rms, &
                                                film_force_rms=judged%severity%film_force_rms, &
                                                film_minimum=judged%extremes%lowest(seen_films(1))%value)]
         associate (motion => coexisting%motions(1))
            motion%state = own%states(:, 1)
            if (own%period > 0 .and. attracting_period(orbit) == own%period) then
               motion%state = orbit%state
               motion%floquet_modulus = abs(orbit%multipliers(1))
            end if
            if (judged%impacts%exists) motion%verdict = verdict_of(problem, judged%extremes, judged%impacts)
         end associate
         judged%settled = [own]
         coexisting%start_is_given = start_is_given(problem)
         coexisting%one_start_reason = one_start_reason(problem, scene%method)
      end associate
      judged%coexisting%starts_solved = 1
      judged%coexisting%unsettled_starts = merge(1, 0, own%period == 0)
   end subroutine note_own_motion

   !> A motion by its window. Where the run ended before the motion repeats within the accuracy, the states of the window show after
   !> how many periods they come again near enough, or the periodic motion that was found next to its end. One that is irregular so
   !> far may creep along by less than that and be far from where it settles.
   type(settled_motion_t) function motion_of_window(problem, samples_per_period, place, group) result(motion)
      type(problem_t), intent(in) :: problem
      integer, intent(in) :: samples_per_period
      integer, intent(in) :: place
      type(scene_group_t), intent(in) :: group
      type(vibration_severity_t) :: severity
      real(dp), allocatable :: states(:, :)
      integer :: periods, i

      associate (ending => group%endings(place))
         severity = severity_of_record(judged_record(group, place), problem%frequency)
         motion%acceleration_rms = severity%acceleration_rms
         periods = ending%samples/samples_per_period
         allocate (states(state_size(problem), periods))
         do i = 1, periods
            states(:, i) = group%states(i*samples_per_period, :size(states, 1), place)
         end do
         motion%period = ending%orbit
         if (motion%period == 0 .and. group%verdicts(place)%class /= class_irregular_so_far) &
            motion%period = near_orbit(problem, near_states(problem), states)
         motion%states = states(:, periods - max(1, motion%period) + 1:)
         if (motion%period == 0 .and. group%verdicts(place)%class == class_subharmonic .and. group%repeat_after(place) > 1) &
            call follow_periods(problem, group%repeat_after(place), motion)
         if (motion%period > 0) motion%rms_is_rough = modulo(periods, motion%period) > 0
         if (allocated(group%paths(place)%states)) motion%path = group%paths(place)%states
      end associate
   end function motion_of_window

   !> States of a motion that repeats after more periods than its window may have, from its last state on.
   subroutine follow_periods(problem, period, motion)
      type(problem_t), intent(in) :: problem
      !> Periods of the force after which it repeats
      integer, intent(in) :: period
      !> With its last state
      type(settled_motion_t), intent(inout) :: motion
      real(dp) :: states(size(motion%states, 1), period), state(size(motion%states, 1), 1)
      logical :: mapped
      integer :: i

      state = motion%states(:, size(motion%states, 2):)
      do i = 1, period
         states(:, i) = state(:, 1)
         if (i == period) exit
         call unlock_texts()
         call map_states(problem, 1, enough_accuracy, state, mapped)
         call lock_texts()
         if (.not. mapped) return
      end do
      motion%period = period
      motion%states = states
   end subroutine follow_periods

   !> What is reported of a motion by its window.
   pure type(motion_summary_t) function summary_of_window(problem, place, group, motion) result(summary)
      type(problem_t), intent(in) :: problem
      integer, intent(in) :: place
      type(scene_group_t), intent(in) :: group
      type(settled_motion_t), intent(in) :: motion
      type(vibration_severity_t) :: severity
      type(window_record_t) :: record

      record = judged_record(group, place)
      severity = severity_of_record(record, problem%frequency)
      summary%class = group%verdicts(place)%class
      summary%period = reported_period(motion, summary%class)
      allocate (summary%state, source=motion%states(:, 1))
      if (record%loads%impact_limit > 0.0_dp) &
         summary%verdict = verdict_of(problem, extremes_of_record(record), impacts_of_record(record, problem%frequency))
      summary%acceleration_rms = severity%acceleration_rms
      summary%film_force_rms = severity%film_force_rms
      summary%film_minimum = record%lowest(seen_films(1))%value
   end function summary_of_window

   !> Periods after which a motion repeats: one that is irregular in narrow bands comes near where it was, and parts from there again.
   elemental integer function reported_period(motion, class) result(period)
      type(settled_motion_t), intent(in) :: motion
      integer, intent(in) :: class

      period = merge(0, motion%period, class == class_irregular)
   end function reported_period

   !> Periods of the force after which the states of a window come again near enough, 0 if they do not within half of it.
   pure integer function near_orbit(problem, measure, states) result(orbit)
      type(problem_t), intent(in) :: problem
      type(known_motions_t), intent(in) :: measure
      !> Number of the state, end of a period
      real(dp), intent(in) :: states(:, :)
      integer :: i

      do orbit = 1, size(states, 2)/2
         if (all([(are_near(problem, measure, states(:, i), states(:, i + orbit)), i=1, size(states, 2) - orbit)])) return
      end do
      orbit = 0
   end function near_orbit

end module window_motion
