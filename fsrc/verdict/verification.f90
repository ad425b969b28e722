!> How far a verdict can be trusted: the window of a scene held against the same window solved tighter.
module verification
   use kinds, only: dp
   use vibration_severity, only: vibration_severity_t
   use node_extremes, only: seen_acceleration, seen_coast_film, seen_film
   use quantities, only: quantity_rattle_class, quantity_word
   use problem, only: of_velocity
   use lyapunov, only: draws_near, parting_t
   use rattle_class, only: class_irregular, class_irregular_so_far, class_subharmonic, is_off_harmonics, rattle_verdict_t
   use scene_status, only: is_success, status_name
   use scene_types, only: spectrum_choice_t
   use text, only: counted, error_text, integer_text, short_text, spaced
   use window_extremes, only: window_extremes_t
   use window_impacts, only: impact_agreement_t
   use window_record, only: energy_gap, momentum_gap, window_record_t
   implicit none(type, external)
   private

   !> What the comparison says. The errors are those of the numbers beside them, never printed smaller than the tighter
   !> solution can tell. A relative error is a share of the smaller one of both numbers: a film that is told a hundred times too
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
      !> Whether the impacts are the same
      type(impact_agreement_t) :: impacts = impact_agreement_t()
      !> Errors of the harmonics [m/s2]
      real(dp), allocatable :: harmonic_errors(:)
      !> Why it is not verified, or that it is
      character(:), allocatable :: reason
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

   public :: compare_windows, severity_error, no_verification, verification_word, closing_sentence, doubt_of_impacts, &
             doubt_of_return, windows_behind, doubt_behind

contains

   !> Verification of a window by a tighter one of the same samples.
   pure subroutine compare_windows(films, tight_films, extremes, tight_extremes, verdict, tight_verdict, unclosed, choice, &
                                   tolerance, tight_accuracy, tight_noise, verification)
      !> Films of the scene and of its tighter solution: sample, flank [m]. Their errors count against the thinner film of both
      !> flanks.
      real(dp), intent(in) :: films(:, :)
      real(dp), intent(in) :: tight_films(:, :)
      !> Extremes of both
      type(window_extremes_t), intent(in) :: extremes
      type(window_extremes_t), intent(in) :: tight_extremes
      !> Verdicts of both
      type(rattle_verdict_t), intent(in) :: verdict
      type(rattle_verdict_t), intent(in) :: tight_verdict
      !> Why one of the windows does not close; empty if both do
      character(*), intent(in) :: unclosed
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
      integer :: lines

      verification%exists = .true.
      reached = tight_accuracy
      ! The coast film is what the other one leaves of the backlash, whose last digit is a share of a thin one.
      if (size(films, 2) > 1) reached = max(reached, epsilon(1.0_dp)*tight_extremes%highest(seen_film)%value/ &
                                            max(tiny(1.0_dp), tight_extremes%lowest(seen_coast_film)%value))
      errors = errors_of(seen_film, 0.0_dp)
      verification%film_minimum_error = errors(1)
      verification%film_maximum_error = errors(2)
      film_difference = max(maxval(maxval(abs(films - tight_films), dim=2)/minval(min(films, tight_films), dim=2)), &
                            error_in_film(seen_film))
      if (size(films, 2) > 1) film_difference = max(film_difference, error_in_film(seen_coast_film))
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

      verification%reason = doubt()
      verification%verified = len(verification%reason) == 0
      if (verification%verified) verification%reason = 'The class is verified: a second solution with a tighter tolerance '// &
         'agrees, and no limit lies '// &
                                                      'within the errors.'
      if (verification%verified .and. verdict%class == class_irregular) verification%reason = verification%reason// &
         ' '//parting_sentence(verdict%parting)//' It may settle later all the same.'

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

      !> First reason to doubt the class, empty if there is none.
      pure function doubt() result(reason)
         character(:), allocatable :: reason

         reason = ''
         if (tight_verdict%class /= verdict%class) then
            reason = 'Solved tighter, the class is '//spaced(quantity_word(quantity_rattle_class, tight_verdict%class))//'.'
         else if (verdict%class == class_irregular_so_far) then
            reason = doubt_of_parting(verdict%parting)
         else if (len(unclosed) > 0) then
            reason = unclosed
         else if (verdict%class == class_irregular) then
            ! Irregular motions part from each other; only that they are irregular can stand.
            if (min(verdict%spectrum%irregular_fraction, tight_verdict%spectrum%irregular_fraction) &
               < 2.0_dp*choice%irregular_limit) &
               reason = 'The irregular fraction is close to its limit.'
         else if (film_difference > tolerance) then
            reason = 'Solved tighter, the film differs by '//short_text(100.0_dp*film_difference, 2)//' %.'
         else if (abs(verdict%spectrum%irregular_fraction - choice%irregular_limit) <= &
                  abs(verdict%spectrum%irregular_fraction - tight_verdict%spectrum%irregular_fraction)) then
            reason = 'The irregular fraction is within its error of its limit.'
         else if (verdict%spectrum%moving .and. verdict%class /= class_subharmonic) then
            reason = doubt_of_limits(verdict, tight_verdict, differences, choice)
         end if
      end function doubt

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

   !> Why a window does not close, empty if it does.
   pure function closing_sentence(record, frequency, mass, noise_floor) result(reason)
      !> Record of the window; without one there is nothing to close
      type(window_record_t), intent(in) :: record
      !> Frequency of the force [Hz] and mass [kg]
      real(dp), intent(in) :: frequency
      real(dp), intent(in) :: mass
      !> Acceleration that the errors of the solution explain [m/s2]
      real(dp), intent(in) :: noise_floor
      character(:), allocatable :: reason

      reason = ''
      if (record%periods == 0) return
      if (.not. momentum_gap(record, frequency)*record%acceleration_size <= &
          closing_share*record%acceleration_size + noise_floor*real(record%periods, dp)) then
         reason = 'The window does not close: the mean of z" is '// &
                  short_text(record%acceleration_sum/real(record%periods, dp), 3)//' m/s2, while the change of velocity gives '// &
                  short_text((record%end_velocity - record%start%numbers(of_velocity)) &
                             *frequency/real(record%periods, dp), 3)//' m/s2.'
      else if (.not. energy_gap(record, mass) <= closing_share) then
         reason = 'The window does not close: the film takes '//short_text(-record%film_work, 3)//' J, the forces give '// &
                  short_text(-record%force_work, 3)//' J.'
      end if
   end function closing_sentence

   !> Why a window is too short to tell an irregular motion, empty if it is not, or the motion is another one.
   pure function doubt_of_impacts(verdict, tight_verdict, periods) result(reason)
      !> Verdicts of a scene and of its tighter solution
      type(rattle_verdict_t), intent(in) :: verdict
      type(rattle_verdict_t), intent(in) :: tight_verdict
      !> Periods of the window
      integer, intent(in) :: periods
      character(:), allocatable :: reason

      reason = ''
      if (verdict%class /= class_irregular .or. tight_verdict%class /= class_irregular) return
      if (min(verdict%reversals_per_period, tight_verdict%reversals_per_period)*real(periods, dp) < least_reversals) &
         reason = 'The window holds too few impacts to tell an irregular motion; more of spectrum.periods would.'
   end function doubt_of_impacts

   !> Why a window of one period is not that of a motion that repeats after it, empty if it is, or the window has more: there the
   !> power off the harmonics tells.
   pure function doubt_of_return(verdict, periods, films, tolerance) result(reason)
      type(rattle_verdict_t), intent(in) :: verdict
      !> Of the window
      integer, intent(in) :: periods
      !> Films where the window begins and where it ends: state, flank [m]
      real(dp), intent(in) :: films(:, :)
      !> Difference of films up to which a regular motion is verified [-]
      real(dp), intent(in) :: tolerance
      character(:), allocatable :: reason
      real(dp) :: differences(size(films, 2))
      integer :: flank

      reason = ''
      if (periods > 1 .or. is_off_harmonics(verdict%class) .or. verdict%class == class_subharmonic) return
      differences = abs(films(2, :) - films(1, :))/minval(films, dim=1)
      flank = maxloc(differences, dim=1)
      if (differences(flank) > tolerance) &
         reason = 'The window of one period begins with a film of '//short_text(films(1, flank), 3)//' m and ends with '// &
                  short_text(films(2, flank), 3)//' m: the motion does not repeat after it. '// &
                  'More of spectrum.periods would tell more.'
   end function doubt_of_return

   !> How many windows behind the one that is judged a motion has to be irregular in too. One that hits a flank now and then may be
   !> quiet for a window and irregular in the next: then the class is that of the window, not of the motion.
   pure integer function windows_behind(periods)
      !> Periods of a window
      integer, intent(in) :: periods

      windows_behind = max(least_windows_behind, (least_periods_behind - 1)/periods + 1)
   end function windows_behind

   !> Why a motion is not irregular behind its window, empty if it is.
   pure function doubt_behind(windows, status, verdict) result(reason)
      !> Windows behind the one that was judged
      integer, intent(in) :: windows
      !> How this one ended, and its verdict
      integer, intent(in) :: status
      type(rattle_verdict_t), intent(in) :: verdict
      character(:), allocatable :: reason

      reason = ''
      if (.not. is_success(status)) then
         reason = 'Behind the window the motion ends as '//status_name(status)//'.'
      else if (.not. is_off_harmonics(verdict%class)) then
         reason = 'The class is that of this window: '//counted(windows, 'window')//' later the motion is '// &
                  spaced(quantity_word(quantity_rattle_class, verdict%class))//'.'
      end if
   end function doubt_behind

   !> Why a motion is irregular only so far.
   pure function doubt_of_parting(parting) result(reason)
      !> How a neighbour parts from it
      type(parting_t), intent(in) :: parting
      character(:), allocatable :: reason

      if (parting%periods == 0) then
         reason = 'The motion does not repeat, and it could not be followed beside a neighbouring one.'
      else if (draws_near(parting)) then
         reason = parting_sentence(parting)//' The motion settles; more of solver.periods would tell to what.'
      else
         reason = parting_sentence(parting)//' That is not positive beyond its error: more of solver.periods would tell more.'
      end if
   end function doubt_of_parting

   !> The Lyapunov exponent of a motion that was followed.
   pure function parting_sentence(parting) result(sentence)
      type(parting_t), intent(in) :: parting
      character(:), allocatable :: sentence

      sentence = 'Neighbouring motions part with a Lyapunov exponent of '//short_text(parting%exponent, 2)//' +- '// &
                error_text(parting%standard_error, parting%exponent, 2)//' a period, over '//counted(parting%periods, 'period')//'.'
   end function parting_sentence

   !> Whether a limit of the classes lies within the errors of the harmonics.
   pure function doubt_of_limits(verdict, tight_verdict, errors, choice) result(reason)
      type(rattle_verdict_t), intent(in) :: verdict
      type(rattle_verdict_t), intent(in) :: tight_verdict
      real(dp), intent(in) :: errors(:)
      type(spectrum_choice_t), intent(in) :: choice
      character(:), allocatable :: reason
      real(dp) :: unforced(size(errors))
      integer, allocatable :: others(:)
      real(dp) :: forced_error, distortion_error, threshold
      integer :: first, known, fewest, most, i

      reason = ''
      associate (spectrum => verdict%spectrum, a => verdict%spectrum%harmonics)
         first = spectrum%largest_forced
         if (.not. a(first) > errors(first)) then
            reason = 'The largest harmonic at a harmonic of the force is as small as its error.'
            if (first == 1) reason = 'The first harmonic is as small as its error.'
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
            reason = 'The harmonic distortion is within its error of the quiet limit.'
            return
         end if
         if (spectrum%harmonic_distortion < choice%quiet_limit) then
            if (spectrum%distortion_is_bound .or. tight_verdict%spectrum%distortion_is_bound) &
               reason = 'The harmonic distortion is a lower bound: more harmonics than are resolved may lift it over the '// &
                  'quiet limit.'
            return
         end if
         threshold = choice%harmonic_threshold
         others = [(i, i=1, size(errors))]
         others = pack(others, others == first .or. [.not. choice%forced(:known), spread(.true., 1, size(errors) - known)])
         fewest = count(a(others) - errors(others) > threshold*(a(first) + errors(first)))
         most = count(a(others) + errors(others) > threshold*(a(first) - errors(first)))
         if (fewest < choice%idle_harmonics .and. (spectrum%count_is_bound .or. tight_verdict%spectrum%count_is_bound)) then
            reason = 'There are at least '//integer_text(fewest)//' harmonics, and beyond the highest resolved one there may '// &
               'be more.'
         else if (fewest < choice%idle_harmonics .and. most >= choice%idle_harmonics) then
            reason = 'Within their errors there are '//integer_text(fewest)//' to '//integer_text(most)//' harmonics.'
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

   !> Verification of a class that could not be put to the test.
   pure function no_verification(reason) result(verification)
      !> Why not
      character(*), intent(in) :: reason
      type(verification_t) :: verification

      verification%exists = .true.
      verification%reason = reason
      allocate (verification%harmonic_errors(0))
   end function no_verification

end module verification
