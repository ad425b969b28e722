!> Taylor series of the motion of elastic teeth with the published films (35) and (37), for a block of lanes (fsrc/THEORY.md,
!> section 4). Films with rupture have those of elastic teeth beside those of rigid ones.
!>
!> The load of a film is that of its spring, so film laws are taken inverted, as the velocity under a load. Errors count as those of
!> the films: an error of a compression d moves a film by as much.
module taylor_springs
   use elementary_functions, only: logarithm
   use kinds, only: dp
   use lane_force, only: factor
   use lane_functions, only: lanes
   use taylor_step_control, only: inverse, order, sign_of
   implicit none(type, external)
   private

   !> Time within which a film and its spring come to rest that a series is to follow: what is faster would overflow the
   !> coefficients [periods]
   real(dp), parameter, public :: shortest_rest = 1.0e-14_dp

   public :: iso_viscous_springs, piezo_viscous_springs

contains

   !> Coefficients 1 to `order` with the film (35).
   pure subroutine iso_viscous_springs(flanks, rolling, squeeze, compliance, load, force, films, lienard, compression)
      !> Flanks: 1 or 2
      integer, intent(in) :: flanks
      !> a, 2 b, kappa, q [-]
      real(dp), intent(in) :: rolling(lanes)
      real(dp), intent(in) :: squeeze(lanes)
      real(dp), intent(in) :: compliance(lanes)
      real(dp), intent(in) :: load(lanes)
      !> Derivatives of the force that oscillates, by module lane_force [-]
      real(dp), intent(in) :: force(lanes, order)
      !> Series of H and C, of V and of d_1 and d_2 [-]; coefficients 0 are given
      real(dp), intent(inout) :: films(lanes, 0:order, 2)
      real(dp), intent(inout) :: lienard(lanes, 0:order)
      real(dp), intent(inout) :: compression(lanes, 2, 0:order)
      !> Lane, series, flank, coefficient
      integer, parameter :: h = 1, d = 2, r = 3, series = 3
      real(dp) :: c(lanes, series, 2, 0:order)
      real(dp) :: stiffness(lanes), share(lanes), twice_root(lanes, 2), product
      integer :: once, flank, k, j, l

      stiffness = 1.0_dp/compliance
      share = 1.0_dp/squeeze
      do flank = 1, flanks
         c(:, h, flank, 0) = films(:, 0, flank)
         c(:, d, flank, 0) = compression(:, flank, 0)
         c(:, r, flank, 0) = sqrt(films(:, 0, flank))
         twice_root(:, flank) = 2.0_dp*c(:, r, flank, 0)
      end do
      ! Products with the newest coefficients come last: all others can be summed while those are still under way. gfortran unrolls
      ! the orders before it looks for full registers only within another loop.
      do once = 1, 1
         !GCC$ unroll 24
         do k = 0, order - 1
            !$omp simd
            do l = 1, lanes
               lienard(l, k + 1) = -factor(k + 1)*force(l, k + 1)
               if (k == 0) lienard(l, 1) = lienard(l, 1) - load(l)
            end do
            do flank = 1, flanks
               !$omp simd private(product)
               do l = 1, lanes
                  lienard(l, k + 1) = lienard(l, k + 1) + (inverse(k + 1)*sign_of(flank)*stiffness(l))*c(l, d, flank, k)
                  product = 0.0_dp
                  do j = 1, k - 1
                     product = product + c(l, d, flank, j)*c(l, h, flank, k - j)
                  end do
                  if (k > 0) product = product + c(l, d, flank, 0)*c(l, h, flank, k)
                  product = -stiffness(l)*(product + c(l, d, flank, k)*c(l, h, flank, 0))
                  if (k == 0) product = product + rolling(l)
                  c(l, r, flank, k + 1) = (inverse(k + 1)*share(l))*product
                  product = 0.0_dp
                  do j = 1, k/2
                     product = product + c(l, r, flank, j)*c(l, r, flank, k + 1 - j)
                  end do
                  product = 2.0_dp*product
                  if (mod(k, 2) == 1) product = product + c(l, r, flank, shiftr(k + 1, 1))*c(l, r, flank, shiftr(k + 1, 1))
                  product = product + twice_root(l, flank)*c(l, r, flank, k + 1)
                  c(l, h, flank, k + 1) = product
                  c(l, d, flank, k + 1) = product - (inverse(k + 1)*sign_of(flank))*lienard(l, k)
               end do
            end do
         end do
      end do
      do flank = 1, flanks
         films(:, 1:, flank) = c(:, h, flank, 1:)
         compression(:, flank, 1:) = c(:, d, flank, 1:)
      end do
   end subroutine iso_viscous_springs

   !> Coefficients 1 to `order` with the film (37).
   pure subroutine piezo_viscous_springs(flanks, strength, rate, compliance, load, force, films, lienard, compression)
      !> Flanks: 1 or 2
      integer, intent(in) :: flanks
      !> a, c, kappa, q [-]
      real(dp), intent(in) :: strength(lanes)
      real(dp), intent(in) :: rate(lanes)
      real(dp), intent(in) :: compliance(lanes)
      real(dp), intent(in) :: load(lanes)
      !> Derivatives of the force that oscillates, by module lane_force [-]
      real(dp), intent(in) :: force(lanes, order)
      !> Series of H and C, of V and of d_1 and d_2 [-]; coefficients 0 are given
      real(dp), intent(inout) :: films(lanes, 0:order, 2)
      real(dp), intent(inout) :: lienard(lanes, 0:order)
      real(dp), intent(inout) :: compression(lanes, 2, 0:order)
      !> Lane, series, flank, coefficient
      integer, parameter :: h = 1, d = 2, y = 3, w = 4, series = 4
      real(dp) :: c(lanes, series, 2, 0:order)
      real(dp), dimension(lanes, 2) :: inverse_film, inverse_spring, velocity
      real(dp) :: stiffness(lanes), share(lanes), of_spring, of_film
      integer :: once, flank, k, j, l

      stiffness = 1.0_dp/compliance
      share = 1.0_dp/rate
      lienard(:, 1) = -load - force(:, 1)
      do flank = 1, flanks
         !$omp simd
         do l = 1, lanes
            c(l, h, flank, 0) = films(l, 0, flank)
            c(l, d, flank, 0) = compression(l, flank, 0)
            inverse_film(l, flank) = 1.0_dp/films(l, 0, flank)
            inverse_spring(l, flank) = 1.0_dp/max(compression(l, flank, 0), shortest_rest*share(l))
            velocity(l, flank) = share(l)*logarithm(strength(l)*compliance(l)*inverse_spring(l, flank)*inverse_film(l, flank) &
                                                    *inverse_film(l, flank)*inverse_film(l, flank)*sqrt(inverse_film(l, flank)))
            lienard(l, 1) = lienard(l, 1) + (sign_of(flank)*stiffness(l))*compression(l, flank, 0)
         end do
      end do
      do once = 1, 1
         !GCC$ unroll 24
         do k = 0, order - 1
            !$omp simd
            do l = 1, lanes
               if (k > 0) lienard(l, k + 1) = -factor(k + 1)*force(l, k + 1)
            end do
            do flank = 1, flanks
               !$omp simd private(of_spring, of_film)
               do l = 1, lanes
                  if (k > 0) lienard(l, k + 1) = lienard(l, k + 1) &
                                                  + (inverse(k + 1)*sign_of(flank)*stiffness(l))*c(l, d, flank, k)
                  c(l, h, flank, k + 1) = inverse(k + 1)*velocity(l, flank)
                  c(l, d, flank, k + 1) = inverse(k + 1)*(velocity(l, flank) - sign_of(flank)*lienard(l, k))
                  of_spring = 0.0_dp
                  of_film = 0.0_dp
                  do j = k - 1, 1, -1
                     of_spring = of_spring + c(l, d, flank, j)*c(l, w, flank, k - j)
                     of_film = of_film + c(l, h, flank, j)*c(l, y, flank, k - j)
                  end do
                  if (k > 0) of_spring = of_spring + c(l, d, flank, k)*c(l, w, flank, 0)
                  if (k > 0) of_film = of_film + c(l, h, flank, k)*c(l, y, flank, 0)
                  c(l, w, flank, k) = inverse_spring(l, flank)*((velocity(l, flank) - sign_of(flank)*lienard(l, k)) - of_spring)
                  c(l, y, flank, k) = inverse_film(l, flank)*(velocity(l, flank) - of_film)
                  velocity(l, flank) = -(inverse(k + 1)*share(l))*(c(l, w, flank, k) + 3.5_dp*c(l, y, flank, k))
               end do
            end do
         end do
      end do
      do flank = 1, flanks
         films(:, 1:, flank) = c(:, h, flank, 1:)
         compression(:, flank, 1:) = c(:, d, flank, 1:)
      end do
   end subroutine piezo_viscous_springs

end module taylor_springs
