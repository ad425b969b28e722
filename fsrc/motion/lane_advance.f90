!> One step of all lanes of a block by Taylor series, and the bookkeeping of a step by any method.
module lane_advance
   use film_series, only: check_ends, expand_motion, film_series_t
   use kinds, only: dp
   use lane_block, only: lane_block_t, lost_film
   use lane_force, only: turn_to
   use lane_functions, only: lanes
   use taylor_rupture, only: evaluate_rupture_series
   use taylor_step_control, only: evaluate_series, lane_steps
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

   !> Series and steps of all lanes, and the states they lead to. Steps in which the film changes
   !> by some powers of ten are rejected, and so are series about a point of extreme damping. Conditions are numbers, 0 or
   !> 1, and their products: without branch and integer the loop runs in full registers.
   pure subroutine take_series_step(series, block)
      type(film_series_t), intent(in) :: series
      type(lane_block_t), intent(inout) :: block
      real(dp) :: next_rise(lanes), thinner(lanes)
      integer :: l

      if (.not. series%checked_at_end) call turn_to(block%phase, block%oscillation%phase)
      block%remaining = 1.0_dp - block%phase
      call expand_motion(series, block)
      thinner = min(block%film(:, 0), block%backlash - block%film(:, 0))
      call lane_steps(series%last_order, series%share, block%accuracy, block%force, thinner, block%film, block%momentum, &
                      block%damping_rate, block%remaining, block%limit, block%step)
      if (series%checked_at_end) then
         call evaluate_rupture_series(block%film, block%momentum, block%step, block%next_film, block%next_momentum, next_rise)
      else
         call evaluate_series(block%film, block%momentum, block%step, block%next_film, block%next_momentum)
      end if
      !$omp simd
      do l = 1, lanes
         block%trust(l) = merge(1.0_dp, 0.0_dp, block%next_film(l) > smallest_film_ratio*block%film(l, 0)) &
            *merge(1.0_dp, 0.0_dp, block%next_film(l) < largest_film_ratio*block%film(l, 0)) &
            *merge(1.0_dp, 0.0_dp, block%backlash(l) - block%next_film(l) &
                   > smallest_film_ratio*(block%backlash(l) - block%film(l, 0))) &
            *merge(1.0_dp, 0.0_dp, abs(block%next_momentum(l)) < huge(1.0_dp)) &
            *merge(1.0_dp, 0.0_dp, block%damping_rate(l) < largest_series_rate)
      end do
      call check_ends(series, next_rise, block)
   end subroutine take_series_step

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
         block%film(l, 0) = merge(block%next_film(l), block%film(l, 0), block%trust(l) > 0.0_dp)
         block%momentum(l, 0) = merge(block%next_momentum(l), block%momentum(l, 0), block%trust(l) > 0.0_dp)
         block%limit(l) = merge(1.0_dp, 0.25_dp*block%step(l), block%trust(l) > 0.0_dp)
         block%remaining(l) = merge(block%remaining(l) - block%step(l), 1.0_dp, block%trust(l) > 0.0_dp)
         block%phase(l) = block%phase(l) + block%trust(l)*block%step(l)
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
