!> Memory is asked for at once, before anything is computed whose arrays follow in size from the input: a lack of it is an error
!> with a sentence then, and not the end of the program somewhere in the middle.
module memory
   use, intrinsic :: iso_c_binding, only: c_int, c_intptr_t, c_loc, c_long, c_ptr
   use errors, only: error_t, exit_bad_input, exit_system, raise
   use kinds, only: dp, int64
   use text, only: integer_text, short_text
   implicit none(type, external)
   private

   !> What a run takes beside the arrays that are counted [bytes]. Beyond 32 MB glibc gives every such array a mapping of its
   !> own and learns nothing from it, so that asking changes nothing for what follows.
   real(dp), parameter :: margin = 48.0e6_dp

   public :: expect_memory, allocate_lines

   interface
      function c_sysconf(name) bind(c, name='sysconf') result(value)
         import :: c_int, c_long
         integer(c_int), value :: name
         integer(c_long) :: value
      end function c_sysconf
   end interface

contains

   !> See that there is memory for a purpose. What no memory of this machine holds is an error of the input, what the system
   !> does not give one of the system.
   subroutine expect_memory(bytes, purpose, error)
      !> What it takes [bytes]
      real(dp), intent(in) :: bytes
      !> What it is, with the keys that make it as large as it is; begins a sentence
      character(*), intent(in) :: purpose
      !> Set if there is not so much memory
      type(error_t), allocatable, intent(out) :: error
      character(1), allocatable, volatile :: room(:)
      real(dp) :: machine
      integer :: stat

      machine = machine_memory()
      if (machine > 0.0_dp .and. bytes > machine) then
         call raise(error, exit_bad_input, purpose//' would take '//size_text(bytes)//' of memory; this machine has '// &
                    size_text(machine))
         return
      end if
      allocate (room(int(bytes + margin, int64)), stat=stat)
      if (stat /= 0) call raise(error, exit_system, 'out of memory: '//purpose//' may take '//size_text(bytes)// &
                                ' beside the '//size_text(margin)//' of the program, more than the system provides')
   end subroutine expect_memory

   !> Memory of this machine [bytes], 0 if it is not known.
   real(dp) function machine_memory()
      !> Names of glibc
      integer(c_int), parameter :: page_bytes = 30, physical_pages = 85

      machine_memory = max(0.0_dp, real(c_sysconf(page_bytes), dp))*max(0.0_dp, real(c_sysconf(physical_pages), dp))
   end function machine_memory

   !> A number of bytes in words.
   pure function size_text(bytes) result(words)
      real(dp), intent(in) :: bytes
      character(:), allocatable :: words

      if (bytes < 1.0e9_dp) then
         words = integer_text(ceiling(bytes*1.0e-6_dp))//' MB'
      else
         words = short_text(bytes*1.0e-9_dp, 3)//' GB'
      end if
   end function size_text

   !> Allocate memory for a variable that is to start with a cache line. Registers as wide as a line are loaded and stored at half
   !> the speed from anywhere else, and no compiler aligns what a procedure keeps on the stack to more than it has to.
   subroutine allocate_lines(bits, room, place)
      !> `storage_size` of the variable [bits]
      integer, intent(in) :: bits
      !> Memory that holds it, and lives as long as it is used
      real(dp), allocatable, target, intent(out) :: room(:)
      !> Its address
      type(c_ptr), intent(out) :: place
      integer, parameter :: line_bytes = 64, number_bytes = storage_size(1.0_dp)/8, line = line_bytes/number_bytes
      integer :: skipped

      allocate (room(bits/storage_size(1.0_dp) + 1 + line))
      skipped = int(modulo(-transfer(c_loc(room), 1_c_intptr_t), int(line_bytes, c_intptr_t)))/number_bytes
      place = c_loc(room(1 + skipped))
   end subroutine allocate_lines

end module memory
