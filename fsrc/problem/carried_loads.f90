!> What a state of a motion carries: the loads of both films and of the springs, their films, their largest pressures, and the
!> acceleration that is left for the mass.
module carried_loads
   use film_law, only: film_kernel, film_load, film_loads, overflow_load, squeeze_velocity
   use film_pressure, only: exact_pressures
   use force, only: force_at, force_of_period
   use kinds, only: dp
   use problem, only: has_elastic_teeth, has_two_flanks, of_coast_compression, of_drive_compression, of_film, of_velocity, &
      problem_t, state_size
   use squeeze_of_load, only: load_carried
   implicit none(type, external)
   private

   public :: thinnest_film, net_load, net_loads, drive_loads, coast_loads, coast_films, films_of, gear_positions, &
             initial_state, spring_loads, load_springs, largest_pressures, acceleration_at, accelerations_of_samples

contains

   !> The thinner one of the films of both flanks in a state [m].
   pure real(dp) function thinnest_film(problem, state)
      type(problem_t), intent(in) :: problem
      !> Its numbers
      real(dp), intent(in) :: state(:)
      real(dp) :: coast(1)

      thinnest_film = state(of_film)
      if (.not. has_two_flanks(problem)) return
      coast = coast_films(problem, reshape(state, [1, size(state)]))
      thinnest_film = min(thinnest_film, coast(1))
   end function thinnest_film

   !> Net load of both films and its slopes.
   pure subroutine net_load(problem, thickness, velocity, load, load_by_film, load_by_velocity, kernel)
      type(problem_t), intent(in) :: problem
      !> Film thickness h > 0 [m]
      real(dp), intent(in) :: thickness
      !> Film velocity z' [m/s]
      real(dp), intent(in) :: velocity
      !> W(h, z') - W(b - h, -z') [N]; beyond `overflow_load` where one of the films has none
      real(dp), intent(out) :: load
      !> Its slopes [N/m], [N s/m]
      real(dp), intent(out) :: load_by_film
      real(dp), intent(out) :: load_by_velocity
      !> Kernel of the film, where it has been chosen before
      procedure(film_kernel), optional :: kernel
      real(dp) :: coast, coast_load, coast_by_film, coast_by_velocity

      if (present(kernel)) then
         call kernel(problem%film, thickness, velocity, load, load_by_film, load_by_velocity)
      else
         call film_load(problem%film, thickness, velocity, load, load_by_film, load_by_velocity)
      end if
      if (.not. has_two_flanks(problem)) return
      if (.not. abs(load) < overflow_load) return
      coast = problem%backlash - thickness
      coast_load = 2.0_dp*overflow_load
      if (coast > 0.0_dp) call film_load(problem%film, coast, -velocity, coast_load, coast_by_film, coast_by_velocity)
      if (abs(coast_load) < overflow_load) then
         load = load - coast_load
         load_by_film = load_by_film + coast_by_film
         load_by_velocity = load_by_velocity + coast_by_velocity
      else
         load = 2.0_dp*overflow_load
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

   !> Loads of the drive film.
   pure subroutine drive_loads(problem, states, loads)
      type(problem_t), intent(in) :: problem
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      !> [N]
      real(dp), intent(out) :: loads(:)

      if (has_elastic_teeth(problem)) then
         loads = states(:, of_drive_compression)/problem%compliance
      else
         call film_loads(problem%film, states(:, of_film), states(:, of_velocity), loads)
      end if
   end subroutine drive_loads

   !> Loads of the coast film, 0 where there is one flank.
   pure subroutine coast_loads(problem, states, loads)
      type(problem_t), intent(in) :: problem
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      !> [N]
      real(dp), intent(out) :: loads(:)

      loads = 0.0_dp
      if (.not. has_two_flanks(problem)) return
      if (has_elastic_teeth(problem)) then
         loads = states(:, of_coast_compression)/problem%compliance
      else
         call film_loads(problem%film, problem%backlash - states(:, of_film), -states(:, of_velocity), loads)
      end if
   end subroutine coast_loads

   !> Films of the coast flank [m].
   pure function coast_films(problem, states) result(films)
      !> With two flanks
      type(problem_t), intent(in) :: problem
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      real(dp) :: films(size(states, 1))

      films = problem%backlash - states(:, of_film)
      if (has_elastic_teeth(problem)) films = films + (states(:, of_drive_compression) + states(:, of_coast_compression))
   end function coast_films

   !> Films of one flank or of both [m].
   pure function films_of(problem, states) result(films)
      type(problem_t), intent(in) :: problem
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      !> State, flank
      real(dp), allocatable :: films(:, :)

      allocate (films(size(states, 1), merge(2, 1, has_two_flanks(problem))))
      films(:, 1) = states(:, of_film)
      if (has_two_flanks(problem)) films(:, 2) = coast_films(problem, states)
   end function films_of

   !> Positions of the gear [m]: with rigid teeth the film of the drive flank.
   pure function gear_positions(problem, states) result(positions)
      type(problem_t), intent(in) :: problem
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      real(dp) :: positions(size(states, 1))

      positions = states(:, of_film)
      if (has_elastic_teeth(problem)) positions = positions - states(:, of_drive_compression)
   end function gear_positions

   !> State in which the motion of a problem starts.
   pure function initial_state(problem) result(state)
      type(problem_t), intent(in) :: problem
      real(dp) :: state(state_size(problem))
      real(dp) :: compression(2)

      state = 0.0_dp
      state(of_film) = problem%initial_film
      state(of_velocity) = problem%initial_velocity
      if (.not. (has_elastic_teeth(problem) .and. problem%initial_film > 0.0_dp)) return
      call start_springs(problem, compression)
      state(of_drive_compression:) = compression(:size(state) - of_velocity)
   end function initial_state

   !> Loads of the springs in a state [N]: none where teeth are rigid.
   pure function spring_loads(problem, state) result(loads)
      type(problem_t), intent(in) :: problem
      !> Its numbers
      real(dp), intent(in) :: state(:)
      real(dp), allocatable :: loads(:)

      loads = state(of_drive_compression:)/problem%compliance
   end function spring_loads

   !> Compress the springs of a state by loads; a spring without one is not compressed.
   pure subroutine load_springs(problem, loads, state)
      type(problem_t), intent(in) :: problem
      !> As of spring_loads [N]
      real(dp), intent(in) :: loads(:)
      !> Its numbers
      real(dp), intent(inout) :: state(:)
      integer :: n

      n = min(size(loads), size(state) - of_velocity)
      state(of_drive_compression:) = 0.0_dp
      state(of_drive_compression:of_velocity + n) = problem%compliance*loads(:n)
   end subroutine load_springs

   !> Compressions of the springs at the start: the drive film carries the first one at the velocity of the gear, the coast film,
   !> whose gap grows by both, the other.
   pure subroutine start_springs(problem, compression)
      type(problem_t), intent(in) :: problem
      !> d_1 and d_2 [m]
      real(dp), intent(out) :: compression(2)
      real(dp) :: load, by_film, by_velocity, low, high, gap, coast_load
      integer :: pass
      integer, parameter :: most_passes = 200
      real(dp), parameter :: thinnest = 1.0e-16_dp

      compression = 0.0_dp
      call film_load(problem%film, problem%initial_film, problem%initial_velocity, load, by_film, by_velocity)
      if (.not. abs(load) < overflow_load) return
      compression(1) = problem%compliance*load
      if (.not. has_two_flanks(problem)) return
      ! The gap is what backlash and drive film leave, and what the spring of the coast flank gives: its load falls as it grows.
      low = max(problem%backlash - problem%initial_film + compression(1), thinnest)
      high = huge(1.0_dp)
      gap = low
      do pass = 1, most_passes
         call film_load(problem%film, gap, -problem%initial_velocity, coast_load, by_film, by_velocity)
         if (gap - problem%compliance*coast_load > problem%backlash - problem%initial_film + compression(1)) then
            high = gap
         else
            low = gap
         end if
         if (high < huge(1.0_dp)) then
            if (.not. (0.5_dp*(low + high) > low .and. 0.5_dp*(low + high) < high)) exit
            gap = 0.5_dp*(low + high)
         else
            gap = 2.0_dp*gap
         end if
      end do
      call film_load(problem%film, gap, -problem%initial_velocity, coast_load, by_film, by_velocity)
      compression(2) = problem%compliance*coast_load
   end subroutine start_springs

   !> Largest pressures of the Reynolds iso-viscous film, on the flank where they are larger.
   pure subroutine largest_pressures(problem, states, pressures)
      type(problem_t), intent(in) :: problem
      !> State, number of it
      real(dp), intent(in) :: states(:, :)
      !> [Pa]
      real(dp), intent(out) :: pressures(:)

      associate (film => problem%film)
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
      real(dp) :: velocity, by_film, by_load
      integer :: outcome, i

      do i = 1, size(films)
         call squeeze_velocity(problem%film, films(i), compressions(i)/problem%compliance, velocities(i), velocity, by_film, &
                               by_load, outcome)
         if (outcome == load_carried) velocities(i) = velocity
      end do
   end subroutine film_velocities

   !> z'' at a state and phase [m/s2].
   pure real(dp) function acceleration_at(problem, state, phase)
      type(problem_t), intent(in) :: problem
      !> Its numbers
      real(dp), intent(in) :: state(:)
      !> Of the force, from 0 to 1 [periods]
      real(dp), intent(in) :: phase
      real(dp) :: load(1), load_by_film, load_by_velocity

      if (has_elastic_teeth(problem)) then
         call net_loads(problem, reshape(state, [1, size(state)]), load)
      else
         call net_load(problem, state(of_film), state(of_velocity), load(1), load_by_film, load_by_velocity)
      end if
      acceleration_at = (load(1) - problem%weight - force_at(problem%force, phase))/problem%mass
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

end module carried_loads
