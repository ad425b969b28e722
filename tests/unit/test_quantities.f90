!> Tests of the table of quantities: each of them has a value, and a scene has the same ones as a single scene, as a value of a
!> sweep and as a row of a campaign.
module test_quantities
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use canonical_scenes, only: canonical_scene
   use checks, only: check_list_t
   use errors, only: error_t
   use judged_scene, only: judged_scene_t, quantity_list, quantity_numbers, quantity_value
   use key_table, only: find_key
   use kinds, only: dp, int64
   use problem, only: has_damped_teeth, has_elastic_teeth
   use quantities, only: a_list, a_number, part_errors, quantity_batch_periods, quantity_followed_periods, &
      least_verdict_with_impacts, needs_impacts, quantity_motion_end, quantity_impacts_per_revolution_coast, &
      quantity_impacts_per_revolution_drive, quantity_reversals_per_revolution, &
      quantity_impacts_per_period_drive, quantity_gear_acceleration_maximum, quantity_gear_acceleration_rms, &
      quantity_impacts_verified, quantity_verdict, quantity_verdict_verified, verification_of, quantities_reported_in, &
      quantity_lyapunov_exponent, quantity_impacts_coast, quantity_drag_bearing, quantity_drag_churning, &
      quantity_drag_synchroniser, quantity_drag_torque, quantity_inertia_ratio, quantity_central_film, quantity_closure_range, &
      quantity_film_at_pressure_maximum, quantity_film_model, quantity_pressure_error, quantity_pressure_resolved, &
      quantity_impacts_drive, quantity_verified, quantity_gear_position_maximum, quantity_gear_position_minimum, &
      quantity_film_dissipated_power, quantity_tooth_dissipated_power, quantity_periods_solved, quantity_status, &
      quantity_restitution_coast, quantity_restitution_drive, quantity_table, quantity_word
   use run_sweep, only: carried_state_t, solve_value
   use scene_solution, only: solve_in_memory
   use sampling, only: plan_table, sample_plan_t
   use scene_types, only: law_iso_viscous, method_taylor, scene_t, until_steady
   use judge_group, only: judgement_space_t
   use solve_chunk, only: solve_scenes
   implicit none(type, external)
   private

   public :: run_quantities_tests

contains

   !> Runs every test of this topic.
   subroutine run_quantities_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('quantities')
      call test_words(checks)
      call test_scene(0.0_dp, 0.0_dp, checks)
      call test_scene(2.0e8_dp, 0.0_dp, checks)
      call test_scene(2.0e8_dp, 0.05_dp, checks)
   end subroutine run_quantities_tests

   !> All quantities of a scene.
   subroutine test_scene(stiffness, damping_ratio, checks)
      real(dp), intent(in) :: stiffness            !> Of its teeth [N/m], 0: rigid
      real(dp), intent(in) :: damping_ratio        !> and their damping [-]
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(judged_scene_t) :: single, swept
      type(scene_t) :: scene
      real(dp), allocatable :: row(:)

      scene = steady_scene()
      scene%contact%stiffness = stiffness
      scene%contact%damping_ratio = damping_ratio
      call solve_single(scene, single)
      call test_every_value(single, checks)
      call solve_swept(scene, swept)
      call solve_row(scene, row)
      call test_same_values(single, swept, row, checks)
   end subroutine test_scene

   !> Words of codes, the first and the last.
   subroutine test_words(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%check(quantity_word(quantity_status, 0) == 'complete', 'first word')
      call checks%check(quantity_word(quantity_status, 9) == 'invalid', 'last word')
      call checks%check(index(quantity_word(quantity_verdict, least_verdict_with_impacts - 1), 'impacts') == 0 .and. &
                        index(quantity_word(quantity_verdict, least_verdict_with_impacts), 'impacts') > 0, &
                        'the first verdict with impacts is the one of that name')
      call checks%check(verification_of(quantity_verdict) == quantity_verdict_verified .and. &
                        verification_of(quantity_impacts_per_period_drive) == quantity_impacts_verified .and. &
                        verification_of(quantity_status) == quantity_verified, &
                        'verdict, impacts and class are verified each by its own flag')
   end subroutine test_words

   !> Every quantity that a scene has is known; of rigid teeth no position of the gear is reported, which the film is.
   subroutine test_every_value(single, checks)
      type(judged_scene_t), intent(in) :: single  !> A steady, verified scene
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      integer :: i

      do i = 1, size(quantity_table)
         if (quantity_table(i)%kind == a_list .and. quantity_table(i)%need == needs_impacts) then
            call checks%check(size(quantity_list(i, single)) == &
                              nint(quantity_value(merge(quantity_impacts_drive, quantity_impacts_coast, &
                                                        index(quantity_table(i)%name, 'drive') > 0), single)), &
                              trim(quantity_table(i)%name)//' has a number of each impact')
         else if (quantity_table(i)%kind == a_list) then
            call checks%check(size(quantity_list(i, single)) > 0, trim(quantity_table(i)%name)//' has numbers')
         else if (any(i == [quantity_gear_position_minimum, quantity_gear_position_maximum]) .and. &
                  .not. has_elastic_teeth(single%resolved%problem)) then
            call checks%check(ieee_is_nan(quantity_value(i, single)), trim(quantity_table(i)%name)//' of rigid teeth')
         else if (any(i == [quantity_film_dissipated_power, quantity_tooth_dissipated_power]) .and. &
                  .not. has_damped_teeth(single%resolved%problem)) then
            call checks%check(ieee_is_nan(quantity_value(i, single)), trim(quantity_table(i)%name)//' of teeth without damping')
         else if (any(i == [quantity_drag_torque, quantity_drag_bearing, quantity_drag_synchroniser, quantity_drag_churning, &
                            quantity_inertia_ratio, quantity_gear_acceleration_rms, quantity_gear_acceleration_maximum, &
                            quantity_impacts_per_revolution_drive, quantity_impacts_per_revolution_coast, &
                            quantity_reversals_per_revolution])) then
            call checks%check(ieee_is_nan(quantity_value(i, single)), trim(quantity_table(i)%name)//' of no gear')
         else if (any(i == [quantity_pressure_error, quantity_pressure_resolved, quantity_film_at_pressure_maximum, &
                            quantity_central_film, quantity_film_model])) then
            call checks%check(ieee_is_nan(quantity_value(i, single)), trim(quantity_table(i)%name)//' of films without nodes')
         else if (any(i == [quantity_restitution_drive, quantity_restitution_coast])) then
            call checks%check(ieee_is_nan(quantity_value(i, single)) .eqv. &
                              nint(quantity_value(merge(quantity_impacts_drive, quantity_impacts_coast, &
                                                        i == quantity_restitution_drive), single)) == 0, &
                              trim(quantity_table(i)%name)//' is known where there are impacts')
         else if (i == quantity_motion_end) then
            call checks%check(ieee_is_nan(quantity_value(i, single)), trim(quantity_table(i)%name)//' of no threshold')
         else if (i == quantity_closure_range) then
            call checks%check(ieee_is_nan(quantity_value(i, single)), trim(quantity_table(i)%name)//' of rigid flanks')
         else if (any(i == [quantity_lyapunov_exponent, quantity_followed_periods, quantity_batch_periods])) then
            call checks%check(ieee_is_nan(quantity_value(i, single)), trim(quantity_table(i)%name)//' of a motion that repeats')
         else
            call checks%check(.not. ieee_is_nan(quantity_value(i, single)), trim(quantity_table(i)%name)//' has a value')
         end if
      end do
   end subroutine test_every_value

   !> What sweeps and campaigns report of a scene is what its summary reports, but for how it was solved.
   subroutine test_same_values(single, swept, row, checks)
      type(judged_scene_t), intent(in) :: single  !> As a single scene
      type(judged_scene_t), intent(in) :: swept   !> As a value of a sweep
      real(dp), intent(in) :: row(:)              !> As a row of a campaign, from its first quantity on
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      integer, allocatable :: reported(:)
      integer :: i, column

      allocate (reported, source=quantities_reported_in('sweep'))
      do i = 1, size(reported)
         if (any(reported(i) == [quantity_status, quantity_periods_solved])) cycle
         if (quantity_table(reported(i))%kind == a_list) then
            call check_list(reported(i), quantity_numbers([reported(i)], swept), 'in a sweep')
         else
            call check_same(reported(i), quantity_value(reported(i), swept), 'in a sweep')
         end if
      end do
      deallocate (reported)
      allocate (reported, source=quantities_reported_in('campaign'))
      column = 0
      do i = 1, size(reported)
         column = column + 1
         if (quantity_table(reported(i))%kind == a_list) then
            call check_list(reported(i), row(column:column + 7), 'in a campaign')
            column = column + 7
         else if (.not. any(reported(i) == [quantity_verified, quantity_periods_solved])) then
            call check_same(reported(i), row(column), 'in a campaign')
         end if
      end do
      call checks%check(column == size(row), 'columns of a row')

   contains

      !> The first numbers of a list agree to five digits of the largest.
      subroutine check_list(quantity, numbers, place)
         integer, intent(in) :: quantity     !> Its code
         real(dp), intent(in) :: numbers(:)  !> Its numbers elsewhere
         character(*), intent(in) :: place   !> Where

         associate (list => quantity_list(quantity, single))
            call checks%check(maxval(abs(numbers - list(:size(numbers)))) < 1.0e-5_dp*maxval(list), &
               trim(quantity_table(quantity)%name)//' '//place)
         end associate
      end subroutine check_list

      !> A number agrees to five digits, an error to its size, everything else exactly.
      subroutine check_same(quantity, value, place)
         integer, intent(in) :: quantity    !> Its code
         real(dp), intent(in) :: value      !> Its value elsewhere
         character(*), intent(in) :: place  !> Where
         real(dp) :: own, room

         own = quantity_value(quantity, single)
         room = 0.0_dp
         if (quantity_table(quantity)%kind == a_number) room = 1.0e-5_dp*abs(own) + 1.0e-9_dp
         ! Errors are differences of two solutions, in which the last digits of both count.
         if (quantity_table(quantity)%part == part_errors) room = 0.5_dp*abs(own)
         if (ieee_is_nan(own) .or. ieee_is_nan(value)) then
            call checks%check(ieee_is_nan(own) .and. ieee_is_nan(value), trim(quantity_table(quantity)%name)//' '//place)
         else
            call checks%check(abs(value - own) <= room, trim(quantity_table(quantity)%name)//' '//place)
         end if
      end subroutine check_same

   end subroutine test_same_values

   !> A canonical scene under half the force that comes to rest in a periodic motion.
   function steady_scene() result(scene)
      type(scene_t) :: scene
      integer, allocatable :: recorded(:)

      scene = canonical_scene(law_iso_viscous, 512)
      scene%excitation%force_amplitude = 100.0_dp
      scene%contact%backlash = 1.0e-4_dp
      scene%solver%method = method_taylor
      scene%solver%until = until_steady
      scene%solver%kept_per_period = 512
      scene%solver%accuracy = 1.0e-8_dp
      scene%solver%periods = 400
      scene%campaign%samples_per_period = 512
      allocate (recorded, source=quantities_reported_in('campaign'))
      scene%campaign%record = recorded
      scene%resolved_input = ''
   end function steady_scene

   !> Solve and judge a single scene.
   subroutine solve_single(scene, judged)
      type(scene_t), intent(in) :: scene          !> The scene
      type(judged_scene_t), intent(out) :: judged  !> Its result
      type(error_t), allocatable :: error

      call solve_in_memory(scene, judged, error)
   end subroutine solve_single

   !> Solve and judge it as the first value of a sweep.
   subroutine solve_swept(scene, judged)
      type(scene_t), intent(in) :: scene          !> The scene
      type(judged_scene_t), intent(out) :: judged  !> Its result
      type(error_t), allocatable :: error
      type(carried_state_t) :: state
      type(judgement_space_t) :: space

      call solve_value(scene, state, space, judged, error)
   end subroutine solve_swept

   !> Solve and judge it as a row of a campaign.
   subroutine solve_row(scene, row)
      type(scene_t), intent(in) :: scene           !> The scene
      real(dp), allocatable, intent(out) :: row(:)  !> Its quantities
      type(judgement_space_t), allocatable :: space
      type(error_t), allocatable :: error
      type(sample_plan_t) :: plan
      real(dp), allocatable :: values(:, :), rows(:, :)

      allocate (values(1, 1), source=scene%excitation%force_amplitude)
      call plan_table([find_key('load.force_amplitude')], values, plan)
      allocate (rows(3 + size(scene%campaign%record) + 7, 1), space)
      call solve_scenes(scene, plan, 1_int64, space, rows, error)
      row = rows(4:, 1)
   end subroutine solve_row

end module test_quantities
