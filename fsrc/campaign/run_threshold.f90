!> Thresholds from input to file: a scan of every line, then passes over all lines together, each the middles of all brackets
!> that are still wide, solved as the scenes of a campaign are. Some lines are searched at a time; NAME.state keeps what was found
!> of those before, for --resume.
module run_threshold
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_quiet_nan, ieee_value
   use campaign_axis, only: grid_value
   use campaign_progress, only: campaign_progress_t
   use clock, only: wall_seconds
   use byte_file, only: put_in_place
   use errors, only: error_t, exit_bad_input, exit_complete, exit_scene_failed, fault_list_t, raise
   use file_system, only: delete_file, file_state_t, state_of_path
   use finished_files, only: place_files
   use key_table, only: key_name, keys
   use kinds, only: dp, int64
   use log_file, only: log_magic, log_t
   use output_lock, only: output_lock_t
   use output_place, only: claim_output_place, log_path, progress_path, result_path, state_path, summary_path
   use prepared_threshold, only: points_plan, prepare_threshold, prepared_threshold_t
   use quantities, only: quantity_certified, quantity_table
   use ranks, only: abort_ranks, add_over_ranks, next_ticket, rank_count, renew_tickets, share_number, sum_over_ranks, this_rank, &
                    wait_for_ranks
   use result_reader, only: result_reader_t
   use resume, only: open_earlier
   use result_format, only: column_name_bytes, column_unit_bytes
   use result_writer, only: result_writer_t
   use sampling, only: sample_plan_t, scene_values
   use scene_report, only: law_sentence
   use scene_status, only: is_success, status_complete, status_interrupted, status_not_written
   use scene_summary, only: add_head
   use scene_types, only: scene_t
   use signals, only: caught_signal
   use solve_chunk, only: chunk_space_t, solve_scenes
   use summary_file, only: summary_t
   use text, only: counted, integer_text, short_text
   use threshold_search, only: bracket_t, brackets_of_scan, halved, is_wide, middle, new_point, point_t
   use varied_keys, only: varied_name
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

   !> Numbers in the first row of a state
   integer, parameter :: counted_numbers = 8

   !> What became of the thresholds so far.
   type :: outcome_t
      !> Rows of the result, one column of this array each
      real(dp), allocatable :: rows(:, :)
      !> Lines that are done
      integer(int64) :: lines = 0_int64
      integer(int64) :: solved = 0_int64, failed = 0_int64, crossings = 0_int64, uncrossed = 0_int64, uncertain = 0_int64
      !> Whether a signal asked to stop
      logical :: cut = .false.
   end type outcome_t

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
      integer(int64) :: first, last, line_count, together
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
      line_count = threshold%lines%layout%scene_count
      call progress%start(progress_path(scene), outcome%solved, outcome%solved, quiet)
      if (.not. allocated(outcome%rows)) allocate (outcome%rows(size(column_names(scene, threshold)), 0))
      together = max(1_int64, scanned_together*rank_count()*omp_get_max_threads()/size(threshold%scan, kind=int64))
      saved = started
      do first = lines_before + 1_int64, line_count, together
         last = min(line_count, first + together - 1_int64)
         call search_lines(scene, threshold, first, last, progress, log, outcome)
         if (outcome%cut) exit
         outcome%lines = last
         if (this_rank() > 0 .or. last == line_count) cycle
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

   !> Names of the columns.
   pure function column_names(scene, threshold) result(names)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      character(column_name_bytes), allocatable :: names(:)
      character(column_name_bytes), parameter :: sides(2) = [character(column_name_bytes) :: 'certified_below', 'certified_above']
      character(column_name_bytes) :: axes(size(threshold%lines%plan%positions))
      character(:), allocatable :: quantity
      integer :: i

      do i = 1, size(axes)
         axes(i) = varied_name(threshold%lines%plan%positions(i))
      end do
      quantity = trim(quantity_table(scene%threshold%quantity)%name)
      names = [character(column_name_bytes) :: 'line', axes, 'crossing', 'lower', 'upper', quantity//'_below', quantity//'_above', &
               'status_below', 'status_above']
      if (scene%spectrum%certify) names = [names, sides]
   end function column_names

   !> Units of the columns.
   pure function column_units(scene, threshold) result(units)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      character(column_unit_bytes), allocatable :: units(:)
      integer :: i

      associate (key => keys(threshold%axis%position)%unit, quantity => quantity_table(scene%threshold%quantity)%unit)
         units = [character(column_unit_bytes) :: '-', keys(threshold%lines%plan%positions)%unit, '-', key, key, quantity, quantity]
         where (units == '') units = '-'
         units = [units, [(units(1), i=1, merge(4, 2, scene%spectrum%certify))]]
      end associate
   end function column_units

   !> Rows of some lines: one for each bracket, and one for a line that has none, from end to end of its range.
   subroutine add_rows(threshold, first, ends, brackets, certified, outcome)
      type(prepared_threshold_t), intent(in) :: threshold
      !> First of the lines
      integer(int64), intent(in) :: first
      !> First and last point of each line
      type(point_t), intent(in) :: ends(:, :)
      !> By rising lines and places
      type(bracket_t), intent(in) :: brackets(:)
      !> Of both ends of each bracket; of no use where that is not recorded
      real(dp), intent(in) :: certified(:, :)
      type(outcome_t), intent(inout) :: outcome
      real(dp), allocatable :: rows(:, :)
      real(dp) :: unknown
      integer(int64) :: line
      integer :: i, k, crossing

      unknown = ieee_value(0.0_dp, ieee_quiet_nan)
      allocate (rows(size(outcome%rows, 1), size(brackets) + size(ends, 2)))
      i = 0
      k = 0
      do line = first, first + size(ends, 2, kind=int64) - 1_int64
         crossing = 0
         do while (is_of_line(i + 1))
            i = i + 1
            crossing = crossing + 1
            call put(brackets(i)%lower, brackets(i)%upper)
         end do
         if (crossing == 0) call put(ends(1, line - first + 1_int64), ends(2, line - first + 1_int64))
         if (crossing == 0) outcome%uncrossed = outcome%uncrossed + 1_int64
      end do
      outcome%crossings = outcome%crossings + size(brackets, kind=int64)
      outcome%rows = reshape([outcome%rows, rows(:, :k)], [size(rows, 1), size(outcome%rows, 2) + k])

   contains

      pure logical function is_of_line(place)
         integer, intent(in) :: place

         is_of_line = place <= size(brackets)
         if (is_of_line) is_of_line = brackets(place)%line == line
      end function is_of_line

      subroutine put(lower, upper)
         type(point_t), intent(in) :: lower
         type(point_t), intent(in) :: upper
         logical :: stands
         integer :: axes

         k = k + 1
         axes = size(threshold%lines%plan%positions)
         rows(1, k) = real(line, dp)
         call scene_values(threshold%lines%plan, line, rows(2:1 + axes, k))
         rows(axes + 2:axes + 8, k) = [real(crossing, dp), grid_value(threshold%axis, lower%place), &
                                       grid_value(threshold%axis, upper%place), lower%quantity, upper%quantity, &
                                       real(lower%status, dp), real(upper%status, dp)]
         if (size(rows, 1) == axes + 8) return
         rows(axes + 9:axes + 10, k) = unknown
         if (crossing == 0) return
         rows(axes + 9:axes + 10, k) = certified(i, :)
         stands = .not. any(ieee_is_nan(certified(i, :)))
         if (stands) stands = all(certified(i, :) > 0.0_dp)
         if (.not. stands) outcome%uncertain = outcome%uncertain + 1_int64
      end subroutine put

   end subroutine add_rows

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

   !> Counts of an outcome, and the table of lines that it is of, as a row of the state.
   pure function counts_of(threshold, outcome) result(counts)
      type(prepared_threshold_t), intent(in) :: threshold
      type(outcome_t), intent(in) :: outcome
      real(dp) :: counts(counted_numbers)

      associate (table => threshold%lines%layout%source_checksum)
         counts = real([outcome%lines, outcome%solved, outcome%failed, outcome%crossings, outcome%uncrossed, outcome%uncertain, &
                        shiftr(table, 32), ibits(table, 0, 32)], dp)
      end associate
   end function counts_of

   !> Keep the outcome as NAME.state. Trouble with it ends nothing: only a run that is killed needs it.
   subroutine save_outcome(scene, threshold, outcome, log)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(outcome_t), intent(in) :: outcome
      type(log_t), intent(in) :: log
      type(error_t), allocatable :: error
      real(dp) :: counts(size(outcome%rows, 1), 1)

      counts = 0.0_dp
      counts(:counted_numbers, 1) = counts_of(threshold, outcome)
      call write_rows_of(state_path(scene), scene, threshold, reshape([counts, outcome%rows], &
                                                              [size(counts), size(outcome%rows, 2) + 1]), error)
      if (.not. allocated(error)) call put_in_place(state_path(scene), error)
      if (allocated(error)) call log%line('  warning: '//error%message)
   end subroutine save_outcome

   !> Read the outcome that an earlier run has kept; without one there is none.
   subroutine load_outcome(scene, threshold, outcome, error)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(outcome_t), intent(inout) :: outcome
      !> Set if the state is damaged, or belongs to another scene or version
      type(error_t), allocatable, intent(out) :: error
      character(*), parameter :: free_keys(0) = [character(1) ::]
      type(result_reader_t) :: reader
      type(file_state_t) :: kept
      real(dp), allocatable :: rows(:, :)
      real(dp) :: counts(counted_numbers)

      kept = state_of_path(state_path(scene))
      if (kept%bytes == 0_int64) return
      call open_earlier(scene, state_path(scene), free_keys, reader, error)
      if (.not. allocated(error)) call reader%verify_rows(reader%row_count, error)
      if (.not. allocated(error)) then
         allocate (rows(reader%columns, reader%row_count))
         call reader%read_rows(1_int64, rows, error)
      end if
      call reader%close()
      if (allocated(error)) return
      counts = counts_of(threshold, outcome)
      if (any(nint(rows(counted_numbers - 1:counted_numbers, 1), int64) /= nint(counts(counted_numbers - 1:), int64))) then
         call raise(error, exit_bad_input, state_path(scene)//' belongs to other lines: their CSV file has changed since')
         return
      end if
      associate (numbers => nint(rows(:counted_numbers, 1), int64))
         outcome%lines = numbers(1)
         outcome%solved = numbers(2)
         outcome%failed = numbers(3)
         outcome%crossings = numbers(4)
         outcome%uncrossed = numbers(5)
         outcome%uncertain = numbers(6)
      end associate
      outcome%rows = rows(:, 2:)
   end subroutine load_outcome

   !> Write rows to a file beside its place.
   subroutine write_rows_of(path, scene, threshold, rows, error)
      character(*), intent(in) :: path
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      real(dp), intent(in) :: rows(:, :)
      type(error_t), allocatable, intent(out) :: error
      type(result_writer_t) :: writer
      type(error_t), allocatable :: close_error

      call writer%open(path, scene%resolved_input, column_names(scene, threshold), column_units(scene, threshold), &
                       size(rows, 2, kind=int64), .false., error)
      if (.not. allocated(error)) call writer%write_rows(rows, error)
      call writer%close(close_error)
      if (.not. allocated(error) .and. allocated(close_error)) call move_alloc(close_error, error)
   end subroutine write_rows_of

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
      call log%line('  '//integer_text(outcome%solved)//' scenes; a grid as fine has '// &
                    integer_text(nint(grid_scenes(scene, threshold), int64))//', '// &
                    short_text(grid_scenes(scene, threshold)/real(outcome%solved, dp), 3)//' times as many')
      call log%line('  '//result_path(scene))
      call log%line('  '//summary_path(scene))
   end subroutine report_ending

end module run_threshold
