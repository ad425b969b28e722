!> Scenes from a CSV file: a header of group.key names, perhaps with units or a row of units below, then one line of numbers for every
!> scene. Separators, quotes and decimal marks are those of all CSV files; comments and empty lines are refused, as a scene is known by
!> its line. Every fault is reported with its line and column. The text is read in blocks.
module csv_samples
   use column_head, only: column_head_t, conversion, head_of
   use csv_fields, only: csv_text_t, field_t
   use csv_table, only: cause_of_count, is_row_of_units
   use errors, only: error_t, fault_list_t
   use key_table, only: key_name, keys
   use kinds, only: dp, int64
   use memory, only: expect_memory
   use number_text, only: read_strict_integer
   use signals, only: must_stop
   use text, only: integer_text, lower, printable
   use varied_keys, only: find_varied_key, is_whole
   use word_list, only: word_t
   implicit none(type, external)
   private

   !> More columns than a campaign could vary are no header.
   integer, parameter :: most_columns = 32
   !> A number as it is read, in the plan of the scenes, and on the way from here to there [bytes]
   real(dp), parameter :: number_bytes = 24.0_dp

   !> The scenes of a file.
   type, public :: csv_samples_t
      !> Key of every column, by its position in the key table
      integer, allocatable :: positions(:)
      !> (column, scene), in the units of the keys
      real(dp), allocatable :: values(:, :)
      !> Scenes that were read: fewer than there are where the reading had to stop
      integer(int64) :: read = 0_int64
      !> Line of the first scene
      integer :: first_line = 2
      !> What was converted, a line each
      type(word_t), allocatable :: notes(:)
   end type csv_samples_t

   public :: read_csv_samples

contains

   !> Read a file; its faults are added to the list.
   subroutine read_csv_samples(path, samples, faults)
      !> Path of the file
      character(*), intent(in) :: path
      !> The scenes; of use only if no fault was added
      type(csv_samples_t), intent(out) :: samples
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      type(csv_text_t) :: text
      type(field_t), allocatable :: names(:), fields(:)
      character(:), allocatable :: message
      integer(int64) :: lines
      integer :: before, columns, count

      before = faults%count()
      allocate (samples%positions(0), samples%values(0, 0), samples%notes(0))
      call text%open(path, lines, message)
      if (len(message) == 0 .and. lines == 0_int64) &
         message = 'the file is empty; its first line must name the keys, such as load.mass,load.frequency'
      if (len(message) > 0) then
         call faults%add(path, 0, '', '', message)
         return
      end if
      call text%take_line(names, columns)
      if (text%stopped) then
         call faults%add(path, 1, '', '', 'there was no time to read the first line to its end')
      else if (columns > most_columns) then
         call faults%add(path, 1, '', '', 'more than '//integer_text(most_columns)//' columns')
      else if (lines == 1_int64) then
         allocate (fields(columns))
         call read_header(names(:columns), fields, path, samples, faults)
         if (faults%count() == before) call faults%add(path, 1, '', '', 'there is no line of numbers after the header')
      else
         call text%take_line(fields, count)
         if (.not. text%stopped) call read_below(text, names(:columns), fields, count, lines, path, samples, faults)
      end if
      call text%close()
   end subroutine read_csv_samples

   !> Read the header and what is below it, of which the first line is there already.
   subroutine read_below(text, names, fields, count, lines, path, samples, faults)
      type(csv_text_t), intent(inout) :: text
      type(field_t), intent(in) :: names(:)
      type(field_t), allocatable, intent(inout) :: fields(:)
      integer, intent(inout) :: count
      integer(int64), intent(in) :: lines
      character(*), intent(in) :: path
      type(csv_samples_t), intent(inout) :: samples
      type(fault_list_t), intent(inout) :: faults
      type(field_t), allocatable :: units(:)
      real(dp), allocatable :: factors(:, :)
      type(error_t), allocatable :: error
      integer :: before

      before = faults%count()
      allocate (units(size(names)))
      if (count == size(names)) then
         if (is_row_of_units(fields(:count))) then
            units = fields(:count)
            samples%first_line = 3
         end if
      end if
      call read_header(names, units, path, samples, faults, factors)
      if (faults%count() > before) return
      call expect_memory(number_bytes*real(size(names), dp)*real(lines, dp), &
                         'this table of '//integer_text(lines)//' lines (&campaign csv)', error)
      if (allocated(error)) then
         call faults%add_error(path, '', '', error)
         return
      end if
      deallocate (samples%values)
      allocate (samples%values(size(names), lines - int(samples%first_line - 1, int64)))
      if (size(samples%values, 2) == 0) call faults%add(path, 2, '', '', 'there is no line of numbers after the row of units')
      if (samples%first_line > 2) call text%take_line(fields, count)
      call read_rows(text, path, fields, count, factors, samples, faults)
   end subroutine read_below

   !> First line: the keys, each with its unit.
   subroutine read_header(names, units, path, samples, faults, factors)
      type(field_t), intent(in) :: names(:)
      !> What stands below them in a row of units, empty fields if there is none
      type(field_t), intent(in) :: units(:)
      character(*), intent(in) :: path
      type(csv_samples_t), intent(inout) :: samples
      type(fault_list_t), intent(inout) :: faults
      !> (1: multiplies the numbers of a column, 2: is added behind; column)
      real(dp), allocatable, intent(out), optional :: factors(:, :)
      type(column_head_t) :: head
      character(:), allocatable :: message, word
      real(dp) :: of_column(2)
      integer :: position, i, column

      if (present(factors)) allocate (factors(2, size(names)), source=0.0_dp)
      do column = 1, size(names)
         call read_name(names(column), units(column)%unit(), position, head, message)
         do i = 1, size(samples%positions)
            if (position > 0 .and. samples%positions(i) == position) &
               message = 'this key is already in column '//integer_text(i)
         end do
         of_column = 0.0_dp
         word = names(column)%shown()
         if (position > 0 .and. len(message) == 0) then
            call conversion(head, trim(keys(position)%unit), of_column(1), of_column(2), message)
            if (len(message) == 0 .and. is_whole(position) .and. abs(of_column(1) - 1.0_dp) > 0.0_dp) &
               message = 'it is in '//head%word//'; whole numbers are needed'
            if (abs(of_column(1) - 1.0_dp) > 0.0_dp .or. abs(of_column(2)) > 0.0_dp) samples%notes = [samples%notes, &
               word_t(printable(path, .false.)//': column '//integer_text(column)//', '//key_name(position)// &
                      ', is converted from '//head%word//' to '//trim(keys(position)%unit))]
         end if
         if (present(factors)) factors(:, column) = of_column
         if (len(message) > 0 .and. len(names(column)%bare()) > 0) message = "'"//word//"': "//message
         ! A column that cannot be used keeps its place.
         samples%positions = [samples%positions, position]
         if (len(message) > 0) call faults%add(path, 1, '', '', 'column '//integer_text(column)//': '//message)
      end do
   end subroutine read_header

   !> One name of the header: a key, perhaps with a unit behind it.
   pure subroutine read_name(field, row, position, head, message)
      type(field_t), intent(in) :: field
      !> Its unit in a row of units; empty if there is none
      character(*), intent(in) :: row
      !> Position of the key, 0 if there is none
      integer, intent(out) :: position
      type(column_head_t), intent(out) :: head
      !> What is wrong with it; empty if nothing is
      character(:), allocatable, intent(out) :: message
      character(:), allocatable :: word, ignored, name
      integer :: cut

      position = 0
      word = field%bare()
      head%name = ''
      head%word = ''
      message = ''
      if (len(word) == 0) then
         message = 'a key must be named here, as in load.mass'
      else if (scan(word(1:1), '#!') > 0) then
         message = 'comments are not allowed'
      else if (index(word, achar(9)) > 0) then
         message = 'tabs separate the columns; commas or semicolons are needed'
      else
         call find_varied_key(word, position, message)
      end if
      if (position > 0) head = head_of('', row, trim(keys(position)%unit))
      if (len(message) == 0 .or. index(word, '.') == 0) return
      ! What stands behind the name of a key is its unit.
      cut = len(word) + 1
      do
         cut = scan(word(:cut - 1), '_ [(/', back=.true.)
         if (cut < 2) return
         name = trim(word(:cut - 1))
         call find_varied_key(name, position, ignored)
         if (position > 0) exit
      end do
      head = head_of(word, row, trim(keys(position)%unit))
      if (lower(head%name) == lower(name)) then
         message = ''
      else
         position = 0
      end if
   end subroutine read_name

   !> All other lines: numbers.
   subroutine read_rows(text, path, fields, count, factors, samples, faults)
      type(csv_text_t), intent(inout) :: text
      character(*), intent(in) :: path
      !> The fields of the first of them
      type(field_t), allocatable, intent(inout) :: fields(:)
      integer, intent(inout) :: count
      !> (1: multiplies the numbers of a column, 2: is added behind; column)
      real(dp), intent(in) :: factors(:, :)
      type(csv_samples_t), intent(inout) :: samples
      type(fault_list_t), intent(inout) :: faults
      character(:), allocatable :: message
      integer(int64) :: row
      integer :: column, columns, line

      columns = size(samples%positions)
      do row = 1_int64, size(samples%values, 2, kind=int64)
         if (row > 1_int64) call text%take_line(fields, count)
         if (text%stopped .or. must_stop()) return
         line = int(min(row + int(samples%first_line - 1, int64), int(huge(1), int64)))
         if (text%broken) then
            call faults%add(path, line, '', '', 'it cannot be read to its end')
            return
         end if
         if (count == 1 .and. len(fields(1)%word()) == 0) then
            call faults%add(path, line, '', '', 'the line is empty; every line must hold one scene')
         else if (count /= columns) then
            call faults%add(path, line, '', '', 'the line has '//integer_text(count)//' columns, the header '// &
                            integer_text(columns)//cause_of_count(fields(:min(count, size(fields))), columns, text%separator))
         else
            do column = 1, columns
               call read_number(text, fields(column), samples%positions(column), samples%values(column, row), message)
               if (len(message) > 0) call faults%add(path, line, '', '', 'column '//integer_text(column)//' ('// &
                                                     key_name(samples%positions(column))//'): '//message)
            end do
            samples%values(:, row) = factors(1, :)*samples%values(:, row) + factors(2, :)
         end if
         samples%read = row
         ! What comes after a full list of faults is not reported anyway.
         if (faults%not_kept() > 0) return
      end do
   end subroutine read_rows

   !> One number of a key.
   subroutine read_number(text, field, position, number, message)
      type(csv_text_t), intent(inout) :: text
      type(field_t), intent(in) :: field
      integer, intent(in) :: position
      real(dp), intent(out) :: number
      !> What is wrong with it; empty if nothing is
      character(:), allocatable, intent(out) :: message
      integer :: whole
      logical :: sound

      message = ''
      if (is_whole(position)) then
         call read_strict_integer(field%bare(), whole, sound)
         number = real(whole, dp)
      else
         call text%read_number(field, number, sound)
      end if
      if (sound) return
      if (len(field%bare()) == 0) then
         message = 'a number is missing'
      else if (text%has_both_marks) then
         message = 'some numbers have a decimal point, others a decimal comma'
      else if (is_whole(position)) then
         message = "'"//field%shown()//"' is not an integer"
      else
         message = "'"//field%shown()//"' is not a number"
      end if
   end subroutine read_number

end module csv_samples
