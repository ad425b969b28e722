!> Whole numbers.
module whole_numbers
   implicit none(type, external)
   private

   public :: common_divisor

contains

   !> Greatest common divisor of two whole numbers: that of 0 and a number is the number.
   elemental integer function common_divisor(one, other) result(divisor)
      integer, intent(in) :: one
      integer, intent(in) :: other
      integer :: rest, remainder

      divisor = one
      rest = other
      do while (rest > 0)
         remainder = modulo(divisor, rest)
         divisor = rest
         rest = remainder
      end do
   end function common_divisor

end module whole_numbers
