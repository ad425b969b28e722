!> The period map: film and velocity at the end of some periods of the force from those at their start.
!> A motion that repeats is a fixed point of it.
module period_map
   use kinds, only: dp
   use lane_motions, only: solve_motions
   use lane_scenes, only: lane_ending_t, lane_request_t, lane_scene_t
   use scene_status, only: status_complete
   implicit none(type, external)
   private

   public :: map_states

contains

   !> Images of states under the period map; neighbours are solved together, eight at a time.
   subroutine map_states(lane, periods, accuracy, films, velocities, mapped)
      !> The scene; its initial state does not matter
      type(lane_scene_t), intent(in) :: lane
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
      type(lane_scene_t) :: scenes(size(films))
      type(lane_ending_t) :: endings(size(films))
      type(lane_request_t) :: request
      real(dp) :: no_films(0, size(films)), no_velocities(0, size(films))

      scenes = lane
      scenes%initial_film = films
      scenes%initial_velocity = velocities
      request%accuracy = accuracy
      request%periods = periods
      no_films = 0.0_dp
      no_velocities = 0.0_dp
      call solve_motions(scenes, request, no_films, no_velocities, endings)
      mapped = all(endings%status == status_complete)
      films = endings%film
      velocities = endings%velocity
   end subroutine map_states

end module period_map
