!> Stand-in for ranks: one process does it all. With MPI=1 the module of the same name in campaign/mpi is built.
module ranks
   use errors, only: error_t
   use kinds, only: dp, int64
   implicit none(type, external)
   private

   public :: start_ranks, end_ranks, abort_ranks, this_rank, rank_count, wait_for_ranks, share_number, next_tickets, &
             renew_tickets, close_tickets, sum_over_ranks, add_over_ranks, is_foreign_job

   !> What --version says
   character(*), parameter, public :: parallel_words = 'without MPI'

   integer(int64) :: tickets = 0_int64

contains

   !> Whether a launcher of MPI jobs has started this process beside others: without MPI they cannot share the work.
   logical function is_foreign_job()
      character(*), parameter :: names(4) = [character(24) :: 'OMPI_COMM_WORLD_SIZE', 'PMI_SIZE', 'MV2_COMM_WORLD_SIZE', &
                                             'MPI_LOCALNRANKS']
      integer :: i

      is_foreign_job = number_in('PMIX_RANK') > 0
      do i = 1, size(names)
         if (number_in(trim(names(i))) > 1) is_foreign_job = .true.
      end do
   end function is_foreign_job

   !> A whole number in the environment, 0 if there is none.
   integer function number_in(name)
      character(*), intent(in) :: name
      character(16) :: value
      integer :: stat

      number_in = 0
      call get_environment_variable(name, value, status=stat)
      if (stat == 0 .and. verify(trim(value), '0123456789') == 0) read (value, *, iostat=stat) number_in
      if (stat /= 0) number_in = 0
   end function number_in

   !> Nothing to start.
   subroutine start_ranks()
      tickets = 0_int64
   end subroutine start_ranks

   !> Nothing to end.
   subroutine end_ranks()
   end subroutine end_ranks

   !> Nothing to abort: the one process ends by itself.
   subroutine abort_ranks(error)
      !> Why
      type(error_t), intent(in) :: error

      if (error%exit_code < 0) tickets = 0_int64
   end subroutine abort_ranks

   !> Number of this rank, from 0.
   integer function this_rank()
      this_rank = 0
   end function this_rank

   !> How many ranks there are.
   integer function rank_count()
      rank_count = 1
   end function rank_count

   !> Wait until all ranks are here.
   subroutine wait_for_ranks()
   end subroutine wait_for_ranks

   !> Give a number of rank 0 to all.
   subroutine share_number(number)
      !> In on rank 0, out on all
      integer, intent(inout) :: number

      if (number < 0) tickets = 0_int64
   end subroutine share_number

   !> The first of some numbers, one after the other, that no rank and no thread gets twice, from 1.
   integer(int64) function next_tickets(count)
      !> How many
      integer(int64), intent(in) :: count

      !$omp atomic capture
      next_tickets = tickets
      tickets = tickets + count
      !$omp end atomic
      next_tickets = next_tickets + 1_int64
   end function next_tickets

   !> Count the tickets from 1 again, once no rank asks for one.
   subroutine renew_tickets()
      tickets = 0_int64
   end subroutine renew_tickets

   !> No more tickets are asked for.
   subroutine close_tickets()
      tickets = 0_int64
   end subroutine close_tickets

   !> Sum of a number over all ranks, known to all.
   integer(int64) function sum_over_ranks(number)
      !> Number of this rank
      integer(int64), intent(in) :: number

      sum_over_ranks = number
   end function sum_over_ranks

   !> Add up tables of all ranks; every rank has the sum then.
   subroutine add_over_ranks(table)
      !> In: of this rank; out: of all
      real(dp), contiguous, intent(inout) :: table(:, :)

      if (size(table) < 0) tickets = 0_int64
   end subroutine add_over_ranks

end module ranks
