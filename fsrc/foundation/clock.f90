!> Wall clock of the run, for the log and the summary only.
module clock
   use kinds, only: dp, int64
   implicit none(type, external)
   private

   public :: wall_seconds

contains

   !> Seconds on a clock that only runs forward [s].
   real(dp) function wall_seconds()
      integer(int64) :: ticks, ticks_per_second

      call system_clock(ticks, ticks_per_second)
      wall_seconds = real(ticks, dp)/real(ticks_per_second, dp)
   end function wall_seconds

end module clock
