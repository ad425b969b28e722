!> Linear equations of an implicit step of elastic teeth (module elastic_step), a few at a time: their factors and solutions.
module step_elimination
   use kinds, only: dp
   use radau_nodes, only: rows, stages
   implicit none(type, external)
   private

   !> Rows and columns of a matrix of two flanks: each flank has a row of zeros, which fills its registers
   integer, parameter, public :: most_rows = 2*rows, most_columns = 2*stages

   !> Factors of a matrix: multipliers below the diagonal and zeros elsewhere, what stands above the diagonal and zeros elsewhere,
   !> the inverse pivots, and the row that has come to each place
   type, public :: factors_t
      real(dp) :: lower(most_rows, most_columns) = 0.0_dp, upper(most_rows, most_columns) = 0.0_dp
      real(dp) :: inverse_pivot(most_columns) = 0.0_dp
      integer :: row(most_rows) = 0
   end type factors_t

   public :: factorise, substitute

contains

   !> Factors of a matrix, which is spent. Rows are exchanged for the largest pivot; all else goes down columns, four rows at a
   !> time. LAPACK's way takes twice as long for so few.
   pure subroutine factorise(last, filled, matrix, factors)
      !> Columns, and rows with those of zeros among them
      integer, intent(in) :: last
      integer, intent(in) :: filled
      !> [-]
      real(dp), intent(inout) :: matrix(most_rows, most_columns)
      type(factors_t), intent(out) :: factors
      real(dp) :: held
      integer :: n, i, j, largest, four

      factors%row = [(n, n=1, most_rows)]
      do n = 1, last
         largest = n
         do i = n + 1, filled
            if (abs(matrix(i, n)) > abs(matrix(largest, n))) largest = i
         end do
         if (largest /= n) then
            factors%row([n, largest]) = factors%row([largest, n])
            do j = 1, n - 1
               factors%lower([n, largest], j) = factors%lower([largest, n], j)
            end do
            do j = n, last
               held = matrix(n, j)
               matrix(n, j) = matrix(largest, j)
               matrix(largest, j) = held
            end do
         end if
         factors%inverse_pivot(n) = 1.0_dp/matrix(n, n)
         do i = 1, n - 1
            factors%upper(i, n) = matrix(i, n)
         end do
         do i = n + 1, filled
            factors%lower(i, n) = matrix(i, n)*factors%inverse_pivot(n)
         end do
         do j = n + 1, last
            held = matrix(n, j)
            do four = 4*(n/4), filled - 1, 4
               !$omp simd
               do i = 1, 4
                  matrix(four + i, j) = matrix(four + i, j) - factors%lower(four + i, n)*held
               end do
            end do
         end do
      end do
   end subroutine factorise

   !> Solve linear equations by the factors of their matrix. No number is written where four are read next: that would wait for it.
   pure subroutine substitute(last, factors, right, solution)
      !> How many
      integer, intent(in) :: last
      type(factors_t), intent(in) :: factors
      !> Right-hand side, by rows, and solution, by columns [-]
      real(dp), intent(in) :: right(most_rows)
      real(dp), intent(out) :: solution(most_columns)
      real(dp) :: rest(most_rows), held
      integer :: n

      rest = 0.0_dp
      do n = 1, last
         rest(n) = right(factors%row(n))
      end do
      do n = 1, last
         held = rest(n)
         rest = rest - factors%lower(:, n)*held
      end do
      solution = 0.0_dp
      do n = last, 1, -1
         held = rest(n)*factors%inverse_pivot(n)
         solution(n) = held
         rest = rest - factors%upper(:, n)*held
      end do
   end subroutine substitute

end module step_elimination
