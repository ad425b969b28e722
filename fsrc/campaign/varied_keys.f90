!> Which keys a campaign may vary: the numbers that describe a motion scene. The one table of them; what each sets
!> stands in varied_scene.
module varied_keys
   use input_key, only: integer_kind, real_kind
   use key_table, only: find_key, keys, known_group, nearest_group, nearest_key
   use text, only: lower
   implicit none(type, external)
   private

   integer, parameter, public :: &
      vary_radius = 1, vary_radius_1 = 2, vary_radius_2 = 3, vary_length = 4, vary_young_modulus = 5, vary_poisson_ratio = 6, &
      vary_viscosity = 7, vary_pressure_viscosity = 8, vary_entrainment_speed = 9, vary_rolling_speed = 10, &
      vary_surface_speed_1 = 11, vary_surface_speed_2 = 12, vary_mass = 13, vary_steady_force = 14, &
      vary_force_amplitude = 15, vary_frequency = 16, vary_gravity = 17, vary_initial_film = 18, vary_initial_velocity = 19, &
      vary_accuracy = 20, vary_solver_periods = 21, vary_spectrum_periods = 22, vary_line_threshold = 23, &
      vary_idle_lines = 24, vary_quiet_limit = 25, vary_irregular_limit = 26, vary_force_scale = 27

   !> A key that may be varied.
   type, public :: varied_key_t
      integer :: code
      !> As in the key table
      character(12) :: group
      character(24) :: name
   end type varied_key_t

   type(varied_key_t), parameter, public :: varied(*) = [ &
      varied_key_t(vary_radius, 'contact', 'radius'), &
      varied_key_t(vary_radius_1, 'contact', 'radius_1'), &
      varied_key_t(vary_radius_2, 'contact', 'radius_2'), &
      varied_key_t(vary_length, 'contact', 'length'), &
      varied_key_t(vary_young_modulus, 'contact', 'young_modulus'), &
      varied_key_t(vary_poisson_ratio, 'contact', 'poisson_ratio'), &
      varied_key_t(vary_viscosity, 'lubricant', 'viscosity'), &
      varied_key_t(vary_pressure_viscosity, 'lubricant', 'pressure_viscosity'), &
      varied_key_t(vary_entrainment_speed, 'kinematics', 'entrainment_speed'), &
      varied_key_t(vary_rolling_speed, 'kinematics', 'rolling_speed'), &
      varied_key_t(vary_surface_speed_1, 'kinematics', 'surface_speed_1'), &
      varied_key_t(vary_surface_speed_2, 'kinematics', 'surface_speed_2'), &
      varied_key_t(vary_mass, 'load', 'mass'), &
      varied_key_t(vary_steady_force, 'load', 'steady_force'), &
      varied_key_t(vary_force_amplitude, 'load', 'force_amplitude'), &
      varied_key_t(vary_frequency, 'load', 'frequency'), &
      varied_key_t(vary_gravity, 'load', 'gravity'), &
      varied_key_t(vary_initial_film, 'film', 'initial_film'), &
      varied_key_t(vary_initial_velocity, 'film', 'initial_velocity'), &
      varied_key_t(vary_accuracy, 'solver', 'accuracy'), &
      varied_key_t(vary_solver_periods, 'solver', 'periods'), &
      varied_key_t(vary_spectrum_periods, 'spectrum', 'periods'), &
      varied_key_t(vary_line_threshold, 'spectrum', 'line_threshold'), &
      varied_key_t(vary_idle_lines, 'spectrum', 'idle_lines'), &
      varied_key_t(vary_quiet_limit, 'spectrum', 'quiet_limit'), &
      varied_key_t(vary_irregular_limit, 'spectrum', 'irregular_limit'), &
      varied_key_t(vary_force_scale, 'load', 'force_scale')]

   public :: find_varied_key, varied_code, varied_key_name, is_whole

contains

   !> Position of 'group.key' in the key table.
   pure subroutine find_varied_key(name, position, message)
      !> As the user wrote it, without blanks around it
      character(*), intent(in) :: name
      !> Position, 0 if this key cannot be varied
      integer, intent(out) :: position
      !> Why not; empty if it can
      character(:), allocatable, intent(out) :: message
      character(:), allocatable :: group, key
      integer :: dot

      position = 0
      message = ''
      dot = index(name, '.')
      if (dot == 0) then
         message = "a key is named as group.key, such as load.mass"
         return
      end if
      group = lower(name(:dot - 1))
      key = lower(name(dot + 1:))
      if (.not. known_group(group)) then
         message = 'unknown group; the nearest known group is '//nearest_group(group)
         return
      end if
      position = find_key(group, key)
      if (position == 0) then
         message = 'unknown key; '//nearest_key(group, key)
      else if (keys(position)%kind /= real_kind .and. keys(position)%kind /= integer_kind) then
         message = 'this key is not a number, so it cannot be varied'
      else if (varied_code(position) == 0) then
         message = 'this key does not describe the motion of a scene, so it cannot be varied'
      end if
      if (len(message) > 0) position = 0
   end subroutine find_varied_key

   !> Code of a key of the key table, 0 if it cannot be varied.
   elemental integer function varied_code(position)
      !> Position in the key table
      integer, intent(in) :: position
      integer :: i

      varied_code = 0
      do i = 1, size(varied)
         if (varied(i)%group == keys(position)%group .and. varied(i)%name == keys(position)%name) varied_code = varied(i)%code
      end do
   end function varied_code

   !> Name of a key as 'group.key'.
   pure function varied_key_name(position) result(name)
      !> Position in the key table
      integer, intent(in) :: position
      character(:), allocatable :: name

      name = trim(keys(position)%group)//'.'//trim(keys(position)%name)
   end function varied_key_name

   !> Whether a key takes whole numbers only.
   pure logical function is_whole(position)
      !> Position in the key table
      integer, intent(in) :: position

      is_whole = keys(position)%kind == integer_kind
   end function is_whole

end module varied_keys
