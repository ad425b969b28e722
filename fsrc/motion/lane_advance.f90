!> One step of all lanes of a block by Taylor series, and the bookkeeping of a step by any method.
module lane_advance
   use film_series, only: check_ends, check_springs, expand_motion, film_series_t
   use kinds, only: dp
   use lane_block, only: lane_block_t, lost_film
   use lane_force, only: turn_to
   use lane_functions, only: lanes
   use stabilized_series, only: first_weighted, lengthen_steps, weights_of_lanes
   use taylor_step_control, only: cut_steps, evaluate_series, evaluate_slope, film_weight, lane_steps, order
   implicit none(type, external)
   private

   !> A step in which the film changes by more than these factors is rejected.
   real(dp), parameter :: smallest_film_ratio = 1.0e-3_dp, largest_film_ratio = 1.0e3_dp
   !> Damping rate that no Taylor step follows [1/periods].
   real(dp), parameter, public :: largest_series_rate = 1.0e7_dp
   !> Step that is too short to continue [periods].
   real(dp), parameter, public :: shortest_step = 1.0e-14_dp

   public :: take_series_step, advance

contains

   !> Expand all motions of a block, and choose their steps.
   pure subroutine take_series_step(series, block)
      type(film_series_t), intent(in) :: series
      type(lane_block_t), intent(inout) :: block

      ! Forces of steps that are checked at their ends stand there already.
      if (series%springs .or. .not. series%checked_at_end) call turn_to(block%phase, block%oscillation%phase)
      block%remaining = 1.0_dp - block%phase
      call expand_motion(series, block)
      if (series%springs) then
         call take_springs_step(series, block)
      else
         call take_rigid_step(series, block)
      end if
   end subroutine take_series_step

   !> Steps of all lanes, and the states they lead to. Steps in which the film changes by some powers of ten are rejected, and so are
   !> series about a point of extreme damping. Conditions are numbers, 0 or 1, and their products: without branch and integer the
   !> loop runs in full registers.
   pure subroutine take_rigid_step(series, block)
      type(film_series_t), intent(in) :: series
      type(lane_block_t), intent(inout) :: block
      real(dp) :: next_rise(lanes), thinner(lanes)
      integer :: l

      thinner = min(block%film(:, 0), block%backlash - block%film(:, 0))
      call lane_steps(series%last_order, series%share, block%accuracy, block%force, thinner, block%film, block%lienard, &
                      block%damping_rate, block%limit, block%step)
      call cut_steps(block%remaining, block%step)
      call evaluate_series(block%film, block%lienard, block%step, block%next_film, block%next_lienard)
      if (series%checked_at_end) call evaluate_slope(block%lienard, block%step, next_rise)
      !$omp simd
      do l = 1, lanes
         block%accepted(l) = merge(1.0_dp, 0.0_dp, block%next_film(l) > smallest_film_ratio*block%film(l, 0)) &
            *merge(1.0_dp, 0.0_dp, block%next_film(l) < largest_film_ratio*block%film(l, 0)) &
            *merge(1.0_dp, 0.0_dp, block%backlash(l) - block%next_film(l) &
                   > smallest_film_ratio*(block%backlash(l) - block%film(l, 0))) &
            *merge(1.0_dp, 0.0_dp, abs(block%next_lienard(l)) < huge(1.0_dp)) &
            *merge(1.0_dp, 0.0_dp, block%damping_rate(l) < largest_series_rate)
      end do
      call check_ends(series, next_rise, block)
   end subroutine take_rigid_step

   !> The same for elastic teeth. An error of a spring counts like that of its film, and one of the gear's velocity as where nothing
   !> damps it. Where a film never pulls, a load that falls by some powers of ten is rejected as well: it would not stay positive.
   pure subroutine take_springs_step(series, block)
      type(film_series_t), intent(in) :: series
      type(lane_block_t), intent(inout) :: block
      real(dp) :: largest(lanes, 0:order), next_films(lanes, 2), changed(lanes, 2), undamped(lanes), sum
      integer :: flanks, flank, k, l

      flanks = merge(2, 1, series%two_flanks)
      largest(:, 0) = block%films(:, 0, 1)
      if (flanks == 2) largest(:, 0) = min(block%films(:, 0, 1), block%films(:, 0, 2))
      do k = series%last_order - 1, series%last_order
         !$omp simd
         do l = 1, lanes
            largest(l, k) = max(abs(block%films(l, k, 1)), abs(block%compression(l, 1, k)))
         end do
         if (flanks == 2) largest(:, k) = max(largest(:, k), abs(block%films(:, k, 2)), abs(block%compression(:, 2, k)))
      end do
      undamped = 0.0_dp
      call lane_steps(series%last_order, series%share, block%accuracy, block%force, largest(:, 0), largest, block%lienard, &
                      undamped, block%limit, block%step)
      if (.not. series%checked_at_end) call take_longer_steps(series, largest(:, 0), block)
      call cut_steps(block%remaining, block%step)
      call evaluate_series(block%film, block%lienard, block%step, block%next_film, block%next_lienard)
      do flank = 1, flanks
         !$omp simd private(sum, k)
         do l = 1, lanes
            sum = block%compression(l, flank, order)
            do k = order - 1, 0, -1
               sum = sum*block%step(l) + block%compression(l, flank, k)
            end do
            block%next_compression(l, flank) = sum
         end do
      end do
      next_films(:, 1) = block%next_film
      if (flanks == 2) then
         next_films(:, 2) = block%backlash - block%next_film + (block%next_compression(:, 1) + block%next_compression(:, 2))
         ! A lane that rests has no backlash.
         next_films(:, 2) = merge(next_films(:, 2), block%films(:, 0, 2), block%backlash < huge(1.0_dp))
      end if
      block%accepted = 1.0_dp
      do flank = 1, flanks
         changed(:, 1) = next_films(:, flank)/block%films(:, 0, flank)
         changed(:, 2) = 1.0_dp
         if (series%never_pulls) changed(:, 2) = block%next_compression(:, flank)/block%compression(:, flank, 0)
         do k = 1, 2
            !$omp simd
            do l = 1, lanes
               block%accepted(l) = block%accepted(l)*merge(1.0_dp, 0.0_dp, changed(l, k) > smallest_film_ratio) &
                  *merge(1.0_dp, 0.0_dp, changed(l, k) < largest_film_ratio)
            end do
         end do
      end do
      block%accepted = block%accepted*merge(1.0_dp, 0.0_dp, abs(block%next_lienard) < huge(1.0_dp)) &
         *merge(1.0_dp, 0.0_dp, block%damping_rate < largest_series_rate)
      call check_springs(series, next_films, block)
   end subroutine take_springs_step

   !> Lengthen the steps that films bound which come to rest on their springs. The velocity of a film that never pulls goes with the
   !> logarithm of its load, so an error of it must be small beside the compression.
   pure subroutine take_longer_steps(series, thinner, block)
      type(film_series_t), intent(in) :: series
      !> The thinner one of both films [-]
      real(dp), intent(in) :: thinner(lanes)
      type(lane_block_t), intent(inout) :: block
      real(dp), parameter :: small = 1.0e-3_dp
      real(dp) :: granted(lanes), chosen(lanes), weights(lanes, first_weighted:order)
      logical :: any_chosen
      integer :: flanks, flank, k, l

      flanks = merge(2, 1, series%two_flanks)
      granted = block%accuracy*film_weight(thinner)
      if (series%never_pulls) then
         do flank = 1, flanks
            granted = min(granted, small*block%compression(:, flank, 0))
         end do
      end if
      call lengthen_steps(series%share, granted, block%rest_rate, block%limit, block%films(:, :, 1), block%films(:, :, flanks), &
                          block%lienard, block%step, chosen, any_chosen)
      if (.not. any_chosen) return
      weights = weights_of_lanes(chosen)
      do k = first_weighted, order
         !$omp simd
         do l = 1, lanes
            block%lienard(l, k) = weights(l, k)*block%lienard(l, k)
            block%films(l, k, 1) = weights(l, k)*block%films(l, k, 1)
            block%film(l, k) = block%films(l, k, 1)
            block%compression(l, 1, k) = weights(l, k)*block%compression(l, 1, k)
         end do
         if (flanks < 2) cycle
         !$omp simd
         do l = 1, lanes
            block%films(l, k, 2) = weights(l, k)*block%films(l, k, 2)
            block%compression(l, 2, k) = weights(l, k)*block%compression(l, 2, k)
         end do
      end do
   end subroutine take_longer_steps

   !> Advance all lanes whose step is accepted; the others try again with a shorter one.
   pure subroutine advance(most_steps, largest_rate, block, events)
      !> Most steps in a period
      real(dp), intent(in) :: most_steps
      !> Largest damping rate [1/periods]
      real(dp), intent(in) :: largest_rate
      type(lane_block_t), intent(inout) :: block
      !> Lanes that need attention: period ended, or trouble
      integer, intent(out) :: events
      real(dp) :: calm, quiet
      integer :: l

      quiet = 0.0_dp
      !$omp simd private(calm) reduction(+: quiet)
      do l = 1, lanes
         block%film(l, 0) = merge(block%next_film(l), block%film(l, 0), block%accepted(l) > 0.0_dp)
         block%lienard(l, 0) = merge(block%next_lienard(l), block%lienard(l, 0), block%accepted(l) > 0.0_dp)
         block%limit(l) = merge(1.0_dp, 0.25_dp*block%step(l), block%accepted(l) > 0.0_dp)
         block%remaining(l) = merge(block%remaining(l) - block%step(l), 1.0_dp, block%accepted(l) > 0.0_dp)
         block%phase(l) = block%phase(l) + block%accepted(l)*block%step(l)
         block%period_steps(l) = block%period_steps(l) + 1.0_dp
         calm = merge(1.0_dp, 0.0_dp, block%remaining(l) > 0.0_dp) &
            *merge(1.0_dp, 0.0_dp, block%limit(l) > shortest_step) &
            *merge(1.0_dp, 0.0_dp, block%period_steps(l) <= most_steps) &
            *merge(1.0_dp, 0.0_dp, block%film(l, 0) > lost_film) &
            *merge(1.0_dp, 0.0_dp, block%film(l, 0) < block%widest_film(l)) &
            *merge(1.0_dp, 0.0_dp, block%damping_rate(l) < largest_rate)
         quiet = quiet + calm
      end do
      events = lanes - nint(quiet)
   end subroutine advance

end module lane_advance
