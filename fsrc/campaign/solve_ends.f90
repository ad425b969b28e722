!> Enters traces of which all is known: where asked for, the motions on both sides of their brackets are followed to their ends
!> first, and motions of another side are looked for where a trace has no bracket, row by row on the threads of all ranks.
module solve_ends
   use campaign_progress, only: campaign_progress_t
   use errors, only: error_t
   use kinds, only: dp, int64
   use log_file, only: log_t
   use prepared_threshold, only: prepared_threshold_t
   use ranks, only: add_over_ranks, next_tickets, rank_count, renew_tickets, sum_over_ranks, this_rank, wait_for_ranks
   use scene_family, only: scene_family_t
   use scene_types, only: scene_t
   use signals, only: caught_signal
   use threshold_ends, only: end_numbers, find_ends, has_ends
   use threshold_outcome, only: add_traces, outcome_t, save_outcome
   use threshold_search, only: bracket_t, rows_of_traces
   use, intrinsic :: omp_lib, only: omp_get_max_threads, omp_get_thread_num
   implicit none(type, external)
   private

   !> Traces whose brackets are followed at a time, for each thread; and how old the state may become meanwhile [s]
   integer(int64), parameter :: traces_together = 8_int64
   real(dp), parameter :: state_interval = 5.0_dp

   public :: end_traces

contains

   !> Enter some traces, some at a time; all ranks do the same. What is found does not depend on the numbers of threads and ranks.
   subroutine end_traces(scene, threshold, first, last, progress, log, outcome, error)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      !> First and last trace
      integer(int64), intent(in) :: first
      integer(int64), intent(in) :: last
      type(campaign_progress_t), intent(inout) :: progress
      type(log_t), intent(in) :: log
      !> Cut where the work must stop: then the traces that are left are not entered
      type(outcome_t), intent(inout) :: outcome
      !> Set if there is no memory for the samples of a scene
      type(error_t), allocatable, intent(inout) :: error
      type(bracket_t), allocatable :: brackets(:)
      real(dp), allocatable :: ends(:, :)
      integer(int64) :: start, end, together

      if (.not. has_ends(scene, threshold%axis%whole)) then
         call add_traces(scene, threshold, first, last, outcome)
         return
      end if
      together = traces_together*rank_count()*omp_get_max_threads()
      do start = first, last, together
         end = min(last, start + together - 1_int64)
         if (allocated(brackets)) deallocate (brackets)
         allocate (brackets, source=rows_of_traces(pack(outcome%points, outcome%points%trace <= end)))
         call follow_brackets(scene, threshold, brackets, progress, log, ends, outcome%cut, error)
         if (outcome%cut) return
         call add_traces(scene, threshold, start, end, outcome, ends)
         if (this_rank() > 0) cycle
         if (outcome%age() > state_interval) call save_outcome(scene, threshold, outcome, log)
      end do
   end subroutine end_traces

   !> Ends of the motions of some brackets, and of traces that have none.
   subroutine follow_brackets(scene, threshold, brackets, progress, log, ends, cut, error)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(bracket_t), intent(in) :: brackets(:)
      type(campaign_progress_t), intent(inout) :: progress
      type(log_t), intent(in) :: log
      !> Ends, bracket
      real(dp), allocatable, intent(out) :: ends(:, :)
      !> Whether the work must stop: the ends are of no use
      logical, intent(out) :: cut
      type(error_t), allocatable, intent(inout) :: error
      type(error_t), allocatable :: own_error
      type(scene_family_t), allocatable :: family
      integer(int64) :: place
      logical :: failed

      allocate (ends(end_numbers, size(brackets)), source=0.0_dp)
      failed = .false.
      call renew_tickets()
      !$omp parallel default(shared) private(place, family, own_error)
      allocate (family)
      do
         if (caught_signal() /= 0 .or. failed) exit
         place = next_tickets(1_int64)
         if (place > size(brackets, kind=int64)) exit
         call find_ends(scene, threshold, brackets(place), family, ends(:, place), own_error)
         if (allocated(own_error)) then
            !$omp critical (threshold_ends_error)
            failed = .true.
            if (.not. allocated(error)) call move_alloc(own_error, error)
            !$omp end critical (threshold_ends_error)
            exit
         end if
         if (this_rank() == 0) then
            if (omp_get_thread_num() == 0) call progress%report(log)
         end if
      end do
      !$omp end parallel
      cut = failed
      if (failed .and. rank_count() > 1) return
      call wait_for_ranks()
      call add_over_ranks(ends)
      cut = sum_over_ranks(int(merge(1, 0, failed .or. caught_signal() /= 0), int64)) > 0_int64
   end subroutine follow_brackets

end module solve_ends
