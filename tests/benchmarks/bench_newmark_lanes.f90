!> Newmark's method on many scenes at once: scene-steps per second of processor time, 512 steps a period, 20
!> periods, iso-viscous and piezo-viscous published film. The scenes differ in the amplitude of the force: up
!> to the steady force (calm), up to three times it (violent). One line a set: median and best of the rounds,
!> evaluations a step, scenes solved alone.
program bench_newmark_lanes
   use constants, only: standard_gravity
   use film_law, only: film_t, kernel_half_pi, kernel_piezo
   use kinds, only: dp
   use newmark_lanes, only: newmark_lane_ending_t, newmark_lane_request_t, newmark_lane_scene_t, &
      solve_newmark_lanes
   use published_iso_viscous, only: rolling_coefficient, squeeze_coefficient
   use published_piezo_viscous, only: piezo_coefficient, squeeze_exponent_rate
   implicit none(type, external)

   !> Radius [m], viscosity [Pa s], Barus coefficient [1/Pa], speed [m/s], film at rest [m], mass [kg], force
   !> [N]
   real(dp), parameter :: radius = 0.0127_dp, viscosity = 0.3_dp, pressure_viscosity = 2.0e-8_dp, &
      speed = 1.9_dp, rest = 0.89e-6_dp, mass = 3.0_dp, steady_force = 40.0_dp
   integer, parameter :: rounds = 41, scene_count = 256
   type(newmark_lane_request_t), parameter :: request = newmark_lane_request_t(steps_per_period=512, &
      periods=20)
   character(*), parameter :: laws(2) = ['iso  ', 'piezo'], sets(2) = [character(7) :: 'calm', 'violent']
   real(dp), parameter :: most(2) = [1.0_dp, 3.0_dp]
   type(newmark_lane_scene_t) :: scenes(scene_count)
   type(newmark_lane_ending_t) :: endings(scene_count)
   real(dp) :: films(0, scene_count), velocities(0, scene_count), accelerations(0, scene_count), rates(rounds)
   real(dp) :: start, finish
   integer :: law, set, i, round

   print '(a)', 'law,forces,median scene-steps/s,best scene-steps/s,evaluations/step,alone'
   do law = 1, 2
      do set = 1, 2
         do i = 1, scene_count
            scenes(i) = scene_of(law, most(set)*real(i, dp)/real(scene_count, dp))
         end do
         do round = 1, rounds
            call cpu_time(start)
            call solve_newmark_lanes(scenes, request, films, velocities, accelerations, endings)
            call cpu_time(finish)
            rates(round) = real(sum(endings%count%steps), dp)/(finish - start)
         end do
         call sort(rates)
         print '(a, ",", a, 2(",", es8.2), ",", f0.4, ",", i0)', trim(laws(law)), trim(sets(set)), &
            rates((rounds + 1)/2), rates(rounds), real(sum(endings%count%evaluations), &
               dp)/real(sum(endings%count%steps), dp), count(endings%periods_alone > 0)
      end do
   end do

contains

   !> Scene of a law with the amplitude of the force as a share of the steady force; its length carries the
   !> static load.
   type(newmark_lane_scene_t) function scene_of(law, share) result(scene)
      integer, intent(in) :: law
      real(dp), intent(in) :: share
      real(dp) :: length

      scene%method%mass = mass
      scene%method%weight = mass*standard_gravity
      scene%method%steady_force = steady_force
      scene%method%force_amplitude = share*steady_force
      scene%method%frequency = 600.0_dp
      scene%method%tolerance = 1.0e-14_dp
      scene%method%iteration_limit = 50
      scene%thickness = rest
      length = steady_force + scene%method%weight
      if (law == 1) then
         length = length*rest/rolling_coefficient(1.0_dp, speed, viscosity, radius)
         scene%film = film_t(kernel=kernel_half_pi, &
            rolling=rolling_coefficient(length, speed, viscosity, radius), &
            squeeze=squeeze_coefficient(length, viscosity, radius))
      else
         length = length*(rest**3*sqrt(rest))/piezo_coefficient(1.0_dp, speed, viscosity, radius, &
            pressure_viscosity)
         scene%film = film_t(kernel=kernel_piezo, rate=squeeze_exponent_rate(speed), &
            piezo=piezo_coefficient(length, speed, viscosity, radius, pressure_viscosity))
      end if
   end function scene_of

   !> Ascending.
   pure subroutine sort(values)
      real(dp), intent(inout) :: values(:)
      real(dp) :: moving
      integer :: i, j

      do i = 2, size(values)
         moving = values(i)
         do j = i - 1, 1, -1
            if (values(j) <= moving) exit
            values(j + 1) = values(j)
         end do
         values(j + 1) = moving
      end do
   end subroutine sort

end program bench_newmark_lanes
