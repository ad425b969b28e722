!> The published piezo-viscous load (37) with the growth exp(-703 w/u) given, for callers that raise many
!> exponentials at once or already know one nearby. (37) is the film-thickness regression (32) turned round.
module piezo_viscous_terms
   use kinds, only: dp
   implicit none(type, external)
   private

   public :: piezo_viscous_terms_load, piezo_viscous_terms_fractions

contains

   !> Load of (37) and its slopes.
   elemental subroutine piezo_viscous_terms_load(coefficient, rate, film, growth, load, load_by_film, &
      load_by_velocity)
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

   !> The same as numerators over one denominator, h^5, for callers that divide but once. Units are those of the load and its
   !> slopes times m^5.
   elemental subroutine piezo_viscous_terms_fractions(coefficient, rate, film, growth, load, load_by_film, load_by_velocity, &
                                                      denominator)
      !> Coefficient of h^(-7/2) [N m^(7/2)]
      real(dp), intent(in) :: coefficient
      !> 703/u [s/m]
      real(dp), intent(in) :: rate
      !> Film thickness h > 0 [m]
      real(dp), intent(in) :: film
      !> exp(-703 w/u) [-]
      real(dp), intent(in) :: growth
      !> Load W h^5 [N m^5]
      real(dp), intent(out) :: load
      !> dW/dh h^5 [N m^4]
      real(dp), intent(out) :: load_by_film
      !> dW/dw h^5 [N s m^4]
      real(dp), intent(out) :: load_by_velocity
      !> h^5 [m^5]
      real(dp), intent(out) :: denominator
      real(dp) :: square, strength

      square = film*film
      denominator = (square*square)*film
      strength = (coefficient*growth)*sqrt(film)
      load = strength*film
      load_by_film = -3.5_dp*strength
      load_by_velocity = -rate*load
   end subroutine piezo_viscous_terms_fractions

end module piezo_viscous_terms
