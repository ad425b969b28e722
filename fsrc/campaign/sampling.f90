!> The scenes of a campaign as numbers: which values the varied keys take in scene i. Any scene is computed
!> on its own, and a scene has the same values whoever asks, alone or in a chunk.
module sampling
   use campaign_axis, only: axis_count, campaign_axis_t, check_axis, grid_value, spread_value
   use checksum, only: checksum_of
   use kinds, only: dp, int64
   use sobol_sequence, only: largest_dimension, largest_sobol_size, new_sobol_sequence, sobol_point, &
      sobol_sequence_t
   use text, only: integer_text
   implicit none(type, external)
   private

   !> The codes of samples count the words of &campaign sample in the order of the key table.
   integer, parameter, public :: method_grid = 1, method_sobol = 2, method_table = 3
   !> Most axes of a full grid
   integer, parameter :: most_grid_axes = 6

   !> All scenes of a campaign.
   type, public :: sample_plan_t
      integer :: method = method_grid
      !> Number of scenes
      integer(int64) :: size = 0_int64
      !> Those whose values are known, the first ones: all, but where the reading of a table had to stop
      integer(int64) :: known = 0_int64
      !> Line of the first scene of a table in its file
      integer :: first_line = 2
      !> Varied keys by their position in the key table, in the order of the values
      integer, allocatable :: positions(:)
      type(campaign_axis_t), allocatable :: axes(:)
      !> Whether all scenes of a sample or a table are solved for each value of the first axis, the slowest
      logical :: is_crossed = .false.
      !> Checksum of the values of a table; 0: there is none
      integer(int64) :: table_checksum = 0_int64
      type(sobol_sequence_t), private :: sequence
      !> (key, scene)
      real(dp), allocatable, private :: table(:, :)
   end type sample_plan_t

   public :: plan_grid, plan_sobol, plan_table, cross_plan, scene_values, chunk_values, largest_value

contains

   !> Full grid. The last axis moves fastest: with counts n_1, n_2, ... the results of all scenes in their
   !> order are an array of n_1 x n_2 x ... in the order of C and numpy.
   pure subroutine plan_grid(axes, plan, bad_axis, message)
      !> Axes, 1 to most_grid_axes
      type(campaign_axis_t), intent(in) :: axes(:)
      !> The plan; of use only if the message is empty
      type(sample_plan_t), intent(out) :: plan
      !> Axis that the message is about; 0: none alone
      integer, intent(out) :: bad_axis
      !> What is wrong and what is allowed; empty if nothing is
      character(:), allocatable, intent(out) :: message
      integer(int64) :: count
      integer :: i

      plan%method = method_grid
      call take_axes(axes, .true., plan, bad_axis, message)
      if (len(message) > 0) return
      if (size(axes) > most_grid_axes) then
         message = 'a full grid varies '//integer_text(most_grid_axes)//' keys at most, here are '// &
            integer_text(size(axes))
         return
      end if
      plan%size = 1_int64
      do i = 1, size(axes)
         count = int(axis_count(axes(i)), int64)
         if (plan%size > huge(plan%size)/count) then
            message = 'the grid has more than '//integer_text(huge(plan%size))//' scenes'
            return
         end if
         plan%size = plan%size*count
      end do
      plan%known = plan%size
   end subroutine plan_grid

   !> Points of Sobol's sequence.
   pure subroutine plan_sobol(axes, scene_count, seed, plan, bad_axis, message)
      !> Axes, 1 to largest_dimension
      type(campaign_axis_t), intent(in) :: axes(:)
      !> Number of scenes
      integer(int64), intent(in) :: scene_count
      !> 0: the plain sequence; any other number: shifted
      integer(int64), intent(in) :: seed
      !> The plan; of use only if the message is empty
      type(sample_plan_t), intent(out) :: plan
      !> Axis that the message is about; 0: none alone
      integer, intent(out) :: bad_axis
      !> What is wrong and what is allowed; empty if nothing is
      character(:), allocatable, intent(out) :: message

      plan%method = method_sobol
      call take_axes(axes, .false., plan, bad_axis, message)
      if (len(message) == 0) call take_size(scene_count, largest_sobol_size, plan, message)
      if (len(message) > 0) return
      if (size(axes) > largest_dimension) then
         message = 'sobol varies '//integer_text(largest_dimension)//' keys at most, here are '// &
            integer_text(size(axes))
         return
      end if
      plan%sequence = new_sobol_sequence(size(axes), seed)
   end subroutine plan_sobol

   !> Scenes as they are listed.
   pure subroutine plan_table(positions, values, plan)
      !> Varied keys by their position in the key table
      integer, intent(in) :: positions(:)
      !> (key, scene); moved into the plan
      real(dp), allocatable, intent(inout) :: values(:, :)
      !> The plan
      type(sample_plan_t), intent(out) :: plan

      plan%method = method_table
      plan%positions = positions
      allocate (plan%axes(0))
      plan%size = size(values, 2, kind=int64)
      plan%known = plan%size
      plan%table_checksum = checksum_of(values)
      call move_alloc(values, plan%table)
   end subroutine plan_table

   !> Solve all scenes of a sample or a table for each value of one more axis, the slowest and the first.
   pure subroutine cross_plan(axis, plan)
      !> Checked axis
      type(campaign_axis_t), intent(in) :: axis
      type(sample_plan_t), intent(inout) :: plan

      plan%is_crossed = .true.
      plan%axes = [axis, plan%axes]
      plan%positions = [axis%position, plan%positions]
      if (plan%known == plan%size) plan%known = plan%known*int(axis_count(axis), int64)
      plan%size = plan%size*int(axis_count(axis), int64)
   end subroutine cross_plan

   !> Check the axes, each alone and against each other, and keep them.
   pure subroutine take_axes(axes, on_grid, plan, bad_axis, message)
      type(campaign_axis_t), intent(in) :: axes(:)
      logical, intent(in) :: on_grid
      type(sample_plan_t), intent(inout) :: plan
      integer, intent(out) :: bad_axis
      character(:), allocatable, intent(out) :: message
      integer :: i

      bad_axis = 0
      message = ''
      if (size(axes) == 0) message = 'no key is varied'
      do i = 1, size(axes)
         call check_axis(axes(i), on_grid, message)
         if (len(message) == 0 .and. any(axes(:i - 1)%position == axes(i)%position)) &
            message = 'this key is varied already'
         if (len(message) == 0) cycle
         bad_axis = i
         return
      end do
      plan%axes = axes
      plan%positions = axes%position
   end subroutine take_axes

   pure subroutine take_size(scene_count, largest, plan, message)
      integer(int64), intent(in) :: scene_count
      integer(int64), intent(in) :: largest
      type(sample_plan_t), intent(inout) :: plan
      character(:), allocatable, intent(inout) :: message

      plan%size = scene_count
      plan%known = scene_count
      if (scene_count < 1_int64 .or. scene_count > largest) &
         message = 'the size must be from 1 to '//integer_text(largest)//', it is '//integer_text(scene_count)
   end subroutine take_size

   !> Values of the varied keys in one scene.
   pure subroutine scene_values(plan, scene, values)
      !> Sound plan
      type(sample_plan_t), intent(in) :: plan
      !> From 1 to plan%size
      integer(int64), intent(in) :: scene
      !> One for every varied key
      real(dp), intent(out) :: values(:)
      integer(int64) :: rest, next, count
      integer :: i, first

      rest = scene - 1_int64
      first = 1
      if (plan%is_crossed) then
         count = plan%size/int(axis_count(plan%axes(1)), int64)
         values(1) = grid_value(plan%axes(1), int(rest/count))
         rest = modulo(rest, count)
         first = 2
      end if
      select case (plan%method)
      case (method_table)
         values(first:) = plan%table(:, rest + 1_int64)
      case (method_grid)
         do i = size(plan%axes), 1, -1
            count = int(axis_count(plan%axes(i)), int64)
            next = rest/count
            values(i) = grid_value(plan%axes(i), int(rest - next*count))
            rest = next
         end do
      case default
         call sobol_point(plan%sequence, rest, values(first:))
         ! The loop over the keys is the inner one: a loop over scenes could be turned into vectors, and
         ! the vector library rounds powers differently from the scalar one that does what is left over.
         do i = first, size(plan%axes)
            values(i) = spread_value(plan%axes(i), values(i))
         end do
      end select
   end subroutine scene_values

   !> Largest value that a key takes in the scenes of a plan, or `base` where it is not varied.
   pure real(dp) function largest_value(plan, position, base)
      !> Sound plan
      type(sample_plan_t), intent(in) :: plan
      !> Position of the key in the key table
      integer, intent(in) :: position
      !> Its value in the base scene
      real(dp), intent(in) :: base
      integer :: i

      largest_value = base
      i = findloc(plan%positions, position, dim=1)
      if (i == 0) return
      if (plan%method == method_table .and. .not. (plan%is_crossed .and. i == 1)) then
         if (plan%is_crossed) i = i - 1
         largest_value = maxval(plan%table(i, :min(plan%known, size(plan%table, 2, kind=int64))))
      else if (allocated(plan%axes(i)%values)) then
         largest_value = maxval(plan%axes(i)%values)
      else
         largest_value = plan%axes(i)%last
      end if
   end function largest_value

   !> Values of the varied keys in scenes that follow each other.
   pure subroutine chunk_values(plan, first, values)
      !> Sound plan
      type(sample_plan_t), intent(in) :: plan
      !> First scene
      integer(int64), intent(in) :: first
      !> (key, scene - first + 1)
      real(dp), contiguous, intent(out) :: values(:, :)
      integer(int64) :: i

      do i = 1_int64, size(values, 2, kind=int64)
         call scene_values(plan, first + i - 1_int64, values(:, i))
      end do
   end subroutine chunk_values

end module sampling
