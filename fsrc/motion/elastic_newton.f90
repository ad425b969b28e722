!> Newton's method for the loads of an implicit step (module elastic_step). The equations of films without a state stand here: by how
!> much their laws miss at the nodes, and what the loads change of that; those of films with one stand in module inner_equations.
module elastic_newton
   use collocation_basis, only: rounding, iteration_share
   use elastic_trial, only: follow_loads, iterate_t, trial_t
   use film_law, only: kept_load, most_films
   use flank_contact, only: carries_positive_loads, equations_of_films, film_equations_t, flank_contact_t, keeps_load
   use inner_equations, only: follow_films, inner_matrix, trial_inner_t, inner_residuals
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_state, only: lane_inner_t
   use radau_nodes, only: once_rows, rows, slope_rows, stages, twice_rows, weigh
   use step_elimination, only: factorise, factors_t, most_columns, most_rows, substitute
   use taylor_step_control, only: film_weight, free_rate, sign_of
   implicit none(type, external)
   private

   !> Slopes of the equations at the nodes, of one flank after the other: by the film, by its velocity and by its load [-]
   type, public :: slopes_t
      real(dp), dimension(most_films) :: by_film, by_velocity, by_load
      !> Whether the equation is that of velocities
      logical, dimension(most_films) :: of_velocities = .false.
   end type slopes_t

   !> Weight of a load at a node in the velocity of its film there, about: what the table of slopes has on its diagonal
   real(dp), parameter :: velocity_share = 10.0_dp

   !> Newton's iterations before the step is given up
   integer, parameter :: most_iterations = 12
   !> The second iteration takes the slopes of the first, and so do the next ones while corrections fall to less than this share.
   real(dp), parameter :: fast_fall = 1.0e-2_dp
   !> Corrections that fall by less than this from one iteration to the next, after some, lead nowhere
   real(dp), parameter :: slowest_fall = 0.9_dp

   !> A correction leaves at least this share of every film, and of the load of one that never pulls
   real(dp), parameter :: least_ratio = 0.1_dp

   !> A correction that raises the load of a film that never pulls by more than this share of it is not the last one: the velocity
   !> of the film goes with the logarithm or a negative power of its load, so that Newton's method hardly moves a load that is far
   !> too small.
   real(dp), parameter :: last_rise = 0.5_dp

   integer :: i, j
   !> 1 in the row of a node, and 0 in the others
   real(dp), parameter :: alone(rows, stages) = reshape([((merge(1.0_dp, 0.0_dp, i == j), i=1, rows), j=1, stages)], [rows, stages])

   public :: solve_loads, allowed_here, residuals, newton_matrix

contains

   !> Newton's method for the loads.
   pure subroutine solve_loads(contact, lane, force, block, inner, trial, inner_trial)
      type(flank_contact_t), intent(in) :: contact
      integer, intent(in) :: lane
      !> F at the nodes [-]
      real(dp), intent(in) :: force(rows)
      type(lane_block_t), intent(inout) :: block
      type(lane_inner_t), intent(in) :: inner
      type(trial_t), intent(inout) :: trial
      type(trial_inner_t), intent(inout) :: inner_trial
      type(iterate_t) :: before
      type(slopes_t) :: slopes
      type(factors_t) :: factors
      real(dp) :: matrix(most_rows, most_columns), right(most_rows), solution(most_rows), correction(rows, 2)
      real(dp) :: change, last_change, ratio, reach, share, state_change, finite, above
      integer :: iteration, flank, i
      logical :: found, stalled, rising, anew, of_velocities(most_rows)

      of_velocities = .false.
      last_change = huge(1.0_dp)
      ! What an error of one in the loads moves the films by
      reach = max(block%step(lane)*min(block%step(lane), 1.0_dp/free_rate), trial%most_yield)
      trial%film(:, 1) = trial%start(1)
      trial%film(:, 2) = trial%start(2)
      call follow_loads(contact, lane, force, block, trial)
      anew = .true.
      do iteration = 1, most_iterations
         if (inner%count > 0) then
            call inner_residuals(contact, lane, block, trial, inner_trial, right, found)
            anew = .true.
         else
            call residuals(contact, lane, block, trial, right, slopes, found)
            anew = anew .or. any(slopes%of_velocities .neqv. of_velocities)
            of_velocities = slopes%of_velocities
         end if
         if (.not. found) return
         if (anew) then
            if (inner%count > 0) then
               call inner_matrix(lane, block, trial, inner_trial%responses, matrix)
            else
               call newton_matrix(contact%film%bends, lane, block, trial, slopes, matrix)
            end if
            call factorise(trial%flanks, matrix, factors)
         end if
         call substitute(trial%flanks, factors, right, solution)
         rising = .false.
         change = 0.0_dp
         do flank = 1, trial%flanks
            correction(:stages, flank) = solution(rows*(flank - 1) + 1:rows*flank - 1)
            correction(rows, flank) = correction(stages, flank)
            if (carries_positive_loads(contact)) then
               rising = rising .or. any(correction(:, flank) > last_rise*trial%load(:, flank))
               correction(:, flank) = max(correction(:, flank), (least_ratio - 1.0_dp)*trial%load(:, flank))
            end if
            finite = 0.0_dp
            !$omp simd reduction(+: finite) reduction(max: change)
            do i = 1, rows
               finite = finite + merge(1.0_dp, 0.0_dp, abs(correction(i, flank)) < huge(1.0_dp))
               change = max(change, abs(correction(i, flank)))
            end do
            if (finite < real(rows, dp)) return
         end do
         ! Part by part: a copy of the whole takes longer.
         before%load = trial%load
         before%film = trial%film
         before%velocity = trial%velocity
         before%gain = trial%gain
         trial%load(:, :trial%flanks) = before%load(:, :trial%flanks) + correction(:, :trial%flanks)
         trial%gain(:, :trial%flanks) = before%gain(:, :trial%flanks) + correction(:, :trial%flanks)
         call follow_loads(contact, lane, force, block, trial)
         share = 1.0_dp
         do flank = 1, trial%flanks
            above = huge(1.0_dp)
            !$omp simd reduction(min: above)
            do i = 1, rows
               above = min(above, trial%film(i, flank) - least_ratio*before%film(i, flank))
            end do
            if (above >= 0.0_dp) cycle
            do i = 1, stages
               if (before%film(i, flank) > 0.0_dp .and. trial%film(i, flank) < least_ratio*before%film(i, flank)) &
                  share = min(share, (1.0_dp - least_ratio)*before%film(i, flank)/(before%film(i, flank) - trial%film(i, flank)))
            end do
         end do
         if (keeps_load(contact)) call stay_above(contact, lane, block, trial%flanks, before, trial%iterate_t, &
                                               of_velocities, share, rising)
         if (share < 1.0_dp) then
            trial%iterate_t = before
            trial%load(:, :trial%flanks) = before%load(:, :trial%flanks) + share*correction(:, :trial%flanks)
            trial%gain(:, :trial%flanks) = before%gain(:, :trial%flanks) + share*correction(:, :trial%flanks)
            call follow_loads(contact, lane, force, block, trial)
         end if
         state_change = 0.0_dp
         if (inner%count > 0) call follow_films(lane, block, trial%flanks, share, before, trial%iterate_t, inner, &
                                                   inner_trial%films, state_change)
         if (share < 1.0_dp .or. rising) then
            last_change = huge(1.0_dp)
            anew = .true.
            cycle
         end if
         ratio = 1.0_dp
         if (last_change < huge(1.0_dp)) ratio = min(1.0_dp, change/last_change)
         anew = last_change < huge(1.0_dp) .and. ratio > fast_fall
         ! Corrections that fall no more are rounding, which a short step magnifies: within the accuracy they are accepted.
         stalled = iteration > 4 .and. change > slowest_fall*last_change
         if (max(change*reach*ratio, state_change) <= merge(1.0_dp, iteration_share, stalled)*allowed_here(lane, block, trial)) then
            if (minval(trial%film(:, :trial%flanks)) > 0.0_dp) block%accepted(lane) = 1.0_dp
            return
         end if
         if (stalled) return
         last_change = change
      end do
   end subroutine solve_loads

   !> Let loads stay above those that their films keep however fast they separate, at nodes whose equations are those of velocities:
   !> there the velocity goes with a negative power of what is above, as with the load of a film that never pulls.
   pure subroutine stay_above(contact, lane, block, flanks, before, trial, of_velocities, share, rising)
      type(flank_contact_t), intent(in) :: contact
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      integer, intent(in) :: flanks
      !> Before and after the correction
      type(iterate_t), intent(in) :: before
      type(iterate_t), intent(in) :: trial
      !> Of each node of one flank after the other, whether its equation is that of velocities
      logical, intent(in) :: of_velocities(most_rows)
      !> Of the correction, to be applied
      real(dp), intent(inout) :: share
      !> Whether a correction raises what is above too much to be the last one
      logical, intent(inout) :: rising
      real(dp) :: above, next
      integer :: flank, i

      do flank = 1, flanks
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
      real(dp) :: thinner, thinnest, thickest, widest
      integer :: i

      thinnest = huge(1.0_dp)
      thickest = -huge(1.0_dp)
      widest = -huge(1.0_dp)
      !$omp simd private(thinner) reduction(min: thinnest) reduction(max: thickest, widest)
      do i = 1, rows
         thinner = merge(min(trial%film(i, 1), trial%film(i, 2)), trial%film(i, 1), trial%flanks == 2)
         thinnest = min(thinnest, thinner)
         thickest = max(thickest, thinner)
         widest = max(widest, trial%film(i, 1), merge(trial%film(i, 2), trial%film(i, 1), trial%flanks == 2))
      end do
      allowed_here = max(block%accuracy(lane)*min(film_weight(thinnest), film_weight(thickest)), rounding*widest)
   end function allowed_here

   !> By how much the film laws miss at the nodes, and their slopes; none where a film has no load. A film without thickness is to
   !> be what it was at the start.
   pure subroutine residuals(contact, lane, block, trial, right, slopes, found)
      type(flank_contact_t), intent(in) :: contact
      integer, intent(in) :: lane
      type(lane_block_t), intent(inout) :: block
      type(trial_t), intent(in) :: trial
      real(dp), intent(out) :: right(most_rows)
      type(slopes_t), intent(inout) :: slopes
      logical, intent(out) :: found
      type(film_equations_t) :: laws
      real(dp), dimension(rows, 2) :: films, loads, velocities
      integer :: n, flank, place, i

      n = rows*trial%flanks
      do flank = 1, trial%flanks
         films(:, flank) = merge(trial%film(:, flank), trial%start(flank), trial%film(:, flank) > 0.0_dp)*block%film_scale(lane)
         loads(:, flank) = trial%load(:, flank)*block%force_scale(lane)
         velocities(:, flank) = trial%velocity(:, flank)*block%velocity_scale(lane)
      end do
      call equations_of_films(contact, n, films, loads, velocities, velocity_share*block%compliance(lane)/ &
                              (block%step(lane) + velocity_share*block%retardation(lane))* &
                              (block%velocity_scale(lane)/block%force_scale(lane)), laws)
      slopes%of_velocities(:n) = laws%of_velocities(:n)
      right(n + 1:) = 0.0_dp
      call scale_laws(n, block%film_scale(lane), block%velocity_scale(lane), block%force_scale(lane), laws, trial%load, &
                      trial%velocity, right, slopes)
      found = .true.
      do flank = 1, trial%flanks
         do i = 1, stages
            place = rows*(flank - 1) + i
            if (trial%film(i, flank) > 0.0_dp) then
               block%no_load(lane) = laws%overloaded(place)
               found = laws%exists(place)
               if (.not. found) return
            else
               right(place) = trial%film(i, flank) - trial%start(flank)
               slopes%by_film(place) = -1.0_dp
               slopes%by_velocity(place) = 0.0_dp
               slopes%by_load(place) = 0.0_dp
            end if
         end do
         right(rows*flank) = 0.0_dp
      end do
   end subroutine residuals

   !> The equations in scaled units.
   pure subroutine scale_laws(n, film_unit, velocity_unit, force_unit, laws, load, velocity, right, slopes)
      !> How many
      integer, intent(in) :: n
      !> What counts as 1 [m], [m/s], [N]
      real(dp), intent(in) :: film_unit
      real(dp), intent(in) :: velocity_unit
      real(dp), intent(in) :: force_unit
      type(film_equations_t), intent(in) :: laws
      !> W and H' [-]
      real(dp), intent(in) :: load(most_films)
      real(dp), intent(in) :: velocity(most_films)
      !> By how much the laws miss [-]
      real(dp), intent(inout) :: right(most_films)
      type(slopes_t), intent(inout) :: slopes
      integer :: i

      !$omp simd
      do i = 1, n
         right(i) = laws%value(i)*(1.0_dp/velocity_unit) - velocity(i)
         slopes%by_film(i) = -laws%by_film(i)*(film_unit/velocity_unit)
         slopes%by_velocity(i) = 1.0_dp
         slopes%by_load(i) = -laws%by_other(i)*(force_unit/velocity_unit)
      end do
      if (all(laws%of_velocities(:n))) return
      do i = 1, n
         if (laws%of_velocities(i)) cycle
         right(i) = laws%value(i)/force_unit - load(i)
         slopes%by_film(i) = -laws%by_film(i)*(film_unit/force_unit)
         slopes%by_velocity(i) = -laws%by_other(i)*(velocity_unit/force_unit)
         slopes%by_load(i) = 1.0_dp
      end do
   end subroutine scale_laws

   !> Newton's matrix: what the loads at the nodes change of the equations there.
   pure subroutine newton_matrix(bends, lane, block, trial, slopes, matrix)
      !> Whether flanks bend
      logical, intent(in) :: bends
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      type(trial_t), intent(in) :: trial
      type(slopes_t), intent(in) :: slopes
      real(dp), intent(out) :: matrix(most_rows, most_columns)
      real(dp), dimension(rows) :: by_film, by_velocity, follows, gear, own, moved, rates
      real(dp) :: diagonal(stages)
      integer :: first, flank, other, column, i, j

      matrix(rows*trial%flanks + 1:, :) = 0.0_dp
      associate (s => block%step(lane), flanks => trial%flanks)
         do flank = 1, flanks
            first = rows*(flank - 1)
            ! The row that fills registers stays zero.
            by_film = slopes%by_film(first + 1:first + rows)
            by_velocity = slopes%by_velocity(first + 1:first + rows)
            by_film(rows) = 0.0_dp
            by_velocity(rows) = 0.0_dp
            follows = trial%follows(:, flank)
            diagonal = slopes%by_load(first + 1:first + stages) + by_film(:stages)*trial%compliance(:stages, flank)
            do j = 1, stages
               !$omp simd
               do i = 1, rows
                  gear(i) = s*(by_film(i)*s*twice_rows(i, j) + by_velocity(i)*once_rows(i, j))
               end do
               if (bends) then
                  !$omp simd
                  do i = 1, rows
                     moved(i) = follows(i)*twice_rows(i, j)
                  end do
                  call weigh(slope_rows, moved, rates)
                  !$omp simd
                  do i = 1, rows
                     gear(i) = gear(i) + s*(by_film(i)*s*moved(i) + by_velocity(i)*rates(i))
                  end do
               end if
               do other = 1, flanks
                  if (other == flank) cycle
                  column = stages*(other - 1) + j
                  !$omp simd
                  do i = 1, rows
                     matrix(first + i, column) = -gear(i)
                  end do
               end do
               own = gear
               if (trial%damped) then
                  moved = trial%yields(:, j)
                  if (bends) moved = moved*(1.0_dp + follows)
                  call weigh(slope_rows, moved, rates)
                  own = own + (by_film*moved + by_velocity*rates/s)
               end if
               ! All rows at once: a number that is written alone would be waited for where its row is read.
               column = stages*(flank - 1) + j
               !$omp simd
               do i = 1, rows
                  matrix(first + i, column) = own(i) + (trial%compliance(j, flank)/s)*by_velocity(i)*slope_rows(i, j) + &
                                              diagonal(j)*alone(i, j)
               end do
            end do
         end do
      end associate
   end subroutine newton_matrix

end module elastic_newton
