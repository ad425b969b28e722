!> Taylor series of the motion with the Reynolds piezo-viscous film, for a block of lanes, on one flank or between two
!> (fsrc/THEORY.md, section 4).
!>
!> Psi has infinite slope where the film ceases to exist, but not in s = sqrt(1 - B max p*(A)): module reynolds_piezo_expansion
!> gives it in two variables. All sums share the powers of z, series of their own, each the product of two lower ones.
module taylor_reynolds_piezo
   use kinds, only: dp
   use lane_force, only: factor
   use lane_functions, only: half_block, lanes
   use reynolds_piezo_expansion, only: expand_reynolds_piezo, first_term, highest_peak_power, highest_group_power, &
      highest_sigma_power, reynolds_piezo_expansion_t
   use taylor_rupture, only: rupture_order
   use taylor_step_control, only: inverse, order
   implicit none(type, external)
   private

   !> Damping rate where there is no expansion: no series follows it [1/periods].
   real(dp), parameter :: no_expansion = 1.0e30_dp

   !> The series, in one array: their coefficients lie at fixed distances from each other, and one address leads to all.
   !> Names as above; group = B, peak = max p*, tail + j: F_j, z + i - 1: z**i.
   integer, parameter :: h = 1, v = 2, p = 3, r = 4, group = 5, s = 6, peak = 7, tail = 8, &
                         z = tail + highest_sigma_power + 1, series = z + highest_group_power(0) - 1

   public :: reynolds_piezo_series, reynolds_piezo_series_of_two

contains

   !> Coefficients 1 to `rupture_order` of H and V, and the damping rate.
   pure subroutine reynolds_piezo_series(strength, rate, pressing, load, force, film, lienard, &
                                         damping_rate, expansion)
      !> a [-]
      real(dp), intent(in) :: strength(lanes)
      !> c [periods]
      real(dp), intent(in) :: rate(lanes)
      !> b [-]
      real(dp), intent(in) :: pressing(lanes)
      !> q [-]
      real(dp), intent(in) :: load(lanes)
      !> Derivatives of the force that oscillates, by module lane_force [-]
      real(dp), intent(in) :: force(lanes, order)
      !> Series of H [-]; coefficient 0 is given
      real(dp), intent(inout) :: film(lanes, 0:order)
      !> Series of V [-]; coefficient 0 is given
      real(dp), intent(inout) :: lienard(lanes, 0:order)
      !> -dV'/dV [1/periods]; huge where there is no expansion
      real(dp), intent(out) :: damping_rate(lanes)
      !> Films looked up last, those at the point of expansion afterwards
      type(reynolds_piezo_expansion_t), intent(inout) :: expansion
      real(dp) :: c(half_block, series, 0:rupture_order)
      real(dp), dimension(half_block) :: half_root, unit_rate, sigma_slope
      !> What z, s and V' take from V, max p* and Psi of the same order
      real(dp), dimension(half_block) :: z_by_lienard, sigma_by_peak, force_by_load
      real(dp) :: of_p, of_r, of_z, of_group, of_power, of_peak, of_s, of_tail, of_force, oscillation
      integer :: before, low, high, k, i, j, m, l

      call expand_reynolds_piezo(film(:, 0), lienard(:, 0), rate, pressing, expansion)
      do before = 0, lanes - 1, half_block
         !$omp simd
         do l = 1, half_block
            c(l, h, 0) = film(before + l, 0)
            c(l, v, 0) = lienard(before + l, 0)
            c(l, p, 0) = expansion%inverse_film(before + l)
            c(l, r, 0) = expansion%root(before + l)
            c(l, group, 0) = expansion%pressure_group(before + l)
            c(l, peak, 0) = expansion%peak(before + l, 0)
            half_root(l) = 0.5_dp*c(l, h, 0)*c(l, r, 0)
            sigma_slope(l) = -0.5_dp/expansion%sigma(before + l)
            unit_rate(l) = rate(before + l)*expansion%inverse_unit(before + l)
            z_by_lienard(l) = unit_rate(l)*c(l, r, 0)
            sigma_by_peak(l) = sigma_slope(l)*c(l, group, 0)
            force_by_load(l) = strength(before + l)*c(l, p, 0)
            c(l, v, 1) = force_by_load(l)*expansion%terms(before + l, 0) - load(before + l) - force(before + l, 1)
            damping_rate(before + l) = merge( &
               -force_by_load(l)*rate(before + l)*c(l, r, 0)*expansion%load_slope(before + l), no_expansion, &
               expansion%inside(before + l) > 0.0_dp)
         end do
         do j = 0, highest_sigma_power
            c(:, tail + j, 0) = expansion%terms(before + 1:before + half_block, first_term(j))
         end do
         !GCC$ unroll 24
         do k = 1, rupture_order - 1
            ! First all that the series take from lower orders, p H = 1, r**2 = p, B = b p r, z e = c V r less its value at the
            ! start, s**2 = 1 - B max p*; then what their new coefficients add to each other: a chain of six operations, during
            ! which the sums of the next order are under way. One loop over lanes an order: where a register holds fewer than
            ! half a block, its rounds share the instructions, which would not fit into the cache of a processor otherwise.
            !$omp simd private(low, high, of_p, of_r, of_z, of_group, of_power, of_peak, of_s, of_tail, of_force, oscillation)
            do l = 1, half_block
               c(l, h, k) = inverse(k)*c(l, v, k - 1)
               of_p = 0.0_dp
               do j = 1, k - 1
                  of_p = of_p + c(l, p, k - j)*c(l, h, j)
               end do
               c(l, p, k) = -c(l, p, 0)*(of_p + c(l, p, 0)*c(l, h, k))
               of_r = 0.0_dp
               do j = 1, (k - 1)/2
                  of_r = of_r + c(l, r, j)*c(l, r, k - j)
               end do
               of_r = 2.0_dp*of_r
               if (mod(k, 2) == 0) of_r = of_r + c(l, r, shiftr(k, 1))*c(l, r, shiftr(k, 1))
               c(l, r, k) = half_root(l)*(c(l, p, k) - of_r)
               of_group = 0.0_dp
               of_z = 0.0_dp
               do j = 1, k - 1
                  of_group = of_group + c(l, r, k - j)*c(l, p, j)
                  of_z = of_z + c(l, r, k - j)*c(l, v, j)
               end do
               c(l, group, k) = pressing(before + l)*(of_group + c(l, r, 0)*c(l, p, k) + c(l, r, k)*c(l, p, 0))
               c(l, z, k) = unit_rate(l)*(of_z + c(l, r, k)*c(l, v, 0))
               !GCC$ unroll 24
               do i = min(highest_group_power(0), k), 2, -1
                  ! Squares, and products of neighbours
                  low = z - 1 + i/2
                  high = z - 1 + (i + 1)/2
                  of_power = 0.0_dp
                  do j = i/2, merge((k - 1)/2, k - (i + 1)/2, low == high)
                     of_power = of_power + c(l, low, j)*c(l, high, k - j)
                  end do
                  if (low == high) of_power = 2.0_dp*of_power
                  if (low == high .and. mod(k, 2) == 0) of_power = of_power + c(l, low, shiftr(k, 1))*c(l, low, shiftr(k, 1))
                  c(l, z + i - 1, k) = of_power
               end do
               of_peak = 0.0_dp
               do i = min(highest_peak_power, k), 2, -1
                  of_peak = of_peak + expansion%peak(before + l, i)*c(l, z + i - 1, k)
               end do
               of_s = 0.0_dp
               do j = (k - 1)/2, 1, -1
                  of_s = of_s + c(l, s, j)*c(l, s, k - j)
               end do
               of_s = 2.0_dp*of_s
               if (mod(k, 2) == 0) of_s = of_s + c(l, s, shiftr(k, 1))*c(l, s, shiftr(k, 1))
               do j = 0, k - 1
                  of_s = of_s + c(l, group, k - j)*c(l, peak, j)
               end do
               !GCC$ unroll 8
               do j = min(highest_sigma_power - 1, rupture_order - 1 - k), 0, -1
                  of_tail = 0.0_dp
                  do i = min(highest_group_power(j), k), 2, -1
                     of_tail = of_tail + expansion%terms(before + l, first_term(j) + i)*c(l, z + i - 1, k)
                  end do
                  do m = 2, merge(k - 1, 0, j + 1 < highest_sigma_power)
                     of_tail = of_tail + c(l, s, m)*c(l, tail + j + 1, k - m)
                  end do
                  if (k > 1 .and. j + 1 < highest_sigma_power) of_tail = of_tail + c(l, s, 1)*c(l, tail + j + 1, k - 1)
                  c(l, tail + j, k) = of_tail
               end do
               of_force = c(l, p, k)*c(l, tail, 0)
               do j = 1, k - 1
                  of_force = of_force + c(l, p, k - j)*c(l, tail, j)
               end do
               oscillation = factor(k + 1)*force(before + l, k + 1)
               ! The chain
               c(l, z, k) = c(l, z, k) + z_by_lienard(l)*c(l, v, k)
               c(l, peak, k) = of_peak + expansion%peak(before + l, 1)*c(l, z, k)
               c(l, s, k) = sigma_slope(l)*of_s + sigma_by_peak(l)*c(l, peak, k)
               !GCC$ unroll 8
               do j = 0, min(highest_sigma_power - 1, rupture_order - 1 - k)
                  c(l, tail + j, k) = (c(l, tail + j, k) + expansion%terms(before + l, first_term(j) + 1)*c(l, z, k)) &
                     + c(l, s, k)*c(l, tail + j + 1, 0)
               end do
               c(l, v, k + 1) = ((inverse(k + 1)*strength(before + l))*of_force - oscillation) &
                  + (inverse(k + 1)*force_by_load(l))*c(l, tail, k)
            end do
         end do
         c(:, h, rupture_order) = inverse(rupture_order)*c(:, v, rupture_order - 1)
         film(before + 1:before + half_block, 1:rupture_order) = c(:, h, 1:)
         lienard(before + 1:before + half_block, 1:rupture_order) = c(:, v, 1:)
      end do
   end subroutine reynolds_piezo_series

   !> The same between two flanks.
   pure subroutine reynolds_piezo_series_of_two(strength, rate, pressing, backlash, load, force, film, lienard, damping_rate, &
                                                expansion)
      !> a [-]
      real(dp), intent(in) :: strength(lanes)
      !> c [periods]
      real(dp), intent(in) :: rate(lanes)
      !> b [-]
      real(dp), intent(in) :: pressing(lanes)
      !> B [-]
      real(dp), intent(in) :: backlash(lanes)
      !> q [-]
      real(dp), intent(in) :: load(lanes)
      !> Derivatives of the force that oscillates, by module lane_force [-]
      real(dp), intent(in) :: force(lanes, order)
      !> Series of H [-]; coefficient 0 is given
      real(dp), intent(inout) :: film(lanes, 0:order)
      !> Series of V [-]; coefficient 0 is given
      real(dp), intent(inout) :: lienard(lanes, 0:order)
      !> -dV'/dV [1/periods]; huge where there is no expansion
      real(dp), intent(out) :: damping_rate(lanes)
      !> Films of the drive and the coast flank looked up last, those at the point of expansion afterwards
      type(reynolds_piezo_expansion_t), intent(inout) :: expansion(2)
      !> Lane, series, flank, coefficient
      real(dp) :: c(half_block, series, 2, 0:rupture_order)
      real(dp), dimension(half_block, 2) :: half_root, unit_rate, sigma_slope, carried
      !> What z, s and V' take from V, max p* and Psi of the same order
      real(dp), dimension(half_block, 2) :: z_by_lienard, sigma_by_peak
      real(dp) :: of_p, of_r, of_z, of_group, of_power, of_peak, of_s, of_tail, of_force
      integer :: before, flank, low, high, k, i, j, m, l

      call expand_reynolds_piezo(film(:, 0), lienard(:, 0), rate, pressing, expansion(1))
      call expand_reynolds_piezo(backlash - film(:, 0), -lienard(:, 0), rate, pressing, expansion(2))
      damping_rate = merge(-strength*rate*(expansion(1)%inverse_film*expansion(1)%root*expansion(1)%load_slope &
                                           + expansion(2)%inverse_film*expansion(2)%root*expansion(2)%load_slope), &
                           no_expansion, expansion(1)%inside*expansion(2)%inside > 0.0_dp)
      do before = 0, lanes - 1, half_block
         do flank = 1, 2
            !$omp simd
            do l = 1, half_block
               c(l, h, flank, 0) = expansion(flank)%film(before + l)
               c(l, v, flank, 0) = expansion(flank)%lienard(before + l)
               c(l, p, flank, 0) = expansion(flank)%inverse_film(before + l)
               c(l, r, flank, 0) = expansion(flank)%root(before + l)
               c(l, group, flank, 0) = expansion(flank)%pressure_group(before + l)
               c(l, peak, flank, 0) = expansion(flank)%peak(before + l, 0)
               half_root(l, flank) = 0.5_dp*c(l, h, flank, 0)*c(l, r, flank, 0)
               sigma_slope(l, flank) = -0.5_dp/expansion(flank)%sigma(before + l)
               unit_rate(l, flank) = rate(before + l)*expansion(flank)%inverse_unit(before + l)
               z_by_lienard(l, flank) = unit_rate(l, flank)*c(l, r, flank, 0)
               sigma_by_peak(l, flank) = sigma_slope(l, flank)*c(l, group, flank, 0)
               carried(l, flank) = c(l, p, flank, 0)*expansion(flank)%terms(before + l, 0)
            end do
            do j = 0, highest_sigma_power
               c(:, tail + j, flank, 0) = expansion(flank)%terms(before + 1:before + half_block, first_term(j))
            end do
         end do
         !$omp simd
         do l = 1, half_block
            c(l, v, 1, 1) = strength(before + l)*(carried(l, 1) - carried(l, 2)) - load(before + l) - force(before + l, 1)
            c(l, v, 2, 1) = -c(l, v, 1, 1)
         end do
         !GCC$ unroll 24
         do k = 1, rupture_order - 1
            do flank = 1, 2
               !$omp simd private(low, high, of_p, of_r, of_z, of_group, of_power, of_peak, of_s, of_tail, of_force)
               do l = 1, half_block
                  c(l, h, flank, k) = inverse(k)*c(l, v, flank, k - 1)
                  of_p = 0.0_dp
                  do j = 1, k - 1
                     of_p = of_p + c(l, p, flank, k - j)*c(l, h, flank, j)
                  end do
                  c(l, p, flank, k) = -c(l, p, flank, 0)*(of_p + c(l, p, flank, 0)*c(l, h, flank, k))
                  of_r = 0.0_dp
                  do j = 1, (k - 1)/2
                     of_r = of_r + c(l, r, flank, j)*c(l, r, flank, k - j)
                  end do
                  of_r = 2.0_dp*of_r
                  if (mod(k, 2) == 0) of_r = of_r + c(l, r, flank, shiftr(k, 1))*c(l, r, flank, shiftr(k, 1))
                  c(l, r, flank, k) = half_root(l, flank)*(c(l, p, flank, k) - of_r)
                  of_group = 0.0_dp
                  of_z = 0.0_dp
                  do j = 1, k - 1
                     of_group = of_group + c(l, r, flank, k - j)*c(l, p, flank, j)
                     of_z = of_z + c(l, r, flank, k - j)*c(l, v, flank, j)
                  end do
                  c(l, group, flank, k) = pressing(before + l) &
                     *(of_group + c(l, r, flank, 0)*c(l, p, flank, k) + c(l, r, flank, k)*c(l, p, flank, 0))
                  c(l, z, flank, k) = unit_rate(l, flank)*(of_z + c(l, r, flank, k)*c(l, v, flank, 0))
                  !GCC$ unroll 24
                  do i = min(highest_group_power(0), k), 2, -1
                     ! Squares, and products of neighbours
                     low = z - 1 + i/2
                     high = z - 1 + (i + 1)/2
                     of_power = 0.0_dp
                     do j = i/2, merge((k - 1)/2, k - (i + 1)/2, low == high)
                        of_power = of_power + c(l, low, flank, j)*c(l, high, flank, k - j)
                     end do
                     if (low == high) of_power = 2.0_dp*of_power
                     if (low == high .and. mod(k, 2) == 0) &
                        of_power = of_power + c(l, low, flank, shiftr(k, 1))*c(l, low, flank, shiftr(k, 1))
                     c(l, z + i - 1, flank, k) = of_power
                  end do
                  of_peak = 0.0_dp
                  do i = min(highest_peak_power, k), 2, -1
                     of_peak = of_peak + expansion(flank)%peak(before + l, i)*c(l, z + i - 1, flank, k)
                  end do
                  of_s = 0.0_dp
                  do j = (k - 1)/2, 1, -1
                     of_s = of_s + c(l, s, flank, j)*c(l, s, flank, k - j)
                  end do
                  of_s = 2.0_dp*of_s
                  if (mod(k, 2) == 0) of_s = of_s + c(l, s, flank, shiftr(k, 1))*c(l, s, flank, shiftr(k, 1))
                  do j = 0, k - 1
                     of_s = of_s + c(l, group, flank, k - j)*c(l, peak, flank, j)
                  end do
                  !GCC$ unroll 8
                  do j = min(highest_sigma_power - 1, rupture_order - 1 - k), 0, -1
                     of_tail = 0.0_dp
                     do i = min(highest_group_power(j), k), 2, -1
                        of_tail = of_tail + expansion(flank)%terms(before + l, first_term(j) + i)*c(l, z + i - 1, flank, k)
                     end do
                     do m = 2, merge(k - 1, 0, j + 1 < highest_sigma_power)
                        of_tail = of_tail + c(l, s, flank, m)*c(l, tail + j + 1, flank, k - m)
                     end do
                     if (k > 1 .and. j + 1 < highest_sigma_power) &
                        of_tail = of_tail + c(l, s, flank, 1)*c(l, tail + j + 1, flank, k - 1)
                     c(l, tail + j, flank, k) = of_tail
                  end do
                  of_force = c(l, p, flank, k)*c(l, tail, flank, 0)
                  do j = 1, k - 1
                     of_force = of_force + c(l, p, flank, k - j)*c(l, tail, flank, j)
                  end do
                  ! The chain
                  c(l, z, flank, k) = c(l, z, flank, k) + z_by_lienard(l, flank)*c(l, v, flank, k)
                  c(l, peak, flank, k) = of_peak + expansion(flank)%peak(before + l, 1)*c(l, z, flank, k)
                  c(l, s, flank, k) = sigma_slope(l, flank)*of_s + sigma_by_peak(l, flank)*c(l, peak, flank, k)
                  !GCC$ unroll 8
                  do j = 0, min(highest_sigma_power - 1, rupture_order - 1 - k)
                     c(l, tail + j, flank, k) = (c(l, tail + j, flank, k) &
                                                 + expansion(flank)%terms(before + l, first_term(j) + 1)*c(l, z, flank, k)) &
                        + c(l, s, flank, k)*c(l, tail + j + 1, flank, 0)
                  end do
                  carried(l, flank) = of_force + c(l, p, flank, 0)*c(l, tail, flank, k)
               end do
            end do
            !$omp simd
            do l = 1, half_block
               c(l, v, 1, k + 1) = (inverse(k + 1)*strength(before + l))*(carried(l, 1) - carried(l, 2)) &
                  - factor(k + 1)*force(before + l, k + 1)
               c(l, v, 2, k + 1) = -c(l, v, 1, k + 1)
            end do
         end do
         c(:, h, 1, rupture_order) = inverse(rupture_order)*c(:, v, 1, rupture_order - 1)
         film(before + 1:before + half_block, 1:rupture_order) = c(:, h, 1, 1:)
         lienard(before + 1:before + half_block, 1:rupture_order) = c(:, v, 1, 1:)
      end do
   end subroutine reynolds_piezo_series_of_two

end module taylor_reynolds_piezo
