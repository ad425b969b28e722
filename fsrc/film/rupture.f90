!> Rupture of the film, the corrected (18) under the conditions of Swift and Stieber (17):
!>
!>    J(x_e) - t^2 K(x_e) - A (cos^4(x_e)/4 + t K(x_e)) = 0 ,   t = tan x_e ,   A = 4 w*/sqrt(2 h*)
!>
!> The one group A decides everything. For each A there is one physical root, t > -A/2. Here it is found as in
!> the paper; module reynolds_iso_viscous has it from a table, which is faster and good to rounding.
module rupture
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

   !> Far more iterations than rounding leaves room for: 3 to 15 are typical.
   integer, parameter :: most_substitutions = 200

   public :: pressure_integrals, squeeze_group, rupture_tangent_successive

contains

   !> The integrals from -pi/2 that pressure and rupture are made of, J of sin^2 cos^2 and K of cos^4, the corrected (16).
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

   !> A = 4 w*/sqrt(2 h*) with w* = w/u and h* = h/R.
   elemental real(dp) function squeeze_group(radius, speed, film, velocity) result(a)
      !> Equivalent radius R [m]
      real(dp), intent(in) :: radius
      !> Speed u of the film's model [m/s]
      real(dp), intent(in) :: speed
      !> Film thickness h0 [m]
      real(dp), intent(in) :: film
      !> Film velocity w = dh0/dt [m/s]
      real(dp), intent(in) :: velocity

      a = 4.0_dp*velocity/(speed*sqrt(2.0_dp*film/radius))
   end function squeeze_group

   !> t_e by the paper's successive substitution, in the form that converges:
   !> t <- -A/2 + sqrt(A^2/4 + (J - A cos^4/4)/K). Stops when rounding stalls it.
   elemental real(dp) function rupture_tangent_successive(a) result(t)
      !> Squeeze group A [-]
      real(dp), intent(in) :: a
      real(dp) :: j, k, quotient, half, change, last_change
      integer :: pass

      t = start(a)
      half = 0.5_dp*a
      last_change = huge(1.0_dp)
      do pass = 1, most_substitutions
         call pressure_integrals(t, j, k)
         quotient = (j - a*cos_4(t)/4.0_dp)/k
         change = -half + sqrt(max(0.0_dp, half*half + quotient)) - t
         t = t + change
         if (abs(change) <= 4.0_dp*epsilon(1.0_dp)*max(1.0_dp, abs(t))) return
         if (pass > 20 .and. abs(change) >= last_change) return
         last_change = abs(change)
      end do
   end function rupture_tangent_successive

   !> cos^4(xbar) of the coordinate tangent.
   elemental real(dp) function cos_4(t)
      real(dp), intent(in) :: t

      cos_4 = 1.0_dp/(1.0_dp + t*t)**2
   end function cos_4

   !> Hyperbola with the slopes of t_e at both ends, -1 and -3/8, and its value at A = 0.
   elemental real(dp) function start(a)
      real(dp), intent(in) :: a

      start = (-11.0_dp*a + 5.0_dp*hypot(a, 1.52_dp))/16.0_dp
   end function start

end module rupture
