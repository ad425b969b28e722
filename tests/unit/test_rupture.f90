!> Tests of the rupture point against roots in arbitrary precision, and of its limits.
module test_rupture
   use checks, only: check_list_t
   use kinds, only: dp
   use reynolds_iso_viscous, only: rupture_tangent_fast, rupture_tangent_slope
   use rupture, only: pressure_integrals, rupture_tangent_successive, squeeze_group
   use rupture_reference, only: rupture_table
   implicit none(type, external)
   private

   !> Demanded of both solvers, relative to the larger of 1 and |t_e|.
   real(dp), parameter :: demanded = 1.0e-13_dp

   public :: run_rupture_tests

contains

   !> Runs every test of this topic.
   subroutine run_rupture_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('rupture')
      call test_squeeze_group(checks)
      call test_reference(checks)
      call test_published_angles(checks)
      call test_sweep(checks)
      call test_slope(checks)
      call test_switch(checks)
      call test_limits(checks)
   end subroutine run_rupture_tests

   !> A = 4 (w/u)/sqrt(2 h/R), of numbers whose root is exact.
   subroutine test_squeeze_group(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%check_close(squeeze_group(0.02_dp, 2.0_dp, 4.0e-6_dp, -0.01_dp), -1.0_dp, &
         8.0_dp*epsilon(1.0_dp), 'squeeze group')
   end subroutine test_squeeze_group

   !> Both solvers and the slope against the table, |A| from 0.01 to 1e4.
   subroutine test_reference(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: a, t, scale, slope
      character(12) :: place
      integer :: i

      do i = 1, size(rupture_table, 2)
         a = rupture_table(1, i)
         t = rupture_table(2, i)
         scale = max(1.0_dp, abs(t))
         write (place, '(es12.4)') a
         call checks%check_close(rupture_tangent_fast(a), t, demanded*scale, 'fast, A ='//place)
         call checks%check_close(rupture_tangent_successive(a), t, demanded*scale, 'successive, A ='//place)
         slope = rupture_tangent_slope(a)
         ! 2 t_e + A in the slope loses two digits where t_e ~ -3A/8.
         call checks%check_close(slope/rupture_table(3, i), 1.0_dp, demanded, 'slope, A ='//place)
      end do
   end subroutine test_reference

   !> Angles known to 15 digits from another calculation, finite volumes beside it.
   subroutine test_published_angles(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: angles(2, 7) = reshape([real(dp) :: &
         -10.0_dp, 1.471455468229795_dp, &
         -1.0_dp, 0.895760873911323_dp, &
         -0.1_dp, 0.498241885171949_dp, &
         0.0_dp, 0.443554334217783_dp, &
         1.0_dp, -0.112520108225344_dp, &
         3.0_dp, -0.788541890097547_dp, &
         10.0_dp, -1.307657790984171_dp], [2, 7])
      character(5) :: place
      integer :: i

      do i = 1, size(angles, 2)
         write (place, '(f5.1)') angles(1, i)
         call checks%check_close(atan(rupture_tangent_fast(angles(1, i))), angles(2, i), demanded, &
            'x_e, A ='//place)
      end do
   end subroutine test_published_angles

   !> Dense sweep: the residual of (18) is that of rounding, both solvers agree, t_e falls with A and is the
   !> physical root.
   subroutine test_sweep(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: points = 4000
      real(dp) :: a, fast, successive, last, j, k, c, size_, error, worst_error, difference, worst_difference
      integer :: i
      logical :: falling, physical

      worst_error = 0.0_dp
      worst_difference = 0.0_dp
      falling = .true.
      physical = .true.
      last = huge(1.0_dp)
      do i = -points, points
         a = 1.0e-3_dp*sinh(real(i, dp)/real(points, dp)*asinh(1.0e7_dp))
         fast = rupture_tangent_fast(a)
         successive = rupture_tangent_successive(a)
         call pressure_integrals(fast, j, k)
         c = 1.0_dp/(1.0_dp + fast*fast)
         size_ = j + abs(fast)*(2.0_dp*abs(fast) + abs(a))*k + abs(a)*c*c/4.0_dp
         error = abs(j - fast*(fast + a)*k - a*c*c/4.0_dp)/size_
         worst_error = max(worst_error, error)
         difference = abs(fast - successive)/max(1.0_dp, abs(fast))
         worst_difference = max(worst_difference, difference)
         falling = falling .and. fast < last
         physical = physical .and. fast > -0.5_dp*a
         last = fast
      end do
      ! The terms of (18) are each good to some epsilon, and t_e as a number to one: so is their sum.
      call checks%check_close(worst_error, 0.0_dp, 32.0_dp*epsilon(1.0_dp), 'sweep: residual of (18)')
      call checks%check_close(worst_difference, 0.0_dp, demanded, 'sweep: fast and successive agree')
      call checks%check(falling, 'sweep: t_e falls with A')
      call checks%check(physical, 'sweep: t_e > -A/2')
   end subroutine test_sweep

   !> dt_e/dA against fourth-order central differences of the solver.
   subroutine test_slope(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: groups(7) = [-30.0_dp, -3.0_dp, -0.3_dp, 0.0_dp, 0.5_dp, 2.0_dp, 20.0_dp]
      real(dp) :: a, h, difference, error
      character(6) :: place
      integer :: i

      do i = 1, size(groups)
         a = groups(i)
         h = 2.0e-3_dp*max(1.0_dp, abs(a))
         difference = (8.0_dp*(rupture_tangent_fast(a + h) - rupture_tangent_fast(a - h)) - &
            (rupture_tangent_fast(a + 2.0_dp*h) - rupture_tangent_fast(a - 2.0_dp*h)))/(12.0_dp*h)
         ! Rounding is eps/h, truncation h^4/30 times the fifth derivative: both about 1e-12 here.
         error = 1.0e-11_dp
         write (place, '(f6.1)') a
         call checks%check_close(difference, rupture_tangent_slope(a), error, &
            'slope against differences, A ='//place)
      end do
   end subroutine test_slope

   !> Nothing jumps where the integrals go over to their series, t_e = -0.97.
   subroutine test_switch(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: below, above, a, j, k, slope
      integer :: i

      ! A of a given t_e is explicit.
      call pressure_integrals(-0.97_dp, j, k)
      a = (j - 0.97_dp**2*k)/(0.25_dp/(1.0_dp + 0.97_dp**2)**2 - 0.97_dp*k)
      slope = rupture_tangent_slope(a)
      do i = 1, 5
         above = rupture_tangent_fast(a*(1.0_dp - 0.1_dp**(2*i)))
         below = rupture_tangent_fast(a*(1.0_dp + 0.1_dp**(2*i)))
         ! The cubic term of the difference is of the order (1e-2 A)^3 for the widest step.
         call checks%check_close(above - below, -2.0_dp*slope*a*0.1_dp**(2*i), &
            8.0_dp*demanded + (a*0.1_dp**(2*i))**3, 'continuous at the switch to the series')
      end do
   end subroutine test_switch

   !> t_e ~ -A - 1/(3A) on fast approach, ~ -3A/8 on fast separation, also far beyond the table.
   subroutine test_limits(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: a, tolerance
      integer :: i

      do i = 5, 15, 5
         a = 10.0_dp**i
         ! The next terms are of the order 1/A^2 relative to the first.
         tolerance = 10.0_dp/a**2 + demanded
         call checks%check_close(rupture_tangent_fast(-a)/a, 1.0_dp, tolerance, 'fast approach, fast solver')
         call checks%check_close(rupture_tangent_successive(-a)/a, 1.0_dp, tolerance, &
            'fast approach, successive')
         call checks%check_close(rupture_tangent_fast(a)/a, -0.375_dp, tolerance, &
            'fast separation, fast solver')
         call checks%check_close(rupture_tangent_successive(a)/a, -0.375_dp, tolerance, &
            'fast separation, successive')
      end do
   end subroutine test_limits

end module test_rupture
