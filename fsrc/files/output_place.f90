!> Where the files of a scene go, and whether they may go there. Looked at before anything runs.
module output_place
   use, intrinsic :: iso_c_binding, only: c_int
   use errors, only: error_t, error_words, exit_system, fault_list_t, is_shortage, last_error, raise
   use file_descriptor, only: close_descriptor, open_existing, read_and_write
   use file_system, only: file_state_t, first_bytes, is_directory, is_link, is_writable, make_directory, path_exists, state_of_path
   use log_file, only: log_magic
   use output_lock, only: lock_magic, lock_path, output_lock_t
   use motion_start, only: start_count
   use problem, only: problem_of
   use result_format, only: result_magic
   use scene_types, only: compute_profile, is_shared_task, scene_t, task_film, task_motion, task_threshold
   use summary_file, only: summary_magic
   use text, only: integer_text
   implicit none(type, external)
   private

   public :: stem, result_path, profiles_path, motions_path, has_motions_table, state_path, summary_path, &
             log_path, progress_path, check_output_place, claim_output_place

contains

   !> Path of the time series.
   pure function result_path(scene) result(path)
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: path

      path = stem(scene)//'.rattle'
   end function result_path

   !> Path of the pressure profiles of a film task, or of a motion whose films are solved in nodes.
   pure function profiles_path(scene) result(path)
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: path

      path = stem(scene)//'.profiles.rattle'
   end function profiles_path

   !> Path of the table of all motions of a scene.
   pure function motions_path(scene) result(path)
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: path

      path = stem(scene)//'.motions.rattle'
   end function motions_path

   !> Whether a scene has a table of its motions: where several starts are followed.
   pure logical function has_motions_table(scene)
      type(scene_t), intent(in) :: scene

      has_motions_table = .false.
      if (scene%task == task_motion .and. scene%solver%starts > 1) &
         has_motions_table = start_count(problem_of(scene), scene%solver) > 1
   end function has_motions_table

   !> Path of the progress of a campaign.
   pure function progress_path(scene) result(path)
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: path

      path = stem(scene)//'.progress.nml'
   end function progress_path

   !> Path of the state from which a run can be carried on.
   pure function state_path(scene) result(path)
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: path

      path = stem(scene)//'.state'
   end function state_path

   !> Path of the summary.
   pure function summary_path(scene) result(path)
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: path

      path = stem(scene)//'.summary.nml'
   end function summary_path

   !> Path of the log.
   pure function log_path(scene) result(path)
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: path

      path = stem(scene)//'.log'
   end function log_path

   !> Folder and name of the files of a scene; a part of a campaign or threshold says which it is.
   pure function stem(scene)
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: stem

      stem = trim(scene%output%directory)//'/'//trim(scene%name)
      if (scene%campaign%parts > 1) stem = stem//'.part-'//integer_text(scene%campaign%part)//'-of-'// &
                                           integer_text(scene%campaign%parts)
   end function stem

   !> Make the folder if it is missing, and see that every file of the scene can be written there.
   subroutine check_output_place(scene, file, may_make, faults)
      type(scene_t), intent(in) :: scene
      !> Its input, for the faults
      character(*), intent(in) :: file
      !> Whether a missing folder is made now; .false.: only what stands already is looked at
      logical, intent(in) :: may_make
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      character(:), allocatable :: directory
      logical :: made

      directory = trim(scene%output%directory)
      if (path_exists(directory)) then
         if (.not. is_directory(directory)) then
            call faults%add(file, 0, 'output', 'directory', "'"//directory//"' is a file; a folder is needed")
            return
         end if
      else if (may_make) then
         call make_directory(directory, made)
         if (.not. made) then
            call faults%add(file, 0, 'output', 'directory', "the folder '"//directory//"' cannot be made")
            return
         end if
      else
         return
      end if
      if (.not. is_writable(directory)) then
         call faults%add(file, 0, 'output', 'directory', "the folder '"//directory//"' is not writable")
         return
      end if
      if (scene%task /= task_motion .or. scene%output%series) call check_kind(result_path(scene), result_magic, .false.)
      if (has_motions_table(scene)) call check_kind(motions_path(scene), result_magic, .false.)
      if ((scene%task == task_film .and. scene%points%compute(compute_profile)) .or. scene%output%profiles) &
         call check_kind(profiles_path(scene), result_magic, .false.)
      if (scene%task == task_motion .or. scene%task == task_threshold) call check_kind(state_path(scene), result_magic, .false.)
      call check_kind(summary_path(scene), summary_magic, .false.)
      if (is_shared_task(scene%task)) call check_kind(progress_path(scene), summary_magic, .false.)
      call check_kind(log_path(scene), log_magic, .false.)
      call check_kind(lock_path(stem(scene)), lock_magic, .true.)

   contains

      !> What stands there begins with the magic, and may be replaced. An empty file holds nothing that could be lost: a
      !> run was killed before it wrote there.
      subroutine check_kind(path, magic, may_stand)
         character(*), intent(in) :: path
         character(*), intent(in) :: magic
         !> Whether it needs no leave to be replaced
         logical, intent(in) :: may_stand
         type(file_state_t) :: state
         character(len(magic)) :: start
         integer :: got
         integer(c_int) :: cause
         character(:), allocatable :: way_on
         logical :: ours, leads_away

         leads_away = is_link(path)
         if (leads_away) then
            call faults%add(file, 0, 'output', '', path//' is a link, which rattle did not make; it is neither followed nor '// &
                            'replaced')
            return
         end if
         way_on = ''
         if (is_shared_task(scene%task)) way_on = '--resume continues it, '
         state = state_of_path(path)
         got = 0
         if (.not. state%exists) return
         ! Pipes and devices are not opened: a pipe would wait for its other end.
         ours = state%is_file .and. state%bytes == 0
         if (state%is_file .and. .not. ours .and. len(magic) > 0) then
            call first_bytes(path, start, got, cause)
            ours = got == len(magic) .and. start == magic
            ! A crash of the machine may leave zeros where bytes were on their way to the disk, a full disk half a word.
            if (may_stand) ours = ours .or. verify(start(:got), achar(0)) == 0 .or. (got > 0 .and. index(magic, start(:got)) == 1)
         end if
         if (.not. ours .and. state%is_file .and. got == 0) then
            call add_unusable(path, 'read', cause)
         else if (.not. ours) then
            call faults%add(file, 0, 'output', '', path//' exists and was not written by rattle; it is never replaced')
         else if (state%bytes > 0 .and. .not. (may_stand .or. scene%output%overwrite)) then
            call faults%add(file, 0, 'output', 'overwrite', path//' exists; '//way_on//'--overwrite replaces it')
         else
            call try_to_write(path, cause)
            if (cause /= 0_c_int) call add_unusable(path, 'replaced', cause)
         end if
      end subroutine check_kind

      !> Why a file cannot be written, 0: it can.
      subroutine try_to_write(path, cause)
         character(*), intent(in) :: path
         integer(c_int), intent(out) :: cause
         integer(c_int) :: descriptor
         logical :: ignored

         cause = 0_c_int
         descriptor = open_existing(path, read_and_write)
         if (descriptor < 0_c_int) cause = last_error()
         if (descriptor >= 0_c_int) call close_descriptor(descriptor, ignored)
      end subroutine try_to_write

      !> A file that stands in the way, or of which nothing can be known, as the system has nothing to spare.
      subroutine add_unusable(path, what, cause)
         character(*), intent(in) :: path
         character(*), intent(in) :: what
         integer(c_int), intent(in) :: cause
         type(error_t), allocatable :: error

         if (is_shortage(cause)) then
            call raise(error, exit_system, path//' cannot be opened: '//error_words(cause))
            call faults%add_error(file, 'output', '', error)
         else
            call faults%add(file, 0, 'output', '', path//' exists and may not be '//what)
         end if
      end subroutine add_unusable

   end subroutine check_output_place

   !> Look at the place of a scene's files and take their lock, if there are no faults yet.
   subroutine claim_output_place(scene, file, lock, faults, error)
      type(scene_t), intent(in) :: scene
      !> Its input, for the faults
      character(*), intent(in) :: file
      !> The lock; the caller gives it back
      type(output_lock_t), intent(inout) :: lock
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      !> Set if another run has the lock, or it cannot be made
      type(error_t), allocatable, intent(out) :: error

      if (faults%count() == 0) call check_output_place(scene, file, .true., faults)
      if (faults%count() == 0) call lock%take(stem(scene), error)
      ! Another run may have written these files since they were looked at.
      if (faults%count() == 0 .and. .not. allocated(error)) call check_output_place(scene, file, .false., faults)
   end subroutine claim_output_place

end module output_place
