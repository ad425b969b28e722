!> Tests of linear equations: the elimination of the program against LAPACK.
module test_linear_equations
   use checks, only: check_list_t
   use kinds, only: dp
   use linear_equations, only: eliminate, solve_linear
   use text, only: integer_text
   implicit none(type, external)
   private

   public :: run_linear_equations_tests

contains

   !> Runs every test of this topic.
   subroutine run_linear_equations_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('linear_equations')
      call test_elimination(checks)
      call test_singular(checks)
   end subroutine run_linear_equations_tests

   !> Whole panels of columns and parts of them, with rows that have to change places; answers of both methods differ by rounding
   !> times the condition of the matrix, some thousands.
   subroutine test_elimination(checks)
      type(check_list_t), intent(inout) :: checks
      integer, parameter :: sizes(9) = [1, 2, 3, 4, 5, 8, 23, 64, 65]
      real(dp), allocatable :: matrix(:, :), right(:, :), table(:, :)
      logical :: solved, other_solved
      integer :: n, i, j, case

      do case = 1, size(sizes)
         n = sizes(case)
         allocate (matrix(n, n), right(n, 2), table(n, n + 2))
         do j = 1, n
            do i = 1, n
               matrix(i, j) = sin(real(3*i*i + 7*j*i + j, dp))
            end do
            ! Without a change of rows the first pivots would be nothing.
            if (n > 1) matrix(j, j) = 0.0_dp
            right(j, :) = [cos(real(j, dp)), real(j, dp)]
         end do
         table(:, :n) = matrix
         table(:, n + 1:) = right
         call solve_linear(matrix, right, other_solved)
         call eliminate(n, n + 2, table, solved)
         call checks%check(solved .and. other_solved, integer_text(n)//' equations are solved')
         call checks%check_close(maxval(abs(table(:, n + 1:) - right))/maxval(abs(right)), 0.0_dp, 1.0e-11_dp, &
                                 integer_text(n)//' equations: answer')
         deallocate (matrix, right, table)
      end do
   end subroutine test_elimination

   !> Two rows alike have no answer.
   subroutine test_singular(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp) :: table(6, 7)
      logical :: solved
      integer :: i, j

      do j = 1, 7
         do i = 1, 6
            table(i, j) = real(i**j, dp)
         end do
      end do
      table(5, :) = 0.0_dp
      call eliminate(6, 7, table, solved)
      call checks%check(.not. solved, 'a row of nothing is reported')
   end subroutine test_singular

end module test_linear_equations
