!> Memory that starts with a cache line. Registers as wide as a line are loaded and stored at half the speed from anywhere else,
!> and no compiler aligns what a procedure keeps on the stack to more than it has to.
module aligned_memory
   use, intrinsic :: iso_c_binding, only: c_intptr_t, c_loc, c_ptr
   use kinds, only: dp
   implicit none(type, external)
   private

   integer, parameter :: line_bytes = 64

   public :: allocate_lines

contains

   !> Allocate memory for a variable that is to start with a cache line.
   subroutine allocate_lines(bits, room, place)
      !> `storage_size` of the variable [bits]
      integer, intent(in) :: bits
      !> Memory that holds it, and lives as long as it is used
      real(dp), allocatable, target, intent(out) :: room(:)
      !> Its address
      type(c_ptr), intent(out) :: place
      integer, parameter :: number_bytes = storage_size(1.0_dp)/8, line = line_bytes/number_bytes
      integer :: skipped

      allocate (room(bits/storage_size(1.0_dp) + 1 + line))
      skipped = int(modulo(-transfer(c_loc(room), 1_c_intptr_t), int(line_bytes, c_intptr_t)))/number_bytes
      place = c_loc(room(1 + skipped))
   end subroutine allocate_lines

end module aligned_memory
