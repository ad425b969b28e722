!> Reynolds film of rigid flanks and iso-viscous oil (fsrc/THEORY.md, section 2): rupture (18), load (20) and (21), corrected, as
!> functions of A = 4 w*/sqrt(2 h*) alone, with w the squeeze velocity [m/s] and u = u1 + u2 the sum of the surface speeds [m/s].
!>
!> The closed forms cancel near x_e = -pi/2 (large A), so the kernels sum tables whose asymptotes are divided out.
!>
!> Every finite A is valid; relative errors are a few epsilon (t_e: relative to max(1, |t_e|)). What falls off
!> on separation underflows to zero at last (Phi beyond A = 1e153). NaN or infinite A: the answer is NaN.
!> A film gets the same bits from the scalar and the array procedures, wherever it stands in the array.
module reynolds_iso_viscous
   use kinds, only: dp
   use iso_viscous_coefficients, only: tangent_table, tangent_slope_table, load_table, load_slope_table, &
      peak_table, peak_slope_table
   use iso_viscous_sums, only: film_block, locate, locate_block, choose_half, sum_table, sum_block
   implicit none(type, external)
   private

   public :: rupture_tangent_fast, rupture_tangent_slope, rupture_angle
   public :: iso_viscous_load, iso_viscous_load_array
   public :: peak_pressure_group, peak_block, peak_pressure_block

contains

   !> Tangent of the rupture angle, t_e = tan x_e [-], exact root of eq (18).
   elemental function rupture_tangent_fast(a) result(tangent)
      !> Squeeze group A [-].
      real(dp), intent(in) :: a
      real(dp) :: tangent

      real(dp) :: v, xi, root, reach, decay, share

      call locate(a, v, xi, root, reach, decay, share)
      tangent = root*sum_table(tangent_table, sign(1.0_dp, a), v)

   end function rupture_tangent_fast

   !> Slope dt_e/dA [-] of the rupture tangent; it runs from -1 to -3/8.
   elemental function rupture_tangent_slope(a) result(slope)
      !> Squeeze group A [-].
      real(dp), intent(in) :: a
      real(dp) :: slope

      real(dp) :: v, xi, root, reach, decay, share

      call locate(a, v, xi, root, reach, decay, share)
      slope = sum_table(tangent_slope_table, sign(1.0_dp, a), v)

   end function rupture_tangent_slope

   !> Rupture angle x_e [rad] of eq (18).
   elemental function rupture_angle(a) result(angle)
      !> Squeeze group A [-].
      real(dp), intent(in) :: a
      real(dp) :: angle

      angle = atan(rupture_tangent_fast(a))

   end function rupture_angle

   !> Load group Phi [-] and its slope; W = 12 l u eta0 R/h0 Phi.
   elemental subroutine iso_viscous_load(a, phi, dphi_da)
      !> Squeeze group A [-].
      real(dp), intent(in) :: a
      !> Load group Phi(A) [-], positive.
      real(dp), intent(out) :: phi
      !> Slope dPhi/dA [-], negative.
      real(dp), intent(out) :: dphi_da

      real(dp) :: v, xi, root, lead, fall, share

      call locate(a, v, xi, root, lead, fall, share)
      call choose_half(a, lead, fall)
      phi = lead*(fall*fall)*share*sum_table(load_table, sign(1.0_dp, a), v)
      dphi_da = (fall*share)*(fall*share)*(fall*share)*sum_table(load_slope_table, sign(1.0_dp, a), v)

   end subroutine iso_viscous_load

   !> Load group and slope of many films.
   pure subroutine iso_viscous_load_array(n, a, phi, dphi_da)
      !> Number of films.
      integer, intent(in) :: n
      !> Squeeze groups A [-].
      real(dp), intent(in) :: a(n)
      !> Load groups Phi(A) [-], positive.
      real(dp), intent(out) :: phi(n)
      !> Slopes dPhi/dA [-], negative.
      real(dp), intent(out) :: dphi_da(n)

      integer :: i, last

      do i = 1, n, film_block
         last = min(i + film_block - 1, n)
         call load_block(last - i + 1, a(i:last), phi(i:last), dphi_da(i:last))
      end do

   end subroutine iso_viscous_load_array

   !> Load group and slope of one block of films.
   pure subroutine load_block(m, a, phi, dphi_da)
      !> Number of films, at most film_block.
      integer, intent(in) :: m
      !> Squeeze groups A [-].
      real(dp), intent(in) :: a(m)
      !> Load groups Phi(A) [-], positive.
      real(dp), intent(out) :: phi(m)
      !> Slopes dPhi/dA [-], negative.
      real(dp), intent(out) :: dphi_da(m)

      real(dp) :: v(film_block), lead(film_block), fall(film_block), share(film_block)
      integer :: i

      call locate_block(m, a, v, lead, fall, share)
      call sum_block(m, load_table, a, v, phi)
      call sum_block(m, load_slope_table, a, v, dphi_da)
      !$omp simd
      do i = 1, m
         phi(i) = lead(i)*(fall(i)*fall(i))*share(i)*phi(i)
         dphi_da(i) = (fall(i)*share(i))*(fall(i)*share(i))*(fall(i)*share(i))*dphi_da(i)
      end do

   end subroutine load_block

   !> Highest pressure group max p* [-], at tan x = -t_e - A, and its slope; alpha p_max = B max p*.
   elemental subroutine peak_pressure_group(a, peak, dpeak_da)
      !> Squeeze group A [-].
      real(dp), intent(in) :: a
      !> Highest pressure group [-], positive.
      real(dp), intent(out) :: peak
      !> Slope d(max p*)/dA [-], negative.
      real(dp), intent(out) :: dpeak_da

      real(dp) :: v, xi, root, lead, fall, share

      call locate(a, v, xi, root, lead, fall, share)
      call choose_half(a, lead, fall)
      peak = lead*(fall*fall*fall)*(share*share)*sum_table(peak_table, sign(1.0_dp, a), v)
      fall = fall*share*fall*share
      dpeak_da = fall*fall*sum_table(peak_slope_table, sign(1.0_dp, a), v)

   end subroutine peak_pressure_group

   !> Highest pressure group, of one block of films.
   pure subroutine peak_block(m, a, peak)
      !> Number of films, at most film_block.
      integer, intent(in) :: m
      !> Squeeze groups A [-].
      real(dp), intent(in) :: a(m)
      !> Highest pressure groups [-], positive.
      real(dp), intent(out) :: peak(m)

      real(dp) :: v(film_block), lead(film_block), fall(film_block), share(film_block)
      integer :: i

      call locate_block(m, a, v, lead, fall, share)
      call sum_block(m, peak_table, a, v, peak)
      !$omp simd
      do i = 1, m
         peak(i) = lead(i)*(fall(i)*fall(i)*fall(i))*(share(i)*share(i))*peak(i)
      end do

   end subroutine peak_block

   !> Highest pressure group and its slope, of one block of films.
   pure subroutine peak_pressure_block(m, a, peak, dpeak_da)
      !> Number of films, at most film_block.
      integer, intent(in) :: m
      !> Squeeze groups A [-].
      real(dp), intent(in) :: a(m)
      !> Highest pressure groups [-], positive.
      real(dp), intent(out) :: peak(m)
      !> Slopes d(max p*)/dA [-], negative.
      real(dp), intent(out) :: dpeak_da(m)

      real(dp) :: v(film_block), lead(film_block), fall(film_block), share(film_block)
      integer :: i

      call locate_block(m, a, v, lead, fall, share)
      call sum_block(m, peak_table, a, v, peak)
      call sum_block(m, peak_slope_table, a, v, dpeak_da)
      !$omp simd
      do i = 1, m
         peak(i) = lead(i)*(fall(i)*fall(i)*fall(i))*(share(i)*share(i))*peak(i)
         fall(i) = fall(i)*share(i)*fall(i)*share(i)
         dpeak_da(i) = fall(i)*fall(i)*dpeak_da(i)
      end do

   end subroutine peak_pressure_block

end module reynolds_iso_viscous
