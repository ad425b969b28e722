!> Keeps the window of a motion out of the samples that an engine hands over.
module window_keeper
   use engine, only: sample_sink_t
   use errors, only: error_t
   use kinds, only: dp, int64
   use problem, only: problem_t, state_size
   implicit none(type, external)
   private

   !> Keeper of the window of a single motion.
   type, extends(sample_sink_t), public :: window_keeper_t
      !> Sample, number of its state, 1; and z'' [m/s2]; not allocated before a window has begun
      real(dp), allocatable :: states(:, :, :), accelerations(:)
      integer(int64), private :: first_step = huge(1_int64)
      integer, private :: numbers = 0
   contains
      procedure :: keep_windows_of
      procedure :: take => keep_samples
      procedure :: begin_window => make_room
   end type window_keeper_t

contains

   !> Prepare for the samples of a problem.
   subroutine keep_windows_of(self, problem)
      class(window_keeper_t), intent(inout) :: self
      type(problem_t), intent(in) :: problem

      self%numbers = state_size(problem)
   end subroutine keep_windows_of

   !> Make room for the window.
   subroutine make_room(self, first_step, samples)
      class(window_keeper_t), intent(inout) :: self
      !> Step of its first sample
      integer(int64), intent(in) :: first_step
      !> How many samples it has
      integer, intent(in) :: samples

      if (allocated(self%states)) deallocate (self%states, self%accelerations)
      allocate (self%states(samples, self%numbers, 1), self%accelerations(samples))
      self%first_step = first_step
   end subroutine make_room

   !> Keep what belongs to the window.
   subroutine keep_samples(self, first_step, force, states, acceleration, error)
      class(window_keeper_t), intent(inout) :: self
      !> Step of the first sample
      integer(int64), intent(in) :: first_step
      !> Applied force F [N]
      real(dp), intent(in) :: force(:)
      !> Sample, number of its state
      real(dp), intent(in) :: states(:, :)
      !> Acceleration z'' [m/s2]
      real(dp), intent(in) :: acceleration(:)
      !> Never set
      type(error_t), allocatable, intent(out) :: error
      integer :: place

      if (first_step < self%first_step) return
      place = int(first_step - self%first_step) + 1
      self%states(place:place + size(force) - 1, :, 1) = states(:, :self%numbers)
      self%accelerations(place:place + size(force) - 1) = acceleration
   end subroutine keep_samples

end module window_keeper
