!> Tests of Newmark's method on many scenes at once: against the scalar steps, in any company, and where a
!> step fails.
module test_newmark_lanes
   use canonical_scenes, only: canonical_scene
   use checks, only: check_list_t, same_bits
   use film_law, only: film_t, kernel_half_pi, load_half_pi, load_piezo, new_film
   use forcing, only: force_of_period
   use kinds, only: dp
   use newmark, only: advance_period, motion_count_t, motion_state_t, newmark_t, start_motion
   use newmark_lane_group, only: group_lanes
   use newmark_lanes, only: newmark_lane_ending_t, newmark_lane_request_t, newmark_lane_scene_t, &
      solve_newmark_lanes
   use scene_status, only: status_complete, status_film_lost, status_not_converged, status_overflow
   use scene_types, only: law_iso_viscous, law_piezo_viscous
   implicit none(type, external)
   private

   !> Samples and endings of a call.
   type :: motions_t
      real(dp), allocatable :: films(:, :), velocities(:, :), accelerations(:, :)
      type(newmark_lane_ending_t), allocatable :: endings(:)
   end type motions_t

   public :: run_newmark_lanes_tests

contains

   !> Runs every test of this topic.
   subroutine run_newmark_lanes_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('newmark_lanes')
      call test_against_scalar(checks)
      call test_company(checks)
      call test_samples(checks)
      call test_landing(checks)
      call test_passes(checks)
      call test_ends(checks)
   end subroutine run_newmark_lanes_tests

   !> A scene like the canonical one, with its own load and film.
   function scene_like(law, amplitude, velocity) result(scene)
      integer, intent(in) :: law          !> Film law
      real(dp), intent(in) :: amplitude   !> F0 [N]
      real(dp), intent(in) :: velocity    !> Film velocity at t = 0 [m/s]
      type(newmark_lane_scene_t) :: scene

      scene%film = new_film(canonical_scene(law, 64))
      scene%thickness = merge(8.889224234368e-7_dp, 1.000449736566e-6_dp, law == law_iso_viscous)
      scene%velocity = velocity
      scene%method%mass = 3.0_dp
      scene%method%weight = 3.0_dp*9.80665_dp
      scene%method%steady_force = 199.2_dp
      scene%method%force_amplitude = amplitude
      scene%method%frequency = 600.0_dp
      scene%method%tolerance = 1.0e-14_dp
      scene%method%iteration_limit = 50
   end function scene_like

   !> More scenes than a group has lanes, of both laws, from calm to violent.
   function many_scenes() result(scenes)
      type(newmark_lane_scene_t) :: scenes(group_lanes + 21)
      integer :: i

      do i = 1, size(scenes)
         scenes(i) = scene_like(merge(law_iso_viscous, law_piezo_viscous, mod(i/3, 2) == 0), &
            5.0_dp*real(i, dp), 1.0e-4_dp*real(mod(i, 5), dp))
         scenes(i)%method%frequency = 500.0_dp + 3.0_dp*real(i, dp)
      end do
   end function many_scenes

   !> Solve scenes and keep every sample.
   function motions_of(scenes, request) result(motions)
      type(newmark_lane_scene_t), intent(in) :: scenes(:)     !> The scenes
      type(newmark_lane_request_t), intent(in) :: request     !> What is asked for
      type(motions_t) :: motions
      integer :: samples

      samples = request%sampled_periods*request%samples_per_period
      allocate (motions%films(samples, size(scenes)), motions%velocities(samples, size(scenes)), &
         motions%accelerations(samples, size(scenes)), motions%endings(size(scenes)))
      motions%films = -1.0_dp
      motions%velocities = 0.0_dp
      motions%accelerations = 0.0_dp
      call solve_newmark_lanes(scenes, request, motions%films, motions%velocities, motions%accelerations, &
                               motions%endings)
   end function motions_of

   !> Every sample of three periods against the scalar steps.
   subroutine test_against_scalar(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: steps = 256, periods = 3
      type(newmark_lane_scene_t) :: scenes(8)
      type(motions_t) :: motions
      real(dp), dimension(steps) :: films, velocities, accelerations
      type(newmark_lane_ending_t) :: ending
      real(dp) :: errors(3), scales(3)
      integer :: i, period, first

      do i = 1, size(scenes)
         scenes(i) = scene_like(merge(law_iso_viscous, law_piezo_viscous, i <= 4), &
            60.0_dp*real(mod(i, 4) + 1, dp), 0.0_dp)
      end do
      motions = motions_of(scenes, newmark_lane_request_t(steps, periods, periods, steps))
      errors = 0.0_dp
      do i = 1, size(scenes)
         call checks%check(motions%endings(i)%status == status_complete .and. &
                           motions%endings(i)%periods == periods .and. &
                           motions%endings(i)%periods_alone == 0, 'scalar: every period in a lane')
         call start_alone(scenes(i), ending)
         do period = 1, periods
            call period_alone(scenes(i), ending, films, velocities, accelerations)
            first = (period - 1)*steps + 1
            scales = [minval(films), maxval(abs(velocities)), maxval(abs(accelerations))]
            errors = max(errors, [maxval(abs(motions%films(first:first + steps - 1, i) - films)), &
               maxval(abs(motions%velocities(first:first + steps - 1, i) - velocities)), &
               maxval(abs(motions%accelerations(first:first + steps - 1, i) - accelerations))]/max(scales, &
               tiny(scales)))
         end do
         call checks%check_close(motions%endings(i)%state%film, motions%films(steps*periods, i), 0.0_dp, &
                                 'scalar: last state')
         call checks%check(motions%endings(i)%count%steps == steps*periods, 'scalar: steps')
      end do
      ! The scalar step stops after one pass where its film moved by less than 1e-14 m, a hundred-millionth.
      call checks%check_close(errors(1), 0.0_dp, 2.0e-12_dp, 'scalar: films')
      call checks%check_close(errors(2), 0.0_dp, 1.0e-10_dp, 'scalar: velocities')
      call checks%check_close(errors(3), 0.0_dp, 1.0e-9_dp, 'scalar: accelerations')
   end subroutine test_against_scalar

   !> A scene has the same bits alone, in any lane, among any neighbours.
   subroutine test_company(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(newmark_lane_scene_t) :: scenes(group_lanes + 21)
      type(newmark_lane_request_t) :: request
      type(motions_t) :: together, reversed, alone
      integer :: i, same_alone, same_reversed

      request = newmark_lane_request_t(96, 3, 2, 8)
      scenes = many_scenes()
      ! One lane that fails disturbs nobody.
      scenes(7)%velocity = -0.08_dp
      together = motions_of(scenes, request)
      call checks%check(together%endings(7)%periods_alone > 0, 'company: a lane failed')
      call checks%check(any(together%endings%count%evaluations > 2*together%endings%count%steps + 1), &
                        'company: some lanes needed further passes')
      reversed = motions_of(scenes(size(scenes):1:-1), request)
      same_alone = 0
      same_reversed = 0
      do i = 1, size(scenes)
         alone = motions_of(scenes(i:i), request)
         if (same(together, i, alone, 1)) same_alone = same_alone + 1
         if (same(together, i, reversed, size(scenes) + 1 - i)) same_reversed = same_reversed + 1
      end do
      call checks%check(same_alone == size(scenes), 'company: the same bits alone')
      call checks%check(same_reversed == size(scenes), 'company: the same bits in other lanes')
   end subroutine test_company

   !> Whether two motions agree to the last bit.
   pure logical function same(some, i, others, j)
      type(motions_t), intent(in) :: some    !> Motions
      integer, intent(in) :: i               !> The one of them
      type(motions_t), intent(in) :: others  !> Other motions
      integer, intent(in) :: j               !> The one of them

      same = all(same_bits(some%films(:, i), others%films(:, j))) .and. &
         all(same_bits(some%velocities(:, i), others%velocities(:, j))) .and. &
         all(same_bits(some%accelerations(:, i), others%accelerations(:, j))) .and. &
         some%endings(i)%status == others%endings(j)%status .and. &
         some%endings(i)%periods_alone == others%endings(j)%periods_alone .and. &
         some%endings(i)%count%evaluations == others%endings(j)%count%evaluations
   end function same

   !> Fewer samples are some of the samples, whatever is sampled.
   subroutine test_samples(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(newmark_lane_scene_t) :: scenes(2)
      type(motions_t) :: every, some, none

      scenes = [scene_like(law_iso_viscous, 205.7_dp, 0.0_dp), &
         scene_like(law_piezo_viscous, 205.7_dp, 0.0_dp)]
      every = motions_of(scenes, newmark_lane_request_t(128, 4, 4, 128))
      some = motions_of(scenes, newmark_lane_request_t(128, 4, 2, 8))
      none = motions_of(scenes, newmark_lane_request_t(128, 4, 0, 1))
      call checks%check(all(abs(some%films - every%films(272::16, :)) <= 0.0_dp), &
                        'samples: every 16th of two periods')
      call checks%check(all(abs(some%velocities - every%velocities(272::16, :)) <= 0.0_dp), &
                        'samples: velocities')
      call checks%check(all(abs(some%accelerations - every%accelerations(272::16, :)) <= 0.0_dp), &
                        'samples: accelerations')
      call checks%check(all(abs(none%endings%state%film - every%films(512, :)) <= 0.0_dp), 'samples: none')
   end subroutine test_samples

   !> A fall so fast that steps must be cut: that period is the scalar one.
   subroutine test_landing(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: steps = 64
      type(newmark_lane_scene_t) :: scene
      type(newmark_lane_ending_t) :: ending
      type(motions_t) :: motions
      real(dp), dimension(steps) :: films, velocities, accelerations

      scene = scene_like(law_iso_viscous, 205.7_dp, -0.08_dp)
      motions = motions_of([scene], newmark_lane_request_t(steps, 3, 3, steps))
      call start_alone(scene, ending)
      call period_alone(scene, ending, films, velocities, accelerations)
      associate (got => motions%endings(1))
         call checks%check(got%status == status_complete .and. got%periods == 3, 'landing: status')
         call checks%check(got%periods_alone >= 1 .and. got%count%cuts > 0 .and. &
                           got%count%cuts == ending%count%cuts, 'landing: cut as in the scalar steps')
      end associate
      ! Rounding differs where the compiler joins the film to the step; the landing enlarges it.
      call checks%check_close(maxval(abs(motions%films(:steps, 1)/films - 1.0_dp)), 0.0_dp, 1.0e-11_dp, &
                              'landing: films')
      call checks%check_close(maxval(abs(motions%velocities(:steps, 1) - &
                              velocities))/maxval(abs(velocities)), 0.0_dp, 1.0e-11_dp, 'landing: velocities')
      call checks%check_close(maxval(abs(motions%accelerations(:steps, 1) - &
                              accelerations))/maxval(abs(accelerations)), 0.0_dp, 1.0e-11_dp, &
                              'landing: accelerations')
   end subroutine test_landing

   !> The limit of passes holds, and a scene that two passes do not settle gets more.
   subroutine test_passes(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(newmark_lane_scene_t) :: scenes(2)
      type(motions_t) :: motions
      integer :: law

      do law = law_iso_viscous, law_piezo_viscous
         scenes = scene_like(law, 300.0_dp, 0.0_dp)
         scenes%method%tolerance = 1.0e-18_dp
         scenes(2)%method%iteration_limit = 2
         motions = motions_of(scenes, newmark_lane_request_t(256, 2, 1, 1))
         call checks%check(motions%endings(1)%status == status_complete .and. &
                           motions%endings(1)%periods_alone == 0, 'passes: settled in the lane')
         call checks%check(motions%endings(1)%count%evaluations > 2*512 + 1, 'passes: more than two')
         call checks%check(motions%endings(2)%status == status_not_converged, 'passes: limit')
      end do
   end subroutine test_passes

   !> Every way in which a scene can fail, beside one that does not.
   subroutine test_ends(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(newmark_lane_scene_t) :: scenes(4)
      type(motions_t) :: motions

      scenes(1) = scene_like(law_iso_viscous, 205.7_dp, 0.0_dp)
      ! Nothing stops a fall in a film that carries nothing.
      scenes(2) = scenes(1)
      scenes(2)%film = film_t(kernel=kernel_half_pi)
      ! exp(703*2/1.905) is no load.
      scenes(3) = scene_like(law_piezo_viscous, 205.7_dp, -2.0_dp)
      ! No lane for the successive iteration.
      scenes(4) = scenes(1)
      scenes(4)%method%by_newton = .false.
      motions = motions_of(scenes, newmark_lane_request_t(256, 2, 2, 16))
      call checks%check(motions%endings(1)%status == status_complete, 'ends: the neighbour')
      call checks%check(motions%endings(2)%status == status_film_lost .and. motions%endings(2)%periods == 0, &
                        'ends: film lost')
      call checks%check(all(motions%films(:, 3) < 0.0_dp), 'ends: no samples without a motion')
      call checks%check(motions%endings(3)%status == status_overflow .and. motions%endings(3)%periods == 0, &
                        'ends: overflow')
      call checks%check(motions%endings(4)%status == status_complete .and. &
                        motions%endings(4)%periods_alone == 2, 'ends: successive iteration alone')
      call checks%check_close(maxval(abs(motions%films(:, 4)/motions%films(:, 1) - 1.0_dp)), 0.0_dp, &
                              1.0e-5_dp, 'ends: the same motion by successive iteration')
   end subroutine test_ends

   !> Start of a scene by the scalar steps.
   subroutine start_alone(scene, ending)
      type(newmark_lane_scene_t), intent(in) :: scene      !> The scene
      type(newmark_lane_ending_t), intent(out) :: ending   !> Its start

      if (scene%film%kernel == kernel_half_pi) then
         call start_motion(load_half_pi, scene%film, scene%method, scene%thickness, scene%velocity, &
                           ending%state, ending%count, ending%status)
      else
         call start_motion(load_piezo, scene%film, scene%method, scene%thickness, scene%velocity, &
                           ending%state, ending%count, ending%status)
      end if
   end subroutine start_alone

   !> Next period of a scene by the scalar steps.
   subroutine period_alone(scene, ending, films, velocities, accelerations)
      type(newmark_lane_scene_t), intent(in) :: scene            !> The scene
      type(newmark_lane_ending_t), intent(inout) :: ending       !> Its motion so far
      real(dp), contiguous, intent(out) :: films(:)              !> h [m]
      real(dp), contiguous, intent(out) :: velocities(:)         !> z' [m/s]
      real(dp), contiguous, intent(out) :: accelerations(:)      !> z'' [m/s2]
      real(dp) :: force(size(films))
      integer :: done

      call force_of_period(scene%method%steady_force, scene%method%force_amplitude, force)
      if (scene%film%kernel == kernel_half_pi) then
         call advance_period(load_half_pi, scene%film, scene%method, force, ending%state, ending%count, &
                             films, velocities, accelerations, done, ending%status)
      else
         call advance_period(load_piezo, scene%film, scene%method, force, ending%state, ending%count, films, &
                             velocities, accelerations, done, ending%status)
      end if
   end subroutine period_alone

end module test_newmark_lanes
