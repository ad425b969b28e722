!> Tests of films with a state of their own: motions of a chain of relaxing films against their exact solution, on one flank and
!> two, of rigid teeth and elastic ones; carried on, over a period, repeating, verified and in a campaign.
module test_inner_states
   use canonical_scenes, only: canonical_scene
   use checks, only: check_list_t, same_bits
   use constants, only: two_pi
   use controlled_engine, only: solve_window
   use engine, only: checkpoint_t, ending_t, motion_state_t, request_t, start_of
   use errors, only: error_t
   use byte_file, only: put_in_place
   use film_states, only: add_film_state
   use judged_scene, only: judged_scene_t, quantity_value
   use key_table, only: find_key
   use kinds, only: dp, int64
   use linear_equations, only: eigenvalues
   use many_motions, only: solve_motions
   use output_place, only: state_path
   use periodic_orbit, only: find_periodic_orbit, periodic_orbit_t
   use problem, only: contact_count, film_at_rest, has_damped_teeth, has_elastic_teeth, inner_places, &
      of_drive_compression, of_film, of_velocity, problem_of, problem_t, state_size, static_load
   use quantities, only: quantity_acceleration_maximum, quantity_verified, quantity_film_minimum, quantity_rattle_class, &
      quantity_table
   use relaxing_film, only: chain_length, relaxing_film_t
   use resume, only: load_state, save_state
   use scene_solution, only: solve_in_memory
   use sampling, only: plan_table, sample_plan_t
   use scene_status, only: is_success, status_complete
   use scene_types, only: method_taylor, scene_t, until_steady
   use judge_group, only: judgement_space_t
   use solve_chunk, only: solve_scenes
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Code of the law in a scene
   integer, parameter :: law_relaxing = 1001

   public :: run_inner_states_tests

contains

   !> Runs every test of this topic.
   subroutine run_inner_states_tests(checks)
      type(check_list_t), intent(inout) :: checks
      type(relaxing_film_t), target, save :: chain

      call checks%start('inner_states')
      call add_film_state(law_relaxing, chain)
      call test_exact_motions(chain, checks)
      call test_carried_on(checks)
      call test_multipliers(chain, checks)
      call test_scene(checks)
   end subroutine run_inner_states_tests

   !> A scene of such films.
   function relaxing_scene(stiffness, backlash, damping_ratio) result(scene)
      !> Of the teeth [N/m], 0: rigid; and backlash [m], 0: one flank
      real(dp), intent(in) :: stiffness
      real(dp), intent(in) :: backlash
      !> Of the teeth; absent: 0 [-]
      real(dp), intent(in), optional :: damping_ratio
      type(scene_t) :: scene

      scene = canonical_scene(law_relaxing, 64)
      scene%excitation%force_amplitude = 100.0_dp
      scene%contact%stiffness = stiffness
      scene%contact%backlash = backlash
      if (present(damping_ratio)) scene%contact%damping_ratio = damping_ratio
      scene%solver%method = method_taylor
      scene%solver%accuracy = 1.0e-9_dp
   end function relaxing_scene

   !> Samples of three periods from a start that is not at rest, against the matrix exponential.
   subroutine test_exact_motions(chain, checks)
      type(relaxing_film_t), intent(in) :: chain
      type(check_list_t), intent(inout) :: checks
      integer, parameter :: samples = 32, periods = 3
      real(dp), parameter :: stiffnesses(3) = [0.0_dp, 3.0e7_dp, 3.0e7_dp], damping_ratios(3) = [0.0_dp, 0.0_dp, 0.1_dp]
      real(dp), parameter :: backlashes(2) = [0.0_dp, 2.2e-4_dp]
      real(dp), parameter :: accuracy = 1.0e-9_dp
      type(problem_t) :: problem
      type(motion_state_t) :: start
      type(ending_t) :: endings(1)
      real(dp), allocatable :: states(:, :, :), exact(:), map(:, :)
      real(dp) :: error, load
      integer :: i, j, k

      do i = 1, size(stiffnesses)
         do j = 1, size(backlashes)
            problem = problem_of(relaxing_scene(stiffnesses(i), backlashes(j), damping_ratios(i)))
            start = start_of(problem)
            call checks%check(size(start%numbers) == 2 + j*(i - 1) + j*chain_length, 'numbers of a state')
            load = chain%stiffness*(chain%reach - start%numbers(of_film))
            if (j == 1) call checks%check_close(load/static_load(problem), 1.0_dp, 1.0e-12_dp, 'rest: the film carries the load')
            start%numbers(of_film) = 1.02_dp*start%numbers(of_film)
            start%numbers(of_velocity) = 0.003_dp
            start%numbers(state_size(problem)) = 0.98_dp*start%numbers(state_size(problem))
            if (allocated(exact)) deallocate (exact)
            allocate (exact, source=augmented(start%numbers))
            call put_loads(chain, problem, exact)
            start%numbers = exact(:state_size(problem))
            allocate (states(samples*periods, state_size(problem), 1), source=0.0_dp)
            call solve_motions([problem], [start], request_t(accuracy=accuracy, periods=periods, samples_per_period=samples, &
                                                             sampled_periods=periods), states, endings)
            call checks%check(endings(1)%status == status_complete .and. endings(1)%samples == samples*periods, 'exact: solved')
            map = exponential(motion_matrix(chain, problem)/(problem%frequency*real(samples, dp)))
            exact = augmented(start%numbers)
            error = 0.0_dp
            do k = 1, samples*periods
               exact = matmul(map, exact)
               call put_loads(chain, problem, exact)
               error = max(error, maxval(abs(states(k, :, 1) - exact(:state_size(problem)))*counted(problem))/exact(of_film))
            end do
            call checks%check_close(error, 0.0_dp, 20.0_dp*accuracy, 'exact: states of the samples')
            error = maxval(abs(endings(1)%numbers - states(samples*periods, :, 1))*counted(problem))/exact(of_film)
            call checks%check_close(error, 0.0_dp, accuracy, 'exact: the last sample is the end')
            deallocate (states)
         end do
      end do
   end subroutine test_exact_motions

   !> Film that one of each number counts as.
   function counted(problem)
      type(problem_t), intent(in) :: problem
      real(dp) :: counted(state_size(problem))

      counted = 1.0_dp
      counted(of_velocity) = 1.0_dp/(two_pi*problem%frequency)
   end function counted

   !> A state and the parts of the force: 1, cosine and sine.
   pure function augmented(state)
      real(dp), intent(in) :: state(:)
      real(dp) :: augmented(size(state) + 3)

      augmented = [state, 1.0_dp, 1.0_dp, 0.0_dp]
   end function augmented

   !> Matrix of the equations of motion of an augmented state.
   function motion_matrix(chain, problem) result(matrix)
      type(relaxing_film_t), intent(in) :: chain
      type(problem_t), intent(in) :: problem
      real(dp), allocatable :: matrix(:, :)
      real(dp), allocatable :: unit(:)
      integer :: n, i

      n = state_size(problem) + 3
      allocate (matrix(n, n))
      do i = 1, n
         unit = spread(0.0_dp, 1, n)
         unit(i) = 1.0_dp
         matrix(:, i) = slope_of(unit)
      end do

   contains

      !> d/dt of an augmented state, linear in it.
      function slope_of(x) result(slope)
         real(dp), intent(in) :: x(:)
         real(dp) :: slope(size(x)), film, velocity, load, net, turn
         integer :: flank, places(2), of_spring

         slope = 0.0_dp
         net = 0.0_dp
         do flank = 1, contact_count(problem)
            places = inner_places(problem, flank)
            of_spring = of_velocity + flank
            turn = merge(1.0_dp, -1.0_dp, flank == 1)
            film = x(of_film)
            if (flank == 2) film = problem%backlash*x(n - 2) - x(of_film)
            if (has_elastic_teeth(problem)) then
               if (has_damped_teeth(problem)) of_spring = of_spring + contact_count(problem)
               if (flank == 2) film = film + x(of_spring - 1) + x(of_spring)
               load = x(of_spring)/problem%contact%compliance
               velocity = (chain%stiffness*(chain%reach*x(n - 2) - film) - chain%chain_stiffness*(film - x(places(2))) - load) &
                          /chain%damping
               if (has_damped_teeth(problem)) then
                  associate (c => problem%contact%retardation/problem%contact%compliance)
                     velocity = (chain%damping*velocity + c*turn*x(of_velocity))/(chain%damping + c)
                     load = load + c*(velocity - turn*x(of_velocity))
                  end associate
               end if
               slope(of_spring) = velocity - turn*x(of_velocity)
               if (flank == 1) slope(of_film) = velocity
            else
               velocity = turn*x(of_velocity)
               load = chain%stiffness*(chain%reach*x(n - 2) - film) - chain%chain_stiffness*(film - x(places(2))) &
                      - chain%damping*velocity
               if (flank == 1) slope(of_film) = velocity
            end if
            net = net + turn*load
            slope(places(1):places(2)) = ([film, x(places(1):places(2) - 1)] - x(places(1):places(2)))/chain%times
         end do
         slope(of_velocity) = (net - static_load(problem)*x(n - 2) - problem%force%cosine*x(n - 1))/problem%mass
         slope(n - 1) = -two_pi*problem%frequency*x(n)
         slope(n) = two_pi*problem%frequency*x(n - 1)
      end function slope_of

   end function motion_matrix

   !> Put the loads of damped teeth into an augmented state, kappa W = D + tau D'.
   subroutine put_loads(chain, problem, x)
      type(relaxing_film_t), intent(in) :: chain
      type(problem_t), intent(in) :: problem
      real(dp), intent(inout) :: x(:)
      real(dp) :: slope(size(x))
      integer :: last

      if (.not. has_damped_teeth(problem)) return
      slope = matmul(motion_matrix(chain, problem), x)
      last = of_velocity + contact_count(problem)
      x(of_drive_compression:last) = x(last + 1:2*last - of_velocity) + &
                                     problem%contact%retardation*slope(last + 1:2*last - of_velocity)
   end subroutine put_loads

   !> Exponential of a matrix: Taylor's series of a small share of it, squared.
   function exponential(matrix) result(power)
      real(dp), intent(in) :: matrix(:, :)
      real(dp) :: power(size(matrix, 1), size(matrix, 1)), term(size(matrix, 1), size(matrix, 1)), small
      integer :: halvings, i

      halvings = max(0, ceiling(log(maxval(sum(abs(matrix), dim=1)))/log(2.0_dp)) + 2)
      small = 0.5_dp**halvings
      power = 0.0_dp
      do i = 1, size(matrix, 1)
         power(i, i) = 1.0_dp
      end do
      term = power
      do i = 1, 20
         term = matmul(term, matrix)*(small/real(i, dp))
         power = power + term
      end do
      do i = 1, halvings
         term = matmul(power, power)
         power = term
      end do
   end function exponential

   !> Carried on, in memory and through a file of state, a motion is the same to the last bit.
   subroutine test_carried_on(checks)
      type(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene
      type(problem_t) :: problem
      type(request_t) :: request
      type(ending_t) :: whole(1), part(1), rest(1)
      type(checkpoint_t) :: kept, read_back
      type(error_t), allocatable :: error
      real(dp) :: none(0, 2, 1)
      integer :: unit

      scene = relaxing_scene(3.0e7_dp, 2.2e-4_dp)
      scene%solver%periods = 20
      problem = problem_of(scene)
      request = request_t(accuracy=1.0e-9_dp, periods=7)
      call solve_motions([problem], [start_of(problem)], request, none, whole)
      request%periods = 3
      call solve_motions([problem], [start_of(problem)], request, none, part)
      kept%motion_state_t = part(1)%motion_state_t
      scene%name = 'rattle_test_inner_states'
      scene%resolved_input = ''
      scene%output%directory = '.'
      call save_state(scene, kept, error)
      if (.not. allocated(error)) call put_in_place(state_path(scene), error)
      call checks%check(.not. allocated(error), 'carried on: the state is kept')
      if (allocated(error)) return
      call load_state(scene, read_back, error)
      call checks%check(.not. allocated(error), 'carried on: the state is read')
      call checks%check(read_back%periods == 3, 'carried on: where it was left')
      if (read_back%periods == 3) then
         request%periods = 7
         call solve_motions([problem], [read_back%motion_state_t], request, none, rest)
         call checks%check(all(same_bits(whole(1)%numbers, rest(1)%numbers)), 'carried on: to the last bit')
      end if
      open (newunit=unit, file=state_path(scene))
      close (unit, status='delete')
   end subroutine test_carried_on

   !> The periodic motion of the whole state, and its multipliers: eigenvalues of the exact map.
   subroutine test_multipliers(chain, checks)
      type(relaxing_film_t), intent(in) :: chain
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: backlashes(2) = [0.0_dp, 2.2e-4_dp]
      type(problem_t) :: problem
      type(ending_t) :: found
      type(periodic_orbit_t) :: orbit
      type(window_record_t) :: record
      real(dp), allocatable :: map(:, :), image(:), states(:, :), z(:)
      complex(dp), allocatable :: exact(:)
      integer :: i

      do i = 1, size(backlashes)
         problem = problem_of(relaxing_scene(3.0e7_dp, backlashes(i)))
         call solve_window(problem, start_of(problem), 1.0e-9_dp, 1, 200, 1, states, z, found, record, until_steady=.true.)
         call checks%check(is_success(found%status) .and. found%orbit == 1, 'multipliers: the motion repeats')
         map = exponential(motion_matrix(chain, problem)/problem%frequency)
         exact = eigenvalues(map(:state_size(problem), :state_size(problem)))
         orbit = find_periodic_orbit(problem, found%numbers, 1.0e-3_dp)
         call checks%check(orbit%period == 1 .and. size(orbit%multipliers) == state_size(problem), 'multipliers: of all numbers')
         if (orbit%period /= 1) cycle
         call checks%check_close(maxval(abs(orbit%multipliers(:4) - exact(:4))), 0.0_dp, 1.0e-6_dp, 'multipliers: the largest ones')
         image = matmul(map, augmented(orbit%state))
         call checks%check_close(maxval(abs(image(:state_size(problem)) - orbit%state)*counted(problem))/orbit%state(of_film), &
                                 0.0_dp, 1.0e-9_dp, 'multipliers: the exact map leaves the motion where it is')
      end do
   end subroutine test_multipliers

   !> As a single scene, verified, and as a row of a campaign.
   subroutine test_scene(checks)
      type(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene
      type(judged_scene_t) :: judged
      type(error_t), allocatable :: error
      type(judgement_space_t), allocatable :: space
      type(sample_plan_t) :: plan
      real(dp), allocatable :: values(:, :), rows(:, :)
      integer, parameter :: reported(*) = [quantity_rattle_class, quantity_verified, quantity_film_minimum, &
                                       quantity_acceleration_maximum]
      integer :: i

      scene = relaxing_scene(0.0_dp, 0.0_dp)
      scene%solver%until = until_steady
      scene%solver%periods = 200
      scene%solver%kept_per_period = 64
      scene%campaign%samples_per_period = 64
      scene%campaign%record = reported
      scene%resolved_input = ''
      call solve_in_memory(scene, judged, error)
      call checks%check(judged%judged .and. quantity_value(quantity_verified, judged) > 0.5_dp, 'scene: verified')
      allocate (values, source=reshape(scene%excitation%force_amplitude*[1.0_dp, 0.5_dp], [1, 2]))
      call plan_table([find_key('load.force_amplitude')], values, plan)
      allocate (rows(3 + size(reported), 2), space)
      call solve_scenes(scene, plan, 1_int64, space, rows, error)
      do i = 1, size(reported)
         call checks%check_close(rows(3 + i, 1)/quantity_value(reported(i), judged), 1.0_dp, 1.0e-6_dp, &
                                 'campaign: '//trim(quantity_table(reported(i))%name))
      end do
      ! Half the force moves the film half as far from its rest.
      call checks%check_close((rows(6, 2) - film_at_rest(judged%resolved%problem, static_load(judged%resolved%problem))) &
                              /(rows(6, 1) - film_at_rest(judged%resolved%problem, static_load(judged%resolved%problem))), &
                              0.5_dp, 1.0e-6_dp, 'campaign: a linear motion')
   end subroutine test_scene

end module test_inner_states
