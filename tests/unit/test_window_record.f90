!> Tests of what the steps of a window show: extremes between samples, sums by which the window closes, Fourier integrals.
module test_window_record
   use canonical_scenes, only: canonical_scene
   use checks, only: check_list_t, same_bits
   use constants, only: two_pi
   use engine, only: ending_t, motion_state_t, request_t, start_of
   use classify_group, only: integral_record
   use kinds, only: dp
   use many_motions, only: solve_motions
   use node_extremes, only: extreme_t, find_extremes, seen_acceleration, seen_films, seen_loads, seen_pressure, &
      seen_quantities, seen_velocity
   use carried_loads, only: accelerations_of_samples
   use problem, only: of_film, of_velocity, problem_of, problem_t
   use rattle_class, only: classify, classify_steps, rattle_verdict_t
   use scene_status, only: status_complete
   use scene_types, only: law_iso_viscous, law_piezo_viscous, model_reynolds, rupture_solved, scene_t, spectrum_choice_t
   use step_nodes, only: add_piece, interpolate, node_place, node_weight, nodes_per_piece, step_nodes_t
   use window_extremes, only: extremes_of_samples, window_extremes_t
   use window_record, only: energy_gap, momentum_gap, record_period, start_record, window_record_t
   implicit none(type, external)
   private

   !> Samples that miss nothing of the canonical scenes: their extremes are off by (pi n/N)**2/2 of the highest harmonics.
   integer, parameter :: fine = 32768
   real(dp), parameter :: accuracy = 1.0e-9_dp

   public :: run_window_record_tests

contains

   !> Runs every test of this topic.
   subroutine run_window_record_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('window_record')
      call test_nodes(checks)
      call test_room(checks)
      call test_peaks(checks)
      call test_curves(checks)
      call test_canonical(checks)
      call test_pieces(checks)
      call test_impact(checks)
      call test_returning(checks)
      call test_coefficients(checks)
   end subroutine run_window_record_tests

   !> Eight nodes integrate and interpolate powers up to the fifteenth and the seventh.
   subroutine test_nodes(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: rounding = 16.0_dp*epsilon(1.0_dp)
      real(dp) :: state(2)
      integer :: k, i

      do k = 0, 15
         call checks%check_close(sum(node_weight*node_place**k), 1.0_dp/real(k + 1, dp), rounding, 'nodes: integral of a power')
      end do
      call checks%check(abs(sum(node_weight*node_place**16) - 1.0_dp/17.0_dp) > 1.0e-10_dp, 'nodes: not of the next one')
      do k = 0, nodes_per_piece - 1
         do i = 0, 10
            call interpolate(reshape([node_place**k, -node_place**k], [nodes_per_piece, 2]), 1, 0.1_dp*real(i, dp), state)
            call checks%check_close(state(of_film), (0.1_dp*real(i, dp))**k, 8.0_dp*rounding, 'nodes: a power between them')
            call checks%check_close(state(of_velocity), -state(of_film), 0.0_dp, 'nodes: the velocity like the film')
         end do
      end do
      call interpolate(reshape([node_place**3, node_place], [nodes_per_piece, 2]), 1, node_place(2), state)
      call checks%check_close(state(of_film), node_place(2)**3, 0.0_dp, 'nodes: at a node')
      call checks%check_close(state(of_velocity), node_place(2), 0.0_dp, 'nodes: velocity at a node')
   end subroutine test_nodes

   !> A lane that takes a motion of other states keeps its room: no piece is written beyond it.
   subroutine test_room(checks)
      type(check_list_t), intent(inout) :: checks

      integer, parameter :: numbers(3) = [6, 4, 6], pieces = 200
      type(step_nodes_t) :: nodes
      integer :: motion, piece, room

      do motion = 1, size(numbers)
         nodes%pieces = 0
         room = 0
         if (allocated(nodes%start)) room = size(nodes%start)
         do piece = 1, pieces
            call add_piece(real(piece, dp), 0.5_dp, spread(spread(real(piece, dp), 1, nodes_per_piece), 2, numbers(motion)), nodes)
         end do
         call checks%check(size(nodes%start) >= room .and. size(nodes%states, 2) == numbers(motion), 'room: of other states')
         call checks%check(size(nodes%states, 1) == nodes_per_piece*size(nodes%start), 'room: of all nodes')
         call checks%check(all(abs(nodes%start(:pieces) - [(piece, piece=1, pieces)]) <= 0.0_dp) .and. &
                           all(abs(nodes%states(nodes_per_piece:nodes_per_piece*pieces:nodes_per_piece, 1) - &
                                   nodes%start(:pieces)) <= 0.0_dp), 'room: pieces where they were put')
      end do
   end subroutine test_room

   !> A peak is found wherever it lies in its piece, also between the last node and the end.
   subroutine test_peaks(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: places = 40
      real(dp), parameter :: nearest = 1.0e-4_dp
      type(problem_t) :: scene
      type(extreme_t) :: lowest, highest
      real(dp) :: peak, velocities(nodes_per_piece), states(nodes_per_piece, 2)
      integer :: i

      states(:, of_film) = 1.0_dp
      do i = 0, places
         peak = nearest + (1.0_dp - 2.0_dp*nearest)*real(i, dp)/real(places, dp)
         ! Not a parabola, which three nodes would know.
         velocities = cos(0.5_dp*(node_place - peak)) + 0.01_dp*(node_place - peak)**3
         lowest = extreme_t()
         highest = extreme_t()
         states(:, of_velocity) = velocities
         call find_extremes(scene, seen_velocity, 0, [0.0_dp], [1.0_dp], states, velocities, lowest, highest)
         call checks%check_close(highest%value, 1.0_dp, 1.0e-11_dp, 'a peak between nodes')
         lowest = extreme_t()
         highest = extreme_t()
         states(:, of_velocity) = -velocities
         call find_extremes(scene, seen_velocity, 0, [0.0_dp], [1.0_dp], states, -velocities, lowest, highest)
         call checks%check_close(lowest%value, -1.0_dp, 1.0e-11_dp, 'a trough between nodes')
      end do
   end subroutine test_peaks

   !> Curves of up to 1.27 oscillations a piece, several of whose peaks look alike by parabolas through their nodes: the highest and
   !> the lowest place of each is found, to what eight nodes show.
   subroutine test_curves(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: curves = 2000, pieces = 8, lines = 3, places = 200
      type(problem_t) :: scene
      type(extreme_t) :: lowest, highest
      real(dp) :: drawn(3, lines), states(nodes_per_piece*pieces, 2), state(2), truth(2), reported(2), value
      integer :: i, j, piece

      states(:, of_film) = 1.0_dp
      truth = 0.0_dp
      reported = 0.0_dp
      do i = 1, curves
         ! Golden multiples are spread as evenly as random numbers, and the same on every machine.
         drawn = reshape([(modulo(0.61803398874989485_dp*real(9*i + j, dp)*real(j, dp), 1.0_dp), j=1, 3*lines)], [3, lines])
         do piece = 1, pieces
            states(nodes_per_piece*(piece - 1) + 1:nodes_per_piece*piece, of_velocity) = &
               curve(drawn, real(piece - 1, dp) + node_place)
         end do
         lowest = extreme_t()
         highest = extreme_t()
         call find_extremes(scene, seen_velocity, 0, [(real(piece - 1, dp), piece=1, pieces)], spread(1.0_dp, 1, pieces), states, &
                            states(:, of_velocity), lowest, highest)
         truth = [huge(1.0_dp), -huge(1.0_dp)]
         do piece = 1, pieces
            do j = 0, places
               call interpolate(states, piece, real(j, dp)/real(places, dp), state)
               truth = [min(truth(1), state(of_velocity)), max(truth(2), state(of_velocity))]
            end do
         end do
         reported = [lowest%value, highest%value]
         value = 1.0e-9_dp*(truth(2) - truth(1))
         if (reported(1) > truth(1) + value .or. reported(2) < truth(2) - value) exit
      end do
      call checks%check_close(reported(1), min(reported(1), truth(1)), 1.0e-8_dp, 'curves: the lowest place')
      call checks%check_close(reported(2), max(reported(2), truth(2)), 1.0e-8_dp, 'curves: the highest place')

   contains

      !> Cosines of a frequency, an amplitude and a phase each.
      pure elemental real(dp) function cosine(frequency, amplitude, phase, x)
         real(dp), intent(in) :: frequency
         real(dp), intent(in) :: amplitude
         real(dp), intent(in) :: phase
         real(dp), intent(in) :: x

         cosine = amplitude*cos(two_pi*(1.27_dp*frequency*x + phase))
      end function cosine

      !> Their sum.
      pure function curve(drawn, x) result(values)
         real(dp), intent(in) :: drawn(:, :)
         real(dp), intent(in) :: x(:)
         real(dp) :: values(size(x))
         integer :: line

         values = 0.0_dp
         do line = 1, size(drawn, 2)
            values = values + cosine(drawn(1, line), drawn(2, line), drawn(3, line), x)
         end do
      end function curve

   end subroutine test_curves

   !> All film laws: extremes as those of very many samples, closed windows, harmonics as those of the samples; Taylor series and
   !> collocation.
   subroutine test_canonical(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      character(*), parameter :: names(4) = [character(15) :: 'half-pi', 'solved', 'published piezo', 'exact']
      type(scene_t) :: scene
      integer :: law, implicit

      do law = 1, 4
         do implicit = 0, 1
            scene = canonical_scene(merge(law_piezo_viscous, law_iso_viscous, law == 3), 512)
            if (law == 2) scene%film%rupture = rupture_solved
            if (law == 4) scene%film%model = model_reynolds
            if (law == 4) scene%kinematics%entrainment_speed = 0.5_dp*1.905_dp
            call compare_with_samples(checks, scene, implicit == 1, trim(names(law)))
         end do
      end do
   end subroutine test_canonical

   !> Hold the record of two periods against their samples.
   subroutine compare_with_samples(checks, scene, implicit, name)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(scene_t), intent(in) :: scene           !> The scene
      logical, intent(in) :: implicit              !> By collocation
      character(*), intent(in) :: name             !> Of its law

      integer, parameter :: window = 2
      type(problem_t) :: lane
      type(motion_state_t) :: start
      type(ending_t) :: endings(1)
      type(window_record_t) :: records(1), integrals(1)
      type(window_extremes_t) :: extremes
      type(rattle_verdict_t) :: by_samples, by_steps
      type(spectrum_choice_t) :: choice
      real(dp), allocatable :: states(:, :, :), accelerations(:)
      real(dp) :: size_of
      integer :: quantity

      lane = problem_of(scene)
      start = start_of(lane)
      start%implicit = implicit
      allocate (states(window*fine, 2, 1), accelerations(window*fine))
      call solve_motions([lane], [start], request_t(accuracy=accuracy, periods=30, samples_per_period=fine, &
         sampled_periods=window), states, endings, records=records)
      call checks%check(endings(1)%status == status_complete .and. records(1)%periods == window, name//': recorded')
      call accelerations_of_samples(lane, fine, states(:, :, 1), accelerations)
      extremes = extremes_of_samples(lane, states(:, :, 1), accelerations)
      do quantity = 1, seen_quantities
         size_of = extremes%highest(quantity)%value - extremes%lowest(quantity)%value
         ! Samples fall short of the extreme, by (pi 100/fine)**2/2 of the range for a hundred harmonics.
         call checks%check(records(1)%highest(quantity)%value >= extremes%highest(quantity)%value - 1.0e-8_dp*size_of .and. &
            records(1)%highest(quantity)%value <= extremes%highest(quantity)%value + 1.0e-6_dp*size_of, name//': highest')
         ! No quantity is where the largest pressure of the film is smallest.
         if (quantity == seen_pressure) cycle
         call checks%check(records(1)%lowest(quantity)%value <= extremes%lowest(quantity)%value + 1.0e-8_dp*size_of .and. &
            records(1)%lowest(quantity)%value >= extremes%lowest(quantity)%value - 1.0e-6_dp*size_of, name//': lowest')
      end do
      associate (fastest => extremes%highest(seen_velocity))
         call checks%check(abs(fastest%state(of_velocity) - fastest%value) <= 0.0_dp, name//': the state is that of the sample')
      end associate
      call checks%check(momentum_gap(records(1), lane%frequency) < 1.0e-8_dp, name//': momentum closes')
      call checks%check(energy_gap(records(1), lane%mass) < 1.0e-8_dp, name//': energy closes')
      call checks%check_close(records(1)%acceleration_square/real(window, dp)*real(size(accelerations), dp) &
         /sum(accelerations**2), 1.0_dp, 1.0e-8_dp, name//': mean square')

      choice%periods = window
      integrals(1) = integral_record(choice)
      call solve_motions([lane], [start], request_t(accuracy=accuracy, periods=30, samples_per_period=1, &
         sampled_periods=window, every_period=.true.), states, endings, records=integrals)
      call classify(accelerations, choice, 1.0e-9_dp, by_samples)
      call classify_steps(integrals(1), lane%frequency, choice, 1.0e-9_dp, by_steps)
      ! The accelerations of samples follow from the film law, which the steps obey to a hundred times their accuracy.
      call checks%check(maxval(abs(by_steps%spectrum%harmonics &
         - by_samples%spectrum%harmonics(:size(by_steps%spectrum%harmonics)))) &
         < 100.0_dp*accuracy*by_samples%spectrum%harmonics(1), name//': harmonics by integrals')
      ! Forty multiples are integrated for; where harmonics lie beyond them, their count is a lower bound.
      call checks%check(by_steps%class == by_samples%class .and. by_steps%spectrum%harmonic_count == &
         min(by_samples%spectrum%harmonic_count, &
         count(by_samples%spectrum%harmonics(:integrals(1)%multiples) > 0.01_dp*by_samples%spectrum%harmonics(1))), &
         name//': class and harmonics by integrals')
      call checks%check(by_steps%spectrum%count_is_bound .or. by_steps%spectrum%harmonic_count == &
         by_samples%spectrum%harmonic_count, &
         name//': fewer harmonics are a lower bound')
      call checks%check_close(by_steps%spectrum%harmonic_distortion/by_samples%spectrum%harmonic_distortion, 1.0_dp, 1.0e-8_dp, &
         name//': distortion by integrals')
      call checks%check_close(by_steps%reversals_per_period, by_samples%reversals_per_period, 0.0_dp, name//': reversals by steps')
   end subroutine compare_with_samples

   !> A window recorded in two calls is one recorded in one call, to the last bit.
   subroutine test_pieces(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(scene_t) :: scene
      type(problem_t) :: lane
      type(ending_t) :: endings(1)
      type(window_record_t) :: whole(1), parts(1)
      real(dp) :: states(4, 2, 1)
      integer :: quantity

      scene = canonical_scene(law_iso_viscous, 512)
      lane = problem_of(scene)
      call solve_motions([lane], [start_of(lane)], request_t(accuracy=accuracy, periods=4, samples_per_period=1, &
         sampled_periods=4), states, endings, records=whole)
      call solve_motions([lane], [start_of(lane)], request_t(accuracy=accuracy, periods=3, samples_per_period=1, &
         sampled_periods=3), states, endings, records=parts)
      call solve_motions([lane], [endings(1)%motion_state_t], request_t(accuracy=accuracy, periods=4, samples_per_period=1, &
         sampled_periods=1), states, endings, records=parts)
      call checks%check(parts(1)%periods == 4, 'parts: all periods')
      do quantity = 1, seen_quantities
         call checks%check(same_bits(parts(1)%highest(quantity)%value, whole(1)%highest(quantity)%value) .and. &
            same_bits(parts(1)%lowest(quantity)%value, whole(1)%lowest(quantity)%value), 'parts: extremes')
      end do
      call checks%check(same_bits(parts(1)%acceleration_sum, whole(1)%acceleration_sum) .and. &
         same_bits(parts(1)%film_work, whole(1)%film_work), 'parts: sums')
      call checks%check(same_bits(parts(1)%start%numbers(of_film), whole(1)%start%numbers(of_film)) .and. &
         same_bits(parts(1)%end_velocity, whole(1)%end_velocity), 'parts: ends')
   end subroutine test_pieces

   !> Ten times the static load at 15 Hz: an impact of a millionth of a period, which 65536 samples a period miss. Values of an
   !> independent solver to six digits: a_1 = 290.754, a_2 = 152.365, film below 0.1 nm.
   subroutine test_impact(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(scene_t) :: scene
      type(problem_t) :: lane
      type(ending_t) :: endings(1)
      type(window_record_t) :: records(1)
      type(rattle_verdict_t) :: verdict
      type(spectrum_choice_t) :: choice
      real(dp) :: states(8, 2, 1)

      scene = canonical_scene(law_iso_viscous, 512)
      scene%excitation%force_amplitude = 700.0_dp
      scene%excitation%frequency = 15.0_dp
      lane = problem_of(scene)
      choice%periods = 8
      records(1) = integral_record(choice)
      records(1)%wants = .true.
      call solve_motions([lane], [start_of(lane)], request_t(accuracy=1.0e-8_dp, periods=40, samples_per_period=1, &
         sampled_periods=8, &
         every_period=.true.), states, endings, records=records)
      call classify_steps(records(1), lane%frequency, choice, 1.0e-9_dp, verdict)
      call checks%check_close(verdict%spectrum%harmonics(1), 290.754_dp, 1.0e-3_dp, 'impact: first harmonic')
      call checks%check_close(verdict%spectrum%harmonics(2), 152.365_dp, 1.0e-3_dp, 'impact: second harmonic')
      call checks%check(records(1)%lowest(seen_films(1))%value < 0.1e-9_dp, 'impact: thinnest film')
      call checks%check(records(1)%highest(seen_velocity)%value - records(1)%lowest(seen_velocity)%value > 5.0_dp, &
         'impact: jump of the velocity')
      call checks%check(verdict%spectrum%count_is_bound .and. verdict%spectrum%harmonic_count == records(1)%multiples, &
         'impact: more harmonics than are resolved')
      call checks%check(.not. verdict%spectrum%distortion_is_bound .and. verdict%spectrum%harmonic_distortion > 1000.0_dp, &
         'impact: distortion by the whole power')
      call checks%check(momentum_gap(records(1), lane%frequency) < 1.0e-6_dp, 'impact: momentum closes')
      call checks%check(energy_gap(records(1), lane%mass) < 1.0e-6_dp, 'impact: energy closes')
      call checks%check(all(records(1)%highest([seen_acceleration, seen_loads(1), seen_pressure])%value > 1.0e10_dp), &
         'impact: peaks')
   end subroutine test_impact

   !> Periods that only return to the last bit are not recorded again, and the sums are those of the periods recorded.
   subroutine test_returning(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(scene_t) :: scene
      type(problem_t) :: lane
      type(ending_t) :: endings(1)
      type(window_record_t) :: records(1)
      real(dp) :: states(100, 2, 1)

      scene = canonical_scene(law_iso_viscous, 512)
      lane = problem_of(scene)
      call solve_motions([lane], [start_of(lane)], request_t(accuracy=accuracy, periods=400, samples_per_period=1, &
         sampled_periods=100), &
         states, endings, records=records)
      call checks%check(endings(1)%samples == 100 .and. records(1)%periods > 0 .and. records(1)%periods < 100, &
         'returning: fewer periods recorded than sampled')
      call checks%check(momentum_gap(records(1), lane%frequency) < 1.0e-8_dp .and. energy_gap(records(1), lane%mass) < 1.0e-8_dp, &
         'returning: the window closes')
   end subroutine test_returning

   !> T c_n of velocities whose Fourier coefficients are known: c_n = 1/T (change of z' + 2 pi i n/T integral of z' exp(-2 pi i n
   !> t/T) dt). A ramp has a constant z'', so all of them are nought; sine and cosine of the k-th multiple give pi k and pi k i.
   subroutine test_coefficients(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: pieces = 100
      real(dp), parameter :: rounding = 1.0e-12_dp
      type(problem_t) :: lane
      type(step_nodes_t) :: nodes
      type(window_record_t) :: record
      complex(dp) :: expected
      real(dp) :: phases(nodes_per_piece*pieces)
      integer :: multiples, n, k, i

      lane = problem_of(canonical_scene(law_iso_viscous, 512))
      nodes%start = [(real(i, dp)/real(pieces, dp), i=0, pieces - 1)]
      nodes%length = [(1.0_dp/real(pieces, dp), i=1, pieces)]
      do i = 1, pieces
         phases(nodes_per_piece*(i - 1) + 1:nodes_per_piece*i) = nodes%start(i) + node_place*nodes%length(i)
      end do
      allocate (nodes%states(size(phases), 2))
      nodes%states(:, of_film) = 1.0e-6_dp
      do multiples = 3, 8
         record = window_record_t(multiples=multiples)
         call start_record(motion_state_t(numbers=[1.0e-6_dp, 0.0_dp]), record)
         nodes%pieces = pieces
         nodes%states(:, of_velocity) = phases
         call record_period(lane, 1.0_dp, nodes, record)
         call checks%check(abs(record%harmonic_sums(0) - 1.0_dp) < rounding, 'coefficients: mean of a ramp')
         call checks%check(all(abs(record%harmonic_sums(1:)) < rounding), 'coefficients: of a ramp')
         do k = 1, multiples
            call start_record(motion_state_t(numbers=[1.0e-6_dp, 0.0_dp]), record)
            nodes%pieces = pieces
            nodes%states(:, of_velocity) = sin(two_pi*real(k, dp)*phases) + 2.0_dp*cos(two_pi*real(k, dp)*phases)
            call record_period(lane, 0.0_dp, nodes, record)
            do n = 0, multiples
               expected = merge(cmplx(0.5_dp, 1.0_dp, dp)*two_pi*real(k, dp), (0.0_dp, 0.0_dp), n == k)
               call checks%check(abs(record%harmonic_sums(n) - expected) < rounding*two_pi*real(multiples, dp), &
                  'coefficients: of sine and cosine')
            end do
         end do
      end do
   end subroutine test_coefficients

end module test_window_record
