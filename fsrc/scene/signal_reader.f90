!> &load signal and &shaft signal: the mean cycle of a force, or of the motion of the shaft, from a CSV file becomes orders,
!> amplitudes and phases, as if the input gave them.
module signal_reader
   use axis_unit, only: no_axis
   use constants, only: two_pi
   use csv_signal, only: read_csv_signal, recording_t
   use errors, only: fault_list_t
   use fourier, only: trigonometric_interpolation
   use input_path, only: path_of_file
   use key_table, only: find_key
   use keys_in_use, only: in_use
   use kinds, only: dp
   use scene_input, only: scene_input_t
   use scene_types, only: highest_order
   use signal_cycles, only: cycle_scatter, drift_of_cycles, fault_of_cycle, mean_cycle
   use signal_span, only: count_cycles
   use text, only: counted, integer_text, printable, real_text, short_text
   use word_list, only: word_t
   implicit none(type, external)
   private

   character(*), parameter :: force_keys(5) = [character(17) :: 'force_orders', 'force_amplitudes', 'force_phases', &
                                               'force_mean', 'force_amplitude'], &
                              motion_keys(4) = [character(17) :: 'orders', 'accelerations', 'phases', 'speed_amplitudes'], &
                              signal_keys(6) = [character(17) :: 'signal', 'signal_column', 'signal_orders', 'signal_cycles', &
                                                'signal_kind', 'cycle_revolutions']
   !> Codes of signal_kind, in the order of the key table: 2 is a speed in rad/s.
   integer, parameter :: kind_acceleration = 1, kind_speed_rpm = 3

   public :: take_signal

contains

   !> Put what the signal of a group gives into its keys, and the keys of the signal away.
   subroutine take_signal(input, group, notes, faults)
      !> Typed values
      type(scene_input_t), intent(inout) :: input
      !> 'load' or 'shaft'
      character(*), intent(in) :: group
      !> A line on what was made of the signal is appended
      type(word_t), allocatable, intent(inout) :: notes(:)
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      character(len(force_keys)), allocatable :: shape_keys(:), keys(:)
      type(recording_t) :: recording
      real(dp), allocatable :: samples(:), orders(:), amplitudes(:), phases(:), forces(:)
      character(:), allocatable :: path, unit, fate, what, told, amplitude_key
      real(dp) :: mean, dropped, scatter
      integer :: i, before, last, cycles

      allocate (shape_keys(merge(size(force_keys), size(motion_keys), group == 'load')))
      shape_keys(:4) = motion_keys
      if (group == 'load') shape_keys = force_keys
      what = trim(merge('the force ', 'the motion', group == 'load'))
      keys = signal_keys(:merge(4, 6, group == 'load'))
      if (.not. input%is_given(group, 'signal')) then
         do i = 2, size(keys)
            if (input%is_given(group, trim(keys(i)))) &
               call input%add_fault(group, trim(keys(i)), 'this key is used only with signal; leave it out', faults)
            input%entries(find_key(group, trim(keys(i))))%present = .false.
         end do
         return
      end if
      before = faults%count()
      do i = 1, size(shape_keys)
         if (input%is_given(group, trim(shape_keys(i)))) call input%add_fault(group, trim(shape_keys(i)), &
            'the signal gives '//what//'; leave this key or the signal out', faults)
      end do
      if (.not. in_use(input, find_key(group, 'signal'))) return
      ! Until the signal is read no rule is held against what it gives.
      if (group == 'shaft') input%entries([(find_key(group, trim(shape_keys(i))), i=1, 2)])%given = .true.
      if (group == 'shaft') input%entries([(find_key(group, trim(shape_keys(i))), i=1, 2)])%faulty = .true.
      if (any([(input%is_faulty(group, trim(keys(i))), i=1, size(keys))])) return
      path = path_of_file(input, group, 'signal', faults)
      if (len(path) == 0) return
      call read_csv_signal(path, input%word(group, 'signal_column'), recording, faults)
      if (faults%count() == before) call count_cycles(input, group, path, recording, cycles, told, faults)
      ! A cycle that is not known is so by a fault of the input, which is told in its place.
      if (faults%count() > before .or. cycles == 0) return
      call average()
      if (faults%count() > before) return
      call trigonometric_interpolation(samples, mean, amplitudes, phases)
      orders = [(real(i, dp), i=1, size(amplitudes))]
      ! The force of each order, by a factor.
      forces = amplitudes
      unit = ' N'
      fate = 'is added to steady_force'
      amplitude_key = shape_keys(2)
      if (group == 'shaft') call shaft_motion()
      if (.not. maxval(forces) > 0.0_dp) then
         call faults%add(path, 0, '', '', 'it has too few samples to be differentiated')
         return
      end if
      last = kept_orders()
      dropped = dropped_share(last)
      notes = [notes, note()]
      if (cycles > 1) call input%tell(group//'.signal_cycles = '//integer_text(cycles))
      if (cycles > 1) call input%tell(group//'.signal_scatter = '//short_text(scatter, 5))
      call put(shape_keys(1), orders(:last))
      call put(amplitude_key, amplitudes(:last))
      call put(shape_keys(3), phases(:last))
      if (group == 'load') then
         associate (entry => input%entries(find_key('load', 'force_mean')))
            entry%given = .true.
            entry%present = .true.
            entry%number = mean
         end associate
      end if
      do i = 1, size(keys)
         associate (entry => input%entries(find_key(group, trim(keys(i)))))
            entry%given = .false.
            entry%present = .false.
         end associate
      end do

   contains

      !> From the recording to its mean cycle, which must be one, and of which the cycles must be repetitions.
      subroutine average()
         !> What a mean of the cycles may be uncertain by, of what it is; and what they may drift by [samples]
         real(dp), parameter :: most_uncertain = 0.5_dp, most_drift = 0.5_dp
         character(:), allocatable :: message, words
         real(dp) :: drift

         samples = mean_cycle(recording%samples, cycles)
         message = ''
         if (cycles > 1) then
            ! Of cycles that cancel each other nothing oscillates.
            scatter = huge(1.0_dp)
            if (maxval(samples) > minval(samples)) scatter = cycle_scatter(recording%samples, samples)
            drift = drift_of_cycles(recording%samples, samples)
            words = 'its '//integer_text(cycles)//' cycles ('//told//') '
            if (scatter > most_uncertain*sqrt(real(cycles, dp))) then
               message = words//'are no repetitions: their rms deviation from their mean is '//short_text(scatter, 3)// &
                         ' times the rms of what oscillates of it, at most '// &
                         short_text(most_uncertain*sqrt(real(cycles, dp)), 3)//' is allowed; '//cycle_keys()
            else if (abs(drift) > most_drift) then
               message = words//'do not line up: from the first to the last they drift by '//short_text(abs(drift), 3)// &
                         ' of '//integer_text(size(samples))//' samples, half a sample is allowed; '//cycle_keys()
            end if
         end if
         if (len(message) == 0) message = fault_of_cycle(samples, recording%axis_unit%kind == no_axis .and. cycles == 1)
         if (len(message) > 0) call faults%add(path, recording%lines(size(recording%lines)), '', '', message)
      end subroutine average

      !> The keys that say what a cycle is.
      function cycle_keys() result(words)
         character(:), allocatable :: words

         words = 'signal_cycles and '//trim(merge('frequency        ', 'cycle_revolutions', group == 'load'))// &
                 ' say what a cycle is'
      end function cycle_keys

      !> From the signal of a shaft to the amplitudes of its angular acceleration or speed. A speed is differentiated where the
      !> scene is derived, at the speed_rpm that it has there.
      subroutine shaft_motion()
         orders = orders/real(input%count('shaft', 'cycle_revolutions'), dp)
         unit = ' rad/s2'
         fate = 'is left out'
         if (input%choice('shaft', 'signal_kind') == kind_acceleration) return
         input%entries(find_key('shaft', 'accelerations'))%given = .false.
         input%entries(find_key('shaft', 'accelerations'))%faulty = .false.
         amplitude_key = 'speed_amplitudes'
         amplitudes = amplitudes*merge(two_pi/60.0_dp, 1.0_dp, input%choice('shaft', 'signal_kind') == kind_speed_rpm)
         ! Of the order at half the samples the signs alone are known, not its phase.
         if (modulo(size(samples), 2) == 0) amplitudes(size(amplitudes)) = 0.0_dp
         forces = amplitudes*orders
         unit = ' rad/s'
         if (input%choice('shaft', 'signal_kind') == kind_speed_rpm) unit = ' 1/min'
         fate = 'is replaced by speed_rpm'
      end subroutine shaft_motion

      !> How many orders are kept: what was asked for, or what holds nearly all of the power.
      integer function kept_orders()
         real(dp), parameter :: most_dropped = 1.0e-6_dp

         if (input%is_given(group, 'signal_orders')) then
            kept_orders = min(input%count(group, 'signal_orders'), size(amplitudes))
            return
         end if
         do kept_orders = 1, min(size(amplitudes), highest_order) - 1
            if (dropped_share(kept_orders) <= most_dropped) return
         end do
      end function kept_orders

      !> Share of the power of what oscillates that lies beyond an order [-].
      real(dp) function dropped_share(kept)
         integer, intent(in) :: kept

         dropped_share = sum((forces(kept + 1:)/maxval(forces))**2)/sum((forces/maxval(forces))**2)
      end function dropped_share

      !> What was made of the signal.
      type(word_t) function note()
         character(:), allocatable :: words

         words = ''
         if (cycles > 1) words = 'in '//integer_text(cycles)//' cycles of '//integer_text(size(samples))// &
                                 ', whose rms deviation from their mean is '//short_text(100.0_dp*scatter, 3)// &
                                 ' % of the rms of what oscillates of it; '
         note%text = 'signal '//printable(path, .false.)//", column '"//recording%column//"': "// &
                     integer_text(size(recording%samples))//' samples; '//words//what_is_kept()//order_text(1)//' to '// &
                     order_text(last)//' are kept, '// &
                     short_text(100.0_dp*dropped, 2)//' % of its power is dropped; its mean of '//short_text(mean, 5)// &
                     unit//' '//fate//'; '//counted(cycles, 'cycle')//': '//told
      end function note

      !> Whole numbers over a force are harmonics of its frequency; over a motion of the shaft they are engine orders.
      pure function what_is_kept() result(words)
         character(:), allocatable :: words

         words = 'harmonics '
         if (group == 'shaft') words = 'engine orders '
      end function what_is_kept

      pure function order_text(i) result(words)
         integer, intent(in) :: i
         character(:), allocatable :: words

         words = real_text(orders(i))
         if (words(max(1, len(words) - 1):) == '.0') words = words(:len(words) - 2)
      end function order_text

      !> Give a list its numbers, at the place of the signal.
      subroutine put(name, numbers)
         character(*), intent(in) :: name
         real(dp), intent(in) :: numbers(:)

         associate (entry => input%entries(find_key(group, name)), signal => input%entries(find_key(group, 'signal')))
            entry%given = .true.
            entry%present = .true.
            entry%faulty = .false.
            entry%file = signal%file
            entry%line = signal%line
            entry%numbers = numbers
         end associate
      end subroutine put

   end subroutine take_signal

end module signal_reader
