!> Lines of a CSV file as people write it: a header with names, then lines of numbers. Lines that begin with '#' are comments, empty
!> ones are skipped. What is wrong is told with its line and column, never with what stands there: a path may lead to a file
!> that is nobody's business.
module csv_lines
   use csv_fields, only: csv_text_t, field_t
   use errors, only: fault_list_t
   use kinds, only: dp
   use number_text, only: read_strict_real
   use text, only: integer_text
   use word_list, only: word_t
   implicit none(type, external)
   private

   public :: next_line, read_names, is_row, take_number, wrong_count, cause_of_count

contains

   !> The next line that is neither a comment nor empty, as its fields; none at the end of the file.
   subroutine next_line(text, lines, line, fields, count)
      type(csv_text_t), intent(inout) :: text
      !> Lines of the file
      integer, intent(in) :: lines
      !> Number of the line, from 1
      integer, intent(inout) :: line
      !> Grows as it must
      type(field_t), allocatable, intent(inout) :: fields(:)
      !> How many fields the line has
      integer, intent(out) :: count
      type(field_t) :: field

      if (.not. allocated(fields)) allocate (fields(2))
      count = 0
      do while (line < lines .and. .not. (text%broken .or. text%stopped))
         line = line + 1
         count = 0
         do
            call text%take_field(field)
            count = count + 1
            if (count > size(fields)) fields = [fields, fields]
            fields(count) = field
            if (field%ends_line) exit
         end do
         if (.not. (index(fields(1)%word(), '#') == 1 .or. (count == 1 .and. len(fields(1)%word()) == 0))) return
         count = 0
      end do
   end subroutine next_line

   !> The header: names that commas separate.
   subroutine read_names(path, line, example, fields, names, faults)
      character(*), intent(in) :: path
      integer, intent(in) :: line
      !> A header as it may be
      character(*), intent(in) :: example
      type(field_t), intent(in) :: fields(:)
      !> Without quotes around them
      type(word_t), allocatable, intent(inout) :: names(:)
      type(fault_list_t), intent(inout) :: faults
      character(:), allocatable :: message
      real(dp) :: number
      logical :: sound
      integer :: i

      message = ''
      deallocate (names)
      allocate (names(size(fields)))
      do i = 1, size(fields)
         names(i)%text = fields(i)%bare()
         if (len(message) > 0) cycle
         call read_strict_real(names(i)%text, number, sound)
         if (sound) message = 'the first line holds numbers; it must name the columns, such as '//example
         if (index(names(i)%text, achar(0)) > 0) message = 'it is no plain text; save it as CSV in UTF-8'
         if (index(names(i)%text, achar(13)) > 0) message = 'carriage returns alone end its lines; line feeds are needed'
         if (len(wrong_separator(fields)) > 0) message = wrong_separator(fields)
      end do
      if (size(fields) == 0) message = 'the file is empty; its first line must name its columns, such as '//example
      if (len(message) > 0) call faults%add(path, merge(line, 0, size(fields) > 0), '', '', message)
   end subroutine read_names

   !> What separates the columns of a line if it is no comma, as a fault; empty if nothing seems to.
   pure function wrong_separator(fields) result(message)
      type(field_t), intent(in) :: fields(:)
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
         if (index(word, ';') > 0) message = 'semicolons separate the columns; commas are needed, and points in the numbers'
         if (len(message) == 0 .and. index(word, tab) > 0) message = 'tabs separate the columns; commas are needed'
      end do
   end function wrong_separator

   !> Whether a line has a field for each name, and a number among them: then its header is one.
   pure logical function is_row(fields, columns)
      type(field_t), intent(in) :: fields(:)
      integer, intent(in) :: columns
      real(dp) :: number
      logical :: sound
      integer :: i

      is_row = .false.
      if (size(fields) /= columns) return
      do i = 1, size(fields)
         call read_strict_real(fields(i)%bare(), number, sound)
         is_row = is_row .or. sound
      end do
   end function is_row

   !> A number of a line, or what is wrong where it should stand.
   subroutine take_number(fields, position, is_first, number, message, is_hopeless)
      type(field_t), intent(in) :: fields(:)
      !> Column
      integer, intent(in) :: position
      !> Whether it is the first line of numbers: what is wrong there is wrong with all that follow
      logical, intent(in) :: is_first
      real(dp), intent(out) :: number
      !> Empty if the number is sound
      character(:), allocatable, intent(out) :: message
      !> Whether the lines that follow are not worth reading
      logical, intent(out) :: is_hopeless
      character(:), allocatable :: word, place
      logical :: sound

      message = ''
      is_hopeless = .false.
      word = fields(position)%bare()
      call read_strict_real(word, number, sound)
      if (sound) return
      place = 'column '//integer_text(position)//': '
      message = wrong_separator(fields)
      is_hopeless = len(message) > 0
      if (is_hopeless) return
      message = place//'no number stands here'
      if (len(word) == 0) then
         message = place//'a number is missing'
      else if (is_first) then
         message = message//'; units belong into the name, as in time_s'
         is_hopeless = .true.
      end if
   end subroutine take_number

   !> That a line has another number of columns than the header, and why.
   function wrong_count(fields, names) result(message)
      type(field_t), intent(in) :: fields(:)
      !> Columns of the header
      integer, intent(in) :: names
      character(:), allocatable :: message

      message = 'the line has '//integer_text(size(fields))//' columns, the header '//integer_text(names)// &
                cause_of_count(fields, names)
   end function wrong_count

   !> Why a line may have too many columns; empty if nothing seems to be the cause.
   function cause_of_count(fields, names) result(cause)
      type(field_t), intent(in) :: fields(:)
      !> Columns of the header
      integer, intent(in) :: names
      character(:), allocatable :: cause
      real(dp) :: number
      logical :: sound
      integer :: i

      cause = ''
      if (len(wrong_separator(fields)) > 0) cause = ': '//wrong_separator(fields)
      if (len(cause) > 0 .or. size(fields) < names) return
      do i = 1, size(fields)
         call read_strict_real(without_half_quotes(fields(i)%bare()), number, sound)
         if (.not. sound) return
      end do
      cause = ': with a decimal comma a number is two columns; write a decimal point'
   end function cause_of_count

   !> A field without a quote at its begin or its end: a number with a decimal comma begins in one field and ends in the next.
   pure function without_half_quotes(word) result(rest)
      character(*), intent(in) :: word
      character(:), allocatable :: rest

      rest = word
      if (index(rest, '"') == 1) rest = rest(2:)
      if (len(rest) > 0 .and. index(rest, '"') == len(rest)) rest = rest(:len(rest) - 1)
   end function without_half_quotes

end module csv_lines
