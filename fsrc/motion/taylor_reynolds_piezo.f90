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
   use load_expansion, only: squeeze_expansion_t
   use reynolds_piezo_expansion, only: expand_reynolds_piezo, first_term, highest_peak_power, highest_group_power, &
      highest_sigma_power, highest_time_power, reynolds_piezo_expansion_t
   use squeeze_of_load, only: load_carried, piezo_viscous_squeeze
   use taylor_rupture, only: rupture_order
   use taylor_step_control, only: film_weight, inverse, order, sign_of, unfollowable_rate
   implicit none(type, external)
   private

   !> The series, in one array: their coefficients lie at fixed distances from each other, and one address leads to all.
   !> Names as above; group = B, peak = max p*, tail + j: F_j, z + i - 1: z**i; of elastic teeth d, the compression, and root = H r.
   integer, parameter :: h = 1, p = 2, r = 3, group = 4, s = 5, peak = 6, tail = 7, z = tail + highest_sigma_power + 1, &
                         d = z + highest_group_power(0), root = d + 1, series = root

   public :: reynolds_piezo_series, expand_under_load, film_throughout

contains

   !> Coefficients 1 to `rupture_order`; those of elastic teeth about films that are expanded under the loads of their springs.
   pure subroutine reynolds_piezo_series(springs, two_flanks, force, block)
      logical, intent(in) :: springs
      logical, intent(in) :: two_flanks
      !> Derivatives of the force that oscillates, by module lane_force [-]
      real(dp), intent(in) :: force(lanes, order)
      type(lane_block_t), intent(inout) :: block
      real(dp) :: slope(lanes), inside(lanes)

      if (.not. springs) then
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
      end if
      if (springs .and. two_flanks) then
         block
            integer, parameter :: flanks = 2
            logical, parameter :: elastic = .true.
            include 'taylor_reynolds_piezo.inc'
         end block
      else if (springs) then
         block
            integer, parameter :: flanks = 1
            logical, parameter :: elastic = .true.
            include 'taylor_reynolds_piezo.inc'
         end block
      else if (two_flanks) then
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

   !> Expand the load of a Reynolds piezo-viscous film about the velocity at which it carries that of its spring: Newton's method
   !> from a velocity near by, whose first iteration is enough for most, and where it does not lead there the film law inverted. A
   !> lane whose film and load are what they were is left as it is, or its bits would depend on the others.
   pure subroutine expand_under_load(film, load, near, accuracy, rate, pressing, squeeze, expansion)
      !> H or C, and its load group [-]
      real(dp), intent(in) :: film(lanes)
      real(dp), intent(in) :: load(lanes)
      !> What its velocity is likely to be [-]
      real(dp), intent(in) :: near(lanes)
      !> What the film may be off in a step, over its length [1/periods]
      real(dp), intent(in) :: accuracy(lanes)
      !> c [periods] and b [-]
      real(dp), intent(in) :: rate(lanes)
      real(dp), intent(in) :: pressing(lanes)
      !> The load that it was expanded under last, and whether a film carries that
      type(squeeze_expansion_t), intent(inout) :: squeeze
      !> The film
      type(reynolds_piezo_expansion_t), intent(inout) :: expansion
      !> Largest step of asinh A that an iteration may take, and share of what a step may be off that a velocity is left off by
      real(dp), parameter :: longest = 0.5_dp, left = 0.01_dp
      real(dp), dimension(lanes) :: velocity, of_one, change, tolerance
      logical :: unchanged(lanes)
      integer :: l

      unchanged = abs(load - squeeze%load) <= 0.0_dp .and. abs(film - expansion%film) <= 0.0_dp
      if (all(unchanged)) return
      squeeze%load = load
      of_one = sqrt(max(film, tiny(1.0_dp)))/rate
      velocity = merge(expansion%lienard, near, unchanged)
      call expand_reynolds_piezo(film, velocity, rate, pressing, expansion)
      change = (load - expansion%terms(:, 0))/expansion%load_slope
      do l = 1, lanes
         if (unchanged(l)) cycle
         squeeze%inside(l) = expansion%inside(l)
         if (expansion%inside(l) > 0.0_dp .and. abs(change(l)) < longest*sqrt(1.0_dp + expansion%group(l)**2)) then
            velocity(l) = velocity(l) + change(l)*of_one(l)
         else
            call invert_law(load(l), expansion%pressure_group(l), of_one(l), near(l), velocity(l), squeeze%inside(l))
         end if
      end do
      call expand_reynolds_piezo(film, velocity, rate, pressing, expansion)
      change = (load - expansion%terms(:, 0))/expansion%load_slope*of_one
      tolerance = left*accuracy*film_weight(film)
      do l = 1, lanes
         if (unchanged(l) .or. abs(change(l)) <= tolerance(l)) cycle
         call invert_law(load(l), expansion%pressure_group(l), of_one(l), near(l), velocity(l), squeeze%inside(l))
      end do
      call expand_reynolds_piezo(film, velocity, rate, pressing, expansion)
      squeeze%inside = squeeze%inside*expansion%inside
   end subroutine expand_under_load

   !> The velocity of a Reynolds piezo-viscous film by its law inverted.
   pure subroutine invert_law(load, pressure_group, of_one, near, velocity, inside)
      !> Load group, B, velocity of A = 1, and what the velocity is likely to be [-]
      real(dp), intent(in) :: load
      real(dp), intent(in) :: pressure_group
      real(dp), intent(in) :: of_one
      real(dp), intent(in) :: near
      !> The velocity [-], and 1; 0 where no film carries the load
      real(dp), intent(out) :: velocity
      real(dp), intent(out) :: inside
      real(dp) :: group, by_load, by_pressure
      integer :: outcome

      call piezo_viscous_squeeze(load, pressure_group, near/of_one, group, by_load, by_pressure, outcome)
      velocity = group*of_one
      inside = merge(1.0_dp, 0.0_dp, outcome == load_carried .and. by_load < 0.0_dp)
   end subroutine invert_law

   !> Whether a Reynolds piezo-viscous film exists all through the steps, 1 or 0. Under a given load its squeeze group goes
   !> smoothly on where sigma falls through zero and there is no film any more, and may come back before the step ends.
   pure function film_throughout(sigma_series, step) result(exists)
      !> Series of sigma, and the steps
      real(dp), intent(in) :: sigma_series(lanes, 0:highest_time_power)
      real(dp), intent(in) :: step(lanes)
      real(dp) :: exists(lanes)
      integer, parameter :: places = 16
      real(dp) :: sigma(lanes)
      integer :: place, k

      exists = 1.0_dp
      do place = 1, places
         sigma = sigma_series(:, highest_time_power)
         do k = highest_time_power - 1, 0, -1
            sigma = sigma*(step*(real(place, dp)/real(places, dp))) + sigma_series(:, k)
         end do
         exists = exists*merge(1.0_dp, 0.0_dp, sigma > 0.0_dp)
      end do
   end function film_throughout

end module taylor_reynolds_piezo
