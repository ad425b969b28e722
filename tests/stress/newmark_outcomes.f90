!> Newmark's method on given scenes with every iteration and predictor, over steps a period and eps: what
!> comes out, compared with the error-controlled engine.
!>
!>    newmark_outcomes INPUT ... > FILE.csv
!>
!> Outcomes: diverged (a status other than complete), wrong number of reversals, false harmonics (another class,
!> or another number of lines), wrong amplitudes (a line off by more than 5 % of the largest), right.
program newmark_outcomes
   use engine, only: motion_count_t, request_t, start_of
   use errors, only: error_t, fault_list_t
   use film_law, only: film_load
   use classify_group, only: classify_windows
   use force, only: force_of_period
   use kinds, only: dp
   use newmark, only: advance_period, start_motion, newmark_state_t
   use random_scenes, only: drawn_scene_t
   use rattle_class, only: classify, rattle_verdict_t
   use prepared_scene, only: resolve, prepare, prepared_scene_t
   use scene_reader, only: override_t, read_scenes
   use scene_types, only: scene_t
   use scene_status, only: is_success, status_complete
   use text, only: real_text
   use node_extremes, only: seen_quantities
   use scene_group, only: scene_group_t, solve_group
   implicit none(type, external)

   !> Octaves of steps a period, four values in each, from this one on; two values of eps a decade.
   integer, parameter :: octaves = 9, first_steps(4) = [8, 10, 12, 14], decades = 8
   real(dp), parameter :: smallest_eps = 1.0e-14_dp
   !> Periods solved, and window at their end.
   integer, parameter :: periods = 64, window = 16
   !> A line may be off by this share of the largest one.
   real(dp), parameter :: harmonic_share = 0.05_dp
   character(*), parameter :: iterations(2) = [character(10) :: 'newton', 'successive']
   character(*), parameter :: predictors(2) = [character(12) :: 'extrapolated', 'previous']

   type(drawn_scene_t) :: drawn
   type(rattle_verdict_t) :: reference
   type(fault_list_t) :: faults
   character(512) :: path
   character(19), allocatable :: outcome(:)
   real(dp), allocatable :: eps(:)
   type(scene_t), allocatable :: scenes(:)
   integer, allocatable :: steps(:)
   integer :: i, run, iteration, predictor

   steps = [((first_steps(run)*2**i, run=1, size(first_steps)), i=0, octaves - 1), 8*2**octaves]
   eps = [(smallest_eps*10.0_dp**(0.5_dp*real(i, dp)), i=0, 2*decades)]
   allocate (outcome(size(steps)*size(eps)))
   print '(a)', 'scene,iteration,predictor,steps,eps,outcome'
   do i = 1, command_argument_count()
      call get_command_argument(i, path)
      call read_scenes(trim(path), [override_t ::], scenes, faults)
      if (faults%count() > 0) error stop 'newmark_outcomes: an input has faults'
      drawn%scene = scenes(1)
      drawn%scene%spectrum%periods = window
      drawn%resolved = resolve(drawn%scene)
      call solve_reference(drawn, reference)
      do iteration = 1, size(iterations)
         do predictor = 1, size(predictors)
            ! The longest runs first, so that no thread is left with one at the end.
            !$omp parallel do schedule(dynamic)
            do run = size(outcome), 1, -1
               outcome(run) = outcome_of(steps(1 + (run - 1)/size(eps)), &
                                         eps(1 + modulo(run - 1, size(eps))), &
                                         iteration == 1, predictor == 1)
            end do
            !$omp end parallel do
            do run = 1, size(outcome)
               print '(a, i0, a)', trim(drawn%scene%name)//','//trim(iterations(iteration))//','// &
                  trim(predictors(predictor))//',', steps(1 + (run - 1)/size(eps)), ','// &
                  real_text(eps(1 + modulo(run - 1, size(eps))))//','//trim(outcome(run))
            end do
         end do
      end do
   end do

contains

   !> Verdict on the motion itself.
   subroutine solve_reference(drawn, verdict)
      !> The scene
      type(drawn_scene_t), intent(in) :: drawn
      !> Its verdict
      type(rattle_verdict_t), intent(out) :: verdict
      type(error_t), allocatable :: error
      type(prepared_scene_t) :: scenes(1)
      type(scene_group_t) :: group
      logical, parameter :: wants(seen_quantities) = .true.

      scenes(1) = prepare(drawn%scene)
      scenes%resolved = drawn%resolved
      scenes%request = request_t(accuracy=1.0e-11_dp, periods=periods, samples_per_period=512, sampled_periods=window)
      call solve_group(scenes, [start_of(drawn%resolved%problem)], wants, group)
      if (is_success(group%endings(1)%status)) call classify_windows(scenes, group, error)
      if (allocated(error) .or. .not. is_success(group%endings(1)%status)) error stop 'newmark_outcomes: a scene cannot be solved'
      verdict = group%verdicts(1)
   end subroutine solve_reference

   !> What comes out of one run.
   function outcome_of(steps, eps, by_newton, extrapolate) result(word)
      !> Steps a period
      integer, intent(in) :: steps
      !> eps of (36) [m]
      real(dp), intent(in) :: eps
      !> Newton's iteration, else the successive one
      logical, intent(in) :: by_newton
      !> First iterate extrapolated, else the previous state
      logical, intent(in) :: extrapolate
      character(19) :: word
      type(request_t) :: method
      type(newmark_state_t) :: state
      type(motion_count_t) :: count
      type(rattle_verdict_t) :: verdict
      real(dp) :: force(steps), films(steps), velocities(steps), accelerations(window*steps), unused(steps), &
         worst
      integer :: period, first, done, status, compared

      associate (problem => drawn%resolved%problem)
         method = request_t(tolerance=eps, iteration_limit=drawn%scene%solver%iteration_limit, by_newton=by_newton, &
                            extrapolate=extrapolate)
         call force_of_period(problem%force, force)
         call start_motion(film_load, problem, state, count, status)
         do period = 1, periods
            if (status /= status_complete) exit
            first = (period - 1 - periods + window)*steps
            if (first < 0) then
               call advance_period(film_load, problem, method, force, state, count, films, velocities, &
                                   unused, done, status)
            else
               call advance_period(film_load, problem, method, force, state, count, films, velocities, &
                                   accelerations(first + 1:first + steps), done, status)
            end if
         end do
      end associate
      word = 'diverged'
      if (status /= status_complete) return
      call classify(accelerations, drawn%scene%spectrum, drawn%resolved%noise_floor, verdict)
      associate (found => verdict%spectrum, right => reference%spectrum)
         compared = min(size(found%harmonics), size(right%harmonics))
         worst = maxval(abs(found%harmonics(:compared) - right%harmonics(:compared)))
         if (abs(verdict%reversals_per_period - reference%reversals_per_period) > 0.05_dp) then
            word = 'wrong reversals'
         else if (verdict%class /= reference%class .or. abs(found%harmonic_count - right%harmonic_count) > 1) then
            word = 'false harmonics'
         else if (worst > harmonic_share*maxval(right%harmonics)) then
            word = 'wrong amplitudes'
         else
            word = 'right'
         end if
      end associate
   end function outcome_of

end program newmark_outcomes
