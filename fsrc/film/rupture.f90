!> Rupture of the film, the corrected (18) under the conditions of Swift and Stieber (17):
!>
!>    J(x_e) - t^2 K(x_e) - A (cos^4(x_e)/4 + t K(x_e)) = 0 ,   t = tan x_e ,   A = 4 w*/sqrt(2 h*)
!>
!> The one group A decides everything. For each A there is one physical root, t > -A/2.
module rupture
   use film_integrals, only: pressure_integrals
   use kinds, only: dp
   implicit none (type, external)
   private

   !> Passes after which rounding, not the method, decides the last digits.
   integer, parameter :: most_newton_passes = 20, most_substitutions = 200

   public :: squeeze_group, rupture_tangent_fast, rupture_tangent_successive, rupture_tangent_slope

contains

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

   !> t_e = tan x_e by Newton's method. The pressure at the rupture point is stationary in its place
   !> (17), so the slope of the left-hand side is just -K (2 t + A).
   elemental real(dp) function rupture_tangent_fast(a) result(t)
      !> Squeeze group A [-]
      real(dp), intent(in) :: a
      real(dp) :: residual, slope, change
      integer :: pass

      t = start(a)
      do pass = 1, most_newton_passes
         call rupture_residual(a, t, residual, slope)
         change = residual/slope
         t = max(t + change, 0.5_dp*(t - 0.5_dp*a))
         if (abs(change) <= 4.0_dp*epsilon(1.0_dp)*max(1.0_dp, abs(t))) return
      end do
   end function rupture_tangent_fast

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

   !> dt_e/dA [-], of (18) by implicit differentiation.
   elemental real(dp) function rupture_tangent_slope(a, t) result(slope)
      !> Squeeze group A [-]
      real(dp), intent(in) :: a
      !> Its rupture tangent t_e [-]
      real(dp), intent(in) :: t
      real(dp) :: j, k

      call pressure_integrals(t, j, k)
      slope = -(cos_4(t)/4.0_dp + t*k)/(k*(2.0_dp*t + a))
   end function rupture_tangent_slope

   !> Left-hand side of (18) and the negative of its slope in t.
   elemental subroutine rupture_residual(a, t, residual, slope)
      real(dp), intent(in) :: a
      real(dp), intent(in) :: t
      real(dp), intent(out) :: residual
      real(dp), intent(out) :: slope
      real(dp) :: j, k

      call pressure_integrals(t, j, k)
      residual = j - t*t*k - a*(cos_4(t)/4.0_dp + t*k)
      slope = k*(2.0_dp*t + a)
   end subroutine rupture_residual

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
