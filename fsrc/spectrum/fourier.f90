!> Discrete Fourier transform of real samples. The only file that knows FFTW.
module fourier
   use, intrinsic :: iso_c_binding
   use kinds, only: dp
   implicit none(type, external)
   private

   include 'fftw3.f03'

   ! Making a plan costs more than many transforms, so each thread keeps its last, with its work space. What a
   ! transform gives does not depend on it: estimated plans of one length are all the same.
   integer :: kept_length = 0
   type(c_ptr) :: kept_plan = c_null_ptr
   real(dp), pointer :: kept_samples(:) => null()
   complex(dp), pointer :: kept_lines(:) => null()
   !$omp threadprivate(kept_length, kept_plan, kept_samples, kept_lines)

   public :: amplitude_spectrum

contains

   !> Single-sided amplitudes a_k of samples = a_0 + sum a_k cos(2 pi k i/n + phase_k), rectangular window.
   subroutine amplitude_spectrum(samples, amplitudes)
      !> n >= 1 equidistant samples
      real(dp), intent(in) :: samples(:)
      !> a_0 to a_(n/2), unit of the samples
      real(dp), allocatable, intent(out) :: amplitudes(:)
      integer :: n

      n = size(samples)
      if (kept_length /= n) call prepare(n)
      allocate (amplitudes(0:n/2))
      kept_samples(:) = samples
      call fftw_execute_dft_r2c(kept_plan, kept_samples, kept_lines)
      ! Not abs: amplitudes are far from overflow, and hypot would be the dearest part.
      amplitudes(:) = 2.0_dp*sqrt(real(kept_lines, dp)**2 + aimag(kept_lines)**2)/real(n, dp)
      amplitudes(0) = 0.5_dp*amplitudes(0)
      if (mod(n, 2) == 0) amplitudes(n/2) = 0.5_dp*amplitudes(n/2)
   end subroutine amplitude_spectrum

   !> Replace the plan of this thread. Plans are estimated, not measured: a measured plan may change the last bit from
   !> run to run. FFTW makes plans for one thread at a time.
   subroutine prepare(length)
      integer, intent(in) :: length

      if (associated(kept_samples)) deallocate (kept_samples, kept_lines)
      allocate (kept_samples(length), kept_lines(0:length/2))
      !$omp critical (fourier_plan)
      if (c_associated(kept_plan)) call fftw_destroy_plan(kept_plan)
      kept_plan = fftw_plan_dft_r2c_1d(length, kept_samples, kept_lines, FFTW_ESTIMATE)
      !$omp end critical (fourier_plan)
      kept_length = length
   end subroutine prepare

end module fourier
