!> Tests of whole motions: the canonical scenes against converged values of another integrator.
module test_integrate_motion
   use canonical_scenes, only: canonical_scene, counting_watcher_t, run_window
   use checks, only: check_list_t
   use engine, only: ending_t, motion_count_t, request_t
   use film_law, only: film_load, film_t, kernel_of, new_film, steady_film
   use film_pressure, only: exact_pressure
   use force, only: cosine_force, force_of_period
   use kinds, only: dp
   use newmark, only: advance_period, start_motion, newmark_state_t
   use problem, only: of_film, of_velocity, problem_of, problem_t
   use sample_recorder, only: sample_recorder_t
   use scene_status, only: status_complete, status_no_rigid_film, status_not_converged, status_overflow
   use scene_types, only: law_iso_viscous, law_piezo_viscous, model_reynolds, rupture_solved, scene_t, spectrum_choice_t
   use harmonic_spectrum, only: find_harmonics, harmonic_spectrum_t
   implicit none(type, external)
   private

   !> Extremes and first harmonics of a window.
   type :: response_t
      !> h_min, h_max [m], z'' least and largest [m/s2]
      real(dp) :: extremes(4) = 0.0_dp
      !> a_1 to a_6 [m/s2]
      real(dp) :: harmonics(6) = 0.0_dp
      type(harmonic_spectrum_t) :: spectrum
      integer :: status = -1
   end type response_t

   public :: run_integrate_motion_tests

contains

   !> Runs every test of this topic.
   subroutine run_integrate_motion_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('integrate_motion')
      call test_idle(checks)
      call test_creep(checks)
      call test_solved(checks)
      call test_reynolds(checks)
      call test_no_rigid_film(checks)
      call test_start_up(checks)
      call test_bookkeeping(checks)
      call test_failures(checks)
   end subroutine run_integrate_motion_tests

   !> Solve a scene and take its window apart.
   subroutine respond(scene, response)
      type(scene_t), intent(in) :: scene         !> Scene with a window of one period
      type(response_t), intent(out) :: response  !> What is in the window

      type(sample_recorder_t) :: recorder
      type(ending_t) :: ending

      call run_window(scene, recorder, ending)
      response%status = ending%status
      if (ending%status /= status_complete) return
      response%extremes = [minval(recorder%states(:, of_film, 1)), maxval(recorder%states(:, of_film, 1)), &
                             minval(recorder%accelerations), maxval(recorder%accelerations)]
      call find_harmonics(recorder%accelerations, 1, spectrum_choice_t(), 1.0e-10_dp, response%spectrum)
      response%harmonics = response%spectrum%harmonics(:6)
   end subroutine respond

   !> A converged row of extremes, harmonics and lines.
   subroutine compare(checks, name, response, extremes, harmonics, harmonic_count)
      type(check_list_t), intent(inout) :: checks   !> Collects the results
      character(*), intent(in) :: name              !> Scene
      type(response_t), intent(in) :: response      !> Computed with 4096 steps
      real(dp), intent(in) :: extremes(4)           !> h_min, h_max [m], z'' min, max [m/s2]
      real(dp), intent(in) :: harmonics(6)          !> a_1 to a_6 [m/s2]
      integer, intent(in) :: harmonic_count             !> Lines over 1 % of the first

      !> Error of the method at 4096 steps, shown by halving, and the digits of the values compared with.
      real(dp), parameter :: film_error = 1.0e-5_dp, acceleration_error = 3.0e-5_dp
      integer :: i

      call checks%check(response%status == status_complete, name//': ended well')
      do i = 1, 2
         call checks%check_close(response%extremes(i)/extremes(i), 1.0_dp, film_error, name//': extreme film')
         call checks%check_close(response%extremes(2 + i)/extremes(2 + i), 1.0_dp, acceleration_error, &
            name//': extreme acceleration')
      end do
      do i = 1, 6
         call checks%check_close(response%harmonics(i)/harmonics(i), 1.0_dp, film_error, name//': harmonic')
      end do
      call checks%check(response%spectrum%harmonic_count == harmonic_count, name//': number of lines')
      call checks%check(response%spectrum%sampling_sufficient, name//': enough samples')
   end subroutine compare

   !> Halving the step brings extremes and harmonics nearer by the square.
   subroutine check_order(checks, name, coarse, middle, fine)
      type(check_list_t), intent(inout) :: checks   !> Collects the results
      character(*), intent(in) :: name              !> Scene
      type(response_t), intent(in) :: coarse        !> With 1024 steps a period
      type(response_t), intent(in) :: middle        !> With 2048
      type(response_t), intent(in) :: fine          !> With 4096

      integer :: i

      do i = 1, 6
         call checks%check_close((coarse%harmonics(i) - middle%harmonics(i))/(middle%harmonics(i) &
            - fine%harmonics(i)), &
            4.0_dp, 0.1_dp, name//': order of a harmonic')
      end do
   end subroutine check_order

   !> Idle rattle, (35).
   subroutine test_idle(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(response_t) :: responses(3)
      integer :: i

      do i = 1, 3
         call respond(canonical_scene(law_iso_viscous, 512*2**i), responses(i))
      end do
      call compare(checks, 'idle', responses(3), [0.341405e-6_dp, 3.570926e-6_dp, -64.348064_dp, &
         202.785793_dp], &
         [21.2023751_dp, 30.5365166_dp, 25.8178690_dp, 22.4385275_dp, 19.3319685_dp, 16.5060500_dp], 30)
      call check_order(checks, 'idle', responses(1), responses(2), responses(3))
      call checks%check(responses(3)%spectrum%harmonic_distortion > 1.0_dp, 'idle: distortion')
   end subroutine test_idle

   !> Creep rattle, (37).
   subroutine test_creep(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(response_t) :: responses(3)
      integer :: i

      do i = 1, 3
         call respond(canonical_scene(law_piezo_viscous, 512*2**i), responses(i))
      end do
      call compare(checks, 'creep', responses(3), [0.837089e-6_dp, 1.827841e-6_dp, -27.155588_dp, &
         14.733975_dp], &
         [6.3805133_dp, 8.5944899_dp, 6.5732897_dp, 4.1034383_dp, 2.4808443_dp, 1.5245533_dp], 12)
      call check_order(checks, 'creep', responses(1), responses(2), responses(3))
   end subroutine test_creep

   !> Idle rattle with the rupture angle solved at every evaluation.
   subroutine test_solved(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(scene_t) :: scene
      type(response_t) :: response

      scene = canonical_scene(law_iso_viscous, 4096)
      scene%film%rupture = rupture_solved
      scene%solver%periods = 40
      call respond(scene, response)
      call compare(checks, 'x_e solved', response, [0.245194e-6_dp, 4.676586e-6_dp, -82.560498_dp, &
         387.838543_dp], &
         [28.9175793_dp, 40.2342318_dp, 35.9704977_dp, 34.0112309_dp, 30.7059169_dp, 27.0072316_dp], 47)
   end subroutine test_solved

   !> The Reynolds iso-viscous film, at the paper's u and at the true entrainment speed.
   subroutine test_reynolds(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(scene_t) :: scene
      type(response_t) :: response

      scene = canonical_scene(law_iso_viscous, 4096)
      scene%film%model = model_reynolds
      call respond(scene, response)
      call compare(checks, 'Reynolds film, u_r = 3.810', response, [0.409978e-6_dp, 6.885256e-6_dp, -92.317481_dp, &
         370.473132_dp], &
         [42.1753420_dp, 52.7575920_dp, 44.9082791_dp, 38.5704473_dp, 32.4493844_dp, 27.3582296_dp], 33)
      scene%kinematics%entrainment_speed = 0.5_dp*1.905_dp
      call respond(scene, response)
      call compare(checks, 'Reynolds film, u_r = 1.905', response, [0.400824e-6_dp, 3.478332e-6_dp, -61.644347_dp, &
         123.573157_dp], &
         [20.8160154_dp, 28.7555678_dp, 21.6951357_dp, 17.0416711_dp, 13.3297691_dp, 10.3671095_dp], 21)
   end subroutine test_reynolds

   !> The Reynolds piezo-viscous film ends where alpha p reaches 1, and not before.
   subroutine test_no_rigid_film(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(scene_t) :: scene
      type(sample_recorder_t) :: recorder
      type(ending_t) :: ending
      type(film_t) :: film

      scene = canonical_scene(law_piezo_viscous, 4096)
      scene%film%model = model_reynolds
      call run_window(scene, recorder, ending)
      film = new_film(scene)
      call checks%check(ending%status == status_no_rigid_film, 'canonical creep load: no rigid film')
      call checks%check(ending%time > 0.0_dp .and. ending%time < 1.0_dp/600.0_dp, 'within the first period')
      call checks%check(film%pressure_viscosity*exact_pressure(film%radius, film%speed, film%viscosity, ending%numbers(of_film), &
         0.0_dp) < 1.0_dp, 'the last film exists')
      scene%excitation%steady_force = 5000.0_dp
      call checks%check(.not. steady_film(film, 5000.0_dp) > 0.0_dp, 'no steady film under 5000 N')
   end subroutine test_no_rigid_film

   !> Films half a period, one and two periods after the start, extrapolated from two steps.
   subroutine test_start_up(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      !> What is left after the terms of the square are gone, at 2048 and 4096 steps.
      real(dp), parameter :: left = 1.0e-9_dp
      real(dp), parameter :: known(3) = [1.916633193569e-06_dp, 3.794375605713e-07_dp, 3.795117960374e-07_dp]
      real(dp) :: coarse(3), fine(3)
      integer :: i

      coarse = early_films(2048)
      fine = early_films(4096)
      do i = 1, 3
         call checks%check_close((fine(i) + (fine(i) - coarse(i))/3.0_dp)/known(i), 1.0_dp, left, &
            'start-up film')
      end do
   end subroutine test_start_up

   !> h(T/2), h(T), h(2T) of the idle scene [m].
   function early_films(steps) result(early)
      integer, intent(in) :: steps  !> Steps a period
      real(dp) :: early(3)

      type(request_t) :: method
      type(problem_t) :: problem
      type(newmark_state_t) :: state
      type(motion_count_t) :: count
      real(dp), dimension(steps) :: force, films, velocities, accelerations
      integer :: done, status

      method = request_t(tolerance=1.0e-16_dp, iteration_limit=100)
      problem = problem_of(canonical_scene(law_iso_viscous, steps))
      call force_of_period(problem%force, force)
      call start_motion(kernel_of(problem%contact%film), problem, state, count, status)
      call advance_period(kernel_of(problem%contact%film), problem, method, force, state, count, films, velocities, &
         accelerations, done, status)
      early(1:2) = films([steps/2, steps])
      call advance_period(kernel_of(problem%contact%film), problem, method, force, state, count, films, velocities, &
         accelerations, done, status)
      early(3) = films(steps)
   end function early_films

   !> Time, steps and periods reported; the equation of motion holds at every sample.
   subroutine test_bookkeeping(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(scene_t) :: scene
      type(sample_recorder_t) :: recorder
      type(ending_t) :: ending
      type(counting_watcher_t) :: watcher
      type(film_t) :: film
      real(dp) :: force(256), load, slope_h, slope_w, residual
      integer :: i

      scene = canonical_scene(law_iso_viscous, 256)
      scene%solver%periods = 7
      scene%spectrum%periods = 2
      call run_window(scene, recorder, ending, watcher)
      call checks%check(ending%status == status_complete, 'bookkeeping: status')
      call checks%check(ending%count%steps == 7*256, 'bookkeeping: steps')
      call checks%check(watcher%reported == 7 .and. watcher%done == 7 .and. watcher%all == 7, &
         'bookkeeping: periods reported')
      call checks%check_close(ending%time*600.0_dp, 7.0_dp, 8.0_dp*epsilon(1.0_dp), 'bookkeeping: time')
      call checks%check(size(recorder%states, 1) == 512, 'bookkeeping: size of the window')
      call checks%check_close(recorder%states(512, of_film, 1), ending%numbers(of_film), 0.0_dp, &
         'bookkeeping: the window ends with the run')
      film = new_film(scene)
      call force_of_period(cosine_force(199.2_dp, 205.7_dp), force)
      residual = 0.0_dp
      do i = 1, 512
         call film_load(film, recorder%states(i, of_film, 1), recorder%states(i, of_velocity, 1), load, slope_h, slope_w)
         residual = max(residual, abs(load - force(1 + modulo(i - 1, 256)) - 3.0_dp*9.80665_dp - &
            3.0_dp*recorder%accelerations(i)))
      end do
      ! The iteration ends when z moves by less than eps, which leaves 4 eps/dt^2 at most: 1e-3 m/s2 here.
      call checks%check_close(residual, 0.0_dp, 3.0_dp*4.0_dp*1.0e-14_dp*(256.0_dp*600.0_dp)**2, &
         'bookkeeping: equation of motion')
   end subroutine test_bookkeeping

   !> The status of a failing motion reaches the caller, with the time of the failure.
   subroutine test_failures(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(scene_t) :: scene
      type(sample_recorder_t) :: recorder
      type(ending_t) :: ending

      scene = canonical_scene(law_piezo_viscous, 64)
      scene%film%initial_velocity = -2.0_dp
      call run_window(scene, recorder, ending)
      call checks%check(ending%status == status_overflow, 'overflow at the start')
      call checks%check_close(ending%time, 0.0_dp, 0.0_dp, 'overflow at the start: time')
      scene%film%initial_velocity = 0.0_dp
      scene%solver%iteration_limit = 1
      call run_window(scene, recorder, ending)
      call checks%check(ending%status == status_not_converged, 'iteration limit')
      call checks%check_close(ending%numbers(of_film), 1.000449736566e-06_dp, 1.0e-17_dp, 'iteration limit: last film')
   end subroutine test_failures

end module test_integrate_motion
