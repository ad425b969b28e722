! Thin layer between the kernels of contact and regime and f2py: plain arguments, explicit sizes, no derived
! types. The Python package checks shapes and types before it calls; nothing here repeats a formula.

! R of (2).
subroutine wrap_equivalent_radius(n, radius_1, radius_2, radius)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use flank_elasticity, only: equivalent_radius
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: radius_1(n)
   real(c_double), intent(in) :: radius_2(n)
   real(c_double), intent(out) :: radius(n)

   radius = equivalent_radius(radius_1, radius_2)
end subroutine wrap_equivalent_radius

! E* of (3).
subroutine wrap_plane_strain_modulus(n, young_modulus, poisson_ratio, modulus)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use flank_elasticity, only: plane_strain_modulus
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: young_modulus(n)
   real(c_double), intent(in) :: poisson_ratio(n)
   real(c_double), intent(out) :: modulus(n)

   modulus = plane_strain_modulus(young_modulus, poisson_ratio)
end subroutine wrap_plane_strain_modulus

! delta of (4).
subroutine wrap_contact_deflection(n, radius, pressure, modulus, deflection)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use regime, only: contact_deflection
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: radius(n)
   real(c_double), intent(in) :: pressure(n)
   real(c_double), intent(in) :: modulus(n)
   real(c_double), intent(out) :: deflection(n)

   deflection = contact_deflection(radius, pressure, modulus)
end subroutine wrap_contact_deflection

! h0 of (33).
subroutine wrap_grubin_film(n, radius, length, speed, viscosity, pressure_viscosity, modulus, load, film)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use regime, only: grubin_film
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: radius(n)
   real(c_double), intent(in) :: length(n)
   real(c_double), intent(in) :: speed(n)
   real(c_double), intent(in) :: viscosity(n)
   real(c_double), intent(in) :: pressure_viscosity(n)
   real(c_double), intent(in) :: modulus(n)
   real(c_double), intent(in) :: load(n)
   real(c_double), intent(out) :: film(n)

   film = grubin_film(radius, length, speed, viscosity, pressure_viscosity, modulus, load)
end subroutine wrap_grubin_film

! g_v of the regime map.
subroutine wrap_viscosity_group(n, radius, speed, viscosity, pressure_viscosity, line_load, group)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use regime, only: viscosity_group
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: radius(n)
   real(c_double), intent(in) :: speed(n)
   real(c_double), intent(in) :: viscosity(n)
   real(c_double), intent(in) :: pressure_viscosity(n)
   real(c_double), intent(in) :: line_load(n)
   real(c_double), intent(out) :: group(n)

   group = viscosity_group(radius, speed, viscosity, pressure_viscosity, line_load)
end subroutine wrap_viscosity_group

! g_e of the regime map.
subroutine wrap_elasticity_group(n, radius, speed, viscosity, modulus, line_load, group)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use regime, only: elasticity_group
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: radius(n)
   real(c_double), intent(in) :: speed(n)
   real(c_double), intent(in) :: viscosity(n)
   real(c_double), intent(in) :: modulus(n)
   real(c_double), intent(in) :: line_load(n)
   real(c_double), intent(out) :: group(n)

   group = elasticity_group(radius, speed, viscosity, modulus, line_load)
end subroutine wrap_elasticity_group

! Film parameter of the regime map.
subroutine wrap_film_parameter(n, radius, speed, viscosity, line_load, film, parameter)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use regime, only: film_parameter
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: radius(n)
   real(c_double), intent(in) :: speed(n)
   real(c_double), intent(in) :: viscosity(n)
   real(c_double), intent(in) :: line_load(n)
   real(c_double), intent(in) :: film(n)
   real(c_double), intent(out) :: parameter(n)

   parameter = film_parameter(radius, speed, viscosity, line_load, film)
end subroutine wrap_film_parameter

! The four limiting films of the regime map, in the order of its codes.
subroutine wrap_limiting_films(n, g_viscosity, g_elasticity, first, second, third, fourth)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use regime, only: limiting_films
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: g_viscosity(n)
   real(c_double), intent(in) :: g_elasticity(n)
   real(c_double), intent(out) :: first(n)
   real(c_double), intent(out) :: second(n)
   real(c_double), intent(out) :: third(n)
   real(c_double), intent(out) :: fourth(n)
   real(c_double) :: films(4)
   integer :: i

   do i = 1, n
      films = limiting_films(g_viscosity(i), g_elasticity(i))
      first(i) = films(1)
      second(i) = films(2)
      third(i) = films(3)
      fourth(i) = films(4)
   end do
end subroutine wrap_limiting_films

! Code of the regime map.
subroutine wrap_mapped_regime(n, g_viscosity, g_elasticity, code)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use regime, only: mapped_regime
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: g_viscosity(n)
   real(c_double), intent(in) :: g_elasticity(n)
   integer(c_int), intent(out) :: code(n)

   code = mapped_regime(g_viscosity, g_elasticity)
end subroutine wrap_mapped_regime

! Code of the regime of a computed film.
subroutine wrap_film_regime(n, alpha_p_maximum, deflection, film, code)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use regime, only: film_regime
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: alpha_p_maximum(n)
   real(c_double), intent(in) :: deflection(n)
   real(c_double), intent(in) :: film(n)
   integer(c_int), intent(out) :: code(n)

   code = film_regime(alpha_p_maximum, deflection, film)
end subroutine wrap_film_regime
