!> Carrying on: NAME.state keeps the state of a run from which it can be extended, and --resume takes it up.
!>
!> The state is that at the start of the last window (or the last period before, if the run did not get so far), so
!> that the window of the longer run is complete however little longer it is. Of a run until steady it is the last at
!> which the longer run would still look for repetition, with all that the search looks back on; once the motion is
!> known to repeat, the state at the start of the one orbit that it is judged by.
module resume
   use engine, only: checkpoint_t, last_search_period
   use earlier_files, only: begin_anew, check_earlier_result, check_lone_summary, open_earlier
   use errors, only: error_t, exit_bad_input, raise
   use file_system, only: file_state_t, state_of_path
   use film_state, only: state_number_t
   use kinds, only: dp, int64
   use output_place, only: motions_path, profiles_path, result_path, state_path
   use nodal_state, only: size_of_motion
   use problem, only: problem_of, state_numbers
   use repetition, only: kept_states, orbit_watch_t
   use result_format, only: column_name_bytes, column_unit_bytes
   use result_reader, only: result_reader_t
   use result_writer, only: result_writer_t
   use sample_recorder, only: series_rows
   use scene_types, only: method_taylor, model_resolved, scene_t, until_steady
   use text, only: integer_text
   implicit none(type, external)
   private

   !> Columns of a file of state; the numbers of the state follow, and those that the search for repetition looks back on.
   character(*), parameter :: head_names(11) = [character(column_name_bytes) :: 'periods', 'acceleration', 'lienard_variable', &
                                                'implicit', 'steps', 'evaluations', 'cuts', 'orbit', 'watch_count', &
                                                'watch_newest', 'watch_states']
   character(*), parameter :: head_units(11) = [character(column_unit_bytes) :: '-', 'm/s2', '-', '-', '-', '-', '-', '-', '-', &
                                                '-', '-']

   !> Keys that may change when a run is carried on: they do not touch what has been solved.
   character(*), parameter :: free_keys(15) = [character(31) :: 'solver.periods', 'solver.starts', 'solver.time_limit', &
                                               'solver.until', &
                                               'spectrum.periods', 'spectrum.harmonic_threshold', 'spectrum.idle_harmonics', &
                                               'spectrum.quiet_limit', 'spectrum.irregular_limit', 'spectrum.impact_limit', &
                                               'spectrum.verify', 'spectrum.verification_tolerance', &
                                               'output.profiles', 'output.profile_phases', 'output.profile_count']

   public :: save_state, load_state

contains

   !> Write the state of a run beside its place, for place_files to bring it there.
   subroutine save_state(scene, state, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Its state
      type(checkpoint_t), intent(in) :: state
      !> Set if the file cannot be written
      type(error_t), allocatable, intent(out) :: error
      type(result_writer_t) :: writer
      type(state_number_t), allocatable :: numbers(:)
      character(column_name_bytes), allocatable :: names(:)
      character(column_unit_bytes), allocatable :: units(:)
      real(dp), allocatable :: row(:, :)

      numbers = state_numbers(problem_of(scene))
      call columns_of(numbers, nodal_numbers(scene), names, units)
      allocate (row(size(names), 1))
      row(:, 1) = row_of(state, size(numbers), nodal_numbers(scene))
      call writer%open(state_path(scene), scene%resolved_input, names, units, 1_int64, .false., error)
      if (.not. allocated(error)) call writer%write_rows(row, error)
      if (.not. allocated(error)) call writer%close(error)
   end subroutine save_state

   !> Read the state of an earlier run of a scene; without one the run begins at t = 0.
   subroutine load_state(scene, state, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Its state
      type(checkpoint_t), intent(out) :: state
      !> Set if the file is damaged, belongs to another scene or version, or is no state that this run comes through
      type(error_t), allocatable, intent(out) :: error
      type(file_state_t) :: kept
      type(result_reader_t) :: reader
      type(state_number_t), allocatable :: numbers(:)
      character(column_name_bytes), allocatable :: names(:)
      character(column_unit_bytes), allocatable :: units(:)
      real(dp), allocatable :: row(:, :)

      kept = state_of_path(state_path(scene))
      if (kept%bytes == 0_int64) then
         call check_series(scene, error)
         if (.not. allocated(error)) call check_earlier_result(scene, motions_path(scene), free_keys, error)
         if (.not. allocated(error)) call check_earlier_result(scene, profiles_path(scene), free_keys, error)
         if (.not. allocated(error)) call check_lone_summary(scene, error)
         return
      end if
      numbers = state_numbers(problem_of(scene))
      call columns_of(numbers, nodal_numbers(scene), names, units)
      allocate (row(size(names), 1))
      call open_earlier(scene, state_path(scene), free_keys, reader, error)
      if (.not. allocated(error) .and. .not. equal_names(reader%names, names)) &
         call raise(error, exit_bad_input, state_path(scene)//' was kept by another version of rattle'//begin_anew)
      if (.not. allocated(error)) call reader%verify_rows(1_int64, error)
      if (.not. allocated(error)) call reader%read_rows(1_int64, row, error)
      call reader%close()
      if (.not. allocated(error)) call check_earlier_result(scene, motions_path(scene), free_keys, error)
      if (.not. allocated(error)) call check_earlier_result(scene, profiles_path(scene), free_keys, error)
      if (allocated(error)) return
      state = state_of(row(:, 1), size(numbers), nodal_numbers(scene))
      if (state%periods == 0) then
         call check_series(scene, error)
         return
      end if
      if (scene%solver%until /= until_steady) then
         ! The search ends here: what it has seen does not follow the motion any more.
         state%watch = orbit_watch_t()
         state%orbit = 0
      else if (state%watch%count == 0) then
         call raise(error, exit_bad_input, state_path(scene)//" was kept by a run with until = 'periods', which does not "// &
                    'watch whether the motion repeats'//begin_anew)
         return
      end if
      if (state%periods > latest_start(scene, state)) then
         call raise(error, exit_bad_input, state_path(scene)//' is at period '//integer_text(state%periods)// &
                    '; the window of this run would begin before')
         return
      end if
      call check_series(scene, error)
      if (allocated(error) .or. .not. scene%output%series) return
      call open_earlier(scene, result_path(scene), free_keys, reader, error)
      if (.not. allocated(error)) call reader%verify_rows(series_rows(scene, state%periods), error)
      call reader%close()
   end subroutine load_state

   !> See that an earlier series is of this scene. Where its run has come to an end and left no state, the run begins anew and
   !> must be the same; where it has a state, or was killed, the run goes further.
   subroutine check_series(scene, error)
      type(scene_t), intent(in) :: scene
      !> Set if it is of another scene, or would become shorter
      type(error_t), allocatable, intent(out) :: error
      type(file_state_t) :: series, state
      type(result_reader_t) :: reader

      series = state_of_path(result_path(scene))
      state = state_of_path(state_path(scene))
      if (series%bytes == 0_int64) return
      call open_earlier(scene, result_path(scene), free_keys, reader, error)
      call reader%close()
      if (allocated(error)) return
      if (reader%row_count > series_rows(scene, scene%solver%periods)) then
         call raise(error, exit_bad_input, result_path(scene)//' holds '//integer_text(reader%row_count)//' rows; this run '// &
                    'would end after '//integer_text(series_rows(scene, scene%solver%periods))//begin_anew)
      else if (reader%row_count >= 0_int64 .and. state%bytes == 0_int64) then
         call check_earlier_result(scene, result_path(scene), [character(1) ::], error)
      end if
   end subroutine check_series

   !> Last period at which a run can take up a state and go on as if it had come there itself.
   pure integer function latest_start(scene, state)
      type(scene_t), intent(in) :: scene
      type(checkpoint_t), intent(in) :: state

      associate (periods => scene%solver%periods, window => scene%spectrum%periods)
         latest_start = periods - window
         if (scene%solver%until /= until_steady) return
         if (scene%solver%method == method_taylor .and. .not. (scene%film%model == model_resolved .and. state%orbit > 0)) then
            latest_start = last_search_period(periods, window)
         else if (state%orbit > 0) then
            latest_start = periods - state%orbit
         end if
      end associate
   end function latest_start

   !> Numbers of the histories of films in nodes, 0 where there are none.
   pure integer function nodal_numbers(scene)
      type(scene_t), intent(in) :: scene

      nodal_numbers = 0
      if (scene%film%model == model_resolved) nodal_numbers = size_of_motion(problem_of(scene), scene%film%nodes)
   end function nodal_numbers

   !> Columns of a file of state.
   pure subroutine columns_of(numbers, nodal, names, units)
      !> Of a state
      type(state_number_t), intent(in) :: numbers(:)
      !> How many there are of films in nodes
      integer, intent(in) :: nodal
      character(column_name_bytes), allocatable, intent(out) :: names(:)
      character(column_unit_bytes), allocatable, intent(out) :: units(:)
      integer :: place, age, i, n

      place = size(head_names)
      n = size(numbers)
      allocate (names(place + n + (n + 1)*kept_states + nodal), units(place + n + (n + 1)*kept_states + nodal))
      names(:place) = head_names
      units(:) = '-'
      units(:place) = head_units
      do i = 1, n
         names(place + i) = numbers(i)%name
         units(place + i) = numbers(i)%unit
      end do
      place = place + n
      do age = 1, kept_states
         do i = 1, n
            names(place + i) = 'watch_'//numbers(i)%name//'_'//integer_text(age)
         end do
         names(place + n + 1) = 'watch_thinnest_'//integer_text(age)
         place = place + n + 1
      end do
      do i = 1, nodal
         names(place + i) = 'nodal_'//integer_text(i)
      end do
   end subroutine columns_of

   !> Whether two lists of names are the same.
   pure logical function equal_names(some, others)
      character(*), intent(in) :: some(:)
      character(*), intent(in) :: others(:)

      equal_names = size(some) == size(others)
      if (equal_names) equal_names = all(some == others)
   end function equal_names

   !> A state as a row; see `state_of`.
   pure function row_of(state, numbers, nodal) result(row)
      !> One of 0 periods has no numbers yet
      type(checkpoint_t), intent(in) :: state
      !> How many it has, and how many of films in nodes
      integer, intent(in) :: numbers
      integer, intent(in) :: nodal
      real(dp), allocatable :: row(:)
      real(dp) :: values(numbers), watched(numbers + 1, kept_states), histories(nodal)

      associate (watch => state%watch)
         values = 0.0_dp
         if (allocated(state%numbers)) values = state%numbers
         watched = 0.0_dp
         if (allocated(watch%states)) watched(:numbers, :) = watch%states
         watched(numbers + 1, :) = watch%thinnest
         histories = 0.0_dp
         if (allocated(state%nodal)) histories = state%nodal
         row = [real(state%periods, dp), state%acceleration, state%lienard_variable, merge(1.0_dp, 0.0_dp, state%implicit), &
                real(state%count%steps, dp), real(state%count%evaluations, dp), real(state%count%cuts, dp), &
                real(state%orbit, dp), real(watch%count, dp), real(watch%newest, dp), &
                merge(1.0_dp, 0.0_dp, allocated(watch%states)), values, watched, histories]
      end associate
   end function row_of

   !> The state of a row; see `row_of`.
   pure function state_of(row, numbers, nodal) result(state)
      real(dp), intent(in) :: row(:)
      !> How many it has, and how many of films in nodes
      integer, intent(in) :: numbers
      integer, intent(in) :: nodal
      type(checkpoint_t) :: state
      real(dp) :: watched(numbers + 1, 0:kept_states - 1)
      integer :: place

      state%periods = nint(row(1))
      state%acceleration = row(2)
      state%lienard_variable = row(3)
      state%implicit = row(4) > 0.5_dp
      state%carried_on = state%periods > 0
      state%count%steps = nint(row(5), int64)
      state%count%evaluations = nint(row(6), int64)
      state%count%cuts = nint(row(7), int64)
      state%orbit = nint(row(8))
      place = size(head_names)
      allocate (state%numbers, source=row(place + 1:place + numbers))
      watched(:, :) = reshape(row(place + numbers + 1:size(row) - nodal), shape(watched))
      if (nodal > 0) allocate (state%nodal, source=row(size(row) - nodal + 1:))
      state%watch%count = nint(row(9))
      state%watch%newest = nint(row(10))
      if (row(11) > 0.5_dp) allocate (state%watch%states(numbers, 0:kept_states - 1), source=watched(:numbers, :))
      state%watch%thinnest = watched(numbers + 1, :)
   end function state_of

end module resume
