!> What is recorded of every scene of a campaign: columns, and the row of a scene. NaN: unknown.
module campaign_record
   use judged_scene, only: judged_scene_t, quantity_numbers
   use key_table, only: keys
   use kinds, only: dp, int64
   use quantities, only: a_list, columns_of, numbers_in_a_row, quantity_t, quantity_table
   use result_format, only: column_name_bytes, column_unit_bytes
   use scene_types, only: scene_t
   use varied_keys, only: varied_name
   implicit none(type, external)
   private

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
      type(quantity_t), allocatable :: recorded(:)
      integer :: i

      allocate (names(0), units(0))
      call put(names, units, 'scene', '-')
      do i = 1, size(positions)
         call put(names, units, varied_name(positions(i)), keys(positions(i))%unit)
         if (units(size(units)) == '') units(size(units)) = '-'
      end do
      call put(names, units, 'status', '-')
      allocate (recorded, source=columns_of(scene%campaign%record))
      names = [character(column_name_bytes) :: names, recorded%name]
      units = [character(column_unit_bytes) :: units, recorded%unit]
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
      integer :: column

      row(1) = real(number, dp)
      row(2:1 + size(values)) = values
      column = 2 + size(values)
      row(column) = real(judged%status, dp)
      row(column + 1:) = quantity_numbers(scene%campaign%record, judged)
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
         column = column - merge(numbers_in_a_row, 1, quantity_table(scene%campaign%record(i))%kind == a_list)
      end do
   end subroutine record_number

end module campaign_record
