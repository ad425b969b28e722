!> Last periods of a scene by the error-controlled engine, and the verdict on them by as many samples as their harmonics need, or
!> by integrals over the steps where no number of samples would do.
module fine_window
   use controlled_engine, only: solve_window
   use engine, only: ending_t, motion_state_t, request_t
   use errors, only: error_t
   use kinds, only: dp
   use many_motions, only: solve_motions
   use memory_need, only: expect_window_memory
   use carried_loads, only: acceleration_at
   use problem, only: of_velocity, problem_t, state_size
   use rattle_class, only: classify, classify_steps, rattle_verdict_t
   use scene_status, only: is_success
   use scene_types, only: scene_t, spectrum_choice_t
   use text_output, only: lock_texts, unlock_texts
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Samples of a period and of a window that no spectrum needs.
   integer, parameter :: most_samples_per_period = 16384, most_samples = 8388608
   !> Piece of a step [periods] that is too short for so many samples to follow what happens there.
   real(dp), parameter :: least_piece = 0.25_dp/real(most_samples_per_period, dp)
   !> Highest multiple of the frequency that is integrated for, as many as a summary lists.
   integer, parameter :: usual_multiples = 40
   !> Share of the first harmonic by which the mean of the samples may miss the change of velocity, and of the power by which
   !> theirs may miss that of the steps: a harmonic may then be off by a tenth of the harmonic threshold at most.
   real(dp), parameter :: mean_share = 1.0e-5_dp, power_share = 1.0e-6_dp

   !> A window.
   type, public :: window_t
      !> Whole periods, and samples of each
      integer :: periods = 0
      integer :: samples_per_period = 0
      !> Sample, number of its state; and z'' [m/s2]
      real(dp), allocatable :: states(:, :), accelerations(:)
      !> What the steps of the engine tell of it; no periods: the samples are all that is known
      type(window_record_t) :: record = window_record_t()
      !> Whether its harmonics are integrals over the steps
      logical :: by_integrals = .false.
   end type window_t

   public :: solve_whole_window, judge_window, may_be_finer, integral_record, classify_window

contains

   !> Solve a scene and judge its last periods. Other threads make texts while it is solved.
   subroutine solve_whole_window(scene, problem, start, accuracy, periods, noise_floor, window, verdict, ending, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What moves, and where the motion starts
      type(problem_t), intent(in) :: problem
      type(motion_state_t), intent(in) :: start
      !> Relative accuracy [-]
      real(dp), intent(in) :: accuracy
      !> Periods to solve
      integer, intent(in) :: periods
      !> Amplitude that the errors of the solution explain [m/s2]
      real(dp), intent(in) :: noise_floor
      !> On entry periods and fewest samples, on return the window
      type(window_t), intent(inout) :: window
      !> Verdict on it
      type(rattle_verdict_t), intent(out) :: verdict
      !> How the run ended; without success there is no window
      type(ending_t), intent(out) :: ending
      !> Set if there is not enough memory
      type(error_t), allocatable, intent(out) :: error

      call unlock_texts()
      call solve_window(problem, start, accuracy, window%samples_per_period, periods, window%periods, window%states, &
                        window%accelerations, ending, window%record, scene%spectrum%impact_limit)
      call lock_texts()
      if (is_success(ending%status)) call judge_window(scene, problem, accuracy, noise_floor, window, verdict, error)
   end subroutine solve_whole_window

   !> Judge a window of the error-controlled engine: by its samples, by twice as many until they are enough, or by integrals over
   !> the steps. The window is solved again from where it begins, which gives the same motion.
   subroutine judge_window(scene, problem, accuracy, noise_floor, window, verdict, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Relative accuracy of its solution [-]
      real(dp), intent(in) :: accuracy
      !> Amplitude that the errors of the solution explain [m/s2]
      real(dp), intent(in) :: noise_floor
      !> The window with its record; on return with as many samples as there may be and its harmonics need
      type(window_t), intent(inout) :: window
      !> Verdict on it
      type(rattle_verdict_t), intent(out) :: verdict
      !> Set if there is not enough memory
      type(error_t), allocatable, intent(out) :: error
      type(window_t) :: finer
      type(ending_t) :: ending

      call classify_window(scene%spectrum, problem, window%periods, window%accelerations, window%record, noise_floor, verdict)
      do while (may_be_finer(verdict, window%record, window%periods, window%samples_per_period))
         call expect_window_memory(2*size(window%accelerations), error)
         if (allocated(error)) return
         finer%periods = window%periods
         finer%samples_per_period = 2*window%samples_per_period
         call unlock_texts()
         call solve_window(problem, window%record%start, accuracy, finer%samples_per_period, finer%periods, finer%periods, &
                           finer%states, finer%accelerations, ending, finer%record, scene%spectrum%impact_limit)
         call lock_texts()
         if (.not. is_success(ending%status)) exit
         window = finer
         call classify_window(scene%spectrum, problem, window%periods, window%accelerations, window%record, noise_floor, verdict)
      end do
      window%by_integrals = .not. verdict%spectrum%sampling_sufficient
      if (window%by_integrals) call judge_by_integrals(scene, problem, accuracy, noise_floor, window, verdict)
   end subroutine judge_window

   !> Whether the samples of a window are too few, and twice as many may be enough.
   elemental logical function may_be_finer(verdict, record, periods, samples_per_period)
      !> Verdict by the samples there are
      type(rattle_verdict_t), intent(in) :: verdict
      !> What the steps of the window tell
      type(window_record_t), intent(in) :: record
      !> Its periods, and the samples of each
      integer, intent(in) :: periods
      integer, intent(in) :: samples_per_period

      may_be_finer = .not. verdict%spectrum%sampling_sufficient .and. record%shortest_piece > least_piece .and. &
                     2*samples_per_period <= most_samples_per_period .and. 2*samples_per_period <= most_samples/periods
   end function may_be_finer

   !> Judge a window by integrals over the steps of its motion.
   subroutine judge_by_integrals(scene, problem, accuracy, noise_floor, window, verdict)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Relative accuracy of its solution [-]
      real(dp), intent(in) :: accuracy
      !> Amplitude that the errors of the solution explain [m/s2]
      real(dp), intent(in) :: noise_floor
      !> The window
      type(window_t), intent(in) :: window
      !> Verdict by its samples, replaced if the integrals can be had
      type(rattle_verdict_t), intent(inout) :: verdict
      type(request_t) :: request
      type(ending_t) :: endings(1)
      type(window_record_t) :: records(1)
      real(dp) :: states(window%periods, state_size(problem), 1)

      records(1) = integral_record(scene%spectrum)
      request = request_t(accuracy=accuracy, periods=window%periods, sampled_periods=window%periods, samples_per_period=1, &
                          every_period=.true.)
      call unlock_texts()
      call solve_motions([problem], [window%record%start], request, states, endings, records=records)
      call lock_texts()
      if (.not. is_success(endings(1)%status)) return
      call classify_steps(records(1), problem%frequency, scene%spectrum, noise_floor, verdict)
   end subroutine judge_by_integrals

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

   !> Class of a window by its samples, and whether they are enough: their mean and their power must be those of the steps.
   subroutine classify_window(spectrum, problem, periods, accelerations, record, noise_floor, verdict)
      !> Limits of the classes
      type(spectrum_choice_t), intent(in) :: spectrum
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Periods of the window
      integer, intent(in) :: periods
      !> z'' of its samples, the same count in each period [m/s2]
      real(dp), intent(in) :: accelerations(:)
      !> What the steps tell; no periods: the samples are all that is known
      type(window_record_t), intent(in) :: record
      !> Amplitude that the errors of the solution explain [m/s2]
      real(dp), intent(in) :: noise_floor
      !> Verdict on it
      type(rattle_verdict_t), intent(out) :: verdict
      type(spectrum_choice_t) :: choice

      choice = spectrum
      choice%periods = periods
      call classify(accelerations, choice, noise_floor, verdict)
      associate (spectrum => verdict%spectrum)
         if (record%periods > 0 .and. spectrum%sampling_sufficient) spectrum%sampling_sufficient = &
            samples_agree(problem, accelerations(:record%periods*(size(accelerations)/periods)), record, noise_floor, &
                          spectrum%harmonics(spectrum%largest_forced))
         if (record%periods > 0) spectrum%resolution_error = spectrum%resolution_error + error_of_ends(problem, &
            accelerations, record)
         spectrum%count_is_bound = .not. spectrum%sampling_sufficient
         spectrum%distortion_is_bound = .not. spectrum%sampling_sufficient
         spectrum%irregular_is_bound = .not. spectrum%sampling_sufficient
      end associate
   end subroutine classify_window

   !> Error of the harmonics of samples of a window that does not return to where it began, by Euler and Maclaurin [m/s2].
   pure real(dp) function error_of_ends(problem, z, record)
      type(problem_t), intent(in) :: problem
      !> z'' of the window [m/s2]
      real(dp), intent(in) :: z(:)
      type(window_record_t), intent(in) :: record
      real(dp) :: start
      integer :: n

      n = size(z)
      start = acceleration_at(problem, record%start%numbers, 0.0_dp)
      error_of_ends = (abs(z(n) - start) + abs((z(n) - z(n - 1)) - (z(1) - start)))/real(n, dp)
   end function error_of_ends

   !> Whether samples have the mean and the power that the steps have, over the periods that were recorded.
   pure logical function samples_agree(problem, z, record, noise_floor, forced_harmonic)
      type(problem_t), intent(in) :: problem
      !> z'' of the periods recorded [m/s2]
      real(dp), intent(in) :: z(:)
      type(window_record_t), intent(in) :: record
      real(dp), intent(in) :: noise_floor
      !> Largest harmonic at an order of the force [m/s2]
      real(dp), intent(in) :: forced_harmonic
      real(dp) :: start, count, mean, power, true_mean, true_power
      integer :: i

      count = real(size(z), dp)
      start = acceleration_at(problem, record%start%numbers, 0.0_dp)
      ! By the trapezium, which leaves no error where the motion is smooth and repeats.
      mean = -0.5_dp*(z(size(z)) - start)
      power = -0.5_dp*(z(size(z))**2 - start**2)
      !$omp simd reduction(+: mean, power)
      do i = 1, size(z)
         mean = mean + z(i)
         power = power + z(i)*z(i)
      end do
      mean = mean/count
      power = power/count
      true_mean = (record%end_velocity - record%start%numbers(of_velocity))*problem%frequency/real(record%periods, dp)
      true_power = record%acceleration_square/real(record%periods, dp)
      samples_agree = abs(mean - true_mean) <= mean_share*forced_harmonic + noise_floor .and. &
                      abs(power - true_power) <= power_share*true_power + 4.0_dp*noise_floor*sqrt(true_power)
   end function samples_agree

end module fine_window
