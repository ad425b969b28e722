!> Stiffness and damping of the published iso-viscous film, (26) to (28), with h0^(5/2) in (27).
!>
!> Sign: k = -dW/dh0 and c = -dW/dw, both positive where the film resists. (The paper defines them without
!> the minus, (25), and then prints the one with it and the other without.) The rupture angle is held fixed in
!> the differentiation, as in the paper; the exact film's slopes let it move.
module published_stiffness
   use constants, only: half_pi
   use kinds, only: dp
   implicit none(type, external)
   private

   public :: published_stiffness_damping

contains

   !> k [N/m] of (26), (27) and c [N s/m] of (28).
   elemental subroutine published_stiffness_damping(rolling, squeeze, film, velocity, rupture_tangent, stiffness, damping)
      !> Coefficient of the rolling term of (24) [N m]
      real(dp), intent(in) :: rolling
      !> Coefficient of the squeeze term of (24) [N s m^(1/2)]
      real(dp), intent(in) :: squeeze
      !> Film thickness h0 > 0 [m]
      real(dp), intent(in) :: film
      !> Film velocity w = dh0/dt [m/s]
      real(dp), intent(in) :: velocity
      !> t_e = tan x_e of (18) [-]
      real(dp), intent(in) :: rupture_tangent
      !> -dW/dh0 at fixed x_e [N/m]
      real(dp), intent(out) :: stiffness
      !> -dW/dw at fixed x_e [N s/m]
      real(dp), intent(out) :: damping

      damping = squeeze*(atan(rupture_tangent) + half_pi)/(film*sqrt(film))
      stiffness = (rolling/film - 1.5_dp*damping*velocity)/film
   end subroutine published_stiffness_damping

end module published_stiffness
