!> Numbers that the keys allow and no engineer can mean, millimetres typed for metres: a line each, with the place.
module odd_numbers
   use input_entry, only: entry_t
   use input_key, only: is_sensible, real_kind, sensible_text
   use key_table, only: find_key, find_swept_key, keys
   use kinds, only: dp
   use scene_input, only: scene_input_t
   use text, only: integer_text, printable, real_text
   use word_list, only: split_words, word_t
   implicit none(type, external)
   private

   public :: odd_numbers_of_input, odd_numbers_of_list

contains

   !> Odd numbers of all keys that were given, of the ends of a sweep or threshold, and of the ranges and lists of a campaign.
   pure function odd_numbers_of_input(input) result(lines)
      !> Typed values without a fault
      type(scene_input_t), intent(in) :: input
      type(word_t), allocatable :: lines(:)
      character(:), allocatable :: task
      integer :: i

      allocate (lines(0))
      do i = 1, size(keys)
         if (keys(i)%kind == real_kind .and. input%entries(i)%given) &
            call add_odd(input%entries(i), '&'//trim(keys(i)%group)//' '//trim(keys(i)%name), i, input%entries(i)%number, '', lines)
      end do
      task = input%word('scene', 'task')
      if (task == 'sweep' .or. task == 'threshold') call add_ends(input, task, lines)
      if (task == 'campaign' .or. task == 'threshold') call add_campaign(input, lines)
   end function odd_numbers_of_input

   !> Both ends of a sweep, or of the range of a threshold. A name that is no key is told elsewhere.
   pure subroutine add_ends(input, task, lines)
      type(scene_input_t), intent(in) :: input
      !> The task, which is also the group
      character(*), intent(in) :: task
      type(word_t), allocatable, intent(inout) :: lines(:)
      character(*), parameter :: ends(2) = ['first', 'last ']
      character(:), allocatable :: name
      integer :: i, dot, position

      name = input%word(task, 'key')
      dot = index(name, '.')
      if (dot == 0) then
         position = find_swept_key(name)
      else
         position = find_key(name(:dot - 1), name(dot + 1:))
      end if
      if (position < 1 .or. position > size(keys)) return
      do i = 1, size(ends)
         call add_odd(input%entries(find_key(task, trim(ends(i)))), '&'//task//' '//trim(ends(i)), position, &
                      input%number(task, trim(ends(i))), whose(position), lines)
      end do
   end subroutine add_ends

   !> Both ends of the range of every varied key, or its list of values. Names that are no keys are told elsewhere.
   pure subroutine add_campaign(input, lines)
      type(scene_input_t), intent(in) :: input
      type(word_t), allocatable, intent(inout) :: lines(:)
      type(word_t), allocatable :: names(:)
      integer :: i, dot, position

      allocate (names, source=split_words(input%words('campaign', 'vary')))
      do i = 1, size(names)
         dot = index(names(i)%text, '.')
         position = find_key(names(i)%text(:dot - 1), names(i)%text(dot + 1:))
         if (position == 0) cycle
         associate (first => input%entries(find_key('campaign', 'first')), last => input%entries(find_key('campaign', 'last')), &
                    values => input%entries(find_key('campaign', 'values')))
            if (i <= size(values%columns)) then
               if (size(values%columns(i)%numbers) > 0) then
                  lines = [lines, odd_numbers_of_list(place_of(values), '&campaign values(:, '//integer_text(i)//')', position, &
                                                      values%columns(i)%numbers)]
                  cycle
               end if
            end if
            if (i <= size(first%numbers)) call add_odd(first, '&campaign first('//integer_text(i)//')', position, &
                                                       first%numbers(i), whose(position), lines)
            if (i <= size(last%numbers)) call add_odd(last, '&campaign last('//integer_text(i)//')', position, &
                                                      last%numbers(i), whose(position), lines)
         end associate
      end do
   end subroutine add_campaign

   !> One number, if it is odd.
   pure subroutine add_odd(entry, what, position, number, for_whom, lines)
      !> Where it stands
      type(entry_t), intent(in) :: entry
      !> How it is called there
      character(*), intent(in) :: what
      !> Key in whose unit it is, by its position in the table
      integer, intent(in) :: position
      real(dp), intent(in) :: number
      !> The key in words, if `what` does not say it
      character(*), intent(in) :: for_whom
      type(word_t), allocatable, intent(inout) :: lines(:)

      if (is_sensible(keys(position), number)) return
      lines = [lines, word_t('warning: '//place_of(entry)//': '//what//' = '//real_text(number)//' '// &
                             trim(keys(position)%unit)//' is not what machines have'//for_whom//' ('// &
                             sensible_text(keys(position))//'); is it in this unit?')]
   end subroutine add_odd

   !> What is odd about a list of numbers: one line, or none. Where each has a line of its own in a file, the first odd one is
   !> named by it.
   pure function odd_numbers_of_list(place, what, position, numbers, first_line) result(lines)
      !> File, or file and line
      character(*), intent(in) :: place
      !> How the list is called there
      character(*), intent(in) :: what
      !> Key in whose unit they are, by its position in the table
      integer, intent(in) :: position
      real(dp), intent(in) :: numbers(:)
      !> Line of the first number, if each has its own
      integer, intent(in), optional :: first_line
      type(word_t), allocatable :: lines(:)
      character(:), allocatable :: line, how_many
      integer :: i, odd, first

      odd = 0
      first = 0
      do i = 1, size(numbers)
         if (is_sensible(keys(position), numbers(i))) cycle
         odd = odd + 1
         if (odd == 1) first = i
      end do
      allocate (lines(0))
      if (odd == 0) return
      how_many = 'the only such number'
      if (odd > 1) how_many = 'the first of '//integer_text(odd)//' such numbers'
      line = ''
      if (present(first_line)) line = ':'//integer_text(first_line + first - 1)
      lines = [word_t('warning: '//place//line//': '//what//': '//real_text(numbers(first))//' '//trim(keys(position)%unit)// &
                      ' is not what machines have'//whose(position)//' ('// &
                      sensible_text(keys(position))//'), '//how_many//' among '//integer_text(size(numbers))// &
                      '; is it in this unit?')]
   end function odd_numbers_of_list

   !> Of which key the numbers of a sweep, a threshold or a campaign are.
   pure function whose(position) result(words)
      integer, intent(in) :: position
      character(:), allocatable :: words

      words = ' for '//trim(keys(position)%group)//'.'//trim(keys(position)%name)
   end function whose

   !> File and line of an entry.
   pure function place_of(entry) result(place)
      type(entry_t), intent(in) :: entry
      character(:), allocatable :: place

      place = printable(entry%file, .false.)
      if (entry%line > 0) place = place//':'//integer_text(entry%line)
   end function place_of

end module odd_numbers
