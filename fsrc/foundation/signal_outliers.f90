!> Samples of a recording that what is around them contradicts: spikes of one or two samples, and runs at another level, as an instrument
!> that drops out leaves them. What is usual follows from medians and counts, which the samples in question do not move.
module signal_outliers
   use kinds, only: dp
   implicit none(type, external)
   private

   !> Samples in question, and their neighbours.
   type, public :: outlier_t
      !> From the first to the last; the last is the smaller one where they lie around the end of a cycle
      integer :: first = 0
      integer :: last = 0
      !> The value of the first, and of the nearest samples before and behind that are not in question
      real(dp) :: value = 0.0_dp
      real(dp) :: before = 0.0_dp
      real(dp) :: behind = 0.0_dp
   end type outlier_t

   !> Fewer samples, of a cycle or of a row that ends, have no usual step
   integer, parameter :: fewest = 16, fewest_of_row = 9
   !> Steps on each side that a sample is compared with, and the share of them that must be smaller by a factor
   integer, parameter :: neighbours = 10
   real(dp), parameter :: usual_share = 0.75_dp, far = 8.0_dp
   !> Share of the range of all others below which nothing is in question, and what the sides of it may differ by, of its height
   real(dp), parameter :: least_height = 0.3_dp, most_difference = 0.25_dp

   public :: find_spikes, find_runs

contains

   !> Spikes of one or two samples.
   pure function find_spikes(samples, length, closes) result(spikes)
      real(dp), intent(in) :: samples(:)
      !> Samples of a cycle: what is so in the next cycle, too, is none; their number if there is one cycle
      integer, intent(in) :: length
      !> Whether the first sample follows the last one
      logical, intent(in) :: closes
      type(outlier_t), allocatable :: spikes(:)
      real(dp), allocatable :: smooth(:)
      real(dp) :: range, height
      type(outlier_t) :: spike
      integer :: n, i, last

      allocate (spikes(0))
      n = size(samples)
      if (n < merge(fewest, fewest_of_row, closes)) return
      smooth = [(median_of_five(samples, i, closes), i=1, n)]
      range = maxval(smooth) - minval(smooth)
      ! Pulses on a constant level are all that such a signal has.
      if (.not. range > 0.0_dp) return
      last = 0
      do i = 1, n
         height = abs(samples(i) - smooth(i))
         if (i <= last .or. .not. height > least_height*range) cycle
         last = i
         if (i < n) then
            if (abs(samples(i + 1) - smooth(i + 1)) > max(least_height*range, 0.5_dp*height)) last = i + 1
         end if
         spike = outlier_t(i, last, samples(i), at(samples, i - 1, closes), at(samples, last + 1, closes))
         ! Beside a spike the signal goes on as if there were none; the flanks of a narrow pulse do not.
         if (max(abs(spike%before - spike%behind), abs(spike%before - at(samples, i - 2, closes)), &
                 abs(spike%behind - at(samples, last + 2, closes))) > most_difference*height) cycle
         if (.not. is_far(samples, i, height, closes) .or. repeats(samples, i, length, height)) cycle
         spikes = [spikes, spike]
      end do
   end function find_spikes

   !> Runs at another level, into which the signal jumps and out of which it jumps back.
   pure function find_runs(samples, length, is_smooth) result(runs)
      !> Of whole cycles
      real(dp), intent(in) :: samples(:)
      !> Samples of a cycle: what is so in the next cycle, too, is none; their number if there is one cycle
      integer, intent(in) :: length
      !> Whether what was measured cannot jump, as the speed of a shaft: then any run is in question that is farther off than all others
      !> are apart; else only one that is constant
      logical, intent(in) :: is_smooth
      type(outlier_t), allocatable :: runs(:)
      real(dp), parameter :: least_jump = 0.2_dp, farther = 1.2_dp
      integer, allocatable :: jumps(:)
      logical, allocatable :: is_outside(:)
      real(dp), allocatable :: smooth(:)
      real(dp) :: range, step, level
      type(outlier_t) :: run
      integer :: n, i, k, samples_of_run

      allocate (runs(0), jumps(0))
      n = size(samples)
      if (n < fewest) return
      smooth = [(median_of_five(samples, i, .true.), i=1, n)]
      range = maxval(smooth) - minval(smooth)
      level = sum(smooth/real(n, dp))
      do i = 1, n
         step = abs(at(samples, i + 1, .true.) - samples(i))
         if (.not. step > least_jump*range) cycle
         if (is_far(samples, i, step, .true.)) jumps = [jumps, i]
         ! What jumps all the time has no level to jump from.
         if (size(jumps) > 4*(n/length)) return
      end do
      allocate (is_outside(n), source=.true.)
      do i = 1, size(jumps)
         run%first = modulo(jumps(i), n) + 1
         run%last = jumps(modulo(i, size(jumps)) + 1)
         samples_of_run = modulo(run%last - run%first, n) + 1
         run%value = samples(run%first)
         run%before = samples(jumps(i))
         run%behind = at(samples, run%last + 1, .true.)
         if (size(jumps) < 2 .or. samples_of_run < 3 .or. samples_of_run > n/3) cycle
         if (abs(run%before - run%behind) > 2.0_dp*most_difference*abs(run%value - run%before)) cycle
         ! Between two runs lies what is usual.
         if (abs(run%value - level) < abs(run%before - level)) cycle
         if (repeats(samples, run%first, length, abs(run%value - run%before))) cycle
         if (.not. is_smooth .and. .not. is_constant(samples, run%first, samples_of_run)) cycle
         runs = [runs, run]
         is_outside([(modulo(run%first + k - 2, n) + 1, k=1, samples_of_run)]) = .false.
      end do
      if (size(runs) == 0) return
      range = maxval(samples, mask=is_outside) - minval(samples, mask=is_outside)
      range = merge(farther, least_height, is_smooth)*range
      ! A signal of levels is constant nearly everywhere.
      if (2*count(is_outside .and. .not. abs(samples - cshift(samples, 1)) > 0.0_dp) > count(is_outside)) range = huge(range)
      runs = pack(runs, abs(runs%value - runs%before) > range .and. abs(runs%value - runs%behind) > range)
   end function find_runs

   !> Whether a height is far more than nearly all steps from sample to sample around a place.
   pure logical function is_far(samples, place, height, closes)
      real(dp), intent(in) :: samples(:)
      integer, intent(in) :: place
      real(dp), intent(in) :: height
      logical, intent(in) :: closes
      integer :: i, steps, smaller

      smaller = 0
      steps = 0
      do i = place - neighbours, place + neighbours - 1
         if (.not. closes .and. (i < 1 .or. i >= size(samples))) cycle
         steps = steps + 1
         if (abs(at(samples, i + 1, closes) - at(samples, i, closes)) < height/far) smaller = smaller + 1
      end do
      is_far = real(smaller, dp) >= usual_share*real(steps, dp)
   end function is_far

   !> Whether a cycle before or behind has nearly the same at the same place.
   pure logical function repeats(samples, place, length, height)
      real(dp), intent(in) :: samples(:)
      integer, intent(in) :: place
      integer, intent(in) :: length
      real(dp), intent(in) :: height
      integer :: i, other

      repeats = .false.
      do i = -1, 1, 2
         other = place + i*length
         if (other < 1 .or. other > size(samples) .or. other == place) cycle
         repeats = repeats .or. abs(samples(other) - samples(place)) < most_difference*height
      end do
   end function repeats

   !> Whether so many samples from one on, around the end of the cycle, are equal.
   pure logical function is_constant(samples, first, count)
      real(dp), intent(in) :: samples(:)
      integer, intent(in) :: first
      integer, intent(in) :: count
      integer :: i

      is_constant = .true.
      do i = 1, count - 1
         is_constant = is_constant .and. .not. abs(at(samples, first + i, .true.) - samples(first)) > 0.0_dp
      end do
   end function is_constant

   !> The median of a sample and the two on either side.
   pure real(dp) function median_of_five(samples, place, closes) result(median)
      real(dp), intent(in) :: samples(:)
      integer, intent(in) :: place
      logical, intent(in) :: closes
      real(dp) :: five(5), swap
      integer :: i, k

      do i = 1, 5
         five(i) = at(samples, place + i - 3, closes)
         do k = i, 2, -1
            if (five(k) >= five(k - 1)) exit
            swap = five(k)
            five(k) = five(k - 1)
            five(k - 1) = swap
         end do
      end do
      median = five(3)
   end function median_of_five

   !> A sample by its place; beyond the ends that of the cycle that follows, or the nearest.
   pure real(dp) function at(samples, place, closes)
      real(dp), intent(in) :: samples(:)
      integer, intent(in) :: place
      logical, intent(in) :: closes

      if (closes) then
         at = samples(modulo(place - 1, size(samples)) + 1)
      else
         at = samples(min(max(place, 1), size(samples)))
      end if
   end function at

end module signal_outliers
