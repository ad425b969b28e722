!> Which keys two resolved inputs differ in.
module input_difference
   use errors, only: fault_list_t
   use namelist_text, only: assignment_t, scan_namelists
   use text, only: counted, integer_text
   implicit none(type, external)
   private

   !> Keys that are named with their values; more are counted.
   integer, parameter :: most_reported = 4

   !> Keys whose files hold tables, of which the rows stand as comments in a resolved input
   character(*), parameter :: tables(2) = [character(15) :: 'gear.drag_table', 'shaft.table']

   public :: differing_keys

contains

   !> The keys that differ, with both values: 'load.mass is 4.0 now and was 3.0; ...'; empty if none does.
   function differing_keys(stored, current, free) result(sentence)
      !> Resolved input of an earlier run
      character(*), intent(in) :: stored
      !> Resolved input of this run
      character(*), intent(in) :: current
      !> Keys that may differ, as group.key
      character(*), optional, intent(in) :: free(:)
      character(:), allocatable :: sentence
      type(assignment_t), allocatable :: old(:), new(:)
      type(fault_list_t) :: ignored
      integer :: i, place, reported

      call scan_namelists(stored, '', 1, old, ignored)
      call scan_namelists(current, '', 1, new, ignored)
      sentence = ''
      reported = 0
      do i = 1, size(new)
         if (len(new(i)%key) == 0 .or. may_differ(new(i), free)) cycle
         place = find(old, new(i))
         if (place == 0) then
            call report(key_name(new(i))//' is '//values_text(new(i))//' now and was not set')
         else if (values_text(old(place)) /= values_text(new(i))) then
            call report(different_values(old(place), new(i)))
         end if
      end do
      do i = 1, size(old)
         if (len(old(i)%key) == 0 .or. may_differ(old(i), free)) cycle
         if (find(new, old(i)) == 0) call report(key_name(old(i))//' was '//values_text(old(i))//' and is not set now')
      end do
      do i = 1, size(tables)
         if (lines_of(stored, trim(tables(i))) /= lines_of(current, trim(tables(i)))) &
            call report(trim(tables(i))//' holds other rows now')
      end do
      if (reported > most_reported) sentence = sentence//'; and '//counted(reported - most_reported, 'key')//' more'

   contains

      !> Put a difference behind the others.
      subroutine report(words)
         character(*), intent(in) :: words

         reported = reported + 1
         if (reported > most_reported) return
         if (reported > 1) sentence = sentence//'; '
         sentence = sentence//words
      end subroutine report

   end function differing_keys

   !> What is reported of the rows of a table, which stand in a file of their own.
   pure function lines_of(input, table) result(lines)
      !> Resolved input
      character(*), intent(in) :: input
      !> Key of the table
      character(*), intent(in) :: table
      character(:), allocatable :: lines
      character(:), allocatable :: opening
      integer :: first, last, place

      opening = '! derived: '//table//' '
      lines = ''
      first = 1
      do
         place = index(input(first:), opening)
         if (place == 0) exit
         first = first + place - 1
         last = first + index(input(first:)//new_line('a'), new_line('a')) - 1
         lines = lines//input(first:min(last, len(input)))
         first = min(last, len(input)) + 1
      end do
   end function lines_of

   !> Both values of a key; of long lists of one length the first ones that differ.
   pure function different_values(old, new) result(sentence)
      type(assignment_t), intent(in) :: old
      type(assignment_t), intent(in) :: new
      character(:), allocatable :: sentence
      integer, parameter :: long = 3
      integer :: i

      sentence = key_name(new)//' is '//values_text(new)//' now and was '//values_text(old)
      if (size(new%values) < long .or. size(new%values) /= size(old%values)) return
      do i = 1, size(new%values)
         if (.not. (allocated(new%values(i)%text) .and. allocated(old%values(i)%text))) return
         if (new%values(i)%text == old%values(i)%text) cycle
         sentence = key_name(new)//'('//integer_text(i)//') is '//new%values(i)%text//' now and was '//old%values(i)%text
         return
      end do
   end function different_values

   !> Whether a key is one of those that may differ.
   pure logical function may_differ(assignment, free)
      type(assignment_t), intent(in) :: assignment
      character(*), optional, intent(in) :: free(:)

      may_differ = .false.
      if (present(free)) may_differ = any(free == assignment%group//'.'//assignment%key)
   end function may_differ

   !> Place of the assignment to the same key, 0 if there is none.
   pure integer function find(assignments, sought)
      type(assignment_t), intent(in) :: assignments(:)
      type(assignment_t), intent(in) :: sought

      do find = 1, size(assignments)
         if (key_name(assignments(find)) == key_name(sought)) return
      end do
      find = 0
   end function find

   pure function key_name(assignment) result(name)
      type(assignment_t), intent(in) :: assignment
      character(:), allocatable :: name

      name = assignment%group
      if (assignment%occurrence > 1) name = name//'('//integer_text(assignment%occurrence)//')'
      name = name//'.'//assignment%key//assignment%subscript_text
   end function key_name

   !> Values as they stand, with commas between.
   pure function values_text(assignment) result(words)
      type(assignment_t), intent(in) :: assignment
      character(:), allocatable :: words
      integer :: i

      words = ''
      if (.not. allocated(assignment%values)) return
      do i = 1, size(assignment%values)
         if (i > 1) words = words//', '
         if (allocated(assignment%values(i)%text)) words = words//assignment%values(i)%text
      end do
   end function values_text

end module input_difference
