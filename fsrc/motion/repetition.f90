!> Does a motion repeat? It is looked for in five ways, each for a purpose of its own (fsrc/THEORY.md, section 7):
!>
!>    to the last bit        this module, `look_back`: the periods in between come again for ever and need not be computed;
!>    within the accuracy    this module, `note_state`: a run until steady ends, with a bound of what the motion is still away;
!>    in some periods        module lane_repetition, `forecast_rest`: a campaign jumps to where a slow motion will come to rest;
!>    if it were followed    module periodic_orbit: Newton's method on the period map, for multipliers and for the verification;
!>    by films in nodes      module nodal_engine, `orbit_of`: within the tolerance of its steps, which is far above rounding.
!>
!> A small step alone proves nothing: a film that rises ever more slowly has a ratio of steps near one, and its bound stays large.
module repetition
   use kinds, only: dp, int64
   use problem, only: of_film, of_velocity, settling_t
   use taylor_step_control, only: film_weight
   implicit none(type, external)
   private

   !> Longest period that is looked for [periods of the force]
   integer, parameter, public :: longest_orbit = 8

   !> Four orbits: three distances, two ratios.
   integer, parameter, public :: kept_states = 4*longest_orbit
   !> Longer orbits are looked for from here on, and then now and again: most motions do not have them.
   integer, parameter :: longer_from = 12
   integer, parameter, public :: longer_every = 4
   !> Ratio above which the bound is not trusted.
   real(dp), parameter :: largest_ratio = 0.99_dp

   !> Distance that is rounding alone.
   real(dp), parameter :: rounding = 32.0_dp*epsilon(1.0_dp)

   !> Last states of a motion, scaled, the newest at `newest`.
   type, public :: orbit_watch_t
      integer :: count = 0
      integer :: newest = 0
      !> Number of the state, place; without a state there is none [-]
      real(dp), allocatable :: states(:, :)
      !> Thinnest film of each [-]
      real(dp) :: thinnest(0:kept_states - 1) = 0.0_dp
   end type orbit_watch_t

   !> A film that settles at a lower rate does so slowly [1/periods].
   real(dp), parameter :: slow_rate = 0.7_dp

   !> Periods after which the marks are set anew; the last one stays as long as all that came before it.
   integer, parameter :: mark_periods(4) = [1, 4, 16, 64]

   !> What a motion looks back on: states at the starts of some periods.
   type, public :: recurrence_t
      private
      !> Period of each mark, -1: it is not set; and the steps up to there
      integer :: periods(size(mark_periods)) = -1
      integer(int64) :: steps(size(mark_periods)) = 0_int64
      !> Bits of the scaled states: number, mark
      integer(int64), allocatable :: states(:, :)
   end type recurrence_t

   public :: start_watch, note_state, weight_of_film, state_of_age, look_back

contains

   !> Watcher of a motion that starts from a state.
   pure subroutine start_watch(state, thinnest, watch)
      !> Scaled [-]
      real(dp), intent(in) :: state(:)
      !> Its thinnest film [-]
      real(dp), intent(in) :: thinnest
      type(orbit_watch_t), intent(out) :: watch

      watch%count = 1
      call keep(state, thinnest, watch)
   end subroutine start_watch

   !> Put a state into its place.
   pure subroutine keep(state, thinnest, watch)
      real(dp), intent(in) :: state(:)
      real(dp), intent(in) :: thinnest
      type(orbit_watch_t), intent(inout) :: watch

      if (.not. allocated(watch%states)) allocate (watch%states(size(state), 0:kept_states - 1), source=0.0_dp)
      watch%states(:, watch%newest) = state
      watch%thinnest(watch%newest) = thinnest
   end subroutine keep

   !> Scaled film and velocity of some periods ago, at most `count` - 1 and `kept_states` - 1.
   pure function state_of_age(watch, age) result(state)
      !> Watcher of a motion
      type(orbit_watch_t), intent(in) :: watch
      !> Periods since then
      integer, intent(in) :: age
      real(dp) :: state(2)

      state = watch%states([of_film, of_velocity], modulo(watch%newest - age, kept_states))
   end function state_of_age

   !> Film error that counted as one some periods ago: that of the thinner film of both flanks [-].
   pure real(dp) function weight_of_film(watch, age)
      type(orbit_watch_t), intent(in) :: watch
      !> Periods since then
      integer, intent(in) :: age

      weight_of_film = film_weight(watch%thinnest(modulo(watch%newest - age, kept_states)))
   end function weight_of_film

   !> Take the state at the end of a period.
   pure subroutine note_state(watch, state, thinnest, weights, settling, tolerance, orbit, distance)
      !> Watcher of this motion
      type(orbit_watch_t), intent(inout) :: watch
      !> Scaled [-]
      real(dp), intent(in) :: state(:)
      !> Its thinnest film [-]
      real(dp), intent(in) :: thinnest
      !> Film that one of each number counts as [-]
      real(dp), intent(in) :: weights(:)
      !> How the film settles by its law
      type(settling_t), intent(in) :: settling
      !> Distance from the repeating motion that is small enough [-]
      real(dp), intent(in) :: tolerance
      !> Periods after which the motion repeats, 0 as long as that is not known
      integer, intent(out) :: orbit
      !> Bound of the distance from the motion that repeats, where there is one [-]
      real(dp), intent(out) :: distance
      integer :: last, periods

      watch%newest = modulo(watch%newest + 1, kept_states)
      call keep(state, thinnest, watch)
      watch%count = watch%count + 1
      last = 1
      if (watch%count >= longer_from .and. modulo(watch%count, longer_every) == 0) last = longest_orbit
      distance = huge(distance)
      orbit = 0
      do periods = 1, last
         if (watch%count < 4*periods) exit
         if (settling%rate < slow_rate) then
            distance = creeping_distance(watch, periods, settling)
         else
            distance = orbit_distance(watch, periods, weights, tolerance)
         end if
         if (distance > tolerance) cycle
         orbit = periods
         call shorten(watch, weights, tolerance, orbit)
         return
      end do
   end subroutine note_state

   !> A motion that repeats after p periods may do so sooner: a spiral whose turn is near 360/p degrees is back after p of
   !> them first. States that are within the tolerance of one point are within twice it of each other, the older ones a
   !> little more: those that are have the shorter orbit.
   pure subroutine shorten(watch, weights, tolerance, orbit)
      type(orbit_watch_t), intent(in) :: watch
      real(dp), intent(in) :: weights(:)
      real(dp), intent(in) :: tolerance
      !> Periods after which the motion repeats
      integer, intent(inout) :: orbit
      integer :: shorter

      do shorter = 1, orbit - 1
         if (modulo(orbit, shorter) /= 0) cycle
         if (cycle_distance(watch, shorter, 0, weights) > 3.0_dp*tolerance) cycle
         orbit = shorter
         return
      end do
   end subroutine shorten

   !> Distance from a motion that repeats after `orbit` periods where the film settles slowly: the largest of three, lest one is
   !> small by chance.
   pure real(dp) function creeping_distance(watch, orbit, settling)
      type(orbit_watch_t), intent(in) :: watch
      integer, intent(in) :: orbit
      !> How the film settles by its law
      type(settling_t), intent(in) :: settling
      real(dp) :: step(2), newer(2), older(2), stiffness
      integer :: age

      creeping_distance = huge(1.0_dp)
      stiffness = settling%stiffness*real(orbit, dp)
      if (.not. stiffness > 0.0_dp) return
      creeping_distance = 0.0_dp
      newer = state_of_age(watch, 0)
      do age = 1, 3
         older = state_of_age(watch, age*orbit)
         step = max(abs(newer - older), rounding*abs(newer))*sign(1.0_dp, newer - older)
         creeping_distance = max(creeping_distance, abs(step(2) + settling%damping*step(1))/stiffness, abs(step(1))/sqrt(stiffness))
         newer = older
      end do
      creeping_distance = creeping_distance/weight_of_film(watch, 3*orbit)
   end function creeping_distance

   !> Bound of the distance from a motion that repeats after `orbit` periods, huge where there is none.
   pure real(dp) function orbit_distance(watch, orbit, weights, tolerance)
      type(orbit_watch_t), intent(in) :: watch
      integer, intent(in) :: orbit
      !> Film that one of each number counts as [-]
      real(dp), intent(in) :: weights(:)
      !> Distance that is small enough [-]
      real(dp), intent(in) :: tolerance
      !> Ratio below which a motion settles fast enough for two ratios to do
      real(dp), parameter :: fast = 0.1_dp
      real(dp) :: last, newer, older, ratio
      integer :: age

      orbit_distance = huge(1.0_dp)
      ratio = 0.0_dp
      last = cycle_distance(watch, orbit, 0, weights)
      ! The map has no memory: a state met again to the last bit comes again for ever.
      if (last <= rounding) orbit_distance = last
      if (last <= rounding) return
      newer = last
      do age = 1, merge(3, 2, orbit == 1)
         if (age == 3 .and. ratio < fast) exit
         if (age == 3 .and. watch%count < 5) return
         older = cycle_distance(watch, orbit, age, weights)
         if (newer >= largest_ratio*older) return
         ratio = max(ratio, newer/older)
         newer = older
      end do
      orbit_distance = max(last*ratio/(1.0_dp - ratio), distance_across(watch, orbit, weights, tolerance, ratio))
   end function orbit_distance

   !> Bound of the distance in the direction along which the motion does not settle by the ratio of its distances, huge where
   !> there is none.
   pure real(dp) function distance_across(watch, orbit, weights, tolerance, ratio)
      type(orbit_watch_t), intent(in) :: watch
      integer, intent(in) :: orbit
      !> Film that one of each number counts as [-]
      real(dp), intent(in) :: weights(:)
      !> Distance that is small enough [-]
      real(dp), intent(in) :: tolerance
      !> Of the distances
      real(dp), intent(in) :: ratio
      !> Share of the tolerance that the errors of the states leave across
      real(dp), parameter :: negligible = 0.3_dp
      real(dp) :: states(2, 0:3), a(2), b(2), c(2), area, older_area, across, other

      states(:, 0) = state_of_age(watch, 0)
      states(:, 1) = state_of_age(watch, orbit)
      states(:, 2) = state_of_age(watch, 2*orbit)
      states(:, 3) = state_of_age(watch, 3*orbit)
      states(2, :) = states(2, :)*weights(of_velocity)
      states = states/weight_of_film(watch, 0)
      a = states(:, 2) - states(:, 3)
      b = states(:, 1) - states(:, 2)
      c = states(:, 0) - states(:, 1)
      distance_across = 0.0_dp
      area = abs(b(1)*c(2) - b(2)*c(1))
      if (area <= negligible*tolerance*norm2(b)) return
      across = area/norm2(b)
      older_area = abs(a(1)*b(2) - a(2)*b(1))
      distance_across = huge(1.0_dp)
      if (area >= largest_ratio*ratio*older_area) return
      other = area/(ratio*older_area)
      distance_across = across*other/(1.0_dp - other)
   end function distance_across

   !> Largest distance of the states of an orbit, `age` orbits back, from those one orbit before.
   pure real(dp) function cycle_distance(watch, orbit, age, weights)
      type(orbit_watch_t), intent(in) :: watch
      integer, intent(in) :: orbit
      integer, intent(in) :: age
      real(dp), intent(in) :: weights(:)
      integer :: back

      cycle_distance = 0.0_dp
      do back = age*orbit, (age + 1)*orbit - 1
         cycle_distance = max(cycle_distance, apart(watch, back, back + orbit, weights))
      end do
   end function cycle_distance

   !> Distance of two states, in the measure of the step control.
   pure real(dp) function apart(watch, back_1, back_2, weights)
      type(orbit_watch_t), intent(in) :: watch
      !> How many periods they lie back
      integer, intent(in) :: back_1
      integer, intent(in) :: back_2
      real(dp), intent(in) :: weights(:)
      integer :: i, j

      i = modulo(watch%newest - back_1, kept_states)
      j = modulo(watch%newest - back_2, kept_states)
      apart = maxval(abs(watch%states(:, i) - watch%states(:, j))*weights)/weight_of_film(watch, back_1)
   end function apart

   !> Compare the state at the start of a period with earlier ones, and keep it.
   pure subroutine look_back(past, period, state, steps, cycle_periods, cycle_steps)
      !> What the motion looks back on
      type(recurrence_t), intent(inout) :: past
      !> Periods done
      integer, intent(in) :: period
      !> Scaled [-]
      real(dp), intent(in) :: state(:)
      !> Steps up to here
      integer(int64), intent(in) :: steps
      !> Periods since the motion was in this very state, 0: it is new
      integer, intent(out) :: cycle_periods
      !> Steps since then
      integer(int64), intent(out) :: cycle_steps
      integer :: i, stays

      if (.not. allocated(past%states)) allocate (past%states(size(state), size(mark_periods)), source=0_int64)
      cycle_periods = 0
      cycle_steps = 0_int64
      do i = size(mark_periods), 1, -1
         if (past%periods(i) >= 0 .and. all(bits_of(state) == past%states(:, i))) then
            cycle_periods = period - past%periods(i)
            cycle_steps = steps - past%steps(i)
         end if
         stays = mark_periods(i)
         if (i == size(mark_periods)) stays = max(stays, past%periods(i))
         if (past%periods(i) >= 0 .and. period - past%periods(i) < stays) cycle
         past%periods(i) = period
         past%steps(i) = steps
         past%states(:, i) = bits_of(state)
      end do
   end subroutine look_back

   !> The bits of a number, so that no array has to be made for them.
   elemental integer(int64) function bits_of(number)
      real(dp), intent(in) :: number

      bits_of = transfer(number, 0_int64)
   end function bits_of

end module repetition
