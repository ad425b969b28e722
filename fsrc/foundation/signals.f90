!> Interruption by a signal, or by the end of the time that a piece of work may take: the handler notes it, the loops look
!> at the note.
module signals
   use, intrinsic :: iso_c_binding, only: c_funloc, c_funptr, c_int, c_intptr_t, c_null_funptr
   implicit none(type, external)
   private

   integer(c_int), parameter :: signal_hang_up = 1, signal_interrupt = 2, signal_user_1 = 10, signal_terminate = 15, &
                                signal_processor_time = 24
   integer(c_int), parameter :: signal_broken_pipe = 13, signal_alarm = 14, signal_file_too_large = 25
   !> SIG_IGN is the address 1.
   integer(c_intptr_t), parameter :: ignored = 1_c_intptr_t

   !> Module state is unavoidable here: a signal handler has no argument that could carry it.
   integer(c_int), volatile :: caught = 0
   logical, volatile :: time_is_up = .false.

   public :: catch_signals, caught_signal, limit_time, lift_time_limit, must_stop

   interface
      function c_signal(number, handler) bind(c, name='signal') result(previous)
         import :: c_int, c_funptr
         integer(c_int), value :: number
         type(c_funptr), value :: handler
         type(c_funptr) :: previous
      end function c_signal

      function c_alarm(seconds) bind(c, name='alarm') result(seconds_left)
         import :: c_int
         integer(c_int), value :: seconds
         integer(c_int) :: seconds_left
      end function c_alarm
   end interface

contains

   !> Note SIGINT, SIGTERM, SIGHUP (the terminal is gone), SIGXCPU (a limit of processor time) and SIGUSR1 (the warning of batch
   !> systems) instead of dying of them. A terminal that no one reads any more and a limit on the size of files are left to the
   !> calls that write.
   subroutine catch_signals()
      type(c_funptr) :: previous

      previous = c_signal(signal_interrupt, c_funloc(note_signal))
      previous = c_signal(signal_terminate, c_funloc(note_signal))
      previous = c_signal(signal_user_1, c_funloc(note_signal))
      previous = c_signal(signal_processor_time, c_funloc(note_signal))
      previous = c_signal(signal_hang_up, c_funloc(note_signal))
      ! What nohup has begun is to outlive the terminal.
      if (transfer(previous, ignored) == ignored) previous = c_signal(signal_hang_up, previous)
      previous = c_signal(signal_broken_pipe, transfer(ignored, c_null_funptr))
      previous = c_signal(signal_file_too_large, transfer(ignored, c_null_funptr))
   end subroutine catch_signals

   !> Number of the first signal caught, 0 if none.
   integer function caught_signal()
      caught_signal = int(caught)
   end function caught_signal

   !> Let what is done from here on take so many seconds: must_stop is true after them, until the limit is lifted.
   subroutine limit_time(seconds)
      !> Whole seconds, 1 or more
      integer, intent(in) :: seconds
      type(c_funptr) :: previous
      integer(c_int) :: seconds_left

      time_is_up = .false.
      previous = c_signal(signal_alarm, c_funloc(note_alarm))
      seconds_left = c_alarm(int(seconds, c_int))
   end subroutine limit_time

   !> No limit of time any more.
   subroutine lift_time_limit()
      integer(c_int) :: seconds_left

      seconds_left = c_alarm(0_c_int)
      time_is_up = .false.
   end subroutine lift_time_limit

   !> Whether the work under way must end here: after a signal, or when its time is up.
   logical function must_stop()
      must_stop = caught /= 0 .or. time_is_up
   end function must_stop

   subroutine note_signal(number) bind(c)
      integer(c_int), value :: number

      if (caught == 0) caught = number
   end subroutine note_signal

   subroutine note_alarm(number) bind(c)
      integer(c_int), value :: number

      if (number == signal_alarm) time_is_up = .true.
   end subroutine note_alarm

end module signals
