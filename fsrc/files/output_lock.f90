!> Keeps two runs from writing the same files: while a run lasts it holds the lock of STEM.lock, a file that goes with the end of
!> the run and shows by which word the run calls what it puts beside its files. One that a killed run has left stops no one, and
!> what that run has left beside its files is taken away.
!>
!> Where the file system knows no locks, the file shows which run began last: it wins, and the others keep nothing. A run that
!> gives up hands the lock back to the one before, which may be at work still.
module output_lock
   use byte_file, only: own_word
   use, intrinsic :: iso_c_binding, only: c_int
   use errors, only: error_t, error_words, exit_system, is_shortage, raise
   use file_system, only: delete_file, file_state_t, first_bytes, found_files, is_link, state_of_path
   use kinds, only: int64
   use random_access_file, only: lock_failed, lock_held, lock_refused, random_access_file_t
   use result_format, only: result_magic
   use summary_file, only: summary_magic
   use word_list, only: word_t
   implicit none(type, external)
   private

   !> What a lock begins with, by which it is known; the word of its run follows.
   character(*), parameter, public :: lock_magic = 'rattle lock '
   integer, parameter :: lock_bytes = len(lock_magic) + 16

   !> The lock of the files of a scene.
   type, public :: output_lock_t
      !> What must be known where the file system knows no locks; else empty
      character(:), allocatable :: warning
      type(random_access_file_t), private :: file
      character(:), allocatable, private :: stem
      logical, private :: held = .false.
      !> Where the file system knows no locks: the lock of the run before, empty: there was none
      character(:), allocatable, private :: before
   contains
      procedure :: take
      procedure :: release
   end type output_lock_t

   !> Whether a lock could not be had in this run; module state, for whoever puts files in their places asks.
   logical :: without_locks = .false.

   public :: lock_path, expect_own_lock, runs_without_locks

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
      character(:), allocatable :: why
      integer :: outcome
      logical :: stands

      self%stem = stem
      self%warning = ''
      self%before = ''
      do
         call self%file%open(lock_path(stem), .true., error)
         if (allocated(error)) return
         call self%file%lock(outcome, why)
         self%held = outcome == lock_held
         if (outcome == lock_refused .or. outcome == lock_failed) then
            call self%file%close(ignored)
            if (outcome == lock_refused) call raise(error, exit_system, stem//' is being written by another run; wait for '// &
                                                    'its end, or choose another name or output directory')
            if (outcome == lock_failed) call raise(error, exit_system, lock_path(stem)//' cannot be locked: '//why)
            return
         end if
         ! A run that has just ended may have taken the file away between the opening and the lock.
         stands = self%file%stands_at(lock_path(stem))
         if (stands .or. .not. self%held) exit
         call self%file%close(ignored)
      end do
      if (self%held) then
         call remove_leftovers(stem)
         call self%file%set_size(0_int64, error)
      else
         without_locks = .true.
         call keep_before(self)
         self%warning = 'warning: this file system has no locks ('//why//'); see that no other run writes here'
         if (self%file%bytes() > 0_int64) self%warning = self%warning//': '//lock_path(stem)//' exists: another run is writing '// &
                                                         'here, or was killed'
      end if
      if (.not. allocated(error)) call self%file%write_at(0_int64, lock_magic//own_word(), error)
      ! A full disk is no reason not to run: only where there are no locks the word is needed.
      if (self%held .and. allocated(error)) deallocate (error)
   end subroutine take

   !> Keep what a lock held before it becomes that of this run.
   subroutine keep_before(self)
      class(output_lock_t), intent(inout) :: self
      character(lock_bytes) :: content
      logical :: complete

      call self%file%read_at(0_int64, content, complete)
      if (complete) self%before = content
   end subroutine keep_before

   !> Take away what killed runs have left beside the files of this run. While it holds the lock no other run is at work.
   subroutine remove_leftovers(stem)
      character(*), intent(in) :: stem
      character(*), parameter :: kinds(6) = [character(16) :: '.rattle', '.profiles.rattle', '.motions.rattle', '.state', &
                                             '.summary.nml', '.progress.nml']
      character(*), parameter :: word = repeat('[0-9a-f]', 16)
      character(max(len(result_magic), len(summary_magic))) :: start
      type(word_t), allocatable :: paths(:)
      type(file_state_t) :: state
      integer :: i, j, got
      logical :: ours, leads_away

      do i = 1, size(kinds)
         call found_files(stem//trim(kinds(i))//'.', word//'.[no][el][wd]', paths)
         do j = 1, size(paths)
            leads_away = is_link(paths(j)%text)
            if (leads_away) cycle
            state = state_of_path(paths(j)%text)
            if (.not. state%is_file) cycle
            call first_bytes(paths(j)%text, start, got)
            ! A kill may have come before all of the first word was there; a crash of the machine may leave zeros.
            ours = index(result_magic, start(:min(got, len(result_magic)))) == 1 .or. &
                   index(summary_magic, start(:min(got, len(summary_magic)))) == 1 .or. verify(start(:got), achar(0)) == 0
            if (ours) call delete_file(paths(j)%text)
         end do
      end do
   end subroutine remove_leftovers

   !> See that no run has begun with the same files since this one did: where there are no locks, the last one wins.
   subroutine expect_own_lock(stem, error)
      !> Path of the files without what follows the name
      character(*), intent(in) :: stem
      !> Set if one has
      type(error_t), allocatable, intent(out) :: error
      character(:), allocatable :: own
      character(lock_bytes) :: content
      integer :: got
      integer(c_int) :: cause

      own = lock_magic//own_word()
      call first_bytes(lock_path(stem), content, got, cause)
      ! Where there are no locks, one that is gone may have gone with a later run.
      if (got == len(content) .and. content == own) return
      if (got < len(content) .and. .not. without_locks) return
      if (is_shortage(cause)) then
         call raise(error, exit_system, lock_path(stem)//' cannot be opened: '//error_words(cause))
      else if (index(content, lock_magic) == 1 .or. got < len(content)) then
         call raise(error, exit_system, stem//' is being written by another run, which began later; what this run has computed '// &
                    'is not kept')
      else
         call raise(error, exit_system, lock_path(stem)//' was written over by another program; what this run has computed is '// &
                    'not kept')
      end if
   end subroutine expect_own_lock

   !> Whether a lock could not be had in this run: another run may write the same files then.
   logical function runs_without_locks()
      runs_without_locks = without_locks
   end function runs_without_locks

   !> Give the lock back; where there are no locks it may be that of another run by now.
   subroutine release(self, gave_up)
      class(output_lock_t), intent(inout) :: self
      !> Whether this run keeps nothing, so that one before it may
      logical, intent(in) :: gave_up
      type(error_t), allocatable :: ignored, of_another

      if (.not. self%file%is_open()) return
      if (.not. self%held) call expect_own_lock(self%stem, of_another)
      if (allocated(of_another)) then
         continue
      else if (gave_up .and. len(self%before) > 0) then
         call self%file%write_at(0_int64, self%before, ignored)
      else
         call delete_file(lock_path(self%stem))
      end if
      call self%file%close(ignored)
      self%held = .false.
   end subroutine release

end module output_lock
