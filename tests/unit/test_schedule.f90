!> Tests of the schedule: every chunk once, dear ones first, stable order of costs.
module test_schedule
   use checks, only: check_list_t
   use kinds, only: dp, int64
   use schedule, only: chunk_rows_for, chunk_schedule_t, cost_order, new_chunk_schedule
   implicit none(type, external)
   private

   public :: run_schedule_tests

contains

   !> Runs every test of this topic.
   subroutine run_schedule_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks

      call checks%start('schedule')
      call test_take(checks)
      call test_threads(checks)
      call test_cost_order(checks)
      call test_chunk_rows(checks)
   end subroutine run_schedule_tests

   subroutine test_take(checks)
      type(check_list_t), intent(inout) :: checks
      logical, parameter :: done(6) = [.false., .true., .false., .false., .true., .false.]
      real(dp), parameter :: costs(6) = [1.0_dp, 9.0_dp, 3.0_dp, 2.0_dp, 8.0_dp, 3.0_dp]
      type(chunk_schedule_t) :: plan
      integer(int64) :: taken(6)
      integer :: i

      plan = new_chunk_schedule(done)
      call checks%check(plan%count() == 4_int64, 'count of chunks')
      call checks%check(plan%left() == 4_int64, 'count of what is left')
      do i = 1, 6
         call plan%take(taken(i))
      end do
      call checks%check(all(taken == [1_int64, 3_int64, 4_int64, 6_int64, 0_int64, 0_int64]), &
                        'those not done, in order')
      call checks%check(plan%left() == 0_int64, 'nothing is left')
      plan = new_chunk_schedule(done, costs)
      do i = 1, 6
         call plan%take(taken(i))
      end do
      call checks%check(all(taken == [3_int64, 6_int64, 4_int64, 1_int64, 0_int64, 0_int64]), &
                        'dear ones first')
      plan = new_chunk_schedule([.true., .true.])
      call plan%take(taken(1))
      call checks%check(taken(1) == 0_int64, 'all done')
   end subroutine test_take

   !> Threads never get the same chunk, and all chunks are taken.
   subroutine test_threads(checks)
      type(check_list_t), intent(inout) :: checks
      integer, parameter :: chunks = 5000
      type(chunk_schedule_t) :: plan
      logical :: done(chunks)
      integer :: times(chunks)
      integer(int64) :: chunk

      done = .false.
      times = 0
      plan = new_chunk_schedule(done)
      !$omp parallel num_threads(4) default(none) shared(plan, times) private(chunk)
      do
         call plan%take(chunk)
         if (chunk == 0_int64) exit
         !$omp atomic
         times(chunk) = times(chunk) + 1
      end do
      !$omp end parallel
      call checks%check(all(times == 1), 'every chunk once')
   end subroutine test_threads

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

   subroutine test_chunk_rows(checks)
      type(check_list_t), intent(inout) :: checks

      call checks%check(chunk_rows_for(1_int64) == 256, 'one scene')
      ! 512 chunks of 256, 512 and so on, and their next larger campaign that 512 chunks cannot hold.
      call checks%check(chunk_rows_for(257_int64*512_int64 - 1_int64) == 256, 'the most scenes for 256')
      call checks%check(chunk_rows_for(257_int64*512_int64) == 512, 'the fewest scenes for 512')
      call checks%check(chunk_rows_for(4097_int64*512_int64 - 1_int64) == 4096, 'the most scenes for 4096')
      call checks%check(chunk_rows_for(4097_int64*512_int64) == 8192, 'the fewest scenes for 8192')
      call checks%check(chunk_rows_for(1000000_int64) == 2048, 'a million scenes')
      call checks%check(chunk_rows_for(huge(1_int64)) == 8192, 'beyond any size')
   end subroutine test_chunk_rows

end module test_schedule
