!> Taylor series of the motion with an iso-viscous film whose rupture follows from (18), for a block of lanes: the Reynolds film,
!> and the published one (24) with x_e solved, on one flank or between two (fsrc/THEORY.md, section 4).
!>
!> Phi has no closed form, but module load_expansion gives its Taylor series about any A. For n = 12 the nested pairs together take
!> as many products of coefficients as two products of whole series.
module taylor_rupture
   use kinds, only: dp
   use lane_force, only: factor
   use lane_functions, only: lanes
   use load_expansion, only: expand_load, highest_power, load_expansion_t
   use taylor_step_control, only: free_rate, inverse, load_error, order, rounding
   implicit none(type, external)
   private

   !> Order n of this series: its coefficients cost more than those of the published films, so a lower one is best.
   integer, parameter, public :: rupture_order = highest_power + 1

   !> Local error over that of the step control above which a step is rejected, and rounding of the equation of motion.
   real(dp), parameter :: most_defect = 1.0_dp
   real(dp), parameter, public :: equation_rounding = 64.0_dp*epsilon(1.0_dp)

   !> The series, in one array: their coefficients lie at fixed distances from each other, and one address leads to all.
   !> Names as above; square = z**2, nest + i: T_i.
   integer, parameter :: last_pair = (rupture_order - 2)/2
   integer, parameter :: h = 1, v = 2, p = 3, r = 4, z = 5, square = 6, nest = 7, series = nest + last_pair

   public :: rupture_series, rupture_series_of_two, evaluate_rupture_series, reject_large_defect

contains

   !> Coefficients 1 to `rupture_order` of H and V, and the damping rate.
   pure subroutine rupture_series(law, strength, rate, load, force, film, lienard, damping_rate, expansion)
      !> Load, as module load_pieces numbers it
      integer, intent(in) :: law
      !> a [-]
      real(dp), intent(in) :: strength(lanes)
      !> c [periods]
      real(dp), intent(in) :: rate(lanes)
      !> q [-]
      real(dp), intent(in) :: load(lanes)
      !> Derivatives of the force that oscillates, by module lane_force [-]
      real(dp), intent(in) :: force(lanes, order)
      !> Series of H [-]; coefficient 0 is given
      real(dp), intent(inout) :: film(lanes, 0:order)
      !> Series of V [-]; coefficient 0 is given
      real(dp), intent(inout) :: lienard(lanes, 0:order)
      !> -dV'/dV [1/periods]
      real(dp), intent(out) :: damping_rate(lanes)
      !> Films looked up last, those at the point of expansion afterwards
      type(load_expansion_t), intent(inout) :: expansion
      real(dp) :: c(lanes, series, 0:rupture_order)
      real(dp), dimension(lanes) :: half_root, unit_rate
      real(dp) :: of_p, of_r, of_z, of_square, of_nest, of_force, oscillation
      integer :: once, k, j, i, l

      call expand_load(law, film(:, 0), lienard(:, 0), rate, expansion)
      !$omp simd
      do l = 1, lanes
         c(l, h, 0) = film(l, 0)
         c(l, v, 0) = lienard(l, 0)
         c(l, p, 0) = expansion%inverse_film(l)
         c(l, r, 0) = expansion%root(l)
         half_root(l) = 0.5_dp*c(l, h, 0)*c(l, r, 0)
         unit_rate(l) = rate(l)*expansion%inverse_unit(l)
         c(l, h, 1) = c(l, v, 0)
         c(l, v, 1) = strength(l)*c(l, p, 0)*expansion%terms(l, 0) - load(l) - force(l, 1)
         damping_rate(l) = -strength(l)*c(l, p, 0)*rate(l)*c(l, r, 0)*expansion%load_slope(l)
      end do
      do i = 0, last_pair
         c(:, nest + i, 0) = expansion%terms(:, 2*i)
      end do
      ! The products with the newest coefficients come last: all others can be summed while those are still under way.
      ! One loop over lanes an order: its rounds share the instructions, which would not fit into the cache of a
      ! processor otherwise. gfortran unrolls the orders before it looks for full registers only within another loop.
      do once = 1, 1
         !GCC$ unroll 24
         do k = 1, rupture_order - 1
            !$omp simd private(of_p, of_r, of_z, of_square, of_nest, of_force, oscillation)
            do l = 1, lanes
               of_p = 0.0_dp
               of_z = 0.0_dp
               do j = 2, k - 1
                  of_p = of_p + c(l, p, k - j)*c(l, h, j)
                  of_z = of_z + c(l, r, k - j)*c(l, v, j)
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
               ! p H = 1, r**2 = p, z e = c V r less its value at the start
               c(l, p, k) = -c(l, p, 0)*(of_p + c(l, p, 0)*c(l, h, k))
               c(l, r, k) = half_root(l)*(c(l, p, k) - of_r)
               c(l, z, k) = unit_rate(l)*(of_z + c(l, r, 0)*c(l, v, k) + c(l, r, k)*c(l, v, 0))
               c(l, square, k) = of_square
               !GCC$ unroll 8
               do i = min(last_pair, (rupture_order - 1 - k)/2), 0, -1
                  of_nest = expansion%terms(l, 2*i + 1)*c(l, z, k)
                  do j = max(2, k - (rupture_order - 1 - 2*(i + 1))), merge(k, 0, i < last_pair)
                     of_nest = of_nest + c(l, square, j)*c(l, nest + i + 1, k - j)
                  end do
                  c(l, nest + i, k) = of_nest
               end do
               of_force = 0.0_dp
               do j = 1, k - 1
                  of_force = of_force + c(l, p, k - j)*c(l, nest, j)
               end do
               of_force = of_force + c(l, p, k)*c(l, nest, 0) + c(l, p, 0)*c(l, nest, k)
               oscillation = factor(k + 1)*force(l, k + 1)
               c(l, h, k + 1) = inverse(k + 1)*c(l, v, k)
               c(l, v, k + 1) = (inverse(k + 1)*strength(l))*of_force - oscillation
            end do
         end do
      end do
      film(:, 1:rupture_order) = c(:, h, 1:)
      lienard(:, 1:rupture_order) = c(:, v, 1:)
   end subroutine rupture_series

   !> The same between two flanks.
   pure subroutine rupture_series_of_two(law, strength, rate, backlash, load, force, film, lienard, damping_rate, expansion)
      !> Load, as module load_pieces numbers it
      integer, intent(in) :: law
      !> a [-]
      real(dp), intent(in) :: strength(lanes)
      !> c [periods]
      real(dp), intent(in) :: rate(lanes)
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
      !> -dV'/dV [1/periods]
      real(dp), intent(out) :: damping_rate(lanes)
      !> Films of the drive and the coast flank looked up last, those at the point of expansion afterwards
      type(load_expansion_t), intent(inout) :: expansion(2)
      !> Lane, series, flank, coefficient
      real(dp) :: c(lanes, series, 2, 0:rupture_order)
      real(dp), dimension(lanes, 2) :: half_root, unit_rate, carried
      real(dp) :: of_p, of_r, of_z, of_square, of_nest, of_force
      integer :: once, flank, k, j, i, l

      c(:, h, 1, 0) = film(:, 0)
      c(:, v, 1, 0) = lienard(:, 0)
      c(:, h, 2, 0) = backlash - film(:, 0)
      c(:, v, 2, 0) = -lienard(:, 0)
      do flank = 1, 2
         call expand_load(law, c(:, h, flank, 0), c(:, v, flank, 0), rate, expansion(flank))
         !$omp simd
         do l = 1, lanes
            c(l, p, flank, 0) = expansion(flank)%inverse_film(l)
            c(l, r, flank, 0) = expansion(flank)%root(l)
            half_root(l, flank) = 0.5_dp*c(l, h, flank, 0)*c(l, r, flank, 0)
            unit_rate(l, flank) = rate(l)*expansion(flank)%inverse_unit(l)
            carried(l, flank) = c(l, p, flank, 0)*expansion(flank)%terms(l, 0)
         end do
         do i = 0, last_pair
            c(:, nest + i, flank, 0) = expansion(flank)%terms(:, 2*i)
         end do
      end do
      damping_rate = -strength*rate*(c(:, p, 1, 0)*c(:, r, 1, 0)*expansion(1)%load_slope &
                                     + c(:, p, 2, 0)*c(:, r, 2, 0)*expansion(2)%load_slope)
      c(:, h, 1, 1) = c(:, v, 1, 0)
      c(:, v, 1, 1) = strength*(carried(:, 1) - carried(:, 2)) - load - force(:, 1)
      c(:, h, 2, 1) = -c(:, h, 1, 1)
      c(:, v, 2, 1) = -c(:, v, 1, 1)
      do once = 1, 1
         !GCC$ unroll 24
         do k = 1, rupture_order - 1
            do flank = 1, 2
               !$omp simd private(of_p, of_r, of_z, of_square, of_nest, of_force)
               do l = 1, lanes
                  of_p = 0.0_dp
                  of_z = 0.0_dp
                  do j = 1, k - 1
                     of_p = of_p + c(l, p, flank, k - j)*c(l, h, flank, j)
                     of_z = of_z + c(l, r, flank, k - j)*c(l, v, flank, j)
                  end do
                  of_r = 0.0_dp
                  of_square = 0.0_dp
                  do j = 1, (k - 1)/2
                     of_r = of_r + c(l, r, flank, j)*c(l, r, flank, k - j)
                     of_square = of_square + c(l, z, flank, j)*c(l, z, flank, k - j)
                  end do
                  of_r = 2.0_dp*of_r
                  of_square = 2.0_dp*of_square
                  if (mod(k, 2) == 0) then
                     of_r = of_r + c(l, r, flank, shiftr(k, 1))*c(l, r, flank, shiftr(k, 1))
                     of_square = of_square + c(l, z, flank, shiftr(k, 1))*c(l, z, flank, shiftr(k, 1))
                  end if
                  c(l, p, flank, k) = -c(l, p, flank, 0)*(of_p + c(l, p, flank, 0)*c(l, h, flank, k))
                  c(l, r, flank, k) = half_root(l, flank)*(c(l, p, flank, k) - of_r)
                  c(l, z, flank, k) = unit_rate(l, flank) &
                     *(of_z + c(l, r, flank, 0)*c(l, v, flank, k) + c(l, r, flank, k)*c(l, v, flank, 0))
                  c(l, square, flank, k) = of_square
                  !GCC$ unroll 8
                  do i = min(last_pair, (rupture_order - 1 - k)/2), 0, -1
                     of_nest = expansion(flank)%terms(l, 2*i + 1)*c(l, z, flank, k)
                     do j = max(2, k - (rupture_order - 1 - 2*(i + 1))), merge(k, 0, i < last_pair)
                        of_nest = of_nest + c(l, square, flank, j)*c(l, nest + i + 1, flank, k - j)
                     end do
                     c(l, nest + i, flank, k) = of_nest
                  end do
                  of_force = 0.0_dp
                  do j = 0, k
                     of_force = of_force + c(l, p, flank, k - j)*c(l, nest, flank, j)
                  end do
                  carried(l, flank) = of_force
               end do
            end do
            !$omp simd
            do l = 1, lanes
               c(l, h, 1, k + 1) = inverse(k + 1)*c(l, v, 1, k)
               c(l, v, 1, k + 1) = (inverse(k + 1)*strength(l))*(carried(l, 1) - carried(l, 2)) - factor(k + 1)*force(l, k + 1)
               c(l, h, 2, k + 1) = -c(l, h, 1, k + 1)
               c(l, v, 2, k + 1) = -c(l, v, 1, k + 1)
            end do
         end do
      end do
      film(:, 1:rupture_order) = c(:, h, 1, 1:)
      lienard(:, 1:rupture_order) = c(:, v, 1, 1:)
   end subroutine rupture_series_of_two

   !> Sums of the series of H, V and V', as evaluate_series takes them.
   pure subroutine evaluate_rupture_series(film, lienard, x, film_sum, lienard_sum, rise_sum)
      !> Series of H [-]
      real(dp), intent(in) :: film(lanes, 0:order)
      !> Series of V [-]
      real(dp), intent(in) :: lienard(lanes, 0:order)
      !> Distance from the point of expansion [periods]
      real(dp), intent(in) :: x(lanes)
      !> H there [-]
      real(dp), intent(out) :: film_sum(lanes)
      !> V there [-]
      real(dp), intent(out) :: lienard_sum(lanes)
      !> V' there [-]
      real(dp), intent(out) :: rise_sum(lanes)
      integer, parameter :: last = rupture_order
      real(dp) :: square, film_odd, film_even, lienard_odd, lienard_even, rise_odd, rise_even
      integer :: l, k

      !$omp simd private(square, film_odd, film_even, lienard_odd, lienard_even, rise_odd, rise_even, k)
      do l = 1, lanes
         square = x(l)*x(l)
         film_even = film(l, last)
         lienard_even = lienard(l, last)
         rise_odd = real(last, dp)*lienard(l, last)
         film_odd = film(l, last - 1)
         lienard_odd = lienard(l, last - 1)
         rise_even = real(last - 1, dp)*lienard(l, last - 1)
         do k = last - 2, 2, -2
            film_even = film_even*square + film(l, k)
            lienard_even = lienard_even*square + lienard(l, k)
            rise_odd = rise_odd*square + real(k, dp)*lienard(l, k)
            film_odd = film_odd*square + film(l, k - 1)
            lienard_odd = lienard_odd*square + lienard(l, k - 1)
            rise_even = rise_even*square + real(k - 1, dp)*lienard(l, k - 1)
         end do
         film_sum(l) = film(l, 0) + (film_even*square + film_odd*x(l))
         lienard_sum(l) = lienard(l, 0) + (lienard_even*square + lienard_odd*x(l))
         rise_sum(l) = rise_even + rise_odd*x(l)
      end do
   end subroutine evaluate_rupture_series

   !> Reject steps whose series violates the equation of motion at their end.
   !>
   !> The last terms of a series tell its error only where the terms before them have begun to fall. There are two cases in which
   !> they have not. A tooth in free flight with A >> 1 has a load that is far below the force, and so are its coefficients: the
   !> last terms are those of the force alone, which fall at once; where V goes through zero, the load is up to a million times
   !> the one at the start. Or the load matters, but its series is close to its radius of convergence, and term after term is as
   !> large as the last. In both cases the series violates the equation of motion at the end of the step. The defect D, by which
   !> the sum of the forces is off there, is that of the first terms left out, so D x/(n + 1) estimates the local error of V; it
   !> must not exceed what the step control grants the last term, in the measure of module taylor_step_control at the end of the
   !> step, less the rounding of the forces.
   pure subroutine reject_large_defect(error_share, load, force, accuracy, carried, largest, rate_of_damping, film, lienard, &
                                       rise, trust)
      !> Share of the accuracy that a step may use up, over its length [1/periods]
      real(dp), intent(in) :: error_share
      !> q + f cos(2 pi x) at the end of the step, and P = q + f [-]
      real(dp), intent(in) :: load(lanes)
      real(dp), intent(in) :: force(lanes)
      !> Relative accuracy of the film [-]
      real(dp), intent(in) :: accuracy(lanes)
      !> Net load at the end of the step, sum of the loads of all films, -dV'/dV, by the film law [-]
      real(dp), intent(in) :: carried(lanes)
      real(dp), intent(in) :: largest(lanes)
      real(dp), intent(in) :: rate_of_damping(lanes)
      !> The thinner film there, V and V', by the series [-]
      real(dp), intent(in) :: film(lanes)
      real(dp), intent(in) :: lienard(lanes)
      real(dp), intent(in) :: rise(lanes)
      !> 1 where the step is trusted, set to 0 where it is rejected
      real(dp), intent(inout) :: trust(lanes)
      real(dp) :: defect, square_film, granted
      integer :: l

      !$omp simd private(defect, square_film, granted)
      do l = 1, lanes
         defect = abs(carried(l) - load(l) - rise(l)) &
            - equation_rounding*(largest(l) + force(l) + abs(rate_of_damping(l)*lienard(l)))
         ! 1 + H**2, and w (1 + H**2) times the accuracy.
         square_film = 1.0_dp + film(l)*film(l)
         granted = (most_defect*real(rupture_order + 1, dp))*error_share*film(l)*max(accuracy(l), rounding*square_film)
         trust(l) = trust(l)*merge(1.0_dp, 0.0_dp, defect*square_film <= granted*(free_rate + rate_of_damping(l))) &
            *merge(1.0_dp, 0.0_dp, defect*rate_of_damping(l)*film(l) <= granted*load_error*force(l))
      end do
   end subroutine reject_large_defect

end module taylor_rupture
