!> Tests of the watcher that shows when a motion repeats, on states that approach known motions at known rates.
!> The film stays near one, where its weight is a half.
module test_period_repetition
   use checks, only: check_list_t
   use kinds, only: dp
   use problem, only: settling_t
   use repetition, only: note_state, orbit_watch_t, start_watch
   implicit none(type, external)
   private

   real(dp), parameter :: film_weight_at_one = 0.5_dp

   public :: run_period_repetition_tests

contains

   !> Runs every test of this topic.
   subroutine run_period_repetition_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('period_repetition')
      call test_rest(checks)
      call test_bound(checks)
      call test_slow(checks)
      call test_chance(checks)
      call test_orbits(checks)
      call test_half_still(checks)
      call test_turns(checks)
      call test_pairs(checks)
      call test_slow_films(checks)
   end subroutine run_period_repetition_tests

   !> Note films one after another, with velocities if given; the first that repeats ends it.
   pure subroutine note_all(films, velocities, velocity_weight, tolerance, place, orbit, distance)
      real(dp), intent(in) :: films(0:)         !> States from the start on [-]
      real(dp), intent(in) :: velocities(0:)       !> Momenta [-]
      real(dp), intent(in) :: velocity_weight   !> Film that a velocity of one counts as [-]
      real(dp), intent(in) :: tolerance         !> Distance that is small enough [-]
      integer, intent(out) :: place             !> State at which the motion was found to repeat; none: the last
      integer, intent(out) :: orbit             !> Its periods, 0: not found
      real(dp), intent(out) :: distance         !> Bound of its distance [-]

      type(orbit_watch_t) :: watch

      call start_watch([films(0), velocities(0)], films(0), watch)
      orbit = 0
      distance = huge(1.0_dp)
      do place = 1, ubound(films, 1)
       call note_state(watch, [films(place), velocities(place)], films(place), [1.0_dp, velocity_weight], settling_t(), tolerance, &
                         orbit, distance)
         if (orbit > 0) return
      end do
      place = ubound(films, 1)
   end subroutine note_all

   !> A state that stays repeats as soon as there are four of them, and only if the velocity stays as well.
   subroutine test_rest(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: films(0:40), velocities(0:40), distance
      integer :: place, orbit, i

      films = 1.0_dp
      velocities = 0.3_dp
      call note_all(films, velocities, 1.0_dp, 1.0e-6_dp, place, orbit, distance)
      call checks%check(orbit == 1 .and. place == 3, 'rest: found with the fourth state')
      call checks%check_close(distance, 0.0_dp, 0.0_dp, 'rest: distance')
      velocities = [(real(i, dp), i=0, 40)]
      call note_all(films, velocities, 1.0_dp, 1.0e-6_dp, place, orbit, distance)
      call checks%check(orbit == 0, 'a velocity that grows does not repeat')
      call note_all(films, velocities, 1.0e-30_dp, 1.0e-6_dp, place, orbit, distance)
      call checks%check(orbit == 1, 'a velocity without weight does not count')
   end subroutine test_rest

   !> x_n = 1 + c q^n is c q^n away from where it goes, and that is the bound: found at the first state within.
   subroutine test_bound(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: start = 1.0e-3_dp, tolerance = 1.0e-7_dp, ratios(4) = [0.05_dp, 0.5_dp, 0.9_dp, 0.98_dp]
      real(dp) :: films(0:600), velocities(0:600), distance
      integer :: place, orbit, i, k

      velocities = 0.0_dp
      do k = 1, size(ratios)
         films = [(1.0_dp + start*ratios(k)**i, i=0, 600)]
         call note_all(films, velocities, 1.0_dp, tolerance, place, orbit, distance)
         call checks%check(orbit == 1, 'bound: found')
         call checks%check_close(distance, start*ratios(k)**place/film_weight_at_one, 1.0e-3_dp*tolerance, &
            'bound: the distance that is left')
         call checks%check(start*ratios(k)**(place - 1) > 0.99_dp*tolerance*film_weight_at_one, 'bound: not later than it holds')
         ! The same in the velocity, which weighs three times as much.
         call note_all([(1.0_dp, i=0, 600)], (films - 1.0_dp)/3.0_dp, 3.0_dp, tolerance, i, orbit, distance)
         call checks%check(orbit == 1 .and. i == place, 'bound: the velocity counts by its weight')
      end do
   end subroutine test_bound

   !> Creeping so slowly that even eight periods hardly change anything proves nothing.
   subroutine test_slow(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: films(0:1200), velocities(0:1200), distance
      integer :: place, orbit, i

      velocities = 0.0_dp
      films = [(1.0_dp + 0.01_dp*0.999_dp**i, i=0, 1200)]
      call note_all(films, velocities, 1.0_dp, 1.0e-2_dp, place, orbit, distance)
      call checks%check(orbit == 0, 'slow: a ratio near one is not trusted')
   end subroutine test_slow

   !> One small ratio among large ones, the newest or the oldest, does not make the bound small.
   subroutine test_chance(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: unit = 1.0e-4_dp*film_weight_at_one
      real(dp) :: films(0:4), velocities(0:4), distance
      integer :: place, orbit

      velocities = 0.0_dp
      ! Distances 1, 0.05, 0.04, 0.032 units: 0.128 are left, not 0.0017.
      films = 1.0_dp + unit*[0.0_dp, 1.0_dp, 1.05_dp, 1.09_dp, 1.122_dp]
      call note_all(films, velocities, 1.0_dp, 0.01e-4_dp, place, orbit, distance)
      call checks%check(orbit == 0, 'chance: the oldest ratio is small')
      call note_all(films, velocities, 1.0_dp, 0.13e-4_dp, place, orbit, distance)
      call checks%check(orbit == 1 .and. place == 4, 'chance: found within its bound')
      call checks%check_close(distance, 0.128e-4_dp, 1.0e-8_dp, 'chance: bound by the largest ratio')
      ! Distances 1, 0.8, 0.64, 0.001 units: 0.004 are left, not 1.6e-6.
      films = 1.0_dp + unit*[0.0_dp, 1.0_dp, 1.8_dp, 2.44_dp, 2.441_dp]
      call note_all(films, velocities, 1.0_dp, 0.003e-4_dp, place, orbit, distance)
      call checks%check(orbit == 0, 'chance: the newest ratio is small')
      call note_all(films, velocities, 1.0_dp, 0.005e-4_dp, place, orbit, distance)
      call checks%check(orbit == 1, 'chance: found within the bound of the older ratio')
   end subroutine test_chance

   !> Motions of one to eight periods are found with the shortest of their periods, one of nine is not.
   subroutine test_orbits(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: films(0:200), velocities(0:200), distance
      integer :: place, orbit, period, i

      velocities = 0.0_dp
      do period = 1, 9
         films = [(1.0_dp + 0.01_dp*real(modulo(i, period)**2, dp) + 0.01_dp*0.8_dp**i, i=0, 200)]
         call note_all(films, velocities, 1.0_dp, 1.0e-6_dp, place, orbit, distance)
         call checks%check(orbit == merge(period, 0, period <= 8), 'orbits: their periods')
         if (orbit > 0) call checks%check(0.01_dp*0.8_dp**place <= 1.01e-6_dp*film_weight_at_one, 'orbits: not too early')
      end do
   end subroutine test_orbits

   !> Every other state stands still while those between still move: nothing repeats before all of them do.
   subroutine test_half_still(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: films(0:400), velocities(0:400), distance
      integer :: place, orbit, still, i

      velocities = 0.0_dp
      do still = 0, 1
         films = [(merge(1.02_dp, 0.98_dp + 0.1_dp*0.9_dp**shiftr(i, 1), modulo(i, 2) == still), i=0, 400)]
         call note_all(films, velocities, 1.0_dp, 1.0e-6_dp, place, orbit, distance)
         call checks%check(orbit == 2, 'half still: period two')
         call checks%check(0.1_dp*0.9_dp**shiftr(place, 1) <= 1.05e-6_dp*film_weight_at_one, 'half still: not too early')
      end do
   end subroutine test_half_still

   !> A spiral into one point, round in the measure of the watch, has the period of the force whatever its turn a period,
   !> though its states come close to each other after the periods of a full turn first.
   subroutine test_turns(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: rates(4) = [0.5_dp, 0.9_dp, 0.98_dp, 0.995_dp]
      real(dp), parameter :: degree = atan(1.0_dp)/45.0_dp, start = 1.0e-3_dp, tolerance = 1.0e-6_dp
      real(dp) :: films(0:3000), velocities(0:3000), angle, distance, left
      integer :: place, orbit, rate, turn, i
      logical :: single, near

      do rate = 1, size(rates)
         single = .true.
         near = .true.
         ! In half degrees; 180 degrees are a negative multiplier.
         do turn = 0, 360
            do i = 0, ubound(films, 1)
               angle = degree*(0.5_dp*real(turn, dp)*real(i, dp) + 23.0_dp)
               films(i) = 1.0_dp + start*rates(rate)**i*cos(angle)
               velocities(i) = start*rates(rate)**i*sin(angle)
            end do
            call note_all(films, velocities, 1.0_dp, tolerance, place, orbit, distance)
            left = start*rates(rate)**place/film_weight_at_one
            single = single .and. orbit == 1
            near = near .and. left <= 2.0_dp*tolerance
         end do
         call checks%check(single, 'turns: one period')
         call checks%check(near, 'turns: not too early')
      end do
   end subroutine test_turns

   !> The same with two real multipliers, of either sign.
   subroutine test_pairs(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: multipliers(6) = [-0.998_dp, -0.995_dp, -0.5_dp, 0.5_dp, 0.995_dp, 0.998_dp]
      real(dp), parameter :: start = 1.0e-3_dp, tolerance = 1.0e-6_dp
      real(dp) :: films(0:6000), velocities(0:6000), distance
      integer :: place, orbit, first, second, i

      do first = 1, size(multipliers)
         do second = 1, size(multipliers)
            do i = 0, ubound(films, 1)
               films(i) = 1.0_dp + start*(multipliers(first)**i + 0.3_dp*multipliers(second)**i)
               velocities(i) = start*(0.5_dp*multipliers(first)**i - multipliers(second)**i)
            end do
            call note_all(films, velocities, 1.0_dp, tolerance, place, orbit, distance)
            call checks%check(orbit == 1, 'pairs: one period')
            call checks%check(max(abs(films(place) - 1.0_dp), abs(velocities(place)))/film_weight_at_one <= 1.5_dp*tolerance, &
               'pairs: not too early')
         end do
      end do
   end subroutine test_pairs

   !> h'' + d h' + k h = 0 is that far from rest that its amplitude shows, however little it moves in a period: films that creep or
   !> swing, with multipliers up to 0.9999, from states whose steps a period are below any tolerance of their ratios.
   subroutine test_slow_films(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: dampings(4) = [0.02_dp, 0.3_dp, 10.0_dp, 1.0e4_dp], rates(4) = [1.0e-4_dp, 0.013_dp, 0.1_dp, 0.6_dp]
      real(dp), parameter :: tolerance = 1.0e-7_dp
      type(settling_t) :: settling
      real(dp) :: fast, left(0:1), distance, film, velocity
      integer :: orbit, i, r, start, mean
      complex(dp) :: roots(2), parts(2), root
      type(orbit_watch_t) :: watch

      do i = 1, size(dampings)
         do r = 1, size(rates)
            ! Creeping: roots -r and r - d. Swinging: k = r^2.
            fast = dampings(i) - rates(r)
            settling = settling_t(rates(r)*fast, dampings(i), rates(r))
            if (fast < rates(r)) settling%stiffness = rates(r)**2
            root = sqrt(cmplx(0.25_dp*dampings(i)**2 - settling%stiffness, 0.0_dp, dp))
            roots = [-0.5_dp*dampings(i) + root, -0.5_dp*dampings(i) - root]
            do start = 0, 2
               ! Film and velocity that the start is away by; the slow direction alone is the second.
               film = merge(0.0_dp, 1.0e-3_dp, start == 0)
               velocity = merge(1.0e-3_dp, merge(-1.0e-3_dp*rates(r), 0.0_dp, start == 1), start == 0)
               parts(1) = (velocity - roots(2)*film)/(roots(1) - roots(2))
               parts(2) = film - parts(1)
               call start_watch([1.0_dp + film, velocity], 1.0_dp + film, watch)
               orbit = 0
               do mean = 1, 1000000
                  left(0) = real(sum(parts*exp(roots*mean)), dp)
                  left(1) = real(sum(parts*roots*exp(roots*mean)), dp)
                  call note_state(watch, [1.0_dp + left(0), left(1)], 1.0_dp + left(0), &
                                  [1.0_dp, 1.0_dp/(2.0_dp + dampings(i))], settling, tolerance, orbit, &
                                  distance)
                  if (orbit > 0) exit
               end do
               call checks%check(orbit > 0, 'slow films: found')
               distance = hypot(left(0), left(1)/sqrt(settling%stiffness))/film_weight_at_one
               if (fast >= rates(r)) distance = abs(left(0))/film_weight_at_one
               call checks%check(distance <= 1.6_dp*tolerance, 'slow films: not too early')
               call checks%check(distance >= 1.0e-3_dp*tolerance .or. dampings(i) > 1.0_dp, 'slow films: not much too late')
            end do
         end do
      end do
      ! A step below the last bit is still a step of a film that has nothing to bring it back.
      call start_watch([1.0_dp, 0.0_dp], 1.0_dp, watch)
      do i = 1, 40
         call note_state(watch, [1.0_dp, 0.0_dp], 1.0_dp, [1.0_dp, 1.0_dp], settling_t(1.0e-12_dp, 1.0_dp, 1.0e-12_dp), tolerance, &
                         orbit, distance)
         call checks%check(orbit == 0, 'slow films: less than the last bit')
      end do
      call note_state(watch, [1.0_dp, 0.0_dp], 1.0_dp, [1.0_dp, 1.0_dp], settling_t(1.0e-5_dp, 1.0_dp, 1.0e-5_dp), tolerance, &
                      orbit, distance)
      call checks%check(orbit == 1 .and. distance > 0.0_dp .and. distance < tolerance, 'slow films: the last bit is near enough')
   end subroutine test_slow_films

end module test_period_repetition
