!> &gear drag_table and &shaft table: what was measured, from CSV files. What is wrong with a file is reported with its line and column.
!> The rows stand as comments in the resolved input, where a run that is carried on finds them changed.
module table_reader
   use column_head, only: column_head_t, conversion, head_of
   use csv_table, only: csv_table_t, read_csv_table
   use errors, only: fault_list_t
   use input_entry, only: numbers_text
   use input_key, only: allowed_text, in_range, is_computable, not_computable_text
   use key_table, only: find_key, keys
   use keys_in_use, only: in_use
   use kinds, only: dp
   use number_text, only: read_strict_real
   use recording_command, only: command_of_run_up
   use scene_input, only: scene_input_t
   use scene_types, only: gear_t, shaft_t
   use signal_doubts, only: doubts_of_run_up
   use text, only: integer_text, lower, printable, real_text
   use word_list, only: word_t
   implicit none(type, external)
   private

   character(*), parameter :: drag_columns(3) = [character(19) :: 'speed_rpm', 'temperature_celsius', 'torque'], &
                              drag_example = 'speed_rpm,temperature_celsius,torque', &
                              excitation_example = 'speed_rpm,acceleration_2,phase_2'

   public :: take_drag_table, take_excitation_table

contains

   !> Read the table of the drag, if there is one.
   subroutine take_drag_table(input, gear, notes)
      !> Typed values
      type(scene_input_t), intent(inout) :: input
      !> Gets the table
      type(gear_t), intent(inout) :: gear
      !> A line for each column that was converted is appended
      type(word_t), allocatable, intent(inout) :: notes(:)
      type(csv_table_t) :: csv
      character(:), allocatable :: path
      integer :: before, places(3), i, j, row
      logical, allocatable :: is_known(:, :)

      before = input%faults%count()
      call open_table(input, 'gear.drag_table', drag_example, path, csv)
      if (len(path) == 0 .or. input%faults%count() > before) return
      call convert_columns(path, [character(12) :: 'speed', 'temperature', 'torque'], [character(6) :: '1/min', 'degC', 'N m'], &
                           csv, notes, input%faults)
      if (input%faults%count() > before) return
      do i = 1, size(drag_columns)
         places(i) = place_of(csv, trim(drag_columns(i)))
         if (places(i) == 0) call input%faults%add(path, csv%header, '', '', 'there is no column '//trim(drag_columns(i))// &
                                                   '; the header must be '//drag_example)
      end do
      do i = 1, size(csv%names)
         if (any(places == i)) cycle
         call input%faults%add(path, csv%header, '', '', 'column '//integer_text(i)//': its name is none of '//drag_example// &
                               ', or is there twice')
      end do
      if (input%faults%count() > before) return
      call check_column(path, csv, places(1), 'shaft.speed_rpm', input%faults)
      call check_column(path, csv, places(2), 'oil.temperature_celsius', input%faults)
      call check_column(path, csv, places(3), 'gear.drag_torque', input%faults)
      if (size(csv%lines) < 2) call input%faults%add(path, csv%lines(1), '', '', 'a table needs two rows at least')
      if (input%faults%count() > before) return
      allocate (gear%drag_table)
      associate (table => gear%drag_table, speeds => csv%values(:, places(1)), temperatures => csv%values(:, places(2)))
         table%speeds = different(speeds)
         table%temperatures = different(temperatures)
         allocate (table%torques(size(table%speeds), size(table%temperatures)), source=0.0_dp)
         allocate (is_known(size(table%speeds), size(table%temperatures)), source=.false.)
         do row = 1, size(csv%lines)
            i = count(table%speeds <= speeds(row))
            j = count(table%temperatures <= temperatures(row))
            if (is_known(i, j)) call input%faults%add(path, csv%lines(row), '', '', 'columns '//integer_text(places(1))//' and '// &
                                                integer_text(places(2))//': an earlier row has this speed and temperature')
            is_known(i, j) = .true.
            table%torques(i, j) = csv%values(row, places(3))
         end do
         do i = 1, size(table%speeds)
            do j = 1, size(table%temperatures)
               if (.not. is_known(i, j)) call input%faults%add(path, 0, '', '', 'the grid has a hole: there is no row with '// &
                  'speed_rpm '//real_text(table%speeds(i))//' and temperature_celsius '// &
                  real_text(table%temperatures(j)))
            end do
         end do
      end associate
      call tell_rows(input, 'gear.drag_table', csv)
   end subroutine take_drag_table

   !> Read the table of the motion of the shaft, if there is one.
   subroutine take_excitation_table(input, shaft, notes)
      !> Typed values
      type(scene_input_t), intent(inout) :: input
      !> Gets the table
      type(shaft_t), intent(inout) :: shaft
      !> A line for each column that was converted, and for what is odd, is appended
      type(word_t), allocatable, intent(inout) :: notes(:)
      type(csv_table_t) :: csv
      character(:), allocatable :: path
      real(dp), allocatable :: orders(:)
      integer, allocatable :: accelerations(:), phases(:)
      integer :: before, speed, i, row

      before = input%faults%count()
      call open_table(input, 'shaft.table', excitation_example, path, csv)
      if (len(path) == 0 .or. input%faults%count() > before) return
      call convert_columns(path, [character(13) :: 'speed', 'acceleration_', 'phase_'], &
                           [character(6) :: '1/min', 'rad/s2', 'rad'], csv, notes, input%faults)
      if (input%faults%count() > before) return
      call sort_columns(path, csv, speed, orders, accelerations, phases, input%faults)
      if (input%faults%count() > before) return
      call check_column(path, csv, speed, 'shaft.speed_rpm', input%faults)
      do i = 1, size(orders)
         call check_column(path, csv, accelerations(i), 'shaft.accelerations', input%faults)
         if (phases(i) > 0) call check_column(path, csv, phases(i), 'shaft.phases', input%faults)
      end do
      do row = 2, size(csv%lines)
         if (csv%values(row, speed) > csv%values(row - 1, speed)) cycle
         call input%faults%add(path, csv%lines(row), '', '', column_text(csv, speed)//'the speeds must ascend, and after '// &
                               real_text(csv%values(row - 1, speed))//' comes '//real_text(csv%values(row, speed)))
      end do
      if (size(csv%lines) < 2) call input%faults%add(path, csv%lines(1), '', '', 'a table needs two rows at least')
      if (input%faults%count() > before) return
      allocate (shaft%table)
      shaft%table%speeds = csv%values(:, speed)
      shaft%table%orders = orders
      shaft%table%accelerations = csv%values(:, accelerations)
      allocate (shaft%table%phases(size(csv%lines), size(orders)), source=0.0_dp)
      do i = 1, size(orders)
         if (phases(i) > 0) shaft%table%phases(:, i) = csv%values(:, phases(i))
      end do
      notes = [notes, doubts_of_run_up(path, csv%lines, shaft%table)]
      call tell_rows(input, 'shaft.table', csv)
   end subroutine take_excitation_table

   !> Bring columns into the units that are needed, and their names into those that are looked for.
   subroutine convert_columns(path, names, units, csv, notes, faults)
      character(*), intent(in) :: path
      !> Names without units; those that end with '_' are the beginning of a name
      character(*), intent(in) :: names(:)
      !> The unit that each needs
      character(*), intent(in) :: units(:)
      type(csv_table_t), intent(inout) :: csv
      type(word_t), allocatable, intent(inout) :: notes(:)
      type(fault_list_t), intent(inout) :: faults
      type(column_head_t) :: head
      character(:), allocatable :: message, name, end_of_name
      real(dp) :: factor, added
      integer :: i, k

      do i = 1, size(csv%names)
         do k = 1, size(names)
            name = trim(names(k))
            head = head_of(csv%names(i)%text, csv%units(i)%text, trim(units(k)))
            if (lower(head%name) /= name .and. .not. (index(name, '_') > 0 .and. index(lower(head%name), name) == 1)) cycle
            call conversion(head, trim(units(k)), factor, added, message)
            if (len(message) > 0) call faults%add(path, csv%header, '', '', column_text(csv, i)//message)
            if (abs(factor - 1.0_dp) > 0.0_dp .or. abs(added) > 0.0_dp) then
               csv%values(:, i) = factor*csv%values(:, i) + added
               notes = [notes, word_t(printable(path, .false.)//': '//column_text(csv, i)//'its '//head%word// &
                                      ' are converted to '//trim(units(k)))]
            end if
            end_of_name = ''
            if (units(k) == '1/min') end_of_name = '_rpm'
            if (units(k) == 'degC') end_of_name = '_celsius'
            ! Speeds and temperatures have several usual units: theirs is said.
            if (len(end_of_name) == 0 .or. len(head%word) > 0) csv%names(i)%text = lower(head%name)//end_of_name
            exit
         end do
      end do
   end subroutine convert_columns

   !> Which column is what: the speed, and each order with its acceleration and phase (0: it has none).
   subroutine sort_columns(path, csv, speed, orders, accelerations, phases, faults)
      character(*), intent(in) :: path
      type(csv_table_t), intent(in) :: csv
      integer, intent(out) :: speed
      real(dp), allocatable, intent(out) :: orders(:)
      integer, allocatable, intent(out) :: accelerations(:)
      integer, allocatable, intent(out) :: phases(:)
      type(fault_list_t), intent(inout) :: faults
      character(*), parameter :: acceleration = 'acceleration_', phase = 'phase_'
      real(dp) :: order
      integer :: i, k
      logical :: is_unknown

      allocate (orders(0), accelerations(0), phases(0))
      speed = place_of(csv, 'speed_rpm')
      if (speed == 0) call faults%add(path, csv%header, '', '', 'there is no column speed_rpm; a header is '//excitation_example)
      do i = 1, size(csv%names)
         if (i == speed .or. index(csv%names(i)%text, phase) == 1) cycle
         call read_order(csv%names(i)%text, acceleration, order, is_unknown)
         if (is_unknown) then
            call add('its name is none of speed_rpm, acceleration_O and phase_O with an order O, such as acceleration_2, or '// &
                     'is there twice')
         else if (order_place() > 0) then
            call add('this order is there twice')
         else
            orders = [orders, order]
            accelerations = [accelerations, i]
            phases = [phases, 0]
         end if
      end do
      do i = 1, size(csv%names)
         if (index(csv%names(i)%text, phase) /= 1) cycle
         call read_order(csv%names(i)%text, phase, order, is_unknown)
         k = order_place()
         if (is_unknown .or. k == 0) then
            call add('it is a phase of an order that has no column acceleration_O')
         else if (phases(k) > 0) then
            call add('the phase of this order is there twice')
         else
            phases(k) = i
         end if
      end do
      if (size(orders) == 0) call faults%add(path, csv%header, '', '', 'there is no column of an order; a header is '// &
                                             excitation_example)

   contains

      subroutine add(message)
         character(*), intent(in) :: message

         call faults%add(path, csv%header, '', '', 'column '//integer_text(i)//': '//message)
      end subroutine add

      !> Place of the order among those that are known, 0 if it is not.
      integer function order_place()
         do order_place = 1, size(orders)
            if (.not. abs(orders(order_place) - order) > 0.0_dp) return
         end do
         order_place = 0
      end function order_place

   end subroutine sort_columns

   !> The order in a name such as acceleration_2.
   subroutine read_order(name, opening, order, is_unknown)
      character(*), intent(in) :: name
      !> What the name begins with
      character(*), intent(in) :: opening
      real(dp), intent(out) :: order
      !> Whether it is no such name
      logical, intent(out) :: is_unknown
      logical :: sound

      order = 0.0_dp
      is_unknown = index(name, opening) /= 1
      if (is_unknown) return
      call read_strict_real(name(len(opening) + 1:), order, sound)
      is_unknown = .not. (sound .and. is_computable(keys(find_key('shaft.orders')), order))
   end subroutine read_order

   !> Path and content of a table, if the input has one; an empty path if it has not, or if there is a fault.
   subroutine open_table(input, key, example, path, csv)
      type(scene_input_t), intent(inout) :: input
      !> As group.name
      character(*), intent(in) :: key
      character(*), intent(in) :: example
      character(:), allocatable, intent(out) :: path
      type(csv_table_t), intent(out) :: csv

      path = ''
      if (.not. input%is_given(key) .or. input%is_faulty(key)) return
      if (.not. in_use(input, find_key(key))) return
      path = input%file_path(key)
      if (len(path) == 0) return
      if (key == 'shaft.table') then
         call read_csv_table(path, example, '; '//command_of_run_up(path)//' makes one of a recording', csv, input%faults)
      else
         call read_csv_table(path, example, '', csv, input%faults)
      end if
   end subroutine open_table

   !> All values of a column are allowed for the key whose unit they have.
   subroutine check_column(path, csv, column, name, faults)
      character(*), intent(in) :: path
      type(csv_table_t), intent(in) :: csv
      integer, intent(in) :: column
      !> As group.name
      character(*), intent(in) :: name
      type(fault_list_t), intent(inout) :: faults
      integer :: row

      associate (key => keys(find_key(name)))
         do row = 1, size(csv%lines)
            associate (value => csv%values(row, column))
               if (.not. in_range(key, value)) then
                  call faults%add(path, csv%lines(row), '', '', column_text(csv, column)//real_text(value)// &
                                  ' is not allowed; allowed: '//allowed_text(key))
               else if (.not. is_computable(key, value)) then
                  call faults%add(path, csv%lines(row), '', '', column_text(csv, column)//not_computable_text(key, value))
               end if
            end associate
         end do
      end associate
   end subroutine check_column

   !> A column of a fault.
   pure function column_text(csv, column) result(words)
      type(csv_table_t), intent(in) :: csv
      integer, intent(in) :: column
      character(:), allocatable :: words

      words = 'column '//integer_text(column)//' ('//csv%names(column)%text//'): '
   end function column_text

   !> First column of a name, 0 if there is none.
   pure integer function place_of(csv, name)
      type(csv_table_t), intent(in) :: csv
      character(*), intent(in) :: name

      do place_of = 1, size(csv%names)
         if (csv%names(place_of)%text == name) return
      end do
      place_of = 0
   end function place_of

   !> The different ones of some numbers, ascending.
   pure function different(numbers) result(ascending)
      real(dp), intent(in) :: numbers(:)
      real(dp), allocatable :: ascending(:)

      ascending = [minval(numbers)]
      do while (ascending(size(ascending)) < maxval(numbers))
         ascending = [ascending, minval(numbers, mask=numbers > ascending(size(ascending)))]
      end do
   end function different

   !> Report the rows of a table, as comments of the resolved input.
   subroutine tell_rows(input, key, csv)
      type(scene_input_t), intent(inout) :: input
      !> As group.name
      character(*), intent(in) :: key
      type(csv_table_t), intent(in) :: csv
      character(:), allocatable :: names
      integer :: i

      names = ''
      do i = 1, size(csv%names)
         names = names//', '//csv%names(i)%text
      end do
      call input%report(key//' columns = '//names(3:))
      do i = 1, size(csv%lines)
         call input%report(key//' row = '//numbers_text(csv%values(i, :)))
      end do
   end subroutine tell_rows

end module table_reader
