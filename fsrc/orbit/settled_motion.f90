!> Motions that repeat, and which of them are the same: a motion of several periods may be met in any of them.
module settled_motion
   use kinds, only: dp
   use known_motions, only: are_near, known_motions_t
   use motion_start, only: characteristic_velocity, gap_of_starts
   use problem, only: problem_t
   implicit none(type, external)
   private

   !> Share of the gap by which films, and of the characteristic velocity by which velocities of one motion may differ [-].
   real(dp), parameter, public :: same_state = 0.01_dp
   !> Relative difference of the acceleration rms up to which motions are the same, and where one of a part of a period is compared [-].
   real(dp), parameter :: same_rms = 0.05_dp, rough_rms = 0.25_dp

   !> A motion that repeats.
   type, public :: settled_motion_t
      !> Periods of the force after which it repeats; 0: it does not
      integer :: period = 0
      !> Numbers of its state, period: at the start of each period of the force
      real(dp), allocatable :: states(:, :)
      !> [m/s2]
      real(dp) :: acceleration_rms = 0.0_dp
      !> Whether that is of a window which is no multiple of the period
      logical :: rms_is_rough = .false.
      !> Films and velocities at the ends of many periods of an irregular one: number, period; not allocated: they are not known
      real(dp), allocatable :: path(:, :)
   end type settled_motion_t

   public :: same_motion, known_of, near_states

contains

   !> Whether two motions of a problem are the same: from some period on they have the same states, and they shake as much. One may
   !> have been seen to repeat after a part of the period of the other: next to a doubling of the period its states differ by less
   !> than those that count as one, and so each of them from one of the other by at most twice that.
   pure logical function same_motion(problem, one, other) result(same)
      type(problem_t), intent(in) :: problem
      type(settled_motion_t), intent(in) :: one
      type(settled_motion_t), intent(in) :: other
      type(known_motions_t) :: measure
      real(dp) :: limit
      integer :: longer, shift, i

      same = .false.
      if (one%period == 0 .or. other%period == 0) return
      longer = max(one%period, other%period)
      if (modulo(longer, min(one%period, other%period)) /= 0) return
      limit = merge(rough_rms, same_rms, one%rms_is_rough .or. other%rms_is_rough)
      if (abs(one%acceleration_rms - other%acceleration_rms) > limit*max(one%acceleration_rms, other%acceleration_rms)) return
      measure = near_states(problem)
      if (one%period /= other%period) then
         measure%near_film = 2.0_dp*measure%near_film
         measure%near_velocity = 2.0_dp*measure%near_velocity
      end if
      do shift = 0, longer - 1
         same = all([(are_near(problem, measure, one%states(:, modulo(i - 1, one%period) + 1), &
                               other%states(:, modulo(i - 1 + shift, other%period) + 1)), i=1, longer)])
         if (same) return
      end do
   end function same_motion

   !> What counts as near of a problem, and the motions that are known of it, each at its place.
   pure type(known_motions_t) function known_of(problem, settled) result(known)
      type(problem_t), intent(in) :: problem
      !> Those that do not repeat are reached by no state, irregular ones by many
      type(settled_motion_t), intent(in) :: settled(:)
      integer :: i

      known = near_states(problem)
      allocate (known%motions(size(settled)))
      do i = 1, size(settled)
         known%motions(i)%states = settled(i)%states(:, :settled(i)%period)
         if (allocated(settled(i)%path)) known%motions(i)%path = settled(i)%path
      end do
   end function known_of

   !> What counts as near of a problem.
   pure type(known_motions_t) function near_states(problem) result(measure)
      type(problem_t), intent(in) :: problem

      measure%near_film = same_state*gap_of_starts(problem)
      measure%near_velocity = same_state*characteristic_velocity(problem)
   end function near_states

end module settled_motion
