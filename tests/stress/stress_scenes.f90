!> Random scenes by every engine, each compared with an independent tighter solution.
!>
!>    stress_scenes [--scenes N] [--seed S] [--first I] [--csv FILE] [--failures FILE] [--list OUTCOME]
!>                  [--accuracy A]
!>
!> Prints the table of outcomes and, of every silent failure and all that is listed, a namelist that shows it
!> again. The exit code is 1 if there is a silent failure. The result does not depend on the number of threads
!> (OMP_NUM_THREADS).
program stress_scenes
   use, intrinsic :: iso_fortran_env, only: error_unit, output_unit
   use clock, only: wall_seconds
   use kinds, only: dp, int64
   use random_scenes, only: draw_group, draw_scene, drawn_scene_t, group_of, group_size, group_t, law_names
   use scene_namelist, only: print_namelist
   use scene_status, only: status_name
   use stress_engines, only: engine_names, engines, run_engine, set_solver
   use stress_outcomes, only: outcome_names, outcome_silent, outcome_t, outcomes
   use stress_references, only: reference_t, solve_references
   use stress_table, only: print_markdown, print_ratios, tally_t, write_csv
   use text, only: integer_text, short_text
   implicit none(type, external)

   integer(int64) :: scenes = 100000_int64, seed = 1_int64, first = 0_int64
   real(dp) :: accuracy = 0.0_dp
   character(512) :: csv = '', failures = ''
   logical :: listed(outcomes) = .false., written
   type(tally_t) :: tally
   real(dp) :: seconds(0:engines) = 0.0_dp, started, slowest = 0.0_dp
   integer(int64) :: group, slowest_group = 0_int64
   integer :: unit

   call read_arguments()
   unit = output_unit
   if (failures /= '') open (newunit=unit, file=trim(failures), status='replace', action='write')
   started = wall_seconds()
   !$omp parallel do schedule(dynamic) default(shared)
   do group = group_of(first), group_of(first + scenes - 1_int64)
      call run_group(group)
   end do
   !$omp end parallel do
   call print_markdown(tally)
   print '(a)', ''
   call print_ratios(tally)
   print '(a)', ''
   print '(a, i0, a, i0, a, i0, a, f0.1, a)', 'scenes ', first, ' to ', first + scenes - 1_int64, ', seed ', &
      seed, ', ', wall_seconds() - started, ' s'
   print '(a, f0.1, 20(a, f0.1))', 'seconds by engine, references first: ', seconds(0), &
      (', ', seconds(group), group=1, engines)
   print '(a, i0, a, f0.2, a)', 'slowest group: ', slowest_group, ', ', slowest, ' s'
   print '(a, i0)', 'silent failures: ', tally%failures()
   if (csv /= '') then
      call write_csv(trim(csv), tally, written)
      if (.not. written) error stop 'stress_scenes: the CSV file cannot be written'
   end if
   if (tally%failures() > 0_int64) stop 1

contains

   !> All engines on the scenes of a group.
   subroutine run_group(number)
      integer(int64), intent(in) :: number
      type(group_t) :: shared
      type(drawn_scene_t), allocatable :: drawn(:)
      type(reference_t), allocatable :: references(:)
      type(outcome_t), allocatable :: results(:, :)
      real(dp) :: spent(0:engines), group_started
      integer :: engine, i
      integer(int64) :: from, to

      shared = draw_group(seed, number)
      if (accuracy > 0.0_dp) shared%accuracy = accuracy
      from = max(first, number*group_size)
      to = min(first + scenes, (number + 1_int64)*group_size) - 1_int64
      allocate (drawn(to - from + 1_int64), references(to - from + 1_int64), results(to - from + 1_int64, &
         engines))
      do i = 1, size(drawn)
         drawn(i) = draw_scene(seed, from + int(i - 1, int64))
         drawn(i)%scene%solver%accuracy = shared%accuracy
      end do
      group_started = wall_seconds()
      spent = 0.0_dp
      call solve_references(shared, drawn, references)
      spent(0) = wall_seconds() - group_started
      do engine = 1, engines
         spent(engine) = wall_seconds()
         call run_engine(engine, shared, drawn, references, results(:, engine))
         spent(engine) = wall_seconds() - spent(engine)
      end do
      !$omp critical (count_outcomes)
      seconds = seconds + spent
      if (sum(spent) > slowest) then
         slowest = sum(spent)
         slowest_group = number
      end if
      do engine = 1, engines
         do i = 1, size(drawn)
            call tally%add(shared%law, engine, results(i, engine))
            if (results(i, engine)%code == outcome_silent .or. listed(results(i, engine)%code)) &
               call report(shared, drawn(i), references(i), engine, results(i, engine))
         end do
      end do
      !$omp end critical (count_outcomes)
   end subroutine run_group

   !> A scene that failed, ready to run.
   subroutine report(shared, drawn, reference, engine, outcome)
      type(group_t), intent(in) :: shared
      type(drawn_scene_t), intent(in) :: drawn
      type(reference_t), intent(in) :: reference
      integer, intent(in) :: engine
      type(outcome_t), intent(in) :: outcome
      type(drawn_scene_t) :: again
      character(:), allocatable :: remark

      again = drawn
      call set_solver(engine, again%scene)
      remark = 'scene '//integer_text(drawn%number)//', '//trim(law_names(shared%law))//', '// &
         trim(engine_names(engine))// &
               ': '//trim(outcome_names(outcome%code))//' '//trim(outcome%fault)
      if (outcome%error >= 0.0_dp) remark = remark//', error '//short_text(outcome%error, 3)// &
         ', accuracy '// &
                                            short_text(shared%accuracy, 3)
      remark = remark//', growth '//short_text(reference%growth, 3)
      if (.not. reference%exists) remark = remark//', tight solution: '//status_name(reference%status)
      call print_namelist(unit, again, remark)
   end subroutine report

   !> Command line.
   subroutine read_arguments()
      character(512) :: word, value
      integer :: i, failure

      failure = 0
      i = 1
      do while (i <= command_argument_count() .and. failure == 0)
         call get_command_argument(i, word)
         value = ''
         if (i < command_argument_count()) call get_command_argument(i + 1, value)
         i = i + 2
         select case (word)
         case ('--scenes')
            read (value, *, iostat=failure) scenes
         case ('--seed')
            read (value, *, iostat=failure) seed
         case ('--first')
            read (value, *, iostat=failure) first
         case ('--csv')
            csv = value
         case ('--failures')
            failures = value
         case ('--list')
            listed = listed .or. outcome_names == value
            if (.not. any(outcome_names == value)) failure = 1
         case ('--accuracy')
            read (value, *, iostat=failure) accuracy
         case default
            failure = 1
         end select
      end do
      if (failure == 0 .and. scenes > 0_int64 .and. first >= 0_int64) return
      write (error_unit, '(a)') 'usage: stress_scenes [--scenes N] [--seed S] [--first I] [--csv FILE]', &
         '   [--failures FILE] [--list OUTCOME] [--accuracy A]'
      stop 2
   end subroutine read_arguments

end program stress_scenes
