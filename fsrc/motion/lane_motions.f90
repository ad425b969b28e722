!> Motions of any number of scenes, error-controlled: Taylor series for the film laws that have one, collocation
!> for all others and for scenes too stiff for explicit steps.
module lane_motions
   use film_law, only: film_load
   use film_series, only: has_series
   use kinds, only: dp
   use lane_integration, only: integrate_lanes
   use lane_scenes, only: lane_ending_t, lane_accuracy, lane_request_t, lane_scene_t, start_status
   use period_repetition, only: orbit_watch_t
   use scene_status, only: status_complete, status_film_lost, status_not_converged
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   public :: solve_motions

contains

   !> Solve all scenes. The order of the scenes decides only which share a block: those of like cost should be
   !> neighbours, the longest first.
   subroutine solve_motions(scenes, request, films, velocities, endings, watches, records)
      !> The scenes
      type(lane_scene_t), intent(in) :: scenes(:)
      !> What is asked for
      type(lane_request_t), intent(in) :: request
      !> Samples of h [m] and z' [m/s]: sample, scene; at least sampled_periods*samples_per_period of a scene
      real(dp), contiguous, intent(inout) :: films(:, :)
      real(dp), contiguous, intent(inout) :: velocities(:, :)
      !> How the scenes ended
      type(lane_ending_t), intent(out) :: endings(:)
      !> What a search for repetition that is carried on looks back on, scene by scene; without it every search begins anew
      type(orbit_watch_t), optional, intent(inout) :: watches(:)
      !> What the steps of the sampled periods tell, scene by scene; a motion that is carried on within them adds to it
      type(window_record_t), optional, intent(inout) :: records(:)
      type(lane_scene_t), allocatable :: rest(:)
      logical, allocatable :: explicit(:), left(:)
      integer, allocatable :: number(:)
      integer :: i, first, kernel

      allocate (rest, source=scenes)
      allocate (explicit(size(scenes)), left(size(scenes)), number(size(scenes)))
      number(:) = [(i, i=1, size(scenes))]
      explicit(:) = has_series(scenes%film, lane_accuracy(scenes, request%accuracy)) .and. .not. scenes%implicit &
                    .and. .not. outgrows_series(scenes)
      left(:) = explicit
      do while (any(left))
         first = findloc(left, .true., dim=1)
         kernel = scenes(first)%film%kernel
         call integrate_lanes(.true., scenes, pack(number, left .and. scenes%film%kernel == kernel), request, &
                              films, velocities, endings, watches, records)
         left(:) = left .and. scenes%film%kernel /= kernel
      end do

      do i = 1, size(scenes)
         left(i) = .not. explicit(i)
         if (left(i)) cycle
         left(i) = any(endings(i)%status == [status_not_converged, status_film_lost])
         if (left(i)) call go_on(endings(i), rest(i))
      end do
      if (any(left)) &
         call integrate_lanes(.false., rest, pack(number, left), request, films, velocities, endings, watches, records)
   end subroutine solve_motions

   !> Whether the coefficients of a series about the start of a motion, in powers of time in periods, would overflow.
   elemental logical function outgrows_series(scene)
      !> The scene
      type(lane_scene_t), intent(in) :: scene
      !> Growth from one coefficient to the next [-]; a step would be some 1e-8 of a period
      real(dp), parameter :: largest_growth = 1.0e8_dp
      !> What is thinner is no film, which is found at the first step [m]
      real(dp), parameter :: thinnest = 1.0e-30_dp
      real(dp) :: load, load_by_film, load_by_velocity, rate

      outgrows_series = .false.
      ! A motion that is carried on goes on as it went; one that cannot start is not for this procedure to refuse.
      if (scene%carried_on) return
      if (start_status(scene) /= status_complete) return
      if (.not. scene%initial_film > thinnest) return
      call film_load(scene%film, scene%initial_film, scene%initial_velocity, load, load_by_film, load_by_velocity)
      load = load + abs(scene%steady_force + scene%weight) + scene%force_amplitude
      rate = largest_growth*scene%frequency
      outgrows_series = abs(scene%initial_velocity) > rate*scene%initial_film .or. &
                        abs(load_by_velocity) > rate*scene%mass .or. abs(load_by_film) > rate**2*scene%mass .or. &
                        load > rate**2*scene%mass*scene%initial_film
   end function outgrows_series

   !> The rest of a motion that Taylor series could not finish.
   pure subroutine go_on(ending, scene)
      !> Where they stopped
      type(lane_ending_t), intent(in) :: ending
      !> The scene, made to start there
      type(lane_scene_t), intent(inout) :: scene

      scene%initial_film = ending%film
      scene%initial_velocity = ending%velocity
      scene%periods_done = ending%periods
      scene%carried_on = .false.
      scene%implicit = .true.
   end subroutine go_on

end module lane_motions
