!> Tests of both iterations of Newmark's method against the same steps written out by hand.
module test_newmark_by_hand
   use canonical_scenes, only: canonical_method, canonical_scene, idle_steady_film
   use checks, only: check_list_t
   use engine, only: motion_count_t, request_t
   use film_law, only: film_load, kernel_of
   use force, only: force_of_period
   use kinds, only: dp
   use linear_newmark, only: damping, first_film, first_velocity, linear_method, load_at_zero, periods, run_linear, stiffness, &
      two_pi
   use newmark, only: advance_period, start_motion, newmark_state_t
   use problem, only: problem_of, problem_t
   use scene_types, only: law_iso_viscous
   implicit none(type, external)
   private

   public :: run_newmark_by_hand_tests

contains

   !> Runs every test of this topic.
   subroutine run_newmark_by_hand_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('newmark')
      call test_by_hand(checks)
      call test_newton_by_hand(checks)
   end subroutine run_newmark_by_hand_tests

   !> The successive iteration step by step, written as the paper says it: z'' of a pass from the equation of
   !> motion at the iterate, then z and z' by Newmark's formulas, until z moves by less than eps. States and
   !> number of iterations agree, from loose tolerances to tight ones.
   subroutine test_by_hand(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: steps = 64
      type(request_t) :: method
      type(motion_count_t) :: count
      real(dp), dimension(periods*steps) :: films, velocities, accelerations
      real(dp) :: dt, h, v, a, next_h, next_v, next_a, last_h, force, error
      integer :: choice, status, i, iterations

      dt = 1.0_dp/(600.0_dp*real(steps, dp))
      do choice = 0, 9
         method = linear_method()
         method%by_newton = .false.
         method%extrapolate = mod(choice, 2) == 1
         method%tolerance = 10.0_dp**(-7 - choice/2)
         call run_linear(method, steps, films, velocities, accelerations, count, status)
         h = first_film
         v = first_velocity
         a = (load_at_zero - stiffness*h - damping*v - 219.2_dp - 29.4_dp)/3.0_dp
         iterations = 1
         error = 0.0_dp
         do i = 1, periods*steps
            force = 199.2_dp + 20.0_dp*cos(two_pi*real(i, dp)/real(steps, dp))
            next_h = h
            next_v = v
            if (method%extrapolate) then
               next_h = h + dt*v + 0.5_dp*dt*dt*a
               next_v = v + dt*a
            end if
            do
               iterations = iterations + 1
               last_h = next_h
               next_a = (load_at_zero - stiffness*next_h - damping*next_v - force - 29.4_dp)/3.0_dp
               call newmark_formulas(dt, h, v, a, next_a, next_h, next_v)
               if (abs(next_h - last_h) < method%tolerance) exit
            end do
            h = next_h
            v = next_v
            a = next_a
            error = max(error, abs(films(i) - h)/1.0e-6_dp, abs(velocities(i) - v)/1.0e-3_dp, &
               abs(accelerations(i) - a))
         end do
         ! Rounding of the load, 1e-13 m/s2, over some hundred steps.
         call checks%check_close(error, 0.0_dp, 1.0e-9_dp, 'successive iteration by hand: states')
         call checks%check(int(count%evaluations) == iterations, 'successive iteration by hand: iterations')
      end do
   end subroutine test_by_hand

   !> Newton's iteration step by step on the canonical idle film, written as corrections of z'' by the
   !> residual of the equation of motion. States and number of iterations agree at every tolerance.
   subroutine test_newton_by_hand(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: steps = 64
      type(request_t) :: method
      type(problem_t) :: problem
      type(motion_count_t) :: count
      type(newmark_state_t) :: state
      real(dp), dimension(steps) :: force, films, velocities, accelerations
      real(dp) :: dt, h, v, a, next_h, next_v, next_a, last_h, load, slope_h, slope_w, error
      integer :: choice, status, i, iterations, done

      problem = problem_of(canonical_scene(law_iso_viscous, steps))
      problem%initial_film = idle_steady_film
      call force_of_period(problem%force, force)
      dt = 1.0_dp/(600.0_dp*real(steps, dp))
      do choice = 7, 14
         method = canonical_method()
         method%tolerance = 10.0_dp**(-choice)
         count = motion_count_t()
         call start_motion(kernel_of(problem%contact%film), problem, state, count, status)
         h = state%film
         v = state%velocity
         a = state%acceleration
         call advance_period(kernel_of(problem%contact%film), problem, method, force, state, count, films, velocities, &
            accelerations, done, &
            status)
         iterations = 1
         error = 0.0_dp
         do i = 1, steps
            next_a = a
            next_h = h + dt*v + 0.5_dp*dt*dt*a
            next_v = v + dt*a
            do
               iterations = iterations + 1
               last_h = next_h
               call film_load(problem%contact%film, next_h, next_v, load, slope_h, slope_w)
               next_a = next_a + (load - force(i) - problem%weight - 3.0_dp*next_a) &
                  /(3.0_dp - 0.25_dp*dt*dt*slope_h - 0.5_dp*dt*slope_w)
               call newmark_formulas(dt, h, v, a, next_a, next_h, next_v)
               if (abs(next_h - last_h) < method%tolerance) exit
            end do
            h = next_h
            v = next_v
            a = next_a
            error = max(error, abs(films(i) - h)/1.0e-6_dp, abs(velocities(i) - v)/1.0e-3_dp, &
               abs(accelerations(i) - a)/100.0_dp)
         end do
         call checks%check_close(error, 0.0_dp, 1.0e-10_dp, 'newton by hand: states')
         call checks%check(int(count%evaluations) == iterations .and. count%cuts == 0, 'newton by hand: iterations')
      end do
   end subroutine test_newton_by_hand

   !> Film and velocity at the end of a step from z'' at both ends: average acceleration.
   pure subroutine newmark_formulas(time_step, film, velocity, acceleration, next_acceleration, next_film, next_velocity)
      real(dp), intent(in) :: time_step          !> dt [s]
      real(dp), intent(in) :: film               !> h at the start [m]
      real(dp), intent(in) :: velocity           !> z' at the start [m/s]
      real(dp), intent(in) :: acceleration       !> z'' at the start [m/s2]
      real(dp), intent(in) :: next_acceleration  !> z'' at the end [m/s2]
      real(dp), intent(out) :: next_film         !> h at the end [m]
      real(dp), intent(out) :: next_velocity     !> z' at the end [m/s]

      next_film = film + time_step*velocity + 0.25_dp*time_step*time_step*(acceleration + next_acceleration)
      next_velocity = velocity + 0.5_dp*time_step*(acceleration + next_acceleration)
   end subroutine newmark_formulas

end module test_newmark_by_hand
