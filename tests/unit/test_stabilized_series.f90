!> Tests of sums of Taylor series with weights: bounded where a motion decays, exact to their order, taken where they are of use.
module test_stabilized_series
   use checks, only: check_list_t
   use kinds, only: dp
   use lane_functions, only: lanes
   use stabilized_series, only: error_weight, exact, first_weighted, lengthen_steps, span, sums, weight, weights_of_lanes
   use taylor_step_control, only: order
   implicit none(type, external)
   private

   public :: run_stabilized_series_tests

contains

   !> Run all tests of this module.
   subroutine run_stabilized_series_tests(checks)
      !> Outcome so far
      type(check_list_t), intent(inout) :: checks

      call checks%start('stabilized series')
      call test_bounds(checks)
      call test_steps(checks)
   end subroutine run_stabilized_series_tests

   !> Sum of w_k x**k/k!.
   pure real(dp) function weighted(weights, x)
      real(dp), intent(in) :: weights(0:order)
      real(dp), intent(in) :: x
      real(dp) :: term
      integer :: k

      term = 1.0_dp
      weighted = weights(0)
      do k = 1, order
         term = term*x/real(k, dp)
         weighted = weighted + weights(k)*term
      end do
   end function weighted

   !> What decays stays bounded within the span; small arguments find the order.
   subroutine test_bounds(checks)
      type(check_list_t), intent(inout) :: checks
      integer, parameter :: places = 20000
      real(dp) :: weights(0:order), errors(0:order), x, beyond, largest, difference
      integer :: s, i

      do s = 1, sums
         weights = 1.0_dp
         weights(first_weighted:) = weight(:, s)
         errors = 0.0_dp
         errors(first_weighted:) = error_weight(:, s)
         beyond = 0.0_dp
         largest = 0.0_dp
         do i = 1, places
            x = -span(s)*real(i, dp)/real(places, dp)
            beyond = max(beyond, abs(weighted(weights, x))/max(0.8_dp, 1.0_dp + 0.8_dp*x))
            largest = max(largest, abs(weighted(errors, x)))
         end do
         ! The weights were found at places of their own, and are printed with twelve digits.
         call checks%check(beyond < 1.001_dp, 'sum bounded within its span')
         call checks%check(largest < 8.0_dp, 'error of what decays bounded within the span')
         call checks%check(abs(weighted(weights, -1.1_dp*span(s))) > 1.0_dp, 'and no longer beyond it')
         ! Both begin with the first term that is not exact, the next one adds up to 0.02.
         difference = (weighted(weights, 0.3_dp) - exp(0.3_dp))/(0.3_dp**(exact(s) + 1)/gamma(real(exact(s) + 2, dp)))
         call checks%check_close(difference, weights(exact(s) + 1) - 1.0_dp, 3.0e-2_dp, 'order of the sum')
         call checks%check_close(errors(exact(s) + 1), 1.0_dp - weights(exact(s) + 1), 1.0e-11_dp, 'first term of the error')
         call checks%check(all(abs(weights(:exact(s)) - 1.0_dp) <= 0.0_dp), 'exact terms')
      end do
   end subroutine test_bounds

   !> A slow motion with a small part that decays 400 times a period takes longer steps, without that part it takes its own.
   subroutine test_steps(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: decay = 400.0_dp, small = 1.0e-9_dp, plain = 6.0_dp/decay
      real(dp) :: slow(lanes, 0:order), mixed(lanes, 0:order), step(lanes), chosen(lanes), weights(lanes, first_weighted:order)
      real(dp) :: granted(lanes), rate(lanes), limit(lanes), total
      logical :: any_chosen
      integer :: k, s

      do k = 0, order
         slow(:, k) = (-1.0_dp)**k/gamma(real(k + 1, dp))
         mixed(:, k) = slow(:, k)*(1.0_dp + small*decay**k)
      end do
      granted = 1.0e-6_dp
      rate = decay
      limit = 1.0_dp
      step = plain
      call lengthen_steps(4.0_dp, granted, rate, limit, mixed, mixed, slow, step, chosen, any_chosen)
      call checks%check(any_chosen .and. all(step > 5.0_dp*plain), 'longer steps')
      s = nint(chosen(1))
      weights = weights_of_lanes(chosen)
      call checks%check(all(abs(weights(1, :) - weight(:, s)) <= 0.0_dp), 'weights of the sum that is chosen')
      total = 0.0_dp
      do k = order, 0, -1
         total = total*step(1) + mixed(1, k)*merge(weights(1, max(k, first_weighted)), 1.0_dp, k >= first_weighted)
      end do
      call checks%check_close(total, exp(-step(1)), 4.0e-6_dp*step(1), 'sum over a longer step')
      step = plain
      call lengthen_steps(4.0_dp, granted, rate, limit, slow, slow, slow, step, chosen, any_chosen)
      call checks%check(.not. any_chosen .and. all(abs(step - plain) <= 0.0_dp), 'steps that nothing bounds')
   end subroutine test_steps

end module test_stabilized_series
