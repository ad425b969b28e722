!> Tests of the mean cycle of a recording: its scatter, its drift, and samples that are no cycle.
module test_signal_cycles
   use checks, only: check_list_t
   use constants, only: two_pi
   use kinds, only: dp
   use signal_cycles, only: cycle_scatter, drift_of_cycles, fault_of_cycle, mean_cycle
   implicit none(type, external)
   private

   public :: run_signal_cycles_tests

contains

   !> Runs every test of this topic.
   subroutine run_signal_cycles_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks

      call checks%start('signal_cycles')
      call test_mean(checks)
      call test_drift(checks)
      call test_ends(checks)
   end subroutine run_signal_cycles_tests

   !> Cycles that differ by a known amount.
   subroutine test_mean(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: shape(4) = [3.0_dp, 1.0_dp, -3.0_dp, -1.0_dp], tolerance = 1.0e-14_dp
      real(dp) :: samples(12)
      integer :: i

      do i = 0, 2
         samples(4*i + 1:4*i + 4) = 10.0_dp + shape + 0.5_dp*real(i - 1, dp)
      end do
      call checks%check(all(abs(mean_cycle(samples, 3) - 10.0_dp - shape) < tolerance), 'mean of three cycles')
      ! Deviations of -0.5, 0 and 0.5 against a shape whose mean square is 5
      call checks%check(abs(cycle_scatter(samples, mean_cycle(samples, 3)) - sqrt(0.5_dp/3.0_dp/5.0_dp)) < tolerance, &
                        'scatter of three cycles')
      call checks%check(all(abs(mean_cycle(samples, 1) - samples) <= 0.0_dp), 'one cycle is its mean')
   end subroutine test_mean

   !> Cycles that are shorter than their share of the samples, and such that differ by chance.
   subroutine test_drift(checks)
      type(check_list_t), intent(inout) :: checks
      integer, parameter :: cycles = 10, length = 90
      real(dp) :: samples(cycles*length), drift, shifts(cycles)
      integer :: i, k

      samples = [(cos(two_pi*real(i, dp)/(real(length, dp) - 0.3_dp)), i=0, cycles*length - 1)]
      drift = drift_of_cycles(samples, mean_cycle(samples, cycles))
      call checks%check(abs(abs(drift) - 0.3_dp*real(cycles - 1, dp)) < 0.01_dp, 'drift of cycles that are shorter')
      shifts = [1.0_dp, -1.2_dp, 0.4_dp, 0.9_dp, -0.8_dp, 1.1_dp, -0.3_dp, -1.0_dp, 0.7_dp, 0.2_dp]
      do i = 1, cycles
         samples((i - 1)*length + 1:i*length) = [(cos(two_pi*(real(k, dp) + shifts(i))/real(length, dp)), k=1, length)]
      end do
      call checks%check(abs(drift_of_cycles(samples, mean_cycle(samples, cycles))) <= 0.0_dp, 'no drift of chance')
   end subroutine test_drift

   !> Cycles that repeat their first sample or jump at their end, and some that only look so.
   subroutine test_ends(checks)
      type(check_list_t), intent(inout) :: checks
      integer :: n

      do n = 8, 100, 23
         call hold(checks, wave(n, 0, 0.0_dp, 0.0_dp), '', 'a cosine')
         call hold(checks, wave(n, 0, 0.5_dp, 0.0_dp), '', 'a cosine whose ends are alike by symmetry')
         call hold(checks, wave(n, 0, 0.3_dp, 0.0_dp), '', 'a cosine between')
         call hold(checks, wave(n, 1, 0.0_dp, 0.0_dp), 'the last sample repeats the first', 'one sample more')
         call hold(checks, wave(n, 1, 0.3_dp*real(n, dp), 0.0_dp), 'the last sample repeats the first', 'one more, elsewhere')
         call checks%check(fault_of_cycle(wave(n, 1, 0.0_dp, 0.0_dp), .false.) == '', 'an axis knows better')
      end do
      call hold(checks, wave(100, 0, 0.0_dp, 1.0_dp), 'the cycle does not close', 'a drift')
      call hold(checks, [0.0_dp, 0.0_dp, 0.0_dp, 1.0_dp, 1.0_dp, 1.0_dp], '', 'a rectangle')
      call hold(checks, [0.0_dp, 0.0_dp, 5.0_dp, 0.0_dp, 0.0_dp, 0.0_dp], '', 'a pulse')
      call hold(checks, [7.0_dp, 7.0_dp, 7.0_dp, 7.0_dp], 'all samples are 7', 'a constant')
   end subroutine test_ends

   !> Whether samples have a fault that begins with these words; empty: none.
   subroutine hold(checks, samples, words, what)
      type(check_list_t), intent(inout) :: checks
      real(dp), intent(in) :: samples(:)
      character(*), intent(in) :: words
      character(*), intent(in) :: what
      character(:), allocatable :: found

      found = fault_of_cycle(samples, .true.)
      call checks%check(index(found, words) == 1 .and. (len(words) > 0 .or. len(found) == 0), what//': '//found)
   end subroutine hold

   !> A cosine of n samples and some more, that begins behind its crest, with a drift in its cycle.
   pure function wave(n, more, shift, drift) result(samples)
      integer, intent(in) :: n
      integer, intent(in) :: more
      !> [samples]
      real(dp), intent(in) :: shift
      real(dp), intent(in) :: drift
      real(dp) :: samples(n + more)
      integer :: i

      samples = [(cos(two_pi*(real(i, dp) + shift)/real(n, dp)) + drift*real(i, dp)/real(n, dp), i=0, n + more - 1)]
   end function wave

end module test_signal_cycles
