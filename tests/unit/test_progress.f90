!> Tests of what is reported while a run goes on.
module test_progress
   use checks, only: check_list_t
   use kinds, only: dp
   use progress, only: progress_words
   implicit none(type, external)
   private

   public :: run_progress_tests

contains

   !> Runs every test of this topic.
   subroutine run_progress_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('progress')
      call checks%check(progress_words(20, 100, 12.0_dp) == '20 of 100 after 12.0 s, 48 s left', &
                        'a fifth took twelve seconds')
      call checks%check(progress_words(7, 7, 3.5_dp) == '7 of 7 after 3.50 s, 0 s left', 'all of it')
   end subroutine run_progress_tests

end module test_progress
