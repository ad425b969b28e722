!> What the films of several gear pairs do to the bearings of their shaft together. All pairs follow the same engine, so their
!> forces have a phase to each other: beside the root of the sum of their squares, true of independent forces,
!> there is the rms of their sum,
!>
!>     rms**2 = sum_i rms_i**2 + 2 sum_(i<j) mean of f_i f_j,
!>
!> means over the periods after which all repeat, or over the window of those that were not seen to. The pairs of an input have one
!> shaft, hence one base frequency; the periods of their windows, and samples of a period, are their own.
module force_signal
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use constants, only: two_pi
   use force, only: force_of_period
   use fourier, only: trigonometric_interpolation
   use kinds, only: dp, int64
   use problem, only: problem_t
   use text, only: counted, integer_text
   use whole_numbers, only: common_divisor
   use word_list, only: joined_words, word_t
   implicit none(type, external)
   private

   !> Share by which the power of samples may miss that of the steps, where their phases are reported.
   real(dp), parameter :: power_share = 0.01_dp

   !> What the film force of a motion is beyond its mean, over a window of whole periods.
   type, public :: force_signal_t
      !> Of the window, 0: it is not known; and the last one of them, counted from the start of the motion
      integer :: periods = 0, last_period = 0
      !> Whether the motion goes on as its window does
      logical :: repeats = .false.
      !> Root of the mean square [N]
      real(dp) :: rms = 0.0_dp
      !> Harmonics at multiples of the base frequency over `periods`: amplitude [N] and phase at the start of the motion
      complex(dp), allocatable :: lines(:)
   end type force_signal_t

   public :: signal_of_window, sum_in_phase, has_enough_samples

contains

   !> Signal of the samples of a window.
   function signal_of_window(problem, accelerations, periods, last_period, repeats, rms) result(signal)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> z'' of the window, the same count in each period [m/s2]
      real(dp), intent(in) :: accelerations(:)
      !> Of the window, and the last one of them
      integer, intent(in) :: periods
      integer, intent(in) :: last_period
      !> Whether the motion goes on as its window does
      logical, intent(in) :: repeats
      !> Root of the mean square that the steps of the window show [N]
      real(dp), intent(in) :: rms
      type(force_signal_t) :: signal
      real(dp), allocatable :: force(:), amplitudes(:), phases(:)
      real(dp) :: mean, phase, turns
      integer(int64) :: start
      integer :: i, k, samples

      samples = size(accelerations)/periods
      allocate (force(samples))
      call force_of_period(problem%force, force)
      call trigonometric_interpolation(problem%mass*accelerations + [(force, i=1, periods)], mean, amplitudes, phases)
      signal = force_signal_t(periods, last_period, repeats, rms)
      allocate (signal%lines(size(amplitudes)))
      start = int(last_period - periods, int64)
      do k = 1, size(amplitudes)
         ! The window begins `start` periods behind the start of the motion, and its first sample is one behind that.
         turns = real(modulo(int(k, int64)*start, int(periods, int64)), dp)/real(periods, dp) &
                 + real(k, dp)/real(size(accelerations), dp)
         phase = phases(k) - two_pi*turns
         signal%lines(k) = cmplx(amplitudes(k)*cos(phase), amplitudes(k)*sin(phase), dp)
      end do
   end function signal_of_window

   !> Root of the mean square of the sum of forces, and over which periods it is one; NaN, and why, where it is not known.
   pure subroutine sum_in_phase(signals, names, rms, words)
      !> Those of all pairs
      type(force_signal_t), intent(in) :: signals(:)
      !> Names of the pairs
      type(word_t), intent(in) :: names(:)
      real(dp), intent(out) :: rms
      character(:), allocatable, intent(out) :: words
      logical :: is_known
      integer :: i, j

      rms = ieee_value(rms, ieee_quiet_nan)
      call find_periods(signals, names, words, is_known)
      if (.not. is_known) return
      rms = 0.0_dp
      do i = 1, size(signals)
         rms = rms + signals(i)%rms**2
         do j = 1, i - 1
            rms = rms + 2.0_dp*mean_of_product(signals(i), signals(j))
         end do
      end do
      rms = sqrt(max(0.0_dp, rms))
   end subroutine sum_in_phase

   !> Over which periods forces are summed, in words; or why they cannot be.
   pure subroutine find_periods(signals, names, words, is_known)
      type(force_signal_t), intent(in) :: signals(:)
      type(word_t), intent(in) :: names(:)
      character(:), allocatable, intent(out) :: words
      logical, intent(out) :: is_known
      logical :: odd(size(signals))
      integer :: i, periods, window

      odd = signals%periods == 0
      words = 'unknown, as there is no window of '//joined_words(names, odd)
      is_known = .not. any(odd)
      if (.not. is_known) return
      odd = [(.not. has_enough_samples(signals(i), power_share), i=1, size(signals))]
      words = 'unknown, as there are too few samples for the force of '//joined_words(names, odd)
      is_known = .not. any(odd)
      if (.not. is_known) return
      if (all(signals%repeats)) then
         periods = 1
         do i = 1, size(signals)
            periods = periods/common_divisor(periods, signals(i)%periods)*signals(i)%periods
         end do
         words = 'over '//counted(periods, 'period')//', after which all pairs repeat'
         return
      end if
      ! All that were not seen to repeat ran as long as was asked for, and have the last periods of that as their window.
      window = findloc(signals%repeats, .false., dim=1)
      odd = .not. signals%repeats .and. .not. (signals%periods == signals(window)%periods .and. &
                                               signals%last_period == signals(window)%last_period)
      words = 'unknown, as the window of '//names(window)%text//' is not that of '//joined_words(names, odd)
      is_known = .not. any(odd)
      if (.not. is_known) return
      odd = modulo(signals(window)%periods, signals%periods) > 0
      words = 'unknown, as the window of '//names(window)%text//', which was not seen to repeat, has '// &
              counted(signals(window)%periods, 'period')//', no multiple of those after which '//joined_words(names, odd)// &
              trim(merge(' repeats', ' repeat ', count(odd) == 1))
      is_known = .not. any(odd)
      if (.not. is_known) return
      words = 'over the last '//counted(signals(window)%periods, 'period')//' of '// &
              integer_text(signals(window)%last_period)//', the window of '
      if (any(signals%repeats)) then
         words = words//joined_words(names,.not. signals%repeats)
      else
         words = words//'all pairs'
      end if
   end subroutine find_periods

   !> Whether the samples of a window have the power that its steps have.
   pure logical function has_enough_samples(signal, share)
      type(force_signal_t), intent(in) :: signal
      !> Share of the power by which they may miss it
      real(dp), intent(in) :: share

      has_enough_samples = abs(0.5_dp*sum(abs(signal%lines)**2) - signal%rms**2) <= share*signal%rms**2
   end function has_enough_samples

   !> Mean of the product of two signals: only harmonics at frequencies of both have one [N2].
   pure real(dp) function mean_of_product(one, other) result(mean)
      type(force_signal_t), intent(in) :: one
      type(force_signal_t), intent(in) :: other
      integer :: step, other_step, shared, count

      shared = common_divisor(one%periods, other%periods)
      step = one%periods/shared
      other_step = other%periods/shared
      count = min(size(one%lines)/step, size(other%lines)/other_step)
      mean = 0.5_dp*sum(real(one%lines(step:count*step:step)*conjg(other%lines(other_step:count*other_step:other_step)), dp))
   end function mean_of_product

end module force_signal
