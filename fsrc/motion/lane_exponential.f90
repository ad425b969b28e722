!> The exponential function for many scenes at once, as arithmetic and bit operations alone. A call of a vector
!> library would treat the last lanes of a short block by scalar code, which differs in the last digit; here a
!> scene gets the same bits in any lane, among any neighbours.
module lane_exponential
   use kinds, only: dp, int64
   implicit none (type, external)
   private

   !> Arguments are held between these.
   real(dp), parameter, public :: lowest_argument = -600.0_dp, highest_argument = 550.0_dp
   !> `near_exponential` is good to rounding up to this magnitude.
   real(dp), parameter, public :: nearness = 0.03125_dp

   !> 2^52 + 2^51: added and subtracted, it rounds to an integer, whose bits stand at the end of the sum.
   real(dp), parameter :: rounder = 6755399441055744.0_dp
   !> 1/ln 2, and ln 2 in two parts, the first with zeros enough to make its product with an integer exact.
   real(dp), parameter :: octaves_per_unit = 1.4426950408889634_dp
   real(dp), parameter :: ln_2_high = 6.931471803691238e-01_dp, ln_2_low = 1.9082149292705877e-10_dp
   !> (exp(t) - 1 - t)/t^2 on |t| <= ln(2)/2, interpolated at the nodes of Chebyshev; the rest is below 2e-17.
   real(dp), parameter :: c(2:11) = [0.5000000000000001_dp, 0.16666666666666669_dp, 0.04166666666662399_dp, &
                                     0.008333333333330051_dp, 0.0013888888917281794_dp, 0.00019841269863105968_dp, &
                                     2.480152119021773e-05_dp, 2.7557268378684192e-06_dp, 2.7620138719733994e-07_dp, &
                                     2.5100424157005067e-08_dp]

   public :: raise_lanes, near_exponential

contains

   !> exp(-rate (velocity + 4 quarter)) of many lanes, to 2 epsilon of the exponential of the rounded argument.
   !> The argument is formed here because a loop of its own costs a third of the exponential.
   pure subroutine raise_lanes(rate, velocity, quarter, growth)
      !> Factor of the velocity; any units whose product with it has none
      real(dp), contiguous, intent(in) :: rate(:)
      !> Velocity at the start of a step
      real(dp), contiguous, intent(in) :: velocity(:)
      !> A quarter of its change in the step
      real(dp), contiguous, intent(in) :: quarter(:)
      !> Exponentials [-]
      real(dp), contiguous, intent(inout) :: growth(:)
      real(dp) :: shifted, octaves, t, t2, t4, tail, mantissa
      integer(int64) :: exponent_bits, bits
      integer :: l

      !$omp simd private(shifted, octaves, t, t2, t4, tail, mantissa, exponent_bits, bits)
      do l = 1, size(growth)
         t = max(lowest_argument, min(highest_argument, -rate(l)*(velocity(l) + 4.0_dp*quarter(l))))
         shifted = t*octaves_per_unit + rounder
         octaves = shifted - rounder
         t = (t - octaves*ln_2_high) - octaves*ln_2_low
         t2 = t*t
         t4 = t2*t2
         tail = ((c(2) + c(3)*t) + t2*(c(4) + c(5)*t)) + &
                t4*(((c(6) + c(7)*t) + t2*(c(8) + c(9)*t)) + t4*(c(10) + c(11)*t))
         mantissa = 1.0_dp + (t + t2*tail)
         ! The integer at the end of the sum goes to the exponent. (One transfer a statement: else no vectors.)
         exponent_bits = transfer(shifted, exponent_bits)
         bits = transfer(mantissa, bits)
         bits = bits + shiftl(exponent_bits, 52)
         mantissa = transfer(bits, mantissa)
         growth(l) = mantissa
      end do
   end subroutine raise_lanes

   !> exp(x) for |x| <= nearness.
   elemental real(dp) function near_exponential(x)
      !> Argument [-]
      real(dp), intent(in) :: x
      real(dp) :: x2

      x2 = x*x
      near_exponential = (1.0_dp + x) + x2*((0.5_dp + x*(1.0_dp/6.0_dp)) + &
                         x2*((1.0_dp/24.0_dp + x*(1.0_dp/120.0_dp)) + x2*(1.0_dp/720.0_dp + x*(1.0_dp/5040.0_dp))))
   end function near_exponential

end module lane_exponential
