!> Solves and judges the scenes of a chunk: the kernels of the single scene, eight scenes to a register.
module solve_chunk
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use campaign_record, only: record_motions, record_number, record_row
   use automatic_model, only: nodes_stopped, reason_for_nodes, reason_t, scene_in_nodes, solve_in_memory
   use errors, only: error_t
   use engine, only: same_request, ending_t, motion_state_t, request_t, reserved_periods, start_of
   use judge_scene, only: note_record, note_regime
   use judged_scene, only: film_model_stopped, judged_scene_t, quantity_value
   use key_table, only: find_key
   use force, only: force_of, largest_oscillation
   use grid_blocks, only: block_scenes
   use group_verification, only: compared, verify_group
   use handed_motions, only: find_other_motions
   use kinds, only: dp, int64
   use memory_need, only: window_bytes
   use node_extremes, only: seen_quantities
   use periodic_orbit, only: periodic_orbit_t
   use quantities, only: asks_to_verify, need_count, needs_verification, needs_impacts, needs_motion_verdicts, needs_starts, &
      needs_of, needs_of_choice, needs_orbit, needs_regime, needs_spectrum, needs_verified_impacts, quantity_film_model
   use resolved_scene, only: engine_request => request_of, resolve, resolved_scene_t
   use row_motions, only: motion_from_rest, row_motions_t
   use sampling, only: chunk_values, largest_value, sample_plan_t
   use scene_group, only: classify_group, find_orbits, follow_group, scene_group_t, solve_group
   use scene_status, only: is_success, status_invalid
   use scene_types, only: least_static_load, method_taylor, scene_t, spectrum_choice_t
   use schedule, only: cost_order
   use signals, only: must_stop
   use varied_keys, only: is_valid_scene, set_varied_keys
   use verification, only: verification_t
   use window_impacts, only: impacts_of_record
   implicit none(type, external)
   private

   !> Most scenes solved together. A motion that never repeats takes many times the periods of the others; among this many
   !> there are enough of them to fill the lanes that the others have left.
   integer, parameter :: most_together = 2048
   !> Fewest, so that no lane stays empty; and what the samples of more than these may take [bytes]
   integer, parameter :: fewest_together = 16
   real(dp), parameter :: most_bytes = 2.0_dp**28

   !> Samples of a batch; kept from chunk to chunk, since the system takes its time to hand out fresh memory.
   type, public :: chunk_space_t
      private
      !> Scenes that are solved together, their tighter solutions, and whether their classes and impacts stand
      type(scene_group_t) :: group, tight
      type(verification_t), allocatable :: verifications(:)
      !> The scene judged last; its arrays serve the next one
      type(judged_scene_t) :: judged
   end type chunk_space_t

   public :: solve_scenes, solve_starts, scenes_of_block, chunk_bytes

contains

   !> Rows of consecutive scenes. They depend on the scenes alone, not on how they are cut into chunks. Where the work must
   !> stop, the rows are of no use.
   subroutine solve_scenes(base, plan, first, space, rows, error)
      !> Checked base scene
      type(scene_t), intent(in) :: base
      !> The plan
      type(sample_plan_t), intent(in) :: plan
      !> First scene
      integer(int64), intent(in) :: first
      !> Work space of this thread
      type(chunk_space_t), intent(inout) :: space
      !> One column of this array is the row of a scene
      real(dp), contiguous, intent(out) :: rows(:, :)
      !> Set if there is no memory for the samples of a scene; the rows are of no use then
      type(error_t), allocatable, intent(out) :: error
      real(dp), allocatable :: values(:, :)
      type(scene_t) :: scene
      logical :: needed(need_count)
      integer :: start, count, batch

      batch = scenes_together(base, plan)
      allocate (values(size(plan%positions), min(batch, size(rows, 2))))
      needed = needs_of(base%campaign%record)
      ! A single scene looks for its orbit while it is put to the test.
      needed(needs_orbit) = needed(needs_orbit) .and. base%spectrum%verify
      ! What tells whether the closure will do
      if (base%film%automatic) needed = needed .or. needs_of_choice()
      if (needed(needs_verification)) needed(compared) = .true.
      scene = base
      scene%resolved_input = ''
      do start = 1, size(rows, 2), batch
         if (must_stop()) return
         count = min(batch, size(rows, 2) - start + 1)
         call chunk_values(plan, first + int(start - 1, int64), values(:, :count))
         call solve_batch(scene, plan, values(:, :count), first + int(start - 1, int64), needed, space, &
                          rows(:, start:start + count - 1), error)
         if (allocated(error)) return
      end do
   end subroutine solve_scenes

   !> What the samples and steps of a scene take while its batch is solved [bytes]
   pure real(dp) function scene_bytes(base, plan)
      type(scene_t), intent(in) :: base
      type(sample_plan_t), intent(in) :: plan
      !> Two numbers a sample; turns of z'' between the nodes of a period; what is known of a scene before it is solved
      real(dp), parameter :: sample_bytes = 16.0_dp, period_bytes = 2048.0_dp, fixed_bytes = 8192.0_dp

      scene_bytes = fixed_bytes + window_periods(base, plan)*(period_bytes + sample_bytes* &
                                                              real(base%campaign%samples_per_period, dp))
      ! The tighter solution stands beside it, or the motion from another start.
      if (asks_to_verify(base%campaign%record) .or. has_starts(base)) scene_bytes = 2.0_dp*scene_bytes
   end function scene_bytes

   !> Most periods of a window.
   pure real(dp) function window_periods(base, plan)
      type(scene_t), intent(in) :: base
      type(sample_plan_t), intent(in) :: plan

      window_periods = real(reserved_periods(nint(largest_value(plan, find_key('spectrum', 'periods'), &
                                                                real(base%spectrum%periods, dp)))), dp)
   end function window_periods

   !> How many scenes are solved together: fewer where their samples are many.
   pure integer function scenes_together(base, plan)
      type(scene_t), intent(in) :: base
      type(sample_plan_t), intent(in) :: plan

      scenes_together = max(fewest_together, min(most_together, int(most_bytes/scene_bytes(base, plan))))
      ! Blocks are whole.
      associate (block => scenes_of_block(base, plan))
         scenes_together = max(1, scenes_together/block)*block
      end associate
   end function scenes_together

   !> Whether scenes are solved from more starts than one.
   pure logical function has_starts(base)
      type(scene_t), intent(in) :: base
      logical :: needed(need_count)

      needed = needs_of(base%campaign%record)
      has_starts = base%solver%starts > 1 .and. needed(needs_starts)
   end function has_starts

   !> Scenes that hand their motions to each other and have to be solved together: those of a block of the grid.
   pure integer function scenes_of_block(base, plan)
      !> Checked base scene
      type(scene_t), intent(in) :: base
      !> The plan
      type(sample_plan_t), intent(in) :: plan

      scenes_of_block = 1
      if (has_starts(base) .and. base%campaign%neighbours) scenes_of_block = block_scenes(plan)
   end function scenes_of_block

   !> Memory that a thread takes to solve a chunk [bytes].
   pure real(dp) function chunk_bytes(base, plan, scenes)
      !> Checked base scene
      type(scene_t), intent(in) :: base
      !> The plan
      type(sample_plan_t), intent(in) :: plan
      !> Scenes of the chunk
      integer(int64), intent(in) :: scenes

      chunk_bytes = scene_bytes(base, plan)*real(min(scenes, int(scenes_together(base, plan), int64)), dp) &
                    + window_bytes(window_periods(base, plan)*real(base%campaign%samples_per_period, dp))
   end function chunk_bytes

   !> Rows of a batch.
   subroutine solve_batch(scene, plan, values, first, needed, space, rows, error)
      !> Base scene; its varied keys are changed
      type(scene_t), intent(inout) :: scene
      !> The plan, values of the varied keys, and number of the first scene
      type(sample_plan_t), intent(in) :: plan
      real(dp), intent(in) :: values(:, :)
      integer(int64), intent(in) :: first
      !> What the columns need
      logical, intent(in) :: needed(:)
      type(chunk_space_t), intent(inout) :: space
      real(dp), intent(out) :: rows(:, :)
      !> Set if there is no memory for the samples of a scene
      type(error_t), allocatable, intent(out) :: error
      type(resolved_scene_t) :: resolved(size(values, 2))
      type(request_t) :: requests(size(values, 2))
      type(spectrum_choice_t) :: choices(size(values, 2))
      type(row_motions_t) :: found(size(values, 2))
      type(reason_t) :: reason
      real(dp) :: costs(size(values, 2))
      integer :: order(size(values, 2)), i, solved, together, start
      logical :: valid(size(values, 2)), in_nodes(size(values, 2))

      solved = 0
      in_nodes = .false.
      do i = 1, size(values, 2)
         call set_varied_keys(scene, plan%positions, values(:, i))
         valid(i) = is_valid_scene(scene, plan%positions, values(:, i))
         costs(i) = huge(1.0_dp)
         if (.not. valid(i)) cycle
         solved = solved + 1
         resolved(i) = resolve(scene)
         costs(i) = -likely_cost(scene, resolved(i))
         requests(i) = request_of(scene, needed)
         choices(i) = scene%spectrum
      end do
      call cost_order(costs, order)
      together = merge(solved, 1, alike(requests(order(:solved))))
      do start = 1, solved, max(1, together)
         associate (group => order(start:start + together - 1))
            call solve_side_by_side(resolved(group), start_of(resolved(group)%problem), choices(group), requests(order(start)), &
                                    needed, space, error)
            if (must_stop() .or. allocated(error)) return
            do i = 1, together
               call judge_scene_of(space%group, i, resolved(group(i)), needed, space%verifications(i), space%judged)
               call record_row(scene, first + int(group(i) - 1, int64), values(:, group(i)), space%judged, rows(:, group(i)))
               if (scene%film%automatic) then
                  reason = reason_for_nodes(space%judged, choices(group(i))%impact_limit)
                  in_nodes(group(i)) = reason%code > 0
               end if
               if (needed(needs_starts)) found(group(i)) = &
                  motion_from_rest(resolved(group(i))%problem, requests(group(i))%samples_per_period, i, space%group)
            end do
         end associate
      end do
      if (needed(needs_starts)) then
         do i = 1, size(found)
            if (.not. allocated(found(i)%settled)) allocate (found(i)%settled(0))
         end do
         if (has_starts(scene)) call find_other_motions(scene, plan, first, resolved, choices, requests, &
                                                        needed(needs_motion_verdicts), order(:solved), space%tight, found, error)
         if (must_stop() .or. allocated(error)) return
         do i = 1, solved
            space%judged%judged = allocated(found(order(i))%told%motions)
            space%judged%coexisting = found(order(i))%told
            call record_motions(scene, space%judged, rows(:, order(i)))
         end do
      end if
      do i = 1, size(values, 2)
         if (.not. in_nodes(i)) cycle
         call solve_row_in_nodes(scene, plan, values(:, i), first + int(i - 1, int64), needed, rows(:, i), error)
         if (must_stop() .or. allocated(error)) return
      end do
      call note_ending(resolved_scene_t(), ending_t(status=status_invalid), space%judged)
      do i = solved + 1, size(values, 2)
         call record_row(scene, first + int(order(i) - 1, int64), values(:, order(i)), space%judged, rows(:, order(i)))
      end do
   end subroutine solve_batch

   !> Solve a row again in nodes of pressure, as a single scene is. Where nodes stop, and where a motion does not start from rest, the
   !> row stays that of the closure.
   subroutine solve_row_in_nodes(scene, plan, values, number, needed, row, error)
      !> Base scene; its varied keys are changed
      type(scene_t), intent(inout) :: scene
      !> The plan, values of the varied keys, and number of the scene
      type(sample_plan_t), intent(in) :: plan
      real(dp), intent(in) :: values(:)
      integer(int64), intent(in) :: number
      !> What the columns need
      logical, intent(in) :: needed(:)
      !> By the closure, and then in nodes
      real(dp), intent(inout) :: row(:)
      !> Set if there is no memory for the samples of the scene
      type(error_t), allocatable, intent(out) :: error
      type(scene_t) :: single
      type(judged_scene_t) :: judged

      call set_varied_keys(scene, plan%positions, values)
      if (scene%film%initial_film > 0.0_dp .or. abs(scene%film%initial_velocity) > 0.0_dp) return
      single = scene_in_nodes(scene)
      single%solver%kept_per_period = scene%campaign%samples_per_period
      single%output%series = .false.
      single%spectrum%verify = needed(needs_verification)
      call solve_in_memory(single, judged, error)
      if (must_stop() .or. allocated(error)) return
      if (nodes_stopped(judged%status)) then
         call record_number(scene, quantity_film_model, film_model_stopped, row)
      else
         call record_row(scene, number, values, judged, row)
      end if
   end subroutine solve_row_in_nodes

   !> Solve scenes that ask for the same, find their classes, and whether they stand, as far as columns ask for it.
   subroutine solve_side_by_side(resolved, starts, choices, request, needed, space, error)
      type(resolved_scene_t), intent(in) :: resolved(:)
      !> Where each motion starts
      type(motion_state_t), intent(in) :: starts(:)
      !> Limits of their classes
      type(spectrum_choice_t), intent(in) :: choices(:)
      !> What is asked of the engine
      type(request_t), intent(in) :: request
      !> What the columns need
      logical, intent(in) :: needed(:)
      type(chunk_space_t), intent(inout) :: space
      !> Set if there is no memory for the samples of a scene
      type(error_t), allocatable, intent(out) :: error

      if (allocated(space%verifications)) deallocate (space%verifications)
      allocate (space%verifications(size(resolved)))
      associate (problems => resolved%problem)
         if (needed(needs_impacts)) then
            call solve_group(problems, starts, request, needed(:seen_quantities), space%group, choices%impact_limit)
         else
            call solve_group(problems, starts, request, needed(:seen_quantities), space%group)
         end if
         if (needed(needs_orbit)) call find_orbits(problems, space%group)
         if (any(needed([needs_spectrum, needs_verification]))) then
            call classify_group(problems, choices, resolved%noise_floor, request, space%group)
            call follow_group(problems, space%group)
         end if
      end associate
      if (allocated(space%group%error)) call move_alloc(space%group%error, error)
      if (must_stop() .or. allocated(error)) return
      if (needed(needs_verified_impacts)) then
         call verify_group(resolved, choices, method_taylor, request, space%group, space%tight, space%verifications, &
                           impacts_of_record(space%group%records(:size(resolved)), resolved%problem%frequency))
      else if (needed(needs_verification)) then
         call verify_group(resolved, choices, method_taylor, request, space%group, space%tight, space%verifications)
      end if
      if (allocated(space%tight%error)) call move_alloc(space%tight%error, error)
   end subroutine solve_side_by_side

   !> Quantities of scenes whose motions start from given states, and how these end. A motion is followed until it repeats, as far
   !> as the periods of its scene allow. Where the work must stop, the answers are of no use.
   subroutine solve_starts(base, positions, values, starts, space, quantities, endings, error)
      !> Checked base scene; its campaign records the quantities, none of which is a list
      type(scene_t), intent(in) :: base
      !> Varied keys, by their positions in the key table
      integer, intent(in) :: positions(:)
      !> (key, scene)
      real(dp), intent(in) :: values(:, :)
      !> Where each motion starts; without numbers: where its scene says
      type(motion_state_t), intent(in) :: starts(:)
      !> Work space
      type(chunk_space_t), intent(inout) :: space
      !> (quantity, scene), NaN: unknown
      real(dp), intent(out) :: quantities(:, :)
      !> How the motions ended; those of scenes that are none are invalid
      type(ending_t), intent(out) :: endings(:)
      !> Set if there is no memory for the samples of a scene
      type(error_t), allocatable, intent(out) :: error
      type(scene_t) :: scene
      type(resolved_scene_t) :: resolved(size(starts))
      type(motion_state_t) :: from(size(starts))
      type(spectrum_choice_t) :: choices(size(starts))
      type(request_t) :: requests(size(starts))
      logical :: needed(need_count), valid(size(starts))
      integer, allocatable :: order(:)
      integer :: i, k, start, together

      needed = needs_of(base%campaign%record)
      scene = base
      scene%resolved_input = ''
      endings = ending_t(status=status_invalid)
      quantities = ieee_value(0.0_dp, ieee_quiet_nan)
      do i = 1, size(starts)
         call set_varied_keys(scene, positions, values(:, i))
         valid(i) = is_valid_scene(scene, positions, values(:, i))
         if (.not. valid(i)) cycle
         resolved(i) = resolve(scene)
         choices(i) = scene%spectrum
         requests(i) = request_of(scene, needed)
         requests(i)%until_steady = .true.
         requests(i)%forecast = .true.
         from(i) = start_of(resolved(i)%problem)
         if (allocated(starts(i)%numbers)) from(i) = starts(i)
      end do
      order = pack([(i, i=1, size(starts))], valid)
      together = merge(size(order), 1, alike(requests(order)))
      do start = 1, size(order), max(1, together)
         associate (group => order(start:start + together - 1))
            call solve_side_by_side(resolved(group), from(group), choices(group), requests(group(1)), needed, space, error)
            if (must_stop() .or. allocated(error)) return
            do i = 1, together
               call judge_scene_of(space%group, i, resolved(group(i)), needed, space%verifications(i), space%judged)
               endings(group(i)) = space%group%endings(i)
               quantities(:, group(i)) = [(quantity_value(base%campaign%record(k), space%judged), &
                                           k=1, size(base%campaign%record))]
            end do
         end associate
      end do
   end subroutine solve_starts

   !> Whether all scenes of a batch ask for the same.
   pure logical function alike(requests)
      type(request_t), intent(in) :: requests(:)

      alike = .true.
      if (size(requests) > 1) alike = all(same_request(requests, requests(1)))
   end function alike

   !> What is asked of the engine.
   pure function request_of(scene, needed) result(request)
      type(scene_t), intent(in) :: scene
      !> What the columns need
      logical, intent(in) :: needed(:)
      type(request_t) :: request

      request = engine_request(scene)
      request%samples_per_period = 1
      if (any(needed([needs_spectrum, needs_verification]))) request%samples_per_period = scene%campaign%samples_per_period
      request%forecast = request%until_steady
   end function request_of

   !> Work that a scene is likely to be: stiff ones take short steps, lightly damped ones many periods, and the more of them the
   !> more the force exceeds the static load, up to motions that never repeat. Found by trial on input/map.nml; it decides
   !> the order only.
   pure real(dp) function likely_cost(scene, resolved)
      type(scene_t), intent(in) :: scene
      type(resolved_scene_t), intent(in) :: resolved
      real(dp), parameter :: largest_ratio = 2.0_dp, irregular_share = 0.06_dp
      real(dp) :: oscillations, settling, ratio

      likely_cost = 0.0_dp
      if (.not. resolved%steady_film > 0.0_dp) return
      oscillations = resolved%natural_frequency/scene%excitation%frequency
      settling = 1.0_dp/max(resolved%damping_ratio*oscillations, 1.0e-3_dp)
      ratio = min(largest_oscillation(force_of(scene%excitation))/max(abs(scene%excitation%static_load()), least_static_load), &
                  largest_ratio)
      likely_cost = (1.0_dp + oscillations*(1.0_dp + resolved%damping_ratio))* &
                    (4.0_dp + settling + irregular_share*ratio**5*settling**2)
   end function likely_cost

   !> Note what is known of a scene before it is judged.
   pure subroutine note_ending(resolved, ending, judged)
      type(resolved_scene_t), intent(in) :: resolved
      type(ending_t), intent(in) :: ending
      type(judged_scene_t), intent(inout) :: judged

      judged%resolved = resolved
      judged%status = ending%status
      judged%judged = is_success(ending%status)
      judged%periods = ending%periods
      judged%repeats_after = ending%orbit
      judged%orbit = periodic_orbit_t()
      judged%nodes_stopped = .false.
   end subroutine note_ending

   !> What is known of a scene of a group.
   pure subroutine judge_scene_of(group, place, resolved, needed, verification, judged)
      !> The group, and the place of the scene in it
      type(scene_group_t), intent(in) :: group
      integer, intent(in) :: place
      type(resolved_scene_t), intent(in) :: resolved
      !> What the columns need
      logical, intent(in) :: needed(:)
      !> Whether its class and its impacts are verified, if that is needed
      type(verification_t), intent(in) :: verification
      type(judged_scene_t), intent(inout) :: judged

      call note_ending(resolved, group%endings(place), judged)
      judged%repeats_after = group%repeat_after(place)
      if (.not. judged%judged) return
      if (any(needed([needs_spectrum, needs_verification]))) judged%rattle = group%verdicts(place)
      call note_record(group%records(place), judged)
      if (needed(needs_regime)) call note_regime(judged)
      judged%verification%exists = needed(needs_verification)
      judged%verification%verified = verification%verified
      judged%verification%impacts = verification%impacts
   end subroutine judge_scene_of

end module solve_chunk
