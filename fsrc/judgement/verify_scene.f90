!> Puts the verdict on a single scene to the test: a group of one, or in nodes of pressure; and the periodic motion behind it with its
!> Floquet multipliers.
module verify_scene
   use carried_loads, only: films_of
   use doubt, only: doubt_t, doubt_second_ending, is_doubted
   use engine, only: ending_t, request_t
   use errors, only: error_t
   use fine_window, only: window_t
   use group_verification, only: tighten, verify_group
   use kinds, only: dp
   use nodal_scene, only: solve_finer
   use nodal_step, only: nodal_choice_t
   use node_extremes, only: seen_pressure
   use periodic_orbit, only: periodic_orbit_t
   use rattle_class, only: class_irregular, classify_steps, note_known, note_orbit, rattle_verdict_t
   use prepared_scene, only: request_of, resolved_scene_t
   use scene_group, only: scene_group_t
   use scene_orbit, only: orbit_of
   use scene_status, only: is_success
   use scene_types, only: method_taylor, scene_t
   use text_output, only: lock_texts, unlock_texts
   use verification, only: compare_windows, doubt_behind, doubt_of_impacts, no_verification, severity_error, verification_t, &
      windows_behind
   use vibration_severity, only: severity_of_record, vibration_severity_t
   use window_class, only: classify_window
   use window_extremes, only: extremes_of_record, window_extremes_t
   use window_impacts, only: agreement_of, impacts_of_record, window_impacts_t
   implicit none(type, external)
   private

   !> Error of a finer solution in nodes, in the unit that module verification multiplies by ten, over the accuracy of the scene
   real(dp), parameter :: finer_share = 0.03_dp

   public :: verify_motion, verify_in_nodes

contains

   !> Verification and periodic motion of a judged scene.
   subroutine verify_motion(scene, resolved, own, repeats_after, window, extremes, severity, impacts, verdict, verification, &
                            orbit, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What follows from it
      type(resolved_scene_t), intent(in) :: resolved
      !> How it ended
      type(ending_t), intent(in) :: own
      !> Periods of the force after which it repeats, 0 where none is known
      integer, intent(in) :: repeats_after
      !> Window at its end
      type(window_t), intent(in) :: window
      !> Its extremes, severity and impacts
      type(window_extremes_t), intent(in) :: extremes
      type(vibration_severity_t), intent(in) :: severity
      type(window_impacts_t), intent(in) :: impacts
      !> Verdict to be tested
      type(rattle_verdict_t), intent(in) :: verdict
      !> Its verification
      type(verification_t), intent(out) :: verification
      !> Periodic motion that it ends on, if there is one
      type(periodic_orbit_t), intent(inout) :: orbit
      !> Set if there is not enough memory
      type(error_t), allocatable, intent(out) :: error
      type(scene_group_t) :: group, tight
      type(request_t) :: request
      type(verification_t) :: verifications(1)
      type(periodic_orbit_t) :: orbits(1)
      real(dp) :: accuracy
      logical :: implicit

      request = request_t(accuracy=scene%solver%accuracy, periods=own%periods, samples_per_period=window%samples_per_period, &
                          sampled_periods=window%periods)
      allocate (group%states(size(window%states, 1), size(window%states, 2), 1))
      group%states(:, :, 1) = window%states
      allocate (group%endings(1), source=own)
      group%endings(1)%samples = size(window%states, 1)
      allocate (group%records(1), source=window%record)
      group%records(1)%lowest = extremes%lowest
      group%records(1)%highest = extremes%highest
      allocate (group%verdicts(1), source=verdict)
      group%repeat_after = [repeats_after]
      call verify_group([resolved], [scene%spectrum], scene%solver%method, request, group, tight, verifications, [impacts], orbits)
      if (allocated(tight%error)) call move_alloc(tight%error, error)
      if (allocated(error)) return
      verification = verifications(1)
      if (.not. is_success(tight%endings(1)%status)) return
      orbit = orbits(1)
      ! Newmark's method may be off by more than motions of a scene differ.
      if (scene%solver%method == method_taylor) orbit = orbit_of(resolved%problem, own, orbits(1))
      call tighten(scene%solver%method, scene%solver%accuracy, accuracy, implicit)
      verification%severity_error = severity_error(severity, severity_of_record(tight%records(1), resolved%problem%frequency), &
                                                    accuracy)
   end subroutine verify_motion

   !> Verification of a scene whose films are solved in nodes: by twice as many of them and a tighter tolerance. Its window need not
   !> close to the last digits, as its steps are of third order.
   subroutine verify_in_nodes(scene, resolved, choice, periods, orbit, window, extremes, severity, impacts, verdict, &
                              verification)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What follows from it
      type(resolved_scene_t), intent(in) :: resolved
      !> How it was followed
      type(nodal_choice_t), intent(in) :: choice
      !> Periods solved
      integer, intent(in) :: periods
      !> Periods after which it repeats, else 0
      integer, intent(in) :: orbit
      !> Window at their end
      type(window_t), intent(in) :: window
      !> Its extremes, severity and impacts
      type(window_extremes_t), intent(in) :: extremes
      type(vibration_severity_t), intent(in) :: severity
      type(window_impacts_t), intent(in) :: impacts
      !> Verdict to be tested
      type(rattle_verdict_t), intent(in) :: verdict
      !> Its verification
      type(verification_t), intent(out) :: verification
      type(window_t) :: finer
      type(ending_t) :: ending
      type(rattle_verdict_t) :: finer_verdict
      type(doubt_t) :: doubt

      finer%periods = window%periods
      finer%samples_per_period = window%samples_per_period
      call unlock_texts()
      call solve_finer(scene, resolved%problem, choice, request_of(scene), periods, finer, ending)
      call lock_texts()
      if (.not. is_success(ending%status)) then
         verification = no_verification(doubt_t(doubt_second_ending, counts=[ending%status, 0]))
         return
      end if
      call classify_window(scene%spectrum, resolved%problem, finer%periods, finer%accelerations, finer%record, &
                           resolved%noise_floor, finer_verdict)
      if (.not. finer_verdict%spectrum%sampling_sufficient .or. window%classified_by == 0) &
         call classify_steps(finer%record, resolved%problem%frequency, scene%spectrum, resolved%noise_floor, finer_verdict)
      call note_orbit(finer_verdict, orbit)
      call note_known(finer_verdict, verdict)
      doubt = doubt_of_impacts(verdict, finer_verdict, window%periods)
      if (.not. is_doubted(doubt) .and. verdict%class == class_irregular .and. finer_verdict%class == class_irregular) &
         call look_behind_in_nodes(scene, resolved, choice, ending, window, doubt)
      associate (problem => resolved%problem)
         ! Of the films their extremes count: where one falls by decades in an impact, a millionth of a period is a third of it.
         call compare_windows(spread(minval(films_of(problem, window%states), dim=1), 1, 1), &
                              spread(minval(films_of(problem, finer%states), dim=1), 1, 1), extremes, &
                              extremes_of_record(finer%record), verdict, finer_verdict, doubt, scene%spectrum, &
                              scene%spectrum%verification_tolerance, finer_share*scene%solver%accuracy, 0.0_dp, verification)
         verification%impacts = agreement_of(problem, extremes, impacts, extremes_of_record(finer%record), &
                                             impacts_of_record(finer%record, problem%frequency), orbit > window%periods)
         verification%severity_error = severity_error(severity, severity_of_record(finer%record, problem%frequency), &
                                                      finer_share*scene%solver%accuracy)
         associate (pressures => [extremes%highest(seen_pressure)%value, finer%record%highest(seen_pressure)%value])
            verification%pressure_error = 2.0_dp*abs(pressures(1) - pressures(2))/minval(pressures)
         end associate
      end associate
   end subroutine verify_in_nodes

   !> Whether a motion in nodes stays irregular behind the window of its finer solution.
   subroutine look_behind_in_nodes(scene, resolved, choice, ending, judged, doubt)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What follows from it
      type(resolved_scene_t), intent(in) :: resolved
      !> How it was followed
      type(nodal_choice_t), intent(in) :: choice
      !> Of the finer solution
      type(ending_t), intent(in) :: ending
      !> The window that was judged
      type(window_t), intent(in) :: judged
      !> None if the motion stays irregular
      type(doubt_t), intent(out) :: doubt
      type(window_t) :: window
      type(ending_t) :: last
      type(rattle_verdict_t) :: verdict
      type(request_t) :: request
      integer :: passed

      last = ending
      request = request_of(scene)
      doubt = doubt_t()
      call unlock_texts()
      do passed = 1, windows_behind(judged%periods)
         window = window_t(periods=judged%periods, samples_per_period=judged%samples_per_period)
         call solve_finer(scene, resolved%problem, choice, request, last%periods + judged%periods, window, last, goes_on=.true.)
         if (is_success(last%status)) call classify_window(scene%spectrum, resolved%problem, window%periods, window%accelerations, &
                                                           window%record, resolved%noise_floor, verdict)
         doubt = doubt_behind(passed, last%status, verdict)
         if (is_doubted(doubt)) exit
      end do
      call lock_texts()
   end subroutine look_behind_in_nodes

end module verify_scene
