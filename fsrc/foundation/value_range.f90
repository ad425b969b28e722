!> Smallest and largest of many numbers.
module value_range
   use kinds, only: dp
   implicit none(type, external)
   private

   public :: range_of

contains

   !> Smallest and largest number of an array, in one pass of whole vectors: minval and maxval wait for every single
   !> comparison. Which of -0 and 0 is told is not said.
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

end module value_range
