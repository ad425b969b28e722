!> The published piezo-viscous film: load (37) with the contact length as a factor and the squeeze velocity
!> (printed: the acceleration) in the exponent; it is the film-thickness regression (32) inverted.
module published_piezo_viscous
   use elementary_functions, only: exponential, largest_exponent
   use kinds, only: dp
   implicit none(type, external)
   private

   !> Factors as printed in (37); (32) gives 12*0.787^2.5 = 6.5935 and 2.5*281.2 = 703.
   real(dp), parameter :: load_factor = 6.6_dp, squeeze_factor = 703.0_dp

   public :: piezo_coefficient, published_piezo_viscous_load, piezo_viscous_terms_load, squeeze_exponent_rate, squeeze_growth

contains

   !> Coefficient of h^(-7/2) in (37) [N m^(7/2)].
   elemental real(dp) function piezo_coefficient(length, speed, viscosity, radius, pressure_viscosity)
      !> Contact length l [m]
      real(dp), intent(in) :: length
      !> Speed u [m/s]
      real(dp), intent(in) :: speed
      !> Viscosity eta0 [Pa s]
      real(dp), intent(in) :: viscosity
      !> Equivalent radius R [m]
      real(dp), intent(in) :: radius
      !> Barus coefficient alpha [1/Pa]
      real(dp), intent(in) :: pressure_viscosity

      piezo_coefficient = load_factor*length*(speed*viscosity)**2.75_dp*(radius*pressure_viscosity)**1.75_dp
   end function piezo_coefficient

   !> Factor 703/u of the film velocity in the exponent of (37) [s/m].
   elemental real(dp) function squeeze_exponent_rate(speed)
      !> Speed u [m/s]
      real(dp), intent(in) :: speed

      squeeze_exponent_rate = squeeze_factor/speed
   end function squeeze_exponent_rate

   !> exp(-703 w/u) of (37) [-], for loops over many states; a single one is faster by the library.
   elemental real(dp) function squeeze_growth(rate, velocity)
      !> 703/u [s/m]
      real(dp), intent(in) :: rate
      !> Film velocity w = dh/dt [m/s]
      real(dp), intent(in) :: velocity

      squeeze_growth = exponential(-rate*velocity)
   end function squeeze_growth

   !> Load of (37) and its slopes.
   elemental subroutine published_piezo_viscous_load(coefficient, rate, film, velocity, load, load_by_film, load_by_velocity)
      !> Coefficient of h^(-7/2) [N m^(7/2)]
      real(dp), intent(in) :: coefficient
      !> 703/u [s/m]
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

      ! Beyond its border the exponential is held there, far above the load by which the motion knows that the law has no value.
      call piezo_viscous_terms_load(coefficient, rate, film, exp(min(-rate*velocity, largest_exponent)), load, &
                                    load_by_film, load_by_velocity)
   end subroutine published_piezo_viscous_load

   !> The same with the growth exp(-703 w/u) given, for callers that raise many exponentials at once.
   elemental subroutine piezo_viscous_terms_load(coefficient, rate, film, growth, load, load_by_film, load_by_velocity)
      !> Coefficient of h^(-7/2) [N m^(7/2)]
      real(dp), intent(in) :: coefficient
      !> 703/u [s/m]
      real(dp), intent(in) :: rate
      !> Film thickness h > 0 [m]
      real(dp), intent(in) :: film
      !> exp(-703 w/u) [-]
      real(dp), intent(in) :: growth
      !> Load W [N]
      real(dp), intent(out) :: load
      !> dW/dh [N/m]
      real(dp), intent(out) :: load_by_film
      !> dW/dw [N s/m]
      real(dp), intent(out) :: load_by_velocity
      real(dp) :: inverse, inverse_2

      ! h^(-7/2) as h^(-4) sqrt(h): root and division run side by side.
      inverse = 1.0_dp/film
      inverse_2 = inverse*inverse
      load = (inverse_2*inverse_2)*(coefficient*sqrt(film))*growth
      load_by_film = -3.5_dp*load*inverse
      load_by_velocity = -rate*load
   end subroutine piezo_viscous_terms_load

end module published_piezo_viscous
