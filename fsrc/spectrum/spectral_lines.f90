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

   !> Spectrum of a window of whole periods.
   type, public :: spectral_lines_t
      !> a_n: single-sided amplitude at n times the forcing frequency, every n below half the samples a period
      real(dp), allocatable :: harmonics(:)
      !> How many a_n exceed the line threshold times a_1
      integer :: line_count = 0
      !> sqrt(sum of a_n^2 from n = 2)/a_1
      real(dp) :: harmonic_distortion = 0.0_dp
      !> Share of the power off the harmonics: 1 - sum a_n^2/(sum over all bins but the mean)
      real(dp) :: irregular_fraction = 0.0_dp
      !> Whether the samples a period are enough for every line
      logical :: sampling_sufficient = .true.
      !> Whether there is any motion: without it the ratios above have no meaning
      logical :: moving = .true.
   end type spectral_lines_t

   public :: find_lines

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
      real(dp) :: unit, power, harmonic_power, least
      integer :: resolved, highest

      call amplitude_spectrum(acceleration, amplitudes)
      highest = ubound(amplitudes, 1)
      resolved = (size(acceleration)/periods - 1)/2
      ! All that follows is in a unit in which no square overflows or vanishes.
      unit = binary_unit(amplitudes)
      amplitudes(:) = amplitudes*(1.0_dp/unit)
      least = noise_floor*(1.0_dp/unit)
      allocate (lines%harmonics(resolved))
      lines%harmonics(:) = amplitudes(periods:resolved*periods:periods)
      ! A line stands for two bins of the transform; that at half the samples is one bin, whose square counts twice.
      power = sum(amplitudes(1:)**2)
      if (mod(size(acceleration), 2) == 0) power = power + amplitudes(highest)**2
      harmonic_power = sum(lines%harmonics**2)
      lines%moving = sqrt(power) > least
      if (lines%moving) then
         lines%irregular_fraction = max(0.0_dp, 1.0_dp - harmonic_power/power)
         lines%line_count = count(lines%harmonics > line_threshold*lines%harmonics(1))
         lines%harmonic_distortion = huge(1.0_dp)
         if (lines%harmonics(1) > least) &
            lines%harmonic_distortion = sqrt(sum(lines%harmonics(2:)**2))/lines%harmonics(1)
         lines%sampling_sufficient = maxval(amplitudes((3*highest)/4 + 1:)) <= &
                                     max(least, sampling_tolerance*line_threshold*lines%harmonics(1))
      end if
      lines%harmonics(:) = lines%harmonics*unit
   end subroutine find_lines

end module spectral_lines
