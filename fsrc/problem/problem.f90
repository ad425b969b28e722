!> What moves: a mass under a force, between two flanks that both carry a film of the same law,
!>
!>     m z'' = W(h, z') - W(b - h, -z') - F(t) - m g ,   0 < h < b .
!>
!> h is the film of the drive flank, b - h that of the coast flank, b the backlash. Without a backlash there is no coast flank and
!> this is (1). What both films carry together is called the net load.
module problem
   use film_pressure, only: exact_pressures
   use film_law, only: film_kernel, film_load, film_loads, film_t, new_film, overflow_load, steady_film
   use force, only: force_at, force_of, force_of_period, force_t
   use kinds, only: dp
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
      !> Frequency f_exc [Hz]; a start of the force's period is the start of the motion
      real(dp) :: frequency = 0.0_dp
      !> h [m] and z' [m/s] at the start; no film: there is none that carries the static load
      real(dp) :: initial_film = 0.0_dp
      real(dp) :: initial_velocity = 0.0_dp
   end type problem_t

   !> The film in the neighbourhood of rest, h'' + d h' + k h = 0 with the period of the force as the unit of time.
   type, public :: settling_t
      !> Stiffness k [1/periods^2]
      real(dp) :: stiffness = huge(1.0_dp)
      !> Damping d, 0 where the momentum of the motion holds it [1/periods]
      real(dp) :: damping = 0.0_dp
      !> Smaller one of the rates at which it creeps, or turns and swings [1/periods]
      real(dp) :: rate = huge(1.0_dp)
   end type settling_t

   public :: problem_of, has_two_flanks, thinner_film, static_load, rest_film, film_at_rest, reference_film, linearise, &
             settling_of, net_load, net_loads, drive_loads, coast_loads, largest_pressures, acceleration_at, &
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

   !> The thinner one of the films of both flanks [m].
   elemental real(dp) function thinner_film(problem, film)
      type(problem_t), intent(in) :: problem
      !> Film of the drive flank h [m]
      real(dp), intent(in) :: film

      thinner_film = min(film, problem%backlash - film)
   end function thinner_film

   !> Film at rest under the static load [m], 0 where there is none.
   elemental real(dp) function rest_film(problem)
      type(problem_t), intent(in) :: problem

      rest_film = film_at_rest(problem, static_load(problem))
   end function rest_film

   !> Film at rest under a load [m], 0 where there is none.
   elemental real(dp) function film_at_rest(problem, load) result(film)
      type(problem_t), intent(in) :: problem
      !> Q + m g [N]
      real(dp), intent(in) :: load

      film = 0.0_dp
      if (has_two_flanks(problem)) then
         film = film_between_flanks(problem, load)
      else if (load > 0.0_dp) then
         film = steady_film(problem%film, load)
      end if
   end function film_at_rest

   !> Where a tooth rests between its flanks: the one root of W(h, 0) - W(b - h, 0) = Q + m g, as the left side falls from
   !> infinity to minus infinity. Newton's method in x = ln(h/(b - h)), in which both films keep their digits, within a bracket
   !> that is halved where it leaves it. A film too thin for its law counts as one that carries more than any load.
   pure real(dp) function film_between_flanks(problem, load) result(film)
      type(problem_t), intent(in) :: problem
      !> Q + m g [N]
      real(dp), intent(in) :: load
      integer, parameter :: most_passes = 200
      !> Films of 1e-35 of the backlash
      real(dp), parameter :: widest = 80.0_dp
      !> Share of the load by which no root of rounded numbers misses it
      real(dp), parameter :: lost_load = 1.0e-4_dp
      real(dp) :: low, high, x, drive, coast, drive_load, coast_load, drive_slope, coast_slope, by_velocity, excess, next
      integer :: pass

      low = -widest
      high = widest
      x = 0.0_dp
      do pass = 1, most_passes
         drive = problem%backlash/(1.0_dp + exp(-x))
         coast = problem%backlash/(1.0_dp + exp(x))
         call film_load(problem%film, drive, 0.0_dp, drive_load, drive_slope, by_velocity)
         call film_load(problem%film, coast, 0.0_dp, coast_load, coast_slope, by_velocity)
         if (abs(drive_load) < overflow_load .and. abs(coast_load) < overflow_load) then
            excess = (drive_load - coast_load) - load
            next = x - excess/((drive_slope + coast_slope)*(drive*coast/problem%backlash))
         else
            ! No film on both sides: the backlash is too narrow for the law, at any load.
            film = 0.0_dp
            if (.not. (abs(drive_load) < overflow_load .or. abs(coast_load) < overflow_load)) return
            excess = merge(1.0_dp, -1.0_dp, abs(coast_load) < overflow_load)
            next = huge(1.0_dp)
         end if
         film = drive
         if (excess > 0.0_dp) low = x
         if (excess < 0.0_dp) high = x
         if (.not. (next > low .and. next < high)) next = 0.5_dp*(low + high)
         if (abs(next - x) <= 2.0_dp*epsilon(1.0_dp)*max(1.0_dp, abs(x))) exit
         x = next
      end do
      ! Near the thinnest film that a law has its load is bounded but its slope is not. A bracket that has closed there, and not upon
      ! the load, has found that no film carries it.
      if (.not. (abs(drive_load) < overflow_load .and. abs(coast_load) < overflow_load)) film = 0.0_dp
      if (film > 0.0_dp .and. abs(excess) > lost_load*(drive_load + coast_load + abs(load))) film = 0.0_dp
   end function film_between_flanks

   !> The thinner film at rest, or the first one where there is none [m].
   elemental real(dp) function reference_film(problem)
      type(problem_t), intent(in) :: problem

      reference_film = rest_film(problem)
      if (.not. reference_film > 0.0_dp) reference_film = problem%initial_film
      reference_film = thinner_film(problem, reference_film)
   end function reference_film

   !> Stiffness -dW/dh [N/m] and damping -dW/dz' [N s/m] of the net load without squeeze velocity.
   pure subroutine linearise(problem, thickness, stiffness, damping)
      type(problem_t), intent(in) :: problem
      !> Film thickness h [m]
      real(dp), intent(in) :: thickness
      real(dp), intent(out) :: stiffness
      real(dp), intent(out) :: damping
      real(dp) :: load, load_by_film, load_by_velocity

      call net_load(problem, thickness, 0.0_dp, load, load_by_film, load_by_velocity)
      stiffness = -load_by_film
      damping = -load_by_velocity
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
   pure subroutine net_loads(problem, films, velocities, loads)
      type(problem_t), intent(in) :: problem
      !> h [m] and z' [m/s]
      real(dp), intent(in) :: films(:)
      real(dp), intent(in) :: velocities(:)
      !> [N]
      real(dp), intent(out) :: loads(:)
      real(dp) :: coast(size(films))

      call film_loads(problem%film, films, velocities, loads)
      if (.not. has_two_flanks(problem)) return
      call coast_loads(problem, films, velocities, coast)
      loads = loads - coast
   end subroutine net_loads

   !> Loads of the drive film.
   pure subroutine drive_loads(problem, films, velocities, loads)
      type(problem_t), intent(in) :: problem
      !> h [m] and z' [m/s]
      real(dp), intent(in) :: films(:)
      real(dp), intent(in) :: velocities(:)
      !> [N]
      real(dp), intent(out) :: loads(:)

      call film_loads(problem%film, films, velocities, loads)
   end subroutine drive_loads

   !> Loads of the coast film, 0 where there is one flank.
   pure subroutine coast_loads(problem, films, velocities, loads)
      type(problem_t), intent(in) :: problem
      !> Of the drive film: h [m] and z' [m/s]
      real(dp), intent(in) :: films(:)
      real(dp), intent(in) :: velocities(:)
      !> [N]
      real(dp), intent(out) :: loads(:)

      loads = 0.0_dp
      if (has_two_flanks(problem)) call film_loads(problem%film, problem%backlash - films, -velocities, loads)
   end subroutine coast_loads

   !> Largest pressures of the exact iso-viscous film, on the flank where they are larger.
   pure subroutine largest_pressures(problem, films, velocities, pressures)
      type(problem_t), intent(in) :: problem
      !> Of the drive film: h [m] and z' [m/s]
      real(dp), intent(in) :: films(:)
      real(dp), intent(in) :: velocities(:)
      !> [Pa]
      real(dp), intent(out) :: pressures(:)
      real(dp) :: coast(size(films))

      associate (film => problem%film)
         call exact_pressures(film%radius, film%speed, film%viscosity, films, velocities, pressures)
         if (.not. has_two_flanks(problem)) return
         call exact_pressures(film%radius, film%speed, film%viscosity, problem%backlash - films, -velocities, coast)
         pressures = max(pressures, coast)
      end associate
   end subroutine largest_pressures

   !> How the film settles by its law alone, without watching it. Its rate is that of a thinner film at rest if it is there: a tooth
   !> in flight does not settle, nor is its motion small.
   pure type(settling_t) function settling_of(problem, thickness, rest_thickness)
      type(problem_t), intent(in) :: problem
      !> Film thickness h [m]
      real(dp), intent(in) :: thickness
      !> Film at rest, near enough; either flank will do [m]
      real(dp), intent(in) :: rest_thickness
      type(settling_t) :: rest

      settling_of = settling_about(problem, thickness)
      if (.not. thinner_film(problem, thickness) > thinner_film(problem, rest_thickness)) return
      rest = settling_about(problem, rest_thickness)
      settling_of%rate = max(settling_of%rate, rest%rate)
   end function settling_of

   !> Settling about one film.
   pure type(settling_t) function settling_about(problem, thickness) result(settling)
      type(problem_t), intent(in) :: problem
      real(dp), intent(in) :: thickness
      real(dp) :: stiffness, damping, discriminant

      call linearise(problem, thickness, stiffness, damping)
      associate (d => settling%damping, k => settling%stiffness)
         d = damping/(problem%mass*problem%frequency)
         k = stiffness/(problem%mass*problem%frequency*problem%frequency)
         discriminant = d*d - 4.0_dp*k
         settling%rate = sqrt(abs(k))
         if (discriminant > 0.0_dp) settling%rate = 2.0_dp*k/(d + sqrt(discriminant))
      end associate
   end function settling_about

   !> z'' at a state and phase [m/s2].
   elemental real(dp) function acceleration_at(problem, film, velocity, phase)
      type(problem_t), intent(in) :: problem
      !> h [m] and z' [m/s]
      real(dp), intent(in) :: film
      real(dp), intent(in) :: velocity
      !> Of the force, from 0 to 1 [periods]
      real(dp), intent(in) :: phase
      real(dp) :: load, load_by_film, load_by_velocity

      call net_load(problem, film, velocity, load, load_by_film, load_by_velocity)
      acceleration_at = (load - problem%weight - force_at(problem%force, phase))/problem%mass
   end function acceleration_at

   !> z'' of the samples of a motion, of which film and velocity are known.
   pure subroutine accelerations_of_samples(problem, samples_per_period, films, velocities, accelerations)
      type(problem_t), intent(in) :: problem
      !> Samples of a period
      integer, intent(in) :: samples_per_period
      !> h [m], from the first sample of a period on
      real(dp), intent(in) :: films(:)
      !> z' [m/s]
      real(dp), intent(in) :: velocities(:)
      !> z'' [m/s2]
      real(dp), intent(out) :: accelerations(:)
      real(dp) :: force(samples_per_period)
      integer :: before, count

      call force_of_period(problem%force, force)
      call net_loads(problem, films, velocities, accelerations)
      do before = 0, size(films) - 1, samples_per_period
         count = min(samples_per_period, size(films) - before)
         accelerations(before + 1:before + count) = (accelerations(before + 1:before + count) - problem%weight - force(:count)) &
                                                    /problem%mass
      end do
   end subroutine accelerations_of_samples

end module problem
