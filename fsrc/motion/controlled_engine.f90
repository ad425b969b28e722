!> Single motion by the controlled engine: the same lanes as in a campaign, one of them used.
!>
!> The motion is solved in blocks of periods, each carried on from the one before to the last bit, with the samples that are wanted.
!> A run that stops once the motion repeats looks for that block by block, and then solves the one orbit that it is judged by.
module controlled_engine
   use clock, only: wall_seconds
   use engine, only: checkpoint_t, ending_t, last_search_period, motion_state_t, motion_watcher_t, request_t, reserved_periods, &
      sample_sink_t, start_of, status_of_stop
   use errors, only: error_t
   use force, only: force_at, force_of_period
   use kinds, only: dp, int64
   use many_motions, only: solve_motions
   use carried_loads, only: acceleration_at, accelerations_of_samples
   use problem, only: of_film, problem_t, state_size
   use repetition, only: orbit_watch_t
   use scene_status, only: is_success, status_complete, status_interrupted, status_steady
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Samples of a block: the time limit waits no longer than these take.
   integer, parameter :: block_samples = 65536
   !> Periods of a block without samples.
   integer, parameter :: block_periods = 256

   public :: solve_controlled, solve_window

contains

   !> Solve the motion of a problem.
   subroutine solve_controlled(problem, request, sink, watcher, checkpoint, ending, record, error)
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
      !> Record of the steps of the window
      type(window_record_t), intent(out) :: record
      !> Set if the sink failed
      type(error_t), allocatable, intent(out) :: error
      type(motion_state_t) :: here
      real(dp) :: started
      integer :: periods, window

      started = wall_seconds()
      ending%status = problem%contact%film%status_without_load
      if (.not. problem%initial_film > 0.0_dp) return
      ending%status = status_complete
      ending%count%evaluations = checkpoint%count%evaluations
      if (checkpoint%periods > 0) then
         here = checkpoint%motion_state_t
      else
         here = start_of(problem)
         call sink%take(0_int64, [force_at(problem%force, 0.0_dp)], reshape(here%numbers, [1, size(here%numbers)]), &
                        [acceleration_at(problem, here%numbers, 0.0_dp)], error)
         if (allocated(error)) return
      end if
      periods = request%periods
      window = request%sampled_periods
      if (request%until_steady) then
         call search_blocks(problem, request, here, started, sink, watcher, checkpoint, ending, error)
         if (allocated(error) .or. ending%status /= status_complete) return
         ending%orbit = checkpoint%orbit
         if (ending%orbit > 0) then
            window = ending%orbit
            periods = checkpoint%periods + window
         end if
      end if
      call solve_blocks(problem, request, here, started, periods, window, sink, watcher, checkpoint, ending, record, error)
      if (ending%orbit > 0 .and. ending%status == status_complete) ending%status = status_steady
   end subroutine solve_controlled

   !> States and accelerations of the last periods of a motion, the record of its steps, and how it ended.
   subroutine solve_window(problem, start, accuracy, samples_per_period, periods, window, states, values, ending, record, &
                           impact_limit, until_steady)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Where the motion starts
      type(motion_state_t), intent(in) :: start
      !> Relative accuracy [-]
      real(dp), intent(in) :: accuracy
      !> Samples of a period
      integer, intent(in) :: samples_per_period
      !> Periods to solve, and how many of the last are sampled
      integer, intent(in) :: periods
      integer, intent(in) :: window
      !> Sample, number of its state; and z'' [m/s2]
      real(dp), allocatable, intent(out) :: states(:, :)
      real(dp), allocatable, intent(out) :: values(:)
      !> How it ended
      type(ending_t), intent(out) :: ending
      !> Record of the steps of the last periods
      type(window_record_t), intent(out) :: record
      !> Multiple of the largest force above which loads are impacts, where these are requested
      real(dp), intent(in), optional :: impact_limit
      !> Whether the motion ends where it repeats; what is sampled is then what repeats. Absent: all periods
      logical, intent(in), optional :: until_steady
      type(request_t) :: request
      type(ending_t) :: endings(1)
      type(window_record_t) :: records(1)
      real(dp), allocatable :: samples(:, :, :)
      integer :: sampled

      request = request_t(accuracy=accuracy, periods=periods, samples_per_period=samples_per_period, sampled_periods=window)
      if (present(until_steady)) request%until_steady = until_steady
      if (present(impact_limit)) records(1)%loads%impact_limit = impact_limit
      sampled = window
      if (request%until_steady) sampled = reserved_periods(window)
      allocate (samples(sampled*samples_per_period, state_size(problem), 1), source=start%numbers(of_film))
      call solve_motions([problem], [start], request, samples, endings, records=records)
      ending = endings(1)
      record = records(1)
      sampled = window*samples_per_period
      if (is_success(ending%status)) sampled = ending%samples
      allocate (states, source=samples(:sampled, :, 1))
      allocate (values(size(states, 1)))
      if (is_success(ending%status)) call accelerations_of_samples(problem, samples_per_period, states, values)
   end subroutine solve_window

   !> Solve block by block until the motion is found to repeat or the search must end. The checkpoint follows every block.
   subroutine search_blocks(problem, request, here, started, sink, watcher, checkpoint, ending, error)
      type(problem_t), intent(in) :: problem
      type(request_t), intent(in) :: request
      !> Where the motion stands
      type(motion_state_t), intent(inout) :: here
      real(dp), intent(in) :: started
      class(sample_sink_t), intent(inout) :: sink
      class(motion_watcher_t), intent(inout) :: watcher
      type(checkpoint_t), intent(inout) :: checkpoint
      type(ending_t), intent(inout) :: ending
      type(error_t), allocatable, intent(out) :: error
      type(request_t) :: block_request
      type(ending_t) :: endings(1), sampled
      type(orbit_watch_t) :: watches(1)
      real(dp) :: none(0, 2, 1)
      integer :: last, block

      block_request = request_t(accuracy=request%accuracy, until_steady=.true.)
      last = last_search_period(request%periods, request%sampled_periods)
      block = merge(sampled_block(request), block_periods, request%all_samples)
      watches(1) = checkpoint%watch
      do while (here%periods < last .and. checkpoint%orbit == 0)
         block_request%periods = min(last, here%periods + block)
         call solve_motions([problem], [here], block_request, none, endings, watches)
         ! Where the search ends follows only now: samples, if wanted, are made by solving the block again.
         if (request%all_samples) then
            call solve_sampled(problem, request, here, endings(1)%periods + merge(0, 1, can_go_on(endings(1)%status) .or. &
                                                                                  is_success(endings(1)%status)), &
                               sink, sampled, error=error)
            if (allocated(error)) return
            if (sampled%status == status_interrupted) then
               ! Samples are lacking: the run is carried on from the start of the block.
               call record_block(sampled, ending)
               return
            end if
         end if
         call record_block(endings(1), ending)
         if (.not. can_go_on(ending%status)) return
         here = endings(1)%motion_state_t
         checkpoint = checkpoint_at(here, ending)
         checkpoint%watch = watches(1)
         checkpoint%orbit = endings(1)%orbit
         if (ending%status /= status_complete) return
         call watcher%period_done(here%periods, request%periods)
         ending%status = status_of_stop(request, started)
         if (ending%status /= status_complete) return
      end do
   end subroutine search_blocks

   !> Solve up to a given period in blocks and hand over the samples that are wanted.
   subroutine solve_blocks(problem, request, here, started, periods, window, sink, watcher, checkpoint, ending, record, error)
      type(problem_t), intent(in) :: problem
      type(request_t), intent(in) :: request
      !> Where the motion stands
      type(motion_state_t), intent(inout) :: here
      real(dp), intent(in) :: started
      integer, intent(in) :: periods
      integer, intent(in) :: window
      class(sample_sink_t), intent(inout) :: sink
      class(motion_watcher_t), intent(inout) :: watcher
      type(checkpoint_t), intent(inout) :: checkpoint
      type(ending_t), intent(inout) :: ending
      type(window_record_t), intent(inout) :: record
      type(error_t), allocatable, intent(out) :: error
      type(request_t) :: block_request
      type(ending_t) :: endings(1)
      type(window_record_t) :: records(1)
      real(dp) :: none(0, 2, 1)
      integer :: samples, sampled_from, last

      samples = request%samples_per_period
      records(1)%loads%impact_limit = request%impact_limit
      sampled_from = merge(0, periods - window, request%all_samples)
      block_request = request_t(accuracy=request%accuracy)
      call sink%begin_window(int(periods - window, int64)*int(samples, int64) + 1_int64, window*samples)
      do while (here%periods < periods)
         if (here%periods < sampled_from) then
            block_request%periods = min(sampled_from, here%periods + block_periods)
            call solve_motions([problem], [here], block_request, none, endings)
         else
            ! A block ends where the window begins: from there the run can be carried on. The window is one block, as it is for
            ! motions side by side, so that its record counts as many returns.
            if (here%periods < periods - window) then
               last = min(periods - window, here%periods + sampled_block(request))
               call solve_sampled(problem, request, here, last, sink, endings(1), error=error)
            else
               call solve_sampled(problem, request, here, periods, sink, endings(1), records, error)
            end if
         end if
         if (allocated(error)) return
         call record_block(endings(1), ending)
         if (.not. can_go_on(ending%status)) return
         here = endings(1)%motion_state_t
         ! A search is carried on from where it ended, not from behind it.
         if (.not. request%until_steady .and. here%periods <= periods - window) checkpoint = checkpoint_at(here, ending)
         if (ending%status /= status_complete) return
         call watcher%period_done(here%periods, periods)
         record = records(1)
         if (here%periods == periods) return
         ending%status = status_of_stop(request, started)
         if (ending%status /= status_complete) return
      end do
   end subroutine solve_blocks

   !> Whether a motion can be carried on from where it stands: a signal leaves it at the end of a period.
   pure logical function can_go_on(status)
      integer, intent(in) :: status

      can_go_on = status == status_complete .or. status == status_interrupted
   end function can_go_on

   !> Periods of a block with samples.
   pure integer function sampled_block(request)
      type(request_t), intent(in) :: request

      sampled_block = max(1, block_samples/request%samples_per_period)
   end function sampled_block

   !> Solve the periods of a block, from where the motion stands, and hand over their samples; of a period in which the motion fails
   !> those before.
   subroutine solve_sampled(problem, request, here, last, sink, found, records, error)
      type(problem_t), intent(in) :: problem
      type(request_t), intent(in) :: request
      type(motion_state_t), intent(in) :: here
      !> Last period of the block
      integer, intent(in) :: last
      class(sample_sink_t), intent(inout) :: sink
      type(ending_t), intent(out) :: found
      !> Record of the steps, added to that of the steps before
      type(window_record_t), optional, intent(inout) :: records(:)
      type(error_t), allocatable, intent(out) :: error
      type(request_t) :: block_request
      type(ending_t) :: endings(1)
      real(dp), allocatable :: states(:, :, :), values(:), force(:)
      integer :: samples, first, last_of_period, last_sample

      samples = request%samples_per_period
      block_request = request_t(accuracy=request%accuracy, samples_per_period=samples, periods=last, &
                                sampled_periods=last - here%periods)
      allocate (states(block_request%sampled_periods*samples, state_size(problem), 1), source=0.0_dp)
      allocate (values(block_request%sampled_periods*samples), force(samples))
      call force_of_period(problem%force, force)
      call solve_motions([problem], [here], block_request, states, endings, records=records)
      found = endings(1)
      last_sample = found%samples + found%samples_of_failure
      call accelerations_of_samples(problem, samples, states(:last_sample, :, 1), values(:last_sample))
      do first = 1, last_sample, samples
         last_of_period = min(first + samples - 1, last_sample)
         call sink%take(int(here%periods, int64)*int(samples, int64) + int(first, int64), force(:last_of_period - first + 1), &
                        states(first:last_of_period, :, 1), values(first:last_of_period), error)
         if (allocated(error)) return
      end do
   end subroutine solve_sampled

   !> Checkpoint where a motion stands, with what it cost.
   pure type(checkpoint_t) function checkpoint_at(here, ending) result(checkpoint)
      type(motion_state_t), intent(in) :: here
      type(ending_t), intent(in) :: ending

      checkpoint%motion_state_t = here
      checkpoint%count%evaluations = ending%count%evaluations
   end function checkpoint_at

   !> How far the motion is after a block.
   pure subroutine record_block(found, ending)
      type(ending_t), intent(in) :: found
      type(ending_t), intent(inout) :: ending

      ending%motion_state_t = found%motion_state_t
      ending%status = merge(status_complete, found%status, is_success(found%status))
      ending%time = found%time
      ending%film = found%film
      ending%count%evaluations = ending%count%evaluations + found%count%steps
      ending%count%steps = ending%count%evaluations
   end subroutine record_block

end module controlled_engine
