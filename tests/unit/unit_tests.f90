!> Runs the suites of unit tests. The last line is 'N passed, M failed'; the exit code is 1 if any failed.
!>
!> The suites are the files test_NAME.f90 beside this one; write_suites.sh writes their list, the module unit_suites.
program unit_tests
   use, intrinsic :: iso_fortran_env, only: error_unit
   use checks, only: check_list_t
   use unit_suites, only: run_suite, suite_names
   implicit none(type, external)

   type(check_list_t) :: checks
   character(80) :: argument
   integer :: i, count_before

   if (command_argument_count() == 0) then
      do i = 1, size(suite_names)
         call run_suite(suite_names(i), checks)
      end do
   end if
   do i = 1, command_argument_count()
      call get_command_argument(i, argument)
      if (argument == '--list') then
         print '(a)', suite_names
         stop
      end if
      checks%wanted = words_of(argument)
      count_before = checks%passed + checks%failed
      if (any(suite_names == suite_of(argument))) call run_suite(suite_of(argument), checks)
      if (checks%passed + checks%failed == count_before) then
         write (error_unit, '(3a)') 'unit_tests: there is no test ''', trim(argument), '''. Usage:'
         write (error_unit, '(a)') '   unit_tests                run every suite', &
            '   unit_tests --list         print the names of the suites', &
            '   unit_tests film_law       run a suite', &
            '   unit_tests film_law/half  run the tests of a suite whose sentence has a word, and print each'
         stop 2, quiet = .true.
      end if
   end do
   print '(i0, a, i0, a)', checks%passed, ' passed, ', checks%failed, ' failed'
   if (checks%failed > 0) stop 1, quiet = .true.

contains

   !> What stands before the stroke.
   pure function suite_of(argument) result(name)
      character(*), intent(in) :: argument
      character(len(suite_names)) :: name

      name = argument(:scan(argument//'/', '/') - 1)
   end function suite_of

   !> What stands behind the stroke.
   pure function words_of(argument) result(words)
      character(*), intent(in) :: argument
      character(:), allocatable :: words

      words = trim(argument(min(scan(argument//'/', '/'), len(argument)) + 1:))
   end function words_of

end program unit_tests
