!> Tests of errors as values and of the list of faults.
module test_errors
   use checks, only: check_list_t
   use errors, only: error_t, exit_bad_input, exit_complete, exit_scene_failed, exit_system, fault_list_t, &
      raise
   implicit none(type, external)
   private

   public :: run_errors_tests

contains

   !> Runs every test of this topic.
   subroutine run_errors_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('errors')
      call test_raise(checks)
      call test_sentences(checks)
      call test_order(checks)
      call test_cap(checks)
      call test_taking(checks)
   end subroutine run_errors_tests

   !> An error holds its code and sentence; the exit codes are documented numbers.
   subroutine test_raise(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(error_t), allocatable :: error

      call raise(error, exit_scene_failed, 'first')
      call raise(error, exit_bad_input, 'second')
      call checks%check(error%exit_code == 2 .and. error%message == 'second', 'the last error counts')
      call checks%check(all([exit_complete, exit_scene_failed, exit_bad_input, exit_system] == [0, 1, 2, &
         3]), 'exit codes')
   end subroutine test_raise

   !> Faults of two looks at one input: what both see is reported once, what one look sees twice is reported twice.
   subroutine test_taking(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(fault_list_t) :: faults, second

      call faults%add('a.nml', 7, 'load', 'mass', 'wrong')
      call second%add('a.nml', 7, 'load', 'mass', 'wrong')
      call second%add('a.nml', 3, 'gear', 'name', 'wrong')
      call second%add('a.nml', 3, 'gear', 'name', 'wrong')
      second%exit_code = exit_system
      call faults%take(second)
      call checks%check(faults%count() == 3, 'known faults are not taken again')
      call checks%check(faults%sentence(3) == 'a.nml:3: &gear name: wrong', 'sentence of a taken fault')
      call checks%check(faults%exit_code == exit_system, 'exit code of both')
      call faults%sort_since(0)
      call checks%check(faults%sentence(1) == 'a.nml:3: &gear name: wrong', 'line of a taken fault')
   end subroutine test_taking

   !> What is not known is left out of the place.
   subroutine test_sentences(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(fault_list_t) :: faults

      call faults%add('a.nml', 7, 'load', 'mass', 'wrong')
      call faults%add('a.nml', 0, 'load', '', 'wrong')
      call faults%add('a.nml', 0, '', 'mass', 'wrong')
      call faults%add('a.nml', 3, '', '', 'wrong')
      call faults%add('a.nml', 0, '', '', 'wrong')
      call checks%check(faults%sentence(1) == 'a.nml:7: &load mass: wrong', 'line, group and key')
      call checks%check(faults%sentence(2) == 'a.nml: &load: wrong', 'group only')
      call checks%check(faults%sentence(3) == 'a.nml: mass: wrong', 'key only')
      call checks%check(faults%sentence(4) == 'a.nml:3: wrong', 'line only')
      call checks%check(faults%sentence(5) == 'a.nml: wrong', 'file only')
   end subroutine test_sentences

   !> Sorted by line, unplaced ones last, equal lines as they came, earlier inputs left alone.
   subroutine test_order(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: lines(8) = [9, 5, 0, 3, 5, 0, 1, 3]
      character(1), parameter :: names(8) = ['x', 'a', 'b', 'c', 'd', 'e', 'f', 'g']
      character(1), parameter :: sorted(8) = ['x', 'f', 'c', 'g', 'a', 'd', 'b', 'e']
      type(fault_list_t) :: faults
      character(:), allocatable :: sentence
      integer :: i
      logical :: in_order

      do i = 1, size(lines)
         call faults%add('f', lines(i), '', '', names(i))
      end do
      call faults%sort_since(1)
      in_order = .true.
      do i = 1, size(sorted)
         sentence = faults%sentence(i)
         in_order = in_order .and. sentence(len(sentence):) == sorted(i)
      end do
      call checks%check(in_order, 'order of the lines')
      call faults%sort_since(8)
      call checks%check(faults%count() == 8, 'nothing to sort')
   end subroutine test_order

   !> Kept up to a thousand, in their order; further ones are counted.
   subroutine test_cap(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(fault_list_t) :: faults
      character(4) :: digits
      integer :: i
      logical :: in_order

      call checks%check(faults%count() == 0 .and. faults%not_kept() == 0, 'empty at first')
      do i = 1, 1234
         write (digits, '(i4.4)') i
         call faults%add('f', 0, '', '', digits)
      end do
      call checks%check(faults%count() == 1000, 'a thousand are kept')
      call checks%check(faults%not_kept() == 234, 'the rest is counted')
      in_order = .true.
      do i = 1, 1000
         write (digits, '(i4.4)') i
         in_order = in_order .and. faults%sentence(i) == 'f: '//digits
      end do
      call checks%check(in_order, 'they keep their order while the list grows')
   end subroutine test_cap

end module test_errors
