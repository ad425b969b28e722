!> Windows of scenes whose samples are too few for their harmonics. Integrals over the steps tell most of what samples do, for much
!> less. Where they leave more open than the count of many harmonics, or creep rests on that count, windows are solved again from
!> where they begin, as those of single scenes are: with twice as many samples until these are enough, but side by side.
module finer_windows
   use carried_loads, only: accelerations_of_samples
   use engine, only: ending_t, motion_state_t, request_t
   use errors, only: error_t
   use fine_window, only: classify_window, integral_record, may_be_finer
   use kinds, only: dp
   use many_motions, only: solve_motions
   use memory_need, only: expect_window_memory
   use problem, only: problem_t, state_size
   use rattle_class, only: class_creep, classify_steps, is_off_harmonics, rattle_verdict_t
   use scene_status, only: is_success
   use scene_types, only: spectrum_choice_t
   use signals, only: must_stop
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Samples of windows that are solved side by side: no more than these, but for a window that has more alone.
   integer, parameter :: samples_together = 2**21

   public :: classify_finer

contains

   !> Classify some windows anew. After a signal to stop the classes are of no use.
   subroutine classify_finer(problems, choices, noise_floors, asked, periods, records, verdicts, class_alone, error)
      !> What moves, scene by scene as all that follows
      type(problem_t), intent(in) :: problems(:)
      !> Limits of the classes
      type(spectrum_choice_t), intent(in) :: choices(:)
      !> Accelerations that the errors of the solutions explain [m/s2]
      real(dp), intent(in) :: noise_floors(:)
      !> What was asked of the engine
      type(request_t), intent(in) :: asked
      !> Periods of the windows
      integer, intent(in) :: periods(:)
      !> What their steps tell
      type(window_record_t), intent(in) :: records(:)
      !> Classes by the samples there are, which are too few; on return by more of them or by integrals
      type(rattle_verdict_t), intent(inout) :: verdicts(:)
      !> Whether nothing but the classes is asked for
      logical, intent(in) :: class_alone
      !> Set if there is no memory for as many samples as are needed; the classes are of no use then
      type(error_t), allocatable, intent(out) :: error
      type(window_record_t) :: windows(size(problems))
      type(rattle_verdict_t), allocatable :: by_samples(:)
      integer, allocatable :: left(:), alike(:)
      integer :: samples_per_period, together, first, i

      if (size(problems) == 0) return
      by_samples = verdicts
      windows = integral_windows(choices, problems, records, periods, asked%accuracy)
      do i = 1, size(problems)
         if (windows(i)%periods > 0) &
            call classify_steps(windows(i), problems(i)%frequency, choices(i), noise_floors(i), verdicts(i))
      end do
      associate (spectrum => verdicts%spectrum)
         if (class_alone) then
            left = pack([(i, i=1, size(problems))], spectrum%irregular_is_bound .and. .not. is_off_harmonics(verdicts%class))
         else
            left = pack([(i, i=1, size(problems))], spectrum%irregular_is_bound .or. spectrum%distortion_is_bound .or. &
                                                    .not. spectrum%count_is_bound .or. verdicts%class == class_creep)
         end if
      end associate
      samples_per_period = asked%samples_per_period
      do
         left = pack(left, may_be_finer(by_samples(left), records(left), periods(left), samples_per_period))
         if (size(left) == 0) return
         samples_per_period = 2*samples_per_period
         !$omp critical (sentences)
         call expect_window_memory(samples_per_period*maxval(periods(left)), error)
         !$omp end critical (sentences)
         if (allocated(error)) return
         do i = minval(periods(left)), maxval(periods(left))
            alike = pack(left, periods(left) == i)
            together = max(1, samples_together/(i*samples_per_period))
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

         allocate (states(count*samples_per_period, maxval(state_size(problems(place))), size(place)), source=0.0_dp)
         allocate (accelerations(count*samples_per_period))
         do k = 1, size(place)
            found(k)%wants = .false.
         end do
         call solve_motions(problems(place), records(place)%start, &
                            request_t(accuracy=asked%accuracy, periods=count, samples_per_period=samples_per_period, &
                                      sampled_periods=count), states, endings, records=found)
         do k = 1, size(place)
            if (.not. is_success(endings(k)%status)) cycle
            associate (own => place(k))
               call accelerations_of_samples(problems(own), samples_per_period, states(:, :, k), accelerations)
               call classify_window(choices(own), problems(own), count, accelerations, found(k), noise_floors(own), &
                                    by_samples(own))
               if (by_samples(own)%spectrum%sampling_sufficient) verdicts(own) = by_samples(own)
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

end module finer_windows
