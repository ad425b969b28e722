!> Tests of the return of a motion to a state it has had: sequences by hand.
module test_recurrence
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use checks, only: check_list_t
   use kinds, only: dp, int64
   use repetition, only: look_back, recurrence_t
   implicit none(type, external)
   private

   !> Steps of every period.
   integer(int64), parameter :: steps_per_period = 17_int64

   public :: run_recurrence_tests

contains

   !> Runs every test of this topic.
   subroutine run_recurrence_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('recurrence')
      call test_cycles(checks)
      call test_bits(checks)
   end subroutine run_recurrence_tests

   !> Follow a motion that settles for some periods and then goes round a cycle.
   subroutine follow(settling, length, most, found, cycle_periods, cycle_steps)
      integer, intent(in) :: settling                 !> Periods before the cycle
      integer, intent(in) :: length                   !> Periods of the cycle
      integer, intent(in) :: most                     !> Periods to follow it for
      integer, intent(out) :: found                   !> Period at which it is found to return, 0: never
      integer, intent(out) :: cycle_periods           !> What it is found to be
      integer(int64), intent(out) :: cycle_steps      !> Its steps
      type(recurrence_t) :: past
      integer :: period, place

      do period = 1, most
         place = period
         if (period > settling) place = settling + 1 + modulo(period - settling - 1, length)
         ! Film and velocity do not both distinguish places.
         call look_back(past, period, [1.0_dp + real(place/2, dp), real(modulo(place, 2), dp)], &
                        period*steps_per_period, cycle_periods, cycle_steps)
         found = period
         if (cycle_periods > 0) return
      end do
      found = 0
   end subroutine follow

   !> Cycles of any length are found, at their true length, soon; a motion that never returns is left alone.
   subroutine test_cycles(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      integer, parameter :: lengths(6) = [1, 2, 3, 8, 13, 40], settlings(4) = [0, 1, 14, 200]
      integer :: i, j, found, cycle_periods, latest
      integer(int64) :: cycle_steps

      do i = 1, size(lengths)
         do j = 1, size(settlings)
            call follow(settlings(j), lengths(i), 1000, found, cycle_periods, cycle_steps)
            call checks%check(found > settlings(j) + lengths(i) .and. cycle_periods == lengths(i) .and. &
                              cycle_steps == lengths(i)*steps_per_period, 'cycle: its length')
            ! At the first mark on the cycle that stays for its length, and once more round it.
            latest = settlings(j) + 2
            if (lengths(i) > 1) latest = settlings(j) + 5 + lengths(i)
            if (lengths(i) > 4) latest = settlings(j) + 17 + lengths(i)
            if (lengths(i) > 16) latest = 2*settlings(j) + 65 + lengths(i)
            call checks%check(found <= latest, 'cycle: found soon')
         end do
      end do
      call follow(2000, 1, 1999, found, cycle_periods, cycle_steps)
      call checks%check(found == 0 .and. cycle_steps == 0_int64, 'no cycle')
   end subroutine test_cycles

   !> A state is the same if all its bits are.
   subroutine test_bits(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(recurrence_t) :: past
      real(dp), parameter :: films(4) = [1.0_dp, 1.0_dp, 1.0_dp + epsilon(1.0_dp), 1.0_dp + epsilon(1.0_dp)]
      real(dp), parameter :: momenta(4) = [0.0_dp, -0.0_dp, -0.0_dp, nearest(-0.0_dp, -1.0_dp)]
      integer :: period, cycle_periods
      integer(int64) :: cycle_steps

      do period = 1, 4
         call look_back(past, period, [films(period), momenta(period)], 0_int64, cycle_periods, cycle_steps)
         call checks%check(cycle_periods == 0, 'one bit differs')
      end do
      call look_back(past, 5, [films(4), momenta(4)], 0_int64, cycle_periods, cycle_steps)
      call checks%check(cycle_periods == 1, 'all bits agree')
      call look_back(past, 6, [ieee_value(1.0_dp, ieee_quiet_nan), momenta(4)], 0_int64, cycle_periods, &
                     cycle_steps)
      call checks%check(cycle_periods == 0, 'no number after a number')
   end subroutine test_bits

end module test_recurrence
