!> From prepared scenes to judged ones: scenes side by side by the controlled engine, a single one by the engine of its own.
module scene_solution
   use controlled_engine, only: solve_controlled
   use engine, only: same_request, checkpoint_t, ending_t, motion_state_t, motion_watcher_t, unwatched_t
   use errors, only: error_t
   use judge_group, only: judge_scenes, judgement_space_t
   use judged_scene, only: judged_scene_t
   use newmark_engine, only: solve_newmark
   use nodal_judgement, only: choice_of, solve_nodal_scene
   use nodal_profiles, only: nodal_profiles_t
   use node_extremes, only: seen_quantities
   use prepared_scene, only: prepare, prepared_scene_t
   use quantities, only: needs_of_summary
   use scene_group, only: solve_group, take_window
   use scene_types, only: method_taylor, scene_t
   use signals, only: must_stop
   use text_output, only: lock_texts, unlock_texts
   use window_keeper, only: window_keeper_t
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   public :: solve_and_judge, solve_single, solve_in_memory

contains

   !> Solve and judge scenes: side by side if all are asked for the same, else one by one. After a signal to stop the answers are of no
   !> use.
   subroutine solve_and_judge(scenes, starts, needed, space, judged, error)
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> Where each motion starts
      type(motion_state_t), intent(in) :: starts(:)
      !> What is to be found, by the codes of module quantities
      logical, intent(in) :: needed(:)
      !> Work space of this thread
      type(judgement_space_t), intent(inout) :: space
      type(judged_scene_t), intent(out) :: judged(:)
      !> Set if there is no memory for the samples of a scene
      type(error_t), allocatable, intent(out) :: error
      integer :: first, together

      if (size(scenes) == 0) return
      together = merge(size(scenes), 1, all(same_request(scenes%request, scenes(1)%request)))
      do first = 1, size(scenes), together
         associate (last => first + together - 1)
            call solve_group(scenes(first:last), starts(first:last), needed(:seen_quantities), space%group)
            if (must_stop()) return
            call judge_scenes(scenes(first:last), needed, space, judged(first:last), error)
         end associate
         if (must_stop() .or. allocated(error)) return
      end do
   end subroutine solve_and_judge

   !> Solve a single scene by its engine: films in nodes have one of their own, the paper's method is asked for, and all else is the
   !> controlled engine's.
   subroutine solve_single(scene, keeper, watcher, checkpoint, space, error, profiles)
      !> What is asked for becomes what was solved: the periods, and those of the window
      type(prepared_scene_t), intent(inout) :: scene
      !> Takes the samples
      class(window_keeper_t), intent(inout) :: keeper
      !> Informed of progress
      class(motion_watcher_t), intent(inout) :: watcher
      !> State to carry on from, and then the one from which the run can be extended
      type(checkpoint_t), intent(inout) :: checkpoint
      !> With the solved scene
      type(judgement_space_t), intent(inout) :: space
      !> Set if the samples could not be kept
      type(error_t), allocatable, intent(out) :: error
      !> What is asked for of pressures and films in nodes, and then those of the window
      type(nodal_profiles_t), intent(inout), optional :: profiles
      type(ending_t) :: ending
      type(window_record_t) :: record

      call unlock_texts()
      associate (problem => scene%resolved%problem)
         if (problem%contact%film%in_nodes) then
            call choice_of(scene, space%nodal)
            call solve_nodal_scene(scene, space%nodal, keeper, watcher, checkpoint, space%group, error, profiles)
         else
            if (scene%method /= method_taylor) then
               call solve_newmark(problem, scene%request, keeper, watcher, checkpoint, ending, record, error)
            else
               call solve_controlled(problem, scene%request, keeper, watcher, checkpoint, ending, record, error)
            end if
            call take_window(keeper%states, keeper%accelerations, ending, record, space%group)
         end if
      end associate
      call lock_texts()
      scene%request%periods = space%group%endings(1)%periods
      scene%request%sampled_periods = space%group%endings(1)%samples/scene%request%samples_per_period
      scene%request%until_steady = .false.
   end subroutine solve_single

   !> Solve and judge a single scene, as its own run does it, without any file.
   subroutine solve_in_memory(scene, judged, error)
      !> Checked scene whose films are in nodes or those of the closure
      type(scene_t), intent(in) :: scene
      type(judged_scene_t), intent(out) :: judged
      !> Set if there is not enough memory
      type(error_t), allocatable, intent(out) :: error
      type(prepared_scene_t) :: prepared
      type(judgement_space_t) :: space
      type(judged_scene_t) :: judged_scenes(1)
      type(window_keeper_t) :: keeper
      type(unwatched_t) :: unwatched
      type(checkpoint_t) :: state

      prepared = prepare(scene)
      call keeper%keep_windows_of(prepared%resolved%problem)
      call solve_single(prepared, keeper, unwatched, state, space, error)
      if (.not. allocated(error)) &
         call judge_scenes([prepared], needs_of_summary(scene%spectrum%verify), space, judged_scenes, error)
      judged = judged_scenes(1)
   end subroutine solve_in_memory

end module scene_solution
