!> Tests of the Reynolds films in physical units: values by their groups, slopes by differences, static films.
module test_reynolds_load
   use checks, only: check_list_t
   use kinds, only: dp
   use reynolds_load, only: load_scale, pressure_rate, reynolds_iso_viscous_load, reynolds_piezo_viscous_load, squeeze_rate, &
                            steady_iso_viscous_film, steady_piezo_viscous_film
   implicit none(type, external)
   private

   real(dp), parameter :: radius = 0.0127_dp, length = 0.01_dp, viscosity = 0.3_dp, speed = 1.905_dp, alpha = 1.0e-8_dp
   !> Fourth-order differences with this relative step: truncation and rounding are both below 1e-10.
   real(dp), parameter :: step = 2.0e-3_dp, difference_error = 1.0e-8_dp

   public :: run_reynolds_load_tests

contains

   !> Runs every test of this topic.
   subroutine run_reynolds_load_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('reynolds_load')
      call test_martin(checks)
      call test_slopes(checks)
      call test_static_film(checks)
      call test_stiffness_of_separation(checks)
   end subroutine run_reynolds_load_tests

   !> Without squeeze W = 2.4475 l eta0 u_r R/h0, Martin's result.
   subroutine test_martin(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: load, by_film, by_velocity

      call reynolds_iso_viscous_load(load_scale(length, speed, viscosity, radius), squeeze_rate(speed, radius), 1.0e-6_dp, &
         0.0_dp, load, by_film, by_velocity)
      call checks%check_close(load/(length*viscosity*speed*radius/1.0e-6_dp), 2.447484246956685_dp, 1.0e-14_dp, 'Martin')
      call checks%check_close(by_film*1.0e-6_dp/load, -1.0_dp, 1.0e-14_dp, 'stiffness of a film that falls with 1/h')
   end subroutine test_martin

   !> Stiffness on fast separation, where its terms cancel: Phi + A Phi'/2, and Psi + A Psi_A/2 + 3 B Psi_B/2 at three quarters of
   !> B_crit, with 40 digits or more.
   subroutine test_stiffness_of_separation(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: groups(6) = [20.0_dp, 30.0_dp, 50.0_dp, 100.0_dp, 2.0e3_dp, 1.0e6_dp]
      real(dp), parameter :: stiffnesses(6) = [2.2322539221216354159e-6_dp, 4.4369740427599335785e-7_dp, &
         5.7687673511405720902e-8_dp, 3.6103627528502475037e-9_dp, 2.2574930426881723031e-14_dp, 3.6119929453099705433e-25_dp]
      real(dp), parameter :: piezo_groups(6) = [8.0_dp, 10.0_dp, 30.0_dp, 100.0_dp, 2.0e3_dp, 1.0e6_dp]
      real(dp), parameter :: pressure_groups(6) = [1858.569121100566_dp, 3559.0331991298362_dp, 93073.899901227429_dp, &
         3434483.1440805886_dp, 27465845424.108376_dp, 3.4332275390750556e18_dp]
      real(dp), parameter :: piezo_stiffnesses(6) = [2.3033238788537120301e-4_dp, 9.6697737756039093087e-5_dp, &
         1.2422593603570579388e-6_dp, 1.0108639791662929021e-8_dp, 6.3207691804541213295e-14_dp, 1.0113242199078170951e-24_dp]
      real(dp) :: load, by_film, by_velocity
      integer :: i

      do i = 1, size(groups)
         call reynolds_iso_viscous_load(1.0_dp, 1.0_dp, 1.0_dp, groups(i), load, by_film, by_velocity)
         call checks%check_close(-by_film/stiffnesses(i), 1.0_dp, 1.0e-12_dp, 'stiffness on fast separation')
         call reynolds_piezo_viscous_load(1.0_dp, 1.0_dp, pressure_groups(i), 1.0_dp, piezo_groups(i), load, by_film, by_velocity)
         call checks%check_close(-by_film/piezo_stiffnesses(i), 1.0_dp, 1.0e-12_dp, 'the same of the piezo-viscous film')
      end do
      ! The other side of the group from which the series is taken.
      call reynolds_piezo_viscous_load(1.0_dp, 1.0_dp, pressure_groups(1), 1.0_dp, piezo_groups(1)*(1.0_dp + epsilon(1.0_dp)), &
                                       load, by_film, by_velocity)
      call checks%check_close(-by_film/piezo_stiffnesses(1), 1.0_dp, 1.0e-12_dp, 'piezo-viscous stiffness where its series begins')
   end subroutine test_stiffness_of_separation

   !> Slopes of both films, approaching, resting and separating.
   subroutine test_slopes(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: velocities(5) = [-0.02_dp, -1.0e-3_dp, 1.0e-5_dp, 1.0e-3_dp, 0.02_dp]
      real(dp) :: load, by_film, by_velocity, film, scale
      integer :: i, law

      do law = 1, 2
         film = merge(1.0e-6_dp, 4.0e-6_dp, law == 1)
         do i = 1, size(velocities)
            call evaluate(law, film, velocities(i), load, by_film, by_velocity)
            scale = max(abs(velocities(i)), 1.0e-3_dp)
            call checks%check(load > 0.0_dp, 'a ruptured film never pulls')
            call checks%check_close(film*by_film/load, difference(law, film, velocities(i), film*step, 0.0_dp)*film/load, &
               difference_error, 'dW/dh')
            call checks%check_close(scale*by_velocity/load, difference(law, film, velocities(i), 0.0_dp, scale*step)*scale/load, &
               difference_error, 'dW/dw')
         end do
      end do
   end subroutine test_slopes

   !> The static films carry their loads; the iso-viscous one is the limit of small alpha.
   subroutine test_static_film(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: loads(4) = [1.0_dp, 20.0_dp, 60.0_dp, 90.0_dp]
      real(dp) :: scale, rate, film, load, by_film, by_velocity
      integer :: i

      scale = load_scale(length, speed, viscosity, radius)
      rate = pressure_rate(speed, viscosity, radius, alpha)
      do i = 1, size(loads)
         film = steady_piezo_viscous_film(scale, rate, loads(i))
         call reynolds_piezo_viscous_load(scale, squeeze_rate(speed, radius), rate, film, 0.0_dp, load, by_film, by_velocity)
         ! A film is known to half an epsilon; the load falls with a power of it between 1 and about 10.
         call checks%check_close(load/loads(i), 1.0_dp, 100.0_dp*epsilon(1.0_dp), 'static piezo-viscous film')
         call checks%check(film > steady_iso_viscous_film(scale, loads(i)), 'pressure thickens the film')
         film = steady_piezo_viscous_film(scale, 1.0e-9_dp*rate, loads(i))
         call checks%check_close(film/steady_iso_viscous_film(scale, loads(i)), 1.0_dp, 1.0e-8_dp, 'limit of small alpha')
      end do
      call checks%check(.not. steady_piezo_viscous_film(scale, rate, 1.0e5_dp) > 0.0_dp, 'no rigid film under 100 kN')
   end subroutine test_static_film

   !> One of the films by its law.
   subroutine evaluate(law, film, velocity, load, by_film, by_velocity)
      integer, intent(in) :: law             !> 1 iso-viscous, 2 piezo-viscous
      real(dp), intent(in) :: film           !> h [m]
      real(dp), intent(in) :: velocity       !> w [m/s]
      real(dp), intent(out) :: load          !> W [N]
      real(dp), intent(out) :: by_film       !> dW/dh [N/m]
      real(dp), intent(out) :: by_velocity   !> dW/dw [N s/m]

      if (law == 1) then
         call reynolds_iso_viscous_load(load_scale(length, speed, viscosity, radius), squeeze_rate(speed, radius), film, &
            velocity, load, by_film, by_velocity)
      else
         call reynolds_piezo_viscous_load(load_scale(length, speed, viscosity, radius), squeeze_rate(speed, radius), &
            pressure_rate(speed, viscosity, radius, alpha), film, velocity, load, by_film, by_velocity)
      end if
   end subroutine evaluate

   !> Slope of the load in one direction by fourth-order central differences.
   real(dp) function difference(law, film, velocity, film_step, velocity_step)
      integer, intent(in) :: law              !> 1 iso-viscous, 2 piezo-viscous
      real(dp), intent(in) :: film            !> h [m]
      real(dp), intent(in) :: velocity        !> w [m/s]
      real(dp), intent(in) :: film_step       !> Step in h [m], or zero
      real(dp), intent(in) :: velocity_step   !> Step in w [m/s], or zero

      real(dp) :: loads(-2:2), by_film, by_velocity
      integer :: i

      do i = -2, 2
         call evaluate(law, film + real(i, dp)*film_step, velocity + real(i, dp)*velocity_step, loads(i), by_film, by_velocity)
      end do
      difference = (8.0_dp*(loads(1) - loads(-1)) - (loads(2) - loads(-2)))/(12.0_dp*(film_step + velocity_step))
   end function difference

end module test_reynolds_load
