!> Whether neighbouring motions part from each other for good: the largest Lyapunov exponent, from motions and a neighbour of each
!> that are solved side by side, or from a displacement that implicit steps carry along. After every period of the force the
!> neighbour is brought back to a small distance along the direction in which it left; the exponent is the mean logarithm by which
!> the distance grew (Benettin and others 1980).
!>
!> A motion that repeats, or one that settles to it, has an exponent of 0 or less; that of a motion which never repeats though its
!> force does is 0 where two frequencies without a common measure make it, and positive where it is irregular for good.
!>
!> The steps of the motion are recorded meanwhile, as those of a window are: what an irregular motion amounts to is known from
!> these periods, with the errors that its sums after each of them give.
module lyapunov
   use carried_loads, only: counts_as, sizes_of_state
   use engine, only: ending_t, motion_state_t, request_t
   use kinds, only: dp
   use many_motions, only: has_tangents, solve_motions
   use problem, only: of_film, of_velocity, problem_t, state_size
   use scene_status, only: status_complete
   use signals, only: must_stop
   use window_record, only: sums_of_record, window_record_t
   implicit none(type, external)
   private

   !> Periods that a motion and its neighbour are followed, in stretches, at least and at most. After each stretch it is seen whether
   !> they part at all; after the least of them, whether more would show more.
   integer, parameter, public :: stretch_periods = 25
   integer, parameter :: stretches = 4, most_stretches = 12
   !> Periods of a block, whose means give the statistical error of the exponent.
   integer, parameter :: block_periods = 5
   !> Periods in which the neighbour turns into the direction that grows most: they do not count.
   integer, parameter, public :: turning_periods = 5
   !> Accuracy of the motions, and distance of the neighbours, relative to the film: a thousand times farther apart than the
   !> errors of a period, whose per mille of a growth is nothing beside its scatter from period to period, and near enough for
   !> the distance to grow as an infinitely small one does.
   real(dp), parameter :: map_accuracy = 1.0e-8_dp, distance = 1.0e-5_dp
   !> Standard errors by which an exponent has to differ from 0.
   real(dp), parameter :: least_errors = 2.0_dp

   !> Periods that a motion has to be followed to be reported irregular, and no more than which it is followed.
   integer, parameter, public :: followed_periods = stretches*stretch_periods
   integer, parameter, public :: most_followed_periods = most_stretches*stretch_periods

   !> How a motion and its neighbour part.
   type, public :: parting_t
      !> Periods they were followed; 0: not at all
      integer :: periods = 0
      !> Lyapunov exponent a period of the force, and its standard error [-]
      real(dp) :: exponent = 0.0_dp
      real(dp) :: standard_error = 0.0_dp
      !> Whether they part for good: the exponent is positive beyond its error, over all periods requested
      logical :: for_good = .false.
      !> Whether the time of the scene was over before all of these periods
      logical :: out_of_time = .false.
   end type parting_t

   !> Where a motion was, over the periods that it was followed.
   type, public :: path_t
      !> What its steps report of them; with what is requested of that, and no periods where the motion does not part for good
      type(window_record_t) :: record
      !> Films and velocities at the ends of the periods: number, period
      real(dp), allocatable :: states(:, :)
      !> Sums of the record: number, as of sums_of_record; period, from 0 on
      real(dp), allocatable :: sums(:, :)
   end type path_t

   !> Whether a path shows enough of its motion, or should be followed on.
   abstract interface
      pure logical function path_is_enough(path)
         import :: path_t
         type(path_t), intent(in) :: path
      end function path_is_enough
   end interface

   public :: follow_neighbours, parting_of, draws_near

contains

   !> Follow motions and their neighbours: until these draw near, or part for good and enough is known of the motion. After a signal to
   !> stop the answer is of no use.
   subroutine follow_neighbours(problems, states, is_enough, partings, paths)
      !> What moves
      type(problem_t), intent(in) :: problems(:)
      !> Where each motion stands, at the start of a period
      type(motion_state_t), intent(in) :: states(:)
      procedure(path_is_enough) :: is_enough
      type(parting_t), intent(out) :: partings(:)
      !> Where the motions went that part for good
      type(path_t), intent(inout) :: paths(:)
      type(motion_state_t) :: here(size(problems))
      real(dp) :: growths(-turning_periods + 1:most_followed_periods, size(problems))
      real(dp) :: displacements(maxval(state_size(problems)), 1, size(problems))
      real(dp), allocatable :: sums(:, :)
      logical :: passed(size(problems))
      integer, allocatable :: left(:)
      integer :: period, i

      displacements = 0.0_dp
      do i = 1, size(problems)
         associate (numbers => states(i)%numbers)
            here(i) = motion_state_t(numbers=numbers)
            displacements(:size(numbers), 1, i) = distance*sizes_of(problems(i), numbers)
         end associate
         allocate (paths(i)%states(of_velocity, most_followed_periods))
      end do
      left = [(i, i=1, size(problems))]
      do period = -turning_periods + 1, most_followed_periods
         if (size(left) == 0 .or. must_stop()) exit
         passed = .false.
         call carry_period(problems, left, period, here, displacements, passed, paths)
         do i = 1, size(left)
            if (.not. passed(left(i))) partings(left(i))%for_good = .false.
         end do
         left = pack(left, passed(left))
         do i = 1, size(left)
            associate (place => left(i), path => paths(left(i)))
               call part(problems(place), here(place)%numbers, displacements(:size(here(place)%numbers), 1, place), &
                         growths(period, place))
               if (period < 1) cycle
               if (period == 1) allocate (path%sums(size(sums_of_record(path%record)), 0:most_followed_periods), source=0.0_dp)
               path%sums(:, period) = sums_of_record(path%record)
               path%states(:, period) = here(place)%numbers([of_film, of_velocity])
               if (mod(period, stretch_periods) /= 0) cycle
               partings(place) = parting_of(growths(1:period, place))
               passed(place) = .not. draws_near(partings(place))
               if (partings(place)%for_good) passed(place) = .not. is_enough(path)
            end associate
         end do
         left = pack(left, passed(left))
      end do
      do i = 1, size(problems)
         associate (path => paths(i), periods => partings(i)%periods)
            if (partings(i)%for_good) then
               path%states = path%states(:, :periods)
               allocate (sums(size(path%sums, 1), 0:periods), source=path%sums(:, :periods))
               call move_alloc(sums, path%sums)
            else
               path = path_t()
            end if
         end associate
      end do
   end subroutine follow_neighbours

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

   !> What the growth of the distance over the periods says. An exponent counts as positive if it is so by two standard errors, in
   !> each half of the periods, and in the last stretch: a motion that settles meanwhile parts from its neighbour only before.
   pure type(parting_t) function parting_of(growths) result(parting)
      !> Logarithm of the growth in each period, whole stretches [-]
      real(dp), intent(in) :: growths(:)
      real(dp) :: blocks(size(growths)/block_periods)
      integer :: n

      n = size(growths)
      blocks = sum(reshape(growths, [block_periods, size(blocks)]), dim=1)/real(block_periods, dp)
      parting%periods = n
      parting%exponent = sum(blocks)/real(size(blocks), dp)
      parting%standard_error = sqrt(sum((blocks - parting%exponent)**2)/real(size(blocks)*(size(blocks) - 1), dp))
      parting%for_good = n >= followed_periods .and. parting%exponent > least_errors*parting%standard_error .and. &
                         sum(growths(:n/2)) > 0.0_dp .and. sum(growths(n/2 + 1:)) > 0.0_dp .and. &
                         sum(growths(max(1, n - stretch_periods + 1):)) > 0.0_dp
   end function parting_of

   !> Whether the exponent is negative beyond its error: then the motion settles, and need not be followed any longer.
   elemental logical function draws_near(parting)
      type(parting_t), intent(in) :: parting

      draws_near = parting%exponent < -least_errors*parting%standard_error
   end function draws_near

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

end module lyapunov
