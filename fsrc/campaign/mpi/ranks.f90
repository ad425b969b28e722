!> Ranks of an MPI job. Work is handed out by a counter on rank 0 that every rank can reach by itself.
module ranks
   use, intrinsic :: iso_c_binding, only: c_f_pointer, c_ptr
   use errors, only: error_t
   use kinds, only: dp, int64
   use mpi_f08
   use text_output, only: put_error_line
   use unplanned_end, only: plan_end
   implicit none(type, external)
   private

   public :: start_ranks, end_ranks, abort_ranks, this_rank, rank_count, wait_for_ranks, share_number, next_tickets, &
             renew_tickets, close_tickets, sum_over_ranks, add_over_ranks, is_foreign_job

   !> What --version says
   character(*), parameter, public :: parallel_words = 'with MPI'

   type(MPI_Win) :: window
   logical :: window_open = .false.
   integer(int64), pointer :: counter(:)

contains

   !> Processes that a launcher of MPI jobs started share the work.
   logical function is_foreign_job()
      is_foreign_job = .false.
   end function is_foreign_job

   !> Start MPI and put the counter of tickets on rank 0. Only one thread at a time calls MPI.
   subroutine start_ranks()
      integer :: provided
      integer(MPI_ADDRESS_KIND) :: bytes
      type(c_ptr) :: place

      call MPI_Init_thread(MPI_THREAD_SERIALIZED, provided)
      bytes = merge(8_MPI_ADDRESS_KIND, 0_MPI_ADDRESS_KIND, this_rank() == 0)
      call MPI_Win_allocate(bytes, 8, MPI_INFO_NULL, MPI_COMM_WORLD, place, window)
      if (this_rank() == 0) then
         call c_f_pointer(place, counter, [1])
         counter(1) = 0_int64
      end if
      call MPI_Barrier(MPI_COMM_WORLD)
      call MPI_Win_lock_all(0, window)
      window_open = .true.
   end subroutine start_ranks

   !> End MPI in order.
   subroutine end_ranks()
      call close_tickets()
      call MPI_Finalize()
   end subroutine end_ranks

   !> End all ranks at once: one of them cannot go on, and says why.
   subroutine abort_ranks(error)
      !> Why
      type(error_t), intent(in) :: error

      call put_error_line(error%message)
      call plan_end()
      call MPI_Abort(MPI_COMM_WORLD, error%exit_code)
   end subroutine abort_ranks

   !> Number of this rank, from 0.
   integer function this_rank()
      call MPI_Comm_rank(MPI_COMM_WORLD, this_rank)
   end function this_rank

   !> How many ranks there are.
   integer function rank_count()
      call MPI_Comm_size(MPI_COMM_WORLD, rank_count)
   end function rank_count

   !> Wait until all ranks are here.
   subroutine wait_for_ranks()
      call MPI_Barrier(MPI_COMM_WORLD)
   end subroutine wait_for_ranks

   !> Give a number of rank 0 to all.
   subroutine share_number(number)
      !> In on rank 0, out on all
      integer, intent(inout) :: number

      call MPI_Bcast(number, 1, MPI_INTEGER, 0, MPI_COMM_WORLD)
   end subroutine share_number

   !> The first of some numbers, one after the other, that no rank and no thread gets twice, from 1.
   integer(int64) function next_tickets(count)
      !> How many
      integer(int64), intent(in) :: count
      integer(int64), asynchronous :: more, before

      more = count
      before = 0_int64
      !$omp critical (rank_tickets)
      call MPI_Fetch_and_op(more, before, MPI_INTEGER8, 0, 0_MPI_ADDRESS_KIND, MPI_SUM, window)
      call MPI_Win_flush(0, window)
      !$omp end critical (rank_tickets)
      next_tickets = before + 1_int64
   end function next_tickets

   !> Count the tickets from 1 again, once no rank asks for one.
   subroutine renew_tickets()
      integer(int64), asynchronous :: none, before

      call wait_for_ranks()
      if (this_rank() == 0) then
         none = 0_int64
         before = 0_int64
         call MPI_Fetch_and_op(none, before, MPI_INTEGER8, 0, 0_MPI_ADDRESS_KIND, MPI_REPLACE, window)
         call MPI_Win_flush(0, window)
      end if
      call wait_for_ranks()
   end subroutine renew_tickets

   !> No more tickets are asked for.
   subroutine close_tickets()
      if (.not. window_open) return
      call MPI_Win_unlock_all(window)
      call MPI_Win_free(window)
      window_open = .false.
   end subroutine close_tickets

   !> Sum of a number over all ranks, known to all.
   integer(int64) function sum_over_ranks(number)
      !> Number of this rank
      integer(int64), intent(in) :: number

      call MPI_Allreduce(number, sum_over_ranks, 1, MPI_INTEGER8, MPI_SUM, MPI_COMM_WORLD)
   end function sum_over_ranks

   !> Add up tables of all ranks; every rank has the sum then.
   subroutine add_over_ranks(table)
      !> In: of this rank; out: of all
      real(dp), contiguous, intent(inout) :: table(:, :)

      call MPI_Allreduce(MPI_IN_PLACE, table, size(table), MPI_REAL8, MPI_SUM, MPI_COMM_WORLD)
   end subroutine add_over_ranks

end module ranks
