!> Tests of the range of an array: the same as minval and maxval, for every length and place.
module test_value_range
   use checks, only: check_list_t
   use kinds, only: dp
   use value_range, only: range_of
   implicit none(type, external)
   private

   public :: run_value_range_tests

contains

   !> Runs every test of this topic.
   subroutine run_value_range_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks
      real(dp) :: values(67), smallest, largest
      integer :: count, i
      logical :: agrees

      call checks%start('value_range')
      agrees = .true.
      do count = 1, size(values)
         values = [(sin(real(7*i + count, dp)), i=1, size(values))]
         call range_of(values(:count), smallest, largest)
         agrees = agrees .and. .not. abs(smallest - minval(values(:count))) > 0.0_dp .and. &
                  .not. abs(largest - maxval(values(:count))) > 0.0_dp
      end do
      call checks%check(agrees, 'as minval and maxval')
      call range_of([1.0_dp, -huge(1.0_dp), 2.0_dp, huge(1.0_dp)], smallest, largest)
      call checks%check(smallest <= -huge(1.0_dp) .and. largest >= huge(1.0_dp), 'extreme numbers')
   end subroutine run_value_range_tests

end module test_value_range
