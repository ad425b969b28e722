!> The state of a motion in nodes of pressure as a list of numbers, from which it goes on to the last bit: histories of the gear and
!> of its films, with pressures and volumes where a film is in nodes at that time.
module nodal_state
   use kinds, only: dp
   use nodal_flank, only: difference_times, kept_times, nodal_flank_t
   use nodal_step, only: motion_t
   use problem, only: contact_count, problem_t, state_size
   implicit none(type, external)
   private

   public :: size_of_motion, pack_motion, unpack_motion

contains

   !> How many numbers a state has.
   pure integer function size_of_motion(problem, nodes)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Of pressure
      integer, intent(in) :: nodes
      !> Histories of a flank and of the gear, and their single numbers
      integer, parameter :: of_flank = 5*(kept_times + 1) + 9, of_gear = 3*(kept_times + 1) + 3

      size_of_motion = of_gear + (kept_times + 1)*state_size(problem) &
                       + contact_count(problem)*(of_flank + nodes*(kept_times + 1 + difference_times))
   end function size_of_motion

   !> The numbers of a motion.
   pure function pack_motion(problem, nodes, motion) result(numbers)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Of pressure
      integer, intent(in) :: nodes
      type(motion_t), intent(in) :: motion
      real(dp), allocatable :: numbers(:)
      real(dp) :: pressures(nodes, 0:kept_times), volumes(nodes, difference_times)
      integer :: flank

      numbers = [motion%position, motion%velocity, motion%time, real(motion%known, dp), motion%step, motion%fastest, motion%states]
      do flank = 1, contact_count(problem)
         associate (film => motion%flanks(flank))
            pressures = 0.0_dp
            volumes = 0.0_dp
            if (film%in_nodes) then
               pressures = film%pressures
               volumes = film%volumes
            end if
            numbers = [numbers, film%gap, film%load, film%film, film%velocity, film%centre, film%peak, film%film_at_peak, &
                       film%middle, film%bending, merge(1.0_dp, 0.0_dp, film%in_nodes), pressures, volumes]
         end associate
      end do
   end function pack_motion

   !> The motion of some numbers.
   pure subroutine unpack_motion(problem, nodes, numbers, motion)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Of pressure
      integer, intent(in) :: nodes
      !> As of pack_motion
      real(dp), intent(in) :: numbers(:)
      type(motion_t), intent(out) :: motion
      integer :: flank, next

      next = 1
      motion%position = taken(next, kept_times + 1)
      next = next + kept_times + 1
      motion%velocity = taken(next, kept_times + 1)
      next = next + kept_times + 1
      motion%time = taken(next, kept_times + 1)
      next = next + kept_times + 1
      motion%known = nint(numbers(next))
      motion%step = numbers(next + 1)
      motion%fastest = numbers(next + 2)
      next = next + 3
      allocate (motion%states(0:kept_times, state_size(problem)))
      motion%states(:, :) = reshape(taken(next, size(motion%states)), shape(motion%states))
      next = next + size(motion%states)
      do flank = 1, contact_count(problem)
         call unpack_flank(motion%flanks(flank), next)
      end do

   contains

      !> Some numbers.
      pure function taken(first, count)
         !> Place of the first one
         integer, intent(in) :: first
         integer, intent(in) :: count
         real(dp) :: taken(count)

         taken = numbers(first:first + count - 1)
      end function taken

      !> The next flank.
      pure subroutine unpack_flank(film, next)
         type(nodal_flank_t), intent(inout) :: film
         !> Place of the next number
         integer, intent(inout) :: next
         real(dp) :: histories(0:kept_times, 5), pairs(0:1, 4)

         histories = reshape(taken(next, size(histories)), shape(histories))
         next = next + size(histories)
         film%gap = histories(:, 1)
         film%load = histories(:, 2)
         film%film = histories(:, 3)
         film%velocity = histories(:, 4)
         film%centre = histories(:, 5)
         pairs = reshape(taken(next, size(pairs)), shape(pairs))
         next = next + size(pairs)
         film%peak = pairs(:, 1)
         film%film_at_peak = pairs(:, 2)
         film%middle = pairs(:, 3)
         film%bending = pairs(:, 4)
         film%in_nodes = numbers(next) > 0.5_dp
         next = next + 1
         if (film%in_nodes) then
            allocate (film%pressures(nodes, 0:kept_times), film%volumes(nodes, difference_times), film%past(nodes), source=0.0_dp)
            allocate (film%active(nodes), source=.false.)
            film%pressures(:, :) = reshape(taken(next, nodes*(kept_times + 1)), [nodes, kept_times + 1])
            next = next + nodes*(kept_times + 1)
            film%volumes(:, :) = reshape(taken(next, nodes*difference_times), [nodes, difference_times])
            next = next + nodes*difference_times
         else
            next = next + nodes*(kept_times + 1 + difference_times)
         end if
      end subroutine unpack_flank

   end subroutine unpack_motion

end module nodal_state
