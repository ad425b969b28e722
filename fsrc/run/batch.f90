!> All scenes of a call: everything is checked before anything runs.
module batch
   use automatic_model, only: choose_model, closure_instead
   use check_report, only: resolved_lines
   use command_line, only: command_t
   use engine, only: checkpoint_t
   use earlier_files, only: check_earlier_files
   use errors, only: error_t, exit_complete, exit_scene_failed, fault_list_t
   use flank_contact, only: contact_of, inner_count
   use gearbox_table, only: check_earlier_table, pair_row_t, row_of_pair, whole_gearbox, write_table
   use judged_scene, only: judged_scene_t
   use key_table, only: find_key
   use memory_need, only: expect_scene_memory, scenes_that_fit
   use output_lock, only: output_lock_t
   use output_place, only: check_output_place, claim_output_place, log_path
   use prepared_scene, only: resolve
   use resume, only: load_state
   use run_film, only: run_film_task
   use run_scene, only: run_one_scene
   use run_sweep, only: run_sweep_task
   use scene_report, only: law_sentence
   use scene_status, only: is_success, status_complete, status_interrupted, status_sentence
   use scene_types, only: method_newmark, model_resolved, scene_t, task_film, task_motion, task_sweep
   use signals, only: caught_signal
   use text, only: counted, integer_text
   use text_output, only: end_turn, lock_texts, put_error_line, put_line, put_text, share_output, speak_for, unlock_texts
   use word_list, only: word_t
   use, intrinsic :: omp_lib, only: omp_get_max_threads
   implicit none(type, external)
   private

   !> What became of a scene of a call.
   type :: outcome_t
      logical :: is_over = .false.
      integer :: status = status_complete
      !> Motions that failed: the scene itself, or values of a sweep
      integer :: failed = 0
      !> Of the table, where the scene is a pair of a gearbox
      type(pair_row_t) :: row
      !> Of the whole gearbox, kept with the first of its pairs until the table is written
      type(output_lock_t) :: gearbox_lock
      !> Faults of the place of its files, trouble with them
      type(fault_list_t) :: faults
      type(error_t), allocatable :: error
   end type outcome_t

   public :: run_batch, print_faults

contains

   !> Check and run the scenes of a call.
   subroutine run_batch(command, scenes, exit_code)
      !> What the arguments ask for
      type(command_t), intent(in) :: command
      !> The scenes of its files
      type(scene_t), intent(in) :: scenes(:)
      !> Exit code of the program
      integer, intent(out) :: exit_code
      type(fault_list_t) :: faults

      exit_code = exit_complete
      call check_names(scenes, faults)
      call check_methods(scenes, faults)
      call check_memory(scenes, faults)
      if (.not. command%check) then
         ! Look first, make folders after, so that a fault in one scene leaves nothing behind for another.
         if (faults%count() == 0) call check_places(scenes, .false., faults)
         if (faults%count() == 0 .and. command%resume) call check_earlier_runs(scenes, faults)
         if (faults%count() == 0) call check_places(scenes, .true., faults)
      end if
      if (command%resume .and. caught_signal() /= 0) then
         exit_code = 128 + caught_signal()
      else if (faults%count() > 0) then
         call print_faults(faults)
         exit_code = faults%exit_code
      else if (command%check) then
         call show_resolved(scenes)
      else
         call run_all(command, scenes, exit_code)
      end if
   end subroutine run_batch

   !> Run the scenes, side by side where there are threads for it: begun and reported in their order, whoever is done first. A failed
   !> one does not stop the others. After a signal, or trouble with files, no more are begun.
   subroutine run_all(command, scenes, exit_code)
      type(command_t), intent(in) :: command
      type(scene_t), intent(in) :: scenes(:)
      integer, intent(out) :: exit_code
      type(outcome_t), allocatable :: outcomes(:)
      type(pair_row_t), allocatable :: rows(:)
      integer :: begun, reported, place
      logical :: is_ending, in_trouble

      exit_code = exit_complete
      allocate (outcomes(size(scenes)), rows(0))
      begun = 0
      reported = 0
      is_ending = .false.
      in_trouble = .false.
      call share_output(size(scenes))
      ! A thread that computes lets the others make texts; all else here is done by one at a time.
      !$omp parallel default(shared) private(place) num_threads(scenes_that_fit(scenes, omp_get_max_threads()))
      call lock_texts()
      do
         if (begun == size(scenes) .or. is_ending) exit
         begun = begun + 1
         place = begun
         call speak_for(place)
         call run_place(command, scenes, place, outcomes(place))
         is_ending = is_ending .or. has_trouble(outcomes(place)) .or. outcomes(place)%status == status_interrupted &
                     .or. caught_signal() /= 0
         outcomes(place)%is_over = .true.
         do while (reported < begun)
            if (.not. outcomes(reported + 1)%is_over) exit
            reported = reported + 1
            call speak_for(reported)
            call settle_place(command, scenes, outcomes, reported, is_ending .and. reported == begun, rows, in_trouble, exit_code)
            call end_turn()
         end do
      end do
      call speak_for(0)
      call unlock_texts()
      !$omp end parallel
      call share_output(0)
      do place = 1, size(scenes)
         call outcomes(place)%gearbox_lock%release(.true.)
      end do
   end subroutine run_all

   !> Run a scene while no other run can write its files. The first pair of a gearbox takes the lock of the table as well, so that
   !> another run of the gearbox is refused before it changes a pair.
   subroutine run_place(command, scenes, place, outcome)
      type(command_t), intent(in) :: command
      type(scene_t), intent(in) :: scenes(:)
      !> Which of them
      integer, intent(in) :: place
      type(outcome_t), intent(inout) :: outcome
      type(judged_scene_t) :: judged
      type(output_lock_t) :: lock
      type(scene_t) :: scene, warned

      scene = scenes(place)
      if (is_pair(scene) .and. first_pair(scenes, place) == place) then
         call claim_output_place(whole_gearbox(scene), scene%source, outcome%gearbox_lock, outcome%faults, outcome%error)
         if (.not. has_trouble(outcome) .and. command%resume) &
            call check_earlier_table(whole_gearbox(scene), names_of_gears(scenes), outcome%error)
      end if
      if (.not. has_trouble(outcome)) call claim_output_place(scene, scene%source, lock, outcome%faults, outcome%error)
      warned = scene
      if (allocated(lock%warning)) then
         if (len(lock%warning) > 0) call warn(warned, lock%warning)
      end if
      if (.not. has_trouble(outcome) .and. command%resume .and. scene%task /= task_motion) &
         call check_earlier_run(scene, outcome%error)
      if (.not. has_trouble(outcome)) call run_task(warned, command, judged, outcome%status, outcome%failed, outcome%error)
      if (is_pair(scene) .and. .not. has_trouble(outcome)) outcome%row = row_of_pair(scene, judged)
      call lock%release(has_trouble(outcome))
   end subroutine run_place

   !> Add a warning to those of a scene.
   subroutine warn(scene, warning)
      type(scene_t), intent(inout) :: scene
      character(*), intent(in) :: warning
      type(word_t), allocatable :: warnings(:)
      integer :: i

      allocate (warnings(size(scene%warnings) + 1))
      do i = 1, size(scene%warnings)
         warnings(i)%text = scene%warnings(i)%text
      end do
      warnings(size(warnings))%text = warning
      call move_alloc(warnings, scene%warnings)
   end subroutine warn

   !> What follows from the outcome of a scene, once all before it are settled: its row, the table of its gearbox, the exit code.
   subroutine settle_place(command, scenes, outcomes, place, is_last_begun, rows, in_trouble, exit_code)
      type(command_t), intent(in) :: command
      type(scene_t), intent(in) :: scenes(:)
      type(outcome_t), intent(inout) :: outcomes(:)
      !> Which of them
      integer, intent(in) :: place
      !> Whether the call is ending and no scene behind this one was begun
      logical, intent(in) :: is_last_begun
      !> Pairs of the gearbox whose table is still to come
      type(pair_row_t), allocatable, intent(inout) :: rows(:)
      !> Whether there was trouble with files: the first of it decides, and nothing follows
      logical, intent(inout) :: in_trouble
      integer, intent(inout) :: exit_code

      if (in_trouble) return
      associate (outcome => outcomes(place))
         if (is_pair(scenes(place)) .and. .not. has_trouble(outcome)) rows = [rows, outcome%row]
         if (size(rows) > 0 .and. (is_last_pair(scenes, place) .or. is_last_begun) .and. .not. has_trouble(outcome)) then
            call write_table(whole_gearbox(scenes(place)), count(scenes%gearbox == scenes(place)%gearbox), rows, command%quiet, &
                             outcome%error, command%verbose)
            call outcomes(first_pair(scenes, place))%gearbox_lock%release(allocated(outcome%error))
            rows = rows(:0)
         end if
         in_trouble = has_trouble(outcome)
         if (allocated(outcome%error)) then
            call put_error_line(outcome%error%message)
            exit_code = outcome%error%exit_code
         else if (in_trouble) then
            call print_faults(outcome%faults)
            exit_code = outcome%faults%exit_code
         else if (outcome%status == status_interrupted .or. &
                  (is_last_begun .and. place < size(scenes) .and. caught_signal() /= 0)) then
            exit_code = 128 + caught_signal()
         else if (outcome%failed > 0) then
            if (exit_code == exit_complete) exit_code = exit_scene_failed
            if (command%quiet) call put_error_line(failure_line(scenes(place), outcome))
         end if
      end associate
   end subroutine settle_place

   !> What became of a scene that failed, for who wants nothing but faults.
   function failure_line(scene, outcome) result(line)
      type(scene_t), intent(in) :: scene
      type(outcome_t), intent(in) :: outcome
      character(:), allocatable :: line

      line = scene%source//': '
      if (scene%task == task_motion) then
         if (scene%gearbox /= '') line = line//trim(scene%name)//': '
         line = line//status_sentence(outcome%status)
      else
         line = line//counted(outcome%failed, 'motion')//' failed;'
      end if
      line = line//' '//log_path(scene)//' has more'
   end function failure_line

   !> Whether the place of the files of a scene was taken, or they could not be written.
   pure logical function has_trouble(outcome)
      type(outcome_t), intent(in) :: outcome

      has_trouble = allocated(outcome%error) .or. outcome%faults%count() > 0
   end function has_trouble

   !> Whether a scene is one of several gear pairs of its input, of which there will be a table.
   pure logical function is_pair(scene)
      type(scene_t), intent(in) :: scene

      is_pair = scene%task == task_motion .and. scene%gearbox /= ''
   end function is_pair

   !> Whether a scene is the last pair of its input.
   pure logical function is_last_pair(scenes, place)
      type(scene_t), intent(in) :: scenes(:)
      integer, intent(in) :: place

      is_last_pair = is_pair(scenes(place))
      if (is_last_pair .and. place < size(scenes)) is_last_pair = scenes(place + 1)%gearbox /= scenes(place)%gearbox
   end function is_last_pair

   !> Place of the first pair of the gearbox of a pair.
   pure integer function first_pair(scenes, place)
      type(scene_t), intent(in) :: scenes(:)
      integer, intent(in) :: place

      first_pair = findloc(scenes%gearbox, scenes(place)%gearbox, dim=1)
   end function first_pair

   !> Run a scene, a film task or a sweep.
   subroutine run_task(scene, command, judged, status, failed, error)
      type(scene_t), intent(in) :: scene
      type(command_t), intent(in) :: command
      !> Result of a motion
      type(judged_scene_t), intent(out) :: judged
      integer, intent(out) :: status
      !> How many motions failed
      integer, intent(out) :: failed
      type(error_t), allocatable, intent(out) :: error

      failed = 0
      select case (scene%task)
      case (task_film)
         call run_film_task(scene, command%quiet, command%verbose, status, error)
      case (task_sweep)
         call run_sweep_task(scene, command%quiet, command%verbose, command%resume, status, failed, error)
      case default
         call run_one_scene(scene, command%quiet, command%verbose, command%resume, judged, status, error)
         if (.not. is_success(status)) failed = 1
      end select
   end subroutine run_task

   !> Two scenes of one name and folder would write the same files.
   subroutine check_names(scenes, faults)
      type(scene_t), intent(in) :: scenes(:)
      type(fault_list_t), intent(inout) :: faults
      integer :: i, j

      do i = 2, size(scenes)
         do j = 1, i - 1
            if (.not. share_files(scenes(i), scenes(j))) cycle
            call faults%add(scenes(i)%source, 0, 'scene', 'name', &
                            "'"//trim(scenes(i)%name)//"' is also the name of "//scenes(j)%source)
            exit
         end do
      end do
   end subroutine check_names

   !> Whether two scenes, or the tables of their gearboxes, would go by one name.
   pure logical function share_files(scene, other)
      type(scene_t), intent(in) :: scene
      type(scene_t), intent(in) :: other

      share_files = scene%name == other%name .or. scene%name == other%gearbox .or. scene%gearbox == other%name
      if (scene%gearbox /= '' .and. scene%source /= other%source) share_files = share_files .or. scene%gearbox == other%gearbox
   end function share_files

   !> Newmark's method follows h and h' alone.
   subroutine check_methods(scenes, faults)
      type(scene_t), intent(in) :: scenes(:)
      type(fault_list_t), intent(inout) :: faults
      integer :: i

      do i = 1, size(scenes)
         if (scenes(i)%task == task_film .or. scenes(i)%solver%method /= method_newmark) cycle
         if (inner_count(contact_of(scenes(i))) == 0) cycle
         call faults%add(scenes(i)%source, scenes(i)%lines(find_key('solver.method')), 'solver', 'method', &
                         'the paper''s method cannot follow a film with a state of its own; set method = ''taylor''')
      end do
   end subroutine check_methods

   !> There is memory for every scene.
   subroutine check_memory(scenes, faults)
      type(scene_t), intent(in) :: scenes(:)
      type(fault_list_t), intent(inout) :: faults
      type(error_t), allocatable :: error
      integer :: i

      do i = 1, size(scenes)
         call expect_scene_memory(scenes(i), error)
         if (allocated(error)) call faults%add_error(scenes(i)%source, '', '', error)
      end do
   end subroutine check_memory

   !> What earlier runs have left, and this one would carry on or replace, belongs to these very scenes.
   subroutine check_earlier_runs(scenes, faults)
      type(scene_t), intent(in) :: scenes(:)
      type(fault_list_t), intent(inout) :: faults
      type(error_t), allocatable :: error
      integer :: i

      do i = 1, size(scenes)
         call check_earlier_run(scenes(i), error)
         if (.not. allocated(error) .and. is_last_pair(scenes, i)) &
            call check_earlier_table(whole_gearbox(scenes(i)), names_of_gears(scenes), error)
         if (allocated(error)) call faults%add(scenes(i)%source, 0, '', '', error%message)
      end do
   end subroutine check_earlier_runs

   pure function names_of_gears(scenes) result(names)
      type(scene_t), intent(in) :: scenes(:)
      type(word_t), allocatable :: names(:)
      integer :: i

      names = [(word_t(trim(scenes(i)%gear%name)), i=1, size(scenes))]
   end function names_of_gears

   subroutine check_earlier_run(scene, error)
      type(scene_t), intent(in) :: scene
      !> Set if its files are of another scene
      type(error_t), allocatable, intent(out) :: error
      type(checkpoint_t) :: state
      type(scene_t) :: chosen

      if (scene%film%automatic .and. scene%task == task_motion) then
         call choose_model(scene, chosen, error)
         if (.not. allocated(error)) call load_state(chosen, state, error)
         ! Where films in nodes stopped, the earlier run went by the closure.
         if (allocated(error) .and. chosen%film%model == model_resolved) then
            deallocate (error)
            chosen = closure_instead(scene, chosen, 'in the earlier run')
            call load_state(chosen, state, error)
         end if
      else if (scene%task == task_motion) then
         call load_state(scene, state, error)
      else
         call check_earlier_files(scene, error)
      end if
   end subroutine check_earlier_run

   !> Every scene has a place for its files.
   subroutine check_places(scenes, may_make, faults)
      type(scene_t), intent(in) :: scenes(:)
      logical, intent(in) :: may_make
      type(fault_list_t), intent(inout) :: faults
      integer :: i

      do i = 1, size(scenes)
         call check_output_place(scenes(i), scenes(i)%source, may_make, faults)
         if (is_last_pair(scenes, i)) call check_output_place(whole_gearbox(scenes(i)), scenes(i)%source, may_make, faults)
      end do
   end subroutine check_places

   !> --check: every key with its value, and what follows from them.
   subroutine show_resolved(scenes)
      type(scene_t), intent(in) :: scenes(:)
      integer :: i, j

      do i = 1, size(scenes)
         call put_line('! '//scenes(i)%source//': valid; '//law_sentence(scenes(i)))
         do j = 1, size(scenes(i)%warnings)
            call put_line('! '//scenes(i)%warnings(j)%text)
         end do
         if (scenes(i)%task /= task_film) call put_line(resolved_lines(scenes(i), resolve(scenes(i))))
         call put_text(scenes(i)%resolved_input)
      end do
   end subroutine show_resolved

   !> Faults to standard error, one line each. A fault of the command line is found anew with every
   !> file, but reported once.
   subroutine print_faults(faults)
      !> All faults
      type(fault_list_t), intent(in) :: faults
      integer :: i, j

      do i = 1, faults%count()
         if (any([(faults%sentence(j) == faults%sentence(i), j=1, i - 1)])) cycle
         call put_error_line(faults%sentence(i))
      end do
      if (faults%not_kept() > 0) call put_error_line('and '//integer_text(faults%not_kept())//' faults more')
   end subroutine print_faults

end module batch
