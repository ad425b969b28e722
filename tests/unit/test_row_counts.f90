!> Tests of what is counted of the rows of a campaign.
module test_row_counts
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use checks, only: check_list_t
   use kinds, only: dp, int64
   use row_counts, only: count_rows
   implicit none(type, external)
   private

   public :: run_row_counts_tests

contains

   !> Runs every test of this topic.
   subroutine run_row_counts_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks
      character(20), parameter :: names(8) = [character(20) :: 'scene', 'status', 'model_limit', 'sampling_sufficient', &
                                              'verified', 'rattle_class', 'motions', 'closure_range']
      real(dp) :: rows(8, 5), unknown

      unknown = ieee_value(1.0_dp, ieee_quiet_nan)
      ! Scene, status (0 complete, 2 not converged), beyond the model, enough samples, verified, class, motions, closure.
      rows(:, 1) = [0.0_dp, 0.0_dp, 0.0_dp, 1.0_dp, 1.0_dp, 4.0_dp, 1.0_dp, 1.0_dp]
      rows(:, 2) = [1.0_dp, 0.0_dp, 3.0_dp, 0.0_dp, 0.0_dp, 6.0_dp, 2.0_dp, 0.0_dp]
      rows(:, 3) = [2.0_dp, 0.0_dp, 1.0_dp, 1.0_dp, 0.0_dp, 5.0_dp, 3.0_dp, 1.0_dp]
      rows(:, 4) = [3.0_dp, 2.0_dp, unknown, unknown, unknown, unknown, unknown, unknown]
      rows(:, 5) = [4.0_dp, 0.0_dp, 2.0_dp, 1.0_dp, unknown, 4.0_dp, 0.0_dp, unknown]

      call checks%start('row_counts')
      ! Done, failed, beyond the model, too few samples, tested, not verified, irregular, irregular so far, followed, several, extrapolated.
      call checks%check(all(count_rows(names, 2, rows) == int([5, 1, 3, 1, 3, 2, 2, 1, 3, 2, 2], int64)), 'each kind')
      call checks%check(all(count_rows([character(1) ::], 2, rows) == int([5, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0], int64)), &
                        'columns that are not recorded')
   end subroutine run_row_counts_tests

end module test_row_counts
