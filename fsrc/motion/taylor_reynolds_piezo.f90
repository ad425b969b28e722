!> Taylor series of the motion with the exact piezo-viscous film, for a block of lanes.
!>
!> With x = f_exc t and H = h/h_s, eq (1) reads
!>
!>     H' = V ,   V' = a p Psi(A, B) - q - f cos(2 pi x) ,   p = 1/H ,   r = H^(-1/2) ,   A = c V r ,   B = b p r .
!>
!> Psi has infinite slope where the film ceases to exist, but not in s = sqrt(1 - B max p*(A)). Module
!> reynolds_piezo_expansion gives max p* in powers of z, the deviation of A over the unit e, and Psi in powers of z and y, the
!> deviation of s. They are nested, powers of z in pairs,
!>
!>     max p* = P_0 ,   P_i = pi_2i + pi_(2i+1) z + z**2 P_(i+1) ,
!>     Psi = F_0 ,   F_j = G_0j + y F_(j+1) ,   G_ij = psi_(2i)j + psi_(2i+1)j z + z**2 G_(i+1)j ,
!>
!> and as z and y begin with the first power of x, what has to be multiplied with some powers of them is needed up to an order
!> that is lower by their number.
module taylor_reynolds_piezo
   use kinds, only: dp
   use lane_functions, only: half_block, lanes
   use reynolds_piezo_expansion, only: expand_reynolds_piezo, first_term, highest_peak_power, highest_power, &
      highest_sigma_power, load_terms, reynolds_piezo_expansion_t
   use series_factors, only: inverse, wave
   use taylor_rupture, only: rupture_order
   use taylor_step_control, only: order
   implicit none(type, external)
   private

   !> Damping rate where there is no expansion: no series follows it [1/periods].
   real(dp), parameter :: no_expansion = 1.0e30_dp

   !> The series, in one array: their coefficients lie at fixed distances from each other, and one address leads to all.
   !> Names as above; group = B, peak + i: P_i, power + j: F_j, pair + i + pairs*j: G_ij for i > 0.
   integer, parameter :: last_peak_pair = (highest_peak_power - 1)/2, pairs = highest_power(0)/2
   integer, parameter :: h = 1, v = 2, p = 3, r = 4, z = 5, square = 6, group = 7, s = 8, peak = 9, &
                         power = peak + last_peak_pair + 1, pair = power + highest_sigma_power + 1, &
                         series = pair + pairs*highest_sigma_power - 1

   public :: reynolds_piezo_series

contains

   !> Coefficients 1 to `rupture_order` of H and V, and the damping rate.
   pure subroutine reynolds_piezo_series(strength, rate, pressing, load, force_cosine, force_sine, film, momentum, &
                                         damping_rate, expansion)
      !> a [-]
      real(dp), intent(in) :: strength(lanes)
      !> c [periods]
      real(dp), intent(in) :: rate(lanes)
      !> b [-]
      real(dp), intent(in) :: pressing(lanes)
      !> q [-]
      real(dp), intent(in) :: load(lanes)
      !> f cos(2 pi x) and f sin(2 pi x) at the point of expansion [-]
      real(dp), intent(in) :: force_cosine(lanes)
      real(dp), intent(in) :: force_sine(lanes)
      !> Series of H [-]; coefficient 0 is given
      real(dp), intent(inout) :: film(lanes, 0:order)
      !> Series of V [-]; coefficient 0 is given
      real(dp), intent(inout) :: momentum(lanes, 0:order)
      !> -dV'/dV [1/periods]; huge where there is no expansion
      real(dp), intent(out) :: damping_rate(lanes)
      !> Films looked up last, those at the point of expansion afterwards
      type(reynolds_piezo_expansion_t), intent(inout) :: expansion
      real(dp) :: c(half_block, series, 0:rupture_order)
      real(dp) :: peak_terms(half_block, 0:highest_peak_power), terms(half_block, 0:load_terms - 1)
      real(dp), dimension(half_block) :: half_root, unit_rate, half_sigma, half_strength, half_pressing, nest
      real(dp) :: of_p, of_r, of_z, of_square, of_group, of_s, of_nest, of_force, force
      integer :: before, k, i, j, m, l

      call expand_reynolds_piezo(film(:, 0), momentum(:, 0), rate, pressing, expansion)
      do before = 0, lanes - 1, half_block
         ! Copies, next to the coefficients: how fast memory elsewhere is depends on where it lies.
         peak_terms = expansion%peak(before + 1:before + half_block, :)
         terms = expansion%terms(before + 1:before + half_block, :)
         half_strength = strength(before + 1:before + half_block)
         half_pressing = pressing(before + 1:before + half_block)
         !$omp simd
         do l = 1, half_block
            c(l, h, 0) = film(before + l, 0)
            c(l, v, 0) = momentum(before + l, 0)
            c(l, p, 0) = expansion%inverse_film(before + l)
            c(l, r, 0) = expansion%root(before + l)
            c(l, group, 0) = expansion%pressure_group(before + l)
            half_root(l) = 0.5_dp*c(l, h, 0)*c(l, r, 0)
            half_sigma(l) = 0.5_dp/expansion%sigma(before + l)
            unit_rate(l) = rate(before + l)*expansion%inverse_unit(before + l)
            c(l, h, 1) = c(l, v, 0)
            c(l, v, 1) = half_strength(l)*c(l, p, 0)*terms(l, 0) &
               - load(before + l) - force_cosine(before + l)
            damping_rate(before + l) = merge( &
               -half_strength(l)*c(l, p, 0)*rate(before + l)*c(l, r, 0)*expansion%load_slope(before + l), no_expansion, &
               expansion%inside(before + l) > 0.0_dp)
         end do
         do i = 0, last_peak_pair
            c(:, peak + i, 0) = peak_terms(:, 2*i)
         end do
         do j = 0, highest_sigma_power
            c(:, power + j, 0) = terms(:, first_term(j))
            do i = 1, highest_power(j)/2
               c(:, pair + i - 1 + pairs*j, 0) = terms(:, first_term(j) + 2*i)
            end do
         end do
         !GCC$ unroll 24
         do k = 1, rupture_order - 1
            !$omp simd private(of_p, of_r, of_z, of_square, of_group)
            do l = 1, half_block
               of_p = 0.0_dp
               of_z = 0.0_dp
               do j = 2, k - 1
                  of_p = of_p + c(l, p, k - j)*c(l, h, j)
                  of_z = of_z + c(l, r, k - j)*c(l, v, j)
               end do
               of_group = 0.0_dp
               do j = 1, k - 1
                  of_group = of_group + c(l, r, k - j)*c(l, p, j)
               end do
               of_r = 0.0_dp
               of_square = 0.0_dp
               do j = 1, (k - 1)/2
                  of_r = of_r + c(l, r, j)*c(l, r, k - j)
                  of_square = of_square + c(l, z, j)*c(l, z, k - j)
               end do
               of_r = 2.0_dp*of_r
               of_square = 2.0_dp*of_square
               if (mod(k, 2) == 0) then
                  of_r = of_r + c(l, r, shiftr(k, 1))*c(l, r, shiftr(k, 1))
                  of_square = of_square + c(l, z, shiftr(k, 1))*c(l, z, shiftr(k, 1))
               end if
               if (k > 1) then
                  of_p = of_p + c(l, p, k - 1)*c(l, h, 1)
                  of_z = of_z + c(l, r, k - 1)*c(l, v, 1)
               end if
               ! p H = 1, r**2 = p, z e = c V r less its value at the start, B = b p r
               c(l, p, k) = -c(l, p, 0)*(of_p + c(l, p, 0)*c(l, h, k))
               c(l, r, k) = half_root(l)*(c(l, p, k) - of_r)
               c(l, z, k) = unit_rate(l)*(of_z + c(l, r, 0)*c(l, v, k) + c(l, r, k)*c(l, v, 0))
               c(l, square, k) = of_square
               c(l, group, k) = half_pressing(l)*(of_group + c(l, r, 0)*c(l, p, k) + c(l, r, k)*c(l, p, 0))
            end do
            !GCC$ unroll 8
            do i = min(last_peak_pair, (rupture_order - 1 - k)/2), 0, -1
               !$omp simd private(of_nest)
               do l = 1, half_block
                  of_nest = peak_terms(l, 2*i + 1)*c(l, z, k)
                  do j = 2, merge(k, 0, i < last_peak_pair)
                     of_nest = of_nest + c(l, square, j)*c(l, peak + i + 1, k - j)
                  end do
                  c(l, peak + i, k) = of_nest
               end do
            end do
            ! s**2 = 1 - B max p*
            !$omp simd private(of_s, of_group)
            do l = 1, half_block
               of_s = 0.0_dp
               do j = 1, (k - 1)/2
                  of_s = of_s + c(l, s, j)*c(l, s, k - j)
               end do
               of_s = 2.0_dp*of_s
               if (mod(k, 2) == 0) of_s = of_s + c(l, s, shiftr(k, 1))*c(l, s, shiftr(k, 1))
               of_group = 0.0_dp
               do j = 0, k
                  of_group = of_group + c(l, group, k - j)*c(l, peak, j)
               end do
               c(l, s, k) = -half_sigma(l)*(of_group + of_s)
            end do
            !GCC$ unroll 8
            do j = min(highest_sigma_power - 1, rupture_order - 1 - k), 0, -1
               !GCC$ unroll 8
               do i = min((highest_power(j) - 1)/2, (rupture_order - 1 - j - k)/2), 0, -1
                  !$omp simd
                  do l = 1, half_block
                     nest(l) = terms(l, first_term(j) + 2*i + 1)*c(l, z, k)
                  end do
                  ! The next pair of powers of z: none, one power alone, or two
                  !GCC$ unroll 24
                  do m = merge(2, max(2, k), 2*i + 2 < highest_power(j)), merge(k, 0, 2*i + 2 <= highest_power(j))
                     !$omp simd
                     do l = 1, half_block
                        nest(l) = nest(l) + c(l, square, m)*c(l, pair + i + pairs*j, k - m)
                     end do
                  end do
                  if (i > 0) c(:, pair + i - 1 + pairs*j, k) = nest
               end do
               !GCC$ unroll 24
               do m = merge(1, k, j + 1 < highest_sigma_power), k
                  !$omp simd
                  do l = 1, half_block
                     nest(l) = nest(l) + c(l, s, m)*c(l, power + j + 1, k - m)
                  end do
               end do
               c(:, power + j, k) = nest
            end do
            !$omp simd private(of_force, force)
            do l = 1, half_block
               of_force = 0.0_dp
               do j = 1, k - 1
                  of_force = of_force + c(l, p, k - j)*c(l, power, j)
               end do
               of_force = of_force + c(l, p, k)*c(l, power, 0) + c(l, p, 0)*c(l, power, k)
               force = wave(k + 1)*merge(force_cosine(before + l), force_sine(before + l), mod(k, 2) == 0)
               c(l, h, k + 1) = inverse(k + 1)*c(l, v, k)
               c(l, v, k + 1) = (inverse(k + 1)*half_strength(l))*of_force - force
            end do
         end do
         film(before + 1:before + half_block, 1:rupture_order) = c(:, h, 1:)
         momentum(before + 1:before + half_block, 1:rupture_order) = c(:, v, 1:)
      end do
   end subroutine reynolds_piezo_series

end module taylor_reynolds_piezo
