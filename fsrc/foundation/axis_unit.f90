!> What the name of a column says about an axis: whether it is one of time or angle, and in which unit.
module axis_unit
   use constants, only: pi
   use kinds, only: dp
   use text, only: lower
   use word_list, only: split_words, word_t
   implicit none(type, external)
   private

   !> What runs along an axis.
   integer, parameter, public :: no_axis = 0, time_axis = 1, angle_axis = 2

   !> An axis as its name tells it.
   type, public :: axis_unit_t
      !> One of the above
      integer :: kind = no_axis
      !> As it is reported; empty if the name says none
      character(6) :: word = ''
      !> One of it in seconds or degrees
      real(dp) :: size = 1.0_dp
      !> Whether brackets hold what is no unit of time or angle
      logical :: is_strange = .false.
   end type axis_unit_t

   character(*), parameter :: time_words(*) = [character(10) :: 't', 'time', 'zeit'], &
      angle_words(*) = [character(10) :: 'angle', 'phase', 'crank', 'theta', 'winkel', 'crankangle']
   type(axis_unit_t), parameter, public :: degrees = axis_unit_t(angle_axis, 'deg', 1.0_dp), &
                                           radians = axis_unit_t(angle_axis, 'rad', 180.0_dp/pi), &
                                           seconds = axis_unit_t(time_axis, 's', 1.0_dp), &
                                           milliseconds = axis_unit_t(time_axis, 'ms', 1.0e-3_dp), &
                                           microseconds = axis_unit_t(time_axis, 'us', 1.0e-6_dp)
   type(axis_unit_t), parameter :: minutes = axis_unit_t(time_axis, 'min', 60.0_dp), &
                                   revolutions = axis_unit_t(angle_axis, 'rev', 360.0_dp)

   public :: unit_of_name

contains

   !> The axis that a name tells of; none if it names something else.
   pure function unit_of_name(name) result(unit)
      !> As it stands in the header
      character(*), intent(in) :: name
      type(axis_unit_t) :: unit
      type(word_t), allocatable :: words(:)
      integer :: kind, i

      allocate (words, source=split_words(plain_words(name)))
      if (size(words) == 0) return
      kind = no_axis
      do i = 1, size(words)
         if (kind == no_axis .and. (i == 1 .or. words(i)%text == 'time')) then
            if (any(time_words == words(i)%text)) kind = time_axis
         end if
         if (kind == no_axis .and. (i == 1 .or. words(i)%text == 'angle')) then
            if (any(angle_words == words(i)%text)) kind = angle_axis
         end if
      end do
      ! A name may also be nothing but a unit.
      if (kind == no_axis .and. size(words) > 1) return
      do i = 1, size(words)
         unit = known_unit(words(i)%text)
         ! A column 'min' is rather one of minima.
         if (unit%kind /= no_axis .and. (kind /= no_axis .or. unit%word /= minutes%word)) return
      end do
      unit = axis_unit_t(kind)
      unit%is_strange = kind /= no_axis .and. scan(name, '[(') > 0
   end function unit_of_name

   !> The unit that a word means.
   pure type(axis_unit_t) function known_unit(word) result(unit)
      character(*), intent(in) :: word

      select case (word)
      case ('s', 'sec', 'secs', 'second', 'seconds', 'sek')
         unit = seconds
      case ('ms', 'msec', 'millisecond', 'milliseconds')
         unit = milliseconds
      case ('us', 'usec', 'microsecond', 'microseconds')
         unit = microseconds
      case ('min', 'minute', 'minutes')
         unit = minutes
      case ('deg', 'degree', 'degrees', 'degca', 'cad', 'dega')
         unit = degrees
      case ('rad', 'radian', 'radians')
         unit = radians
      case ('rev', 'revs', 'revolution', 'revolutions', 'turn', 'turns')
         unit = revolutions
      case default
         unit = axis_unit_t()
      end select
   end function known_unit

   !> The words of a name in lower case, blanks between them; the signs of degrees and millionths become letters.
   pure function plain_words(name) result(words)
      character(*), intent(in) :: name
      character(:), allocatable :: words
      !> Bytes of the signs: a degree is 176 in Latin letters and 194 176 in UTF-8, micro 181, 194 181, or as a Greek mu 206 188
      integer, parameter :: degree = 176, micro = 181, greek = 206, mu = 188, latin = 194
      integer :: i, code
      character(*), parameter :: parts = ' []()_/,;.-:"'//achar(9)//achar(39)

      words = ''
      do i = 1, len(name)
         code = iachar(name(i:i))
         if (code == degree) then
            words = words//' deg '
         else if (code == micro .or. code == mu) then
            words = words//'u'
         else if (scan(name(i:i), parts) > 0) then
            words = words//' '
         else if (code /= latin .and. code /= greek) then
            words = words//lower(name(i:i))
         end if
      end do
      words = trim(adjustl(words))
   end function plain_words

end module axis_unit
