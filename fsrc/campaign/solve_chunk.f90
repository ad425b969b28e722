!> Solves and judges the scenes of a chunk: the kernels of the single scene, eight scenes to a register.
module solve_chunk
   use campaign_record, only: judged_scene_t, need_of, needs_regime, needs_spectrum, record_row
   use kinds, only: dp, int64
   use lane_motions, only: accelerations, solve_motions
   use lane_scenes, only: lane_ending_t, lane_request_t, lane_scene_t
   use rattle_class, only: classify
   use regime_check, only: check_regime
   use resolved_scene, only: resolve, resolved_scene_t
   use sampling, only: chunk_values, sample_plan_t
   use scene_lane, only: lane_of_scene
   use scene_status, only: is_success, status_invalid
   use scene_types, only: scene_t, spectrum_choice_t, until_steady
   use schedule, only: cost_order
   use varied_scene, only: is_valid_scene, set_varied_key
   implicit none(type, external)
   private

   !> Scenes solved together. A motion that never repeats takes many times the periods of the others; among this many
   !> there are enough of them to fill the lanes that the others have left.
   integer, parameter :: batch = 2048

   !> Samples of a batch; kept from chunk to chunk, since the system takes its time to hand out fresh memory.
   type, public :: chunk_space_t
      private
      real(dp), allocatable :: films(:, :), velocities(:, :)
   end type chunk_space_t

   public :: solve_scenes

contains

   !> Rows of consecutive scenes. They depend on the scenes alone, not on how they are cut into chunks.
   subroutine solve_scenes(base, plan, first, space, rows)
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
      real(dp), allocatable :: values(:, :)
      type(scene_t) :: scene
      integer :: start, count, samples, together

      samples = max(base%spectrum%periods, 8)*base%campaign%samples_per_period
      together = min(batch, size(rows, 2))
      if (allocated(space%films)) then
         if (size(space%films, 2) < together) deallocate (space%films, space%velocities)
      end if
      if (.not. allocated(space%films)) allocate (space%films(samples, together), space%velocities(samples, together))
      allocate (values(size(plan%positions), together))
      scene = base
      scene%resolved_input = ''
      do start = 1, size(rows, 2), batch
         count = min(batch, size(rows, 2) - start + 1)
         call chunk_values(plan, first + int(start - 1, int64), values(:, :count))
         call solve_batch(scene, plan%positions, values(:, :count), first + int(start - 1, int64), space%films, &
                          space%velocities, &
                          rows(:, start:start + count - 1))
      end do
   end subroutine solve_scenes

   !> Rows of a batch.
   subroutine solve_batch(scene, positions, values, first, films, velocities, rows)
      !> Base scene; its varied keys are changed
      type(scene_t), intent(inout) :: scene
      integer, intent(in) :: positions(:)
      real(dp), intent(in) :: values(:, :)
      integer(int64), intent(in) :: first
      !> Work space: samples of h and z'
      real(dp), contiguous, intent(inout) :: films(:, :)
      real(dp), contiguous, intent(inout) :: velocities(:, :)
      real(dp), intent(out) :: rows(:, :)
      type(resolved_scene_t) :: resolved(size(values, 2))
      type(lane_scene_t) :: lanes(size(values, 2))
      type(lane_ending_t) :: endings(size(values, 2))
      type(judged_scene_t) :: judged
      type(lane_request_t) :: request
      real(dp) :: costs(size(values, 2)), accuracy(size(values, 2))
      integer :: periods(size(values, 2)), order(size(values, 2)), place(size(values, 2)), i, solved
      logical :: valid(size(values, 2)), with_spectrum, with_regime

      with_spectrum = is_needed(scene, needs_spectrum)
      with_regime = is_needed(scene, needs_regime)
      solved = 0
      do i = 1, size(values, 2)
         call set_values(scene, positions, values(:, i))
         valid(i) = is_valid_scene(scene, positions, values(:, i))
         costs(i) = huge(1.0_dp)
         if (.not. valid(i)) cycle
         solved = solved + 1
         resolved(i) = resolve(scene)
         lanes(i) = lane_of_scene(scene, resolved(i)%film, resolved(i)%initial_film, scene%film%initial_velocity)
         costs(i) = -likely_cost(scene, resolved(i))
         accuracy(i) = scene%solver%accuracy
         periods(i) = scene%solver%periods
      end do
      call cost_order(costs, order)
      do i = 1, solved
         place(order(i)) = i
      end do
      call request_of(scene, accuracy(order(1)), periods(order(1)), request)
      if (alike(accuracy(order(:solved)), periods(order(:solved)))) then
         call solve_motions(lanes(order(:solved)), request, films(:, :solved), velocities(:, :solved), endings(:solved))
      else
         do i = 1, solved
            call request_of(scene, accuracy(order(i)), periods(order(i)), request)
            call solve_motions(lanes(order(i):order(i)), request, films(:, i:i), velocities(:, i:i), endings(i:i))
         end do
      end if
      do i = 1, size(values, 2)
         judged = judged_scene_t()
         if (valid(i)) then
            call set_values(scene, positions, values(:, i))
            judged%ending = endings(place(i))
            judged%resolved = resolved(i)
            call judge_scene(scene, lanes(i), with_spectrum, with_regime, films(:, place(i)), velocities(:, place(i)), judged)
         else
            judged%ending%status = status_invalid
         end if
         call record_row(scene, first + int(i - 1, int64), values(:, i), judged, rows(:, i))
      end do
   end subroutine solve_batch

   pure subroutine set_values(scene, positions, values)
      type(scene_t), intent(inout) :: scene
      integer, intent(in) :: positions(:)
      real(dp), intent(in) :: values(:)
      integer :: k

      do k = 1, size(positions)
         call set_varied_key(scene, positions(k), values(k))
      end do
   end subroutine set_values

   !> Whether all scenes of a batch ask for the same.
   pure logical function alike(accuracy, periods)
      real(dp), intent(in) :: accuracy(:)
      integer, intent(in) :: periods(:)

      alike = .true.
      if (size(periods) < 2) return
      alike = all(periods == periods(1)) .and. .not. any(abs(accuracy - accuracy(1)) > 0.0_dp)
   end function alike

   !> What is asked of the engine.
   pure subroutine request_of(scene, accuracy, periods, request)
      type(scene_t), intent(in) :: scene
      real(dp), intent(in) :: accuracy
      integer, intent(in) :: periods
      type(lane_request_t), intent(out) :: request

      request%accuracy = accuracy
      request%periods = periods
      request%samples_per_period = scene%campaign%samples_per_period
      request%sampled_periods = scene%spectrum%periods
      request%until_steady = scene%solver%until == until_steady
      if (request%until_steady) request%sampled_periods = max(scene%spectrum%periods, 8)
      request%forecast = request%until_steady
   end subroutine request_of

   !> Work that a scene is likely to be: stiff ones take short steps, lightly damped ones many periods.
   pure real(dp) function likely_cost(scene, resolved)
      type(scene_t), intent(in) :: scene
      type(resolved_scene_t), intent(in) :: resolved
      real(dp) :: oscillations

      likely_cost = 0.0_dp
      if (.not. resolved%steady_film > 0.0_dp) return
      oscillations = resolved%natural_frequency/scene%load%frequency
      likely_cost = (1.0_dp + oscillations*(1.0_dp + resolved%damping_ratio))* &
                    (4.0_dp + 1.0_dp/max(resolved%damping_ratio*oscillations, 1.0e-3_dp))
   end function likely_cost

   !> Judge the window of a scene as far as its columns ask for it.
   subroutine judge_scene(scene, lane, with_spectrum, with_regime, films, velocities, judged)
      type(scene_t), intent(in) :: scene
      type(lane_scene_t), intent(in) :: lane
      !> What the columns need
      logical, intent(in) :: with_spectrum, with_regime
      real(dp), intent(in) :: films(:)
      real(dp), intent(in) :: velocities(:)
      type(judged_scene_t), intent(inout) :: judged
      type(spectrum_choice_t) :: choice
      real(dp), allocatable :: values(:)
      integer :: samples

      judged%success = is_success(judged%ending%status)
      if (.not. judged%success) return
      samples = judged%ending%samples
      choice = scene%spectrum
      choice%periods = samples/scene%campaign%samples_per_period
      allocate (values(samples))
      call accelerations(lane, scene%campaign%samples_per_period, films(:samples), velocities(:samples), values)
      judged%film_minimum = minval(films(:samples))
      judged%film_maximum = maxval(films(:samples))
      judged%acceleration_minimum = minval(values)
      judged%acceleration_maximum = maxval(values)
      if (with_spectrum) call classify(values, choice, judged%resolved%noise_floor, judged%rattle)
      if (with_regime) judged%regime = check_regime(judged%resolved%film, scene%film%law, films(:samples), &
                                                    velocities(:samples))
   end subroutine judge_scene

   !> Whether any recorded quantity needs this.
   pure logical function is_needed(scene, need)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: need
      integer :: i

      is_needed = .false.
      do i = 1, size(scene%campaign%record)
         is_needed = is_needed .or. need_of(scene%campaign%record(i)%text) == need
      end do
   end function is_needed

end module solve_chunk
