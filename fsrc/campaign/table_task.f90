!> A task whose result is a table over many scenes that threads and ranks share, from its input to its files. Opening, ranks,
!> progress and closing are here; a task extends the type by the rest.
module table_task
   use campaign_plan, only: look_watcher_t
   use campaign_progress, only: campaign_progress_t
   use clock, only: wall_seconds
   use errors, only: error_t, exit_complete, exit_scene_failed, fault_list_t, raise
   use file_system, only: delete_file
   use finished_files, only: bring_back, drop_aside, set_aside
   use kinds, only: dp, int64
   use log_file, only: log_magic, log_t
   use output_lock, only: output_lock_t
   use output_place, only: claim_output_place, log_path, progress_path
   use ranks, only: abort_ranks, rank_count, share_number, this_rank, wait_for_ranks
   use scene_report, only: law_sentence, report_notes
   use scene_types, only: scene_t
   use signals, only: caught_signal
   use text, only: counted
   use text_output, only: put_error_line
   use version, only: program_version
   use word_list, only: word_t
   use, intrinsic :: omp_lib, only: omp_get_max_threads
   implicit none(type, external)
   private

   !> A task and what became of it.
   type, abstract, public :: table_task_t
      !> Checked base scene
      type(scene_t) :: scene
      !> Whether to go on with the files of an earlier run, if there are any
      logical :: carry_on = .false.
      !> What is odd about the scenes of the table, known once the task is prepared
      type(word_t), allocatable :: warnings(:)
      !> On rank 0, once the files are open: scenes of the table as far as they are known, and those that earlier runs have solved
      integer(int64) :: scenes = 0_int64, done_before = 0_int64
      type(campaign_progress_t) :: progress
      !> Log of rank 0
      type(log_t) :: log
      !> Wall time when the run began [s]
      real(dp) :: started = 0.0_dp
      !> Whether a signal has cut the run short, and how many of its scenes have failed
      logical :: is_cut = .false.
      integer(int64) :: failed = 0_int64
   contains
      !> Plan the table and look at its scenes
      procedure(prepare_table), deferred :: prepare
      !> What --check reports of a prepared task
      procedure(words_of_table), deferred :: check_lines
      !> Open the files on rank 0, and count what an earlier run has solved
      procedure(step_of_table), deferred :: open_files
      !> What the first line of the log says will be solved
      procedure(words_of_table), deferred :: heading
      !> Further lines of the log
      procedure(report_of_table), deferred :: report_start
      !> Solve on the threads of all ranks, without access to the files yet, until all is done or a signal asks to stop
      procedure(step_of_table), deferred :: solve
      !> Write result and summary, and say in the log what became of the task; what has failed before comes in as the error
      procedure(ending_of_table), deferred :: close_files
   end type table_task_t

   !> The place of the files and the log of a run: begun while the scenes are still looked at, where that takes long.
   type, extends(look_watcher_t) :: opening_t
      private
      type(scene_t) :: scene
      !> Input of the scene, for the faults
      character(:), allocatable :: file
      logical :: quiet = .false., verbose = .false., is_begun = .false.
      !> Wall time when the look began [s]
      real(dp) :: started = 0.0_dp
      type(campaign_progress_t) :: progress
      type(log_t) :: log
      !> Path of the log
      type(word_t) :: paths(1)
      type(output_lock_t) :: lock
      !> Why the run is refused
      type(fault_list_t) :: faults
      type(error_t), allocatable :: error
   contains
      procedure :: note_seen
      procedure :: undo
   end type opening_t

   abstract interface
      subroutine prepare_table(self, file, hurried, faults, watcher)
         import :: table_task_t, fault_list_t, look_watcher_t
         class(table_task_t), intent(inout) :: self
         !> Input of the scene, for the faults
         character(*), intent(in) :: file
         !> Whether to look at no more scenes than there is time for
         logical, intent(in) :: hurried
         !> Faults are appended
         type(fault_list_t), intent(inout) :: faults
         !> Gets a report of how far the look at the scenes is
         class(look_watcher_t), optional, intent(inout) :: watcher
      end subroutine prepare_table

      subroutine step_of_table(self, error)
         import :: table_task_t, error_t
         class(table_task_t), intent(inout) :: self
         !> Set if files could not be read or written
         type(error_t), allocatable, intent(out) :: error
      end subroutine step_of_table

      subroutine ending_of_table(self, error)
         import :: table_task_t, error_t
         class(table_task_t), intent(inout) :: self
         !> In: what has failed so far; out: also if a file could not be written
         type(error_t), allocatable, intent(inout) :: error
      end subroutine ending_of_table

      subroutine report_of_table(self)
         import :: table_task_t
         class(table_task_t), intent(in) :: self
      end subroutine report_of_table

      function words_of_table(self) result(words)
         import :: table_task_t
         class(table_task_t), intent(in) :: self
         character(:), allocatable :: words
      end function words_of_table
   end interface

   !> What the look at the scenes may take without a word [s]
   real(dp), parameter :: patience = 1.0_dp

   public :: run_table_task, check_table_task

contains

   !> Run a task and write its files. All ranks call this.
   subroutine run_table_task(task, scene, file, carry_on, quiet, faults, exit_code, error, verbose)
      !> New
      class(table_task_t), intent(inout) :: task
      !> Checked base scene
      type(scene_t), intent(in) :: scene
      !> Its input, for the faults
      character(*), intent(in) :: file
      !> Go on with the files of an earlier run, if there are any
      logical, intent(in) :: carry_on
      !> Nothing to the terminal
      logical, intent(in) :: quiet
      !> Faults of the input are appended; nothing has run then
      type(fault_list_t), intent(inout) :: faults
      !> Exit code of the program
      integer, intent(out) :: exit_code
      !> Set if files could not be written
      type(error_t), allocatable, intent(out) :: error
      !> All of the log to the terminal; absent: no
      logical, intent(in), optional :: verbose
      type(opening_t) :: opening

      task%started = wall_seconds()
      task%scene = scene
      task%carry_on = carry_on
      opening%scene = scene
      opening%file = file
      opening%quiet = quiet
      if (present(verbose)) opening%verbose = verbose
      opening%started = task%started
      call task%prepare(file, .false., faults, opening)
      if (this_rank() == 0) call open_task(task, opening, faults, exit_code, error)
      call share_number(exit_code)
      if (exit_code /= exit_complete) then
         call opening%lock%release(.true.)
         return
      end if
      ! Memory may lack on the machine of this rank alone.
      if (faults%count() > 0) then
         call raise(error, faults%exit_code, faults%sentence(1))
         call abort_ranks(error)
         return
      end if
      if (this_rank() == 0) call report_opening(task, opening%lock%warning)
      call task%progress%start(progress_path(scene), task%scenes, task%done_before, quiet)
      call task%solve(error)
      if (allocated(error)) call abort_ranks(error)
      call wait_for_ranks()
      call task%progress%add_up()
      if (this_rank() == 0) then
         call task%close_files(error)
         call task%log%close()
         exit_code = merge(exit_scene_failed, exit_complete, task%failed > 0_int64)
         if (task%is_cut) exit_code = 128 + caught_signal()
         if (allocated(error)) exit_code = error%exit_code
         if (quiet .and. exit_code == exit_scene_failed) &
            call put_error_line(file//': '//counted(task%failed, 'scene')//' failed; '//log_path(task%scene)//' has more')
      end if
      call opening%lock%release(allocated(error))
      call share_number(exit_code)
   end subroutine run_table_task

   !> What rank 0 does before anything is solved.
   subroutine open_task(task, opening, faults, exit_code, error)
      class(table_task_t), intent(inout) :: task
      type(opening_t), intent(inout) :: opening
      type(fault_list_t), intent(inout) :: faults
      !> Complete if the task can be solved
      integer, intent(out) :: exit_code
      type(error_t), allocatable, intent(out) :: error

      call faults%take(opening%faults)
      if (allocated(opening%error)) then
         call move_alloc(opening%error, error)
      else if (.not. opening%is_begun) then
         call claim_output_place(task%scene, opening%file, opening%lock, faults, error)
      end if
      if (caught_signal() /= 0) then
         ! The look at the scenes was cut short: there may be faults that are not known.
         exit_code = 128 + caught_signal()
      else if (faults%count() > 0) then
         exit_code = faults%exit_code
      else
         if (.not. allocated(error)) call task%open_files(error)
         task%log = opening%log
         if (.not. (allocated(error) .or. opening%is_begun)) &
            call task%log%open(log_path(task%scene), opening%quiet, error, opening%verbose)
         exit_code = exit_complete
         if (allocated(error)) exit_code = error%exit_code
      end if
      if (opening%is_begun) then
         if (exit_code /= exit_complete) call opening%undo()
         call drop_aside(opening%paths)
      end if
   end subroutine open_task

   !> Once the look at the scenes takes long, take the place of the files and begin the log; from then on report how far it is.
   subroutine note_seen(self, seen, all)
      class(opening_t), intent(inout) :: self
      integer(int64), intent(in) :: seen
      integer(int64), intent(in) :: all

      if (this_rank() > 0) return
      if (.not. self%is_begun) then
         if (wall_seconds() - self%started < patience) return
         call claim_output_place(self%scene, self%file, self%lock, self%faults, self%error)
         self%is_refused = allocated(self%error) .or. self%faults%count() > 0
         if (self%is_refused) return
         ! gfortran 12 loses the texts of a list that is built of function results.
         self%paths(1)%text = log_path(self%scene)
         call set_aside(self%paths)
         self%is_begun = .true.
         call self%log%open(log_path(self%scene), self%quiet, self%error, self%verbose)
         self%is_refused = allocated(self%error)
         if (self%is_refused) return
         call self%log%line(log_magic//program_version//', '//trim(self%scene%name)//': '//counted(all, 'scene')// &
                            ' to be looked at before the first is solved')
         call self%progress%start(progress_path(self%scene), all, 0_int64, self%quiet)
      end if
      self%progress%looked_at = seen
      if (self%progress%is_due()) call self%progress%report(self%log)
   end subroutine note_seen

   !> Leave the place of the files as it was, as nothing will be solved.
   subroutine undo(self)
      class(opening_t), intent(inout) :: self

      call self%log%close()
      call delete_file(log_path(self%scene))
      call delete_file(progress_path(self%scene))
      call bring_back(self%paths)
   end subroutine undo

   !> What will be solved, how, and what is odd about it.
   subroutine report_opening(task, warning)
      class(table_task_t), intent(in) :: task
      !> Of the lock; empty if there is none
      character(*), intent(in) :: warning

      call task%log%line(log_magic//program_version//', '//task%heading()//', '//law_sentence(task%scene)//'; '// &
                         counted(rank_count(), 'rank')//' of '//counted(omp_get_max_threads(), 'thread'))
      call report_notes(task%log, task%scene%warnings)
      call report_notes(task%log, task%warnings)
      call task%report_start()
      if (len(warning) > 0) call report_notes(task%log, [word_t(warning)])
   end subroutine report_opening

   !> --check of a task: however large its table is, this takes a few seconds.
   subroutine check_table_task(task, scene, file, lines, faults)
      !> New
      class(table_task_t), intent(inout) :: task
      !> Checked base scene
      type(scene_t), intent(in) :: scene
      !> Its input, for the faults
      character(*), intent(in) :: file
      !> What to report
      character(:), allocatable, intent(out) :: lines
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      integer :: i

      lines = ''
      task%scene = scene
      call task%prepare(file, .true., faults)
      if (faults%count() > 0) return
      do i = 1, size(task%warnings)
         lines = lines//'! '//task%warnings(i)%text//new_line('a')
      end do
      lines = lines//task%check_lines()
   end subroutine check_table_task

end module table_task
