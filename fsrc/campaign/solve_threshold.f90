!> Solves what the search for thresholds asks for, point by point, on the threads of all ranks, and keeps what is found.
module solve_threshold
   use campaign_progress, only: campaign_progress_t
   use clock, only: wall_seconds
   use errors, only: error_t
   use kinds, only: dp, int64
   use log_file, only: log_t
   use prepared_threshold, only: points_plan, prepared_threshold_t
   use quantities, only: quantity_code, quantity_table, verification_of
   use ranks, only: add_over_ranks, next_tickets, rank_count, renew_tickets, sum_over_ranks, this_rank, wait_for_ranks
   use row_counts, only: count_rows
   use sampling, only: sample_plan_t
   use scene_types, only: scene_t
   use schedule, only: pace_t
   use signals, only: caught_signal
   use judge_group, only: judgement_space_t
   use solve_chunk, only: solve_scenes
   use solve_ends, only: end_traces
   use threshold_outcome, only: outcome_t, save_outcome, solved_scenes
   use threshold_search, only: known_side, merged_points, missing_middles, missing_scan, new_point, point_t, untested_ends
   use, intrinsic :: omp_lib, only: omp_get_max_threads, omp_get_thread_num
   implicit none(type, external)
   private

   !> How old the state may become [s]. Several ranks have to wait for each other to keep it, and do so less often; a signal
   !> makes them keep all that they have.
   real(dp), parameter :: state_interval = 5.0_dp, shared_interval = 30.0_dp
   !> Rows of a table of answers: whether the scene is solved, its status, its quantity, whether its class is verified
   integer, parameter :: is_solved = 1, of_status = 2, of_quantity = 3, of_verification = 4

   public :: search_lines

contains

   !> All thresholds of some traces; all ranks find the same. What is known of them already is not solved again.
   subroutine search_lines(scene, threshold, first, last, progress, log, outcome, error)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      !> First and last trace
      integer(int64), intent(in) :: first
      integer(int64), intent(in) :: last
      type(campaign_progress_t), intent(inout) :: progress
      type(log_t), intent(in) :: log
      type(outcome_t), intent(inout) :: outcome
      !> Set if there is no memory for the samples of a scene
      type(error_t), allocatable, intent(out) :: error
      type(point_t), allocatable :: wanted(:)
      type(pace_t) :: pace
      logical :: testing

      do
         call next_points(scene, threshold, first, last, outcome%points, wanted, testing)
         if (size(wanted) == 0) exit
         call solve_points(scene, threshold, wanted, testing, pace, progress, log, outcome, error)
         if (outcome%cut) return
      end do
      call end_traces(scene, threshold, first, last, progress, log, outcome, error)
   end subroutine search_lines

   !> What is to be solved next: the scan, then the middles of brackets that are still wide, then the verifications of their ends.
   subroutine next_points(scene, threshold, first, last, points, wanted, testing)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      !> First and last trace
      integer(int64), intent(in) :: first
      integer(int64), intent(in) :: last
      !> All points that are known
      type(point_t), intent(in) :: points(:)
      type(point_t), allocatable, intent(out) :: wanted(:)
      !> Whether verifications are asked for
      logical, intent(out) :: testing
      type(point_t), allocatable :: known(:)

      testing = .false.
      known = pack(points, points%trace >= first .and. points%trace <= last)
      wanted = missing_scan(known, threshold%scan, first, last)
      if (size(wanted) == 0) wanted = missing_middles(known)
      if (size(wanted) > 0 .or. .not. scene%spectrum%verify) return
      testing = .true.
      wanted = untested_ends(known)
   end subroutine next_points

   !> Solve points on the threads of all ranks, all of them or as many as there is time for before the state is kept. What is
   !> found does not depend on the numbers of threads and ranks.
   subroutine solve_points(scene, threshold, wanted, testing, known_pace, progress, log, outcome, error)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(point_t), intent(in) :: wanted(:)
      !> Whether their verifications are asked for
      logical, intent(in) :: testing
      !> What the scenes before have taken
      type(pace_t), intent(inout) :: known_pace
      type(campaign_progress_t), intent(inout) :: progress
      type(log_t), intent(in) :: log
      type(outcome_t), intent(inout) :: outcome
      !> Set if there is no memory for the samples of a scene; the other points are kept
      type(error_t), allocatable, intent(out) :: error
      type(error_t), allocatable :: own_error
      type(scene_t) :: recorded
      type(sample_plan_t) :: plan
      type(judgement_space_t) :: space
      type(pace_t) :: pace, next_pace
      real(dp), allocatable :: answers(:, :), rows(:, :)
      integer(int64) :: first, last, taken, left
      integer :: status, threads, bound
      real(dp) :: started, round_started
      logical :: out_of_time, failed

      recorded = scene
      bound = quantity_code(trim(quantity_table(scene%threshold%quantity)%name)//'_is_bound')
      if (testing) then
         recorded%campaign%record = [scene%threshold%quantity, verification_of(scene%threshold%quantity)]
      else if (bound > 0) then
         recorded%campaign%record = [scene%threshold%quantity, bound]
      end if
      call points_plan(threshold, wanted%trace, wanted%place, plan)
      status = 2 + size(plan%positions)
      allocate (answers(of_verification, size(wanted)), source=0.0_dp)
      progress%scenes = solved_scenes(outcome) + plan%size
      round_started = wall_seconds()
      call renew_tickets()
      threads = rank_count()*omp_get_max_threads()
      left = plan%size
      failed = .false.
      !$omp parallel default(shared) private(first, last, taken, rows, space, pace, started, out_of_time, own_error)
      pace = known_pace
      do
         started = wall_seconds()
         out_of_time = rank_count() > 1 .and. started - round_started > shared_interval
         if (caught_signal() /= 0 .or. out_of_time .or. failed) exit
         !$omp atomic read
         taken = left
         taken = pace%next_share(taken, threads)
         first = next_tickets(taken)
         if (first > plan%size) exit
         last = min(plan%size, first + taken - 1_int64)
         !$omp atomic write
         left = plan%size - last
         allocate (rows(status + size(recorded%campaign%record), last - first + 1_int64))
         call solve_scenes(recorded, plan, first, space, rows, own_error)
         if (caught_signal() /= 0) exit
         if (allocated(own_error)) then
            !$omp critical (threshold_answers)
            failed = .true.
            if (.not. allocated(error)) call move_alloc(own_error, error)
            !$omp end critical (threshold_answers)
            exit
         end if
         call pace%note(size(rows, 2), wall_seconds() - started)
         !$omp critical (threshold_answers)
         answers(of_status, first:last) = rows(status, :)
         answers(of_quantity, first:last) = rows(status + 1, :)
         if (testing) then
            answers(of_verification, first:last) = rows(status + 2, :)
         else if (bound > 0) then
            answers(of_quantity, first:last) = known_side(rows(status + 1, :), rows(status + 2, :), scene%threshold%level)
         end if
         answers(is_solved, first:last) = 1.0_dp
         !$omp end critical (threshold_answers)
         call progress%add(count_rows([character(1) ::], status, rows))
         deallocate (rows)
         if (this_rank() == 0) then
            if (omp_get_thread_num() == 0) call keep_up(scene, threshold, wanted, testing, answers, progress, log, outcome)
         end if
      end do
      if (omp_get_thread_num() == 0) next_pace = pace
      !$omp end parallel
      known_pace = next_pace
      outcome%cut = failed
      if (failed .and. rank_count() > 1) return
      call wait_for_ranks()
      call add_over_ranks(answers)
      outcome%points = merged_points(outcome%points, answered(scene, wanted, testing, answers))
      outcome%cut = sum_over_ranks(int(merge(1, 0, failed .or. caught_signal() /= 0), int64)) > 0_int64
      if (rank_count() == 1 .or. this_rank() > 0 .or. outcome%cut) return
      if (outcome%age() > state_interval) call save_outcome(scene, threshold, outcome, log)
   end subroutine solve_points

   !> Report the progress, and keep the state, if it is time to.
   subroutine keep_up(scene, threshold, wanted, testing, answers, progress, log, outcome)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(point_t), intent(in) :: wanted(:)
      logical, intent(in) :: testing
      !> Other threads write there
      real(dp), intent(in) :: answers(:, :)
      type(campaign_progress_t), intent(inout) :: progress
      type(log_t), intent(in) :: log
      type(outcome_t), intent(inout) :: outcome
      type(outcome_t) :: so_far
      real(dp), allocatable :: copied(:, :)

      call progress%report(log)
      if (rank_count() > 1) return
      if (outcome%age() < state_interval) return
      !$omp critical (threshold_answers)
      copied = answers
      !$omp end critical (threshold_answers)
      so_far = outcome
      so_far%points = merged_points(outcome%points, answered(scene, wanted, testing, copied))
      !$omp critical (sentences)
      call save_outcome(scene, threshold, so_far, log)
      !$omp end critical (sentences)
      outcome%kept_at = so_far%kept_at
   end subroutine keep_up

   !> The points of a table that are solved.
   pure function answered(scene, wanted, testing, answers) result(points)
      type(scene_t), intent(in) :: scene
      type(point_t), intent(in) :: wanted(:)
      logical, intent(in) :: testing
      real(dp), intent(in) :: answers(:, :)
      type(point_t), allocatable :: points(:)
      integer :: i, count

      allocate (points(size(wanted)))
      count = 0
      do i = 1, size(wanted)
         if (.not. answers(is_solved, i) > 0.0_dp) cycle
         count = count + 1
         if (testing) then
            points(count) = wanted(i)
            points(count)%tested = .true.
            points(count)%verified = answers(of_verification, i)
         else
            points(count) = new_point(scene%threshold, wanted(i), nint(answers(of_status, i)), answers(of_quantity, i))
         end if
      end do
      points = points(:count)
   end function answered

end module solve_threshold
