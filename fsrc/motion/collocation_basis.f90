!> What implicit steps by collocation have in common, of rigid teeth (module collocation_step) and of contacts with numbers of their
!> own (module elastic_step): how long steps are, where they start from, and what their errors are. Only their equations are two.
module collocation_basis
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_force, only: forces_of_lane, total_forces
   use lane_functions, only: lanes
   use radau_nodes, only: node, node_rows, powers_of_place, rows, stages
   implicit none(type, external)
   private

   !> Share of the accuracy for the last coefficient of a polynomial, and for the first one left out.
   real(dp), parameter, public :: last_share = 40.0_dp, next_share = 2.0_dp
   !> Share of the accuracy at which the iterations end
   real(dp), parameter, public :: iteration_share = 1.0e-2_dp
   !> Error that is rounding alone, as a share of the film
   real(dp), parameter, public :: rounding = 16.0_dp*epsilon(1.0_dp)
   !> Longest step [periods]
   real(dp), parameter :: longest_step = 0.25_dp
   !> Step over the one before, at least, and the most for which polynomials are carried on
   real(dp), parameter :: least_growth = 0.1_dp, most_extrapolation = 2.0_dp

   public :: choose_steps, forces_of_stages, forces_at_nodes, can_extrapolate, carry_on, highest_terms, error_of_acceleration, &
             growth_of, series_of_motion

contains

   !> Steps as proposed, cut to end with the period.
   pure subroutine choose_steps(block)
      type(lane_block_t), intent(inout) :: block
      real(dp) :: reach
      integer :: l

      do l = 1, lanes
         block%remaining(l) = 1.0_dp - block%phase(l)
         reach = min(block%proposed(l), block%limit(l), longest_step)
         block%step(l) = merge(0.5_dp*block%remaining(l), reach, block%remaining(l) < 2.0_dp*reach)
         block%step(l) = merge(block%remaining(l), block%step(l), block%remaining(l) <= reach)
      end do
   end subroutine choose_steps

   !> Force at the nodes, static load included.
   pure subroutine forces_of_stages(block, force)
      type(lane_block_t), intent(in) :: block
      !> Scaled force [-]
      real(dp), intent(out) :: force(lanes, stages)
      real(dp) :: phase(lanes)
      integer :: i

      do i = 1, stages
         phase = min(1.0_dp, block%phase + node(i)*block%step)
         call total_forces(phase, block%static_load, block%oscillation, force(:, i))
      end do
   end subroutine forces_of_stages

   !> The same of one lane, to the same bits.
   pure subroutine forces_at_nodes(lane, block, force)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      !> Scaled force [-]
      real(dp), intent(out) :: force(rows)

      call forces_of_lane(lane, min(1.0_dp, block%phase(lane) + node_rows*block%step(lane)), block%static_load(lane), &
                          block%oscillation, force)
   end subroutine forces_at_nodes

   !> Whether the polynomials of the step before may be carried on to the end of this one.
   pure logical function can_extrapolate(lane, block)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block

      can_extrapolate = block%last_step(lane) > 0.0_dp .and. block%step(lane) < most_extrapolation*block%last_step(lane)
   end function can_extrapolate

   !> First iterate: a polynomial of the step before at the nodes of this one.
   pure subroutine carry_on(polynomial, ratio, values)
      !> Coefficients of the powers of 2c - 1
      real(dp), intent(in) :: polynomial(stages)
      !> This step over the one before
      real(dp), intent(in) :: ratio
      !> At the nodes
      real(dp), intent(out) :: values(rows)
      integer :: i, j

      values = polynomial(stages)
      do j = stages - 1, 1, -1
         !$omp simd
         do i = 1, rows
            values(i) = values(i)*(1.0_dp + 2.0_dp*ratio*node_rows(i)) + polynomial(j)
         end do
      end do
   end subroutine carry_on

   !> Size of the highest Legendre coefficient of the acceleration, and what the first one left out may be:
   !> the coefficients are taken to fall as they did over the last ones.
   pure subroutine highest_terms(polynomial, top, next)
      !> Coefficients of the powers of 2c - 1
      real(dp), intent(in) :: polynomial(stages)
      !> Coefficient of P_6
      real(dp), intent(out) :: top
      !> Coefficient of P_7
      real(dp), intent(out) :: next
      !> Coefficients of the powers 4, 5 and 6 in P_4, P_5 and P_6, and of power 4 in P_6
      real(dp), parameter :: lead_4 = 4.375_dp, lead_5 = 7.875_dp, lead_6 = 14.4375_dp, tail_6 = -19.6875_dp
      real(dp) :: fifth, fourth

      top = abs(polynomial(7))/lead_6
      fifth = max(abs(polynomial(6))/lead_5, top)
      fourth = max(abs(polynomial(5) - tail_6*polynomial(7)/lead_6)/lead_4, fifth, tiny(1.0_dp))
      ! A coefficient may vanish by chance: it counts as no less than what the two before it predict.
      top = max(top, fifth*(fifth/fourth))
      next = top*sqrt(top/fourth)
   end subroutine highest_terms

   !> Error of the film by the polynomial of the acceleration [-]: the last coefficient moves the film by s^2 k/196 and V by s k/14 at
   !> the end of a smooth step; within it, and at the end of a stiff one, the first coefficient left out counts.
   pure real(dp) function error_of_acceleration(polynomial, step, weight) result(error)
      !> Coefficients of the powers of 2c - 1
      real(dp), intent(in) :: polynomial(stages)
      !> s [periods]
      real(dp), intent(in) :: step
      !> Film error that an error of one in V counts as
      real(dp), intent(in) :: weight
      real(dp) :: top, next

      call highest_terms(polynomial, top, next)
      error = max(top/last_share, next/next_share)*step*max(step/real(4*stages**2, dp), weight/real(2*stages, dp))
   end function error_of_acceleration

   !> Next step over this one, by an error in units of that allowed.
   pure real(dp) function growth_of(error, most, share)
      real(dp), intent(in) :: error
      !> Next step over this one, at most
      real(dp), intent(in) :: most
      !> Of what the error allows
      real(dp), intent(in) :: share

      growth_of = max(least_growth, min(most, share/sqrt(sqrt(sqrt(max(error, tiny(1.0_dp)))))))
   end function growth_of

   !> Position and velocity through the step as power series about its start, from the polynomial of the acceleration.
   pure subroutine series_of_motion(lane, block)
      integer, intent(in) :: lane
      type(lane_block_t), intent(inout) :: block
      real(dp) :: shifted(0:stages), scale
      integer :: j

      shifted = powers_of_place(block%polynomial(lane, :))
      block%film(lane, 1:) = 0.0_dp
      block%lienard(lane, 1:) = 0.0_dp
      block%film(lane, 1) = block%lienard(lane, 0)
      scale = 1.0_dp
      do j = 0, stages - 1
         block%lienard(lane, j + 1) = shifted(j)*scale/real(j + 1, dp)
         block%film(lane, j + 2) = block%lienard(lane, j + 1)/real(j + 2, dp)
         scale = scale/block%step(lane)
      end do
   end subroutine series_of_motion

end module collocation_basis
