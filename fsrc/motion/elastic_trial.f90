!> A try of an implicit step of contacts with numbers of their own (module elastic_step): the films where it begins, the loads that
!> Newton's method sets out from, and gear, springs and films that follow from the loads at the nodes.
module elastic_trial
   use collocation_basis, only: can_extrapolate, carry_on
   use film_law, only: film_over_gap, films_over_gaps, width_compression
   use film_state, only: load_t
   use flank_contact, only: carries_positive_loads, flank_contact_t, load_of_contact
   use kinds, only: dp
   use lane_block, only: given_way, lane_block_t
   use lane_state, only: lane_inner_t
   use linear_equations, only: solve_linear
   use radau_nodes, only: node_rows, once_rows, row_of, rows, slope, slope_rows, stages, twice_rows, weigh
   use taylor_step_control, only: sign_of
   implicit none(type, external)
   private

   !> What an iteration of Newton's method changes: values at the nodes, those of the last one twice, which fills registers, of one
   !> or two flanks [-].
   type, public :: iterate_t
      !> Loads W, films H, film velocities H'
      real(dp) :: load(rows, 2) = 0.0_dp, film(rows, 2) = 0.0_dp, velocity(rows, 2) = 0.0_dp
      !> Loads as they count, with digits of their own. Of films that may pull or keep a part of their load they are less those of
      !> the springs at the start: a soft tooth is compressed by millions of its film, which the difference of two compressions
      !> would leave without digits. Of others they are the loads, which may fall to nothing
      real(dp) :: gain(rows, 2) = 0.0_dp
   end type iterate_t

   !> A step under way, as much of it as the iterate and its loads decide [-].
   type, extends(iterate_t), public :: trial_t
      integer :: flanks = 1
      !> Films at the start, and the compressions that loads count with
      real(dp) :: start(2) = 0.0_dp, counted(2) = 0.0_dp
      !> Compression of flanks that bend by their width, at the start too; how the compression follows the film, as a share of the
      !> gear's displacement, and what a load moves its film by, beside what a damped tooth yields
      real(dp) :: width(rows, 2) = 0.0_dp, start_width(2) = 0.0_dp, follows(rows, 2) = 0.0_dp, compliance(rows, 2) = 0.0_dp
      !> Deflections of damped teeth since the start, and the share of those at the start that loads have to hold against; what the
      !> loads at the nodes compress a contact by: node of the compression, node of the load
      real(dp) :: deflection(rows, 2) = 0.0_dp, lag(2) = 0.0_dp, yields(rows, stages) = 0.0_dp
      !> Of these what the tooth takes, I + tau/s d/dc inverted; the most that a load moves a compression by, kappa without damping
      real(dp) :: retards(rows, stages) = 0.0_dp, most_yield = 0.0_dp
      logical :: damped = .false.
      !> A, and of the gear V and Z - Z at the start
      real(dp) :: acceleration(rows) = 0.0_dp, lienard(rows) = 0.0_dp, displacement(rows) = 0.0_dp
   end type trial_t

   public :: start_films, first_loads, follow_loads

contains

   !> Films where the step begins.
   pure subroutine start_films(contact, lane, block, trial)
      type(flank_contact_t), intent(in) :: contact
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      type(trial_t), intent(inout) :: trial
      real(dp) :: scale, load, by_film, by_load
      integer :: flank

      trial%compliance = merge(0.0_dp, block%compliance(lane), block%retardation(lane) > 0.0_dp)
      trial%start(1) = block%film(lane, 0)
      if (trial%flanks == 2) trial%start(2) = block%backlash(lane) - block%film(lane, 0) + &
                                              given_way(block%compression(lane, :, 0), lane, block)
      trial%damped = block%retardation(lane) > 0.0_dp
      trial%most_yield = block%compliance(lane)
      if (trial%damped) call retard(lane, block, trial)
      if (.not. contact%film%bends) return
      scale = block%film_scale(lane)
      do flank = 1, trial%flanks
         load = block%compression(lane, flank, 0)/block%compliance(lane)*block%force_scale(lane)
         if (flank == 2) then
            trial%start(2) = trial%start(2) + trial%start_width(1)
            trial%start(2) = film_over_gap(contact%film, trial%start(2)*scale, load, block%coast_film(lane)*scale)/scale
         end if
         call width_compression(contact%film, trial%start(flank)*scale, load, trial%start_width(flank), by_film, by_load)
         trial%start_width(flank) = trial%start_width(flank)/scale
      end do
   end subroutine start_films

   !> How damped teeth follow their loads through the step: with D' = sum(slope_ij (D_j - D(0)))/s the deflections hold
   !> tau D' = kappa_t W - D at the nodes by a matrix of numbers, whatever tau is.
   pure subroutine retard(lane, block, trial)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      type(trial_t), intent(inout) :: trial
      real(dp) :: matrix(stages, stages), inverse(stages, stages)
      logical :: solved
      integer :: i

      inverse = 0.0_dp
      do i = 1, stages
         inverse(i, i) = 1.0_dp
      end do
      matrix = inverse + block%retardation(lane)/block%step(lane)*slope
      ! The eigenvalues of the slopes have positive real parts: it is solved.
      call solve_linear(matrix, inverse, solved)
      associate (share => block%damped_share(lane))
         trial%retards = inverse(row_of, :)
         trial%yields = share*trial%retards
         do i = 1, rows
            trial%yields(i, row_of(i)) = trial%yields(i, row_of(i)) + (1.0_dp - share)
         end do
         trial%yields = block%compliance(lane)*trial%yields
      end associate
      trial%most_yield = maxval(abs(trial%yields))
   end subroutine retard

   !> First iterate: the polynomials of the step before, or the loads at its end where they would be carried too far.
   pure subroutine first_loads(lane, block, contact, inner, trial)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      type(flank_contact_t), intent(in) :: contact
      type(lane_inner_t), intent(in) :: inner
      type(trial_t), intent(inout) :: trial
      real(dp) :: base
      logical :: from_start
      integer :: flank

      from_start = block%compliance(lane) > 0.0_dp .and. .not. carries_positive_loads(contact)
      base = 0.0_dp
      do flank = 1, trial%flanks
         trial%counted(flank) = merge(0.0_dp, block%compression(lane, flank, 0), from_start)
         if (trial%damped) then
            trial%lag(flank) = block%compression(lane, trial%flanks + flank, 0)
            if (from_start) trial%lag(flank) = trial%lag(flank) - block%damped_share(lane)*block%compression(lane, flank, 0)
         end if
         if (from_start) base = start_load(lane, block, contact, inner, flank)
         if (can_extrapolate(lane, block)) then
            call carry_on(block%load_polynomial(lane, :, flank), block%step(lane)/block%last_step(lane), trial%gain(:, flank))
            if (from_start) trial%gain(:, flank) = trial%gain(:, flank) - sum(block%load_polynomial(lane, :, flank))
            trial%load(:, flank) = base + trial%gain(:, flank)
         else
            trial%load(:, flank) = start_load(lane, block, contact, inner, flank)
            trial%gain(:, flank) = trial%load(:, flank) - base
         end if
         ! Between nodes a polynomial may fall below what a film that never pulls can carry.
         if (.not. carries_positive_loads(contact)) cycle
         if (minval(trial%load(:, flank)) > 0.0_dp) cycle
         where (.not. trial%load(:, flank) > 0.0_dp) trial%load(:, flank) = start_load(lane, block, contact, inner, flank)
         trial%gain(:, flank) = trial%load(:, flank)
      end do
   end subroutine first_loads

   !> Load at the start of the step: that of the spring, or of a rigid film.
   pure real(dp) function start_load(lane, block, contact, inner, flank) result(load)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      type(flank_contact_t), intent(in) :: contact
      type(lane_inner_t), intent(in) :: inner
      integer, intent(in) :: flank
      type(load_t) :: carried
      real(dp) :: film

      if (block%compliance(lane) > 0.0_dp) then
         load = block%compression(lane, flank, 0)/block%compliance(lane)
      else
         film = block%film(lane, 0)
         if (flank == 2) film = block%backlash(lane) - film
         carried = load_of_contact(contact, film*block%film_scale(lane), &
                                   sign_of(flank)*block%lienard(lane, 0)*block%velocity_scale(lane), &
                                   inner%now(inner%count*(flank - 1) + 1:inner%count*flank))
         load = carried%load/block%force_scale(lane)
      end if
   end function start_load

   !> Gear and films that follow from the loads.
   pure subroutine follow_loads(contact, lane, force, block, trial)
      type(flank_contact_t), intent(in) :: contact
      integer, intent(in) :: lane
      !> F at the nodes [-]
      real(dp), intent(in) :: force(rows)
      type(lane_block_t), intent(in) :: block
      type(trial_t), intent(inout) :: trial
      real(dp), dimension(rows, 2) :: gap, yielded
      real(dp), dimension(rows) :: once, twice, rate
      integer :: flank

      associate (s => block%step(lane), kappa => block%compliance(lane))
         trial%acceleration = trial%load(:, 1) - force
         if (trial%flanks == 2) trial%acceleration = trial%acceleration - trial%load(:, 2)
         call weigh(once_rows, trial%acceleration, once)
         call weigh(twice_rows, trial%acceleration, twice)
         trial%lienard = block%lienard(lane, 0) + s*once
         trial%displacement = s*(node_rows*block%lienard(lane, 0) + s*twice)
         do flank = 1, trial%flanks
            yielded(:, flank) = kappa*trial%gain(:, flank) - trial%counted(flank)
            if (trial%damped) call deflect(kappa, block%damped_share(lane), flank, yielded(:, flank), trial)
            gap(:, flank) = trial%start(flank) + (sign_of(flank)*trial%displacement + yielded(:, flank))
         end do
         if (contact%film%bends) then
            call bend(contact, lane, block, gap, yielded, trial)
         else
            trial%film(:, :trial%flanks) = gap(:, :trial%flanks)
         end if
         do flank = 1, trial%flanks
            call weigh(slope_rows, yielded(:, flank), rate)
            trial%velocity(:, flank) = sign_of(flank)*trial%lienard + rate/s
         end do
      end associate
   end subroutine follow_loads

   !> Compressions of a contact whose tooth is damped, from those without damping.
   pure subroutine deflect(compliance, share, flank, yielded, trial)
      !> kappa, and the share of the damped tooth in it [-]
      real(dp), intent(in) :: compliance
      real(dp), intent(in) :: share
      integer, intent(in) :: flank
      !> Since the start [-]
      real(dp), intent(inout) :: yielded(rows)
      type(trial_t), intent(inout) :: trial
      real(dp) :: behind(rows)

      behind = share*compliance*trial%gain(:, flank) - trial%lag(flank)
      call weigh(trial%retards, behind, trial%deflection(:, flank))
      yielded = (1.0_dp - share)*yielded + trial%deflection(:, flank)
   end subroutine deflect

   !> Films of flanks that bend, from those that would be there if their width stayed what it was, and their compressions. They are
   !> looked for from where they were found last.
   pure subroutine bend(contact, lane, block, gap, yielded, trial)
      type(flank_contact_t), intent(in) :: contact
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      !> Films without a change of width, of one or two flanks [-]
      real(dp), intent(in) :: gap(rows, 2)
      !> Compressions since the start, then with those by the width [-]
      real(dp), intent(inout) :: yielded(rows, 2)
      type(trial_t), intent(inout) :: trial
      real(dp), dimension(rows, 2) :: gaps, loads, near, films, by_gap, by_load
      integer :: flank

      associate (scale => block%film_scale(lane), unit => block%force_scale(lane))
         do flank = 1, trial%flanks
            gaps(:, flank) = (gap(:, flank) - trial%start_width(flank))*scale
            loads(:, flank) = trial%load(:, flank)*unit
            near(:, flank) = trial%film(:, flank)*scale
         end do
         call films_over_gaps(contact%film, rows*trial%flanks, gaps, loads, near, films, by_gap, by_load)
         do flank = 1, trial%flanks
            trial%film(:, flank) = films(:, flank)/scale
            trial%width(:, flank) = trial%film(:, flank) - (gap(:, flank) - trial%start_width(flank))
            yielded(:, flank) = yielded(:, flank) + (trial%width(:, flank) - trial%start_width(flank))
            trial%follows(:, flank) = by_gap(:, flank)
            trial%compliance(:, flank) = by_load(:, flank)*(unit/scale)
            if (.not. trial%damped) &
               trial%compliance(:, flank) = block%compliance(lane)*(1.0_dp + by_gap(:, flank)) + trial%compliance(:, flank)
         end do
      end associate
   end subroutine bend

end module elastic_trial
