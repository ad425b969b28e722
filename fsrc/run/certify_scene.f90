!> Puts the verdict on a scene to the test: the same scene solved tighter by the error-controlled engine, whatever
!> method solved it first, sampled finely enough for its lines; and the periodic motion behind it with its Floquet
!> multipliers.
module certify_scene
   use certificate, only: certificate_t, compare_windows, no_certificate
   use fine_window, only: solve_fine_window, window_t
   use kinds, only: dp
   use lane_scenes, only: lane_ending_t, lane_scene_t
   use periodic_orbit, only: attracting_period, find_periodic_orbit, periodic_orbit_t
   use rattle_class, only: class_irregular, note_orbit, rattle_verdict_t
   use resolved_scene, only: resolved_scene_t
   use scene_status, only: is_success, status_name
   use scene_types, only: method_newmark, scene_t
   implicit none(type, external)
   private

   !> Accuracy of the tighter solution: this, or a hundredth of the scene's own.
   real(dp), parameter :: tight_accuracy = 1.0e-10_dp, tightest_accuracy = 1.0e-12_dp
   !> A periodic motion farther away than this is not that of the scene [-].
   real(dp), parameter :: orbit_nearness = 0.02_dp

   public :: certify

contains

   !> Certificate and periodic motion of a judged scene.
   subroutine certify(scene, resolved, lane, periods, window, verdict, certificate, orbit)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What follows from it
      type(resolved_scene_t), intent(in) :: resolved
      !> Its lane
      type(lane_scene_t), intent(in) :: lane
      !> Periods solved
      integer, intent(in) :: periods
      !> Window at their end
      type(window_t), intent(in) :: window
      !> Verdict to be tested; an irregular motion found to repeat becomes subharmonic
      type(rattle_verdict_t), intent(inout) :: verdict
      !> Its certificate
      type(certificate_t), intent(out) :: certificate
      !> Periodic motion at the end of the run
      type(periodic_orbit_t), intent(out), optional :: orbit
      type(lane_ending_t) :: ending
      type(periodic_orbit_t) :: found
      type(rattle_verdict_t) :: tight_verdict
      type(window_t) :: tight
      real(dp) :: accuracy

      accuracy = tight_accuracy
      if (scene%solver%method /= method_newmark) accuracy = min(accuracy, max(tightest_accuracy, 0.01_dp*scene%solver%accuracy))
      tight%periods = window%periods
      tight%samples_per_period = window%samples_per_period
      call solve_fine_window(scene, lane, accuracy, periods, resolved%noise_floor_at(accuracy), tight, tight_verdict, ending)
      if (.not. is_success(ending%status)) then
         certificate = no_certificate('The tighter solution ended as '//status_name(ending%status)//'.')
         return
      end if
      if (present(orbit) .or. tight_verdict%class == class_irregular) then
         found = find_periodic_orbit(lane, ending%film, ending%velocity, orbit_nearness)
         call note_orbit(verdict, attracting_period(found))
         call note_orbit(tight_verdict, attracting_period(found))
      end if
      if (present(orbit)) orbit = found
      associate (stride => tight%samples_per_period/window%samples_per_period)
         call compare_windows(window%films, tight%films(stride::stride), window%accelerations, &
                              tight%accelerations(stride::stride), verdict, tight_verdict, scene%spectrum, &
                              scene%spectrum%certificate_tolerance, certificate)
      end associate
   end subroutine certify

end module certify_scene
