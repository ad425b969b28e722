!> Result of a scene as the &summary group.
module scene_summary
   use certificate, only: certificate_word
   use errors, only: error_t
   use floquet, only: orbit_stability, stability_name
   use key_table, only: choice_word
   use kinds, only: dp
   use node_extremes, only: seen_acceleration, seen_film, seen_load, seen_velocity
   use rattle_class, only: class_name
   use regime, only: film_elastohydrodynamic
   use regime_check, only: model_limit_name, regime_name
   use resolved_scene, only: resolved_scene_t
   use scene_report, only: speed_meaning
   use scene_result, only: passes_per_step, scene_result_t
   use scene_status, only: is_success, status_name, status_no_rigid_film, status_sentence
   use scene_types, only: scene_t
   use summary_file, only: summary_t
   use version, only: program_version
   implicit none(type, external)
   private

   !> Harmonics that the summary lists.
   integer, parameter :: most_harmonics = 40

   public :: write_scene_summary, add_head

contains

   !> Write the summary of a scene beside its place, for place_files to bring it there.
   subroutine write_scene_summary(path, scene, resolved, result, error)
      !> Path of the summary
      character(*), intent(in) :: path
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What follows from it
      type(resolved_scene_t), intent(in) :: resolved
      !> Its result
      type(scene_result_t), intent(in) :: result
      !> Set if the file cannot be written
      type(error_t), allocatable, intent(out) :: error
      type(summary_t) :: summary

      call add_head(summary, scene, result%ending%status, result%ending%time)
      call summary%add('law', choice_word('film', 'law', scene%film%law))
      call summary%add('model', choice_word('film', 'model', scene%film%model))
      call summary%add('speed_used', resolved%film%speed)
      call summary%add('speed_meaning', speed_meaning(scene))
      if (resolved%steady_film > 0.0_dp) then
         call summary%add('steady_film', resolved%steady_film)
         call summary%add('natural_frequency', resolved%natural_frequency)
         call summary%add('damping_ratio', resolved%damping_ratio)
      end if
      if (result%judged) call add_window(summary, result)
      if (.not. is_success(result%ending%status) .and. result%ending%film > 0.0_dp) &
         call summary%add('film_at_status_time', result%ending%film)
      if (result%ending%status == status_no_rigid_film) then
         call summary%add('film_regime', regime_name(film_elastohydrodynamic))
         call summary%add('law_contradicted', .true.)
      end if
      call summary%add('periods_solved', result%ending%periods)
      associate (count => result%ending%count)
         call summary%add('evaluations', count%evaluations)
         call summary%add('steps', count%steps)
         call summary%add('steps_cut', count%cuts)
         if (count%steps > 0) call summary%add('iterations_per_step', passes_per_step(count))
      end associate
      call summary%add('wall_seconds', result%solve_seconds + result%judge_seconds)
      call summary%write_beside(path, error)
   end subroutine write_scene_summary

   !> What every summary of a scene begins with.
   subroutine add_head(summary, scene, status, time)
      !> An empty summary
      type(summary_t), intent(inout) :: summary
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Status of scene_status
      integer, intent(in) :: status
      !> When a motion got it [s]
      real(dp), intent(in), optional :: time

      call summary%add('name', trim(scene%name))
      call summary%add('program_version', program_version)
      call summary%add('status', status_name(status))
      if (present(time)) call summary%add('status_time', time)
      call summary%add('status_text', status_sentence(status))
   end subroutine add_head

   !> What was judged from the window.
   subroutine add_window(summary, result)
      type(summary_t), intent(inout) :: summary
      type(scene_result_t), intent(in) :: result

      call summary%add('window_periods', result%window_periods)
      call summary%add('samples_per_period', result%samples_per_period)
      call summary%add('series_coarse', result%series_coarse)
      call summary%add('lines_by_integrals', result%lines_by_integrals)
      associate (lowest => result%extremes%lowest, highest => result%extremes%highest)
         call summary%add('film_minimum', lowest(seen_film)%value)
         call summary%add('film_maximum', highest(seen_film)%value)
         call summary%add('velocity_minimum', lowest(seen_velocity)%value)
         call summary%add('velocity_maximum', highest(seen_velocity)%value)
         call summary%add('acceleration_minimum', lowest(seen_acceleration)%value)
         call summary%add('acceleration_maximum', highest(seen_acceleration)%value)
         call summary%add('load_minimum', lowest(seen_load)%value)
         call summary%add('load_maximum', highest(seen_load)%value)
      end associate
      call summary%add('model_limit', model_limit_name(result%model_limit))
      associate (rattle => result%rattle, lines => result%rattle%lines)
         call summary%add('reversals_per_period', rattle%reversals_per_period)
         call summary%add('harmonics', lines%harmonics(:min(most_harmonics, size(lines%harmonics))))
         if (lines%moving) then
            call summary%add('line_count', lines%line_count)
            call summary%add('line_count_is_bound', lines%count_is_bound)
            call summary%add('harmonic_distortion', lines%harmonic_distortion)
            call summary%add('harmonic_distortion_is_bound', lines%distortion_is_bound)
            call summary%add('irregular_fraction', lines%irregular_fraction)
            call summary%add('sampling_sufficient', lines%sampling_sufficient)
         end if
         call summary%add('rattle_class', class_name(rattle%class))
      end associate
      if (result%certificate%exists) call add_certificate(summary, result)
      if (result%orbit%period == 0 .and. result%ending%orbit > 0) call summary%add('orbit_period', result%ending%orbit)
      associate (regime => result%regime)
         if (regime%pressure_exists) call summary%add('pressure_maximum', regime%pressure_maximum)
         call summary%add('alpha_p_maximum', regime%alpha_p_maximum)
         call summary%add('deflection', regime%deflection)
         call summary%add('film_regime', regime_name(regime%regime))
         call summary%add('law_contradicted', regime%law_contradicted)
      end associate
   end subroutine add_window

   !> What the tighter solution says, and the periodic motion with its multipliers.
   subroutine add_certificate(summary, result)
      type(summary_t), intent(inout) :: summary
      type(scene_result_t), intent(in) :: result

      associate (certificate => result%certificate, orbit => result%orbit)
         call summary%add('certificate', certificate_word(certificate))
         call summary%add('certificate_text', certificate%reason)
         if (size(certificate%harmonic_errors) > 0) then
            call summary%add('film_error', certificate%film_error)
            call summary%add('film_minimum_error', certificate%film_minimum_error)
            call summary%add('film_maximum_error', certificate%film_maximum_error)
            call summary%add('acceleration_error', certificate%acceleration_error)
            call summary%add('acceleration_minimum_error', certificate%acceleration_minimum_error)
            call summary%add('acceleration_maximum_error', certificate%acceleration_maximum_error)
            call summary%add('harmonic_errors', &
                             certificate%harmonic_errors(:min(most_harmonics, size(certificate%harmonic_errors))))
         end if
         if (orbit%period > 0) then
            call summary%add('orbit_period', orbit%period)
            call summary%add('orbit_stability', stability_name(orbit_stability(orbit%multipliers)))
            call summary%add('floquet_multipliers', [orbit%multipliers(1)%re, orbit%multipliers(1)%im, &
                                                     orbit%multipliers(2)%re, orbit%multipliers(2)%im])
         end if
      end associate
   end subroutine add_certificate

end module scene_summary
