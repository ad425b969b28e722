!> What a threshold has found so far: the rows of its result with their counts, and all points of the traces under way, kept as
!> NAME.state for --resume.
module threshold_outcome
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_quiet_nan, ieee_value
   use byte_file, only: put_in_place
   use campaign_axis, only: grid_value
   use clock, only: wall_seconds
   use errors, only: error_t, exit_bad_input, raise
   use file_system, only: file_state_t, state_of_path
   use key_table, only: keys
   use kinds, only: dp, int64
   use log_file, only: log_t
   use output_place, only: result_path, state_path
   use prepared_threshold, only: prepared_threshold_t
   use quantities, only: quantity_table
   use result_format, only: column_name_bytes, column_unit_bytes
   use result_reader, only: result_reader_t
   use result_writer, only: result_writer_t
   use ranks, only: add_over_ranks, share_number, this_rank
   use earlier_files, only: begin_anew, check_lone_summary, open_earlier
   use sampling, only: scene_values
   use scene_status, only: is_success
   use scene_types, only: scene_t
   use motion_branch, only: end_bracketed
   use threshold_ends, only: end_numbers, has_ends
   use threshold_search, only: bracket_t, is_crossing, is_verified, new_point, point_t, rows_of_traces
   use varied_keys, only: varied_name
   implicit none(type, external)
   private

   !> Numbers in the first row of a state, and in the row of a point
   integer, parameter :: counted_numbers = 8, point_numbers = 6

   !> What became of the thresholds so far.
   type, public :: outcome_t
      !> Rows of the result, one column of this array each
      real(dp), allocatable :: rows(:, :)
      !> Traces that are done, scenes that were solved for them and those of them that failed, and their crossings; traces without
      !> one, crossings with an end that is not verified, and crossings whose ends were verified only farther apart than asked for
      integer(int64) :: traces = 0_int64
      integer(int64) :: solved = 0_int64, failed = 0_int64, crossings = 0_int64, uncrossed = 0_int64, uncertain = 0_int64, &
                        wide = 0_int64
      !> What is known of the traces under way, by rising traces and places
      type(point_t), allocatable :: points(:)
      !> Whether a signal asked to stop
      logical :: cut = .false.
      !> When the state was kept last [s]
      real(dp) :: kept_at = 0.0_dp
   contains
      procedure :: age
   end type outcome_t

   public :: start_outcome, share_points, add_traces, solved_scenes, failed_scenes, end_counts, write_rows_of, save_outcome, &
             load_outcome, check_earlier_threshold

contains

   !> An outcome of nothing yet; one that was loaded stays.
   subroutine start_outcome(scene, threshold, outcome)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(outcome_t), intent(inout) :: outcome

      if (.not. allocated(outcome%rows)) allocate (outcome%rows(size(column_names(scene, threshold)), 0))
      if (.not. allocated(outcome%points)) allocate (outcome%points(0))
      outcome%kept_at = wall_seconds()
   end subroutine start_outcome

   !> How long ago the state was kept [s]
   real(dp) function age(self)
      class(outcome_t), intent(in) :: self

      age = wall_seconds() - self%kept_at
   end function age

   !> Enter some traces of which all is known: a row for each bracket, and one for a trace that has none, from end to end of its
   !> range. Their points are not needed any more.
   subroutine add_traces(scene, threshold, first, last, outcome, ends)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      !> First and last of the traces
      integer(int64), intent(in) :: first
      integer(int64), intent(in) :: last
      type(outcome_t), intent(inout) :: outcome
      !> Where the motions on both sides of each row end, as of threshold_ends; absent: not known
      real(dp), intent(in), optional :: ends(:, :)
      type(point_t), allocatable :: points(:)
      type(bracket_t), allocatable :: brackets(:)
      real(dp) :: motion_ends(end_numbers)
      real(dp), allocatable :: rows(:, :)
      integer :: k, crossing

      points = pack(outcome%points, outcome%points%trace >= first .and. outcome%points%trace <= last)
      outcome%points = pack(outcome%points, outcome%points%trace > last)
      allocate (brackets, source=rows_of_traces(points))
      allocate (rows(size(outcome%rows, 1), size(brackets)))
      motion_ends = ieee_value(0.0_dp, ieee_quiet_nan)
      crossing = 0
      do k = 1, size(brackets)
         associate (bracket => brackets(k))
            if (present(ends)) motion_ends = ends(:, k)
            if (k > 1) then
               if (brackets(k - 1)%lower%trace /= bracket%lower%trace) crossing = 0
            end if
            if (is_crossing(bracket)) then
               crossing = crossing + 1
               outcome%crossings = outcome%crossings + 1_int64
               if (.not. all(is_verified([bracket%lower, bracket%upper]))) outcome%uncertain = outcome%uncertain + 1_int64
               if (bracket%upper%place - bracket%lower%place > 1) outcome%wide = outcome%wide + 1_int64
            else
               outcome%uncrossed = outcome%uncrossed + 1_int64
            end if
            rows(:, k) = row_of(scene, threshold, crossing, bracket%lower, bracket%upper, motion_ends)
         end associate
      end do
      outcome%solved = outcome%solved + scenes_of(points)
      outcome%failed = outcome%failed + count(.not. is_success(points%status), kind=int64)
      outcome%traces = last - threshold%traces%first + 1_int64
      outcome%rows = reshape([outcome%rows, rows], [size(rows, 1), size(outcome%rows, 2) + size(rows, 2)])
   end subroutine add_traces

   !> Row of a bracket, or of a trace without one.
   function row_of(scene, threshold, crossing, lower, upper, motion_ends) result(row)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      !> Which one of its trace; 0: the trace has none
      integer, intent(in) :: crossing
      type(point_t), intent(in) :: lower
      type(point_t), intent(in) :: upper
      !> Where the motions on both sides end
      real(dp), intent(in) :: motion_ends(:)
      real(dp), allocatable :: row(:)
      real(dp) :: axes(size(threshold%traces%plan%positions)), ends(2), width, verified(2)

      call scene_values(threshold%traces%plan, lower%trace, axes)
      ends = [grid_value(threshold%axis, lower%place), grid_value(threshold%axis, upper%place)]
      width = ends(2) - ends(1)
      verified = [lower%verified, upper%verified]
      if (crossing == 0) width = ieee_value(0.0_dp, ieee_quiet_nan)
      if (crossing == 0) verified = ieee_value(0.0_dp, ieee_quiet_nan)
      row = [real(lower%trace, dp), axes, real(crossing, dp), ends, width, lower%quantity, upper%quantity, &
             real(lower%status, dp), real(upper%status, dp)]
      if (scene%spectrum%verify) row = [row, verified]
      if (has_ends(scene, threshold%axis%whole)) row = [row, motion_ends]
   end function row_of

   !> How many crossings have motions that were followed; at how many of them either side is possible, since motions of a side go on
   !> beyond the bracket; at how many an end is known to a bracket only, or not at all; and how many traces without a crossing have
   !> motions of another side.
   pure function end_counts(scene, threshold, outcome) result(counts)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(outcome_t), intent(in) :: outcome
      integer(int64) :: counts(4)
      integer :: lower, last, crossing

      counts = 0_int64
      if (.not. has_ends(scene, threshold%axis%whole)) return
      lower = size(threshold%traces%plan%positions) + 3
      last = size(outcome%rows, 1) - end_numbers
      do crossing = 1, size(outcome%rows, 2)
         associate (row => outcome%rows(:, crossing))
            associate (below => row(last + 1), above => row(last + 2), kinds => row(last + 3:))
               if (.not. row(lower - 1) > 0.0_dp) then
                  if (.not. ieee_is_nan(below)) counts(4) = counts(4) + 1_int64
                  cycle
               end if
               if (reaches(below, row(lower)) .or. reaches(-above, -row(lower + 1))) counts(1) = counts(1) + 1_int64
               if (reaches(below, nearest(row(lower + 1), 1.0_dp)) .or. reaches(-above, nearest(-row(lower), 1.0_dp))) &
                  counts(2) = counts(2) + 1_int64
               if (any(reaches(kinds, real(end_bracketed, dp)))) counts(3) = counts(3) + 1_int64
            end associate
         end associate
      end do
   end function end_counts

   !> Whether a number is as large as another; what is unknown, a NaN, is not.
   elemental logical function reaches(value, limit)
      real(dp), intent(in) :: value
      real(dp), intent(in) :: limit

      reaches = .false.
      if (.not. ieee_is_nan(value)) reaches = value >= limit
   end function reaches

   !> Scenes that were solved for some points: those put to the test were solved for that once more.
   pure integer(int64) function scenes_of(points)
      type(point_t), intent(in) :: points(:)

      scenes_of = size(points, kind=int64) + count(points%tested, kind=int64)
   end function scenes_of

   !> Scenes that were solved so far, and those of them that failed: of the traces that are done and of those under way.
   pure integer(int64) function solved_scenes(outcome)
      type(outcome_t), intent(in) :: outcome

      solved_scenes = outcome%solved + scenes_of(outcome%points)
   end function solved_scenes

   pure integer(int64) function failed_scenes(outcome)
      type(outcome_t), intent(in) :: outcome

      failed_scenes = outcome%failed + count(.not. is_success(outcome%points%status), kind=int64)
   end function failed_scenes

   !> Names of the columns.
   pure function column_names(scene, threshold) result(names)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      character(column_name_bytes), allocatable :: names(:)
      character(column_name_bytes), parameter :: sides(2) = [character(column_name_bytes) :: 'verified_below', 'verified_above']
      character(column_name_bytes), parameter :: ends(end_numbers) = &
         [character(column_name_bytes) :: 'last_below', 'last_above', 'motion_end_below', 'motion_end_above']
      character(column_name_bytes) :: axes(size(threshold%traces%plan%positions))
      character(:), allocatable :: quantity
      integer :: i

      do i = 1, size(axes)
         axes(i) = varied_name(threshold%traces%plan%positions(i))
      end do
      quantity = trim(quantity_table(scene%threshold%quantity)%name)
      names = [character(column_name_bytes) :: 'trace', axes, 'crossing', 'lower', 'upper', 'width', quantity//'_below', &
               quantity//'_above', 'status_below', 'status_above']
      if (scene%spectrum%verify) names = [names, sides]
      if (has_ends(scene, threshold%axis%whole)) names = [names, ends]
   end function column_names

   !> Units of the columns.
   pure function column_units(scene, threshold) result(units)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      character(column_unit_bytes), allocatable :: units(:)
      integer :: i

      associate (key => keys(threshold%axis%position)%unit, quantity => quantity_table(scene%threshold%quantity)%unit)
         units = [character(column_unit_bytes) :: '-', keys(threshold%traces%plan%positions)%unit, '-', key, key, key, quantity, &
                  quantity]
         where (units == '') units = '-'
         units = [units, [(units(1), i=1, merge(4, 2, scene%spectrum%verify))]]
         if (has_ends(scene, threshold%axis%whole)) &
            units = [units, units(size(threshold%traces%plan%positions) + [3, 3]), units(1), units(1)]
      end associate
   end function column_units

   !> Write rows to a file beside its place.
   subroutine write_rows_of(path, scene, threshold, rows, error)
      character(*), intent(in) :: path
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      real(dp), intent(in) :: rows(:, :)
      type(error_t), allocatable, intent(out) :: error
      type(result_writer_t) :: writer
      type(error_t), allocatable :: close_error

      call writer%open(path, scene%resolved_input, column_names(scene, threshold), column_units(scene, threshold), &
                       size(rows, 2, kind=int64), .false., error, threshold%traces%layout%source_checksum)
      if (.not. allocated(error)) call writer%write_rows(rows, error)
      call writer%close(close_error)
      if (.not. allocated(error) .and. allocated(close_error)) call move_alloc(close_error, error)
   end subroutine write_rows_of

   !> Keep the outcome as NAME.state: its counts as the first row, the rows of the traces that are done, then the points of those
   !> under way. Trouble with it ends nothing: only a run that is cut or killed needs it.
   subroutine save_outcome(scene, threshold, outcome, log)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(outcome_t), intent(inout) :: outcome
      type(log_t), intent(in) :: log
      type(error_t), allocatable :: error
      real(dp), allocatable :: table(:, :)
      integer :: done

      done = size(outcome%rows, 2)
      allocate (table(size(outcome%rows, 1), 1 + done + size(outcome%points)), source=0.0_dp)
      table(:counted_numbers, 1) = real([int(done, int64), outcome%traces, outcome%solved, outcome%failed, outcome%crossings, &
                                         outcome%uncrossed, outcome%uncertain, outcome%wide], dp)
      table(:, 2:1 + done) = outcome%rows
      table(:point_numbers, 2 + done:) = table_of(outcome%points)
      call write_rows_of(state_path(scene), scene, threshold, table, error)
      if (.not. allocated(error)) call put_in_place(state_path(scene), error)
      if (allocated(error)) call log%item('warning', error%message)
      outcome%kept_at = wall_seconds()
   end subroutine save_outcome

   !> Points as numbers.
   pure function table_of(points) result(table)
      type(point_t), intent(in) :: points(:)
      real(dp) :: table(point_numbers, size(points))
      integer :: i

      do i = 1, size(points)
         table(:, i) = [real(points(i)%trace, dp), real(points(i)%place, dp), real(points(i)%status, dp), points(i)%quantity, &
                        merge(1.0_dp, 0.0_dp, points(i)%tested), points(i)%verified]
      end do
   end function table_of

   !> Numbers as points.
   pure function points_of(scene, threshold, table) result(points)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      real(dp), intent(in) :: table(:, :)
      type(point_t) :: points(size(table, 2))
      integer :: i, place

      do i = 1, size(points)
         place = nint(table(2, i))
         points(i) = new_point(scene%threshold, point_t(trace=nint(table(1, i), int64), place=place, &
                                                        scanned=any(threshold%scan == place)), nint(table(3, i)), table(4, i))
         points(i)%tested = table(5, i) > 0.0_dp
         points(i)%verified = table(6, i)
      end do
   end function points_of

   !> Give the points that the first rank has loaded to all ranks.
   subroutine share_points(scene, threshold, outcome)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(outcome_t), intent(inout) :: outcome
      real(dp), allocatable :: table(:, :)
      integer :: count

      count = size(outcome%points)
      call share_number(count)
      allocate (table(point_numbers, count), source=0.0_dp)
      if (this_rank() == 0) table = table_of(outcome%points)
      call add_over_ranks(table)
      outcome%points = points_of(scene, threshold, table)
   end subroutine share_points

   !> Read the outcome that an earlier run has kept; without one there is none.
   subroutine load_outcome(scene, threshold, outcome, error)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(outcome_t), intent(inout) :: outcome
      !> Set if the state is damaged, or belongs to another scene or version
      type(error_t), allocatable, intent(out) :: error
      character(column_name_bytes), allocatable :: names(:)
      type(result_reader_t) :: reader
      integer :: done
      type(file_state_t) :: kept
      real(dp), allocatable :: rows(:, :)

      kept = state_of_path(state_path(scene))
      if (kept%bytes == 0_int64) return
      call open_of_same_lines(state_path(scene), scene, threshold, reader, error)
      if (.not. allocated(error)) then
         names = column_names(scene, threshold)
         if (size(names) /= reader%columns) then
            call raise(error, exit_bad_input, state_path(scene)//' was kept by another version of rattle, with other columns'// &
                       begin_anew)
         else if (any(names /= reader%names)) then
            call raise(error, exit_bad_input, state_path(scene)//' was kept by another version of rattle, with other columns'// &
                       begin_anew)
         end if
      end if
      if (.not. allocated(error)) call reader%verify_rows(reader%row_count, error)
      if (.not. allocated(error)) then
         allocate (rows(reader%columns, reader%row_count))
         call reader%read_rows(1_int64, rows, error)
      end if
      call reader%close()
      if (allocated(error)) return
      associate (numbers => nint(rows(:counted_numbers, 1), int64))
         done = int(numbers(1))
         outcome%traces = numbers(2)
         outcome%solved = numbers(3)
         outcome%failed = numbers(4)
         outcome%crossings = numbers(5)
         outcome%uncrossed = numbers(6)
         outcome%uncertain = numbers(7)
         outcome%wide = numbers(8)
      end associate
      outcome%rows = rows(:, 2:1 + done)
      outcome%points = points_of(scene, threshold, rows(:point_numbers, 2 + done:))
   end subroutine load_outcome

   !> Where an earlier run has kept no state, its result, if there is one, must be that of this scene: it will be replaced. A state
   !> of this scene is that of a run which was allowed to replace the result.
   subroutine check_earlier_threshold(scene, threshold, error)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      !> Set if it is of another scene, or cannot be read
      type(error_t), allocatable, intent(out) :: error
      type(result_reader_t) :: reader
      type(file_state_t) :: kept

      kept = state_of_path(result_path(scene))
      if (kept%bytes > 0_int64) call open_of_same_lines(result_path(scene), scene, threshold, reader, error)
      call reader%close()
      if (.not. allocated(error)) call check_lone_summary(scene, error)
   end subroutine check_earlier_threshold

   !> Open a file of an earlier run of this scene with the same traces.
   subroutine open_of_same_lines(path, scene, threshold, reader, error)
      character(*), intent(in) :: path
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(result_reader_t), intent(inout) :: reader
      !> Set if it cannot be read, or belongs to another scene or other traces
      type(error_t), allocatable, intent(out) :: error

      call open_earlier(scene, path, [character(1) ::], reader, error)
      if (.not. allocated(error) .and. reader%source_checksum /= threshold%traces%layout%source_checksum) &
         call raise(error, exit_bad_input, path//' belongs to other traces: their CSV file has changed since'//begin_anew)
   end subroutine open_of_same_lines

end module threshold_outcome
