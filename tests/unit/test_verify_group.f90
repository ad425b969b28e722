!> Tests of the verification of groups: motions that repeat after several periods whose windows begin elsewhere.
module test_verify_group
   use canonical_scenes, only: canonical_scene
   use verification, only: verification_t
   use checks, only: check_list_t
   use engine, only: request_t, start_of
   use kinds, only: dp
   use node_extremes, only: seen_quantities
   use rattle_class, only: class_subharmonic
   use classify_group, only: classify_windows
   use errors, only: error_t
   use periodic_orbit, only: periodic_orbit_t
   use prepared_scene, only: prepare, prepared_scene_t
   use scene_orbit, only: nearby_orbit
   use verify_group, only: verified_windows_t, verify_windows
   use scene_group, only: scene_group_t, solve_group
   use scene_status, only: status_complete
   use scene_types, only: law_iso_viscous, scene_t
   implicit none(type, external)
   private

   integer, parameter :: samples_per_period = 64
   logical, parameter :: wants(seen_quantities) = .true.

   public :: run_verify_group_tests

contains

   !> Runs every test of this topic.
   subroutine run_verify_group_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('verify_group')
      call test_phase_of_an_orbit(checks)
   end subroutine run_verify_group_tests

   !> Solve and classify a scene alone.
   subroutine solve(speed, amplitude, request, scenes, group)
      real(dp), intent(in) :: speed
      real(dp), intent(in) :: amplitude
      type(request_t), intent(in) :: request
      type(prepared_scene_t), intent(out) :: scenes(1)
      type(scene_group_t), intent(inout) :: group
      type(scene_t) :: scene
      type(error_t), allocatable :: error

      scene = canonical_scene(law_iso_viscous, samples_per_period)
      scene%kinematics%entrainment_speed = speed
      scene%excitation%force_amplitude = amplitude
      scenes(1) = prepare(scene)
      scenes(1)%request = request
      call solve_group(scenes, start_of(scenes%resolved%problem), wants, group)
      call classify_windows(scenes, group, error)
   end subroutine solve

   !> A motion that repeats after two periods stands, with whichever of them its window begins, and whether it is known to
   !> repeat from its own solution or from the tighter one.
   subroutine test_phase_of_an_orbit(checks)
      class(check_list_t), intent(inout) :: checks
      type(prepared_scene_t) :: scenes(1)
      type(scene_group_t) :: group, tight
      type(request_t) :: request
      type(periodic_orbit_t) :: orbit
      real(dp), allocatable :: states(:, :)
      type(verification_t) :: verifications(1)
      type(error_t), allocatable :: error

      request = request_t(accuracy=1.0e-6_dp, periods=400, samples_per_period=samples_per_period, sampled_periods=8, &
                          until_steady=.true.)
      call solve(12.0_dp, 290.0_dp, request, scenes, group)
      orbit = nearby_orbit(scenes(1)%resolved%problem, group%endings(1))
      group%repeat_after(1) = orbit%period
      associate (samples => group%endings(1)%samples)
         call checks%check(samples == 2*samples_per_period .and. group%verdicts(1)%class == class_subharmonic, &
                           'an orbit of two periods')
         call verify_windows(scenes, verified_windows_t(), group, tight, verifications, error)
         call checks%check(verifications(1)%verified, 'as it was solved')
         states = group%states(:samples, :, 1)
         group%states(:samples, :, 1) = cshift(states, samples_per_period)
         call verify_windows(scenes, verified_windows_t(), group, tight, verifications, error)
         call checks%check(verifications(1)%verified, 'beginning with the other period')
         group%endings(1)%status = status_complete
         call verify_windows(scenes, verified_windows_t(), group, tight, verifications, error)
         call checks%check(verifications(1)%verified, 'known to repeat by the tighter solution alone')
         group%states(:samples, :, 1) = cshift(states, samples_per_period/2)
         call verify_windows(scenes, verified_windows_t(), group, tight, verifications, error)
         call checks%check(.not. verifications(1)%verified, 'half a period late it is another motion')
      end associate
   end subroutine test_phase_of_an_orbit

end module test_verify_group
