!> A campaign from input to file: plan, chunks to threads and ranks, rows in the order of the scenes.
module run_campaign
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use campaign_file, only: campaign_file_t
   use campaign_progress, only: campaign_progress_t
   use clock, only: wall_seconds
   use earlier_files, only: check_lone_summary
   use errors, only: error_t, exit_complete, exit_scene_failed, exit_system, fault_list_t, raise
   use finished_files, only: bring_back, drop_aside, set_aside
   use file_system, only: file_state_t, path_exists, state_of_path
   use kinds, only: dp, int64
   use log_file, only: log_magic, log_t
   use output_lock, only: expect_own_lock, output_lock_t
   use output_place, only: claim_output_place, log_path, progress_path, result_path, stem, summary_path
   use prepared_campaign, only: campaign_t, prepare_campaign
   use rattle_class, only: class_irregular_so_far
   use ranks, only: abort_ranks, next_tickets, rank_count, share_number, sum_over_ranks, this_rank, wait_for_ranks
   use scene_report, only: law_sentence
   use scene_summary, only: add_notes, add_results
   use scene_status, only: is_success, status_complete, status_interrupted, status_name, status_not_written
   use scene_types, only: scene_t
   use schedule, only: pace_t
   use signals, only: caught_signal
   use solve_chunk, only: chunk_space_t, solve_scenes
   use summary_file, only: summary_t
   use text, only: counted, integer_text, short_text
   use version, only: program_version
   use word_list, only: word_t
   use, intrinsic :: omp_lib, only: omp_get_max_threads
   implicit none(type, external)
   private

   public :: run_one_campaign

contains

   !> Run a campaign and write its files. All ranks call this.
   subroutine run_one_campaign(scene, file, carry_on, quiet, faults, exit_code, error)
      !> Checked base scene
      type(scene_t), intent(in) :: scene
      !> Its input, for the faults
      character(*), intent(in) :: file
      !> Go on with the file of an earlier run, if there is one
      logical, intent(in) :: carry_on
      !> Nothing to the terminal
      logical, intent(in) :: quiet
      !> Faults of the input are appended; nothing has run then
      type(fault_list_t), intent(inout) :: faults
      !> Exit code of the program
      integer, intent(out) :: exit_code
      !> Set if files could not be written
      type(error_t), allocatable, intent(out) :: error
      type(campaign_t) :: campaign
      type(campaign_file_t) :: results
      type(campaign_progress_t) :: progress
      type(log_t) :: log
      type(output_lock_t) :: lock
      type(error_t), allocatable :: close_error
      type(word_t), allocatable :: warnings(:), summaries(:)
      integer(int64) :: spoilt
      integer :: i
      real(dp) :: started
      type(file_state_t) :: earlier

      started = wall_seconds()
      call prepare_campaign(scene, file, .false., campaign, faults)
      exit_code = faults%exit_code
      spoilt = 0_int64
      if (this_rank() == 0) then
         call claim_output_place(scene, file, lock, faults, error)
         if (caught_signal() /= 0) then
            ! The look at the scenes was cut short: there may be faults that are not known.
            exit_code = 128 + caught_signal()
         else if (allocated(error)) then
            exit_code = error%exit_code
         else if (faults%count() == 0) then
            earlier = state_of_path(result_path(scene))
            if (carry_on) call check_lone_summary(scene, error)
            summaries = [word_t(summary_path(scene))]
            if (.not. allocated(error)) call set_aside(summaries)
            if (allocated(error)) then
               continue
            else if (carry_on .and. earlier%bytes > 0_int64) then
               call results%resume(result_path(scene), campaign%layout, spoilt, error)
            else
               call results%create(result_path(scene), campaign%layout, scene%output%overwrite .and. .not. carry_on, error)
            end if
            if (allocated(error)) call bring_back(summaries)
            call drop_aside(summaries)
            if (.not. allocated(error)) call log%open(log_path(scene), quiet, error)
            exit_code = exit_complete
            if (allocated(error)) exit_code = error%exit_code
         end if
      end if
      call share_number(exit_code)
      if (exit_code /= exit_complete) then
         call lock%release(.true.)
         return
      end if
      ! Memory may lack on the machine of this rank alone.
      if (faults%count() > 0) then
         call raise(error, faults%exit_code, faults%sentence(1))
      else if (this_rank() > 0) then
         call results%join(result_path(scene), campaign%layout, error)
      end if
      if (allocated(error)) then
         call abort_ranks(error)
         return
      end if
      call wait_for_ranks()

      if (this_rank() == 0) then
         call log%line(log_magic//program_version//', campaign '//trim(scene%name)//': '// &
                       integer_text(campaign%layout%scene_count)// &
                       ' scenes, '//law_sentence(scene)//'; '//counted(rank_count(), 'rank')//' of '// &
                       counted(omp_get_max_threads(), 'thread'))
         warnings = [scene%warnings, campaign%warnings]
         do i = 1, size(warnings)
            call log%line('  '//warnings(i)%text)
         end do
         if (spoilt > 0) call log%line('  '//integer_text(spoilt)//' chunks of the earlier run were damaged; they are solved again')
         if (len(lock%warning) > 0) call log%line('  '//lock%warning)
      end if
      call progress%start(progress_path(scene), campaign%layout%scene_count, done_scenes(results), quiet)
      call solve_chunks(scene, campaign, results, progress, log, error)
      if (allocated(error)) call abort_ranks(error)
      call wait_for_ranks()
      progress%done = sum_over_ranks(progress%done)
      progress%failed = sum_over_ranks(progress%failed)
      progress%beyond_model = sum_over_ranks(progress%beyond_model)
      progress%undersampled = sum_over_ranks(progress%undersampled)
      progress%tested = sum_over_ranks(progress%tested)
      progress%uncertain = sum_over_ranks(progress%uncertain)
      progress%irregular_so_far = sum_over_ranks(progress%irregular_so_far)
      if (this_rank() == 0) then
         call close_campaign(scene, campaign, started, results, progress, log, allocated(error), exit_code, close_error)
         if (allocated(error)) exit_code = error%exit_code
         if (.not. allocated(error) .and. allocated(close_error)) call move_alloc(close_error, error)
      end if
      call lock%release(allocated(error))
      call share_number(exit_code)
   end subroutine run_one_campaign

   !> Chunks until none is left, or a signal asks to stop: a thread takes as many at a time as a few seconds of work are.
   subroutine solve_chunks(scene, campaign, results, progress, log, error)
      type(scene_t), intent(in) :: scene
      type(campaign_t), intent(in) :: campaign
      type(campaign_file_t), intent(inout) :: results
      type(campaign_progress_t), intent(inout) :: progress
      type(log_t), intent(in) :: log
      type(error_t), allocatable, intent(out) :: error
      type(error_t), allocatable :: own_error
      integer(int64), allocatable :: pending(:)
      type(chunk_space_t) :: space
      type(pace_t) :: pace
      integer(int64) :: ticket, last_ticket, taken, left, chunk, chunk_rows, ignored, scenes
      real(dp) :: started
      logical :: failed

      failed = .false.
      pending = pack([(chunk, chunk=1_int64, results%chunk_count())],.not. results%done_flags())
      left = size(pending, kind=int64)
      ! A file of an earlier version may have longer chunks.
      call results%chunk_bounds(1_int64, ignored, chunk_rows)
      chunk_rows = max(1_int64, chunk_rows)
      !$omp parallel default(shared) private(ticket, last_ticket, taken, scenes, space, pace, started, own_error)
      pace = pace_t()
      do
         started = wall_seconds()
         if (caught_signal() /= 0 .or. failed) exit
         !$omp atomic read
         taken = left
         taken = (pace%next_share(taken*chunk_rows, rank_count()*omp_get_max_threads()) - 1_int64)/chunk_rows + 1_int64
         ticket = next_tickets(taken)
         if (ticket > size(pending, kind=int64)) exit
         last_ticket = min(size(pending, kind=int64), ticket + taken - 1_int64)
         !$omp atomic write
         left = size(pending, kind=int64) - last_ticket
         call solve_some(scene, campaign, pending(ticket:last_ticket), results, space, progress, scenes, own_error)
         if (caught_signal() /= 0) exit
         call pace%note(int(scenes), wall_seconds() - started)
         if (allocated(own_error)) then
            !$omp critical (campaign_error)
            failed = .true.
            if (.not. allocated(error)) call move_alloc(own_error, error)
            !$omp end critical (campaign_error)
         end if
         if (this_rank() == 0) call tell_progress(results, progress, log)
      end do
      !$omp end parallel
   end subroutine solve_chunks

   !> Tell the progress, if it is time to.
   subroutine tell_progress(results, progress, log)
      type(campaign_file_t), intent(in) :: results
      type(campaign_progress_t), intent(inout) :: progress
      type(log_t), intent(in) :: log

      if (.not. progress%is_due()) return
      if (rank_count() > 1) then
         call progress%tell(log, results%scenes_done())
      else
         call progress%tell(log)
      end if
   end subroutine tell_progress

   !> Solve and write some chunks, those that follow each other side by side. What was stopped is not written: its scenes are solved
   !> again when the run is carried on.
   subroutine solve_some(scene, campaign, chunks, results, space, progress, scenes, error)
      type(scene_t), intent(in) :: scene
      type(campaign_t), intent(in) :: campaign
      !> By rising numbers
      integer(int64), intent(in) :: chunks(:)
      type(campaign_file_t), intent(inout) :: results
      !> Work space of this thread
      type(chunk_space_t), intent(inout) :: space
      type(campaign_progress_t), intent(inout) :: progress
      !> How many scenes were solved
      integer(int64), intent(out) :: scenes
      !> Set if chunks could not be written
      type(error_t), allocatable, intent(out) :: error
      real(dp), allocatable :: rows(:, :)
      integer(int64) :: first_row, last_row, ignored
      integer :: first, last, status_column

      status_column = 2 + size(campaign%plan%positions)
      scenes = 0_int64
      last = 0
      do while (last < size(chunks))
         first = last + 1
         last = first
         do while (last < size(chunks))
            if (chunks(last + 1) /= chunks(last) + 1_int64) exit
            last = last + 1
         end do
         call results%chunk_bounds(chunks(first), first_row, ignored)
         call results%chunk_bounds(chunks(last), ignored, last_row)
         allocate (rows(size(campaign%layout%names), last_row - first_row + 1_int64))
         call solve_scenes(scene, campaign%plan, campaign%first + first_row - 1_int64, space, rows)
         if (caught_signal() /= 0) return
         call results%write_chunks(chunks(first), rows, error)
         if (allocated(error)) return
         call progress%add(last_row - first_row + 1_int64, &
                           count(.not. is_success(nint(rows(status_column, :))), kind=int64), &
                           flagged(campaign%layout%names == 'model_limit', rows, 1.0_dp), &
                           flagged(campaign%layout%names == 'sampling_sufficient', -rows, 0.0_dp), &
                           flagged(campaign%layout%names == 'verified', rows, 0.0_dp), &
                           flagged(campaign%layout%names == 'verified', -rows, 0.0_dp), &
                           flagged(campaign%layout%names == 'rattle_class', rows, real(class_irregular_so_far, dp)))
         scenes = scenes + last_row - first_row + 1_int64
         deallocate (rows)
      end do
   end subroutine solve_some

   !> Rows in which a column is not below a limit, 0 where it is not recorded. What is unknown, NaN, counts as below.
   pure integer(int64) function flagged(is_column, rows, limit)
      !> Whether a column is the one
      logical, intent(in) :: is_column(:)
      !> One column of this array is the row of a scene
      real(dp), intent(in) :: rows(:, :)
      real(dp), intent(in) :: limit
      integer :: column, row

      flagged = 0_int64
      column = findloc(is_column, .true., dim=1)
      if (column == 0) return
      do row = 1, size(rows, 2)
         if (ieee_is_nan(rows(column, row))) cycle
         if (rows(column, row) >= limit) flagged = flagged + 1_int64
      end do
   end function flagged

   !> Close the file and say what became of the campaign.
   subroutine close_campaign(scene, campaign, started, results, progress, log, not_written, exit_code, error)
      type(scene_t), intent(in) :: scene
      type(campaign_t), intent(in) :: campaign
      real(dp), intent(in) :: started
      type(campaign_file_t), intent(inout) :: results
      type(campaign_progress_t), intent(inout) :: progress
      type(log_t), intent(inout) :: log
      !> Whether chunks could not be written
      logical, intent(in) :: not_written
      integer, intent(out) :: exit_code
      type(error_t), allocatable, intent(out) :: error
      type(summary_t) :: summary
      type(error_t), allocatable :: overtaken, summary_error
      integer :: status
      logical :: finished, stands

      call results%close(finished, error)
      call expect_own_lock(stem(scene), overtaken)
      status = merge(status_complete, status_interrupted, finished)
      if (allocated(error) .or. not_written) status = status_not_written
      call progress%finish(log)
      call summary%add('name', trim(scene%name))
      call summary%add('program_version', program_version)
      call summary%add('status', status_name(status))
      call add_notes(summary, scene, [scene%warnings, campaign%warnings])
      call add_results(summary, [word_t(result_path(scene))], status)
      call summary%add('scenes', campaign%layout%scene_count)
      call summary%add('scenes_done', progress%done_before + progress%done)
      call summary%add('scenes_invalid', campaign%invalid)
      call summary%add('scenes_failed_in_this_run', progress%failed)
      call summary%add('scenes_beyond_model_in_this_run', progress%beyond_model)
      call summary%add('scenes_undersampled_in_this_run', progress%undersampled)
      if (any(campaign%layout%names == 'verified')) &
         call summary%add('scenes_not_verified_in_this_run', progress%uncertain)
      if (any(campaign%layout%names == 'rattle_class')) &
         call summary%add('scenes_irregular_so_far_in_this_run', progress%irregular_so_far)
      call summary%add('wall_seconds', wall_seconds() - started)
      if (allocated(overtaken)) then
         call move_alloc(overtaken, error)
      else
         call summary%write(summary_path(scene), summary_error)
         if (.not. allocated(error) .and. allocated(summary_error)) call move_alloc(summary_error, error)
         stands = path_exists(result_path(scene))
         if (.not. (stands .or. allocated(error))) call raise(error, exit_system, result_path(scene)//' was taken away')
      end if
      if (progress%beyond_model > 0) call log%line('  warning: '//counted(progress%beyond_model, 'scene')//' beyond what the '// &
         'model can mean: films beyond a tenth of the radius or below 1 nm (column model_limit)')
      if (progress%undersampled > 0) call log%line('  warning: the lines of '//counted(progress%undersampled, 'scene')// &
         ' are not resolved (column sampling_sufficient); raise campaign.samples_per_period')
      if (progress%tested > 0) call log%line('  '//integer_text(progress%uncertain)//' of '//integer_text(progress%tested)// &
         ' scenes not verified: solved again, tighter, the class is another or close to a limit (column verified)')
      if (progress%irregular_so_far > 0) call log%line('  '//counted(progress%irregular_so_far, 'scene')// &
         ' irregular so far: without repetition, and no neighbouring motion parts for good (rattle_class)')
      call log%line('  '//result_path(scene))
      call log%line('  '//summary_path(scene))
      call log%close()
      exit_code = exit_complete
      if (progress%failed > 0) exit_code = exit_scene_failed
      if (.not. finished) exit_code = 128 + caught_signal()
      if (allocated(error)) exit_code = error%exit_code
   end subroutine close_campaign

   !> Scenes in chunks that are done.
   integer(int64) function done_scenes(results)
      type(campaign_file_t), intent(in) :: results
      integer(int64) :: chunk, first, last

      done_scenes = 0_int64
      do chunk = 1_int64, results%chunk_count()
         if (.not. results%is_done(chunk)) cycle
         call results%chunk_bounds(chunk, first, last)
         done_scenes = done_scenes + last - first + 1_int64
      end do
   end function done_scenes

end module run_campaign
