!> Eigenvalues of small matrices, by LAPACK.
module matrix_values
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use kinds, only: dp
   implicit none(type, external)
   private

   interface
      !> Eigenvalues of a general matrix.
      pure subroutine dgeev(jobvl, jobvr, n, a, lda, wr, wi, vl, ldvl, vr, ldvr, work, lwork, info)
         import :: dp
         character, intent(in) :: jobvl
         character, intent(in) :: jobvr
         integer, intent(in) :: n
         integer, intent(in) :: lda
         integer, intent(in) :: ldvl
         integer, intent(in) :: ldvr
         integer, intent(in) :: lwork
         real(dp), intent(inout) :: a(lda, *)
         real(dp), intent(out) :: wr(*)
         real(dp), intent(out) :: wi(*)
         real(dp), intent(out) :: vl(ldvl, *)
         real(dp), intent(out) :: vr(ldvr, *)
         real(dp), intent(out) :: work(*)
         integer, intent(out) :: info
      end subroutine dgeev
   end interface

   public :: eigenvalues

contains

   !> Eigenvalues of a matrix, the largest first; of a complex pair the one with the positive imaginary part.
   !> None at all where LAPACK finds none.
   pure function eigenvalues(matrix) result(values)
      !> Square, of numbers of like size
      real(dp), intent(in) :: matrix(:, :)
      complex(dp), allocatable :: values(:)
      real(dp), dimension(size(matrix, 1)) :: real_part, imaginary_part
      real(dp) :: copy(size(matrix, 1), size(matrix, 1)), work(8*size(matrix, 1)), no_left(1, 1), no_right(1, 1)
      logical :: left(size(matrix, 1))
      integer :: n, i, largest, info

      n = size(matrix, 1)
      copy = matrix
      allocate (values(merge(n, 0, all(ieee_is_finite(matrix)))))
      if (size(values) == 0) return
      call dgeev('N', 'N', n, copy, n, real_part, imaginary_part, no_left, 1, no_right, 1, work, size(work), info)
      if (info /= 0) values = values(:0)
      left = .true.
      do i = 1, size(values)
         largest = maxloc(hypot(real_part, imaginary_part), dim=1, mask=left)
         left(largest) = .false.
         values(i) = cmplx(real_part(largest), imaginary_part(largest), dp)
      end do
   end function eigenvalues

end module matrix_values
