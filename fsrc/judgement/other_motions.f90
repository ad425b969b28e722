!> Motions of scenes from other starts than their own: of all scenes side by side. A start ends as soon as it has
!> come to a motion that is known of its scene.
module other_motions
   use classify_group, only: classify_windows, follow_irregular
   use clock, only: wall_seconds
   use coexisting_motions, only: coexisting_motions_t, motion_summary_t
   use engine, only: motion_state_t, reserved_periods, same_request, state_of_start
   use errors, only: error_t
   use judged_scene, only: judged_scene_t
   use kinds, only: dp
   use known_motions, only: are_near, known_motions_t, known_of, near_states, same_motion, settled_motion_t
   use motion_start, only: chosen_starts, motion_start_t, motion_starts, several_starts
   use node_extremes, only: seen_films, seen_loads, seen_net_load, seen_quantities
   use periodic_orbit, only: periodic_orbit_t
   use prepared_scene, only: prepared_scene_t, with_accuracy
   use problem, only: problem_t
   use rattle_class, only: class_irregular, class_irregular_so_far, class_subharmonic, note_orbit
   use scene_group, only: has_window, scene_group_t, solve_group
   use scene_orbit, only: orbit_ahead
   use scene_status, only: is_success
   use signals, only: must_stop
   use window_motion, only: enough_accuracy, motion_of_window, summary_of_window
   implicit none(type, external)
   private

   !> Seed of the starts that are drawn
   integer, parameter :: seed = 1
   !> Most periods of a start, where its scene may have more
   integer, parameter :: most_periods = 120
   !> How often a motion that has not shown what it is, is followed on: the scene's own, and one from another start
   integer, parameter :: own_extensions = 2, other_extensions = 1
   !> Starts in a row that may find no periodic motion far from their ends
   integer, parameter :: most_failures = 8
   !> Samples of windows that are solved side by side: no more than these, but for as many windows as there are scenes
   integer, parameter :: samples_together = 2**21

   !> A state to start from.
   type, public :: start_trial_t
      !> Place of its scene
      integer :: scene = 0
      real(dp), allocatable :: state(:)
      !> Whether it is the end of the scene's own motion, or of another start, which is followed on
      logical :: is_own = .false., goes_on = .false.
      !> Periods after which it repeats, as Newton's method has found; 0: it is not known
      integer :: period = 0
      !> On return, whether it came to a motion that is known now
      logical :: has_motion = .false.
      !> Whether it came to a motion that repeats, and whether it did not and may still, or came next to one whose acceleration its
      !> window does not tell; the state is that of its end then
      logical :: settled = .false., is_open = .false., is_next_to_one = .false.
   end type start_trial_t

   public :: find_other_motions, solve_trials, follow_on

contains

   !> Find the motions of scenes that have several starts. A motion of a scene that has not shown what it is, is followed on before
   !> the other starts, others after them. After a signal to stop they are of no use.
   subroutine find_other_motions(scenes, with_verdicts, space, judged, error, ends_at)
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> Whether the verdicts of the motions are asked for
      logical, intent(in) :: with_verdicts
      !> Work space
      type(scene_group_t), intent(inout) :: space
      !> Judged scenes, with their own motions; the others are added
      type(judged_scene_t), intent(inout) :: judged(:)
      !> Set if there is no memory for the samples of a scene
      type(error_t), allocatable, intent(out) :: error
      !> When no further start is begun, on the clock of wall_seconds [s]; absent: there is no such time
      real(dp), intent(in), optional :: ends_at
      type(start_trial_t), allocatable :: trials(:, :)
      integer, allocatable :: places(:)
      logical, allocatable :: follows(:)
      integer :: first, last, number, i

      places = pack([(i, i=1, size(scenes))], judged%coexisting%one_start_reason == several_starts .and. &
                    judged%coexisting%starts_solved > 0 .and. scenes%starts > 1)
      if (size(places) == 0) return
      allocate (trials(size(places), maxval(scenes(places)%starts)))
      do i = 1, size(places)
         trials(i, :) = trials_of(places(i), scenes(places(i))%resolved%problem, size(trials, 2), judged(places(i)))
      end do
      follows = [(judged(places(i))%settled(1)%period == 0 .and. &
                  judged(places(i))%coexisting%motions(1)%class /= class_irregular, i=1, size(places))]
      if (in_time()) call follow_on(scenes, with_verdicts, follows, space, trials(:, 1), judged, error)
      ! The first one alone, since a motion that it finds ends others that come to it; then all others.
      first = 2
      do
         if (first > size(trials, 2)) exit
         if (.not. in_time()) exit
         last = merge(2, size(trials, 2), first == 2)
         call solve_wave(scenes, with_verdicts, trials(:, first:last), space, judged, error)
         first = last + 1
      end do
      if (in_time()) call lead_to_orbits(scenes, with_verdicts, trials(:, 2:first - 1), space, judged, error)
      ! Of starts that settle slowly the next one is followed on only if those before it have shown where they lead.
      follows = .true.
      do number = 2, first - 1
         if (.not. in_time()) exit
         follows = follows .and. [(all(judged(places(i))%coexisting%motions%class /= class_irregular), i=1, size(places))]
         call solve_again(scenes, with_verdicts, follows .and. trials(:, number)%is_open, trials(:, number), space, judged, error)
         follows = follows .and. .not. trials(:, number)%is_open
      end do
      ! The scene's own motion may be one that another start has shown to be.
      follows = trials(:, 1)%is_open .and. [(size(judged(places(i))%settled) > 1, i=1, size(places))]
      if (in_time()) call solve_again(scenes, with_verdicts, follows, trials(:, 1), space, judged, error)
      if (must_stop() .or. allocated(error)) return
      do i = 1, size(places)
         call count_left(trials(i, 2:first - 1), judged(places(i))%coexisting)
      end do

   contains

      !> Whether more may be solved.
      logical function in_time()

         in_time = .not. (must_stop() .or. allocated(error))
         if (present(ends_at) .and. in_time) in_time = wall_seconds() < ends_at
      end function in_time

   end subroutine find_other_motions

   !> Solve the next starts of all scenes.
   subroutine solve_wave(scenes, with_verdicts, wave, space, judged, error)
      type(prepared_scene_t), intent(in) :: scenes(:)
      logical, intent(in) :: with_verdicts
      !> Scene, start
      type(start_trial_t), intent(inout) :: wave(:, :)
      type(scene_group_t), intent(inout) :: space
      type(judged_scene_t), intent(inout) :: judged(:)
      type(error_t), allocatable, intent(out) :: error
      type(start_trial_t) :: trials(size(wave))

      trials = reshape(wave, [size(wave)])
      call solve_trials(scenes, with_verdicts, trials, space, judged, error)
      wave = reshape(trials, shape(wave))
   end subroutine solve_wave

   !> Solve all starts that settle slowly from the periodic motion that they near, where there is one. Where several
   !> in a row have found none, the next ones look for it near their ends alone.
   subroutine lead_to_orbits(scenes, with_verdicts, others, space, judged, error)
      type(prepared_scene_t), intent(in) :: scenes(:)
      logical, intent(in) :: with_verdicts
      !> Scene, start
      type(start_trial_t), intent(inout) :: others(:, :)
      type(scene_group_t), intent(inout) :: space
      type(judged_scene_t), intent(inout) :: judged(:)
      type(error_t), allocatable, intent(out) :: error
      type(start_trial_t) :: trials(size(others))
      logical :: is_led(size(others))
      integer :: failures(size(scenes)), i

      others%goes_on = .true.
      trials = reshape(others, [size(others)])
      is_led = trials%is_open
      failures = 0
      do i = 1, size(trials)
         if (must_stop()) return
         if (.not. is_led(i)) cycle
         associate (failed => failures(trials(i)%scene))
            call lead_to_orbit(scenes(trials(i)%scene)%resolved%problem, failed < most_failures, trials(i))
            is_led(i) = trials(i)%period > 0
            failed = merge(0, failed + 1, is_led(i))
         end associate
      end do
      call solve_again(scenes, with_verdicts, is_led, trials, space, judged, error)
      others = reshape(trials, shape(others))
   end subroutine lead_to_orbits

   !> Solve some trials on from their states.
   subroutine solve_again(scenes, with_verdicts, followed, trials, space, judged, error)
      type(prepared_scene_t), intent(in) :: scenes(:)
      logical, intent(in) :: with_verdicts
      logical, intent(in) :: followed(:)
      type(start_trial_t), intent(inout) :: trials(:)
      type(scene_group_t), intent(inout) :: space
      type(judged_scene_t), intent(inout) :: judged(:)
      type(error_t), allocatable, intent(out) :: error
      type(start_trial_t) :: these(count(followed))

      these = pack(trials, followed)
      call solve_trials(scenes, with_verdicts, these, space, judged, error)
      trials = unpack(these, followed, trials)
   end subroutine solve_again

   !> The end of a scene's own motion, and its other starts.
   pure function trials_of(place, problem, count, judged) result(trials)
      !> Place of the scene
      integer, intent(in) :: place
      type(problem_t), intent(in) :: problem
      !> Of all starts
      integer, intent(in) :: count
      type(judged_scene_t), intent(in) :: judged
      type(start_trial_t) :: trials(count)
      type(motion_start_t) :: starts(count)
      type(motion_state_t) :: state
      integer :: i

      starts = motion_starts(problem, count, seed)
      trials(1) = start_trial_t(place, judged%settled(1)%states(:, 1), is_own=.true.)
      do i = 2, count
         state = state_of_start(problem, starts(i))
         trials(i) = start_trial_t(place, state%numbers)
      end do
   end function trials_of

   !> Count the starts that are left: those that do not settle are taken to have the irregular motion, where there is one.
   pure subroutine count_left(trials, coexisting)
      !> All starts but the scene's own
      type(start_trial_t), intent(in) :: trials(:)
      type(coexisting_motions_t), intent(inout) :: coexisting
      integer :: i

      coexisting%drawn_starts = count(trials(chosen_starts:)%settled)
      i = findloc(coexisting%motions%class, class_irregular, dim=1)
      if (i > 0) coexisting%motions(i)%starts = coexisting%motions(i)%starts + count(trials%is_open .and. .not. trials%has_motion)
   end subroutine count_left

   !> Where a motion nears a stable periodic one, it goes on from that.
   subroutine lead_to_orbit(problem, from_far, trial)
      type(problem_t), intent(in) :: problem
      !> Whether that may be far from where the motion has come to
      logical, intent(in) :: from_far
      !> With the period of the periodic motion, or 0
      type(start_trial_t), intent(inout) :: trial
      type(periodic_orbit_t) :: orbit

      orbit = orbit_ahead(problem, motion_state_t(numbers=trial%state), from_far)
      trial%period = orbit%period
      if (orbit%period > 0) trial%state = orbit%state
   end subroutine lead_to_orbit

   !> Follow the ends of motions on, each time by as many periods as before, until they have shown what they are. What settles slowly
   !> is next to a stable periodic motion: where Newton's method finds one, the motion goes on from there.
   subroutine follow_on(scenes, with_verdicts, followed, space, trials, judged, error)
      type(prepared_scene_t), intent(in) :: scenes(:)
      logical, intent(in) :: with_verdicts
      !> Which of the trials
      logical, intent(in) :: followed(:)
      type(scene_group_t), intent(inout) :: space
      type(start_trial_t), intent(inout) :: trials(:)
      type(judged_scene_t), intent(inout) :: judged(:)
      type(error_t), allocatable, intent(out) :: error
      type(start_trial_t), allocatable :: these(:)
      integer, allocatable :: left(:)
      integer :: extension, i

      left = pack([(i, i=1, size(trials))], followed)
      do extension = 1, max(own_extensions, other_extensions)
         left = pack(left, extension <= merge(own_extensions, other_extensions, trials(left)%is_own))
         if (size(left) == 0) return
         these = trials(left)
         do i = 1, size(these)
            if (must_stop()) return
            call lead_to_orbit(scenes(these(i)%scene)%resolved%problem, .true., these(i))
         end do
         call solve_trials(scenes, with_verdicts, these, space, judged, error)
         if (must_stop() .or. allocated(error)) return
         trials(left) = these
         left = pack(left, these%is_open)
      end do
   end subroutine follow_on

   !> Solve some starts side by side, and add the motions that they lead to and that are not known yet; the first of those that lead
   !> to one motion counts. After a signal to stop the motions are of no use.
   subroutine solve_trials(scenes, with_verdicts, trials, space, judged, error)
      type(prepared_scene_t), intent(in) :: scenes(:)
      logical, intent(in) :: with_verdicts
      type(start_trial_t), intent(inout) :: trials(:)
      type(scene_group_t), intent(inout) :: space
      type(judged_scene_t), intent(inout) :: judged(:)
      !> Set if there is no memory for the samples of a scene
      type(error_t), allocatable, intent(out) :: error
      type(known_motions_t) :: known(size(trials))
      integer, allocatable :: alike(:)
      logical :: left(size(trials)), is_alike(size(trials))
      integer :: together, first, i

      do i = 1, size(trials)
         known(i) = known_of(scenes(trials(i)%scene)%resolved%problem, judged(trials(i)%scene)%settled)
      end do
      left = .true.
      do while (any(left))
         first = findloc(left, .true., dim=1)
         associate (request => scenes(trials(first)%scene)%request)
            is_alike = left .and. trials%period == trials(first)%period .and. same_request(scenes(trials%scene)%request, request)
            together = max(size(scenes), samples_together/(reserved_periods(request%sampled_periods)*request%samples_per_period))
         end associate
         alike = pack([(i, i=1, size(trials))], is_alike)
         do first = 1, size(alike), together
            call solve_alike(alike(first:min(first + together - 1, size(alike))))
            if (must_stop() .or. allocated(error)) return
         end do
         left = left .and. .not. is_alike
      end do

   contains

      !> Solve starts of scenes that ask for the same.
      subroutine solve_alike(own)
         integer, intent(in) :: own(:)
         type(prepared_scene_t) :: tried(size(own))
         type(motion_state_t) :: starts(size(own))
         logical :: wants(seen_quantities)
         integer :: k

         do k = 1, size(own)
            tried(k) = tried_scene(scenes(trials(own(k))%scene), trials(own(k))%period, with_verdicts)
            starts(k)%numbers = trials(own(k))%state
         end do
         wants = .false.
         wants(seen_films(1)) = .true.
         wants([seen_loads(1), seen_net_load]) = with_verdicts
         call solve_group(tried, starts, wants, space, known(own))
         call classify_windows(tried, space, error)
         if (must_stop() .or. allocated(error)) return
         do k = 1, size(own)
            if (has_window(space%endings(k))) call note_orbit(space%verdicts(k), trials(own(k))%period)
         end do
         call follow_irregular(tried, space, are_followed(trials(own), judged, space))
         if (must_stop()) return
         do k = 1, size(own)
            call add_motion(tried(k), k, space, trials(own(k)), judged(trials(own(k))%scene))
         end do
      end subroutine solve_alike

   end subroutine solve_trials

   !> A scene as it is solved from another start: until it repeats, or for the period of the motion that it starts on.
   pure type(prepared_scene_t) function tried_scene(scene, period, with_verdicts) result(tried)
      type(prepared_scene_t), intent(in) :: scene
      !> That period, or 0
      integer, intent(in) :: period
      logical, intent(in) :: with_verdicts

      tried = with_accuracy(scene, max(scene%request%accuracy, enough_accuracy))
      tried%request%periods = merge(period, min(scene%request%periods, most_periods), period > 0)
      if (period > 0) tried%request%sampled_periods = period
      tried%request%until_steady = period == 0
      tried%request%forecast = period == 0
      tried%request%all_samples = .false.
      tried%request%impact_limit = merge(scene%spectrum%impact_limit, 0.0_dp, with_verdicts)
   end function tried_scene

   !> Motions off their harmonics that are followed beside neighbours: the ends of the scenes' own ones, and of each scene whose known
   !> motions all repeat one more.
   pure function are_followed(trials, judged, group) result(followed)
      type(start_trial_t), intent(in) :: trials(:)
      type(judged_scene_t), intent(in) :: judged(:)
      !> With the classes of the trials
      type(scene_group_t), intent(in) :: group
      logical :: followed(size(trials))
      integer :: k

      followed = .false.
      do k = 1, size(trials)
         if (.not. has_window(group%endings(k))) cycle
         if (group%verdicts(k)%class /= class_irregular_so_far) cycle
         followed(k) = trials(k)%is_own .or. (all(judged(trials(k)%scene)%settled%period > 0) .and. &
                                              .not. any(followed .and. trials%scene == trials(k)%scene))
      end do
   end function are_followed

   !> Count a start, and add its motion if that is none of those that are known: one that repeats within the accuracy, or next to
   !> whose end a motion that repeats was found, and whose states are others, or an irregular one where all others repeat. Two
   !> irregular ones cannot be told apart.
   subroutine add_motion(scene, place, group, trial, judged)
      type(prepared_scene_t), intent(in) :: scene
      !> Place of the start in its group
      integer, intent(in) :: place
      type(scene_group_t), intent(in) :: group
      type(start_trial_t), intent(inout) :: trial
      !> Its scene
      type(judged_scene_t), intent(inout) :: judged
      type(settled_motion_t) :: motion
      integer :: known, i

      associate (ending => group%endings(place), problem => scene%resolved%problem, class => group%verdicts(place)%class, &
                 coexisting => judged%coexisting)
         if (.not. (trial%is_own .or. trial%goes_on)) coexisting%starts_solved = coexisting%starts_solved + 1
         coexisting%extra_periods = coexisting%extra_periods + ending%periods
         known = ending%known
         trial%settled = ending%orbit > 0
         trial%is_next_to_one = .false.
         trial%is_open = .false.
         if (has_window(ending)) then
            motion = motion_of_window(problem, scene%request%samples_per_period, place, group)
            if (trial%period > 0) call note_return
            if (.not. trial%settled .and. motion%period > 0 .and. class == class_subharmonic) then
               trial%is_next_to_one = motion%rms_is_rough
               trial%settled = .not. trial%is_next_to_one
            end if
            if (trial%settled) then
               do i = 1, size(judged%settled)
                  if (same_motion(problem, judged%settled(i), motion)) known = i
               end do
            else
               motion%period = 0
               motion%states = motion%states(:, size(motion%states, 2):)
               trial%is_open = class /= class_irregular
               if (class == class_irregular) known = findloc(judged%settled%period, 0, dim=1)
               if (trial%is_own .and. known == 1) call note_irregular(summary_of_window(problem, place, group, motion))
            end if
            if (known == 0 .and. .not. trial%is_open) then
               judged%settled = [judged%settled, motion]
               coexisting%motions = [coexisting%motions, summary_of_window(problem, place, group, motion)]
               known = size(judged%settled)
            end if
         end if
         if (trial%is_open) trial%state = ending%numbers
      end associate
      trial%period = 0
      if (.not. trial%is_own) then
         if (known > 0 .and. .not. trial%has_motion) &
            judged%coexisting%motions(known)%starts = judged%coexisting%motions(known)%starts + 1
         if (trial%settled .eqv. trial%goes_on) &
            judged%coexisting%unsettled_starts = judged%coexisting%unsettled_starts + merge(-1, 1, trial%settled)
      else if (known > 1) then
         call give_own_motion(known, trial%settled, judged)
      end if
      trial%has_motion = trial%has_motion .or. known > 0

   contains

      !> A motion that starts on a periodic one is that if it comes back to where it started.
      subroutine note_return
         integer :: samples, k

         associate (problem => scene%resolved%problem, states => group%states(:, :, place))
            samples = scene%request%samples_per_period
            motion%period = trial%period
            motion%states = transpose(states([(k*samples, k=1, trial%period)], :size(trial%state)))
            motion%rms_is_rough = .false.
            trial%settled = are_near(problem, near_states(problem), motion%states(:, trial%period), trial%state)
         end associate
      end subroutine note_return

      !> The scene's own motion, followed on, is irregular.
      subroutine note_irregular(summary)
         type(motion_summary_t), intent(in) :: summary

         judged%settled(1) = motion
         judged%coexisting%motions(1) = summary
         judged%coexisting%motions(1)%from_own_start = .true.
         judged%coexisting%motions(1)%starts = 1
      end subroutine note_irregular

   end subroutine add_motion

   !> The scene's own motion, followed on, has come to another one: it is that one.
   subroutine give_own_motion(known, settled, judged)
      !> Its place
      integer, intent(in) :: known
      !> Whether that one repeats
      logical, intent(in) :: settled
      type(judged_scene_t), intent(inout) :: judged
      !> One less than there are: that of the own start was no motion of its own
      integer :: order(size(judged%settled) - 1), others(size(judged%settled) - 1), i

      others = [(i, i=2, size(judged%settled))]
      order = [known, pack(others, others /= known)]
      judged%settled = judged%settled(order)
      associate (coexisting => judged%coexisting)
         coexisting%motions = coexisting%motions(order)
         coexisting%motions(1)%from_own_start = .true.
         coexisting%motions(1)%starts = coexisting%motions(1)%starts + 1
         if (settled) coexisting%unsettled_starts = coexisting%unsettled_starts - 1
      end associate
   end subroutine give_own_motion

end module other_motions
