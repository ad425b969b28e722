!> Tests of elastic teeth: references of independent codes, the limit of stiff teeth, small motions, order of Newmark's method.
module test_elastic_teeth
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use canonical_scenes, only: canonical_scene, loose_gear
   use checks, only: check_list_t
   use controlled_engine, only: solve_window
   use engine, only: ending_t, motion_state_t, request_t, start_of
   use film_law, only: film_load
   use fourier, only: amplitude_spectrum
   use judged_scene, only: judged_scene_t, quantity_value
   use kinds, only: dp
   use linear_motion, only: natural_motion
   use many_motions, only: solve_motions
   use node_extremes, only: seen_films, seen_loads, seen_position
   use periodic_orbit, only: find_periodic_orbit, periodic_orbit_t
   use carried_loads, only: contact_films, gear_positions
   use starting_state, only: initial_state
   use problem, only: film_at_rest, films_at_rest, loads_at_rest, of_drive_compression, of_film, of_velocity, problem_of, &
      problem_t, static_load
   use quantities, only: quantity_damping_ratio, quantity_natural_frequency
   use prepared_scene, only: resolved_scene_t
   use scene_status, only: is_success, status_complete, status_no_rigid_film
   use scene_types, only: law_iso_viscous, law_piezo_viscous, model_published, model_reynolds, rupture_half_pi, rupture_solved, &
      scene_t
   use window_record, only: energy_gap, window_record_t
   implicit none(type, external)
   private

   !> Samples of a period of the references, accuracy of the engine, agreement with them.
   integer, parameter :: samples = 2048
   real(dp), parameter :: accuracy = 1.0e-9_dp, agreement = 1.0e-6_dp

   public :: run_elastic_teeth_tests

contains

   !> Runs every test of this topic.
   subroutine run_elastic_teeth_tests(checks)
      type(check_list_t), intent(inout) :: checks

      call checks%start('elastic_teeth')
      call compare(checks, 'S1', canonical(law_iso_viscous, model_reynolds, 1.0e8_dp), [-8.0451176e-06_dp, 1.7592233e-05_dp], &
                   [4.4165721e-07_dp, 1.7791013e-05_dp], [-137.09369_dp, 273.10504_dp], [13.1545_dp, 851.6997_dp], &
                   [179.1303_dp, 65.92906_dp, 27.95162_dp, 8.087156_dp, 4.063589_dp, 3.244983_dp])
      call compare(checks, 'S2', canonical(law_iso_viscous, model_reynolds, 3.0e8_dp), [-4.3164787e-06_dp, 2.3549764e-05_dp], &
                   [2.8681202e-07_dp, 2.3599900e-05_dp], [-138.54144_dp, 447.15241_dp], [10.3895_dp, 1393.8812_dp], &
                   [188.5199_dp, 101.95991_dp, 73.45934_dp, 48.29567_dp, 28.61970_dp, 15.09713_dp])
      call compare(checks, 'S3', canonical(law_iso_viscous, model_published, 1.0e9_dp), [-7.2750257e-07_dp, 3.7120931e-06_dp], &
                   [2.5271515e-07_dp, 3.7657064e-06_dp], [-115.71702_dp, 196.88632_dp], [35.6678_dp, 1024.6143_dp], &
                   [25.04402_dp, 38.72661_dp, 48.19850_dp, 46.01152_dp, 31.18127_dp, 17.62888_dp])
      call compare(checks, 'S4', canonical(law_piezo_viscous, model_published, 3.0e8_dp), [-1.6181008e-06_dp, 2.6993669e-06_dp], &
                   [7.6277243e-07_dp, 2.7210544e-06_dp], [-63.473246_dp, 100.396692_dp], [2.1309_dp, 733.9331_dp], &
                   [21.23886_dp, 55.53131_dp, 31.68247_dp, 1.048872_dp, 1.427171_dp, 1.322506_dp])
      call compare(checks, 'S5', between_flanks(), [1.6215028e-06_dp, 9.5334473e-05_dp], [2.0209873e-06_dp, 9.5342724e-05_dp], &
                   [-15.810873_dp, 34.772748_dp], [0.3820_dp, 22.4316_dp], &
                   [1.0586044_dp, 2.0625726_dp, 1.5370627_dp, 0.8834755_dp, 1.8064580_dp, 2.0901589_dp], &
                   [4.8281494e-06_dp, 9.8386477e-05_dp], [0.3564_dp, 8.8322_dp])
      call test_rest(checks)
      call test_small_motions(checks)
      call test_stiff_teeth(checks)
      call test_two_ways(checks)
      call test_film_that_ceases(checks)
      call test_mirror(checks)
      call test_no_company(checks)
      call test_soft_teeth(checks)
      call test_lost_load(checks)
      call test_kept_load(checks)
   end subroutine run_elastic_teeth_tests

   !> The canonical scene, steady under Q + m g, on elastic teeth.
   type(problem_t) function canonical(law, model, stiffness)
      integer, intent(in) :: law
      integer, intent(in) :: model
      !> k [N/m]
      real(dp), intent(in) :: stiffness
      type(scene_t) :: scene

      scene = canonical_scene(law, 256)
      scene%film%model = model
      scene%film%initial_film = 0.0_dp
      scene%excitation%steady_force = 199.2_dp
      scene%excitation%gravity = 9.80665_dp
      scene%contact%stiffness = stiffness
      canonical = problem_of(scene)
   end function canonical

   !> Case R1 with 5e7 N/m on both flanks.
   type(problem_t) function between_flanks() result(problem)
      type(scene_t) :: scene

      scene = loose_gear()
      scene%contact%stiffness = 5.0e7_dp
      problem = problem_of(scene)
   end function between_flanks

   !> Compare one period of a steady motion with a reference.
   subroutine compare(checks, name, problem, positions, films, accelerations, loads, harmonics, coast_films, coast_loads)
      type(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: name
      type(problem_t), intent(in) :: problem
      !> Smallest and largest of the samples: z [m], h_1 [m], z'' [m/s2], W_1 [N]
      real(dp), intent(in) :: positions(2)
      real(dp), intent(in) :: films(2)
      real(dp), intent(in) :: accelerations(2)
      real(dp), intent(in) :: loads(2)
      !> Of z'' [m/s2]
      real(dp), intent(in) :: harmonics(:)
      !> Of the coast flank: h_2 [m], W_2 [N]
      real(dp), intent(in), optional :: coast_films(2)
      real(dp), intent(in), optional :: coast_loads(2)
      type(ending_t) :: found
      type(window_record_t) :: record
      type(periodic_orbit_t) :: orbit
      real(dp), allocatable :: states(:, :), z(:), amplitudes(:)

      call solve_window(problem, start_of(problem), accuracy, 1, 400, 1, states, z, found, record, until_steady=.true.)
      call checks%check(is_success(found%status) .and. found%orbit == 1, name//': repeats after one period')
      call solve_window(problem, start_of(problem), accuracy, samples, found%periods + 1, 1, states, z, found, record)
      call checks%check(found%status == status_complete, name//': solved')
      if (found%status /= status_complete) return
      call near([minval(states(:, of_film)), maxval(states(:, of_film))], films, agreement, 'film')
      associate (gear => gear_positions(problem, states))
         call near([minval(gear), maxval(gear)], positions, agreement, 'position')
      end associate
      call near([minval(z), maxval(z)], accelerations, agreement, 'acceleration')
      associate (load => states(:, of_drive_compression)/problem%contact%compliance)
         ! The loads are printed with four digits behind the point.
         call near([minval(load), maxval(load)], loads, agreement + 1.0e-4_dp/loads(2), 'load')
      end associate
      call amplitude_spectrum(z, amplitudes)
      call near(amplitudes(1:size(harmonics)), harmonics, agreement, 'harmonics')
      ! An impact between two samples is a little sharper than at one of them.
      call near([record%lowest(seen_position)%value, record%highest(seen_position)%value], positions, 1.0e-4_dp, 'extremes')
      call near([record%highest(seen_loads(1))%value], loads(2:), 1.0e-3_dp, 'largest load')
      if (present(coast_films)) then
         call near([record%lowest(seen_films(2))%value, record%highest(seen_films(2))%value], coast_films, 1.0e-4_dp, &
                   'coast film')
         call near([record%highest(seen_loads(2))%value], coast_loads(2:), 1.0e-3_dp, 'largest load of the coast film')
      end if
      call checks%check(energy_gap(record, problem%mass) < 1.0e-7_dp, name//': energy closes')
      orbit = find_periodic_orbit(problem, found%numbers, 0.02_dp)
      call checks%check(orbit%period == 1, name//': a periodic orbit')
      if (orbit%period == 1) call checks%check(size(orbit%multipliers) == merge(4, 3, present(coast_films)) .and. &
                                               abs(orbit%multipliers(1)) < 1.0_dp, name//': as many multipliers as states')

   contains

      !> Numbers agree, in parts of the largest.
      subroutine near(numbers, expected, tolerance, what)
         real(dp), intent(in) :: numbers(:)
         real(dp), intent(in) :: expected(:)
         real(dp), intent(in) :: tolerance
         character(*), intent(in) :: what

         call checks%check(maxval(abs(numbers - expected)) < tolerance*maxval(abs(expected)), name//': '//what)
      end subroutine near

   end subroutine compare

   !> Springs that are pressed by hundreds of films: steps are as long as the accuracy allows, and as good. No load that a step is
   !> first guessed to have leaves a film then.
   subroutine test_soft_teeth(checks)
      type(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene
      type(problem_t) :: problem
      type(ending_t) :: found
      real(dp), allocatable :: states(:, :), z(:)
      type(window_record_t) :: record
      real(dp) :: thinnest(2)
      integer :: i

      scene = canonical_scene(law_iso_viscous, 256)
      scene%contact%radius = 15.9e-3_dp
      scene%contact%length = 3.42e-3_dp
      scene%contact%backlash = 93.9e-6_dp
      scene%contact%stiffness = 3.13e6_dp
      scene%lubricant%viscosity = 0.0334_dp
      scene%kinematics%entrainment_speed = 0.136_dp
      scene%excitation%mass = 0.016_dp
      scene%excitation%gravity = 0.0_dp
      scene%excitation%frequency = 23.4_dp
      scene%excitation%steady_force = 3.41_dp
      scene%excitation%force_amplitude = 44.9_dp
      scene%film%model = model_reynolds
      scene%film%initial_film = 0.0_dp
      problem = problem_of(scene)
      do i = 1, 2
         call solve_window(problem, start_of(problem), merge(1.0e-6_dp, 1.0e-9_dp, i == 1), samples, 1, 1, states, z, found, record)
         call checks%check(found%status == status_complete, 'soft teeth: solved')
         if (found%status /= status_complete) return
         thinnest(i) = minval(states(:, of_film))
         if (i == 1) call checks%check(found%count%steps < 8000, 'soft teeth: few steps')
      end do
      call checks%check(abs(thinnest(1)/thinnest(2) - 1.0_dp) < 3.0e-5_dp, 'soft teeth: thinnest film')
   end subroutine test_soft_teeth

   !> A tooth that is thrown off leaves its film next to no load, and comes back. A step that ends with next to no load then puts
   !> the film off by a tenth, whatever the accuracy.
   subroutine test_lost_load(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: stiffness(3) = [3.0e8_dp, 3.0e7_dp, 3.9e8_dp], amplitude(3) = [2000.0_dp, 700.0_dp, 490.0_dp]
      real(dp), parameter :: accuracies(2) = [1.0e-6_dp, 1.0e-8_dp]
      type(scene_t) :: scene
      type(problem_t) :: problem
      type(motion_state_t) :: start
      type(ending_t) :: ending, tight_ending
      type(window_record_t) :: record
      real(dp), allocatable :: tight(:, :), states(:, :), z(:)
      integer :: i, j

      do i = 1, size(stiffness)
         scene = canonical_scene(merge(law_iso_viscous, law_piezo_viscous, i == 3), 256)
         scene%film%initial_film = 0.0_dp
         scene%contact%stiffness = stiffness(i)
         scene%excitation%force_amplitude = amplitude(i)
         if (i == 2) scene%contact%backlash = 3.0e-5_dp
         if (i == 3) then
            ! A film that ruptures holds on to a part of its load, and a spring of 170 films presses it.
            scene%film%rupture = rupture_solved
            scene%lubricant%viscosity = 0.042_dp
            scene%kinematics%entrainment_speed = 1.39_dp
            scene%excitation%frequency = 238.0_dp
         end if
         problem = problem_of(scene)
         start = start_of(problem)
         start%implicit = .true.
         call solve_window(problem, start, 1.0e-11_dp, 64, 4, 4, tight, z, tight_ending, record)
         do j = 1, size(accuracies)
            call solve_window(problem, start, accuracies(j), 64, 4, 4, states, z, ending, record)
            call checks%check(all([ending%status, tight_ending%status] == status_complete), 'lost load: solved')
            if (size(states) /= size(tight)) exit
            call checks%check(maxval(abs(states(:, of_film)/tight(:, of_film) - 1.0_dp)) < 10.0_dp*accuracies(j), &
                              'lost load: within the accuracy')
         end do
      end do
   end subroutine test_lost_load

   !> Films that rupture by (18) keep a part of their load. Of three motions from rest the first has a film that is short while it
   !> separates fast, the second a spring that is pressed by millions of its film, the third loads next to the kept one in steps that
   !> end within an impact: each was given up. The references are those of scipy's Radau method at tolerances of 1e-10 and 1e-9, for
   !> the logarithm of the film, with equations of their own.
   subroutine test_kept_load(checks)
      type(check_list_t), intent(inout) :: checks
      !> k [N/m], eta0 [Pa s], U [m/s], F0 [N], f_exc [Hz]; smallest and largest film of the fourth period [m]
      real(dp), parameter :: motions(7, 3) = reshape([ &
         7.39e6_dp, 0.234_dp, 0.0279_dp, 261.0_dp, 181.0_dp, 1.4951104e-9_dp, 1.03253992e-3_dp, &
         3599280.3270976157_dp, 0.009281705312695244_dp, 0.2662864857679972_dp, 3180.7103920638256_dp, 51.11087858632672_dp, &
         1.2790428549e-1_dp, 1.4747779942e-1_dp, &
         5.234e6_dp, 0.02513_dp, 0.03499_dp, 916.0_dp, 462.8_dp, 1.12934450e-8_dp, 4.29603416e-5_dp], [7, 3])
      type(scene_t) :: scene
      type(problem_t) :: problem
      type(ending_t) :: ending
      type(window_record_t) :: record
      real(dp), allocatable :: states(:, :), z(:)
      integer :: i

      scene = canonical_scene(law_iso_viscous, 256)
      scene%film%rupture = rupture_solved
      scene%film%initial_film = 0.0_dp
      scene%excitation%steady_force = 199.2_dp
      scene%excitation%gravity = 9.80665_dp
      do i = 1, size(motions, 2)
         scene%contact%stiffness = motions(1, i)
         scene%lubricant%viscosity = motions(2, i)
         scene%kinematics%entrainment_speed = motions(3, i)
         scene%excitation%force_amplitude = motions(4, i)
         scene%excitation%frequency = motions(5, i)
         problem = problem_of(scene)
         call solve_window(problem, start_of(problem), accuracy, 64, 4, 1, states, z, ending, record)
         call checks%check(ending%status == status_complete, 'kept load: solved')
         if (ending%status /= status_complete) cycle
         call checks%check_close(record%lowest(seen_films(1))%value/motions(6, i), 1.0_dp, agreement, 'kept load: thinnest film')
         call checks%check_close(record%highest(seen_films(1))%value/motions(7, i), 1.0_dp, agreement, 'kept load: thickest film')
      end do
   end subroutine test_kept_load

   !> At rest films and springs fill the backlash, and the start stands still.
   subroutine test_rest(checks)
      type(check_list_t), intent(inout) :: checks
      type(problem_t) :: problem
      real(dp) :: drive, coast, load, by_film, by_velocity, gap, start(4)

      problem = between_flanks()
      call loads_at_rest(problem, static_load(problem), drive, coast)
      call checks%check_close(drive - coast, 5.0_dp, 1.0e-13_dp, 'rest: static load')
      start = initial_state(problem)
      call checks%check_close(start(3)/(problem%contact%compliance*drive), 1.0_dp, 1.0e-12_dp, 'rest: spring of the drive flank')
      call checks%check_close(start(4)/(problem%contact%compliance*coast), 1.0_dp, 1.0e-9_dp, 'rest: spring of the coast flank')
      gap = problem%backlash - start(1) + start(3) + start(4)
      call film_load(problem%contact%film, gap, 0.0_dp, load, by_film, by_velocity)
      call checks%check_close(load/coast, 1.0_dp, 1.0e-9_dp, 'rest: film of the coast flank')
   end subroutine test_rest

   !> Natural frequencies and damping ratios of the cubic, and that of stiff teeth.
   subroutine test_small_motions(checks)
      type(check_list_t), intent(inout) :: checks
      type(problem_t) :: problem
      type(judged_scene_t) :: judged
      real(dp) :: frequency, ratio, alone, ratio_alone, films(2)
      integer :: i

      call pair_of(canonical(law_iso_viscous, model_reynolds, 3.0e8_dp), frequency, ratio)
      call checks%check_close(frequency, 948.37_dp, 0.005_dp, 'natural frequency of 3e8 N/m')
      call checks%check_close(ratio, 0.1896_dp, 5.0e-5_dp, 'damping ratio')
      call pair_of(canonical(law_iso_viscous, model_reynolds, 1.0e8_dp), frequency, ratio)
      call checks%check_close(frequency, 725.63_dp, 0.005_dp, 'natural frequency of 1e8 N/m')
      call checks%check_close(ratio, 0.0847_dp, 6.0e-5_dp, 'damping ratio')
      call pair_of(canonical(law_iso_viscous, model_reynolds, 1.0e14_dp), frequency, ratio)
      call checks%check_close(frequency, 1114.5_dp, 0.05_dp, 'natural frequency of stiff teeth')
      call checks%check_close(ratio, 0.3454_dp, 5.0e-4_dp, 'damping ratio')
      ! A coast film of a load of 1e-12 N takes no part in the motion.
      problem = canonical(law_piezo_viscous, model_published, 1.0e13_dp)
      call pair_of(problem, alone, ratio_alone)
      problem%backlash = 0.01_dp
      call pair_of(problem, frequency, ratio)
      call checks%check_close(frequency/alone, 1.0_dp, 1.0e-9_dp, 'natural frequency beside a soft coast film')
      call checks%check_close(ratio/ratio_alone, 1.0_dp, 1.0e-9_dp, 'damping ratio beside a soft coast film')
      ! Without a load both films are one: half of each film's spring and film in series, twice.
      problem = between_flanks()
      problem%force%steady = -problem%weight
      call pair_of(problem, frequency, ratio)
      problem%mass = 0.5_dp*problem%mass
      films = films_at_rest(problem, static_load(problem))
      problem%backlash = huge(1.0_dp)
      call natural_motion(problem, films, alone, ratio_alone)
      call checks%check_close(frequency/alone, 1.0_dp, 1.0e-12_dp, 'natural frequency between equal films')
      call checks%check_close(ratio/ratio_alone, 1.0_dp, 1.0e-12_dp, 'damping ratio between equal films')
      do i = 0, 1
         problem = canonical(law_iso_viscous, model_reynolds, 1.0e13_dp)
         if (i == 0) problem%contact%compliance = 0.0_dp
         problem%mass = 0.01_dp*problem%mass
         call pair_of(problem, frequency, ratio)
         call checks%check(max(frequency, ratio) <= 0.0_dp, 'an overdamped motion has no natural frequency')
      end do
      judged%resolved = resolved_scene_t(steady_film=1.0e-6_dp)
      call checks%check(ieee_is_nan(quantity_value(quantity_natural_frequency, judged)) .and. &
                        ieee_is_nan(quantity_value(quantity_damping_ratio, judged)), 'nothing known is no number')
   end subroutine test_small_motions

   !> Natural frequency and damping ratio about the rest under the static load.
   subroutine pair_of(problem, frequency, ratio)
      type(problem_t), intent(in) :: problem
      real(dp), intent(out) :: frequency
      real(dp), intent(out) :: ratio

      call natural_motion(problem, films_at_rest(problem, static_load(problem)), frequency, ratio)
   end subroutine pair_of

   !> Teeth of 1e15 N/m are rigid, and the difference falls as one over the stiffness.
   subroutine test_stiff_teeth(checks)
      type(check_list_t), intent(inout) :: checks
      type(problem_t) :: problem
      type(ending_t) :: ending
      type(window_record_t) :: record
      real(dp), allocatable :: rigid(:, :), stiff(:, :), z(:)
      real(dp) :: difference(2)
      integer :: law, i

      do law = law_iso_viscous, law_piezo_viscous
         problem = canonical(law, model_published, 1.0e15_dp)
         problem%contact%compliance = 0.0_dp
         problem%rest_films = -1.0_dp
         call solve_window(problem, start_of(problem), 1.0e-10_dp, 256, 3, 3, rigid, z, ending, record)
         do i = 1, 2
            problem%contact%compliance = 1.0e-14_dp*0.1_dp**(i - 1)
            call solve_window(problem, start_of(problem), 1.0e-10_dp, 256, 3, 3, stiff, z, ending, record)
            difference(i) = maxval(abs(stiff(:, of_film) - rigid(:, of_film)))/maxval(rigid(:, of_film))
         end do
         call checks%check(difference(2) < 2.0e-6_dp, 'stiff teeth are rigid')
         call checks%check_close(difference(1)/difference(2), 10.0_dp, 0.1_dp, 'the difference falls as 1/k')
      end do
   end subroutine test_stiff_teeth

   !> Taylor series and collocation solve the same equations, whatever the film law.
   subroutine test_two_ways(checks)
      type(check_list_t), intent(inout) :: checks
      integer, parameter :: laws(5) = [law_iso_viscous, law_iso_viscous, law_piezo_viscous, law_iso_viscous, law_piezo_viscous]
      integer, parameter :: models(5) = [model_published, model_published, model_published, model_reynolds, model_reynolds]
      integer, parameter :: ruptures(5) = [rupture_half_pi, rupture_solved, rupture_half_pi, rupture_half_pi, rupture_half_pi]
      type(scene_t) :: scene
      type(problem_t) :: problem
      type(motion_state_t) :: start
      type(ending_t) :: endings(2)
      type(window_record_t) :: record
      real(dp), allocatable :: explicit(:, :), implicit(:, :), z(:)
      real(dp) :: difference
      integer :: i, flanks
      character(80) :: name

      do i = 1, size(laws)
         do flanks = 1, 2
            scene = canonical_scene(laws(i), 256)
            scene%film%model = models(i)
            scene%film%rupture = ruptures(i)
            scene%film%initial_film = 0.0_dp
            scene%contact%stiffness = 2.0e8_dp
            scene%excitation%force_amplitude = 60.0_dp
            if (flanks == 2) scene%contact%backlash = 1.0e-5_dp
            problem = problem_of(scene)
            start = start_of(problem)
            write (name, '(a, i0, a, i0)') 'two ways, law ', i, ', flanks ', flanks
            call solve_window(problem, start, 1.0e-10_dp, 64, 3, 3, explicit, z, endings(1), record)
            start%implicit = .true.
            call solve_window(problem, start, 1.0e-10_dp, 64, 3, 3, implicit, z, endings(2), record)
            call checks%check(all(endings%status == status_complete), trim(name)//': solved')
            call checks%check(endings(2)%implicit .and. .not. endings(1)%implicit, trim(name)//': two ways')
            difference = maxval(abs(explicit(:, of_film)/implicit(:, of_film) - 1.0_dp))
            call checks%check(difference < 1.0e-7_dp, trim(name)//': they agree')
         end do
      end do
   end subroutine test_two_ways

   !> An Reynolds piezo-viscous film that ceases to exist within a step, and would be there again at its end, ends the motion at any
   !> accuracy.
   subroutine test_film_that_ceases(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: forces(2) = [17.659496534923726_dp, 296.44855903492373_dp], &
         frequencies(2) = [246.8073635611789_dp, 1549.7277682860056_dp], &
         stiffnesses(2) = [12372396.299009396_dp, 116174302.15327093_dp], &
         viscosities(2) = [0.1254321769887137_dp, 0.32252635606807356_dp]
      type(scene_t) :: scene
      type(problem_t) :: problem
      type(ending_t) :: ending
      type(window_record_t) :: record
      real(dp), allocatable :: states(:, :), z(:)
      integer :: i, digits

      do i = 1, size(forces)
         scene = canonical_scene(law_piezo_viscous, 256)
         scene%film%model = model_reynolds
         scene%film%initial_film = 0.0_dp
         scene%excitation%force_amplitude = forces(i)
         scene%excitation%frequency = frequencies(i)
         scene%contact%stiffness = stiffnesses(i)
         scene%lubricant%viscosity = viscosities(i)
         problem = problem_of(scene)
         do digits = 5, 8
            call solve_window(problem, start_of(problem), 10.0_dp**(-digits), 64, 4, 1, states, z, ending, record)
            call checks%check(ending%status == status_no_rigid_film, 'a film that ceases within a step')
         end do
      end do
   end subroutine test_film_that_ceases

   !> With the other sign load and force press the other flank: the same motion with its films exchanged. Soft teeth let the film of
   !> the flank that carries nothing grow beyond the backlash.
   subroutine test_mirror(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: stiffness(2) = [1.0e6_dp, 5.0e7_dp], load(2) = [30.0_dp, 0.5_dp]
      type(problem_t) :: pressed, turned
      type(ending_t) :: ending
      type(window_record_t) :: record
      real(dp), allocatable :: states(:, :), turned_states(:, :), z(:), turned_z(:)
      integer :: i

      do i = 1, 2
         pressed = between_flanks()
         pressed%contact%compliance = 1.0_dp/stiffness(i)
         pressed%rest_films = -1.0_dp
         turned = pressed
         pressed%force%steady = load(i)
         turned%force%steady = -load(i)
         turned%force%cosine = -pressed%force%cosine
         turned%force%sine = -pressed%force%sine
         turned%force%others(:, :) = -pressed%force%others
         pressed%initial_film = film_at_rest(pressed, load(i))
         turned%initial_film = film_at_rest(turned, -load(i))
         call checks%check(turned%initial_film > turned%backlash .eqv. i == 1, 'mirror: soft teeth open beyond the backlash')
         call solve_window(pressed, start_of(pressed), accuracy, 64, 3, 1, states, z, ending, record)
         call checks%check(ending%status == status_complete, 'mirror: solved on the drive flank')
         call solve_window(turned, start_of(turned), accuracy, 64, 3, 1, turned_states, turned_z, ending, record)
         call checks%check(ending%status == status_complete, 'mirror: solved on the coast flank')
         if (ending%status /= status_complete) cycle
         call checks%check(maxval(abs(contact_films(turned, 2, turned_states)/states(:, of_film) - 1.0_dp)) < 1.0e-6_dp .and. &
                           maxval(abs(turned_states(:, of_film)/contact_films(pressed, 2, states) - 1.0_dp)) < 1.0e-6_dp, &
                           'mirror: the films change places')
         call checks%check(maxval(abs(turned_z + z)) < 1.0e-6_dp*maxval(abs(z)), 'mirror: the acceleration turns')
      end do
   end subroutine test_mirror

   !> A window carried on from its middle is the same to the last bit, and so is a motion among others.
   subroutine test_no_company(checks)
      type(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene
      type(problem_t) :: problems(21)
      type(motion_state_t) :: starts(size(problems))
      type(ending_t) :: half, whole, ending, endings(size(problems))
      type(window_record_t) :: record
      type(request_t) :: request
      real(dp) :: none(0, 4, size(problems))
      real(dp), allocatable :: states(:, :), rest(:, :), z(:)
      integer :: law, i
      character(40) :: name

      do law = 1, 2
         name = 'Reynolds iso-viscous'
         problems = between_flanks()
         if (law == 2) then
            name = 'Reynolds piezo-viscous'
            scene = canonical_scene(law_piezo_viscous, 256)
            scene%film%model = model_reynolds
            scene%film%initial_film = 0.0_dp
            scene%contact%stiffness = 2.0e8_dp
            scene%contact%backlash = 1.0e-5_dp
            do i = 1, size(problems)
               scene%excitation%force_amplitude = 50.0_dp + real(i, dp)
               problems(i) = problem_of(scene)
            end do
         end if
         call solve_window(problems(1), start_of(problems(1)), 1.0e-7_dp, 64, 6, 3, states, z, whole, record)
         call checks%check(is_success(whole%status) .and. (law == 1 .or. .not. whole%implicit), trim(name)//': solved')
         call solve_window(problems(1), start_of(problems(1)), 1.0e-7_dp, 64, 3, 1, rest, z, half, record)
         call solve_window(problems(1), half%motion_state_t, 1.0e-7_dp, 64, 6, 3, rest, z, ending, record)
         call checks%check(all(abs(states - rest) <= 0.0_dp), trim(name)//', carried on: the same bits')
         call checks%check(all(abs(ending%numbers - whole%numbers) <= 0.0_dp), trim(name)//', carried on: the same end')
         call checks%check(size(states, 2) == 4 .and. of_velocity == 2, trim(name)//': states of four numbers')
         do i = 1, size(problems)
            starts(i) = start_of(problems(i))
         end do
         request%accuracy = 1.0e-7_dp
         request%periods = 6
         request%every_period = .true.
         call solve_motions(problems, starts, request, none, endings)
         call checks%check(all(abs(endings(1)%numbers - whole%numbers) <= 0.0_dp), trim(name)//': alone as among others')
         call solve_motions(problems(size(problems):1:-1), starts(size(problems):1:-1), request, none, endings)
         call checks%check(all(abs(endings(size(problems))%numbers - whole%numbers) <= 0.0_dp), &
                           trim(name)//': the last one of them, too')
      end do
   end subroutine test_no_company

end module test_elastic_teeth
