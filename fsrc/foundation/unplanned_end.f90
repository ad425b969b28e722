!> Libraries end the program on their own where the system refuses them something, a thread or memory, say: they say why, with an
!> exit code that means something else here. Then the program has the last word.
module unplanned_end
   use, intrinsic :: iso_c_binding, only: c_funloc, c_funptr, c_int
   use errors, only: exit_system
   use text_output, only: put_error_line
   implicit none(type, external)
   private

   !> Module state is unavoidable here: what is called at the end has no argument that could carry it.
   logical, volatile :: is_planned = .true.

   public :: watch_end, plan_end

   interface
      function c_atexit(handler) bind(c, name='atexit') result(stat)
         import :: c_funptr, c_int
         type(c_funptr), value :: handler
         integer(c_int) :: stat
      end function c_atexit

      subroutine c_end_at_once(exit_code) bind(c, name='_exit')
         import :: c_int
         integer(c_int), value :: exit_code
      end subroutine c_end_at_once
   end interface

contains

   !> Take every end from here on as that of a library, until plan_end is called.
   subroutine watch_end()
      is_planned = c_atexit(c_funloc(note_end)) /= 0
   end subroutine watch_end

   !> The program ends now, with its own exit code.
   subroutine plan_end()
      is_planned = .true.
   end subroutine plan_end

   subroutine note_end() bind(c)
      if (is_planned) return
      call put_error_line('the system refused what the program needs, see the line above; what was not finished can be run '// &
                          'again with --resume')
      call c_end_at_once(int(exit_system, c_int))
   end subroutine note_end

end module unplanned_end
