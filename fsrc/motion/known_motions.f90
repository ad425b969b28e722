!> Motions that are known of a problem: periodic ones, and the irregular one. A motion from another start that has come to one of
!> them need not be followed any further. Which of them are the same: one of several periods may be met in any of them.
module known_motions
   use kinds, only: dp
   use motion_start, only: characteristic_velocity, gap_of_starts
   use problem, only: moving_numbers, of_velocity, problem_t
   implicit none(type, external)
   private

   !> A motion by its states.
   type, public :: known_motion_t
      !> States at the starts of its periods of the force, one after the other: number of the state, period; none: it does not repeat
      real(dp), allocatable :: states(:, :)
      !> Films and velocities at the ends of many periods of an irregular one: number, period; not allocated: they are not known
      real(dp), allocatable :: path(:, :)
   end type known_motion_t

   !> What is known of the motions of a problem that others come to.
   type, public :: known_motions_t
      type(known_motion_t), allocatable :: motions(:)
      !> Largest differences of films and compressions [m] and of velocities [m/s] of states that count as one
      real(dp) :: near_film = 0.0_dp
      real(dp) :: near_velocity = 0.0_dp
   end type known_motions_t

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

   !> Share of the gap by which films, and of the characteristic velocity by which velocities of one motion may differ [-].
   real(dp), parameter, public :: same_state = 0.01_dp
   !> Relative difference of the acceleration rms up to which motions are the same, and where one of a part of a period is compared [-].
   real(dp), parameter, public :: same_rms = 0.05_dp, rough_rms = 0.25_dp

   !> Distance that one of a hundred pairs of samples of one distribution exceeds, in units of sqrt(1/n + 1/m).
   real(dp), parameter :: rare_distance = 1.63_dp

   !> Periods after which a start that does not repeat is compared with a known irregular motion, and by how many of the last ones.
   integer, parameter, public :: compared_after = 32, compared_periods = 24

   public :: reached_motion, joined_irregular, are_near, are_of_one_motion, distance_of, same_motion, known_of, near_states

contains

   !> The known motion that two successive states both belong to, one period apart; 0: none, or several that near each other.
   pure integer function reached_motion(problem, known, older, newer) result(reached)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> What is known of it
      type(known_motions_t), intent(in) :: known
      !> Numbers of the states at the starts of two successive periods
      real(dp), intent(in) :: older(:)
      real(dp), intent(in) :: newer(:)
      integer :: place, next, period

      reached = 0
      if (.not. allocated(known%motions)) return
      do place = 1, size(known%motions)
         associate (states => known%motions(place)%states)
            do period = 1, size(states, 2)
               next = modulo(period, size(states, 2)) + 1
               if (.not. are_near(problem, known, older, states(:, period))) cycle
               if (.not. are_near(problem, known, newer, states(:, next))) cycle
               if (reached > 0 .and. reached /= place) then
                  reached = 0
                  return
               end if
               reached = place
            end do
         end associate
      end do
   end function reached_motion

   !> The known irregular motion that the last periods of another motion are like; 0: none.
   pure integer function joined_irregular(known, path) result(joined)
      type(known_motions_t), intent(in) :: known
      !> Films and velocities at the ends of its periods: number, period
      real(dp), intent(in) :: path(:, :)

      do joined = 1, size(known%motions)
         if (.not. allocated(known%motions(joined)%path)) cycle
         if (are_of_one_motion(path(:, max(1, size(path, 2) - compared_periods + 1):), known%motions(joined)%path)) return
      end do
      joined = 0
   end function joined_irregular

   !> Whether the states at the ends of periods of two motions that do not repeat may be those of one: by the distance of Kolmogorov
   !> and Smirnov between the distributions of their films and of their velocities.
   pure logical function are_of_one_motion(one, other)
      !> Number of a state, such as film and velocity; period
      real(dp), intent(in) :: one(:, :)
      real(dp), intent(in) :: other(:, :)
      real(dp) :: limit
      integer :: i

      limit = rare_distance*sqrt(1.0_dp/real(size(one, 2), dp) + 1.0_dp/real(size(other, 2), dp))
      are_of_one_motion = all([(largest_distance(one(i, :), other(i, :)) <= limit, i=1, size(one, 1))])
   end function are_of_one_motion

   !> Largest difference of the shares of two samples that are not above a value [-].
   pure real(dp) function largest_distance(one, other) result(distance)
      real(dp), intent(in) :: one(:)
      real(dp), intent(in) :: other(:)
      real(dp) :: values(size(one) + size(other))
      integer :: i

      values = [one, other]
      distance = maxval([(abs(real(count(one <= values(i)), dp)/real(size(one), dp) - &
                              real(count(other <= values(i)), dp)/real(size(other), dp)), i=1, size(values))])
   end function largest_distance

   !> Whether two states count as one by how gear and teeth stand and move; states of films follow these.
   pure logical function are_near(problem, known, one, other)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> What counts as near
      type(known_motions_t), intent(in) :: known
      !> Numbers of the states
      real(dp), intent(in) :: one(:)
      real(dp), intent(in) :: other(:)
      integer :: n

      n = moving_numbers(problem)
      are_near = all(abs(one(:n) - other(:n)) <= near_of(problem, known))
   end function are_near

   !> Distance of two states by how gear and teeth stand and move, in units of what counts as near [-].
   pure real(dp) function distance_of(problem, known, one, other) result(distance)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> What counts as near
      type(known_motions_t), intent(in) :: known
      !> Numbers of the states
      real(dp), intent(in) :: one(:)
      real(dp), intent(in) :: other(:)
      integer :: n

      n = moving_numbers(problem)
      distance = maxval(abs(one(:n) - other(:n))/near_of(problem, known))
   end function distance_of

   !> What counts as near of each number that moves.
   pure function near_of(problem, known) result(near)
      type(problem_t), intent(in) :: problem
      type(known_motions_t), intent(in) :: known
      real(dp) :: near(moving_numbers(problem))

      near = known%near_film
      near(of_velocity) = known%near_velocity
   end function near_of

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

end module known_motions
