!> Tests of the harmonics of a window on made signals.
module test_harmonic_spectrum
   use checks, only: check_list_t
   use kinds, only: dp
   use harmonic_spectrum, only: find_harmonics, gather_about_multiples, harmonic_spectrum_t
   use scene_types, only: note_orders, spectrum_choice_t
   implicit none(type, external)
   private

   real(dp), parameter :: two_pi = 8.0_dp*atan(1.0_dp)
   !> Of transforms of some hundred samples of order ten.
   real(dp), parameter :: rounding = 1.0e-13_dp

   public :: run_harmonic_spectrum_tests

contains

   !> Runs every test of this topic.
   subroutine run_harmonic_spectrum_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('harmonic_spectrum')
      call test_harmonics(checks)
      call test_subharmonics(checks)
      call test_odd_counts(checks)
      call test_invariance(checks)
      call test_period_of_force(checks)
      call test_gathering(checks)
      call test_rest(checks)
      call test_size(checks)
      call test_sampling(checks)
   end subroutine run_harmonic_spectrum_tests

   !> Counts and reach are those of multiples of the dominant order, whatever period its force is written with: the same signal with
   !> the cycle twice or three times as long, and with small harmonics between.
   subroutine test_period_of_force(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      ! The last harmonic takes 0.0016 of 4.0052 of the power beyond the first: 99 % lie within the second.
      real(dp), parameter :: amplitudes(4) = [5.0_dp, 2.0_dp, 0.06_dp, 0.04_dp]
      real(dp) :: lines(60), halves(80)
      type(harmonic_spectrum_t) :: spectrum
      type(spectrum_choice_t) :: choice
      integer :: longer

      do longer = 1, 5
         call note_orders([longer], [1.0_dp], choice)
         lines = 0.0_dp
         lines(longer:4*longer:longer) = amplitudes
         halves = 0.0_dp
         halves(2::2) = lines(:40)
         call find_harmonics(signal(2, 128, halves, 0), 2, choice, 1.0e-9_dp, spectrum)
         call checks%check(spectrum%harmonic_count == 3, 'a longer cycle: as many')
         call checks%check_close(spectrum%spectral_reach, 1.0_dp + 0.99_dp*4.0052_dp/4.0_dp, 1.0e-10_dp, 'a longer cycle: reach')
         if (longer == 1) cycle
         ! Harmonics between, below the threshold each and together.
         lines(1) = 0.02_dp
         lines(2*longer + 1) = 0.02_dp
         halves(2::2) = lines(:40)
         call find_harmonics(signal(2, 128, halves, 0), 2, choice, 1.0e-9_dp, spectrum)
         call checks%check(spectrum%harmonic_count == 3, 'small ones between: as many')
         call checks%check_close(spectrum%spectral_reach, 1.0_dp + 0.99_dp*4.0052_dp/4.0_dp, 1.0e-3_dp, 'small ones: reach')
      end do
   end subroutine test_period_of_force

   !> What lies about a multiple belongs to it: half way between two to the upper one, below the first to that.
   subroutine test_gathering(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      real(dp), parameter :: ones(9) = 1.0_dp
      type(spectrum_choice_t) :: choice

      call checks%check_close(maxval(abs(gather_about_multiples(ones, 1)/ones - 1.0_dp)), 0.0_dp, 0.0_dp, 'each its own')
      call checks%check(size(gather_about_multiples(ones, 2)) == 5, 'nine harmonics about five multiples of 2')
      call checks%check_close(maxval(abs(gather_about_multiples(ones, 2) - sqrt([2.0_dp, 2.0_dp, 2.0_dp, 2.0_dp, 1.0_dp]))), &
                              0.0_dp, 1.0e-15_dp, '1 2, 3 4, 5 6, 7 8, 9')
      call checks%check_close(maxval(abs(gather_about_multiples(ones, 3) - sqrt([4.0_dp, 3.0_dp, 2.0_dp]))), 0.0_dp, 1.0e-15_dp, &
                              '1 to 4, 5 to 7, 8 and on')
      call checks%check_close(maxval(abs(gather_about_multiples(ones, 20) - 3.0_dp)), 0.0_dp, 1.0e-15_dp, 'all below the first')
      call note_orders([2, 4, 1], [3.0_dp, 5.0_dp, 1.0_dp], choice)
      call checks%check(choice%dominant_order == 4, 'the order with the largest force')
      call note_orders([4, 2], [5.0_dp, 5.0_dp*(1.0_dp - epsilon(1.0_dp))], choice)
      call checks%check(choice%dominant_order == 2, 'the lowest of equal ones, however they are written')
   end subroutine test_gathering

   !> Cosines of given amplitudes at 1/2, 1, 3/2, ... of the forcing frequency, each with its own phase.
   function signal(periods, steps, halves, shift) result(samples)
      integer, intent(in) :: periods     !> Periods of the force
      integer, intent(in) :: steps       !> Samples a period
      real(dp), intent(in) :: halves(:)  !> Amplitudes at the multiples of half the forcing frequency
      integer, intent(in) :: shift       !> Samples by which it begins later
      real(dp) :: samples(periods*steps)

      integer :: i, k

      samples = 3.0_dp
      do k = 1, size(halves)
         samples = samples + halves(k)*cos([(two_pi*0.5_dp*real(k*(i + shift), dp)/real(steps, dp) &
            + 0.3_dp*real(k, dp), &
            i=1, periods*steps)])
      end do
   end function signal

   !> Three harmonics and a mean.
   subroutine test_harmonics(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(harmonic_spectrum_t) :: spectrum

      call find_harmonics(signal(16, 32, [0.0_dp, 5.0_dp, 0.0_dp, 2.0_dp, 0.0_dp, 0.04_dp, 0.0_dp, 0.06_dp], &
         0), 16, spectrum_choice_t(), 1.0e-9_dp, spectrum)
      call checks%check(size(spectrum%harmonics) == 15, 'harmonics below half the samples a period')
      call checks%check_close(spectrum%harmonics(1), 5.0_dp, rounding, 'first harmonic')
      call checks%check_close(spectrum%harmonics(2), 2.0_dp, rounding, 'second harmonic')
      call checks%check_close(spectrum%harmonics(3), 0.04_dp, rounding, 'third harmonic')
      call checks%check_close(spectrum%harmonics(4), 0.06_dp, rounding, 'fourth harmonic')
      call checks%check_close(maxval(spectrum%harmonics(5:)), 0.0_dp, rounding, 'no further harmonic')
      call checks%check(spectrum%harmonic_count == 3, 'harmonics over 1 % of the first')
      call checks%check_close(spectrum%harmonic_distortion, sqrt(4.0_dp + 0.0016_dp + 0.0036_dp)/5.0_dp, &
         rounding, 'distortion')
      call checks%check_close(spectrum%irregular_fraction, 0.0_dp, rounding, 'nothing off the harmonics')
      call checks%check(spectrum%moving .and. spectrum%sampling_sufficient, 'moving, well sampled')
   end subroutine test_harmonics

   !> Harmonics between the harmonics are the irregular share of the power; the mean is no part of it.
   subroutine test_subharmonics(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(harmonic_spectrum_t) :: spectrum

      call find_harmonics(signal(16, 32, [1.0_dp, 2.0_dp, 2.0_dp, 4.0_dp], 0), 16, spectrum_choice_t(), 1.0e-9_dp, spectrum)
      call checks%check_close(spectrum%irregular_fraction, 5.0_dp/25.0_dp, rounding, 'half-integer harmonics')
      call checks%check_close(spectrum%harmonics(2), 4.0_dp, rounding, 'the harmonics beside them')
      call find_harmonics(signal(16, 32, [1.0_dp], 0), 16, spectrum_choice_t(), 1.0e-9_dp, spectrum)
      call checks%check_close(spectrum%irregular_fraction, 1.0_dp, rounding, 'nothing but a half-integer harmonic')
      call checks%check(spectrum%harmonic_distortion >= huge(1.0_dp), &
         'no first harmonic: distortion without bound')
   end subroutine test_subharmonics

   !> Odd numbers of samples a period and of periods.
   subroutine test_odd_counts(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: periods(4) = [1, 3, 7, 8], steps(4) = [33, 27, 16, 25]
      type(harmonic_spectrum_t) :: spectrum
      integer :: i

      do i = 1, 4
         call find_harmonics(signal(periods(i), steps(i), [0.0_dp, 5.0_dp, 0.0_dp, 2.0_dp], 0), periods(i), &
                             spectrum_choice_t(), 1.0e-9_dp, spectrum)
         call checks%check(size(spectrum%harmonics) == (steps(i) - 1)/2, 'odd counts: number of harmonics')
         call checks%check_close(spectrum%harmonics(1), 5.0_dp, rounding, 'odd counts: first harmonic')
         call checks%check_close(spectrum%harmonics(2), 2.0_dp, rounding, 'odd counts: second harmonic')
         call checks%check_close(spectrum%irregular_fraction, 0.0_dp, rounding, 'odd counts: regular')
      end do
      ! A harmonic at half the samples counts once, not twice, in the power.
      call find_harmonics([(3.0_dp*cos(two_pi*real(i, dp)/8.0_dp) + 4.0_dp*real(1 - 2*modulo(i, 2), dp), i=1, &
         8)], 1, spectrum_choice_t(), 1.0e-9_dp, spectrum)
      call checks%check_close(spectrum%irregular_fraction, 1.0_dp - 9.0_dp/(9.0_dp + 2.0_dp*16.0_dp), rounding, &
         'power of the highest bin')
   end subroutine test_odd_counts

   !> The start of the window and twice the samples change nothing.
   subroutine test_invariance(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: halves(6) = [0.5_dp, 5.0_dp, 0.25_dp, 2.0_dp, 0.0_dp, 1.0_dp]
      type(harmonic_spectrum_t) :: spectrum, shifted, doubled

      call find_harmonics(signal(16, 32, halves, 0), 16, spectrum_choice_t(), 1.0e-9_dp, spectrum)
      call find_harmonics(signal(16, 32, halves, 13), 16, spectrum_choice_t(), 1.0e-9_dp, shifted)
      call find_harmonics(signal(16, 64, halves, 0), 16, spectrum_choice_t(), 1.0e-9_dp, doubled)
      call checks%check_close(maxval(abs(spectrum%harmonics - shifted%harmonics)), 0.0_dp, rounding, &
         'shifted: harmonics')
      call checks%check_close(shifted%irregular_fraction, spectrum%irregular_fraction, rounding, &
         'shifted: irregular share')
      call checks%check_close(maxval(abs(spectrum%harmonics - doubled%harmonics(:15))), 0.0_dp, rounding, &
         'doubled: harmonics')
      call checks%check_close(doubled%irregular_fraction, spectrum%irregular_fraction, rounding, &
         'doubled: irregular share')
      call checks%check(shifted%harmonic_count == spectrum%harmonic_count .and. doubled%harmonic_count == spectrum%harmonic_count, &
         'number of harmonics')
   end subroutine test_invariance

   !> Nothing but a mean, and motion below the noise, are no motion.
   subroutine test_rest(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: at_rest(64) = 0.0_dp
      type(harmonic_spectrum_t) :: spectrum

      call find_harmonics(at_rest, 4, spectrum_choice_t(), 1.0e-9_dp, spectrum)
      call checks%check(.not. spectrum%moving .and. spectrum%harmonic_count == 0, 'zero signal')
      call find_harmonics(at_rest + 7.0_dp, 4, spectrum_choice_t(), 1.0e-9_dp, spectrum)
      call checks%check(.not. spectrum%moving, 'constant signal')
      call find_harmonics(signal(4, 16, [0.0_dp, 0.9e-9_dp], 0), 4, spectrum_choice_t(), 1.0e-9_dp, spectrum)
      call checks%check(.not. spectrum%moving, 'below the noise')
      call find_harmonics(signal(4, 16, [0.0_dp, 1.1e-9_dp], 0), 4, spectrum_choice_t(), 1.0e-9_dp, spectrum)
      call checks%check(spectrum%moving, 'above the noise')
   end subroutine test_rest

   !> Harmonics of any size have the ratios of harmonics of ordinary size, to the last bit.
   subroutine test_size(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: exponents(3) = [-900, 512, 1000]
      type(harmonic_spectrum_t) :: spectrum, scaled
      integer :: i

      call find_harmonics(signal(16, 32, [0.0_dp, 5.0_dp, 0.0_dp, 2.0_dp], 0), 16, spectrum_choice_t(), 1.0e-9_dp, spectrum)
      do i = 1, size(exponents)
         call find_harmonics(scale(signal(16, 32, [0.0_dp, 5.0_dp, 0.0_dp, 2.0_dp], 0), exponents(i)), 16, &
                             spectrum_choice_t(), scale(1.0e-9_dp, exponents(i)), scaled)
         call checks%check(scaled%moving .and. scaled%harmonic_count == spectrum%harmonic_count, 'size: harmonics')
         call checks%check_close(scaled%irregular_fraction, spectrum%irregular_fraction, 0.0_dp, 'size: irregular share')
         call checks%check_close(scaled%harmonic_distortion, spectrum%harmonic_distortion, 0.0_dp, 'size: distortion')
         call checks%check(scaled%sampling_sufficient .eqv. spectrum%sampling_sufficient, 'size: sampling')
      end do
   end subroutine test_size

   !> A harmonic near half the samples says that there are too few of them.
   subroutine test_sampling(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: halves(30)
      type(harmonic_spectrum_t) :: spectrum

      halves = 0.0_dp
      halves(2) = 10.0_dp
      halves(26) = 2.0e-4_dp
      call find_harmonics(signal(2, 32, halves, 0), 2, spectrum_choice_t(), 1.0e-9_dp, spectrum)
      call checks%check(.not. spectrum%sampling_sufficient, 'thirteenth harmonic of 32 samples')
      halves(26) = 0.5e-4_dp
      call find_harmonics(signal(2, 32, halves, 0), 2, spectrum_choice_t(), 1.0e-9_dp, spectrum)
      call checks%check(spectrum%sampling_sufficient, 'thirteenth harmonic, small enough')
      halves(22) = 2.0e-4_dp
      call find_harmonics(signal(2, 32, halves, 0), 2, spectrum_choice_t(), 1.0e-9_dp, spectrum)
      call checks%check(spectrum%sampling_sufficient, 'eleventh harmonic of 32 samples')
   end subroutine test_sampling

end module test_harmonic_spectrum
