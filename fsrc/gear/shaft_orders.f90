!> Engine orders of a shaft, multiples of its speed, as whole multiples of the lowest frequency that they all fit into. A
!> four-stroke engine has halves among them.
module shaft_orders
   use kinds, only: dp
   implicit none(type, external)
   private

   public :: base_order

contains

   !> Greatest common divisor of orders; 0 if they have none above a hundred-thousandth of the largest. Times the speed of the
   !> shaft [1/s] it is the frequency that the motion repeats with, and the orders over it are
   !> whole numbers.
   pure real(dp) function base_order(orders)
      !> Orders above 0; what they are off a common divisor by rounding, as 0.333 is off a third, is not forgiven beyond 1e-9
      real(dp), intent(in) :: orders(:)
      real(dp), parameter :: rounding = 1.0e-9_dp, least = 1.0e-5_dp
      real(dp) :: divisor, remainder, swap
      integer :: i

      base_order = 0.0_dp
      if (size(orders) == 0) return
      divisor = orders(1)
      do i = 2, size(orders)
         remainder = orders(i)
         do while (remainder > rounding*maxval(orders))
            swap = remainder
            remainder = abs(divisor - remainder*anint(divisor/remainder))
            divisor = swap
         end do
      end do
      if (divisor < least*maxval(orders)) return
      ! The largest order tells the divisor with the most digits.
      base_order = maxval(orders)/anint(maxval(orders)/divisor)
   end function base_order

end module shaft_orders
