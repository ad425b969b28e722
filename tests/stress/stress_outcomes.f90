!> How a scene came out of an engine: right, failed with a status, or a silent failure.
!>
!> An error-controlled solution is right if its film is within K times its accuracy of the tight one. K = 30:
!> a period's worth of local errors may add up to 4 to 12 times the accuracy (the share of it that a step may
!> use up, module taylor_step_control), and a motion remembers some periods. Where errors grow by g (module
!> stress_references) K g times the accuracy is what can be asked for, counted apart as `sensitive`. Where
!> that is above 10 % the growth says no more how far apart motions come, and nothing can be asked for:
!> chaotic motions, and motions that fall to one side or the other.
!>
!> `unjudged`: solved, but the tight solution failed.
module stress_outcomes
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use engine, only: ending_t
   use kinds, only: dp, int64
   use scene_status, only: is_success, status_film_lost, status_no_rigid_film, status_not_converged, &
                           status_overflow, status_steady
   use stress_references, only: compared_samples, comparisons, reference_t
   implicit none(type, external)
   private

   integer, parameter, public :: outcome_right = 1, outcome_sensitive = 2, outcome_not_converged = 3, outcome_film_lost = 4, &
                                 outcome_no_rigid_film = 5, outcome_overflow = 6, outcome_unjudged = 7, outcome_silent = 8
   integer, parameter, public :: outcomes = 8
   character(*), parameter, public :: outcome_names(outcomes) = [character(14) :: 'right', 'sensitive', 'not_converged', &
      'film_lost', 'no_rigid_film', 'overflow', 'unjudged', 'SILENT FAILURE']

   !> K of the header.
   real(dp), parameter :: allowed_ratio = 30.0_dp
   !> Error of the film that growth can foresee [-].
   real(dp), parameter :: unforeseeable = 0.1_dp
   !> More steps for a scene are a hang.
   integer(int64), parameter :: most_steps = 1000000000_int64

   !> What came out.
   type, public :: outcome_t
      integer :: code = 0
      !> Largest relative error of the film; negative: not known
      real(dp) :: error = -1.0_dp
      !> The same over the accuracy asked for
      real(dp) :: ratio = -1.0_dp
      !> Whether the tight solution shows that the scene can be solved
      logical :: solvable = .false.
      !> What is wrong, of a silent failure
      character(24) :: fault = ''
   end type outcome_t

   public :: judge_controlled

contains

   !> Outcome of an error-controlled engine.
   pure function judge_controlled(reference, periods, accuracy, films, ending) result(outcome)
      !> What it is compared with
      type(reference_t), intent(in) :: reference
      !> Periods of the reference
      integer, intent(in) :: periods
      !> Accuracy asked for [-]
      real(dp), intent(in) :: accuracy
      !> Films of the last periods, or of one orbit of a steady motion [m]
      real(dp), intent(in) :: films(:)
      !> How it ended
      type(ending_t), intent(in) :: ending
      type(outcome_t) :: outcome
      real(dp) :: allowed
      integer :: i

      outcome = outcome_of_status(ending%status, reference)
      if (ending%count%steps > most_steps) outcome = silent('too many steps')
      if (outcome%code /= 0) return
      if (.not. is_motion(films(:ending%samples)) .or. .not. is_motion(ending%numbers(:1)) .or. &
          ending%samples == 0 .or. &
          .not. ieee_is_finite(ending%numbers(2))) then
         outcome = silent('no film')
         return
      end if
      outcome%code = outcome_unjudged
      if (.not. reference%exists) return
      outcome%error = 0.0_dp
      do i = 1, ending%samples
         associate (other => reference%films(matching_sample(i, periods, ending)))
            outcome%error = max(outcome%error, abs(films(i) - other)/other)
         end associate
      end do
      outcome%ratio = outcome%error/accuracy
      outcome%code = outcome_right
      if (outcome%error <= allowed_ratio*(accuracy + reference%accuracy)) return
      outcome%code = outcome_sensitive
      allowed = allowed_ratio*(accuracy + reference%accuracy)*reference%growth
      if (outcome%error <= allowed .or. allowed > unforeseeable) return
      outcome%code = outcome_silent
      outcome%fault = merge('wrong steady motion', 'beyond its accuracy', ending%status == status_steady)
   end function judge_controlled

   !> Sample of the reference at the phase of a sample: the same one, or that of the latest period in which an
   !> orbit is where it was then.
   pure integer function matching_sample(sample, periods, ending) result(match)
      !> Sample of the solution
      integer, intent(in) :: sample
      !> Periods of the reference
      integer, intent(in) :: periods
      !> How it ended
      type(ending_t), intent(in) :: ending
      integer :: back

      match = sample
      if (ending%status /= status_steady) return
      back = modulo(periods - ending%periods + (ending%samples - sample)/compared_samples, ending%orbit)
      match = comparisons - (back + 1)*compared_samples + 1 + modulo(sample - 1, compared_samples)
   end function matching_sample

   !> Outcome of a scene that did not get through; code 0 of one that did.
   pure function outcome_of_status(status, reference) result(outcome)
      !> Status of scene_status
      integer, intent(in) :: status
      type(reference_t), intent(in) :: reference
      type(outcome_t) :: outcome

      outcome%solvable = reference%exists
      if (is_success(status)) return
      select case (status)
      case (status_not_converged)
         outcome%code = outcome_not_converged
      case (status_film_lost)
         outcome%code = outcome_film_lost
      case (status_no_rigid_film)
         outcome%code = outcome_no_rigid_film
      case (status_overflow)
         outcome%code = outcome_overflow
      case default
         outcome = silent('unknown status')
      end select
   end function outcome_of_status

   !> A silent failure.
   pure type(outcome_t) function silent(fault)
      !> What is wrong
      character(*), intent(in) :: fault

      silent%code = outcome_silent
      silent%solvable = .true.
      silent%fault = fault
   end function silent

   !> Whether all films are some.
   pure logical function is_motion(films)
      !> [m]
      real(dp), intent(in) :: films(:)

      is_motion = all(films > 0.0_dp) .and. all(ieee_is_finite(films))
   end function is_motion

end module stress_outcomes
