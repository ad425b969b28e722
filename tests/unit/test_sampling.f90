!> Tests of the values that grids, Sobol points and Latin hypercubes give to scenes, and of what they refuse.
module test_sampling
   use campaign_axis, only: campaign_axis_t, scale_linear, scale_logarithmic
   use checks, only: check_list_t, same_bits
   use kinds, only: dp, int64
   use sampling, only: chunk_values, cross_plan, largest_value, plan_grid, plan_sobol, plan_table, &
      sample_plan_t, scene_values
   use text, only: integer_text
   implicit none(type, external)
   private

   public :: run_sampling_tests

contains

   !> Runs every test of this topic.
   subroutine run_sampling_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks

      call checks%start('sampling')
      call test_grid(checks)
      call test_grid_values(checks)
      call test_spread_values(checks)
      call test_any_chunk(checks)
      call test_table(checks)
      call test_crossed_plans(checks)
      call test_faults(checks)
   end subroutine run_sampling_tests

   !> A sample and a table are repeated for each value of one more axis, the slowest; each scene is that of the plan alone.
   subroutine test_crossed_plans(checks)
      type(check_list_t), intent(inout) :: checks
      type(sample_plan_t) :: plans(3), plan
      real(dp), allocatable :: table(:, :)
      character(:), allocatable :: message
      real(dp) :: values(2), crossed(3)
      integer(int64) :: scene, pair
      integer :: bad_axis, i
      logical :: same

      call plan_sobol([range_axis(2, scale_linear, 0.0_dp, 1.0_dp, 0), range_axis(3, scale_linear, 0.0_dp, 1.0_dp, 0)], &
                      5_int64, 1_int64, plans(1), bad_axis, message)
      call plan_sobol([range_axis(2, scale_linear, 0.0_dp, 1.0_dp, 0), list_axis(3, [4.0_dp, 9.0_dp])], &
                      5_int64, 7_int64, plans(2), bad_axis, message)
      allocate (table(2, 5))
      table = reshape([(real(i, dp), i=1, 10)], [2, 5])
      call plan_table([2, 3], table, plans(3))
      do i = 1, size(plans)
         plan = plans(i)
         call cross_plan(list_axis(1, [1.0_dp, 2.0_dp, 3.0_dp]), plan)
         call checks%check(plan%size == 15_int64 .and. plan%known == 15_int64 .and. all(plan%positions == [1, 2, 3]), &
                           'scenes and keys of a crossed plan')
         same = .true.
         do pair = 1_int64, 3_int64
            do scene = 1_int64, 5_int64
               call scene_values(plans(i), scene, values)
               call scene_values(plan, 5_int64*(pair - 1_int64) + scene, crossed)
               same = same .and. all(same_bits(crossed, [real(pair, dp), values]))
            end do
         end do
         call checks%check(same, 'values of a crossed plan')
         call checks%check(.not. abs(largest_value(plan, 1, 0.0_dp) - 3.0_dp) > 0.0_dp, 'largest value of its first axis')
      end do
      call checks%check(.not. abs(largest_value(plan, 3, 0.0_dp) - 10.0_dp) > 0.0_dp, 'largest value of a column')
   end subroutine test_crossed_plans

   !> Order and corners of a grid of three axes.
   subroutine test_grid(checks)
      type(check_list_t), intent(inout) :: checks
      type(campaign_axis_t) :: axes(3)
      type(sample_plan_t) :: plan
      character(:), allocatable :: message
      real(dp) :: values(3)
      integer :: bad_axis, i, j, k
      integer(int64) :: scene
      logical :: ordered

      axes(1) = range_axis(11, scale_linear, 0.1_dp, 0.7_dp, 3)
      axes(2) = range_axis(12, scale_logarithmic, 3.0e-7_dp, 7.0e3_dp, 11)
      axes(3) = list_axis(13, [5.0_dp, -1.0_dp])
      call plan_grid(axes, plan, bad_axis, message)
      call checks%check(len(message) == 0 .and. bad_axis == 0, 'a sound grid: '//message)
      call checks%check(plan%size == 66_int64, 'count of scenes')
      call checks%check(all(plan%positions == [11, 12, 13]), 'keys')
      call scene_values(plan, 1_int64, values)
      call checks%check(all(same_bits(values, [0.1_dp, 3.0e-7_dp, 5.0_dp])), 'first corner')
      call scene_values(plan, 66_int64, values)
      call checks%check(all(same_bits(values, [0.7_dp, 7.0e3_dp, -1.0_dp])), 'last corner')
      call scene_values(plan, 2_int64, values)
      call checks%check(all(same_bits(values, [0.1_dp, 3.0e-7_dp, -1.0_dp])), 'the last axis moves fastest')
      scene = 0_int64
      ordered = .true.
      do i = 0, 2
         do j = 0, 10
            do k = 0, 1
               scene = scene + 1_int64
               call scene_values(plan, scene, values)
               ordered = ordered .and. abs(values(1) - (0.1_dp + 0.3_dp*i)) < 1.0e-15_dp
               ordered = ordered .and. &
                         abs(log(values(2)/3.0e-7_dp) - j*log(7.0e3_dp/3.0e-7_dp)/10.0_dp) < 1.0e-13_dp
               ordered = ordered .and. same_bits(values(3), 5.0_dp - 6.0_dp*k)
            end do
         end do
      end do
      call checks%check(ordered, 'all scenes')
   end subroutine test_grid

   !> Ends are hit for any count; whole steps are exact; whole keys get whole numbers.
   subroutine test_grid_values(checks)
      type(check_list_t), intent(inout) :: checks
      type(sample_plan_t) :: plan
      type(campaign_axis_t) :: axis
      character(:), allocatable :: message
      real(dp) :: value(1)
      integer :: bad_axis, count, scale
      integer(int64) :: scene
      logical :: exact

      exact = .true.
      do scale = scale_linear, scale_logarithmic
         do count = 2, 300
            call plan_grid([range_axis(1, scale, 0.1_dp, 0.3_dp, count)], plan, bad_axis, message)
            call scene_values(plan, 1_int64, value)
            exact = exact .and. same_bits(value(1), 0.1_dp)
            call scene_values(plan, int(count, int64), value)
            exact = exact .and. same_bits(value(1), 0.3_dp)
         end do
      end do
      call checks%check(exact, 'both ends exactly')
      call plan_grid([range_axis(1, scale_linear, 0.0_dp, 100.0_dp, 101)], plan, bad_axis, message)
      exact = .true.
      do scene = 1_int64, 101_int64
         call scene_values(plan, scene, value)
         exact = exact .and. same_bits(value(1), real(scene - 1_int64, dp))
      end do
      call checks%check(exact, 'whole steps exactly')
      axis = range_axis(1, scale_logarithmic, 10.0_dp, 1000.0_dp, 12)
      axis%whole = .true.
      call plan_grid([axis], plan, bad_axis, message)
      exact = len(message) == 0
      do scene = 1_int64, 12_int64
         call scene_values(plan, scene, value)
         exact = exact .and. same_bits(value(1), anint(value(1)))
      end do
      call checks%check(exact, 'integers on a logarithmic axis')
   end subroutine test_grid_values

   !> Sobol and Latin points keep to the range and give lists and integers equal shares.
   subroutine test_spread_values(checks)
      type(check_list_t), intent(inout) :: checks
      type(sample_plan_t) :: plan
      type(campaign_axis_t) :: axes(4)
      character(:), allocatable :: message
      real(dp) :: values(4, 1024)
      integer :: bad_axis

      axes(1) = range_axis(1, scale_linear, -2.0_dp, 6.0_dp, 0)
      axes(2) = range_axis(2, scale_logarithmic, 1.0e-6_dp, 1.0e2_dp, 0)
      axes(3) = range_axis(3, scale_linear, 3.0_dp, 10.0_dp, 0)
      axes(3)%whole = .true.
      axes(4) = list_axis(4, [7.0_dp, 1.0_dp, 3.0_dp, 2.0_dp])
      call plan_sobol(axes, 1024_int64, 0_int64, plan, bad_axis, message)
      call checks%check(len(message) == 0, 'a sound sample: '//message)
      call chunk_values(plan, 1_int64, values)
      call checks%check(all(same_bits(values(:, 1), [-2.0_dp, 1.0e-6_dp, 3.0_dp, 7.0_dp])), &
                        'the origin is the first of each')
      call checks%check_close(sum(values(1, :))/1024.0_dp, 2.0_dp, 0.01_dp, 'mean of a linear axis')
      call checks%check_close(sum(log10(values(2, :)))/1024.0_dp, -2.0_dp, 0.01_dp, &
                              'mean of a logarithmic axis')
      call checks%check(all(same_bits(values(3, :), anint(values(3, :)))), 'integers')
      call checks%check(count(same_bits(values(3, :), 3.0_dp)) == 128 .and. count(same_bits(values(3, :), &
                                                            10.0_dp)) == 128, &
                        'equal shares of integers')
      call checks%check(count(same_bits(values(4, :), 2.0_dp)) == 256, 'equal shares of a list')
      call plan_sobol(axes, 1024_int64, 9_int64, plan, bad_axis, message)
      call chunk_values(plan, 1_int64, values)
      call checks%check(minval(values(1, :)) > -2.0_dp .and. maxval(values(1, :)) < 6.0_dp, &
                        'within a linear range')
      call checks%check(minval(values(2, :)) > 1.0e-6_dp .and. maxval(values(2, :)) < 1.0e2_dp, &
                        'within a logarithmic range')
      call checks%check(count(same_bits(values(4, :), 7.0_dp)) == 256, 'equal shares of a list, shifted')
   end subroutine test_spread_values

   !> A scene has the same bits in chunks of any size, and alone.
   subroutine test_any_chunk(checks)
      type(check_list_t), intent(inout) :: checks
      integer, parameter :: scenes = 343
      type(sample_plan_t) :: plan
      type(campaign_axis_t) :: axes(3)
      character(:), allocatable :: message
      real(dp) :: whole(3, scenes), parts(3, scenes)
      integer :: bad_axis, method, width, first
      logical :: equal

      axes(1) = range_axis(1, scale_logarithmic, 0.3_dp, 17.0_dp, 7)
      axes(2) = range_axis(2, scale_logarithmic, 1.0e-9_dp, 0.02_dp, 7)
      axes(3) = range_axis(3, scale_linear, -0.3_dp, 0.7_dp, 7)
      do method = 1, 2
         if (method == 1) call plan_grid(axes, plan, bad_axis, message)
         if (method == 2) call plan_sobol(axes, int(scenes, int64), 11_int64, plan, bad_axis, message)
         call chunk_values(plan, 1_int64, whole)
         equal = .true.
         do width = 1, 19
            do first = 1, scenes, width
               call chunk_values(plan, int(first, int64), parts(:, first:min(first + width - 1, scenes)))
            end do
            equal = equal .and. all(transfer(parts, [1_int64]) == transfer(whole, [1_int64]))
         end do
         call checks%check(equal, 'chunks of any size, method '//integer_text(method))
      end do
   end subroutine test_any_chunk

   subroutine test_table(checks)
      type(check_list_t), intent(inout) :: checks
      type(sample_plan_t) :: plan
      real(dp), allocatable :: values(:, :)
      character(:), allocatable :: message
      real(dp) :: scene(2)
      integer :: bad_axis

      allocate (values, source=reshape([1.0_dp, 2.0_dp, 3.0_dp, 4.0_dp, 5.0_dp, 6.0_dp], [2, 3]))
      call plan_table([21, 22], values, plan)
      call checks%check(plan%size == 3_int64 .and. .not. allocated(values), 'a table moves into its plan')
      call scene_values(plan, 3_int64, scene)
      call checks%check(all(same_bits(scene, [5.0_dp, 6.0_dp])), 'scene of a table')
      call checks%check(same_bits(largest_value(plan, 21, 9.0_dp), 5.0_dp), 'largest value of a column')
      call checks%check(same_bits(largest_value(plan, 20, 9.0_dp), 9.0_dp), 'largest value of a key that is not varied')
      call plan_grid([range_axis(3, scale_linear, 1.0_dp, 2.5_dp, 3)], plan, bad_axis, message)
      call checks%check(same_bits(largest_value(plan, 3, 9.0_dp), 2.5_dp), 'largest value of a range')
      call plan_grid([campaign_axis_t(position=3, values=[1.0_dp, 7.0_dp, 2.0_dp])], plan, bad_axis, message)
      call checks%check(same_bits(largest_value(plan, 3, 9.0_dp), 7.0_dp), 'largest value of a list')
   end subroutine test_table

   !> What is refused, and in which words.
   subroutine test_faults(checks)
      type(check_list_t), intent(inout) :: checks
      type(campaign_axis_t) :: sound, whole
      real(dp) :: none(0)

      sound = range_axis(1, scale_linear, 1.0_dp, 2.0_dp, 3)
      whole = range_axis(2, scale_linear, 1.0_dp, 10.0_dp, 4)
      whole%whole = .true.
      call refuse_grid(checks, [sound, range_axis(2, scale_linear, 2.0_dp, 1.0_dp, 3)], 2, 'below the last')
      call refuse_grid(checks, [sound, range_axis(2, scale_linear, 1.0_dp, 1.0_dp, 3)], 2, 'below the last')
      call refuse_grid(checks, [range_axis(2, scale_logarithmic, 0.0_dp, 1.0_dp, 3)], 1, &
                       'must lie above zero')
      call refuse_grid(checks, [range_axis(2, scale_logarithmic, -2.0_dp, -1.0_dp, 3)], 1, &
                       'must lie above zero')
      call refuse_grid(checks, [range_axis(2, scale_linear, 1.0_dp, 1.0e200_dp, 3)], 1, &
                       'between 1e-100 and 1e100')
      call refuse_grid(checks, [range_axis(2, scale_linear, 1.0_dp, 2.0_dp, 1)], 1, 'count must be 2 or more')
      call refuse_grid(checks, [list_axis(2, none)], 1, 'list of values is empty')
      call refuse_grid(checks, [list_axis(2, [1.0_dp, 3.0_dp, 1.0_dp])], 1, 'has the value 1.0 twice')
      call refuse_grid(checks, [sound, list_axis(3, [1.0_dp]), sound], 3, 'varied already')
      whole%count = 5
      call refuse_grid(checks, [whole], 1, 'does not divide the range')
      whole%first = 1.5_dp
      call refuse_grid(checks, [whole], 1, 'takes integers')
      whole%first = 1.0_dp
      whole%scale = scale_logarithmic
      whole%count = 10
      call refuse_grid(checks, [whole], 1, 'steps below 1')
      whole = list_axis(2, [1.0_dp, 2.5_dp])
      whole%whole = .true.
      call refuse_grid(checks, [whole], 1, '2.5 is not an integer')
      call refuse_grid(checks, many_axes(7, 2), 0, '6 keys at most')
      call refuse_grid(checks, many_axes(6, 100000000), 0, 'more than 9223372036854775807 scenes')
      call refuse_grid(checks, many_axes(0, 2), 0, 'no key is varied')
      call refuse_sizes(checks, sound)
   end subroutine test_faults

   subroutine refuse_grid(checks, axes, expected_axis, words)
      type(check_list_t), intent(inout) :: checks
      type(campaign_axis_t), intent(in) :: axes(:)
      integer, intent(in) :: expected_axis
      character(*), intent(in) :: words
      type(sample_plan_t) :: plan
      character(:), allocatable :: message
      integer :: bad_axis

      call plan_grid(axes, plan, bad_axis, message)
      call checks%check(index(message, words) > 0, 'refused: '//words//' (got: '//message//')')
      call checks%check(bad_axis == expected_axis, 'axis of the refusal: '//words)
   end subroutine refuse_grid

   subroutine refuse_sizes(checks, axis)
      type(check_list_t), intent(inout) :: checks
      type(campaign_axis_t), intent(in) :: axis
      type(sample_plan_t) :: plan
      character(:), allocatable :: message
      integer :: bad_axis

      call plan_sobol([axis], 0_int64, 0_int64, plan, bad_axis, message)
      call checks%check(index(message, 'size must be from 1') > 0, 'no scene at all')
      call plan_sobol([axis], -5_int64, 0_int64, plan, bad_axis, message)
      call checks%check(index(message, 'it is -5') > 0, 'a negative size')
      call plan_sobol(many_axes(33, 2), 5_int64, 0_int64, plan, bad_axis, message)
      call checks%check(index(message, '32 keys at most') > 0, 'too many dimensions')
   end subroutine refuse_sizes

   pure function range_axis(position, scale, first, last, count) result(axis)
      integer, intent(in) :: position
      integer, intent(in) :: scale
      real(dp), intent(in) :: first
      real(dp), intent(in) :: last
      integer, intent(in) :: count
      type(campaign_axis_t) :: axis

      axis%position = position
      axis%scale = scale
      axis%first = first
      axis%last = last
      axis%count = count
   end function range_axis

   pure function list_axis(position, values) result(axis)
      integer, intent(in) :: position
      real(dp), intent(in) :: values(:)
      type(campaign_axis_t) :: axis

      axis%position = position
      allocate (axis%values, source=values)
   end function list_axis

   pure function many_axes(axis_count, point_count) result(axes)
      integer, intent(in) :: axis_count
      integer, intent(in) :: point_count
      type(campaign_axis_t) :: axes(axis_count)
      integer :: i

      do i = 1, axis_count
         axes(i) = range_axis(i, scale_linear, 0.0_dp, 1.0_dp, point_count)
      end do
   end function many_axes

end module test_sampling
