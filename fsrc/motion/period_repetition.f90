!> Tells when a motion repeats, from its states at the ends of the periods of the force.
!>
!> The states x_n follow from one another by one map, the same for every period. With d_n the distance of x_n from
!> x_(n-p), and q a bound of the ratios of successive d, the motion is still
!>
!>     d_(n+p) + d_(n+2p) + ... <= d_n q/(1 - q)
!>
!> away from the one that repeats after p periods. It counts as repeating once that is below the tolerance. A small
!> d_n alone proves nothing: a film that rises ever more slowly for hundreds of periods has q near one, and its
!> bound stays large. q is the largest ratio of several; a single small one may be chance, as a state computed with
!> one step more than the one before is off by up to the accuracy.
module period_repetition
   use kinds, only: dp
   use taylor_step_control, only: film_weight, free_rate
   implicit none (type, external)
   private

   !> Longest period that is looked for [periods of the force]
   integer, parameter, public :: longest_orbit = 8

   !> Three orbits: two distances for a ratio.
   integer, parameter :: kept = 3*longest_orbit
   !> Longer orbits are looked for from here on, and then now and again: most motions do not have them.
   integer, parameter :: longer_from = 12, longer_every = 4
   !> Ratio above which the bound is not trusted.
   real(dp), parameter :: largest_ratio = 0.99_dp

   !> Distance that is rounding alone.
   real(dp), parameter :: rounding = 32.0_dp*epsilon(1.0_dp)

   !> Last states of a motion, scaled, the newest at `newest`.
   type, public :: orbit_watch_t
      integer :: count = 0
      integer :: newest = 0
      real(dp) :: film(0:kept - 1) = 0.0_dp
      real(dp) :: momentum(0:kept - 1) = 0.0_dp
   end type orbit_watch_t

   public :: note_state

contains

   !> Take the state at the end of a period.
   pure subroutine note_state(watch, film, momentum, damping_rate, tolerance, orbit, distance)
      !> Watcher of this motion
      type(orbit_watch_t), intent(inout) :: watch
      !> Scaled film H [-]
      real(dp), intent(in) :: film
      !> Scaled momentum V [-]
      real(dp), intent(in) :: momentum
      !> Damping rate there [1/periods]
      real(dp), intent(in) :: damping_rate
      !> Distance from the repeating motion that is small enough [-]
      real(dp), intent(in) :: tolerance
      !> Periods after which the motion repeats, 0 as long as that is not known
      integer, intent(out) :: orbit
      !> Bound of the distance from the motion that repeats, where there is one [-]
      real(dp), intent(out) :: distance
      integer :: last

      watch%newest = modulo(watch%newest + 1, kept)
      watch%film(watch%newest) = film
      watch%momentum(watch%newest) = momentum
      watch%count = watch%count + 1
      last = 1
      if (watch%count >= longer_from .and. modulo(watch%count, longer_every) == 0) last = longest_orbit
      distance = huge(distance)
      do orbit = 1, last
         if (watch%count < 3*orbit) exit
         distance = orbit_distance(watch, orbit, 1.0_dp/(free_rate + damping_rate))
         if (distance <= tolerance) return
      end do
      orbit = 0
   end subroutine note_state

   !> Bound of the distance from a motion that repeats after `orbit` periods, huge where there is none.
   pure real(dp) function orbit_distance(watch, orbit, momentum_weight)
      type(orbit_watch_t), intent(in) :: watch
      integer, intent(in) :: orbit
      !> Film that a momentum of one counts as [-]
      real(dp), intent(in) :: momentum_weight
      real(dp) :: last, before, ratio
      integer :: back

      orbit_distance = huge(1.0_dp)
      last = 0.0_dp
      before = 0.0_dp
      do back = 0, orbit - 1
         last = max(last, apart(watch, back, back + orbit, momentum_weight))
         before = max(before, apart(watch, back + orbit, back + 2*orbit, momentum_weight))
      end do
      ! The map has no memory: a state met again to the last bit comes again for ever.
      if (last <= rounding) orbit_distance = last
      if (last <= rounding .or. last >= largest_ratio*before) return
      ratio = last/before
      if (orbit == 1) ratio = max(ratio, earlier_ratio(watch, ratio, momentum_weight))
      if (ratio < largest_ratio) orbit_distance = last*ratio/(1.0_dp - ratio)
   end function orbit_distance

   !> Largest of the ratios before the last one: of one, or of two where the motion does not settle fast.
   pure real(dp) function earlier_ratio(watch, last_ratio, momentum_weight)
      type(orbit_watch_t), intent(in) :: watch
      !> The last ratio [-]
      real(dp), intent(in) :: last_ratio
      real(dp), intent(in) :: momentum_weight
      real(dp), parameter :: fast = 0.1_dp
      real(dp) :: newer, older
      integer :: back

      earlier_ratio = 0.0_dp
      newer = apart(watch, 1, 2, momentum_weight)
      do back = 2, 3
         if (back == 3 .and. max(last_ratio, earlier_ratio) < fast) return
         if (watch%count < back + 2) exit
         older = apart(watch, back, back + 1, momentum_weight)
         if (.not. newer < older) exit
         earlier_ratio = max(earlier_ratio, newer/older)
         newer = older
      end do
      if (back <= 3) earlier_ratio = huge(1.0_dp)
   end function earlier_ratio

   !> Distance of two states, in the measure of the step control.
   pure real(dp) function apart(watch, back_1, back_2, momentum_weight)
      type(orbit_watch_t), intent(in) :: watch
      !> How many periods they lie back
      integer, intent(in) :: back_1
      integer, intent(in) :: back_2
      real(dp), intent(in) :: momentum_weight
      integer :: i, j

      i = modulo(watch%newest - back_1, kept)
      j = modulo(watch%newest - back_2, kept)
      apart = max(abs(watch%film(i) - watch%film(j)), abs(watch%momentum(i) - watch%momentum(j))*momentum_weight) &
         /film_weight(watch%film(i))
   end function apart

end module period_repetition
