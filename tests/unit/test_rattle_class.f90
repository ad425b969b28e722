!> Tests of the class of a motion on made signals, at both sides of every limit.
module test_rattle_class
   use checks, only: check_list_t
   use kinds, only: dp
   use quantities, only: quantity_rattle_class, quantity_word
   use rattle_class, only: class_creep, class_idle, class_irregular_so_far, class_quiet, class_subharmonic, classify, &
      classify_steps, note_orbit, rattle_verdict_t
   use scene_types, only: note_orders, spectrum_choice_t
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   integer, parameter :: periods = 4, steps = 256
   real(dp), parameter :: two_pi = 8.0_dp*atan(1.0_dp), noise_floor = 1.0e-9_dp

   public :: run_rattle_class_tests

contains

   !> Runs every test of this topic.
   subroutine run_rattle_class_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: amplitudes(60)

      call checks%start('rattle_class')

      amplitudes = 0.0_dp
      call expect(amplitudes, 0.0_dp, class_quiet, 'no motion')
      amplitudes(1) = 1.0_dp
      call expect(amplitudes, 0.0_dp, class_quiet, 'one harmonic')
      amplitudes(2) = 0.34_dp
      call expect(amplitudes, 0.0_dp, class_quiet, 'distortion 0.34')
      amplitudes(2) = 0.36_dp
      call expect(amplitudes, 0.0_dp, class_creep, 'distortion 0.36')
      amplitudes(3:19) = 0.011_dp
      call expect(amplitudes, 0.0_dp, class_creep, '19 harmonics')
      amplitudes(20) = 0.011_dp
      call expect(amplitudes, 0.0_dp, class_idle, '20 harmonics')
      amplitudes(20) = 0.009_dp
      call expect(amplitudes, 0.0_dp, class_creep, 'the twentieth below the threshold')
      amplitudes = 0.011_dp
      amplitudes(1) = 1.0_dp
      call expect(amplitudes, 0.0_dp, class_quiet, 'many small harmonics are no rattle')
      ! The irregular share of a half-integer harmonic b beside a line of 1: b^2/(1 + b^2).
      amplitudes = 0.0_dp
      amplitudes(1) = 1.0_dp
      call expect(amplitudes, 0.09_dp, class_quiet, 'irregular share 0.0080')
      call expect(amplitudes, 0.11_dp, class_irregular_so_far, 'irregular share 0.0120')
      amplitudes(1:30) = 1.0_dp
      call expect(amplitudes, 2.0_dp, class_irregular_so_far, 'irregular before idle')

      call test_own_limits(checks)
      call test_reversals_per_period(checks)
      call test_known_orbit(checks)
      call test_orders_of_force(checks)
      call checks%check(word(class_quiet) == 'quiet' .and. word(class_creep) == 'creep' .and. word(class_idle) == 'idle' .and. &
         word(class_irregular_so_far) == 'irregular_so_far' .and. word(class_subharmonic) == 'subharmonic', 'words')

   contains

      !> Harmonics and a harmonic at half the forcing frequency, and their class.
      subroutine expect(harmonics, half_line, class, message)
         real(dp), intent(in) :: harmonics(:)  !> a_1, a_2, ...
         real(dp), intent(in) :: half_line     !> Amplitude at half the forcing frequency
         integer, intent(in) :: class          !> Its class
         character(*), intent(in) :: message   !> Name of the signal

         type(rattle_verdict_t) :: verdict

         call classify(signal(harmonics, half_line), spectrum_choice_t(periods=periods), noise_floor, verdict)
         call checks%check(verdict%class == class, message//' is '//word(class))
      end subroutine expect

   end subroutine run_rattle_class_tests

   !> Samples of a window.
   function signal(harmonics, half_line) result(samples)
      real(dp), intent(in) :: harmonics(:)  !> a_1, a_2, ...
      real(dp), intent(in) :: half_line     !> Amplitude at half the forcing frequency
      real(dp) :: samples(periods*steps)

      integer :: i, n

      samples = half_line*cos([(two_pi*0.5_dp*real(i, dp)/real(steps, dp), i=1, periods*steps)])
      do n = 1, size(harmonics)
         samples = samples + harmonics(n)*sin([(two_pi*real(n*i, dp)/real(steps, dp), i=1, periods*steps)])
      end do
   end function signal

   !> A motion that repeats with orders that the force has not got is subharmonic, however many periods of the others the list of
   !> orders makes a period; and the same by samples and by integrals over the steps.
   subroutine test_orders_of_force(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(spectrum_choice_t) :: choice
      real(dp) :: amplitudes(20)

      choice%periods = periods
      amplitudes = 0.0_dp
      amplitudes([4, 8]) = [1.0_dp, 0.6_dp]
      ! The second order, by whose half and three halves a period is doubled: 2 (0.05)^2/(1 + 0.6^2) is a share of 0.0037.
      amplitudes([2, 6]) = 0.05_dp
      call note_orders([4, 8], [1.0_dp, 0.4_dp], choice)
      call expect(class_quiet, 0.0037_dp, 'a little between the orders')
      call note_orders([1, 4, 8], [0.0_dp, 1.0_dp, 0.4_dp], choice)
      call expect(class_quiet, 0.0037_dp, 'an order of 0 beside them')
      amplitudes([2, 6]) = 0.1_dp
      call expect(class_subharmonic, 0.0145_dp, 'more than the limit')
      call note_orders([1, 4, 8], [0.0009_dp, 1.0_dp, 0.4_dp], choice)
      call expect(class_subharmonic, 0.0145_dp, 'with a trace of an order')
      call note_orders([1, 4, 8], [0.001_dp, 1.0_dp, 0.4_dp], choice)
      call expect(class_quiet, 0.0_dp, 'with an order of a thousandth')
      call note_orders([2, 8], [1.0_dp, 1.0_dp], choice)
      call expect(class_creep, 0.0_dp, 'harmonics of orders of the force')
      call note_orders([200, 300], [1.0_dp, 1.0_dp], choice)
      call expect(class_subharmonic, 1.0_dp, 'harmonics below the common order')

   contains

      !> Class and share of the power off the harmonics, by samples and by steps.
      subroutine expect(class, share, message)
         integer, intent(in) :: class
         real(dp), intent(in) :: share
         character(*), intent(in) :: message
         type(rattle_verdict_t) :: by_samples, by_steps

         call classify(signal(amplitudes, 0.0_dp), choice, noise_floor, by_samples)
         call classify_steps(record_of(amplitudes), 0.5_dp, choice, noise_floor, by_steps)
         call checks%check(by_samples%class == class, 'orders, by samples: '//message//' is '//word(by_samples%class))
         call checks%check(by_steps%class == class, 'orders, by steps: '//message//' is '//word(by_steps%class))
         call checks%check_close(by_samples%spectrum%irregular_fraction, share, 1.0e-4_dp, 'share by samples: '//message)
         call checks%check_close(by_steps%spectrum%irregular_fraction, by_samples%spectrum%irregular_fraction, 1.0e-12_dp, &
                                 'share by steps: '//message)
      end subroutine expect

   end subroutine test_orders_of_force

   !> Record of one period with these harmonics, of a force of half a hertz, whose coefficients are the amplitudes.
   function record_of(harmonics) result(record)
      real(dp), intent(in) :: harmonics(:)
      type(window_record_t) :: record

      record%periods = 1
      record%multiples = size(harmonics)
      record%acceleration_square = 0.5_dp*sum(harmonics**2)
      allocate (record%harmonic_sums(0:size(harmonics)), source=(0.0_dp, 0.0_dp))
      record%harmonic_sums(1:) = cmplx(harmonics, 0.0_dp, dp)
      allocate (record%harmonic_squares(0:size(harmonics)), source=abs(record%harmonic_sums)**2)
      record%turns = [-sum(abs(harmonics)), sum(abs(harmonics))]
      record%turn_count = 2
   end function record_of

   !> Only a motion off its harmonics that is known to repeat after several periods is subharmonic.
   subroutine test_known_orbit(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(rattle_verdict_t) :: verdict
      integer :: class, orbit

      do class = class_quiet, class_subharmonic
         do orbit = 0, 8
            verdict%class = class
            call note_orbit(verdict, orbit)
            call checks%check(verdict%class == merge(class_subharmonic, class, class == class_irregular_so_far .and. orbit > 1), &
               'known orbit: '//word(class))
         end do
      end do
   end subroutine test_known_orbit

   !> Every limit is that of the scene, not the default one.
   subroutine test_own_limits(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: amplitudes(60)

      amplitudes = 0.0_dp
      amplitudes(1:3) = [1.0_dp, 0.5_dp, 0.03_dp]
      call expect(spectrum_choice_t(periods=periods), 0.0_dp, class_creep, 'default limits')
      call expect(spectrum_choice_t(periods=periods, quiet_limit=0.6_dp), 0.0_dp, class_quiet, 'quiet limit 0.6')
      call expect(spectrum_choice_t(periods=periods, idle_harmonics=3), 0.0_dp, class_idle, '3 harmonics are idle')
      call expect(spectrum_choice_t(periods=periods, idle_harmonics=3, harmonic_threshold=0.04_dp), 0.0_dp, class_creep, &
         'harmonic threshold 0.04')
      ! 0.2^2/(1 + 0.5^2 + 0.2^2) is a share of 0.031.
      call expect(spectrum_choice_t(periods=periods), 0.2_dp, class_irregular_so_far, 'irregular share 0.031')
      call expect(spectrum_choice_t(periods=periods, irregular_limit=0.04_dp), 0.2_dp, class_creep, 'irregular limit 0.04')

   contains

      !> The signal under other limits, and its class.
      subroutine expect(choice, half_line, class, message)
         type(spectrum_choice_t), intent(in) :: choice  !> Limits
         real(dp), intent(in) :: half_line              !> Amplitude at half the forcing frequency
         integer, intent(in) :: class                   !> Its class
         character(*), intent(in) :: message            !> Name of the limits

         type(rattle_verdict_t) :: verdict

         call classify(signal(amplitudes, half_line), choice, noise_floor, verdict)
         call checks%check(verdict%class == class, 'own limits: '//message)
      end subroutine expect

   end subroutine test_own_limits

   !> Reversals are counted over the window and given for a period.
   subroutine test_reversals_per_period(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(rattle_verdict_t) :: verdict

      call classify(signal([1.0_dp, 0.0_dp, 2.0_dp], 0.0_dp), spectrum_choice_t(periods=periods), &
         noise_floor, verdict)
      call checks%check_close(verdict%reversals_per_period, 6.0_dp, 0.0_dp, 'six reversals a period')
      call classify(signal([0.0_dp], 1.0_dp), spectrum_choice_t(periods=periods), noise_floor, verdict)
      call checks%check_close(verdict%reversals_per_period, 1.0_dp, 0.0_dp, 'one reversal a period')
      call classify(signal([0.0_dp], 0.0_dp), spectrum_choice_t(periods=periods), noise_floor, verdict)
      call checks%check_close(verdict%reversals_per_period, 0.0_dp, 0.0_dp, 'no motion, no reversal')
   end subroutine test_reversals_per_period

   !> Word of a class.
   pure function word(class)
      integer, intent(in) :: class  !> Its code
      character(:), allocatable :: word

      word = quantity_word(quantity_rattle_class, class)
   end function word

end module test_rattle_class
