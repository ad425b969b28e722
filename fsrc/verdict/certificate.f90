!> How far a verdict can be trusted: the window of a scene held against the same window solved tighter.
module certificate
   use kinds, only: dp
   use rattle_class, only: class_irregular, class_name, class_subharmonic, rattle_verdict_t
   use scene_types, only: spectrum_choice_t
   use text, only: integer_text, short_text
   implicit none(type, external)
   private

   !> What the comparison says.
   type, public :: certificate_t
      !> Whether there was a tighter solution to compare with
      logical :: exists = .false.
      !> The class stands
      logical :: certified = .false.
      !> Largest relative difference of the film over the window [-]
      real(dp) :: film_error = 0.0_dp
      !> Difference of the largest |z''| relative to it [-]
      real(dp) :: acceleration_error = 0.0_dp
      !> Differences of the lines [m/s2]
      real(dp), allocatable :: harmonic_errors(:)
      !> Why it is not certified, or that it is
      character(:), allocatable :: reason
   end type certificate_t

   public :: compare_windows, no_certificate, certificate_word

contains

   !> Certificate of a window by a tighter one of the same samples.
   pure subroutine compare_windows(films, tight_films, accelerations, tight_accelerations, verdict, tight_verdict, choice, &
                                   tolerance, certificate)
      !> Film of the scene and of its tighter solution [m]
      real(dp), intent(in) :: films(:)
      real(dp), intent(in) :: tight_films(:)
      !> Accelerations of both [m/s2]
      real(dp), intent(in) :: accelerations(:)
      real(dp), intent(in) :: tight_accelerations(:)
      !> Verdicts of both
      type(rattle_verdict_t), intent(in) :: verdict
      type(rattle_verdict_t), intent(in) :: tight_verdict
      !> Limits of the classes
      type(spectrum_choice_t), intent(in) :: choice
      !> Film error up to which a regular motion is certified [-]
      real(dp), intent(in) :: tolerance
      !> The certificate
      type(certificate_t), intent(out) :: certificate
      real(dp) :: peak
      integer :: lines

      certificate%exists = .true.
      certificate%film_error = maxval(abs(films - tight_films)/tight_films)
      peak = maxval(abs(tight_accelerations))
      if (peak > 0.0_dp) certificate%acceleration_error = abs(maxval(abs(accelerations)) - peak)/peak
      lines = min(size(verdict%lines%harmonics), size(tight_verdict%lines%harmonics))
      certificate%harmonic_errors = abs(verdict%lines%harmonics(:lines) - tight_verdict%lines%harmonics(:lines))

      certificate%reason = doubt()
      certificate%certified = len(certificate%reason) == 0
      if (certificate%certified) certificate%reason = 'The class stands: solved tighter, it is the same, and no limit lies '// &
                                                      'within the errors.'

   contains

      !> First reason to doubt the class, empty if there is none.
      pure function doubt() result(reason)
         character(:), allocatable :: reason

         reason = ''
         if (tight_verdict%class /= verdict%class) then
            reason = 'Solved tighter, the class is '//class_name(tight_verdict%class)//'.'
         else if (verdict%class == class_irregular) then
            ! Irregular motions part from each other; only that they are irregular can stand.
            if (min(verdict%lines%irregular_fraction, tight_verdict%lines%irregular_fraction) < 2.0_dp*choice%irregular_limit) &
               reason = 'The irregular fraction is close to its limit.'
         else if (certificate%film_error > tolerance) then
            reason = 'Solved tighter, the film differs by '//short_text(100.0_dp*certificate%film_error, 2)//' %.'
         else if (abs(verdict%lines%irregular_fraction - choice%irregular_limit) <= &
                  abs(verdict%lines%irregular_fraction - tight_verdict%lines%irregular_fraction)) then
            reason = 'The irregular fraction is within its error of its limit.'
         else if (verdict%lines%moving .and. verdict%class /= class_subharmonic) then
            reason = doubt_of_limits(verdict, certificate%harmonic_errors, choice)
         end if
      end function doubt

   end subroutine compare_windows

   !> Whether a limit of the classes lies within the errors of the lines.
   pure function doubt_of_limits(verdict, errors, choice) result(reason)
      type(rattle_verdict_t), intent(in) :: verdict
      real(dp), intent(in) :: errors(:)
      type(spectrum_choice_t), intent(in) :: choice
      character(:), allocatable :: reason
      real(dp) :: distortion_error, threshold
      integer :: fewest, most

      reason = ''
      associate (lines => verdict%lines, a => verdict%lines%harmonics)
         if (.not. a(1) > errors(1)) then
            reason = 'The first harmonic is as small as its error.'
            return
         end if
         distortion_error = (sqrt(sum(errors(2:)**2)) + lines%harmonic_distortion*errors(1))/(a(1) - errors(1))
         if (abs(lines%harmonic_distortion - choice%quiet_limit) <= distortion_error) then
            reason = 'The harmonic distortion is within its error of the quiet limit.'
            return
         end if
         if (lines%harmonic_distortion < choice%quiet_limit) return
         threshold = choice%line_threshold
         fewest = count(a(:size(errors)) - errors > threshold*(a(1) + errors(1)))
         most = count(a(:size(errors)) + errors > threshold*(a(1) - errors(1)))
         if (fewest < choice%idle_lines .and. most >= choice%idle_lines) &
            reason = 'Within their errors there are '//integer_text(fewest)//' to '//integer_text(most)//' lines.'
      end associate
   end function doubt_of_limits

   !> Whether the class stands, in a word.
   pure function certificate_word(certificate) result(word)
      !> A certificate that exists
      type(certificate_t), intent(in) :: certificate
      character(:), allocatable :: word

      word = 'uncertain'
      if (certificate%certified) word = 'certified'
   end function certificate_word

   !> Certificate of a class that could not be put to the test.
   pure function no_certificate(reason) result(certificate)
      !> Why not
      character(*), intent(in) :: reason
      type(certificate_t) :: certificate

      certificate%exists = .true.
      certificate%reason = reason
      allocate (certificate%harmonic_errors(0))
   end function no_certificate

end module certificate
