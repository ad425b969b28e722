!> Files that are read and written at any place, by several threads at once as long as their places differ,
!> with every failure seen. Thin calls of the C library.
module random_access_file
   use, intrinsic :: iso_c_binding, only: c_char, c_f_pointer, c_int, c_loc, c_long
   use errors, only: error_t, error_words, exit_system, interrupted_call, last_error, no_locks, no_such_call, not_supported, &
                     raise, would_wait
   use file_descriptor, only: close_descriptor, open_existing, open_or_make, read_and_write, read_bytes, read_only, &
                              synchronise_descriptor, write_bytes
   use file_system, only: is_at_path => stands_at
   use kinds, only: dp, int64
   implicit none(type, external)
   private

   integer(c_int), parameter :: exclusive_without_waiting = 6, from_end = 2

   !> Outcomes of a request for the lock.
   integer, parameter, public :: lock_held = 1, lock_refused = 2, lock_unknown = 3, lock_failed = 4

   !> An open file. Its procedures change nothing in it but open and close.
   type, public :: random_access_file_t
      private
      integer(c_int) :: descriptor = -1
      character(:), allocatable :: path
   contains
      procedure :: open => open_file
      procedure :: open_to_read
      procedure :: is_open
      procedure :: rename_path
      procedure :: lock
      procedure :: stands_at
      procedure :: set_size
      procedure :: bytes => file_bytes
      generic :: write_at => write_text_at, write_reals_at
      generic :: read_at => read_text_at, read_reals_at
      procedure :: synchronise
      procedure :: close => close_file
      procedure, private :: write_text_at
      procedure, private :: write_reals_at
      procedure, private :: read_text_at
      procedure, private :: read_reals_at
      procedure, private :: write_all
      procedure, private :: read_all
      procedure, private :: fail
   end type random_access_file_t

   interface
      function c_flock(descriptor, operation) bind(c, name='flock') result(stat)
         import :: c_int
         integer(c_int), value :: descriptor
         integer(c_int), value :: operation
         integer(c_int) :: stat
      end function c_flock

      function c_ftruncate(descriptor, length) bind(c, name='ftruncate') result(stat)
         import :: c_int, c_long
         integer(c_int), value :: descriptor
         integer(c_long), value :: length
         integer(c_int) :: stat
      end function c_ftruncate

      function c_lseek(descriptor, offset, origin) bind(c, name='lseek') result(place)
         import :: c_int, c_long
         integer(c_int), value :: descriptor
         integer(c_long), value :: offset
         integer(c_int), value :: origin
         integer(c_long) :: place
      end function c_lseek
   end interface

contains

   !> Open a file for reading and writing, whatever it holds.
   subroutine open_file(self, path, may_make, error)
      class(random_access_file_t), intent(inout) :: self
      character(*), intent(in) :: path
      !> Whether an empty file is made if there is none
      logical, intent(in) :: may_make
      !> Set if it cannot be opened
      type(error_t), allocatable, intent(out) :: error

      self%path = path
      if (may_make) then
         self%descriptor = open_or_make(path)
      else
         self%descriptor = open_existing(path, read_and_write)
      end if
      if (self%descriptor < 0) call self%fail('opened', error)
   end subroutine open_file

   !> Open a file for reading alone.
   subroutine open_to_read(self, path, error)
      class(random_access_file_t), intent(inout) :: self
      character(*), intent(in) :: path
      !> Set if it cannot be opened
      type(error_t), allocatable, intent(out) :: error

      self%path = path
      self%descriptor = open_existing(path, read_only)
      if (self%descriptor < 0) call self%fail('read', error)
   end subroutine open_to_read

   !> Whether there is an open file.
   pure logical function is_open(self)
      class(random_access_file_t), intent(in) :: self

      is_open = self%descriptor >= 0
   end function is_open

   !> Note that the open file has another path now.
   subroutine rename_path(self, path)
      class(random_access_file_t), intent(inout) :: self
      !> New path
      character(*), intent(in) :: path

      self%path = path
   end subroutine rename_path

   !> Ask for the advisory lock of the file, without waiting for it. It lasts until the file is closed or
   !> the program ends in whatever way. Some file systems of clusters know no locks.
   subroutine lock(self, outcome, why)
      class(random_access_file_t), intent(in) :: self
      !> lock_held, lock_refused (another run has it), lock_unknown (there are no locks here) or lock_failed (anything else)
      integer, intent(out) :: outcome
      !> What the operating system says where the lock is not held
      character(:), allocatable, intent(out) :: why
      integer(c_int) :: cause

      why = ''
      do
         outcome = lock_held
         if (c_flock(self%descriptor, exclusive_without_waiting) == 0) return
         cause = last_error()
         if (cause == interrupted_call) cycle
         outcome = lock_failed
         if (cause == would_wait) outcome = lock_refused
         if (any(cause == [no_locks, no_such_call, not_supported])) outcome = lock_unknown
         why = error_words(cause)
         return
      end do
   end subroutine lock

   !> Whether the open file is the one that stands at a path.
   logical function stands_at(self, path)
      class(random_access_file_t), intent(in) :: self
      character(*), intent(in) :: path

      stands_at = is_at_path(self%descriptor, path)
   end function stands_at

   !> Cut the file to a length, or lengthen it by zeros that take no place on the disk.
   subroutine set_size(self, bytes, error)
      class(random_access_file_t), intent(in) :: self
      !> New length
      integer(int64), intent(in) :: bytes
      !> Set if it cannot be done
      type(error_t), allocatable, intent(out) :: error

      if (c_ftruncate(self%descriptor, int(bytes, c_long)) /= 0) call self%fail('written', error)
   end subroutine set_size

   !> Length of the file.
   integer(int64) function file_bytes(self)
      class(random_access_file_t), intent(in) :: self

      file_bytes = int(c_lseek(self%descriptor, 0_c_long, from_end), int64)
   end function file_bytes

   !> Write text.
   subroutine write_text_at(self, offset, text, error)
      class(random_access_file_t), intent(in) :: self
      !> Bytes before it
      integer(int64), intent(in) :: offset
      character(*), intent(in) :: text
      !> Set if the disk is full, say
      type(error_t), allocatable, intent(out) :: error

      call self%write_all(offset, len(text, int64), text, error)
   end subroutine write_text_at

   !> Write numbers in the byte order of the machine.
   subroutine write_reals_at(self, offset, numbers, error)
      class(random_access_file_t), intent(in) :: self
      !> Bytes before them
      integer(int64), intent(in) :: offset
      !> Numbers in the order of the file
      real(dp), contiguous, target, intent(in) :: numbers(:, :)
      !> Set if the disk is full, say
      type(error_t), allocatable, intent(out) :: error
      character(kind=c_char), pointer :: bytes(:)

      if (size(numbers) == 0) return
      call c_f_pointer(c_loc(numbers), bytes, [8_int64*size(numbers, kind=int64)])
      call self%write_all(offset, size(bytes, kind=int64), bytes, error)
   end subroutine write_reals_at

   !> Read text; `complete` shows whether the file went so far.
   subroutine read_text_at(self, offset, text, complete)
      class(random_access_file_t), intent(in) :: self
      !> Bytes before it
      integer(int64), intent(in) :: offset
      !> Filled from the left
      character(*), intent(out) :: text
      !> Whether all of it was read
      logical, intent(out) :: complete

      call self%read_all(offset, len(text, int64), text, complete)
   end subroutine read_text_at

   !> Read numbers; `complete` shows whether the file went so far.
   subroutine read_reals_at(self, offset, numbers, complete)
      class(random_access_file_t), intent(in) :: self
      !> Bytes before them
      integer(int64), intent(in) :: offset
      !> Numbers in the order of the file
      real(dp), contiguous, target, intent(out) :: numbers(:, :)
      !> Whether all of them were read
      logical, intent(out) :: complete
      character(kind=c_char), pointer :: bytes(:)

      complete = .true.
      if (size(numbers) == 0) return
      call c_f_pointer(c_loc(numbers), bytes, [8_int64*size(numbers, kind=int64)])
      call self%read_all(offset, size(bytes, kind=int64), bytes, complete)
   end subroutine read_reals_at

   !> See that everything stands on the disk itself.
   subroutine synchronise(self, error)
      class(random_access_file_t), intent(in) :: self
      !> Set if the disk is full, say
      type(error_t), allocatable, intent(out) :: error
      logical :: stands

      call synchronise_descriptor(self%descriptor, stands)
      if (.not. stands) call self%fail('written', error)
   end subroutine synchronise

   !> Close the file, and give back its lock.
   subroutine close_file(self, error)
      class(random_access_file_t), intent(inout) :: self
      !> Set if the file is not complete
      type(error_t), allocatable, intent(out) :: error
      integer(c_int) :: descriptor
      logical :: closed

      if (self%descriptor < 0) return
      descriptor = self%descriptor
      self%descriptor = -1
      call close_descriptor(descriptor, closed)
      if (.not. closed) call self%fail('written', error)
   end subroutine close_file

   !> Write bytes at a place.
   subroutine write_all(self, offset, count, bytes, error)
      class(random_access_file_t), intent(in) :: self
      integer(int64), intent(in) :: offset
      integer(int64), intent(in) :: count
      character(kind=c_char), intent(in) :: bytes(count)
      type(error_t), allocatable, intent(out) :: error
      logical :: complete

      call write_bytes(self%descriptor, count, bytes, complete, offset)
      if (.not. complete) call self%fail('written', error)
   end subroutine write_all

   !> Read bytes at a place.
   subroutine read_all(self, offset, count, bytes, complete)
      class(random_access_file_t), intent(in) :: self
      integer(int64), intent(in) :: offset
      integer(int64), intent(in) :: count
      character(kind=c_char), intent(out) :: bytes(count)
      logical, intent(out) :: complete
      integer(int64) :: got
      logical :: failed

      call read_bytes(self%descriptor, count, bytes, got, failed, offset)
      complete = got == count
   end subroutine read_all

   !> Turn the failure of the last call into an error.
   subroutine fail(self, what, error)
      class(random_access_file_t), intent(in) :: self
      character(*), intent(in) :: what
      type(error_t), allocatable, intent(out) :: error

      call raise(error, exit_system, self%path//' cannot be '//what//': '//error_words(last_error()))
   end subroutine fail

end module random_access_file
