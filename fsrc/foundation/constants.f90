!> Mathematical and physical constants.
module constants
   use kinds, only: dp
   implicit none(type, external)
   private

   real(dp), parameter, public :: pi = 3.141592653589793_dp
   real(dp), parameter, public :: half_pi = 0.5_dp*pi
   real(dp), parameter, public :: two_pi = 2.0_dp*pi

   !> Standard acceleration of free fall [m/s2].
   real(dp), parameter, public :: standard_gravity = 9.80665_dp

end module constants
