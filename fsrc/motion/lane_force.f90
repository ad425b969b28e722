!> The part of the force that oscillates, scaled, for a block of lanes: its values and its derivatives.
module lane_force
   use constants, only: two_pi
   use force, only: force_t
   use kinds, only: dp
   use lane_functions, only: half_block, half_cosine_sine, lane_cosine_sine, lanes
   use scene_types, only: highest_order
   use taylor_step_control, only: order
   implicit none(type, external)
   private

   !> Phases of the lanes on the unit circle.
   type, public :: lane_phase_t
      !> Of 2 pi times the phase
      real(dp) :: cosine(lanes), sine(lanes)
   end type lane_phase_t

   !> Forces of the lanes.
   type, public :: lane_force_t
      !> Where the lanes stand
      type(lane_phase_t) :: phase
      !> Factors of the cosine and sine of each order, lane by lane [-]
      real(dp) :: cosine(lanes, highest_order), sine(lanes, highest_order)
      !> Highest order of all of them; factors beyond it are not defined
      integer :: highest
   end type lane_force_t

   integer :: i, n
   !> Derivative k-1 of cos(2 pi x), over k!, is factor(k) times cos (k odd) or sin (k even) of 2 pi x.
   real(dp), parameter, public :: factor(order) = &
      [(merge(1.0_dp, -1.0_dp, mod(i, 4) < 2)*two_pi**(i - 1)/gamma(real(i + 1, dp)), i=1, order)]

   !> Orders whose derivatives are added at once
   integer, parameter :: together = 4
   !> (k, n): n**(k-1)
   real(dp), parameter :: powers(order, highest_order + together) = &
      reshape([((real(n, dp)**(i - 1), i=1, order), n=1, highest_order + together)], [order, highest_order + together])

   public :: no_forces, set_force, start_force, turn_to, move_forces, force_values, force_derivatives, total_forces, forces_of_lane

contains

   !> Forces of lanes before any is set.
   pure subroutine no_forces(forces)
      type(lane_force_t), intent(inout) :: forces

      forces%highest = 1
      forces%cosine(:, 1) = 0.0_dp
      forces%sine(:, 1) = 0.0_dp
      forces%phase%cosine = 1.0_dp
      forces%phase%sine = 0.0_dp
   end subroutine no_forces

   !> Give a lane its force. Orders that its neighbours alone have it takes nothing of: the same bits as alone.
   pure subroutine set_force(force, unit, lane, forces)
      !> The force
      type(force_t), intent(in) :: force
      !> What counts as 1 [N]
      real(dp), intent(in) :: unit
      integer, intent(in) :: lane
      type(lane_force_t), intent(inout) :: forces
      integer :: n

      do n = forces%highest + 1, force%highest
         forces%cosine(:, n) = 0.0_dp
         forces%sine(:, n) = 0.0_dp
      end do
      forces%highest = max(forces%highest, force%highest)
      forces%cosine(lane, 1) = force%cosine/unit
      forces%sine(lane, 1) = force%sine/unit
      do n = 2, force%highest
         forces%cosine(lane, n) = force%others(1, n)/unit
         forces%sine(lane, n) = force%others(2, n)/unit
      end do
      forces%cosine(lane, force%highest + 1:forces%highest) = 0.0_dp
      forces%sine(lane, force%highest + 1:forces%highest) = 0.0_dp
   end subroutine set_force

   !> Bring the force of a lane to the start of a period.
   pure subroutine start_force(lane, forces)
      integer, intent(in) :: lane
      type(lane_force_t), intent(inout) :: forces

      forces%phase%cosine(lane) = 1.0_dp
      forces%phase%sine(lane) = 0.0_dp
   end subroutine start_force

   !> Phases on the unit circle.
   pure subroutine turn_to(phase, circle)
      !> From 0 to 1 [periods]
      real(dp), intent(in) :: phase(lanes)
      type(lane_phase_t), intent(inout) :: circle

      call lane_cosine_sine(phase, circle%cosine, circle%sine)
   end subroutine turn_to

   !> Take over other phases in the lanes whose step is accepted.
   pure subroutine move_forces(there, accepted, forces)
      !> Phases at the ends of the steps
      type(lane_phase_t), intent(in) :: there
      !> 1 where the step is accepted, else 0
      real(dp), intent(in) :: accepted(lanes)
      type(lane_force_t), intent(inout) :: forces

      forces%phase%cosine = merge(there%cosine, forces%phase%cosine, accepted > 0.0_dp)
      forces%phase%sine = merge(there%sine, forces%phase%sine, accepted > 0.0_dp)
   end subroutine move_forces

   !> Values of the part that oscillates at some phases [-].
   pure function force_values(forces, phase) result(values)
      type(lane_force_t), intent(in) :: forces
      type(lane_phase_t), intent(in) :: phase
      real(dp) :: values(lanes)
      type(lane_phase_t) :: power
      integer :: n

      values = forces%cosine(:, 1)*phase%cosine + forces%sine(:, 1)*phase%sine
      if (forces%highest < 2) return
      power = phase
      do n = 2, forces%highest
         call raise(phase, power)
         values = values + forces%cosine(:, n)*power%cosine + forces%sine(:, n)*power%sine
      end do
   end function force_values

   !> Derivatives of the part that oscillates where the lanes stand: coefficient k of V takes factor(k) times derivative
   !> k from it. That of a cos(n t + phi) is n**(k-1) a times the cosine (k odd) or sine (k even) of n t + phi.
   pure subroutine force_derivatives(last, forces, derivatives)
      !> Last one that is wanted
      integer, intent(in) :: last
      type(lane_force_t), intent(in) :: forces
      !> Lane, k
      real(dp), intent(out) :: derivatives(lanes, order)
      type(lane_phase_t) :: power
      real(dp), dimension(lanes) :: cosine, sine
      real(dp), dimension(lanes, together) :: cosines, sines
      integer :: first, i, n, k

      associate (phase => forces%phase)
         cosine = forces%cosine(:, 1)*phase%cosine + forces%sine(:, 1)*phase%sine
         sine = forces%cosine(:, 1)*phase%sine - forces%sine(:, 1)*phase%cosine
         do k = 1, last, 2
            derivatives(:, k) = cosine
         end do
         do k = 2, last, 2
            derivatives(:, k) = sine
         end do
         if (forces%highest < 2) return
         power = phase
         do first = 2, forces%highest, together
            do i = 1, together
               n = first + i - 1
               if (n > forces%highest) then
                  cosines(:, i) = 0.0_dp
                  sines(:, i) = 0.0_dp
                  cycle
               end if
               call raise(phase, power)
               cosines(:, i) = forces%cosine(:, n)*power%cosine + forces%sine(:, n)*power%sine
               sines(:, i) = forces%cosine(:, n)*power%sine - forces%sine(:, n)*power%cosine
            end do
            do k = 1, last, 2
               call add_orders(powers(k, first:first + together - 1), cosines, derivatives(:, k))
            end do
            do k = 2, last, 2
               call add_orders(powers(k, first:first + together - 1), sines, derivatives(:, k))
            end do
         end do
      end associate
   end subroutine force_derivatives

   !> Add the share of some orders to a derivative.
   pure subroutine add_orders(power, values, derivative)
      !> By which each order is multiplied
      real(dp), intent(in) :: power(together)
      real(dp), intent(in) :: values(lanes, together)
      real(dp), intent(inout) :: derivative(lanes)
      integer :: l

      !$omp simd
      do l = 1, lanes
         derivative(l) = derivative(l) + power(1)*values(l, 1) + power(2)*values(l, 2) + power(3)*values(l, 3) &
                         + power(4)*values(l, 4)
      end do
   end subroutine add_orders

   !> Steady and oscillating part together, at other phases.
   pure subroutine total_forces(phase, steady, forces, total)
      !> From 0 to 1 [periods]
      real(dp), intent(in) :: phase(lanes)
      !> Steady part [-]
      real(dp), intent(in) :: steady(lanes)
      type(lane_force_t), intent(in) :: forces
      !> Force [-]
      real(dp), intent(out) :: total(lanes)
      type(lane_phase_t) :: circle, power
      integer :: n, l

      call turn_to(phase, circle)
      !$omp simd
      do l = 1, lanes
         total(l) = steady(l) + forces%cosine(l, 1)*circle%cosine(l) + forces%sine(l, 1)*circle%sine(l)
      end do
      if (forces%highest < 2) return
      power = circle
      do n = 2, forces%highest
         call raise(circle, power)
         total = total + forces%cosine(:, n)*power%cosine + forces%sine(:, n)*power%sine
      end do
   end subroutine total_forces

   !> The same of one lane at many phases, to the same bits.
   pure subroutine forces_of_lane(lane, phase, steady, forces, total)
      integer, intent(in) :: lane
      !> From 0 to 1 [periods]
      real(dp), intent(in) :: phase(half_block)
      !> Steady part [-]
      real(dp), intent(in) :: steady
      type(lane_force_t), intent(in) :: forces
      !> Force [-]
      real(dp), intent(out) :: total(half_block)
      real(dp), dimension(half_block) :: cosine, sine, power_cosine, power_sine
      real(dp) :: next
      integer :: n, i

      call half_cosine_sine(phase, cosine, sine)
      !$omp simd
      do i = 1, half_block
         total(i) = steady + forces%cosine(lane, 1)*cosine(i) + forces%sine(lane, 1)*sine(i)
      end do
      power_cosine = cosine
      power_sine = sine
      do n = 2, forces%highest
         !$omp simd private(next)
         do i = 1, half_block
            next = power_cosine(i)*cosine(i) - power_sine(i)*sine(i)
            power_sine(i) = power_sine(i)*cosine(i) + power_cosine(i)*sine(i)
            power_cosine(i) = next
            total(i) = total(i) + forces%cosine(lane, n)*power_cosine(i) + forces%sine(lane, n)*power_sine(i)
         end do
      end do
   end subroutine forces_of_lane

   !> From a power of a point on the unit circle to the next one.
   pure subroutine raise(point, power)
      type(lane_phase_t), intent(in) :: point
      type(lane_phase_t), intent(inout) :: power
      real(dp) :: next
      integer :: l

      !$omp simd private(next)
      do l = 1, lanes
         next = power%cosine(l)*point%cosine(l) - power%sine(l)*point%sine(l)
         power%sine(l) = power%sine(l)*point%cosine(l) + power%cosine(l)*point%sine(l)
         power%cosine(l) = next
      end do
   end subroutine raise

end module lane_force
