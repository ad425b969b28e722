!> Tests of the schedule: stable order of costs, size of chunks.
module test_schedule
   use checks, only: check_list_t
   use kinds, only: dp, int64
   use schedule, only: chunk_rows_for, cost_order
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
      call test_long_scenes(checks)
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

   subroutine test_chunk_rows(checks)
      type(check_list_t), intent(inout) :: checks

      call checks%check(rows_of(1_int64) == 256, 'one scene')
      ! 512 chunks of 256, 512 and so on, and their next larger campaign that 512 chunks cannot hold.
      call checks%check(rows_of(257_int64*512_int64 - 1_int64) == 256, 'the most scenes for 256')
      call checks%check(rows_of(257_int64*512_int64) == 512, 'the fewest scenes for 512')
      call checks%check(rows_of(4097_int64*512_int64 - 1_int64) == 4096, 'the most scenes for 4096')
      call checks%check(rows_of(4097_int64*512_int64) == 8192, 'the fewest scenes for 8192')
      call checks%check(rows_of(1000000_int64) == 2048, 'a million scenes')
      call checks%check(rows_of(huge(1_int64)) == 8192, 'beyond any size')

   contains

      !> Scenes in a chunk if each is so short that its periods do not matter.
      pure integer function rows_of(scenes)
         integer(int64), intent(in) :: scenes

         rows_of = chunk_rows_for(scenes, 8.0_dp, .false.)
      end function rows_of

   end subroutine test_chunk_rows

   !> Long scenes make small chunks, 262144 periods at most, 65536 with certificates, but never fewer than 8 scenes.
   subroutine test_long_scenes(checks)
      type(check_list_t), intent(inout) :: checks

      call checks%check(chunk_rows_for(1_int64, 1024.0_dp, .false.) == 256, '256 scenes of 1024 periods')
      call checks%check(chunk_rows_for(1_int64, 1025.0_dp, .false.) == 128, '128 scenes of 1025 periods')
      call checks%check(chunk_rows_for(huge(1_int64), 400.0_dp, .false.) == 512, '512 scenes of 400 periods')
      call checks%check(chunk_rows_for(1_int64, 1.0e9_dp, .false.) == 8, '8 scenes at least')
      call checks%check(chunk_rows_for(1_int64, 256.0_dp, .true.) == 256, '256 certified scenes of 256 periods')
      call checks%check(chunk_rows_for(1_int64, 257.0_dp, .true.) == 128, '128 certified scenes of 257 periods')
   end subroutine test_long_scenes

end module test_schedule
