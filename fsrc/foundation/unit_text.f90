!> Units as people write them: products, quotients and powers of those that engineers use, with prefixes.
module unit_text
   use constants, only: pi
   use kinds, only: dp
   use text, only: lower
   implicit none(type, external)
   private

   !> Powers of a unit: of m, kg, s, K, V, A, and of the plane angle
   integer, parameter :: base_count = 7, of_time = 3, of_angle = 7

   !> What a text means.
   type, public :: unit_t
      !> Whether it is a unit
      logical :: is_known = .false.
      !> As it is reported
      character(16) :: word = ''
      !> One of it in m, kg, s, K, V, A, rad; and what is added behind, for degrees of temperature
      real(dp) :: size = 1.0_dp
      real(dp) :: zero = 0.0_dp
      integer :: powers(base_count) = 0
   end type unit_t

   !> A unit with a name of its own, and the prefixes that are in use with it.
   type :: symbol_t
      character(5) :: word
      real(dp) :: size
      integer :: powers(base_count)
      character(8) :: prefixes = ''
      real(dp) :: zero = 0.0_dp
   end type symbol_t

   real(dp), parameter :: pound = 0.45359237_dp, fall = 9.80665_dp, ice = 273.15_dp, rankine = 5.0_dp/9.0_dp
   type(symbol_t), parameter :: symbols(*) = [ &
      symbol_t('m', 1.0_dp, [1, 0, 0, 0, 0, 0, 0], 'kcdmun'), &
      symbol_t('g', 1.0e-3_dp, [0, 1, 0, 0, 0, 0, 0], 'kmu'), &
      symbol_t('s', 1.0_dp, [0, 0, 1, 0, 0, 0, 0], 'mun'), &
      symbol_t('min', 60.0_dp, [0, 0, 1, 0, 0, 0, 0]), &
      symbol_t('h', 3600.0_dp, [0, 0, 1, 0, 0, 0, 0]), &
      symbol_t('K', 1.0_dp, [0, 0, 0, 1, 0, 0, 0], 'm'), &
      symbol_t('degC', 1.0_dp, [0, 0, 0, 1, 0, 0, 0], zero=ice), &
      symbol_t('degF', rankine, [0, 0, 0, 1, 0, 0, 0], zero=ice - 32.0_dp*rankine), &
      symbol_t('V', 1.0_dp, [0, 0, 0, 0, 1, 0, 0], 'kmu'), &
      symbol_t('A', 1.0_dp, [0, 0, 0, 0, 0, 1, 0], 'kmu'), &
      symbol_t('rad', 1.0_dp, [0, 0, 0, 0, 0, 0, 1], 'kmu'), &
      symbol_t('deg', pi/180.0_dp, [0, 0, 0, 0, 0, 0, 1], 'm'), &
      symbol_t('rev', 2.0_dp*pi, [0, 0, 0, 0, 0, 0, 1]), &
      symbol_t('rpm', pi/30.0_dp, [0, 0, -1, 0, 0, 0, 1], 'k'), &
      symbol_t('Hz', 1.0_dp, [0, 0, -1, 0, 0, 0, 0], 'kMG'), &
      symbol_t('N', 1.0_dp, [1, 1, -2, 0, 0, 0, 0], 'kMGmu'), &
      symbol_t('daN', 10.0_dp, [1, 1, -2, 0, 0, 0, 0]), &
      symbol_t('lbf', pound*fall, [1, 1, -2, 0, 0, 0, 0]), &
      symbol_t('kgf', fall, [1, 1, -2, 0, 0, 0, 0]), &
      symbol_t('lb', pound, [0, 1, 0, 0, 0, 0, 0]), &
      symbol_t('Pa', 1.0_dp, [-1, 1, -2, 0, 0, 0, 0], 'kMGmu'), &
      symbol_t('bar', 1.0e5_dp, [-1, 1, -2, 0, 0, 0, 0], 'km'), &
      symbol_t('J', 1.0_dp, [2, 1, -2, 0, 0, 0, 0], 'kMm'), &
      symbol_t('W', 1.0_dp, [2, 1, -3, 0, 0, 0, 0], 'kMm'), &
      symbol_t('P', 0.1_dp, [-1, 1, -1, 0, 0, 0, 0], 'c'), &
      symbol_t('St', 1.0e-4_dp, [2, 0, -1, 0, 0, 0, 0], 'c'), &
      symbol_t('l', 1.0e-3_dp, [3, 0, 0, 0, 0, 0, 0], 'm'), &
      symbol_t('L', 1.0e-3_dp, [3, 0, 0, 0, 0, 0, 0], 'm'), &
      symbol_t('%', 1.0e-2_dp, [0, 0, 0, 0, 0, 0, 0]), &
      symbol_t('-', 1.0_dp, [0, 0, 0, 0, 0, 0, 0]), &
      symbol_t('1', 1.0_dp, [0, 0, 0, 0, 0, 0, 0])]
   character(*), parameter :: prefix_letters = 'GMkcdmun'
   real(dp), parameter :: prefix_sizes(*) = [1.0e9_dp, 1.0e6_dp, 1.0e3_dp, 1.0e-2_dp, 1.0e-1_dp, 1.0e-3_dp, 1.0e-6_dp, 1.0e-9_dp]

   public :: unit_of_text, is_of_kind, convert_unit, plain_letters

contains

   !> The unit that a text means.
   pure function unit_of_text(text) result(unit)
      !> As it stands, blanks around it allowed
      character(*), intent(in) :: text
      type(unit_t) :: unit
      type(unit_t) :: factor
      character(:), allocatable :: rest
      integer :: at, behind, sign
      logical :: is_grouped

      rest = usual_spelling(trim(adjustl(plain_letters(text))))
      sign = 1
      is_grouped = .false.
      unit%is_known = verify(rest, ' */().') > 0
      at = 1
      do while (at <= len(rest))
         select case (rest(at:at))
         case (' ', '*', '.')
         case ('/')
            sign = -1
         case ('(')
            is_grouped = .true.
         case (')')
            is_grouped = .false.
            sign = 1
         case default
            behind = at + scan(rest(at:)//' ', ' */().') - 1
            factor = unit_of_factor(rest(at:behind - 1))
            unit%is_known = unit%is_known .and. factor%is_known
            unit%size = unit%size*factor%size**sign
            unit%powers = unit%powers + sign*factor%powers
            unit%zero = factor%zero
            if (.not. is_grouped) sign = 1
            at = behind - 1
         end select
         at = at + 1
      end do
      ! Degrees of temperature in a quotient are differences.
      if (scan(rest, ' */') > 0) unit%zero = 0.0_dp
      if (unit%is_known) unit%word = rest
   end function unit_of_text

   !> The unit of one factor, such as mm2 or s^-2.
   pure function unit_of_factor(word) result(unit)
      character(*), intent(in) :: word
      type(unit_t) :: unit
      type(symbol_t) :: symbol
      integer :: letters, power, i, prefix

      letters = verify(word, '0123456789^+-', back=.true.)
      power = 1
      if (letters > 0 .and. letters < len(word)) power = power_of(word(letters + 1:))
      if (letters == 0) letters = len(word)
      if (power == 0) return
      do i = 1, size(symbols)
         symbol = symbols(i)
         prefix = 0
         if (word(:letters) /= symbol%word) then
            if (letters < 2) cycle
            if (word(2:letters) /= symbol%word .or. index(trim(symbol%prefixes), word(1:1)) == 0) cycle
            prefix = index(prefix_letters, word(1:1))
         end if
         unit = unit_t(.true., '', symbol%size**power, symbol%zero, power*symbol%powers)
         if (prefix > 0) unit%size = (prefix_sizes(prefix)*symbol%size)**power
         return
      end do
   end function unit_of_factor

   !> The power that digits behind a unit mean; 0: none.
   pure integer function power_of(digits) result(power)
      character(*), intent(in) :: digits
      integer :: first

      first = 1
      if (digits(1:1) == '^') first = 2
      power = 0
      if (len(digits) < first) return
      if (scan(digits(first:first), '+-') > 0) first = first + 1
      if (len(digits) /= first) return
      power = index('123456', digits(first:first))
      if (index(digits, '-') > 0) power = -power
   end function power_of

   !> Whether two units measure the same: a frequency is one of revolutions, and a speed of rotation one of them in a time.
   pure logical function is_of_kind(unit, needed)
      type(unit_t), intent(in) :: unit
      type(unit_t), intent(in) :: needed
      integer, parameter :: frequency(base_count - 1) = [0, 0, -1, 0, 0, 0]

      is_of_kind = unit%is_known .and. all(unit%powers == needed%powers)
      if (is_of_kind .or. .not. unit%is_known) return
      is_of_kind = all(unit%powers(:of_angle - 1) == frequency) .and. all(needed%powers(:of_angle - 1) == frequency) .and. &
                   abs(unit%powers(of_angle) - needed%powers(of_angle)) == 1
      ! Per second, a speed may be one in radians or in revolutions.
      if (unit%powers(of_angle) == 0 .and. unit%word == '1/s') is_of_kind = .false.
   end function is_of_kind

   !> What makes numbers of one unit such of another of the same kind: they are multiplied, then something is added.
   pure subroutine convert_unit(unit, needed, factor, added)
      type(unit_t), intent(in) :: unit
      type(unit_t), intent(in) :: needed
      real(dp), intent(out) :: factor
      real(dp), intent(out) :: added

      factor = unit%size/needed%size*(2.0_dp*pi)**(needed%powers(of_angle) - unit%powers(of_angle))
      added = (unit%zero - needed%zero)/needed%size
   end subroutine convert_unit

   !> The usual spelling of units that people also write otherwise.
   pure function usual_spelling(text) result(usual)
      !> In plain letters
      character(*), intent(in) :: text
      character(:), allocatable :: usual

      usual = text
      select case (lower(text))
      case ('sec', 'secs', 'second', 'seconds', 'sek')
         usual = 's'
      case ('msec', 'millisecond', 'milliseconds')
         usual = 'ms'
      case ('usec', 'microsecond', 'microseconds')
         usual = 'us'
      case ('minute', 'minutes')
         usual = 'min'
      case ('degree', 'degrees', 'degca', 'cad', 'dega', 'deg ca', 'deg kw', 'degkw', 'deg crank')
         usual = 'deg'
      case ('radian', 'radians')
         usual = 'rad'
      case ('revs', 'revolution', 'revolutions', 'turn', 'turns')
         usual = 'rev'
      case ('rpm', 'u/min', 'r/min', 'rev/min', 'upm', 'revs/min')
         usual = 'rpm'
      case ('min-1', 'min^-1')
         usual = '1/min'
      case ('hz')
         usual = 'Hz'
      case ('khz')
         usual = 'kHz'
      case ('degc', 'deg c', 'celsius')
         usual = 'degC'
      case ('degf', 'deg f', 'fahrenheit')
         usual = 'degF'
      case ('kelvin')
         usual = 'K'
      case ('newton', 'newtons')
         usual = 'N'
      case ('kn')
         usual = 'kN'
      case ('lbs')
         usual = 'lb'
      case ('kp')
         usual = 'kgf'
      case ('cst')
         usual = 'cSt'
      case ('nmm')
         usual = 'N mm'
      case ('ncm')
         usual = 'N cm'
      case ('knm')
         usual = 'kN m'
      case default
         continue
      end select
      select case (text)
      case ('Nm')
         usual = 'N m'
      case ('mNm')
         usual = 'mN m'
      case ('kgm2', 'kgm^2')
         usual = 'kg m2'
      case ('kgcm2', 'kgcm^2')
         usual = 'kg cm2'
      case ('kgmm2', 'kgmm^2')
         usual = 'kg mm2'
      case ('Pas')
         usual = 'Pa s'
      case ('mPas')
         usual = 'mPa s'
      case default
         continue
      end select
      if (index(usual, ' per ') > 0) usual = usual(:index(usual, ' per ') - 1)//'/'//usual(index(usual, ' per ') + 5:)
   end function usual_spelling

   !> A text whose signs of degrees, millionths, products and powers are letters, be they written in Latin letters or in UTF-8.
   pure function plain_letters(text) result(plain)
      character(*), intent(in) :: text
      character(:), allocatable :: plain
      !> Bytes: a degree is 176 in Latin letters and 194 176 in UTF-8, micro 181, 194 181, or as a Greek mu 206 188; a raised minus is
      !> 226 129 187
      integer, parameter :: degree = 176, micro = 181, mu = 188, dot = 183, squared = 178, cubed = 179, raised_one = 185
      character(*), parameter :: raised_minus = char(226)//char(129)//char(187)
      integer :: i

      plain = ''
      i = 1
      do while (i <= len(text))
         if (index(text(i:), raised_minus) == 1) then
            plain = plain//'^-'
            i = i + len(raised_minus)
            cycle
         end if
         select case (iachar(text(i:i)))
         case (degree)
            plain = plain//'deg'
         case (micro, mu)
            plain = plain//'u'
         case (dot)
            plain = plain//'*'
         case (squared)
            plain = plain//'2'
         case (cubed)
            plain = plain//'3'
         case (raised_one)
            plain = plain//'1'
         case (194, 206)
         case (9, 160)
            plain = plain//' '
         case default
            plain = plain//text(i:i)
         end select
         i = i + 1
      end do
   end function plain_letters

end module unit_text
