!> A small campaign for the tests of its file, and the steps that they are made of.
module campaign_file_cases
   use campaign_file, only: campaign_file_t
   use campaign_header, only: campaign_layout_t
   use checks, only: check_list_t
   use checksum, only: checksum_of
   use errors, only: error_t
   use file_system, only: read_whole_file
   use kinds, only: dp, int64
   use text, only: integer_text
   implicit none(type, external)
   private

   character(*), parameter, public :: path = 'unit_test_campaign.tmp'
   character(*), parameter, public :: line_feed = achar(10)
   character(*), parameter, public :: input = '&load'//line_feed//'   mass = 3.0'//line_feed// &
      '   frequency = 600.0'//line_feed//'/'// &
                              line_feed//'&solver'//line_feed//'   periods = 20'//line_feed//'/'//line_feed
   integer, parameter, public :: scenes = 1000, chunk_rows = 64, chunks = 16, columns = 3
   integer, parameter :: size_limit = 1000000

   public :: layout_of, rows_of, compute, create, resume, close_file, finish, content_of, long_at, overwrite_bytes, &
             reseal, expect

contains

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
      call file%write_chunks(int(chunk, int64), rows_of(first, last), error)
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

   pure integer(int64) function long_at(content, offset)
      character(*), intent(in) :: content
      integer(int64), intent(in) :: offset

      long_at = transfer(content(offset + 1:offset + 8), long_at)
   end function long_at

   subroutine overwrite_bytes(offset, bytes)
      integer(int64), intent(in) :: offset
      character(*), intent(in) :: bytes
      integer :: unit

      open (newunit=unit, file=path, access='stream', form='unformatted', status='old', action='readwrite')
      write (unit, pos=offset + 1) bytes
      close (unit)
   end subroutine overwrite_bytes

   !> Enter the right checksum of a changed header, as another program would leave it.
   subroutine reseal()
      character(:), allocatable :: content
      integer :: text_end, table

      content = content_of(path)
      text_end = 128 + 48*columns + len(input)
      table = ((text_end + 63)/64)*64
      call overwrite_bytes(72_int64, transfer(checksum_of(content(:24)//content(33:72)//content(129:text_end)// &
                                                          content(table + 1:table + 32)), repeat(' ', 8)))
   end subroutine reseal

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

end module campaign_file_cases
