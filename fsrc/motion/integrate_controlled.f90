!> Motion of a single scene by the error-controlled engine: the same lanes as in a campaign, one of them used.
!>
!> The motion is solved in blocks of periods, each carried on from the one before to the last bit, with the samples
!> that are wanted. A run that stops once the motion repeats looks for that block by block, and then solves the one
!> orbit that it is judged by.
module integrate_controlled
   use checkpoint, only: checkpoint_t
   use clock, only: wall_seconds
   use errors, only: error_t
   use film_law, only: film_t
   use forcing, only: applied_force, force_of_period
   use integrate_motion, only: motion_end_t, motion_watcher_t, status_of_stop
   use kinds, only: dp, int64
   use lane_motions, only: solve_motions
   use lane_scenes, only: carried_on_from, lane_ending_t, lane_request_t, lane_scene_t
   use period_repetition, only: longest_orbit, orbit_watch_t
   use sample_accelerations, only: accelerations_of_samples
   use sample_sink, only: sample_sink_t
   use scene_lane, only: lane_of_scene
   use scene_status, only: is_success, status_complete, status_interrupted, status_steady
   use scene_types, only: scene_t, until_steady
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Samples of a block: the time limit waits no longer than these take.
   integer, parameter :: block_samples = 65536
   !> Periods of a block without samples.
   integer, parameter :: block_periods = 256

   public :: solve_controlled, solve_window, find_steady_motion, last_search_period, reserved_periods

contains

   !> Solve the motion of a scene.
   subroutine solve_controlled(scene, film, initial_film, start, wants_all, sink, watcher, ending, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Its film
      type(film_t), intent(in) :: film
      !> Film at t = 0 [m]
      real(dp), intent(in) :: initial_film
      !> State to carry on from; 0 periods: start at t = 0
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
      real(dp) :: started, first(1)
      integer :: periods, window

      started = wall_seconds()
      ending%status = film%status_without_load
      if (.not. initial_film > 0.0_dp) return
      ending%status = status_complete
      ending%checkpoint = start
      ending%count%evaluations = start%evaluations
      lane = lane_of_scene(scene, film, initial_film, scene%film%initial_velocity)
      if (start%periods > 0) then
         lane = lane_at(start, lane)
      else
         call accelerations_at_start(lane, first)
         call sink%take(0_int64, [applied_force(lane%steady_force, lane%force_amplitude, 0.0_dp)], [lane%initial_film], &
                        [lane%initial_velocity], first, error)
         if (allocated(error)) return
      end if
      periods = scene%solver%periods
      window = scene%spectrum%periods
      if (scene%solver%until == until_steady) then
         call search_blocks(scene, lane, started, wants_all, sink, watcher, ending, error)
         if (allocated(error) .or. ending%status /= status_complete) return
         ending%orbit = ending%checkpoint%orbit
         if (ending%orbit > 0) then
            window = ending%orbit
            periods = ending%checkpoint%periods + window
         end if
      end if
      call solve_blocks(scene, lane, started, periods, window, wants_all, sink, watcher, ending, error)
      if (ending%orbit > 0 .and. ending%status == status_complete) ending%status = status_steady
   end subroutine solve_controlled

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

   !> Films, velocities and accelerations of the last periods of a run, what its steps tell, and how it ended.
   subroutine solve_window(lane, accuracy, samples_per_period, periods, window, films, velocities, values, ending, record)
      !> Lane of the scene
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
      !> What the steps tell of the last periods
      type(window_record_t), intent(out) :: record
      type(lane_request_t) :: request
      type(lane_ending_t) :: endings(1)
      type(window_record_t) :: records(1)
      real(dp), allocatable :: film_samples(:, :), velocity_samples(:, :)

      request%accuracy = accuracy
      request%periods = periods
      request%samples_per_period = samples_per_period
      request%sampled_periods = window
      allocate (film_samples(window*samples_per_period, 1), velocity_samples(window*samples_per_period, 1), &
                source=lane%initial_film)
      call solve_motions([lane], request, film_samples, velocity_samples, endings, records=records)
      ending = endings(1)
      record = records(1)
      allocate (films, source=film_samples(:, 1))
      allocate (velocities, source=velocity_samples(:, 1))
      allocate (values(size(films)))
      if (is_success(ending%status)) call accelerations_of_samples(lane, samples_per_period, films, velocities, values)
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
      request%sampled_periods = reserved_periods(window)
      allocate (no_films(request%sampled_periods, 1), no_velocities(request%sampled_periods, 1), source=0.0_dp)
      call solve_motions([lane], request, no_films, no_velocities, endings)
      found = endings(1)
   end subroutine find_steady_motion

   !> Solve block by block until the motion is found to repeat or the search must end. The checkpoint follows every block.
   subroutine search_blocks(scene, lane, started, wants_all, sink, watcher, ending, error)
      type(scene_t), intent(in) :: scene
      !> The scene where it stands, carried on
      type(lane_scene_t), intent(inout) :: lane
      real(dp), intent(in) :: started
      logical, intent(in) :: wants_all
      class(sample_sink_t), intent(inout) :: sink
      class(motion_watcher_t), intent(inout) :: watcher
      type(motion_end_t), intent(inout) :: ending
      type(error_t), allocatable, intent(out) :: error
      type(lane_request_t) :: request
      type(lane_ending_t) :: endings(1), sampled
      type(orbit_watch_t) :: watches(1)
      real(dp) :: no_films(0, 1), no_velocities(0, 1)
      integer :: last, block

      request%accuracy = scene%solver%accuracy
      request%until_steady = .true.
      last = last_search_period(scene%solver%periods, scene%spectrum%periods)
      block = merge(sampled_block(scene), block_periods, wants_all)
      watches(1) = ending%checkpoint%watch
      do while (lane%periods_done < last .and. ending%checkpoint%orbit == 0)
         request%periods = min(last, lane%periods_done + block)
         call solve_motions([lane], request, no_films, no_velocities, endings, watches)
         ! Where the search ends is known only now: samples, if wanted, are made by solving the block again.
         if (wants_all) then
            call solve_sampled(scene, lane, endings(1)%periods, sink, sampled, error=error)
            if (allocated(error)) return
            if (sampled%status == status_interrupted) then
               ! Samples are lacking: the run is carried on from the start of the block.
               call record_block(scene, sampled, ending)
               return
            end if
         end if
         call record_block(scene, endings(1), ending)
         if (.not. can_go_on(ending%status)) return
         ending%checkpoint = checkpoint_of(endings(1), ending%count%evaluations)
         ending%checkpoint%watch = watches(1)
         ending%checkpoint%orbit = endings(1)%orbit
         lane = lane_at(ending%checkpoint, lane)
         if (ending%status /= status_complete) return
         call watcher%period_done(lane%periods_done, scene%solver%periods)
         ending%status = status_of_stop(scene, started)
         if (ending%status /= status_complete) return
      end do
   end subroutine search_blocks

   !> Solve up to a known period in blocks and hand over the samples that are wanted.
   subroutine solve_blocks(scene, lane, started, periods, window, wants_all, sink, watcher, ending, error)
      type(scene_t), intent(in) :: scene
      !> The scene where it stands, carried on
      type(lane_scene_t), intent(inout) :: lane
      real(dp), intent(in) :: started
      integer, intent(in) :: periods
      integer, intent(in) :: window
      logical, intent(in) :: wants_all
      class(sample_sink_t), intent(inout) :: sink
      class(motion_watcher_t), intent(inout) :: watcher
      type(motion_end_t), intent(inout) :: ending
      type(error_t), allocatable, intent(out) :: error
      type(lane_request_t) :: request
      type(lane_ending_t) :: endings(1)
      type(checkpoint_t) :: here
      type(window_record_t) :: records(1)
      real(dp) :: no_films(0, 1), no_velocities(0, 1)
      integer :: samples, sampled_from, last

      samples = scene%solver%samples_per_period()
      sampled_from = merge(0, periods - window, wants_all)
      request%accuracy = scene%solver%accuracy
      call sink%begin_window(int(periods - window, int64)*int(samples, int64) + 1_int64, window*samples)
      do while (lane%periods_done < periods)
         if (lane%periods_done < sampled_from) then
            request%periods = min(sampled_from, lane%periods_done + block_periods)
            call solve_motions([lane], request, no_films, no_velocities, endings)
         else
            last = min(periods, lane%periods_done + sampled_block(scene))
            ! A block ends where the window begins: from there the run can be carried on, and its steps are recorded.
            if (lane%periods_done < periods - window) then
               call solve_sampled(scene, lane, min(last, periods - window), sink, endings(1), error=error)
            else
               call solve_sampled(scene, lane, last, sink, endings(1), records, error)
            end if
         end if
         if (allocated(error)) return
         call record_block(scene, endings(1), ending)
         if (.not. can_go_on(ending%status)) return
         here = checkpoint_of(endings(1), ending%count%evaluations)
         lane = lane_at(here, lane)
         ! A search is carried on from where it ended, not from behind it.
         if (scene%solver%until /= until_steady .and. here%periods <= periods - window) ending%checkpoint = here
         if (ending%status /= status_complete) return
         call watcher%period_done(here%periods, periods)
         ending%record = records(1)
         if (here%periods == periods) return
         ending%status = status_of_stop(scene, started)
         if (ending%status /= status_complete) return
      end do
   end subroutine solve_blocks

   !> Whether a motion can be carried on from where it stands: a signal leaves it at the end of a period.
   pure logical function can_go_on(status)
      integer, intent(in) :: status

      can_go_on = status == status_complete .or. status == status_interrupted
   end function can_go_on

   !> Periods of a block with samples.
   pure integer function sampled_block(scene)
      type(scene_t), intent(in) :: scene

      sampled_block = max(1, block_samples/scene%solver%samples_per_period())
   end function sampled_block

   !> Solve the periods of a block, from where the lane stands, and hand over their samples.
   subroutine solve_sampled(scene, lane, last, sink, found, records, error)
      type(scene_t), intent(in) :: scene
      type(lane_scene_t), intent(in) :: lane
      !> Last period of the block
      integer, intent(in) :: last
      class(sample_sink_t), intent(inout) :: sink
      type(lane_ending_t), intent(out) :: found
      !> What the steps tell, added to what they told before
      type(window_record_t), optional, intent(inout) :: records(:)
      type(error_t), allocatable, intent(out) :: error
      type(lane_request_t) :: request
      type(lane_ending_t) :: endings(1)
      real(dp), allocatable :: films(:, :), velocities(:, :), values(:), force(:)
      integer :: samples

      samples = scene%solver%samples_per_period()
      request%accuracy = scene%solver%accuracy
      request%samples_per_period = samples
      request%periods = last
      request%sampled_periods = last - lane%periods_done
      allocate (films(request%sampled_periods*samples, 1), velocities(request%sampled_periods*samples, 1), source=0.0_dp)
      allocate (values(request%sampled_periods*samples), force(samples))
      call force_of_period(scene%load%steady_force, scene%load%force_amplitude, force)
      call solve_motions([lane], request, films, velocities, endings, records=records)
      call hand_over(lane, force, lane%periods_done, endings(1), films(:, 1), velocities(:, 1), values, sink, error)
      found = endings(1)
   end subroutine solve_sampled

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

      call accelerations_of_samples(lane, size(force), films(:ending%samples), velocities(:ending%samples), values(:ending%samples))
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

      call accelerations_of_samples(lane, 1, [lane%initial_film], [lane%initial_velocity], value)
   end subroutine accelerations_at_start

   !> A lane that starts where a motion ended.
   pure type(lane_scene_t) function lane_at(here, lane)
      type(checkpoint_t), intent(in) :: here
      type(lane_scene_t), intent(in) :: lane

      lane_at = carried_on_from(lane, here%film, here%velocity, here%momentum, here%implicit, here%periods)
   end function lane_at

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

   !> How far the motion is after a block.
   pure subroutine record_block(scene, found, ending)
      type(scene_t), intent(in) :: scene
      type(lane_ending_t), intent(in) :: found
      type(motion_end_t), intent(inout) :: ending

      ending%count%evaluations = ending%count%evaluations + found%steps
      ending%status = merge(status_complete, found%status, is_success(found%status))
      ending%film = found%film
      ending%velocity = found%velocity
      ending%time = (real(found%periods, dp) + found%phase)/scene%load%frequency
      ending%periods = found%periods
      ending%count%steps = ending%count%evaluations
   end subroutine record_block

end module integrate_controlled
