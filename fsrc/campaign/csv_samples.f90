!> Scenes from a CSV file: a header of group.key names, then one line of numbers for every scene. Commas
!> separate, names may stand in quotes, lines end as on Unix or Windows; nothing else is understood, and
!> every fault is reported with its line and column. The text is read in blocks.
module csv_samples
   use csv_fields, only: csv_text_t, field_t
   use errors, only: error_t, fault_list_t
   use key_table, only: key_name
   use kinds, only: dp, int64
   use memory, only: expect_memory
   use number_text, only: read_strict_integer, read_strict_real
   use signals, only: must_stop
   use text, only: integer_text
   use varied_keys, only: find_varied_key, is_whole
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
      !> (column, scene)
      real(dp), allocatable :: values(:, :)
      !> Scenes that were read: fewer than there are where the reading had to stop
      integer(int64) :: read = 0_int64
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
      character(:), allocatable :: message
      integer(int64) :: lines
      type(error_t), allocatable :: error
      integer :: before

      before = faults%count()
      allocate (samples%positions(0), samples%values(0, 0))
      call text%open(path, lines, message)
      if (len(message) > 0) then
         call faults%add(path, 0, '', '', message)
         return
      end if
      if (lines == 0_int64) then
         call faults%add(path, 0, '', '', &
                         'the file is empty; its first line must name the keys, such as '// &
                         'load.mass,load.frequency')
      else
         call read_header(text, path, samples%positions, faults)
      end if
      if (faults%count() == before .and. lines == 1_int64) &
         call faults%add(path, 1, '', '', 'there is no line of numbers after the header')
      if (faults%count() == before) then
         deallocate (samples%values)
         call expect_memory(number_bytes*real(size(samples%positions), dp)*real(lines, dp), &
                            'this table of '//integer_text(lines)//' lines (&campaign csv)', error)
         if (allocated(error)) then
            call faults%add_error(path, '', '', error)
            allocate (samples%values(0, 0))
         else
            allocate (samples%values(size(samples%positions), lines - 1_int64))
            call read_rows(text, path, samples, faults)
         end if
      end if
      call text%close()
   end subroutine read_csv_samples

   !> First line: the keys.
   subroutine read_header(text, path, positions, faults)
      type(csv_text_t), intent(inout) :: text
      character(*), intent(in) :: path
      integer, allocatable, intent(inout) :: positions(:)
      type(fault_list_t), intent(inout) :: faults
      type(field_t) :: field
      character(:), allocatable :: message
      integer :: position

      do
         call text%take_field(field)
         if (text%stopped) then
            call faults%add(path, 1, '', '', 'there was no time to read the first line to its end')
            return
         end if
         if (size(positions) == most_columns) then
            call faults%add(path, 1, '', '', 'more than '//integer_text(most_columns)//' columns')
            return
         end if
         call read_name(field, positions, position, message)
         ! A column that cannot be used keeps its place.
         positions = [positions, position]
         if (len(message) > 0) &
            call faults%add(path, 1, '', '', 'column '//integer_text(size(positions))//': '//message)
         if (field%ends_line) return
      end do
   end subroutine read_header

   !> One name of the header.
   pure subroutine read_name(field, positions, position, message)
      type(field_t), intent(in) :: field
      integer, intent(in) :: positions(:)
      integer, intent(out) :: position
      character(:), allocatable, intent(out) :: message
      character(:), allocatable :: word
      integer :: i

      position = 0
      word = field%bare()
      if (len(word) == 0) then
         message = 'a key must be named here, as in load.mass'
         return
      end if
      if (scan(word(1:1), '#!') > 0) then
         message = 'comments are not allowed'
      else
         call find_varied_key(word, position, message)
      end if
      do i = 1, size(positions)
         if (position > 0 .and. positions(i) == position) &
            message = 'this key stands in column '//integer_text(i)//' already'
      end do
      if (len(message) > 0) message = "'"//field%shown()//"': "//message
   end subroutine read_name

   !> All other lines: numbers.
   subroutine read_rows(text, path, samples, faults)
      type(csv_text_t), intent(inout) :: text
      character(*), intent(in) :: path
      type(csv_samples_t), intent(inout) :: samples
      type(fault_list_t), intent(inout) :: faults
      type(field_t) :: field
      character(:), allocatable :: message
      integer(int64) :: row
      integer :: column, columns, line
      logical :: empty

      columns = size(samples%positions)
      do row = 1_int64, size(samples%values, 2, kind=int64)
         if (must_stop()) return
         line = int(min(row + 1_int64, int(huge(1), int64)))
         column = 0
         do
            call text%take_field(field)
            if (text%stopped) return
            column = column + 1
            empty = column == 1 .and. field%ends_line .and. len(field%word()) == 0
            if (column <= columns .and. .not. empty) then
               call read_number(field, samples%positions(column), samples%values(column, row), message)
               if (len(message) > 0) &
                  call faults%add(path, line, '', '', 'column '//integer_text(column)//' ('// &
                                  key_name(samples%positions(column))//'): '//message)
            end if
            if (field%ends_line) exit
         end do
         if (text%broken) then
            call faults%add(path, line, '', '', 'it cannot be read to its end')
            return
         end if
         if (empty) then
            call faults%add(path, line, '', '', 'the line is empty; every line must hold one scene')
         else if (column /= columns) then
            call faults%add(path, line, '', '', 'the line has '//integer_text(column)// &
                            ' columns, the header '//integer_text(columns))
         end if
         samples%read = row
         ! What comes after a full list of faults is not reported anyway.
         if (faults%not_kept() > 0) return
      end do
   end subroutine read_rows

   !> One number of a key.
   pure subroutine read_number(field, position, number, message)
      type(field_t), intent(in) :: field
      integer, intent(in) :: position
      real(dp), intent(out) :: number
      character(:), allocatable, intent(out) :: message
      integer :: whole
      logical :: sound

      message = ''
      if (is_whole(position)) then
         call read_strict_integer(field%word(), whole, sound)
         number = real(whole, dp)
      else
         call read_strict_real(field%word(), number, sound)
      end if
      if (sound) return
      if (len(field%word()) == 0) then
         message = 'a number is missing'
      else if (is_whole(position)) then
         message = "'"//field%shown()//"' is not an integer"
      else
         message = "'"//field%shown()//"' is not a number"
      end if
   end subroutine read_number

end module csv_samples
