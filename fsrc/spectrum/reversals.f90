!> Reversals: extrema of a periodic signal that stand out from their surroundings.
module reversals
   use kinds, only: dp
   implicit none(type, external)
   private

   !> Extrema of less prominence than this share of the range are ripple.
   real(dp), parameter, public :: reversal_prominence = 0.01_dp

   public :: count_reversals

contains

   !> Number of extrema, maxima and minima, whose prominence exceeds a share of the range of the signal,
   !> which is taken as cyclic. A walk from the highest sample that turns only after a swing of more
   !> than the threshold meets just those extrema.
   pure integer function count_reversals(signal, share) result(count)
      !> Samples of whole periods
      real(dp), intent(in) :: signal(:)
      !> Smallest prominence as a share of the range [-]
      real(dp), intent(in) :: share
      real(dp) :: threshold, extreme
      integer :: i, first
      logical :: falling

      count = 0
      threshold = share*(maxval(signal) - minval(signal))
      if (.not. threshold > 0.0_dp) return
      first = maxloc(signal, dim=1)
      falling = .true.
      extreme = signal(first)
      do i = 1, size(signal)
         associate (value => signal(1 + modulo(first - 1 + i, size(signal))))
            if (falling) then
               if (value < extreme) then
                  extreme = value
               else if (value - extreme > threshold) then
                  count = count + 1
                  falling = .false.
                  extreme = value
               end if
            else if (value > extreme) then
               extreme = value
            else if (extreme - value > threshold) then
               count = count + 1
               falling = .true.
               extreme = value
            end if
         end associate
      end do
      ! The walk ends at the maximum it began with, which the loop has not counted.
      count = count + 1
   end function count_reversals

end module reversals
