!> What is recorded of every scene of a campaign: columns, and the row of a scene. NaN: unknown.
module campaign_record
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use judged_scene, only: judged_scene_t, quantity_list, quantity_value
   use key_table, only: keys
   use kinds, only: dp, int64
   use quantities, only: a_list, quantity_t, quantity_table
   use result_format, only: column_name_bytes, column_unit_bytes
   use scene_types, only: scene_t
   use text, only: integer_text
   use varied_keys, only: varied_name
   implicit none(type, external)
   private

   !> Numbers of a list that are recorded.
   integer, parameter :: recorded_numbers = 8

   public :: record_columns, record_number, record_row

contains

   !> Names and units of the columns: scene, varied keys, status, then what is recorded.
   pure subroutine record_columns(scene, positions, names, units)
      !> Checked base scene
      type(scene_t), intent(in) :: scene
      !> Varied keys by their position in the key table
      integer, intent(in) :: positions(:)
      !> Names
      character(column_name_bytes), allocatable, intent(out) :: names(:)
      !> Units
      character(column_unit_bytes), allocatable, intent(out) :: units(:)
      type(quantity_t) :: quantity
      integer :: i, n

      allocate (names(0), units(0))
      call put(names, units, 'scene', '-')
      do i = 1, size(positions)
         call put(names, units, varied_name(positions(i)), keys(positions(i))%unit)
         if (units(size(units)) == '') units(size(units)) = '-'
      end do
      call put(names, units, 'status', '-')
      do i = 1, size(scene%campaign%record)
         quantity = quantity_table(scene%campaign%record(i))
         if (quantity%kind == a_list) then
            do n = 1, recorded_numbers
               ! In the singular.
               call put(names, units, quantity%name(:len_trim(quantity%name) - 1)//'_'//integer_text(n), quantity%unit)
            end do
         else
            call put(names, units, quantity%name, quantity%unit)
         end if
      end do

   end subroutine record_columns

   !> Append a column.
   pure subroutine put(names, units, name, unit)
      character(column_name_bytes), allocatable, intent(inout) :: names(:)
      character(column_unit_bytes), allocatable, intent(inout) :: units(:)
      character(*), intent(in) :: name
      character(*), intent(in) :: unit
      character(column_name_bytes) :: full_name
      character(column_unit_bytes) :: full_unit

      full_name = name
      full_unit = unit
      names = [names, full_name]
      units = [units, full_unit]
   end subroutine put

   !> Row of a scene.
   pure subroutine record_row(scene, number, values, judged, row)
      !> Base scene, for the choice of columns
      type(scene_t), intent(in) :: scene
      !> Number of the scene, from 1
      integer(int64), intent(in) :: number
      !> Values of the varied keys
      real(dp), intent(in) :: values(:)
      !> The judged scene
      type(judged_scene_t), intent(in) :: judged
      !> The row
      real(dp), intent(out) :: row(:)
      real(dp), allocatable :: list(:)
      integer :: i, code, column

      row(1) = real(number, dp)
      row(2:1 + size(values)) = values
      column = 2 + size(values)
      row(column) = real(judged%status, dp)
      do i = 1, size(scene%campaign%record)
         code = scene%campaign%record(i)
         if (quantity_table(code)%kind == a_list) then
            if (allocated(list)) deallocate (list)
            allocate (list, source=quantity_list(code, judged))
            row(column + 1:column + recorded_numbers) = ieee_value(0.0_dp, ieee_quiet_nan)
            if (size(list) > 0) row(column + 1:column + recorded_numbers) = list(:recorded_numbers)
            column = column + recorded_numbers
         else
            column = column + 1
            row(column) = quantity_value(code, judged)
         end if
      end do
   end subroutine record_row

   !> Put a number into its place in a row, if it is recorded.
   pure subroutine record_number(scene, code, number, row)
      !> Base scene, for the choice of columns
      type(scene_t), intent(in) :: scene
      !> Code of a quantity that is no list
      integer, intent(in) :: code
      real(dp), intent(in) :: number
      !> With all other columns
      real(dp), intent(inout) :: row(:)
      integer :: column, i

      ! They stand at the end of a row.
      column = size(row)
      do i = size(scene%campaign%record), 1, -1
         if (scene%campaign%record(i) == code) row(column) = number
         column = column - merge(recorded_numbers, 1, quantity_table(scene%campaign%record(i))%kind == a_list)
      end do
   end subroutine record_number

end module campaign_record
