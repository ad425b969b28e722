!> A recorded signal from a CSV file: a column of uniform samples. A column of time or angle tells where the samples stand.
module csv_signal
   use axis_unit, only: axis_unit_t, no_axis, unit_of_name
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
      type(csv_table_t) :: table
      integer :: before, chosen, axis

      before = faults%count()
      recording%column = ''
      recording%axis_name = ''
      chosen = 0
      axis = 0
      allocate (recording%samples(0), recording%axis(0), recording%lines(0))
      call table%open(path, most_samples, 'that is no signal', 'time_s,force', faults)
      if (faults%count() == before) call choose_column(path, table, column, chosen, axis, faults)
      if (faults%count() == before) then
         recording%column = table%names(chosen)%text
         if (axis > 0) recording%axis_name = table%names(axis)%text
         if (axis > 0) recording%axis_unit = unit_of_name(recording%axis_name)
         call read_samples(path, chosen, axis, table, recording, faults)
      end if
      call table%close()
      if (faults%count() == before) call check_uniform(path, recording, faults)
   end subroutine read_csv_signal

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
         unit = unit_of_name(table%names(i)%text)
         if (unit%kind /= no_axis) then
            if (axis == 0) axis = i
         else if (len(table%names(i)%text) > 0) then
            others = others + 1
            other = i
         end if
      end do
      ! Names of what is no table of numbers are nobody's business.
      if (.not. table%has_numbers()) list = ', which cannot be told: the line below is no line of as many numbers'
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
