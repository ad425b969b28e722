!> Taylor series of the motion with an iso-viscous film whose rupture follows from (18), for a block of lanes: the Reynolds film,
!> and the published one (24) with x_e solved, on one flank or between two, of rigid or elastic teeth (fsrc/THEORY.md, section 4).
!>
!> Phi has no closed form, but module load_expansion gives its Taylor series about any A. For n = 12 the nested pairs together take
!> as many products of coefficients as two products of whole series. Of elastic teeth A is such a series in the load group.
!>
!> The recurrence is written once, in taylor_rupture.inc, and compiled for one flank and two, rigid and elastic.
module taylor_rupture
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_force, only: factor
   use lane_functions, only: lanes
   use load_expansion, only: expand_load, highest_power
   use taylor_step_control, only: free_rate, inverse, load_error, order, rounding, sign_of
   implicit none(type, external)
   private

   !> Order n of this series: its coefficients cost more than those of the published films, so a lower one is best.
   integer, parameter, public :: rupture_order = highest_power + 1

   !> Local error over that of the step control above which a step is rejected, and rounding of the equation of motion.
   real(dp), parameter :: most_defect = 1.0_dp
   real(dp), parameter, public :: equation_rounding = 64.0_dp*epsilon(1.0_dp)

   !> The series, in one array: their coefficients lie at fixed distances from each other, and one address leads to all.
   !> Names as above; square = z**2, nest + i: T_i; of elastic teeth d, the compression, and r is the root of H.
   integer, parameter :: last_pair = (rupture_order - 2)/2
   integer, parameter :: h = 1, d = 2, p = 3, r = 4, z = 5, square = 6, nest = 7, series = nest + last_pair

   public :: rupture_series, evaluate_rupture_series, reject_large_defect

contains

   !> Coefficients 1 to `rupture_order`, and of rigid teeth the damping rate; those of elastic teeth about squeeze groups that are
   !> expanded under the loads of their springs.
   pure subroutine rupture_series(law, elastic, two_flanks, force, block)
      !> Load, as module load_pieces numbers it
      integer, intent(in) :: law
      logical, intent(in) :: elastic
      logical, intent(in) :: two_flanks
      !> Derivatives of the force that oscillates, by module lane_force [-]
      real(dp), intent(in) :: force(lanes, order)
      type(lane_block_t), intent(inout) :: block
      real(dp) :: slope(lanes)

      if (elastic) then
         if (two_flanks) then
            call two_elastic_flanks(force, block)
         else
            call elastic_flank(force, block)
         end if
         return
      end if
      associate (drive => block%expansion(1), coast => block%expansion(2))
         call expand_load(law, block%film(:, 0), block%lienard(:, 0), block%damping, drive)
         slope = drive%inverse_film*drive%root*drive%load_slope
         if (two_flanks) then
            call expand_load(law, block%backlash - block%film(:, 0), -block%lienard(:, 0), block%damping, coast)
            slope = slope + coast%inverse_film*coast%root*coast%load_slope
         end if
         block%damping_rate = -block%strength*block%damping*slope
      end associate
      if (two_flanks) then
         call two_rigid_flanks(force, block)
      else
         call rigid_flank(force, block)
      end if
   end subroutine rupture_series

   !> One rigid flank.
   pure subroutine rigid_flank(force, block)
      !> Derivatives of the force that oscillates [-]
      real(dp), intent(in) :: force(lanes, order)
      type(lane_block_t), intent(inout) :: block
      integer, parameter :: flanks = 1
      logical, parameter :: elastic = .false.

      include 'taylor_rupture.inc'
   end subroutine rigid_flank

   !> Two rigid flanks.
   pure subroutine two_rigid_flanks(force, block)
      !> Derivatives of the force that oscillates [-]
      real(dp), intent(in) :: force(lanes, order)
      type(lane_block_t), intent(inout) :: block
      integer, parameter :: flanks = 2
      logical, parameter :: elastic = .false.

      include 'taylor_rupture.inc'
   end subroutine two_rigid_flanks

   !> One elastic flank.
   pure subroutine elastic_flank(force, block)
      !> Derivatives of the force that oscillates [-]
      real(dp), intent(in) :: force(lanes, order)
      type(lane_block_t), intent(inout) :: block
      integer, parameter :: flanks = 1
      logical, parameter :: elastic = .true.

      include 'taylor_rupture.inc'
   end subroutine elastic_flank

   !> Two elastic flanks.
   pure subroutine two_elastic_flanks(force, block)
      !> Derivatives of the force that oscillates [-]
      real(dp), intent(in) :: force(lanes, order)
      type(lane_block_t), intent(inout) :: block
      integer, parameter :: flanks = 2
      logical, parameter :: elastic = .true.

      include 'taylor_rupture.inc'
   end subroutine two_elastic_flanks

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
   !> The last terms of a series show its error only where the terms before them have begun to fall. There are two cases in which
   !> they have not. A tooth in free flight with A >> 1 has a load that is far below the force, and so are its coefficients: the
   !> last terms are those of the force alone, which fall at once; where V goes through zero, the load is up to a million times
   !> the one at the start. Or the load matters, but its series is close to its radius of convergence, and term after term is as
   !> large as the last. In both cases the series violates the equation of motion at the end of the step. The defect D, by which
   !> the sum of the forces is off there, is that of the first terms left out, so D x/(n + 1) estimates the local error of V; it
   !> must not exceed what the step control grants the last term, in the measure of module taylor_step_control at the end of the
   !> step, less the rounding of the forces.
   pure subroutine reject_large_defect(error_share, load, force, accuracy, carried, largest, rate_of_damping, film, lienard, &
                                       rise, accepted)
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
      !> 1 where the step is accepted, set to 0 where it is rejected
      real(dp), intent(inout) :: accepted(lanes)
      real(dp) :: defect, square_film, granted
      integer :: l

      !$omp simd private(defect, square_film, granted)
      do l = 1, lanes
         defect = abs(carried(l) - load(l) - rise(l)) &
            - equation_rounding*(largest(l) + force(l) + abs(rate_of_damping(l)*lienard(l)))
         ! 1 + H**2, and w (1 + H**2) times the accuracy.
         square_film = 1.0_dp + film(l)*film(l)
         granted = (most_defect*real(rupture_order + 1, dp))*error_share*film(l)*max(accuracy(l), rounding*square_film)
         accepted(l) = accepted(l)*merge(1.0_dp, 0.0_dp, defect*square_film <= granted*(free_rate + rate_of_damping(l))) &
            *merge(1.0_dp, 0.0_dp, defect*rate_of_damping(l)*film(l) <= granted*load_error*force(l))
      end do
   end subroutine reject_large_defect

end module taylor_rupture
