!> Random scenes solved and judged as a user has them judged, each summary, each row of a campaign and each value of a
!> sweep compared with the true motion.
!>
!>    stress_summaries [--scenes N] [--campaigns N] [--sweeps N] [--seed S] [--first I] [--longest STEPS] [--failures FILE]
!>       [--list OUTCOME]
!>
!> Scenes that are likely to take more than `--longest` steps are not solved, but counted as too long.
!> Prints the table of outcomes and, of every silent failure and all that is listed, a namelist that shows it
!> again. The exit code is 1 if there is a silent failure. The result does not depend on the number of threads
!> (OMP_NUM_THREADS).
program stress_summaries
   use, intrinsic :: iso_fortran_env, only: error_unit, output_unit
   use clock, only: wall_seconds
   use judged_scenes, only: campaign_keys, campaign_rows, draw_campaign, draw_judged_scene, draw_sweep, is_gear, sweep_values
   use kinds, only: dp, int64
   use lobatto_rule, only: lobatto_rule_t, new_lobatto_rule
   use random_scenes, only: drawn_scene_t, law_names, laws
   use reference_check, only: reference_deviation
   use run_sweep, only: carried_state_t
   use scene_namelist, only: print_namelist
   use scene_types, only: scene_t
   use summary_outcomes, only: outcome_of_row, outcome_of_summary, reported_long, reported_names, reported_outcome_t, &
                               reported_outcomes, reported_silent
   use text, only: integer_text
   use reported_summary, only: rows_reported, steps_expected, summary_reported, reported_t, value_reported
   implicit none(type, external)

   !> The scenes of a table: all decades, loose gears, rows of campaigns without and with verification, values of sweeps.
   character(*), parameter :: kinds_of_scenes(5) = [character(16) :: 'all decades', 'loose gears', 'campaign rows', &
      'verified rows', 'sweep values']
   integer(int64) :: scenes = 100000_int64, campaigns = -1_int64, sweeps = -1_int64, seed = 1_int64, first = 0_int64, number, &
      longest = huge(1_int64)
   integer(int64) :: counts(reported_outcomes, laws, size(kinds_of_scenes)) = 0_int64
   character(512) :: failures = ''
   logical :: listed(reported_outcomes) = .false.
   real(dp) :: started, seconds(2) = 0.0_dp, row_seconds(2) = 0.0_dp, value_seconds(2) = 0.0_dp, slowest = 0.0_dp
   integer(int64) :: slowest_scene = 0_int64
   type(lobatto_rule_t) :: rule
   integer :: unit

   call read_arguments()
   unit = output_unit
   if (failures /= '') open (newunit=unit, file=trim(failures), status='replace', action='write')
   rule = new_lobatto_rule()
   if (.not. reference_deviation(rule) <= 1.0_dp) error stop 'stress_summaries: the reference misses the known motions'
   started = wall_seconds()
   !$omp parallel do schedule(dynamic) default(shared)
   do number = first, first + scenes - 1_int64
      call run_scene(number)
   end do
   !$omp end parallel do
   if (campaigns < 0_int64) campaigns = scenes/int(4*campaign_rows, int64)
   !$omp parallel do schedule(dynamic) default(shared)
   do number = first, first + campaigns - 1_int64
      call run_campaign(number)
   end do
   !$omp end parallel do
   if (sweeps < 0_int64) sweeps = scenes/int(4*sweep_values, int64)
   !$omp parallel do schedule(dynamic) default(shared)
   do number = first, first + sweeps - 1_int64
      call run_values(number)
   end do
   !$omp end parallel do
   call print_table()
   print '(a)', ''
   print '(a, i0, a, i0, a, i0, a, f0.1, a)', 'scenes ', first, ' to ', first + scenes - 1_int64, ', seed ', seed, ', ', &
      wall_seconds() - started, ' s'
   print '(6(a, f0.1), a)', 'seconds of the program ', seconds(1), ', of the reference ', seconds(2), '; of campaigns ', &
      row_seconds(1), ' and ', row_seconds(2), '; of sweeps ', value_seconds(1), ' and ', value_seconds(2), ', all threads together'
   print '(a, i0, a, f0.2, a)', 'slowest scene: ', slowest_scene, ', ', slowest, ' s'
   print '(a, i0)', 'silent failures: ', sum(counts(reported_silent, :, :))
   if (any(counts(reported_silent, :, :) > 0_int64)) stop 1

contains

   !> One scene.
   subroutine run_scene(number)
      integer(int64), intent(in) :: number
      type(drawn_scene_t) :: drawn
      type(reported_t) :: reported
      type(reported_outcome_t) :: outcome
      real(dp) :: times(3)
      integer :: law

      call draw_judged_scene(seed, number, drawn, law)
      times = wall_seconds()
      if (all(steps_expected([drawn]) <= longest)) then
         call summary_reported(drawn, reported)
         times(2) = wall_seconds()
         call outcome_of_summary(drawn, rule, reported, outcome)
         times(3) = wall_seconds()
      else
         outcome = reported_outcome_t(code=reported_long, fault='')
      end if
      !$omp critical (count_summaries)
      if (times(3) - times(1) > slowest) then
         slowest = times(3) - times(1)
         slowest_scene = number
      end if
      call note(drawn, merge(2, 1, is_gear(number)), law, 'scene', outcome)
      seconds = seconds + times(2:) - times(:2)
      !$omp end critical (count_summaries)
   end subroutine run_scene

   !> One campaign.
   subroutine run_campaign(number)
      integer(int64), intent(in) :: number
      type(scene_t) :: base
      type(drawn_scene_t), allocatable :: drawn(:)
      type(reported_t), allocatable :: reported(:)
      type(reported_outcome_t) :: outcome
      real(dp) :: values(size(campaign_keys), campaign_rows), times(3)
      logical :: verified, too_long
      integer :: law, i

      allocate (drawn(campaign_rows), reported(campaign_rows))
      call draw_campaign(seed, number, base, law, values, drawn)
      times(1) = wall_seconds()
      verified = modulo(number, 4_int64) == 3_int64
      too_long = sum(steps_expected(drawn)) > longest/3_int64*int(campaign_rows, int64)
      if (.not. too_long) call rows_reported(base, campaign_keys, values, verified, reported)
      times(2) = wall_seconds()
      do i = 1, campaign_rows
         if (too_long) then
            outcome = reported_outcome_t(code=reported_long, fault='')
         else
            call outcome_of_row(drawn(i), rule, reported(i), outcome)
         end if
         !$omp critical (count_summaries)
         call note(drawn(i), merge(4, 3, verified), law, 'row', outcome)
         !$omp end critical (count_summaries)
      end do
      times(3) = wall_seconds()
      !$omp critical (count_summaries)
      row_seconds = row_seconds + times(2:) - times(:2)
      !$omp end critical (count_summaries)
   end subroutine run_campaign

   !> One sweep.
   subroutine run_values(number)
      integer(int64), intent(in) :: number
      type(drawn_scene_t) :: drawn(sweep_values)
      type(reported_t) :: reported
      type(reported_outcome_t) :: outcome
      type(carried_state_t) :: state
      real(dp) :: times(3)
      logical :: too_long
      integer :: law, i

      too_long = .false.
      call draw_sweep(seed, number, drawn, law)
      do i = 1, sweep_values
         associate (value => drawn(i))
            value%before = state
            if (state%film > 0.0_dp) then
               value%scene%film%initial_film = state%film
               value%scene%film%initial_velocity = state%velocity
            end if
         end associate
         times = wall_seconds()
         ! A sweep hands on where a value ends.
         if (.not. too_long) too_long = any(steps_expected(drawn(i:i)) > longest)
         if (too_long) then
            outcome = reported_outcome_t(code=reported_long, fault='')
         else
            call value_reported(drawn(i)%scene, state, reported)
            times(2) = wall_seconds()
            call outcome_of_row(drawn(i), rule, reported, outcome)
            times(3) = wall_seconds()
         end if
         !$omp critical (count_summaries)
         call note(drawn(i), 5, law, 'value', outcome)
         value_seconds = value_seconds + times(2:) - times(:2)
         !$omp end critical (count_summaries)
      end do
   end subroutine run_values

   !> Count an outcome, and write down a scene that failed.
   subroutine note(drawn, place, law, kind_of_scene, outcome)
      type(drawn_scene_t), intent(in) :: drawn
      !> Place in kinds_of_scenes
      integer, intent(in) :: place
      integer, intent(in) :: law
      character(*), intent(in) :: kind_of_scene
      type(reported_outcome_t), intent(in) :: outcome

      counts(outcome%code, law, place) = counts(outcome%code, law, place) + 1_int64
      if (.not. (outcome%code == reported_silent .or. listed(outcome%code))) return
      call print_namelist(unit, drawn, kind_of_scene//' '//integer_text(drawn%number)//', seed '//integer_text(seed)//', '// &
                          trim(law_names(law))//': '//trim(reported_names(outcome%code))//' '//outcome%fault)
      flush (unit)
   end subroutine note

   !> Outcomes by scenes and law.
   subroutine print_table()
      integer :: place, law, i

      print '(100a)', '| scenes | film |', (' '//trim(reported_names(i))//' |', i=1, reported_outcomes)
      print '(100a)', '|---|---|', ('---:|', i=1, reported_outcomes)
      do place = 1, size(kinds_of_scenes)
         if (.not. any(counts(:, :, place) > 0_int64)) cycle
         do law = 1, laws
            if (any(counts(:, law, place) > 0_int64)) &
               call print_row(trim(kinds_of_scenes(place)), trim(law_names(law)), counts(:, law, place))
         end do
         call print_row(trim(kinds_of_scenes(place)), '**all**', sum(counts(:, :, place), dim=2))
      end do
   end subroutine print_table

   !> One row.
   subroutine print_row(scene_kind, film, row)
      character(*), intent(in) :: scene_kind
      character(*), intent(in) :: film
      integer(int64), intent(in) :: row(:)
      integer :: i

      print '(100a)', '| '//scene_kind//' | '//film//' |', (' '//integer_text(row(i))//' |', i=1, reported_outcomes)
   end subroutine print_row

   !> Command line.
   subroutine read_arguments()
      character(512) :: word, value
      integer :: i, failure

      failure = modulo(command_argument_count(), 2)
      do i = 1, command_argument_count() - 1, 2
         if (failure /= 0) exit
         call get_command_argument(i, word)
         call get_command_argument(i + 1, value)
         select case (word)
         case ('--scenes')
            read (value, *, iostat=failure) scenes
         case ('--campaigns')
            read (value, *, iostat=failure) campaigns
         case ('--sweeps')
            read (value, *, iostat=failure) sweeps
         case ('--seed')
            read (value, *, iostat=failure) seed
         case ('--first')
            read (value, *, iostat=failure) first
         case ('--longest')
            read (value, *, iostat=failure) longest
         case ('--failures')
            failures = value
         case ('--list')
            listed = listed .or. reported_names == value
            if (.not. any(reported_names == value)) failure = 1
         case default
            failure = 1
         end select
      end do
      if (failure == 0 .and. scenes > 0_int64 .and. first >= 0_int64) return
      write (error_unit, '(a)') 'usage: stress_summaries [--scenes N] [--campaigns N] [--sweeps N] [--seed S] [--first I]', &
         '   [--longest STEPS] [--failures FILE] [--list OUTCOME]'
      stop 2
   end subroutine read_arguments

end program stress_summaries
