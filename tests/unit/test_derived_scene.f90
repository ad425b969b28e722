!> Tests of the scene that follows from a gear pair: what is reported of it and in which unit, which values of a sweep are
!> refused, and when the drag is said to be too large.
module test_derived_scene
   use campaign_file_cases, only: line_feed
   use checks, only: check_list_t
   use constants, only: pi
   use derived_scene, only: derive
   use errors, only: fault_list_t
   use key_table, only: find_key, keys
   use kinds, only: dp
   use scene_texts, only: read_text
   use scene_types, only: scene_t
   use text, only: integer_text, short_text
   implicit none(type, external)
   private

   character(*), parameter :: gear = '&gear teeth_1 = 11, teeth_2 = 38, normal_module = 2.5e-3, helix_angle_deg = 28.96, '// &
                              'face_width = 0.016, loose_inertia = 1.715e-3, backlash = 1e-4, tooth_stiffness = 0'
   character(*), parameter :: drag = ', drag_torque = 0.1 /'//line_feed
   character(*), parameter :: shaft = '&shaft speed_rpm = 800, orders = 2, 3.5, accelerations = 600, 150 /'//line_feed
   character(*), parameter :: oil = '&oil viscosity_40_cst = 58, viscosity_100_cst = 9.6, temperature_celsius = 40 /'//line_feed
   character(*), parameter :: film = '&film law = "iso-viscous", model = "reynolds" /'//line_feed
   character(*), parameter :: pair = gear//drag//shaft//oil//film
   !> Force at a shaft acceleration of 1 rad/s2, and at a drag torque of 1 N m [N]
   real(dp), parameter :: force_of_one = 6.673367428_dp/600.0_dp, force_of_torque = 22.40374258_dp

   public :: run_derived_scene_tests

contains

   !> Runs every test of this topic.
   subroutine run_derived_scene_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('derived_scene')
      call test_values_of_sweeps(checks)
      call test_drag_warning(checks)
      call test_force(checks)
      call test_reported_units(checks)
      call test_temperatures(checks)
      call test_highest_order(checks)
   end subroutine run_derived_scene_tests

   !> A scene that must be read without a fault.
   subroutine read_well(checks, text, scene)
      class(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: text
      type(scene_t), intent(out) :: scene
      type(fault_list_t) :: faults

      call read_text(text, scene, faults)
      call checks%check(faults%count() == 0, 'read without a fault')
      if (faults%count() > 0) print '(a)', faults%sentence(1)
   end subroutine read_well

   !> The value of a sweep that cannot be derived is found wherever it stands, and named with its end.
   subroutine test_values_of_sweeps(checks)
      class(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene

      call read_well(checks, pair//sweep('40', '-50', 2), scene)
      call refuse('40', '-140', 2, '&sweep last: at -140')
      call refuse('40', '-140', 181, '&sweep first: at -92.00000: the viscosity that follows is  1.14E+07 Pa s')
      call refuse('-140', '40', 2, '&sweep first: at -140')
      call refuse('-140', '40', 3, '&sweep first: at -140')

   contains

      !> A sweep over the temperature of the oil, whose viscosity can be computed with down to some 130 degrees below zero.
      function sweep(first, last, count) result(text)
         character(*), intent(in) :: first
         character(*), intent(in) :: last
         integer, intent(in) :: count
         character(:), allocatable :: text

         text = '&scene task = "sweep" /'//line_feed//'&sweep key = "temperature_celsius", first = '//first//', last = '//last// &
                ', count = '//integer_text(count)//' /'//line_feed
      end function sweep

      subroutine refuse(first, last, count, words)
         character(*), intent(in) :: first
         character(*), intent(in) :: last
         integer, intent(in) :: count
         character(*), intent(in) :: words
         type(scene_t) :: refused
         type(fault_list_t) :: faults

         call read_text(pair//sweep(first, last, count), refused, faults)
         call checks%check(faults%count() == 1, 'one fault of a sweep: '//words)
         if (faults%count() > 0) call checks%check(index(faults%sentence(1), words) > 0, &
                                                   'sweep refused with "'//words//'": '//faults%sentence(1))
      end subroutine refuse

   end subroutine test_values_of_sweeps

   !> The drag is compared with the largest inertia force of the scene, with its scale.
   subroutine test_drag_warning(checks)
      class(check_list_t), intent(inout) :: checks
      real(dp), parameter :: largest = 750.0_dp*force_of_one

      call expect('0.1', '1.0', '')
      call expect('0.4', '1.0', largest_words(0.4_dp, 1.0_dp))
      call expect('0.4', '1.1', '')
      call expect('0.1', '0.25', largest_words(0.1_dp, 0.25_dp))

   contains

      !> What is warned of.
      function largest_words(torque, scale) result(words)
         real(dp), intent(in) :: torque
         real(dp), intent(in) :: scale
         character(:), allocatable :: words

         words = 'the drag of '//short_text(torque*force_of_torque, 4)//' N is larger than the inertia force of '// &
                 short_text(scale*largest, 4)//' N at most'
      end function largest_words

      subroutine expect(torque, scale, words)
         character(*), intent(in) :: torque
         character(*), intent(in) :: scale
         !> Empty: no warning of the drag
         character(*), intent(in) :: words
         type(scene_t) :: scene
         logical :: reported, right
         integer :: i

         call read_well(checks, gear//', drag_torque = '//torque//' /'//line_feed//shaft//oil//film// &
                        '&load force_scale = '//scale//' /', scene)
         reported = .false.
         right = .false.
         do i = 1, size(scene%warnings)
            reported = reported .or. index(scene%warnings(i)%text, 'the drag of') > 0
            if (len(words) > 0) right = right .or. index(scene%warnings(i)%text, words) > 0
         end do
         call checks%check(reported .eqv. len(words) > 0, 'drag of '//torque//' N m, force times '//scale//': warned or not')
         call checks%check(right .or. len(words) == 0, 'drag of '//torque//' N m, force times '//scale//': '//words)
      end subroutine expect

   end subroutine test_drag_warning

   !> Each order has its own acceleration, as a multiple of the half order that they share.
   subroutine test_force(checks)
      class(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene, cycle

      call read_well(checks, pair, scene)
      associate (load => scene%excitation)
         call checks%check_close(load%frequency, 0.5_dp*800.0_dp/60.0_dp, 1.0e-12_dp, 'the half order of the shaft')
         call checks%check(all(load%force_orders == [4, 7]), 'multiples of the half order')
         call checks%check_close(load%force_amplitudes(1), 600.0_dp*force_of_one, 1.0e-8_dp, 'force of order 2')
         call checks%check_close(load%force_amplitudes(2), 150.0_dp*force_of_one, 1.0e-8_dp, 'force of order 3.5')
         call checks%check_close(load%steady_force, 0.1_dp*force_of_torque, 1.0e-8_dp, 'force of the drag')
      end associate
      ! Amplitudes of the speed: the acceleration is their derivative, a quarter of a period ahead.
      cycle = scene
      cycle%shaft%speed_amplitudes = [0.5_dp, 0.25_dp]
      cycle%shaft%phases = [0.1_dp, 0.2_dp]
      call derive(cycle)
      associate (a => cycle%excitation%force_amplitudes, per_second => 2.0_dp*pi*800.0_dp/60.0_dp)
         call checks%check_close(a(1), 0.5_dp*2.0_dp*per_second*force_of_one, 1.0e-8_dp, 'derivative of order 2')
         call checks%check_close(a(2), 0.25_dp*3.5_dp*per_second*force_of_one, 1.0e-8_dp, 'derivative of order 3.5')
         call checks%check_close(cycle%excitation%force_phases(2), 0.2_dp + 0.5_dp*pi, 1.0e-14_dp, 'a quarter ahead')
      end associate
   end subroutine test_force

   !> What follows stands in the resolved input with the unit that its key has.
   subroutine test_reported_units(checks)
      class(check_list_t), intent(inout) :: checks
      !> Those that are no keys, as their units
      character(*), parameter :: others(7) = [character(40) :: 'gear.base_radius_1 m', 'gear.base_radius_2 m', &
                                              'gear.working_pressure_angle deg', 'gear.base_helix_angle deg', &
                                              'gear.profile_shift_sum', 'gear.contact_ratio', 'gear.overlap_ratio']
      character(*), parameter :: head = '! derived: '
      type(scene_t) :: scene
      character(:), allocatable :: line, name, unit
      character(40) :: expected
      integer :: start, length, known, i

      call read_well(checks, pair, scene)
      known = 0
      start = 1
      do while (start <= len(scene%resolved_input))
         length = index(scene%resolved_input(start:)//line_feed, line_feed)
         line = scene%resolved_input(start:start + length - 2)
         start = start + length
         if (index(line, head) /= 1) cycle
         known = known + 1
         name = line(len(head) + 1:index(line, ' = ') - 1)
         ! The unit stands behind the last number, which a comma or its name comes before.
         unit = line(index(line, ', ', back=.true.) + 2:)
         if (index(line, ', ') == 0) unit = line(index(line, ' = ') + 3:)
         unit = unit(index(unit//' ', ' ') + 1:)
         expected = ''
         do i = 1, size(others)
            if (index(others(i), name//' ') == 1) expected = others(i) (len(name) + 2:)
         end do
         if (find_key(name) > 0) then
            expected = keys(find_key(name))%unit
            if (expected == '-') expected = ''
         else
            call checks%check(any(index(others, name//' ') == 1), 'a derived number that is known: '//name)
         end if
         call checks%check(unit == expected, 'unit of '//line)
      end do
      call checks%check(known == 21, 'all that follows is reported')
      call reported('load.steady_force', scene%excitation%steady_force)
      call reported('load.mass', scene%excitation%mass)
      call reported('load.frequency', scene%excitation%frequency)
      call reported('load.gravity', scene%excitation%gravity)
      call reported('contact.radius', scene%contact%radius)
      call reported('contact.length', scene%contact%length)
      call reported('contact.backlash', scene%contact%backlash)
      call reported('kinematics.entrainment_speed', scene%kinematics%entrainment_speed)
      call reported('lubricant.viscosity', scene%lubricant%viscosity)
      call reported('lubricant.pressure_viscosity', scene%lubricant%pressure_viscosity)

   contains

      !> A number of the scene is the one reported.
      subroutine reported(key, number)
         character(*), intent(in) :: key
         real(dp), intent(in) :: number
         real(dp) :: read_back
         integer :: place, status

         place = index(scene%resolved_input, head//key//' = ') + len(head//key//' = ')
         read (scene%resolved_input(place:), *, iostat=status) read_back
         call checks%check(status == 0, 'a number is reported of '//key)
         if (status == 0) call checks%check_close(read_back, number, 1.0e-9_dp*abs(number), 'reported: '//key)
      end subroutine reported

   end subroutine test_reported_units

   !> The data of an oil are compared with the coldest and the hottest of all scenes.
   subroutine test_temperatures(checks)
      class(check_list_t), intent(inout) :: checks
      character(*), parameter :: campaign = '&scene task = "campaign" /'//line_feed//'&campaign vary = "shaft.speed_rpm", '// &
                                 '"oil.temperature_celsius", '

      call warn('', 0)
      call warn('&scene task = "sweep" /'//line_feed//'&sweep key = "temperature_celsius", first = 40, last = 170, count = 3 /', 1)
      call warn('&scene task = "sweep" /'//line_feed//'&sweep key = "temperature_celsius", first = -30, last = 40, count = 3 /', 1)
      call warn(campaign//'first = 600, -30, last = 900, 170, count = 2, 2 /', 2)
      call warn(campaign//'first = 600, 170, last = 900, -30, count = 2, 2 /', 2)
      call warn(campaign//'first = 600, 40, last = 900, 100, count = 2, 2 /', 0)
      call warn(campaign//'values(:, 1) = 600, 900, values(:, 2) = -30, 40 /', 1)
      call warn(campaign//'values(:, 1) = 600, 900, values(:, 2) = 40, 170 /', 1)

   contains

      !> How often a viscosity is said to be extrapolated.
      subroutine warn(text, count)
         character(*), intent(in) :: text
         integer, intent(in) :: count
         type(scene_t) :: scene
         integer :: i, reported

         call read_well(checks, pair//text, scene)
         reported = 0
         do i = 1, size(scene%warnings)
            if (index(scene%warnings(i)%text, 'extrapolated by 70 K') > 0) reported = reported + 1
         end do
         call checks%check(reported == count, 'viscosities extrapolated: '//text)
      end subroutine warn

   end subroutine test_temperatures

   !> Four samples for each multiple of the base frequency are enough, and fewer are not.
   subroutine test_highest_order(checks)
      class(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene
      type(fault_list_t) :: faults

      ! Of the half order that both share, the multiples are 4 and 7.
      call read_well(checks, pair//'&solver samples_per_period = 28 /', scene)
      call read_text(pair//'&solver samples_per_period = 27 /', scene, faults)
      call checks%check(faults%count() == 1, 'fewer than four samples for the highest order')
      if (faults%count() > 0) call checks%check(index(faults%sentence(1), 'at least four for each multiple') > 0, &
                                                faults%sentence(1))
   end subroutine test_highest_order

end module test_derived_scene
