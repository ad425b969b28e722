!> A branch of periodic motions as a key changes: pseudo-arclength continuation of fixed points of the period map, with their
!> Floquet multipliers, from a stable motion to where it ends. It ends at a fold, where the branch turns back; where a multiplier
!> leaves the unit circle at -1 or as a complex pair; where the motion is no longer of the kind that is followed; or at the end
!> of the range. THEORY.md has the equations.
!>
!> What is followed is a family of maps, one for each place of the key in its range, a share from 0 to 1.
module motion_branch
   use kinds, only: dp
   use linear_equations, only: eigenvalues, solve_linear
   implicit none(type, external)
   private

   !> How a branch ends. The first four and the sixth are those of the quantity motion_end, in its order.
   integer, parameter, public :: end_fold = 1, end_doubling = 2, end_torus = 3, end_of_kind = 4, end_of_range = 5, &
                                 end_bracketed = 6, end_lost = 7
   !> The start is no stable motion of the kind.
   integer, parameter, public :: end_no_start = 0

   !> Accuracy of the map
   real(dp), parameter :: map_accuracy = 1.0e-12_dp
   !> Step of the differences: in the state, over the sizes of its numbers, and in the key, over its range. Their errors are about
   !> the square of the step, and map_accuracy over it.
   real(dp), parameter :: state_step = 1.0e-4_dp, key_step = 1.0e-5_dp
   !> Newton's correction from which on a point is found, over the sizes; rounding in the map may keep corrections above it, which
   !> then no longer fall to a tenth.
   real(dp), parameter :: converged = 1.0e-10_dp, largest_disturbance = 1.0e-7_dp, slowest_fall = 0.1_dp
   integer, parameter :: most_corrections = 8
   !> Longest step along the branch, over the sizes, and along the key, over its range; and shortest one before it is given up.
   real(dp), parameter :: longest_step = 0.1_dp, longest_key_step = 1.0_dp/64.0_dp, shortest_step = 1.0e-9_dp
   !> A step is halved where it turns the tangent by more than this cosine, or changes the largest multiplier by more than that.
   real(dp), parameter :: least_cosine = 0.97_dp, largest_change = 0.25_dp
   integer, parameter :: most_steps = 400
   !> Where the end of a branch is: to this share of the range and of the sizes; and most trials of that search.
   real(dp), parameter :: end_resolution = 1.0e-9_dp
   integer, parameter :: most_trials = 60
   !> What comes to zero there: the direction of the branch, or its stability
   integer, parameter :: of_direction = 1, of_stability = 2
   !> A multiplier of a point that is known to this is taken to be beyond the unit circle: points next to a fold have one near 1.
   real(dp), parameter :: beyond_circle = 1.0e-4_dp
   !> Next to a loss of stability nearer than this share of the range the kind of a motion is not known.
   real(dp), parameter :: unsure_kind = 1.0e-5_dp

   !> Maps along a key, the states that they take, and what kind of motion is followed.
   type, abstract, public :: motion_family_t
      private
      !> Of the branch under way: periods of the force after which its motions repeat, 1 or -1 to larger or smaller values of the key,
      !> and what the numbers of states count as along it, each in its unit
      integer :: periods = 1, direction = 1
      real(dp), allocatable :: units(:)
   contains
      procedure(map_at_shares), deferred :: map
      procedure(sizes_at), deferred :: sizes
      procedure(is_of_kind), deferred :: keeps_kind
   end type motion_family_t

   abstract interface
      !> Images of states, each at a place of its own.
      subroutine map_at_shares(self, periods, accuracy, shares, states, mapped)
         import :: dp, motion_family_t
         class(motion_family_t), intent(inout) :: self
         !> Periods of the force
         integer, intent(in) :: periods
         !> Relative accuracy [-]
         real(dp), intent(in) :: accuracy
         !> Place of the key in its range, state [-]
         real(dp), intent(in) :: shares(:)
         !> Number of a state, state; replaced by their images
         real(dp), intent(inout) :: states(:, :)
         !> Whether every state could be followed to the end
         logical, intent(out) :: mapped
      end subroutine map_at_shares

      !> What the numbers of a state count as, each in its unit.
      function sizes_at(self, share, state) result(sizes)
         import :: dp, motion_family_t
         class(motion_family_t), intent(inout) :: self
         !> Place of the key in its range [-]
         real(dp), intent(in) :: share
         !> Numbers of the state
         real(dp), intent(in) :: state(:)
         real(dp) :: sizes(size(state))
      end function sizes_at

      !> Whether the stable motion next to a state is of the kind that is followed.
      logical function is_of_kind(self, periods, share, state)
         import :: dp, motion_family_t
         class(motion_family_t), intent(inout) :: self
         !> Periods of the force after which it repeats
         integer, intent(in) :: periods
         !> Place of the key in its range [-]
         real(dp), intent(in) :: share
         !> Numbers of the state
         real(dp), intent(in) :: state(:)
      end function is_of_kind
   end interface

   !> A periodic motion of a branch.
   type, public :: branch_point_t
      !> Place of the key in its range [-]
      real(dp) :: share = 0.0_dp
      !> Numbers of its state at the start of a period of the force
      real(dp), allocatable :: state(:)
      !> Floquet multipliers of one period of the motion, the largest first [-]
      complex(dp), allocatable :: multipliers(:)
      !> Direction of the branch, of length 1: numbers of the state over their sizes, then the key over its range
      real(dp), allocatable :: tangent(:)
   end type branch_point_t

   !> Where a branch ends, and how it came there.
   type, public :: branch_end_t
      !> One of the codes above
      integer :: code = end_no_start
      !> Last motion that is stable and of the kind
      type(branch_point_t) :: point
      !> Motions from the start to it
      type(branch_point_t), allocatable :: points(:)
   end type branch_end_t

   public :: follow_branch, point_at

contains

   !> Follow a branch from a motion at a place, to larger values of the key or to smaller ones.
   function follow_branch(family, periods, share, state, direction, first_step) result(ending)
      class(motion_family_t), intent(inout) :: family
      !> Periods of the force after which the motion repeats
      integer, intent(in) :: periods
      !> Place of the start [-]
      real(dp), intent(in) :: share
      !> Numbers of a state next to the motion
      real(dp), intent(in) :: state(:)
      !> 1 or -1
      integer, intent(in) :: direction
      !> First step along the key [-]
      real(dp), intent(in) :: first_step
      type(branch_end_t) :: ending
      type(branch_point_t) :: here, next
      real(dp) :: step, cosine, bound
      integer :: steps
      logical :: found, ends

      family%periods = periods
      family%direction = direction
      family%units = max(family%sizes(share, state), abs(state))
      ending%point%share = share
      ending%point%state = state
      allocate (ending%points(0))
      here = point_on(family, share, state, found)
      if (.not. found) return
      if (growth(here) > 0.0_dp) return
      if (.not. family%keeps_kind(periods, here%share, here%state)) return
      bound = merge(1.0_dp, 0.0_dp, direction > 0)
      step = first_step/max(abs(here%tangent(size(here%tangent))), 1.0e-3_dp)
      do steps = 1, most_steps
         ending%points = [ending%points, here]
         ending%point = here
         ending%code = end_of_range
         if (.not. abs(bound - here%share) > 0.0_dp) return
         ending%code = end_lost
         do
            if (step < shortest_step) return
            call advance(family, here, step, bound, next, found)
            if (found) then
               cosine = dot_product(here%tangent, next%tangent)
               if (cosine >= least_cosine .and. abs(growth(next) - growth(here)) <= largest_change) exit
               ! Beyond the unit circle nothing is followed: how fast a multiplier grows there does not matter.
               if (cosine >= least_cosine .and. growth(here) > -largest_change .and. growth(next) > 0.0_dp) exit
            end if
            step = 0.5_dp*step
         end do
         call find_end(family, here, next, ending, ends)
         if (ends) return
         here = next
         step = min(2.0_dp*step, longest_step, longest_key_step/max(abs(here%tangent(size(here%tangent))), 1.0e-3_dp))
      end do
      ending%code = end_lost
   end function follow_branch

   !> The next motion of a branch, on its bound if that is nearer.
   subroutine advance(family, here, step, bound, next, found)
      class(motion_family_t), intent(inout) :: family
      type(branch_point_t), intent(in) :: here
      !> Length along the tangent [-]
      real(dp), intent(in) :: step
      !> Last place of the range [-]
      real(dp), intent(in) :: bound
      type(branch_point_t), intent(out) :: next
      logical, intent(out) :: found
      real(dp) :: length
      logical :: at_bound
      integer :: n

      n = size(family%units)
      length = step
      associate (along_key => real(family%direction, dp)*here%tangent(n + 1), left => abs(bound - here%share))
         at_bound = along_key*step >= left
         if (at_bound) length = left/along_key
      end associate
      next%state = here%state + length*here%tangent(:n)*family%units
      next%share = here%share + length*here%tangent(n + 1)
      if (at_bound) then
         next = point_on(family, bound, next%state, found)
      else
         call correct(family, here%tangent, .false., next, found)
         ! A branch that turns within its last step may leave the range and come back.
         if (found) found = next%share >= 0.0_dp .and. next%share <= 1.0_dp
      end if
   end subroutine advance

   !> Whether a branch ends between two of its motions, and where: first where it turns back, then where it loses stability
   !> before that, then where it loses its kind before that.
   subroutine find_end(family, here, next, ending, ends)
      class(motion_family_t), intent(inout) :: family
      type(branch_point_t), intent(in) :: here
      type(branch_point_t), intent(in) :: next
      type(branch_end_t), intent(inout) :: ending
      logical, intent(out) :: ends
      type(branch_point_t) :: last, last_of_kind
      integer :: code

      last = next
      code = 0
      if (margin(family, of_direction, next) <= 0.0_dp) then
         call narrow(family, of_direction, here, last)
         code = end_fold
      end if
      if (growth(last) > merge(beyond_circle, 0.0_dp, code == end_fold)) then
         call narrow(family, of_stability, here, last)
         code = code_of(last)
      end if
      ends = code /= 0
      if (.not. family%keeps_kind(family%periods, last%share, last%state)) then
         last_of_kind = last
         call narrow_kind(family, here,.not. ends, last_of_kind)
         ! Where stability is lost, a motion that is followed less accurately may leave what it should be judged by.
         if (.not. ends .or. abs(last_of_kind%share - last%share) > unsure_kind) then
            code = end_of_kind
            last = last_of_kind
         end if
         ends = .true.
      end if
      if (.not. ends) return
      ending%code = code
      ending%point = last
      ending%points = [ending%points, last]
   end subroutine find_end

   !> Above zero before the branch turns back, or where its motion is stable [-].
   pure real(dp) function margin(family, what, point)
      class(motion_family_t), intent(in) :: family
      !> of_direction or of_stability
      integer, intent(in) :: what
      type(branch_point_t), intent(in) :: point

      margin = -growth(point)
      if (what == of_direction) margin = real(family%direction, dp)*point%tangent(size(point%tangent))
   end function margin

   !> The last motion before a margin that is above zero here and not there comes to zero: false position, with halves of
   !> the weight of an end that stays (Illinois).
   subroutine narrow(family, what, from, to)
      class(motion_family_t), intent(inout) :: family
      !> of_direction or of_stability
      integer, intent(in) :: what
      type(branch_point_t), intent(in) :: from
      !> Where the margin is not above zero; replaced by the last motion where it is
      type(branch_point_t), intent(inout) :: to
      type(branch_point_t) :: low, trial
      real(dp) :: places(2), values(2), length, place
      integer :: trials, kept
      logical :: found

      length = distance(family, from, to)
      low = from
      places = [0.0_dp, length]
      values = [margin(family, what, from), margin(family, what, to)]
      kept = 0
      do trials = 1, most_trials
         if (places(2) - places(1) <= end_resolution) exit
         place = places(1) + (places(2) - places(1))*values(1)/(values(1) - values(2))
         ! Both ends come near: a trial stands beside the end by a share of the resolution at least.
         place = max(places(1) + 0.3_dp*end_resolution, min(place, places(2) - 0.3_dp*end_resolution))
         trial = between(family, from, place, found)
         if (.not. found) then
            place = 0.5_dp*(places(1) + places(2))
            trial = between(family, from, place, found)
            if (.not. found) exit
         end if
         if (margin(family, what, trial) > 0.0_dp) then
            low = trial
            places(1) = place
            values(1) = margin(family, what, trial)
            if (kept == 2) values(2) = 0.5_dp*values(2)
            kept = 2
         else
            places(2) = place
            values(2) = margin(family, what, trial)
            if (kept == 1) values(1) = 0.5_dp*values(1)
            kept = 1
         end if
      end do
      to = low
   end subroutine narrow

   !> The last motion of the kind, by halves. Where all motions are stable, a state between both leads to the one there by itself.
   subroutine narrow_kind(family, from, stable, to)
      class(motion_family_t), intent(inout) :: family
      type(branch_point_t), intent(in) :: from
      !> Whether all motions from one to the other are stable
      logical, intent(in) :: stable
      !> A motion that is not of the kind; replaced by the last one that is
      type(branch_point_t), intent(inout) :: to
      type(branch_point_t) :: low, trial
      real(dp) :: places(2), shares(2), place, length
      integer :: trials
      logical :: found

      low = from
      length = distance(family, from, to)
      places = [0.0_dp, length]
      shares = [from%share, to%share]
      do trials = 1, most_trials
         if (abs(shares(2) - shares(1)) <= end_resolution .or. places(2) - places(1) <= end_resolution) exit
         place = 0.5_dp*(places(1) + places(2))
         if (stable) then
            trial%share = from%share + (to%share - from%share)*(place/length)
            trial%state = from%state + (to%state - from%state)*(place/length)
         else
            trial = between(family, from, place, found)
            if (.not. found) exit
         end if
         if (family%keeps_kind(family%periods, trial%share, trial%state)) then
            low = trial
            places(1) = place
            shares(1) = trial%share
         else
            places(2) = place
            shares(2) = trial%share
         end if
      end do
      if (stable) low = point_on(family, low%share, low%state, found)
      to = low
   end subroutine narrow_kind

   !> Distance from a motion to another along the tangent of the first [-].
   pure real(dp) function distance(family, from, to)
      class(motion_family_t), intent(in) :: family
      type(branch_point_t), intent(in) :: from
      type(branch_point_t), intent(in) :: to

      distance = dot_product(from%tangent, [(to%state - from%state)/family%units, to%share - from%share])
   end function distance

   !> The motion of the branch at some length along the tangent of another.
   type(branch_point_t) function between(family, from, length, found) result(point)
      class(motion_family_t), intent(inout) :: family
      type(branch_point_t), intent(in) :: from
      real(dp), intent(in) :: length
      logical, intent(out) :: found

      associate (n => size(family%units))
         allocate (point%state, source=from%state + length*from%tangent(:n)*family%units)
         point%share = from%share + length*from%tangent(n + 1)
      end associate
      call correct(family, from%tangent, .true., point, found)
   end function between

   !> How the last motion of a branch loses its stability.
   pure integer function code_of(point)
      type(branch_point_t), intent(in) :: point

      code_of = end_fold
      if (abs(point%multipliers(1)%im) > 0.0_dp) then
         code_of = end_torus
      else if (point%multipliers(1)%re < 0.0_dp) then
         code_of = end_doubling
      end if
   end function code_of

   !> By how much the largest multiplier is beyond the unit circle [-].
   pure real(dp) function growth(point)
      type(branch_point_t), intent(in) :: point

      growth = abs(point%multipliers(1)) - 1.0_dp
   end function growth

   !> The periodic motion at a place of the key.
   function point_at(family, periods, units, share, state, direction, found) result(point)
      class(motion_family_t), intent(inout) :: family
      !> Periods of the force after which it repeats
      integer, intent(in) :: periods
      !> What the numbers of its state count as, each in its unit
      real(dp), intent(in) :: units(:)
      !> Place [-]
      real(dp), intent(in) :: share
      !> Numbers of a state next to it
      real(dp), intent(in) :: state(:)
      !> 1 or -1: to where the tangent points
      integer, intent(in) :: direction
      !> Whether there is one
      logical, intent(out) :: found
      type(branch_point_t) :: point

      family%periods = periods
      family%direction = direction
      family%units = units
      point = point_on(family, share, state, found)
   end function point_at

   !> The same on the branch under way.
   type(branch_point_t) function point_on(family, share, state, found) result(point)
      class(motion_family_t), intent(inout) :: family
      real(dp), intent(in) :: share
      real(dp), intent(in) :: state(:)
      logical, intent(out) :: found
      real(dp) :: along_key(size(state) + 1)

      along_key = 0.0_dp
      along_key(size(along_key)) = real(family%direction, dp)
      point%share = share
      allocate (point%state, source=state)
      call correct(family, along_key, .false., point, found)
   end function point_on

   !> Newton's method on state and key together, in the plane through a point across a direction. The slopes at the point that is
   !> found give its multipliers and the tangent.
   subroutine correct(family, normal, strict, point, found)
      class(motion_family_t), intent(inout) :: family
      !> Direction across the plane, of length 1
      real(dp), intent(in) :: normal(:)
      !> Whether multipliers and tangent are those of the point itself, and not of the one before its last correction
      logical, intent(in) :: strict
      !> A state and a place near a motion; replaced by it
      type(branch_point_t), intent(inout) :: point
      logical, intent(out) :: found
      real(dp) :: jacobian(size(normal) - 1, size(normal) - 1), matrix(size(normal), size(normal)), solution(size(normal), 2)
      real(dp), dimension(size(normal) - 1) :: by_key, residual, sizes, units
      real(dp) :: moved, moved_before, next_move
      integer :: corrections, i, n
      logical :: mapped, solved

      units = family%units
      n = size(units)
      found = .false.
      moved = huge(moved)
      do corrections = 1, most_corrections
         sizes = family%sizes(point%share, point%state)
         if (.not. all(sizes > 0.0_dp)) return
         call slopes(family, sizes, point, residual, jacobian, by_key, mapped)
         if (.not. mapped) return
         do i = 1, n
            matrix(:n, i) = jacobian(:, i)*units(i)/units
            matrix(i, i) = matrix(i, i) - 1.0_dp
         end do
         matrix(:n, n + 1) = by_key/units
         matrix(n + 1, :) = normal
         solution(:, 1) = [-residual/units, 0.0_dp]
         solution(:, 2) = 0.0_dp
         solution(n + 1, 2) = 1.0_dp
         call solve_linear(matrix, solution, solved)
         if (.not. solved) return
         moved_before = moved
         moved = max(maxval(abs(solution(:n, 1))*units/sizes), abs(solution(n + 1, 1)))
         if (.not. moved < huge(moved)) return
         ! Newton's method that does not converge leads to another motion, if to any.
         if (corrections > 2 .and. moved > moved_before .and. moved > largest_disturbance) return
         point%state = point%state + solution(:n, 1)*units
         point%share = point%share + solution(n + 1, 1)
         found = moved <= converged .or. (moved <= largest_disturbance .and. moved >= slowest_fall*moved_before)
         ! Newton's corrections fall by their squares: the next one would be this.
         next_move = moved*(moved/moved_before)**2
         if (corrections > 1 .and. .not. strict) found = found .or. (moved < moved_before .and. next_move <= converged)
         if (.not. found) cycle
         point%tangent = solution(:, 2)/norm2(solution(:, 2))
         point%multipliers = eigenvalues(jacobian*spread(units, 1, n)/spread(units, 2, n))
         found = size(point%multipliers) > 0
         return
      end do
   end subroutine correct

   !> Image of a state less the state, and the slopes of the map by state and key, by central differences.
   subroutine slopes(family, sizes, point, residual, jacobian, by_key, mapped)
      class(motion_family_t), intent(inout) :: family
      !> What the numbers of the state count as, each in its unit
      real(dp), intent(in) :: sizes(:)
      type(branch_point_t), intent(in) :: point
      real(dp), intent(out) :: residual(:)
      !> Number of the image, number of the state
      real(dp), intent(out) :: jacobian(:, :)
      real(dp), intent(out) :: by_key(:)
      logical, intent(out) :: mapped
      real(dp) :: states(size(sizes), 0:2*size(sizes) + 2), shares(0:2*size(sizes) + 2), steps(size(sizes))
      integer :: i, n

      n = size(sizes)
      steps = state_step*sizes
      states = spread(point%state, 2, 2*n + 3)
      shares = point%share
      do i = 1, n
         states(i, i) = point%state(i) + steps(i)
         states(i, n + i) = point%state(i) - steps(i)
      end do
      ! The key stays in its range.
      shares(2*n + 1) = min(1.0_dp, max(0.0_dp, point%share + key_step))
      shares(2*n + 2) = max(0.0_dp, min(1.0_dp, point%share - key_step))
      mapped = shares(2*n + 1) > shares(2*n + 2)
      if (.not. mapped) return
      call family%map(family%periods, map_accuracy, shares, states, mapped)
      if (.not. mapped) return
      residual = states(:, 0) - point%state
      do i = 1, n
         jacobian(:, i) = (states(:, i) - states(:, n + i))/(2.0_dp*steps(i))
      end do
      by_key = (states(:, 2*n + 1) - states(:, 2*n + 2))/(shares(2*n + 1) - shares(2*n + 2))
   end subroutine slopes

end module motion_branch
