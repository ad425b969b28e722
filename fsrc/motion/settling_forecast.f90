!> Where a slowly settling motion will come to rest, from its states at the ends of the periods of the force.
!>
!> Near a motion that repeats after p periods the map of p periods is linear, and the differences of successive states
!> follow d_(n+1) = M d_n. Two of them span the plane of film and momentum; the third gives the characteristic polynomial of
!> M, lambda**2 - alpha lambda - beta, and with it the fixed point: x = x_n + (alpha d_n + beta (d_n + d_(n-1)))/(1 - alpha -
!> beta), minimal polynomial extrapolation (Cabay and Jackson 1976). Where the differences are parallel, because the motion
!> forgets all but one direction at once, lambda alone does (Aitken). It costs no period more.
!>
!> A forecast is no proof: the motion goes on from there, and repeats or not by its own states (module period_repetition);
!> if not, it goes back to where it was (module lane_integration). A forecast is made only where it is safe: multipliers inside
!> the unit circle, the same in two successive estimates, and a place that is near. So a motion that leaves an unstable one
!> is not led back to it.
module settling_forecast
   use kinds, only: dp
   use period_repetition, only: longer_every, longest_orbit, orbit_watch_t, state_of_age
   use taylor_step_control, only: film_weight
   implicit none(type, external)
   private

   !> Largest multiplier below which the motion settles fast enough by itself, and beyond which it may not settle at all.
   real(dp), parameter :: fast = 0.3_dp, slowest = 0.997_dp
   !> Largest difference of the states, relative to the film, that counts as near.
   real(dp), parameter :: near = 0.1_dp
   !> How far two estimates of a multiplier may differ, in units of its distance from 1.
   real(dp), parameter :: agreement = 0.2_dp
   !> Sine of the angle below which two differences are parallel.
   real(dp), parameter :: parallel = 0.02_dp

   public :: forecast_rest

contains

   !> The state in which the motion will come to rest.
   pure subroutine forecast_rest(watch, momentum_weight, orbit, film, momentum)
      !> The last states of the motion
      type(orbit_watch_t), intent(in) :: watch
      !> Film that a momentum of one counts as [-]
      real(dp), intent(in) :: momentum_weight
      !> Periods after which it will repeat; 0: there is no forecast to be trusted
      integer, intent(out) :: orbit
      !> Scaled film H and momentum V there [-]
      real(dp), intent(out) :: film
      real(dp), intent(out) :: momentum
      real(dp) :: older(2), rest(2), multiplier, older_multiplier, state(2), weight(2)
      integer :: periods, longest

      orbit = 0
      film = 0.0_dp
      momentum = 0.0_dp
      state = state_of_age(watch, 0)
      weight = [1.0_dp, momentum_weight]/film_weight(state(1))
      ! Longer orbits are looked for now and again: most motions do not have them.
      longest = merge(longest_orbit, 1, modulo(watch%count, longer_every) == 0)
      do periods = 1, longest
         if (watch%count < 3*periods + 2) return
         call settle(watch, weight, periods, 0, multiplier, rest)
         if (.not. (multiplier > fast .and. multiplier < slowest .and. maxval(abs(rest)) < near)) cycle
         call settle(watch, weight, periods, 1, older_multiplier, older)
         if (.not. abs(older_multiplier - multiplier) < agreement*(1.0_dp - multiplier)) cycle
         film = state(1) + rest(1)/weight(1)
         momentum = state(2) + rest(2)/weight(2)
         if (film > 0.0_dp) orbit = periods
         return
      end do
   end subroutine forecast_rest

   !> Largest multiplier of the map of one orbit, and how far its fixed point is from a state. Huge where there is none.
   pure subroutine settle(watch, weight, orbit, age, multiplier, rest)
      type(orbit_watch_t), intent(in) :: watch
      !> What film and momentum count
      real(dp), intent(in) :: weight(2)
      !> Periods of the orbit
      integer, intent(in) :: orbit
      !> Periods since the state
      integer, intent(in) :: age
      !> |lambda| [-]
      real(dp), intent(out) :: multiplier
      !> Weighted difference of the fixed point from the state [-]
      real(dp), intent(out) :: rest(2)
      real(dp) :: states(2, 0:3), a(2), b(2), c(2), across, alpha, beta, discriminant
      integer :: i

      do i = 0, 3
         states(:, i) = weight*state_of_age(watch, age + i*orbit)
      end do
      a = states(:, 2) - states(:, 3)
      b = states(:, 1) - states(:, 2)
      c = states(:, 0) - states(:, 1)
      multiplier = huge(1.0_dp)
      rest = huge(1.0_dp)
      if (max(maxval(abs(a)), maxval(abs(b))) > near .or. .not. maxval(abs(b)) > 0.0_dp) return
      across = cross(a, b)
      if (abs(across) > parallel*norm2(a)*norm2(b)) then
         alpha = cross(a, c)/across
         beta = cross(c, b)/across
         discriminant = 0.25_dp*alpha*alpha + beta
         if (discriminant < 0.0_dp) then
            multiplier = sqrt(-beta)
         else
            multiplier = 0.5_dp*abs(alpha) + sqrt(discriminant)
         end if
      else
         alpha = dot_product(b, c)/dot_product(b, b)
         beta = 0.0_dp
         multiplier = abs(alpha)
         if (norm2(c - alpha*b) > parallel*norm2(b)) multiplier = huge(1.0_dp)
      end if
      if (multiplier < slowest) rest = (alpha*c + beta*(b + c))/(1.0_dp - alpha - beta)
   end subroutine settle

   !> Area of the parallelogram of two vectors.
   pure real(dp) function cross(a, b)
      real(dp), intent(in) :: a(2)
      real(dp), intent(in) :: b(2)

      cross = a(1)*b(2) - a(2)*b(1)
   end function cross

end module settling_forecast
