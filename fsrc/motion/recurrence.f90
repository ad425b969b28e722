!> Return of a motion to a state that it has had before, to the last bit.
!>
!> Film and momentum at the start of a period decide all that follows (lane_block, start_period). Where both have the
!> very bits of an earlier period, the periods in between will return again and again: there is nothing left to compute.
!> Floating-point numbers are finite in number, so a motion that settles gets there, most after ten to forty periods. No
!> tolerance enters: the motion is the one that would have been computed.
!>
!> A state is compared with the one a period before, and with marks that are set anew after so many periods, the last of
!> them after more and more: a cycle of any length is found once a mark that stays for so long lies on it (Brent 1980).
module recurrence
   use kinds, only: dp, int64
   implicit none(type, external)
   private

   !> Periods after which the marks are set anew; the last one stays as long as all that came before it.
   integer, parameter :: distances(4) = [1, 4, 16, 64]

   !> A state at the start of a period.
   type :: mark_t
      integer :: period = -1
      !> Bits of H and V
      integer(int64) :: film = 0_int64, momentum = 0_int64
      !> Steps up to there
      integer(int64) :: steps = 0_int64
   end type mark_t

   !> What a motion looks back on.
   type, public :: recurrence_t
      private
      type(mark_t) :: marks(size(distances)) = mark_t()
   end type recurrence_t

   public :: look_back

contains

   !> Compare the state at the start of a period with earlier ones, and keep it.
   pure subroutine look_back(past, period, film, momentum, steps, cycle_periods, cycle_steps)
      !> What the motion looks back on
      type(recurrence_t), intent(inout) :: past
      !> Periods done
      integer, intent(in) :: period
      !> Scaled film H and momentum V [-]
      real(dp), intent(in) :: film
      real(dp), intent(in) :: momentum
      !> Steps up to here
      integer(int64), intent(in) :: steps
      !> Periods since the motion was in this very state, 0: it is new
      integer, intent(out) :: cycle_periods
      !> Steps since then
      integer(int64), intent(out) :: cycle_steps
      type(mark_t) :: here
      integer :: i, stays

      here = mark_t(period, transfer(film, 0_int64), transfer(momentum, 0_int64), steps)
      cycle_periods = 0
      cycle_steps = 0_int64
      do i = size(distances), 1, -1
         associate (mark => past%marks(i))
            if (same_state(here, mark)) then
               cycle_periods = period - mark%period
               cycle_steps = steps - mark%steps
            end if
            stays = distances(i)
            if (i == size(distances)) stays = max(stays, mark%period)
            if (mark%period < 0 .or. period - mark%period >= stays) mark = here
         end associate
      end do
   end subroutine look_back

   !> Whether a state is that of a mark that has been set.
   pure logical function same_state(here, mark)
      type(mark_t), intent(in) :: here
      type(mark_t), intent(in) :: mark

      same_state = mark%period >= 0 .and. here%film == mark%film .and. here%momentum == mark%momentum
   end function same_state

end module recurrence
