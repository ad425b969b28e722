!> Tests of what is reported of thresholds: every number of summary and log against an outcome of which each count is another
!> number. The outcome is that of a state that is carried on with nothing left to solve.
module test_run_threshold
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use campaign_file_cases, only: content_of, line_feed
   use checks, only: check_list_t, same_bits
   use errors, only: error_t, exit_scene_failed, fault_list_t
   use file_system, only: delete_file, path_exists
   use kinds, only: dp, int64
   use log_file, only: log_t
   use output_place, only: log_path, progress_path, result_path, state_path, summary_path
   use prepared_threshold, only: prepared_threshold_t
   use result_reader, only: result_reader_t
   use run_threshold, only: grid_scenes, threshold_task_t
   use scene_texts, only: input_path
   use scene_types, only: scene_t
   use table_task, only: run_table_task
   use text, only: counted, integer_text
   use threshold_cases, only: crossings, failed, grid, traces, new_outcome, prepare, solved, uncertain, uncrossed, wide
   use threshold_outcome, only: add_traces, outcome_t, save_outcome
   implicit none(type, external)
   private

   public :: run_run_threshold_tests

contains

   !> Runs every test of this topic.
   subroutine run_run_threshold_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('run_threshold')
      call test_grid(checks)
      call test_reported(checks)
   end subroutine run_run_threshold_tests

   !> A grid as fine has every place that halving may reach.
   subroutine test_grid(checks)
      class(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene
      type(prepared_threshold_t) :: threshold

      call prepare(checks, scene, threshold, ' /')
      call checks%check_close(grid_scenes(threshold), grid, 1.0e-12_dp, 'a grid of the finest steps')
      threshold%axis%count = 11
      call checks%check_close(grid_scenes(threshold), 11.0_dp*real(traces, dp), 1.0e-12_dp, 'a grid of eleven places')
   end subroutine test_grid

   !> Log, summary and result of a run that is carried on where all traces are done but the last.
   subroutine test_reported(checks)
      class(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene
      type(prepared_threshold_t) :: threshold
      type(outcome_t) :: outcome, whole
      type(threshold_task_t) :: task
      type(fault_list_t) :: faults
      type(error_t), allocatable :: error
      type(log_t) :: log
      type(result_reader_t) :: reader
      character(:), allocatable :: reported, summary
      character(32), parameter :: names(16) = [character(32) :: 'trace', 'kinematics.entrainment_speed', 'crossing', 'lower', &
                                                 'upper', 'width', 'rattle_class_below', 'rattle_class_above', 'status_below', &
                                                 'status_above', 'verified_below', 'verified_above', 'last_below', &
                                                 'last_above', 'motion_end_below', 'motion_end_above']
      real(dp), allocatable :: rows(:, :)
      integer :: exit_code

      call prepare(checks, scene, threshold, ' /')
      call clear(scene)
      call new_outcome(scene, threshold, whole)
      call add_traces(scene, threshold, 1_int64, traces, whole)
      call new_outcome(scene, threshold, outcome)
      call add_traces(scene, threshold, 1_int64, traces - 1_int64, outcome)
      call save_outcome(scene, threshold, outcome, log)
      ! A run that is carried on may replace what it goes on from.
      scene%output%overwrite = .true.
      call run_table_task(task, scene, input_path, .true., .true., faults, exit_code, error)
      call checks%check(faults%count() == 0 .and. .not. allocated(error), 'carried on to its end')
      if (faults%count() > 0) print '(a)', faults%sentence(1)
      if (allocated(error)) print '(a)', error%message
      call checks%check(exit_code == exit_scene_failed, 'scenes that failed are reported by the exit code')
      call checks%check(.not. path_exists(state_path(scene)), 'a state that was carried on to its end is gone')
      reported = content_of(log_path(scene))
      summary = content_of(summary_path(scene))
      call expect('carried on       after '//integer_text(traces - 1_int64)// &
                  ' traces of the earlier run and 5 values of those under way')
      call expect('5 values a trace, then halves down to 33 places;')
      call expect('scenes           '//integer_text(solved)//' of '//integer_text(solved)//',')
      call expect('crossings        '//integer_text(crossings)//'; '//integer_text(uncrossed)//' of '// &
                  counted(traces, 'trace')//' without any; at '//integer_text(uncertain)//' a side is not verified'//line_feed)
      call expect(counted(wide, 'crossing')//' have ends that are verified only farther apart than requested')
      call expect('failed           a side of its own')
      call expect('  '//integer_text(solved)//' scenes; a grid as fine has '//integer_text(nint(grid, int64))// &
                  ', 4.71 times as many'//line_feed)
      call hold('traces', integer_text(traces))
      call hold('crossings', integer_text(crossings))
      call hold('traces_without_crossing', integer_text(uncrossed))
      call hold('crossings_uncertain', integer_text(uncertain))
      call hold('crossings_wide', integer_text(wide))
      call hold('scenes', integer_text(solved))
      call hold('scenes_failed', integer_text(failed))
      call hold('scenes_of_a_grid', '198.0')
      call hold('status', "'complete'")
      call reader%open(result_path(scene), error)
      call checks%check(.not. allocated(error), 'a result')
      if (allocated(error)) return
      allocate (rows(reader%columns, reader%row_count))
      call reader%read_rows(1_int64, rows, error)
      call reader%close()
      call checks%check(all(shape(rows) == shape(whole%rows)), 'as many rows as brackets and traces without one')
      if (all(shape(rows) == shape(whole%rows))) &
         call checks%check(all(same_bits(rows, whole%rows) .or. (ieee_is_nan(rows) .and. ieee_is_nan(whole%rows))), &
                           'rows of the outcome')
      call checks%check(size(reader%names) == size(names), 'as many columns')
      if (size(reader%names) == size(names)) call checks%check(all(reader%names == names), 'names of the columns')
      call clear(scene)

   contains

      subroutine expect(words)
         character(*), intent(in) :: words

         call checks%check(index(reported, words) > 0, 'reported in the log: '//words)
      end subroutine expect

      subroutine hold(key, value)
         character(*), intent(in) :: key
         character(*), intent(in) :: value

         call checks%check(index(summary, '   '//key//' = '//value//line_feed) > 0, 'reported in the summary: '//key//' = '//value)
      end subroutine hold

   end subroutine test_reported

   !> Take the files of the run away.
   subroutine clear(scene)
      type(scene_t), intent(in) :: scene

      call delete_file(state_path(scene))
      call delete_file(result_path(scene))
      call delete_file(summary_path(scene))
      call delete_file(log_path(scene))
      call delete_file(progress_path(scene))
   end subroutine clear

end module test_run_threshold
