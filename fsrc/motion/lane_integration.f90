!> Many motions, a block of lanes at a time, each lane with its own time and step.
!>
!> A lane whose scene is done takes the next one; a lane without a scene rests. Every lane goes through the
!> same instructions whatever its neighbours do, and no number of one lane enters another: a scene has the
!> same bits alone, in any lane, in any company.
!>
!> The steps are Taylor series where the film law has one, or collocation. Taylor steps are explicit, and as
!> short as the damping of the film makes them: a scene that needs too many of them in one period ends with
!> status_not_converged at the start of that period, for collocation to go on.
module lane_integration
   use collocation_step, only: take_collocation_step
   use elastic_step, only: advance_contacts, take_elastic_step
   use elastic_tangents, only: place_tangents, tangents_in_units
   use engine, only: ending_t, motion_count_t, motion_state_t, request_t
   use film_series, only: series_of, set_coefficients
   use kinds, only: dp, int64
   use known_motions, only: known_motions_t
   use lane_advance, only: advance, largest_series_rate, shortest_step, take_series_step
   use lane_block, only: load_problem, lost_film, place_block, rest_lane, start_period, start_status
   use lane_functions, only: lanes
   use lane_repetition, only: find_repetition, look_for_known, restore_departure
   use lane_run, only: lane_run_t, lane_watch_t
   use lane_state, only: place_inner, place_state, state_of_lane, take_state, thinner_scaled_film, velocity_of_lane
   use lane_sampling, only: begin_samples, end_samples, lane_samples_t, take_samples
   use problem, only: has_inner_numbers, of_film, problem_t, state_size
   use repetition, only: orbit_watch_t, recurrence_t, start_watch
   use scene_status, only: is_success, status_complete, status_film_lost, status_interrupted, status_not_converged
   use signals, only: must_stop
   use step_nodes, only: take_nodes
   use window_record, only: record_period, start_record, window_record_t
   implicit none(type, external)
   private

   !> More Taylor steps in a period cost more than collocation; more steps of collocation lead nowhere.
   real(dp), parameter :: most_series_steps = 3000.0_dp, most_implicit_steps = 1.0e5_dp
   !> Steps of collocation that a motion may take in all, once and for each of its periods. Of the ready inputs and 2400 random scenes
   !> of the stress study the longest take 431 000 in 191 periods, 546 000 in seven, as tests do.
   real(dp), parameter :: most_steps_once = 7.0e5_dp, most_steps_in_mean = 1.5e3_dp

   public :: integrate_lanes

contains

   !> Solve scenes, by Taylor series (all of one film law that has one) or by collocation.
   subroutine integrate_lanes(by_series, problems, starts, queue, request, states, endings, watches, records, known, displacements)
      !> Taylor series, else collocation
      logical, intent(in) :: by_series
      !> What moves, and where each motion starts
      type(problem_t), intent(in) :: problems(:)
      type(motion_state_t), intent(in) :: starts(:)
      !> Those of them to be solved, in the order in which lanes take them
      integer, intent(in) :: queue(:)
      !> What is requested
      type(request_t), intent(in) :: request
      !> Samples: sample, number of its state, scene
      real(dp), contiguous, intent(inout) :: states(:, :, :)
      !> How the motions ended; on entry the steps they took before
      type(ending_t), intent(inout) :: endings(:)
      !> What the watchers of the scenes carried on have seen, kept up
      type(orbit_watch_t), optional, intent(inout) :: watches(:)
      !> Records of the steps of the sampled periods, scene by scene; that of a motion that begins within its sampled periods is
      !> kept and added to
      type(window_record_t), optional, intent(inout) :: records(:)
      !> Periodic motions that are known, scene by scene
      type(known_motions_t), optional, intent(in) :: known(:)
      !> Small displacements of the starts of motions that have tangents, then of their ends: number of the state, displacement,
      !> scene
      real(dp), optional, allocatable, intent(inout) :: displacements(:, :, :)
      type(lane_run_t) :: run
      real(dp), allocatable, target :: room(:)
      integer :: l, events

      call place_block(room, run%block)
      run%request = request
      run%by_series = by_series
      if (size(queue) > 0) run%series = series_of(problems(queue(1)))
      if (size(queue) > 0) run%own_numbers = has_inner_numbers(problems(queue(1)))
      run%most_steps = merge(most_series_steps, most_implicit_steps, by_series)
      run%largest_rate = merge(largest_series_rate, huge(1.0_dp), by_series)
      run%samples%per_period = request%samples_per_period
      do l = 1, lanes
         call next_scene(l, problems, starts, queue, run, endings, watches, records, displacements)
      end do
      do while (run%active > 0)
         if (must_stop()) exit
         if (by_series) then
            call take_series_step(run%series, run%block)
         else if (run%own_numbers) then
            call take_elastic_step(run%contacts, run%watches%scene > 0, run%block, run%inner, run%tangents)
         else
            call take_collocation_step(run%contacts, run%watches%scene > 0, run%block)
         end if
         if (run%samples%sampled_lanes > 0) then
            call take_samples(run%block, run%inner, run%samples, states)
            if (present(records)) call take_lane_nodes(records, run)
         end if
         if (run%own_numbers) call advance_contacts(run%block, run%inner)
         call advance(run%most_steps, run%largest_rate, run%block, events)
         if (events == 0) cycle
         do l = 1, lanes
            if (run%watches(l)%scene == 0) then
               call rest_lane(l, run%block)
               cycle
            end if
            if (run%block%remaining(l) <= 0.0_dp) then
               call end_period(l, problems, states, run, records, known)
               if (takes_too_long(run%watches(l), by_series)) call give_up(l, run)
            else if (in_trouble(l, run) .and. run%watches(l)%departure%period > 0) then
               run%watches(l)%ending%count%steps = run%watches(l)%ending%count%steps + nint(run%block%period_steps(l), int64)
               call start_period(l, run%block)
               call restore_departure(l, run)
            else if (in_trouble(l, run)) then
               call give_up(l, run)
            end if
            if (run%watches(l)%period < run%watches(l)%last_period) cycle
            if (present(displacements)) displacements(:size(run%watches(l)%state), :, run%watches(l)%scene) = &
               tangents_in_units(run%tangents(l), l, run%block)
            call finish(l, problems, run, endings, watches)
            call next_scene(l, problems, starts, queue, run, endings, watches, records, displacements)
         end do
      end do
      if (run%active > 0) call interrupt(problems, starts, queue, run, endings, watches)
   end subroutine integrate_lanes

   !> Put the next scene that can start into a lane.
   pure subroutine next_scene(lane, problems, starts, queue, run, endings, watches, records, displacements)
      integer, intent(in) :: lane
      type(problem_t), intent(in) :: problems(:)
      type(motion_state_t), intent(in) :: starts(:)
      integer, intent(in) :: queue(:)
      type(lane_run_t), intent(inout) :: run
      type(ending_t), intent(inout) :: endings(:)
      type(orbit_watch_t), optional, intent(in) :: watches(:)
      type(window_record_t), optional, intent(inout) :: records(:)
      !> As of integrate_lanes
      real(dp), optional, allocatable, intent(in) :: displacements(:, :, :)
      integer :: scene, status

      run%watches(lane) = lane_watch_t()
      do while (run%taken < size(queue))
         run%taken = run%taken + 1
         scene = queue(run%taken)
         status = start_status(problems(scene), starts(scene))
         endings(scene) = ending_at(starts(scene), status,.not. run%by_series, endings(scene)%count)
         if (status /= status_complete .or. run%request%periods <= starts(scene)%periods) cycle
         call load_problem(problems(scene), starts(scene), run%request%accuracy, lane, run%block)
         call place_inner(problems(scene), starts(scene), run%inner(lane))
         if (run%by_series) call set_coefficients(problems(scene), starts(scene)%carried_on, lane, run%block)
         run%contacts(lane) = problems(scene)%contact
         if (present(displacements)) call place_tangents(displacements(:state_size(problems(scene)), :, scene), lane, run%block, &
                                                         run%tangents(lane))
         associate (watch => run%watches(lane))
            watch%scene = scene
            watch%ending%count = endings(scene)%count
            watch%period = starts(scene)%periods
            watch%last_period = run%request%periods
            watch%sample_from = max(0, run%request%periods - run%request%sampled_periods)
            allocate (watch%state(state_size(problems(scene))))
            call take_state(lane, run%block, run%inner(lane), watch%state)
            allocate (watch%weights(state_size(problems(scene))), source=1.0_dp)
            if (run%inner(lane)%count > 0) watch%weights(size(watch%weights) - size(run%inner(lane)%now) + 1:) = &
               run%inner(lane)%counts_as/run%block%film_scale(lane)
            call start_watch(watch%state, thinner_scaled_film(watch%state, lane, run%block), watch%states)
            watch%departure%period = 0
            watch%excursions = 0
            if (present(watches) .and. starts(scene)%carried_on) watch%states = watches(scene)
         end associate
         run%samples%written(lane) = samples_before(run%watches(lane), run%samples)
         run%samples%column(lane) = scene
         if (present(records)) then
            run%nodes(lane)%pieces = 0
            if (run%watches(lane)%period < run%watches(lane)%sample_from) records(scene)%periods = 0
         end if
         if (run%watches(lane)%period >= run%watches(lane)%sample_from) call begin_period(lane, run, records)
         return
      end do
      run%active = run%active - 1
      call rest_lane(lane, run%block)
   end subroutine next_scene

   !> Begin a period that is sampled, and its window if it is the first one.
   pure subroutine begin_period(lane, run, records)
      integer, intent(in) :: lane
      type(lane_run_t), intent(inout) :: run
      type(window_record_t), optional, intent(inout) :: records(:)
      type(motion_state_t) :: start

      call begin_samples(run%samples, lane)
      ! So the returns of a window are found after as many of its periods, whatever came before.
      if (run%watches(lane)%period == run%watches(lane)%sample_from) run%watches(lane)%past = recurrence_t()
      if (.not. present(records)) return
      associate (record => records(run%watches(lane)%scene))
         if (record%periods > 0) return
         start = state_of_lane(lane, run%block, run%inner(lane))
         start%implicit = .not. run%by_series
         call start_record(start, record)
      end associate
   end subroutine begin_period

   !> Nodes of the present steps of the lanes whose periods are sampled.
   pure subroutine take_lane_nodes(records, run)
      type(window_record_t), intent(in) :: records(:)
      type(lane_run_t), intent(inout) :: run
      integer :: l

      do l = 1, lanes
         if (run%samples%sampled(l) .and. run%block%accepted(l) > 0.0_dp) &
            call take_nodes(run%block, l, run%inner(l), records(run%watches(l)%scene)%longest_piece, run%nodes(l))
      end do
   end subroutine take_lane_nodes

   !> Samples of the periods before this one.
   pure integer function samples_before(watch, samples)
      type(lane_watch_t), intent(in) :: watch
      type(lane_samples_t), intent(in) :: samples

      samples_before = max(0, watch%period - watch%sample_from)*samples%per_period
   end function samples_before

   !> A period has ended: does the motion repeat, are samples due?
   pure subroutine end_period(lane, problems, states, run, records, known)
      integer, intent(in) :: lane
      type(problem_t), intent(in) :: problems(:)
      real(dp), contiguous, intent(inout) :: states(:, :, :)
      type(lane_run_t), intent(inout) :: run
      type(window_record_t), optional, intent(inout) :: records(:)
      type(known_motions_t), optional, intent(in) :: known(:)

      associate (watch => run%watches(lane), block => run%block)
         if (present(records) .and. run%samples%sampled(lane)) &
            call record_period(problems(watch%scene), velocity_of_lane(lane, block), run%nodes(lane), records(watch%scene))
         watch%ending%count%steps = watch%ending%count%steps + nint(block%period_steps(lane), int64)
         call start_period(lane, block)
         watch%period = watch%period + 1
         call take_state(lane, block, run%inner(lane), watch%state)
         if (present(known)) call look_for_known(lane, problems(watch%scene), known(watch%scene), run)
         if (watch%ending%known == 0) call find_repetition(lane, problems(watch%scene), states, run)
         if (watch%period >= watch%sample_from .and. watch%period < watch%last_period) call begin_period(lane, run, records)
      end associate
   end subroutine end_period

   !> The scene of a lane goes no further; its state is that at the start of the period.
   pure subroutine give_up(lane, run)
      integer, intent(in) :: lane
      type(lane_run_t), intent(inout) :: run

      associate (watch => run%watches(lane), block => run%block)
         watch%ending%status = status_not_converged
         if (block%film(lane, 0) < lost_film .or. block%film(lane, 0) > block%widest_film(lane)) &
            watch%ending%status = status_film_lost
         if (block%no_load(lane)) watch%ending%status = run%contacts(lane)%film%status_without_load
         watch%phase = block%phase(lane)
         watch%film = block%film(lane, 0)*block%film_scale(lane)
         watch%ending%count%steps = watch%ending%count%steps + nint(block%period_steps(lane), int64)
         ! The motion is carried on, by other steps, from the start of the period that was not finished.
         watch%ending%samples_of_failure = run%samples%written(lane) - samples_before(watch, run%samples)
         run%samples%written(lane) = samples_before(watch, run%samples)
         run%nodes(lane)%pieces = 0
         call place_state(watch%state, lane, block, run%inner(lane))
         watch%last_period = watch%period
      end associate
   end subroutine give_up

   !> Leave the scenes that are under way at the start of their period, and those that wait where they are.
   pure subroutine interrupt(problems, starts, queue, run, endings, watches)
      type(problem_t), intent(in) :: problems(:)
      type(motion_state_t), intent(in) :: starts(:)
      integer, intent(in) :: queue(:)
      type(lane_run_t), intent(inout) :: run
      type(ending_t), intent(inout) :: endings(:)
      type(orbit_watch_t), optional, intent(inout) :: watches(:)
      integer :: l, i

      do l = 1, lanes
         if (run%watches(l)%scene == 0) cycle
         if (run%watches(l)%departure%period > 0) call restore_departure(l, run)
         ! What was done of the period does not count: it is solved again when the motion is carried on.
         run%watches(l)%ending%status = status_interrupted
         run%samples%written(l) = samples_before(run%watches(l), run%samples)
         call place_state(run%watches(l)%state, l, run%block, run%inner(l))
         call finish(l, problems, run, endings, watches)
      end do
      do i = run%taken + 1, size(queue)
         associate (scene => queue(i))
            endings(scene) = ending_at(starts(scene), status_interrupted, starts(scene)%implicit, endings(scene)%count)
         end associate
      end do
   end subroutine interrupt

   !> Ending of a motion that has not gone on from its start.
   pure type(ending_t) function ending_at(start, status, implicit, count) result(ending)
      type(motion_state_t), intent(in) :: start
      !> Why
      integer, intent(in) :: status
      !> Method that was to follow it
      logical, intent(in) :: implicit
      !> Cost so far
      type(motion_count_t), intent(in) :: count

      ending%motion_state_t = start
      if (allocated(start%numbers)) ending%film = start%numbers(of_film)
      ending%status = status
      ending%implicit = implicit
      ending%count = count
   end function ending_at

   !> Whether a motion that is to go on has taken more steps than lead anywhere.
   pure logical function takes_too_long(watch, by_series)
      type(lane_watch_t), intent(in) :: watch
      logical, intent(in) :: by_series

      takes_too_long = .not. by_series .and. watch%period < watch%last_period .and. &
                       real(watch%ending%count%steps, dp) > most_steps_once + most_steps_in_mean*real(watch%last_period, dp)
   end function takes_too_long

   !> Record the end of a motion.
   pure subroutine finish(lane, problems, run, endings, watches)
      integer, intent(in) :: lane
      type(problem_t), intent(in) :: problems(:)
      type(lane_run_t), intent(inout) :: run
      type(ending_t), intent(inout) :: endings(:)
      type(orbit_watch_t), optional, intent(inout) :: watches(:)

      if (present(watches)) watches(run%watches(lane)%scene) = run%watches(lane)%states
      associate (ending => run%watches(lane)%ending)
         ending%motion_state_t = state_of_lane(lane, run%block, run%inner(lane))
         ending%periods = run%watches(lane)%period
         ending%implicit = .not. run%by_series
         ending%time = (real(ending%periods, dp) + run%watches(lane)%phase)/problems(run%watches(lane)%scene)%frequency
         ending%film = ending%numbers(of_film)
         if (.not. is_success(ending%status) .and. ending%status /= status_interrupted) ending%film = run%watches(lane)%film
         ending%samples = run%samples%written(lane)
         endings(run%watches(lane)%scene) = ending
      end associate
      call end_samples(run%samples, lane)
   end subroutine finish

   !> Whether the motion of a lane cannot go on like this.
   pure logical function in_trouble(lane, run)
      integer, intent(in) :: lane
      type(lane_run_t), intent(in) :: run

      in_trouble = .not. (run%block%limit(lane) > shortest_step &
         .and. run%block%period_steps(lane) <= run%most_steps &
                          .and. run%block%film(lane, 0) > lost_film &
                          .and. run%block%film(lane, 0) < run%block%widest_film(lane) &
                          .and. run%block%damping_rate(lane) < run%largest_rate)
   end function in_trouble

end module lane_integration
