!> One step of Newmark's average acceleration method for m z'' = W(h, z') - F(t) - m g, eq (1), with the iteration
!> within a step that (36) ends:
!>
!>    h_i  = h_(i-1) + dt z'_(i-1) + dt^2/4 (z''_(i-1) + z''_i)
!>    z'_i = z'_(i-1) + dt/2 (z''_(i-1) + z''_i)
!>
!> A pass evaluates the film at the present iterate. `successive`: its load gives z''_i, as in the paper.
!> `newton`: the load is linearised about the iterate, which gives z''_i from one linear equation.
!>
!> Where teeth give, the gear moves by these formulas and the films, which have velocities of their own, by the trapezium,
!> h_i = h_(i-1) + dt/2 (h'_(i-1) + h'_i). The loads at the end of the step are found by Newton's method with the slopes of the law.
module newmark_step
   use engine, only: request_t
   use film_law, only: film_kernel, never_pulls, overflow_load
   use kinds, only: dp
   use carried_loads, only: net_load
   use problem, only: has_elastic_teeth, has_two_flanks, problem_t, thinner_film
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
      !> Where teeth give, of the drive and the coast flank: compressions of the springs d [m] and velocities of the films h' [m/s]
      real(dp) :: compression(2) = 0.0_dp, film_velocity(2) = 0.0_dp
   end type newmark_state_t

   public :: take_step

contains

   !> One step of whichever teeth.
   pure subroutine take_step(kernel, problem, request, time_step, force, state, next, passes, status)
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
      integer, intent(out) :: passes
      !> Status of scene_status
      integer, intent(out) :: status

      if (has_elastic_teeth(problem)) then
         call spring_step(kernel, problem, request, time_step, force, state, next, passes, status)
      else
         call rigid_step(kernel, problem, request, time_step, force, state, next, passes, status)
      end if
   end subroutine take_step

   !> One step of rigid teeth.
   pure subroutine rigid_step(kernel, problem, request, time_step, force, state, next, passes, status)
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

      ! Factors of z'' at the end of the step, and what h and z' would be there if it were zero.
      velocity_weight = 0.5_dp*time_step
      film_weight = velocity_weight*velocity_weight
      known_film = state%film + time_step*state%velocity + film_weight*state%acceleration
      known_velocity = state%velocity + velocity_weight*state%acceleration
      next = state
      if (request%extrapolate) then
         next%film = known_film + film_weight*state%acceleration
         next%velocity = known_velocity + velocity_weight*state%acceleration
      end if
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
         if (request%by_newton) then
            next%acceleration = (load + load_by_film*(known_film - next%film) + &
                                 load_by_velocity*(known_velocity - next%velocity) - force - problem%weight)/ &
                                (problem%mass - load_by_film*film_weight - load_by_velocity*velocity_weight)
         else
            next%acceleration = (load - force - problem%weight)/problem%mass
         end if
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
   end subroutine rigid_step

   !> One step where teeth give: Newton's method for the loads of both films.
   pure subroutine spring_step(kernel, problem, request, time_step, force, state, next, passes, status)
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
      real(dp), dimension(2) :: load, residual, by_film, by_velocity, films, old_films, start, correction, sign_of
      real(dp) :: slopes(2, 2), half, way, determinant, carried, ratio
      integer :: flanks, flank

      half = 0.5_dp*time_step
      sign_of = [1.0_dp, -1.0_dp]
      flanks = merge(2, 1, has_two_flanks(problem))
      start = state%film
      if (flanks == 2) start(2) = problem%backlash - state%film + sum(state%compression)
      load = state%compression/problem%compliance
      films = start
      next = state
      status = status_film_lost
      do passes = 1, request%iteration_limit
         next%acceleration = (load(1) - load(2) - force - problem%weight)/problem%mass
         next%velocity = state%velocity + half*(state%acceleration + next%acceleration)
         way = half*(state%velocity + next%velocity)
         next%compression = problem%compliance*load
         old_films = films
         films = start + (sign_of*way + (next%compression - state%compression))
         next%film_velocity = (films - start)/half - state%film_velocity
         next%film = films(1)
         if (minval(films(:flanks)) <= smallest_film_ratio*minval(start(:flanks))) return
         ! The loads of the last pass fulfil the law within the tolerance of the films.
         if (passes > 1 .and. maxval(abs(films(:flanks) - old_films(:flanks))) < request%tolerance) then
            status = status_complete
            return
         end if
         slopes = 0.0_dp
         residual = 0.0_dp
         slopes(2, 2) = 1.0_dp
         do flank = 1, flanks
            call kernel(problem%film, films(flank), next%film_velocity(flank), carried, by_film(flank), by_velocity(flank))
            if (.not. carried < overflow_load) then
               status = problem%film%status_without_load
               return
            end if
            residual(flank) = carried - load(flank)
            ! A film that never pulls: the equation of the logarithms, as in module elastic_step.
            if (never_pulls(problem%film) .and. carried > 0.0_dp .and. load(flank) > carried) then
               ratio = load(flank)/carried
               residual(flank) = -load(flank)*log(ratio)
               by_film(flank) = by_film(flank)*ratio
               by_velocity(flank) = by_velocity(flank)*ratio
            end if
            ! What one of each load moves: the gear by half**2/m, its own film by the spring as well.
            slopes(flank, :flanks) = -sign_of(flank)*sign_of(:flanks)*(by_film(flank)*half + by_velocity(flank))*half/problem%mass
            slopes(flank, flank) = slopes(flank, flank) + 1.0_dp &
                                   - (by_film(flank) + by_velocity(flank)/half)*problem%compliance
         end do
         determinant = slopes(1, 1)*slopes(2, 2) - slopes(1, 2)*slopes(2, 1)
         correction = [residual(1)*slopes(2, 2) - slopes(1, 2)*residual(2), &
                       slopes(1, 1)*residual(2) - slopes(2, 1)*residual(1)]/determinant
         if (never_pulls(problem%film)) correction = max(correction, -0.9_dp*load)
         load = load + correction
      end do
      passes = request%iteration_limit
      status = status_not_converged
   end subroutine spring_step

end module newmark_step
