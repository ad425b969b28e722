!> Interruption by a signal: the handler notes the signal, the loops look at the note.
!> SIGKILL excepted, nothing stops the program between two whole periods of a scene.
module signals
   use, intrinsic :: iso_c_binding, only: c_funloc, c_funptr, c_int, c_intptr_t, c_null_funptr
   implicit none(type, external)
   private

   integer(c_int), parameter :: signal_interrupt = 2, signal_user_1 = 10, signal_terminate = 15
   integer(c_int), parameter :: signal_broken_pipe = 13, signal_file_too_large = 25

   !> Module state is unavoidable here: a signal handler has no argument that could carry it.
   integer(c_int), volatile :: caught = 0

   public :: catch_signals, caught_signal

   interface
      function c_signal(number, handler) bind(c, name='signal') result(previous)
         import :: c_int, c_funptr
         integer(c_int), value :: number
         type(c_funptr), value :: handler
         type(c_funptr) :: previous
      end function c_signal
   end interface

contains

   !> Note SIGINT, SIGTERM and SIGUSR1 (the warning of batch systems) instead of dying of them. A terminal
   !> that nobody reads any more and a limit on the size of files are left to the calls that write.
   subroutine catch_signals()
      type(c_funptr) :: previous

      previous = c_signal(signal_interrupt, c_funloc(note_signal))
      previous = c_signal(signal_terminate, c_funloc(note_signal))
      previous = c_signal(signal_user_1, c_funloc(note_signal))
      ! SIG_IGN is the address 1.
      previous = c_signal(signal_broken_pipe, transfer(1_c_intptr_t, c_null_funptr))
      previous = c_signal(signal_file_too_large, transfer(1_c_intptr_t, c_null_funptr))
   end subroutine catch_signals

   !> Number of the first signal caught, 0 if none.
   integer function caught_signal()
      caught_signal = int(caught)
   end function caught_signal

   subroutine note_signal(number) bind(c)
      integer(c_int), value :: number

      if (caught == 0) caught = number
   end subroutine note_signal

end module signals
