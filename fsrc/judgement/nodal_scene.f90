!> A scene whose films are solved in nodes of pressure: how it is followed, and its verification by twice as many nodes and a
!> tighter tolerance.
module nodal_scene
   use clock, only: wall_seconds
   use controlled_engine, only: solve_window
   use constants, only: pi
   use doubt, only: doubt_t, doubt_second_ending
   use engine, only: checkpoint_t, ending_t, motion_watcher_t, request_t, sample_sink_t, start_of, unwatched_t
   use errors, only: error_t
   use fine_window, only: window_t
   use finer_windows, only: integral_record
   use kinds, only: dp, int64
   use nodal_engine, only: solve_in_nodes
   use nodal_profiles, only: nodal_profiles_t
   use nodal_step, only: is_late, nodal_choice_t
   use node_extremes, only: seen_films, seen_loads, seen_net_load
   use problem, only: largest_applied_force, problem_t, state_size
   use scene_status, only: is_success, status_time_limit
   use scene_types, only: scene_t
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Share of the accuracy that is the tolerance of a step; bound of bending, beyond which films are solved in nodes, over the
   !> accuracy
   real(dp), parameter :: tolerance_share = 0.3_dp, bound_factor = 10.0_dp
   !> Largest bound: one percent of bending, and ten of alpha p
   real(dp), parameter :: largest_bound = 1.0e-2_dp
   !> S of the grid over the width of the widest contact, sqrt(2 H + 8 M/pi)
   real(dp), parameter :: width_factor = 1.6_dp
   !> Motion by the closure that tells the widest contact: its accuracy, and most periods of it
   real(dp), parameter :: closure_accuracy = 1.0e-5_dp
   integer, parameter :: closure_periods = 12, closure_samples = 64
   !> How much finer a verification is: nodes, and the tolerance
   integer, parameter :: more_nodes = 2
   real(dp), parameter :: tighter = 0.3_dp

   !> Keeps the window of a motion.
   type, extends(sample_sink_t), public :: window_keeper_t
      real(dp), allocatable :: states(:, :), accelerations(:)
      integer(int64) :: first = huge(1_int64)
      integer :: numbers = 0
   contains
      procedure :: take => keep_samples
      procedure :: begin_window => make_room
   end type window_keeper_t

   public :: choice_of, solve_nodal_scene, solve_finer

contains

   !> How a scene is followed. A motion by the closure tells how wide its contacts become.
   subroutine choice_of(scene, problem, choice)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What moves
      type(problem_t), intent(in) :: problem
      type(nodal_choice_t), intent(out) :: choice
      type(problem_t) :: by_closure
      type(ending_t) :: ending
      type(window_record_t) :: record
      real(dp), allocatable :: states(:, :), values(:)
      real(dp) :: film, load
      integer :: periods

      if (scene%solver%time_limit > 0.0_dp) choice%ends_at = wall_seconds() + scene%solver%time_limit
      choice%nodes = scene%film%nodes
      choice%tolerance = tolerance_share*scene%solver%accuracy
      choice%bound = min(largest_bound, bound_factor*scene%solver%accuracy)
      by_closure = problem
      by_closure%contact%film%in_nodes = .false.
      ! As many of any run, so that one that is carried on has the same grid.
      periods = closure_periods
      film = problem%initial_film
      load = largest_applied_force(problem)
      call solve_window(by_closure, start_of(by_closure), closure_accuracy, closure_samples, periods, periods, states, values, &
                        ending, record)
      if (is_success(ending%status)) then
         film = record%lowest(seen_films(1))%value
         ! The net load is as far below zero as the other film pushes back.
         load = max(record%highest(seen_loads(1))%value, -record%lowest(seen_net_load)%value)
      end if
      associate (oil => problem%contact%film%closure)
         choice%scale = width_factor*sqrt(2.0_dp*film/oil%film_unit + 8.0_dp/pi*load/oil%load_unit)
      end associate

   end subroutine choice_of

   !> Solve a scene.
   subroutine solve_nodal_scene(scene, problem, choice, request, sink, watcher, ending, record, error, profiles, checkpoint)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What moves
      type(problem_t), intent(in) :: problem
      !> How it is followed
      type(nodal_choice_t), intent(in) :: choice
      !> What is asked for
      type(request_t), intent(in) :: request
      !> Takes the samples
      class(sample_sink_t), intent(inout) :: sink
      !> Told of progress
      class(motion_watcher_t), intent(inout) :: watcher
      !> How it ended
      type(ending_t), intent(out) :: ending
      !> What its steps tell of the window, Fourier integrals too: samples would have to be solved for once more
      type(window_record_t), intent(out) :: record
      !> Set if the sink failed
      type(error_t), allocatable, intent(out) :: error
      !> What is asked for of pressures and films over the contact, and then those of the window
      type(nodal_profiles_t), intent(inout), optional :: profiles
      !> State to carry on from, and then the one from which the run can be extended; absent: from rest
      type(checkpoint_t), intent(inout), optional :: checkpoint
      type(checkpoint_t) :: state

      if (present(checkpoint)) state = checkpoint
      record = integral_record(scene%spectrum)
      record%wants = .true.
      record%loads%impact_limit = request%impact_limit
      call solve_in_nodes(problem, choice, request, sink, watcher, state, ending, record, error, profiles)
      if (present(checkpoint)) checkpoint = state
   end subroutine solve_nodal_scene

   !> The window of a scene, solved finer, unless the time of the scene is over.
   subroutine solve_finer(scene, problem, choice, request, periods, window, ending, goes_on)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What moves
      type(problem_t), intent(in) :: problem
      !> How it was followed
      type(nodal_choice_t), intent(in) :: choice
      !> What was asked for
      type(request_t), intent(in) :: request
      !> Periods that were solved
      integer, intent(in) :: periods
      !> On entry periods and samples, on return the window
      type(window_t), intent(inout) :: window
      !> How it ended; where it goes on, how it ended before
      type(ending_t), intent(inout) :: ending
      !> Whether it goes on from there; absent: no
      logical, intent(in), optional :: goes_on
      type(checkpoint_t) :: state
      type(nodal_choice_t) :: finer
      type(request_t) :: again
      type(window_keeper_t) :: keeper
      type(unwatched_t) :: nobody
      type(error_t), allocatable :: error

      ending%status = status_time_limit
      if (is_late(choice)) return
      finer = choice
      finer%nodes = more_nodes*choice%nodes
      finer%tolerance = tighter*choice%tolerance
      finer%bound = tighter*choice%bound
      again = request
      again%periods = periods
      again%sampled_periods = window%periods
      again%until_steady = .false.
      keeper%numbers = state_size(problem)
      if (present(goes_on)) then
         if (goes_on) state = checkpoint_t(periods=ending%periods, numbers=ending%numbers, nodal=ending%nodal)
      end if
      call solve_nodal_scene(scene, problem, finer, again, keeper, nobody, ending, window%record, error, checkpoint=state)
      if (.not. is_success(ending%status)) return
      call move_alloc(keeper%states, window%states)
      call move_alloc(keeper%accelerations, window%accelerations)
   end subroutine solve_finer

   !> Keep what belongs to the window.
   subroutine keep_samples(self, first_step, force, states, acceleration, error)
      class(window_keeper_t), intent(inout) :: self
      integer(int64), intent(in) :: first_step
      real(dp), intent(in) :: force(:)
      real(dp), intent(in) :: states(:, :)
      real(dp), intent(in) :: acceleration(:)
      type(error_t), allocatable, intent(out) :: error
      integer :: place

      if (first_step < self%first) return
      place = int(first_step - self%first) + 1
      self%states(place:place + size(force) - 1, :) = states
      self%accelerations(place:place + size(force) - 1) = acceleration
   end subroutine keep_samples

   !> Make room for the window.
   subroutine make_room(self, first_step, samples)
      class(window_keeper_t), intent(inout) :: self
      integer(int64), intent(in) :: first_step
      integer, intent(in) :: samples

      if (allocated(self%states)) deallocate (self%states, self%accelerations)
      allocate (self%states(samples, self%numbers), self%accelerations(samples))
      self%first = first_step
   end subroutine make_room

end module nodal_scene
