!> Which lubrication regime a line contact is in (fsrc/THEORY.md, section 9): contact groups of eqs (2) to (4), Grubin's film (33), the
!> regime map of Johnson (1970) and the rule by which a computed film is called iso-viscous, piezo-viscous or elastohydrodynamic.
module regime
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use constants, only: two_pi
   use kinds, only: dp
   implicit none(type, external)
   private

   public :: contact_deflection, hertzian_pressure, grubin_film
   public :: viscosity_group, elasticity_group, film_parameter, limiting_films, mapped_regime, film_regime

   !> Codes of the regime map, in the order of `limiting_films`.
   integer, parameter, public :: map_iso_viscous_rigid = 1, map_piezo_viscous_rigid = 2, &
      map_iso_viscous_elastic = 3, map_piezo_viscous_elastic = 4

   !> Codes of a computed film. Unknown: a number that is negative, not a number, or a film that is not
   !> positive.
   integer, parameter, public :: film_regime_unknown = 0, film_iso_viscous = 1, film_piezo_viscous = 2, &
      film_elastohydrodynamic = 3

   !> alpha p below which a film counts as iso-viscous. At alpha p = 0.1 the Reynolds piezo-viscous load in pure
   !> rolling is 3.2 % above the iso-viscous one.
   real(dp), parameter, public :: iso_viscous_limit = 0.1_dp
   !> alpha p from which no rigid piezo-viscous film exists: the pressure -ln(1 - alpha p)/alpha of eq (31) is
   !> infinite.
   real(dp), parameter, public :: rigid_limit = 1.0_dp
   !> Share of the film by which the surfaces may be pressed in, eq (4), and still count as rigid.
   real(dp), parameter, public :: deflection_limit = 0.1_dp
   !> Stiffness of a steel tooth and its flank by its face width, 14 N/(um mm), ISO 6336-1 [N/m2].
   real(dp), parameter, public :: steel_tooth = 1.4e10_dp

contains

   !> Depth by which a pressure flattens the contact, eq (4): 4 R p^2/E*^2.
   elemental function contact_deflection(radius, pressure, modulus) result(deflection)
      !> R [m]
      real(dp), intent(in) :: radius
      !> Largest pressure that acts on the surfaces [Pa]
      real(dp), intent(in) :: pressure
      !> E* [Pa]
      real(dp), intent(in) :: modulus
      !> delta [m]
      real(dp) :: deflection

      deflection = 4.0_dp*radius*(pressure/modulus)**2
   end function contact_deflection

   !> Largest pressure of a line contact without oil (Hertz) [Pa].
   elemental real(dp) function hertzian_pressure(radius, length, modulus, load)
      !> R and l [m]
      real(dp), intent(in) :: radius
      real(dp), intent(in) :: length
      !> E* [Pa]
      real(dp), intent(in) :: modulus
      !> W [N]
      real(dp), intent(in) :: load

      hertzian_pressure = sqrt(load*modulus/(two_pi*radius*length))
   end function hertzian_pressure

   !> Elastohydrodynamic film of Grubin as printed in eq (33), h0/R = 2.076 u*^0.72 Wbar^-0.091. Its load
   !> group is Wbar = W/(E' R l), not the group of eq (20), and E' = E* of eq (3); its speed is the
   !> entrainment speed.
   elemental function grubin_film( &
      radius, length, speed, viscosity, pressure_viscosity, modulus, load) result(film)
      !> R [m]
      real(dp), intent(in) :: radius
      !> l [m]
      real(dp), intent(in) :: length
      !> Entrainment speed U = (u1 + u2)/2 [m/s]
      real(dp), intent(in) :: speed
      !> eta0 [Pa s]
      real(dp), intent(in) :: viscosity
      !> alpha [1/Pa]
      real(dp), intent(in) :: pressure_viscosity
      !> E* [Pa]
      real(dp), intent(in) :: modulus
      !> W [N]
      real(dp), intent(in) :: load
      !> h0 [m]
      real(dp) :: film

      film = radius*2.076_dp*(speed*viscosity*pressure_viscosity/radius)**0.72_dp &
         *(load/(modulus*radius*length))**(-0.091_dp)
   end function grubin_film

   !> Viscosity group g_v of the regime map.
   elemental function viscosity_group(radius, speed, viscosity, pressure_viscosity, line_load) result(group)
      !> R [m]
      real(dp), intent(in) :: radius
      !> Entrainment speed U [m/s]
      real(dp), intent(in) :: speed
      !> eta0 [Pa s]
      real(dp), intent(in) :: viscosity
      !> alpha [1/Pa]
      real(dp), intent(in) :: pressure_viscosity
      !> w = W/l [N/m]
      real(dp), intent(in) :: line_load
      !> g_v [-]
      real(dp) :: group

      group = pressure_viscosity*(line_load/radius)*sqrt(line_load/(viscosity*speed))
   end function viscosity_group

   !> Elasticity group g_e of the regime map.
   elemental function elasticity_group(radius, speed, viscosity, modulus, line_load) result(group)
      !> R [m]
      real(dp), intent(in) :: radius
      !> Entrainment speed U [m/s]
      real(dp), intent(in) :: speed
      !> eta0 [Pa s]
      real(dp), intent(in) :: viscosity
      !> E* [Pa]
      real(dp), intent(in) :: modulus
      !> w = W/l [N/m]
      real(dp), intent(in) :: line_load
      !> g_e [-]
      real(dp) :: group

      group = line_load/sqrt(viscosity*speed*modulus*radius)
   end function elasticity_group

   !> Film parameter h^ of the regime map.
   elemental function film_parameter(radius, speed, viscosity, line_load, film) result(value)
      !> R [m]
      real(dp), intent(in) :: radius
      !> Entrainment speed U [m/s]
      real(dp), intent(in) :: speed
      !> eta0 [Pa s]
      real(dp), intent(in) :: viscosity
      !> w = W/l [N/m]
      real(dp), intent(in) :: line_load
      !> h0 [m]
      real(dp), intent(in) :: film
      !> h^ [-]
      real(dp) :: value

      value = film*line_load/(viscosity*speed*radius)
   end function film_parameter

   !> The four limiting films of the map, in the order of the map's codes.
   pure function limiting_films(g_viscosity, g_elasticity) result(films)
      !> g_v >= 0 [-]
      real(dp), intent(in) :: g_viscosity
      !> g_e >= 0 [-]
      real(dp), intent(in) :: g_elasticity
      !> h^ of each limit [-]
      real(dp) :: films(4)

      films(map_iso_viscous_rigid) = 4.9_dp
      films(map_piezo_viscous_rigid) = 1.66_dp*g_viscosity**(2.0_dp/3.0_dp)
      films(map_iso_viscous_elastic) = 3.10_dp*g_elasticity**0.8_dp
      films(map_piezo_viscous_elastic) = 2.65_dp*g_viscosity**0.54_dp*g_elasticity**0.06_dp
   end function limiting_films

   !> Regime of a point of the map: the limit with the largest film; of equal ones the first.
   elemental function mapped_regime(g_viscosity, g_elasticity) result(code)
      !> g_v >= 0 [-]
      real(dp), intent(in) :: g_viscosity
      !> g_e >= 0 [-]
      real(dp), intent(in) :: g_elasticity
      !> One of map_..., 0 where a group is negative or not a number
      integer :: code

      code = 0
      if (ieee_is_nan(g_viscosity) .or. ieee_is_nan(g_elasticity)) return
      if (min(g_viscosity, g_elasticity) < 0.0_dp) return
      code = maxloc(limiting_films(g_viscosity, g_elasticity), dim=1)
   end function mapped_regime

   !> Regime of a computed film. The pressure is that of the constant-viscosity film, the p of eq (31): it
   !> stays finite where the piezo-viscous pressure does not exist.
   elemental function film_regime(alpha_p_maximum, deflection, film) result(code)
      !> alpha times the largest constant-viscosity pressure [-]
      real(dp), intent(in) :: alpha_p_maximum
      !> delta of eq (4) [m]; read only below alpha p = 1
      real(dp), intent(in) :: deflection
      !> Thinnest film [m]
      real(dp), intent(in) :: film
      !> One of film_...
      integer :: code

      code = film_regime_unknown
      if (ieee_is_nan(alpha_p_maximum) .or. ieee_is_nan(film)) return
      if (alpha_p_maximum < 0.0_dp .or. film <= 0.0_dp) return
      if (alpha_p_maximum >= rigid_limit) then
         code = film_elastohydrodynamic
         return
      end if
      if (ieee_is_nan(deflection)) return
      if (deflection < 0.0_dp) return
      if (deflection > deflection_limit*film) then
         code = film_elastohydrodynamic
      else if (alpha_p_maximum >= iso_viscous_limit) then
         code = film_piezo_viscous
      else
         code = film_iso_viscous
      end if
   end function film_regime

end module regime
