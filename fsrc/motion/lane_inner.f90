!> States of films of the motion in a lane, beside the block: they never enter its rows, which the series go over. In the units of
!> their law, of one flank and then of the other.
module lane_inner
   use engine, only: motion_state_t
   use kinds, only: dp
   use problem, only: contact_count, inner_places, problem_t, state_numbers
   use radau_nodes, only: stages
   implicit none(type, external)
   private

   !> States of the films in a lane.
   type, public :: lane_inner_t
      !> Numbers of the film of one flank; 0: films have no state of their own
      integer :: count = 0
      !> Numbers now, where the step leads to, and series about the start of the step: number, power
      real(dp), allocatable :: now(:)
      real(dp), allocatable :: next(:)
      real(dp), allocatable :: series(:, :)
      !> Film that one of each counts as [m]
      real(dp), allocatable :: counts_as(:)
   end type lane_inner_t

   public :: place_inner, evaluate_inner

contains

   !> Put the films of a motion into a lane.
   pure subroutine place_inner(problem, start, inner)
      type(problem_t), intent(in) :: problem
      !> Where it starts
      type(motion_state_t), intent(in) :: start
      type(lane_inner_t), intent(out) :: inner
      integer :: first, last, places(2), i

      places = inner_places(problem, 1)
      inner%count = places(2) - places(1) + 1
      if (inner%count == 0) return
      first = places(1)
      places = inner_places(problem, contact_count(problem))
      last = places(2)
      allocate (inner%now(last - first + 1), source=start%numbers(first:last))
      allocate (inner%next(last - first + 1), source=start%numbers(first:last))
      allocate (inner%series(last - first + 1, 0:stages), source=0.0_dp)
      associate (numbers => state_numbers(problem))
         allocate (inner%counts_as(last - first + 1), source=[(numbers(i)%counts_as, i=first, last)])
      end associate
   end subroutine place_inner

   !> The states at some distances from the start of the step.
   pure subroutine evaluate_inner(inner, distances, values)
      type(lane_inner_t), intent(in) :: inner
      !> [periods]
      real(dp), intent(in) :: distances(:)
      !> Distance, number
      real(dp), intent(out) :: values(:, :)
      integer :: k, i

      do i = 1, size(values, 2)
         values(:, i) = inner%series(i, stages)
         do k = stages - 1, 0, -1
            values(:, i) = values(:, i)*distances + inner%series(i, k)
         end do
      end do
   end subroutine evaluate_inner

end module lane_inner
