!> A linear film for the tests of Newmark's method, and its motions with and without steps.
module linear_newmark
   use engine, only: motion_count_t, request_t
   use film_law, only: film_t
   use force, only: cosine_force, force_of_period
   use kinds, only: dp
   use newmark, only: advance_period, start_motion, newmark_state_t
   use problem, only: problem_t
   use scene_status, only: status_complete
   implicit none(type, external)
   private

   !> Linear film: load at h = 0 [N], stiffness [N/m], damping [N s/m]; a natural frequency of 796 Hz, a
   !> damping ratio of 0.1 and, at rest, a film of 1.9e-6 m.
   real(dp), parameter, public :: load_at_zero = 370.0_dp, stiffness = 75.0e6_dp, damping = 3000.0_dp
   !> First state of the linear film.
   real(dp), parameter, public :: first_film = 2.4e-6_dp, first_velocity = 1.0e-3_dp
   integer, parameter, public :: periods = 3
   real(dp), parameter, public :: two_pi = 8.0_dp*atan(1.0_dp)

   public :: linear_film, linear_method, linear_problem, linear_motion, run_linear

contains

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

   !> Iteration for the linear film.
   function linear_method() result(method)
      type(request_t) :: method

      method%tolerance = 1.0e-20_dp
      method%iteration_limit = 200
   end function linear_method

   !> The linear film with its load.
   function linear_problem() result(problem)
      type(problem_t) :: problem

      problem%contact%film%rolling = load_at_zero
      problem%contact%film%piezo = stiffness
      problem%contact%film%squeeze = damping
      problem%mass = 3.0_dp
      problem%weight = 29.4_dp
      problem%force = cosine_force(199.2_dp, 20.0_dp)
      problem%frequency = 600.0_dp
      problem%initial_film = first_film
      problem%initial_velocity = first_velocity
   end function linear_problem

   !> State after a number of steps. On a linear film average acceleration is the trapezoidal rule: eigenvalue
   !> lambda becomes (1 + lambda dt/2)/(1 - lambda dt/2) a step, and the forced motion is that of the
   !> frequency 2/dt tan(omega dt/2). Without steps they are exp(lambda dt) and omega.
   pure function linear_motion(time_step, step, discrete) result(state)
      real(dp), intent(in) :: time_step  !> dt [s]
      integer, intent(in) :: step        !> Number of steps
      logical, intent(in) :: discrete    !> With steps, else the exact motion at that time
      type(newmark_state_t) :: state

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
      type(request_t), intent(in) :: method             !> Iteration
      integer, intent(in) :: steps                      !> Steps a period
      real(dp), intent(out) :: films(periods*steps)          !> h at the end of every step [m]
      real(dp), intent(out) :: velocities(periods*steps)     !> z' [m/s]
      real(dp), intent(out) :: accelerations(periods*steps)  !> z'' [m/s2]
      type(motion_count_t), intent(out) :: count        !> Cost
      integer, intent(out) :: status                    !> How it ended

      type(newmark_state_t) :: state
      type(problem_t) :: problem
      real(dp) :: force(steps)
      integer :: period, first, last, done

      problem = linear_problem()
      call force_of_period(problem%force, force)
      call start_motion(linear_film, problem, state, count, status)
      do period = 1, periods
         first = (period - 1)*steps + 1
         last = period*steps
         call advance_period(linear_film, problem, method, force, state, count, films(first:last), &
            velocities(first:last), accelerations(first:last), done, status)
         if (status /= status_complete) return
      end do
   end subroutine run_linear

end module linear_newmark
