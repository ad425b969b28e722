!> One scene from input to files: resolve, solve, judge, record.
module run_scene
   use automatic_model, only: choose_model, closure_instead, nodes_stopped
   use clock, only: wall_seconds
   use engine, only: checkpoint_t
   use errors, only: error_t
   use finished_files, only: place_files
   use single_motions, only: find_all_motions
   use gearbox_table, only: whole_gearbox
   use judge_group, only: judge_scenes, judgement_space_t
   use judged_scene, only: judged_scene_t
   use kinds, only: dp
   use log_file, only: log_t
   use nodal_profiles, only: nodal_profiles_t
   use motions_table, only: write_motions
   use output_place, only: has_motions_table, log_path, motions_path, profiles_path, result_path, state_path, summary_path
   use profiles_table, only: write_profiles
   use progress, only: progress_t
   use prepared_scene, only: prepare, prepared_scene_t
   use quantities, only: needs_of_summary
   use resume, only: load_state, save_state
   use sample_recorder, only: sample_recorder_t
   use scene_report, only: report_ending, report_start
   use scene_solution, only: solve_single
   use scene_status, only: is_success, status_complete, status_interrupted, status_name, status_not_written
   use scene_summary, only: write_scene_summary
   use scene_types, only: model_resolved, scene_t
   use short_report, only: report_short
   use signals, only: caught_signal
   use text, only: integer_text
   use word_list, only: word_t
   implicit none(type, external)
   private

   public :: run_one_scene

contains

   !> Run a scene and write its files. An error is one of the system (disk); how the physics ended
   !> stands in the status.
   subroutine run_one_scene(scene, quiet, verbose, carry_on, judged, status, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Nothing to the terminal
      logical, intent(in) :: quiet
      !> All of the log to the terminal
      logical, intent(in) :: verbose
      !> Take up the state of an earlier run, if there is one
      logical, intent(in) :: carry_on
      !> The result
      type(judged_scene_t), intent(out) :: judged
      !> Status of scene_status
      integer, intent(out) :: status
      !> Set if a file could not be written
      type(error_t), allocatable, intent(out) :: error
      type(scene_t) :: chosen
      type(checkpoint_t) :: state
      type(error_t), allocatable :: of_another_model

      if (.not. scene%film%automatic) then
         call run_by_its_model(scene, quiet, verbose, carry_on, judged, status, error)
         return
      end if
      status = status_not_written
      call choose_model(scene, chosen, error)
      if (allocated(error)) return
      ! What an earlier run has left says whether it came to its end in nodes.
      if (carry_on .and. chosen%film%model == model_resolved) call load_state(chosen, state, of_another_model)
      if (allocated(of_another_model)) then
         chosen = closure_instead(scene, chosen, 'in the earlier run')
      else
         call run_by_its_model(chosen, quiet, verbose, carry_on, judged, status, error)
         if (allocated(error) .or. .not. nodes_stopped(judged%status)) return
         chosen = closure_instead(scene, chosen, status_name(judged%status))
      end if
      call run_by_its_model(chosen, quiet, verbose, carry_on, judged, status, error)
   end subroutine run_one_scene

   !> Run a scene whose model of the film is found. Where one was to be chosen and films in nodes stop, nothing is written.
   subroutine run_by_its_model(scene, quiet, verbose, carry_on, judged, status, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Nothing to the terminal
      logical, intent(in) :: quiet
      !> All of the log to the terminal
      logical, intent(in) :: verbose
      !> Take up the state of an earlier run, if there is one
      logical, intent(in) :: carry_on
      !> The result
      type(judged_scene_t), intent(out) :: judged
      !> Status of scene_status
      integer, intent(out) :: status
      !> Set if a file could not be written
      type(error_t), allocatable, intent(out) :: error
      type(prepared_scene_t) :: prepared
      type(judgement_space_t) :: space
      type(judged_scene_t) :: judged_scenes(1)
      type(sample_recorder_t) :: recorder
      type(checkpoint_t) :: state
      type(nodal_profiles_t) :: profiles
      type(progress_t) :: watcher
      type(log_t), target :: log
      type(error_t), allocatable :: write_error
      real(dp) :: started, solve_seconds
      logical :: is_chosen_in_nodes

      status = status_complete
      is_chosen_in_nodes = scene%film%model == model_resolved .and. scene%film%model_words /= ''
      started = wall_seconds()
      solve_seconds = 0.0_dp
      prepared = prepare(scene)
      judged%resolved = prepared%resolved
      if (carry_on) call load_state(scene, state, error)
      if (carry_on .and. caught_signal() /= 0) then
         ! The files of the earlier run were not verified to their end; they stay as they are.
         status = status_interrupted
         judged%status = status
         return
      end if
      if (.not. allocated(error)) call log%open(log_path(scene), quiet, error, verbose)
      if (allocated(error)) return
      call report_start(log, scene, judged)
      if (state%orbit > 0) then
         call log%item('earlier run', 'found steady; its periodic motion is solved again from period '// &
                       integer_text(state%periods))
      else if (state%periods > 0) then
         call log%item('carried on', 'from period '//integer_text(state%periods))
      end if
      call recorder%open(scene, prepared%resolved%problem, result_path(scene), state%periods, error)
      if (.not. allocated(error)) then
         call watcher%start(log, 'periods', quiet)
         profiles%wanted = scene%output%profiles
         if (allocated(scene%output%profile_phases)) profiles%phases = scene%output%profile_phases
         call solve_single(prepared, recorder, watcher, state, space, error, profiles)
         call watcher%clear()
         solve_seconds = wall_seconds() - started
         if (allocated(error)) then
            judged%ending = space%group%endings(1)
         else
            call judge_scenes([prepared], needs_of_summary(scene%spectrum%verify), space, judged_scenes, error)
            if (.not. allocated(error)) call find_all_motions(scene, started, space%tight, judged_scenes, error)
            judged = judged_scenes(1)
         end if
         judged%nodes_stopped = scene%film%nodes_stopped
         ! A signal that came meanwhile has cut the verification short.
         if (is_success(judged%status) .and. caught_signal() /= 0) judged%status = status_interrupted
         if (judged%judged) call recorder%add_extremes(space%group%records(1), &
                                                       judged%ending%periods - judged%window_periods, judged%series_coarse)
         call recorder%close(write_error)
         if (.not. allocated(error) .and. allocated(write_error)) call move_alloc(write_error, error)
         if (.not. allocated(error) .and. is_chosen_in_nodes .and. nodes_stopped(judged%status)) then
            call log%item('ended', status_name(judged%status)//': the film is solved by the closure instead')
            call log%close()
            return
         end if
         if (.not. allocated(error)) call save_state(scene, state, error)
         if (.not. allocated(error) .and. has_motions_table(scene)) call write_motions(scene, judged, error)
         if (.not. allocated(error) .and. scene%output%profiles) call write_profiles(scene, judged, profiles, error)
      end if
      if (allocated(error)) judged%status = status_not_written
      call write_scene_summary(summary_path(scene), scene, judged, paths_of(scene%output%series, result_path(scene)), &
                               wall_seconds() - started, write_error, paths_of(has_motions_table(scene), motions_path(scene)), &
                               paths_of(scene%output%profiles, profiles_path(scene)))
      if (.not. allocated(error) .and. allocated(write_error)) call move_alloc(write_error, error)
      if (scene%gearbox /= '') then
         call place_files(result_files(scene), summary_path(scene), error, summary_path(whole_gearbox(scene)))
      else
         call place_files(result_files(scene), summary_path(scene), error)
      end if
      if (.not. allocated(error)) then
         call report_ending(log, scene, judged, solve_seconds)
         call report_short(log, scene, judged)
      end if
      if (allocated(error)) judged%status = status_not_written
      status = judged%status
      if (allocated(error)) call log%item('error', error%message)
      call log%close()
   end subroutine run_by_its_model

   !> Series, state, table of motions and profiles.
   pure function result_files(scene) result(paths)
      type(scene_t), intent(in) :: scene
      type(word_t), allocatable :: paths(:)
      integer :: n

      ! One by one: gfortran 12 loses the texts of a list that is built of function results.
      n = merge(2, 1, scene%output%series)
      allocate (paths(n + merge(1, 0, has_motions_table(scene)) + merge(1, 0, scene%output%profiles)))
      if (scene%output%series) paths(1)%text = result_path(scene)
      paths(n)%text = state_path(scene)
      if (has_motions_table(scene)) paths(n + 1)%text = motions_path(scene)
      if (scene%output%profiles) paths(size(paths))%text = profiles_path(scene)
   end function result_files

   !> The path of a file, if there is one.
   pure function paths_of(exists, path) result(paths)
      logical, intent(in) :: exists
      character(*), intent(in) :: path
      type(word_t), allocatable :: paths(:)

      allocate (paths(merge(1, 0, exists)))
      if (exists) paths(1)%text = path
   end function paths_of

end module run_scene
