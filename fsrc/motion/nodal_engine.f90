!> Motion of a gear whose flanks bend under films solved in nodes of pressure: the gear at rest, its periods by the steps of module
!> nodal_step, their samples, and when the motion repeats.
module nodal_engine
   use starting_state, only: initial_state
   use clock, only: wall_seconds
   use engine, only: checkpoint_t, ending_t, last_search_period, motion_watcher_t, motion_state_t, request_t, sample_sink_t, &
                     status_of_stop
   use errors, only: error_t
   use force, only: force_at, force_of_period
   use kinds, only: dp, int64
   use nodal_film, only: shares_of_fourth_order
   use nodal_flank, only: accept_step, correct_flank, finish_step, is_bent, kept_times, nodal_contact_t, nodal_flank_t, respond, &
                          rigid_gap, share_that_leaves_a_film, step_weights_t, stiffen
   use nodal_profiles, only: nodal_profiles_t, note_profiles, start_profiles
   use nodal_state, only: pack_motion, unpack_motion
   use nodal_step, only: begin_period, distance_of_states, fastest_of, first_step, gear_t, is_late, most_steps, motion_t, &
                         nodal_choice_t, set_up, state_of, take_step
   use problem, only: of_drive_compression, of_film, of_velocity, problem_t, state_size, static_load
   use repetition, only: kept_states, longest_orbit, orbit_watch_t
   use scene_status, only: status_complete, status_film_cycles, status_film_torn, status_interrupted, status_steady, &
                           status_time_limit
   use signals, only: must_stop
   use step_nodes, only: add_piece, node_place, nodes_per_piece, step_nodes_t
   use window_record, only: record_period, start_record, window_record_t
   implicit none(type, external)
   private

   !> Newton's iterations for the gear at rest: of them all, and before nodes change one by one
   integer, parameter :: most_rest_iterations = 120, free_rest_iterations = 80
   !> By how much the load grows from one film at rest to the next, at most and at least
   real(dp), parameter :: largest_growth = 1.4_dp, least_growth = 1.005_dp
   !> Share up to which two loads are the same
   real(dp), parameter :: same_load = 1.0e-3_dp
   !> States at the ends of periods that are kept, and share of the tolerance of a step up to which a motion repeats
   integer, parameter :: kept_periods = kept_states
   real(dp), parameter :: repetition_share = 2.0_dp

   public :: solve_in_nodes

contains

   !> Solve the motion of a problem from rest.
   subroutine solve_in_nodes(problem, choice, request, sink, watcher, checkpoint, ending, record, error, profiles)
      !> What moves
      type(problem_t), intent(in) :: problem
      type(nodal_choice_t), intent(in) :: choice
      !> What is requested; the accuracy is that of the choice
      type(request_t), intent(in) :: request
      !> Takes the samples
      class(sample_sink_t), intent(inout) :: sink
      !> Is called after every period
      class(motion_watcher_t), intent(inout) :: watcher
      !> State to carry on from, and then the one from which the run can be extended
      type(checkpoint_t), intent(inout) :: checkpoint
      !> How it ended
      type(ending_t), intent(out) :: ending
      !> What is requested of the window, and then the record of its steps
      type(window_record_t), intent(inout) :: record
      !> Set if the sink failed
      type(error_t), allocatable, intent(out) :: error
      !> What is requested of pressures and films over the contact, and then those of the window
      type(nodal_profiles_t), intent(inout), optional :: profiles
      type(nodal_contact_t) :: contact
      type(gear_t) :: gear
      type(motion_t) :: motion
      type(step_nodes_t) :: nodes
      type(nodal_profiles_t) :: kept
      real(dp), allocatable :: force(:), states(:, :), accelerations(:), first(:, :)
      real(dp), allocatable :: watched(:, :)
      integer :: period, last, n, from, last_kept
      logical :: found, searching
      real(dp) :: started

      started = wall_seconds()
      n = request%samples_per_period
      call set_up(problem, choice, contact, gear)
      found = checkpoint%periods > 0
      if (found) then
         call unpack_motion(problem, choice%nodes, checkpoint%nodal, motion)
         ending%count = checkpoint%count
         ending%periods = checkpoint%periods
      else
         call rest_of_gear(problem, contact, gear, motion, found)
      end if
      allocate (ending%numbers(state_size(problem)), source=initial_state(problem))
      ending%status = merge(status_complete, status_film_cycles, found)
      if (.not. found) return
      allocate (force(n), states(n, state_size(problem)), accelerations(n))
      call force_of_period(problem%force, force)
      allocate (first(1, state_size(problem)))
      first(1, :) = motion%states(1, :)
      if (checkpoint%periods == 0) &
         call sink%take(0_int64, [force_at(problem%force, 0.0_dp)], first, &
                        [acceleration(problem, gear, motion, force_at(problem%force, 0.0_dp), 1)], error)
      if (allocated(error)) return
      last = request%periods
      from = last - request%sampled_periods
      searching = request%until_steady
      last_kept = from
      if (searching) last_kept = last_search_period(request%periods, request%sampled_periods)
      if (checkpoint%orbit > 0) then
         ending%orbit = checkpoint%orbit
         searching = .false.
         from = checkpoint%periods
         last = from + ending%orbit
      end if
      call sink%begin_window(int(from, int64)*int(n, int64) + 1_int64, (last - from)*n)
      if (present(profiles)) kept = profiles
      if (from == checkpoint%periods) then
         call start_record(state_now(motion, from), record)
         call start_profiles(contact, kept)
      end if
      allocate (watched(state_size(problem), kept_periods), source=0.0_dp)
      watched(:, 1) = motion%states(1, :)
      if (checkpoint%watch%count > 0) watched = checkpoint%watch%states
      period = checkpoint%periods
      do while (period < last)
         period = period + 1
         call solve_period(problem, contact, gear, force, period - from - 1, period == last, motion, nodes, record, kept, states, &
                           accelerations, ending, choice)
         ending%film = motion%states(1, of_film)
         ending%time = (real(period - 1, dp) + motion%time(1))/problem%frequency
         call note_flank(gear, motion, ending)
         if (ending%status /= status_complete) return
         ending%numbers = motion%states(1, :)
         ending%time = real(period, dp)/problem%frequency
         ending%periods = period
         call sink%take(int(period - 1, int64)*int(n, int64) + 1_int64, force, states, accelerations, error)
         if (allocated(error)) return
         if (period > from) call record_period(problem, motion%states(1, of_velocity), nodes, record)
         call begin_period(motion)
         watched(:, 2:) = watched(:, :kept_periods - 1)
         watched(:, 1) = motion%states(1, :)
         if (searching) then
            ending%orbit = orbit_of(problem, watched(:, :min(period + 1, kept_periods)), fastest_of(gear, motion), &
                                    repetition_share*choice%tolerance)
            if (ending%orbit > last - period) ending%orbit = 0
            searching = ending%orbit == 0
            if (.not. searching) then
               from = period
               last = period + ending%orbit
               call sink%begin_window(int(from, int64)*int(n, int64) + 1_int64, ending%orbit*n)
            end if
         end if
         ! Of a run until steady the last state from which a longer one goes on searching, or that at the start of its orbit
         if (merge(period == from, period <= last_kept, ending%orbit > 0)) &
            call keep_state(problem, choice, motion, period, ending, request%until_steady, watched, checkpoint)
         if (period == from) then
            call start_record(state_now(motion, period), record)
            call start_profiles(contact, kept)
         end if
         call watcher%period_done(period, last)
         if (period == last) exit
         ending%status = status_of_stop(request, started)
         if (ending%status /= status_complete) return
         if (is_late(choice)) ending%status = status_time_limit
         if (ending%status /= status_complete) return
      end do
      if (ending%orbit > 0) ending%status = status_steady
      ending%nodal = pack_motion(problem, choice%nodes, motion)
      if (present(profiles)) profiles = kept
   end subroutine solve_in_nodes

   !> Keep a state from which the run can be extended.
   pure subroutine keep_state(problem, choice, motion, period, ending, until_steady, watched, checkpoint)
      type(problem_t), intent(in) :: problem
      type(nodal_choice_t), intent(in) :: choice
      !> At the end of a period
      type(motion_t), intent(in) :: motion
      !> Whole periods done
      integer, intent(in) :: period
      !> With the cost so far, and the periods after which the motion repeats if that is known
      type(ending_t), intent(in) :: ending
      !> Whether it is searched for repetition
      logical, intent(in) :: until_steady
      !> States that the search looks back on: number, period, the last one first
      real(dp), intent(in) :: watched(:, :)
      type(checkpoint_t), intent(out) :: checkpoint

      checkpoint = checkpoint_t(periods=period, carried_on=.true., count=ending%count, orbit=ending%orbit, &
                                nodal=pack_motion(problem, choice%nodes, motion))
      ! Within the constructor gfortran 12 reads behind the end of that array.
      checkpoint%numbers = motion%states(1, :)
      if (until_steady) checkpoint%watch = orbit_watch_t(count=min(period + 1, kept_periods), states=watched)
   end subroutine keep_state

   !> Periods after which a motion repeats, 0 if it is not seen to: the states at the ends of successive periods come nearer to
   !> those before them, and are within the tolerance of where they lead to.
   pure integer function orbit_of(problem, states, fastest, tolerance) result(orbit)
      type(problem_t), intent(in) :: problem
      !> Number of the state, period: the last one first
      real(dp), intent(in) :: states(:, :)
      !> Largest velocity so far [m/s]
      real(dp), intent(in) :: fastest
      !> Largest distance that is left, relative [-]
      real(dp), intent(in) :: tolerance
      !> Ratio of distances that is not trusted
      real(dp), parameter :: largest_ratio = 0.9_dp
      real(dp) :: distances(size(states, 2)), ratio
      integer :: period, age

      do orbit = 1, longest_orbit
         if (size(states, 2) - orbit < 3*orbit) exit
         do age = 1, 3*orbit
            distances(age) = distance_of_states(problem, fastest, states(:, age), states(:, age + orbit))
         end do
         ratio = 0.0_dp
         do period = 1, orbit
            if (distances(period + orbit) > 0.0_dp) ratio = max(ratio, distances(period)/distances(period + orbit))
            if (distances(period + 2*orbit) > 0.0_dp) &
               ratio = max(ratio, min(sqrt(distances(period)/distances(period + 2*orbit)), 1.0_dp))
         end do
         ! Errors of the steps are not worth a ratio.
         if (maxval(distances(:2*orbit)) <= 0.1_dp*tolerance) return
         if (ratio > largest_ratio) cycle
         if (maxval(distances(:orbit))*max(1.0_dp, ratio/(1.0_dp - ratio)) <= tolerance) return
      end do
      orbit = 0
   end function orbit_of

   !> Note which film could not be followed, if one could not, and under which load: the one in nodes, of both the one that carries
   !> more.
   pure subroutine note_flank(gear, motion, ending)
      type(gear_t), intent(in) :: gear
      type(motion_t), intent(in) :: motion
      type(ending_t), intent(inout) :: ending
      integer :: flank

      if (ending%status /= status_film_cycles .and. ending%status /= status_film_torn) return
      ending%lost_film = 1
      ending%lost_load = -1.0_dp
      do flank = 1, gear%flanks
         associate (film => motion%flanks(flank))
            if (.not. film%in_nodes .or. gear%load_unit*film%load(1) < ending%lost_load) cycle
            ending%lost_film = flank
            ending%lost_load = gear%load_unit*film%load(1)
            ending%film = gear%film_unit*film%film(1)
         end associate
      end do
      ending%lost_load = max(ending%lost_load, 0.0_dp)
   end subroutine note_flank

   !> State at present, as other parts of the program have it.
   pure type(motion_state_t) function state_now(motion, periods) result(state)
      type(motion_t), intent(in) :: motion
      !> Periods done
      integer, intent(in) :: periods

      state%periods = periods
      allocate (state%numbers, source=motion%states(1, :))
   end function state_now

   !> The gear at rest under its static load: films of the closure are the first iterate, loads in nodes grow step by step.
   pure subroutine rest_of_gear(problem, contact, gear, motion, found)
      type(problem_t), intent(in) :: problem
      type(nodal_contact_t), intent(in) :: contact
      type(gear_t), intent(in) :: gear
      type(motion_t), intent(out) :: motion
      logical, intent(out) :: found
      type(step_weights_t) :: at_rest
      real(dp) :: start(state_size(problem)), loads(2), target, load(2), by_gap(2), change, changes, correction, share
      real(dp) :: growth, solved_load
      type(nodal_flank_t) :: solved
      integer :: flank, iteration, j

      at_rest = step_weights_t()
      start = initial_state(problem)
      found = problem%initial_film > 0.0_dp
      if (.not. found) return
      loads = 0.0_dp
      loads(:gear%flanks) = start(of_drive_compression:of_velocity + gear%flanks)/(problem%contact%compliance*gear%load_unit)
      ! A closure may have one film under two loads, and then gives the other load or none.
      target = static_load(problem)/gear%load_unit + loads(2)
      if (target > 0.0_dp .and. abs(loads(1) - target) > same_load*target) loads(1) = target
      do flank = 1, gear%flanks
         associate (film => motion%flanks(flank))
            ! A rigid film at rest: M H = 12 Phi(0), of which Phi(0) is 0.2039.
            film%film = 12.0_dp*0.2039_dp/max(loads(flank), 1.0e-12_dp)
            film%load = loads(flank)
            film%gap = rigid_gap(contact, film%film(1), film%load(1))
            film%bending(0) = 4.0_dp/3.14_dp*film%load(1)/film%film(1)
            ! Of 0.64 M/sqrt(2 H) as the largest pressure
            film%bending(0) = max(film%bending(0), 0.064_dp*contact%oil%material*film%load(1)/sqrt(2.0_dp*film%film(1)))
            if (.not. is_bent(contact, film)) cycle
            target = min(0.1_dp, film%load(1))
            film%film = 12.0_dp*0.2039_dp/target
            film%load = target
            film%gap = rigid_gap(contact, film%film(1), target)
            call stiffen(contact, film)
            film%gap(0) = film%gap(1)
            film%pressures(:, 0) = film%pressures(:, 1)
            film%active = film%pressures(:, 0) > 0.0_dp
            film%fourth = shares_of_fourth_order(film%pressures(:, 0))
            film%rate = 0.0_dp
            film%past = 0.0_dp
            growth = largest_growth
            solved_load = 0.0_dp
            do
               call rest_under(contact, target, film, found)
               if (found) then
                  if (.not. target < loads(flank)) exit
                  solved_load = target
                  solved = film
               else
                  ! From the last load that was solved by a smaller step
                  growth = sqrt(growth)
                  if (growth < least_growth .or. .not. solved_load > 0.0_dp) return
                  film = solved
               end if
               target = min(loads(flank), growth*solved_load)
            end do
         end associate
      end do
      ! Now the gear, with both films.
      motion%position = motion%flanks(1)%gap(merge(0, 1, motion%flanks(1)%in_nodes))
      do flank = 1, gear%flanks
         associate (film => motion%flanks(flank))
            film%gap(0) = motion%position(0)
            if (flank == 2) film%gap(0) = gear%backlash - motion%position(0)
            if (.not. film%in_nodes) film%film(0) = film%film(1)
            film%rate = 0.0_dp
            film%past_film = 0.0_dp
         end associate
      end do
      do iteration = 1, most_rest_iterations
         load = 0.0_dp
         by_gap = 0.0_dp
         do flank = 1, gear%flanks
            call respond(contact, iteration > free_rest_iterations, motion%flanks(flank), load(flank), by_gap(flank), found)
            if (.not. found) return
         end do
         correction = (load(1) - load(2) - static_load(problem)/gear%load_unit)/(-sum(by_gap))
         share = share_that_leaves_a_film(motion%flanks(1), correction)
         if (gear%flanks == 2) share = min(share, share_that_leaves_a_film(motion%flanks(2), -correction))
         changes = 0.0_dp
         do flank = 1, gear%flanks
            call correct_flank(contact, share, merge(correction, -correction, flank == 1), motion%flanks(flank), change)
            changes = max(changes, change)
         end do
         motion%position(0) = motion%position(0) + share*correction
         if (changes < 1.0e-10_dp .and. abs(correction) < 1.0e-10_dp*(1.0_dp + abs(motion%position(0)))) exit
      end do
      found = changes < 1.0e-6_dp
      if (.not. found) return
      do flank = 1, gear%flanks
         call finish_step(contact, at_rest, motion%flanks(flank))
         ! It has stood still for long.
         do j = 1, kept_times
            call accept_step(contact, motion%flanks(flank))
         end do
      end do
      motion%position = motion%position(0)
      motion%velocity = 0.0_dp
      motion%time = 0.0_dp
      motion%known = 1
      motion%step = first_step
      allocate (motion%states(0:kept_times, state_size(problem)))
      do j = 0, kept_times
         motion%states(j, :) = state_of(problem, gear, motion, 1)
      end do
   end subroutine rest_of_gear

   !> A film in nodes at rest under a load, from one that is near it.
   pure subroutine rest_under(contact, target, film, found)
      type(nodal_contact_t), intent(in) :: contact
      !> M [-]
      real(dp), intent(in) :: target
      type(nodal_flank_t), intent(inout) :: film
      logical, intent(out) :: found
      real(dp), parameter :: last_change = 1.0e-9_dp
      real(dp) :: load, by_gap, change
      integer :: iteration

      do iteration = 1, most_rest_iterations
         call respond(contact, iteration > free_rest_iterations, film, load, by_gap, found)
         if (.not. found) return
         call correct_flank(contact, 1.0_dp, (target - load)/by_gap, film, change)
         film%fourth = shares_of_fourth_order(film%pressures(:, 0))
         found = change < last_change
         if (found) return
      end do
   end subroutine rest_under

   !> z'' at a place of the histories [m/s2].
   pure real(dp) function acceleration(problem, gear, motion, force, place)
      type(problem_t), intent(in) :: problem
      type(gear_t), intent(in) :: gear
      type(motion_t), intent(in) :: motion
      !> [N]
      real(dp), intent(in) :: force
      integer, intent(in) :: place

      acceleration = motion%flanks(1)%load(place)
      if (gear%flanks == 2) acceleration = acceleration - motion%flanks(2)%load(place)
      acceleration = (gear%load_unit*acceleration - force - problem%weight)/problem%mass
   end function acceleration

   !> A period: its steps, the samples of it, and the nodes of its steps where they are recorded.
   subroutine solve_period(problem, contact, gear, force, done, is_last, motion, nodes, record, kept, states, accelerations, &
                           ending, choice)
      type(problem_t), intent(in) :: problem
      type(nodal_contact_t), intent(in) :: contact
      type(gear_t), intent(in) :: gear
      !> Of the samples [N]
      real(dp), intent(in) :: force(:)
      !> Whole periods since the window began, below 0 before; and whether this is its last one
      integer, intent(in) :: done
      logical, intent(in) :: is_last
      type(motion_t), intent(inout) :: motion
      type(step_nodes_t), intent(inout) :: nodes
      type(window_record_t), intent(in) :: record
      !> Pressures and films over the contact that are kept of the window
      type(nodal_profiles_t), intent(inout) :: kept
      !> Sample, number of its state; and z'' [m/s2]
      real(dp), intent(out) :: states(:, :)
      real(dp), intent(out) :: accelerations(:)
      type(ending_t), intent(inout) :: ending
      type(nodal_choice_t), intent(in) :: choice
      real(dp), allocatable :: piece(:, :)
      real(dp) :: phase, length, start, loads
      integer :: sample, i, pieces, part
      integer(int64) :: steps

      allocate (piece(nodes_per_piece, size(states, 2)))
      sample = 0
      steps = 0
      do while (motion%time(1) < 1.0_dp)
         call take_step(problem, contact, gear, choice, motion, ending)
         if (ending%status /= status_complete) return
         steps = steps + 1
         if (steps > most_steps) ending%status = status_film_cycles
         if (modulo(steps, 256_int64) == 0) then
            if (must_stop()) ending%status = status_interrupted
         end if
         if (ending%status /= status_complete) return
         do while (sample < size(force))
            phase = real(sample + 1, dp)/real(size(force), dp)
            if (phase > motion%time(1) + 1.0e-12_dp) exit
            sample = sample + 1
            states(sample, :) = state_at(motion, phase)
            loads = states(sample, of_velocity + 1)
            if (gear%flanks == 2) loads = loads - states(sample, of_velocity + 2)
            accelerations(sample) = (loads/problem%contact%compliance - force(sample) - problem%weight)/problem%mass
         end do
         if (done < 0) cycle
         call note_profiles(contact, gear%flanks, motion, done, is_last, kept)
         pieces = max(1, ceiling((motion%time(1) - motion%time(2))/record%longest_piece))
         length = (motion%time(1) - motion%time(2))/real(pieces, dp)
         do part = 1, pieces
            start = motion%time(2) + real(part - 1, dp)*length
            do i = 1, nodes_per_piece
               piece(i, :) = state_at(motion, start + node_place(i)*length)
            end do
            call add_piece(start, length, piece, nodes)
         end do
      end do
      ending%count%steps = ending%count%steps + steps
   end subroutine solve_period

   !> State within the last step: the polynomial through its end and the times before. What is positive stays positive.
   pure function state_at(motion, time) result(state)
      type(motion_t), intent(in) :: motion
      !> [periods]
      real(dp), intent(in) :: time
      real(dp) :: state(size(motion%states, 2)), weight
      integer :: points, i, j

      points = min(motion%known, kept_times)
      state = 0.0_dp
      do i = 1, points
         weight = 1.0_dp
         do j = 1, points
            if (j /= i) weight = weight*(time - motion%time(j))/(motion%time(i) - motion%time(j))
         end do
         state = state + weight*motion%states(i, :)
      end do
      state(of_film) = max(state(of_film), 0.5_dp*min(motion%states(1, of_film), motion%states(2, of_film)))
   end function state_at

end module nodal_engine
