!> Progress of a campaign: one line on a terminal, a line every ten seconds at least elsewhere, and NAME.progress.nml for watchers.
module campaign_progress
   use clock, only: wall_seconds
   use errors, only: error_t
   use file_system, only: is_terminal
   use kinds, only: dp, int64
   use log_file, only: labelled, log_t
   use ranks, only: sum_over_ranks
   use row_counts, only: count_done, count_failed, count_tested, count_uncertain, counts_of_rows
   use summary_file, only: summary_t
   use text, only: integer_text, short_text
   use text_output, only: show_on_terminal
   implicit none(type, external)
   private

   !> What a thread takes at a time takes a few seconds: only then it is seen that a line is due [s]
   real(dp), parameter :: terminal_interval = 0.5_dp, line_interval = 6.0_dp, file_interval = 5.0_dp

   !> Progress so far. Threads add to the counts; each of them reports.
   type, public :: campaign_progress_t
      integer(int64) :: scenes = 0_int64, done_before = 0_int64
      !> Of the scenes that this run has solved, by module row_counts
      integer(int64) :: counts(counts_of_rows) = 0_int64
      !> Scenes that other ranks have solved
      integer(int64), private :: done_elsewhere = 0_int64
      !> Scenes that were looked at, as long as none is solved
      integer(int64) :: looked_at = 0_int64
      logical :: quiet = .false.
      character(:), allocatable :: path
      logical, private :: on_terminal = .false.
      real(dp), private :: started = 0.0_dp, last_report = 0.0_dp, written = 0.0_dp
   contains
      procedure :: start
      procedure :: add
      procedure :: is_due
      procedure :: report
      procedure :: add_up
      procedure :: finish
   end type campaign_progress_t

contains

   !> Begin.
   subroutine start(self, path, scenes, done_before, quiet)
      class(campaign_progress_t), intent(inout) :: self
      !> File for watchers
      character(*), intent(in) :: path
      !> Scenes of the campaign, and those an earlier run has solved
      integer(int64), intent(in) :: scenes
      integer(int64), intent(in) :: done_before
      !> Nothing to the terminal
      logical, intent(in) :: quiet

      self%path = path
      self%scenes = scenes
      self%done_before = done_before
      self%looked_at = 0_int64
      self%quiet = quiet
      self%on_terminal = is_terminal()
      self%started = wall_seconds()
      self%last_report = self%started
      self%written = self%started
   end subroutine start

   !> Count solved scenes.
   subroutine add(self, counts)
      class(campaign_progress_t), intent(inout) :: self
      !> Of their rows
      integer(int64), intent(in) :: counts(counts_of_rows)
      integer :: i

      do i = 1, counts_of_rows
         !$omp atomic
         self%counts(i) = self%counts(i) + counts(i)
      end do
   end subroutine add

   !> Whether it is time to report.
   logical function is_due(self)
      class(campaign_progress_t), intent(in) :: self
      real(dp) :: now

      now = wall_seconds()
      !$omp critical (sentences)
      is_due = self%done_before + self%counts(count_done) < self%scenes .and. &
               (now - self%written > file_interval .or. &
                now - self%last_report >= merge(terminal_interval, line_interval, self%on_terminal))
      !$omp end critical (sentences)
   end function is_due

   !> Report, if it is time to, and no other thread makes texts.
   subroutine report(self, log, done)
      class(campaign_progress_t), intent(inout) :: self
      !> Log of the campaign
      type(log_t), intent(in) :: log
      !> Scenes that all ranks have done in all runs, where this is not the only rank
      integer(int64), intent(in), optional :: done
      real(dp) :: now

      now = wall_seconds()
      !$omp critical (sentences)
      if (present(done)) self%done_elsewhere = max(0_int64, done - self%done_before - self%counts(count_done))
      if (now - self%written > file_interval) call write_progress(self, now)
      if (now - self%last_report >= merge(terminal_interval, line_interval, self%on_terminal)) call report_line(self, log, now)
      !$omp end critical (sentences)
   end subroutine report

   !> A line that is written over on a terminal, one more elsewhere.
   subroutine report_line(self, log, now)
      class(campaign_progress_t), intent(inout) :: self
      type(log_t), intent(in) :: log
      real(dp), intent(in) :: now

      self%last_report = now
      if (.not. self%on_terminal) then
         call log%item('scenes', words(self, now))
      else if (.not. self%quiet) then
         call show_on_terminal(achar(13)//labelled('scenes', words(self, now))//'   ')
      end if
   end subroutine report_line

   !> Add up the counts of all ranks.
   subroutine add_up(self)
      class(campaign_progress_t), intent(inout) :: self
      integer :: i

      do i = 1, counts_of_rows
         self%counts(i) = sum_over_ranks(self%counts(i))
      end do
   end subroutine add_up

   !> The last word.
   subroutine finish(self, log)
      class(campaign_progress_t), intent(inout) :: self
      !> Log of the campaign
      type(log_t), intent(in) :: log

      if (self%on_terminal .and. .not. self%quiet) call show_on_terminal(achar(13)//repeat(' ', 100)//achar(13))
      ! The counts are those of all ranks now.
      self%done_elsewhere = 0_int64
      call write_progress(self, wall_seconds())
      call log%item('scenes', words(self, wall_seconds()))
   end subroutine finish

   !> How far, how fast, how long still, how many failures and doubts.
   function words(self, now) result(line)
      class(campaign_progress_t), intent(in) :: self
      real(dp), intent(in) :: now
      character(:), allocatable :: line
      integer(int64) :: done
      real(dp) :: rate

      done = self%counts(count_done) + self%done_elsewhere
      if (self%looked_at > 0_int64) then
         rate = real(self%looked_at, dp)/max(now - self%started, 1.0e-9_dp)
         line = integer_text(self%looked_at)//' of '//integer_text(self%scenes)//' looked at, none solved yet; '// &
                short_text(real(self%scenes - self%looked_at, dp)/rate, 2)//' s left to look'
         return
      end if
      rate = real(done, dp)/max(now - self%started, 1.0e-9_dp)
      line = integer_text(self%done_before + done)//' of '//integer_text(self%scenes)//', '// &
             short_text(rate, 3)//' a second'
      if (done > 0 .and. self%done_before + done < self%scenes) line = line//', '// &
         short_text(real(self%scenes - self%done_before - done, dp)/rate, 2)//' s left'
      line = line//', '//integer_text(self%counts(count_failed))//' failed'
      if (self%counts(count_tested) > 0) line = line//', '//integer_text(self%counts(count_uncertain))//' not verified'
   end function words

   !> File for watchers; where it cannot be written the campaign goes on.
   subroutine write_progress(self, now)
      class(campaign_progress_t), intent(inout) :: self
      real(dp), intent(in) :: now
      type(summary_t) :: summary
      type(error_t), allocatable :: ignored

      self%written = now
      call summary%add('scenes', self%scenes)
      call summary%add('scenes_done', self%done_before + self%counts(count_done) + self%done_elsewhere)
      if (self%looked_at > 0_int64) call summary%add('scenes_looked_at', self%looked_at)
      call summary%add('scenes_failed', self%counts(count_failed))
      call summary%add('seconds', now - self%started)
      call summary%add('scenes_per_second', real(self%counts(count_done) + self%done_elsewhere, dp)/ &
                       max(now - self%started, 1.0e-9_dp))
      call summary%write(self%path, ignored)
   end subroutine write_progress

end module campaign_progress
