!> Functions for many scenes at once, one scene a lane.
!>
!> All lanes of a block go through the same vector instructions, arithmetic and bit operations alone, for the reason that
!> module elementary_functions gives. So a scene gets the same bits in any lane, among any neighbours.
module lane_functions
   use elementary_functions, only: cosine_sine, exponential
   use kinds, only: dp, int64
   implicit none(type, external)
   private

   !> Scenes in a block. A register holds 8 at most; two registers, interleaved, hide the latency of the arithmetic.
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

   public :: lane_cosine_sine, half_cosine_sine, lane_exponential, coarse_log, coarse_power, whole_below

contains

   !> Cosine and sine of 2 pi times a phase.
   pure subroutine lane_cosine_sine(phase, cosine, sine)
      !> Phase from 0 to 1 [periods]
      real(dp), intent(in) :: phase(lanes)
      !> cos(2 pi phase) [-]
      real(dp), intent(out) :: cosine(lanes)
      !> sin(2 pi phase) [-]
      real(dp), intent(out) :: sine(lanes)
      integer :: l

      !$omp simd
      do l = 1, lanes
         call cosine_sine(phase(l), cosine(l), sine(l))
      end do
   end subroutine lane_cosine_sine

   !> The same of half as many phases, to the same bits.
   pure subroutine half_cosine_sine(phase, cosine, sine)
      !> Phase from 0 to 1 [periods]
      real(dp), intent(in) :: phase(half_block)
      !> cos(2 pi phase) [-]
      real(dp), intent(out) :: cosine(half_block)
      !> sin(2 pi phase) [-]
      real(dp), intent(out) :: sine(half_block)
      integer :: l

      !$omp simd
      do l = 1, half_block
         call cosine_sine(phase(l), cosine(l), sine(l))
      end do
   end subroutine half_cosine_sine

   !> Exponential function.
   pure subroutine lane_exponential(x, y)
      !> Argument [-]
      real(dp), intent(in) :: x(lanes)
      !> exp(x) [-]
      real(dp), intent(out) :: y(lanes)
      integer :: l

      !$omp simd
      do l = 1, lanes
         y(l) = exponential(x(l))
      end do
   end subroutine lane_exponential

   !> Logarithm to the base 2 in units of 2^-20, plus 1023*2^20: the upper half of the bits of a number. Straight between powers of
   !> two, so it is short of the logarithm by up to 0.086 octaves there. Zero gives 0.
   elemental real(dp) function coarse_log(x)
      !> Not negative [-]
      real(dp), intent(in) :: x

      coarse_log = transfer(ior(shiftr(transfer(x, 1_int64), 32), transfer(integer_base, 1_int64)), 1.0_dp) - integer_base
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
