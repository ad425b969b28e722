!> What the program reports to a user of a scene: solved and judged as a single scene is, as a row of a campaign, or as a
!> value of a sweep, without their files. The only file of this study that knows how the program does that.
module reported_summary
   use verification, only: verification_sentence, verification_word
   use engine, only: ending_t, motion_state_t, request_t, start_of
   use errors, only: error_t
   use impact_reference, only: compared_harmonics
   use judged_scene, only: judged_scene_t, quantity_value
   use kinds, only: dp, int64
   use many_motions, only: solve_motions
   use problem, only: has_two_flanks, problem_t
   use quantities, only: quantity_acceleration_maximum, quantity_acceleration_minimum, quantity_verified, &
      quantity_coast_film_maximum, quantity_coast_film_minimum, quantity_film_maximum, quantity_film_minimum, &
      quantity_harmonics, quantity_orbit_period, quantity_periods_solved, quantity_rattle_class, quantity_sampling_sufficient, &
      quantity_word
   use random_scenes, only: drawn_scene_t
   use run_sweep, only: carried_state_t, solve_value
   use scene_solution, only: solve_in_memory
   use sampling, only: plan_table, sample_plan_t
   use scene_status, only: is_success, status_steady, status_name
   use scene_types, only: scene_t, task_campaign, until_steady
   use judge_group, only: judgement_space_t
   use solve_chunk, only: solve_scenes
   use varied_keys, only: find_varied_key
   implicit none(type, external)
   private

   !> What the summary says.
   type, public :: reported_t
      !> Status as a word, and whether there is a window
      character(16) :: status = ''
      logical :: judged = .false., verified = .false.
      !> Whether a verification was asked for
      logical :: verification_asked = .true.
      character(16) :: class = ''
      character(160) :: reason = ''
      !> film_minimum, film_maximum [m], acceleration_minimum, acceleration_maximum [m/s2], coast_film_minimum, coast_film_maximum
      !> [m], with the errors stated
      real(dp) :: extremes(6) = 0.0_dp, extreme_errors(6) = 0.0_dp
      !> [m/s2], with the errors stated; beyond `harmonic_count` none is listed
      real(dp) :: harmonics(compared_harmonics) = 0.0_dp, harmonic_errors(compared_harmonics) = 0.0_dp
      integer :: harmonic_count = 0
      !> Periods solved, periods of the window, and of the orbit of a steady motion (0: not steady)
      integer :: periods = 0, window = 0, orbit = 0
      !> Periods after which the motion next to the one found repeats, 0: none is reported
      integer :: repeats = 0
      logical :: sampling_sufficient = .true.
   end type reported_t

   public :: rows_reported, steps_expected, summary_reported, value_reported

contains

   !> Steps that scenes are likely to take, as far as their first periods show; a steady motion is found after `settled` of them.
   function steps_expected(drawn) result(steps)
      !> Scenes of one accuracy
      type(drawn_scene_t), intent(in) :: drawn(:)
      integer(int64) :: steps(size(drawn))
      integer, parameter :: first_periods = 2, settled = 30
      type(problem_t) :: problems(size(drawn))
      type(motion_state_t) :: starts(size(drawn))
      type(ending_t) :: endings(size(drawn))
      real(dp) :: none(0, 2, size(drawn))
      integer :: i

      do i = 1, size(drawn)
         problems(i) = drawn(i)%resolved%problem
         starts(i) = start_of(problems(i))
      end do
      call solve_motions(problems, starts, request_t(accuracy=drawn(1)%scene%solver%accuracy, periods=first_periods, &
                                                     every_period=.true.), none, endings)
      steps = endings%count%steps/first_periods*merge(min(drawn%scene%solver%periods, settled), drawn%scene%solver%periods, &
                                                      drawn%scene%solver%until == until_steady)
   end function steps_expected

   !> What the summary of a scene shows.
   subroutine summary_reported(drawn, reported)
      !> The scene with its solver
      type(drawn_scene_t), intent(in) :: drawn
      type(reported_t), intent(out) :: reported
      type(judged_scene_t) :: result
      type(error_t), allocatable :: error
      integer :: n

      call solve_in_memory(drawn%scene, result, error)
      reported%status = status_name(result%status)
      if (allocated(error)) reported%status = 'not_written'
      reported%judged = is_success(result%status) .and. result%judged .and. .not. allocated(error)
      if (.not. reported%judged) return
      reported%class = quantity_word(quantity_rattle_class, result%rattle%class)
      reported%periods = result%ending%periods
      reported%window = result%window_periods
      reported%orbit = result%repeats_after
      reported%repeats = result%orbit%period
      reported%sampling_sufficient = result%rattle%spectrum%sampling_sufficient
      reported%extremes = extremes_of(result)
      n = min(compared_harmonics, size(result%rattle%spectrum%harmonics))
      reported%harmonic_count = n
      reported%harmonics(:n) = result%rattle%spectrum%harmonics(:n)
      reported%harmonic_errors = huge(1.0_dp)
      reported%extreme_errors = huge(1.0_dp)
      associate (verification => result%verification)
         reported%verified = verification_word(verification) == 'verified'
         if (verification%exists) reported%reason = verification_sentence(verification)
         if (.not. allocated(verification%harmonic_errors)) return
         n = min(n, size(verification%harmonic_errors))
         reported%harmonic_errors(:n) = verification%harmonic_errors(:n)
         if (n == 0) return
         reported%extreme_errors = [verification%film_minimum_error, verification%film_maximum_error, &
                                verification%acceleration_minimum_error, verification%acceleration_maximum_error, &
                                verification%film_error*reported%extremes(5:)]
      end associate
   end subroutine summary_reported

   !> Extremes of a judged scene.
   pure function extremes_of(judged) result(extremes)
      type(judged_scene_t), intent(in) :: judged
      real(dp) :: extremes(6)
      integer, parameter :: codes(6) = [quantity_film_minimum, quantity_film_maximum, quantity_acceleration_minimum, &
         quantity_acceleration_maximum, quantity_coast_film_minimum, quantity_coast_film_maximum]
      integer :: i

      do i = 1, size(codes)
         extremes(i) = quantity_value(codes(i), judged)
      end do
      if (.not. has_two_flanks(judged%resolved%problem)) extremes(5:) = 0.0_dp
   end function extremes_of

   !> What a campaign reports of scenes that differ from a base in some keys.
   subroutine rows_reported(base, keys, values, verified, reported)
      !> Base scene with its solver
      type(scene_t), intent(in) :: base
      !> Varied keys as a user writes them
      character(*), intent(in) :: keys(:)
      !> Their values: key, scene
      real(dp), intent(in) :: values(:, :)
      !> Whether the class is to be verified
      logical, intent(in) :: verified
      !> What is reported of each scene
      type(reported_t), intent(out) :: reported(:)
      integer, parameter :: recorded(11) = [quantity_film_minimum, quantity_film_maximum, quantity_acceleration_minimum, &
         quantity_acceleration_maximum, quantity_coast_film_minimum, quantity_coast_film_maximum, quantity_rattle_class, &
         quantity_sampling_sufficient, quantity_orbit_period, quantity_periods_solved, quantity_harmonics], row_harmonics = 8
      integer, allocatable :: record(:)
      type(scene_t) :: scene
      type(sample_plan_t) :: plan
      type(judgement_space_t), allocatable :: space
      type(error_t), allocatable :: error
      character(:), allocatable :: message
      real(dp), allocatable :: table(:, :), rows(:, :)
      integer :: positions(size(keys)), first, i

      do i = 1, size(keys)
         call find_varied_key(trim(keys(i)), positions(i), message)
      end do
      scene = base
      scene%task = task_campaign
      record = recorded
      if (verified) record = [recorded(:10), quantity_verified, quantity_harmonics]
      scene%campaign%record = record
      scene%resolved_input = ''
      table = values
      call plan_table(positions, table, plan)
      first = 2 + size(keys)
      allocate (rows(first + size(record) - 1 + row_harmonics, size(reported)), space)
      call solve_scenes(scene, plan, 1_int64, space, rows, error)
      if (allocated(error)) then
         reported%status = 'not_written'
         return
      end if
      do i = 1, size(reported)
         associate (row => rows(first:, i))
            reported(i)%status = status_name(nint(row(1)))
            reported(i)%judged = is_success(nint(row(1)))
            if (.not. reported(i)%judged) cycle
            reported(i)%extremes = row(2:7)
            if (.not. scene%contact%backlash > 0.0_dp) reported(i)%extremes(5:) = 0.0_dp
            reported(i)%class = quantity_word(quantity_rattle_class, nint(row(8)))
            reported(i)%sampling_sufficient = row(9) > 0.5_dp
            reported(i)%orbit = nint(row(10))
            reported(i)%periods = nint(row(11))
            reported(i)%window = scene%spectrum%periods
            ! A motion that was found to repeat while it was followed is judged by one orbit, others by the whole window.
            if (reported(i)%orbit > 0 .and. nint(row(1)) == status_steady) reported(i)%window = reported(i)%orbit
            reported(i)%verification_asked = verified
            if (verified) reported(i)%verified = row(12) > 0.5_dp
            associate (before => size(record))
               reported(i)%harmonics(:row_harmonics) = row(before + 1:before + row_harmonics)
            end associate
            reported(i)%harmonic_count = row_harmonics
         end associate
      end do
   end subroutine rows_reported

   !> What a sweep reports of a value.
   subroutine value_reported(scene, state, reported)
      !> Scene with that value
      type(scene_t), intent(in) :: scene
      !> State that the value before has left, none: no film; on return that for the next one
      type(carried_state_t), intent(inout) :: state
      type(reported_t), intent(out) :: reported
      type(error_t), allocatable :: error
      type(judged_scene_t) :: judged
      type(judgement_space_t) :: space

      call solve_value(scene, state, space, judged, error)
      reported%status = status_name(judged%status)
      reported%judged = is_success(judged%status) .and. .not. allocated(error)
      reported%verification_asked = .false.
      if (.not. reported%judged) return
      reported%extremes = extremes_of(judged)
      reported%class = quantity_word(quantity_rattle_class, judged%rattle%class)
      ! The window is the orbit of a motion found steady.
      reported%window = scene%spectrum%periods
      if (judged%ending%periods < scene%solver%periods) reported%orbit = judged%orbit%period
      if (reported%orbit > 0) reported%window = reported%orbit
      reported%periods = judged%ending%periods
      reported%harmonics(1) = judged%rattle%spectrum%harmonics(1)
      reported%harmonic_count = 1
   end subroutine value_reported

end module reported_summary
