!> The state of a film through an implicit step, taken out of the equations of the gear.
!>
!> At the nodes of the step y is a polynomial through its start and its values y_i, y_i' = sum(derivative_ij (y_j - y(0)))/s, and
!> the film law is to hold there, r(h_i, h_i', y_i, y_i') = 0. A pass of Newton's method solves these equations for small changes
!> of all h_i and h_i', which the gear does not know yet,
!>
!>     dy = -J^-1 (r + r_h dh + r_h' dh') ,      W = W_i + W_y dy + W_h dh + W_h' dh' ,
!>
!> so that what the gear sees of a contact is a load at each node with slopes in the films and velocities at all nodes (Schur's
!> complement): its equations are as many as without the state, and the contacts are independent of each other. Once the gear has
!> found dh and dh', `follow_film` brings the state after.
module inner_step
   use film_law, only: overflow_load
   use film_state, only: film_response_t
   use film_states, only: respond_of_state
   use flank_contact, only: flank_contact_t
   use kinds, only: dp
   use linear_equations, only: solve_linear
   implicit none(type, external)
   private

   !> State of a film through a step.
   type, public :: inner_step_t
      !> At the start, and at the nodes: number, node
      real(dp), allocatable :: start(:)
      real(dp), allocatable :: values(:, :)
      !> -J^-1 of r, of r_h at each node and of r_h' at each node: number and node, right-hand side
      real(dp), allocatable, private :: follows(:, :)
   end type inner_step_t

   !> What the gear sees of a contact over a step.
   type, public :: step_response_t
      !> Loads at the nodes [N], as they will be once the state is right
      real(dp), allocatable :: loads(:)
      !> Their slopes in films [N/m] and velocities [N s/m]: node of the load, node of the film
      real(dp), allocatable :: by_film(:, :)
      real(dp), allocatable :: by_velocity(:, :)
      !> Whether every node has a load, and if not, whether because it is beyond all
      logical :: exists = .false.
      logical :: overloaded = .false.
   end type step_response_t

   public :: eliminate_state, follow_film

contains

   !> Take the state of a film out of the equations of a step.
   pure subroutine eliminate_state(contact, derivative, length, films, velocities, inner, response)
      type(flank_contact_t), intent(in) :: contact
      !> Derivative at a node, over the length of the step, of the polynomial that is 1 at another node and 0 at the start
      real(dp), intent(in) :: derivative(:, :)
      !> Length of the step [s]
      real(dp), intent(in) :: length
      !> h [m] and h' [m/s] at the nodes
      real(dp), intent(in) :: films(:)
      real(dp), intent(in) :: velocities(:)
      type(inner_step_t), intent(inout) :: inner
      type(step_response_t), intent(out) :: response
      type(film_response_t) :: here(size(films))
      real(dp) :: jacobian(size(inner%values), size(inner%values)), rates(size(inner%start), size(films))
      integer :: n, nodes, first, last, i, j, k

      n = size(inner%start)
      nodes = size(films)
      rates = matmul(inner%values - spread(inner%start, 2, nodes), transpose(derivative))/length
      if (.not. allocated(inner%follows)) allocate (inner%follows(n*nodes, 1 + 2*nodes))
      inner%follows = 0.0_dp
      jacobian = 0.0_dp
      do i = 1, nodes
         here(i) = respond_of_state(contact%state_law, contact%film, films(i), velocities(i), inner%values(:, i), rates(:, i))
         response%overloaded = .not. abs(here(i)%load) < overflow_load
         if (response%overloaded) return
         first = n*(i - 1) + 1
         last = n*i
         inner%follows(first:last, 1) = -here(i)%residual
         inner%follows(first:last, 1 + i) = -here(i)%residual_by_film
         inner%follows(first:last, 1 + nodes + i) = -here(i)%residual_by_velocity
         do j = 1, nodes
            do k = 1, n
               jacobian(first:last, n*(j - 1) + k) = derivative(i, j)/length*here(i)%residual_by_rate(:, k)
            end do
         end do
         jacobian(first:last, first:last) = jacobian(first:last, first:last) + here(i)%residual_by_inner
      end do
      call solve_linear(jacobian, inner%follows, response%exists)
      if (.not. response%exists) return
      allocate (response%loads(nodes), response%by_film(nodes, nodes), response%by_velocity(nodes, nodes))
      do i = 1, nodes
         first = n*(i - 1) + 1
         last = n*i
         response%loads(i) = here(i)%load + dot_product(here(i)%by_inner, inner%follows(first:last, 1))
         do j = 1, nodes
            response%by_film(i, j) = dot_product(here(i)%by_inner, inner%follows(first:last, 1 + j))
            response%by_velocity(i, j) = dot_product(here(i)%by_inner, inner%follows(first:last, 1 + nodes + j))
         end do
         response%by_film(i, i) = response%by_film(i, i) + here(i)%by_film
         response%by_velocity(i, i) = response%by_velocity(i, i) + here(i)%by_velocity
      end do
   end subroutine eliminate_state

   !> Let the state follow changes of the films, by the equations solved last.
   pure subroutine follow_film(share, film_changes, velocity_changes, inner, changes)
      !> Share of its correction that the gear has taken
      real(dp), intent(in) :: share
      !> At the nodes [m], [m/s]
      real(dp), intent(in) :: film_changes(:)
      real(dp), intent(in) :: velocity_changes(:)
      type(inner_step_t), intent(inout) :: inner
      !> Largest change of each of its numbers
      real(dp), intent(out) :: changes(:)
      real(dp) :: right(1 + 2*size(film_changes)), change(size(inner%values, 1), size(inner%values, 2))

      right(1) = share
      right(2:1 + size(film_changes)) = film_changes
      right(2 + size(film_changes):) = velocity_changes
      change = reshape(matmul(inner%follows, right), shape(change))
      inner%values = inner%values + change
      changes = maxval(abs(change), dim=2)
   end subroutine follow_film

end module inner_step
