!> Rows of a table, one for each lane of half a block, brought side by side.
!>
!> Where one register holds a number of every lane, whole rows are loaded, and exchanged between registers in three stages,
!> which compilers know as eight interleaved stores. Where registers are narrower, exchanges between them cost more than
!> loads, and registers are filled number by number.
module lane_rows
   use kinds, only: dp
   use lane_functions, only: half_block
   implicit none(type, external)
   private

   !> Whether one register of the processor that is compiled for holds half a block.
   logical, parameter, public :: wide_registers = WIDE_REGISTERS

   public :: interleave_rows

contains

   !> Rows of equal length, the lane first.
   pure subroutine interleave_rows(length, row_1, row_2, row_3, row_4, row_5, row_6, row_7, row_8, columns)
      !> Numbers of a row, a multiple of half_block
      integer, intent(in) :: length
      !> Row of every lane
      real(dp), dimension(length), intent(in) :: row_1, row_2, row_3, row_4, row_5, row_6, row_7, row_8
      !> The same numbers: lane, place in the row
      real(dp), intent(out) :: columns(half_block, length)
      integer :: i

      !$omp simd if(simd: wide_registers)
      do i = 1, length
         columns(1, i) = row_1(i)
         columns(2, i) = row_2(i)
         columns(3, i) = row_3(i)
         columns(4, i) = row_4(i)
         columns(5, i) = row_5(i)
         columns(6, i) = row_6(i)
         columns(7, i) = row_7(i)
         columns(8, i) = row_8(i)
      end do
   end subroutine interleave_rows

end module lane_rows
