!> Motion of a single scene by the error-controlled engine: the same lanes as in a campaign, one of them used.
!>
!> A run that stops once the motion repeats is solved without samples first. How long it is then known, and the
!> samples that are wanted are made in blocks of periods, each carried on from the one before to the last bit.
module integrate_controlled
   use checkpoint, only: checkpoint_t
   use clock, only: wall_seconds
   use errors, only: error_t
   use film_law, only: film_t
   use forcing, only: applied_force, force_of_period
   use integrate_motion, only: motion_end_t, motion_watcher_t, time_is_up
   use kinds, only: dp, int64
   use lane_motions, only: accelerations, solve_motions
   use lane_scenes, only: lane_ending_t, lane_request_t, lane_scene_t
   use period_repetition, only: longest_orbit
   use sample_sink, only: sample_sink_t
   use scene_lane, only: lane_of_scene
   use scene_status, only: is_success, status_complete, status_interrupted, status_steady, status_time_limit
   use scene_types, only: scene_t, until_steady
   use signals, only: caught_signal
   implicit none(type, external)
   private

   !> Samples of a block: a signal waits no longer than these take.
   integer, parameter :: block_samples = 65536
   !> Periods of a block without samples.
   integer, parameter :: block_periods = 256

   public :: solve_controlled, solve_window, find_steady_motion

contains

   !> Solve the motion of a scene.
   subroutine solve_controlled(scene, film, initial_film, start, wants_all, sink, watcher, ending, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Its film
      type(film_t), intent(in) :: film
      !> Film at t = 0 [m]
      real(dp), intent(in) :: initial_film
      !> State to carry on from; 0 periods: start at t = 0. A run until steady always starts there.
      type(checkpoint_t), intent(in) :: start
      !> Whether the sink wants all samples, or those of the window only
      logical, intent(in) :: wants_all
      !> Takes the samples
      class(sample_sink_t), intent(inout) :: sink
      !> Told of progress
      class(motion_watcher_t), intent(inout) :: watcher
      !> How it ended
      type(motion_end_t), intent(out) :: ending
      !> Set if the sink failed
      type(error_t), allocatable, intent(out) :: error
      type(lane_scene_t) :: lane
      type(lane_ending_t) :: found
      integer :: periods, window

      ending%status = film%status_without_load
      if (.not. initial_film > 0.0_dp) return
      lane = lane_of_scene(scene, film, initial_film, scene%film%initial_velocity)
      periods = scene%solver%periods
      window = scene%spectrum%periods
      if (scene%solver%until == until_steady) then
         call find_steady_motion(lane, scene%solver%accuracy, periods, window, found)
         if (.not. is_success(found%status)) then
            call record_ending(scene, found, ending)
            return
         end if
         periods = found%periods
         if (found%orbit > 0) window = found%orbit
      end if
      call solve_blocks(scene, lane, start, periods, window, wants_all, sink, watcher, ending, error)
      if (ending%status == status_complete .and. scene%solver%until == until_steady .and. found%orbit > 0) then
         ending%status = status_steady
         ending%orbit = found%orbit
      end if
   end subroutine solve_controlled

   !> Films, velocities and accelerations of the last periods of a run, and how it ended.
   subroutine solve_window(scene, lane, accuracy, samples_per_period, periods, window, films, velocities, values, ending)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Its lane
      type(lane_scene_t), intent(in) :: lane
      !> Relative accuracy [-]
      real(dp), intent(in) :: accuracy
      !> Samples of a period
      integer, intent(in) :: samples_per_period
      !> Periods to solve, and how many of the last are sampled
      integer, intent(in) :: periods
      integer, intent(in) :: window
      !> h [m], z' [m/s], z'' [m/s2]
      real(dp), allocatable, intent(out) :: films(:)
      real(dp), allocatable, intent(out) :: velocities(:)
      real(dp), allocatable, intent(out) :: values(:)
      !> How it ended
      type(lane_ending_t), intent(out) :: ending
      type(lane_request_t) :: request
      type(lane_ending_t) :: endings(1)
      real(dp), allocatable :: film_samples(:, :), velocity_samples(:, :)

      request%accuracy = accuracy
      request%periods = periods
      request%samples_per_period = samples_per_period
      request%sampled_periods = window
      allocate (film_samples(window*samples_per_period, 1), velocity_samples(window*samples_per_period, 1), &
                source=scene%film%initial_film)
      call solve_motions([lane], request, film_samples, velocity_samples, endings)
      ending = endings(1)
      allocate (films, source=film_samples(:, 1))
      allocate (velocities, source=velocity_samples(:, 1))
      allocate (values(size(films)))
      if (is_success(ending%status)) call accelerations(lane, samples_per_period, films, velocities, values)
   end subroutine solve_window

   !> Solve until the motion repeats, without samples.
   subroutine find_steady_motion(lane, accuracy, periods, window, found)
      !> The scene
      type(lane_scene_t), intent(in) :: lane
      !> Relative accuracy [-]
      real(dp), intent(in) :: accuracy
      !> Most periods, and periods of the window at their end
      integer, intent(in) :: periods
      integer, intent(in) :: window
      !> How it ended
      type(lane_ending_t), intent(out) :: found
      type(lane_request_t) :: request
      type(lane_ending_t) :: endings(1)
      real(dp), allocatable :: no_films(:, :), no_velocities(:, :)

      request%accuracy = accuracy
      request%periods = periods
      request%until_steady = .true.
      request%samples_per_period = 1
      request%sampled_periods = max(window, longest_orbit)
      allocate (no_films(request%sampled_periods, 1), no_velocities(request%sampled_periods, 1), source=0.0_dp)
      call solve_motions([lane], request, no_films, no_velocities, endings)
      found = endings(1)
   end subroutine find_steady_motion

   !> Solve a known number of periods in blocks and hand over the samples that are wanted.
   subroutine solve_blocks(scene, lane, start, periods, window, wants_all, sink, watcher, ending, error)
      type(scene_t), intent(in) :: scene
      type(lane_scene_t), intent(in) :: lane
      type(checkpoint_t), intent(in) :: start
      integer, intent(in) :: periods
      integer, intent(in) :: window
      logical, intent(in) :: wants_all
      class(sample_sink_t), intent(inout) :: sink
      class(motion_watcher_t), intent(inout) :: watcher
      type(motion_end_t), intent(out) :: ending
      type(error_t), allocatable, intent(out) :: error
      type(lane_scene_t) :: carried
      type(lane_request_t) :: request
      type(lane_ending_t) :: endings(1)
      real(dp), allocatable :: films(:, :), velocities(:, :), values(:), force(:)
      real(dp) :: started, first(1)
      integer :: samples, block, done, sampled_from

      started = wall_seconds()
      samples = scene%solver%samples_per_period()
      sampled_from = merge(0, periods - window, wants_all)
      block = max(1, min(periods, block_samples/samples))
      allocate (films(block*samples, 1), velocities(block*samples, 1), source=0.0_dp)
      allocate (values(block*samples), force(samples))
      call force_of_period(scene%load%steady_force, scene%load%force_amplitude, force)
      request%accuracy = scene%solver%accuracy
      request%samples_per_period = samples
      carried = lane

      call sink%begin_window(int(periods - window, int64)*int(samples, int64) + 1_int64, window*samples)
      if (start%periods > 0) then
         carried%carried_on = .true.
         carried%periods_done = start%periods
         carried%implicit = start%implicit
         carried%initial_film = start%film
         carried%initial_velocity = start%velocity
         carried%initial_momentum = start%momentum
         ending%count%evaluations = start%evaluations
      else
         call accelerations_at_start(lane, first)
         call sink%take(0_int64, [applied_force(lane%steady_force, lane%force_amplitude, 0.0_dp)], [lane%initial_film], &
                        [lane%initial_velocity], first, error)
      end if
      ending%checkpoint = start
      done = start%periods
      do while (done < periods .and. .not. allocated(error))
         if (done < sampled_from) then
            request%sampled_periods = 0
            request%periods = min(sampled_from, done + block_periods)
         else
            request%periods = min(periods, done + block)
            ! A block ends where the window begins: from there the run can be carried on.
            if (done < periods - window) request%periods = min(request%periods, periods - window)
            request%sampled_periods = request%periods - done
         end if
         call solve_motions([carried], request, films, velocities, endings)
         call hand_over(lane, force, done, endings(1), films(:, 1), velocities(:, 1), values, sink, error)
         ending%count%evaluations = ending%count%evaluations + endings(1)%steps
         call record_ending(scene, endings(1), ending)
         if (allocated(error) .or. .not. is_success(endings(1)%status)) return
         done = request%periods
         call carry_on(endings(1), carried)
         if (done <= periods - window) ending%checkpoint = checkpoint_of(endings(1), ending%count%evaluations)
         call watcher%period_done(done, periods)
         if (done == periods) exit
         if (caught_signal() /= 0) ending%status = status_interrupted
         if (time_is_up(scene, started)) ending%status = status_time_limit
         if (ending%status /= status_complete) return
      end do
   end subroutine solve_blocks

   !> Samples of a block, period by period.
   subroutine hand_over(lane, force, done, ending, films, velocities, values, sink, error)
      type(lane_scene_t), intent(in) :: lane
      real(dp), intent(in) :: force(:)
      !> Periods before the block
      integer, intent(in) :: done
      type(lane_ending_t), intent(in) :: ending
      real(dp), intent(in) :: films(:)
      real(dp), intent(in) :: velocities(:)
      real(dp), intent(inout) :: values(:)
      class(sample_sink_t), intent(inout) :: sink
      type(error_t), allocatable, intent(out) :: error
      integer :: period, first, last

      call accelerations(lane, size(force), films(:ending%samples), velocities(:ending%samples), values(:ending%samples))
      do period = 1, ending%samples/size(force)
         first = (period - 1)*size(force) + 1
         last = period*size(force)
         call sink%take(int(done + period - 1, int64)*int(size(force), int64) + 1_int64, force, films(first:last), &
                        velocities(first:last), values(first:last), error)
         if (allocated(error)) return
      end do
   end subroutine hand_over

   !> z'' at t = 0, where no period ends.
   pure subroutine accelerations_at_start(lane, value)
      type(lane_scene_t), intent(in) :: lane
      real(dp), intent(out) :: value(1)

      call accelerations(lane, 1, [lane%initial_film], [lane%initial_velocity], value)
   end subroutine accelerations_at_start

   !> Make a lane start where a motion ended.
   pure subroutine carry_on(ending, lane)
      type(lane_ending_t), intent(in) :: ending
      type(lane_scene_t), intent(inout) :: lane

      lane%carried_on = .true.
      lane%periods_done = ending%periods
      lane%implicit = ending%implicit
      lane%initial_film = ending%film
      lane%initial_velocity = ending%velocity
      lane%initial_momentum = ending%momentum
   end subroutine carry_on

   !> State at the end of a lane's run, with what it cost.
   pure function checkpoint_of(ending, evaluations) result(here)
      type(lane_ending_t), intent(in) :: ending
      integer(int64), intent(in) :: evaluations
      type(checkpoint_t) :: here

      here%periods = ending%periods
      here%film = ending%film
      here%velocity = ending%velocity
      here%momentum = ending%momentum
      here%implicit = ending%implicit
      here%evaluations = evaluations
   end function checkpoint_of

   !> Ending of a lane as that of the motion.
   pure subroutine record_ending(scene, found, ending)
      type(scene_t), intent(in) :: scene
      type(lane_ending_t), intent(in) :: found
      type(motion_end_t), intent(inout) :: ending

      ending%status = merge(status_complete, found%status, is_success(found%status))
      ending%film = found%film
      ending%velocity = found%velocity
      ending%time = (real(found%periods, dp) + found%phase)/scene%load%frequency
      ending%periods = found%periods
      ending%count%steps = ending%count%evaluations
   end subroutine record_ending

end module integrate_controlled
