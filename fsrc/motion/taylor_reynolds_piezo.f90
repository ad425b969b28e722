!> Taylor series of the motion with the Reynolds piezo-viscous film, for a block of lanes, on one flank or between two, of rigid or
!> elastic teeth (fsrc/THEORY.md, section 4).
!>
!> Psi has infinite slope where the film ceases to exist, but not in s = sqrt(1 - B max p*(A)): module reynolds_piezo_expansion
!> gives it in two variables. All sums share the powers of z, series of their own, each the product of two lower ones.
!>
!> The recurrence is written once, in taylor_reynolds_piezo.inc, and compiled for one flank and two, rigid and elastic: numbers that
!> the compiler knows, or the loops over lanes would not run in full registers.
module taylor_reynolds_piezo
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_force, only: factor
   use lane_functions, only: half_block, lanes
   use reynolds_piezo_expansion, only: expand_reynolds_piezo, first_term, highest_peak_power, highest_group_power, &
      highest_sigma_power
   use taylor_rupture, only: rupture_order
   use taylor_step_control, only: inverse, order, sign_of, unfollowable_rate
   implicit none(type, external)
   private

   !> The series, in one array: their coefficients lie at fixed distances from each other, and one address leads to all.
   !> Names as above; group = B, peak = max p*, tail + j: F_j, z + i - 1: z**i; of elastic teeth d, the compression, and root = H r.
   integer, parameter :: h = 1, p = 2, r = 3, group = 4, s = 5, peak = 6, tail = 7, z = tail + highest_sigma_power + 1, &
                         d = z + highest_group_power(0), root = d + 1, series = root

   public :: reynolds_piezo_series

contains

   !> Coefficients 1 to `rupture_order`; those of elastic teeth about films that are expanded under the loads of their springs.
   pure subroutine reynolds_piezo_series(springs, two_flanks, force, block)
      logical, intent(in) :: springs
      logical, intent(in) :: two_flanks
      !> Derivatives of the force that oscillates, by module lane_force [-]
      real(dp), intent(in) :: force(lanes, order)
      type(lane_block_t), intent(inout) :: block
      real(dp) :: slope(lanes), inside(lanes)

      if (springs) then
         if (two_flanks) then
            block
               integer, parameter :: flanks = 2
               logical, parameter :: elastic = .true.

               include 'taylor_reynolds_piezo.inc'
            end block
         else
            block
               integer, parameter :: flanks = 1
               logical, parameter :: elastic = .true.

               include 'taylor_reynolds_piezo.inc'
            end block
         end if
         return
      end if
      associate (drive => block%piezo_expansion(1), coast => block%piezo_expansion(2))
         call expand_reynolds_piezo(block%film(:, 0), block%lienard(:, 0), block%damping, block%pressing, drive)
         slope = drive%inverse_film*drive%root*drive%load_slope
         inside = drive%inside
         if (two_flanks) then
            call expand_reynolds_piezo(block%backlash - block%film(:, 0), -block%lienard(:, 0), block%damping, block%pressing, &
                                       coast)
            slope = slope + coast%inverse_film*coast%root*coast%load_slope
            inside = inside*coast%inside
         end if
         block%damping_rate = merge(-block%strength*block%damping*slope, unfollowable_rate, inside > 0.0_dp)
      end associate
      if (two_flanks) then
         block
            integer, parameter :: flanks = 2
            logical, parameter :: elastic = .false.

            include 'taylor_reynolds_piezo.inc'
         end block
      else
         block
            integer, parameter :: flanks = 1
            logical, parameter :: elastic = .false.

            include 'taylor_reynolds_piezo.inc'
         end block
      end if
   end subroutine reynolds_piezo_series

end module taylor_reynolds_piezo
