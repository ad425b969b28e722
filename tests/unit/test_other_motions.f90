!> Tests of the search for other motions: when it ends, and that all its starts are accounted for.
module test_other_motions
   use canonical_scenes, only: loose_gear
   use checks, only: check_list_t
   use clock, only: wall_seconds
   use errors, only: error_t
   use judged_scene, only: judged_scene_t
   use kinds, only: dp
   use other_motions, only: find_other_motions
   use prepared_scene, only: prepare
   use scene_group, only: scene_group_t
   use scene_solution, only: solve_in_memory
   use scene_types, only: method_taylor, scene_t, until_steady
   implicit none(type, external)
   private

   public :: run_other_motions_tests

contains

   !> Runs every test of this topic.
   subroutine run_other_motions_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('other_motions')
      call test_time_limit(checks)
      call test_counts(checks)
      call test_long_window(checks)
   end subroutine run_other_motions_tests

   !> After its time no start is begun, and none counts.
   subroutine test_time_limit(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(judged_scene_t) :: judged(1)
      type(scene_group_t) :: space
      type(error_t), allocatable :: error
      type(scene_t) :: scene

      scene = scene_of_starts(7)
      call solve_in_memory(scene, judged(1), error)
      call find_other_motions([prepare(scene)], .true., space, judged, error, wall_seconds() - 1.0_dp)
      call checks%check(.not. allocated(error), 'time limit: ends')
      call checks%check(judged(1)%coexisting%starts_solved == 1 .and. judged(1)%coexisting%extra_periods == 0, &
                        'time limit: its own start alone')
      call checks%check(sum(judged(1)%coexisting%motions%starts) == 1, 'time limit: one start of one motion')
   end subroutine test_time_limit

   !> Every start has a motion or is unsettled, and more starts lose no motion.
   subroutine test_counts(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(judged_scene_t) :: judged(1)
      type(scene_group_t) :: space
      type(error_t), allocatable :: error
      type(scene_t) :: scene
      integer, parameter :: counts(4) = [2, 3, 4, 13]
      integer :: i, motions

      motions = 1
      do i = 1, size(counts)
         scene = scene_of_starts(counts(i))
         call solve_in_memory(scene, judged(1), error)
         call find_other_motions([prepare(scene)], .true., space, judged, error)
         associate (coexisting => judged(1)%coexisting)
            call checks%check(coexisting%starts_solved == counts(i), 'counts: all starts')
            call checks%check(sum(coexisting%motions%starts) + coexisting%unsettled_starts == counts(i), 'counts: each start')
            call checks%check(coexisting%drawn_starts == max(0, counts(i) - 3), 'counts: drawn starts')
            call checks%check(size(coexisting%motions) >= motions, 'counts: no motion is lost')
            call checks%check(count(coexisting%motions%from_own_start) == 1 .and. coexisting%motions(1)%from_own_start, &
                              'counts: one own motion, the first')
            motions = size(coexisting%motions)
         end associate
      end do
   end subroutine test_counts

   !> Starts settle as well where the window has more periods than they are followed.
   subroutine test_long_window(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(judged_scene_t) :: judged(1)
      type(scene_group_t) :: space
      type(error_t), allocatable :: error
      type(scene_t) :: scene

      scene = scene_of_starts(5)
      scene%solver%periods = 400
      scene%spectrum%periods = 150
      call solve_in_memory(scene, judged(1), error)
      ! No start comes to a motion that stands elsewhere: each has to repeat by itself.
      judged(1)%settled(1)%states = 2.0_dp*judged(1)%settled(1)%states
      call find_other_motions([prepare(scene)], .true., space, judged, error)
      call checks%check(judged(1)%coexisting%unsettled_starts == 0, 'long window: all starts settle')
      call checks%check(sum(judged(1)%coexisting%motions%starts) == 5, 'long window: each start has a motion')
   end subroutine test_long_window

   !> A gear that settles, with as many starts.
   type(scene_t) function scene_of_starts(starts) result(scene)
      integer, intent(in) :: starts

      scene = loose_gear()
      scene%solver%method = method_taylor
      scene%solver%until = until_steady
      scene%solver%kept_per_period = 512
      scene%solver%accuracy = 1.0e-8_dp
      scene%solver%periods = 60
      scene%solver%starts = starts
      scene%spectrum%periods = 4
      scene%output%series = .false.
      scene%resolved_input = ''
   end function scene_of_starts

end module test_other_motions
