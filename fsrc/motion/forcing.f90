!> The force on the loose gear, (34).
module forcing
   use elementary_functions, only: cosine_sine
   use kinds, only: dp
   implicit none(type, external)
   private

   public :: applied_force, force_of_period, cosines_of_period

contains

   !> F = Q + F0 cos(2 pi phase) [N] at a phase from 0 to 1 period of the force.
   elemental real(dp) function applied_force(steady_force, amplitude, phase)
      !> Steady force Q [N]
      real(dp), intent(in) :: steady_force
      !> Amplitude F0 [N]
      real(dp), intent(in) :: amplitude
      !> f_exc t [-]
      real(dp), intent(in) :: phase
      real(dp) :: cosine, sine

      call cosine_sine(phase, cosine, sine)
      applied_force = steady_force + amplitude*cosine
   end function applied_force

   !> Force at the end of every step of a period; it repeats from period to period to the last bit.
   pure subroutine force_of_period(steady_force, amplitude, force)
      !> Steady force Q [N]
      real(dp), intent(in) :: steady_force
      !> Amplitude F0 [N]
      real(dp), intent(in) :: amplitude
      !> Force at phases 1/n, 2/n, ... 1 [N]
      real(dp), intent(out) :: force(:)
      integer :: i

      do i = 1, size(force)
         force(i) = applied_force(steady_force, amplitude, real(i, dp)/real(size(force), dp))
      end do
   end subroutine force_of_period

   !> cos(2 pi phase) at the end of every step of a period.
   pure subroutine cosines_of_period(cosines)
      !> Cosine at phases 1/n, 2/n, ... 1 [-]
      real(dp), intent(out) :: cosines(:)

      call force_of_period(0.0_dp, 1.0_dp, cosines)
   end subroutine cosines_of_period

end module forcing
