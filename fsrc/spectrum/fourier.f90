!> Discrete Fourier transform of real samples. The only file that knows FFTW.
module fourier
   use, intrinsic :: iso_c_binding
   use kinds, only: dp
   implicit none(type, external)
   private

   include 'fftw3.f03'

   public :: amplitude_spectrum

contains

   !> Single-sided amplitudes a_k of samples = a_0 + sum a_k cos(2 pi k i/n + phase_k), rectangular window.
   !> Plans are estimated, not measured: a measured plan may change the last bit from run to run.
   subroutine amplitude_spectrum(samples, amplitudes)
      !> n >= 1 equidistant samples
      real(dp), intent(in) :: samples(:)
      !> a_0 to a_(n/2), unit of the samples
      real(dp), allocatable, intent(out) :: amplitudes(:)
      real(dp), allocatable :: copy(:)
      complex(dp), allocatable :: transform(:)
      type(c_ptr) :: plan
      integer :: n

      n = size(samples)
      allocate (copy(n), transform(0:n/2), amplitudes(0:n/2))
      copy(:) = samples
      !$omp critical (fourier_plan)
      plan = fftw_plan_dft_r2c_1d(n, copy, transform, FFTW_ESTIMATE)
      !$omp end critical (fourier_plan)
      call fftw_execute_dft_r2c(plan, copy, transform)
      !$omp critical (fourier_plan)
      call fftw_destroy_plan(plan)
      !$omp end critical (fourier_plan)
      amplitudes = 2.0_dp*abs(transform)/real(n, dp)
      amplitudes(0) = 0.5_dp*amplitudes(0)
      if (mod(n, 2) == 0) amplitudes(n/2) = 0.5_dp*amplitudes(n/2)
   end subroutine amplitude_spectrum

end module fourier
