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
   use kinds, only: dp
   use lane_functions, only: lanes
   use rupture_lookup, only: look_up, rupture_load_t, rupture_state_t
   use series_factors, only: inverse, wave
   use taylor_step_control, only: free_rate, load_error, order, rounding
   implicit none(type, external)
   private

   !> Order of this series: its coefficients are dearer than those of the published films, so a lower one is
   !> best.
   integer, parameter, public :: rupture_order = 12

   !> Local error over that of the step control above which a step is not trusted, and rounding of the equation of motion.
   real(dp), parameter :: most_defect = 1.0_dp, equation_rounding = 64.0_dp*epsilon(1.0_dp)

   !> The series, in one array: their coefficients lie at fixed distances from each other, and one address leads to all.
   !> Names as above; u = m + t, y = m u, w = P, sine = t s, width_part: what A is multiplied by in Phi, square = (o**2)'/A',
   !> slope: times k, turn: X', one place later.
   integer, parameter :: h = 1, v = 2, p = 3, r = 4, a = 5, a_slope = 6, square = 7, o = 8, t_slope = 9, turn = 10, &
                         s = 11, sine = 12, m = 13, u = 14, y = 15, w = 16, width_part = 17, phi = 18, series = 18

   public :: rupture_series, evaluate_rupture_series, distrust_load_unforeseen

contains

   !> Coefficients 1 to `rupture_order` of H and V, and the damping rate.
   pure subroutine rupture_series(form, strength, rate, load, force_cosine, force_sine, film, momentum, &
      damping_rate, state)
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
      !> Films looked up last, those at the point of expansion afterwards
      type(rupture_state_t), intent(inout) :: state
      real(dp) :: c(lanes, series, 0:rupture_order)
      real(dp), dimension(lanes) :: half_p, half_root, half_o
      real(dp) :: of_p, of_r, of_a, of_square, of_o, of_turn, of_s, of_m, of_w, of_y, of_load, of_force, force, t_k
      integer :: k, j, l

      call look_up(form, film(:, 0), momentum(:, 0), rate, state)
      !$omp simd
      do l = 1, lanes
         c(l, h, 0) = film(l, 0)
         c(l, v, 0) = momentum(l, 0)
         c(l, p, 0) = state%pressure(l)
         c(l, r, 0) = state%root(l)
         half_root(l) = 0.5_dp*c(l, h, 0)*c(l, r, 0)
         half_p(l) = -c(l, p, 0)*half_root(l)
         c(l, a, 0) = state%group(l)
         c(l, m, 0) = state%end_ratio(l)
         c(l, w, 0) = state%width(l)
         c(l, o, 0) = 2.0_dp*state%tangent(l) + c(l, a, 0)
         half_o(l) = state%half_o(l)
         c(l, square, 0) = 2.0_dp*c(l, a, 0) - 4.0_dp*c(l, m, 0)
         c(l, s, 0) = state%cosine_square(l)
         c(l, sine, 0) = state%sine(l)
         c(l, u, 0) = c(l, m, 0) + state%tangent(l)
         c(l, y, 0) = c(l, m, 0)*c(l, u, 0)
         c(l, width_part, 0) = state%width_part(l)
         c(l, phi, 0) = state%load(l)
         c(l, h, 1) = c(l, v, 0)
         c(l, v, 1) = strength(l)*c(l, p, 0)*c(l, phi, 0) - load(l) - force_cosine(l)
         damping_rate(l) = -strength(l)*c(l, p, 0)*rate(l)*c(l, r, 0)*state%load_slope(l)
      end do
      ! Products of old coefficients first, twelve sums side by side, then those with the coefficients of the order before;
      ! those of this order, of which each waits for the one before, come last.
      !GCC$ unroll 24
      do k = 1, rupture_order - 1
         !$omp simd private(of_p, of_r, of_a, of_square, of_o, of_turn, of_s, of_m, of_w, of_y, of_load, of_force, force, t_k)
         do l = 1, lanes
            of_p = 0.0_dp
            of_force = 0.0_dp
            do j = 2, k - 2
               of_p = of_p + c(l, p, k - j)*c(l, h, j)
               of_force = of_force + c(l, p, k - j)*c(l, phi, j)
            end do
            of_r = 0.0_dp
            of_a = 0.0_dp
            do j = 2, k - 2
               of_r = of_r + c(l, r, k - j)*c(l, r, j)
               of_a = of_a + c(l, r, k - j)*c(l, v, j)
            end do
            of_turn = 0.0_dp
            of_w = 0.0_dp
            of_s = 0.0_dp
            of_m = 0.0_dp
            do j = 2, k - 2
               of_turn = of_turn + c(l, s, k - j)*c(l, t_slope, j)
               of_w = of_w + c(l, s, k - j)*c(l, turn, j)
               of_s = of_s + c(l, sine, k - j)*c(l, turn, j)
               of_m = of_m + c(l, y, k - j)*c(l, turn, j)
            end do
            of_square = 0.0_dp
            do j = 2, k - 2
               of_square = of_square + c(l, square, k - j)*c(l, a_slope, j)
            end do
            of_o = 0.0_dp
            do j = 2, k - 2
               of_o = of_o + c(l, o, k - j)*c(l, o, j)
            end do
            of_y = 0.0_dp
            do j = 2, k - 2
               of_y = of_y + c(l, u, k - j)*c(l, m, j)
            end do
            of_load = 0.0_dp
            do j = 2, k - 2
               of_load = of_load + c(l, width_part, k - j)*c(l, a, j)
            end do
            do j = 1, k - 1, max(1, k - 2)
               of_p = of_p + c(l, p, k - j)*c(l, h, j)
               of_force = of_force + c(l, p, k - j)*c(l, phi, j)
               of_r = of_r + c(l, r, k - j)*c(l, r, j)
               of_a = of_a + c(l, r, k - j)*c(l, v, j)
               of_turn = of_turn + c(l, s, k - j)*c(l, t_slope, j)
               of_w = of_w + c(l, s, k - j)*c(l, turn, j)
               of_s = of_s + c(l, sine, k - j)*c(l, turn, j)
               of_m = of_m + c(l, y, k - j)*c(l, turn, j)
               of_square = of_square + c(l, square, k - j)*c(l, a_slope, j)
               of_o = of_o + c(l, o, k - j)*c(l, o, j)
               of_y = of_y + c(l, u, k - j)*c(l, m, j)
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

   !> Sums of the series of H, V and V', as evaluate_series takes them.
   pure subroutine evaluate_rupture_series(film, momentum, x, film_sum, momentum_sum, rise_sum)
      !> Series of H [-]
      real(dp), intent(in) :: film(lanes, 0:order)
      !> Series of V [-]
      real(dp), intent(in) :: momentum(lanes, 0:order)
      !> Distance from the point of expansion [periods]
      real(dp), intent(in) :: x(lanes)
      !> H there [-]
      real(dp), intent(out) :: film_sum(lanes)
      !> V there [-]
      real(dp), intent(out) :: momentum_sum(lanes)
      !> V' there [-]
      real(dp), intent(out) :: rise_sum(lanes)
      integer, parameter :: last = rupture_order
      real(dp) :: square, film_odd, film_even, momentum_odd, momentum_even, rise_odd, rise_even
      integer :: l, k

      !$omp simd private(square, film_odd, film_even, momentum_odd, momentum_even, rise_odd, rise_even, k)
      do l = 1, lanes
         square = x(l)*x(l)
         film_even = film(l, last)
         momentum_even = momentum(l, last)
         rise_odd = real(last, dp)*momentum(l, last)
         film_odd = film(l, last - 1)
         momentum_odd = momentum(l, last - 1)
         rise_even = real(last - 1, dp)*momentum(l, last - 1)
         do k = last - 2, 2, -2
            film_even = film_even*square + film(l, k)
            momentum_even = momentum_even*square + momentum(l, k)
            rise_odd = rise_odd*square + real(k, dp)*momentum(l, k)
            film_odd = film_odd*square + film(l, k - 1)
            momentum_odd = momentum_odd*square + momentum(l, k - 1)
            rise_even = rise_even*square + real(k - 1, dp)*momentum(l, k - 1)
         end do
         film_sum(l) = film(l, 0) + (film_even*square + film_odd*x(l))
         momentum_sum(l) = momentum(l, 0) + (momentum_even*square + momentum_odd*x(l))
         rise_sum(l) = rise_even + rise_odd*x(l)
      end do
   end subroutine evaluate_rupture_series

   !> Take back the trust in steps at whose end the series of V misses the forces that the film and the gear have there.
   !>
   !> The last terms of a series tell its error only where the terms before them have begun to fall. A tooth in free flight
   !> with A >> 1 has a load of next to nothing, and so are its coefficients: those of the force alone, which fall at once, are
   !> seen. Where V goes through zero the load is back, up to a million times the one at the start. Or the load is some, but
   !> its series is near the border of its convergence: term after term is as large as the last. Neither of them can
   !> hide from the equation of motion at the end of the step. What the sum of the forces is off there, D, is that of the
   !> first terms left out, so D x/(n + 1) stands for the local error of V; it is held against what the step control
   !> grants the last term. The measure is that of module taylor_step_control at the end of the
   !> step, without its quotients; rounding is not held against a step.
   pure subroutine distrust_load_unforeseen(form, error_share, strength, rate, load, amplitude, cosine, force, accuracy, film, &
                                            momentum, next_film, next_momentum, next_rise, trust, state)
      !> Load of the film
      type(rupture_load_t), intent(in) :: form
      !> Share of the accuracy that a step may use up, over its length [1/periods]
      real(dp), intent(in) :: error_share
      !> a [-]
      real(dp), intent(in) :: strength(lanes)
      !> c [periods]
      real(dp), intent(in) :: rate(lanes)
      !> q, f, cos(2 pi x) at the end of the step, and P = q + f [-]
      real(dp), intent(in) :: load(lanes)
      real(dp), intent(in) :: amplitude(lanes)
      real(dp), intent(in) :: cosine(lanes)
      real(dp), intent(in) :: force(lanes)
      !> Relative accuracy of the film [-]
      real(dp), intent(in) :: accuracy(lanes)
      !> H and V at the start of the step [-]
      real(dp), intent(in) :: film(lanes)
      real(dp), intent(in) :: momentum(lanes)
      !> H, V and V' of the series at its end [-]
      real(dp), intent(in) :: next_film(lanes)
      real(dp), intent(in) :: next_momentum(lanes)
      real(dp), intent(in) :: next_rise(lanes)
      !> 1 where the step is trusted, set to 0 where it is not
      real(dp), intent(inout) :: trust(lanes)
      !> Films looked up last, those at the end of trusted steps afterwards
      type(rupture_state_t), intent(inout) :: state
      real(dp), dimension(lanes) :: end_film, end_momentum
      real(dp) :: carried, rate_of_damping, defect, square_film, granted
      integer :: l

      !$omp simd
      do l = 1, lanes
         end_film(l) = merge(next_film(l), film(l), trust(l) > 0.0_dp)
         end_momentum(l) = merge(next_momentum(l), momentum(l), trust(l) > 0.0_dp)
      end do
      call look_up(form, end_film, end_momentum, rate, state)
      !$omp simd private(carried, rate_of_damping, defect, square_film, granted)
      do l = 1, lanes
         rate_of_damping = -strength(l)*state%pressure(l)*rate(l)*state%root(l)*state%load_slope(l)
         carried = strength(l)*state%pressure(l)*state%load(l)
         defect = abs(carried - load(l) - amplitude(l)*cosine(l) - next_rise(l)) &
            - equation_rounding*(abs(carried) + force(l) + abs(rate_of_damping*end_momentum(l)))
         ! 1 + H**2, and w (1 + H**2) times the accuracy.
         square_film = 1.0_dp + end_film(l)*end_film(l)
         granted = (most_defect*real(rupture_order + 1, dp))*error_share*end_film(l)*max(accuracy(l), rounding*square_film)
         trust(l) = trust(l)*merge(1.0_dp, 0.0_dp, defect*square_film <= granted*(free_rate + rate_of_damping)) &
            *merge(1.0_dp, 0.0_dp, defect*rate_of_damping*end_film(l) <= granted*load_error*force(l))
      end do
   end subroutine distrust_load_unforeseen

end module taylor_rupture
