!> Implicit steps by collocation for contacts with numbers of their own, lane by lane: elastic teeth, films with a state, of any
!> law and stiffness, one flank or two.
!>
!> A spring stands between the gear and each film. Within a step of length s the loads W_1 and W_2 are polynomials in c = 0..1
!> through their values at the seven nodes of Radau. They move the gear, the springs follow them, and the films are what gear and
!> springs leave,
!>
!>     A_i = W_1i - W_2i - F(x + c_i s) ,     V_i = V + s sum(once_ij A_j) ,     Z_i - Z = c_i s V + s**2 sum(twice_ij A_j) ,
!>     H_1i = H_1 + (Z_i - Z) + kappa W_1i - D_1 ,     H_1i' = V_i + sum(slope_ij (kappa W_1j - D_1))/s ,
!>
!> for the coast film with the signs of Z and V turned (module elastic_trial). The film law at each node is solved for the loads by
!> Newton's method with its slopes (module elastic_equations): as H_i' = w(H_i, W_i) where its load tells its velocity, else as
!> W(H_i, H_i') = W_i. Loads that do not fall to nothing count from those of the springs at the start, so that kappa W_i - D_1 keeps
!> its digits. Nothing here grows with the stiffness: at kappa = 0 these are the equations of module collocation_step. A state of a
!> film is taken out of these equations contact by contact (module inner_step), and brought after once the loads are corrected.
!>
!> The error is that of rigid teeth, of the polynomial of the acceleration (module collocation_basis); a load that is off moves its
!> film by kappa as well, and so counts the first coefficient of its polynomial that is left out.
module elastic_step
   use collocation_basis, only: can_extrapolate, carry_on, choose_steps, error_of_acceleration, forces_of_stages, growth_of, &
      highest_terms, last_share, pass_share, rounding, series_of_motion
   use elastic_equations, only: imbalances, newton_matrix, slopes_t
   use elastic_tangents, only: carry_tangents, lane_tangents_t
   use elastic_trial, only: follow_loads, sign_of, trial_t
   use film_state, only: load_t
   use flank_contact, only: carries_positive_loads, film_over_gap, flank_contact_t, keeps_load, kept_load, load_of_contact, &
      width_compression
   use inner_equations, only: error_of_states, first_states, follow_films, inner_imbalances, inner_matrix, series_of_states, &
      trial_inner_t
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_functions, only: lanes
   use lane_inner, only: lane_inner_t
   use radau_nodes, only: meet_start, power, power_rows, powers_of_place, rows, stages, weigh
   use step_elimination, only: factorise, factors_t, most_columns, most_rows, substitute
   use taylor_step_control, only: film_weight, free_rate
   implicit none(type, external)
   private

   !> Newton's iterations before the step is given up
   integer, parameter :: most_passes = 12
   !> The second pass takes the slopes of the first, and so do the next ones while corrections fall to less than this in a pass.
   real(dp), parameter :: fast_fall = 1.0e-2_dp
   !> Corrections that fall by less than this in a pass, after some, lead nowhere
   real(dp), parameter :: slowest_fall = 0.9_dp

   !> Step over the one before, at most, which leaves its loads to be carried on: a longer one would take twice the iterations. Its
   !> share of what the error allows: a rejected step costs as much as an accepted one.
   real(dp), parameter :: most_growth = 1.99_dp, step_share = 0.7_dp

   !> A correction leaves at least this share of every film, and of the load of one that never pulls
   real(dp), parameter :: least_ratio = 0.1_dp

   !> A correction that raises the load of a film that never pulls by more than this share of it is not the last one: the velocity
   !> of the film goes with the logarithm or a negative power of its load, so that Newton's method hardly moves a load that is far
   !> too small.
   real(dp), parameter :: last_rise = 0.5_dp

   public :: take_elastic_step, advance_contacts

contains

   !> Try one step in every lane that has a scene.
   pure subroutine take_elastic_step(contacts, occupied, block, inner, tangents)
      !> Contacts of the lanes
      type(flank_contact_t), intent(in) :: contacts(lanes)
      !> Lanes with a scene
      logical, intent(in) :: occupied(lanes)
      !> The block; leaves the state that the step leads to, whether it is to be trusted, and series for the samples
      type(lane_block_t), intent(inout) :: block
      !> and the same of the states of the films
      type(lane_inner_t), intent(inout) :: inner(lanes)
      !> Displacements that go along
      type(lane_tangents_t), intent(inout) :: tangents(lanes)
      real(dp) :: force(lanes, stages), lane_force(rows)
      type(trial_t) :: trial
      type(trial_inner_t) :: states
      integer :: l

      call choose_steps(block)
      call forces_of_stages(block, force)
      block%next_film = block%film(:, 0)
      block%next_lienard = block%lienard(:, 0)
      block%trust = 0.0_dp
      do l = 1, lanes
         if (.not. occupied(l)) cycle
         trial%flanks = merge(2, 1, block%backlash(l) < huge(1.0_dp))
         call start_films(contacts(l), l, block, trial)
         if (inner(l)%count > 0) call first_states(l, block, trial%flanks, inner(l), states)
         call first_loads(l, block, contacts(l), inner(l), trial)
         lane_force(:stages) = force(l, :)
         lane_force(rows) = force(l, stages)
         call solve(contacts(l), l, lane_force, block, inner(l), trial, states)
         call judge(contacts(l)%film%bends, l, trial, block, inner(l), states)
         if (block%trust(l) > 0.0_dp .and. allocated(tangents(l)%now)) &
            call carry_tangents(contacts(l), l, trial, block, tangents(l))
      end do
   end subroutine take_elastic_step

   !> Advance the springs and the states of films of all lanes whose step is accepted.
   pure subroutine advance_contacts(block, inner)
      type(lane_block_t), intent(inout) :: block
      type(lane_inner_t), intent(inout) :: inner(lanes)
      integer :: l

      do l = 1, lanes
         if (block%trust(l) > 0.0_dp) block%compression(l, :, 0) = block%next_compression(l, :)
      end do
      do l = 1, lanes
         if (inner(l)%count > 0 .and. block%trust(l) > 0.0_dp) inner(l)%now(:) = inner(l)%next
      end do
   end subroutine advance_contacts

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

   !> Films where the step begins.
   pure subroutine start_films(contact, lane, block, trial)
      type(flank_contact_t), intent(in) :: contact
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      type(trial_t), intent(inout) :: trial
      real(dp) :: scale, load, by_film, by_load
      integer :: flank

      trial%compliance = block%compliance(lane)
      trial%start(1) = block%film(lane, 0)
      if (trial%flanks == 2) trial%start(2) = block%backlash(lane) - block%film(lane, 0) + sum(block%compression(lane, :, 0))
      if (.not. contact%film%bends) return
      scale = block%film_scale(lane)
      do flank = 1, trial%flanks
         load = block%compression(lane, flank, 0)/block%compliance(lane)*block%force_scale(lane)
         if (flank == 2) then
            trial%start(2) = trial%start(2) + trial%start_width(1)
            trial%start(2) = film_over_gap(contact%film, trial%start(2)*scale, load, trial%start(2)*scale)/scale
         end if
         call width_compression(contact%film, trial%start(flank)*scale, load, trial%start_width(flank), by_film, by_load)
         trial%start_width(flank) = trial%start_width(flank)/scale
      end do
   end subroutine start_films

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

   !> Newton's method for the loads.
   pure subroutine solve(contact, lane, force, block, inner, trial, inner_trial)
      type(flank_contact_t), intent(in) :: contact
      integer, intent(in) :: lane
      !> F at the nodes [-]
      real(dp), intent(in) :: force(rows)
      type(lane_block_t), intent(inout) :: block
      type(lane_inner_t), intent(in) :: inner
      type(trial_t), intent(inout) :: trial
      type(trial_inner_t), intent(inout) :: inner_trial
      type(trial_t) :: before
      type(slopes_t) :: slopes
      type(factors_t) :: factors
      real(dp) :: matrix(most_rows, most_columns), right(most_rows), solution(most_columns), correction(rows, 2)
      real(dp) :: change, last_change, ratio, reach, share, state_change
      integer :: pass, flank, i
      logical :: found, stalled, rising, anew, of_velocities(most_rows)

      of_velocities = .false.
      last_change = huge(1.0_dp)
      ! What an error of one in the loads moves the films by
      reach = max(block%step(lane)*min(block%step(lane), 1.0_dp/free_rate), block%compliance(lane))
      trial%film(:, 1) = trial%start(1)
      trial%film(:, 2) = trial%start(2)
      call follow_loads(contact, lane, force, block, trial)
      anew = .true.
      do pass = 1, most_passes
         if (inner%count > 0) then
            call inner_imbalances(contact, lane, block, trial, inner_trial, right, found)
            anew = .true.
         else
            call imbalances(contact, lane, block, trial, right, slopes, found)
            anew = anew .or. any(slopes%of_velocities .neqv. of_velocities)
            of_velocities = slopes%of_velocities
         end if
         if (.not. found) return
         if (anew) then
            if (inner%count > 0) then
               call inner_matrix(lane, block, trial%flanks, inner_trial%responses, matrix)
            else
               call newton_matrix(contact%film%bends, lane, block, trial, slopes, matrix)
            end if
            call factorise(stages*trial%flanks, rows*trial%flanks, matrix, factors)
         end if
         call substitute(stages*trial%flanks, factors, right, solution)
         rising = .false.
         change = 0.0_dp
         do flank = 1, trial%flanks
            correction(:stages, flank) = solution(stages*(flank - 1) + 1:stages*flank)
            correction(rows, flank) = correction(stages, flank)
            if (carries_positive_loads(contact)) then
               rising = rising .or. any(correction(:, flank) > last_rise*trial%load(:, flank))
               correction(:, flank) = max(correction(:, flank), (least_ratio - 1.0_dp)*trial%load(:, flank))
            end if
            if (.not. all(abs(correction(:, flank)) < huge(1.0_dp))) return
            change = max(change, maxval(abs(correction(:, flank))))
         end do
         before = trial
         trial%load(:, :trial%flanks) = before%load(:, :trial%flanks) + correction(:, :trial%flanks)
         trial%gain(:, :trial%flanks) = before%gain(:, :trial%flanks) + correction(:, :trial%flanks)
         call follow_loads(contact, lane, force, block, trial)
         share = 1.0_dp
         do flank = 1, trial%flanks
            if (minval(trial%film(:, flank) - least_ratio*before%film(:, flank)) >= 0.0_dp) cycle
            do i = 1, stages
               if (before%film(i, flank) > 0.0_dp .and. trial%film(i, flank) < least_ratio*before%film(i, flank)) &
                  share = min(share, (1.0_dp - least_ratio)*before%film(i, flank)/(before%film(i, flank) - trial%film(i, flank)))
            end do
         end do
         if (keeps_load(contact)) call stay_above(contact, lane, block, before, trial, of_velocities, share, rising)
         if (share < 1.0_dp) then
            trial = before
            trial%load(:, :trial%flanks) = before%load(:, :trial%flanks) + share*correction(:, :trial%flanks)
            trial%gain(:, :trial%flanks) = before%gain(:, :trial%flanks) + share*correction(:, :trial%flanks)
            call follow_loads(contact, lane, force, block, trial)
         end if
         state_change = 0.0_dp
         if (inner%count > 0) call follow_films(lane, block, share, before, trial, inner, inner_trial%films, state_change)
         if (share < 1.0_dp .or. rising) then
            last_change = huge(1.0_dp)
            anew = .true.
            cycle
         end if
         ratio = 1.0_dp
         if (last_change < huge(1.0_dp)) ratio = min(1.0_dp, change/last_change)
         anew = last_change < huge(1.0_dp) .and. ratio > fast_fall
         ! Corrections that fall no more are rounding, which a short step magnifies: within the accuracy they are accepted.
         stalled = pass > 4 .and. change > slowest_fall*last_change
         if (max(change*reach*ratio, state_change) <= merge(1.0_dp, pass_share, stalled)*allowed_here(lane, block, trial)) then
            if (minval(trial%film(:, :trial%flanks)) > 0.0_dp) block%trust(lane) = 1.0_dp
            return
         end if
         if (stalled) return
         last_change = change
      end do
   end subroutine solve

   !> Let loads stay above those that their films keep however fast they separate, at nodes whose equations are those of velocities:
   !> there the velocity goes with a negative power of what is above, as with the load of a film that never pulls.
   pure subroutine stay_above(contact, lane, block, before, trial, of_velocities, share, rising)
      type(flank_contact_t), intent(in) :: contact
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      !> Before and after the correction
      type(trial_t), intent(in) :: before
      type(trial_t), intent(in) :: trial
      !> Of each node of one flank after the other, whether its equation is that of velocities
      logical, intent(in) :: of_velocities(most_rows)
      !> Of the correction, to be applied
      real(dp), intent(inout) :: share
      !> Whether a correction raises what is above too much to be the last one
      logical, intent(inout) :: rising
      real(dp) :: above, next
      integer :: flank, i

      do flank = 1, trial%flanks
         do i = 1, stages
            if (.not. of_velocities(rows*(flank - 1) + i)) cycle
            if (.not. min(before%film(i, flank), trial%film(i, flank)) > 0.0_dp) cycle
            above = before%load(i, flank) - kept(before%film(i, flank))
            next = trial%load(i, flank) - kept(trial%film(i, flank))
            if (next < least_ratio*above) share = min(share, (1.0_dp - least_ratio)*above/(above - next))
            rising = rising .or. next > (1.0_dp + last_rise)*above + rounding*trial%load(i, flank)
         end do
      end do

   contains

      !> [-]
      pure real(dp) function kept(film)
         !> H [-]
         real(dp), intent(in) :: film

         kept = kept_load(contact%film, film*block%film_scale(lane))/block%force_scale(lane)
      end function kept

   end subroutine stay_above

   !> Error that the accuracy allows to the films of a step, where the thinner one of both is thickest or thinnest [-].
   pure real(dp) function allowed_here(lane, block, trial)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      type(trial_t), intent(in) :: trial
      real(dp) :: thinner(rows)

      thinner = trial%film(:, 1)
      if (trial%flanks == 2) thinner = min(thinner, trial%film(:, 2))
      allowed_here = max(block%accuracy(lane)*min(film_weight(minval(thinner)), film_weight(maxval(thinner))), &
                         rounding*maxval(trial%film(:, :trial%flanks)))
   end function allowed_here

   !> Error of the step, whether it stands, and the next one; series of film, velocity and compressions for the samples.
   pure subroutine judge(bends, lane, trial, block, inner, states)
      !> Whether flanks bend
      logical, intent(in) :: bends
      integer, intent(in) :: lane
      type(trial_t), intent(in) :: trial
      type(lane_block_t), intent(inout) :: block
      type(lane_inner_t), intent(inout) :: inner
      type(trial_inner_t), intent(in) :: states
      real(dp) :: polynomial(rows, 0:2), width(rows), top, next, error
      integer :: flank

      error = huge(1.0_dp)
      if (block%trust(lane) > 0.0_dp) then
         associate (s => block%step(lane), kappa => block%compliance(lane))
            call weigh(power_rows, trial%acceleration, polynomial(:, 0))
            error = error_of_acceleration(polynomial(:stages, 0), s, 1.0_dp/free_rate)
            do flank = 1, trial%flanks
               call weigh(power_rows, trial%gain(:, flank), polynomial(:, flank))
               call highest_terms(polynomial(:stages, flank), top, next)
               error = max(error, max(top/last_share, next)*kappa)
               if (.not. bends) cycle
               call weigh(power_rows, trial%width(:, flank), width)
               call highest_terms(width(:stages), top, next)
               error = max(error, top/last_share, next)
            end do
            if (inner%count > 0) error = max(error, error_of_states(lane, block, trial%flanks, states%films, inner))
            error = error/allowed_here(lane, block, trial)
         end associate
         if (.not. error <= 1.0_dp) block%trust(lane) = 0.0_dp
      end if
      block%proposed(lane) = block%step(lane)*growth_of(error, most_growth, step_share)
      if (.not. block%trust(lane) > 0.0_dp) return
      block%next_film(lane) = trial%film(stages, 1)
      block%next_lienard(lane) = trial%lienard(stages)
      block%next_compression(lane, :trial%flanks) = block%compliance(lane)*trial%load(stages, :trial%flanks)
      block%polynomial(lane, :) = polynomial(:stages, 0)
      block%load_polynomial(lane, :, :trial%flanks) = polynomial(:stages, 1:trial%flanks)
      block%last_step(lane) = block%step(lane)
      block%damping_rate(lane) = 0.0_dp
      call series_of_step(lane, trial, block)
      if (bends) call add_width(lane, trial, block)
      if (inner%count > 0) call series_of_states(block%step(lane), trial%flanks, states%films, inner)
   end subroutine judge

   !> Power series of film, velocity and compressions about the start of the step.
   pure subroutine series_of_step(lane, trial, block)
      integer, intent(in) :: lane
      type(trial_t), intent(in) :: trial
      type(lane_block_t), intent(inout) :: block
      real(dp) :: shifted(0:stages), scale
      integer :: flank, j

      call series_of_motion(lane, block)
      block%compression(lane, :, 1:) = 0.0_dp
      associate (s => block%step(lane))
         do flank = 1, trial%flanks
            shifted = block%compliance(lane)*powers_of_place(block%load_polynomial(lane, :, flank))
            call meet_start(trial%counted(flank), shifted)
            scale = 1.0_dp
            do j = 1, stages
               scale = scale/s
               block%compression(lane, flank, j) = shifted(j)*scale
            end do
            if (flank == 1) block%film(lane, 1:stages) = block%film(lane, 1:stages) + block%compression(lane, 1, 1:stages)
         end do
      end associate
   end subroutine series_of_step

   !> Add the compression of the drive flank by its width to the series of the film.
   pure subroutine add_width(lane, trial, block)
      integer, intent(in) :: lane
      type(trial_t), intent(in) :: trial
      type(lane_block_t), intent(inout) :: block
      real(dp) :: shifted(0:stages), scale
      integer :: j

      shifted = powers_of_place(matmul(power, trial%width(:stages, 1)))
      call meet_start(trial%start_width(1), shifted)
      scale = 1.0_dp
      do j = 1, stages
         scale = scale/block%step(lane)
         block%film(lane, j) = block%film(lane, j) + shifted(j)*scale
      end do
   end subroutine add_width

end module elastic_step
