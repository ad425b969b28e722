!> Value of one key: taken from an assignment as the key asks, or refused with a fault; and its text.
module input_entry
   use errors, only: fault_list_t
   use input_key, only: allowed_text, in_range, integer_kind, is_list, key_t, list_kind, logical_kind, path_limit, &
                        real_kind, reals_kind, table_kind, text_kind
   use kinds, only: dp
   use mistaken_units, only: meant_behind
   use namelist_scanner, only: value_t
   use namelist_text, only: assignment_t
   use number_text, only: read_strict_integer, read_strict_real
   use scene_types, only: numbers_t
   use text, only: integer_text, logical_text, lower, printable, quoted, quoted_words, real_text
   use word_list, only: split_words, word_count, word_position, word_t
   implicit none(type, external)
   private

   !> Words of a list that are set one by one
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

   public :: new_entry, set_entry, continues_list, value_text, numbers_text, place_of

contains

   !> Entry that nobody has set: the default of its key, or no value.
   function new_entry(key, file) result(entry)
      type(key_t), intent(in) :: key
      !> Name of the input for the faults
      character(*), intent(in) :: file
      type(entry_t) :: entry
      type(word_t), allocatable :: words(:)
      type(value_t), allocatable :: values(:)
      type(fault_list_t) :: none
      integer :: i

      entry%file = file
      entry%word = ''
      entry%words = ''
      allocate (entry%numbers(0), entry%columns(0))
      entry%present = key%default /= '' .and. key%default /= 'required'
      if (.not. entry%present) return
      if (key%kind == list_kind) then
         allocate (words, source=split_words(trim(key%default)))
      else
         allocate (words(1))
         words(1)%text = trim(key%default)
      end if
      allocate (values(size(words)))
      do i = 1, size(words)
         values(i)%text = words(i)%text
         values(i)%quoted = any(key%kind == [text_kind, list_kind])
      end do
      call add_values(key, values, entry, none)
   end function new_entry

   !> Read the value of one assignment into its entry.
   subroutine set_entry(key, assignment, entry, file, faults)
      type(key_t), intent(in) :: key
      !> The assignment
      type(assignment_t), intent(in) :: assignment
      !> Takes the value, or becomes faulty
      type(entry_t), intent(inout) :: entry
      !> Name of the source of the assignment for the faults
      character(*), intent(in) :: file
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      type(entry_t) :: before
      integer :: length

      ! The default of a list is no beginning of it.
      length = 0
      if (entry%given) length = list_length(key, entry)
      before = entry
      entry%given = .true.
      entry%file = file
      entry%line = assignment%line
      entry%faulty = .not. assignment%sound
      if (entry%faulty) return
      if (key%kind == table_kind .and. .not. assignment%whole_column) then
         call refuse('give it as '//trim(key%name)//'(:, 1) = ..., '//trim(key%name)//'(:, 2) = ...')
         return
      else if (key%kind /= table_kind .and. assignment%whole_column) then
         call refuse('takes no (:, i)')
         return
      end if
      if (.not. is_list(key)) then
         if (assignment%first_element /= 0) then
            call refuse('takes no index')
            return
         else if (size(assignment%values) > 1) then
            call refuse('takes one value, '//integer_text(size(assignment%values))//' are given'//comma_hint())
            return
         end if
      else if (assignment%first_element > length + 1) then
         call refuse('element '//integer_text(assignment%first_element)//' is given, but element '//integer_text(length + 1)// &
                     ' is not; a list is given from its first element on')
         return
      else if (key%kind == list_kind .and. assignment%first_element > most_words) then
         call refuse('at most '//integer_text(most_words)//' elements are allowed')
         return
      end if
      if (length == 0 .or. assignment%first_element <= length) then
         entry%words = ''
         entry%numbers = [real(dp) ::]
         deallocate (entry%columns)
         allocate (entry%columns(0))
         call add_elements(before, 1, min(assignment%first_element - 1, length), entry)
      end if
      call add_values(key, assignment%values, entry, faults)
      ! An element that was given before is replaced; those behind it stay.
      if (assignment%first_element > 0 .and. .not. entry%faulty) &
         call add_elements(before, list_length(key, entry) + 1, length, entry)
      if (.not. entry%faulty) entry%present = .true.

   contains

      !> Two whole numbers with a comma between them are surely one number with a decimal comma.
      pure function comma_hint() result(hint)
         character(:), allocatable :: hint
         character(*), parameter :: digits = '0123456789'

         hint = ''
         if (key%kind /= real_kind .or. .not. assignment%has_comma .or. size(assignment%values) /= 2) return
         associate (whole => assignment%values(1)%text, decimals => assignment%values(2)%text)
            if (verify(whole, '+-'//digits) > 0 .or. verify(decimals, digits//'eEdD+-') > 0) return
            hint = '; the decimal comma is a point here: '//whole//'.'//decimals
         end associate
      end function comma_hint

      subroutine refuse(message)
         character(*), intent(in) :: message

         entry%faulty = .true.
         call faults%add(file, assignment%line, assignment%group, assignment%key, message)
      end subroutine refuse

   end subroutine set_entry

   !> Put the elements first to last of another list behind those of a list; none if last is smaller.
   pure subroutine add_elements(before, first, last, entry)
      type(entry_t), intent(in) :: before
      integer, intent(in) :: first
      integer, intent(in) :: last
      type(entry_t), intent(inout) :: entry
      type(word_t), allocatable :: words(:)
      integer :: i

      if (last < first) return
      if (last <= size(before%numbers)) entry%numbers = [entry%numbers, before%numbers(first:last)]
      do i = first, min(last, size(before%columns))
         call append_column(entry%columns, before%columns(i)%numbers)
      end do
      allocate (words, source=split_words(before%words))
      do i = first, min(last, size(words))
         entry%words = trim(adjustl(entry%words//' '//words(i)%text))
      end do
   end subroutine add_elements

   !> Put a column behind those of a table.
   pure subroutine append_column(columns, numbers)
      type(numbers_t), allocatable, intent(inout) :: columns(:)
      real(dp), intent(in) :: numbers(:)
      type(numbers_t), allocatable :: grown(:)
      integer :: i

      allocate (grown(size(columns) + 1))
      do i = 1, size(columns)
         call move_alloc(columns(i)%numbers, grown(i)%numbers)
      end do
      grown(size(grown))%numbers = numbers
      call move_alloc(grown, columns)
   end subroutine append_column

   !> Elements that a list has so far.
   pure integer function list_length(key, entry)
      type(key_t), intent(in) :: key
      type(entry_t), intent(in) :: entry

      select case (key%kind)
      case (reals_kind)
         list_length = size(entry%numbers)
      case (table_kind)
         list_length = size(entry%columns)
      case default
         list_length = word_count(entry%words)
      end select
   end function list_length

   !> Whether an assignment adds elements to a list: key(i) = ... behind key(i - 1) = ...
   pure logical function continues_list(key, assignment, entry)
      type(key_t), intent(in) :: key
      !> The assignment
      type(assignment_t), intent(in) :: assignment
      !> What was set before
      type(entry_t), intent(in) :: entry

      continues_list = is_list(key) .and. assignment%first_element > 1 .and. &
                       assignment%first_element > list_length(key, entry)
   end function continues_list

   !> Read values as their key asks, and put them behind those that a list has already.
   subroutine add_values(key, values, entry, faults)
      type(key_t), intent(in) :: key
      type(value_t), intent(in) :: values(:)
      type(entry_t), intent(inout) :: entry
      type(fault_list_t), intent(inout) :: faults
      real(dp), allocatable :: numbers(:)
      integer :: i

      allocate (numbers(size(values)))
      do i = 1, size(values)
         call read_value(key, values(i), entry, faults)
         if (entry%faulty) return
         numbers(i) = entry%number
      end do
      if (key%kind == reals_kind) entry%numbers = [entry%numbers, numbers]
      if (key%kind == table_kind) call append_column(entry%columns, numbers)
   end subroutine add_values

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
         if (.not. value%quoted) call read_strict_real(value%text, entry%number, sound)
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
         if (sound .and. key%kind == text_kind) entry%word = word
         if (sound .and. key%kind == list_kind) entry%words = trim(adjustl(entry%words//' '//word))
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

   !> The namelist spellings of true and false.
   pure subroutine read_logical(text, flag, sound)
      character(*), intent(in) :: text
      logical, intent(out) :: flag
      logical, intent(out) :: sound

      flag = .false.
      sound = .true.
      select case (lower(text))
      case ('.true.', 'true', 't', '.t.')
         flag = .true.
      case ('.false.', 'false', 'f', '.f.')
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
