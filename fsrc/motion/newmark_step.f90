!> One step of Newmark's average acceleration method for m z'' = W(h, z') - F(t) - m g, eq (1), with the iteration
!> within a step that (36) ends:
!>
!>    h_i  = h_(i-1) + dt z'_(i-1) + dt^2/4 (z''_(i-1) + z''_i)
!>    z'_i = z'_(i-1) + dt/2 (z''_(i-1) + z''_i)
!>
!> An iteration evaluates the film at the present iterate. `successive`: its load gives z''_i, as in the paper.
!> `newton`: the load is linearised about the iterate, which gives z''_i from one linear equation.
!>
!> It is the paper's method for the paper's rigid teeth; the checker refuses it for elastic ones.
module newmark_step
   use engine, only: request_t
   use film_state, only: load_t
   use flank_contact, only: film_kernel, overflow_load
   use kinds, only: dp
   use carried_loads, only: net_load
   use problem, only: problem_t, thinner_film
   use scene_status, only: status_complete, status_film_lost, status_not_converged
   implicit none(type, external)
   private

   !> A step in which the film loses more than this factor, or goes to zero and below, is cut in two.
   real(dp), parameter, public :: smallest_film_ratio = 1.0e-3_dp
   !> State of the motion.
   type, public :: newmark_state_t
      !> Film thickness h [m]
      real(dp) :: film = 0.0_dp
      !> z' [m/s]
      real(dp) :: velocity = 0.0_dp
      !> z'' [m/s2]
      real(dp) :: acceleration = 0.0_dp
   end type newmark_state_t

   public :: take_step

contains

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
      real(dp) :: predicted_film, predicted_velocity, old_film, film_weight, velocity_weight, &
                  smallest_film

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

end module newmark_step
