!> Puts the values of varied keys into a scene, and says whether they make one.
module varied_scene
   use input_key, only: in_range
   use key_table, only: keys
   use kinds, only: dp
   use scene_types, only: scene_t
   implicit none(type, external)
   private

   public :: set_varied_key, is_valid_scene, can_be_varied

contains

   !> Set one key of a scene. Speeds all end as the entrainment speed, as in a single input.
   pure subroutine set_varied_key(scene, position, value)
      !> The scene
      type(scene_t), intent(inout) :: scene
      !> Position of the key in the key table
      integer, intent(in) :: position
      !> Its value, SI unit
      real(dp), intent(in) :: value

      select case (trim(keys(position)%group)//'.'//trim(keys(position)%name))
      case ('contact.radius')
         scene%contact%radius = value
      case ('contact.radius_1')
         scene%contact%radius_1 = value
      case ('contact.radius_2')
         scene%contact%radius_2 = value
      case ('contact.length')
         scene%contact%length = value
      case ('contact.young_modulus')
         scene%contact%young_modulus = value
      case ('contact.poisson_ratio')
         scene%contact%poisson_ratio = value
      case ('lubricant.viscosity')
         scene%lubricant%viscosity = value
      case ('lubricant.pressure_viscosity')
         scene%lubricant%pressure_viscosity = value
      case ('kinematics.entrainment_speed')
         scene%kinematics%entrainment_speed = value
      case ('kinematics.rolling_speed')
         scene%kinematics%entrainment_speed = 0.5_dp*value
      case ('kinematics.surface_speed_1')
         scene%kinematics%surface_speed_1 = value
         scene%kinematics%entrainment_speed = 0.5_dp*(value + scene%kinematics%surface_speed_2)
      case ('kinematics.surface_speed_2')
         scene%kinematics%surface_speed_2 = value
         scene%kinematics%entrainment_speed = 0.5_dp*(scene%kinematics%surface_speed_1 + value)
      case default
         call set_motion_key(scene, trim(keys(position)%group)//'.'//trim(keys(position)%name), value)
      end select
   end subroutine set_varied_key

   !> Keys of load, film, solver and spectrum.
   pure subroutine set_motion_key(scene, name, value)
      type(scene_t), intent(inout) :: scene
      character(*), intent(in) :: name
      real(dp), intent(in) :: value

      select case (name)
      case ('load.mass')
         scene%load%mass = value
      case ('load.steady_force')
         scene%load%steady_force = value
      case ('load.force_amplitude')
         scene%load%force_amplitude = value
      case ('load.frequency')
         scene%load%frequency = value
      case ('load.gravity')
         scene%load%gravity = value
      case ('film.initial_film')
         scene%film%initial_film = value
      case ('film.initial_velocity')
         scene%film%initial_velocity = value
      case ('solver.accuracy')
         scene%solver%accuracy = value
      case ('solver.periods')
         scene%solver%periods = nint(value)
      case ('spectrum.periods')
         scene%spectrum%periods = nint(value)
      case ('spectrum.line_threshold')
         scene%spectrum%line_threshold = value
      case ('spectrum.idle_lines')
         scene%spectrum%idle_lines = nint(value)
      case ('spectrum.quiet_limit')
         scene%spectrum%quiet_limit = value
      case ('spectrum.irregular_limit')
         scene%spectrum%irregular_limit = value
      case default
         continue
      end select
   end subroutine set_motion_key

   !> Whether a numeric key describes a single motion of a campaign.
   pure logical function can_be_varied(position)
      !> Position of the key in the key table
      integer, intent(in) :: position

      select case (trim(keys(position)%group))
      case ('contact', 'lubricant', 'kinematics', 'load')
         can_be_varied = .true.
      case ('film')
         can_be_varied = .true.
      case ('solver')
         can_be_varied = keys(position)%name == 'accuracy' .or. keys(position)%name == 'periods'
      case ('spectrum')
         can_be_varied = keys(position)%name /= 'certificate_tolerance'
      case default
         can_be_varied = .false.
      end select
   end function can_be_varied

   !> Whether every value is in the range of its key and the scene as a whole is one.
   pure logical function is_valid_scene(scene, positions, values)
      !> The scene with its values set
      type(scene_t), intent(in) :: scene
      !> Varied keys
      integer, intent(in) :: positions(:)
      !> Their values
      real(dp), intent(in) :: values(:)
      integer :: i

      is_valid_scene = scene%load%steady_force + scene%load%mass*scene%load%gravity > 0.0_dp .and. &
                       scene%kinematics%entrainment_speed > 0.0_dp .and. scene%solver%periods >= scene%spectrum%periods
      do i = 1, size(positions)
         is_valid_scene = is_valid_scene .and. in_range(keys(positions(i)), values(i))
      end do
   end function is_valid_scene

end module varied_scene
