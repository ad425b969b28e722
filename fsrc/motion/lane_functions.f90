!> Elementary functions for many scenes at once, one scene a lane.
!>
!> All lanes of a block go through the same vector instructions, written here as arithmetic and bit operations
!> alone: a call of a vector library would treat the last lanes of a shorter block by scalar code, which
!> differs in the last digit. So a scene gets the same bits in any lane, among any neighbours.
module lane_functions
   use constants, only: two_pi
   use kinds, only: dp, int64
   implicit none(type, external)
   private

   !> Scenes in a block. A register holds 8 at most; two registers, interleaved, hide the latency of the
   !> arithmetic.
   integer, parameter, public :: lanes = 16
   !> Those of one register. Rows of tables are brought side by side for so many, and what needs many numbers a lane takes one
   !> half after the other.
   integer, parameter, public :: half_block = lanes/2

   !> 2^52 + 2^51: added and subtracted, it rounds to an integer, whose bits stand at the end of the sum.
   real(dp), parameter :: rounder = 6755399441055744.0_dp
   !> 2^52: a number below it, put in place of its mantissa, is that integer.
   real(dp), parameter :: integer_base = 4503599627370496.0_dp
   !> One doubling of a number in units of `coarse_log`.
   real(dp), parameter, public :: octave = 1048576.0_dp
   !> `coarse_log` of 1.
   real(dp), parameter, public :: log_of_one = 1023.0_dp*octave

   !> Fraction of 1/k! that the exponential needs below |x| = ln(2)/2; the rest is under 5e-18.
   integer :: i
   integer, parameter :: exponential_terms = 13
   real(dp), parameter :: inverse_factorial(0:exponential_terms) = &
      [(1.0_dp/gamma(real(i + 1, dp)), i=0, exponential_terms)]

   !> Largest argument, and its negative, of `lane_exponential`; beyond it the value at the border is given.
   real(dp), parameter, public :: largest_exponent = 300.0_dp

   public :: lane_cosine_sine, lane_exponential, coarse_log, coarse_power, whole_below

contains

   !> Cosine and sine of 2 pi times a phase. Quadrant by rounding, then the polynomials of Sun's fdlibm on
   !> |angle| <= pi/4; errors stay below 2 ulp of 1.
   pure subroutine lane_cosine_sine(phase, cosine, sine)
      !> Phase from 0 to 1 [periods]
      real(dp), intent(in) :: phase(lanes)
      !> cos(2 pi phase) [-]
      real(dp), intent(out) :: cosine(lanes)
      !> sin(2 pi phase) [-]
      real(dp), intent(out) :: sine(lanes)
      real(dp) :: quadrant, angle, z, near_sine, near_cosine, even
      integer :: l

      !$omp simd private(quadrant, angle, z, near_sine, near_cosine, even)
      do l = 1, lanes
         quadrant = (4.0_dp*phase(l) + rounder) - rounder
         angle = two_pi*(phase(l) - 0.25_dp*quadrant)
         z = angle*angle
         near_sine = angle + angle*z*(-1.6666666666666632e-01_dp + z*(8.3333333333224895e-03_dp &
            + z*(-1.9841269829857949e-04_dp + z*(2.7557313707070068e-06_dp &
            + z*(-2.5050760253406863e-08_dp + z*1.589690995211550e-10_dp)))))
         near_cosine = 1.0_dp - 0.5_dp*z + z*z*(4.1666666666666602e-02_dp + z*(-1.3888888888874110e-03_dp &
            + z*(2.4801587289476729e-05_dp + z*(-2.7557314351390663e-07_dp &
            + z*(2.0875723212981748e-09_dp - z*1.1359647557788195e-11_dp)))))
         even = abs(abs(quadrant - 2.0_dp) - 1.0_dp)
         cosine(l) = merge(near_cosine, near_sine, even > 0.5_dp)
         sine(l) = merge(near_sine, near_cosine, even > 0.5_dp)
         cosine(l) = merge(-cosine(l), cosine(l), abs(quadrant - 1.5_dp) < 1.0_dp)
         sine(l) = merge(-sine(l), sine(l), abs(quadrant - 2.5_dp) < 1.0_dp)
      end do
   end subroutine lane_cosine_sine

   !> Exponential function, relative error below 2 epsilon for |x| <= largest_exponent.
   pure subroutine lane_exponential(x, y)
      !> Argument [-]
      real(dp), intent(in) :: x(lanes)
      !> exp(x) [-]
      real(dp), intent(out) :: y(lanes)
      !> 1/ln 2, and ln 2 in two parts, the first with zeros enough to make its product exact
      real(dp), parameter :: octaves_per_unit = 1.4426950408889634_dp
      real(dp), parameter :: ln_2_high = 6.931471803691238e-01_dp, ln_2_low = 1.9082149292705877e-10_dp
      real(dp) :: held, sum, rest
      integer :: l, k

      !$omp simd private(held, sum, rest, k)
      do l = 1, lanes
         held = max(-largest_exponent, min(largest_exponent, x(l)))
         sum = held*octaves_per_unit + rounder
         rest = (held - (sum - rounder)*ln_2_high) - (sum - rounder)*ln_2_low
         y(l) = inverse_factorial(exponential_terms)
         do k = exponential_terms - 1, 0, -1
            y(l) = y(l)*rest + inverse_factorial(k)
         end do
         ! The integer at the end of the sum goes to the exponent of the result.
         y(l) = transfer(transfer(y(l), 1_int64) + shiftl(transfer(sum, 1_int64), 52), 1.0_dp)
      end do
   end subroutine lane_exponential

   !> Logarithm to the base 2 in units of 2^-20, plus 1023*2^20: the upper half of the bits of a number.
   !> Straight between powers of two, so it is short of the logarithm by up to 0.086 octaves there. Zero gives
   !> 0.
   elemental real(dp) function coarse_log(x)
      !> Not negative [-]
      real(dp), intent(in) :: x

      coarse_log = transfer(ior(shiftr(transfer(x, 1_int64), 32), transfer(integer_base, 1_int64)), 1.0_dp) &
         - integer_base
   end function coarse_log

   !> 2^(x 2^-20), at most 6.2 per cent above: the inverse of `coarse_log` without its 1023*2^20.
   elemental real(dp) function coarse_power(x)
      !> From -1022*2^20 to 1023*2^20 [-]
      real(dp), intent(in) :: x

      coarse_power = transfer(shiftl(transfer(x + (log_of_one + integer_base), 1_int64), 32), 1.0_dp)
   end function coarse_power

   !> Largest whole number below x, or x where that is whole. Of an odd whole x it is the one below: what takes this for
   !> a place among cells finds one that ends there. A conversion to integer and back would be compiled lane by lane.
   elemental real(dp) function whole_below(x)
      !> From 0 to 2^51 [-]
      real(dp), intent(in) :: x

      whole_below = ((x - 0.5_dp) + rounder) - rounder
   end function whole_below

end module lane_functions
