!> Tests of the schedule: stable order of costs, size of chunks, and what threads take at a time.
module test_schedule
   use checks, only: check_list_t
   use kinds, only: dp, int64
   use schedule, only: chunk_rows_for, cost_order, pace_t
   implicit none(type, external)
   private

   public :: run_schedule_tests

contains

   !> Runs every test of this topic.
   subroutine run_schedule_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks

      call checks%start('schedule')
      call test_cost_order(checks)
      call test_chunk_rows(checks)
      call test_work_at_a_time(checks)
      call test_shares(checks)
   end subroutine run_schedule_tests

   subroutine test_cost_order(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp) :: costs(1000)
      integer :: order(1000), i, n
      logical :: sorted

      do n = 0, 1000, 111
         costs(:n) = [(real(modulo(modulo(i*i, 1009)*79, 101), dp), i=1, n)]
         call cost_order(costs(:n), order(:n))
         sorted = all([(count(order(:n) == i) == 1, i=1, n)])
         do i = 2, n
            sorted = sorted .and. (costs(order(i - 1)) < costs(order(i)) .or. &
                                   (costs(order(i - 1)) <= costs(order(i)) .and. order(i - 1) < order(i)))
         end do
         call checks%check(sorted, 'rising costs, equal ones in their old order')
      end do
   end subroutine test_cost_order

   !> As few scenes as 16384 chunks allow, whatever the scenes take: 1, 2, 4 and so on up to 8192.
   subroutine test_chunk_rows(checks)
      type(check_list_t), intent(inout) :: checks

      call checks%check(chunk_rows_for(0_int64, 1) == 1, 'a part without scenes')
      call checks%check(chunk_rows_for(1_int64, 1) == 1, 'one scene')
      call checks%check(chunk_rows_for(16384_int64, 1) == 1, 'the most scenes for 1')
      call checks%check(chunk_rows_for(16385_int64, 1) == 2, 'the fewest scenes for 2')
      call checks%check(chunk_rows_for(4096_int64*16384_int64, 1) == 4096, 'the most scenes for 4096')
      call checks%check(chunk_rows_for(4096_int64*16384_int64 + 1_int64, 1) == 8192, 'the fewest scenes for 8192')
      call checks%check(chunk_rows_for(1000000_int64, 1) == 64, 'a million scenes')
      call checks%check(chunk_rows_for(huge(1_int64), 1) == 8192, 'beyond any size')
      call checks%check(chunk_rows_for(145_int64, 116) == 116, 'a block of a grid')
      call checks%check(chunk_rows_for(116_int64*16384_int64 + 1_int64, 116) == 232, 'two blocks of a grid')
   end subroutine test_chunk_rows

   !> No more than 10 s of work are under way at once, as long as scenes cost no more than 2.5 times those before them, and a scene
   !> alone no more than that; and scenes of one cost are not taken in smaller pieces than needed.
   subroutine test_work_at_a_time(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: most_work = 10.0_dp, costs(5) = [1.0e-5_dp, 4.0e-3_dp, 0.3_dp, 3.0_dp, 9.0_dp]
      type(pace_t) :: pace
      integer(int64) :: left, taken
      integer :: i, pieces
      real(dp) :: cost, largest

      call checks%check(pace%next_scenes() == 1, 'one scene, as long as nothing is known of any')
      do i = 1, size(costs)
         pace = pace_t()
         left = 100000_int64
         pieces = 0
         largest = 0.0_dp
         do while (left > 0_int64 .and. pieces < 1000)
            taken = min(left, pace%next_share(left, 1))
            pieces = pieces + 1
            left = left - taken
            largest = max(largest, real(taken, dp)*costs(i))
            call pace%note(int(taken), real(taken, dp)*costs(i))
         end do
         call checks%check(largest <= max(4.0_dp, costs(i))*(1.0_dp + epsilon(1.0_dp)), 'scenes of one cost: 4 s, or one scene')
         call checks%check(pieces < 1000 .eqv. left == 0_int64, 'pieces come to an end')
         if (costs(i) < 0.1_dp) call checks%check(pieces < 200, 'scenes that cost little are not taken one by one')
      end do
      pace = pace_t()
      cost = 1.0e-4_dp
      largest = 0.0_dp
      do while (cost < 4.0_dp)
         taken = pace%next_share(1000000_int64, 4)
         largest = max(largest, real(taken, dp)*cost)
         call pace%note(int(taken), real(taken, dp)*cost)
         cost = 2.5_dp*cost
      end do
      call checks%check(largest <= most_work .and. largest > 1.0_dp, 'scenes that cost more and more: 10 s at most')
      call checks%check(pace%next_share(1000000_int64, 4) == 1_int64, 'slow scenes one by one')
   end subroutine test_work_at_a_time

   !> Threads take less and less towards the end, but not so few that lanes stay empty.
   subroutine test_shares(checks)
      type(check_list_t), intent(inout) :: checks
      type(pace_t) :: pace

      call pace%note(2048, 0.1_dp)
      call checks%check(pace%next_share(1000000_int64, 2) == 2048_int64, 'no more than fit together')
      call checks%check(pace%next_share(4000_int64, 2) == 1001_int64, 'a quarter of what is left for two threads')
      call checks%check(pace%next_share(4000_int64, 20) == 101_int64, 'a fortieth for twenty')
      call checks%check(pace%next_share(100_int64, 20) == 32_int64, 'but 32')
      call pace%note(1, 1.0_dp)
      call checks%check(pace%next_share(100_int64, 20) == 4_int64, 'and no more than time allows')
   end subroutine test_shares

end module test_schedule
