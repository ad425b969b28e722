!> A sweep from input to files: steady motions along a key, each carried on from the one before, there and back.
!> Where two motions are possible, the way there and the way back show different ones: jumps and hysteresis.
module run_sweep
   use clock, only: wall_seconds
   use errors, only: error_t
   use fine_window, only: solve_whole_window, window_t
   use finished_files, only: place_files
   use floquet, only: orbit_stability
   use integrate_controlled, only: find_steady_motion
   use kinds, only: dp, int64
   use lane_scenes, only: lane_ending_t, lane_scene_t
   use log_file, only: log_t
   use node_extremes, only: seen_acceleration, seen_film
   use output_place, only: log_path, result_path, summary_path
   use periodic_orbit, only: attracting_period, find_periodic_orbit, periodic_orbit_t
   use progress, only: progress_t
   use rattle_class, only: note_orbit, rattle_verdict_t
   use regime_check, only: model_limit
   use resolved_scene, only: resolve, resolved_scene_t
   use result_writer, only: result_writer_t
   use scene_lane, only: lane_of_scene
   use scene_report, only: law_sentence, report_head
   use scene_status, only: is_success, status_complete, status_interrupted, status_not_written, status_sentence
   use scene_summary, only: add_head
   use scene_types, only: scene_t, sweep_force_amplitude, sweep_frequency, sweep_steady_force
   use signals, only: caught_signal
   use summary_file, only: summary_t
   use text, only: integer_text, short_text
   use word_list, only: word_t
   implicit none(type, external)
   private

   !> Columns of the table.
   integer, parameter, public :: sweep_columns = 18
   character(*), parameter :: names(sweep_columns) = [character(24) :: 'value', 'direction', 'film_minimum', 'film_maximum', &
      'acceleration_minimum', 'acceleration_maximum', 'orbit_period', 'floquet_modulus', 'orbit_stability', 'line_count', &
      'harmonic_distortion', 'irregular_fraction', 'rattle_class', 'natural_frequency', 'periods', 'status', 'first_harmonic', &
      'model_limit']
   character(*), parameter :: units(sweep_columns) = [character(8) :: '-', '-', 'm', 'm', 'm/s2', 'm/s2', '-', '-', '-', '-', &
      '-', '-', '-', 'Hz', '-', '-', 'm/s2', '-']
   !> A periodic motion farther away than this is another one [-].
   real(dp), parameter :: orbit_nearness = 1.0e-3_dp

   public :: run_sweep_task, solve_value

contains

   !> Run a sweep and write its files.
   subroutine run_sweep_task(scene, quiet, status, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Nothing to the terminal
      logical, intent(in) :: quiet
      !> Status of scene_status
      integer, intent(out) :: status
      !> Set if a file could not be written
      type(error_t), allocatable, intent(out) :: error
      type(log_t), target :: log
      type(progress_t) :: watcher
      type(result_writer_t) :: writer
      type(error_t), allocatable :: close_error, summary_error
      real(dp) :: started, film, velocity, row(sweep_columns, 1)
      integer :: i, failed, ended, beyond_model

      status = status_complete
      started = wall_seconds()
      call log%open(log_path(scene), quiet, error)
      if (allocated(error)) return
      call report_head(log, scene, 'sweep of '//integer_text(size(scene%sweep%values))//' motions, '//law_sentence(scene))
      call writer%open(result_path(scene), scene%resolved_input, names, units, size(scene%sweep%values, kind=int64), .true., error)
      call watcher%start(log, quiet)
      film = 0.0_dp
      velocity = 0.0_dp
      failed = 0
      beyond_model = 0
      do i = 1, size(scene%sweep%values)
         if (allocated(error)) exit
         call solve_value(swept_scene(scene, scene%sweep%values(i)), film, velocity, row(:, 1), ended, error)
         ! A motion under way when the signal came may be half judged.
         if (caught_signal() /= 0) then
            status = status_interrupted
            exit
         end if
         if (allocated(error)) exit
         row(1:2, 1) = [scene%sweep%values(i), merge(1.0_dp, -1.0_dp, i <= scene%sweep%outward)]
         row(16, 1) = real(ended, dp)
         if (.not. is_success(ended)) failed = failed + 1
         if (row(18, 1) > 0.0_dp) beyond_model = beyond_model + 1
         call writer%write_rows(row, error)
         call watcher%period_done(i, size(scene%sweep%values))
      end do
      call watcher%clear()
      call writer%close(close_error)
      if (.not. allocated(error) .and. allocated(close_error)) call move_alloc(close_error, error)
      if (allocated(error)) status = status_not_written
      call write_sweep_summary(scene, failed, wall_seconds() - started, status, summary_error)
      if (.not. allocated(error) .and. allocated(summary_error)) call move_alloc(summary_error, error)
      call place_files([word_t(result_path(scene))], summary_path(scene), error)
      if (allocated(error)) status = status_not_written
      if (allocated(error)) then
         call log%line('  '//error%message)
      else
         if (beyond_model > 0) call log%line('  warning: '//integer_text(beyond_model)//' motions leave what the model can '// &
            'mean: films beyond a tenth of the radius or below 1 nm (column model_limit)')
         call log%line('  '//integer_text(failed)//' motions failed; '//short_text(wall_seconds() - started, 3)//' s: '// &
                       status_sentence(status))
         call log%line('  '//result_path(scene))
         call log%line('  '//summary_path(scene))
      end if
      call log%close()
   end subroutine run_sweep_task

   !> The scene at one value of the swept key.
   pure function swept_scene(scene, value) result(swept)
      type(scene_t), intent(in) :: scene
      real(dp), intent(in) :: value
      type(scene_t) :: swept

      swept = scene
      select case (scene%sweep%key)
      case (sweep_frequency)
         swept%load%frequency = value
      case (sweep_force_amplitude)
         swept%load%force_amplitude = value
      case (sweep_steady_force)
         swept%load%steady_force = value
      case default
         swept%kinematics%entrainment_speed = value
      end select
   end function swept_scene

   !> Steady motion of one value, from the state given; that state becomes the one for the next value.
   subroutine solve_value(scene, film, velocity, row, status, error)
      !> Checked scene with that value
      type(scene_t), intent(in) :: scene
      !> State to start from; no film: the steady film at rest [m], [m/s]
      real(dp), intent(inout) :: film
      real(dp), intent(inout) :: velocity
      !> Row of the table, by the places of its names, but the first two values and the status; what is unknown is 0
      real(dp), intent(out) :: row(:)
      !> Status of scene_status
      integer, intent(out) :: status
      !> Set if there is not enough memory
      type(error_t), allocatable, intent(out) :: error
      type(resolved_scene_t) :: resolved
      type(lane_scene_t) :: lane
      type(lane_ending_t) :: ending, window_ending
      type(periodic_orbit_t) :: orbit
      type(rattle_verdict_t) :: verdict
      type(window_t) :: window

      row = 0.0_dp
      resolved = resolve(scene)
      row(14) = resolved%natural_frequency
      if (.not. film > 0.0_dp) then
         film = resolved%initial_film
         velocity = scene%film%initial_velocity
      end if
      status = resolved%film%status_without_load
      if (.not. film > 0.0_dp) return
      call find_steady_motion(lane_of_scene(scene, resolved%film, film, velocity), scene%solver%accuracy, &
                              scene%solver%periods, scene%spectrum%periods, ending)
      row(15) = real(ending%periods, dp)
      status = ending%status
      if (.not. is_success(status)) then
         film = 0.0_dp
         return
      end if
      film = ending%film
      velocity = ending%velocity
      lane = lane_of_scene(scene, resolved%film, film, velocity)
      window%periods = scene%spectrum%periods
      if (ending%orbit > 0) window%periods = ending%orbit
      window%samples_per_period = scene%solver%samples_per_period()
      call solve_whole_window(scene, lane, scene%solver%accuracy, window%periods, resolved%noise_floor, window, verdict, &
                              window_ending, error)
      if (allocated(error)) return
      if (.not. is_success(window_ending%status)) then
         status = window_ending%status
         return
      end if
      orbit = find_periodic_orbit(lane, film, velocity, orbit_nearness)
      call note_orbit(verdict, max(ending%orbit, attracting_period(orbit)))
      associate (lowest => window%record%lowest, highest => window%record%highest)
         row(3:6) = [lowest(seen_film)%value, highest(seen_film)%value, lowest(seen_acceleration)%value, &
                     highest(seen_acceleration)%value]
         row(18) = real(model_limit(row(3), row(4), resolved%film%radius), dp)
      end associate
      row(7) = real(orbit%period, dp)
      if (orbit%period > 0) row(8:9) = [abs(orbit%multipliers(1)), real(orbit_stability(orbit%multipliers), dp)]
      if (verdict%lines%moving) row(10:12) = [real(verdict%lines%line_count, dp), verdict%lines%harmonic_distortion, &
                                              verdict%lines%irregular_fraction]
      row(13) = real(verdict%class, dp)
      row(17) = verdict%lines%harmonics(1)
   end subroutine solve_value

   !> What the sweep did.
   subroutine write_sweep_summary(scene, failed, seconds, status, error)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: failed
      real(dp), intent(in) :: seconds
      integer, intent(in) :: status
      type(error_t), allocatable, intent(out) :: error
      type(summary_t) :: summary

      call add_head(summary, scene, status)
      call summary%add('motions', size(scene%sweep%values))
      call summary%add('motions_failed', failed)
      call summary%add('wall_seconds', seconds)
      call summary%write_beside(summary_path(scene), error)
   end subroutine write_sweep_summary

end module run_sweep
