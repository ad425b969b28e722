!> Step size of the Taylor series and its evaluation, for a block of lanes (fsrc/THEORY.md, section 5).
!>
!> Of the weight of a thick film: without the square of H a tooth thrown to 8 h_s has errors 1000 times the accuracy; with it
!> the error stays close to the accuracy whatever the force.
module taylor_step_control
   use kinds, only: dp
   use lane_functions, only: coarse_log, coarse_power, lanes
   implicit none(type, external)
   private

   !> Highest order n of the series. For the published films it is the cheapest for accuracies from 1e-5 to
   !> 1e-11, at most a tenth slower than the best order.
   integer, parameter, public :: order = 14

   integer :: i
   !> 1/k
   real(dp), parameter, public :: inverse(order) = [(1.0_dp/real(i, dp), i=1, order)]

   !> Error that is rounding alone.
   real(dp), parameter, public :: rounding = 2.0_dp*epsilon(1.0_dp)
   !> Longest step [periods]
   real(dp), parameter, public :: longest_step = 0.25_dp
   !> g of the header, one over the time a Lienard variable acts where nothing damps [1/periods]
   real(dp), parameter, public :: free_rate = 2.0_dp

   !> Damping rate where there is no expansion: no step follows it [1/periods]
   real(dp), parameter, public :: unfollowable_rate = 1.0e30_dp

   !> Relative error of the load that counts like one of the film
   real(dp), parameter, public :: load_error = 100.0_dp

   !> Signs of the velocity of the gear towards drive and coast flank, and of their loads on it
   real(dp), parameter, public :: sign_of(2) = [1.0_dp, -1.0_dp]

   public :: lane_steps, cut_steps, evaluate_series, evaluate_slope, film_weight, lienard_weight

contains

   !> Longest step of every lane.
   pure subroutine lane_steps(last_order, share, accuracy, force, thinner, film, lienard, damping_rate, limit, step)
      !> Order n of the series
      integer, intent(in) :: last_order
      !> Share of the accuracy that a step may use up, over its length [1/periods]
      real(dp), intent(in) :: share
      !> Relative accuracy of the film [-]
      real(dp), intent(in) :: accuracy(lanes)
      !> P of the header [-]
      real(dp), intent(in) :: force(lanes)
      !> The thinner one of the films of both flanks [-]
      real(dp), intent(in) :: thinner(lanes)
      !> Series of H [-], order last
      real(dp), intent(in) :: film(lanes, 0:order)
      !> Series of V [-], order last
      real(dp), intent(in) :: lienard(lanes, 0:order)
      !> d of the header [1/periods]
      real(dp), intent(in) :: damping_rate(lanes)
      !> Longest step allowed after a step that failed [periods]
      real(dp), intent(in) :: limit(lanes)
      !> [periods]
      real(dp), intent(out) :: step(lanes)
      real(dp) :: weight, level, last, next_to_last, reach, root, next_root
      integer :: l

      root = 1.0_dp/real(last_order - 1, dp)
      next_root = 1.0_dp/real(last_order - 2, dp)
      !$omp simd private(weight, level, last, next_to_last, reach)
      do l = 1, lanes
         weight = lienard_weight(thinner(l), damping_rate(l), force(l))
         level = coarse_log(share*max(accuracy(l)*film_weight(thinner(l)), rounding*film(l, 0)))
         last = coarse_log(max(abs(film(l, last_order)), abs(lienard(l, last_order))*weight))
         next_to_last = coarse_log(max(abs(film(l, last_order - 1)), abs(lienard(l, last_order - 1))*weight))
         reach = min((level - last)*root, (level - next_to_last)*next_root, 0.0_dp)
         step(l) = min(coarse_power(reach), longest_step, limit(l))
      end do
   end subroutine lane_steps

   !> Cut the last steps of a period so that its end is hit, two of equal length rather than a long and a short one.
   pure subroutine cut_steps(remaining, step)
      !> What is left of the period [periods]
      real(dp), intent(in) :: remaining(lanes)
      !> Longest step, then the step, equal to `remaining` where the period ends with it [periods]
      real(dp), intent(inout) :: step(lanes)
      real(dp) :: ends
      integer :: l

      !$omp simd private(ends)
      do l = 1, lanes
         ! 1 where the step ends the period, else 0, by its sign: a comparison would be compiled as a branch, and the loop
         ! would not run in full registers.
         ends = 0.5_dp + sign(0.5_dp, step(l) - remaining(l))
         step(l) = ends*remaining(l) + (1.0_dp - ends)*min(step(l), 0.5_dp*remaining(l))
      end do
   end subroutine cut_steps

   !> H/(1 + H**2): the film error that counts as one [h_s].
   elemental real(dp) function film_weight(film)
      !> H [-]
      real(dp), intent(in) :: film

      film_weight = film/(1.0_dp + film*film)
   end function film_weight

   !> Film error that an error of one in the Lienard variable counts as [h_s].
   elemental real(dp) function lienard_weight(film, damping_rate, force)
      !> H [-]
      real(dp), intent(in) :: film
      !> d of the header [1/periods]
      real(dp), intent(in) :: damping_rate
      !> P of the header [-]
      real(dp), intent(in) :: force

      lienard_weight = max(1.0_dp/(free_rate + damping_rate), damping_rate*film_weight(film)/(load_error*force))
   end function lienard_weight

   !> Sum of two series, whose coefficients are zero where there are none. Even and odd powers go apart: four short chains instead of
   !> two long ones.
   pure subroutine evaluate_series(film, lienard, x, film_sum, lienard_sum)
      !> Series of H [-], order last
      real(dp), intent(in) :: film(lanes, 0:order)
      !> Series of V [-], order last
      real(dp), intent(in) :: lienard(lanes, 0:order)
      !> Distance from the point of expansion [periods]
      real(dp), intent(in) :: x(lanes)
      !> H there [-]
      real(dp), intent(out) :: film_sum(lanes)
      !> V there [-]
      real(dp), intent(out) :: lienard_sum(lanes)
      real(dp) :: square, film_odd, film_even, lienard_odd, lienard_even
      integer :: l, k

      !$omp simd private(square, film_odd, film_even, lienard_odd, lienard_even, k)
      do l = 1, lanes
         square = x(l)*x(l)
         film_even = film(l, order)
         lienard_even = lienard(l, order)
         film_odd = film(l, order - 1)
         lienard_odd = lienard(l, order - 1)
         do k = order - 2, 2, -2
            film_even = film_even*square + film(l, k)
            lienard_even = lienard_even*square + lienard(l, k)
            film_odd = film_odd*square + film(l, k - 1)
            lienard_odd = lienard_odd*square + lienard(l, k - 1)
         end do
         film_sum(l) = film(l, 0) + (film_even*square + film_odd*x(l))
         lienard_sum(l) = lienard(l, 0) + (lienard_even*square + lienard_odd*x(l))
      end do
   end subroutine evaluate_series

   !> Slope of a series, in the same way.
   pure subroutine evaluate_slope(series, x, slope)
      !> Order last
      real(dp), intent(in) :: series(lanes, 0:order)
      !> Distance from the point of expansion [periods]
      real(dp), intent(in) :: x(lanes)
      !> Derivative of the sum there [1/periods]
      real(dp), intent(out) :: slope(lanes)
      real(dp) :: square, odd, even
      integer :: l, k

      !$omp simd private(square, odd, even, k)
      do l = 1, lanes
         square = x(l)*x(l)
         odd = real(order, dp)*series(l, order)
         even = real(order - 1, dp)*series(l, order - 1)
         do k = order - 2, 2, -2
            odd = odd*square + real(k, dp)*series(l, k)
            even = even*square + real(k - 1, dp)*series(l, k - 1)
         end do
         slope(l) = even + odd*x(l)
      end do
   end subroutine evaluate_slope

end module taylor_step_control
