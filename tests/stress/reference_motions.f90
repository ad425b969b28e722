!> The motions that random starts of a gear scene lead to, by the steps of impact_steps: what the program reports of several motions
!> is compared with them. Nothing of the search of the program is used. A start is followed period by period until it has stayed on
!> a motion that an earlier start has come to, or repeats by itself.
module reference_motions
   use impact_steps, only: start_of_tooth, take_step, tooth_state_t, tooth_step_t, tooth_t
   use impact_window, only: impact_window_t, solve_impact_window
   use kinds, only: dp, int64
   use lobatto_rule, only: lobatto_rule_t
   use engine, only: state_of_start
   use motion_start, only: motion_start_t
   use problem, only: problem_t
   use random_walk, only: next_uniform, random_state_t
   implicit none(type, external)
   private

   !> Tolerance of the steps, which decides where starts lead.
   real(dp), parameter :: tolerance = 1.0e-4_dp
   !> Longest step, in periods of the highest order of the force, and most steps of a period.
   real(dp), parameter :: longest = 0.4_dp
   integer, parameter :: most_steps = 100000
   !> Most periods of a start, and longest period of a motion that is looked for [periods of the force].
   integer, parameter :: most_periods = 600, longest_period = 12
   !> Where so many starts do not repeat, the next ones are followed for `later_periods`; where no start repeats, no more than
   !> `most_unsettled` are followed.
   integer, parameter :: enough_unsettled = 3, later_periods = 300, most_unsettled = 16
   !> Distances at which a start has joined a known motion, at which its own periods repeat, and at which states are those of one
   !> motion, in units of gap and characteristic velocity [-].
   real(dp), parameter :: joined = 5.0e-3_dp, repeated = 2.0e-5_dp, alike = 1.0e-2_dp
   !> Periods that it has to stay there.
   integer, parameter :: stay = 3
   !> Periods over which a motion that does not repeat is measured.
   integer, parameter :: measured_periods = 20
   real(dp), parameter :: two_pi = 6.28318530717958647692_dp

   !> A motion that repeats.
   type, public :: reference_motion_t
      !> States at the starts of its periods of the force
      type(tooth_state_t), allocatable :: states(:)
      !> Starts that lead to it, and rms of z'' [m/s2]
      integer :: starts = 0
      real(dp) :: acceleration_rms = 0.0_dp
   end type reference_motion_t

   !> All that the starts lead to.
   type, public :: reference_motions_t
      type(reference_motion_t), allocatable :: motions(:)
      !> Starts that were followed, those of them that do not repeat, and those that could not be followed
      integer :: starts = 0, unsettled = 0, failed = 0
      !> Largest rms of z'' of those that do not repeat [m/s2]
      real(dp) :: unsettled_rms = 0.0_dp
      !> Periods solved
      integer :: periods = 0
   end type reference_motions_t

   public :: find_reference_motions, motion_from_state, is_same_motion

contains

   !> Follow random starts: films of the middle half of the gap, velocities within twice the characteristic one. A start ends on a
   !> motion that is given too, which these steps have to have stayed on; it counts if a start leads there.
   subroutine find_reference_motions(problem, tooth, rule, count, seed, number, given, found)
      !> What moves, for the film that a spring leaves at rest
      type(problem_t), intent(in) :: problem
      type(tooth_t), intent(in) :: tooth
      type(lobatto_rule_t), intent(in) :: rule
      !> How many
      integer, intent(in) :: count
      !> Any number, and the number of the scene
      integer(int64), intent(in) :: seed
      integer(int64), intent(in) :: number
      !> Motions that are known; those without states are none
      type(reference_motion_t), intent(in) :: given(:)
      type(reference_motions_t), intent(out) :: found
      integer(int64), parameter :: start_stream = 2_int64**47
      type(random_state_t) :: walk
      real(dp) :: film, velocity
      integer :: i, n

      walk = random_state_t(seed=seed, stream=start_stream + number)
      allocate (found%motions(0))
      do i = 1, size(given)
         if (.not. allocated(given(i)%states)) cycle
         if (.not. any([(is_same_motion(tooth, given(i), found%motions(n)), n=1, size(found%motions))])) &
            found%motions = [found%motions, given(i)]
      end do
      do i = 1, count
         if (found%unsettled >= most_unsettled .and. sum(found%motions%starts) == 0) exit
         found%starts = i
         call next_uniform(walk, film)
         call next_uniform(walk, velocity)
         call follow(tooth, rule, start_of_tooth(problem, state_of_start(problem, motion_start_t('random', &
            tooth%backlash*(0.25_dp + 0.5_dp*film), 2.0_dp*velocity_unit(tooth)*(2.0_dp*velocity - 1.0_dp))), 0.0_dp), found)
      end do
      found%motions = pack(found%motions, found%motions%starts > 0)
   end subroutine find_reference_motions

   !> Follow one start.
   subroutine follow(tooth, rule, start, found)
      type(tooth_t), intent(in) :: tooth
      type(lobatto_rule_t), intent(in) :: rule
      type(tooth_state_t), intent(in) :: start
      type(reference_motions_t), intent(inout) :: found
      type(tooth_state_t) :: past(0:most_periods), state
      type(impact_window_t) :: window
      integer :: n, most, period, place
      logical :: solved

      most = most_periods
      if (found%unsettled >= enough_unsettled) most = later_periods
      past(0) = start
      do n = 1, most
         past(n) = past(n - 1)
         call solve_period(tooth, rule, past(n), solved)
         found%periods = found%periods + 1
         if (.not. solved) then
            found%failed = found%failed + 1
            return
         end if
         if (n <= stay) cycle
         place = joined_motion(tooth, past(n - stay:n), found)
         if (place > 0) then
            found%motions(place)%starts = found%motions(place)%starts + 1
            return
         end if
         period = repeats_after(tooth, past(:n))
         if (period == 0) cycle
         call add_motion(tooth, rule, past(n), period, found)
         return
      end do
      found%unsettled = found%unsettled + 1
      state = past(most)
      call solve_impact_window(tooth, rule, tolerance, measured_periods, 1, state, window, solved)
      if (solved) found%unsettled_rms = max(found%unsettled_rms, sqrt(0.5_dp*window%power))
   end subroutine follow

   !> Solve a period.
   pure subroutine solve_period(tooth, rule, state, solved)
      type(tooth_t), intent(in) :: tooth
      type(lobatto_rule_t), intent(in) :: rule
      !> Carried on
      type(tooth_state_t), intent(inout) :: state
      logical, intent(out) :: solved
      type(tooth_step_t) :: step
      integer :: steps

      state%phase = 0.0_dp
      do steps = 1, most_steps
         call take_step(tooth, rule, tolerance, longest/real(size(tooth%amplitudes), dp), state, step, solved)
         if (.not. solved .or. state%phase >= 1.0_dp) return
      end do
      solved = .false.
   end subroutine solve_period

   !> A motion that repeats, from a state on it; one that has been met before gets one start more.
   subroutine add_motion(tooth, rule, state, period, found)
      type(tooth_t), intent(in) :: tooth
      type(lobatto_rule_t), intent(in) :: rule
      type(tooth_state_t), intent(in) :: state
      integer, intent(in) :: period
      type(reference_motions_t), intent(inout) :: found
      type(reference_motion_t) :: motion
      logical :: solved
      integer :: i

      call motion_from_state(tooth, rule, state, period, motion, solved)
      if (.not. solved) then
         found%failed = found%failed + 1
         return
      end if
      do i = 1, size(found%motions)
         if (.not. is_same_motion(tooth, motion, found%motions(i))) cycle
         found%motions(i)%starts = found%motions(i)%starts + 1
         return
      end do
      motion%starts = 1
      found%motions = [found%motions, motion]
   end subroutine add_motion

   !> States and rms of a motion of so many periods from a state on it.
   subroutine motion_from_state(tooth, rule, state, period, motion, solved)
      type(tooth_t), intent(in) :: tooth
      type(lobatto_rule_t), intent(in) :: rule
      type(tooth_state_t), intent(in) :: state
      integer, intent(in) :: period
      type(reference_motion_t), intent(out) :: motion
      !> Whether it could be followed
      logical, intent(out) :: solved
      type(tooth_state_t) :: moving
      type(impact_window_t) :: window

      moving = state
      call solve_impact_window(tooth, rule, tolerance, period, 1, moving, window, solved)
      if (.not. solved) return
      motion%states = window%states(1:period)
      motion%acceleration_rms = sqrt(0.5_dp*window%power)
   end subroutine motion_from_state

   !> The known motion that the last states have stayed on; 0: none.
   pure integer function joined_motion(tooth, past, found) result(place)
      type(tooth_t), intent(in) :: tooth
      !> The newest last
      type(tooth_state_t), intent(in) :: past(:)
      type(reference_motions_t), intent(in) :: found
      integer :: shift, i

      do place = 1, size(found%motions)
         associate (states => found%motions(place)%states)
            do shift = 0, size(states) - 1
               if (all([(distance(tooth, past(i), states(1 + modulo(i + shift, size(states)))) <= joined, &
                         i=1, size(past))])) return
            end do
         end associate
      end do
      place = 0
   end function joined_motion

   !> Periods after which the last states repeat, the fewest; 0: they do not.
   pure integer function repeats_after(tooth, past) result(period)
      type(tooth_t), intent(in) :: tooth
      !> The newest last
      type(tooth_state_t), intent(in) :: past(:)
      integer :: i, n

      n = size(past)
      do period = 1, longest_period
         if (n - period - 2*longest_period < 1) exit
         if (all([(distance(tooth, past(n - i), past(n - i - period)) <= repeated, i=0, 2*longest_period)])) return
      end do
      period = 0
   end function repeats_after

   !> Whether two motions pass through the same states.
   pure logical function is_same_motion(tooth, one, other, within) result(same)
      type(tooth_t), intent(in) :: tooth
      type(reference_motion_t), intent(in) :: one
      type(reference_motion_t), intent(in) :: other
      !> Distance of states that count as one, `alike` unless given [-]
      real(dp), intent(in), optional :: within
      real(dp) :: limit
      integer :: shift, i, n

      limit = alike
      if (present(within)) limit = within
      ! A multiple of the shortest period is the same motion, too.
      n = max(size(one%states), size(other%states))
      do shift = 0, size(other%states) - 1
         same = all([(distance(tooth, one%states(1 + modulo(i, size(one%states))), &
                               other%states(1 + modulo(i + shift, size(other%states)))) <= limit, i=1, n)])
         if (same) return
      end do
   end function is_same_motion

   !> Distance of two states in units of gap and characteristic velocity [-].
   pure real(dp) function distance(tooth, one, other)
      type(tooth_t), intent(in) :: tooth
      type(tooth_state_t), intent(in) :: one
      type(tooth_state_t), intent(in) :: other

      distance = max(abs(one%film - other%film)/tooth%backlash, abs(one%velocity - other%velocity)/velocity_unit(tooth), &
                     maxval(abs(one%compression - other%compression))/tooth%backlash)
   end function distance

   !> Velocity that the orders of the force give a free mass, sum of F_k/(m k omega) [m/s].
   pure real(dp) function velocity_unit(tooth) result(unit)
      type(tooth_t), intent(in) :: tooth
      integer :: k

      unit = sum([(tooth%amplitudes(k)/real(k, dp), k=1, size(tooth%amplitudes))])/(two_pi*tooth%frequency*tooth%mass)
   end function velocity_unit

end module reference_motions
