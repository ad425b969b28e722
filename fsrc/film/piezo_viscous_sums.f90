!> Sum of the table of module piezo_viscous_coefficients, and the coordinate of sigma it is made in.
!>
!> Both sums, for one film and for a block, take the same steps, each of which the compiler can fuse in one
!> way only: equal bits.
module piezo_viscous_sums
   use kinds, only: dp
   use iso_viscous_sums, only: film_block
   use piezo_viscous_coefficients, only: sigma_degree, group_degree, row_degree, mean_table, difference_table
   implicit none(type, external)
   private

   public :: sum_block, sum_film, table_coordinate

   !> The map of sigma to the table coordinate w; see the table module.
   real(dp), parameter :: zero = sqrt(2.0_dp) - 1.0_dp
   real(dp), parameter :: pole = sqrt(2.0_dp) + 1.0_dp
   real(dp), parameter :: edge = 3.0_dp + 2.0_dp*sqrt(2.0_dp)

contains

   !> Map sigma to the table coordinate.
   elemental subroutine table_coordinate(sigma, w, dw)
      !> sqrt(1 - B/B_crit) [-].
      real(dp), intent(in) :: sigma
      !> Table coordinate, from -1 at B_crit to 1 at B = 0 [-].
      real(dp), intent(out) :: w
      !> Slope dw/d(sigma) [-].
      real(dp), intent(out) :: dw

      real(dp) :: inverse

      inverse = 1.0_dp/(sigma + pole)
      w = edge*(sigma - zero)*inverse
      dw = edge*(zero + pole)*(inverse*inverse)

   end subroutine table_coordinate

   !> Sum the table S(v, w) and its slopes for one film: first powers of v, for all powers of w at once.
   pure subroutine sum_film(side, v, w, s, ds_dv, ds_dw)
      !> Sign of A.
      real(dp), intent(in) :: side
      !> Coordinate of A [-].
      real(dp), intent(in) :: v
      !> Coordinate of sigma [-].
      real(dp), intent(in) :: w
      !> Sum S [-].
      real(dp), intent(out) :: s
      !> Slope dS/dv [-].
      real(dp), intent(out) :: ds_dv
      !> Slope dS/dw [-].
      real(dp), intent(out) :: ds_dw

      real(dp) :: p(0:sigma_degree), dp_dv(0:sigma_degree), total, slope
      integer :: j, k

      !$omp simd private(total, slope)
      do j = 0, sigma_degree
         total = 0.0_dp
         slope = 0.0_dp
         do k = group_degree, 0, -1
            slope = slope*v + total
            total = total*v + (mean_table(j, k) + side*difference_table(j, k))
         end do
         p(j) = total
         dp_dv(j) = slope
      end do
      s = 0.0_dp
      ds_dv = 0.0_dp
      ds_dw = 0.0_dp
      do j = sigma_degree, 0, -1
         ds_dw = ds_dw*w + s
         s = s*w + p(j)
         ds_dv = ds_dv*w + dp_dv(j)
      end do

   end subroutine sum_film

   !> Sum the table S(v, w) and its slopes for one block of films.
   pure subroutine sum_block(m, a, v, w, s, ds_dv, ds_dw)
      !> Number of films, at most film_block.
      integer, intent(in) :: m
      !> Squeeze groups A [-].
      real(dp), intent(in) :: a(m)
      !> Coordinates of A [-].
      real(dp), intent(in) :: v(m)
      !> Coordinates of sigma [-].
      real(dp), intent(in) :: w(m)
      !> Sums S [-].
      real(dp), intent(out) :: s(m)
      !> Slopes dS/dv [-].
      real(dp), intent(out) :: ds_dv(m)
      !> Slopes dS/dw [-].
      real(dp), intent(out) :: ds_dw(m)

      real(dp) :: p(film_block), dp_dv(film_block)
      integer :: i, j

      s = 0.0_dp
      ds_dv = 0.0_dp
      ds_dw = 0.0_dp
      do j = sigma_degree, 0, -1
         call sum_row(m, j, a, v, p, dp_dv)
         !$omp simd
         do i = 1, m
            ds_dw(i) = ds_dw(i)*w(i) + s(i)
            s(i) = s(i)*w(i) + p(i)
            ds_dv(i) = ds_dv(i)*w(i) + dp_dv(i)
         end do
      end do

   end subroutine sum_block

   !> Sum the powers of v that go with one power of w, eight at a time: their coefficients stay in registers.
   pure subroutine sum_row(m, j, a, v, p, dp_dv)
      !> Number of films, at most film_block.
      integer, intent(in) :: m
      !> Power of w.
      integer, intent(in) :: j
      !> Squeeze groups A [-].
      real(dp), intent(in) :: a(m)
      !> Coordinates of A [-].
      real(dp), intent(in) :: v(m)
      !> Sums [-].
      real(dp), intent(out) :: p(m)
      !> Slopes in v [-].
      real(dp), intent(out) :: dp_dv(m)

      real(dp) :: side, s, ds
      integer :: i, k

      p = 0.0_dp
      dp_dv = 0.0_dp
      do k = row_degree(j) - 7, 0, -8
         !$omp simd private(side, s, ds)
         do i = 1, m
            side = sign(1.0_dp, a(i))
            ds = dp_dv(i)*v(i) + p(i)
            s = p(i)*v(i) + (mean_table(j, k + 7) + side*difference_table(j, k + 7))
            ds = ds*v(i) + s
            s = s*v(i) + (mean_table(j, k + 6) + side*difference_table(j, k + 6))
            ds = ds*v(i) + s
            s = s*v(i) + (mean_table(j, k + 5) + side*difference_table(j, k + 5))
            ds = ds*v(i) + s
            s = s*v(i) + (mean_table(j, k + 4) + side*difference_table(j, k + 4))
            ds = ds*v(i) + s
            s = s*v(i) + (mean_table(j, k + 3) + side*difference_table(j, k + 3))
            ds = ds*v(i) + s
            s = s*v(i) + (mean_table(j, k + 2) + side*difference_table(j, k + 2))
            ds = ds*v(i) + s
            s = s*v(i) + (mean_table(j, k + 1) + side*difference_table(j, k + 1))
            dp_dv(i) = ds*v(i) + s
            p(i) = s*v(i) + (mean_table(j, k) + side*difference_table(j, k))
         end do
      end do

   end subroutine sum_row

end module piezo_viscous_sums
