!> Lines of text to standard output and to logs, and whether they have reached their readers: a full disk takes a log or a
!> template as it takes a result. (The runtime reports no failure where it flushes a unit.) What works that go on side by side
!> print reaches the standard output in their order: the first of them speaks, the others are kept waiting.
module text_output
   use, intrinsic :: iso_c_binding, only: c_int
   use file_descriptor, only: standard_error, standard_output, write_bytes
   use kinds, only: int64
   use word_list, only: word_t
   use, intrinsic :: omp_lib, only: omp_destroy_nest_lock, omp_init_nest_lock, omp_nest_lock_kind, omp_set_nest_lock, &
      omp_unset_nest_lock
   implicit none(type, external)
   private

   !> Module state is unavoidable here: the standard output is one for all, and its fate is asked for at the end.
   character(:), allocatable :: lost
   !> What each work has reported before its turn, whose turn it is (0: works do not share the output), and which work this thread
   !> does
   type(word_t), allocatable :: waiting(:)
   integer :: turn = 0, own = 0
   !> Whether works share the output: it changes only while one thread is at work, the turn while that thread holds the lock
   logical :: shared = .false.
   !$omp threadprivate(own)
   !> Held by the thread that makes texts: gfortran keeps the length of a text that a function allocates for all threads
   integer(omp_nest_lock_kind) :: text_lock

   public :: put_text, put_line, put_error_line, show_on_terminal, write_line, note_lost_text, lost_text, share_output, &
             speak_for, end_turn, has_turn, lock_texts, unlock_texts

contains

   !> Text to standard output, as it stands.
   subroutine put_text(text)
      character(*), intent(in) :: text

      call lock_texts()
      if (has_turn()) then
         call write_text(standard_output, text, 'the standard output')
      else
         waiting(own)%text = waiting(own)%text//text
      end if
      call unlock_texts()
   end subroutine put_text

   !> Let works go on side by side, each on a thread. The first has its turn to report. A thread makes texts only between lock_texts
   !> and unlock_texts, one at a time.
   subroutine share_output(works)
      !> How many, 0: no more
      integer, intent(in) :: works
      integer :: i

      if (shared) call omp_destroy_nest_lock(text_lock)
      shared = works > 0
      if (shared) call omp_init_nest_lock(text_lock)
      if (allocated(waiting)) deallocate (waiting)
      waiting = [(word_t(''), i=1, works)]
      turn = min(works, 1)
   end subroutine share_output

   !> Wait until no other thread makes texts. May be called again by the thread that does.
   subroutine lock_texts()
      if (shared) call omp_set_nest_lock(text_lock)
   end subroutine lock_texts

   !> Let other threads make texts.
   subroutine unlock_texts()
      if (shared) call omp_unset_nest_lock(text_lock)
   end subroutine unlock_texts

   !> What this thread reports from here on is reported for a work.
   subroutine speak_for(work)
      !> From 1, 0: for none
      integer, intent(in) :: work

      own = work
   end subroutine speak_for

   !> The work whose turn it is has reported all: that of the next one comes, first of all what it has reported by now.
   subroutine end_turn()
      call lock_texts()
      turn = turn + 1
      if (turn <= size(waiting)) call write_text(standard_output, waiting(turn)%text, 'the standard output')
      call unlock_texts()
   end subroutine end_turn

   !> Whether what this thread prints goes out at once. Asked between lock_texts and unlock_texts: otherwise the turn may pass
   !> meanwhile.
   logical function has_turn()
      has_turn = own == turn
   end function has_turn

   !> A line to standard output.
   subroutine put_line(text)
      character(*), intent(in) :: text

      call put_text(text//new_line('a'))
   end subroutine put_line

   !> A line to standard error. Where no one reads there, the exit code has to do.
   subroutine put_error_line(text)
      character(*), intent(in) :: text
      logical :: ignored

      call write_bytes(standard_error, len(text, kind=int64) + 1_int64, text//new_line('a'), ignored)
   end subroutine put_error_line

   !> Text to a terminal, which later text writes over.
   subroutine show_on_terminal(text)
      character(*), intent(in) :: text
      logical :: ignored

      call write_bytes(standard_output, len(text, kind=int64), text, ignored)
   end subroutine show_on_terminal

   !> A line to an open file.
   subroutine write_line(descriptor, text, path)
      integer(c_int), intent(in) :: descriptor
      character(*), intent(in) :: text
      character(*), intent(in) :: path

      call write_text(descriptor, text//new_line('a'), path)
   end subroutine write_line

   subroutine write_text(descriptor, text, path)
      integer(c_int), intent(in) :: descriptor
      character(*), intent(in) :: text
      character(*), intent(in) :: path
      logical :: complete

      call write_bytes(descriptor, len(text, kind=int64), text, complete)
      if (.not. complete) call note_lost_text(path)
   end subroutine write_text

   !> Note that words could not be written.
   subroutine note_lost_text(place)
      !> Where they should have gone
      character(*), intent(in) :: place

      if (.not. allocated(lost)) lost = place
   end subroutine note_lost_text

   !> Where words were lost first; empty if all that was reported has been written.
   pure function lost_text() result(place)
      character(:), allocatable :: place

      place = ''
      if (allocated(lost)) place = lost
   end function lost_text

end module text_output
