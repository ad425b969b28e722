!> Tests of when a motion by the closure is solved again in nodes of pressure.
module test_automatic_model
   use automatic_model, only: reason_for_nodes, reason_t
   use canonical_scenes, only: scene_g
   use checks, only: check_list_t
   use judged_scene, only: judged_scene_t
   use kinds, only: dp
   use node_extremes, only: seen_loads, seen_net_load
   use problem, only: coast_flank, drive_flank, largest_applied_force
   use prepared_scene, only: resolve
   use scene_status, only: status_complete, status_film_lost, status_interrupted
   use scene_types, only: viscosity_constant, viscosity_roelands
   implicit none(type, external)
   private

   !> Loads above this multiple of the largest force are impacts
   real(dp), parameter :: impact_limit = 2.0_dp

   public :: run_automatic_model_tests

contains

   !> Runs every test of this topic.
   subroutine run_automatic_model_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('automatic_model')
      call test_reasons(checks)
   end subroutine run_automatic_model_tests

   !> A scene G that was solved: largest loads of both flanks and least net load, over the largest force.
   function judged_as(oil, drive, coast, least) result(judged)
      !> Code of its viscosity law
      integer, intent(in) :: oil
      real(dp), intent(in) :: drive
      real(dp), intent(in) :: coast
      real(dp), intent(in) :: least
      type(judged_scene_t) :: judged
      real(dp) :: force

      judged%resolved = resolve(scene_g(oil))
      judged%status = status_complete
      judged%judged = .true.
      force = largest_applied_force(judged%resolved%problem)
      judged%extremes%highest(seen_loads(1))%value = drive*force
      judged%extremes%highest(seen_loads(2))%value = coast*force
      judged%extremes%lowest(seen_net_load)%value = least*force
      judged%impacts%exists = .true.
      judged%impacts%contacts(drive_flank)%count = merge(1, 0, drive > impact_limit)
      judged%impacts%contacts(coast_flank)%count = merge(1, 0, coast > impact_limit)
   end function judged_as

   !> Each limit from both sides, within the error of the closure, 2.4 % of Roelands' oil and 0.93 % of oil of constant viscosity (0.49 %
   !> of M below 0.15, without impacts), and beyond it.
   subroutine test_reasons(checks)
      type(check_list_t), intent(inout) :: checks
      type(judged_scene_t) :: judged
      type(reason_t) :: reason

      call expect(judged_as(viscosity_roelands, 10.0_dp, 10.0_dp, -9.0_dp), .false., 'impacts far from the limit')
      call expect(judged_as(viscosity_roelands, 2.02_dp, 10.0_dp, -9.0_dp), .true., 'an impact just above it')
      call expect(judged_as(viscosity_roelands, 1.98_dp, 10.0_dp, -9.0_dp), .true., 'a load just below it')
      call expect(judged_as(viscosity_roelands, 10.0_dp, 1.98_dp, -9.0_dp), .true., 'on the other flank')
      call expect(judged_as(viscosity_roelands, 10.0_dp, 2.06_dp, -9.0_dp), .false., 'a load 3 % above it')
      call expect(judged_as(viscosity_constant, 10.0_dp, 2.03_dp, -9.0_dp), .false., 'one of 1.5 % in oil of constant viscosity')
      call expect(judged_as(viscosity_roelands, 1.5_dp, 0.1_dp, 0.004_dp), .true., 'nearly a separation')
      call expect(judged_as(viscosity_roelands, 1.5_dp, 0.1_dp, -0.004_dp), .true., 'a separation, just so')
      call expect(judged_as(viscosity_roelands, 1.5_dp, 0.1_dp, 0.1_dp), .false., 'none')
      call expect(judged_as(viscosity_roelands, 1.5_dp, 0.1_dp, -0.1_dp), .false., 'one beyond doubt')
      judged = judged_as(viscosity_roelands, 1.5_dp, 0.1_dp, 0.1_dp)
      judged%impacts%unloaded_share = 0.004_dp
      call expect(judged, .true., 'a drive film that is hardly ever unloaded')
      judged%impacts%unloaded_share = 0.5_dp
      call expect(judged, .false., 'one that is often')
      ! M = 2 is 424 N in scene G, alpha p = 8 is 508 MPa.
      judged = judged_as(viscosity_roelands, 10.0_dp, 10.0_dp, -9.0_dp)
      judged%extremes%highest(seen_loads(2))%value = 430.0_dp
      call expect(judged, .true., 'a load beyond the range of the closure')
      judged%extremes%highest(seen_loads(2))%value = 420.0_dp
      call expect(judged, .false., 'one within')
      judged%regime%pressure_maximum = 520.0e6_dp
      call expect(judged, .true., 'a pressure beyond it')
      judged%status = status_film_lost
      reason = reason_for_nodes(judged, impact_limit)
      call checks%check(reason%code > 0, 'a closure that ended')
      judged%status = status_interrupted
      reason = reason_for_nodes(judged, impact_limit)
      call checks%check(reason%code == 0, 'but not one that was interrupted')

   contains

      !> Check whether a motion is solved again.
      subroutine expect(judged, again, name)
         type(judged_scene_t), intent(in) :: judged
         logical, intent(in) :: again
         character(*), intent(in) :: name

         reason = reason_for_nodes(judged, impact_limit)
         call checks%check(reason%code > 0 .eqv. again, name)
      end subroutine expect

   end subroutine test_reasons

end module test_automatic_model
