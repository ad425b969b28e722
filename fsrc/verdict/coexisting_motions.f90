!> All motions of one operating point that its starts have led to, and which of them shakes most and least.
module coexisting_motions
   use kinds, only: dp
   implicit none(type, external)
   private

   !> One of them.
   type, public :: told_motion_t
      !> Code of its class
      integer :: class = 0
      !> Periods of the force after which it repeats; 0: it does not
      integer :: period = 0
      !> Numbers of its state at the start of a period of the force, from which it is the same motion again
      real(dp), allocatable :: state(:)
      !> Modulus of its largest Floquet multiplier; negative: unknown
      real(dp) :: floquet_modulus = -1.0_dp
      !> Starts that lead to it, and whether that of the scene is one of them
      integer :: starts = 0
      logical :: from_own_start = .false.
      !> Acceleration rms [m/s2], film force rms [N] and least film [m]
      real(dp) :: acceleration_rms = 0.0_dp
      real(dp) :: film_force_rms = 0.0_dp
      real(dp) :: film_minimum = 0.0_dp
   end type told_motion_t

   !> All of them.
   type, public :: coexisting_motions_t
      !> That of the scene first; not allocated: nothing is known of others
      type(told_motion_t), allocatable :: motions(:)
      !> Starts whose motions were solved, and those of them that did not settle on one that repeats
      integer :: starts_solved = 0
      integer :: unsettled_starts = 0
      !> Starts among those that settled whose film and velocity were drawn
      integer :: drawn_starts = 0
      !> Why there is one start only, as of one_start_reason
      integer :: one_start_reason = 0
   end type coexisting_motions_t

   public :: loudest_motion, quietest_motion

contains

   !> Place of the motion with the largest acceleration rms; 0: none is known.
   pure integer function loudest_motion(coexisting) result(place)
      type(coexisting_motions_t), intent(in) :: coexisting

      place = 0
      if (allocated(coexisting%motions)) place = maxloc(coexisting%motions%acceleration_rms, dim=1)
   end function loudest_motion

   !> Place of the motion with the smallest acceleration rms; 0: none is known.
   pure integer function quietest_motion(coexisting) result(place)
      type(coexisting_motions_t), intent(in) :: coexisting

      place = 0
      if (allocated(coexisting%motions)) place = minloc(coexisting%motions%acceleration_rms, dim=1)
   end function quietest_motion

end module coexisting_motions
