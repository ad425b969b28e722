!> The part of the force that oscillates, scaled, for a block of lanes: its values and its derivatives.
module lane_force
   use constants, only: two_pi
   use force, only: force_t
   use kinds, only: dp
   use lane_functions, only: lane_cosine_sine, lanes
   use taylor_step_control, only: order
   implicit none(type, external)
   private

   !> Forces of the lanes, at a phase each.
   type, public :: lane_force_t
      !> Amplitude [-]
      real(dp) :: amplitude(lanes)
      !> Of 2 pi times the phase
      real(dp) :: cosine(lanes), sine(lanes)
   end type lane_force_t

   integer :: i
   !> Derivative k-1 of cos(2 pi x), over k!, is factor(k) times cos (k odd) or sin (k even) of 2 pi x.
   real(dp), parameter, public :: factor(order) = &
      [(merge(1.0_dp, -1.0_dp, mod(i, 4) < 2)*two_pi**(i - 1)/gamma(real(i + 1, dp)), i=1, order)]

   public :: set_force, start_force, turn_forces, move_forces, force_values, force_derivatives, total_forces

contains

   !> Give a lane its force.
   pure subroutine set_force(force, unit, lane, forces)
      !> The force
      type(force_t), intent(in) :: force
      !> What counts as 1 [N]
      real(dp), intent(in) :: unit
      integer, intent(in) :: lane
      type(lane_force_t), intent(inout) :: forces

      forces%amplitude(lane) = force%amplitude/unit
   end subroutine set_force

   !> Bring the force of a lane to the start of a period.
   pure subroutine start_force(lane, forces)
      integer, intent(in) :: lane
      type(lane_force_t), intent(inout) :: forces

      forces%cosine(lane) = 1.0_dp
      forces%sine(lane) = 0.0_dp
   end subroutine start_force

   !> Bring the forces of all lanes to other phases.
   pure subroutine turn_forces(phase, forces)
      !> From 0 to 1 [periods]
      real(dp), intent(in) :: phase(lanes)
      type(lane_force_t), intent(inout) :: forces

      call lane_cosine_sine(phase, forces%cosine, forces%sine)
   end subroutine turn_forces

   !> Take over the phases of other forces of the same lanes, in the lanes whose step is trusted.
   pure subroutine move_forces(there, trust, forces)
      !> Forces at the ends of the steps
      type(lane_force_t), intent(in) :: there
      !> 1 where the step is trusted, else 0
      real(dp), intent(in) :: trust(lanes)
      type(lane_force_t), intent(inout) :: forces

      forces%cosine = merge(there%cosine, forces%cosine, trust > 0.0_dp)
      forces%sine = merge(there%sine, forces%sine, trust > 0.0_dp)
   end subroutine move_forces

   !> Values of the part that oscillates [-].
   pure function force_values(forces) result(values)
      type(lane_force_t), intent(in) :: forces
      real(dp) :: values(lanes)

      values = forces%amplitude*forces%cosine
   end function force_values

   !> Derivatives of the part that oscillates: coefficient k of the momentum takes factor(k) times derivative k from it.
   pure subroutine force_derivatives(last, forces, derivatives)
      !> Last one that is wanted
      integer, intent(in) :: last
      type(lane_force_t), intent(in) :: forces
      !> Lane, k
      real(dp), intent(out) :: derivatives(lanes, order)
      integer :: k

      do k = 1, last, 2
         derivatives(:, k) = forces%amplitude*forces%cosine
      end do
      do k = 2, last, 2
         derivatives(:, k) = forces%amplitude*forces%sine
      end do
   end subroutine force_derivatives

   !> Steady and oscillating part together, at other phases.
   pure subroutine total_forces(phase, steady, forces, total)
      !> From 0 to 1 [periods]
      real(dp), intent(in) :: phase(lanes)
      !> Steady part [-]
      real(dp), intent(in) :: steady(lanes)
      type(lane_force_t), intent(in) :: forces
      !> Force [-]
      real(dp), intent(out) :: total(lanes)
      real(dp), dimension(lanes) :: cosine, sine
      integer :: l

      call lane_cosine_sine(phase, cosine, sine)
      !$omp simd
      do l = 1, lanes
         total(l) = steady(l) + forces%amplitude(l)*cosine(l)
      end do
   end subroutine total_forces

end module lane_force
