!> Tests of the values of quantities: of a scene in which every number is another, each quantity has its own number and no other.
module test_judged_scene
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use canonical_scenes, only: loose_gear
   use checks, only: check_list_t
   use coexisting_motions, only: motion_summary_t
   use impacts, only: impact_t
   use judged_scene, only: judged_scene_t, quantity_list, quantity_value
   use kinds, only: dp
   use problem, only: coast_flank, drive_flank
   use node_extremes, only: seen_acceleration, seen_films, seen_loads, seen_position, seen_quantities, seen_velocity
   use quantities, only: quantity_table
   use rattle_class, only: class_creep, class_idle, class_irregular
   use prepared_scene, only: resolve
   use scene_types, only: drag_computed, scene_t
   use vibration_severity, only: vibration_severity_t
   implicit none(type, external)
   private

   public :: run_judged_scene_tests

contains

   !> Runs every test of this topic.
   subroutine run_judged_scene_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(judged_scene_t) :: judged

      call checks%start('judged_scene')
      judged = made_up()
      call test_numbers(checks, judged)
      call test_lists(checks, judged)
      call test_unknown(checks, judged)
   end subroutine run_judged_scene_tests

   !> A scene between two flanks with elastic teeth, in which every number is another.
   type(judged_scene_t) function made_up() result(judged)
      type(scene_t) :: scene
      integer :: i

      scene = loose_gear()
      scene%contact%stiffness = 2.8e8_dp
      scene%contact%damping_ratio = 0.02_dp
      judged%resolved = resolve(scene)
      judged%resolved%steady_film = 1.5_dp
      judged%resolved%gear_speed = 9.0_dp
      judged%resolved%natural_frequency = 2.5_dp
      judged%resolved%damping_ratio = 3.5_dp
      judged%resolved%drag%known_by = drag_computed
      judged%resolved%drag%torque = 4.5_dp
      judged%resolved%drag%bearing = 5.5_dp
      judged%resolved%drag%synchroniser = 6.5_dp
      judged%resolved%drag%churning = 7.5_dp
      judged%judged = .true.
      judged%ending%periods = 40
      judged%repeats_after = 3
      judged%ending%count%steps = 50
      judged%ending%count%evaluations = 75
      judged%ending%count%cuts = 9
      judged%window_periods = 4
      judged%samples_per_period = 64
      judged%rattle%class = class_idle
      judged%rattle%reversals_per_period = 11.0_dp
      judged%rattle%parting%periods = 100
      judged%rattle%parting%exponent = 0.125_dp
      judged%rattle%spectrum%harmonics = [21.0_dp, 22.0_dp]
      judged%rattle%spectrum%harmonic_count = 23
      judged%rattle%spectrum%harmonic_distortion = 24.0_dp
      judged%rattle%spectrum%irregular_fraction = 25.0_dp
      judged%rattle%spectrum%spectral_reach = 26.0_dp
      judged%severity%acceleration_rms = 31.0_dp
      judged%severity%acceleration_kurtosis = 32.0_dp
      judged%severity%film_force_rms = 33.0_dp
      judged%severity%dissipated_energy = 34.0_dp
      judged%severity%tooth_energy = 10.0_dp
      do i = 1, seen_quantities
         judged%extremes%lowest(i)%value = 100.0_dp + real(i, dp)
         judged%extremes%highest(i)%value = 200.0_dp + real(i, dp)
         judged%extremes%lowest(i)%state = [2.0e-6_dp, 0.0_dp, 3.0e-6_dp, 0.0_dp, 3.0e-6_dp, 0.0_dp]
         judged%extremes%highest(i)%state = [2.0e-6_dp, 0.0_dp, 3.0e-6_dp, 0.0_dp, 3.0e-6_dp, 0.0_dp]
      end do
      judged%regime%alpha_p_maximum = 41.0_dp
      judged%regime%pressure_maximum = 42.0_dp
      judged%regime%deflection = 43.0_dp
      judged%verification%exists = .true.
      judged%verification%film_error = 51.0_dp
      judged%verification%film_minimum_error = 52.0_dp
      judged%verification%film_maximum_error = 53.0_dp
      judged%verification%acceleration_minimum_error = 54.0_dp
      judged%verification%acceleration_maximum_error = 55.0_dp
      judged%verification%acceleration_error = 56.0_dp
      judged%verification%severity_error = 57.0_dp
      judged%verification%severity_errors = vibration_severity_t(0.61_dp, 0.62_dp, 0.63_dp, 0.64_dp)
      judged%verification%impacts_per_period_errors = [0.65_dp, 0.66_dp]
      judged%verification%impulse_mean_errors = [0.67_dp, 0.68_dp]
      judged%verification%harmonic_errors = [58.0_dp, 59.0_dp]
      judged%orbit%period = 2
      judged%orbit%multipliers = [(0.3_dp, -0.4_dp), (0.1_dp, 0.0_dp)]
      judged%coexisting%motions = [motion_summary_t(class=class_idle, acceleration_rms=82.0_dp, film_force_rms=83.0_dp, &
                                                film_minimum=84.0_dp), &
                                   motion_summary_t(class=class_irregular, verdict=1, acceleration_rms=85.0_dp, &
                                                 film_force_rms=86.0_dp, film_minimum=87.0_dp), &
                                   motion_summary_t(class=class_creep, acceleration_rms=81.0_dp, film_force_rms=88.0_dp, &
                                                 film_minimum=89.0_dp)]
      judged%coexisting%starts_solved = 29
      judged%coexisting%unsettled_starts = 2
      judged%coexisting%extra_periods = 90
      judged%impacts%exists = .true.
      judged%impacts%periods = 4
      judged%impacts%unloaded_share = 0.25_dp
      associate (drive => judged%impacts%contacts(drive_flank), coast => judged%impacts%contacts(coast_flank))
         drive%count = 8
         coast%count = 20
         drive%load_maximum = 61.0_dp
         coast%load_maximum = 62.0_dp
         drive%velocity_maximum = 63.0_dp
         coast%velocity_maximum = 64.0_dp
         drive%impulse_maximum = 65.0_dp
         coast%impulse_maximum = 66.0_dp
         drive%impulse_sum = 16.0_dp
         coast%impulse_sum = 60.0_dp
         drive%approach = 8.0_dp
         drive%departure = 6.0_dp
         coast%approach = 5.0_dp
         coast%departure = 2.0_dp
         drive%kept = [impact_t(time=0.5_dp, load=71.0_dp, velocity=72.0_dp, impulse=73.0_dp)]
         coast%kept = [impact_t(time=1.5_dp, load=74.0_dp, velocity=75.0_dp, impulse=76.0_dp)]
      end associate
   end function made_up

   !> Code of a quantity.
   pure integer function code_of(name)
      character(*), intent(in) :: name

      code_of = findloc(quantity_table%name == name, .true., dim=1)
   end function code_of

   subroutine test_numbers(checks, judged)
      class(check_list_t), intent(inout) :: checks
      type(judged_scene_t), intent(in) :: judged

      call expect('steady_film', 1.5_dp)
      call expect('natural_frequency', 2.5_dp)
      call expect('damping_ratio', 3.5_dp)
      call expect('drag_torque', 4.5_dp)
      call expect('drag_bearing', 5.5_dp)
      call expect('drag_synchroniser', 6.5_dp)
      call expect('drag_churning', 7.5_dp)
      call expect('periods_solved', 40.0_dp)
      call expect('orbit_period', 2.0_dp)
      call expect('steps', 50.0_dp)
      call expect('evaluations', 75.0_dp)
      call expect('iterations_per_step', 1.5_dp)
      call expect('steps_cut', 9.0_dp)
      call expect('window_periods', 4.0_dp)
      call expect('samples_per_period', 64.0_dp)
      call expect('rattle_class', real(class_idle, dp))
      call expect('reversals_per_period', 11.0_dp)
      call expect('reversals_per_second', 11.0_dp*judged%resolved%problem%frequency)
      call expect('reversals_per_revolution', 11.0_dp*judged%resolved%problem%frequency/9.0_dp)
      call expect('spectral_reach', 26.0_dp)
      call expect('lyapunov_exponent', 0.125_dp)
      call expect('harmonic_count', 23.0_dp)
      call expect('harmonic_distortion', 24.0_dp)
      call expect('irregular_fraction', 25.0_dp)
      call expect('acceleration_rms', 31.0_dp)
      call expect('acceleration_kurtosis', 32.0_dp)
      call expect('film_force_rms', 33.0_dp)
      call expect('dissipated_energy', 34.0_dp)
      call expect('dissipated_power', 34.0_dp*judged%resolved%problem%frequency)
      call expect('film_dissipated_power', 24.0_dp*judged%resolved%problem%frequency)
      call expect('tooth_dissipated_power', 10.0_dp*judged%resolved%problem%frequency)
      call expect('crest_factor', (200.0_dp + real(seen_acceleration, dp))/31.0_dp)
      call extremes('film', seen_films(1))
      call extremes('velocity', seen_velocity)
      call extremes('acceleration', seen_acceleration)
      call extremes('load', seen_loads(1))
      call extremes('coast_film', seen_films(2))
      call extremes('gear_position', seen_position)
      call expect('coast_load_maximum', 200.0_dp + real(seen_loads(2), dp))
      call expect('alpha_p_maximum', 41.0_dp)
      call expect('pressure_maximum', 42.0_dp)
      call expect('deflection', 43.0_dp)
      call expect('film_error', 51.0_dp)
      call expect('film_minimum_error', 52.0_dp)
      call expect('film_maximum_error', 53.0_dp)
      call expect('acceleration_minimum_error', 54.0_dp)
      call expect('acceleration_maximum_error', 55.0_dp)
      call expect('acceleration_error', 56.0_dp)
      call expect('severity_error', 57.0_dp)
      call expect('acceleration_rms_error', 0.61_dp)
      call expect('film_force_rms_error', 0.63_dp)
      call expect('dissipated_power_error', 0.64_dp*judged%resolved%problem%frequency)
      call expect('impacts_per_period_drive_error', 0.65_dp)
      call expect('impacts_per_period_coast_error', 0.66_dp)
      call expect('impact_impulse_mean_drive_error', 0.67_dp)
      call expect('impact_impulse_mean_coast_error', 0.68_dp)
      call expect('floquet_modulus', 0.5_dp)
      call expect('motions', 3.0_dp)
      call expect('starts_solved', 29.0_dp)
      call expect('unsettled_starts', 2.0_dp)
      call expect('start_periods', 90.0_dp)
      call expect('loudest_class', real(class_irregular, dp))
      call expect('loudest_verdict', 1.0_dp)
      call expect('loudest_acceleration_rms', 85.0_dp)
      call expect('loudest_film_force_rms', 86.0_dp)
      call expect('loudest_film_minimum', 87.0_dp)
      call expect('quietest_class', real(class_creep, dp))
      call expect('quietest_acceleration_rms', 81.0_dp)
      call expect('unloaded_share', 0.25_dp)
      call expect('impact_periods', 4.0_dp)
      call expect('impacts_drive', 8.0_dp)
      call expect('impacts_coast', 20.0_dp)
      call expect('impacts_per_period_drive', 2.0_dp)
      call expect('impacts_per_period_coast', 5.0_dp)
      call expect('impacts_per_second_drive', 2.0_dp*judged%resolved%problem%frequency)
      call expect('impacts_per_second_coast', 5.0_dp*judged%resolved%problem%frequency)
      call expect('impacts_per_revolution_drive', 2.0_dp*judged%resolved%problem%frequency/9.0_dp)
      call expect('impacts_per_revolution_coast', 5.0_dp*judged%resolved%problem%frequency/9.0_dp)
      call expect('impact_load_maximum_drive', 61.0_dp)
      call expect('impact_load_maximum_coast', 62.0_dp)
      call expect('impact_velocity_maximum_drive', 63.0_dp)
      call expect('impact_velocity_maximum_coast', 64.0_dp)
      call expect('impact_impulse_maximum_drive', 65.0_dp)
      call expect('impact_impulse_maximum_coast', 66.0_dp)
      call expect('impact_impulse_mean_drive', 2.0_dp)
      call expect('impact_impulse_mean_coast', 3.0_dp)
      call expect('restitution_drive', 0.75_dp)
      call expect('restitution_coast', 0.4_dp)

   contains

      subroutine extremes(name, seen)
         character(*), intent(in) :: name
         integer, intent(in) :: seen

         call expect(name//'_minimum', 100.0_dp + real(seen, dp))
         call expect(name//'_maximum', 200.0_dp + real(seen, dp))
      end subroutine extremes

      subroutine expect(name, number)
         character(*), intent(in) :: name
         real(dp), intent(in) :: number

         call checks%check(code_of(name) > 0, 'a quantity: '//name)
         if (code_of(name) > 0) &
            call checks%check_close(quantity_value(code_of(name), judged), number, 1.0e-14_dp*abs(number), name)
      end subroutine expect

   end subroutine test_numbers

   !> Lists; impacts are reported by the time since the motion began.
   subroutine test_lists(checks, judged)
      class(check_list_t), intent(inout) :: checks
      type(judged_scene_t), intent(in) :: judged

      call expect('harmonics', [21.0_dp, 22.0_dp])
      call expect('harmonic_errors', [58.0_dp, 59.0_dp])
      call expect('floquet_multipliers', [0.3_dp, -0.4_dp, 0.1_dp, 0.0_dp])
      call expect('impact_times_drive', [36.5_dp/judged%resolved%problem%frequency])
      call expect('impact_times_coast', [37.5_dp/judged%resolved%problem%frequency])
      call expect('impact_loads_drive', [71.0_dp])
      call expect('impact_loads_coast', [74.0_dp])
      call expect('impact_velocities_drive', [72.0_dp])
      call expect('impact_velocities_coast', [75.0_dp])
      call expect('impact_impulses_drive', [73.0_dp])
      call expect('impact_impulses_coast', [76.0_dp])

   contains

      subroutine expect(name, numbers)
         character(*), intent(in) :: name
         real(dp), intent(in) :: numbers(:)
         real(dp), allocatable :: list(:)

         allocate (list, source=quantity_list(code_of(name), judged))
         call checks%check(size(list) == size(numbers), name//': as many')
         if (size(list) == size(numbers)) &
            call checks%check_close(maxval(abs(list - numbers)), 0.0_dp, 1.0e-14_dp*maxval(numbers), name)
      end subroutine expect

   end subroutine test_lists

   !> What rests on a part that a scene lacks is unknown.
   subroutine test_unknown(checks, whole)
      class(check_list_t), intent(inout) :: checks
      type(judged_scene_t), intent(in) :: whole
      type(judged_scene_t) :: judged

      judged = whole
      judged%orbit%period = 0
      call checks%check_close(quantity_value(code_of('orbit_period'), judged), 3.0_dp, 0.0_dp, 'an orbit that the engine saw')
      call checks%check(ieee_is_nan(quantity_value(code_of('floquet_modulus'), judged)), 'no orbit, no multiplier')
      judged%impacts%contacts(drive_flank)%approach = 0.0_dp
      call checks%check(ieee_is_nan(quantity_value(code_of('restitution_drive'), judged)), 'no approach, no restitution')
      judged%impacts%exists = .false.
      call checks%check(ieee_is_nan(quantity_value(code_of('impacts_drive'), judged)), 'impacts that nobody asked for')
      judged%verification%exists = .false.
      call checks%check(ieee_is_nan(quantity_value(code_of('verified'), judged)), 'no verification')
      judged%rattle%spectrum%moving = .false.
      call checks%check(ieee_is_nan(quantity_value(code_of('harmonic_count'), judged)), 'no lines at rest')
      judged%resolved%gear_speed = 0.0_dp
      call checks%check(ieee_is_nan(quantity_value(code_of('reversals_per_revolution'), judged)), 'no gear, no revolution')
      judged%regime%pressure_exists = .false.
      call checks%check(ieee_is_nan(quantity_value(code_of('pressure_maximum'), judged)), 'no pressure')
      judged%judged = .false.
      call checks%check(ieee_is_nan(quantity_value(code_of('film_minimum'), judged)), 'no window')
      call checks%check(size(quantity_list(code_of('harmonics'), judged)) == 0, 'no window, no lines')
   end subroutine test_unknown

end module test_judged_scene
