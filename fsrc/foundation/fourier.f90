!> Discrete Fourier transform of real samples. The only file that knows FFTW.
module fourier
   use, intrinsic :: iso_c_binding
   use kinds, only: dp
   use value_range, only: binary_unit
   implicit none(type, external)
   private

   include 'fftw3.f03'

   !> A plan with its work space.
   type :: plan_t
      !> Number of samples, none yet if 0
      integer :: length = 0
      type(c_ptr) :: plan = c_null_ptr
      real(dp), pointer, contiguous :: samples(:) => null()
      complex(dp), pointer, contiguous :: lines(:) => null()
   end type plan_t

   ! Making a plan costs more than many transforms, so each thread keeps its last ones: motions of one, two and
   ! more periods, finely and coarsely sampled, follow each other in a campaign. What a transform gives does not
   ! depend on it: estimated plans of one length are all the same.
   integer, parameter :: kept_plans = 8
   type(plan_t) :: kept(kept_plans)
   integer :: oldest = 1
   !$omp threadprivate(kept, oldest)

   public :: amplitude_spectrum, trigonometric_interpolation

contains

   !> Single-sided amplitudes a_k of samples = a_0 + sum a_k cos(2 pi k i/n + phase_k), rectangular window.
   subroutine amplitude_spectrum(samples, amplitudes)
      !> n >= 1 equidistant samples
      real(dp), intent(in) :: samples(:)
      !> a_0 to a_(n/2), unit of the samples
      real(dp), allocatable, intent(out) :: amplitudes(:)
      real(dp) :: unit
      integer :: n, i

      n = size(samples)
      i = plan_of(n)
      allocate (amplitudes(0:n/2))
      unit = binary_unit(samples)
      associate (transform => kept(i))
         transform%samples(:) = samples*(1.0_dp/unit)
         call fftw_execute_dft_r2c(transform%plan, transform%samples, transform%lines)
         ! Not abs: in this unit no square overflows, and hypot would cost most.
         amplitudes(:) = 2.0_dp*sqrt(real(transform%lines, dp)**2 + aimag(transform%lines)**2)/real(n, dp)*unit
      end associate
      amplitudes(0) = 0.5_dp*amplitudes(0)
      if (mod(n, 2) == 0) amplitudes(n/2) = 0.5_dp*amplitudes(n/2)
   end subroutine amplitude_spectrum

   !> The trigonometric polynomial a_0 + sum a_k cos(2 pi k x + phase_k) through samples at x = 0, 1/n, 2/n, ...
   subroutine trigonometric_interpolation(samples, mean, amplitudes, phases)
      !> n >= 2 equidistant samples of one period
      real(dp), intent(in) :: samples(:)
      !> a_0, unit of the samples
      real(dp), intent(out) :: mean
      !> a_1 to a_(n/2), unit of the samples, and their phases [rad]
      real(dp), allocatable, intent(out) :: amplitudes(:)
      real(dp), allocatable, intent(out) :: phases(:)
      real(dp) :: unit
      integer :: n, i

      n = size(samples)
      i = plan_of(n)
      unit = binary_unit(samples)
      associate (transform => kept(i))
         transform%samples(:) = samples*(1.0_dp/unit)
         call fftw_execute_dft_r2c(transform%plan, transform%samples, transform%lines)
         mean = real(transform%lines(0), dp)/real(n, dp)*unit
         amplitudes = 2.0_dp*abs(transform%lines(1:))/real(n, dp)*unit
         phases = atan2(aimag(transform%lines(1:)), real(transform%lines(1:), dp))
      end associate
      if (mod(n, 2) == 0) amplitudes(n/2) = 0.5_dp*amplitudes(n/2)
   end subroutine trigonometric_interpolation

   !> Where the plan for so many samples is kept.
   integer function plan_of(length)
      integer, intent(in) :: length

      plan_of = findloc(kept%length, length, dim=1)
      if (plan_of == 0) call prepare(length, plan_of)
   end function plan_of

   !> Replace the oldest plan of this thread. Plans are estimated, not measured: a measured plan may change the last
   !> bit from run to run. FFTW makes plans for one thread at a time.
   subroutine prepare(length, place)
      !> Number of samples
      integer, intent(in) :: length
      !> Where the new plan is kept
      integer, intent(out) :: place

      place = oldest
      oldest = modulo(oldest, kept_plans) + 1
      associate (transform => kept(place))
         if (associated(transform%samples)) deallocate (transform%samples, transform%lines)
         allocate (transform%samples(length), transform%lines(0:length/2))
         !$omp critical (fourier_plan)
         if (c_associated(transform%plan)) call fftw_destroy_plan(transform%plan)
         transform%plan = fftw_plan_dft_r2c_1d(length, transform%samples, transform%lines, FFTW_ESTIMATE)
         !$omp end critical (fourier_plan)
         transform%length = length
      end associate
   end subroutine prepare

end module fourier
