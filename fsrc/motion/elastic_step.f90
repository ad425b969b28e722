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
!> for the coast film with the signs of Z and V turned. The film law at each node is solved for the loads by Newton's method with
!> its slopes: as H_i' = w(H_i, W_i) where its load tells its velocity, else as W(H_i, H_i') = W_i. Nothing here grows with the
!> stiffness: at kappa = 0 these are the equations of module collocation_step. A state of a film is taken out of these equations
!> contact by contact (module inner_step), and brought after once the loads are corrected.
!>
!> The error is that of module collocation_step, of the polynomial of the acceleration; a load that is off moves its film by
!> kappa as well, and so counts the first coefficient of its polynomial that is left out.
module elastic_step
   use collocation_step, only: choose_steps, forces_of_stages, highest_terms
   use film_state, only: load_t
   use flank_contact, only: carries_positive_loads, equations_of_films, film_equations_t, film_over_gap, films_over_gaps, &
      flank_contact_t, load_of_contact, most_films, width_compression
   use inner_equations, only: can_extrapolate, error_of_states, first_states, follow_films, inner_imbalances, inner_matrix, &
      last_share, most_growth, most_rows, series_of_states, sign_of, trial_inner_t, trial_t
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_functions, only: lanes
   use lane_inner, only: lane_inner_t
   use radau_nodes, only: meet_start, node, once, power, powers_of_place, slope, stages, twice
   use taylor_step_control, only: film_weight, free_rate
   implicit none(type, external)
   private

   !> Newton's iterations before the step is given up
   integer, parameter :: most_passes = 12
   !> The second pass takes the slopes of the first, and so do the next ones while corrections fall to less than this in a pass.
   real(dp), parameter :: fast_fall = 1.0e-2_dp
   !> Share of the accuracy at which the iterations end
   real(dp), parameter, public :: pass_share = 1.0e-2_dp
   !> and for the first coefficient of a polynomial left out
   real(dp), parameter :: next_share = 2.0_dp
   !> Corrections that fall by less than this in a pass, after some, lead nowhere
   real(dp), parameter :: slowest_fall = 0.9_dp

   !> Step over the one before, at least (at most it is most_growth), and its share of what the error allows. A rejected step costs
   !> as much as an accepted one; a step of twice the length before, whose loads cannot be extrapolated, takes twice the iterations.
   real(dp), parameter :: least_growth = 0.1_dp, step_share = 0.7_dp

   !> The films of a flank at the nodes, and one more, that of the last node again, which fills up registers
   integer, parameter :: films_of_flank = most_films/2

   !> Slopes of the equations at the nodes, of one flank after the other: by the film, by its velocity and by its load [-]
   type :: slopes_t
      real(dp) :: by_film(2*stages) = 0.0_dp, by_velocity(2*stages) = 0.0_dp, by_load(2*stages) = 0.0_dp
   end type slopes_t

   !> Factors of a matrix: multipliers below the diagonal and zeros elsewhere, what stands above the diagonal and zeros elsewhere,
   !> the inverse pivots, and the row that has come to each place
   type :: factors_t
      real(dp) :: lower(most_rows, 2*stages) = 0.0_dp, upper(most_rows, 2*stages) = 0.0_dp, inverse_pivot(2*stages) = 0.0_dp
      integer :: row(2*stages) = 0
   end type factors_t

   !> Error that is rounding alone, as a share of the thickest film
   real(dp), parameter :: rounding = 16.0_dp*epsilon(1.0_dp)

   !> A correction leaves at least this share of every film, and of the load of one that never pulls
   real(dp), parameter :: least_ratio = 0.1_dp

   !> A correction that raises the load of a film that never pulls by more than this share of it is not the last one: the velocity
   !> of the film goes with the logarithm or a negative power of its load, so that Newton's method hardly moves a load that is far
   !> too small.
   real(dp), parameter :: last_rise = 0.5_dp

   public :: take_elastic_step, advance_contacts

contains

   !> Try one step in every lane that has a scene.
   pure subroutine take_elastic_step(contacts, occupied, block, inner)
      !> Contacts of the lanes
      type(flank_contact_t), intent(in) :: contacts(lanes)
      !> Lanes with a scene
      logical, intent(in) :: occupied(lanes)
      !> The block; leaves the state that the step leads to, whether it is to be trusted, and series for the samples
      type(lane_block_t), intent(inout) :: block
      !> and the same of the states of the films
      type(lane_inner_t), intent(inout) :: inner(lanes)
      real(dp) :: force(lanes, stages)
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
         call first_loads(l, block, contacts(l), inner(l), trial%flanks, trial%load)
         call solve(contacts(l), l, force(l, :), block, inner(l), trial, states)
         call judge(contacts(l)%film%bends, l, trial, block, inner(l), states)
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
   pure subroutine first_loads(lane, block, contact, inner, flanks, load)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      type(flank_contact_t), intent(in) :: contact
      type(lane_inner_t), intent(in) :: inner
      integer, intent(in) :: flanks
      real(dp), intent(inout) :: load(stages, 2)
      real(dp) :: place
      integer :: flank, i, j

      do flank = 1, flanks
         if (can_extrapolate(lane, block)) then
            do i = 1, stages
               place = 1.0_dp + 2.0_dp*block%step(lane)/block%last_step(lane)*node(i)
               load(i, flank) = 0.0_dp
               do j = stages, 1, -1
                  load(i, flank) = load(i, flank)*place + block%load_polynomial(lane, j, flank)
               end do
            end do
         else
            load(:, flank) = start_load(lane, block, contact, inner, flank)
         end if
         ! Between nodes a polynomial may fall below what a film that never pulls can carry.
         if (.not. carries_positive_loads(contact)) cycle
         where (.not. load(:, flank) > 0.0_dp) load(:, flank) = start_load(lane, block, contact, inner, flank)
      end do
   end subroutine first_loads

   !> Newton's method for the loads.
   pure subroutine solve(contact, lane, force, block, inner, trial, inner_trial)
      type(flank_contact_t), intent(in) :: contact
      integer, intent(in) :: lane
      !> F at the nodes [-]
      real(dp), intent(in) :: force(stages)
      type(lane_block_t), intent(inout) :: block
      type(lane_inner_t), intent(in) :: inner
      type(trial_t), intent(inout) :: trial
      type(trial_inner_t), intent(inout) :: inner_trial
      type(trial_t) :: before
      type(slopes_t) :: slopes
      type(factors_t) :: factors
      real(dp) :: matrix(most_rows, 2*stages), right(2*stages), correction(2*stages), loads(2*stages)
      real(dp) :: change, last_change, ratio, reach, share, state_change
      integer :: pass, n, flank, i
      logical :: found, stalled, rising, anew

      n = stages*trial%flanks
      last_change = huge(1.0_dp)
      ! What an error of one in the loads moves the films by
      reach = max(block%step(lane)*min(block%step(lane), 1.0_dp/free_rate), block%compliance(lane))
      trial%film(:, 1) = trial%start(1)
      trial%film(:, 2) = trial%start(2)
      call states(contact, lane, force, block, trial)
      anew = .true.
      do pass = 1, most_passes
         if (inner%count > 0) then
            call inner_imbalances(contact, lane, block, trial, inner_trial, right, found)
            anew = .true.
         else
            call imbalances(contact, lane, block, trial, right, slopes, found)
         end if
         if (.not. found) return
         if (anew) then
            if (inner%count > 0) then
               call inner_matrix(lane, block, trial%flanks, inner_trial%responses, matrix)
            else
               call newton_matrix(contact%film%bends, lane, block, trial, slopes, matrix)
            end if
            call factorise(n, matrix, factors)
         end if
         call substitute(n, factors, right, correction)
         rising = .false.
         if (carries_positive_loads(contact)) then
            loads(:n) = reshape(trial%load(:, :trial%flanks), [n])
            rising = any(correction(:n) > last_rise*loads(:n))
            correction(:n) = max(correction(:n), (least_ratio - 1.0_dp)*loads(:n))
         end if
         change = maxval(abs(correction(:n)))
         if (.not. change < huge(1.0_dp)) return
         before = trial
         call correct(1.0_dp, correction(:n), trial)
         call states(contact, lane, force, block, trial)
         share = 1.0_dp
         do flank = 1, trial%flanks
            do i = 1, stages
               if (before%film(i, flank) > 0.0_dp .and. trial%film(i, flank) < least_ratio*before%film(i, flank)) &
                  share = min(share, (1.0_dp - least_ratio)*before%film(i, flank)/(before%film(i, flank) - trial%film(i, flank)))
            end do
         end do
         if (share < 1.0_dp) then
            trial = before
            call correct(share, correction(:n), trial)
            call states(contact, lane, force, block, trial)
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

   !> Add a share of the corrections to the loads.
   pure subroutine correct(share, correction, trial)
      real(dp), intent(in) :: share
      real(dp), intent(in) :: correction(:)
      type(trial_t), intent(inout) :: trial
      integer :: flank

      do flank = 1, trial%flanks
         trial%load(:, flank) = trial%load(:, flank) + share*correction(stages*(flank - 1) + 1:stages*flank)
      end do
   end subroutine correct

   !> Gear and films that follow from the loads.
   pure subroutine states(contact, lane, force, block, trial)
      type(flank_contact_t), intent(in) :: contact
      integer, intent(in) :: lane
      real(dp), intent(in) :: force(stages)
      type(lane_block_t), intent(in) :: block
      type(trial_t), intent(inout) :: trial
      real(dp), dimension(stages, 2) :: gap, yielded
      integer :: flank

      associate (s => block%step(lane), kappa => block%compliance(lane))
         trial%acceleration = trial%load(:, 1) - force
         if (trial%flanks == 2) trial%acceleration = trial%acceleration - trial%load(:, 2)
         trial%lienard = block%lienard(lane, 0) + s*matmul(once, trial%acceleration)
         trial%way = s*(node*block%lienard(lane, 0) + s*matmul(twice, trial%acceleration))
         do flank = 1, trial%flanks
            yielded(:, flank) = kappa*trial%load(:, flank) - block%compression(lane, flank, 0)
            gap(:, flank) = trial%start(flank) + (sign_of(flank)*trial%way + yielded(:, flank))
         end do
         if (contact%film%bends) then
            call bend(contact, lane, block, gap, yielded, trial)
         else
            trial%film(:, :trial%flanks) = gap(:, :trial%flanks)
         end if
         do flank = 1, trial%flanks
            trial%velocity(:, flank) = sign_of(flank)*trial%lienard + matmul(slope, yielded(:, flank))/s
         end do
      end associate
   end subroutine states

   !> Films of flanks that bend, from those that would be there if their width stayed what it was, and their compressions. They are
   !> looked for from where they were found last.
   pure subroutine bend(contact, lane, block, gap, yielded, trial)
      type(flank_contact_t), intent(in) :: contact
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      !> Films without a change of width, of one or two flanks [-]
      real(dp), intent(in) :: gap(stages, 2)
      !> Compressions since the start, then with those by the width [-]
      real(dp), intent(inout) :: yielded(stages, 2)
      type(trial_t), intent(inout) :: trial
      real(dp), dimension(films_of_flank, 2) :: gaps, loads, near, films, by_gap, by_load
      integer :: flank

      associate (scale => block%film_scale(lane), unit => block%force_scale(lane))
         do flank = 1, trial%flanks
            gaps(:, flank) = filled_up(gap(:, flank) - trial%start_width(flank))*scale
            loads(:, flank) = filled_up(trial%load(:, flank))*unit
            near(:, flank) = filled_up(trial%film(:, flank))*scale
         end do
         call films_over_gaps(contact%film, films_of_flank*trial%flanks, gaps, loads, near, films, by_gap, by_load)
         do flank = 1, trial%flanks
            trial%film(:, flank) = films(:stages, flank)/scale
            trial%width(:, flank) = trial%film(:, flank) - (gap(:, flank) - trial%start_width(flank))
            yielded(:, flank) = yielded(:, flank) + (trial%width(:, flank) - trial%start_width(flank))
            trial%follows(:, flank) = by_gap(:stages, flank)
            trial%compliance(:, flank) = block%compliance(lane)*(1.0_dp + by_gap(:stages, flank)) + &
                                         by_load(:stages, flank)*(unit/scale)
         end do
      end associate
   end subroutine bend

   !> Values at the nodes, the last one twice.
   pure function filled_up(values) result(filled)
      real(dp), intent(in) :: values(stages)
      real(dp) :: filled(films_of_flank)

      filled(:stages) = values
      filled(stages + 1:) = values(stages)
   end function filled_up

   !> By how much the film laws miss at the nodes, and their slopes; none where a film has no load. A film without thickness is to
   !> be what it was at the start.
   pure subroutine imbalances(contact, lane, block, trial, right, slopes, found)
      type(flank_contact_t), intent(in) :: contact
      integer, intent(in) :: lane
      type(lane_block_t), intent(inout) :: block
      type(trial_t), intent(in) :: trial
      real(dp), intent(out) :: right(2*stages)
      type(slopes_t), intent(out) :: slopes
      logical, intent(out) :: found
      type(film_equations_t) :: laws
      real(dp), dimension(films_of_flank, 2) :: films, loads, velocities
      real(dp) :: film_unit, velocity_unit, force_unit
      integer :: row, flank, place, i

      right = 0.0_dp
      film_unit = block%film_scale(lane)
      velocity_unit = block%velocity_scale(lane)
      force_unit = block%force_scale(lane)
      do flank = 1, trial%flanks
         films(:, flank) = filled_up(merge(trial%film(:, flank), trial%start(flank), trial%film(:, flank) > 0.0_dp))*film_unit
         loads(:, flank) = filled_up(trial%load(:, flank))*force_unit
         velocities(:, flank) = filled_up(trial%velocity(:, flank))*velocity_unit
      end do
      call equations_of_films(contact, films_of_flank*trial%flanks, films, loads, velocities, laws)
      do flank = 1, trial%flanks
         do i = 1, stages
            row = stages*(flank - 1) + i
            place = films_of_flank*(flank - 1) + i
            if (.not. trial%film(i, flank) > 0.0_dp) then
               right(row) = trial%film(i, flank) - trial%start(flank)
               slopes%by_film(row) = -1.0_dp
               slopes%by_velocity(row) = 0.0_dp
               slopes%by_load(row) = 0.0_dp
               cycle
            end if
            block%no_load(lane) = laws%overloaded(place)
            found = laws%exists(place)
            if (.not. found) return
            if (laws%of_velocities(place)) then
               right(row) = laws%value(place)/velocity_unit - trial%velocity(i, flank)
               slopes%by_film(row) = -laws%by_film(place)*(film_unit/velocity_unit)
               slopes%by_velocity(row) = 1.0_dp
               slopes%by_load(row) = -laws%by_other(place)*(force_unit/velocity_unit)
            else
               right(row) = laws%value(place)/force_unit - trial%load(i, flank)
               slopes%by_film(row) = -laws%by_film(place)*(film_unit/force_unit)
               slopes%by_velocity(row) = -laws%by_other(place)*(velocity_unit/force_unit)
               slopes%by_load(row) = 1.0_dp
            end if
         end do
      end do
      found = .true.
   end subroutine imbalances

   !> Newton's matrix: what the loads at the nodes change of the equations there.
   pure subroutine newton_matrix(bends, lane, block, trial, slopes, matrix)
      !> Whether flanks bend
      logical, intent(in) :: bends
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      type(trial_t), intent(in) :: trial
      type(slopes_t), intent(in) :: slopes
      real(dp), intent(out) :: matrix(most_rows, 2*stages)
      real(dp) :: by_film(stages), by_velocity(stages), by_load(stages), by_gear(stages, stages), turn
      integer :: first, flank, other, i, j

      matrix(stages*trial%flanks + 1:, :) = 0.0_dp
      associate (s => block%step(lane), flanks => trial%flanks)
         do flank = 1, flanks
            first = stages*(flank - 1)
            by_film = slopes%by_film(first + 1:first + stages)
            by_velocity = slopes%by_velocity(first + 1:first + stages)
            by_load = slopes%by_load(first + 1:first + stages)
            do j = 1, stages
               by_gear(:, j) = s*(by_film*s*twice(:, j) + by_velocity*once(:, j))
            end do
            if (bends) then
               do j = 1, stages
                  by_gear(:, j) = by_gear(:, j) + s*(by_film*trial%follows(:, flank)*s*twice(:, j) + &
                                                     by_velocity*matmul(slope, trial%follows(:, flank)*twice(:, j)))
               end do
            end if
            do other = 1, flanks
               turn = sign_of(flank)*sign_of(other)
               do j = 1, stages
                  do i = 1, stages
                     matrix(first + i, stages*(other - 1) + j) = turn*by_gear(i, j)
                  end do
               end do
            end do
            do j = 1, stages
               do i = 1, stages
                  matrix(first + i, first + j) = matrix(first + i, first + j) + &
                                                 (trial%compliance(j, flank)/s)*by_velocity(i)*slope(i, j)
               end do
               matrix(first + j, first + j) = matrix(first + j, first + j) + (by_load(j) + by_film(j)*trial%compliance(j, flank))
            end do
         end do
      end associate
   end subroutine newton_matrix

   !> Factors of a matrix, which is spent. Rows are exchanged for the largest pivot; all else goes down columns, four rows at a
   !> time.
   !> LAPACK's way takes twice as long for so few.
   pure subroutine factorise(last, matrix, factors)
      !> How many rows there are, the last ones of zeros not counted
      integer, intent(in) :: last
      real(dp), intent(inout) :: matrix(most_rows, 2*stages)
      type(factors_t), intent(out) :: factors
      real(dp) :: held
      integer :: n, i, j, largest, four

      factors%row = [(n, n=1, 2*stages)]
      do n = 1, last
         largest = n
         do i = n + 1, last
            if (abs(matrix(i, n)) > abs(matrix(largest, n))) largest = i
         end do
         if (largest /= n) then
            factors%row([n, largest]) = factors%row([largest, n])
            do j = 1, n - 1
               factors%lower([n, largest], j) = factors%lower([largest, n], j)
            end do
            do j = n, last
               held = matrix(n, j)
               matrix(n, j) = matrix(largest, j)
               matrix(largest, j) = held
            end do
         end if
         factors%inverse_pivot(n) = 1.0_dp/matrix(n, n)
         do i = 1, n - 1
            factors%upper(i, n) = matrix(i, n)
         end do
         do i = n + 1, last
            factors%lower(i, n) = matrix(i, n)*factors%inverse_pivot(n)
         end do
         do j = n + 1, last
            held = matrix(n, j)
            do four = 4*(n/4), last - 1, 4
               !$omp simd
               do i = 1, 4
                  matrix(four + i, j) = matrix(four + i, j) - factors%lower(four + i, n)*held
               end do
            end do
         end do
      end do
   end subroutine factorise

   !> Solve linear equations by the factors of their matrix. No number is written where four are read next: that would wait for it.
   pure subroutine substitute(last, factors, right, solution)
      integer, intent(in) :: last
      type(factors_t), intent(in) :: factors
      real(dp), intent(in) :: right(2*stages)
      real(dp), intent(out) :: solution(2*stages)
      real(dp) :: rest(most_rows), held
      integer :: n

      rest = 0.0_dp
      do n = 1, last
         rest(n) = right(factors%row(n))
      end do
      do n = 1, last
         held = rest(n)
         rest = rest - factors%lower(:, n)*held
      end do
      solution = 0.0_dp
      do n = last, 1, -1
         held = rest(n)*factors%inverse_pivot(n)
         solution(n) = held
         rest = rest - factors%upper(:, n)*held
      end do
   end subroutine substitute

   !> Error that the accuracy allows to the films of a step, where the thinner one of both is thickest or thinnest [-].
   pure real(dp) function allowed_here(lane, block, trial)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      type(trial_t), intent(in) :: trial
      real(dp) :: thinner(stages)

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
      real(dp) :: polynomial(stages, 0:2), top, next, error
      integer :: flank

      error = huge(1.0_dp)
      if (block%trust(lane) > 0.0_dp) then
         associate (s => block%step(lane), kappa => block%compliance(lane))
            polynomial(:, 0) = matmul(power, trial%acceleration)
            call highest_terms(polynomial(:, 0), top, next)
            error = max(top/last_share, next/next_share)*s*max(s/real(4*stages**2, dp), 1.0_dp/(free_rate*real(2*stages, dp)))
            do flank = 1, trial%flanks
               polynomial(:, flank) = matmul(power, trial%load(:, flank))
               call highest_terms(polynomial(:, flank), top, next)
               error = max(error, max(top/last_share, next)*kappa)
               if (.not. bends) cycle
               call highest_terms(matmul(power, trial%width(:, flank)), top, next)
               error = max(error, top/last_share, next)
            end do
            if (inner%count > 0) error = max(error, error_of_states(lane, block, trial%flanks, states%films, inner))
            error = error/allowed_here(lane, block, trial)
         end associate
         if (.not. error <= 1.0_dp) block%trust(lane) = 0.0_dp
      end if
      block%proposed(lane) = block%step(lane) &
                             *max(least_growth, min(most_growth, step_share/sqrt(sqrt(sqrt(max(error, tiny(1.0_dp)))))))
      if (.not. block%trust(lane) > 0.0_dp) return
      block%next_film(lane) = trial%film(stages, 1)
      block%next_lienard(lane) = trial%lienard(stages)
      block%next_compression(lane, :trial%flanks) = block%compliance(lane)*trial%load(stages, :trial%flanks)
      block%polynomial(lane, :) = polynomial(:, 0)
      block%load_polynomial(lane, :, :trial%flanks) = polynomial(:, 1:trial%flanks)
      block%last_step(lane) = block%step(lane)
      block%damping_rate(lane) = 0.0_dp
      call series_of_step(lane, trial%flanks, block)
      if (bends) call add_width(lane, trial, block)
      if (inner%count > 0) call series_of_states(block%step(lane), trial%flanks, states%films, inner)
   end subroutine judge

   !> Power series of film, velocity and compressions about the start of the step.
   pure subroutine series_of_step(lane, flanks, block)
      integer, intent(in) :: lane
      integer, intent(in) :: flanks
      type(lane_block_t), intent(inout) :: block
      real(dp) :: shifted(0:stages), scale
      integer :: flank, j

      block%film(lane, 1:) = 0.0_dp
      block%lienard(lane, 1:) = 0.0_dp
      block%compression(lane, :, 1:) = 0.0_dp
      associate (s => block%step(lane))
         shifted = powers_of_place(block%polynomial(lane, :))
         block%film(lane, 1) = block%lienard(lane, 0)
         scale = 1.0_dp
         do j = 0, stages - 1
            block%lienard(lane, j + 1) = shifted(j)*scale/real(j + 1, dp)
            block%film(lane, j + 2) = block%lienard(lane, j + 1)/real(j + 2, dp)
            scale = scale/s
         end do
         do flank = 1, flanks
            shifted = block%compliance(lane)*powers_of_place(block%load_polynomial(lane, :, flank))
            call meet_start(block%compression(lane, flank, 0), shifted)
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

      shifted = powers_of_place(matmul(power, trial%width(:, 1)))
      call meet_start(trial%start_width(1), shifted)
      scale = 1.0_dp
      do j = 1, stages
         scale = scale/block%step(lane)
         block%film(lane, j) = block%film(lane, j) + shifted(j)*scale
      end do
   end subroutine add_width

end module elastic_step
