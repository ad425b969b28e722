!> Solves and judges the scenes of a chunk: the kernels of the single scene, eight scenes to a register.
module solve_chunk
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use automatic_model, only: nodes_stopped, reason_for_nodes, reason_t, scene_in_nodes
   use campaign_record, only: record_number, record_row
   use engine, only: ending_t, motion_state_t, reserved_periods, start_of
   use errors, only: error_t
   use judged_scene, only: film_model_stopped, judged_scene_t, quantity_value
   use key_table, only: find_key
   use force, only: force_of, largest_oscillation
   use grid_blocks, only: block_scenes, neighbours_of
   use handed_motions, only: hand_on_motions, neighbours_t
   use judge_group, only: judgement_space_t
   use kinds, only: dp, int64
   use memory_need, only: window_bytes
   use other_motions, only: find_other_motions
   use prepared_scene, only: prepare, prepared_scene_t, resolved_scene_t
   use quantities, only: asks_to_verify, need_count, needs_impacts, needs_motion_verdicts, needs_of, needs_of_choice, &
      needs_orbit, needs_spectrum, needs_starts, needs_verification, quantity_film_model
   use sampling, only: chunk_values, largest_value, sample_plan_t
   use scene_solution, only: solve_and_judge, solve_in_memory
   use scene_status, only: status_invalid
   use scene_types, only: least_static_load, scene_t
   use schedule, only: cost_order
   use signals, only: must_stop
   use varied_keys, only: is_valid_scene, pair_position, set_varied_keys
   use verify_group, only: compared
   implicit none(type, external)
   private

   !> Most scenes solved together. A motion that never repeats takes many times the periods of the others; among this many
   !> there are enough of them to fill the lanes that the others have left.
   integer, parameter :: most_together = 2048
   !> Fewest, so that no lane stays empty; and what the samples of more than these may take [bytes]
   integer, parameter :: fewest_together = 16
   real(dp), parameter :: most_bytes = 2.0_dp**28

   !> The scene of a campaign whose motion took the most steps.
   type, public :: longest_scene_t
      !> Number in the campaign, 0: none; and its steps
      integer(int64) :: number = 0_int64, steps = 0_int64
   end type longest_scene_t

   public :: note_longest, solve_scenes, solve_starts, scenes_of_block, chunk_bytes

contains

   !> Rows of consecutive scenes. They depend on the scenes alone, not on how they are cut into chunks. Where the work must
   !> stop, the rows are of no use.
   subroutine solve_scenes(base, plan, first, space, rows, error, longest)
      !> Checked base scene
      type(scene_t), intent(in) :: base
      !> The plan
      type(sample_plan_t), intent(in) :: plan
      !> First scene
      integer(int64), intent(in) :: first
      !> Work space of this thread
      type(judgement_space_t), intent(inout) :: space
      !> One column of this array is the row of a scene
      real(dp), contiguous, intent(out) :: rows(:, :)
      !> Set if there is no memory for the samples of a scene; the rows are of no use then
      type(error_t), allocatable, intent(out) :: error
      !> Kept up
      type(longest_scene_t), optional, intent(inout) :: longest
      real(dp), allocatable :: values(:, :)
      type(scene_t) :: scene
      logical :: needed(need_count)
      integer :: start, count, batch

      batch = scenes_together(base, plan)
      allocate (values(size(plan%positions), min(batch, size(rows, 2))))
      needed = needs_of_rows(base)
      scene = base
      scene%resolved_input = ''
      do start = 1, size(rows, 2), batch
         if (must_stop()) return
         count = min(batch, size(rows, 2) - start + 1)
         call chunk_values(plan, first + int(start - 1, int64), values(:, :count))
         call solve_batch(scene, plan, values(:, :count), first + int(start - 1, int64), needed, space, &
                          rows(:, start:start + count - 1), error, longest)
         if (allocated(error)) return
      end do
   end subroutine solve_scenes

   !> What has to be found for the rows of a campaign.
   pure function needs_of_rows(base) result(needed)
      !> Checked base scene
      type(scene_t), intent(in) :: base
      logical :: needed(need_count)

      needed = needs_of(base%campaign%record)
      ! A single scene looks for its orbit while it is verified.
      needed(needs_orbit) = needed(needs_orbit) .and. base%spectrum%verify
      ! What decides whether the closure will do
      if (base%film%automatic) needed = needed .or. needs_of_choice()
      needed(needs_spectrum) = needed(needs_spectrum) .or. needed(needs_verification)
      if (needed(needs_verification)) needed(compared) = .true.
   end function needs_of_rows

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

      window_periods = real(reserved_periods(nint(largest_value(plan, find_key('spectrum.periods'), &
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
   subroutine solve_batch(scene, plan, values, first, needed, space, rows, error, longest)
      !> Base scene; its varied keys are changed
      type(scene_t), intent(inout) :: scene
      !> The plan, values of the varied keys, and number of the first scene
      type(sample_plan_t), intent(in) :: plan
      real(dp), intent(in) :: values(:, :)
      integer(int64), intent(in) :: first
      !> What the columns need
      logical, intent(in) :: needed(:)
      type(judgement_space_t), intent(inout) :: space
      real(dp), intent(out) :: rows(:, :)
      !> Set if there is no memory for the samples of a scene
      type(error_t), allocatable, intent(out) :: error
      !> Kept up
      type(longest_scene_t), optional, intent(inout) :: longest
      type(prepared_scene_t) :: scenes(size(values, 2))
      type(judged_scene_t), allocatable :: judged(:)
      type(reason_t) :: reason
      real(dp) :: costs(size(values, 2))
      integer :: order(size(values, 2)), i
      integer, allocatable :: solved(:), in_nodes(:)

      costs = huge(1.0_dp)
      do i = 1, size(values, 2)
         call set_varied_keys(scene, plan%positions, values(:, i))
         if (.not. is_valid_scene(scene, plan%positions, values(:, i))) cycle
         scenes(i) = prepared_row(scene, needed)
         costs(i) = -likely_cost(scene, scenes(i)%resolved)
      end do
      call cost_order(costs, order)
      solved = pack(order, costs(order) < huge(1.0_dp))
      allocate (judged(size(solved)), in_nodes(0))
      call solve_and_judge(scenes(solved), start_of(scenes(solved)%resolved%problem), needed, space, judged, error)
      if (must_stop() .or. allocated(error)) return
      if (needed(needs_starts)) call find_other_motions(scenes(solved), space%tight, judged, error)
      if (must_stop() .or. allocated(error)) return
      if (scenes_of_block(scene, plan) > 1) &
         call hand_on_motions(scenes(solved), neighbours_of_rows(plan, first, solved), space%tight, judged, error)
      if (must_stop() .or. allocated(error)) return
      do i = 1, size(solved)
         associate (place => solved(i))
            call record_row(scene, first + int(place - 1, int64), values(:, place), judged(i), rows(:, place))
            if (present(longest)) &
               call note_longest(first + int(place - 1, int64), judged(i)%ending%count%steps, longest)
            if (.not. scene%film%automatic) cycle
            reason = reason_for_nodes(judged(i), scenes(place)%spectrum%impact_limit)
            if (reason%code > 0) in_nodes = [in_nodes, place]
         end associate
      end do
      do i = 1, size(in_nodes)
         associate (place => in_nodes(i))
            call solve_row_in_nodes(scene, plan, values(:, place), first + int(place - 1, int64), needed, rows(:, place), error)
         end associate
         if (must_stop() .or. allocated(error)) return
      end do
      do i = size(solved) + 1, size(values, 2)
         call record_row(scene, first + int(order(i) - 1, int64), values(:, order(i)), judged_scene_t(status=status_invalid), &
                         rows(:, order(i)))
      end do
   end subroutine solve_batch

   !> Keep the scene with the most steps, of two the first.
   pure subroutine note_longest(number, steps, longest)
      integer(int64), intent(in) :: number
      integer(int64), intent(in) :: steps
      type(longest_scene_t), intent(inout) :: longest

      if (steps > longest%steps .or. (steps == longest%steps .and. number < longest%number)) &
         longest = longest_scene_t(number, steps)
   end subroutine note_longest

   !> Neighbours of the rows of a batch on the grid, those of them that are solved.
   pure function neighbours_of_rows(plan, first, solved) result(neighbours)
      !> The plan, and number of the first scene of the batch
      type(sample_plan_t), intent(in) :: plan
      integer(int64), intent(in) :: first
      !> Places of the rows in the batch
      integer, intent(in) :: solved(:)
      type(neighbours_t) :: neighbours(size(solved))
      integer :: i, k

      do i = 1, size(solved)
         associate (others => neighbours_of(plan, first + int(solved(i) - 1, int64), plan%positions /= pair_position()))
            allocate (neighbours(i)%places, source=[(findloc(solved, int(others(k) - first) + 1, dim=1), k=1, size(others))])
         end associate
         neighbours(i)%places = pack(neighbours(i)%places, neighbours(i)%places > 0)
      end do
   end function neighbours_of_rows

   !> A row that is ready to be solved.
   pure type(prepared_scene_t) function prepared_row(scene, needed) result(prepared)
      !> Checked scene of the row
      type(scene_t), intent(in) :: scene
      !> What the columns need
      logical, intent(in) :: needed(:)

      prepared = prepare(scene)
      prepared%start_verdicts = needed(needs_motion_verdicts)
      associate (request => prepared%request)
         request%samples_per_period = merge(scene%campaign%samples_per_period, 1, needed(needs_spectrum))
         request%forecast = request%until_steady
         if (.not. needed(needs_impacts)) request%impact_limit = 0.0_dp
      end associate
   end function prepared_row

   !> Solve a row again in nodes of pressure, as a single scene is. Where nodes stop the row stays that of the closure.
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
      type(judgement_space_t), intent(inout) :: space
      !> (quantity, scene), NaN: unknown
      real(dp), intent(out) :: quantities(:, :)
      !> How the motions ended; those of scenes that are none are invalid
      type(ending_t), intent(out) :: endings(:)
      !> Set if there is no memory for the samples of a scene
      type(error_t), allocatable, intent(out) :: error
      type(scene_t) :: scene
      type(prepared_scene_t) :: scenes(size(starts))
      type(judged_scene_t), allocatable :: judged(:)
      type(motion_state_t) :: from(size(starts))
      logical :: needed(need_count), is_valid(size(starts))
      integer, allocatable :: solved(:)
      integer :: i, k

      needed = needs_of(base%campaign%record)
      needed(needs_spectrum) = needed(needs_spectrum) .or. needed(needs_verification)
      scene = base
      scene%resolved_input = ''
      endings = ending_t(status=status_invalid)
      quantities = ieee_value(0.0_dp, ieee_quiet_nan)
      do i = 1, size(starts)
         call set_varied_keys(scene, positions, values(:, i))
         is_valid(i) = is_valid_scene(scene, positions, values(:, i))
         if (.not. is_valid(i)) cycle
         scenes(i) = prepared_row(scene, needed)
         scenes(i)%request%until_steady = .true.
         scenes(i)%request%forecast = .true.
         from(i) = start_of(scenes(i)%resolved%problem)
         if (allocated(starts(i)%numbers)) from(i) = starts(i)
      end do
      solved = pack([(i, i=1, size(starts))], is_valid)
      allocate (judged(size(solved)))
      call solve_and_judge(scenes(solved), from(solved), needed, space, judged, error)
      if (must_stop() .or. allocated(error)) return
      do i = 1, size(solved)
         endings(solved(i)) = judged(i)%ending
         quantities(:, solved(i)) = [(quantity_value(base%campaign%record(k), judged(i)), k=1, size(base%campaign%record))]
      end do
   end subroutine solve_starts

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

end module solve_chunk
