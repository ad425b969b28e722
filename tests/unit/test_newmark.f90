!> Tests of Newmark's method on a linear film, whose motion is known in closed form with and without steps.
module test_newmark
   use checks, only: check_list_t
   use engine, only: motion_count_t, request_t
   use kinds, only: dp
   use linear_newmark, only: first_film, first_velocity, linear_film, linear_method, linear_motion, linear_problem, periods, &
      run_linear
   use newmark, only: start_motion, newmark_state_t
   use scene_status, only: status_complete
   implicit none(type, external)
   private

   public :: run_newmark_tests

contains

   !> Runs every test of this topic.
   subroutine run_newmark_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('newmark')
      call test_discrete(checks)
      call test_order(checks)
      call test_loose_tolerance(checks)
      call test_start(checks)
   end subroutine run_newmark_tests

   !> Both iterations, converged, give the motion with steps to rounding, every sample of it.
   subroutine test_discrete(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: steps = 128
      type(request_t) :: method
      type(motion_count_t) :: count
      type(newmark_state_t) :: expected
      real(dp), dimension(periods*steps) :: films, velocities, accelerations
      real(dp) :: error(3)
      character(:), allocatable :: name
      integer :: choice, status, i

      do choice = 1, 4
         method = linear_method()
         method%by_newton = choice <= 2
         method%extrapolate = mod(choice, 2) == 1
         name = trim(merge('newton    ', 'successive', method%by_newton))//', '// &
            trim(merge('extrapolated', 'previous    ', method%extrapolate))
         call run_linear(method, steps, films, velocities, accelerations, count, status)
         call checks%check(status == status_complete .and. count%cuts == 0, &
            name//': ended well, without cuts')
         call checks%check(count%steps == periods*steps, name//': steps counted')
         error = 0.0_dp
         do i = 1, periods*steps
            expected = linear_motion(1.0_dp/(600.0_dp*real(steps, dp)), i, .true.)
            error(1) = max(error(1), abs(films(i) - expected%film))
            error(2) = max(error(2), abs(velocities(i) - expected%velocity))
            error(3) = max(error(3), abs(accelerations(i) - expected%acceleration))
         end do
         ! The load of 370 N keeps 370 epsilon, so z'' some 1e-13 m/s2, and eps leaves 4 eps/dt^2 times the
         ! contraction of a pass, 1e-12 m/s2; there are hundreds of steps.
         call checks%check_close(error(1), 0.0_dp, 1.0e-18_dp, name//': film')
         call checks%check_close(error(2), 0.0_dp, 1.0e-14_dp, name//': velocity')
         call checks%check_close(error(3), 0.0_dp, 1.0e-10_dp, name//': acceleration')
         ! On a linear film the first pass is exact, the second sees that.
         if (method%by_newton) call checks%check(count%evaluations == 1 + 2*periods*steps, &
            name//': two iterations a step')
      end do
   end subroutine test_discrete

   !> Against the motion without steps the error falls fourfold when the step is halved.
   subroutine test_order(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: errors(3)
      type(request_t) :: method
      integer :: i

      method = linear_method()
      do i = 1, 3
         errors(i) = final_error(method, 128*2**i)
      end do
      ! The next power of the step enters the quotient with about 1e-3.
      call checks%check_close(errors(1)/errors(2), 4.0_dp, 0.05_dp, 'order two, first halving')
      call checks%check_close(errors(2)/errors(3), 4.0_dp, 0.02_dp, 'order two, second halving')
   end subroutine test_order

   !> With a tolerance that the first pass always meets the method is another one: of order one from the
   !> previous state, of order two from the extrapolated one.
   subroutine test_loose_tolerance(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: first(3), second(3)
      type(request_t) :: method
      integer :: i

      method = linear_method()
      method%by_newton = .false.
      method%tolerance = 1.0_dp
      do i = 1, 3
         method%extrapolate = .false.
         first(i) = final_error(method, 512*2**i)
         method%extrapolate = .true.
         second(i) = final_error(method, 512*2**i)
      end do
      ! The quotient nears the power of two as the step: 3 % and 1 % away at these steps.
      call checks%check_close(first(2)/first(3), 2.0_dp, 0.06_dp, 'previous, one pass: order one')
      call checks%check_close(second(2)/second(3), 4.0_dp, 0.06_dp, 'extrapolated, one pass: order two')
      method%tolerance = 1.0e-20_dp
      method%extrapolate = .false.
      call checks%check_close(final_error(method, 1024)/final_error(method, 2048), 4.0_dp, 0.02_dp, &
         'previous, to convergence: order two')
   end subroutine test_loose_tolerance

   !> Largest error of the film over the samples of the coarsest grid, against the exact motion [m].
   real(dp) function final_error(method, steps) result(error)
      type(request_t), intent(in) :: method  !> Constants
      integer, intent(in) :: steps           !> Steps a period, a multiple of 128

      type(motion_count_t) :: count
      type(newmark_state_t) :: expected
      real(dp), dimension(periods*steps) :: films, velocities, accelerations
      integer :: status, i

      call run_linear(method, steps, films, velocities, accelerations, count, status)
      error = 0.0_dp
      do i = steps/128, periods*steps, steps/128
         expected = linear_motion(1.0_dp/(600.0_dp*real(steps, dp)), i, .false.)
         error = max(error, abs(films(i) - expected%film))
      end do
   end function final_error

   !> z''(0) comes from the equation of motion.
   subroutine test_start(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(newmark_state_t) :: state
      type(motion_count_t) :: count
      integer :: status

      call start_motion(linear_film, linear_problem(), state, count, status)
      call checks%check(status == status_complete, 'start: status')
      call checks%check_close(state%film, first_film, 0.0_dp, 'start: film')
      call checks%check_close(state%velocity, first_velocity, 0.0_dp, 'start: velocity')
      call checks%check_close(state%acceleration, (370.0_dp - 180.0_dp - 3.0_dp - 199.2_dp - 20.0_dp &
         - 29.4_dp)/3.0_dp, &
         370.0_dp*4.0_dp*epsilon(1.0_dp), 'start: acceleration')
      call checks%check(count%evaluations == 1 .and. count%steps == 0, 'start: cost')
   end subroutine test_start

end module test_newmark
