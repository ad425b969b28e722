!> All motions of one scene: its starts are followed side by side until each is on a motion that is known, or repeats by itself.
!>
!> A start is given up to a known stable motion once it was next to it, and to no other, at the ends of two periods running. A
!> start whose periods come near each other is handed to Newton's method on the period map, and what that finds is a motion of its
!> own unless it is one that is known. Where the motion of the scene itself has neither repeated nor proved to be irregular, it is
!> followed on beyond its end like a start.
module follow_starts
   use carried_loads, only: counts_as, thinnest_film
   use classify_group, only: classify_windows, follow_irregular
   use coexisting_motions, only: coexisting_motions_t, motion_summary_t
   use engine, only: ending_t, motion_state_t, request_t, status_of_stop, state_of_start
   use errors, only: error_t
   use judged_scene, only: judged_scene_t
   use kinds, only: dp
   use known_motions, only: are_of_one_motion, compared_after, compared_periods, known_of, reached_motion, same_motion, &
      settled_motion_t
   use many_motions, only: solve_motions
   use motion_start, only: chosen_starts, motion_start_t, motion_starts, one_start_reason, start_count, start_is_given
   use node_extremes, only: seen_films, seen_quantities
   use periodic_orbit, only: attracting_period, map_states, periodic_orbit_t
   use problem, only: of_film, of_velocity, problem_t, state_size
   use rattle_class, only: class_irregular, class_irregular_so_far, note_orbit
   use prepared_scene, only: prepare, prepared_scene_t, request_of
   use scene_group, only: scene_group_t, solve_group
   use scene_orbit, only: nearby_orbit, orbit_ahead
   use scene_status, only: is_success, status_complete
   use scene_types, only: scene_t
   use signals, only: must_stop
   use text_output, only: lock_texts, unlock_texts
   use vibration_severity, only: severity_of_record, vibration_severity_t
   use window_extremes, only: extremes_of_record, window_extremes_t
   use window_impacts, only: impacts_of_record, verdict_of
   implicit none(type, external)
   private

   !> Accuracy with which starts are followed: it decides where they lead, not what is told of it.
   real(dp), parameter :: start_accuracy = 1.0e-6_dp
   !> Periods of a round, after which it is seen where starts are, and most periods of a start.
   integer, parameter :: round_periods = 2, most_periods = 120
   !> Periods of an irregular motion of the scene itself that starts are held against.
   integer, parameter :: own_periods = 60
   !> Most periods of a start after the first one that has had all of its own and neither repeats nor is known to be irregular.
   integer, parameter :: later_periods = 64
   !> Longest period that is looked for, as by the search for periodic motions.
   integer, parameter :: longest_period = 8
   !> Distance between two periods, relative to the film, from which on Newton's method is tried, and by how much it has to fall
   !> before it is tried again [-].
   real(dp), parameter :: first_try = 0.005_dp, next_try = 0.1_dp
   !> The same distance of a start that has had all its periods: it may settle slowly [-].
   real(dp), parameter :: last_try = 0.05_dp
   !> Periods after which a motion that was started again by film and velocity has to be itself.
   integer, parameter :: restart_periods = 40
   !> Seed of the starts that are drawn.
   integer, parameter :: seed = 1

   !> What is known of the starts beside that of the scene, and last of the end of its own motion where that is followed on.
   type :: follower_t
      !> Whether the last one is the end of the scene's own motion
      logical :: with_own = .false.
      type(motion_state_t), allocatable :: states(:)
      !> Number of a state, ends of the last periods (the newest last), start
      real(dp), allocatable :: past(:, :, :)
      !> Film and velocity at the end of each period: number, period, start
      real(dp), allocatable :: history(:, :, :)
      !> Periods done, and the motion that it leads to; 0: not known yet
      integer, allocatable :: periods(:), motion(:)
      !> Whether it could not be followed
      logical, allocatable :: failed(:)
      !> Distance at the last try of Newton's method [-]
      real(dp), allocatable :: tried(:)
   end type follower_t

   public :: find_all_motions

contains

   !> Find the motions that the starts of a judged scene lead to. After a signal to stop the answer is of no use.
   subroutine find_all_motions(scene, started, judged, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> When the run began, on the clock of wall_seconds [s]
      real(dp), intent(in) :: started
      !> Its judged scene; the other motions are added
      type(judged_scene_t), intent(inout) :: judged
      !> Set if there is not enough memory
      type(error_t), allocatable, intent(out) :: error
      type(settled_motion_t), allocatable :: settled(:)
      type(motion_start_t), allocatable :: starts(:)
      type(follower_t) :: followers
      logical, allocatable :: is_unsettled(:)
      integer :: count, others, i

      associate (problem => judged%resolved%problem, coexisting => judged%coexisting)
         coexisting%start_is_given = start_is_given(problem)
         coexisting%one_start_reason = one_start_reason(problem, scene%solver%method)
         count = start_count(problem, scene%solver)
         call note_own_motion(scene, judged%ending, count > 1, judged, settled)
         if (count > 1) then
            starts = motion_starts(problem, count, seed)
            call begin_starts(problem, starts(2:), coexisting%motions(1), followers)
            call follow(scene, judged, started, followers, settled, error)
            if (allocated(error) .or. must_stop()) return
            coexisting%starts_solved = count
            if (followers%with_own) call give_own_motion(coexisting, settled, followers%motion)
            others = count - 1
            is_unsettled = unsettled(followers%motion(:others), coexisting)
            coexisting%unsettled_starts = coexisting%unsettled_starts + size(pack(is_unsettled, is_unsettled))
            ! The own start is not among those that were followed here.
            coexisting%drawn_starts = size(pack(is_unsettled(chosen_starts:),.not. is_unsettled(chosen_starts:)))
            do i = 1, size(coexisting%motions)
               associate (motion => followers%motion(:others))
                  coexisting%motions(i)%starts = coexisting%motions(i)%starts + size(pack(motion, motion == i))
               end associate
               call find_restart(problem, i, settled, coexisting%motions(i))
            end do
            coexisting%extra_periods = coexisting%extra_periods + sum(followers%periods)
         end if
      end associate
   end subroutine find_all_motions

   !> Starts whose motions were not seen to repeat.
   pure function unsettled(motion, coexisting) result(is_unsettled)
      !> Motion of each start, 0: not known
      integer, intent(in) :: motion(:)
      type(coexisting_motions_t), intent(in) :: coexisting
      logical :: is_unsettled(size(motion))
      integer :: i

      is_unsettled = motion == 0
      do i = 1, size(is_unsettled)
         if (motion(i) > 0) is_unsettled(i) = coexisting%motions(motion(i))%period == 0
      end do
   end function unsettled

   !> Where the motion of the scene itself, followed on, has come to one that is told, it is that one: it takes its place.
   subroutine give_own_motion(coexisting, settled, motion)
      type(coexisting_motions_t), intent(inout) :: coexisting
      type(settled_motion_t), allocatable, intent(inout) :: settled(:)
      !> Motion of each start, that of the own one last
      integer, intent(inout) :: motion(:)
      !> One less than there are: that of the scene itself was no motion of its own
      integer :: order(size(settled) - 1), others(size(settled) - 1), own, i

      own = motion(size(motion))
      if (own <= 1) return
      others = [(i, i=2, size(settled))]
      order = [own, pack(others, others /= own)]
      coexisting%motions(own)%from_own_start = .true.
      coexisting%motions(own)%starts = coexisting%motions(own)%starts + 1
      coexisting%unsettled_starts = merge(1, 0, coexisting%motions(own)%period == 0)
      coexisting%motions = coexisting%motions(order)
      settled = settled(order)
      do i = 1, size(motion)
         motion(i) = findloc(order, motion(i), dim=1)
      end do
   end subroutine give_own_motion

   !> The motion of the scene itself is the first one.
   subroutine note_own_motion(scene, ending, for_others, judged, settled)
      type(scene_t), intent(in) :: scene
      type(ending_t), intent(in) :: ending
      !> Whether others are to be held against it
      logical, intent(in) :: for_others
      type(judged_scene_t), intent(inout) :: judged
      !> The same, as far as it repeats
      type(settled_motion_t), allocatable, intent(out) :: settled(:)
      type(periodic_orbit_t) :: orbit
      type(motion_summary_t) :: own

      orbit = judged%orbit
      if (orbit%period == 0 .and. for_others .and. .not. scene%spectrum%verify) &
         orbit = nearby_orbit(judged%resolved%problem, ending)
      own%class = judged%rattle%class
      ! Of an irregular motion the tighter solution may have come to a motion that repeats; this one has not.
      if (own%class == class_irregular) orbit = periodic_orbit_t()
      own%period = attracting_period(orbit)
      own%state = ending%numbers
      if (own%period > 0) then
         own%state = orbit%state
         own%floquet_modulus = abs(orbit%multipliers(1))
      else if (judged%repeats_after > 0 .and. orbit%period == 0 .and. own%class /= class_irregular) then
         own%period = judged%repeats_after
      end if
      if (judged%impacts%exists) own%verdict = verdict_of(judged%resolved%problem, judged%extremes, judged%impacts)
      own%from_own_start = .true.
      own%starts = 1
      own%acceleration_rms = judged%severity%acceleration_rms
      own%film_force_rms = judged%severity%film_force_rms
      own%film_minimum = judged%extremes%lowest(seen_films(1))%value
      allocate (settled(1))
      settled(1) = settled_of(judged%resolved%problem, own)
      own%period = settled(1)%period
      allocate (judged%coexisting%motions(1))
      judged%coexisting%motions(1) = own
      judged%coexisting%starts_solved = 1
      judged%coexisting%unsettled_starts = merge(1, 0, own%period == 0)
   end subroutine note_own_motion

   !> The states of a motion that repeats, one of each period.
   type(settled_motion_t) function settled_of(problem, told) result(settled)
      type(problem_t), intent(in) :: problem
      !> Its state, period and rms
      type(motion_summary_t), intent(in) :: told
      real(dp) :: states(size(told%state), 1)
      integer :: i
      logical :: mapped

      allocate (settled%states(size(told%state), told%period))
      settled%acceleration_rms = told%acceleration_rms
      states(:, 1) = told%state
      do i = 1, told%period
         settled%states(:, i) = states(:, 1)
         if (i == told%period) exit
         call map_states(problem, 1, start_accuracy, states, mapped)
         if (.not. mapped) return
      end do
      settled%period = told%period
   end function settled_of

   !> Starts that have not moved yet.
   subroutine begin_starts(problem, starts, own, followers)
      type(problem_t), intent(in) :: problem
      type(motion_start_t), intent(in) :: starts(:)
      !> The motion of the scene itself, as far as it came
      type(motion_summary_t), intent(in) :: own
      type(follower_t), intent(out) :: followers
      integer :: i, n

      followers%with_own = own%period == 0 .and. own%class == class_irregular_so_far
      n = size(starts) + merge(1, 0, followers%with_own)
      allocate (followers%states(n), followers%failed(n), followers%tried(n))
      allocate (followers%past(state_size(problem), longest_period + 1, n), source=0.0_dp)
      allocate (followers%history(of_velocity, most_periods + round_periods, n), source=0.0_dp)
      allocate (followers%periods(n), followers%motion(n), source=0)
      followers%failed = .false.
      followers%tried = huge(1.0_dp)
      do i = 1, size(starts)
         followers%states(i) = state_of_start(problem, starts(i))
      end do
      if (followers%with_own) followers%states(n) = motion_state_t(numbers=own%state)
   end subroutine begin_starts

   !> Follow all starts until each is on a known motion, or has had its periods. Where the motion of the scene is irregular, a start
   !> whose states are like those of that motion has it; else the first start that does not repeat, the motion of the scene itself
   !> before others, has all its periods, while others wait for what it is.
   subroutine follow(scene, judged, started, followers, settled, error)
      type(scene_t), intent(in) :: scene
      type(judged_scene_t), intent(inout) :: judged
      real(dp), intent(in) :: started
      type(follower_t), intent(inout) :: followers
      !> Motions that are known; others are added
      type(settled_motion_t), allocatable, intent(inout) :: settled(:)
      type(error_t), allocatable, intent(out) :: error
      real(dp), allocatable :: irregular(:, :)
      integer, allocatable :: left(:)
      logical :: is_left(size(followers%motion)), none_is_irregular
      integer :: most, first, last, i

      most = min(most_periods, max(scene%solver%periods, longest_period + 1))
      none_is_irregular = .false.
      if (judged%rattle%class == class_irregular) call follow_own(judged, irregular)
      do
         is_left = followers%motion == 0 .and. .not. followers%failed
         first = findloc(is_left, .true., dim=1)
         last = size(is_left)
         if (followers%with_own .and. is_left(last)) first = last
         is_left = is_left .and. followers%periods < merge(min(most, later_periods), most, none_is_irregular)
         if (.not. (allocated(irregular) .or. none_is_irregular)) &
            is_left = is_left .and. (followers%periods < compared_after .or. [(i == first, i=1, size(is_left))])
         left = pack([(i, i=1, size(is_left))], is_left)
         if (size(left) == 0 .or. must_stop()) exit
         if (status_of_stop(request_of(scene), started) /= status_complete) exit
         call go_on(judged%resolved%problem, left, followers)
         do i = 1, size(left)
            if (followers%failed(left(i))) cycle
            associate (problem => judged%resolved%problem, past => followers%past(:, longest_period:, left(i)))
               followers%motion(left(i)) = reached_motion(problem, known_of(problem, settled), past(:, 1), past(:, 2))
            end associate
            if (followers%motion(left(i)) > 0) cycle
            call look_for_repetition(scene, judged, left(i), followers, settled, error)
            if (allocated(error) .or. must_stop()) return
         end do
         if (first > 0 .and. .not. (allocated(irregular) .or. none_is_irregular)) then
            if (followers%motion(first) == 0 .and. .not. followers%failed(first) .and. followers%periods(first) >= most) then
               ! What settles slowly is near a motion that repeats without its periods being near each other.
               call look_for_repetition(scene, judged, first, followers, settled, error, last_try)
               if (allocated(error) .or. must_stop()) return
               if (followers%motion(first) > 0) cycle
               call judge_unsettled(scene, judged, followers%states(first), settled, none_is_irregular, error)
               if (allocated(error) .or. must_stop()) return
               if (.not. none_is_irregular) irregular = followers%history(:, compared_after + 1:followers%periods(first), first)
            end if
         end if
         if (allocated(irregular)) call join_irregular(judged, irregular, followers)
      end do
      do i = 1, size(is_left)
         if (followers%motion(i) > 0 .or. followers%failed(i)) cycle
         call look_for_repetition(scene, judged, i, followers, settled, error, huge(1.0_dp))
         if (allocated(error) .or. must_stop()) return
      end do
      first = irregular_place(judged)
      if (first == 0 .or. none_is_irregular) return
      where (followers%motion == 0 .and. .not. followers%failed .and. followers%periods >= most) followers%motion = first
   end subroutine follow

   !> Place of the irregular motion; 0: none is known.
   pure integer function irregular_place(judged)
      type(judged_scene_t), intent(in) :: judged

      irregular_place = findloc(judged%coexisting%motions%class, class_irregular, dim=1)
   end function irregular_place

   !> Films and velocities of the irregular motion of the scene, beyond its end.
   subroutine follow_own(judged, irregular)
      !> Its periods are counted with those of the other starts
      type(judged_scene_t), intent(inout) :: judged
      !> Number, period; not allocated where it could not be followed
      real(dp), allocatable, intent(out) :: irregular(:, :)
      real(dp), allocatable :: states(:, :, :)
      type(ending_t) :: endings(1)

      associate (problem => judged%resolved%problem, own => judged%coexisting%motions(1))
         allocate (states(own_periods, size(own%state), 1), source=0.0_dp)
         call unlock_texts()
         call solve_motions([problem], [motion_state_t(numbers=own%state)], &
                            request_t(accuracy=start_accuracy, periods=own_periods, samples_per_period=1, &
                                      sampled_periods=own_periods), states, endings)
         call lock_texts()
         judged%coexisting%extra_periods = endings(1)%periods
         if (endings(1)%status == status_complete) irregular = transpose(states(:, :of_velocity, 1))
      end associate
   end subroutine follow_own

   !> Starts that have not repeated for long enough have the irregular motion that is known, if their states are like those of it.
   pure subroutine join_irregular(judged, irregular, followers)
      type(judged_scene_t), intent(in) :: judged
      !> Films and velocities of that motion: number, period
      real(dp), intent(in) :: irregular(:, :)
      type(follower_t), intent(inout) :: followers
      integer :: i

      do i = 1, size(followers%motion)
         if (followers%motion(i) > 0 .or. followers%failed(i) .or. followers%periods(i) < compared_after) cycle
         associate (last => followers%periods(i))
            if (are_of_one_motion(followers%history(:, last - compared_periods + 1:last, i), irregular)) &
               followers%motion(i) = irregular_place(judged)
         end associate
      end do
   end subroutine join_irregular

   !> Follow some starts for a round.
   subroutine go_on(problem, left, followers)
      type(problem_t), intent(in) :: problem
      !> Which
      integer, intent(in) :: left(:)
      type(follower_t), intent(inout) :: followers
      type(problem_t) :: problems(size(left))
      type(ending_t) :: endings(size(left))
      real(dp), allocatable :: states(:, :, :)
      integer :: i

      problems = problem
      allocate (states(round_periods, state_size(problem), size(left)), source=0.0_dp)
      call unlock_texts()
      call solve_motions(problems, followers%states(left), &
                         request_t(accuracy=start_accuracy, periods=round_periods, samples_per_period=1, &
                                   sampled_periods=round_periods), states, endings)
      call lock_texts()
      do i = 1, size(left)
         associate (place => left(i))
            followers%periods(place) = followers%periods(place) + endings(i)%periods
            followers%failed(place) = endings(i)%status /= status_complete
            if (followers%failed(place)) cycle
            followers%history(:, followers%periods(place) - round_periods + 1:followers%periods(place), place) = &
               transpose(states(:, :of_velocity, i))
            followers%states(place) = motion_state_t(numbers=endings(i)%numbers, implicit=endings(i)%implicit)
            followers%past(:, :, place) = eoshift(followers%past(:, :, place), round_periods, dim=2)
            followers%past(:, longest_period + 2 - round_periods:, place) = transpose(states(:, :, i))
         end associate
      end do
   end subroutine go_on

   !> Where the periods of a start come near each other, find the motion that it settles on.
   subroutine look_for_repetition(scene, judged, place, followers, settled, error, ahead_within)
      type(scene_t), intent(in) :: scene
      type(judged_scene_t), intent(inout) :: judged
      !> Which start
      integer, intent(in) :: place
      type(follower_t), intent(inout) :: followers
      !> Motions that are known; another one is added
      type(settled_motion_t), allocatable, intent(inout) :: settled(:)
      type(error_t), allocatable, intent(out) :: error
      !> Of a start that has had all its periods, distance of these up to which a motion ahead of its end is looked for, whatever was
      !> tried; absent: next to its end, as its periods come near each other [-]
      real(dp), intent(in), optional :: ahead_within
      type(periodic_orbit_t) :: orbit
      type(motion_summary_t) :: told
      type(settled_motion_t) :: one
      type(scene_group_t) :: group
      type(ending_t) :: here
      real(dp) :: distance, limit
      integer :: i

      if (followers%periods(place) <= longest_period) return
      associate (problem => judged%resolved%problem, past => followers%past(:, :, place))
         distance = distance_of_periods(problem, past)
         limit = min(first_try, next_try*followers%tried(place))
         if (present(ahead_within)) limit = ahead_within
         if (distance > limit) return
         followers%tried(place) = distance
         here%numbers = followers%states(place)%numbers
         if (present(ahead_within)) then
            orbit = orbit_ahead(problem, here)
         else
            orbit = nearby_orbit(problem, here)
         end if
         if (attracting_period(orbit) == 0) return
         told%period = orbit%period
         told%state = orbit%state
         told%floquet_modulus = abs(orbit%multipliers(1))
         call judge_motion(prepare(scene), motion_state_t(numbers=orbit%state), orbit%period, told, group, error)
         if (allocated(error) .or. told%class == 0) return
         one = settled_of(problem, told)
         do i = 1, size(settled)
            if (same_motion(problem, one, settled(i))) followers%motion(place) = i
         end do
         if (followers%motion(place) > 0 .or. one%period == 0) return
         settled = [settled, one]
         judged%coexisting%motions = [judged%coexisting%motions, told]
         followers%motion(place) = size(settled)
      end associate
   end subroutine look_for_repetition

   !> Least distance between the last state and those one to eight periods before, relative to the film.
   pure real(dp) function distance_of_periods(problem, past) result(distance)
      type(problem_t), intent(in) :: problem
      !> Number of a state, period, the newest last
      real(dp), intent(in) :: past(:, :)
      real(dp) :: scale(size(past, 1))
      integer :: i, n

      n = size(past, 2)
      scale = counts_as(problem, past(:, n))
      distance = minval([(maxval(abs(past(:, n) - past(:, i))*scale), i=1, n - 1)])/thinnest_film(problem, past(:, n))
   end function distance_of_periods

   !> Class and severity of a motion, over some periods from a state on it.
   subroutine judge_motion(scene, start, periods, told, group, error)
      type(prepared_scene_t), intent(in) :: scene
      type(motion_state_t), intent(in) :: start
      integer, intent(in) :: periods
      !> With its period; class 0 where it could not be solved
      type(motion_summary_t), intent(inout) :: told
      !> With its solution
      type(scene_group_t), intent(inout) :: group
      type(error_t), allocatable, intent(out) :: error
      type(prepared_scene_t) :: one(1)
      type(vibration_severity_t) :: severity
      type(window_extremes_t) :: extremes
      logical, parameter :: wants(seen_quantities) = .true.

      told%class = 0
      one(1) = scene
      one%request%periods = periods
      one%request%sampled_periods = periods
      one%request%until_steady = .false.
      call solve_group(one, [start], wants, group)
      if (.not. is_success(group%endings(1)%status)) return
      call classify_windows(one, group, error)
      if (allocated(error)) return
      associate (record => group%records(1), problem => scene%resolved%problem)
         call note_orbit(group%verdicts(1), told%period)
         told%class = group%verdicts(1)%class
         severity = severity_of_record(record, problem%frequency)
         extremes = extremes_of_record(record)
         told%verdict = verdict_of(problem, extremes, impacts_of_record(record, problem%frequency))
      end associate
      told%acceleration_rms = severity%acceleration_rms
      told%film_force_rms = severity%film_force_rms
      told%film_minimum = extremes%lowest(seen_films(1))%value
   end subroutine judge_motion

   !> Add the motion of a start that does not repeat, if it is irregular.
   subroutine judge_unsettled(scene, judged, state, settled, is_none, error)
      type(scene_t), intent(in) :: scene
      type(judged_scene_t), intent(inout) :: judged
      !> Where the start has come to
      type(motion_state_t), intent(in) :: state
      !> Motions by their places; one that does not repeat has no states
      type(settled_motion_t), allocatable, intent(inout) :: settled(:)
      !> Whether it is not
      logical, intent(out) :: is_none
      type(error_t), allocatable, intent(out) :: error
      type(motion_summary_t) :: told
      type(settled_motion_t) :: without_states
      type(scene_group_t) :: group

      is_none = .true.
      call judge_motion(prepare(scene), state, scene%spectrum%periods, told, group, error)
      if (allocated(error)) return
      if (told%class /= class_irregular_so_far) return
      call follow_irregular([prepare(scene)], group)
      if (must_stop() .or. group%verdicts(1)%class /= class_irregular) return
      told%class = class_irregular
      told%state = group%endings(1)%numbers
      allocate (without_states%states(size(told%state), 0))
      settled = [settled, without_states]
      judged%coexisting%motions = [judged%coexisting%motions, told]
      is_none = .false.
   end subroutine judge_unsettled

   !> Take the state of a motion from which film and velocity alone start it again: contacts with numbers of their own begin at
   !> rest then, and come into the motion by themselves, but perhaps into another one.
   subroutine find_restart(problem, place, settled, told)
      type(problem_t), intent(in) :: problem
      !> Its place among those that are known
      integer, intent(in) :: place
      type(settled_motion_t), intent(in) :: settled(:)
      type(motion_summary_t), intent(inout) :: told
      type(ending_t), allocatable :: endings(:)
      type(motion_state_t), allocatable :: starts(:)
      type(problem_t), allocatable :: problems(:)
      real(dp), allocatable :: states(:, :, :)
      integer :: i, n

      told%restarts = told%period > 0
      if (.not. told%restarts .or. size(told%state) == of_velocity) return
      n = told%period
      allocate (endings(n), starts(n), problems(n))
      problems = problem
      do i = 1, n
         associate (state => settled(place)%states(:, i))
            starts(i) = state_of_start(problem, motion_start_t('given', state(of_film), state(of_velocity)))
         end associate
      end do
      allocate (states(2, size(told%state), n), source=0.0_dp)
      call unlock_texts()
      call solve_motions(problems, starts, request_t(accuracy=start_accuracy, periods=restart_periods, samples_per_period=1, &
                                                     sampled_periods=2), states, endings)
      call lock_texts()
      do i = 1, n
         told%restarts = endings(i)%status == status_complete .and. &
                         reached_motion(problem, known_of(problem, settled), states(1, :, i), states(2, :, i)) == place
         if (.not. told%restarts) cycle
         told%state = settled(place)%states(:, i)
         return
      end do
   end subroutine find_restart

end module follow_starts
