!> Tests of the forecast of where a motion settles: linear maps, whose fixed point is known, and real motions.
module test_settling_forecast
   use canonical_scenes, only: canonical_scene
   use checks, only: check_list_t
   use engine, only: ending_t, request_t, start_of
   use kinds, only: dp
   use lane_repetition, only: forecast_rest
   use many_motions, only: solve_motions
   use problem, only: of_film, problem_of, problem_t, settling_t
   use repetition, only: note_state, orbit_watch_t, start_watch
   use scene_status, only: status_complete, status_steady
   use scene_types, only: law_iso_viscous, scene_t
   implicit none(type, external)
   private

   !> Fixed point of the linear maps, H and V.
   real(dp), parameter :: rest(2) = [1.2_dp, -0.4_dp]
   !> Film that a velocity of one counts as.
   real(dp), parameter :: weight = 0.1_dp

   public :: run_settling_forecast_tests

contains

   !> Runs every test of this topic.
   subroutine run_settling_forecast_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('settling_forecast')
      call test_linear_maps(checks)
      call test_refusals(checks)
      call test_motions(checks)
      call test_failed_excursions(checks)
   end subroutine run_settling_forecast_tests

   !> Forecast from the first states of x -> rest + M (x - rest).
   subroutine follow(map, states, start, found, film, velocity)
      real(dp), intent(in) :: map(2, 2)   !> M
      integer, intent(in) :: states       !> States seen
      real(dp), intent(in) :: start(2)    !> First difference from the fixed point
      logical, intent(out) :: found       !> Whether there is a forecast
      real(dp), intent(out) :: film       !> Forecast
      real(dp), intent(out) :: velocity   !> Forecast
      type(orbit_watch_t) :: watch
      real(dp) :: away(2), place(2), distance
      integer :: i, orbit

      away = start
      call start_watch(rest + away, rest(1) + away(1), watch)
      do i = 2, states
         away = matmul(map, away)
         call note_state(watch, rest + away, rest(1) + away(1), [1.0_dp, weight], settling_t(), 0.0_dp, orbit, distance)
      end do
      call forecast_rest(watch, weight, huge(1.0_dp), orbit, place)
      film = place(1)
      velocity = place(2)
      found = orbit > 0
   end subroutine follow

   !> Real, alternating and complex multipliers: the fixed point is hit up to the rounding of the differences.
   subroutine test_linear_maps(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      real(dp), parameter :: start(2) = [0.01_dp, 0.05_dp]
      real(dp), parameter :: maps(2, 2, 4) = reshape([0.9_dp, 0.1_dp, 0.02_dp, 0.5_dp, &  ! two real ones
                                                     -0.9_dp, 0.0_dp, 0.05_dp, 0.4_dp, &  ! one alternates
                                                     0.6_dp, -0.7_dp, 0.7_dp, 0.6_dp, &   ! a spiral, |lambda| = 0.92
                                                     0.95_dp, 0.0_dp, 0.0_dp, 0.0_dp], [2, 2, 4])  ! one direction is forgotten
      real(dp) :: film, velocity
      integer :: i
      logical :: found

      do i = 1, 4
         call follow(maps(:, :, i), 5, start, found, film, velocity)
         call checks%check(found, 'linear map: forecast')
         ! Differences of 1e-4 and more, divided by 1 - 0.95: 1e-16/1e-4*20 of 0.05.
         call checks%check_close(film, rest(1), 1.0e-12_dp, 'linear map: film')
         call checks%check_close(velocity, rest(2), 1.0e-11_dp, 'linear map: velocity')
         call follow(maps(:, :, i), 4, start, found, film, velocity)
         call checks%check(.not. found, 'one estimate is none')
      end do
   end subroutine test_linear_maps

   !> No forecast: motions that leave their fixed point, hardly move towards it, settle fast, or are far away; and of a
   !> doubled period only over two periods.
   subroutine test_refusals(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      real(dp) :: film, velocity
      logical :: found

      call follow(diagonal(1.02_dp, 0.5_dp), 8, [1.0e-3_dp, 1.0e-3_dp], found, film, velocity)
      call checks%check(.not. found, 'unstable')
      call follow(diagonal(-1.02_dp, 0.5_dp), 8, [1.0e-3_dp, 1.0e-3_dp], found, film, velocity)
      call checks%check(.not. found, 'leaving towards a doubled period')
      call follow(diagonal(0.999_dp, 0.5_dp), 8, [1.0e-3_dp, 1.0e-3_dp], found, film, velocity)
      call checks%check(.not. found, 'too slow to tell')
      call follow(diagonal(0.2_dp, 0.1_dp), 8, [1.0e-3_dp, 1.0e-3_dp], found, film, velocity)
      call checks%check(.not. found, 'settles by itself')
      call follow(diagonal(0.9_dp, 0.5_dp), 5, [3.0_dp, 1.0_dp], found, film, velocity)
      call checks%check(.not. found, 'far away')
   end subroutine test_refusals

   pure function diagonal(first, second) result(map)
      real(dp), intent(in) :: first   !> Multiplier of the film
      real(dp), intent(in) :: second  !> Multiplier of the velocity
      real(dp) :: map(2, 2)

      map = reshape([first, 0.0_dp, 0.0_dp, second], [2, 2])
   end function diagonal

   !> Lightly damped motions end on the same orbit with and without forecast, and much sooner with it.
   subroutine test_motions(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      real(dp), parameter :: accuracy = 1.0e-8_dp, speeds(4) = [12.0_dp, 16.0_dp, 20.0_dp, 30.0_dp]
      integer, parameter :: samples = 64
      type(problem_t) :: lanes(4)
      type(request_t) :: request
      type(ending_t) :: plain(4), ahead(4)
      real(dp), dimension(8*samples, 2, 4) :: states, others
      integer :: i

      do i = 1, 4
         lanes(i) = canonical_lane(speeds(i), 150.0_dp)
      end do
      request%accuracy = accuracy
      request%periods = 400
      request%samples_per_period = samples
      request%sampled_periods = 8
      request%until_steady = .true.
      call solve_motions(lanes, start_of(lanes), request, states, plain)
      request%forecast = .true.
      call solve_motions(lanes, start_of(lanes), request, others, ahead)
      call checks%check(all(plain%status == status_steady .and. ahead%status == status_steady), 'both are steady')
      call checks%check(all(plain%orbit == 1 .and. ahead%orbit == 1), 'both have the period of the force')
      ! Each is within 0.3 accuracies of the orbit, where its steps are accurate; two steps differ by their errors.
      call checks%check_close(maxval(abs(states(:samples, of_film, :)/others(:samples, of_film, :) - 1.0_dp)), 0.0_dp, &
                              4.0_dp*accuracy, 'the same motion')
      call checks%check(sum(ahead%periods) < 0.6*sum(plain%periods), 'sooner')
   end subroutine test_motions

   !> Motions that never settle are sometimes forecast to. Behind a forecast that failed they are what they were, to the
   !> last bit, period by period; only the steps of the increasing and back are more.
   subroutine test_failed_excursions(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      integer, parameter :: samples = 16, scenes = 120
      type(problem_t) :: lanes(scenes)
      type(request_t) :: request
      type(ending_t) :: plain(scenes), ahead(scenes)
      real(dp), dimension(8*samples, 2, scenes) :: states, others
      logical :: unsettled(scenes)
      integer :: i

      do i = 1, scenes
         lanes(i) = canonical_lane(40.0_dp + 2.0_dp*real(modulo(i, 10), dp), 160.0_dp + 3.0_dp*real(i, dp))
      end do
      request%periods = 120
      request%samples_per_period = samples
      request%sampled_periods = 8
      request%until_steady = .true.
      states = 0.0_dp
      others = 0.0_dp
      call solve_motions(lanes, start_of(lanes), request, states, plain)
      request%forecast = .true.
      call solve_motions(lanes, start_of(lanes), request, others, ahead)
      unsettled = ahead%status == status_complete
      ! Which of them these are is left to rounding, for the motions are irregular.
      call checks%check(count(unsettled .and. ahead%count%steps > plain%count%steps) > 0, 'failed forecasts: there are some')
      call checks%check(all(plain%status == status_complete .or. .not. unsettled), 'failed forecasts: none would have settled')
      call checks%check(all(plain%periods == ahead%periods .or. .not. unsettled), 'failed forecasts: the periods of the motion')
      call checks%check(all(maxval(abs(states(:, of_film, :) - others(:, of_film, :)), dim=1) <= 0.0_dp .or. .not. unsettled), &
                        'failed forecasts: the same motion to the last bit')
   end subroutine test_failed_excursions

   !> The canonical scene with another speed and force, from its steady film on.
   function canonical_lane(speed, force) result(lane)
      real(dp), intent(in) :: speed  !> Entrainment speed [m/s]
      real(dp), intent(in) :: force  !> Force amplitude [N]
      type(problem_t) :: lane
      type(scene_t) :: scene

      scene = canonical_scene(law_iso_viscous, 64)
      scene%kinematics%entrainment_speed = speed
      scene%excitation%force_amplitude = force
      lane = problem_of(scene)
   end function canonical_lane

end module test_settling_forecast
