!> The scene that follows from &gear, &shaft and &oil: contact, kinematics, load and lubricant of a loose gear. Whatever sets a
!> number of these groups, an input, a sweep or a campaign, derives the scene from them behind it.
module derived_scene
   use constants, only: pi, two_pi
   use gear_contact, only: find_contact, gear_contact_t
   use input_key, only: is_computable
   use key_table, only: find_key, keys
   use kinds, only: dp
   use loose_gear_drag, only: drag_of_gear, reference_diameter
   use oil_data, only: oil_pressure_viscosity, oil_viscosity
   use scene_rules, only: broken_elastic_rules, rule_t, sentence_length
   use scene_types, only: drag_computed, drag_given, drag_tabulated, highest_order, note_orders, scene_t, shaft_t
   use table_values, only: excitation_at, is_within
   implicit none(type, external)
   private

   public :: derive, derived_rules, base_order, accelerations_of

contains

   !> Set all that follows from the groups that are given. A scene that breaks a derived rule is of no use.
   pure subroutine derive(scene)
      type(scene_t), intent(inout) :: scene
      type(gear_contact_t) :: contact
      character(:), allocatable :: wrong, message

      if (scene%oil%given) then
         associate (oil => scene%oil, lubricant => scene%lubricant)
            lubricant%viscosity = viscosity_at(scene, oil%temperature_celsius)
            lubricant%pressure_viscosity = oil%pressure_viscosity
            if (.not. oil%pressure_viscosity > 0.0_dp) lubricant%pressure_viscosity = &
               oil_pressure_viscosity(oil%base, viscosity_at(scene, 38.0_dp), oil%temperature_celsius)
         end associate
      end if
      if (.not. scene%gear%given) return
      scene%drag = drag_of_gear(scene%gear, scene%shaft%speed_rpm, scene%oil)
      call find_contact(scene%gear, scene%drag%torque, scene%shaft%speed_rpm/60.0_dp, contact, wrong, message)
      scene%teeth = contact%teeth
      scene%contact%radius = contact%radius
      scene%contact%length = contact%length
      scene%contact%backlash = scene%gear%backlash
      scene%contact%tooth_width = contact%tooth_width
      scene%contact%stiffness = scene%contact%stiffness_of_width(scene%gear%tooth_stiffness)
      scene%contact%damping_ratio = scene%gear%tooth_damping_ratio
      scene%kinematics%entrainment_speed = contact%entrainment_speed
      scene%excitation%mass = contact%mass
      scene%excitation%steady_force = contact%steady_force
      scene%excitation%gravity = 0.0_dp
      call derive_force(scene, contact%force_per_acceleration)
   end subroutine derive

   !> Force, and the orders at which it makes lines.
   pure subroutine derive_force(scene, force_per_acceleration)
      type(scene_t), intent(inout) :: scene
      !> [N s2/rad]
      real(dp), intent(in) :: force_per_acceleration
      real(dp) :: base

      if (allocated(scene%shaft%table)) &
         call excitation_at(scene%shaft%table, scene%shaft%speed_rpm, scene%shaft%accelerations, scene%shaft%phases)
      base = base_order(scene%shaft%orders)
      if (.not. base > 0.0_dp) return
      scene%excitation%frequency = base*scene%shaft%speed_rpm/60.0_dp
      scene%excitation%force_orders = nint(scene%shaft%orders/base)
      scene%excitation%force_amplitudes = force_per_acceleration*accelerations_of(scene%shaft)
      scene%excitation%force_phases = scene%shaft%phases
      ! The derivative of a cosine leads it by a quarter of its period.
      if (allocated(scene%shaft%speed_amplitudes)) scene%excitation%force_phases = scene%shaft%phases + 0.5_dp*pi
      call note_orders(scene%excitation%force_orders, scene%excitation%force_amplitudes, scene%spectrum)
   end subroutine derive_force

   !> Amplitudes of the angular acceleration of a shaft, order by order [rad/s2].
   pure function accelerations_of(shaft) result(accelerations)
      type(shaft_t), intent(in) :: shaft
      real(dp), allocatable :: accelerations(:)

      if (allocated(shaft%speed_amplitudes)) then
         accelerations = shaft%speed_amplitudes*shaft%orders*two_pi*shaft%speed_rpm/60.0_dp
      else
         accelerations = shaft%accelerations
      end if
   end function accelerations_of

   !> Viscosity of the oil at a temperature [degC].
   pure real(dp) function viscosity_at(scene, temperature)
      type(scene_t), intent(in) :: scene
      real(dp), intent(in) :: temperature

      viscosity_at = oil_viscosity(scene%oil%viscosity_40_cst, scene%oil%viscosity_100_cst, scene%oil%density_15, temperature)
   end function viscosity_at

   !> Greatest common divisor of orders, which have halves among them in a four-stroke engine; 0 if they have none above a
   !> hundred-thousandth of the largest. Times the speed of the shaft [1/s] it is the frequency that the motion repeats with,
   !> and the orders over it are whole numbers.
   pure real(dp) function base_order(orders)
      !> Orders above 0; what they are off a common divisor by rounding, as 0.333 is off a third, is not forgiven beyond 1e-9
      real(dp), intent(in) :: orders(:)
      real(dp), parameter :: rounding = 1.0e-9_dp, least = 1.0e-5_dp
      real(dp) :: divisor, remainder, swap
      integer :: i

      base_order = 0.0_dp
      if (size(orders) == 0) return
      divisor = orders(1)
      do i = 2, size(orders)
         remainder = orders(i)
         do while (remainder > rounding*maxval(orders))
            swap = remainder
            remainder = abs(divisor - remainder*anint(divisor/remainder))
            divisor = swap
         end do
      end do
      if (divisor < least*maxval(orders)) return
      ! The largest order shows the divisor with the most digits.
      base_order = maxval(orders)/anint(maxval(orders)/divisor)
   end function base_order

   !> The rules that a derived scene breaks.
   pure function derived_rules(scene) result(broken)
      !> Derived; it breaks none of the rules between its own numbers
      type(scene_t), intent(in) :: scene
      type(rule_t), allocatable :: broken(:)
      type(gear_contact_t) :: contact
      character(:), allocatable :: wrong, message
      real(dp) :: base

      allocate (broken(0))
      if (scene%oil%given) then
         call demand(broken, 'lubricant.viscosity', scene%lubricant%viscosity, 'oil.temperature_celsius')
         call demand(broken, 'lubricant.pressure_viscosity', scene%lubricant%pressure_viscosity, 'oil.temperature_celsius')
      end if
      if (scene%oil%given .and. .not. scene%gear%given) broken = [broken, broken_elastic_rules(scene)]
      if (.not. scene%gear%given) return
      call find_contact(scene%gear, scene%drag%torque, scene%shaft%speed_rpm/60.0_dp, contact, wrong, message)
      if (len(wrong) > 0) then
         call add(broken, 'gear.'//wrong, message)
         return
      end if
      call demand(broken, 'contact.radius', scene%contact%radius, 'gear.contact_position')
      call demand(broken, 'contact.length', scene%contact%length, 'gear.face_width')
      call demand(broken, 'kinematics.entrainment_speed', scene%kinematics%entrainment_speed, 'shaft.speed_rpm')
      call demand(broken, 'load.mass', scene%excitation%mass, 'gear.loose_inertia')
      call add_drag_rules(broken, scene)
      if (allocated(scene%shaft%table)) &
         call demand_within(broken, 'shaft.speed_rpm', scene%shaft%speed_rpm, scene%shaft%table%speeds, 'shaft.table')
      base = base_order(scene%shaft%orders)
      if (.not. base > 0.0_dp) then
         call add(broken, orders_key(scene), 'they have no common divisor to repeat with; halves, thirds and the like have')
         return
      end if
      call demand(broken, 'load.frequency', scene%excitation%frequency, 'shaft.speed_rpm')
      if (maxval(scene%excitation%force_orders) > highest_order) &
         call add(broken, orders_key(scene), 'the highest is too large a multiple of their common divisor')
      if (scene%solver%samples_per_period() < 4*maxval(scene%excitation%force_orders)) &
         call add(broken, 'solver.samples_per_period', 'at least four for each multiple of the base frequency are needed')
      broken = [broken, broken_elastic_rules(scene)]
   end function derived_rules

   !> Key that the orders of the shaft come from.
   pure function orders_key(scene) result(key)
      type(scene_t), intent(in) :: scene
      character(12) :: key

      key = 'shaft.orders'
      if (allocated(scene%shaft%table)) key = 'shaft.table'
   end function orders_key

   !> Rules of a drag that is computed or taken from a table.
   pure subroutine add_drag_rules(broken, scene)
      type(rule_t), allocatable, intent(inout) :: broken(:)
      type(scene_t), intent(in) :: scene
      character(sentence_length) :: sentence
      character(26) :: cause

      associate (gear => scene%gear)
         select case (scene%drag%known_by)
         case (drag_tabulated)
            cause = 'gear.drag_table'
            call demand_within(broken, 'shaft.speed_rpm', scene%shaft%speed_rpm, gear%drag_table%speeds, cause)
            call demand_within(broken, 'oil.temperature_celsius', scene%oil%temperature_celsius, &
                               gear%drag_table%temperatures, cause)
         case (drag_computed)
            cause = 'gear.bearing_mean_diameter'
            if (gear%immersion_depth > reference_diameter(gear)) then
               write (sentence, '(ss, 2(a, es10.3), a)') 'the reference circle of gear 2 has a diameter of ', &
                  reference_diameter(gear), ' m, and its lowest point cannot lie', gear%immersion_depth, ' m below the oil'
               call add(broken, 'gear.immersion_depth', sentence)
            end if
            if (gear%synchroniser_cones > 0 .and. &
                .not. min(gear%synchroniser_diameter, gear%synchroniser_width, gear%synchroniser_gap) > 0.0_dp) &
               call add(broken, 'gear.synchroniser_cones', &
                        'cones need synchroniser_diameter, synchroniser_width and synchroniser_gap')
         case default
            cause = 'gear.drag_torque'
         end select
         call demand(broken, 'load.steady_force', scene%excitation%steady_force, trim(cause))
         if (scene%drag%known_by == drag_given .or. gear%backlash > 0.0_dp .or. scene%drag%torque > 0.0_dp) return
         write (sentence, '(ss, a, es10.3, a)') 'without a backlash the drag torque must be positive; here it is', &
            scene%drag%torque, ' N m'
         call add(broken, trim(cause), sentence)
      end associate
   end subroutine add_drag_rules

   !> A value must lie within the rows of a table.
   pure subroutine demand_within(broken, key, value, axis, table)
      type(rule_t), allocatable, intent(inout) :: broken(:)
      !> Key of the value
      character(*), intent(in) :: key
      real(dp), intent(in) :: value
      !> Ascending
      real(dp), intent(in) :: axis(:)
      !> Key of the table
      character(*), intent(in) :: table
      character(sentence_length) :: sentence

      if (is_within(axis, value)) return
      write (sentence, '(ss, a, g0.7, 5a, 2(g0.7, a))') 'it is ', value, ' ', trim(keys(find_key(key))%unit), ' and ', &
         trim(table), ' goes from ', axis(1), ' to ', axis(size(axis)), ' '//trim(keys(find_key(key))%unit)
      call add(broken, key, sentence)
   end subroutine demand_within

   !> Add a rule that is broken.
   pure subroutine add(broken, key, sentence)
      type(rule_t), allocatable, intent(inout) :: broken(:)
      character(*), intent(in) :: key
      character(*), intent(in) :: sentence

      broken = [broken, rule_t(key, sentence)]
   end subroutine add

   !> A number that is derived must be one that can be computed with.
   pure subroutine demand(broken, key, value, cause)
      type(rule_t), allocatable, intent(inout) :: broken(:)
      !> Its key
      character(*), intent(in) :: key
      real(dp), intent(in) :: value
      !> Key that it follows from
      character(*), intent(in) :: cause
      character(sentence_length) :: sentence
      integer :: position

      position = find_key(key)
      if (is_computable(keys(position), value)) return
      write (sentence, '(ss, 3a, es9.2, 3a, es8.1, a, es8.1)') 'the ', trim(keys(position)%name), ' that follows is ', value, ' ', &
         trim(keys(position)%unit), '; possible:', keys(position)%computable(1), ' to', keys(position)%computable(2)
      call add(broken, cause, sentence)
   end subroutine demand

end module derived_scene
