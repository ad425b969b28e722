!> Tests of the cuts of Newmark's method, where a step is too long, and of every way in which a motion can fail.
module test_newmark_cuts
   use canonical_scenes, only: canonical_method, canonical_scene, idle_steady_film
   use checks, only: check_list_t
   use engine, only: motion_count_t, request_t
   use film_law, only: film_t, kernel_of
   use force, only: force_of_period
   use kinds, only: dp, int64
   use linear_newmark, only: linear_film, linear_method, two_pi, linear_problem
   use newmark, only: advance_period, start_motion, newmark_state_t
   use problem, only: problem_of, problem_t, static_load
   use scene_status, only: status_complete, status_film_lost, status_not_converged, status_overflow
   use scene_types, only: law_iso_viscous, law_piezo_viscous
   implicit none(type, external)
   private

   public :: run_newmark_cuts_tests

contains

   !> Runs every test of this topic.
   subroutine run_newmark_cuts_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('newmark')
      call test_cuts(checks)
      call test_nested_cut(checks)
      call test_second_half_cut(checks)
      call test_ends(checks)
   end subroutine run_newmark_cuts_tests

   !> A fall so fast that the first iterate of a step lies below the flank: the step is cut, rejoins the grid,
   !> and the motion is that of fine steps, to the order of the method.
   subroutine test_cuts(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: fall = -0.08_dp
      real(dp) :: coarse(64), middle(96), fine(4096), finest(8192), error(2)
      type(motion_count_t) :: count

      call fall_through_a_period(fall, .true., coarse, count)
      call checks%check(count%cuts > 0, 'cuts: the step was cut')
      call checks%check(count%steps == 64, 'cuts: the samples stay on the grid')
      call checks%check(all(coarse > 0.0_dp), 'cuts: the film stays positive')
      call fall_through_a_period(fall, .true., fine, count)
      call checks%check(count%cuts == 0, 'cuts: none with fine steps')
      call fall_through_a_period(fall, .true., finest, count)
      error(1) = maxval(abs(coarse(8:) - finest(1024::128))/finest(1024::128))
      error(2) = maxval(abs(fine(512::64) - finest(1024::128))/finest(1024::128))
      ! Behind the landing 64 steps a period leave some per cent; against that the fine motion is exact.
      call checks%check_close(error(1), 0.0_dp, 0.05_dp, 'cuts: the motion after the landing')
      call checks%check_close(error(2), 0.0_dp, 0.001_dp, 'cuts: the fine motion has converged')
      ! The successive iteration converges in few such falls: a step that needs a cut is nearly too long.
      call fall_through_a_period(-0.07_dp, .false., middle, count)
      call checks%check(count%cuts > 0 .and. all(middle > 0.0_dp), &
         'cuts: successive iteration is cut as well')
   end subroutine test_cuts

   !> A first step of three radians of a free oscillation, cut in half and its first half cut again: the state
   !> at its end is that of two quarters and a half, with the forces of their ends.
   subroutine test_nested_cut(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: steps = 8
      real(dp), parameter :: angular = 3.0_dp*600.0_dp*real(steps, dp), rest = 1.0e-5_dp, amplitude = 124.0_dp
      type(request_t) :: method
      type(problem_t) :: problem
      type(newmark_state_t) :: start, state
      type(motion_count_t) :: count, cut_count
      real(dp), dimension(4*steps) :: force, films, velocities, accelerations
      real(dp) :: cut_film, cut_velocity, cut_acceleration
      integer :: done, status

      method = linear_method()
      problem = falling_film(angular, rest, amplitude)
      problem%initial_film = rest
      problem%initial_velocity = -0.9_dp*rest*angular
      call start_motion(linear_film, problem, start, count, status)

      state = start
      call force_of_period(problem%force, force(:steps))
      call advance_period(linear_film, problem, method, force(:steps), state, cut_count, films(:steps), &
         velocities(:steps), &
         accelerations(:steps), done, status)
      call checks%check(done >= 1 .and. cut_count%cuts >= 2, 'nested cut: the first step was cut')
      cut_film = films(1)
      cut_velocity = velocities(1)
      cut_acceleration = accelerations(1)

      state = start
      call force_of_period(problem%force, force)
      count = motion_count_t()
      call advance_period(linear_film, problem, method, force, state, count, films, velocities, accelerations, &
         done, status)
      call checks%check(done >= 2 .and. count%cuts == 0, 'nested cut: quarters need no cut')
      state = newmark_state_t(films(2), velocities(2), accelerations(2))
      force(1) = problem%force%steady + amplitude*cos(two_pi/real(steps, dp))
      call advance_period(linear_film, problem, method, force(:2*steps), state, count, films(:2*steps), &
         velocities(:2*steps), accelerations(:2*steps), done, status)
      call checks%check_close(cut_film/films(1), 1.0_dp, 1.0e-12_dp, 'nested cut: film')
      call checks%check_close(cut_velocity/velocities(1), 1.0_dp, 1.0e-12_dp, 'nested cut: velocity')
      call checks%check_close(cut_acceleration/accelerations(1), 1.0_dp, 1.0e-12_dp, &
         'nested cut: acceleration')
   end subroutine test_nested_cut

   !> A first step of three radians of a free oscillation, cut in half, and then its second half cut again: the state at its
   !> end is that of a half and two quarters, with the forces of their ends.
   subroutine test_second_half_cut(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: steps = 8
      real(dp), parameter :: angular = 3.0_dp*600.0_dp*real(steps, dp), rest = 1.0e-5_dp, amplitude = 124.0_dp
      type(request_t) :: method
      type(problem_t) :: problem
      type(newmark_state_t) :: cut, whole
      type(motion_count_t) :: count
      integer :: status

      method = linear_method()
      problem = falling_film(angular, rest, amplitude)
      problem%initial_film = 1.8_dp*rest
      call start_motion(linear_film, problem, whole, count, status)
      cut = whole
      call take_step(1, 1.0_dp, cut)
      call take_step(2, 0.5_dp, whole)
      call take_step(4, 0.75_dp, whole)
      call take_step(4, 1.0_dp, whole)
      call checks%check_close(cut%film/whole%film, 1.0_dp, 1.0e-12_dp, 'second half cut: film')
      call checks%check_close(cut%velocity/whole%velocity, 1.0_dp, 1.0e-12_dp, 'second half cut: velocity')
      call checks%check_close(cut%acceleration/whole%acceleration, 1.0_dp, 1.0e-12_dp, 'second half cut: acceleration')

   contains

      !> A step of a part of 1/8 period, which only as a whole needs cuts.
      subroutine take_step(parts, share, state)
         integer, intent(in) :: parts                  !> Of 1/8 period
         real(dp), intent(in) :: share                 !> Of 1/8 period at its end
         type(newmark_state_t), intent(inout) :: state

         real(dp), dimension(parts*steps) :: force, films, velocities, accelerations
         integer :: done

         force = problem%force%steady + amplitude*cos(two_pi*share/real(steps, dp))
         ! Later steps of the period do not matter.
         call advance_period(linear_film, problem, method, force, state, count, films, velocities, accelerations, done, status)
         call checks%check(done >= 1, 'second half cut: the step was taken')
         state = newmark_state_t(films(1), velocities(1), accelerations(1))
      end subroutine take_step

   end subroutine test_second_half_cut

   !> The load of the linear film on a stiff one without damping.
   function falling_film(angular, rest, amplitude) result(problem)
      real(dp), intent(in) :: angular    !> Natural angular frequency [1/s]
      real(dp), intent(in) :: rest       !> Film at rest [m]
      real(dp), intent(in) :: amplitude  !> F0 [N]
      type(problem_t) :: problem

      problem = linear_problem()
      problem%force%cosine = amplitude
      problem%contact%film = film_t(piezo=problem%mass*angular**2)
      problem%contact%film%rolling = problem%contact%film%piezo*rest + static_load(problem)
   end function falling_film

   !> One period of the canonical idle scene from its steady film with a given velocity.
   subroutine fall_through_a_period(fall, by_newton, films, count)
      real(dp), intent(in) :: fall                !> Velocity at t = 0 [m/s]
      logical, intent(in) :: by_newton            !> Iteration
      real(dp), contiguous, intent(out) :: films(:)  !> h at the end of every step [m]
      type(motion_count_t), intent(out) :: count  !> Cost

      type(request_t) :: method
      type(problem_t) :: problem
      type(newmark_state_t) :: state
      real(dp), dimension(size(films)) :: force, velocities, accelerations
      integer :: done, status

      problem = problem_of(canonical_scene(law_iso_viscous, size(films)))
      problem%initial_film = idle_steady_film
      problem%initial_velocity = fall
      method = canonical_method()
      method%by_newton = by_newton
      call force_of_period(problem%force, force)
      call start_motion(kernel_of(problem%contact%film), problem, state, count, status)
      films = -1.0_dp
      call advance_period(kernel_of(problem%contact%film), problem, method, force, state, count, films, velocities, &
         accelerations, done, status)
   end subroutine fall_through_a_period

   !> Every way in which a motion can fail.
   subroutine test_ends(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: steps = 64
      type(request_t) :: method
      type(problem_t) :: problem
      type(newmark_state_t) :: state, before
      type(motion_count_t) :: count
      real(dp), dimension(steps) :: force, films, velocities, accelerations
      integer :: done, status

      ! One pass cannot see that it has converged.
      method = canonical_method()
      method%iteration_limit = 1
      problem = problem_of(canonical_scene(law_iso_viscous, steps))
      problem%initial_film = idle_steady_film
      call force_of_period(problem%force, force)
      call start_motion(kernel_of(problem%contact%film), problem, state, count, status)
      before = state
      call advance_period(kernel_of(problem%contact%film), problem, method, force, state, count, films, velocities, &
         accelerations, done, status)
      call checks%check(status == status_not_converged, 'iteration limit: status')
      call checks%check(done == 0 .and. count%steps == 0 .and. count%cuts == 0, &
         'iteration limit: no step, no cut')
      call checks%check(count%evaluations == 2, 'iteration limit: evaluations counted')
      call checks%check(abs(state%film - before%film) <= 0.0_dp, &
         'iteration limit: the state is that before the step')

      ! The successive iteration diverges where the film is too stiff for the step.
      method = canonical_method()
      method%by_newton = .false.
      method%iteration_limit = 50
      problem = problem_of(canonical_scene(law_piezo_viscous, 8))
      problem%initial_film = 1.0e-6_dp
      call start_motion(kernel_of(problem%contact%film), problem, state, count, status)
      call force_of_period(problem%force, force(:8))
      call advance_period(kernel_of(problem%contact%film), problem, method, force(:8), state, count, films(:8), velocities(:8), &
         accelerations(:8), &
         done, status)
      call checks%check(status /= status_complete .or. count%cuts > 0, 'a diverging step is not passed over')

      ! exp(703*2/1.905) is no load.
      problem%initial_velocity = -2.0_dp
      call start_motion(kernel_of(problem%contact%film), problem, state, count, status)
      call checks%check(status == status_overflow, 'overflow at the start: status')

      ! Nothing stops a fall in a film that carries nothing.
      method = linear_method()
      problem = linear_problem()
      problem%contact%film = film_t()
      problem%initial_film = 1.0e-6_dp
      problem%initial_velocity = -1.0e-3_dp
      call force_of_period(problem%force, force)
      call start_motion(linear_film, problem, state, count, status)
      call advance_period(linear_film, problem, method, force, state, count, films, velocities, accelerations, &
         done, status)
      call checks%check(status == status_film_lost, 'no load: film lost')
      call checks%check(done < steps .and. int(count%steps) == done, 'no load: steps before the loss')
      call checks%check(state%film > 0.0_dp, 'no load: the last film is positive')
      if (done > 0) call checks%check(abs(films(done) - state%film) <= 0.0_dp, &
         'no load: state of the last step')
      call checks%check(count%cuts >= 30_int64, 'no load: cut down to the shortest step')
   end subroutine test_ends

end module test_newmark_cuts
