!> The force on the loose gear, (34): F = Q + F0 cos(2 pi x), where x = f_exc t counts time in periods.
!>
!> All that a force is stands here and, scaled for the lanes of a block, in module lane_force. A phase stands on
!> the unit circle at exp(2 pi i x), from whose powers every harmonic of a force follows.
module force
   use elementary_functions, only: cosine_sine
   use kinds, only: dp
   use scene_types, only: load_t
   implicit none(type, external)
   private

   !> A force that repeats.
   type, public :: force_t
      !> Steady part Q [N]
      real(dp) :: steady = 0.0_dp
      !> Amplitude F0 of the part that oscillates [N]
      real(dp) :: amplitude = 0.0_dp
   end type force_t

   public :: force_of, force_at, force_on_circle, force_of_period, largest_oscillation

contains

   !> The force of a scene.
   elemental type(force_t) function force_of(load)
      !> Group &load of the scene
      type(load_t), intent(in) :: load

      force_of = force_t(steady=load%steady_force, amplitude=load%force_amplitude)
   end function force_of

   !> Force at a phase [N].
   elemental real(dp) function force_at(force, phase)
      !> The force
      type(force_t), intent(in) :: force
      !> From 0 to 1 [periods]
      real(dp), intent(in) :: phase
      real(dp) :: cosine, sine

      call cosine_sine(phase, cosine, sine)
      force_at = force_on_circle(force, cmplx(cosine, sine, dp))
   end function force_at

   !> Force where a phase stands on the unit circle [N].
   elemental real(dp) function force_on_circle(force, point)
      !> The force
      type(force_t), intent(in) :: force
      !> exp(2 pi i x)
      complex(dp), intent(in) :: point

      force_on_circle = force%steady + force%amplitude*point%re
   end function force_on_circle

   !> Force at the end of every step of a period; it repeats from period to period to the last bit.
   pure subroutine force_of_period(force, values)
      !> The force
      type(force_t), intent(in) :: force
      !> At phases 1/n, 2/n, ... 1 [N]
      real(dp), intent(out) :: values(:)
      integer :: i

      do i = 1, size(values)
         values(i) = force_at(force, real(i, dp)/real(size(values), dp))
      end do
   end subroutine force_of_period

   !> Bound of the part that oscillates [N].
   elemental real(dp) function largest_oscillation(force)
      !> The force
      type(force_t), intent(in) :: force

      largest_oscillation = abs(force%amplitude)
   end function largest_oscillation

end module force
