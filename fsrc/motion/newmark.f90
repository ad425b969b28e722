!> Newmark's average acceleration method for m z'' = W(h, z') - F(t) - m g, eq (1), with the iteration
!> within a step that (36) ends:
!>
!>    h_i  = h_(i-1) + dt z'_(i-1) + dt^2/4 (z''_(i-1) + z''_i)
!>    z'_i = z'_(i-1) + dt/2 (z''_(i-1) + z''_i)
!>
!> A pass evaluates the film at the present iterate. `successive`: its load gives z''_i, as in the paper.
!> `newton`: the load is linearised about the iterate, which gives z''_i from one linear equation.
module newmark
   use engine, only: motion_count_t, request_t
   use film_law, only: film_kernel, overflow_load
   use force, only: force_at
   use kinds, only: dp, int64
   use problem, only: net_load, problem_t, thinner_film
   use scene_status, only: status_complete, status_film_lost, status_interrupted, status_not_converged
   use signals, only: must_stop
   implicit none(type, external)
   private

   !> A step in which the film loses more than this factor, or goes to zero and below, is cut in two.
   real(dp), parameter, public :: smallest_film_ratio = 1.0e-3_dp
   !> Cuts within a cut: a step of 2^-30 of the grid's that still fails will not succeed.
   integer, parameter :: deepest_cut = 30
   !> Cuts of one step of the grid: a motion that needs more needs another method.
   integer(int64), parameter :: most_cuts = 256_int64

   !> Evaluations after which a period looks whether it must end
   integer(int64), parameter :: evaluations_between_looks = 65536_int64

   !> State of the motion.
   type, public :: newmark_state_t
      !> Film thickness h [m]
      real(dp) :: film = 0.0_dp
      !> z' [m/s]
      real(dp) :: velocity = 0.0_dp
      !> z'' [m/s2]
      real(dp) :: acceleration = 0.0_dp
   end type newmark_state_t

   public :: start_motion, advance_period

contains

   !> z''(0) from the equation of motion.
   pure subroutine start_motion(kernel, problem, state, count, status)
      !> Kernel of the film
      procedure(film_kernel) :: kernel
      !> What moves
      type(problem_t), intent(in) :: problem
      !> State at t = 0
      type(newmark_state_t), intent(out) :: state
      !> Cost so far
      type(motion_count_t), intent(inout) :: count
      !> Status of scene_status
      integer, intent(out) :: status
      real(dp) :: load, load_by_film, load_by_velocity

      call net_load(problem, problem%initial_film, problem%initial_velocity, load, load_by_film, load_by_velocity, kernel)
      count%evaluations = count%evaluations + 1
      state%film = problem%initial_film
      state%velocity = problem%initial_velocity
      status = merge(status_complete, problem%film%status_without_load, load < overflow_load)
      if (status == status_complete) &
         state%acceleration = (load - problem%weight - force_at(problem%force, 0.0_dp))/problem%mass
   end subroutine start_motion

   !> Advance one period of the force. On failure the state is that before the failing step.
   subroutine advance_period(kernel, problem, request, force, state, count, films, velocities, accelerations, done, status)
      !> Kernel of the film
      procedure(film_kernel) :: kernel
      !> What moves
      type(problem_t), intent(in) :: problem
      !> How the iteration goes and ends
      type(request_t), intent(in) :: request
      !> Applied force at the end of every step [N]; its size is the number of steps
      real(dp), intent(in) :: force(:)
      !> State, advanced
      type(newmark_state_t), intent(inout) :: state
      !> Cost, counted up
      type(motion_count_t), intent(inout) :: count
      !> Samples at the end of every step: h [m], z' [m/s], z'' [m/s2]
      real(dp), contiguous, intent(out) :: films(:)
      real(dp), contiguous, intent(out) :: velocities(:)
      real(dp), contiguous, intent(out) :: accelerations(:)
      !> Steps that succeeded
      integer, intent(out) :: done
      !> Status of scene_status
      integer, intent(out) :: status
      type(newmark_state_t) :: next
      real(dp) :: time_step
      integer(int64) :: next_look
      integer :: i, passes

      time_step = 1.0_dp/(problem%frequency*real(size(force), dp))
      status = status_complete
      next_look = count%evaluations + evaluations_between_looks
      do i = 1, size(force)
         if (count%evaluations >= next_look) then
            next_look = count%evaluations + evaluations_between_looks
            if (must_stop()) then
               status = status_interrupted
               exit
            end if
         end if
         if (request%by_newton) then
            call newton_step(kernel, problem, request, time_step, force(i), state, next, passes, status)
         else
            call successive_step(kernel, problem, request, time_step, force(i), state, next, passes, status)
         end if
         count%evaluations = count%evaluations + int(passes, int64)
         if (status /= status_complete) then
            call cut_step(kernel, problem, request, time_step, real(i - 1, dp)/real(size(force), dp), &
                          1.0_dp/real(size(force), dp), 1, count%cuts + most_cuts, state, next, count, status)
            if (status /= status_complete) exit
         end if
         state = next
         films(i) = state%film
         velocities(i) = state%velocity
         accelerations(i) = state%acceleration
      end do
      done = i - 1
      count%steps = count%steps + int(done, int64)
   end subroutine advance_period

   !> A step in which the film law had no value at some iterate, as two halves that end on the grid.
   !> A step that merely did not converge is not helped: it ends the scene.
   recursive subroutine cut_step(kernel, problem, request, time_step, phase, phase_step, depth, last_cut, state, next, count, &
                                 status)
      procedure(film_kernel) :: kernel
      type(problem_t), intent(in) :: problem
      type(request_t), intent(in) :: request
      !> Step to be cut [s]
      real(dp), intent(in) :: time_step
      !> Phase at its start, and its length in phase [-]
      real(dp), intent(in) :: phase
      real(dp), intent(in) :: phase_step
      !> How often this stretch of the grid has been cut
      integer, intent(in) :: depth
      !> Count of cuts at which this step of the grid is given up
      integer(int64), intent(in) :: last_cut
      type(newmark_state_t), intent(in) :: state
      type(newmark_state_t), intent(out) :: next
      type(motion_count_t), intent(inout) :: count
      !> On entry why the step failed, on return whether the halves did
      integer, intent(inout) :: status
      type(newmark_state_t) :: from
      real(dp) :: half, end_phase, force
      integer :: part, passes

      next = state
      if (status == status_not_converged .or. depth > deepest_cut .or. count%cuts >= last_cut) return
      count%cuts = count%cuts + 1
      half = 0.5_dp*time_step
      from = state
      do part = 1, 2
         end_phase = phase + 0.5_dp*real(part, dp)*phase_step
         force = force_at(problem%force, end_phase)
         if (request%by_newton) then
            call newton_step(kernel, problem, request, half, force, from, next, passes, status)
         else
            call successive_step(kernel, problem, request, half, force, from, next, passes, status)
         end if
         count%evaluations = count%evaluations + int(passes, int64)
         if (status /= status_complete) call cut_step(kernel, problem, request, half, end_phase - 0.5_dp*phase_step, &
                                                      0.5_dp*phase_step, depth + 1, last_cut, from, next, count, status)
         if (status /= status_complete) return
         from = next
      end do
   end subroutine cut_step

   !> One step, each pass one evaluation of load and slopes and one linear equation for z''.
   pure subroutine newton_step(kernel, problem, request, time_step, force, state, next, passes, status)
      procedure(film_kernel) :: kernel
      type(problem_t), intent(in) :: problem
      type(request_t), intent(in) :: request
      !> Step [s]
      real(dp), intent(in) :: time_step
      !> Applied force at its end [N]
      real(dp), intent(in) :: force
      type(newmark_state_t), intent(in) :: state
      !> State at its end
      type(newmark_state_t), intent(out) :: next
      integer, intent(out) :: passes
      integer, intent(out) :: status
      real(dp) :: load, load_by_film, load_by_velocity, known_film, known_velocity, old_film, film_weight, velocity_weight, &
                  smallest_film

      call begin_step(request, time_step, state, next, known_film, known_velocity, film_weight, velocity_weight)
      smallest_film = smallest_film_ratio*thinner_film(problem, state%film)
      status = status_film_lost
      passes = 0
      if (thinner_film(problem, next%film) <= smallest_film) return
      do passes = 1, request%iteration_limit
         call net_load(problem, next%film, next%velocity, load, load_by_film, load_by_velocity, kernel)
         if (.not. load < overflow_load) then
            status = problem%film%status_without_load
            return
         end if
         next%acceleration = (load + load_by_film*(known_film - next%film) + &
                              load_by_velocity*(known_velocity - next%velocity) - force - problem%weight)/ &
                             (problem%mass - load_by_film*film_weight - load_by_velocity*velocity_weight)
         old_film = next%film
         next%film = known_film + film_weight*next%acceleration
         next%velocity = known_velocity + velocity_weight*next%acceleration
         if (thinner_film(problem, next%film) <= smallest_film) return
         if (abs(next%film - old_film) < request%tolerance) then
            status = status_complete
            return
         end if
      end do
      passes = request%iteration_limit
      status = status_not_converged
   end subroutine newton_step

   !> One step of the paper's iteration: z'' of a pass is that of the equation of motion at the iterate.
   pure subroutine successive_step(kernel, problem, request, time_step, force, state, next, passes, status)
      procedure(film_kernel) :: kernel
      type(problem_t), intent(in) :: problem
      type(request_t), intent(in) :: request
      !> Step [s]
      real(dp), intent(in) :: time_step
      !> Applied force at its end [N]
      real(dp), intent(in) :: force
      type(newmark_state_t), intent(in) :: state
      !> State at its end
      type(newmark_state_t), intent(out) :: next
      integer, intent(out) :: passes
      integer, intent(out) :: status
      real(dp) :: load, load_by_film, load_by_velocity, known_film, known_velocity, old_film, film_weight, velocity_weight, &
                  smallest_film

      call begin_step(request, time_step, state, next, known_film, known_velocity, film_weight, velocity_weight)
      smallest_film = smallest_film_ratio*thinner_film(problem, state%film)
      status = status_film_lost
      passes = 0
      if (thinner_film(problem, next%film) <= smallest_film) return
      do passes = 1, request%iteration_limit
         call net_load(problem, next%film, next%velocity, load, load_by_film, load_by_velocity, kernel)
         if (.not. load < overflow_load) then
            status = problem%film%status_without_load
            return
         end if
         next%acceleration = (load - force - problem%weight)/problem%mass
         old_film = next%film
         next%film = known_film + film_weight*next%acceleration
         next%velocity = known_velocity + velocity_weight*next%acceleration
         if (thinner_film(problem, next%film) <= smallest_film) return
         if (abs(next%film - old_film) < request%tolerance) then
            status = status_complete
            return
         end if
      end do
      passes = request%iteration_limit
      status = status_not_converged
   end subroutine successive_step

   !> Known part of Newmark's formulas and the first iterate.
   pure subroutine begin_step(request, time_step, state, first, known_film, known_velocity, film_weight, velocity_weight)
      type(request_t), intent(in) :: request
      real(dp), intent(in) :: time_step
      type(newmark_state_t), intent(in) :: state
      !> First iterate
      type(newmark_state_t), intent(out) :: first
      !> h and z' at the end of the step were z'' zero there
      real(dp), intent(out) :: known_film
      real(dp), intent(out) :: known_velocity
      !> Factors of z'' at the end of the step: dt^2/4 and dt/2
      real(dp), intent(out) :: film_weight
      real(dp), intent(out) :: velocity_weight

      velocity_weight = 0.5_dp*time_step
      film_weight = velocity_weight*velocity_weight
      known_film = state%film + time_step*state%velocity + film_weight*state%acceleration
      known_velocity = state%velocity + velocity_weight*state%acceleration
      first = state
      if (request%extrapolate) then
         first%film = known_film + film_weight*state%acceleration
         first%velocity = known_velocity + velocity_weight*state%acceleration
      end if
   end subroutine begin_step

end module newmark
