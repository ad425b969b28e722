!> All motions of a single scene, and what its table lists of them besides: how fast disturbances of them die, and states from which
!> film and velocity alone start them again.
module single_motions
   use engine, only: ending_t, motion_state_t, request_t, state_of_start
   use errors, only: error_t
   use judged_scene, only: judged_scene_t
   use kinds, only: dp
   use known_motions, only: known_of, reached_motion
   use many_motions, only: solve_motions
   use motion_start, only: motion_start_t
   use other_motions, only: find_other_motions
   use periodic_orbit, only: attracting_period, periodic_orbit_t
   use prepared_scene, only: prepare
   use problem, only: of_film, of_velocity, problem_t, state_size
   use scene_group, only: scene_group_t
   use scene_orbit, only: nearby_orbit
   use scene_status, only: status_complete
   use scene_types, only: scene_t
   use signals, only: must_stop
   use text_output, only: lock_texts, unlock_texts
   use window_motion, only: enough_accuracy
   implicit none(type, external)
   private

   !> Periods after which a motion that was started again by film and velocity has to be itself.
   integer, parameter :: restart_periods = 40

   public :: find_all_motions

contains

   !> Find the motions of a judged scene from all its starts. After a signal to stop they are of no use.
   subroutine find_all_motions(scene, started, space, judged, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> When the run began, on the clock of wall_seconds [s]
      real(dp), intent(in) :: started
      !> Work space
      type(scene_group_t), intent(inout) :: space
      !> The judged scene, with its own motion; the others are added
      type(judged_scene_t), intent(inout) :: judged(1)
      !> Set if there is no memory for the samples of a start
      type(error_t), allocatable, intent(out) :: error
      real(dp) :: ends_at

      ends_at = huge(ends_at)
      if (scene%solver%time_limit > 0.0_dp) ends_at = started + scene%solver%time_limit
      call find_other_motions([prepare(scene)], space, judged, error, ends_at)
      if (must_stop() .or. allocated(error)) return
      if (judged(1)%coexisting%starts_solved > 1) call complete_motions(judged(1)%resolved%problem, judged(1))
   end subroutine find_all_motions

   !> Complete the motions of a scene that has several starts.
   subroutine complete_motions(problem, judged)
      type(problem_t), intent(in) :: problem
      !> With all its motions
      type(judged_scene_t), intent(inout) :: judged
      type(periodic_orbit_t) :: orbit
      integer :: i

      do i = 1, size(judged%settled)
         associate (motion => judged%coexisting%motions(i))
            if (must_stop()) return
            if (motion%period == 0) cycle
            if (motion%floquet_modulus < 0.0_dp) then
               orbit = nearby_orbit(problem, motion_state_t(numbers=motion%state))
               if (attracting_period(orbit) == motion%period) then
                  motion%state = orbit%state
                  motion%floquet_modulus = abs(orbit%multipliers(1))
               end if
            end if
            motion%restarts = state_size(problem) == of_velocity
            if (.not. motion%restarts) call find_restart(problem, judged, i)
         end associate
      end do
   end subroutine complete_motions

   !> Take the state of a motion from which film and velocity alone start it again: contacts with numbers of their own begin at
   !> rest then, and come into the motion by themselves, but perhaps into another one.
   subroutine find_restart(problem, judged, place)
      type(problem_t), intent(in) :: problem
      type(judged_scene_t), intent(inout) :: judged
      !> Place of the motion
      integer, intent(in) :: place
      type(ending_t) :: endings(judged%settled(place)%period)
      type(motion_state_t) :: starts(size(endings))
      type(problem_t) :: problems(size(endings))
      real(dp), allocatable :: states(:, :, :)
      integer :: i

      problems = problem
      do i = 1, size(starts)
         associate (state => judged%settled(place)%states(:, i))
            starts(i) = state_of_start(problem, motion_start_t('given', state(of_film), state(of_velocity)))
         end associate
      end do
      allocate (states(2, state_size(problem), size(starts)), source=0.0_dp)
      call unlock_texts()
      call solve_motions(problems, starts, request_t(accuracy=enough_accuracy, periods=restart_periods, samples_per_period=1, &
                                                     sampled_periods=2), states, endings)
      call lock_texts()
      associate (motion => judged%coexisting%motions(place))
         do i = 1, size(starts)
            motion%restarts = endings(i)%status == status_complete .and. &
                              reached_motion(problem, known_of(problem, judged%settled), states(1, :, i), states(2, :, i)) == place
            if (.not. motion%restarts) cycle
            motion%state = judged%settled(place)%states(:, i)
            return
         end do
      end associate
   end subroutine find_restart

end module single_motions
