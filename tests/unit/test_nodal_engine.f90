!> Tests of motions whose films are solved in nodes of pressure: the canonical scenes from rest, and scene G of a loose gear,
!> against solutions of an independent program that are extrapolated over the nodes.
module test_nodal_engine
   use canonical_scenes, only: canonical_scene, counting_watcher_t, scene_g
   use checks, only: check_list_t
   use engine, only: checkpoint_t, ending_t, motion_state_t, start_of
   use errors, only: error_t
   use kinds, only: dp
   use nodal_step, only: nodal_choice_t
   use nodal_engine, only: solve_in_nodes
   use nodal_judgement, only: choice_of
   use node_extremes, only: seen_acceleration, seen_films, seen_loads, seen_pressure
   use carried_loads, only: gear_positions
   use problem, only: of_drive_compression, of_film, of_velocity, problem_of, problem_t
   use prepared_scene, only: request_of, prepare
   use scene_status, only: status_complete, status_steady
   use scene_types, only: law_elastohydrodynamic, method_taylor, model_resolved, scene_t, until_periods, until_steady, &
      viscosity_constant, viscosity_roelands
   use text, only: integer_text
   use window_record, only: window_record_t
   use classify_group, only: integral_record
   use window_keeper, only: window_keeper_t
   implicit none(type, external)
   private

   character(8), parameter :: law_names(3) = [character(8) :: 'constant', 'barus', 'roelands']

   public :: run_nodal_engine_tests

contains

   !> Runs every test of this topic.
   subroutine run_nodal_engine_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('nodal_engine')
      call test_canonical(checks)
      call test_start(checks)
      call test_scene_g(checks)
      call test_bound(checks)
      call test_repetition(checks)
   end subroutine run_nodal_engine_tests

   !> Solve a scene in nodes.
   subroutine solve(scene, keeper, ending, record, watcher, bound)
      type(scene_t), intent(in) :: scene
      !> Keeps the window
      type(window_keeper_t), intent(out) :: keeper
      type(ending_t), intent(out) :: ending
      type(window_record_t), intent(out) :: record
      type(counting_watcher_t), intent(inout) :: watcher
      !> Of bending, where it is not that of the scene
      real(dp), intent(in), optional :: bound
      type(problem_t) :: problem
      type(nodal_choice_t) :: choice
      type(checkpoint_t) :: start
      type(error_t), allocatable :: error

      problem = problem_of(scene)
      call choice_of(prepare(scene), choice)
      if (present(bound)) choice%bound = bound
      call keeper%keep_windows_of(problem)
      record = integral_record(scene%spectrum)
      record%wants = .true.
      record%loads%impact_limit = scene%spectrum%impact_limit
      call solve_in_nodes(problem, choice, request_of(scene), keeper, watcher, start, ending, record, error)
   end subroutine solve

   !> The canonical scenes, two periods from rest: gear positions after half a period and a whole one, from that at rest, largest
   !> acceleration, smallest film, and in oil of constant viscosity the largest pressure.
   subroutine test_canonical(checks)
      type(check_list_t), intent(inout) :: checks
      !> z(T/2), z(T) [um], z'' [m/s2], h [um]
      real(dp), parameter :: reference(4, 2) = reshape([2.0398_dp, 11.648_dp, 287.33_dp, 0.6047_dp, &
                                                        2.5396_dp, 11.739_dp, 295.11_dp, 1.8883_dp], [4, 2])
      !> Of 64 nodes. Positions are those of a gear that is thrown off its flank, and as far off as its
      !> velocity there.
      real(dp), parameter :: tolerances(4) = [2.0e-3_dp, 2.0e-3_dp, 5.0e-4_dp, 1.0e-3_dp]
      character(16), parameter :: names(4) = [character(16) :: 'z after T/2', 'z after T', 'acceleration', 'smallest film']
      integer, parameter :: laws(2) = [viscosity_constant, viscosity_roelands]
      type(scene_t) :: scene
      type(window_keeper_t) :: keeper
      type(ending_t) :: ending
      type(window_record_t) :: record
      type(counting_watcher_t) :: watcher
      real(dp), allocatable :: positions(:)
      real(dp) :: found(4), start
      integer :: i, j

      do i = 1, 2
         scene = canonical_scene(law_elastohydrodynamic, 512)
         scene%contact%young_modulus = 2.2e11_dp*(1.0_dp - 0.3_dp**2)
         scene%contact%stiffness = 1.0e8_dp
         scene%contact%flattening_included = .false.
         scene%lubricant%viscosity_law = laws(i)
         scene%film%model = model_resolved
         scene%film%nodes = 64
         scene%solver%accuracy = 1.0e-3_dp
         scene%solver%periods = 2
         scene%spectrum%periods = 2
         call solve(scene, keeper, ending, record, watcher)
         call checks%check(ending%status == status_complete .and. ending%periods == 2, 'canonical scene is solved')
         positions = gear_positions(problem_of(scene), keeper%states(:, :, 1))
         start = sum(gear_positions(problem_of(scene), reshape(record%start%numbers, [1, size(record%start%numbers)])))
         found = [1.0e6_dp*(positions(256) - start), 1.0e6_dp*(positions(512) - start), &
                  record%highest(seen_acceleration)%value, 1.0e6_dp*record%lowest(seen_films(1))%value]
         do j = 1, 4
            call checks%check_close(found(j)/reference(j, i), 1.0_dp, tolerances(j), &
                                    'canonical scene, '//trim(law_names(laws(i)))//': '//trim(names(j)))
         end do
         if (i == 2) cycle
         call checks%check_close(record%highest(seen_pressure)%value/381.0e6_dp, 1.0_dp, 3.0e-3_dp, &
                                 'canonical scene: largest pressure')
         scene%film%nodes = 32
         scene%solver%accuracy = 1.0e-2_dp
         call solve(scene, keeper, ending, record, watcher)
         call checks%check_close(record%highest(seen_acceleration)%value/reference(3, i), 1.0_dp, 2.0e-3_dp, &
                                 'canonical scene, 32 nodes: acceleration')
         call checks%check_close(1.0e6_dp*record%lowest(seen_films(1))%value/reference(4, i), 1.0_dp, 3.0e-3_dp, &
                                 'canonical scene, 32 nodes: smallest film')
      end do
   end subroutine test_canonical

   !> Starts from a film and a velocity: from the film at rest, given as such, the motion is that from rest, on a grid of another
   !> width; from others both are those of the first moment, and the first load is that of the closure.
   subroutine test_start(checks)
      type(check_list_t), intent(inout) :: checks
      !> Film over that at rest, velocity [m/s]
      real(dp), parameter :: starts(2, 5) = reshape([0.7_dp, 0.0_dp, 0.7_dp, -2.0e-3_dp, 0.7_dp, 5.0e-3_dp, 20.0_dp, -0.05_dp, &
                                                     20.0_dp, 0.05_dp], [2, 5])
      type(scene_t) :: scene
      type(window_keeper_t) :: keeper
      type(ending_t) :: ending
      type(window_record_t) :: rest, record
      type(counting_watcher_t) :: watcher
      type(motion_state_t) :: by_closure
      type(problem_t) :: problem
      real(dp) :: film
      integer :: i

      scene = scene_g(viscosity_constant)
      scene%excitation%steady_force = 60.0_dp
      scene%film%model = model_resolved
      scene%film%nodes = 64
      scene%solver%accuracy = 1.0e-3_dp
      scene%solver%kept_per_period = 64
      scene%solver%periods = 1
      scene%spectrum%periods = 1
      call solve(scene, keeper, ending, rest, watcher)
      film = rest%start%numbers(of_film)
      scene%film%initial_film = film
      call solve(scene, keeper, ending, record, watcher)
      call checks%check_close(record%start%numbers(of_drive_compression)/rest%start%numbers(of_drive_compression), 1.0_dp, &
                              1.0e-4_dp, 'start: the film at rest carries the static load')
      call checks%check_close(record%highest(seen_acceleration)%value/rest%highest(seen_acceleration)%value, 1.0_dp, 1.0e-4_dp, &
                              'start: from the film at rest as from rest')
      do i = 1, size(starts, 2)
         scene%film%initial_film = starts(1, i)*film
         scene%film%initial_velocity = starts(2, i)
         call solve(scene, keeper, ending, record, watcher)
         call checks%check(ending%status == status_complete, 'start: solved')
         call checks%check_close(record%start%numbers(of_film)/(starts(1, i)*film), 1.0_dp, 1.0e-10_dp, 'start: its film')
         call checks%check_close(record%start%numbers(of_velocity), starts(2, i), 1.0e-14_dp, 'start: its velocity')
         problem = problem_of(scene)
         problem%contact%film%in_nodes = .false.
         by_closure = start_of(problem)
         call checks%check_close(record%start%numbers(of_drive_compression)/by_closure%numbers(of_drive_compression), 1.0_dp, &
                                 0.05_dp, 'start: its load is that of the closure')
      end do
   end subroutine test_start

   !> Twelfth period of scene G: peaks to 2e-3 and films to 3e-3 by 32 nodes, at an accuracy of 1e-3 by 64 to it and three times it.
   subroutine test_scene_g(checks)
      type(check_list_t), intent(inout) :: checks
      !> z'' max, min and rms [m/s2], films [m], loads [N]
      real(dp), parameter :: reference(7, 3) = reshape([ &
         508.18_dp, -251.54_dp, 37.472_dp, 0.1319e-6_dp, 0.2177e-6_dp, 326.80_dp, 161.06_dp, &
         515.88_dp, -255.81_dp, 37.826_dp, 0.2492e-6_dp, 0.2957e-6_dp, 331.57_dp, 163.71_dp, &
         514.03_dp, -255.15_dp, 37.717_dp, 0.2385e-6_dp, 0.2926e-6_dp, 330.41_dp, 163.30_dp], [7, 3])
      !> Last digits of the references: errors of peaks and films are reported to them
      real(dp), parameter :: last_digits(7) = [1.2e-4_dp, 2.4e-4_dp, 1.6e-4_dp, 7.6e-4_dp, 4.6e-4_dp, 1.5e-4_dp, 2.5e-4_dp]
      real(dp), parameter :: errors(7, 2) = reshape([2.0e-3_dp, 2.0e-3_dp, 2.0e-3_dp, 3.0e-3_dp, 3.0e-3_dp, 2.0e-3_dp, 2.0e-3_dp, &
                                                     1.0e-3_dp, 1.0e-3_dp, 1.0e-3_dp, 3.0e-3_dp, 3.0e-3_dp, 1.0e-3_dp, 1.0e-3_dp], &
                                                    [7, 2])
      character(16), parameter :: names(7) = [character(16) :: 'acceleration max', 'acceleration min', 'rms', 'drive film', &
                                              'coast film', 'drive load', 'coast load']
      integer, parameter :: nodes(2) = [32, 64]
      real(dp), parameter :: accuracies(2) = [1.0e-2_dp, 1.0e-3_dp]
      !> Largest pressure in oil of constant viscosity [Pa], 3e-3 by 32 nodes
      real(dp), parameter :: pressure = 176.7e6_dp
      type(scene_t) :: scene
      type(window_keeper_t) :: keeper
      type(ending_t) :: ending
      type(window_record_t) :: record
      type(counting_watcher_t) :: watcher
      real(dp) :: found(7)
      integer :: law, i, j

      do law = viscosity_constant, viscosity_roelands
         do i = 1, 2
            scene = scene_g(law)
            scene%film%model = model_resolved
            scene%film%nodes = nodes(i)
            scene%solver%accuracy = accuracies(i)
            scene%solver%kept_per_period = 64
            scene%solver%periods = 12
            scene%spectrum%periods = 1
            call solve(scene, keeper, ending, record, watcher)
            call checks%check(ending%status == status_complete, 'scene G is solved')
            associate (lowest => record%lowest, highest => record%highest)
               found = [highest(seen_acceleration)%value, lowest(seen_acceleration)%value, sqrt(record%acceleration_square), &
                        lowest(seen_films(1))%value, lowest(seen_films(2))%value, highest(seen_loads(1))%value, &
                        highest(seen_loads(2))%value]
            end associate
            do j = 1, 7
               call checks%check_close(found(j)/reference(j, law), 1.0_dp, errors(j, i) + last_digits(j), 'scene G, '// &
                                       trim(law_names(law))//', '//integer_text(nodes(i))//' nodes: '//trim(names(j)))
            end do
            if (law == viscosity_constant) &
               call checks%check_close(record%highest(seen_pressure)%value/pressure, 1.0_dp, 3.0e-3_dp, 'scene G: largest pressure')
         end do
      end do
   end subroutine test_scene_g

   !> A bound a hundred times as small, with films in nodes nearly all along, changes the peak by no more than a thousandth.
   subroutine test_bound(checks)
      type(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene
      type(window_keeper_t) :: keeper
      type(ending_t) :: ending
      type(window_record_t) :: record, all_in_nodes
      type(counting_watcher_t) :: watcher

      scene = scene_g(viscosity_roelands)
      scene%film%model = model_resolved
      scene%film%nodes = 64
      scene%solver%accuracy = 1.0e-2_dp
      scene%solver%kept_per_period = 64
      scene%solver%periods = 2
      scene%spectrum%periods = 1
      call solve(scene, keeper, ending, record, watcher)
      call solve(scene, keeper, ending, all_in_nodes, watcher, bound=1.0e-4_dp)
      call checks%check(ending%status == status_complete, 'scene G is solved in nodes')
      call checks%check_close(record%highest(seen_acceleration)%value/all_in_nodes%highest(seen_acceleration)%value, 1.0_dp, &
                              1.0e-3_dp, 'the bound hardly matters to the peak')
      call checks%check_close(record%lowest(seen_films(1))%value/all_in_nodes%lowest(seen_films(1))%value, 1.0_dp, 3.0e-3_dp, &
                              'nor to the film')
   end subroutine test_bound

   !> A run until steady ends with a window that repeats, and shows each period once.
   subroutine test_repetition(checks)
      type(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene
      type(window_keeper_t) :: keeper, longer
      type(ending_t) :: ending, last
      type(window_record_t) :: record, later
      type(counting_watcher_t) :: watcher, other

      scene = scene_g(viscosity_constant)
      scene%film%model = model_resolved
      scene%film%nodes = 32
      scene%solver%accuracy = 1.0e-2_dp
      scene%solver%method = method_taylor
      scene%solver%kept_per_period = 64
      scene%solver%periods = 60
      scene%solver%until = until_steady
      scene%spectrum%periods = 1
      call solve(scene, keeper, ending, record, watcher)
      call checks%check(ending%status == status_steady .and. ending%orbit == 1 .and. ending%periods < 30, 'scene G repeats')
      call checks%check(watcher%reported == ending%periods .and. watcher%all == ending%periods, 'each period is reported once')
      scene%solver%until = until_periods
      scene%solver%periods = 30
      call solve(scene, longer, last, later, other)
      call checks%check_close(record%highest(seen_acceleration)%value/later%highest(seen_acceleration)%value, 1.0_dp, &
                              1.0e-3_dp, 'its window is that of a long run')
      call checks%check_close(maxval(abs(keeper%accelerations - longer%accelerations))/maxval(abs(longer%accelerations)), 0.0_dp, &
                              1.0e-2_dp, 'sample for sample')
   end subroutine test_repetition

end module test_nodal_engine
