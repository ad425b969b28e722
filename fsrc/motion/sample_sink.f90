!> Where the motion hands its samples, whole periods at a time. The motion never knows what becomes of them.
module sample_sink
   use errors, only: error_t
   use kinds, only: dp, int64
   implicit none(type, external)
   private

   !> Taker of samples.
   type, abstract, public :: sample_sink_t
   contains
      procedure(take_samples), deferred :: take
      procedure(open_window), deferred :: begin_window
   end type sample_sink_t

   abstract interface
      !> Take consecutive samples; the initial state comes alone as step 0.
      subroutine take_samples(self, first_step, force, film, velocity, acceleration, error)
         import :: dp, error_t, int64, sample_sink_t
         class(sample_sink_t), intent(inout) :: self
         !> Step of the first sample
         integer(int64), intent(in) :: first_step
         !> Applied force F, one per sample [N]
         real(dp), intent(in) :: force(:)
         !> Film thickness h [m]
         real(dp), intent(in) :: film(:)
         !> Film velocity z' [m/s]
         real(dp), intent(in) :: velocity(:)
         !> Acceleration z'' [m/s2]
         real(dp), intent(in) :: acceleration(:)
         !> Set if the samples could not be kept
         type(error_t), allocatable, intent(out) :: error
      end subroutine take_samples

      !> Told before its first sample where the window begins that the motion is judged by.
      subroutine open_window(self, first_step, samples)
         import :: int64, sample_sink_t
         class(sample_sink_t), intent(inout) :: self
         !> Step of its first sample
         integer(int64), intent(in) :: first_step
         !> How many samples it has
         integer, intent(in) :: samples
      end subroutine open_window
   end interface

end module sample_sink
