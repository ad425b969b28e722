!> Tests of what is kept of a threshold: rows and counts of points that are known, entered at once, trace by trace, in parts of the
!> traces, and read back from a state.
module test_threshold_outcome
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_quiet_nan, ieee_value
   use campaign_file_cases, only: line_feed
   use checks, only: check_list_t, same_bits
   use errors, only: error_t
   use file_system, only: delete_file
   use kinds, only: dp, int64
   use log_file, only: log_t
   use output_place, only: state_path
   use prepared_threshold, only: prepared_threshold_t
   use scene_status, only: status_film_lost, status_steady
   use scene_types, only: scene_t
   use threshold_cases, only: case_points, creep, crossings, failed, first_force, idle, last_force, traces, new_outcome, prepare, &
                              quiet, solved, speeds, steps, uncertain, uncrossed, wide
   use threshold_outcome, only: add_traces, end_counts, failed_scenes, load_outcome, outcome_t, save_outcome, solved_scenes
   use threshold_search, only: point_t, rows_of_traces
   implicit none(type, external)
   private

   public :: run_threshold_outcome_tests

contains

   !> Runs every test of this topic.
   subroutine run_threshold_outcome_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(scene_t) :: scene
      type(prepared_threshold_t) :: threshold
      type(outcome_t) :: outcome

      call checks%start('threshold_outcome')
      call prepare(checks, scene, threshold, ' /')
      call new_outcome(scene, threshold, outcome)
      call check_scenes(checks, outcome, 'under way')
      call add_traces(scene, threshold, 1_int64, traces, outcome)
      call check_counts(checks, outcome, 'all traces at once')
      call check_rows(checks, outcome%rows)
      call test_line_by_line(checks, scene, threshold, outcome)
      call test_state(checks, scene, threshold, outcome)
      call test_part(checks, outcome)
      call test_without_verifications(checks)
      call test_ends(checks)
   end subroutine run_threshold_outcome_tests

   !> Scenes are counted once, whether their traces are done or under way.
   subroutine check_scenes(checks, outcome, what)
      class(check_list_t), intent(inout) :: checks
      type(outcome_t), intent(in) :: outcome
      character(*), intent(in) :: what

      call checks%check(solved_scenes(outcome) == solved, 'scenes solved: '//what)
      call checks%check(failed_scenes(outcome) == failed, 'scenes failed: '//what)
   end subroutine check_scenes

   !> Every count of an outcome of which all traces are done.
   subroutine check_counts(checks, outcome, what)
      class(check_list_t), intent(inout) :: checks
      type(outcome_t), intent(in) :: outcome
      character(*), intent(in) :: what

      call check_scenes(checks, outcome, what)
      call checks%check(outcome%traces == traces .and. size(outcome%points) == 0, 'traces done: '//what)
      call checks%check(outcome%solved == solved .and. outcome%failed == failed, 'scenes of the traces: '//what)
      call checks%check(outcome%crossings == crossings, 'crossings: '//what)
      call checks%check(outcome%uncrossed == uncrossed, 'traces without a crossing: '//what)
      call checks%check(outcome%uncertain == uncertain, 'uncertain crossings: '//what)
      call checks%check(outcome%wide == wide, 'wide crossings: '//what)
   end subroutine check_counts

   !> Every number of every row.
   subroutine check_rows(checks, rows)
      class(check_list_t), intent(inout) :: checks
      real(dp), intent(in) :: rows(:, :)
      integer, parameter :: verified_below = 11, verified_above = 12
      integer :: trace

      call checks%check(all(shape(rows) == [16, 7]), 'a row for each crossing and each trace without one')
      call checks%check(all(ieee_is_nan(rows(13:, :))), 'no ends of motions that were not followed')
      if (any(shape(rows) /= [12, 7])) return
      call row(1, 1, 1, [8, 9], [quiet, idle], [status_steady, status_steady])
      call stand(1, [1, 0])
      call row(2, 2, 1, [8, 11], [quiet, idle], [status_steady, status_steady])
      call stand(2, [1, 1])
      call row(3, 2, 2, [23, 24], [idle, 0], [status_steady, status_film_lost])
      call checks%check(ieee_is_nan(rows(verified_below, 3)) .and. ieee_is_nan(rows(verified_above, 3)), &
                        'row 3: nothing was put to the test')
      do trace = 3, 6
         if (trace < 6) call row(trace + 1, trace, 0, [0, steps], [creep, creep], [status_steady, status_steady])
         if (trace == 6) call row(trace + 1, trace, 0, [0, steps], [0, 0], [status_film_lost, status_film_lost])
         call checks%check(all(ieee_is_nan(rows([6, verified_below, verified_above], trace + 1))), &
                           'a trace without a crossing has no width and no verification')
      end do

   contains

      subroutine row(place, trace, crossing, places, classes, statuses)
         integer, intent(in) :: place, trace, crossing, places(2), classes(2), statuses(2)
         real(dp) :: ends(2)
         character(8) :: name

         write (name, '(a, i0, a)') 'row ', place, ': '
         ends = first_force + (last_force - first_force)*real(places, dp)/real(steps, dp)
         call checks%check(nint(rows(1, place)) == trace .and. same_bits(rows(2, place), speeds(trace)), name//'its trace')
         call checks%check(nint(rows(3, place)) == crossing, name//'its crossing')
         call checks%check_close(rows(4, place), ends(1), 1.0e-12_dp, name//'lower end')
         call checks%check_close(rows(5, place), ends(2), 1.0e-12_dp, name//'upper end')
         if (crossing > 0) call checks%check_close(rows(6, place), ends(2) - ends(1), 1.0e-12_dp, name//'width')
         if (statuses(1) == status_steady) call checks%check(nint(rows(7, place)) == classes(1), name//'class below')
         if (statuses(2) == status_steady) call checks%check(nint(rows(8, place)) == classes(2), name//'class above')
         call checks%check(all(nint(rows(9:10, place)) == statuses), name//'how both scenes ended')
      end subroutine row

      subroutine stand(place, verified)
         integer, intent(in) :: place, verified(2)

         call checks%check(all(nint(rows(verified_below:verified_above, place)) == verified), &
            'which class is verified, in its order')
      end subroutine stand

   end subroutine check_rows

   !> Traces entered one after another are those entered at once; what is counted on the way is counted once.
   subroutine test_line_by_line(checks, scene, threshold, at_once)
      class(check_list_t), intent(inout) :: checks
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(outcome_t), intent(in) :: at_once
      type(outcome_t) :: outcome
      integer(int64) :: trace

      call new_outcome(scene, threshold, outcome)
      do trace = 1_int64, traces
         call add_traces(scene, threshold, trace, trace, outcome)
         call check_scenes(checks, outcome, 'some traces done')
         call checks%check(outcome%traces == trace, 'traces done, one after another')
      end do
      call check_counts(checks, outcome, 'trace by trace')
      call check_same(checks, outcome%rows, at_once%rows, 'trace by trace')
   end subroutine test_line_by_line

   !> A state read back is the outcome that was kept, and goes on to the same end.
   subroutine test_state(checks, scene, threshold, at_once)
      class(check_list_t), intent(inout) :: checks
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(outcome_t), intent(in) :: at_once
      type(outcome_t) :: kept, loaded
      type(error_t), allocatable :: error
      type(log_t) :: log
      integer(int64) :: trace

      do trace = 0_int64, traces
         call new_outcome(scene, threshold, kept)
         if (trace > 0_int64) call add_traces(scene, threshold, 1_int64, trace, kept)
         call save_outcome(scene, threshold, kept, log)
         loaded = outcome_t()
         call load_outcome(scene, threshold, loaded, error)
         call checks%check(.not. allocated(error) .and. allocated(loaded%rows), 'a state is read back')
         if (.not. allocated(loaded%rows)) return
         call check_scenes(checks, loaded, 'read back')
         call checks%check(all([loaded%traces, loaded%solved, loaded%failed, loaded%crossings, loaded%uncrossed, &
                                loaded%uncertain, loaded%wide] == [kept%traces, kept%solved, kept%failed, kept%crossings, &
                                                                  kept%uncrossed, kept%uncertain, kept%wide]), 'its counts')
         call check_same(checks, loaded%rows, kept%rows, 'read back')
         call check_points(checks, loaded%points, kept%points)
         call add_traces(scene, threshold, trace + 1_int64, traces, loaded)
         if (trace < traces) call check_counts(checks, loaded, 'carried on')
         if (trace < traces) call check_same(checks, loaded%rows, at_once%rows, 'carried on')
      end do
      call delete_file(state_path(scene))
   end subroutine test_state

   !> Points are the same in all that is known of them.
   subroutine check_points(checks, points, others)
      class(check_list_t), intent(inout) :: checks
      type(point_t), intent(in) :: points(:)
      type(point_t), intent(in) :: others(:)

      call checks%check(size(points) == size(others), 'points read back: as many')
      if (size(points) /= size(others)) return
      call checks%check(all(points%trace == others%trace .and. points%place == others%place), 'points read back: where')
      call checks%check(all(points%scanned .eqv. others%scanned), 'points read back: those of the scan')
      call checks%check(all(points%status == others%status .and. points%side == others%side), 'points read back: what')
      call checks%check(all(points%tested .eqv. others%tested), 'points read back: put to the test')
      call checks%check(all(same_numbers(points%verified, others%verified)), 'points read back: verified')
      call checks%check(all(same_bits(points%quantity, others%quantity)), 'points read back: their quantity')
   end subroutine check_points

   subroutine check_same(checks, rows, others, what)
      class(check_list_t), intent(inout) :: checks
      real(dp), intent(in) :: rows(:, :)
      real(dp), intent(in) :: others(:, :)
      character(*), intent(in) :: what

      call checks%check(all(shape(rows) == shape(others)), 'as many rows: '//what)
      if (any(shape(rows) /= shape(others))) return
      call checks%check(all(same_numbers(rows, others)), 'the same rows: '//what)
   end subroutine check_same

   !> The same bits, or unknown both.
   elemental logical function same_numbers(x, y)
      real(dp), intent(in) :: x
      real(dp), intent(in) :: y

      same_numbers = same_bits(x, y) .or. (ieee_is_nan(x) .and. ieee_is_nan(y))
   end function same_numbers

   !> The second half of the traces is a part that counts its own traces, and has the rows of the whole.
   subroutine test_part(checks, whole)
      class(check_list_t), intent(inout) :: checks
      type(outcome_t), intent(in) :: whole
      type(scene_t) :: scene
      type(prepared_threshold_t) :: threshold
      type(outcome_t) :: outcome

      call prepare(checks, scene, threshold, ', part = 2, parts = 2 /')
      call checks%check(threshold%traces%first == 4_int64 .and. threshold%traces%layout%scene_count == 3_int64, &
                        'a part of the traces')
      call new_outcome(scene, threshold, outcome)
      outcome%points = pack(outcome%points, outcome%points%trace > 3_int64)
      call add_traces(scene, threshold, 4_int64, 5_int64, outcome)
      call checks%check(outcome%traces == 2_int64, 'traces of a part')
      call add_traces(scene, threshold, 6_int64, 6_int64, outcome)
      call checks%check(outcome%traces == 3_int64 .and. outcome%uncrossed == 3_int64 .and. outcome%crossings == 0_int64, &
                        'counts of a part')
      call check_same(checks, outcome%rows, whole%rows(:, 5:), 'a part')
   end subroutine test_part

   !> Where motions end stands in the rows of crossings and of traces without one; and it is counted where either side is possible, beyond a bracket, and where
   !> an end is not sure. With one start there are no such columns.
   subroutine test_ends(checks)
      class(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene
      type(prepared_threshold_t) :: threshold
      type(outcome_t) :: outcome
      real(dp), allocatable :: ends(:, :)

      call prepare(checks, scene, threshold, ' /')
      call new_outcome(scene, threshold, outcome)
      allocate (ends(4, size(rows_of_traces(outcome%points))), source=ieee_value(0.0_dp, ieee_quiet_nan))
      ! From 85 to 95 N, from 85 to 115 N, from 235 to 245 N, and traces without a crossing
      ends(:, 1) = [200.0_dp, 20.0_dp, 1.0_dp, 2.0_dp]
      ends(:, 2) = [90.0_dp, 90.0_dp, 4.0_dp, 4.0_dp]
      ends(:, 3) = [260.0_dp, ieee_value(0.0_dp, ieee_quiet_nan), 6.0_dp, ieee_value(0.0_dp, ieee_quiet_nan)]
      ends(:, 4) = [170.0_dp, 150.0_dp, 1.0_dp, 6.0_dp]
      call add_traces(scene, threshold, 1_int64, traces, outcome, ends)
      call checks%check(all(same_bits(outcome%rows(13:, :), ends) .or. ieee_is_nan(ends)), 'ends of the motions of each row')
      call checks%check(all(ieee_is_nan(outcome%rows(13:, 5:))), 'no ends where nothing was followed')
      call checks%check(all(end_counts(scene, threshold, outcome) == [3, 2, 1, 1]), 'counts of ends')
      ends(1, 1) = 94.0_dp
      ends(2, 1) = 86.0_dp
      ends(:, 4) = ieee_value(0.0_dp, ieee_quiet_nan)
      call new_outcome(scene, threshold, outcome)
      call add_traces(scene, threshold, 1_int64, traces, outcome, ends)
      call checks%check(all(end_counts(scene, threshold, outcome) == [3, 1, 1, 0]), 'ends within a bracket are one change')
      ends(:, 3) = [ends(2, 3), 240.0_dp, ends(4, 3), 1.0_dp]
      call new_outcome(scene, threshold, outcome)
      call add_traces(scene, threshold, 1_int64, traces, outcome, ends)
      call checks%check(all(end_counts(scene, threshold, outcome) == [3, 0, 0, 0]), 'motions of the side above alone')
      call prepare(checks, scene, threshold, ' /'//line_feed//'&solver starts = 1 /')
      call new_outcome(scene, threshold, outcome)
      call add_traces(scene, threshold, 1_int64, traces, outcome)
      call checks%check(size(outcome%rows, 1) == 12, 'no ends with one start')
      call checks%check(all(end_counts(scene, threshold, outcome) == 0), 'nor counts of them')
   end subroutine test_ends

   !> Without verifications rows have no column of them, and nothing is put to the test.
   subroutine test_without_verifications(checks)
      class(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene
      type(prepared_threshold_t) :: threshold
      type(outcome_t) :: outcome

      call prepare(checks, scene, threshold, ' /'//line_feed//'&spectrum verify = .false. /')
      call new_outcome(scene, threshold, outcome)
      outcome%points%tested = .false.
      call add_traces(scene, threshold, 1_int64, traces, outcome)
      call checks%check(size(outcome%rows, 1) == 14, 'no columns of verifications')
      call checks%check(outcome%solved == size(case_points(scene), kind=int64), 'every point is one scene')
      call checks%check(outcome%wide == 0_int64, 'brackets as narrow as asked for')
   end subroutine test_without_verifications

end module test_threshold_outcome
