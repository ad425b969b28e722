!> Files that are written byte by byte, with every failure seen. The runtime's own unformatted and stream
!> output forgets that the disk was full when it empties its buffer; hence this one.
module byte_file
   use, intrinsic :: iso_c_binding, only: c_char, c_f_pointer, c_int, c_loc
   use errors, only: error_t, exit_system, raise
   use file_descriptor, only: close_descriptor, open_replacing, write_bytes
   use kinds, only: dp, int64
   use system_error, only: error_words, last_error
   implicit none(type, external)
   private

   !> Bytes that are gathered before they go to the disk.
   integer, parameter :: buffer_bytes = 65536

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
      procedure, private :: write_on
      procedure, private :: fail
   end type byte_file_t

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
      self%descriptor = open_replacing(path)
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
         call self%write_on(bytes, error)
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
      logical :: complete

      call self%flush(error)
      if (allocated(error)) return
      bytes = transfer(number, bytes)
      call write_bytes(self%descriptor, 8_int64, bytes, complete, offset)
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

   !> Close the file. After a failed write nothing more is written, and no second error is raised.
   subroutine close_file(self, error)
      class(byte_file_t), intent(inout) :: self
      !> Set if the file is not complete
      type(error_t), allocatable, intent(out) :: error
      integer(c_int) :: descriptor
      logical :: closed

      if (self%descriptor < 0) return
      if (.not. self%broken) call self%flush(error)
      descriptor = self%descriptor
      self%descriptor = -1
      call close_descriptor(descriptor, closed)
      if (.not. closed .and. .not. self%broken) call self%fail(error)
   end subroutine close_file

   !> Write bytes behind those that the file has.
   subroutine write_on(self, bytes, error)
      class(byte_file_t), intent(inout) :: self
      character(kind=c_char), contiguous, intent(in) :: bytes(:)
      type(error_t), allocatable, intent(out) :: error
      logical :: complete

      call write_bytes(self%descriptor, size(bytes, kind=int64), bytes, complete)
      if (.not. complete) call self%fail(error)
   end subroutine write_on

   !> Turn the failure of the last call into an error.
   subroutine fail(self, error)
      class(byte_file_t), intent(inout) :: self
      type(error_t), allocatable, intent(out) :: error

      self%broken = .true.
      call raise(error, exit_system, self%path//' cannot be written: '//error_words(last_error()))
   end subroutine fail

end module byte_file
