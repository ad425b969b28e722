!> Takes namelist text apart into assignments, each with its line, and reports every fault of the text.
!>
!> The runtime's own namelist reader stops at the first fault, takes a wrong value in the last group for
!> the end of the file, and accepts misspelt groups and repeated keys without a word; hence this one.
module namelist_text
   use errors, only: fault_list_t
   use namelist_scanner, only: new_scanner, scanner_t, value_t
   use text, only: integer_text, lower
   implicit none(type, external)
   private

   !> The group that may stand several times: each is a gear pair of its own.
   character(*), parameter, public :: repeated_group = 'gear'

   !> key = values, or key(index) = values.
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
      !> First element that is set; 0: no index was given
      integer :: first_element = 0
      !> Whether the index was (:, first_element): a column of a table
      logical :: whole_column = .false.
      type(value_t), allocatable :: values(:)
      !> Whether a comma stands among them
      logical :: has_comma = .false.
   end type assignment_t

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
      integer :: i, stray_line, used, earlier
      logical :: sound

      allocate (assignments(64))
      used = 0
      if (len_trim(content) == 0) then
         assignments = assignments(:0)
         call faults%add(file, 0, '', '', 'the file is empty; a scene needs at least its required groups')
         return
      end if
      text = with_line_feeds(content)
      call check_characters(text, file, first_line, faults, sound)
      if (.not. sound) then
         assignments = assignments(:0)
         return
      end if

      scanner = new_scanner(text, first_line)
      stray_line = -2
      do
         call scanner%skip_blanks()
         if (scanner%ended()) exit
         if (scanner%letter() /= '&') then
            ! Lines that follow each other are one fault, not one each.
            if (scanner%line > stray_line + 1) call faults%add(file, scanner%line, '', '', &
                                                               'text outside a group; a group starts with &name and ends with /')
            stray_line = scanner%line
            call scanner%skip_stray()
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
         earlier = 0
         do i = 1, used
            if (len(assignments(i)%key) > 0 .or. assignments(i)%group /= group) cycle
            earlier = earlier + 1
            if (group == repeated_group) cycle
            call faults%add(file, scanner%line, group, '', &
                            'this group stands in line '//integer_text(assignments(i)%line)//' already')
            exit
         end do
         call scan_group(scanner, file, group, earlier + 1, assignments, used, faults)
      end do
      assignments = assignments(:used)
   end subroutine scan_namelists

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
      integer :: first_line

      first_line = scanner%line
      assignment%group = group
      assignment%key = ''
      assignment%line = first_line
      call append(assignment)
      do
         call scanner%skip_blanks()
         if (scanner%letter() == ',') then
            call scanner%step()
            cycle
         end if
         if (scanner%at_new_group()) then
            call faults%add(file, first_line, group, '', 'this group is not closed by a /')
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

      assignment%sound = .false.
      assignment%group = group
      assignment%line = scanner%line
      assignment%key = lower(scanner%take_word())
      if (len(assignment%key) == 0) then
         call faults%add(file, scanner%line, group, '', &
                         "unexpected '"//scanner%letter()//"'; a key must stand here, as in key = value")
         call scanner%skip_line()
         return
      end if
      call scanner%skip_blanks()
      if (scanner%letter() == '(') then
         call scanner%take_index(assignment%first_element, assignment%whole_column)
         if (assignment%first_element < 1) then
            call faults%add(file, scanner%line, group, assignment%key, 'the index in parentheses must be one positive integer')
            call scanner%skip_line()
            return
         end if
         call scanner%skip_blanks()
      end if
      if (scanner%letter() /= '=') then
         call faults%add(file, assignment%line, group, assignment%key, 'an equals sign must follow the key')
         if (scanner%line == assignment%line) call scanner%skip_line()
         return
      end if
      call scanner%step()
      call scan_values(scanner, file, assignment, faults)
   end subroutine scan_assignment

   !> Values up to the next key, slash or group.
   subroutine scan_values(scanner, file, assignment, faults)
      type(scanner_t), intent(inout) :: scanner
      character(*), intent(in) :: file
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
         call scanner%skip_blanks()
         if (scanner%at_new_group()) exit
         if (scanner%letter() == '/') exit
         if (scanner%letter() == ',') then
            if (comma_before) then
               call faults%add(file, scanner%line, assignment%group, assignment%key, 'a value is missing before the comma')
               sound = .false.
            end if
            comma_before = .true.
            assignment%has_comma = .true.
            call scanner%step()
            cycle
         end if
         if (scanner%key_follows()) exit
         if (used == size(values)) then
            allocate (grown(2*used))
            grown(:used) = values
            call move_alloc(grown, values)
         end if
         used = used + 1
         call scanner%take_value(values(used), closed)
         if (.not. closed) then
            call faults%add(file, assignment%line, assignment%group, assignment%key, 'the closing quote is missing')
            return
         end if
         comma_before = .false.
      end do
      assignment%values = values(:used)
      if (used == 0 .and. sound) then
         call faults%add(file, assignment%line, assignment%group, assignment%key, &
                         'a value is missing after the equals sign')
         sound = .false.
      end if
      assignment%sound = sound
   end subroutine scan_values

   !> Text whose lines all end with a line feed, as they do on Unix: those of Windows end with one behind a carriage return,
   !> those of old Macs with a carriage return alone.
   pure function with_line_feeds(content) result(text)
      character(*), intent(in) :: content
      character(:), allocatable :: text
      character(*), parameter :: carriage_return = achar(13), line_feed = achar(10)
      integer :: i, used

      text = content
      used = 0
      do i = 1, len(content)
         if (content(i:i) == line_feed .and. i > 1) then
            if (content(i - 1:i - 1) == carriage_return) cycle
         end if
         used = used + 1
         text(used:used) = merge(line_feed, content(i:i), content(i:i) == carriage_return)
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
