!> Thresholds from input to file: a scan of every trace, then passes over all traces together, each the middles of all brackets
!> that are still wide, then the verifications of their ends, all solved as the scenes of a campaign are. Some traces are searched
!> at a time; NAME.state keeps what was found, for --resume.
module run_threshold
   use campaign_progress, only: campaign_progress_t
   use clock, only: wall_seconds
   use errors, only: error_t, exit_complete, exit_scene_failed, fault_list_t, raise
   use file_system, only: delete_file, path_exists
   use finished_files, only: place_files
   use key_table, only: key_name
   use kinds, only: dp, int64
   use log_file, only: log_magic, log_t
   use output_lock, only: output_lock_t
   use output_place, only: claim_output_place, log_path, progress_path, result_path, state_path, summary_path
   use prepared_threshold, only: prepare_threshold, prepared_threshold_t
   use ranks, only: abort_ranks, rank_count, share_number, sum_over_ranks, this_rank
   use scene_report, only: law_sentence
   use scene_status, only: status_complete, status_interrupted, status_not_written
   use scene_summary, only: add_head, add_results
   use scene_types, only: scene_t
   use signals, only: caught_signal
   use solve_threshold, only: search_lines
   use summary_file, only: summary_t
   use text, only: counted, integer_text, short_text
   use threshold_outcome, only: failed_scenes, load_outcome, outcome_t, save_outcome, share_points, solved_scenes, &
                                check_earlier_threshold, start_outcome, write_rows_of
   use version, only: program_version
   use word_list, only: word_t
   use, intrinsic :: omp_lib, only: omp_get_max_threads
   implicit none(type, external)
   private

   !> Scenes of a scan for each thread that are solved at a time: traces beyond them wait for those before
   integer(int64), parameter :: scanned_together = 4096_int64

   public :: run_one_threshold, grid_scenes

contains

   !> Find thresholds and write their files. All ranks call this.
   subroutine run_one_threshold(scene, file, carry_on, quiet, faults, exit_code, error)
      !> Checked base scene
      type(scene_t), intent(in) :: scene
      !> Its input, for the faults
      character(*), intent(in) :: file
      !> Go on from the state of an earlier run, if there is one
      logical, intent(in) :: carry_on
      !> Nothing to the terminal
      logical, intent(in) :: quiet
      !> Faults of the input are appended; nothing has run then
      type(fault_list_t), intent(inout) :: faults
      !> Exit code of the program
      integer, intent(out) :: exit_code
      !> Set if files could not be written
      type(error_t), allocatable, intent(out) :: error
      type(prepared_threshold_t) :: threshold
      type(campaign_progress_t) :: progress
      type(outcome_t) :: outcome
      type(log_t) :: log
      type(output_lock_t) :: lock
      real(dp) :: started
      integer(int64) :: first, last, last_trace, together
      integer :: traces_before

      started = wall_seconds()
      call prepare_threshold(scene, file, .false., threshold, faults)
      exit_code = faults%exit_code
      if (this_rank() == 0) then
         call claim_output_place(scene, file, lock, faults, error)
         if (faults%count() == 0 .and. .not. allocated(error) .and. carry_on) call load_outcome(scene, threshold, outcome, error)
         if (faults%count() == 0 .and. .not. allocated(error) .and. carry_on .and. .not. allocated(outcome%rows)) &
            call check_earlier_threshold(scene, threshold, error)
         if (faults%count() == 0 .and. .not. allocated(error)) call log%open(log_path(scene), quiet, error)
         exit_code = merge(faults%exit_code, exit_complete, faults%count() > 0)
         if (allocated(error)) exit_code = error%exit_code
         if (caught_signal() /= 0) exit_code = 128 + caught_signal()
      end if
      call share_number(exit_code)
      if (exit_code /= exit_complete) then
         call lock%release(.true.)
         return
      end if
      ! Memory may lack on the machine of this rank alone.
      if (faults%count() > 0) then
         call raise(error, faults%exit_code, faults%sentence(1))
         call abort_ranks(error)
         return
      end if
      call start_outcome(scene, threshold, outcome)
      call share_points(scene, threshold, outcome)
      if (this_rank() == 0) call report_start(log, scene, threshold, carry_on, outcome)
      if (this_rank() == 0) then
         if (len(lock%warning) > 0) call log%line('  '//lock%warning)
      end if
      if (this_rank() == 0 .and. .not. carry_on) call delete_file(state_path(scene))
      traces_before = int(outcome%traces)
      call share_number(traces_before)
      last_trace = threshold%traces%first + threshold%traces%layout%scene_count - 1_int64
      call progress%start(progress_path(scene), solved_scenes(outcome), solved_scenes(outcome), quiet)
      together = max(1_int64, scanned_together*rank_count()*omp_get_max_threads()/size(threshold%scan, kind=int64))
      do first = threshold%traces%first + traces_before, last_trace, together
         last = min(last_trace, first + together - 1_int64)
         call search_lines(scene, threshold, first, last, progress, log, outcome)
         if (outcome%cut) exit
      end do
      if (this_rank() == 0 .and. outcome%cut) call save_outcome(scene, threshold, outcome, log)
      progress%done = sum_over_ranks(progress%done)
      progress%failed = sum_over_ranks(progress%failed)
      if (this_rank() == 0) call close_threshold(scene, threshold, started, progress, log, outcome, exit_code, error)
      call lock%release(allocated(error))
      call share_number(exit_code)
   end subroutine run_one_threshold

   !> What will be done.
   subroutine report_start(log, scene, threshold, carry_on, outcome)
      type(log_t), intent(in) :: log
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      logical, intent(in) :: carry_on
      !> What an earlier run has found
      type(outcome_t), intent(in) :: outcome
      integer :: i

      call log%line(log_magic//program_version//', threshold '//trim(scene%name)//': '// &
                    counted(int(threshold%traces%layout%scene_count), 'trace')//' of '//key_name(threshold%axis%position)//', '// &
                    law_sentence(scene)//'; '//counted(rank_count(), 'rank')//' of '//counted(omp_get_max_threads(), 'thread'))
      do i = 1, size(scene%warnings)
         call log%line('  '//scene%warnings(i)%text)
      end do
      do i = 1, size(threshold%traces%warnings)
         call log%line('  '//threshold%traces%warnings(i)%text)
      end do
      if (solved_scenes(outcome) > 0_int64) then
         call log%line('  carried on after '//integer_text(outcome%traces)//' traces of the earlier run and '// &
                       integer_text(size(outcome%points))//' values of those under way')
      else if (carry_on) then
         call log%line('  there is no state of an earlier run; all is solved from the start')
      end if
      call log%line('  '//integer_text(size(threshold%scan))//' values a trace, then halves down to '// &
                    integer_text(threshold%axis%count)//' places; two changes between neighbours of the scan that cancel each '// &
                    'other stay unseen: more &threshold count sees them')
      if (scene%spectrum%verify) call log%line('  the ends of a crossing go apart again until both are verified')
   end subroutine report_start

   !> Scenes of a grid that finds brackets as narrow.
   pure real(dp) function grid_scenes(scene, threshold)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold

      grid_scenes = real(threshold%axis%count, dp)
      if (.not. threshold%axis%whole) grid_scenes = max(real(scene%threshold%count, dp), 1.0_dp/scene%threshold%tolerance + 1.0_dp)
      grid_scenes = grid_scenes*real(threshold%traces%layout%scene_count, dp)
   end function grid_scenes

   !> Write the files and say what became of the thresholds. What was cut short leaves no result.
   subroutine close_threshold(scene, threshold, started, progress, log, outcome, exit_code, error)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      real(dp), intent(in) :: started
      type(campaign_progress_t), intent(inout) :: progress
      type(log_t), intent(inout) :: log
      type(outcome_t), intent(in) :: outcome
      integer, intent(out) :: exit_code
      !> In: what has failed so far; out: also if a file could not be written
      type(error_t), allocatable, intent(inout) :: error
      type(error_t), allocatable :: summary_error
      type(summary_t) :: summary
      type(word_t), allocatable :: results(:)
      integer :: status
      logical :: keeps_earlier

      call progress%finish(log)
      allocate (results(0))
      status = status_complete
      if (outcome%cut) then
         status = status_interrupted
      else if (.not. allocated(error)) then
         results = [word_t(result_path(scene))]
         call write_rows_of(result_path(scene), scene, threshold, outcome%rows, error)
      end if
      if (allocated(error)) status = status_not_written
      call add_head(summary, scene, status)
      call add_results(summary, results, status)
      call summary%add('traces', threshold%traces%layout%scene_count)
      call summary%add('crossings', outcome%crossings)
      call summary%add('traces_without_crossing', outcome%uncrossed)
      if (scene%spectrum%verify) call summary%add('crossings_uncertain', outcome%uncertain)
      if (scene%spectrum%verify) call summary%add('crossings_wide', outcome%wide)
      call summary%add('scenes', solved_scenes(outcome))
      call summary%add('scenes_failed', failed_scenes(outcome))
      call summary%add('scenes_of_a_grid', grid_scenes(scene, threshold))
      call summary%add('wall_seconds', wall_seconds() - started)
      keeps_earlier = .false.
      if (outcome%cut) keeps_earlier = path_exists(result_path(scene))
      ! Where an earlier run left a result, its summary stays beside it: what was cut short has its state.
      if (.not. keeps_earlier) then
         call summary%write_beside(summary_path(scene), summary_error)
         if (.not. allocated(error) .and. allocated(summary_error)) call move_alloc(summary_error, error)
         call place_files(results, summary_path(scene), error)
      end if
      if (allocated(error)) then
         call log%line('  '//error%message)
      else if (outcome%cut) then
         call log%line('  cut short after '//integer_text(outcome%traces)//' of '// &
                       counted(int(threshold%traces%layout%scene_count), 'trace')//'; --resume goes on with these and '// &
                       counted(size(outcome%points), 'value')//' of the next, no result is written before')
         if (keeps_earlier) then
            call log%line('  '//result_path(scene)//' and its summary are those of an earlier run')
         else
            call log%line('  '//summary_path(scene))
         end if
      else
         call delete_file(state_path(scene))
         call report_ending(log, scene, threshold, outcome)
      end if
      call log%close()
      exit_code = exit_complete
      if (failed_scenes(outcome) > 0_int64) exit_code = exit_scene_failed
      if (outcome%cut) exit_code = 128 + caught_signal()
      if (allocated(error)) exit_code = error%exit_code
   end subroutine close_threshold

   !> What was found, and what it took.
   subroutine report_ending(log, scene, threshold, outcome)
      type(log_t), intent(in) :: log
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(outcome_t), intent(in) :: outcome
      character(:), allocatable :: line

      line = '  '//counted(outcome%crossings, 'crossing')//'; '//integer_text(outcome%uncrossed)//' of '// &
             counted(threshold%traces%layout%scene_count, 'trace')//' without any'
      if (scene%spectrum%verify) line = line//'; at '//counted(outcome%uncertain, 'crossing')// &
                                         ' a class beside it is not verified'
      call log%line(line)
      if (outcome%wide > 0_int64) call log%line('  the ends of '//counted(outcome%wide, 'crossing')//' are verified only '// &
                                                'farther apart than asked for: the width tells how sure that is (column width)')
      if (outcome%failed > 0_int64) call log%line('  scenes that failed are a kind of their own: where they begin is a '// &
                                                  'crossing (columns status_below, status_above)')
      ! Where there are more parts than traces, some have none.
      if (outcome%solved > 0_int64) &
         call log%line('  '//integer_text(outcome%solved)//' scenes; a grid as fine has '// &
                       integer_text(nint(grid_scenes(scene, threshold), int64))//', '// &
                       short_text(grid_scenes(scene, threshold)/real(outcome%solved, dp), 3)//' times as many')
      call log%line('  '//result_path(scene))
      call log%line('  '//summary_path(scene))
   end subroutine report_ending

end module run_threshold
