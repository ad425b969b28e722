!> A scene with all that follows from it before anything is solved.
module resolved_scene
   use constants, only: two_pi
   use film_law, only: film_load, film_t, new_film, steady_film
   use film_pressure, only: pressure_scale
   use kinds, only: dp
   use regime_check, only: steady_alpha_p
   use rupture, only: squeeze_group
   use scene_types, only: scene_t
   implicit none(type, external)
   private

   !> What follows from a scene.
   type, public :: resolved_scene_t
      type(film_t) :: film
      !> Film that carries Q + m g [m]; 0 where no rigid film does: then nothing that rests on it is known
      real(dp) :: steady_film = 0.0_dp
      !> Film at t = 0 [m]
      real(dp) :: initial_film = 0.0_dp
      !> sqrt(k/m)/(2 pi) and c/(2 sqrt(k m)) with the total derivatives of the scene's own film
      real(dp) :: natural_frequency = 0.0_dp
      real(dp) :: damping_ratio = 0.0_dp
      !> Squeeze group A at t = 0 [-]
      real(dp) :: initial_squeeze_group = 0.0_dp
      !> Pressure group B at the steady film [-]
      real(dp) :: pressure_group = 0.0_dp
      !> Largest alpha p at the steady film, exact [-]
      real(dp) :: alpha_p = 0.0_dp
      !> Amplitude of acceleration that rounding explains [m/s2]
      real(dp) :: noise_floor = 0.0_dp
   end type resolved_scene_t

   public :: resolve

contains

   !> Work out what follows from a scene.
   pure function resolve(scene) result(resolved)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      type(resolved_scene_t) :: resolved
      real(dp) :: static_load, load, load_by_film, load_by_velocity

      associate (film => resolved%film, mass => scene%load%mass)
         film = new_film(scene)
         static_load = scene%load%steady_force + mass*scene%load%gravity
         resolved%steady_film = steady_film(film, static_load)
         resolved%initial_film = resolved%steady_film
         if (scene%film%initial_film > 0.0_dp) resolved%initial_film = scene%film%initial_film
         if (resolved%initial_film > 0.0_dp) resolved%initial_squeeze_group = &
            squeeze_group(film%radius, film%speed, resolved%initial_film, scene%film%initial_velocity)
         resolved%noise_floor = 1.0e-12_dp*(static_load + scene%load%force_amplitude)/mass
         if (.not. resolved%steady_film > 0.0_dp) return
         call film_load(film, resolved%steady_film, 0.0_dp, load, load_by_film, load_by_velocity)
         resolved%natural_frequency = sqrt(-load_by_film/mass)/two_pi
         resolved%damping_ratio = -load_by_velocity/(2.0_dp*sqrt(-load_by_film*mass))
         resolved%pressure_group = film%pressure_viscosity* &
                                   pressure_scale(film%radius, film%speed, film%viscosity, resolved%steady_film)
         resolved%alpha_p = steady_alpha_p(film, resolved%steady_film)
      end associate
   end function resolve

end module resolved_scene
