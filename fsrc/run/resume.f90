!> Carrying on: NAME.state keeps the state of a run from which it can be extended, and --resume takes it up.
!>
!> The state is that at the start of the last window (or the last period before, if the run did not get so far), so
!> that the window of the longer run is complete however little longer it is.
module resume
   use checkpoint, only: checkpoint_t
   use errors, only: error_t, exit_bad_input, raise
   use file_system, only: path_exists
   use kinds, only: dp, int64
   use output_place, only: state_path
   use result_reader, only: result_reader_t
   use result_writer, only: result_writer_t
   use scene_types, only: scene_t
   use text, only: integer_text
   implicit none(type, external)
   private

   character(*), parameter :: state_names(9) = [character(12) :: 'periods', 'film', 'velocity', 'acceleration', 'momentum', &
                                                'implicit', 'steps', 'evaluations', 'cuts']
   character(*), parameter :: state_units(9) = [character(4) :: '-', 'm', 'm/s', 'm/s2', '-', '-', '-', '-', '-']

   !> Keys that may change when a run is carried on: they do not touch what has been solved.
   character(*), parameter :: free_keys(9) = [character(24) :: 'periods', 'time_limit', 'line_threshold', 'idle_lines', &
                                              'quiet_limit', 'irregular_limit', 'certify', 'certificate_tolerance', 'until']

   public :: save_state, load_state

contains

   !> Write the state of a run.
   subroutine save_state(scene, state, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Its state
      type(checkpoint_t), intent(in) :: state
      !> Set if the file cannot be written
      type(error_t), allocatable, intent(out) :: error
      type(result_writer_t) :: writer
      real(dp) :: row(size(state_names), 1)

      row(:, 1) = [real(state%periods, dp), state%film, state%velocity, state%acceleration, state%momentum, &
                   merge(1.0_dp, 0.0_dp, state%implicit), real(state%steps, dp), real(state%evaluations, dp), &
                   real(state%cuts, dp)]
      call writer%open(state_path(scene), scene%resolved_input, state_names, state_units, error)
      if (.not. allocated(error)) call writer%write_rows(row, error)
      if (.not. allocated(error)) call writer%close(error)
   end subroutine save_state

   !> Read the state of an earlier run of a scene; without one the run begins at t = 0.
   subroutine load_state(scene, state, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Its state
      type(checkpoint_t), intent(out) :: state
      !> Set if the file is damaged or belongs to another scene
      type(error_t), allocatable, intent(out) :: error
      type(result_reader_t) :: reader
      real(dp) :: row(size(state_names), 1)
      character(:), allocatable :: changed

      if (.not. path_exists(state_path(scene))) return
      call reader%open(state_path(scene), error)
      if (.not. allocated(error)) call reader%read_rows(1_int64, row, error)
      call reader%close()
      if (allocated(error)) return
      changed = changed_key(reader%input_text, scene%resolved_input)
      if (len(changed) > 0) then
         call raise(error, exit_bad_input, state_path(scene)//' belongs to another scene: '//changed//' was different')
         return
      end if
      state%periods = nint(row(1, 1))
      state%film = row(2, 1)
      state%velocity = row(3, 1)
      state%acceleration = row(4, 1)
      state%momentum = row(5, 1)
      state%implicit = row(6, 1) > 0.5_dp
      state%steps = nint(row(7, 1), int64)
      state%evaluations = nint(row(8, 1), int64)
      state%cuts = nint(row(9, 1), int64)
      if (state%periods > scene%solver%periods - scene%spectrum%periods) then
         call raise(error, exit_bad_input, state_path(scene)//' is at period '//integer_text(state%periods)// &
                    '; the window of this run would begin before')
      end if
   end subroutine load_state

   !> First key, as group.key, whose line differs between two resolved inputs; empty if none does.
   pure function changed_key(old, new) result(key)
      character(*), intent(in) :: old
      character(*), intent(in) :: new
      character(:), allocatable :: key

      key = missing_in(new, old)
      if (len(key) == 0) key = missing_in(old, new)

   contains

      !> First line of a text that is not in the other one.
      pure function missing_in(text, other) result(found)
         character(*), intent(in) :: text
         character(*), intent(in) :: other
         character(:), allocatable :: found
         character(:), allocatable :: group, line
         integer :: from, length

         found = ''
         group = ''
         from = 1
         do while (from <= len(text))
            length = index(text(from:)//new_line('a'), new_line('a')) - 1
            line = text(from:from + length - 1)
            from = from + length + 1
            if (line(1:1) == '&') group = line(2:)
            if (index(line, '=') == 0) cycle
            if (any(free_keys == adjustl(line(:index(line, '=') - 1)))) cycle
            if (index(other, line//new_line('a')) > 0) cycle
            found = group//'.'//trim(adjustl(line(:index(line, '=') - 1)))
            return
         end do
      end function missing_in

   end function changed_key

end module resume
