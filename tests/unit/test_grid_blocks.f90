!> Blocks of a grid and the neighbours within them.
module test_grid_blocks
   use campaign_axis, only: campaign_axis_t
   use checks, only: check_list_t
   use grid_blocks, only: block_scenes, neighbours_of
   use kinds, only: dp, int64
   use sampling, only: plan_grid, plan_table, sample_plan_t
   implicit none(type, external)
   private

   public :: run_grid_blocks_tests

contains

   !> Runs every test of this topic.
   subroutine run_grid_blocks_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks
      type(sample_plan_t) :: plan
      logical, parameter :: all_axes(3) = .true., no_pairs(3) = [.false., .true., .true.]

      call checks%start('grid_blocks')
      plan = grid([2, 65, 29])
      call checks%check(block_scenes(plan) == 116, 'whole lines of the fastest axis')
      call checks%check(all(neighbours_of(plan, 1_int64, all_axes) == [30_int64, 2_int64]), 'a corner')
      call checks%check(all(neighbours_of(plan, 31_int64, all_axes) == [2_int64, 60_int64, 30_int64, 32_int64]), &
                        'the slow axis before the fast one')
      call checks%check(all(neighbours_of(plan, 116_int64, all_axes) == [87_int64, 115_int64]), &
                        'nothing beyond the end of a line, nor of a block')
      call checks%check(all(neighbours_of(plan, 262_int64, all_axes) == [233_int64, 291_int64, 263_int64]), 'another block')
      plan = grid([4, 3, 5])
      call checks%check(block_scenes(plan) == 30, 'fewer lines of a small grid')
      call checks%check(any(neighbours_of(plan, 16_int64, all_axes) == 1_int64), 'along the slowest axis')
      call checks%check(.not. any(neighbours_of(plan, 16_int64, no_pairs) == 1_int64), 'gear pairs are no neighbours')
      call checks%check(all(neighbours_of(plan, 16_int64, no_pairs) == [21_int64, 17_int64]), 'within a gear pair')
      call checks%check(block_scenes(grid([2, 2, 1000])) == 125, 'a part of a long line')
      call checks%check(block_scenes(listed()) == 1, 'scenes of a table have no neighbours')
   end subroutine run_grid_blocks_tests

   !> A grid with so many values of each axis.
   type(sample_plan_t) function grid(counts) result(plan)
      integer, intent(in) :: counts(3)
      type(campaign_axis_t) :: axes(3)
      character(:), allocatable :: message
      integer :: bad_axis, i

      do i = 1, 3
         axes(i) = campaign_axis_t(position=i, first=1.0_dp, last=2.0_dp, count=counts(i))
      end do
      call plan_grid(axes, plan, bad_axis, message)
   end function grid

   !> Three scenes of a table.
   type(sample_plan_t) function listed() result(plan)
      real(dp), allocatable :: values(:, :)

      allocate (values(1, 3), source=1.0_dp)
      call plan_table([1], values, plan)
   end function listed

end module test_grid_blocks
