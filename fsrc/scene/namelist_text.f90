!> Takes namelist text apart into assignments, each with its line, and reports every fault of the text.
!>
!> The runtime's own namelist reader stops at the first fault, takes a wrong value in the last group for
!> the end of the file, and accepts misspelt groups and repeated keys without a word; hence this one.
module namelist_text
   use errors, only: fault_list_t
   use text, only: integer_text, is_word_character, lower
   implicit none(type, external)
   private

   !> One value as it stands, and whether it stood in quotes.
   type, public :: value_t
      character(:), allocatable :: text
      logical :: quoted = .false.
   end type value_t

   !> key = values, or key(index) = values.
   type, public :: assignment_t
      character(:), allocatable :: group
      !> Empty: here the group opens, so that a group without any key is seen as well
      character(:), allocatable :: key
      !> Whether it could be taken apart; if not, a fault stands for it already
      logical :: sound = .true.
      !> Line of the key
      integer :: line = 0
      !> First element that is set; 0: no index was given
      integer :: first_element = 0
      !> Whether the index was (:, first_element): a column of a table
      logical :: whole_column = .false.
      type(value_t), allocatable :: values(:)
   end type assignment_t

   type :: group_place_t
      character(:), allocatable :: group
      integer :: line = 0
   end type group_place_t

   !> State of the walk through the text.
   type :: scanner_t
      character(:), allocatable :: content
      character(:), allocatable :: file
      integer :: at = 1
      integer :: line = 1
   end type scanner_t

   character(*), parameter :: horizontal_tab = achar(9), line_feed = achar(10), carriage_return = achar(13)
   !> Some editors begin a text in UTF-8 with it
   character(*), parameter :: byte_order_mark = char(239)//char(187)//char(191)

   public :: scan_namelists

contains

   !> All assignments of a text; faults of its form are added to the list.
   subroutine scan_namelists(content, file, first_line, assignments, faults)
      !> Whole text
      character(*), intent(in) :: content
      !> Its name for the faults
      character(*), intent(in) :: file
      !> Number of its first line; 0 for a text of one line, which then has no number in the faults
      integer, intent(in) :: first_line
      !> What stands in it, in its order
      type(assignment_t), allocatable, intent(out) :: assignments(:)
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      type(scanner_t) :: scanner
      type(group_place_t) :: opened(64)
      character(:), allocatable :: group
      integer :: i, opened_count, stray_line, used
      logical :: sound

      allocate (assignments(64))
      used = 0
      scanner%content = content
      scanner%file = file
      scanner%line = first_line
      if (len_trim(content) == 0) then
         assignments = assignments(:0)
         call faults%add(file, 0, '', '', 'the file is empty; a scene needs at least its required groups')
         return
      end if
      call check_characters(scanner, faults, sound)
      if (.not. sound) then
         assignments = assignments(:0)
         return
      end if

      if (index(content, byte_order_mark) == 1) scanner%at = 1 + len(byte_order_mark)
      opened_count = 0
      stray_line = -2
      do
         call skip_blanks(scanner)
         if (ended(scanner)) exit
         if (letter(scanner) /= '&') then
            ! Lines that follow each other are one fault, not one each.
            if (scanner%line > stray_line + 1) call faults%add(file, scanner%line, '', '', &
                                                               'text outside a group; a group starts with &name and ends with /')
            stray_line = scanner%line
            call skip_stray(scanner)
            cycle
         end if
         scanner%at = scanner%at + 1
         group = lower(take_word(scanner))
         if (len(group) == 0) then
            call faults%add(file, scanner%line, '', '', 'a group name must follow the & at once')
            stray_line = scanner%line
            call skip_line(scanner)
            cycle
         end if
         do i = 1, opened_count
            if (opened(i)%group == group) call faults%add(file, scanner%line, group, '', &
                                                          'this group stands in line '//integer_text(opened(i)%line)//' already')
         end do
         if (opened_count < size(opened)) then
            opened_count = opened_count + 1
            opened(opened_count)%group = group
            opened(opened_count)%line = scanner%line
         end if
         call scan_group(scanner, group, assignments, used, faults)
      end do
      assignments = assignments(:used)
   end subroutine scan_namelists

   !> Assignments of one group, up to its slash.
   subroutine scan_group(scanner, group, assignments, used, faults)
      type(scanner_t), intent(inout) :: scanner
      character(*), intent(in) :: group
      type(assignment_t), allocatable, intent(inout) :: assignments(:)
      integer, intent(inout) :: used
      type(fault_list_t), intent(inout) :: faults
      type(assignment_t) :: assignment
      integer :: first_line

      first_line = scanner%line
      assignment%group = group
      assignment%key = ''
      assignment%line = first_line
      call append(assignment)
      do
         call skip_blanks(scanner)
         if (.not. ended(scanner)) then
            if (letter(scanner) == ',') then
               scanner%at = scanner%at + 1
               cycle
            end if
         end if
         if (at_new_group(scanner)) then
            call faults%add(scanner%file, first_line, group, '', 'this group is not closed by a /')
            return
         end if
         if (letter(scanner) == '/') then
            scanner%at = scanner%at + 1
            return
         end if
         call scan_assignment(scanner, group, assignment, faults)
         if (len(assignment%key) > 0) call append(assignment)
      end do

   contains

      subroutine append(assignment)
         type(assignment_t), intent(in) :: assignment
         type(assignment_t), allocatable :: grown(:)

         if (used == size(assignments)) then
            allocate (grown(2*used))
            grown(:used) = assignments
            call move_alloc(grown, assignments)
         end if
         used = used + 1
         assignments(used) = assignment
      end subroutine append

   end subroutine scan_group

   !> One 'key = values'; after a fault the rest of its line is passed over.
   subroutine scan_assignment(scanner, group, assignment, faults)
      type(scanner_t), intent(inout) :: scanner
      character(*), intent(in) :: group
      type(assignment_t), intent(out) :: assignment
      type(fault_list_t), intent(inout) :: faults
      logical :: sound

      sound = .false.
      assignment%sound = .false.
      assignment%group = group
      assignment%line = scanner%line
      assignment%key = lower(take_word(scanner))
      if (len(assignment%key) == 0) then
         call faults%add(scanner%file, scanner%line, group, '', &
                         "unexpected '"//letter(scanner)//"'; a key must stand here, as in key = value")
         call skip_line(scanner)
         return
      end if
      call skip_blanks(scanner)
      if (.not. ended(scanner)) then
         if (letter(scanner) == '(') then
            call take_index(scanner, assignment%first_element, assignment%whole_column)
            if (assignment%first_element < 1) then
               call faults%add(scanner%file, scanner%line, group, assignment%key, &
                               'the index in parentheses must be one positive integer')
               call skip_line(scanner)
               return
            end if
            call skip_blanks(scanner)
         end if
      end if
      if (.not. ended(scanner)) sound = letter(scanner) == '='
      if (.not. sound) then
         call faults%add(scanner%file, assignment%line, group, assignment%key, 'an equals sign must follow the key')
         if (scanner%line == assignment%line) call skip_line(scanner)
         return
      end if
      scanner%at = scanner%at + 1
      call scan_values(scanner, assignment, faults)
   end subroutine scan_assignment

   !> Values up to the next key, slash or group.
   subroutine scan_values(scanner, assignment, faults)
      type(scanner_t), intent(inout) :: scanner
      type(assignment_t), intent(inout) :: assignment
      type(fault_list_t), intent(inout) :: faults
      type(value_t), allocatable :: values(:), grown(:)
      integer :: used
      logical :: comma_before, sound, closed

      allocate (values(8))
      used = 0
      sound = .true.
      comma_before = .true.
      do
         call skip_blanks(scanner)
         if (at_new_group(scanner)) exit
         if (letter(scanner) == '/') exit
         if (letter(scanner) == ',') then
            if (comma_before) then
               call faults%add(scanner%file, scanner%line, assignment%group, assignment%key, 'a value is missing before the comma')
               sound = .false.
            end if
            comma_before = .true.
            scanner%at = scanner%at + 1
            cycle
         end if
         if (key_follows(scanner)) exit
         if (used == size(values)) then
            allocate (grown(2*used))
            grown(:used) = values
            call move_alloc(grown, values)
         end if
         used = used + 1
         call take_value(scanner, values(used), closed)
         if (.not. closed) then
            call faults%add(scanner%file, assignment%line, assignment%group, assignment%key, 'the closing quote is missing')
            return
         end if
         comma_before = .false.
      end do
      assignment%values = values(:used)
      if (used == 0 .and. sound) then
         call faults%add(scanner%file, assignment%line, assignment%group, assignment%key, &
                         'a value is missing after the equals sign')
         sound = .false.
      end if
      assignment%sound = sound
   end subroutine scan_values

   !> A quoted text (it must end on its line) or a bare word. A slash with a word right behind it is part
   !> of the bare word: 3/4 is a bad number, not a 3 and the end of the group.
   subroutine take_value(scanner, value, closed)
      type(scanner_t), intent(inout) :: scanner
      type(value_t), intent(out) :: value
      logical, intent(out) :: closed
      character(1) :: quote
      integer :: start, closing

      closed = .true.
      quote = letter(scanner)
      value%quoted = quote == "'" .or. quote == '"'
      start = scanner%at
      scanner%at = scanner%at + 1
      if (.not. value%quoted) then
         do while (.not. ended(scanner))
            if (is_blank(letter(scanner)) .or. scan(letter(scanner), ',!='//"'"//'"') > 0) exit
            if (letter(scanner) == '/' .and. .not. word_follows(scanner)) exit
            scanner%at = scanner%at + 1
         end do
         value%text = scanner%content(start:scanner%at - 1)
         return
      end if
      value%text = ''
      do
         start = scanner%at
         closing = scan(scanner%content(start:), quote//line_feed//carriage_return)
         closed = closing > 0
         if (closed) closed = scanner%content(start + closing - 1:start + closing - 1) == quote
         if (.not. closed) exit
         value%text = value%text//scanner%content(start:start + closing - 2)
         scanner%at = start + closing
         if (letter(scanner) /= quote) return
         value%text = value%text//quote
         scanner%at = scanner%at + 1
      end do
      call skip_line(scanner)
   end subroutine take_value

   !> Number in parentheses after a key; 0 if it is not one positive integer.
   subroutine take_index(scanner, first_element, whole_column)
      type(scanner_t), intent(inout) :: scanner
      integer, intent(out) :: first_element
      logical, intent(out) :: whole_column
      character(:), allocatable :: inside
      integer :: closing, stat

      first_element = 0
      whole_column = .false.
      closing = index(scanner%content(scanner%at:), ')')
      if (closing < 3 .or. closing > 16) return
      inside = adjustl(scanner%content(scanner%at + 1:scanner%at + closing - 2))
      if (inside(1:1) == ':') then
         whole_column = .true.
         inside = adjustl(inside(2:))
         if (inside(1:1) /= ',') return
         inside = adjustl(inside(2:))
      end if
      if (verify(trim(inside), '0123456789') > 0 .or. len_trim(inside) == 0) return
      read (inside, *, iostat=stat) first_element
      if (stat /= 0) first_element = 0
      scanner%at = scanner%at + closing
   end subroutine take_index

   !> Binary files and stray control characters are one fault, not hundreds.
   subroutine check_characters(scanner, faults, sound)
      type(scanner_t), intent(inout) :: scanner
      type(fault_list_t), intent(inout) :: faults
      logical, intent(out) :: sound
      integer :: i, line

      sound = .true.
      line = scanner%line
      do i = 1, len(scanner%content)
         associate (code => iachar(scanner%content(i:i)))
            if (code == 10) line = line + 1
            if ((code < 32 .and. code /= 9 .and. code /= 10 .and. code /= 13) .or. code == 127) then
               call faults%add(scanner%file, line, '', '', &
                               'not a text file: it holds the control character '//integer_text(code))
               sound = .false.
               return
            end if
         end associate
      end do
   end subroutine check_characters

   !> Whether a group opens here, or the text ends.
   pure logical function at_new_group(scanner)
      type(scanner_t), intent(in) :: scanner

      at_new_group = ended(scanner)
      if (.not. at_new_group) at_new_group = letter(scanner) == '&'
   end function at_new_group

   !> Whether a letter or digit comes right after the present character.
   pure logical function word_follows(scanner)
      type(scanner_t), intent(in) :: scanner

      word_follows = scanner%at < len(scanner%content)
      if (word_follows) word_follows = is_word_character(scanner%content(scanner%at + 1:scanner%at + 1))
   end function word_follows

   !> Whether 'word =' or 'word(' stands here; the scanner stays where it is.
   logical function key_follows(scanner)
      type(scanner_t), intent(inout) :: scanner
      integer :: at, line

      at = scanner%at
      line = scanner%line
      key_follows = len(take_word(scanner)) > 0
      if (key_follows) then
         call skip_blanks(scanner)
         key_follows = scan(letter(scanner), '=(') > 0
      end if
      scanner%at = at
      scanner%line = line
   end function key_follows

   !> Letters, digits and underscores from here on.
   function take_word(scanner) result(word)
      type(scanner_t), intent(inout) :: scanner
      character(:), allocatable :: word
      integer :: start

      start = scanner%at
      do while (.not. ended(scanner))
         if (.not. is_word_character(letter(scanner))) exit
         scanner%at = scanner%at + 1
      end do
      word = scanner%content(start:scanner%at - 1)
   end function take_word

   !> Pass over blanks, line ends and comments.
   subroutine skip_blanks(scanner)
      type(scanner_t), intent(inout) :: scanner

      do while (.not. ended(scanner))
         if (letter(scanner) == '!') then
            call skip_line(scanner)
         else if (.not. is_blank(letter(scanner))) then
            return
         else
            if (letter(scanner) == line_feed) scanner%line = scanner%line + 1
            scanner%at = scanner%at + 1
         end if
      end do
   end subroutine skip_blanks

   !> Pass over the rest of the line, its end excepted.
   subroutine skip_line(scanner)
      type(scanner_t), intent(inout) :: scanner

      do while (.not. ended(scanner))
         if (letter(scanner) == line_feed) return
         scanner%at = scanner%at + 1
      end do
   end subroutine skip_line

   !> Pass over text outside a group up to the next & or line end.
   subroutine skip_stray(scanner)
      type(scanner_t), intent(inout) :: scanner

      do while (.not. ended(scanner))
         if (letter(scanner) == '&' .or. letter(scanner) == line_feed) return
         scanner%at = scanner%at + 1
      end do
   end subroutine skip_stray

   pure character(1) function letter(scanner)
      type(scanner_t), intent(in) :: scanner

      letter = ' '
      if (scanner%at <= len(scanner%content)) letter = scanner%content(scanner%at:scanner%at)
   end function letter

   pure logical function ended(scanner)
      type(scanner_t), intent(in) :: scanner

      ended = scanner%at > len(scanner%content)
   end function ended

   pure logical function is_blank(character_)
      character(1), intent(in) :: character_

      is_blank = character_ == ' ' .or. character_ == horizontal_tab .or. character_ == line_feed .or. &
                 character_ == carriage_return
   end function is_blank

end module namelist_text
