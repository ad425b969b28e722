!> How far a verdict can be trusted: the window of a scene held against the same window solved tighter.
module verification
   use doubt, only: doubt_class, doubt_class_behind, doubt_count, doubt_count_bound, doubt_distortion, doubt_distortion_bound, &
      doubt_ending_behind, doubt_energy, doubt_film, doubt_flight, doubt_fraction_close, doubt_fraction_error, doubt_impacts, &
      doubt_largest_harmonic, doubt_momentum, doubt_parting, doubt_return, doubt_sentence, doubt_t, first_doubt, is_doubted, &
      parting_sentence
   use carried_loads, only: films_of
   use kinds, only: dp
   use vibration_severity, only: vibration_severity_t
   use node_extremes, only: seen_acceleration, seen_films
   use problem, only: of_velocity, problem_t
   use regime_check, only: gap_too_wide, model_limit
   use rattle_class, only: class_irregular, class_irregular_so_far, class_subharmonic, is_off_harmonics, rattle_verdict_t
   use scene_status, only: is_success
   use scene_types, only: spectrum_choice_t
   use window_extremes, only: window_extremes_t
   use window_impacts, only: impact_agreement_t
   use window_record, only: energy_gap, momentum_gap, window_record_t
   implicit none(type, external)
   private

   !> What the comparison says. The errors are those of the numbers beside them, never printed smaller than the tighter
   !> solution can tell. A relative error is a share of the smaller one of both numbers: a film that is reported a hundred times too
   !> thin is 9900 % off, not 99 %.
   type, public :: verification_t
      !> Whether there was a tighter solution to compare with
      logical :: exists = .false.
      !> The class is verified
      logical :: verified = .false.
      !> Largest relative difference of the film over the window, its extremes included [-]
      real(dp) :: film_error = 0.0_dp
      !> Errors of the smallest and largest film [m]
      real(dp) :: film_minimum_error = 0.0_dp
      real(dp) :: film_maximum_error = 0.0_dp
      !> Errors of the smallest and largest z'' [m/s2], and the larger of both relative to the largest |z''| [-]
      real(dp) :: acceleration_minimum_error = 0.0_dp
      real(dp) :: acceleration_maximum_error = 0.0_dp
      real(dp) :: acceleration_error = 0.0_dp
      !> Largest relative error of the numbers of severity [-]
      real(dp) :: severity_error = 0.0_dp
      !> Of films in nodes: twice the share by which twice as many change the largest pressure [-]; below 0: it is not known
      real(dp) :: pressure_error = -1.0_dp
      !> Whether the impacts are the same
      type(impact_agreement_t) :: impacts = impact_agreement_t()
      !> Errors of the harmonics [m/s2]
      real(dp), allocatable :: harmonic_errors(:)
      !> Why it is not verified; of a verified irregular motion, how a neighbouring one parts from it
      type(doubt_t) :: doubt = doubt_t()
   end type verification_t

   !> Errors in units of the difference from the tighter solution, which has an error of its own.
   real(dp), parameter :: margin = 2.0_dp
   !> Share of the largest difference of its kind that every error has at least: one difference alone may vanish by chance.
   real(dp), parameter :: least_share = 0.1_dp
   !> Errors of the tighter solution, in units of its accuracy.
   real(dp), parameter :: tight_share = 10.0_dp
   !> Share of the flow of momentum, or of energy, by which a window that closes may miss.
   real(dp), parameter :: closing_share = 1.0e-3_dp
   !> Windows behind the one that is judged, and periods of them together, at least, in which a motion has to be irregular too.
   integer, parameter :: least_windows_behind = 4, least_periods_behind = 32
   !> Reversals of the acceleration that an irregular window holds at least, four impacts: of fewer the next window, or the
   !> same one solved otherwise, may hold none.
   real(dp), parameter :: least_reversals = 8.0_dp

   public :: compare_windows, severity_error, no_verification, verification_word, verification_sentence, &
 doubt_of_windows, doubt_of_closing, doubt_of_flight, doubt_of_impacts, doubt_of_return, windows_behind, doubt_behind, &
             films_of_ends

contains

   !> Verification of a window by a tighter one of the same samples.
   pure subroutine compare_windows(films, tight_films, extremes, tight_extremes, verdict, tight_verdict, unclosed, choice, &
                                   tolerance, tight_accuracy, tight_noise, verification)
      !> Films of the scene and of its tighter solution: sample, contact [m]. Their errors count against the thinnest film of
      !> all contacts.
      real(dp), intent(in) :: films(:, :)
      real(dp), intent(in) :: tight_films(:, :)
      !> Extremes of both
      type(window_extremes_t), intent(in) :: extremes
      type(window_extremes_t), intent(in) :: tight_extremes
      !> Verdicts of both
      type(rattle_verdict_t), intent(in) :: verdict
      type(rattle_verdict_t), intent(in) :: tight_verdict
      !> What the windows leave to be doubted
      type(doubt_t), intent(in) :: unclosed
      !> Limits of the classes
      type(spectrum_choice_t), intent(in) :: choice
      !> Film error up to which a regular motion is verified [-]
      real(dp), intent(in) :: tolerance
      !> Relative accuracy of the tighter solution [-]
      real(dp), intent(in) :: tight_accuracy
      !> Acceleration that its errors explain [m/s2]
      real(dp), intent(in) :: tight_noise
      type(verification_t), intent(out) :: verification
      real(dp), allocatable :: differences(:)
      real(dp) :: peaks(2), errors(2), film_difference, reached
      integer :: lines, contact

      verification%exists = .true.
      reached = tight_accuracy
      ! Other films are what the first one leaves of the backlash, whose last digit is a share of a thin one.
      do contact = 2, size(films, 2)
         reached = max(reached, epsilon(1.0_dp)*tight_extremes%highest(seen_films(1))%value/ &
                       max(tiny(1.0_dp), tight_extremes%lowest(seen_films(contact))%value))
      end do
      errors = errors_of(seen_films(1), 0.0_dp)
      verification%film_minimum_error = errors(1)
      verification%film_maximum_error = errors(2)
      film_difference = maxval(maxval(abs(films - tight_films), dim=2)/minval(min(films, tight_films), dim=2))
      do contact = 1, size(films, 2)
         film_difference = max(film_difference, error_in_film(seen_films(contact)))
      end do
      verification%film_error = margin*film_difference
      errors = errors_of(seen_acceleration, tight_noise)
      verification%acceleration_minimum_error = errors(1)
      verification%acceleration_maximum_error = errors(2)
      peaks = [peak_of(extremes), peak_of(tight_extremes)]
      if (any(peaks > 0.0_dp)) verification%acceleration_error = maxval(errors)/minval(peaks, mask=peaks > 0.0_dp)
      lines = min(size(verdict%spectrum%harmonics), size(tight_verdict%spectrum%harmonics))
      differences = abs(verdict%spectrum%harmonics(:lines) - tight_verdict%spectrum%harmonics(:lines))
      differences = max(differences + tight_share*reached*tight_verdict%spectrum%harmonics(:lines), &
                        least_share*maxval(differences)) &
                    + max(verdict%spectrum%resolution_error, tight_verdict%spectrum%resolution_error) + tight_noise
      verification%harmonic_errors = margin*differences

      verification%doubt = doubt_of_class()
      verification%verified = .not. is_doubted(verification%doubt)
      if (verification%verified .and. verdict%class == class_irregular) verification%doubt%parting = verdict%parting

   contains

      !> Errors of the extremes of a film as a share of it, without margin [-].
      pure real(dp) function error_in_film(quantity)
         !> Code of node_extremes
         integer, intent(in) :: quantity

         error_in_film = maxval(errors_of(quantity, 0.0_dp)/ &
                                (margin*[min(extremes%lowest(quantity)%value, tight_extremes%lowest(quantity)%value), &
                                         min(extremes%highest(quantity)%value, tight_extremes%highest(quantity)%value)]))
      end function error_in_film

      !> Largest |z''| [m/s2].
      pure real(dp) function peak_of(extremes)
         type(window_extremes_t), intent(in) :: extremes

         peak_of = max(abs(extremes%lowest(seen_acceleration)%value), abs(extremes%highest(seen_acceleration)%value))
      end function peak_of

      !> Errors of the smallest and the largest value of a quantity.
      pure function errors_of(quantity, noise) result(differences)
         !> Code of node_extremes
         integer, intent(in) :: quantity
         !> What the errors of the tighter solution explain
         real(dp), intent(in) :: noise
         real(dp) :: differences(2)
         real(dp) :: values(2), sizes(2)

         values = [tight_extremes%lowest(quantity)%value, tight_extremes%highest(quantity)%value]
         sizes = max(abs(values), tiny(1.0_dp))
         differences = abs([extremes%lowest(quantity)%value, extremes%highest(quantity)%value] - values)
         differences = margin*(noise + max(differences + tight_share*reached*sizes, &
                                           least_share*maxval(differences/sizes)*sizes))
      end function errors_of

      !> First reason to doubt the class.
      pure type(doubt_t) function doubt_of_class() result(doubt)
         doubt = doubt_t()
         if (tight_verdict%class /= verdict%class) then
            doubt = doubt_t(doubt_class, counts=[tight_verdict%class, 0])
         else if (verdict%class == class_irregular_so_far) then
            doubt = doubt_t(doubt_parting, parting=verdict%parting)
         else if (is_doubted(unclosed)) then
            doubt = unclosed
         else if (verdict%class == class_irregular) then
            ! Irregular motions part from each other; only that they are irregular can stand.
            if (min(verdict%spectrum%irregular_fraction, tight_verdict%spectrum%irregular_fraction) &
               < 2.0_dp*choice%irregular_limit) doubt = doubt_t(doubt_fraction_close)
         else if (film_difference > tolerance) then
            doubt = doubt_t(doubt_film, numbers=[film_difference, 0.0_dp])
         else if (abs(verdict%spectrum%irregular_fraction - choice%irregular_limit) <= &
                  abs(verdict%spectrum%irregular_fraction - tight_verdict%spectrum%irregular_fraction)) then
            doubt = doubt_t(doubt_fraction_error)
         else if (verdict%spectrum%moving .and. verdict%class /= class_subharmonic) then
            doubt = doubt_of_limits(verdict, tight_verdict, differences, choice)
         end if
      end function doubt_of_class

   end subroutine compare_windows

   !> Largest relative error of the numbers of severity [-].
   pure real(dp) function severity_error(severity, tight, tight_accuracy)
      !> Of the scene and of its tighter solution
      type(vibration_severity_t), intent(in) :: severity
      type(vibration_severity_t), intent(in) :: tight
      !> Relative accuracy of the tighter solution [-]
      real(dp), intent(in) :: tight_accuracy

      associate (numbers => numbers_of(severity))
         severity_error = margin*(tight_share*tight_accuracy + &
                                  maxval(abs(numbers - numbers_of(tight))/max(abs(numbers), tiny(1.0_dp))))
      end associate

   contains

      !> All of them.
      pure function numbers_of(severity) result(numbers)
         type(vibration_severity_t), intent(in) :: severity
         real(dp) :: numbers(4)

         numbers = [severity%acceleration_rms, severity%acceleration_kurtosis, severity%film_force_rms, severity%dissipated_energy]
      end function numbers_of

   end function severity_error

   !> First reason to doubt a motion by its window and that of its tighter solution, before both are held against each other.
   pure type(doubt_t) function doubt_of_windows(problem, record, tight_record, noise_floor, tight_noise, verdict, tight_verdict, &
                                                too_few_samples, periods, tight_end, tolerance) result(doubt)
      type(problem_t), intent(in) :: problem
      !> Records of both windows
      type(window_record_t), intent(in) :: record
      type(window_record_t), intent(in) :: tight_record
      !> Accelerations that the errors of both solutions explain [m/s2]
      real(dp), intent(in) :: noise_floor
      real(dp), intent(in) :: tight_noise
      !> Verdicts of both
      type(rattle_verdict_t), intent(in) :: verdict
      type(rattle_verdict_t), intent(in) :: tight_verdict
      !> Doubt about the samples of both, or none
      type(doubt_t), intent(in) :: too_few_samples
      !> Periods of the window
      integer, intent(in) :: periods
      !> Numbers of the state where the tighter solution ends
      real(dp), intent(in) :: tight_end(:)
      !> Difference of films up to which a regular motion is verified [-]
      real(dp), intent(in) :: tolerance

      doubt = first_doubt([doubt_of_flight(tight_record, problem%contact%film%radius), &
                           doubt_of_closing(record, problem%frequency, problem%mass, noise_floor), &
                           doubt_of_closing(tight_record, problem%frequency, problem%mass, tight_noise), &
                           too_few_samples, &
                           doubt_of_impacts(verdict, tight_verdict, periods), &
                           doubt_of_return(verdict, periods, films_of_ends(problem, tight_record, tight_end), tolerance)])
   end function doubt_of_windows

   !> Films where a window begins and where it ends: state, contact [m].
   pure function films_of_ends(problem, record, end_numbers) result(films)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Record of the window, and numbers of the state where it ends
      type(window_record_t), intent(in) :: record
      real(dp), intent(in) :: end_numbers(:)
      real(dp), allocatable :: films(:, :)

      films = films_of(problem, reshape([record%start%numbers, end_numbers], [2, size(end_numbers)], order=[2, 1]))
   end function films_of_ends

   !> Why a window does not close.
   pure type(doubt_t) function doubt_of_closing(record, frequency, mass, noise_floor) result(doubt)
      !> Record of the window; without one there is nothing to close
      type(window_record_t), intent(in) :: record
      !> Frequency of the force [Hz] and mass [kg]
      real(dp), intent(in) :: frequency
      real(dp), intent(in) :: mass
      !> Acceleration that the errors of the solution explain [m/s2]
      real(dp), intent(in) :: noise_floor

      doubt = doubt_t()
      if (record%periods == 0) return
      if (.not. momentum_gap(record, frequency)*record%acceleration_size <= &
          closing_share*record%acceleration_size + noise_floor*real(record%periods, dp)) then
         doubt = doubt_t(doubt_momentum, numbers=[record%acceleration_sum, &
                                                  (record%end_velocity - record%start%numbers(of_velocity))*frequency]/ &
                         real(record%periods, dp))
      else if (.not. energy_gap(record, mass) <= closing_share) then
         doubt = doubt_t(doubt_energy, numbers=-[record%film_work, record%force_work])
      end if
   end function doubt_of_closing

   !> Whether a motion flies beyond what the model means.
   pure type(doubt_t) function doubt_of_flight(record, radius) result(doubt)
      !> Record of the window
      type(window_record_t), intent(in) :: record
      !> Equivalent radius [m]
      real(dp), intent(in) :: radius

      doubt = doubt_t()
      if (record%periods == 0 .or. .not. record%wants(seen_films(1))) return
      associate (largest => record%highest(seen_films(1))%value)
         if (model_limit(radius, largest, radius) == gap_too_wide) doubt = doubt_t(doubt_flight, numbers=[largest, radius])
      end associate
   end function doubt_of_flight

   !> Whether a window is too short to tell an irregular motion; of other motions there is no doubt.
   pure type(doubt_t) function doubt_of_impacts(verdict, tight_verdict, periods) result(doubt)
      !> Verdicts of a scene and of its tighter solution
      type(rattle_verdict_t), intent(in) :: verdict
      type(rattle_verdict_t), intent(in) :: tight_verdict
      !> Periods of the window
      integer, intent(in) :: periods

      doubt = doubt_t()
      if (verdict%class /= class_irregular .or. tight_verdict%class /= class_irregular) return
      if (min(verdict%reversals_per_period, tight_verdict%reversals_per_period)*real(periods, dp) < least_reversals) &
         doubt = doubt_t(doubt_impacts)
   end function doubt_of_impacts

   !> Whether a window of one period is not that of a motion that repeats after it. Of longer windows there is no doubt: there
   !> the power off the harmonics tells.
   pure type(doubt_t) function doubt_of_return(verdict, periods, films, tolerance) result(doubt)
      type(rattle_verdict_t), intent(in) :: verdict
      !> Of the window
      integer, intent(in) :: periods
      !> Films where the window begins and where it ends: state, contact [m]
      real(dp), intent(in) :: films(:, :)
      !> Difference of films up to which a regular motion is verified [-]
      real(dp), intent(in) :: tolerance
      real(dp) :: differences(size(films, 2))
      integer :: contact

      doubt = doubt_t()
      if (periods > 1 .or. is_off_harmonics(verdict%class) .or. verdict%class == class_subharmonic) return
      differences = abs(films(2, :) - films(1, :))/minval(films, dim=1)
      contact = maxloc(differences, dim=1)
      if (differences(contact) > tolerance) doubt = doubt_t(doubt_return, numbers=films(:2, contact))
   end function doubt_of_return

   !> How many windows behind the one that is judged a motion has to be irregular in too. One that hits a flank now and then may be
   !> quiet for a window and irregular in the next: then the class is that of the window, not of the motion.
   pure integer function windows_behind(periods)
      !> Periods of a window
      integer, intent(in) :: periods

      windows_behind = max(least_windows_behind, (least_periods_behind - 1)/periods + 1)
   end function windows_behind

   !> Whether a motion is not irregular behind its window.
   pure type(doubt_t) function doubt_behind(windows, status, verdict) result(doubt)
      !> Windows behind the one that was judged
      integer, intent(in) :: windows
      !> How this one ended, and its verdict
      integer, intent(in) :: status
      type(rattle_verdict_t), intent(in) :: verdict

      doubt = doubt_t()
      if (.not. is_success(status)) then
         doubt = doubt_t(doubt_ending_behind, counts=[status, 0])
      else if (.not. is_off_harmonics(verdict%class)) then
         doubt = doubt_t(doubt_class_behind, counts=[verdict%class, windows])
      end if
   end function doubt_behind

   !> Whether a limit of the classes lies within the errors of the harmonics.
   pure type(doubt_t) function doubt_of_limits(verdict, tight_verdict, errors, choice) result(doubt)
      type(rattle_verdict_t), intent(in) :: verdict
      type(rattle_verdict_t), intent(in) :: tight_verdict
      real(dp), intent(in) :: errors(:)
      type(spectrum_choice_t), intent(in) :: choice
      real(dp) :: unforced(size(errors))
      integer, allocatable :: others(:)
      real(dp) :: forced_error, distortion_error, threshold
      integer :: first, known, fewest, most, i

      doubt = doubt_t()
      associate (spectrum => verdict%spectrum, a => verdict%spectrum%harmonics)
         first = spectrum%largest_forced
         if (.not. a(first) > errors(first)) then
            doubt = doubt_t(doubt_largest_harmonic, counts=[first, 0])
            return
         end if
         known = min(size(errors), size(choice%forced))
         unforced = errors
         where (choice%forced(:known)) unforced(:known) = 0.0_dp
         forced_error = sqrt(max(0.0_dp, sum((errors - unforced)**2)))
         distortion_error = max((sqrt(unforced(1)**2 + sum(unforced(2:)**2)) + spectrum%harmonic_distortion*forced_error)/ &
                                (spectrum%forced_amplitude - forced_error), &
                                abs(spectrum%harmonic_distortion - tight_verdict%spectrum%harmonic_distortion))
         if (abs(spectrum%harmonic_distortion - choice%quiet_limit) <= distortion_error) then
            doubt = doubt_t(doubt_distortion)
            return
         end if
         if (spectrum%harmonic_distortion < choice%quiet_limit) then
            if (spectrum%distortion_is_bound .or. tight_verdict%spectrum%distortion_is_bound) &
               doubt = doubt_t(doubt_distortion_bound)
            return
         end if
         threshold = choice%harmonic_threshold
         others = [(i, i=1, size(errors))]
         others = pack(others, others == first .or. [.not. choice%forced(:known), spread(.true., 1, size(errors) - known)])
         fewest = count(a(others) - errors(others) > threshold*(a(first) + errors(first)))
         most = count(a(others) + errors(others) > threshold*(a(first) - errors(first)))
         if (fewest < choice%idle_harmonics .and. (spectrum%count_is_bound .or. tight_verdict%spectrum%count_is_bound)) then
            doubt = doubt_t(doubt_count_bound, counts=[fewest, 0])
         else if (fewest < choice%idle_harmonics .and. most >= choice%idle_harmonics) then
            doubt = doubt_t(doubt_count, counts=[fewest, most])
         end if
      end associate
   end function doubt_of_limits

   !> Whether the class is verified, in a word.
   pure function verification_word(verification) result(word)
      !> A verification that exists
      type(verification_t), intent(in) :: verification
      character(:), allocatable :: word

      word = 'uncertain'
      if (verification%verified) word = 'verified'
   end function verification_word

   !> Why the class is not verified, or that it is.
   pure function verification_sentence(verification) result(sentence)
      !> A verification that exists
      type(verification_t), intent(in) :: verification
      character(:), allocatable :: sentence, tighter

      sentence = doubt_sentence(verification%doubt)
      if (.not. verification%verified) return
      tighter = 'a tighter tolerance'
      if (verification%pressure_error >= 0.0_dp) tighter = 'twice the nodes and '//tighter
      sentence = 'The class is verified: a second solution with '//tighter//' agrees, and no limit lies within the errors.'
      if (verification%doubt%parting%periods > 0) &
         sentence = sentence//' '//parting_sentence(verification%doubt%parting)//' It may settle later all the same.'
   end function verification_sentence

   !> Verification of a class that could not be put to the test.
   pure function no_verification(doubt) result(verification)
      !> Why not
      type(doubt_t), intent(in) :: doubt
      type(verification_t) :: verification

      verification%exists = .true.
      verification%doubt = doubt
      allocate (verification%harmonic_errors(0))
   end function no_verification

end module verification
