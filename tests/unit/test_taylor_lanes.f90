!> Tests of the error-controlled engine: accuracy against itself, against collocation, against Newmark's
!> method and reference values; equal bits in any lane; repetition; motions carried on; failures.
module test_taylor_lanes
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use, intrinsic :: iso_c_binding, only: c_intptr_t, c_loc
   use checks, only: check_list_t, same_bits
   use constants, only: standard_gravity, two_pi
   use engine, only: ending_t, motion_state_t, request_t, start_of
   use film_law, only: film_load, kernel_half_pi, kernel_piezo, kernel_reynolds_iso, kernel_reynolds_piezo, kernel_solved_fast
   use film_series, only: check_ends, has_series, series_of, set_coefficients
   use kinds, only: dp
   use lane_advance, only: take_series_step
   use lane_block, only: lane_block_t, load_problem, place_block
   use lane_functions, only: coarse_log, coarse_power, half_block, lane_cosine_sine, lane_exponential, lanes, log_of_one, &
      whole_below
   use lane_rows, only: interleave_rows
   use many_motions, only: solve_motions
   use carried_loads, only: accelerations_of_samples
   use problem, only: of_film, of_velocity, problem_t
   use published_iso_viscous, only: rolling_coefficient, squeeze_coefficient
   use published_piezo_viscous, only: piezo_coefficient, squeeze_exponent_rate
   use reynolds_load, only: pressure_rate, squeeze_rate
   use scene_status, only: status_complete, status_film_lost, status_overflow, status_steady
   implicit none(type, external)
   private

   real(dp), parameter :: radius = 0.0127_dp, viscosity = 0.3_dp, pressure_viscosity = 2.0e-8_dp, &
      mass = 3.0_dp
   real(dp), parameter :: frequency = 600.0_dp, first_film = 0.89e-6_dp

   public :: run_taylor_lanes_tests

contains

   !> Run all tests of this module.
   subroutine run_taylor_lanes_tests(checks)
      !> Outcome so far
      type(check_list_t), intent(inout) :: checks

      call checks%start('taylor lanes')
      call test_functions(checks)
      call test_memory(checks)
      call test_reference(checks)
      call test_accuracy(checks)
      call test_leaving_cells(checks)
      call test_against_newmark(checks)
      call test_equal_bits(checks)
      call test_repetition(checks)
      call test_carrying_on(checks)
      call test_failures(checks)
      call test_unknown_law(checks)
   end subroutine run_taylor_lanes_tests

   !> Scene whose film carries Q + m g at h = 0.89 um at rest, Q = 40 N.
   pure function scene_of(kernel, speed, force_ratio) result(scene)
      !> Film law
      integer, intent(in) :: kernel
      !> Speed u [m/s]
      real(dp), intent(in) :: speed
      !> F0/Q [-]
      real(dp), intent(in) :: force_ratio
      type(problem_t) :: scene
      real(dp) :: load, length

      scene%mass = mass
      scene%weight = mass*standard_gravity
      scene%force%steady = 40.0_dp
      scene%force%cosine = force_ratio*scene%force%steady
      scene%frequency = frequency
      scene%initial_film = first_film
      load = scene%force%steady + scene%weight
      scene%contact%film%kernel = kernel
      scene%contact%film%radius = radius
      scene%contact%film%speed = speed
      select case (kernel)
      case (kernel_half_pi)
         length = load*first_film/rolling_coefficient(1.0_dp, speed, viscosity, radius)
         scene%contact%film%rolling = rolling_coefficient(length, speed, viscosity, radius)
         scene%contact%film%squeeze = squeeze_coefficient(length, viscosity, radius)
      case (kernel_piezo)
         length = load*first_film**3.5_dp/piezo_coefficient(1.0_dp, speed, viscosity, radius, &
            pressure_viscosity)
         scene%contact%film%piezo = piezo_coefficient(length, speed, viscosity, radius, pressure_viscosity)
         scene%contact%film%rate = squeeze_exponent_rate(speed)
      case (kernel_solved_fast)
         length = load*first_film/rolling_coefficient(1.0_dp, speed, viscosity, radius)
         scene%contact%film%rolling = rolling_coefficient(length, speed, viscosity, radius)
         scene%contact%film%squeeze = squeeze_coefficient(length, viscosity, radius)
         scene%contact%film%squeeze_rate = squeeze_rate(speed, radius)
      case default
         scene%contact%film%scale = load*first_film/0.203957020579723718_dp
         scene%contact%film%squeeze_rate = squeeze_rate(speed, radius)
         ! With three times the static load at 1.9 m/s, sigma comes down to 0.5, and is 1 in flight.
         if (kernel == kernel_reynolds_piezo) &
            scene%contact%film%pressure_rate = pressure_rate(speed, viscosity, radius, 4.5e-10_dp)
      end select
   end function scene_of

   !> Films of the last periods of one scene.
   subroutine films_of(scene, accuracy, periods, sampled, per_period, films, ending, implicit)
      type(problem_t), intent(in) :: scene
      real(dp), intent(in) :: accuracy
      integer, intent(in) :: periods
      integer, intent(in) :: sampled
      integer, intent(in) :: per_period
      real(dp), allocatable, intent(out) :: films(:)
      type(ending_t), intent(out) :: ending
      !> By collocation from the start
      logical, optional, intent(in) :: implicit
      type(motion_state_t) :: start
      type(ending_t) :: endings(1)
      real(dp) :: states(sampled*per_period, 2, 1)

      states = 0.0_dp
      start = start_of(scene)
      if (present(implicit)) start%implicit = implicit
      call solve_motions([scene], [start], request_t(accuracy=accuracy, periods=periods, &
         samples_per_period=per_period, &
                                                 sampled_periods=sampled), states, endings)
      ending = endings(1)
      films = states(:, of_film, 1)
   end subroutine films_of

   !> Exponential, cosine and sine, coarse logarithm.
   subroutine test_functions(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp) :: x(lanes), y(lanes), cosine(lanes), sine(lanes), worst_exponential, worst_circle
      integer :: i, l

      worst_exponential = 0.0_dp
      worst_circle = 0.0_dp
      do i = 0, 200
         x = [(-299.0_dp + real(i*lanes + l, dp)*598.0_dp/real(201*lanes, dp), l=1, lanes)]
         call lane_exponential(x, y)
         worst_exponential = max(worst_exponential, maxval(abs(y/exp(x) - 1.0_dp)))
         x = [(real(i*lanes + l, dp)/real(201*lanes, dp), l=1, lanes)]
         call lane_cosine_sine(x, cosine, sine)
         worst_circle = max(worst_circle, maxval(abs(cosine - cos(two_pi*x))), maxval(abs(sine &
            - sin(two_pi*x))))
      end do
      call checks%check_close(worst_exponential, 0.0_dp, 4.0_dp*epsilon(1.0_dp), 'exponential')
      call checks%check_close(worst_circle, 0.0_dp, 6.0_dp*epsilon(1.0_dp), 'cosine and sine')
      x = [(10.0_dp**(l - 8), l=1, lanes)]
      call checks%check(maxval(abs(coarse_power(coarse_log(x) - log_of_one)/x - 1.0_dp)) < 2.0e-6_dp, &
         'coarse power inverts')
      x = [(0.25_dp + real(l - 1, dp), l=1, lanes)]
      call checks%check(all(abs(whole_below(x) - (x - 0.25_dp)) <= 0.0_dp), 'whole number below')
      call checks%check(all(abs(whole_below(x - 0.25_dp) - (x - 0.25_dp)) <= 1.0_dp), 'a whole number or the one below')
      call checks%check(all(abs(whole_below(spacing(1.0_dp)*[0.0_dp, 1.0_dp])) <= 0.0_dp), 'nothing below zero')
   end subroutine test_functions

   !> Rows side by side, and blocks at the start of a cache line.
   subroutine test_memory(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp) :: rows(3*half_block, half_block), columns(half_block, 3*half_block)
      real(dp), allocatable, target :: room(:)
      type(lane_block_t), pointer :: block
      integer :: i

      rows = reshape([(real(i, dp), i=1, size(rows))], shape(rows))
      call interleave_rows(size(rows, 1), rows(:, 1), rows(:, 2), rows(:, 3), rows(:, 4), rows(:, 5), rows(:, 6), rows(:, 7), &
         rows(:, 8), columns)
      call checks%check(all(abs(columns - transpose(rows)) <= 0.0_dp), 'rows side by side')
      call place_block(room, block)
      call checks%check(modulo(transfer(c_loc(block%film), 1_c_intptr_t), 64_c_intptr_t) == 0, 'series start with a line')
      call checks%check(modulo(transfer(c_loc(block%piezo_expansion(1)%terms), 1_c_intptr_t), 64_c_intptr_t) == 0, &
         'so does the last expansion')
   end subroutine test_memory

   !> Start-up of the canonical idle scene, films known to 13 digits.
   subroutine test_reference(checks)
      type(check_list_t), intent(inout) :: checks
      type(problem_t) :: scene
      type(ending_t) :: ending
      real(dp), allocatable :: films(:)

      scene%mass = 3.0_dp
      scene%weight = 3.0_dp*standard_gravity
      scene%force%steady = 199.2_dp
      scene%force%cosine = 205.7_dp
      scene%frequency = 600.0_dp
      scene%contact%film%kernel = kernel_half_pi
      scene%contact%film%rolling = rolling_coefficient(0.010_dp, 1.905_dp, 0.3_dp, radius)
      scene%contact%film%squeeze = squeeze_coefficient(0.010_dp, 0.3_dp, radius)
      scene%initial_film = scene%contact%film%rolling/(scene%force%steady + scene%weight)
      call films_of(scene, 1.0e-12_dp, 2, 2, 2, films, ending)
      call checks%check(ending%status == status_complete, 'canonical scene completes')
      call checks%check_close(films(1)/1.916633193569e-06_dp, 1.0_dp, 1.0e-12_dp, 'film after half a period')
      call checks%check_close(films(2)/3.794375605713e-07_dp, 1.0_dp, 1.0e-12_dp, 'film after one period')
      call checks%check_close(films(4)/3.795117960374e-07_dp, 1.0_dp, 1.0e-12_dp, 'film after two periods')
   end subroutine test_reference

   !> Errors follow the accuracy asked for, and two methods agree.
   subroutine test_accuracy(checks)
      type(check_list_t), intent(inout) :: checks
      integer, parameter :: kernels(5) = [kernel_half_pi, kernel_piezo, kernel_reynolds_iso, kernel_solved_fast, &
                                          kernel_reynolds_piezo]
      type(problem_t) :: scene
      type(ending_t) :: ending
      real(dp), allocatable :: films(:), exact(:)
      character(8) :: text
      integer :: k, digits

      do k = 1, size(kernels)
         scene = scene_of(kernels(k), 1.9_dp, 3.0_dp)
         call films_of(scene, 1.0e-13_dp, 20, 20, 16, exact, ending)
         do digits = 4, 10, 2
            call films_of(scene, 10.0_dp**(-digits), 20, 20, 16, films, ending)
            write (text, '(i0, a, i0)') kernels(k), ', ', digits
            call checks%check(maxval(abs(films/exact - 1.0_dp)) < 4.0_dp*10.0_dp**(-digits), &
               'accuracy of kernel, digits '//text)
            call checks%check(.not. ending%implicit, 'by series, kernel '//text)
         end do
         call films_of(scene, 1.0e-9_dp, 20, 20, 16, films, ending, .true.)
         call checks%check(maxval(abs(films/exact - 1.0_dp)) < 1.0e-9_dp, 'collocation agrees '//text)
      end do
   end subroutine test_accuracy

   !> The cells of the Reynolds piezo-viscous film end at |A| = 14. Where a motion goes further, collocation goes on; and below the
   !> accuracy of the cells it solves all of it.
   subroutine test_leaving_cells(checks)
      type(check_list_t), intent(inout) :: checks
      type(problem_t) :: scene
      type(ending_t) :: ending
      real(dp), allocatable :: films(:), exact(:)

      scene = scene_of(kernel_reynolds_piezo, 1.9_dp, 3.0_dp)
      call films_of(scene, 0.9e-10_dp, 6, 6, 16, exact, ending)
      call checks%check(ending%implicit .and. ending%status == status_complete, 'no cells for that accuracy')
      ! A = 20 at the start, and soon less
      scene%initial_velocity = 20.0_dp*sqrt(scene%initial_film)/scene%contact%film%squeeze_rate
      call films_of(scene, 1.0e-12_dp, 3, 3, 16, exact, ending)
      call films_of(scene, 1.0e-6_dp, 3, 3, 16, films, ending)
      call checks%check(ending%implicit .and. ending%status == status_complete, 'begun beyond the cells')
      call checks%check(maxval(abs(films/exact - 1.0_dp)) < 4.0e-6_dp, 'begun beyond the cells: accuracy')
      scene = scene_of(kernel_reynolds_piezo, 0.3_dp, 10.0_dp)
      call films_of(scene, 1.0e-12_dp, 6, 6, 16, exact, ending)
      call films_of(scene, 1.0e-6_dp, 6, 6, 16, films, ending)
      call checks%check(ending%implicit .and. ending%status == status_complete, 'beyond the cells')
      call checks%check(maxval(abs(films/exact - 1.0_dp)) < 4.0e-6_dp, 'beyond the cells: accuracy')
   end subroutine test_leaving_cells

   !> Newmark's average acceleration with Richardson extrapolation comes to the same film.
   subroutine test_against_newmark(checks)
      type(check_list_t), intent(inout) :: checks
      type(problem_t) :: scene
      type(ending_t) :: ending
      real(dp), allocatable :: films(:)
      real(dp) :: rough, fine, finest

      scene = scene_of(kernel_half_pi, 1.9_dp, 1.0_dp)
      call films_of(scene, 1.0e-10_dp, 5, 1, 1, films, ending)
      rough = newmark_film(scene, 5, 512)
      fine = newmark_film(scene, 5, 1024)
      finest = newmark_film(scene, 5, 2048)
      rough = fine + (fine - rough)/3.0_dp
      finest = finest + (finest - fine)/3.0_dp
      call checks%check_close((finest + (finest - rough)/15.0_dp)/films(1), 1.0_dp, 1.0e-9_dp, 'Newmark, &
&         extrapolated twice')
   end subroutine test_against_newmark

   !> Film after some periods by Newmark's method, every step solved by Newton's.
   real(dp) function newmark_film(scene, periods, steps)
      type(problem_t), intent(in) :: scene
      integer, intent(in) :: periods
      integer, intent(in) :: steps
      real(dp) :: h, v, a, next, dt, force, load, by_film, by_velocity, residual
      integer :: i, pass

      dt = 1.0_dp/(scene%frequency*real(steps, dp))
      h = scene%initial_film
      v = scene%initial_velocity
      call film_load(scene%contact%film, h, v, load, by_film, by_velocity)
      a = (load - scene%weight - scene%force%steady - scene%force%cosine)/scene%mass
      do i = 1, periods*steps
         force = scene%force%steady + scene%force%cosine*cos(two_pi*real(modulo(i, steps), &
            dp)/real(steps, dp))
         next = a
         do pass = 1, 20
            call film_load(scene%contact%film, h + dt*v + 0.25_dp*dt*dt*(a + next), v + 0.5_dp*dt*(a + next), &
               load, by_film, by_velocity)
            residual = (load - scene%weight - force)/scene%mass - next
            next = next + residual/(1.0_dp - (0.25_dp*dt*dt*by_film + 0.5_dp*dt*by_velocity)/scene%mass)
            if (abs(residual) < 1.0e-11_dp*max(1.0_dp, abs(next))) exit
         end do
         h = h + dt*v + 0.25_dp*dt*dt*(a + next)
         v = v + 0.5_dp*dt*(a + next)
         a = next
      end do
      newmark_film = h
   end function newmark_film

   !> Equal bits alone, in any lane, among any neighbours, by series and by collocation.
   subroutine test_equal_bits(checks)
      type(check_list_t), intent(inout) :: checks
      integer, parameter :: count = 2*lanes + 3, per_period = 8, periods = 6
      type(problem_t) :: scenes(count), mixed(count)
      type(motion_state_t) :: starts(count)
      logical :: implicit(count)
      type(ending_t) :: endings(count), alone(1)
      type(request_t) :: request
      real(dp) :: states(periods*per_period, 2, count), own_states(periods*per_period, 2, 1)
      integer :: i, shift
      logical :: equal

      request = request_t(accuracy=1.0e-7_dp, periods=periods, samples_per_period=per_period, &
         sampled_periods=periods)
      do i = 1, count
         scenes(i) = scene_of(merge(kernel_half_pi, kernel_piezo, modulo(i, 3) < 2), 0.5_dp &
            + 0.1_dp*real(i, dp), &
                              0.1_dp*real(i, dp))
         implicit(i) = modulo(i, 7) == 0
         if (modulo(i, 5) == 0) scenes(i) = scene_of(kernel_reynolds_iso, 1.0_dp, 0.1_dp*real(i, dp))
         if (modulo(i, 7) == 0) scenes(i) = scene_of(kernel_solved_fast, 1.5_dp, 0.1_dp*real(i, dp))
         if (modulo(i, 4) == 0) scenes(i) = scene_of(kernel_reynolds_piezo, 1.9_dp, 0.08_dp*real(i, dp))
      end do
      do shift = 0, lanes, 5
         mixed = cshift(scenes, shift)
         starts = start_of(mixed)
         starts%implicit = cshift(implicit, shift)
         states = 0.0_dp
         call solve_motions(mixed, starts, request, states, endings)
         equal = .true.
         do i = 1, count, 4
            own_states = 0.0_dp
            call solve_motions(mixed(i:i), starts(i:i), request, own_states, alone)
            equal = equal .and. all(same_bits(own_states(:, :, 1), states(:, :, i))) &
               .and. same_bits(alone(1)%lienard_variable, endings(i)%lienard_variable) &
               .and. alone(1)%count%steps == endings(i)%count%steps
         end do
         call checks%check(equal, 'equal bits alone and in company')
      end do
   end subroutine test_equal_bits

   !> Motions that repeat, after one period and after two, and one that never does.
   subroutine test_repetition(checks)
      type(check_list_t), intent(inout) :: checks
      type(problem_t) :: scenes(4)
      type(ending_t) :: endings(4)
      type(request_t) :: request
      real(dp), allocatable :: exact(:)
      type(ending_t) :: ending
      real(dp) :: states(8*16, 2, 4)

      scenes(1) = scene_of(kernel_half_pi, 1.9_dp, 1.0_dp)
      scenes(2) = scene_of(kernel_piezo, 1.9_dp, 0.0_dp)
      ! Three times the static load on a film with f_n = 2.5 f_exc: the motion doubles its period.
      scenes(3) = scenes(1)
      scenes(3)%contact%film%kernel = kernel_piezo
      scenes(3)%contact%film%piezo = piezo_coefficient(1.958e-3_dp, 1.905_dp, viscosity, radius, pressure_viscosity)
      scenes(3)%contact%film%rate = squeeze_exponent_rate(1.905_dp)
      scenes(3)%force%steady = 38.27_dp
      scenes(3)%force%cosine = 203.1_dp
      scenes(3)%initial_film = 0.889e-6_dp
      ! Slow surfaces: the film rises for hundreds of periods.
      scenes(4) = scene_of(kernel_piezo, 0.05_dp, 3.0_dp)
      request = request_t(accuracy=1.0e-8_dp, periods=300, samples_per_period=16, sampled_periods=8, &
         until_steady=.true.)
      states = 0.0_dp
      call solve_motions(scenes, start_of(scenes), request, states, endings)
      call checks%check(all(endings(1:3)%status == status_steady), 'motions that repeat are found')
      call checks%check(all(endings(1:3)%orbit == [1, 1, 2]), 'they repeat after 1, 1, 2 periods')
      call checks%check(all(endings(1:3)%distance < 1.0e-8_dp), 'their distance is below the accuracy')
      call checks%check(all(endings(1:2)%periods < 15), 'soon')
      call checks%check(all(endings%samples == [16, 16, 32, 128]), 'one orbit is sampled')
      call checks%check(endings(4)%status == status_complete, 'a film that rises slowly does not repeat')
      call films_of(scenes(1), 1.0e-10_dp, 300, 1, 16, exact, ending)
      call checks%check_close(maxval(abs(states(:16, of_film, 1)/exact - 1.0_dp)), 0.0_dp, 2.0e-8_dp, &
         'orbit of the whole run')
      call films_of(scenes(3), 1.0e-10_dp, 300 + modulo(endings(3)%periods, 2), 2, 16, exact, ending)
      call checks%check_close(maxval(abs(states(:32, of_film, 3)/exact - 1.0_dp)), 0.0_dp, 5.0e-8_dp, &
         'orbit of two periods')
   end subroutine test_repetition

   !> One long run is two chained ones, bit for bit, by series and by collocation.
   subroutine test_carrying_on(checks)
      type(check_list_t), intent(inout) :: checks
      type(problem_t) :: scene
      type(motion_state_t) :: start
      type(ending_t) :: long(1), first(1), second(1)
      type(request_t) :: request
      real(dp), dimension(12*8, 2, 1) :: states, whole
      integer :: method

      do method = 1, 2
         scene = scene_of(kernel_half_pi, 1.9_dp, 2.0_dp)
         start = start_of(scene)
         start%implicit = method == 2
         states = 0.0_dp
         request = request_t(accuracy=1.0e-6_dp, periods=30, samples_per_period=8, sampled_periods=12)
         call solve_motions([scene], [start], request, states, long)
         whole = states
         request%periods = 13
         request%sampled_periods = 0
         call solve_motions([scene], [start], request, states, first)
         request%periods = 30
         request%sampled_periods = 12
         states = 0.0_dp
         call solve_motions([scene], [first(1)%motion_state_t], request, states, second)
         call checks%check(all(same_bits(states, whole)) .and. same_bits(long(1)%lienard_variable, second(1)%lienard_variable), &
            'carried on, bit for bit')
      end do
   end subroutine test_carrying_on

   !> Scenes that cannot start say so; accelerations follow from the equation of motion.
   subroutine test_failures(checks)
      type(check_list_t), intent(inout) :: checks
      type(problem_t) :: scenes(4)
      type(ending_t) :: endings(4)
      real(dp) :: states(4, 2, 4), values(4)

      states(:, of_film, :) = 1.0_dp
      states(:, of_velocity, :) = 0.0_dp
      scenes = scene_of(kernel_piezo, 1.9_dp, 1.0_dp)
      scenes(1)%initial_film = -1.0e-9_dp
      scenes(2)%initial_film = ieee_value(1.0_dp, ieee_quiet_nan)
      scenes(3)%initial_velocity = -2.0_dp
      call solve_motions(scenes, start_of(scenes), request_t(accuracy=1.0e-6_dp, periods=2, samples_per_period=4, &
         sampled_periods=1), states, endings)
      call checks%check(all(endings%status == [status_film_lost, status_film_lost, status_overflow, &
         status_complete]), &
                        'statuses of scenes that cannot start')
      call checks%check(all(endings%samples == [0, 0, 0, 4]), 'samples of scenes that cannot start')
      call accelerations_of_samples(scenes(4), 4, reshape([first_film, 0.0_dp], [1, 2]), values(:1))
      call checks%check_close(values(1), 0.0_dp, 1.0e-9_dp, 'balance at a quarter of a period')
   end subroutine test_failures

   !> A law that no choice knows has no series, its steps are rejected, and its motion ends at once.
   subroutine test_unknown_law(checks)
      type(check_list_t), intent(inout) :: checks
      type(problem_t) :: scene
      type(ending_t) :: endings(1)
      type(lane_block_t), pointer :: block
      real(dp), allocatable, target :: room(:)
      real(dp) :: states(4, 2, 1)
      integer :: l

      scene = scene_of(kernel_half_pi, 1.9_dp, 1.0_dp)
      scene%contact%film%kernel = 99
      call checks%check(.not. has_series(scene, 1.0e-3_dp), 'unknown law: no series')
      call place_block(room, block)
      do l = 1, lanes
         call load_problem(scene, start_of(scene), 1.0e-6_dp, l, block)
         call set_coefficients(scene, .false., l, block)
      end do
      call take_series_step(series_of(scene), block)
      call checks%check(all(block%accepted <= 0.0_dp), 'unknown law: steps rejected')
      block%accepted = 1.0_dp
      call check_ends(series_of(scene), [(0.0_dp, l=1, lanes)], block)
      call checks%check(all(block%accepted <= 0.0_dp), 'unknown law: ends rejected')
      call solve_motions([scene], start_of([scene]), request_t(accuracy=1.0e-6_dp, periods=2, samples_per_period=4, &
                                                               sampled_periods=1), states, endings)
      call checks%check(endings(1)%status == status_overflow .and. endings(1)%periods == 0, 'unknown law: no motion')
   end subroutine test_unknown_law

end module test_taylor_lanes
