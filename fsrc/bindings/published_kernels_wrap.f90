! Thin layer between the published film laws and f2py: plain arguments, explicit sizes, no derived
! types. The Python package checks shapes and types before it calls; nothing here repeats a formula.

! Load of (35) and its slopes.
subroutine wrap_half_pi_rupture_load(n, film, velocity, radius, length, speed, viscosity, load, &
   load_by_film, load_by_velocity)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use published_iso_viscous, only: half_pi_rupture_load, rolling_coefficient, squeeze_coefficient
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: film(n)
   real(c_double), intent(in) :: velocity(n)
   real(c_double), intent(in) :: radius(n)
   real(c_double), intent(in) :: length(n)
   real(c_double), intent(in) :: speed(n)
   real(c_double), intent(in) :: viscosity(n)
   real(c_double), intent(out) :: load(n)
   real(c_double), intent(out) :: load_by_film(n)
   real(c_double), intent(out) :: load_by_velocity(n)

   call half_pi_rupture_load( &
      rolling_coefficient(length, speed, viscosity, radius), squeeze_coefficient(length, viscosity, radius), &
      film, velocity, load, load_by_film, load_by_velocity)
end subroutine wrap_half_pi_rupture_load

! Load of (24) with x_e of (18), and its total slopes.
subroutine wrap_solved_rupture_load(n, film, velocity, radius, length, speed, viscosity, load, &
   load_by_film, load_by_velocity)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use published_iso_viscous, only: rolling_coefficient, solved_rupture_load, squeeze_coefficient
   use reynolds_iso_viscous, only: rupture_tangent_fast
   use rupture, only: squeeze_group
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: film(n)
   real(c_double), intent(in) :: velocity(n)
   real(c_double), intent(in) :: radius(n)
   real(c_double), intent(in) :: length(n)
   real(c_double), intent(in) :: speed(n)
   real(c_double), intent(in) :: viscosity(n)
   real(c_double), intent(out) :: load(n)
   real(c_double), intent(out) :: load_by_film(n)
   real(c_double), intent(out) :: load_by_velocity(n)
   real(c_double) :: a(n)

   a = squeeze_group(radius, speed, film, velocity)
   call solved_rupture_load( &
      rolling_coefficient(length, speed, viscosity, radius), squeeze_coefficient(length, viscosity, radius), &
      film, velocity, a, rupture_tangent_fast(a), load, load_by_film, load_by_velocity)
end subroutine wrap_solved_rupture_load

! Stiffness and damping of (26)-(28) with x_e of (18).
subroutine wrap_published_stiffness_damping( &
   n, film, velocity, radius, length, speed, viscosity, stiffness, damping)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use published_iso_viscous, only: published_stiffness_damping, rolling_coefficient, squeeze_coefficient
   use reynolds_iso_viscous, only: rupture_tangent_fast
   use rupture, only: squeeze_group
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: film(n)
   real(c_double), intent(in) :: velocity(n)
   real(c_double), intent(in) :: radius(n)
   real(c_double), intent(in) :: length(n)
   real(c_double), intent(in) :: speed(n)
   real(c_double), intent(in) :: viscosity(n)
   real(c_double), intent(out) :: stiffness(n)
   real(c_double), intent(out) :: damping(n)

   call published_stiffness_damping( &
      rolling_coefficient(length, speed, viscosity, radius), squeeze_coefficient(length, viscosity, radius), &
      film, velocity, rupture_tangent_fast(squeeze_group(radius, speed, film, velocity)), stiffness, damping)
end subroutine wrap_published_stiffness_damping

! Load of (37) and its slopes.
subroutine wrap_published_piezo_load(n, film, velocity, radius, length, speed, viscosity, &
   pressure_viscosity, load, load_by_film, load_by_velocity)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use published_piezo_viscous, only: piezo_coefficient, published_piezo_viscous_load, squeeze_exponent_rate
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: film(n)
   real(c_double), intent(in) :: velocity(n)
   real(c_double), intent(in) :: radius(n)
   real(c_double), intent(in) :: length(n)
   real(c_double), intent(in) :: speed(n)
   real(c_double), intent(in) :: viscosity(n)
   real(c_double), intent(in) :: pressure_viscosity(n)
   real(c_double), intent(out) :: load(n)
   real(c_double), intent(out) :: load_by_film(n)
   real(c_double), intent(out) :: load_by_velocity(n)

   call published_piezo_viscous_load( &
      piezo_coefficient(length, speed, viscosity, radius, pressure_viscosity), squeeze_exponent_rate(speed), &
      film, velocity, load, load_by_film, load_by_velocity)
   ! min(x, limit) of the kernel swallows a NaN.
   where (ieee_is_nan(velocity))
      load = velocity
      load_by_film = velocity
      load_by_velocity = velocity
   end where
end subroutine wrap_published_piezo_load
