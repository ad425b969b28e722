!> Rules of the keys that describe the force, in &load or by &gear and &shaft. What contact and orders of gears must be is known
!> when these are derived.
module force_checker
   use kinds, only: dp
   use scene_input, only: scene_input_t
   use text, only: integer_text, real_text
   implicit none(type, external)
   private

   public :: check_force, check_gear, check_shaft

contains

   !> Exactly one way to give the force, lists of one length, and samples that see every order.
   subroutine check_force(input)
      !> Typed values
      type(scene_input_t), intent(inout) :: input
      character(*), parameter :: rule = 'give either force_amplitude, or force_orders with force_amplitudes, or signal'
      character(*), parameter :: lists(3) = [character(16) :: 'force_orders', 'force_amplitudes', 'force_phases']
      character(:), allocatable :: samples, remedy
      real(dp), allocatable :: orders(:)
      logical :: given(3)
      integer :: i, highest

      if (input%is_given('load.signal')) return
      given = [(input%is_given('load.'//lists(i)), i=1, 3)]
      if (.not. any(given)) then
         if (.not. input%is_given('load.force_amplitude')) &
            call input%refuse('load.force_amplitude', 'a force is required: '//rule)
         return
      end if
      i = findloc(given, .true., dim=1)
      if (input%is_given('load.force_amplitude')) then
         call input%refuse('load.'//lists(i), rule)
         return
      else if (.not. all(given(:2))) then
         call input%refuse('load.'//lists(i), 'force_orders and force_amplitudes are given together')
         return
      end if
      if (any([(input%is_faulty('load.'//lists(i)), i=1, 3)])) return
      orders = input%numbers('load.force_orders')
      call check_lengths(input, 'load', lists)
      if (any(abs(orders - anint(orders)) > 0.0_dp)) then
         call input%refuse('load.force_orders', 'harmonics are whole numbers; for halves take half the frequency')
         return
      end if
      do i = 2, size(orders)
         if (any(nint(orders(:i - 1)) == nint(orders(i)))) then
            call input%refuse('load.force_orders', 'harmonic '//integer_text(nint(orders(i)))//' is given twice')
            return
         end if
      end do
      if (input%word('scene.task') == 'sweep' .and. input%word('sweep.key') == 'force_amplitude') &
         call input%refuse('sweep.key', 'a force of several harmonics has no force_amplitude; sweep force_scale')
      samples = 'samples_per_period'
      if (input%word('solver.method') == 'newmark') samples = 'steps_per_period'
      if (input%is_faulty('solver.'//samples)) return
      highest = nint(maxval(orders))
      if (input%count('solver.'//samples) >= 4*highest) return
      remedy = ''
      if (len(input%word('load.signal')) > 0) remedy = '; signal_orders keeps fewer'
      call input%refuse('solver.'//samples, 'the highest harmonic of the force needs at least '//integer_text(4*highest)//remedy)
   end subroutine check_force

   !> Speed and force need the shaft, the drag is known in one way, and what belongs together stands together.
   subroutine check_gear(input)
      !> Typed values
      type(scene_input_t), intent(inout) :: input
      character(*), parameter :: with_oil(2) = [character(21) :: 'drag_table', 'bearing_mean_diameter'], &
                                 cone_keys(3) = [character(21) :: 'synchroniser_diameter', 'synchroniser_width', &
                                                 'synchroniser_gap']
      integer :: i, cones

      if (.not. input%has_group('shaft')) call input%faults%add(input%file, 0, 'shaft', '', &
                                                         'this group is required where &gear stands: it drives the gears')
      if (.not. any([input%is_given('gear.drag_torque'), input%is_given('gear.drag_table'), &
                     input%is_given('gear.bearing_mean_diameter')])) &
         call input%refuse('gear.drag_torque', 'the drag on the loose gear is required: give exactly one of drag_torque; '// &
                           'drag_table; bearing_mean_diameter, from which it is computed')
      do i = 1, 2
         if (input%is_given('gear.'//with_oil(i)) .and. .not. input%has_group('oil')) &
            call input%refuse('gear.'//with_oil(i), 'it needs the temperature of the oil: give &oil')
      end do
      call check_both(input, ['tip_diameter_1', 'tip_diameter_2'])
      call check_both(input, [character(17) :: 'bearing_width', 'bearing_clearance'])
      if (input%is_faulty('gear.synchroniser_cones')) return
      cones = input%count('gear.synchroniser_cones')
      do i = 1, size(cone_keys)
         if (cones > 0 .and. .not. (input%is_given('gear.'//cone_keys(i)) .or. &
                                    input%is_faulty('gear.'//cone_keys(i)))) &
            call input%refuse('gear.'//cone_keys(i), 'this key is required where synchroniser_cones > 0')
         if (cones == 0 .and. input%is_given('gear.'//cone_keys(i)) .and. &
             input%is_given('gear.bearing_mean_diameter')) &
            call input%refuse('gear.'//cone_keys(i), 'this key is used only with synchroniser_cones > 0; leave it out')
      end do
   end subroutine check_gear

   !> Two keys of a gear stand together or not at all.
   subroutine check_both(input, names)
      type(scene_input_t), intent(inout) :: input
      character(*), intent(in) :: names(2)
      integer :: i

      do i = 1, 2
         if (input%is_given('gear.'//names(i)) .and. .not. input%is_given('gear.'//trim(names(3 - i)))) &
            call input%refuse('gear.'//names(i), 'give both '//trim(names(1))//' and '//trim(names(2)))
      end do
   end subroutine check_both

   !> The shaft drives gears, and its lists are of one length.
   subroutine check_shaft(input)
      !> Typed values
      type(scene_input_t), intent(inout) :: input
      character(*), parameter :: lists(4) = [character(16) :: 'orders', 'phases', 'accelerations', 'speed_amplitudes'], &
                                 rule = 'give either accelerations or speed_amplitudes with orders, or signal, or table'
      real(dp), allocatable :: orders(:)
      integer :: i

      if (.not. input%has_group('gear')) call input%faults%add(input%file, 0, 'gear', '', &
                                                        'this group is required where &shaft stands: it says what is driven')
      if (any([(input%is_faulty('shaft.'//lists(i)), i=1, size(lists))])) return
      if (input%is_given('shaft.table') .or. input%is_faulty('shaft.table')) return
      call check_speed_range(input)
      if (input%is_given('shaft.accelerations') .and. input%is_given('shaft.speed_amplitudes')) then
         call input%refuse('shaft.speed_amplitudes', rule)
      else if (.not. (input%is_given('shaft.accelerations') .or. input%is_given('shaft.speed_amplitudes'))) then
         call input%refuse('shaft.accelerations', 'a motion of the shaft is required: '//rule)
      end if
      if (.not. input%is_given('shaft.orders')) return
      allocate (orders, source=input%numbers('shaft.orders'))
      call check_lengths(input, 'shaft', lists)
      do i = 2, size(orders)
         if (any(.not. abs(orders(:i - 1) - orders(i)) > 0.0_dp)) then
            call input%refuse('shaft.orders', 'engine order '//real_text(orders(i))//' is given twice')
            return
         end if
      end do
   end subroutine check_shaft

   !> The speeds for which a motion was measured are two, ascending.
   subroutine check_speed_range(input)
      type(scene_input_t), intent(inout) :: input
      real(dp), allocatable :: ends(:)

      if (.not. input%is_given('shaft.signal_speed_range') .or. input%is_faulty('shaft.signal_speed_range')) return
      allocate (ends, source=input%numbers('shaft.signal_speed_range'))
      if (size(ends) == 2) then
         if (ends(1) <= ends(2)) return
      end if
      call input%refuse('shaft.signal_speed_range', 'the lowest and the highest speed are needed, in this order: two values')
   end subroutine check_speed_range

   !> Every list has as many values as the first.
   subroutine check_lengths(input, group, lists)
      !> Typed values
      type(scene_input_t), intent(inout) :: input
      !> Group and names of the lists, of which the first is given
      character(*), intent(in) :: group
      character(*), intent(in) :: lists(:)
      integer :: i, count

      count = size(input%numbers(group//'.'//lists(1)))
      do i = 2, size(lists)
         if (input%is_given(group//'.'//lists(i)) .and. size(input%numbers(group//'.'//lists(i))) /= count) &
            call input%refuse(group//'.'//lists(i), 'as many values as '//trim(lists(1))//' has ('//integer_text(count)// &
                              ') are needed')
      end do
   end subroutine check_lengths

end module force_checker
