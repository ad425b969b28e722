!> A campaign: chunks of scenes to threads and ranks, rows in the order of the scenes. table_task runs it.
module run_campaign
   use campaign_plan, only: look_watcher_t
   use campaign_file, only: campaign_file_t
   use campaign_progress, only: campaign_progress_t
   use clock, only: wall_seconds
   use core_time, only: core_time_sentence
   use earlier_files, only: check_lone_summary
   use errors, only: error_t, exit_system, fault_list_t, raise
   use finished_files, only: bring_back, drop_aside, set_aside
   use file_system, only: file_state_t, path_exists, state_of_path
   use kinds, only: dp, int64
   use log_file, only: log_t
   use output_lock, only: expect_own_lock
   use output_place, only: result_path, stem, summary_path
   use prepared_campaign, only: campaign_t, prepare_campaign
   use ranks, only: add_over_ranks, next_tickets, rank_count, this_rank
   use row_counts, only: count_beyond_model, count_done, count_extrapolated, count_failed, count_followed, count_irregular, &
      count_irregular_so_far, count_rows, count_several, count_tested, count_uncertain, count_undersampled
   use scene_summary, only: add_notes, add_results
   use regime_check, only: extrapolated_closure, outside_model
   use scene_status, only: status_complete, status_interrupted, status_name, status_not_written
   use scene_types, only: scene_t
   use schedule, only: pace_t
   use signals, only: caught_signal
   use judge_group, only: judgement_space_t
   use solve_chunk, only: longest_scene_t, note_longest, scenes_of_block, solve_scenes
   use summary_file, only: summary_t
   use table_task, only: table_task_t
   use text, only: counted, integer_text, short_text
   use version, only: program_version
   use word_list, only: word_t
   use, intrinsic :: omp_lib, only: omp_get_max_threads
   implicit none(type, external)
   private

   !> A campaign, or one part of it.
   type, extends(table_task_t), public :: campaign_task_t
      private
      type(campaign_t) :: campaign
      type(campaign_file_t) :: results
      !> Of this rank
      type(longest_scene_t) :: longest
      !> Chunks of an earlier run that were damaged
      integer(int64) :: spoilt = 0_int64
   contains
      procedure :: prepare
      procedure :: check_lines
      procedure :: open_files
      procedure :: heading
      procedure :: report_start
      procedure :: solve
      procedure :: close_files
   end type campaign_task_t

contains

   subroutine prepare(self, file, hurried, faults, watcher)
      class(campaign_task_t), intent(inout) :: self
      character(*), intent(in) :: file
      logical, intent(in) :: hurried
      type(fault_list_t), intent(inout) :: faults
      class(look_watcher_t), optional, intent(inout) :: watcher

      call prepare_campaign(self%scene, file, hurried, self%campaign, faults, watcher)
      if (faults%count() == 0) self%warnings = self%campaign%warnings
   end subroutine prepare

   !> How many scenes, how large the result, how long it may take; what was not looked at for lack of time is reported.
   function check_lines(self) result(words)
      class(campaign_task_t), intent(in) :: self
      character(:), allocatable :: words
      integer(int64) :: chunks
      character(:), allocatable :: among

      associate (campaign => self%campaign, layout => self%campaign%layout)
         chunks = (layout%scene_count + layout%chunk_rows - 1_int64)/layout%chunk_rows
         among = ''
         if (campaign%seen < layout%scene_count) among = ' among the first '//integer_text(campaign%seen)// &
                                                         '; there was no time to look at more'
         ! Where a table is so long that its traces could not even be counted, none of its scenes was looked at.
         words = '! scenes             '//trim(merge(' at least', '         ', campaign%seen == 0_int64 .and. chunks > 0_int64))// &
                 ' '//integer_text(layout%scene_count)//' ('//integer_text(campaign%invalid)//' invalid'//among//')'// &
                 new_line('a')//'! result size         '// &
                 short_text(8.0e-6_dp*real(size(layout%names), dp)*real(layout%scene_count, dp), 3)//' MB'//new_line('a')// &
                 '! chunks              '//integer_text(chunks)//' of at most '//counted(layout%chunk_rows, 'scene')// &
                 new_line('a')//'! core time, '//core_time_sentence(self%scene, campaign)
      end associate
   end function check_lines

   !> A new result, or that of an earlier run; the summary of an earlier run goes before its result does.
   subroutine open_files(self, error)
      class(campaign_task_t), intent(inout) :: self
      type(error_t), allocatable, intent(out) :: error
      character(:), allocatable :: path
      type(word_t), allocatable :: summaries(:)
      type(file_state_t) :: earlier

      path = result_path(self%scene)
      earlier = state_of_path(path)
      if (self%carry_on) call check_lone_summary(self%scene, error)
      summaries = [word_t(summary_path(self%scene))]
      if (.not. allocated(error)) call set_aside(summaries)
      if (allocated(error)) then
         continue
      else if (self%carry_on .and. earlier%bytes > 0_int64) then
         call self%results%resume(path, self%campaign%layout, self%spoilt, error)
      else
         call self%results%create(path, self%campaign%layout, self%scene%output%overwrite .and. .not. self%carry_on, error)
      end if
      if (allocated(error)) call bring_back(summaries)
      call drop_aside(summaries)
      self%scenes = self%campaign%layout%scene_count
      if (.not. allocated(error)) self%done_before = done_scenes(self%results)
   end subroutine open_files

   function heading(self) result(words)
      class(campaign_task_t), intent(in) :: self
      character(:), allocatable :: words

      words = 'campaign '//trim(self%scene%name)//': '//integer_text(self%campaign%layout%scene_count)//' scenes'
   end function heading

   subroutine report_start(self)
      class(campaign_task_t), intent(in) :: self

      if (self%spoilt > 0) call self%log%item('earlier run', integer_text(self%spoilt)// &
                                              ' of its chunks were damaged; they are solved again')
   end subroutine report_start

   subroutine solve(self, error)
      class(campaign_task_t), intent(inout) :: self
      type(error_t), allocatable, intent(out) :: error

      if (this_rank() > 0) call self%results%join(result_path(self%scene), self%campaign%layout, error)
      if (.not. allocated(error)) &
         call solve_chunks(self%scene, self%campaign, self%results, self%progress, self%log, self%longest, error)
      if (.not. allocated(error)) call share_longest(self%longest)
   end subroutine solve

   !> Find the longest scene of all ranks.
   subroutine share_longest(longest)
      !> In: of this rank; out: of all
      type(longest_scene_t), intent(inout) :: longest
      real(dp), allocatable :: table(:, :)
      integer :: i

      allocate (table(2, rank_count()), source=0.0_dp)
      table(:, this_rank() + 1) = [real(longest%number, dp), real(longest%steps, dp)]
      call add_over_ranks(table)
      do i = 1, size(table, 2)
         call note_longest(int(table(1, i), int64), int(table(2, i), int64), longest)
      end do
   end subroutine share_longest

   !> Chunks until none is left, or a signal asks to stop: a thread takes as many at a time as a few seconds of work are.
   subroutine solve_chunks(scene, campaign, results, progress, log, longest, error)
      type(scene_t), intent(in) :: scene
      type(campaign_t), intent(in) :: campaign
      type(campaign_file_t), intent(inout) :: results
      type(campaign_progress_t), intent(inout) :: progress
      type(log_t), intent(in) :: log
      type(longest_scene_t), intent(out) :: longest
      type(error_t), allocatable, intent(out) :: error
      type(error_t), allocatable :: own_error
      integer(int64), allocatable :: pending(:)
      type(judgement_space_t) :: space
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
         call solve_some(scene, campaign, pending(ticket:last_ticket), results, space, progress, longest, scenes, own_error)
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

   !> Report the progress, if it is time to.
   subroutine tell_progress(results, progress, log)
      type(campaign_file_t), intent(in) :: results
      type(campaign_progress_t), intent(inout) :: progress
      type(log_t), intent(in) :: log

      if (.not. progress%is_due()) return
      if (rank_count() > 1) then
         call progress%report(log, results%scenes_done())
      else
         call progress%report(log)
      end if
   end subroutine tell_progress

   !> Solve and write some chunks, those that follow each other side by side. What was stopped is not written: its scenes are solved
   !> again when the run is carried on.
   subroutine solve_some(scene, campaign, chunks, results, space, progress, longest, scenes, error)
      type(scene_t), intent(in) :: scene
      type(campaign_t), intent(in) :: campaign
      !> By rising numbers
      integer(int64), intent(in) :: chunks(:)
      type(campaign_file_t), intent(inout) :: results
      !> Work space of this thread
      type(judgement_space_t), intent(inout) :: space
      type(campaign_progress_t), intent(inout) :: progress
      !> Of all threads
      type(longest_scene_t), intent(inout) :: longest
      !> How many scenes were solved
      integer(int64), intent(out) :: scenes
      !> Set if chunks could not be written, or there is no memory for them
      type(error_t), allocatable, intent(out) :: error
      real(dp), allocatable :: rows(:, :)
      type(longest_scene_t) :: own_longest
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
         call solve_scenes(scene, campaign%plan, campaign%first + first_row - 1_int64, space, rows, error, own_longest)
         if (caught_signal() /= 0 .or. allocated(error)) return
         call results%write_chunks(chunks(first), rows, error)
         if (allocated(error)) return
         call progress%add(count_rows(campaign%layout%names, status_column, rows))
         scenes = scenes + last_row - first_row + 1_int64
         deallocate (rows)
      end do
      !$omp critical (longest_scene)
      call note_longest(own_longest%number, own_longest%steps, longest)
      !$omp end critical (longest_scene)
   end subroutine solve_some

   !> Close the result, write the summary, and say what became of the campaign.
   subroutine close_files(self, error)
      class(campaign_task_t), intent(inout) :: self
      type(error_t), allocatable, intent(inout) :: error
      type(error_t), allocatable :: close_error
      type(summary_t) :: summary
      integer :: status
      logical :: finished

      call self%results%close(finished, close_error)
      self%is_cut = .not. finished
      self%failed = self%progress%counts(count_failed)
      status = merge(status_complete, status_interrupted, finished)
      if (allocated(error) .or. allocated(close_error)) status = status_not_written
      call self%progress%finish(self%log)
      call add_counts(summary, self, status)
      call write_summary(self%scene, summary, close_error)
      if (.not. allocated(error) .and. allocated(close_error)) call move_alloc(close_error, error)
      call report_ending(self%log, self%scene, self%campaign, self%progress, self%longest)
   end subroutine close_files

   subroutine add_counts(summary, task, status)
      type(summary_t), intent(inout) :: summary
      class(campaign_task_t), intent(in) :: task
      integer, intent(in) :: status

      call summary%add('name', trim(task%scene%name))
      call summary%add('program_version', program_version)
      call summary%add('status', status_name(status))
      call add_notes(summary, task%scene, [task%scene%warnings, task%warnings])
      call add_results(summary, [word_t(result_path(task%scene))], status)
      associate (progress => task%progress, counts => task%progress%counts)
         call summary%add('scenes', task%scenes)
         call summary%add('scenes_done', progress%done_before + counts(count_done))
         call summary%add('scenes_invalid', task%campaign%invalid)
         call summary%add('scenes_failed_in_this_run', counts(count_failed))
         call summary%add('scenes_beyond_model_in_this_run', counts(count_beyond_model))
         call summary%add('scenes_undersampled_in_this_run', counts(count_undersampled))
         if (any(task%campaign%layout%names == 'closure_range')) &
            call summary%add('scenes_extrapolated_in_this_run', counts(count_extrapolated))
         if (any(task%campaign%layout%names == 'verified')) &
            call summary%add('scenes_not_verified_in_this_run', counts(count_uncertain))
         if (any(task%campaign%layout%names == 'rattle_class')) then
            call summary%add('scenes_irregular_in_this_run', counts(count_irregular))
            call summary%add('scenes_irregular_so_far_in_this_run', counts(count_irregular_so_far))
         end if
         if (any(task%campaign%layout%names == 'motions')) &
            call summary%add('scenes_with_several_motions_in_this_run', counts(count_several))
      end associate
      call summary%add('wall_seconds', wall_seconds() - task%started)
   end subroutine add_counts

   !> Put the summary beside the result, unless another run has taken that place.
   subroutine write_summary(scene, summary, error)
      type(scene_t), intent(in) :: scene
      type(summary_t), intent(in) :: summary
      !> In: what went wrong with the result; out: also if the summary could not be written, or another run has the place
      type(error_t), allocatable, intent(inout) :: error
      type(error_t), allocatable :: overtaken, summary_error
      logical :: stands

      call expect_own_lock(stem(scene), overtaken)
      if (allocated(overtaken)) then
         call move_alloc(overtaken, error)
         return
      end if
      call summary%write(summary_path(scene), summary_error)
      if (.not. allocated(error) .and. allocated(summary_error)) call move_alloc(summary_error, error)
      stands = path_exists(result_path(scene))
      if (.not. (stands .or. allocated(error))) call raise(error, exit_system, result_path(scene)//' was removed')
   end subroutine write_summary

   !> What has to be known about the scenes of this run, and where the files are.
   subroutine report_ending(log, scene, campaign, progress, longest)
      type(log_t), intent(in) :: log
      type(scene_t), intent(in) :: scene
      type(campaign_t), intent(in) :: campaign
      type(campaign_progress_t), intent(in) :: progress
      type(longest_scene_t), intent(in) :: longest

      associate (counts => progress%counts)
         if (counts(count_uncertain) > 0) call log%item('not verified', integer_text(counts(count_uncertain))//' of '// &
            counted(counts(count_tested), 'scene')//': a tighter solution has another class, or comes close to a limit (verified)')
         if (counts(count_irregular) > 0) call log%item('irregular', counted(counts(count_irregular), 'scene')// &
            ': numbers of 100 periods or more, with standard errors (acceleration_rms_error)')
         if (counts(count_irregular_so_far) > 0) call log%item('irregular so far', &
            counted(counts(count_irregular_so_far), 'scene')//': no repetition, no Lyapunov exponent that is surely positive')
         if (counts(count_followed) > 0 .and. scene%solver%starts > 1) &
            call log%item('motions', 'several at '//integer_text(counts(count_several))//' of '// &
                          counted(counts(count_followed), 'scene')//'; '//integer_text(scene%solver%starts)//' starts'// &
                          trim(merge(' and neighbours', '               ', scenes_of_block(scene, campaign%plan) > 1))// &
                          ' do not prove that there are no others')
         if (longest%number > 0_int64) call log%item('longest', 'scene '//integer_text(longest%number)//', '// &
                                                     counted(longest%steps, 'step'))
         call log%item('files', summary_path(scene)//', .rattle, .log')
         if (counts(count_beyond_model) > 0) call log%item('warning', outside_model(counted(counts(count_beyond_model), 'scene')))
         if (counts(count_extrapolated) > 0) call log%item('warning', extrapolated_closure( &
            integer_text(counts(count_extrapolated)), counted(counts(count_done), 'scene'), scene%film%automatic))
         if (counts(count_undersampled) > 0) call log%item('warning', 'harmonics of '// &
            counted(counts(count_undersampled), 'scene')//' are not resolved (sampling_sufficient); '// &
            'raise campaign.samples_per_period')
      end associate
   end subroutine report_ending

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
