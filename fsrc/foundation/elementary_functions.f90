!> Exponential and circular functions as arithmetic and bit operations alone, for loops over many numbers.
!>
!> A call within such a loop becomes one of a vector library, and the last numbers of a short loop are left to scalar code, which
!> differs in the last digit. Here a number gets the same bits in any place, alone or among any neighbours, and loops run in full
!> registers.
module elementary_functions
   use constants, only: two_pi
   use kinds, only: dp, int64
   implicit none(type, external)
   private

   integer :: i
   !> 2^52 + 2^51: added and subtracted, it rounds to an integer, whose bits stand at the end of the sum.
   real(dp), parameter :: rounder = 6755399441055744.0_dp

   !> Largest argument, and its negative, of `exponential`; beyond it the value at the border is given, of which products with
   !> other numbers do not overflow.
   real(dp), parameter, public :: largest_exponent = 550.0_dp
   !> Fraction of 1/k! that the exponential needs below |x| = ln(2)/2; the rest is under 5e-18.
   integer, parameter :: exponential_terms = 13
   real(dp), parameter :: inverse_factorial(0:exponential_terms) = &
      [(1.0_dp/gamma(real(i + 1, dp)), i=0, exponential_terms)]

   public :: cosine_sine, exponential, exponentials, logarithm, logarithms

contains

   !> Cosine and sine of 2 pi times a phase. Quadrant by rounding, then the polynomials of Sun's fdlibm on
   !> |angle| <= pi/4; errors stay below 2 ulp of 1.
   elemental subroutine cosine_sine(phase, cosine, sine)
      !> Phase from 0 to 1 [periods]
      real(dp), intent(in) :: phase
      !> cos(2 pi phase) [-]
      real(dp), intent(out) :: cosine
      !> sin(2 pi phase) [-]
      real(dp), intent(out) :: sine
      real(dp) :: quadrant, angle, z, near_sine, near_cosine, even

      quadrant = (4.0_dp*phase + rounder) - rounder
      angle = two_pi*(phase - 0.25_dp*quadrant)
      z = angle*angle
      near_sine = angle + angle*z*(-1.6666666666666632e-01_dp + z*(8.3333333333224895e-03_dp &
         + z*(-1.9841269829857949e-04_dp + z*(2.7557313707070068e-06_dp &
         + z*(-2.5050760253406863e-08_dp + z*1.589690995211550e-10_dp)))))
      near_cosine = 1.0_dp - 0.5_dp*z + z*z*(4.1666666666666602e-02_dp + z*(-1.3888888888874110e-03_dp &
         + z*(2.4801587289476729e-05_dp + z*(-2.7557314351390663e-07_dp &
         + z*(2.0875723212981748e-09_dp - z*1.1359647557788195e-11_dp)))))
      even = abs(abs(quadrant - 2.0_dp) - 1.0_dp)
      cosine = merge(near_cosine, near_sine, even > 0.5_dp)
      sine = merge(near_sine, near_cosine, even > 0.5_dp)
      cosine = merge(-cosine, cosine, abs(quadrant - 1.5_dp) < 1.0_dp)
      sine = merge(-sine, sine, abs(quadrant - 2.5_dp) < 1.0_dp)
   end subroutine cosine_sine

   !> Exponential function, relative error below 2 epsilon for |x| <= largest_exponent.
   elemental real(dp) function exponential(x)
      !> Argument [-]
      real(dp), intent(in) :: x
      !> 1/ln 2, and ln 2 in two parts, the first with zeros enough to make its product exact
      real(dp), parameter :: octaves_per_unit = 1.4426950408889634_dp
      real(dp), parameter :: ln_2_high = 6.931471803691238e-01_dp, ln_2_low = 1.9082149292705877e-10_dp
      real(dp) :: held, sum, rest, mantissa
      integer :: k

      held = max(-largest_exponent, min(largest_exponent, x))
      sum = held*octaves_per_unit + rounder
      rest = (held - (sum - rounder)*ln_2_high) - (sum - rounder)*ln_2_low
      mantissa = inverse_factorial(exponential_terms)
      do k = exponential_terms - 1, 0, -1
         mantissa = mantissa*rest + inverse_factorial(k)
      end do
      exponential = with_octaves(mantissa, sum)
   end function exponential

   !> Natural logarithm of a normal number, error below 1 epsilon of 1 or of itself. Octaves apart, the rest lies between
   !> sqrt(1/2) and sqrt(2), and with s = (m - 1)/(m + 1) its logarithm is 2 (s + s^3/3 + s^5/5 + ...).
   elemental real(dp) function logarithm(x)
      !> Positive [-]
      real(dp), intent(in) :: x
      !> 2^52: a number below it, put in place of its mantissa, is that integer
      real(dp), parameter :: integer_base = 4503599627370496.0_dp
      !> Bits of sqrt(1/2), of the mantissa
      integer(int64), parameter :: least = int(z'3FE6A09E667F3BCD', int64), mantissa_bits = int(z'000FFFFFFFFFFFFF', int64)
      !> Of s^(2k+1)
      integer, parameter :: terms = 10
      real(dp), parameter :: odd(0:terms) = [(2.0_dp/real(2*i + 1, dp), i=0, terms)]
      real(dp), parameter :: ln_2_high = 6.931471803691238e-01_dp, ln_2_low = 1.9082149292705877e-10_dp
      !> Added to make octaves positive
      integer(int64), parameter :: lift = 1023_int64
      integer(int64) :: bits, exponent
      real(dp) :: rest, octaves, s, square, sum
      integer :: k

      bits = transfer(x, bits)
      bits = bits - least
      exponent = shiftr(bits + shiftl(lift, 52), 52)
      bits = iand(bits, mantissa_bits) + least
      rest = transfer(bits, rest)
      exponent = ior(exponent, transfer(integer_base, exponent))
      octaves = transfer(exponent, octaves)
      octaves = (octaves - integer_base) - real(lift, dp)
      s = (rest - 1.0_dp)/(rest + 1.0_dp)
      square = s*s
      sum = odd(terms)
      do k = terms - 1, 1, -1
         sum = sum*square + odd(k)
      end do
      logarithm = octaves*ln_2_high + (odd(0)*s + (s*square*sum + octaves*ln_2_low))
   end function logarithm

   !> Exponential functions of many numbers. A loop that calls one function is compiled for full registers; one that calls several
   !> is not.
   pure subroutine exponentials(n, x, y)
      !> How many
      integer, intent(in) :: n
      !> Arguments [-]
      real(dp), intent(in) :: x(n)
      !> exp(x) [-]
      real(dp), intent(out) :: y(n)
      integer :: k

      !$omp simd
      do k = 1, n
         y(k) = exponential(x(k))
      end do
   end subroutine exponentials

   !> Natural logarithms of many numbers.
   pure subroutine logarithms(n, x, y)
      !> How many
      integer, intent(in) :: n
      !> Positive [-]
      real(dp), intent(in) :: x(n)
      !> ln(x) [-]
      real(dp), intent(out) :: y(n)
      integer :: k

      !$omp simd
      do k = 1, n
         y(k) = logarithm(x(k))
      end do
   end subroutine logarithms

   !> A number times two to the power of the integer that `rounder` has left at the end of a sum: it goes to the exponent.
   elemental real(dp) function with_octaves(number, sum)
      !> The number [-]
      real(dp), intent(in) :: number
      !> The sum [-]
      real(dp), intent(in) :: sum
      integer(int64) :: octaves, bits

      ! One transfer a statement: else no vectors.
      octaves = transfer(sum, octaves)
      bits = transfer(number, bits)
      bits = bits + shiftl(octaves, 52)
      with_octaves = transfer(bits, with_octaves)
   end function with_octaves

end module elementary_functions
