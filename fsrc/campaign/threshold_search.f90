!> Where a criterion changes along a range: a scan of every trace, then the middles of neighbours that differ, until they stand as
!> close together as asked for; then the ends of each change go apart again until both are verified. Values stand at places,
!> whole numbers from 0 on, so that every half is exact. All that is known is one list of points: what is to be solved next
!> follows from that list alone, so that a search may be cut anywhere and go on.
module threshold_search
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_quiet_nan, ieee_value
   use campaign_axis, only: campaign_axis_t, grid_value
   use kinds, only: dp, int64
   use quantities, only: a_code, a_flag, quantity_table
   use scene_status, only: is_success
   use scene_types, only: threshold_t
   implicit none(type, external)
   private

   !> What a point is where its quantity has no value. A scene that failed is minus its status.
   integer, parameter, public :: side_unknown = -1000

   !> A value of the key and what was found there.
   type, public :: point_t
      !> Trace along which it stands, from 1, and its place there, from 0
      integer(int64) :: trace = 0_int64
      integer :: place = 0
      !> Whether the scan has this place
      logical :: scanned = .false.
      !> Status of scene_status, and the quantity, NaN: unknown
      integer :: status = 0
      real(dp) :: quantity = 0.0_dp
      !> What the criterion makes of both: two points of one number are alike
      integer :: side = 0
      !> Whether its class was put to the test, and what came out: 1 it stands, 0 it does not, NaN there is no test of it
      logical :: tested = .false.
      real(dp) :: verified = 0.0_dp
   end type point_t

   !> Two points of a trace that differ, or the ends of a trace that has none such.
   type, public :: bracket_t
      type(point_t) :: lower
      type(point_t) :: upper
   end type bracket_t

   public :: finest_axis, scan_places, known_side, new_point, merged_points, missing_scan, missing_middles, untested_ends, &
             brackets_of, rows_of_traces, is_crossing, is_verified

contains

   !> The range of a threshold, divided as finely as its brackets become: by halves of the steps of the scan, or into integers.
   pure function finest_axis(threshold, position, whole) result(axis)
      type(threshold_t), intent(in) :: threshold
      !> Position of its key in the key table
      integer, intent(in) :: position
      !> Whether the key takes whole numbers only
      logical, intent(in) :: whole
      type(campaign_axis_t) :: axis
      integer :: steps

      axis%position = position
      axis%whole = whole
      axis%first = threshold%first
      axis%last = threshold%last
      if (whole) then
         axis%count = nint(threshold%last - threshold%first) + 1
         return
      end if
      axis%scale = threshold%scale
      steps = threshold%count - 1
      do while (real(steps, dp)*threshold%tolerance < 1.0_dp)
         steps = 2*steps
      end do
      axis%count = steps + 1
   end function finest_axis

   !> Places of the scan, both ends of the range among them.
   pure function scan_places(threshold, axis) result(places)
      type(threshold_t), intent(in) :: threshold
      !> The range, divided finely
      type(campaign_axis_t), intent(in) :: axis
      integer, allocatable :: places(:)
      type(campaign_axis_t) :: scan
      integer :: i

      if (axis%whole) then
         scan = axis
         if (threshold%count < axis%count) then
            scan%scale = threshold%scale
            scan%count = threshold%count
         end if
         places = [(nint(grid_value(scan, i) - axis%first), i=0, scan%count - 1)]
         places = pack(places, [.true., places(2:) > places(:size(places) - 1)])
      else
         places = [(i*((axis%count - 1)/(threshold%count - 1)), i=0, threshold%count - 1)]
      end if
   end function scan_places

   !> A quantity whose side of the level is known: NaN where the quantity is reported to be below the level and may be larger.
   elemental real(dp) function known_side(quantity, is_bound, level)
      real(dp), intent(in) :: quantity
      !> Above zero: the quantity may be larger
      real(dp), intent(in) :: is_bound
      real(dp), intent(in) :: level

      known_side = quantity
      if (ieee_is_nan(quantity) .or. ieee_is_nan(is_bound)) return
      if (is_bound > 0.0_dp .and. quantity < level) known_side = ieee_value(0.0_dp, ieee_quiet_nan)
   end function known_side

   !> A point, and on which side of the criterion it is.
   pure type(point_t) function new_point(threshold, wanted, status, quantity) result(point)
      type(threshold_t), intent(in) :: threshold
      !> The point that was to be solved
      type(point_t), intent(in) :: wanted
      integer, intent(in) :: status
      real(dp), intent(in) :: quantity

      point = wanted
      point%status = status
      ! The sum leaves no zero below zero.
      point%quantity = quantity + 0.0_dp
      point%side = side_unknown
      point%verified = ieee_value(0.0_dp, ieee_quiet_nan)
      if (.not. is_success(status)) then
         point%side = -status
      else if (ieee_is_nan(quantity)) then
         return
      else if (threshold%wanted > 0) then
         point%side = merge(1, 0, nint(quantity) == threshold%wanted)
      else if (threshold%least_wanted > 0) then
         point%side = merge(1, 0, nint(quantity) >= threshold%least_wanted)
      else if (any(quantity_table(threshold%quantity)%kind == [a_code, a_flag])) then
         point%side = nint(quantity)
      else
         point%side = merge(1, 0, quantity >= threshold%level)
      end if
   end function new_point

   !> Two lists of points as one, by rising traces and places. Of two points of one place the second list has the newer one.
   pure function merged_points(points, newer) result(both)
      !> By rising traces and places
      type(point_t), intent(in) :: points(:)
      type(point_t), intent(in) :: newer(:)
      type(point_t), allocatable :: both(:)
      type(point_t), allocatable :: found(:)
      integer :: i, j, count

      allocate (found(size(points) + size(newer)))
      i = 1
      j = 1
      count = 0
      do while (i <= size(points) .or. j <= size(newer))
         count = count + 1
         if (j > size(newer)) then
            found(count) = points(i)
            i = i + 1
         else if (i > size(points)) then
            found(count) = newer(j)
            j = j + 1
         else if (stands_before(points(i), newer(j))) then
            found(count) = points(i)
            i = i + 1
         else
            if (.not. stands_before(newer(j), points(i))) i = i + 1
            found(count) = newer(j)
            j = j + 1
         end if
      end do
      both = found(:count)
   end function merged_points

   !> Whether a point belongs before another.
   elemental logical function stands_before(one, other)
      type(point_t), intent(in) :: one
      type(point_t), intent(in) :: other

      stands_before = one%trace < other%trace .or. (one%trace == other%trace .and. one%place < other%place)
   end function stands_before

   !> Points of the scan of some traces that are not known yet.
   pure function missing_scan(points, scan, first, last) result(wanted)
      !> By rising traces and places
      type(point_t), intent(in) :: points(:)
      !> Places of the scan
      integer, intent(in) :: scan(:)
      !> First and last trace
      integer(int64), intent(in) :: first
      integer(int64), intent(in) :: last
      type(point_t), allocatable :: wanted(:)
      type(point_t) :: point
      integer(int64) :: trace
      integer :: i, k, count

      allocate (wanted(size(scan)*(last - first + 1_int64)))
      count = 0
      k = 1
      do trace = first, last
         do i = 1, size(scan)
            point = point_t(trace=trace, place=scan(i), scanned=.true.)
            do while (k <= size(points))
               if (.not. stands_before(points(k), point)) exit
               k = k + 1
            end do
            if (k <= size(points)) then
               if (.not. stands_before(point, points(k))) cycle
            end if
            count = count + 1
            wanted(count) = point
         end do
      end do
      wanted = wanted(:count)
   end function missing_scan

   !> Points in the middle between neighbours that differ and are not next to each other.
   pure function missing_middles(points) result(wanted)
      !> By rising traces and places
      type(point_t), intent(in) :: points(:)
      type(point_t), allocatable :: wanted(:)
      integer :: i, count

      allocate (wanted(size(points)))
      count = 0
      do i = 2, size(points)
         if (.not. differ(points(i - 1), points(i)) .or. points(i)%place - points(i - 1)%place < 2) cycle
         count = count + 1
         wanted(count) = point_t(trace=points(i)%trace, place=points(i - 1)%place + (points(i)%place - points(i - 1)%place)/2)
      end do
      wanted = wanted(:count)
   end function missing_middles

   !> Whether neighbours stand on one trace and on different sides.
   elemental logical function differ(one, other)
      type(point_t), intent(in) :: one
      type(point_t), intent(in) :: other

      differ = one%trace == other%trace .and. one%side /= other%side
   end function differ

   !> Whether the class of a point was put to the test and stands.
   elemental logical function is_verified(point)
      type(point_t), intent(in) :: point

      ! No number is above zero that is none.
      is_verified = point%tested .and. point%verified > 0.0_dp
   end function is_verified

   !> Ends of brackets whose classes are still to be put to the test.
   pure function untested_ends(points) result(wanted)
      !> By rising traces and places
      type(point_t), intent(in) :: points(:)
      type(point_t), allocatable :: wanted(:)
      type(point_t), allocatable :: standing(:)
      logical, allocatable :: chosen(:)
      integer :: i

      allocate (standing, source=standing_points(points))
      allocate (chosen(size(standing)), source=.false.)
      do i = 2, size(standing)
         if (.not. differ(standing(i - 1), standing(i))) cycle
         chosen(end_of(standing, i - 1, -1)) = .true.
         chosen(end_of(standing, i, 1)) = .true.
      end do
      wanted = pack(standing, chosen .and. .not. standing%tested .and. is_success(standing%status))
   end function untested_ends

   !> Where the end of a bracket is: at the nearest point, from the change outwards, whose class is verified, as long as the points
   !> are alike; or at one that is still to be tested. Where none of them stands, and where scenes fail, it is the point beside
   !> the change.
   pure integer function end_of(points, beside, step)
      type(point_t), intent(in) :: points(:)
      !> Point beside the change
      integer, intent(in) :: beside
      !> -1 or 1: outwards
      integer, intent(in) :: step
      integer :: i

      end_of = beside
      if (.not. is_success(points(beside)%status)) return
      i = beside
      do
         if (.not. points(i)%tested .or. is_verified(points(i))) then
            end_of = i
            return
         end if
         i = i + step
         if (i < 1 .or. i > size(points)) return
         if (points(i)%trace /= points(beside)%trace .or. points(i)%side /= points(beside)%side) return
      end do
   end function end_of

   !> The points without those that only narrower brackets have led to and of which none stands: a kind of motion that no
   !> verified point shows begins and ends nowhere. A bracket then ends where its ends were verified before.
   pure function standing_points(points) result(standing)
      type(point_t), intent(in) :: points(:)
      type(point_t), allocatable :: standing(:)
      logical, allocatable :: kept(:)
      integer :: first, last

      allocate (kept(size(points)), source=.true.)
      last = 0
      do while (last < size(points))
         first = last + 1
         last = first
         do while (last < size(points))
            if (points(last + 1)%trace /= points(first)%trace .or. points(last + 1)%side /= points(first)%side) exit
            last = last + 1
         end do
         associate (alike => points(first:last))
            kept(first:last) = any(alike%scanned .or. .not. alike%tested .or. is_verified(alike))
         end associate
      end do
      standing = pack(points, kept)
   end function standing_points

   !> All brackets, by rising traces and places: neighbours that differ, each end where it stands verified.
   pure function brackets_of(points) result(brackets)
      !> By rising traces and places
      type(point_t), intent(in) :: points(:)
      type(bracket_t), allocatable :: brackets(:)
      type(point_t), allocatable :: standing(:)
      type(bracket_t), allocatable :: found(:)
      integer :: i, count

      allocate (standing, source=standing_points(points))
      allocate (found(size(standing)))
      count = 0
      do i = 2, size(standing)
         if (.not. differ(standing(i - 1), standing(i))) cycle
         count = count + 1
         found(count) = bracket_t(standing(end_of(standing, i - 1, -1)), standing(end_of(standing, i, 1)))
      end do
      brackets = found(:count)
   end function brackets_of

   !> Whether the ends of a bracket are on different sides.
   elemental logical function is_crossing(bracket)
      type(bracket_t), intent(in) :: bracket

      is_crossing = bracket%lower%side /= bracket%upper%side
   end function is_crossing

   !> All brackets, and in their order for each trace without one a bracket from end to end of its range, whose sides are alike.
   pure function rows_of_traces(points) result(rows)
      !> By rising traces and places, all of each trace
      type(point_t), intent(in) :: points(:)
      type(bracket_t), allocatable :: rows(:)
      type(bracket_t), allocatable :: brackets(:), found(:)
      integer :: start, end, i, count

      allocate (brackets, source=brackets_of(points))
      allocate (found(size(brackets) + size(points)))
      count = 0
      i = 1
      end = 0
      do while (end < size(points))
         start = end + 1
         end = start
         do while (end < size(points))
            if (points(end + 1)%trace /= points(start)%trace) exit
            end = end + 1
         end do
         count = count + 1
         found(count) = bracket_t(points(start), points(end))
         if (i > size(brackets)) cycle
         if (brackets(i)%lower%trace /= points(start)%trace) cycle
         count = count - 1
         do while (i <= size(brackets))
            if (brackets(i)%lower%trace /= points(start)%trace) exit
            count = count + 1
            found(count) = brackets(i)
            i = i + 1
         end do
      end do
      rows = found(:count)
   end function rows_of_traces

end module threshold_search
