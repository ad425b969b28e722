!> &load signal and &shaft signal: the mean cycle of a force, or of the motion of the shaft, from a CSV file becomes orders,
!> amplitudes and phases, as if the input gave them.
module signal_reader
   use column_head, only: no_axis
   use constants, only: two_pi
   use csv_signal, only: read_csv_signal, recording_t
   use fourier, only: trigonometric_interpolation
   use key_table, only: find_key
   use keys_in_use, only: in_use
   use kinds, only: dp
   use recording_command, only: command_of_cycle
   use scene_input, only: scene_input_t
   use scene_types, only: highest_order
   use signal_cycles, only: cycle_scatter, drift_of_cycles, fault_of_cycle, mean_cycle
   use signal_doubts, only: cause_of_scatter, doubts_of_samples
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
   !> Share of the power at half the samples, from which on they are too few
   real(dp), parameter :: much_at_half = 0.01_dp

   !> What is made of a signal.
   type :: signal_t
      !> 'load' or 'shaft'
      character(:), allocatable :: group
      character(:), allocatable :: path
      type(recording_t) :: recording
      !> Cycles of the recording, and how they are known
      integer :: cycles = 0
      character(:), allocatable :: counted_by
      !> Root mean square by which the cycles differ from their mean, over that of what oscillates of it
      real(dp) :: scatter = 0.0_dp
      !> The mean cycle
      real(dp), allocatable :: samples(:)
      !> What is odd about it, a line each
      type(word_t), allocatable :: doubts(:)
      !> Its mean, and of each order amplitude and phase; and what is like the force of each, by a factor
      real(dp) :: mean = 0.0_dp
      real(dp), allocatable :: orders(:), amplitudes(:), phases(:), forces(:)
      !> Orders of which samples show amplitude and phase, and the share of the power at half the samples, whose phase they do not
      integer :: shown_orders = 0
      real(dp) :: share_at_half = 0.0_dp
      !> Key of the amplitudes, their unit, and what becomes of the mean
      character(:), allocatable :: amplitude_key, unit, fate
   end type signal_t

   public :: take_signal

contains

   !> Put what the signal of a group gives into its keys, and the keys of the signal away.
   subroutine take_signal(input, group, notes)
      !> Typed values
      type(scene_input_t), intent(inout) :: input
      !> 'load' or 'shaft'
      character(*), intent(in) :: group
      !> A line on what was made of the signal is appended
      type(word_t), allocatable, intent(inout) :: notes(:)
      character(len(force_keys)), allocatable :: shape_keys(:), keys(:)
      type(signal_t) :: signal
      integer :: i, before, last

      allocate (shape_keys, source=motion_keys)
      if (group == 'load') shape_keys = force_keys
      keys = signal_keys(:merge(4, 6, group == 'load'))
      if (.not. input%is_given(group//'.signal')) then
         do i = 2, size(keys)
            if (input%is_given(group//'.'//keys(i))) &
               call input%refuse(group//'.'//keys(i), 'this key is used only with signal; leave it out')
            input%entries(find_key(group//'.'//keys(i)))%present = .false.
         end do
         return
      end if
      before = input%faults%count()
      do i = 1, size(shape_keys)
         if (input%is_given(group//'.'//shape_keys(i))) call input%refuse(group//'.'//shape_keys(i), 'the signal gives '// &
            trim(merge('the force ', 'the motion', group == 'load'))//'; leave this key or the signal out')
      end do
      if (.not. in_use(input, find_key(group//'.signal'))) return
      call read_signal(input, group, shape_keys(:2), keys, signal)
      ! A count of cycles that is not known is so by a fault of the input, which stands in its place.
      if (input%faults%count() > before .or. signal%cycles == 0) return
      call average_cycles(input, signal)
      if (input%faults%count() > before) return
      call find_orders(input, signal)
      if (.not. maxval(signal%forces) > 0.0_dp) then
         call input%faults%add(signal%path, 0, '', '', 'it has too few samples to be differentiated')
         return
      end if
      if (asks_for_more(input, signal)) return
      last = kept_orders(input, signal)
      notes = [notes, note_of(signal, last), signal%doubts, doubt_of_limit(signal, last)]
      if (group == 'shaft') call tell_measured_speed(input, signal)
      if (signal%cycles > 1) call input%report(group//'.signal_cycles = '//integer_text(signal%cycles))
      if (signal%cycles > 1) call input%report(group//'.signal_scatter = '//short_text(signal%scatter, 5))
      call put(input, group, shape_keys(1), signal%orders(:last))
      call put(input, group, signal%amplitude_key, signal%amplitudes(:last))
      call put(input, group, shape_keys(3), signal%phases(:last))
      if (group == 'load') then
         associate (entry => input%entries(find_key('load.force_mean')))
            entry%given = .true.
            entry%present = .true.
            entry%number = signal%mean
         end associate
      end if
      do i = 1, size(keys)
         input%entries(find_key(group//'.'//keys(i)))%given = .false.
         input%entries(find_key(group//'.'//keys(i)))%present = .false.
      end do
   end subroutine take_signal

   !> Read the recording and count its cycles; none where the input or the file has a fault.
   subroutine read_signal(input, group, shape_keys, keys, signal)
      type(scene_input_t), intent(inout) :: input
      character(*), intent(in) :: group
      !> Keys of the orders and their amplitudes
      character(*), intent(in) :: shape_keys(2)
      !> Keys of the signal
      character(*), intent(in) :: keys(:)
      type(signal_t), intent(inout) :: signal
      integer :: i, before

      ! Until the signal is read no rule is applied to what it gives.
      if (group == 'shaft') input%entries([(find_key(group//'.'//shape_keys(i)), i=1, 2)])%given = .true.
      if (group == 'shaft') input%entries([(find_key(group//'.'//shape_keys(i)), i=1, 2)])%faulty = .true.
      if (any([(input%is_faulty(group//'.'//keys(i)), i=1, size(keys))])) return
      signal%group = group
      allocate (signal%doubts(0))
      signal%path = input%file_path(group//'.signal')
      if (len(signal%path) == 0) return
      before = input%faults%count()
      call read_csv_signal(signal%path, input%word(group//'.signal_column'), unit_of_signal(input, group), '; '// &
                           command_of_cycle(input, group, signal%path)//' may mend it', signal%recording, input%faults)
      if (input%faults%count() == before) &
         call count_cycles(input, group, signal%path, signal%recording, signal%cycles, signal%counted_by)
   end subroutine read_signal

   !> Unit of the numbers of a signal.
   pure function unit_of_signal(input, group) result(unit)
      type(scene_input_t), intent(in) :: input
      character(*), intent(in) :: group
      character(:), allocatable :: unit
      character(*), parameter :: of_kinds(*) = [character(6) :: 'rad/s2', 'rad/s', '1/min']

      unit = 'N'
      if (group == 'shaft') unit = trim(of_kinds(input%choice('shaft.signal_kind')))
   end function unit_of_signal

   !> From the recording to its mean cycle, which must be one, and of which the cycles must be repetitions.
   subroutine average_cycles(input, signal)
      type(scene_input_t), intent(inout) :: input
      type(signal_t), intent(inout) :: signal
      !> What a mean of the cycles may be uncertain by, of what it is; and what they may drift by [samples]
      real(dp), parameter :: most_uncertain = 0.5_dp, most_drift = 0.5_dp, usual_scatter = 0.1_dp
      character(:), allocatable :: message, words, cycle_keys
      real(dp) :: drift, most_scatter

      associate (cycles => signal%cycles, recording => signal%recording)
         signal%samples = mean_cycle(recording%samples, cycles)
         message = ''
         words = ''
         cycle_keys = ''
         if (cycles > 1) then
            ! Of cycles that cancel each other nothing oscillates.
            signal%scatter = huge(1.0_dp)
            if (maxval(signal%samples) > minval(signal%samples)) &
               signal%scatter = cycle_scatter(recording%samples, signal%samples)
            drift = drift_of_cycles(recording%samples, signal%samples)
            most_scatter = most_uncertain*sqrt(real(cycles, dp))
            words = 'its '//integer_text(cycles)//' cycles ('//signal%counted_by//') '
            cycle_keys = 'signal_cycles and '//trim(merge('frequency        ', 'cycle_revolutions', signal%group == 'load'))// &
                         ' say what a cycle is'
            if (signal%scatter > most_scatter) then
               message = words//'are no repetitions: their rms deviation from their mean is '//short_text(signal%scatter, 3)// &
                         ' times the rms of what oscillates of it, at most '//short_text(most_scatter, 3)//' is allowed; '// &
                         cycle_keys
            else if (abs(drift) > most_drift) then
               message = words//'do not line up: from the first to the last they drift by '//short_text(abs(drift), 3)// &
                         ' of '//integer_text(size(signal%samples))//' samples, half a sample is allowed; '//cycle_keys
            end if
         end if
         if (len(message) == 0) message = fault_of_cycle(signal%samples, recording%axis_unit%kind == no_axis .and. cycles == 1)
         signal%doubts = doubts_of_samples(input, signal%group, signal%path, recording, cycles)
         if (len(message) > 0) then
            if (size(signal%doubts) > 0) message = message//'; '//signal%doubts(1)%text
            call input%faults%add(signal%path, recording%lines(size(recording%lines)), '', '', message)
         else if (cycles > 1 .and. signal%scatter > usual_scatter) then
            signal%doubts = [signal%doubts, word_t('warning: '//printable(signal%path, .false.)//': the '//words// &
               'differ: their rms deviation from their mean is '//short_text(100.0_dp*signal%scatter, 3)// &
               ' % of the rms of what oscillates of it, '//cause_of_scatter(recording%samples, cycles, drift)//'; '//cycle_keys)]
         end if
      end associate
   end subroutine average_cycles

   !> Orders, amplitudes and phases of the mean cycle. The signal of a shaft is its angular acceleration or speed; a speed is
   !> differentiated where the scene is derived, at the speed_rpm that it has there.
   subroutine find_orders(input, signal)
      type(scene_input_t), intent(inout) :: input
      type(signal_t), intent(inout) :: signal
      logical :: in_rpm
      integer :: i

      call trigonometric_interpolation(signal%samples, signal%mean, signal%amplitudes, signal%phases)
      signal%orders = [(real(i, dp), i=1, size(signal%amplitudes))]
      signal%forces = signal%amplitudes
      signal%shown_orders = size(signal%amplitudes)
      signal%amplitude_key = 'force_amplitudes'
      signal%unit = ' N'
      signal%fate = 'is added to steady_force'
      if (modulo(size(signal%samples), 2) == 0) signal%share_at_half = dropped_share(signal%forces, size(signal%forces) - 1)
      if (signal%group == 'load') return
      signal%orders = signal%orders/real(input%count('shaft.cycle_revolutions'), dp)
      signal%amplitude_key = 'accelerations'
      signal%unit = ' rad/s2'
      signal%fate = 'is left out'
      if (input%choice('shaft.signal_kind') == kind_acceleration) return
      input%entries(find_key('shaft.accelerations'))%given = .false.
      input%entries(find_key('shaft.accelerations'))%faulty = .false.
      in_rpm = input%choice('shaft.signal_kind') == kind_speed_rpm
      signal%amplitude_key = 'speed_amplitudes'
      signal%amplitudes = signal%amplitudes*merge(two_pi/60.0_dp, 1.0_dp, in_rpm)
      ! Of the order at half the samples the signs alone are known, not its phase.
      if (modulo(size(signal%samples), 2) == 0) then
         signal%share_at_half = dropped_share(signal%amplitudes*signal%orders, size(signal%amplitudes) - 1)
         signal%amplitudes(size(signal%amplitudes)) = 0.0_dp
         signal%shown_orders = signal%shown_orders - 1
      end if
      signal%forces = signal%amplitudes*signal%orders
      signal%unit = trim(merge(' 1/min', ' rad/s', in_rpm))
      signal%fate = 'is replaced by speed_rpm'
   end subroutine find_orders

   !> Whether more orders are requested than samples show; that is a fault.
   logical function asks_for_more(input, signal)
      type(scene_input_t), intent(inout) :: input
      type(signal_t), intent(in) :: signal
      integer :: asked

      asked = 0
      if (input%is_given(signal%group//'.signal_orders')) asked = input%count(signal%group//'.signal_orders')
      asks_for_more = asked > signal%shown_orders
      if (asks_for_more) call input%refuse(signal%group//'.signal_orders', counted(asked, 'order')//' take '// &
         integer_text(2*asked + 1)//' samples a cycle; the signal has '//integer_text(size(signal%samples))//', which show '// &
         counted(signal%shown_orders, 'order')//'; ask for these, or sample it finer')
   end function asks_for_more

   !> That much of the power is where samples show no phase: there may be more beyond, which they show as something else.
   pure function doubt_of_limit(signal, last) result(lines)
      type(signal_t), intent(in) :: signal
      !> Orders that are kept
      integer, intent(in) :: last
      type(word_t), allocatable :: lines(:)
      character(:), allocatable :: fate

      allocate (lines(0))
      if (signal%share_at_half < much_at_half) return
      fate = 'is left out'
      if (last == size(signal%amplitudes) .and. last == signal%shown_orders) fate = 'is kept with the phase of a cosine'
      lines = [word_t('warning: '//printable(signal%path, .false.)//': '//integer_text(size(signal%samples))// &
                      ' samples a cycle are too few: '//short_text(100.0_dp*signal%share_at_half, 3)//' % of the power that '// &
                      'they show is that of harmonic '//integer_text(size(signal%amplitudes))// &
                      ', of which they show no phase: it '//fate//'; of harmonics beyond they show nothing: sample it finer')]
   end function doubt_of_limit

   !> Between which speeds the motion is one that was measured, unless the input says it: a tenth either way of the speed at which it was,
   !> which is the mean of a speed, and else speed_rpm.
   subroutine tell_measured_speed(input, signal)
      type(scene_input_t), intent(inout) :: input
      type(signal_t), intent(in) :: signal
      real(dp), parameter :: either_way = 0.1_dp, digit = 0.01_dp
      real(dp) :: speed

      if (input%is_given('shaft.signal_speed_range')) return
      speed = input%number('shaft.speed_rpm')
      if (input%choice('shaft.signal_kind') /= kind_acceleration .and. signal%mean > maxval(abs(signal%samples - signal%mean))) then
         speed = signal%mean
         if (input%choice('shaft.signal_kind') /= kind_speed_rpm) speed = speed*60.0_dp/two_pi
      end if
      if (.not. speed > 0.0_dp) return
      call put(input, 'shaft', 'signal_speed_range', &
               anint(speed*[1.0_dp - either_way, 1.0_dp + either_way]/digit)*digit)
   end subroutine tell_measured_speed

   !> How many orders are kept: what was requested, or what holds nearly all of the power.
   pure integer function kept_orders(input, signal)
      type(scene_input_t), intent(in) :: input
      type(signal_t), intent(in) :: signal
      real(dp), parameter :: most_dropped = 1.0e-6_dp

      if (input%is_given(signal%group//'.signal_orders')) then
         kept_orders = input%count(signal%group//'.signal_orders')
         return
      end if
      do kept_orders = 1, min(size(signal%amplitudes), highest_order) - 1
         if (dropped_share(signal%forces, kept_orders) <= most_dropped) return
      end do
   end function kept_orders

   !> Share of the power of what oscillates that lies beyond an order [-].
   pure real(dp) function dropped_share(forces, kept)
      real(dp), intent(in) :: forces(:)
      integer, intent(in) :: kept

      dropped_share = sum((forces(kept + 1:)/maxval(forces))**2)/sum((forces/maxval(forces))**2)
   end function dropped_share

   !> What was made of the signal. Orders of a force are harmonics of its frequency, those of a shaft engine orders.
   type(word_t) function note_of(signal, last) result(note)
      type(signal_t), intent(in) :: signal
      !> Orders that are kept
      integer, intent(in) :: last
      character(:), allocatable :: words, power

      words = ''
      if (signal%cycles > 1) words = 'in '//integer_text(signal%cycles)//' cycles of '//integer_text(size(signal%samples))// &
                                     ', whose rms deviation from their mean is '//short_text(100.0_dp*signal%scatter, 3)// &
                                     ' % of the rms of what oscillates of it; '
      if (signal%recording%jitter > 0.0_dp) words = words//'its time stamps jitter by '// &
         short_text(100.0_dp*signal%recording%jitter, 2)//' % of a step at most and are taken as uniform; '
      if (len(signal%recording%unit_note) > 0) words = words//signal%recording%unit_note//'; '
      ! Of power that samples do not show nothing is said.
      power = short_text(100.0_dp*dropped_share(signal%forces, last), 2)//' % of its power is dropped; its mean of '
      if (signal%share_at_half > much_at_half) power = 'its mean of '
      note%text = 'signal '//printable(signal%path, .false.)//", column '"//signal%recording%column//"': "// &
                  integer_text(size(signal%recording%samples))//' samples; '//words// &
                  trim(merge('harmonics    ', 'engine orders', signal%group == 'load'))//' '//order_text(signal%orders(1))// &
                  ' to '//order_text(signal%orders(last))//' are kept, '//power// &
                  short_text(signal%mean, 5)//signal%unit//' '//signal%fate//'; '//counted(signal%cycles, 'cycle')//': '// &
                  signal%counted_by
   end function note_of

   !> An order, a whole one without a point.
   pure function order_text(order) result(words)
      real(dp), intent(in) :: order
      character(:), allocatable :: words

      words = real_text(order)
      if (words(max(1, len(words) - 1):) == '.0') words = words(:len(words) - 2)
   end function order_text

   !> Give a list its numbers, at the place of the signal.
   subroutine put(input, group, name, numbers)
      type(scene_input_t), intent(inout) :: input
      character(*), intent(in) :: group
      character(*), intent(in) :: name
      real(dp), intent(in) :: numbers(:)

      associate (entry => input%entries(find_key(group//'.'//name)), signal => input%entries(find_key(group//'.signal')))
         entry%given = .true.
         entry%present = .true.
         entry%faulty = .false.
         entry%file = signal%file
         entry%line = signal%line
         entry%numbers = numbers
      end associate
   end subroutine put

end module signal_reader
