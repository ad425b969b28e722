!> Lines of text to standard output and to logs, and whether they have reached their readers: a full disk takes a log or a
!> template as it takes a result. (The runtime tells of no failure where it flushes a unit.)
module text_output
   use, intrinsic :: iso_c_binding, only: c_int
   use file_descriptor, only: standard_output, write_bytes
   use kinds, only: int64
   implicit none(type, external)
   private

   !> Module state is unavoidable here: the standard output is one for all, and its fate is asked for at the end.
   character(:), allocatable :: lost

   public :: put_text, put_line, write_line, note_lost_text, lost_text

contains

   !> Text to standard output, as it stands.
   subroutine put_text(text)
      character(*), intent(in) :: text

      call write_text(standard_output, text, 'the standard output')
   end subroutine put_text

   !> A line to standard output.
   subroutine put_line(text)
      character(*), intent(in) :: text

      call put_text(text//new_line('a'))
   end subroutine put_line

   !> A line to an open file.
   subroutine write_line(descriptor, text, path)
      integer(c_int), intent(in) :: descriptor
      character(*), intent(in) :: text
      character(*), intent(in) :: path

      call write_text(descriptor, text//new_line('a'), path)
   end subroutine write_line

   subroutine write_text(descriptor, text, path)
      integer(c_int), intent(in) :: descriptor
      character(*), intent(in) :: text
      character(*), intent(in) :: path
      logical :: complete

      call write_bytes(descriptor, len(text, kind=int64), text, complete)
      if (.not. complete) call note_lost_text(path)
   end subroutine write_text

   !> Note that words could not be written.
   subroutine note_lost_text(place)
      !> Where they should have gone
      character(*), intent(in) :: place

      if (.not. allocated(lost)) lost = place
   end subroutine note_lost_text

   !> Where words were lost first; empty if all that was told has been written.
   pure function lost_text() result(place)
      character(:), allocatable :: place

      place = ''
      if (allocated(lost)) place = lost
   end function lost_text

end module text_output
