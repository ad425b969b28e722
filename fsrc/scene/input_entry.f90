!> Value of one key: taken from an assignment as the key asks, or refused with a fault; and its text.
module input_entry
   use errors, only: fault_list_t
   use input_key, only: allowed_text, in_range, integer_kind, is_list, key_t, list_kind, logical_kind, path_limit, &
                        real_kind, reals_kind, table_kind, text_kind
   use kinds, only: dp, int64
   use mistaken_units, only: meant_behind
   use namelist_scanner, only: subscript_t, value_t
   use namelist_text, only: assignment_t, most_elements
   use number_text, only: read_strict_integer, read_strict_real
   use scene_types, only: numbers_t
   use text, only: counted, integer_text, logical_text, lower, printable, quoted, quoted_words, real_text
   use word_list, only: split_words, word_position, word_t
   implicit none(type, external)
   private

   !> Words of a list
   integer, parameter :: most_words = 1000

   !> Value of one key.
   type, public :: entry_t
      !> Whether the user set it, and whether it has any value
      logical :: given = .false., present = .false.
      !> Whether it was set but could not be read: a fault stands for it already
      logical :: faulty = .false.
      !> Input it was set in, and the line there (0: on the command line)
      character(:), allocatable :: file
      integer :: line = 0
      !> What was set: by element of a list, by element and column of a table; a null value where nothing was
      type(value_t), allocatable :: elements(:, :)
      real(dp) :: number = 0.0_dp
      integer :: count = 0
      logical :: flag = .false.
      character(:), allocatable :: word
      !> Blank-separated words of a list
      character(:), allocatable :: words
      !> Numbers of a list
      real(dp), allocatable :: numbers(:)
      !> Columns of a table
      type(numbers_t), allocatable :: columns(:)
   end type entry_t

   public :: new_entry, set_entry, is_overridden, rows_of, forget_elements, close_list, value_text, numbers_text, place_of

contains

   !> Entry that no one has set: the default of its key, or no value.
   function new_entry(key, file) result(entry)
      type(key_t), intent(in) :: key
      !> Name of the input for the faults
      character(*), intent(in) :: file
      type(entry_t) :: entry
      type(word_t), allocatable :: words(:)
      type(fault_list_t) :: none
      integer :: i

      entry%file = file
      entry%word = ''
      entry%words = ''
      allocate (entry%numbers(0), entry%columns(0), entry%elements(0, 0))
      entry%present = key%default /= '' .and. key%default /= 'required'
      if (.not. entry%present) return
      if (key%kind == list_kind) then
         allocate (words, source=split_words(trim(key%default)))
      else
         allocate (words(1))
         words(1)%text = trim(key%default)
      end if
      call make_room(entry%elements, size(words), 1)
      do i = 1, size(words)
         entry%elements(i, 1) = default_value(key, words(i)%text)
         call read_value(key, entry%elements(i, 1), entry, none)
      end do
      call close_list(key, entry, none)
      ! The default of a list is no beginning of it.
      deallocate (entry%elements)
      allocate (entry%elements(0, 0))
   end function new_entry

   !> Value that the key table gives.
   pure type(value_t) function default_value(key, text) result(value)
      type(key_t), intent(in) :: key
      character(*), intent(in) :: text

      value%text = text
      value%quoted = any(key%kind == [text_kind, list_kind])
   end function default_value

   !> Read the values of one assignment into the elements of its entry. A null value leaves its element as it was.
   subroutine set_entry(key, assignment, overriding, entry, file, faults)
      type(key_t), intent(in) :: key
      !> The assignment
      type(assignment_t), intent(in) :: assignment
      !> Whether elements may be set that are set already
      logical, intent(in) :: overriding
      !> Takes the values, or becomes faulty
      type(entry_t), intent(inout) :: entry
      !> Name of the source of the assignment for the faults
      character(*), intent(in) :: file
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      character(:), allocatable :: message
      integer :: i, last, row, column

      if (.not. assignment%sound) then
         entry%given = .true.
         entry%faulty = .true.
         entry%file = file
         entry%line = assignment%line
         return
      end if
      do last = size(assignment%values), 1, -1
         if (allocated(assignment%values(last)%text)) exit
      end do
      if (last == 0) return
      message = refusal(key, assignment, entry, last)
      if (message == '' .and. .not. overriding) message = set_already(assignment, entry, last)
      if (message /= '') then
         call faults%add(file, assignment%line, assignment%group, assignment%key, message)
         ! What was set before stands where it was set.
         if (entry%given) return
      end if
      entry%given = .true.
      entry%file = file
      entry%line = assignment%line
      entry%faulty = message /= ''
      if (entry%faulty) return
      if (overriding) call forget_behind(assignment%subscripts, last, entry%elements)
      do i = 1, last
         if (.not. allocated(assignment%values(i)%text)) cycle
         call find_element(assignment%subscripts, i, row, column)
         call read_value(key, assignment%values(i), entry, faults)
         if (entry%faulty) return
         call make_room(entry%elements, row, column)
         entry%elements(row, column) = assignment%values(i)
         entry%elements(row, column)%line = assignment%line
      end do
      entry%present = .true.
   end subroutine set_entry

   !> Why a key cannot take the values of an assignment; empty if it can.
   pure function refusal(key, assignment, entry, count) result(message)
      type(key_t), intent(in) :: key
      type(assignment_t), intent(in) :: assignment
      type(entry_t), intent(in) :: entry
      !> Values without null values behind them
      integer, intent(in) :: count
      character(:), allocatable :: message
      integer :: i, limit, row, column

      message = ''
      if (key%kind == table_kind .and. size(assignment%subscripts) /= 2) then
         message = 'give it as '//trim(key%name)//'(:, 1) = ..., '//trim(key%name)//'(:, 2) = ...'
      else if (.not. is_list(key) .and. size(assignment%subscripts) > 0) then
         message = 'takes no index'
      else if (.not. is_list(key) .and. count > 1) then
         message = 'takes one value, '//integer_text(count)//' are given'//comma_hint(key, assignment)
      else if (key%kind /= table_kind .and. size(assignment%subscripts) > 1) then
         message = 'takes no (:, i)'
      else
         limit = merge(most_words, most_elements, key%kind == list_kind)
         do i = 1, count
            call find_element(assignment%subscripts, i, row, column)
            if (row == 0) message = integer_text(count)//' values are given to '//counted(i - 1, 'element')
            if (row > limit .or. room(entry%elements, row, column) > 8_int64*most_elements) &
               message = 'at most '//integer_text(limit)//' elements are allowed'
            if (message /= '') return
         end do
      end if
   end function refusal

   !> Elements of a table that has room for one more.
   pure integer(int64) function room(elements, row, column)
      type(value_t), intent(in) :: elements(:, :)
      integer, intent(in) :: row
      integer, intent(in) :: column

      room = int(max(row, size(elements, 1)), int64)*int(max(column, size(elements, 2)), int64)
   end function room

   !> Make a table so large that it has an element.
   pure subroutine make_room(elements, row, column)
      type(value_t), allocatable, intent(inout) :: elements(:, :)
      integer, intent(in) :: row
      integer, intent(in) :: column
      type(value_t), allocatable :: grown(:, :)
      integer :: rows, i, j

      if (row <= size(elements, 1) .and. column <= size(elements, 2)) return
      rows = size(elements, 1)
      if (row > rows) rows = max(row, min(2*rows, most_elements))
      allocate (grown(rows, max(column, size(elements, 2))))
      do j = 1, size(elements, 2)
         do i = 1, size(elements, 1)
            if (.not. allocated(elements(i, j)%text)) cycle
            call move_alloc(elements(i, j)%text, grown(i, j)%text)
            grown(i, j)%quoted = elements(i, j)%quoted
            grown(i, j)%line = elements(i, j)%line
         end do
      end do
      call move_alloc(grown, elements)
   end subroutine make_room

   !> Where a whole list or column is replaced, forget what it had behind the new values.
   pure subroutine forget_behind(subscripts, length, elements)
      type(subscript_t), intent(in) :: subscripts(:)
      !> Of the new list
      integer, intent(in) :: length
      type(value_t), intent(inout) :: elements(:, :)
      integer :: i, row, column

      if (size(subscripts) > 0) then
         if (.not. subscripts(1)%whole()) return
      end if
      call find_element(subscripts, length, row, column)
      if (column > size(elements, 2)) return
      do i = row + 1, size(elements, 1)
         if (allocated(elements(i, column)%text)) deallocate (elements(i, column)%text)
      end do
   end subroutine forget_behind

   !> Whether an element was set on the command line.
   pure logical function is_overridden(entry, row, column)
      type(entry_t), intent(in) :: entry
      integer, intent(in) :: row
      integer, intent(in) :: column

      is_overridden = row <= size(entry%elements, 1) .and. column <= size(entry%elements, 2)
      if (is_overridden) is_overridden = allocated(entry%elements(row, column)%text) .and. entry%elements(row, column)%line == 0
   end function is_overridden

   !> Number of the last element of a list, 0: it has none.
   pure integer function rows_of(entry) result(rows)
      type(entry_t), intent(in) :: entry

      do rows = size(entry%elements, 1), 1, -1
         if (allocated(entry%elements(rows, 1)%text)) exit
      end do
   end function rows_of

   !> Forget the elements of a column from a row on that the file has set.
   pure subroutine forget_elements(entry, first_row, column)
      type(entry_t), intent(inout) :: entry
      integer, intent(in) :: first_row
      integer, intent(in) :: column
      integer :: i

      if (column > size(entry%elements, 2)) return
      do i = first_row, size(entry%elements, 1)
         if (entry%elements(i, column)%line > 0 .and. allocated(entry%elements(i, column)%text)) &
            deallocate (entry%elements(i, column)%text)
      end do
   end subroutine forget_elements

   !> That an element of an assignment was set before; empty if none was.
   pure function set_already(assignment, entry, count) result(message)
      type(assignment_t), intent(in) :: assignment
      type(entry_t), intent(in) :: entry
      integer, intent(in) :: count
      character(:), allocatable :: message
      integer :: i, row, column

      message = ''
      do i = 1, count
         if (.not. allocated(assignment%values(i)%text)) cycle
         call find_element(assignment%subscripts, i, row, column)
         if (row > size(entry%elements, 1) .or. column > size(entry%elements, 2)) cycle
         if (.not. allocated(entry%elements(row, column)%text)) cycle
         message = 'this key'
         if (size(assignment%subscripts) > 0) message = 'element '//element_name(entry%elements, row, column)
         message = message//' is set in line '//integer_text(entry%elements(row, column)%line)//' already'
         return
      end do
   end function set_already

   !> Row and column of a value among those of an assignment; row 0 if its subscripts have fewer elements.
   pure subroutine find_element(subscripts, place, row, column)
      !> None, one of a list, or two of a table
      type(subscript_t), intent(in) :: subscripts(:)
      !> From 1
      integer, intent(in) :: place
      integer, intent(out) :: row
      integer, intent(out) :: column
      integer :: rows, columns

      row = place
      column = 1
      if (size(subscripts) == 0) return
      rows = subscripts(1)%extent()
      columns = 1
      if (size(subscripts) == 2) columns = subscripts(2)%extent()
      ! Values behind a single element of a list are those of the elements behind it.
      if (size(subscripts) == 1 .and. subscripts(1)%single) rows = huge(1)
      row = 0
      if ((place - 1)/rows >= columns) return
      row = subscripts(1)%element(1 + mod(place - 1, rows))
      if (size(subscripts) == 2) column = subscripts(2)%element(1 + (place - 1)/rows)
   end subroutine find_element

   !> Two whole numbers with a comma between them are surely one number with a decimal comma.
   pure function comma_hint(key, assignment) result(hint)
      type(key_t), intent(in) :: key
      type(assignment_t), intent(in) :: assignment
      character(:), allocatable :: hint
      character(*), parameter :: digits = '0123456789'

      hint = ''
      if (key%kind /= real_kind .or. .not. assignment%has_comma .or. size(assignment%values) /= 2) return
      if (.not. (allocated(assignment%values(1)%text) .and. allocated(assignment%values(2)%text))) return
      associate (whole => assignment%values(1)%text, decimals => assignment%values(2)%text)
         if (verify(whole, '+-'//digits) > 0 .or. verify(decimals, digits//'eEdD+-') > 0) return
         hint = '; the decimal comma is a point here: '//whole//'.'//decimals
      end associate
   end function comma_hint

   !> Put the elements of a list together, once all are known. One that is unset between others is a fault where the key needs it.
   subroutine close_list(key, entry, faults)
      type(key_t), intent(in) :: key
      type(entry_t), intent(inout) :: entry
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      type(numbers_t), allocatable :: columns(:)
      integer :: lengths(size(entry%elements, 2)), last, i, j

      if (.not. is_list(key) .or. entry%faulty .or. size(lengths) == 0) return
      do j = 1, size(lengths)
         do i = size(entry%elements, 1), 1, -1
            if (allocated(entry%elements(i, j)%text)) exit
         end do
         lengths(j) = i
      end do
      entry%words = ''
      ! What was forgotten is no column.
      last = findloc(lengths > 0, .true., dim=1, back=.true.)
      allocate (columns(last))
      do j = 1, last
         allocate (columns(j)%numbers(lengths(j)))
         do i = 1, lengths(j)
            if (.not. allocated(entry%elements(i, j)%text)) then
               if (key%unset == '') then
                  entry%faulty = .true.
                  call faults%add(entry%file, entry%line, trim(key%group), trim(key%name), 'element '// &
                                  element_name(entry%elements, i, j)//' is not set, but element '// &
                                  element_name(entry%elements, lengths(j), j)//' is; every element up to the last is needed')
                  return
               end if
               entry%elements(i, j) = default_value(key, trim(key%unset))
            end if
            call read_value(key, entry%elements(i, j), entry, faults)
            columns(j)%numbers(i) = entry%number
            if (key%kind == list_kind) entry%words = trim(adjustl(entry%words//' '//entry%word))
         end do
      end do
      if (key%kind == reals_kind .and. last > 0) entry%numbers = columns(1)%numbers
      if (key%kind == table_kind) call move_alloc(columns, entry%columns)
   end subroutine close_list

   !> An element of a list, or of a table, in words.
   pure function element_name(elements, row, column) result(name)
      type(value_t), intent(in) :: elements(:, :)
      integer, intent(in) :: row
      integer, intent(in) :: column
      character(:), allocatable :: name

      name = integer_text(row)
      if (size(elements, 2) > 1) name = '('//name//', '//integer_text(column)//')'
   end function element_name

   !> Read one value as its key asks.
   subroutine read_value(key, value, entry, faults)
      type(key_t), intent(in) :: key
      type(value_t), intent(in) :: value
      type(entry_t), intent(inout) :: entry
      type(fault_list_t), intent(inout) :: faults
      character(:), allocatable :: allowed, word
      logical :: sound

      sound = .false.
      select case (key%kind)
      case (real_kind, reals_kind, table_kind)
         if (.not. value%quoted) call read_strict_real(with_exponent_letter(value%text), entry%number, sound)
         if (sound) sound = in_range(key, entry%number)
      case (integer_kind)
         if (.not. value%quoted) call read_strict_integer(value%text, entry%count, sound)
         if (sound) sound = in_range(key, real(entry%count, dp))
      case (logical_kind)
         if (.not. value%quoted) call read_logical(value%text, entry%flag, sound)
      case default
         sound = value%quoted .and. len_trim(value%text) > 0 .and. len(value%text) <= path_limit
         if (sound .and. (key%choices /= '' .or. key%kind == list_kind)) sound = scan(trim(value%text), ' ') == 0
         word = value%text
         ! Every later question compares whole words: a blank behind one must not make it another.
         if (key%choices /= '') word = trim(word)
         if (sound .and. key%choices /= '') sound = word_position(trim(key%choices), word) > 0
         if (sound) entry%word = word
      end select
      if (sound) return
      entry%faulty = .true.
      allowed = allowed_text(key)
      if (key%kind == text_kind .and. key%choices == '') allowed = allowed//' of at most '//integer_text(path_limit)//' characters'
      if (key%kind == text_kind .and. key%choices /= '' .and. key%default /= '') &
         allowed = allowed//"; without this key: '"//trim(key%default)//"'"
      if (any(key%kind == [real_kind, reals_kind]) .and. .not. value%quoted) allowed = allowed//meant_behind(key, entry%number)
      call faults%add(entry%file, entry%line, trim(key%group), trim(key%name), &
                      shown(value)//' is not allowed; allowed: '//allowed)
   end subroutine read_value

   !> Value as it stands in the input, shortened for a sentence.
   pure function shown(value) result(words)
      type(value_t), intent(in) :: value
      character(:), allocatable :: words
      integer, parameter :: most = 40

      words = value%text
      if (len(words) > most) words = words(:most)//'...'
      if (value%quoted) words = quoted(words)
   end function shown

   !> Number whose exponent has the letter e: in namelists it may have a q, or none before its sign if the number has a point.
   pure function with_exponent_letter(text) result(number)
      character(*), intent(in) :: text
      character(:), allocatable :: number
      integer :: place

      number = text
      place = scan(text, 'qQ')
      if (place > 0) number(place:place) = 'e'
      place = scan(text, '+-', back=.true.)
      if (place < 2) return
      if (index(text(:place - 1), '.') > 0 .and. verify(text(place - 1:place - 1), '0123456789.') == 0) &
         number = text(:place - 1)//'e'//text(place:)
   end function with_exponent_letter

   !> The namelist spellings of true and false, with or without their points.
   pure subroutine read_logical(text, flag, sound)
      character(*), intent(in) :: text
      logical, intent(out) :: flag
      logical, intent(out) :: sound

      flag = .false.
      sound = .true.
      select case (lower(text))
      case ('.true.', 'true', 't', '.t.', '.true', '.t')
         flag = .true.
      case ('.false.', 'false', 'f', '.f.', '.false', '.f')
      case default
         sound = .false.
      end select
   end subroutine read_logical

   !> Value of an entry in namelist spelling.
   function value_text(key, entry) result(words)
      type(key_t), intent(in) :: key
      !> Entry with a value
      type(entry_t), intent(in) :: entry
      character(:), allocatable :: words

      select case (key%kind)
      case (real_kind)
         words = real_text(entry%number)
      case (integer_kind)
         words = integer_text(entry%count)
      case (logical_kind)
         words = logical_text(entry%flag)
      case (text_kind)
         words = quoted(entry%word)
      case (reals_kind)
         words = numbers_text(entry%numbers)
      case default
         words = quoted_words(entry%words, ' ')
      end select
   end function value_text

   !> Numbers with commas between.
   pure function numbers_text(numbers) result(words)
      !> Finite numbers
      real(dp), intent(in) :: numbers(:)
      character(:), allocatable :: words
      ! A sign, 18 digits, a point and an exponent; comma and blank
      integer, parameter :: longest = 27
      integer :: i, used

      allocate (character(longest*size(numbers)) :: words)
      used = 0
      do i = 1, size(numbers)
         associate (part => real_text(numbers(i))//', ')
            words(used + 1:used + len(part)) = part
            used = used + len(part)
         end associate
      end do
      words = words(:max(0, used - len(', ')))
   end function numbers_text

   !> File and line of an entry.
   pure function place_of(entry) result(place)
      type(entry_t), intent(in) :: entry
      character(:), allocatable :: place

      place = printable(entry%file, .false.)
      if (entry%line > 0) place = place//':'//integer_text(entry%line)
   end function place_of

end module input_entry
