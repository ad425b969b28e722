!> Tests of whether motions that do not repeat are one by their states.
module test_irregular_states
   use checks, only: check_list_t
   use kinds, only: dp
   use known_motions, only: are_of_one_motion
   implicit none(type, external)
   private

   public :: run_irregular_states_tests

contains

   !> Runs every test of this topic.
   subroutine run_irregular_states_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('irregular_states')
      call test_one_motion(checks)
      call test_limit(checks)
   end subroutine run_irregular_states_tests

   !> Parts of one chaotic sequence, x' = 3.9 x (1 - x), are of one motion; those of another one, and of one at rest, are not.
   subroutine test_one_motion(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      real(dp) :: states(2, 400)
      integer :: i

      states(1, 1) = 0.3_dp
      do i = 2, size(states, 2)
         states(1, i) = 3.9_dp*states(1, i - 1)*(1.0_dp - states(1, i - 1))
      end do
      states(2, :) = -states(1, :)
      do i = 100, 300, 50
         call checks%check(are_of_one_motion(states(:, i:i + 39), states(:, i + 40:i + 99)), 'one: parts of a sequence')
         call checks%check(.not. are_of_one_motion(states(:, i:i + 39), 0.5_dp*states(:, i + 40:i + 99)), 'another: half as large')
         call checks%check(.not. are_of_one_motion(states(:, i:i + 39), spread([0.6_dp, -0.6_dp], 2, 60)), 'another: at rest')
         call checks%check(.not. are_of_one_motion(states(:, i:i + 39), reshape([states(1, 100:159), 0.2_dp*states(2, 100:159)], &
                                                                                [2, 60], order=[2, 1])), 'another: by one number')
      end do
   end subroutine test_one_motion

   !> Two samples of ten: 1.63 sqrt(2/10) = 0.73.
   subroutine test_limit(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      real(dp) :: one(1, 10), other(1, 10)
      integer :: i

      one(1, :) = [(real(i, dp), i=1, 10)]
      other = one + 6.5_dp
      call checks%check(are_of_one_motion(one, other), 'limit: seven of ten are below')
      other = one + 7.5_dp
      call checks%check(.not. are_of_one_motion(one, other), 'limit: eight of ten are below')
   end subroutine test_limit

end module test_irregular_states
