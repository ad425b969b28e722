!> Rupture of the film, the corrected (18) under the conditions of Swift and Stieber (17):
!>
!>    J(x_e) - t^2 K(x_e) - A (cos^4(x_e)/4 + t K(x_e)) = 0 ,   t = tan x_e ,   A = 4 w*/sqrt(2 h*)
!>
!> The one group A decides everything. For each A there is one physical root, t > -A/2. Here it is found as in
!> the paper; module reynolds_iso_viscous has it from a table, which is faster and good to rounding.
module rupture
   use film_integrals, only: pressure_integrals
   use kinds, only: dp
   implicit none(type, external)
   private

   !> Far more passes than rounding leaves room for: 3 to 15 are typical.
   integer, parameter :: most_substitutions = 200

   public :: squeeze_group, rupture_tangent_successive

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
