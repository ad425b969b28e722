!> Small motions of teeth that give about their rest. With the stiffnesses K and dampings C of the films, and kappa of the springs,
!>
!>     z' = v ,   m kappa v' = d_1 - d_2 ,
!>     C_1 (v + d_1') = -K_1 (z + d_1) - d_1/kappa ,    C_2 (-v + d_2') = -K_2 (d_2 - z) - d_2/kappa ,
!>
!> whose eigenvalues, for one flank, are the roots of m C s^3 + m (k + K) s^2 + k C s + k K = 0.
module linear_motion
   use constants, only: two_pi
   use film_law, only: film_load, steady_film
   use kinds, only: dp
   use matrix_values, only: eigenvalues
   use problem, only: has_two_flanks, loads_at_rest, problem_t, static_load
   implicit none(type, external)
   private

   public :: natural_motion

contains

   !> Natural frequency and damping ratio of the pair of eigenvalues that swings, or where none does of the two slowest ones.
   !> Both are 0 where no eigenvalues are found.
   pure subroutine natural_motion(problem, natural_frequency, damping_ratio)
      !> With teeth that give, and a film at rest
      type(problem_t), intent(in) :: problem
      !> Size of the eigenvalues over 2 pi [Hz]
      real(dp), intent(out) :: natural_frequency
      !> Minus the real part over the size [-]
      real(dp), intent(out) :: damping_ratio
      real(dp), dimension(2) :: loads, stiffness, damping
      real(dp) :: matrix(4, 4), rate
      complex(dp), allocatable :: values(:)
      complex(dp) :: slow(2)
      integer :: flanks, flank, n, i

      loads = [static_load(problem), 0.0_dp]
      if (has_two_flanks(problem)) call loads_at_rest(problem, static_load(problem), loads(1), loads(2))
      flanks = merge(2, 1, has_two_flanks(problem))
      do flank = 1, flanks
         call slopes_at_rest(loads(flank), stiffness(flank), damping(flank))
      end do
      n = 2 + flanks
      matrix = 0.0_dp
      ! Time in units of the gear on one spring: then no number of the matrix is far from one for its physics alone.
      rate = 1.0_dp/sqrt(problem%mass*problem%compliance)
      matrix(1, 2) = 1.0_dp
      do flank = 1, flanks
         associate (turn => real(3 - 2*flank, dp), own => 2 + flank)
            matrix(2, own) = turn
            matrix(own, 1) = -turn*stiffness(flank)/(damping(flank)*rate)
            matrix(own, 2) = -turn
            matrix(own, own) = -(stiffness(flank) + 1.0_dp/problem%compliance)/(damping(flank)*rate)
         end associate
      end do
      allocate (values, source=eigenvalues(matrix(:n, :n)))
      natural_frequency = 0.0_dp
      damping_ratio = 0.0_dp
      if (size(values) == 0) return
      values = values*cmplx(rate, 0.0_dp, dp)
      i = minloc(-values%re/abs(values), dim=1, mask=abs(values%im) > 0.0_dp)
      if (i > 0) then
         natural_frequency = abs(values(i))/two_pi
         damping_ratio = -values(i)%re/abs(values(i))
      else
         ! The largest stand first.
         slow = values(n - 1:)
         natural_frequency = sqrt(slow(1)%re*slow(2)%re)/two_pi
         damping_ratio = -(slow(1)%re + slow(2)%re)/(2.0_dp*two_pi*natural_frequency)
      end if

   contains

      !> K [N/m] and C [N s/m] of a film at rest.
      pure subroutine slopes_at_rest(carried, film_stiffness, film_damping)
         !> Its load [N]
         real(dp), intent(in) :: carried
         real(dp), intent(out) :: film_stiffness
         real(dp), intent(out) :: film_damping
         real(dp) :: load, by_film, by_velocity

         call film_load(problem%film, steady_film(problem%film, carried), 0.0_dp, load, by_film, by_velocity)
         film_stiffness = -by_film
         film_damping = -by_velocity
      end subroutine slopes_at_rest

   end subroutine natural_motion

end module linear_motion
