!> Motion of a gear whose flanks bend under films solved in nodes of pressure: its periods by the steps of module nodal_step, from the
!> start of module nodal_start, their samples, and when the motion repeats.
module nodal_engine
   use starting_state, only: initial_state
   use clock, only: wall_seconds
   use engine, only: checkpoint_t, ending_t, last_search_period, motion_watcher_t, motion_state_t, request_t, sample_sink_t, &
      status_of_stop
   use errors, only: error_t
   use force, only: force_at, force_of_period
   use kinds, only: dp, int64
   use nodal_flank, only: kept_times
   use nodal_profiles, only: nodal_profiles_t, note_profiles, start_profiles
   use nodal_start, only: start_of_gear
   use nodal_state, only: pack_motion, unpack_motion
   use nodal_step, only: begin_period, distance_of_states, gear_t, is_late, most_steps, motion_t, nodal_choice_t, set_up, take_step
   use problem, only: of_film, of_velocity, problem_t, state_size
   use repetition, only: kept_states, longest_orbit, orbit_watch_t
   use scene_status, only: status_complete, status_film_cycles, status_film_torn, status_interrupted, status_steady, &
      status_time_limit
   use signals, only: must_stop
   use step_nodes, only: add_piece, node_place, nodes_per_piece, step_nodes_t
   use window_record, only: record_period, start_record, window_record_t
   implicit none(type, external)
   private

   !> States at the ends of periods that are kept, and share of the tolerance of a step up to which a motion repeats
   integer, parameter :: kept_periods = kept_states
   real(dp), parameter :: repetition_share = 2.0_dp

   !> A motion under way, with what is recorded of it.
   type :: nodal_run_t
      type(gear_t) :: gear
      type(motion_t) :: motion
      !> Nodes of the steps of the present period, and pressures and films over the contact that are kept of the window
      type(step_nodes_t) :: nodes
      type(nodal_profiles_t) :: kept
      !> The present period, the last one before the window, and the last one of it
      integer :: period = 0, from = 0, last = 0
      !> Samples of a period: force [N], state by number, z'' [m/s2]
      real(dp), allocatable :: force(:), states(:, :), accelerations(:)
      !> States that the search for repetition looks back on: number, period, the last one first
      real(dp), allocatable :: watched(:, :)
   end type nodal_run_t

   public :: solve_in_nodes, add_step

contains

   !> Solve the motion of a problem from its start.
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
      type(nodal_run_t) :: run
      integer :: n, last_kept
      logical :: searching
      real(dp) :: started

      started = wall_seconds()
      n = request%samples_per_period
      call start_run(problem, choice, n, checkpoint, run, ending)
      if (ending%status /= status_complete) return
      if (checkpoint%periods == 0) call sink%take(0_int64, [force_at(problem%force, 0.0_dp)], run%motion%states(1:1, :), &
                                                  [first_acceleration(run%gear, run%motion)], error)
      if (allocated(error)) return
      if (present(profiles)) run%kept = profiles
      run%last = request%periods
      run%from = run%last - request%sampled_periods
      searching = request%until_steady
      last_kept = run%from
      if (searching) last_kept = last_search_period(request%periods, request%sampled_periods)
      if (checkpoint%orbit > 0) then
         ending%orbit = checkpoint%orbit
         searching = .false.
         run%from = checkpoint%periods
         run%last = run%from + ending%orbit
      end if
      call sink%begin_window(int(run%from, int64)*int(n, int64) + 1_int64, (run%last - run%from)*n)
      if (run%from == run%period) call start_window(run, record)
      do while (run%period < run%last)
         run%period = run%period + 1
         call solve_period(run, record, ending)
         call note_progress(run, ending)
         if (ending%status /= status_complete) return
         call sink%take(int(run%period - 1, int64)*int(n, int64) + 1_int64, run%force, run%states, run%accelerations, error)
         if (allocated(error)) return
         if (run%period > run%from) call record_period(problem, run%motion%states(1, of_velocity), run%nodes, record)
         call begin_period(run%motion)
         run%watched(:, 2:) = run%watched(:, :kept_periods - 1)
         run%watched(:, 1) = run%motion%states(1, :)
         if (searching) then
            ending%orbit = orbit_of(run%gear, run%motion, run%watched(:, :min(run%period + 1, kept_periods)))
            if (ending%orbit > run%last - run%period) ending%orbit = 0
            searching = ending%orbit == 0
            if (.not. searching) then
               run%from = run%period
               run%last = run%period + ending%orbit
               call sink%begin_window(int(run%from, int64)*int(n, int64) + 1_int64, ending%orbit*n)
            end if
         end if
         ! Of a run until steady the last state from which a longer one goes on searching, or that at the start of its orbit
         if (merge(run%period == run%from, run%period <= last_kept, ending%orbit > 0)) &
            call keep_state(run, ending, request%until_steady, checkpoint)
         if (run%period == run%from) call start_window(run, record)
         call watcher%period_done(run%period, run%last)
         if (run%period == run%last) exit
         ending%status = status_of_stop(request, started)
         if (ending%status == status_complete) then
            if (is_late(choice)) ending%status = status_time_limit
         end if
         if (ending%status /= status_complete) return
      end do
      if (ending%orbit > 0) ending%status = status_steady
      ending%nodal = pack_motion(problem, choice%nodes, run%motion)
      if (present(profiles)) profiles = run%kept
   end subroutine solve_in_nodes

   !> Begin a motion at its start, or where it is carried on from.
   pure subroutine start_run(problem, choice, samples_per_period, checkpoint, run, ending)
      type(problem_t), intent(in) :: problem
      type(nodal_choice_t), intent(in) :: choice
      integer, intent(in) :: samples_per_period
      type(checkpoint_t), intent(in) :: checkpoint
      type(nodal_run_t), intent(out) :: run
      !> With a status other than complete where no film at the start is found
      type(ending_t), intent(inout) :: ending
      logical :: found

      call set_up(problem, choice, run%gear)
      found = checkpoint%periods > 0
      if (found) then
         call unpack_motion(problem, choice%nodes, checkpoint%nodal, run%motion)
         run%period = checkpoint%periods
         ending%count = checkpoint%count
         ending%periods = checkpoint%periods
      else
         call start_of_gear(run%gear, run%motion, found)
      end if
      allocate (ending%numbers(state_size(problem)), source=initial_state(problem))
      ending%status = merge(status_complete, status_film_cycles, found)
      if (.not. found) return
      allocate (run%force(samples_per_period), run%states(samples_per_period, state_size(problem)), &
                run%accelerations(samples_per_period))
      call force_of_period(problem%force, run%force)
      allocate (run%watched(state_size(problem), kept_periods), source=0.0_dp)
      run%watched(:, 1) = run%motion%states(1, :)
      if (checkpoint%watch%count > 0) run%watched = checkpoint%watch%states
   end subroutine start_run

   !> Begin the window.
   pure subroutine start_window(run, record)
      type(nodal_run_t), intent(inout) :: run
      type(window_record_t), intent(inout) :: record
      type(motion_state_t) :: start

      start%periods = run%period
      allocate (start%numbers, source=run%motion%states(1, :))
      call start_record(start, record)
      call start_profiles(run%gear%contact, run%kept)
   end subroutine start_window

   !> Note how far the motion is after a period, or where it could not be followed: which film, and under which load, is the one in
   !> nodes, of both the one that carries more.
   pure subroutine note_progress(run, ending)
      type(nodal_run_t), intent(in) :: run
      type(ending_t), intent(inout) :: ending
      integer :: flank

      ending%film = run%motion%states(1, of_film)
      if (ending%status == status_complete) then
         ending%numbers = run%motion%states(1, :)
         ending%time = real(run%period, dp)/run%gear%problem%frequency
         ending%periods = run%period
         return
      end if
      ending%time = (real(run%period - 1, dp) + run%motion%time(1))/run%gear%problem%frequency
      if (ending%status /= status_film_cycles .and. ending%status /= status_film_torn) return
      ending%lost_film = 1
      ending%lost_load = -1.0_dp
      do flank = 1, run%gear%flanks
         associate (film => run%motion%flanks(flank), load_unit => run%gear%load_unit)
            if (.not. film%in_nodes .or. load_unit*film%load(1) < ending%lost_load) cycle
            ending%lost_film = flank
            ending%lost_load = load_unit*film%load(1)
            ending%film = run%gear%film_unit*film%film(1)
         end associate
      end do
      ending%lost_load = max(ending%lost_load, 0.0_dp)
   end subroutine note_progress

   !> Keep a state from which the run can be extended.
   pure subroutine keep_state(run, ending, until_steady, checkpoint)
      !> At the end of a period
      type(nodal_run_t), intent(in) :: run
      !> With the cost so far, and the periods after which the motion repeats if that is known
      type(ending_t), intent(in) :: ending
      !> Whether it is searched for repetition
      logical, intent(in) :: until_steady
      type(checkpoint_t), intent(out) :: checkpoint

      checkpoint = checkpoint_t(periods=run%period, carried_on=.true., count=ending%count, orbit=ending%orbit, &
                                nodal=pack_motion(run%gear%problem, run%gear%choice%nodes, run%motion))
      ! Within the constructor gfortran 12 reads behind the end of that array.
      checkpoint%numbers = run%motion%states(1, :)
      if (until_steady) checkpoint%watch = orbit_watch_t(count=min(run%period + 1, kept_periods), states=run%watched)
   end subroutine keep_state

   !> Periods after which a motion repeats, 0 if it is not seen to: the states at the ends of successive periods come nearer to
   !> those before them, and are within the tolerance of where they lead to.
   pure integer function orbit_of(gear, motion, states) result(orbit)
      type(gear_t), intent(in) :: gear
      type(motion_t), intent(in) :: motion
      !> Number of the state, period: the last one first
      real(dp), intent(in) :: states(:, :)
      !> Ratio of distances that is not trusted
      real(dp), parameter :: largest_ratio = 0.9_dp
      real(dp) :: distances(size(states, 2)), ratio, tolerance
      integer :: period, age

      tolerance = repetition_share*gear%choice%tolerance
      do orbit = 1, longest_orbit
         if (size(states, 2) - orbit < 3*orbit) exit
         do age = 1, 3*orbit
            distances(age) = distance_of_states(gear, motion, states(:, age), states(:, age + orbit))
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

   !> z'' of a gear where its motion begins [m/s2].
   pure real(dp) function first_acceleration(gear, motion) result(acceleration)
      type(gear_t), intent(in) :: gear
      type(motion_t), intent(in) :: motion

      acceleration = motion%flanks(1)%load(1)
      if (gear%flanks == 2) acceleration = acceleration - motion%flanks(2)%load(1)
      acceleration = (gear%load_unit*acceleration - force_at(gear%problem%force, 0.0_dp) - gear%problem%weight)/gear%problem%mass
   end function first_acceleration

   !> A period: its steps, the samples of it, and the nodes of its steps where they are recorded.
   subroutine solve_period(run, record, ending)
      type(nodal_run_t), intent(inout) :: run
      type(window_record_t), intent(in) :: record
      type(ending_t), intent(inout) :: ending
      real(dp) :: phase, loads
      integer :: sample
      integer(int64) :: steps

      sample = 0
      steps = 0
      associate (gear => run%gear, motion => run%motion, problem => run%gear%problem, states => run%states, force => run%force)
         do while (motion%time(1) < 1.0_dp)
            call take_step(gear, motion, ending)
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
               run%accelerations(sample) = (loads/problem%contact%compliance - force(sample) - problem%weight)/problem%mass
            end do
            if (run%period <= run%from) cycle
            call note_profiles(gear%flanks, motion, run%period - run%from - 1, run%period == run%last, run%kept)
            call add_step(motion, record%longest_piece, run%nodes)
         end do
      end associate
      ending%count%steps = ending%count%steps + steps
   end subroutine solve_period

   !> Add the last step to the nodes of its period.
   pure subroutine add_step(motion, longest_piece, nodes)
      type(motion_t), intent(in) :: motion
      !> [periods]
      real(dp), intent(in) :: longest_piece
      type(step_nodes_t), intent(inout) :: nodes
      real(dp) :: piece(nodes_per_piece, size(motion%states, 2)), length, start
      integer :: pieces, part, i

      pieces = max(1, ceiling((motion%time(1) - motion%time(2))/longest_piece))
      length = (motion%time(1) - motion%time(2))/real(pieces, dp)
      do part = 1, pieces
         start = motion%time(2) + real(part - 1, dp)*length
         do i = 1, nodes_per_piece
            piece(i, :) = state_at(motion, start + node_place(i)*length)
         end do
         call add_piece(start, length, piece, nodes)
      end do
   end subroutine add_step

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
