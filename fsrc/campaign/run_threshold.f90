!> Thresholds from input to file: a scan of every line, then passes over all lines together, each the middles of all brackets
!> that are still wide, solved as the scenes of a campaign are. Some lines are searched at a time; NAME.state keeps what was found
!> of those before, for --resume.
module run_threshold
   use campaign_progress, only: campaign_progress_t
   use clock, only: wall_seconds
   use errors, only: error_t, exit_complete, exit_scene_failed, fault_list_t, raise
   use file_system, only: delete_file
   use finished_files, only: place_files
   use key_table, only: key_name
   use kinds, only: dp, int64
   use log_file, only: log_magic, log_t
   use output_lock, only: output_lock_t
   use output_place, only: claim_output_place, log_path, progress_path, result_path, state_path, summary_path
   use prepared_threshold, only: points_plan, prepare_threshold, prepared_threshold_t
   use quantities, only: quantity_certified
   use ranks, only: abort_ranks, add_over_ranks, next_ticket, rank_count, renew_tickets, share_number, sum_over_ranks, this_rank, &
                    wait_for_ranks
   use sampling, only: sample_plan_t
   use scene_report, only: law_sentence
   use scene_status, only: is_success, status_complete, status_interrupted, status_not_written
   use scene_summary, only: add_head
   use scene_types, only: scene_t
   use signals, only: caught_signal
   use solve_chunk, only: chunk_space_t, solve_scenes
   use summary_file, only: summary_t
   use text, only: counted, integer_text, short_text
   use threshold_outcome, only: add_rows, load_outcome, outcome_t, save_outcome, start_outcome, write_rows_of
   use threshold_search, only: bracket_t, brackets_of_scan, halved, is_wide, middle, new_point, point_t
   use version, only: program_version
   use word_list, only: word_t
   use, intrinsic :: omp_lib, only: omp_get_max_threads, omp_get_thread_num
   implicit none(type, external)
   private

   !> Scenes of a scan for each thread that are solved at a time: lines beyond them wait for those before
   integer(int64), parameter :: scanned_together = 4096_int64
   !> How old the state may become [s]
   real(dp), parameter :: state_interval = 10.0_dp
   !> Scenes that a thread takes at a time: fewer leave lanes empty, more leave the other threads nothing
   integer, parameter :: fewest_taken = 32, most_taken = 512

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
      integer(int64) :: first, last, last_line, together
      real(dp) :: saved
      integer :: lines_before

      started = wall_seconds()
      call prepare_threshold(scene, file, .false., threshold, faults)
      exit_code = faults%exit_code
      if (this_rank() == 0) then
         call claim_output_place(scene, file, lock, faults, error)
         if (faults%count() == 0 .and. .not. allocated(error) .and. carry_on) call load_outcome(scene, threshold, outcome, error)
         if (faults%count() == 0 .and. .not. allocated(error)) call log%open(log_path(scene), quiet, error)
         exit_code = merge(faults%exit_code, exit_complete, faults%count() > 0)
         if (allocated(error)) exit_code = error%exit_code
         if (caught_signal() /= 0) exit_code = 128 + caught_signal()
      end if
      call share_number(exit_code)
      if (exit_code /= exit_complete) then
         call lock%release()
         return
      end if
      ! Memory may lack on the machine of this rank alone.
      if (faults%count() > 0) then
         call raise(error, faults%exit_code, faults%sentence(1))
         call abort_ranks(error)
         return
      end if
      if (this_rank() == 0) call report_start(log, scene, threshold, carry_on, outcome%lines)
      if (this_rank() == 0 .and. .not. carry_on) call delete_file(state_path(scene))
      lines_before = int(outcome%lines)
      call share_number(lines_before)
      last_line = threshold%lines%first + threshold%lines%layout%scene_count - 1_int64
      call progress%start(progress_path(scene), outcome%solved, outcome%solved, quiet)
      call start_outcome(scene, threshold, outcome)
      together = max(1_int64, scanned_together*rank_count()*omp_get_max_threads()/size(threshold%scan, kind=int64))
      saved = started
      do first = threshold%lines%first + lines_before, last_line, together
         last = min(last_line, first + together - 1_int64)
         call search_lines(scene, threshold, first, last, progress, log, outcome)
         if (outcome%cut) exit
         outcome%lines = last - threshold%lines%first + 1_int64
         if (this_rank() > 0 .or. last == last_line) cycle
         if (wall_seconds() - saved < state_interval) cycle
         call save_outcome(scene, threshold, outcome, log)
         saved = wall_seconds()
      end do
      if (this_rank() == 0 .and. outcome%cut) call save_outcome(scene, threshold, outcome, log)
      progress%done = sum_over_ranks(progress%done)
      progress%failed = sum_over_ranks(progress%failed)
      if (this_rank() == 0) call close_threshold(scene, threshold, started, progress, log, outcome, exit_code, error)
      call lock%release()
      call share_number(exit_code)
   end subroutine run_one_threshold

   !> What will be done.
   subroutine report_start(log, scene, threshold, carry_on, lines_before)
      type(log_t), intent(in) :: log
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      logical, intent(in) :: carry_on
      !> Lines that an earlier run has searched
      integer(int64), intent(in) :: lines_before
      integer :: i

      call log%line(log_magic//program_version//', threshold '//trim(scene%name)//': '// &
                    counted(int(threshold%lines%layout%scene_count), 'line')//' of '//key_name(threshold%axis%position)//', '// &
                    law_sentence(scene)//'; '//counted(rank_count(), 'rank')//' of '//counted(omp_get_max_threads(), 'thread'))
      do i = 1, size(scene%warnings)
         call log%line('  '//scene%warnings(i)%text)
      end do
      do i = 1, size(threshold%lines%warnings)
         call log%line('  '//threshold%lines%warnings(i)%text)
      end do
      if (lines_before > 0_int64) then
         call log%line('  carried on after '//integer_text(lines_before)//' lines of the earlier run')
      else if (carry_on) then
         call log%line('  there is no state of an earlier run; all is solved from the start')
      end if
      call log%line('  '//integer_text(size(threshold%scan))//' values a line, then halves down to '// &
                    integer_text(threshold%axis%count)//' places; two changes between neighbours of the scan that cancel each '// &
                    'other stay unseen: more &threshold count sees them')
   end subroutine report_start

   !> All thresholds of some lines; all ranks find the same.
   subroutine search_lines(scene, threshold, first, last, progress, log, outcome)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      !> First and last line
      integer(int64), intent(in) :: first
      integer(int64), intent(in) :: last
      type(campaign_progress_t), intent(inout) :: progress
      type(log_t), intent(in) :: log
      type(outcome_t), intent(inout) :: outcome
      type(bracket_t), allocatable :: brackets(:), wide(:)
      type(point_t), allocatable :: points(:), ends(:, :)
      real(dp), allocatable :: certified(:), both(:, :)
      integer(int64) :: line
      integer :: i, scanned

      scanned = size(threshold%scan)
      call solve_points(scene, threshold, [((line, i=1, scanned), line=first, last)], &
                        [((threshold%scan(i), i=1, scanned), line=first, last)], progress, log, outcome, points, certified)
      if (outcome%cut) return
      allocate (ends(2, last - first + 1_int64), brackets(0))
      do line = 1_int64, last - first + 1_int64
         associate (scan => points((line - 1_int64)*scanned + 1_int64:line*scanned))
            brackets = [brackets, brackets_of_scan(first + line - 1_int64, scan)]
            ends(:, line) = scan([1, scanned])
         end associate
      end do
      do
         wide = pack(brackets, is_wide(brackets))
         if (size(wide) == 0) exit
         call solve_points(scene, threshold, wide%line, middle(wide), progress, log, outcome, points, certified)
         if (outcome%cut) return
         brackets = halved(brackets, points)
      end do
      if (scene%spectrum%certify) then
         call solve_points(certifying(scene), threshold, [brackets%line, brackets%line], &
                           [brackets%lower%place, brackets%upper%place], progress, log, outcome, points, certified)
         if (outcome%cut) return
      end if
      allocate (both(size(brackets), 2), source=0.0_dp)
      if (scene%spectrum%certify) both = reshape(certified, [size(brackets), 2])
      call add_rows(threshold, first, ends, brackets, both, outcome)
   end subroutine search_lines

   !> The scene with the certificate of its class on record.
   pure type(scene_t) function certifying(scene)
      type(scene_t), intent(in) :: scene

      certifying = scene
      certifying%campaign%record = [scene%threshold%quantity, quantity_certified]
   end function certifying

   !> Solve scenes at some places of some lines, on the threads of all ranks. What is found does not depend on their number.
   subroutine solve_points(scene, threshold, lines, places, progress, log, outcome, points, certified)
      !> With what is to be recorded: the quantity, and `certified` or nothing behind it
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      !> Line of each scene, and its place there
      integer(int64), intent(in) :: lines(:)
      integer, intent(in) :: places(:)
      type(campaign_progress_t), intent(inout) :: progress
      type(log_t), intent(in) :: log
      type(outcome_t), intent(inout) :: outcome
      !> What was found; empty where the work was cut
      type(point_t), allocatable, intent(out) :: points(:)
      !> Whether each class is certified: 1, 0, NaN: there is none; empty if that is not recorded
      real(dp), allocatable, intent(out) :: certified(:)
      type(sample_plan_t) :: plan
      type(chunk_space_t) :: space
      real(dp), allocatable :: rows(:, :), part(:, :)
      integer(int64) :: ticket, first, last, taken
      integer :: i, status

      allocate (points(0), certified(0))
      if (size(lines) == 0) return
      call points_plan(threshold, lines, places, plan)
      status = 2 + size(plan%positions)
      allocate (rows(status + size(scene%campaign%record), size(lines)), source=0.0_dp)
      taken = (plan%size - 1_int64)/(2_int64*rank_count()*omp_get_max_threads()) + 1_int64
      taken = max(int(fewest_taken, int64), min(int(most_taken, int64), taken))
      progress%scenes = progress%scenes + plan%size
      call renew_tickets()
      !$omp parallel default(shared) private(ticket, first, last, part, space)
      do
         if (caught_signal() /= 0) exit
         ticket = next_ticket()
         first = (ticket - 1_int64)*taken + 1_int64
         if (first > plan%size) exit
         last = min(plan%size, first + taken - 1_int64)
         allocate (part(size(rows, 1), last - first + 1_int64))
         call solve_scenes(scene, plan, first, space, part)
         if (caught_signal() /= 0) exit
         rows(:, first:last) = part
         call progress%add(last - first + 1_int64, count(.not. is_success(nint(part(status, :))), kind=int64), &
                            0_int64, 0_int64, 0_int64, 0_int64)
         deallocate (part)
         if (this_rank() == 0) then
            if (omp_get_thread_num() == 0) call progress%tell(log)
         end if
      end do
      !$omp end parallel
      call wait_for_ranks()
      outcome%cut = sum_over_ranks(int(merge(1, 0, caught_signal() /= 0), int64)) > 0_int64
      if (outcome%cut) return
      call add_over_ranks(rows)
      outcome%solved = outcome%solved + plan%size
      outcome%failed = outcome%failed + count(.not. is_success(nint(rows(status, :))), kind=int64)
      points = [(new_point(scene%threshold, places(i), nint(rows(status, i)), rows(status + 1, i)), i=1, size(places))]
      if (size(scene%campaign%record) > 1) certified = rows(status + 2, :)
   end subroutine solve_points

   !> Scenes of a grid that finds brackets as narrow.
   pure real(dp) function grid_scenes(scene, threshold)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold

      grid_scenes = real(threshold%axis%count, dp)
      if (.not. threshold%axis%whole) grid_scenes = max(real(scene%threshold%count, dp), 1.0_dp/scene%threshold%tolerance + 1.0_dp)
      grid_scenes = grid_scenes*real(threshold%lines%layout%scene_count, dp)
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
      call summary%add('lines', threshold%lines%layout%scene_count)
      call summary%add('crossings', outcome%crossings)
      call summary%add('lines_without_crossing', outcome%uncrossed)
      if (scene%spectrum%certify) call summary%add('crossings_uncertain', outcome%uncertain)
      call summary%add('scenes', outcome%solved)
      call summary%add('scenes_failed', outcome%failed)
      call summary%add('scenes_of_a_grid', grid_scenes(scene, threshold))
      call summary%add('wall_seconds', wall_seconds() - started)
      call summary%write_beside(summary_path(scene), summary_error)
      if (.not. allocated(error) .and. allocated(summary_error)) call move_alloc(summary_error, error)
      call place_files(results, summary_path(scene), error)
      if (allocated(error)) then
         call log%line('  '//error%message)
      else if (outcome%cut) then
         call log%line('  cut short after '//integer_text(outcome%lines)//' of '// &
                       counted(int(threshold%lines%layout%scene_count), 'line')//'; --resume goes on, no result is written before')
         call log%line('  '//summary_path(scene))
      else
         call delete_file(state_path(scene))
         call report_ending(log, scene, threshold, outcome, outcome%failed)
      end if
      call log%close()
      exit_code = exit_complete
      if (outcome%failed > 0_int64) exit_code = exit_scene_failed
      if (outcome%cut) exit_code = 128 + caught_signal()
      if (allocated(error)) exit_code = error%exit_code
   end subroutine close_threshold

   !> What was found, and what it took.
   subroutine report_ending(log, scene, threshold, outcome, failed)
      type(log_t), intent(in) :: log
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(outcome_t), intent(in) :: outcome
      !> Scenes that failed
      integer(int64), intent(in) :: failed
      character(:), allocatable :: line

      line = '  '//integer_text(outcome%crossings)//' crossings; '//integer_text(outcome%uncrossed)//' of '// &
             integer_text(threshold%lines%layout%scene_count)//' lines have none'
      if (scene%spectrum%certify) line = line//'; at '//integer_text(outcome%uncertain)// &
                                         ' crossings a class beside it is not certified'
      call log%line(line)
      if (failed > 0_int64) call log%line('  scenes that failed are a kind of their own: where they begin is a crossing '// &
                                          '(columns status_below, status_above)')
      ! Where there are more parts than lines, some have none.
      if (outcome%solved > 0_int64) &
         call log%line('  '//integer_text(outcome%solved)//' scenes; a grid as fine has '// &
                       integer_text(nint(grid_scenes(scene, threshold), int64))//', '// &
                       short_text(grid_scenes(scene, threshold)/real(outcome%solved, dp), 3)//' times as many')
      call log%line('  '//result_path(scene))
      call log%line('  '//summary_path(scene))
   end subroutine report_ending

end module run_threshold
