!> All motions of the scenes of a batch that are looked for: from the starts of each scene, and on a grid from the motions of its
!> neighbours, in rounds until no scene lacks a motion that a neighbour has.
module handed_motions
   use engine, only: motion_state_t, state_of_start
   use errors, only: error_t
   use grid_blocks, only: neighbours_of
   use kinds, only: int64
   use motion_start, only: motion_start_t, motion_starts, one_start_reason, several_starts
   use periodic_orbit, only: periodic_orbit_t
   use problem, only: problem_t
   use rattle_class, only: class_irregular
   use prepared_scene, only: prepared_scene_t
   use row_motions, only: are_alike, handed_state, row_motions_t, solve_trials, start_trial_t
   use sampling, only: method_grid, sample_plan_t
   use scene_group, only: scene_group_t
   use scene_orbit, only: orbit_ahead
   use scene_types, only: scene_t
   use known_motions, only: settled_motion_t
   use signals, only: must_stop
   use varied_keys, only: pair_position
   implicit none(type, external)
   private

   !> Seed of the starts that are drawn
   integer, parameter :: start_seed = 1
   !> How often a motion that has not shown what it is, is followed on: the one from rest, and one from another start
   integer, parameter :: own_extensions = 2, other_extensions = 1

   !> Motions that a scene was handed: numbers of the scenes that had them, and their places there; and those that did not settle
   type :: handed_t
      integer, allocatable :: scenes(:), places(:)
      type(settled_motion_t), allocatable :: unsettled(:)
   end type handed_t

   public :: find_other_motions

contains

   !> Find the motions of the scenes of a batch beside those from rest. After a signal to stop they are of no use.
   subroutine find_other_motions(scene, plan, first, scenes, with_verdicts, order, space, found, error)
      !> Base scene
      type(scene_t), intent(in) :: scene
      !> The plan, and number of the first scene of the batch
      type(sample_plan_t), intent(in) :: plan
      integer(int64), intent(in) :: first
      !> Scenes of the batch
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> Whether the verdicts of the motions are asked for
      logical, intent(in) :: with_verdicts
      !> Those of them that were solved from rest, in the order in which they are solved
      integer, intent(in) :: order(:)
      !> Work space
      type(scene_group_t), intent(inout) :: space
      !> With the motions from rest
      type(row_motions_t), intent(inout) :: found(:)
      !> Set if there is no memory for the samples of a scene
      type(error_t), allocatable, intent(out) :: error
      integer :: place

      do place = 1, size(order)
         found(order(place))%told%one_start_reason = one_start_reason(scenes(order(place))%resolved%problem, scene%solver%method)
      end do
      call try_starts(pack(order, found(order)%told%one_start_reason == several_starts .and. found(order)%told%starts_solved > 0))
      if (must_stop() .or. allocated(error)) return
      if (scene%campaign%neighbours .and. plan%method == method_grid) call hand_on_motions

   contains

      !> Follow all starts but the first, rest. A motion from rest that has not shown what it is, is followed on before them, others
      !> after them.
      subroutine try_starts(places)
         !> Places of the scenes that have several starts
         integer, intent(in) :: places(:)
         type(motion_start_t) :: starts(scene%solver%starts, size(places))
         type(motion_state_t) :: state
         type(start_trial_t) :: trials(size(places), scene%solver%starts)
         logical :: follows(size(places))
         integer :: number, i

         do i = 1, size(places)
            associate (own => found(places(i)))
               trials(i, 1) = start_trial_t(places(i), own%settled(1)%states(:, 1), is_own=.true.)
               follows(i) = own%settled(1)%period == 0 .and. own%told%motions(1)%class /= class_irregular
            end associate
            starts(:, i) = motion_starts(scenes(places(i))%resolved%problem, scene%solver%starts, start_seed)
         end do
         call follow_on(follows, trials(:, 1))
         if (must_stop() .or. allocated(error)) return
         do number = 2, scene%solver%starts
            do i = 1, size(places)
               state = state_of_start(scenes(places(i))%resolved%problem, starts(number, i))
               trials(i, number) = start_trial_t(places(i), state%numbers)
            end do
            call try(trials(:, number))
            if (must_stop() .or. allocated(error)) return
         end do
         ! Of starts that settle slowly the next one is followed on only if those before it have shown where they lead.
         follows = .true.
         do number = 2, scene%solver%starts
            follows = follows .and. [(all(found(places(i))%told%motions%class /= class_irregular), i=1, size(places))]
            trials(:, number)%goes_on = .true.
            call follow_on(follows .and. trials(:, number)%is_open, trials(:, number))
            if (must_stop() .or. allocated(error)) return
            follows = follows .and. .not. trials(:, number)%is_open
         end do
      end subroutine try_starts

      !> Hand every motion to the neighbours that have none like it, in rounds ordered by the numbers of the scenes.
      subroutine hand_on_motions
         type(handed_t) :: handed(size(found))
         type(start_trial_t), allocatable :: trials(:)
         integer :: i, last

         do i = 1, size(handed)
            allocate (handed(i)%scenes(0), handed(i)%places(0), handed(i)%unsettled(0))
         end do
         do
            call next_round(plan, first, scenes, found, handed, trials)
            if (size(trials) == 0) return
            call try(trials)
            if (must_stop() .or. allocated(error)) return
            trials%goes_on = .true.
            call follow_on(trials%is_next_to_one, trials)
            if (must_stop() .or. allocated(error)) return
            do i = 1, size(trials)
               if (trials(i)%settled) cycle
               associate (to => handed(trials(i)%scene))
                  ! The trials of a scene are the last ones that it was handed, in their order.
                  last = size(to%scenes) - count(trials(i:)%scene == trials(i)%scene) + 1
                  to%unsettled = [to%unsettled, found(to%scenes(last))%settled(to%places(last))]
               end associate
            end do
         end do
      end subroutine hand_on_motions

      !> Follow the ends of motions on, each time by as many periods as before, until they have shown what they are. What settles
      !> slowly is next to a stable periodic motion: where Newton's method finds one, the motion goes on from there.
      subroutine follow_on(followed, trials)
         !> Which of the trials
         logical, intent(in) :: followed(:)
         type(start_trial_t), intent(inout) :: trials(:)
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
               call go_to_orbit(scenes(these(i)%scene)%resolved%problem, these(i))
            end do
            call try(these)
            if (must_stop() .or. allocated(error)) return
            trials(left) = these
            left = pack(left, these%is_open)
         end do
      end subroutine follow_on

      !> Solve some starts side by side.
      subroutine try(trials)
         type(start_trial_t), intent(inout) :: trials(:)

         call solve_trials(scenes, with_verdicts, trials, space, found, error)
      end subroutine try

   end subroutine find_other_motions

   !> Where a trial nears a stable periodic motion, it starts on that one.
   subroutine go_to_orbit(problem, trial)
      type(problem_t), intent(in) :: problem
      type(start_trial_t), intent(inout) :: trial
      type(periodic_orbit_t) :: orbit

      orbit = orbit_ahead(problem, motion_state_t(numbers=trial%state))
      if (orbit%period > 0) trial%state = orbit%state
   end subroutine go_to_orbit

   !> Starts of the next round. Of motions that are alike a scene is handed one in a round, and none any more if one did not settle.
   subroutine next_round(plan, first, scenes, found, handed, trials)
      type(sample_plan_t), intent(in) :: plan
      integer(int64), intent(in) :: first
      type(prepared_scene_t), intent(in) :: scenes(:)
      type(row_motions_t), intent(in) :: found(:)
      type(handed_t), intent(inout) :: handed(:)
      type(start_trial_t), allocatable, intent(out) :: trials(:)
      type(settled_motion_t), allocatable :: known(:)
      integer(int64), allocatable :: neighbours(:)
      integer :: to, from, i, place

      allocate (trials(0))
      do to = 1, size(found)
         if (.not. takes_part(found(to))) cycle
         neighbours = neighbours_of(plan, first + int(to - 1, int64), plan%positions /= pair_position())
         known = [found(to)%settled, handed(to)%unsettled]
         do i = 1, size(neighbours)
            if (neighbours(i) < first .or. neighbours(i) >= first + size(found, kind=int64)) cycle
            from = int(neighbours(i) - first) + 1
            if (.not. takes_part(found(from))) cycle
            do place = 1, size(found(from)%settled)
               associate (motion => found(from)%settled(place))
                  if (any(handed(to)%scenes == from .and. handed(to)%places == place)) cycle
                  if (any(are_alike(known, motion))) cycle
                  ! Where one that is neither periodic nor known to be irregular is going, nobody knows.
                  if (motion%period == 0 .and. found(from)%told%motions(place)%class /= class_irregular) cycle
                  handed(to)%scenes = [handed(to)%scenes, from]
                  handed(to)%places = [handed(to)%places, place]
                  known = [known, motion]
                  trials = [trials, start_trial_t(to, handed_state(scenes(to)%resolved%problem, motion, &
                                                                   scenes(from)%resolved%problem))]
               end associate
            end do
         end do
      end do
   end subroutine next_round

   !> Whether a scene was solved from several starts: one that needs no other start needs no neighbours, nor has anything for them.
   pure logical function takes_part(found)
      type(row_motions_t), intent(in) :: found

      takes_part = found%told%starts_solved > 1
   end function takes_part

end module handed_motions
