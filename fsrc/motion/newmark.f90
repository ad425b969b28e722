!> Newmark's average acceleration method for m z'' = W(h, z') - F(t) - m g, eq (1): start, one step, the steps of a period, and the
!> cuts of those that fail; an iteration within a step that (36) ends (fsrc/THEORY.md, section 6). An iteration evaluates the film at
!> the present iterate. `successive`: its load gives z''_i, as in the paper. `newton`: the load is linearised about the iterate, which
!> gives z''_i from one linear equation.
!>
!> It is the paper's method for the paper's rigid teeth; the checker refuses it for elastic ones.
module newmark
   use carried_loads, only: net_load
   use engine, only: motion_count_t, request_t
   use film_law, only: film_kernel, overflow_load
   use film_state, only: load_t
   use force, only: force_at
   use kinds, only: dp, int64
   use problem, only: problem_t, thinner_film
   use scene_status, only: status_complete, status_film_lost, status_interrupted, status_not_converged
   use signals, only: must_stop
   implicit none(type, external)
   private

   !> A step in which the film loses more than this factor, or goes to zero and below, is cut in two.
   real(dp), parameter :: smallest_film_ratio = 1.0e-3_dp
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
      type(load_t) :: load

      state%film = problem%initial_film
      state%velocity = problem%initial_velocity
      count%evaluations = count%evaluations + 1
      call net_load(problem, state%film, state%velocity, load, kernel)
      status = merge(status_complete, problem%contact%film%status_without_load, load%load < overflow_load)
      if (status /= status_complete) return
      state%acceleration = (load%load - problem%weight - force_at(problem%force, 0.0_dp))/problem%mass
   end subroutine start_motion

   !> One step.
   pure subroutine take_step(kernel, problem, request, time_step, force, state, next, iterations, status)
      !> Kernel of the film
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
      !> Evaluations of the film, or of both
      integer, intent(out) :: iterations
      !> Status of scene_status
      integer, intent(out) :: status
      type(load_t) :: load
      real(dp) :: predicted_film, predicted_velocity, old_film, film_weight, velocity_weight, smallest_film

      ! Factors of z'' at the end of the step, and what h and z' would be there if it were zero.
      velocity_weight = 0.5_dp*time_step
      film_weight = velocity_weight*velocity_weight
      predicted_film = state%film + time_step*state%velocity + film_weight*state%acceleration
      predicted_velocity = state%velocity + velocity_weight*state%acceleration
      next = state
      if (request%extrapolate) then
         next%film = predicted_film + film_weight*state%acceleration
         next%velocity = predicted_velocity + velocity_weight*state%acceleration
      end if
      smallest_film = smallest_film_ratio*thinner_film(problem, state%film)
      status = status_film_lost
      iterations = 0
      if (thinner_film(problem, next%film) <= smallest_film) return
      do iterations = 1, request%iteration_limit
         call net_load(problem, next%film, next%velocity, load, kernel)
         if (.not. load%load < overflow_load) then
            status = problem%contact%film%status_without_load
            return
         end if
         if (request%by_newton) then
            next%acceleration = (load%load + load%by_film*(predicted_film - next%film) + &
                                 load%by_velocity*(predicted_velocity - next%velocity) - force - problem%weight)/ &
                                (problem%mass - load%by_film*film_weight - load%by_velocity*velocity_weight)
         else
            next%acceleration = (load%load - force - problem%weight)/problem%mass
         end if
         old_film = next%film
         next%film = predicted_film + film_weight*next%acceleration
         next%velocity = predicted_velocity + velocity_weight*next%acceleration
         if (thinner_film(problem, next%film) <= smallest_film) return
         if (abs(next%film - old_film) < request%tolerance) then
            status = status_complete
            return
         end if
      end do
      iterations = request%iteration_limit
      status = status_not_converged
   end subroutine take_step

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
      integer :: i

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
         call take_or_cut(kernel, problem, request, time_step, force(i), real(i - 1, dp)/real(size(force), dp), &
                          1.0_dp/real(size(force), dp), 0, count%cuts + most_cuts, state, next, count, status)
         if (status /= status_complete) exit
         state = next
         films(i) = state%film
         velocities(i) = state%velocity
         accelerations(i) = state%acceleration
      end do
      done = i - 1
      count%steps = count%steps + int(done, int64)
   end subroutine advance_period

   !> A step, or two halves of one in which the film law had no value at some iterate, which end on the grid.
   !> A step that merely did not converge is not helped: it ends the scene.
   recursive subroutine take_or_cut(kernel, problem, request, time_step, force, phase, phase_step, depth, last_cut, state, next, &
                                    count, status)
      procedure(film_kernel) :: kernel
      type(problem_t), intent(in) :: problem
      type(request_t), intent(in) :: request
      !> Step [s]
      real(dp), intent(in) :: time_step
      !> Applied force at its end [N]
      real(dp), intent(in) :: force
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
      !> Status of scene_status
      integer, intent(out) :: status
      type(newmark_state_t) :: from
      real(dp) :: end_phase
      integer :: part, iterations

      call take_step(kernel, problem, request, time_step, force, state, next, iterations, status)
      count%evaluations = count%evaluations + int(iterations, int64)
      if (status == status_complete .or. status == status_not_converged) return
      if (depth >= deepest_cut .or. count%cuts >= last_cut) return
      count%cuts = count%cuts + 1
      from = state
      do part = 1, 2
         end_phase = phase + 0.5_dp*real(part, dp)*phase_step
         call take_or_cut(kernel, problem, request, 0.5_dp*time_step, force_at(problem%force, end_phase), &
                          end_phase - 0.5_dp*phase_step, 0.5_dp*phase_step, depth + 1, last_cut, from, next, count, status)
         if (status /= status_complete) return
         from = next
      end do
   end subroutine take_or_cut

end module newmark
