!> Tests of the search for thresholds on functions whose changes are known.
module test_threshold_search
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_quiet_nan, ieee_value
   use campaign_axis, only: campaign_axis_t, grid_value
   use checks, only: check_list_t, same_bits
   use kinds, only: dp, int64
   use quantities, only: least_verdict_with_impacts, quantity_film_force_rms, quantity_rattle_class, quantity_verdict
   use scene_status, only: status_film_lost, status_steady
   use scene_types, only: threshold_t
   use threshold_search, only: bracket_t, brackets_of, finest_axis, is_verified, known_side, merged_points, missing_middles, &
                               missing_scan, new_point, point_t, scan_places, side_unknown, untested_ends
   implicit none(type, external)
   private

   !> Where the known function takes another value
   real(dp), parameter :: changes(6) = [0.11_dp, 1.3_dp, 1.30001_dp, 2.7_dp, 2.9_dp, 3.99_dp]

   public :: run_threshold_search_tests

contains

   !> Runs every test of this topic.
   subroutine run_threshold_search_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks

      call checks%start('threshold_search')
      call test_places(checks)
      call test_sides(checks)
      call test_bounds(checks)
      call test_all_changes(checks)
      call test_unseen_pair(checks)
      call test_integers(checks)
      call test_ends(checks)
      call test_kinds_that_none_shows(checks)
      call test_cut_anywhere(checks)
   end subroutine run_threshold_search_tests

   !> A bound from below shows its side where it has reached the level, and nowhere else; a number shows it everywhere.
   subroutine test_bounds(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: level = 12.0_dp, quantity(3) = [11.0_dp, 12.0_dp, 13.0_dp]
      real(dp) :: nan

      nan = ieee_value(0.0_dp, ieee_quiet_nan)
      call checks%check(all(same_bits(known_side(quantity, 0.0_dp, level), quantity)), 'a number is on the side where it is')
      call checks%check(all(same_bits(known_side(quantity, nan, level), quantity)), 'nothing said of bounds: a number')
      call checks%check(all(ieee_is_nan(known_side(quantity, 1.0_dp, level)) .eqv. [.true., .false., .false.]), &
                        'a bound below the level has no side')
      call checks%check(all(same_bits(known_side(quantity(2:), 1.0_dp, level), quantity(2:))), &
                        'a bound that reaches the level is above')
      call checks%check(ieee_is_nan(known_side(nan, 1.0_dp, level)), 'what is unknown stays so')
   end subroutine test_bounds

   !> A threshold of the class between 0.1 and 4.1.
   pure function search(count, tolerance, scale) result(threshold)
      integer, intent(in) :: count
      real(dp), intent(in) :: tolerance
      integer, intent(in) :: scale
      type(threshold_t) :: threshold

      threshold = threshold_t(key='load.mass', first=0.1_dp, last=4.1_dp, scale=scale, count=count, tolerance=tolerance, &
                              quantity=quantity_rattle_class)
   end function search

   !> The known function: 1, 2, 3, 1, 2, 3, 1.
   pure real(dp) function known(value)
      real(dp), intent(in) :: value

      known = real(modulo(count(value >= changes), 3) + 1, dp)
   end function known

   !> All brackets of the known function, and how many values were asked for.
   subroutine find(threshold, axis, brackets, asked)
      type(threshold_t), intent(in) :: threshold
      type(campaign_axis_t), intent(in) :: axis
      type(bracket_t), allocatable, intent(out) :: brackets(:)
      integer, intent(out) :: asked
      type(point_t), allocatable :: points(:), wanted(:)

      allocate (points(0))
      do
         wanted = missing_scan(points, scan_places(threshold, axis), 7_int64, 7_int64)
         if (size(wanted) == 0) wanted = missing_middles(points)
         if (size(wanted) == 0) exit
         points = merged_points(points, solved(threshold, axis, wanted))
      end do
      asked = size(points)
      brackets = brackets_of(points)
   end subroutine find

   !> What the known function says of some points.
   function solved(threshold, axis, wanted) result(points)
      type(threshold_t), intent(in) :: threshold
      type(campaign_axis_t), intent(in) :: axis
      type(point_t), intent(in) :: wanted(:)
      type(point_t) :: points(size(wanted))
      integer :: i

      do i = 1, size(wanted)
         points(i) = new_point(threshold, wanted(i), status_steady, known(grid_value(axis, wanted(i)%place)))
      end do
   end function solved

   subroutine test_places(checks)
      type(check_list_t), intent(inout) :: checks
      type(campaign_axis_t) :: axis, coarse
      integer, allocatable :: places(:)
      real(dp) :: farthest
      integer :: i, scale

      do scale = 1, 2
         axis = finest_axis(search(33, 1.0e-4_dp, scale), 3, .false.)
         call checks%check(axis%count == 16385, 'the first halves of 32 steps that are a 1e-4 of the range wide')
         if (allocated(places)) deallocate (places)
         allocate (places, source=scan_places(search(33, 1.0e-4_dp, scale), axis))
         coarse = axis
         coarse%count = 33
         call checks%check(size(places) == 33, 'the scan has its count')
         farthest = 0.0_dp
         do i = 1, 33
            farthest = max(farthest, abs(grid_value(axis, places(i)) - grid_value(coarse, i - 1)))
         end do
         ! Products and sums may be rounded together or one by one.
         call checks%check(farthest <= 2.0_dp*epsilon(1.0_dp)*max(abs(axis%first), abs(axis%last)), &
                           'the values of the scan are those of a grid of its count')
      end do
      axis = finest_axis(search(2, 0.5_dp, 1), 3, .false.)
      call checks%check(axis%count == 3, 'a bracket as wide as half the range')
      axis = finest_axis(search(1000000, 1.0e-9_dp, 1), 3, .false.)
      call checks%check(axis%count > 1000000000, 'the finest of all fits an integer')
   end subroutine test_places

   subroutine test_sides(checks)
      type(check_list_t), intent(inout) :: checks
      type(threshold_t) :: threshold
      type(point_t) :: point

      threshold = search(33, 1.0e-4_dp, 1)
      point = new_point(threshold, point_t(place=5), status_film_lost, 2.0_dp)
      call checks%check(point%side == -status_film_lost .and. point%place == 5, 'a scene that failed is a kind of its own')
      point = new_point(threshold, point_t(place=5), status_steady, ieee_value(0.0_dp, ieee_quiet_nan))
      call checks%check(point%side == side_unknown, 'so is one without a class')
      point = new_point(threshold, point_t(place=5), status_steady, 3.0_dp)
      call checks%check(point%side == 3, 'every class is another side')
      threshold%wanted = 3
      point = new_point(threshold, point_t(place=5), status_steady, 2.0_dp)
      call checks%check(point%side == 0, 'all classes but the one that is looked for are alike')
      point = new_point(threshold, point_t(place=5), status_steady, 3.0_dp)
      call checks%check(point%side == 1, 'the one that is looked for')
      threshold = threshold_t(key='load.mass', quantity=quantity_verdict, least_wanted=least_verdict_with_impacts)
      point = new_point(threshold, point_t(place=5), status_steady, 1.0_dp)
      call checks%check(point%side == 0, 'a separation is no impact')
      point = new_point(threshold, point_t(place=5), status_steady, 2.0_dp)
      call checks%check(point%side == 1, 'impacts on one flank are impacts')
      point = new_point(threshold, point_t(place=5), status_steady, 3.0_dp)
      call checks%check(point%side == 1, 'so are those on both flanks')
      threshold = threshold_t(key='load.mass', quantity=quantity_film_force_rms, level=2.5_dp)
      point = new_point(threshold, point_t(place=5), status_steady, 2.5_dp)
      call checks%check(point%side == 1, 'a level is reached')
      point = new_point(threshold, point_t(place=5), status_steady, 2.4999_dp)
      call checks%check(point%side == 0, 'a level is not reached')
   end subroutine test_sides

   !> Every change has its bracket, also two in one step of the scan where a third value lies between.
   subroutine test_all_changes(checks)
      type(check_list_t), intent(inout) :: checks
      type(campaign_axis_t) :: axis
      type(bracket_t), allocatable :: brackets(:)
      real(dp) :: lower, upper
      integer :: i, asked, scale
      logical :: right

      do scale = 1, 2
         axis = finest_axis(search(33, 1.0e-6_dp, scale), 3, .false.)
         call find(search(33, 1.0e-6_dp, scale), axis, brackets, asked)
         call checks%check(size(brackets) == size(changes), 'as many brackets as changes')
         if (size(brackets) /= size(changes)) cycle
         right = .true.
         do i = 1, size(changes)
            lower = grid_value(axis, brackets(i)%lower%place)
            upper = grid_value(axis, brackets(i)%upper%place)
            right = right .and. lower < changes(i) .and. changes(i) <= upper .and. brackets(i)%lower%trace == 7_int64 &
                    .and. brackets(i)%upper%place == brackets(i)%lower%place + 1 &
                    .and. brackets(i)%lower%side == nint(known(lower)) .and. brackets(i)%upper%side == nint(known(upper))
         end do
         call checks%check(right, 'each bracket holds its change, in their order')
         call checks%check(asked <= 33 + 6*15, 'with a scan and 15 halves for each')
      end do
   end subroutine test_all_changes

   !> Two changes between neighbours of the scan that cancel each other are not seen; a finer scan sees them.
   subroutine test_unseen_pair(checks)
      type(check_list_t), intent(inout) :: checks
      type(threshold_t) :: threshold
      type(campaign_axis_t) :: axis
      type(bracket_t), allocatable :: brackets(:)
      integer :: asked, i

      do i = 1, 2
         threshold = search(merge(9, 41, i == 1), 1.0e-3_dp, 1)
         threshold%wanted = 2
         axis = finest_axis(threshold, 3, .false.)
         ! The second value lies between 0.11 and 1.3, and between 2.7 and 2.9, which is less than a step of half.
         threshold%first = 0.1_dp
         call find(threshold, axis, brackets, asked)
         call checks%check(size(brackets) == merge(2, 4, i == 1), 'a pair within one step is seen by a finer scan only')
      end do
   end subroutine test_unseen_pair

   subroutine test_integers(checks)
      type(check_list_t), intent(inout) :: checks
      type(threshold_t) :: threshold
      type(campaign_axis_t) :: axis
      type(bracket_t), allocatable :: brackets(:)
      integer, allocatable :: places(:)
      integer :: asked

      threshold = search(33, 1.0e-4_dp, 2)
      threshold%first = 1.0_dp
      threshold%last = 5.0_dp
      axis = finest_axis(threshold, 3, .true.)
      allocate (places, source=scan_places(threshold, axis))
      call checks%check(size(places) == 5 .and. all(places == [0, 1, 2, 3, 4]), 'no integer is scanned twice')
      threshold%last = 1000.0_dp
      axis = finest_axis(threshold, 3, .true.)
      call find(threshold, axis, brackets, asked)
      call checks%check(size(brackets) == 3, 'changes between integers')
      call checks%check(all(brackets%upper%place - brackets%lower%place == 1), 'down to the next integer')
   end subroutine test_integers

   !> Points of one trace with these sides, places of the scan every fourth; verified as reported, 2: not put to the test.
   function line_of(sides, verified, trace) result(points)
      integer, intent(in) :: sides(:)
      integer, intent(in) :: verified(:)
      integer(int64), intent(in) :: trace
      type(point_t) :: points(size(sides))
      integer :: i

      do i = 1, size(sides)
         points(i) = new_point(search(3, 1.0e-2_dp, 1), point_t(trace=trace, place=i - 1, scanned=mod(i - 1, 4) == 0), &
                               status_steady, real(sides(i), dp))
         points(i)%tested = verified(i) < 2
         if (points(i)%tested) points(i)%verified = real(verified(i), dp)
      end do
   end function line_of

   !> An end goes outwards to the first point that stands, over those of its own kind alone; one that has none stays.
   subroutine test_ends(checks)
      type(check_list_t), intent(inout) :: checks
      integer, parameter :: sides(9) = [1, 1, 1, 1, 3, 3, 3, 3, 3]
      type(point_t), allocatable :: wanted(:), points(:)

      call check_bracket('both ends stand', sides, [2, 2, 2, 1, 1, 2, 2, 2, 2], 3, 4, [.true., .true.])
      call check_bracket('the lower end goes down', sides, [2, 1, 0, 0, 1, 2, 2, 2, 2], 1, 4, [.true., .true.])
      call check_bracket('the upper end goes up', sides, [2, 2, 2, 1, 0, 0, 1, 2, 2], 3, 6, [.true., .true.])
      call check_bracket('the lower end has no place to stand', sides, [0, 0, 0, 0, 0, 1, 2, 2, 2], 3, 5, [.false., .true.])
      call check_bracket('nothing is put to the test', sides, [2, 2, 2, 2, 2, 2, 2, 2, 2], 3, 4, [.false., .false.])
      allocate (points, source=line_of(sides, [2, 2, 0, 0, 1, 2, 2, 2, 2], 1_int64))
      wanted = untested_ends(points)
      call checks%check(size(wanted) == 1, 'one more point is put to the test')
      call checks%check(wanted(1)%place == 1 .and. wanted(1)%side == 1, 'the next one outwards')
      wanted = untested_ends(line_of(sides, [2, 2, 2, 0, 0, 2, 2, 2, 2], 1_int64))
      call checks%check(size(wanted) == 2, 'and on both sides at once')
      call checks%check(wanted(1)%place == 2 .and. wanted(2)%place == 5, 'of each the nearest')
      wanted = untested_ends(line_of(sides, [0, 0, 0, 0, 0, 0, 0, 0, 0], 1_int64))
      call checks%check(size(wanted) == 0, 'where none stands all have been tried')
      ! The scene that fails has no verification, and what is beyond it is not asked.
      points(5:) = new_point(search(3, 1.0e-2_dp, 1), points(5), status_film_lost, 0.0_dp)
      points(5:)%place = [4, 5, 6, 7, 8]
      points(5:)%tested = .false.
      wanted = untested_ends(points)
      call checks%check(size(wanted) == 1, 'scenes that fail are not put to the test')
      ! Two traces of the same places do not see each other.
      wanted = untested_ends([line_of(sides, [2, 2, 2, 1, 1, 2, 2, 2, 2], 1_int64), &
                              line_of([1, 1, 1, 1, 1, 1, 1, 1, 1], [2, 2, 2, 2, 2, 2, 2, 2, 2], 2_int64)])
      call checks%check(size(wanted) == 0, 'the end of a trace and the start of the next are no neighbours')

   contains

      subroutine check_bracket(what, sides, verified, lower, upper, stand)
         character(*), intent(in) :: what
         integer, intent(in) :: sides(:), verified(:), lower, upper
         logical, intent(in) :: stand(2)
         type(bracket_t), allocatable :: brackets(:)

         allocate (brackets, source=brackets_of(line_of(sides, verified, 1_int64)))
         call checks%check(size(brackets) == 1, what//': one bracket')
         if (size(brackets) /= 1) return
         call checks%check(brackets(1)%lower%place == lower .and. brackets(1)%upper%place == upper, what//': its ends')
         call checks%check(is_verified(brackets(1)%lower) .eqv. stand(1), what//': below')
         call checks%check(is_verified(brackets(1)%upper) .eqv. stand(2), what//': above')
      end subroutine check_bracket

   end subroutine test_ends

   !> A kind that only narrower brackets have met and no verified point shows is none; the scan's own stays as it was found.
   subroutine test_kinds_that_none_shows(checks)
      type(check_list_t), intent(inout) :: checks
      integer, parameter :: between(9) = [1, 1, 2, 2, 3, 3, 3, 3, 3], scanned(9) = [1, 1, 2, 2, 2, 3, 3, 3, 3]
      type(bracket_t), allocatable :: brackets(:)

      allocate (brackets, source=brackets_of(line_of(between, [2, 1, 0, 0, 1, 2, 2, 2, 2], 1_int64)))
      call checks%check(size(brackets) == 1, 'one change from the first to the third')
      call checks%check(brackets(1)%lower%place == 1 .and. brackets(1)%upper%place == 4, 'from where they stand')
      call checks%check(brackets(1)%lower%side == 1 .and. brackets(1)%upper%side == 3, 'and what they are')
      brackets = brackets_of(line_of(between, [2, 1, 0, 1, 1, 2, 2, 2, 2], 1_int64))
      call checks%check(size(brackets) == 2, 'one verified point is enough for a kind')
      call checks%check(brackets(1)%upper%place == 3 .and. brackets(2)%lower%place == 3, 'at which both brackets end')
      brackets = brackets_of(line_of(scanned, [2, 1, 0, 0, 0, 1, 2, 2, 2], 1_int64))
      call checks%check(size(brackets) == 2, 'what the scan has met stays')
      call checks%check(.not. (is_verified(brackets(1)%upper) .or. is_verified(brackets(2)%lower)), 'with its doubt')
   end subroutine test_kinds_that_none_shows

   !> A search that is cut at any point, with some answers of a pass or all of them, asks for the same points in all.
   subroutine test_cut_anywhere(checks)
      type(check_list_t), intent(inout) :: checks
      type(threshold_t) :: threshold
      type(campaign_axis_t) :: axis
      type(point_t), allocatable :: points(:), wanted(:), whole(:)
      integer :: every

      threshold = search(33, 1.0e-4_dp, 1)
      axis = finest_axis(threshold, 3, .false.)
      allocate (whole(0))
      do every = 1, 5
         if (allocated(points)) deallocate (points)
         allocate (points(0))
         do
            wanted = missing_scan(points, scan_places(threshold, axis), 7_int64, 7_int64)
            if (size(wanted) == 0) wanted = missing_middles(points)
            if (size(wanted) == 0) exit
            points = merged_points(points, solved(threshold, axis, wanted(1::every)))
         end do
         if (every == 1) whole = points
         call checks%check(size(points) == size(whole), 'as many points, however they came')
         if (size(points) == size(whole)) call checks%check(all(points%place == whole%place), 'the same points')
      end do
   end subroutine test_cut_anywhere

end module test_threshold_search
