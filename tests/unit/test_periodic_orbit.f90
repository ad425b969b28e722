!> Tests of the finder of periodic motions, from states that are not on them.
module test_periodic_orbit
   use canonical_scenes, only: canonical_scene
   use checks, only: check_list_t
   use engine, only: ending_t, request_t, start_of
   use kinds, only: dp
   use many_motions, only: solve_motions
   use periodic_orbit, only: attracting_period, find_periodic_orbit, map_states, periodic_orbit_t
   use problem, only: of_film, of_velocity, problem_of, problem_t
   use scene_types, only: law_iso_viscous, scene_t
   implicit none(type, external)
   private

   public :: run_periodic_orbit_tests

contains

   !> Runs every test of this topic.
   subroutine run_periodic_orbit_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('periodic_orbit')
      call test_off_the_orbit(checks)
      call test_slow_return(checks)
      call test_multipliers(checks)
      call test_periods(checks)
      call test_shortest_period(checks)
      call test_attracting(checks)
   end subroutine run_periodic_orbit_tests

   !> Canonical published iso-viscous scene with another force and speed, from its steady film.
   function lane_of(amplitude, speed) result(lane)
      real(dp), intent(in) :: amplitude   !> F0 [N]
      real(dp), intent(in) :: speed       !> Entrainment speed [m/s]
      type(problem_t) :: lane
      type(scene_t) :: scene

      scene = canonical_scene(law_iso_viscous, 512)
      scene%excitation%force_amplitude = amplitude
      scene%kinematics%entrainment_speed = speed
      lane = problem_of(scene)
   end function lane_of

   !> State after many periods.
   function settled(lane, periods) result(ending)
      type(problem_t), intent(in) :: lane   !> The scene
      integer, intent(in) :: periods           !> Periods
      type(ending_t) :: ending
      type(ending_t) :: endings(1)
      real(dp) :: none(0, 2, 1)

      none = 0.0_dp
      call solve_motions([lane], [start_of(lane)], request_t(accuracy=1.0e-12_dp, periods=periods), none, endings)
      ending = endings(1)
   end function settled

   !> The motion is found from states beside it, in film and velocity, either way, with the distance of the larger; and it is
   !> another one beyond the nearness.
   subroutine test_off_the_orbit(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(problem_t) :: lane
      type(ending_t) :: true
      type(periodic_orbit_t) :: orbit
      real(dp), parameter :: shares(2, 4) = reshape([0.005_dp, 0.0_dp, -0.005_dp, 0.0_dp, 0.0_dp, 0.005_dp, 0.001_dp, -0.005_dp], &
                                                    [2, 4])
      real(dp) :: film, velocity, scale
      integer :: i

      lane = lane_of(205.7_dp, 1.905_dp)
      true = settled(lane, 120)
      scale = true%numbers(of_film)*2.0_dp*acos(-1.0_dp)*lane%frequency
      do i = 1, size(shares, 2)
         film = true%numbers(of_film)*(1.0_dp + shares(1, i))
         velocity = true%numbers(of_velocity) + scale*shares(2, i)
         orbit = find_periodic_orbit(lane, [film, velocity], 0.02_dp)
         call checks%check(orbit%period == 1, 'off the orbit: found')
         call checks%check_close(orbit%state(of_film)/true%numbers(of_film), 1.0_dp, 1.0e-9_dp, 'off the orbit: its film')
         call checks%check_close((orbit%state(of_velocity) - true%numbers(of_velocity))/scale, 0.0_dp, 1.0e-9_dp, &
                                 'off the orbit: its velocity')
         call checks%check_close(orbit%distance, maxval(abs(shares(:, i))), 1.0e-8_dp, 'off the orbit: how far')
         orbit = find_periodic_orbit(lane, [film, velocity], 0.0045_dp)
         call checks%check(orbit%period == 0, 'off the orbit: too far away')
      end do
   end subroutine test_off_the_orbit

   !> A motion that changes little in a period, because the force is fast, hardly moves in one even far from the motion that
   !> repeats: how far that is shows whether it is meant.
   subroutine test_slow_return(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(problem_t) :: lane
      type(ending_t) :: true
      type(periodic_orbit_t) :: orbit

      lane = lane_of(100.0_dp, 1.905_dp)
      lane%frequency = 6.0e5_dp
      true = settled(lane, 5000)
      orbit = find_periodic_orbit(lane, [1.05_dp*true%numbers(of_film), true%numbers(of_velocity)], 0.06_dp)
      call checks%check(orbit%period == 1, 'slow return: found within the nearness')
      call checks%check_close(orbit%distance, 0.05_dp, 1.0e-8_dp, 'slow return: how far')
      orbit = find_periodic_orbit(lane, [1.05_dp*true%numbers(of_film), true%numbers(of_velocity)], 0.04_dp)
      call checks%check(orbit%period == 0, 'slow return: too far away')
   end subroutine test_slow_return

   !> Multipliers against differences of another step, extrapolated.
   subroutine test_multipliers(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(problem_t) :: lane
      type(ending_t) :: true
      type(periodic_orbit_t) :: orbit
      real(dp) :: trace(2), step, film_step, velocity_step, states(2, 4)
      integer :: i
      logical :: mapped

      lane = lane_of(100.0_dp, 8.0_dp)
      true = settled(lane, 200)
      orbit = find_periodic_orbit(lane, [1.001_dp*true%numbers(of_film), true%numbers(of_velocity)], 0.02_dp)
      do i = 1, 2
         step = 5.0e-4_dp*real(i, dp)
         film_step = step*true%numbers(of_film)
         velocity_step = film_step*2.0_dp*acos(-1.0_dp)*lane%frequency
         states(of_film, :) = true%numbers(of_film) + [film_step, -film_step, 0.0_dp, 0.0_dp]
         states(of_velocity, :) = true%numbers(of_velocity) + [0.0_dp, 0.0_dp, velocity_step, -velocity_step]
         call map_states(lane, 1, 1.0e-12_dp, states, mapped)
         trace(i) = (states(of_film, 1) - states(of_film, 2))/(2.0_dp*film_step) + &
                    (states(of_velocity, 3) - states(of_velocity, 4))/(2.0_dp*velocity_step)
      end do
      call checks%check(orbit%period == 1 .and. mapped, 'multipliers: found')
      call checks%check_close(real(sum(orbit%multipliers), dp), (4.0_dp*trace(1) - trace(2))/3.0_dp, 2.0e-8_dp, &
                              'multipliers: their sum is the trace')
   end subroutine test_multipliers

   !> Motions of two to eight periods are found with their own period, from beside them.
   subroutine test_periods(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      integer, parameter :: periods(3) = [2, 4, 8]
      real(dp), parameter :: amplitudes(3) = [452.75_dp, 455.0_dp, 362.75_dp]
      real(dp), parameter :: speeds(3) = [8.405158309469508_dp, 15.736063383946137_dp, 13.830057843624784_dp]
      type(problem_t) :: lane
      type(ending_t) :: true
      type(periodic_orbit_t) :: orbit
      integer :: i

      do i = 1, size(periods)
         lane = lane_of(amplitudes(i), speeds(i))
         true = settled(lane, 800)
         orbit = find_periodic_orbit(lane, [true%numbers(of_film)*(1.0_dp + 1.0e-5_dp), true%numbers(of_velocity)], 1.0e-3_dp)
         call checks%check(orbit%period == periods(i) .and. attracting_period(orbit) == periods(i), 'periods: its own')
         call checks%check_close(orbit%state(of_film)/true%numbers(of_film), 1.0_dp, 1.0e-7_dp, 'periods: its film')
      end do
   end subroutine test_periods

   !> A motion near its period doubling jumps from side to side of the one that it settles to: after two periods it is nearer to
   !> where it was than after one, and yet its period is one.
   subroutine test_shortest_period(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(problem_t) :: lane
      type(ending_t) :: true
      type(periodic_orbit_t) :: orbit
      real(dp), parameter :: offset = 7.0e-4_dp, nearness = 1.0e-3_dp
      real(dp) :: there(2), image(2, 1)
      logical :: mapped

      lane = lane_of(396.0_dp, 8.405158309469508_dp)
      true = settled(lane, 800)
      there = [true%numbers(of_film)*(1.0_dp + offset), true%numbers(of_velocity)]
      image(:, 1) = there
      call map_states(lane, 1, 1.0e-12_dp, image, mapped)
      call checks%check(mapped .and. abs(image(of_film, 1) - there(of_film)) > nearness*true%numbers(of_film), &
                        'shortest: far after a period')
      orbit = find_periodic_orbit(lane, there, nearness)
      call checks%check(orbit%period == 1, 'shortest: its period')
      call checks%check_close(orbit%distance, offset, 1.0e-7_dp, 'shortest: how far')
      call checks%check(abs(real(orbit%multipliers(1)) + 0.96_dp) < 0.02_dp, 'shortest: its multiplier')
   end subroutine test_shortest_period

   !> Only a motion that others approach is one that they will repeat.
   subroutine test_attracting(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      complex(dp), parameter :: inside = (-0.99_dp, 0.0_dp), outside = (-1.01_dp, 0.0_dp), small = (0.1_dp, 0.0_dp)

      call checks%check(attracting_period(periodic_orbit_t(period=2, multipliers=[inside, small])) == 2, 'attracting: stable')
      call checks%check(attracting_period(periodic_orbit_t(period=2, multipliers=[outside, small])) == 0, 'attracting: unstable')
      call checks%check(attracting_period(periodic_orbit_t()) == 0, 'attracting: none')
   end subroutine test_attracting

end module test_periodic_orbit
