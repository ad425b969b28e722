!> What the head of a column says: its name and its unit, which stands in brackets, behind a stroke, at the end of the name, or in a row
!> of units below; and whether the column is an axis of time or angle.
module column_head
   use kinds, only: dp
   use text, only: lower
   use unit_text, only: convert_unit, is_of_kind, plain_letters, unit_of_text, unit_t
   use word_list, only: split_words, word_t
   implicit none(type, external)
   private

   !> What runs along an axis.
   integer, parameter, public :: no_axis = 0, time_axis = 1, angle_axis = 2

   !> A head of a column.
   type, public :: column_head_t
      !> Its name without a unit
      character(:), allocatable :: name
      !> Its unit as it is reported; empty: it says none
      character(:), allocatable :: word
      !> Of no known kind, though it is called one
      logical :: is_strange = .false.
      type(unit_t) :: unit
   end type column_head_t

   !> An axis as its head shows it.
   type, public :: axis_unit_t
      !> One of the above
      integer :: kind = no_axis
      !> As it is reported; empty if the head says none
      character(16) :: word = ''
      !> One of it in seconds or degrees
      real(dp) :: size = 1.0_dp
      !> Whether brackets, or a row of units, hold what is no unit of time or angle
      logical :: is_strange = .false.
   end type axis_unit_t

   character(*), parameter :: time_words(*) = [character(10) :: 't', 'time', 'zeit'], &
      angle_words(*) = [character(10) :: 'angle', 'phase', 'crank', 'theta', 'winkel', 'crankangle'], &
      parts = ' _', letters = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ'
   !> Units that are also usual endings of names, as in force_min; so are single letters, as in load_A, V apart, and digits
   character(*), parameter :: usual_endings(*) = [character(4) :: 'min', 'rad', 'rev', 'revs', 'turn', 'deg', 'sec', 'secs', &
                                                  'sek', 'lb', 'lbs', 'bar', 'cad', 'upm']

   !> What factors between units are off by rounding
   real(dp), parameter :: rounding = 8.0_dp*epsilon(1.0_dp)

   public :: head_of, axis_of, conversion

contains

   !> What a head says where a unit of some kind is needed.
   pure function head_of(text, row, needed) result(head)
      !> As it stands in the first line
      character(*), intent(in) :: text
      !> What stands below it in a row of units; empty: nothing
      character(*), intent(in) :: row
      !> A unit of the kind that is needed; an ending of a name that may be something else is taken as a unit only if it is of this kind
      character(*), intent(in) :: needed
      type(column_head_t) :: head
      character(:), allocatable :: plain
      type(unit_t) :: below
      real(dp) :: factor, added
      integer :: at, width

      plain = trim(adjustl(plain_letters(text)))
      head%name = plain
      head%word = ''
      call take_brackets('[', ']', .false.)
      ! Round brackets hold anything, also brackets.
      if (len(head%word) == 0) call take_brackets('(', ')', .false.)
      if (len(head%word) == 0) call take_brackets('(', ')', .true.)
      at = index(plain, ' / ')
      width = 3
      if (at == 0) at = index(plain, ' in ')
      if (at > 0 .and. index(plain, ' in ') == at) width = 4
      if (len(head%word) == 0 .and. at > 0) then
         head%unit = unit_of_text(plain(at + width:))
         if (head%unit%is_known) call take(plain(at + width:), at - 1)
      end if
      if (len(head%word) == 0) call take_ending()
      if (len_trim(row) == 0) return
      below = unit_of_text(row)
      ! Both must agree; a row says more than an ending.
      if (len(head%word) > 0 .and. head%unit%is_known .and. below%is_known) then
         call convert_unit(below, head%unit, factor, added)
         if (is_of_kind(below, head%unit) .and. abs(factor - 1.0_dp) < rounding .and. .not. abs(added) > 0.0_dp) return
         head%is_strange = .true.
         head%word = head%word//' and '//trim(below%word)
         return
      end if
      head%unit = below
      call take(row, len(head%name))

   contains

      !> Take a unit that stands in brackets: the first or last that open, and the last that close.
      pure subroutine take_brackets(opening, closing, is_last)
         character(1), intent(in) :: opening
         character(1), intent(in) :: closing
         logical, intent(in) :: is_last
         integer :: first, last

         first = index(plain, opening, back=is_last)
         last = index(plain, closing, back=.true.)
         if (first == 0 .or. last < first) return
         head%unit = unit_of_text(plain(first + 1:last - 1))
         if (head%unit%is_known .or. opening == '[') call take(plain(first + 1:last - 1), first - 1)
      end subroutine take_brackets

      !> Take a unit, and the name up to it.
      pure subroutine take(word, name_length)
         character(*), intent(in) :: word
         integer, intent(in) :: name_length

         head%word = trim(adjustl(word))
         if (head%unit%is_known) head%word = trim(head%unit%word)
         head%is_strange = .not. head%unit%is_known
         head%name = trim(head%name(:name_length))
      end subroutine take

      !> Take the longest ending that is a unit, if there is one: rad_s2 is rad/s2, N_m is N m.
      pure subroutine take_ending()
         character(*), parameter :: joints(*) = [' ', '/']
         character(:), allocatable :: ending
         type(unit_t) :: unit
         integer :: start, k, i

         start = 1
         do
            do k = 1, size(joints)
               ending = plain(start:)
               do i = 1, len(ending)
                  if (ending(i:i) == '_') ending(i:i) = joints(k)
               end do
               if (verify(ending(1:1), letters//'1%') > 0 .or. scan(ending, letters//'%') == 0) exit
               unit = unit_of_text(ending)
               if (.not. unit%is_known) cycle
               if (.not. is_of_kind(unit, unit_of_text(needed))) then
                  if (scan(plain(start:), parts) > 0 .or. is_usual_ending(plain(start:))) cycle
               end if
               head%unit = unit
               call take(ending, start - 2)
               return
            end do
            if (scan(plain(start:), parts) == 0) return
            start = start + scan(plain(start:), parts)
            if (start > len(plain)) return
         end do
      end subroutine take_ending

   end function head_of

   !> Whether an ending of a name is usually none of its unit.
   pure logical function is_usual_ending(word)
      character(*), intent(in) :: word

      is_usual_ending = (len(word) == 1 .and. word /= 'V') .or. any(usual_endings == lower(word)) .or. len(word) > 4 .or. &
                        scan(word, '123456789') > 0
      is_usual_ending = is_usual_ending .and. index(word, '/') == 0
   end function is_usual_ending

   !> The axis that a head reports; none if it names something else.
   pure function axis_of(text, row) result(axis)
      !> As it stands in the first line
      character(*), intent(in) :: text
      !> What stands below it in a row of units; empty: nothing
      character(*), intent(in) :: row
      type(axis_unit_t) :: axis
      type(column_head_t) :: head
      type(unit_t) :: below
      character(*), parameter :: needed(*) = [character(3) :: 's', 'deg']
      real(dp) :: added
      integer :: kind

      below = unit_of_text(row)
      if (len_trim(row) == 0) below%is_known = .false.
      axis%kind = kind_of_words(split_words(words_of(text)))
      do kind = time_axis, angle_axis
         ! A name, or what stands below it, may also be nothing but a unit; a column 'min' is rather one of minima.
         if (axis%kind /= no_axis .or. lower(trim(text)) == 'min') exit
         if (is_alike(unit_of_text(text), needed(kind)) .or. is_alike(below, needed(kind))) axis%kind = kind
      end do
      if (axis%kind == no_axis) return
      head = head_of(text, row, needed(axis%kind))
      axis%is_strange = len(head%word) == 0 .and. scan(text, '[(') > 0
      if (len(head%word) == 0) return
      axis%is_strange = head%is_strange .or. .not. is_alike(head%unit, needed(axis%kind))
      if (axis%is_strange) return
      axis%word = head%unit%word
      call convert_unit(head%unit, unit_of_text(needed(axis%kind)), axis%size, added)

   contains

      !> Whether a unit is of the kind of another.
      pure logical function is_alike(unit, other)
         type(unit_t), intent(in) :: unit
         character(*), intent(in) :: other

         is_alike = is_of_kind(unit, unit_of_text(other))
      end function is_alike

   end function axis_of

   !> What the words of a name say about an axis: its first one, or 'time' or 'angle' anywhere.
   pure integer function kind_of_words(words) result(kind)
      type(word_t), intent(in) :: words(:)
      integer :: i

      kind = no_axis
      do i = 1, size(words)
         if (kind == no_axis .and. (i == 1 .or. words(i)%text == 'time')) then
            if (any(time_words == words(i)%text)) kind = time_axis
         end if
         if (kind == no_axis .and. (i == 1 .or. words(i)%text == 'angle')) then
            if (any(angle_words == words(i)%text)) kind = angle_axis
         end if
      end do
   end function kind_of_words

   !> The words of a name in lower case, blanks between them.
   pure function words_of(text) result(words)
      character(*), intent(in) :: text
      character(:), allocatable :: words
      character(*), parameter :: separators = '[]()_/,;.-:"'//achar(9)//achar(39)
      integer :: i

      words = lower(plain_letters(text))
      do i = 1, len(words)
         if (scan(words(i:i), separators) > 0) words(i:i) = ' '
      end do
   end function words_of

   !> What makes the numbers of a column such of the unit that is needed, or why nothing does.
   pure subroutine conversion(head, needed, factor, added, message)
      type(column_head_t), intent(in) :: head
      !> The unit that is needed
      character(*), intent(in) :: needed
      !> The numbers are multiplied by this, then something is added; 1 and 0 where the head says no unit
      real(dp), intent(out) :: factor
      real(dp), intent(out) :: added
      !> Why they cannot be converted, as the end of a sentence; empty if they can
      character(:), allocatable, intent(out) :: message

      factor = 1.0_dp
      added = 0.0_dp
      message = ''
      if (len(head%word) == 0) return
      if (head%is_strange) then
         message = 'its unit is not known; '//needed//' is needed'
      else if (.not. is_of_kind(head%unit, unit_of_text(needed))) then
         message = 'it is in '//head%word//'; '//needed//' is needed'
      else
         call convert_unit(head%unit, unit_of_text(needed), factor, added)
         ! The same unit leaves every bit as it is.
         if (abs(factor - 1.0_dp) < rounding) factor = 1.0_dp
      end if
   end subroutine conversion

end module column_head
