!> Tests of samples that what is around them contradicts: found where they were put, and none in signals that have none.
module test_signal_outliers
   use checks, only: check_list_t
   use constants, only: two_pi
   use kinds, only: dp
   use signal_outliers, only: find_runs, find_spikes, outlier_t
   use text, only: integer_text
   implicit none(type, external)
   private

   integer, parameter :: n = 720

   public :: run_signal_outliers_tests

contains

   !> Runs every test of this topic.
   subroutine run_signal_outliers_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks

      call checks%start('signal_outliers')
      call test_spikes(checks)
      call test_runs(checks)
      call test_nothing(checks)
      call test_rows(checks)
   end subroutine run_signal_outliers_tests

   !> Two orders over a cycle.
   pure function wave(count) result(samples)
      integer, intent(in) :: count
      real(dp), allocatable :: samples(:)
      integer :: i

      samples = [(800.0_dp + 12.0_dp*cos(2.0_dp*two_pi*i/count) + 4.0_dp*sin(4.0_dp*two_pi*i/count), i=1, count)]
   end function wave

   !> One sample, and two, at many places and of many heights.
   subroutine test_spikes(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: values(*) = [0.0_dp, 400.0_dp, 760.0_dp, 840.0_dp, 1600.0_dp, 12000.0_dp]
      type(outlier_t), allocatable :: found(:)
      real(dp), allocatable :: samples(:)
      integer :: i, k, place, width

      allocate (found(0), samples(0))
      do width = 1, 2
         do k = 1, size(values)
            do i = 1, 24
               place = 1 + modulo(30*i - 29, n - 1)
               samples = wave(n)
               samples(place:place + width - 1) = values(k)
               found = find_spikes(samples, n, .true.)
               call checks%check(size(found) == 1, 'a spike is found at '//integer_text(place))
               if (size(found) /= 1) cycle
               call checks%check(found(1)%first == place .and. found(1)%last == place + width - 1 .and. &
                                 abs(found(1)%before - found(1)%behind) < 2.0_dp, 'its place and neighbours')
            end do
         end do
      end do
   end subroutine test_spikes

   !> Runs at another level, also around the end of the cycle; those of a signal that can jump are constant.
   subroutine test_runs(checks)
      type(check_list_t), intent(inout) :: checks
      type(outlier_t), allocatable :: found(:)
      real(dp), allocatable :: samples(:)
      integer :: i, shift

      allocate (found(0), samples(0))
      do i = 0, 11
         shift = 60*i
         samples = wave(n)
         samples(100:159) = 400.0_dp
         samples = cshift(samples, shift)
         found = find_runs(samples, n, .false.)
         call checks%check(size(found) == 1, 'a constant run is found, moved by '//integer_text(shift))
         if (size(found) == 1) call checks%check(found(1)%first == modulo(99 - shift, n) + 1 .and. &
                                                 found(1)%last == modulo(158 - shift, n) + 1, 'its ends')
         samples = wave(n)
         samples(100:159) = 2.0_dp*samples(100:159)
         samples(400:420) = 0.5_dp*samples(400:420)
         found = find_runs(cshift(samples, shift), n, .true.)
         call checks%check(size(found) == 2, 'runs of a speed are found')
         call checks%check(size(find_runs(cshift(samples, shift), n, .false.)) == 0, 'those of a force may be real')
      end do
   end subroutine test_runs

   !> Signals without outliers: sines of few and many samples, squares, pulses, decays, noise, quantised.
   subroutine test_nothing(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), allocatable :: samples(:), noise(:)
      integer :: i, k, count

      allocate (samples(0))
      do count = 4, 200, 7
         call none(checks, [(sin(two_pi*i/count), i=1, count)], count, 'a sine of '//integer_text(count))
      end do
      do k = 1, 100, 9
         call none(checks, [(sin(two_pi*k*i/n), i=1, n)], n, 'order '//integer_text(k))
         call none(checks, merge(1.0_dp, 0.0_dp, [(i <= 3*k, i=1, n)]), n, 'a square')
         call none(checks, [(exp(-real(i, dp)/k), i=1, n)], n, 'a decay '//integer_text(k))
         call none(checks, [(max(0.0_dp, sin(two_pi*k*i/n) - 0.5_dp), i=1, n)], n, 'pulses '//integer_text(k))
         call none(checks, [(merge(1.0_dp, 0.0_dp, modulo(i, k + 3) == 0), i=1, n)], n, 'a sample at a time')
         call none(checks, [(real(modulo(i, 7*k + 5), dp), i=1, n)], n, 'a saw')
         call none(checks, anint([(real(k, dp)*sin(2.0_dp*two_pi*i/n), i=1, n)]), n, 'quantised')
      end do
      allocate (noise(20*n))
      call random_init(.true., .true.)
      do k = 1, 40
         call random_number(noise)
         noise = noise + cshift(noise, 1) - cshift(noise, 333) - cshift(noise, 4444)
         call none(checks, noise, n, 'noise')
         samples = noise + merge(2.0_dp, 0.0_dp, [(modulo(i, 90) < 2*k, i=1, size(noise))])
         call none(checks, samples, n, 'a noisy square')
         call none(checks, noise(:n) + 3.0_dp*wave(n), n, 'a noisy wave')
      end do
      ! What repeats in each cycle belongs to it.
      samples = [(wave(n), i=1, 3)]
      samples(100::n) = 1000.0_dp
      call none(checks, samples, n, 'a peak of every cycle')
   end subroutine test_nothing

   !> Whether nothing is found.
   subroutine none(checks, samples, length, what)
      type(check_list_t), intent(inout) :: checks
      real(dp), intent(in) :: samples(:)
      integer, intent(in) :: length
      character(*), intent(in) :: what

      call checks%check(size(find_spikes(samples, length, .true.)) == 0, 'no spike: '//what)
      call checks%check(size(find_runs(samples, length, .false.)) == 0, 'no run: '//what)
   end subroutine none

   !> Rows of a run-up, which end: a resonance over several rows is none, a row alone is.
   subroutine test_rows(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), allocatable :: rows(:)
      type(outlier_t), allocatable :: found(:)
      integer :: i

      allocate (rows, source=[(500.0_dp + 10.0_dp*i + 900.0_dp/(1.0_dp + (real(i - 15, dp)/2.0_dp)**2), i=1, 30)])
      call checks%check(size(find_spikes(rows, 30, .false.)) == 0, 'a resonance is none')
      allocate (found(0))
      rows = [(500.0_dp + 10.0_dp*i, i=1, 30)]
      rows(20) = 0.0_dp
      found = find_spikes(rows, 30, .false.)
      call checks%check(size(found) == 1, 'a row of 0 is found')
      if (size(found) == 1) call checks%check(found(1)%first == 20, 'its row')
   end subroutine test_rows

end module test_signal_outliers
