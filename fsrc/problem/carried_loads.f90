!> What a state of a motion carries: the loads of both films and of the springs, their films, their largest pressures, and the
!> acceleration that is left for the mass.
module carried_loads
   use constants, only: two_pi
   use elastohydrodynamic_closure, only: closure_pressure
   use film_law, only: film_kernel, film_load, film_over_gap, overflow_load, width_compression
   use film_pressure, only: exact_pressure, exact_pressures
   use film_state, only: load_t, state_number_t
   use flank_contact, only: carries_positive_loads, loads_of_contact, of_gap, of_pressure, of_smallest_film, velocity_under
   use force, only: force_at, force_of_period, largest_oscillation
   use kinds, only: dp
   use problem, only: coast_flank, compression_count, contact_count, drive_flank, deflection_places, has_damped_teeth, &
      has_elastic_teeth, has_inner_numbers, has_two_flanks, inner_places, of_coast_compression, of_drive_compression, of_film, &
      of_velocity, problem_t, state_numbers, static_load
   use scene_types, only: least_static_load
   implicit none(type, external)
   private

   public :: thinnest_film, net_load, net_loads, contact_loads, contact_load, contact_films, contact_film, films_of, &
             gear_positions, tooth_powers, counts_as, sizes_of_state, largest_pressures, largest_pressure, acceleration_at, &
             accelerations_of_samples

contains

   !> The thinnest one of the films of all contacts in a state [m].
   pure real(dp) function thinnest_film(problem, state)
      type(problem_t), intent(in) :: problem
      !> Its numbers
      real(dp), intent(in) :: state(:)
      integer :: contact

      thinnest_film = state(of_film)
      do contact = 2, contact_count(problem)
         thinnest_film = min(thinnest_film, contact_film(problem, contact, state))
      end do
   end function thinnest_film

   !> Net load of films without a state of their own, W(h, z') - W(b - h, -z'), and its slopes; beyond `overflow_load` where one of
   !> the films has none.
   pure subroutine net_load(problem, thickness, velocity, load, kernel)
      !> Of rigid teeth
      type(problem_t), intent(in) :: problem
      !> Film thickness h > 0 [m]
      real(dp), intent(in) :: thickness
      !> Film velocity z' [m/s]
      real(dp), intent(in) :: velocity
      type(load_t), intent(out) :: load
      !> Kernel of the film, where it has been chosen before
      procedure(film_kernel), optional :: kernel
      type(load_t) :: coast

      if (present(kernel)) then
         call kernel(problem%contact%film, thickness, velocity, load%load, load%by_film, load%by_velocity)
      else
         call film_load(problem%contact%film, thickness, velocity, load%load, load%by_film, load%by_velocity)
      end if
      if (.not. has_two_flanks(problem)) return
      if (.not. abs(load%load) < overflow_load) return
      coast%load = 2.0_dp*overflow_load
      if (problem%backlash - thickness > 0.0_dp) &
         call film_load(problem%contact%film, problem%backlash - thickness, -velocity, coast%load, coast%by_film, coast%by_velocity)
      if (abs(coast%load) < overflow_load) then
         load%load = load%load - coast%load
         load%by_film = load%by_film + coast%by_film
         load%by_velocity = load%by_velocity + coast%by_velocity
      else
         load%load = 2.0_dp*overflow_load
      end if
   end subroutine net_load

   !> Net loads of many states.
   pure subroutine net_loads(problem, states, loads)
      type(problem_t), intent(in) :: problem
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      !> [N]
      real(dp), intent(out) :: loads(:)

      call drive_loads(problem, states, loads)
      if (.not. has_two_flanks(problem)) return
      block
         real(dp) :: coast(size(loads))

         call coast_loads(problem, states, coast)
         loads = loads - coast
      end block
   end subroutine net_loads

   !> Loads of the film of a contact, 0 where there is no such contact.
   pure subroutine contact_loads(problem, contact, states, loads)
      type(problem_t), intent(in) :: problem
      !> Its number
      integer, intent(in) :: contact
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      !> [N]
      real(dp), intent(out) :: loads(:)

      if (contact == drive_flank) then
         call drive_loads(problem, states, loads)
      else
         call coast_loads(problem, states, loads)
      end if
   end subroutine contact_loads

   !> Load of the film of a contact in one state [N].
   pure real(dp) function contact_load(problem, contact, state)
      type(problem_t), intent(in) :: problem
      !> Its number
      integer, intent(in) :: contact
      !> Its numbers
      real(dp), intent(in) :: state(:)
      type(load_t) :: load
      real(dp) :: loads(1)

      if (is_one_film(problem)) then
         call net_load(problem, state(of_film), state(of_velocity), load)
         contact_load = load%load
      else
         call contact_loads(problem, contact, reshape(state, [1, size(state)]), loads)
         contact_load = loads(1)
      end if
   end function contact_load

   !> Whether nothing but one film carries, of one state: it is not worth the registers of many.
   elemental logical function is_one_film(problem)
      type(problem_t), intent(in) :: problem

      is_one_film = .not. (has_two_flanks(problem) .or. has_inner_numbers(problem))
   end function is_one_film

   !> Films of a contact [m].
   pure function contact_films(problem, contact, states) result(films)
      type(problem_t), intent(in) :: problem
      !> Number of a contact that there is
      integer, intent(in) :: contact
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      real(dp) :: films(size(states, 1))

      if (contact == drive_flank) then
         films = states(:, of_film)
      else
         films = coast_films(problem, states)
      end if
   end function contact_films

   !> Film of a contact in one state [m].
   pure real(dp) function contact_film(problem, contact, state)
      type(problem_t), intent(in) :: problem
      !> Number of a contact that there is
      integer, intent(in) :: contact
      !> Its numbers
      real(dp), intent(in) :: state(:)
      real(dp) :: films(1)

      if (contact == drive_flank) then
         contact_film = state(of_film)
      else
         films = coast_films(problem, reshape(state, [1, size(state)]))
         contact_film = films(1)
      end if
   end function contact_film

   !> Loads of the drive film.
   pure subroutine drive_loads(problem, states, loads)
      type(problem_t), intent(in) :: problem
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      !> [N]
      real(dp), intent(out) :: loads(:)
      integer :: inner(2)

      if (has_elastic_teeth(problem)) then
         loads = states(:, of_drive_compression)/problem%contact%compliance
      else
         inner = inner_places(problem, 1)
         call loads_of_contact(problem%contact, states(:, of_film), states(:, of_velocity), states(:, inner(1):inner(2)), loads)
      end if
   end subroutine drive_loads

   !> Loads of the coast film, 0 where there is one flank.
   pure subroutine coast_loads(problem, states, loads)
      type(problem_t), intent(in) :: problem
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      !> [N]
      real(dp), intent(out) :: loads(:)
      integer :: inner(2)

      loads = 0.0_dp
      if (.not. has_two_flanks(problem)) return
      if (has_elastic_teeth(problem)) then
         loads = states(:, of_coast_compression)/problem%contact%compliance
      else
         inner = inner_places(problem, 2)
         call loads_of_contact(problem%contact, problem%backlash - states(:, of_film), -states(:, of_velocity), &
                               states(:, inner(1):inner(2)), loads)
      end if
   end subroutine coast_loads

   !> Films of the coast flank [m].
   pure function coast_films(problem, states) result(films)
      !> With two flanks
      type(problem_t), intent(in) :: problem
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      real(dp) :: films(size(states, 1))

      if (problem%contact%film%in_nodes) then
         films = nodal_numbers(problem, coast_flank, of_smallest_film, states)
         return
      end if
      films = problem%backlash - states(:, of_film)
      if (has_elastic_teeth(problem)) films = films + (compressions(problem, drive_flank, states) + &
                                                       compressions(problem, coast_flank, states))
      if (.not. problem%contact%film%bends) return
      films = films + drive_widths(problem, states)
      films = film_over_gap(problem%contact%film, films, states(:, of_coast_compression)/problem%contact%compliance, films)
   end function coast_films

   !> By how much a contact stands compressed, but for what follows its width [m].
   pure function compressions(problem, contact, states)
      !> With elastic teeth
      type(problem_t), intent(in) :: problem
      integer, intent(in) :: contact
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      real(dp) :: compressions(size(states, 1))
      integer :: places(2)

      compressions = states(:, of_velocity + contact)
      if (.not. has_damped_teeth(problem)) return
      places = deflection_places(problem)
      compressions = (1.0_dp - problem%contact%damped_share)*compressions + states(:, places(1) + contact - 1)
   end function compressions

   !> Power that damped teeth lose, c D'^2 with tau D' = kappa_t W - D [W]; 0 of others.
   pure function tooth_powers(problem, states) result(powers)
      type(problem_t), intent(in) :: problem
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      real(dp) :: powers(size(states, 1))
      integer :: places(2), contact

      powers = 0.0_dp
      if (.not. has_damped_teeth(problem)) return
      places = deflection_places(problem)
      associate (share => problem%contact%damped_share)
         do contact = 1, contact_count(problem)
            powers = powers + (share*states(:, of_velocity + contact) - states(:, places(1) + contact - 1))**2 &
                     /(share*problem%contact%compliance*problem%contact%retardation)
         end do
      end associate
   end function tooth_powers

   !> A number of the states of a flank whose film is solved in nodes.
   pure function nodal_numbers(problem, contact, which, states) result(numbers)
      type(problem_t), intent(in) :: problem
      integer, intent(in) :: contact
      !> One of those of module flank_contact
      integer, intent(in) :: which
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      real(dp) :: numbers(size(states, 1))
      integer :: places(2)

      places = inner_places(problem, contact)
      numbers = states(:, places(1) + which - 1)
   end function nodal_numbers

   !> Width compressions of the drive flank [m].
   pure function drive_widths(problem, states) result(widths)
      !> Of flanks that bend
      type(problem_t), intent(in) :: problem
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      real(dp), dimension(size(states, 1)) :: widths, by_film, by_load

      call width_compression(problem%contact%film, states(:, of_film), &
                             states(:, of_drive_compression)/problem%contact%compliance, widths, by_film, by_load)
   end function drive_widths

   !> Films of all contacts [m].
   pure function films_of(problem, states) result(films)
      type(problem_t), intent(in) :: problem
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      !> State, contact
      real(dp), allocatable :: films(:, :)
      integer :: contact

      allocate (films(size(states, 1), contact_count(problem)))
      do contact = 1, size(films, 2)
         films(:, contact) = contact_films(problem, contact, states)
      end do
   end function films_of

   !> Positions of the gear [m]: with rigid teeth the film of the drive flank.
   pure function gear_positions(problem, states) result(positions)
      type(problem_t), intent(in) :: problem
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      real(dp) :: positions(size(states, 1))

      if (problem%contact%film%in_nodes) then
         positions = nodal_numbers(problem, drive_flank, of_gap, states)
         return
      end if
      positions = states(:, of_film)
      if (has_elastic_teeth(problem)) positions = positions - compressions(problem, drive_flank, states)
      if (problem%contact%film%bends) positions = positions - drive_widths(problem, states)
   end function gear_positions

   !> Largest pressure of one state, as of largest_pressures [Pa].
   pure real(dp) function largest_pressure(problem, state)
      type(problem_t), intent(in) :: problem
      !> Its numbers
      real(dp), intent(in) :: state(:)
      real(dp) :: pressures(1)

      if (is_one_film(problem)) then
         associate (film => problem%contact%film)
            largest_pressure = exact_pressure(film%radius, film%speed, film%viscosity, state(of_film), state(of_velocity))
         end associate
      else
         call largest_pressures(problem, reshape(state, [1, size(state)]), pressures)
         largest_pressure = pressures(1)
      end if
   end function largest_pressure

   !> Largest pressures of the Reynolds iso-viscous film, or of an elastohydrodynamic film, on the flank where they are larger.
   pure subroutine largest_pressures(problem, states, pressures)
      type(problem_t), intent(in) :: problem
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      !> [Pa]
      real(dp), intent(out) :: pressures(:)

      associate (film => problem%contact%film, compliance => problem%contact%compliance)
         if (film%in_nodes) then
            pressures = nodal_numbers(problem, drive_flank, of_pressure, states)
            if (has_two_flanks(problem)) pressures = max(pressures, nodal_numbers(problem, coast_flank, of_pressure, states))
            return
         end if
         if (film%bends) then
            pressures = closure_pressure(film%closure, states(:, of_film), states(:, of_drive_compression)/compliance)
            if (has_two_flanks(problem)) &
               pressures = max(pressures, closure_pressure(film%closure, coast_films(problem, states), &
                                                           states(:, of_coast_compression)/compliance))
            return
         end if
         if (.not. has_elastic_teeth(problem)) then
            call exact_pressures(film%radius, film%speed, film%viscosity, states(:, of_film), states(:, of_velocity), pressures)
            if (.not. has_two_flanks(problem)) return
         end if
         ! Room that one flank of rigid teeth does not take.
         block
            real(dp), dimension(size(pressures)) :: coast, squeeze

            if (has_elastic_teeth(problem)) then
               squeeze = states(:, of_velocity)
               call film_velocities(problem, states(:, of_film), states(:, of_drive_compression), squeeze)
               call exact_pressures(film%radius, film%speed, film%viscosity, states(:, of_film), squeeze, pressures)
               if (.not. has_two_flanks(problem)) return
            end if
            squeeze = -states(:, of_velocity)
            if (has_elastic_teeth(problem)) &
               call film_velocities(problem, coast_films(problem, states), states(:, of_coast_compression), squeeze)
            call exact_pressures(film%radius, film%speed, film%viscosity, coast_films(problem, states), squeeze, coast)
            pressures = max(pressures, coast)
         end block
      end associate
   end subroutine largest_pressures

   !> Velocities of films that carry springs; that of the gear stays where a film carries its spring at no velocity.
   pure subroutine film_velocities(problem, films, compressions, velocities)
      type(problem_t), intent(in) :: problem
      !> [m]
      real(dp), intent(in) :: films(:)
      real(dp), intent(in) :: compressions(:)
      !> [m/s]
      real(dp), intent(inout) :: velocities(:)
      integer :: i

      do i = 1, size(films)
         velocities(i) = velocity_under(problem%contact, films(i), compressions(i)/problem%contact%compliance, velocities(i))
      end do
   end subroutine film_velocities

   !> z'' at a state and phase [m/s2].
   pure real(dp) function acceleration_at(problem, state, phase)
      type(problem_t), intent(in) :: problem
      !> Its numbers
      real(dp), intent(in) :: state(:)
      !> Of the force, from 0 to 1 [periods]
      real(dp), intent(in) :: phase
      type(load_t) :: load
      real(dp) :: loads(1)

      if (size(state) > of_velocity) then
         call net_loads(problem, reshape(state, [1, size(state)]), loads)
      else
         call net_load(problem, state(of_film), state(of_velocity), load)
         loads = load%load
      end if
      acceleration_at = (loads(1) - problem%weight - force_at(problem%force, phase))/problem%mass
   end function acceleration_at

   !> z'' of the samples of a motion.
   pure subroutine accelerations_of_samples(problem, samples_per_period, states, accelerations)
      type(problem_t), intent(in) :: problem
      !> Samples of a period
      integer, intent(in) :: samples_per_period
      !> Sample, number of its state; from the first sample of a period on
      real(dp), intent(in) :: states(:, :)
      !> z'' [m/s2]
      real(dp), intent(out) :: accelerations(:)
      real(dp) :: force(samples_per_period)
      integer :: before, count

      call force_of_period(problem%force, force)
      call net_loads(problem, states, accelerations)
      do before = 0, size(accelerations) - 1, samples_per_period
         count = min(samples_per_period, size(accelerations) - before)
         accelerations(before + 1:before + count) = (accelerations(before + 1:before + count) - problem%weight - force(:count)) &
                                                    /problem%mass
      end do
   end subroutine accelerations_of_samples

   !> Film that one of each number of a state counts as, in its neighbourhood.
   pure function counts_as(problem, state) result(scale)
      type(problem_t), intent(in) :: problem
      !> Its numbers
      real(dp), intent(in) :: state(:)
      real(dp) :: scale(size(state))
      type(state_number_t), allocatable :: numbers(:)
      integer :: first, i

      scale = 1.0_dp
      scale(of_velocity) = 1.0_dp/(two_pi*problem%frequency)
      first = of_drive_compression + compression_count(problem)
      ! A stiff tooth is compressed by far less than its film: by what the forces compress it.
      if (has_elastic_teeth(problem)) scale(of_drive_compression:first - 1) = max(1.0_dp, thinnest_film(problem, state)/ &
         (problem%contact%compliance*(abs(static_load(problem)) + largest_oscillation(problem%force) + least_static_load)))
      if (size(state) < first) return
      numbers = state_numbers(problem)
      scale(first:) = [(numbers(i)%counts_as, i=first, size(state))]
   end function counts_as

   !> What the numbers of a state count as, each in its unit. The map of a period is known to a share of each number: where a tooth
   !> impacts through a thin film, to more than that of the film.
   pure function sizes_of_state(problem, state, scale) result(sizes)
      type(problem_t), intent(in) :: problem
      !> Its numbers
      real(dp), intent(in) :: state(:)
      !> As of counts_as, of this state or one near it
      real(dp), intent(in) :: scale(:)
      real(dp) :: sizes(size(state)), thickness
      !> Largest size of a compression that stays positive, over the compression
      real(dp), parameter :: most_of_compression = 100.0_dp
      integer :: last

      thickness = thinnest_film(problem, state)
      sizes = max(thickness/scale, abs(state))
      sizes(of_film) = thickness
      ! A film that never pulls leaves its spring compressed, however little; so must the states beside this one be.
      last = of_velocity + compression_count(problem)
      if (carries_positive_loads(problem%contact)) &
         sizes(of_drive_compression:last) = min(sizes(of_drive_compression:last), &
                                                most_of_compression*abs(state(of_drive_compression:last)))
   end function sizes_of_state

end module carried_loads
