!> Richardson extrapolation of a method whose error runs in even powers of the step, by the scheme of Neville
!> and Aitken. Column j of a row is the solution with the row's steps, freed of the first j - 1 powers.
module richardson
   use kinds, only: dp
   implicit none(type, external)
   private

   !> Rows of a table at most, and the steps of each as multiples of the first one's (Bulirsch).
   integer, parameter, public :: most_rows = 8
   integer, parameter, public :: multiples(most_rows) = [1, 2, 3, 4, 6, 8, 12, 16]

   public :: extrapolate

contains

   !> Add a row to the table. Of the table only its last row is kept, from the last column to the first.
   pure subroutine extrapolate(row, values, table)
      !> Number of the row, from 1 on
      integer, intent(in) :: row
      !> Solution with the steps of the row
      real(dp), intent(in) :: values(:)
      !> Last row: point, column counted from the last one, so that (:, 1) is the best value and (:, 2) the
      !> next best
      real(dp), intent(inout) :: table(:, :)
      integer :: j

      table(:, row) = values
      do j = row - 1, 1, -1
         table(:, j) = table(:, j + 1) + (table(:, j + 1) - table(:, j))/ &
            ((real(multiples(row), dp)/real(multiples(j), dp))**2 - 1.0_dp)
      end do
   end subroutine extrapolate

end module richardson
