!> Points of the load W of a film in a piece of a step: its nodes, its ends, where W turns, and where it passes a level. Between
!> the nodes film and velocity are interpolated, and W follows from them by its own law.
module load_points
   use carried_loads, only: contact_loads
   use kinds, only: dp
   use node_extremes, only: narrow, top_of_parabola
   use problem, only: of_velocity, problem_t
   use step_nodes, only: interpolate, node_place, nodes_per_piece
   implicit none(type, external)
   private

   !> Points of a piece: its nodes, its ends and the turns between.
   integer, parameter :: most_points = 2*nodes_per_piece + 4

   !> Points of W in a piece, in their order: place from 0 to 1, W [N], velocity of the gear [m/s], and whether W turns there.
   type, public :: piece_points_t
      integer :: count = 0
      real(dp) :: place(most_points) = 0.0_dp, load(most_points) = 0.0_dp, velocity(most_points) = 0.0_dp
      logical :: turns(most_points) = .false.
   end type piece_points_t

   public :: load_at, find_points, find_crossing

contains

   !> W and the velocity of the gear at a place in a piece.
   pure subroutine load_at(problem, contact, states, piece, place, load, velocity)
      type(problem_t), intent(in) :: problem
      integer, intent(in) :: contact
      real(dp), intent(in) :: states(:, :)
      integer, intent(in) :: piece
      real(dp), intent(in) :: place
      real(dp), intent(out) :: load
      real(dp), intent(out) :: velocity
      real(dp) :: here(1, size(states, 2)), loads(1)

      call interpolate(states, piece, place, here(1, :))
      call contact_loads(problem, contact, here, loads)
      load = loads(1)
      velocity = here(1, of_velocity)
   end subroutine load_at

   !> Points of W in a piece.
   pure subroutine find_points(problem, contact, states, piece, loads, points)
      type(problem_t), intent(in) :: problem
      integer, intent(in) :: contact
      real(dp), intent(in) :: states(:, :)
      integer, intent(in) :: piece
      !> At the nodes [N]
      real(dp), intent(in) :: loads(nodes_per_piece)
      type(piece_points_t), intent(out) :: points
      real(dp) :: x(0:nodes_per_piece + 1), y(0:nodes_per_piece + 1), v(0:nodes_per_piece + 1), place, load, velocity
      integer :: i

      x = [0.0_dp, node_place, 1.0_dp]
      y(1:nodes_per_piece) = loads
      v(1:nodes_per_piece) = states(nodes_per_piece*(piece - 1) + 1:nodes_per_piece*piece, of_velocity)
      call load_at(problem, contact, states, piece, x(0), y(0), v(0))
      call load_at(problem, contact, states, piece, x(nodes_per_piece + 1), y(nodes_per_piece + 1), v(nodes_per_piece + 1))
      call add(x(0), y(0), v(0), .false., points)
      call add_turn_at_end(0, points)
      do i = 1, nodes_per_piece
         if ((y(i) - y(i - 1))*(y(i + 1) - y(i)) < 0.0_dp) then
            call find_turn(x(i - 1:i + 1), y(i - 1:i + 1), v(i), place, load, velocity)
            if (place < x(i)) call add(place, load, velocity, .true., points)
            call add(x(i), y(i), v(i), .false., points)
            if (place > x(i)) call add(place, load, velocity, .true., points)
         else
            call add(x(i), y(i), v(i), .false., points)
         end if
      end do
      call add_turn_at_end(nodes_per_piece, points)
      call add(x(nodes_per_piece + 1), y(nodes_per_piece + 1), v(nodes_per_piece + 1), .false., points)

   contains

      !> Add a point behind those before it.
      pure subroutine add(place, load, velocity, turns, points)
         real(dp), intent(in) :: place
         real(dp), intent(in) :: load
         real(dp), intent(in) :: velocity
         logical, intent(in) :: turns
         type(piece_points_t), intent(inout) :: points

         if (points%count > 0) then
            if (.not. place > points%place(points%count)) return
         end if
         points%count = points%count + 1
         points%place(points%count) = place
         points%load(points%count) = load
         points%velocity(points%count) = velocity
         points%turns(points%count) = turns
      end subroutine add

      !> Add where W turns between an end of the piece and the node next to it, if it does.
      pure subroutine add_turn_at_end(first, points)
         !> The first of both points
         integer, intent(in) :: first
         type(piece_points_t), intent(inout) :: points
         real(dp) :: top, estimate, here, speed, place, load, velocity, sign_of
         integer :: k

         k = min(max(first, 1), nodes_per_piece)
         ! A turn of either kind is the highest point of a parabola, of W or of -W.
         sign_of = merge(1.0_dp, -1.0_dp, (y(k + 1) - y(k))*(x(k) - x(k - 1)) < (y(k) - y(k - 1))*(x(k + 1) - x(k)))
         call top_of_parabola(x(k - 1:k + 1), sign_of*y(k - 1:k + 1), top, estimate)
         if (.not. (top > x(first) .and. top < x(first + 1))) return
         call load_at(problem, contact, states, piece, top, here, speed)
         if (.not. sign_of*here > max(sign_of*y(first), sign_of*y(first + 1))) return
         call find_turn([x(first), top, x(first + 1)], [y(first), here, y(first + 1)], speed, place, load, velocity)
         call add(place, load, velocity, .true., points)
      end subroutine add_turn_at_end

      !> Where W turns between three places, the middle one above or below both others.
      pure subroutine find_turn(places, values, speed, place, load, velocity)
         real(dp), intent(in) :: places(3)
         real(dp), intent(in) :: values(3)
         !> Velocity at the middle one [m/s]
         real(dp), intent(in) :: speed
         real(dp), intent(out) :: place
         real(dp), intent(out) :: load
         real(dp), intent(out) :: velocity
         integer, parameter :: most_renewals = 8
         real(dp), parameter :: same_place = 1.0e-7_dp
         real(dp) :: at(3), height(3), top, estimate, sign_of, here
         integer :: iteration

         sign_of = merge(1.0_dp, -1.0_dp, values(2) > values(1))
         at = places
         height = sign_of*values
         place = places(2)
         load = values(2)
         velocity = speed
         do iteration = 1, most_renewals
            call top_of_parabola(at, height, top, estimate)
            if (.not. (top > at(1) .and. top < at(3))) exit
            if (abs(top - at(2)) < same_place) exit
            call load_at(problem, contact, states, piece, top, here, estimate)
            if (sign_of*here > sign_of*load) then
               place = top
               load = here
               velocity = estimate
            end if
            call narrow(at, height, top, sign_of*here)
         end do
      end subroutine find_turn

   end subroutine find_points

   !> Where W passes a level between two points that stand on both sides of it: false position, where one end that stays counts
   !> half (Illinois).
   pure subroutine find_crossing(problem, contact, states, piece, points, second, level, place, load, velocity)
      type(problem_t), intent(in) :: problem
      integer, intent(in) :: contact
      real(dp), intent(in) :: states(:, :)
      integer, intent(in) :: piece
      type(piece_points_t), intent(in) :: points
      !> The later of both points
      integer, intent(in) :: second
      !> [N]
      real(dp), intent(in) :: level
      real(dp), intent(out) :: place
      !> W [N] and the velocity of the gear [m/s] there
      real(dp), intent(out) :: load
      real(dp), intent(out) :: velocity
      integer, parameter :: most_iterations = 60
      real(dp), parameter :: same_place = 1.0e-13_dp, same_load = 1.0e-13_dp
      real(dp) :: x(2), y(2)
      integer :: iteration, side, side_before

      x = points%place(second - 1:second)
      y = points%load(second - 1:second) - level
      side_before = 0
      place = x(2)
      load = points%load(second)
      velocity = points%velocity(second)
      do iteration = 1, most_iterations
         if (x(2) - x(1) < same_place) exit
         place = (x(1)*y(2) - x(2)*y(1))/(y(2) - y(1))
         if (.not. (place > x(1) .and. place < x(2))) place = 0.5_dp*(x(1) + x(2))
         call load_at(problem, contact, states, piece, place, load, velocity)
         if (abs(load - level) <= same_load*level) exit
         side = merge(1, 2, load - level > 0.0_dp .eqv. y(1) > 0.0_dp)
         x(side) = place
         y(side) = load - level
         if (side == side_before) y(3 - side) = 0.5_dp*y(3 - side)
         side_before = side
      end do
   end subroutine find_crossing

end module load_points
