!> Where a criterion changes along a range: brackets whose ends differ, halved until they are as narrow as asked for. Values
!> stand at places, whole numbers from 0 on, so that every half is exact.
module threshold_search
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
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
      !> From 0 on
      integer :: place = 0
      !> Status of scene_status, and the quantity, NaN: unknown
      integer :: status = 0
      real(dp) :: quantity = 0.0_dp
      !> What the criterion makes of both: two points of one number are alike
      integer :: side = 0
   end type point_t

   !> Two neighbouring points that differ.
   type, public :: bracket_t
      !> Line along which they stand, from 1
      integer(int64) :: line = 0_int64
      type(point_t) :: lower
      type(point_t) :: upper
   end type bracket_t

   public :: finest_axis, scan_places, new_point, brackets_of_scan, is_wide, middle, halved

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

   !> A point, and on which side of the criterion it is.
   pure type(point_t) function new_point(threshold, place, status, quantity) result(point)
      type(threshold_t), intent(in) :: threshold
      integer, intent(in) :: place
      integer, intent(in) :: status
      real(dp), intent(in) :: quantity

      ! The sum leaves no zero below zero.
      point = point_t(place, status, quantity + 0.0_dp, side_unknown)
      if (.not. is_success(status)) then
         point%side = -status
      else if (ieee_is_nan(quantity)) then
         return
      else if (threshold%wanted > 0) then
         point%side = merge(1, 0, nint(quantity) == threshold%wanted)
      else if (any(quantity_table(threshold%quantity)%kind == [a_code, a_flag])) then
         point%side = nint(quantity)
      else
         point%side = merge(1, 0, quantity >= threshold%level)
      end if
   end function new_point

   !> Neighbours of a line that differ.
   pure function brackets_of_scan(line, points) result(brackets)
      integer(int64), intent(in) :: line
      !> By rising places
      type(point_t), intent(in) :: points(:)
      type(bracket_t), allocatable :: brackets(:)
      integer :: i

      allocate (brackets(0))
      do i = 2, size(points)
         if (points(i)%side /= points(i - 1)%side) brackets = [brackets, bracket_t(line, points(i - 1), points(i))]
      end do
   end function brackets_of_scan

   !> Whether there are places between the ends of a bracket.
   elemental logical function is_wide(bracket)
      type(bracket_t), intent(in) :: bracket

      is_wide = bracket%upper%place - bracket%lower%place > 1
   end function is_wide

   !> Place in the middle of a bracket.
   elemental integer function middle(bracket)
      type(bracket_t), intent(in) :: bracket

      middle = bracket%lower%place + (bracket%upper%place - bracket%lower%place)/2
   end function middle

   !> All brackets, the wide ones halved. Of a half whose ends are alike nothing is left; where the middle is of a third kind
   !> both halves are.
   function halved(brackets, middles) result(narrower)
      !> By rising lines and places
      type(bracket_t), intent(in) :: brackets(:)
      !> The points in the middle of the wide ones, in their order
      type(point_t), intent(in) :: middles(:)
      type(bracket_t), allocatable :: narrower(:)
      type(bracket_t) :: found(2*size(brackets))
      integer :: i, wide, count

      wide = 0
      count = 0
      do i = 1, size(brackets)
         if (is_wide(brackets(i))) then
            wide = wide + 1
            call keep(bracket_t(brackets(i)%line, brackets(i)%lower, middles(wide)))
            call keep(bracket_t(brackets(i)%line, middles(wide), brackets(i)%upper))
         else
            call keep(brackets(i))
         end if
      end do
      narrower = found(:count)

   contains

      subroutine keep(bracket)
         type(bracket_t), intent(in) :: bracket

         if (bracket%lower%side == bracket%upper%side) return
         count = count + 1
         found(count) = bracket
      end subroutine keep

   end function halved

end module threshold_search
