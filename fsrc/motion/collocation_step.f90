!> Implicit steps by collocation, for a block of lanes: any film law, any stiffness (fsrc/THEORY.md, section 6).
!>
!> A film law resists approach and motion, which keeps the matrix of Newton's method regular, and its pivots need no search.
!> First iterate: the polynomial of the step before, carried on. The measure of the error is that of the Taylor series
!> (taylor_step_control), with the least damping rate of the step and the least film that counts as one at its nodes.
module collocation_step
   use collocation_newton, only: allowed, correct, newton_pass_t, residual_and_matrix, scaled_load, solve_lanes, stage_states, &
      thinner
   use film_state, only: load_t
   use flank_contact, only: flank_contact_t
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_force, only: force_values, total_forces
   use lane_functions, only: lanes
   use radau_nodes, only: node, power, stages
   use taylor_step_control, only: lienard_weight
   implicit none(type, external)
   private

   !> Newton's iterations before the step is given up
   integer, parameter :: most_passes = 10
   !> Share of the accuracy for the last coefficient of the polynomial, and for the first one left out.
   real(dp), parameter :: last_share = 40.0_dp, next_share = 2.0_dp
   !> Largest of the integrals of the integral of w, of the header.
   real(dp), parameter :: twice_between = 1.2320e-3_dp
   !> Longest step [periods]
   real(dp), parameter :: longest_step = 0.25_dp
   !> Step over the one before, least and most, and the most for which the polynomial is carried on.
   real(dp), parameter :: least_growth = 0.1_dp, most_growth = 4.0_dp
   real(dp), parameter :: most_extrapolation = 2.0_dp

   public :: take_collocation_step, choose_steps, forces_of_stages, highest_terms

contains

   !> Try one step in every lane that has a scene.
   pure subroutine take_collocation_step(contacts, occupied, block)
      !> Contacts of the lanes
      type(flank_contact_t), intent(in) :: contacts(lanes)
      !> Lanes with a scene
      logical, intent(in) :: occupied(lanes)
      !> The block; leaves the film and velocity that the step leads to, whether they are to be trusted, and
      !> series for the samples
      type(lane_block_t), intent(inout) :: block
      real(dp) :: force(lanes, stages), k(lanes, stages), film(lanes, stages), lienard(lanes, stages)
      real(dp) :: residual(lanes, stages), matrix(lanes, stages, stages), imbalance(lanes)
      type(newton_pass_t) :: last
      logical :: busy(lanes)
      integer :: pass

      call choose_steps(block)
      call forces_of_stages(block, force)
      call first_iterate(contacts, occupied, block, k)
      busy = occupied
      block%trust = merge(1.0_dp, 0.0_dp, occupied)
      do pass = 1, most_passes
         call stage_states(busy, block, k, film, lienard)
         call residual_and_matrix(contacts, force, k, film, lienard, block, busy, residual, matrix)
         imbalance = maxval(abs(residual), dim=2)
         call solve_lanes(busy, matrix, residual)
         call correct(contacts, busy, pass, imbalance, residual, last, block, k)
         if (.not. any(busy)) exit
      end do
      where (busy) block%trust = 0.0_dp
      call stage_states(occupied, block, k, film, lienard)
      call judge(occupied, k, film, lienard, block)
   end subroutine take_collocation_step

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

   !> The polynomial of the step before at the new nodes, or its last value where it would be carried too far.
   pure subroutine first_iterate(contacts, occupied, block, k)
      type(flank_contact_t), intent(in) :: contacts(lanes)
      logical, intent(in) :: occupied(lanes)
      !> The acceleration at the start of a first step is set
      type(lane_block_t), intent(inout) :: block
      !> Accelerations at the nodes [-]
      real(dp), intent(out) :: k(lanes, stages)
      type(load_t) :: load
      real(dp) :: ratio, place, oscillation(lanes)
      integer :: l, i, j

      k = 0.0_dp
      oscillation = force_values(block%oscillation, block%oscillation%phase)
      do l = 1, lanes
         if (.not. occupied(l)) cycle
         if (.not. block%last_step(l) > 0.0_dp) then
            load = scaled_load(contacts(l), block, l, block%film(l, 0), block%lienard(l, 0))
            block%acceleration(l) = load%load - block%static_load(l) - oscillation(l)
         end if
         if (block%last_step(l) > 0.0_dp .and. block%step(l) < most_extrapolation*block%last_step(l)) then
            ratio = block%step(l)/block%last_step(l)
            do i = 1, stages
               place = 1.0_dp + 2.0_dp*ratio*node(i)
               do j = stages, 1, -1
                  k(l, i) = k(l, i)*place + block%polynomial(l, j)
               end do
            end do
         else
            k(l, :) = block%acceleration(l)
         end if
      end do
   end subroutine first_iterate

   !> Error of the steps, whether they stand, and the next ones; series of film and velocity for the samples.
   pure subroutine judge(occupied, k, film, lienard, block)
      logical, intent(in) :: occupied(lanes)
      real(dp), intent(in) :: k(lanes, stages)
      real(dp), intent(in) :: film(lanes, stages)
      real(dp), intent(in) :: lienard(lanes, stages)
      type(lane_block_t), intent(inout) :: block
      real(dp) :: polynomial(stages), weight, top, next, between, error, growth
      integer :: l

      block%next_film = block%film(:, 0)
      block%next_lienard = block%lienard(:, 0)
      do l = 1, lanes
         if (.not. occupied(l)) cycle
         growth = least_growth
         if (block%trust(l) > 0.0_dp) then
            polynomial = matmul(power, k(l, :))
            call highest_terms(polynomial, top, next)
            weight = lienard_weight(thinner(block%film(l, 0), l, block), block%damping_rate(l), block%force(l))
            error = max(top/last_share, next/next_share)*block%step(l) &
               *max(block%step(l)/real(4*stages**2, dp), weight/real(2*stages, dp))
            between = abs(at_start(polynomial) - block%acceleration(l))*twice_between*block%step(l)**2
            error = max(error, between) &
               /min(allowed(block%film(l, 0), l, block), allowed(minval(film(l, :)), l, block), &
                    allowed(maxval(film(l, :)), l, block))
            growth = growth_of(error)
            if (.not. error <= 1.0_dp .or. &
                min(minval(film(l, :)), block%backlash(l) - maxval(film(l, :))) <= 0.0_dp) block%trust(l) = 0.0_dp
         end if
         block%proposed(l) = growth*block%step(l)
         if (block%trust(l) > 0.0_dp) then
            block%next_film(l) = film(l, stages)
            block%next_lienard(l) = lienard(l, stages)
            block%polynomial(l, :) = polynomial
            block%acceleration(l) = k(l, stages)
            block%last_step(l) = block%step(l)
            call series_of_step(l, block)
         end if
      end do
   end subroutine judge

   !> Next step over this one, by an error in units of that allowed.
   pure real(dp) function growth_of(error)
      real(dp), intent(in) :: error

      growth_of = max(least_growth, min(most_growth, 0.9_dp/sqrt(sqrt(sqrt(max(error, tiny(1.0_dp)))))))
   end function growth_of

   !> Value at the start of the step, 2c - 1 = -1.
   pure real(dp) function at_start(polynomial)
      !> Coefficients of the powers of 2c - 1
      real(dp), intent(in) :: polynomial(stages)

      at_start = sum(polynomial(1::2)) - sum(polynomial(2::2))
   end function at_start

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

   !> Film and velocity of the step as power series about its start.
   pure subroutine series_of_step(lane, block)
      integer, intent(in) :: lane
      type(lane_block_t), intent(inout) :: block
      real(dp) :: shifted(0:stages - 1), scale
      integer :: i, j

      ! From powers of 2c - 1 to powers of c: Horner's scheme on polynomials.
      shifted = 0.0_dp
      do i = stages, 1, -1
         do j = stages - 1, 1, -1
            shifted(j) = 2.0_dp*shifted(j - 1) - shifted(j)
         end do
         shifted(0) = block%polynomial(lane, i) - shifted(0)
      end do
      block%film(lane, 1:) = 0.0_dp
      block%lienard(lane, 1:) = 0.0_dp
      block%film(lane, 1) = block%lienard(lane, 0)
      scale = 1.0_dp
      do j = 0, stages - 1
         block%lienard(lane, j + 1) = shifted(j)*scale/real(j + 1, dp)
         block%film(lane, j + 2) = block%lienard(lane, j + 1)/real(j + 2, dp)
         scale = scale/block%step(lane)
      end do
   end subroutine series_of_step

end module collocation_step
