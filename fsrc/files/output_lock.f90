!> Keeps two runs from writing the same files: while a run lasts it holds the lock of STEM.lock, an empty file that
!> goes with the end of the run. One that a killed run has left stops nobody.
module output_lock
   use errors, only: error_t, exit_system, raise
   use file_system, only: delete_file
   use random_access_file, only: lock_held, lock_refused, random_access_file_t
   implicit none(type, external)
   private

   !> The lock of the files of a scene.
   type, public :: output_lock_t
      private
      type(random_access_file_t) :: file
      character(:), allocatable :: path
      logical :: held = .false.
   contains
      procedure :: take
      procedure :: release
   end type output_lock_t

   public :: lock_path

contains

   !> Path of the lock of the files of a scene.
   pure function lock_path(stem)
      !> Their path without what follows the name
      character(*), intent(in) :: stem
      character(:), allocatable :: lock_path

      lock_path = stem//'.lock'
   end function lock_path

   !> Take the lock. Where the file system knows no locks, the run goes on without.
   subroutine take(self, stem, error)
      class(output_lock_t), intent(inout) :: self
      !> Path of the files without what follows the name
      character(*), intent(in) :: stem
      !> Set if another run has it, or the file cannot be made
      type(error_t), allocatable, intent(out) :: error
      type(error_t), allocatable :: ignored
      integer :: outcome
      logical :: stands

      self%path = lock_path(stem)
      do
         call self%file%open(self%path, .true., error)
         if (allocated(error)) return
         call self%file%lock(outcome)
         self%held = outcome == lock_held
         if (outcome == lock_refused) then
            call self%file%close(ignored)
            call raise(error, exit_system, stem//' is being written by another run; wait for its end, or '// &
                       'choose another name or output directory')
            return
         end if
         ! A run that has just ended may have taken the file away between the opening and the lock.
         stands = self%file%stands_at(self%path)
         if (stands .or. .not. self%held) return
         call self%file%close(ignored)
      end do
   end subroutine take

   !> Give the lock back.
   subroutine release(self)
      class(output_lock_t), intent(inout) :: self
      type(error_t), allocatable :: ignored

      if (.not. self%file%is_open()) return
      call delete_file(self%path)
      call self%file%close(ignored)
      self%held = .false.
   end subroutine release

end module output_lock
