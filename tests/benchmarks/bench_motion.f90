!> Takers that forget every sample: the motion alone is timed.
module silent_motion
   use engine, only: checkpoint_t, ending_t, motion_watcher_t, sample_sink_t
   use errors, only: error_t
   use kinds, only: dp, int64
   implicit none(type, external)
   private

   type, extends(sample_sink_t), public :: no_sink_t
   contains
      procedure :: take => forget
      procedure :: begin_window => forget_window
   end type no_sink_t

   type, extends(motion_watcher_t), public :: no_watcher_t
   contains
      procedure :: period_done => ignore
   end type no_watcher_t

contains

   subroutine forget(self, first_step, force, states, acceleration, error)
      class(no_sink_t), intent(inout) :: self
      integer(int64), intent(in) :: first_step
      real(dp), intent(in) :: force(:)
      real(dp), intent(in) :: states(:, :)
      real(dp), intent(in) :: acceleration(:)
      type(error_t), allocatable, intent(out) :: error

      if (.false.) print *, same_type_as(self, self), first_step, force, states, acceleration, allocated(error)
   end subroutine forget

   subroutine forget_window(self, first_step, samples)
      class(no_sink_t), intent(inout) :: self
      integer(int64), intent(in) :: first_step
      integer, intent(in) :: samples

      if (.false.) print *, same_type_as(self, self), first_step, samples
   end subroutine forget_window

   subroutine ignore(self, done, all)
      class(no_watcher_t), intent(inout) :: self
      integer, intent(in) :: done
      integer, intent(in) :: all

      if (.false.) print *, same_type_as(self, self), done, all
   end subroutine ignore

end module silent_motion

!> Cost of a Newmark step on the scenes whose inputs are given: median over rounds, one line a scene.
program bench_motion
   use engine, only: checkpoint_t, ending_t
   use errors, only: error_t, fault_list_t
   use kinds, only: dp, int64
   use newmark_engine, only: solve_newmark
   use prepared_scene, only: request_of, resolve, resolved_scene_t
   use scene_reader, only: override_t, read_scenes
   use scene_types, only: scene_t
   use silent_motion, only: no_sink_t, no_watcher_t
   use window_record, only: window_record_t
   implicit none(type, external)

   integer, parameter :: rounds = 41
   type(scene_t) :: scene
   type(scene_t), allocatable :: scenes(:)
   type(resolved_scene_t) :: resolved
   type(fault_list_t) :: faults
   type(no_sink_t) :: sink
   type(no_watcher_t) :: watcher
   type(checkpoint_t) :: checkpoint
   type(ending_t) :: ending
   type(window_record_t) :: record
   type(error_t), allocatable :: error
   character(512) :: path
   real(dp) :: nanoseconds(rounds)
   integer(int64) :: start, finish, rate
   integer :: i, round

   do i = 1, command_argument_count()
      call get_command_argument(i, path)
      call read_scenes(trim(path), [override_t ::], scenes, faults)
      if (faults%count() > 0) error stop 'bench_motion: an input has faults'
      scene = scenes(1)
      resolved = resolve(scene)
      do round = 1, rounds
         call system_clock(start, rate)
         checkpoint = checkpoint_t()
         call solve_newmark(resolved%problem, request_of(scene), sink, watcher, checkpoint, ending, record, error)
         call system_clock(finish)
         nanoseconds(round) = 1.0e9_dp*real(finish - start, dp)/real(rate, dp)/real(ending%count%steps, dp)
      end do
      print '(a, a1, f0.2, a1, f0.4)', trim(scene%name), ',', median(nanoseconds), ',', &
         real(ending%count%evaluations, dp)/real(ending%count%steps, dp)
   end do

contains

   real(dp) function median(values)
      real(dp), intent(in) :: values(:)
      real(dp) :: sorted(size(values)), moving
      integer :: i, j

      sorted = values
      do i = 2, size(sorted)
         moving = sorted(i)
         do j = i - 1, 1, -1
            if (sorted(j) <= moving) exit
            sorted(j + 1) = sorted(j)
         end do
         sorted(j + 1) = moving
      end do
      median = sorted((size(sorted) + 1)/2)
   end function median

end program bench_motion
