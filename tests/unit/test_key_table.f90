!> Tests of the key table: its lines hang together and agree with the codes of scene_types.
module test_key_table
   use checks, only: check_list_t
   use input_key, only: allowed_text, in_range, integer_kind, key_t, list_kind, logical_kind, real_kind, &
      reals_kind, text_kind
   use key_table, only: find_key, find_swept_key, key_name, keys, known_group, nearest_group, nearest_key, starts_group
   use kinds, only: dp
   use quantities, only: quantity_code, quantity_table
   use scene_types, only: column_names, compute_damping, compute_limits, compute_load, compute_pressure, &
      compute_profile, compute_rupture, compute_stiffness, iteration_newton, iteration_successive, &
      law_iso_viscous, law_piezo_viscous, method_newmark, method_taylor, &
      model_numerical, model_published, model_reynolds, predictor_extrapolated, predictor_previous, &
      rupture_half_pi, rupture_solved, rupture_solver_fast, rupture_solver_successive, speed_mean, &
      speed_sum, &
      task_campaign, task_film, task_motion, task_sweep, task_threshold, until_periods, until_steady, viscosity_barus, &
      viscosity_roelands
   use varied_keys, only: find_varied_key
   use word_list, only: split_words, word_position, word_t
   implicit none(type, external)
   private

   public :: run_key_table_tests

contains

   !> Runs every test of this topic.
   subroutine run_key_table_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('key_table')
      call test_lines(checks)
      call test_codes(checks)
      call test_recorded_quantities(checks)
      call test_varied_keys(checks)
      call test_ranges(checks)
      call test_hints(checks)
   end subroutine run_key_table_tests

   !> Each quantity stands in the place of its code, and what a campaign can record is what the key table allows.
   subroutine test_recorded_quantities(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      character(:), allocatable :: name
      integer :: i

      do i = 1, size(quantity_table)
         name = trim(quantity_table(i)%name)
         call checks%check(quantity_table(i)%code == i .and. quantity_code(name) == i, name//': its code is its place')
         call checks%check(index(quantity_table(i)%reported_in, 'campaign') > 0 .eqv. &
            word_position(trim(keys(find_key('campaign.record'))%choices), name) > 0, name//': a word of the key')
      end do
      call checks%check(quantity_code('everything') == 0, 'no quantity of this name')
   end subroutine test_recorded_quantities

   !> The keys that a campaign varies are numbers of the key table, and all numbers of the groups that make a motion.
   subroutine test_varied_keys(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      character(*), parameter :: groups(5) = [character(12) :: 'contact', 'lubricant', 'kinematics', 'load', 'film']
      character(:), allocatable :: message
      type(word_t), allocatable :: swept(:)
      logical :: is_number, is_varied
      integer :: i, position

      do i = 1, size(keys)
         is_number = keys(i)%kind == real_kind .or. keys(i)%kind == integer_kind
         call find_varied_key(key_name(i), position, message)
         is_varied = position > 0
         call checks%check(is_varied .eqv. len(message) == 0, trim(keys(i)%name)//': varied, or reported why not')
         call checks%check(is_number .or. .not. is_varied, trim(keys(i)%name)//': varied, so a number')
         if (any(groups == keys(i)%group)) &
            call checks%check(is_varied .eqv. keys(i)%kind == real_kind, &
                              trim(keys(i)%name)//': a number of a motion, so it can vary')
      end do
      allocate (swept, source=split_words(keys(find_key('sweep.key'))%choices))
      do i = 1, size(swept)
         call find_varied_key(key_name(find_swept_key(swept(i)%text)), position, message)
         call checks%check(position > 0, swept(i)%text//': swept, so it can vary')
      end do
   end subroutine test_varied_keys

   !> Every line is found under its own name only, its group stands together, its default and example are
   !> allowed, its deciding key exists and has those words, and nothing is cut off by the length of a field.
   subroutine test_lines(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      character(:), allocatable :: name
      integer :: i

      do i = 1, size(keys)
         name = trim(keys(i)%group)//' '//trim(keys(i)%name)
         call checks%check(find_key(keys(i)%group//'.'//keys(i)%name) == i, name//': found once')
         call checks%check(known_group(keys(i)%group), name//': group known')
         if (keys(i)%default /= 'required') call checks%check(is_allowed(keys(i), keys(i)%default), &
            name//': default')
         call checks%check(is_allowed(keys(i), keys(i)%example), name//': example')
         call checks%check(keys(i)%default /= 'required' .or. keys(i)%example /= '', &
            name//': required, so has an example')
         call checks%check(decider_exists(keys(i)), name//': its deciding key and words exist')
         call checks%check(keys(i)%sentence(len(keys(i)%sentence):) == ' ' .and. &
            index(trim(keys(i)%sentence), '.', back=.true.) == len_trim(keys(i)%sentence), &
            name//': whole sentence')
         call checks%check((keys(i)%unit == '') .eqv. any(keys(i)%kind == [logical_kind, text_kind, &
            list_kind]), &
            name//': a number has a unit')
         call checks%check(len(allowed_text(keys(i))) > 0, name//': allowed values in words')
      end do
      call checks%check(starts_group(1) .and. starts_group(size(keys) + 1), 'first group, and behind the last')
      do i = 2, size(keys)
         call checks%check(starts_group(i) .neqv. keys(i)%group == keys(i - 1)%group, &
            trim(keys(i)%group)//': begins where its first key stands')
         if (keys(i)%group == keys(i - 1)%group) cycle
         call checks%check(.not. any(keys(:i - 1)%group == keys(i)%group), &
            trim(keys(i)%group)//': group stands together')
      end do
      call checks%check(find_key('load.radius') == 0 .and. find_key('.') == 0, &
         'a key outside its group is not found')
      call checks%check(.not. known_group('loads'), 'unknown group')
   end subroutine test_lines

   !> Whether a default or example, if there is one, is an allowed value.
   logical function is_allowed(key, value) result(allowed)
      type(key_t), intent(in) :: key        !> Line of the table
      character(*), intent(in) :: value     !> Its default or example, may be empty

      real(dp) :: number
      integer :: stat, start, i

      allowed = .true.
      if (value == '') return
      select case (key%kind)
      case (real_kind, integer_kind, reals_kind)
         read (value, *, iostat=stat) number
         allowed = stat == 0 .and. in_range(key, number)
         if (key%kind == integer_kind) allowed = allowed .and. scan(value, '.eE') == 0
      case (logical_kind)
         allowed = value == '.true.' .or. value == '.false.'
      case default
         if (key%choices == '') return
         start = 1
         do i = 1, len_trim(value) + 1
            if (i <= len_trim(value)) then
               if (value(i:i) /= ' ') cycle
            end if
            allowed = allowed .and. word_position(trim(key%choices), value(start:i - 1)) > 0
            start = i + 1
         end do
      end select
   end function is_allowed

   !> Whether the rules of a key, ' & ' between two, name keys and their words: 'group.key=word[|word]', 'group.key[|group.key]' or
   !> 'without group.key'.
   logical function decider_exists(key) result(exists)
      type(key_t), intent(in) :: key  !> Line of the table

      character(:), allocatable :: rest, rule
      integer :: dot, equals, decider, bar

      exists = .true.
      rest = trim(key%used_when)
      do while (len(rest) > 0)
         rule = rest(:index(rest//' & ', ' & ') - 1)
         rest = rest(min(len(rest), len(rule) + 3) + 1:)
         equals = index(rule, '=')
         if (equals == 0) then
            if (index(rule, 'without ') == 1) rule = rule(9:)
            rule = rule//'|'
            do while (len(rule) > 0)
               bar = index(rule, '|')
               exists = exists .and. find_key(rule(:bar - 1)) > 0
               rule = rule(bar + 1:)
            end do
            cycle
         end if
         dot = index(rule, '.')
         exists = exists .and. dot > 1 .and. equals > dot + 1
         if (.not. exists) return
         decider = find_key(rule(:equals - 1))
         exists = decider > 0
         if (.not. exists) return
         rule = rule(equals + 1:)//'|'
         do while (len(rule) > 0)
            bar = index(rule, '|')
            exists = exists .and. word_position(trim(keys(decider)%choices), rule(:bar - 1)) > 0
            rule = rule(bar + 1:)
         end do
      end do
   end function decider_exists

   !> A code is the place of its word among the choices.
   subroutine test_codes(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer :: i

      call agree('film', 'law', 'iso-viscous', law_iso_viscous)
      call agree('film', 'law', 'piezo-viscous', law_piezo_viscous)
      call agree('film', 'model', 'published', model_published)
      call agree('film', 'model', 'reynolds', model_reynolds)
      call agree('film', 'model', 'numerical', model_numerical)
      call agree('film', 'rupture', 'half-pi', rupture_half_pi)
      call agree('film', 'rupture', 'solved', rupture_solved)
      call agree('film', 'rupture_solver', 'fast', rupture_solver_fast)
      call agree('film', 'rupture_solver', 'successive', rupture_solver_successive)
      call agree('solver', 'method', 'newmark', method_newmark)
      call agree('solver', 'method', 'taylor', method_taylor)
      call agree('solver', 'until', 'periods', until_periods)
      call agree('solver', 'until', 'steady', until_steady)
      call agree('solver', 'iteration', 'newton', iteration_newton)
      call agree('solver', 'iteration', 'successive', iteration_successive)
      call agree('solver', 'predictor', 'extrapolated', predictor_extrapolated)
      call agree('solver', 'predictor', 'previous', predictor_previous)
      call agree('scene', 'task', 'motion', task_motion)
      call agree('scene', 'task', 'film', task_film)
      call agree('scene', 'task', 'sweep', task_sweep)
      call agree('scene', 'task', 'campaign', task_campaign)
      call agree('scene', 'task', 'threshold', task_threshold)
      call agree('lubricant', 'viscosity_law', 'barus', viscosity_barus)
      call agree('lubricant', 'viscosity_law', 'roelands', viscosity_roelands)
      call agree('points', 'speed_reading', 'mean', speed_mean)
      call agree('points', 'speed_reading', 'sum', speed_sum)
      call agree('points', 'compute', 'rupture', compute_rupture)
      call agree('points', 'compute', 'load', compute_load)
      call agree('points', 'compute', 'stiffness', compute_stiffness)
      call agree('points', 'compute', 'damping', compute_damping)
      call agree('points', 'compute', 'pressure', compute_pressure)
      call agree('points', 'compute', 'limits', compute_limits)
      call agree('points', 'compute', 'profile', compute_profile)
      do i = 1, size(column_names)
         call agree('output', 'columns', trim(column_names(i)), i)
      end do

   contains

      !> One word, one code.
      subroutine agree(group, name, word, code)
         character(*), intent(in) :: group  !> Group of the key
         character(*), intent(in) :: name   !> Its name
         character(*), intent(in) :: word   !> One of its choices
         integer, intent(in) :: code        !> Constant of scene_types

         call checks%check(word_position(trim(keys(find_key(group//'.'//name))%choices), word) == code, &
            name//' '//word//': code')
      end subroutine agree

   end subroutine test_codes

   !> Open and closed bounds.
   subroutine test_ranges(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call expect('contact', 'radius', 0.0_dp, .false.)
      call expect('contact', 'radius', tiny(1.0_dp), .true.)
      call expect('contact', 'poisson_ratio', -1.0_dp, .false.)
      call expect('contact', 'poisson_ratio', 0.5_dp, .true.)
      call expect('contact', 'poisson_ratio', 0.51_dp, .false.)
      call expect('load', 'force_amplitude', 0.0_dp, .true.)
      call expect('load', 'force_amplitude', -tiny(1.0_dp), .false.)
      call expect('load', 'steady_force', -1.0e10_dp, .true.)
      call expect('solver', 'steps_per_period', 7.0_dp, .false.)
      call expect('solver', 'steps_per_period', 8.0_dp, .true.)
      call expect('solver', 'steps_per_period', 1.0e7_dp, .true.)
      call expect('spectrum', 'harmonic_threshold', 0.0_dp, .false.)
      call expect('spectrum', 'harmonic_threshold', 1.0_dp, .true.)

   contains

      !> One number for one key.
      subroutine expect(group, name, number, allowed)
         character(*), intent(in) :: group  !> Group of the key
         character(*), intent(in) :: name   !> Its name
         real(dp), intent(in) :: number     !> Number to judge
         logical, intent(in) :: allowed     !> Whether it is allowed

         call checks%check(in_range(keys(find_key(group//'.'//name)), number) .eqv. allowed, name//': bound')
      end subroutine expect

   end subroutine test_ranges

   !> Suggestions for misspelt keys and groups; allowed values in words.
   subroutine test_hints(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%check(index(nearest_key('contact', 'raduis'), ' radius') > 0, 'nearest key')
      call checks%check(index(nearest_key('lubricant', 'mass'), '&load') > 0, 'group where the key lives')
      call checks%check(index(nearest_key('load', repeat('x', 5000)), 'nearest') > 0, &
         'a very long name has a nearest key')
      call checks%check(nearest_group('lubricants') == 'lubricant', 'nearest group')
      call checks%check(allowed_text(keys(find_key('contact.poisson_ratio'))) == 'a number > -1.0 and <= 0.5', 'allowed numbers')
      call checks%check(index(allowed_text(keys(find_key('solver.steps_per_period'))), &
         'an integer >= 8 and <= ') == 1, &
         'allowed integers')
      call checks%check(allowed_text(keys(find_key('film.rupture'))) == "one of 'half-pi' 'solved'", &
         'allowed words')
   end subroutine test_hints

end module test_key_table
