!> Film and velocity within the steps of a motion, at Gauss's nodes: what happens between samples is seen there.
!>
!> A step is as long as its polynomials are good, so eight nodes of it carry all that they know: integrals over a step are
!> exact to rounding, and interpolation between its nodes is closer than the accuracy of the step. A step is cut into equal
!> pieces of eight nodes each where oscillations shorter than it are to be integrated.
module step_nodes
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_state, only: carried_numbers, evaluate_inner, sum_series, lane_inner_t, numbers_of_lane, series_of_number
   use problem, only: of_film, of_velocity
   use taylor_step_control, only: order
   implicit none(type, external)
   private

   !> Nodes of a piece of a step.
   integer, parameter, public :: nodes_per_piece = 8
   !> Their places in the piece, from 0 to 1, and the weights of their integrals.
   real(dp), parameter :: place(4) = [0.1834346424956498_dp, 0.5255324099163290_dp, 0.7966664774136267_dp, 0.9602898564975363_dp]
   real(dp), parameter :: share(4) = [0.3626837833783620_dp, 0.3137066458778873_dp, 0.2223810344533745_dp, 0.1012285362903763_dp]
   real(dp), parameter, public :: node_place(nodes_per_piece) = 0.5_dp + 0.5_dp*[-place(4:1:-1), place]
   real(dp), parameter, public :: node_weight(nodes_per_piece) = 0.5_dp*[share(4:1:-1), share]
   !> Barycentric weights of interpolation, (-1)^i sqrt((1 - x^2) w) (Wang and Xiang 2012).
   real(dp), parameter :: barycentric(nodes_per_piece) = [-1.0_dp, 1.0_dp, -1.0_dp, 1.0_dp, -1.0_dp, 1.0_dp, -1.0_dp, 1.0_dp] &
                          *sqrt([(1.0_dp - place(4:1:-1)**2)*share(4:1:-1), (1.0_dp - place**2)*share])
   !> Pieces for which there is room at first.
   integer, parameter :: first_room = 64

   !> Nodes of the steps of one period of one motion, piece after piece.
   type, public :: step_nodes_t
      !> Pieces
      integer :: pieces = 0
      !> Phase where a piece begins, and its length [periods]
      real(dp), allocatable :: start(:), length(:)
      !> States at the nodes, eight a piece: node, number of the state
      real(dp), allocatable :: states(:, :)
   end type step_nodes_t

   public :: take_nodes, add_piece, interpolate

contains

   !> Add the nodes of the present step of a lane.
   pure subroutine take_nodes(block, lane, inner, longest_piece, nodes)
      !> The block, with series and steps
      type(lane_block_t), intent(in) :: block
      integer, intent(in) :: lane
      !> States of films beside it
      type(lane_inner_t), intent(in) :: inner
      !> Longest piece [periods]
      real(dp), intent(in) :: longest_piece
      !> Nodes of the period so far
      type(step_nodes_t), intent(inout) :: nodes
      real(dp), dimension(nodes_per_piece) :: x, film, velocity, odd_film, odd_velocity, numbers
      real(dp) :: film_series(0:order), lienard_series(0:order), length
      integer :: pieces, piece, before, carried, i, k

      film_series = block%film(lane, :)
      lienard_series = block%lienard(lane, :)
      pieces = max(1, ceiling(block%step(lane)/longest_piece))
      length = block%step(lane)/real(pieces, dp)
      carried = carried_numbers(lane, block)
      call provide_room(nodes, nodes%pieces + pieces, numbers_of_lane(lane, block, inner))
      do piece = 1, pieces
         x = (real(piece - 1, dp) + node_place)*length
         ! Even and odd powers apart: four sums that do not wait for each other.
         film = film_series(order)
         velocity = lienard_series(order)
         odd_film = film_series(order - 1)
         odd_velocity = lienard_series(order - 1)
         do k = order - 2, 2, -2
            !$omp simd
            do i = 1, nodes_per_piece
               film(i) = film(i)*(x(i)*x(i)) + film_series(k)
               velocity(i) = velocity(i)*(x(i)*x(i)) + lienard_series(k)
               odd_film(i) = odd_film(i)*(x(i)*x(i)) + film_series(k - 1)
               odd_velocity(i) = odd_velocity(i)*(x(i)*x(i)) + lienard_series(k - 1)
            end do
         end do
         !$omp simd
         do i = 1, nodes_per_piece
            film(i) = film(i)*(x(i)*x(i)) + (odd_film(i)*x(i) + film_series(0))
            velocity(i) = velocity(i)*(x(i)*x(i)) + (odd_velocity(i)*x(i) + lienard_series(0))
            velocity(i) = velocity(i) + block%slip(lane)/sqrt(film(i))
         end do
         if (block%slip(lane) > 0.0_dp .and. block%backlash(lane) < huge(1.0_dp)) &
            velocity = velocity - block%slip(lane)/sqrt(block%backlash(lane) - film)
         before = nodes_per_piece*nodes%pieces
         nodes%pieces = nodes%pieces + 1
         nodes%start(nodes%pieces) = block%phase(lane) + real(piece - 1, dp)*length
         nodes%length(nodes%pieces) = length
         nodes%states(before + 1:before + nodes_per_piece, of_film) = film*block%film_scale(lane)
         nodes%states(before + 1:before + nodes_per_piece, of_velocity) = velocity*block%velocity_scale(lane)
         do k = 1, carried
            call sum_series(nodes_per_piece, series_of_number(lane, k, block), x, numbers)
            nodes%states(before + 1:before + nodes_per_piece, of_velocity + k) = numbers*block%film_scale(lane)
         end do
         if (inner%count > 0) call evaluate_inner(inner, x, nodes%states(before + 1:before + nodes_per_piece, &
                                                                         of_velocity + carried + 1:))
      end do
   end subroutine take_nodes

   !> Add a piece whose states are known.
   pure subroutine add_piece(start, length, states, nodes)
      !> Phase where it begins, and its length [periods]
      real(dp), intent(in) :: start
      real(dp), intent(in) :: length
      !> Node, number of the state
      real(dp), intent(in) :: states(:, :)
      !> Nodes of the period so far
      type(step_nodes_t), intent(inout) :: nodes

      call provide_room(nodes, nodes%pieces + 1, size(states, 2))
      nodes%states(nodes_per_piece*nodes%pieces + 1:nodes_per_piece*(nodes%pieces + 1), :) = states
      nodes%pieces = nodes%pieces + 1
      nodes%start(nodes%pieces) = start
      nodes%length(nodes%pieces) = length
   end subroutine add_piece

   !> See that so many pieces have their place.
   pure subroutine provide_room(nodes, pieces, numbers)
      type(step_nodes_t), intent(inout) :: nodes
      integer, intent(in) :: pieces
      !> Of a state
      integer, intent(in) :: numbers
      real(dp), allocatable :: longer(:, :)
      integer :: room, filled

      room = 0
      filled = 0
      if (allocated(nodes%states)) then
         room = size(nodes%start)
         filled = room
         ! The lane has taken a motion of other states, of which nothing stands here yet.
         if (size(nodes%states, 2) /= numbers) filled = 0
      end if
      if (room >= pieces .and. filled > 0) return
      room = max(first_room, pieces, room, 2*filled)
      call extend(nodes%start, room)
      call extend(nodes%length, room)
      allocate (longer(nodes_per_piece*room, numbers))
      if (filled > 0) longer(:nodes_per_piece*filled, :) = nodes%states
      call move_alloc(longer, nodes%states)
   end subroutine provide_room

   !> Lengthen an array.
   pure subroutine extend(numbers, length)
      real(dp), allocatable, intent(inout) :: numbers(:)
      integer, intent(in) :: length
      real(dp), allocatable :: longer(:)

      allocate (longer(length))
      if (allocated(numbers)) longer(:size(numbers)) = numbers
      call move_alloc(longer, numbers)
   end subroutine extend

   !> State within a piece, from those at its nodes.
   pure subroutine interpolate(states, piece, x, state)
      !> Nodes of some pieces, eight a piece: node, number of the state
      real(dp), intent(in) :: states(:, :)
      !> The piece, and a place in it, from 0 to 1
      integer, intent(in) :: piece
      real(dp), intent(in) :: x
      !> The numbers there
      real(dp), intent(out) :: state(:)
      real(dp), dimension(nodes_per_piece) :: distance, factor, products
      integer :: nearest, number, before

      before = nodes_per_piece*(piece - 1)
      distance = x - node_place
      if (any(abs(distance) < epsilon(1.0_dp))) then
         nearest = minloc(abs(distance), dim=1)
         state = states(before + nearest, :)
      else
         factor = barycentric/distance
         factor = factor/sum(factor)
         do number = 1, size(states, 2)
            call multiply(factor, states(before + 1:before + nodes_per_piece, number), products)
            state(number) = sum(products)
         end do
      end if
   end subroutine interpolate

   !> Rounded products. Part of another routine, which the flags of this file do not allow, they would be fused with their sum, one
   !> way here and another there.
   pure subroutine multiply(factor, values, products)
      real(dp), intent(in) :: factor(nodes_per_piece)
      real(dp), intent(in) :: values(nodes_per_piece)
      real(dp), intent(out) :: products(nodes_per_piece)

      products = factor*values
   end subroutine multiply

end module step_nodes
