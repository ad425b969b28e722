!> A campaign from input to file: plan, chunks to threads and ranks, rows in the order of the scenes.
module run_campaign
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use campaign_file, only: campaign_file_t, campaign_layout_t
   use campaign_plan, only: count_invalid, plan_campaign
   use campaign_progress, only: campaign_progress_t
   use campaign_record, only: record_columns
   use clock, only: wall_seconds
   use errors, only: error_t, exit_complete, exit_scene_failed, fault_list_t, raise
   use file_system, only: file_state_t, state_of_path
   use key_table, only: find_key
   use kinds, only: dp, int64
   use log_file, only: log_magic, log_t
   use memory, only: expect_memory
   use output_lock, only: output_lock_t
   use output_place, only: check_output_place, log_path, progress_path, result_path, stem, summary_path
   use ranks, only: abort_ranks, next_ticket, rank_count, share_number, sum_over_ranks, this_rank, wait_for_ranks
   use quantities, only: needs_certificate, quantity_table
   use sampling, only: largest_value, sample_plan_t
   use scene_report, only: law_sentence
   use scene_status, only: is_success, status_complete, status_interrupted, status_name, status_not_written
   use scene_types, only: scene_t
   use schedule, only: chunk_rows_for
   use signals, only: caught_signal, lift_time_limit, limit_time, must_stop
   use solve_chunk, only: chunk_bytes, chunk_space_t, solve_scenes
   use summary_file, only: summary_t
   use text, only: counted, integer_text, short_text
   use version, only: program_version
   use word_list, only: word_t
   use, intrinsic :: omp_lib, only: omp_get_max_threads, omp_get_thread_num
   implicit none(type, external)
   private

   !> What --check may take to read the scenes, to look at them, and to solve some of them [s]
   integer, parameter :: reading_limit = 2, looking_limit = 1, trial_limit = 1

   public :: run_one_campaign, check_campaign

contains

   !> --check of a campaign: how many scenes, how large the result, how long it may take. However large the campaign is,
   !> this takes a few seconds: what was not looked at by then is told.
   subroutine check_campaign(scene, file, lines, faults)
      !> Checked base scene
      type(scene_t), intent(in) :: scene
      !> Its input, for the faults
      character(*), intent(in) :: file
      !> What to tell
      character(:), allocatable, intent(out) :: lines
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      type(sample_plan_t) :: plan
      type(campaign_layout_t) :: layout
      integer(int64) :: invalid, first, seen
      integer(int64) :: chunks
      character(:), allocatable :: among
      type(word_t), allocatable :: warnings(:)
      integer :: i

      lines = ''
      call prepare(scene, file, .true., plan, first, seen, invalid, layout, warnings, faults)
      if (faults%count() > 0) return
      chunks = (layout%scene_count + layout%chunk_rows - 1_int64)/layout%chunk_rows
      among = ''
      if (seen < layout%scene_count) among = ' among the first '//integer_text(seen)//'; there was no time to look at more'
      do i = 1, size(warnings)
         lines = lines//'! '//warnings(i)%text//new_line('a')
      end do
      ! Where a table is so long that its lines could not even be counted, none of its scenes was looked at.
      lines = lines//'! scenes             '//trim(merge(' at least', '         ', seen == 0_int64 .and. chunks > 0_int64))//' '// &
              integer_text(layout%scene_count)//' ('//integer_text(invalid)//' invalid'//among//')'//new_line('a')// &
              '! result size         '//short_text(8.0e-6_dp*real(size(layout%names), dp)*real(layout%scene_count, dp), 3)// &
              ' MB'//new_line('a')// &
              '! chunks              '//integer_text(chunks)//' of at most '// &
              integer_text(layout%chunk_rows)//' scenes'//new_line('a')// &
              '! core time, '//core_time_sentence(scene, plan, first, seen, layout)
   end subroutine check_campaign

   !> How long the scenes may take, from trials of 8, 64 and 512 of them, as far as there is time.
   function core_time_sentence(scene, plan, first, seen, layout) result(sentence)
      type(scene_t), intent(in) :: scene
      type(sample_plan_t), intent(in) :: plan
      !> First scene of this part of the campaign, and scenes of it whose values are known
      integer(int64), intent(in) :: first
      integer(int64), intent(in) :: seen
      type(campaign_layout_t), intent(in) :: layout
      character(:), allocatable :: sentence
      type(chunk_space_t) :: space
      type(error_t), allocatable :: error
      real(dp), allocatable :: rows(:, :)
      real(dp) :: started, seconds
      integer(int64) :: trial

      sentence = 'not estimated: no scene could be looked at'
      if (seen == 0_int64) return
      call limit_time(trial_limit)
      trial = min(8_int64, seen)
      do
         allocate (rows(size(layout%names), trial))
         started = wall_seconds()
         call solve_scenes(scene, plan, first + (seen - trial)/2_int64, space, rows, error)
         seconds = (wall_seconds() - started)/real(trial, dp)*real(layout%scene_count, dp)
         deallocate (rows)
         if (must_stop() .or. allocated(error)) exit
         sentence = 'estimated '//short_text(seconds, 2)//' s, from '//integer_text(trial)//' scenes'
         if (trial == min(512_int64, seen)) exit
         trial = min(8_int64*trial, seen)
      end do
      if (must_stop() .and. trial == min(8_int64, seen)) &
         sentence = 'more than '//short_text(seconds, 2)//' s: '//integer_text(trial)//' scenes were not solved within '// &
                    integer_text(trial_limit)//' s'
      call lift_time_limit()
   end function core_time_sentence

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
      type(sample_plan_t) :: plan
      type(campaign_layout_t) :: layout
      type(campaign_file_t) :: results
      type(campaign_progress_t) :: progress
      type(log_t) :: log
      type(output_lock_t) :: lock
      type(error_t), allocatable :: close_error
      type(word_t), allocatable :: warnings(:)
      integer(int64) :: first, seen, spoilt, invalid
      integer :: i
      real(dp) :: started
      type(file_state_t) :: earlier

      started = wall_seconds()
      call prepare(scene, file, .false., plan, first, seen, invalid, layout, warnings, faults)
      exit_code = faults%exit_code
      spoilt = 0_int64
      if (this_rank() == 0) then
         if (faults%count() == 0) call check_output_place(scene, file, .true., faults)
         if (faults%count() == 0) call lock%take(stem(scene), error)
         ! Another run may have written these files since they were looked at.
         if (faults%count() == 0 .and. .not. allocated(error)) call check_output_place(scene, file, .false., faults)
         if (caught_signal() /= 0) then
            ! The look at the scenes was cut short: there may be faults that are not known.
            exit_code = 128 + caught_signal()
         else if (allocated(error)) then
            exit_code = error%exit_code
         else if (faults%count() == 0) then
            earlier = state_of_path(result_path(scene))
            if (carry_on .and. earlier%bytes > 0_int64) then
               call results%resume(result_path(scene), layout, spoilt, error)
            else
               call results%create(result_path(scene), layout, scene%output%overwrite .and. .not. carry_on, error)
            end if
            if (.not. allocated(error)) call log%open(log_path(scene), quiet, error)
            exit_code = exit_complete
            if (allocated(error)) exit_code = error%exit_code
         end if
      end if
      call share_number(exit_code)
      if (exit_code /= exit_complete) then
         call lock%release()
         return
      end if
      ! Memory may lack on the machine of this rank alone.
      if (faults%count() > 0) then
         call raise(error, faults%exit_code, faults%sentence(1))
      else if (this_rank() > 0) then
         call results%join(result_path(scene), layout, error)
      end if
      if (allocated(error)) then
         call abort_ranks(error)
         return
      end if
      call wait_for_ranks()

      if (this_rank() == 0) then
         call log%line(log_magic//program_version//', campaign '//trim(scene%name)//': '//integer_text(layout%scene_count)// &
                       ' scenes, '//law_sentence(scene)//'; '//counted(rank_count(), 'rank')//' of '// &
                       counted(omp_get_max_threads(), 'thread'))
         warnings = [scene%warnings, warnings]
         do i = 1, size(warnings)
            call log%line('  '//warnings(i)%text)
         end do
         if (spoilt > 0) call log%line('  '//integer_text(spoilt)//' chunks of the earlier run were damaged; they are solved again')
         if (.not. results%is_locked()) call log%line('  warning: this file system knows no locks; see that no other run '// &
                                                      'writes here')
      end if
      call progress%start(progress_path(scene), layout%scene_count, done_scenes(results), quiet)
      call solve_chunks(scene, plan, layout, first, results, progress, log, error)
      if (allocated(error)) call abort_ranks(error)
      call wait_for_ranks()
      progress%done = sum_over_ranks(progress%done)
      progress%failed = sum_over_ranks(progress%failed)
      progress%beyond_model = sum_over_ranks(progress%beyond_model)
      progress%undersampled = sum_over_ranks(progress%undersampled)
      if (this_rank() == 0) then
         call close_campaign(scene, layout, invalid, started, results, progress, log, allocated(error), exit_code, close_error)
         if (allocated(error)) exit_code = error%exit_code
         if (.not. allocated(error) .and. allocated(close_error)) call move_alloc(close_error, error)
      end if
      call lock%release()
      call share_number(exit_code)
   end subroutine run_one_campaign

   !> What is known before anything is solved; the scenes are cut by the whole campaign, whatever part of it this is. After a
   !> fault only the faults are of use.
   subroutine prepare(scene, file, hurried, plan, first, seen, invalid, layout, warnings, faults)
      type(scene_t), intent(in) :: scene
      character(*), intent(in) :: file
      !> Whether to look at no more scenes than there is time for
      logical, intent(in) :: hurried
      type(sample_plan_t), intent(out) :: plan
      !> First scene of this part of the campaign, how many of the part were looked at, and how many of these are invalid
      integer(int64), intent(out) :: first
      integer(int64), intent(out) :: seen
      integer(int64), intent(out) :: invalid
      type(campaign_layout_t), intent(out) :: layout
      !> Numbers of a table that no engineer can mean
      type(word_t), allocatable, intent(out) :: warnings(:)
      type(fault_list_t), intent(inout) :: faults
      integer(int64) :: last

      first = 0_int64
      seen = 0_int64
      invalid = 0_int64
      if (hurried) call limit_time(reading_limit)
      call plan_campaign(scene, file, plan, warnings, faults)
      if (hurried) call lift_time_limit()
      if (faults%count() > 0) return
      layout%chunk_rows = int(chunk_rows_for(plan%size, largest_value(plan, find_key('solver', 'periods'), &
                                                                      real(scene%solver%periods, dp)), &
                                             any(quantity_table(scene%campaign%record)%need == needs_certificate)), int64)
      call share_of_part(scene, plan%size, layout%chunk_rows, first, last)
      layout%input_text = scene%resolved_input
      layout%source_checksum = plan%table_checksum
      layout%scene_count = last - first + 1_int64
      call record_columns(scene, plan%positions, layout%names, layout%units)
      call expect_campaign_memory(scene, file, plan, layout, faults)
      if (faults%count() > 0) return
      if (hurried) call limit_time(looking_limit)
      call count_invalid(scene, file, plan, first, last, seen, invalid, faults)
      if (hurried) call lift_time_limit()
   end subroutine prepare

   !> See that there is memory for the threads of this process and for the table of chunks.
   subroutine expect_campaign_memory(scene, file, plan, layout, faults)
      type(scene_t), intent(in) :: scene
      character(*), intent(in) :: file
      type(sample_plan_t), intent(in) :: plan
      type(campaign_layout_t), intent(in) :: layout
      type(fault_list_t), intent(inout) :: faults
      !> A thread beside its chunk, and a chunk in all lists of them
      real(dp), parameter :: thread_bytes = 10.0e6_dp, listed_bytes = 64.0_dp
      type(error_t), allocatable :: error
      real(dp) :: chunks, row_bytes

      chunks = real((layout%scene_count + layout%chunk_rows - 1_int64)/layout%chunk_rows, dp)
      row_bytes = 8.0_dp*real(size(layout%names), dp)*real(min(layout%chunk_rows, layout%scene_count), dp)
      call expect_memory(real(omp_get_max_threads(), dp)*(thread_bytes + 2.0_dp*row_bytes + &
                                                          chunk_bytes(scene, plan, layout%chunk_rows)) &
                         + listed_bytes*chunks, &
                         'this campaign of '//integer_text(layout%scene_count)//' scenes, of which each of '// &
                         integer_text(omp_get_max_threads())//' threads (--threads) solves '// &
                         integer_text(layout%chunk_rows)//' at a time with windows of &spectrum periods and &campaign '// &
                         'samples_per_period = '//integer_text(scene%campaign%samples_per_period)//',', error)
      if (allocated(error)) call faults%add_error(file, 0, '', '', error)
   end subroutine expect_campaign_memory

   !> Chunks until none is left, or a signal asks to stop.
   subroutine solve_chunks(scene, plan, layout, first, results, progress, log, error)
      type(scene_t), intent(in) :: scene
      type(sample_plan_t), intent(in) :: plan
      type(campaign_layout_t), intent(in) :: layout
      !> First scene of this part of the campaign
      integer(int64), intent(in) :: first
      type(campaign_file_t), intent(inout) :: results
      type(campaign_progress_t), intent(inout) :: progress
      type(log_t), intent(in) :: log
      type(error_t), allocatable, intent(out) :: error
      type(error_t), allocatable :: own_error
      integer(int64), allocatable :: pending(:)
      type(chunk_space_t) :: space
      real(dp), allocatable :: rows(:, :)
      integer(int64) :: ticket, first_row, last_row, chunk
      logical :: failed
      integer :: status_column

      failed = .false.
      status_column = 2 + size(plan%positions)
      pending = pack([(chunk, chunk=1_int64, results%chunk_count())],.not. results%done_flags())
      !$omp parallel default(shared) private(ticket, chunk, first_row, last_row, rows, space, own_error)
      do
         if (caught_signal() /= 0 .or. failed) exit
         ticket = next_ticket()
         if (ticket > size(pending, kind=int64)) exit
         chunk = pending(ticket)
         call results%chunk_bounds(chunk, first_row, last_row)
         allocate (rows(size(layout%names), last_row - first_row + 1_int64))
         call solve_scenes(scene, plan, first + first_row - 1_int64, space, rows, own_error)
         ! A chunk that was stopped is not written: its scenes are solved again when the run is carried on.
         if (caught_signal() /= 0) exit
         if (.not. allocated(own_error)) call results%write_chunk(chunk, rows, own_error)
         if (.not. allocated(own_error)) &
            call progress%add(last_row - first_row + 1_int64, &
                              count(.not. is_success(nint(rows(status_column, :))), kind=int64), &
                              flagged(layout%names == 'model_limit', rows, 1.0_dp), &
                              flagged(layout%names == 'sampling_sufficient', -rows, 0.0_dp))
         deallocate (rows)
         if (allocated(own_error)) then
            !$omp critical (campaign_error)
            failed = .true.
            if (.not. allocated(error)) call move_alloc(own_error, error)
            !$omp end critical (campaign_error)
         end if
         if (this_rank() == 0) then
            if (omp_get_thread_num() == 0) call progress%tell(log)
         end if
      end do
      !$omp end parallel
   end subroutine solve_chunks

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
   subroutine close_campaign(scene, layout, invalid, started, results, progress, log, not_written, exit_code, error)
      type(scene_t), intent(in) :: scene
      type(campaign_layout_t), intent(in) :: layout
      integer(int64), intent(in) :: invalid
      real(dp), intent(in) :: started
      type(campaign_file_t), intent(inout) :: results
      type(campaign_progress_t), intent(inout) :: progress
      type(log_t), intent(inout) :: log
      !> Whether chunks could not be written
      logical, intent(in) :: not_written
      integer, intent(out) :: exit_code
      type(error_t), allocatable, intent(out) :: error
      type(summary_t) :: summary
      type(error_t), allocatable :: summary_error
      integer :: status
      logical :: finished

      call results%close(finished, error)
      status = merge(status_complete, status_interrupted, finished)
      if (allocated(error) .or. not_written) status = status_not_written
      call progress%finish(log)
      call summary%add('name', trim(scene%name))
      call summary%add('program_version', program_version)
      call summary%add('status', status_name(status))
      call summary%add('scenes', layout%scene_count)
      call summary%add('scenes_done', progress%done_before + progress%done)
      call summary%add('scenes_invalid', invalid)
      call summary%add('scenes_failed_in_this_run', progress%failed)
      call summary%add('scenes_beyond_model_in_this_run', progress%beyond_model)
      call summary%add('scenes_undersampled_in_this_run', progress%undersampled)
      call summary%add('wall_seconds', wall_seconds() - started)
      call summary%write(summary_path(scene), summary_error)
      if (.not. allocated(error) .and. allocated(summary_error)) call move_alloc(summary_error, error)
      if (progress%beyond_model > 0) call log%line('  warning: '//integer_text(progress%beyond_model)//' scenes leave what the '// &
         'model can mean: films beyond a tenth of the radius or below 1 nm (column model_limit)')
      if (progress%undersampled > 0) call log%line('  warning: the lines of '//integer_text(progress%undersampled)// &
         ' scenes are not resolved (column sampling_sufficient); raise campaign.samples_per_period')
      call log%line('  '//result_path(scene))
      call log%line('  '//summary_path(scene))
      call log%close()
      exit_code = exit_complete
      if (progress%failed > 0) exit_code = exit_scene_failed
      if (.not. finished) exit_code = 128 + caught_signal()
      if (allocated(error)) exit_code = error%exit_code
   end subroutine close_campaign

   !> Scenes of the whole campaign that this part solves, cut at the borders of chunks.
   pure subroutine share_of_part(scene, scenes, chunk, first, last)
      type(scene_t), intent(in) :: scene
      !> Scenes of the campaign, and of a chunk
      integer(int64), intent(in) :: scenes
      integer(int64), intent(in) :: chunk
      integer(int64), intent(out) :: first
      integer(int64), intent(out) :: last
      integer(int64) :: chunks, parts, part

      chunks = (scenes - 1_int64)/chunk + 1_int64
      parts = int(scene%campaign%parts, int64)
      part = int(scene%campaign%part, int64)
      first = chunk*(chunks*(part - 1_int64)/parts) + 1_int64
      last = min(scenes, chunk*(chunks*part/parts))
   end subroutine share_of_part

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
