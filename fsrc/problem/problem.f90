!> What moves: a film, a force and a mass, eq (1): m z'' = W(h, z') - F(t) - m g.
module problem
   use film_law, only: film_load, film_loads, film_t, new_film, steady_film
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

   public :: problem_of, static_load, rest_film, reference_film, linearise, settling_of, acceleration_at, accelerations_of_samples

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
      problem%initial_film = scene%film%initial_film
      if (.not. problem%initial_film > 0.0_dp) problem%initial_film = steady_film(problem%film, scene%load%static_load())
      problem%initial_velocity = scene%film%initial_velocity
   end function problem_of

   !> Static load Q + m g [N].
   elemental real(dp) function static_load(problem)
      type(problem_t), intent(in) :: problem

      static_load = problem%force%steady + problem%weight
   end function static_load

   !> Film that carries the static load [m], 0 where none does.
   elemental real(dp) function rest_film(problem)
      type(problem_t), intent(in) :: problem

      rest_film = 0.0_dp
      if (static_load(problem) > 0.0_dp) rest_film = steady_film(problem%film, static_load(problem))
   end function rest_film

   !> Film that carries the static load, or the first film where there is none [m].
   elemental real(dp) function reference_film(problem)
      type(problem_t), intent(in) :: problem

      reference_film = rest_film(problem)
      if (.not. reference_film > 0.0_dp) reference_film = problem%initial_film
   end function reference_film

   !> Stiffness -dW/dh [N/m] and damping -dW/dz' [N s/m] of a film without squeeze velocity.
   pure subroutine linearise(problem, thickness, stiffness, damping)
      type(problem_t), intent(in) :: problem
      !> Film thickness h [m]
      real(dp), intent(in) :: thickness
      real(dp), intent(out) :: stiffness
      real(dp), intent(out) :: damping
      real(dp) :: load, load_by_film, load_by_velocity

      call film_load(problem%film, thickness, 0.0_dp, load, load_by_film, load_by_velocity)
      stiffness = -load_by_film
      damping = -load_by_velocity
   end subroutine linearise

   !> How the film settles by its law alone, without watching it. Its rate is that of a thinner film at rest if it is there: a tooth
   !> in flight does not settle, nor is its motion small.
   pure type(settling_t) function settling_of(problem, thickness, rest_thickness)
      type(problem_t), intent(in) :: problem
      !> Film thickness h [m]
      real(dp), intent(in) :: thickness
      !> Film at rest, near enough [m]
      real(dp), intent(in) :: rest_thickness
      type(settling_t) :: rest

      settling_of = settling_about(problem, thickness)
      if (.not. thickness > rest_thickness) return
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

      call film_load(problem%film, film, velocity, load, load_by_film, load_by_velocity)
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
      call film_loads(problem%film, films, velocities, accelerations)
      do before = 0, size(films) - 1, samples_per_period
         count = min(samples_per_period, size(films) - before)
         accelerations(before + 1:before + count) = (accelerations(before + 1:before + count) - problem%weight - force(:count)) &
                                                    /problem%mass
      end do
   end subroutine accelerations_of_samples

end module problem
