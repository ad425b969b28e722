!> Richardson extrapolation of a method whose error runs in even powers of the step, by the scheme of Neville
!> and Aitken. Column j of a row is the solution with the row's steps, freed of the first j - 1 powers.
module richardson
   use kinds, only: dp
   implicit none(type, external)
   private

   !> Rows of a table at most, and the steps of each as multiples of the first one's (Bulirsch).
   integer, parameter, public :: most_rows = 8
   integer, parameter, public :: multiples(most_rows) = [1, 2, 3, 4, 6, 8, 12, 16]

   !> Relative differences below this are the rounding of thousands of steps, and say nothing of the expansion.
   real(dp), parameter :: rounding = 256.0_dp*epsilon(1.0_dp)

   public :: extrapolate, doubt

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

   !> How many times the error of the best value may exceed the difference of the last two columns, at least 1.
   !> A row moves the best value by (n_row/n_1)^2 times that difference: so much is credited to the order of the
   !> last column, which one row cannot prove. Where the first rows are too coarse to follow the expansion, terms
   !> that cancel by chance make the difference small, and the credit makes it smaller. So no more than
   !> `most_credit` is given, and what the row before had promised must have held.
   pure real(dp) function doubt(row, change, last_change, most_credit)
      !> Number of the row, from 2 on
      integer, intent(in) :: row
      !> Largest difference of the last two columns of the row, relative to the values
      real(dp), intent(in) :: change
      !> The same of the row before; huge if that was the first one
      real(dp), intent(in) :: last_change
      !> Most credit given [-]
      real(dp), intent(in) :: most_credit
      real(dp) :: credit

      credit = (real(multiples(row), dp)/real(multiples(1), dp))**2
      doubt = max(1.0_dp, credit/most_credit, credit*(change - rounding)/max(last_change, rounding))
   end function doubt

end module richardson
