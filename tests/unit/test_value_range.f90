!> Tests of the range of an array: the same as minval and maxval, for every length and place; and of its unit.
module test_value_range
   use checks, only: check_list_t
   use kinds, only: dp
   use value_range, only: binary_unit, range_of
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
      call test_unit(checks)
   end subroutine run_value_range_tests

   !> The largest magnitude is from one half to one in its unit, where the reciprocal of the unit is finite.
   subroutine test_unit(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp) :: no_numbers(0)
      integer :: i

      do i = -1000, 1000, 40
         call checks%check_close(binary_unit([scale(0.6_dp, i - 3), scale(-0.6_dp, i)]), scale(1.0_dp, i), 0.0_dp, 'unit')
      end do
      call checks%check_close(binary_unit([0.5_dp]), 1.0_dp, 0.0_dp, 'unit of a power of two')
      call checks%check_close(binary_unit([huge(1.0_dp)]), scale(1.0_dp, 1000), 0.0_dp, 'unit of the largest number')
      call checks%check_close(binary_unit([-tiny(1.0_dp)]), scale(1.0_dp, -1000), 0.0_dp, 'unit of the smallest number')
      call checks%check_close(binary_unit([0.0_dp, 0.0_dp]), 1.0_dp, 0.0_dp, 'unit of zeros')
      call checks%check_close(binary_unit(no_numbers), 1.0_dp, 0.0_dp, 'unit of nothing')
   end subroutine test_unit

end module test_value_range
