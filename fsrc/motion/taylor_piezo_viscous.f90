!> Taylor series of the motion with the published piezo-viscous film (37), for a block of lanes, on one flank or between two, of
!> rigid or elastic teeth (fsrc/THEORY.md, section 4: names and equations are those of (37) there). One power and one exponential at
!> the point of expansion are enough, or the logarithm of the load of a spring.
!>
!> The recurrence of rigid teeth is written once, in taylor_piezo_viscous.inc, and compiled for one flank and for two.
module taylor_piezo_viscous
   use elementary_functions, only: logarithm
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_force, only: factor
   use lane_functions, only: coarse_log, lane_exponential, lanes, log_of_one, octave
   use taylor_step_control, only: inverse, order, sign_of, unfollowable_rate
   implicit none(type, external)
   private

   !> Growth of the load in one step that the series resolves, and share of the accuracy below which a load is negligible [octaves]
   real(dp), parameter :: most_growth = 20.0_dp, negligible = -8.0_dp

   !> Damping beyond this would overflow the coefficients [1/periods]. The load of such a lane is held there;
   !> its damping rate, which stays as it is, keeps the series from being used.
   real(dp), parameter :: largest_rate = 1.0e14_dp

   !> Time within which a film and its spring come to rest that a series is to follow: what is faster would overflow the
   !> coefficients [periods]
   real(dp), parameter :: shortest_rest = 1.0e-14_dp

   public :: piezo_viscous_series, reject_unresolved_growth

contains

   !> Coefficients 1 to `order` of H and V, of elastic teeth those of both films and compressions too, and the damping rate, of rigid
   !> teeth -dV'/dV = c S [1/periods].
   pure subroutine piezo_viscous_series(elastic, two_flanks, force, block)
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
            include 'taylor_piezo_viscous.inc'
         end block
      else
         block
            integer, parameter :: flanks = 1
            include 'taylor_piezo_viscous.inc'
         end block
      end if
   end subroutine piezo_viscous_series

   !> One or two elastic flanks.
   pure subroutine elastic_flanks(flanks, force, block)
      !> 1 or 2
      integer, intent(in) :: flanks
      !> Derivatives of the force that oscillates [-]
      real(dp), intent(in) :: force(lanes, order)
      type(lane_block_t), intent(inout) :: block
      !> Lane, series, flank, coefficient
      integer, parameter :: h = 1, d = 2, y = 3, w = 4, series = 4
      real(dp) :: c(lanes, series, 2, 0:order)
      real(dp), dimension(lanes, 2) :: inverse_film, inverse_spring, velocity
      real(dp) :: stiffness(lanes), share(lanes), of_spring, of_film
      integer :: once, flank, k, j, l

      block%damping_rate = merge(0.0_dp, unfollowable_rate, block%damping*minval(block%compression(:, :flanks, 0), dim=2) &
                                 > shortest_rest)
      stiffness = 1.0_dp/block%compliance
      share = 1.0_dp/block%damping
      block%lienard(:, 1) = -block%static_load - force(:, 1)
      block%rest_rate = 0.0_dp
      do flank = 1, flanks
         !$omp simd
         do l = 1, lanes
            c(l, h, flank, 0) = block%films(l, 0, flank)
            c(l, d, flank, 0) = block%compression(l, flank, 0)
            inverse_film(l, flank) = 1.0_dp/block%films(l, 0, flank)
            inverse_spring(l, flank) = 1.0_dp/max(block%compression(l, flank, 0), shortest_rest*share(l))
            block%rest_rate(l) = max(block%rest_rate(l), share(l)*(inverse_spring(l, flank) + 3.5_dp*inverse_film(l, flank)))
            velocity(l, flank) = share(l)*logarithm(block%strength(l)*block%compliance(l)*inverse_spring(l, flank) &
                                                    *inverse_film(l, flank)*inverse_film(l, flank)*inverse_film(l, flank) &
                                                    *sqrt(inverse_film(l, flank)))
            block%lienard(l, 1) = block%lienard(l, 1) + (sign_of(flank)*stiffness(l))*block%compression(l, flank, 0)
         end do
      end do
      do once = 1, 1
         !GCC$ unroll 24
         do k = 0, order - 1
            !$omp simd
            do l = 1, lanes
               if (k > 0) block%lienard(l, k + 1) = -factor(k + 1)*force(l, k + 1)
            end do
            do flank = 1, flanks
               !$omp simd private(of_spring, of_film)
               do l = 1, lanes
                  if (k > 0) block%lienard(l, k + 1) = block%lienard(l, k + 1) &
                                                        + (inverse(k + 1)*sign_of(flank)*stiffness(l))*c(l, d, flank, k)
                  c(l, h, flank, k + 1) = inverse(k + 1)*velocity(l, flank)
                  c(l, d, flank, k + 1) = inverse(k + 1)*(velocity(l, flank) - sign_of(flank)*block%lienard(l, k))
                  of_spring = 0.0_dp
                  of_film = 0.0_dp
                  do j = k - 1, 1, -1
                     of_spring = of_spring + c(l, d, flank, j)*c(l, w, flank, k - j)
                     of_film = of_film + c(l, h, flank, j)*c(l, y, flank, k - j)
                  end do
                  if (k > 0) of_spring = of_spring + c(l, d, flank, k)*c(l, w, flank, 0)
                  if (k > 0) of_film = of_film + c(l, h, flank, k)*c(l, y, flank, 0)
                  c(l, w, flank, k) = inverse_spring(l, flank) &
                     *((velocity(l, flank) - sign_of(flank)*block%lienard(l, k)) - of_spring)
                  c(l, y, flank, k) = inverse_film(l, flank)*(velocity(l, flank) - of_film)
                  velocity(l, flank) = -(inverse(k + 1)*share(l))*(c(l, w, flank, k) + 3.5_dp*c(l, y, flank, k))
               end do
            end do
         end do
      end do
      do flank = 1, flanks
         block%films(:, 1:, flank) = c(:, h, flank, 1:)
         block%compression(:, flank, 1:) = c(:, d, flank, 1:)
      end do
   end subroutine elastic_flanks

   !> Reject steps in which the load grows by more than the series resolves. While the tooth moves away, the load falls below
   !> exp(-100) times the forces, and its coefficients vanish beside theirs. When the tooth comes back, the load grows by the same
   !> factor within one step of free fall, which the coefficients do not show. Logarithms to the base 2 of the load over the force
   !> show it: log2(S/P) = log2(a/P) - 7/2 log2 H - c V/ln 2.
   pure subroutine reject_unresolved_growth(film, lienard, next_film, next_lienard, block)
      !> H and V at the start of the step [-]
      real(dp), intent(in) :: film(lanes)
      real(dp), intent(in) :: lienard(lanes)
      !> H and V at its end [-]
      real(dp), intent(in) :: next_film(lanes)
      real(dp), intent(in) :: next_lienard(lanes)
      type(lane_block_t), intent(inout) :: block
      real(dp), parameter :: octaves_per_unit = 1.4426950408889634_dp
      real(dp) :: growth, load
      integer :: l

      !$omp simd private(growth, load)
      do l = 1, lanes
         growth = 3.5_dp/octave*(coarse_log(film(l)) - coarse_log(max(next_film(l), tiny(1.0_dp)))) &
            - octaves_per_unit*block%damping(l)*(next_lienard(l) - lienard(l))
         load = (coarse_log(block%strength(l)) - coarse_log(block%force(l)*block%accuracy(l)))/octave &
            - 3.5_dp/octave*(coarse_log(film(l)) - log_of_one) - octaves_per_unit*block%damping(l)*lienard(l) + growth
         block%accepted(l) = block%accepted(l)*(1.0_dp - merge(1.0_dp, 0.0_dp, growth > most_growth) &
                                                *merge(1.0_dp, 0.0_dp, load > negligible))
      end do
   end subroutine reject_unresolved_growth

end module taylor_piezo_viscous
