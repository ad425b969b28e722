!> Tests of the verification: what a tighter solution must share with a scene for its class to stand.
module test_verification
  use verification, only: verification_t, compare_windows, doubt_of_closing, doubt_of_return, no_verification, verification_sentence
   use checks, only: check_list_t
   use doubt, only: doubt_impacts, doubt_sentence, doubt_t, doubt_second_ending, is_doubted
   use engine, only: motion_state_t
   use kinds, only: dp
   use node_extremes, only: seen_acceleration, seen_films
   use rattle_class, only: class_creep, class_idle, class_irregular, class_quiet, class_subharmonic, rattle_verdict_t
   use scene_status, only: status_time_limit
   use scene_types, only: spectrum_choice_t
   use window_extremes, only: window_extremes_t
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   real(dp), parameter :: films(3) = [1.0e-6_dp, 2.0e-6_dp, 4.0e-6_dp], values(3) = [-100.0_dp, 20.0_dp, 30.0_dp]
   real(dp), parameter :: tolerance = 0.01_dp
   character(*), parameter :: stands = 'The class is verified'

   public :: run_verification_tests

contains

   !> Runs every test of this topic.
   subroutine run_verification_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('verification')
      call test_errors(checks)
      call test_film(checks)
      call test_subharmonic(checks)
      call test_quiet_limit(checks)
      call test_harmonic_count(checks)
      call test_first_harmonic(checks)
      call test_bounds(checks)
      call test_closing(checks)
      call test_chance(checks)
      call test_tighter_errors(checks)
      call test_coast_film(checks)
      call test_return(checks)
      call test_none(checks)
   end subroutine run_verification_tests

   !> Verdict on given harmonics, with the default limits but those of `choice`.
   pure function verdict_of(class, harmonics, choice) result(verdict)
      integer, intent(in) :: class                  !> Class
      real(dp), intent(in) :: harmonics(:)          !> a_1, a_2, ...
      type(spectrum_choice_t), intent(in) :: choice !> Limits
      type(rattle_verdict_t) :: verdict

      verdict%class = class
      allocate (verdict%spectrum%harmonics, source=harmonics)
      verdict%spectrum%harmonic_count = count(harmonics > choice%harmonic_threshold*harmonics(1))
      verdict%spectrum%forced_amplitude = harmonics(1)
      verdict%spectrum%harmonic_distortion = norm2(harmonics(2:))/harmonics(1)
   end function verdict_of

   !> Verification of windows that close, without velocities: their extremes are those of the samples.
   subroutine compare(films, tight_films, values, tight_values, verdict, tight, choice, tolerance, verification, unclosed)
      real(dp), intent(in) :: films(:)              !> h of the scene [m]
      real(dp), intent(in) :: tight_films(:)        !> and of its tighter solution [m]
      real(dp), intent(in) :: values(:)             !> z'' of the scene [m/s2]
      real(dp), intent(in) :: tight_values(:)       !> and of its tighter solution [m/s2]
      type(rattle_verdict_t), intent(in) :: verdict !> On the scene
      type(rattle_verdict_t), intent(in) :: tight   !> On its tighter solution
      type(spectrum_choice_t), intent(in) :: choice !> Limits
      real(dp), intent(in) :: tolerance             !> Of the film [-]
      type(verification_t), intent(out) :: verification
      type(doubt_t), optional, intent(in) :: unclosed !> What the windows leave to be doubted

      type(doubt_t) :: left

      if (present(unclosed)) left = unclosed
      call compare_windows(one_flank(films), one_flank(tight_films), extremes_of(films, values), &
         extremes_of(tight_films, tight_values), verdict, tight, left, choice, tolerance, 0.0_dp, 0.0_dp, verification)
   end subroutine compare

   !> Films of one flank.
   pure function one_flank(films)
      real(dp), intent(in) :: films(:) !> h [m]
      real(dp) :: one_flank(size(films), 1)

      one_flank(:, 1) = films
   end function one_flank

   !> Extremes of film and acceleration.
   pure function extremes_of(films, values) result(extremes)
      real(dp), intent(in) :: films(:)   !> h [m]
      real(dp), intent(in) :: values(:)  !> z'' [m/s2]
      type(window_extremes_t) :: extremes

      extremes%lowest(seen_films(1))%value = minval(films)
      extremes%highest(seen_films(1))%value = maxval(films)
      extremes%lowest(seen_acceleration)%value = minval(values)
      extremes%highest(seen_acceleration)%value = maxval(values)
   end function extremes_of

   !> Verification of the same window with other harmonics, expected to stand or to name its doubt.
   subroutine expect(checks, class, harmonics, tight_harmonics, choice, words)
      type(check_list_t), intent(inout) :: checks   !> Collects the results
      integer, intent(in) :: class                  !> Class of both
      real(dp), intent(in) :: harmonics(:)          !> Of the scene
      real(dp), intent(in) :: tight_harmonics(:)    !> Of its tighter solution
      type(spectrum_choice_t), intent(in) :: choice !> Limits
      character(*), intent(in) :: words             !> In its reason

      type(verification_t) :: verification

      call compare(films, films, values, values, verdict_of(class, harmonics, choice), &
         verdict_of(class, tight_harmonics, choice), choice, tolerance, verification)
      call checks%check(verification%exists .and. (verification%verified .eqv. words == stands), 'verified or not: '//words)
call checks%check(index(verification_sentence(verification), words) > 0, words//' (got: '//verification_sentence(verification)//')')
   end subroutine expect

   !> The errors themselves.
   subroutine test_errors(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(verification_t) :: verification
      type(spectrum_choice_t) :: choice
      type(rattle_verdict_t) :: verdict, tight

      verdict = verdict_of(class_creep, [1.0_dp, 0.5_dp, 0.2_dp], choice)
      tight = verdict_of(class_creep, [1.001_dp, 0.498_dp], choice)
      call compare(films*[1.0_dp, 0.997_dp, 1.001_dp], films, 0.9_dp*values, values, verdict, tight, choice, tolerance, &
         verification)
      call checks%check_close(verification%film_error, 0.006_dp/0.997_dp, 1.0e-15_dp, &
         'film error: twice the largest difference, either way')
      call checks%check_close(verification%acceleration_error, 0.2_dp/0.9_dp, 1.0e-15_dp, 'acceleration error: of the smaller peak')
      call checks%check(size(verification%harmonic_errors) == 2, 'harmonic errors: those that both have')
      call checks%check_close(maxval(abs(verification%harmonic_errors - [0.002_dp, 0.004_dp])), 0.0_dp, 1.0e-15_dp, &
         'harmonic errors')
      call checks%check(verification%verified, 'small errors far from the limits')
      tight%class = class_idle
      call compare(films, films, values, values, verdict, tight, choice, tolerance, verification)
      call checks%check(.not. verification%verified .and. index(verification_sentence(verification), 'the class is idle') > 0, &
                        'another class')
   end subroutine test_errors

   !> A regular motion stands up to the tolerance of its film.
   subroutine test_film(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(verification_t) :: verification
      type(spectrum_choice_t) :: choice
      type(rattle_verdict_t) :: verdict

      verdict = verdict_of(class_creep, [1.0_dp, 0.5_dp], choice)
      call compare(1.009_dp*films, films, values, values, verdict, verdict, choice, tolerance, verification)
      call checks%check(verification%verified, 'film: within the tolerance')
      call compare(1.011_dp*films, films, values, values, verdict, verdict, choice, tolerance, verification)
  call checks%check(.not. verification%verified .and. index(verification_sentence(verification), 'the film differs by 1.1 %') > 0, &
         'film: beyond the tolerance')
      ! A scene at rest has no harmonics to doubt.
      verdict = verdict_of(class_quiet, [1.0e-20_dp, 0.35e-20_dp], choice)
      verdict%spectrum%moving = .false.
      call compare(films, films, 0.0_dp*values, 0.0_dp*values, verdict, verdict, choice, tolerance, verification)
      call checks%check(verification%verified, 'film: at rest')
   end subroutine test_film

   !> Subharmonic motions are regular: their films agree. Their class is verified unless the limit is within the error of the
   !> irregular fraction, and so does every other class of a regular motion; their harmonics do not matter.
   subroutine test_subharmonic(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(verification_t) :: verification
      type(spectrum_choice_t) :: choice
      type(rattle_verdict_t) :: verdict, tight

      verdict = verdict_of(class_subharmonic, [1.0e-3_dp, 0.5_dp], choice)
      verdict%spectrum%irregular_fraction = 0.012_dp
      tight = verdict_of(class_subharmonic, [3.0e-3_dp, 0.5_dp], choice)
      tight%spectrum%irregular_fraction = 0.0135_dp
      call compare(films, films, values, values, verdict, tight, choice, tolerance, verification)
      call checks%check(verification%verified, 'subharmonic: the limit is outside the error')
      call compare(1.011_dp*films, films, values, values, verdict, tight, choice, tolerance, verification)
  call checks%check(.not. verification%verified .and. index(verification_sentence(verification), 'the film differs by 1.1 %') > 0, &
         'subharmonic: beyond the tolerance of the film')
      tight%spectrum%irregular_fraction = 0.0145_dp
      call compare(films, films, values, values, verdict, tight, choice, tolerance, verification)
      call checks%check(.not. verification%verified .and. index(verification_sentence(verification), 'irregular fraction') > 0, &
         'subharmonic: the limit is within the error')
      tight%class = class_irregular
      tight%spectrum%irregular_fraction = verdict%spectrum%irregular_fraction
      call compare(films, films, values, values, verdict, tight, choice, tolerance, verification)
     call checks%check(.not. verification%verified .and. index(verification_sentence(verification), 'the class is irregular') > 0, &
         'subharmonic: irregular if solved tighter')
      verdict = verdict_of(class_creep, [1.0_dp, 0.5_dp], choice)
      verdict%spectrum%irregular_fraction = 0.009_dp
      tight = verdict
      call compare(films, films, values, values, verdict, tight, choice, tolerance, verification)
      call checks%check(verification%verified, 'creep: the irregular limit is outside the error')
      tight%spectrum%irregular_fraction = 0.0075_dp
      call compare(films, films, values, values, verdict, tight, choice, tolerance, verification)
      call checks%check(.not. verification%verified, 'creep: the irregular limit is within the error')
   end subroutine test_subharmonic

   !> The distortion a_2/a_1 on either side of its limit, with errors that reach it or do not.
   subroutine test_quiet_limit(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      character(*), parameter :: doubt = 'within its error of the quiet limit'
      type(spectrum_choice_t) :: choice

      call expect(checks, class_creep, [1.0_dp, 0.36_dp], [1.0_dp, 0.371_dp], choice, doubt)
      call expect(checks, class_creep, [1.0_dp, 0.36_dp], [1.0_dp, 0.369_dp], choice, stands)
      call expect(checks, class_quiet, [1.0_dp, 0.34_dp], [1.0_dp, 0.329_dp], choice, doubt)
      call expect(checks, class_quiet, [1.0_dp, 0.34_dp], [1.0_dp, 0.331_dp], choice, stands)
      ! An error of the first harmonic alone: 0.36 0.03/0.97 = 0.011.
      call expect(checks, class_creep, [1.0_dp, 0.36_dp], [1.03_dp, 0.36_dp], choice, doubt)
      call expect(checks, class_creep, [1.0_dp, 0.36_dp], [1.02_dp, 0.36_dp], choice, stands)
      choice%quiet_limit = 0.5_dp
      call expect(checks, class_quiet, [1.0_dp, 0.36_dp], [1.0_dp, 0.371_dp], choice, stands)
   end subroutine test_quiet_limit

   !> A third harmonic close to the threshold matters where three harmonics make the class.
   subroutine test_harmonic_count(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      character(*), parameter :: doubt = 'there are 2 to 3 harmonics'
      type(spectrum_choice_t) :: choice

      choice%idle_harmonics = 3
      call expect(checks, class_idle, [1.0_dp, 0.5_dp, 0.011_dp], [1.0_dp, 0.5_dp, 0.0125_dp], choice, doubt)
      call expect(checks, class_idle, [1.0_dp, 0.5_dp, 0.011_dp], [1.0_dp, 0.5_dp, 0.0115_dp], choice, stands)
      call expect(checks, class_creep, [1.0_dp, 0.5_dp, 0.009_dp], [1.0_dp, 0.5_dp, 0.0075_dp], choice, doubt)
      call expect(checks, class_creep, [1.0_dp, 0.5_dp, 0.009_dp], [1.0_dp, 0.5_dp, 0.0085_dp], choice, stands)
      choice%idle_harmonics = 4
      call expect(checks, class_creep, [1.0_dp, 0.5_dp, 0.011_dp], [1.0_dp, 0.5_dp, 0.0125_dp], choice, stands)
      ! The error of the first line moves the threshold, too.
      choice%idle_harmonics = 3
      choice%harmonic_threshold = 0.5_dp
      call expect(checks, class_creep, [1.0_dp, 2.0_dp, 0.5_dp], [1.1_dp, 2.0_dp, 0.5_dp], choice, doubt)
      choice%harmonic_threshold = 0.01_dp
      ! A quiet motion is quiet with any number of harmonics.
      call expect(checks, class_quiet, [1.0_dp, 0.1_dp, 0.011_dp], [1.0_dp, 0.1_dp, 0.0125_dp], choice, stands)
   end subroutine test_harmonic_count

   !> No share of the first harmonic means anything while its error is as large.
   subroutine test_first_harmonic(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(spectrum_choice_t) :: choice

      call expect(checks, class_creep, [1.0_dp, 50.0_dp], [2.0_dp, 50.0_dp], choice, 'The first harmonic is as small as its error')
      call expect(checks, class_creep, [1.0_dp, 50.0_dp], [1.9_dp, 50.0_dp], choice, 'within its error of the quiet limit')
   end subroutine test_first_harmonic

   !> Harmonics and distortion that are lower bounds prove nothing below a limit, and enough above it.
   subroutine test_bounds(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(verification_t) :: verification
      type(spectrum_choice_t) :: choice
      type(rattle_verdict_t) :: verdict

      choice%idle_harmonics = 3
      verdict = verdict_of(class_creep, [1.0_dp, 0.5_dp], choice)
      verdict%spectrum%count_is_bound = .true.
      call compare(films, films, values, values, verdict, verdict, choice, tolerance, verification)
    call checks%check(index(verification_sentence(verification), 'at least 2 harmonics') > 0, &
                        'bounds: there may be more harmonics')
      verdict = verdict_of(class_idle, [1.0_dp, 0.5_dp, 0.4_dp], choice)
      verdict%spectrum%count_is_bound = .true.
      call compare(films, films, values, values, verdict, verdict, choice, tolerance, verification)
      call checks%check(verification%verified, 'bounds: enough harmonics are enough')
      verdict = verdict_of(class_quiet, [1.0_dp, 0.1_dp], choice)
      verdict%spectrum%distortion_is_bound = .true.
      call compare(films, films, values, values, verdict, verdict, choice, tolerance, verification)
      call checks%check(index(verification_sentence(verification), 'distortion is a lower bound') > 0, &
         'bounds: the distortion may be larger')
      verdict = verdict_of(class_idle, [1.0_dp, 0.5_dp, 0.4_dp], choice)
      verdict%spectrum%distortion_is_bound = .true.
      call compare(films, films, values, values, verdict, verdict, choice, tolerance, verification)
      call checks%check(verification%verified, 'bounds: enough distortion is enough')
   end subroutine test_bounds

   !> A window that does not close is not verified, and says by how much it does not.
   subroutine test_closing(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(verification_t) :: verification
      type(spectrum_choice_t) :: choice
      type(rattle_verdict_t) :: verdict
      type(window_record_t) :: record
      real(dp), parameter :: frequency = 15.0_dp, mass = 3.0_dp, noise = 1.0e-6_dp

      verdict = verdict_of(class_creep, [1.0_dp, 0.5_dp], choice)
      call compare(films, films, values, values, verdict, verdict, choice, tolerance, verification, doubt_t(doubt_impacts))
      call checks%check(verification%doubt%code == doubt_impacts .and. .not. verification%verified, 'closing: the reason given')
      call checks%check(reason() == '', 'closing: no record, no doubt')
      ! Two periods whose velocity grows by 4 m/s, of which the integral of z'' sees all, or 0.2 % less.
      record = window_record_t(periods=2, start=motion_state_t(numbers=[1.0_dp, 0.0_dp]), end_velocity=4.0_dp, &
                               acceleration_sum=4.0_dp*frequency, acceleration_size=10.0_dp*frequency)
      call checks%check(reason() == '', 'closing: momentum')
      record%acceleration_sum = 3.98_dp*frequency
      call checks%check(index(reason(), 'the mean of z"') > 0, 'closing: momentum is missing')
      record%acceleration_sum = 4.0_dp*frequency
      ! Kinetic energy 3 4**2/2 = 24 J.
      record%film_work = -6.0_dp
      record%force_work = -30.0_dp
      record%work_size = 36.0_dp
      call checks%check(reason() == '', 'closing: energy')
      record%film_work = -6.04_dp
      call checks%check(index(reason(), 'J, the forces give') > 0, 'closing: energy is missing')

   contains

      !> Why the window does not close.
      pure function reason()
         character(:), allocatable :: reason

         reason = doubt_sentence(doubt_of_closing(record, frequency, mass, noise))
      end function reason

   end subroutine test_closing

   !> One difference alone may vanish by chance: no error is a small share of the others of its kind.
   subroutine test_chance(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(verification_t) :: verification
      type(spectrum_choice_t) :: choice
      type(rattle_verdict_t) :: verdict, tight

      verdict = verdict_of(class_creep, [1.0_dp, 0.5_dp], choice)
      tight = verdict_of(class_creep, [1.0_dp, 0.51_dp], choice)
      call compare(films, films, values*[1.0_dp, 1.0_dp, 1.1_dp], values, verdict, tight, choice, tolerance, verification)
      call checks%check_close(verification%acceleration_maximum_error, 6.0_dp, 1.0e-13_dp, 'chance: the error of the maximum')
      call checks%check_close(verification%acceleration_minimum_error, 2.0_dp, 1.0e-13_dp, 'chance: a tenth of it, relatively')
      call checks%check_close(verification%harmonic_errors(1), 0.002_dp, 1.0e-15_dp, &
         'chance: a tenth of the other harmonic''s error')
   end subroutine test_chance

   !> The tighter solution has errors, too: solutions that agree to the last bit do not make a number exact.
   subroutine test_tighter_errors(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: accuracy = 1.0e-10_dp, noise = 1.0e-6_dp
      type(verification_t) :: verification
      type(spectrum_choice_t) :: choice
      type(rattle_verdict_t) :: verdict

      verdict = verdict_of(class_creep, [1.0_dp, 0.5_dp], choice)
      call compare_windows(one_flank(films), one_flank(films), extremes_of(films, values), extremes_of(films, values), verdict, &
         verdict, doubt_t(), choice, tolerance, accuracy, noise, verification)
      call checks%check(verification%film_error > accuracy, 'tighter errors: film')
      call checks%check(verification%film_minimum_error > accuracy*minval(films) .and. &
         verification%film_maximum_error > accuracy*maxval(films), 'tighter errors: extremes of the film')
      call checks%check(verification%acceleration_minimum_error > noise + accuracy*abs(minval(values)) .and. &
         verification%acceleration_maximum_error > noise + accuracy*maxval(values), 'tighter errors: extremes of the acceleration')
      call checks%check(all(verification%harmonic_errors > noise + accuracy*verdict%spectrum%harmonics), &
         'tighter errors: harmonics')
      call checks%check(verification%film_error < 100.0_dp*accuracy .and. &
         all(verification%harmonic_errors < 100.0_dp*(noise + accuracy*verdict%spectrum%harmonics)), 'tighter errors: not by far')
   end subroutine test_tighter_errors

   !> Between two flanks the errors of both films count, against the thinner one: in samples, and in extremes between them. On teeth
   !> that give the drive film may be thicker than the backlash.
   subroutine test_coast_film(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: coast(3) = [1.0e-7_dp, 2.0e-7_dp, 4.0e-7_dp], error = 0.05_dp
      type(verification_t) :: verification
      type(spectrum_choice_t) :: choice
      type(rattle_verdict_t) :: verdict
      type(window_extremes_t) :: extremes, tight_extremes

      verdict = verdict_of(class_creep, [1.0_dp, 0.5_dp], choice)
      extremes = extremes_of(films, values)
      extremes%lowest(seen_films(2))%value = minval(coast)
      extremes%highest(seen_films(2))%value = maxval(coast)
      tight_extremes = extremes
      call compare_both(coast)
      ! Twenty times the last digit of the drive film, as a share of the coast film.
      call checks%check(verification%verified, 'coast film: the same')
      call checks%check_close(verification%film_error, 20.0_dp*epsilon(1.0_dp)*maxval(films)/minval(coast), 1.0e-18_dp, &
                              'coast film: the same to its last digit')
      call compare_both(coast*[1.0_dp, 1.0_dp + error, 1.0_dp])
      call checks%check_close(verification%film_error, 2.0_dp*error, 1.0e-14_dp, 'coast film: error of a sample')
      call checks%check(.not. verification%verified, 'coast film: not verified')
      extremes%lowest(seen_films(2))%value = (1.0_dp - error)*minval(coast)
      call compare_both(coast)
      call checks%check_close(verification%film_error, 2.0_dp*error/(1.0_dp - error), 4.0e-13_dp, &
                              'coast film: error between samples')
      tight_extremes%lowest(seen_films(2))%value = 1.0e-9_dp*minval(coast)
      extremes%lowest(seen_films(2))%value = 1.0e-9_dp*minval(coast)
      call compare_both(coast)
      call checks%check_close(verification%acceleration_error, 2.0e10_dp*epsilon(1.0_dp)*maxval(films)/minval(coast), 1.0e-9_dp, &
                              'coast film: so thin that the last digit of the drive film tells')
      tight_extremes%lowest(seen_films(2))%value = minval(coast)
      extremes%lowest(seen_films(2))%value = 1.0e-3_dp*minval(coast)
      call compare_both(coast*[1.0e-3_dp, 1.0_dp, 1.0_dp])
      call checks%check(verification%film_error*extremes%lowest(seen_films(2))%value > minval(coast), &
                        'coast film: reported far too thin, its error is a share of what is reported')

   contains

      !> Compare with a solution of the same drive film.
      subroutine compare_both(coast_film)
         real(dp), intent(in) :: coast_film(:) !> Of the scene [m]

         call compare_windows(reshape([films, coast_film], [3, 2]), reshape([films, coast], [3, 2]), extremes, tight_extremes, &
            verdict, verdict, doubt_t(), choice, tolerance, 0.0_dp, 0.0_dp, verification)
      end subroutine compare_both

   end subroutine test_coast_film

   !> A window of one period has to return where it began, on both flanks; longer ones, and what does not claim to repeat, need not.
   subroutine test_return(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: near(2, 2) = reshape([1.0e-6_dp, 1.005e-6_dp, 3.0e-6_dp, 3.0e-6_dp], [2, 2])
      real(dp), parameter :: far(2, 2) = reshape([1.0e-6_dp, 1.005e-6_dp, 3.0e-6_dp, 2.9e-6_dp], [2, 2])
      type(spectrum_choice_t) :: choice
      type(rattle_verdict_t) :: idle, irregular

      idle = verdict_of(class_idle, [1.0_dp, 0.5_dp], choice)
      irregular = verdict_of(class_irregular, [1.0_dp, 0.5_dp], choice)
      call checks%check(.not. is_doubted(doubt_of_return(idle, 1, near, tolerance)), 'return: back again')
      call checks%check(index(doubt_sentence(doubt_of_return(idle, 1, far, tolerance)), '3.00E-6 m and ends with 2.90E-6 m') > 0, &
                        'return: elsewhere')
      call checks%check(.not. is_doubted(doubt_of_return(idle, 2, far, tolerance)), 'return: a longer window')
      call checks%check(.not. is_doubted(doubt_of_return(irregular, 1, far, tolerance)), 'return: of an irregular motion')
   end subroutine test_return

   !> Without a tighter solution nothing is verified.
   subroutine test_none(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(verification_t) :: verification

      verification = no_verification(doubt_t(doubt_second_ending, counts=[status_time_limit, 0]))
      call checks%check(verification%exists .and. .not. verification%verified, 'none: not verified')
      call checks%check(verification_sentence(verification) == 'The second solution ended as time_limit.' .and. &
                        size(verification%harmonic_errors) == 0, 'none: its reason')
   end subroutine test_none

end module test_verification
