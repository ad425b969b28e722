!> Tests of the finite-volume solution of the Reynolds equation against closed forms, and of its order of
!> accuracy.
module test_numerical_reynolds
   use, intrinsic :: ieee_arithmetic, only: ieee_positive_inf, ieee_quiet_nan, ieee_value
   use checks, only: check_list_t
   use constants, only: half_pi, pi
   use kinds, only: dp
   use numerical_reynolds, only: film_solution_t, scale_film, solve_reynolds
   use numerical_reynolds_grid, only: film_problem_t, law_barus, law_constant, law_roelands, log_viscosity_ratio
   use numerical_reynolds_rupture, only: reynolds_bad_input, reynolds_converged, reynolds_no_rigid_film, reynolds_unresolved
   implicit none(type, external)
   private

   public :: run_numerical_reynolds_tests

   !> Exact iso-viscous films: A, rupture angle, Phi, B_crit = 1/max p*.
   real(dp), parameter :: iso(4, 7) = reshape([ &
      -10.0_dp, 1.471455468229795_dp, 3.928634511188594_dp, 0.3991093859271338_dp, &
      -1.0_dp, 0.8957608739113226_dp, 0.4669361425852977_dp, 3.299920163085864_dp, &
      -0.1_dp, 0.4982418851719488_dp, 0.2240174855099537_dp, 7.116355164967033_dp, &
      0.0_dp, 0.4435543342177832_dp, 0.2039570205797237_dp, 7.889828622697975_dp, &
      0.1_dp, 0.3876174358753711_dp, 0.1854276377346423_dp, 8.773322678500321_dp, &
      1.0_dp, -0.1125201082253439_dp, 0.07851021219003870_dp, 24.45183655754417_dp, &
      3.0_dp, -0.7885418900975466_dp, 0.01836495362233236_dp, 174.9457309380940_dp], [4, 7])

   !> Exact Barus films: row of `iso`, B/B_crit, Psi.
   real(dp), parameter :: barus(3, 12) = reshape([ &
      2.0_dp, 0.1_dp, 0.4823409384584999_dp, 2.0_dp, 0.5_dp, 0.5686956034470299_dp, &
      2.0_dp, 0.9_dp, 0.7837156586546572_dp, 2.0_dp, 0.99_dp, 0.9756785868823309_dp, &
      4.0_dp, 0.1_dp, 0.2105210410096070_dp, 4.0_dp, 0.5_dp, 0.2472544472469768_dp, &
      4.0_dp, 0.9_dp, 0.3383676085470261_dp, 4.0_dp, 0.99_dp, 0.4194168244010132_dp, &
      6.0_dp, 0.1_dp, 0.08093436550373677_dp, 6.0_dp, 0.5_dp, 0.09444571414845139_dp, &
      6.0_dp, 0.9_dp, 0.1276297531683181_dp, 6.0_dp, 0.99_dp, 0.1568442108923335_dp], [3, 12])

   !> Row of `iso` with A = 0, used where one film is enough.
   integer, parameter :: rolling_row = 4
   real(dp), parameter :: exact_tolerance = 1.0e-8_dp
   real(dp), parameter :: rounding = 1.0e-11_dp

   !> An oil of 0.3 Pa s and 2e-8 1/Pa.
   real(dp), parameter :: oil_viscosity = 0.3_dp, oil_pressure_viscosity = 2.0e-8_dp

contains

   !> Runs every test of this topic.
   subroutine run_numerical_reynolds_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('numerical_reynolds')
      call test_iso_viscous(checks)
      call test_barus(checks)
      call test_order(checks)
      call test_complementarity(checks)
      call test_speeds(checks)
      call test_scales(checks)
      call test_roelands(checks)
      call test_rejections(checks)
   end subroutine run_numerical_reynolds_tests

   !> Load, rupture and largest pressure of the extrapolated solution are the closed forms'.
   subroutine test_iso_viscous(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      type(film_solution_t) :: solution
      character(len=24) :: label
      integer :: i

      do i = 1, size(iso, 2)
         write (label, '(a, f6.2)') 'iso-viscous, A =', iso(1, i)
         call solve_reynolds(film_problem_t(squeeze=iso(1, i)), 4096, .true., solution)
         call checks%check(solution%status == reynolds_converged, label//': converged')
         call checks%check_close(solution%load/iso(3, i), 1.0_dp, exact_tolerance, label//': load')
         call checks%check_close(solution%rupture_angle, iso(2, i), exact_tolerance, label//': rupture')
         call checks%check_close(solution%maximum_pressure*iso(4, i), 1.0_dp, exact_tolerance, &
            label//': pressure')
         call checks%check(solution%load_correction < 1.0e-5_dp*solution%load, label//': grid error')
      end do
      call solve_reynolds(film_problem_t(squeeze=-1.0e4_dp), 4096, .true., solution)
      call checks%check_close(solution%load/3926.990816988908_dp, 1.0_dp, 1.0e-6_dp, 'A = -1e4: load')
      call solve_reynolds(film_problem_t(squeeze=10.0_dp), 16384, .true., solution)
      call checks%check_close(solution%load/0.001939984020199494_dp, 1.0_dp, 1.0e-6_dp, 'A = 10: load')
   end subroutine test_iso_viscous

   !> Load and largest pressure -ln(1 - B/B_crit)/B of piezo-viscous films up to 99 % of the critical group.
   subroutine test_barus(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      type(film_problem_t) :: problem
      type(film_solution_t) :: solution
      character(len=32) :: label
      integer :: i, row

      do i = 1, size(barus, 2)
         row = nint(barus(1, i))
         write (label, '(a, f5.1, a, f5.2)') 'Barus, A =', iso(1, row), ', B/B_crit', barus(2, i)
         problem = film_problem_t(squeeze=iso(1, row), law=law_barus, pressure_group=barus(2, i)*iso(4, row))
         call solve_reynolds(problem, 4096, .true., solution)
         call checks%check(solution%status == reynolds_converged, label//': converged')
         call checks%check_close(solution%load/barus(3, i), 1.0_dp, exact_tolerance, label//': load')
         call checks%check_close(solution%rupture_angle, iso(2, row), exact_tolerance, label//': rupture')
         call checks%check_close(solution%maximum_pressure*problem%pressure_group, -log(1.0_dp - barus(2, &
            i)), &
            10.0_dp*exact_tolerance*(-log(1.0_dp - barus(2, i))), label//': pressure')
      end do
      problem%pressure_group = 1.01_dp*iso(4, row)
      call solve_reynolds(problem, 1024, .false., solution)
      call checks%check(solution%status == reynolds_no_rigid_film, 'Barus: no rigid film beyond B_crit')
      problem%pressure_group = 100.0_dp*iso(4, row)
      call solve_reynolds(problem, 1024, .false., solution)
      call checks%check(solution%status == reynolds_no_rigid_film, 'Barus: no rigid film far beyond B_crit')
   end subroutine test_barus

   !> Halving the step divides load, rupture and profile errors by four; extrapolation gains more.
   subroutine test_order(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: order_tolerance = 0.1_dp
      type(film_problem_t) :: problem
      type(film_solution_t) :: solution
      real(dp) :: load_error(3), rupture_error(3), profile_error(3), extrapolated, exact_load
      integer :: i, law

      do law = law_constant, law_barus
         problem = film_problem_t(law=law, pressure_group=0.5_dp*iso(4, rolling_row))
         exact_load = merge(iso(3, rolling_row), barus(3, 6), law == law_constant)
         do i = 1, 3
            call solve_reynolds(problem, 64*2**i, .false., solution)
            load_error(i) = abs(solution%load - exact_load)
            rupture_error(i) = abs(solution%rupture_angle - iso(2, rolling_row))
            profile_error(i) = maxval(abs(solution%pressure - exact_profile(problem, solution%angle)))
         end do
         do i = 1, 2
            call checks%check_close(order(load_error(i:i + 1)), 2.0_dp, order_tolerance, 'order of the load')
            call checks%check_close(order(rupture_error(i:i + 1)), 2.0_dp, order_tolerance, &
               'order of the rupture')
            call checks%check_close(order(profile_error(i:i + 1)), 2.0_dp, order_tolerance, &
               'order of the profile')
         end do
         call solve_reynolds(problem, 512, .true., solution)
         extrapolated = abs(solution%load - exact_load)
         call checks%check(extrapolated < 0.01_dp*load_error(3), 'extrapolation')
      end do
   end subroutine test_order

   !> Observed order of two errors at steps of ratio two.
   pure function order(errors) result(value)
      real(dp), intent(in) :: errors(2)  !> Error at the coarse and at the fine step
      real(dp) :: value

      value = log(errors(1)/errors(2))/log(2.0_dp)
   end function order

   !> Closed-form pressure in pure rolling, constant viscosity or Barus; t_e of eq (22).
   elemental function exact_profile(problem, angle) result(pressure)
      type(film_problem_t), intent(in) :: problem  !> Law and B
      real(dp), intent(in) :: angle                !> xbar [rad]
      real(dp) :: pressure                         !> q* [-]

      real(dp) :: j, k, rupture

      rupture = iso(2, rolling_row)
      pressure = 0.0_dp
      if (angle >= rupture) return
      j = angle/8.0_dp - sin(4.0_dp*angle)/32.0_dp + pi/16.0_dp
      k = 3.0_dp*angle/8.0_dp + sin(2.0_dp*angle)/4.0_dp + sin(4.0_dp*angle)/32.0_dp + 3.0_dp*pi/16.0_dp
      pressure = j - tan(rupture)**2*k
      associate (group => problem%pressure_group)
         if (problem%law == law_barus) pressure = -log(1.0_dp - group*pressure)/group
      end associate
   end function exact_profile

   !> The pressure is positive up to the rupture, zero behind it, and the grid runs from -pi/2 to pi/2.
   subroutine test_complementarity(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      type(film_solution_t) :: solution
      integer :: i

      do i = 1, size(iso, 2)
         call solve_reynolds(film_problem_t(squeeze=iso(1, i)), 1000, .false., solution)
         associate (q => solution%pressure, angle => solution%angle)
            call checks%check(size(q) == 1001 .and. size(angle) == 1001, 'profile: size')
            call checks%check_close(angle(0), -half_pi, rounding, 'profile: first node')
            call checks%check_close(angle(1000), half_pi, rounding, 'profile: last node')
            call checks%check(all(q >= 0.0_dp), 'profile: no tension')
            call checks%check(all(q > 0.0_dp .or. angle >= solution%rupture_angle .or. angle <= angle(0)), &
               'profile: oil before the rupture')
            call checks%check( &
               all(q <= 0.0_dp .or. angle <= solution%rupture_angle), 'profile: none behind it')
         end associate
      end do
   end subroutine test_complementarity

   !> Rolling backwards, no rolling, and any speed scale.
   subroutine test_speeds(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      type(film_problem_t) :: problem
      type(film_solution_t) :: forwards, backwards, squeezed
      real(dp), parameter :: group = 2.0_dp

      problem = film_problem_t(squeeze=-1.0_dp, law=law_barus, pressure_group=group)
      call solve_reynolds(problem, 512, .true., forwards)
      problem%rolling = -1.0_dp
      call solve_reynolds(problem, 512, .true., backwards)
      call checks%check_close(backwards%load, forwards%load, rounding, 'backwards: load')
      call checks%check_close(backwards%rupture_angle, -forwards%rupture_angle, rounding, &
         'backwards: rupture')
      call checks%check(maxval(abs(backwards%pressure(512:0:-1) - forwards%pressure)) < rounding, &
         'backwards: mirrored profile')

      problem = film_problem_t(rolling=0.25_dp, squeeze=-0.25_dp, law=law_barus, pressure_group=4.0_dp*group)
      call solve_reynolds(problem, 512, .true., squeezed)
      call checks%check_close(4.0_dp*squeezed%load, forwards%load, rounding, 'other speed scale: load')

      ! Pure squeeze: q* = cos^4(xbar)/4 on approach, no film on separation.
      call solve_reynolds(film_problem_t(rolling=0.0_dp, squeeze=-1.0_dp), 512, .true., squeezed)
      call checks%check_close(squeezed%load, pi/8.0_dp, exact_tolerance, 'pure squeeze: load')
      call checks%check_close(squeezed%maximum_pressure, 0.25_dp, exact_tolerance, 'pure squeeze: pressure')
      call checks%check_close(squeezed%rupture_angle, half_pi, rounding, 'pure squeeze: no rupture')
      call checks%check(maxval(abs(squeezed%pressure - 0.25_dp*cos(squeezed%angle)**4)) < 1.0e-4_dp, &
         'pure squeeze: profile')
      call solve_reynolds(film_problem_t(rolling=0.0_dp, squeeze=1.0_dp), 512, .true., squeezed)
      call checks%check(squeezed%status == reynolds_converged, 'pure separation: converged')
      call checks%check_close(squeezed%load, 0.0_dp, 0.0_dp, 'pure separation: no load')
      call solve_reynolds(film_problem_t(rolling=0.0_dp), 512, .true., squeezed)
      call checks%check(squeezed%status == reynolds_converged, 'rest: converged')
      call checks%check_close(squeezed%load, 0.0_dp, 0.0_dp, 'rest: no load')
   end subroutine test_speeds

   !> Films in SI units: Martin's load, squeeze of either sign, pure squeeze 6 pi/sqrt(2) l eta0 (R/h0)^(3/2)
   !> |w|.
   subroutine test_scales(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: radius = 0.0127_dp, film = 1.0e-6_dp, speed = 1.905_dp, squeeze = -2.0e-3_dp
      type(film_problem_t) :: problem
      type(film_solution_t) :: solution
      real(dp) :: pressure_scale, load_scale, ratio

      call scale_film( &
         radius, film, speed, 0.0_dp, oil_viscosity, oil_pressure_viscosity, problem, pressure_scale, &
         load_scale)
      call checks%check_close(problem%rolling, 1.0_dp, rounding, 'scales: rolling')
      call checks%check_close(problem%pressure_group/(oil_pressure_viscosity*pressure_scale), 1.0_dp, &
         rounding, &
         'scales: B')
      problem%law = law_constant
      call solve_reynolds(problem, 1024, .true., solution)
      call checks%check_close(solution%load*load_scale*film/(oil_viscosity*speed*radius), &
         2.447484246956685_dp, &
         1.0e-7_dp, 'scales: load in pure rolling')

      call scale_film( &
         radius, film, -speed, squeeze, oil_viscosity, oil_pressure_viscosity, problem, pressure_scale, &
         load_scale)
      ratio = 4.0_dp*squeeze/speed/sqrt(2.0_dp*film/radius)
      call checks%check_close(problem%squeeze/abs(problem%rolling), ratio, rounding, 'scales: A')
      call checks%check(problem%rolling < 0.0_dp, 'scales: sign of the rolling speed')

      call scale_film( &
         radius, film, 0.0_dp, squeeze, oil_viscosity, oil_pressure_viscosity, problem, pressure_scale, &
         load_scale)
      problem%law = law_constant
      call solve_reynolds(problem, 1024, .true., solution)
      call checks%check_close(solution%load*load_scale/(oil_viscosity*(radius/film)**1.5_dp*abs(squeeze)), &
         6.0_dp*pi/sqrt(2.0_dp), 1.0e-7_dp, 'scales: load in pure squeeze')

      call scale_film( &
         radius, film, 0.0_dp, 0.0_dp, oil_viscosity, oil_pressure_viscosity, problem, pressure_scale, &
         load_scale)
      call checks%check(max(pressure_scale, load_scale) <= 0.0_dp, 'scales: rest')
   end subroutine test_scales

   !> Roelands: its limits are Barus and constant viscosity, and its largest pressure q obeys
   !> integral of eta0/eta from 0 to q = p_max, the constant-viscosity pressure.
   subroutine test_roelands(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      type(film_problem_t) :: problem
      type(film_solution_t) :: solution, barus_solution
      real(dp) :: group, logarithm, slope, pressure_scale, load_scale
      integer :: i

      group = 0.9_dp*iso(4, rolling_row)
      problem = film_problem_t(law=law_barus, pressure_group=group)
      call solve_reynolds(problem, 1024, .true., barus_solution)
      problem%law = law_roelands
      problem%roelands_pressure = 4.0_dp
      problem%roelands_logarithm = 4.0_dp
      call solve_reynolds(problem, 1024, .true., solution)
      call checks%check_close(solution%load, barus_solution%load, rounding, 'Roelands, Z = 1: Barus')
      problem%roelands_pressure = 0.6e6_dp
      problem%roelands_logarithm = 1.0e6_dp
      call solve_reynolds(problem, 1024, .true., solution)
      call checks%check_close(solution%load, barus_solution%load, 1.0e-5_dp, 'Roelands, large p_r: Barus')

      call scale_film(0.0127_dp, 1.0e-6_dp, 1.905_dp, 0.0_dp, oil_viscosity, oil_pressure_viscosity, &
         problem, &
         pressure_scale, load_scale)
      problem%law = law_roelands
      call checks%check_close(problem%roelands_pressure, 3.92_dp, rounding, 'Roelands: alpha p_r')
      call checks%check_close(problem%roelands_logarithm, log(0.3_dp) + 9.67_dp, rounding, &
         'Roelands: ln eta0 + 9.67')
      call log_viscosity_ratio(problem, 0.0_dp, logarithm, slope)
      call checks%check_close(logarithm, 0.0_dp, 0.0_dp, 'Roelands: ambient viscosity')
      call checks%check_close(slope, 1.0_dp, rounding, 'Roelands: slope at ambient pressure is alpha')
      call log_viscosity_ratio(problem, 10.0_dp, logarithm, slope)
      call checks%check(logarithm < 10.0_dp .and. slope < 1.0_dp, 'Roelands: below Barus')

      do i = 2, 6, 2
         problem%squeeze = iso(1, i)
         problem%pressure_group = 1.0e-9_dp
         call solve_reynolds(problem, 1024, .true., solution)
         call checks%check_close(solution%load/iso(3, i), 1.0_dp, 1.0e-7_dp, &
            'Roelands, small B: constant viscosity')
         ! Beyond the critical group of Barus this oil keeps a rigid film up to the integral to infinity,
         ! 1.1394.
         problem%pressure_group = 1.05_dp*iso(4, i)
         call solve_reynolds(problem, 4096, .true., solution)
         call checks%check(solution%status == reynolds_converged, &
            'Roelands: beyond the critical group of Barus')
         call checks%check_close(fluidity_integral(problem, &
            problem%pressure_group*solution%maximum_pressure), &
            1.05_dp, 1.0e-7_dp, 'Roelands: largest pressure')
         call checks%check_close(solution%rupture_angle, iso(2, i), exact_tolerance, 'Roelands: rupture')
      end do
      problem%pressure_group = 1.15_dp*iso(4, 6)
      call solve_reynolds(problem, 1024, .true., solution)
      call checks%check(solution%status == reynolds_no_rigid_film, &
         'Roelands: no rigid film at 1.15 B_crit')
   end subroutine test_roelands

   !> Integral of eta0/eta over alpha q from 0 to a limit, Simpson's rule.
   pure function fluidity_integral(problem, limit) result(integral)
      type(film_problem_t), intent(in) :: problem  !> Viscosity law
      real(dp), intent(in) :: limit                !> Largest alpha q [-]
      real(dp) :: integral

      integer, parameter :: panels = 2000
      real(dp) :: logarithm, slope
      integer :: i

      integral = 0.0_dp
      do i = 0, panels
         call log_viscosity_ratio(problem, limit*real(i, dp)/real(panels, dp), logarithm, slope)
         integral = integral + exp(-logarithm)*real(merge(1, 2 + 2*modulo(i, 2), i == 0 .or. i == panels), dp)
      end do
      integral = integral*limit/real(3*panels, dp)
   end function fluidity_integral

   !> Input that must be rejected, and films too narrow for the grid.
   subroutine test_rejections(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: infinity, nan

      infinity = ieee_value(0.0_dp, ieee_positive_inf)
      nan = ieee_value(0.0_dp, ieee_quiet_nan)
      call expect(film_problem_t(), 63, .false., reynolds_bad_input, 'odd number of cells')
      call expect(film_problem_t(), 14, .false., reynolds_bad_input, 'too few cells')
      call expect(film_problem_t(), 16, .true., reynolds_bad_input, 'too few cells to extrapolate')
      call expect(film_problem_t(), -64, .false., reynolds_bad_input, 'negative number of cells')
      call expect(film_problem_t(rolling=nan), 64, .false., reynolds_bad_input, 'rolling not a number')
      call expect(film_problem_t(squeeze=infinity), 64, .false., reynolds_bad_input, 'infinite squeeze')
      call expect(film_problem_t(pressure_group=-1.0_dp), 64, .false., reynolds_bad_input, 'negative B')
      call expect(film_problem_t(law=7), 64, .false., reynolds_bad_input, 'unknown law')
      call expect(film_problem_t(law=law_roelands), 64, .false., reynolds_bad_input, &
         'Roelands without constants')
      call expect(film_problem_t(squeeze=1.0e101_dp), 64, .false., reynolds_bad_input, 'squeeze out of range')
      call expect(film_problem_t(squeeze=1.0e100_dp), 64, .false., reynolds_unresolved, 'fastest separation')
      call expect(film_problem_t(squeeze=-1.0e100_dp), 64, .false., reynolds_converged, 'fastest approach')
      call expect(film_problem_t(law=law_roelands, roelands_pressure=2.1_dp, roelands_logarithm=1.0_dp), 64, &
         .false., reynolds_bad_input, 'Roelands, Z out of range')
      call expect(film_problem_t(squeeze=1000.0_dp), 64, .false., reynolds_unresolved, &
         'film narrower than the cells')

   contains

      !> One problem, one status.
      subroutine expect(problem, cells, extrapolate, status, message)
         type(film_problem_t), intent(in) :: problem  !> Groups and law
         integer, intent(in) :: cells                 !> Cells
         logical, intent(in) :: extrapolate           !> Richardson's extrapolation
         integer, intent(in) :: status                !> Expected outcome
         character(len=*), intent(in) :: message      !> What is wrong with the input

         type(film_solution_t) :: solution

         call solve_reynolds(problem, cells, extrapolate, solution)
         call checks%check(solution%status == status, 'status: '//message)
      end subroutine expect

   end subroutine test_rejections

end module test_numerical_reynolds
