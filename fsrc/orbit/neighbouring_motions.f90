!> Motions of the controlled engine beside a neighbour of each, through a period and back: solved side by side, or with a displacement
!> that implicit steps carry along.
module neighbouring_motions
   use carried_loads, only: counts_as, sizes_of_state
   use engine, only: ending_t, motion_state_t, request_t
   use kinds, only: dp
   use lyapunov, only: followed_motions_t, path_t
   use many_motions, only: has_tangents, solve_motions
   use problem, only: of_film, of_velocity, problem_t, state_size
   use scene_status, only: status_complete
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Accuracy of the motions, and distance of the neighbours, relative to the film: a thousand times farther apart than the
   !> errors of a period, whose per mille of a growth is nothing beside its scatter from period to period, and near enough for
   !> the distance to grow as an infinitely small one does.
   real(dp), parameter :: map_accuracy = 1.0e-8_dp, distance = 1.0e-5_dp

   !> The motions.
   type, extends(followed_motions_t), public :: neighbouring_motions_t
      private
      !> What moves
      type(problem_t), allocatable :: problems(:)
      !> Where the motions stand, at the start of a period
      type(motion_state_t), allocatable :: here(:)
      !> Of the neighbours: number of the state, 1, motion
      real(dp), allocatable :: displacements(:, :, :)
   contains
      procedure :: carry
   end type neighbouring_motions_t

   public :: beside_neighbours

contains

   !> Motions from where they stand, with their neighbours.
   function beside_neighbours(problems, states) result(followed)
      !> What moves
      type(problem_t), intent(in) :: problems(:)
      !> Where each motion stands, at the start of a period
      type(motion_state_t), intent(in) :: states(:)
      type(neighbouring_motions_t) :: followed
      integer :: i

      allocate (followed%problems, source=problems)
      allocate (followed%here(size(problems)))
      allocate (followed%displacements(maxval(state_size(problems)), 1, size(problems)), source=0.0_dp)
      do i = 1, size(problems)
         associate (numbers => states(i)%numbers)
            followed%here(i) = motion_state_t(numbers=numbers)
            followed%displacements(:size(numbers), 1, i) = distance*sizes_of(problems(i), numbers)
         end associate
      end do
   end function beside_neighbours

   !> Carry motions and their neighbours through a period.
   subroutine carry(self, left, period, growths, states, passed, paths)
      class(neighbouring_motions_t), intent(inout) :: self
      integer, intent(in) :: left(:)
      integer, intent(in) :: period
      real(dp), intent(inout) :: growths(:)
      real(dp), intent(inout) :: states(:, :)
      logical, intent(inout) :: passed(:)
      type(path_t), intent(inout) :: paths(:)
      integer :: i

      call carry_period(self%problems, left, period, self%here, self%displacements, passed, paths)
      do i = 1, size(left)
         associate (place => left(i))
            if (.not. passed(place)) cycle
            associate (numbers => self%here(place)%numbers)
               call part(self%problems(place), numbers, self%displacements(:size(numbers), 1, place), growths(place))
               states(:, place) = numbers([of_film, of_velocity])
            end associate
         end associate
      end do
   end subroutine carry

   !> Carry motions and their displacements through a period: those that have tangents with these, the others beside a neighbour.
   subroutine carry_period(problems, left, period, here, displacements, passed, paths)
      !> What moves, and which of it
      type(problem_t), intent(in) :: problems(:)
      integer, intent(in) :: left(:)
      !> Its number; from the first one on the steps are recorded
      integer, intent(in) :: period
      !> Where the motions stand, at the start of a period and then at its end
      type(motion_state_t), intent(inout) :: here(:)
      !> Number of the state, 1, problem
      real(dp), intent(inout) :: displacements(:, :, :)
      !> Whether a motion and what is beside it could be followed
      logical, intent(inout) :: passed(:)
      type(path_t), intent(inout) :: paths(:)
      type(request_t) :: one_period
      type(motion_state_t) :: neighbours(size(problems))
      type(ending_t) :: endings(2*size(problems))
      type(window_record_t) :: records(2*size(problems))
      real(dp) :: samples(max(1, period), size(displacements, 1), 2*size(problems))
      real(dp), allocatable :: moved(:, :, :)
      integer, allocatable :: along(:), beside(:)
      integer :: i, n

      one_period = request_t(accuracy=map_accuracy, periods=1)
      ! One more period of those that a record has, and so one sample more.
      if (period > 0) one_period = request_t(accuracy=map_accuracy, periods=period, sampled_periods=period, samples_per_period=1)
      here%periods = one_period%periods - 1
      along = pack(left, has_tangents(problems(left), here(left), map_accuracy))
      beside = pack(left,.not. has_tangents(problems(left), here(left), map_accuracy))
      n = size(along)
      moved = displacements(:, :, along)
      do i = 1, n
         call hand_over(paths(along(i))%record, records(i))
      end do
      if (n > 0) call solve_motions(problems(along), here(along), one_period, samples(:, :, :n), endings(:n), &
                                    records=records(:n), displacements=moved)
      do i = 1, n
         associate (place => along(i))
            passed(place) = endings(i)%status == status_complete
            here(place)%numbers = endings(i)%numbers
            displacements(:, :, place) = moved(:, :, i)
            call hand_over(records(i), paths(place)%record)
         end associate
      end do
      n = size(beside)
      do i = 1, n
         associate (place => beside(i))
            neighbours(place) = here(place)
            neighbours(place)%numbers = here(place)%numbers + displacements(:size(here(place)%numbers), 1, place)
            call hand_over(paths(place)%record, records(2*i - 1))
            records(2*i) = window_record_t(wants=.false.)
         end associate
      end do
      if (n > 0) call solve_motions([(problems(beside(i)), problems(beside(i)), i=1, n)], &
                                    [(here(beside(i)), neighbours(beside(i)), i=1, n)], one_period, samples(:, :, :2*n), &
                                    endings(:2*n), records=records(:2*n))
      do i = 1, n
         associate (place => beside(i), motion => endings(2*i - 1), neighbour => endings(2*i))
            passed(place) = motion%status == status_complete .and. neighbour%status == status_complete
            here(place)%numbers = motion%numbers
            displacements(:size(motion%numbers), 1, place) = neighbour%numbers - motion%numbers
            call hand_over(records(2*i - 1), paths(place)%record)
         end associate
      end do
   end subroutine carry_period

   !> Hand a record over; its turns, which are many, are moved.
   pure subroutine hand_over(from, to)
      !> Without its turns on return
      type(window_record_t), intent(inout) :: from
      type(window_record_t), intent(inout) :: to
      real(dp), allocatable :: turns(:)

      call move_alloc(from%turns, turns)
      to = from
      call move_alloc(turns, to%turns)
   end subroutine hand_over

   !> How far a displacement has grown in a period; for the next one it is brought back.
   subroutine part(problem, motion, displacement, growth)
      type(problem_t), intent(in) :: problem
      !> Numbers of the state of the motion
      real(dp), intent(in) :: motion(:)
      !> Of these numbers, after the period and for the next one
      real(dp), intent(inout) :: displacement(:)
      !> Logarithm by which their distance grew [-]
      real(dp), intent(out) :: growth
      real(dp) :: direction(size(motion)), farthest

      direction = displacement/sizes_of(problem, motion)
      farthest = maxval(abs(direction))
      ! Neighbours that have met give no direction: what is left of their distance is less than the errors.
      if (.not. farthest > map_accuracy*distance) then
         farthest = map_accuracy*distance
         direction = farthest
      end if
      growth = log(farthest/distance)
      displacement = distance*(direction/farthest)*sizes_of(problem, motion)
   end subroutine part

   !> What the numbers of a state count as, each in its unit.
   function sizes_of(problem, numbers) result(sizes)
      type(problem_t), intent(in) :: problem
      !> Of the state
      real(dp), intent(in) :: numbers(:)
      real(dp) :: sizes(size(numbers))

      sizes = sizes_of_state(problem, numbers, counts_as(problem, numbers))
   end function sizes_of

end module neighbouring_motions
