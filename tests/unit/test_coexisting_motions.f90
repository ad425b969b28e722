!> Tests of what is reported of all motions of an operating point.
module test_coexisting_motions
   use checks, only: check_list_t
   use coexisting_motions, only: coexisting_motions_t, largest_missed_share, loudest_motion, motions_sentence, quietest_motion, &
      motion_summary_t
   use kinds, only: dp
   use motion_start, only: one_by_newmark
   use rattle_class, only: class_idle, class_quiet
   implicit none(type, external)
   private

   public :: run_coexisting_motions_tests

contains

   !> Runs every test of this topic.
   subroutine run_coexisting_motions_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('coexisting_motions')
      call test_missed_share(checks)
      call test_sentences(checks)
      call test_loudest(checks)
   end subroutine run_coexisting_motions_tests

   !> A motion of the share that is reported is met by one of the starts with 95 %.
   subroutine test_missed_share(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      integer :: n

      do n = 1, 60
         call checks%check_close((1.0_dp - largest_missed_share(n))**n, 0.05_dp, 1.0e-12_dp, 'missed share')
      end do
      call checks%check_close(largest_missed_share(29), 0.0981_dp, 1.0e-4_dp, 'missed share: 29 starts, below a tenth')
      call checks%check_close(largest_missed_share(0), 1.0_dp, 0.0_dp, 'missed share: no start, anything')
   end subroutine test_missed_share

   !> Words for one motion, for several, and where starts do not settle.
   subroutine test_sentences(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(coexisting_motions_t) :: reported

      call checks%check(motions_sentence(reported) == '', 'words: nothing is known')
      allocate (reported%motions(1))
      reported%motions(1) = motion_summary_t(class=class_quiet, period=1, starts=1, from_own_start=.true., &
                                       acceleration_rms=7.8_dp)
      reported%starts_solved = 1
      call checks%check(motions_sentence(reported) == 'one start: other motions were not looked for (solver.starts)', &
                        'words: one start')
      reported%one_start_reason = one_by_newmark
      call checks%check(index(motions_sentence(reported), 'one start: the method of the paper') == 1, 'words: why one start')
      reported%starts_solved = 29
      reported%drawn_starts = 26
      call checks%check(motions_sentence(reported) == &
                        'one motion from 29 starts: any other has less than 11 % of the sampled starts (95 %)', &
                        'words: one motion')
      reported%unsettled_starts = 2
      reported%drawn_starts = 24
      call checks%check(motions_sentence(reported) == &
                        'one motion from 29 starts; of 2 starts the motion does not repeat, or not yet; any other has less '// &
                        'than 12 % of the sampled starts (95 %)', 'words: two starts do not settle')
      reported%unsettled_starts = 0
      reported%drawn_starts = 26
      reported%motions(1)%starts = 21
      reported%motions = [reported%motions, motion_summary_t(class=class_idle, period=1, starts=8, acceleration_rms=51.0_dp)]
      call checks%check(motions_sentence(reported) == '2 motions: quiet 7.8 m/s2 (from rest, 21 of 29 starts), idle 51 m/s2 '// &
                        '(8 of 29); any other has less than 11 % of the sampled starts (95 %)' .or. &
                        motions_sentence(reported) == '2 motions: quiet 7.800 m/s2 (from rest, 21 of 29 starts), '// &
                       'idle 51.00 m/s2 (8 of 29); any other has less than 11 % of the sampled starts (95 %)', 'words: two motions')
      reported%start_is_given = .true.
      call checks%check(index(motions_sentence(reported), '(from the given start, 21 of 29 starts)') > 0, 'words: a given start')
   end subroutine test_sentences

   !> The largest and the smallest acceleration rms, whatever the order.
   subroutine test_loudest(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(coexisting_motions_t) :: reported

      call checks%check(loudest_motion(reported) == 0 .and. quietest_motion(reported) == 0, 'loudest: none is known')
      reported%motions = [motion_summary_t(acceleration_rms=2.0_dp), motion_summary_t(acceleration_rms=3.0_dp), &
                      motion_summary_t(acceleration_rms=1.0_dp)]
      call checks%check(loudest_motion(reported) == 2 .and. quietest_motion(reported) == 3, 'loudest and quietest')
   end subroutine test_loudest

end module test_coexisting_motions
