!> Whole motion of a scene: from the first state through all periods, samples handed to a sink.
module integrate_motion
   use checkpoint, only: checkpoint_t
   use clock, only: wall_seconds
   use constants, only: two_pi
   use errors, only: error_t
   use film_law, only: film_kernel, film_t, kernel_of, steady_film
   use forcing, only: applied_force, force_of_period
   use kinds, only: dp, int64
   use newmark, only: advance_period, motion_count_t, motion_state_t, newmark_t, start_motion
   use period_repetition, only: note_state, orbit_watch_t
   use sample_sink, only: sample_sink_t
   use scene_status, only: status_complete, status_interrupted, status_steady, status_time_limit
   use scene_types, only: iteration_newton, predictor_extrapolated, scene_t, until_steady
   use signals, only: caught_signal
   use window_record, only: window_record_t
   use settling_rate, only: settling_of
   implicit none(type, external)
   private

   !> How the motion ended.
   type, public :: motion_end_t
      integer :: status = status_complete
      !> Time reached [s]
      real(dp) :: time = 0.0_dp
      !> Whole periods solved
      integer :: periods = 0
      !> Film there [m] and its velocity [m/s]
      real(dp) :: film = 0.0_dp
      real(dp) :: velocity = 0.0_dp
      !> Periods after which a steady motion repeats, else 0
      integer :: orbit = 0
      type(motion_count_t) :: count
      !> State from which the run can be extended
      type(checkpoint_t) :: checkpoint
      !> What the steps of the window tell beyond its samples; no periods: its samples are its steps
      type(window_record_t) :: record
   end type motion_end_t

   !> Watcher of the motion, told after every period.
   type, abstract, public :: motion_watcher_t
   contains
      procedure(watch_period), deferred :: period_done
   end type motion_watcher_t

   abstract interface
      !> Told how far the motion is.
      subroutine watch_period(self, done, all)
         import :: motion_watcher_t
         class(motion_watcher_t), intent(inout) :: self
         !> Periods solved
         integer, intent(in) :: done
         !> Periods asked for
         integer, intent(in) :: all
      end subroutine watch_period
   end interface

   !> Distance from the repeating motion, relative to the film, at which Newmark's motion counts as steady: far below
   !> the error of its steps [-].
   real(dp), parameter :: repetition_tolerance = 1.0e-9_dp

   public :: solve_motion, status_of_stop

contains

   !> Solve the motion of a scene. The film law is chosen here, once.
   subroutine solve_motion(scene, film, initial_film, start, sink, watcher, ending, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Its film
      type(film_t), intent(in) :: film
      !> Film at t = 0 [m]
      real(dp), intent(in) :: initial_film
      !> State to carry on from; 0 periods: start at t = 0
      type(checkpoint_t), intent(in) :: start
      !> Takes the samples
      class(sample_sink_t), intent(inout) :: sink
      !> Told of progress
      class(motion_watcher_t), intent(inout) :: watcher
      !> How it ended
      type(motion_end_t), intent(out) :: ending
      !> Set if the sink failed
      type(error_t), allocatable, intent(out) :: error

      procedure(film_kernel), pointer :: kernel

      kernel => kernel_of(film)
      ending%status = film%status_without_load
      if (associated(kernel)) call run_periods(kernel, scene, film, initial_film, start, sink, watcher, ending, error)
   end subroutine solve_motion

   !> All periods with one kernel.
   subroutine run_periods(kernel, scene, film, initial_film, start, sink, watcher, ending, error)
      procedure(film_kernel) :: kernel
      type(scene_t), intent(in) :: scene
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: initial_film
      type(checkpoint_t), intent(in) :: start
      class(sample_sink_t), intent(inout) :: sink
      class(motion_watcher_t), intent(inout) :: watcher
      type(motion_end_t), intent(out) :: ending
      type(error_t), allocatable, intent(out) :: error
      type(newmark_t) :: method
      type(motion_state_t) :: state
      real(dp), allocatable :: force(:), films(:), velocities(:), accelerations(:)
      type(orbit_watch_t) :: states
      logical :: searching
      integer(int64) :: first_step
      integer :: period, last_period, window, steps, done
      real(dp) :: started, rest_film

      started = wall_seconds()
      rest_film = steady_film(film, scene%load%static_load())
      method = newmark_of(scene)
      steps = scene%solver%samples_per_period()
      allocate (force(steps), films(steps), velocities(steps), accelerations(steps))
      call force_of_period(method%steady_force, method%force_amplitude, force)

      ! Without a film to start from there is none that carries the static load.
      ending%status = film%status_without_load
      if (.not. initial_film > 0.0_dp) return
      if (start%periods > 0) then
         state = motion_state_t(start%film, start%velocity, start%acceleration)
         ending%count = motion_count_t(start%steps, start%evaluations, start%cuts)
         ending%periods = start%periods
         states = start%watch
      else
         call start_motion(kernel, film, method, initial_film, scene%film%initial_velocity, state, ending%count, ending%status)
         ending%film = state%film
         if (ending%status /= status_complete) return
         call sink%take(0_int64, [applied_force(method%steady_force, method%force_amplitude, 0.0_dp)], [state%film], &
                        [state%velocity], [state%acceleration], error)
         if (allocated(error)) return
      end if
      ending%status = status_complete
      ending%checkpoint = start

      last_period = scene%solver%periods
      window = scene%spectrum%periods
      searching = scene%solver%until == until_steady .and. start%orbit == 0
      if (start%orbit > 0) then
         ending%orbit = start%orbit
         last_period = start%periods + start%orbit
         window = start%orbit
      end if
      call sink%begin_window(int(last_period - window, int64)*int(steps, int64) + 1_int64, window*steps)
      period = start%periods
      do while (period < last_period)
         period = period + 1
         first_step = int(period - 1, int64)*int(steps, int64) + 1_int64
         call advance_period(kernel, film, method, force, state, ending%count, films, velocities, accelerations, done, &
                             ending%status)
         call sink%take(first_step, force(:done), films(:done), velocities(:done), accelerations(:done), error)
         ending%film = state%film
         ending%velocity = state%velocity
         ending%time = real(first_step + int(done - 1, int64), dp)/(method%frequency*real(steps, dp))
         if (allocated(error) .or. ending%status /= status_complete) return
         ending%periods = period
         if (searching) then
            call look_back(film, rest_film, method, state, initial_film, last_period - period, states, ending%orbit)
            searching = ending%orbit == 0
            if (.not. searching) then
               window = ending%orbit
               last_period = period + window
               call sink%begin_window(int(period, int64)*int(steps, int64) + 1_int64, window*steps)
            end if
         end if
         if (period <= last_period - window) &
            ending%checkpoint = checkpoint_of(period, state, ending%count, states, ending%orbit)
         call watcher%period_done(period, last_period)
         if (period == last_period) exit
         ending%status = status_of_stop(scene, started)
         if (ending%status /= status_complete) return
      end do
      if (ending%orbit > 0) ending%status = status_steady
   end subroutine run_periods

   !> Take the state at the end of a period: does the motion repeat?
   pure subroutine look_back(film, rest_film, method, state, initial_film, periods_left, states, orbit)
      type(film_t), intent(in) :: film
      !> Film that carries the static load [m]
      real(dp), intent(in) :: rest_film
      type(newmark_t), intent(in) :: method
      type(motion_state_t), intent(in) :: state
      !> Film at t = 0, that scales the states [m]
      real(dp), intent(in) :: initial_film
      !> Periods in which the orbit must find room
      integer, intent(in) :: periods_left
      type(orbit_watch_t), intent(inout) :: states
      !> Periods after which the motion repeats, 0: not known to, or too many
      integer, intent(out) :: orbit
      real(dp) :: distance

      call note_state(states, state%film/initial_film, state%velocity/(initial_film*method%frequency), 1.0_dp/two_pi, &
                      settling_of(film, state%film, rest_film, method%mass, method%frequency), repetition_tolerance, orbit, &
                      distance)
      if (orbit > periods_left) orbit = 0
   end subroutine look_back

   !> State at the end of a period, with what it cost.
   pure function checkpoint_of(period, state, count, watch, orbit) result(here)
      integer, intent(in) :: period
      type(motion_state_t), intent(in) :: state
      type(motion_count_t), intent(in) :: count
      type(orbit_watch_t), intent(in) :: watch
      integer, intent(in) :: orbit
      type(checkpoint_t) :: here

      here%periods = period
      here%film = state%film
      here%velocity = state%velocity
      here%acceleration = state%acceleration
      here%watch = watch
      here%orbit = orbit
      here%steps = count%steps
      here%evaluations = count%evaluations
      here%cuts = count%cuts
   end function checkpoint_of

   !> Whether a scene may go on, status_complete, or must stop between two periods and why.
   integer function status_of_stop(scene, started) result(status)
      !> The scene
      type(scene_t), intent(in) :: scene
      !> When it began, on the clock of wall_seconds [s]
      real(dp), intent(in) :: started

      status = status_complete
      if (caught_signal() /= 0) status = status_interrupted
      if (scene%solver%time_limit > 0.0_dp) then
         if (wall_seconds() - started > scene%solver%time_limit) status = status_time_limit
      end if
   end function status_of_stop

   !> Constants of the method from the scene.
   pure function newmark_of(scene) result(method)
      type(scene_t), intent(in) :: scene
      type(newmark_t) :: method

      method%mass = scene%load%mass
      method%weight = scene%load%weight()
      method%steady_force = scene%load%steady_force
      method%force_amplitude = scene%load%force_amplitude
      method%frequency = scene%load%frequency
      method%tolerance = scene%solver%tolerance
      method%iteration_limit = scene%solver%iteration_limit
      method%by_newton = scene%solver%iteration == iteration_newton
      method%extrapolate = scene%solver%predictor == predictor_extrapolated
   end function newmark_of

end module integrate_motion
