!> One scene from input to files: resolve, solve, judge, record.
module run_scene
   use automatic_model, only: choose_model
   use clock, only: wall_seconds
   use engine, only: checkpoint_t, ending_t
   use errors, only: error_t
   use finished_files, only: place_files
   use follow_starts, only: find_all_motions
   use gearbox_table, only: whole_gearbox
   use judge_scene, only: judge, note_ending
   use judged_scene, only: judged_scene_t
   use kinds, only: dp
   use log_file, only: log_t
   use nodal_profiles, only: nodal_profiles_t
   use motions_table, only: write_motions
   use output_place, only: has_motions_table, log_path, motions_path, profiles_path, result_path, state_path, summary_path
   use profiles_table, only: write_profiles
   use progress, only: progress_t
   use prepared_scene, only: resolve
   use resume, only: load_state, save_state
   use sample_recorder, only: sample_recorder_t
   use scene_engine, only: solve_scene
   use scene_report, only: report_ending, report_start
   use scene_status, only: is_success, status_complete, status_interrupted, status_not_written
   use scene_summary, only: write_scene_summary
   use scene_types, only: model_resolved, scene_t
   use signals, only: caught_signal
   use text, only: integer_text
   use window_record, only: window_record_t
   use word_list, only: word_t
   implicit none(type, external)
   private

   public :: run_one_scene

contains

   !> Run a scene and write its files. An error is one of the system (disk); how the physics ended
   !> stands in the status.
   subroutine run_one_scene(scene, quiet, carry_on, judged, status, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Nothing to the terminal
      logical, intent(in) :: quiet
      !> Take up the state of an earlier run, if there is one
      logical, intent(in) :: carry_on
      !> The result
      type(judged_scene_t), intent(out) :: judged
      !> Status of scene_status
      integer, intent(out) :: status
      !> Set if a file could not be written
      type(error_t), allocatable, intent(out) :: error
      type(scene_t) :: chosen

      if (.not. scene%film%automatic) then
         call run_by_its_model(scene, quiet, carry_on, judged, status, error)
         return
      end if
      status = status_not_written
      call choose_model(scene, chosen, error)
      if (.not. allocated(error)) call run_by_its_model(chosen, quiet, carry_on, judged, status, error)
   end subroutine run_one_scene

   !> Run a scene whose model of the film is known.
   subroutine run_by_its_model(scene, quiet, carry_on, judged, status, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Nothing to the terminal
      logical, intent(in) :: quiet
      !> Take up the state of an earlier run, if there is one
      logical, intent(in) :: carry_on
      !> The result
      type(judged_scene_t), intent(out) :: judged
      !> Status of scene_status
      integer, intent(out) :: status
      !> Set if a file could not be written
      type(error_t), allocatable, intent(out) :: error
      type(ending_t) :: ending
      type(window_record_t) :: record
      type(sample_recorder_t) :: recorder
      type(checkpoint_t) :: state
      type(nodal_profiles_t) :: profiles
      type(progress_t) :: watcher
      type(log_t), target :: log
      type(error_t), allocatable :: write_error
      real(dp) :: started, solve_seconds

      status = status_complete
      started = wall_seconds()
      solve_seconds = 0.0_dp
      judged%resolved = resolve(scene)
      judged%nodes_stopped = scene%film%nodes_stopped
      if (carry_on) call load_state(scene, state, error)
      if (carry_on .and. caught_signal() /= 0) then
         ! The files of the earlier run were not verified to their end; they stay as they are.
         status = status_interrupted
         judged%status = status
         return
      end if
      if (.not. allocated(error)) call log%open(log_path(scene), quiet, error)
      if (allocated(error)) return
      call report_start(log, scene, judged)
      if (state%orbit > 0) then
   call log%line('  found steady by the earlier run; its periodic motion is solved again from period '//integer_text(state%periods))
      else if (state%periods > 0) then
         call log%line('  carried on from period '//integer_text(state%periods))
      end if
      call recorder%open(scene, judged%resolved%problem, result_path(scene), state%periods, error)
      if (.not. allocated(error)) then
         call watcher%start(log, 'periods', quiet)
         profiles%wanted = scene%output%profiles
         if (allocated(scene%output%profile_phases)) profiles%phases = scene%output%profile_phases
         call solve_scene(scene, judged%resolved%problem, recorder, watcher, state, judged%nodal, ending, record, error, profiles)
         call watcher%clear()
         solve_seconds = wall_seconds() - started
         call note_ending(ending, judged)
         if (.not. allocated(error)) call judge(scene, recorder, record, ending, judged, error)
         if (judged%judged .and. .not. allocated(error) .and. scene%film%model /= model_resolved) &
            call find_all_motions(scene, ending, started, judged, error)
         ! A signal that came meanwhile has cut the verification short.
         if (is_success(judged%status) .and. caught_signal() /= 0) judged%status = status_interrupted
         if (judged%judged) call recorder%add_extremes(record, judged%periods - judged%window_periods, judged%series_coarse)
         call recorder%close(write_error)
         if (.not. allocated(error) .and. allocated(write_error)) call move_alloc(write_error, error)
         if (.not. allocated(error)) call save_state(scene, state, error)
         if (.not. allocated(error) .and. has_motions_table(scene)) call write_motions(scene, judged, error)
         if (.not. allocated(error) .and. scene%output%profiles) call write_profiles(scene, judged, profiles, error)
      end if
      if (allocated(error)) judged%status = status_not_written
      call write_scene_summary(summary_path(scene), scene, judged, series_of(scene), wall_seconds() - started, write_error, &
                               motions_of(scene), profiles_of(scene))
      if (.not. allocated(error) .and. allocated(write_error)) call move_alloc(write_error, error)
      if (scene%gearbox /= '') then
         call place_files(result_files(scene), summary_path(scene), error, summary_path(whole_gearbox(scene)))
      else
         call place_files(result_files(scene), summary_path(scene), error)
      end if
      if (.not. allocated(error)) call report_ending(log, scene, judged, solve_seconds)
      if (allocated(error)) judged%status = status_not_written
      status = judged%status
      if (allocated(error)) call log%line('  '//error%message)
      call log%close()
   end subroutine run_by_its_model

   !> Series, state, table of motions and profiles.
   pure function result_files(scene) result(paths)
      type(scene_t), intent(in) :: scene
      type(word_t), allocatable :: paths(:)
      integer :: n

      ! One by one: gfortran 12 loses the texts of a list that is built of function results.
      n = merge(1, 0, scene%output%series)
      allocate (paths(n + 1 + merge(1, 0, has_motions_table(scene)) + merge(1, 0, scene%output%profiles)))
      if (n > 0) paths(1)%text = result_path(scene)
      paths(n + 1)%text = state_path(scene)
      if (has_motions_table(scene)) paths(n + 2)%text = motions_path(scene)
      if (scene%output%profiles) paths(size(paths))%text = profiles_path(scene)
   end function result_files

   !> The table of motions, if there is one.
   pure function motions_of(scene) result(paths)
      type(scene_t), intent(in) :: scene
      type(word_t), allocatable :: paths(:)

      allocate (paths(merge(1, 0, has_motions_table(scene))))
      if (size(paths) > 0) paths(1)%text = motions_path(scene)
   end function motions_of

   !> The profiles, if they are asked for.
   pure function profiles_of(scene) result(paths)
      type(scene_t), intent(in) :: scene
      type(word_t), allocatable :: paths(:)

      allocate (paths(merge(1, 0, scene%output%profiles)))
      if (size(paths) > 0) paths(1)%text = profiles_path(scene)
   end function profiles_of

   !> The series, if it is asked for.
   pure function series_of(scene) result(paths)
      type(scene_t), intent(in) :: scene
      type(word_t), allocatable :: paths(:)

      allocate (paths(0))
      if (scene%output%series) paths = [word_t(result_path(scene))]
   end function series_of

end module run_scene
