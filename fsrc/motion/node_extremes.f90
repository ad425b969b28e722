!> Extremes of a motion between the nodes of its steps.
!>
!> The largest node is near the largest value, not at it. Where a parabola through neighbouring nodes may come out highest,
!> film and velocity are interpolated in the piece of the step, the quantity follows from them by its own law, and the
!> parabola is renewed until it stands.
module node_extremes
   use kinds, only: dp
   use carried_loads, only: acceleration_at, contact_film, contact_load, gear_positions, largest_pressure, net_loads
   use problem, only: contact_count, most_contacts, of_velocity, problem_t
   use step_nodes, only: interpolate, node_place, nodes_per_piece
   use value_range, only: range_of
   implicit none(type, external)
   private

   !> Quantities whose extremes are looked for: h [m] and load [N] of each contact; z' [m/s], z'' [m/s2], largest pressure of the
   !> Reynolds films [Pa]; where there are several contacts their net load [N]; where it is not that of a film, position of the
   !> gear [m].
   integer, parameter, public :: seen_films(most_contacts) = [1, 8], seen_velocity = 2, seen_acceleration = 3, &
                                 seen_loads(most_contacts) = [4, 6], seen_pressure = 5, seen_net_load = 7, seen_position = 9
   integer, parameter, public :: seen_quantities = 9

   !> Pieces that are looked at together, at most: their arrays stay in the cache.
   integer, parameter, public :: block_pieces = 64, block_nodes = nodes_per_piece*block_pieces

   !> How far above its nodes a curve of at most 1.27 oscillations a piece is looked for, as a share of the range of many pieces. In
   !> a piece of its own one of a thousand random curves rises farther, by 0.27 of the range at most seen.
   real(dp), parameter :: between = 0.15_dp
   !> How far it is allowed to rise above the parabola through three nodes, as a share of its range in the piece: one of a thousand
   !> random curves rises by more than 0.05, the farthest of 32,000 by 0.0701.
   real(dp), parameter :: parabola_error = 0.07_dp
   !> Change of an extreme, as a share of the range, behind which the next one would be a hundred times smaller.
   real(dp), parameter :: settled = 1.0e-9_dp
   integer, parameter :: most_renewals = 12
   !> Places in a piece that are the same.
   real(dp), parameter :: same_place = 1.0e-9_dp

   !> An extreme and the state there.
   type, public :: extreme_t
      real(dp) :: value = 0.0_dp
      !> Its numbers, none where there is no extreme
      real(dp), allocatable :: state(:)
      !> When: periods since the window began, and phase
      integer :: period = 0
      real(dp) :: phase = 0.0_dp
      logical :: exists = .false.
   end type extreme_t

   public :: find_extremes, narrow, seen_net_load_of, top_of_parabola

contains

   !> Smallest and largest value of a quantity over some pieces, a block of them at most, kept where they are beyond those found
   !> before.
   pure subroutine find_extremes(problem, quantity, period, start, length, states, values, lowest, highest)
      type(problem_t), intent(in) :: problem
      integer, intent(in) :: quantity
      !> Periods since the window began
      integer, intent(in) :: period
      !> Phase where each piece begins, and its length [periods]
      real(dp), intent(in) :: start(:)
      real(dp), intent(in) :: length(:)
      !> State and quantity at the nodes, eight a piece
      real(dp), intent(in) :: states(:, :)
      real(dp), contiguous, intent(in) :: values(:)
      !> Extremes found so far
      type(extreme_t), intent(inout) :: lowest
      type(extreme_t), intent(inout) :: highest
      real(dp) :: smallest, largest

      call range_of(values, smallest, largest)
      call find_highest(1.0_dp, largest, largest - smallest, highest)
      ! Where the largest pressure of the film is smallest is never requested.
      if (quantity /= seen_pressure) call find_highest(-1.0_dp, -smallest, largest - smallest, lowest)

   contains

      !> Highest value of the quantity times a sign.
      pure subroutine find_highest(sign_of, top, range, found)
         real(dp), intent(in) :: sign_of
         !> Highest node, and range of the nodes
         real(dp), intent(in) :: top
         real(dp), intent(in) :: range
         type(extreme_t), intent(inout) :: found
         real(dp) :: level, bounds(block_nodes)
         integer :: peaks(block_nodes), i, count_of_peaks

         level = top - between*range
         if (found%exists) level = max(level, sign_of*found%value - between*range)
         count_of_peaks = 0
         do i = 1, size(values)
            if (sign_of*values(i) < level) cycle
            if (.not. is_peak(values, sign_of, i)) cycle
            count_of_peaks = count_of_peaks + 1
            peaks(count_of_peaks) = i
            bounds(count_of_peaks) = bound_of_peak(values, sign_of, i)
         end do
         ! From the peak that may be the highest on, until none is left that may be higher than what was found.
         do while (count_of_peaks > 0)
            i = maxloc(bounds(:count_of_peaks), dim=1)
            if (found%exists) then
               if (.not. bounds(i) > sign_of*found%value) exit
            end if
            call renew(sign_of, peaks(i), range, found)
            peaks(i) = peaks(count_of_peaks)
            bounds(i) = bounds(count_of_peaks)
            count_of_peaks = count_of_peaks - 1
         end do
      end subroutine find_highest

      !> Follow the peak near a place until it stands.
      pure subroutine renew(sign_of, i, range, found)
         real(dp), intent(in) :: sign_of
         integer, intent(in) :: i
         real(dp), intent(in) :: range
         type(extreme_t), intent(inout) :: found
         real(dp) :: x(3), y(3), place, estimate, here, best, best_place, state(size(states, 2)), best_state(size(states, 2))
         integer :: piece, node, j

         piece = (i - 1)/nodes_per_piece + 1
         node = modulo(i - 1, nodes_per_piece) + 1
         x = [0.0_dp, node_place(node), 1.0_dp]
         y(2) = sign_of*values(i)
         best = values(i)
         best_place = x(2)
         best_state = states(i, :)
         do j = 1, 3, 2
            if (node + j - 2 >= 1 .and. node + j - 2 <= nodes_per_piece) then
               x(j) = node_place(node + j - 2)
               y(j) = sign_of*values(i + j - 2)
            else
               call evaluate(piece, x(j), state, here)
               y(j) = sign_of*here
               if (y(j) > sign_of*best) call keep(x(j), here, state, best_place, best, best_state)
            end if
         end do
         do j = 1, most_renewals
            call top_of_parabola(x, y, place, estimate)
            place = min(max(place, x(1)), x(3))
            ! The parabola may point at an end of the piece while the peak stands beside it.
            if (abs(place - x(1)) < same_place) place = x(1) + 0.25_dp*(x(2) - x(1))
            if (abs(place - x(3)) < same_place) place = x(3) + 0.25_dp*(x(2) - x(3))
            if (minval(abs(place - x)) < same_place) exit
            call evaluate(piece, place, state, here)
            if (sign_of*here > sign_of*best) call keep(place, here, state, best_place, best, best_state)
            if (abs(sign_of*here - maxval(y)) <= settled*range .and. j > 2) exit
            call narrow(x, y, place, sign_of*here)
         end do
         if (found%exists) then
            if (.not. sign_of*best > sign_of*found%value) return
         end if
         found = extreme_t(value=best, state=best_state, period=period, phase=start(piece) + best_place*length(piece), &
                           exists=.true.)
      end subroutine renew

      !> State and quantity at a place in a piece.
      pure subroutine evaluate(piece, x, state, quantity_there)
         integer, intent(in) :: piece
         real(dp), intent(in) :: x
         real(dp), intent(out) :: state(:)
         real(dp), intent(out) :: quantity_there
         real(dp) :: value(1)
         integer :: contact

         call interpolate(states, piece, x, state)
         select case (quantity)
         case (seen_velocity)
            value = state(of_velocity)
         case (seen_acceleration)
            value = acceleration_at(problem, state, min(1.0_dp, start(piece) + x*length(piece)))
         case (seen_pressure)
            value = largest_pressure(problem, state)
         case (seen_net_load)
            call net_loads(problem, reshape(state, [1, size(state)]), value)
         case (seen_position)
            value = gear_positions(problem, reshape(state, [1, size(state)]))
         case default
            do contact = 1, most_contacts
               if (quantity == seen_films(contact)) value = contact_film(problem, contact, state)
               if (quantity == seen_loads(contact)) value = contact_load(problem, contact, state)
            end do
         end select
         quantity_there = value(1)
      end subroutine evaluate

   end subroutine find_extremes

   !> Whether no node beside one, of the same piece, is higher.
   pure logical function is_peak(values, sign_of, i)
      real(dp), contiguous, intent(in) :: values(:)
      real(dp), intent(in) :: sign_of
      integer, intent(in) :: i

      is_peak = .true.
      if (modulo(i - 1, nodes_per_piece) > 0) is_peak = sign_of*values(i - 1) <= sign_of*values(i)
      if (is_peak .and. modulo(i, nodes_per_piece) > 0) is_peak = sign_of*values(i + 1) <= sign_of*values(i)
   end function is_peak

   !> What the peak at a node may rise to within its piece: the parabola through the node and its neighbours, and its error.
   pure real(dp) function bound_of_peak(values, sign_of, i) result(bound)
      real(dp), contiguous, intent(in) :: values(:)
      real(dp), intent(in) :: sign_of
      integer, intent(in) :: i
      real(dp) :: x, estimate
      integer :: middle, before

      middle = min(max(modulo(i - 1, nodes_per_piece) + 1, 2), nodes_per_piece - 1)
      before = nodes_per_piece*((i - 1)/nodes_per_piece)
      associate (y => values(before + 1:before + nodes_per_piece))
         call top_of_parabola(node_place(middle - 1:middle + 1), sign_of*y(middle - 1:middle + 1), x, estimate)
         bound = max(estimate, sign_of*values(i)) + parabola_error*(maxval(y) - minval(y))
      end associate
   end function bound_of_peak

   !> Keep a place as the best one so far.
   pure subroutine keep(place, value, state, best_place, best, best_state)
      real(dp), intent(in) :: place
      real(dp), intent(in) :: value
      real(dp), intent(in) :: state(:)
      real(dp), intent(out) :: best_place
      real(dp), intent(out) :: best
      real(dp), intent(out) :: best_state(:)

      best_place = place
      best = value
      best_state = state
   end subroutine keep

   !> Code of what all contacts carry together: of a single one its load.
   pure integer function seen_net_load_of(problem)
      type(problem_t), intent(in) :: problem

      seen_net_load_of = merge(seen_net_load, seen_loads(1), contact_count(problem) > 1)
   end function seen_net_load_of

   !> Take a point into three that stand around a peak, and leave out the one that is farthest from it.
   pure subroutine narrow(x, y, place, value)
      !> Places, in their order, and values
      real(dp), intent(inout) :: x(3)
      real(dp), intent(inout) :: y(3)
      !> The new one, between the outer two
      real(dp), intent(in) :: place
      real(dp), intent(in) :: value
      real(dp) :: places(4), values(4)
      integer :: before, highest

      before = count(x < place)
      places = [x(:before), place, x(before + 1:)]
      values = [y(:before), value, y(before + 1:)]
      highest = min(max(maxloc(values, dim=1), 2), 3)
      x = places(highest - 1:highest + 1)
      y = values(highest - 1:highest + 1)
   end subroutine narrow

   !> Highest point of the parabola through three points, between 0 and 1.
   pure subroutine top_of_parabola(x, y, place, value)
      !> Places, in their order, and values
      real(dp), intent(in) :: x(3)
      real(dp), intent(in) :: y(3)
      !> Where it is highest, and its value there
      real(dp), intent(out) :: place
      real(dp), intent(out) :: value
      real(dp) :: slope, next_slope, curvature

      slope = (y(2) - y(1))/(x(2) - x(1))
      next_slope = (y(3) - y(2))/(x(3) - x(2))
      curvature = (next_slope - slope)/(x(3) - x(1))
      if (curvature < 0.0_dp) then
         place = min(max(0.5_dp*(x(1) + x(2)) - 0.5_dp*slope/curvature, 0.0_dp), 1.0_dp)
      else
         place = merge(0.0_dp, 1.0_dp, y(1) > y(3))
      end if
      value = y(1) + (place - x(1))*(slope + curvature*(place - x(2)))
   end subroutine top_of_parabola

end module node_extremes
