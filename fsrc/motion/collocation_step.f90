!> Implicit steps by collocation, for a block of lanes: any film law, any stiffness (fsrc/THEORY.md, section 6).
!>
!> A film law resists approach and motion, which keeps the matrix of Newton's method regular, and its pivots need no search.
!> First iterate: the polynomial of the step before, carried on. The measure of the error is that of the Taylor series
!> (taylor_step_control), with the least damping rate of the step and the least film that counts as one at its nodes.
module collocation_step
   use collocation_basis, only: can_extrapolate, carry_on, choose_steps, error_of_acceleration, forces_of_stages, growth_of, &
      series_of_motion
  use collocation_newton, only: allowed, correct, newton_iteration_t, residual_and_matrix, scaled_load, solve_lanes, stage_states, &
      thinner
   use film_state, only: load_t
   use flank_contact, only: flank_contact_t
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_force, only: force_values
   use lane_functions, only: lanes
   use radau_nodes, only: power, rows, stages
   use taylor_step_control, only: lienard_weight
   implicit none(type, external)
   private

   !> Newton's iterations before the step is given up
   integer, parameter :: most_iterations = 10
   !> Largest of the integrals of the integral of w, of the header.
   real(dp), parameter :: twice_between = 1.2320e-3_dp
   !> Step over the one before, at most, and its share of what the error allows
   real(dp), parameter :: most_growth = 4.0_dp, step_share = 0.9_dp

   public :: take_collocation_step

contains

   !> Try one step in every lane that has a scene.
   pure subroutine take_collocation_step(contacts, occupied, block)
      !> Contacts of the lanes
      type(flank_contact_t), intent(in) :: contacts(lanes)
      !> Lanes with a scene
      logical, intent(in) :: occupied(lanes)
      !> The block; leaves the film and velocity that the step leads to, whether they are accepted, and series for the samples
      type(lane_block_t), intent(inout) :: block
      real(dp) :: force(lanes, stages), k(lanes, stages), film(lanes, stages), lienard(lanes, stages)
      real(dp) :: residual(lanes, stages), matrix(lanes, stages, stages), largest(lanes)
      type(newton_iteration_t) :: last
      logical :: busy(lanes)
      integer :: iteration

      call choose_steps(block)
      call forces_of_stages(block, force)
      call first_iterate(contacts, occupied, block, k)
      busy = occupied
      block%accepted = merge(1.0_dp, 0.0_dp, occupied)
      do iteration = 1, most_iterations
         call stage_states(busy, block, k, film, lienard)
         call residual_and_matrix(contacts, force, k, film, lienard, block, busy, residual, matrix)
         largest = maxval(abs(residual), dim=2)
         call solve_lanes(busy, matrix, residual)
         call correct(contacts, busy, iteration, largest, residual, last, block, k)
         if (.not. any(busy)) exit
      end do
      where (busy) block%accepted = 0.0_dp
      call stage_states(occupied, block, k, film, lienard)
      call judge(occupied, k, film, lienard, block)
   end subroutine take_collocation_step

   !> The polynomial of the step before at the new nodes, or its last value where it would be carried too far.
   pure subroutine first_iterate(contacts, occupied, block, k)
      type(flank_contact_t), intent(in) :: contacts(lanes)
      logical, intent(in) :: occupied(lanes)
      !> The acceleration at the start of a first step is set
      type(lane_block_t), intent(inout) :: block
      !> Accelerations at the nodes [-]
      real(dp), intent(out) :: k(lanes, stages)
      type(load_t) :: load
      real(dp) :: carried(rows), oscillation(lanes)
      integer :: l

      k = 0.0_dp
      oscillation = force_values(block%oscillation, block%oscillation%phase)
      do l = 1, lanes
         if (.not. occupied(l)) cycle
         if (.not. block%last_step(l) > 0.0_dp) then
            load = scaled_load(contacts(l), block, l, block%film(l, 0), block%lienard(l, 0))
            block%acceleration(l) = load%load - block%static_load(l) - oscillation(l)
         end if
         if (can_extrapolate(l, block)) then
            call carry_on(block%polynomial(l, :), block%step(l)/block%last_step(l), carried)
            k(l, :) = carried(:stages)
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
      real(dp) :: polynomial(stages), weight, between, error, growth
      integer :: l

      block%next_film = block%film(:, 0)
      block%next_lienard = block%lienard(:, 0)
      do l = 1, lanes
         if (.not. occupied(l)) cycle
         growth = growth_of(huge(1.0_dp), most_growth, step_share)
         if (block%accepted(l) > 0.0_dp) then
            polynomial = matmul(power, k(l, :))
            weight = lienard_weight(thinner(block%film(l, 0), l, block), block%damping_rate(l), block%force(l))
            error = error_of_acceleration(polynomial, block%step(l), weight)
            between = abs(at_start(polynomial) - block%acceleration(l))*twice_between*block%step(l)**2
            error = max(error, between)/min(allowed(block%film(l, 0), l, block), allowed(minval(film(l, :)), l, block), &
                    allowed(maxval(film(l, :)), l, block))
            growth = growth_of(error, most_growth, step_share)
            if (.not. error <= 1.0_dp .or. &
                min(minval(film(l, :)), block%backlash(l) - maxval(film(l, :))) <= 0.0_dp) block%accepted(l) = 0.0_dp
         end if
         block%proposed(l) = growth*block%step(l)
         if (block%accepted(l) > 0.0_dp) then
            block%next_film(l) = film(l, stages)
            block%next_lienard(l) = lienard(l, stages)
            block%polynomial(l, :) = polynomial
            block%acceleration(l) = k(l, stages)
            block%last_step(l) = block%step(l)
            call series_of_motion(l, block)
         end if
      end do
   end subroutine judge

   !> Value at the start of the step, 2c - 1 = -1.
   pure real(dp) function at_start(polynomial)
      !> Coefficients of the powers of 2c - 1
      real(dp), intent(in) :: polynomial(stages)

      at_start = sum(polynomial(1::2)) - sum(polynomial(2::2))
   end function at_start

end module collocation_step
