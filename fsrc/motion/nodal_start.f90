!> State in which a gear whose films are solved in nodes begins to move: at rest under its static load, or from a film and a velocity
!> that are given.
module nodal_start
   use kinds, only: dp
   use motion_start, only: start_is_given
   use nodal_film, only: shares_of_fourth_order, smallest_film
   use nodal_flank, only: accept_step, correct_flank, finish_step, is_bent, kept_times, nodal_contact_t, nodal_flank_t, respond, &
      rigid_gap, rigid_load, share_that_leaves_a_film, step_weights_t, stiffen
   use nodal_step, only: first_step, gear_t, motion_t, state_of
   use problem, only: of_drive_compression, of_velocity, state_size, static_load
   use starting_state, only: initial_state
   implicit none(type, external)
   private

   !> Newton's iterations: of them all, and before nodes change one by one
   integer, parameter :: most_iterations = 120, free_iterations = 80
   !> Relative change of the state that is the last one
   real(dp), parameter :: last_change = 1.0e-9_dp
   !> By how much the load grows from one film at rest to the next, at most and at least
   real(dp), parameter :: largest_growth = 1.4_dp, least_growth = 1.005_dp
   !> Share up to which two loads are the same
   real(dp), parameter :: same_load = 1.0e-3_dp

   public :: start_of_gear

contains

   !> The gear where its motion begins.
   pure subroutine start_of_gear(gear, motion, found)
      type(gear_t), intent(in) :: gear
      type(motion_t), intent(out) :: motion
      !> Whether its films were found
      logical, intent(out) :: found
      integer :: j

      found = gear%problem%initial_film > 0.0_dp
      if (.not. found) return
      if (start_is_given(gear%problem)) then
         call given_start(gear, motion, found)
      else
         call rest_of_gear(gear, motion, found)
      end if
      if (.not. found) return
      motion%position = motion%position(0)
      motion%time = 0.0_dp
      motion%known = 1
      motion%step = first_step
      allocate (motion%states(0:kept_times, state_size(gear%problem)))
      do j = 0, kept_times
         motion%states(j, :) = state_of(gear, motion, 1)
      end do
   end subroutine start_of_gear

   !> The gear at a film of the drive flank and at a velocity that are given: its films have been squeezed at this velocity for long.
   pure subroutine given_start(gear, motion, found)
      type(gear_t), intent(in) :: gear
      type(motion_t), intent(inout) :: motion
      logical, intent(out) :: found

      motion%velocity = gear%problem%initial_velocity*gear%time_unit/gear%film_unit
      motion%fastest = abs(motion%velocity(0))
      call squeezed_film(gear%contact, motion%velocity(0), gear%problem%initial_film/gear%film_unit, .false., motion%flanks(1), &
                         found)
      if (.not. found) return
      motion%position = motion%flanks(1)%gap(0)
      if (gear%flanks == 2) call squeezed_film(gear%contact, -motion%velocity(0), gear%backlash - motion%position(0), .true., &
                                               motion%flanks(2), found)
   end subroutine given_start

   !> A film that is squeezed at some velocity: that of rigid flanks, or where these bend in nodes, from a wider film on by closing
   !> the gap.
   pure subroutine squeezed_film(contact, velocity, target, by_gap, film, found)
      type(nodal_contact_t), intent(in) :: contact
      !> H' [-]
      real(dp), intent(in) :: velocity
      !> Smallest film H, or the gap G [-]
      real(dp), intent(in) :: target
      logical, intent(in) :: by_gap
      type(nodal_flank_t), intent(inout) :: film
      logical, intent(out) :: found
      real(dp), parameter :: widening = 1.2_dp, closing = 0.2_dp, most_closing = 0.5_dp, faster = 1.5_dp
      type(nodal_flank_t) :: trial
      type(step_weights_t) :: weights
      real(dp) :: step
      logical :: is_beyond
      integer :: j

      found = .true.
      film%film = target
      if (by_gap) film%film = film_of_gap(contact, velocity, target)
      call put_rigid_film(contact, velocity, film)
      if (is_bent(contact, film)) then
         do while (is_bent(contact, film))
            film%film = widening*film%film
            call put_rigid_film(contact, velocity, film)
         end do
         call enter_nodes(contact, velocity, film)
         call move_gap(contact, 0.0_dp, film, found)
         if (.not. found) return
         step = -closing*film%film(0)
         is_beyond = .false.
         do while (abs(step) > epsilon(1.0_dp)*(abs(film%gap(0)) + film%film(0)))
            trial = film
            call move_gap(contact, step, trial, found)
            if (found) found = trial%film(0) > most_closing*film%film(0)
            if (found .and. .not. merge(trial%gap(0), trial%film(0), by_gap) < target) film = trial
            if (found) is_beyond = is_beyond .or. merge(trial%gap(0), trial%film(0), by_gap) < target
            step = merge(faster, 0.5_dp, found .and. .not. is_beyond)*step
         end do
         found = is_beyond
         if (.not. found) return
      end if
      weights = step_weights_t()
      weights%rate(0) = velocity/film%film(0)
      call finish_step(contact, weights, film)
      do j = 1, kept_times
         call accept_step(contact, film)
      end do
   end subroutine squeezed_film

   !> Let a film be that of rigid flanks at its thickness and a velocity.
   pure subroutine put_rigid_film(contact, velocity, film)
      type(nodal_contact_t), intent(in) :: contact
      !> H' [-]
      real(dp), intent(in) :: velocity
      type(nodal_flank_t), intent(inout) :: film
      type(step_weights_t) :: weights

      weights = step_weights_t()
      weights%rate(0) = velocity/film%film(0)
      call finish_step(contact, weights, film)
      film%velocity = velocity
      film%load = film%load(0)
      film%gap = rigid_gap(contact, film%film(0), film%load(0))
   end subroutine put_rigid_film

   !> Film of rigid flanks whose gap and velocity are known [-].
   pure real(dp) function film_of_gap(contact, velocity, gap) result(film)
      type(nodal_contact_t), intent(in) :: contact
      !> H' [-]
      real(dp), intent(in) :: velocity
      !> G [-]
      real(dp), intent(in) :: gap
      integer, parameter :: most_passes = 200
      real(dp) :: low, high, load, by_film, by_velocity
      logical :: exists
      integer :: pass

      low = 0.0_dp
      high = huge(1.0_dp)
      film = max(gap, 1.0_dp)
      do pass = 1, most_passes
         call rigid_load(contact, film, velocity, load, by_film, by_velocity, exists)
         if (rigid_gap(contact, film, load) > gap) then
            high = film
         else
            low = film
         end if
         film = merge(0.5_dp*(low + high), 2.0_dp*film, high < huge(1.0_dp))
      end do
   end function film_of_gap

   !> Move the gap of a film in nodes, and find its pressures there and its smallest film.
   pure subroutine move_gap(contact, step, film, found)
      type(nodal_contact_t), intent(in) :: contact
      !> dG [-]
      real(dp), intent(in) :: step
      type(nodal_flank_t), intent(inout) :: film
      logical, intent(out) :: found

      call find_pressures(contact, film, found, step=step)
      if (.not. found) return
      film%film(0) = smallest_film(contact%grid, film%gap(0), film%pressures(:, 0))
      found = film%film(0) > 0.0_dp
   end subroutine move_gap

   !> The gear at rest under its static load, from films that carry it each.
   pure subroutine rest_of_gear(gear, motion, found)
      type(gear_t), intent(in) :: gear
      type(motion_t), intent(inout) :: motion
      logical, intent(out) :: found
      type(step_weights_t) :: at_rest
      real(dp) :: start(state_size(gear%problem)), loads(2), static, load(2), by_gap(2), change, changes, correction, share
      integer :: flank, iteration, j

      at_rest = step_weights_t()
      start = initial_state(gear%problem)
      static = static_load(gear%problem)/gear%load_unit
      loads = 0.0_dp
      loads(:gear%flanks) = start(of_drive_compression:of_velocity + gear%flanks)/(gear%problem%contact%compliance*gear%load_unit)
      ! A closure may have one film under two loads, and then gives the other load or none.
      associate (target => static + loads(2))
         if (target > 0.0_dp .and. abs(loads(1) - target) > same_load*target) loads(1) = target
      end associate
      do flank = 1, gear%flanks
         call rest_of_film(gear%contact, loads(flank), motion%flanks(flank), found)
         if (.not. found) return
      end do
      motion%position = motion%flanks(1)%gap(merge(0, 1, motion%flanks(1)%in_nodes))
      do flank = 1, gear%flanks
         associate (film => motion%flanks(flank))
            film%gap(0) = motion%position(0)
            if (flank == 2) film%gap(0) = gear%backlash - motion%position(0)
            if (.not. film%in_nodes) film%film(0) = film%film(1)
            film%rate = 0.0_dp
            film%past_film = 0.0_dp
         end associate
      end do
      do iteration = 1, most_iterations
         load = 0.0_dp
         by_gap = 0.0_dp
         do flank = 1, gear%flanks
            call respond(gear%contact, iteration > free_iterations, motion%flanks(flank), load(flank), by_gap(flank), found)
            if (.not. found) return
         end do
         correction = (load(1) - load(2) - static)/(-sum(by_gap))
         share = share_that_leaves_a_film(motion%flanks(1), correction)
         if (gear%flanks == 2) share = min(share, share_that_leaves_a_film(motion%flanks(2), -correction))
         changes = 0.0_dp
         do flank = 1, gear%flanks
            call correct_flank(gear%contact, share, merge(correction, -correction, flank == 1), motion%flanks(flank), change)
            changes = max(changes, change)
         end do
         motion%position(0) = motion%position(0) + share*correction
         if (changes < 1.0e-10_dp .and. abs(correction) < 1.0e-10_dp*(1.0_dp + abs(motion%position(0)))) exit
      end do
      found = changes < 1.0e-6_dp
      if (.not. found) return
      do flank = 1, gear%flanks
         call finish_step(gear%contact, at_rest, motion%flanks(flank))
         ! It has stood still for long.
         do j = 1, kept_times
            call accept_step(gear%contact, motion%flanks(flank))
         end do
      end do
      motion%velocity = 0.0_dp
   end subroutine rest_of_gear

   !> A film at rest under a load: that of rigid flanks, or in nodes, where the load grows step by step.
   pure subroutine rest_of_film(contact, load, film, found)
      type(nodal_contact_t), intent(in) :: contact
      !> M [-]
      real(dp), intent(in) :: load
      type(nodal_flank_t), intent(inout) :: film
      logical, intent(out) :: found
      type(nodal_flank_t) :: solved
      real(dp) :: target, growth, solved_load

      found = .true.
      ! A rigid film at rest: M H = 12 Phi(0), of which Phi(0) is 0.2039.
      film%film = 12.0_dp*0.2039_dp/max(load, 1.0e-12_dp)
      film%load = load
      film%gap = rigid_gap(contact, film%film(1), film%load(1))
      film%bending(0) = 4.0_dp/3.14_dp*film%load(1)/film%film(1)
      ! Of 0.64 M/sqrt(2 H) as the largest pressure
      film%bending(0) = max(film%bending(0), 0.064_dp*contact%oil%material*film%load(1)/sqrt(2.0_dp*film%film(1)))
      if (.not. is_bent(contact, film)) return
      target = min(0.1_dp, film%load(1))
      film%film = 12.0_dp*0.2039_dp/target
      film%load = target
      film%gap = rigid_gap(contact, film%film(1), target)
      call enter_nodes(contact, 0.0_dp, film)
      growth = largest_growth
      solved_load = 0.0_dp
      do
         call find_pressures(contact, film, found, load=target)
         if (found) then
            if (.not. target < load) return
            solved_load = target
            solved = film
         else
            ! From the last load that was solved by a smaller step
            growth = sqrt(growth)
            if (growth < least_growth .or. .not. solved_load > 0.0_dp) return
            film = solved
         end if
         target = min(load, growth*solved_load)
      end do
   end subroutine rest_of_film

   !> Let the film of rigid flanks at a velocity be one in nodes, which is squeezed at this velocity for long.
   pure subroutine enter_nodes(contact, velocity, film)
      type(nodal_contact_t), intent(in) :: contact
      !> H' [-]
      real(dp), intent(in) :: velocity
      type(nodal_flank_t), intent(inout) :: film

      call stiffen(contact, film)
      film%gap(0) = film%gap(1)
      film%pressures(:, 0) = film%pressures(:, 1)
      film%active = film%pressures(:, 0) > 0.0_dp
      film%fourth = shares_of_fourth_order(film%pressures(:, 0))
      film%rate = 0.0_dp
      film%past = velocity*contact%grid%length
   end subroutine enter_nodes

   !> Pressures of a film in nodes by Newton's method, from those near them: under a load, or with the gap moved by a step.
   pure subroutine find_pressures(contact, film, found, step, load)
      type(nodal_contact_t), intent(in) :: contact
      type(nodal_flank_t), intent(inout) :: film
      logical, intent(out) :: found
      !> dG [-]
      real(dp), intent(in), optional :: step
      !> M [-]
      real(dp), intent(in), optional :: load
      real(dp) :: carried, by_gap, change, correction
      integer :: iteration

      do iteration = 1, most_iterations
         call respond(contact, iteration > free_iterations, film, carried, by_gap, found)
         if (.not. found) return
         correction = 0.0_dp
         if (present(load)) correction = (load - carried)/by_gap
         if (present(step) .and. iteration == 1) correction = step
         call correct_flank(contact, 1.0_dp, correction, film, change)
         film%fourth = shares_of_fourth_order(film%pressures(:, 0))
         found = change < last_change
         if (found) return
      end do
   end subroutine find_pressures

end module nodal_start
