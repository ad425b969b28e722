!> The published iso-viscous film: load (24), (35) and its slopes. With the rupture angle fixed at pi/2
!> there is no branch, no root and no transcendental function but one square root. It is taken of h and not
!> of 1/h, so that root and division run side by side: the motion waits for every one of these.
module published_iso_viscous
   use constants, only: half_pi, pi
   use kinds, only: dp
   use reynolds_iso_viscous, only: rupture_tangent_slope
   implicit none(type, external)
   private

   !> Factor of the rolling term as printed in (23); Reynolds film: 12 Phi(0) = 2.447 with u = u1 + u2.
   real(dp), parameter :: rolling_factor = 2.8_dp

   public :: rolling_coefficient, squeeze_coefficient, half_pi_rupture_load, solved_rupture_load, published_stiffness_damping, &
             width_of_film

contains

   !> Coefficient of 1/h in (23) and (24) [N m].
   elemental real(dp) function rolling_coefficient(length, speed, viscosity, radius)
      !> Contact length l [m]
      real(dp), intent(in) :: length
      !> Speed u [m/s]
      real(dp), intent(in) :: speed
      !> Viscosity eta0 [Pa s]
      real(dp), intent(in) :: viscosity
      !> Equivalent radius R [m]
      real(dp), intent(in) :: radius

      rolling_coefficient = rolling_factor*length*speed*viscosity*radius
   end function rolling_coefficient

   !> Coefficient of -w (x_e + pi/2) h^(-3/2) in (24) [N s m^(1/2)].
   elemental real(dp) function squeeze_coefficient(length, viscosity, radius)
      !> Contact length l [m]
      real(dp), intent(in) :: length
      !> Viscosity eta0 [Pa s]
      real(dp), intent(in) :: viscosity
      !> Equivalent radius R [m]
      real(dp), intent(in) :: radius

      squeeze_coefficient = 3.0_dp*length*viscosity*radius*sqrt(radius)/sqrt(2.0_dp)
   end function squeeze_coefficient

   !> x_e + pi/2, with all its digits where a film that separates fast is short.
   elemental real(dp) function width_of_film(rupture_tangent)
      !> t_e = tan x_e of (18) [-]
      real(dp), intent(in) :: rupture_tangent

      if (rupture_tangent < 0.0_dp) then
         width_of_film = atan(-1.0_dp/rupture_tangent)
      else
         width_of_film = half_pi + atan(rupture_tangent)
      end if
   end function width_of_film

   !> Load of (35), x_e = pi/2 on approach and separation: the film can pull, as printed.
   elemental subroutine half_pi_rupture_load(rolling, squeeze, film, velocity, load, load_by_film, load_by_velocity)
      !> Coefficient of the rolling term [N m]
      real(dp), intent(in) :: rolling
      !> Coefficient of the squeeze term [N s m^(1/2)]
      real(dp), intent(in) :: squeeze
      !> Film thickness h > 0 [m]
      real(dp), intent(in) :: film
      !> Film velocity w = dh/dt [m/s]
      real(dp), intent(in) :: velocity
      !> Load W [N]
      real(dp), intent(out) :: load
      !> dW/dh [N/m]
      real(dp), intent(out) :: load_by_film
      !> dW/dw [N s/m]
      real(dp), intent(out) :: load_by_velocity
      real(dp) :: inverse, damping

      inverse = 1.0_dp/film
      damping = pi*squeeze*(inverse*inverse*sqrt(film))
      load = rolling*inverse - damping*velocity
      load_by_film = (1.5_dp*damping*velocity - rolling*inverse)*inverse
      load_by_velocity = -damping
   end subroutine half_pi_rupture_load

   !> Load of (24) with x_e from the corrected (18); the slopes are total, x_e moves along.
   elemental subroutine solved_rupture_load(rolling, squeeze, film, velocity, a, rupture_tangent, load, load_by_film, &
                                            load_by_velocity)
      !> Coefficient of the rolling term [N m]
      real(dp), intent(in) :: rolling
      !> Coefficient of the squeeze term [N s m^(1/2)]
      real(dp), intent(in) :: squeeze
      !> Film thickness h > 0 [m]
      real(dp), intent(in) :: film
      !> Film velocity w = dh/dt [m/s]
      real(dp), intent(in) :: velocity
      !> Squeeze group A of film and velocity [-]
      real(dp), intent(in) :: a
      !> t_e(A) [-]
      real(dp), intent(in) :: rupture_tangent
      !> Load W [N]
      real(dp), intent(out) :: load
      !> dW/dh [N/m]
      real(dp), intent(out) :: load_by_film
      !> dW/dw [N s/m]
      real(dp), intent(out) :: load_by_velocity
      real(dp) :: inverse, damping, width, width_by_log_a

      inverse = 1.0_dp/film
      damping = squeeze*(inverse*inverse*sqrt(film))
      width = width_of_film(rupture_tangent)
      width_by_log_a = a*rupture_tangent_slope(a)/(1.0_dp + rupture_tangent*rupture_tangent)
      load = rolling*inverse - damping*velocity*width
      load_by_film = (damping*velocity*(1.5_dp*width + 0.5_dp*width_by_log_a) - rolling*inverse)*inverse
      load_by_velocity = -damping*(width + width_by_log_a)
   end subroutine solved_rupture_load

   !> Stiffness k and damping c of (26) to (28), with h0^(5/2) in (27).
   !>
   !> Sign: k = -dW/dh0 and c = -dW/dw, both positive where the film resists. (The paper defines them without
   !> the minus, (25), and then prints the one with it and the other without.) The rupture angle is held fixed in
   !> the differentiation, as in the paper; the slopes of solved_rupture_load let it move.
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

      damping = squeeze*width_of_film(rupture_tangent)/(film*sqrt(film))
      stiffness = (rolling/film - 1.5_dp*damping*velocity)/film
   end subroutine published_stiffness_damping

end module published_iso_viscous
