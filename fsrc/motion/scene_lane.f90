!> A scene as a lane of the error-controlled engine.
module scene_lane
   use film_law, only: film_t
   use kinds, only: dp
   use lane_scenes, only: lane_scene_t
   use scene_types, only: scene_t
   implicit none(type, external)
   private

   public :: lane_of_scene

contains

   !> Lane that starts at the given state.
   pure function lane_of_scene(scene, film, initial_film, initial_velocity) result(lane)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Its film
      type(film_t), intent(in) :: film
      !> Film at the start of a period [m]
      real(dp), intent(in) :: initial_film
      !> Film velocity there [m/s]
      real(dp), intent(in) :: initial_velocity
      type(lane_scene_t) :: lane

      lane%film = film
      lane%mass = scene%load%mass
      lane%weight = scene%load%weight()
      lane%steady_force = scene%load%steady_force
      lane%force_amplitude = scene%load%force_amplitude
      lane%frequency = scene%load%frequency
      lane%initial_film = initial_film
      lane%first_film = initial_film
      lane%initial_velocity = initial_velocity
   end function lane_of_scene

end module scene_lane
