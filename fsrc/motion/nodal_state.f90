!> The state of a motion in nodes of pressure as a list of numbers, from which it goes on to the last bit: histories of the gear and
!> of its films, with pressures and volumes where a film is in nodes at that time.
module nodal_state
   use kinds, only: dp
   use nodal_flank, only: difference_times, kept_times
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
      real(dp) :: single(3), in_nodes(1)
      integer :: flank, next, j

      next = 1
      call take(numbers, next, motion%position)
      call take(numbers, next, motion%velocity)
      call take(numbers, next, motion%time)
      call take(numbers, next, single)
      motion%known = nint(single(1))
      motion%step = single(2)
      motion%fastest = single(3)
      allocate (motion%states(0:kept_times, state_size(problem)))
      do j = 1, size(motion%states, 2)
         call take(numbers, next, motion%states(:, j))
      end do
      do flank = 1, contact_count(problem)
         associate (film => motion%flanks(flank))
            call take(numbers, next, film%gap)
            call take(numbers, next, film%load)
            call take(numbers, next, film%film)
            call take(numbers, next, film%velocity)
            call take(numbers, next, film%centre)
            call take(numbers, next, film%peak)
            call take(numbers, next, film%film_at_peak)
            call take(numbers, next, film%middle)
            call take(numbers, next, film%bending)
            call take(numbers, next, in_nodes)
            film%in_nodes = in_nodes(1) > 0.5_dp
            if (.not. film%in_nodes) then
               next = next + nodes*(kept_times + 1 + difference_times)
               cycle
            end if
            allocate (film%pressures(nodes, 0:kept_times), film%volumes(nodes, difference_times), film%past(nodes), source=0.0_dp)
            allocate (film%active(nodes), source=.false.)
            do j = 0, kept_times
               call take(numbers, next, film%pressures(:, j))
            end do
            do j = 1, difference_times
               call take(numbers, next, film%volumes(:, j))
            end do
         end associate
      end do
   end subroutine unpack_motion

   !> Take the next numbers.
   pure subroutine take(numbers, next, values)
      real(dp), intent(in) :: numbers(:)
      !> Place of the first one, then of the one behind the last
      integer, intent(inout) :: next
      real(dp), intent(out) :: values(:)

      values = numbers(next:next + size(values) - 1)
      next = next + size(values)
   end subroutine take

end module nodal_state
