!> Thresholds: a scan of every trace, then rounds over all traces together, each of the middles of all brackets that are still wide,
!> then the verifications of their ends, all solved as the scenes of a campaign are. Some traces are searched at a time; NAME.state
!> keeps what was found, for --resume. table_task runs them.
module run_threshold
   use campaign_plan, only: look_watcher_t
   use clock, only: wall_seconds
   use core_time, only: core_time_sentence
   use errors, only: error_t, fault_list_t
   use file_system, only: delete_file, path_exists
   use finished_files, only: place_files
   use key_table, only: key_name
   use kinds, only: dp, int64
   use log_file, only: log_t
   use output_place, only: result_path, state_path, summary_path
   use prepared_campaign, only: campaign_t
   use prepared_threshold, only: points_plan, prepare_threshold, prepared_threshold_t
   use ranks, only: rank_count, share_number, this_rank
   use scene_status, only: status_complete, status_interrupted, status_not_written
   use scene_summary, only: add_head, add_results
   use scene_types, only: scene_t
   use solve_threshold, only: search_lines
   use summary_file, only: summary_t
   use table_task, only: table_task_t
   use text, only: counted, integer_text, short_text
   use threshold_ends, only: has_ends
   use threshold_outcome, only: end_counts, failed_scenes, load_outcome, outcome_t, save_outcome, share_points, solved_scenes, &
                                check_earlier_threshold, start_outcome, write_rows_of
   use word_list, only: word_t
   use, intrinsic :: omp_lib, only: omp_get_max_threads
   implicit none(type, external)
   private

   !> Scenes of a scan for each thread that are solved at a time: traces beyond them wait for those before
   integer(int64), parameter :: scanned_together = 4096_int64

   !> The thresholds of all traces, or of one part of these.
   type, extends(table_task_t), public :: threshold_task_t
      private
      type(prepared_threshold_t) :: threshold
      type(outcome_t) :: outcome
   contains
      procedure :: prepare
      procedure :: check_lines
      procedure :: open_files
      procedure :: heading
      procedure :: report_start
      procedure :: solve
      procedure :: close_files
   end type threshold_task_t

   public :: grid_scenes

contains

   subroutine prepare(self, file, hurried, faults, watcher)
      class(threshold_task_t), intent(inout) :: self
      character(*), intent(in) :: file
      logical, intent(in) :: hurried
      type(fault_list_t), intent(inout) :: faults
      class(look_watcher_t), optional, intent(inout) :: watcher

      call prepare_threshold(self%scene, file, hurried, self%threshold, faults, watcher)
      if (faults%count() == 0) self%warnings = self%threshold%traces%warnings
   end subroutine prepare

   !> How many traces and scenes, and how long the scan may take.
   function check_lines(self) result(words)
      class(threshold_task_t), intent(in) :: self
      character(:), allocatable :: words
      type(campaign_t) :: scan
      integer(int64) :: trace_count, looked_at, trace
      integer :: i, scanned

      associate (threshold => self%threshold)
         trace_count = threshold%traces%layout%scene_count
         scanned = size(threshold%scan)
         scan = threshold%traces
         looked_at = min(trace_count, max(1_int64, 512_int64/scanned))
         scan%first = 1_int64
         scan%seen = looked_at*scanned
         call points_plan(threshold, threshold%traces%first + [((trace, i=1, scanned), trace=0_int64, looked_at - 1_int64)], &
                          [((threshold%scan(i), i=1, scanned), trace=1_int64, looked_at)], scan%plan)
         scan%layout%scene_count = trace_count*scanned
         scan%layout%names = [scan%layout%names, scan%layout%names(1)]
         words = '! traces              '//integer_text(trace_count)//new_line('a')// &
                 '! scenes of the scan  '//integer_text(scan%layout%scene_count)//new_line('a')// &
                 '! a grid as fine has  '//integer_text(nint(grid_scenes(threshold), int64))//' scenes'// &
                 new_line('a')//'! core time of the scan, '//core_time_sentence(self%scene, scan)
      end associate
   end function check_lines

   !> The state of an earlier run; its result is written over once all is found.
   subroutine open_files(self, error)
      class(threshold_task_t), intent(inout) :: self
      type(error_t), allocatable, intent(out) :: error

      if (self%carry_on) call load_outcome(self%scene, self%threshold, self%outcome, error)
      if (self%carry_on .and. .not. allocated(error) .and. .not. allocated(self%outcome%rows)) &
         call check_earlier_threshold(self%scene, self%threshold, error)
      if (allocated(error)) return
      call start_outcome(self%scene, self%threshold, self%outcome)
      self%done_before = solved_scenes(self%outcome)
      ! How many more there will be is not known.
      self%scenes = self%done_before
   end subroutine open_files

   function heading(self) result(words)
      class(threshold_task_t), intent(in) :: self
      character(:), allocatable :: words

      words = 'threshold '//trim(self%scene%name)//': '//counted(int(self%threshold%traces%layout%scene_count), 'trace')// &
              ' of '//key_name(self%threshold%axis%position)
   end function heading

   !> What an earlier run has found, and what a scan does not see.
   subroutine report_start(self)
      class(threshold_task_t), intent(in) :: self

      if (self%done_before > 0_int64) then
         call self%log%item('carried on', 'after '//integer_text(self%outcome%traces)//' traces of the earlier run and '// &
                            integer_text(size(self%outcome%points))//' values of those under way')
      else if (self%carry_on) then
         call self%log%item('earlier run', 'has left no state; all is solved from the start')
      end if
      call self%log%detail('  '//integer_text(size(self%threshold%scan))//' values a trace, then halves down to '// &
                         integer_text(self%threshold%axis%count)//' places; two changes between neighbours of the scan that '// &
                         'cancel each other stay unseen: more &threshold count sees them')
      if (self%scene%spectrum%verify) call self%log%detail('  the ends of a crossing go apart again until both are verified')
      if (has_ends(self%scene, self%threshold%axis%whole)) &
         call self%log%detail('  then the motions of both sides, from '//counted(self%scene%solver%starts, 'start')// &
                            ', are followed along '//key_name(self%threshold%axis%position)//' to where they end; in a trace '// &
                            'without a crossing these starts are tried at both ends and in the middle')
   end subroutine report_start

   subroutine solve(self, error)
      class(threshold_task_t), intent(inout) :: self
      type(error_t), allocatable, intent(out) :: error
      integer(int64) :: first, last, last_trace, together
      integer :: traces_before

      call start_outcome(self%scene, self%threshold, self%outcome)
      call share_points(self%scene, self%threshold, self%outcome)
      if (this_rank() == 0 .and. .not. self%carry_on) call delete_file(state_path(self%scene))
      traces_before = int(self%outcome%traces)
      call share_number(traces_before)
      associate (scene => self%scene, threshold => self%threshold, outcome => self%outcome)
         last_trace = threshold%traces%first + threshold%traces%layout%scene_count - 1_int64
         together = max(1_int64, scanned_together*rank_count()*omp_get_max_threads()/size(threshold%scan, kind=int64))
         do first = threshold%traces%first + traces_before, last_trace, together
            last = min(last_trace, first + together - 1_int64)
            call search_lines(scene, threshold, first, last, self%progress, self%log, outcome, error)
            if (outcome%cut) exit
         end do
         if (this_rank() == 0 .and. outcome%cut) call save_outcome(scene, threshold, outcome, self%log)
      end associate
   end subroutine solve

   !> Scenes of a grid that finds brackets as narrow: every place that halving may reach, on each trace.
   pure real(dp) function grid_scenes(threshold)
      type(prepared_threshold_t), intent(in) :: threshold

      grid_scenes = real(threshold%axis%count, dp)*real(threshold%traces%layout%scene_count, dp)
   end function grid_scenes

   !> Write the files and say what became of the thresholds. What was cut short leaves no result.
   subroutine close_files(self, error)
      class(threshold_task_t), intent(inout) :: self
      type(error_t), allocatable, intent(inout) :: error
      type(error_t), allocatable :: summary_error
      type(summary_t) :: summary
      type(word_t), allocatable :: results(:)
      integer :: status
      logical :: keeps_earlier

      self%is_cut = self%outcome%cut
      self%failed = failed_scenes(self%outcome)
      call self%progress%finish(self%log)
      allocate (results(0))
      status = status_complete
      if (self%is_cut) then
         status = status_interrupted
      else if (.not. allocated(error)) then
         results = [word_t(result_path(self%scene))]
         call write_rows_of(result_path(self%scene), self%scene, self%threshold, self%outcome%rows, error)
      end if
      if (allocated(error)) status = status_not_written
      call add_counts(summary, self, results, status)
      keeps_earlier = .false.
      if (self%is_cut) keeps_earlier = path_exists(result_path(self%scene))
      ! Where an earlier run left a result, its summary stays beside it: what was cut short has its state.
      if (.not. keeps_earlier) then
         call summary%write_beside(summary_path(self%scene), summary_error)
         if (.not. allocated(error) .and. allocated(summary_error)) call move_alloc(summary_error, error)
         call place_files(results, summary_path(self%scene), error)
      end if
      if (allocated(error)) then
         call self%log%item('error', error%message)
      else if (self%is_cut) then
         call report_cut(self, keeps_earlier)
      else
         call delete_file(state_path(self%scene))
         call report_ending(self%log, self%scene, self%threshold, self%outcome)
      end if
   end subroutine close_files

   subroutine add_counts(summary, task, results, status)
      type(summary_t), intent(inout) :: summary
      class(threshold_task_t), intent(in) :: task
      !> Paths of what was written
      type(word_t), intent(in) :: results(:)
      integer, intent(in) :: status
      integer(int64) :: counts(4)

      call add_head(summary, task%scene, status)
      call add_results(summary, results, status)
      associate (scene => task%scene, outcome => task%outcome)
         call summary%add('traces', task%threshold%traces%layout%scene_count)
         call summary%add('crossings', outcome%crossings)
         call summary%add('traces_without_crossing', outcome%uncrossed)
         if (scene%spectrum%verify) call summary%add('crossings_uncertain', outcome%uncertain)
         if (scene%spectrum%verify) call summary%add('crossings_wide', outcome%wide)
         if (has_ends(scene, task%threshold%axis%whole)) then
            counts = end_counts(scene, task%threshold, outcome)
            call summary%add('crossings_followed', counts(1))
            call summary%add('crossings_either', counts(2))
            call summary%add('crossings_end_unsure', counts(3))
            call summary%add('traces_with_another_side', counts(4))
         end if
         call summary%add('scenes', solved_scenes(outcome))
         call summary%add('scenes_failed', failed_scenes(outcome))
         call summary%add('scenes_of_a_grid', grid_scenes(task%threshold))
      end associate
      call summary%add('wall_seconds', wall_seconds() - task%started)
   end subroutine add_counts

   !> How far a run came that was cut short.
   subroutine report_cut(task, keeps_earlier)
      class(threshold_task_t), intent(in) :: task
      !> Whether result and summary of an earlier run stand
      logical, intent(in) :: keeps_earlier

      call task%log%item('cut short', 'after '//integer_text(task%outcome%traces)//' of '// &
                         counted(int(task%threshold%traces%layout%scene_count), 'trace')//'; --resume goes on with these and '// &
                         counted(size(task%outcome%points), 'value')//' of the next, no result is written before')
      if (keeps_earlier) then
         call task%log%item('files', result_path(task%scene)//' and its summary are those of an earlier run')
      else
         call task%log%item('files', summary_path(task%scene)//', .state, .log')
      end if
   end subroutine report_cut

   !> What was found, and what it took.
   subroutine report_ending(log, scene, threshold, outcome)
      type(log_t), intent(in) :: log
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(outcome_t), intent(in) :: outcome
      character(:), allocatable :: line
      integer(int64) :: counts(4)

      line = integer_text(outcome%crossings)//'; '//integer_text(outcome%uncrossed)//' of '// &
             counted(threshold%traces%layout%scene_count, 'trace')//' without any'
      if (scene%spectrum%verify) line = line//'; at '//integer_text(outcome%uncertain)//' a side is not verified'
      call log%item('crossings', line)
      if (outcome%wide > 0_int64) call log%item('width', counted(outcome%wide, 'crossing')//' have ends that are verified '// &
                                                'only farther apart than requested (width)')
      counts = end_counts(scene, threshold, outcome)
      if (counts(1) > 0_int64) call log%item('either side', 'possible at '//integer_text(counts(2))//' of '// &
                                             counted(counts(1), 'crossing')//', beyond the change from rest (last_below, '// &
                                             'last_above)')
      if (counts(3) > 0_int64) call log%item('motion ends', 'unsure at '//counted(counts(3), 'crossing')// &
                                             ': no repetition, known to a bracket, or unknown '// &
                                             '(motion_end_below, _above)')
      if (counts(4) > 0_int64) call log%item('other side', 'in '//integer_text(counts(4))//' of '// &
                                             counted(outcome%uncrossed, 'trace')//' without a crossing, from other starts '// &
                                             '(last_above to last_below)')
      if (sum(counts) > 0_int64 .and. scene%solver%starts > 1) &
         call log%item('starts', integer_text(scene%solver%starts)//' do not prove that there are no other motions')
      if (outcome%failed > 0_int64) call log%item('failed', 'a side of its own: where such scenes begin is a crossing '// &
                                                  '(status_below, status_above)')
      ! Where there are more parts than traces, some have none.
      if (outcome%solved > 0_int64) &
         call log%detail('  '//integer_text(outcome%solved)//' scenes; a grid as fine has '// &
                       integer_text(nint(grid_scenes(threshold), int64))//', '// &
                       short_text(grid_scenes(threshold)/real(outcome%solved, dp), 3)//' times as many')
      call log%item('files', summary_path(scene)//', .rattle, .log')
   end subroutine report_ending

end module run_threshold
