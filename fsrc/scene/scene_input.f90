!> The input of one scene as typed values, one per line of the key table, each with its place.
module scene_input
   use errors, only: fault_list_t
   use key_table, only: allowed_text, find_key, in_range, integer_kind, key_t, keys, known_group, list_kind, &
                        logical_kind, nearest_group, nearest_key, path_limit, real_kind, reals_kind, table_kind, &
                        text_kind
   use kinds, only: dp
   use namelist_scanner, only: value_t
   use namelist_text, only: assignment_t
   use number_text, only: read_strict_integer, read_strict_real
   use text, only: integer_text, logical_text, lower, quoted, quoted_words, real_text
   implicit none(type, external)
   private

   !> One column of a table.
   type, public :: column_t
      real(dp), allocatable :: numbers(:)
   end type column_t

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
      type(column_t), allocatable :: columns(:)
   end type entry_t

   !> All keys of one scene.
   type, public :: scene_input_t
      !> Name of the input for the faults
      character(:), allocatable :: file
      type(entry_t), allocatable :: entries(:)
   contains
      procedure :: set_all
      procedure :: is_given
      procedure :: number => number_of
      procedure :: count => count_of
      procedure :: choice => choice_of
      procedure :: flag => flag_of
      procedure :: word => word_of
      procedure :: words => words_of
      procedure :: numbers => numbers_of
      procedure :: columns => columns_of
      procedure :: add_fault
   end type scene_input_t

   public :: new_scene_input, numbers_text, value_text, word_position

contains

   !> Input without any value but the defaults.
   function new_scene_input(file) result(input)
      !> Name of the input for the faults
      character(*), intent(in) :: file
      type(scene_input_t) :: input
      type(fault_list_t) :: none
      integer :: i

      input%file = file
      allocate (input%entries(size(keys)))
      do i = 1, size(keys)
         input%entries(i)%file = file
         input%entries(i)%word = ''
         input%entries(i)%words = ''
         allocate (input%entries(i)%numbers(0), input%entries(i)%columns(0))
         if (keys(i)%default == '' .or. keys(i)%default == 'required') cycle
         select case (keys(i)%kind)
         case (list_kind)
            input%entries(i)%words = trim(keys(i)%default)
         case default
            call read_value(keys(i), value_t(trim(keys(i)%default), keys(i)%kind == text_kind), input%entries(i), file, none)
         end select
         input%entries(i)%present = .true.
      end do
   end function new_scene_input

   !> Take the assignments of a text; later calls (overrides) replace earlier values.
   subroutine set_all(self, assignments, file, overriding, faults)
      class(scene_input_t), intent(inout) :: self
      !> Assignments in their order
      type(assignment_t), intent(in) :: assignments(:)
      !> Name of their source for the faults
      character(*), intent(in) :: file
      !> Whether a key may be set that an earlier call has set
      logical, intent(in) :: overriding
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      character(:), allocatable :: reported
      integer :: i, position

      reported = ''
      do i = 1, size(assignments)
         associate (assignment => assignments(i))
            if (.not. known_group(assignment%group)) then
               if (assignment%group /= reported) call faults%add(file, assignment%line, assignment%group, '', &
                                               'unknown group; the nearest known group is &'//nearest_group(assignment%group))
               reported = assignment%group
               cycle
            end if
            if (len(assignment%key) == 0) cycle
            position = find_key(assignment%group, assignment%key)
            if (position == 0) then
               if (assignment%sound) call faults%add(file, assignment%line, assignment%group, assignment%key, &
                                                   'unknown key; '//nearest_key(assignment%group, assignment%key))
               cycle
            end if
            if (self%entries(position)%given .and. .not. overriding .and. &
                .not. continues_list(keys(position), assignment, self%entries(position))) then
               call faults%add(file, assignment%line, assignment%group, assignment%key, &
                               'this key is set in line '//integer_text(self%entries(position)%line)//' already')
               cycle
            end if
            call set_entry(keys(position), assignment, self%entries(position), file, faults)
         end associate
      end do
   end subroutine set_all

   !> Read the value of one assignment into its entry.
   subroutine set_entry(key, assignment, entry, file, faults)
      type(key_t), intent(in) :: key
      type(assignment_t), intent(in) :: assignment
      type(entry_t), intent(inout) :: entry
      character(*), intent(in) :: file
      type(fault_list_t), intent(inout) :: faults
      integer :: i, length

      ! The default of a list is no beginning of it.
      length = 0
      if (entry%given) length = list_length(key, entry)
      entry%given = .true.
      entry%file = file
      entry%line = assignment%line
      entry%faulty = .not. assignment%sound
      if (entry%faulty) return
      if (assignment%whole_column .neqv. key%kind == table_kind) then
         call refuse(trim(merge('give it as '//trim(key%name)//'(:, 1) = ..., '//trim(key%name)//'(:, 2) = ...', &
                                'takes no (:, i)'//repeat(' ', 27 + 2*len_trim(key%name)), key%kind == table_kind)))
         return
      end if
      if (.not. is_list(key)) then
         if (assignment%first_element /= 0) then
            call refuse('takes no index')
            return
         else if (size(assignment%values) > 1) then
            call refuse('takes one value, '//integer_text(size(assignment%values))//' are given')
            return
         end if
      else if (assignment%first_element > 1 .and. assignment%first_element /= length + 1) then
         call refuse('elements must be given one after the other; element '//integer_text(length + 1)//' comes next')
         return
      end if
      if (assignment%first_element <= 1) then
         entry%words = ''
         entry%numbers = [real(dp) ::]
         entry%columns = [column_t ::]
      end if
      if (key%kind == table_kind) entry%numbers = [real(dp) ::]
      do i = 1, size(assignment%values)
         call read_value(key, assignment%values(i), entry, file, faults)
         if (entry%faulty) return
      end do
      if (key%kind == table_kind) entry%columns = [entry%columns, column_t(entry%numbers)]
      entry%present = .true.

   contains

      subroutine refuse(message)
         character(*), intent(in) :: message

         entry%faulty = .true.
         call faults%add(file, assignment%line, assignment%group, assignment%key, message)
      end subroutine refuse

   end subroutine set_entry

   !> Whether a key holds several values.
   pure logical function is_list(key)
      type(key_t), intent(in) :: key

      is_list = any(key%kind == [list_kind, reals_kind, table_kind])
   end function is_list

   !> Elements that a list has so far.
   pure integer function list_length(key, entry)
      type(key_t), intent(in) :: key
      type(entry_t), intent(in) :: entry
      integer :: i

      select case (key%kind)
      case (reals_kind)
         list_length = size(entry%numbers)
      case (table_kind)
         list_length = size(entry%columns)
      case default
         list_length = 0
         if (len(entry%words) > 0) list_length = 1 + count([(entry%words(i:i) == ' ', i=1, len(entry%words))])
      end select
   end function list_length

   !> Whether an assignment adds elements to a list: key(i) = ... behind key(i - 1) = ...
   pure logical function continues_list(key, assignment, entry)
      type(key_t), intent(in) :: key
      type(assignment_t), intent(in) :: assignment
      type(entry_t), intent(in) :: entry

      continues_list = is_list(key) .and. assignment%first_element > 1 .and. &
                       assignment%first_element > list_length(key, entry)
   end function continues_list

   !> Read one value as its key asks.
   subroutine read_value(key, value, entry, file, faults)
      type(key_t), intent(in) :: key
      type(value_t), intent(in) :: value
      type(entry_t), intent(inout) :: entry
      character(*), intent(in) :: file
      type(fault_list_t), intent(inout) :: faults
      logical :: sound

      sound = .false.
      select case (key%kind)
      case (real_kind)
         if (.not. value%quoted) call read_strict_real(value%text, entry%number, sound)
         if (sound) sound = in_range(key, entry%number)
      case (reals_kind, table_kind)
         if (.not. value%quoted) call read_strict_real(value%text, entry%number, sound)
         if (sound) sound = in_range(key, entry%number)
         if (sound) entry%numbers = [entry%numbers, entry%number]
      case (integer_kind)
         if (.not. value%quoted) call read_strict_integer(value%text, entry%count, sound)
         if (sound) sound = in_range(key, real(entry%count, dp))
      case (logical_kind)
         if (.not. value%quoted) call read_logical(value%text, entry%flag, sound)
      case default
         sound = value%quoted .and. len_trim(value%text) > 0 .and. len(value%text) <= path_limit
         if (sound .and. key%choices /= '') sound = &
            index(' '//trim(key%choices)//' ', ' '//trim(value%text)//' ') > 0 .and. scan(trim(value%text), ' ') == 0
         if (sound .and. key%kind == list_kind) sound = scan(trim(value%text), ' ') == 0
         if (sound .and. key%kind == text_kind) entry%word = value%text
         if (sound .and. key%kind == list_kind) entry%words = trim(entry%words//' '//value%text)
         if (sound .and. key%kind == list_kind) entry%words = trim(adjustl(entry%words))
      end select
      if (sound) return
      entry%faulty = .true.
      call faults%add(file, entry%line, trim(key%group), trim(key%name), shown(value)//' is not allowed; allowed: '// &
                      allowed_text(key)//trim(merge(' of at most 512 characters', repeat(' ', 26), &
                                                    key%kind == text_kind .and. key%choices == '')))
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

   !> Whether the user set a key.
   pure logical function is_given(self, group, name)
      class(scene_input_t), intent(in) :: self
      !> Namelist group
      character(*), intent(in) :: group
      !> Key in the group
      character(*), intent(in) :: name

      is_given = self%entries(find_key(group, name))%given
   end function is_given

   !> Value of a real key, 0 where it has none.
   pure real(dp) function number_of(self, group, name)
      class(scene_input_t), intent(in) :: self
      !> Namelist group
      character(*), intent(in) :: group
      !> Key in the group
      character(*), intent(in) :: name

      number_of = self%entries(find_key(group, name))%number
   end function number_of

   !> Value of an integer key.
   pure integer function count_of(self, group, name)
      class(scene_input_t), intent(in) :: self
      !> Namelist group
      character(*), intent(in) :: group
      !> Key in the group
      character(*), intent(in) :: name

      count_of = self%entries(find_key(group, name))%count
   end function count_of

   !> Value of a logical key.
   pure logical function flag_of(self, group, name)
      class(scene_input_t), intent(in) :: self
      !> Namelist group
      character(*), intent(in) :: group
      !> Key in the group
      character(*), intent(in) :: name

      flag_of = self%entries(find_key(group, name))%flag
   end function flag_of

   !> Value of a text key, empty where it has none.
   pure function word_of(self, group, name) result(word)
      class(scene_input_t), intent(in) :: self
      !> Namelist group
      character(*), intent(in) :: group
      !> Key in the group
      character(*), intent(in) :: name
      character(:), allocatable :: word

      word = self%entries(find_key(group, name))%word
   end function word_of

   !> Blank-separated words of a list key.
   pure function words_of(self, group, name) result(words)
      class(scene_input_t), intent(in) :: self
      !> Namelist group
      character(*), intent(in) :: group
      !> Key in the group
      character(*), intent(in) :: name
      character(:), allocatable :: words

      words = self%entries(find_key(group, name))%words
   end function words_of

   !> Numbers of a list key.
   pure function numbers_of(self, group, name) result(numbers)
      class(scene_input_t), intent(in) :: self
      !> Namelist group
      character(*), intent(in) :: group
      !> Key in the group
      character(*), intent(in) :: name
      real(dp), allocatable :: numbers(:)

      numbers = self%entries(find_key(group, name))%numbers
   end function numbers_of

   !> Columns of a table key.
   pure function columns_of(self, group, name) result(columns)
      class(scene_input_t), intent(in) :: self
      !> Namelist group
      character(*), intent(in) :: group
      !> Key in the group
      character(*), intent(in) :: name
      type(column_t), allocatable :: columns(:)

      allocate (columns, source=self%entries(find_key(group, name))%columns)
   end function columns_of

   !> Position of the word of a key among its choices in the table, from 1.
   pure integer function choice_of(self, group, name)
      class(scene_input_t), intent(in) :: self
      !> Namelist group
      character(*), intent(in) :: group
      !> Key in the group
      character(*), intent(in) :: name
      integer :: position

      position = find_key(group, name)
      choice_of = word_position(trim(keys(position)%choices), self%entries(position)%word)
   end function choice_of

   !> Position of a word in a blank-separated list, 0 if it is not there.
   pure integer function word_position(list, word)
      character(*), intent(in) :: list
      character(*), intent(in) :: word
      integer :: place, i

      word_position = 0
      place = index(' '//list//' ', ' '//word//' ')
      if (place == 0) return
      word_position = 1 + count([(list(i:i) == ' ', i=1, place - 1)])
   end function word_position

   !> Add a fault at the place of a key: where it was set, or without a line if it was not.
   subroutine add_fault(self, group, name, message, faults)
      class(scene_input_t), intent(in) :: self
      !> Namelist group
      character(*), intent(in) :: group
      !> Key in the group
      character(*), intent(in) :: name
      !> What is wrong and what is allowed
      character(*), intent(in) :: message
      !> List to append to
      type(fault_list_t), intent(inout) :: faults

      associate (entry => self%entries(find_key(group, name)))
         call faults%add(entry%file, entry%line, group, name, message)
      end associate
   end subroutine add_fault

   !> Value of an entry in namelist spelling.
   function value_text(key, entry) result(words)
      !> Its key
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
      integer :: i

      words = ''
      do i = 1, size(numbers)
         if (i > 1) words = words//', '
         words = words//real_text(numbers(i))
      end do
   end function numbers_text

end module scene_input
