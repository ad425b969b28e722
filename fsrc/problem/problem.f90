!> What moves: a mass under a force, between two flanks that both carry a film of the same law,
!>
!>     m z'' = W(h, z') - W(b - h, -z') - F(t) - m g ,   0 < h < b .
!>
!> h is the film of the drive flank, b - h that of the coast flank, b the backlash. Without a backlash there is no coast flank and
!> this is (1). What both films carry together is called the net load.
!>
!> Teeth may give: a spring stands between the gear at z and each film, and its compression is the film's load,
!>
!>     W(h_1, h_1') = d_1/kappa ,   d_1 = h_1 - z ,      W(h_2, h_2') = d_2/kappa ,   d_2 = h_2 - (b - z) ,
!>     m z'' = (d_1 - d_2)/kappa - F(t) - m g .
!>
!> The state of a motion is h_1 and z', with teeth that give also d_1, and d_2 where there are two flanks: a compression keeps its
!> digits however stiff the tooth is, a position would not.
module problem
   use film_pressure, only: exact_pressures
   use film_law, only: film_kernel, film_load, film_loads, film_t, new_film, overflow_load, squeeze_velocity, steady_film
   use force, only: force_at, force_of, force_of_period, force_t
   use kinds, only: dp
   use squeeze_of_load, only: load_carried
   use scene_types, only: scene_t
   implicit none(type, external)
   private

   !> What moves, and where it starts.
   type, public :: problem_t
      type(film_t) :: film = film_t()
      type(force_t) :: force = force_t()
      !> Mass m [kg] and weight m g [N]
      real(dp) :: mass = 0.0_dp
      real(dp) :: weight = 0.0_dp
      !> Backlash b [m]; huge: there is one flank
      real(dp) :: backlash = huge(1.0_dp)
      !> Compliance of a tooth kappa [m/N]; 0: rigid
      real(dp) :: compliance = 0.0_dp
      !> Frequency f_exc [Hz]; a start of the force's period is the start of the motion
      real(dp) :: frequency = 0.0_dp
      !> h [m] and z' [m/s] at the start; no film: there is none that carries the static load
      real(dp) :: initial_film = 0.0_dp
      real(dp) :: initial_velocity = 0.0_dp
   end type problem_t

   !> Numbers of a state and their most: film of the drive flank h_1 [m], velocity z' [m/s], compressions d_1 and d_2 [m].
   integer, parameter, public :: of_film = 1, of_velocity = 2, of_drive_compression = 3, of_coast_compression = 4, largest_state = 4

   !> The film in the neighbourhood of rest, h'' + d h' + k h = 0 with the period of the force as the unit of time.
   type, public :: settling_t
      !> Stiffness k [1/periods^2]
      real(dp) :: stiffness = huge(1.0_dp)
      !> Damping d, 0 where the momentum of the motion holds it [1/periods]
      real(dp) :: damping = 0.0_dp
      !> Smaller one of the rates at which it creeps, or turns and swings [1/periods]
      real(dp) :: rate = huge(1.0_dp)
   end type settling_t

   public :: problem_of, has_two_flanks, has_elastic_teeth, state_size, static_load, film_at_rest, films_at_rest, loads_at_rest, &
             reference_films, reference_film, thinner_film, thinnest_film, start_springs, linearise, settling_of, net_load, &
             net_loads, drive_loads, coast_loads, coast_films, films_of, gear_positions, largest_pressures, acceleration_at, &
             accelerations_of_samples

contains

   !> The problem of a scene. Without an initial film it starts from the steady one.
   pure type(problem_t) function problem_of(scene) result(problem)
      !> Checked scene
      type(scene_t), intent(in) :: scene

      problem%film = new_film(scene)
      problem%force = force_of(scene%load)
      problem%mass = scene%load%mass
      problem%weight = scene%load%weight()
      problem%frequency = scene%load%frequency
      if (scene%contact%backlash > 0.0_dp) problem%backlash = scene%contact%backlash
      if (scene%contact%stiffness > 0.0_dp) problem%compliance = 1.0_dp/scene%contact%stiffness
      problem%initial_film = scene%film%initial_film
      if (.not. problem%initial_film > 0.0_dp) problem%initial_film = film_at_rest(problem, scene%load%static_load())
      problem%initial_velocity = scene%film%initial_velocity
   end function problem_of

   !> Static load Q + m g [N].
   elemental real(dp) function static_load(problem)
      type(problem_t), intent(in) :: problem

      static_load = problem%force%steady + problem%weight
   end function static_load

   !> Whether there is a coast flank.
   elemental logical function has_two_flanks(problem)
      type(problem_t), intent(in) :: problem

      has_two_flanks = problem%backlash < huge(1.0_dp)
   end function has_two_flanks

   !> Whether the teeth give.
   elemental logical function has_elastic_teeth(problem)
      type(problem_t), intent(in) :: problem

      has_elastic_teeth = problem%compliance > 0.0_dp
   end function has_elastic_teeth

   !> How many numbers a state has.
   elemental integer function state_size(problem)
      type(problem_t), intent(in) :: problem

      state_size = 2
      if (has_elastic_teeth(problem)) state_size = merge(4, 3, has_two_flanks(problem))
   end function state_size

   !> The thinner one of the films of both flanks, of rigid teeth [m].
   elemental real(dp) function thinner_film(problem, film)
      type(problem_t), intent(in) :: problem
      !> Film of the drive flank h [m]
      real(dp), intent(in) :: film

      thinner_film = min(film, problem%backlash - film)
   end function thinner_film

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

   !> Film of the drive flank at rest under a load [m], 0 where there is none.
   elemental real(dp) function film_at_rest(problem, load) result(film)
      type(problem_t), intent(in) :: problem
      !> Q + m g [N]
      real(dp), intent(in) :: load
      real(dp) :: films(2)

      films = films_at_rest(problem, load)
      film = films(1)
   end function film_at_rest

   !> Films of drive and coast flank at rest under a load [m]: 0 where there are none, the second huge where there is one flank.
   pure function films_at_rest(problem, load) result(films)
      type(problem_t), intent(in) :: problem
      !> Q + m g [N]
      real(dp), intent(in) :: load
      real(dp) :: films(2), loads(2)

      films = 0.0_dp
      if (has_two_flanks(problem)) then
         call loads_at_rest(problem, load, loads(1), loads(2))
         if (loads(1) > 0.0_dp) films = [steady_film(problem%film, loads(1)), steady_film(problem%film, loads(2))]
      else if (load > 0.0_dp) then
         films = [steady_film(problem%film, load), huge(1.0_dp)]
      end if
   end function films_at_rest

   !> Loads of both films of a tooth that rests between its flanks under a load. Their difference is that load, and the films that
   !> carry them fill the backlash and what both springs give,
   !>
   !>     h(W_1) + h(W_2) - kappa (W_1 + W_2) = b ,      W_1 - W_2 = Q + m g .
   !>
   !> The left side falls with the smaller one of both loads, whose logarithm is found by bisection: so both films have all their
   !> digits. Loads that are too large for their films count as films of no thickness.
   pure subroutine loads_at_rest(problem, load, drive_load, coast_load)
      !> With two flanks
      type(problem_t), intent(in) :: problem
      !> Q + m g [N]
      real(dp), intent(in) :: load
      !> W_1 and W_2 [N], both 0 where no films carry them
      real(dp), intent(out) :: drive_load
      real(dp), intent(out) :: coast_load
      !> Logarithms of loads between which the smaller one lies
      real(dp), parameter :: least = -200.0_dp, most = 80.0_dp
      !> Share of the backlash by which no root of rounded numbers misses it
      real(dp), parameter :: missed = 1.0e-6_dp
      real(dp) :: low, high, middle, smaller, larger, thick, thin, excess

      low = least
      high = most
      do
         middle = 0.5_dp*(low + high)
         smaller = exp(middle)
         larger = smaller + abs(load)
         thin = steady_film(problem%film, larger)
         thick = steady_film(problem%film, smaller)
         excess = thick + thin - problem%compliance*(smaller + larger) - problem%backlash
         if (.not. thin > 0.0_dp) excess = -problem%backlash
         if (.not. (middle > low .and. middle < high)) exit
         if (excess > 0.0_dp) then
            low = middle
         else
            high = middle
         end if
      end do
      ! The bracket may have closed upon the largest load that films of the law carry, or where none carries the load at all, and
      ! not upon the backlash.
      if (.not. thin > 0.0_dp .or. abs(excess) > missed*(problem%backlash + thick)) then
         smaller = 0.0_dp
         larger = 0.0_dp
      end if
      drive_load = merge(larger, smaller, load > 0.0_dp)
      coast_load = merge(smaller, larger, load > 0.0_dp)
   end subroutine loads_at_rest

   !> Films of drive and coast flank at rest under the static load, or where there are none about those of the start [m].
   pure function reference_films(problem) result(films)
      type(problem_t), intent(in) :: problem
      real(dp) :: films(2)

      films = films_at_rest(problem, static_load(problem))
      if (films(1) > 0.0_dp) return
      films = [problem%initial_film, problem%backlash - problem%initial_film]
      ! Teeth that give let a film grow beyond the backlash.
      if (.not. films(2) > 0.0_dp) films(2) = films(1)
   end function reference_films

   !> The thinner one of them [m].
   elemental real(dp) function reference_film(problem)
      type(problem_t), intent(in) :: problem

      reference_film = minval(reference_films(problem))
   end function reference_film

   !> Stiffness [N/m] and damping [N s/m] against slow motions of the gear: of each film -dW/dh and -dW/dh' without squeeze
   !> velocity, where teeth give in series with its spring.
   pure subroutine linearise(problem, films, stiffness, damping)
      type(problem_t), intent(in) :: problem
      !> Films of drive and coast flank [m]
      real(dp), intent(in) :: films(2)
      real(dp), intent(out) :: stiffness
      real(dp), intent(out) :: damping
      real(dp) :: load, by_film, by_velocity, share
      integer :: flank

      stiffness = 0.0_dp
      damping = 0.0_dp
      do flank = 1, merge(2, 1, has_two_flanks(problem))
         call film_load(problem%film, films(flank), 0.0_dp, load, by_film, by_velocity)
         ! What of the gear's way the film takes; the spring takes the rest.
         share = 1.0_dp
         if (has_elastic_teeth(problem)) share = 1.0_dp/(1.0_dp - problem%compliance*by_film)
         stiffness = stiffness - by_film*share
         damping = damping - by_velocity*share*share
      end do
   end subroutine linearise

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

   !> Largest pressures of the exact iso-viscous film, on the flank where they are larger.
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
         call squeeze_velocity(problem%film, films(i), compressions(i)/problem%compliance, velocity, by_film, by_load, outcome)
         if (outcome == load_carried) velocities(i) = velocity
      end do
   end subroutine film_velocities

   !> How the film settles by its law alone, without watching it. Its rate is that of a thinner film at rest if it is there: a tooth
   !> in flight does not settle, nor is its motion small.
   pure type(settling_t) function settling_of(problem, films, rest_films)
      type(problem_t), intent(in) :: problem
      !> Films of drive and coast flank, and those at rest, near enough [m]
      real(dp), intent(in) :: films(2)
      real(dp), intent(in) :: rest_films(2)
      type(settling_t) :: rest

      settling_of = settling_about(problem, films)
      if (.not. minval(films) > minval(rest_films)) return
      rest = settling_about(problem, rest_films)
      settling_of%rate = max(settling_of%rate, rest%rate)
   end function settling_of

   !> Settling about some films.
   pure type(settling_t) function settling_about(problem, films) result(settling)
      type(problem_t), intent(in) :: problem
      real(dp), intent(in) :: films(2)
      real(dp) :: stiffness, damping, discriminant

      call linearise(problem, films, stiffness, damping)
      associate (d => settling%damping, k => settling%stiffness)
         d = damping/(problem%mass*problem%frequency)
         k = stiffness/(problem%mass*problem%frequency*problem%frequency)
         discriminant = d*d - 4.0_dp*k
         settling%rate = sqrt(abs(k))
         if (discriminant > 0.0_dp) settling%rate = 2.0_dp*k/(d + sqrt(discriminant))
      end associate
   end function settling_about

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

end module problem
