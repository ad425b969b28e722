!> Reynolds film of rigid flanks and Barus oil (fsrc/THEORY.md, section 2): Psi(A, B) by a table over sigma = sqrt(1 - B/B_crit).
!>
!> Valid: finite A, 0 <= B < B_crit(A). Any other B gives NaN in all three answers and raises no floating-point exception; so does
!> a NaN or infinite A or a NaN B, which may raise the invalid one. Where numbers leave the range of their kind: from A = 3.4e102
!> on B_crit is above the largest number, and infinite; dPsi/dB underflows beyond A = 1e61 and overflows below A = -1e153.
!> Relative error: Psi 1e-14, slopes 1e-12, both growing as epsilon/(1 - B/B_crit) towards B_crit.
!> A film gets the same bits from the scalar and the array procedure, wherever it stands in the array.
module reynolds_piezo_viscous
   use kinds, only: dp, int64
   use iso_viscous_sums, only: film_block, film_coordinate, film_coordinate_block
   use piezo_viscous_sums, only: sum_block, sum_film, table_coordinate
   use reynolds_iso_viscous, only: iso_viscous_load, iso_viscous_load_array, peak_pressure_group, &
      peak_pressure_block
   implicit none(type, external)
   private

   public :: critical_pressure_group, piezo_viscous_load, piezo_viscous_load_array

   !> A quiet NaN; the IEEE modules would cost a save of the floating-point state in every call.
   real(dp), parameter :: quiet_nan = transfer(9221120237041090560_int64, 1.0_dp)
   real(dp), parameter :: infinity = transfer(9218868437227405312_int64, 1.0_dp)

   !> Least peak pressure group whose inverse is a finite number, next above 2**-1024.
   real(dp), parameter :: least_peak = nearest(0.25_dp*tiny(1.0_dp), 1.0_dp)

contains

   !> B_crit = 1/max p* [-], the pressure group up to which a rigid piezo-viscous film exists; infinite where it is
   !> above the largest number, for then every B has a film.
   elemental function critical_pressure_group(a) result(critical)
      !> Squeeze group A [-].
      real(dp), intent(in) :: a
      real(dp) :: critical

      real(dp) :: peak, dpeak_da

      call peak_pressure_group(a, peak, dpeak_da)
      critical = 1.0_dp/peak_or(least_peak, peak)
      if (peak < least_peak) critical = infinity

   end function critical_pressure_group

   !> Load group Psi [-] and its slopes; W = 12 l u eta0 R/h0 Psi.
   elemental subroutine piezo_viscous_load(a, b, psi, dpsi_da, dpsi_db)
      !> Squeeze group A [-].
      real(dp), intent(in) :: a
      !> Pressure group B [-].
      real(dp), intent(in) :: b
      !> Load group Psi(A, B) [-], positive.
      real(dp), intent(out) :: psi
      !> Slope dPsi/dA at constant B [-], negative.
      real(dp), intent(out) :: dpsi_da
      !> Slope dPsi/dB at constant A [-], positive.
      real(dp), intent(out) :: dpsi_db

      real(dp) :: phi, dphi_da, peak, dpeak_da, v, dv_da, held, used, sigma, defect
      real(dp) :: w, dw, s, ds_dv, ds_dw

      call iso_viscous_load(a, phi, dphi_da)
      call peak_pressure_group(a, peak, dpeak_da)
      call film_coordinate(a, v, dv_da)
      call enter_sigma(b, peak, held, used, sigma, defect)
      call table_coordinate(sigma, w, dw)
      call sum_film(sign(1.0_dp, a), v, w, s, ds_dv, ds_dw)
      call assemble(phi, dphi_da, peak, dpeak_da, held, used, sigma, s, ds_dv*dv_da, ds_dw*dw, psi, &
         dpsi_da, dpsi_db)
      psi = psi + defect
      dpsi_da = dpsi_da + defect
      dpsi_db = dpsi_db + defect

   end subroutine piezo_viscous_load

   !> Load groups and slopes of many films.
   pure subroutine piezo_viscous_load_array(n, a, b, psi, dpsi_da, dpsi_db)
      !> Number of films.
      integer, intent(in) :: n
      !> Squeeze groups A [-].
      real(dp), intent(in) :: a(n)
      !> Pressure groups B [-].
      real(dp), intent(in) :: b(n)
      !> Load groups Psi(A, B) [-], positive.
      real(dp), intent(out) :: psi(n)
      !> Slopes dPsi/dA at constant B [-], negative.
      real(dp), intent(out) :: dpsi_da(n)
      !> Slopes dPsi/dB at constant A [-], positive.
      real(dp), intent(out) :: dpsi_db(n)

      integer :: i, last

      do i = 1, n, film_block
         last = min(i + film_block - 1, n)
         call load_block(last - i + 1, a(i:last), b(i:last), psi(i:last), dpsi_da(i:last), dpsi_db(i:last))
      end do

   end subroutine piezo_viscous_load_array

   !> Load groups and slopes of one block of films.
   pure subroutine load_block(m, a, b, psi, dpsi_da, dpsi_db)
      !> Number of films, at most film_block.
      integer, intent(in) :: m
      !> Squeeze groups A [-].
      real(dp), intent(in) :: a(m)
      !> Pressure groups B [-].
      real(dp), intent(in) :: b(m)
      !> Load groups Psi(A, B) [-], positive.
      real(dp), intent(out) :: psi(m)
      !> Slopes dPsi/dA at constant B [-], negative.
      real(dp), intent(out) :: dpsi_da(m)
      !> Slopes dPsi/dB at constant A [-], positive.
      real(dp), intent(out) :: dpsi_db(m)

      real(dp), dimension(film_block) :: phi, dphi_da, peak, dpeak_da, v, dv_da, held, used, sigma
      real(dp), dimension(film_block) :: defect, w, dw, s, ds_dv, ds_dw
      integer :: i

      call iso_viscous_load_array(m, a, phi, dphi_da)
      call peak_pressure_block(m, a, peak, dpeak_da)
      call film_coordinate_block(m, a, v, dv_da)
      !$omp simd
      do i = 1, m
         call enter_sigma(b(i), peak(i), held(i), used(i), sigma(i), defect(i))
      end do
      !$omp simd
      do i = 1, m
         call table_coordinate(sigma(i), w(i), dw(i))
      end do
      call sum_block(m, a, v, w, s, ds_dv, ds_dw)
      !$omp simd
      do i = 1, m
         call assemble(phi(i), dphi_da(i), peak(i), dpeak_da(i), held(i), used(i), sigma(i), s(i), &
            ds_dv(i)*dv_da(i), ds_dw(i)*dw(i), psi(i), dpsi_da(i), dpsi_db(i))
         psi(i) = psi(i) + defect(i)
         dpsi_da(i) = dpsi_da(i) + defect(i)
         dpsi_db(i) = dpsi_db(i) + defect(i)
      end do

   end subroutine load_block

   !> Peak pressure group, or a bound where it has fallen below.
   elemental function peak_or(bound, peak) result(bounded)
      !> Bound [-].
      real(dp), intent(in) :: bound
      !> Highest pressure group max p* [-].
      real(dp), intent(in) :: peak
      real(dp) :: bounded

      bounded = merge(bound, peak, peak < bound)

   end function peak_or

   !> Turn B into sigma = sqrt(1 - B/B_crit); without a rigid film take B = 0 and mark the film.
   elemental subroutine enter_sigma(b, peak, held, used, sigma, defect)
      !> Pressure group B [-].
      real(dp), intent(in) :: b
      !> Highest pressure group max p* [-].
      real(dp), intent(in) :: peak
      !> B, or zero where there is no rigid film [-].
      real(dp), intent(out) :: held
      !> B/B_crit = alpha times the highest iso-viscous pressure, or zero where there is no rigid film [-].
      real(dp), intent(out) :: used
      !> sqrt(1 - B/B_crit) [-].
      real(dp), intent(out) :: sigma
      !> Zero, or NaN where there is no rigid film.
      real(dp), intent(out) :: defect

      real(dp) :: gap

      ! B max p* could overflow, so B meets B_crit first, unless max p* is that small; the product may still round
      ! to one.
      held = merge(b, 0.0_dp, b >= 0.0_dp .and. (b < 1.0_dp/peak_or(tiny(peak), peak) .or. peak < tiny(peak)))
      used = held*peak
      gap = 1.0_dp - used
      sigma = sqrt(merge(gap, 1.0_dp, gap > 0.0_dp))
      defect = merge(0.0_dp, quiet_nan, b >= 0.0_dp .and. held >= b .and. gap > 0.0_dp)

   end subroutine enter_sigma

   !> Put Psi = Phi (1 + (1 - sigma) S) and its slopes together.
   elemental subroutine assemble(phi, dphi_da, peak, dpeak_da, b, used, sigma, s, ds_da, ds_dsigma, psi, &
      dpsi_da, dpsi_db)
      !> Iso-viscous load group Phi [-].
      real(dp), intent(in) :: phi
      !> Slope dPhi/dA [-].
      real(dp), intent(in) :: dphi_da
      !> Highest pressure group max p* [-].
      real(dp), intent(in) :: peak
      !> Slope d(max p*)/dA [-].
      real(dp), intent(in) :: dpeak_da
      !> Pressure group B [-].
      real(dp), intent(in) :: b
      !> B/B_crit [-].
      real(dp), intent(in) :: used
      !> sqrt(1 - B/B_crit) [-].
      real(dp), intent(in) :: sigma
      !> Tabulated excess S [-].
      real(dp), intent(in) :: s
      !> Slope of S in A at constant sigma [-].
      real(dp), intent(in) :: ds_da
      !> Slope of S in sigma at constant A [-].
      real(dp), intent(in) :: ds_dsigma
      !> Load group Psi [-].
      real(dp), intent(out) :: psi
      !> Slope dPsi/dA at constant B [-].
      real(dp), intent(out) :: dpsi_da
      !> Slope dPsi/dB at constant A [-].
      real(dp), intent(out) :: dpsi_db

      real(dp) :: rest, ratio, pull

      ! 1 - sigma without cancellation as B -> 0; pull = -dPsi/d(sigma**2).
      rest = used/(1.0_dp + sigma)
      ratio = 1.0_dp + rest*s
      pull = phi*(s - rest*ds_dsigma)/(2.0_dp*sigma)
      psi = phi*ratio
      dpsi_da = dphi_da*ratio + (phi*(rest*ds_da) + (b*pull)*dpeak_da)
      dpsi_db = pull*peak

   end subroutine assemble

end module reynolds_piezo_viscous
