!> Rules of the keys of &gear and &shaft; what their contact and orders must be is known when these are derived.
module gear_checker
   use errors, only: fault_list_t
   use kinds, only: dp
   use scene_input, only: scene_input_t
   use text, only: integer_text, real_text
   implicit none(type, external)
   private

   public :: check_gear, check_shaft

contains

   !> Speed and force need the shaft.
   subroutine check_gear(input, faults)
      !> Typed values
      type(scene_input_t), intent(in) :: input
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults

      if (.not. input%has_group('shaft')) call faults%add(input%file, 0, 'shaft', '', &
                                                         'this group is required where &gear stands: it drives the gears')
   end subroutine check_gear

   !> The shaft drives gears, and its lists are of one length.
   subroutine check_shaft(input, faults)
      !> Typed values
      type(scene_input_t), intent(in) :: input
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      character(*), parameter :: lists(3) = [character(13) :: 'orders', 'accelerations', 'phases']
      real(dp), allocatable :: orders(:)
      integer :: i

      if (.not. input%has_group('gear')) call faults%add(input%file, 0, 'gear', '', &
                                                        'this group is required where &shaft stands: it says what is driven')
      if (any([(input%is_faulty('shaft', trim(lists(i))), i=1, 3)])) return
      if (.not. input%is_given('shaft', 'orders')) return
      allocate (orders, source=input%numbers('shaft', 'orders'))
      do i = 2, 3
         if (input%is_given('shaft', trim(lists(i))) .and. size(input%numbers('shaft', trim(lists(i)))) /= size(orders)) &
            call input%add_fault('shaft', trim(lists(i)), 'as many values as orders has ('//integer_text(size(orders))// &
                                 ') are needed', faults)
      end do
      do i = 2, size(orders)
         if (any(.not. abs(orders(:i - 1) - orders(i)) > 0.0_dp)) then
            call input%add_fault('shaft', 'orders', 'order '//real_text(orders(i))//' stands there twice', faults)
            return
         end if
      end do
   end subroutine check_shaft

end module gear_checker
