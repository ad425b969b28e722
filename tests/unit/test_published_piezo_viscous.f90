!> Tests of the published piezo-viscous film against (37) in the paper's groups, its slopes and its overflow.
module test_published_piezo_viscous
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use checks, only: check_list_t
   use film_law, only: overflow_load
   use kinds, only: dp
   use published_piezo_viscous, only: piezo_coefficient, published_piezo_viscous_load, squeeze_exponent_rate
   implicit none(type, external)
   private

   real(dp), parameter :: radius = 0.0127_dp, length = 0.010_dp, speed = 1.905_dp, viscosity = 0.3_dp, &
      alpha = 2.0e-8_dp

   public :: run_published_piezo_viscous_tests

contains

   !> Runs every test of this topic.
   subroutine run_published_piezo_viscous_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('published_piezo_viscous')
      call test_values(checks)
      call test_slopes(checks)
      call test_overflow(checks)
   end subroutine run_published_piezo_viscous_tests

   !> (37) in groups: W = 6.6 l (R/alpha) u*^2.75 h*^-3.5 exp(-703 w*), from (32) inverted.
   subroutine test_values(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: films(3) = [8.4e-7_dp, 1.0e-6_dp, 1.8e-6_dp]
      real(dp), parameter :: velocities(4) = [-4.0e-3_dp, -1.0e-4_dp, 0.0_dp, 2.0e-3_dp]
      real(dp) :: load, slope_h, slope_w, expected, speed_group, film_ratio
      integer :: i, k

      speed_group = speed*viscosity*alpha/radius
      do i = 1, size(films)
         do k = 1, size(velocities)
            film_ratio = films(i)/radius
            expected = 6.6_dp*length*radius/alpha* &
               exp(2.75_dp*log(speed_group) - 3.5_dp*log(film_ratio) - 703.0_dp*velocities(k)/speed)
            call film_load(films(i), velocities(k), load, slope_h, slope_w)
            ! An exponential of logarithms up to 60 keeps about 60 epsilon.
            call checks%check_close(load/expected, 1.0_dp, 256.0_dp*epsilon(1.0_dp), '(37)')
         end do
      end do
   end subroutine test_values

   !> ln W is linear in ln h and in w; its slopes are known numbers, and so is a difference.
   subroutine test_slopes(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: film = 1.0e-6_dp, velocity = -1.0e-3_dp, step = 1.0e-3_dp
      real(dp) :: load, slope_h, slope_w, after, before, ignored_h, ignored_w
      integer, parameter :: exponent_terms = 2

      call film_load(film, velocity, load, slope_h, slope_w)
      call checks%check_close(slope_h*film/load, -3.5_dp, 8.0_dp*epsilon(1.0_dp), 'exponent of h')
      call checks%check_close(slope_w*speed/load, -703.0_dp, 703.0_dp*8.0_dp*epsilon(1.0_dp), 'rate in w')
      call film_load(film*exp(step), velocity, after, ignored_h, ignored_w)
      call film_load(film*exp(-step), velocity, before, ignored_h, ignored_w)
      call checks%check_close(log(after/before)/(real(exponent_terms, dp)*step), slope_h*film/load, &
         1.0e-12_dp, &
         'dW/dh against differences')
      call film_load(film, velocity + step*speed/703.0_dp, after, ignored_h, ignored_w)
      call film_load(film, velocity - step*speed/703.0_dp, before, ignored_h, ignored_w)
      call checks%check_close(log(after/before)/(real(exponent_terms, dp)*step)*703.0_dp/speed, &
         slope_w/load, &
         1.0e-12_dp*703.0_dp, 'dW/dw against differences')
   end subroutine test_slopes

   !> Beyond the largest exponent the load is a number and no load.
   subroutine test_overflow(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: exponents(4) = [551.0_dp, 745.0_dp, 1.0e4_dp, 1.0e10_dp]
      real(dp) :: load, slope_h, slope_w
      integer :: i, k

      do i = 1, size(exponents)
         do k = -9, -3
            call film_load(10.0_dp**k, -exponents(i)*speed/703.0_dp, load, slope_h, slope_w)
            call checks%check(load > overflow_load, 'a load beyond the largest exponent is an overflow')
            call checks%check(ieee_is_finite(load) .and. ieee_is_finite(slope_h) &
               .and. ieee_is_finite(slope_w), &
               'a load beyond the largest exponent is finite')
         end do
      end do
      call film_load(1.0e-6_dp, -200.0_dp*speed/703.0_dp, load, slope_h, slope_w)
      call checks%check(load < overflow_load, 'an exponent of 200 is no overflow')
      call film_load(1.0e-6_dp, 1.0e4_dp, load, slope_h, slope_w)
      call checks%check(load >= 0.0_dp .and. load < tiny(1.0_dp), 'very fast separation carries nothing')
   end subroutine test_overflow

   !> (37) with its coefficients.
   subroutine film_load(film, velocity, load, load_by_film, load_by_velocity)
      real(dp), intent(in) :: film               !> h [m]
      real(dp), intent(in) :: velocity           !> w [m/s]
      real(dp), intent(out) :: load              !> W [N]
      real(dp), intent(out) :: load_by_film      !> dW/dh [N/m]
      real(dp), intent(out) :: load_by_velocity  !> dW/dw [N s/m]

      call published_piezo_viscous_load(piezo_coefficient(length, speed, viscosity, radius, alpha), &
         squeeze_exponent_rate(speed), &
         film, velocity, load, load_by_film, load_by_velocity)
   end subroutine film_load

end module test_published_piezo_viscous
