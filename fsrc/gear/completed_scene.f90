!> What is reported of the scene that follows from an input: faults, warnings, and the numbers that follow as comments of the
!> resolved input.
module completed_scene
   use derived_scene, only: accelerations_of, derive, derived_rules
   use errors, only: fault_list_t
   use gear_contact, only: find_contact, gear_contact_t
   use input_entry, only: numbers_text
   use key_table, only: find_key, keys
   use kinds, only: dp
   use loose_gear_drag, only: gap_is_turbulent
   use mistaken_units, only: likely_reason
   use odd_teeth, only: warnings_of_teeth
   use oil_data, only: kinematic_viscosity, least_viscosity_meant
   use scene_rules, only: rule_t
   use scene_types, only: drag_computed, drag_given, scene_t, set_number, task_sweep, task_threshold
   use text, only: real_text, short_text
   use word_list, only: word_t
   implicit none(type, external)
   private

   !> A temperature farther from those of the data sheet than these are apart deserves a warning [K].
   real(dp), parameter :: farthest_beyond_data = 60.0_dp

   public :: complete_scene, beyond_measured_speeds

contains

   !> Derive the scene of an input, report what is wrong with it or odd about it, and put what follows into its resolved input as
   !> comments.
   subroutine complete_scene(scene, faults)
      !> Without a fault of its own
      type(scene_t), intent(inout) :: scene
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      type(rule_t), allocatable :: broken(:)
      real(dp) :: ends(2)
      integer :: i, dot, before

      before = faults%count()
      if (.not. (scene%gear%given .or. scene%oil%given)) return
      call derive(scene)
      allocate (broken, source=derived_rules(scene))
      do i = 1, size(broken)
         associate (key => broken(i)%keys)
            dot = index(key, '.')
            call faults%add(scene%source, scene%lines(find_key(key)), key(:dot - 1), trim(key(dot + 1:)), trim(broken(i)%sentence))
         end associate
      end do
      if (faults%count() > before) then
         call add_mistaken_units(scene, size(broken), faults)
         return
      end if
      if (scene%task == task_sweep) call check_sweep(scene, faults)
      if (scene%oil%given) call tell_oil(scene)
      if (scene%gear%given) call tell_gear(scene)
      ends = ends_of_key(scene, 'shaft.speed_rpm', scene%shaft%speed_rpm)
      if (scene%gear%given) scene%warnings = [scene%warnings, beyond_measured_speeds(scene, ends(1), ends(2))]
      if (scene%gear%given) call tell_teeth(scene)
   end subroutine complete_scene

   !> Behind the rules that a scene breaks, numbers that were surely meant in another unit: the likely reason, if the scene breaks
   !> fewer rules with what was meant.
   subroutine add_mistaken_units(scene, broken, faults)
      type(scene_t), intent(in) :: scene
      !> How many rules it breaks
      integer, intent(in) :: broken
      type(fault_list_t), intent(inout) :: faults
      type(scene_t) :: meant
      character(:), allocatable :: role
      integer :: i

      meant = scene
      do i = 1, size(scene%mistaken)
         associate (key => keys(scene%mistaken(i)%key))
            call set_number(meant, key%group, key%name, scene%mistaken(i)%meant)
         end associate
      end do
      call derive(meant)
      role = ''
      if (size(derived_rules(meant)) < broken) role = 'the likely reason: '
      do i = 1, size(scene%mistaken)
         associate (number => scene%mistaken(i), key => keys(scene%mistaken(i)%key))
            call faults%add(number%source, number%line, trim(key%group), trim(key%name), role//number%sentence)
         end associate
      end do
   end subroutine add_mistaken_units

   !> The scenes at all values of a sweep can be derived.
   subroutine check_sweep(scene, faults)
      type(scene_t), intent(in) :: scene
      type(fault_list_t), intent(inout) :: faults
      type(rule_t), allocatable :: broken(:)
      type(scene_t) :: swept
      integer :: i

      swept = scene
      associate (sweep => scene%sweep)
         do i = 1, sweep%outward
            call set_number(swept, keys(sweep%key)%group, keys(sweep%key)%name, sweep%values(i))
            call derive(swept)
            if (allocated(broken)) deallocate (broken)
            allocate (broken, source=derived_rules(swept))
            if (size(broken) == 0) cycle
            call faults%add(scene%source, 0, 'sweep', trim(merge('last ', 'first', i == sweep%outward)), &
                            'at '//short_text(sweep%values(i), 7)//': '//trim(broken(1)%sentence)// &
                            likely_reason(keys(sweep%key), sweep%values(i)))
            exit
         end do
      end associate
   end subroutine check_sweep

   !> What follows from &oil.
   subroutine tell_oil(scene)
      type(scene_t), intent(inout) :: scene
      real(dp) :: thin, ends(2)
      real(dp), parameter :: low = 40.0_dp, high = 100.0_dp

      ends = ends_of_key(scene, 'oil.temperature_celsius', scene%oil%temperature_celsius)
      if (ends(1) < low - farthest_beyond_data) &
         call warn(ends(1), low - ends(1), ', and near its pour point an oil leaves that line')
      if (ends(2) > high + farthest_beyond_data) call warn(ends(2), ends(2) - high, '')
      thin = kinematic_viscosity(scene%oil%viscosity_40_cst, scene%oil%viscosity_100_cst, ends(2))
      if (thin < least_viscosity_meant) scene%warnings = [scene%warnings, word_t('warning: the oil has '// &
         short_text(thin, 3)//' mm2/s at '//short_text(ends(2), 3)// &
         ' degC; the line through both viscosities (ASTM D341) is meant for 2 and more')]
      call report(scene, 'lubricant.viscosity', [scene%lubricant%viscosity], 'Pa s')
      call report(scene, 'lubricant.pressure_viscosity', [scene%lubricant%pressure_viscosity], '1/Pa')

   contains

      !> Say that a temperature lies far beyond the data.
      subroutine warn(temperature, beyond, words)
         real(dp), intent(in) :: temperature
         !> By how much [K]
         real(dp), intent(in) :: beyond
         !> What else there is to say
         character(*), intent(in) :: words

         scene%warnings = [scene%warnings, word_t('warning: at '//short_text(temperature, 3)// &
            ' degC the viscosity is extrapolated by '//short_text(beyond, 2)// &
            ' K from the 40 and 100 degC of the data sheet, farther than these are apart'//words)]
      end subroutine warn

   end subroutine tell_oil

   !> Lowest and highest value of a key in what an input asks for, but for those of a table of scenes.
   pure function ends_of_key(scene, name, own) result(ends)
      type(scene_t), intent(in) :: scene
      !> As group.name
      character(*), intent(in) :: name
      !> Its value in the input
      real(dp), intent(in) :: own
      real(dp) :: ends(2)
      integer :: i

      ends = own
      if (scene%task == task_sweep) then
         if (scene%sweep%key == find_key(name)) ends = [minval(scene%sweep%values), maxval(scene%sweep%values)]
      end if
      if (scene%task == task_threshold) then
         associate (threshold => scene%threshold)
            if (threshold%key == name) ends = [min(threshold%first, threshold%last), max(threshold%first, threshold%last)]
         end associate
      end if
      if (.not. allocated(scene%campaign%vary)) return
      do i = 1, size(scene%campaign%vary)
         if (scene%campaign%vary(i)%text /= name) cycle
         associate (campaign => scene%campaign)
            if (i <= min(size(campaign%first), size(campaign%last))) &
               ends = [min(campaign%first(i), campaign%last(i)), max(campaign%first(i), campaign%last(i))]
            if (i > size(campaign%values)) cycle
            if (size(campaign%values(i)%numbers) > 0) &
               ends = [minval(campaign%values(i)%numbers), maxval(campaign%values(i)%numbers)]
         end associate
      end do
   end function ends_of_key

   !> That speeds lie beyond those for which the motion of the shaft was measured; no line if none do.
   pure function beyond_measured_speeds(scene, lowest, highest) result(lines)
      type(scene_t), intent(in) :: scene
      !> Of the speeds [1/min]
      real(dp), intent(in) :: lowest
      real(dp), intent(in) :: highest
      type(word_t), allocatable :: lines(:)
      character(:), allocatable :: speeds

      allocate (lines(0))
      if (.not. allocated(scene%shaft%signal_speed_range)) return
      associate (range => scene%shaft%signal_speed_range)
         if (lowest >= range(1) .and. highest <= range(2)) return
         speeds = short_text(lowest, 5)
         if (highest > lowest) speeds = speeds//' to '//short_text(highest, 5)
         lines = [word_t('warning: the motion of the shaft was measured for '//short_text(range(1), 5)//' to '// &
                         short_text(range(2), 5)//' 1/min (&shaft signal_speed_range) and is used with the same amplitudes for '// &
                         speeds//' 1/min, beyond these; a run-up (&shaft table) has the motion of each speed')]
      end associate
   end function beyond_measured_speeds
   !> Warnings of the teeth of a pair, and of those at both ends of what is varied.
   subroutine tell_teeth(scene)
      type(scene_t), intent(inout) :: scene
      character(*), parameter :: names(7) = [character(18) :: 'normal_module', 'pressure_angle_deg', 'helix_angle_deg', &
                                             'centre_distance', 'contact_position', 'tip_diameter_1', 'tip_diameter_2']
      type(word_t), allocatable :: lines(:)
      type(scene_t) :: varied
      real(dp) :: values(size(names)), ends(2)
      integer :: i, j

      allocate (lines, source=warnings_of_teeth(scene, ''))
      if (size(lines) == 0) then
         associate (gear => scene%gear)
            values = [gear%normal_module, gear%pressure_angle_deg, gear%helix_angle_deg, gear%centre_distance, &
                      gear%contact_position, gear%tip_diameter_1, gear%tip_diameter_2]
         end associate
         do i = 1, size(names)
            ends = ends_of_key(scene, 'gear.'//trim(names(i)), values(i))
            do j = 1, 2
               if (.not. abs(ends(j) - values(i)) > 0.0_dp) cycle
               varied = scene
               call set_number(varied, 'gear', names(i), ends(j))
               lines = [lines, warnings_of_teeth(varied, 'at '//trim(names(i))//' = '//real_text(ends(j))//': ')]
            end do
         end do
      end if
      scene%warnings = [scene%warnings, lines]
   end subroutine tell_teeth

   !> What follows from &gear and &shaft.
   subroutine tell_gear(scene)
      type(scene_t), intent(inout) :: scene
      type(gear_contact_t) :: contact
      character(:), allocatable :: wrong, message

      call find_contact(scene%gear, scene%drag%torque, scene%shaft%speed_rpm/60.0_dp, contact, wrong, message)
      associate (excitation => scene%excitation)
         if (excitation%steady_force >= excitation%force_scale*sum(excitation%force_amplitudes)) scene%warnings = [scene%warnings, &
            word_t('warning: the drag of '//short_text(excitation%steady_force, 4)//' N is larger than the inertia force of '// &
                   short_text(excitation%force_scale*sum(excitation%force_amplitudes), 4)// &
                   ' N at most: the tooth stays on its flank, or on the film there')]
         if (allocated(scene%shaft%speed_amplitudes) .or. allocated(scene%shaft%table)) &
            call report(scene, 'shaft.accelerations', accelerations_of(scene%shaft), 'rad/s2')
         if (allocated(scene%shaft%table)) call report(scene, 'shaft.orders', scene%shaft%orders, '')
         if (allocated(scene%shaft%table)) call report(scene, 'shaft.phases', scene%shaft%phases, 'rad')
         call report(scene, 'gear.base_radius_1', [contact%base_radius_1], 'm')
         call report(scene, 'gear.base_radius_2', [contact%base_radius_2], 'm')
         call report(scene, 'gear.centre_distance', [contact%centre_distance], 'm')
         call report(scene, 'gear.working_pressure_angle', [contact%working_pressure_angle], 'deg')
         call report(scene, 'gear.base_helix_angle', [contact%base_helix_angle], 'deg')
         call report(scene, 'gear.profile_shift_sum', [scene%teeth%shift_sum], '')
         call report(scene, 'gear.contact_ratio', [scene%teeth%contact_ratio], '')
         call report(scene, 'gear.overlap_ratio', [scene%teeth%overlap_ratio], '')
         if (scene%gear%tip_diameter_1 > 0.0_dp) call report(scene, 'gear.contact_lines', [contact%contact_lines], '')
         if (scene%drag%known_by /= drag_given) call report(scene, 'gear.drag_torque', [scene%drag%torque], 'N m')
         if (scene%drag%known_by == drag_computed) then
            call report(scene, 'gear.drag_bearing', [scene%drag%bearing], 'N m')
            call report(scene, 'gear.drag_synchroniser', [scene%drag%synchroniser], 'N m')
            call report(scene, 'gear.drag_churning', [scene%drag%churning], 'N m')
            if (gap_is_turbulent(scene%gear, scene%shaft%speed_rpm, scene%oil)) scene%warnings = [scene%warnings, &
               word_t('warning: oil whirls in the gap of the synchroniser or of the plain bearing at this speed, where it is '// &
                      'computed as laminar: it brakes more')]
         end if
         call report(scene, 'contact.radius', [scene%contact%radius], 'm')
         call report(scene, 'contact.length', [scene%contact%length], 'm')
         if (scene%contact%backlash > 0.0_dp) call report(scene, 'contact.backlash', [scene%contact%backlash], 'm')
         if (scene%contact%stiffness > 0.0_dp) call report(scene, 'contact.stiffness', [scene%contact%stiffness], 'N/m')
         if (scene%contact%damping_ratio > 0.0_dp) &
            call report(scene, 'contact.damping_ratio', [scene%contact%damping_ratio], '-')
         call report(scene, 'kinematics.entrainment_speed', [scene%kinematics%entrainment_speed], 'm/s')
         call report(scene, 'load.mass', [excitation%mass], 'kg')
         call report(scene, 'load.steady_force', [excitation%steady_force], 'N')
         call report(scene, 'load.force_orders', real(excitation%force_orders, dp), '')
         call report(scene, 'load.force_amplitudes', excitation%force_amplitudes, 'N')
         call report(scene, 'load.force_phases', excitation%force_phases, 'rad')
         call report(scene, 'load.frequency', [excitation%frequency], 'Hz')
         call report(scene, 'load.gravity', [excitation%gravity], 'm/s2')
      end associate
   end subroutine tell_gear

   !> Put a derived key into the resolved input.
   subroutine report(scene, name, numbers, unit)
      type(scene_t), intent(inout) :: scene
      character(*), intent(in) :: name
      real(dp), intent(in) :: numbers(:)
      character(*), intent(in) :: unit

      scene%resolved_input = scene%resolved_input//'! derived: '//name//' = '//trim(numbers_text(numbers)//' '//unit)// &
                             new_line('a')
   end subroutine report

end module completed_scene
