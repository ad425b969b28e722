!> Runs the tests of all modules. The last line is 'N passed, M failed'; the exit code is 1 if any failed.
program unit_tests
   use checks, only: check_list_t
   use test_elementary_functions, only: run_elementary_functions_tests
   use test_errors, only: run_errors_tests
   use test_film_integrals, only: run_film_integrals_tests
   use test_film_law, only: run_film_law_tests
   use test_film_pressure, only: run_film_pressure_tests
   use test_fourier, only: run_fourier_tests
   use test_input_entry, only: run_input_entry_tests
   use test_integrate_motion, only: run_integrate_motion_tests
   use test_key_table, only: run_key_table_tests
   use test_namelist_text, only: run_namelist_text_tests
   use test_newmark, only: run_newmark_tests
   use test_newmark_by_hand, only: run_newmark_by_hand_tests
   use test_newmark_cuts, only: run_newmark_cuts_tests
   use test_numerical_artefacts, only: run_numerical_artefacts_tests
   use test_published_iso_viscous, only: run_published_iso_viscous_tests
   use test_published_piezo_viscous, only: run_published_piezo_viscous_tests
   use test_rattle_class, only: run_rattle_class_tests
   use test_regime_check, only: run_regime_check_tests
   use test_result_writer, only: run_result_writer_tests
   use test_reversals, only: run_reversals_tests
   use test_rupture, only: run_rupture_tests
   use test_scene_input, only: run_scene_input_tests
   use test_spectral_lines, only: run_spectral_lines_tests
   use test_text, only: run_text_tests
   use test_window_record, only: run_window_record_tests
   use test_word_list, only: run_word_list_tests
   use test_printable_text, only: run_printable_text_tests
   use test_stopping, only: run_stopping_tests
   use test_text_output, only: run_text_output_tests
   use test_value_range, only: run_value_range_tests
   use test_film_fit, only: run_film_fit_tests
   use test_film_point, only: run_film_point_tests
   use test_numerical_reynolds, only: run_numerical_reynolds_tests
   use test_recurrence, only: run_recurrence_tests
   use test_regime, only: run_regime_tests
   use test_reynolds_film, only: run_reynolds_film_tests
   use test_reynolds_load, only: run_reynolds_load_tests
   use test_load_expansion, only: run_load_expansion_tests
   use test_reynolds_piezo_expansion, only: run_reynolds_piezo_expansion_tests
   use test_taylor_lanes, only: run_taylor_lanes_tests
   use test_taylor_surprises, only: run_taylor_surprises_tests
   use test_checksum, only: run_checksum_tests
   use test_random_numbers, only: run_random_numbers_tests
   use test_sampling, only: run_sampling_tests
   use test_spread_points, only: run_spread_points_tests
   use test_csv_samples, only: run_csv_samples_tests
   use test_certificate, only: run_certificate_tests
   use test_floquet, only: run_floquet_tests
   use test_period_repetition, only: run_period_repetition_tests
   use test_campaign_file, only: run_campaign_file_tests
   use test_campaign_refusals, only: run_campaign_refusals_tests
   use test_schedule, only: run_schedule_tests
   use test_lane_motions, only: run_lane_motions_tests
   use test_periodic_orbit, only: run_periodic_orbit_tests
   use test_settling_forecast, only: run_settling_forecast_tests
   use test_slow_motions, only: run_slow_motions_tests
   implicit none(type, external)

   type(check_list_t) :: checks

   call run_text_tests(checks)
   call run_printable_text_tests(checks)
   call run_stopping_tests(checks)
   call run_text_output_tests(checks)
   call run_word_list_tests(checks)
   call run_value_range_tests(checks)
   call run_elementary_functions_tests(checks)
   call run_errors_tests(checks)
   call run_key_table_tests(checks)
   call run_namelist_text_tests(checks)
   call run_input_entry_tests(checks)
   call run_scene_input_tests(checks)
   call run_film_integrals_tests(checks)
   call run_rupture_tests(checks)
   call run_film_pressure_tests(checks)
   call run_published_iso_viscous_tests(checks)
   call run_published_piezo_viscous_tests(checks)
   call run_film_law_tests(checks)
   call run_film_fit_tests(checks)
   call run_film_point_tests(checks)
   call run_numerical_reynolds_tests(checks)
   call run_recurrence_tests(checks)
   call run_regime_tests(checks)
   call run_reynolds_film_tests(checks)
   call run_reynolds_load_tests(checks)
   call run_newmark_tests(checks)
   call run_newmark_by_hand_tests(checks)
   call run_newmark_cuts_tests(checks)
   call run_integrate_motion_tests(checks)
   call run_fourier_tests(checks)
   call run_spectral_lines_tests(checks)
   call run_reversals_tests(checks)
   call run_rattle_class_tests(checks)
   call run_regime_check_tests(checks)
   call run_certificate_tests(checks)
   call run_period_repetition_tests(checks)
   call run_floquet_tests(checks)
   call run_numerical_artefacts_tests(checks)
   call run_result_writer_tests(checks)
   call run_load_expansion_tests(checks)
   call run_reynolds_piezo_expansion_tests(checks)
   call run_taylor_lanes_tests(checks)
   call run_taylor_surprises_tests(checks)
   call run_checksum_tests(checks)
   call run_random_numbers_tests(checks)
   call run_spread_points_tests(checks)
   call run_sampling_tests(checks)
   call run_csv_samples_tests(checks)
   call run_campaign_file_tests(checks)
   call run_campaign_refusals_tests(checks)
   call run_schedule_tests(checks)
   call run_lane_motions_tests(checks)
   call run_periodic_orbit_tests(checks)
   call run_settling_forecast_tests(checks)
   call run_window_record_tests(checks)
   call run_slow_motions_tests(checks)

   print '(i0, a, i0, a)', checks%passed, ' passed, ', checks%failed, ' failed'
   if (checks%failed > 0) stop 1, quiet = .true.
end program unit_tests
