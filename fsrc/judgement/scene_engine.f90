!> Which engine follows the motion of a scene: films in nodes have one of their own, the paper's method is asked for, and all else is
!> the controlled engine's.
module scene_engine
   use controlled_engine, only: solve_controlled
   use engine, only: checkpoint_t, ending_t, motion_watcher_t, sample_sink_t
   use errors, only: error_t
   use newmark_engine, only: solve_newmark
   use nodal_profiles, only: nodal_profiles_t
   use nodal_scene, only: choice_of, solve_nodal_scene
   use nodal_step, only: nodal_choice_t
   use problem, only: problem_t
   use prepared_scene, only: request_of
   use scene_types, only: method_taylor, scene_t
   use text_output, only: lock_texts, unlock_texts
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   public :: solve_scene

contains

   !> Solve the motion of a scene.
   subroutine solve_scene(scene, problem, sink, watcher, checkpoint, nodal, ending, record, error, profiles)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Takes the samples
      class(sample_sink_t), intent(inout) :: sink
      !> Told of progress
      class(motion_watcher_t), intent(inout) :: watcher
      !> State to carry on from, and then the one from which the run can be extended
      type(checkpoint_t), intent(inout) :: checkpoint
      !> How films in nodes are followed; of others it stays
      type(nodal_choice_t), intent(inout) :: nodal
      !> How it ended
      type(ending_t), intent(out) :: ending
      !> What the steps of the window tell
      type(window_record_t), intent(out) :: record
      !> Set if the sink failed
      type(error_t), allocatable, intent(out) :: error
      !> What is asked for of pressures and films in nodes, and then those of the window
      type(nodal_profiles_t), intent(inout), optional :: profiles

      call unlock_texts()
      if (problem%contact%film%in_nodes) then
         call choice_of(scene, problem, nodal)
         call solve_nodal_scene(scene, problem, nodal, request_of(scene), sink, watcher, ending, record, error, &
                                profiles, checkpoint)
      else if (scene%solver%method /= method_taylor) then
         call solve_newmark(problem, request_of(scene), sink, watcher, checkpoint, ending, record, error)
      else
         call solve_controlled(problem, request_of(scene), sink, watcher, checkpoint, ending, record, error)
      end if
      call lock_texts()
   end subroutine solve_scene

end module scene_engine
