!> One key of the input: its name, its kind of value, and what it allows. The keys themselves stand in the
!> key table.
module input_key
   use kinds, only: dp
   use text, only: real_text
   use word_list, only: split_words, word_t
   implicit none(type, external)
   private

   integer, parameter, public :: real_kind = 1, integer_kind = 2, logical_kind = 3, text_kind = 4, list_kind = 5, &
                                 reals_kind = 6, table_kind = 7

   !> Allowed numbers; an open bound itself is not allowed.
   type, public :: range_t
      real(dp) :: lower = -huge(1.0_dp)
      logical :: lower_open = .true.
      real(dp) :: upper = huge(1.0_dp)
      logical :: upper_open = .true.
   end type range_t

   !> One key.
   type, public :: key_t
      !> Namelist group
      character(12) :: group
      !> Name in the group
      character(24) :: name
      !> Type of its value
      integer :: kind
      !> SI unit, '-' for a pure number, empty where it does not apply
      character(8) :: unit
      !> 'required', a value, or empty: optional, its absence means what the sentence says
      character(512) :: default
      !> Allowed numbers
      type(range_t) :: range
      !> Allowed words, separated by blanks; empty: any text that the reader accepts
      character(3400) :: choices
      !> Rules with ' & ' between, all of which must hold; empty: always legal. 'group.key=word[|word]': it has one of these words;
      !> 'group.key[|group.key]': one of these is given; 'without group.key': it is not.
      character(128) :: used_when
      !> What it means
      character(240) :: sentence
      !> Value in the template where there is no default
      character(24) :: example = ''
      !> Least and largest number that an engineer may mean, wide; others are taken, with a warning
      real(dp) :: sensible(2) = [-huge(1.0_dp), huge(1.0_dp)]
      !> Least and largest number that a film and its motion can be computed with, wider still; others are refused
      real(dp) :: computable(2) = [-huge(1.0_dp), huge(1.0_dp)]
      !> Group that gives this key where it stands; empty: none does
      character(8) :: given_by = ''
      !> Default where &gear stands, if it is another
      character(24) :: with_gear = ''
      !> What an element of a list means that is left unset between others; empty: each must be set
      character(8) :: unset = ''
   end type key_t

   !> Longest name of a scene, and longest text of any key.
   integer, parameter, public :: name_limit = 64, path_limit = 512

   public :: in_range, is_list, allowed_text, is_sensible, sensible_text, is_computable, not_computable_text

contains

   !> Whether a number is allowed for a key.
   pure logical function in_range(key, number)
      !> Key with a range
      type(key_t), intent(in) :: key
      !> Finite number
      real(dp), intent(in) :: number

      in_range = merge(number > key%range%lower, number >= key%range%lower, key%range%lower_open) .and. &
                 merge(number < key%range%upper, number <= key%range%upper, key%range%upper_open)
   end function in_range

   !> Whether an engineer may mean this number. Zero, where it is allowed, is none of what it counts, in any unit.
   pure logical function is_sensible(key, number)
      type(key_t), intent(in) :: key
      !> Finite number
      real(dp), intent(in) :: number

      is_sensible = (number >= key%sensible(1) .and. number <= key%sensible(2)) .or. .not. abs(number) > 0.0_dp
   end function is_sensible

   !> Whether a film and its motion can be computed with this number.
   pure logical function is_computable(key, number)
      type(key_t), intent(in) :: key
      !> Finite number
      real(dp), intent(in) :: number

      is_computable = number >= key%computable(1) .and. number <= key%computable(2)
   end function is_computable

   !> Why a number is refused that a key allows.
   pure function not_computable_text(key, number) result(words)
      !> Key with bounds of what can be computed with
      type(key_t), intent(in) :: key
      !> Finite number beyond them
      real(dp), intent(in) :: number
      character(:), allocatable :: words

      words = real_text(number)//' '//trim(key%unit)//' gives numbers too large or too small to compute with; '// &
              'possible: '//real_text(key%computable(1))//' to '//real_text(key%computable(2))//' '//trim(key%unit)
      if (key%unit == '-') words = words(:len(words) - 2)
   end function not_computable_text

   !> Sensible numbers in words, empty where any number is.
   pure function sensible_text(key) result(words)
      type(key_t), intent(in) :: key
      character(:), allocatable :: words

      words = ''
      if (key%sensible(2) < huge(1.0_dp)) &
         words = real_text(key%sensible(1))//' to '//real_text(key%sensible(2))//' '//trim(key%unit)
   end function sensible_text

   !> Whether a key holds several values.
   pure logical function is_list(key)
      type(key_t), intent(in) :: key

      is_list = any(key%kind == [list_kind, reals_kind, table_kind])
   end function is_list

   !> Allowed values in words.
   pure function allowed_text(key) result(allowed)
      type(key_t), intent(in) :: key
      character(:), allocatable :: allowed
      logical :: bounded_below, bounded_above

      select case (key%kind)
      case (logical_kind)
         allowed = '.true. or .false.'
      case (text_kind, list_kind)
         allowed = choices_text(key)
      case default
         ! One rule for a number and for each number of a list.
         bounded_below = key%range%lower > -huge(1.0_dp)
         bounded_above = key%range%upper < huge(1.0_dp)
         allowed = trim(merge('an integer', 'a number  ', key%kind == integer_kind))
         if (is_list(key)) allowed = 'numbers'
         if (bounded_below) allowed = allowed//trim(merge(' >  ', ' >= ', key%range%lower_open))// &
                                      ' '//bound_text(key%range%lower, key%kind)
         if (bounded_below .and. bounded_above) allowed = allowed//' and'
         if (bounded_above) allowed = allowed//trim(merge(' <  ', ' <= ', key%range%upper_open))// &
                                      ' '//bound_text(key%range%upper, key%kind)
      end select
   end function allowed_text

   pure function bound_text(bound, kind) result(words)
      real(dp), intent(in) :: bound
      integer, intent(in) :: kind
      character(:), allocatable :: words

      words = real_text(bound)
      if (kind == integer_kind .and. index(words, '.0') == len(words) - 1) words = words(:len(words) - 2)
   end function bound_text

   pure function choices_text(key) result(words)
      type(key_t), intent(in) :: key
      character(:), allocatable :: words
      type(word_t), allocatable :: choices(:)
      integer :: i

      if (len_trim(key%choices) == 0) then
         words = 'a text in quotes'
         return
      end if
      words = trim(merge('any of', 'one of', key%kind == list_kind))
      allocate (choices, source=split_words(trim(key%choices)))
      do i = 1, size(choices)
         words = words//" '"//choices(i)%text//"'"
      end do
   end function choices_text

end module input_key
