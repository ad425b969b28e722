!> Taylor series of the motion with the published piezo-viscous film (37), for a block of lanes, on one flank or between two
!> (fsrc/THEORY.md, section 4: names and equations are those of (37) there). One power and one exponential at the point of
!> expansion are enough.
module taylor_piezo_viscous
   use kinds, only: dp
   use lane_force, only: factor
   use lane_functions, only: coarse_log, lane_exponential, lanes, log_of_one, octave
   use taylor_step_control, only: inverse, order
   implicit none(type, external)
   private

   !> Growth of the load in one step that the series resolves, and share of the accuracy below which a load is
   !> negligible [octaves]
   real(dp), parameter :: most_growth = 20.0_dp, negligible = -8.0_dp

   !> Damping beyond this would overflow the coefficients [1/periods]. The load of such a lane is held there;
   !> its damping rate, which is told as it is, keeps the series from being used.
   real(dp), parameter :: largest_rate = 1.0e14_dp

   public :: piezo_viscous_series, piezo_viscous_series_of_two, reject_unresolved_growth

contains

   !> Coefficients 1 to `order` of H and V, and the damping rate.
   pure subroutine piezo_viscous_series(strength, rate, load, force, film, lienard, &
      damping_rate)
      !> a [-]
      real(dp), intent(in) :: strength(lanes)
      !> c [periods]
      real(dp), intent(in) :: rate(lanes)
      !> q [-]
      real(dp), intent(in) :: load(lanes)
      !> Derivatives of the force that oscillates, by module lane_force [-]
      real(dp), intent(in) :: force(lanes, order)
      !> Series of H [-]; coefficient 0 is given
      real(dp), intent(inout) :: film(lanes, 0:order)
      !> Series of V [-]; coefficient 0 is given
      real(dp), intent(inout) :: lienard(lanes, 0:order)
      !> -dV'/dV = c S [1/periods]
      real(dp), intent(out) :: damping_rate(lanes)
      real(dp) :: y(lanes, 0:order), g(lanes, 0:order), s(lanes, 0:order)
      real(dp) :: exponent(lanes), growth(lanes), inverse_film(lanes), product
      integer :: k, j, l

      !$omp simd
      do l = 1, lanes
         exponent(l) = -rate(l)*lienard(l, 0)
      end do
      call lane_exponential(exponent, growth)
      !$omp simd
      do l = 1, lanes
         inverse_film(l) = 1.0_dp/film(l, 0)
         s(l, 0) = strength(l)*growth(l)*inverse_film(l)*inverse_film(l)*inverse_film(l)*sqrt(inverse_film(l))
         damping_rate(l) = rate(l)*s(l, 0)
         s(l, 0) = merge(s(l, 0), 1.0_dp, damping_rate(l) < largest_rate)
         film(l, 1) = lienard(l, 0)
         lienard(l, 1) = s(l, 0) - load(l) - force(l, 1)
         y(l, 0) = inverse_film(l)*lienard(l, 0)
         g(l, 0) = -3.5_dp*y(l, 0) - rate(l)*lienard(l, 1)
         s(l, 1) = s(l, 0)*g(l, 0)
      end do
      ! The products with the newest coefficients come last: all others can be summed while those are still
      ! under way. Unrolled, all coefficients of a lane live in registers.
      !GCC$ unroll 24
      do k = 2, order - 1
         !$omp simd private(product)
         do l = 1, lanes
            film(l, k) = inverse(k)*lienard(l, k - 1)
            lienard(l, k) = inverse(k)*s(l, k - 1) - factor(k)*force(l, k)
            product = lienard(l, k - 1)
            do j = 1, k - 1
               product = product - film(l, k - j)*y(l, j - 1)
            end do
            y(l, k - 1) = inverse_film(l)*product
            g(l, k - 1) = -3.5_dp*y(l, k - 1) - (real(k, dp)*rate(l))*lienard(l, k)
            product = 0.0_dp
            do j = 1, k - 2
               product = product + s(l, k - 1 - j)*g(l, j)
            end do
            product = product + s(l, k - 1)*g(l, 0)
            product = product + s(l, 0)*g(l, k - 1)
            s(l, k) = inverse(k)*product
         end do
      end do
      !$omp simd
      do l = 1, lanes
         film(l, order) = inverse(order)*lienard(l, order - 1)
         lienard(l, order) = inverse(order)*s(l, order - 1) - factor(order)*force(l, order)
      end do
   end subroutine piezo_viscous_series

   !> The same between two flanks.
   pure subroutine piezo_viscous_series_of_two(strength, rate, backlash, load, force, film, lienard, damping_rate)
      !> a [-]
      real(dp), intent(in) :: strength(lanes)
      !> c [periods]
      real(dp), intent(in) :: rate(lanes)
      !> B [-]
      real(dp), intent(in) :: backlash(lanes)
      !> q [-]
      real(dp), intent(in) :: load(lanes)
      !> Derivatives of the force that oscillates, by module lane_force [-]
      real(dp), intent(in) :: force(lanes, order)
      !> Series of H [-]; coefficient 0 is given
      real(dp), intent(inout) :: film(lanes, 0:order)
      !> Series of V [-]; coefficient 0 is given
      real(dp), intent(inout) :: lienard(lanes, 0:order)
      !> -dV'/dV = c times both loads [1/periods]
      real(dp), intent(out) :: damping_rate(lanes)
      !> Sign of H_k and V_k for the drive and the coast film
      real(dp), parameter :: turned(2) = [1.0_dp, -1.0_dp]
      real(dp), dimension(lanes, 0:order, 2) :: y, g, s
      real(dp) :: growth(lanes), inverse_film(lanes), turned_inverse(lanes, 2), turned_rate(lanes, 2), flank_rate, product
      integer :: k, j, l, flank

      damping_rate = 0.0_dp
      do flank = 1, 2
         turned_rate(:, flank) = turned(flank)*rate
         call lane_exponential(-turned_rate(:, flank)*lienard(:, 0), growth)
         inverse_film = 1.0_dp/merge(film(:, 0), backlash - film(:, 0), flank == 1)
         turned_inverse(:, flank) = turned(flank)*inverse_film
         !$omp simd private(flank_rate)
         do l = 1, lanes
            s(l, 0, flank) = strength(l)*growth(l)*inverse_film(l)*inverse_film(l)*inverse_film(l)*sqrt(inverse_film(l))
            flank_rate = rate(l)*s(l, 0, flank)
            damping_rate(l) = damping_rate(l) + flank_rate
            s(l, 0, flank) = merge(s(l, 0, flank), 1.0_dp, flank_rate < largest_rate)
         end do
      end do
      film(:, 1) = lienard(:, 0)
      lienard(:, 1) = (s(:, 0, 1) - s(:, 0, 2)) - load - force(:, 1)
      do flank = 1, 2
         y(:, 0, flank) = turned_inverse(:, flank)*lienard(:, 0)
         g(:, 0, flank) = -3.5_dp*y(:, 0, flank) - turned_rate(:, flank)*lienard(:, 1)
         s(:, 1, flank) = s(:, 0, flank)*g(:, 0, flank)
      end do
      !GCC$ unroll 24
      do k = 2, order - 1
         !$omp simd
         do l = 1, lanes
            film(l, k) = inverse(k)*lienard(l, k - 1)
            lienard(l, k) = inverse(k)*(s(l, k - 1, 1) - s(l, k - 1, 2)) - factor(k)*force(l, k)
         end do
         !GCC$ unroll 2
         do flank = 1, 2
            !$omp simd private(product)
            do l = 1, lanes
               product = lienard(l, k - 1)
               do j = 1, k - 1
                  product = product - film(l, k - j)*y(l, j - 1, flank)
               end do
               y(l, k - 1, flank) = turned_inverse(l, flank)*product
               g(l, k - 1, flank) = -3.5_dp*y(l, k - 1, flank) - (real(k, dp)*turned_rate(l, flank))*lienard(l, k)
               product = 0.0_dp
               do j = 0, k - 1
                  product = product + s(l, k - 1 - j, flank)*g(l, j, flank)
               end do
               s(l, k, flank) = inverse(k)*product
            end do
         end do
      end do
      film(:, order) = inverse(order)*lienard(:, order - 1)
      lienard(:, order) = inverse(order)*(s(:, order - 1, 1) - s(:, order - 1, 2)) - factor(order)*force(:, order)
   end subroutine piezo_viscous_series_of_two

   !> Reject steps in which the load grows by more than the series resolves. While the tooth moves away, the load falls below
   !> exp(-100) times the forces, and its coefficients vanish beside theirs. When the tooth comes back, the load grows by the same
   !> factor within one step of free fall, which the coefficients do not show. Logarithms to the base 2 of the load over the force
   !> show it: log2(S/P) = log2(a/P) - 7/2 log2 H - c V/ln 2.
   pure subroutine reject_unresolved_growth(strength, rate, force, accuracy, film, lienard, next_film, &
                                              next_lienard, trust)
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
      !> 1 where the step is trusted, set to 0 where it is rejected
      real(dp), intent(inout) :: trust(lanes)
      real(dp), parameter :: octaves_per_unit = 1.4426950408889634_dp
      real(dp) :: growth, load
      integer :: l

      !$omp simd private(growth, load)
      do l = 1, lanes
         growth = 3.5_dp/octave*(coarse_log(film(l)) - coarse_log(max(next_film(l), tiny(1.0_dp)))) &
            - octaves_per_unit*rate(l)*(next_lienard(l) - lienard(l))
         load = (coarse_log(strength(l)) - coarse_log(force(l)*accuracy(l)))/octave &
            - 3.5_dp/octave*(coarse_log(film(l)) - log_of_one) - octaves_per_unit*rate(l)*lienard(l) + growth
         trust(l) = trust(l)*(1.0_dp - merge(1.0_dp, 0.0_dp, growth > most_growth) &
                              *merge(1.0_dp, 0.0_dp, load > negligible))
      end do
   end subroutine reject_unresolved_growth

end module taylor_piezo_viscous
