!> Motion by the paper's Newmark method: from the first state through all periods, samples handed to a sink.
module newmark_engine
   use clock, only: wall_seconds
   use constants, only: two_pi
   use engine, only: checkpoint_t, ending_t, motion_watcher_t, request_t, sample_sink_t, status_of_stop
   use errors, only: error_t
   use film_law, only: film_kernel
   use flank_contact, only: kernel_of_contact
   use force, only: force_at, force_of_period
   use kinds, only: dp, int64
   use newmark, only: advance_period, newmark_state_t, start_motion
   use problem, only: film_unit, of_film, of_velocity, problem_t, reference_films, rigid_films, settling_of, state_size, &
      thinner_in_units
   use repetition, only: note_state, orbit_watch_t
   use scene_status, only: status_complete, status_steady
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Distance from the repeating motion, relative to the film, at which Newmark's motion counts as steady: far below
   !> the error of its steps [-].
   real(dp), parameter :: repetition_tolerance = 1.0e-9_dp

   public :: solve_newmark

contains

   !> Solve the motion of a problem. The kernel of its film is chosen here, once.
   subroutine solve_newmark(problem, request, sink, watcher, checkpoint, ending, record, error)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> What is requested
      type(request_t), intent(in) :: request
      !> Takes the samples
      class(sample_sink_t), intent(inout) :: sink
      !> Is called after every period
      class(motion_watcher_t), intent(inout) :: watcher
      !> State to carry on from, and then the one from which the run can be extended
      type(checkpoint_t), intent(inout) :: checkpoint
      !> How it ended
      type(ending_t), intent(out) :: ending
      !> Record of the steps of the window: none, as its samples are its steps
      type(window_record_t), intent(out) :: record
      !> Set if the sink failed
      type(error_t), allocatable, intent(out) :: error

      procedure(film_kernel), pointer :: kernel
      type(newmark_state_t) :: state
      real(dp), allocatable :: force(:), states_of_steps(:, :), accelerations(:)
      type(orbit_watch_t) :: states
      logical :: searching
      integer(int64) :: first_step
      integer :: period, last_period, window, steps, done
      real(dp) :: started

      started = wall_seconds()
      record%periods = 0
      kernel => kernel_of_contact(problem%contact)
      steps = request%samples_per_period
      allocate (ending%numbers(state_size(problem)), source=0.0_dp)
      allocate (force(steps), states_of_steps(steps, state_size(problem)), accelerations(steps))
      call force_of_period(problem%force, force)

      ! Without a film to start from there is none that carries the static load.
      ending%status = problem%contact%film%status_without_load
      if (.not. (associated(kernel) .and. problem%initial_film > 0.0_dp)) return
      if (checkpoint%periods > 0) then
         state = newmark_state_t(checkpoint%numbers(of_film), checkpoint%numbers(of_velocity), checkpoint%acceleration)
         ending%count = checkpoint%count
         ending%periods = checkpoint%periods
         states = checkpoint%watch
      else
         call start_motion(kernel, problem, state, ending%count, ending%status)
         ending%numbers(of_film) = state%film
         ending%film = state%film
         if (ending%status /= status_complete) return
         call sink%take(0_int64, [force_at(problem%force, 0.0_dp)], &
                        reshape([state%film, state%velocity], [1, 2]), [state%acceleration], error)
         if (allocated(error)) return
      end if
      ending%status = status_complete

      last_period = request%periods
      window = request%sampled_periods
      searching = request%until_steady .and. checkpoint%orbit == 0
      if (checkpoint%orbit > 0) then
         ending%orbit = checkpoint%orbit
         last_period = checkpoint%periods + checkpoint%orbit
         window = checkpoint%orbit
      end if
      call sink%begin_window(int(last_period - window, int64)*int(steps, int64) + 1_int64, window*steps)
      period = checkpoint%periods
      do while (period < last_period)
         period = period + 1
         first_step = int(period - 1, int64)*int(steps, int64) + 1_int64
         call advance_period(kernel, problem, request, force, state, ending%count, states_of_steps(:, of_film), &
                             states_of_steps(:, of_velocity), accelerations, done, ending%status)
         call sink%take(first_step, force(:done), states_of_steps(:done, :), accelerations(:done), error)
         ending%numbers(of_film) = state%film
         ending%numbers(of_velocity) = state%velocity
         ending%film = state%film
         ending%time = real(first_step + int(done - 1, int64), dp)/(problem%frequency*real(steps, dp))
         if (allocated(error) .or. ending%status /= status_complete) return
         ending%periods = period
         if (searching) then
            call look_back(problem, state, last_period - period, states, ending%orbit)
            searching = ending%orbit == 0
            if (.not. searching) then
               window = ending%orbit
               last_period = period + window
               call sink%begin_window(int(period, int64)*int(steps, int64) + 1_int64, window*steps)
            end if
         end if
         if (period <= last_period - window) &
            checkpoint = checkpoint_t(periods=period, numbers=ending%numbers, acceleration=state%acceleration, &
                                      watch=states, orbit=ending%orbit, count=ending%count)
         call watcher%period_done(period, last_period)
         if (period == last_period) exit
         ending%status = status_of_stop(request, started)
         if (ending%status /= status_complete) return
      end do
      if (ending%orbit > 0) ending%status = status_steady
   end subroutine solve_newmark

   !> Take the state at the end of a period: does the motion repeat?
   pure subroutine look_back(problem, state, periods_left, states, orbit)
      type(problem_t), intent(in) :: problem
      type(newmark_state_t), intent(in) :: state
      !> Periods in which the orbit must find room
      integer, intent(in) :: periods_left
      type(orbit_watch_t), intent(inout) :: states
      !> Periods after which the motion repeats, 0: not known to, or too many
      integer, intent(out) :: orbit
      real(dp) :: distance, unit

      unit = film_unit(problem)
      call note_state(states, [state%film/unit, state%velocity/(unit*problem%frequency)], &
                      thinner_in_units(problem, state%film/unit, unit), [1.0_dp, 1.0_dp/two_pi], &
                      settling_of(problem, rigid_films(problem, state%film), reference_films(problem)), repetition_tolerance, &
                      orbit, distance)
      if (orbit > periods_left) orbit = 0
   end subroutine look_back

end module newmark_engine
