!> Tests of the contact groups, Grubin's film, the regime map and the regime of a computed film.
module test_regime
   use, intrinsic :: ieee_arithmetic, only: ieee_positive_inf, ieee_quiet_nan, ieee_value
   use checks, only: check_list_t
   use flank_elasticity, only: equivalent_radius, plane_strain_modulus
   use kinds, only: dp
   use regime, only: contact_deflection, elasticity_group, film_elastohydrodynamic, film_iso_viscous, film_parameter, &
      film_piezo_viscous, film_regime, film_regime_unknown, grubin_film, limiting_films, map_iso_viscous_elastic, &
      map_iso_viscous_rigid, map_piezo_viscous_elastic, map_piezo_viscous_rigid, mapped_regime, viscosity_group
   implicit none(type, external)
   private

   public :: run_regime_tests

   real(dp), parameter :: rounding = 1.0e-13_dp

   !> A steel contact: R [m], l [m], U [m/s], eta0 [Pa s], alpha [1/Pa], E* [Pa].
   real(dp), parameter :: radius = 0.0127_dp, length = 0.01_dp, speed = 1.905_dp, viscosity = 0.3_dp, &
      pressure_viscosity = 2.0e-8_dp, modulus = 226.0e9_dp

contains

   !> Runs every test of this topic.
   subroutine run_regime_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('regime')
      call test_contact(checks)
      call test_map(checks)
      call test_exact_limits(checks)
      call test_film(checks)
   end subroutine run_regime_tests

   !> Equations (2), (3), (4) and (33).
   subroutine test_contact(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: film

      call checks%check_close(equivalent_radius(0.03_dp, 0.06_dp), 0.02_dp, rounding, &
         'radius of two cylinders')
      call checks%check_close(equivalent_radius(0.03_dp, -0.06_dp), 0.06_dp, rounding, &
         'radius, hollow surface')
      call checks%check_close(equivalent_radius(0.03_dp, ieee_value(0.0_dp, ieee_positive_inf)), 0.03_dp, &
         rounding, &
         'radius over a plane')
      call checks%check_close(plane_strain_modulus(205.66e9_dp, 0.3_dp)/226.0e9_dp, 1.0_dp, 1.0e-14_dp, &
         'plane-strain modulus of steel')
      call checks%check_close(contact_deflection(radius, 2.0e8_dp, modulus), 3.978385151538883e-8_dp, &
         1.0e-20_dp, &
         'deflection at 200 MPa')
      film = grubin_film(radius, length, speed, viscosity, pressure_viscosity, modulus, 1.0e4_dp)
      call checks%check_close(film*1.0e6_dp, 2.41410238_dp, 1.0e-8_dp, 'film of Grubin')
      call checks%check_close( &
         grubin_film(radius, length, speed, viscosity, pressure_viscosity, modulus, 2.0e4_dp)/film, &
         2.0_dp**(-0.091_dp), rounding, 'film of Grubin: load exponent')
      call checks%check_close( &
         grubin_film(radius, length, 2.0_dp*speed, viscosity, pressure_viscosity, modulus, 1.0e4_dp)/film, &
         2.0_dp**0.72_dp, rounding, 'film of Grubin: speed exponent')
   end subroutine test_contact

   !> Every corner of the map, its borders, and points that lie nowhere.
   subroutine test_map(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: nan, films(4), line_load

      nan = ieee_value(0.0_dp, ieee_quiet_nan)
      call checks%check(mapped_regime(0.0_dp, 0.0_dp) == map_iso_viscous_rigid, 'map: origin')
      call checks%check(mapped_regime(1.0_dp, 0.5_dp) == map_iso_viscous_rigid, 'map: rigid, iso-viscous')
      call checks%check(mapped_regime(100.0_dp, 0.5_dp) == map_piezo_viscous_rigid, &
         'map: rigid, piezo-viscous')
      call checks%check(mapped_regime(0.1_dp, 10.0_dp) == map_iso_viscous_elastic, &
         'map: elastic, iso-viscous')
      call checks%check(mapped_regime(100.0_dp, 20.0_dp) == map_piezo_viscous_elastic, &
         'map: elastic, piezo-viscous')
      call checks%check(mapped_regime(-1.0_dp, 1.0_dp) == 0, 'map: negative group')
      call checks%check(mapped_regime(nan, 1.0_dp) == 0 .and. mapped_regime(1.0_dp, nan) == 0, &
         'map: no number')
      call checks%check(mapped_regime(1.001_dp*(4.9_dp/1.66_dp)**1.5_dp, 0.0_dp) == map_piezo_viscous_rigid, &
         'map: beyond the border of the rigid regimes')
      call checks%check(mapped_regime(0.999_dp*(4.9_dp/1.66_dp)**1.5_dp, 0.0_dp) == map_iso_viscous_rigid, &
         'map: before the border of the rigid regimes')

      ! The last limit is Dowson's minimum film h/R = 2.65 U^0.7 G^0.54 W^-0.13, in its own groups.
      line_load = 1.0e5_dp
      films = limiting_films(viscosity_group(radius, speed, viscosity, pressure_viscosity, line_load), &
         elasticity_group(radius, speed, viscosity, modulus, line_load))
      call checks%check_close(films(map_piezo_viscous_elastic)/film_parameter(radius, speed, viscosity, &
         line_load, &
         radius*2.65_dp*(viscosity*speed/(modulus*radius))**0.7_dp*(pressure_viscosity*modulus)**0.54_dp &
         *(line_load/(modulus*radius))**(-0.13_dp)), 1.0_dp, 1.0e-12_dp, 'map: the film of Dowson')
   end subroutine test_map

   !> The rigid limits are the rounded values of the Reynolds film: 24 Phi(0) = 4.895 and, at the critical group
   !> in pure rolling, (12 sqrt(2)/B_crit(0))^(2/3) = 1.666.
   subroutine test_exact_limits(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: load_group = 0.2039570205797237_dp, critical_group = 7.889828622697975_dp
      real(dp) :: films(4)

      films = limiting_films(1.0_dp, 1.0_dp)
      call checks%check_close(films(map_iso_viscous_rigid), 24.0_dp*load_group, 0.006_dp, 'limit of Martin')
      call checks%check_close(films(map_piezo_viscous_rigid), &
         (12.0_dp*sqrt(2.0_dp)/critical_group)**(2.0_dp/3.0_dp), 0.007_dp, 'limit of Blok')
   end subroutine test_exact_limits

   !> Limits of the rule for computed films, and numbers it must not classify.
   subroutine test_film(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: film = 1.0e-6_dp, shallow = 0.05e-6_dp, deep = 0.2e-6_dp
      real(dp) :: nan, infinity

      nan = ieee_value(0.0_dp, ieee_quiet_nan)
      infinity = ieee_value(0.0_dp, ieee_positive_inf)
      call checks%check(film_regime(0.0_dp, 0.0_dp, film) == film_iso_viscous, 'film: no pressure')
      call checks%check(film_regime(0.0999_dp, shallow, film) == film_iso_viscous, 'film: alpha p below 0.1')
      call checks%check(film_regime(0.1_dp, shallow, film) == film_piezo_viscous, 'film: alpha p = 0.1')
      call checks%check(film_regime(0.999_dp, shallow, film) == film_piezo_viscous, 'film: alpha p below 1')
      call checks%check(film_regime(1.0_dp, shallow, film) == film_elastohydrodynamic, 'film: alpha p = 1')
      call checks%check(film_regime(infinity, nan, film) == film_elastohydrodynamic, 'film: no rigid film')
      call checks%check(film_regime(0.01_dp, deep, film) == film_elastohydrodynamic, &
         'film: deep, low alpha p')
      call checks%check(film_regime(0.5_dp, deep, film) == film_elastohydrodynamic, 'film: deep')
      call checks%check(film_regime(0.05_dp, 0.1_dp, 1.0_dp) == film_iso_viscous, &
         'film: at the deflection limit')
      call checks%check(film_regime(0.05_dp, 0.1001_dp, 1.0_dp) == film_elastohydrodynamic, &
         'film: just beyond the deflection limit')
      call checks%check(film_regime(nan, shallow, film) == film_regime_unknown, 'film: pressure no number')
      call checks%check(film_regime(0.5_dp, nan, film) == film_regime_unknown, 'film: deflection no number')
      call checks%check(film_regime(0.5_dp, shallow, nan) == film_regime_unknown, 'film: film no number')
      call checks%check(film_regime(-0.1_dp, shallow, film) == film_regime_unknown, 'film: negative pressure')
      call checks%check(film_regime(0.5_dp, shallow, 0.0_dp) == film_regime_unknown, 'film: no film')
      call checks%check(film_regime(0.5_dp, -shallow, film) == film_regime_unknown, &
         'film: negative deflection')
   end subroutine test_film

end module test_regime
