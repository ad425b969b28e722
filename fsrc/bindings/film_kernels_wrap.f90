! Thin layer between the kernels of the Reynolds film and f2py: plain arguments, explicit sizes, no derived
! types. The Python package checks shapes and types before it calls; nothing here repeats a formula.

! t_e(A) of (18); by_substitution /= 0: the paper's successive substitution.
subroutine wrap_rupture_tangent(n, a, by_substitution, t)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use reynolds_iso_viscous, only: rupture_tangent_fast
   use rupture, only: rupture_tangent_successive
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: a(n)
   integer(c_int), intent(in) :: by_substitution
   real(c_double), intent(out) :: t(n)

   if (by_substitution /= 0) then
      t = rupture_tangent_successive(a)
   else
      t = rupture_tangent_fast(a)
   end if
end subroutine wrap_rupture_tangent

! x_e(A) of (18).
subroutine wrap_rupture_angle(n, a, x)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use reynolds_iso_viscous, only: rupture_angle
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: a(n)
   real(c_double), intent(out) :: x(n)

   x = rupture_angle(a)
end subroutine wrap_rupture_angle

! dt_e/dA of (18).
subroutine wrap_rupture_tangent_slope(n, a, slope)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use reynolds_iso_viscous, only: rupture_tangent_slope
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: a(n)
   real(c_double), intent(out) :: slope(n)

   slope = rupture_tangent_slope(a)
end subroutine wrap_rupture_tangent_slope

! Phi(A) and its slope, the exact (21).
subroutine wrap_iso_viscous_load(n, a, phi, dphi_da)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use reynolds_iso_viscous, only: iso_viscous_load_array
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: a(n)
   real(c_double), intent(out) :: phi(n)
   real(c_double), intent(out) :: dphi_da(n)

   call iso_viscous_load_array(n, a, phi, dphi_da)
end subroutine wrap_iso_viscous_load

! Psi(A, B) and its slopes.
subroutine wrap_piezo_viscous_load(n, a, b, psi, dpsi_da, dpsi_db)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use reynolds_piezo_viscous, only: piezo_viscous_load_array
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: a(n)
   real(c_double), intent(in) :: b(n)
   real(c_double), intent(out) :: psi(n)
   real(c_double), intent(out) :: dpsi_da(n)
   real(c_double), intent(out) :: dpsi_db(n)

   call piezo_viscous_load_array(n, a, b, psi, dpsi_da, dpsi_db)
end subroutine wrap_piezo_viscous_load

! B_crit(A).
subroutine wrap_critical_pressure_group(n, a, critical)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use reynolds_piezo_viscous, only: critical_pressure_group
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: a(n)
   real(c_double), intent(out) :: critical(n)

   critical = critical_pressure_group(a)
end subroutine wrap_critical_pressure_group

! Load of the Reynolds iso-viscous film in SI units and its total slopes.
subroutine wrap_reynolds_iso_viscous_load( &
   n, film, velocity, radius, length, speed, viscosity, load, load_by_film, load_by_velocity)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use reynolds_load, only: load_scale, reynolds_iso_viscous_load, squeeze_rate
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

   call reynolds_iso_viscous_load( &
      load_scale(length, speed, viscosity, radius), squeeze_rate(speed, radius), film, velocity, &
      load, load_by_film, load_by_velocity)
end subroutine wrap_reynolds_iso_viscous_load

! Load of the Reynolds piezo-viscous film in SI units and its total slopes. The kernel marks the absence of a
! rigid film by a load without slopes, NaN marks it here.
subroutine wrap_reynolds_piezo_viscous_load( &
   n, film, velocity, radius, length, speed, viscosity, pressure_viscosity, load, load_by_film, load_by_velocity)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use reynolds_load, only: load_scale, load_without_film, pressure_rate, reynolds_piezo_viscous_load, squeeze_rate
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

   call reynolds_piezo_viscous_load( &
      load_scale(length, speed, viscosity, radius), squeeze_rate(speed, radius), &
      pressure_rate(speed, viscosity, radius, pressure_viscosity), film, velocity, &
      load, load_by_film, load_by_velocity)
   where (.not. load < load_without_film)
      load = ieee_value(1.0_c_double, ieee_quiet_nan)
      load_by_film = ieee_value(1.0_c_double, ieee_quiet_nan)
      load_by_velocity = ieee_value(1.0_c_double, ieee_quiet_nan)
   end where
end subroutine wrap_reynolds_piezo_viscous_load

! h* at which alpha p = 1.
subroutine wrap_limiting_film_ratio(n, speed_group, squeeze_ratio, film_ratio)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use film_pressure, only: limiting_film_ratio
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: speed_group(n)
   real(c_double), intent(in) :: squeeze_ratio(n)
   real(c_double), intent(out) :: film_ratio(n)

   film_ratio = limiting_film_ratio(speed_group, squeeze_ratio)
end subroutine wrap_limiting_film_ratio

! A of a film in SI units.
subroutine wrap_squeeze_group(n, radius, speed, film, velocity, a)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use rupture, only: squeeze_group
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: radius(n)
   real(c_double), intent(in) :: speed(n)
   real(c_double), intent(in) :: film(n)
   real(c_double), intent(in) :: velocity(n)
   real(c_double), intent(out) :: a(n)

   a = squeeze_group(radius, speed, film, velocity)
end subroutine wrap_squeeze_group

! p/p* of (12) [Pa].
subroutine wrap_pressure_scale(n, radius, speed, viscosity, film, scale)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use film_pressure, only: pressure_scale
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: radius(n)
   real(c_double), intent(in) :: speed(n)
   real(c_double), intent(in) :: viscosity(n)
   real(c_double), intent(in) :: film(n)
   real(c_double), intent(out) :: scale(n)

   scale = pressure_scale(radius, speed, viscosity, film)
end subroutine wrap_pressure_scale

! p*(xbar) of (16) at t = tan(xbar).
subroutine wrap_pressure_group(n, t, t_rupture, a, p)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use film_pressure, only: pressure_group
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: t(n)
   real(c_double), intent(in) :: t_rupture(n)
   real(c_double), intent(in) :: a(n)
   real(c_double), intent(out) :: p(n)

   p = pressure_group(t, t_rupture, a)
end subroutine wrap_pressure_group

! alpha q of (31); the kernel marks the absence of a rigid film by a huge number, NaN marks it here.
subroutine wrap_barus_pressure(n, alpha_p, alpha_q)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use film_pressure, only: barus_pressure
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: alpha_p(n)
   real(c_double), intent(out) :: alpha_q(n)

   alpha_q = barus_pressure(alpha_p)
   where (.not. alpha_p < 1.0_c_double) alpha_q = ieee_value(1.0_c_double, ieee_quiet_nan)
end subroutine wrap_barus_pressure

! Groups of a film in SI units for the numerical Reynolds solver: u/v, squeeze group, B, alpha p_r, Roelands'
! logarithm; then the scales of pressure [Pa] and line load [N/m].
subroutine wrap_scale_film(si, groups, scales)
   use, intrinsic :: iso_c_binding, only: c_double
   use numerical_reynolds, only: scale_film
   use numerical_reynolds_grid, only: film_problem_t
   implicit none
   real(c_double), intent(in) :: si(6)
   real(c_double), intent(out) :: groups(5)
   real(c_double), intent(out) :: scales(2)
   type(film_problem_t) :: problem

   call scale_film(si(1), si(2), si(3), si(4), si(5), si(6), problem, scales(1), scales(2))
   groups = [problem%rolling, problem%squeeze, problem%pressure_group, problem%roelands_pressure, &
             problem%roelands_logarithm]
end subroutine wrap_scale_film

! Numerical solution of one film on m - 1 cells; groups as above. results: load, its correction, largest q*,
! rupture angle; counts: status, Newton steps. Without a solution the numbers are NaN.
subroutine wrap_solve_reynolds(groups, law, extrapolate, m, angle, pressure, results, counts)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use numerical_reynolds, only: film_solution_t, solve_reynolds
   use numerical_reynolds_grid, only: film_problem_t
   use numerical_reynolds_rupture, only: reynolds_converged
   implicit none
   real(c_double), intent(in) :: groups(5)
   integer(c_int), intent(in) :: law
   integer(c_int), intent(in) :: extrapolate
   integer(c_int), intent(in) :: m
   real(c_double), intent(out) :: angle(m)
   real(c_double), intent(out) :: pressure(m)
   real(c_double), intent(out) :: results(4)
   integer(c_int), intent(out) :: counts(2)
   type(film_solution_t) :: solution

   angle = ieee_value(1.0_c_double, ieee_quiet_nan)
   pressure = angle
   results = ieee_value(1.0_c_double, ieee_quiet_nan)
   call solve_reynolds(film_problem_t(groups(1), groups(2), groups(3), law, groups(4), groups(5)), m - 1, &
                       extrapolate /= 0, solution)
   counts = [solution%status, solution%iterations]
   if (allocated(solution%angle)) angle = solution%angle
   if (solution%status /= reynolds_converged) return
   pressure = solution%pressure
   results = [solution%load, solution%load_correction, solution%maximum_pressure, solution%rupture_angle]
end subroutine wrap_solve_reynolds
