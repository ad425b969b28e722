!> How many cycles of a group a recording holds. Its axis is evidence: what it spans is compared with the cycle that the keys of the
!> group give, and what is off by more than half a sample is refused, with both numbers and the key that would mend it.
module signal_span
   use column_head, only: angle_axis, axis_of, axis_unit_t, no_axis, time_axis
   use csv_signal, only: least_samples, recording_t
   use kinds, only: dp
   use recording_command, only: command_of_cycle
   use scene_input, only: scene_input_t
   use text, only: counted, integer_text, short_text
   implicit none(type, external)
   private

   real(dp), parameter :: turn = 360.0_dp

   public :: count_cycles

contains

   !> Count the cycles of a recording.
   subroutine count_cycles(input, group, path, recording, cycles, basis)
      type(scene_input_t), intent(inout) :: input
      !> 'load' or 'shaft'
      character(*), intent(in) :: group
      !> Path of the file
      character(*), intent(in) :: path
      !> At least four samples, on a uniform axis if there is one
      type(recording_t), intent(in) :: recording
      !> 0 if they are not known: then the file has a fault, or the input has one that is reported elsewhere
      integer, intent(out) :: cycles
      !> How they are known, in a few words
      character(:), allocatable, intent(out) :: basis
      type(axis_unit_t) :: unit
      character(:), allocatable :: message
      real(dp) :: length
      integer :: asked

      asked = 0
      if (input%is_given(group//'.signal_cycles')) asked = input%count(group//'.signal_cycles')
      message = ''
      if (recording%axis_unit%kind == no_axis) then
         cycles = max(1, asked)
         basis = 'no axis defines its cycles'
      else
         cycles = 0
         length = cycle_length(input, group, recording%axis_unit%kind)
         if (.not. length > 0.0_dp) return
         call find_unit(recording, length, asked, unit, message)
         if (len(message) == 0) call fit_cycles(input, group, path, recording, unit, length, asked, cycles, message)
         basis = "by its axis '"//recording%axis_name//"' in "//trim(unit%word)
      end if
      associate (count => size(recording%samples))
         if (len(message) == 0 .and. modulo(count, max(1, cycles)) /= 0) then
            message = integer_text(count)//' samples are not '//integer_text(cycles)//' cycles of a whole number each but of '// &
                      plain_number(real(count, dp)/real(cycles, dp))//'; resample it, or give another signal_cycles: '// &
                      command_of_cycle(input, group, path)
         else if (len(message) == 0 .and. count < least_samples*cycles) then
            message = integer_text(count)//' samples are too few for signal_cycles = '//integer_text(cycles)//'; a cycle needs '// &
                      integer_text(least_samples)
         end if
      end associate
      if (len(message) == 0) return
      call input%faults%add(path, 0, '', '', message)
      cycles = 0
   end subroutine count_cycles

   !> What a cycle is by the keys: [s] or [deg]; 0 if they have a fault.
   pure real(dp) function cycle_length(input, group, kind) result(length)
      type(scene_input_t), intent(in) :: input
      character(*), intent(in) :: group
      !> Kind of the axis
      integer, intent(in) :: kind

      length = turn
      if (group == 'shaft') length = turn*real(input%count('shaft.cycle_revolutions'), dp)
      if (kind == angle_axis) return
      length = 0.0_dp
      if (group == 'shaft' .and. input%number('shaft.speed_rpm') > 0.0_dp) then
         length = real(input%count('shaft.cycle_revolutions'), dp)*60.0_dp/input%number('shaft.speed_rpm')
      else if (group == 'load' .and. input%number('load.frequency') > 0.0_dp) then
         length = 1.0_dp/input%number('load.frequency')
      end if
   end function cycle_length

   !> The unit of an axis. One without a unit in its name is of seconds; or of degrees or radians, whichever fits.
   pure subroutine find_unit(recording, length, asked, unit, message)
      type(recording_t), intent(in) :: recording
      !> A cycle [s] or [deg]
      real(dp), intent(in) :: length
      !> Cycles that the input asks for, 0: any
      integer, intent(in) :: asked
      type(axis_unit_t), intent(out) :: unit
      character(:), allocatable, intent(out) :: message

      message = ''
      unit = recording%axis_unit
      if (unit%is_strange) message = "the unit of its axis '"//recording%axis_name// &
                                     "' is not known; known are s, ms, us, min, h, deg, rad and rev"
      if (len_trim(unit%word) > 0 .or. len(message) > 0) return
      unit = axis_of('s', '')
      if (recording%axis_unit%kind == time_axis) return
      unit = axis_of('deg', '')
      if (whole_cycles(recording, axis_of('rad', ''), length, asked) == 0) return
      unit = axis_of('rad', '')
      if (whole_cycles(recording, axis_of('deg', ''), length, asked) > 0) message = "its axis '"//recording%axis_name// &
         "' fits in degrees and in radians; put the unit into its name, as in angle_deg or angle_rad"
   end subroutine find_unit

   !> How many cycles fit the axis.
   subroutine fit_cycles(input, group, path, recording, unit, length, asked, cycles, message)
      type(scene_input_t), intent(in) :: input
      character(*), intent(in) :: group
      character(*), intent(in) :: path
      type(recording_t), intent(in) :: recording
      type(axis_unit_t), intent(in) :: unit
      !> A cycle [s] or [deg]
      real(dp), intent(in) :: length
      integer, intent(in) :: asked
      !> 0 if none do
      integer, intent(out) :: cycles
      !> Why none do; empty if some do
      character(:), allocatable, intent(out) :: message
      integer :: turns

      message = ''
      if (group == 'load' .and. unit%kind == angle_axis) then
         ! No key says how many turns of what a cycle of a force takes: the input says how many cycles there are.
         turns = whole_cycles(recording, unit, length, 0)
         cycles = max(1, asked)
         if (turns == 1 .and. cycles == 1) return
         if (turns > 0 .and. asked > 0 .and. modulo(turns, cycles) == 0) return
         cycles = 0
      else
         cycles = whole_cycles(recording, unit, length, asked)
         if (cycles > 0) return
      end if
      message = span_text(recording, unit)//', '//cycle_text(input, group, unit, length, asked)//'; '// &
                remedy(input, group, path, recording, unit, length, asked)
   end subroutine fit_cycles

   !> How many whole cycles an axis spans, within half a sample; 0 if no number of them, or not the number that is asked for.
   pure integer function whole_cycles(recording, unit, length, asked) result(cycles)
      type(recording_t), intent(in) :: recording
      type(axis_unit_t), intent(in) :: unit
      !> A cycle [s] or [deg]
      real(dp), intent(in) :: length
      !> 0: any number
      integer, intent(in) :: asked

      cycles = cycles_in(size(recording%samples), length/(recording%step*unit%size), asked)
   end function whole_cycles

   !> The same of a number of samples.
   pure integer function cycles_in(samples, per_cycle, asked) result(cycles)
      integer, intent(in) :: samples
      !> Samples a cycle by the keys
      real(dp), intent(in) :: per_cycle
      integer, intent(in) :: asked
      !> Half a sample, and its rounding error
      real(dp), parameter :: most_off = 0.5_dp + 1.0e-6_dp

      cycles = asked
      if (asked == 0) then
         ! Below, there may seem to be more cycles than an integer counts.
         if (per_cycle > 1.0_dp) cycles = nint(real(samples, dp)/per_cycle)
      end if
      if (cycles > samples/least_samples) cycles = 0
      if (abs(real(samples, dp) - real(cycles, dp)*per_cycle) > most_off) cycles = 0
   end function cycles_in

   !> What the axis spans.
   pure function span_text(recording, unit) result(words)
      type(recording_t), intent(in) :: recording
      type(axis_unit_t), intent(in) :: unit
      character(:), allocatable :: words

      associate (count => size(recording%samples))
         words = "its axis '"//recording%axis_name//"' spans "//plain_number(real(count, dp)*recording%step)//' '// &
                 trim(unit%word)//' ('//integer_text(count)//' samples, '//plain_number(recording%step)//' '// &
                 trim(unit%word)//' apart)'
      end associate
   end function span_text

   !> What the keys say a cycle is, in the unit of the axis.
   function cycle_text(input, group, unit, length, asked) result(words)
      type(scene_input_t), intent(in) :: input
      character(*), intent(in) :: group
      type(axis_unit_t), intent(in) :: unit
      !> [s] or [deg]
      real(dp), intent(in) :: length
      integer, intent(in) :: asked
      character(:), allocatable :: words

      words = plain_number(length/unit%size)//' '//trim(unit%word)
      if (asked > 0) words = counted(asked, 'cycle')//' (signal_cycles) of '//words// &
                            ' are '//plain_number(real(asked, dp)*length/unit%size)//' '//trim(unit%word)
      if (asked == 0) words = 'a cycle is '//words
      if (group == 'load' .and. unit%kind == time_axis) then
         words = words//' at frequency = '//plain_number(input%number('load.frequency'))//' Hz'
      else if (group == 'shaft') then
         words = words//' with cycle_revolutions = '//integer_text(input%count('shaft.cycle_revolutions'))
         if (unit%kind == time_axis) words = words//' at speed_rpm = '//plain_number(input%number('shaft.speed_rpm'))
      end if
   end function cycle_text

   !> What would make the axis fit.
   function remedy(input, group, path, recording, unit, length, asked) result(words)
      type(scene_input_t), intent(in) :: input
      character(*), intent(in) :: group
      character(*), intent(in) :: path
      type(recording_t), intent(in) :: recording
      type(axis_unit_t), intent(in) :: unit
      real(dp), intent(in) :: length
      integer, intent(in) :: asked
      character(:), allocatable :: words
      real(dp) :: per_cycle
      integer :: revolutions

      per_cycle = length/(recording%step*unit%size)
      if (repeats_its_start()) then
         words = 'its last sample is where the next cycle begins; leave line '// &
                 integer_text(recording%lines(size(recording%lines)))//' out'
      else if (asked > 0 .and. whole_cycles(recording, unit, length, 0) > 0) then
         words = 'signal_cycles = '//integer_text(whole_cycles(recording, unit, length, 0))//' fits'
         if (group == 'load' .and. unit%kind == angle_axis) words = 'signal_cycles must divide it into whole turns'
      else if (group == 'load' .and. unit%kind == angle_axis) then
         words = 'signal_cycles = 1 if the force repeats only after all of it, more if it repeats within'
         if (whole_cycles(recording, unit, length, 0) == 0) words = 'that is no whole number of turns for signal_cycles: '// &
                                                                    'name the column otherwise if it is no angle of the cycle'
      else if (fits_in('ms')) then
         words = 'if it is in ms, name it time_ms'
      else if (fits_in('us')) then
         words = 'if it is in us, name it time_us'
      else
         ! An engine does not change its speed to suit a record: whole cycles are cut out of it.
         words = 'cut whole cycles out: '//command_of_cycle(input, group, path, option_of_speed())
         if (real(size(recording%samples), dp) < per_cycle) words = 'it holds no whole cycle: '// &
                                                                   'record more than one, or give one over its angle'
         if (group == 'load') return
         revolutions = whole_revolutions()
         if (revolutions > 0) words = 'cycle_revolutions = '//integer_text(revolutions)// &
                                      ' if that is what a cycle of it takes; else '//words
      end if

   contains

      !> Whether the last sample stands where the next cycle begins.
      logical function repeats_its_start()
         real(dp), parameter :: near = 0.1_dp
         integer :: before_last

         before_last = size(recording%samples) - 1
         associate (whole => cycles_in(before_last, per_cycle, asked))
            repeats_its_start = whole > 0 .and. abs(real(before_last, dp) - real(whole, dp)*per_cycle) <= near
         end associate
      end function repeats_its_start

      !> What shows the script the speed of a recording over time; it finds that of a speed itself.
      function option_of_speed() result(option)
         character(:), allocatable :: option

         option = ''
         if (unit%kind == angle_axis) return
         if (group == 'load') then
            option = '--speed-near '//plain_number(60.0_dp*input%number('load.frequency'))
         else if (input%word('shaft.signal_kind') == 'angular_acceleration') then
            option = '--speed-near '//plain_number(input%number('shaft.speed_rpm'))
         end if
      end function option_of_speed

      !> Whether an axis of time without a unit fits in this one.
      logical function fits_in(word)
         character(*), intent(in) :: word

         fits_in = len_trim(recording%axis_unit%word) == 0 .and. unit%kind == time_axis .and. &
                   whole_cycles(recording, axis_of(word, ''), length, asked) > 0
      end function fits_in

      !> Revolutions of a cycle that would fit within half a sample, else 0.
      integer function whole_revolutions()
         real(dp) :: of_one
         integer :: cycles

         of_one = per_cycle/real(input%count('shaft.cycle_revolutions'), dp)
         whole_revolutions = cycles_in(size(recording%samples), of_one, 0)
         cycles = max(1, asked, nint(real(size(recording%samples), dp)/per_cycle))
         if (modulo(whole_revolutions, cycles) /= 0) cycles = max(1, asked)
         if (modulo(whole_revolutions, cycles) /= 0) whole_revolutions = 0
         whole_revolutions = whole_revolutions/cycles
      end function whole_revolutions

   end function remedy

   !> A number of at most seven digits, without zeros at its end.
   pure function plain_number(number) result(words)
      real(dp), intent(in) :: number
      character(:), allocatable :: words
      integer, parameter :: digits = 7

      words = short_text(number, digits)
      if (index(words, '.') == 0 .or. index(words, 'E') > 0) return
      words = words(:verify(words, '0', back=.true.))
      if (words(len(words):) == '.') words = words(:len(words) - 1)
   end function plain_number

end module signal_span
