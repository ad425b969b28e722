!> Taylor series of the motion with the published iso-viscous film (35), for a block of lanes, on one flank or between two, of rigid
!> or elastic teeth (fsrc/THEORY.md, section 4: names and equations are those of (35) there).
!>
!> Of rigid teeth V = H' - 2 b r is Lienard's variable, which stays well-conditioned however heavy the damping: there H' is the
!> small difference of V and -2 b r, but the film depends on V alone. The recurrence is written once, in taylor_iso_viscous.inc, and
!> compiled for one flank and for two. The load of an elastic tooth is that of its spring, so the law is taken inverted, as the
!> velocity under a load.
module taylor_iso_viscous
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_force, only: factor
   use lane_functions, only: half_block, lanes
   use taylor_step_control, only: inverse, order, sign_of
   implicit none(type, external)
   private

   public :: iso_viscous_series

contains

   !> Coefficients 1 to `order` of H and V, of elastic teeth those of both films and compressions too, and the damping rate.
   pure subroutine iso_viscous_series(elastic, two_flanks, force, block)
      logical, intent(in) :: elastic
      logical, intent(in) :: two_flanks
      !> Derivatives of the force that oscillates, by module lane_force [-]
      real(dp), intent(in) :: force(lanes, order)
      type(lane_block_t), intent(inout) :: block

      if (elastic) then
         call elastic_flanks(merge(2, 1, two_flanks), force, block)
      else if (two_flanks) then
         block
            integer, parameter :: flanks = 2
            include 'taylor_iso_viscous.inc'
         end block
      else
         block
            integer, parameter :: flanks = 1
            include 'taylor_iso_viscous.inc'
         end block
      end if
   end subroutine iso_viscous_series

   !> One or two elastic flanks. An error of a compression d counts as one of its film, which it moves by as much.
   pure subroutine elastic_flanks(flanks, force, block)
      !> 1 or 2
      integer, intent(in) :: flanks
      !> Derivatives of the force that oscillates [-]
      real(dp), intent(in) :: force(lanes, order)
      type(lane_block_t), intent(inout) :: block
      !> sqrt H: lane, order, flank
      real(dp) :: r(half_block, 0:order, 2)
      real(dp), dimension(half_block) :: stiffness, share, pull, turn
      real(dp) :: twice_root(half_block, 2), product, square, opened
      integer :: before, flank, k, j, l, m

      do before = 0, lanes - 1, half_block
         !$omp simd private(m)
         do l = 1, half_block
            m = before + l
            stiffness(l) = 1.0_dp/block%compliance(m)
            share(l) = 1.0_dp/block%damping(m)
            pull(l) = -share(l)*stiffness(l)
            block%rest_rate(m) = 0.0_dp
            block%damping_rate(m) = 0.0_dp
         end do
         do flank = 1, flanks
            !$omp simd private(m)
            do l = 1, half_block
               m = before + l
               r(l, 0, flank) = sqrt(block%films(m, 0, flank))
               twice_root(l, flank) = 2.0_dp*r(l, 0, flank)
               turn(l) = share(l)*block%strength(m) &
                         + pull(l)*(block%compression(m, flank, 0)*block%films(m, 0, flank))
               block%rest_rate(m) = max(block%rest_rate(m), -turn(l)/r(l, 0, flank) &
                                                 - twice_root(l, flank)*pull(l) &
                                         *(block%films(m, 0, flank) + block%compression(m, flank, 0)))
            end do
         end do
         ! Products with the newest coefficients come last: all others can be summed while those are still under way.
         !GCC$ unroll 24
         do k = 0, order - 1
            !$omp simd private(m)
            do l = 1, half_block
               m = before + l
               block%lienard(m, k + 1) = -factor(k + 1)*force(m, k + 1)
               if (k == 0) block%lienard(m, 1) = block%lienard(m, 1) - block%static_load(m)
            end do
            do flank = 1, flanks
               !$omp simd private(product, square, opened, m)
               do l = 1, half_block
                  m = before + l
                  block%lienard(m, k + 1) = block%lienard(m, k + 1) &
                                            + (inverse(k + 1)*sign_of(flank)*stiffness(l))*block%compression(m, flank, k)
                  square = 0.0_dp
                  do j = 1, k/2
                     square = square + r(l, j, flank)*r(l, k + 1 - j, flank)
                  end do
                  square = 2.0_dp*square
                  if (mod(k, 2) == 1) square = square + r(l, shiftr(k + 1, 1), flank)*r(l, shiftr(k + 1, 1), flank)
                  opened = square - (inverse(k + 1)*sign_of(flank))*block%lienard(m, k)
                  product = 0.0_dp
                  do j = 1, k - 1
                     product = product + block%compression(m, flank, j)*block%films(m, k - j, flank)
                  end do
                  if (k > 0) product = product + block%compression(m, flank, 0)*block%films(m, k, flank)
                  product = product + block%compression(m, flank, k)*block%films(m, 0, flank)
                  if (k == 0) product = product - block%strength(m)*block%compliance(m)
                  r(l, k + 1, flank) = (inverse(k + 1)*pull(l))*product
                  block%films(m, k + 1, flank) = square + twice_root(l, flank)*r(l, k + 1, flank)
                  block%compression(m, flank, k + 1) = opened + twice_root(l, flank)*r(l, k + 1, flank)
               end do
            end do
         end do
      end do
   end subroutine elastic_flanks

end module taylor_iso_viscous
