!> One step of all lanes of a block by Taylor series, and the bookkeeping of a step by any method.
module lane_advance
   use film_law, only: kernel_half_pi, kernel_piezo, kernel_reynolds_iso, kernel_reynolds_piezo, kernel_solved_fast
   use kinds, only: dp
   use lane_functions, only: lane_cosine_sine, lanes
   use lane_scenes, only: lane_block_t
   use load_expansion, only: expand_load
   use load_pieces, only: exact_load, published_load
   use reynolds_piezo_expansion, only: expand_reynolds_piezo
   use taylor_iso_viscous, only: iso_viscous_series
   use taylor_piezo_viscous, only: distrust_load_from_nothing, piezo_viscous_series
   use taylor_reynolds_piezo, only: reynolds_piezo_series
   use taylor_rupture, only: distrust_load_unforeseen, evaluate_rupture_series, rupture_series
   use taylor_step_control, only: evaluate_series, lane_steps
   implicit none(type, external)
   private

   !> A step in which the film changes by more than these factors is not trusted.
   real(dp), parameter :: smallest_film_ratio = 1.0e-3_dp, largest_film_ratio = 1.0e3_dp
   !> Damping rate that no Taylor step follows [1/periods].
   real(dp), parameter, public :: largest_series_rate = 1.0e7_dp
   !> Scaled film that is none any more, and step too short to go on with [periods].
   real(dp), parameter, public :: lost_film = 1.0e-9_dp, shortest_step = 1.0e-14_dp

   public :: solves_rupture, take_series_step, advance

contains

   !> Whether the rupture of a film law follows from (18): its series is that of module taylor_rupture or taylor_reynolds_piezo.
   elemental logical function solves_rupture(kernel)
      !> Its kernel
      integer, intent(in) :: kernel

      solves_rupture = kernel == kernel_reynolds_iso .or. kernel == kernel_solved_fast .or. kernel == kernel_reynolds_piezo
   end function solves_rupture

   !> Series and steps of all lanes, and the states they lead to. A film that changes by some powers of ten in
   !> one step is not trusted, nor is a series about a point of extreme damping. Conditions are numbers, 0 or
   !> 1, and their products: without branch and integer the loop runs in full registers.
   pure subroutine take_series_step(kernel, last_order, share, block)
      !> Whose series
      integer, intent(in) :: kernel
      !> Its order, and the share of the accuracy that a step may use up, over its length [1/periods]
      integer, intent(in) :: last_order
      real(dp), intent(in) :: share
      type(lane_block_t), intent(inout) :: block
      real(dp), dimension(lanes) :: cosine, sine, end_phase, end_cosine, end_sine, end_film, end_momentum, next_rise
      logical :: rupture
      integer :: law, l

      rupture = solves_rupture(kernel)
      if (.not. rupture) call lane_cosine_sine(block%phase, block%cosine, block%sine)
      !$omp simd
      do l = 1, lanes
         cosine(l) = block%amplitude(l)*block%cosine(l)
         sine(l) = block%amplitude(l)*block%sine(l)
         block%remaining(l) = 1.0_dp - block%phase(l)
      end do
      select case (kernel)
      case (kernel_piezo)
         call piezo_viscous_series(block%strength, block%damping, block%load, cosine, sine, block%film, &
                                   block%momentum, block%damping_rate)
      case (kernel_half_pi)
         call iso_viscous_series(block%strength, block%damping, block%load, cosine, sine, block%film, &
                                 block%momentum, block%damping_rate)
      case (kernel_reynolds_piezo)
         call reynolds_piezo_series(block%strength, block%damping, block%pressing, block%load, cosine, sine, block%film, &
                                    block%momentum, block%damping_rate, block%piezo_expansion)
      case default
         law = merge(exact_load, published_load, kernel == kernel_reynolds_iso)
         call rupture_series(law, block%strength, block%damping, block%load, cosine, sine, block%film, &
                             block%momentum, block%damping_rate, block%expansion)
      end select
      call lane_steps(last_order, share, block%accuracy, block%force, block%film, block%momentum, block%damping_rate, &
                      block%remaining, block%limit, block%step)
      if (rupture) then
         call evaluate_rupture_series(block%film, block%momentum, block%step, block%next_film, block%next_momentum, next_rise)
      else
         call evaluate_series(block%film, block%momentum, block%step, block%next_film, block%next_momentum)
      end if
      !$omp simd
      do l = 1, lanes
         block%trust(l) = merge(1.0_dp, 0.0_dp, block%next_film(l) > smallest_film_ratio*block%film(l, 0)) &
            *merge(1.0_dp, 0.0_dp, block%next_film(l) < largest_film_ratio*block%film(l, 0)) &
            *merge(1.0_dp, 0.0_dp, abs(block%next_momentum(l)) < huge(1.0_dp)) &
            *merge(1.0_dp, 0.0_dp, block%damping_rate(l) < largest_series_rate)
      end do
      if (kernel == kernel_piezo) call distrust_load_from_nothing( &
         block%strength, block%damping, block%force, block%accuracy, block%film, block%momentum, &
         block%next_film, block%next_momentum, block%trust)
      if (.not. rupture) return
      !$omp simd
      do l = 1, lanes
         end_phase(l) = block%phase(l) + block%step(l)
      end do
      call lane_cosine_sine(end_phase, end_cosine, end_sine)
      !$omp simd
      do l = 1, lanes
         end_film(l) = merge(block%next_film(l), block%film(l, 0), block%trust(l) > 0.0_dp)
         end_momentum(l) = merge(block%next_momentum(l), block%momentum(l, 0), block%trust(l) > 0.0_dp)
      end do
      if (kernel == kernel_reynolds_piezo) then
         call expand_reynolds_piezo(end_film, end_momentum, block%damping, block%pressing, block%piezo_expansion)
         associate (end => block%piezo_expansion)
            block%trust = block%trust*end%inside
            call distrust_load_unforeseen(share, block%strength, block%damping, block%load, block%amplitude, end_cosine, &
                                          block%force, block%accuracy, end%pressure, end%root, end%terms(:, 0), end%load_slope, &
                                          end_film, end_momentum, next_rise, block%trust)
         end associate
      else
         call expand_load(law, end_film, end_momentum, block%damping, block%expansion)
         associate (end => block%expansion)
            call distrust_load_unforeseen(share, block%strength, block%damping, block%load, block%amplitude, end_cosine, &
                                          block%force, block%accuracy, end%pressure, end%root, end%terms(:, 0), end%load_slope, &
                                          end_film, end_momentum, next_rise, block%trust)
         end associate
      end if
      !$omp simd
      do l = 1, lanes
         block%cosine(l) = merge(end_cosine(l), block%cosine(l), block%trust(l) > 0.0_dp)
         block%sine(l) = merge(end_sine(l), block%sine(l), block%trust(l) > 0.0_dp)
      end do
   end subroutine take_series_step

   !> Advance all lanes whose step is to be trusted; the others try again with a shorter one.
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
            *merge(1.0_dp, 0.0_dp, block%damping_rate(l) < largest_rate)
         quiet = quiet + calm
      end do
      events = lanes - nint(quiet)
   end subroutine advance

end module lane_advance
