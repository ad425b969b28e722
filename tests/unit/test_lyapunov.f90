!> Tests of how neighbouring motions part: what made growths say, a motion that repeats, and one that is known to be chaotic.
module test_lyapunov
   use canonical_scenes, only: canonical_scene
   use checks, only: check_list_t
   use engine, only: ending_t, request_t, start_of
   use irregular_statistics, only: is_enough
   use kinds, only: dp
   use lyapunov, only: draws_near, follow_neighbours, followed_periods, parting_of, parting_t, path_t
   use many_motions, only: solve_motions
   use neighbouring_motions, only: beside_neighbours, neighbouring_motions_t
   use periodic_orbit, only: find_periodic_orbit, periodic_orbit_t
   use problem, only: problem_of, problem_t
   use scene_types, only: law_iso_viscous, scene_t
   implicit none(type, external)
   private

   public :: run_lyapunov_tests

contains

   !> Runs every test of this topic.
   subroutine run_lyapunov_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('lyapunov')
      call test_growths(checks)
      call test_repeating(checks)
   end subroutine run_lyapunov_tests

   !> Blocks of 5 periods show the error; halves and the last quarter have to grow, and all periods have to be there.
   subroutine test_growths(checks)
      type(check_list_t), intent(inout) :: checks

      real(dp) :: growths(followed_periods)
      type(parting_t) :: parting
      integer :: i

      call checks%check(followed_periods >= 100, 'a hundred periods')
      growths = [(merge(0.6_dp, 0.2_dp, mod(i - 1, 10) < 5), i=1, followed_periods)]
      parting = parting_of(growths)
      call checks%check(parting%for_good .and. parting%periods == followed_periods, 'growth for good')
      call checks%check_close(parting%exponent, 0.4_dp, 1.0e-14_dp, 'its mean')
      ! Twenty blocks 0.2 off their mean: 0.2/sqrt(19).
      call checks%check_close(parting%standard_error, 0.2_dp/sqrt(19.0_dp), 1.0e-14_dp, 'its standard error')
      parting = parting_of(growths(:50))
      call checks%check(.not. (parting%for_good .or. draws_near(parting)), 'too few periods')
      parting = parting_of(-growths)
      call checks%check(draws_near(parting) .and. .not. parting%for_good, 'drawing near')
      growths = [(merge(-3.5_dp, 4.0_dp, mod(i - 1, 10) < 5), i=1, followed_periods)]
      parting = parting_of(growths)
      call checks%check(parting%exponent > 0.0_dp .and. .not. (parting%for_good .or. draws_near(parting)), &
                        'positive within two standard errors')
      growths = 1.0_dp
      growths(76:) = -0.2_dp
      call checks%check(.not. parting_of_is_for_good(growths), 'settled in the last quarter')
      growths = 1.0_dp
      growths(:50) = -0.01_dp
      call checks%check(.not. parting_of_is_for_good(growths), 'no growth in the first half')
   end subroutine test_growths

   !> Whether growths count as growth for good.
   logical function parting_of_is_for_good(growths)
      real(dp), intent(in) :: growths(:)   !> Logarithms of the growth in each period
      type(parting_t) :: parting

      parting = parting_of(growths)
      parting_of_is_for_good = parting%for_good
   end function parting_of_is_for_good

   !> A motion that repeats: the exponent is the logarithm of its largest Floquet multiplier, found by the period map.
   subroutine test_repeating(checks)
      type(check_list_t), intent(inout) :: checks

      type(scene_t) :: scene
      type(problem_t) :: problem
      type(ending_t) :: endings(1)
      type(parting_t) :: partings(1)
      type(path_t) :: paths(1)
      type(neighbouring_motions_t) :: followed
      type(periodic_orbit_t) :: orbit
      real(dp) :: none(0, 2, 1)

      scene = canonical_scene(law_iso_viscous, 512)
      scene%excitation%force_amplitude = 60.0_dp
      scene%kinematics%entrainment_speed = 15.0_dp
      problem = problem_of(scene)
      call solve_motions([problem], [start_of(problem)], request_t(accuracy=1.0e-10_dp, periods=200), none, endings)
      orbit = find_periodic_orbit(problem, endings(1)%numbers, 1.0e-3_dp)
      call checks%check(orbit%period == 1, 'the motion repeats')
      if (orbit%period /= 1) return
      followed = beside_neighbours([problem], [endings(1)%motion_state_t])
      call follow_neighbours(followed, is_enough, partings, paths)
      call checks%check(partings(1)%periods > 0 .and. draws_near(partings(1)), 'neighbours of a motion that repeats draw near')
      ! A pair of complex multipliers turns the difference, whose size swings about the mean: a share of one turn in 25 periods.
      call checks%check_close(partings(1)%exponent, log(abs(orbit%multipliers(1))), 0.1_dp*abs(log(abs(orbit%multipliers(1)))), &
                              'its exponent')
   end subroutine test_repeating

end module test_lyapunov
