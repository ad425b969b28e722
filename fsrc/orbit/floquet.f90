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

   public :: floquet_multipliers, orbit_stability

contains

   !> Eigenvalues of the Jacobian of the period map, the larger first.
   pure function floquet_multipliers(jacobian) result(multipliers)
      !> d(film, velocity at the end)/d(film, velocity at the start), units of the states
      real(dp), intent(in) :: jacobian(2, 2)
      complex(dp) :: multipliers(2)
      real(dp) :: half_trace, determinant, discriminant, larger

      half_trace = 0.5_dp*(jacobian(1, 1) + jacobian(2, 2))
      determinant = jacobian(1, 1)*jacobian(2, 2) - jacobian(1, 2)*jacobian(2, 1)
      discriminant = half_trace*half_trace - determinant
      if (discriminant < 0.0_dp) then
         multipliers(1) = cmplx(half_trace, sqrt(-discriminant), dp)
         multipliers(2) = conjg(multipliers(1))
      else
         ! The smaller one from the product: the difference of the formula would cancel.
         larger = half_trace + sign(sqrt(discriminant), half_trace)
         multipliers(1) = cmplx(larger, 0.0_dp, dp)
         multipliers(2) = (0.0_dp, 0.0_dp)
         if (abs(larger) > tiny(1.0_dp)) multipliers(2) = cmplx(determinant/larger, 0.0_dp, dp)
      end if
   end function floquet_multipliers

   !> Stability of a periodic motion by its multipliers.
   pure integer function orbit_stability(multipliers) result(code)
      !> Larger one first
      complex(dp), intent(in) :: multipliers(2)

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
