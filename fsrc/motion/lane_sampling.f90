!> Samples of the motions of a block at equidistant phases, from the series of the steps they lie in.
!> Nothing is evaluated where no sample is requested.
module lane_sampling
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_functions, only: lanes
   use lane_state, only: carried_numbers, evaluate_inner, sum_series, lane_inner_t, series_of_number
   use problem, only: of_film, of_velocity
   use taylor_step_control, only: order
   implicit none(type, external)
   private

   !> Where the samples of every lane go.
   type, public :: lane_samples_t
      !> Samples of a period
      integer :: per_period = 0
      !> Lanes being sampled
      integer :: sampled_lanes = 0
      !> Whether this lane is
      logical :: sampled(lanes) = .false.
      !> Next sample of the period
      integer :: next(lanes) = 1
      !> Samples written so far
      integer :: written(lanes) = 0
      !> Column of the scene in the arrays of samples
      integer :: column(lanes) = 1
   end type lane_samples_t

   !> Samples of a lane that are evaluated together.
   integer, parameter :: together = 32

   public :: begin_samples, end_samples, repeat_samples, take_samples

contains

   !> Sample a lane from now, the start of a period, on.
   pure subroutine begin_samples(samples, lane)
      type(lane_samples_t), intent(inout) :: samples
      integer, intent(in) :: lane

      if (.not. samples%sampled(lane)) samples%sampled_lanes = samples%sampled_lanes + 1
      samples%sampled(lane) = .true.
      samples%next(lane) = 1
   end subroutine begin_samples

   !> Sample a lane no more.
   pure subroutine end_samples(samples, lane)
      type(lane_samples_t), intent(inout) :: samples
      integer, intent(in) :: lane

      if (samples%sampled(lane)) samples%sampled_lanes = samples%sampled_lanes - 1
      samples%sampled(lane) = .false.
   end subroutine end_samples

   !> Take the samples that lie within the present step of any lane, lane by lane: most of the time few lanes are
   !> being sampled, while all samples of one step share its series.
   pure subroutine take_samples(block, inner, samples, states)
      !> The block, with series and steps
      type(lane_block_t), intent(in) :: block
      !> States of films beside it
      type(lane_inner_t), intent(in) :: inner(lanes)
      type(lane_samples_t), intent(inout) :: samples
      !> Of all scenes: sample, number of its state, scene
      real(dp), contiguous, intent(inout) :: states(:, :, :)
      real(dp), dimension(together) :: x, film, velocity, values
      real(dp) :: film_series(0:order), lienard_series(0:order)
      real(dp) :: due_until, number
      integer :: l, i, due, last, first, carried, k

      number = real(samples%per_period, dp)
      do l = 1, lanes
         if (.not. (samples%sampled(l) .and. block%accepted(l) > 0.0_dp)) cycle
         film_series = block%film(l, :)
         lienard_series = block%lienard(l, :)
         carried = carried_numbers(l, block)
         due_until = merge(1.0_dp, block%phase(l) + block%step(l), block%step(l) >= block%remaining(l))
         last = last_sample(due_until, samples%per_period)
         do
            due = min(together, last - samples%next(l) + 1)
            if (due <= 0) exit
            ! Full vectors, filled up with the last sample, so that one has the same bits however many stand beside it.
            !$omp simd
            do i = 1, together
               x(i) = real(samples%next(l) + min(i, due) - 1, dp)/number - block%phase(l)
            end do
            call evaluate_lane(film_series, lienard_series, block%slip(l), block%backlash(l), x, film, velocity)
            first = samples%written(l) + 1
            states(first:first + due - 1, of_film, samples%column(l)) = film(:due)*block%film_scale(l)
            states(first:first + due - 1, of_velocity, samples%column(l)) = velocity(:due)*block%velocity_scale(l)
            do k = 1, carried
               call sum_series(together, series_of_number(l, k, block), x, values)
               states(first:first + due - 1, of_velocity + k, samples%column(l)) = values(:due)*block%film_scale(l)
            end do
            if (inner(l)%count > 0) call evaluate_inner(inner(l), x(:due), &
               states(first:first + due - 1, of_velocity + carried + 1:of_velocity + carried + size(inner(l)%now), &
                      samples%column(l)))
            samples%written(l) = samples%written(l) + due
            samples%next(l) = samples%next(l) + due
         end do
      end do
   end subroutine take_samples

   !> Write the samples of the last periods once more, and again.
   pure subroutine repeat_samples(cycle_periods, cycles, lane, samples, states)
      !> The last periods that count
      integer, intent(in) :: cycle_periods
      !> How often
      integer, intent(in) :: cycles
      integer, intent(in) :: lane
      type(lane_samples_t), intent(inout) :: samples
      !> Of all scenes: sample, number of its state, scene
      real(dp), contiguous, intent(inout) :: states(:, :, :)
      integer :: distance, i, column

      distance = cycle_periods*samples%per_period
      column = samples%column(lane)
      do i = samples%written(lane) + 1, samples%written(lane) + cycles*distance
         states(i, :, column) = states(i - distance, :, column)
      end do
      samples%written(lane) = samples%written(lane) + cycles*distance
   end subroutine repeat_samples

   !> The last sample at or before a phase.
   pure integer function last_sample(phase, per_period)
      !> Phase [periods]
      real(dp), intent(in) :: phase
      !> Samples of a period
      integer, intent(in) :: per_period
      real(dp) :: number

      number = real(per_period, dp)
      last_sample = int(phase*number)
      ! The product is rounded: what counts is where the sample is taken.
      if (real(last_sample, dp)/number > phase) last_sample = last_sample - 1
      if (real(last_sample + 1, dp)/number <= phase) last_sample = last_sample + 1
   end function last_sample

   !> H and H' of one lane at several distances from its point of expansion.
   pure subroutine evaluate_lane(film_series, lienard_series, slip, backlash, x, film, velocity)
      !> Series of H and V [-]
      real(dp), intent(in) :: film_series(0:order)
      real(dp), intent(in) :: lienard_series(0:order)
      !> H' = V + slip (1/sqrt(H) - 1/sqrt(B - H)), and B, huge where there is one flank
      real(dp), intent(in) :: slip
      real(dp), intent(in) :: backlash
      !> Distances [periods]
      real(dp), intent(in) :: x(together)
      !> H and H' there
      real(dp), intent(out) :: film(together)
      real(dp), intent(out) :: velocity(together)
      integer :: i

      call sum_series(together, film_series, x, film)
      call sum_series(together, lienard_series, x, velocity)
      if (.not. slip > 0.0_dp) return
      !$omp simd
      do i = 1, together
         velocity(i) = velocity(i) + slip/sqrt(film(i))
      end do
      if (backlash < huge(1.0_dp)) velocity = velocity - slip/sqrt(backlash - film)
   end subroutine evaluate_lane

end module lane_sampling
