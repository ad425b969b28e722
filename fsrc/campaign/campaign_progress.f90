!> Progress of a campaign: one line on a terminal, a line every ten seconds at least elsewhere, and NAME.progress.nml for watchers.
module campaign_progress
   use, intrinsic :: iso_fortran_env, only: output_unit
   use clock, only: wall_seconds
   use errors, only: error_t
   use file_system, only: is_terminal
   use kinds, only: dp, int64
   use log_file, only: log_t
   use ranks, only: sum_over_ranks
   use summary_file, only: summary_t
   use text, only: integer_text, short_text
   implicit none(type, external)
   private

   !> What a thread takes at a time takes a few seconds: only then it is seen that a line is due [s]
   real(dp), parameter :: terminal_interval = 0.5_dp, line_interval = 6.0_dp, file_interval = 5.0_dp

   !> Progress so far. Threads add to the counts; each of them tells.
   type, public :: campaign_progress_t
      integer(int64) :: scenes = 0_int64, done_before = 0_int64, done = 0_int64, failed = 0_int64
      !> Scenes that other ranks have solved
      integer(int64), private :: done_elsewhere = 0_int64
      !> Scenes whose motion leaves what the model can mean, and whose harmonics no samples follow and no integrals could be had for
      integer(int64) :: beyond_model = 0_int64, undersampled = 0_int64
      !> Scenes whose class was put to the test, and those of them whose class does not stand
      integer(int64) :: tested = 0_int64, uncertain = 0_int64, irregular_so_far = 0_int64
      !> Scenes whose motions are known, and those of them that have several
      integer(int64) :: followed = 0_int64, several = 0_int64
      logical :: quiet = .false.
      character(:), allocatable :: path
      logical, private :: on_terminal = .false.
      real(dp), private :: started = 0.0_dp, told = 0.0_dp, written = 0.0_dp
   contains
      procedure :: start
      procedure :: add
      procedure :: is_due
      procedure :: tell
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
      self%quiet = quiet
      self%on_terminal = is_terminal()
      self%started = wall_seconds()
      self%told = self%started
      self%written = self%started
   end subroutine start

   !> Count solved scenes.
   subroutine add(self, done, failed, beyond_model, undersampled, tested, uncertain, irregular_so_far, followed, several)
      class(campaign_progress_t), intent(inout) :: self
      !> Scenes solved, and those of them that failed
      integer(int64), intent(in) :: done
      integer(int64), intent(in) :: failed
      !> Scenes that leave what the model can mean, and scenes whose harmonics are not resolved
      integer(int64), intent(in) :: beyond_model
      integer(int64), intent(in) :: undersampled
      !> Scenes whose class was put to the test, and those of them whose class does not stand
      integer(int64), intent(in) :: tested
      integer(int64), intent(in) :: uncertain
      !> and of those, or of all where none are, how many are irregular so far
      integer(int64), intent(in) :: irregular_so_far
      !> Scenes whose motions are known, and those of them that have several
      integer(int64), intent(in) :: followed
      integer(int64), intent(in) :: several

      !$omp atomic
      self%done = self%done + done
      !$omp atomic
      self%failed = self%failed + failed
      !$omp atomic
      self%beyond_model = self%beyond_model + beyond_model
      !$omp atomic
      self%undersampled = self%undersampled + undersampled
      !$omp atomic
      self%tested = self%tested + tested
      !$omp atomic
      self%uncertain = self%uncertain + uncertain
      !$omp atomic
      self%irregular_so_far = self%irregular_so_far + irregular_so_far
      !$omp atomic
      self%followed = self%followed + followed
      !$omp atomic
      self%several = self%several + several
   end subroutine add

   !> Whether it is time to tell.
   logical function is_due(self)
      class(campaign_progress_t), intent(in) :: self
      real(dp) :: now

      now = wall_seconds()
      !$omp critical (sentences)
      is_due = self%done_before + self%done < self%scenes .and. &
               (now - self%written > file_interval .or. &
                now - self%told >= merge(terminal_interval, line_interval, self%on_terminal))
      !$omp end critical (sentences)
   end function is_due

   !> Tell, if it is time to, and no other thread makes texts.
   subroutine tell(self, log, done)
      class(campaign_progress_t), intent(inout) :: self
      !> Log of the campaign
      type(log_t), intent(in) :: log
      !> Scenes that all ranks have done in all runs, where this is not the only rank
      integer(int64), intent(in), optional :: done
      real(dp) :: now

      now = wall_seconds()
      !$omp critical (sentences)
      if (present(done)) self%done_elsewhere = max(0_int64, done - self%done_before - self%done)
      if (now - self%written > file_interval) call write_progress(self, now)
      if (now - self%told >= merge(terminal_interval, line_interval, self%on_terminal)) call tell_line(self, log, now)
      !$omp end critical (sentences)
   end subroutine tell

   !> A line that is written over on a terminal, one more elsewhere.
   subroutine tell_line(self, log, now)
      class(campaign_progress_t), intent(inout) :: self
      type(log_t), intent(in) :: log
      real(dp), intent(in) :: now
      integer :: ignored

      self%told = now
      if (.not. self%on_terminal) then
         call log%line('  '//words(self, now))
      else if (.not. self%quiet) then
         write (output_unit, '(a)', advance='no', iostat=ignored) achar(13)//'  '//words(self, now)//'   '
         flush (output_unit, iostat=ignored)
      end if
   end subroutine tell_line

   !> Add up the counts of all ranks.
   subroutine add_up(self)
      class(campaign_progress_t), intent(inout) :: self

      self%done = sum_over_ranks(self%done)
      self%failed = sum_over_ranks(self%failed)
      self%beyond_model = sum_over_ranks(self%beyond_model)
      self%undersampled = sum_over_ranks(self%undersampled)
      self%tested = sum_over_ranks(self%tested)
      self%uncertain = sum_over_ranks(self%uncertain)
      self%irregular_so_far = sum_over_ranks(self%irregular_so_far)
      self%followed = sum_over_ranks(self%followed)
      self%several = sum_over_ranks(self%several)
   end subroutine add_up

   !> The last word.
   subroutine finish(self, log)
      class(campaign_progress_t), intent(inout) :: self
      !> Log of the campaign
      type(log_t), intent(in) :: log
      integer :: ignored

      if (self%on_terminal .and. .not. self%quiet) &
         write (output_unit, '(a)', advance='no', iostat=ignored) achar(13)//repeat(' ', 100)//achar(13)
      ! The counts are those of all ranks now.
      self%done_elsewhere = 0_int64
      call write_progress(self, wall_seconds())
      call log%line('  '//words(self, wall_seconds()))
   end subroutine finish

   !> How far, how fast, how long still, how many failures and doubts.
   function words(self, now) result(line)
      class(campaign_progress_t), intent(in) :: self
      real(dp), intent(in) :: now
      character(:), allocatable :: line
      integer(int64) :: done
      real(dp) :: rate

      done = self%done + self%done_elsewhere
      rate = real(done, dp)/max(now - self%started, 1.0e-9_dp)
      line = integer_text(self%done_before + done)//' of '//integer_text(self%scenes)//' scenes, '// &
             short_text(rate, 3)//' a second'
      if (done > 0 .and. self%done_before + done < self%scenes) line = line//', '// &
         short_text(real(self%scenes - self%done_before - done, dp)/rate, 2)//' s left'
      line = line//', '//integer_text(self%failed)//' failed'
      if (self%tested > 0) line = line//', '//integer_text(self%uncertain)//' not verified'
   end function words

   !> File for watchers; where it cannot be written the campaign goes on.
   subroutine write_progress(self, now)
      class(campaign_progress_t), intent(inout) :: self
      real(dp), intent(in) :: now
      type(summary_t) :: summary
      type(error_t), allocatable :: ignored

      self%written = now
      call summary%add('scenes', self%scenes)
      call summary%add('scenes_done', self%done_before + self%done + self%done_elsewhere)
      call summary%add('scenes_failed', self%failed)
      call summary%add('seconds', now - self%started)
      call summary%add('scenes_per_second', real(self%done + self%done_elsewhere, dp)/max(now - self%started, 1.0e-9_dp))
      call summary%write(self%path, ignored)
   end subroutine write_progress

end module campaign_progress
