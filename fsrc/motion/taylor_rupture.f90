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

   public :: rupture_series, reject_large_defect

contains

   !> Coefficients 1 to `rupture_order`, and of rigid teeth the damping rate; those of elastic teeth about squeeze groups that are
   !> expanded under the loads of their springs.
   pure subroutine rupture_series(law, springs, two_flanks, force, block)
      !> Load, as module load_pieces numbers it
      integer, intent(in) :: law
      logical, intent(in) :: springs
      logical, intent(in) :: two_flanks
      !> Derivatives of the force that oscillates, by module lane_force [-]
      real(dp), intent(in) :: force(lanes, order)
      type(lane_block_t), intent(inout) :: block
      real(dp) :: slope(lanes)

      if (.not. springs) then
         associate (drive => block%expansion(1), coast => block%expansion(2))
            call expand_load(law, block%film(:, 0), block%lienard(:, 0), block%damping, drive)
            slope = drive%inverse_film*drive%root*drive%load_slope
            if (two_flanks) then
               call expand_load(law, block%backlash - block%film(:, 0), -block%lienard(:, 0), block%damping, coast)
               slope = slope + coast%inverse_film*coast%root*coast%load_slope
            end if
            block%damping_rate = -block%strength*block%damping*slope
         end associate
      end if
      if (springs .and. two_flanks) then
         block
            integer, parameter :: flanks = 2
            logical, parameter :: elastic = .true.
            include 'taylor_rupture.inc'
         end block
      else if (springs) then
         block
            integer, parameter :: flanks = 1
            logical, parameter :: elastic = .true.
            include 'taylor_rupture.inc'
         end block
      else if (two_flanks) then
         block
            integer, parameter :: flanks = 2
            logical, parameter :: elastic = .false.
            include 'taylor_rupture.inc'
         end block
      else
         block
            integer, parameter :: flanks = 1
            logical, parameter :: elastic = .false.
            include 'taylor_rupture.inc'
         end block
      end if
   end subroutine rupture_series

   !> Reject steps whose series violates the equation of motion at their end by a defect D beyond rounding: D x/(n + 1) estimates the
   !> local error of V, in the measure of module taylor_step_control (fsrc/THEORY.md, section 5).
   pure subroutine reject_large_defect(error_share, load, carried, largest, rate_of_damping, film, lienard, rise, block)
      !> Share of the accuracy that a step may use up, over its length [1/periods]
      real(dp), intent(in) :: error_share
      !> q + f cos(2 pi x) at the end of the step [-]
      real(dp), intent(in) :: load(lanes)
      !> Net load at the end of the step, sum of the loads of all films, -dV'/dV, by the film law [-]
      real(dp), intent(in) :: carried(lanes)
      real(dp), intent(in) :: largest(lanes)
      real(dp), intent(in) :: rate_of_damping(lanes)
      !> The thinner film there, V and V', by the series [-]
      real(dp), intent(in) :: film(lanes)
      real(dp), intent(in) :: lienard(lanes)
      real(dp), intent(in) :: rise(lanes)
      type(lane_block_t), intent(inout) :: block
      real(dp) :: defect, square_film, granted
      integer :: l

      !$omp simd private(defect, square_film, granted)
      do l = 1, lanes
         defect = abs(carried(l) - load(l) - rise(l)) &
            - equation_rounding*(largest(l) + block%force(l) + abs(rate_of_damping(l)*lienard(l)))
         ! 1 + H**2, and w (1 + H**2) times the accuracy.
         square_film = 1.0_dp + film(l)*film(l)
         granted = (most_defect*real(rupture_order + 1, dp))*error_share*film(l)*max(block%accuracy(l), rounding*square_film)
         block%accepted(l) = block%accepted(l) &
            *merge(1.0_dp, 0.0_dp, defect*square_film <= granted*(free_rate + rate_of_damping(l))) &
            *merge(1.0_dp, 0.0_dp, defect*rate_of_damping(l)*film(l) <= granted*load_error*block%force(l))
      end do
   end subroutine reject_large_defect

end module taylor_rupture
