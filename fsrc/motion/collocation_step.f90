!> Implicit steps by collocation, for a block of lanes: any film law, any stiffness.
!>
!> Within a step of length s from x the acceleration K = H'' is a polynomial in c = 0..1 that satisfies the
!> equation of motion at the seven nodes of Radau. With its values K_i as unknowns,
!>
!>     V_i = V + s sum(once_ij K_j) ,   H_i = H + c_i s V + s**2 sum(twice_ij K_j) ,   K_i = W(H_i, V_i) - F(x + c_i s)
!>
!> are seven equations, solved by Newton's method with the slopes of the film law,
!>
!>     (1 - s**2 W_H twice - s W_V once) dK = W - F - K .
!>
!> A film law resists approach and motion, W_H <= 0 and W_V <= 0, which keeps the matrix regular, and its pivots
!> need no search. First iterate: the polynomial of the step before, carried on.
!>
!> The error is taken from the highest coefficient k of the polynomial: it moves the film by about s**2 k/(4*49) and
!> the momentum by s k/14. The measure of these is that of the Taylor series (taylor_step_control), with the least
!> damping rate of the step.
module collocation_step
   use constants, only: two_pi
   use film_law, only: film_load, film_t, overflow_load
   use kinds, only: dp
   use lane_functions, only: lane_cosine_sine, lanes
   use lane_scenes, only: lane_block_t
   use radau_nodes, only: node, once, power, stages, twice
   use taylor_step_control, only: film_weight, momentum_weight
   implicit none(type, external)
   private

   !> Newton passes before the step is given up, and share of the accuracy at which they end.
   integer, parameter :: most_passes = 10
   real(dp), parameter :: pass_share = 1.0e-2_dp
   !> Share of the accuracy for a step. The estimate is one of the polynomial's error, and far above that of the
   !> state at the end of the step.
   real(dp), parameter :: safety = 2.0_dp
   !> Error that is rounding alone.
   real(dp), parameter :: rounding = 16.0_dp*epsilon(1.0_dp)
   !> Longest step [periods]
   real(dp), parameter :: longest_step = 0.25_dp
   !> Step over the one before, least and most, and the most for which the polynomial is carried on.
   real(dp), parameter :: least_growth = 0.1_dp, most_growth = 4.0_dp, most_extrapolation = 2.0_dp

   public :: take_collocation_step

contains

   !> Try one step in every lane that has a scene.
   pure subroutine take_collocation_step(films, occupied, block)
      !> Film laws
      type(film_t), intent(in) :: films(lanes)
      !> Lanes with a scene
      logical, intent(in) :: occupied(lanes)
      !> The block; leaves the film and momentum that the step leads to, whether they are to be trusted, and series
      !> for the samples
      type(lane_block_t), intent(inout) :: block
      real(dp) :: force(lanes, stages), k(lanes, stages), film(lanes, stages), momentum(lanes, stages)
      real(dp) :: residual(lanes, stages), matrix(lanes, stages, stages), change(lanes), last_change(lanes)
      logical :: busy(lanes)
      integer :: pass

      call choose_steps(block)
      call forces_of_stages(block, force)
      call first_iterate(films, occupied, block, k)
      busy = occupied
      block%trust = merge(1.0_dp, 0.0_dp, occupied)
      last_change = huge(1.0_dp)
      do pass = 1, most_passes
         call stage_states(block, k, film, momentum)
         call residual_and_matrix(films, force, k, film, momentum, block, busy, residual, matrix)
         call solve_lanes(matrix, residual)
         call correct(busy, pass, residual, block, k, change, last_change)
         if (.not. any(busy)) exit
      end do
      where (busy) block%trust = 0.0_dp
      call stage_states(block, k, film, momentum)
      call judge(occupied, k, film, momentum, block)
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

   !> Force at the nodes: static load and cosine.
   pure subroutine forces_of_stages(block, force)
      type(lane_block_t), intent(in) :: block
      !> Scaled force [-]
      real(dp), intent(out) :: force(lanes, stages)
      real(dp) :: phase(lanes), cosine(lanes), sine(lanes)
      integer :: i

      do i = 1, stages
         phase = min(1.0_dp, block%phase + node(i)*block%step)
         call lane_cosine_sine(phase, cosine, sine)
         force(:, i) = block%load + block%amplitude*cosine
      end do
   end subroutine forces_of_stages

   !> The polynomial of the step before at the new nodes, or its last value where it would be carried too far.
   pure subroutine first_iterate(films, occupied, block, k)
      type(film_t), intent(in) :: films(lanes)
      logical, intent(in) :: occupied(lanes)
      type(lane_block_t), intent(in) :: block
      !> Accelerations at the nodes [-]
      real(dp), intent(out) :: k(lanes, stages)
      real(dp) :: ratio, place, load, by_film, by_momentum
      integer :: l, i, j

      k = 0.0_dp
      do l = 1, lanes
         if (.not. occupied(l)) cycle
         if (block%last_step(l) > 0.0_dp .and. block%step(l) < most_extrapolation*block%last_step(l)) then
            ratio = block%step(l)/block%last_step(l)
            do i = 1, stages
               place = 1.0_dp + 2.0_dp*ratio*node(i)
               do j = stages, 1, -1
                  k(l, i) = k(l, i)*place + block%polynomial(l, j)
               end do
            end do
         else
            call scaled_load(films(l), block, l, block%film(l, 0), block%momentum(l, 0), load, by_film, by_momentum)
            k(l, :) = load - block%load(l) - block%amplitude(l)*cos(two_pi*block%phase(l))
         end if
      end do
   end subroutine first_iterate

   !> Film and momentum at the nodes.
   pure subroutine stage_states(block, k, film, momentum)
      type(lane_block_t), intent(in) :: block
      real(dp), intent(in) :: k(lanes, stages)
      !> H and V at the nodes [-]
      real(dp), intent(out) :: film(lanes, stages)
      real(dp), intent(out) :: momentum(lanes, stages)
      real(dp) :: first, second
      integer :: i, j, l

      do i = 1, stages
         !$omp simd private(first, second, j)
         do l = 1, lanes
            first = 0.0_dp
            second = 0.0_dp
            do j = 1, stages
               first = first + once(i, j)*k(l, j)
               second = second + twice(i, j)*k(l, j)
            end do
            momentum(l, i) = block%momentum(l, 0) + block%step(l)*first
            film(l, i) = block%film(l, 0) + block%step(l)*(node(i)*block%momentum(l, 0) + block%step(l)*second)
         end do
      end do
   end subroutine stage_states

   !> Load of the film law and its slopes in scaled units.
   pure subroutine scaled_load(film_law, block, lane, film, momentum, load, by_film, by_momentum)
      type(film_t), intent(in) :: film_law
      type(lane_block_t), intent(in) :: block
      integer, intent(in) :: lane
      !> H [-]
      real(dp), intent(in) :: film
      !> V = H' [-]
      real(dp), intent(in) :: momentum
      !> Load [-], its slope in H, its slope in V
      real(dp), intent(out) :: load
      real(dp), intent(out) :: by_film
      real(dp), intent(out) :: by_momentum

      call film_load(film_law, film*block%film_scale(lane), momentum*block%velocity_scale(lane), load, by_film, &
                     by_momentum)
      if (abs(load) < overflow_load) then
         load = load/block%force_scale(lane)
         by_film = by_film*(block%film_scale(lane)/block%force_scale(lane))
         by_momentum = by_momentum*(block%velocity_scale(lane)/block%force_scale(lane))
      end if
   end subroutine scaled_load

   !> Newton's equations of all busy lanes; a lane whose film law has no value is given up, and gets equations that
   !> change nothing, as do the lanes that are done.
   pure subroutine residual_and_matrix(films, force, k, film, momentum, block, busy, residual, matrix)
      type(film_t), intent(in) :: films(lanes)
      real(dp), intent(in) :: force(lanes, stages)
      real(dp), intent(in) :: k(lanes, stages)
      real(dp), intent(in) :: film(lanes, stages)
      real(dp), intent(in) :: momentum(lanes, stages)
      type(lane_block_t), intent(inout) :: block
      logical, intent(inout) :: busy(lanes)
      !> Right-hand side [-]
      real(dp), intent(out) :: residual(lanes, stages)
      !> Matrix [-]
      real(dp), intent(out) :: matrix(lanes, stages, stages)
      real(dp) :: load, by_film(lanes, stages), by_momentum(lanes, stages)
      integer :: l, i, j

      residual = 0.0_dp
      by_film = 0.0_dp
      by_momentum = 0.0_dp
      do l = 1, lanes
         do i = 1, stages
            if (.not. busy(l)) exit
            if (film(l, i) > 0.0_dp) then
               call scaled_load(films(l), block, l, film(l, i), momentum(l, i), load, by_film(l, i), by_momentum(l, i))
               block%no_load(l) = .not. abs(load) < overflow_load
            end if
            busy(l) = film(l, i) > 0.0_dp .and. .not. block%no_load(l)
            if (busy(l)) residual(l, i) = load - force(l, i) - k(l, i)
         end do
         if (busy(l)) then
            block%damping_rate(l) = max(0.0_dp, -maxval(by_momentum(l, :)))
         else
            residual(l, :) = 0.0_dp
            by_film(l, :) = 0.0_dp
            by_momentum(l, :) = 0.0_dp
         end if
      end do
      do j = 1, stages
         do i = 1, stages
            !$omp simd
            do l = 1, lanes
               matrix(l, i, j) = merge(1.0_dp, 0.0_dp, i == j) &
                  - block%step(l)*(block%step(l)*by_film(l, i)*twice(i, j) + by_momentum(l, i)*once(i, j))
            end do
         end do
      end do
   end subroutine residual_and_matrix

   !> Solve the linear equations of all lanes; the solution replaces the right-hand side.
   pure subroutine solve_lanes(matrix, right)
      real(dp), intent(inout) :: matrix(lanes, stages, stages)
      real(dp), intent(inout) :: right(lanes, stages)
      real(dp) :: factor(lanes)
      integer :: i, j, n, l

      do n = 1, stages
         do l = 1, lanes
            matrix(l, n, n) = 1.0_dp/matrix(l, n, n)
         end do
         do i = n + 1, stages
            factor = matrix(:, i, n)*matrix(:, n, n)
            do j = n + 1, stages
               !$omp simd
               do l = 1, lanes
                  matrix(l, i, j) = matrix(l, i, j) - factor(l)*matrix(l, n, j)
               end do
            end do
            right(:, i) = right(:, i) - factor*right(:, n)
         end do
      end do
      do n = stages, 1, -1
         do j = n + 1, stages
            right(:, n) = right(:, n) - matrix(:, n, j)*right(:, j)
         end do
         right(:, n) = right(:, n)*matrix(:, n, n)
      end do
   end subroutine solve_lanes

   !> Apply Newton's correction; lanes whose correction is small enough are done, those that diverge given up.
   pure subroutine correct(busy, pass, correction, block, k, change, last_change)
      logical, intent(inout) :: busy(lanes)
      !> Number of this pass
      integer, intent(in) :: pass
      real(dp), intent(in) :: correction(lanes, stages)
      type(lane_block_t), intent(inout) :: block
      real(dp), intent(inout) :: k(lanes, stages)
      !> Size of the correction in the film [-], now and in the pass before
      real(dp), intent(inout) :: change(lanes)
      real(dp), intent(inout) :: last_change(lanes)
      integer :: l

      do l = 1, lanes
         if (.not. busy(l)) then
            if (block%trust(l) > 0.0_dp .and. block%no_load(l)) block%trust(l) = 0.0_dp
            cycle
         end if
         k(l, :) = k(l, :) + correction(l, :)
         change(l) = maxval(abs(correction(l, :)))*block%step(l)/allowed(l, block) &
            *min(block%step(l), momentum_weight(block%film(l, 0), block%damping_rate(l), block%force(l)))
         busy(l) = change(l) > pass_share
         if (busy(l) .and. pass > 3 .and. change(l) > 2.0_dp*last_change(l)) then
            busy(l) = .false.
            block%trust(l) = 0.0_dp
         end if
         last_change(l) = change(l)
      end do
   end subroutine correct

   !> Error of the steps, whether they stand, and the next ones; series of film and momentum for the samples.
   pure subroutine judge(occupied, k, film, momentum, block)
      logical, intent(in) :: occupied(lanes)
      real(dp), intent(in) :: k(lanes, stages)
      real(dp), intent(in) :: film(lanes, stages)
      real(dp), intent(in) :: momentum(lanes, stages)
      type(lane_block_t), intent(inout) :: block
      !> Leading coefficient of the Legendre polynomial P_6
      real(dp), parameter :: leading = 14.4375_dp
      real(dp) :: polynomial(stages), top, error, growth
      integer :: l

      block%next_film = block%film(:, 0)
      block%next_momentum = block%momentum(:, 0)
      do l = 1, lanes
         if (.not. occupied(l)) cycle
         growth = least_growth
         if (block%trust(l) > 0.0_dp) then
            polynomial = matmul(power, k(l, :))
            top = abs(polynomial(stages))/leading*block%step(l)
            error = max(top*block%step(l)/real(4*stages**2, dp), &
                        top/real(2*stages, dp)*momentum_weight(block%film(l, 0), block%damping_rate(l), block%force(l))) &
               /(safety*allowed(l, block))
            growth = max(least_growth, min(most_growth, 0.9_dp/sqrt(sqrt(sqrt(max(error, tiny(1.0_dp)))))))
            if (.not. error <= 1.0_dp .or. minval(film(l, :)) <= 0.0_dp) block%trust(l) = 0.0_dp
         end if
         block%proposed(l) = growth*block%step(l)
         if (block%trust(l) > 0.0_dp) then
            block%next_film(l) = film(l, stages)
            block%next_momentum(l) = momentum(l, stages)
            block%polynomial(l, :) = polynomial
            block%last_step(l) = block%step(l)
            call series_of_step(l, block)
         end if
      end do
   end subroutine judge

   !> Error of the film that the accuracy allows [-].
   pure real(dp) function allowed(lane, block)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block

      allowed = max(block%accuracy(lane)*film_weight(block%film(lane, 0)), rounding*block%film(lane, 0))
   end function allowed

   !> Film and momentum of the step as power series about its start.
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
      block%momentum(lane, 1:) = 0.0_dp
      block%film(lane, 1) = block%momentum(lane, 0)
      scale = 1.0_dp
      do j = 0, stages - 1
         block%momentum(lane, j + 1) = shifted(j)*scale/real(j + 1, dp)
         block%film(lane, j + 2) = block%momentum(lane, j + 1)/real(j + 2, dp)
         scale = scale/block%step(lane)
      end do
   end subroutine series_of_step

end module collocation_step
