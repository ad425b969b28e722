!> Log of a scene: every line goes to the terminal and to NAME.log alike.
module log_file
   use, intrinsic :: iso_fortran_env, only: output_unit
   use errors, only: error_t, exit_system, raise
   implicit none(type, external)
   private

   !> First word of every log, by which one is known.
   character(*), parameter, public :: log_magic = 'rattle '

   !> An open log.
   type, public :: log_t
      private
      integer :: unit = -1
      logical :: to_terminal = .true.
   contains
      procedure :: open => open_log
      procedure :: line => log_line
      procedure :: close => close_log
   end type log_t

contains

   !> Open a log; one that stands there is replaced.
   subroutine open_log(self, path, quiet, error)
      class(log_t), intent(inout) :: self
      !> Path of the log
      character(*), intent(in) :: path
      !> Nothing to the terminal
      logical, intent(in) :: quiet
      !> Set if the log cannot be written
      type(error_t), allocatable, intent(out) :: error
      character(200) :: message
      integer :: stat

      self%to_terminal = .not. quiet
      open (newunit=self%unit, file=path, status='replace', action='write', iostat=stat, iomsg=message)
      if (stat == 0) return
      self%unit = -1
      call raise(error, exit_system, path//' cannot be written: '//trim(message))
   end subroutine open_log

   !> Write a line.
   subroutine log_line(self, text)
      class(log_t), intent(in) :: self
      !> The line
      character(*), intent(in) :: text
      integer :: ignored

      if (self%to_terminal) write (output_unit, '(a)', iostat=ignored) text
      if (self%unit == -1) return
      write (self%unit, '(a)', iostat=ignored) text
      flush (self%unit, iostat=ignored)
   end subroutine log_line

   !> Close the log.
   subroutine close_log(self)
      class(log_t), intent(inout) :: self
      integer :: ignored

      if (self%unit /= -1) close (self%unit, iostat=ignored)
      self%unit = -1
   end subroutine close_log

end module log_file
