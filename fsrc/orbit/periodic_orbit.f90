!> The periodic motion next to a state: found by Newton's method on the period map, from period 1 to 8.
module periodic_orbit
   use constants, only: two_pi
   use floquet, only: floquet_multipliers, orbit_stability, orbit_unstable
   use kinds, only: dp
   use period_map, only: map_states
   use problem, only: problem_t, thinner_film
   implicit none(type, external)
   private

   integer, parameter :: longest_period = 8
   !> Accuracy of the period map, and of the fixed point.
   real(dp), parameter :: map_accuracy = 1.0e-12_dp, converged = 1.0e-10_dp
   !> Step of the differences: their error is about its square, and map_accuracy over it.
   real(dp), parameter :: difference_step = 1.0e-4_dp
   integer, parameter :: most_newton_steps = 8

   !> A periodic motion.
   type, public :: periodic_orbit_t
      !> Period in periods of the force, 0: none was found
      integer :: period = 0
      !> State at the start of a period of the force [m], [m/s]
      real(dp) :: film = 0.0_dp
      real(dp) :: velocity = 0.0_dp
      !> Distance of the state that the search began with, relative to the film [-]
      real(dp) :: distance = 0.0_dp
      !> Floquet multipliers of one period of the motion [-]
      complex(dp) :: multipliers(2) = (0.0_dp, 0.0_dp)
   end type periodic_orbit_t

   public :: find_periodic_orbit, attracting_period

contains

   !> Look for a periodic motion near a state; the shortest period that is near enough is taken.
   function find_periodic_orbit(problem, film, velocity, nearness) result(orbit)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> State at the start of a period of the force [m], [m/s]
      real(dp), intent(in) :: film
      real(dp), intent(in) :: velocity
      !> Distance at which a periodic motion is another one, relative to the film [-]
      real(dp), intent(in) :: nearness
      type(periodic_orbit_t) :: orbit
      real(dp) :: films(1), velocities(1), scale
      integer :: period
      logical :: mapped

      scale = 1.0_dp/(two_pi*problem%frequency)
      films = film
      velocities = velocity
      do period = 1, longest_period
         call map_states(problem, 1, map_accuracy, films, velocities, mapped)
         if (.not. mapped) return
         if (max(abs(films(1) - film), abs(velocities(1) - velocity)*scale) > &
             nearness*thinner_film(problem, film)) cycle
         orbit = newton(problem, period, film, velocity, scale)
         if (orbit%period > 0 .and. orbit%distance <= nearness) return
      end do
      orbit = periodic_orbit_t()
   end function find_periodic_orbit

   !> Periods of the force after which motions near a periodic one repeat, 0 where there is none or they leave it.
   pure integer function attracting_period(orbit) result(period)
      !> A periodic motion, or none
      type(periodic_orbit_t), intent(in) :: orbit

      period = 0
      if (orbit%period == 0) return
      if (orbit_stability(orbit%multipliers) /= orbit_unstable) period = orbit%period
   end function attracting_period

   !> Fixed point of the map of some periods, and the multipliers there.
   function newton(problem, period, film, velocity, scale) result(orbit)
      type(problem_t), intent(in) :: problem
      integer, intent(in) :: period
      real(dp), intent(in) :: film
      real(dp), intent(in) :: velocity
      !> Film that a velocity counts as [s]
      real(dp), intent(in) :: scale
      type(periodic_orbit_t) :: orbit
      real(dp) :: films(5), velocities(5), jacobian(2, 2), state(2), gap(2), change(2), h, w, determinant, thickness
      integer :: step
      logical :: mapped

      state = [film, velocity]
      do step = 1, most_newton_steps
         thickness = min(state(1), problem%backlash - state(1))
         h = difference_step*thickness
         w = difference_step*thickness/scale
         films = state(1) + [0.0_dp, h, -h, 0.0_dp, 0.0_dp]
         velocities = state(2) + [0.0_dp, 0.0_dp, 0.0_dp, w, -w]
         call map_states(problem, period, map_accuracy, films, velocities, mapped)
         if (.not. mapped) return
         jacobian(:, 1) = [films(2) - films(3), velocities(2) - velocities(3)]/(2.0_dp*h)
         jacobian(:, 2) = [films(4) - films(5), velocities(4) - velocities(5)]/(2.0_dp*w)
         gap = [films(1), velocities(1)] - state
         ! (1 - J) change = gap
         determinant = (1.0_dp - jacobian(1, 1))*(1.0_dp - jacobian(2, 2)) - jacobian(1, 2)*jacobian(2, 1)
         if (abs(determinant) < tiny(1.0_dp)) return
         change(1) = ((1.0_dp - jacobian(2, 2))*gap(1) + jacobian(1, 2)*gap(2))/determinant
         change(2) = (jacobian(2, 1)*gap(1) + (1.0_dp - jacobian(1, 1))*gap(2))/determinant
         state = state + change
         thickness = thinner_film(problem, state(1))
         if (.not. thickness > 0.0_dp) return
         if (max(abs(change(1)), abs(change(2))*scale) > converged*thickness) cycle
         orbit%period = period
         orbit%film = state(1)
         orbit%velocity = state(2)
         orbit%distance = max(abs(state(1) - film), abs(state(2) - velocity)*scale)/thickness
         orbit%multipliers = floquet_multipliers(jacobian)
         return
      end do
   end function newton

end module periodic_orbit
