!> Tests of exponential, logarithm and circular functions: against the intrinsic ones, and the same bits in any place.
module test_elementary_functions
   use checks, only: check_list_t, same_bits
   use constants, only: two_pi
   use elementary_functions, only: cosine_sine, exponential, largest_exponent, logarithm
   use kinds, only: dp
   implicit none(type, external)
   private

   integer :: j
   !> Points from just above -1 to 1; no whole number of registers.
   integer, parameter :: points = 4099
   real(dp), parameter :: spread(points) = [(2.0_dp*real(j, dp)/real(points, dp) - 1.0_dp, j=1, points)]

   public :: run_elementary_functions_tests

contains

   !> Runs every test of this topic.
   subroutine run_elementary_functions_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('elementary_functions')
      call test_exponential(checks)
      call test_logarithm(checks)
      call test_circle(checks)
   end subroutine run_elementary_functions_tests

   !> The exponential up to its borders and beyond.
   subroutine test_exponential(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: x(points), y(points), fewer(2:points), error

      x = largest_exponent*spread
      error = maxval(abs(exponential(x)/exp(x) - 1.0_dp))
      call checks%check_close(error, 0.0_dp, 4.0_dp*epsilon(1.0_dp), 'exponential: whole range')
      error = maxval(abs(exponential(spread)/exp(spread) - 1.0_dp))
      call checks%check_close(error, 0.0_dp, 4.0_dp*epsilon(1.0_dp), 'exponential: near one')
      call checks%check(same_bits(exponential(1.0e6_dp), exponential(largest_exponent)), 'exponential: held above')
      call checks%check(same_bits(exponential(-1.0e6_dp), exponential(-largest_exponent)), 'exponential: held below')
      y = exponential(x)
      fewer = exponential(x(2:))
      call checks%check(all(same_bits(y(2:), fewer)), 'exponential: the same bits in another place')
   end subroutine test_exponential

   !> The logarithm of small and large numbers, and of those near one.
   subroutine test_logarithm(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: x(points), y(points), fewer(2:points), error

      x = exp(largest_exponent*spread)
      error = maxval(abs(logarithm(x) - log(x))/max(1.0_dp, abs(log(x))))
      call checks%check_close(error, 0.0_dp, 2.0_dp*epsilon(1.0_dp), 'logarithm: whole range')
      x = 1.0_dp + 0.5_dp*spread
      error = maxval(abs(logarithm(x) - log(x))/max(tiny(1.0_dp), abs(log(x))))
      call checks%check_close(error, 0.0_dp, 4.0_dp*epsilon(1.0_dp), 'logarithm: near one')
      y = logarithm(x)
      fewer = logarithm(x(2:))
      call checks%check(all(same_bits(y(2:), fewer)), 'logarithm: the same bits in another place')
   end subroutine test_logarithm

   !> Cosine and sine once around, and exact at its quarters.
   subroutine test_circle(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: quarters(5) = [0.0_dp, 0.25_dp, 0.5_dp, 0.75_dp, 1.0_dp]
      real(dp) :: phase(points), cosine(points), sine(points), fewer(2:points), unused(2:points), error

      phase = 0.5_dp*(spread + 1.0_dp)
      call cosine_sine(phase, cosine, sine)
      error = max(maxval(abs(cosine - cos(two_pi*phase))), maxval(abs(sine - sin(two_pi*phase))))
      ! Half of it is the rounding of 2 pi times the phase.
      call checks%check_close(error, 0.0_dp, 6.0_dp*epsilon(1.0_dp), 'circle: once around')
      call cosine_sine(phase(2:), fewer, unused)
      call checks%check(all(same_bits(cosine(2:), fewer)), 'circle: the same bits in another place')
      call cosine_sine(quarters, cosine(:5), sine(:5))
      call checks%check(all(abs(cosine(:5) - [1.0_dp, 0.0_dp, -1.0_dp, 0.0_dp, 1.0_dp]) <= 0.0_dp), 'circle: cosine of quarters')
      call checks%check(all(abs(sine(:5) - [0.0_dp, 1.0_dp, 0.0_dp, -1.0_dp, 0.0_dp]) <= 0.0_dp), 'circle: sine of quarters')
   end subroutine test_circle

end module test_elementary_functions
