!> Harmonics of the acceleration, at multiples of the forcing frequency.
module harmonic_spectrum
   use fourier, only: amplitude_spectrum
   use kinds, only: dp
   use scene_types, only: spectrum_choice_t
   use value_range, only: binary_unit
   implicit none(type, external)
   private

   !> Of the highest quarter of the resolved frequencies at most this share of a harmonic may be left,
   !> else twice the samples would change a harmonic by more than 0.1 %.
   real(dp), parameter :: sampling_tolerance = 1.0e-3_dp

   !> Error of integrals over the steps, relative to the largest harmonic.
   real(dp), parameter :: integral_error = 1.0e-8_dp

   !> Spectrum of a window of whole periods.
   type, public :: harmonic_spectrum_t
      !> a_n: single-sided amplitude at n times the forcing frequency, every n below half the samples a period
      real(dp), allocatable :: harmonics(:)
      !> Order of the largest forced harmonic, with which others are compared, and root of the sum of squares of all forced
      !> harmonics [m/s2]
      integer :: largest_forced = 1
      real(dp) :: forced_amplitude = 0.0_dp
      !> How many multiples of the dominant order of the force have harmonics about them that exceed the harmonic threshold times
      !> the largest forced one, of the forced ones that alone, and whether there may be more beyond the highest of them
      integer :: harmonic_count = 0
      logical :: count_is_bound = .false.
      !> Multiple of the dominant order up to which `reach_share` of the power at harmonics that are not forced lies [-]; 0: unknown
      real(dp) :: spectral_reach = 0.0_dp
      !> Root of the sum of squares of all harmonics that are not forced, over that of the forced ones, and whether it may be larger
      real(dp) :: harmonic_distortion = 0.0_dp
      logical :: distortion_is_bound = .false.
      !> Share of the power that varies from period to period: 1 - sum a_n^2/(sum over all bins but the mean)
      real(dp) :: varying_fraction = 0.0_dp
      !> The same, with harmonics that are no multiples of the common order of the force, and whether it may be larger
      real(dp) :: irregular_fraction = 0.0_dp
      logical :: irregular_is_bound = .false.
      !> Whether the samples a period, or the integrals over the steps, are enough for every harmonic listed
      logical :: sampling_sufficient = .true.
      !> Error of a harmonic that harmonics beyond those resolved may make [m/s2]
      real(dp) :: resolution_error = 0.0_dp
      !> Whether there is any motion: without it the ratios above have no meaning
      logical :: moving = .true.
   end type harmonic_spectrum_t

   !> Share of the power beyond the forced harmonics that `spectral_reach` leaves below it.
   real(dp), parameter :: reach_share = 0.99_dp

   public :: find_harmonics, find_harmonics_by_integrals, gather_about_multiples

contains

   !> Harmonics of a window of acceleration samples.
   subroutine find_harmonics(acceleration, periods, choice, noise_floor, spectrum)
      !> Samples of whole periods, the same count in each [m/s2]
      real(dp), intent(in) :: acceleration(:)
      !> Periods in the window, a divisor of the count of samples
      integer, intent(in) :: periods
      !> Orders of the force, and the threshold above which a harmonic counts
      type(spectrum_choice_t), intent(in) :: choice
      !> Amplitude that the errors of the solution explain [m/s2]
      real(dp), intent(in) :: noise_floor
      !> The harmonics
      type(harmonic_spectrum_t), intent(out) :: spectrum
      real(dp), allocatable :: amplitudes(:)

      call amplitude_spectrum(acceleration, amplitudes)
      ! A harmonic stands for two bins of the transform; that at half the samples is one bin, whose square counts twice.
      call harmonics_of_bins(amplitudes, periods, (size(acceleration)/periods - 1)/2, mod(size(acceleration), 2) == 0, &
                             choice, noise_floor, spectrum)
      if (.not. spectrum%sampling_sufficient) spectrum%spectral_reach = 0.0_dp
      spectrum%count_is_bound = .not. spectrum%sampling_sufficient
      spectrum%distortion_is_bound = .not. spectrum%sampling_sufficient
      spectrum%irregular_is_bound = .not. spectrum%sampling_sufficient
   end subroutine find_harmonics

   !> Harmonics of a window from harmonics found by integrals over its steps, and its power: what lies beyond the highest harmonic
   !> is power too.
   pure subroutine find_harmonics_by_integrals(harmonics, harmonic_power, known_beyond, power, choice, noise_floor, spectrum)
      !> a_1, a_2, ... [m/s2]
      real(dp), intent(in) :: harmonics(:)
      !> Power that belongs to harmonics, in units of `power`
      real(dp), intent(in) :: harmonic_power
      !> Whether that is known of the power beyond the highest harmonic, too; else the harmonic distortion is a lower bound,
      !> that of the harmonics resolved
      logical, intent(in) :: known_beyond
      !> Twice the mean square of z'' about its mean: the sum of the squares of all harmonics [m2/s4]
      real(dp), intent(in) :: power
      !> Orders of the force, and the threshold above which a harmonic counts
      type(spectrum_choice_t), intent(in) :: choice
      !> Amplitude that the errors of the solution explain [m/s2]
      real(dp), intent(in) :: noise_floor
      !> The harmonics
      type(harmonic_spectrum_t), intent(out) :: spectrum
      real(dp) :: unforced(size(harmonics)), tail, unforced_amplitude

      allocate (spectrum%harmonics, source=harmonics)
      call hold_against_force(harmonics, choice%forced, spectrum%largest_forced, spectrum%forced_amplitude, unforced)
      spectrum%resolution_error = integral_error*maxval(harmonics)
      spectrum%moving = sqrt(max(0.0_dp, power)) > noise_floor
      if (.not. spectrum%moving) return
      spectrum%distortion_is_bound = .not. known_beyond
      spectrum%harmonic_count = harmonics_above(harmonics(spectrum%largest_forced), unforced, choice)
      tail = maxval(harmonics((3*size(harmonics))/4 + 1:))
      spectrum%count_is_bound = tail > max(noise_floor, sampling_tolerance* &
                                           choice%harmonic_threshold*harmonics(spectrum%largest_forced))
      spectrum%harmonic_distortion = huge(1.0_dp)
      associate (forced_amplitude => spectrum%forced_amplitude)
         if (forced_amplitude > noise_floor) then
            spectrum%harmonic_distortion = norm2(unforced/forced_amplitude)
            if (known_beyond) spectrum%harmonic_distortion = max(spectrum%harmonic_distortion, sqrt(max(0.0_dp, &
               (harmonic_power/forced_amplitude)/forced_amplitude - 1.0_dp)))
         end if
      end associate
      unforced_amplitude = max(norm2(unforced), sqrt(max(0.0_dp, harmonic_power - spectrum%forced_amplitude**2)))
      if (known_beyond .and. unforced_amplitude > noise_floor) &
         spectrum%spectral_reach = reach_of(unforced, choice%dominant_order, unforced_amplitude)
   end subroutine find_harmonics_by_integrals

   !> Harmonics of a window from the amplitudes of its bins.
   subroutine harmonics_of_bins(amplitudes, periods, resolved, last_is_half, choice, noise_floor, spectrum)
      !> Amplitudes from 0 on; on return in another unit
      real(dp), allocatable, intent(inout) :: amplitudes(:)
      !> Periods in the window
      integer, intent(in) :: periods
      !> Harmonics that are resolved
      integer, intent(in) :: resolved
      !> Whether the last bin stands for one bin of the transform alone
      logical, intent(in) :: last_is_half
      type(spectrum_choice_t), intent(in) :: choice
      real(dp), intent(in) :: noise_floor
      type(harmonic_spectrum_t), intent(out) :: spectrum
      real(dp) :: unforced(resolved), unit, power, least
      integer :: highest

      highest = ubound(amplitudes, 1)
      ! All that follows is in a unit in which no square overflows or vanishes.
      unit = binary_unit(amplitudes)
      amplitudes(:) = amplitudes*(1.0_dp/unit)
      least = noise_floor*(1.0_dp/unit)
      allocate (spectrum%harmonics(resolved))
      spectrum%harmonics(:) = amplitudes(periods:resolved*periods:periods)
      power = sum(amplitudes(1:)**2)
      if (last_is_half) power = power + amplitudes(highest)**2
      spectrum%moving = sqrt(power) > least
      call hold_against_force(spectrum%harmonics, choice%forced, spectrum%largest_forced, spectrum%forced_amplitude, unforced)
      if (spectrum%moving) then
         spectrum%varying_fraction = max(0.0_dp, 1.0_dp - sum(spectrum%harmonics**2)/power)
         spectrum%irregular_fraction = max(0.0_dp, 1.0_dp - &
                                           sum(spectrum%harmonics(choice%common_order::choice%common_order)**2)/power)
         spectrum%harmonic_count = harmonics_above(spectrum%harmonics(spectrum%largest_forced), unforced, choice)
         if (norm2(unforced) > least) spectrum%spectral_reach = reach_of(unforced, choice%dominant_order, norm2(unforced))
         spectrum%harmonic_distortion = huge(1.0_dp)
         if (spectrum%forced_amplitude > least) &
            spectrum%harmonic_distortion = sqrt(unforced(1)**2 + sum(unforced(2:)**2))/spectrum%forced_amplitude
         ! Samples fold what lies beyond the highest resolved frequencies back upon the harmonics.
         spectrum%resolution_error = maxval(amplitudes((3*highest)/4 + 1:))
         spectrum%sampling_sufficient = spectrum%resolution_error <= &
                                max(least, sampling_tolerance*choice%harmonic_threshold*spectrum%harmonics(spectrum%largest_forced))
         spectrum%resolution_error = spectrum%resolution_error*unit
      end if
      spectrum%harmonics(:) = spectrum%harmonics*unit
      spectrum%forced_amplitude = spectrum%forced_amplitude*unit
   end subroutine harmonics_of_bins

   !> Which harmonic the others are compared with: the largest at an order of the force.
   pure subroutine hold_against_force(harmonics, forced, largest, amplitude, unforced)
      real(dp), intent(in) :: harmonics(:)
      !> Orders of the force; of those beyond the harmonics nothing is known
      logical, intent(in) :: forced(:)
      !> Order of the largest forced harmonic
      integer, intent(out) :: largest
      !> Root of the sum of squares of the forced harmonics
      real(dp), intent(out) :: amplitude
      !> The harmonics, 0 where they are forced
      real(dp), intent(out) :: unforced(:)
      logical :: mask(size(harmonics))
      integer :: known

      known = min(size(harmonics), size(forced))
      mask = .false.
      mask(:known) = forced(:known)
      largest = max(1, maxloc(harmonics, dim=1, mask=mask))
      unforced = merge(0.0_dp, harmonics, mask)
      amplitude = harmonics(largest)
      if (amplitude > 0.0_dp) amplitude = amplitude*sqrt(sum((merge(harmonics, 0.0_dp, mask)/amplitude)**2))
   end subroutine hold_against_force

   !> Multiples of the dominant order with harmonics above a share of the largest forced one: that one, and those about which
   !> harmonics are not forced. Of a force that is one cosine every harmonic is such a multiple.
   pure integer function harmonics_above(largest_forced, unforced, choice)
      !> [m/s2]
      real(dp), intent(in) :: largest_forced
      real(dp), intent(in) :: unforced(:)
      type(spectrum_choice_t), intent(in) :: choice

      associate (gathered => gather_about_multiples(unforced, choice%dominant_order), &
                 least => choice%harmonic_threshold*largest_forced)
         harmonics_above = merge(1, 0, largest_forced > least) + count(gathered(2:) > least)
      end associate
   end function harmonics_above

   !> Root of the sum of squares of the harmonics about each multiple of an order: those nearer to it than to others, half way
   !> between two those of the upper one; those below the first with that. It depends on the orders as multiples of that one alone,
   !> not on the period that they are multiples of.
   pure function gather_about_multiples(harmonics, dominant) result(gathered)
      !> a_1, a_2, ...
      real(dp), intent(in) :: harmonics(:)
      integer, intent(in) :: dominant
      real(dp) :: gathered(max(1, (2*size(harmonics) + dominant)/(2*dominant)))
      integer :: multiple, first, last

      first = 1
      do multiple = 1, size(gathered)
         last = min(size(harmonics), ((2*multiple + 1)*dominant + 1)/2 - 1)
         gathered(multiple) = norm2(harmonics(first:last))
         first = last + 1
      end do
   end function gather_about_multiples

   !> Multiple of the dominant order up to which nearly all of an amplitude lies, between two by their shares of the power; 0 if
   !> less lies at the harmonics.
   pure real(dp) function reach_of(unforced, dominant, amplitude) result(reach)
      real(dp), intent(in) :: unforced(:)
      integer, intent(in) :: dominant
      !> Root of the sum of squares of all harmonics that are not forced, above 0
      real(dp), intent(in) :: amplitude
      real(dp) :: below, here
      integer :: multiple

      reach = 0.0_dp
      below = 0.0_dp
      associate (gathered => gather_about_multiples(unforced, dominant))
         do multiple = 1, size(gathered)
            here = (gathered(multiple)/amplitude)**2
            if (below + here >= reach_share) then
               reach = real(multiple - 1, dp) + (reach_share - below)/here
               return
            end if
            below = below + here
         end do
      end associate
   end function reach_of

end module harmonic_spectrum
