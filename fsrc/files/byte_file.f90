!> Files that are written byte by byte, with every failure seen. The runtime's own unformatted and stream
!> output forgets that the disk was full when it empties its buffer; hence these thin calls of the C library.
module byte_file
   use, intrinsic :: iso_c_binding, only: c_char, c_f_pointer, c_int, c_loc, c_long, c_null_char, c_size_t
   use errors, only: error_t, exit_system, raise
   use kinds, only: dp, int64
   use system_error, only: error_words, last_error
   implicit none(type, external)
   private

   !> Bytes that are gathered before they go to the disk.
   integer, parameter :: buffer_bytes = 65536
   integer(c_int), parameter :: read_and_write_for_all = 438, interrupted_call = 4

   !> An open file.
   type, public :: byte_file_t
      private
      integer(c_int) :: descriptor = -1
      !> Whether a write has failed; nothing more is written then
      logical :: broken = .false.
      integer :: used = 0
      character(:), allocatable :: path
      character(kind=c_char), allocatable :: buffer(:)
   contains
      procedure :: open => open_file
      procedure :: is_open
      generic :: put => put_text, put_numbers
      procedure :: put_at
      procedure :: flush => flush_buffer
      procedure :: close => close_file
      procedure, private :: put_text
      procedure, private :: put_numbers
      procedure, private :: write_bytes
      procedure, private :: fail
   end type byte_file_t

   interface
      function c_creat(path, mode) bind(c, name='creat') result(descriptor)
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int), value :: mode
         integer(c_int) :: descriptor
      end function c_creat

      function c_write(descriptor, bytes, count) bind(c, name='write') result(written)
         import :: c_char, c_int, c_size_t
         integer(c_int), value :: descriptor
         character(kind=c_char), intent(in) :: bytes(*)
         integer(c_size_t), value :: count
         integer(c_size_t) :: written
      end function c_write

      function c_pwrite(descriptor, bytes, count, offset) bind(c, name='pwrite') result(written)
         import :: c_char, c_int, c_long, c_size_t
         integer(c_int), value :: descriptor
         character(kind=c_char), intent(in) :: bytes(*)
         integer(c_size_t), value :: count
         integer(c_long), value :: offset
         integer(c_size_t) :: written
      end function c_pwrite

      function c_close(descriptor) bind(c, name='close') result(stat)
         import :: c_int
         integer(c_int), value :: descriptor
         integer(c_int) :: stat
      end function c_close
   end interface

contains

   !> Create a file; one that stands there is replaced.
   subroutine open_file(self, path, error)
      class(byte_file_t), intent(inout) :: self
      !> Path of the file
      character(*), intent(in) :: path
      !> Set if it cannot be written
      type(error_t), allocatable, intent(out) :: error

      self%path = path
      self%used = 0
      self%broken = .false.
      if (.not. allocated(self%buffer)) allocate (self%buffer(buffer_bytes))
      self%descriptor = c_creat(path//c_null_char, read_and_write_for_all)
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
      !> Bytes as they are
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
      character(kind=c_char), pointer :: bytes(:)

      if (size(numbers) == 0) return
      call c_f_pointer(c_loc(numbers), bytes, [8*size(numbers, kind=int64)])
      if (self%used + size(bytes, kind=int64) > buffer_bytes) call self%flush(error)
      if (allocated(error)) return
      if (size(bytes, kind=int64) >= buffer_bytes) then
         call self%write_bytes(bytes, error)
      else
         self%buffer(self%used + 1:self%used + size(bytes)) = bytes
         self%used = self%used + size(bytes)
      end if
   end subroutine put_numbers

   !> Write a long integer over what stands at a place; everything before is on the disk then.
   subroutine put_at(self, offset, number, error)
      class(byte_file_t), intent(inout) :: self
      !> Bytes before it
      integer(int64), intent(in) :: offset
      !> The number
      integer(int64), intent(in) :: number
      !> Set if the disk is full, say
      type(error_t), allocatable, intent(out) :: error
      character(8) :: bytes

      call self%flush(error)
      if (allocated(error)) return
      bytes = transfer(number, bytes)
      if (c_pwrite(self%descriptor, bytes, 8_c_size_t, int(offset, c_long)) /= 8_c_size_t) call self%fail(error)
   end subroutine put_at

   !> Hand everything to the operating system.
   subroutine flush_buffer(self, error)
      class(byte_file_t), intent(inout) :: self
      !> Set if the disk is full, say
      type(error_t), allocatable, intent(out) :: error
      integer :: used

      used = self%used
      self%used = 0
      if (used > 0) call self%write_bytes(self%buffer(:used), error)
   end subroutine flush_buffer

   !> Close the file. After a failed write nothing more is written, and no second error is raised.
   subroutine close_file(self, error)
      class(byte_file_t), intent(inout) :: self
      !> Set if the file is not complete
      type(error_t), allocatable, intent(out) :: error
      integer(c_int) :: descriptor

      if (self%descriptor < 0) return
      if (.not. self%broken) call self%flush(error)
      descriptor = self%descriptor
      self%descriptor = -1
      ! A disk across the network may report only now that it is full.
      if (c_close(descriptor) /= 0 .and. .not. self%broken) call self%fail(error)
   end subroutine close_file

   !> Write bytes, in as many calls as it takes.
   subroutine write_bytes(self, bytes, error)
      class(byte_file_t), intent(inout) :: self
      character(kind=c_char), contiguous, intent(in) :: bytes(:)
      type(error_t), allocatable, intent(out) :: error
      integer(c_size_t) :: done, written
      integer(c_int) :: cause

      done = 0
      do while (done < size(bytes, kind=c_size_t))
         written = c_write(self%descriptor, bytes(done + 1:), size(bytes, kind=c_size_t) - done)
         if (written > 0) then
            done = done + written
            cycle
         end if
         cause = last_error()
         if (written < 0 .and. cause == interrupted_call) cycle
         call self%fail(error)
         return
      end do
   end subroutine write_bytes

   !> Turn the failure of the last call into an error.
   subroutine fail(self, error)
      class(byte_file_t), intent(inout) :: self
      type(error_t), allocatable, intent(out) :: error

      self%broken = .true.
      call raise(error, exit_system, self%path//' cannot be written: '//error_words(last_error()))
   end subroutine fail

end module byte_file
