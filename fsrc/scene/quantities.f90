!> The one table of quantities: what is reported of a judged scene in summaries, columns of sweeps, rows of campaigns and logs, and
!> what the codes among them mean. Values are computed in judged_scene. fsrc/README.md says how a quantity is added.
module quantities
   use text, only: integer_text
   implicit none(type, external)
   public
   private :: integer_text

   !> Numbers, counts, flags (1 or 0), codes of words, and lists of numbers.
   integer, parameter :: a_number = 1, a_count = 2, a_flag = 3, a_code = 4, a_list = 5
   character(*), parameter :: kind_names(5) = [character(6) :: 'number', 'count', 'flag', 'code', 'list']

   !> What has to be found for a quantity beyond the motion itself. The first are the extremes of the window, by the codes of
   !> node_extremes.
   integer, parameter :: needs_nothing = 0, needs_film_range = 1, needs_velocity_range = 2, needs_acceleration_range = 3, &
                                 needs_load_range = 4, needs_regime = 5, needs_coast_load_range = 6, needs_net_load_range = 7, &
                                 needs_coast_film_range = 8, needs_position_range = 9, needs_deflection = 10, &
                                 needs_spectrum = 11, needs_verification = 12, needs_impacts = 13, needs_verified_impacts = 14, &
                                 needs_orbit = 15, needs_closure_range = 16, needs_starts = 17, needs_motion_verdicts = 18, &
                                 needs_multipliers = 19, needs_film_force = 20, need_count = 20

   !> Parts of the summary, in their order.
   integer, parameter :: part_scene = 1, part_window = 2, part_spectrum = 3, part_class = 4, part_errors = 5, &
                                 part_orbit = 6, part_regime = 7, part_cost = 8

   enum, bind(c)
      enumerator :: quantity_status = 1, quantity_steady_film, quantity_natural_frequency, quantity_damping_ratio, &
         quantity_drag_torque, quantity_drag_bearing, quantity_drag_synchroniser, quantity_drag_churning, quantity_inertia_ratio, &
         quantity_window_periods, quantity_samples_per_period, quantity_series_coarse, quantity_harmonics_by_integrals, &
         quantity_film_minimum, quantity_film_maximum, quantity_velocity_minimum, quantity_velocity_maximum, &
         quantity_acceleration_minimum, quantity_acceleration_maximum, quantity_load_minimum, quantity_load_maximum, &
         quantity_acceleration_rms, quantity_gear_acceleration_rms, quantity_gear_acceleration_maximum, quantity_crest_factor, &
         quantity_acceleration_kurtosis, quantity_film_force_rms, quantity_dissipated_energy, quantity_dissipated_power, &
         quantity_film_dissipated_power, quantity_tooth_dissipated_power, quantity_coast_film_minimum, &
         quantity_coast_film_maximum, quantity_coast_load_maximum, quantity_reversal, &
         quantity_unloaded_share, quantity_separation, quantity_impacts_per_period_drive, quantity_impacts_per_period_coast, &
         quantity_impacts_per_second_drive, quantity_impacts_per_second_coast, quantity_impacts_per_revolution_drive, &
         quantity_impacts_per_revolution_coast, &
         quantity_impact_load_maximum_drive, quantity_impact_load_maximum_coast, quantity_impact_velocity_maximum_drive, &
         quantity_impact_velocity_maximum_coast, quantity_impact_impulse_maximum_drive, quantity_impact_impulse_maximum_coast, &
         quantity_impact_impulse_mean_drive, quantity_impact_impulse_mean_coast, quantity_restitution_drive, &
         quantity_restitution_coast, quantity_double_sided, quantity_verdict, &
         quantity_impact_periods, quantity_impacts_drive, quantity_impacts_coast, quantity_impact_times_drive, &
         quantity_impact_loads_drive, quantity_impact_velocities_drive, quantity_impact_impulses_drive, &
         quantity_impact_times_coast, quantity_impact_loads_coast, quantity_impact_velocities_coast, &
         quantity_impact_impulses_coast, quantity_gear_position_minimum, quantity_gear_position_maximum, quantity_model_limit, &
         quantity_reversals_per_period, quantity_reversals_per_second, quantity_reversals_per_revolution, quantity_harmonics, &
         quantity_harmonic_count, quantity_harmonic_count_is_bound, quantity_spectral_reach, &
         quantity_harmonic_distortion, quantity_harmonic_distortion_is_bound, &
         quantity_irregular_fraction, quantity_irregular_fraction_is_bound, quantity_sampling_sufficient, quantity_rattle_class, &
         quantity_motions, quantity_starts_solved, quantity_unsettled_starts, quantity_start_periods, quantity_loudest_class, &
         quantity_loudest_verdict, quantity_loudest_acceleration_rms, quantity_loudest_film_force_rms, &
         quantity_loudest_film_minimum, quantity_quietest_class, quantity_quietest_acceleration_rms, quantity_motion_end, &
         quantity_lyapunov_exponent, quantity_followed_periods, quantity_batch_periods, quantity_verified, &
         quantity_verdict_verified, quantity_impacts_verified, quantity_film_error, &
         quantity_film_minimum_error, quantity_film_maximum_error, quantity_acceleration_error, &
         quantity_acceleration_minimum_error, quantity_acceleration_maximum_error, quantity_acceleration_rms_error, &
         quantity_film_force_rms_error, quantity_dissipated_power_error, quantity_impacts_per_period_drive_error, &
         quantity_impacts_per_period_coast_error, quantity_impact_impulse_mean_drive_error, &
         quantity_impact_impulse_mean_coast_error, quantity_severity_error, quantity_harmonic_errors, quantity_orbit_period, &
         quantity_orbit_stability, quantity_floquet_multipliers, &
         quantity_floquet_modulus, quantity_pressure_maximum, quantity_pressure_error, quantity_pressure_resolved, &
         quantity_film_at_pressure_maximum, quantity_central_film, quantity_alpha_p_maximum, quantity_deflection, &
         quantity_deflection_share, quantity_stiffness_matters, quantity_film_regime, quantity_law_contradicted, &
         quantity_closure_range, quantity_film_model, quantity_periods_solved, quantity_evaluations, quantity_steps, &
         quantity_steps_cut, quantity_iterations_per_step
   end enum

   !> What is reported of each contact, and the codes of its quantities: that of the drive flank, that of the coast flank.
   integer, parameter :: contact_film_minimum = 1, contact_film_maximum = 2, contact_load_maximum = 3, contact_impacts = 4, &
                         contact_impacts_per_period = 5, contact_impact_load_maximum = 6, contact_impact_velocity_maximum = 7, &
                         contact_impact_impulse_maximum = 8, contact_impact_impulse_mean = 9, contact_impact_times = 10, &
                         contact_impact_loads = 11, contact_impact_velocities = 12, contact_impact_impulses = 13, &
                         contact_impacts_per_period_error = 14, contact_impact_impulse_mean_error = 15, &
                         contact_impacts_per_second = 16, contact_impacts_per_revolution = 17, contact_restitution = 18
   integer, parameter :: quantities_of_contacts(2, 18) = reshape([ &
      quantity_film_minimum, quantity_coast_film_minimum, &
      quantity_film_maximum, quantity_coast_film_maximum, &
      quantity_load_maximum, quantity_coast_load_maximum, &
      quantity_impacts_drive, quantity_impacts_coast, &
      quantity_impacts_per_period_drive, quantity_impacts_per_period_coast, &
      quantity_impact_load_maximum_drive, quantity_impact_load_maximum_coast, &
      quantity_impact_velocity_maximum_drive, quantity_impact_velocity_maximum_coast, &
      quantity_impact_impulse_maximum_drive, quantity_impact_impulse_maximum_coast, &
      quantity_impact_impulse_mean_drive, quantity_impact_impulse_mean_coast, &
      quantity_impact_times_drive, quantity_impact_times_coast, &
      quantity_impact_loads_drive, quantity_impact_loads_coast, &
      quantity_impact_velocities_drive, quantity_impact_velocities_coast, &
      quantity_impact_impulses_drive, quantity_impact_impulses_coast, &
      quantity_impacts_per_period_drive_error, quantity_impacts_per_period_coast_error, &
      quantity_impact_impulse_mean_drive_error, quantity_impact_impulse_mean_coast_error, &
      quantity_impacts_per_second_drive, quantity_impacts_per_second_coast, &
      quantity_impacts_per_revolution_drive, quantity_impacts_per_revolution_coast, &
      quantity_restitution_drive, quantity_restitution_coast], [2, 18])

   !> One quantity.
   type :: quantity_t
      integer :: code
      character(32) :: name
      !> SI unit, '-' for a pure number
      character(6) :: unit
      integer :: kind
      integer :: part
      integer :: need
      !> Where it is reported, besides the words of its codes: any of summary, sweep, flanks (a sweep of scenes with a backlash),
      !> gears (a sweep of gears), campaign (a word of its key record), log
      character(28) :: reported_in
      character(168) :: meaning
      !> Words of the codes, from the first code on, a bar between two
      character(160) :: words = ''
      integer :: first_code = 0
      !> Digits in the log
      integer :: digits = 5
   end type quantity_t

   !> Those of the scene and of the motion over its window.
   type(quantity_t), parameter, private :: quantities_of_motion(*) = [ &
      quantity_t(quantity_status, 'status', '-', a_code, part_scene, needs_nothing, 'sweep', &
         'How the motion ended; in every summary and row.', &
         'complete|steady|not_converged|film_lost|no_rigid_film|overflow|interrupted|time_limit|not_written|invalid|'// &
         'film_cycles|film_torn'), &
      quantity_t(quantity_steady_film, 'steady_film', 'm', a_number, part_scene, needs_nothing, 'summary campaign log', &
         'Film that carries the static load Q + m g without motion.'), &
      quantity_t(quantity_natural_frequency, 'natural_frequency', 'Hz', a_number, part_scene, needs_nothing, &
         'summary sweep campaign log', 'Of small motions about the steady film, undamped; unknown where they are overdamped.'), &
      quantity_t(quantity_damping_ratio, 'damping_ratio', '-', a_number, part_scene, needs_nothing, 'summary campaign log', &
         'Of small motions about the steady film; unknown where they are overdamped.', digits=4), &
      quantity_t(quantity_drag_torque, 'drag_torque', 'N m', a_number, part_scene, needs_nothing, 'summary gears campaign log', &
         'Drag torque on the loose gear of &gear, as given, tabulated or computed, with its drag_scale.', digits=4), &
      quantity_t(quantity_drag_bearing, 'drag_bearing', 'N m', a_number, part_scene, needs_nothing, 'summary gears campaign log', &
         'Part of a computed drag_torque: the bearing; negative where the own shaft pulls the gear forward.', digits=4), &
      quantity_t(quantity_drag_synchroniser, 'drag_synchroniser', 'N m', a_number, part_scene, needs_nothing, &
         'summary gears campaign log', &
         'Part of a computed drag_torque: the synchroniser; negative where the own shaft pulls the gear forward.', digits=4), &
      quantity_t(quantity_drag_churning, 'drag_churning', 'N m', a_number, part_scene, needs_nothing, &
         'summary gears campaign log', 'Part of a computed drag_torque: the oil that the gear churns.', digits=4), &
      quantity_t(quantity_inertia_ratio, 'inertia_ratio', '-', a_number, part_scene, needs_nothing, 'summary gears campaign log', &
         'Lambda: largest inertia force that pulls the tooth of a loose gear off its flank over the drag that holds it there; '// &
         'above 1 it leaves without oil.', digits=4), &
      quantity_t(quantity_window_periods, 'window_periods', '-', a_count, part_window, needs_nothing, 'summary', &
         'Periods of the force at the end of the run that are judged. A motion of whose repeats they hold no whole number is '// &
         'followed on until they do.'), &
      quantity_t(quantity_samples_per_period, 'samples_per_period', '-', a_count, part_window, needs_nothing, 'summary', &
         'Samples of a period that the harmonics are found from.'), &
      quantity_t(quantity_series_coarse, 'series_coarse', '-', a_flag, part_window, needs_nothing, 'summary', &
         'Whether the samples of the time series are too few for its motion.'), &
      quantity_t(quantity_harmonics_by_integrals, 'harmonics_by_integrals', '-', a_flag, part_window, needs_nothing, 'summary', &
         'Whether the harmonics are integrals over the steps, since no samples follow the motion.'), &
      quantity_t(quantity_film_minimum, 'film_minimum', 'm', a_number, part_window, needs_film_range, 'summary sweep campaign', &
         'Minimum film thickness of the window.'), &
      quantity_t(quantity_film_maximum, 'film_maximum', 'm', a_number, part_window, needs_film_range, 'summary sweep campaign', &
         'Largest film of the window.'), &
      quantity_t(quantity_velocity_minimum, 'velocity_minimum', 'm/s', a_number, part_window, needs_velocity_range, &
         'summary campaign', 'Smallest film velocity of the window: the fastest approach.'), &
      quantity_t(quantity_velocity_maximum, 'velocity_maximum', 'm/s', a_number, part_window, needs_velocity_range, &
         'summary campaign', 'Largest film velocity of the window: the fastest separation.'), &
      quantity_t(quantity_acceleration_minimum, 'acceleration_minimum', 'm/s2', a_number, part_window, needs_acceleration_range, &
         'summary sweep campaign', &
         'Smallest acceleration of the window; with a &gear relative to the shaft, along the line of action.'), &
      quantity_t(quantity_acceleration_maximum, 'acceleration_maximum', 'm/s2', a_number, part_window, needs_acceleration_range, &
         'summary sweep campaign', &
         'Largest acceleration of the window; with a &gear relative to the shaft, along the line of action.'), &
      quantity_t(quantity_load_minimum, 'load_minimum', 'N', a_number, part_window, needs_load_range, 'summary', &
         'Smallest load of the film over the window.'), &
      quantity_t(quantity_load_maximum, 'load_maximum', 'N', a_number, part_window, needs_load_range, 'summary campaign', &
         'Largest load of the film over the window.'), &
      quantity_t(quantity_acceleration_rms, 'acceleration_rms', 'm/s2', a_number, part_window, needs_nothing, &
         'summary sweep campaign', &
         'Root of the mean square of the acceleration over the window; with a &gear relative to the shaft, along the line of '// &
         'action.', digits=4), &
      quantity_t(quantity_gear_acceleration_rms, 'gear_acceleration_rms', 'rad/s2', a_number, part_window, needs_nothing, &
         'summary gears campaign log', &
         'Rms of the angular acceleration of the loose gear of &gear, relative to a gear that follows the shaft without a gap.', &
         digits=4), &
      quantity_t(quantity_gear_acceleration_maximum, 'gear_acceleration_maximum', 'rad/s2', a_number, part_window, &
         needs_acceleration_range, 'summary gears campaign log', &
         'Largest size of the angular acceleration of the loose gear, relative to a gear that follows the shaft without a gap.', &
         digits=4), &
      quantity_t(quantity_crest_factor, 'crest_factor', '-', a_number, part_window, needs_acceleration_range, 'summary campaign', &
         'Largest size of the acceleration over acceleration_rms; of a cosine 1.414.'), &
      quantity_t(quantity_acceleration_kurtosis, 'acceleration_kurtosis', '-', a_number, part_window, needs_nothing, &
         'summary campaign', 'Fourth central moment of the acceleration over the square of its variance; of a cosine 1.5.'), &
      quantity_t(quantity_film_force_rms, 'film_force_rms', 'N', a_number, part_window, needs_nothing, 'summary sweep campaign', &
         'Rms of the film force about its mean, which is the load on the bearings.', digits=4), &
      quantity_t(quantity_dissipated_energy, 'dissipated_energy', 'J', a_number, part_window, needs_nothing, 'summary campaign', &
         'Work that film and teeth dissipate a period of the force, - integral of (W - Q - m g) dh over the window by its '// &
         'periods; less than 0 at times if it does not repeat.'), &
      quantity_t(quantity_dissipated_power, 'dissipated_power', 'W', a_number, part_window, needs_nothing, &
         'summary sweep campaign log', 'dissipated_energy times the frequency of the force.', digits=4), &
      quantity_t(quantity_film_dissipated_power, 'film_dissipated_power', 'W', a_number, part_window, needs_nothing, &
         'summary campaign', 'Part of dissipated_power in the films, where teeth are damped.'), &
      quantity_t(quantity_tooth_dissipated_power, 'tooth_dissipated_power', 'W', a_number, part_window, needs_nothing, &
         'summary campaign', 'Part of dissipated_power in damped teeth, the mean of c D''^2 of both flanks.'), &
      quantity_t(quantity_coast_film_minimum, 'coast_film_minimum', 'm', a_number, part_window, needs_coast_film_range, &
         'summary flanks campaign', 'Minimum film thickness of the coast flank over the window, where there is a backlash.'), &
      quantity_t(quantity_coast_film_maximum, 'coast_film_maximum', 'm', a_number, part_window, needs_coast_film_range, &
         'summary campaign', 'Largest film of the coast flank over the window.'), &
      quantity_t(quantity_coast_load_maximum, 'coast_load_maximum', 'N', a_number, part_window, needs_coast_load_range, &
         'summary campaign', 'Largest load of the film of the coast flank over the window.')]

   !> Those of separation and impacts.
   type(quantity_t), parameter, private :: quantities_of_impacts(*) = [ &
      quantity_t(quantity_reversal, 'reversal', '-', a_flag, part_window, needs_impacts, 'summary sweep campaign', &
         'Whether the load of the drive film less that of the coast film changes its sign over the window.'), &
      quantity_t(quantity_unloaded_share, 'unloaded_share', '-', a_number, part_window, needs_impacts, 'summary sweep campaign', &
         'Share of the window in which the drive film carries less than a hundredth of |Q + m g|; of F_max where that is 0.'), &
      quantity_t(quantity_separation, 'separation', '-', a_flag, part_window, needs_impacts, 'summary sweep campaign', &
         'Whether the tooth leaves the drive flank: reversal, or an unloaded share above 0.'), &
      quantity_t(quantity_impacts_per_period_drive, 'impacts_per_period_drive', '-', a_number, part_window, needs_impacts, &
         'summary sweep campaign', &
         'Impacts on the drive flank a period: maxima of its load above impact_limit times F_max, the largest |F + m g|.'), &
      quantity_t(quantity_impacts_per_period_coast, 'impacts_per_period_coast', '-', a_number, part_window, needs_impacts, &
         'summary flanks campaign', &
         'Impacts on the coast flank a period: maxima of its load above impact_limit times F_max, the largest |F + m g|.'), &
      quantity_t(quantity_impacts_per_second_drive, 'impacts_per_second_drive', '1/s', a_number, part_window, needs_impacts, &
         'summary campaign', 'impacts_per_period_drive times the frequency.'), &
      quantity_t(quantity_impacts_per_second_coast, 'impacts_per_second_coast', '1/s', a_number, part_window, needs_impacts, &
         'summary campaign', 'impacts_per_period_coast times the frequency.'), &
      quantity_t(quantity_impacts_per_revolution_drive, 'impacts_per_revolution_drive', '-', a_number, part_window, &
         needs_impacts, 'summary campaign', 'Impacts on the drive flank in a revolution of the loose gear of &gear.'), &
      quantity_t(quantity_impacts_per_revolution_coast, 'impacts_per_revolution_coast', '-', a_number, part_window, &
         needs_impacts, 'summary campaign', 'Impacts on the coast flank in a revolution of the loose gear of &gear.'), &
      quantity_t(quantity_impact_load_maximum_drive, 'impact_load_maximum_drive', 'N', a_number, part_window, needs_impacts, &
         'summary sweep campaign', 'Largest load of an impact on the drive flank; 0: there is none.'), &
      quantity_t(quantity_impact_load_maximum_coast, 'impact_load_maximum_coast', 'N', a_number, part_window, needs_impacts, &
         'summary flanks campaign', 'Largest load of an impact on the coast flank; 0: there is none.'), &
      quantity_t(quantity_impact_velocity_maximum_drive, 'impact_velocity_maximum_drive', 'm/s', a_number, part_window, &
         needs_impacts, 'summary sweep campaign', &
         'Largest velocity at which the gear approaches the drive flank where its load passes F_max to an impact; 0: '// &
         'there is none.'), &
      quantity_t(quantity_impact_velocity_maximum_coast, 'impact_velocity_maximum_coast', 'm/s', a_number, part_window, &
         needs_impacts, 'summary flanks campaign', &
         'Largest velocity at which the gear approaches the coast flank where its load passes F_max to an impact; 0: '// &
         'there is none.'), &
      quantity_t(quantity_impact_impulse_maximum_drive, 'impact_impulse_maximum_drive', 'N s', a_number, part_window, &
         needs_impacts, 'summary sweep campaign', &
         'Largest impulse of an impact on the drive flank: integral of its load while it exceeds F_max; 0: there is none.'), &
      quantity_t(quantity_impact_impulse_maximum_coast, 'impact_impulse_maximum_coast', 'N s', a_number, part_window, &
         needs_impacts, 'summary flanks campaign', &
         'Largest impulse of an impact on the coast flank: integral of its load while it exceeds F_max; 0: there is none.'), &
      quantity_t(quantity_impact_impulse_mean_drive, 'impact_impulse_mean_drive', 'N s', a_number, part_window, needs_impacts, &
         'summary sweep campaign', 'Mean impulse of the impacts on the drive flank; 0: there is none.'), &
      quantity_t(quantity_impact_impulse_mean_coast, 'impact_impulse_mean_coast', 'N s', a_number, part_window, needs_impacts, &
         'summary flanks campaign', 'Mean impulse of the impacts on the coast flank; 0: there is none.'), &
      quantity_t(quantity_restitution_drive, 'restitution_drive', '-', a_number, part_window, needs_impacts, &
         'summary sweep campaign', &
         'Of the largest impact on the drive flank: velocity away where its load falls to F_max over that of approach where '// &
         'it rose past it; unknown without one.', digits=4), &
      quantity_t(quantity_restitution_coast, 'restitution_coast', '-', a_number, part_window, needs_impacts, &
         'summary flanks campaign', &
         'Of the largest impact on the coast flank: velocity away where its load falls to F_max over that of approach where '// &
         'it rose past it; unknown without one.', digits=4), &
      quantity_t(quantity_double_sided, 'double_sided', '-', a_flag, part_window, needs_impacts, 'summary flanks campaign log', &
         'Whether there are impacts on both flanks in the window.'), &
      quantity_t(quantity_verdict, 'verdict', '-', a_code, part_window, needs_impacts, 'summary sweep campaign', &
         'What the tooth does in its gap. Impacts without separation: it floats up on its film and falls back, but never '// &
         'leaves it.', &
         'no separation|separation|single-sided impacts|double-sided impacts|impacts without separation'), &
      quantity_t(quantity_impact_periods, 'impact_periods', '-', a_count, part_window, needs_impacts, 'summary', &
         'Periods in which impacts were counted: fewer than window_periods where the others repeat them, more where the '// &
         'motion was followed on.'), &
      quantity_t(quantity_impacts_drive, 'impacts_drive', '-', a_count, part_window, needs_impacts, 'summary', &
         'Impacts on the drive flank in impact_periods.'), &
      quantity_t(quantity_impacts_coast, 'impacts_coast', '-', a_count, part_window, needs_impacts, 'summary', &
         'Impacts on the coast flank in impact_periods.'), &
      quantity_t(quantity_impact_times_drive, 'impact_times_drive', 's', a_list, part_window, needs_impacts, 'summary', &
         'Of up to 20 impacts on the drive flank in impact_periods: when the load is largest, since the start of the motion.'), &
      quantity_t(quantity_impact_loads_drive, 'impact_loads_drive', 'N', a_list, part_window, needs_impacts, 'summary', &
         'Of the impacts of impact_times_drive: largest load.'), &
      quantity_t(quantity_impact_velocities_drive, 'impact_velocities_drive', 'm/s', a_list, part_window, needs_impacts, &
         'summary', 'Of the impacts of impact_times_drive: velocity at which the gear approaches where the load passes F_max.'), &
      quantity_t(quantity_impact_impulses_drive, 'impact_impulses_drive', 'N s', a_list, part_window, needs_impacts, 'summary', &
         'Of the impacts of impact_times_drive: integral of the load while it exceeds F_max.'), &
      quantity_t(quantity_impact_times_coast, 'impact_times_coast', 's', a_list, part_window, needs_impacts, 'summary', &
         'Of up to 20 impacts on the coast flank in impact_periods: when the load is largest, since the start of the motion.'), &
      quantity_t(quantity_impact_loads_coast, 'impact_loads_coast', 'N', a_list, part_window, needs_impacts, 'summary', &
         'Of the impacts of impact_times_coast: largest load.'), &
      quantity_t(quantity_impact_velocities_coast, 'impact_velocities_coast', 'm/s', a_list, part_window, needs_impacts, &
         'summary', 'Of the impacts of impact_times_coast: velocity at which the gear approaches where the load passes F_max.'), &
      quantity_t(quantity_impact_impulses_coast, 'impact_impulses_coast', 'N s', a_list, part_window, needs_impacts, 'summary', &
         'Of the impacts of impact_times_coast: integral of the load while it exceeds F_max.')]

   !> The others.
   type(quantity_t), parameter, private :: other_quantities(*) = [ &
      quantity_t(quantity_gear_position_minimum, 'gear_position_minimum', 'm', a_number, part_window, needs_position_range, &
         'summary campaign', &
         'Smallest gap of the gear over the window, with teeth as if unloaded: the film less their deflection.'), &
      quantity_t(quantity_gear_position_maximum, 'gear_position_maximum', 'm', a_number, part_window, needs_position_range, &
         'summary campaign', 'Largest gap of the gear over the window.'), &
      quantity_t(quantity_model_limit, 'model_limit', '-', a_code, part_window, needs_film_range, 'summary sweep campaign', &
         'Where the motion leaves the range of the model.', 'within|too_wide|too_narrow|too_wide_and_narrow'), &
      quantity_t(quantity_reversals_per_period, 'reversals_per_period', '-', a_number, part_window, needs_spectrum, &
         'summary campaign', 'Turns of the acceleration that stand out from the curve, a period of the force.'), &
      quantity_t(quantity_reversals_per_second, 'reversals_per_second', '1/s', a_number, part_window, needs_spectrum, &
         'summary campaign', 'reversals_per_period times the frequency.'), &
      quantity_t(quantity_reversals_per_revolution, 'reversals_per_revolution', '-', a_number, part_window, needs_spectrum, &
         'summary campaign', 'Turns of the acceleration that stand out, in a revolution of the loose gear of &gear.'), &
      quantity_t(quantity_harmonics, 'harmonics', 'm/s2', a_list, part_window, needs_spectrum, 'summary sweep campaign', &
         'Amplitudes of the acceleration at multiples of the frequency of the force: 40 in a summary, harmonic_1 to 8 in a row.'), &
      quantity_t(quantity_harmonic_count, 'harmonic_count', '-', a_count, part_spectrum, needs_spectrum, 'summary sweep campaign', &
         'Multiples of the dominant order of the force with harmonics about them above the harmonic threshold.'), &
      quantity_t(quantity_harmonic_count_is_bound, 'harmonic_count_is_bound', '-', a_flag, part_spectrum, needs_spectrum, &
         'summary sweep campaign', 'Whether there may be more harmonics beyond the highest that is resolved.'), &
      quantity_t(quantity_spectral_reach, 'spectral_reach', '-', a_number, part_spectrum, needs_spectrum, 'summary campaign', &
         'Multiple of the dominant order of the force up to which 99 % of the power lies that is not at its orders; '// &
         'unknown where less is resolved.'), &
      quantity_t(quantity_harmonic_distortion, 'harmonic_distortion', '-', a_number, part_spectrum, needs_spectrum, &
         'summary sweep campaign', 'All harmonics from the second on over the first.'), &
      quantity_t(quantity_harmonic_distortion_is_bound, 'harmonic_distortion_is_bound', '-', a_flag, part_spectrum, &
         needs_spectrum, 'summary sweep campaign', &
         'Whether harmonics beyond the highest that is resolved may add to harmonic_distortion.'), &
      quantity_t(quantity_irregular_fraction, 'irregular_fraction', '-', a_number, part_spectrum, needs_spectrum, &
         'summary sweep campaign', &
         'Share of the power off the harmonics of the force, those of its orders from a thousandth of the largest on.'), &
      quantity_t(quantity_irregular_fraction_is_bound, 'irregular_fraction_is_bound', '-', a_flag, part_spectrum, needs_spectrum, &
         'summary sweep campaign', 'Whether power beyond the highest harmonic that is resolved may add to irregular_fraction.'), &
      quantity_t(quantity_sampling_sufficient, 'sampling_sufficient', '-', a_flag, part_spectrum, needs_spectrum, &
         'summary campaign', 'Whether the harmonics are those of the motion, not of too few samples.'), &
      quantity_t(quantity_rattle_class, 'rattle_class', '-', a_code, part_class, needs_spectrum, 'summary sweep campaign', &
         'Class of the motion by its spectrum.', 'quiet|creep|idle|irregular|subharmonic|irregular_so_far', first_code=1), &
      quantity_t(quantity_motions, 'motions', '-', a_count, part_class, needs_starts, 'summary campaign', &
         'Different motions that the starts of solver.starts settle on; 1 is no proof that there is no other.'), &
      quantity_t(quantity_starts_solved, 'starts_solved', '-', a_count, part_class, needs_starts, 'summary campaign', &
         'Starts whose motions were solved, that of the scene with them.'), &
      quantity_t(quantity_unsettled_starts, 'unsettled_starts', '-', a_count, part_class, needs_starts, 'summary campaign', &
         'Starts whose motions were not seen to repeat: irregular ones, and those that take longer or fail.'), &
      quantity_t(quantity_start_periods, 'start_periods', '-', a_count, part_class, needs_starts, 'summary campaign', &
         'Periods of the force that were solved from the other starts, beside periods_solved.'), &
      quantity_t(quantity_loudest_class, 'loudest_class', '-', a_code, part_class, needs_starts, 'summary campaign', &
         'Class of the motion with the largest acceleration_rms of all starts.', &
         'quiet|creep|idle|irregular|subharmonic|irregular_so_far', first_code=1), &
      quantity_t(quantity_loudest_verdict, 'loudest_verdict', '-', a_code, part_class, needs_motion_verdicts, 'summary campaign', &
         'Its verdict, of separation and impacts.', &
         'no separation|separation|single-sided impacts|double-sided impacts|impacts without separation'), &
      quantity_t(quantity_loudest_acceleration_rms, 'loudest_acceleration_rms', 'm/s2', a_number, part_class, needs_starts, &
         'summary campaign', 'Its acceleration_rms.', digits=4), &
      quantity_t(quantity_loudest_film_force_rms, 'loudest_film_force_rms', 'N', a_number, part_class, needs_starts, &
         'summary campaign', 'Its film_force_rms.', digits=4), &
      quantity_t(quantity_loudest_film_minimum, 'loudest_film_minimum', 'm', a_number, part_class, needs_starts, &
         'summary campaign', 'Its film_minimum.'), &
      quantity_t(quantity_quietest_class, 'quietest_class', '-', a_code, part_class, needs_starts, 'summary campaign', &
         'Class of the motion with the smallest acceleration_rms of all starts.', &
         'quiet|creep|idle|irregular|subharmonic|irregular_so_far', first_code=1), &
      quantity_t(quantity_quietest_acceleration_rms, 'quietest_acceleration_rms', 'm/s2', a_number, part_class, needs_starts, &
         'summary campaign', 'Its acceleration_rms.', digits=4), &
      quantity_t(quantity_motion_end, 'motion_end', '-', a_code, part_class, needs_starts, 'threshold', &
         'How the motions of a side end where they are followed: they lose stability, their side, or the range ends.', &
         'fold|period_doubling|torus|criterion|end_of_range|bracketed|lost', first_code=1), &
      quantity_t(quantity_lyapunov_exponent, 'lyapunov_exponent', '-', a_number, part_class, needs_spectrum, &
         'summary sweep campaign', &
         'Mean logarithm by which a neighbouring motion parts, a period of the force; where a motion does not repeat.'), &
      quantity_t(quantity_followed_periods, 'followed_periods', '-', a_count, part_class, needs_spectrum, 'summary campaign', &
         'Periods that an irregular motion was followed: extremes, severity, impacts and harmonics are those of all of them.'), &
      quantity_t(quantity_batch_periods, 'batch_periods', '-', a_count, part_class, needs_spectrum, 'summary campaign', &
         'Of an irregular motion: periods of the batches, next to uncorrelated, whose means give its standard errors.'), &
      quantity_t(quantity_verified, 'verified', '-', a_flag, part_class, needs_verification, 'campaign', &
         'Whether the class is verified: a second, tighter solution agrees, or both halves of what was followed of an '// &
         'irregular motion.'), &
      quantity_t(quantity_verdict_verified, 'verdict_verified', '-', a_flag, part_class, needs_verified_impacts, &
         'summary campaign', &
         'Whether the verdict is the same when the scene is solved again, tighter; by a part of the motion only if every '// &
         'flank is hit.'), &
      quantity_t(quantity_impacts_verified, 'impacts_verified', '-', a_flag, part_class, needs_verified_impacts, &
         'summary campaign', &
         'Whether each flank has as many impacts a period when solved again, tighter, over a whole motion; of an '// &
         'irregular one, whether its halves agree.'), &
      quantity_t(quantity_film_error, 'film_error', '-', a_number, part_errors, needs_verification, 'summary', &
         'Largest error of the films of both flanks over the window, relative to the thinner one.'), &
      quantity_t(quantity_film_minimum_error, 'film_minimum_error', 'm', a_number, part_errors, needs_verification, 'summary', &
         'Error of film_minimum.'), &
      quantity_t(quantity_film_maximum_error, 'film_maximum_error', 'm', a_number, part_errors, needs_verification, 'summary', &
         'Error of film_maximum.'), &
      quantity_t(quantity_acceleration_error, 'acceleration_error', '-', a_number, part_errors, needs_verification, 'summary', &
         'Larger of both errors below, over the largest size of the acceleration.'), &
      quantity_t(quantity_acceleration_minimum_error, 'acceleration_minimum_error', 'm/s2', a_number, part_errors, &
         needs_verification, 'summary', 'Error of acceleration_minimum.'), &
      quantity_t(quantity_acceleration_maximum_error, 'acceleration_maximum_error', 'm/s2', a_number, part_errors, &
         needs_verification, 'summary', 'Error of acceleration_maximum.'), &
      quantity_t(quantity_acceleration_rms_error, 'acceleration_rms_error', 'm/s2', a_number, part_errors, needs_verification, &
         'summary campaign', 'Error of acceleration_rms; of an irregular motion two standard errors, as all that follow.'), &
      quantity_t(quantity_film_force_rms_error, 'film_force_rms_error', 'N', a_number, part_errors, needs_verification, &
         'summary campaign', 'Error of film_force_rms.'), &
      quantity_t(quantity_dissipated_power_error, 'dissipated_power_error', 'W', a_number, part_errors, needs_verification, &
         'summary campaign', 'Error of dissipated_power.'), &
      quantity_t(quantity_impacts_per_period_drive_error, 'impacts_per_period_drive_error', '-', a_number, part_errors, &
         needs_verified_impacts, 'summary campaign', 'Error of impacts_per_period_drive.'), &
      quantity_t(quantity_impacts_per_period_coast_error, 'impacts_per_period_coast_error', '-', a_number, part_errors, &
         needs_verified_impacts, 'summary campaign', 'Error of impacts_per_period_coast.'), &
      quantity_t(quantity_impact_impulse_mean_drive_error, 'impact_impulse_mean_drive_error', 'N s', a_number, part_errors, &
         needs_verified_impacts, 'summary campaign', 'Error of impact_impulse_mean_drive.'), &
      quantity_t(quantity_impact_impulse_mean_coast_error, 'impact_impulse_mean_coast_error', 'N s', a_number, part_errors, &
         needs_verified_impacts, 'summary campaign', 'Error of impact_impulse_mean_coast.'), &
      quantity_t(quantity_severity_error, 'severity_error', '-', a_number, part_errors, needs_verification, 'summary', &
         'Largest relative error of acceleration_rms, acceleration_kurtosis, film_force_rms and dissipated_energy.'), &
      quantity_t(quantity_harmonic_errors, 'harmonic_errors', 'm/s2', a_list, part_errors, needs_verification, 'summary', &
         'Errors of the harmonics.'), &
      quantity_t(quantity_orbit_period, 'orbit_period', '-', a_count, part_orbit, needs_orbit, 'summary sweep campaign', &
         'Periods of the force after which the motion repeats; 0 where that is not known.'), &
      quantity_t(quantity_orbit_stability, 'orbit_stability', '-', a_code, part_orbit, needs_multipliers, 'summary sweep', &
         'What the Floquet multipliers say of the periodic motion.', &
         'stable|stable, period doubling near|stable, fold near|stable, torus near|unstable', first_code=1), &
      quantity_t(quantity_floquet_multipliers, 'floquet_multipliers', '-', a_list, part_orbit, needs_multipliers, 'summary', &
         'Factors by which a period changes a small disturbance: real and imaginary part of each, the larger first.'), &
      quantity_t(quantity_floquet_modulus, 'floquet_modulus', '-', a_number, part_orbit, needs_multipliers, 'sweep', &
         'Modulus of the largest Floquet multiplier.'), &
      quantity_t(quantity_pressure_maximum, 'pressure_maximum', 'Pa', a_number, part_regime, needs_regime, 'summary campaign', &
         'Largest pressure of the Reynolds film over the window, where it exists; of an elastohydrodynamic film by its closure.'), &
      quantity_t(quantity_pressure_error, 'pressure_error', '-', a_number, part_regime, needs_verification, 'summary', &
         'Of films in nodes: twice the share by which twice as many nodes change pressure_maximum.', digits=2), &
      quantity_t(quantity_pressure_resolved, 'pressure_resolved', '-', a_flag, part_regime, needs_verification, 'summary', &
         'Of films in nodes: whether pressure_error is less than 0.04. The peak of Roelands'' oil at the outlet may be '// &
         'narrower than nodes are apart.'), &
      quantity_t(quantity_film_at_pressure_maximum, 'film_at_pressure_maximum', 'm', a_number, part_regime, needs_regime, &
         'summary', 'Of films in nodes: the film where and when the pressure is largest; film_minimum is the smallest over all '// &
         'the contact.'), &
      quantity_t(quantity_central_film, 'central_film', 'm', a_number, part_regime, needs_regime, 'summary', &
         'Of films in nodes: the film in the middle of the contact when the pressure is largest.'), &
      quantity_t(quantity_alpha_p_maximum, 'alpha_p_maximum', '-', a_number, part_regime, needs_regime, 'summary campaign', &
         'Largest pressure of the Reynolds iso-viscous film, or of an elastohydrodynamic film, times the pressure-viscosity '// &
         'coefficient.'), &
      quantity_t(quantity_deflection, 'deflection', 'm', a_number, part_regime, needs_regime, 'summary campaign', &
         'Hertzian deflection of the flanks at the largest pressure, equation (4).'), &
      quantity_t(quantity_deflection_share, 'deflection_share', '-', a_number, part_regime, needs_deflection, 'summary campaign', &
         'Deflection of the tooth as a share of the film, under the largest load; a rigid one as a steel tooth, 14 N/(um mm).'), &
      quantity_t(quantity_stiffness_matters, 'stiffness_matters', '-', a_flag, part_regime, needs_deflection, 'summary campaign', &
         'Whether deflection_share is above a tenth: rigid teeth are, or of elastic ones would be, no fair assumption.'), &
      quantity_t(quantity_film_regime, 'film_regime', '-', a_code, part_regime, needs_regime, 'summary campaign', &
         'Regime of the film by its largest pressure.', 'unknown|iso-viscous|piezo-viscous|elastohydrodynamic'), &
      quantity_t(quantity_law_contradicted, 'law_contradicted', '-', a_flag, part_regime, needs_regime, 'summary campaign', &
         'Whether the film law of the scene does not hold in its regime.'), &
      quantity_t(quantity_closure_range, 'closure_range', '-', a_code, part_regime, needs_closure_range, 'summary campaign', &
         'Whether loads, oil and pressures of an elastohydrodynamic film stay within those that its closure was fitted to; '// &
         'campaigns that find its pressure record it.', &
         'within|outside'), &
      quantity_t(quantity_film_model, 'film_model', '-', a_code, part_regime, needs_nothing, 'summary campaign', &
         'Model of the elastohydrodynamic film by which the motion is solved; recorded of every row of film.model = automatic.', &
         'closure|resolved|closure, as nodes stopped', first_code=1), &
      quantity_t(quantity_periods_solved, 'periods_solved', '-', a_count, part_cost, needs_nothing, 'summary sweep campaign', &
         'Periods of the force that were solved.'), &
      quantity_t(quantity_evaluations, 'evaluations', '-', a_count, part_cost, needs_nothing, 'summary', &
         'Evaluations of the film.'), &
      quantity_t(quantity_steps, 'steps', '-', a_count, part_cost, needs_nothing, 'summary', 'Steps in time.'), &
      quantity_t(quantity_steps_cut, 'steps_cut', '-', a_count, part_cost, needs_nothing, 'summary', &
         'Steps that were cut where the film law had no value.'), &
      quantity_t(quantity_iterations_per_step, 'iterations_per_step', '-', a_number, part_cost, needs_nothing, 'summary', &
         'Evaluations of the film a step.')]

   !> All of them, each in the place of its code.
   type(quantity_t), parameter :: quantity_table(*) = [quantities_of_motion, quantities_of_impacts, other_quantities]

   !> Names of those that a campaign can record, blanks between them. Element by element, as flang 19 folds no other way.
   integer, private :: i
   logical, parameter, private :: in_campaigns(*) = [(index(quantity_table(i)%reported_in, 'campaign') > 0, &
                                                      i=1, size(quantity_table))]
   character(*), parameter, private :: names(*) = [(quantity_table(i)%name, i=1, size(quantity_table))]
   character(*), parameter :: recordable = transfer(pack(names, in_campaigns), repeat(' ', len(names)*count(in_campaigns)))

   !> Those of them that are no lists: a threshold can be one of theirs.
   logical, parameter, private :: is_measurable(*) = [(index(quantity_table(i)%reported_in, 'campaign') > 0 .and. &
                                                       quantity_table(i)%kind /= a_list, i=1, size(quantity_table))]
   character(*), parameter :: measurable = transfer(pack(names, is_measurable), repeat(' ', len(names)*count(is_measurable)))
   !> Words of rattle_class
   character(*), parameter :: class_words = 'quiet creep idle irregular subharmonic irregular_so_far '
   !> Numbers of a list that a row of a campaign or sweep has
   integer, parameter :: numbers_in_a_row = 8
   !> Least code of verdict of a motion with impacts
   integer, parameter :: least_verdict_with_impacts = 2

contains

   !> Code of a quantity, 0 if there is none of this name.
   pure integer function quantity_code(name)
      character(*), intent(in) :: name

      quantity_code = findloc(quantity_table%name, name, dim=1)
   end function quantity_code

   !> The word of a code.
   pure function quantity_word(quantity, code) result(word)
      !> A quantity that has words
      integer, intent(in) :: quantity
      integer, intent(in) :: code
      character(:), allocatable :: word
      integer :: i

      word = trim(quantity_table(quantity)%words)//'|'
      do i = quantity_table(quantity)%first_code, code - 1
         word = word(index(word, '|') + 1:)
      end do
      word = word(:index(word, '|') - 1)
   end function quantity_word

   !> What has to be found for some quantities, with what that needs itself.
   pure function needs_of(quantities) result(needed)
      !> Codes
      integer, intent(in) :: quantities(:)
      logical :: needed(need_count)
      integer :: i

      needed = [(any(quantity_table(quantities)%need == i), i=1, need_count)]
      needed(needs_impacts) = any(needed([needs_impacts, needs_verified_impacts, needs_motion_verdicts]))
      needed(needs_starts) = any(needed([needs_starts, needs_motion_verdicts]))
      needed(needs_verification) = any(needed([needs_verification, needs_verified_impacts]))
      needed(needs_load_range) = any(needed([needs_load_range, needs_deflection, needs_impacts, needs_closure_range]))
      needed(needs_regime) = any(needed([needs_regime, needs_closure_range]))
      needed(needs_net_load_range) = any(needed([needs_net_load_range, needs_impacts]))
      needed(needs_film_range) = any(needed([needs_film_range, needs_starts]))
      needed(needs_spectrum) = any(needed([needs_spectrum, needs_starts]))
      needed(needs_coast_film_range) = any(needed([needs_film_range, needs_coast_film_range]))
      needed(needs_coast_load_range) = any(needed([needs_coast_load_range, needs_deflection, needs_closure_range]))
   end function needs_of

   !> What has to be found to choose between closure and nodes of pressure: range of the closure, and verdict.
   pure function needs_of_choice() result(needed)
      logical :: needed(need_count)

      needed = needs_of([quantity_closure_range, quantity_verdict])
   end function needs_of_choice

   !> What has to be found for the summary of a single scene.
   pure function needs_of_summary(verified) result(needed)
      !> Whether the scene is verified; only then its periodic motion is looked for
      logical, intent(in) :: verified
      logical :: needed(need_count)

      needed = .true.
      needed([needs_verification, needs_verified_impacts, needs_multipliers]) = verified
      needed([needs_orbit, needs_motion_verdicts]) = .false.
   end function needs_of_summary

   !> Whether some quantities ask for the scene to be solved again, tighter.
   pure logical function asks_to_verify(quantities)
      !> Codes
      integer, intent(in) :: quantities(:)
      logical :: needed(need_count)

      needed = needs_of(quantities)
      asks_to_verify = needed(needs_verification)
   end function asks_to_verify

   !> The flag that says whether a quantity stands when its scene is solved again, tighter: of verdict, impacts and class, whichever
   !> the quantity belongs to.
   pure integer function verification_of(quantity)
      integer, intent(in) :: quantity

      verification_of = quantity_verified
      if (quantity_table(quantity)%need /= needs_impacts) return
      verification_of = quantity_impacts_verified
      if (any(quantity_table(quantity)%kind == [a_code, a_flag])) verification_of = quantity_verdict_verified
   end function verification_of

   !> Codes of the quantities that are reported somewhere, in the order of the table.
   pure function quantities_reported_in(place) result(codes)
      !> summary, sweep, campaign or log
      character(*), intent(in) :: place
      integer, allocatable :: codes(:)

      codes = pack(quantity_table%code, index(quantity_table%reported_in, place) > 0)
   end function quantities_reported_in

   !> Quantities as columns of rows: a list has several, of harmonics harmonic_1, harmonic_2, ...
   pure function columns_of(codes) result(columns)
      integer, intent(in) :: codes(:)
      type(quantity_t), allocatable :: columns(:)
      type(quantity_t) :: column
      character(len(column%name)) :: name
      integer :: k, n

      allocate (columns(0))
      do k = 1, size(codes)
         column = quantity_table(codes(k))
         name = column%name
         do n = 1, merge(numbers_in_a_row, 1, column%kind == a_list)
            if (column%kind == a_list) column%name = name(:len_trim(name) - 1)//'_'//integer_text(n)
            columns = [columns, column]
         end do
      end do
   end function columns_of

end module quantities
