!> Tests of the count of reversals.
module test_reversals
   use checks, only: check_list_t
   use kinds, only: dp
   use reversals, only: count_reversals, reversal_prominence
   implicit none(type, external)
   private

   real(dp), parameter :: two_pi = 8.0_dp*atan(1.0_dp)

   public :: run_reversals_tests

contains

   !> Runs every test of this topic.
   subroutine run_reversals_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('reversals')
      call test_plain(checks)
      call test_prominence(checks)
      call test_invariance(checks)
   end subroutine run_reversals_tests

   !> Signals that can be counted by eye.
   subroutine test_plain(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer :: i

      call expect([0.0_dp, 0.0_dp, 0.0_dp], 0, 'constant')
      call expect([5.0_dp], 0, 'one sample')
      call expect([0.0_dp, 1.0_dp], 2, 'two samples')
      call expect([0.0_dp, 1.0_dp, 1.0_dp, 1.0_dp, 0.0_dp, 0.0_dp], 2, 'plateaus')
      call expect([1.0_dp, 1.0_dp, 0.0_dp, 0.0_dp, 1.0_dp], 2, 'plateau over the end')
      call expect([0.0_dp, 2.0_dp, 1.0_dp, 3.0_dp, 0.5_dp, 1.0_dp], 6, 'three maxima')
      call expect([0.0_dp, 1.0_dp, 2.0_dp, 1.0_dp, 0.0_dp, -3.0_dp], 2, 'slopes')
      call expect([(sin(two_pi*real(i, dp)/64.0_dp), i=1, 64)], 2, 'sine')
      call expect([(sin(two_pi*5.0_dp*real(i, dp)/640.0_dp), i=1, 640)], 10, 'five sines')
      call expect([(cos(two_pi*real(i, dp)/64.0_dp) + cos(two_pi*real(3*i, dp)/64.0_dp), i=1, 64)], 6, &
         'first and third')

   contains

      !> One signal, one count.
      subroutine expect(signal, reversals, message)
         real(dp), intent(in) :: signal(:)     !> Whole periods
         integer, intent(in) :: reversals      !> What is to be counted
         character(*), intent(in) :: message   !> Name of the signal

         call checks%check(count_reversals(signal, reversal_prominence) == reversals, message)
         call checks%check(count_reversals(-signal, reversal_prominence) == reversals, &
            message//', upside down')
      end subroutine expect

   end subroutine test_plain

   !> Ripple counts from the threshold on: a dip, or upside down a bump, of a little less and a little more.
   subroutine test_prominence(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: signal(200)
      integer :: i

      call checks%check(count_reversals([0.0_dp, 50.0_dp, 49.1_dp, 100.0_dp], 0.01_dp) == 2, &
         'ripple below the threshold')
      call checks%check(count_reversals([0.0_dp, 50.0_dp, 48.9_dp, 100.0_dp], 0.01_dp) == 4, &
         'ripple above the threshold')
      call checks%check(count_reversals([0.0_dp, 50.0_dp, 48.9_dp, 100.0_dp], 0.02_dp) == 2, &
         'another threshold')
      do i = -1, 1, 2
         call checks%check(count_reversals(real(i, dp)*[0.0_dp, 50.0_dp, 49.001_dp, 100.0_dp], reversal_prominence) == 2, &
            'ripple just below a hundredth of the range')
         call checks%check(count_reversals(real(i, dp)*[0.0_dp, 50.0_dp, 48.999_dp, 100.0_dp], reversal_prominence) == 4, &
            'ripple just above a hundredth of the range')
      end do
      signal = [(sin(two_pi*real(i, dp)/200.0_dp) + 0.008_dp*sin(real(7*i*i, dp)), i=1, 200)]
      call checks%check(count_reversals(signal, 0.01_dp) == 2, 'noise below the threshold')
      call checks%check(count_reversals(signal, 0.001_dp) > 20, 'noise above it')
   end subroutine test_prominence

   !> Where the window begins, its scale and twice the samples change nothing.
   subroutine test_invariance(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: n = 120
      real(dp) :: signal(n), doubled(2*n)
      integer :: shift, reference, i
      logical :: same

      signal = [(wave(two_pi*real(i, dp)/real(n, dp)), i=1, n)]
      doubled = [(wave(two_pi*real(i, dp)/real(2*n, dp)), i=1, 2*n)]
      reference = count_reversals(signal, 0.01_dp)
      call checks%check(reference > 4, 'the wave has several reversals')
      same = .true.
      do shift = 1, n - 1
         same = same .and. count_reversals(cshift(signal, shift), 0.01_dp) == reference
      end do
      call checks%check(same, 'shifted')
      call checks%check(count_reversals(signal(n:1:-1), 0.01_dp) == reference, 'backwards')
      call checks%check(count_reversals(1.0e-9_dp*signal - 5.0_dp, 0.01_dp) == reference, 'scaled')
      call checks%check(count_reversals(doubled, 0.01_dp) == reference, 'twice the samples')
      call checks%check(count_reversals([signal, signal, signal], 0.01_dp) == 3*reference, &
         'three times the window')
   end subroutine test_invariance

   !> Some harmonics.
   elemental real(dp) function wave(phase)
      real(dp), intent(in) :: phase  !> Phase [rad]

      wave = cos(phase) + 0.8_dp*cos(2.0_dp*phase + 0.4_dp) + 0.6_dp*cos(5.0_dp*phase + 1.0_dp)
   end function wave

end module test_reversals
