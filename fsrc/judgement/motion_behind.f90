!> Whether irregular motions, solved again, are irregular in their windows and stay so behind them, and where they are then: one
!> procedure for scenes and rows.
!>
!> Two solutions of an irregular motion part whatever their digits, so that one of another accuracy is another sample of it: one that
!> settles shows that the first one may. Nothing but the class of its windows is asked for, which integrals over their steps tell.
module motion_behind
   use doubt, only: doubt_class, doubt_class_behind, doubt_none, doubt_t, doubt_second_ending
   use engine, only: ending_t, motion_state_t, request_t
   use errors, only: error_t
   use finer_windows, only: classify_finer, integral_record
   use kinds, only: dp
   use many_motions, only: solve_motions
   use problem, only: state_size
   use rattle_class, only: classify_steps, is_off_harmonics, rattle_verdict_t
   use prepared_scene, only: resolved_scene_t
   use scene_status, only: is_success
   use scene_types, only: spectrum_choice_t
   use signals, only: must_stop
   use verification, only: doubt_behind, windows_behind
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Accuracy of the other solution: enough to tell motions apart, and another one where the scene has nearly this [-]
   real(dp), parameter :: usual_accuracy = 1.0e-6_dp, finer_accuracy = 1.0e-8_dp, nearly = 0.1_dp

   public :: follow_behind, other_accuracy

contains

   !> Accuracy of another solution of an irregular motion [-].
   elemental real(dp) function other_accuracy(own_accuracy)
      !> That of the first one [-]
      real(dp), intent(in) :: own_accuracy

      other_accuracy = merge(usual_accuracy, finer_accuracy, own_accuracy <= nearly*usual_accuracy)
   end function other_accuracy

   !> Solve irregular motions again, side by side, and follow them behind their windows. After a signal to stop the answers are of no
   !> use.
   subroutine follow_behind(resolved, choices, accuracy, before, periods, samples_per_period, states, doubts, error)
      !> What follows from the scenes, and the limits of their classes
      type(resolved_scene_t), intent(in) :: resolved(:)
      type(spectrum_choice_t), intent(in) :: choices(:)
      !> Relative accuracy of this solution [-]
      real(dp), intent(in) :: accuracy
      !> Periods before the windows that were judged
      integer, intent(in) :: before
      !> Periods of a window, and samples of each, from which on more are taken where integrals leave the class open
      integer, intent(in) :: periods
      integer, intent(in) :: samples_per_period
      !> Where the motions start; on return where the last window behind ends, or the last one that could be followed
      type(motion_state_t), intent(inout) :: states(:)
      !> None where a motion stays irregular
      type(doubt_t), intent(out) :: doubts(:)
      !> Set if there is no memory for the samples that a class needs; the doubts are of no use then
      type(error_t), allocatable, intent(out) :: error
      type(request_t) :: window
      integer, allocatable :: left(:)
      integer :: i, passed

      allocate (left, source=[(i, i=1, size(resolved))])
      if (size(left) == 0) return
      if (before > 0) call go_to_windows
      window = request_t(accuracy=accuracy, periods=periods, samples_per_period=1, sampled_periods=periods, every_period=.true.)
      do passed = 0, windows_behind(periods)
         if (size(left) == 0 .or. must_stop() .or. allocated(error)) return
         call pass_window
      end do

   contains

      !> Follow the motions to where their windows begin.
      subroutine go_to_windows
         type(ending_t) :: endings(size(left))
         real(dp) :: none(0, 2, size(left))
         integer :: k

         call solve_motions(resolved%problem, states, request_t(accuracy=accuracy, periods=before), none, endings)
         do k = 1, size(left)
            if (is_success(endings(k)%status)) then
               states(k) = endings(k)%motion_state_t
            else
               doubts(k) = doubt_t(doubt_second_ending, counts=[endings(k)%status, 0])
            end if
         end do
         left = pack(left, doubts%code == doubt_none)
      end subroutine go_to_windows

      !> Follow those that are left through one more window.
      subroutine pass_window
         type(motion_state_t) :: starts(size(left))
         type(ending_t) :: endings(size(left))
         type(window_record_t) :: records(size(left))
         type(rattle_verdict_t) :: verdicts(size(left))
         real(dp) :: numbers(periods, maxval(state_size(resolved(left)%problem)), size(left))
         logical :: followed(size(left))
         integer :: k

         starts = states(left)
         starts%periods = 0
         do k = 1, size(left)
            records(k) = integral_record(choices(left(k)))
         end do
         numbers = 0.0_dp
         call solve_motions(resolved(left)%problem, starts, window, numbers, endings, records=records)
         followed = is_success(endings%status)
         do k = 1, size(left)
            if (.not. followed(k)) cycle
            call classify_steps(records(k), resolved(left(k))%problem%frequency, choices(left(k)), &
                                resolved(left(k))%noise_floor_at(accuracy), verdicts(k))
            states(left(k)) = endings(k)%motion_state_t
         end do
         call settle_bounds(pack([(k, k=1, size(left))], followed .and. verdicts%spectrum%irregular_is_bound .and. &
                                                         .not. is_off_harmonics(verdicts%class)), records, verdicts)
         if (allocated(error)) return
         do k = 1, size(left)
            doubts(left(k)) = doubt_behind(passed, endings(k)%status, verdicts(k))
            if (passed == 0 .and. doubts(left(k))%code == doubt_class_behind) doubts(left(k))%code = doubt_class
         end do
         left = pack(left, doubts(left)%code == doubt_none)
      end subroutine pass_window

      !> Classes where integrals give no more than a bound of what is off the harmonics: by samples, as many as it takes.
      subroutine settle_bounds(unsure, records, verdicts)
         !> Places of these among those that are left
         integer, intent(in) :: unsure(:)
         type(window_record_t), intent(in) :: records(:)
         type(rattle_verdict_t), intent(inout) :: verdicts(:)
         type(rattle_verdict_t) :: classes(size(unsure))
         integer :: classified_by(size(unsure)), k

         if (size(unsure) == 0) return
         classes = verdicts(unsure)
         classes%spectrum%sampling_sufficient = .false.
         associate (scenes => left(unsure))
            call classify_finer(resolved(scenes)%problem, choices(scenes), &
                                [(resolved(scenes(k))%noise_floor_at(accuracy), k=1, size(unsure))], accuracy, &
                            samples_per_period, spread(periods, 1, size(unsure)), records(unsure), classes, classified_by, .true., &
                                error)
         end associate
         verdicts(unsure) = classes
      end subroutine settle_bounds

   end subroutine follow_behind

end module motion_behind
