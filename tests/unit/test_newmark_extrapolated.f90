!> Tests of Newmark's method with Richardson extrapolation: order, accuracy on the scenes of the bench, ends;
!> alone and in lanes.
module test_newmark_extrapolated
   use checks, only: check_list_t
   use constants, only: standard_gravity
   use film_law, only: film_load, film_t, kernel_half_pi, kernel_piezo, kernel_solved_successive
   use kinds, only: dp
   use newmark, only: motion_count_t, motion_state_t, newmark_t, start_motion
   use newmark_extrapolated, only: advance_extrapolated, extrapolate_interval, extrapolation_t, &
      new_extrapolation
   use newmark_lanes, only: newmark_lane_scene_t
   use newmark_lanes_extrapolated, only: extrapolated_ending_t, solve_lanes_extrapolated
   use published_iso_viscous, only: rolling_coefficient, squeeze_coefficient
   use published_piezo_viscous, only: piezo_coefficient, squeeze_exponent_rate
   use richardson, only: doubt, extrapolate, most_rows, multiples
   use scene_status, only: status_complete, status_film_lost
   implicit none(type, external)
   private

   !> Film at rest of the scenes of the bench [m].
   real(dp), parameter :: rest = 0.89e-6_dp
   !> Their h/h0 after 200 periods, iso-viscous then piezo-viscous, F0 = 0.1, 1, 3 Q; from
   !> tests/benchmarks/reference.
   real(dp), parameter :: expected(6) = [0.9439755277058367_dp, 0.884126866665122_dp, 7.464518570741262_dp, &
                                   0.9839221837151537_dp, 0.8724728573949495_dp, 4.58624051607516_dp]

   public :: run_newmark_extrapolated_tests

contains

   !> Runs every test of this topic.
   subroutine run_newmark_extrapolated_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('newmark_extrapolated')
      call test_table(checks)
      call test_doubt(checks)
      call test_order(checks)
      call test_accuracy(checks)
      call test_samples(checks)
      call test_landing(checks)
      call test_lost(checks)
      call test_lanes(checks)
      call test_take_off(checks)
      call test_coarse_first_rows(checks)
   end subroutine run_newmark_extrapolated_tests

   !> A scene of the bench.
   type(newmark_lane_scene_t) function bench_scene(number) result(scene)
      integer, intent(in) :: number  !> From 1 to 6
      real(dp), parameter :: radius = 0.0127_dp, viscosity = 0.3_dp, speed = 1.9_dp, alpha = 2.0e-8_dp
      real(dp), parameter :: shares(3) = [0.1_dp, 1.0_dp, 3.0_dp]
      real(dp) :: length

      scene%method%mass = 3.0_dp
      scene%method%weight = 3.0_dp*standard_gravity
      scene%method%steady_force = 40.0_dp
      scene%method%force_amplitude = 40.0_dp*shares(mod(number - 1, 3) + 1)
      scene%method%frequency = 600.0_dp
      scene%thickness = rest
      length = 40.0_dp + scene%method%weight
      if (number <= 3) then
         length = length*rest/rolling_coefficient(1.0_dp, speed, viscosity, radius)
         scene%film = film_t(kernel=kernel_half_pi, &
            rolling=rolling_coefficient(length, speed, viscosity, radius), &
            squeeze=squeeze_coefficient(length, viscosity, radius))
      else
         length = length*(rest**3*sqrt(rest))/piezo_coefficient(1.0_dp, speed, viscosity, radius, alpha)
         scene%film = film_t(kernel=kernel_piezo, rate=squeeze_exponent_rate(speed), &
            piezo=piezo_coefficient(length, speed, viscosity, radius, alpha))
      end if
   end function bench_scene

   !> A polynomial in the square of the step is freed of as many terms as there are rows but one.
   subroutine test_table(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: table(1, most_rows), step
      integer :: row

      do row = 1, most_rows
         step = 1.0_dp/real(multiples(row), dp)
         call extrapolate(row, [3.0_dp + step**2 - 5.0_dp*step**4 + 7.0_dp*step**6], table)
         if (row == 3) call checks%check(abs(table(1, 1) - 3.0_dp) > 0.01_dp, &
            'table: three rows leave the third term')
      end do
      call checks%check_close(table(1, 1), 3.0_dp, 64.0_dp*epsilon(1.0_dp), 'table: eight rows')
   end subroutine test_table

   !> Doubt is 1 in the regime of the expansion; elsewhere it takes back what is not proven.
   subroutine test_doubt(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: change = 1.0e-9_dp

      call checks%check_close(doubt(2, change, huge(1.0_dp), 9.0_dp), 1.0_dp, 0.0_dp, 'doubt: second row')
      call checks%check_close(doubt(3, change, 1.0e-6_dp, 9.0_dp), 1.0_dp, 0.0_dp, 'doubt: a promise held')
      call checks%check_close(doubt(5, change, 1.0e-6_dp, 9.0_dp), 4.0_dp, 0.0_dp, 'doubt: credit of six squared')
      call checks%check_close(doubt(4, change, 2.0_dp*change, 36.0_dp), 8.0_dp, 1.0e-3_dp, &
                              'doubt: a promise broken')
      call checks%check_close(doubt(8, 0.0_dp, 0.0_dp, 256.0_dp), 1.0_dp, 0.0_dp, 'doubt: nothing left')
   end subroutine test_doubt

   !> Column k has the order 2 k: half the steps, 4^k times the error.
   subroutine test_order(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(newmark_lane_scene_t) :: scene
      type(motion_state_t) :: state
      type(motion_count_t) :: count
      real(dp) :: film(1), velocity(1), exact(1), estimate, errors(2, 3), ratio
      integer :: number, i, k, rows, status

      do number = 2, 5, 3
         scene = bench_scene(number)
         scene%method%tolerance = 1.0e-15_dp
         scene%method%iteration_limit = 20
         call start_motion(film_load, scene%film, scene%method, scene%thickness, scene%velocity, state, &
                           count, status)
         call extrapolate_interval(film_load, scene%film, scene%method, 0.0_dp, 1.0_dp, state, 256, 0.0_dp, &
                                   most_rows, rows, count, exact, velocity, estimate, status)
         call checks%check(status == status_complete .and. rows == most_rows .and. estimate < 1.0e-12_dp, &
                           'order: exact motion')
         do k = 1, 3
            do i = 1, 2
               call extrapolate_interval(film_load, scene%film, scene%method, 0.0_dp, 1.0_dp, state, 64*i, &
                                         0.0_dp, k, rows, count, film, velocity, estimate, status)
               errors(i, k) = abs(film(1)/exact(1) - 1.0_dp)
               if (k > 1) call checks%check(errors(i, k) < 10.0_dp*estimate, 'order: the estimate holds')
            end do
            ratio = log(errors(1, k)/errors(2, k))/log(2.0_dp)
            ! The next power of the step enters with some per cent at these steps.
            call checks%check_close(ratio, 2.0_dp*real(k, dp), 0.3_dp, 'order: of a column')
         end do
      end do
   end subroutine test_order

   !> 200 periods of the scenes of the bench to the accuracy asked for.
   subroutine test_accuracy(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: films(64), accelerations(64), accuracy
      type(newmark_lane_scene_t) :: scene
      type(extrapolation_t) :: extrapolation
      type(motion_state_t) :: state
      type(motion_count_t) :: count
      integer :: number, k, status

      do number = 1, 6
         scene = bench_scene(number)
         do k = 4, 12, 4
            accuracy = 10.0_dp**(-k)
            call run(scene, accuracy, 200, films, accelerations, extrapolation, state, count, status)
            call checks%check(status == status_complete, 'accuracy: status')
            call checks%check_close(films(64)/rest, expected(number), accuracy*expected(number), &
                                    'accuracy: after 200 periods')
            call checks%check(extrapolation%largest_estimate <= accuracy, 'accuracy: estimate')
            call checks%check(count%cuts == 0 .or. number == 3, 'accuracy: no cuts')
         end do
      end do
   end subroutine test_accuracy

   !> The motion does not depend on the number of samples, and the last one is the state.
   subroutine test_samples(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: numbers(6) = [1, 5, 16, 40, 97, 192]
      real(dp), parameter :: accuracy = 1.0e-9_dp
      real(dp) :: films(192), accelerations(192), reference(64), unused(64)
      type(extrapolation_t) :: extrapolation
      type(motion_state_t) :: state
      type(motion_count_t) :: count
      integer :: i, status

      call run(bench_scene(5), 1.0e-12_dp, 3, reference, unused, extrapolation, state, count, status)
      do i = 1, size(numbers)
         associate (last => numbers(i))
            call run(bench_scene(5), accuracy, 3, films(:last), accelerations(:last), extrapolation, state, &
                     count, status)
            call checks%check(status == status_complete, 'samples: status')
            call checks%check_close(films(last)/reference(64), 1.0_dp, accuracy, 'samples: end of the period')
            call checks%check_close(films(last), state%film, 0.0_dp, 'samples: state')
            call checks%check_close(accelerations(last), state%acceleration, 0.0_dp, 'samples: acceleration')
            if (mod(last, 16) == 0) call checks%check_close(films(last/16)/reference(4), 1.0_dp, accuracy, &
               'samples: within the period')
         end associate
      end do
   end subroutine test_samples

   !> A fall so fast that coarse steps would be cut.
   subroutine test_landing(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: films(64), fine(64), unused(64)
      type(newmark_lane_scene_t) :: scene
      type(extrapolation_t) :: extrapolation
      type(motion_state_t) :: state
      type(motion_count_t) :: count
      integer :: status

      scene = bench_scene(3)
      scene%velocity = -0.3_dp
      call run(scene, 1.0e-8_dp, 1, films, unused, extrapolation, state, count, status)
      call checks%check(status == status_complete, 'landing: status')
      call checks%check(maxval(extrapolation%bases) > minval(extrapolation%bases), &
                        'landing: fine steps where needed')
      call run(scene, 1.0e-11_dp, 1, fine, unused, extrapolation, state, count, status)
      call checks%check_close(maxval(abs(films/fine - 1.0_dp)), 0.0_dp, 1.0e-8_dp, 'landing: accuracy')
   end subroutine test_landing

   !> Nothing stops a fall in a film that carries nothing.
   subroutine test_lost(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: films(64), unused(64)
      type(newmark_lane_scene_t) :: scene
      type(extrapolation_t) :: extrapolation
      type(motion_state_t) :: state
      type(motion_count_t) :: count
      integer :: status

      scene = bench_scene(1)
      scene%film = film_t()
      call run(scene, 1.0e-8_dp, 5, films, unused, extrapolation, state, count, status)
      call checks%check(status == status_film_lost, 'lost: status')
      call checks%check(state%film > 0.0_dp, 'lost: the last film is positive')
   end subroutine test_lost

   !> All scenes of the bench in lanes, beside one that fails; each has the same bits alone.
   subroutine test_lanes(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: samples = 10*64
      real(dp), parameter :: accuracy = 1.0e-8_dp
      type(newmark_lane_scene_t) :: scenes(7)
      type(extrapolated_ending_t) :: endings(7), ending(1)
      real(dp), allocatable, dimension(:, :) :: films, velocities, accelerations, film, velocity, acceleration
      integer :: i

      allocate (films(samples, 7), velocities(samples, 7), accelerations(samples, 7))
      allocate (film(samples, 1), velocity(samples, 1), acceleration(samples, 1))
      do i = 1, 6
         scenes(i) = bench_scene(i)
      end do
      scenes(7) = bench_scene(1)
      scenes(7)%film = film_t()
      call solve_lanes_extrapolated(scenes, accuracy, 200, 10, 64, films, velocities, accelerations, endings)
      do i = 1, 6
         call checks%check(endings(i)%status == status_complete .and. endings(i)%estimate <= accuracy, &
                           'lanes: status')
         call checks%check_close(films(samples, i)/rest, expected(i), accuracy*expected(i), &
                                 'lanes: after 200 periods')
      end do
      call checks%check(endings(7)%status == status_film_lost, 'lanes: film lost')
      do i = 2, 5, 3
         call solve_lanes_extrapolated(scenes(i:i), accuracy, 200, 10, 64, film, velocity, acceleration, &
                                       ending)
         call checks%check(all(abs(film(:, 1) - films(:, i)) <= 0.0_dp) .and. &
                           all(abs(velocity(:, 1) - velocities(:, i)) <= 0.0_dp) .and. &
                           all(abs(acceleration(:, 1) - accelerations(:, i)) <= 0.0_dp), &
                           'lanes: the same bits alone')
      end do
   end subroutine test_lanes

   !> Two teeth that a load of hundreds of powers of e throws off, period after period. What the velocity is wrong
   !> by at the take-off moves the film all through the flight. Expected: by collocation, to 1e-11.
   subroutine test_take_off(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: expected_films(2) = [1.0845656139681317e5_dp, 1.7837683266450525e6_dp], &
         accuracies(2) = [1.0e-6_dp, 1.0e-8_dp]
      integer, parameter :: periods(2) = [17, 23]
      type(newmark_lane_scene_t) :: scenes(2)
      real(dp) :: films(8), unused(8), accuracy
      type(extrapolation_t) :: extrapolation
      type(motion_state_t) :: state
      type(motion_count_t) :: count
      integer :: i, k, status

      scenes%film%kernel = kernel_piezo
      scenes%film%rate = [1.8377589123316420e2_dp, 5.4715612691820127e2_dp]
      scenes%film%piezo = [4.3613949057659782e-13_dp, 1.5081770729847392e-16_dp]
      scenes%method%mass = [4.9204676870851324e-2_dp, 2.7519206500784343e-1_dp]
      scenes%method%weight = scenes%method%mass*standard_gravity
      scenes%method%steady_force = [1.2690040761500127e3_dp, 1.9962142539491315e3_dp]
      scenes%method%force_amplitude = [8.0518800274726427e3_dp, 1.0234195113647511e4_dp]
      scenes%method%frequency = [2.6218604884070351e2_dp, 1.1318248085446500e2_dp]
      scenes%thickness = [3.8169239835835829e-5_dp, 3.4393299584999886e-6_dp]
      do i = 1, 2
         do k = -1, 2
            accuracy = accuracies(i)*2.0_dp**k
            call run(scenes(i), accuracy, periods(i), films, unused, extrapolation, state, count, status)
            call checks%check(status == status_complete, 'take-off: status')
            call checks%check_close(films(8)/(scenes(i)%thickness*expected_films(i)), 1.0_dp, 12.0_dp*accuracy, &
                                    'take-off: after many flights')
         end do
      end do
   end subroutine test_take_off

   !> A film so stiff that the first rows of the tables miss its motion. Expected: by collocation, to 1e-11.
   subroutine test_coarse_first_rows(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: samples = 64
      real(dp), parameter :: accuracy = 1.0e-8_dp
      type(newmark_lane_scene_t) :: scene(1)
      type(extrapolated_ending_t) :: ending(1)
      real(dp), dimension(samples, 1) :: films, fine, velocities, accelerations

      scene%film = film_t(kernel=kernel_solved_successive, radius=5.5205099770970732e-3_dp, &
         speed=2.6972097000677209e-2_dp, rolling=3.2910011714875696e-2_dp, squeeze=6.8683299326774222e-2_dp, &
         squeeze_rate=7.7914785640763959_dp)
      scene%method%mass = 3.4301344326117311e-1_dp
      scene%method%weight = scene%method%mass*standard_gravity
      scene%method%steady_force = 1.8977740374403620e3_dp
      scene%method%force_amplitude = 5.7436384159352691e1_dp
      scene%method%frequency = 3.8345039962363485e3_dp
      scene%thickness = 1.7310691968498213e-5_dp
      scene%velocity = -1.6033249754995399e-2_dp
      call solve_lanes_extrapolated(scene, accuracy, 20, 8, 8, films, velocities, accelerations, ending)
      call checks%check(ending(1)%status == status_complete .and. ending(1)%estimate <= accuracy, &
                        'coarse first rows: status')
      call solve_lanes_extrapolated(scene, 1.0e-11_dp, 20, 8, 8, fine, velocities, accelerations, ending)
      call checks%check_close(maxval(abs(films/fine - 1.0_dp)), 0.0_dp, accuracy, 'coarse first rows: accuracy')
      call checks%check_close(fine(samples, 1)/scene(1)%thickness, 9.9997787120303150e-1_dp, 1.0e-10_dp, &
                              'coarse first rows: expected film')
   end subroutine test_coarse_first_rows

   !> Run a scene and keep the samples of its last period.
   subroutine run(scene, accuracy, periods, films, accelerations, extrapolation, state, count, status)
      type(newmark_lane_scene_t), intent(in) :: scene            !> The scene
      real(dp), intent(in) :: accuracy                           !> Accuracy
      integer, intent(in) :: periods                             !> Periods
      real(dp), contiguous, intent(out) :: films(:)              !> h [m]
      real(dp), contiguous, intent(out) :: accelerations(:)      !> z'' [m/s2]
      type(extrapolation_t), intent(out) :: extrapolation        !> Intervals
      type(motion_state_t), intent(out) :: state                 !> State at the end
      type(motion_count_t), intent(out) :: count                 !> Cost
      integer, intent(out) :: status                             !> Status of scene_status
      real(dp) :: velocities(size(films))
      integer :: period, done

      call start_motion(film_load, scene%film, scene%method, scene%thickness, scene%velocity, state, count, &
                        status)
      extrapolation = new_extrapolation(accuracy, size(films))
      do period = 1, periods
         if (status /= status_complete) return
         call advance_extrapolated(film_load, scene%film, scene%method, extrapolation, state, count, films, &
                                   velocities, accelerations, done, status)
      end do
   end subroutine run

end module test_newmark_extrapolated
