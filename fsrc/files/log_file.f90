!> Log of a scene. A line goes to the terminal and to NAME.log alike, as does an item, a line with a label. A detail goes to the
!> terminal only where all of the log is wanted there, and a row, which says in short what details say, only where not.
module log_file
   use, intrinsic :: iso_c_binding, only: c_int
   use errors, only: error_t, error_words, exit_system, last_error, raise
   use file_descriptor, only: close_descriptor, open_existing, open_new, read_and_write
   use file_system, only: delete_file, file_state_t, stands_at, state_of_path
   use output_lock, only: expect_own_lock, runs_without_locks
   use text_output, only: lost_text, note_lost_text, put_error_line, put_line, write_line
   implicit none(type, external)
   private

   !> First word of every log, by which one is known.
   character(*), parameter, public :: log_magic = 'rattle '
   public :: labelled

   !> Width of the column of labels
   integer, parameter :: label_width = 17

   !> An open log.
   type, public :: log_t
      private
      integer(c_int) :: descriptor = -1_c_int
      character(:), allocatable :: path
      logical :: to_terminal = .true., verbose = .false.
   contains
      procedure :: open => open_log
      procedure :: line => log_line
      procedure :: item => log_item
      procedure :: detail => log_detail
      procedure :: row => log_row
      procedure :: close => close_log
   end type log_t

contains

   !> Open a log; one that stands there is replaced.
   subroutine open_log(self, path, quiet, error, verbose)
      class(log_t), intent(inout) :: self
      !> Path of the log
      character(*), intent(in) :: path
      !> Nothing to the terminal
      logical, intent(in) :: quiet
      !> Set if the log cannot be written
      type(error_t), allocatable, intent(out) :: error
      !> Details to the terminal as well, instead of rows; absent: no
      logical, intent(in), optional :: verbose
      type(file_state_t) :: state

      self%to_terminal = .not. quiet
      if (present(verbose)) self%verbose = verbose
      self%path = path
      ! Where there are no locks the log that stands there may be that of a run that began later.
      call expect_own_lock(path(:index(path, '.log', back=.true.) - 1), error)
      if (allocated(error)) return
      state = state_of_path(path)
      if (state%exists .and. .not. state%is_file) then
         ! A log that is led to a device: the device stays.
         self%descriptor = open_existing(path, read_and_write)
      else
         ! One that stands there is not written into: it could bear another name elsewhere.
         call delete_file(path)
         self%descriptor = open_new(path)
      end if
      if (self%descriptor < 0_c_int) call raise(error, exit_system, path//' cannot be written: '//error_words(last_error()))
   end subroutine open_log

   !> Write a line. Where one was lost none follows: a log is known by its first line.
   subroutine log_line(self, text)
      class(log_t), intent(in) :: self
      !> The line
      character(*), intent(in) :: text

      if (self%to_terminal) call put_line(text)
      call write_to_file(self, text)
   end subroutine log_line

   !> Write a line with a label.
   subroutine log_item(self, label, text)
      class(log_t), intent(in) :: self
      !> What the line shows; empty for what belongs to the line before
      character(*), intent(in) :: label
      !> The value with its unit
      character(*), intent(in) :: text

      call self%line(labelled(label, text))
   end subroutine log_item

   !> Write a line that the terminal has where all is wanted there.
   subroutine log_detail(self, text)
      class(log_t), intent(in) :: self
      !> The line
      character(*), intent(in) :: text

      if (self%to_terminal .and. self%verbose) call put_line(text)
      call write_to_file(self, text)
   end subroutine log_detail

   !> Show a row of the short report.
   subroutine log_row(self, label, text)
      class(log_t), intent(in) :: self
      !> What the row shows; empty for what belongs to the row before
      character(*), intent(in) :: label
      !> The value with its unit
      character(*), intent(in) :: text

      if (self%to_terminal .and. .not. self%verbose) call put_line(labelled(label, text))
   end subroutine log_row

   !> A line with a label: all labels stand in one column.
   pure function labelled(label, text) result(line)
      !> What the line shows; empty for what belongs to the line before
      character(*), intent(in) :: label
      !> What stands beside it
      character(*), intent(in) :: text
      character(:), allocatable :: line

      line = '  '//label//repeat(' ', label_width - len(label))//text
   end function labelled

   subroutine write_to_file(self, text)
      class(log_t), intent(in) :: self
      character(*), intent(in) :: text

      if (self%descriptor >= 0_c_int .and. lost_text() /= self%path) call write_line(self%descriptor, text, self%path)
   end subroutine write_to_file

   !> Close the log. One that lost its first word is taken away: no later run could see that it was a log.
   subroutine close_log(self)
      class(log_t), intent(inout) :: self
      type(file_state_t) :: state
      logical :: closed, stands

      if (self%descriptor < 0_c_int) return
      stands = stands_at(self%descriptor, self%path)
      state = state_of_path(self%path)
      if (.not. stands .and. state%exists .and. runs_without_locks()) then
         ! A run that loses may have begun its log a moment after that of the winner: the results are sound all the same.
         call put_error_line('warning: '//self%path//' was replaced by that of another run')
      else if (.not. stands) then
         call note_lost_text(self%path)
      end if
      call close_descriptor(self%descriptor, closed)
      if (.not. closed) call note_lost_text(self%path)
      self%descriptor = -1_c_int
      if (stands .and. state%is_file .and. state%bytes < len(log_magic)) call delete_file(self%path)
   end subroutine close_log

end module log_file
