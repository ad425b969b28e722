!> Class of a motion by the spectrum of its acceleration.
module rattle_class
   use kinds, only: dp
   use reversals, only: count_reversals, reversal_prominence
   use scene_types, only: spectrum_choice_t
   use spectral_lines, only: find_lines, find_lines_by_integrals, spectral_lines_t
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   integer, parameter, public :: class_quiet = 1, class_creep = 2, class_idle = 3, class_irregular = 4, class_subharmonic = 5

   !> Verdict on a window.
   type, public :: rattle_verdict_t
      integer :: class = class_quiet
      real(dp) :: reversals_per_period = 0.0_dp
      type(spectral_lines_t) :: lines
   end type rattle_verdict_t

   public :: classify, classify_steps, note_orbit

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

      call find_lines(acceleration, choice%periods, choice%forced, choice%line_threshold, noise_floor, verdict%lines)
      verdict%class = class_of(verdict%lines, choice)
      if (verdict%lines%moving) verdict%reversals_per_period = &
         real(count_reversals(acceleration, reversal_prominence), dp)/real(choice%periods, dp)
   end subroutine classify

   !> A motion off its harmonics that is known to repeat after several periods of the force is subharmonic.
   elemental subroutine note_orbit(verdict, orbit)
      !> Verdict on the lines of the motion
      type(rattle_verdict_t), intent(inout) :: verdict
      !> Periods of the force after which the motion is known to repeat, 0: not known
      integer, intent(in) :: orbit

      if (verdict%class == class_irregular .and. orbit > 1) verdict%class = class_subharmonic
   end subroutine note_orbit

   !> Classify a window by the integrals over the steps of its motion: however short an impact is, they see it. Of the power
   !> beyond the highest multiple that is integrated, as much is taken to be off the harmonics as of the highest quarter of them.
   subroutine classify_steps(record, frequency, choice, noise_floor, verdict)
      !> Record of all periods of the window, with Fourier coefficients
      type(window_record_t), intent(in) :: record
      !> Frequency of the force [Hz]
      real(dp), intent(in) :: frequency
      !> Limits
      type(spectrum_choice_t), intent(in) :: choice
      !> Amplitude that the errors of the solution explain [m/s2]
      real(dp), intent(in) :: noise_floor
      type(rattle_verdict_t), intent(out) :: verdict
      real(dp), dimension(record%multiples) :: varying, repeating
      real(dp) :: mean, periods, power, off_harmonics, beyond, irregular_beyond
      integer :: highest_quarter

      periods = real(record%periods, dp)
      mean = record%acceleration_sum/periods
      power = 2.0_dp*(record%acceleration_square/periods - mean*mean)
      highest_quarter = (3*record%multiples)/4 + 1
      associate (sums => record%line_sums, squares => record%line_squares, n => record%multiples)
         ! What varies from period to period is off the harmonics; of the mean of z'' only that.
         repeating(:) = (abs(sums(1:))/periods)**2
         varying(:) = max(0.0_dp, squares(1:)/periods - repeating)
         off_harmonics = sum(varying) + 0.5_dp*max(0.0_dp, squares(0)/periods - (abs(sums(0))/periods)**2)
         beyond = max(0.0_dp, power/(2.0_dp*frequency)**2 - off_harmonics - sum(repeating))
         irregular_beyond = beyond*share(sum(varying(highest_quarter:)), sum(repeating(highest_quarter:)))
         call find_lines_by_integrals(2.0_dp*frequency/periods*abs(sums(1:n)), &
                                      share(off_harmonics + irregular_beyond, sum(repeating) + beyond - irregular_beyond), &
                                      power, choice%forced, choice%line_threshold, noise_floor, verdict%lines)
      end associate
      verdict%class = class_of(verdict%lines, choice)
      if (verdict%lines%moving) verdict%reversals_per_period = &
         real(count_reversals(record%turns(:record%turn_count), reversal_prominence), dp)/periods

   contains

      !> Share of the first of two powers in both of them.
      pure real(dp) function share(one, other)
         real(dp), intent(in) :: one
         real(dp), intent(in) :: other

         share = one/max(one + other, tiny(1.0_dp))
      end function share

   end subroutine classify_steps

   !> Order of the questions: regular at all, rich at all, how rich.
   pure integer function class_of(lines, choice) result(class)
      type(spectral_lines_t), intent(in) :: lines
      type(spectrum_choice_t), intent(in) :: choice

      if (.not. lines%moving) then
         class = class_quiet
      else if (lines%irregular_fraction > choice%irregular_limit) then
         class = class_irregular
      else if (lines%harmonic_distortion < choice%quiet_limit) then
         class = class_quiet
      else if (lines%line_count >= choice%idle_lines) then
         class = class_idle
      else
         class = class_creep
      end if
   end function class_of

end module rattle_class
