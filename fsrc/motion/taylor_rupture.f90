!> Taylor series of the motion with an iso-viscous film whose rupture follows from (18), for a block of lanes: the exact film,
!> and the published one (24) with x_e solved.
!>
!> With x = f_exc t and H = h/h_s, eq (1) reads
!>
!>     H' = V ,   V' = a p Phi(A) - q - f cos(2 pi x) ,   p = 1/H ,   A = c V r ,   r = H^(-1/2) .
!>
!> With the rupture angle x_e, t = tan x_e, s = cos(x_e)**2, K = integral of cos**4 up to x_e, m = s**2/(4 K), X = x_e + pi/2,
!> P = X + t s, the load is
!>
!>     Phi = s/4 - A P/8      exact film, eq (21) corrected
!>     Phi = 1 - 3/11.2 A X   published film, eq (24), in units of its rolling term
!>
!> It has no closed form in A, but its parts obey simple equations along the motion:
!>
!>     (2 t + A) t' = -(m + t) A'                             eq (18) differentiated
!>
!> is (t**2 + A t)' = -m A'. With o = 2 t + A > 0 this becomes, and the rest follows by the chain rule,
!>
!>     (o**2)' = (2 A - 4 m) A' ,   t = (o - A)/2 ,   X' = s t' ,
!>     s' = -2 (t s) X' ,   P' = 2 s X' ,   t s = P - X ,   m' = -4 X' m (m + t) .
!>
!> No root is sought: at the point of expansion t, dt/dA and dPhi/dA come from the film tables, and with them
!>
!>     m = -t - o dt/dA ,   P = 2 s**2 (m + t) - 8 dPhi/dA .
!>
!> None of the formulas cancels, on approach (A -> -inf: t ~ -A, m -> 0) or separation
!> (A -> +inf: t ~ -3 A/8, m ~ 15 A/32, Phi ~ 16/(81 A**2)).
module taylor_rupture
   use constants, only: two_pi
   use kinds, only: dp
   use lane_functions, only: lanes
   use iso_viscous_coefficients, only: coordinate_scale, load_slope_table, tangent_slope_table, tangent_table
   use iso_viscous_sums, only: locate_block, sum_block
   use published_iso_viscous, only: squeeze_share
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
   integer, parameter, public :: rupture_order = 12

   !> The series, in one array: their coefficients lie at fixed distances from each other, and one address leads to all.
   !> Names as above; u = m + t, y = m u, w = P, sine = t s, load = (Phi - s)/A, square = (o**2)'/A', slope: times k, turn: X',
   !> one place later.
   integer, parameter :: h = 1, v = 2, p = 3, r = 4, a = 5, a_slope = 6, square = 7, o = 8, t_slope = 9, turn = 10, &
                         s = 11, sine = 12, m = 13, u = 14, y = 15, w = 16, width_part = 17, phi = 18, series = 18

   !> Phi = constant + cosine s + A (width P + angle X) of a film.
   type, public :: rupture_load_t
      real(dp) :: constant = 0.0_dp
      real(dp) :: cosine = 0.0_dp
      real(dp) :: width = 0.0_dp
      real(dp) :: angle = 0.0_dp
   end type rupture_load_t

   !> The exact film, and the published one.
   type(rupture_load_t), parameter, public :: exact_load = rupture_load_t(cosine=0.25_dp, width=-0.125_dp)
   type(rupture_load_t), parameter, public :: published_load = rupture_load_t(constant=1.0_dp, angle=-squeeze_share)

   public :: rupture_series

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

   !> Coefficients 1 to `rupture_order` of H and V, and the damping rate.
   pure subroutine rupture_series(form, strength, rate, load, force_cosine, force_sine, film, momentum, &
      damping_rate)
      !> Load of the film
      type(rupture_load_t), intent(in) :: form
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
      real(dp) :: c(lanes, series, 0:rupture_order)
      real(dp), dimension(lanes) :: half_p, half_root, half_o, t_0, m_0, w_0
      real(dp) :: of_p, of_r, of_a, of_square, of_o, of_turn, of_s, of_m, of_w, of_y, of_load, of_force, force, t_k, turning, slope
      integer :: k, j, l

      !$omp simd
      do l = 1, lanes
         c(l, h, 0) = film(l, 0)
         c(l, v, 0) = momentum(l, 0)
         c(l, p, 0) = 1.0_dp/c(l, h, 0)
         c(l, r, 0) = sqrt(c(l, p, 0))
         half_root(l) = 0.5_dp*c(l, h, 0)*c(l, r, 0)
         half_p(l) = -c(l, p, 0)*half_root(l)
         c(l, a, 0) = rate(l)*c(l, v, 0)*c(l, r, 0)
      end do
      call rupture_states(c(:, a, 0), t_0, m_0, w_0)
      !$omp simd
      do l = 1, lanes
         c(l, m, 0) = m_0(l)
         c(l, w, 0) = w_0(l)
         c(l, o, 0) = 2.0_dp*t_0(l) + c(l, a, 0)
         half_o(l) = 0.5_dp/c(l, o, 0)
         c(l, square, 0) = 2.0_dp*c(l, a, 0) - 4.0_dp*c(l, m, 0)
         c(l, s, 0) = 1.0_dp/(1.0_dp + t_0(l)*t_0(l))
         c(l, sine, 0) = t_0(l)*c(l, s, 0)
         c(l, u, 0) = c(l, m, 0) + t_0(l)
         c(l, y, 0) = c(l, m, 0)*c(l, u, 0)
         c(l, width_part, 0) = form%width*w_0(l) + form%angle*(w_0(l) - c(l, sine, 0))
         c(l, phi, 0) = form%constant + form%cosine*c(l, s, 0) + c(l, a, 0)*c(l, width_part, 0)
         c(l, h, 1) = c(l, v, 0)
         c(l, v, 1) = strength(l)*c(l, p, 0)*c(l, phi, 0) - load(l) - force_cosine(l)
         ! dX/dA, dPhi/dA
         turning = -c(l, s, 0)*c(l, u, 0)/c(l, o, 0)
         slope = c(l, width_part, 0) + turning*(c(l, a, 0)*(2.0_dp*form%width*c(l, s, 0) + form%angle) &
                                                - 2.0_dp*form%cosine*c(l, sine, 0))
         damping_rate(l) = -strength(l)*c(l, p, 0)*rate(l)*c(l, r, 0)*slope
      end do
      ! All products of earlier coefficients first, twelve sums side by side; those with the newest ones, of which each
      ! waits for the one before, come after.
      !GCC$ unroll 24
      do k = 1, rupture_order - 1
         !$omp simd private(of_p, of_r, of_a, of_square, of_o, of_turn, of_s, of_m, of_w, of_y, of_load, of_force, force, t_k)
         do l = 1, lanes
            of_p = 0.0_dp
            of_force = 0.0_dp
            do j = 1, k - 1
               of_p = of_p + c(l, p, k - j)*c(l, h, j)
               of_force = of_force + c(l, p, k - j)*c(l, phi, j)
            end do
            of_r = 0.0_dp
            of_a = 0.0_dp
            do j = 1, k - 1
               of_r = of_r + c(l, r, k - j)*c(l, r, j)
               of_a = of_a + c(l, r, k - j)*c(l, v, j)
            end do
            of_turn = 0.0_dp
            of_w = 0.0_dp
            of_s = 0.0_dp
            of_m = 0.0_dp
            do j = 1, k - 1
               of_turn = of_turn + c(l, s, k - j)*c(l, t_slope, j)
               of_w = of_w + c(l, s, k - j)*c(l, turn, j)
               of_s = of_s + c(l, sine, k - j)*c(l, turn, j)
               of_m = of_m + c(l, y, k - j)*c(l, turn, j)
            end do
            of_square = 0.0_dp
            do j = 1, k - 1
               of_square = of_square + c(l, square, k - j)*c(l, a_slope, j)
            end do
            of_o = 0.0_dp
            do j = 1, k - 1
               of_o = of_o + c(l, o, k - j)*c(l, o, j)
            end do
            of_y = 0.0_dp
            do j = 1, k - 1
               of_y = of_y + c(l, u, k - j)*c(l, m, j)
            end do
            of_load = 0.0_dp
            do j = 1, k - 1
               of_load = of_load + c(l, width_part, k - j)*c(l, a, j)
            end do
            ! p H = 1, r**2 = p, A = c V r
            of_p = of_p + c(l, p, 0)*c(l, h, k)
            c(l, p, k) = -c(l, p, 0)*of_p
            c(l, r, k) = half_p(l)*of_p - half_root(l)*of_r
            c(l, a, k) = rate(l)*(of_a + c(l, v, k)*c(l, r, 0) + c(l, v, 0)*c(l, r, k))
            c(l, a_slope, k) = real(k, dp)*c(l, a, k)
            ! o**2, o, t, x_e'
            c(l, o, k) = half_o(l)*(inverse(k)*(of_square + c(l, square, 0)*c(l, a_slope, k)) - of_o)
            t_k = 0.5_dp*(c(l, o, k) - c(l, a, k))
            c(l, t_slope, k) = real(k, dp)*t_k
            c(l, turn, k) = of_turn + c(l, s, 0)*c(l, t_slope, k)
            ! s, P, t s, m
            c(l, s, k) = -(2.0_dp*inverse(k))*(of_s + c(l, sine, 0)*c(l, turn, k))
            c(l, w, k) = (2.0_dp*inverse(k))*(of_w + c(l, s, 0)*c(l, turn, k))
            c(l, sine, k) = c(l, w, k) - inverse(k)*c(l, turn, k)
            c(l, m, k) = -(4.0_dp*inverse(k))*(of_m + c(l, y, 0)*c(l, turn, k))
            c(l, square, k) = 2.0_dp*c(l, a, k) - 4.0_dp*c(l, m, k)
            c(l, u, k) = c(l, m, k) + t_k
            c(l, y, k) = of_y + c(l, m, 0)*c(l, u, k) + c(l, m, k)*c(l, u, 0)
            ! Phi, H, V
            c(l, width_part, k) = form%width*c(l, w, k) + (inverse(k)*form%angle)*c(l, turn, k)
            c(l, phi, k) = form%cosine*c(l, s, k) + (of_load + c(l, a, 0)*c(l, width_part, k) &
                                                     + c(l, a, k)*c(l, width_part, 0))
            force = wave(k + 1)*merge(force_cosine(l), force_sine(l), mod(k, 2) == 0)
            c(l, h, k + 1) = inverse(k + 1)*c(l, v, k)
            c(l, v, k + 1) = (inverse(k + 1)*strength(l))*(of_force + c(l, p, 0)*c(l, phi, k) + c(l, p, k)*c(l, phi, 0)) - force
         end do
      end do
      film(:, 1:rupture_order) = c(:, h, 1:)
      momentum(:, 1:rupture_order) = c(:, v, 1:)
   end subroutine rupture_series

end module taylor_rupture
