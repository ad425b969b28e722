!> Progress of a motion, or of a sweep of motions: on a terminal one line that is written over, elsewhere a timed line now and then.
module progress
   use clock, only: wall_seconds
   use file_system, only: is_terminal
   use engine, only: motion_watcher_t
   use kinds, only: dp
   use log_file, only: labelled, log_t
   use text, only: integer_text, short_text
   use text_output, only: has_turn, lock_texts, show_on_terminal, unlock_texts
   implicit none(type, external)
   private

   real(dp), parameter :: terminal_interval = 0.2_dp, line_interval = 10.0_dp

   !> Watcher of a motion.
   type, extends(motion_watcher_t), public :: progress_t
      private
      type(log_t), pointer :: log => null()
      !> What is counted
      character(:), allocatable :: unit
      logical :: quiet = .false., on_terminal = .false., shown = .false.
      real(dp) :: started = 0.0_dp, last = 0.0_dp
   contains
      procedure :: start => start_progress
      procedure :: period_done
      procedure :: clear => clear_progress
   end type progress_t

   public :: progress_words

contains

   !> Begin to watch.
   subroutine start_progress(self, log, unit, quiet)
      class(progress_t), intent(inout) :: self
      type(log_t), target, intent(in) :: log
      !> What is counted, one and many: 'periods'
      character(*), intent(in) :: unit
      !> Nothing to the terminal
      logical, intent(in) :: quiet

      self%log => log
      self%unit = unit
      self%quiet = quiet
      self%on_terminal = is_terminal()
      self%started = wall_seconds()
      self%last = self%started
   end subroutine start_progress

   !> A period is done. The thread that reports it computes.
   subroutine period_done(self, done, all)
      class(progress_t), intent(inout) :: self
      !> Periods solved
      integer, intent(in) :: done
      !> Periods asked for
      integer, intent(in) :: all
      character(:), allocatable :: line
      real(dp) :: now

      now = wall_seconds()
      if (now - self%last < merge(terminal_interval, line_interval, self%on_terminal)) return
      self%last = now
      call lock_texts()
      line = labelled(self%unit, progress_words(done, all, now - self%started))
      if (.not. self%on_terminal) then
         call self%log%line(line)
      else if (.not. self%quiet .and. has_turn()) then
         call show_on_terminal(achar(13)//line//'    ')
         self%shown = .true.
      end if
      call unlock_texts()
   end subroutine period_done

   !> How far a run is, and how long it takes still.
   pure function progress_words(done, all, seconds) result(words)
      !> What is solved, and what will be
      integer, intent(in) :: done
      integer, intent(in) :: all
      !> Since the run began [s]
      real(dp), intent(in) :: seconds
      character(:), allocatable :: words

      words = integer_text(done)//' of '//integer_text(all)//' after '//short_text(seconds, 3)//' s, '// &
              short_text(seconds*real(all - done, dp)/real(done, dp), 2)//' s left'
   end function progress_words

   !> Wipe the line on the terminal.
   subroutine clear_progress(self)
      class(progress_t), intent(inout) :: self

      if (self%shown) call show_on_terminal(achar(13)//repeat(' ', 72)//achar(13))
      self%shown = .false.
   end subroutine clear_progress

end module progress
