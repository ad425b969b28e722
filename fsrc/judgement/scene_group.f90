!> Scenes solved side by side, or a single one: the samples of their windows, what the steps report of them, and their classes.
module scene_group
   use engine, only: ending_t, motion_state_t, reserved_periods
   use irregular_statistics, only: irregular_statistics_t
   use kinds, only: dp
   use known_motions, only: known_motions_t
   use lyapunov, only: path_t
   use many_motions, only: solve_motions
   use node_extremes, only: seen_quantities
   use periodic_orbit, only: periodic_orbit_t
   use prepared_scene, only: prepared_scene_t
   use problem, only: state_size
   use rattle_class, only: rattle_verdict_t
   use scene_status, only: is_success
   use text_output, only: lock_texts, unlock_texts
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Solved scenes. The arrays are kept from group to group, since the system takes its time to hand out fresh memory: they may
   !> be longer than the group.
   type, public :: scene_group_t
      !> Sample, number of its state, scene
      real(dp), allocatable :: states(:, :, :)
      !> z'' of the window of a single scene, as its engine handed it out [m/s2]; of scenes side by side it follows from the states
      real(dp), allocatable :: accelerations(:)
      !> How the motions ended
      type(ending_t), allocatable :: endings(:)
      !> What the steps of the windows show; no periods: the samples are all there is
      type(window_record_t), allocatable :: records(:)
      !> Classes of the motions that have a window
      type(rattle_verdict_t), allocatable :: verdicts(:)
      !> Samples of a period that these are from; 0: integrals over the steps
      integer, allocatable :: classified_by(:)
      !> Periods after which they repeat, by the engine or by a search at their ends; 0 where none was found
      integer, allocatable :: repeat_after(:)
      !> Where motions went beyond their windows: those that are irregular, with their statistics, and those whose window is no
      !> multiple of the periods after which they repeat
      type(path_t), allocatable :: paths(:)
      type(irregular_statistics_t), allocatable :: statistics(:)
      !> Periodic motions next to the ends, where they were looked for
      type(periodic_orbit_t), allocatable :: orbits(:)
   end type scene_group_t

   public :: solve_group, take_window, has_window, judged_record, goes_beyond

contains

   !> Solve scenes side by side. All are asked for the same but for their limits of impacts.
   subroutine solve_group(scenes, starts, wants, group, known)
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> Where each motion starts
      type(motion_state_t), intent(in) :: starts(:)
      !> Extremes that are asked for, by the codes of node_extremes
      logical, intent(in) :: wants(seen_quantities)
      !> The scenes, without their classes
      type(scene_group_t), intent(inout) :: group
      !> Periodic motions that are known of each scene: a motion that comes to one of them has no window
      type(known_motions_t), intent(in), optional :: known(:)
      type(window_record_t) :: blank
      integer :: samples, i

      associate (request => scenes(1)%request, n => size(scenes))
         samples = request%sampled_periods
         if (request%until_steady) samples = reserved_periods(samples)
         call make_room(group, max(1, samples*request%samples_per_period), maxval(state_size(scenes%resolved%problem)), n)
         blank%wants = wants
         do i = 1, n
            group%records(i) = blank
            group%records(i)%loads%impact_limit = scenes(i)%request%impact_limit
         end do
         call unlock_texts()
         call solve_motions(scenes%resolved%problem, starts, request, group%states(:, :, :n), group%endings(:n), &
                            records=group%records(:n), known=known)
         call lock_texts()
         group%repeat_after(:n) = group%endings(:n)%orbit
      end associate
   end subroutine solve_group

   !> See that there is room for a group; of scenes that were in it nothing is left.
   subroutine make_room(group, samples, numbers, scenes)
      type(scene_group_t), intent(inout) :: group
      !> Samples of a window, numbers of a state, and scenes
      integer, intent(in) :: samples
      integer, intent(in) :: numbers
      integer, intent(in) :: scenes

      if (allocated(group%states)) then
         if (size(group%states, 1) < samples .or. size(group%states, 2) /= numbers .or. size(group%states, 3) < scenes) &
            group = scene_group_t()
      end if
      if (.not. allocated(group%states)) allocate (group%states(samples, numbers, scenes))
      if (allocated(group%accelerations)) deallocate (group%accelerations)
      if (.not. allocated(group%endings)) &
         allocate (group%endings(scenes), group%records(scenes), group%verdicts(scenes), group%classified_by(scenes), &
                   group%repeat_after(scenes), group%paths(scenes), group%statistics(scenes), group%orbits(scenes))
      group%paths = path_t()
      group%statistics = irregular_statistics_t()
      group%orbits = periodic_orbit_t()
   end subroutine make_room

   !> The group of a single scene that an engine of its own has followed.
   subroutine take_window(states, accelerations, ending, record, group)
      !> Sample, number of its state, 1; and z'' [m/s2]; not allocated where no window was come to. The group takes them over
      real(dp), allocatable, intent(inout) :: states(:, :, :)
      real(dp), allocatable, intent(inout) :: accelerations(:)
      !> How it ended
      type(ending_t), intent(in) :: ending
      !> What the steps of the window show
      type(window_record_t), intent(in) :: record
      type(scene_group_t), intent(out) :: group

      call move_alloc(states, group%states)
      if (.not. allocated(group%states)) allocate (group%states(0, 0, 1), accelerations(0))
      call make_room(group, size(group%states, 1), size(group%states, 2), 1)
      call move_alloc(accelerations, group%accelerations)
      group%endings(1) = ending
      group%endings(1)%samples = size(group%states, 1)
      group%records(1) = record
      group%repeat_after(1) = ending%orbit
   end subroutine take_window

   !> What the steps report of a motion: over the periods that it was followed beyond its window, else over its window.
   pure type(window_record_t) function judged_record(group, place)
      type(scene_group_t), intent(in) :: group
      !> Of the motion
      integer, intent(in) :: place

      judged_record = group%records(place)
      if (goes_beyond(group, place)) judged_record = group%paths(place)%record
   end function judged_record

   !> Whether a motion is judged over more periods than those of its window.
   pure logical function goes_beyond(group, place)
      type(scene_group_t), intent(in) :: group
      !> Of the motion
      integer, intent(in) :: place

      goes_beyond = group%paths(place)%record%periods > 0
   end function goes_beyond

   !> Whether a motion has a window: it has not failed, nor come to a known one.
   elemental logical function has_window(ending)
      type(ending_t), intent(in) :: ending

      has_window = is_success(ending%status) .and. ending%known == 0
   end function has_window

end module scene_group
