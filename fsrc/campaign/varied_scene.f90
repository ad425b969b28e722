!> Puts the values of varied keys into a scene, and says whether they make one.
module varied_scene
   use input_key, only: allowed_text, in_range, is_computable, not_computable_text
   use key_table, only: keys
   use kinds, only: dp
   use scene_types, only: least_entrainment_speed, least_static_load, scene_t
   use text, only: integer_text, real_text
   use varied_keys, only: varied_key_name
   use varied_keys, only: vary_accuracy, vary_entrainment_speed, vary_force_amplitude, vary_force_scale, vary_frequency, &
                          vary_gravity, &
                          vary_idle_lines, vary_initial_film, vary_initial_velocity, vary_irregular_limit, vary_length, &
                          vary_line_threshold, vary_mass, vary_poisson_ratio, vary_pressure_viscosity, vary_quiet_limit, &
                          vary_radius, vary_radius_1, vary_radius_2, vary_rolling_speed, vary_solver_periods, &
                          vary_spectrum_periods, vary_steady_force, vary_surface_speed_1, vary_surface_speed_2, vary_viscosity, &
                          vary_young_modulus
   implicit none(type, external)
   private

   public :: set_varied_keys, is_valid_scene, why_invalid

contains

   !> Set the varied keys of a scene, in their order.
   pure subroutine set_varied_keys(scene, codes, values)
      !> The scene
      type(scene_t), intent(inout) :: scene
      !> Keys by their codes
      integer, intent(in) :: codes(:)
      !> Their values, SI units
      real(dp), intent(in) :: values(:)
      integer :: i

      do i = 1, size(codes)
         call set_varied_key(scene, codes(i), values(i))
      end do
   end subroutine set_varied_keys

   !> Set one key of a scene. Speeds all end as the entrainment speed, as in a single input.
   pure subroutine set_varied_key(scene, code, value)
      type(scene_t), intent(inout) :: scene
      integer, intent(in) :: code
      real(dp), intent(in) :: value

      select case (code)
      case (vary_radius)
         scene%contact%radius = value
      case (vary_radius_1)
         scene%contact%radius_1 = value
      case (vary_radius_2)
         scene%contact%radius_2 = value
      case (vary_length)
         scene%contact%length = value
      case (vary_young_modulus)
         scene%contact%young_modulus = value
      case (vary_poisson_ratio)
         scene%contact%poisson_ratio = value
      case (vary_viscosity)
         scene%lubricant%viscosity = value
      case (vary_pressure_viscosity)
         scene%lubricant%pressure_viscosity = value
      case (vary_entrainment_speed)
         scene%kinematics%entrainment_speed = value
      case (vary_rolling_speed)
         scene%kinematics%entrainment_speed = 0.5_dp*value
      case (vary_surface_speed_1)
         scene%kinematics%surface_speed_1 = value
         scene%kinematics%entrainment_speed = 0.5_dp*value + 0.5_dp*scene%kinematics%surface_speed_2
      case (vary_surface_speed_2)
         scene%kinematics%surface_speed_2 = value
         scene%kinematics%entrainment_speed = 0.5_dp*scene%kinematics%surface_speed_1 + 0.5_dp*value
      case (vary_mass)
         scene%load%mass = value
      case (vary_steady_force)
         scene%load%steady_force = value
      case (vary_force_amplitude)
         scene%load%force_amplitude = value
      case (vary_force_scale)
         scene%load%force_scale = value
      case (vary_frequency)
         scene%load%frequency = value
      case (vary_gravity)
         scene%load%gravity = value
      case default
         call set_choice_key(scene, code, value)
      end select
   end subroutine set_varied_key

   !> Keys of film, solver and spectrum.
   pure subroutine set_choice_key(scene, code, value)
      type(scene_t), intent(inout) :: scene
      integer, intent(in) :: code
      real(dp), intent(in) :: value

      select case (code)
      case (vary_initial_film)
         scene%film%initial_film = value
      case (vary_initial_velocity)
         scene%film%initial_velocity = value
      case (vary_accuracy)
         scene%solver%accuracy = value
      case (vary_solver_periods)
         scene%solver%periods = nint(value)
      case (vary_spectrum_periods)
         scene%spectrum%periods = nint(value)
      case (vary_line_threshold)
         scene%spectrum%line_threshold = value
      case (vary_idle_lines)
         scene%spectrum%idle_lines = nint(value)
      case (vary_quiet_limit)
         scene%spectrum%quiet_limit = value
      case (vary_irregular_limit)
         scene%spectrum%irregular_limit = value
      case default
         continue
      end select
   end subroutine set_choice_key

   !> Whether every value is in the range of its key and the scene as a whole is one.
   pure logical function is_valid_scene(scene, positions, values)
      !> The scene with its values set
      type(scene_t), intent(in) :: scene
      !> Varied keys, by their positions in the key table
      integer, intent(in) :: positions(:)
      !> Their values
      real(dp), intent(in) :: values(:)
      integer :: i

      is_valid_scene = .true.
      do i = 1, size(positions)
         is_valid_scene = is_valid_scene .and. in_range(keys(positions(i)), values(i)) &
                          .and. is_computable(keys(positions(i)), values(i))
      end do
      ! A value that is not allowed may overflow together with another.
      if (is_valid_scene) is_valid_scene = scene%load%static_load() >= least_static_load .and. &
                                           scene%kinematics%entrainment_speed >= least_entrainment_speed .and. &
                                           scene%solver%periods >= scene%spectrum%periods
   end function is_valid_scene

   !> What is wrong with a scene that is not valid: the first of its varied keys whose value is not allowed, or the rule that
   !> the scene as a whole breaks.
   pure function why_invalid(scene, positions, values) result(words)
      !> The scene with its values set
      type(scene_t), intent(in) :: scene
      !> Varied keys, by their positions in the key table
      integer, intent(in) :: positions(:)
      !> Their values
      real(dp), intent(in) :: values(:)
      character(:), allocatable :: words
      integer :: i

      do i = 1, size(positions)
         if (in_range(keys(positions(i)), values(i)) .and. is_computable(keys(positions(i)), values(i))) cycle
         words = varied_key_name(positions(i))//': '//not_computable_text(keys(positions(i)), values(i))
         if (in_range(keys(positions(i)), values(i))) return
         words = varied_key_name(positions(i))//': '//real_text(values(i))//' is not allowed; allowed: '// &
                 allowed_text(keys(positions(i)))
         return
      end do
      if (scene%load%static_load() < least_static_load) then
         words = 'load.steady_force: the static load steady_force + mass*gravity must be positive, at least 1e-12 N'
      else if (scene%kinematics%entrainment_speed < least_entrainment_speed) then
         words = 'kinematics: the sum of both surface speeds must be positive, at least 2e-9 m/s'
      else
         words = 'solver.periods: at least &spectrum periods ('//integer_text(scene%spectrum%periods)//') must be solved'
      end if
   end function why_invalid

end module varied_scene
