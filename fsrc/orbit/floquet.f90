!> Floquet multipliers of a periodic motion, and what they say of its stability.
module floquet
   use kinds, only: dp
   use matrix_values, only: eigenvalues
   implicit none(type, external)
   private

   integer, parameter, public :: orbit_stable = 1, orbit_doubling_near = 2, orbit_fold_near = 3, orbit_torus_near = 4, &
                         orbit_unstable = 5

   !> A multiplier beyond this is near the unit circle.
   real(dp), parameter :: near = 0.9_dp
   !> Error of the multipliers themselves.
   real(dp), parameter :: tolerance = 1.0e-6_dp

   public :: floquet_multipliers, orbit_stability

contains

   !> Eigenvalues of the Jacobian of the period map, the largest first.
   pure function floquet_multipliers(jacobian) result(multipliers)
      !> d(state at the end)/d(state at the start), numbers of like size
      real(dp), intent(in) :: jacobian(:, :)
      complex(dp) :: multipliers(size(jacobian, 1))

      multipliers = eigenvalues(jacobian)
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
