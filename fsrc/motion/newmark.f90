!> Motion by Newmark's method (module newmark_step): start, the steps of a period, and the cuts of those that fail.
module newmark
   use engine, only: motion_count_t, request_t
   use film_law, only: film_kernel, overflow_load
   use film_state, only: load_t
   use force, only: force_at
   use kinds, only: dp, int64
   use newmark_step, only: newmark_state_t, take_step
   use carried_loads, only: net_load
   use problem, only: problem_t
   use scene_status, only: status_complete, status_interrupted, status_not_converged
   use signals, only: must_stop
   implicit none(type, external)
   private

   !> Cuts within a cut: a step of 2^-30 of the grid's that still fails will not succeed.
   integer, parameter :: deepest_cut = 30
   !> Cuts of one step of the grid: a motion that needs more needs another method.
   integer(int64), parameter :: most_cuts = 256_int64

   !> Evaluations after which a period looks whether it must end
   integer(int64), parameter :: evaluations_between_looks = 65536_int64

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
      integer :: i, iterations

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
         call take_step(kernel, problem, request, time_step, force(i), state, next, iterations, status)
         count%evaluations = count%evaluations + int(iterations, int64)
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
      integer :: part, iterations

      next = state
      if (status == status_not_converged .or. depth > deepest_cut .or. count%cuts >= last_cut) return
      count%cuts = count%cuts + 1
      half = 0.5_dp*time_step
      from = state
      do part = 1, 2
         end_phase = phase + 0.5_dp*real(part, dp)*phase_step
         force = force_at(problem%force, end_phase)
         call take_step(kernel, problem, request, half, force, from, next, iterations, status)
         count%evaluations = count%evaluations + int(iterations, int64)
         if (status /= status_complete) call cut_step(kernel, problem, request, half, end_phase - 0.5_dp*phase_step, &
                                                      0.5_dp*phase_step, depth + 1, last_cut, from, next, count, status)
         if (status /= status_complete) return
         from = next
      end do
   end subroutine cut_step

end module newmark
