!> The period map: the state at the end of some periods of the force from that at their start.
!> A motion that repeats is a fixed point of it.
module period_map
   use engine, only: ending_t, motion_state_t, numbers_of, request_t
   use kinds, only: dp
   use many_motions, only: solve_motions
   use problem, only: largest_state, of_drive_compression, of_film, of_velocity, problem_t
   use scene_status, only: status_complete
   implicit none(type, external)
   private

   public :: map_states

contains

   !> Images of states under the period map; neighbours are solved together.
   subroutine map_states(problem, periods, accuracy, states, mapped)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Periods of the force
      integer, intent(in) :: periods
      !> Relative accuracy of the film [-]
      real(dp), intent(in) :: accuracy
      !> Number of a state, state; replaced by their images
      real(dp), intent(inout) :: states(:, :)
      !> Whether every state could be followed to the end
      logical, intent(out) :: mapped
      type(problem_t) :: problems(size(states, 2))
      type(motion_state_t) :: starts(size(states, 2))
      type(ending_t) :: endings(size(states, 2))
      real(dp) :: none(0, 2, size(states, 2)), numbers(largest_state)
      integer :: i

      problems = problem
      do i = 1, size(starts)
         starts(i)%film = states(of_film, i)
         starts(i)%velocity = states(of_velocity, i)
         starts(i)%compression(:size(states, 1) - of_velocity) = states(of_drive_compression:, i)
      end do
      call solve_motions(problems, starts, request_t(accuracy=accuracy, periods=periods), none, endings)
      mapped = all(endings%status == status_complete)
      do i = 1, size(endings)
         numbers = numbers_of(endings(i))
         states(:, i) = numbers(:size(states, 1))
      end do
   end subroutine map_states

end module period_map
