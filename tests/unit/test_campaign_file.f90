!> Tests of the result file of a campaign: any order of chunks and any number of runs and ranks give the same
!> bytes; spoilt chunks are seen.
module test_campaign_file
   use campaign_file, only: campaign_file_t
   use campaign_file_cases, only: chunk_rows, chunks, close_file, columns, compute, content_of, create, finish, input, &
      layout_of, long_at, overwrite_bytes, path, resume, rows_of, scenes
   use campaign_header, only: campaign_layout_t
   use checks, only: check_list_t
   use checksum, only: checksum_of
   use errors, only: error_t
   use file_system, only: delete_file, path_exists
   use kinds, only: dp, int64
   use text, only: integer_text
   implicit none(type, external)
   private

   public :: run_campaign_file_tests

contains

   !> Runs every test of this topic.
   subroutine run_campaign_file_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks
      character(:), allocatable :: undisturbed

      call checks%start('campaign_file')
      call delete_file(path)
      call test_layout(checks, undisturbed)
      call test_orders(checks, undisturbed)
      call test_kills(checks, undisturbed)
      call test_spoilt_chunks(checks, undisturbed)
      call test_join(checks, undisturbed)
      call delete_file(path)
      call checks%check(.not. path_exists(path//'.new'), 'nothing is left behind')
   end subroutine run_campaign_file_tests

   !> Every part at its documented place.
   subroutine test_layout(checks, undisturbed)
      type(check_list_t), intent(inout) :: checks
      character(:), allocatable, intent(out) :: undisturbed
      type(campaign_file_t) :: file
      type(campaign_layout_t) :: layout
      integer(int64) :: table, first_row, first, last
      integer :: chunk

      layout = layout_of(input)
      call create(checks, file, .false.)
      call checks%check(file%chunk_count() == chunks .and. .not. any(file%done_flags()), 'no chunk is done')
      undisturbed = content_of(path)
      call checks%check(long_at(undisturbed, 24_int64) == -1_int64, 'rows unknown')
      call finish(checks, file)
      undisturbed = content_of(path)
      call checks%check(undisturbed(:8) == 'RATTLE'//achar(13)//achar(10), 'magic')
      call checks%check(long_at(undisturbed, 24_int64) == scenes, 'count of rows')
      table = 128 + 48*columns + len(input)
      call checks%check(undisturbed(128 + 48*columns + 1:table) == input, 'input text')
      table = ((table + 63)/64)*64
      call checks%check(undisturbed(table + 1:table + 8) == 'CHUNKTAB', 'magic of the table')
      call checks%check(long_at(undisturbed, table + 8) == chunk_rows, 'scenes in a chunk')
      call checks%check(long_at(undisturbed, table + 16) == chunks, 'count of chunks')
      call checks%check(long_at(undisturbed, table + 24) == scenes, 'scenes')
      first_row = ((table + 32 + 8*chunks + 63)/64)*64
      call checks%check(long_at(undisturbed, 16_int64) == first_row, 'bytes before the rows')
      call checks%check(len(undisturbed, int64) == first_row + 8*columns*scenes, 'size')
      do chunk = 1, chunks
         first = int(chunk - 1, int64)*chunk_rows + 1
         last = min(first + chunk_rows - 1, int(scenes, int64))
         call checks%check(long_at(undisturbed, table + 32 + 8*(chunk - 1)) == checksum_of(rows_of(first, &
                                                            last)), 'checksum')
         call checks%check(undisturbed(first_row + 24*(first - 1) + 1:first_row + 24*last) == &
                           bytes_of(rows_of(first, last)), &
                           'rows')
      end do
   end subroutine test_layout

   pure function bytes_of(rows) result(bytes)
      real(dp), intent(in) :: rows(:, :)
      character(8*size(rows)) :: bytes

      bytes = transfer(rows, bytes)
   end function bytes_of

   !> Chunks in other orders, and by several threads.
   subroutine test_orders(checks, undisturbed)
      type(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: undisturbed
      type(campaign_file_t) :: file
      type(error_t), allocatable :: error
      integer(int64) :: first, last
      integer :: i, failed

      call create(checks, file, .true.)
      do i = chunks, 1, -1
         call compute(checks, file, i)
      end do
      call close_file(checks, file, .true.)
      call checks%check(content_of(path) == undisturbed, 'the last chunk first')

      call create(checks, file, .true.)
      call file%chunk_bounds(3_int64, first, last)
      call file%write_chunks(3_int64, rows_of(first, int(scenes, int64)), error)
      call checks%check(.not. allocated(error) .and. count(file%done_flags()) == chunks - 2, 'all but two chunks at once')
      call checks%check(file%scenes_done() == scenes - first + 1, 'scenes that are done')
      call file%write_chunks(1_int64, rows_of(1_int64, first), error)
      call checks%check(allocated(error) .and. .not. file%is_done(1_int64), 'rows that end within a chunk')
      call file%write_chunks(1_int64, rows_of(1_int64, first - 1), error)
      call close_file(checks, file, .true.)
      call checks%check(content_of(path) == undisturbed, 'chunks side by side')
      call create(checks, file, .true.)
      failed = 0
      !$omp parallel do num_threads(4) schedule(dynamic) default(none) shared(file) &
      !$omp private(first, last, error) reduction(+:failed)
      do i = 1, chunks
         call file%chunk_bounds(int(i, int64), first, last)
         call file%write_chunks(int(i, int64), rows_of(first, last), error)
         if (allocated(error)) failed = failed + 1
      end do
      !$omp end parallel do
      call checks%check(failed == 0, 'four threads: written')
      call close_file(checks, file, .true.)
      call checks%check(content_of(path) == undisturbed, 'four threads')
   end subroutine test_orders

   !> A run that ends after any number of chunks, even between rows and checksum, goes on where it was.
   subroutine test_kills(checks, undisturbed)
      type(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: undisturbed
      type(campaign_file_t) :: file
      integer :: done, i

      do done = 0, chunks
         call create(checks, file, .true.)
         do i = 1, done
            call compute(checks, file, 1 + modulo(7*i, chunks))
         end do
         call close_file(checks, file, done == chunks)
         call resume(checks, file, 0)
         call checks%check(count(file%done_flags()) == done, 'what was done stays done')
         call finish(checks, file)
         call checks%check(content_of(path) == undisturbed, 'resumed after '//integer_text(done)//' chunks')
      end do
      ! Rows without their checksum: torn by the kill, and written anew.
      call create(checks, file, .true.)
      call compute(checks, file, 3)
      call close_file(checks, file, .false.)
      call overwrite_bytes(int(len(undisturbed), int64) - 24*500, repeat('x', 1000))
      call resume(checks, file, 0)
      call finish(checks, file)
      call checks%check(content_of(path) == undisturbed, 'torn rows')
   end subroutine test_kills

   !> Altered rows and a file that was cut short, finished or not.
   subroutine test_spoilt_chunks(checks, undisturbed)
      type(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: undisturbed
      type(campaign_file_t) :: file
      integer(int64) :: first_row
      integer :: unit

      first_row = long_at(undisturbed, 16_int64)
      call overwrite_bytes(first_row + 24*chunk_rows*2 + 5, '!')
      call overwrite_bytes(first_row + 24*chunk_rows*9, repeat(achar(0), 24))
      call resume(checks, file, 2)
      call checks%check(.not. file%is_done(3_int64) .and. .not. file%is_done(10_int64), 'both are not done')
      call checks%check(count(file%done_flags()) == chunks - 2, 'all others are')
      call close_file(checks, file, .false.)
      call checks%check(long_at(content_of(path), 24_int64) == -1_int64, 'the file is open again')
      call resume(checks, file, 0)
      call finish(checks, file)
      call checks%check(content_of(path) == undisturbed, 'mended')
      open (newunit=unit, file=path, access='stream', form='unformatted', status='replace', action='write')
      write (unit) undisturbed(:first_row + 24*(4*chunk_rows + 10))
      close (unit)
      call resume(checks, file, chunks - 4)
      call finish(checks, file)
      call checks%check(content_of(path) == undisturbed, 'cut short and mended')
      call resume(checks, file, 0)
      call close_file(checks, file, .true.)
      call checks%check(content_of(path) == undisturbed, 'a finished file stays as it is')
   end subroutine test_spoilt_chunks

   !> Ranks join the file of another, which sees their chunks in the end.
   subroutine test_join(checks, undisturbed)
      type(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: undisturbed
      type(campaign_file_t) :: first, second
      type(error_t), allocatable :: error
      integer :: chunk

      call create(checks, first, .true.)
      call compute(checks, first, 1)
      call second%join(path, layout_of(input), error)
      call checks%check(.not. allocated(error), 'join')
      call checks%check(second%is_done(1_int64) .and. .not. second%is_done(2_int64), 'what is done so far')
      do chunk = 2, chunks
         if (modulo(chunk, 2) == 0) call compute(checks, first, chunk)
         if (modulo(chunk, 2) == 1) call compute(checks, second, chunk)
      end do
      call first%refresh(error)
      call checks%check(all(first%done_flags()), 'both see all')
      call close_file(checks, second, .true.)
      call close_file(checks, first, .true.)
      call checks%check(content_of(path) == undisturbed, 'two ranks')
   end subroutine test_join

end module test_campaign_file
