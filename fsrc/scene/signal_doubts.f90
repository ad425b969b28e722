!> What is odd about a recorded signal though it can be read: drop-outs and spikes of the instrument, accelerations that no machine has,
!> cycles that are no good repetitions.
module signal_doubts
   use constants, only: pi
   use csv_signal, only: least_samples, recording_t
   use key_table, only: find_key, keys
   use kinds, only: dp
   use odd_numbers, only: largest_swing
   use recording_command, only: command_of_cycle
   use scene_input, only: scene_input_t
   use scene_types, only: excitation_table_t
   use signal_cycles, only: cycle_scatter, mean_cycle
   use signal_outliers, only: find_runs, find_spikes, outlier_t
   use text, only: counted, integer_text, printable, short_text
   use word_list, only: word_t
   implicit none(type, external)
   private

   !> Codes of signal_kind, in the order of the key table
   integer, parameter :: kind_acceleration = 1, kind_speed = 2, kind_speed_rpm = 3, a_force = 0

   public :: doubts_of_samples, doubts_of_run_up, cause_of_scatter

contains

   !> What single samples of a recording make one doubt, a line each.
   function doubts_of_samples(input, group, path, recording, cycles) result(lines)
      type(scene_input_t), intent(in) :: input
      !> 'load' or 'shaft'
      character(*), intent(in) :: group
      !> Path of the file
      character(*), intent(in) :: path
      !> Of whole cycles
      type(recording_t), intent(in) :: recording
      integer, intent(in) :: cycles
      type(word_t), allocatable :: lines(:)
      type(outlier_t), allocatable :: spikes(:), runs(:), stops(:)
      character(6), parameter :: units(0:3) = [character(6) :: 'N', 'rad/s2', 'rad/s', '1/min']
      character(:), allocatable :: unit
      integer :: kind, length, i

      kind = a_force
      if (group == 'shaft') kind = input%choice('shaft.signal_kind')
      unit = ' '//trim(units(kind))
      allocate (lines(0))
      length = size(recording%samples)/cycles
      allocate (spikes, source=find_spikes(recording%samples, length, .true.))
      allocate (runs, source=find_runs(recording%samples, length, kind >= kind_speed))
      allocate (stops(0))
      if (kind >= kind_speed) stops = stops_of_speed(recording%samples)
      ! What stops is reported once.
      spikes = pack(spikes, [(.not. any(stops%first <= spikes(i)%first .and. spikes(i)%first <= stops%last), i=1, size(spikes))])
      runs = pack(runs, [(.not. any(stops%first <= runs(i)%first .and. runs(i)%first <= stops%last), i=1, size(runs))])
      call add(stops, 'reaches')
      call add(spikes, 'stands alone at')
      call add(runs, 'jumps to')
      if (size(lines) > 0) return
      call add_impossible(recording, kind, input%number('shaft.speed_rpm'), input%count('shaft.cycle_revolutions'), length, &
                          unit, printable(path, .false.), lines)

   contains

      !> Add the first of some outliers, and how many there are.
      subroutine add(outliers, what)
         type(outlier_t), intent(in) :: outliers(:)
         !> What the value is, before it
         character(*), intent(in) :: what
         character(:), allocatable :: words, lasting
         integer :: count

         if (size(outliers) == 0) return
         associate (one => outliers(1))
            count = modulo(one%last - one%first, size(recording%samples)) + 1
            lasting = ''
            if (count > 1) lasting = ' for '//counted(count, 'sample')//', to line '//integer_text(recording%lines(one%last))
            words = "column '"//recording%column//"' "//what//' '//short_text(one%value, 6)//unit//lasting//'; '// &
                    'its neighbours are '//short_text(one%before, 6)//unit//' before and '// &
                    short_text(one%behind, 6)//unit//' behind'
            if (size(outliers) > 1) words = words//', and so '//counted(size(outliers) - 1, 'further time')
            lines = [lines, word_t('warning: '//printable(path, .false.)//':'//integer_text(recording%lines(one%first))//': '// &
                                   words//': a drop-out or spike of the instrument? '// &
                                   command_of_cycle(input, group, path, '--mend')//' mends it')]
         end associate
      end subroutine add

   end function doubts_of_samples

   !> What single rows of a run-up make one doubt, a line each: accelerations that stand alone, or that no machine has at this speed.
   function doubts_of_run_up(path, file_lines, table) result(lines)
      !> Path of the file
      character(*), intent(in) :: path
      !> Line of each row
      integer, intent(in) :: file_lines(:)
      !> The run-up
      type(excitation_table_t), intent(in) :: table
      type(word_t), allocatable :: lines(:)
      real(dp), parameter :: unit = pi/30.0_dp
      type(outlier_t), allocatable :: spikes(:)
      character(:), allocatable :: order
      real(dp), allocatable :: limits(:)
      integer :: i, row

      allocate (lines(0), spikes(0))
      allocate (limits, source=largest_swing*(unit*table%speeds)**2)
      do i = 1, size(table%orders)
         order = 'acceleration of order '//short_text(table%orders(i), 3)//': '
         associate (accelerations => table%accelerations(:, i))
            spikes = find_spikes(accelerations, size(accelerations), .false.)
            if (size(spikes) > 0) call add(spikes(1)%first, order//short_text(spikes(1)%value, 5)// &
                                           ' rad/s2 stands alone between '//short_text(spikes(1)%before, 5)//' and '// &
                                           short_text(spikes(1)%behind, 5)// &
                                           ' rad/s2: a drop-out or spike of the measurement?')
            row = maxloc(accelerations/limits, dim=1)
            if (accelerations(row) > limits(row)) call add(row, order//short_text(accelerations(row), 5)// &
               ' rad/s2 is not what machines have at this speed ('//short_text(limits(row), 3)//' rad/s2 at most)')
         end associate
      end do

   contains

      subroutine add(row_of_table, words)
         integer, intent(in) :: row_of_table
         character(*), intent(in) :: words

         lines = [lines, word_t('warning: '//printable(path, .false.)//':'//integer_text(file_lines(row_of_table))//': '//words)]
      end subroutine add

   end function doubts_of_run_up

   !> Where a speed is zero or below that is no speed of a machine that stops, nor one without its mean.
   pure function stops_of_speed(speeds) result(stops)
      real(dp), intent(in) :: speeds(:)
      type(outlier_t), allocatable :: stops(:)
      real(dp), parameter :: least_mean = 0.25_dp
      real(dp) :: mean, deviation
      integer :: n, i, first, step
      logical, allocatable :: turns(:)

      allocate (stops(0))
      n = size(speeds)
      mean = sum(speeds/real(n, dp))
      deviation = sqrt(sum((speeds - mean)**2/real(n, dp)))
      allocate (turns, source=speeds > 0.0_dp)
      if (2*count(turns) <= n .or. mean < least_mean*deviation) return
      do first = 1, n
         if (turns(first)) cycle
         if (first > 1) then
            if (.not. turns(first - 1)) cycle
         end if
         i = first + findloc([turns(first:), .true.], .true., dim=1) - 2
         stops = [stops, outlier_t(first, i, speeds(first))]
         ! The nearest that turn may be those of the cycle before and behind.
         do step = 1, n
            stops(size(stops))%before = speeds(modulo(first - 1 - step, n) + 1)
            if (stops(size(stops))%before > 0.0_dp) exit
         end do
         do step = 1, n
            stops(size(stops))%behind = speeds(modulo(i - 1 + step, n) + 1)
            if (stops(size(stops))%behind > 0.0_dp) exit
         end do
      end do
   end function stops_of_speed

   !> Add the largest sample, or of a speed the largest step, that is more than machines have.
   subroutine add_impossible(recording, kind, speed_rpm, revolutions, length, unit, path, lines)
      type(recording_t), intent(in) :: recording
      integer, intent(in) :: kind
      real(dp), intent(in) :: speed_rpm
      !> Revolutions and samples of a cycle
      integer, intent(in) :: revolutions
      integer, intent(in) :: length
      character(*), intent(in) :: unit
      character(*), intent(in) :: path
      type(word_t), allocatable, intent(inout) :: lines(:)
      character(*), parameter :: names(0:1) = [character(22) :: 'load.force_amplitudes', 'shaft.accelerations']
      real(dp), parameter :: turn_per_minute = pi/30.0_dp
      real(dp), allocatable :: sizes(:)
      real(dp) :: limit
      character(:), allocatable :: words
      integer :: worst

      limit = keys(find_key(trim(names(min(kind, 1)))))%sensible(2)
      allocate (sizes, source=abs(recording%samples))
      if (kind >= kind_speed) sizes = abs(recording%samples - cshift(recording%samples, -1))* &
                                      real(length, dp)*speed_rpm/(60.0_dp*real(revolutions, dp))
      if (kind == kind_speed_rpm) sizes = turn_per_minute*sizes
      worst = maxloc(sizes, dim=1)
      if (.not. sizes(worst) > limit) return
      associate (samples => recording%samples, n => size(recording%samples))
         words = "column '"//recording%column//"': "//short_text(samples(worst), 6)//unit
         if (kind >= kind_speed) words = words//' after '//short_text(samples(modulo(worst - 2, n) + 1), 6)//unit// &
                                         ' is an acceleration of '//short_text(sizes(worst), 3)//' rad/s2, which'
         words = words//' is not what machines have ('//short_text(limit, 2)// &
                 trim(merge(' N     ', ' rad/s2', kind == a_force))//' at most); its neighbours are '// &
                 short_text(samples(modulo(worst - 2, n) + 1), 6)//unit//' and '//short_text(samples(modulo(worst, n) + 1), 6)//unit
      end associate
      lines = [lines, word_t('warning: '//path//':'//integer_text(recording%lines(worst))//': '//words)]
   end subroutine add_impossible

   !> The likely cause of cycles that differ much, as part of a sentence.
   function cause_of_scatter(samples, cycles, drift) result(words)
      !> Of whole cycles
      real(dp), intent(in) :: samples(:)
      integer, intent(in) :: cycles
      !> By how many samples they drift from the first to the last
      real(dp), intent(in) :: drift
      character(:), allocatable :: words
      integer, parameter :: most_cycles = 64
      !> Another count is better if it leaves so much of the scatter
      real(dp), parameter :: better = 0.5_dp
      real(dp), allocatable :: mean(:), levels(:)
      real(dp) :: least, scatter
      integer :: best, other, i

      best = 0
      allocate (mean, source=mean_cycle(samples, cycles))
      least = better*cycle_scatter(samples, mean)
      do other = 2, min(most_cycles, size(samples)/least_samples)
         if (other == cycles .or. modulo(size(samples), other) /= 0) cycle
         mean = mean_cycle(samples, other)
         if (.not. maxval(mean) > minval(mean)) cycle
         scatter = cycle_scatter(samples, mean)
         if (scatter >= least) cycle
         least = scatter
         best = other
      end do
      allocate (levels, source=[(sum(samples(i:i + size(samples)/cycles - 1))*real(cycles, dp)/real(size(samples), dp), &
                 i=1, size(samples), size(samples)/cycles)])
      mean = mean_cycle(samples, cycles)
      if (best > 0) then
         words = 'while '//integer_text(best)//' cycles would differ by '//short_text(100.0_dp*least, 2)// &
                 ' %: is a cycle '//short_text(real(cycles, dp)/real(best, dp), 3)//' times as long?'
      else if (abs(drift) > 0.0_dp) then
         words = 'and from the first to the last they drift by '//short_text(abs(drift), 2)//' samples: did the speed drift?'
      else if (maxval(levels) - minval(levels) > better*(maxval(mean) - minval(mean))) then
         words = 'and their means go from '//short_text(minval(levels), 4)//' to '//short_text(maxval(levels), 4)// &
                 ': did the operating point drift?'
      else if (cycles == 2) then
         words = 'and no other count can be compared: is a cycle twice as long (signal_cycles = 1), or the signal noisy?'
      else
         words = 'and no other count repeats better: is it noisy, or did the operating point change?'
      end if
   end function cause_of_scatter

end module signal_doubts
