!> State of a motion at the end of a period, complete: carried on from it, a motion is the same to the last bit
!> as if it had never stopped.
module checkpoint
   use kinds, only: dp, int64
   use period_repetition, only: orbit_watch_t
   implicit none(type, external)
   private

   !> State at the end of a whole period.
   type, public :: checkpoint_t
      !> Periods done; 0: the start of the motion, nothing else counts
      integer :: periods = 0
      !> h [m], z' [m/s], z'' [m/s2]
      real(dp) :: film = 0.0_dp
      real(dp) :: velocity = 0.0_dp
      real(dp) :: acceleration = 0.0_dp
      !> Scaled momentum of the error-controlled engine, and whether it had gone over to its implicit method
      real(dp) :: momentum = 0.0_dp
      logical :: implicit = .false.
      !> Of a run until steady: the states that its search looks back on
      type(orbit_watch_t) :: watch = orbit_watch_t()
      !> and, once it is over, the periods after which the motion repeats; 0: it goes on
      integer :: orbit = 0
      !> Cost so far
      integer(int64) :: steps = 0
      integer(int64) :: evaluations = 0
      integer(int64) :: cuts = 0
   end type checkpoint_t

end module checkpoint
