!> Reversals: extrema of a periodic signal that stand out from their surroundings.
module reversals
   use kinds, only: dp
   use value_range, only: range_of
   implicit none(type, external)
   private

   !> Extrema of less prominence than this share of the range are ripple.
   real(dp), parameter, public :: reversal_prominence = 0.01_dp

   !> A walk along the signal that turns only after a swing of more than a threshold.
   type :: walk_t
      real(dp) :: threshold = 0.0_dp
      !> Farthest sample since the last turn
      real(dp) :: extreme = 0.0_dp
      logical :: falling = .true.
      integer :: turns = 0
   end type walk_t

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
      type(walk_t) :: walk
      real(dp) :: lowest, highest
      integer :: first

      count = 0
      call range_of(signal, lowest, highest)
      walk%threshold = share*(highest - lowest)
      if (.not. walk%threshold > 0.0_dp) return
      first = findloc(signal, highest, dim=1)
      walk%extreme = highest
      call walk_along(signal(first + 1:), walk)
      call walk_along(signal(:first), walk)
      ! The walk ends at the maximum it began with, which it has not counted.
      count = walk%turns + 1
   end function count_reversals

   !> Go on along some samples.
   pure subroutine walk_along(signal, walk)
      real(dp), intent(in) :: signal(:)
      type(walk_t), intent(inout) :: walk
      integer :: i

      do i = 1, size(signal)
         if (walk%falling) then
            if (signal(i) < walk%extreme) then
               walk%extreme = signal(i)
            else if (signal(i) - walk%extreme > walk%threshold) then
               call turn(signal(i), walk)
            end if
         else if (signal(i) > walk%extreme) then
            walk%extreme = signal(i)
         else if (walk%extreme - signal(i) > walk%threshold) then
            call turn(signal(i), walk)
         end if
      end do
   end subroutine walk_along

   !> Turn at a sample that is farther from the extreme than the threshold.
   pure subroutine turn(value, walk)
      real(dp), intent(in) :: value
      type(walk_t), intent(inout) :: walk

      walk%turns = walk%turns + 1
      walk%falling = .not. walk%falling
      walk%extreme = value
   end subroutine turn

end module reversals
