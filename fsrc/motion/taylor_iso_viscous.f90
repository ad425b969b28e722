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
   use lane_functions, only: lanes
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
      !> Lane, series, flank, coefficient
      integer, parameter :: h = 1, d = 2, r = 3, series = 3
      real(dp) :: c(lanes, series, 2, 0:order)
      real(dp) :: stiffness(lanes), share(lanes), twice_root(lanes, 2), product
      integer :: once, flank, k, j, l

      block%damping_rate = 0.0_dp
      stiffness = 1.0_dp/block%compliance
      share = 1.0_dp/block%damping
      do flank = 1, flanks
         c(:, h, flank, 0) = block%films(:, 0, flank)
         c(:, d, flank, 0) = block%compression(:, flank, 0)
         c(:, r, flank, 0) = sqrt(block%films(:, 0, flank))
         twice_root(:, flank) = 2.0_dp*c(:, r, flank, 0)
      end do
      ! Products with the newest coefficients come last: all others can be summed while those are still under way. gfortran unrolls
      ! the orders before it looks for full registers only within another loop.
      do once = 1, 1
         !GCC$ unroll 24
         do k = 0, order - 1
            !$omp simd
            do l = 1, lanes
               block%lienard(l, k + 1) = -factor(k + 1)*force(l, k + 1)
               if (k == 0) block%lienard(l, 1) = block%lienard(l, 1) - block%static_load(l)
            end do
            do flank = 1, flanks
               !$omp simd private(product)
               do l = 1, lanes
                  block%lienard(l, k + 1) = block%lienard(l, k + 1) + (inverse(k + 1)*sign_of(flank)*stiffness(l))*c(l, d, flank, k)
                  product = 0.0_dp
                  do j = 1, k - 1
                     product = product + c(l, d, flank, j)*c(l, h, flank, k - j)
                  end do
                  if (k > 0) product = product + c(l, d, flank, 0)*c(l, h, flank, k)
                  product = -stiffness(l)*(product + c(l, d, flank, k)*c(l, h, flank, 0))
                  if (k == 0) product = product + block%strength(l)
                  c(l, r, flank, k + 1) = (inverse(k + 1)*share(l))*product
                  product = 0.0_dp
                  do j = 1, k/2
                     product = product + c(l, r, flank, j)*c(l, r, flank, k + 1 - j)
                  end do
                  product = 2.0_dp*product
                  if (mod(k, 2) == 1) product = product + c(l, r, flank, shiftr(k + 1, 1))*c(l, r, flank, shiftr(k + 1, 1))
                  product = product + twice_root(l, flank)*c(l, r, flank, k + 1)
                  c(l, h, flank, k + 1) = product
                  c(l, d, flank, k + 1) = product - (inverse(k + 1)*sign_of(flank))*block%lienard(l, k)
               end do
            end do
         end do
      end do
      do flank = 1, flanks
         block%films(:, 1:, flank) = c(:, h, flank, 1:)
         block%compression(:, flank, 1:) = c(:, d, flank, 1:)
      end do
   end subroutine elastic_flanks

end module taylor_iso_viscous
