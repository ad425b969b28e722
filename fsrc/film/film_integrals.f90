!> The two integrals that pressure and rupture of the iso-viscous film are made of:
!> J(x) = integral of sin^2 cos^2 and K(x) = integral of cos^4 from -pi/2 to x, the corrected (16).
module film_integrals
   use constants, only: pi
   use kinds, only: dp
   implicit none(type, external)
   private

   integer :: i
   integer, parameter :: terms = 15

   !> Below this tangent the closed forms cancel (J ~ d^3/3, K ~ d^5/5 with d = x + pi/2):
   !> power series in d take over, all of whose digits count. Here d = 0.8.
   real(dp), parameter :: series_below = -0.97_dp
   real(dp), parameter :: series_j(terms) = &
      [((-1.0_dp)**(i + 1)*4.0_dp**(2*i + 1)/(32.0_dp*gamma(real(2*i + 2, dp))), i=1, terms)]
   real(dp), parameter :: series_k(terms) = &
      [((-1.0_dp)**i*(4.0_dp**(2*i + 1)/32.0_dp - 2.0_dp**(2*i + 1)/4.0_dp)/gamma(real(2*i + 2, dp)), i=2, terms + 1)]

   public :: pressure_integrals

contains

   !> J and K of the parabolic film at the coordinate tangent t = tan(xbar).
   !> Errors stay below a few epsilon relative to J and K for every finite t.
   elemental subroutine pressure_integrals(tangent, j, k)
      !> t = tan(xbar) [-]
      real(dp), intent(in) :: tangent
      !> Integral of sin^2 cos^2 [-]
      real(dp), intent(out) :: j
      !> Integral of cos^4 [-]
      real(dp), intent(out) :: k
      real(dp) :: x, d, q, sin_2x, cos_2x, sin_4x
      integer :: n

      if (tangent < series_below) then
         d = atan(-1.0_dp/tangent)
         q = d*d
         j = series_j(terms)
         k = series_k(terms)
         do n = terms - 1, 1, -1
            j = j*q + series_j(n)
            k = k*q + series_k(n)
         end do
         j = j*q*d
         k = k*q*q*d
      else
         x = atan(tangent)
         cos_2x = 1.0_dp/(1.0_dp + tangent*tangent)
         sin_2x = 2.0_dp*tangent*cos_2x
         cos_2x = 2.0_dp*cos_2x - 1.0_dp
         sin_4x = 2.0_dp*sin_2x*cos_2x
         j = x/8.0_dp - sin_4x/32.0_dp + pi/16.0_dp
         k = 3.0_dp*x/8.0_dp + sin_2x/4.0_dp + sin_4x/32.0_dp + 3.0_dp*pi/16.0_dp
      end if
   end subroutine pressure_integrals

end module film_integrals
