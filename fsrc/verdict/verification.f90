!> How far a verdict can be trusted: the window of a scene compared with the same window solved tighter.
module verification
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use doubt, only: doubt_class, doubt_count, doubt_count_bound, doubt_distortion, doubt_distortion_bound, doubt_energy, &
      doubt_film, doubt_flight, doubt_fraction_close, doubt_fraction_error, doubt_halves, doubt_impacts, doubt_largest_harmonic, &
      doubt_momentum, doubt_parting, doubt_return, doubt_sentence, doubt_t, first_doubt, is_doubted, parting_sentence
   use carried_loads, only: films_of
   use harmonic_spectrum, only: gather_about_multiples
   use irregular_statistics, only: irregular_statistics_t
   use kinds, only: dp
   use vibration_severity, only: severity_numbers, vibration_severity_t
   use node_extremes, only: seen_acceleration, seen_films
   use problem, only: most_contacts, of_velocity, problem_t
   use regime_check, only: gap_too_wide, model_limit
   use rattle_class, only: class_irregular_so_far, class_subharmonic, is_off_harmonics, rattle_verdict_t
   use scene_types, only: spectrum_choice_t
   use window_extremes, only: window_extremes_t
   use window_impacts, only: impact_agreement_t, impulse_mean, window_impacts_t
   use window_record, only: energy_gap, momentum_gap, window_record_t
   implicit none(type, external)
   private

   !> What the comparison says. The errors are those of the numbers beside them, never printed smaller than the tighter
   !> solution can show. A relative error is a share of the smaller one of both numbers: a film that is reported a hundred times too
   !> thin is 9900 % off, not 99 %.
   type, public :: verification_t
      !> Whether there was a tighter solution to compare with
      logical :: exists = .false.
      !> The class is verified
      logical :: verified = .false.
      !> Whether it is an irregular motion, and errors are twice the standard errors over the periods that it was followed
      logical :: by_statistics = .false.
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
      !> Errors of these, each in its unit; of impacts a period [-], and of their mean impulse [N s], of each contact
      type(vibration_severity_t) :: severity_errors
      real(dp) :: impacts_per_period_errors(most_contacts) = 0.0_dp
      real(dp) :: impulse_mean_errors(most_contacts) = 0.0_dp
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
   !> Reversals of the acceleration that an irregular motion has at least while it is followed, four impacts.
   real(dp), parameter :: least_reversals = 8.0_dp

   public :: compare_windows, irregular_verification, note_severity_errors, note_impact_errors, no_verification, &
             verified_in_brackets, verification_word, verification_sentence, &
             doubt_of_windows, doubt_of_closing, doubt_of_flight, doubt_of_impacts, &
             doubt_of_return, films_of_ends

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
      ! Other films are the backlash less the first one: its last digit is a share of a thin film.
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

   !> Errors of the severity by that of the tighter solution.
   pure subroutine note_severity_errors(severity, tight, tight_accuracy, verification)
      !> Of the scene and of its tighter solution
      type(vibration_severity_t), intent(in) :: severity
      type(vibration_severity_t), intent(in) :: tight
      !> Relative accuracy of the tighter solution [-]
      real(dp), intent(in) :: tight_accuracy
      type(verification_t), intent(inout) :: verification

      associate (numbers => severity_numbers(severity))
         associate (errors => margin*(abs(numbers - severity_numbers(tight)) + tight_share*tight_accuracy*abs(numbers)))
            verification%severity_errors = vibration_severity_t(errors(1), errors(2), errors(3), errors(4))
            verification%severity_error = maxval(errors/max(abs(numbers), tiny(1.0_dp)))
         end associate
      end associate
   end subroutine note_severity_errors

   !> Errors of the impacts by those of the tighter solution.
   pure subroutine note_impact_errors(impacts, tight, verification)
      !> Of the scene and of its tighter solution
      type(window_impacts_t), intent(in) :: impacts
      type(window_impacts_t), intent(in) :: tight
      type(verification_t), intent(inout) :: verification

      ! By whole numbers, so that what agrees has no error.
      verification%impacts_per_period_errors = margin*abs(real(impacts%contacts%count*tight%periods - &
                                                               tight%contacts%count*impacts%periods, dp)) &
                                               /real(max(1, impacts%periods)*max(1, tight%periods), dp)
      verification%impulse_mean_errors = margin*abs(impulse_mean(impacts%contacts) - impulse_mean(tight%contacts))
   end subroutine note_impact_errors

   !> Verification of an irregular motion by the periods that it was followed. A second solution would be another sample of it:
   !> what stands is its exponent, and what both halves of these periods agree in.
   pure type(verification_t) function irregular_verification(problem, record, verdict, statistics, choice, noise_floor) &
      result(verification)
      type(problem_t), intent(in) :: problem
      !> Record of these periods, and the verdict on them
      type(window_record_t), intent(in) :: record
      type(rattle_verdict_t), intent(in) :: verdict
      type(irregular_statistics_t), intent(in) :: statistics
      !> Limits of the classes
      type(spectrum_choice_t), intent(in) :: choice
      !> Acceleration that the errors of the solution explain [m/s2]
      real(dp), intent(in) :: noise_floor
      type(doubt_t) :: apart

      apart = doubt_t()
      if (.not. statistics%halves_agree) apart = doubt_t(doubt_halves, numbers=statistics%rms_of_halves)
      verification = no_verification(first_doubt([doubt_of_flight(record, problem%contact%film%radius), &
                                                  doubt_of_closing(record, problem%frequency, problem%mass, noise_floor), &
                                                  doubt_of_impacts(verdict, record%periods), &
                                                  doubt_of_fraction(verdict, choice), apart]))
      verification%verified = .not. is_doubted(verification%doubt)
      verification%by_statistics = .true.
      associate (errors => margin*severity_numbers(statistics%severity))
         verification%severity_errors = vibration_severity_t(errors(1), errors(2), errors(3), errors(4))
      end associate
      verification%severity_error = margin*statistics%severity_share
      verification%harmonic_errors = margin*statistics%harmonics
      verification%impacts_per_period_errors = margin*statistics%impacts_per_period
      verification%impulse_mean_errors = margin*statistics%impulse_mean
      verification%impacts = impact_agreement_t(verdict=statistics%same_contacts, numbers=statistics%halves_agree)
      verification%doubt%parting = verdict%parting
      associate (unknown => ieee_value(1.0_dp, ieee_quiet_nan))
         verification%film_error = unknown
         verification%film_minimum_error = unknown
         verification%film_maximum_error = unknown
         verification%acceleration_error = unknown
         verification%acceleration_minimum_error = unknown
         verification%acceleration_maximum_error = unknown
      end associate
   end function irregular_verification

   !> First reason to doubt a motion by its window and that of its tighter solution, before both are compared with each other.
   pure type(doubt_t) function doubt_of_windows(problem, record, tight_record, noise_floor, tight_noise, verdict, &
                                                too_few_samples, periods, tight_end, tolerance) result(doubt)
      type(problem_t), intent(in) :: problem
      !> Records of both windows
      type(window_record_t), intent(in) :: record
      type(window_record_t), intent(in) :: tight_record
      !> Accelerations that the errors of both solutions explain [m/s2]
      real(dp), intent(in) :: noise_floor
      real(dp), intent(in) :: tight_noise
      !> Verdict on the first one
      type(rattle_verdict_t), intent(in) :: verdict
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

   !> Whether an irregular motion shows too little of itself.
   pure type(doubt_t) function doubt_of_impacts(verdict, periods) result(doubt)
      type(rattle_verdict_t), intent(in) :: verdict
      !> That the verdict is on
      integer, intent(in) :: periods

      doubt = doubt_t()
      if (verdict%reversals_per_period*real(periods, dp) < least_reversals) doubt = doubt_t(doubt_impacts)
   end function doubt_of_impacts

   !> Whether an irregular motion is nearly on its harmonics.
   pure type(doubt_t) function doubt_of_fraction(verdict, choice) result(doubt)
      type(rattle_verdict_t), intent(in) :: verdict
      type(spectrum_choice_t), intent(in) :: choice

      doubt = doubt_t()
      if (verdict%spectrum%irregular_fraction < 2.0_dp*choice%irregular_limit) doubt = doubt_t(doubt_fraction_close)
   end function doubt_of_fraction

   !> Whether a window of one period is not that of a motion that repeats after it. Of longer windows there is no doubt: there
   !> the power off the harmonics shows.
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
      if (periods > 1 .or. is_off_harmonics(verdict%class)) return
      differences = abs(films(2, :) - films(1, :))/minval(films, dim=1)
      contact = maxloc(differences, dim=1)
      if (differences(contact) > tolerance) doubt = doubt_t(doubt_return, numbers=films(:2, contact))
   end function doubt_of_return

   !> Whether a limit of the classes lies within the errors of the harmonics.
   pure type(doubt_t) function doubt_of_limits(verdict, tight_verdict, errors, choice) result(doubt)
      type(rattle_verdict_t), intent(in) :: verdict
      type(rattle_verdict_t), intent(in) :: tight_verdict
      real(dp), intent(in) :: errors(:)
      type(spectrum_choice_t), intent(in) :: choice
      real(dp), dimension(size(errors)) :: unforced, others
      real(dp), allocatable :: gathered(:), their_errors(:)
      real(dp) :: forced_error, distortion_error
      integer :: first, known, fewest, most

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
         others = a(:size(errors))
         where (choice%forced(:known)) others(:known) = 0.0_dp
         ! The error of a root of a sum of squares is at most that root of the errors.
         gathered = gather_about_multiples(others, choice%dominant_order)
         their_errors = gather_about_multiples(unforced, choice%dominant_order)
         associate (threshold => choice%harmonic_threshold, largest => [a(first) + errors(first), a(first) - errors(first)])
            fewest = count([a(first) - errors(first) > threshold*largest(1), &
                            gathered(2:) - their_errors(2:) > threshold*largest(1)])
            most = count([a(first) + errors(first) > threshold*largest(2), &
                          gathered(2:) + their_errors(2:) > threshold*largest(2)])
         end associate
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

   !> The same behind a word for a reader: it is the numbers that are verified, not the model.
   pure function verified_in_brackets(verified) result(words)
      logical, intent(in) :: verified
      character(:), allocatable :: words

      words = ' (uncertain)'
      if (verified) words = ' (numerically verified)'
   end function verified_in_brackets

   !> Why the class is not verified, or that it is.
   pure function verification_sentence(verification) result(sentence)
      !> A verification that exists
      type(verification_t), intent(in) :: verification
      character(:), allocatable :: sentence, tighter

      sentence = doubt_sentence(verification%doubt)
      if (.not. verification%verified) return
      if (verification%by_statistics) then
         sentence = parting_sentence(verification%doubt%parting)//' Both halves of these agree: the class is verified. '// &
                    'It may settle later all the same.'
         return
      end if
      tighter = 'a tighter tolerance'
      if (verification%pressure_error >= 0.0_dp) tighter = 'twice the nodes and '//tighter
      sentence = 'The class is verified: a second solution with '//tighter//' agrees, and no limit lies within the errors.'
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
