!> Tests of motions followed behind their windows: one that stays irregular, one that settles, and both side by side.
module test_motion_behind
   use canonical_scenes, only: canonical_scene
   use checks, only: check_list_t
   use doubt, only: doubt_class_behind, doubt_t, is_doubted
   use engine, only: ending_t, motion_state_t, request_t, start_of
   use errors, only: error_t
   use kinds, only: dp
   use lyapunov, only: map_accuracy
   use many_motions, only: solve_motions
   use motion_behind, only: follow_behind
   use rattle_class, only: class_irregular, class_irregular_so_far
   use resolved_scene, only: resolve, resolved_scene_t
   use scene_types, only: law_iso_viscous, scene_t, spectrum_choice_t
   use verification, only: windows_behind
   implicit none(type, external)
   private

   integer, parameter :: samples_per_period = 64, window = 8

   public :: run_motion_behind_tests

contains

   !> Runs every test of this topic.
   subroutine run_motion_behind_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('motion_behind')
      call test_two_motions(checks)
   end subroutine run_motion_behind_tests

   !> A motion that stays irregular is followed through all windows, as if it had never stopped. One that settles is left where it is
   !> seen to, and tells after how many windows and to what. Neither changes a bit of the other.
   subroutine test_two_motions(checks)
      class(check_list_t), intent(inout) :: checks
      !> Of the scenes: speed [m/s], amplitude [N], periods before the windows behind
      real(dp), parameter :: speeds(2) = [12.0_dp, 1.905_dp], amplitudes(2) = [1200.0_dp, 400.0_dp]
      integer, parameter :: periods(2) = [60, 8]
      type(scene_t) :: scene
      type(resolved_scene_t) :: resolved(2)
      type(spectrum_choice_t) :: choices(2)
      type(motion_state_t) :: starts(2), together(2), alone(1)
      type(ending_t) :: ended(1)
      type(doubt_t) :: doubts(2), doubt(1)
      type(error_t), allocatable :: error
      real(dp) :: none(0, 2, 1)
      integer :: i, passed

      do i = 1, 2
         scene = canonical_scene(law_iso_viscous, samples_per_period)
         scene%kinematics%entrainment_speed = speeds(i)
         scene%excitation%force_amplitude = amplitudes(i)
         resolved(i) = resolve(scene)
         choices(i) = scene%spectrum
         call solve_motions([resolved(i)%problem], [start_of(resolved(i)%problem)], &
                            request_t(accuracy=1.0e-6_dp, periods=periods(i)), none, ended)
         starts(i) = ended(1)%motion_state_t
      end do
      together = starts
      call follow_behind(resolved, choices, window, samples_per_period, together, doubts, error)
      call checks%check(.not. allocated(error), 'no error')
      call checks%check(.not. is_doubted(doubts(1)), 'irregular for good')
      call checks%check(doubts(2)%code == doubt_class_behind .and. .not. any(doubts(2)%counts(1) == &
                        [class_irregular, class_irregular_so_far]), 'settles behind its window')
      do i = 1, 2
         passed = windows_behind(window)
         if (is_doubted(doubts(i))) passed = doubts(i)%counts(2)
         starts(i)%periods = 0
         call solve_motions(resolved(i:i)%problem, starts(i:i), request_t(accuracy=map_accuracy, periods=passed*window, &
                                                                          every_period=.true.), none, ended)
         call checks%check(all(abs(together(i)%numbers - ended(1)%numbers) <= 0.0_dp), 'where the last window behind ends')
         alone = starts(i:i)
         call follow_behind(resolved(i:i), choices(i:i), window, samples_per_period, alone, doubt, error)
         call checks%check(all(abs(together(i)%numbers - alone(1)%numbers) <= 0.0_dp) .and. &
                           doubt(1)%code == doubts(i)%code .and. all(doubt(1)%counts == doubts(i)%counts), 'as if it were alone')
      end do
   end subroutine test_two_motions

end module test_motion_behind
