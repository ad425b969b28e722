!> Tests of scenes that are solved side by side: each has the windows, limits and classes that it has alone.
module test_scene_group
   use canonical_scenes, only: canonical_scene, loose_gear
   use checks, only: check_list_t, same_bits
   use engine, only: request_t, start_of
   use kinds, only: dp
   use node_extremes, only: seen_quantities
   use problem, only: state_size
   use classify_group, only: classify_windows
   use errors, only: error_t
   use prepared_scene, only: prepare, prepared_scene_t
   use scene_group, only: scene_group_t, solve_group
   use scene_types, only: law_iso_viscous, scene_t
   implicit none(type, external)
   private

   logical, parameter :: wants(seen_quantities) = .true.

   public :: run_scene_group_tests

contains

   !> Runs every test of this topic.
   subroutine run_scene_group_tests(checks)
      type(check_list_t), intent(inout) :: checks

      call checks%start('scene_group')
      call test_windows_of_unlike_length(checks)
      call test_more_numbers_a_state(checks)
   end subroutine run_scene_group_tests

   !> What is asked for: 16 samples a period are too few for idle rattle, so that its lines are integrals.
   pure function request_of(periods) result(request)
      integer, intent(in) :: periods
      type(request_t) :: request

      request = request_t(accuracy=1.0e-6_dp, periods=periods, samples_per_period=16, sampled_periods=16, &
                          until_steady=.true.)
   end function request_of

   !> Quiet motion, which 16 samples resolve; idle rattle, which repeats after one period; motion that repeats after two. The
   !> limits of each are its own.
   subroutine test_windows_of_unlike_length(checks)
      type(check_list_t), intent(inout) :: checks

      integer, parameter :: count = 3
      real(dp), parameter :: amplitudes(count) = [5.0_dp, 205.7_dp, 290.0_dp]
      real(dp), parameter :: speeds(count) = [1.905_dp, 1.905_dp, 12.0_dp]
      real(dp), parameter :: thresholds(count) = [0.3_dp, 0.01_dp, 0.02_dp]
      type(scene_t) :: scene
      type(prepared_scene_t) :: scenes(count)
      type(error_t), allocatable :: error
      type(scene_group_t) :: together, alone
      integer :: i

      do i = 1, count
         scene = canonical_scene(law_iso_viscous, 16)
         scene%excitation%force_amplitude = amplitudes(i)
         scene%kinematics%entrainment_speed = speeds(i)
         scene%spectrum%harmonic_threshold = thresholds(i)
         scenes(i) = prepare(scene)
         scenes(i)%request = request_of(400)
      end do
      associate (problems => scenes%resolved%problem)
         call solve_group(scenes, start_of(problems), wants, together)
         call classify_windows(scenes, together, error)
         call checks%check(all(together%endings%orbit == [1, 1, 2]), 'unlike windows: one period, one, two')
         call checks%check(all(together%endings%samples == 16*[1, 1, 2]), 'unlike windows: samples')
         call checks%check(together%verdicts(1)%spectrum%harmonic_count == 1, 'unlike windows: lines of quiet motion')
         call checks%check(together%verdicts(2)%spectrum%harmonic_count == 30, 'unlike windows: lines of idle rattle')
         do i = 1, count
            call solve_group(scenes(i:i), start_of(problems(i:i)), wants, alone)
            call classify_windows(scenes(i:i), alone, error)
            associate (mine => together%verdicts(i), own => alone%verdicts(1))
               call checks%check(mine%class == own%class .and. mine%spectrum%harmonic_count == own%spectrum%harmonic_count, &
                                 'unlike windows: class and lines as alone')
               call checks%check(size(mine%spectrum%harmonics) == size(own%spectrum%harmonics), 'unlike windows: harmonics alone')
               call checks%check(all(same_bits(mine%spectrum%harmonics, own%spectrum%harmonics)), 'unlike windows: the same bits')
               call checks%check(same_bits(mine%reversals_per_period, own%reversals_per_period) .and. &
                                 same_bits(mine%spectrum%irregular_fraction, own%spectrum%irregular_fraction), &
                                 'unlike windows: reversals and power off the harmonics')
            end associate
         end do
      end associate
   end subroutine test_windows_of_unlike_length

   !> Elastic teeth have more numbers a state than rigid ones, which were solved before in the same arrays.
   subroutine test_more_numbers_a_state(checks)
      type(check_list_t), intent(inout) :: checks

      type(scene_t) :: scene
      type(prepared_scene_t) :: rigid(1), elastic(1)
      type(scene_group_t) :: kept, fresh

      scene = loose_gear()
      rigid(1) = prepare(scene)
      scene%contact%stiffness = 2.8e8_dp
      elastic(1) = prepare(scene)
      rigid(1)%request = request_of(40)
      elastic(1)%request = request_of(40)
      call solve_group(rigid, start_of(rigid%resolved%problem), wants, kept)
      call solve_group(elastic, start_of(elastic%resolved%problem), wants, kept)
      call solve_group(elastic, start_of(elastic%resolved%problem), wants, fresh)
      call checks%check(size(kept%states, 2) == maxval(state_size(elastic%resolved%problem)), 'more numbers: room for all')
      if (any(shape(kept%states) /= shape(fresh%states))) return
      associate (n => fresh%endings(1)%samples)
         call checks%check(n > 0 .and. kept%endings(1)%samples == n, 'more numbers: samples')
         call checks%check(all(same_bits(kept%states(:n, :, 1), fresh%states(:n, :, 1))), 'more numbers: the same bits')
      end associate
   end subroutine test_more_numbers_a_state

end module test_scene_group
