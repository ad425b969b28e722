!> Steps of a gear whose flanks bend under films solved in nodes of pressure (module nodal_flank): backward differences of third
!> order of variable step, in Moes' variables,
!>
!>     mu Z'' = M_1 - M_2 - F(T) ,   G_1 = Z ,   G_2 = B - Z .
!>
!> An iteration of Newton's method solves each film for a gap that is still to be corrected, M + S dG, so that the gear has one
!> equation. A step of a rigid film that ends beyond the bound is thrown away and done again in nodes. Steps end where periods do.
module nodal_step
   use carried_loads, only: films_of
   use clock, only: wall_seconds
   use constants, only: two_pi
   use engine, only: ending_t
   use force, only: force_at
   use kinds, only: dp, int64
   use nodal_film, only: grid_of, outlet_shift
   use nodal_flank, only: accept_step, begin_step, correct_flank, difference_times, finish_step, is_bent, kept_times, &
      may_soften, nodal_contact_t, nodal_flank_t, respond, share_that_leaves_a_film, soften, step_weights_t, stiffen
   use nodal_tangent, only: advance_tangent, nodal_tangent_t, soften_tangent, stiffen_tangent
   use problem, only: contact_count, has_two_flanks, largest_applied_force, of_film, of_velocity, problem_t, state_size
   use scene_status, only: status_complete, status_film_cycles, status_film_torn
   use scene_types, only: viscosity_constant
   implicit none(type, external)
   private

   !> How a motion is followed.
   type, public :: nodal_choice_t
      integer :: nodes = 32
      !> Tolerance of a step [-]
      real(dp) :: tolerance = 3.0e-3_dp
      !> Bound of bending beyond which films are solved in nodes [-]
      real(dp) :: bound = 1.0e-2_dp
      !> S of the grid [-]
      real(dp) :: scale = 3.0_dp
      !> When no more period is begun, of the motion and of what follows from it, on the clock of wall_seconds [s]
      real(dp) :: ends_at = huge(1.0_dp)
   end type nodal_choice_t

   !> Largest load below which errors of loads count as errors of it: that of the forces, if these are less [-]; share of the
   !> velocity that the force gives a free gear
   real(dp), parameter :: largest_floor = 0.05_dp, floor_share = 0.1_dp

   !> The gear: what moves, how it is followed, the contact of a flank, units and coefficients.
   type, public :: gear_t
      type(problem_t) :: problem
      type(nodal_choice_t) :: choice
      type(nodal_contact_t) :: contact
      !> Film [m], load [N] and time [s] of Moes' variables
      real(dp) :: film_unit = 1.0_dp, load_unit = 1.0_dp, time_unit = 1.0_dp
      !> mu, B, and a period
      real(dp) :: mass = 1.0_dp, backlash = huge(1.0_dp), period = 1.0_dp
      integer :: flanks = 1
      !> Load below which errors of loads count as errors of this one [-]
      real(dp) :: load_floor = largest_floor
      !> Velocity below which errors of velocities count as errors of this one: a share of what the force gives a free gear
      real(dp) :: velocity_floor = 1.0_dp
      !> Velocity that the force gives a free gear
      real(dp) :: free_velocity = 1.0_dp
   end type gear_t

   !> A motion under way. Places of histories as in module nodal_flank.
   type, public :: motion_t
      type(nodal_flank_t) :: flanks(2)
      real(dp) :: position(0:kept_times) = 0.0_dp, velocity(0:kept_times) = 0.0_dp
      !> Times [periods], in the present period; and how many of the last ones are known
      real(dp) :: time(0:kept_times) = 0.0_dp
      integer :: known = 0
      !> Velocity predicted for the end of a step, and the largest one so far
      real(dp) :: guessed_velocity = 0.0_dp, fastest = 0.0_dp
      !> Next step [periods]
      real(dp) :: step = 0.0_dp
      !> States at the last times, in the unit of each: time, number
      real(dp), allocatable :: states(:, :)
   end type motion_t

   !> Minimum film thickness of a flank, largest pressure, gap, film at the largest pressure, and film in the middle: the numbers of
   !> a state behind the compressions, flank by flank.
   integer, parameter :: numbers_of_flank = 5

   !> First step of a motion [periods]
   real(dp), parameter, public :: first_step = 1.0e-6_dp
   !> Shortest step, with which a motion is given up, and longest one [periods]; largest growth of a step; share of the predicted
   !> distance that counts as error of a step, of each order
   real(dp), parameter :: shortest_step = 1.0e-13_dp, most_growth = 1.5_dp, longest_step = 0.02_dp, &
                          error_shares(3) = [0.5_dp, 0.3_dp, 0.12_dp]
   !> Newton's iterations: of them all, before nodes change one by one, and the last correction of them [-]
   integer, parameter :: most_iterations = 40, free_iterations = 8
   real(dp), parameter :: last_correction = 1.0e-7_dp
   !> Rejected steps in a row after which an unloaded film is torn, its load and the times it may be in a period
   integer, parameter :: most_rejected = 6, most_torn = 20

   !> Steps of a period after which a motion is given up; it takes some 1200, and 6000 at the finest accuracy
   integer(int64), parameter, public :: most_steps = 50000_int64

   public :: is_late, set_up, state_of, take_step, begin_period, distance_of_states

contains

   !> Whether the time that a motion may take is over.
   logical function is_late(choice)
      type(nodal_choice_t), intent(in) :: choice

      is_late = wall_seconds() > choice%ends_at
   end function is_late

   !> Units, coefficients and grid.
   pure subroutine set_up(problem, choice, gear)
      type(problem_t), intent(in) :: problem
      type(nodal_choice_t), intent(in) :: choice
      type(gear_t), intent(out) :: gear

      gear%problem = problem
      gear%choice = choice
      associate (oil => problem%contact%film%closure, contact => gear%contact)
         contact%oil = oil
         contact%bound = choice%bound
         contact%compliance = problem%contact%compliance*oil%load_unit/oil%film_unit
         contact%grid = grid_of(choice%nodes, choice%scale, contact%compliance, &
                                merge(outlet_shift, 0.0_dp, oil%viscosity_law == viscosity_constant))
         gear%film_unit = oil%film_unit
         gear%load_unit = oil%load_unit
         gear%time_unit = oil%film_unit/oil%velocity_unit
         gear%period = 1.0_dp/(problem%frequency*gear%time_unit)
         gear%mass = problem%mass*oil%film_unit/(gear%time_unit**2*oil%load_unit)
         gear%flanks = contact_count(problem)
         gear%free_velocity = largest_applied_force(problem)/(oil%load_unit*gear%mass)*gear%period/two_pi
         gear%velocity_floor = floor_share*gear%free_velocity
         gear%load_floor = min(largest_floor, largest_applied_force(problem)/oil%load_unit)
         if (has_two_flanks(problem)) gear%backlash = problem%backlash/oil%film_unit
      end associate
   end subroutine set_up

   !> Numbers of the state at a place of the histories.
   pure function state_of(gear, motion, place) result(state)
      type(gear_t), intent(in) :: gear
      type(motion_t), intent(in) :: motion
      !> 0 or 1
      integer, intent(in) :: place
      real(dp) :: state(state_size(gear%problem))
      integer :: flank, first

      state(of_film) = motion%flanks(1)%film(place)*gear%film_unit
      state(of_velocity) = motion%velocity(place)*gear%film_unit/gear%time_unit
      do flank = 1, gear%flanks
         state(of_velocity + flank) = gear%problem%contact%compliance*gear%load_unit*motion%flanks(flank)%load(place)
         first = of_velocity + gear%flanks + numbers_of_flank*(flank - 1) + 1
         associate (film => motion%flanks(flank))
            state(first:first + numbers_of_flank - 1) = &
               [film%film(place)*gear%film_unit, film%peak(place)*gear%contact%oil%pressure_unit, &
                film%gap(place)*gear%film_unit, film%film_at_peak(place)*gear%film_unit, film%middle(place)*gear%film_unit]
         end associate
      end do
   end function state_of

   !> One step, which is done again shorter, or in nodes, until it may be accepted.
   subroutine take_step(gear, motion, ending, tangent)
      type(gear_t), intent(in) :: gear
      type(motion_t), intent(inout) :: motion
      type(ending_t), intent(inout) :: ending
      !> Neighbours of the motion, which follow it
      type(nodal_tangent_t), intent(inout), optional :: tangent
      type(step_weights_t) :: weights
      real(dp) :: left, error, growth
      integer :: order, flank, rejected
      logical :: solved, changed, at_end

      rejected = 0
      do
         left = 1.0_dp - motion%time(1)
         at_end = motion%step >= left*(1.0_dp - 1.0e-9_dp)
         if (at_end) then
            motion%time(0) = 1.0_dp
         else
            if (motion%step > 0.5_dp*left) motion%step = 0.5_dp*left
            motion%time(0) = motion%time(1) + motion%step
         end if
         order = min(motion%known, difference_times)
         weights = weights_of(motion%time*gear%period, order, min(motion%known, kept_times))
         call solve_step(gear, weights, motion, ending, solved)
         growth = 0.3_dp
         if (solved) then
            changed = .false.
            do flank = 1, gear%flanks
               if (motion%flanks(flank)%in_nodes) cycle
               if (.not. is_bent(gear%contact, motion%flanks(flank))) cycle
               if (present(tangent)) call stiffen_tangent(gear%contact, motion%flanks(flank), tangent%flanks(flank))
               call stiffen(gear%contact, motion%flanks(flank))
               changed = .true.
            end do
            if (changed) cycle
            error = error_of_step(gear, motion, order)/gear%choice%tolerance
            growth = min(most_growth, max(0.2_dp, 0.85_dp*max(error, 1.0e-10_dp)**(-1.0_dp/real(order + 1, dp))))
            if (.not. error > 1.0_dp) exit
         end if
         rejected = rejected + 1
         if (.not. solved .and. rejected >= most_rejected) then
            call tear_films(gear, motion, ending, changed, tangent)
            if (ending%status /= status_complete) return
            if (changed) rejected = 0
         end if
         motion%step = growth*(motion%time(0) - motion%time(1))
         if (motion%step < shortest_step) then
            ending%status = status_film_cycles
            return
         end if
      end do
      if (at_end) then
         motion%step = min(max(motion%step, growth*left), longest_step)
      else
         motion%step = min(growth*motion%step, longest_step)
      end if
      if (present(tangent)) call advance_tangent(gear%contact, motion%flanks(:gear%flanks), gear%mass, weights, tangent)
      do flank = 1, gear%flanks
         call accept_step(gear%contact, motion%flanks(flank))
         if (may_soften(gear%contact, motion%flanks(flank))) call soften_film(gear, flank, motion, tangent)
      end do
      motion%position(1:) = motion%position(:kept_times - 1)
      motion%velocity(1:) = motion%velocity(:kept_times - 1)
      motion%time(1:) = motion%time(:kept_times - 1)
      motion%fastest = max(motion%fastest, abs(motion%velocity(1)))
      motion%known = min(motion%known + 1, kept_times + 1)
      motion%states(2:, :) = motion%states(1:kept_times - 1, :)
      motion%states(1, :) = state_of(gear, motion, 1)
   end subroutine take_step

   !> Open cavities in films that open and carry next to nothing: they are those of rigid flanks again.
   pure subroutine tear_films(gear, motion, ending, changed, tangent)
      type(gear_t), intent(in) :: gear
      type(motion_t), intent(inout) :: motion
      type(ending_t), intent(inout) :: ending
      !> Whether there is such a film
      logical, intent(out) :: changed
      type(nodal_tangent_t), intent(inout), optional :: tangent
      integer :: flank

      changed = .false.
      do flank = 1, gear%flanks
         associate (film => motion%flanks(flank))
            if (.not. (film%in_nodes .and. film%load(1) < largest_floor .and. film%velocity(1) > 0.0_dp)) cycle
         end associate
         call soften_film(gear, flank, motion, tangent)
         ending%count%cuts = ending%count%cuts + 1
         changed = .true.
      end do
      if (changed .and. ending%count%cuts > most_torn*int(ending%periods + 1, int64)) ending%status = status_film_torn
   end subroutine tear_films

   !> From nodes to the closed form, with the neighbours.
   pure subroutine soften_film(gear, flank, motion, tangent)
      type(gear_t), intent(in) :: gear
      integer, intent(in) :: flank
      type(motion_t), intent(inout) :: motion
      type(nodal_tangent_t), intent(inout), optional :: tangent

      call soften(gear%contact, motion%flanks(flank))
      if (present(tangent)) call soften_tangent(gear%contact, motion%flanks(flank), tangent%flanks(flank))
   end subroutine soften_film

   !> Let times count from the start of the next period.
   pure subroutine begin_period(motion)
      type(motion_t), intent(inout) :: motion

      motion%time = motion%time - 1.0_dp
      motion%time(1) = 0.0_dp
   end subroutine begin_period

   !> Relative distance of two states: of both films, and of velocities over the largest one so far.
   pure real(dp) function distance_of_states(gear, motion, one, other) result(distance)
      type(gear_t), intent(in) :: gear
      type(motion_t), intent(in) :: motion
      !> Numbers of a state
      real(dp), intent(in) :: one(:)
      !> Those of the other one
      real(dp), intent(in) :: other(:)
      real(dp) :: films(2, contact_count(gear%problem)), fastest

      fastest = motion%fastest*gear%film_unit/gear%time_unit
      films = films_of(gear%problem, transpose(reshape([one, other], [size(one), 2])))
      distance = max(abs(one(of_velocity) - other(of_velocity))/fastest, maxval(abs(films(1, :) - films(2, :))/films(2, :)))
   end function distance_of_states

   !> Weights of a step of some order, and of a prediction by some points.
   pure type(step_weights_t) function weights_of(time, order, points) result(weights)
      !> Places as in module nodal_flank [-]
      real(dp), intent(in) :: time(0:)
      integer, intent(in) :: order
      integer, intent(in) :: points
      real(dp) :: product
      integer :: i, j

      do i = 1, order
         weights%rate(0) = weights%rate(0) + 1.0_dp/(time(0) - time(i))
         product = 1.0_dp
         do j = 1, order
            if (j /= i) product = product*(time(0) - time(j))/(time(i) - time(j))
         end do
         weights%rate(i) = product/(time(i) - time(0))
      end do
      do i = 1, points
         weights%guess(i) = 1.0_dp
         do j = 1, points
            if (j /= i) weights%guess(i) = weights%guess(i)*(time(0) - time(j))/(time(i) - time(j))
         end do
      end do
   end function weights_of

   !> Solve the equations of a step by Newton's method.
   subroutine solve_step(gear, weights, motion, ending, solved)
      type(gear_t), intent(in) :: gear
      type(step_weights_t), intent(in) :: weights
      type(motion_t), intent(inout) :: motion
      type(ending_t), intent(inout) :: ending
      logical, intent(out) :: solved
      real(dp) :: past_position, past_velocity, force, load(2), by_gap(2), correction, share, change, changes, scale
      integer :: flank, iteration

      associate (a0 => weights%rate(0))
         past_position = dot_product(weights%rate(1:), motion%position(1:difference_times))
         past_velocity = dot_product(weights%rate(1:), motion%velocity(1:difference_times))
         force = (force_at(gear%problem%force, motion%time(0)) + gear%problem%weight)/gear%load_unit
         motion%position(0) = dot_product(weights%guess, motion%position(1:))
         motion%guessed_velocity = dot_product(weights%guess, motion%velocity(1:))
         do flank = 1, gear%flanks
            call begin_step(weights, motion%flanks(flank))
            motion%flanks(flank)%gap(0) = merge(motion%position(0), gear%backlash - motion%position(0), flank == 1)
         end do
         solved = .false.
         do iteration = 1, most_iterations
            load = 0.0_dp
            by_gap = 0.0_dp
            do flank = 1, gear%flanks
               call respond(gear%contact, iteration > free_iterations, motion%flanks(flank), load(flank), by_gap(flank), solved)
               ending%count%evaluations = ending%count%evaluations + 1
               if (.not. solved) return
            end do
            correction = (load(1) - load(2) - force - gear%mass*(a0*(a0*motion%position(0) + past_position) + past_velocity)) &
                         /(gear%mass*a0*a0 - sum(by_gap))
            share = share_that_leaves_a_film(motion%flanks(1), correction)
            if (gear%flanks == 2) share = min(share, share_that_leaves_a_film(motion%flanks(2), -correction))
            changes = 0.0_dp
            scale = huge(1.0_dp)
            do flank = 1, gear%flanks
               call correct_flank(gear%contact, share, merge(correction, -correction, flank == 1), motion%flanks(flank), change)
               changes = max(changes, change)
               scale = min(scale, motion%flanks(flank)%film(1))
            end do
            motion%position(0) = motion%position(0) + share*correction
            solved = changes <= last_correction .and. abs(correction) <= last_correction*scale .and. share >= 1.0_dp
            if (solved) exit
         end do
         if (.not. solved) return
         motion%velocity(0) = a0*motion%position(0) + past_position
         do flank = 1, gear%flanks
            call finish_step(gear%contact, weights, motion%flanks(flank))
            solved = solved .and. motion%flanks(flank)%film(0) > 0.0_dp
         end do
      end associate
   end subroutine solve_step

   !> Error of a step: of the velocity, of loads, above a floor, and of films.
   pure real(dp) function error_of_step(gear, motion, order) result(error)
      type(gear_t), intent(in) :: gear
      type(motion_t), intent(in) :: motion
      integer, intent(in) :: order
      integer :: flank

      error = abs(motion%velocity(0) - motion%guessed_velocity)/max(motion%fastest, abs(motion%velocity(0)), gear%velocity_floor)
      do flank = 1, gear%flanks
         associate (film => motion%flanks(flank))
            error = max(error, abs(film%load(0) - film%guessed_load)/(film%load(0) + gear%load_floor), &
                        abs(film%centre(0) - film%guessed_centre)/film%centre(0))
         end associate
      end do
      error = error_shares(order)*error
   end function error_of_step

end module nodal_step
