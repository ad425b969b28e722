!> Rules of the keys that describe the force.
module force_checker
   use errors, only: fault_list_t
   use kinds, only: dp
   use scene_input, only: scene_input_t
   use text, only: integer_text
   implicit none(type, external)
   private

   public :: check_force

contains

   !> Exactly one way to give the force, lists of one length, and samples that see every order.
   subroutine check_force(input, faults)
      !> Typed values
      type(scene_input_t), intent(in) :: input
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      character(*), parameter :: rule = 'give either force_amplitude, or force_orders with force_amplitudes, or signal'
      character(*), parameter :: lists(3) = [character(16) :: 'force_orders', 'force_amplitudes', 'force_phases']
      character(:), allocatable :: samples, remedy
      real(dp), allocatable :: orders(:)
      logical :: given(3)
      integer :: i, highest

      if (input%is_given('load', 'signal')) return
      given = [(input%is_given('load', trim(lists(i))), i=1, 3)]
      if (.not. any(given)) then
         if (.not. input%is_given('load', 'force_amplitude')) &
            call input%add_fault('load', 'force_amplitude', 'a force is required: '//rule, faults)
         return
      end if
      i = findloc(given, .true., dim=1)
      if (input%is_given('load', 'force_amplitude')) then
         call input%add_fault('load', trim(lists(i)), rule, faults)
         return
      else if (.not. all(given(:2))) then
         call input%add_fault('load', trim(lists(i)), 'force_orders and force_amplitudes are given together', faults)
         return
      end if
      if (any([(input%is_faulty('load', trim(lists(i))), i=1, 3)])) return
      orders = input%numbers('load', 'force_orders')
      do i = 2, 3
         if (given(i) .and. size(input%numbers('load', trim(lists(i)))) /= size(orders)) &
            call input%add_fault('load', trim(lists(i)), 'as many values as force_orders has ('//integer_text(size(orders))// &
                                 ') are needed', faults)
      end do
      if (any(abs(orders - anint(orders)) > 0.0_dp)) then
         call input%add_fault('load', 'force_orders', 'orders are whole numbers; for halves take half the frequency', faults)
         return
      end if
      do i = 2, size(orders)
         if (any(nint(orders(:i - 1)) == nint(orders(i)))) then
            call input%add_fault('load', 'force_orders', 'order '//integer_text(nint(orders(i)))//' stands there twice', faults)
            return
         end if
      end do
      if (input%word('scene', 'task') == 'sweep' .and. input%word('sweep', 'key') == 'force_amplitude') &
         call input%add_fault('sweep', 'key', 'a force of several orders has no force_amplitude; sweep force_scale', faults)
      samples = 'samples_per_period'
      if (input%word('solver', 'method') == 'newmark') samples = 'steps_per_period'
      if (input%is_faulty('solver', samples)) return
      highest = nint(maxval(orders))
      if (input%count('solver', samples) >= 4*highest) return
      remedy = ''
      if (len(input%word('load', 'signal')) > 0) remedy = '; signal_orders keeps fewer'
      call input%add_fault('solver', samples, 'the highest order of the force needs at least '//integer_text(4*highest)//remedy, &
                           faults)
   end subroutine check_force

end module force_checker
