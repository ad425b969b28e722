!> Tests of the amplitude spectrum on made signals.
module test_fourier
   use checks, only: check_list_t
   use fourier, only: amplitude_spectrum, trigonometric_interpolation
   use kinds, only: dp
   implicit none(type, external)
   private

   real(dp), parameter :: two_pi = 8.0_dp*atan(1.0_dp)
   !> Relative to the largest sample: a transform adds up log n roundings, the cosine of a phase 2 pi k i/n
   !> brings its size in epsilon.
   real(dp), parameter :: rounding = 1.0e-12_dp

   public :: run_fourier_tests

contains

   !> Runs every test of this topic.
   subroutine run_fourier_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: counts(8) = [1, 2, 3, 16, 45, 96, 97, 1000]
      integer :: i

      call checks%start('fourier')
      do i = 1, size(counts)
         call test_lines(checks, counts(i))
         call test_power(checks, counts(i))
         call test_size(checks, counts(i))
         call test_interpolation(checks, counts(i))
      end do
   end subroutine run_fourier_tests

   !> A mean, a line at every bin with its own amplitude and phase: each is found in its bin.
   subroutine test_lines(checks, n)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      integer, intent(in) :: n                     !> Number of samples

      real(dp), allocatable :: amplitudes(:)
      real(dp) :: samples(n), expected(0:n/2), phase, error
      character(4) :: digits
      integer :: i, k

      expected = [(1.0_dp + 0.1_dp*real(k, dp), k=0, n/2)]
      samples = expected(0)
      do k = 1, n/2
         ! The highest bin of an even number of samples has no sine.
         phase = merge(0.0_dp, 0.7_dp*real(k, dp), 2*k == n)
         samples = samples + expected(k)*cos([(two_pi*real(modulo(k*i, n), dp)/real(n, dp) + phase, i=0, &
            n - 1)])
      end do
      call amplitude_spectrum(samples, amplitudes)
      write (digits, '(i4)') n
      call checks%check(lbound(amplitudes, 1) == 0 .and. ubound(amplitudes, 1) == n/2, 'bounds, n ='//digits)
      if (ubound(amplitudes, 1) /= n/2) return
      error = maxval(abs(amplitudes - expected))/sum(expected)
      call checks%check_close(error, 0.0_dp, rounding, 'lines, n ='//digits)
   end subroutine test_lines

   !> The trigonometric interpolation goes through every sample.
   subroutine test_interpolation(checks, n)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      integer, intent(in) :: n                     !> Number of samples

      real(dp), allocatable :: amplitudes(:), phases(:)
      real(dp) :: samples(n), mean, sum_there, error
      integer :: i, k

      samples = [(3.0e5_dp*(1.5_dp + sin(real(i*i, dp))), i=1, n)]
      call trigonometric_interpolation(samples, mean, amplitudes, phases)
      error = real(abs(size(amplitudes) - n/2) + abs(size(phases) - n/2), dp)
      do i = 0, n - 1
         sum_there = mean
         do k = 1, n/2
            sum_there = sum_there + amplitudes(k)*cos(two_pi*real(modulo(k*i, n), dp)/real(n, dp) + phases(k))
         end do
         error = max(error, abs(sum_there - samples(i + 1)))
      end do
      call checks%check_close(error/maxval(samples), 0.0_dp, rounding, 'interpolation goes through the samples')
   end subroutine test_interpolation

   !> Parseval: the mean square of the samples is that of the lines.
   subroutine test_power(checks, n)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      integer, intent(in) :: n                     !> Number of samples

      real(dp), allocatable :: amplitudes(:)
      real(dp) :: samples(n), power
      character(4) :: digits
      integer :: i

      samples = [(sin(real(i*i, dp)) + 0.3_dp*modulo(real(i, dp), 7.0_dp), i=1, n)]
      call amplitude_spectrum(samples, amplitudes)
      power = 0.5_dp*sum(amplitudes**2) + 0.5_dp*amplitudes(0)**2
      if (modulo(n, 2) == 0) power = power + 0.5_dp*amplitudes(n/2)**2
      write (digits, '(i4)') n
      call checks%check_close(power*real(n, dp)/sum(samples**2), 1.0_dp, rounding, 'power, n ='//digits)
   end subroutine test_power

   !> Samples of any size have amplitudes of their size, with the same digits where a power of two lies between them.
   subroutine test_size(checks, n)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      integer, intent(in) :: n                     !> Number of samples

      integer, parameter :: exponents(4) = [-1000, -540, 512, 1015]
      real(dp), allocatable :: amplitudes(:), expected(:)
      real(dp) :: samples(n)
      character(4) :: digits
      integer :: i

      write (digits, '(i4)') n
      samples = [(sin(real(i*i, dp)) + 0.3_dp*modulo(real(i, dp), 7.0_dp), i=1, n)]
      call amplitude_spectrum(samples, expected)
      do i = 1, size(exponents)
         call amplitude_spectrum(scale(samples, exponents(i)), amplitudes)
         ! At the border of what is normal a weak line loses digits.
         call checks%check(all(abs(scale(amplitudes, -exponents(i)) - expected) <= merge(1.0e-6_dp, 0.0_dp, i == 1)), &
            'amplitudes of any size, n ='//digits)
      end do
   end subroutine test_size

end module test_fourier
