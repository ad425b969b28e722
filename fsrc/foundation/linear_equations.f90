!> Linear equations, by LAPACK.
module linear_equations
   use kinds, only: dp
   implicit none(type, external)
   private

   interface
      !> Solve A X = B.
      pure subroutine dgesv(n, nrhs, a, lda, ipiv, b, ldb, info)
         import :: dp
         integer, intent(in) :: n
         integer, intent(in) :: nrhs
         integer, intent(in) :: lda
         integer, intent(in) :: ldb
         real(dp), intent(inout) :: a(lda, *)
         integer, intent(out) :: ipiv(*)
         real(dp), intent(inout) :: b(ldb, *)
         integer, intent(out) :: info
      end subroutine dgesv
   end interface

   public :: solve_linear

contains

   !> Solve A X = B for any number of right-hand sides.
   pure subroutine solve_linear(matrix, solution, solved)
      !> A, square
      real(dp), intent(in) :: matrix(:, :)
      !> B, and then X
      real(dp), intent(inout) :: solution(:, :)
      !> Whether A is regular; if not, B is spoilt
      logical, intent(out) :: solved
      real(dp) :: factors(size(matrix, 1), size(matrix, 1))
      integer :: pivots(size(matrix, 1)), info

      factors = matrix
      call dgesv(size(matrix, 1), size(solution, 2), factors, size(matrix, 1), pivots, solution, size(matrix, 1), info)
      solved = info == 0
   end subroutine solve_linear

end module linear_equations
