!> Text that a terminal shows and does not obey: words of an input stand in what is told of it.
module printable_text
   implicit none(type, external)
   private

   character(*), parameter :: hexadecimal = '0123456789ABCDEF'

   public :: printable

contains

   !> Text with every byte as \xHH that is neither a printable character of ASCII nor part of one in UTF-8. Line feeds stay if
   !> they may.
   pure function printable(text, keep_lines) result(shown)
      !> Any bytes
      character(*), intent(in) :: text
      !> Whether line feeds stay
      logical, intent(in) :: keep_lines
      character(:), allocatable :: shown
      integer :: at, used, length, code, i

      allocate (character(4*len(text)) :: shown)
      used = 0
      at = 1
      do while (at <= len(text))
         code = iachar(text(at:at))
         length = 0
         if (code >= 32 .and. code < 127) length = 1
         if (code == 10 .and. keep_lines) length = 1
         if (code >= 128) length = utf8_length(text(at:))
         if (length == 0) then
            i = code/16 + 1
            shown(used + 1:used + 4) = '\x'//hexadecimal(i:i)//hexadecimal(modulo(code, 16) + 1:modulo(code, 16) + 1)
            used = used + 4
            at = at + 1
         else
            shown(used + 1:used + length) = text(at:at + length - 1)
            used = used + length
            at = at + length
         end if
      end do
      shown = shown(:used)
   end function printable

   !> Bytes of the character in UTF-8 that a text begins with; 0 if it is none, or one that commands the terminal (below U+00A0).
   pure integer function utf8_length(text)
      character(*), intent(in) :: text
      integer :: lead, point, length, i

      utf8_length = 0
      lead = iachar(text(1:1))
      length = 4
      if (lead < 240) length = 3
      if (lead < 224) length = 2
      if (lead < 194 .or. lead > 244 .or. len(text) < length) return
      point = iand(lead, 127/2**length)
      do i = 2, length
         if (iand(iachar(text(i:i)), 192) /= 128) return
         point = 64*point + iand(iachar(text(i:i)), 63)
      end do
      if (point < 160) return
      if (length == 3 .and. (point < 2048 .or. (point >= 55296 .and. point < 57344))) return
      if (length == 4 .and. (point < 65536 .or. point > 1114111)) return
      utf8_length = length
   end function utf8_length

end module printable_text
