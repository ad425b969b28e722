!> Motions of the scenes of a campaign from other starts than rest: all scenes of a batch side by side, one start after the other.
!> A start ends as soon as it has come to a motion that is known of its scene.
module row_motions
   use starting_state, only: keep_by_contacts, kept_by_contacts
   use classify_group, only: classify_windows, follow_irregular
   use coexisting_motions, only: coexisting_motions_t, motion_summary_t
   use engine, only: same_request, motion_state_t
   use errors, only: error_t
   use kinds, only: dp
   use known_motions, only: are_near, known_motions_t, known_of, near_states, same_motion, settled_motion_t
   use node_extremes, only: seen_films, seen_loads, seen_net_load, seen_quantities
   use periodic_orbit, only: map_states
   use problem, only: problem_t, state_size
   use rattle_class, only: class_irregular, class_irregular_so_far, class_subharmonic
   use prepared_scene, only: prepared_scene_t, with_accuracy
   use scene_group, only: scene_group_t, solve_group
   use scene_status, only: is_success
   use signals, only: must_stop
   use vibration_severity, only: severity_of_record, vibration_severity_t
   use window_extremes, only: extremes_of_record
   use window_impacts, only: impacts_of_record, verdict_of
   implicit none(type, external)
   private

   !> Accuracy that is enough to tell motions apart [-]
   real(dp), parameter :: enough_accuracy = 1.0e-6_dp
   !> Ratio of their accelerations within which motions of one period count as alike
   real(dp), parameter :: alike_ratio = 1.25_dp

   !> All motions that are known of a scene.
   type, public :: row_motions_t
      !> As they are told; none where the one from rest failed
      type(coexisting_motions_t) :: told
      !> The same ones with all their states; of those that do not repeat the last state alone
      type(settled_motion_t), allocatable :: settled(:)
   end type row_motions_t

   !> A state to start from.
   type, public :: start_trial_t
      !> Place of its scene in the batch
      integer :: scene = 0
      real(dp), allocatable :: state(:)
      !> Whether it is the end of the motion from rest, or of another start, which is followed on
      logical :: is_own = .false., goes_on = .false.
      !> On return, whether it came to a motion that repeats, and whether it did not and may still, or came next to one whose
      !> acceleration its window does not tell; the state is that of its end then
      logical :: settled = .false., is_open = .false., is_next_to_one = .false.
   end type start_trial_t

   public :: motion_from_rest, solve_trials, handed_state, are_alike

contains

   !> The motion of a scene that was solved from its own start; none where it failed.
   subroutine motion_from_rest(scene, place, group, told, settled)
      type(prepared_scene_t), intent(in) :: scene
      !> Place of the scene in its group
      integer, intent(in) :: place
      !> With its class
      type(scene_group_t), intent(in) :: group
      !> The motion as it is reported, and with its states
      type(coexisting_motions_t), intent(out) :: told
      type(settled_motion_t), allocatable, intent(out) :: settled(:)

      allocate (settled(0))
      if (.not. is_success(group%endings(place)%status)) return
      settled = [settled_of(scene%resolved%problem, scene%request%samples_per_period, place, group)]
      told%motions = [summary_of(scene%resolved%problem, place, group, settled(1))]
      told%motions(1)%from_own_start = .true.
      told%starts_solved = 1
      if (settled(1)%period == 0) told%unsettled_starts = 1
   end subroutine motion_from_rest

   !> A motion by its window. Where the run ended before the motion repeats within the accuracy, the states of the window tell after
   !> how many periods they come again near enough, or the periodic motion that was found next to its end. One that is irregular so
   !> far may creep along by less than that and be far from where it settles.
   type(settled_motion_t) function settled_of(problem, samples_per_period, place, group) result(settled)
      type(problem_t), intent(in) :: problem
      integer, intent(in) :: samples_per_period
      integer, intent(in) :: place
      type(scene_group_t), intent(in) :: group
      type(vibration_severity_t) :: severity
      real(dp), allocatable :: states(:, :)
      integer :: periods, i

      associate (ending => group%endings(place))
         severity = severity_of_record(group%records(place), problem%frequency)
         settled%acceleration_rms = severity%acceleration_rms
         periods = ending%samples/samples_per_period
         allocate (states(state_size(problem), periods))
         do i = 1, periods
            states(:, i) = group%states(i*samples_per_period, :size(states, 1), place)
         end do
         settled%period = ending%orbit
         if (settled%period == 0 .and. group%verdicts(place)%class /= class_irregular_so_far) &
            settled%period = near_orbit(problem, near_states(problem), states)
         settled%states = states(:, periods - max(1, settled%period) + 1:)
         if (settled%period == 0 .and. group%verdicts(place)%class == class_subharmonic .and. group%repeat_after(place) > 1) &
            call follow_periods(problem, group%repeat_after(place), settled)
         if (settled%period > 0) settled%rms_is_rough = modulo(periods, settled%period) > 0
         if (allocated(group%paths(place)%states)) settled%path = group%paths(place)%states
      end associate
   end function settled_of

   !> States of a motion that repeats after more periods than its window may have, from the end of the window on.
   subroutine follow_periods(problem, period, settled)
      type(problem_t), intent(in) :: problem
      !> Periods of the force after which it repeats
      integer, intent(in) :: period
      !> With its last state
      type(settled_motion_t), intent(inout) :: settled
      real(dp) :: states(size(settled%states, 1), period), state(size(settled%states, 1), 1)
      logical :: mapped
      integer :: i

      state = settled%states(:, size(settled%states, 2):)
      do i = 1, period
         states(:, i) = state(:, 1)
         if (i == period) exit
         call map_states(problem, 1, enough_accuracy, state, mapped)
         if (.not. mapped) return
      end do
      settled%period = period
      settled%states = states
   end subroutine follow_periods

   !> What is told of a motion by its window.
   pure type(motion_summary_t) function summary_of(problem, place, group, settled) result(told)
      type(problem_t), intent(in) :: problem
      integer, intent(in) :: place
      type(scene_group_t), intent(in) :: group
      type(settled_motion_t), intent(in) :: settled
      type(vibration_severity_t) :: severity

      severity = severity_of_record(group%records(place), problem%frequency)
      told%class = group%verdicts(place)%class
      told%period = settled%period
      allocate (told%state, source=settled%states(:, 1))
      associate (record => group%records(place))
         if (record%loads%impact_limit > 0.0_dp) &
            told%verdict = verdict_of(problem, extremes_of_record(record), impacts_of_record(record, problem%frequency))
      end associate
      told%starts = 1
      told%acceleration_rms = severity%acceleration_rms
      told%film_force_rms = severity%film_force_rms
      told%film_minimum = group%records(place)%lowest(seen_films(1))%value
   end function summary_of

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

   !> Solve some starts side by side, and add the motions that they lead to and that are not known yet. After a signal to stop
   !> the motions are of no use.
   subroutine solve_trials(scenes, with_verdicts, trials, space, found, error)
      !> Scenes of a batch
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> Whether the verdicts of the motions are asked for
      logical, intent(in) :: with_verdicts
      !> The starts; the first of those that lead to one motion counts
      type(start_trial_t), intent(inout) :: trials(:)
      !> Work space
      type(scene_group_t), intent(inout) :: space
      type(row_motions_t), intent(inout) :: found(:)
      !> Set if there is no memory for the samples of a scene
      type(error_t), allocatable, intent(out) :: error
      logical :: left(size(trials)), together(size(trials))
      integer :: first, i

      left = .true.
      do while (any(left))
         first = findloc(left, .true., dim=1)
         together = left .and. [(same_request(scenes(trials(first)%scene)%request, scenes(trials(i)%scene)%request), &
                                 i=1, size(trials))]
         call solve_alike(pack([(i, i=1, size(trials))], together))
         if (must_stop() .or. allocated(error)) return
         left = left .and. .not. together
      end do

   contains

      !> Solve starts of scenes that ask for the same.
      subroutine solve_alike(own)
         integer, intent(in) :: own(:)
         type(prepared_scene_t) :: tried(size(own))
         type(motion_state_t) :: starts(size(own))
         type(known_motions_t) :: known(size(own))
         logical :: wants(seen_quantities)
         integer :: k

         associate (places => trials(own)%scene)
            do k = 1, size(own)
               tried(k) = with_accuracy(scenes(places(k)), max(scenes(places(k))%request%accuracy, enough_accuracy))
               tried(k)%request%until_steady = .true.
               tried(k)%request%forecast = .true.
               tried(k)%request%impact_limit = merge(tried(k)%spectrum%impact_limit, 0.0_dp, with_verdicts)
               starts(k)%numbers = trials(own(k))%state
               known(k) = known_of(tried(k)%resolved%problem, found(places(k))%settled)
            end do
            wants = .false.
            wants(seen_films(1)) = .true.
            wants([seen_loads(1), seen_net_load]) = with_verdicts
            call solve_group(tried, starts, wants, space, known)
            call classify_windows(tried, space, error)
            if (must_stop() .or. allocated(error)) return
            ! Motions that are off their harmonics: the ones from rest, and others where all that are known repeat.
            call follow_irregular(tried, space, [(trials(own(k))%is_own .or. all(found(places(k))%settled%period > 0), &
                                                  k=1, size(own))])
            do k = 1, size(own)
               call add_motion(tried(k), k, space, trials(own(k)), found(places(k)))
            end do
         end associate
      end subroutine solve_alike

   end subroutine solve_trials

   !> Count a start, and add its motion if that is none of those that are known: one that repeats within the accuracy, or next to
   !> whose end a motion that repeats was found, and whose states are others, or an irregular one where all others repeat. Two
   !> irregular ones cannot be told apart.
   subroutine add_motion(scene, place, group, trial, found)
      type(prepared_scene_t), intent(in) :: scene
      !> Place of the start in its group
      integer, intent(in) :: place
      type(scene_group_t), intent(in) :: group
      type(start_trial_t), intent(inout) :: trial
      type(row_motions_t), intent(inout) :: found
      type(settled_motion_t) :: motion
      type(motion_summary_t) :: told
      integer :: known, i

      associate (ending => group%endings(place), problem => scene%resolved%problem)
         if (.not. (trial%is_own .or. trial%goes_on)) found%told%starts_solved = found%told%starts_solved + 1
         found%told%extra_periods = found%told%extra_periods + ending%periods
         known = ending%known
         trial%settled = ending%orbit > 0
         trial%is_next_to_one = .false.
         if (known == 0 .and. is_success(ending%status)) then
            motion = settled_of(problem, scene%request%samples_per_period, place, group)
            if (.not. trial%settled .and. motion%period > 0 .and. group%verdicts(place)%class == class_subharmonic) then
               trial%is_next_to_one = motion%rms_is_rough
               trial%settled = .not. trial%is_next_to_one
            end if
            if (trial%settled) then
               do i = 1, size(found%settled)
                  if (same_motion(problem, found%settled(i), motion)) known = i
               end do
            else
               motion%period = 0
               motion%states = motion%states(:, size(motion%states, 2):)
            end if
            if (known == 0 .and. is_another(trial%settled, group%verdicts(place)%class, found%settled)) then
               told = summary_of(problem, place, group, motion)
               found%settled = [found%settled, motion]
               found%told%motions = [found%told%motions, told]
               known = size(found%settled)
            end if
         end if
         trial%is_open = .not. trial%settled .and. is_success(ending%status) .and. group%verdicts(place)%class /= class_irregular
         if (trial%is_open) trial%state = ending%numbers
      end associate
      if (.not. trial%is_own) then
         if (trial%settled .eqv. trial%goes_on) &
            found%told%unsettled_starts = found%told%unsettled_starts + merge(-1, 1, trial%settled)
      else if (known > 1) then
         call give_own_motion(known, trial%settled, found)
      end if
   end subroutine add_motion

   !> Whether a motion that is the same as none that are known is another one.
   pure logical function is_another(settled, class, known)
      !> Whether it repeats
      logical, intent(in) :: settled
      !> Code of its class
      integer, intent(in) :: class
      !> Those that are known
      type(settled_motion_t), intent(in) :: known(:)

      is_another = settled .or. (class == class_irregular .and. .not. any(known%period == 0))
   end function is_another

   !> The motion from rest, followed on, has come to another one: it is that one.
   subroutine give_own_motion(known, settled, found)
      !> Its place
      integer, intent(in) :: known
      !> Whether that one repeats
      logical, intent(in) :: settled
      type(row_motions_t), intent(inout) :: found
      !> One less than there are: that of the motion from rest was no motion of its own
      integer :: order(size(found%settled) - 1), others(size(found%settled) - 1), i

      others = [(i, i=2, size(found%settled))]
      order = [known, pack(others, others /= known)]
      found%settled = found%settled(order)
      found%told%motions = found%told%motions(order)
      found%told%motions(1)%from_own_start = .true.
      if (settled) found%told%unsettled_starts = found%told%unsettled_starts - 1
   end subroutine give_own_motion

   !> Whether two motions are alike: of one period and with nearly the same acceleration, or both do not repeat.
   elemental logical function are_alike(one, other)
      type(settled_motion_t), intent(in) :: one
      type(settled_motion_t), intent(in) :: other

      are_alike = one%period == other%period .and. &
                  (one%period == 0 .or. (one%acceleration_rms <= alike_ratio*other%acceleration_rms .and. &
                                         other%acceleration_rms <= alike_ratio*one%acceleration_rms))
   end function are_alike

   !> State from which a scene starts with the motion of another one: its films, velocity, and what its contacts carry.
   pure function handed_state(problem, motion, from) result(state)
      type(problem_t), intent(in) :: problem
      !> Motion of the other one, and what moves there
      type(settled_motion_t), intent(in) :: motion
      type(problem_t), intent(in) :: from
      real(dp), allocatable :: state(:)

      state = motion%states(:, 1)
      call keep_by_contacts(problem, kept_by_contacts(from, motion%states(:, 1)), state)
   end function handed_state

end module row_motions
