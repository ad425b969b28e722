!> Files of an earlier run that --resume finds at the places of its own: it goes on with those of its very scene, and never
!> replaces those of another.
module earlier_files
   use errors, only: error_t, exit_bad_input, raise
   use file_system, only: file_state_t, path_exists, state_of_path
   use input_difference, only: differing_keys
   use kinds, only: int64
   use output_place, only: profiles_path, result_path, state_path, summary_path
   use result_reader, only: result_reader_t
   use scene_status, only: status_name, status_not_written
   use scene_types, only: scene_t
   use summary_file, only: value_in_summary
   use version, only: program_version
   implicit none(type, external)
   private

   !> What to do with files that cannot be carried on.
   character(*), parameter, public :: begin_anew = '; --overwrite instead of --resume begins the run anew'

   public :: check_earlier_files, check_earlier_result, check_lone_summary, open_earlier

contains

   !> See that the results of an earlier run at the places of this one are of the same scene.
   subroutine check_earlier_files(scene, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Set if one is of another scene, or cannot be read
      type(error_t), allocatable, intent(out) :: error

      call check_earlier_result(scene, result_path(scene), [character(1) ::], error)
      if (.not. allocated(error)) call check_earlier_result(scene, profiles_path(scene), [character(1) ::], error)
      if (.not. allocated(error)) call check_lone_summary(scene, error)
   end subroutine check_earlier_files

   !> See that a result of an earlier run, if one stands there, is of this scene.
   subroutine check_earlier_result(scene, path, free, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      character(*), intent(in) :: path
      !> Keys that may have changed since
      character(*), intent(in) :: free(:)
      !> Set if it is of another scene, or cannot be read
      type(error_t), allocatable, intent(out) :: error
      type(result_reader_t) :: reader
      type(file_state_t) :: kept

      kept = state_of_path(path)
      if (kept%bytes == 0_int64) return
      call open_earlier(scene, path, free, reader, error)
      call reader%close()
   end subroutine check_earlier_result

   !> A summary beside which nothing stands that holds an input could be that of any scene.
   subroutine check_lone_summary(scene, error)
      type(scene_t), intent(in) :: scene
      !> Set if there is such a summary, and a run has come to its end with it
      type(error_t), allocatable, intent(out) :: error
      type(file_state_t) :: kept(2)
      character(:), allocatable :: status
      logical :: stands

      kept = [state_of_path(result_path(scene)), state_of_path(state_path(scene))]
      stands = path_exists(summary_path(scene))
      if (any(kept%bytes > 0_int64) .or. .not. stands) return
      status = value_in_summary(summary_path(scene), 'status')
      if (status == '' .or. status == status_name(status_not_written)) return
      call raise(error, exit_bad_input, summary_path(scene)//' is of an earlier run whose result is missing, so that its input '// &
                 'is unknown'//begin_anew)
   end subroutine check_lone_summary

   !> Open a file of an earlier run of this scene.
   subroutine open_earlier(scene, path, free, reader, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      character(*), intent(in) :: path
      !> Keys that may have changed since
      character(*), intent(in) :: free(:)
      type(result_reader_t), intent(out) :: reader
      !> Set if it cannot be read or belongs to another scene
      type(error_t), allocatable, intent(out) :: error
      character(:), allocatable :: difference

      call reader%open(path, error)
      if (allocated(error)) then
         error%message = error%message//begin_anew
         return
      end if
      if (reader%from_another_version) then
         call raise(error, exit_bad_input, path//' was written by version '//reader%version//' of rattle, this is '// &
                    program_version//begin_anew)
         return
      end if
      difference = differing_keys(reader%input_text, scene%resolved_input, free)
      if (len(difference) > 0) call raise(error, exit_bad_input, path//' belongs to another scene: '//difference//begin_anew)
   end subroutine open_earlier

end module earlier_files
