!> The period map: film and velocity at the end of some periods of the force from those at their start.
!> A motion that repeats is a fixed point of it.
module period_map
   use engine, only: ending_t, motion_state_t, request_t
   use kinds, only: dp
   use many_motions, only: solve_motions
   use problem, only: problem_t
   use scene_status, only: status_complete
   implicit none(type, external)
   private

   public :: map_states

contains

   !> Images of states under the period map; neighbours are solved together, eight at a time.
   subroutine map_states(problem, periods, accuracy, films, velocities, mapped)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Periods of the force
      integer, intent(in) :: periods
      !> Relative accuracy of the film [-]
      real(dp), intent(in) :: accuracy
      !> States, replaced by their images [m]
      real(dp), intent(inout) :: films(:)
      !> [m/s]
      real(dp), intent(inout) :: velocities(:)
      !> Whether every state could be followed to the end
      logical, intent(out) :: mapped
      type(problem_t) :: problems(size(films))
      type(motion_state_t) :: starts(size(films))
      type(ending_t) :: endings(size(films))
      real(dp) :: no_films(0, size(films)), no_velocities(0, size(films))

      problems = problem
      starts%film = films
      starts%velocity = velocities
      no_films = 0.0_dp
      no_velocities = 0.0_dp
      call solve_motions(problems, starts, request_t(accuracy=accuracy, periods=periods), no_films, no_velocities, endings)
      mapped = all(endings%status == status_complete)
      films = endings%film
      velocities = endings%velocity
   end subroutine map_states

end module period_map
