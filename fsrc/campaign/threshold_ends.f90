!> Where the motions on both sides of a crossing end. A bracket is where the motion from rest changes; motions that are on a side
!> of the criterion may go on beyond it. Those that the starts of both ends lead to are followed: of the side below to larger
!> values of the key, of the side above to smaller ones. Where branches overlap, either side is possible. In a trace without a
!> bracket starts at both ends of the range and in its middle may lead to motions on another side: these are followed both ways.
!>
!> Motions that repeat are followed as branches. Where one ends, the motion that follows there may be on the same side, and is
!> followed on; so is one that does not repeat, value by value, each from the state of the value before.
module threshold_ends
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use engine, only: motion_state_t, state_of_start
   use errors, only: error_t
   use kinds, only: dp
   use known_motions, only: are_near, known_motions_t, near_states
   use motion_branch, only: branch_end_t, branch_point_t, end_bracketed, end_lost, end_no_start, end_of_kind, end_of_range, &
      follow_branch, point_at
   use motion_start, only: motion_start_t, motion_starts, start_count
   use prepared_threshold, only: prepared_threshold_t
   use problem, only: problem_t
   use quantities, only: needs_orbit, needs_starts, needs_verification, needs_verified_impacts, part_cost, part_scene, &
      quantity_table
   use sampling, only: scene_values
   use scene_family, only: judged_start_t, scene_family_t
   use scene_types, only: method_newmark, scene_t
   use signals, only: must_stop
   use threshold_search, only: bracket_t, is_crossing, side_unknown
   implicit none(type, external)
   private

   !> Numbers of both ends: last value of the motions of the side below and above, and how they end there
   integer, parameter, public :: end_numbers = 4
   !> Most branches that one motion is followed over
   integer, parameter :: most_branches = 12
   !> By how much a motion is put off an end of its branch, over its sizes: it leaves one that is not stable any more
   real(dp), parameter :: push = 1.0e-3_dp
   !> Seed of the starts that are drawn
   integer, parameter :: start_seed = 1
   !> No place of a search
   integer, parameter :: nowhere = -1

   !> Places between which a motion that does not repeat was followed [-].
   type :: walk_t
      real(dp) :: from = 0.0_dp, to = 0.0_dp
   end type walk_t

   !> A motion that a start leads to.
   type :: seed_t
      real(dp) :: share = 0.0_dp
      type(judged_start_t) :: judged
   end type seed_t

   public :: has_ends, find_ends

contains

   !> Whether motions are followed to their ends: by several starts, along a key that is no whole number, and by a criterion that
   !> looks at one motion.
   pure logical function has_ends(scene, whole)
      !> Checked base scene
      type(scene_t), intent(in) :: scene
      !> Whether the key takes whole numbers only
      logical, intent(in) :: whole

      has_ends = scene%solver%starts > 1 .and. scene%solver%method /= method_newmark .and. .not. whole
      associate (quantity => quantity_table(scene%threshold%quantity))
         if (any(quantity%part == [part_scene, part_cost])) has_ends = .false.
         if (any(quantity%need == [needs_orbit, needs_starts, needs_verification, needs_verified_impacts])) has_ends = .false.
      end associate
   end function has_ends

   !> Ends of the motions on both sides of a bracket; of a trace without one, from end to end of its range, those of the motions on
   !> another side. After a signal to stop they are of no use.
   subroutine find_ends(scene, threshold, bracket, family, ends, error)
      !> Checked base scene
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(bracket_t), intent(in) :: bracket
      !> Work space
      type(scene_family_t), intent(inout) :: family
      !> Last values below and above [unit of the key], then how they end there, codes of motion_end; NaN: not followed
      real(dp), intent(out) :: ends(end_numbers)
      !> Set if there was no memory for the samples of a scene
      type(error_t), allocatable, intent(out) :: error
      real(dp) :: values(size(threshold%traces%plan%positions)), last(2), first_step
      type(seed_t), allocatable :: seeds(:)
      integer :: places(2), codes(2), i

      ends = ieee_value(0.0_dp, ieee_quiet_nan)
      call scene_values(threshold%traces%plan, bracket%lower%trace, values)
      call family%begin(scene, threshold%axis, threshold%traces%plan%positions, values)
      places = [bracket%lower%place, bracket%upper%place]
      ! Nothing was followed yet: to larger values below the range, to smaller ones above it.
      last = [-1.0_dp, 2.0_dp]
      codes = end_no_start
      if (is_crossing(bracket)) then
         call find_seeds(scene, places, 1, family, seeds)
         first_step = family%share_of(places(2) - places(1))
         call follow_all(family, bracket%lower%side, places(1), 1, first_step, seeds, last(1), codes(1))
         call follow_all(family, bracket%upper%side, places(2), -1, first_step, seeds, last(2), codes(2))
      else if (bracket%lower%side >= 0) then
         ! Where starts from rest lead is known.
         call find_seeds(scene, [places(1), sum(places)/2, places(2)], 2, family, seeds)
         do i = 1, size(seeds)
            associate (side => seeds(i)%judged%side)
               if (side == bracket%lower%side .or. any(seeds(:i - 1)%judged%side == side)) cycle
               call follow_all(family, side, nowhere, 1, family%scan_step(), seeds, last(1), codes(1))
               call follow_all(family, side, nowhere, -1, family%scan_step(), seeds, last(2), codes(2))
            end associate
         end do
      end if
      do i = 1, 2
         if (codes(i) == end_no_start) cycle
         ends(i) = family%value_at(last(i))
         ends(2 + i) = real(codes(i), dp)
      end do
      if (allocated(family%error)) call move_alloc(family%error, error)
   end subroutine find_ends

   !> Motions that the starts of some places lead to.
   subroutine find_seeds(scene, places, first_start, family, seeds)
      type(scene_t), intent(in) :: scene
      !> As of threshold_search
      integer, intent(in) :: places(:)
      !> First of the starts that are tried
      integer, intent(in) :: first_start
      type(scene_family_t), intent(inout) :: family
      type(seed_t), allocatable, intent(out) :: seeds(:)
      type(problem_t) :: problem
      type(motion_start_t), allocatable :: starts(:)
      type(motion_state_t), allocatable :: states(:)
      type(judged_start_t), allocatable :: judged(:)
      real(dp), allocatable :: shares(:)
      real(dp) :: share
      integer :: place, i
      logical :: is_scene

      allocate (states(0), shares(0))
      do place = 1, size(places)
         share = family%share_of(places(place))
         call family%problem_at(share, problem, is_scene)
         if (.not. is_scene) cycle
         starts = motion_starts(problem, start_count(problem, scene%solver), start_seed)
         shares = [shares, spread(share, 1, size(starts) - first_start + 1)]
         states = [states, (state_of_start(problem, starts(i)), i=first_start, size(starts))]
      end do
      judged = family%judge(shares, states)
      allocate (seeds(size(shares)))
      do i = 1, size(seeds)
         seeds(i) = seed_t(shares(i), judged(i))
      end do
   end subroutine find_seeds

   !> Follow all motions of a side, and report the one that comes farthest.
   subroutine follow_all(family, side, own, direction, first_step, seeds, farthest, code)
      type(scene_family_t), intent(inout) :: family
      !> Side of the criterion that is followed
      integer, intent(in) :: side
      !> Place of the end of the bracket that is on this side; nowhere: there is none
      integer, intent(in) :: own
      !> 1: to larger values of the key; -1: to smaller ones
      integer, intent(in) :: direction
      !> First step along the key [-]
      real(dp), intent(in) :: first_step
      type(seed_t), intent(in) :: seeds(:)
      !> Last place over the range [-], and how the motion ends there; unchanged where none comes farther
      real(dp), intent(inout) :: farthest
      integer, intent(inout) :: code
      type(branch_point_t), allocatable :: passed(:)
      type(walk_t), allocatable :: walks(:)
      real(dp) :: share
      integer :: pass, i, ended

      if (side == side_unknown .or. side < 0) return
      call family%follow_side(side)
      allocate (passed(0), walks(0))
      ! Those of its own end come first: the others are often on their branches.
      do pass = 1, 2
         do i = 1, size(seeds)
            if (seeds(i)%judged%side /= side) cycle
            if (is_at(seeds(i), own) .neqv. pass == 1) cycle
            ! Two motions that do not repeat cannot be distinguished.
            if (seeds(i)%judged%period == 0 .and. any(is_between(walks%from, walks%to, seeds(i)%share))) cycle
            if (has_passed(family, seeds(i), direction, passed)) cycle
            call follow_motion(family, seeds(i), direction, first_step, share, ended, passed, walks)
            if (must_stop() .or. allocated(family%error)) return
            if (ended == end_no_start) cycle
            if (real(direction, dp)*(share - farthest) > 0.0_dp) then
               farthest = share
               code = ended
            end if
         end do
      end do

   contains

      !> Whether a motion was found at a place.
      logical function is_at(seed, place)
         type(seed_t), intent(in) :: seed
         !> As of threshold_search
         integer, intent(in) :: place

         is_at = .not. abs(seed%share - family%share_of(place)) > 0.0_dp
      end function is_at

   end subroutine follow_all

   !> Whether a place is on a walk.
   elemental logical function is_between(from, to, share)
      real(dp), intent(in) :: from
      real(dp), intent(in) :: to
      !> [-]
      real(dp), intent(in) :: share

      is_between = (share - from)*(share - to) <= 0.0_dp
   end function is_between

   !> Whether a motion is on a branch that was followed before.
   logical function has_passed(family, seed, direction, passed)
      type(scene_family_t), intent(inout) :: family
      type(seed_t), intent(in) :: seed
      integer, intent(in) :: direction
      !> Motions of the branches
      type(branch_point_t), intent(in) :: passed(:)
      type(branch_point_t) :: point
      type(problem_t) :: problem
      type(known_motions_t) :: measure
      real(dp) :: images(size(seed%judged%state), 1)
      integer :: i, period
      logical :: found, is_scene

      has_passed = .false.
      if (seed%judged%period == 0) return
      call family%problem_at(seed%share, problem, is_scene)
      measure = near_states(problem)
      do i = 1, size(passed)
         point = passed(i)
         found = .true.
         if (abs(point%share - seed%share) > 0.0_dp) then
            ! A step reaches from one motion to the next.
            associate (before => passed(max(1, i - 1)))
               if ((point%share - seed%share)*(before%share - seed%share) >= 0.0_dp) cycle
               point = point_at(family, seed%judged%period, family%sizes(seed%share, point%state), seed%share, &
                                point%state + (before%state - point%state)*(seed%share - point%share)/ &
                                (before%share - point%share), direction, found)
            end associate
         end if
         if (.not. found) cycle
         images(:, 1) = seed%judged%state
         do period = 1, seed%judged%period
            has_passed = are_near(problem, measure, point%state, images(:, 1))
            if (has_passed) return
            call family%map(1, 1.0e-8_dp, [seed%share], images, found)
            if (.not. found) exit
         end do
      end do
   end function has_passed

   !> Follow a motion of the side that the family follows, from branch to branch.
   subroutine follow_motion(family, seed, direction, first_step, share, code, passed, walks)
      type(scene_family_t), intent(inout) :: family
      type(seed_t), intent(in) :: seed
      integer, intent(in) :: direction
      !> First step along the key [-]
      real(dp), intent(in) :: first_step
      !> Last place, and how the motion ends there
      real(dp), intent(out) :: share
      integer, intent(out) :: code
      !> Motions of the branches; those of this one are added
      type(branch_point_t), allocatable, intent(inout) :: passed(:)
      !> Ways over which motions that do not repeat were followed; those of this one are added
      type(walk_t), allocatable, intent(inout) :: walks(:)
      type(branch_end_t) :: branch
      type(judged_start_t) :: here
      real(dp) :: before
      integer :: branches
      logical :: goes_on

      here = seed%judged
      share = seed%share
      code = end_no_start
      do branches = 1, most_branches
         if (here%period > 0) then
            branch = follow_branch(family, here%period, share, here%state, direction, first_step)
            if (must_stop() .or. allocated(family%error)) return
            if (branch%code == end_no_start) then
               call follow_values(family, direction, share, here, code)
               if (code /= end_lost) return
               cycle
            end if
            passed = [passed, branch%points]
            share = branch%point%share
            code = branch%code
            if (code == end_of_range .or. code == end_of_kind) return
            call leave_branch(family, direction, branch%point, here, share, goes_on)
            if (.not. goes_on) return
         else
            before = share
            call follow_values(family, direction, share, here, code)
            walks = [walks, walk_t(before, share)]
            if (code /= end_lost) return
         end if
      end do
      code = end_lost
   end subroutine follow_motion

   !> Go on beyond the end of a branch, where the motion that follows there is on the same side.
   subroutine leave_branch(family, direction, point, here, share, goes_on)
      type(scene_family_t), intent(inout) :: family
      integer, intent(in) :: direction
      !> Last motion of the branch
      type(branch_point_t), intent(in) :: point
      type(judged_start_t), intent(inout) :: here
      real(dp), intent(inout) :: share
      logical, intent(out) :: goes_on
      type(judged_start_t) :: judged(1)
      real(dp) :: beyond

      goes_on = .false.
      beyond = point%share + real(direction, dp)*family%share_of(1)
      if (beyond < 0.0_dp .or. beyond > 1.0_dp) return
      judged = family%judge([beyond], [motion_state_t(numbers=point%state + push*family%sizes(point%share, point%state))])
      goes_on = judged(1)%side == family%followed_side()
      if (.not. goes_on) return
      here = judged(1)
      share = beyond
   end subroutine leave_branch

   !> Follow a motion value by value, each from the state of the one before, until it leaves its side; between that value and the
   !> last one by halves of the step, down to the width of a bracket. Where it comes to repeat it is left, end_lost, to be followed
   !> as a branch.
   subroutine follow_values(family, direction, share, here, code)
      type(scene_family_t), intent(inout) :: family
      integer, intent(in) :: direction
      real(dp), intent(inout) :: share
      type(judged_start_t), intent(inout) :: here
      integer, intent(out) :: code
      type(judged_start_t) :: judged(1)
      real(dp) :: step, next
      logical :: repeats

      repeats = here%period > 0
      step = family%scan_step()
      code = end_bracketed
      do
         next = share + real(direction, dp)*step
         next = max(0.0_dp, min(1.0_dp, next))
         if (.not. abs(next - share) > 0.0_dp) then
            code = end_of_range
            return
         end if
         judged = family%judge([next], [motion_state_t(numbers=here%state)])
         if (must_stop() .or. allocated(family%error)) return
         if (judged(1)%side == family%followed_side()) then
            share = next
            here = judged(1)
            if (here%period > 0 .and. .not. repeats) then
               code = end_lost
               return
            end if
            repeats = here%period > 0
         else
            if (step <= 1.001_dp*family%share_of(1)) return
            step = max(0.5_dp*step, family%share_of(1))
         end if
      end do
   end subroutine follow_values

end module threshold_ends
