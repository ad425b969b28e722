!> Tests of single films in the groups of the paper: the figure-5 case, published slopes, limits, the reference solution.
module test_film_point
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use checks, only: check_list_t
   use film_point, only: film_contact_t, film_peak, film_peak_t, film_point_t, film_response_t, iso_viscous_response, &
      limit_of_point, new_film_point, piezo_viscous_response, published_response, solve_numerically
   use kinds, only: dp
   use regime, only: film_elastohydrodynamic, film_piezo_viscous
   implicit none(type, external)
   private

   type(film_contact_t), parameter :: contact = film_contact_t(radius=0.0127_dp, length=0.01_dp, modulus=2.26e11_dp, &
      viscosity=0.3_dp, pressure_viscosity=2.0e-8_dp)

   public :: run_film_point_tests

contains

   !> Runs every test of this topic.
   subroutine run_film_point_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('film_point')
      call test_figure_5(checks)
      call test_published(checks)
      call test_limit(checks)
      call test_numerical_solution(checks)
   end subroutine run_film_point_tests

   !> alpha p = 1.65 with the groups as printed, 0.826 with p halved, then 201 MPa at w* = -5e-4.
   subroutine test_figure_5(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(film_peak_t) :: peak
      type(film_response_t) :: response

      peak = film_peak(contact, new_film_point(contact, 70.0e-6_dp, 0.0_dp, 0.9e-6_dp))
      call checks%check_close(peak%alpha_p, 1.65_dp, 0.005_dp, 'alpha p as printed')
      call checks%check(ieee_is_nan(peak%pressure), 'no pressure as printed')
      call checks%check_close(peak%deflection/deflection_at(peak%alpha_p/contact%pressure_viscosity), 1.0_dp, 1.0e-14_dp, &
         'deflection at p where q does not exist')
      call checks%check(peak%regime == film_elastohydrodynamic, 'no rigid film as printed')
      response = piezo_viscous_response(contact, new_film_point(contact, 70.0e-6_dp, 0.0_dp, 0.9e-6_dp))
      call checks%check(ieee_is_nan(response%load), 'its load is not a number')
      peak = film_peak(contact, new_film_point(contact, 70.0e-6_dp, 0.0_dp, 0.45e-6_dp))
      call checks%check_close(peak%alpha_p, 0.826_dp, 0.0005_dp, 'alpha p with p halved')
      call checks%check(peak%regime == film_piezo_viscous, 'a rigid film with p halved')
      peak = film_peak(contact, new_film_point(contact, 70.0e-6_dp, -5.0e-4_dp, 0.45e-6_dp))
      call checks%check_close(peak%pressure, 201.0e6_dp, 0.5e6_dp, 'highest pressure of figure 5')
      call checks%check_close(peak%deflection/deflection_at(peak%pressure), 1.0_dp, 1.0e-14_dp, 'deflection at q where it exists')

   contains

      !> (4) as printed [m].
      pure real(dp) function deflection_at(pressure)
         real(dp), intent(in) :: pressure  !> Pressure [Pa]

         deflection_at = 4.0_dp*contact%radius*(pressure/contact%modulus)**2
      end function deflection_at

   end subroutine test_figure_5

   !> (27) and (28) are the slopes of (24) at fixed x_e: recomputed from loads of the printed form.
   subroutine test_published(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(film_point_t) :: point
      type(film_response_t) :: response
      real(dp) :: rolling, width, h, w, load
      integer :: i

      do i = -1, 1
         point = new_film_point(contact, 70.0e-6_dp, real(i, dp)*5.0e-4_dp, 0.9e-6_dp)
         response = published_response(contact, point)
         h = point%film
         w = point%velocity
         rolling = 2.8_dp*contact%length*point%speed*contact%viscosity*contact%radius
         width = 3.0_dp*contact%length*contact%viscosity*contact%radius**1.5_dp/sqrt(2.0_dp)* &
            (atan(point%rupture_tangent) + acos(0.0_dp))
         load = rolling/h - width*w*h**(-1.5_dp)
         call checks%check_close(response%load/load, 1.0_dp, 1.0e-14_dp, 'published load')
         call checks%check_close(response%damping/(width*h**(-1.5_dp)), 1.0_dp, 1.0e-14_dp, 'published damping')
         call checks%check_close(response%stiffness/(rolling/h**2 - 1.5_dp*width*w*h**(-2.5_dp)), 1.0_dp, 1.0e-14_dp, &
            'published stiffness')
      end do
   end subroutine test_published

   !> At the limiting film alpha p is 1; a film that separates fast enough has none.
   subroutine test_limit(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(film_peak_t) :: peak
      real(dp) :: limit
      integer :: i

      do i = -2, 2
         limit = limit_of_point(contact, new_film_point(contact, 70.0e-6_dp, real(i, dp)*2.5e-4_dp, 0.9e-6_dp))
         peak = film_peak(contact, new_film_point(contact, limit/contact%radius, real(i, dp)*2.5e-4_dp, 0.9e-6_dp))
         call checks%check_close(peak%alpha_p, 1.0_dp, 1.0e-12_dp, 'alpha p at the limiting film')
      end do
      limit = limit_of_point(contact, new_film_point(contact, 70.0e-6_dp, 0.5_dp, 0.9e-6_dp))
      call checks%check(ieee_is_nan(limit), 'no limit in fast separation')
   end subroutine test_limit

   !> The finite volumes find the exact loads, extrapolated from 2048 and 4096 cells.
   subroutine test_numerical_solution(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(film_point_t) :: point
      type(film_response_t) :: exact
      real(dp) :: load, angle, pressure
      integer :: i

      do i = -1, 1
         point = new_film_point(contact, 70.0e-6_dp, real(i, dp)*5.0e-4_dp, 0.4e-6_dp)
         exact = piezo_viscous_response(contact, point)
         call solve_numerically(contact, point, .false., 4096, load, angle, pressure)
         call checks%check_close(load/exact%load, 1.0_dp, 1.0e-8_dp, 'numerical load')
         call checks%check_close(angle, atan(point%rupture_tangent), 1.0e-8_dp, 'numerical rupture')
         exact = iso_viscous_response(contact, point)
         call checks%check(load > exact%load, 'pressure adds load')
      end do
   end subroutine test_numerical_solution

end module test_film_point
