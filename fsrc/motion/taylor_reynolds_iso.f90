!> Taylor series of the motion with the exact iso-viscous film, for a block of lanes.
!>
!> With x = f_exc t and H = h/h_s, eq (1) reads
!>
!>     H' = V ,   V' = a p Phi(A) - q - f cos(2 pi x) ,   p = 1/H ,   A = c V r ,   r = H^(-1/2) .
!>
!> Phi has no closed form in A, but its parts obey simple equations along the motion. With the rupture angle
!> x_e, t = tan x_e, s = cos(x_e)**2, K = integral of cos**4 up to x_e, m = s**2/(4 K), P = x_e + pi/2 + t s:
!>
!>     Phi = s/4 - A P/8                                      load, eq (21) corrected
!>     (2 t + A) t' = -(m + t) A'                             eq (18) differentiated
!>
!> The second is (t**2 + A t)' = -m A'. With o = 2 t + A > 0 this becomes, and the rest follows by the chain
!> rule,
!>
!>     (o**2)' = (2 A - 4 m) A' ,   t = (o - A)/2 ,   s (1 + t**2) = 1 ,
!>     x_e' = s t' ,   m' = -4 x_e' m (m + t) ,   P' = 2 s x_e' .
!>
!> No root is sought: at the point of expansion t, dt/dA and dPhi/dA come from the film tables, and with them
!>
!>     m = -t - o dt/dA ,   P = 2 s**2 (m + t) - 8 dPhi/dA .
!>
!> None of the formulas cancels, on approach (A -> -inf: t ~ -A, m -> 0) or separation
!> (A -> +inf: t ~ -3 A/8, m ~ 15 A/32, Phi ~ 16/(81 A**2)).
module taylor_reynolds_iso
   use constants, only: two_pi
   use kinds, only: dp
   use lane_functions, only: lanes
   use iso_viscous_coefficients, only: coordinate_scale, load_slope_table, tangent_slope_table, tangent_table
   use iso_viscous_sums, only: locate_block, sum_block
   use taylor_step_control, only: order
   implicit none(type, external)
   private

   integer :: i
   !> 1/k
   real(dp), parameter :: inverse(order) = [(1.0_dp/real(i, dp), i=1, order)]
   !> Coefficient k-1 of cos(2 pi x) about any x0, over k, is wave(k) times cos (k odd) or sin (k even) of 2
   !> pi x0.
   real(dp), parameter :: wave(order) = &
      [(merge(1.0_dp, -1.0_dp, mod(i, 4) < 2)*two_pi**(i - 1)/gamma(real(i + 1, dp)), i=1, order)]

   !> Order of this series: its coefficients are dearer than those of the published films, so a lower one is
   !> best.
   integer, parameter, public :: reynolds_order = 12

   public :: reynolds_iso_series

contains

   !> t, m and P of the films of a block, from their tables.
   pure subroutine rupture_states(group, tangent, share, width)
      !> A [-]
      real(dp), intent(in) :: group(lanes)
      !> t [-]
      real(dp), intent(out) :: tangent(lanes)
      !> m [-]
      real(dp), intent(out) :: share(lanes)
      !> P [-]
      real(dp), intent(out) :: width(lanes)
      real(dp), dimension(lanes) :: v, lead, fall, half, tangent_sum, slope, load_slope
      real(dp) :: s
      integer :: l

      call locate_block(lanes, group, v, lead, fall, half)
      call sum_block(lanes, tangent_table, group, v, tangent_sum)
      call sum_block(lanes, tangent_slope_table, group, v, slope)
      call sum_block(lanes, load_slope_table, group, v, load_slope)
      !$omp simd private(s)
      do l = 1, lanes
         tangent(l) = tangent_sum(l)*sqrt(group(l)*group(l) + coordinate_scale*coordinate_scale)
         share(l) = -tangent(l) - (2.0_dp*tangent(l) + group(l))*slope(l)
         s = 1.0_dp/(1.0_dp + tangent(l)*tangent(l))
         load_slope(l) = (fall(l)*half(l))*(fall(l)*half(l))*(fall(l)*half(l))*load_slope(l)
         width(l) = 2.0_dp*s*s*(share(l) + tangent(l)) - 8.0_dp*load_slope(l)
      end do
   end subroutine rupture_states

   !> Coefficients 1 to `reynolds_order` of H and V, and the damping rate.
   pure subroutine reynolds_iso_series(strength, rate, load, force_cosine, force_sine, film, momentum, &
      damping_rate)
      !> a [-]
      real(dp), intent(in) :: strength(lanes)
      !> c [periods]
      real(dp), intent(in) :: rate(lanes)
      !> q [-]
      real(dp), intent(in) :: load(lanes)
      !> f cos(2 pi x) and f sin(2 pi x) at the point of expansion [-]
      real(dp), intent(in) :: force_cosine(lanes)
      real(dp), intent(in) :: force_sine(lanes)
      !> Series of H [-]; coefficient 0 is given
      real(dp), intent(inout) :: film(lanes, 0:order)
      !> Series of V [-]; coefficient 0 is given
      real(dp), intent(inout) :: momentum(lanes, 0:order)
      !> -dV'/dV [1/periods]
      real(dp), intent(out) :: damping_rate(lanes)
      real(dp), dimension(lanes, 0:reynolds_order) :: p, r, group, group_slope, square, opening, tangent, &
         tangent_slope, tau, s
      real(dp), dimension(lanes, 0:reynolds_order) :: angle_slope, share, width, both_parts, y, phi, w
      real(dp) :: force(lanes, 0:1), both(lanes), half_root(lanes), half_opening(lanes)
      real(dp) :: sum, half
      integer :: k, j, l

      !$omp simd
      do l = 1, lanes
         force(l, 0) = force_cosine(l)
         force(l, 1) = force_sine(l)
         p(l, 0) = 1.0_dp/film(l, 0)
         r(l, 0) = sqrt(p(l, 0))
         half_root(l) = 0.5_dp*film(l, 0)*r(l, 0)
         both(l) = -p(l, 0)*half_root(l)
         group(l, 0) = rate(l)*momentum(l, 0)*r(l, 0)
      end do
      call rupture_states(group(:, 0), tangent(:, 0), share(:, 0), width(:, 0))
      !$omp simd
      do l = 1, lanes
         opening(l, 0) = 2.0_dp*tangent(l, 0) + group(l, 0)
         half_opening(l) = 0.5_dp/opening(l, 0)
         square(l, 0) = 2.0_dp*group(l, 0) - 4.0_dp*share(l, 0)
         s(l, 0) = 1.0_dp/(1.0_dp + tangent(l, 0)*tangent(l, 0))
         both_parts(l, 0) = share(l, 0) + tangent(l, 0)
         y(l, 0) = share(l, 0)*both_parts(l, 0)
         phi(l, 0) = 0.25_dp*s(l, 0) - 0.125_dp*group(l, 0)*width(l, 0)
         w(l, 0) = p(l, 0)*phi(l, 0)
         film(l, 1) = momentum(l, 0)
         momentum(l, 1) = strength(l)*w(l, 0) - load(l) - force(l, 0)
         damping_rate(l) = strength(l)*p(l, 0)*rate(l)*r(l, 0) &
            *(0.125_dp*width(l, 0) - 0.25_dp*s(l, 0)*s(l, 0)*both_parts(l, 0))
      end do
      !GCC$ unroll 24
      do k = 1, reynolds_order - 1
         !$omp simd private(sum, half)
         do l = 1, lanes
            ! r**2 = p, p H = 1
            half = 0.0_dp
            do j = 1, (k - 1)/2
               half = half + r(l, j)*r(l, k - j)
            end do
            half = 2.0_dp*half
            if (mod(k, 2) == 0) half = half + r(l, shiftr(k, 1))*r(l, shiftr(k, 1))
            sum = 0.0_dp
            do j = 1, k
               sum = sum + p(l, k - j)*film(l, j)
            end do
            p(l, k) = -p(l, 0)*sum
            r(l, k) = both(l)*sum - half_root(l)*half
         end do
         !$omp simd private(sum, half)
         do l = 1, lanes
            ! A = c V r
            sum = 0.0_dp
            do j = 0, k
               sum = sum + momentum(l, j)*r(l, k - j)
            end do
            group(l, k) = rate(l)*sum
            group_slope(l, k) = real(k, dp)*group(l, k)
            ! o**2, o, t
            sum = 0.0_dp
            do j = 1, k
               sum = sum + square(l, k - j)*group_slope(l, j)
            end do
            half = 0.0_dp
            do j = 1, (k - 1)/2
               half = half + opening(l, j)*opening(l, k - j)
            end do
            half = 2.0_dp*half
            if (mod(k, 2) == 0) half = half + opening(l, shiftr(k, 1))*opening(l, shiftr(k, 1))
            opening(l, k) = half_opening(l)*(inverse(k)*sum - half)
            tangent(l, k) = 0.5_dp*(opening(l, k) - group(l, k))
         end do
         !$omp simd private(sum, half)
         do l = 1, lanes
            ! 1 + t**2
            half = tangent(l, 0)*tangent(l, k)
            do j = 1, (k - 1)/2
               half = half + tangent(l, j)*tangent(l, k - j)
            end do
            half = 2.0_dp*half
            if (mod(k, 2) == 0) half = half + tangent(l, shiftr(k, 1))*tangent(l, shiftr(k, 1))
            tau(l, k) = half
            tangent_slope(l, k) = real(k, dp)*tangent(l, k)
            ! s and x_e'
            sum = 0.0_dp
            half = 0.0_dp
            do j = 1, k
               sum = sum + s(l, k - j)*tau(l, j)
               half = half + s(l, k - j)*tangent_slope(l, j)
            end do
            s(l, k) = -s(l, 0)*sum
            angle_slope(l, k - 1) = half
            ! m and P
            sum = 0.0_dp
            half = 0.0_dp
            do j = 0, k - 1
               sum = sum + angle_slope(l, j)*y(l, k - 1 - j)
               half = half + angle_slope(l, j)*s(l, k - 1 - j)
            end do
            share(l, k) = -(4.0_dp*inverse(k))*sum
            width(l, k) = (2.0_dp*inverse(k))*half
            square(l, k) = 2.0_dp*group(l, k) - 4.0_dp*share(l, k)
            both_parts(l, k) = share(l, k) + tangent(l, k)
            sum = 0.0_dp
            do j = 0, k
               sum = sum + share(l, j)*both_parts(l, k - j)
            end do
            y(l, k) = sum
         end do
         !$omp simd private(sum)
         do l = 1, lanes
            ! Phi and p Phi
            sum = 0.0_dp
            do j = 0, k
               sum = sum + group(l, j)*width(l, k - j)
            end do
            phi(l, k) = 0.25_dp*s(l, k) - 0.125_dp*sum
            sum = 0.0_dp
            do j = 0, k
               sum = sum + p(l, j)*phi(l, k - j)
            end do
            w(l, k) = sum
            film(l, k + 1) = inverse(k + 1)*momentum(l, k)
            momentum(l, k + 1) = (inverse(k + 1)*strength(l))*w(l, k) - wave(k + 1)*force(l, mod(k, 2))
         end do
      end do
   end subroutine reynolds_iso_series

end module taylor_reynolds_iso
