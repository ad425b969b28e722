!> Newton's method for the equations of collocation (collocation_step), for a block of lanes: states at the
!> nodes, load and slopes there, linear equations, corrections.
module collocation_newton
   use collocation_basis, only: rounding, iteration_share
   use film_law, only: overflow_load
   use film_state, only: load_t
   use flank_contact, only: flank_contact_t, is_costly, load_of_contact, mixed_loads
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_functions, only: half_block, lanes
   use radau_nodes, only: node, once, stages, twice
   use taylor_step_control, only: film_weight, lienard_weight, sign_of
   implicit none(type, external)
   private

   !> Ratio of two corrections below which Newton's method is sure to converge quadratically.
   real(dp), parameter :: fast = 0.03_dp

   !> What an iteration of Newton's method says of the next.
   type, public :: newton_iteration_t
      !> Largest correction of the accelerations, and largest residual before it [-]
      real(dp), dimension(lanes) :: change = huge(1.0_dp), residual = huge(1.0_dp)
   end type newton_iteration_t

   public :: stage_states, scaled_load, residual_and_matrix, solve_lanes, correct, allowed, thinner

contains

   !> Film and velocity at the nodes, in the halves of the block where a lane is busy.
   pure subroutine stage_states(busy, block, k, film, lienard)
      logical, intent(in) :: busy(lanes)
      type(lane_block_t), intent(in) :: block
      real(dp), intent(in) :: k(lanes, stages)
      !> H and V at the nodes [-]
      real(dp), intent(out) :: film(lanes, stages)
      real(dp), intent(out) :: lienard(lanes, stages)
      real(dp) :: first, second
      integer :: half, i, j, l

      do half = 1, lanes, half_block
         if (.not. any(busy(half:half + half_block - 1))) cycle
         do i = 1, stages
            !$omp simd private(first, second, j)
            do l = half, half + half_block - 1
               first = 0.0_dp
               second = 0.0_dp
               do j = 1, stages
                  first = first + once(i, j)*k(l, j)
                  second = second + twice(i, j)*k(l, j)
               end do
               lienard(l, i) = block%lienard(l, 0) + block%step(l)*first
               film(l, i) = block%film(l, 0) + block%step(l)*(node(i)*block%lienard(l, 0) + block%step(l)*second)
            end do
         end do
      end do
   end subroutine stage_states

   !> Net load of films without a state of their own, and its slopes in H and V, in scaled units.
   pure type(load_t) function scaled_load(contact, block, lane, film, lienard) result(load)
      type(flank_contact_t), intent(in) :: contact
      type(lane_block_t), intent(in) :: block
      integer, intent(in) :: lane
      !> H [-]
      real(dp), intent(in) :: film
      !> V = H' [-]
      real(dp), intent(in) :: lienard
      real(dp), parameter :: none(0) = [real(dp) ::]
      type(load_t) :: coast

      load = load_of_contact(contact, film*block%film_scale(lane), lienard*block%velocity_scale(lane), none)
      call scale_load(block, lane, load)
      if (.not. block%backlash(lane) < huge(1.0_dp)) return
      coast = load_of_contact(contact, (block%backlash(lane) - film)*block%film_scale(lane), &
                              -lienard*block%velocity_scale(lane), none)
      call scale_load(block, lane, coast)
      call subtract_coast(coast, load)
   end function scaled_load

   !> Load and slopes from physical units to scaled ones; a load that is none stays as it is.
   pure subroutine scale_load(block, lane, load)
      type(lane_block_t), intent(in) :: block
      integer, intent(in) :: lane
      type(load_t), intent(inout) :: load

      if (abs(load%load) < overflow_load) then
         load%load = load%load/block%force_scale(lane)
         load%by_film = load%by_film*(block%film_scale(lane)/block%force_scale(lane))
         load%by_velocity = load%by_velocity*(block%velocity_scale(lane)/block%force_scale(lane))
      end if
   end subroutine scale_load

   !> Take the load of the coast film off that of the drive film; where there is none of it there is no net load.
   pure subroutine subtract_coast(coast, load)
      !> Of the coast film, with its slopes in its own thickness and velocity [-]
      type(load_t), intent(in) :: coast
      !> Of the drive film, then of both [-]
      type(load_t), intent(inout) :: load

      if (abs(load%load) < overflow_load .and. abs(coast%load) < overflow_load) then
         load%load = load%load - coast%load
         load%by_film = load%by_film + coast%by_film
         load%by_velocity = load%by_velocity + coast%by_velocity
      else
         load%load = 2.0_dp*overflow_load
      end if
   end subroutine subtract_coast

   !> Net loads at the nodes of all busy lanes, up to the first node where there is no film.
   pure subroutine loads_of_stages(contacts, film, lienard, block, busy, load, by_film, by_lienard)
      type(flank_contact_t), intent(in) :: contacts(lanes)
      real(dp), intent(in) :: film(lanes, stages)
      real(dp), intent(in) :: lienard(lanes, stages)
      type(lane_block_t), intent(in) :: block
      logical, intent(in) :: busy(lanes)
      !> Loads [-] and their slopes in H and V
      real(dp), intent(out) :: load(lanes, stages)
      real(dp), intent(out) :: by_film(lanes, stages)
      real(dp), intent(out) :: by_lienard(lanes, stages)
      real(dp), dimension(lanes*stages) :: thickness, velocity
      type(load_t) :: loads(lanes*stages), net
      integer :: lane_of(lanes*stages), stage_of(lanes*stages)
      integer :: flank, l, i, n

      load = 0.0_dp
      by_film = 0.0_dp
      by_lienard = 0.0_dp
      do flank = 1, 2
         n = 0
         do l = 1, lanes
            if (.not. busy(l) .or. (flank == 2 .and. .not. block%backlash(l) < huge(1.0_dp))) cycle
            do i = 1, stages
               if (.not. thinner(film(l, i), l, block) > 0.0_dp) exit
               n = n + 1
               lane_of(n) = l
               stage_of(n) = i
               thickness(n) = merge(film(l, i), block%backlash(l) - film(l, i), flank == 1)*block%film_scale(l)
               velocity(n) = sign_of(flank)*lienard(l, i)*block%velocity_scale(l)
            end do
         end do
         if (n == 0) return
         call mixed_loads(contacts, lane_of(:n), thickness(:n), velocity(:n), loads(:n))
         do i = 1, n
            associate (l => lane_of(i), stage => stage_of(i))
               call scale_load(block, l, loads(i))
               net = loads(i)
               if (flank == 2) then
                  net = load_t(load(l, stage), by_film(l, stage), by_lienard(l, stage))
                  call subtract_coast(loads(i), net)
               end if
               load(l, stage) = net%load
               by_film(l, stage) = net%by_film
               by_lienard(l, stage) = net%by_velocity
            end associate
         end do
      end do
   end subroutine loads_of_stages

   !> The thinner one of the films of both flanks [-].
   pure real(dp) function thinner(film, lane, block)
      !> H [-]
      real(dp), intent(in) :: film
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block

      thinner = min(film, block%backlash(lane) - film)
   end function thinner

   !> Newton's equations of all busy lanes; a lane whose film law has no value is given up, and gets equations
   !> that change nothing, as do the lanes that are done beside busy ones.
   pure subroutine residual_and_matrix(contacts, force, k, film, lienard, block, busy, residual, matrix)
      type(flank_contact_t), intent(in) :: contacts(lanes)
      real(dp), intent(in) :: force(lanes, stages)
      real(dp), intent(in) :: k(lanes, stages)
      real(dp), intent(in) :: film(lanes, stages)
      real(dp), intent(in) :: lienard(lanes, stages)
      type(lane_block_t), intent(inout) :: block
      logical, intent(inout) :: busy(lanes)
      !> Right-hand side [-]
      real(dp), intent(out) :: residual(lanes, stages)
      !> Matrix [-]
      real(dp), intent(out) :: matrix(lanes, stages, stages)
      real(dp), dimension(lanes, stages) :: load, by_film, by_lienard
      integer :: half, l, i, j

      residual = 0.0_dp
      call loads_of_stages(contacts, film, lienard, block, busy, load, by_film, by_lienard)
      do l = 1, lanes
         do i = 1, stages
            if (.not. busy(l)) exit
            if (thinner(film(l, i), l, block) > 0.0_dp) block%no_load(l) = .not. abs(load(l, i)) < overflow_load
            busy(l) = thinner(film(l, i), l, block) > 0.0_dp .and. .not. block%no_load(l)
            if (busy(l)) residual(l, i) = load(l, i) - force(l, i) - k(l, i)
         end do
         if (busy(l)) then
            block%damping_rate(l) = max(0.0_dp, -maxval(by_lienard(l, :)))
         else
            residual(l, :) = 0.0_dp
            by_film(l, :) = 0.0_dp
            by_lienard(l, :) = 0.0_dp
         end if
      end do
      do half = 1, lanes, half_block
         if (.not. any(busy(half:half + half_block - 1))) cycle
         do j = 1, stages
            do i = 1, stages
               !$omp simd
               do l = half, half + half_block - 1
                  matrix(l, i, j) = merge(1.0_dp, 0.0_dp, i == j) &
                     - block%step(l)*(block%step(l)*by_film(l, i)*twice(i, j) + by_lienard(l, i)*once(i, j))
               end do
            end do
         end do
      end do
   end subroutine residual_and_matrix

   !> Solve the linear equations of the halves of the block where a lane is busy; the solution replaces the right-hand side.
   !> A motion that is solved alone pays for one half.
   pure subroutine solve_lanes(busy, matrix, right)
      logical, intent(in) :: busy(lanes)
      real(dp), intent(inout) :: matrix(lanes, stages, stages)
      real(dp), intent(inout) :: right(lanes, stages)
      integer :: half

      do half = 1, lanes, half_block
         if (any(busy(half:half + half_block - 1))) call solve_half(half, matrix, right)
      end do
   end subroutine solve_lanes

   !> Solve the linear equations of half a block.
   pure subroutine solve_half(half, matrix, right)
      !> Its first lane
      integer, intent(in) :: half
      real(dp), intent(inout) :: matrix(lanes, stages, stages)
      real(dp), intent(inout) :: right(lanes, stages)
      real(dp) :: factor(half_block)
      integer :: last, i, j, n, l

      last = half + half_block - 1
      do n = 1, stages
         do l = half, last
            matrix(l, n, n) = 1.0_dp/matrix(l, n, n)
         end do
         do i = n + 1, stages
            factor = matrix(half:last, i, n)*matrix(half:last, n, n)
            do j = n + 1, stages
               !$omp simd
               do l = 0, half_block - 1
                  matrix(half + l, i, j) = matrix(half + l, i, j) - factor(1 + l)*matrix(half + l, n, j)
               end do
            end do
            right(half:last, i) = right(half:last, i) - factor*right(half:last, n)
         end do
      end do
      do n = stages, 1, -1
         do j = n + 1, stages
            right(half:last, n) = right(half:last, n) - matrix(half:last, n, j)*right(half:last, j)
         end do
         right(half:last, n) = right(half:last, n)*matrix(half:last, n, n)
      end do
   end subroutine solve_half

   !> Apply Newton's correction; lanes whose correction is small enough are done, those that diverge given up.
   pure subroutine correct(contacts, busy, iteration, residual, correction, last, block, k)
      type(flank_contact_t), intent(in) :: contacts(lanes)
      logical, intent(inout) :: busy(lanes)
      !> Number of this iteration
      integer, intent(in) :: iteration
      !> Largest residual before the correction [-]
      real(dp), intent(in) :: residual(lanes)
      !> Of the accelerations [-]
      real(dp), intent(in) :: correction(lanes, stages)
      !> The iteration before, then this one
      type(newton_iteration_t), intent(inout) :: last
      type(lane_block_t), intent(inout) :: block
      real(dp), intent(inout) :: k(lanes, stages)
      real(dp) :: ratio, change, film_change
      integer :: l

      do l = 1, lanes
         if (.not. busy(l)) then
            if (block%accepted(l) > 0.0_dp .and. block%no_load(l)) block%accepted(l) = 0.0_dp
            cycle
         end if
         k(l, :) = k(l, :) + correction(l, :)
         change = maxval(abs(correction(l, :)))
         film_change = change*block%step(l)/allowed(block%film(l, 0), l, block) &
            *min(block%step(l), lienard_weight(thinner(block%film(l, 0), l, block), block%damping_rate(l), block%force(l)))
         ! From the second iteration on: the next correction will be smaller by the same factor at least, and where
         ! corrections fall fast by its square, if the slopes of the film law are the total ones. But not where a
         ! correction went too far, to where the film is stiff: the ones that lead back are small, and many.
         ratio = merge(1.0_dp, min(1.0_dp, max(change/last%change(l), residual(l)/last%residual(l))), iteration == 1)
         if (ratio < fast .and. is_costly(contacts(l))) ratio = ratio*ratio
         busy(l) = film_change*ratio > iteration_share
         if (busy(l) .and. iteration > 3 .and. change > 2.0_dp*last%change(l)) then
            busy(l) = .false.
            block%accepted(l) = 0.0_dp
         end if
         last%change(l) = change
         last%residual(l) = residual(l)
      end do
   end subroutine correct

   !> Error of the film that the accuracy allows [-].
   pure real(dp) function allowed(film, lane, block)
      !> H [-]
      real(dp), intent(in) :: film
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block

      allowed = max(block%accuracy(lane)*film_weight(thinner(film, lane, block)), rounding*film)
   end function allowed

end module collocation_newton
