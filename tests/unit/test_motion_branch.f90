!> Tests of branches of periodic motions on maps whose ends are known in closed form.
module test_motion_branch
   use checks, only: check_list_t
   use kinds, only: dp
   use motion_branch, only: branch_end_t, branch_point_t, end_doubling, end_fold, end_lost, end_no_start, end_of_kind, &
                            end_of_range, end_torus, follow_branch, motion_family_t, point_at
   implicit none(type, external)
   private

   integer, parameter :: fold_map = 1, doubling_map = 2, torus_map = 3, steep_map = 4, failing_map = 5

   !> Maps with a fold at 0.7: x + 0.7 - share - x^2; a logistic map that doubles its period at 0.5; a delayed logistic map whose
   !> multipliers leave the unit circle as a pair at 0.5; folds at 0.6 and 0.3 of states that are a million times as small; and the
   !> first map, undefined beyond 0.4.
   type, extends(motion_family_t) :: known_map_t
      integer :: kind = fold_map
      !> Least first number of a state of the kind that is followed
      real(dp) :: least = -huge(1.0_dp)
   contains
      procedure :: map => map_known
      procedure :: sizes => sizes_known
      procedure :: keeps_kind => keeps_known
   end type known_map_t

   public :: run_motion_branch_tests

contains

   !> Runs every test of this topic.
   subroutine run_motion_branch_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('motion_branch')
      call test_fold(checks)
      call test_stability(checks)
      call test_kind(checks)
      call test_range(checks)
      call test_no_start(checks)
      call test_passed(checks)
   end subroutine run_motion_branch_tests

   subroutine map_known(self, periods, accuracy, shares, states, mapped)
      class(known_map_t), intent(inout) :: self
      integer, intent(in) :: periods
      real(dp), intent(in) :: accuracy
      real(dp), intent(in) :: shares(:)
      real(dp), intent(inout) :: states(:, :)
      logical, intent(out) :: mapped
      real(dp) :: rate(size(shares)), before(size(shares))
      integer :: period

      mapped = accuracy > 0.0_dp
      if (self%kind == failing_map) mapped = all(shares < 0.4_dp)
      do period = 1, periods
         select case (self%kind)
         case (fold_map, failing_map)
            states(1, :) = states(1, :) + 0.7_dp - shares - states(1, :)**2
         case (doubling_map)
            rate = 2.0_dp + 2.0_dp*shares
            states(1, :) = rate*states(1, :)*(1.0_dp - states(1, :))
         case (torus_map)
            rate = 1.5_dp + shares
            before = states(1, :)
            states(1, :) = rate*states(1, :)*(1.0_dp - states(2, :))
            states(2, :) = before
         case default
            ! In millionths: cubic(x) = share, between two folds
            states(1, :) = states(1, :) + 1.0e-6_dp*0.1_dp*(shares - cubic(1.0e6_dp*states(1, :)))
         end select
      end do
   end subroutine map_known

   !> A cubic whose extremes are 0.6 at -1 and 0.3 at 1.
   elemental real(dp) function cubic(x)
      real(dp), intent(in) :: x

      cubic = 0.45_dp + 0.075_dp*(x**3 - 3.0_dp*x)
   end function cubic

   function sizes_known(self, share, state) result(sizes)
      class(known_map_t), intent(inout) :: self
      real(dp), intent(in) :: share
      real(dp), intent(in) :: state(:)
      real(dp) :: sizes(size(state))

      sizes = merge(1.0e-6_dp, 1.0_dp, self%kind == steep_map .and. share >= 0.0_dp)
   end function sizes_known

   logical function keeps_known(self, periods, share, state)
      class(known_map_t), intent(inout) :: self
      integer, intent(in) :: periods
      real(dp), intent(in) :: share
      real(dp), intent(in) :: state(:)
      integer, parameter :: settling_periods = 200
      real(dp) :: states(size(state), 1)
      logical :: mapped

      ! It is the motion next to a state that is judged.
      states(:, 1) = state
      call self%map(settling_periods*periods, 1.0_dp, [share], states, mapped)
      keeps_known = states(1, 1) >= self%least .or. .not. self%least > -huge(1.0_dp)
   end function keeps_known

   !> Folds to 1e-8 of the range, upwards and downwards, of states that count little as well.
   subroutine test_fold(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(known_map_t) :: family
      type(branch_end_t) :: ending

      ending = follow_branch(family, 1, 0.1_dp, [0.8_dp], 1, 1.0e-4_dp)
      call checks%check(ending%code == end_fold, 'fold: its kind')
      call checks%check_close(ending%point%share, 0.7_dp, 1.0e-8_dp, 'fold: its place')
      call checks%check(abs(ending%point%multipliers(1)) < 1.0_dp + 1.0e-6_dp, 'fold: its last motion is stable')
      call checks%check_close(real(ending%point%multipliers(1), dp), 1.0_dp, 1.0e-4_dp, 'fold: a multiplier of 1')
      family%kind = steep_map
      ending = follow_branch(family, 1, 0.45_dp, [-1.7e-6_dp], 1, 1.0e-4_dp)
      call checks%check(ending%code == end_fold, 'fold upwards: its kind')
      call checks%check_close(ending%point%share, 0.6_dp, 1.0e-8_dp, 'fold upwards: its place')
      ending = follow_branch(family, 1, 0.45_dp, [1.7e-6_dp], -1, 1.0e-2_dp)
      call checks%check(ending%code == end_fold, 'fold downwards: its kind')
      call checks%check_close(ending%point%share, 0.3_dp, 1.0e-8_dp, 'fold downwards: its place')
   end subroutine test_fold

   !> Period doubling and torus, where multipliers leave the unit circle elsewhere; the key goes on there. Multipliers are known to
   !> 1e-8, and change by 2 over the range.
   subroutine test_stability(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(known_map_t) :: family
      type(branch_end_t) :: ending

      family%kind = doubling_map
      ending = follow_branch(family, 1, 0.1_dp, [0.55_dp], 1, 1.0e-4_dp)
      call checks%check(ending%code == end_doubling, 'doubling: its kind')
      call checks%check_close(ending%point%share, 0.5_dp, 3.0e-8_dp, 'doubling: its place')
      call checks%check_close(ending%point%state(1), 2.0_dp/3.0_dp, 1.0e-7_dp, 'doubling: its state')
      ! Beyond it, the motion of two periods is followed to where it doubles, 1 + sqrt(6); its image curves more.
      ending = follow_branch(family, 2, 0.55_dp, [0.76_dp], 1, 1.0e-4_dp)
      call checks%check(ending%code == end_doubling, 'second doubling: its kind')
      call checks%check_close(ending%point%share, 0.5_dp*(sqrt(6.0_dp) - 1.0_dp), 2.0e-7_dp, 'second doubling: its place')
      family%kind = torus_map
      ending = follow_branch(family, 1, 0.1_dp, [0.37_dp, 0.37_dp], 1, 1.0e-4_dp)
      call checks%check(ending%code == end_torus, 'torus: its kind')
      call checks%check_close(ending%point%share, 0.5_dp, 3.0e-8_dp, 'torus: its place')
   end subroutine test_stability

   !> A branch that loses its kind before its fold ends there: x = sqrt(0.7 - share) comes to 0.5 at 0.45.
   subroutine test_kind(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(known_map_t) :: family
      type(branch_end_t) :: ending

      family%least = 0.5_dp
      ending = follow_branch(family, 1, 0.1_dp, [0.8_dp], 1, 1.0e-4_dp)
      call checks%check(ending%code == end_of_kind, 'kind: it ends')
      call checks%check_close(ending%point%share, 0.45_dp, 2.0e-9_dp, 'kind: its place')
      ! Within the step that passes the fold: x is 0.01 at 0.6999.
      family%least = 0.01_dp
      ending = follow_branch(family, 1, 0.1_dp, [0.8_dp], 1, 1.0e-4_dp)
      call checks%check(ending%code == end_of_kind, 'kind next to a fold: it ends')
      call checks%check_close(ending%point%share, 0.6999_dp, 2.0e-9_dp, 'kind next to a fold: its place')
   end subroutine test_kind

   !> The end of the range, and of where there is a map.
   subroutine test_range(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(known_map_t) :: family
      type(branch_end_t) :: ending

      ending = follow_branch(family, 1, 0.1_dp, [0.8_dp], -1, 1.0e-4_dp)
      call checks%check(ending%code == end_of_range, 'range: it ends')
      call checks%check(.not. ending%point%share > 0.0_dp, 'range: at its end')
      call checks%check_close(ending%point%state(1), sqrt(0.7_dp), 1.0e-10_dp, 'range: its state')
      ending = follow_branch(family, 1, 0.0_dp, [0.8_dp], -1, 1.0e-4_dp)
      call checks%check(ending%code == end_of_range, 'range: it begins where it ends')
      family%kind = failing_map
      ending = follow_branch(family, 1, 0.1_dp, [0.8_dp], 1, 1.0e-4_dp)
      call checks%check(ending%code == end_lost, 'no map: lost')
      call checks%check_close(ending%point%share, 0.4_dp, 3.0e-5_dp, 'no map: its place')
   end subroutine test_range

   !> What is no stable motion of the kind is not followed.
   subroutine test_no_start(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(known_map_t) :: family
      type(branch_end_t) :: ending

      ending = follow_branch(family, 1, 0.1_dp, [-0.8_dp], 1, 1.0e-4_dp)
      call checks%check(ending%code == end_no_start, 'no start: an unstable motion')
      ending = follow_branch(family, 1, 0.9_dp, [0.3_dp], 1, 1.0e-4_dp)
      call checks%check(ending%code == end_no_start, 'no start: no motion')
      family%least = 0.9_dp
      ending = follow_branch(family, 1, 0.1_dp, [0.8_dp], 1, 1.0e-4_dp)
      call checks%check(ending%code == end_no_start, 'no start: another kind')
   end subroutine test_no_start

   !> Motions of the branch from start to end, and one at a place between them.
   subroutine test_passed(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(known_map_t) :: family
      type(branch_end_t) :: ending
      type(branch_point_t) :: point
      logical :: found
      integer :: i

      ending = follow_branch(family, 1, 0.1_dp, [0.8_dp], 1, 1.0e-4_dp)
      associate (points => ending%points)
         call checks%check(all([(points(i)%share > points(i - 1)%share, i=2, size(points))]), 'passed: one after the other')
         do i = 1, size(points)
            call checks%check_close(points(i)%state(1)**2, 0.7_dp - points(i)%share, 1.0e-9_dp, 'passed: each on the branch')
         end do
         call checks%check_close(points(2)%share, 0.1001_dp, 1.0e-7_dp, 'passed: the first step is that asked for')
      end associate
      point = point_at(family, 1, [1.0_dp], 0.3_dp, [0.6_dp], 1, found)
      call checks%check(found, 'at a place: found')
      call checks%check_close(point%state(1), sqrt(0.4_dp), 1.0e-10_dp, 'at a place: its state')
   end subroutine test_passed

end module test_motion_branch
