!> The registers of the processor that is compiled for: half a block of lanes.
module register_width
   implicit none(type, external)
   private

   !> Whether one register holds half a block.
   logical, parameter, public :: wide_registers = .true.

end module register_width
