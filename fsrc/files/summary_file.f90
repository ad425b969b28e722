!> NAME.summary.nml: one group &summary, readable by Fortran and f90nml. Unknown values are left out. A comment behind
!> the group holds the checksum of all bytes before it.
module summary_file
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use byte_file, only: byte_file_t, put_in_place
   use checksum, only: checksum_of
   use errors, only: error_t
   use file_system, only: read_whole_file
   use kinds, only: dp, int64
   use text, only: integer_text, logical_text, quoted, real_text
   use word_list, only: word_t
   implicit none(type, external)
   private

   !> First word of every summary, by which one is known.
   character(*), parameter, public :: summary_magic = '&summary'
   !> What stands before the checksum of a summary.
   character(*), parameter :: checksum_mark = '! checksum '

   !> A summary that is being put together.
   type, public :: summary_t
      private
      character(:), allocatable :: body
   contains
      generic :: add => add_real, add_reals, add_integer, add_long, add_logical, add_text, add_texts
      procedure :: next_group
      procedure :: write => write_summary
      procedure :: write_beside
      procedure, private :: add_real
      procedure, private :: add_reals
      procedure, private :: add_integer
      procedure, private :: add_long
      procedure, private :: add_logical
      procedure, private :: add_text
      procedure, private :: add_texts
      procedure, private :: add_line
   end type summary_t

   public :: value_in_summary, read_from_summary, checksum_in_summary

contains

   !> Add a real value; a number that is not finite has no namelist spelling and is unknown by rule.
   subroutine add_real(self, name, value)
      class(summary_t), intent(inout) :: self
      character(*), intent(in) :: name
      real(dp), intent(in) :: value

      if (ieee_is_finite(value)) call self%add_line(name, real_text(value))
   end subroutine add_real

   !> Add a list of real values, four to a line.
   subroutine add_reals(self, name, values)
      class(summary_t), intent(inout) :: self
      character(*), intent(in) :: name
      !> Values, none: the key is left out
      real(dp), intent(in) :: values(:)
      character(:), allocatable :: text
      integer :: i

      if (size(values) == 0) return
      text = real_text(values(1))
      do i = 2, size(values)
         text = text//', '
         if (mod(i, 4) == 1) text = text//new_line('a')//repeat(' ', 6)
         text = text//real_text(values(i))
      end do
      call self%add_line(name, text)
   end subroutine add_reals

   !> Add an integer.
   subroutine add_integer(self, name, value)
      class(summary_t), intent(inout) :: self
      character(*), intent(in) :: name
      integer, intent(in) :: value

      call self%add_line(name, integer_text(value))
   end subroutine add_integer

   !> Add a long integer.
   subroutine add_long(self, name, value)
      class(summary_t), intent(inout) :: self
      character(*), intent(in) :: name
      integer(int64), intent(in) :: value

      call self%add_line(name, integer_text(value))
   end subroutine add_long

   !> Add a logical.
   subroutine add_logical(self, name, value)
      class(summary_t), intent(inout) :: self
      character(*), intent(in) :: name
      logical, intent(in) :: value

      call self%add_line(name, logical_text(value))
   end subroutine add_logical

   !> Add a text.
   subroutine add_text(self, name, value)
      class(summary_t), intent(inout) :: self
      character(*), intent(in) :: name
      character(*), intent(in) :: value

      call self%add_line(name, quoted(value))
   end subroutine add_text

   !> Add a list of texts, one to a line.
   subroutine add_texts(self, name, values)
      class(summary_t), intent(inout) :: self
      character(*), intent(in) :: name
      !> Values, none: the key is left out
      type(word_t), intent(in) :: values(:)
      character(:), allocatable :: text
      integer :: i

      if (size(values) == 0) return
      text = quoted(values(1)%text)
      do i = 2, size(values)
         text = text//','//new_line('a')//repeat(' ', 6)//quoted(values(i)%text)
      end do
      call self%add_line(name, text)
   end subroutine add_texts

   subroutine add_line(self, name, value)
      class(summary_t), intent(inout) :: self
      character(*), intent(in) :: name
      character(*), intent(in) :: value

      if (.not. allocated(self%body)) self%body = ''
      self%body = self%body//'   '//name//' = '//value//new_line('a')
   end subroutine add_line

   !> Close the group and begin another; what is added goes there.
   subroutine next_group(self, name)
      class(summary_t), intent(inout) :: self
      character(*), intent(in) :: name

      self%body = self%body//'/'//new_line('a')//'&'//name//new_line('a')
   end subroutine next_group

   !> Write the file and put it in its place; what stands there stays until then.
   subroutine write_summary(self, path, error)
      class(summary_t), intent(in) :: self
      character(*), intent(in) :: path
      !> Set if it cannot be written
      type(error_t), allocatable, intent(out) :: error

      call self%write_beside(path, error)
      if (.not. allocated(error)) call put_in_place(path, error)
   end subroutine write_summary

   !> Write the file beside its place, for place_files to bring it there.
   subroutine write_beside(self, path, error)
      class(summary_t), intent(in) :: self
      character(*), intent(in) :: path
      !> Set if it cannot be written; nothing is left then
      type(error_t), allocatable, intent(out) :: error
      type(byte_file_t) :: file
      type(error_t), allocatable :: close_error
      character(:), allocatable :: text

      call file%open(path, error)
      if (allocated(error)) return
      text = summary_magic//new_line('a')//self%body//'/'//new_line('a')
      call file%put(text//checksum_mark//integer_text(checksum_of(text))//new_line('a'), error)
      call file%close(close_error)
      if (.not. allocated(error) .and. allocated(close_error)) call move_alloc(close_error, error)
   end subroutine write_beside

   !> Value of the first key of a name in a summary, without quotes; empty if there is none.
   function value_in_summary(path, name) result(value)
      character(*), intent(in) :: path
      character(*), intent(in) :: name
      character(:), allocatable :: value
      type(word_t), allocatable :: values(:)

      value = ''
      call read_from_summary(path, '   '//name//' = ', values)
      if (size(values) > 0) value = values(1)%text
   end function value_in_summary

   !> What follows in all lines of a summary that begin alike, without quotes.
   subroutine read_from_summary(path, start, values)
      character(*), intent(in) :: path
      !> How the lines begin
      character(*), intent(in) :: start
      !> As texts, in their order
      type(word_t), allocatable, intent(out) :: values(:)
      integer, parameter :: largest_summary = 10000000
      character(:), allocatable :: content, value
      integer :: place, stat

      allocate (values(0))
      call read_whole_file(path, largest_summary, content, stat)
      if (stat /= 0) return
      do
         place = index(content, new_line('a')//start)
         if (place == 0) return
         content = content(place + len(start) + 1:)
         value = content(:index(content//new_line('a'), new_line('a')) - 1)
         if (index(value, "'") == 1) value = value(2:len(value) - 1)
         values = [values, word_t(value)]
      end do
   end subroutine read_from_summary

   !> The checksum that ends a summary; 0 if it has none.
   integer(int64) function checksum_in_summary(path) result(stored)
      character(*), intent(in) :: path
      type(word_t), allocatable :: values(:)
      integer :: stat

      stored = 0_int64
      call read_from_summary(path, checksum_mark, values)
      if (size(values) > 0) read (values(size(values))%text, *, iostat=stat) stored
   end function checksum_in_summary

end module summary_file
