!> A sweep from input to files: steady motions along a key, each carried on from the one before, there and back.
!> Where two motions are possible, the increasing and the decreasing show different ones: jumps and hysteresis.
module run_sweep
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use clock, only: wall_seconds
   use derived_scene, only: derive
   use engine, only: motion_state_t, start_of
   use errors, only: error_t
   use finished_files, only: place_files
   use judge_group, only: judgement_space_t
   use judged_scene, only: judged_scene_t, quantity_numbers, quantity_value
   use key_table, only: keys
   use kinds, only: dp, int64
   use log_file, only: log_t
   use output_place, only: log_path, result_path, summary_path
   use starting_state, only: keep_by_contacts, kept_by_contacts
   use problem, only: of_film, of_velocity
   use progress, only: progress_t
   use quantities, only: columns_of, need_count, needs_film_force, needs_motion_verdicts, needs_orbit, needs_starts, &
      needs_verification, needs_verified_impacts, quantities_reported_in, quantity_model_limit, quantity_t, quantity_table
   use prepared_scene, only: prepare, prepared_scene_t
   use result_format, only: column_name_bytes, column_unit_bytes
   use result_reader, only: result_reader_t
   use result_writer, only: result_writer_t
   use regime_check, only: outside_model
   use scene_report, only: law_sentence, report_head
   use scene_solution, only: solve_and_judge
   use scene_status, only: is_success, status_complete, status_interrupted, status_not_written, status_sentence
   use scene_summary, only: add_head, add_results
   use scene_types, only: scene_t, set_number
   use signals, only: caught_signal, must_stop
   use summary_file, only: summary_t
   use text, only: counted, integer_text, short_text
   use word_list, only: word_t
   implicit none(type, external)
   private

   !> What a motion hands to the next one.
   type, public :: carried_state_t
      !> h [m], 0: there is none; z' [m/s]
      real(dp) :: film = 0.0_dp
      real(dp) :: velocity = 0.0_dp
      !> What the contacts keep while the stiffness changes
      real(dp), allocatable :: kept(:)
   end type carried_state_t

   public :: run_sweep_task, solve_value

contains

   !> Run a sweep and write its files.
   subroutine run_sweep_task(scene, quiet, verbose, carry_on, status, failed, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Nothing to the terminal
      logical, intent(in) :: quiet
      !> All of the log to the terminal
      logical, intent(in) :: verbose
      !> Whether an earlier run is to be carried on: it is solved anew, and the log says where it was cut
      logical, intent(in) :: carry_on
      !> Status of scene_status
      integer, intent(out) :: status
      !> How many of its motions failed
      integer, intent(out) :: failed
      !> Set if a file could not be written
      type(error_t), allocatable, intent(out) :: error
      type(log_t), target :: log
      type(progress_t) :: watcher
      type(result_writer_t) :: writer
      type(error_t), allocatable :: close_error, summary_error
      type(judged_scene_t) :: judged
      type(judgement_space_t) :: space
      character(column_name_bytes), allocatable :: names(:)
      character(column_unit_bytes), allocatable :: units(:)
      type(carried_state_t) :: state
      real(dp) :: started
      integer :: i, beyond_model

      status = status_complete
      failed = 0
      started = wall_seconds()
      call log%open(log_path(scene), quiet, error, verbose)
      if (allocated(error)) return
      call report_head(log, scene, 'sweep of '//integer_text(size(scene%sweep%values))//' motions, '//law_sentence(scene))
      if (carry_on) call report_cut(log, scene)
      call sweep_columns(scene, names, units)
      call writer%open(result_path(scene), scene%resolved_input, names, units, size(scene%sweep%values, kind=int64), .true., error)
      call watcher%start(log, 'motions', quiet)
      beyond_model = 0
      do i = 1, size(scene%sweep%values)
         if (allocated(error)) exit
         call solve_value(swept_scene(scene, scene%sweep%values(i)), state, space, judged, error)
         ! A motion under way when the signal came may be half judged.
         if (caught_signal() /= 0) then
            status = status_interrupted
            call log%item('cut', 'after '//integer_text(i - 1)//' of '//counted(size(scene%sweep%values), 'motion'))
            exit
         end if
         if (allocated(error)) exit
         if (.not. is_success(judged%status)) failed = failed + 1
         if (quantity_value(quantity_model_limit, judged) > 0.0_dp) beyond_model = beyond_model + 1
         call writer%write_rows(reshape(sweep_row(scene, i, judged), [size(names), 1]), error)
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
         call log%item('error', error%message)
      else
         call log%item('motions', integer_text(size(scene%sweep%values))//' in '//short_text(wall_seconds() - started, 3)// &
                       ' s: '//ending_sentence(scene, failed, status))
         call log%item('files', summary_path(scene)//', .rattle, .log')
         if (beyond_model > 0) call log%item('warning', outside_model(counted(beyond_model, 'motion')))
      end if
      call log%close()
   end subroutine run_sweep_task

   !> The scene at one value of the swept key.
   pure function swept_scene(scene, value) result(swept)
      type(scene_t), intent(in) :: scene
      real(dp), intent(in) :: value
      type(scene_t) :: swept

      swept = scene
      call set_number(swept, keys(scene%sweep%key)%group, keys(scene%sweep%key)%name, value)
      call derive(swept)
   end function swept_scene

   !> Report where an earlier run of this sweep was cut, if it was.
   subroutine report_cut(log, scene)
      type(log_t), intent(in) :: log
      type(scene_t), intent(in) :: scene
      type(result_reader_t) :: earlier
      type(error_t), allocatable :: error

      call earlier%open(result_path(scene), error)
      if (allocated(error)) return
      if (earlier%row_count < size(scene%sweep%values)) call log%item('earlier run', &
         'was cut after '//integer_text(earlier%row_count)//' of '// &
         counted(size(scene%sweep%values), 'motion')//'; every motion begins with the one before, so all are solved again')
      call earlier%close()
   end subroutine report_cut

   !> Names and units of the columns: the swept key, the way, then the quantities that sweeps report.
   pure subroutine sweep_columns(scene, names, units)
      type(scene_t), intent(in) :: scene
      character(column_name_bytes), allocatable, intent(out) :: names(:)
      character(column_unit_bytes), allocatable, intent(out) :: units(:)
      type(quantity_t), allocatable :: reported(:)

      allocate (reported, source=columns_of(swept_quantities(scene)))
      names = [character(column_name_bytes) :: keys(scene%sweep%key)%name, 'direction', reported%name]
      units = [character(column_unit_bytes) :: keys(scene%sweep%key)%unit, '-', reported%unit]
   end subroutine sweep_columns

   !> Codes of the quantities that this sweep reports; what is swept has its column already.
   pure function swept_quantities(scene) result(codes)
      type(scene_t), intent(in) :: scene
      integer, allocatable :: codes(:)

      codes = quantities_reported_in('sweep')
      if (scene%contact%backlash > 0.0_dp) codes = [codes, quantities_reported_in('flanks')]
      if (scene%gear%given) codes = [codes, quantities_reported_in('gears')]
      codes = pack(codes, quantity_table(codes)%name /= keys(scene%sweep%key)%name)
   end function swept_quantities

   !> Row of a value; what is unknown is 0.
   pure function sweep_row(scene, place, judged) result(row)
      type(scene_t), intent(in) :: scene
      !> Place of the value in the sweep
      integer, intent(in) :: place
      !> The motion there
      type(judged_scene_t), intent(in) :: judged
      real(dp), allocatable :: row(:)

      row = [scene%sweep%values(place), merge(1.0_dp, -1.0_dp, place <= scene%sweep%outward), &
             quantity_numbers(swept_quantities(scene), judged)]
      where (ieee_is_nan(row)) row = 0.0_dp
   end function sweep_row

   !> Steady motion of one value, from the state given; that state becomes the one for the next value.
   subroutine solve_value(scene, state, space, judged, error)
      !> Checked scene with that value
      type(scene_t), intent(in) :: scene
      !> State to start from; no film: the steady film at rest
      type(carried_state_t), intent(inout) :: state
      !> Work space
      type(judgement_space_t), intent(inout) :: space
      !> The motion
      type(judged_scene_t), intent(out) :: judged
      !> Set if there is not enough memory
      type(error_t), allocatable, intent(out) :: error
      type(prepared_scene_t) :: prepared(1)
      type(judged_scene_t) :: judged_values(1)
      type(motion_state_t) :: start

      prepared(1) = prepare(scene)
      prepared%request%until_steady = .true.
      judged%resolved = prepared(1)%resolved
      associate (problem => prepared(1)%resolved%problem)
         judged%status = problem%contact%film%status_without_load
         if (state%film > 0.0_dp) then
            problem%initial_film = state%film
            problem%initial_velocity = state%velocity
         end if
         if (.not. problem%initial_film > 0.0_dp) return
         start = start_of(problem)
         if (state%film > 0.0_dp) call keep_by_contacts(problem, state%kept, start%numbers)
         call solve_and_judge(prepared, [start], needs_of_values(), space, judged_values, error)
         if (must_stop() .or. allocated(error)) return
         judged = judged_values(1)
         state = carried_state_t()
         if (.not. is_success(judged%status)) return
         state%film = judged%ending%numbers(of_film)
         state%velocity = judged%ending%numbers(of_velocity)
         state%kept = kept_by_contacts(problem, judged%ending%numbers)
      end associate
   end subroutine solve_value

   !> What has to be found for the values of a sweep; the harmonics of all are computed.
   pure function needs_of_values() result(needed)
      logical :: needed(need_count)

      needed = .true.
      needed([needs_verification, needs_verified_impacts, needs_orbit, needs_starts, needs_motion_verdicts, needs_film_force]) = &
         .false.
   end function needs_of_values

   !> How the sweep ended, whose motions may have failed.
   pure function ending_sentence(scene, failed, status) result(sentence)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: failed
      !> Status of the sweep
      integer, intent(in) :: status
      character(:), allocatable :: sentence

      sentence = status_sentence(status)
      if (failed == 0) return
      if (status /= status_complete) then
         sentence = sentence//' '//counted(failed, 'motion')//' failed (column status).'
      else
         sentence = integer_text(failed)//' of '//counted(size(scene%sweep%values), 'motion')//' failed (column status).'
         if (failed < size(scene%sweep%values)) sentence = sentence//' The others were solved.'
      end if
   end function ending_sentence

   !> What the sweep did.
   subroutine write_sweep_summary(scene, failed, seconds, status, error)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: failed
      real(dp), intent(in) :: seconds
      integer, intent(in) :: status
      type(error_t), allocatable, intent(out) :: error
      type(summary_t) :: summary

      call add_head(summary, scene, status, sentence=ending_sentence(scene, failed, status))
      call add_results(summary, [word_t(result_path(scene))], status)
      call summary%add('motions', size(scene%sweep%values))
      call summary%add('motions_failed', failed)
      call summary%add('wall_seconds', seconds)
      call summary%write_beside(summary_path(scene), error)
   end subroutine write_sweep_summary

end module run_sweep
