!> An oil as its data sheet gives it, at a temperature: kinematic viscosity after Ubbelohde and Walther (ASTM D341), density,
!> dynamic viscosity, and the Barus coefficient after ISO/TR 15144-1.
module oil_data
   use kinds, only: dp
   implicit none(type, external)
   private

   !> Kinematic viscosity from which on ASTM D341 is meant [mm2/s]; above 0.3 its formula holds
   real(dp), parameter, public :: least_viscosity_meant = 2.0_dp

   !> 0 degC [K]
   real(dp), parameter :: zero_celsius = 273.15_dp
   !> What ASTM D341 adds to a kinematic viscosity [mm2/s], and by what a kelvin lowers the density [kg/(m3 K)]
   real(dp), parameter :: shift = 0.7_dp, density_slope = 0.7_dp

   public :: kinematic_viscosity, oil_density, oil_viscosity, oil_pressure_viscosity, viscosity_temperature_slope

contains

   !> Kinematic viscosity nu [mm2/s]: log10 log10(nu + 0.7) is linear in the logarithm of the absolute temperature.
   elemental real(dp) function kinematic_viscosity(at_40, at_100, temperature) result(viscosity)
      !> At 40 and 100 degC, above 0.3 [mm2/s]
      real(dp), intent(in) :: at_40
      real(dp), intent(in) :: at_100
      !> [degC]
      real(dp), intent(in) :: temperature
      !> Colder oil is a solid: 10**251 mm2/s
      real(dp), parameter :: largest = 2.4_dp
      real(dp) :: z_40, z_100, share

      z_40 = walther(at_40)
      z_100 = walther(at_100)
      share = log((temperature + zero_celsius)/(40.0_dp + zero_celsius))/log((100.0_dp + zero_celsius)/(40.0_dp + zero_celsius))
      viscosity = 10.0_dp**(10.0_dp**min(largest, z_40 + share*(z_100 - z_40))) - shift
   end function kinematic_viscosity

   !> Ordinate of ASTM D341, log10 log10(nu + 0.7).
   elemental real(dp) function walther(viscosity)
      !> nu [mm2/s]
      real(dp), intent(in) :: viscosity

      walther = log10(log10(viscosity + shift))
   end function walther

   !> By which share the dynamic viscosity falls with a kelvin, beta = -d ln eta/dT [1/K]: the derivative of both formulas, with
   !> M = d walther/d log10 K, negative. Drag section 15.
   elemental real(dp) function viscosity_temperature_slope(at_40, at_100, density_15, temperature) result(slope)
      !> Kinematic viscosities at 40 and 100 degC [mm2/s]
      real(dp), intent(in) :: at_40
      real(dp), intent(in) :: at_100
      !> Density at 15 degC [kg/m3]
      real(dp), intent(in) :: density_15
      !> [degC]
      real(dp), intent(in) :: temperature
      real(dp) :: m, viscosity

      m = (walther(at_100) - walther(at_40))/log10((100.0_dp + zero_celsius)/(40.0_dp + zero_celsius))
      viscosity = kinematic_viscosity(at_40, at_100, temperature)
      slope = -m*log(viscosity + shift)*(viscosity + shift)/(viscosity*(temperature + zero_celsius)) &
              + density_slope/oil_density(density_15, temperature)
   end function viscosity_temperature_slope

   !> Density rho [kg/m3].
   elemental real(dp) function oil_density(at_15, temperature) result(density)
      !> At 15 degC [kg/m3]
      real(dp), intent(in) :: at_15
      !> [degC]
      real(dp), intent(in) :: temperature

      density = at_15 - density_slope*(temperature - 15.0_dp)
   end function oil_density

   !> Dynamic viscosity eta0 [Pa s].
   elemental real(dp) function oil_viscosity(at_40, at_100, density_15, temperature) result(viscosity)
      !> Kinematic viscosities at 40 and 100 degC [mm2/s]
      real(dp), intent(in) :: at_40
      real(dp), intent(in) :: at_100
      !> Density at 15 degC [kg/m3]
      real(dp), intent(in) :: density_15
      !> [degC]
      real(dp), intent(in) :: temperature

      viscosity = 1.0e-6_dp*kinematic_viscosity(at_40, at_100, temperature)*oil_density(density_15, temperature)
   end function oil_viscosity

   !> Barus coefficient alpha [1/Pa] from that at 38 degC, ISO/TR 15144-1 with 273.15 for its 273; positive below 510 degC.
   elemental real(dp) function oil_pressure_viscosity(base, viscosity_38, temperature) result(pressure_viscosity)
      !> Kind of base oil, a code of scene_types
      integer, intent(in) :: base
      !> Dynamic viscosity at 38 degC [Pa s]
      real(dp), intent(in) :: viscosity_38
      !> [degC]
      real(dp), intent(in) :: temperature
      real(dp), parameter :: factors(3) = [2.657e-8_dp, 1.466e-8_dp, 1.392e-8_dp], &
                             exponents(3) = [0.1348_dp, 0.0507_dp, 0.1572_dp]

      pressure_viscosity = factors(base)*viscosity_38**exponents(base)* &
                           (1.0_dp + 516.0_dp*(1.0_dp/(temperature + zero_celsius) - 1.0_dp/(38.0_dp + zero_celsius)))
   end function oil_pressure_viscosity

end module oil_data
