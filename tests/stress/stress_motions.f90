!> Random gear scenes, all motions that the program reports of them compared with random starts of an independent solver.
!>
!>    stress_motions [--scenes N] [--first I] [--starts N] [--seed S] [--seconds T] [--csv FILE]
!>
!> Prints a table of what share of the motions was reported, and of every motion that was missed with more than `looked_into` of the
!> starts a line that shows the scene again. After T seconds of wall time no further scene is begun. The exit code is 1 if a motion
!> was missed that is louder than all reported and has more than that, or if a reported motion is none of the independent solver.
program stress_motions
   use, intrinsic :: iso_fortran_env, only: error_unit, int64
   use clock, only: wall_seconds
   use coexisting_motions, only: coexisting_motions_t, motion_summary_t
   use engine, only: motion_state_t
   use gear_motions, only: draw_gear_scene, drawn_keys, gear_scene_t, motions_reported, read_pairs, row_reported, reported_row_t
   use impact_steps, only: start_of_tooth, tooth_of_lane, tooth_t
   use kinds, only: dp
   use lobatto_rule, only: lobatto_rule_t, new_lobatto_rule
   use quantities, only: quantity_rattle_class, quantity_word
   use reference_check, only: reference_deviation
   use reference_motions, only: find_reference_motions, is_same_motion, motion_from_state, reference_motion_t, reference_motions_t
   use scene_types, only: scene_t
   use text, only: integer_text, real_text, short_text
   implicit none(type, external)

   !> Shares of the starts: motions that are counted, and those that are looked into one by one [-].
   real(dp), parameter :: counted = 0.05_dp, looked_into = 0.2_dp
   !> Relative difference of the acceleration rms within which a row reports a motion [-].
   real(dp), parameter :: same_rms = 0.05_dp
   !> Distance of states within which a motion repeats after a part of its period [-]; the reference is good for a tenth of it.
   real(dp), parameter :: same_period = 1.0e-3_dp
   !> Every so many scenes a grid about the scene is solved.
   integer(int64), parameter :: row_stride = 2_int64
   !> Ways of the program.
   integer, parameter :: alone = 1, row = 2
   character(*), parameter :: ways(2) = [character(48) :: 'alone, 29 starts', 'row of a campaign, 3 starts and neighbours']

   !> Counts of a way.
   type :: tally_t
      !> Scenes judged; of these with several motions above the counted share
      integer :: scenes = 0, several = 0
      !> Motions above that share, and reported ones among them; the same of the loudest one of each scene
      integer :: motions = 0, reported = 0, loudest_reported = 0
      !> Motions missed above looked_into, and those of them that are louder than all reported
      integer :: missed = 0, missed_loud = 0
      !> Scenes that are reported to have one motion while another has more than looked_into
      integer :: false_single = 0
   end type tally_t

   integer(int64) :: scenes = 2000_int64, first = 0_int64, seed = 1_int64, number
   integer :: starts = 40, unit = 0, unit_status
   integer :: solved = 0, unsettled_scenes = 0, unconfirmed = 0, lost = 0, starts_failed = 0, reference_periods = 0, &
              program_periods(2) = 0, multiples = 0, several_reported = 0
   real(dp) :: seconds = huge(1.0_dp), began, spent(3) = 0.0_dp
   type(tally_t) :: tallies(2)
   type(scene_t), allocatable :: pairs(:)
   type(lobatto_rule_t) :: rule
   character(512) :: csv = ''

   call read_arguments()
   rule = new_lobatto_rule()
   if (.not. reference_deviation(rule) <= 1.0_dp) error stop 'stress_motions: the reference misses the known motions'
   call read_pairs(pairs)
   if (csv /= '') then
      open (newunit=unit, file=trim(csv), status='replace', action='write', iostat=unit_status)
      if (unit_status /= 0) error stop 'stress_motions: the file cannot be written'
      write (unit, '(a)') 'scene,pair,speed,temperature,stiffness,scale,damping,share,rms,period,alone,row'
   end if
   began = wall_seconds()
   !$omp parallel do schedule(dynamic) default(shared)
   do number = first, first + scenes - 1_int64
      if (wall_seconds() - began < seconds) call run_scene(number)
   end do
   !$omp end parallel do
   call print_table()
   if (sum(tallies%missed_loud) > 0 .or. unconfirmed > 0) stop 1

contains

   !> One scene.
   subroutine run_scene(number)
      integer(int64), intent(in) :: number
      type(gear_scene_t) :: drawn
      type(coexisting_motions_t) :: reported
      type(reported_row_t) :: reported_row
      type(reference_motions_t) :: found
      type(reference_motion_t), allocatable :: motions(:)
      type(tooth_t) :: tooth
      real(dp) :: times(4)
      integer :: periods(2), false, longer
      logical :: judged

      call draw_gear_scene(pairs, seed, number, drawn)
      tooth = tooth_of_lane(drawn%resolved%problem)
      times = wall_seconds()
      allocate (motions(0))
      false = 0
      longer = 0
      call motions_reported(drawn, reported, periods, judged)
      times(2) = wall_seconds()
      if (modulo(number, row_stride) == 0_int64) call row_reported(drawn, reported_row)
      times(3) = wall_seconds()
      if (judged) then
         call follow_reported(drawn, number, tooth, reported, motions, false, longer)
         call find_reference_motions(drawn%resolved%problem, tooth, rule, starts, seed, number, motions, found)
      end if
      times(4) = wall_seconds()
      !$omp critical (count_scenes)
      spent = spent + times(2:) - times(:3)
      if (.not. judged) then
         lost = lost + 1
         print '(a)', 'no window: '//scene_words(drawn, number)
      else
         solved = solved + 1
         if (found%unsettled > 0) unsettled_scenes = unsettled_scenes + 1
         unconfirmed = unconfirmed + false
         multiples = multiples + longer
         if (size(reported%motions) > 1) several_reported = several_reported + 1
         starts_failed = starts_failed + found%failed
         reference_periods = reference_periods + found%periods
         program_periods = program_periods + periods
         call count_motions(drawn, number, tooth, found, reported, motions, reported_row)
      end if
      !$omp end critical (count_scenes)
   end subroutine run_scene

   !> The motions that are reported, as the independent solver has them.
   subroutine follow_reported(drawn, number, tooth, reported, motions, false, longer)
      type(gear_scene_t), intent(in) :: drawn
      integer(int64), intent(in) :: number
      type(tooth_t), intent(in) :: tooth
      type(coexisting_motions_t), intent(in) :: reported
      !> Those that repeat; no states: it does not stay there
      type(reference_motion_t), allocatable, intent(out) :: motions(:)
      !> How many of them it leaves, and how many repeat after a part of the reported period
      integer, intent(out) :: false
      integer, intent(out) :: longer
      type(reference_motion_t) :: twice, part
      logical :: solved
      integer :: i, n

      allocate (motions(size(reported%motions)))
      false = 0
      longer = 0
      do i = 1, size(motions)
         associate (motion => reported%motions(i))
            if (motion%period == 0) cycle
            call motion_from_state(tooth, rule, start_of_tooth(drawn%resolved%problem, motion_state_t(numbers=motion%state), &
                                                               0.0_dp), 2*motion%period, twice, solved)
            motions(i) = twice
            if (solved) then
               motions(i)%states = twice%states(:motion%period)
               twice%states = twice%states(motion%period + 1:)
               solved = is_same_motion(tooth, motions(i), twice)
            end if
            if (.not. solved) then
               false = false + 1
               if (allocated(motions(i)%states)) deallocate (motions(i)%states)
               print '(3a)', 'reported, but left: ', scene_words(drawn, number), ', '//motion_words(motion)
               cycle
            end if
            do n = 1, motion%period/2
               if (modulo(motion%period, n) /= 0) cycle
               part%states = motions(i)%states(:n)
               if (.not. is_same_motion(tooth, part, motions(i), same_period)) cycle
               longer = longer + 1
               print '(3a)', 'repeats after '//integer_text(n)//' periods: ', scene_words(drawn, number), ', '//motion_words(motion)
               exit
            end do
         end associate
      end do
   end subroutine follow_reported

   !> Count which motions of the independent solver are reported.
   subroutine count_motions(drawn, number, tooth, found, reported, motions, reported_row)
      type(gear_scene_t), intent(in) :: drawn
      integer(int64), intent(in) :: number
      type(tooth_t), intent(in) :: tooth
      type(reference_motions_t), intent(in) :: found
      type(coexisting_motions_t), intent(in) :: reported
      !> As of follow_reported
      type(reference_motion_t), intent(in) :: motions(:)
      type(reported_row_t), intent(in) :: reported_row
      real(dp) :: share(size(found%motions) + 1), rms(size(found%motions) + 1), loudest(2)
      logical :: is_reported(size(found%motions) + 1, 2), is_counted(size(found%motions) + 1)
      integer :: way, i, n

      n = size(found%motions)
      share(:n) = real(found%motions%starts, dp)/real(found%starts, dp)
      rms(:n) = found%motions%acceleration_rms
      ! Those that do not repeat are one motion.
      share(n + 1) = real(found%unsettled, dp)/real(found%starts, dp)
      rms(n + 1) = found%unsettled_rms
      do i = 1, n
         is_reported(i, alone) = is_reported_alone(tooth, found%motions(i), motions)
         is_reported(i, row) = is_reported_in_row(rms(i), reported_row)
      end do
      is_reported(n + 1, alone) = any(reported%motions%period == 0) .or. reported%unsettled_starts > 0
      is_reported(n + 1, row) = reported_row%unsettled > 0
      loudest = [maxval(reported%motions%acceleration_rms), reported_row%loudest_rms]
      is_counted = share > counted
      do way = 1, 2
         if (way == row .and. .not. reported_row%judged) cycle
         associate (tally => tallies(way))
            tally%scenes = tally%scenes + 1
            if (count(is_counted) > 1) tally%several = tally%several + 1
            tally%motions = tally%motions + count(is_counted)
            tally%reported = tally%reported + count(is_counted .and. is_reported(:, way))
            if (any(is_counted)) then
               if (is_reported(maxloc(rms, dim=1, mask=is_counted), way)) tally%loudest_reported = tally%loudest_reported + 1
            end if
            if (merge(size(reported%motions), reported_row%motions, way == alone) == 1 .and. &
                any(share > looked_into .and. .not. is_reported(:, way))) tally%false_single = tally%false_single + 1
            do i = 1, n + 1
               if (is_reported(i, way) .or. share(i) <= looked_into) cycle
               tally%missed = tally%missed + 1
               if (rms(i) > (1.0_dp + same_rms)*loudest(way)) tally%missed_loud = tally%missed_loud + 1
               print '(a)', 'missed '//trim(ways(way))//': '//scene_words(drawn, number)//', '//short_text(100.0_dp*share(i), 3)// &
                  ' % of the starts, '//short_text(rms(i), 4)//' m/s2, period '// &
                  integer_text(period_of(found, i))//'; reported '//reported_words(way, reported, reported_row)
            end do
         end associate
      end do
      if (unit == 0) return
      do i = 1, n + 1
         if (share(i) > 0.0_dp) write (unit, '(i0, ",", i0, 7(",", es14.6), ",", i0, 2(",", i0))') number, drawn%pair, &
            drawn%values, drawn%resolved%damping_ratio, share(i), rms(i), period_of(found, i), &
            merge(1, 0, is_reported(i, alone)), merge(merge(1, 0, is_reported(i, row)), -1, reported_row%judged)
      end do
      flush (unit)
   end subroutine count_motions

   !> Whether one of the reported motions is this one.
   pure logical function is_reported_alone(tooth, motion, motions)
      type(tooth_t), intent(in) :: tooth
      type(reference_motion_t), intent(in) :: motion
      !> As of follow_reported
      type(reference_motion_t), intent(in) :: motions(:)
      integer :: i

      is_reported_alone = .true.
      do i = 1, size(motions)
         if (.not. allocated(motions(i)%states)) cycle
         if (is_same_motion(tooth, motion, motions(i))) return
      end do
      is_reported_alone = .false.
   end function is_reported_alone

   !> Periods of the force after which a motion repeats, 0: those that do not.
   pure integer function period_of(found, place) result(period)
      type(reference_motions_t), intent(in) :: found
      integer, intent(in) :: place

      period = 0
      if (place <= size(found%motions)) period = size(found%motions(place)%states)
   end function period_of

   !> Whether a row reports a motion: by the rms of the loudest, quietest or own one, or between them where the row counts more.
   pure logical function is_reported_in_row(rms, reported_row) result(is_reported)
      real(dp), intent(in) :: rms
      type(reported_row_t), intent(in) :: reported_row

      is_reported = any(abs([reported_row%rest_rms, reported_row%loudest_rms, reported_row%quietest_rms] - rms) &
                <= same_rms*rms) .or. &
                (reported_row%motions > 2 .and. rms > reported_row%quietest_rms .and. rms < reported_row%loudest_rms)
   end function is_reported_in_row

   !> The scene in words that show it again.
   function scene_words(drawn, number) result(words)
      type(gear_scene_t), intent(in) :: drawn
      integer(int64), intent(in) :: number
      character(:), allocatable :: words
      integer :: i

      words = 'scene '//integer_text(number)//' ('//trim(drawn%scene%name)
      do i = 1, size(drawn_keys)
         words = words//' --set '//trim(drawn_keys(i))//'='//real_text(drawn%values(i))
      end do
      words = words//'), damping '//short_text(drawn%resolved%damping_ratio, 3)
   end function scene_words

   !> A reported motion.
   function motion_words(motion) result(words)
      type(motion_summary_t), intent(in) :: motion
      character(:), allocatable :: words

      words = trim(quantity_word(quantity_rattle_class, motion%class))//' '//short_text(motion%acceleration_rms, 4)// &
              ' m/s2, period '//integer_text(motion%period)//', '//integer_text(motion%starts)//' starts'
   end function motion_words

   !> What was reported.
   function reported_words(way, reported, reported_row) result(words)
      integer, intent(in) :: way
      type(coexisting_motions_t), intent(in) :: reported
      type(reported_row_t), intent(in) :: reported_row
      character(:), allocatable :: words
      integer :: i

      if (way == row) then
         words = integer_text(reported_row%motions)//' motions, '//short_text(reported_row%quietest_rms, 4)//' to '// &
                 short_text(reported_row%loudest_rms, 4)//' m/s2'
         return
      end if
      words = ''
      do i = 1, size(reported%motions)
         if (i > 1) words = words//'; '
         words = words//motion_words(reported%motions(i))
      end do
      words = words//'; '//integer_text(reported%unsettled_starts)//' unsettled'
   end function reported_words

   !> The outcome.
   subroutine print_table()
      integer :: way

      print '(a)', '| what is reported | scenes | with several motions | motions above 5 % | reported | loudest reported | '// &
         'missed above 20 % | louder than all reported | reported as one, another above 20 % |'
      print '(a)', '|---|---:|---:|---:|---:|---:|---:|---:|---:|'
      do way = 1, 2
         associate (tally => tallies(way))
            print '(a)', '| '//trim(ways(way))//' | '//integer_text(tally%scenes)//' | '//integer_text(tally%several)//' | '// &
               integer_text(tally%motions)//' | '//percent(tally%reported, tally%motions)//' | '// &
               percent(tally%loudest_reported, tally%scenes)//' | '//integer_text(tally%missed)//' | '// &
               integer_text(tally%missed_loud)//' | '//integer_text(tally%false_single)//' |'
         end associate
      end do
      print '(a)', ''
      print '(a, i0, a, i0, a, i0, a)', 'scenes from ', first, ' on, seed ', seed, ', ', starts, ' starts of the reference each'
      print '(a)', integer_text(solved)//' scenes judged, '//integer_text(lost)//' had no window; in '// &
         integer_text(unsettled_scenes)//' some starts do not repeat; '//integer_text(starts_failed)//' starts could not be solved'
      print '(a)', 'several motions are reported of '//integer_text(several_reported)// &
         ' scenes; reported motions that the reference leaves: '//integer_text(unconfirmed)// &
         '; with a longer period than the shortest: '//integer_text(multiples)
      print '(a)', 'periods solved from the own start '//integer_text(program_periods(1))//', from the others '// &
         integer_text(program_periods(2))//', by the reference '//integer_text(reference_periods)
      print '(3(a, f0.1), a)', 'seconds of scenes alone ', spent(1), ', of grids ', spent(2), ', of the reference ', spent(3), &
         ', all threads together'
   end subroutine print_table

   !> A share in percent.
   function percent(part, whole) result(words)
      integer, intent(in) :: part
      integer, intent(in) :: whole
      character(:), allocatable :: words

      words = '-'
      if (whole > 0) words = short_text(100.0_dp*real(part, dp)/real(whole, dp), 4)//' %'
   end function percent

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
         case ('--first')
            read (value, *, iostat=failure) first
         case ('--starts')
            read (value, *, iostat=failure) starts
         case ('--seed')
            read (value, *, iostat=failure) seed
         case ('--seconds')
            read (value, *, iostat=failure) seconds
         case ('--csv')
            csv = value
         case default
            failure = 1
         end select
      end do
      if (failure == 0 .and. scenes > 0_int64 .and. first >= 0_int64 .and. starts > 0) return
      write (error_unit, '(a)') 'usage: stress_motions [--scenes N] [--first I] [--starts N] [--seed S] [--seconds T] [--csv FILE]'
      stop 2
   end subroutine read_arguments

end program stress_motions
