!> Tests of the tooth between two flanks: rest, references of independent codes, symmetry, the limit of one flank.
module test_two_flanks
   use canonical_scenes, only: loose_gear
   use checks, only: check_list_t, same_bits
   use controlled_engine, only: solve_window
   use engine, only: ending_t, motion_state_t, request_t, start_of
   use film_law, only: film_load
   use fourier, only: amplitude_spectrum
   use film_state, only: load_t
   use kinds, only: dp
   use many_motions, only: solve_motions
   use vibration_severity, only: severity_of_record, severity_of_samples, vibration_severity_t
   use node_extremes, only: seen_loads, seen_net_load
   use carried_loads, only: net_load
   use problem, only: film_at_rest, of_film, of_velocity, problem_of, problem_t
   use scene_status, only: is_success, status_complete
   use scene_types, only: law_iso_viscous, law_piezo_viscous, model_published, model_reynolds, rupture_half_pi, rupture_solved, &
                          scene_t
   use window_record, only: energy_gap, window_record_t
   implicit none(type, external)
   private

   !> Samples of a period of the references, and the accuracy of theirs and of the engine.
   integer, parameter :: samples = 2048
   real(dp), parameter :: accuracy = 1.0e-9_dp, agreement = 1.0e-6_dp

   public :: run_two_flanks_tests

contains

   !> Runs every test of this topic.
   subroutine run_two_flanks_tests(checks)
      type(check_list_t), intent(inout) :: checks

      call checks%start('two_flanks')
      call test_rest(checks)
      call test_slopes(checks)
      call test_reference_1(checks)
      call test_reference_3(checks)
      call test_reference_4(checks)
      call test_mirror(checks)
      call test_series(checks)
      call test_wide_backlash(checks)
   end subroutine run_two_flanks_tests

   !> The canonical scene with a backlash.
   type(scene_t) function canonical_between_flanks(law, model, rupture) result(scene)
      integer, intent(in) :: law
      integer, intent(in) :: model
      integer, intent(in) :: rupture

      scene%contact%radius = 0.0127_dp
      scene%contact%length = 0.01_dp
      scene%contact%young_modulus = 205.66e9_dp
      scene%contact%poisson_ratio = 0.3_dp
      scene%contact%backlash = 4.0e-6_dp
      scene%lubricant%viscosity = 0.3_dp
      scene%lubricant%pressure_viscosity = 2.0e-8_dp
      scene%kinematics%entrainment_speed = 1.905_dp
      scene%excitation%mass = 3.0_dp
      scene%excitation%frequency = 600.0_dp
      scene%excitation%steady_force = 20.0_dp
      scene%excitation%force_amplitude = 205.7_dp
      scene%film%law = law
      scene%film%model = model
      scene%film%rupture = rupture
   end function canonical_between_flanks

   !> At rest the net load is the static one, from films pressed against one flank to films pressed against the other.
   subroutine test_rest(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: loads(*) = [-5000.0_dp, -300.0_dp, -1.0_dp, -1.0e-6_dp, 0.0_dp, 1.0e-6_dp, 1.0_dp, 300.0_dp, 5000.0_dp]
      type(problem_t) :: problem
      type(scene_t) :: scene
      type(load_t) :: net
      real(dp) :: film, mirrored, by_film, by_velocity, drive, tolerance
      integer :: i, law

      do law = 1, 4
         problem = problem_of(scene_of_law(law))
         do i = 1, size(loads)
            ! No Reynolds piezo-viscous film is that thin.
            if (law == 4 .and. abs(loads(i)) > 1000.0_dp) cycle
            film = film_at_rest(problem, loads(i))
            mirrored = film_at_rest(problem, -loads(i))
            call checks%check(film > 0.0_dp .and. film < problem%backlash, 'rest: between the flanks')
            call film_load(problem%contact%film, film, 0.0_dp, drive, by_film, by_velocity)
            call net_load(problem, film, 0.0_dp, net)
            ! b - h loses the digits by which h is shorter than b.
            tolerance = 16.0_dp*epsilon(1.0_dp)*(drive + abs(loads(i)) + abs(net%by_film)*problem%backlash)
            call checks%check(abs(net%load - loads(i)) <= tolerance, 'rest: the net load is the static one')
            call checks%check(abs(film - (problem%backlash - mirrored)) <= 8.0_dp*epsilon(1.0_dp)*problem%backlash, &
                              'rest: mirrored with the load')
         end do
      end do
      scene = scene_of_law(4)
      scene%lubricant%pressure_viscosity = 2.0e-8_dp
      problem = problem_of(scene)
      call checks%check(.not. film_at_rest(problem, 5000.0_dp) > 0.0_dp, 'rest: no rigid piezo-viscous film carries 5000 N')
      call checks%check(.not. film_at_rest(problem, -5000.0_dp) > 0.0_dp, 'rest: nor at the other flank')
   end subroutine test_rest

   !> One of the laws with a series.
   type(scene_t) function scene_of_law(law) result(scene)
      integer, intent(in) :: law

      select case (law)
      case (1)
         scene = canonical_between_flanks(law_iso_viscous, model_published, rupture_half_pi)
      case (2)
         scene = canonical_between_flanks(law_piezo_viscous, model_published, rupture_half_pi)
      case (3)
         scene = canonical_between_flanks(law_iso_viscous, model_reynolds, rupture_half_pi)
      case (5)
         scene = canonical_between_flanks(law_iso_viscous, model_published, rupture_solved)
      case default
         scene = canonical_between_flanks(law_piezo_viscous, model_reynolds, rupture_half_pi)
         scene%lubricant%pressure_viscosity = 2.0e-9_dp
      end select
   end function scene_of_law

   !> Slopes of the net load against differences.
   subroutine test_slopes(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: step = 1.0e-5_dp, film = 1.3e-6_dp, velocity = 2.0e-4_dp
      type(problem_t) :: problem
      type(load_t) :: load, above, below
      integer :: law

      do law = 1, 4
         problem = problem_of(scene_of_law(law))
         call net_load(problem, film, velocity, load)
         call net_load(problem, film*(1.0_dp + step), velocity, above)
         call net_load(problem, film*(1.0_dp - step), velocity, below)
         call checks%check_close((above%load - below%load)/(2.0_dp*step*film*load%by_film), 1.0_dp, 1.0e-7_dp, 'slope in the film')
         call net_load(problem, film, velocity*(1.0_dp + step), above)
         call net_load(problem, film, velocity*(1.0_dp - step), below)
         call checks%check_close((above%load - below%load)/(2.0_dp*step*velocity*load%by_velocity), 1.0_dp, 1.0e-7_dp, &
                                 'slope in the velocity')
      end do
   end subroutine test_slopes

   !> R1: Reynolds film, three orders.
   subroutine test_reference_1(checks)
      type(check_list_t), intent(inout) :: checks

      call compare(checks, 'R1', loose_gear_problem(), [2.0385964e-06_dp, 9.5180665e-05_dp], [-15.900521_dp, 36.042153_dp], &
                   [1.0544934_dp, 2.0593625_dp, 1.5235086_dp, 0.8887504_dp, 1.8208022_dp, 2.0759337_dp, 1.2894884_dp, &
                    0.4725849_dp], [22.91200_dp, 8.87695_dp], &
                   vibration_severity_t(4.939422_dp, 22.1410_dp, 6.424069_dp, 1.5696859e-4_dp))

   contains

      type(problem_t) function loose_gear_problem()
         loose_gear_problem = problem_of(loose_gear())
      end function loose_gear_problem

   end subroutine test_reference_1

   !> R3: published piezo-viscous film.
   subroutine test_reference_3(checks)
      type(check_list_t), intent(inout) :: checks

      call compare(checks, 'R3', problem_of(canonical_between_flanks(law_piezo_viscous, model_published, rupture_half_pi)), &
                   [1.0171632e-06_dp, 2.9199843e-06_dp], [-21.034912_dp, 21.334129_dp], &
                   [14.4858004_dp, 2.8541201_dp, 10.8644005_dp, 2.6224554_dp, 3.5903728_dp, 1.2712236_dp, 1.0567365_dp, &
                    0.5642385_dp], [283.4196_dp, 249.5708_dp], &
                   vibration_severity_t(13.398022_dp, 1.56530_dp, 171.143605_dp, 4.5073491e-4_dp))
   end subroutine test_reference_3

   !> R4: published iso-viscous film, no static load.
   subroutine test_reference_4(checks)
      type(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene

      scene = loose_gear()
      scene%film%model = model_published
      scene%contact%backlash = 8.0e-5_dp
      scene%excitation%steady_force = 0.0_dp
      scene%excitation%force_orders = [1, 4]
      scene%excitation%force_amplitudes = [6.0_dp, 3.0_dp]
      scene%excitation%force_phases = [0.0_dp, 0.3_dp]
      call compare(checks, 'R4', problem_of(scene), [1.0214233e-06_dp, 7.9708353e-05_dp], [-466.402023_dp, 55.880566_dp], &
                   [1.1560955_dp, 1.0103131_dp, 1.8883829_dp, 4.4178161_dp, 2.4031906_dp, 4.9109625_dp, 1.7944560_dp, &
                    3.6924518_dp], [32.4707_dp, 217.1656_dp], &
                   vibration_severity_t(18.249671_dp, 343.762_dp, 9.650001_dp, 6.4343945e-4_dp))
   end subroutine test_reference_4

   !> Compare one period of a steady motion with a reference.
   subroutine compare(checks, name, problem, films, accelerations, harmonics, loads, severity)
      type(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: name
      type(problem_t), intent(in) :: problem
      !> Smallest and largest of the samples: h [m], z'' [m/s2]
      real(dp), intent(in) :: films(2)
      real(dp), intent(in) :: accelerations(2)
      !> Of z'' [m/s2]
      real(dp), intent(in) :: harmonics(:)
      !> Largest loads of the drive and the coast film [N]
      real(dp), intent(in) :: loads(2)
      !> To the digits given
      type(vibration_severity_t), intent(in) :: severity
      integer, parameter :: periods = 400
      type(ending_t) :: found
      type(window_record_t) :: record
      type(vibration_severity_t) :: reported
      real(dp), allocatable :: states(:, :), z(:), amplitudes(:)

      call solve_window(problem, start_of(problem), accuracy, 1, periods, 1, states, z, found, record, until_steady=.true.)
      call checks%check(is_success(found%status) .and. found%orbit == 1, name//': repeats after one period')
      call solve_window(problem, start_of(problem), accuracy, samples, found%periods + 1, 1, states, z, found, record)
      call checks%check(found%status == status_complete, name//': solved')
      if (found%status /= status_complete) return
      call checks%check(maxval(abs([minval(states(:, of_film)), maxval(states(:, of_film))] - films)) < agreement*films(2), &
                        name//': film')
      call checks%check(maxval(abs([minval(z), maxval(z)] - accelerations)) < agreement*maxval(abs(accelerations)), &
                        name//': acceleration')
      call amplitude_spectrum(z, amplitudes)
      call checks%check(maxval(abs(amplitudes(1:size(harmonics)) - harmonics)) < agreement*maxval(harmonics), &
                        name//': harmonics')
      ! Largest loads of the references are those of 4096 samples, to six digits.
      call checks%check(abs(record%highest(seen_loads(1))%value/loads(1) - 1.0_dp) < 1.0e-4_dp, name//': drive load')
      call checks%check(abs(record%highest(seen_loads(2))%value/loads(2) - 1.0_dp) < 1.0e-4_dp, name//': coast load')
      call checks%check(record%lowest(seen_net_load)%value < 0.0_dp, name//': double-sided')
      reported = severity_of_record(record, problem%frequency)
      call checks%check_close(reported%acceleration_rms/severity%acceleration_rms, 1.0_dp, 1.0e-6_dp, name//': rms')
      call checks%check_close(reported%acceleration_kurtosis/severity%acceleration_kurtosis, 1.0_dp, 4.0e-6_dp, name//': kurtosis')
      call checks%check_close(reported%film_force_rms/severity%film_force_rms, 1.0_dp, 1.0e-6_dp, name//': net film force')
      call checks%check_close(reported%dissipated_energy/severity%dissipated_energy, 1.0_dp, 1.0e-6_dp, name//': dissipated energy')
      ! The impacts of R4 need twice as many samples.
      reported = severity_of_samples(problem, samples, states(:, of_velocity), z)
      call checks%check_close(reported%film_force_rms/severity%film_force_rms, 1.0_dp, 2.0e-4_dp, &
                              name//': net film force by samples')
      call checks%check_close(reported%dissipated_energy/severity%dissipated_energy, 1.0_dp, 2.0e-4_dp, name//': energy by samples')
      call checks%check(energy_gap(record, problem%mass) < 1.0e-7_dp, name//': energy closes')
   end subroutine compare

   !> Without static load and under odd orders the motion is its own mirror image half a period later, or one of a pair.
   subroutine test_mirror(checks)
      type(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene
      type(problem_t) :: problem, mirrored
      type(ending_t) :: found
      type(window_record_t) :: record
      real(dp), allocatable :: states(:, :), z(:), other_states(:, :)

      scene = canonical_between_flanks(law_piezo_viscous, model_published, rupture_half_pi)
      scene%excitation%steady_force = 0.0_dp
      problem = problem_of(scene)
      call solve_window(problem, start_of(problem), accuracy, 1, 400, 1, states, z, found, record, until_steady=.true.)
      call solve_window(problem, start_of(problem), accuracy, samples, found%periods + 1, 1, states, z, found, record)
      call checks%check(maxval(abs(cshift(states(:, of_film), samples/2) - (problem%backlash - states(:, of_film)))) &
                        < 1.0e-7_dp*problem%backlash, 'mirror: its own image half a period later')
      ! A motion under the mirrored force is the mirrored motion.
      scene%excitation%steady_force = 20.0_dp
      problem = problem_of(scene)
      scene%excitation%steady_force = -20.0_dp
      scene%excitation%force_orders = [1]
      scene%excitation%force_amplitudes = [scene%excitation%force_amplitude]
      scene%excitation%force_phases = [acos(-1.0_dp)]
      mirrored = problem_of(scene)
      call solve_window(problem, start_of(problem), accuracy, 64, 5, 5, states, z, found, record)
      call solve_window(mirrored, start_of(mirrored), accuracy, 64, 5, 5, other_states, z, found, record)
      call checks%check(maxval(abs(other_states(:, of_film) - (problem%backlash - states(:, of_film)))) &
                        < 1.0e-7_dp*problem%backlash, 'mirror: of the mirrored force')
   end subroutine test_mirror

   !> Taylor series and collocation follow the same motion; a motion has the same bits alone and beside those on one flank and of
   !> other laws.
   subroutine test_series(checks)
      type(check_list_t), intent(inout) :: checks
      integer, parameter :: laws = 5, periods = 8, motions = 3*laws
      real(dp), parameter :: asked = 1.0e-8_dp
      type(problem_t) :: problems(motions)
      type(motion_state_t) :: starts(motions)
      type(request_t) :: request
      type(ending_t) :: endings(motions)
      real(dp), dimension(64, 2, motions) :: by_series, by_collocation, alone
      integer :: i

      request = request_t(accuracy=asked, periods=periods, samples_per_period=64, sampled_periods=1)
      do i = 1, motions
         problems(i) = problem_of(scene_of_law(modulo(i - 1, laws) + 1))
         if (i > laws) problems(i)%force%cosine = problems(i)%force%cosine*(0.6_dp + 0.01_dp*real(i, dp))
         if (i > 2*laws) problems(i)%backlash = huge(1.0_dp)
      end do
      starts = start_of(problems)
      starts%implicit = .true.
      call solve_motions(problems, starts, request, by_collocation, endings)
      starts%implicit = .false.
      call solve_motions(problems, starts, request, by_series, endings)
      do i = 1, 2*laws
         call checks%check(endings(i)%status == status_complete, 'series: solved')
         call checks%check(.not. endings(i)%implicit, 'series: by series')
         associate (h => by_series(:, of_film, i), w => by_series(:, 2, i))
            call checks%check(maxval(abs(h - by_collocation(:, of_film, i))) < 10.0_dp*asked*minval(h), &
                              'series: film of collocation')
            call checks%check(maxval(abs(w - by_collocation(:, 2, i))) < 100.0_dp*asked*maxval(abs(w)), &
                              'series: velocity of collocation')
         end associate
         call solve_motions(problems(i:i), starts(i:i), request, alone(:, :, i:i), endings(i:i))
         call checks%check(all(same_bits(alone(:, :, i), by_series(:, :, i))), 'series: the same alone')
      end do
   end subroutine test_series

   !> A backlash of a metre changes no more than the load of a coast film a metre thick, and a tenth of it ten times as much.
   subroutine test_wide_backlash(checks)
      type(check_list_t), intent(inout) :: checks
      type(problem_t) :: problem
      type(ending_t) :: ending
      type(window_record_t) :: record
      real(dp), allocatable :: states(:, :), z(:), wide(:, :), narrower(:, :)
      real(dp) :: differences(2), by_one

      problem = problem_of(canonical_between_flanks(law_iso_viscous, model_reynolds, rupture_half_pi))
      problem%force%steady = 199.2_dp
      problem%rest_films = -1.0_dp
      problem%backlash = huge(1.0_dp)
      problem%initial_film = 1.0e-6_dp
      call solve_window(problem, start_of(problem), 1.0e-11_dp, 64, 3, 3, states, z, ending, record)
      problem%backlash = 1.0_dp
      call solve_window(problem, start_of(problem), 1.0e-11_dp, 64, 3, 3, wide, z, ending, record)
      problem%backlash = 0.1_dp
      call solve_window(problem, start_of(problem), 1.0e-11_dp, 64, 3, 3, narrower, z, ending, record)
      differences = [maxval(abs(wide(:, of_film)/states(:, of_film) - 1.0_dp)), &
                     maxval(abs(narrower(:, of_film)/states(:, of_film) - 1.0_dp))]
      ! The coast film carries 1.8e-6 of the static load; a tooth in flight answers some twenty times as much.
      problem%backlash = 1.0_dp
      by_one = film_at_rest(problem, 199.2_dp)
      problem%backlash = huge(1.0_dp)
      call checks%check_close(film_at_rest(problem, 199.2_dp)/by_one, 1.0_dp, 2.0e-6_dp, 'at rest the load of the coast film')
      call checks%check(differences(1) < 1.0e-4_dp, 'a metre of backlash is one flank')
      call checks%check_close(differences(2)/differences(1), 10.0_dp, 1.0_dp, 'and the difference falls as 1/b')
   end subroutine test_wide_backlash

end module test_two_flanks
