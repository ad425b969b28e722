!> Equations of films with a state in an implicit step (module elastic_step): their states are taken out contact by contact (module
!> inner_step), so that the gear meets loads whose slopes reach over all nodes of the step. The Makefile keeps these procedures out
!> of the steps that call them, which films without a state take as well.
module inner_equations
   use collocation_basis, only: can_extrapolate, highest_terms, last_share
   use elastic_trial, only: iterate_t, trial_t
   use flank_contact, only: flank_contact_t
   use inner_step, only: eliminate_state, follow_film, inner_step_t, step_response_t
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_state, only: evaluate_inner, lane_inner_t
   use radau_nodes, only: meet_start, node, once, power, powers_of_place, rows, slope, stages, twice
   use step_elimination, only: most_columns, most_rows
   use taylor_step_control, only: sign_of
   implicit none(type, external)
   private

   !> States of both films through the step, and what the gear sees of them.
   type, public :: trial_inner_t
      type(inner_step_t) :: films(2)
      type(step_response_t) :: responses(2)
   end type trial_inner_t

   public :: first_states, inner_residuals, inner_matrix, follow_films, error_of_states, series_of_states

contains

   !> First iterate of the states of films: the polynomials of the step before, or the states at its end where they would be carried
   !> too far.
   pure subroutine first_states(lane, block, flanks, inner, states)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      integer, intent(in) :: flanks
      type(lane_inner_t), intent(in) :: inner
      type(trial_inner_t), intent(out) :: states
      real(dp) :: values(stages, size(inner%now))
      integer :: flank, first, last

      if (can_extrapolate(lane, block)) then
         call evaluate_inner(inner, block%last_step(lane) + block%step(lane)*node, values)
      else
         values = spread(inner%now, 1, stages)
      end if
      do flank = 1, flanks
         first = inner%count*(flank - 1) + 1
         last = inner%count*flank
         states%films(flank)%start = inner%now(first:last)
         states%films(flank)%values = transpose(values(:, first:last))
      end do
   end subroutine first_states

   !> By how much the laws of films with a state miss at the nodes, whose loads follow from the films at all nodes.
   pure subroutine inner_residuals(contact, lane, block, trial, inner_trial, right, found)
      type(flank_contact_t), intent(in) :: contact
      integer, intent(in) :: lane
      type(lane_block_t), intent(inout) :: block
      type(trial_t), intent(in) :: trial
      type(trial_inner_t), intent(inout) :: inner_trial
      real(dp), intent(out) :: right(most_rows)
      logical, intent(out) :: found
      integer :: flank

      right = 0.0_dp
      found = all(trial%film(:, :trial%flanks) > 0.0_dp)
      do flank = 1, trial%flanks
         if (.not. found) return
         associate (response => inner_trial%responses(flank))
            call eliminate_state(contact, slope, block%step(lane)*block%film_scale(lane)/block%velocity_scale(lane), &
                                 trial%film(:stages, flank)*block%film_scale(lane), &
                                 trial%velocity(:stages, flank)*block%velocity_scale(lane), inner_trial%films(flank), response)
            block%no_load(lane) = response%overloaded
            found = response%exists
            if (found) right(rows*(flank - 1) + 1:rows*flank - 1) = response%loads/block%force_scale(lane) - &
                                                                     trial%load(:stages, flank)
         end associate
      end do
   end subroutine inner_residuals

   !> Newton's matrix of films with a state.
   pure subroutine inner_matrix(lane, block, trial, responses, matrix)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      type(trial_t), intent(in) :: trial
      type(step_response_t), intent(in) :: responses(2)
      real(dp), intent(out) :: matrix(most_rows, most_columns)
      real(dp), dimension(stages, stages) :: by_film, by_velocity, by_gear
      integer :: first, column, flank, other, i

      matrix = 0.0_dp
      associate (s => block%step(lane), kappa => block%compliance(lane), flanks => trial%flanks)
         do flank = 1, flanks
            first = rows*(flank - 1)
            column = stages*(flank - 1)
            by_film = -responses(flank)%by_film*(block%film_scale(lane)/block%force_scale(lane))
            by_velocity = -responses(flank)%by_velocity*(block%velocity_scale(lane)/block%force_scale(lane))
            by_gear = s*(s*matmul(by_film, twice) + matmul(by_velocity, once))
            do other = 1, flanks
               matrix(first + 1:first + stages, stages*(other - 1) + 1:stages*other) = sign_of(flank)*sign_of(other)*by_gear
            end do
            if (trial%damped) then
               by_gear = matmul(by_film + matmul(by_velocity, slope)/s, trial%yields(:stages, :))
            else
               by_gear = kappa*(by_film + matmul(by_velocity, slope)/s)
            end if
            matrix(first + 1:first + stages, column + 1:column + stages) = &
               matrix(first + 1:first + stages, column + 1:column + stages) + by_gear
            do i = 1, stages
               matrix(first + i, column + i) = matrix(first + i, column + i) + 1.0_dp
            end do
         end do
      end associate
   end subroutine inner_matrix

   !> Let the states of the films follow a correction of the loads.
   pure subroutine follow_films(lane, block, flanks, share, before, trial, inner, films, largest)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      integer, intent(in) :: flanks
      !> Of the correction
      real(dp), intent(in) :: share
      !> Before and after the correction
      type(iterate_t), intent(in) :: before
      type(iterate_t), intent(in) :: trial
      type(lane_inner_t), intent(in) :: inner
      type(inner_step_t), intent(inout) :: films(2)
      !> What the largest change of a number counts as [-]
      real(dp), intent(out) :: largest
      real(dp) :: changes(inner%count)
      integer :: flank

      largest = 0.0_dp
      do flank = 1, flanks
         call follow_film(share, (trial%film(:stages, flank) - before%film(:stages, flank))*block%film_scale(lane), &
                          (trial%velocity(:stages, flank) - before%velocity(:stages, flank))*block%velocity_scale(lane), &
                          films(flank), changes)
         largest = max(largest, maxval(changes*inner%counts_as(inner%count*(flank - 1) + 1:inner%count*flank)) &
                       /block%film_scale(lane))
      end do
   end subroutine follow_films

   !> Error of the states of films: that of a polynomial is the first coefficient left out [-].
   pure real(dp) function error_of_states(lane, block, flanks, films, inner) result(error)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      integer, intent(in) :: flanks
      type(inner_step_t), intent(in) :: films(2)
      type(lane_inner_t), intent(in) :: inner
      real(dp) :: top, next
      integer :: flank, i

      error = 0.0_dp
      do flank = 1, flanks
         do i = 1, inner%count
            call highest_terms(matmul(power, films(flank)%values(i, :)), top, next)
            error = max(error, max(top/last_share, next)*inner%counts_as(inner%count*(flank - 1) + i)/block%film_scale(lane))
         end do
      end do
   end function error_of_states

   !> Power series of the states of films about the start of the step, and the states at its end.
   pure subroutine series_of_states(step, flanks, films, inner)
      !> [periods]
      real(dp), intent(in) :: step
      integer, intent(in) :: flanks
      type(inner_step_t), intent(in) :: films(2)
      type(lane_inner_t), intent(inout) :: inner
      real(dp) :: shifted(0:stages)
      integer :: flank, place, i, j

      do flank = 1, flanks
         do i = 1, inner%count
            place = inner%count*(flank - 1) + i
            inner%next(place) = films(flank)%values(i, stages)
            shifted = powers_of_place(matmul(power, films(flank)%values(i, :)))
            call meet_start(inner%now(place), shifted)
            inner%series(place, :) = [(shifted(j)/step**j, j=0, stages)]
         end do
      end do
   end subroutine series_of_states

end module inner_equations
