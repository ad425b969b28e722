! Thin layer between the reader of CSV files and f2py: plain arguments, explicit sizes, no derived types.

! Read a CSV file, in which a field may be empty. First with no room, for its counts of rows and columns and the line of its
! header; then with room for both. A file that cannot be read has no rows, and its faults as lines.
subroutine wrap_read_csv(path, example, rows, columns, counts, faults, names, units, values, lines)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use csv_table, only: csv_table_t, read_csv_table
   use errors, only: fault_list_t
   implicit none
   character(*), intent(in) :: path
   character(*), intent(in) :: example
   integer(c_int), intent(in) :: rows
   integer(c_int), intent(in) :: columns
   integer(c_int), intent(out) :: counts(3)
   character(16384), intent(out) :: faults
   character(96), intent(out) :: names(columns)
   character(96), intent(out) :: units(columns)
   real(c_double), intent(out) :: values(rows, columns)
   integer(c_int), intent(out) :: lines(rows)
   type(csv_table_t) :: table
   type(fault_list_t) :: found
   integer :: i, used

   counts = 0
   faults = ''
   names = ''
   units = ''
   values = 0.0_c_double
   lines = 0
   call read_csv_table(path, example, '', table, found, gaps_allowed=.true.)
   used = 0
   do i = 1, found%count()
      if (used + len(found%sentence(i)) + 1 > len(faults)) exit
      faults(used + 1:) = found%sentence(i)//new_line('a')
      used = used + len(found%sentence(i)) + 1
   end do
   if (found%count() > 0) return
   counts = [size(table%lines), size(table%names), table%header]
   if (rows /= counts(1) .or. columns /= counts(2)) return
   do i = 1, columns
      names(i) = table%names(i)%text
      units(i) = table%units(i)%text
   end do
   values = table%values
   lines = table%lines
end subroutine wrap_read_csv

! What a column is called without its unit, and what makes its numbers such of the unit that is needed: a factor, and what is
! added behind; or why nothing does.
subroutine wrap_column_unit(head, below, needed, name, unit, conversion_of, message)
   use, intrinsic :: iso_c_binding, only: c_double
   use column_head, only: column_head_t, conversion, head_of
   implicit none
   character(*), intent(in) :: head
   character(*), intent(in) :: below
   character(*), intent(in) :: needed
   character(96), intent(out) :: name
   character(96), intent(out) :: unit
   real(c_double), intent(out) :: conversion_of(2)
   character(256), intent(out) :: message
   type(column_head_t) :: found
   character(:), allocatable :: words

   found = head_of(head, trim(below), needed)
   name = found%name
   unit = found%word
   call conversion(found, needed, conversion_of(1), conversion_of(2), words)
   message = words
end subroutine wrap_column_unit
