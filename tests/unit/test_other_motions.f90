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
      call test_new_motion(checks)
   end subroutine run_other_motions_tests

   !> After its time no start is begun, and none counts.
   subroutine test_time_limit(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(judged_scene_t) :: judged(1)

      call search(scene_of_starts(7), .true., judged, checks, wall_seconds() - 1.0_dp)
      call checks%check(judged(1)%coexisting%starts_solved == 1 .and. judged(1)%coexisting%extra_periods == 0, &
                        'time limit: its own start alone')
      call checks%check(sum(judged(1)%coexisting%motions%starts) == 1, 'time limit: one start of one motion')
   end subroutine test_time_limit

   !> Every start has a motion or is unsettled, and more starts lose no motion.
   subroutine test_counts(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(judged_scene_t) :: judged(1)
      integer, parameter :: counts(4) = [2, 3, 4, 13]
      integer :: i, motions

      motions = 1
      do i = 1, size(counts)
         call search(scene_of_starts(counts(i)), .true., judged, checks)
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

   !> A motion that is not known is found once, however many starts lead to it.
   subroutine test_new_motion(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(judged_scene_t) :: judged(1)

      call search(scene_of_starts(5), .false., judged, checks)
      associate (motions => judged(1)%coexisting%motions)
         call checks%check(size(motions) == 2 .and. size(judged(1)%settled) == 2, 'new motion: once')
         call checks%check(all(motions%starts == [1, 4]), 'new motion: by all other starts')
         call checks%check(judged(1)%coexisting%unsettled_starts == 0, 'new motion: repeats')
         ! It is the scene's own one, to the accuracy of starts times the largest growth of an error in an impact.
         call checks%check_close(motions(2)%acceleration_rms, motions(1)%acceleration_rms, &
                                 1.0e-4_dp*motions(1)%acceleration_rms, 'new motion: shakes as the scene does')
         call checks%check(motions(2)%class == motions(1)%class .and. motions(2)%verdict == motions(1)%verdict, &
                           'new motion: class and verdict')
      end associate
   end subroutine test_new_motion

   !> Solve a scene and look for its other motions.
   subroutine search(scene, knows_own, judged, checks, ends_at)
      type(scene_t), intent(in) :: scene
      logical, intent(in) :: knows_own                   !> Whether its own motion is where it is: else no start comes to it
      type(judged_scene_t), intent(out) :: judged(1)     !> With all motions
      type(check_list_t), intent(inout) :: checks        !> Collects the results
      real(dp), intent(in), optional :: ends_at          !> As of find_other_motions
      type(scene_group_t) :: space
      type(error_t), allocatable :: error

      call solve_in_memory(scene, judged(1), error)
      if (.not. knows_own) judged(1)%settled(1)%states = 2.0_dp*judged(1)%settled(1)%states
      call find_other_motions([prepare(scene)], space, judged, error, ends_at)
      call checks%check(.not. allocated(error), 'search: ends without an error')
   end subroutine search

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
