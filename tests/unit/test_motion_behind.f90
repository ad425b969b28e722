!> Tests of motions followed behind their windows: one that stays irregular, one that settles, and both side by side.
module test_motion_behind
   use canonical_scenes, only: canonical_scene
   use checks, only: check_list_t
   use doubt, only: doubt_class, doubt_class_behind, doubt_t, is_doubted
   use engine, only: ending_t, motion_state_t, request_t, start_of
   use errors, only: error_t
   use kinds, only: dp
   use many_motions, only: solve_motions
   use rattle_class, only: class_irregular, class_irregular_so_far
   use prepared_scene, only: prepare, prepared_scene_t, with_accuracy
   use scene_types, only: law_iso_viscous, scene_t
   use verification, only: windows_behind
   use verify_group, only: follow_behind, other_accuracy
   implicit none(type, external)
   private

   integer, parameter :: samples_per_period = 64, window = 8
   real(dp), parameter :: accuracy = 1.0e-6_dp

   public :: run_motion_behind_tests

contains

   !> Runs every test of this topic.
   subroutine run_motion_behind_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('motion_behind')
      call test_two_motions(checks)
      call test_other_accuracy(checks)
   end subroutine run_motion_behind_tests

   !> A motion that stays irregular is followed through its window and all windows behind, as if it never stopped. One that settles
   !> is left where it is seen to, and tells after how many windows and to what. Neither changes a bit of the other.
   subroutine test_two_motions(checks)
      class(check_list_t), intent(inout) :: checks
      !> Of the scenes: speed [m/s] and amplitude [N]
      real(dp), parameter :: speeds(2) = [12.0_dp, 1.905_dp], amplitudes(2) = [1200.0_dp, 400.0_dp]
      integer, parameter :: none_before = 0, some_before = 52
      type(scene_t) :: scene
      type(prepared_scene_t) :: scenes(2)
      type(motion_state_t) :: together(2), alone(1), start(1)
      type(doubt_t) :: doubts(2), doubt(1)
      type(error_t), allocatable :: error
      integer :: i, windows

      do i = 1, 2
         scene = canonical_scene(law_iso_viscous, samples_per_period)
         scene%kinematics%entrainment_speed = speeds(i)
         scene%excitation%force_amplitude = amplitudes(i)
         scenes(i) = with_accuracy(prepare(scene), accuracy)
         scenes(i)%request%sampled_periods = window
         together(i) = start_of(scenes(i)%resolved%problem)
      end do
      call follow_behind(scenes, none_before, together, doubts, error)
      call checks%check(.not. allocated(error), 'no error')
      call checks%check(.not. is_doubted(doubts(1)), 'irregular for good')
      call checks%check(doubts(2)%code == doubt_class_behind .and. .not. any(doubts(2)%counts(1) == &
                        [class_irregular, class_irregular_so_far]), 'settles behind its window')
      do i = 1, 2
         windows = 1 + windows_behind(window)
         if (is_doubted(doubts(i))) windows = 1 + doubts(i)%counts(2)
         call expect_end(i, windows*window, together(i))
         alone = start_of(scenes(i)%resolved%problem)
         call follow_behind(scenes(i:i), none_before, alone, doubt, error)
         call checks%check(all(abs(together(i)%numbers - alone(1)%numbers) <= 0.0_dp) .and. &
                           doubt(1)%code == doubts(i)%code .and. all(doubt(1)%counts == doubts(i)%counts), 'as if it were alone')
      end do
      alone = start_of(scenes(1)%resolved%problem)
      call follow_behind(scenes(:1), some_before, alone, doubt, error)
      call expect_end(1, some_before + (1 + windows_behind(window))*window, alone(1))
      ! Where it begins later, the one that settles has settled.
      start = start_of(scenes(2)%resolved%problem)
      call follow_behind(scenes(2:), some_before, start, doubt, error)
      call checks%check(doubt(1)%code == doubt_class .and. doubt(1)%counts(1) == doubts(2)%counts(1), 'settled in its window')

   contains

      !> A motion is where a solution of so many periods from its start ends.
      subroutine expect_end(place, periods, state)
         !> Place of its scene
         integer, intent(in) :: place
         integer, intent(in) :: periods
         type(motion_state_t), intent(in) :: state
         type(ending_t) :: ended(1)
         real(dp) :: none(0, 2, 1)

         call solve_motions(scenes(place:place)%resolved%problem, [start_of(scenes(place)%resolved%problem)], &
                            request_t(accuracy=accuracy, periods=periods, every_period=.true.), none, ended)
         call checks%check(all(abs(state%numbers - ended(1)%numbers) <= 0.0_dp), 'where the last window behind ends')
      end subroutine expect_end

   end subroutine test_two_motions

   !> Another solution has another accuracy, whatever that of the first one.
   subroutine test_other_accuracy(checks)
      class(check_list_t), intent(inout) :: checks

      call checks%check_close(other_accuracy(1.0e-8_dp), 1.0e-6_dp, 1.0e-20_dp, 'of most scenes')
      call checks%check_close(other_accuracy(1.0e-12_dp), 1.0e-6_dp, 1.0e-20_dp, 'of exact scenes')
      call checks%check_close(other_accuracy(1.0e-6_dp), 1.0e-8_dp, 1.0e-20_dp, 'of scenes that have that accuracy')
      call checks%check_close(other_accuracy(1.0e-4_dp), 1.0e-8_dp, 1.0e-20_dp, 'of rough scenes')
   end subroutine test_other_accuracy

end module test_motion_behind
