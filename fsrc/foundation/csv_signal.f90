!> A recorded signal from a CSV file: a header with names, then a line of numbers for each of its uniform samples. Lines that
!> begin with '#' are comments, empty ones are skipped. A column of time or angle tells where the samples stand. What is wrong is
!> told with its line and column, never with what stands there: a path may lead to a file that is nobody's business.
module csv_signal
   use axis_unit, only: axis_unit_t, no_axis, unit_of_name
   use csv_fields, only: csv_text_t, field_t
   use csv_lines, only: cause_of_count, is_row, next_line, read_names, take_number, wrong_count
   use errors, only: fault_list_t
   use kinds, only: dp, int64
   use text, only: integer_text, short_text
   use word_list, only: word_t
   implicit none(type, external)
   private

   !> Samples of a cycle
   integer, parameter, public :: least_samples = 4
   integer, parameter :: most_samples = 10000000

   !> What a file holds.
   type, public :: recording_t
      !> Names of the column that was read and of its axis; the latter is empty if there is none
      character(:), allocatable :: column
      character(:), allocatable :: axis_name
      type(axis_unit_t) :: axis_unit
      !> Samples, where each stands on the axis, and its line
      real(dp), allocatable :: samples(:)
      real(dp), allocatable :: axis(:)
      integer, allocatable :: lines(:)
      !> What the last digit of the axis is worth, in its unit
      real(dp) :: last_digit = 0.0_dp
   contains
      procedure :: step => mean_step
   end type recording_t

   public :: read_csv_signal

contains

   !> Read a column and its axis.
   subroutine read_csv_signal(path, column, recording, faults)
      !> Path of the file
      character(*), intent(in) :: path
      !> Name of the column in the header; empty: the only one that is no time or angle
      character(*), intent(in) :: column
      !> What it holds; of use only if no fault was added
      type(recording_t), intent(out) :: recording
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      type(csv_text_t) :: text
      type(word_t), allocatable :: names(:)
      type(field_t), allocatable :: fields(:)
      character(:), allocatable :: message
      integer(int64) :: lines
      integer :: before, line, header, chosen, axis, count

      before = faults%count()
      allocate (names(0))
      recording%column = ''
      recording%axis_name = ''
      allocate (recording%samples(0), recording%axis(0), recording%lines(0))
      call text%open(path, lines, message)
      if (len(message) > 0) then
         call faults%add(path, 0, '', '', message)
         return
      end if
      line = 0
      if (lines > int(most_samples, int64)) then
         call faults%add(path, 0, '', '', 'it has more than '//integer_text(most_samples)//' lines; that is no signal')
      else
         call next_line(text, int(lines), line, fields, count)
         header = line
         call read_names(path, header, 'time_s,force', fields(:count), names, faults)
      end if
      if (faults%count() == before) then
         call next_line(text, int(lines), line, fields, count)
         call choose_column(path, header, names, is_row(fields(:count), size(names)), column, chosen, axis, faults)
      end if
      if (faults%count() == before) then
         recording%column = names(chosen)%text
         if (axis > 0) recording%axis_name = names(axis)%text
         if (axis > 0) recording%axis_unit = unit_of_name(recording%axis_name)
         call read_rows(text, path, int(lines), line, size(names), chosen, axis, fields, count, recording, faults)
      end if
      call text%close()
      if (faults%count() == before) call check_uniform(path, recording, faults)
   end subroutine read_csv_signal

   !> Which column is the signal, and which one its axis (0: none is).
   subroutine choose_column(path, line, names, is_table, column, chosen, axis, faults)
      character(*), intent(in) :: path
      !> Where the header stands
      integer, intent(in) :: line
      type(word_t), intent(in) :: names(:)
      !> Whether the file is a table of numbers, whose names may be told
      logical, intent(in) :: is_table
      character(*), intent(in) :: column
      integer, intent(out) :: chosen
      integer, intent(out) :: axis
      type(fault_list_t), intent(inout) :: faults
      type(axis_unit_t) :: unit
      character(:), allocatable :: list
      integer :: i, others, other

      chosen = 0
      axis = 0
      others = 0
      other = 0
      list = ''
      do i = 1, size(names)
         list = list//', '//names(i)%text
         if (len(column) > 0 .and. names(i)%text == column) then
            if (chosen > 0) call faults%add(path, line, '', '', "two columns are named '"//column//"'")
            chosen = i
            cycle
         end if
         unit = unit_of_name(names(i)%text)
         if (unit%kind /= no_axis) then
            if (axis == 0) axis = i
         else if (len(names(i)%text) > 0) then
            others = others + 1
            other = i
         end if
      end do
      if (.not. is_table) list = ', which cannot be told: the line below is no line of as many numbers'
      if (len(column) == 0 .and. size(names) == 1) then
         chosen = 1
         axis = 0
      else if (len(column) == 0 .and. others == 1) then
         chosen = other
      else if (len(column) == 0) then
         call faults%add(path, line, '', '', 'signal_column must name one of its columns: '//list(3:))
      else if (chosen == 0) then
         call faults%add(path, line, '', '', "there is no column '"//column//"'; its columns are "//list(3:))
      end if
   end subroutine choose_column

   !> All other lines.
   subroutine read_rows(text, path, lines, line, names, chosen, axis, fields, columns, recording, faults)
      type(csv_text_t), intent(inout) :: text
      character(*), intent(in) :: path
      integer, intent(in) :: lines
      integer, intent(inout) :: line
      !> Columns of the header
      integer, intent(in) :: names
      integer, intent(in) :: chosen
      integer, intent(in) :: axis
      !> Of the first of these lines, which is read already
      type(field_t), allocatable, intent(inout) :: fields(:)
      integer, intent(inout) :: columns
      type(recording_t), intent(inout) :: recording
      type(fault_list_t), intent(inout) :: faults
      !> No time or angle is as large, and its powers can still be computed with
      real(dp), parameter :: farthest = 1.0e30_dp
      real(dp), allocatable :: read_samples(:), read_axis(:)
      integer, allocatable :: read_lines(:)
      integer :: count, before, digits, decimals, most_digits, most_decimals
      logical :: is_hopeless

      before = faults%count()
      is_hopeless = .false.
      allocate (read_samples(lines), read_axis(lines), read_lines(lines))
      count = 0
      most_digits = 0
      most_decimals = -range(1.0_dp)
      do
         if (text%broken) call faults%add(path, line, '', '', 'it cannot be read to its end')
         if (text%stopped) call faults%add(path, line, '', '', 'there was no time to read it to its end')
         if (columns == 0 .or. text%broken .or. text%stopped .or. faults%not_kept() > 0) exit
         count = count + 1
         read_lines(count) = line
         if (columns == names) then
            call read_number(chosen, read_samples(count))
            if (axis > 0) then
               call read_number(axis, read_axis(count))
               call count_digits(fields(axis)%bare(), digits, decimals)
               most_digits = max(most_digits, digits)
               if (digits > 0) most_decimals = max(most_decimals, decimals)
            end if
         else
            call faults%add(path, line, '', '', wrong_count(fields(:columns), names))
            ! What is wrong with the first line, or with how the numbers are written, is wrong with all that follow.
            is_hopeless = count == 1 .or. len(cause_of_count(fields(:columns), names)) > 0
         end if
         if (is_hopeless) exit
         call next_line(text, lines, line, fields, columns)
      end do
      recording%samples = read_samples(:count)
      recording%lines = read_lines(:count)
      if (faults%count() > before) return
      if (count < least_samples) call faults%add(path, 0, '', '', 'it has '//integer_text(count)// &
                                                 ' samples; a cycle needs at least '//integer_text(least_samples))
      if (axis == 0 .or. count == 0) return
      recording%axis = read_axis(:count)
      if (maxval(abs(recording%axis)) > farthest) then
         call faults%add(path, 0, '', '', 'its axis reaches to '//short_text(maxval(abs(recording%axis)), 2)//'; that is no axis')
         return
      end if
      ! Fixed decimals, or as many digits of every number
      recording%last_digit = 10.0_dp**(-most_decimals)
      if (maxval(abs(recording%axis)) > 0.0_dp) recording%last_digit = &
         max(recording%last_digit, 10.0_dp**(floor(log10(maxval(abs(recording%axis)))) + 1 - most_digits))

   contains

      subroutine read_number(position, number)
         integer, intent(in) :: position
         real(dp), intent(out) :: number
         character(:), allocatable :: message
         logical :: is_wrong

         if (is_hopeless) return
         call take_number(fields(:columns), position, count == 1, number, message, is_wrong)
         if (len(message) > 0) call faults%add(path, line, '', '', message)
         is_hopeless = is_wrong
      end subroutine read_number

   end subroutine read_rows

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

   !> Mean step from one sample to the next.
   pure real(dp) function mean_step(self)
      class(recording_t), intent(in) :: self

      associate (n => size(self%axis))
         mean_step = (self%axis(n) - self%axis(1))/real(n - 1, dp)
      end associate
   end function mean_step

   !> The samples follow each other in equal steps. Numbers that were rounded when they were written may be off a little, but not
   !> by so much that a sample could be missing.
   subroutine check_uniform(path, recording, faults)
      character(*), intent(in) :: path
      type(recording_t), intent(in) :: recording
      type(fault_list_t), intent(inout) :: faults
      real(dp), parameter :: least_rounding = 0.05_dp, most_rounding = 0.25_dp
      character(:), allocatable :: message
      real(dp) :: step, allowed
      integer :: i

      if (size(recording%axis) < 2) return
      step = recording%step()
      allowed = min(max(least_rounding*step, recording%last_digit), most_rounding*step)
      associate (axis => recording%axis, n => size(recording%axis))
         message = 'the axis descends'
         i = findloc(axis(2:) < axis(:n - 1), .true., dim=1) + 1
         if (i == 1) then
            message = 'the samples are not uniform'
            if (recording%last_digit > most_rounding*step .and. step > 0.0_dp) &
               message = message//' (or the axis has too few digits to show it)'
            i = findloc([(abs(axis(i) - axis(1) - step*real(i - 1, dp)) > allowed .or. .not. axis(i) > axis(i - 1), i=2, n)], &
                        .true., dim=1) + 1
         end if
         if (i > 1) call faults%add(path, recording%lines(i), '', '', message//': after '//short_text(axis(i - 1), 7)// &
                                    ' comes '//short_text(axis(i), 7)//', the mean step is '//short_text(step, 7))
      end associate
   end subroutine check_uniform

end module csv_signal
