!> Lines of the acceleration at the harmonics of the forcing frequency.
module spectral_lines
   use fourier, only: amplitude_spectrum
   use kinds, only: dp
   use value_range, only: binary_unit
   implicit none(type, external)
   private

   !> Of the highest quarter of the resolved frequencies at most this share of a line may be left,
   !> else twice the samples would change a line by more than 0.1 %.
   real(dp), parameter :: sampling_tolerance = 1.0e-3_dp

   !> Error of integrals over the steps, relative to the largest harmonic.
   real(dp), parameter :: integral_error = 1.0e-8_dp

   !> Spectrum of a window of whole periods.
   type, public :: spectral_lines_t
      !> a_n: single-sided amplitude at n times the forcing frequency, every n below half the samples a period
      real(dp), allocatable :: harmonics(:)
      !> How many a_n exceed the line threshold times a_1, and whether there may be more beyond the highest of them
      integer :: line_count = 0
      logical :: count_is_bound = .false.
      !> sqrt(sum of a_n^2 from n = 2)/a_1, and whether it may be larger
      real(dp) :: harmonic_distortion = 0.0_dp
      logical :: distortion_is_bound = .false.
      !> Share of the power off the harmonics: 1 - sum a_n^2/(sum over all bins but the mean)
      real(dp) :: irregular_fraction = 0.0_dp
      !> Whether the samples a period, or the integrals over the steps, are enough for every line listed
      logical :: sampling_sufficient = .true.
      !> Error of a harmonic that lines beyond those resolved may make [m/s2]
      real(dp) :: resolution_error = 0.0_dp
      !> Whether there is any motion: without it the ratios above have no meaning
      logical :: moving = .true.
   end type spectral_lines_t

   public :: find_lines, find_lines_by_integrals

contains

   !> Lines of a window of acceleration samples.
   subroutine find_lines(acceleration, periods, line_threshold, noise_floor, lines)
      !> Samples of whole periods, the same count in each [m/s2]
      real(dp), intent(in) :: acceleration(:)
      !> Periods in the window, a divisor of the count of samples
      integer, intent(in) :: periods
      !> A harmonic above this share of the first is a line [-]
      real(dp), intent(in) :: line_threshold
      !> Amplitude that the errors of the solution explain [m/s2]
      real(dp), intent(in) :: noise_floor
      !> The lines
      type(spectral_lines_t), intent(out) :: lines
      real(dp), allocatable :: amplitudes(:)

      call amplitude_spectrum(acceleration, amplitudes)
      ! A line stands for two bins of the transform; that at half the samples is one bin, whose square counts twice.
      call lines_of_bins(amplitudes, periods, (size(acceleration)/periods - 1)/2, mod(size(acceleration), 2) == 0, &
                         line_threshold, noise_floor, lines)
      lines%count_is_bound = .not. lines%sampling_sufficient
      lines%distortion_is_bound = .not. lines%sampling_sufficient
   end subroutine find_lines

   !> Lines of a window from harmonics found by integrals over its steps, and its power: what lies beyond the highest harmonic is
   !> power too.
   pure subroutine find_lines_by_integrals(harmonics, irregular_fraction, power, line_threshold, noise_floor, lines)
      !> a_1, a_2, ... [m/s2]
      real(dp), intent(in) :: harmonics(:)
      !> Share of the power off the harmonics
      real(dp), intent(in) :: irregular_fraction
      !> Twice the mean square of z'' about its mean: the sum of the squares of all lines [m2/s4]
      real(dp), intent(in) :: power
      !> A harmonic above this share of the first is a line [-]
      real(dp), intent(in) :: line_threshold
      !> Amplitude that the errors of the solution explain [m/s2]
      real(dp), intent(in) :: noise_floor
      !> The lines
      type(spectral_lines_t), intent(out) :: lines
      real(dp) :: tail

      allocate (lines%harmonics, source=harmonics)
      lines%resolution_error = integral_error*maxval(harmonics)
      lines%moving = sqrt(max(0.0_dp, power)) > noise_floor
      if (.not. lines%moving) return
      lines%irregular_fraction = irregular_fraction
      lines%line_count = count(harmonics > line_threshold*harmonics(1))
      tail = maxval(harmonics((3*size(harmonics))/4 + 1:))
      lines%count_is_bound = tail > max(noise_floor, sampling_tolerance*line_threshold*harmonics(1))
      lines%harmonic_distortion = huge(1.0_dp)
      if (harmonics(1) > noise_floor) lines%harmonic_distortion = &
         max(norm2(harmonics(2:)/harmonics(1)), &
             sqrt(max(0.0_dp, (1.0_dp - irregular_fraction)*(power/harmonics(1))/harmonics(1) - 1.0_dp)))
   end subroutine find_lines_by_integrals

   !> Lines of a window from the amplitudes of its bins.
   subroutine lines_of_bins(amplitudes, periods, resolved, last_is_half, line_threshold, noise_floor, lines)
      !> Amplitudes from 0 on; on return in another unit
      real(dp), allocatable, intent(inout) :: amplitudes(:)
      !> Periods in the window
      integer, intent(in) :: periods
      !> Harmonics that are resolved
      integer, intent(in) :: resolved
      !> Whether the last bin stands for one bin of the transform alone
      logical, intent(in) :: last_is_half
      real(dp), intent(in) :: line_threshold
      real(dp), intent(in) :: noise_floor
      type(spectral_lines_t), intent(out) :: lines
      real(dp) :: unit, power, harmonic_power, least
      integer :: highest

      highest = ubound(amplitudes, 1)
      ! All that follows is in a unit in which no square overflows or vanishes.
      unit = binary_unit(amplitudes)
      amplitudes(:) = amplitudes*(1.0_dp/unit)
      least = noise_floor*(1.0_dp/unit)
      allocate (lines%harmonics(resolved))
      lines%harmonics(:) = amplitudes(periods:resolved*periods:periods)
      power = sum(amplitudes(1:)**2)
      if (last_is_half) power = power + amplitudes(highest)**2
      harmonic_power = sum(lines%harmonics**2)
      lines%moving = sqrt(power) > least
      if (lines%moving) then
         lines%irregular_fraction = max(0.0_dp, 1.0_dp - harmonic_power/power)
         lines%line_count = count(lines%harmonics > line_threshold*lines%harmonics(1))
         lines%harmonic_distortion = huge(1.0_dp)
         if (lines%harmonics(1) > least) &
            lines%harmonic_distortion = sqrt(sum(lines%harmonics(2:)**2))/lines%harmonics(1)
         ! Samples fold what lies beyond the highest resolved frequencies back upon the lines.
         lines%resolution_error = maxval(amplitudes((3*highest)/4 + 1:))
         lines%sampling_sufficient = lines%resolution_error <= &
                                     max(least, sampling_tolerance*line_threshold*lines%harmonics(1))
         lines%resolution_error = lines%resolution_error*unit
      end if
      lines%harmonics(:) = lines%harmonics*unit
   end subroutine lines_of_bins

end module spectral_lines
