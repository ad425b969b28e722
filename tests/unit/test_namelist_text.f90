!> Tests of the namelist scanner on small texts.
module test_namelist_text
   use checks, only: check_list_t
   use errors, only: fault_list_t
   use namelist_text, only: assignment_t, scan_namelists
   implicit none (type, external)
   private

   character(1), parameter :: end_of_line = achar(10), tab = achar(9), carriage_return = achar(13)

   public :: run_namelist_text_tests

contains

   !> Runs every test of this topic.
   subroutine run_namelist_text_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('namelist_text')
      call test_sound(checks)
      call test_values(checks)
      call test_line_ends(checks)
      call test_many(checks)
      call test_outside(checks)
      call test_faults(checks)
   end subroutine run_namelist_text_tests

   !> Two groups with comments, tabs, capitals, commas, an index, DOS line ends.
   subroutine test_sound(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      character(*), parameter :: text = '! first line'//end_of_line// &
         '&Load'//carriage_return//end_of_line// &
         tab//'MASS = 3.0, frequency=600 ! a / in a comment'//end_of_line// &
         '/'//end_of_line//end_of_line// &
         '&output columns(2) = ''time'' , "film" /'
      type(assignment_t), allocatable :: assignments(:)
      type(fault_list_t) :: faults

      call read_text(text, assignments, faults)
      call checks%check(faults%count() == 0, 'sound text')
      call checks%check(size(assignments) == 3, 'three assignments')
      if (size(assignments) /= 3) return
      call checks%check(assignments(1)%group == 'load' .and. assignments(1)%key == 'mass', &
         'names in lower case')
      call checks%check(all(assignments%line == [3, 3, 6]), 'lines')
      call checks%check(size(assignments(2)%subscripts) == 0 .and. assignments(3)%subscript_text == '(2)', 'index')
      call checks%check(assignments(2)%values(1)%text == '600' .and. .not. assignments(2)%values(1)%quoted, &
         'bare value')
      call checks%check(size(assignments(3)%values) == 2, 'two values')
      call checks%check(assignments(3)%values(1)%text == 'time' .and. assignments(3)%values(1)%quoted, &
         'quoted value')
      call checks%check(assignments(3)%values(2)%text == 'film', 'double quotes')
   end subroutine test_sound

   !> What quotes protect.
   subroutine test_values(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(assignment_t), allocatable :: assignments(:)
      type(fault_list_t) :: faults

      call read_text("&a k = 'it''s / & ! = ,' b = ""''"" c='' d = 1.0e-8/", assignments, faults)
      call checks%check(faults%count() == 0 .and. size(assignments) == 4, 'four values')
      if (size(assignments) /= 4) return
      call checks%check(assignments(1)%values(1)%text == "it's / & ! = ,", 'doubled quote and protected characters')
      call checks%check(assignments(2)%values(1)%text == "''", 'other quotes inside')
      call checks%check(assignments(3)%values(1)%text == '' .and. assignments(3)%values(1)%quoted, &
         'empty text')
      call checks%check(assignments(4)%values(1)%text == '1.0e-8', 'a slash ends a bare value')
   end subroutine test_values

   !> More assignments and values than the first lists hold.
   subroutine test_many(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(assignment_t), allocatable :: assignments(:)
      type(fault_list_t) :: faults
      character(:), allocatable :: text
      character(3) :: digits
      integer :: i
      logical :: in_order

      text = '&g'//end_of_line
      do i = 1, 150
         write (digits, '(i3.3)') i
         text = text//'k'//digits//' = '//digits//end_of_line
      end do
      text = text//'last = '//repeat('7 ', 40)//'/'
      call read_text(text, assignments, faults)
      call checks%check(faults%count() == 0 .and. size(assignments) == 151, 'many assignments')
      if (size(assignments) /= 151) return
      in_order = .true.
      do i = 1, 150
         write (digits, '(i3.3)') i
         in_order = in_order .and. assignments(i)%key == 'k'//digits .and. assignments(i)%line == i + 1 &
            .and. assignments(i)%values(1)%text == digits
      end do
      call checks%check(in_order, 'they keep their order while the list grows')
      call checks%check(size(assignments(151)%values) == 40, 'many values')
   end subroutine test_many

   !> Lines end as on Unix, Windows or an old Mac: a comment ends with its line, and faults have the same places.
   subroutine test_line_ends(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      character(2), parameter :: ends(3) = [character(2) :: achar(10), achar(13)//achar(10), achar(13)]
      type(assignment_t), allocatable :: assignments(:)
      type(fault_list_t) :: faults
      character(:), allocatable :: line_end
      integer :: i

      do i = 1, size(ends)
         line_end = trim(ends(i))
         call read_text('! comment'//line_end//'&g k=1 ! one'//line_end//line_end//'m=2 /'//line_end//'m=3', assignments, &
                        faults)
         call checks%check(size(assignments) == 2, 'a comment swallows nothing')
         if (size(assignments) /= 2) cycle
         call checks%check(assignments(1)%line == 2 .and. assignments(2)%line == 4, 'lines are counted')
         call checks%check(faults%count() == i, 'one fault behind the group')
         if (faults%count() == i) call checks%check(index(faults%sentence(i), 'f:5:') == 1, 'in the fifth line')
      end do
   end subroutine test_line_ends

   !> Text outside groups is passed over, and groups open and close as in old compilers.
   subroutine test_outside(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(assignment_t), allocatable :: assignments(:)
      type(fault_list_t) :: faults

      call read_text('Load case 3: Q & A, R&D for $5, it''s old; x == 3'//end_of_line//'===='//end_of_line// &
                     'a film of 2 = 3'//end_of_line//'# &gear k=3'//end_of_line//'some text &load k=1 / behind it'//end_of_line// &
                     '$h'//end_of_line//'  # k=2'//end_of_line//'l=2 ! /'//end_of_line//'&end &i m=3 $END'//achar(12)// &
                     end_of_line//'/'//end_of_line//'&end'//end_of_line//'$ rattle'//end_of_line//achar(26), assignments, faults)
      call checks%check(faults%count() == 0, 'text outside groups')
      if (faults%count() > 0) call checks%check(.false., faults%sentence(1))
      call checks%check(size(assignments) == 3, 'three groups')
      if (size(assignments) /= 3) return
      call checks%check(all(assignments%line == [5, 8, 9]), 'lines of groups among text')
   end subroutine test_outside

   !> Every fault is found at its line, and the text after it is still read.
   subroutine test_faults(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call expect('', 1, 0, 'f: the file is empty', 'empty text')
      call expect('   '//end_of_line, 0, 0, '', 'blank lines only hold nothing')
      call expect('stray'//end_of_line//'more', 1, 0, 'f:1: text outside', 'text without any group')
      call expect('k = 1'//end_of_line//'&g k=1 /', 1, 1, 'f:1: text outside', 'key outside a group')
      call expect('k(1) = 1'//end_of_line//'m=1'//end_of_line//'&g k=1 /', 1, 1, 'f:1: text outside', 'lines that follow are one')
      call expect('%load k=1 /'//end_of_line//'&g k=1 /', 1, 1, 'f:1: text outside', 'another sign')
      call expect('load k = 1 /'//end_of_line//'&g k=1 /', 1, 1, 'f:1: text outside', 'no sign')
      call expect('Laod'//end_of_line//'&g k=1 /', 1, 1, 'f:1: text outside', 'no sign, misspelt, alone on its line')
      call expect('&g k=1 / load ! the next'//end_of_line, 1, 1, 'f:1: text outside', 'no sign, behind a group')
      call expect('&'//end_of_line//'&g k=1 /', 1, 1, 'f:1: a group name must follow', 'group without a name')
      call expect('&g k=1 /'//end_of_line//'&g m=2 /', 1, 2, 'f:2: &g: this group is already in line 1', &
         'group twice')
      call expect('&g k=1'//end_of_line//'&h m=2 /', 1, 2, 'f:1: &g: this group is not closed', 'open group')
      call expect('&g k=1', 1, 1, 'f:1: &g: this group is not closed', 'open at the end')
      call expect('&g k=1 &ending', 2, 1, 'f:1: &g: this group is not closed', 'a longer word is no end')
      call expect('&g'//end_of_line//'k 1'//end_of_line//'m=2 /', 1, 1, 'f:2: &g k: an equals sign', &
         'no equals sign')
      call expect('&g k 1 /', 1, 0, 'f:1: &g k: an equals sign', 'no equals sign in one line')
      call expect('&g'//end_of_line//'= 1'//end_of_line//'m=2 /', 1, 1, 'f:2: &g: unexpected ''=''', 'no key')
      call expect('&g k = m=2 /', 1, 1, 'f:1: &g k: a value is missing', 'no value')
      call expect('&g k = ''abc'//end_of_line//'m=2 /', 1, 1, 'f:1: &g k: the closing quote', 'open quote')
      call expect('&g k = 1; 2; m=2 /', 1, 1, 'f:1: &g k: a semicolon separates', 'semicolons')
      call expect('&g k = 0*1 m=2 /', 1, 1, 'f:1: &g k: the repeat count', 'repeat count of none')
      call expect('&g k = 99999999999*1 m=2 /', 1, 1, 'f:1: &g k: the repeat count', 'repeat count beyond integers')
      call expect('&g k = 3*1 1000000*2 m=2 /', 1, 1, 'f:1: &g k: at most 1000000', 'too many values')
      call expect('&g k(0) = 1'//end_of_line//'m=2 /', 1, 1, 'f:1: &g k: the index', 'index 0')
      call expect('&g k(9223372036854775807) = 1 m=2 /', 1, 1, 'f:1: &g k: the index', 'index beyond integers, one fault')
      call expect('&g k(1:2:0) = 1 m=2 /', 1, 1, 'f:1: &g k: the index', 'stride 0')
      call expect('&g k(3:1) = 1 m=2 /', 1, 1, 'f:1: &g k: the index', 'section without elements')
      call expect('&g k(::-1) = 1 m=2 /', 1, 1, 'f:1: &g k: the index', 'backwards from nowhere')
      call expect('&g k(1:2:3:4) = 1 m=2 /', 1, 1, 'f:1: &g k: the index', 'four parts')
      call expect('&g k() = 1 m=2 /', 1, 1, 'f:1: &g k: the index', 'no index')
      call expect('&g k(x) = 1 m=2 /', 1, 1, 'f:1: &g k: the index', 'a word')
      call expect('&g k(:,) = 1'//end_of_line//'m=2 /', 1, 1, 'f:1: &g k: the index', 'column with an empty number')
      call expect('&g k(1 = 2 /', 1, 0, 'f:1: &g k: the index', 'open parenthesis')
      call expect('&g k=1'//end_of_line//achar(0)//' /', 1, 0, 'f:2: not a text file', 'binary file')

   contains

      !> One text: how many faults, how many assignments, and how the first fault begins.
      subroutine expect(text, fault_count, assignment_count, beginning, message)
         character(*), intent(in) :: text         !> Text to scan
         integer, intent(in) :: fault_count       !> Faults in it
         integer, intent(in) :: assignment_count  !> Assignments that are still read
         character(*), intent(in) :: beginning    !> Of the first fault; empty: not looked at
         character(*), intent(in) :: message      !> What is wrong with the text

         type(assignment_t), allocatable :: assignments(:)
         type(fault_list_t) :: faults

         call read_text(text, assignments, faults)
         if (fault_count > 0) call checks%check(faults%count() == fault_count, message//': number of faults')
         call checks%check(size(assignments) == assignment_count, message//': number of assignments')
         if (len(beginning) > 0 .and. faults%count() > 0) &
            call checks%check(index(faults%sentence(1), beginning) == 1, message//': '//faults%sentence(1))
      end subroutine expect

   end subroutine test_faults

   !> Scan a text; keep the assignments that could be taken apart.
   subroutine read_text(text, kept, faults)
      character(*), intent(in) :: text                            !> Text to scan
      type(assignment_t), allocatable, intent(out) :: kept(:)     !> Its sound assignments
      type(fault_list_t), intent(inout) :: faults                 !> Faults are appended

      type(assignment_t), allocatable :: assignments(:)
      integer :: i, used

      call scan_namelists(text, 'f', 1, assignments, faults)
      allocate (kept(count(is_sound(assignments))))
      used = 0
      do i = 1, size(assignments)
         if (.not. is_sound(assignments(i))) cycle
         used = used + 1
         kept(used) = assignments(i)
      end do
   end subroutine read_text

   !> Whether an element stands for a key with values, and not for the opening of a group or a fault.
   elemental logical function is_sound(assignment)
      type(assignment_t), intent(in) :: assignment  !> Element of the scanned list

      is_sound = assignment%sound .and. len(assignment%key) > 0
   end function is_sound

end module test_namelist_text
