!> Takes namelist text apart into assignments, each with its line, and reports every fault of the text.
!>
!> The runtime's own namelist reader stops at the first fault, takes a wrong value in the last group for
!> the end of the file, and accepts misspelt groups and repeated keys without a word; hence this one. It reads
!> what the standard has, but for what input/NAMELISTS.md lists.
module namelist_text
   use errors, only: fault_list_t
   use key_table, only: resembles_group
   use namelist_scanner, only: new_scanner, scanner_t, subscript_t, value_t
   use text, only: integer_text, is_word_character, lower
   implicit none(type, external)
   private

   !> The group that may stand several times: each is a gear pair of its own.
   character(*), parameter, public :: repeated_group = 'gear'

   !> Elements that a key may have.
   integer, parameter, public :: most_elements = 1000000

   !> key = values, or key(subscripts) = values.
   type, public :: assignment_t
      character(:), allocatable :: group
      !> Which of the groups of this name it stands in, from 1
      integer :: occurrence = 1
      !> Empty: here the group opens, so that a group without any key is seen as well
      character(:), allocatable :: key
      !> Whether it could be taken apart; if not, a fault stands for it already
      logical :: sound = .true.
      !> Line of the key
      integer :: line = 0
      !> Subscripts behind the key, none where it stands alone, and how they stand there
      type(subscript_t), allocatable :: subscripts(:)
      character(:), allocatable :: subscript_text
      !> Its values, each as often as its repeat count says
      type(value_t), allocatable :: values(:)
      !> Whether a comma stands among them
      logical :: has_comma = .false.
   end type assignment_t

   !> Closes a group of old compilers: &end or $end
   character(*), parameter :: group_end = 'end'
   character(*), parameter :: outside_a_group = 'text outside a group; a group starts with &name and ends with /'
   character(*), parameter :: no_semicolon = 'a semicolon separates values only in the mode decimal=''comma''; '// &
                              'here decimals have a point, and commas separate values'
   character(*), parameter :: word_letters = 'abcdefghijklmnopqrstuvwxyz0123456789_'

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
      character(:), allocatable :: group, text
      integer :: i, before, first_stray, stray_line, used, earlier
      logical :: sound

      allocate (assignments(64))
      used = 0
      text = with_line_feeds(content)
      if (len_trim(text) == 0) then
         assignments = assignments(:0)
         call faults%add(file, 0, '', '', 'the file is empty; a scene needs at least its required groups')
         return
      end if
      call check_characters(text, file, first_line, faults, sound)
      if (.not. sound) then
         assignments = assignments(:0)
         return
      end if

      scanner = new_scanner(text, first_line)
      before = faults%count()
      first_stray = 0
      stray_line = -2
      do
         call scanner%skip_blanks()
         if (scanner%ended()) exit
         group = lower(scanner%word_ahead())
         if (scanner%letter() /= '&' .and. .not. (scanner%letter() == '$' .and. len(group) > 0)) then
            if (first_stray == 0) first_stray = scanner%line
            ! Lines that follow each other are one fault, not one each.
            i = scanner%line
            if (.not. is_misplaced(scanner%take_stray(resembles_group))) cycle
            if (i > stray_line + 1) call faults%add(file, i, '', '', outside_a_group)
            stray_line = i
            cycle
         end if
         call scanner%step()
         group = lower(scanner%take_word())
         if (len(group) == 0) then
            call faults%add(file, scanner%line, '', '', 'a group name must follow the & at once')
            stray_line = scanner%line
            call scanner%skip_line()
            cycle
         end if
         if (group == group_end) cycle
         earlier = 0
         do i = 1, used
            if (len(assignments(i)%key) > 0 .or. assignments(i)%group /= group) cycle
            earlier = earlier + 1
            if (group == repeated_group) cycle
            call faults%add(file, scanner%line, group, '', &
                            'this group is already in line '//integer_text(assignments(i)%line))
            exit
         end do
         call scan_group(scanner, file, group, earlier + 1, assignments, used, faults)
      end do
      assignments = assignments(:used)
      if (used == 0 .and. first_stray > 0 .and. faults%count() == before) &
         call faults%add(file, first_stray, '', '', outside_a_group)
   end subroutine scan_namelists

   !> Whether text outside of groups, which is passed over, looks as if it belonged into one: an assignment, or a group without its
   !> sign.
   pure logical function is_misplaced(line)
      !> Up to its end, or to the group behind it
      character(*), intent(in) :: line
      character(:), allocatable :: behind
      integer :: first, last

      ! Another sign may stand where the & should.
      first = merge(1, 2, is_word_character(line(1:1)))
      first = first + verify(line(first:)//'.', ' '//achar(9)) - 1
      last = first
      do while (last <= len(line))
         if (.not. is_word_character(line(last:last))) exit
         last = last + 1
      end do
      behind = adjustl(line(last:))//' '
      is_misplaced = last > first .and. is_set(behind)
      if (is_misplaced .or. last == first .or. .not. resembles_group(line(first:last - 1))) return
      is_misplaced = behind == '' .or. scan(behind(1:1), '!/,') == 1
      if (.not. is_misplaced) is_misplaced = is_set(adjustl(behind(verify(lower(behind)//'.', word_letters):)))
   end function is_misplaced

   !> Whether an equals sign stands here, or subscripts and an equals sign.
   pure logical function is_set(text)
      character(*), intent(in) :: text
      character(:), allocatable :: rest

      rest = text//'  '
      if (rest(1:1) == '(') rest = adjustl(rest(index(rest, ')') + 1:))//'  '
      is_set = rest(1:1) == '=' .and. rest(2:2) /= '='
   end function is_set

   !> Assignments of one group, up to its slash.
   subroutine scan_group(scanner, file, group, occurrence, assignments, used, faults)
      type(scanner_t), intent(inout) :: scanner
      character(*), intent(in) :: file
      character(*), intent(in) :: group
      integer, intent(in) :: occurrence
      type(assignment_t), allocatable, intent(inout) :: assignments(:)
      integer, intent(inout) :: used
      type(fault_list_t), intent(inout) :: faults
      type(assignment_t) :: assignment
      integer :: first_line, i

      first_line = scanner%line
      assignment%group = group
      assignment%key = ''
      assignment%subscript_text = ''
      assignment%line = first_line
      call append(assignment)
      do
         call scanner%skip_blanks()
         if (scanner%letter() == ',') then
            call scanner%step()
            cycle
         end if
         if (scanner%at_sign()) then
            if (lower(scanner%word_ahead()) /= group_end) then
               call faults%add(file, first_line, group, '', 'this group is not closed by a /')
               return
            end if
            do i = 0, len(group_end)
               call scanner%step()
            end do
            return
         end if
         if (scanner%letter() == '/') then
            call scanner%step()
            return
         end if
         call scan_assignment(scanner, file, group, assignment, faults)
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
         assignments(used)%occurrence = occurrence
      end subroutine append

   end subroutine scan_group

   !> One 'key = values'; after a fault the rest of its line is passed over.
   subroutine scan_assignment(scanner, file, group, assignment, faults)
      type(scanner_t), intent(inout) :: scanner
      character(*), intent(in) :: file
      character(*), intent(in) :: group
      type(assignment_t), intent(out) :: assignment
      type(fault_list_t), intent(inout) :: faults
      logical :: sound, closed

      assignment%sound = .false.
      assignment%group = group
      assignment%line = scanner%line
      allocate (assignment%subscripts(0))
      assignment%subscript_text = ''
      assignment%key = lower(scanner%take_word())
      if (len(assignment%key) == 0) then
         call faults%add(file, scanner%line, group, '', &
                         "unexpected '"//scanner%letter()//"'; a key is expected, as in key = value")
         call scanner%step()
         call scanner%skip_fault()
         return
      end if
      call scanner%skip_blanks()
      sound = .true.
      closed = .true.
      if (scanner%letter() == '(') then
         call scanner%take_subscripts(assignment%subscripts, assignment%subscript_text, sound, closed)
         if (.not. sound) call faults%add(file, assignment%line, group, assignment%key, 'the index in parentheses must be '// &
                                          'a positive integer or a section such as (1:2), (2:) or (1:5:2)')
         if (closed) call scanner%skip_blanks()
      end if
      if (.not. closed .or. scanner%letter() /= '=') then
         if (sound) call faults%add(file, assignment%line, group, assignment%key, 'an equals sign must follow the key')
         if (scanner%line == assignment%line .or. .not. closed) call scanner%skip_fault()
         return
      end if
      call scanner%step()
      call scan_values(scanner, file, assignment, faults)
      assignment%sound = assignment%sound .and. sound
   end subroutine scan_assignment

   !> Values up to the next key, slash or group.
   subroutine scan_values(scanner, file, assignment, faults)
      type(scanner_t), intent(inout) :: scanner
      character(*), intent(in) :: file
      type(assignment_t), intent(inout) :: assignment
      type(fault_list_t), intent(inout) :: faults
      type(value_t), allocatable :: values(:), grown(:)
      type(value_t) :: value
      integer :: used, repeats
      logical :: comma_before, sound, closed

      allocate (values(8))
      used = 0
      sound = .true.
      comma_before = .true.
      do
         call scanner%skip_blanks()
         if (scanner%at_sign() .or. scanner%letter() == '/') exit
         if (scanner%letter() == ',' .or. scanner%letter() == ';') then
            if (scanner%letter() == ';' .and. sound) call refuse(no_semicolon)
            ! Nothing between two commas is a null value.
            if (comma_before) call append(value_t(), 1)
            comma_before = .true.
            assignment%has_comma = .true.
            call scanner%step()
            cycle
         end if
         if (scanner%key_follows()) exit
         call scanner%take_value(value, repeats, closed)
         if (.not. closed) then
            call refuse('the closing quote is missing')
            return
         end if
         call append(value, repeats)
         comma_before = .false.
      end do
      assignment%values = values(:used)
      if (used == 0 .and. sound) call refuse('a value is missing after the equals sign')
      assignment%sound = sound

   contains

      !> Put a value behind the others so often.
      subroutine append(value, repeats)
         type(value_t), intent(in) :: value
         integer, intent(in) :: repeats
         integer :: i

         if (.not. sound) return
         if (repeats < 1) then
            call refuse('the repeat count before a * must be a positive integer')
         else if (repeats > most_elements - used) then
            call refuse('at most '//integer_text(most_elements)//' values are allowed')
         end if
         if (.not. sound) return
         if (used + repeats > size(values)) then
            allocate (grown(2*(used + repeats)))
            grown(:used) = values(:used)
            call move_alloc(grown, values)
         end if
         do i = used + 1, used + repeats
            values(i) = value
         end do
         used = used + repeats
      end subroutine append

      subroutine refuse(message)
         character(*), intent(in) :: message

         sound = .false.
         call faults%add(file, assignment%line, assignment%group, assignment%key, message)
      end subroutine refuse

   end subroutine scan_values

   !> Text whose lines all end with a line feed, as they do on Unix: those of Windows end with one behind a carriage return,
   !> those of old Macs with a carriage return alone. The page feed of a printer and the end of a file of DOS become blanks.
   pure function with_line_feeds(content) result(text)
      character(*), intent(in) :: content
      character(:), allocatable :: text
      character(*), parameter :: carriage_return = achar(13), line_feed = achar(10), form_feed = achar(12), end_of_file = achar(26)
      integer :: i, used

      text = content
      used = 0
      do i = 1, len(content)
         if (content(i:i) == line_feed .and. i > 1) then
            if (content(i - 1:i - 1) == carriage_return) cycle
         end if
         used = used + 1
         text(used:used) = content(i:i)
         if (content(i:i) == carriage_return) text(used:used) = line_feed
         if (content(i:i) == form_feed .or. content(i:i) == end_of_file) text(used:used) = ' '
      end do
      text = text(:used)
   end function with_line_feeds

   !> Binary files and stray control characters are one fault, not hundreds.
   subroutine check_characters(content, file, first_line, faults, sound)
      character(*), intent(in) :: content
      character(*), intent(in) :: file
      integer, intent(in) :: first_line
      type(fault_list_t), intent(inout) :: faults
      logical, intent(out) :: sound
      integer :: i, line

      sound = .true.
      line = first_line
      do i = 1, len(content)
         associate (code => iachar(content(i:i)))
            if (code == 10) line = line + 1
            if ((code < 32 .and. code /= 9 .and. code /= 10 .and. code /= 13) .or. code == 127) then
               call faults%add(file, line, '', '', &
                               'not a text file: it holds the control character '//integer_text(code))
               sound = .false.
               return
            end if
         end associate
      end do
   end subroutine check_characters

end module namelist_text
