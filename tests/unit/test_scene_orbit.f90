!> Tests of the periodic motion that a scene ends on: of several that the scene has, its own.
module test_scene_orbit
   use checks, only: check_list_t
   use engine, only: ending_t
   use errors, only: fault_list_t
   use kinds, only: dp
   use periodic_orbit, only: map_states, periodic_orbit_t
   use problem, only: of_velocity, problem_t
   use prepared_scene, only: resolve, resolved_scene_t
   use scene_texts, only: read_text
   use scene_types, only: scene_t
   use scene_orbit, only: nearby_orbit, orbit_of
   implicit none(type, external)
   private

   character, parameter :: line_feed = new_line('a')
   !> A gear pair at 1714.5 1/min and 79.08 degC with two motions that repeat after every period, 55.46 and 62.98 m/s2 rms; from
   !> rest it comes to either, as the accuracy has it.
   character(*), parameter :: text = &
      "&contact radius = 5.2564712e-3, length = 0.017967588, backlash = 1.0e-4, stiffness = 2.24e8 /"//line_feed// &
      "&lubricant viscosity = 0.013016226, pressure_viscosity = 1.4e-8 /"//line_feed// &
      "&kinematics entrainment_speed = 1.0836941 /"//line_feed// &
      "&load mass = 0.86080597, steady_force = 2.2403743, gravity = 0.0, frequency = 57.150477, force_orders = 1, 2, 3"// &
      line_feed//"force_amplitudes = 12.666254, 2.1110423, 1.0555212, force_phases = 0.0, 0.8, -0.5 /"//line_feed// &
      "&film law = 'iso-viscous', model = 'reynolds' /"//line_feed//"&solver method = 'taylor' /"
   !> A state of each: film [m], velocity [m/s], compressions of both teeth [m]
   real(dp), parameter :: states(4, 2) = reshape([2.10682816e-7_dp, -1.84484370e-2_dp, 4.46568997e-7_dp, 2.45830567e-10_dp, &
                                                  1.68137536e-8_dp, 4.73556093e-2_dp, 1.31078870e-6_dp, 4.29540728e-10_dp], [4, 2])
   !> Moduli of their largest Floquet multipliers; the second by central differences of 1e-6 of what the numbers of a state count as
   real(dp), parameter :: moduli(2) = [0.5210_dp, 0.3514_dp]

   public :: run_scene_orbit_tests

contains

   !> Runs every test of this topic.
   subroutine run_scene_orbit_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('scene_orbit')
      call test_orbit_of_the_scene(checks)
   end subroutine run_scene_orbit_tests

   !> Where the tighter solution has come to another motion, the periodic motion is that of the scene itself.
   subroutine test_orbit_of_the_scene(checks)
      class(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene
      type(fault_list_t) :: faults
      type(resolved_scene_t) :: resolved
      type(periodic_orbit_t) :: orbits(2), found
      type(ending_t) :: own(2), away
      integer :: i

      call read_text(text, scene, faults)
      call checks%check(faults%count() == 0, 'a scene')
      if (faults%count() > 0) return
      resolved = resolve(scene)
      do i = 1, 2
         own(i) = settled(resolved%problem, states(:, i))
         orbits(i) = nearby_orbit(resolved%problem, own(i))
         call checks%check(orbits(i)%period == 1, 'a motion that repeats')
         if (orbits(i)%period == 0) return
         call checks%check_close(abs(orbits(i)%multipliers(1)), moduli(i), 1.0e-3_dp, 'its multiplier')
      end do
      do i = 1, 2
         found = orbit_of(resolved%problem, own(i), orbits(i))
         call checks%check(all(abs(found%state - orbits(i)%state) <= 0.0_dp), 'the orbit of the tighter one, bit by bit')
         found = orbit_of(resolved%problem, own(i), orbits(3 - i))
         call checks%check_close(abs(found%multipliers(1)), moduli(i), 1.0e-3_dp, 'not that of the tighter solution')
         away = own(i)
         away%numbers(of_velocity) = away%numbers(of_velocity) + 0.02_dp
         found = orbit_of(resolved%problem, away, orbits(i))
         call checks%check(found%period == 0, 'a scene that is on neither has none')
      end do
      found = orbit_of(resolved%problem, own(1), periodic_orbit_t())
      call checks%check(found%period == 0, 'none of the tighter solution')
   end subroutine test_orbit_of_the_scene

   !> Where a motion is after twenty periods.
   type(ending_t) function settled(problem, state) result(ending)
      type(problem_t), intent(in) :: problem
      real(dp), intent(in) :: state(:) !> Numbers of the state that it starts from
      real(dp) :: image(size(state), 1)
      logical :: mapped

      image(:, 1) = state
      call map_states(problem, 20, 1.0e-9_dp, image, mapped)
      allocate (ending%numbers, source=image(:, 1))
   end function settled

end module test_scene_orbit
