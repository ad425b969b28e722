!> Files that are written byte by byte, with every failure seen. The runtime's own unformatted and stream
!> output forgets that the disk was full when it empties its buffer; hence this one.
!>
!> A file is written beside its place, under a name that no one can foresee, and put there when it is complete, or as soon as what
!> it holds makes sense. Until then whatever stands at the place stays as it is.
module byte_file
   use, intrinsic :: iso_c_binding, only: c_char, c_f_pointer, c_int, c_loc
   use errors, only: error_t, error_words, exit_system, last_error, raise
   use file_descriptor, only: close_descriptor, open_new, synchronise_descriptor, write_bytes
   use file_system, only: delete_file, random_word, rename_file, rename_new, stands_at
   use kinds, only: dp, int64
   use text_output, only: lock_texts, unlock_texts
   implicit none(type, external)
   private

   !> Bytes that are gathered before they go to the disk.
   integer, parameter :: buffer_bytes = 65536
   !> Bytes after which the disk is waited for: what is left for the end is written within a second.
   integer(int64), parameter :: synchronised_bytes = 2_int64**26

   !> An open file.
   type, public :: byte_file_t
      private
      integer(c_int) :: descriptor = -1
      !> Whether a write has failed; nothing more is written then
      logical :: broken = .false.
      !> Whether it stands at its place
      logical :: placed = .false.
      integer :: used = 0
      !> Bytes that the disk may not have yet
      integer(int64) :: not_on_disk = 0_int64
      character(:), allocatable :: path
      character(kind=c_char), allocatable :: buffer(:)
   contains
      procedure :: open => open_file
      procedure :: is_open
      generic :: put => put_text, put_numbers
      procedure :: put_at
      procedure :: flush => flush_buffer
      procedure :: show
      procedure :: close => close_file
      procedure, private :: put_text
      procedure, private :: put_numbers
      procedure, private :: write_on
      procedure, private :: fail
   end type byte_file_t

   !> How a run calls what it puts beside its files; module state, for all files of a run are known by it.
   character(16) :: word_of_run = ''

   public :: new_path, old_path, own_word, put_in_place, raise_taken_away

contains

   !> Word by which this run calls what it puts beside its files.
   function own_word()
      character(16) :: own_word

      !$omp critical (word_of_run_is_made)
      if (word_of_run == '') word_of_run = random_word()
      own_word = word_of_run
      !$omp end critical (word_of_run_is_made)
   end function own_word

   !> Where a file is written until it is put in its place.
   function new_path(path)
      character(*), intent(in) :: path
      character(:), allocatable :: new_path

      new_path = path//'.'//own_word()//'.new'
   end function new_path

   !> Where an earlier file waits until others are in their places.
   function old_path(path)
      character(*), intent(in) :: path
      character(:), allocatable :: old_path

      old_path = path//'.'//own_word()//'.old'
   end function old_path

   !> Put a file that was written beside its place there, in one step; what stands there is replaced.
   subroutine put_in_place(path, error)
      character(*), intent(in) :: path
      !> Set if it cannot be done; what stands there stays then
      type(error_t), allocatable, intent(out) :: error
      logical :: moved

      call rename_file(new_path(path), path, moved)
      if (moved) return
      call raise(error, exit_system, path//' cannot be written: '//error_words(last_error()))
      call delete_file(new_path(path))
   end subroutine put_in_place

   !> Create a file beside its place.
   subroutine open_file(self, path, error)
      class(byte_file_t), intent(inout) :: self
      character(*), intent(in) :: path
      !> Set if it cannot be written
      type(error_t), allocatable, intent(out) :: error

      self%path = path
      self%used = 0
      self%broken = .false.
      self%placed = .false.
      self%not_on_disk = 0_int64
      if (.not. allocated(self%buffer)) allocate (self%buffer(buffer_bytes))
      self%descriptor = open_new(new_path(path))
      if (self%descriptor < 0) call self%fail(error)
   end subroutine open_file

   !> Whether there is a file to write to.
   pure logical function is_open(self)
      class(byte_file_t), intent(in) :: self

      is_open = self%descriptor >= 0
   end function is_open

   !> Append text.
   subroutine put_text(self, text, error)
      class(byte_file_t), intent(inout) :: self
      character(*), intent(in) :: text
      !> Set if the disk is full, say
      type(error_t), allocatable, intent(out) :: error
      integer :: first, last

      first = 1
      do while (first <= len(text))
         if (self%used == buffer_bytes) call self%flush(error)
         if (allocated(error)) return
         last = min(len(text), first + buffer_bytes - self%used - 1)
         self%buffer(self%used + 1:self%used + last - first + 1) = transfer(text(first:last), self%buffer)
         self%used = self%used + last - first + 1
         first = last + 1
      end do
   end subroutine put_text

   !> Append numbers in the byte order of the machine. Many at once go to the disk as they stand.
   subroutine put_numbers(self, numbers, error)
      class(byte_file_t), intent(inout) :: self
      !> Numbers in the order of the file
      real(dp), contiguous, target, intent(in) :: numbers(:, :)
      !> Set if the disk is full, say
      type(error_t), allocatable, intent(out) :: error
      character(kind=c_char), pointer, contiguous :: bytes(:)

      if (size(numbers) == 0) return
      call c_f_pointer(c_loc(numbers), bytes, [8*size(numbers, kind=int64)])
      if (self%used + size(bytes, kind=int64) > buffer_bytes) call self%flush(error)
      if (allocated(error)) return
      if (size(bytes, kind=int64) >= buffer_bytes) then
         call self%write_on(bytes, error)
      else
         self%buffer(self%used + 1:self%used + size(bytes)) = bytes
         self%used = self%used + size(bytes)
      end if
   end subroutine put_numbers

   !> Write over what stands at a place; everything before is on the disk then.
   subroutine put_at(self, offset, bytes, error)
      class(byte_file_t), intent(inout) :: self
      !> Bytes before it
      integer(int64), intent(in) :: offset
      character(*), intent(in) :: bytes
      !> Set if the disk is full, say
      type(error_t), allocatable, intent(out) :: error
      logical :: complete

      call self%flush(error)
      if (allocated(error)) return
      call write_bytes(self%descriptor, len(bytes, int64), bytes, complete, offset)
      if (.not. complete) call self%fail(error)
   end subroutine put_at

   !> Hand everything to the operating system.
   subroutine flush_buffer(self, error)
      class(byte_file_t), intent(inout) :: self
      !> Set if the disk is full, say
      type(error_t), allocatable, intent(out) :: error
      integer :: used

      used = self%used
      self%used = 0
      if (used > 0) call self%write_on(self%buffer(:used), error)
   end subroutine flush_buffer

   !> Put the file in its place already, if nothing stands there: what is written into it afterwards goes there. Where another run
   !> was faster it stays beside its place.
   subroutine show(self, error)
      class(byte_file_t), intent(inout) :: self
      !> Set if the disk is full, say
      type(error_t), allocatable, intent(out) :: error

      call self%flush(error)
      if (.not. allocated(error)) call rename_new(new_path(self%path), self%path, self%placed)
   end subroutine show

   !> Close the file, which stands on the disk itself then. After a failed write nothing more is written, and no
   !> second error is raised; a file beside its place is taken away.
   subroutine close_file(self, error)
      class(byte_file_t), intent(inout) :: self
      !> Set if the file is not complete
      type(error_t), allocatable, intent(out) :: error
      integer(c_int) :: descriptor
      logical :: sound

      if (self%descriptor < 0) return
      if (.not. self%broken) call self%flush(error)
      if (.not. self%broken) then
         call synchronise_descriptor(self%descriptor, sound)
         if (.not. sound) call self%fail(error)
      end if
      if (.not. self%broken) call expect_at_place(self, error)
      descriptor = self%descriptor
      self%descriptor = -1
      call close_descriptor(descriptor, sound)
      if (.not. sound .and. .not. self%broken) call self%fail(error)
      if (self%broken .and. .not. self%placed) call delete_file(new_path(self%path))
   end subroutine close_file

   !> See that no one has taken the file away: what is written into a file without a name is lost.
   subroutine expect_at_place(self, error)
      class(byte_file_t), intent(inout) :: self
      !> Set if it does not stand where it should
      type(error_t), allocatable, intent(out) :: error
      logical :: stands

      if (self%placed) then
         stands = stands_at(self%descriptor, self%path)
      else
         stands = stands_at(self%descriptor, new_path(self%path))
      end if
      if (stands) return
      self%broken = .true.
      call raise_taken_away(self%path, error)
   end subroutine expect_at_place

   !> Say that a file was taken away under the run that writes it.
   subroutine raise_taken_away(path, error)
      character(*), intent(in) :: path
      !> Set
      type(error_t), allocatable, intent(out) :: error

      call raise(error, exit_system, path//' cannot be written: it was removed or replaced while the run wrote it')
   end subroutine raise_taken_away

   !> Write bytes behind those that the file has.
   subroutine write_on(self, bytes, error)
      class(byte_file_t), intent(inout) :: self
      character(kind=c_char), contiguous, intent(in) :: bytes(:)
      type(error_t), allocatable, intent(out) :: error
      logical :: complete

      call write_bytes(self%descriptor, size(bytes, kind=int64), bytes, complete)
      if (.not. complete) call self%fail(error)
      self%not_on_disk = self%not_on_disk + size(bytes, kind=int64)
      if (self%not_on_disk < synchronised_bytes .or. .not. complete) return
      self%not_on_disk = 0_int64
      call synchronise_descriptor(self%descriptor, complete)
      if (.not. complete) call self%fail(error)
   end subroutine write_on

   !> Turn the failure of the last call into an error.
   subroutine fail(self, error)
      class(byte_file_t), intent(inout) :: self
      type(error_t), allocatable, intent(out) :: error

      integer(c_int) :: cause

      cause = last_error()
      self%broken = .true.
      call lock_texts()
      call raise(error, exit_system, self%path//' cannot be written: '//error_words(cause))
      call unlock_texts()
   end subroutine fail

end module byte_file
