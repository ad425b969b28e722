!> What a call asks for: a campaign or threshold, or scenes one after the other.
module run_tasks
   use batch, only: print_faults, run_batch
   use command_line, only: command_t, most_threads
   use completed_scene, only: complete_scene
   use errors, only: error_t, exit_bad_input, exit_complete, fault_list_t
   use gearbox, only: base_of_pairs
   use key_table, only: choice_word
   use ranks, only: end_ranks, is_foreign_job, rank_count, start_ranks, this_rank
   use run_campaign, only: campaign_task_t
   use run_threshold, only: threshold_task_t
   use scene_reader, only: read_scenes
   use scene_types, only: is_shared_task, scene_t, task_threshold
   use signals, only: catch_signals, caught_signal
   use stack, only: expect_stacks_of_threads
   use table_task, only: check_table_task, run_table_task, table_task_t
   use text, only: integer_text
   use text_output, only: put_error_line, put_line, put_text
   use, intrinsic :: omp_lib, only: omp_get_max_threads, omp_set_num_threads
   implicit none(type, external)
   private

   public :: run_all_tasks

contains

   !> Read the inputs and hand them to who solves them. A campaign or threshold stands alone in its call.
   subroutine run_all_tasks(command, exit_code)
      !> What the arguments ask for
      type(command_t), intent(in) :: command
      !> Exit code of the program
      integer, intent(out) :: exit_code
      type(scene_t), allocatable :: scenes(:), pairs(:)
      type(fault_list_t) :: faults, found
      type(error_t), allocatable :: error
      integer :: i, j, before, threads

      if (command%threads > 0) call omp_set_num_threads(command%threads)
      allocate (scenes(0))
      do i = 1, size(command%files)
         before = faults%count()
         call read_scenes(command%files(i)%text, command%overrides, pairs, faults)
         if (faults%count() > before) cycle
         do j = 1, size(pairs)
            found = fault_list_t()
            call complete_scene(pairs(j), found)
            call faults%take(found)
         end do
         if (faults%count() > before) cycle
         if (is_shared_task(pairs(1)%task)) then
            call append(scenes, [base_of_pairs(pairs)])
         else
            call append(scenes, pairs)
         end if
      end do
      ! While it waits for an input, a pipe perhaps, a signal ends the program.
      call catch_signals()
      if (is_foreign_job()) call faults%add('rattle', 0, '', '', 'a launcher started several copies of this program, which was '// &
                                            'built without MPI: each would do all the work. MPI=1 make builds it with MPI')
      threads = omp_get_max_threads()
      if (threads > most_threads()) call faults%add('OMP_NUM_THREADS', 0, '', '', integer_text(threads)// &
                                                    ' threads are asked for; at most '//integer_text(most_threads())// &
                                                    ' are allowed on this machine')
      if (faults%count() == 0 .and. .not. command%check) call expect_stacks_of_threads(error)
      if (allocated(error)) call faults%add_error('rattle', '', '', error)
      if (faults%count() == 0 .and. size(scenes) > 1) then
         do i = 1, size(scenes)
            if (is_shared_task(scenes(i)%task)) call faults%add(scenes(i)%source, 0, 'scene', 'task', 'a '// &
                                                      choice_word('scene.task', scenes(i)%task)// &
                                                      ' must be the only input of a call')
         end do
      end if
      if (faults%count() > 0) then
         call print_faults(faults)
         exit_code = faults%exit_code
      else if (any(is_shared_task(scenes%task))) then
         call run_shared_task(command, scenes(1), exit_code)
      else
         call run_alone(command, scenes, exit_code)
      end if
   end subroutine run_all_tasks

   !> The tasks whose work threads and ranks share.
   subroutine make_table_task(code, task)
      !> Code of such a task
      integer, intent(in) :: code
      class(table_task_t), allocatable, intent(out) :: task

      select case (code)
      case (task_threshold)
         allocate (threshold_task_t :: task)
      case default
         allocate (campaign_task_t :: task)
      end select
   end subroutine make_table_task

   !> Put scenes behind others.
   subroutine append(scenes, more)
      type(scene_t), allocatable, intent(inout) :: scenes(:)
      type(scene_t), intent(in) :: more(:)
      type(scene_t), allocatable :: grown(:)
      integer :: i

      allocate (grown(size(scenes) + size(more)))
      do i = 1, size(scenes)
         grown(i) = scenes(i)
      end do
      do i = 1, size(more)
         grown(size(scenes) + i) = more(i)
      end do
      call move_alloc(grown, scenes)
   end subroutine append

   !> Scenes take one process: several would all do the same work.
   subroutine run_alone(command, scenes, exit_code)
      type(command_t), intent(in) :: command
      type(scene_t), intent(in) :: scenes(:)
      integer, intent(out) :: exit_code

      call start_ranks()
      exit_code = exit_bad_input
      if (rank_count() == 1) then
         call run_batch(command, scenes, exit_code)
      else if (this_rank() == 0) then
         call put_error_line('an MPI job of '//integer_text(rank_count())//' processes was started, but only a '// &
            'campaign or threshold can be divided; start motions, sweeps and film tasks without mpirun')
      end if
      call end_ranks()
   end subroutine run_alone

   !> Check or run the campaign or threshold; rank 0 does the talking.
   subroutine run_shared_task(command, scene, exit_code)
      type(command_t), intent(in) :: command
      type(scene_t), intent(inout) :: scene
      integer, intent(out) :: exit_code
      class(table_task_t), allocatable :: task
      type(fault_list_t) :: faults
      type(error_t), allocatable :: error
      character(:), allocatable :: lines
      integer :: i

      call make_table_task(scene%task, task)
      exit_code = exit_complete
      call start_ranks()
      if (command%check) then
         call check_table_task(task, scene, scene%source, lines, faults)
         if (caught_signal() /= 0) then
            exit_code = 128 + caught_signal()
         else if (faults%count() > 0) then
            exit_code = faults%exit_code
         else if (this_rank() == 0) then
            call put_line('! '//scene%source//': valid')
            do i = 1, size(scene%warnings)
               call put_line('! '//scene%warnings(i)%text)
            end do
            call put_line(lines)
            call put_text(scene%resolved_input)
         end if
      else
         call run_table_task(task, scene, scene%source, command%resume, command%quiet, faults, exit_code, &
                             error, command%verbose)
         if (this_rank() == 0 .and. allocated(error)) call put_error_line(error%message)
      end if
      if (this_rank() == 0 .and. faults%count() > 0) call print_faults(faults)
      call end_ranks()
   end subroutine run_shared_task

end module run_tasks
