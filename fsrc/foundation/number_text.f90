!> Strict reading of numbers: digits, one point, one exponent, nothing else; finite.
module number_text
   use kinds, only: dp, int64
   implicit none(type, external)
   private

   !> Up to so many digits an integer is an exact real, and so are the powers of ten up to 22: one
   !> multiplication or division then rounds as the decimal number itself would be rounded.
   integer, parameter :: exact_digits = 15, exact_power = 22
   integer :: power
   real(dp), parameter :: powers_of_ten(0:exact_power) = [(10.0_dp**power, power=0, exact_power)]
   !> No exponent of a number in range has more digits
   integer, parameter :: exponent_digits = 8

   public :: read_strict_real, read_strict_integer

contains

   !> Decimal number. One that is too large, or so small that it would lose digits, is not read.
   pure subroutine read_strict_real(word, number, sound)
      !> The number alone, without blanks
      character(*), intent(in) :: word
      !> Its value, 0 if it is not sound
      real(dp), intent(out) :: number
      !> Whether it is a number in range
      logical, intent(out) :: sound
      integer(int64) :: digits
      integer :: at, kept, leading, decimals, exponent, stat
      logical :: any_digit, point, negative

      number = 0.0_dp
      sound = .false.
      digits = 0_int64
      kept = 0
      leading = 0
      decimals = 0
      any_digit = .false.
      point = .false.
      negative = .false.
      do at = 1, len(word)
         select case (word(at:at))
         case ('0':'9')
            any_digit = .true.
            if (point) decimals = decimals + 1
            if (kept > 0 .or. word(at:at) /= '0') kept = kept + 1
            if (kept > 0 .and. .not. point) leading = leading + 1
            if (kept == 0 .and. point) leading = leading - 1
            if (kept > 0 .and. kept <= exact_digits) digits = 10_int64*digits + int(iachar(word(at:at)) - 48, int64)
         case ('.')
            if (point) return
            point = .true.
         case ('+', '-')
            if (at > 1) return
            negative = word(at:at) == '-'
         case ('e', 'E', 'd', 'D')
            exit
         case default
            return
         end select
      end do
      if (.not. any_digit) return
      exponent = 0
      if (at <= len(word)) call read_exponent(word(at + 1:), exponent, sound)
      if (at <= len(word) .and. .not. sound) return
      if (kept == 0) then
         sound = .true.
         return
      end if
      ! The runtime would overflow while it reads, which stops a program that traps overflow.
      sound = exponent + leading - 1 < range(number) .and. exponent + leading - 1 > -range(number)
      if (.not. sound) return
      if (kept <= exact_digits .and. abs(exponent - decimals) <= exact_power) then
         number = real(digits, dp)
         if (exponent >= decimals) number = number*powers_of_ten(exponent - decimals)
         if (exponent < decimals) number = number/powers_of_ten(decimals - exponent)
         if (negative) number = -number
      else
         read (word, *, iostat=stat) number
         sound = stat == 0
      end if
   end subroutine read_strict_real

   !> Exponent of a number: optional sign and digits.
   pure subroutine read_exponent(word, exponent, sound)
      character(*), intent(in) :: word
      integer, intent(out) :: exponent
      logical, intent(out) :: sound
      integer :: start, first

      exponent = 0
      start = first_digit(word)
      sound = start > 0
      if (.not. sound) return
      first = verify(word(start:), '0')
      if (first == 0) return
      first = start + first - 1
      sound = len(word) - first < exponent_digits
      if (.not. sound) return
      do start = first, len(word)
         exponent = 10*exponent + iachar(word(start:start)) - 48
      end do
      if (word(1:1) == '-') exponent = -exponent
   end subroutine read_exponent

   !> Decimal integer: optional sign and digits.
   pure subroutine read_strict_integer(word, number, sound)
      !> The number alone, without blanks
      character(*), intent(in) :: word
      !> Its value, 0 if it is not sound
      integer, intent(out) :: number
      !> Whether it is an integer in range
      logical, intent(out) :: sound
      integer :: stat

      number = 0
      sound = first_digit(word) > 0
      if (.not. sound) return
      read (word, *, iostat=stat) number
      sound = stat == 0
      if (.not. sound) number = 0
   end subroutine read_strict_integer

   !> Place of the first of the digits that make up a word, behind an optional sign; 0 if it is anything else.
   pure integer function first_digit(word)
      character(*), intent(in) :: word

      first_digit = 1
      if (len(word) > 0) first_digit = merge(2, 1, scan(word(1:1), '+-') > 0)
      if (len(word) < first_digit) then
         first_digit = 0
      else if (verify(word(first_digit:), '0123456789') > 0) then
         first_digit = 0
      end if
   end function first_digit

end module number_text
