!> Longer steps of a Taylor series whose motion has a part that comes to rest much faster than the rest of it moves
!> (fsrc/THEORY.md, section 5).
!>
!> A series of order 14 follows a part that decays at a rate lambda over 6.5/lambda at most: beyond, its last terms grow, however
!> small that part is. With weights for the terms above order p their sum stays bounded over S/lambda, and exact to order p. The
!> weights make the longest S. Those of the error make it begin with the first term that is not exact, and count what decays as
!> little as they can. scripts/generate/stabilized_weights.py finds both.
module stabilized_series
   use kinds, only: dp
   use lane_functions, only: coarse_log, coarse_power, lanes
   use taylor_step_control, only: free_rate, longest_step, order, rounding
   implicit none(type, external)
   private

   !> Sums there are, and the highest order to which each is exact
   integer, parameter, public :: sums = 2, exact(sums) = [5, 8]
   !> First order whose weights differ from one
   integer, parameter, public :: first_weighted = 6
   !> S of each
   real(dp), parameter, public :: span(sums) = [48.6099_dp, 24.9683_dp]
   !> Weights of the terms in each sum
   real(dp), parameter, public :: weight(first_weighted:order, sums) = reshape([ &
      8.678179297445e-01_dp, 5.936578442176e-01_dp, 3.110901776804e-01_dp, 1.239504444671e-01_dp, 3.715553177186e-02_dp, &
      8.172711803581e-03_dp, 1.252895021878e-03_dp, 1.202487359232e-04_dp, 5.465128618032e-06_dp, &
      1.0_dp, 1.0_dp, 1.0_dp, 9.250700663428e-01_dp, 7.003238347148e-01_dp, &
      3.933944177160e-01_dp, 1.511396564351e-01_dp, 3.538531136298e-02_dp, 3.819376266228e-03_dp], &
      [order - first_weighted + 1, sums])
   !> Weights of the terms in its error
   real(dp), parameter, public :: error_weight(first_weighted:order, sums) = reshape([ &
      1.321820702555e-01_dp, 2.465734977190e-01_dp, 2.231907303098e-01_dp, 1.264949654209e-01_dp, 4.863553457883e-02_dp, &
      1.289239130355e-02_dp, 2.286767910718e-03_dp, 2.468623026209e-04_dp, 1.236350266462e-05_dp, &
      0.0_dp, 0.0_dp, 0.0_dp, 7.492993365718e-02_dp, 1.880968487640e-01_dp, &
      2.054932008965e-01_dp, 1.212429214942e-01_dp, 3.839884608162e-02_dp, 5.195548294632e-03_dp], &
      [order - first_weighted + 1, sums])

   !> Share of S that steps use: the rate grows on the way, and powers of what decays do so faster.
   real(dp), parameter :: margin = 0.75_dp
   !> Steps shorter than this over the rate are not bounded by it.
   real(dp), parameter :: least_reach = 5.0_dp
   !> Of n c_n/c_(n-1) over the rate, where what decays makes up the last terms: 1, and 2 of its square
   real(dp), parameter :: least_ratio = 0.5_dp, largest_ratio = 3.0_dp

   public :: lengthen_steps, weights_of_lanes

contains

   !> Lengthen the steps that what decays bounds, where a sum with weights allows it.
   pure subroutine lengthen_steps(share, granted, rate, limit, one, other, lienard, step, chosen, any_chosen)
      !> Share of the accuracy that a step may use up, over its length [1/periods]
      real(dp), intent(in) :: share
      !> Error of the films that counts as the accuracy [-]
      real(dp), intent(in) :: granted(lanes)
      !> Fastest rate at which a part decays [1/periods]
      real(dp), intent(in) :: rate(lanes)
      !> Longest step allowed after a step that failed [periods]
      real(dp), intent(in) :: limit(lanes)
      !> Series of both films; twice the same where there is one [-]
      real(dp), intent(in) :: one(lanes, 0:order)
      real(dp), intent(in) :: other(lanes, 0:order)
      !> Series of V [-]
      real(dp), intent(in) :: lienard(lanes, 0:order)
      !> Step of the plain sum, then the longer one [periods]
      real(dp), intent(inout) :: step(lanes)
      !> Number of the sum that the step takes; 0: the plain one
      real(dp), intent(out) :: chosen(lanes)
      !> Whether any lane takes another one
      logical, intent(out) :: any_chosen
      real(dp) :: bounded(lanes), inverse_rate(lanes), level(lanes), count, x, of_one, of_other, of_lienard
      integer :: s, k, l

      count = 0.0_dp
      !$omp simd reduction(+: count)
      do l = 1, lanes
         chosen(l) = 0.0_dp
         bounded(l) = merge(1.0_dp, 0.0_dp, rate(l)*step(l) > least_reach) &
            *max(decays(one(l, order - 1), one(l, order), rate(l)), decays(other(l, order - 1), other(l, order), rate(l)))
         count = count + bounded(l)
      end do
      any_chosen = .false.
      if (.not. count > 0.0_dp) return
      !$omp simd
      do l = 1, lanes
         inverse_rate(l) = 1.0_dp/max(rate(l), 1.0_dp)
         level(l) = coarse_log(share*max(granted(l), rounding*one(l, 0)))
      end do
      !GCC$ unroll 2
      do s = 1, sums
         !$omp simd private(x, of_one, of_other, of_lienard, k)
         do l = 1, lanes
            x = min(margin*span(s)*inverse_rate(l), longest_step, limit(l))
            of_one = error_weight(order, s)*one(l, order)
            of_other = error_weight(order, s)*other(l, order)
            of_lienard = error_weight(order, s)*lienard(l, order)
            do k = order - 1, first_weighted, -1
               of_one = of_one*x + error_weight(k, s)*one(l, k)
               of_other = of_other*x + error_weight(k, s)*other(l, k)
               of_lienard = of_lienard*x + error_weight(k, s)*lienard(l, k)
            end do
            ! The error over the step, which may use up the accuracy in proportion to its length
            of_one = max(abs(of_one), abs(of_other), abs(of_lienard)*(1.0_dp/free_rate))*(x*x*x*x*x)
            x = bounded(l)*x*coarse_power(min((level(l) - coarse_log(of_one))*(1.0_dp/real(exact(s), dp)), 0.0_dp))
            chosen(l) = merge(real(s, dp), chosen(l), x > step(l))
            step(l) = max(x, step(l))
         end do
      end do
      count = 0.0_dp
      !$omp simd reduction(+: count)
      do l = 1, lanes
         count = count + chosen(l)
      end do
      any_chosen = count > 0.0_dp
   end subroutine lengthen_steps

   !> Weights of the terms in the sums that lanes have chosen: lane, order.
   pure function weights_of_lanes(chosen) result(weights)
      !> As of lengthen_steps
      real(dp), intent(in) :: chosen(lanes)
      real(dp) :: weights(lanes, first_weighted:order)
      integer :: k, l

      do k = first_weighted, order
         !$omp simd
         do l = 1, lanes
            weights(l, k) = merge(merge(1.0_dp, weight(k, 1), chosen(l) < 0.5_dp), weight(k, 2), chosen(l) < 1.5_dp)
         end do
      end do
   end function weights_of_lanes

   !> 1 where the last two terms of a series are those of what decays at a rate, else 0.
   elemental real(dp) function decays(next_to_last, last, rate)
      real(dp), intent(in) :: next_to_last
      real(dp), intent(in) :: last
      !> [1/periods]
      real(dp), intent(in) :: rate
      real(dp) :: ratio

      ratio = -real(order, dp)*last*sign(1.0_dp, next_to_last)
      decays = merge(1.0_dp, 0.0_dp, ratio > least_ratio*rate*abs(next_to_last)) &
               *merge(1.0_dp, 0.0_dp, ratio < largest_ratio*rate*abs(next_to_last))
   end function decays

end module stabilized_series
