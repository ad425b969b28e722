!> How large many numbers are: their smallest and largest, and the power of two next to them.
module value_range
   use kinds, only: dp
   implicit none(type, external)
   private

   public :: range_of, binary_unit

contains

   !> Smallest and largest number of an array, in one pass of whole vectors: minval and maxval wait for every single
   !> comparison. Which of -0 and 0 is reported is not said.
   pure subroutine range_of(values, smallest, largest)
      !> One or more numbers, none of them NaN
      real(dp), intent(in) :: values(:)
      !> Smallest
      real(dp), intent(out) :: smallest
      !> Largest
      real(dp), intent(out) :: largest
      integer :: i

      smallest = values(1)
      largest = values(1)
      !$omp simd reduction(min: smallest) reduction(max: largest)
      do i = 1, size(values)
         smallest = merge(values(i), smallest, values(i) < smallest)
         largest = merge(values(i), largest, values(i) > largest)
      end do
   end subroutine range_of

   !> Power of two next to the largest magnitude; 1 if there is none above zero or one is not finite. In this unit the
   !> squares of numbers of any size neither overflow nor vanish, and no digit changes: to divide by it is exact, but
   !> for what is far too small beside the largest to count.
   pure real(dp) function binary_unit(values)
      !> Numbers, none of them NaN
      real(dp), intent(in) :: values(:)
      !> The reciprocal of the unit must be finite, too.
      integer, parameter :: largest_exponent = 1000
      real(dp) :: smallest, largest

      binary_unit = 1.0_dp
      if (size(values) == 0) return
      call range_of(values, smallest, largest)
      largest = max(-smallest, largest)
      if (largest > 0.0_dp .and. largest <= huge(1.0_dp)) &
         binary_unit = scale(1.0_dp, max(-largest_exponent, min(exponent(largest), largest_exponent)))
   end function binary_unit

end module value_range
