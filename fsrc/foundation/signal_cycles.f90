!> The mean cycle of a recording of one or several, and how much its cycles differ.
module signal_cycles
   use constants, only: two_pi
   use fourier, only: trigonometric_interpolation
   use kinds, only: dp
   use text, only: short_text
   implicit none(type, external)
   private

   !> A step back to the first sample that is so many times the largest other one is a jump
   real(dp), parameter :: largest_jump = 5.0_dp

   public :: mean_cycle, cycle_scatter, drift_of_cycles, fault_of_cycle

contains

   !> Mean of cycles of as many samples.
   pure function mean_cycle(samples, cycles) result(mean)
      !> Of whole cycles, one after the other
      real(dp), intent(in) :: samples(:)
      integer, intent(in) :: cycles
      real(dp), allocatable :: mean(:)
      integer :: i, length

      if (cycles == 1) then
         mean = samples
         return
      end if
      length = size(samples)/cycles
      allocate (mean(length))
      do i = 1, length
         mean(i) = sum(samples(i::length)/real(cycles, dp))
      end do
   end function mean_cycle

   !> Root mean square of what the cycles are off their mean, by that of what oscillates of the mean [-].
   pure real(dp) function cycle_scatter(samples, mean)
      !> Of whole cycles
      real(dp), intent(in) :: samples(:)
      !> Their mean, not constant
      real(dp), intent(in) :: mean(:)
      real(dp) :: unit, level, deviation
      integer :: i, length

      length = size(mean)
      level = sum(mean/real(length, dp))
      unit = maxval(abs(mean - level))
      deviation = 0.0_dp
      do i = 1, size(samples), length
         deviation = deviation + sum(((samples(i:i + length - 1) - mean)/unit)**2)
      end do
      cycle_scatter = sqrt(deviation/real(size(samples), dp)/(sum(((mean - level)/unit)**2)/real(length, dp)))
   end function cycle_scatter

   !> By how many samples the cycles drift against their mean, from the first to the last: a straight line through the phases of
   !> its largest harmonic. 0 where the cycles are too few for one, or where the drift is not four times what it is uncertain by.
   real(dp) function drift_of_cycles(samples, mean) result(drift)
      !> Of whole cycles
      real(dp), intent(in) :: samples(:)
      !> Their mean, not constant
      real(dp), intent(in) :: mean(:)
      real(dp), parameter :: least_sure = 4.0_dp
      real(dp), allocatable :: amplitudes(:), phases(:), lags(:), middle(:)
      real(dp) :: level, phase, slope, uncertainty
      integer :: i, length, cycles, harmonic

      length = size(mean)
      cycles = size(samples)/length
      drift = 0.0_dp
      if (cycles < 3) return
      call trigonometric_interpolation(mean, level, amplitudes, phases)
      harmonic = maxloc(amplitudes, dim=1)
      phase = phases(harmonic)
      allocate (lags(cycles))
      do i = 1, cycles
         call trigonometric_interpolation(samples((i - 1)*length + 1:i*length), level, amplitudes, phases)
         lags(i) = modulo(phases(harmonic) - phase + 0.5_dp*two_pi, two_pi) - 0.5_dp*two_pi
      end do
      lags = lags*real(length, dp)/(two_pi*real(harmonic, dp))
      middle = [(real(i, dp) - 0.5_dp*real(cycles + 1, dp), i=1, cycles)]
      slope = sum(middle*lags)/sum(middle**2)
      lags = lags - sum(lags)/real(cycles, dp) - slope*middle
      uncertainty = sqrt(sum(lags**2)/real(cycles - 2, dp)/sum(middle**2))
      if (abs(slope) > least_sure*uncertainty) drift = slope*real(cycles - 1, dp)
   end function drift_of_cycles

   !> Why samples are no cycle: behind its last one it goes on with the first. Empty if they may be one.
   pure function fault_of_cycle(samples, may_repeat) result(message)
      !> Four and more
      real(dp), intent(in) :: samples(:)
      !> Whether nothing else shows that the last sample is not the first of the next cycle
      logical, intent(in) :: may_repeat
      character(:), allocatable :: message
      real(dp), parameter :: rounding = 1.0e-9_dp
      real(dp) :: range, largest_step, closing_step, next
      integer :: n

      message = ''
      n = size(samples)
      range = maxval(samples) - minval(samples)
      if (.not. range > 0.0_dp) then
         message = 'all samples are '//short_text(samples(1), 7)//'; nothing oscillates'
         return
      end if
      largest_step = maxval(abs(samples(2:) - samples(:n - 1)))
      closing_step = abs(samples(1) - samples(n))
      ! What would follow: the first sample after one whole cycle, the second after one that repeats its start.
      next = 4.0_dp*(samples(n) + samples(n - 2)) - 6.0_dp*samples(n - 1) - samples(n - 3)
      if (may_repeat .and. closing_step <= rounding*range .and. abs(next - samples(2)) < abs(next - samples(1))) then
         message = 'the last sample repeats the first; a cycle ends one step before, leave it out'
      else if (closing_step > largest_jump*largest_step) then
         message = 'the cycle does not close: from the last sample to the first it is '// &
                   short_text(closing_step/largest_step, 3)//' times the largest other step; if this jump is real, '// &
                   'let the cycle begin elsewhere'
      end if
   end function fault_of_cycle

end module signal_cycles
