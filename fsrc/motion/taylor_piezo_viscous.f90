!> Taylor series of the motion with the published piezo-viscous film (37), for a block of lanes, on one flank or between two
!> (fsrc/THEORY.md, section 4: names and equations are those of (37) there). One power and one exponential at the point of
!> expansion are enough.
!>
!> The recurrence is written once, in taylor_piezo_viscous.inc, and compiled for one flank and for two.
module taylor_piezo_viscous
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_force, only: factor
   use lane_functions, only: coarse_log, lane_exponential, lanes, log_of_one, octave
   use taylor_step_control, only: inverse, order, sign_of
   implicit none(type, external)
   private

   !> Growth of the load in one step that the series resolves, and share of the accuracy below which a load is
   !> negligible [octaves]
   real(dp), parameter :: most_growth = 20.0_dp, negligible = -8.0_dp

   !> Damping beyond this would overflow the coefficients [1/periods]. The load of such a lane is held there;
   !> its damping rate, which stays as it is, keeps the series from being used.
   real(dp), parameter :: largest_rate = 1.0e14_dp

   public :: piezo_viscous_series, reject_unresolved_growth

contains

   !> Coefficients 1 to `order` of H and V between rigid flanks, and the damping rate, -dV'/dV = c S [1/periods].
   pure subroutine piezo_viscous_series(two_flanks, force, block)
      logical, intent(in) :: two_flanks
      !> Derivatives of the force that oscillates, by module lane_force [-]
      real(dp), intent(in) :: force(lanes, order)
      type(lane_block_t), intent(inout) :: block

      if (two_flanks) then
         call two_rigid_flanks(force, block)
      else
         call rigid_flank(force, block)
      end if
   end subroutine piezo_viscous_series

   !> One rigid flank.
   pure subroutine rigid_flank(force, block)
      !> Derivatives of the force that oscillates [-]
      real(dp), intent(in) :: force(lanes, order)
      type(lane_block_t), intent(inout) :: block
      integer, parameter :: flanks = 1

      include 'taylor_piezo_viscous.inc'
   end subroutine rigid_flank

   !> Two rigid flanks.
   pure subroutine two_rigid_flanks(force, block)
      !> Derivatives of the force that oscillates [-]
      real(dp), intent(in) :: force(lanes, order)
      type(lane_block_t), intent(inout) :: block
      integer, parameter :: flanks = 2

      include 'taylor_piezo_viscous.inc'
   end subroutine two_rigid_flanks

   !> Reject steps in which the load grows by more than the series resolves. While the tooth moves away, the load falls below
   !> exp(-100) times the forces, and its coefficients vanish beside theirs. When the tooth comes back, the load grows by the same
   !> factor within one step of free fall, which the coefficients do not show. Logarithms to the base 2 of the load over the force
   !> show it: log2(S/P) = log2(a/P) - 7/2 log2 H - c V/ln 2.
   pure subroutine reject_unresolved_growth(strength, rate, force, accuracy, film, lienard, next_film, &
                                              next_lienard, accepted)
      !> a [-]
      real(dp), intent(in) :: strength(lanes)
      !> c [periods]
      real(dp), intent(in) :: rate(lanes)
      !> Force that matters, P = q + f [-]
      real(dp), intent(in) :: force(lanes)
      !> Relative accuracy of the film [-]
      real(dp), intent(in) :: accuracy(lanes)
      !> H and V at the start of the step [-]
      real(dp), intent(in) :: film(lanes)
      real(dp), intent(in) :: lienard(lanes)
      !> H and V at its end [-]
      real(dp), intent(in) :: next_film(lanes)
      real(dp), intent(in) :: next_lienard(lanes)
      !> 1 where the step is accepted, set to 0 where it is rejected
      real(dp), intent(inout) :: accepted(lanes)
      real(dp), parameter :: octaves_per_unit = 1.4426950408889634_dp
      real(dp) :: growth, load
      integer :: l

      !$omp simd private(growth, load)
      do l = 1, lanes
         growth = 3.5_dp/octave*(coarse_log(film(l)) - coarse_log(max(next_film(l), tiny(1.0_dp)))) &
            - octaves_per_unit*rate(l)*(next_lienard(l) - lienard(l))
         load = (coarse_log(strength(l)) - coarse_log(force(l)*accuracy(l)))/octave &
            - 3.5_dp/octave*(coarse_log(film(l)) - log_of_one) - octaves_per_unit*rate(l)*lienard(l) + growth
         accepted(l) = accepted(l)*(1.0_dp - merge(1.0_dp, 0.0_dp, growth > most_growth) &
                              *merge(1.0_dp, 0.0_dp, load > negligible))
      end do
   end subroutine reject_unresolved_growth

end module taylor_piezo_viscous
