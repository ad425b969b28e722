!> What is requested of an engine, what watches it, and what it hands out. There are two: Newmark's method of the paper
!> (newmark_engine) and the controlled engine (controlled_engine), which also solves many motions side by side (many_motions).
module engine
   use clock, only: wall_seconds
   use errors, only: error_t
   use kinds, only: dp, int64
   use starting_state, only: initial_state
   use motion_start, only: motion_start_t
   use problem, only: problem_t
   use repetition, only: longest_orbit, orbit_watch_t
   use scene_status, only: status_complete, status_interrupted, status_time_limit
   use signals, only: caught_signal
   implicit none(type, external)
   private

   !> What is requested of an engine.
   type, public :: request_t
      !> Relative accuracy of the film, of the controlled engine [-]
      real(dp) :: accuracy = 1.0e-8_dp
      !> Periods to solve, those done before included; the most if `until_steady`
      integer :: periods = 0
      !> Samples of a period, at phases 1/n, 2/n, ... 1: Newmark's steps
      integer :: samples_per_period = 0
      !> Periods sampled, the last ones, or one orbit of a motion found steady, however long; 0: no samples
      integer :: sampled_periods = 0
      !> Stop when the motion is known to repeat
      logical :: until_steady = .false.
      !> Compute every period, those too that return to the last bit
      logical :: every_period = .false.
      !> Jump to the extrapolated fixed point of a slowly settling motion. If it then repeats, the periods before the
      !> samples are fewer than those that follow from the start
      logical :: forecast = .false.
      !> Hand over the samples of all periods, of a single motion
      logical :: all_samples = .false.
      !> Loads above this multiple of the largest force are recorded as impacts; 0: none
      real(dp) :: impact_limit = 0.0_dp
      !> Wall time that a single motion may take [s]; 0: no limit
      real(dp) :: time_limit = 0.0_dp
      !> Of Newmark's method: eps of (36) [m], most iterations in a step, Newton's iteration or else the successive one, first
      !> iterate extrapolated or else the previous state
      real(dp) :: tolerance = 0.0_dp
      integer :: iteration_limit = 0
      logical :: by_newton = .true.
      logical :: extrapolate = .true.
   end type request_t

   !> State of a motion at the end of a period, or where it starts.
   type, public :: motion_state_t
      !> Whole periods done
      integer :: periods = 0
      !> Its numbers, named by module problem; none where nothing is known of it
      real(dp), allocatable :: numbers(:)
      !> Of the controlled engine: scaled Lienard variable [-], whether it stands for the velocity, so that the motion goes on as if
      !> it had never stopped, and whether the motion goes on by the implicit method
      real(dp) :: lienard_variable = 0.0_dp
      logical :: carried_on = .false.
      logical :: implicit = .false.
   end type motion_state_t

   !> What a motion cost.
   type, public :: motion_count_t
      !> Steps: of Newmark's grid, or of the controlled engine, those of returning periods too
      integer(int64) :: steps = 0
      !> Evaluations of the film by Newmark's method
      integer(int64) :: evaluations = 0
      !> Steps that were cut in two, cuts within cuts included
      integer(int64) :: cuts = 0
   end type motion_count_t

   !> How a motion ended, with the state at the end of its last whole period.
   type, extends(motion_state_t), public :: ending_t
      !> Status of scene_status
      integer :: status = status_complete
      !> Time reached, within a period too where the motion failed [s], and the film there [m]
      real(dp) :: time = 0.0_dp, film = 0.0_dp
      !> Flank whose film in nodes could not be followed, else 0, and its load [N]
      integer :: lost_film = 0
      real(dp) :: lost_load = 0.0_dp
      !> Periods after which a steady motion repeats, else 0
      integer :: orbit = 0
      !> Place of the known motion that it has come to, else 0: it is that motion then, and has no samples of its own
      integer :: known = 0
      !> Bound of the relative distance of the film from the motion that repeats [-]
      real(dp) :: distance = 0.0_dp
      !> Samples written: of whole periods, and of the one in which the motion failed
      integer :: samples = 0, samples_of_failure = 0
      !> Of films in nodes that came to their end: histories, as of module nodal_state
      real(dp), allocatable :: nodal(:)
      type(motion_count_t) :: count = motion_count_t()
   end type ending_t

   !> State from which a run can be extended: carried on from it, a motion is the same to the last bit as if it had never stopped.
   !> 0 periods: the start of the motion, nothing else counts.
   type, extends(motion_state_t), public :: checkpoint_t
      !> z'' [m/s2]
      real(dp) :: acceleration = 0.0_dp
      !> Of a run until steady: the states that its search looks back on
      type(orbit_watch_t) :: watch = orbit_watch_t()
      !> and, once it is over, the periods after which the motion repeats; 0: it goes on
      integer :: orbit = 0
      !> Cost so far
      type(motion_count_t) :: count = motion_count_t()
      !> Of films in nodes: their histories, as of module nodal_state
      real(dp), allocatable :: nodal(:)
   end type checkpoint_t

   !> Where a motion hands its samples, whole periods at a time. What becomes of them does not change the motion.
   type, abstract, public :: sample_sink_t
   contains
      procedure(take_samples), deferred :: take
      procedure(open_window), deferred :: begin_window
   end type sample_sink_t

   !> Watcher of a motion, called after every period.
   type, abstract, public :: motion_watcher_t
   contains
      procedure(watch_period), deferred :: period_done
   end type motion_watcher_t

   !> Watches nothing.
   type, extends(motion_watcher_t), public :: unwatched_t
   contains
      procedure :: period_done => pass_over
   end type unwatched_t

   abstract interface
      !> Take consecutive samples; the initial state comes alone as step 0.
      subroutine take_samples(self, first_step, force, states, acceleration, error)
         import :: dp, error_t, int64, sample_sink_t
         class(sample_sink_t), intent(inout) :: self
         !> Step of the first sample
         integer(int64), intent(in) :: first_step
         !> Applied force F, one per sample [N]
         real(dp), intent(in) :: force(:)
         !> Sample, number of its state
         real(dp), intent(in) :: states(:, :)
         !> Acceleration z'' [m/s2]
         real(dp), intent(in) :: acceleration(:)
         !> Set if the samples could not be kept
         type(error_t), allocatable, intent(out) :: error
      end subroutine take_samples

      !> Called before its first sample: where the window begins that the motion is judged by.
      subroutine open_window(self, first_step, samples)
         import :: int64, sample_sink_t
         class(sample_sink_t), intent(inout) :: self
         !> Step of its first sample
         integer(int64), intent(in) :: first_step
         !> How many samples it has
         integer, intent(in) :: samples
      end subroutine open_window

      !> Called with how far the motion is.
      subroutine watch_period(self, done, all)
         import :: motion_watcher_t
         class(motion_watcher_t), intent(inout) :: self
         !> Periods solved
         integer, intent(in) :: done
         !> Periods requested
         integer, intent(in) :: all
      end subroutine watch_period
   end interface

   public :: start_of, state_of_start, same_request, status_of_stop, last_search_period, reserved_periods

contains

   !> Do nothing.
   subroutine pass_over(self, done, all)
      class(unwatched_t), intent(inout) :: self
      integer, intent(in) :: done
      integer, intent(in) :: all

      ! Compilers warn of arguments that are not used.
      if (done > all .and. same_type_as(self, self)) return
   end subroutine pass_over

   !> Where the motion of a problem starts.
   elemental type(motion_state_t) function start_of(problem)
      type(problem_t), intent(in) :: problem

      start_of = motion_state_t(numbers=initial_state(problem))
   end function start_of

   !> State of a motion that starts elsewhere; contacts with numbers of their own have stood still for long.
   pure type(motion_state_t) function state_of_start(problem, start) result(state)
      type(problem_t), intent(in) :: problem
      type(motion_start_t), intent(in) :: start
      type(problem_t) :: moved

      moved = problem
      moved%initial_film = start%film
      moved%initial_velocity = start%velocity
      state = start_of(moved)
   end function state_of_start

   !> Whether two requests are the same for motions that are solved side by side.
   elemental logical function same_request(one, other)
      type(request_t), intent(in) :: one
      type(request_t), intent(in) :: other

      same_request = one%periods == other%periods .and. one%sampled_periods == other%sampled_periods .and. &
                      .not. abs(one%accuracy - other%accuracy) > 0.0_dp
   end function same_request

   !> Last period of a run until steady after which it may be found that the motion repeats: the longest orbit and
   !> the window have to follow.
   pure integer function last_search_period(periods, window)
      !> Most periods, and periods of the window at their end
      integer, intent(in) :: periods
      integer, intent(in) :: window

      last_search_period = periods - reserved_periods(window) - 1
   end function last_search_period

   !> Periods at the end of a run until steady of which each may belong to the window.
   pure integer function reserved_periods(window)
      !> Periods of the window
      integer, intent(in) :: window

      reserved_periods = max(window, longest_orbit)
   end function reserved_periods

   !> Whether a motion may go on, status_complete, or must stop between two periods and why.
   integer function status_of_stop(request, started) result(status)
      type(request_t), intent(in) :: request
      !> When it began, on the clock of wall_seconds [s]
      real(dp), intent(in) :: started

      status = status_complete
      if (caught_signal() /= 0) status = status_interrupted
      if (request%time_limit > 0.0_dp) then
         if (wall_seconds() - started > request%time_limit) status = status_time_limit
      end if
   end function status_of_stop

end module engine
