!> Exact iso-viscous film: Reynolds equation of a rigid cylinder over a plane with Swift-Stieber rupture.
!>
!> Everything depends on A = 4 w*/sqrt(2 h*), w* = w/u, h* = h0/R, with w the squeeze velocity [m/s] and
!> u = u1 + u2 the sum of the surface speeds [m/s]. In the film angle x, t = tan x, the pressure group is
!>
!>    p*(x) = J(x) - t_e**2 K(x) - A (cos(x)**4/4 + t_e K(x)),   p = 6 sqrt(2 R) u eta0 h0**(-3/2) p*
!>    J = integral of sin**2 cos**2,   K = integral of cos**4,   both from -pi/2
!>
!> Rupture angle x_e: p*(x_e) = 0, eq (18) with its signs corrected. Load: W = 12 l u eta0 R/h0 Phi(A),
!> Phi = cos(x_e)**2/4 - (A/8)(x_e + pi/2 + sin x_e cos x_e), eq (20) and (21) corrected. The closed forms cancel
!> near x_e = -pi/2 (large A), so the kernels use tables in xi = A/(c + sqrt(A**2 + c**2)), -1 < xi < 1,
!> with the asymptotes divided out: Phi -> -pi A/8 and 16/(81 A**2), t_e -> -A and -3 A/8.
!>
!> Every finite A is valid; relative errors are a few epsilon (t_e: relative to max(1, |t_e|)). What falls off on
!> separation underflows to zero at last (Phi beyond A = 1e153). NaN or infinite A: the answer is NaN.
!> A film gets the same bits from the scalar and the array procedures, wherever it stands in the array.
module reynolds_iso_viscous
   use kinds, only: dp
   use iso_viscous_coefficients, only: coordinate_scale, iso_degree, tangent_table, tangent_slope_table, &
      & load_table, load_slope_table, peak_table, peak_slope_table
   implicit none (type, external)
   private

   public :: rupture_tangent_fast, rupture_tangent_slope, rupture_angle
   public :: iso_viscous_load, iso_viscous_load_array
   public :: peak_pressure_group, peak_pressure_block
   public :: film_coordinate, film_coordinate_block

   !> Films per block: long enough to hide latency, short enough for the first-level cache.
   integer, parameter, public :: film_block = 64

   real(dp), parameter :: half_scale = 0.5_dp*coordinate_scale

   !> Beyond this |A| the root of A**2 + c**2 rounds to |A|.
   real(dp), parameter :: far_group = 1.0e9_dp

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
      if (a < 0.0_dp) then
         fall = 1.0_dp
      else
         lead = half_scale
      end if
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
      if (a < 0.0_dp) then
         fall = 1.0_dp
      else
         lead = half_scale
      end if
      peak = lead*(fall*fall*fall)*(share*share)*sum_table(peak_table, sign(1.0_dp, a), v)
      dpeak_da = (fall*share*fall*share)*(fall*share*fall*share)*sum_table(peak_slope_table, sign(1.0_dp, a), v)

   end subroutine peak_pressure_group

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
         dpeak_da(i) = (fall(i)*share(i)*fall(i)*share(i))*(fall(i)*share(i)*fall(i)*share(i))*dpeak_da(i)
      end do

   end subroutine peak_pressure_block

   !> Coordinate of the film tables and its slope.
   elemental subroutine film_coordinate(a, v, dv_da)
      !> Squeeze group A [-].
      real(dp), intent(in) :: a
      !> Coordinate v = 2|xi| - 1 [-].
      real(dp), intent(out) :: v
      !> Slope dv/dA [-].
      real(dp), intent(out) :: dv_da

      real(dp) :: xi, root, reach, decay, share, gap

      call locate(a, v, xi, root, reach, decay, share)
      ! dxi/dA = (1 - xi**2)**2/(2 c (1 + xi**2)); 1 - xi**2 = 4 decay share**2 keeps its digits near 1.
      gap = 4.0_dp*decay*(share*share)
      dv_da = sign(gap*gap/(coordinate_scale*(1.0_dp + xi*xi)), a)

   end subroutine film_coordinate

   !> Coordinate of the film tables and its slope, of one block of films.
   pure subroutine film_coordinate_block(m, a, v, dv_da)
      !> Number of films.
      integer, intent(in) :: m
      !> Squeeze groups A [-].
      real(dp), intent(in) :: a(m)
      !> Coordinates v = 2|xi| - 1 [-].
      real(dp), intent(out) :: v(m)
      !> Slopes dv/dA [-].
      real(dp), intent(out) :: dv_da(m)

      integer :: i

      !$omp simd
      do i = 1, m
         call film_coordinate(a(i), v(i), dv_da(i))
      end do

   end subroutine film_coordinate_block

   !> Map A to the table coordinate and to the factors of the asymptotes; no overflow for any finite A.
   elemental subroutine locate(a, v, xi, root, reach, decay, share)
      !> Squeeze group A [-].
      real(dp), intent(in) :: a
      !> Table coordinate 2|xi| - 1 [-].
      real(dp), intent(out) :: v
      !> |xi| [-].
      real(dp), intent(out) :: xi
      !> sqrt(A**2 + c**2) [-].
      real(dp), intent(out) :: root
      !> (sqrt(A**2 + c**2) + |A|)/2 [-].
      real(dp), intent(out) :: reach
      !> (1 - |xi|)/(1 + |xi|) = (c/2)/reach [-].
      real(dp), intent(out) :: decay
      !> 1/(1 + decay) = (1 + |xi|)/2 [-].
      real(dp), intent(out) :: share

      real(dp) :: size, near

      size = abs(a)
      near = min(size, far_group)
      root = sqrt(near*near + coordinate_scale*coordinate_scale) + (size - near)
      xi = size/(coordinate_scale + root)
      v = 2.0_dp*xi - 1.0_dp
      reach = 0.5_dp*root + 0.5_dp*size
      decay = half_scale/reach
      share = 0.5_dp + 0.5_dp*xi

   end subroutine locate

   !> Sum a table for one film, step by step as sum_block does.
   pure function sum_table(table, side, v) result(total)
      !> Coefficients of ascending powers of v: mean of both signs of A, half difference.
      real(dp), intent(in) :: table(0:iso_degree, 2)
      !> Sign of A.
      real(dp), intent(in) :: side
      !> Table coordinate [-].
      real(dp), intent(in) :: v
      real(dp) :: total

      real(dp) :: z, even, odd
      integer :: k

      z = v*v
      even = 0.0_dp
      odd = 0.0_dp
      do k = iso_degree - 1, 0, -2
         even = even*z + (table(k, 1) + side*table(k, 2))
         odd = odd*z + (table(k + 1, 1) + side*table(k + 1, 2))
      end do
      total = even + v*odd

   end function sum_table

   !> Coordinates and asymptotic factors of one block of films.
   pure subroutine locate_block(m, a, v, lead, fall, share)
      !> Number of films, at most film_block.
      integer, intent(in) :: m
      !> Squeeze groups A [-].
      real(dp), intent(in) :: a(m)
      !> Table coordinates 2|xi| - 1 [-].
      real(dp), intent(out) :: v(m)
      !> (sqrt(A**2 + c**2) + |A|)/2 for A < 0, else c/2 [-].
      real(dp), intent(out) :: lead(m)
      !> One for A < 0, else (1 - |xi|)/(1 + |xi|) [-].
      real(dp), intent(out) :: fall(m)
      !> (1 + |xi|)/2 [-].
      real(dp), intent(out) :: share(m)

      real(dp) :: xi(film_block), root(film_block)
      integer :: i

      !$omp simd
      do i = 1, m
         call locate(a(i), v(i), xi(i), root(i), lead(i), fall(i), share(i))
      end do
      ! The choice of the half stands in a loop of its own: in one with divisions gfortran would branch.
      !$omp simd
      do i = 1, m
         lead(i) = merge(lead(i), half_scale, a(i) < 0.0_dp)
         fall(i) = merge(1.0_dp, fall(i), a(i) < 0.0_dp)
      end do

   end subroutine locate_block

   !> Sum a table for one block of films. Even and odd powers go apart, two short chains instead of a long one,
   !> five rows of each at a time, which keeps their coefficients in registers while the films pass.
   pure subroutine sum_block(m, table, a, v, total)
      !> Number of films, at most film_block.
      integer, intent(in) :: m
      !> Coefficients of ascending powers of v: mean of both signs of A, half difference.
      real(dp), intent(in) :: table(0:iso_degree, 2)
      !> Squeeze groups A [-].
      real(dp), intent(in) :: a(m)
      !> Table coordinates [-].
      real(dp), intent(in) :: v(m)
      !> Sums.
      real(dp), intent(out) :: total(m)

      real(dp) :: even(film_block), odd(film_block), z, e, o, side
      integer :: i, k

      even(:m) = 0.0_dp
      odd(:m) = 0.0_dp
      do k = iso_degree - 9, 0, -10
         !$omp simd private(side, z, e, o)
         do i = 1, m
            side = sign(1.0_dp, a(i))
            z = v(i)*v(i)
            e = even(i)*z + (table(k + 8, 1) + side*table(k + 8, 2))
            o = odd(i)*z + (table(k + 9, 1) + side*table(k + 9, 2))
            e = e*z + (table(k + 6, 1) + side*table(k + 6, 2))
            o = o*z + (table(k + 7, 1) + side*table(k + 7, 2))
            e = e*z + (table(k + 4, 1) + side*table(k + 4, 2))
            o = o*z + (table(k + 5, 1) + side*table(k + 5, 2))
            e = e*z + (table(k + 2, 1) + side*table(k + 2, 2))
            o = o*z + (table(k + 3, 1) + side*table(k + 3, 2))
            even(i) = e*z + (table(k, 1) + side*table(k, 2))
            odd(i) = o*z + (table(k + 1, 1) + side*table(k + 1, 2))
         end do
      end do
      !$omp simd
      do i = 1, m
         total(i) = even(i) + v(i)*odd(i)
      end do

   end subroutine sum_block

end module reynolds_iso_viscous
