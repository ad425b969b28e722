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
      !> Place of its scene, and number of the start, 1 its own; 0: it was handed on
      integer :: scene = 0
      integer :: number = 0
      real(dp), allocatable :: state(:)
      !> Whether it is the end of the scene's own motion, or of another start, which is followed on
      logical :: is_own = .false., goes_on = .false.
      !> Periods after which it repeats, as Newton's method has found; 0: it is not known
      integer :: period = 0
      !> On return, whether it came to a motion that is known now
      logical :: has_motion = .false.
      !> Whether it came to a motion that repeats, and whether it did not and may still, or came next to one whose acceleration its
      !> window does not show; the state is that of its end then
      logical :: settled = .false., is_open = .false., is_next_to_one = .false.
   end type start_trial_t

   public :: find_other_motions, solve_trials, follow_on

contains

   !> Find the motions of scenes that have several starts. A motion of a scene that has not shown what it is, is followed on before
   !> the other starts, others after them. After a signal to stop they are of no use.
   subroutine find_other_motions(scenes, space, judged, error, ends_at)
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> Work space
      type(scene_group_t), intent(inout) :: space
      !> Judged scenes, with their own motions; the others are added
      type(judged_scene_t), intent(inout) :: judged(:)
      !> Set if there is no memory for the samples of a scene
      type(error_t), allocatable, intent(out) :: error
      !> When no further start is begun, on the clock of wall_seconds [s]; absent: there is no such time
      real(dp), intent(in), optional :: ends_at
      type(start_trial_t), allocatable :: trials(:)
      integer :: number, i

      call list_trials(scenes, judged, trials)
      if (size(trials) == 0) return
      if (in_time()) call follow_on(scenes, trials%is_open, space, trials, judged, error)
      ! The first one alone, since a motion that it finds ends others that come to it; then all others.
      if (in_time()) call solve_some(scenes, trials%number == 2, space, trials, judged, error)
      if (in_time()) call solve_some(scenes, trials%number > 2, space, trials, judged, error)
      trials%goes_on = .true.
      if (in_time()) call lead_to_orbits(scenes, space, trials, judged, error)
      do number = 2, maxval(trials%number)
         if (in_time()) call solve_some(scenes, [(is_next(trials(i)), i=1, size(trials))], space, trials, judged, error)
      end do
      ! The scene's own motion may be one that another start has shown to be.
      if (in_time()) call solve_some(scenes, trials%is_own .and. trials%is_open .and. &
                                     [(size(judged(trials(i)%scene)%settled) > 1, i=1, size(trials))], space, trials, judged, error)
      if (must_stop() .or. allocated(error)) return
      call count_left(trials, judged)

   contains

      !> Whether more may be solved.
      logical function in_time()

         in_time = .not. (must_stop() .or. allocated(error))
         if (present(ends_at) .and. in_time) in_time = wall_seconds() < ends_at
      end function in_time

      !> Whether a start of this number is followed on: of starts that settle slowly the next one only if those before it have shown
      !> where they lead.
      pure logical function is_next(trial)
         type(start_trial_t), intent(in) :: trial

         is_next = trial%number == number .and. trial%is_open
         if (is_next) is_next = all(judged(trial%scene)%coexisting%motions%class /= class_irregular) .and. &
                                .not. any(trials%scene == trial%scene .and. trials%is_open .and. &
                                          trials%number > 1 .and. trials%number < number)
      end function is_next

   end subroutine find_other_motions

   !> Starts of all scenes that have several: first the ends of the scenes' own motions, then the second starts of all, and so on.
   pure subroutine list_trials(scenes, judged, trials)
      type(prepared_scene_t), intent(in) :: scenes(:)
      type(judged_scene_t), intent(in) :: judged(:)
      type(start_trial_t), allocatable, intent(out) :: trials(:)
      type(start_trial_t), allocatable :: of_scene(:, :)
      type(motion_start_t), allocatable :: starts(:)
      type(motion_state_t) :: state
      integer, allocatable :: places(:)
      integer :: number, i

      places = pack([(i, i=1, size(scenes))], judged%coexisting%one_start_reason == several_starts .and. &
                    judged%coexisting%starts_solved > 0 .and. scenes%starts > 1)
      if (size(places) == 0) then
         allocate (trials(0))
         return
      end if
      allocate (of_scene(size(places), maxval(scenes(places)%starts)))
      do i = 1, size(places)
         associate (problem => scenes(places(i))%resolved%problem, own => judged(places(i)))
            starts = motion_starts(problem, size(of_scene, 2), seed)
            of_scene(i, 1) = start_trial_t(places(i), 1, own%settled(1)%states(:, 1), is_own=.true., &
                                           is_open=own%settled(1)%period == 0 .and. &
                                           own%coexisting%motions(1)%class /= class_irregular)
            do number = 2, size(starts)
               state = state_of_start(problem, starts(number))
               of_scene(i, number) = start_trial_t(places(i), number, state%numbers)
            end do
         end associate
      end do
      trials = reshape(of_scene, [size(of_scene)])
   end subroutine list_trials

   !> Solve all starts that settle slowly from the periodic motion that they near, where there is one. Where several in a row have
   !> found none, the next ones look for it near their ends alone.
   subroutine lead_to_orbits(scenes, space, trials, judged, error)
      type(prepared_scene_t), intent(in) :: scenes(:)
      type(scene_group_t), intent(inout) :: space
      type(start_trial_t), intent(inout) :: trials(:)
      type(judged_scene_t), intent(inout) :: judged(:)
      type(error_t), allocatable, intent(out) :: error
      integer :: failures(size(scenes)), i

      failures = 0
      do i = 1, size(trials)
         if (must_stop()) return
         if (trials(i)%is_own .or. .not. trials(i)%is_open) cycle
         associate (failed => failures(trials(i)%scene))
            call lead_to_orbit(scenes(trials(i)%scene)%resolved%problem, failed < most_failures, trials(i))
            failed = merge(0, failed + 1, trials(i)%period > 0)
         end associate
      end do
      call solve_some(scenes, trials%period > 0, space, trials, judged, error)
   end subroutine lead_to_orbits

   !> Solve some of the trials, on from their states.
   subroutine solve_some(scenes, solved, space, trials, judged, error)
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> Which
      logical, intent(in) :: solved(:)
      type(scene_group_t), intent(inout) :: space
      type(start_trial_t), intent(inout) :: trials(:)
      type(judged_scene_t), intent(inout) :: judged(:)
      type(error_t), allocatable, intent(out) :: error
      type(start_trial_t) :: these(count(solved))

      these = pack(trials, solved)
      call solve_trials(scenes, these, space, judged, error)
      trials = unpack(these, solved, trials)
   end subroutine solve_some

   !> Count the starts that are left: those that do not settle are taken to have the irregular motion, where there is one.
   pure subroutine count_left(trials, judged)
      type(start_trial_t), intent(in) :: trials(:)
      type(judged_scene_t), intent(inout) :: judged(:)
      integer :: i, place

      do i = 1, size(trials)
         if (trials(i)%is_own) cycle
         associate (coexisting => judged(trials(i)%scene)%coexisting)
            if (trials(i)%settled .and. trials(i)%number > chosen_starts) coexisting%drawn_starts = coexisting%drawn_starts + 1
            if (trials(i)%has_motion .or. .not. trials(i)%is_open) cycle
            place = findloc(coexisting%motions%class, class_irregular, dim=1)
            if (place > 0) coexisting%motions(place)%starts = coexisting%motions(place)%starts + 1
         end associate
      end do
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
   subroutine follow_on(scenes, followed, space, trials, judged, error)
      type(prepared_scene_t), intent(in) :: scenes(:)
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
         call solve_trials(scenes, these, space, judged, error)
         if (must_stop() .or. allocated(error)) return
         trials(left) = these
         left = pack(left, these%is_open)
      end do
   end subroutine follow_on

   !> Solve some starts side by side, and add the motions that they lead to and that are not known yet; the first of those that lead
   !> to one motion counts. After a signal to stop the motions are of no use.
   subroutine solve_trials(scenes, trials, space, judged, error)
      type(prepared_scene_t), intent(in) :: scenes(:)
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
            tried(k) = tried_scene(scenes(trials(own(k))%scene), trials(own(k))%period)
            starts(k)%numbers = trials(own(k))%state
         end do
         wants = .false.
         wants(seen_films(1)) = .true.
         wants([seen_loads(1), seen_net_load]) = any(tried%request%impact_limit > 0.0_dp)
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
   pure type(prepared_scene_t) function tried_scene(scene, period) result(tried)
      type(prepared_scene_t), intent(in) :: scene
      !> That period, or 0
      integer, intent(in) :: period

      tried = with_accuracy(scene, max(scene%request%accuracy, enough_accuracy))
      tried%request%periods = merge(period, min(scene%request%periods, most_periods), period > 0)
      if (period > 0) tried%request%sampled_periods = period
      tried%request%until_steady = period == 0
      tried%request%forecast = period == 0
      tried%request%all_samples = .false.
      tried%request%impact_limit = merge(scene%spectrum%impact_limit, 0.0_dp, scene%start_verdicts)
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
   !> irregular ones cannot be distinguished.
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
            if (.not. trial%settled .and. motion%period > 0 .and. class == class_subharmonic .and. &
                group%repeat_after(place) > 1) then
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
