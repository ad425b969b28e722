!> Random gear scenes, and the motions that the program reports of them: of a scene alone, and in the middle of the grid of a
!> campaign. A scene depends on its number and the seed alone.
module gear_motions
   use campaign_axis, only: campaign_axis_t
   use completed_scene, only: complete_scene
   use coexisting_motions, only: coexisting_motions_t
   use errors, only: error_t, fault_list_t
   use judged_scene, only: judged_scene_t
   use kinds, only: dp, int64
   use quantities, only: quantity_acceleration_rms, quantity_loudest_acceleration_rms, quantity_motions, &
      quantity_quietest_acceleration_rms, quantity_starts_solved, quantity_unsettled_starts
   use random_scenes, only: draw
   use random_walk, only: next_uniform, random_state_t
   use prepared_scene, only: resolve, resolved_scene_t
   use sampling, only: plan_grid, sample_plan_t
   use scene_group, only: scene_group_t
   use scene_reader, only: override_t, read_scenes
   use scene_status, only: is_success
   use single_motions, only: find_all_motions
   use scene_types, only: scene_t, task_campaign, task_motion
   use judge_group, only: judgement_space_t
   use solve_chunk, only: solve_scenes
   use scene_solution, only: solve_in_memory
   use varied_keys, only: find_varied_key, is_valid_scene, set_varied_keys
   implicit none(type, external)
   private

   !> Keys that are drawn, and their ranges: speed [1/min] and temperature [degC] even, stiffness of a tooth [N/m2] and scale of the
   !> orders in the logarithm. The first two are the axes of the campaign.
   character(*), parameter, public :: drawn_keys(4) = [character(23) :: 'shaft.speed_rpm', 'oil.temperature_celsius', &
      'gear.tooth_stiffness', 'load.force_scale']
   real(dp), parameter :: speeds(2) = [600.0_dp, 3500.0_dp], temperatures(2) = [-20.0_dp, 120.0_dp], &
                          stiffnesses(2) = [1.0e7_dp, 1.0e12_dp], scales(2) = [0.5_dp, 2.0_dp]
   !> Larger damping ratios are drawn again.
   real(dp), parameter :: largest_damping = 0.3_dp
   !> Starts of a scene alone and of the rows of a campaign, as by default.
   integer, parameter :: starts_alone = 29, starts_of_row = 3
   !> Points of the grid along an axis, and their distances.
   integer, parameter :: half_grid = 1, grid_points = 2*half_grid + 1
   real(dp), parameter :: grid_steps(2) = [100.0_dp, 5.0_dp]

   !> A scene.
   type, public :: gear_scene_t
      !> With the drawn values set, the pair it is of, and the values
      type(scene_t) :: scene
      integer :: pair = 0
      real(dp) :: values(size(drawn_keys)) = 0.0_dp
      type(resolved_scene_t) :: resolved
   end type gear_scene_t

   !> What the row of a campaign shows.
   type, public :: reported_row_t
      logical :: judged = .false.
      integer :: motions = 0, starts = 0, unsettled = 0
      !> Of the motions from rest, loudest and quietest [m/s2]
      real(dp) :: rest_rms = 0.0_dp, loudest_rms = 0.0_dp, quietest_rms = 0.0_dp
   end type reported_row_t

   public :: read_pairs, draw_gear_scene, motions_reported, row_reported

contains

   !> The pairs that scenes are drawn from: those of the ready gearbox with its run-up, and the loose pair.
   subroutine read_pairs(pairs)
      type(scene_t), allocatable, intent(out) :: pairs(:)
      type(scene_t), allocatable :: scenes(:)
      type(override_t) :: none(0)
      type(fault_list_t) :: faults
      integer :: i

      call read_scenes('input/gearbox_map.nml', none, pairs, faults)
      call read_scenes('input/loose_pair.nml', none, scenes, faults)
      if (faults%count() == 0) then
         do i = 1, size(pairs)
            call complete_scene(pairs(i), faults)
         end do
         call complete_scene(scenes(1), faults)
      end if
      if (faults%count() > 0) error stop 'the ready inputs could not be read; the study runs where input/ is'
      pairs = [pairs, scenes(1)]
   end subroutine read_pairs

   !> Draw a scene.
   subroutine draw_gear_scene(pairs, seed, number, drawn)
      !> Of read_pairs
      type(scene_t), intent(in) :: pairs(:)
      integer(int64), intent(in) :: seed
      integer(int64), intent(in) :: number
      type(gear_scene_t), intent(out) :: drawn
      integer(int64), parameter :: scene_stream = 2_int64**46
      type(random_state_t) :: walk
      integer :: positions(size(drawn_keys))
      real(dp) :: share(3)

      positions = key_positions()
      walk = random_state_t(seed=seed, stream=scene_stream + number)
      do
         call next_uniform(walk, share(1))
         call next_uniform(walk, share(2))
         call next_uniform(walk, share(3))
         drawn%pair = 1 + int(share(1)*real(size(pairs), dp))
         drawn%values(1) = speeds(1) + share(2)*(speeds(2) - speeds(1))
         drawn%values(2) = temperatures(1) + share(3)*(temperatures(2) - temperatures(1))
         call draw(walk, stiffnesses, drawn%values(3))
         call draw(walk, scales, drawn%values(4))
         drawn%scene = pairs(drawn%pair)
         drawn%scene%task = task_motion
         call set_varied_keys(drawn%scene, positions, drawn%values)
         if (.not. is_valid_scene(drawn%scene, positions, drawn%values)) cycle
         drawn%resolved = resolve(drawn%scene)
         associate (resolved => drawn%resolved)
            if (resolved%natural_frequency > 0.0_dp .and. resolved%damping_ratio < largest_damping) return
         end associate
      end do
   end subroutine draw_gear_scene

   !> Positions of the drawn keys in the key table.
   function key_positions() result(positions)
      integer :: positions(size(drawn_keys))
      character(:), allocatable :: message
      integer :: i

      do i = 1, size(drawn_keys)
         call find_varied_key(trim(drawn_keys(i)), positions(i), message)
      end do
   end function key_positions

   !> All motions that are reported of a scene alone.
   subroutine motions_reported(drawn, reported, periods, judged)
      type(gear_scene_t), intent(in) :: drawn
      type(coexisting_motions_t), intent(out) :: reported
      !> Periods solved from the own start, and from the others
      integer, intent(out) :: periods(2)
      !> Whether there was anything to report
      logical, intent(out) :: judged
      type(scene_t) :: scene
      type(judged_scene_t) :: result(1)
      type(scene_group_t) :: space
      type(error_t), allocatable :: error

      scene = drawn%scene
      scene%resolved_input = ''
      scene%output%series = .false.
      scene%solver%starts = starts_alone
      scene%solver%periods = 200
      scene%solver%kept_per_period = 512
      call solve_in_memory(scene, result(1), error)
      judged = .not. allocated(error) .and. is_success(result(1)%status) .and. result(1)%judged
      periods = 0
      if (.not. judged) return
      call find_all_motions(scene, 0.0_dp, space, result, error)
      judged = .not. allocated(error)
      reported = result(1)%coexisting
      periods = [result(1)%ending%periods, reported%extra_periods]
   end subroutine motions_reported

   !> What the row in the middle of a small grid over speed and temperature shows.
   subroutine row_reported(drawn, reported)
      type(gear_scene_t), intent(in) :: drawn
      type(reported_row_t), intent(out) :: reported
      integer, parameter :: middle = half_grid*(grid_points + 1) + 1
      type(scene_t) :: scene
      type(sample_plan_t) :: plan
      type(campaign_axis_t) :: axes(size(grid_steps))
      type(judgement_space_t), allocatable :: space
      type(error_t), allocatable :: error
      character(:), allocatable :: message
      real(dp), allocatable :: rows(:, :)
      integer :: positions(size(drawn_keys)), i, bad

      positions = key_positions()
      do i = 1, size(axes)
         axes(i)%position = positions(i)
         axes(i)%first = drawn%values(i) - grid_steps(i)*real(half_grid, dp)
         axes(i)%last = drawn%values(i) + grid_steps(i)*real(half_grid, dp)
         axes(i)%count = grid_points
      end do
      call plan_grid(axes, plan, bad, message)
      if (len(message) > 0) error stop 'the grid about a scene cannot be planned'
      scene = drawn%scene
      scene%task = task_campaign
      scene%solver%starts = starts_of_row
      scene%solver%periods = 60
      scene%campaign%neighbours = .true.
      scene%campaign%record = [quantity_acceleration_rms, quantity_motions, quantity_starts_solved, quantity_unsettled_starts, &
                               quantity_loudest_acceleration_rms, quantity_quietest_acceleration_rms]
      ! Number of the scene, values, status, quantities.
      allocate (rows(2 + size(axes) + size(scene%campaign%record), grid_points**2), space)
      call solve_scenes(scene, plan, 1_int64, space, rows, error)
      if (allocated(error)) return
      associate (row => rows(2 + size(axes):, middle))
         reported%judged = is_success(nint(row(1))) .and. row(3) >= 1.0_dp
         if (.not. reported%judged) return
         reported%rest_rms = row(2)
         reported%motions = nint(row(3))
         reported%starts = nint(row(4))
         reported%unsettled = nint(row(5))
         reported%loudest_rms = row(6)
         reported%quietest_rms = row(7)
      end associate
   end subroutine row_reported

end module gear_motions
