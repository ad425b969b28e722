!> Tests of motions that take many periods of the force to settle: they are found steady only where they are within the accuracy
!> of the motion that repeats, which a long run shows.
module test_slow_motions
   use canonical_scenes, only: canonical_scene
   use checks, only: check_list_t
   use engine, only: ending_t, request_t, start_of
   use film_law, only: film_load, film_t, new_film, steady_film
   use kinds, only: dp
   use lane_block, only: lane_accuracy
   use many_motions, only: solve_motions
   use problem, only: of_film, problem_of, problem_t
   use scene_status, only: status_complete, status_steady
   use scene_types, only: law_iso_viscous, law_piezo_viscous, model_published, model_reynolds, rupture_half_pi, rupture_solved, &
                          scene_t
   implicit none(type, external)
   private

   public :: run_slow_motions_tests

contains

   !> Runs every test of this topic.
   subroutine run_slow_motions_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('slow_motions')
      call test_creeping_scenes(checks)
      call test_films(checks)
      call test_accuracy(checks)
   end subroutine run_slow_motions_tests

   !> Two scenes of a published piezo-viscous film that move less than the accuracy in a period and have 3 % and 2e-4 of the film
   !> to go.
   subroutine test_creeping_scenes(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(scene_t) :: scene

      scene = canonical_scene(law_piezo_viscous, 512)
      scene%contact%radius = 0.01_dp
      scene%lubricant%viscosity = 0.1_dp
      scene%kinematics%entrainment_speed = 0.40697359310498676_dp
      scene%excitation%mass = 0.0053950761602586375_dp
      scene%excitation%steady_force = 99.94709237637299_dp
      scene%excitation%force_amplitude = 90.26714103778565_dp
      scene%excitation%frequency = 67471871.51652412_dp
      call check_steady(scene, 0.012489684314513562_dp, 1.0e-4_dp, 45000, .true., 'creeping, large force', checks)
      scene%kinematics%entrainment_speed = 0.3421500519277709_dp
      scene%excitation%mass = 0.02161460902130761_dp
      scene%excitation%steady_force = 99.78803309444119_dp
      scene%excitation%force_amplitude = 3.531398262729351_dp
      scene%excitation%frequency = 16587384.93909263_dp
      call check_steady(scene, 0.0002145920046477532_dp, 1.0e-6_dp, 16000, .true., 'creeping, small force', checks)
   end subroutine test_creeping_scenes

   !> Films of all laws that creep or swing, with multipliers of about 0.99 and 0.999.
   subroutine test_films(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      real(dp), parameter :: ratios(4) = [20.0_dp, 3.0_dp, 1.02_dp, 0.05_dp]
      type(scene_t) :: scene
      integer :: law, i

      do law = 1, 5
         do i = 1, size(ratios)
            scene = slow_scene(law, ratios(i), merge(0.01_dp, 0.05_dp, ratios(i) > 1.0_dp))
            call check_steady(scene, 0.0_dp, 1.0e-6_dp, 5000, i == 1 .and. law == 1, 'slow films', checks)
         end do
      end do
   end subroutine test_films

   !> A slow film is solved to an accuracy that its errors may add up to, and any other to the accuracy asked for.
   subroutine test_accuracy(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      integer :: law

      do law = 1, 5
         call expect(slow_scene(law, 20.0_dp, 0.003_dp), 1.0e-6_dp, 3.0e-9_dp, 'creeping')
         call expect(slow_scene(law, 0.1_dp, 0.05_dp), 1.0e-6_dp, 5.0e-8_dp, 'swinging')
         call expect(slow_scene(law, 20.0_dp, 1.1_dp), 1.0e-6_dp, 1.0e-6_dp, 'settles at once')
      end do
      call expect(slow_scene(1, 20.0_dp, 0.003_dp), 1.0e-12_dp, 1.0e-13_dp, 'no better than rounding')

   contains

      !> The accuracy of a scene.
      subroutine expect(scene, asked, expected, name)
         type(scene_t), intent(in) :: scene     !> The scene
         real(dp), intent(in) :: asked          !> Accuracy asked for [-]
         real(dp), intent(in) :: expected       !> That of its periods [-]
         character(*), intent(in) :: name       !> Of the case

         call checks%check_close(lane_accuracy(lane_of(scene, 0.0_dp), asked)/expected, 1.0_dp, 1.0e-9_dp, 'accuracy: '//name)
      end subroutine expect

   end subroutine test_accuracy

   !> Scene of a film law with a damping ratio and a rate of settling, by its mass and frequency [1/periods].
   function slow_scene(law, damping_ratio, rate) result(scene)
      integer, intent(in) :: law                !> Published, half-pi and solved; piezo; exact, iso and piezo
      real(dp), intent(in) :: damping_ratio     !> c/(2 sqrt(k m)) [-]
      real(dp), intent(in) :: rate              !> Of the slow direction, or the natural circular frequency [1/periods]
      type(scene_t) :: scene
      type(film_t) :: film
      real(dp) :: load, load_by_film, load_by_velocity, natural

      scene = canonical_scene(merge(law_iso_viscous, law_piezo_viscous, any(law == [1, 2, 4])), 512)
      scene%film%model = merge(model_published, model_reynolds, law <= 3)
      scene%film%rupture = merge(rupture_half_pi, rupture_solved, law /= 2)
      scene%lubricant%pressure_viscosity = 1.0e-9_dp
      scene%excitation%gravity = 0.0_dp
      film = new_film(scene)
      call film_load(film, steady_film(film, scene%excitation%static_load()), 0.0_dp, load, load_by_film, load_by_velocity)
      scene%excitation%mass = (0.5_dp*load_by_velocity/damping_ratio)**2/(-load_by_film)
      natural = sqrt(-load_by_film/scene%excitation%mass)
      scene%excitation%frequency = natural/rate
      if (damping_ratio > 1.0_dp) scene%excitation%frequency = natural/rate/(damping_ratio + sqrt(damping_ratio**2 - 1.0_dp))
      scene%excitation%force_amplitude = 0.8_dp*scene%excitation%steady_force
   end function slow_scene

   !> Lane of a scene, from its steady film.
   function lane_of(scene, velocity) result(lane)
      type(scene_t), intent(in) :: scene        !> The scene
      real(dp), intent(in) :: velocity          !> z' at t = 0 [m/s]
      type(problem_t) :: lane

      lane = problem_of(scene)
      lane%initial_velocity = velocity
   end function lane_of

   !> A scene is found steady, within the accuracy of where a long run ends.
   subroutine check_steady(scene, velocity, accuracy, periods, creeps, name, checks)
      type(scene_t), intent(in) :: scene           !> The scene
      real(dp), intent(in) :: velocity             !> z' at t = 0 [m/s]
      real(dp), intent(in) :: accuracy             !> Relative accuracy of the film [-]
      integer, intent(in) :: periods               !> After which it is where it will stay
      logical, intent(in) :: creeps                !> Whether it creeps in one direction alone
      character(*), intent(in) :: name             !> Of the scene
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(problem_t) :: lane
      type(ending_t) :: steady(1), long(1)
      real(dp) :: none(0, 2, 1), film, away

      none = 0.0_dp
      lane = lane_of(scene, velocity)
      call solve_motions([lane], [start_of(lane)], request_t(accuracy=accuracy, periods=periods, until_steady=.true.), none, &
                         steady)
      call solve_motions([lane], [start_of(lane)], request_t(accuracy=0.01_dp*accuracy, periods=periods), none, long)
      call checks%check(steady(1)%status == status_steady .and. long(1)%status == status_complete, name//': found steady')
      call checks%check(steady(1)%orbit == 1 .and. steady(1)%distance <= accuracy, name//': its bound')
      call checks%check_close(steady(1)%numbers(of_film)/long(1)%numbers(of_film), 1.0_dp, accuracy, &
                              name//': where a long run ends')
      ! The bound counts in H/(1 + H**2); of a film that creeps it is the distance itself, but for the step that was the largest.
      film = steady(1)%numbers(of_film)*2.0_dp**(-nint(log(long(1)%numbers(of_film))/log(2.0_dp)))
      away = abs(steady(1)%numbers(of_film)/long(1)%numbers(of_film) - 1.0_dp)*(1.0_dp + film*film)
      if (creeps) call checks%check(steady(1)%distance < 1.3_dp*away, name//': its bound is not much too large')
   end subroutine check_steady

end module test_slow_motions
