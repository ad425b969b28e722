!> One varied key of a campaign and the numbers it takes: a list, or a range with a scale.
module campaign_axis
   use kinds, only: dp, int64
   use text, only: integer_text, real_text
   implicit none(type, external)
   private

   integer, parameter, public :: scale_linear = 1, scale_logarithmic = 2

   !> Ends of a range stay well within the reals, so that their products and quotients do.
   real(dp), parameter :: largest_end = 1.0e100_dp, smallest_end = 1.0e-100_dp

   !> One axis.
   type, public :: campaign_axis_t
      !> Position in the key table
      integer :: position = 0
      !> Whether the key takes whole numbers only
      logical :: whole = .false.
      !> How the range is divided; of no use with a list
      integer :: scale = scale_linear
      !> Ends of the range; both belong to it
      real(dp) :: first = 0.0_dp
      real(dp) :: last = 0.0_dp
      !> Points of a grid along the range
      integer :: count = 0
      !> The list; not allocated: a range is given
      real(dp), allocatable :: values(:)
   end type campaign_axis_t

   public :: check_axis, axis_count, grid_value, spread_value

contains

   !> See that an axis makes sense.
   pure subroutine check_axis(axis, on_grid, message)
      !> The axis
      type(campaign_axis_t), intent(in) :: axis
      !> Whether its count is used
      logical, intent(in) :: on_grid
      !> What is wrong and what is allowed; empty if nothing is
      character(:), allocatable, intent(out) :: message
      integer :: i, j

      message = ''
      if (allocated(axis%values)) then
         if (size(axis%values) == 0) message = 'the list of values is empty'
         do i = 1, size(axis%values)
            if (axis%whole .and. .not. is_whole_number(axis%values(i))) then
               message = 'the value '//real_text(axis%values(i))//' is not an integer; this key takes integers'
               return
            end if
            do j = 1, i - 1
               if (.not. (axis%values(i) < axis%values(j) .or. axis%values(i) > axis%values(j))) then
                  message = 'the list has the value '//real_text(axis%values(i))//' twice'
                  return
               end if
            end do
         end do
         return
      end if
      call check_range(axis, message)
      if (len(message) == 0 .and. on_grid) call check_count(axis, message)
   end subroutine check_axis

   pure subroutine check_range(axis, message)
      type(campaign_axis_t), intent(in) :: axis
      character(:), allocatable, intent(inout) :: message

      if (axis%scale == scale_logarithmic .and. (axis%first <= 0.0_dp .or. axis%last <= 0.0_dp)) then
         message = 'a logarithmic range must lie above zero; it goes from '//range_text(axis)
      else if (axis%first >= axis%last) then
         message = 'the first value must be below the last; the range goes from '//range_text(axis)
      else if (max(abs(axis%first), abs(axis%last)) > largest_end .or. &
               (axis%scale == scale_logarithmic .and. axis%first < smallest_end)) then
         message = 'a range must stay between 1e-100 and 1e100 in size; it goes from '//range_text(axis)
      else if (axis%whole .and. .not. (is_whole_number(axis%first) .and. is_whole_number(axis%last))) then
         message = 'this key takes integers; the range goes from '//range_text(axis)
      end if
   end subroutine check_range

   pure subroutine check_count(axis, message)
      type(campaign_axis_t), intent(in) :: axis
      character(:), allocatable, intent(inout) :: message
      logical :: sound

      if (axis%count < 2) then
         message = 'the count must be 2 or more, it is '//integer_text(axis%count)
         return
      end if
      if (.not. axis%whole) return
      if (axis%scale == scale_linear) then
         sound = is_whole_number((axis%last - axis%first)/real(axis%count - 1, dp))
         if (.not. sound) message = 'this key takes integers; a count of '//integer_text(axis%count)// &
                                    ' does not divide the range from '//range_text(axis)//' into whole steps'
      else
         ! The first step of a logarithmic range is its smallest.
         sound = axis%first*((axis%last/axis%first)**(1.0_dp/real(axis%count - 1, dp)) - 1.0_dp) >= 1.0_dp
         if (.not. sound) message = 'this key takes integers; a count of '//integer_text(axis%count)// &
                                    ' needs steps below 1 at the start of the range from '//range_text(axis)
      end if
   end subroutine check_count

   pure function range_text(axis) result(words)
      type(campaign_axis_t), intent(in) :: axis
      character(:), allocatable :: words

      words = real_text(axis%first)//' to '//real_text(axis%last)
   end function range_text

   !> Whether a number is an integer that the default kind holds.
   pure logical function is_whole_number(number)
      real(dp), intent(in) :: number

      is_whole_number = abs(number) <= real(huge(1), dp) .and. .not. abs(number - anint(number)) > 0.0_dp
   end function is_whole_number

   !> Points of a grid along an axis.
   pure integer function axis_count(axis)
      !> Checked axis
      type(campaign_axis_t), intent(in) :: axis

      axis_count = axis%count
      if (allocated(axis%values)) axis_count = size(axis%values)
   end function axis_count

   !> Value at a point of the grid. The ends of the range are hit exactly, and a linear range is rounded
   !> once where its ends times the count are exact.
   pure real(dp) function grid_value(axis, point)
      !> Checked axis
      type(campaign_axis_t), intent(in) :: axis
      !> From 0 to axis_count - 1
      integer, intent(in) :: point
      real(dp) :: steps, done

      if (allocated(axis%values)) then
         grid_value = axis%values(point + 1)
         return
      end if
      steps = real(axis%count - 1, dp)
      done = real(point, dp)
      if (point == 0) then
         grid_value = axis%first
      else if (point == axis%count - 1) then
         grid_value = axis%last
      else if (axis%scale == scale_linear) then
         grid_value = (axis%first*(steps - done) + axis%last*done)/steps
      else
         grid_value = axis%first*(axis%last/axis%first)**(done/steps)
      end if
      if (axis%whole) grid_value = anint(grid_value)
   end function grid_value

   !> Value at a share of the axis. Whole numbers of a linear range and values of a list get equal shares.
   pure real(dp) function spread_value(axis, share)
      !> Checked axis
      type(campaign_axis_t), intent(in) :: axis
      !> At least 0, below 1
      real(dp), intent(in) :: share
      integer(int64) :: part

      if (allocated(axis%values)) then
         part = min(int(share*real(size(axis%values), dp), int64), size(axis%values, kind=int64) - 1_int64)
         spread_value = axis%values(part + 1_int64)
      else if (axis%scale == scale_logarithmic) then
         spread_value = min(axis%first*(axis%last/axis%first)**share, axis%last)
         if (axis%whole) spread_value = anint(spread_value)
      else if (axis%whole) then
         spread_value = min(axis%first + aint(share*(axis%last - axis%first + 1.0_dp)), axis%last)
      else
         ! Rounding may lead a little beyond an end.
         spread_value = max(axis%first, min(axis%first*(1.0_dp - share) + axis%last*share, axis%last))
      end if
   end function spread_value

end module campaign_axis
