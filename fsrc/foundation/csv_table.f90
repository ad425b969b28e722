!> A table of numbers from a CSV file: a header with names, then a line of numbers for each row.
module csv_table
   use csv_fields, only: csv_text_t, field_t
   use csv_lines, only: next_line, read_names, take_number, wrong_count
   use errors, only: fault_list_t
   use kinds, only: dp, int64
   use text, only: integer_text
   use word_list, only: word_t
   implicit none(type, external)
   private

   integer, parameter :: most_lines = 20000

   !> What a file holds.
   type, public :: csv_table_t
      !> Names of the columns, and the line of the header
      type(word_t), allocatable :: names(:)
      integer :: header = 0
      !> (row, column), and the line of each row
      real(dp), allocatable :: values(:, :)
      integer, allocatable :: lines(:)
   end type csv_table_t

   public :: read_csv_table

contains

   !> Read all columns.
   subroutine read_csv_table(path, example, table, faults)
      !> Path of the file
      character(*), intent(in) :: path
      !> A header as it may be
      character(*), intent(in) :: example
      !> What it holds; of use only if no fault was added
      type(csv_table_t), intent(out) :: table
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      type(csv_text_t) :: text
      type(field_t), allocatable :: fields(:)
      character(:), allocatable :: message
      integer(int64) :: lines
      integer :: before, line, count

      before = faults%count()
      allocate (table%names(0), table%values(0, 0), table%lines(0))
      call text%open(path, lines, message)
      if (len(message) == 0 .and. lines > int(most_lines, int64)) message = 'it has more than '//integer_text(most_lines)// &
                                                                            ' lines; that is no table of a test stand'
      if (len(message) > 0) then
         call faults%add(path, 0, '', '', message)
         call text%close()
         return
      end if
      line = 0
      call next_line(text, int(lines), line, fields, count)
      table%header = line
      call read_names(path, line, example, fields(:count), table%names, faults)
      if (faults%count() == before) call read_rows(text, path, int(lines), line, table, faults)
      call text%close()
      if (faults%count() == before .and. size(table%lines) == 0) &
         call faults%add(path, table%header, '', '', 'there is no line of numbers after the header')
   end subroutine read_csv_table

   !> All lines behind the header.
   subroutine read_rows(text, path, lines, line, table, faults)
      type(csv_text_t), intent(inout) :: text
      character(*), intent(in) :: path
      integer, intent(in) :: lines
      integer, intent(inout) :: line
      type(csv_table_t), intent(inout) :: table
      type(fault_list_t), intent(inout) :: faults
      type(field_t), allocatable :: fields(:)
      character(:), allocatable :: message
      real(dp), allocatable :: values(:, :)
      integer :: rows(lines), row, column, columns
      logical :: is_hopeless

      allocate (values(lines, size(table%names)))
      row = 0
      do
         call next_line(text, lines, line, fields, columns)
         if (text%broken) call faults%add(path, line, '', '', 'it cannot be read to its end')
         if (text%stopped) call faults%add(path, line, '', '', 'there was no time to read it to its end')
         if (columns == 0 .or. text%broken .or. text%stopped .or. faults%not_kept() > 0) exit
         row = row + 1
         rows(row) = line
         is_hopeless = columns /= size(table%names)
         if (is_hopeless) call faults%add(path, line, '', '', wrong_count(fields(:columns), size(table%names)))
         do column = 1, size(table%names)
            if (is_hopeless) exit
            call take_number(fields(:columns), column, row == 1, values(row, column), message, is_hopeless)
            if (len(message) > 0) call faults%add(path, line, '', '', message)
         end do
         if (is_hopeless) exit
      end do
      table%values = values(:row, :)
      table%lines = rows(:row)
   end subroutine read_rows

end module csv_table
