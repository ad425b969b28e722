!> Class of a motion by the spectrum of its acceleration.
module rattle_class
   use kinds, only: dp
   use lyapunov, only: parting_t
   use reversals, only: count_reversals, reversal_prominence
   use scene_types, only: spectrum_choice_t
   use harmonic_spectrum, only: find_harmonics, find_harmonics_by_integrals, harmonic_spectrum_t
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> A motion off the harmonics of its force is subharmonic if it repeats after a period all the same. Else it is irregular so
   !> far; it becomes subharmonic or irregular as soon as more is known of it.
   integer, parameter, public :: class_quiet = 1, class_creep = 2, class_idle = 3, class_irregular = 4, class_subharmonic = 5, &
                         class_irregular_so_far = 6

   !> Verdict on a window.
   type, public :: rattle_verdict_t
      integer :: class = class_quiet
      real(dp) :: reversals_per_period = 0.0_dp
      !> Of a motion that does not repeat: how a neighbouring one parts from it
      type(parting_t) :: parting = parting_t()
      type(harmonic_spectrum_t) :: spectrum
   end type rattle_verdict_t

   !> What a motion of each class sounds like, whatever the tooth does: an impact is a matter of the verdict.
   character(*), parameter, public :: sounds(6) = [character(49) :: &
      'a sound of little beside the orders of the force', 'a sound of few harmonics', 'a sound of many harmonics', &
      'a sound that does not repeat', 'a sound that repeats after several periods', 'a sound that has not repeated yet']

   public :: classify, classify_steps, note_orbit, note_parting, note_known, is_off_harmonics

contains

   !> Classify a window of whole periods of acceleration.
   subroutine classify(acceleration, choice, noise_floor, verdict)
      !> Samples, the same count in each of choice%periods periods [m/s2]
      real(dp), intent(in) :: acceleration(:)
      !> Periods and limits
      type(spectrum_choice_t), intent(in) :: choice
      !> Amplitude that the errors of the solution explain [m/s2]
      real(dp), intent(in) :: noise_floor
      type(rattle_verdict_t), intent(out) :: verdict

      call find_harmonics(acceleration, choice%periods, choice, noise_floor, verdict%spectrum)
      verdict%class = class_of(verdict%spectrum, choice)
      if (verdict%spectrum%moving) verdict%reversals_per_period = &
         real(count_reversals(acceleration, reversal_prominence), dp)/real(choice%periods, dp)
   end subroutine classify

   !> A motion off the harmonics that is known to repeat after several periods of the force is subharmonic.
   elemental subroutine note_orbit(verdict, orbit)
      !> Verdict on the harmonics of the motion
      type(rattle_verdict_t), intent(inout) :: verdict
      !> Periods of the force after which the motion is known to repeat, 0: not known
      integer, intent(in) :: orbit

      if (verdict%class == class_irregular_so_far .and. orbit > 1) verdict%class = class_subharmonic
   end subroutine note_orbit

   !> A motion that does not repeat, and that its neighbours leave for good, is irregular.
   elemental subroutine note_parting(verdict, parting)
      !> Verdict on the harmonics of the motion
      type(rattle_verdict_t), intent(inout) :: verdict
      !> How a neighbour parts from it
      type(parting_t), intent(in) :: parting

      if (verdict%class /= class_irregular_so_far) return
      verdict%parting = parting
      if (parting%for_good) verdict%class = class_irregular
   end subroutine note_parting

   !> What is known of a motion off its harmonics counts for another solution of it as well: looked at once, it counts for both.
   !> Where it repeats after several periods, the films of both show whether they are one motion.
   elemental subroutine note_known(verdict, known)
      !> Verdict on the harmonics of the other solution
      type(rattle_verdict_t), intent(inout) :: verdict
      !> Verdict on the motion
      type(rattle_verdict_t), intent(in) :: known

      call note_orbit(verdict, merge(2, 0, known%class == class_subharmonic))
      call note_parting(verdict, known%parting)
   end subroutine note_known

   !> Whether a window is off its harmonics, and its motion is not known to repeat.
   elemental logical function is_off_harmonics(class)
      integer, intent(in) :: class

      is_off_harmonics = class == class_irregular .or. class == class_irregular_so_far
   end function is_off_harmonics

   !> Classify a window by the integrals over the steps of its motion: however short an impact is, they see it. Of the power
   !> beyond the highest multiple that is integrated, as much is taken to be off the harmonics as of the highest quarter of them.
   !> It is more where impacts come earlier or later from period to period: that takes the more of a harmonic the higher it is. The
   !> share of the power off the harmonics is a lower bound, then.
   subroutine classify_steps(record, frequency, choice, noise_floor, verdict, by_power)
      !> Record of all periods of the window, with Fourier coefficients
      type(window_record_t), intent(in) :: record
      !> Frequency of the force [Hz]
      real(dp), intent(in) :: frequency
      !> Limits
      type(spectrum_choice_t), intent(in) :: choice
      !> Amplitude that the errors of the solution explain [m/s2]
      real(dp), intent(in) :: noise_floor
      type(rattle_verdict_t), intent(out) :: verdict
      !> Whether harmonics are those of the mean power of a period, as of a motion that does not repeat, whose phases are lost; else,
      !> and where absent, those that come again from period to period
      logical, intent(in), optional :: by_power
      real(dp), dimension(record%multiples) :: varying, repeating, harmonics
      !> Share of the power beyond the highest multiple that is neglected, and share of the highest quarter off the harmonics below
      !> which a motion repeats so well that its impacts come in time: it grows with the square of the order at most
      real(dp), parameter :: negligible = 1.0e-3_dp, repeating_share = 1.0e-5_dp
      real(dp) :: mean, periods, power, varying_fraction, irregular_fraction, share_repeating
      logical :: is_bound, known_beyond
      integer :: n

      periods = real(record%periods, dp)
      mean = record%acceleration_sum/periods
      power = 2.0_dp*(record%acceleration_square/periods - mean*mean)
      associate (sums => record%harmonic_sums, squares => record%harmonic_squares)
         ! What varies from period to period is off the harmonics; of the mean of z'' only that.
         harmonics(:) = abs(sums(1:))/periods
         repeating(:) = harmonics**2
         varying(:) = max(0.0_dp, squares(1:)/periods - repeating)
         call find_share_off(varying_fraction, is_bound)
         share_repeating = 1.0_dp - varying_fraction
         known_beyond = .not. (is_bound .and. varying_fraction > choice%irregular_limit)
         irregular_fraction = varying_fraction
         if (choice%common_order > 1) then
            where ([(modulo(n, choice%common_order) > 0, n=1, record%multiples)])
               varying = varying + repeating
               repeating = 0.0_dp
            end where
            call find_share_off(irregular_fraction, is_bound)
         end if
         if (present(by_power)) then
            if (by_power) then
               harmonics(:) = sqrt(squares(1:)/periods)
               share_repeating = 1.0_dp
            end if
         end if
         call find_harmonics_by_integrals(2.0_dp*frequency*harmonics, share_repeating*power, &
                                          known_beyond, power, choice, noise_floor, verdict%spectrum)
         if (verdict%spectrum%moving) then
            verdict%spectrum%varying_fraction = varying_fraction
            verdict%spectrum%irregular_fraction = irregular_fraction
            verdict%spectrum%irregular_is_bound = is_bound
         end if
      end associate
      verdict%class = class_of(verdict%spectrum, choice)
      if (verdict%spectrum%moving) verdict%reversals_per_period = &
         real(count_reversals(record%turns(:record%turn_count), reversal_prominence), dp)/periods

   contains

      !> Share of the power off the harmonics, and whether it is a bound.
      pure subroutine find_share_off(share_off, is_bound)
         real(dp), intent(out) :: share_off
         logical, intent(out) :: is_bound
         real(dp) :: off_harmonics, beyond, share_beyond
         integer :: highest_quarter

         highest_quarter = (3*record%multiples)/4 + 1
         associate (mean_sum => record%harmonic_sums(0), mean_squares => record%harmonic_squares(0))
            off_harmonics = sum(varying) + 0.5_dp*max(0.0_dp, mean_squares/periods - (abs(mean_sum)/periods)**2)
         end associate
         beyond = max(0.0_dp, power/(2.0_dp*frequency)**2 - off_harmonics - sum(repeating))
         share_beyond = share(sum(varying(highest_quarter:)), sum(repeating(highest_quarter:)))
         share_off = share(off_harmonics + beyond*share_beyond, sum(repeating) + beyond - beyond*share_beyond)
         is_bound = share_beyond > repeating_share .and. &
                    beyond - beyond*share_beyond > negligible*(off_harmonics + sum(repeating) + beyond)
      end subroutine find_share_off

      !> Share of the first of two powers in both of them.
      pure real(dp) function share(one, other)
         real(dp), intent(in) :: one
         real(dp), intent(in) :: other

         share = one/max(one + other, tiny(1.0_dp))
      end function share

   end subroutine classify_steps

   !> Order of the questions: regular at all, rich at all, how rich.
   pure integer function class_of(spectrum, choice) result(class)
      type(harmonic_spectrum_t), intent(in) :: spectrum
      type(spectrum_choice_t), intent(in) :: choice

      if (.not. spectrum%moving) then
         class = class_quiet
      else if (spectrum%irregular_fraction > choice%irregular_limit) then
         class = merge(class_subharmonic, class_irregular_so_far, spectrum%varying_fraction <= choice%irregular_limit)
      else if (spectrum%harmonic_distortion < choice%quiet_limit) then
         class = class_quiet
      else if (spectrum%harmonic_count >= choice%idle_harmonics) then
         class = class_idle
      else
         class = class_creep
      end if
   end function class_of

end module rattle_class
