!> Tests of the error-controlled engine where its series do not see what comes, and where a motion only seems to repeat.
!> The scenes are such on which random trials had found a wrong motion that ended as if it were right.
module test_taylor_surprises
   use checks, only: check_list_t
   use constants, only: standard_gravity
   use engine, only: ending_t, request_t, start_of
   use film_law, only: kernel_half_pi, kernel_reynolds_iso
   use kinds, only: dp
   use many_motions, only: solve_motions
   use problem, only: of_film, problem_of, problem_t
   use scene_status, only: status_complete
   use scene_types, only: law_iso_viscous, law_piezo_viscous, model_reynolds, rupture_solved, rupture_solver_fast, scene_t
   implicit none(type, external)
   private

   public :: run_taylor_surprises_tests

contains

   !> Run all tests of this module.
   subroutine run_taylor_surprises_tests(checks)
      !> Outcome so far
      type(check_list_t), intent(inout) :: checks

      call checks%start('taylor surprises')
      call test_slow_terms(checks)
      call test_load_after_flight(checks)
      call test_slow_direction(checks)
      call test_solved_rupture(checks)
      call test_slow_drift(checks)
   end subroutine run_taylor_surprises_tests

   !> Largest relative error of the film over the last periods, against a far tighter solution.
   subroutine largest_error(scene, accuracy, periods, until_steady, error, ending)
      type(problem_t), intent(in) :: scene
      !> Accuracy asked for [-]
      real(dp), intent(in) :: accuracy
      !> Periods to solve
      integer, intent(in) :: periods
      !> Stop when the motion repeats
      logical, intent(in) :: until_steady
      !> [-]
      real(dp), intent(out) :: error
      !> How it ended
      type(ending_t), intent(out) :: ending
      integer, parameter :: per_period = 16, sampled = 8
      real(dp), dimension(sampled*per_period, 2, 1) :: states, exact
      type(ending_t) :: endings(1)
      type(request_t) :: request

      states = 0.0_dp
      request = request_t(accuracy=1.0e-11_dp, periods=periods, samples_per_period=per_period, sampled_periods=sampled)
      call solve_motions([scene], [start_of(scene)], request, states, endings)
      exact = states
      request%accuracy = accuracy
      request%until_steady = until_steady
      call solve_motions([scene], [start_of(scene)], request, states, endings)
      ending = endings(1)
      error = maxval(abs(states(:, of_film, :)/exact(:, of_film, :) - 1.0_dp))
   end subroutine largest_error

   !> Light damping and slow surfaces: half-way through a period the terms of the series are all alike, and the last of them
   !> is no measure of those left out.
   subroutine test_slow_terms(checks)
      type(check_list_t), intent(inout) :: checks
      type(problem_t) :: scene
      type(ending_t) :: ending
      real(dp) :: error

      scene%contact%film%kernel = kernel_reynolds_iso
      scene%contact%film%radius = 2.3876495360356676e-3_dp
      scene%contact%film%speed = 5.7905602267840174e-2_dp
      scene%contact%film%scale = 1.3773074987286440e-4_dp
      scene%contact%film%squeeze_rate = 2.3867652204519580_dp
      scene%mass = 1.1847070022232703e-1_dp
      scene%weight = 1.1618006923352833_dp
      scene%force%steady = 8.5248996137767730e-1_dp
      scene%force%cosine = 1.1335863523156863e1_dp
      scene%frequency = 3.3377924443537181e3_dp
      scene%initial_film = 1.3945928475863152e-5_dp
      call largest_error(scene, 1.0e-4_dp, 14, .false., error, ending)
      call checks%check(.not. ending%implicit, 'slow terms: by series')
      call checks%check(error < 20.0e-4_dp, 'slow terms: error')
   end subroutine test_slow_terms

   !> A tooth thrown up: its film carries nothing, until it comes down within one step of free flight.
   subroutine test_load_after_flight(checks)
      type(check_list_t), intent(inout) :: checks
      type(problem_t) :: scene
      type(ending_t) :: ending
      real(dp) :: error
      integer :: digits

      scene%contact%film%kernel = kernel_reynolds_iso
      scene%contact%film%radius = 8.3212234704100108e-2_dp
      scene%contact%film%speed = 5.0148848203949430e-2_dp
      scene%contact%film%scale = 3.6059898361908885e-2_dp
      scene%contact%film%squeeze_rate = 1.6269628012664370e1_dp
      scene%mass = 2.0489868142673440_dp
      scene%weight = 2.0093696542134847e1_dp
      scene%force%steady = 2.5718992217975565e3_dp
      scene%force%cosine = 8.5688727383669557e3_dp
      scene%frequency = 3.2351430272900971e3_dp
      scene%initial_film = 3.5893279803907646e-6_dp
      do digits = 3, 6
         call largest_error(scene, 10.0_dp**(-digits), 12, .false., error, ending)
         call checks%check(.not. ending%implicit, 'load after flight: by series')
         call checks%check(error < 4.0_dp*10.0_dp**(-digits), 'load after flight: error')
      end do
   end subroutine test_load_after_flight

   !> The film settles at once, the velocity by one per cent a period: two ratios of the distance are small before the slow
   !> direction is all that is left.
   subroutine test_slow_direction(checks)
      type(check_list_t), intent(inout) :: checks
      type(problem_t) :: scene
      type(ending_t) :: ending
      real(dp) :: error

      scene%contact%film%kernel = kernel_half_pi
      scene%contact%film%radius = 3.0260019130531328e-2_dp
      scene%contact%film%speed = 5.7712742755697308e-2_dp
      scene%contact%film%rolling = 3.1349266025364127e-4_dp
      scene%contact%film%squeeze = 7.1587712878562091e-4_dp
      scene%contact%film%squeeze_rate = 8.5252648189720279_dp
      scene%mass = 2.0946522249044204_dp
      scene%weight = 2.0541521241358932e1_dp
      scene%force%steady = 2.5606598107152614_dp
      scene%force%cosine = 2.2477053946577504e2_dp
      scene%frequency = 3.7803949891367083e3_dp
      scene%initial_film = 1.3569829599508520e-5_dp
      call largest_error(scene, 1.0e-8_dp, 14, .true., error, ending)
      call checks%check(ending%status == status_complete, 'a slow direction is not at rest')
      call checks%check(error < 30.0e-8_dp, 'slow direction: error')
   end subroutine test_slow_direction

   !> The published film with rupture solved, thrown up by forces of several static loads; a disturbance of the first grows by
   !> 1.7, and 30 times that is what the errors of its periods may add up to.
   subroutine test_solved_rupture(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: accuracy(2) = [1.0e-4_dp, 1.0e-6_dp]
      integer, parameter :: periods(2) = [21, 19]
      type(scene_t) :: scenes(2)
      type(ending_t) :: ending
      real(dp) :: error
      integer :: i

      scenes%film%law = law_iso_viscous
      scenes%film%rupture = rupture_solved
      scenes%film%rupture_solver = rupture_solver_fast
      scenes%contact%radius = [5.481505246044251e-2_dp, 4.110801607969542e-3_dp]
      scenes%contact%length = [2.482650588895104_dp, 1.3145276388388247e1_dp]
      scenes%lubricant%viscosity = [1.4116535368984156e-3_dp, 2.2617399322324586e-1_dp]
      scenes%kinematics%entrainment_speed = [1.4556216504284314e-1_dp, 2.6123350837128096e-2_dp]
      scenes%excitation%mass = [3.0481749918051043e-1_dp, 1.9599910303633315e1_dp]
      scenes%excitation%steady_force = [2.6476179534595015_dp, 2.0093811269988987e2_dp]
      scenes%excitation%force_amplitude = [1.3731101564097994e1_dp, 3.12891527894301e2_dp]
      scenes%excitation%frequency = [3.3203726876730893e3_dp, 4.565151742131865e3_dp]
      scenes%excitation%gravity = standard_gravity
      do i = 1, 2
         call largest_error(problem_of(scenes(i)), accuracy(i), periods(i), .false., error, ending)
         call checks%check(error < 50.0_dp*accuracy(i), 'solved rupture: error')
      end do
   end subroutine test_solved_rupture

   !> Reynolds films that hardly damp and rise for hundreds of periods: the errors of long steps have one sign in every period, and
   !> nothing takes them back.
   subroutine test_slow_drift(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: accuracy = 1.0e-8_dp
      integer, parameter :: periods(2) = [20, 19]
      type(scene_t) :: scenes(2)
      type(ending_t) :: ending
      real(dp) :: error
      integer :: i

      scenes%film%law = [law_iso_viscous, law_piezo_viscous]
      scenes%film%model = model_reynolds
      scenes%contact%radius = [1.93865446011907e-2_dp, 1.6020974452047476e-2_dp]
      scenes%contact%length = [5.59338826537699e-2_dp, 1.0_dp]
      scenes%lubricant%viscosity = [9.100549814564605e-2_dp, 2.466993085450881e-1_dp]
      scenes%lubricant%pressure_viscosity = [1.0184313417353531e-9_dp, 2.389375542836103e-6_dp]
      scenes%kinematics%entrainment_speed = [8.901207788764973e-2_dp, 1.0392731254470945e-1_dp]
      scenes%excitation%mass = [4.658884809511463e-2_dp, 5.168492983542199e-1_dp]
      scenes%excitation%steady_force = [9.791663787723879e-1_dp, 8.695342057114708e-2_dp]
      scenes%excitation%force_amplitude = [1.8799435966339346_dp, 4.333756218537626e1_dp]
      scenes%excitation%frequency = [2.3111980781663406e3_dp, 2.935898664916683e3_dp]
      scenes%excitation%gravity = standard_gravity
      do i = 1, 2
         call largest_error(problem_of(scenes(i)), accuracy, periods(i), .false., error, ending)
         call checks%check(.not. ending%implicit, 'slow drift: by series')
         call checks%check(error < 30.0_dp*accuracy, 'slow drift: error')
      end do
   end subroutine test_slow_drift

end module test_taylor_surprises
