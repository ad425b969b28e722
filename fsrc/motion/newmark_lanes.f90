!> Motions of many scenes by Newmark's method, a scene a lane. All scenes of a call have the same number of
!> steps a period; film law, forces, frequency and tolerance are each scene's own.
!>
!> A period in which a step of a lane fails is solved again alone, by module newmark, which can cut steps; so
!> is every period of a scene that has no lane. No number of one scene enters another: a scene has the same
!> bits alone, in any lane, among any neighbours. Against the scalar steps the last digits differ: here every
!> step has at least two passes.
module newmark_lanes
   use film_law, only: film_load, film_t
   use forcing, only: cosines_of_period, force_of_period
   use kinds, only: dp, int64
   use newmark, only: advance_period, motion_count_t, motion_state_t, newmark_t, start_motion
   use newmark_lane_group, only: block_lanes, group_lanes, has_lanes, lane_state, load_lane, newmark_lane_group_t, &
      place_group, rest_group_lane
   use newmark_lane_steps, only: advance_lanes
   use scene_status, only: status_complete
   implicit none(type, external)
   private

   !> One scene.
   type, public :: newmark_lane_scene_t
      !> Its film
      type(film_t) :: film
      !> Its constants
      type(newmark_t) :: method
      !> h [m] and z' [m/s] at t = 0
      real(dp) :: thickness = 0.0_dp
      real(dp) :: velocity = 0.0_dp
   end type newmark_lane_scene_t

   !> What is asked of all scenes of a call.
   type, public :: newmark_lane_request_t
      integer :: steps_per_period = 0
      integer :: periods = 0
      !> Periods sampled, the last ones; 0: none
      integer :: sampled_periods = 0
      !> Samples of a period, a divisor of its steps; the last one is its end
      integer :: samples_per_period = 1
   end type newmark_lane_request_t

   !> How a scene ended.
   type, public :: newmark_lane_ending_t
      !> Status of scene_status
      integer :: status = status_complete
      !> Whole periods solved, and those of them that were solved alone
      integer :: periods = 0
      integer :: periods_alone = 0
      !> State at their end
      type(motion_state_t) :: state
      !> Cost
      type(motion_count_t) :: count
   end type newmark_lane_ending_t

   public :: solve_newmark_lanes

contains

   !> Solve all scenes. Samples of a scene that failed are those of its whole periods.
   subroutine solve_newmark_lanes(scenes, request, films, velocities, accelerations, endings)
      !> The scenes
      type(newmark_lane_scene_t), intent(in) :: scenes(:)
      !> What is asked for
      type(newmark_lane_request_t), intent(in) :: request
      !> Samples of h [m], z' [m/s] and z'' [m/s2]: sample, scene
      real(dp), contiguous, intent(inout) :: films(:, :)
      real(dp), contiguous, intent(inout) :: velocities(:, :)
      real(dp), contiguous, intent(inout) :: accelerations(:, :)
      !> How they ended
      type(newmark_lane_ending_t), intent(out) :: endings(:)
      integer, allocatable :: queue(:)
      real(dp), allocatable :: cosine(:)
      real(dp), allocatable, target :: room(:)
      type(newmark_lane_group_t), pointer :: group
      integer :: i, first, last

      call place_group(room, group)
      allocate (cosine(request%steps_per_period))
      call cosines_of_period(cosine)
      do i = 1, size(scenes)
         associate (scene => scenes(i), ending => endings(i))
            call start_motion(film_load, scene%film, scene%method, scene%thickness, scene%velocity, &
                              ending%state, ending%count, ending%status)
            if (has_lanes(scene%film, scene%method)) cycle
            do while (ending%status == status_complete .and. ending%periods < request%periods)
               call solve_period_alone(scene, request, films(:, i), velocities(:, i), accelerations(:, i), &
                                       ending)
            end do
         end associate
      end do

      queue = pack([(i, i=1, size(scenes))], endings%status == status_complete .and. &
         endings%periods < request%periods)
      first = 1
      do while (first <= size(queue))
         ! As many as fit and have the law of the first.
         last = first
         do while (last - first + 1 < group_lanes .and. last < size(queue))
            if (scenes(queue(last + 1))%film%kernel /= scenes(queue(first))%film%kernel) exit
            last = last + 1
         end do
         call solve_group(scenes, queue(first:last), request, cosine, group, films, velocities, &
                          accelerations, endings)
         first = last + 1
      end do
   end subroutine solve_newmark_lanes

   !> Solve the scenes of one group through all periods.
   subroutine solve_group(scenes, members, request, cosine, group, films, velocities, accelerations, endings)
      type(newmark_lane_scene_t), intent(in) :: scenes(:)
      !> Scenes in the lanes
      integer, intent(in) :: members(:)
      type(newmark_lane_request_t), intent(in) :: request
      !> cos(2 pi f_exc t) at the end of every step of a period [-]
      real(dp), intent(in) :: cosine(:)
      type(newmark_lane_group_t), intent(inout) :: group
      real(dp), contiguous, intent(inout) :: films(:, :)
      real(dp), contiguous, intent(inout) :: velocities(:, :)
      real(dp), contiguous, intent(inout) :: accelerations(:, :)
      type(newmark_lane_ending_t), intent(inout) :: endings(:)
      type(motion_state_t) :: state
      integer :: l, period, stride, first_sample, i, sample

      group%kernel = scenes(members(1))%film%kernel
      group%used = block_lanes*((size(members) + block_lanes - 1)/block_lanes)
      do l = 1, group%used
         call rest_group_lane(group, l)
         if (l <= size(members)) call load(l)
      end do
      stride = request%steps_per_period/request%samples_per_period
      do period = 1, request%periods
         first_sample = first_sample_of(period, request)
         if (first_sample == 0) then
            call advance_lanes(group, cosine)
         else
            do i = 0, request%samples_per_period - 1
               call advance_lanes(group, cosine(i*stride + 1:(i + 1)*stride))
               sample = first_sample + i
               do l = 1, size(members)
                  if (endings(members(l))%status /= status_complete .or. group%failed(l)) cycle
                  state = lane_state(group, l, time_step(l))
                  films(sample, members(l)) = state%film
                  velocities(sample, members(l)) = state%velocity
                  accelerations(sample, members(l)) = state%acceleration
               end do
            end do
         end if
         do l = 1, size(members)
            if (endings(members(l))%status == status_complete) call end_period(l)
         end do
      end do

   contains

      !> Step of a lane [s].
      pure real(dp) function time_step(lane)
         integer, intent(in) :: lane

         time_step = 1.0_dp/(scenes(members(lane))%method%frequency*real(request%steps_per_period, dp))
      end function time_step

      !> Put the scene of a lane into it, with the state it has reached.
      subroutine load(lane)
         integer, intent(in) :: lane

         associate (scene => scenes(members(lane)))
            call load_lane(group, lane, scene%film, scene%method, time_step(lane), &
                           endings(members(lane))%state)
         end associate
      end subroutine load

      !> Note the state of a lane at the end of a period; after a failure, solve the period alone.
      subroutine end_period(lane)
         integer, intent(in) :: lane

         associate (ending => endings(members(lane)), i => members(lane))
            if (.not. group%failed(lane)) then
               ending%state = lane_state(group, lane, time_step(lane))
               ending%periods = ending%periods + 1
               ending%count%steps = ending%count%steps + int(size(cosine), int64)
               ending%count%evaluations = ending%count%evaluations + 2_int64*int(size(cosine), int64) + &
                  group%further_passes(lane)
            else
               call solve_period_alone(scenes(i), request, films(:, i), velocities(:, i), &
                                       accelerations(:, i), ending)
               if (ending%status == status_complete) call load(lane)
            end if
            group%further_passes(lane) = 0_int64
         end associate
      end subroutine end_period

   end subroutine solve_group

   !> The next period of a scene by the scalar steps.
   subroutine solve_period_alone(scene, request, films, velocities, accelerations, ending)
      type(newmark_lane_scene_t), intent(in) :: scene
      type(newmark_lane_request_t), intent(in) :: request
      !> Samples of the scene
      real(dp), contiguous, intent(inout) :: films(:)
      real(dp), contiguous, intent(inout) :: velocities(:)
      real(dp), contiguous, intent(inout) :: accelerations(:)
      type(newmark_lane_ending_t), intent(inout) :: ending
      real(dp), allocatable, dimension(:) :: force, all_films, all_velocities, all_accelerations
      integer :: done, first, last, stride

      allocate (force(request%steps_per_period))
      allocate (all_films, all_velocities, all_accelerations, mold=force)
      call force_of_period(scene%method%steady_force, scene%method%force_amplitude, force)
      call advance_period(film_load, scene%film, scene%method, force, ending%state, ending%count, all_films, &
                          all_velocities, all_accelerations, done, ending%status)
      if (ending%status /= status_complete) return
      ending%periods = ending%periods + 1
      ending%periods_alone = ending%periods_alone + 1
      first = first_sample_of(ending%periods, request)
      if (first == 0) return
      last = first + request%samples_per_period - 1
      stride = request%steps_per_period/request%samples_per_period
      films(first:last) = all_films(stride::stride)
      velocities(first:last) = all_velocities(stride::stride)
      accelerations(first:last) = all_accelerations(stride::stride)
   end subroutine solve_period_alone

   !> Where the samples of a period start; 0: it is not sampled.
   pure integer function first_sample_of(period, request)
      !> The period, from 1 on
      integer, intent(in) :: period
      type(newmark_lane_request_t), intent(in) :: request

      first_sample_of = 0
      if (period > request%periods - request%sampled_periods) &
         first_sample_of = (period - 1 - (request%periods - &
         request%sampled_periods))*request%samples_per_period + 1
   end function first_sample_of

end module newmark_lanes
