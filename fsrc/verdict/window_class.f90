!> Class of a window by its samples, and whether they are enough.
module window_class
   use carried_loads, only: acceleration_at
   use kinds, only: dp
   use problem, only: of_velocity, problem_t
   use rattle_class, only: classify, rattle_verdict_t
   use scene_types, only: spectrum_choice_t
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Share of the first harmonic by which the mean of the samples may miss the change of velocity, and of the power by which
   !> theirs may miss that of the steps: a harmonic may then be off by a tenth of the harmonic threshold at most.
   real(dp), parameter :: mean_share = 1.0e-5_dp, power_share = 1.0e-6_dp

   public :: classify_window

contains

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
      !> What the steps show; no periods: the samples are all that is known
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

end module window_class
