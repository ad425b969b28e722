!> Puts the verdict on a scene to the test: the same scene solved tighter by the error-controlled engine, whatever
!> method solved it first, sampled finely enough for its harmonics; and the periodic motion behind it with its Floquet
!> multipliers.
module verify_scene
   use doubt, only: doubt_samples, doubt_t, doubt_tighter_ending, first_doubt, is_doubted
   use motion_behind, only: follow_behind
   use verification, only: verification_t, compare_windows, doubt_behind, doubt_of_impacts, doubt_of_windows, severity_error, &
      no_verification, windows_behind
   use engine, only: ending_t, motion_state_t, request_t, start_of
   use errors, only: error_t
   use fine_window, only: solve_whole_window, window_t
   use kinds, only: dp
   use known_motions, only: are_near
   use node_extremes, only: seen_pressure
   use nodal_step, only: nodal_choice_t
   use nodal_scene, only: solve_finer
   use vibration_severity, only: severity_of_record, vibration_severity_t
   use periodic_orbit, only: attracting_period, find_periodic_orbit, map_states, periodic_orbit_t
   use carried_loads, only: films_of
   use problem, only: problem_t
   use rattle_class, only: classify_steps, class_irregular, note_known, note_orbit, rattle_verdict_t
   use resolved_scene, only: request_of, resolved_scene_t
   use scene_status, only: is_success
   use scene_types, only: method_newmark, method_taylor, scene_t
   use settled_motion, only: near_states
   use text_output, only: lock_texts, unlock_texts
   use window_class, only: classify_window
   use window_extremes, only: extremes_of_record, window_extremes_t
   use window_impacts, only: agreement_of, impacts_of_record, window_impacts_t
   implicit none(type, external)
   private

   !> Accuracy of the tighter solution: this, or a hundredth of the scene's own.
   real(dp), parameter :: tight_accuracy = 1.0e-10_dp, tightest_accuracy = 1.0e-12_dp
   !> A periodic motion farther away than this is not that of the scene [-].
   real(dp), parameter, public :: orbit_nearness = 0.02_dp

   !> Error of a finer solution in nodes, in the unit that module verification multiplies by ten, over the accuracy of the scene
   real(dp), parameter :: finer_share = 0.03_dp

   public :: verify_motion, verify_in_nodes, tighten, nearby_orbit, orbit_of

contains

   !> Verification and periodic motion of a judged scene.
   subroutine verify_motion(scene, resolved, own, window, extremes, severity, impacts, verdict, verification, orbit, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What follows from it
      type(resolved_scene_t), intent(in) :: resolved
      !> How it ended
      type(ending_t), intent(in) :: own
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
      type(ending_t) :: ending
      type(motion_state_t) :: start
      type(rattle_verdict_t) :: tight_verdict
      type(window_t) :: tight
      type(doubt_t) :: unclosed, unclosed_behind
      real(dp) :: accuracy
      integer :: periods
      logical :: irregular

      start = start_of(resolved%problem)
      call tighten(scene%solver%method, scene%solver%accuracy, accuracy, start%implicit)
      tight%periods = window%periods
      tight%samples_per_period = window%samples_per_period
      periods = own%periods
      irregular = verdict%class == class_irregular
      ! Two solutions of an irregular motion part whatever their digits: the tighter one is that of a window behind. That the motion
      ! comes there from its start is left to be shown of Newmark's steps alone.
      if (irregular .and. scene%solver%method == method_taylor) then
         call go_behind(own%motion_state_t)
         if (allocated(error)) return
         periods = window%periods
      end if
      call solve_whole_window(scene, resolved%problem, start, accuracy, periods, resolved%noise_floor_at(accuracy), tight, &
                              tight_verdict, ending, error)
      if (allocated(error)) return
      if (.not. is_success(ending%status)) then
         verification = no_verification(doubt_t(doubt_tighter_ending, counts=[ending%status, 0]))
         return
      end if
      orbit = nearby_orbit(resolved%problem, ending)
      call note_orbit(tight_verdict, attracting_period(orbit))
      orbit = orbit_of(resolved%problem, own, orbit)
      call note_known(tight_verdict, verdict)
      if (irregular .and. scene%solver%method == method_newmark .and. tight_verdict%class == class_irregular) then
         call go_behind(ending%motion_state_t)
         if (allocated(error)) return
      end if
      unclosed = first_doubt([doubt_of_windows(resolved%problem, window%record, tight%record, resolved%noise_floor, &
                                  resolved%noise_floor_at(accuracy), verdict, tight_verdict, &
                                  doubt_of_samples(scene, verdict, tight, tight_verdict), window%periods, ending%numbers, &
                                  scene%spectrum%verification_tolerance), unclosed_behind])
      call compare_windows(films_of(resolved%problem, window%states), &
                           films_of(resolved%problem, tight%states), extremes, &
                           extremes_of_record(tight%record), verdict, tight_verdict, unclosed, scene%spectrum, &
                           scene%spectrum%verification_tolerance, accuracy, resolved%noise_floor_at(accuracy), verification)
      verification%impacts = agreement_of(resolved%problem, extremes, impacts, extremes_of_record(tight%record), &
                                         impacts_of_record(tight%record, resolved%problem%frequency))
      verification%severity_error = severity_error(severity, severity_of_record(tight%record, resolved%problem%frequency), accuracy)

   contains

      !> See that the motion stays irregular behind its window, and go there.
      subroutine go_behind(from)
         !> Where the window ends
         type(motion_state_t), intent(in) :: from
         type(motion_state_t) :: behind(1)
         type(doubt_t) :: found(1)

         behind = from
         call unlock_texts()
         call follow_behind([resolved], [scene%spectrum], window%periods, window%samples_per_period, behind, found, error)
         call lock_texts()
         behind%implicit = behind%implicit .or. start%implicit
         start = behind(1)
         start%periods = 0
         unclosed_behind = found(1)
      end subroutine go_behind

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
         verification = no_verification(doubt_t(doubt_tighter_ending, counts=[ending%status, 0]))
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
                                             impacts_of_record(finer%record, problem%frequency))
         verification%severity_error = severity_error(severity, severity_of_record(finer%record, problem%frequency), &
                                                      finer_share*scene%solver%accuracy)
         associate (pressures => [extremes%highest(seen_pressure)%value, finer%record%highest(seen_pressure)%value])
            verification%pressure_error = abs(pressures(1) - pressures(2))/minval(pressures)
         end associate
      end associate
   end subroutine verify_in_nodes

   !> How a scene is solved tighter.
   pure subroutine tighten(method, own_accuracy, accuracy, by_collocation)
      !> Code of its method
      integer, intent(in) :: method
      !> Relative accuracy that it was solved with [-]
      real(dp), intent(in) :: own_accuracy
      !> Relative accuracy of the tighter solution [-]
      real(dp), intent(out) :: accuracy
      !> Whether by the implicit method, whatever the film law
      logical, intent(out) :: by_collocation

      accuracy = tight_accuracy
      by_collocation = .false.
      if (method /= method_taylor) return
      accuracy = min(accuracy, max(tightest_accuracy, 0.01_dp*own_accuracy))
      ! Where there is no room for a tighter solution, another method tells the errors.
      by_collocation = accuracy > 0.05_dp*own_accuracy
   end subroutine tighten

   !> The periodic motion at the end of a run, if there is one.
   type(periodic_orbit_t) function nearby_orbit(problem, ending)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Where its motion ended
      type(ending_t), intent(in) :: ending

      call unlock_texts()
      nearby_orbit = find_periodic_orbit(problem, ending%numbers, orbit_nearness)
      call lock_texts()
   end function nearby_orbit

   !> The periodic motion that a scene ends on: that of its tighter solution, which is nearer to it, unless this has come to another
   !> motion of the scene.
   type(periodic_orbit_t) function orbit_of(problem, own, tight) result(orbit)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> How the scene ended
      type(ending_t), intent(in) :: own
      !> Periodic motion of its tighter solution, or none
      type(periodic_orbit_t), intent(in) :: tight
      real(dp) :: states(size(own%numbers), 1)
      integer :: period
      logical :: mapped

      orbit = tight
      if (tight%period > 0) states(:, 1) = tight%state
      do period = 1, tight%period
         if (are_near(problem, near_states(problem), states(:, 1), own%numbers)) return
         call unlock_texts()
         call map_states(problem, 1, tight_accuracy, states, mapped)
         call lock_texts()
      end do
      if (tight%period > 0) orbit = nearby_orbit(problem, own)
   end function orbit_of

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

   !> Whether the samples are too few, and how many would do.
   pure type(doubt_t) function doubt_of_samples(scene, verdict, tight, tight_verdict) result(doubt)
      type(scene_t), intent(in) :: scene
      type(rattle_verdict_t), intent(in) :: verdict
      !> The tighter solution
      type(window_t), intent(in) :: tight
      type(rattle_verdict_t), intent(in) :: tight_verdict
      logical :: would_do

      doubt = doubt_t()
      if (verdict%spectrum%sampling_sufficient .and. tight_verdict%spectrum%sampling_sufficient) return
      would_do = tight_verdict%spectrum%sampling_sufficient .and. tight%classified_by > scene%solver%samples_per_period()
      doubt = doubt_t(doubt_samples, counts=[merge(tight%classified_by, 0, would_do), &
                                             merge(1, 0, scene%solver%method == method_newmark)])
   end function doubt_of_samples

end module verify_scene
