!> Tests of Newmark's method on a linear film, whose motion is known in closed form with and without steps,
!> and of its cuts and its ends on the films of the scenes.
module test_newmark
   use canonical_scenes, only: canonical_scene
   use checks, only: check_list_t
   use film_law, only: film_t, load_half_pi, load_piezo, new_film
   use forcing, only: force_of_period
   use kinds, only: dp, int64
   use newmark, only: advance_period, motion_count_t, motion_state_t, newmark_t, start_motion
   use scene_status, only: status_complete, status_film_lost, status_not_converged, status_overflow
   use scene_types, only: law_iso_viscous, law_piezo_viscous
   implicit none(type, external)
   private

   !> Linear film: load at h = 0 [N], stiffness [N/m], damping [N s/m]; a natural frequency of 796 Hz, a
   !> damping ratio of 0.1 and, at rest, a film of 1.9e-6 m.
   real(dp), parameter :: load_at_zero = 370.0_dp, stiffness = 75.0e6_dp, damping = 3000.0_dp
   !> First state of the linear film.
   real(dp), parameter :: first_film = 2.4e-6_dp, first_velocity = 1.0e-3_dp
   integer, parameter :: periods = 3
   real(dp), parameter :: two_pi = 8.0_dp*atan(1.0_dp)

   public :: run_newmark_tests

contains

   !> Runs every test of this topic.
   subroutine run_newmark_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('newmark')
      call test_discrete(checks)
      call test_by_hand(checks)
      call test_newton_by_hand(checks)
      call test_order(checks)
      call test_loose_tolerance(checks)
      call test_start(checks)
      call test_cuts(checks)
      call test_nested_cut(checks)
      call test_ends(checks)
   end subroutine run_newmark_tests

   !> Load falling linearly with film and velocity; interface film_kernel. The film carries the load at zero
   !> as `rolling`, the stiffness as `piezo`, the damping as `squeeze`.
   pure subroutine linear_film(film, thickness, velocity, load, load_by_film, load_by_velocity)
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity
      real(dp), intent(out) :: load
      real(dp), intent(out) :: load_by_film
      real(dp), intent(out) :: load_by_velocity

      load = film%rolling - film%piezo*thickness - film%squeeze*velocity
      load_by_film = -film%piezo
      load_by_velocity = -film%squeeze
   end subroutine linear_film

   !> Constants for the linear film; the caller sets the iteration.
   function linear_method() result(method)
      type(newmark_t) :: method

      method%mass = 3.0_dp
      method%weight = 29.4_dp
      method%steady_force = 199.2_dp
      method%force_amplitude = 20.0_dp
      method%frequency = 600.0_dp
      method%tolerance = 1.0e-20_dp
      method%iteration_limit = 200
   end function linear_method

   !> The linear film itself.
   function linear_oil() result(film)
      type(film_t) :: film

      film%rolling = load_at_zero
      film%piezo = stiffness
      film%squeeze = damping
   end function linear_oil

   !> State after a number of steps. On a linear film average acceleration is the trapezoidal rule: eigenvalue
   !> lambda becomes (1 + lambda dt/2)/(1 - lambda dt/2) a step, and the forced motion is that of the
   !> frequency 2/dt tan(omega dt/2). Without steps they are exp(lambda dt) and omega.
   pure function linear_motion(time_step, step, discrete) result(state)
      real(dp), intent(in) :: time_step  !> dt [s]
      integer, intent(in) :: step        !> Number of steps
      logical, intent(in) :: discrete    !> With steps, else the exact motion at that time
      type(motion_state_t) :: state

      real(dp), parameter :: mass = 3.0_dp, omega = two_pi*600.0_dp, amplitude = 20.0_dp
      real(dp) :: rest, decay, frequency, real_part
      complex(dp) :: eigenvalue, forced, free, factor, oscillation, half, one

      rest = (load_at_zero - 199.2_dp - 29.4_dp)/stiffness
      decay = 0.5_dp*damping/mass
      eigenvalue = cmplx(-decay, sqrt(stiffness/mass - decay**2), dp)
      frequency = omega
      factor = exp(eigenvalue*cmplx(time_step*real(step, dp), 0.0_dp, dp))
      if (discrete) then
         frequency = 2.0_dp/time_step*tan(0.5_dp*omega*time_step)
         one = cmplx(1.0_dp, 0.0_dp, dp)
         half = eigenvalue*cmplx(0.5_dp*time_step, 0.0_dp, dp)
         factor = ((one + half)/(one - half))**step
      end if
      forced = cmplx(-amplitude, 0.0_dp, dp)/cmplx(stiffness - mass*frequency**2, damping*frequency, dp)
      real_part = first_film - rest - real(forced, dp)
      free = cmplx(real_part, (-decay*real_part - first_velocity &
         + real(cmplx(0.0_dp, frequency, dp)*forced, dp)) &
         /aimag(eigenvalue), dp)
      oscillation = forced*exp(cmplx(0.0_dp, omega*time_step*real(step, dp), dp))
      state%film = rest + real(oscillation + free*factor, dp)
      state%velocity = real(cmplx(0.0_dp, frequency, dp)*oscillation + eigenvalue*free*factor, dp)
      state%acceleration = real(eigenvalue**2*free*factor, dp) - frequency**2*real(oscillation, dp)
   end function linear_motion

   !> Motion of the linear film through some periods.
   subroutine run_linear(method, steps, films, velocities, accelerations, count, status)
      type(newmark_t), intent(in) :: method             !> Constants
      integer, intent(in) :: steps                      !> Steps a period
      real(dp), intent(out) :: films(periods*steps)          !> h at the end of every step [m]
      real(dp), intent(out) :: velocities(periods*steps)     !> z' [m/s]
      real(dp), intent(out) :: accelerations(periods*steps)  !> z'' [m/s2]
      type(motion_count_t), intent(out) :: count        !> Cost
      integer, intent(out) :: status                    !> How it ended

      type(motion_state_t) :: state
      real(dp) :: force(steps)
      integer :: period, first, last, done

      call force_of_period(method%steady_force, method%force_amplitude, force)
      call start_motion(linear_film, linear_oil(), method, first_film, first_velocity, state, count, status)
      do period = 1, periods
         first = (period - 1)*steps + 1
         last = period*steps
         call advance_period(linear_film, linear_oil(), method, force, state, count, films(first:last), &
            velocities(first:last), accelerations(first:last), done, status)
         if (status /= status_complete) return
      end do
   end subroutine run_linear

   !> Both iterations, converged, give the motion with steps to rounding, every sample of it.
   subroutine test_discrete(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: steps = 128
      type(newmark_t) :: method
      type(motion_count_t) :: count
      type(motion_state_t) :: expected
      real(dp), dimension(periods*steps) :: films, velocities, accelerations
      real(dp) :: error(3)
      character(:), allocatable :: name
      integer :: choice, status, i

      do choice = 1, 4
         method = linear_method()
         method%by_newton = choice <= 2
         method%extrapolate = mod(choice, 2) == 1
         name = trim(merge('newton    ', 'successive', method%by_newton))//', '// &
            trim(merge('extrapolated', 'previous    ', method%extrapolate))
         call run_linear(method, steps, films, velocities, accelerations, count, status)
         call checks%check(status == status_complete .and. count%cuts == 0, &
            name//': ended well, without cuts')
         call checks%check(count%steps == periods*steps, name//': steps counted')
         error = 0.0_dp
         do i = 1, periods*steps
            expected = linear_motion(1.0_dp/(method%frequency*real(steps, dp)), i, .true.)
            error(1) = max(error(1), abs(films(i) - expected%film))
            error(2) = max(error(2), abs(velocities(i) - expected%velocity))
            error(3) = max(error(3), abs(accelerations(i) - expected%acceleration))
         end do
         ! The load of 370 N keeps 370 epsilon, so z'' some 1e-13 m/s2, and eps leaves 4 eps/dt^2 times the
         ! contraction of a pass, 1e-12 m/s2; there are hundreds of steps.
         call checks%check_close(error(1), 0.0_dp, 1.0e-18_dp, name//': film')
         call checks%check_close(error(2), 0.0_dp, 1.0e-14_dp, name//': velocity')
         call checks%check_close(error(3), 0.0_dp, 1.0e-10_dp, name//': acceleration')
         ! On a linear film the first pass is exact, the second sees that.
         if (method%by_newton) call checks%check(count%evaluations == 1 + 2*periods*steps, &
            name//': two passes a step')
      end do
   end subroutine test_discrete

   !> The successive iteration step by step, written as the paper says it: z'' of a pass from the equation of
   !> motion at the iterate, then z and z' by Newmark's formulas, until z moves by less than eps. States and
   !> number of passes agree, from loose tolerances to tight ones.
   subroutine test_by_hand(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: steps = 64
      type(newmark_t) :: method
      type(motion_count_t) :: count
      real(dp), dimension(periods*steps) :: films, velocities, accelerations
      real(dp) :: dt, h, v, a, next_h, next_v, next_a, last_h, force, error
      integer :: choice, status, i, passes

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
         passes = 1
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
               passes = passes + 1
               last_h = next_h
               next_a = (load_at_zero - stiffness*next_h - damping*next_v - force - 29.4_dp)/3.0_dp
               next_h = h + dt*v + 0.25_dp*dt*dt*(a + next_a)
               next_v = v + 0.5_dp*dt*(a + next_a)
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
         call checks%check(int(count%evaluations) == passes, 'successive iteration by hand: passes')
      end do
   end subroutine test_by_hand

   !> Newton's iteration step by step on the canonical idle film, written as corrections of z'' by the
   !> residual of the equation of motion. States and number of passes agree at every tolerance.
   subroutine test_newton_by_hand(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: steps = 64
      type(newmark_t) :: method
      type(film_t) :: film
      type(motion_count_t) :: count
      type(motion_state_t) :: state
      real(dp), dimension(steps) :: force, films, velocities, accelerations
      real(dp) :: dt, h, v, a, next_h, next_v, next_a, last_h, load, slope_h, slope_w, error
      integer :: choice, status, i, passes, done

      film = new_film(canonical_scene(law_iso_viscous, steps))
      dt = 1.0_dp/(600.0_dp*real(steps, dp))
      do choice = 7, 14
         method = canonical_method()
         method%tolerance = 10.0_dp**(-choice)
         call force_of_period(method%steady_force, method%force_amplitude, force)
         count = motion_count_t()
         call start_motion(load_half_pi, film, method, 8.889224234368e-7_dp, 0.0_dp, state, count, status)
         h = state%film
         v = state%velocity
         a = state%acceleration
         call advance_period(load_half_pi, film, method, force, state, count, films, velocities, &
            accelerations, done, &
            status)
         passes = 1
         error = 0.0_dp
         do i = 1, steps
            next_a = a
            next_h = h + dt*v + 0.5_dp*dt*dt*a
            next_v = v + dt*a
            do
               passes = passes + 1
               last_h = next_h
               call load_half_pi(film, next_h, next_v, load, slope_h, slope_w)
               next_a = next_a + (load - force(i) - method%weight - 3.0_dp*next_a) &
                  /(3.0_dp - 0.25_dp*dt*dt*slope_h - 0.5_dp*dt*slope_w)
               next_h = h + dt*v + 0.25_dp*dt*dt*(a + next_a)
               next_v = v + 0.5_dp*dt*(a + next_a)
               if (abs(next_h - last_h) < method%tolerance) exit
            end do
            h = next_h
            v = next_v
            a = next_a
            error = max(error, abs(films(i) - h)/1.0e-6_dp, abs(velocities(i) - v)/1.0e-3_dp, &
               abs(accelerations(i) - a)/100.0_dp)
         end do
         call checks%check_close(error, 0.0_dp, 1.0e-10_dp, 'newton by hand: states')
         call checks%check(int(count%evaluations) == passes .and. count%cuts == 0, 'newton by hand: passes')
      end do
   end subroutine test_newton_by_hand

   !> Against the motion without steps the error falls fourfold when the step is halved.
   subroutine test_order(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: errors(3)
      type(newmark_t) :: method
      integer :: i

      method = linear_method()
      do i = 1, 3
         errors(i) = final_error(method, 128*2**i)
      end do
      ! The next power of the step enters the quotient with about 1e-3.
      call checks%check_close(errors(1)/errors(2), 4.0_dp, 0.05_dp, 'order two, first halving')
      call checks%check_close(errors(2)/errors(3), 4.0_dp, 0.02_dp, 'order two, second halving')
   end subroutine test_order

   !> With a tolerance that the first pass always meets the method is another one: of order one from the
   !> previous state, of order two from the extrapolated one.
   subroutine test_loose_tolerance(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: first(3), second(3)
      type(newmark_t) :: method
      integer :: i

      method = linear_method()
      method%by_newton = .false.
      method%tolerance = 1.0_dp
      do i = 1, 3
         method%extrapolate = .false.
         first(i) = final_error(method, 512*2**i)
         method%extrapolate = .true.
         second(i) = final_error(method, 512*2**i)
      end do
      ! The quotient nears the power of two as the step: 3 % and 1 % away at these steps.
      call checks%check_close(first(2)/first(3), 2.0_dp, 0.06_dp, 'previous, one pass: order one')
      call checks%check_close(second(2)/second(3), 4.0_dp, 0.06_dp, 'extrapolated, one pass: order two')
      method%tolerance = 1.0e-20_dp
      method%extrapolate = .false.
      call checks%check_close(final_error(method, 1024)/final_error(method, 2048), 4.0_dp, 0.02_dp, &
         'previous, to convergence: order two')
   end subroutine test_loose_tolerance

   !> Largest error of the film over the samples of the coarsest grid, against the exact motion [m].
   real(dp) function final_error(method, steps) result(error)
      type(newmark_t), intent(in) :: method  !> Constants
      integer, intent(in) :: steps           !> Steps a period, a multiple of 128

      type(motion_count_t) :: count
      type(motion_state_t) :: expected
      real(dp), dimension(periods*steps) :: films, velocities, accelerations
      integer :: status, i

      call run_linear(method, steps, films, velocities, accelerations, count, status)
      error = 0.0_dp
      do i = steps/128, periods*steps, steps/128
         expected = linear_motion(1.0_dp/(method%frequency*real(steps, dp)), i, .false.)
         error = max(error, abs(films(i) - expected%film))
      end do
   end function final_error

   !> z''(0) comes from the equation of motion.
   subroutine test_start(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(motion_state_t) :: state
      type(motion_count_t) :: count
      integer :: status

      call start_motion(linear_film, linear_oil(), linear_method(), first_film, first_velocity, state, &
         count, status)
      call checks%check(status == status_complete, 'start: status')
      call checks%check_close(state%film, first_film, 0.0_dp, 'start: film')
      call checks%check_close(state%velocity, first_velocity, 0.0_dp, 'start: velocity')
      call checks%check_close(state%acceleration, (370.0_dp - 180.0_dp - 3.0_dp - 199.2_dp - 20.0_dp &
         - 29.4_dp)/3.0_dp, &
         370.0_dp*4.0_dp*epsilon(1.0_dp), 'start: acceleration')
      call checks%check(count%evaluations == 1 .and. count%steps == 0, 'start: cost')
   end subroutine test_start

   !> A fall so fast that the first iterate of a step lies below the flank: the step is cut, rejoins the grid,
   !> and the motion is that of fine steps, to the order of the method.
   subroutine test_cuts(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: fall = -0.08_dp
      real(dp) :: coarse(64), middle(96), fine(4096), finest(8192), error(2)
      type(motion_count_t) :: count

      call fall_through_a_period(fall, .true., coarse, count)
      call checks%check(count%cuts > 0, 'cuts: the step was cut')
      call checks%check(count%steps == 64, 'cuts: the samples stay on the grid')
      call checks%check(all(coarse > 0.0_dp), 'cuts: the film stays positive')
      call fall_through_a_period(fall, .true., fine, count)
      call checks%check(count%cuts == 0, 'cuts: none with fine steps')
      call fall_through_a_period(fall, .true., finest, count)
      error(1) = maxval(abs(coarse(8:) - finest(1024::128))/finest(1024::128))
      error(2) = maxval(abs(fine(512::64) - finest(1024::128))/finest(1024::128))
      ! Behind the landing 64 steps a period leave some per cent; against that the fine motion is exact.
      call checks%check_close(error(1), 0.0_dp, 0.05_dp, 'cuts: the motion after the landing')
      call checks%check_close(error(2), 0.0_dp, 0.001_dp, 'cuts: the fine motion has converged')
      ! The successive iteration converges in few such falls: a step that needs a cut is nearly too long.
      call fall_through_a_period(-0.07_dp, .false., middle, count)
      call checks%check(count%cuts > 0 .and. all(middle > 0.0_dp), &
         'cuts: successive iteration is cut as well')
   end subroutine test_cuts

   !> A first step of three radians of a free oscillation, cut in half and its first half cut again: the state
   !> at its end is that of two quarters and a half, with the forces of their ends.
   subroutine test_nested_cut(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: steps = 8
      real(dp), parameter :: angular = 3.0_dp*600.0_dp*real(steps, dp), rest = 1.0e-5_dp, amplitude = 124.0_dp
      type(newmark_t) :: method
      type(film_t) :: film
      type(motion_state_t) :: start, state
      type(motion_count_t) :: count, cut_count
      real(dp), dimension(4*steps) :: force, films, velocities, accelerations
      real(dp) :: cut_film, cut_velocity, cut_acceleration
      integer :: done, status

      method = linear_method()
      method%force_amplitude = amplitude
      film%piezo = method%mass*angular**2
      film%rolling = film%piezo*rest + method%steady_force + method%weight
      call start_motion(linear_film, film, method, rest, -0.9_dp*rest*angular, start, count, status)

      state = start
      call force_of_period(method%steady_force, amplitude, force(:steps))
      call advance_period(linear_film, film, method, force(:steps), state, cut_count, films(:steps), &
         velocities(:steps), &
         accelerations(:steps), done, status)
      call checks%check(done >= 1 .and. cut_count%cuts >= 2, 'nested cut: the first step was cut')
      cut_film = films(1)
      cut_velocity = velocities(1)
      cut_acceleration = accelerations(1)

      state = start
      call force_of_period(method%steady_force, amplitude, force)
      count = motion_count_t()
      call advance_period(linear_film, film, method, force, state, count, films, velocities, accelerations, &
         done, status)
      call checks%check(done >= 2 .and. count%cuts == 0, 'nested cut: quarters need no cut')
      state = motion_state_t(films(2), velocities(2), accelerations(2))
      force(1) = method%steady_force + amplitude*cos(two_pi/real(steps, dp))
      call advance_period(linear_film, film, method, force(:2*steps), state, count, films(:2*steps), &
         velocities(:2*steps), accelerations(:2*steps), done, status)
      call checks%check_close(cut_film/films(1), 1.0_dp, 1.0e-12_dp, 'nested cut: film')
      call checks%check_close(cut_velocity/velocities(1), 1.0_dp, 1.0e-12_dp, 'nested cut: velocity')
      call checks%check_close(cut_acceleration/accelerations(1), 1.0_dp, 1.0e-12_dp, &
         'nested cut: acceleration')
   end subroutine test_nested_cut

   !> One period of the canonical idle scene from its steady film with a given velocity.
   subroutine fall_through_a_period(fall, by_newton, films, count)
      real(dp), intent(in) :: fall                !> Velocity at t = 0 [m/s]
      logical, intent(in) :: by_newton            !> Iteration
      real(dp), contiguous, intent(out) :: films(:)  !> h at the end of every step [m]
      type(motion_count_t), intent(out) :: count  !> Cost

      type(newmark_t) :: method
      type(film_t) :: film
      type(motion_state_t) :: state
      real(dp), dimension(size(films)) :: force, velocities, accelerations
      integer :: done, status

      film = new_film(canonical_scene(law_iso_viscous, size(films)))
      method = canonical_method()
      method%by_newton = by_newton
      call force_of_period(method%steady_force, method%force_amplitude, force)
      call start_motion(load_half_pi, film, method, 8.889224234368e-7_dp, fall, state, count, status)
      films = -1.0_dp
      call advance_period(load_half_pi, film, method, force, state, count, films, velocities, &
         accelerations, done, status)
   end subroutine fall_through_a_period

   !> Constants of the canonical scenes.
   function canonical_method() result(method)
      type(newmark_t) :: method

      method%mass = 3.0_dp
      method%weight = 3.0_dp*9.80665_dp
      method%steady_force = 199.2_dp
      method%force_amplitude = 205.7_dp
      method%frequency = 600.0_dp
      method%tolerance = 1.0e-14_dp
      method%iteration_limit = 100
   end function canonical_method

   !> Every way in which a motion can fail.
   subroutine test_ends(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: steps = 64
      type(newmark_t) :: method
      type(film_t) :: film
      type(motion_state_t) :: state, before
      type(motion_count_t) :: count
      real(dp), dimension(steps) :: force, films, velocities, accelerations
      integer :: done, status

      ! One pass cannot see that it has converged.
      method = canonical_method()
      method%iteration_limit = 1
      call force_of_period(method%steady_force, method%force_amplitude, force)
      film = new_film(canonical_scene(law_iso_viscous, steps))
      call start_motion(load_half_pi, film, method, 8.889224234368e-7_dp, 0.0_dp, state, count, status)
      before = state
      call advance_period(load_half_pi, film, method, force, state, count, films, velocities, &
         accelerations, done, status)
      call checks%check(status == status_not_converged, 'iteration limit: status')
      call checks%check(done == 0 .and. count%steps == 0 .and. count%cuts == 0, &
         'iteration limit: no step, no cut')
      call checks%check(count%evaluations == 2, 'iteration limit: evaluations counted')
      call checks%check(abs(state%film - before%film) <= 0.0_dp, &
         'iteration limit: the state is that before the step')

      ! The successive iteration diverges where the film is too stiff for the step.
      method = canonical_method()
      method%by_newton = .false.
      method%iteration_limit = 50
      film = new_film(canonical_scene(law_piezo_viscous, 8))
      call start_motion(load_piezo, film, method, 1.0e-6_dp, 0.0_dp, state, count, status)
      call force_of_period(method%steady_force, method%force_amplitude, force(:8))
      call advance_period(load_piezo, film, method, force(:8), state, count, films(:8), velocities(:8), &
         accelerations(:8), &
         done, status)
      call checks%check(status /= status_complete .or. count%cuts > 0, 'a diverging step is not passed over')

      ! exp(703*2/1.905) is no load.
      call start_motion(load_piezo, film, method, 1.0e-6_dp, -2.0_dp, state, count, status)
      call checks%check(status == status_overflow, 'overflow at the start: status')

      ! Nothing stops a fall in a film that carries nothing.
      method = linear_method()
      film = film_t()
      call force_of_period(method%steady_force, method%force_amplitude, force)
      call start_motion(linear_film, film, method, 1.0e-6_dp, -1.0e-3_dp, state, count, status)
      call advance_period(linear_film, film, method, force, state, count, films, velocities, accelerations, &
         done, status)
      call checks%check(status == status_film_lost, 'no load: film lost')
      call checks%check(done < steps .and. int(count%steps) == done, 'no load: steps before the loss')
      call checks%check(state%film > 0.0_dp, 'no load: the last film is positive')
      if (done > 0) call checks%check(abs(films(done) - state%film) <= 0.0_dp, &
         'no load: state of the last step')
      call checks%check(count%cuts >= 30_int64, 'no load: cut down to the shortest step')
   end subroutine test_ends

end module test_newmark
