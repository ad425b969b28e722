!> Scenes that are solved side by side: the samples of their windows, what the steps tell of them, and their classes.
module scene_group
   use errors, only: error_t
   use engine, only: ending_t, motion_state_t, request_t, reserved_periods
   use finer_windows, only: classify_finer
   use irregular_motion, only: follow_irregular
   use lyapunov, only: path_t
   use kinds, only: dp
   use known_motions, only: known_motions_t
   use many_motions, only: solve_motions
   use node_extremes, only: seen_quantities
   use carried_loads, only: accelerations_of_samples
   use periodic_orbit, only: periodic_orbit_t
   use problem, only: problem_t, state_size
   use rattle_class, only: note_orbit, rattle_verdict_t
   use scene_orbit, only: nearby_orbit
   use scene_status, only: is_success
   use scene_types, only: spectrum_choice_t
   use signals, only: must_stop
   use window_class, only: classify_window
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Solved scenes. The arrays are kept from group to group, since the system takes its time to hand out fresh memory: they may
   !> be longer than the group.
   type, public :: scene_group_t
      !> Sample, number of its state, scene
      real(dp), allocatable :: states(:, :, :)
      !> How the motions ended
      type(ending_t), allocatable :: endings(:)
      !> What the steps of the windows tell
      type(window_record_t), allocatable :: records(:)
      !> Classes of the motions that have a window
      type(rattle_verdict_t), allocatable :: verdicts(:)
      !> Samples of a period that these are from; 0: integrals over the steps
      integer, allocatable :: classified_by(:)
      !> Periods after which they repeat, by the engine or by a search at their ends; 0 where none is known
      integer, allocatable :: repeat_after(:)
      !> Where the motions went that are irregular
      type(path_t), allocatable :: paths(:)
      !> Set if there was no memory for the samples that a class needs: the classes are of no use
      type(error_t), allocatable :: error
      !> z'' of one scene [m/s2]
      real(dp), allocatable, private :: accelerations(:)
   end type scene_group_t

   public :: solve_group, has_window, classify_group, find_orbits, follow_group

contains

   !> Solve scenes side by side.
   subroutine solve_group(problems, starts, request, wants, group, impact_limits, known)
      !> What moves, and where each motion starts
      type(problem_t), intent(in) :: problems(:)
      type(motion_state_t), intent(in) :: starts(:)
      !> What is asked of the engine
      type(request_t), intent(in) :: request
      !> Extremes that are asked for, by the codes of node_extremes
      logical, intent(in) :: wants(seen_quantities)
      !> The scenes, without their classes
      type(scene_group_t), intent(inout) :: group
      !> Multiples of the largest force above which loads are impacts, where these are asked for
      real(dp), intent(in), optional :: impact_limits(:)
      !> Periodic motions that are known of each scene: a motion that comes to one of them has no window
      type(known_motions_t), intent(in), optional :: known(:)
      type(window_record_t) :: blank
      integer :: samples, numbers, n, i

      n = size(problems)
      if (allocated(group%error)) deallocate (group%error)
      samples = request%sampled_periods
      if (request%until_steady) samples = reserved_periods(samples)
      samples = max(1, samples*request%samples_per_period)
      numbers = maxval(state_size(problems))
      if (allocated(group%states)) then
         if (size(group%states, 1) < samples .or. size(group%states, 2) /= numbers .or. size(group%states, 3) < n) &
            deallocate (group%states, group%endings, group%records, group%verdicts, group%classified_by, group%repeat_after, &
                        group%paths, group%accelerations)
      end if
      if (.not. allocated(group%states)) &
         allocate (group%states(samples, numbers, n), group%endings(n), group%records(n), group%verdicts(n), &
                   group%classified_by(n), group%repeat_after(n), group%paths(n), group%accelerations(samples))
      blank%wants = wants
      do i = 1, n
         group%records(i) = blank
         group%paths(i) = path_t()
         if (present(impact_limits)) group%records(i)%loads%impact_limit = impact_limits(i)
      end do
      call solve_motions(problems, starts, request, group%states(:, :, :n), group%endings(:n), records=group%records(:n), &
                         known=known)
      group%repeat_after(:n) = group%endings(:n)%orbit
   end subroutine solve_group

   !> Whether a motion has a window: it has not failed, nor come to a known one.
   elemental logical function has_window(ending)
      type(ending_t), intent(in) :: ending

      has_window = is_success(ending%status) .and. ending%known == 0
   end function has_window

   !> Classes of the windows, by as many samples as they need, or by integrals over the steps. After a signal to stop
   !> they are of no use.
   subroutine classify_group(problems, choices, noise_floors, request, group, class_alone)
      !> What moves
      type(problem_t), intent(in) :: problems(:)
      !> Limits of the classes, scene by scene
      type(spectrum_choice_t), intent(in) :: choices(:)
      !> Accelerations that the errors of the solutions explain [m/s2]
      real(dp), intent(in) :: noise_floors(:)
      !> What was asked of the engine
      type(request_t), intent(in) :: request
      !> The solved scenes; their classes are added
      type(scene_group_t), intent(inout) :: group
      !> Whether nothing but the classes is asked for
      logical, intent(in), optional :: class_alone
      type(rattle_verdict_t), allocatable :: finer(:)
      integer, allocatable :: number(:), classified_by(:)
      logical :: coarse(size(problems)), only_class
      integer :: i

      only_class = .false.
      if (present(class_alone)) only_class = class_alone
      coarse = .false.
      do i = 1, size(problems)
         if (must_stop()) return
         if (.not. has_window(group%endings(i))) cycle
         associate (samples => group%endings(i)%samples, verdict => group%verdicts(i))
            call accelerations_of_samples(problems(i), request%samples_per_period, group%states(:samples, :, i), &
                                          group%accelerations(:samples))
            call classify_window(choices(i), problems(i), samples/request%samples_per_period, group%accelerations(:samples), &
                                 group%records(i), noise_floors(i), verdict)
            group%classified_by(i) = request%samples_per_period
            coarse(i) = .not. verdict%spectrum%sampling_sufficient
         end associate
      end do
      if (any(coarse)) then
         number = pack([(i, i=1, size(problems))], coarse)
         finer = group%verdicts(number)
         allocate (classified_by(size(number)))
         call classify_finer(problems(number), choices(number), noise_floors(number), request%accuracy, &
                             request%samples_per_period, group%endings(number)%samples/request%samples_per_period, &
                             group%records(number), finer, classified_by, only_class, group%error)
         group%verdicts(number) = finer
         group%classified_by(number) = classified_by
      end if
      do i = 1, size(problems)
         if (has_window(group%endings(i))) call note_orbit(group%verdicts(i), group%endings(i)%orbit)
      end do
   end subroutine classify_group

   !> Look for the periodic motions at the ends of the scenes.
   subroutine find_orbits(problems, group)
      !> What moves
      type(problem_t), intent(in) :: problems(:)
      !> The solved scenes
      type(scene_group_t), intent(inout) :: group
      type(periodic_orbit_t) :: orbit
      integer :: i

      do i = 1, size(problems)
         if (must_stop()) return
         ! One that was seen to repeat after every period needs no search.
         if (.not. is_success(group%endings(i)%status) .or. group%endings(i)%orbit == 1) cycle
         orbit = nearby_orbit(problems(i), group%endings(i))
         if (orbit%period > 0) group%repeat_after(i) = orbit%period
      end do
   end subroutine find_orbits

   !> Learn more of the motions that are off their harmonics.
   subroutine follow_group(problems, group)
      !> What moves
      type(problem_t), intent(in) :: problems(:)
      !> The classified scenes
      type(scene_group_t), intent(inout) :: group

      associate (n => size(problems))
         call follow_irregular(problems, group%endings(:n), group%verdicts(:n), group%repeat_after(:n), group%paths(:n))
      end associate
   end subroutine follow_group

end module scene_group
