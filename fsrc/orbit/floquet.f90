!> Floquet multipliers of a periodic motion, and what they say of its stability.
module floquet
   use kinds, only: dp
   implicit none(type, external)
   private

   integer, parameter, public :: orbit_stable = 1, orbit_doubling_near = 2, orbit_fold_near = 3, orbit_torus_near = 4, &
                         orbit_unstable = 5

   !> A multiplier beyond this is near the unit circle.
   real(dp), parameter :: near = 0.9_dp
   !> Error of the multipliers themselves.
   real(dp), parameter :: tolerance = 1.0e-6_dp

   interface
      !> Eigenvalues of a general matrix (LAPACK).
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

   public :: floquet_multipliers, orbit_stability

contains

   !> Eigenvalues of the Jacobian of the period map, the largest first.
   pure function floquet_multipliers(jacobian) result(multipliers)
      !> d(state at the end)/d(state at the start), numbers of like size
      real(dp), intent(in) :: jacobian(:, :)
      complex(dp) :: multipliers(size(jacobian, 1))
      real(dp), dimension(size(jacobian, 1)) :: real_part, imaginary_part
      real(dp) :: matrix(size(jacobian, 1), size(jacobian, 1)), work(8*size(jacobian, 1)), none(1, 1)
      logical :: left(size(jacobian, 1))
      integer :: n, i, largest, info

      n = size(jacobian, 1)
      matrix = jacobian
      call dgeev('N', 'N', n, matrix, n, real_part, imaginary_part, none, 1, none, 1, work, size(work), info)
      left = .true.
      do i = 1, n
         ! Of a complex pair the one with the positive imaginary part stands first, as in LAPACK.
         largest = maxloc(hypot(real_part, imaginary_part), dim=1, mask=left)
         left(largest) = .false.
         multipliers(i) = cmplx(real_part(largest), imaginary_part(largest), dp)
      end do
   end function floquet_multipliers

   !> Stability of a periodic motion by its multipliers.
   pure integer function orbit_stability(multipliers) result(code)
      !> Largest one first
      complex(dp), intent(in) :: multipliers(:)

      code = orbit_stable
      if (abs(multipliers(1)) > 1.0_dp + tolerance) then
         code = orbit_unstable
      else if (abs(multipliers(1)) > near) then
         if (abs(multipliers(1)%im) > 0.0_dp) then
            code = orbit_torus_near
         else if (multipliers(1)%re < 0.0_dp) then
            code = orbit_doubling_near
         else
            code = orbit_fold_near
         end if
      end if
   end function orbit_stability

end module floquet
