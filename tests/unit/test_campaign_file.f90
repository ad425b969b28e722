!> Tests of the result file of a campaign: any order of chunks and any number of runs give the same bytes;
!> spoilt chunks, changed inputs, second runs and full disks are seen.
module test_campaign_file
   use campaign_file, only: campaign_file_t, campaign_layout_t
   use checks, only: check_list_t
   use checksum, only: checksum_of
   use errors, only: error_t, exit_bad_input, exit_system
   use file_system, only: delete_file, path_exists, read_whole_file
   use input_difference, only: first_difference
   use kinds, only: dp, int64
   use random_access_file, only: random_access_file_t
   use text, only: integer_text
   implicit none(type, external)
   private

   character(*), parameter :: path = 'unit_test_campaign.tmp', other_path = 'unit_test_campaign_other.tmp'
   character(*), parameter :: line_feed = achar(10)
   character(*), parameter :: input = '&load'//line_feed//'   mass = 3.0'//line_feed// &
      '   frequency = 600.0'//line_feed//'/'// &
                              line_feed//'&solver'//line_feed//'   periods = 20'//line_feed//'/'//line_feed
   integer, parameter :: scenes = 1000, chunk_rows = 64, chunks = 16, columns = 3
   integer, parameter :: size_limit = 1000000

   public :: run_campaign_file_tests

contains

   !> Runs every test of this topic.
   subroutine run_campaign_file_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks
      character(:), allocatable :: undisturbed

      call checks%start('input_difference')
      call test_difference(checks)
      call checks%start('campaign_file')
      call delete_file(path)
      call delete_file(other_path)
      call test_layout(checks, undisturbed)
      call test_orders(checks, undisturbed)
      call test_kills(checks, undisturbed)
      call test_spoilt_chunks(checks, undisturbed)
      call test_lock(checks)
      call test_changes(checks)
      call test_foreign_files(checks)
      call test_join(checks, undisturbed)
      call test_full_disk(checks)
      call delete_file(path)
      call delete_file(other_path)
      call checks%check(.not. path_exists(path//'.new'), 'nothing is left behind')
   end subroutine run_campaign_file_tests

   pure function layout_of(text) result(layout)
      character(*), intent(in) :: text
      type(campaign_layout_t) :: layout

      layout%input_text = text
      allocate (layout%names, source=[character(32) :: 'mass', 'class', 'film_minimum'])
      allocate (layout%units, source=[character(16) :: 'kg', '-', 'm'])
      layout%scene_count = scenes
      layout%chunk_rows = chunk_rows
   end function layout_of

   !> What the solver would find.
   pure function rows_of(first, last) result(rows)
      integer(int64), intent(in) :: first
      integer(int64), intent(in) :: last
      real(dp) :: rows(columns, last - first + 1)
      integer(int64) :: i

      do i = first, last
         rows(:, i - first + 1) = [real(i, dp), sqrt(real(i, dp)), 1.0_dp/real(i, dp)]
      end do
   end function rows_of

   subroutine compute(checks, file, chunk)
      type(check_list_t), intent(inout) :: checks
      type(campaign_file_t), intent(inout) :: file
      integer, intent(in) :: chunk
      type(error_t), allocatable :: error
      integer(int64) :: first, last

      call file%chunk_bounds(int(chunk, int64), first, last)
      call file%write_chunk(int(chunk, int64), rows_of(first, last), error)
      call checks%check(.not. allocated(error) .and. file%is_done(int(chunk, int64)), 'write chunk '// &
                        integer_text(chunk))
   end subroutine compute

   subroutine create(checks, file, overwrite)
      type(check_list_t), intent(inout) :: checks
      type(campaign_file_t), intent(inout) :: file
      logical, intent(in) :: overwrite
      type(error_t), allocatable :: error

      call file%create(path, layout_of(input), overwrite, error)
      call checks%check(.not. allocated(error), 'create')
      if (allocated(error)) print '(a)', error%message
   end subroutine create

   subroutine resume(checks, file, expected_spoilt)
      type(check_list_t), intent(inout) :: checks
      type(campaign_file_t), intent(inout) :: file
      integer, intent(in) :: expected_spoilt
      type(error_t), allocatable :: error
      integer(int64) :: spoilt

      call file%resume(path, layout_of(input), spoilt, error)
      call checks%check(.not. allocated(error), 'resume')
      if (allocated(error)) print '(a)', error%message
      call checks%check(spoilt == expected_spoilt, 'spoilt chunks')
   end subroutine resume

   !> Close, which finishes the file or does not.
   subroutine close_file(checks, file, expected)
      type(check_list_t), intent(inout) :: checks
      type(campaign_file_t), intent(inout) :: file
      logical, intent(in) :: expected
      type(error_t), allocatable :: error
      logical :: finished

      call file%close(finished, error)
      call checks%check(.not. allocated(error), 'close')
      call checks%check(finished .eqv. expected, 'finished')
   end subroutine close_file

   subroutine finish(checks, file)
      type(check_list_t), intent(inout) :: checks
      type(campaign_file_t), intent(inout) :: file
      integer :: chunk

      do chunk = 1, chunks
         if (.not. file%is_done(int(chunk, int64))) call compute(checks, file, chunk)
      end do
      call close_file(checks, file, .true.)
   end subroutine finish

   function content_of(name) result(content)
      character(*), intent(in) :: name
      character(:), allocatable :: content
      integer :: stat

      call read_whole_file(name, size_limit, content, stat)
      if (stat /= 0) content = ''
   end function content_of

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
      call checks%check(file%is_locked(), 'locked')
      call checks%check(file%chunk_count() == chunks .and. .not. any(file%done_flags()), 'no chunk is done')
      undisturbed = content_of(path)
      call checks%check(long_at(undisturbed, 24_int64) == -1_int64, 'rows unknown')
      call finish(checks, file)
      undisturbed = content_of(path)
      call checks%check(undisturbed(:8) == 'RATTLE'//achar(13)//achar(10), 'magic')
      call checks%check(long_at(undisturbed, 24_int64) == scenes, 'count of rows')
      table = 64 + 48*columns + len(input)
      call checks%check(undisturbed(64 + 48*columns + 1:table) == input, 'input text')
      table = ((table + 63)/64)*64
      call checks%check(undisturbed(table + 1:table + 8) == 'CHUNKTAB', 'magic of the table')
      call checks%check(long_at(undisturbed, table + 8) == chunk_rows, 'scenes in a chunk')
      call checks%check(long_at(undisturbed, table + 16) == chunks, 'count of chunks')
      first_row = ((table + 24 + 8*chunks + 63)/64)*64
      call checks%check(long_at(undisturbed, 16_int64) == first_row, 'bytes before the rows')
      call checks%check(len(undisturbed, int64) == first_row + 8*columns*scenes, 'size')
      do chunk = 1, chunks
         first = int(chunk - 1, int64)*chunk_rows + 1
         last = min(first + chunk_rows - 1, int(scenes, int64))
         call checks%check(long_at(undisturbed, table + 24 + 8*(chunk - 1)) == checksum_of(rows_of(first, &
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

   pure integer(int64) function long_at(content, offset)
      character(*), intent(in) :: content
      integer(int64), intent(in) :: offset

      long_at = transfer(content(offset + 1:offset + 8), long_at)
   end function long_at

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
      failed = 0
      !$omp parallel do num_threads(4) schedule(dynamic) default(none) shared(file) &
      !$omp private(first, last, error) reduction(+:failed)
      do i = 1, chunks
         call file%chunk_bounds(int(i, int64), first, last)
         call file%write_chunk(int(i, int64), rows_of(first, last), error)
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

   subroutine overwrite_bytes(offset, bytes)
      integer(int64), intent(in) :: offset
      character(*), intent(in) :: bytes
      integer :: unit

      open (newunit=unit, file=path, access='stream', form='unformatted', status='old', action='readwrite')
      write (unit, pos=offset + 1) bytes
      close (unit)
   end subroutine overwrite_bytes

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

   !> While one run has the file, no other gets it.
   subroutine test_lock(checks)
      type(check_list_t), intent(inout) :: checks
      type(campaign_file_t) :: first, second
      type(error_t), allocatable :: error
      integer(int64) :: spoilt
      character(:), allocatable :: before

      call create(checks, first, .true.)
      call compute(checks, first, 1)
      before = content_of(path)
      call second%resume(path, layout_of(input), spoilt, error)
      call expect(checks, error, exit_bad_input, 'is being written by another run')
      call second%create(path, layout_of(input), .true., error)
      call expect(checks, error, exit_bad_input, 'is being written by another run')
      call second%create(path, layout_of(input), .false., error)
      call expect(checks, error, exit_bad_input, 'exists; --resume continues it')
      call checks%check(content_of(path) == before, 'the refused run changes nothing')
      call compute(checks, first, 2)
      call close_file(checks, first, .false.)
      call second%resume(path, layout_of(input), spoilt, error)
      call checks%check(.not. allocated(error), 'free again')
      call close_file(checks, second, .false.)
   end subroutine test_lock

   subroutine expect(checks, error, exit_code, words)
      type(check_list_t), intent(inout) :: checks
      type(error_t), allocatable, intent(in) :: error
      integer, intent(in) :: exit_code
      character(*), intent(in) :: words

      call checks%check(allocated(error), 'an error: '//words)
      if (.not. allocated(error)) return
      call checks%check(index(error%message, words) > 0, 'an error: '//words//' (got: '//error%message//')')
      call checks%check(error%exit_code == exit_code, 'exit code: '//words)
   end subroutine expect

   !> Another input is refused by the name of its key; other columns are as well.
   subroutine test_changes(checks)
      type(check_list_t), intent(inout) :: checks
      type(campaign_file_t) :: file
      type(campaign_layout_t) :: layout
      type(error_t), allocatable :: error
      integer(int64) :: spoilt
      character(:), allocatable :: before

      call create(checks, file, .true.)
      call compute(checks, file, 1)
      call close_file(checks, file, .false.)
      before = content_of(path)
      call file%resume(path, layout_of('&load'//line_feed//'   mass = 3.5'//input(20:)), spoilt, error)
      call expect(checks, error, exit_bad_input, 'load.mass is 3.5 now and was 3.0')
      layout = layout_of(input)
      layout%names(3) = 'film_maximum'
      call file%resume(path, layout, spoilt, error)
      call expect(checks, error, exit_bad_input, 'other columns')
      deallocate (layout%names)
      allocate (layout%names, source=[character(32) :: 'mass'])
      call file%resume(path, layout, spoilt, error)
      call expect(checks, error, exit_bad_input, 'other columns')
      call checks%check(content_of(path) == before, 'nothing is changed')
      layout = layout_of(input)
      layout%chunk_rows = 100
      call file%resume(path, layout, spoilt, error)
      call checks%check(.not. allocated(error) .and. file%chunk_count() == chunks, &
                        'chunks are those of the file')
      call close_file(checks, file, .false.)
      layout%scene_count = 2000
      call file%resume(path, layout, spoilt, error)
      call expect(checks, error, exit_bad_input, 'damaged table of chunks')
   end subroutine test_changes

   subroutine test_difference(checks)
      type(check_list_t), intent(inout) :: checks

      call checks%check(first_difference(input, input) == '', 'no difference')
      call checks%check(first_difference('&a b = 1, 2 c = 3 /', &
                                         '&a b = 1, 2 c = 4 /') == 'a.c is 4 now and was 3', 'number')
      call checks%check(first_difference('&a b = 1, 2 /', '&a b = 1 /') == 'a.b is 1 now and was 1, 2', &
                        'list')
      call checks%check(first_difference('&a c = 3 /', '&a b = 1 c = 3 /') == &
                        'a.b is 1 now and was not set', 'new key')
      call checks%check(first_difference("&a b = 'x' c = 3 /", &
                                         '&a c = 3 /') == 'a.b was x and is not set now', 'lost key')
      call checks%check(first_difference('&a b = 1 / &d b = 1 /', &
                                         '&a b = 1 / &d b = 2 /') == 'd.b is 2 now and was 1', 'group')
      call checks%check(first_difference('&a v(1) = 1 v(2) = 1 /', &
                                         '&a v(1) = 1 v(2) = 2 /') == 'a.v(2) is 2 now and was 1', &
                        'element')
   end subroutine test_difference

   !> Files of another kind are neither resumed nor replaced; a place that is none is told.
   subroutine test_foreign_files(checks)
      type(check_list_t), intent(inout) :: checks
      type(campaign_file_t) :: file
      type(error_t), allocatable :: error
      integer(int64) :: spoilt
      integer :: unit

      open (newunit=unit, file=other_path, status='replace', action='write')
      write (unit, '(a)') 'my notes'
      close (unit)
      call file%resume(other_path, layout_of(input), spoilt, error)
      call expect(checks, error, exit_bad_input, 'was not written by rattle')
      call file%create(other_path, layout_of(input), .true., error)
      call expect(checks, error, exit_bad_input, 'never replaced')
      call checks%check(content_of(other_path) == 'my notes'//line_feed, 'the notes are safe')
      call delete_file(other_path)
      call file%resume(other_path, layout_of(input), spoilt, error)
      call expect(checks, error, exit_bad_input, 'nothing to resume')
      call file%create('no_such_folder_here/x.rattle', layout_of(input), .false., error)
      call expect(checks, error, exit_bad_input, 'no_such_folder_here/x.rattle')
   end subroutine test_foreign_files

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

   !> A device that is always full takes the place of a full disk; rows of a wrong size are refused.
   subroutine test_full_disk(checks)
      type(check_list_t), intent(inout) :: checks
      type(campaign_file_t) :: file
      type(error_t), allocatable :: error

      call create(checks, file, .true.)
      call file%write_chunk(1_int64, rows_of(1_int64, 5_int64), error)
      call expect(checks, error, exit_system, 'wrong size')
      call checks%check(.not. file%is_done(1_int64), 'a chunk that was not written is not done')
      call close_file(checks, file, .false.)
      call test_full_device(checks)
   end subroutine test_full_disk

   subroutine test_full_device(checks)
      type(check_list_t), intent(inout) :: checks
      type(random_access_file_t) :: file
      type(error_t), allocatable :: error

      if (.not. path_exists('/dev/full')) return
      call file%open('/dev/full', .false., error)
      call checks%check(.not. allocated(error), 'open the full device')
      call file%write_at(0_int64, rows_of(1_int64, 5_int64), error)
      call expect(checks, error, exit_system, '/dev/full cannot be written: No space left')
      call file%close(error)
   end subroutine test_full_device

end module test_campaign_file
