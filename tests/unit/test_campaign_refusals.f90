!> Tests of what the result file of a campaign refuses: second runs, changed inputs, files of another kind, places
!> that cannot be written, full disks.
module test_campaign_refusals
   use campaign_file, only: campaign_file_t
   use campaign_file_cases, only: chunks, close_file, compute, content_of, create, expect, input, layout_of, line_feed, &
      overwrite_bytes, reseal, path, rows_of
   use campaign_header, only: campaign_layout_t
   use checks, only: check_list_t
   use errors, only: error_t, exit_bad_input, exit_system
   use file_system, only: delete_file, path_exists
   use input_difference, only: differing_keys
   use kinds, only: int64
   use random_access_file, only: random_access_file_t
   implicit none(type, external)
   private

   character(*), parameter :: other_path = 'unit_test_campaign_other.tmp'

   public :: run_campaign_refusals_tests

contains

   !> Runs every test of this topic.
   subroutine run_campaign_refusals_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks

      call checks%start('input_difference')
      call test_difference(checks)
      call checks%start('campaign_file')
      call delete_file(path)
      call delete_file(other_path)
      call test_lock(checks)
      call test_changes(checks)
      call test_foreign_headers(checks)
      call test_foreign_files(checks)
      call test_full_disk(checks)
      call delete_file(path)
      call delete_file(other_path)
   end subroutine run_campaign_refusals_tests

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
      call expect(checks, error, exit_system, 'is being written by another run')
      call second%create(path, layout_of(input), .true., error)
      call expect(checks, error, exit_system, 'is being written by another run')
      call second%create(path, layout_of(input), .false., error)
      call expect(checks, error, exit_bad_input, 'exists; --resume continues it')
      call checks%check(content_of(path) == before, 'the refused run changes nothing')
      call compute(checks, first, 2)
      call close_file(checks, first, .false.)
      call second%resume(path, layout_of(input), spoilt, error)
      call checks%check(.not. allocated(error), 'free again')
      call close_file(checks, second, .false.)
   end subroutine test_lock

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
      layout = layout_of(input)
      layout%units(1) = 'g'
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
      call expect(checks, error, exit_bad_input, 'holds 1000 scenes, this campaign has 2000')
      layout = layout_of(input)
      layout%source_checksum = 1
      call file%resume(path, layout, spoilt, error)
      call expect(checks, error, exit_bad_input, 'was begun with other scenes: the CSV file has changed')
      call checks%check(content_of(path) == before, 'nothing is changed by later refusals')
   end subroutine test_changes

   !> A file of another version of the program, and one whose table of chunks is none, are left alone.
   subroutine test_foreign_headers(checks)
      type(check_list_t), intent(inout) :: checks
      integer(int64), parameter :: version_place = 40_int64
      type(campaign_file_t) :: file
      type(error_t), allocatable :: error
      integer(int64) :: spoilt
      character(:), allocatable :: before

      call create(checks, file, .true.)
      call close_file(checks, file, .false.)
      call overwrite_bytes(version_place, '9.8.7   ')
      call file%resume(path, layout_of(input), spoilt, error)
      call expect(checks, error, exit_bad_input, 'damaged header')
      call reseal()
      before = content_of(path)
      call file%resume(path, layout_of(input), spoilt, error)
      call expect(checks, error, exit_bad_input, 'was begun by version 9.8.7 of the program')
      call checks%check(content_of(path) == before, 'another version: nothing is changed')
      call create(checks, file, .true.)
      call close_file(checks, file, .false.)
      call overwrite_bytes(int(index(content_of(path), 'CHUNKTAB'), int64) - 1_int64, 'BLOCKTAB')
      call reseal()
      before = content_of(path)
      call file%resume(path, layout_of(input), spoilt, error)
      call expect(checks, error, exit_bad_input, 'it has no table of chunks')
      call checks%check(content_of(path) == before, 'no table: nothing is changed')
   end subroutine test_foreign_headers

   subroutine test_difference(checks)
      type(check_list_t), intent(inout) :: checks

      call checks%check(differing_keys(input, input) == '', 'no difference')
      call checks%check(differing_keys('&a b = 1, 2 c = 3 /', &
                                         '&a b = 1, 2 c = 4 /') == 'a.c is 4 now and was 3', 'number')
      call checks%check(differing_keys('&a b = 1, 2 /', '&a b = 1 /') == 'a.b is 1 now and was 1, 2', &
                        'list')
      call checks%check(differing_keys('&a c = 3 /', '&a b = 1 c = 3 /') == &
                        'a.b is 1 now and was not set', 'new key')
      call checks%check(differing_keys("&a b = 'x' c = 3 /", &
                                         '&a c = 3 /') == 'a.b was x and is not set now', 'lost key')
      call checks%check(differing_keys('&a b = 1 / &d b = 1 /', &
                                         '&a b = 1 / &d b = 2 /') == 'd.b is 2 now and was 1', 'group')
      call checks%check(differing_keys('&a v(1) = 1 v(2) = 1 /', &
                                         '&a v(1) = 1 v(2) = 2 /') == 'a.v(2) is 2 now and was 1', &
                        'element')
      call checks%check(differing_keys('&a b = 1 / &d b = 1 /', '&a b = 2 / &d b = 2 /', ['a.b']) == &
                        'd.b is 2 now and was 1', 'a key of another group than the one that may differ')
      call checks%check(differing_keys('&a b = 1 c = 1 /', '&a b = 2 d = 1 /', [character(3) :: 'a.b', 'a.d', 'a.c']) == '', &
                        'keys that may differ, come or go')
   end subroutine test_difference

   !> Files of another kind are neither resumed nor replaced; a place that is none is reported.
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

   !> A device that is always full takes the place of a full disk; rows of a wrong size are refused.
   subroutine test_full_disk(checks)
      type(check_list_t), intent(inout) :: checks
      type(campaign_file_t) :: file
      type(error_t), allocatable :: error

      call create(checks, file, .true.)
      call file%write_chunks(1_int64, rows_of(1_int64, 5_int64), error)
      call expect(checks, error, exit_system, 'wrong size')
      call checks%check(.not. file%is_done(1_int64), 'a chunk that was not written is not done')
      call close_file(checks, file, .false.)
      call test_full_device(checks)
   end subroutine test_full_disk

   subroutine test_full_device(checks)
      type(check_list_t), intent(inout) :: checks
      type(random_access_file_t) :: file
      type(error_t), allocatable :: error

      call checks%check(path_exists('/dev/full'), 'there is a device that is always full')
      call file%open('/dev/full', .false., error)
      call checks%check(.not. allocated(error), 'open the full device')
      call file%write_at(0_int64, rows_of(1_int64, 5_int64), error)
      call expect(checks, error, exit_system, '/dev/full cannot be written: No space left')
      call file%close(error)
   end subroutine test_full_device

end module test_campaign_refusals
