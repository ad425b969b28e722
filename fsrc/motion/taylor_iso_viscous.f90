!> Taylor series of the motion with the published iso-viscous film (35), for a block of lanes, on one flank or between two
!> (fsrc/THEORY.md, section 4: names and equations are those of (35) there).
!>
!> V = H' - 2 b r is Lienard's variable, which stays well-conditioned however heavy the damping: there H' is the small
!> difference of V and -2 b r, but the film depends on V alone.
!>
!> The recurrence is written once, in taylor_iso_viscous.inc, and compiled for one flank and for two.
module taylor_iso_viscous
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_force, only: factor
   use lane_functions, only: lanes
   use taylor_step_control, only: inverse, order, sign_of
   implicit none(type, external)
   private

   public :: iso_viscous_series

contains

   !> Coefficients 1 to `order` of H and V between rigid flanks, and the damping rate.
   pure subroutine iso_viscous_series(two_flanks, force, block)
      logical, intent(in) :: two_flanks
      !> Derivatives of the force that oscillates, by module lane_force [-]
      real(dp), intent(in) :: force(lanes, order)
      type(lane_block_t), intent(inout) :: block

      if (two_flanks) then
         call two_rigid_flanks(force, block)
      else
         call rigid_flank(force, block)
      end if
   end subroutine iso_viscous_series

   !> One rigid flank.
   pure subroutine rigid_flank(force, block)
      !> Derivatives of the force that oscillates [-]
      real(dp), intent(in) :: force(lanes, order)
      type(lane_block_t), intent(inout) :: block
      integer, parameter :: flanks = 1

      include 'taylor_iso_viscous.inc'
   end subroutine rigid_flank

   !> Two rigid flanks.
   pure subroutine two_rigid_flanks(force, block)
      !> Derivatives of the force that oscillates [-]
      real(dp), intent(in) :: force(lanes, order)
      type(lane_block_t), intent(inout) :: block
      integer, parameter :: flanks = 2

      include 'taylor_iso_viscous.inc'
   end subroutine two_rigid_flanks

end module taylor_iso_viscous
