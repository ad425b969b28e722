!> Implicit steps by collocation for contacts with numbers of their own, lane by lane: elastic teeth, films with a state, of any
!> law and stiffness, one flank or two.
!>
!> The loads at the nodes are the unknowns: gear, springs and films follow from them (module elastic_trial), and Newton's method makes
!> the film laws hold (module elastic_newton; fsrc/THEORY.md, section 6). A state of a film is taken out of these equations contact by
!> contact (module inner_step), and brought after once the loads are corrected.
!>
!> The error is that of rigid teeth, of the polynomial of the acceleration (module collocation_basis); a load that is off moves its
!> film by kappa as well, and so counts the first coefficient of its polynomial that is left out.
module elastic_step
   use collocation_basis, only: choose_steps, error_of_acceleration, forces_at_nodes, growth_of, highest_terms, last_share, &
      series_of_motion
   use elastic_newton, only: allowed_here, solve_loads
   use elastic_tangents, only: carry_tangents, lane_tangents_t
   use elastic_trial, only: first_loads, start_films, trial_t
   use flank_contact, only: flank_contact_t
   use inner_equations, only: error_of_states, first_states, series_of_states, trial_inner_t
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_functions, only: lanes
   use lane_state, only: lane_inner_t
   use radau_nodes, only: meet_start, power, power_rows, powers_of_place, rows, stages, weigh
   use taylor_step_control, only: free_rate
   implicit none(type, external)
   private

   !> Step over the one before, at most, which leaves its loads to be carried on: a longer one would take twice the iterations. Its
   !> share of what the error allows: a rejected step costs as much as an accepted one.
   real(dp), parameter :: most_growth = 1.99_dp, step_share = 0.7_dp

   public :: take_elastic_step, advance_contacts

contains

   !> Try one step in every lane that has a scene.
   pure subroutine take_elastic_step(contacts, occupied, block, inner, tangents)
      !> Contacts of the lanes
      type(flank_contact_t), intent(in) :: contacts(lanes)
      !> Lanes with a scene
      logical, intent(in) :: occupied(lanes)
      !> The block; leaves the state that the step leads to, whether it is accepted, and series for the samples
      type(lane_block_t), intent(inout) :: block
      !> and the same of the states of the films
      type(lane_inner_t), intent(inout) :: inner(lanes)
      !> Displacements that go along
      type(lane_tangents_t), intent(inout) :: tangents(lanes)
      real(dp) :: force(rows)
      type(trial_t) :: trial
      type(trial_inner_t) :: states
      integer :: l

      call choose_steps(block)
      block%next_film = block%film(:, 0)
      block%next_lienard = block%lienard(:, 0)
      block%accepted = 0.0_dp
      do l = 1, lanes
         if (.not. occupied(l)) cycle
         trial%flanks = merge(2, 1, block%backlash(l) < huge(1.0_dp))
         call start_films(contacts(l), l, block, trial)
         if (inner(l)%count > 0) call first_states(l, block, trial%flanks, inner(l), states)
         call first_loads(l, block, contacts(l), inner(l), trial)
         call forces_at_nodes(l, block, force)
         call solve_loads(contacts(l), l, force, block, inner(l), trial, states)
         call judge(contacts(l)%film%bends, l, trial, block, inner(l), states)
         if (block%accepted(l) > 0.0_dp .and. allocated(tangents(l)%now)) &
            call carry_tangents(contacts(l), l, trial, block, tangents(l))
      end do
   end subroutine take_elastic_step

   !> Advance the springs and the states of films of all lanes whose step is accepted.
   pure subroutine advance_contacts(block, inner)
      type(lane_block_t), intent(inout) :: block
      type(lane_inner_t), intent(inout) :: inner(lanes)
      integer :: l

      do l = 1, lanes
         if (block%accepted(l) > 0.0_dp) block%compression(l, :, 0) = block%next_compression(l, :)
      end do
      do l = 1, lanes
         if (inner(l)%count > 0 .and. block%accepted(l) > 0.0_dp) inner(l)%now(:) = inner(l)%next
      end do
   end subroutine advance_contacts

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
      if (block%accepted(lane) > 0.0_dp) then
         associate (s => block%step(lane), kappa => trial%most_yield)
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
         if (.not. error <= 1.0_dp) block%accepted(lane) = 0.0_dp
      end if
      block%proposed(lane) = block%step(lane)*growth_of(error, most_growth, step_share)
      if (.not. block%accepted(lane) > 0.0_dp) return
      block%next_film(lane) = trial%film(stages, 1)
      block%next_lienard(lane) = trial%lienard(stages)
      block%next_compression(lane, :trial%flanks) = block%compliance(lane)*trial%load(stages, :trial%flanks)
      if (trial%damped) then
         do flank = 1, trial%flanks
            block%next_compression(lane, trial%flanks + flank) = block%compression(lane, trial%flanks + flank, 0) + &
                                                                 trial%deflection(stages, flank)
         end do
      end if
      block%polynomial(lane, :) = polynomial(:stages, 0)
      block%load_polynomial(lane, :, :trial%flanks) = polynomial(:stages, 1:trial%flanks)
      block%last_step(lane) = block%step(lane)
      block%coast_film(lane) = trial%film(stages, 2)
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
            if (trial%damped) call add_deflection(lane, flank, trial, block)
            if (flank == 1 .and. .not. trial%damped) &
               block%film(lane, 1:stages) = block%film(lane, 1:stages) + block%compression(lane, 1, 1:stages)
         end do
      end associate
   end subroutine series_of_step

   !> Power series of the deflection of a damped tooth; that of the drive flank is added to the series of the film.
   pure subroutine add_deflection(lane, flank, trial, block)
      integer, intent(in) :: lane
      integer, intent(in) :: flank
      type(trial_t), intent(in) :: trial
      type(lane_block_t), intent(inout) :: block
      real(dp) :: shifted(0:stages), scale
      integer :: place, j

      shifted = powers_of_place(matmul(power, trial%deflection(:stages, flank)))
      call meet_start(0.0_dp, shifted)
      place = trial%flanks + flank
      scale = 1.0_dp
      do j = 1, stages
         scale = scale/block%step(lane)
         block%compression(lane, place, j) = shifted(j)*scale
      end do
      if (flank == 1) block%film(lane, 1:stages) = block%film(lane, 1:stages) + block%compression(lane, place, 1:stages) + &
                                                   (1.0_dp - block%damped_share(lane))*block%compression(lane, 1, 1:stages)
   end subroutine add_deflection

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
