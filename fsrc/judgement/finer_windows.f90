!> Windows of scenes, one or many, whose samples are too few for their harmonics. Integrals over the steps tell most of what samples
!> do, for much less. Where they leave more open than the count of many harmonics, or creep rests on that count, windows are solved
!> again from where they begin, side by side: with twice as many samples until these are enough.
module finer_windows
   use carried_loads, only: accelerations_of_samples
   use engine, only: ending_t, motion_state_t, request_t
   use errors, only: error_t
   use kinds, only: dp
   use many_motions, only: solve_motions
   use memory_need, only: expect_window_memory
   use problem, only: problem_t, state_size
   use rattle_class, only: class_creep, classify_steps, is_off_harmonics, rattle_verdict_t
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

   public :: classify_finer, integral_record, may_be_finer

contains

   !> Classify some windows anew. After a signal to stop the classes are of no use.
   subroutine classify_finer(problems, choices, noise_floors, accuracy, samples_per_period, periods, records, verdicts, &
                             classified_by, class_alone, error)
      !> What moves, scene by scene as all that follows
      type(problem_t), intent(in) :: problems(:)
      !> Limits of the classes
      type(spectrum_choice_t), intent(in) :: choices(:)
      !> Accelerations that the errors of the solutions explain [m/s2]
      real(dp), intent(in) :: noise_floors(:)
      !> Relative accuracy of the solutions [-], and the samples of each period that they have
      real(dp), intent(in) :: accuracy
      integer, intent(in) :: samples_per_period
      !> Periods of the windows
      integer, intent(in) :: periods(:)
      !> What their steps tell
      type(window_record_t), intent(in) :: records(:)
      !> Classes by the samples there are, which are too few; on return by more of them or by integrals
      type(rattle_verdict_t), intent(inout) :: verdicts(:)
      !> Samples of a period that the classes are from; 0: integrals over the steps
      integer, intent(out) :: classified_by(:)
      !> Whether nothing but the classes is asked for
      logical, intent(in) :: class_alone
      !> Set if there is no memory for as many samples as are needed; the classes are of no use then
      type(error_t), allocatable, intent(out) :: error
      type(window_record_t) :: windows(size(problems))
      type(rattle_verdict_t), allocatable :: by_samples(:)
      integer, allocatable :: left(:), alike(:)
      integer :: finer, together, first, i

      classified_by = samples_per_period
      if (size(problems) == 0) return
      by_samples = verdicts
      windows = integral_windows(choices, problems, records, periods, accuracy)
      do i = 1, size(problems)
         if (windows(i)%periods == 0) cycle
         call classify_steps(windows(i), problems(i)%frequency, choices(i), noise_floors(i), verdicts(i))
         classified_by(i) = 0
      end do
      associate (spectrum => verdicts%spectrum)
         if (class_alone) then
            left = pack([(i, i=1, size(problems))], spectrum%irregular_is_bound .and. .not. is_off_harmonics(verdicts%class))
         else
            left = pack([(i, i=1, size(problems))], spectrum%irregular_is_bound .or. spectrum%distortion_is_bound .or. &
                                                    .not. spectrum%count_is_bound .or. verdicts%class == class_creep)
         end if
      end associate
      finer = samples_per_period
      do
         left = pack(left, may_be_finer(records(left), periods(left), finer) .and. &
                     .not. by_samples(left)%spectrum%sampling_sufficient)
         if (size(left) == 0) return
         finer = 2*finer
         call lock_texts()
         !$omp critical (sentences)
         call expect_window_memory(finer*maxval(periods(left)), error)
         !$omp end critical (sentences)
         call unlock_texts()
         if (allocated(error)) return
         do i = minval(periods(left)), maxval(periods(left))
            alike = pack(left, periods(left) == i)
            together = max(1, samples_together/(i*finer))
            do first = 1, size(alike), together
               if (must_stop()) return
               call classify_alike(alike(first:min(first + together - 1, size(alike))), i)
            end do
         end do
      end do

   contains

      !> Solve windows of as many periods with the samples there are to be now, and classify them by these.
      subroutine classify_alike(place, count)
         integer, intent(in) :: place(:)
         integer, intent(in) :: count
         type(window_record_t) :: found(size(place))
         type(ending_t) :: endings(size(place))
         real(dp), allocatable :: states(:, :, :), accelerations(:)
         integer :: k

         allocate (states(count*finer, maxval(state_size(problems(place))), size(place)), source=0.0_dp)
         allocate (accelerations(count*finer))
         do k = 1, size(place)
            found(k)%wants = .false.
         end do
         call solve_motions(problems(place), records(place)%start, &
                            request_t(accuracy=accuracy, periods=count, samples_per_period=finer, &
                                      sampled_periods=count), states, endings, records=found)
         do k = 1, size(place)
            if (.not. is_success(endings(k)%status)) cycle
            associate (own => place(k))
               call accelerations_of_samples(problems(own), finer, states(:, :, k), accelerations)
               call classify_window(choices(own), problems(own), count, accelerations, found(k), noise_floors(own), &
                                    by_samples(own))
               if (.not. by_samples(own)%spectrum%sampling_sufficient) cycle
               verdicts(own) = by_samples(own)
               classified_by(own) = finer
            end associate
         end do
      end subroutine classify_alike

   end subroutine classify_finer

   !> Records of some windows with Fourier integrals. The windows are solved again from where they begin, side by side; a window
   !> that cannot be has no periods in its record.
   function integral_windows(choices, problems, records, periods, accuracy) result(windows)
      !> Limits of the classes
      type(spectrum_choice_t), intent(in) :: choices(:)
      !> The motions, what the steps of their windows told, and how many periods these have
      type(problem_t), intent(in) :: problems(:)
      type(window_record_t), intent(in) :: records(:)
      integer, intent(in) :: periods(:)
      !> Relative accuracy [-]
      real(dp), intent(in) :: accuracy
      type(window_record_t) :: windows(size(problems))
      type(motion_state_t) :: starts(size(problems))
      type(request_t) :: request
      type(ending_t) :: ended(size(problems))
      integer :: i
      real(dp), allocatable :: states(:, :, :)

      request%accuracy = accuracy
      request%periods = maxval(periods)
      request%sampled_periods = request%periods
      request%samples_per_period = 1
      request%every_period = .true.
      do i = 1, size(problems)
         starts(i) = records(i)%start
         starts(i)%periods = request%periods - periods(i)
         windows(i) = integral_record(choices(i))
      end do
      allocate (states(request%periods, maxval(state_size(problems)), size(problems)), source=0.0_dp)
      call solve_motions(problems, starts, request, states, ended, records=windows)
      do i = 1, size(problems)
         if (.not. is_success(ended(i)%status)) windows(i)%periods = 0
      end do
   end function integral_windows

   !> An empty record that asks for Fourier integrals. Where all orders of the force are multiples of one, so may all harmonics be,
   !> and as many of them are asked for as of a force whose orders have no common divisor.
   pure function integral_record(spectrum) result(record)
      !> Limits of the classes
      type(spectrum_choice_t), intent(in) :: spectrum
      type(window_record_t) :: record

      record%wants = .false.
      record%multiples = max(usual_multiples, 2*spectrum%idle_harmonics*common_divisor(spectrum%forced), &
                             2*findloc(spectrum%forced, .true., dim=1, back=.true.))
   end function integral_record

   !> Greatest order of which all orders of a force are multiples.
   pure integer function common_divisor(forced)
      logical, intent(in) :: forced(:)
      integer :: order

      common_divisor = 1
      ! It is no larger than the lowest of them.
      do order = 2, findloc(forced, .true., dim=1)
         if (count(forced(order::order)) == count(forced)) common_divisor = order
      end do
   end function common_divisor

   !> Whether twice as many samples of a window may be enough.
   elemental logical function may_be_finer(record, periods, samples_per_period)
      !> What the steps of the window tell; no periods: it cannot be solved again
      type(window_record_t), intent(in) :: record
      !> Its periods, and the samples of each
      integer, intent(in) :: periods
      integer, intent(in) :: samples_per_period

      may_be_finer = record%periods > 0 .and. record%shortest_piece > least_piece .and. &
                     2*samples_per_period <= most_samples_per_period .and. 2*samples_per_period <= most_samples/max(1, periods)
   end function may_be_finer

end module finer_windows
