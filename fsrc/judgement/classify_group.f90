!> Classes of the windows of a group, and what becomes of motions that are off their harmonics.
!>
!> Where the samples of a window are too few for its harmonics, integrals over the steps give most of what samples do, for much
!> less. Where they leave more open than the count of many harmonics, or creep rests on that count, windows are solved again from
!> where they begin, side by side: with twice as many samples until these are enough.
module classify_group
   use carried_loads, only: accelerations_of_samples
   use engine, only: ending_t, motion_state_t, request_t
   use errors, only: error_t
   use kinds, only: dp
   use irregular_statistics, only: is_enough, statistics_of_path
   use lyapunov, only: draws_near, follow_neighbours, followed_motions_t, parting_t, path_t
   use many_motions, only: solve_motions
   use memory_need, only: expect_window_memory
   use neighbouring_motions, only: beside_neighbours, neighbouring_motions_t
   use periodic_orbit, only: attracting_period, periodic_orbit_t
   use prepared_scene, only: prepared_scene_t
   use problem, only: state_size
   use rattle_class, only: class_creep, class_irregular_so_far, classify_steps, note_orbit, note_parting, &
      rattle_verdict_t
   use scene_group, only: has_window, scene_group_t
   use scene_orbit, only: long_orbit, nearby_orbit
   use scene_status, only: is_success
   use scene_types, only: spectrum_choice_t
   use signals, only: must_stop
   use text_output, only: lock_texts, unlock_texts
   use window_class, only: classify_window
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Samples of a period and of a window that no spectrum needs.
   integer, parameter :: most_samples_per_period = 16384, most_samples = 8388608
   !> Piece of a step [periods] that is too short for so many samples to follow what happens there.
   real(dp), parameter :: least_piece = 0.25_dp/real(most_samples_per_period, dp)
   !> Highest multiple of the frequency that is integrated for, as many as a summary lists.
   integer, parameter :: usual_multiples = 40
   !> Samples of windows that are solved side by side: no more than these, but for a window that has more alone.
   integer, parameter :: samples_together = 2**21

   public :: classify_windows, complete_windows, follow_beside_neighbours, follow_irregular, integral_record, may_be_finer

contains

   !> Classes of the windows, by as many samples as they need, or by integrals over the steps. After a signal to stop they are of no
   !> use.
   subroutine classify_windows(scenes, group, error, asked)
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> The solved scenes; their classes are added
      type(scene_group_t), intent(inout) :: group
      !> Set if there is no memory for as many samples as are needed; the classes are of no use then
      type(error_t), allocatable, intent(out) :: error
      !> Which of them; absent: all
      logical, intent(in), optional :: asked(:)
      real(dp), allocatable :: accelerations(:)
      type(rattle_verdict_t), allocatable :: verdicts(:)
      integer, allocatable :: coarse(:), classified_by(:)
      logical :: is_coarse(size(scenes)), has_class(size(scenes))
      integer :: i

      has_class = has_window(group%endings(:size(scenes)))
      if (present(asked)) has_class = has_class .and. asked
      is_coarse = .false.
      if (.not. allocated(group%accelerations)) allocate (accelerations(size(group%states, 1)))
      do i = 1, size(scenes)
         if (must_stop()) return
         if (has_class(i)) call classify_own_samples(scenes(i), i, group, accelerations, is_coarse(i))
      end do
      coarse = pack([(i, i=1, size(scenes))], is_coarse)
      if (size(coarse) > 0) then
         verdicts = group%verdicts(coarse)
         allocate (classified_by(size(coarse)))
         call classify_finer(scenes(coarse), group%endings(coarse)%samples/scenes(1)%request%samples_per_period, &
                             group%records(coarse), verdicts, classified_by, error)
         group%verdicts(coarse) = verdicts
         group%classified_by(coarse) = classified_by
      end if
      do i = 1, size(scenes)
         if (has_class(i)) call note_orbit(group%verdicts(i), group%endings(i)%orbit)
      end do
   end subroutine classify_windows

   !> Class of a window by the samples that there are.
   subroutine classify_own_samples(scene, place, group, accelerations, is_coarse)
      type(prepared_scene_t), intent(in) :: scene
      !> Place of the scene in the group
      integer, intent(in) :: place
      type(scene_group_t), intent(inout) :: group
      !> Work space for z'' of a window [m/s2]; not allocated where the engine handed it out
      real(dp), allocatable, intent(inout) :: accelerations(:)
      !> Whether the samples are too few, and the window can be solved again
      logical, intent(out) :: is_coarse

      associate (samples => group%endings(place)%samples, per_period => scene%request%samples_per_period, &
                 problem => scene%resolved%problem, noise => scene%resolved%noise_floor, verdict => group%verdicts(place), &
                 record => group%records(place))
         if (allocated(accelerations)) then
            call accelerations_of_samples(problem, per_period, group%states(:samples, :, place), accelerations(:samples))
            call classify_window(scene%spectrum, problem, samples/per_period, accelerations(:samples), record, noise, verdict)
         else
            call classify_window(scene%spectrum, problem, samples/per_period, group%accelerations, record, noise, verdict)
         end if
         group%classified_by(place) = per_period
         is_coarse = .not. verdict%spectrum%sampling_sufficient .and. record%periods > 0
         if (.not. (is_coarse .and. problem%contact%film%in_nodes)) return
         ! Films in nodes have their integrals already: samples would have to be solved for once more.
         call classify_steps(record, problem%frequency, scene%spectrum, noise, verdict)
         group%classified_by(place) = 0
         is_coarse = .false.
      end associate
   end subroutine classify_own_samples

   !> Classify some windows anew. After a signal to stop the classes are of no use.
   subroutine classify_finer(scenes, periods, records, verdicts, classified_by, error)
      !> With the accuracy that they were solved with, and the samples that they have
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> Periods of the windows
      integer, intent(in) :: periods(:)
      !> What their steps show
      type(window_record_t), intent(in) :: records(:)
      !> Classes by the samples there are, which are too few; on return by more of them or by integrals
      type(rattle_verdict_t), intent(inout) :: verdicts(:)
      !> Samples of a period that the classes are from; 0: integrals over the steps
      integer, intent(out) :: classified_by(:)
      !> Set if there is no memory for as many samples as are needed; the classes are of no use then
      type(error_t), allocatable, intent(out) :: error
      type(window_record_t) :: windows(size(scenes))
      type(rattle_verdict_t) :: by_samples(size(scenes))
      integer, allocatable :: left(:), alike(:)
      integer :: finer, together, first, i

      finer = scenes(1)%request%samples_per_period
      classified_by = finer
      by_samples = verdicts
      windows = integral_windows(scenes, records, periods, with_extremes=.false.)
      do i = 1, size(scenes)
         if (windows(i)%periods == 0) cycle
         call classify_steps(windows(i), scenes(i)%resolved%problem%frequency, scenes(i)%spectrum, &
                             scenes(i)%resolved%noise_floor, verdicts(i))
         classified_by(i) = 0
      end do
      associate (spectrum => verdicts%spectrum)
         left = pack([(i, i=1, size(scenes))], spectrum%irregular_is_bound .or. spectrum%distortion_is_bound .or. &
                                               .not. spectrum%count_is_bound .or. verdicts%class == class_creep)
      end associate
      do
         left = pack(left, may_be_finer(records(left), periods(left), finer) .and. &
                     .not. by_samples(left)%spectrum%sampling_sufficient)
         if (size(left) == 0) return
         finer = 2*finer
         !$omp critical (sentences)
         call expect_window_memory(finer*maxval(periods(left)), error)
         !$omp end critical (sentences)
         if (allocated(error)) return
         do i = minval(periods(left)), maxval(periods(left))
            alike = pack(left, periods(left) == i)
            together = max(1, samples_together/(i*finer))
            do first = 1, size(alike), together
               if (must_stop()) return
               associate (these => alike(first:min(first + together - 1, size(alike))))
                  by_samples(these) = finer_classes(scenes(these), records(these), i, finer, by_samples(these))
               end associate
            end do
         end do
         do i = 1, size(left)
            if (.not. by_samples(left(i))%spectrum%sampling_sufficient) cycle
            verdicts(left(i)) = by_samples(left(i))
            classified_by(left(i)) = finer
         end do
      end do
   end subroutine classify_finer

   !> Classes of windows of as many periods that are solved again with some samples of each.
   function finer_classes(scenes, records, periods, samples_per_period, by_fewer) result(classes)
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> What their steps show
      type(window_record_t), intent(in) :: records(:)
      integer, intent(in) :: periods
      integer, intent(in) :: samples_per_period
      !> Classes by fewer samples, which stay where a window cannot be solved again
      type(rattle_verdict_t), intent(in) :: by_fewer(:)
      type(rattle_verdict_t) :: classes(size(scenes))
      type(window_record_t) :: found(size(scenes))
      type(ending_t) :: endings(size(scenes))
      real(dp), allocatable :: states(:, :, :), accelerations(:)
      integer :: k

      classes = by_fewer
      allocate (states(periods*samples_per_period, maxval(state_size(scenes%resolved%problem)), size(scenes)), source=0.0_dp)
      allocate (accelerations(periods*samples_per_period))
      do k = 1, size(scenes)
         found(k)%wants = .false.
      end do
      call unlock_texts()
      call solve_motions(scenes%resolved%problem, records%start, &
                         request_t(accuracy=scenes(1)%request%accuracy, periods=periods, samples_per_period=samples_per_period, &
                                   sampled_periods=periods), states, endings, records=found)
      call lock_texts()
      do k = 1, size(scenes)
         if (.not. is_success(endings(k)%status)) cycle
         associate (problem => scenes(k)%resolved%problem)
            call accelerations_of_samples(problem, samples_per_period, states(:, :, k), accelerations)
            call classify_window(scenes(k)%spectrum, problem, periods, accelerations, found(k), scenes(k)%resolved%noise_floor, &
                                 classes(k))
         end associate
      end do
   end function finer_classes

   !> Look for a periodic motion at the ends of motions that are off their harmonics, follow those that are irregular still beside
   !> neighbours, and complete the windows of those that repeat. After a signal to stop the answers are of no use.
   subroutine follow_irregular(scenes, group, followed)
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> The classified scenes
      type(scene_group_t), intent(inout) :: group
      !> Which of them; absent: all
      logical, intent(in), optional :: followed(:)
      type(neighbouring_motions_t) :: followed_motions
      logical :: is_left(size(scenes))
      integer, allocatable :: left(:)
      integer :: i

      is_left = has_window(group%endings(:size(scenes)))
      if (present(followed)) is_left = is_left .and. followed
      where (is_left) is_left = group%verdicts(:size(scenes))%class == class_irregular_so_far
      left = pack([(i, i=1, size(scenes))], is_left)
      do i = 1, size(left)
         if (must_stop()) return
         call take_orbit(nearby_orbit(scenes(left(i))%resolved%problem, group%endings(left(i))), left(i), group)
      end do
      left = pack(left, group%verdicts(left)%class == class_irregular_so_far)
      if (size(left) > 0) then
         followed_motions = beside_neighbours(scenes(left)%resolved%problem, group%endings(left)%motion_state_t)
         call follow_beside_neighbours(scenes, left, followed_motions, group)
      end if
      do i = 1, size(left)
         if (must_stop()) return
         ! What settles may repeat after more periods than are looked for before.
         if (draws_near(group%verdicts(left(i))%parting)) &
            call take_orbit(long_orbit(scenes(left(i))%resolved%problem, group%endings(left(i))), left(i), group)
      end do
      call complete_windows(scenes, group)
   end subroutine follow_irregular

   !> Follow motions beside their neighbours. Of those that part for good, what they amount to is that of all these periods. After a
   !> signal to stop the answers are of no use.
   subroutine follow_beside_neighbours(scenes, left, followed, group)
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> Which of them are followed, by an engine of their own
      integer, intent(in) :: left(:)
      class(followed_motions_t), intent(inout) :: followed
      !> The classified scenes
      type(scene_group_t), intent(inout) :: group
      type(parting_t) :: partings(size(left))
      type(path_t) :: passed(size(left))
      integer :: i

      do i = 1, size(left)
         passed(i)%record = integral_record(scenes(left(i))%spectrum)
         passed(i)%record%wants = group%records(left(i))%wants
         passed(i)%record%loads%impact_limit = scenes(left(i))%request%impact_limit
      end do
      call unlock_texts()
      call follow_neighbours(followed, is_enough, partings, passed)
      call lock_texts()
      do i = 1, size(left)
         call note_parting(group%verdicts(left(i)), partings(i))
         if (.not. partings(i)%for_good) cycle
         call take_path(scenes(left(i)), passed(i), .true., left(i), group)
         group%statistics(left(i)) = statistics_of_path(passed(i), scenes(left(i))%resolved%problem%frequency)
      end do
   end subroutine follow_beside_neighbours

   !> Take the periodic motion at the end of a scene, if there is one.
   subroutine take_orbit(orbit, place, group)
      type(periodic_orbit_t), intent(in) :: orbit
      !> Of the scene in the group
      integer, intent(in) :: place
      type(scene_group_t), intent(inout) :: group

      call note_orbit(group%verdicts(place), attracting_period(orbit))
      if (orbit%period > 0) group%repeat_after(place) = orbit%period
   end subroutine take_orbit

   !> Complete the windows of motions that repeat after a number of periods that does not divide them: follow these from where the
   !> window begins over whole periods of the motion.
   subroutine complete_windows(scenes, group)
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> The classified scenes, with the periods after which they repeat
      type(scene_group_t), intent(inout) :: group
      type(path_t) :: path
      type(window_record_t), allocatable :: records(:)
      integer, allocatable :: left(:)
      integer :: periods(size(scenes)), n, i

      n = size(scenes)
      periods = group%endings(:n)%samples/scenes(1)%request%samples_per_period
      left = pack([(i, i=1, n)], has_window(group%endings(:n)) .and. group%records(:n)%periods > 0 .and. &
                  group%repeat_after(:n) > 1 .and. modulo(periods, max(1, group%repeat_after(:n))) > 0)
      if (size(left) == 0) return
      associate (after => group%repeat_after(left))
         records = integral_windows(scenes(left), group%records(left), ((periods(left) - 1)/after + 1)*after, with_extremes=.true.)
      end associate
      do i = 1, size(left)
         if (records(i)%periods == 0) cycle
         path%record = records(i)
         call take_path(scenes(left(i)), path, .false., left(i), group)
      end do
   end subroutine complete_windows

   !> Take where a motion went beyond its window, and its harmonics from there; its class stands.
   subroutine take_path(scene, path, by_power, place, group)
      type(prepared_scene_t), intent(in) :: scene
      type(path_t), intent(in) :: path
      !> Whether its harmonics are those of the mean power of its periods
      logical, intent(in) :: by_power
      !> Of the scene in the group
      integer, intent(in) :: place
      type(scene_group_t), intent(inout) :: group
      type(rattle_verdict_t) :: verdict

      call classify_steps(path%record, scene%resolved%problem%frequency, scene%spectrum, scene%resolved%noise_floor, verdict, &
                          by_power=by_power)
      associate (found => group%verdicts(place))
         ! Whether the samples of the scene follow the motion is known from its window.
         verdict%spectrum%sampling_sufficient = found%spectrum%sampling_sufficient
         found%spectrum = verdict%spectrum
         found%reversals_per_period = verdict%reversals_per_period
      end associate
      group%paths(place) = path
   end subroutine take_path

   !> Records of some windows with Fourier integrals. The windows are solved again from where they begin, side by side; a window
   !> that cannot be has no periods in its record.
   function integral_windows(scenes, records, periods, with_extremes) result(windows)
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> What the steps of their windows gave, and how many periods are solved from where they begin
      type(window_record_t), intent(in) :: records(:)
      integer, intent(in) :: periods(:)
      !> Whether extremes and impacts are asked for as in the records
      logical, intent(in) :: with_extremes
      type(window_record_t) :: windows(size(scenes))
      type(motion_state_t) :: starts(size(scenes))
      type(request_t) :: request
      type(ending_t) :: ended(size(scenes))
      integer :: i
      real(dp), allocatable :: states(:, :, :)

      request%accuracy = scenes(1)%request%accuracy
      request%periods = maxval(periods)
      request%sampled_periods = request%periods
      request%samples_per_period = 1
      request%every_period = .true.
      do i = 1, size(scenes)
         starts(i) = records(i)%start
         starts(i)%periods = request%periods - periods(i)
         windows(i) = integral_record(scenes(i)%spectrum)
         if (.not. with_extremes) cycle
         windows(i)%wants = records(i)%wants
         windows(i)%loads%impact_limit = records(i)%loads%impact_limit
      end do
      allocate (states(request%periods, maxval(state_size(scenes%resolved%problem)), size(scenes)), source=0.0_dp)
      call unlock_texts()
      call solve_motions(scenes%resolved%problem, starts, request, states, ended, records=windows)
      call lock_texts()
      do i = 1, size(scenes)
         if (.not. is_success(ended(i)%status)) windows(i)%periods = 0
      end do
   end function integral_windows

   !> An empty record that asks for Fourier integrals, up to twice the multiple of the dominant order that makes a motion idle.
   pure function integral_record(spectrum) result(record)
      !> Limits of the classes
      type(spectrum_choice_t), intent(in) :: spectrum
      type(window_record_t) :: record

      record%wants = .false.
      record%multiples = max(usual_multiples, 2*spectrum%idle_harmonics*spectrum%dominant_order, &
                             2*findloc(spectrum%forced, .true., dim=1, back=.true.))
   end function integral_record

   !> Whether twice as many samples of a window may be enough.
   elemental logical function may_be_finer(record, periods, samples_per_period)
      !> What the steps of the window show; no periods: it cannot be solved again
      type(window_record_t), intent(in) :: record
      !> Its periods, and the samples of each
      integer, intent(in) :: periods
      integer, intent(in) :: samples_per_period

      may_be_finer = record%periods > 0 .and. record%shortest_piece > least_piece .and. &
                     2*samples_per_period <= most_samples_per_period .and. 2*samples_per_period <= most_samples/max(1, periods)
   end function may_be_finer

end module classify_group
