!> Tests of what irregular motions amount to: errors of numbers whose errors are known, and a motion against a long window of another
!> solution of it.
module test_irregular_statistics
   use canonical_scenes, only: canonical_scene
   use checks, only: check_list_t
   use classify_group, only: classify_windows, follow_irregular
   use engine, only: ending_t, motion_state_t, request_t, start_of
   use errors, only: error_t
   use irregular_statistics, only: irregular_statistics_t, is_enough, statistics_of_path
   use judged_scene, only: judged_scene_t, quantity_value
   use kinds, only: dp
   use lyapunov, only: path_t
   use many_motions, only: solve_motions
   use node_extremes, only: seen_quantities
   use prepared_scene, only: prepare, prepared_scene_t
   use quantities, only: quantity_batch_periods, quantity_followed_periods
   use rattle_class, only: class_irregular
   use scene_group, only: judged_record, scene_group_t, solve_group
   use scene_types, only: law_iso_viscous, scene_t
   use verification, only: irregular_verification, verification_t
   use vibration_severity, only: severity_of_record, vibration_severity_t
   use window_impacts, only: impacts_of_record, window_impacts_t
   use window_record, only: sum_beyond, sum_of_impacts, sum_of_impulses, sum_of_powers, sum_of_squares, sums_of_record, &
      window_record_t
   implicit none(type, external)
   private

   public :: run_irregular_statistics_tests

contains

   !> Runs every test of this topic.
   subroutine run_irregular_statistics_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('irregular_statistics')
      call test_independent_periods(checks)
      call test_correlated_periods(checks)
      call test_halves(checks)
      call test_motion(checks)
   end subroutine run_irregular_statistics_tests

   !> Pseudo-random numbers of mean 0 and variance 1, in the interval of a uniform distribution.
   function random_numbers(count) result(numbers)
      integer, intent(in) :: count
      real(dp) :: numbers(count)
      integer, allocatable :: seed(:)
      integer :: n, i

      call random_seed(size=n)
      seed = [(7*i + 11, i=1, n)]
      call random_seed(put=seed)
      call random_number(numbers)
      numbers = sqrt(12.0_dp)*(numbers - 0.5_dp)
   end function random_numbers

   !> A path of periods whose mean squares of z'' and of the film force are given; 4 impacts of 0.5 N periods on one contact, and a
   !> harmonic of the same power.
   function path_of(squares) result(path)
      real(dp), intent(in) :: squares(:)  !> Mean square of each period
      type(path_t) :: path
      integer :: i

      path%record%periods = size(squares)
      allocate (path%sums(sum_of_squares, 0:size(squares)), source=0.0_dp)
      do i = 1, size(squares)
         path%sums(:, i) = path%sums(:, i - 1)
         path%sums(sum_of_powers + 1, i) = path%sums(sum_of_powers + 1, i) + squares(i)
         path%sums(sum_beyond + 1, i) = path%sums(sum_beyond + 1, i) + 4.0_dp*squares(i)
         path%sums(sum_of_impacts, i) = path%sums(sum_of_impacts, i) + 4.0_dp
         path%sums(sum_of_impulses, i) = path%sums(sum_of_impulses, i) + 2.0_dp
         path%sums(sum_of_squares, i) = path%sums(sum_of_squares, i) + squares(i)
      end do
   end function path_of

   !> Of independent periods the error of the mean square is their scatter over the root of their count; that of the root half of it
   !> over the root. What is the same in each period has no error.
   subroutine test_independent_periods(checks)
      class(check_list_t), intent(inout) :: checks
      real(dp) :: squares(200), scatter, mean
      type(irregular_statistics_t) :: found

      squares = 100.0_dp + 10.0_dp*random_numbers(200)
      found = statistics_of_path(path_of(squares), 50.0_dp)
      mean = sum(squares)/200.0_dp
      scatter = sqrt(sum((squares - mean)**2)/199.0_dp)
      call checks%check(found%periods == 200 .and. found%batch_periods == 1, 'independent: batches of a period')
      ! What is left of the correlation by chance, at most a tenth, adds a tenth at most; the root is curved by less than a percent.
      associate (expected => 0.5_dp*scatter/(sqrt(200.0_dp)*sqrt(mean)))
         call checks%check(found%severity%acceleration_rms > 0.99_dp*expected .and. &
                           found%severity%acceleration_rms < 1.12_dp*expected, 'independent: error of the rms')
         call checks%check_close(found%severity%film_force_rms, 2.0_dp*found%severity%acceleration_rms, 1.0e-12_dp, &
                                 'independent: twice of a force that is twice as large')
         call checks%check_close(found%harmonics(1), 100.0_dp*found%severity%acceleration_rms, 1.0e-10_dp, &
                                 'independent: of a harmonic, 2 f times as large')
      end associate
      call checks%check(maxval(found%impacts_per_period) <= 0.005_dp .and. maxval(found%impulse_mean) < 1.0e-14_dp, &
                        'independent: the same in each period')
      call checks%check(found%halves_agree .and. found%same_contacts, 'independent: the halves agree')
      call checks%check(is_enough(path_of(squares)), 'independent: enough periods')
      call checks%check(.not. is_enough(path_of(squares(:100)**8)), 'wild: not enough periods')
   end subroutine test_independent_periods

   !> Of periods of which each remembers 0.8 of the one before, the error is sqrt((1 + 0.8)/(1 - 0.8)) = 3 times as large: shorter
   !> batches miss most of that. Mean of 40 paths, by whose scatter it is held.
   subroutine test_correlated_periods(checks)
      class(check_list_t), intent(inout) :: checks
      integer, parameter :: periods = 300, paths = 40
      real(dp) :: noise(periods*paths), squares(periods), roots(paths), errors(paths), scatter
      type(irregular_statistics_t) :: found
      integer :: path, i, batch

      noise = random_numbers(periods*paths)
      batch = 0
      do path = 1, paths
         squares(1) = noise((path - 1)*periods + 1)
         do i = 2, periods
            squares(i) = 0.8_dp*squares(i - 1) + 0.6_dp*noise((path - 1)*periods + i)
         end do
         squares = 100.0_dp + 10.0_dp*squares
         found = statistics_of_path(path_of(squares), 50.0_dp)
         errors(path) = found%severity%acceleration_rms
         roots(path) = sqrt(sum(squares)/real(periods, dp))
         batch = max(batch, found%batch_periods)
      end do
      scatter = sqrt(sum((roots - sum(roots)/real(paths, dp))**2)/real(paths - 1, dp))
      ! The scatter of 40 is known to a ninth, two of its errors; the mean error better.
      call checks%check_close(sqrt(sum(errors**2)/real(paths, dp))/scatter, 1.0_dp, 0.25_dp, 'correlated: the scatter of paths')
      call checks%check(batch > 4, 'correlated: batches of several periods')
      call checks%check(count(abs(roots - 10.0_dp) <= 2.0_dp*errors) >= 34, 'correlated: most within two standard errors')
   end subroutine test_correlated_periods

   !> Halves that differ by more than their errors, and a flank that is hit in one of them alone: then a motion does not stand.
   subroutine test_halves(checks)
      class(check_list_t), intent(inout) :: checks
      real(dp) :: squares(200)
      type(irregular_statistics_t) :: found
      type(path_t) :: path

      squares = 100.0_dp + 10.0_dp*random_numbers(200)
      path = path_of(squares)
      path%sums(sum_of_impacts + 1, 101:) = 1.0_dp
      found = statistics_of_path(path, 50.0_dp)
      call checks%check(found%halves_agree .and. .not. found%same_contacts, 'halves: another flank')
      ! One impact in 200 periods might as well have been none.
      call checks%check_close(found%impacts_per_period(2), 0.005_dp, 1.0e-12_dp, 'halves: an impact more or less')
      path%sums(sum_of_powers + 1, :) = path%sums(sum_of_powers + 1, :)**3
      found = statistics_of_path(path, 50.0_dp)
      call checks%check(found%rms_of_halves(1) < found%rms_of_halves(2), 'halves: both are reported')
   end subroutine test_halves

   !> An irregular motion against 1200 periods of another solution: all that is reported of it lies within its errors, four of them,
   !> and the errors are no larger than the scatter of as many periods.
   subroutine test_motion(checks)
      class(check_list_t), intent(inout) :: checks
      integer, parameter :: samples_per_period = 64, long = 1200
      type(prepared_scene_t) :: scenes(1)
      type(scene_group_t) :: group
      type(scene_t) :: scene
      type(error_t), allocatable :: error
      type(window_record_t) :: record, reference(1)
      type(window_impacts_t) :: impacts, reference_impacts
      type(vibration_severity_t) :: found, expected
      type(verification_t) :: verification
      type(judged_scene_t) :: judged
      type(ending_t) :: endings(1)
      real(dp) :: states(long, 2, 1)

      scene = canonical_scene(law_iso_viscous, samples_per_period)
      scene%kinematics%entrainment_speed = 12.0_dp
      scene%excitation%force_amplitude = 1200.0_dp
      scenes(1) = prepare(scene)
      scenes(1)%request = request_t(accuracy=1.0e-6_dp, periods=60, samples_per_period=samples_per_period, sampled_periods=8, &
                                    impact_limit=1.5_dp)
      call solve_group(scenes, start_of(scenes%resolved%problem), spread(.true., 1, seen_quantities), group)
      call classify_windows(scenes, group, error)
      call follow_irregular(scenes, group)
      call checks%check(group%verdicts(1)%class == class_irregular, 'motion: irregular')
      if (group%verdicts(1)%class /= class_irregular) return
      record = judged_record(group, 1)
      associate (problem => scenes(1)%resolved%problem, statistics => group%statistics(1))
         call checks%check(record%periods >= 100 .and. statistics%periods == record%periods, 'motion: a hundred periods and more')
         reference(1)%loads%impact_limit = 1.5_dp
         reference(1)%multiples = record%multiples
         call solve_motions([problem], [motion_state_t(numbers=group%endings(1)%numbers)], &
                            request_t(accuracy=1.0e-9_dp, periods=long, sampled_periods=long, samples_per_period=1, &
                                      every_period=.true.), states, endings, records=reference)
         found = severity_of_record(record, problem%frequency)
         expected = severity_of_record(reference(1), problem%frequency)
         impacts = impacts_of_record(record, problem%frequency)
         reference_impacts = impacts_of_record(reference(1), problem%frequency)
         call within('rms of the acceleration', found%acceleration_rms, expected%acceleration_rms, &
                     statistics%severity%acceleration_rms)
         call within('rms of the film force', found%film_force_rms, expected%film_force_rms, statistics%severity%film_force_rms)
         call within('dissipated energy', found%dissipated_energy, expected%dissipated_energy, &
                     statistics%severity%dissipated_energy)
         call within('kurtosis', found%acceleration_kurtosis, expected%acceleration_kurtosis, &
                     statistics%severity%acceleration_kurtosis)
         call within('impacts a period', real(impacts%contacts(1)%count, dp)/real(impacts%periods, dp), &
                     real(reference_impacts%contacts(1)%count, dp)/real(reference_impacts%periods, dp), &
                     statistics%impacts_per_period(1))
         associate (harmonics => 2.0_dp*problem%frequency*sqrt(reference(1)%harmonic_squares(1:)/real(long, dp)))
            call within('first harmonic', group%verdicts(1)%spectrum%harmonics(1), harmonics(1), statistics%harmonics(1))
            call within('seventh harmonic', group%verdicts(1)%spectrum%harmonics(7), harmonics(7), statistics%harmonics(7))
         end associate
         call checks%check(sum(sums_of_record(record) - group%paths(1)%sums(:, record%periods)) <= 0.0_dp, &
                           'motion: the sums are those of the record')
         verification = irregular_verification(problem, record, group%verdicts(1), statistics, scenes(1)%spectrum, 0.0_dp)
         call checks%check(verification%verified, 'motion: it stands')
         call checks%check_close(verification%severity_errors%acceleration_rms, 2.0_dp*statistics%severity%acceleration_rms, &
                                 1.0e-14_dp*found%acceleration_rms, 'motion: errors are two standard errors')
         judged%judged = .true.
         judged%statistics = statistics
         call checks%check_close(quantity_value(quantity_followed_periods, judged), real(record%periods, dp), 0.0_dp, &
                                 'motion: periods are reported')
         call checks%check_close(quantity_value(quantity_batch_periods, judged), real(statistics%batch_periods, dp), 0.0_dp, &
                                 'motion: batches are reported')
      end associate

   contains

      subroutine within(what, number, expected, error)
         character(*), intent(in) :: what
         real(dp), intent(in) :: number
         real(dp), intent(in) :: expected
         real(dp), intent(in) :: error  !> Standard error

         call checks%check_close(number, expected, 4.0_dp*error, 'motion: '//what)
         call checks%check(error > 0.0_dp .and. error < 0.2_dp*expected, 'motion: error of '//what)
      end subroutine within

   end subroutine test_motion

end module test_irregular_statistics
