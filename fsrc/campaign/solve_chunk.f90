!> Solves and judges the scenes of a chunk: the kernels of the single scene, eight scenes to a register.
module solve_chunk
   use campaign_certificate, only: test_class
   use campaign_record, only: record_row
   use controlled_engine, only: reserved_periods
   use engine, only: ending_t, motion_state_t, request_t, start_of
   use errors, only: error_t
   use fine_window, only: classify_window, integral_record
   use judged_scene, only: judged_scene_t
   use key_table, only: find_key
   use force, only: force_of, largest_oscillation
   use kinds, only: dp, int64
   use loudness, only: loudness_of_record
   use many_motions, only: solve_motions
   use memory_need, only: window_bytes
   use node_extremes, only: seen_pressure, seen_quantities
   use problem, only: accelerations_of_samples, problem_t, state_size, thinnest_film
   use rattle_class, only: classify_steps, note_orbit
   use periodic_orbit, only: periodic_orbit_t
   use quantities, only: need_count, needs_certificate, needs_coast_film_range, needs_coast_load_range, needs_deflection, &
      needs_film_range, needs_load_range, needs_regime, needs_spectrum, quantity_table
   use regime_check, only: check_regime
   use resolved_scene, only: engine_request => request_of, resolve, resolved_scene_t
   use sampling, only: chunk_values, largest_value, sample_plan_t
   use scene_status, only: is_success, status_invalid
   use scene_types, only: least_static_load, scene_t
   use schedule, only: cost_order
   use signals, only: must_stop
   use varied_keys, only: is_valid_scene, set_varied_keys
   use window_extremes, only: extremes_of_record
   use window_record, only: window_record_t
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
      !> Sample, number of its state, scene
      real(dp), allocatable :: states(:, :, :)
      !> z'' of one scene [m/s2]
      real(dp), allocatable :: accelerations(:)
      !> What the steps of the windows tell
      type(window_record_t), allocatable :: records(:)
      !> The scene judged last; its arrays serve the next one
      type(judged_scene_t) :: judged
   end type chunk_space_t

   public :: solve_scenes, chunk_bytes

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
      !> Set if there is not enough memory
      type(error_t), allocatable, intent(out) :: error
      real(dp), allocatable :: values(:, :)
      type(scene_t) :: scene
      logical :: needed(need_count)
      integer :: start, count, batch, i

      batch = scenes_together(base, plan)
      allocate (values(size(plan%positions), min(batch, size(rows, 2))))
      needed = [(any(quantity_table(base%campaign%record)%need == i), i=1, need_count)]
      needed(needs_load_range) = any(needed([needs_load_range, needs_deflection]))
      needed(needs_coast_film_range) = any(needed([needs_film_range, needs_coast_film_range]))
      needed(needs_coast_load_range) = any(needed([needs_coast_load_range, needs_deflection]))
      scene = base
      scene%resolved_input = ''
      do start = 1, size(rows, 2), batch
         if (must_stop()) return
         count = min(batch, size(rows, 2) - start + 1)
         call chunk_values(plan, first + int(start - 1, int64), values(:, :count))
         call solve_batch(scene, plan%positions, values(:, :count), first + int(start - 1, int64), needed, space, &
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
   end function scenes_together

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
   subroutine solve_batch(scene, positions, values, first, needed, space, rows, error)
      !> Base scene; its varied keys are changed
      type(scene_t), intent(inout) :: scene
      !> Varied keys by their positions in the key table
      integer, intent(in) :: positions(:)
      real(dp), intent(in) :: values(:, :)
      integer(int64), intent(in) :: first
      !> What the columns need
      logical, intent(in) :: needed(:)
      type(chunk_space_t), intent(inout) :: space
      real(dp), intent(out) :: rows(:, :)
      type(error_t), allocatable, intent(out) :: error
      type(resolved_scene_t) :: resolved(size(values, 2))
      type(request_t) :: requests(size(values, 2))
      type(ending_t) :: endings(size(values, 2))
      real(dp) :: costs(size(values, 2))
      type(window_record_t), allocatable :: windows(:)
      integer, allocatable :: number(:)
      integer :: order(size(values, 2)), i, solved
      logical :: valid(size(values, 2)), coarse(size(values, 2)), together

      solved = 0
      do i = 1, size(values, 2)
         call set_varied_keys(scene, positions, values(:, i))
         valid(i) = is_valid_scene(scene, positions, values(:, i))
         costs(i) = huge(1.0_dp)
         if (.not. valid(i)) cycle
         solved = solved + 1
         resolved(i) = resolve(scene)
         costs(i) = -likely_cost(scene, resolved(i))
         requests(i) = request_of(scene, needed)
      end do
      call cost_order(costs, order)
      together = alike(requests(order(:solved)))
      call provide_space(space, requests(order(:solved)), solved, merge(solved, 1, together), &
                         max(2, maxval(state_size(resolved(order(:solved))%problem))), needed)
      if (together .and. solved > 0) then
         associate (problems => resolved(order(:solved))%problem)
            call solve_motions(problems, start_of(problems), requests(order(1)), space%states(:, :, :solved), &
                               endings(:solved), records=space%records(:solved))
         end associate
      end if
      coarse = .false.
      do i = 1, size(values, 2)
         if (must_stop()) return
         associate (scene_number => order(i))
            if (valid(scene_number)) then
               call set_varied_keys(scene, positions, values(:, scene_number))
               associate (problem => resolved(scene_number)%problem)
                  if (.not. together) call solve_motions([problem], [start_of(problem)], requests(scene_number), &
                                                         space%states(:, :, :1), endings(i:i), &
                                                         records=space%records(i:i))
               end associate
               call note_ending(resolved(scene_number), endings(i), space%judged)
               call judge_by_samples(scene, endings(i)%samples, needed, i, merge(i, 1, together), space)
               coarse(i) = space%judged%judged .and. .not. space%judged%rattle%lines%sampling_sufficient
               ! What the samples are too few for is judged below, by the steps.
               if (.not. coarse(i)) call complete(scene, needed, space%records(i), space%judged, error)
               if (allocated(error)) return
            else
               call note_ending(resolved_scene_t(), ending_t(status=status_invalid), space%judged)
            end if
            if (.not. coarse(i)) call record_row(scene, first + int(scene_number - 1, int64), values(:, scene_number), &
                                                 space%judged, rows(:, scene_number))
         end associate
      end do
      number = pack([(i, i=1, size(values, 2))], coarse)
      if (together .and. size(number) > 0) then
         windows = integral_windows(scene, resolved(order(number))%problem, endings(number), space%records(number), &
                                    requests(order(1)))
      end if
      do i = 1, size(number)
         if (must_stop()) return
         associate (place => number(i), scene_number => order(number(i)))
            call set_varied_keys(scene, positions, values(:, scene_number))
            if (.not. together) windows = integral_windows(scene, [resolved(scene_number)%problem], endings([place]), &
                                                           space%records([place]), requests(scene_number))
            call note_ending(resolved(scene_number), endings(place), space%judged)
            associate (window => windows(merge(i, 1, together)))
               if (window%periods > 0) then
                  call classify_steps(window, scene%load%frequency, scene%spectrum, space%judged%resolved%noise_floor, &
                                      space%judged%rattle)
               else
                  call judge_by_samples(scene, endings(place)%samples, needed, place, &
                                        merge(place, 1, together), space)
               end if
            end associate
            call complete(scene, needed, space%records(place), space%judged, error)
            if (allocated(error)) return
            call record_row(scene, first + int(scene_number - 1, int64), values(:, scene_number), space%judged, &
                            rows(:, scene_number))
         end associate
      end do
   end subroutine solve_batch

   !> Records of some windows with Fourier integrals. The windows are solved again from where they begin, side by side; a window
   !> that cannot be has no periods in its record.
   function integral_windows(scene, problems, endings, records, asked) result(windows)
      !> Any scene of the batch
      type(scene_t), intent(in) :: scene
      !> The motions, how they ended and what the steps of their windows told
      type(problem_t), intent(in) :: problems(:)
      type(ending_t), intent(in) :: endings(:)
      type(window_record_t), intent(in) :: records(:)
      !> What was asked of the engine
      type(request_t), intent(in) :: asked
      type(window_record_t) :: windows(size(problems))
      type(motion_state_t) :: starts(size(problems))
      type(request_t) :: request
      type(ending_t) :: ended(size(problems))
      integer :: periods(size(problems)), i
      real(dp), allocatable :: states(:, :, :)

      periods = endings%samples/asked%samples_per_period
      request%accuracy = asked%accuracy
      request%periods = maxval(periods)
      request%sampled_periods = request%periods
      request%samples_per_period = 1
      request%every_period = .true.
      do i = 1, size(problems)
         starts(i) = records(i)%start
         starts(i)%periods = request%periods - periods(i)
         windows(i) = integral_record(scene%spectrum)
      end do
      allocate (states(request%periods, maxval(state_size(problems)), size(problems)), source=0.0_dp)
      call solve_motions(problems, starts, request, states, ended, records=windows)
      do i = 1, size(problems)
         if (.not. is_success(ended(i)%status)) windows(i)%periods = 0
      end do
   end function integral_windows

   !> See that the samples and records of so many scenes have their place.
   pure subroutine provide_space(space, requests, scenes, sampled, numbers, needed)
      type(chunk_space_t), intent(inout) :: space
      type(request_t), intent(in) :: requests(:)
      !> Scenes, and those whose samples are kept at a time
      integer, intent(in) :: scenes
      integer, intent(in) :: sampled
      !> Of a state
      integer, intent(in) :: numbers
      !> What the columns need
      logical, intent(in) :: needed(:)
      type(window_record_t) :: blank
      integer :: samples, i

      blank%wants = needed(:seen_quantities)
      if (allocated(space%records)) then
         if (size(space%records) < scenes) deallocate (space%records)
      end if
      if (.not. allocated(space%records)) allocate (space%records(scenes))
      do i = 1, scenes
         space%records(i) = blank
      end do
      samples = max(1, maxval(requests%sampled_periods*requests%samples_per_period))
      if (allocated(space%states)) then
         if (size(space%states, 1) >= samples .and. size(space%states, 2) == numbers .and. size(space%states, 3) >= sampled) return
         deallocate (space%states, space%accelerations)
      end if
      allocate (space%states(samples, numbers, sampled), space%accelerations(samples))
   end subroutine provide_space

   !> Whether all scenes of a batch ask for the same.
   pure logical function alike(requests)
      type(request_t), intent(in) :: requests(:)

      alike = .true.
      if (size(requests) < 2) return
      alike = all(requests%periods == requests(1)%periods) .and. &
              all(requests%sampled_periods == requests(1)%sampled_periods) .and. &
              .not. any(abs(requests%accuracy - requests(1)%accuracy) > 0.0_dp)
   end function alike

   !> What is asked of the engine.
   pure function request_of(scene, needed) result(request)
      type(scene_t), intent(in) :: scene
      !> What the columns need
      logical, intent(in) :: needed(:)
      type(request_t) :: request

      request = engine_request(scene)
      request%samples_per_period = 1
      if (any(needed([needs_spectrum, needs_certificate]))) request%samples_per_period = scene%campaign%samples_per_period
      if (request%until_steady) request%sampled_periods = reserved_periods(scene%spectrum%periods)
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
      oscillations = resolved%natural_frequency/scene%load%frequency
      settling = 1.0_dp/max(resolved%damping_ratio*oscillations, 1.0e-3_dp)
      ratio = min(largest_oscillation(force_of(scene%load))/max(abs(scene%load%static_load()), least_static_load), largest_ratio)
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
      ! None is looked for.
      judged%orbit = periodic_orbit_t()
   end subroutine note_ending

   !> Class of the window of a scene by its samples, if its columns ask for it.
   subroutine judge_by_samples(scene, samples, needed, place, column, space)
      type(scene_t), intent(in) :: scene
      !> Samples of its window
      integer, intent(in) :: samples
      !> What the columns need
      logical, intent(in) :: needed(:)
      !> Where its record and where its samples stand
      integer, intent(in) :: place
      integer, intent(in) :: column
      !> With its ending and what follows from it; the verdict is added
      type(chunk_space_t), intent(inout) :: space

      space%judged%rattle%lines%sampling_sufficient = .true.
      if (.not. (space%judged%judged .and. any(needed([needs_spectrum, needs_certificate])))) return
      associate (values => space%accelerations(:samples))
         call accelerations_of_samples(space%judged%resolved%problem, scene%campaign%samples_per_period, &
                                       space%states(:samples, :, column), values)
         call classify_window(scene, space%judged%resolved%problem, samples/scene%campaign%samples_per_period, values, &
                              space%records(place), space%judged%resolved%noise_floor, space%judged%rattle)
      end associate
   end subroutine judge_by_samples

   !> What the steps of the window of a judged scene tell, and whether its class stands.
   subroutine complete(scene, needed, record, judged, error)
      type(scene_t), intent(in) :: scene
      !> What the columns need
      logical, intent(in) :: needed(:)
      !> Its record
      type(window_record_t), intent(in) :: record
      type(judged_scene_t), intent(inout) :: judged
      type(error_t), allocatable, intent(out) :: error

      if (.not. judged%judged) return
      call note_orbit(judged%rattle, judged%repeats_after)
      judged%extremes = extremes_of_record(record)
      judged%loudness = loudness_of_record(record, scene%load%frequency)
      associate (pressure => record%highest(seen_pressure))
         if (needed(needs_regime)) judged%regime = check_regime(judged%resolved%problem%film, pressure%value, &
                                                                thinnest_film(judged%resolved%problem, pressure%state))
      end associate
      if (needed(needs_certificate)) call test_class(scene, judged%resolved, request_of(scene, needed), judged%rattle, &
                                                     judged%certificate, error)
   end subroutine complete

end module solve_chunk
