!> Tests of the Floquet multipliers of known Jacobians, and of the stability that they mean.
module test_floquet
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use checks, only: check_list_t
   use kinds, only: dp
   use linear_equations, only: eigenvalues
   use periodic_orbit, only: orbit_doubling_near, orbit_fold_near, orbit_stability, orbit_stable, orbit_torus_near, orbit_unstable
   use quantities, only: quantity_orbit_stability, quantity_word
   implicit none(type, external)
   private

   public :: run_floquet_tests

contains

   !> Runs every test of this topic.
   subroutine run_floquet_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('floquet')
      call test_multipliers(checks)
      call test_stability(checks)
   end subroutine run_floquet_tests

   !> Eigenvalues in either sign, a pair, and one so small that the formula alone would lose it.
   subroutine test_multipliers(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      complex(dp), allocatable :: found(:)

      call expect_real(-0.5_dp, 0.2_dp)
      call expect_real(0.5_dp, -0.2_dp)
      call expect_real(0.9_dp, 1.0e-12_dp)
      call expect_real(-0.9_dp, 1.0e-12_dp)
      call expect_real(0.3_dp, 0.0_dp)
      ! A turn by 60 degrees, shrunk to 0.8.
      found = eigenvalues(0.8_dp*reshape([0.5_dp, sqrt(0.75_dp), -sqrt(0.75_dp), 0.5_dp], [2, 2]))
      call checks%check_close(found(1)%re, 0.4_dp, 1.0e-15_dp, 'pair: real part')
      call checks%check_close(abs(found(1)%im), 0.8_dp*sqrt(0.75_dp), 1.0e-15_dp, 'pair: imaginary part')
      call checks%check_close(abs(found(1) - conjg(found(2))), 0.0_dp, 0.0_dp, 'pair: conjugate')
      found = eigenvalues(reshape([0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp], [2, 2]))
      call checks%check_close(maxval(abs(found)), 0.0_dp, 0.0_dp, 'no memory at all')
      found = eigenvalues(reshape([1.0_dp, ieee_value(1.0_dp, ieee_quiet_nan), 0.0_dp, 1.0_dp], [2, 2]))
      call checks%check(size(found) == 0, 'a matrix without eigenvalues has none')

   contains

      !> A Jacobian with these eigenvalues, the larger first, in a skew basis.
      subroutine expect_real(larger, smaller)
         real(dp), intent(in) :: larger   !> Eigenvalue of the larger modulus
         real(dp), intent(in) :: smaller  !> The other one

         ! Triangular: the eigenvalues stand on the diagonal, to the last bit.
         found = eigenvalues(reshape([smaller, 0.0_dp, 3.0_dp, larger], [2, 2]))
         call checks%check_close(found(1)%re, larger, 4.0_dp*epsilon(1.0_dp), 'the larger multiplier')
         call checks%check_close(found(2)%re, smaller, 4.0_dp*epsilon(1.0_dp)*abs(smaller), 'the smaller multiplier')
         call checks%check_close(maxval(abs(found%im)), 0.0_dp, 0.0_dp, 'no imaginary part')
      end subroutine expect_real

   end subroutine test_multipliers

   !> Inside the unit circle, near it in three directions, and outside.
   subroutine test_stability(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call expect((0.89_dp, 0.0_dp), orbit_stable, 'stable')
      call expect((-0.89_dp, 0.0_dp), orbit_stable, 'stable')
      call expect((-0.91_dp, 0.0_dp), orbit_doubling_near, 'stable, period doubling near')
      call expect((0.91_dp, 0.0_dp), orbit_fold_near, 'stable, fold near')
      call expect((-0.7_dp, 0.7_dp), orbit_torus_near, 'stable, torus near')
      call expect((0.6_dp, 0.6_dp), orbit_stable, 'stable')
      call expect((1.0000005_dp, 0.0_dp), orbit_fold_near, 'stable, fold near')
      call expect((1.000002_dp, 0.0_dp), orbit_unstable, 'unstable')
      call expect((-1.000002_dp, 0.0_dp), orbit_unstable, 'unstable')
      call expect((0.8_dp, 0.8_dp), orbit_unstable, 'unstable')

   contains

      !> A multiplier, its code and its words.
      subroutine expect(multiplier, code, words)
         complex(dp), intent(in) :: multiplier  !> The larger one
         integer, intent(in) :: code            !> Its stability
         character(*), intent(in) :: words      !> In words

         call checks%check(orbit_stability([multiplier, conjg(multiplier)]) == code, 'stability: '//words)
         call checks%check(quantity_word(quantity_orbit_stability, code) == words, 'words: '//words)
      end subroutine expect

   end subroutine test_stability

end module test_floquet
