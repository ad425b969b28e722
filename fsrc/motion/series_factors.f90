!> Factors that all Taylor series of a motion share.
module series_factors
   use constants, only: two_pi
   use kinds, only: dp
   use taylor_step_control, only: order
   implicit none(type, external)
   private

   integer :: i
   !> 1/k
   real(dp), parameter, public :: inverse(order) = [(1.0_dp/real(i, dp), i=1, order)]
   !> Coefficient k-1 of cos(2 pi x) about any x0, over k, is wave(k) times cos (k odd) or sin (k even) of 2
   !> pi x0.
   real(dp), parameter, public :: wave(order) = &
      [(merge(1.0_dp, -1.0_dp, mod(i, 4) < 2)*two_pi**(i - 1)/gamma(real(i + 1, dp)), i=1, order)]

end module series_factors
