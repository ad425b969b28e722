!> Sums of the tables of module iso_viscous_coefficients, and the coordinate they are made in.
!>
!> The coordinate is xi = A/(c + sqrt(A**2 + c**2)), -1 < xi < 1. All film quantities are analytic in it, ends
!> included. The coefficients are mean + sign(A) difference of those for A < 0 and A > 0. Both sums, for one
!> film and for a block, take the same steps, each of which the compiler can fuse in one way only: equal bits.
module iso_viscous_sums
   use kinds, only: dp
   use iso_viscous_coefficients, only: coordinate_scale, iso_degree
   implicit none(type, external)
   private

   public :: film_coordinate, film_coordinate_block
   public :: locate, locate_block, choose_half
   public :: sum_table, sum_block

   !> Films per block: long enough to hide latency, short enough for the first-level cache.
   integer, parameter, public :: film_block = 64

   real(dp), parameter :: half_scale = 0.5_dp*coordinate_scale

   !> Beyond this |A| the root of A**2 + c**2 rounds to |A|.
   real(dp), parameter :: far_group = 1.0e9_dp

contains

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

   !> Asymptotic factors of the half of A: Phi goes with lead fall**2 share, max p* with
   !> lead fall**3 share**2.
   elemental subroutine choose_half(a, lead, fall)
      !> Squeeze group A [-].
      real(dp), intent(in) :: a
      !> From reach to reach for A < 0, else c/2 [-].
      real(dp), intent(inout) :: lead
      !> From decay to one for A < 0, else decay [-].
      real(dp), intent(inout) :: fall

      lead = merge(lead, half_scale, a < 0.0_dp)
      fall = merge(1.0_dp, fall, a < 0.0_dp)

   end subroutine choose_half

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
         call choose_half(a(i), lead(i), fall(i))
      end do

   end subroutine locate_block

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

   !> Sum a table for one block of films. Even and odd powers go apart, two short chains instead of a long
   !> one, five rows of each at a time, which keeps their coefficients in registers while the films pass.
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

end module iso_viscous_sums
