!> Motions that scenes hand to their neighbours, in rounds until no scene lacks a motion that a neighbour has.
module handed_motions
   use errors, only: error_t
   use judged_scene, only: judged_scene_t
   use kinds, only: dp
   use known_motions, only: settled_motion_t
   use other_motions, only: follow_on, solve_trials, start_trial_t
   use prepared_scene, only: prepared_scene_t
   use problem, only: of_velocity, problem_t, state_size
   use rattle_class, only: class_irregular
   use scene_group, only: scene_group_t
   use signals, only: must_stop
   use starting_state, only: keep_by_contacts, kept_by_contacts
   implicit none(type, external)
   private

   !> Ratio of their accelerations within which motions of one period count as alike
   real(dp), parameter :: alike_ratio = 1.25_dp

   !> Places of the scenes that hand their motions to a scene, in the order in which they do.
   type, public :: neighbours_t
      integer, allocatable :: places(:)
   end type neighbours_t

   !> Motions that a scene was handed: places of the scenes that had them, and their places there; and those that did not settle
   type :: handed_t
      integer, allocatable :: scenes(:), places(:)
      type(settled_motion_t), allocatable :: unsettled(:)
   end type handed_t

   public :: hand_on_motions

contains

   !> Hand every motion to the neighbours that have none like it. After a signal to stop the motions are of no use.
   subroutine hand_on_motions(scenes, neighbours, space, judged, error)
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> Of each scene
      type(neighbours_t), intent(in) :: neighbours(:)
      !> Work space
      type(scene_group_t), intent(inout) :: space
      !> Judged scenes, with the motions of their starts; others are added
      type(judged_scene_t), intent(inout) :: judged(:)
      !> Set if there is no memory for the samples of a scene
      type(error_t), allocatable, intent(out) :: error
      type(handed_t) :: handed(size(scenes))
      type(start_trial_t), allocatable :: trials(:)
      integer :: i, last

      do i = 1, size(handed)
         allocate (handed(i)%scenes(0), handed(i)%places(0), handed(i)%unsettled(0))
      end do
      do
         call next_round(scenes, neighbours, judged, handed, trials)
         if (size(trials) == 0) return
         call solve_trials(scenes, trials, space, judged, error)
         if (must_stop() .or. allocated(error)) return
         trials%goes_on = .true.
         call follow_on(scenes, trials%is_next_to_one, space, trials, judged, error)
         if (must_stop() .or. allocated(error)) return
         do i = 1, size(trials)
            if (trials(i)%settled) cycle
            associate (to => handed(trials(i)%scene))
               ! The trials of a scene are the last ones that it was handed, in their order.
               last = size(to%scenes) - count(trials(i:)%scene == trials(i)%scene) + 1
               to%unsettled = [to%unsettled, judged(to%scenes(last))%settled(to%places(last))]
            end associate
         end do
      end do
   end subroutine hand_on_motions

   !> Starts of the next round. Of motions that are alike a scene is handed one in a round, and none any more if one did not settle.
   !> A scene that needs no other start needs no neighbours, nor has anything for them.
   subroutine next_round(scenes, neighbours, judged, handed, trials)
      type(prepared_scene_t), intent(in) :: scenes(:)
      type(neighbours_t), intent(in) :: neighbours(:)
      type(judged_scene_t), intent(in) :: judged(:)
      type(handed_t), intent(inout) :: handed(:)
      type(start_trial_t), allocatable, intent(out) :: trials(:)
      type(settled_motion_t), allocatable :: known(:)
      integer :: to, from, i, place

      allocate (trials(0))
      do to = 1, size(scenes)
         if (judged(to)%coexisting%starts_solved <= 1) cycle
         known = [judged(to)%settled, handed(to)%unsettled]
         do i = 1, size(neighbours(to)%places)
            from = neighbours(to)%places(i)
            if (judged(from)%coexisting%starts_solved <= 1) cycle
            do place = 1, size(judged(from)%settled)
               associate (motion => judged(from)%settled(place))
                  if (any(handed(to)%scenes == from .and. handed(to)%places == place)) cycle
                  if (any(are_alike(known, motion))) cycle
                  ! Where one that is neither periodic nor known to be irregular is going, is not known.
                  if (motion%period == 0 .and. judged(from)%coexisting%motions(place)%class /= class_irregular) cycle
                  handed(to)%scenes = [handed(to)%scenes, from]
                  handed(to)%places = [handed(to)%places, place]
                  known = [known, motion]
                  trials = [trials, start_trial_t(to, 0, handed_state(scenes(to)%resolved%problem, motion, &
                                                                   scenes(from)%resolved%problem))]
               end associate
            end do
         end do
      end do
   end subroutine next_round

   !> Whether two motions are alike: of one period and with nearly the same acceleration, or both do not repeat.
   elemental logical function are_alike(one, other)
      type(settled_motion_t), intent(in) :: one
      type(settled_motion_t), intent(in) :: other

      are_alike = one%period == other%period .and. &
                  (one%period == 0 .or. (one%acceleration_rms <= alike_ratio*other%acceleration_rms .and. &
                                         other%acceleration_rms <= alike_ratio*one%acceleration_rms))
   end function are_alike

   !> State from which a scene starts with the motion of another one: its films, velocity, and what its contacts carry.
   pure function handed_state(problem, motion, from) result(state)
      type(problem_t), intent(in) :: problem
      !> Motion of the other one, and what moves there
      type(settled_motion_t), intent(in) :: motion
      type(problem_t), intent(in) :: from
      real(dp), allocatable :: state(:)

      ! Where only one of both has damped teeth, their states differ in size.
      allocate (state(state_size(problem)), source=0.0_dp)
      state(:of_velocity) = motion%states(:of_velocity, 1)
      call keep_by_contacts(problem, kept_by_contacts(from, motion%states(:, 1)), state)
   end function handed_state

end module handed_motions
