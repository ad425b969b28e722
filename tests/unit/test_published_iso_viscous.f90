!> Tests of the published iso-viscous film against (24), (35) in the paper's own groups, and of its slopes.
module test_published_iso_viscous
   use checks, only: check_list_t
   use constants, only: half_pi, pi
   use kinds, only: dp
   use published_iso_viscous, only: half_pi_rupture_load, rolling_coefficient, solved_rupture_load, &
      squeeze_coefficient
   use reynolds_iso_viscous, only: rupture_tangent_fast
   use rupture, only: squeeze_group
   implicit none(type, external)
   private

   real(dp), parameter :: radius = 0.0127_dp, length = 0.010_dp, speed = 1.905_dp, viscosity = 0.3_dp
   !> Few operations on either side.
   real(dp), parameter :: rounding = 64.0_dp*epsilon(1.0_dp)
   !> Films [m] and velocities [m/s] of the canonical motion.
   real(dp), parameter :: films(4) = [2.5e-7_dp, 3.4e-7_dp, 8.9e-7_dp, 4.6e-6_dp]
   real(dp), parameter :: velocities(6) = [-2.0e-2_dp, -5.0e-3_dp, -1.0e-5_dp, 0.0_dp, 3.0e-3_dp, 1.5e-2_dp]

   public :: run_published_iso_viscous_tests

contains

   !> Runs every test of this topic.
   subroutine run_published_iso_viscous_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('published_iso_viscous')
      call test_loads(checks)
      call test_slopes(checks)
      call test_pull(checks)
      call test_short_films(checks)
   end subroutine run_published_iso_viscous_tests

   !> Load as in (35), l eta0 R/h (2.8 u - (3 pi/sqrt 2) w sqrt(R/h)), and as in (24) with x_e.
   subroutine test_loads(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: h, w, scale, load, slope_h, slope_w, x_e, expected
      integer :: i, k

      do i = 1, size(films)
         do k = 1, size(velocities)
            h = films(i)
            w = velocities(k)
            scale = length*viscosity*radius/h
            call half_pi_load(h, w, load, slope_h, slope_w)
            expected = scale*(2.8_dp*speed - 3.0_dp*pi/sqrt(2.0_dp)*w*sqrt(radius/h))
            call checks%check_close(load, expected, rounding*scale*(speed + abs(w)*sqrt(radius/h)), '(35)')
            call solved_load(h, w, load, slope_h, slope_w)
            x_e = atan(rupture_tangent_fast(4.0_dp*(w/speed)/sqrt(2.0_dp*h/radius)))
            expected = scale*(2.8_dp*speed - 3.0_dp/sqrt(2.0_dp)*(x_e + half_pi)*w*sqrt(radius/h))
            call checks%check_close(load, expected, rounding*scale*(speed + abs(w)*sqrt(radius/h)), &
               '(24) with x_e')
         end do
      end do
      ! At rest both are (23).
      call half_pi_load(films(3), 0.0_dp, load, slope_h, slope_w)
      call checks%check_close(load, 2.8_dp*0.010_dp*1.905_dp*0.3_dp*0.0127_dp/8.9e-7_dp, rounding*load, &
         '(23)')
      call checks%check_close(-slope_w/(3.0_dp*pi/sqrt(2.0_dp)*length*viscosity*(radius/films(3))**1.5_dp), &
         1.0_dp, &
         rounding, 'damping 3 pi/sqrt 2')
      ! x_e of the film at rest, 0.44355, against pi/2.
      call solved_load(films(3), 0.0_dp, load, slope_h, slope_w)
      call checks%check_close(-slope_w*sqrt(2.0_dp)/3.0_dp/(length*viscosity*(radius/films(3))**1.5_dp), &
         0.443554334217783_dp + half_pi, rounding, 'damping with the solved angle')
   end subroutine test_loads

   !> Slopes of both loads against fourth-order differences.
   subroutine test_slopes(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: h, w, load, slope_h, slope_w, error, step_h, step_w, stiffness, damping
      integer :: i, k

      do i = 1, size(films)
         do k = 1, size(velocities)
            h = films(i)
            w = velocities(k)
            step_h = 1.0e-3_dp*h
            step_w = 2.0e-3_dp*speed*sqrt(2.0_dp*h/radius)/4.0_dp
            ! Truncation: (1e-3)^4/30 times a fifth derivative of some hundreds; rounding: eps/1e-3.
            error = 5.0e-11_dp
            call half_pi_load(h, w, load, slope_h, slope_w)
            stiffness = (abs(load) + abs(slope_w*w))/h
            call checks%check_close(difference(.false., h, w, step_h, 0.0_dp), slope_h, error*stiffness, '(35): dW/dh')
            call checks%check_close(difference(.false., h, w, 0.0_dp, step_w), slope_w, error*stiffness*h/step_w, &
               '(35): dW/dw')
            call solved_load(h, w, load, slope_h, slope_w)
            damping = 3.0_dp*pi/sqrt(2.0_dp)*length*viscosity*(radius/h)**1.5_dp
            stiffness = (abs(load) + damping*abs(w))/h
            call checks%check_close(difference(.true., h, w, step_h, 0.0_dp), slope_h, error*stiffness, &
               '(24): dW/dh, x_e moving')
            call checks%check_close(difference(.true., h, w, 0.0_dp, step_w), slope_w, &
               error*(damping + stiffness*h/step_w), &
               '(24): dW/dw, x_e moving')
         end do
      end do
   end subroutine test_slopes

   !> As printed, (35) pulls on fast separation; with x_e solved the squeeze term dies out instead.
   subroutine test_pull(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: load, slope_h, slope_w

      call half_pi_load(8.9e-7_dp, 0.05_dp, load, slope_h, slope_w)
      call checks%check(load < 0.0_dp, '(35) pulls on separation, as printed')
      call solved_load(8.9e-7_dp, 0.05_dp, load, slope_h, slope_w)
      call checks%check(load > 0.0_dp, 'with x_e solved the film does not pull here')
   end subroutine test_pull

   !> A film that separates fast ruptures just behind its inlet: (24) over (23) at squeeze groups A, from (16) and (18) in 60 digits.
   subroutine test_short_films(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: groups(4) = [30.0_dp, 1.0e3_dp, 1.0e5_dp, 1.0e7_dp]
      real(dp), parameter :: shares(4) = [0.28678644105537651282_dp, 0.2857152532100863663_dp, 0.2857142858110355253_dp, &
                                          0.28571428571429538927_dp]
      real(dp) :: load, still, slope_h, slope_w
      integer :: i

      call solved_load(films(3), 0.0_dp, still, slope_h, slope_w)
      do i = 1, size(groups)
         call solved_load(films(3), groups(i)*speed*sqrt(2.0_dp*films(3)/radius)/4.0_dp, load, slope_h, slope_w)
         call checks%check_close(load/still, shares(i), 16.0_dp*epsilon(1.0_dp), '(24) on fast separation')
      end do
   end subroutine test_short_films

   !> (35) with its coefficients.
   subroutine half_pi_load(film, velocity, load, load_by_film, load_by_velocity)
      real(dp), intent(in) :: film               !> h [m]
      real(dp), intent(in) :: velocity           !> w [m/s]
      real(dp), intent(out) :: load              !> W [N]
      real(dp), intent(out) :: load_by_film      !> dW/dh [N/m]
      real(dp), intent(out) :: load_by_velocity  !> dW/dw [N s/m]

      call half_pi_rupture_load(rolling_coefficient(length, speed, viscosity, radius), &
         squeeze_coefficient(length, viscosity, radius), film, velocity, load, load_by_film, load_by_velocity)
   end subroutine half_pi_load

   !> (24) with its coefficients and x_e.
   subroutine solved_load(film, velocity, load, load_by_film, load_by_velocity)
      real(dp), intent(in) :: film               !> h [m]
      real(dp), intent(in) :: velocity           !> w [m/s]
      real(dp), intent(out) :: load              !> W [N]
      real(dp), intent(out) :: load_by_film      !> dW/dh [N/m]
      real(dp), intent(out) :: load_by_velocity  !> dW/dw [N s/m]

      real(dp) :: a

      a = squeeze_group(radius, speed, film, velocity)
      call solved_rupture_load(rolling_coefficient(length, speed, viscosity, radius), &
         squeeze_coefficient(length, viscosity, radius), film, velocity, a, rupture_tangent_fast(a), load, &
         load_by_film, load_by_velocity)
   end subroutine solved_load

   !> Load alone.
   real(dp) function load_of(solved, film, velocity) result(load)
      logical, intent(in) :: solved     !> (24) with x_e, else (35)
      real(dp), intent(in) :: film      !> h [m]
      real(dp), intent(in) :: velocity  !> w [m/s]

      real(dp) :: slope_h, slope_w

      if (solved) then
         call solved_load(film, velocity, load, slope_h, slope_w)
      else
         call half_pi_load(film, velocity, load, slope_h, slope_w)
      end if
   end function load_of

   !> Slope of the load in one direction by fourth-order central differences.
   real(dp) function difference(solved, film, velocity, film_step, velocity_step)
      logical, intent(in) :: solved          !> (24) with x_e, else (35)
      real(dp), intent(in) :: film           !> h [m]
      real(dp), intent(in) :: velocity       !> w [m/s]
      real(dp), intent(in) :: film_step      !> Step in h [m], or zero
      real(dp), intent(in) :: velocity_step  !> Step in w [m/s], or zero

      real(dp) :: loads(-2:2)
      integer :: i

      do i = -2, 2
         loads(i) = load_of(solved, film + real(i, dp)*film_step, velocity + real(i, dp)*velocity_step)
      end do
      difference = (8.0_dp*(loads(1) - loads(-1)) - (loads(2) - loads(-2)))/(12.0_dp*(film_step + velocity_step))
   end function difference

end module test_published_iso_viscous
