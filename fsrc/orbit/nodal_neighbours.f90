!> A motion in nodes of pressure beside a neighbour (module nodal_tangent), through a period and back, until its time is over.
module nodal_neighbours
   use engine, only: ending_t, motion_state_t
   use kinds, only: dp
   use lyapunov, only: followed_motions_t, path_t
   use nodal_orbit, only: follow_period, state_of_neighbours
   use nodal_state, only: unpack_motion
   use nodal_step, only: gear_t, motion_t, nodal_choice_t, set_up
   use nodal_tangent, only: combine, neighbours, nodal_tangent_t, start_tangent
   use problem, only: of_film, of_velocity, problem_t
   use scene_status, only: status_complete
   use window_record, only: start_record
   implicit none(type, external)
   private

   !> The motion, a single one.
   type, extends(followed_motions_t), public :: nodal_neighbours_t
      private
      type(gear_t) :: gear
      type(motion_t) :: motion
      type(nodal_tangent_t) :: tangent
   contains
      procedure :: carry
   end type nodal_neighbours_t

   public :: beside_nodal_neighbour

contains

   !> A motion from where it stands, with its neighbour.
   function beside_nodal_neighbour(problem, choice, numbers) result(followed)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> How it was followed
      type(nodal_choice_t), intent(in) :: choice
      !> Where it stands, as of pack_motion
      real(dp), intent(in) :: numbers(:)
      type(nodal_neighbours_t) :: followed

      followed%ends_at = choice%ends_at
      associate (gear => followed%gear, motion => followed%motion)
         call set_up(problem, choice, gear)
         call unpack_motion(problem, choice%nodes, numbers, motion)
         call start_tangent(gear%contact, motion%flanks(:gear%flanks), motion%time*gear%period, followed%tangent)
      end associate
   end function beside_nodal_neighbour

   !> Carry the motion and its neighbour through a period. The neighbour keeps its direction and comes back to a unit.
   subroutine carry(self, left, period, growths, states, passed, paths)
      class(nodal_neighbours_t), intent(inout) :: self
      integer, intent(in) :: left(:)
      integer, intent(in) :: period
      real(dp), intent(inout) :: growths(:)
      real(dp), intent(inout) :: states(:, :)
      logical, intent(inout) :: passed(:)
      type(path_t), intent(inout) :: paths(:)
      type(ending_t) :: ending
      type(motion_state_t) :: start
      real(dp) :: state(2, neighbours), farthest, share(neighbours, neighbours)

      associate (gear => self%gear, motion => self%motion, tangent => self%tangent, only => left(1))
         if (period == 1) then
            start%numbers = motion%states(1, :)
            call start_record(start, paths(only)%record)
         end if
         if (period < 1) then
            call follow_period(gear, motion, ending, tangent)
         else
            call follow_period(gear, motion, ending, tangent, paths(only)%record)
         end if
         if (ending%status /= status_complete .or. .not. tangent%exists) return
         state = state_of_neighbours(gear, tangent)
         farthest = maxval(abs(state(:, 1)))
         passed(only) = farthest > 0.0_dp
         if (.not. passed(only)) return
         growths(only) = log(farthest)
         states(:, only) = motion%states(1, [of_film, of_velocity])
         share = 0.0_dp
         share(1, 1) = 1.0_dp/farthest
         share(2, 2) = share(1, 1)
         call combine(share, tangent)
      end associate
   end subroutine carry

end module nodal_neighbours
