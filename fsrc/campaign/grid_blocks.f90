!> Blocks of a grid: scenes that follow each other and hand their motions to each other. A block depends on the plan alone, never
!> on threads, ranks, parts or what was solved before, so that the bytes of a result do not.
module grid_blocks
   use campaign_axis, only: axis_count
   use kinds, only: int64
   use sampling, only: method_grid, sample_plan_t
   implicit none(type, external)
   private

   !> Fewest and most scenes of a block, and how many blocks a grid has in between: threads and jobs share blocks, and a kill loses
   !> what was done of one.
   integer(int64), parameter :: fewest_scenes = 32_int64, most_scenes = 128_int64, usual_blocks = 32_int64

   public :: block_scenes, neighbours_of

contains

   !> Scenes of a block, as many whole lines along the fastest axis as these may be, or a part of one. The last block of a plan may
   !> be shorter.
   pure integer function block_scenes(plan)
      type(sample_plan_t), intent(in) :: plan
      integer :: line

      block_scenes = 1
      if (plan%method /= method_grid) return
      block_scenes = int(min(most_scenes, max(fewest_scenes, plan%size/usual_blocks)))
      line = axis_count(plan%axes(size(plan%axes)))
      if (line <= block_scenes) block_scenes = line*(block_scenes/line)
   end function block_scenes

   !> Neighbours of a scene on its grid, one step away along one axis, that stand in its block: the slowest axis first, the smaller
   !> number first. An axis of gear pairs has none.
   pure function neighbours_of(plan, scene, is_ordered) result(neighbours)
      type(sample_plan_t), intent(in) :: plan
      !> Number of the scene, from 1
      integer(int64), intent(in) :: scene
      !> Whether neighbouring values of an axis are alike, axis by axis
      logical, intent(in) :: is_ordered(:)
      integer(int64), allocatable :: neighbours(:)
      integer(int64) :: strides(size(plan%axes)), block, other
      integer :: i, side, place

      allocate (neighbours(0))
      block = int(block_scenes(plan), int64)
      strides(size(strides)) = 1_int64
      do i = size(strides) - 1, 1, -1
         strides(i) = strides(i + 1)*int(axis_count(plan%axes(i + 1)), int64)
      end do
      do i = 1, size(strides)
         if (.not. is_ordered(i)) cycle
         place = int(modulo((scene - 1_int64)/strides(i), int(axis_count(plan%axes(i)), int64)))
         do side = -1, 1, 2
            if (place + side < 0 .or. place + side >= axis_count(plan%axes(i))) cycle
            other = scene + int(side, int64)*strides(i)
            if ((other - 1_int64)/block == (scene - 1_int64)/block) neighbours = [neighbours, other]
         end do
      end do
   end function neighbours_of

end module grid_blocks
