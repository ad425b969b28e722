!> Number kinds, defined once for the whole program.
module kinds
   use, intrinsic :: iso_fortran_env, only: int32, int64, real64
   implicit none(type, external)
   private

   !> Real kind of every physical quantity: IEEE double precision.
   integer, parameter, public :: dp = real64
   public :: int32, int64

end module kinds
