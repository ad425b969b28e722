!> Text helpers: numbers to text, lower case, quoting, nearest known word, text that a terminal shows and does not obey.
module text
   use kinds, only: dp, int64
   implicit none(type, external)
   private

   public :: counted, integer_text, real_text, short_text, error_text, stated_error, logical_text, lower, spaced, quoted, &
             quoted_words, edit_distance, is_word_character, printable

   interface counted
      module procedure counted_default
      module procedure counted_long
   end interface counted

   interface integer_text
      module procedure integer_text_default
      module procedure integer_text_long
   end interface integer_text

   character(*), parameter :: hexadecimal = '0123456789ABCDEF'
   !> Significant digits of an error, and the share of a unit of the last one that is rounding of binary numbers
   integer, parameter :: error_digits = 2
   real(dp), parameter :: rounding_share = 1.0e-9_dp

contains

   !> Decimal digits of an integer.
   pure function integer_text_default(number) result(text)
      !> Any integer
      integer, intent(in) :: number
      character(:), allocatable :: text

      text = integer_text_long(int(number, int64))
   end function integer_text_default

   !> Decimal digits of a long integer.
   pure function integer_text_long(number) result(text)
      !> Any integer
      integer(int64), intent(in) :: number
      character(:), allocatable :: text
      character(20) :: buffer

      write (buffer, '(ss, i0)') number
      text = trim(buffer)
   end function integer_text_long

   !> A count with its noun, as in '1 rank' or '2 ranks'.
   pure function counted_default(number, noun) result(text)
      !> Any integer
      integer, intent(in) :: number
      !> Of one thing
      character(*), intent(in) :: noun
      character(:), allocatable :: text

      text = counted_long(int(number, int64), noun)
   end function counted_default

   !> The same of a large count.
   pure function counted_long(number, noun) result(text)
      !> Any integer
      integer(int64), intent(in) :: number
      !> Of one thing
      character(*), intent(in) :: noun
      character(:), allocatable :: text

      text = integer_text(number)//' '//noun
      if (number /= 1) text = text//'s'
   end function counted_long

   !> Shortest decimal text that reads back to the same number.
   pure function real_text(number) result(text)
      !> Any finite number
      real(dp), intent(in) :: number
      character(:), allocatable :: text
      character(32) :: buffer
      real(dp) :: back
      integer :: digits, stat

      if (.not. abs(number) > 0.0_dp) then
         text = '0.0'
         return
      end if
      if (is_plain(number)) then
         do digits = 1, 17
            write (buffer, '(ss, f32.'//integer_text(digits)//')') number
            read (buffer, *, iostat=stat) back
            if (stat == 0 .and. transfer(back, 1_int64) == transfer(number, 1_int64)) then
               text = trim(adjustl(buffer))
               if (text(1:1) == '.') text = '0'//text
               return
            end if
         end do
      end if
      do digits = 0, 17
         write (buffer, '(ss, es32.'//integer_text(digits)//'e3)') number
         read (buffer, *, iostat=stat) back
         if (stat == 0 .and. transfer(back, 1_int64) == transfer(number, 1_int64)) exit
      end do
      text = plain_exponent(trim(adjustl(buffer)))
   end function real_text

   !> Number with a given count of significant digits, for tables and sentences.
   pure function short_text(number, digits) result(text)
      !> Any finite number
      real(dp), intent(in) :: number
      !> Significant digits, 1 to 17
      integer, intent(in) :: digits
      character(:), allocatable :: text
      character(40) :: buffer
      integer :: decimals

      if (.not. abs(number) > 0.0_dp) then
         text = '0'
      else if (is_plain(number)) then
         decimals = decimals_of(number, digits)
         write (buffer, '(ss, f40.'//integer_text(decimals)//')') number
         text = trim(adjustl(buffer))
         if (decimals == 0) text = text(:len(text) - 1)
      else
         write (buffer, '(ss, es40.'//integer_text(digits - 1)//'e3)') number
         text = plain_exponent(trim(adjustl(buffer)))
      end if
   end function short_text

   !> Decimals that short_text gives a number; negative where its last digit stands before the point.
   pure integer function decimals_of(number, digits)
      !> Any number but 0
      real(dp), intent(in) :: number
      !> Significant digits
      integer, intent(in) :: digits

      decimals_of = digits - 1 - floor(log10(abs(number)))
      if (is_plain(number)) decimals_of = max(0, decimals_of)
   end function decimals_of

   !> The error of a number that short_text shows with so many digits: never below half a unit of the last of these digits.
   pure function error_text(error, number, digits) result(text)
      !> Bound of the error, not negative
      real(dp), intent(in) :: error
      !> The number; of a relative error 1
      real(dp), intent(in) :: number
      !> Significant digits of the number as it is reported, 1 to 17
      integer, intent(in) :: digits
      character(:), allocatable :: text
      real(dp) :: rounding

      rounding = 0.0_dp
      if (abs(number) > 0.0_dp) rounding = 0.5_dp*10.0_dp**(-decimals_of(number, digits))
      text = short_text(stated_error(error, rounding), error_digits)
   end function error_text

   !> An error with two digits: the bound rounded up, and not below the rounding of the number that it belongs to.
   elemental real(dp) function stated_error(error, rounding)
      !> Bound of the error, not negative
      real(dp), intent(in) :: error
      !> Largest rounding of the number, in the same unit
      real(dp), intent(in) :: rounding
      real(dp) :: bound, unit
      character(16) :: text
      integer :: exponent, stat

      bound = max(error, rounding)
      stated_error = bound
      ! What is hardly a number at all has no two digits.
      if (.not. (bound > 1000.0_dp*tiny(1.0_dp) .and. bound < huge(1.0_dp)/1000.0_dp)) return
      exponent = floor(log10(bound)) - error_digits + 1
      unit = 10.0_dp**exponent
      text = integer_text(ceiling(bound/unit - rounding_share))//'E'//integer_text(exponent)
      read (text, *, iostat=stat) stated_error
      if (stat /= 0) stated_error = bound
   end function stated_error

   !> Whether a number is written without an exponent.
   pure logical function is_plain(number)
      real(dp), intent(in) :: number

      is_plain = abs(number) >= 1.0e-3_dp .and. abs(number) < 1.0e6_dp
   end function is_plain

   !> Exponent without its leading zeros: 1.5E-007 becomes 1.5E-7.
   pure function plain_exponent(long) result(text)
      character(*), intent(in) :: long
      character(:), allocatable :: text
      integer :: mark, exponent, stat

      mark = index(long, 'E')
      text = long
      if (mark == 0) return
      read (long(mark + 1:), *, iostat=stat) exponent
      if (stat /= 0) return
      text = long(:mark - 1)
      if (text(len(text):) == '.') text = text//'0'
      text = text//'E'//integer_text(exponent)
   end function plain_exponent

   !> Namelist spelling of a logical.
   pure function logical_text(flag) result(text)
      !> Flag to spell
      logical, intent(in) :: flag
      character(:), allocatable :: text

      text = trim(merge('.true. ', '.false.', flag))
   end function logical_text

   !> ASCII lower case.
   pure function lower(mixed) result(text)
      character(*), intent(in) :: mixed
      character(len(mixed)) :: text
      integer :: i

      text = mixed
      do i = 1, len(mixed)
         if (mixed(i:i) >= 'A' .and. mixed(i:i) <= 'Z') text(i:i) = achar(iachar(mixed(i:i)) + 32)
      end do
   end function lower

   !> A name as words: blanks for underscores.
   pure function spaced(name) result(words)
      character(*), intent(in) :: name
      character(:), allocatable :: words
      integer :: i

      words = name
      do i = 1, len(name)
         if (name(i:i) == '_') words(i:i) = ' '
      end do
   end function spaced

   !> Text in namelist quotes, quotes inside doubled.
   pure function quoted(plain) result(text)
      character(*), intent(in) :: plain
      character(:), allocatable :: text
      integer :: i

      text = "'"
      do i = 1, len(plain)
         text = text//plain(i:i)
         if (plain(i:i) == "'") text = text//"'"
      end do
      text = text//"'"
   end function quoted

   !> Words of a list, each in namelist quotes, commas between.
   pure function quoted_words(words, separator) result(text)
      character(*), intent(in) :: words
      !> What stands between its words
      character(1), intent(in) :: separator
      character(:), allocatable :: text
      integer :: i, start

      text = ''
      start = 1
      do i = 1, len(words) + 1
         if (i <= len(words)) then
            if (words(i:i) /= separator) cycle
         end if
         if (start > 1) text = text//', '
         text = text//quoted(words(start:i - 1))
         start = i + 1
      end do
   end function quoted_words

   !> Letters, digits and underscore make up keys and group names.
   elemental logical function is_word_character(letter)
      !> One character
      character(1), intent(in) :: letter

      is_word_character = (letter >= 'a' .and. letter <= 'z') .or. (letter >= 'A' .and. letter <= 'Z') .or. &
                          (letter >= '0' .and. letter <= '9') .or. letter == '_'
   end function is_word_character

   !> Levenshtein distance, for the nearest known key to a misspelt one.
   pure integer function edit_distance(left, right)
      !> Misspelt word
      character(*), intent(in) :: left
      !> Known word
      character(*), intent(in) :: right
      integer :: row(0:len(right)), diagonal, above, i, j

      row = [(j, j=0, len(right))]
      do i = 1, len(left)
         diagonal = row(0)
         row(0) = i
         do j = 1, len(right)
            above = row(j)
            row(j) = min(above + 1, row(j - 1) + 1, diagonal + merge(0, 1, left(i:i) == right(j:j)))
            diagonal = above
         end do
      end do
      edit_distance = row(len(right))
   end function edit_distance

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

end module text
