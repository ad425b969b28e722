!> Numbers of a CSV file as people write it: a header with names, perhaps a row of units, then lines of numbers. Lines that begin with
!> '#' are comments, empty ones are skipped. What is wrong is reported with its line and column, never with what stands there: a path may
!> lead to a file that is private.
module csv_table
   use csv_fields, only: csv_text_t, field_t
   use errors, only: fault_list_t
   use kinds, only: dp, int64
   use number_text, only: read_strict_real
   use text, only: integer_text
   use unit_text, only: unit_of_text, unit_t
   use word_list, only: word_t
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   implicit none(type, external)
   private

   integer, parameter :: most_lines_of_tables = 20000
   character(*), parameter :: decimal_commas = ': decimal commas are read only where semicolons separate the columns; '// &
                                               'write decimal points, or semicolons'

   !> What a file holds.
   type, public :: csv_table_t
      !> Names of the columns, without quotes around them, and the line of the header
      type(word_t), allocatable :: names(:)
      integer :: header = 0
      !> Units of the columns in a row below; all are empty if there is none
      type(word_t), allocatable :: units(:)
      !> (row, column), and the line of each row
      real(dp), allocatable :: values(:, :)
      integer, allocatable :: lines(:)
      !> Most significant digits of a number in the last column that was read, and most of them behind its point
      integer :: most_digits = 0, most_decimals = -range(1.0_dp)
      logical, private :: gaps_allowed = .false.
      type(csv_text_t), private :: text
      character(:), allocatable, private :: path
      !> What mends a file that cannot be read, as the end of a sentence
      character(:), allocatable, private :: remedy
      !> Lines of the file, and the one that was read last
      integer, private :: line_count = 0, line = 0
      !> Fields of that line, and how many it has; 0: the file has ended
      type(field_t), allocatable, private :: fields(:)
      integer, private :: columns = 0
   contains
      procedure :: open => open_table
      procedure :: has_numbers
      procedure :: read => read_rows
      procedure :: close => close_table
      procedure, private :: next_line
      procedure, private :: read_names
      procedure, private :: take_units
      procedure, private :: refuse
   end type csv_table_t

   public :: read_csv_table, is_row_of_units, cause_of_count

contains

   !> Read all columns of a table.
   subroutine read_csv_table(path, example, remedy, table, faults, gaps_allowed)
      !> Path of the file
      character(*), intent(in) :: path
      !> A header as it may be
      character(*), intent(in) :: example
      !> What makes such a table, as the end of a sentence; may be empty
      character(*), intent(in) :: remedy
      !> What it holds; of use only if no fault was added
      type(csv_table_t), intent(out) :: table
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      !> Whether a field may be empty, which is not a number then; absent: no
      logical, intent(in), optional :: gaps_allowed
      integer :: before, i

      before = faults%count()
      if (present(gaps_allowed)) table%gaps_allowed = gaps_allowed
      call table%open(path, most_lines_of_tables, 'too many for a table', example, remedy, faults)
      if (faults%count() == before) call table%read([(i, i=1, size(table%names))], faults)
      call table%close()
      if (faults%count() == before .and. size(table%lines) == 0) &
         call faults%add(path, table%header, '', '', 'there is no line of numbers after the header')
   end subroutine read_csv_table

   !> Open a file, and read its header and the line behind it.
   subroutine open_table(self, path, most_lines, verdict, example, remedy, faults)
      class(csv_table_t), intent(inout) :: self
      character(*), intent(in) :: path
      !> Lines that it has at most, and what a file with more of them is
      integer, intent(in) :: most_lines
      character(*), intent(in) :: verdict
      !> A header as it may be
      character(*), intent(in) :: example
      !> What mends it if it cannot be read, as the end of a sentence; may be empty
      character(*), intent(in) :: remedy
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      character(:), allocatable :: message
      integer(int64) :: lines

      self%path = path
      self%remedy = remedy
      allocate (self%names(0), self%units(0), self%values(0, 0), self%lines(0), self%fields(2))
      call self%text%open(path, lines, message)
      if (len(message) == 0 .and. lines > int(most_lines, int64)) &
         message = 'it has more than '//integer_text(most_lines)//' lines; '//verdict
      if (len(message) > 0) then
         call faults%add(path, 0, '', '', message)
         return
      end if
      self%line_count = int(lines)
      call self%next_line()
      self%header = self%line
      call self%read_names(example, faults)
      call self%next_line()
      call self%take_units()
   end subroutine open_table

   !> Close the file.
   subroutine close_table(self)
      class(csv_table_t), intent(inout) :: self

      call self%text%close()
   end subroutine close_table

   !> Read the next line that is neither a comment nor empty; without any field at the end of the file.
   subroutine next_line(self)
      class(csv_table_t), intent(inout) :: self
      character(:), allocatable :: first

      self%columns = 0
      do while (self%line < self%line_count .and. .not. (self%text%broken .or. self%text%stopped))
         self%line = self%line + 1
         call self%text%take_line(self%fields, self%columns)
         first = self%fields(1)%word()
         if (.not. (index(first, '#') == 1 .or. (self%columns == 1 .and. len(first) == 0))) return
         self%columns = 0
      end do
   end subroutine next_line

   !> The header.
   subroutine read_names(self, example, faults)
      class(csv_table_t), intent(inout) :: self
      character(*), intent(in) :: example
      type(fault_list_t), intent(inout) :: faults
      character(:), allocatable :: message
      real(dp) :: number
      logical :: sound
      integer :: i

      message = ''
      deallocate (self%names, self%units)
      allocate (self%names(min(self%columns, size(self%fields))))
      allocate (self%units(size(self%names)))
      do i = 1, size(self%names)
         self%names(i)%text = self%fields(i)%bare()
         self%units(i)%text = ''
         if (len(message) > 0) cycle
         call read_strict_real(self%text%numeral(self%fields(i)), number, sound)
         if (sound) message = 'the first line holds numbers; it must name the columns, such as '//example
         if (index(self%names(i)%text, achar(0)) > 0) message = 'it is not plain text; save it as CSV in UTF-8'
         if (index(self%names(i)%text, achar(13)) > 0) message = 'carriage returns alone end its lines; line feeds are needed'
         if (len(message) > 0) message = message//self%remedy
      end do
      if (self%columns > size(self%names)) message = 'it has more than '//integer_text(size(self%names))//' columns'
      if (len(message) == 0) message = wrong_separator(self%fields(:size(self%names)), self%text%separator)
      if (index(message, 'separate the columns') > 0) message = message//self%remedy
      if (self%columns == 0) message = 'the file is empty; its first line must name its columns, such as '//example
      if (len(message) > 0) call faults%add(self%path, merge(self%line, 0, self%columns > 0), '', '', message)
   end subroutine read_names

   !> Take the line that was read last as the units of the columns if it is a row of them, and go on to the next.
   subroutine take_units(self)
      class(csv_table_t), intent(inout) :: self
      integer :: i

      if (self%columns /= size(self%names)) return
      if (.not. is_row_of_units(self%fields(:self%columns))) return
      do i = 1, self%columns
         self%units(i)%text = self%fields(i)%unit()
      end do
      call self%next_line()
   end subroutine take_units

   !> Whether fields are units: none is a number, and one at least is a unit.
   pure logical function is_row_of_units(fields)
      type(field_t), intent(in) :: fields(:)
      type(unit_t) :: unit
      real(dp) :: number
      logical :: sound
      integer :: i

      is_row_of_units = .false.
      do i = 1, size(fields)
         ! A number with a decimal comma is none of units either.
         if (scan(fields(i)%bare()//' ', '0123456789') == 1 .and. index(fields(i)%bare(), '1/') /= 1) exit
         call read_strict_real(fields(i)%bare(), number, sound)
         if (sound) exit
         unit = unit_of_text(fields(i)%unit())
         is_row_of_units = is_row_of_units .or. unit%is_known
      end do
      if (i <= size(fields)) is_row_of_units = .false.
   end function is_row_of_units

   !> Whether the line that was read last has a field for each name, and a number among them: then the header is one.
   pure logical function has_numbers(self)
      class(csv_table_t), intent(in) :: self
      real(dp) :: number
      logical :: sound
      integer :: i

      has_numbers = .false.
      if (self%columns /= size(self%names)) return
      do i = 1, self%columns
         call read_strict_real(self%text%numeral(self%fields(i)), number, sound)
         has_numbers = has_numbers .or. sound
      end do
   end function has_numbers

   !> Read some columns of all lines from the present one on.
   subroutine read_rows(self, chosen, faults)
      class(csv_table_t), intent(inout) :: self
      !> Their places
      integer, intent(in) :: chosen(:)
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      real(dp), allocatable :: values(:, :)
      integer, allocatable :: lines(:)
      character(:), allocatable :: cause
      integer :: row, i, digits, decimals
      logical :: is_hopeless

      is_hopeless = .false.
      cause = ''
      allocate (values(self%line_count, size(chosen)), lines(self%line_count))
      row = 0
      do
         if (self%text%broken) call faults%add(self%path, self%line, '', '', 'it cannot be read to its end')
         if (self%text%stopped) call faults%add(self%path, self%line, '', '', 'there was no time to read it to its end')
         if (self%columns == 0 .or. self%text%broken .or. self%text%stopped .or. faults%not_kept() > 0) exit
         row = row + 1
         lines(row) = self%line
         if (self%columns == size(self%names)) then
            do i = 1, size(chosen)
               if (.not. is_hopeless) call read_number(chosen(i), values(row, i))
            end do
            call count_digits(self%text%numeral(self%fields(chosen(size(chosen)))), digits, decimals)
            self%most_digits = max(self%most_digits, digits)
            if (digits > 0) self%most_decimals = max(self%most_decimals, decimals)
         else
            cause = cause_of_count(self%fields(:min(self%columns, size(self%fields))), size(self%names), self%text%separator)
            call self%refuse('the line has '//integer_text(self%columns)//' columns, the header '// &
                             integer_text(size(self%names))//cause, faults)
            ! What is wrong with the first line, or with how the numbers are written, is wrong with all that follow.
            is_hopeless = row == 1 .or. len(cause) > 0
         end if
         if (is_hopeless) exit
         call self%next_line()
      end do
      self%values = values(:row, :)
      self%lines = lines(:row)

   contains

      !> A number, or what is wrong where it should stand.
      subroutine read_number(position, number)
         integer, intent(in) :: position
         real(dp), intent(out) :: number
         character(:), allocatable :: message, word
         logical :: sound

         call self%text%read_number(self%fields(position), number, sound)
         if (sound) return
         word = self%fields(position)%bare()
         if (self%gaps_allowed .and. len(word) == 0) then
            number = ieee_value(number, ieee_quiet_nan)
            return
         end if
         message = wrong_separator(self%fields(:self%columns), self%text%separator)
         if (self%text%has_both_marks) message = 'some numbers have a decimal point, others a decimal comma'
         if (len(message) == 0 .and. is_decimal_comma(word)) message = 'column '//integer_text(position)//decimal_commas
         is_hopeless = len(message) > 0
         if (.not. is_hopeless) then
            message = 'column '//integer_text(position)//': this is not a number'
            if (len(word) == 0) then
               message = 'column '//integer_text(position)//': a number is missing'
            else if (row == 1) then
               message = message//'; below the names one row may hold units, then numbers follow'
               is_hopeless = .true.
            end if
         end if
         call self%refuse(message, faults)
      end subroutine read_number

   end subroutine read_rows

   !> Add a fault of the line that was read last; the first one says what mends the file.
   subroutine refuse(self, message, faults)
      class(csv_table_t), intent(inout) :: self
      character(*), intent(in) :: message
      type(fault_list_t), intent(inout) :: faults

      call faults%add(self%path, self%line, '', '', message//self%remedy)
      self%remedy = ''
   end subroutine refuse

   !> What separates the columns of a line if it is something else than in the header, as a fault; empty if nothing seems to.
   pure function wrong_separator(fields, separator) result(message)
      type(field_t), intent(in) :: fields(:)
      !> That of the header
      character(1), intent(in) :: separator
      character(:), allocatable :: message
      character(*), parameter :: tab = achar(9)
      character(:), allocatable :: word, bare
      integer :: i

      message = ''
      do i = 1, size(fields)
         word = fields(i)%word()
         bare = fields(i)%bare()
         ! A name in one pair of quotes may hold anything.
         if (word /= bare .and. scan(bare, '"'//"'") == 0) cycle
         if (index(word, ';') > 0 .and. separator /= ';') message = 'semicolons separate the columns, but not those of the header'
         if (len(message) == 0 .and. index(word, tab) > 0) message = 'tabs separate the columns; commas or semicolons are needed'
      end do
   end function wrong_separator

   !> Why a line may have too many columns; empty if nothing seems to be the cause.
   pure function cause_of_count(fields, names, separator) result(cause)
      !> Fields of the line
      type(field_t), intent(in) :: fields(:)
      !> Columns of the header, and what separates them
      integer, intent(in) :: names
      character(1), intent(in) :: separator
      character(:), allocatable :: cause
      real(dp) :: number
      logical :: sound
      integer :: i

      cause = ''
      if (len(wrong_separator(fields, separator)) > 0) cause = ': '//wrong_separator(fields, separator)
      if (len(cause) > 0 .or. size(fields) < names .or. separator == ';') return
      do i = 1, size(fields)
         call read_strict_real(fields(i)%bare(), number, sound)
         if (.not. sound) return
      end do
      cause = decimal_commas
   end function cause_of_count

   !> Whether a word is a number with a decimal comma.
   pure logical function is_decimal_comma(word)
      character(*), intent(in) :: word
      real(dp) :: number
      integer :: comma

      comma = index(word, ',')
      is_decimal_comma = comma > 0
      if (is_decimal_comma) call read_strict_real(word(:comma - 1)//'.'//word(comma + 1:), number, is_decimal_comma)
   end function is_decimal_comma

   !> How many significant digits a number has, and how many of them behind the point of one without an exponent.
   pure subroutine count_digits(word, digits, decimals)
      !> A sound number
      character(*), intent(in) :: word
      integer, intent(out) :: digits
      integer, intent(out) :: decimals
      integer :: mark, exponent, stat, point, first

      mark = scan(word//'e', 'eEdD')
      exponent = 0
      if (mark < len(word)) read (word(mark + 1:), *, iostat=stat) exponent
      point = index(word(:mark - 1), '.')
      decimals = -exponent
      if (point > 0) decimals = mark - 1 - point - exponent
      first = scan(word(:mark - 1), '123456789')
      digits = 0
      if (first == 0) return
      digits = mark - first
      if (point > first) digits = digits - 1
   end subroutine count_digits

end module csv_table
