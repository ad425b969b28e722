!> Tests of the drag on a loose gear, of measured tables, of contact ratios and of the balance of inertia against drag. References
!> were computed apart from this program.
module test_drag
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use checks, only: check_list_t
   use constants, only: two_pi
   use derived_scene, only: derive, derived_rules
   use drag_parts, only: churning_torque, needle_bearing_torque, sheared_gap_torque
   use force, only: force_of, inertia_ratio
   use gear_contact, only: find_contact, gear_contact_t
   use kinds, only: dp
   use loose_gear_drag, only: drag_of_gear, gap_is_turbulent, reference_diameter
   use oil_data, only: oil_viscosity, viscosity_temperature_slope
   use scene_types, only: drag_t, drag_table_t, excitation_t, excitation_table_t, gear_t, oil_t, scene_t
   use table_values, only: excitation_at, is_within, torque_of_table
   implicit none(type, external)
   private

   !> Of references with twelve digits
   real(dp), parameter :: tolerance = 1.0e-9_dp

   public :: run_drag_tests

contains

   !> Runs every test of this topic.
   subroutine run_drag_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('drag')
      call test_references(checks)
      call test_relative_speed(checks)
      call test_bearing(checks)
      call test_gap(checks)
      call test_churning(checks)
      call test_viscosity_slope(checks)
      call test_whirls(checks)
      call test_drag_table(checks)
      call test_excitation_table(checks)
      call test_contact_ratios(checks)
      call test_tips(checks)
      call test_inertia_ratio(checks)
      call test_derived_anew(checks)
      call test_derived_rules(checks)
   end subroutine run_drag_tests

   !> The pair of the references: 19/37 with a needle bearing, a double cone and oil up to a third of the radius below its axis.
   pure function pair() result(gear)
      type(gear_t) :: gear

      gear%given = .true.
      gear%teeth_1 = 19
      gear%teeth_2 = 37
      gear%normal_module = 2.2e-3_dp
      gear%pressure_angle_deg = 20.0_dp
      gear%helix_angle_deg = 28.0_dp
      gear%face_width = 0.016_dp
      gear%centre_distance = 0.070_dp
      gear%loose_inertia = 8.9e-4_dp
      gear%bearing_mean_diameter = 0.038_dp
      gear%bearing_factor = 6.0_dp
      gear%synchroniser_cones = 2
      gear%synchroniser_diameter = 0.062_dp
      gear%synchroniser_width = 0.008_dp
      gear%synchroniser_gap = 0.2e-3_dp
      gear%immersion_depth = reference_diameter(gear)/3.0_dp
   end function pair

   pure type(oil_t) function oil_at(temperature)
      real(dp), intent(in) :: temperature  !> [degC]

      oil_at = oil_t(.true., 58.0_dp, 9.6_dp, 870.0_dp, temperature, volume=2.0e-3_dp)
   end function oil_at

   !> Cases D1 to D6: cold and hot, both branches of churning and between, a shaft that turns along and one that is faster.
   subroutine test_references(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(gear_t) :: gear

      gear = pair()
      call checks%check_close(reference_diameter(gear), 2.0_dp*0.046095601063_dp, 1.0e-12_dp, 'reference diameter')
      call check('D1', gear, 800.0_dp, -20.0_dp, [0.379199850795_dp, 1.35986651878_dp, 0.0843236932516_dp, 1.82339006283_dp])
      call check('D2', gear, 800.0_dp, 100.0_dp, [0.00821821385238_dp, 0.00501152968815_dp, 0.0228524999855_dp, &
                                                  0.0360822435261_dp])
      call check('D3', gear, 1800.0_dp, 100.0_dp, [0.0141112596677_dp, 0.0112675792162_dp, 0.0480317784194_dp, &
                                                   0.0734106173033_dp])
      call check('D4', gear, 3000.0_dp, 100.0_dp, [0.0198364955872_dp, 0.0187485096258_dp, 0.0680269570921_dp, &
                                                   0.106611962305_dp])
      gear%own_shaft_ratio = 0.48_dp
      gear%bearing_factor = 12.0_dp
      gear%synchroniser_cones = 1
      gear%immersion_depth = 0.0_dp
      call check('D5', gear, 600.0_dp, 120.0_dp, [0.010535424_dp, 8.17417855043e-5_dp, 0.0_dp, 0.0106171657855_dp])
      gear = pair()
      gear%own_shaft_ratio = 0.9_dp
      gear%bearing_width = 0.02_dp
      gear%bearing_clearance = 3.0e-5_dp
      call check('D6', gear, 2000.0_dp, 40.0_dp, [-0.11465081617_dp, -0.0594640409137_dp, 0.0602147116024_dp, -0.113900145482_dp])
      gear%drag_scale = 2.5_dp
      call check('a scaled drag', gear, 2000.0_dp, 40.0_dp, 2.5_dp* &
                 [-0.11465081617_dp, -0.0594640409137_dp, 0.0602147116024_dp, -0.113900145482_dp])

   contains

      subroutine check(what, gear, speed_rpm, temperature, expected)
         character(*), intent(in) :: what
         type(gear_t), intent(in) :: gear
         real(dp), intent(in) :: speed_rpm
         real(dp), intent(in) :: temperature
         !> Bearing, synchroniser, churning, all
         real(dp), intent(in) :: expected(4)
         type(drag_t) :: drag

         drag = drag_of_gear(gear, speed_rpm, oil_at(temperature))
         call checks%check_close(drag%bearing, expected(1), tolerance*abs(expected(1)), what//': bearing')
         call checks%check_close(drag%synchroniser, expected(2), tolerance*abs(expected(2)), what//': synchroniser')
         call checks%check_close(drag%churning, expected(3), tolerance*abs(expected(3)), what//': churning')
         call checks%check_close(drag%torque, expected(4), tolerance*abs(expected(4)), what//': all')
      end subroutine check

   end subroutine test_references

   !> Bearing and synchroniser brake against the own shaft, churning against the housing; a shaft as fast as the gear does nothing.
   subroutine test_relative_speed(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(gear_t) :: gear
      type(drag_t) :: drag, slower, faster

      gear = pair()
      drag = drag_of_gear(gear, 1500.0_dp, oil_at(60.0_dp))
      gear%own_shaft_ratio = 19.0_dp/37.0_dp
      slower = drag_of_gear(gear, 1500.0_dp, oil_at(60.0_dp))
      call checks%check_close(abs(slower%bearing) + abs(slower%synchroniser), 0.0_dp, 0.0_dp, 'a shaft as fast as the gear')
      call checks%check_close(slower%churning, drag%churning, 0.0_dp, 'churning asks for no shaft')
      gear%own_shaft_ratio = 0.513514_dp
      slower = drag_of_gear(gear, 1500.0_dp, oil_at(60.0_dp))
      call checks%check(slower%bearing < 0.0_dp, 'a little beside it the bearing brakes as dry friction does')
      gear%own_shaft_ratio = 0.0_dp
      drag = drag_of_gear(gear, 1500.0_dp, oil_at(60.0_dp))
      gear%own_shaft_ratio = 2.0_dp*19.0_dp/37.0_dp
      faster = drag_of_gear(gear, 1500.0_dp, oil_at(60.0_dp))
      call checks%check_close(faster%bearing, -drag%bearing, 1.0e-14_dp*drag%bearing, 'a shaft of twice the speed: bearing')
      call checks%check_close(faster%synchroniser, -drag%synchroniser, 1.0e-14_dp*drag%synchroniser, &
                              'a shaft of twice the speed: synchroniser')
      call checks%check_close(faster%churning, drag%churning, 0.0_dp, 'a shaft of twice the speed: churning')
   end subroutine test_relative_speed

   !> 160 up to nu n = 2023.86, the power above; no speed, no torque.
   subroutine test_bearing(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      real(dp), parameter :: by_hand = 1.0e-10_dp*6.0_dp*38.0_dp**3

      call checks%check_close(needle_bearing_torque(6.0_dp, 0.038_dp, 2.0_dp, 1000.0_dp), by_hand*160.0_dp, 1.0e-17_dp, &
                              'bearing: nu n = 2000')
      call checks%check_close(needle_bearing_torque(6.0_dp, 0.038_dp, 2.0_dp, 1011.92_dp), by_hand*160.0_dp, 1.0e-17_dp, &
                              'bearing: nu n = 2023.84')
      call checks%check(needle_bearing_torque(6.0_dp, 0.038_dp, 2.0_dp, 1011.94_dp) > by_hand*160.0_dp, 'bearing: nu n = 2023.88')
      call checks%check_close(needle_bearing_torque(6.0_dp, 0.038_dp, 8.0_dp, 1000.0_dp), by_hand*400.0_dp, 1.0e-16_dp, &
                              'bearing: nu n = 8000')
      call checks%check_close(needle_bearing_torque(6.0_dp, 0.038_dp, 8.0_dp, 0.0_dp), 0.0_dp, 0.0_dp, 'bearing: at rest')
   end subroutine test_bearing

   !> Petrov's law where the film stays cool, less where it is heated; two gaps brake twice.
   subroutine test_gap(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(gear_t) :: gear
      type(drag_t) :: double, single
      real(dp), parameter :: petrov = two_pi*0.05_dp*10.0_dp*0.03_dp**3*0.008_dp/2.0e-4_dp
      real(dp) :: heated, q

      call checks%check_close(sheared_gap_torque(0.06_dp, 0.008_dp, 2.0e-4_dp, 0.05_dp, 0.0_dp, 10.0_dp), petrov, &
                              1.0e-14_dp*petrov, 'gap: no heating')
      call checks%check_close(sheared_gap_torque(0.06_dp, 0.008_dp, 2.0e-4_dp, 0.05_dp, 0.05_dp, 0.0_dp), 0.0_dp, 0.0_dp, &
                              'gap: at rest')
      q = sqrt(0.05_dp*0.05_dp*(10.0_dp*0.03_dp)**2/(8.0_dp*0.14_dp))
      heated = petrov*log(q + sqrt(1.0_dp + q**2))/(q*sqrt(1.0_dp + q**2))
      call checks%check_close(sheared_gap_torque(0.06_dp, 0.008_dp, 2.0e-4_dp, 0.05_dp, 0.05_dp, 10.0_dp), heated, &
                              1.0e-13_dp*petrov, 'gap: heating')
      gear = pair()
      double = drag_of_gear(gear, 1500.0_dp, oil_at(20.0_dp))
      gear%synchroniser_cones = 1
      single = drag_of_gear(gear, 1500.0_dp, oil_at(20.0_dp))
      call checks%check_close(double%synchroniser, 2.0_dp*single%synchroniser, 1.0e-15_dp, 'a double cone has two gaps')
      gear%synchroniser_cones = 0
      single = drag_of_gear(gear, 1500.0_dp, oil_at(20.0_dp))
      call checks%check_close(single%synchroniser, 0.0_dp, 0.0_dp, 'no cone, no synchroniser')
   end subroutine test_gap

   !> A gear that does not dip churns nothing; one that is covered has its whole surface in oil.
   subroutine test_churning(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      real(dp), parameter :: depths(3) = [0.0_dp, 0.04_dp, 0.08_dp]
      real(dp) :: torques(3)

      torques = churning_torque(40, 2.0e-3_dp, 0.36_dp, 0.0_dp, 0.02_dp, depths, 1.0e-3_dp, 850.0_dp, 2.0e-5_dp, 100.0_dp)
      call checks%check_close(torques(1), 0.0_dp, 0.0_dp, 'churning: no depth')
      ! Half of the gear has half of the surface: half of the torque but for (h/D)**0.45.
      call checks%check_close(torques(3)/torques(2), 2.0_dp*2.0_dp**0.45_dp, 1.0e-12_dp, 'churning: covered and half covered')
   end subroutine test_churning

   !> beta against a difference of viscosities.
   subroutine test_viscosity_slope(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      real(dp), parameter :: temperatures(4) = [-20.0_dp, 20.0_dp, 60.0_dp, 120.0_dp], step = 1.0e-3_dp
      real(dp) :: slopes(4), differences(4)

      slopes = viscosity_temperature_slope(58.0_dp, 9.6_dp, 870.0_dp, temperatures)
      differences = -(log(oil_viscosity(58.0_dp, 9.6_dp, 870.0_dp, temperatures + step)) - &
                      log(oil_viscosity(58.0_dp, 9.6_dp, 870.0_dp, temperatures - step)))/(2.0_dp*step)
      ! The step leaves step**2 times the third derivative, and rounding 1e-16/step.
      call checks%check(all(abs(slopes - differences) < 1.0e-9_dp*abs(slopes)), 'beta is the slope of the viscosity')
   end subroutine test_viscosity_slope

   !> The gap of the pair stays laminar up to 120 degC and 3500 1/min, where its number is 14 of 41.
   subroutine test_whirls(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(gear_t) :: gear

      gear = pair()
      call checks%check(.not. gap_is_turbulent(gear, 3500.0_dp, oil_at(120.0_dp)), 'the gap of the pair is laminar')
      call checks%check(gap_is_turbulent(gear, 3500.0_dp*3.1_dp, oil_at(120.0_dp)), 'three times as fast it is not')
   end subroutine test_whirls

   !> Case E2, the rows themselves, the border, one row, and rows beside a single temperature.
   subroutine test_drag_table(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(drag_table_t) :: table

      table = drag_table_t([600.0_dp, 1000.0_dp], [20.0_dp, 60.0_dp], &
                           reshape([0.16_dp, 0.20_dp, 0.05_dp, 0.07_dp], [2, 2]))
      call checks%check_close(torque_of_table(table, 700.0_dp, 50.0_dp), 0.08375_dp, 1.0e-15_dp, 'E2')
      call checks%check_close(torque_of_table(table, 600.0_dp, 60.0_dp), 0.05_dp, 0.0_dp, 'E2: a row')
      call checks%check_close(torque_of_table(table, 1000.0_dp, 20.0_dp), 0.20_dp, 0.0_dp, 'E2: another row')
      call checks%check(is_within(table%speeds, 600.0_dp) .and. is_within(table%speeds, 1000.0_dp), 'E2: both ends are within')
      call checks%check(.not. (is_within(table%speeds, 599.9_dp) .or. is_within(table%speeds, 1000.1_dp)), 'E2: beyond them')
      table = drag_table_t([600.0_dp, 1000.0_dp], [20.0_dp], reshape([0.16_dp, 0.20_dp], [2, 1]))
      call checks%check_close(torque_of_table(table, 900.0_dp, 20.0_dp), 0.19_dp, 1.0e-15_dp, 'one temperature')
   end subroutine test_drag_table

   !> Case E1: phases go the short way round, over pi and back.
   subroutine test_excitation_table(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(excitation_table_t) :: table
      real(dp), allocatable :: accelerations(:), phases(:)

      table = excitation_table_t([600.0_dp, 1000.0_dp, 2000.0_dp], [2.0_dp, 4.0_dp], &
                                 reshape([900.0_dp, 600.0_dp, 500.0_dp, 120.0_dp, 100.0_dp, 150.0_dp], [3, 2]), &
                                 reshape([0.0_dp, 0.2_dp, 0.4_dp, 3.0_dp, -3.0_dp, -2.0_dp], [3, 2]))
      call excitation_at(table, 700.0_dp, accelerations, phases)
      call checks%check_close(accelerations(1), 825.0_dp, 1.0e-12_dp, 'E1: amplitude')
      call checks%check_close(accelerations(2), 115.0_dp, 1.0e-12_dp, 'E1: amplitude of the fourth order')
      call checks%check_close(phases(1), 0.05_dp, 1.0e-15_dp, 'E1: phase')
      call checks%check_close(phases(2), 3.07079632679_dp, 1.0e-11_dp, 'E1: phase the short way round')
      call excitation_at(table, 1000.0_dp, accelerations, phases)
      call checks%check_close(accelerations(1), 600.0_dp, 0.0_dp, 'E1: a row')
      call checks%check_close(phases(2), -3.0_dp, 0.0_dp, 'E1: phase of a row')
      call excitation_at(table, 2000.0_dp, accelerations, phases)
      call checks%check_close(accelerations(2), 150.0_dp, 0.0_dp, 'E1: the last row')
      table%phases(:, 2) = [-3.0_dp, 3.0_dp, 2.0_dp]
      call excitation_at(table, 700.0_dp, accelerations, phases)
      call checks%check_close(phases(2), -3.07079632679_dp, 1.0e-11_dp, 'E1 mirrored: phase the short way round')
   end subroutine test_excitation_table

   !> Contact ratios of two pairs whose tip diameters are not known, and of one with tips as high that are not shortened.
   subroutine test_contact_ratios(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(gear_t) :: gears
      type(gear_contact_t) :: contact
      character(:), allocatable :: wrong, message
      real(dp) :: tips(2), length
      real(dp), parameter :: shift = 0.5_dp*0.107257065_dp

      gears = gear_t(teeth_1=19, teeth_2=37, normal_module=2.2e-3_dp, pressure_angle_deg=20.0_dp, helix_angle_deg=28.0_dp, &
                     face_width=0.016_dp, centre_distance=0.070_dp, loose_inertia=8.9e-4_dp)
      call find_contact(gears, 0.0_dp, 10.0_dp, contact, wrong, message)
      call checks%check_close(contact%teeth%contact_ratio, 1.351943473539_dp, 1.0e-12_dp, '19/37: eps_alpha')
      call checks%check_close(contact%teeth%overlap_ratio, 1.0868177434_dp, 1.0e-10_dp, '19/37: eps_beta')
      call checks%check_close(contact%contact_lines, 1.0_dp, 0.0_dp, '19/37: one line where no tip diameter is given')
      length = contact%length
      tips = 2.0_dp*(0.5_dp*2.2e-3_dp*[19.0_dp, 37.0_dp]/cos(28.0_dp*two_pi/360.0_dp) + 2.2e-3_dp*(1.0_dp + shift))
      gears%tip_diameter_1 = tips(1)
      gears%tip_diameter_2 = tips(2)
      call find_contact(gears, 0.0_dp, 10.0_dp, contact, wrong, message)
      call checks%check_close(contact%contact_lines, 1.35319203678_dp, 1.0e-8_dp, '19/37: lines by the tip diameters')
      call checks%check_close(contact%length, length*contact%contact_lines, 1.0e-15_dp, '19/37: length of all lines')
      call checks%check_close(contact%tooth_width, 0.016_dp*contact%contact_lines, 1.0e-15_dp, '19/37: width of all teeth')
      gears = gear_t(teeth_1=11, teeth_2=38, normal_module=2.5e-3_dp, pressure_angle_deg=20.0_dp, helix_angle_deg=-28.96_dp, &
                     face_width=0.016_dp, loose_inertia=1.715e-3_dp)
      call find_contact(gears, 0.0_dp, 10.0_dp, contact, wrong, message)
      call checks%check_close(contact%teeth%contact_ratio, 1.30511390286_dp, 1.0e-11_dp, '11/38: eps_alpha')
      call checks%check_close(contact%teeth%overlap_ratio, 0.986401904099_dp, 1.0e-12_dp, '11/38: eps_beta, whichever the hand')
   end subroutine test_contact_ratios

   !> Tips that interfere, that lie within the base circle, that do not reach each other.
   subroutine test_tips(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call check(0.048_dp, 0.097_dp, '')
      call check(0.071_dp, 0.097_dp, 'tip_diameter_1')
      call check(0.048_dp, 0.112_dp, 'tip_diameter_2')
      call check(0.043_dp, 0.097_dp, 'tip_diameter_1')
      call check(0.048_dp, 0.085_dp, 'tip_diameter_2')
      call check(0.0444_dp, 0.0861_dp, 'tip_diameter_1')

   contains

      subroutine check(first, second, expected)
         real(dp), intent(in) :: first
         real(dp), intent(in) :: second
         character(*), intent(in) :: expected
         type(gear_contact_t) :: contact
         character(:), allocatable :: wrong, message

         call find_contact(gear_t(teeth_1=19, teeth_2=37, normal_module=2.2e-3_dp, pressure_angle_deg=20.0_dp, &
                                  helix_angle_deg=28.0_dp, face_width=0.016_dp, centre_distance=0.070_dp, loose_inertia=8.9e-4_dp, &
                                  tip_diameter_1=first, tip_diameter_2=second), 0.0_dp, 10.0_dp, contact, wrong, message)
         call checks%check(wrong == expected .and. (len(message) > 0 .eqv. len(expected) > 0), 'tips: '//expected//' '//wrong)
      end subroutine check

   end subroutine test_tips

   !> The largest deceleration of a sum counts, not the sum of its amplitudes; where the drag is negative the largest acceleration.
   subroutine test_inertia_ratio(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(excitation_t) :: excitation

      excitation%steady_force = 100.0_dp
      excitation%force_orders = [1, 2, 3]
      excitation%force_amplitudes = [600.0_dp, 100.0_dp, 50.0_dp]
      excitation%force_phases = [0.0_dp, 0.8_dp, -0.5_dp]
      call checks%check_close(inertia_ratio(force_of(excitation)), 6.0307131488_dp, 6.0e-9_dp, 'Lambda of three orders')
      excitation%force_scale = 0.5_dp
      call checks%check_close(inertia_ratio(force_of(excitation)), 3.0153565744_dp, 3.0e-9_dp, 'Lambda of half the motion')
      excitation%force_scale = -1.0_dp
      excitation%steady_force = -100.0_dp
      call checks%check_close(inertia_ratio(force_of(excitation)), 6.0307131488_dp, 6.0e-9_dp, 'Lambda of all reversed')
      excitation%steady_force = 0.0_dp
      call checks%check(ieee_is_nan(inertia_ratio(force_of(excitation))), 'no Lambda without a drag')
      excitation = excitation_t(steady_force=2.240374258_dp, force_amplitude=6.673367428_dp)
      call checks%check_close(inertia_ratio(force_of(excitation)), 2.97868421_dp, 1.0e-8_dp, 'Lambda of one order is F0/Q')
   end subroutine test_inertia_ratio

   !> A scene whose speed, temperature and pair come and go is derived as if it were the first.
   subroutine test_derived_anew(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(scene_t) :: scene, alone
      real(dp), parameter :: speeds(4) = [700.0_dp, 2000.0_dp, 600.0_dp, 700.0_dp], &
                             temperatures(4) = [-20.0_dp, 100.0_dp, 20.0_dp, 60.0_dp]
      integer :: i

      call make_scene(scene)
      do i = 1, size(speeds)
         if (i == 3) scene%gear%drag_table = drag_table_t([600.0_dp, 1000.0_dp], [20.0_dp, 60.0_dp], &
                                                          reshape([0.16_dp, 0.20_dp, 0.05_dp, 0.07_dp], [2, 2]))
         if (i == 3) scene%gear%bearing_mean_diameter = 0.0_dp
         scene%shaft%speed_rpm = speeds(i)
         scene%oil%temperature_celsius = temperatures(i)
         call derive(scene)
         call make_scene(alone)
         alone%gear = scene%gear
         alone%shaft%speed_rpm = speeds(i)
         alone%oil%temperature_celsius = temperatures(i)
         call derive(alone)
         call checks%check_close(scene%drag%torque, alone%drag%torque, 0.0_dp, 'derived anew: drag')
         call checks%check_close(scene%drag%churning, alone%drag%churning, 0.0_dp, 'derived anew: churning')
         call checks%check_close(scene%excitation%steady_force, alone%excitation%steady_force, 0.0_dp, 'derived anew: Q')
         call checks%check_close(maxval(abs(scene%excitation%force_amplitudes - alone%excitation%force_amplitudes)), 0.0_dp, &
                                 0.0_dp, 'derived anew: amplitudes')
         call checks%check_close(maxval(abs(scene%excitation%force_phases - alone%excitation%force_phases)), 0.0_dp, 0.0_dp, &
                                 'derived anew: phases')
      end do
      call checks%check_close(scene%drag%torque, 0.055_dp, 1.0e-15_dp, 'derived anew: the drag is that of the table')
      call checks%check_close(scene%excitation%force_phases(2), 3.07079632679_dp, 1.0e-11_dp, 'derived anew: phase of the table')
   end subroutine test_derived_anew

   !> The pair on a shaft with the run-up of E1.
   pure subroutine make_scene(scene)
      type(scene_t), intent(out) :: scene

      scene%gear = pair()
      scene%gear%backlash = 9.0e-5_dp
      scene%oil = oil_at(60.0_dp)
      scene%solver%method = 2
      scene%solver%kept_per_period = 512
      scene%shaft%speed_rpm = 1000.0_dp
      allocate (scene%shaft%orders, source=[2.0_dp, 4.0_dp])
      allocate (scene%shaft%table)
      associate (table => scene%shaft%table)
         allocate (table%speeds, source=[600.0_dp, 1000.0_dp, 2000.0_dp])
         allocate (table%orders, source=[2.0_dp, 4.0_dp])
         allocate (table%accelerations, source=reshape([900.0_dp, 600.0_dp, 500.0_dp, 120.0_dp, 100.0_dp, 150.0_dp], [3, 2]))
         allocate (table%phases, source=reshape([0.0_dp, 0.2_dp, 0.4_dp, 3.0_dp, -3.0_dp, -2.0_dp], [3, 2]))
      end associate
   end subroutine make_scene

   !> What is refused: beyond a table, deeper than the gear, cones without a gap, no drag without a backlash.
   subroutine test_derived_rules(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(scene_t) :: scene

      call make_scene(scene)
      call check(scene, '')
      scene%shaft%speed_rpm = 599.0_dp
      call check(scene, 'shaft.speed_rpm')
      scene%shaft%speed_rpm = 2001.0_dp
      call check(scene, 'shaft.speed_rpm')
      call make_scene(scene)
      scene%gear%immersion_depth = reference_diameter(scene%gear)
      call check(scene, '')
      scene%gear%immersion_depth = 1.0001_dp*reference_diameter(scene%gear)
      call check(scene, 'gear.immersion_depth')
      call make_scene(scene)
      scene%gear%synchroniser_gap = 0.0_dp
      call check(scene, 'gear.synchroniser_cones')
      scene%gear%synchroniser_cones = 0
      call check(scene, '')
      scene%gear%own_shaft_ratio = 2.0_dp
      scene%gear%immersion_depth = 0.0_dp
      call check(scene, '')
      scene%gear%backlash = 0.0_dp
      call check(scene, 'gear.bearing_mean_diameter')
      call make_scene(scene)
      scene%gear%bearing_mean_diameter = 0.0_dp
      scene%gear%drag_table = drag_table_t([600.0_dp, 1000.0_dp], [20.0_dp, 60.0_dp], &
                                           reshape([0.16_dp, 0.20_dp, 0.05_dp, 0.07_dp], [2, 2]))
      call check(scene, '')
      scene%oil%temperature_celsius = 60.5_dp
      call check(scene, 'oil.temperature_celsius')

   contains

      subroutine check(tried, expected)
         type(scene_t), intent(in) :: tried
         character(*), intent(in) :: expected
         type(scene_t) :: scene

         scene = tried
         call derive(scene)
         associate (broken => derived_rules(scene))
            if (len(expected) == 0) then
               call checks%check(size(broken) == 0, 'rules: nothing is wrong')
            else
               call checks%check(size(broken) > 0, 'rules: '//expected)
               if (size(broken) > 0) call checks%check(broken(1)%keys == expected, 'rules: '//expected//', not '//broken(1)%keys)
            end if
         end associate
      end subroutine check

   end subroutine test_derived_rules

end module test_drag
