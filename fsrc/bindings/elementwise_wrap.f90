! Thin layer between kernels of numbers and f2py: a kernel by its name, its k arguments and its results as columns of n numbers.
! The functions of scripts/rattle/kernels name the arguments, check shapes and types; nothing here repeats a formula.
subroutine wrap_kernel(name, n, k, v, results, count)
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_quiet_nan, ieee_value
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use film_fit, only: law_film_ratio, thickness_law_t
   use film_pressure, only: barus_pressure, limiting_film_ratio, pressure_group, pressure_scale
   use flank_elasticity, only: equivalent_radius, plane_strain_modulus
   use published_iso_viscous, only: half_pi_rupture_load, published_stiffness_damping, rolling_coefficient, solved_rupture_load, &
      squeeze_coefficient
   use published_piezo_viscous, only: piezo_coefficient, published_piezo_viscous_load, squeeze_exponent_rate
   use regime, only: contact_deflection, elasticity_group, film_parameter, film_regime, grubin_film, limiting_films, &
      mapped_regime, viscosity_group
   use reynolds_iso_viscous, only: iso_viscous_load_array, rupture_angle, rupture_tangent_fast, rupture_tangent_slope
   use reynolds_load, only: load_scale, load_without_film, pressure_rate, reynolds_iso_viscous_load, reynolds_piezo_viscous_load, &
      squeeze_rate
   use reynolds_piezo_viscous, only: critical_pressure_group, piezo_viscous_load_array
   use rupture, only: rupture_tangent_successive, squeeze_group
   implicit none
   character(*), intent(in) :: name
   integer(c_int), intent(in) :: n
   integer(c_int), intent(in) :: k
   real(c_double), intent(in) :: v(n, k)
   real(c_double), intent(out) :: results(n, 4)
   ! How many results there are; -1: one, a code; 0: no kernel has this name
   integer(c_int), intent(out) :: count
   real(c_double) :: a(n)
   integer :: i

   results = ieee_value(1.0_c_double, ieee_quiet_nan)
   count = 1
   select case (name)
   case ('rupture_tangent')
      results(:, 1) = rupture_tangent_fast(v(:, 1))
   case ('rupture_tangent_successive')
      results(:, 1) = rupture_tangent_successive(v(:, 1))
   case ('rupture_angle')
      results(:, 1) = rupture_angle(v(:, 1))
   case ('rupture_tangent_slope')
      results(:, 1) = rupture_tangent_slope(v(:, 1))
   case ('iso_viscous_load')
      count = 2
      call iso_viscous_load_array(n, v(:, 1), results(:, 1), results(:, 2))
   case ('piezo_viscous_load')
      count = 3
      call piezo_viscous_load_array(n, v(:, 1), v(:, 2), results(:, 1), results(:, 2), results(:, 3))
   case ('critical_pressure_group')
      results(:, 1) = critical_pressure_group(v(:, 1))
   case ('limiting_film_ratio')
      results(:, 1) = limiting_film_ratio(v(:, 1), v(:, 2))
   case ('squeeze_group')
      results(:, 1) = squeeze_group(v(:, 1), v(:, 2), v(:, 3), v(:, 4))
   case ('pressure_scale')
      results(:, 1) = pressure_scale(v(:, 1), v(:, 2), v(:, 3), v(:, 4))
   case ('pressure_group')
      results(:, 1) = pressure_group(v(:, 1), v(:, 2), v(:, 3))
   case ('barus_pressure')
      ! The kernel marks the absence of a rigid film by a huge number, NaN marks it here.
      where (v(:, 1) < 1.0_c_double) results(:, 1) = barus_pressure(v(:, 1))
   case ('equivalent_radius')
      results(:, 1) = equivalent_radius(v(:, 1), v(:, 2))
   case ('plane_strain_modulus')
      results(:, 1) = plane_strain_modulus(v(:, 1), v(:, 2))
   case ('contact_deflection')
      results(:, 1) = contact_deflection(v(:, 1), v(:, 2), v(:, 3))
   case ('grubin_film')
      results(:, 1) = grubin_film(v(:, 1), v(:, 2), v(:, 3), v(:, 4), v(:, 5), v(:, 6), v(:, 7))
   case ('viscosity_group')
      results(:, 1) = viscosity_group(v(:, 1), v(:, 2), v(:, 3), v(:, 4), v(:, 5))
   case ('elasticity_group')
      results(:, 1) = elasticity_group(v(:, 1), v(:, 2), v(:, 3), v(:, 4), v(:, 5))
   case ('film_parameter')
      results(:, 1) = film_parameter(v(:, 1), v(:, 2), v(:, 3), v(:, 4), v(:, 5))
   case ('limiting_films')
      count = 4
      do i = 1, n
         results(i, :) = limiting_films(v(i, 1), v(i, 2))
      end do
   case ('mapped_regime')
      count = -1
      results(:, 1) = real(mapped_regime(v(:, 1), v(:, 2)), c_double)
   case ('film_regime')
      count = -1
      results(:, 1) = real(film_regime(v(:, 1), v(:, 2), v(:, 3)), c_double)
   case ('law_film_ratio')
      results(:, 1) = law_film_ratio(thickness_law_t(v(1, 1), v(1, 2), v(1, 3), v(1, 4)), v(:, 5), v(:, 6), v(:, 7))
   case ('half_pi_rupture_load', 'solved_rupture_load', 'published_stiffness_damping', 'published_piezo_load', &
         'reynolds_iso_viscous_load', 'reynolds_piezo_viscous_load')
      count = 3
      associate (film => v(:, 1), velocity => v(:, 2), radius => v(:, 3), length => v(:, 4), speed => v(:, 5), &
                 viscosity => v(:, 6), load => results(:, 1), by_film => results(:, 2), by_velocity => results(:, 3))
         a = squeeze_group(radius, speed, film, velocity)
         select case (name)
         case ('half_pi_rupture_load')
            call half_pi_rupture_load(rolling_coefficient(length, speed, viscosity, radius), &
                                      squeeze_coefficient(length, viscosity, radius), film, velocity, load, by_film, by_velocity)
         case ('solved_rupture_load')
            call solved_rupture_load(rolling_coefficient(length, speed, viscosity, radius), &
                                     squeeze_coefficient(length, viscosity, radius), film, velocity, a, rupture_tangent_fast(a), &
                                     load, by_film, by_velocity)
         case ('published_stiffness_damping')
            count = 2
            call published_stiffness_damping(rolling_coefficient(length, speed, viscosity, radius), &
                                             squeeze_coefficient(length, viscosity, radius), film, velocity, &
                                             rupture_tangent_fast(a), load, by_film)
         case ('published_piezo_load')
            call published_piezo_viscous_load(piezo_coefficient(length, speed, viscosity, radius, v(:, 7)), &
                                              squeeze_exponent_rate(speed), film, velocity, load, by_film, by_velocity)
            ! min(x, limit) of the kernel swallows a NaN.
            do i = 1, n
               if (ieee_is_nan(velocity(i))) results(i, :3) = velocity(i)
            end do
         case ('reynolds_iso_viscous_load')
            call reynolds_iso_viscous_load(load_scale(length, speed, viscosity, radius), squeeze_rate(speed, radius), film, &
                                           velocity, load, by_film, by_velocity)
         case ('reynolds_piezo_viscous_load')
            call reynolds_piezo_viscous_load(load_scale(length, speed, viscosity, radius), squeeze_rate(speed, radius), &
                                             pressure_rate(speed, viscosity, radius, v(:, 7)), film, velocity, load, by_film, &
                                             by_velocity)
            ! The kernel marks the absence of a rigid film by a load without slopes, NaN marks it here.
            do i = 1, n
               if (.not. load(i) < load_without_film) results(i, :3) = ieee_value(1.0_c_double, ieee_quiet_nan)
            end do
         case default
            continue
         end select
      end associate
   case default
      count = 0
   end select
end subroutine wrap_kernel
