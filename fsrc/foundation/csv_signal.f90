!> A recorded signal from a CSV file: a column of uniform samples. A column of time or angle shows where the samples stand.
module csv_signal
   use column_head, only: axis_of, axis_unit_t, column_head_t, conversion, head_of, no_axis
   use csv_table, only: csv_table_t
   use errors, only: fault_list_t
   use kinds, only: dp
   use text, only: integer_text, short_text
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
      !> Samples in the unit that was asked for, where each stands on the axis, and its line
      real(dp), allocatable :: samples(:)
      real(dp), allocatable :: axis(:)
      integer, allocatable :: lines(:)
      !> From one sample to the next, in the unit of the axis
      real(dp) :: step = 0.0_dp
      !> By how much of a step the axis jitters at most; 0 where it is as uniform as its digits show
      real(dp) :: jitter = 0.0_dp
      !> What the last digit of the axis is worth, in its unit
      real(dp) :: last_digit = 0.0_dp
      !> What became of the unit of the column, in a few words
      character(:), allocatable :: unit_note
   end type recording_t

   public :: read_csv_signal

contains

   !> Read a column and its axis.
   subroutine read_csv_signal(path, column, needed, remedy, recording, faults)
      !> Path of the file
      character(*), intent(in) :: path
      !> Name of the column in the header; empty: the only one that is no time or angle
      character(*), intent(in) :: column
      !> Unit that its numbers are brought into
      character(*), intent(in) :: needed
      !> What makes a signal of a file that is none, as the end of a sentence; may be empty
      character(*), intent(in) :: remedy
      !> What it holds; of use only if no fault was added
      type(recording_t), intent(out) :: recording
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      type(csv_table_t) :: table
      integer :: before, chosen, axis

      before = faults%count()
      recording%column = ''
      recording%axis_name = ''
      recording%unit_note = ''
      chosen = 0
      axis = 0
      allocate (recording%samples(0), recording%axis(0), recording%lines(0))
      call table%open(path, most_samples, 'too many for a signal', 'time_s,force', remedy, faults)
      if (faults%count() == before) call choose_column(path, table, column, chosen, axis, faults)
      if (faults%count() == before) then
         recording%column = table%names(chosen)%text
         if (axis > 0) recording%axis_name = table%names(axis)%text
         if (axis > 0) recording%axis_unit = axis_of(recording%axis_name, table%units(axis)%text)
         call read_samples(path, chosen, axis, table, recording, faults)
      end if
      call table%close()
      if (faults%count() == before) call take_unit(path, table, chosen, needed, recording, faults)
      if (faults%count() == before) call check_uniform(path, remedy, recording, faults)
   end subroutine read_csv_signal

   !> Bring the samples into the unit that is needed.
   subroutine take_unit(path, table, chosen, needed, recording, faults)
      character(*), intent(in) :: path
      type(csv_table_t), intent(in) :: table
      integer, intent(in) :: chosen
      character(*), intent(in) :: needed
      type(recording_t), intent(inout) :: recording
      type(fault_list_t), intent(inout) :: faults
      type(column_head_t) :: head
      character(:), allocatable :: message
      real(dp) :: factor, added

      head = head_of(table%names(chosen)%text, table%units(chosen)%text, needed)
      call conversion(head, needed, factor, added, message)
      if (len(message) > 0) then
         call faults%add(path, table%header, '', '', 'column '//integer_text(chosen)//': '//message)
         return
      end if
      if (len(head%word) == 0) recording%unit_note = 'its head says no unit, '//needed//' is taken'
      if (factor < 1.0_dp .or. factor > 1.0_dp) then
         recording%samples = factor*recording%samples
         recording%unit_note = 'its '//head%word//' are converted to '//needed
      end if
   end subroutine take_unit

   !> Which column is the signal, and which one its axis (0: none is).
   subroutine choose_column(path, table, column, chosen, axis, faults)
      character(*), intent(in) :: path
      !> With its header, and the line behind it
      type(csv_table_t), intent(in) :: table
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
      do i = 1, size(table%names)
         list = list//', '//table%names(i)%text
         if (len(column) > 0 .and. table%names(i)%text == column) then
            if (chosen > 0) call faults%add(path, table%header, '', '', "two columns are named '"//column//"'")
            chosen = i
            cycle
         end if
         unit = axis_of(table%names(i)%text, table%units(i)%text)
         if (unit%kind /= no_axis) then
            if (axis == 0) axis = i
         else if (len(table%names(i)%text) > 0) then
            others = others + 1
            other = i
         end if
      end do
      ! Names of what is no table of numbers are private.
      if (.not. table%has_numbers()) list = ', which are not known: the line below is no line of as many numbers'
      if (len(column) == 0 .and. size(table%names) == 1) then
         chosen = 1
         axis = 0
      else if (len(column) == 0 .and. others == 1) then
         chosen = other
      else if (len(column) == 0) then
         call faults%add(path, table%header, '', '', 'signal_column must name one of its columns: '//list(3:))
      else if (chosen == 0) then
         call faults%add(path, table%header, '', '', "there is no column '"//column//"'; its columns are "//list(3:))
      end if
   end subroutine choose_column

   !> The samples, and where each stands on the axis.
   subroutine read_samples(path, chosen, axis, table, recording, faults)
      character(*), intent(in) :: path
      integer, intent(in) :: chosen
      !> 0: there is none
      integer, intent(in) :: axis
      type(csv_table_t), intent(inout) :: table
      type(recording_t), intent(inout) :: recording
      type(fault_list_t), intent(inout) :: faults
      !> No time or angle is as large, and its powers can still be computed with
      real(dp), parameter :: farthest = 1.0e30_dp
      real(dp) :: largest
      integer :: before, count

      before = faults%count()
      call table%read(pack([chosen, axis], [.true., axis > 0]), faults)
      recording%samples = table%values(:, 1)
      recording%lines = table%lines
      if (faults%count() > before) return
      count = size(recording%samples)
      if (count < least_samples) call faults%add(path, 0, '', '', 'it has '//integer_text(count)// &
                                                 ' samples; a cycle needs at least '//integer_text(least_samples))
      if (axis == 0 .or. count == 0) return
      recording%axis = table%values(:, 2)
      largest = maxval(abs(recording%axis))
      if (largest > farthest) then
         call faults%add(path, 0, '', '', 'its axis reaches to '//short_text(largest, 2)//'; that is no axis')
         return
      end if
      ! Fixed decimals, or as many digits of every number
      recording%last_digit = 10.0_dp**(-table%most_decimals)
      if (largest > 0.0_dp) &
         recording%last_digit = max(recording%last_digit, 10.0_dp**(floor(log10(largest)) + 1 - table%most_digits))
   end subroutine read_samples

   !> The samples follow each other in equal steps. Time stamps may jitter, and numbers be rounded when they were written, but not by so
   !> much that a sample could be missing.
   subroutine check_uniform(path, remedy, recording, faults)
      character(*), intent(in) :: path
      character(*), intent(in) :: remedy
      type(recording_t), intent(inout) :: recording
      type(fault_list_t), intent(inout) :: faults
      real(dp), parameter :: most_jitter = 0.1_dp, most_rounding = 0.25_dp
      character(:), allocatable :: message
      real(dp), allocatable :: places(:), off(:)
      real(dp) :: step, allowed
      integer :: i

      if (size(recording%axis) < 2) return
      associate (axis => recording%axis, n => size(recording%axis))
         ! The straight line through all of them: one that jitters says little of its ends.
         places = [(real(i, dp) - 0.5_dp*real(n + 1, dp), i=1, n)]
         off = axis - axis(1)
         step = sum(places*off)/sum(places**2)
         recording%step = step
         off = abs(off - sum(off/real(n, dp)) - step*places)
         ! The line itself is uncertain by what jitters.
         allowed = min(max(most_jitter*step*(1.0_dp + 2.0_dp/sqrt(real(n, dp))), recording%last_digit), most_rounding*step)
         message = 'the axis descends'
         i = findloc(axis(2:) < axis(:n - 1), .true., dim=1) + 1
         if (i == 1) then
            message = 'the samples are not uniform'
            if (recording%last_digit > most_rounding*step .and. step > 0.0_dp) &
               message = message//' (or the axis has too few digits to show it)'
            ! Where steps grow or one is missing, the line is off everywhere: the worst step is reported.
            if (.not. all(axis(2:) > axis(:n - 1)) .or. maxval(off) > allowed) &
               i = maxloc(abs(axis(2:) - axis(:n - 1) - step), dim=1) + 1
         end if
         if (i > 1) call faults%add(path, recording%lines(i), '', '', message//': after '//short_text(axis(i - 1), 7)// &
                                    ' comes '//short_text(axis(i), 7)//', the mean step is '//short_text(step, 7)//remedy)
         if (maxval(off) > recording%last_digit) recording%jitter = maxval(off)/step
      end associate
   end subroutine check_uniform

end module csv_signal
