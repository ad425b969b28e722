!> Tests of the forces of several pairs together: the rms of their sum against sums of the same cosines on one axis of time.
module test_force_signal
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use canonical_scenes, only: loose_gear
   use checks, only: check_list_t
   use constants, only: two_pi
   use force, only: force_at
   use force_signal, only: force_signal_t, signal_of_window, sum_in_phase
   use kinds, only: dp
   use problem, only: problem_of, problem_t
   use word_list, only: joined_words, word_t
   implicit none(type, external)
   private

   public :: run_force_signal_tests

   !> A force of cosines [N] over the base period, and how a motion with it is sampled.
   type :: example_t
      !> Order over the base, amplitude [N] and phase [rad] of each cosine
      real(dp) :: orders(2), amplitudes(2), phases(2)
      !> Periods of the window, the last of them, samples of each
      integer :: periods, last_period, samples
      logical :: repeats
   end type example_t

   type(example_t), parameter :: once = example_t([1.0_dp, 5.0_dp], [3.0_dp, 1.0_dp], [0.4_dp, 2.0_dp], 1, 10, 64, .true.)
   type(example_t), parameter :: twice = example_t([1.0_dp, 0.5_dp], [1.5_dp, 4.0_dp], [-2.0_dp, 0.3_dp], 2, 5, 32, .true.)
   type(example_t), parameter :: thrice = example_t([1.0_dp, 1.0_dp/3.0_dp], [2.0_dp, 5.0_dp], [1.0_dp, -1.0_dp], 3, 7, 128, .true.)
   !> Of the last four of 200 periods: a motion that is elsewhere before
   type(example_t), parameter :: passing = example_t([1.25_dp, 0.5_dp], [2.5_dp, 3.0_dp], [0.7_dp, 0.1_dp], 4, 200, 64, .false.)

contains

   !> Runs every test of this topic.
   subroutine run_force_signal_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('force_signal')
      call check_sum(checks, [once], 1, 0, 'over 1 period, after which all pairs repeat')
      call check_sum(checks, [thrice], 3, 0, 'over 3 periods, after which all pairs repeat')
      call check_sum(checks, [once, twice, thrice], 6, 0, 'over 6 periods, after which all pairs repeat')
      call check_sum(checks, [twice, once, passing], 4, 196, 'over the last 4 periods of 200, the window of 3')
      call check_sum(checks, [passing, passing], 4, 196, 'over the last 4 periods of 200, the window of all pairs')
      call test_the_applied_force(checks)
      call test_unknown_sums(checks)
      call test_words(checks)
   end subroutine run_force_signal_tests

   !> The sum of some forces over all periods of a window, and what is said of it.
   subroutine check_sum(checks, examples, periods, first, expected)
      class(check_list_t), intent(inout) :: checks
      type(example_t), intent(in) :: examples(:)
      !> Periods of the window, and those before it
      integer, intent(in) :: periods
      integer, intent(in) :: first
      character(*), intent(in) :: expected
      character(:), allocatable :: words
      real(dp) :: rms
      integer :: place

      call sum_in_phase([(signal_of(examples(place)), place=1, size(examples))], names_of(size(examples)), rms, words)
      call checks%check_close(rms, direct_sum(examples, periods, first), 1.0e-12_dp, 'sum '//expected)
      call checks%check(words == expected, 'words "'//words//'" for "'//expected//'"')

   contains

      !> Root of the mean square of the cosines together, on one axis of time.
      real(dp) function direct_sum(examples, periods, first)
         type(example_t), intent(in) :: examples(:)
         integer, intent(in) :: periods
         integer, intent(in) :: first
         real(dp) :: square, value
         integer :: i, k, n

         n = 384*periods
         square = 0.0_dp
         do i = 1, n
            value = 0.0_dp
            do k = 1, size(examples)
               value = value + force_of(examples(k), real(first, dp) + real(i, dp)/384.0_dp)
            end do
            square = square + value**2
         end do
         direct_sum = sqrt(square/real(n, dp))
      end function direct_sum

   end subroutine check_sum

   !> Value of a force at a time [N].
   pure real(dp) function force_of(example, time)
      type(example_t), intent(in) :: example
      !> [periods]
      real(dp), intent(in) :: time

      force_of = sum(example%amplitudes*cos(two_pi*example%orders*time + example%phases))
   end function force_of

   !> Signal of a force, by the samples of a motion that has it.
   type(force_signal_t) function signal_of(example) result(signal)
      type(example_t), intent(in) :: example
      type(problem_t) :: problem
      real(dp) :: accelerations(example%periods*example%samples), time
      integer :: i

      problem = problem_of(loose_gear())
      do i = 1, size(accelerations)
         time = real(example%last_period - example%periods, dp) + real(i, dp)/real(example%samples, dp)
         accelerations(i) = (force_of(example, time) - force_at(problem%force, modulo(time, 1.0_dp)))/problem%mass
      end do
      signal = signal_of_window(problem, accelerations, example%periods, example%last_period, example%repeats, &
                                sqrt(0.5_dp*sum(example%amplitudes**2)))
   end function signal_of

   pure function names_of(number) result(names)
      integer, intent(in) :: number
      type(word_t) :: names(number)
      integer :: i

      do i = 1, number
         names(i)%text = achar(iachar('0') + i)
      end do
   end function names_of

   !> The force of the engine belongs to the film force, its mean does not.
   subroutine test_the_applied_force(checks)
      class(check_list_t), intent(inout) :: checks
      type(force_signal_t) :: signal
      type(problem_t) :: problem
      real(dp) :: still(64)

      problem = problem_of(loose_gear())
      still = 0.0_dp
      signal = signal_of_window(problem, still, 1, 1, .true., 1.0_dp)
      call checks%check_close(abs(signal%lines(1)), 7.9_dp, 1.0e-13_dp, 'first order of the force')
      call checks%check_close(abs(signal%lines(3)), 0.8_dp, 1.0e-13_dp, 'third order of the force')
      call checks%check_close(atan2(signal%lines(2)%im, signal%lines(2)%re), 0.5_dp, 1.0e-13_dp, 'phase of the second order')
      call checks%check_close(sum(abs(signal%lines(4:))), 0.0_dp, 1.0e-12_dp, 'no other')
   end subroutine test_the_applied_force

   !> Sums that cannot be reported say why, and name the pairs.
   subroutine test_unknown_sums(checks)
      class(check_list_t), intent(inout) :: checks
      type(force_signal_t) :: signals(3)
      type(example_t) :: other

      signals = [signal_of(once), signal_of(passing), signal_of(passing)]
      signals(2)%periods = 0
      call check_unknown('unknown, as there is no window of 2')
      signals(2) = signal_of(passing)
      signals(1)%rms = 1.01_dp*signals(1)%rms
      signals(3)%rms = 0.98_dp*signals(3)%rms
      call check_unknown('unknown, as there are too few samples for the force of 1 and 3')
      signals = [signal_of(once), signal_of(passing), signal_of(thrice)]
      call check_unknown('unknown, as the window of 2, which was not seen to repeat, has 4 periods, no multiple of those '// &
                         'after which 3 repeats')
      other = passing
      other%last_period = 100
      signals(3) = signal_of(other)
      call check_unknown('unknown, as the window of 2 is not that of 3')

   contains

      subroutine check_unknown(expected)
         character(*), intent(in) :: expected
         character(:), allocatable :: words
         real(dp) :: rms

         call sum_in_phase(signals, names_of(3), rms, words)
         call checks%check(ieee_is_nan(rms), 'no number: '//expected)
         call checks%check(words == expected, 'words "'//words//'" for "'//expected//'"')
      end subroutine check_unknown

   end subroutine test_unknown_sums

   !> Lists as sentences have them.
   subroutine test_words(checks)
      class(check_list_t), intent(inout) :: checks
      type(word_t) :: names(3)

      names = names_of(3)
      call checks%check(joined_words(names, [.false., .false., .false.]) == '', 'no word')
      call checks%check(joined_words(names, [.false., .true., .false.]) == '2', 'one word')
      call checks%check(joined_words(names, [.true., .false., .true.]) == '1 and 3', 'two words')
      call checks%check(joined_words(names, [.true., .true., .true.]) == '1, 2 and 3', 'three words')
   end subroutine test_words

end module test_force_signal
