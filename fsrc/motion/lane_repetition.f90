!> Whether the motion of a lane repeats, looked for at the end of every period: within the accuracy, so that a run until steady
!> ends; to the last bit, so that nothing more has to be computed; and where a motion that settles slowly will come to rest.
!>
!> The forecast is an extrapolation of three successive differences (fsrc/THEORY.md, section 7); where they are parallel, because
!> the motion forgets all but one direction at once, one ratio does (Aitken). It costs no period more.
!>
!> A forecast is no proof: the motion goes on from there, and repeats or not by its own states (module repetition); if not, it goes
!> back to where it was. A forecast is made only where it is safe: multipliers inside the unit circle, the same in two successive
!> estimates, and a place that is near. So a motion that leaves an unstable one is not led back to it.
module lane_repetition
   use engine, only: last_search_period, motion_state_t, request_t
   use kinds, only: dp, int64
   use known_motions, only: compared_after, joined_irregular, known_motions_t, reached_motion
   use lane_run, only: departure_t, lane_run_t, lane_watch_t
   use lane_sampling, only: repeat_samples
   use lane_state, only: films_of_lane, place_state, state_of_lane, thinner_scaled_film
   use problem, only: films_near_rest, of_film, of_velocity, problem_t, settling_of, settling_t
   use repetition, only: longer_every, longest_orbit, look_back, note_state, orbit_watch_t, recurrence_t, start_watch, &
      state_of_age, weight_of_film
   use scene_status, only: status_steady
   use taylor_step_control, only: lienard_weight
   implicit none(type, external)
   private

   !> Every so many periods a motion is compared with an irregular one that is known.
   integer, parameter :: compared_every = 4
   !> Share of the accuracy within which a motion counts as repeating.
   real(dp), parameter :: repetition_share = 0.3_dp

   !> Excursions to where a motion is forecast to settle, forecasts in one of them, and periods since the last one, once
   !> and for every period of the orbit, after which it has failed: more of them show that the motion does not settle.
   integer, parameter :: most_excursions = 3, most_forecasts = 6, excursion_once = 6, excursion_per_period = 5

   !> Largest multiplier below which the motion settles fast enough by itself, and beyond which it may not settle at all.
   real(dp), parameter :: fast = 0.3_dp, slowest = 0.997_dp
   !> Largest difference of the states, relative to the film, that counts as near.
   real(dp), parameter :: near = 0.1_dp
   !> How far two estimates of a multiplier may differ, in units of its distance from 1.
   real(dp), parameter :: agreement = 0.2_dp
   !> Sine of the angle below which two differences are parallel.
   real(dp), parameter :: parallel = 0.02_dp

   public :: find_repetition, look_for_known, restore_departure, forecast_rest

contains

   !> Look for repetition at the end of a period.
   pure subroutine find_repetition(lane, problem, states, run)
      integer, intent(in) :: lane
      type(problem_t), intent(in) :: problem
      !> Samples: sample, number of its state, scene
      real(dp), contiguous, intent(inout) :: states(:, :, :)
      !> The block, its period counted and its state that of the period's end
      type(lane_run_t), intent(inout) :: run
      real(dp) :: weight, distance
      integer :: orbit

      associate (watch => run%watches(lane), block => run%block, request => run%request)
         if (is_searching(watch, request)) then
            weight = lienard_weight(thinner_scaled_film(watch%state, lane, block), block%damping_rate(lane), block%force(lane))
            watch%weights(of_velocity) = weight
            call note_state(watch%states, watch%state, thinner_scaled_film(watch%state, lane, block), watch%weights, &
                            settling_of_lane(lane, problem, run), repetition_share*request%accuracy, orbit, distance)
            if (orbit > 0) then
               watch%ending%orbit = orbit
               watch%ending%distance = distance
               watch%ending%status = status_steady
               watch%sample_from = watch%period
               watch%last_period = watch%period + merge(orbit, 0, request%sampled_periods > 0)
            else if (request%forecast .and. .not. run%own_numbers) then
               call look_ahead(weight, lane, last_search_period(request%periods, request%sampled_periods), run)
            end if
         else if (.not. request%every_period) then
            call skip_returns(lane, states, run)
         end if
      end associate
   end subroutine find_repetition

   !> Look whether the motion has come to one that is known. It is then that motion, and goes no further. An excursion, which did
   !> not start where the motion did, is no witness.
   pure subroutine look_for_known(lane, problem, known, run)
      integer, intent(in) :: lane
      type(problem_t), intent(in) :: problem
      !> What is known of it
      type(known_motions_t), intent(in) :: known
      !> The block, its period counted and its state that of the period's end
      type(lane_run_t), intent(inout) :: run
      type(motion_state_t) :: here
      integer :: periods, i

      associate (watch => run%watches(lane))
         if (.not. is_searching(watch, run%request) .or. watch%departure%period > 0 .or. .not. allocated(known%motions)) return
         here = state_of_lane(lane, run%block, run%inner(lane))
         if (allocated(watch%earlier)) watch%ending%known = reached_motion(problem, known, watch%earlier, here%numbers)
         if (any([(allocated(known%motions(i)%path), i=1, size(known%motions))])) then
            if (.not. allocated(watch%path)) allocate (watch%path(of_velocity, 0))
            periods = size(watch%path, 2) + 1
            watch%path = reshape([watch%path, here%numbers([of_film, of_velocity])], [of_velocity, periods])
            if (watch%ending%known == 0 .and. periods >= compared_after .and. modulo(periods, compared_every) == 0) &
               watch%ending%known = joined_irregular(known, watch%path)
         end if
         call move_alloc(here%numbers, watch%earlier)
         if (watch%ending%known == 0) return
         watch%ending%orbit = size(known%motions(watch%ending%known)%states, 2)
         watch%ending%status = status_steady
         watch%sample_from = watch%period
         watch%last_period = watch%period
      end associate
   end subroutine look_for_known

   !> Whether it is still to be found that a motion repeats. A run without samples is one to be carried on: there the last state
   !> counts like the others.
   pure logical function is_searching(watch, request)
      type(lane_watch_t), intent(in) :: watch
      type(request_t), intent(in) :: request

      is_searching = request%until_steady .and. watch%ending%orbit == 0
      if (request%sampled_periods > 0) is_searching = &
         is_searching .and. watch%period <= last_search_period(request%periods, request%sampled_periods)
   end function is_searching

   !> How the film of a lane settles from where it is.
   pure type(settling_t) function settling_of_lane(lane, problem, run)
      integer, intent(in) :: lane
      type(problem_t), intent(in) :: problem
      type(lane_run_t), intent(in) :: run

      associate (block => run%block)
         settling_of_lane = settling_of(problem, films_of_lane(run%watches(lane)%state, lane, block)*block%film_scale(lane), &
                                        films_near_rest(problem, block%film_scale(lane)))
         ! Lienard's variable holds the damping.
         if (block%slip(lane) > 0.0_dp) settling_of_lane%damping = 0.0_dp
      end associate
   end function settling_of_lane

   !> Skip the periods in which the motion only returns to the state it is in, to the last bit: whole cycles up to where
   !> sampling begins, and at the end those whose samples are the ones of the cycle before. Their steps count like the others.
   pure subroutine skip_returns(lane, states, run)
      integer, intent(in) :: lane
      real(dp), contiguous, intent(inout) :: states(:, :, :)
      type(lane_run_t), intent(inout) :: run
      integer(int64) :: cycle_steps
      integer :: cycle_periods, cycles

      associate (watch => run%watches(lane))
         call look_back(watch%past, merge(watch%period - watch%sample_from, watch%period, watch%period > watch%sample_from), &
                        watch%state, watch%ending%count%steps, cycle_periods, cycle_steps)
         if (cycle_periods == 0) return
         cycles = 0
         if (watch%period < watch%sample_from) then
            cycles = (watch%sample_from - watch%period)/cycle_periods
         else if (watch%period - cycle_periods >= watch%sample_from) then
            cycles = (watch%last_period - watch%period)/cycle_periods
            call repeat_samples(cycle_periods, cycles, lane, run%samples, states)
         end if
         if (cycles == 0) return
         watch%period = watch%period + cycles*cycle_periods
         watch%ending%count%steps = watch%ending%count%steps + int(cycles, int64)*cycle_steps
         if (watch%period < watch%sample_from) watch%past = recurrence_t()
      end associate
   end subroutine skip_returns

   !> Jump to where the motion is forecast to settle, or restore the saved state if the jump failed. So a motion that does not
   !> repeat is the one that follows from its start, to the last bit.
   pure subroutine look_ahead(weight, lane, last, run)
      !> Film that a Lienard variable of one counts as [-]
      real(dp), intent(in) :: weight
      integer, intent(in) :: lane
      !> Last period after which repetition may be found
      integer, intent(in) :: last
      type(lane_run_t), intent(inout) :: run
      real(dp) :: rest(2)
      real(dp), allocatable :: state(:)
      integer :: orbit, back_at

      associate (watch => run%watches(lane))
         if (watch%departure%period == 0) then
            if (watch%excursions == most_excursions) return
            watch%forecasts = 0
         end if
         orbit = 0
         if (watch%forecasts < most_forecasts) call forecast_rest(watch%states, weight, run%block%backlash(lane), orbit, rest)
         back_at = watch%period + excursion_once + excursion_per_period*orbit
         if (orbit > 0 .and. back_at <= last) then
            if (watch%departure%period == 0) then
               watch%excursions = watch%excursions + 1
               watch%departure = departure_t(watch%period, watch%state, watch%states)
            end if
            watch%back_at = back_at
            watch%forecasts = watch%forecasts + 1
            state = watch%state
            state(of_film) = rest(1)
            state(of_velocity) = rest(2)
            call start_watch(state, thinner_scaled_film(state, lane, run%block), watch%states)
            call place(state, lane, run)
         else if (watch%departure%period > 0 .and. watch%period >= watch%back_at) then
            call restore_departure(lane, run)
         end if
      end associate
   end subroutine look_ahead

   !> Restore the state from which the motion jumped.
   pure subroutine restore_departure(lane, run)
      integer, intent(in) :: lane
      type(lane_run_t), intent(inout) :: run

      associate (watch => run%watches(lane))
         watch%period = watch%departure%period
         watch%states = watch%departure%states
         watch%departure%period = 0
         call place(watch%departure%state, lane, run)
      end associate
   end subroutine restore_departure

   !> Let a period start from a state.
   pure subroutine place(state, lane, run)
      !> Scaled [-]
      real(dp), intent(in) :: state(:)
      integer, intent(in) :: lane
      type(lane_run_t), intent(inout) :: run

      call place_state(state, lane, run%block, run%inner(lane))
      run%watches(lane)%state = state
   end subroutine place

   !> The state in which the motion will come to rest.
   pure subroutine forecast_rest(watch, lienard_weight, backlash, orbit, place)
      !> The last states of the motion
      type(orbit_watch_t), intent(in) :: watch
      !> Film that a Lienard variable of one counts as [-]
      real(dp), intent(in) :: lienard_weight
      !> Scaled backlash, huge where there is one flank [-]
      real(dp), intent(in) :: backlash
      !> Periods after which it will repeat; 0: there is no forecast to be trusted
      integer, intent(out) :: orbit
      !> Scaled film H and Lienard variable V there [-]
      real(dp), intent(out) :: place(2)
      real(dp) :: older(2), rest(2), multiplier, older_multiplier, state(2), weight(2)
      integer :: periods, longest

      orbit = 0
      place = 0.0_dp
      state = state_of_age(watch, 0)
      weight = [1.0_dp, lienard_weight]/weight_of_film(watch, 0)
      ! Longer orbits are looked for now and again: most motions do not have them.
      longest = merge(longest_orbit, 1, modulo(watch%count, longer_every) == 0)
      do periods = 1, longest
         if (watch%count < 3*periods + 2) return
         call settle(watch, weight, periods, 0, multiplier, rest)
         if (.not. (multiplier > fast .and. multiplier < slowest .and. maxval(abs(rest)) < near)) cycle
         call settle(watch, weight, periods, 1, older_multiplier, older)
         if (.not. abs(older_multiplier - multiplier) < agreement*(1.0_dp - multiplier)) cycle
         place = state + rest/weight
         if (min(place(1), backlash - place(1)) > 0.0_dp) orbit = periods
         return
      end do
   end subroutine forecast_rest

   !> Largest multiplier of the map of one orbit, and how far its fixed point is from a state. Huge where there is none.
   pure subroutine settle(watch, weight, orbit, age, multiplier, rest)
      type(orbit_watch_t), intent(in) :: watch
      !> What film and Lienard variable count
      real(dp), intent(in) :: weight(2)
      !> Periods of the orbit
      integer, intent(in) :: orbit
      !> Periods since the state
      integer, intent(in) :: age
      !> |lambda| [-]
      real(dp), intent(out) :: multiplier
      !> Weighted difference of the fixed point from the state [-]
      real(dp), intent(out) :: rest(2)
      real(dp) :: states(2, 0:3), a(2), b(2), c(2), across, alpha, beta, discriminant
      integer :: i

      do i = 0, 3
         states(:, i) = weight*state_of_age(watch, age + i*orbit)
      end do
      a = states(:, 2) - states(:, 3)
      b = states(:, 1) - states(:, 2)
      c = states(:, 0) - states(:, 1)
      multiplier = huge(1.0_dp)
      rest = huge(1.0_dp)
      if (max(maxval(abs(a)), maxval(abs(b))) > near .or. .not. maxval(abs(b)) > 0.0_dp) return
      across = cross(a, b)
      if (abs(across) > parallel*norm2(a)*norm2(b)) then
         alpha = cross(a, c)/across
         beta = cross(c, b)/across
         discriminant = 0.25_dp*alpha*alpha + beta
         if (discriminant < 0.0_dp) then
            multiplier = sqrt(-beta)
         else
            multiplier = 0.5_dp*abs(alpha) + sqrt(discriminant)
         end if
      else
         alpha = dot_product(b, c)/dot_product(b, b)
         beta = 0.0_dp
         multiplier = abs(alpha)
         if (norm2(c - alpha*b) > parallel*norm2(b)) multiplier = huge(1.0_dp)
      end if
      if (multiplier < slowest) rest = (alpha*c + beta*(b + c))/(1.0_dp - alpha - beta)
   end subroutine settle

   !> Area of the parallelogram of two vectors.
   pure real(dp) function cross(a, b)
      real(dp), intent(in) :: a(2)
      real(dp), intent(in) :: b(2)

      cross = a(1)*b(2) - a(2)*b(1)
   end function cross

end module lane_repetition
