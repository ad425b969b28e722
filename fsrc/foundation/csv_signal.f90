!> One cycle of a measured signal from a CSV file: a header with names, then a line of numbers for each of its uniform samples.
!> Lines that begin with '#' are comments, empty ones are skipped. A column of time or angle tells whether the samples are uniform.
module csv_signal
   use csv_fields, only: csv_text_t, field_t
   use errors, only: fault_list_t
   use kinds, only: dp, int64
   use number_text, only: read_strict_real
   use text, only: integer_text, lower, short_text
   use word_list, only: word_t
   implicit none(type, external)
   private

   !> Samples of a cycle
   integer, parameter :: least_samples = 4, most_samples = 10000000

   public :: read_csv_signal

contains

   !> Read a column; what is wrong with the file is told with its line.
   subroutine read_csv_signal(path, column, name, samples, faults)
      !> Path of the file
      character(*), intent(in) :: path
      !> Name of the column in the header; empty: the only one that is no time or angle
      character(*), intent(in) :: column
      !> Name of the column that was read
      character(:), allocatable, intent(out) :: name
      !> Its samples; of use only if no fault was added
      real(dp), allocatable, intent(out) :: samples(:)
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      type(csv_text_t) :: text
      type(word_t), allocatable :: names(:)
      character(:), allocatable :: message
      real(dp), allocatable :: times(:)
      integer, allocatable :: at(:)
      integer(int64) :: lines
      integer :: before, line, chosen, abscissa

      before = faults%count()
      name = ''
      allocate (names(0), samples(0), times(0), at(0))
      call text%open(path, lines, message)
      if (len(message) > 0) then
         call faults%add(path, 0, '', '', message)
         return
      end if
      line = 0
      if (lines > int(most_samples, int64)) then
         call faults%add(path, 0, '', '', 'it has more than '//integer_text(most_samples)//' lines; that is no cycle of a signal')
      else
         call read_names(text, int(lines), line, names)
         if (size(names) == 0) call faults%add(path, 0, '', '', &
            'the file is empty; its first line must name its columns, such as time,force')
      end if
      if (faults%count() == before) call choose_column(path, line, names, column, chosen, abscissa, faults)
      if (faults%count() == before) then
         name = names(chosen)%text
         call read_rows(text, path, int(lines), line, names, chosen, abscissa, samples, times, at, faults)
      end if
      call text%close()
      if (faults%count() == before) call check_uniform(path, times, at, faults)
      if (faults%count() == before) call check_cycle(path, at, samples, faults)
   end subroutine read_csv_signal

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

   !> The header.
   subroutine read_names(text, lines, line, names)
      type(csv_text_t), intent(inout) :: text
      integer, intent(in) :: lines
      integer, intent(inout) :: line
      !> Without quotes around them
      type(word_t), allocatable, intent(out) :: names(:)
      type(field_t), allocatable :: fields(:)
      character(:), allocatable :: word
      integer :: count, i

      call next_line(text, lines, line, fields, count)
      allocate (names(count))
      do i = 1, count
         word = fields(i)%word()
         if (len(word) > 1) then
            if (scan(word(1:1), '"'//"'") > 0 .and. word(1:1) == word(len(word):)) word = trim(adjustl(word(2:len(word) - 1)))
         end if
         names(i)%text = word
      end do
   end subroutine read_names

   !> Which column is the signal, and which one its time or angle (0: none is).
   subroutine choose_column(path, line, names, column, chosen, abscissa, faults)
      character(*), intent(in) :: path
      !> Where the header stands
      integer, intent(in) :: line
      type(word_t), intent(in) :: names(:)
      character(*), intent(in) :: column
      integer, intent(out) :: chosen
      integer, intent(out) :: abscissa
      type(fault_list_t), intent(inout) :: faults
      character(:), allocatable :: list
      real(dp) :: number
      logical :: sound
      integer :: i, others

      chosen = 0
      abscissa = 0
      others = 0
      list = ''
      do i = 1, size(names)
         call read_strict_real(names(i)%text, number, sound)
         if (sound) then
            call faults%add(path, line, '', '', "'"//names(i)%text//"' is a number; the first line must name the columns")
            return
         end if
         list = list//', '//names(i)%text
         if (names(i)%text == column) then
            if (chosen > 0) call faults%add(path, line, '', '', "two columns are named '"//column//"'")
            chosen = i
         end if
         if (abscissa == 0 .and. is_abscissa(names(i)%text)) then
            abscissa = i
         else
            others = others + 1
         end if
      end do
      if (len(column) == 0 .and. size(names) == 1) then
         chosen = 1
      else if (len(column) == 0 .and. others == 1) then
         chosen = merge(2, 1, abscissa == 1)
      else if (len(column) == 0) then
         call faults%add(path, line, '', '', 'signal_column must name one of its columns: '//list(3:))
      else if (chosen == 0) then
         call faults%add(path, line, '', '', "there is no column '"//column//"'; its columns are "//list(3:))
      end if
      if (abscissa == chosen) abscissa = 0
   end subroutine choose_column

   !> Whether a name is that of a time or an angle, whatever its unit.
   pure logical function is_abscissa(name)
      character(*), intent(in) :: name
      character(:), allocatable :: word

      word = lower(name(:scan(name//' ', ' [(_/,;') - 1))
      is_abscissa = any(word == [character(5) :: 't', 'time', 'angle', 'phase', 'crank'])
   end function is_abscissa

   !> All other lines.
   subroutine read_rows(text, path, lines, line, names, chosen, abscissa, samples, times, at, faults)
      type(csv_text_t), intent(inout) :: text
      character(*), intent(in) :: path
      integer, intent(in) :: lines
      integer, intent(inout) :: line
      type(word_t), intent(in) :: names(:)
      integer, intent(in) :: chosen
      integer, intent(in) :: abscissa
      !> The signal, its time or angle if there is a column of it, and the line of each sample
      real(dp), allocatable, intent(inout) :: samples(:)
      real(dp), allocatable, intent(inout) :: times(:)
      integer, allocatable, intent(inout) :: at(:)
      type(fault_list_t), intent(inout) :: faults
      type(field_t), allocatable :: fields(:)
      real(dp), allocatable :: read_samples(:), read_times(:)
      integer, allocatable :: read_at(:)
      integer :: count, columns, before

      before = faults%count()
      allocate (read_samples(lines), read_times(lines), read_at(lines))
      count = 0
      do
         call next_line(text, lines, line, fields, columns)
         if (text%broken) call faults%add(path, line, '', '', 'it cannot be read to its end')
         if (text%stopped) call faults%add(path, line, '', '', 'there was no time to read it to its end')
         if (columns == 0 .or. text%broken .or. text%stopped .or. faults%not_kept() > 0) exit
         count = count + 1
         read_at(count) = line
         if (columns /= size(names)) then
            call faults%add(path, line, '', '', 'the line has '//integer_text(columns)//' columns, the header '// &
                            integer_text(size(names)))
            cycle
         end if
         call read_number(chosen, read_samples(count))
         if (abscissa > 0) call read_number(abscissa, read_times(count))
      end do
      samples = read_samples(:count)
      at = read_at(:count)
      if (abscissa > 0) times = read_times(:count)
      if (faults%count() == before .and. count < least_samples) call faults%add(path, 0, '', '', 'it has '// &
         integer_text(count)//' samples; a cycle needs at least '//integer_text(least_samples))

   contains

      subroutine read_number(position, number)
         integer, intent(in) :: position
         real(dp), intent(out) :: number
         logical :: sound

         call read_strict_real(fields(position)%word(), number, sound)
         if (sound) return
         if (len(fields(position)%word()) == 0) then
            call faults%add(path, line, '', '', "column '"//names(position)%text//"': a number is missing")
         else
            call faults%add(path, line, '', '', "column '"//names(position)%text//"': '"//fields(position)%shown()// &
                            "' is not a number")
         end if
      end subroutine read_number

   end subroutine read_rows

   !> The samples follow each other in equal steps. Times that were rounded when they were written may be off a little.
   subroutine check_uniform(path, times, at, faults)
      character(*), intent(in) :: path
      !> Of each sample; none: they are taken for uniform
      real(dp), intent(in) :: times(:)
      integer, intent(in) :: at(:)
      type(fault_list_t), intent(inout) :: faults
      real(dp), parameter :: rounding = 0.05_dp
      real(dp) :: step
      integer :: i

      if (size(times) < 2) return
      step = (times(size(times)) - times(1))/real(size(times) - 1, dp)
      do i = 2, size(times)
         if (step > 0.0_dp .and. abs(times(i) - times(1) - step*real(i - 1, dp)) <= rounding*step) cycle
         call faults%add(path, at(i), '', '', 'the samples are not uniform: after '//short_text(times(i - 1), 7)//' comes '// &
                         short_text(times(i), 7)//', the mean step is '//short_text(step, 7))
         return
      end do
   end subroutine check_uniform

   !> The signal is one cycle: behind its last sample it goes on with the first.
   subroutine check_cycle(path, at, samples, faults)
      character(*), intent(in) :: path
      integer, intent(in) :: at(:)
      real(dp), intent(in) :: samples(:)
      type(fault_list_t), intent(inout) :: faults
      !> A step back to the first sample that is so many times the largest other one is a jump
      real(dp), parameter :: largest_jump = 5.0_dp, rounding = 1.0e-9_dp
      real(dp) :: range, largest_step, closing_step, next
      integer :: n

      n = size(samples)
      range = maxval(samples) - minval(samples)
      if (.not. range > 0.0_dp) then
         call faults%add(path, at(n), '', '', 'all samples are '//short_text(samples(1), 7)//'; nothing oscillates')
         return
      end if
      largest_step = maxval(abs(samples(2:) - samples(:n - 1)))
      closing_step = abs(samples(1) - samples(n))
      ! What would follow: the first sample after one whole cycle, the second after one that repeats its start.
      next = 4.0_dp*(samples(n) + samples(n - 2)) - 6.0_dp*samples(n - 1) - samples(n - 3)
      if (closing_step <= rounding*range .and. abs(next - samples(2)) < abs(next - samples(1))) then
         call faults%add(path, at(n), '', '', 'the last sample repeats the first; a cycle ends one step before, leave it out')
      else if (closing_step > largest_jump*largest_step) then
         call faults%add(path, at(n), '', '', 'the cycle does not close: from the last sample to the first it is '// &
                         short_text(closing_step/largest_step, 3)//' times the largest other step; if this jump is real, '// &
                         'let the cycle begin elsewhere')
      end if
   end subroutine check_cycle

end module csv_signal
