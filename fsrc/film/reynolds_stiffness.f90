!> Stiffness of the Reynolds films in the groups of modules reynolds_iso_viscous and reynolds_piezo_viscous:
!>
!>    -dW/dh0 = 12 l u eta0 R/h0**2 T,   T = Phi + (A/2) dPhi/dA                      iso-viscous
!>                                       T = Psi + (A/2) dPsi/dA + (3/2) B dPsi/dB    piezo-viscous
!>
!> The load of a film that separates fast hardly depends on its thickness: Phi and Psi fall off with 1/A**2, T with
!> 1/A**4, and its terms cancel. There x = 1/A**2 goes with h0, and T = -x**2 d(Psi/x)/dx at constant B x**(-3/2) comes
!> from the tables of module separation_coefficients, in which nothing cancels.
!>
!> Relative error below 1e-12 for every A, of the piezo-viscous one up to 0.99 B_crit, growing as epsilon/(1 - B/B_crit)
!> from there on. T underflows to zero beyond A = 1e77.
module reynolds_stiffness
   use kinds, only: dp
   use piezo_viscous_sums, only: table_coordinate
   use reynolds_iso_viscous, only: peak_pressure_group
   use separation_coefficients, only: first_group, separation_degree, separation_load, separation_log_peak, &
      separation_piezo_load, separation_sigma_degree
   implicit none(type, external)
   private

   public :: iso_viscous_stiffness, piezo_viscous_stiffness

contains

   !> T [-] of the iso-viscous film.
   elemental real(dp) function iso_viscous_stiffness(a, phi, phi_by_a) result(stiffness)
      !> Squeeze group A [-]
      real(dp), intent(in) :: a
      !> Phi(A) [-]
      real(dp), intent(in) :: phi
      !> dPhi/dA [-]
      real(dp), intent(in) :: phi_by_a
      real(dp) :: u, load, load_by_u

      if (a > first_group) then
         u = (first_group/a)**2
         call sum_powers(separation_load, u, load, load_by_u)
         stiffness = -(u/first_group**2)*u*load_by_u
      else
         stiffness = phi + 0.5_dp*a*phi_by_a
      end if
   end function iso_viscous_stiffness

   !> T [-] of the piezo-viscous film.
   elemental real(dp) function piezo_viscous_stiffness(a, b, psi, psi_by_a, psi_by_b) result(stiffness)
      !> Squeeze group A [-]
      real(dp), intent(in) :: a
      !> Pressure group 0 <= B < B_crit(A) [-]
      real(dp), intent(in) :: b
      !> Psi(A, B) [-]
      real(dp), intent(in) :: psi
      !> dPsi/dA at constant B [-]
      real(dp), intent(in) :: psi_by_a
      !> dPsi/dB at constant A [-]
      real(dp), intent(in) :: psi_by_b

      if (a > first_group) then
         stiffness = separating_stiffness(a, b)
      else
         stiffness = psi + 0.5_dp*a*psi_by_a + 1.5_dp*b*psi_by_b
      end if
   end function piezo_viscous_stiffness

   !> T [-] of the piezo-viscous film that separates fast.
   elemental real(dp) function separating_stiffness(a, b) result(stiffness)
      !> Squeeze group A > first_group [-]
      real(dp), intent(in) :: a
      !> Pressure group 0 <= B < B_crit(A) [-]
      real(dp), intent(in) :: b
      real(dp) :: u, peak, peak_by_a, used, sigma, w, w_by_sigma, row, row_by_u, load, load_by_u, load_by_w
      integer :: j

      u = (first_group/a)**2
      call peak_pressure_group(a, peak, peak_by_a)
      used = b*peak
      ! The difference may round to nothing just below B_crit.
      sigma = sqrt(max(1.0_dp - used, epsilon(1.0_dp)))
      call table_coordinate(sigma, w, w_by_sigma)
      load = 0.0_dp
      load_by_u = 0.0_dp
      load_by_w = 0.0_dp
      do j = separation_sigma_degree, 0, -1
         call sum_powers(separation_piezo_load(:, j), u, row, row_by_u)
         load_by_w = load_by_w*w + load
         load = load*w + row
         load_by_u = load_by_u*w + row_by_u
      end do
      ! sigma moves with u as used = 1 - sigma**2 does, which goes with max p* A**3.
      call sum_powers(separation_log_peak, u, row, row_by_u)
      stiffness = -(u/first_group**2)*u*(load_by_u - load_by_w*w_by_sigma*used*row_by_u/(2.0_dp*sigma))
   end function separating_stiffness

   !> A table in powers of u, and its slope.
   pure subroutine sum_powers(table, u, total, slope)
      !> Coefficients of ascending powers
      real(dp), intent(in) :: table(0:separation_degree)
      !> (first_group/A)**2 [-]
      real(dp), intent(in) :: u
      !> Sum
      real(dp), intent(out) :: total
      !> Its derivative with respect to u
      real(dp), intent(out) :: slope
      integer :: k

      total = 0.0_dp
      slope = 0.0_dp
      do k = separation_degree, 0, -1
         slope = slope*u + total
         total = total*u + table(k)
      end do
   end subroutine sum_powers

end module reynolds_stiffness
