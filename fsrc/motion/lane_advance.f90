!> One step of all lanes of a block by Taylor series, and the bookkeeping of a step by any method.
module lane_advance
   use film_law, only: kernel_half_pi, kernel_piezo, kernel_reynolds_iso, kernel_reynolds_piezo
   use film_series, only: film_series_t
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_force, only: force_derivatives, force_values, lane_force_t, move_forces, turn_forces
   use lane_functions, only: lanes
   use load_expansion, only: expand_load
   use load_pieces, only: exact_load, published_load
   use reynolds_piezo_expansion, only: expand_reynolds_piezo
   use taylor_iso_viscous, only: iso_viscous_series
   use taylor_piezo_viscous, only: distrust_load_from_nothing, piezo_viscous_series
   use taylor_reynolds_piezo, only: reynolds_piezo_series
   use taylor_rupture, only: distrust_load_unforeseen, evaluate_rupture_series, rupture_series
   use taylor_step_control, only: evaluate_series, lane_steps, order
   implicit none(type, external)
   private

   !> A step in which the film changes by more than these factors is not trusted.
   real(dp), parameter :: smallest_film_ratio = 1.0e-3_dp, largest_film_ratio = 1.0e3_dp
   !> Damping rate that no Taylor step follows [1/periods].
   real(dp), parameter, public :: largest_series_rate = 1.0e7_dp
   !> Scaled film that is none any more, and step too short to go on with [periods].
   real(dp), parameter, public :: lost_film = 1.0e-9_dp, shortest_step = 1.0e-14_dp

   public :: take_series_step, advance

contains

   !> Series and steps of all lanes, and the states they lead to. A film that changes by some powers of ten in
   !> one step is not trusted, nor is a series about a point of extreme damping. Conditions are numbers, 0 or
   !> 1, and their products: without branch and integer the loop runs in full registers.
   pure subroutine take_series_step(series, block)
      !> Series of the film law
      type(film_series_t), intent(in) :: series
      type(lane_block_t), intent(inout) :: block
      real(dp) :: next_rise(lanes)
      integer :: l

      if (.not. series%solves_rupture) call turn_forces(block%phase, block%oscillation)
      block%remaining = 1.0_dp - block%phase
      call find_series(series%kernel, series%last_order, block)
      call lane_steps(series%last_order, series%share, block%accuracy, block%force, block%film, block%momentum, &
                      block%damping_rate, block%remaining, block%limit, block%step)
      if (series%solves_rupture) then
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
      if (series%kernel == kernel_piezo) call distrust_load_from_nothing( &
         block%strength, block%damping, block%force, block%accuracy, block%film, block%momentum, &
         block%next_film, block%next_momentum, block%trust)
      if (series%solves_rupture) call hold_against_forces(series, next_rise, block)
   end subroutine take_series_step

   !> Series of film and momentum about the states of a block.
   pure subroutine find_series(kernel, last_order, block)
      !> Whose series
      integer, intent(in) :: kernel
      !> Order of their last coefficients
      integer, intent(in) :: last_order
      type(lane_block_t), intent(inout) :: block
      real(dp) :: force(lanes, order)

      call force_derivatives(last_order, block%oscillation, force)
      select case (kernel)
      case (kernel_piezo)
         call piezo_viscous_series(block%strength, block%damping, block%load, force, block%film, &
                                   block%momentum, block%damping_rate)
      case (kernel_half_pi)
         call iso_viscous_series(block%strength, block%damping, block%load, force, block%film, &
                                 block%momentum, block%damping_rate)
      case (kernel_reynolds_piezo)
         call reynolds_piezo_series(block%strength, block%damping, block%pressing, block%load, force, block%film, &
                                    block%momentum, block%damping_rate, block%piezo_expansion)
      case default
         call rupture_series(law_of(kernel), block%strength, block%damping, block%load, force, block%film, &
                             block%momentum, block%damping_rate, block%expansion)
      end select
   end subroutine find_series

   !> Number of the load of a film law in module load_pieces.
   elemental integer function law_of(kernel)
      !> Its kernel
      integer, intent(in) :: kernel

      law_of = merge(exact_load, published_load, kernel == kernel_reynolds_iso)
   end function law_of

   !> Hold the ends of the steps of films with rupture against film and force there; where a step is not trusted, its start is
   !> looked at instead, for the next try.
   pure subroutine hold_against_forces(series, rise, block)
      !> Series of the film law
      type(film_series_t), intent(in) :: series
      !> V' at the ends, by the series [-]
      real(dp), intent(in) :: rise(lanes)
      type(lane_block_t), intent(inout) :: block
      real(dp), dimension(lanes) :: phase, film, momentum
      type(lane_force_t) :: oscillation

      phase = block%phase + block%step
      oscillation%amplitude = block%oscillation%amplitude
      call turn_forces(phase, oscillation)
      film = merge(block%next_film, block%film(:, 0), block%trust > 0.0_dp)
      momentum = merge(block%next_momentum, block%momentum(:, 0), block%trust > 0.0_dp)
      if (series%kernel == kernel_reynolds_piezo) then
         associate (there => block%piezo_expansion)
            call expand_reynolds_piezo(film, momentum, block%damping, block%pressing, there)
            block%trust = block%trust*there%inside
            call compare(there%inverse_film, there%root, there%terms(:, 0), there%load_slope, block%trust)
         end associate
      else
         associate (there => block%expansion)
            call expand_load(law_of(series%kernel), film, momentum, block%damping, there)
            call compare(there%inverse_film, there%root, there%terms(:, 0), there%load_slope, block%trust)
         end associate
      end if
      call move_forces(oscillation, block%trust, block%oscillation)

   contains

      !> Forces by the film law and by the series.
      pure subroutine compare(inverse_film, root, load, load_slope, trust)
         !> p, r, Phi and dPhi/dA by the film law [-]
         real(dp), intent(in) :: inverse_film(lanes)
         real(dp), intent(in) :: root(lanes)
         real(dp), intent(in) :: load(lanes)
         real(dp), intent(in) :: load_slope(lanes)
         !> 1 where the step is trusted, set to 0 where they differ
         real(dp), intent(inout) :: trust(lanes)

         call distrust_load_unforeseen(series%share, block%strength, block%damping, block%load + force_values(oscillation), &
                                     block%force, block%accuracy, inverse_film, root, load, load_slope, film, momentum, rise, trust)
      end subroutine compare

   end subroutine hold_against_forces

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
