!> Tests of pressures and films over the contact that are kept of a motion in nodes.
module test_nodal_profiles
   use canonical_scenes, only: scene_g
   use checks, only: check_list_t
   use engine, only: checkpoint_t, ending_t, unwatched_t
   use errors, only: error_t
   use kinds, only: dp
   use nodal_film, only: smallest_film
   use nodal_profiles, only: at_largest_loads, nodal_profile_t, nodal_profiles_t
   use nodal_engine, only: solve_in_nodes
   use nodal_judgement, only: choice_of
   use nodal_step, only: nodal_choice_t
   use node_extremes, only: seen_loads
   use problem, only: coast_flank, drive_flank, problem_of, problem_t
   use prepared_scene, only: request_of, prepare
   use scene_types, only: model_resolved, scene_t, viscosity_roelands
   use text, only: integer_text
   use window_impacts, only: impacts_of_record, window_impacts_t
   use window_record, only: window_record_t
   use classify_group, only: integral_record
   use window_keeper, only: window_keeper_t
   implicit none(type, external)
   private

   public :: run_nodal_profiles_tests

contains

   !> Runs every test of this topic.
   subroutine run_nodal_profiles_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('nodal_profiles')
      call test_largest_loads(checks)
      call test_phases(checks)
   end subroutine run_nodal_profiles_tests

   !> Two periods of scene G, the second one judged.
   subroutine solve(profiles, problem, record)
      !> What is asked for, and then the profiles
      type(nodal_profiles_t), intent(inout) :: profiles
      type(problem_t), intent(out) :: problem
      type(window_record_t), intent(out) :: record
      type(scene_t) :: scene
      type(nodal_choice_t) :: choice
      type(window_keeper_t) :: keeper
      type(unwatched_t) :: nobody
      type(ending_t) :: ending
      type(checkpoint_t) :: start
      type(error_t), allocatable :: error

      scene = scene_g(viscosity_roelands)
      scene%film%model = model_resolved
      scene%film%nodes = 32
      scene%solver%accuracy = 1.0e-2_dp
      scene%solver%kept_per_period = 64
      scene%solver%periods = 2
      scene%spectrum%periods = 1
      problem = problem_of(scene)
      call choice_of(prepare(scene), choice)
      call keeper%keep_windows_of(problem)
      record = integral_record(scene%spectrum)
      record%wants = .true.
      record%loads%impact_limit = scene%spectrum%impact_limit
      call solve_in_nodes(problem, choice, request_of(scene), keeper, nobody, start, ending, record, error, profiles)
   end subroutine solve

   !> A profile carries the load that is reported of it, and obeys the shape of its contact.
   subroutine check_profile(checks, problem, profiles, profile, name)
      type(check_list_t), intent(inout) :: checks
      type(problem_t), intent(in) :: problem
      type(nodal_profiles_t), intent(in) :: profiles
      type(nodal_profile_t), intent(in) :: profile
      character(*), intent(in) :: name

      associate (grid => profiles%contact%grid)
         call checks%check_close(dot_product(grid%load, profile%pressures)/profile%load, 1.0_dp, 1.0e-12_dp, &
                                 name//' carries its load')
         call checks%check(minval(profile%films) >= smallest_film(grid, profile%films(1) - 0.5_dp*grid%place(1)**2 - &
                           dot_product(grid%film_at_nodes(1, :), profile%pressures), profile%pressures)*(1.0_dp - 1.0e-12_dp), &
                           name//' has no film below its smallest one')
      end associate
      call checks%check(profile%contact <= merge(2, 1, problem%backlash < 1.0_dp) .and. profile%time > 0.0_dp .and. &
                        profile%time <= 1.0_dp, name//' is of this window')
   end subroutine check_profile

   !> At each impact the profile is that of its largest load. An impact takes some 35 steps, so the end of one is within a
   !> seventieth of it: a parabola over half of that width falls by 3e-3 there, 4e-3 are let pass.
   subroutine test_largest_loads(checks)
      type(check_list_t), intent(inout) :: checks
      type(nodal_profiles_t) :: profiles
      type(problem_t) :: problem
      type(window_record_t) :: record
      type(window_impacts_t) :: impacts
      type(nodal_profile_t), allocatable :: chosen(:)
      real(dp) :: unit
      integer :: flank, i

      profiles%wanted = .true.
      call solve(profiles, problem, record)
      impacts = impacts_of_record(record, problem%frequency)
      unit = problem%contact%film%closure%load_unit
      do flank = drive_flank, coast_flank
         associate (kept => impacts%contacts(flank)%kept, name => 'impact on flank '//integer_text(flank))
            call checks%check(size(kept) > 0, name//' is there')
            chosen = at_largest_loads(profiles, flank, kept%time, 1)
            do i = 1, size(kept)
               call checks%check_close(unit*chosen(i)%load/kept(i)%load, 1.0_dp, 4.0e-3_dp, name//': load')
               call checks%check(unit*chosen(i)%load <= kept(i)%load*(1.0_dp + 1.0e-6_dp), name//': no more than the largest')
               call check_profile(checks, problem, profiles, chosen(i), name)
            end do
         end associate
         chosen = at_largest_loads(profiles, flank, [real(dp) ::], 1)
         associate (largest => record%highest(merge(seen_loads(1), seen_loads(2), flank == drive_flank))%value)
            call checks%check(size(chosen) == 1, 'without impacts there is one')
            call checks%check_close(unit*chosen(1)%load/largest, 1.0_dp, 4.0e-3_dp, 'of the largest load')
         end associate
      end do
   end subroutine test_largest_loads

   !> At phases both flanks are reported at the first end of a step from there on.
   subroutine test_phases(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: phases(3) = [0.1_dp, 0.5_dp, 1.0_dp]
      !> Longest step [periods]
      real(dp), parameter :: longest = 0.02_dp
      type(nodal_profiles_t) :: profiles
      type(problem_t) :: problem
      type(window_record_t) :: record
      integer :: i

      profiles%wanted = .true.
      profiles%phases = phases
      call solve(profiles, problem, record)
      call checks%check(profiles%count == 2*size(phases), 'a profile for each phase and flank')
      do i = 1, min(profiles%count, 2*size(phases))
         associate (profile => profiles%kept(i), phase => phases((i + 1)/2))
            call check_profile(checks, problem, profiles, profile, 'phase '//integer_text(i))
            call checks%check(profile%time >= phase*(1.0_dp - 1.0e-12_dp) .and. profile%time < phase + longest, 'at its phase')
            call checks%check(profile%contact == 2 - modulo(i, 2), 'flank by flank')
         end associate
      end do
   end subroutine test_phases

end module test_nodal_profiles
