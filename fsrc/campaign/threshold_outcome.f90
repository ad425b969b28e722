!> What a threshold has found so far: the rows of its result, and their counts, kept as NAME.state for --resume.
module threshold_outcome
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_quiet_nan, ieee_value
   use byte_file, only: put_in_place
   use campaign_axis, only: grid_value
   use errors, only: error_t, exit_bad_input, raise
   use file_system, only: file_state_t, state_of_path
   use key_table, only: keys
   use kinds, only: dp, int64
   use log_file, only: log_t
   use output_place, only: state_path
   use prepared_threshold, only: prepared_threshold_t
   use quantities, only: quantity_table
   use result_format, only: column_name_bytes, column_unit_bytes
   use result_reader, only: result_reader_t
   use result_writer, only: result_writer_t
   use resume, only: open_earlier
   use sampling, only: scene_values
   use scene_types, only: scene_t
   use threshold_search, only: bracket_t, point_t
   use varied_keys, only: varied_name
   implicit none(type, external)
   private

   !> Numbers in the first row of a state
   integer, parameter :: counted_numbers = 6

   !> What became of the thresholds so far.
   type, public :: outcome_t
      !> Rows of the result, one column of this array each
      real(dp), allocatable :: rows(:, :)
      !> Lines that are done
      integer(int64) :: lines = 0_int64
      integer(int64) :: solved = 0_int64, failed = 0_int64, crossings = 0_int64, uncrossed = 0_int64, uncertain = 0_int64
      !> Whether a signal asked to stop
      logical :: cut = .false.
   end type outcome_t

   public :: start_outcome, add_rows, write_rows_of, save_outcome, load_outcome

contains

   !> An outcome of nothing yet; one that was loaded stays.
   pure subroutine start_outcome(scene, threshold, outcome)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(outcome_t), intent(inout) :: outcome

      if (.not. allocated(outcome%rows)) allocate (outcome%rows(size(column_names(scene, threshold)), 0))
   end subroutine start_outcome

   !> Rows of some lines: one for each bracket, and one for a line that has none, from end to end of its range.
   subroutine add_rows(threshold, first, ends, brackets, certified, outcome)
      type(prepared_threshold_t), intent(in) :: threshold
      !> First of the lines
      integer(int64), intent(in) :: first
      !> First and last point of each line
      type(point_t), intent(in) :: ends(:, :)
      !> By rising lines and places
      type(bracket_t), intent(in) :: brackets(:)
      !> Of both ends of each bracket; of no use where that is not recorded
      real(dp), intent(in) :: certified(:, :)
      type(outcome_t), intent(inout) :: outcome
      real(dp), allocatable :: rows(:, :)
      real(dp) :: unknown
      integer(int64) :: line
      integer :: i, k, crossing

      unknown = ieee_value(0.0_dp, ieee_quiet_nan)
      allocate (rows(size(outcome%rows, 1), size(brackets) + size(ends, 2)))
      i = 0
      k = 0
      do line = first, first + size(ends, 2, kind=int64) - 1_int64
         crossing = 0
         do while (is_of_line(i + 1))
            i = i + 1
            crossing = crossing + 1
            call put(brackets(i)%lower, brackets(i)%upper)
         end do
         if (crossing == 0) call put(ends(1, line - first + 1_int64), ends(2, line - first + 1_int64))
         if (crossing == 0) outcome%uncrossed = outcome%uncrossed + 1_int64
      end do
      outcome%crossings = outcome%crossings + size(brackets, kind=int64)
      outcome%rows = reshape([outcome%rows, rows(:, :k)], [size(rows, 1), size(outcome%rows, 2) + k])

   contains

      pure logical function is_of_line(place)
         integer, intent(in) :: place

         is_of_line = place <= size(brackets)
         if (is_of_line) is_of_line = brackets(place)%line == line
      end function is_of_line

      subroutine put(lower, upper)
         type(point_t), intent(in) :: lower
         type(point_t), intent(in) :: upper
         logical :: stands
         integer :: axes

         k = k + 1
         axes = size(threshold%lines%plan%positions)
         rows(1, k) = real(line, dp)
         call scene_values(threshold%lines%plan, line, rows(2:1 + axes, k))
         rows(axes + 2:axes + 8, k) = [real(crossing, dp), grid_value(threshold%axis, lower%place), &
                                       grid_value(threshold%axis, upper%place), lower%quantity, upper%quantity, &
                                       real(lower%status, dp), real(upper%status, dp)]
         if (size(rows, 1) == axes + 8) return
         rows(axes + 9:axes + 10, k) = unknown
         if (crossing == 0) return
         rows(axes + 9:axes + 10, k) = certified(i, :)
         stands = .not. any(ieee_is_nan(certified(i, :)))
         if (stands) stands = all(certified(i, :) > 0.0_dp)
         if (.not. stands) outcome%uncertain = outcome%uncertain + 1_int64
      end subroutine put

   end subroutine add_rows

   !> Names of the columns.
   pure function column_names(scene, threshold) result(names)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      character(column_name_bytes), allocatable :: names(:)
      character(column_name_bytes), parameter :: sides(2) = [character(column_name_bytes) :: 'certified_below', 'certified_above']
      character(column_name_bytes) :: axes(size(threshold%lines%plan%positions))
      character(:), allocatable :: quantity
      integer :: i

      do i = 1, size(axes)
         axes(i) = varied_name(threshold%lines%plan%positions(i))
      end do
      quantity = trim(quantity_table(scene%threshold%quantity)%name)
      names = [character(column_name_bytes) :: 'line', axes, 'crossing', 'lower', 'upper', quantity//'_below', quantity//'_above', &
               'status_below', 'status_above']
      if (scene%spectrum%certify) names = [names, sides]
   end function column_names

   !> Units of the columns.
   pure function column_units(scene, threshold) result(units)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      character(column_unit_bytes), allocatable :: units(:)
      integer :: i

      associate (key => keys(threshold%axis%position)%unit, quantity => quantity_table(scene%threshold%quantity)%unit)
         units = [character(column_unit_bytes) :: '-', keys(threshold%lines%plan%positions)%unit, '-', key, key, quantity, quantity]
         where (units == '') units = '-'
         units = [units, [(units(1), i=1, merge(4, 2, scene%spectrum%certify))]]
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
                       size(rows, 2, kind=int64), .false., error, threshold%lines%layout%source_checksum)
      if (.not. allocated(error)) call writer%write_rows(rows, error)
      call writer%close(close_error)
      if (.not. allocated(error) .and. allocated(close_error)) call move_alloc(close_error, error)
   end subroutine write_rows_of

   !> Keep the outcome as NAME.state, its counts as the first row. Trouble with it ends nothing: only a run that is killed needs it.
   subroutine save_outcome(scene, threshold, outcome, log)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(outcome_t), intent(in) :: outcome
      type(log_t), intent(in) :: log
      type(error_t), allocatable :: error
      real(dp) :: counts(size(outcome%rows, 1), 1)

      counts = 0.0_dp
      counts(:counted_numbers, 1) = real([outcome%lines, outcome%solved, outcome%failed, outcome%crossings, outcome%uncrossed, &
                                          outcome%uncertain], dp)
      call write_rows_of(state_path(scene), scene, threshold, reshape([counts, outcome%rows], &
                                                              [size(counts), size(outcome%rows, 2) + 1]), error)
      if (.not. allocated(error)) call put_in_place(state_path(scene), error)
      if (allocated(error)) call log%line('  warning: '//error%message)
   end subroutine save_outcome

   !> Read the outcome that an earlier run has kept; without one there is none.
   subroutine load_outcome(scene, threshold, outcome, error)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(outcome_t), intent(inout) :: outcome
      !> Set if the state is damaged, or belongs to another scene or version
      type(error_t), allocatable, intent(out) :: error
      character(*), parameter :: free_keys(0) = [character(1) ::]
      type(result_reader_t) :: reader
      type(file_state_t) :: kept
      real(dp), allocatable :: rows(:, :)

      kept = state_of_path(state_path(scene))
      if (kept%bytes == 0_int64) return
      call open_earlier(scene, state_path(scene), free_keys, reader, error)
      if (.not. allocated(error) .and. reader%source_checksum /= threshold%lines%layout%source_checksum) &
         call raise(error, exit_bad_input, state_path(scene)//' belongs to other lines: their CSV file has changed since')
      if (.not. allocated(error)) call reader%verify_rows(reader%row_count, error)
      if (.not. allocated(error)) then
         allocate (rows(reader%columns, reader%row_count))
         call reader%read_rows(1_int64, rows, error)
      end if
      call reader%close()
      if (allocated(error)) return
      associate (numbers => nint(rows(:counted_numbers, 1), int64))
         outcome%lines = numbers(1)
         outcome%solved = numbers(2)
         outcome%failed = numbers(3)
         outcome%crossings = numbers(4)
         outcome%uncrossed = numbers(5)
         outcome%uncertain = numbers(6)
      end associate
      outcome%rows = rows(:, 2:)
   end subroutine load_outcome

end module threshold_outcome
