!> Tests of the exact pressure and of the reduced pressure.
module test_film_pressure
   use checks, only: check_list_t
   use film_pressure, only: barus_pressure, pressure_group, pressure_scale
   use kinds, only: dp
   use rupture, only: pressure_integrals
   use rupture_reference, only: rupture_table
   implicit none(type, external)
   private

   public :: run_film_pressure_tests

contains

   !> Runs every test of this topic.
   subroutine run_film_pressure_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('film_pressure')
      call test_critical_group(checks)
      call test_shape(checks)
      call test_scale(checks)
      call test_barus(checks)
   end subroutine run_film_pressure_tests

   !> 1/max p* = B_crit. On separation the terms of p* nearly cancel at the peak: each brings an error of
   !> some epsilon of its own. On approach t_e + A nearly cancels: t_e, rounded, brings t_e (2 t_e + A) K.
   subroutine test_critical_group(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: a, t, peak, term, j, k
      character(12) :: place
      integer :: i

      do i = 1, size(rupture_table, 2)
         a = rupture_table(1, i)
         t = rupture_table(2, i)
         peak = 1.0_dp/rupture_table(4, i)
         call pressure_integrals(-t - a, j, k)
         term = abs(a)/(4.0_dp*(1.0_dp + (t + a)**2)**2) + j + abs(t)*(2.0_dp*abs(t) + abs(a))*k
         write (place, '(es12.4)') a
         call checks%check_close(pressure_group(-t - a, t, a), peak, 16.0_dp*epsilon(1.0_dp)*term, &
            'largest p*, A ='//place)
      end do
   end subroutine test_critical_group

   !> p* is zero at both ends, positive between, and rises up to t = -t_e - A and falls from there.
   subroutine test_shape(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: points = 200
      real(dp) :: a, t, peak, x, p, last, angle, start
      logical :: rising, falling
      character(12) :: place
      integer :: i, k

      do i = 1, size(rupture_table, 2), 6
         a = rupture_table(1, i)
         t = rupture_table(2, i)
         if (a > 100.0_dp) cycle
         write (place, '(es12.4)') a
         peak = pressure_group(-t - a, t, a)
         ! Relative to its peak p* is good to 1e-12 up to A = 100, where the terms of p* are 1e4 times p*.
         call checks%check_close(pressure_group(t, t, a)/peak, 0.0_dp, 1.0e-11_dp, &
            'p* at the rupture, A ='//place)
         call checks%check_close(pressure_group(-1.0e12_dp, t, a)/peak, 0.0_dp, 1.0e-20_dp, &
            'p* far ahead, A ='//place)
         rising = .true.
         falling = .true.
         start = atan(-t - a)
         last = peak
         do k = 1, points - 1
            angle = start + (atan(t) - start)*real(k, dp)/real(points, dp)
            p = pressure_group(tan(angle), t, a)
            falling = falling .and. p > 0.0_dp .and. p < last
            last = p
         end do
         last = 0.0_dp
         do k = 1, points
            x = -tan(2.0_dp*atan(1.0_dp) + (-start - 2.0_dp*atan(1.0_dp))*real(k, dp)/real(points, dp))
            p = pressure_group(x, t, a)
            rising = rising .and. p > last
            last = p
         end do
         call checks%check(rising, 'p* rises up to its maximum, A ='//place)
         call checks%check(falling, 'p* falls from its maximum, A ='//place)
         call checks%check_close(last/peak, 1.0_dp, 1.0e-11_dp, 'maximum at t = -t_e - A, A ='//place)
      end do
   end subroutine test_shape

   !> p/p* against its own unit: alpha times it is the group B = 6 sqrt(2) u*/h*^(3/2).
   subroutine test_scale(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: radius = 0.0127_dp, speed = 1.905_dp, viscosity = 0.3_dp, alpha = 2.0e-8_dp, &
         film = 8.9e-7_dp
      real(dp) :: group

      group = 6.0_dp*sqrt(2.0_dp)*(speed*viscosity*alpha/radius)/(film/radius)**1.5_dp
      call checks%check_close(alpha*pressure_scale(radius, speed, viscosity, film)/group, 1.0_dp, &
         16.0_dp*epsilon(1.0_dp), 'pressure scale')
   end subroutine test_scale

   !> alpha p = 1 - exp(-alpha q) is (31) inverted.
   subroutine test_barus(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: alpha_q
      integer :: i

      do i = 0, 12
         alpha_q = 0.5_dp*real(i, dp)
         ! 1 - alpha p keeps epsilon absolutely, which the logarithm enlarges by exp(alpha q).
         call checks%check_close(barus_pressure(1.0_dp - exp(-alpha_q)), alpha_q, &
            2.0_dp*epsilon(1.0_dp)*(exp(alpha_q) + alpha_q), 'alpha q of alpha p')
      end do
      call checks%check(barus_pressure(nearest(1.0_dp, -1.0_dp)) < 40.0_dp, 'alpha q just below alpha p = 1')
      call checks%check(abs(barus_pressure(1.0_dp) - huge(1.0_dp)) <= 0.0_dp, 'no q at alpha p = 1')
      call checks%check(barus_pressure(1.05_dp) >= huge(1.0_dp), 'no q just beyond alpha p = 1')
      call checks%check(barus_pressure(1.65_dp) >= huge(1.0_dp), 'no q beyond alpha p = 1')
   end subroutine test_barus

end module test_film_pressure
