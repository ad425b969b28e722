!> Tests of severity: values of an independent solver, the work of the force, steps and samples of all film laws.
module test_vibration_severity
   use canonical_scenes, only: canonical_scene
   use verification, only: note_severity_errors, verification_t
   use checks, only: check_list_t
   use controlled_engine, only: solve_window
   use engine, only: ending_t, motion_state_t, start_of
   use force, only: force_of_period
   use kinds, only: dp
   use vibration_severity, only: severity_numbers, severity_of_record, severity_of_samples, vibration_severity_t
   use problem, only: of_film, of_velocity, problem_of, problem_t, static_load
   use scene_types, only: law_iso_viscous, law_piezo_viscous, model_published, model_reynolds, rupture_half_pi, rupture_solved, &
                          rupture_solver_fast, rupture_solver_successive, scene_t
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   integer, parameter :: samples = 4096

   public :: run_vibration_severity_tests

contains

   !> Runs every test of this topic.
   subroutine run_vibration_severity_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('severity')
      call test_reference(checks)
      call test_work(checks)
      call test_unclosed(checks)
      call test_cosine(checks)
      call test_error(checks)
   end subroutine run_vibration_severity_tests

   !> The canonical tooth pair under three orders.
   function scene_of(law) result(scene)
      integer, intent(in) :: law  !> Published: half-pi, solved fast and successively, piezo; exact: iso, piezo
      type(scene_t) :: scene

      scene = canonical_scene(merge(law_piezo_viscous, law_iso_viscous, any(law == [4, 6])), 512)
      scene%film%model = merge(model_reynolds, model_published, law > 4)
      scene%film%rupture = merge(rupture_solved, rupture_half_pi, any(law == [2, 3]))
      scene%film%rupture_solver = merge(rupture_solver_successive, rupture_solver_fast, law == 3)
      if (law == 6) scene%lubricant%pressure_viscosity = 1.0e-9_dp
      scene%excitation%force_orders = [1, 2, 3]
      scene%excitation%force_amplitudes = [150.0_dp, 60.0_dp, 25.0_dp]
      scene%excitation%force_phases = [0.0_dp, 0.7_dp, -1.2_dp]
   end function scene_of

   !> Solve and hand out the last periods.
   subroutine solve(problem, implicit, periods, window, states, accelerations, record)
      type(problem_t), intent(in) :: problem           !> What moves
      logical, intent(in) :: implicit                  !> By collocation
      integer, intent(in) :: periods                   !> To solve
      integer, intent(in) :: window                    !> Of them judged
      real(dp), allocatable, intent(out) :: states(:, :), accelerations(:)  !> Samples
      type(window_record_t), intent(out) :: record     !> What the steps show
      type(motion_state_t) :: start
      type(ending_t) :: ending

      start = start_of(problem)
      start%implicit = implicit
      call solve_window(problem, start, 1.0e-10_dp, samples, periods, window, states, accelerations, ending, record)
   end subroutine solve

   !> Values of an independent solver, to the digits given, and its largest acceleration.
   subroutine test_reference(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(problem_t) :: problem
      type(window_record_t) :: record
      type(vibration_severity_t) :: found
      real(dp), allocatable :: states(:, :), accelerations(:)

      problem = problem_of(scene_of(1))
      call solve(problem, .false., 60, 1, states, accelerations, record)
      found = severity_of_record(record, problem%frequency)
      call checks%check_close(found%acceleration_rms, 21.323978_dp, 0.6e-6_dp, 'reference: rms of the acceleration')
      call checks%check_close(found%acceleration_kurtosis, 4.67967_dp, 0.6e-5_dp, 'reference: kurtosis of the acceleration')
      call checks%check_close(found%film_force_rms, 145.751130_dp, 0.6e-6_dp, 'reference: rms of the film force')
      call checks%check_close(found%dissipated_energy, 3.1298907e-4_dp, 0.6e-11_dp, 'reference: dissipated energy')
   end subroutine test_reference

   !> In a periodic motion the film takes what the force gives, and steps and samples show the same.
   subroutine test_work(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      character(*), parameter :: names(6) = [character(16) :: 'half-pi', 'solved', 'successive', 'published piezo', 'exact iso', &
                                             'exact piezo']
      type(problem_t) :: problem
      type(window_record_t) :: record
      type(vibration_severity_t) :: by_steps, by_samples
      real(dp), allocatable :: states(:, :), accelerations(:)
      real(dp) :: force(samples), work
      integer :: law, implicit

      do law = 1, 6
         problem = problem_of(scene_of(law))
         call force_of_period(problem%force, force)
         do implicit = 0, 1
            call solve(problem, implicit == 1, 120, 1, states, accelerations, record)
            by_steps = severity_of_record(record, problem%frequency)
            by_samples = severity_of_samples(problem, samples, states(:, of_velocity), accelerations)
            associate (name => trim(names(law))//trim(merge(', implicit', '          ', implicit == 1)))
               work = -sum(force*states(:, of_velocity))/(real(samples, dp)*problem%frequency)
               call checks%check(work > 1.0e-6_dp, name//': the force works')
               call checks%check_close(by_steps%dissipated_energy/work, 1.0_dp, 1.0e-8_dp, name//': energy and work')
               call checks%check_close(by_samples%dissipated_energy/work, 1.0_dp, 1.0e-8_dp, name//': energy by samples')
               call checks%check_close(by_samples%acceleration_rms/by_steps%acceleration_rms, 1.0_dp, 1.0e-8_dp, &
                                       name//': rms by samples')
               call checks%check_close(by_samples%acceleration_kurtosis/by_steps%acceleration_kurtosis, 1.0_dp, 1.0e-8_dp, &
                                       name//': kurtosis by samples')
               call checks%check_close(by_samples%film_force_rms/by_steps%film_force_rms, 1.0_dp, 1.0e-8_dp, &
                                       name//': film force by samples')
            end associate
         end do
      end do
   end subroutine test_work

   !> Two periods of a motion that has not settled: what the film takes is the work of the force beyond the static load less the
   !> gain of kinetic energy, and the means are central.
   subroutine test_unclosed(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(problem_t) :: problem
      type(window_record_t) :: record
      type(vibration_severity_t) :: found
      real(dp), allocatable :: states(:, :), accelerations(:)
      real(dp) :: work, mean, variance

      problem = problem_of(scene_of(1))
      problem%initial_film = 1.5_dp*problem%initial_film
      problem%initial_velocity = -2.0e-3_dp
      call solve(problem, .false., 2, 2, states, accelerations, record)
      found = severity_of_record(record, problem%frequency)
      work = -record%force_work + static_load(problem)*(states(2*samples, of_film) - record%start%numbers(of_film)) &
             - 0.5_dp*problem%mass*(states(2*samples, of_velocity)**2 - record%start%numbers(of_velocity)**2)
      call checks%check(abs(states(2*samples, of_film)/record%start%numbers(of_film) - 1.0_dp) > 0.1_dp, &
                        'unclosed: the film has changed')
      call checks%check_close(2.0_dp*found%dissipated_energy/work, 1.0_dp, 1.0e-8_dp, 'unclosed: energy of the window')
      mean = sum(accelerations)/(2.0_dp*real(samples, dp))
      variance = sum((accelerations - mean)**2)/(2.0_dp*real(samples, dp))
      call checks%check_close(found%acceleration_kurtosis*variance**2* &
                              (2.0_dp*real(samples, dp))/sum((accelerations - mean)**4), 1.0_dp, 1.0e-3_dp, &
                              'unclosed: kurtosis about the mean')
   end subroutine test_unclosed

   !> A cosine about a mean that is not zero.
   subroutine test_cosine(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(problem_t) :: problem
      type(vibration_severity_t) :: found
      real(dp) :: accelerations(samples), velocities(samples)

      problem = problem_of(canonical_scene(law_iso_viscous, 512))
      problem%force%cosine = 0.0_dp
      call force_of_period(problem%force, accelerations)
      problem%force%cosine = 1.0_dp
      call force_of_period(problem%force, velocities)
      velocities = velocities - accelerations
      accelerations = 5.0_dp + 2.0_dp*velocities
      problem%force%cosine = 0.0_dp
      found = severity_of_samples(problem, samples, velocities, accelerations)
      call checks%check_close(found%acceleration_rms, sqrt(27.0_dp), 1.0e-11_dp, 'cosine: rms about zero')
      call checks%check_close(found%acceleration_kurtosis, 1.5_dp, 1.0e-11_dp, 'cosine: kurtosis about the mean')
      call checks%check_close(found%film_force_rms/problem%mass, sqrt(2.0_dp), 1.0e-11_dp, 'cosine: film force about its mean')
      call checks%check_close(found%dissipated_energy*problem%frequency/problem%mass, -1.0_dp, 1.0e-11_dp, &
                              'cosine: work in phase with the velocity')
   end subroutine test_cosine

   !> The largest error of the four numbers by a tighter solution, which has one of its own.
   subroutine test_error(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(verification_t) :: verification
      real(dp) :: tight(4)
      integer :: i

      do i = 1, 4
         tight = [1.0_dp, 2.0_dp, 3.0_dp, 4.0_dp]
         tight(i) = 1.01_dp*tight(i)
         call note_severity_errors(vibration_severity_t(1.0_dp, 2.0_dp, 3.0_dp, 4.0_dp), &
                                   vibration_severity_t(tight(1), tight(2), tight(3), tight(4)), 1.0e-10_dp, verification)
         call checks%check_close(verification%severity_error, 0.020000002_dp, 1.0e-14_dp, 'error: twice the difference')
         associate (errors => severity_numbers(verification%severity_errors), numbers => [1.0_dp, 2.0_dp, 3.0_dp, 4.0_dp])
            call checks%check_close(errors(i), 0.020000002_dp*numbers(i), 1.0e-13_dp, 'error: of the number that differs')
            call checks%check(count(errors > 1.0e-8_dp) == 1, 'error: of no other one')
         end associate
      end do
   end subroutine test_error

end module test_vibration_severity
