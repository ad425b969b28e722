!> Samples of the motions of a block at equidistant phases, from the series of the steps they lie in.
!> Nothing is evaluated where no sample is asked for.
module lane_sampling
   use kinds, only: dp
   use lane_functions, only: lanes
   use lane_scenes, only: lane_block_t
   use taylor_step_control, only: evaluate_series
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

   public :: begin_samples, end_samples, take_samples

contains

   !> Sample a lane from now, the start of a period, on.
   pure subroutine begin_samples(samples, lane)
      type(lane_samples_t), intent(inout) :: samples
      !> Lane
      integer, intent(in) :: lane

      if (.not. samples%sampled(lane)) samples%sampled_lanes = samples%sampled_lanes + 1
      samples%sampled(lane) = .true.
      samples%next(lane) = 1
   end subroutine begin_samples

   !> Sample a lane no more.
   pure subroutine end_samples(samples, lane)
      type(lane_samples_t), intent(inout) :: samples
      !> Lane
      integer, intent(in) :: lane

      if (samples%sampled(lane)) samples%sampled_lanes = samples%sampled_lanes - 1
      samples%sampled(lane) = .false.
   end subroutine end_samples

   !> Take the samples that lie within the present step of any lane, one of every lane at a time.
   pure subroutine take_samples(block, samples, films, velocities)
      !> The block, with series and steps
      type(lane_block_t), intent(in) :: block
      type(lane_samples_t), intent(inout) :: samples
      !> h [m] and z' [m/s] of all scenes: sample, scene
      real(dp), contiguous, intent(inout) :: films(:, :)
      real(dp), contiguous, intent(inout) :: velocities(:, :)
      real(dp) :: x(lanes), film(lanes), momentum(lanes), velocity(lanes), inside(lanes), &
         due_until(lanes), number
      integer :: l, due

      number = real(samples%per_period, dp)
      do l = 1, lanes
         due_until(l) = merge(1.0_dp, block%phase(l) + block%step(l), block%step(l) >= block%remaining(l))
         if (.not. (samples%sampled(l) .and. block%trust(l) > 0.0_dp)) due_until(l) = -1.0_dp
      end do
      do
         due = 0
         do l = 1, lanes
            x(l) = real(samples%next(l), dp)/number
            inside(l) = merge(1.0_dp, 0.0_dp, x(l) <= due_until(l))
            if (inside(l) > 0.0_dp) due = due + 1
            x(l) = inside(l)*(x(l) - block%phase(l))
         end do
         if (due == 0) return
         call evaluate_series(block%film, block%momentum, x, film, momentum)
         !$omp simd
         do l = 1, lanes
            velocity(l) = momentum(l) + block%slip(l)/sqrt(film(l))
         end do
         do l = 1, lanes
            if (.not. inside(l) > 0.0_dp) cycle
            samples%written(l) = samples%written(l) + 1
            samples%next(l) = samples%next(l) + 1
            films(samples%written(l), samples%column(l)) = film(l)*block%film_scale(l)
            velocities(samples%written(l), samples%column(l)) = velocity(l)*block%velocity_scale(l)
         end do
      end do
   end subroutine take_samples

end module lane_sampling
