!> Taylor series of the motion with the published iso-viscous film (35), for a block of lanes, on one flank or between two
!> (fsrc/THEORY.md, section 4: names and equations are those of (35) there).
!>
!> V = H' - 2 b r is Lienard's variable, which stays well-conditioned however heavy the damping: there H' is the small
!> difference of V and -2 b r, but the film depends on V alone.
module taylor_iso_viscous
   use kinds, only: dp
   use lane_force, only: factor
   use lane_functions, only: lanes
   use taylor_step_control, only: inverse, order
   implicit none(type, external)
   private

   public :: iso_viscous_series, iso_viscous_series_of_two

contains

   !> Coefficients 1 to `order` of H and V, and the damping rate.
   pure subroutine iso_viscous_series(rolling, squeeze, load, force, film, lienard, &
      damping_rate)
      !> a [-]
      real(dp), intent(in) :: rolling(lanes)
      !> 2 b [-]
      real(dp), intent(in) :: squeeze(lanes)
      !> q [-]
      real(dp), intent(in) :: load(lanes)
      !> Derivatives of the force that oscillates, by module lane_force [-]
      real(dp), intent(in) :: force(lanes, order)
      !> Series of H [-]; coefficient 0 is given
      real(dp), intent(inout) :: film(lanes, 0:order)
      !> Series of V [-]; coefficient 0 is given
      real(dp), intent(inout) :: lienard(lanes, 0:order)
      !> -dV'/dV at constant H: b H^(-3/2) [1/periods]
      real(dp), intent(out) :: damping_rate(lanes)
      real(dp) :: p(lanes, 0:order), r(lanes, 0:order)
      real(dp) :: minus_p(lanes), half_root(lanes), both(lanes), product, square
      integer :: k, j, l

      !$omp simd
      do l = 1, lanes
         p(l, 0) = 1.0_dp/film(l, 0)
         r(l, 0) = sqrt(p(l, 0))
         minus_p(l) = -p(l, 0)
         half_root(l) = 0.5_dp*film(l, 0)*r(l, 0)
         both(l) = minus_p(l)*half_root(l)
         damping_rate(l) = 0.5_dp*squeeze(l)*p(l, 0)*r(l, 0)
         film(l, 1) = lienard(l, 0) + squeeze(l)*r(l, 0)
         lienard(l, 1) = rolling(l)*p(l, 0) - load(l) - force(l, 1)
         p(l, 1) = minus_p(l)*(film(l, 1)*p(l, 0))
         r(l, 1) = both(l)*(film(l, 1)*p(l, 0))
      end do
      ! The products with the newest coefficients come last: all others can be summed while those are still
      ! under way. Unrolled, all coefficients of a lane live in registers.
      !GCC$ unroll 24
      do k = 2, order - 1
         !$omp simd private(product, square)
         do l = 1, lanes
            film(l, k) = inverse(k)*lienard(l, k - 1) + (inverse(k)*squeeze(l))*r(l, k - 1)
            lienard(l, k) = (inverse(k)*rolling(l))*p(l, k - 1) - factor(k)*force(l, k)
            square = 0.0_dp
            do j = 1, (k - 1)/2
               square = square + r(l, j)*r(l, k - j)
            end do
            square = 2.0_dp*square
            if (mod(k, 2) == 0) square = square + r(l, shiftr(k, 1))*r(l, shiftr(k, 1))
            product = 0.0_dp
            do j = 2, k - 1
               product = product + film(l, j)*p(l, k - j)
            end do
            product = product + film(l, 1)*p(l, k - 1)
            product = product + film(l, k)*p(l, 0)
            p(l, k) = minus_p(l)*product
            r(l, k) = both(l)*product - half_root(l)*square
         end do
      end do
      !$omp simd
      do l = 1, lanes
         film(l, order) = inverse(order)*(lienard(l, order - 1) + squeeze(l)*r(l, order - 1))
         lienard(l, order) = (inverse(order)*rolling(l))*p(l, order - 1) - factor(order)*force(l, order)
      end do
   end subroutine iso_viscous_series

   !> The same between two flanks.
   pure subroutine iso_viscous_series_of_two(rolling, squeeze, backlash, load, force, film, lienard, damping_rate)
      !> a [-]
      real(dp), intent(in) :: rolling(lanes)
      !> 2 b [-]
      real(dp), intent(in) :: squeeze(lanes)
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
      !> -dV'/dV at constant H: b (H^(-3/2) + C^(-3/2)) [1/periods]
      real(dp), intent(out) :: damping_rate(lanes)
      !> Of the drive and the coast flank
      real(dp) :: p(lanes, 0:order, 2), r(lanes, 0:order, 2)
      real(dp), dimension(lanes, 2) :: thickness, minus_p, half_root, both
      real(dp) :: product, square
      integer :: k, j, l, flank

      thickness(:, 1) = film(:, 0)
      thickness(:, 2) = backlash - film(:, 0)
      do flank = 1, 2
         !$omp simd
         do l = 1, lanes
            p(l, 0, flank) = 1.0_dp/thickness(l, flank)
            r(l, 0, flank) = sqrt(p(l, 0, flank))
            ! The sums that follow take the coefficients of H for those of either film.
            minus_p(l, flank) = merge(-p(l, 0, flank), p(l, 0, flank), flank == 1)
            half_root(l, flank) = 0.5_dp*thickness(l, flank)*r(l, 0, flank)
            both(l, flank) = minus_p(l, flank)*half_root(l, flank)
         end do
      end do
      damping_rate = 0.5_dp*squeeze*(p(:, 0, 1)*r(:, 0, 1) + p(:, 0, 2)*r(:, 0, 2))
      film(:, 1) = lienard(:, 0) + squeeze*(r(:, 0, 1) - r(:, 0, 2))
      lienard(:, 1) = rolling*(p(:, 0, 1) - p(:, 0, 2)) - load - force(:, 1)
      do flank = 1, 2
         p(:, 1, flank) = minus_p(:, flank)*(film(:, 1)*p(:, 0, flank))
         r(:, 1, flank) = both(:, flank)*(film(:, 1)*p(:, 0, flank))
      end do
      !GCC$ unroll 24
      do k = 2, order - 1
         !$omp simd
         do l = 1, lanes
            film(l, k) = inverse(k)*lienard(l, k - 1) + (inverse(k)*squeeze(l))*(r(l, k - 1, 1) - r(l, k - 1, 2))
            lienard(l, k) = (inverse(k)*rolling(l))*(p(l, k - 1, 1) - p(l, k - 1, 2)) - factor(k)*force(l, k)
         end do
         !GCC$ unroll 2
         do flank = 1, 2
            !$omp simd private(product, square)
            do l = 1, lanes
               square = 0.0_dp
               do j = 1, (k - 1)/2
                  square = square + r(l, j, flank)*r(l, k - j, flank)
               end do
               square = 2.0_dp*square
               if (mod(k, 2) == 0) square = square + r(l, shiftr(k, 1), flank)*r(l, shiftr(k, 1), flank)
               product = 0.0_dp
               do j = 1, k
                  product = product + film(l, j)*p(l, k - j, flank)
               end do
               p(l, k, flank) = minus_p(l, flank)*product
               r(l, k, flank) = both(l, flank)*product - half_root(l, flank)*square
            end do
         end do
      end do
      film(:, order) = inverse(order)*(lienard(:, order - 1) + squeeze*(r(:, order - 1, 1) - r(:, order - 1, 2)))
      lienard(:, order) = (inverse(order)*rolling)*(p(:, order - 1, 1) - p(:, order - 1, 2)) - factor(order)*force(:, order)
   end subroutine iso_viscous_series_of_two

end module taylor_iso_viscous
