!> Whether neighbouring motions part from each other for good: the largest Lyapunov exponent, from motions and a neighbour of each.
!> After every period of the force the neighbour is brought back to a small distance along the direction in which it left; the
!> exponent is the mean logarithm by which the distance grew (Benettin and others 1980).
!>
!> A motion that repeats, or one that settles to it, has an exponent of 0 or less; that of a motion which never repeats though its
!> force does is 0 where two frequencies without a common measure make it, and positive where it is irregular for good.
!>
!> The steps of the motion are recorded meanwhile, as those of a window are: what an irregular motion amounts to is known from
!> these periods, with the errors that its sums after each of them give.
module lyapunov
   use clock, only: wall_seconds
   use kinds, only: dp
   use problem, only: of_velocity
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

   !> Motions that are followed, each with a neighbour: what engine they go by is a matter of its own.
   type, abstract, public :: followed_motions_t
      !> Wall time after which no more period is begun [s]; by default there is no such time
      real(dp) :: ends_at = huge(1.0_dp)
   contains
      procedure(carry_motions), deferred :: carry
   end type followed_motions_t

   abstract interface
      !> Carry some motions and their neighbours through a period, and bring the neighbours back.
      subroutine carry_motions(self, left, period, growths, states, passed, paths)
         import :: dp, followed_motions_t, path_t
         class(followed_motions_t), intent(inout) :: self
         !> Which of them
         integer, intent(in) :: left(:)
         !> Its number; from the first one on the steps are recorded
         integer, intent(in) :: period
         !> Of each motion that passed: logarithm by which the distance of its neighbour grew [-]
         real(dp), intent(inout) :: growths(:)
         !> Films and velocities at the end of the period: number, motion
         real(dp), intent(inout) :: states(:, :)
         !> Whether a motion and what is beside it could be followed
         logical, intent(inout) :: passed(:)
         !> With the records
         type(path_t), intent(inout) :: paths(:)
      end subroutine carry_motions

      !> Whether a path shows enough of its motion, or should be followed on.
      pure logical function path_is_enough(path)
         import :: path_t
         type(path_t), intent(in) :: path
      end function path_is_enough
   end interface

   public :: follow_neighbours, parting_of, draws_near

contains

   !> Follow motions and their neighbours: until these draw near, or part for good and enough is known of the motion. After a signal to
   !> stop the answer is of no use.
   subroutine follow_neighbours(followed, is_enough, partings, paths)
      !> The motions with their neighbours
      class(followed_motions_t), intent(inout) :: followed
      procedure(path_is_enough) :: is_enough
      type(parting_t), intent(out) :: partings(:)
      !> Where the motions went that part for good
      type(path_t), intent(inout) :: paths(:)
      real(dp) :: growths(-turning_periods + 1:most_followed_periods, size(paths)), states(of_velocity, size(paths))
      real(dp), allocatable :: sums(:, :)
      logical :: passed(size(paths))
      integer, allocatable :: left(:)
      integer :: period, i

      allocate (left, source=[(i, i=1, size(paths))])
      do period = -turning_periods + 1, most_followed_periods
         if (size(left) == 0 .or. must_stop()) exit
         if (wall_seconds() > followed%ends_at) then
            do i = 1, size(left)
               if (partings(left(i))%for_good) partings(left(i)) = parting_of(growths(1:period - 1, left(i)))
               partings(left(i))%out_of_time = .not. partings(left(i))%for_good
            end do
            exit
         end if
         passed = .false.
         call followed%carry(left, period, growths(period, :), states, passed, paths)
         do i = 1, size(left)
            if (.not. passed(left(i))) partings(left(i))%for_good = .false.
         end do
         left = pack(left, passed(left))
         if (period < 1) cycle
         do i = 1, size(left)
            associate (place => left(i), path => paths(left(i)))
               if (period == 1) allocate (path%sums(size(sums_of_record(path%record)), 0:most_followed_periods), &
                                          path%states(of_velocity, most_followed_periods), source=0.0_dp)
               path%sums(:, period) = sums_of_record(path%record)
               path%states(:, period) = states(:, place)
               if (mod(period, stretch_periods) /= 0) cycle
               partings(place) = parting_of(growths(1:period, place))
               passed(place) = .not. draws_near(partings(place))
               if (partings(place)%for_good) passed(place) = .not. is_enough(path)
            end associate
         end do
         left = pack(left, passed(left))
      end do
      do i = 1, size(paths)
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

   !> What the growth of the distance over the periods says. An exponent counts as positive if it is so by two standard errors, in
   !> each half of the periods, and in the last stretch: a motion that settles meanwhile parts from its neighbour only before.
   pure type(parting_t) function parting_of(growths) result(parting)
      !> Logarithm of the growth in each period, of two blocks at least [-]
      real(dp), intent(in) :: growths(:)
      real(dp) :: blocks(size(growths)/block_periods)
      integer :: n

      n = size(growths)
      associate (whole => growths(n - block_periods*size(blocks) + 1:))
         blocks = sum(reshape(whole, [block_periods, size(blocks)]), dim=1)/real(block_periods, dp)
      end associate
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

end module lyapunov
