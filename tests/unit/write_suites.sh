#!/bin/sh
# Prints the module of the suites of unit tests, one for each file test_NAME.f90 beside this script.
set -eu
cd "$(dirname "$0")"
suites=$(ls test_*.f90 | sed 's/^test_\(.*\)\.f90$/\1/')
count=$(echo "$suites" | wc -l)
each() { echo "$suites" | sed "$1"; }

cat << END
!> The suites of unit tests.
module unit_suites
   use checks, only: check_list_t
$(each 's/.*/   use test_&, only: run_&_tests/')
   implicit none(type, external)
   private

   public :: run_suite

   character(40), parameter, public :: suite_names($count) = [character(40) :: &
$(each "s/.*/      '&', \\&/; \$s/, &/]/")

contains

   subroutine run_suite(name, checks)
      character(*), intent(in) :: name
      type(check_list_t), intent(inout) :: checks

      select case (name)
$(each "s/.*/      case ('&')\n         call run_&_tests(checks)/")
      end select
   end subroutine run_suite

end module unit_suites
END
