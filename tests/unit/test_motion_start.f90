!> Tests of the starts that all motions of a problem are looked for from, and of what makes two motions the same.
module test_motion_start
   use canonical_scenes, only: canonical_scene, loose_gear
   use checks, only: check_list_t
   use engine, only: motion_state_t, state_of_start
   use kinds, only: dp
   use known_motions, only: known_of, reached_motion, same_motion, same_state, settled_motion_t
   use motion_start, only: characteristic_velocity, chosen_starts, gap_of_starts, motion_start_t, motion_starts, &
      one_by_damping, one_by_newmark, one_start_reason, one_without_swing, several_starts
   use problem, only: film_at_rest, of_film, of_velocity, problem_of, problem_t, static_load
   use scene_types, only: law_iso_viscous, method_newmark, method_taylor, scene_t
   implicit none(type, external)
   private

   public :: run_motion_start_tests

contains

   !> Runs every test of this topic.
   subroutine run_motion_start_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('motion_start')
      call test_characteristic_velocity(checks)
      call test_starts(checks)
      call test_drawn(checks)
      call test_one_flank(checks)
      call test_one_start(checks)
      call test_same_motion(checks)
      call test_reached_motion(checks)
   end subroutine run_motion_start_tests

   !> v* of three orders, by hand: each order counts by its amplitude over its own circular frequency, whatever its phase.
   subroutine test_characteristic_velocity(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(problem_t) :: problem
      real(dp), parameter :: two_pi = 2.0_dp*acos(-1.0_dp)
      real(dp) :: expected

      problem = problem_of(loose_gear())
      expected = (7.9_dp + 2.0_dp/2.0_dp + 0.8_dp/3.0_dp)/(problem%mass*two_pi*problem%frequency)
      call checks%check_close(characteristic_velocity(problem)/expected, 1.0_dp, 1.0e-14_dp, 'v* of three orders')
      call checks%check_close(gap_of_starts(problem)/problem%backlash, 1.0_dp, 0.0_dp, 'the gap is the backlash')
   end subroutine test_characteristic_velocity

   !> The first starts: the own one, the rest under the opposite load, and the middle of the gap at -4 v*. Fewer starts are the
   !> first ones of more.
   subroutine test_starts(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(motion_start_t) :: starts(29), few(3)
      type(motion_state_t) :: state
      type(problem_t) :: problem

      problem = problem_of(loose_gear())
      starts = motion_starts(problem, 29, 1)
      few = motion_starts(problem, 3, 1)
      call checks%check(all(starts(:3)%name == ['rest  ', 'coast ', 'middle']) .and. all(starts(4:)%name == 'random'), &
                        'starts: their order')
      call checks%check(.not. any(abs(few%film - starts(:3)%film) > 0.0_dp), 'starts: fewer are the first of more')
      call checks%check_close(starts(1)%film/film_at_rest(problem, static_load(problem)), 1.0_dp, 1.0e-14_dp, 'starts: rest')
      ! The same films with both flanks exchanged
      call checks%check_close((starts(2)%film + starts(1)%film)/problem%backlash, 1.0_dp, 1.0e-12_dp, 'starts: coast')
      call checks%check_close(starts(3)%film/problem%backlash, 0.5_dp, 1.0e-14_dp, 'starts: middle')
      call checks%check_close(starts(3)%velocity/characteristic_velocity(problem), -4.0_dp, 1.0e-14_dp, 'starts: -4 v*')
      problem%initial_velocity = 1.0e-3_dp
      few = motion_starts(problem, 3, 1)
      call checks%check(few(1)%name == 'given' .and. few(2)%name == 'coast', 'starts: one that is given is not called rest')
      call checks%check(all(abs([few(1)%film, few(1)%velocity] - [problem%initial_film, 1.0e-3_dp]) <= 0.0_dp), &
                        'starts: the given one is the first')
      state = state_of_start(problem, starts(3))
      call checks%check(all(abs(state%numbers([of_film, of_velocity]) - [starts(3)%film, starts(3)%velocity]) <= 0.0_dp), &
                        'starts: their states')
   end subroutine test_starts

   !> What is drawn fills the middle half of the gap and twice v* either way evenly, differs from seed to seed, and film and velocity
   !> are independent of each other.
   subroutine test_drawn(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      integer, parameter :: n = 4000
      type(motion_start_t) :: starts(n + chosen_starts), others(n + chosen_starts)
      real(dp) :: film(n), velocity(n)
      type(problem_t) :: problem
      !> Five standard errors of the mean of n even numbers between -1 and 1, and of their products
      real(dp), parameter :: five_errors = 5.0_dp/sqrt(3.0_dp*real(n, dp))

      problem = problem_of(loose_gear())
      starts = motion_starts(problem, size(starts), 1)
      others = motion_starts(problem, size(others), 2)
      film = 4.0_dp*(starts(chosen_starts + 1:)%film/problem%backlash - 0.5_dp)
      velocity = starts(chosen_starts + 1:)%velocity/(2.0_dp*characteristic_velocity(problem))
      call checks%check(maxval(abs(film)) < 1.0_dp .and. maxval(abs(velocity)) < 1.0_dp, 'drawn: within')
      call checks%check(max(maxval(-film), maxval(-velocity)) > 0.99_dp .and. min(maxval(film), maxval(velocity)) > 0.99_dp, &
                        'drawn: up to both ends')
      call checks%check_close(sum(film)/real(n, dp), 0.0_dp, five_errors, 'drawn: mean film')
      call checks%check_close(sum(velocity)/real(n, dp), 0.0_dp, five_errors, 'drawn: mean velocity')
      call checks%check_close(sum(film*velocity)/real(n, dp), 0.0_dp, five_errors, 'drawn: independent')
      call checks%check(count(abs(starts%film - others%film) > 0.0_dp) == n, 'drawn: by the seed')
   end subroutine test_drawn

   !> One flank has no coast: the gap is what the force moves a free mass by.
   subroutine test_one_flank(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(motion_start_t) :: starts(3)
      type(problem_t) :: problem
      real(dp) :: expected

      problem = problem_of(canonical_scene(law_iso_viscous, 512))
      expected = problem%initial_film + 2.0_dp*205.7_dp/(3.0_dp*(2.0_dp*acos(-1.0_dp)*600.0_dp)**2)
      call checks%check_close(gap_of_starts(problem)/expected, 1.0_dp, 1.0e-12_dp, 'one flank: its gap')
      starts = motion_starts(problem, 3, 1)
      call checks%check(starts(2)%name == 'far', 'one flank: no coast')
      call checks%check_close(starts(2)%film/expected, 1.0_dp, 1.0e-12_dp, 'one flank: the far end')
   end subroutine test_one_flank

   !> When one start is enough. The canonical scene of constant viscosity has a damping ratio of 0.61, on teeth of 1e8 N/m less.
   subroutine test_one_start(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(scene_t) :: scene

      scene = canonical_scene(law_iso_viscous, 512)
      call checks%check(one_start_reason(problem_of(scene), method_taylor) == one_by_damping, 'one start: damped')
      call checks%check(one_start_reason(problem_of(scene), method_newmark) == one_by_newmark, 'one start: the paper''s method')
      scene%contact%stiffness = 1.0e8_dp
      call checks%check(one_start_reason(problem_of(scene), method_taylor) == several_starts, 'several: hardly damped')
      scene = canonical_scene(law_iso_viscous, 512)
      scene%contact%backlash = 1.0e-5_dp
      call checks%check(one_start_reason(problem_of(scene), method_taylor) == several_starts, 'several: two flanks')
      scene%excitation%force_amplitude = 0.0_dp
      call checks%check(one_start_reason(problem_of(scene), method_taylor) == one_without_swing, 'one start: at rest')
   end subroutine test_one_start

   !> Two motions are the same in whichever period of theirs they are met, and up to the limits of each number.
   subroutine test_same_motion(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(settled_motion_t) :: one, other
      type(problem_t) :: problem
      real(dp) :: gap, speed

      problem = problem_of(loose_gear())
      gap = gap_of_starts(problem)
      speed = characteristic_velocity(problem)
      one = settled_motion_t(2, reshape([0.1_dp*gap, 0.2_dp*speed, 0.6_dp*gap, -0.3_dp*speed], [2, 2]), 10.0_dp)
      other = one
      call checks%check(same_motion(problem, one, other), 'same: itself')
      other%states = one%states(:, [2, 1])
      call checks%check(same_motion(problem, one, other), 'same: met a period later')
      other%states(1, 1) = other%states(1, 1) + 0.9_dp*same_state*gap
      call checks%check(same_motion(problem, one, other), 'same: within a hundredth of the gap')
      other%states(1, 1) = other%states(1, 1) + 0.2_dp*same_state*gap
      call checks%check(.not. same_motion(problem, one, other), 'another: by its film')
      other = one
      other%states(2, 2) = other%states(2, 2) + 1.1_dp*same_state*speed
      call checks%check(.not. same_motion(problem, one, other), 'another: by its velocity')
      other = one
      other%acceleration_rms = 10.6_dp
      call checks%check(.not. same_motion(problem, one, other), 'another: by its rms')
      other%rms_is_rough = .true.
      call checks%check(same_motion(problem, one, other), 'same: its rms is that of a part of its period')
      other%acceleration_rms = 14.0_dp
      call checks%check(.not. same_motion(problem, one, other), 'another: by its rough rms')
      other = settled_motion_t(1, one%states(:, :1), 10.0_dp)
      call checks%check(.not. same_motion(problem, one, other), 'another: by its period')
      ! Two periods whose states are a little more than a hundredth apart, met as one of a single period beyond one of them.
      one%states(:, 2) = one%states(:, 1) + [1.1_dp*same_state*gap, 0.0_dp]
      other%states(1, 1) = one%states(1, 2) + 0.8_dp*same_state*gap
      call checks%check(same_motion(problem, one, other) .and. same_motion(problem, other, one), 'same: next to a doubling')
      other%states(1, 1) = one%states(1, 2) + 1.1_dp*same_state*gap
      call checks%check(.not. same_motion(problem, one, other), 'another: next to a doubling')
      one = settled_motion_t(0, reshape([real(dp) ::], [2, 0]), 10.0_dp)
      call checks%check(.not. same_motion(problem, one, one), 'another: neither repeats')
   end subroutine test_same_motion

   !> A start has reached the one known motion that it is next to after two periods running, in the order of that motion.
   subroutine test_reached_motion(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(settled_motion_t) :: known(3)
      type(problem_t) :: problem
      real(dp) :: gap, speed, states(2, 2), near(2)

      problem = problem_of(loose_gear())
      gap = gap_of_starts(problem)
      speed = characteristic_velocity(problem)
      states = reshape([0.1_dp*gap, 0.2_dp*speed, 0.6_dp*gap, -0.3_dp*speed], [2, 2])
      near = 0.9_dp*same_state*[gap, speed]
      known(1) = settled_motion_t(0, states(:, :1), 10.0_dp)
      known(2) = settled_motion_t(2, states, 10.0_dp)
      known(3) = settled_motion_t(1, reshape([0.3_dp*gap, 0.0_dp], [2, 1]), 10.0_dp)
      call checks%check(reached(states(:, 1) + near, states(:, 2) - near) == 2, 'reached: next to it twice')
      call checks%check(reached(states(:, 2), states(:, 1)) == 2, 'reached: from its second period on')
      call checks%check(reached(states(:, 1), states(:, 1)) == 0, 'not reached: in another order')
      call checks%check(reached(states(:, 1), states(:, 2) + 1.2_dp*near) == 0, 'not reached: next to it once')
      known(3) = settled_motion_t(2, states + spread(near, 2, 2), 10.0_dp)
      call checks%check(reached(states(:, 1) - 0.5_dp*near, states(:, 2)) == 2, 'reached: far enough from the other')
      call checks%check(reached(states(:, 1) + 0.5_dp*near, states(:, 2)) == 0, 'not reached: next to two')

   contains

      integer function reached(older, newer)
         real(dp), intent(in) :: older(:)
         real(dp), intent(in) :: newer(:)

         reached = reached_motion(problem, known_of(problem, known), older, newer)
      end function reached

   end subroutine test_reached_motion

end module test_motion_start
