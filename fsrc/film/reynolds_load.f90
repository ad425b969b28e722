!> Load and slopes of the exact films in physical units, u = u1 + u2 (the sum, as the Reynolds equation with
!> 6 eta0 u dh/dx asks):
!>
!>    W = 12 l u eta0 R/h Phi(A)     iso-viscous,      A = 4 w/(u sqrt(2 h/R))
!>    W = 12 l u eta0 R/h Psi(A, B)  piezo-viscous,    B = 6 sqrt(2R) alpha u eta0 h^(-3/2)
!>
!> The slopes are total: rupture moves with film and velocity.
module reynolds_load
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use kinds, only: dp
   use reynolds_iso_viscous, only: iso_viscous_group => iso_viscous_load
   use reynolds_piezo_viscous, only: piezo_viscous_group => piezo_viscous_load
   implicit none(type, external)
   private

   !> Stands for the load where no rigid piezo-viscous film exists; above every load that is one [N].
   real(dp), parameter :: load_without_film = 1.0e200_dp

   public :: load_scale, squeeze_rate, pressure_rate, reynolds_iso_viscous_load, reynolds_piezo_viscous_load

contains

   !> 12 l u eta0 R [N m].
   elemental real(dp) function load_scale(length, speed, viscosity, radius)
      !> Contact length l [m]
      real(dp), intent(in) :: length
      !> Sum of the surface speeds u [m/s]
      real(dp), intent(in) :: speed
      !> Viscosity eta0 [Pa s]
      real(dp), intent(in) :: viscosity
      !> Equivalent radius R [m]
      real(dp), intent(in) :: radius

      load_scale = 12.0_dp*length*speed*viscosity*radius
   end function load_scale

   !> A sqrt(h)/w = 4 sqrt(R/2)/u [s m^(-1/2)].
   elemental real(dp) function squeeze_rate(speed, radius)
      !> Sum of the surface speeds u [m/s]
      real(dp), intent(in) :: speed
      !> Equivalent radius R [m]
      real(dp), intent(in) :: radius

      squeeze_rate = 4.0_dp*sqrt(0.5_dp*radius)/speed
   end function squeeze_rate

   !> B h^(3/2) = 6 sqrt(2R) alpha u eta0 [m^(3/2)].
   elemental real(dp) function pressure_rate(speed, viscosity, radius, pressure_viscosity)
      !> Sum of the surface speeds u [m/s]
      real(dp), intent(in) :: speed
      !> Viscosity eta0 [Pa s]
      real(dp), intent(in) :: viscosity
      !> Equivalent radius R [m]
      real(dp), intent(in) :: radius
      !> Barus coefficient alpha [1/Pa]
      real(dp), intent(in) :: pressure_viscosity

      pressure_rate = 6.0_dp*sqrt(2.0_dp*radius)*pressure_viscosity*speed*viscosity
   end function pressure_rate

   !> Exact iso-viscous load.
   elemental subroutine reynolds_iso_viscous_load(scale, rate, film, velocity, load, load_by_film, load_by_velocity)
      !> 12 l u eta0 R [N m]
      real(dp), intent(in) :: scale
      !> A sqrt(h)/w [s m^(-1/2)]
      real(dp), intent(in) :: rate
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
      real(dp) :: inverse, a_by_velocity, a, phi, phi_by_a

      inverse = 1.0_dp/film
      a_by_velocity = rate*inverse*sqrt(film)
      a = a_by_velocity*velocity
      call iso_viscous_group(a, phi, phi_by_a)
      load = scale*inverse*phi
      load_by_film = -scale*inverse*inverse*(phi + 0.5_dp*a*phi_by_a)
      load_by_velocity = scale*inverse*phi_by_a*a_by_velocity
   end subroutine reynolds_iso_viscous_load

   !> Exact piezo-viscous load; where no rigid film exists, a load above every real one, without slopes.
   elemental subroutine reynolds_piezo_viscous_load(scale, rate, b_rate, film, velocity, load, load_by_film, load_by_velocity)
      !> 12 l u eta0 R [N m]
      real(dp), intent(in) :: scale
      !> A sqrt(h)/w [s m^(-1/2)]
      real(dp), intent(in) :: rate
      !> B h^(3/2) [m^(3/2)]
      real(dp), intent(in) :: b_rate
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
      real(dp) :: inverse, root_inverse, a, b, psi, psi_by_a, psi_by_b

      inverse = 1.0_dp/film
      root_inverse = inverse*sqrt(film)
      a = rate*root_inverse*velocity
      b = b_rate*inverse*root_inverse
      call piezo_viscous_group(a, b, psi, psi_by_a, psi_by_b)
      if (ieee_is_nan(psi)) then
         load = load_without_film
         load_by_film = 0.0_dp
         load_by_velocity = 0.0_dp
      else
         load = scale*inverse*psi
         load_by_film = -scale*inverse*inverse*(psi + 0.5_dp*a*psi_by_a + 1.5_dp*b*psi_by_b)
         load_by_velocity = scale*inverse*psi_by_a*rate*root_inverse
      end if
   end subroutine reynolds_piezo_viscous_load

end module reynolds_load
