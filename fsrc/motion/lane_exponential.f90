!> Powers of two and the exponential function for many scenes at once, as arithmetic and bit operations alone.
!> A call of a vector library would treat the last lanes of a short block by scalar code, which differs in the
!> last digit; here a scene gets the same bits in any lane, among any neighbours.
module lane_exponential
   use kinds, only: dp, int64
   implicit none(type, external)
   private

   !> Exponents are held between these.
   real(dp), parameter :: lowest_exponent = -870.0_dp, highest_exponent = 790.0_dp
   !> `near_exponential` is good to rounding up to this magnitude.
   real(dp), parameter, public :: nearness = 0.03125_dp

   !> 2^52 + 2^51: added and subtracted, it rounds to an integer, whose bits stand at the end of the sum.
   real(dp), parameter :: rounder = 6755399441055744.0_dp
   !> (2^t - 1)/t on |t| <= 1/2, interpolated at the nodes of Chebyshev; the rest is below 2e-17.
   real(dp), parameter :: c(11) = [0.6931471805599453_dp, 0.24022650695910097_dp, 0.0555041086648216_dp, &
                            0.009618129107606854_dp, 0.0013333558146416916_dp, 0.00015403530441794136_dp, &
                            1.525273382986708e-05_dp, 1.3215442552522291e-06_dp, 1.0178062426976924e-07_dp, &
                            7.072593027878997e-09_dp, 4.4549643712692967e-10_dp]

   public :: power_of_two, near_exponential

contains

   !> 2^x, to 2 epsilon; beyond about 2^-870 and 2^790 those are given.
   elemental real(dp) function power_of_two(x)
      !> Exponent [-]
      real(dp), intent(in) :: x
      real(dp) :: held, shifted, t, t2, mantissa
      integer(int64) :: octaves, bits

      held = max(lowest_exponent, min(highest_exponent, x))
      shifted = held + rounder
      t = held - (shifted - rounder)
      t2 = t*t
      mantissa = 1.0_dp + t*(((c(1) + c(2)*t) + t2*(c(3) + c(4)*t)) + &
         (t2*t2)*(((c(5) + c(6)*t) + t2*(c(7) + c(8)*t)) + (t2*t2)*((c(9) + c(10)*t) + t2*c(11))))
      ! The integer at the end of the sum goes to the exponent. (One transfer a statement: else no vectors.)
      octaves = transfer(shifted, octaves)
      bits = transfer(mantissa, bits)
      bits = bits + shiftl(octaves, 52)
      mantissa = transfer(bits, mantissa)
      power_of_two = mantissa
   end function power_of_two

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
