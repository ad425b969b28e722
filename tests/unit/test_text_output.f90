!> Tests of words that cannot be written.
module test_text_output
   use checks, only: check_list_t
   use file_system, only: path_exists
   use errors, only: error_t
   use log_file, only: log_t
   use text_output, only: lost_text
   implicit none(type, external)
   private

   public :: run_text_output_tests

contains

   !> Runs every test of this topic.
   subroutine run_text_output_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks
      type(log_t) :: log
      type(error_t), allocatable :: error
      character(*), parameter :: path = 'rattle_test_text_output.log'
      character(20) :: line
      integer :: unit, stat

      call checks%start('text_output')
      call log%open('absent_folder/x.log', .true., error)
      call checks%check(allocated(error), 'a log without a folder')
      if (allocated(error)) call checks%check(index(error%message, 'absent_folder/x.log cannot be written: ') == 1, 'its sentence')

      call log%open(path, .true., error)
      call log%line('one')
      call log%line('two')
      call log%close()
      call checks%check(.not. allocated(error) .and. lost_text() == '', 'nothing is lost')
      open (newunit=unit, file=path, action='read')
      read (unit, '(a)', iostat=stat) line
      read (unit, '(a)', iostat=stat) line
      close (unit, status='delete')
      call checks%check(stat == 0 .and. line == 'two', 'two lines')

      call log%open('/dev/full', .true., error)
      call checks%check(.not. allocated(error) .and. lost_text() == '', 'a full disk is opened')
      call log%line('three')
      call log%close()
      call checks%check(lost_text() == '/dev/full', 'a line is lost')
      call checks%check(path_exists('/dev/full'), 'the device of a log stays')
   end subroutine run_text_output_tests

end module test_text_output
