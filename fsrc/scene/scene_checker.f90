!> What must hold between the keys of a scene. What a single key must be stands in the key table.
module scene_checker
   use errors, only: error_t
   use force_checker, only: check_force, check_gear, check_shaft
   use input_key, only: allowed_text, in_range, is_computable, not_computable_text, real_kind, reals_kind
   use key_table, only: find_key, find_swept_key, key_name, keys
   use keys_in_use, only: in_use, reason_unused
   use kinds, only: dp
   use mistaken_units, only: likely_reason, meant_behind
   use memory, only: expect_memory
   use quantities, only: a_count, a_number, quantity_code, quantity_table
   use scene_input, only: scene_input_t
   use scene_rules, only: broken_rules, rule_t
   use scene_types, only: scene_t, set_number
   use text, only: integer_text
   use word_list, only: split_words, word_t
   implicit none(type, external)
   private

   public :: check_together

contains

   !> Add a fault for every rule that the input breaks.
   subroutine check_together(input)
      type(scene_input_t), intent(inout) :: input

      call check_computable(input)
      call check_required(input)
      call check_used(input)
      if (input%has_group('gear')) then
         call check_gear(input)
      else
         call check_radius(input)
         call check_speed(input)
      end if
      call check_film_model(input)
      if (input%word('solver.method') == 'newmark') call check_newmark(input)
      call check_rules(input)
      call check_no_word_twice(input, 'output.columns')
      call check_columns(input)
      call check_no_word_twice(input, 'points.compute')
      call check_no_word_twice(input, 'campaign.vary')
      call check_no_word_twice(input, 'campaign.record')
      if (input%word('scene.task') == 'film') then
         call check_points(input)
      else
         if (input%has_group('shaft')) then
            call check_shaft(input)
         else
            call check_force(input)
         end if
         call check_window(input)
         if (input%word('scene.task') == 'sweep') call check_sweep(input)
         if (input%word('scene.task') == 'campaign') call check_campaign(input)
         if (input%word('scene.task') == 'threshold') call check_threshold(input)
      end if
   end subroutine check_together

   !> No number leads out of the range of the reals; one that does is faulty, and no rule is applied to it.
   subroutine check_computable(input)
      type(scene_input_t), intent(inout) :: input
      integer :: i, j

      do i = 1, size(keys)
         associate (entry => input%entries(i))
            if (.not. entry%given .or. entry%faulty) cycle
            if (keys(i)%kind == real_kind) call check_number(i, entry%number)
            if (keys(i)%kind /= reals_kind) cycle
            do j = 1, size(entry%numbers)
               if (.not. entry%faulty) call check_number(i, entry%numbers(j))
            end do
         end associate
      end do

   contains

      subroutine check_number(position, number)
         integer, intent(in) :: position
         real(dp), intent(in) :: number

         if (is_computable(keys(position), number)) return
         call input%refuse(key_name(position), not_computable_text(keys(position), number)//meant_behind(keys(position), number))
         input%entries(position)%faulty = .true.
      end subroutine check_number

   end subroutine check_computable

   !> Every required key is there.
   subroutine check_required(input)
      type(scene_input_t), intent(inout) :: input
      integer :: i

      do i = 1, size(keys)
         if (keys(i)%default /= 'required' .or. .not. in_use(input, i)) cycle
         if (input%entries(i)%given .or. input%entries(i)%present) cycle
         ! Which keys a task requires is not known before the task is.
         if (keys(i)%used_when /= '' .and. input%is_faulty('scene.task')) cycle
         if (keys(i)%given_by == 'oil' .and. input%has_group('gear')) then
            call input%refuse(key_name(i), 'this key is required, or the data sheet of the oil '// &
                              'in &oil; allowed: '//allowed_text(keys(i)))
            cycle
         end if
         call input%refuse(key_name(i), 'this key is required; allowed: '//allowed_text(keys(i)))
      end do
   end subroutine check_required

   !> No key is set that the chosen law or method would not read.
   subroutine check_used(input)
      type(scene_input_t), intent(inout) :: input
      integer :: i

      do i = 1, size(keys)
         if (.not. input%entries(i)%given .or. in_use(input, i)) cycle
         if (keys(i)%given_by /= '' .and. input%has_group(trim(keys(i)%given_by))) then
            call input%refuse(key_name(i), 'it follows from &'//trim(keys(i)%given_by)//'; leave it out')
            cycle
         end if
         call input%refuse(key_name(i), reason_unused(input, i))
      end do
   end subroutine check_used

   !> The paper's method has rigid teeth and rigid flanks. (Module batch refuses it for films with a state of their own, of which
   !> no scene knows.)
   subroutine check_newmark(input)
      type(scene_input_t), intent(inout) :: input

      if (input%word('film.law') == 'elastohydrodynamic') then
         call input%refuse('solver.method', 'the paper''s method is for the rigid flanks of the paper; set method = ''taylor''')
      else if (input%is_given('contact.stiffness') .or. input%number('gear.tooth_stiffness') > 0.0_dp) then
         call input%refuse('solver.method', 'the paper''s method is for the rigid teeth of the paper; set method = ''taylor'', '// &
                           'or '// &
                           trim(merge('leave contact.stiffness out ', 'set gear.tooth_stiffness = 0', &
                                         input%is_given('contact.stiffness'))))
      end if
   end subroutine check_newmark

   !> The rules between numbers hold.
   subroutine check_rules(input)
      type(scene_input_t), intent(inout) :: input
      type(rule_t), allocatable :: broken(:)
      type(scene_t) :: scene
      integer :: i

      call input%put_numbers(scene)
      call input%put_laws(scene)
      allocate (broken, source=broken_rules(scene))
      do i = 1, size(broken)
         if (is_clear(input, broken(i)%keys)) &
            call input%refuse(broken(i)%keys(:index(broken(i)%keys, ' ') - 1), &
                              trim(broken(i)%sentence)//reasons_for(input, broken(i)%keys))
      end do
   end subroutine check_rules

   !> Numbers of a broken rule that were surely meant in another unit, behind its sentence.
   function reasons_for(input, names) result(reasons)
      type(scene_input_t), intent(in) :: input
      !> Keys of the rule as group.name, with blanks between
      character(*), intent(in) :: names
      character(:), allocatable :: reasons
      type(word_t), allocatable :: words(:)
      integer :: i, position

      reasons = ''
      allocate (words, source=split_words(names))
      do i = 1, size(words)
         position = find_key(words(i)%text)
         if (keys(position)%kind /= real_kind .or. .not. input%entries(position)%given) cycle
         reasons = reasons//likely_reason(keys(position), input%entries(position)%number)
      end do
   end function reasons_for

   !> Whether all keys of a rule have a value that could be read.
   pure logical function is_clear(input, names)
      type(scene_input_t), intent(in) :: input
      !> As group.name, with blanks between
      character(*), intent(in) :: names
      type(word_t), allocatable :: words(:)
      integer :: i

      ! A backlash lifts the rule of the static load.
      is_clear = (index(names, 'load.') /= 1 .or. .not. input%is_faulty('contact.backlash')) .and. &
                 (index(names, 'gear.drag') /= 1 .or. .not. input%is_faulty('gear.backlash'))
      allocate (words, source=split_words(names))
      do i = 1, size(words)
         associate (entry => input%entries(find_key(words(i)%text)))
            is_clear = is_clear .and. entry%present .and. .not. entry%faulty
         end associate
      end do
   end function is_clear

   !> Exactly one way to give the radius.
   subroutine check_radius(input)
      type(scene_input_t), intent(inout) :: input
      character(*), parameter :: rule = 'give either radius or both radius_1 and radius_2'
      logical :: single, first, second

      single = input%is_given('contact.radius')
      first = input%is_given('contact.radius_1')
      second = input%is_given('contact.radius_2')
      if (single .and. (first .or. second)) then
         call input%refuse('contact.radius', rule)
      else if (first .neqv. second) then
         if (first) call input%refuse('contact.radius_1', rule)
         if (second) call input%refuse('contact.radius_2', rule)
      else if (.not. (single .or. first)) then
         call input%refuse('contact.radius', 'a radius is required: '//rule)
      end if
   end subroutine check_radius

   !> Exactly one way to give the speed.
   subroutine check_speed(input)
      type(scene_input_t), intent(inout) :: input
      character(*), parameter :: rule = 'give exactly one of: entrainment_speed; rolling_speed; surface_speed_1 and surface_speed_2'
      logical :: mean, sum_, first, second, groups_given

      groups_given = input%is_given('points.speed_groups') .or. input%is_given('points.speed_group_range')
      mean = input%is_given('kinematics.entrainment_speed')
      sum_ = input%is_given('kinematics.rolling_speed')
      first = input%is_given('kinematics.surface_speed_1')
      second = input%is_given('kinematics.surface_speed_2')
      if (groups_given .and. (mean .or. sum_ .or. first .or. second)) then
         call input%refuse(trim(merge('points.speed_groups     ', 'points.speed_group_range', &
                                      input%is_given('points.speed_groups'))), &
                           'give either speed groups or the speeds of &kinematics')
      else if (count([mean, sum_, first .or. second]) > 1) then
         if (mean) then
            call input%refuse('kinematics.entrainment_speed', rule)
         else
            call input%refuse('kinematics.rolling_speed', rule)
         end if
      else if (first .neqv. second) then
         if (first) call input%refuse('kinematics.surface_speed_1', rule)
         if (second) call input%refuse('kinematics.surface_speed_2', rule)
      else if (.not. (mean .or. sum_ .or. first .or. groups_given)) then
         call input%refuse('kinematics.entrainment_speed', 'a speed is required: '//rule)
      end if
   end subroutine check_speed

   !> The window is no larger than a transform can be.
   subroutine check_window(input)
      type(scene_input_t), intent(inout) :: input
      !> Samples in the window, whose transform then takes a second or two, in which no signal ends it. One of a length
      !> with large prime factors takes ten times as long.
      real(dp), parameter :: most_samples = 1.0e7_dp, most_of_any_number = 2.0e6_dp

      if (input%is_faulty('spectrum.periods')) return
      if (input%word('scene.task') == 'campaign' .or. input%word('scene.task') == 'threshold') then
         call check_samples('campaign.samples_per_period')
      else if (input%word('solver.method') == 'newmark') then
         call check_samples('solver.steps_per_period')
      else
         call check_samples('solver.samples_per_period')
      end if

   contains

      subroutine check_samples(key)
         character(*), intent(in) :: key
         real(dp) :: samples

         if (input%is_faulty(key)) return
         samples = real(input%count('spectrum.periods'), dp)*real(input%count(key), dp)
         if (samples > most_samples) then
            call input%refuse(key, 'the window of &spectrum periods would hold more than 10000000 samples')
         else if (samples > most_of_any_number .and. .not. has_small_factors(nint(samples))) then
            call input%refuse(key, 'the window of &spectrum periods would hold more than 2000000 samples; '// &
                              'only a product of factors up to 13, such as a power of 2, may be as large')
         end if
      end subroutine check_samples

      !> Whether a number is a product of factors up to 13.
      pure logical function has_small_factors(number)
         integer, intent(in) :: number
         integer :: rest, factor

         rest = number
         do factor = 2, 13
            do while (modulo(rest, factor) == 0)
               rest = rest/factor
            end do
         end do
         has_small_factors = rest == 1
      end function has_small_factors

   end subroutine check_window

   !> No word of a list twice.
   subroutine check_no_word_twice(input, key)
      type(scene_input_t), intent(inout) :: input
      !> As group.name
      character(*), intent(in) :: key
      type(word_t), allocatable :: words(:)
      integer :: i, j

      if (input%is_faulty(key)) return
      allocate (words, source=split_words(input%words(key)))
      do i = 1, size(words)
         do j = i + 1, size(words)
            if (words(i)%text /= words(j)%text) cycle
            call input%refuse(key, "'"//words(i)%text//"' is named twice")
            return
         end do
      end do
   end subroutine check_no_word_twice

   !> Columns of the coast flank are asked for only where there is one.
   subroutine check_columns(input)
      type(scene_input_t), intent(inout) :: input
      type(word_t), allocatable :: words(:)
      integer :: i

      if (input%is_faulty('output.columns')) return
      if (input%is_given('contact.backlash') .or. input%is_given('gear.backlash')) return
      allocate (words, source=split_words(input%words('output.columns')))
      do i = 1, size(words)
         if (index(words(i)%text, 'coast_') /= 1) cycle
         call input%refuse('output.columns', "'"//words(i)%text//"' needs a coast flank: give "// &
                           trim(merge('gear.backlash   ', 'contact.backlash', input%has_group('gear'))))
      end do
   end subroutine check_columns

   !> The reference solution is for film tasks, as a motion would wait for it at every step; its closure, other laws of viscosity and
   !> what flanks flatten by are for the elastohydrodynamic law.
   subroutine check_film_model(input)
      type(scene_input_t), intent(inout) :: input
      character(*), parameter :: law = "law = 'elastohydrodynamic'", bent(3) = [character(9) :: 'closure', 'resolved', 'automatic']
      logical :: numerical, elastic

      numerical = input%word('film.model') == 'numerical'
      elastic = input%word('scene.task') /= 'film' .and. input%word('film.law') == 'elastohydrodynamic'
      if (numerical .and. input%word('scene.task') /= 'film') &
         call input%refuse('film.model', "'numerical' is for task = 'film' only")
      if (elastic .and. .not. (numerical .or. any(input%word('film.model') == bent))) &
         call input%refuse('film.model', "the model of "//law//" is 'closure', 'resolved' or 'automatic'")
      if (input%word('film.model') == 'resolved') call check_resolved(input, elastic)
      if (input%word('film.model') == 'automatic') call check_automatic(input, elastic)
      if (input%word('film.model') == 'closure' .and. .not. elastic) call input%refuse('film.model', "'closure' needs "//law)
      if (input%word('lubricant.viscosity_law') == 'roelands' .and. .not. (numerical .or. elastic)) &
         call input%refuse('lubricant.viscosity_law', "'roelands' needs "//law//", or task = 'film' and model = 'numerical'")
      if (input%word('lubricant.viscosity_law') == 'constant' .and. .not. elastic) &
         call input%refuse('lubricant.viscosity_law', "'constant' needs "//law)
      ! The default stands in the resolved input of pairs of which others are elastic.
      if (.not. (input%flag('contact.flattening_included') .or. elastic .or. input%is_given('contact.stiffness') .or. &
                 input%number('gear.tooth_stiffness') > 0.0_dp)) &
         call input%refuse('contact.flattening_included', 'rigid flanks have nothing to include; give a stiffness or '//law)
   end subroutine check_film_model

   !> Films in nodes of pressure are those of a single motion.
   subroutine check_resolved(input, elastic)
      type(scene_input_t), intent(inout) :: input
      !> Whether the law is the elastohydrodynamic one
      logical, intent(in) :: elastic
      real(dp), parameter :: finest = 1.0e-5_dp

      if (.not. elastic) then
         call input%refuse('film.model', "'resolved' needs law = 'elastohydrodynamic'")
         return
      end if
      if (input%word('scene.task') /= 'motion') &
         call input%refuse('film.model', "'resolved' is for task = 'motion'; take 'closure' for many scenes")
      if (.not. input%is_faulty('solver.accuracy') .and. input%number('solver.accuracy') < finest) &
         call input%refuse('solver.accuracy', "too fine for model = 'resolved'; allowed: 1e-5 to 1e-2")
      call check_nodes(input)
      if (input%is_given('solver.starts') .and. input%count('solver.starts') > 1) &
         call input%refuse('solver.starts', "model = 'resolved' follows one motion alone; leave it out, or "// &
                           "look for others with model = 'closure'")
      call check_profiles(input)
   end subroutine check_resolved

   !> Films in nodes of pressure where the closure does not do are those of single motions, or of rows of campaigns.
   subroutine check_automatic(input, elastic)
      type(scene_input_t), intent(inout) :: input
      !> Whether the law is the elastohydrodynamic one
      logical, intent(in) :: elastic

      if (.not. elastic) then
         call input%refuse('film.model', "'automatic' needs law = 'elastohydrodynamic'")
         return
      end if
      if (input%word('scene.task') /= 'motion' .and. input%word('scene.task') /= 'campaign') &
         call input%refuse('film.model', "'automatic' is for task = 'motion' or 'campaign'; sweeps and thresholds follow "// &
                           "motions from one value to the next, which films in nodes do not; take 'closure'")
      if (input%word('solver.method') /= 'taylor') call input%refuse('film.model', "'automatic' needs the taylor method")
      call check_nodes(input)
   end subroutine check_automatic

   !> The number of nodes is one of the list.
   subroutine check_nodes(input)
      type(scene_input_t), intent(inout) :: input
      integer, parameter :: choices(5) = [24, 32, 48, 64, 128]

      if (.not. input%is_faulty('film.nodes') .and. .not. any(input%count('film.nodes') == choices)) &
         call input%refuse('film.nodes', 'not a number of nodes; allowed: 24, 32, 48, 64, 128')
   end subroutine check_nodes

   !> When profiles are written is reported once, in the order of time.
   subroutine check_profiles(input)
      type(scene_input_t), intent(inout) :: input
      real(dp), allocatable :: phases(:)
      character(*), parameter :: names(2) = [character(14) :: 'profile_phases', 'profile_count']
      integer :: i

      do i = 1, size(names)
         if (input%is_given('output.'//names(i)) .and. .not. input%flag('output.profiles')) &
            call input%refuse('output.'//names(i), 'this key is used only with output.profiles = .true.')
      end do
      if (.not. input%is_given('output.profile_phases') .or. input%is_faulty('output.profile_phases')) return
      if (input%is_given('output.profile_count')) &
         call input%refuse('output.profile_count', 'it excludes output.profile_phases; leave one of the two out')
      phases = input%numbers('output.profile_phases')
      if (any(phases(2:) <= phases(:size(phases) - 1))) &
         call input%refuse('output.profile_phases', 'each phase has to be larger than the one before')
   end subroutine check_profiles

   !> The ends of a sweep differ, its key allows the values between them, and its engine can follow it.
   subroutine check_sweep(input)
      type(scene_input_t), intent(inout) :: input
      character(:), allocatable :: key, message
      type(rule_t), allocatable :: broken(:)
      type(scene_t) :: swept
      real(dp) :: ends(2)
      integer :: i, j, position

      if (input%word('solver.method') /= 'taylor') call input%refuse('solver.method', 'a sweep needs the taylor method')
      if (input%is_faulty('sweep.key') .or. input%is_faulty('sweep.first') .or. input%is_faulty('sweep.last')) return
      if (.not. all([input%is_given('sweep.key'), input%is_given('sweep.first'), input%is_given('sweep.last')])) return
      key = input%word('sweep.key')
      position = find_swept_key(key)
      if (.not. in_use(input, position)) then
         call input%refuse('sweep.key', 'the input does not use '//key_name(position)//'; sweep a key that it uses')
         return
      end if
      ends = [input%number('sweep.first'), input%number('sweep.last')]
      do i = 1, 2
         if (.not. in_range(keys(position), ends(i)) .or. &
             (input%word('sweep.spacing') == 'logarithmic' .and. .not. ends(i) > 0.0_dp)) then
            message = 'not allowed for '//key//'; allowed: '//allowed_text(keys(position))// &
                      ', and above zero where the spacing is logarithmic'
         else if (.not. is_computable(keys(position), ends(i))) then
            message = not_computable_text(keys(position), ends(i))
         else
            cycle
         end if
         call input%refuse('sweep.'//merge('first', 'last ', i == 1), message//meant_behind(keys(position), ends(i)))
         return
      end do
      if (.not. abs(ends(2) - ends(1)) > 0.0_dp) call input%refuse('sweep.last', 'it must differ from first')
      ! Measured with a margin: each motion has its own copy of the values.
      call check_memory(input, 'sweep.count', 80.0_dp*real(input%count('sweep.count'), dp))
      do i = 1, 2
         call input%put_numbers(swept)
         call input%put_laws(swept)
         call set_number(swept, keys(position)%group, keys(position)%name, ends(i))
         if (allocated(broken)) deallocate (broken)
         allocate (broken, source=broken_rules(swept))
         do j = 1, size(broken)
            if (index(broken(j)%keys, key_name(position)//' ') == 0 .or. .not. is_clear(input, broken(j)%keys)) cycle
            call input%refuse('sweep.'//merge('first', 'last ', i == 1), &
                              trim(broken(j)%sentence)//likely_reason(keys(position), ends(i)))
         end do
      end do
   end subroutine check_sweep

   !> There is memory for what a key makes large.
   subroutine check_memory(input, key, bytes)
      type(scene_input_t), intent(inout) :: input
      !> As group.name
      character(*), intent(in) :: key
      !> What it takes [bytes]
      real(dp), intent(in) :: bytes
      type(error_t), allocatable :: error

      if (input%is_faulty(key)) return
      call expect_memory(bytes, 'this', error)
      if (.not. allocated(error)) return
      associate (known => keys(find_key(key)))
         call input%faults%add_error(input%file, trim(known%group), trim(known%name), error)
      end associate
   end subroutine check_memory

   !> A campaign varies something, one way or another, and is solved by the engine of many lanes.
   subroutine check_campaign(input)
      type(scene_input_t), intent(inout) :: input

      if (input%is_given('campaign.vary') .eqv. input%is_given('campaign.csv')) &
         call input%refuse('campaign.vary', 'give either vary or csv')
      call check_sample(input)
   end subroutine check_campaign

   !> What varies is solved by the engine of many lanes, a sample has a size, and a part is one of the parts.
   subroutine check_sample(input)
      type(scene_input_t), intent(inout) :: input

      if (input%word('solver.method') /= 'taylor') &
         call input%refuse('solver.method', 'a '//input%word('scene.task')//' needs the taylor method')
      if (input%word('campaign.sample') /= 'grid' .and. .not. input%is_given('campaign.size')) &
         call input%refuse('campaign.size', 'a sample needs its size')
      if (.not. (input%is_faulty('campaign.part') .or. input%is_faulty('campaign.parts')) .and. &
          input%count('campaign.part') > input%count('campaign.parts')) &
         call input%refuse('campaign.part', 'at most parts ('//integer_text(input%count('campaign.parts'))//')')
   end subroutine check_sample

   !> A threshold may stand alone or along the axes of &campaign; its criterion is one that the scene has.
   subroutine check_threshold(input)
      type(scene_input_t), intent(inout) :: input
      character(:), allocatable :: criterion
      integer :: code
      logical :: takes_level

      call check_sample(input)
      if (input%is_given('campaign.vary') .and. input%is_given('campaign.csv')) &
         call input%refuse('campaign.vary', 'give either vary or csv, or neither')
      if (input%is_faulty('threshold.criterion')) return
      criterion = input%word('threshold.criterion')
      code = quantity_code(criterion)
      takes_level = code > 0
      if (takes_level) takes_level = quantity_table(code)%kind == a_number .or. quantity_table(code)%kind == a_count
      if (takes_level .and. .not. (input%is_given('threshold.level') .or. input%is_faulty('threshold.level'))) &
         call input%refuse('threshold.level', criterion//' is a number: give the level that it has to reach')
      if (input%is_given('threshold.level') .and. .not. takes_level) &
         call input%refuse('threshold.level', criterion//' changes by itself and has no level; leave it out')
      if ((criterion == 'double_sided' .or. index(criterion, 'coast') > 0) .and. &
          .not. (input%is_given('contact.backlash') .or. input%is_given('gear.backlash'))) &
         call input%refuse('threshold.criterion', criterion//' needs a backlash')
   end subroutine check_threshold

   !> One way to give each list of a film task, and no more points than anyone means.
   subroutine check_points(input)
      type(scene_input_t), intent(inout) :: input
      real(dp), parameter :: most_points = 1.0e7_dp
      real(dp) :: points

      points = 1.0_dp
      call check_list('film_ratios', 'film_ratio_range', .true.)
      call check_list('squeeze_ratios', 'squeeze_ratio_range', .false.)
      call check_list('speed_groups', 'speed_group_range', .false.)
      if (points <= most_points) call check_memory(input, 'points.film_ratio_range', 32.0_dp*points)
      if (points > most_points) call input%refuse('points.film_ratio_range', 'the lists make more than 10000000 points')
      if (mod(input%count('points.cells'), 2) /= 0) call input%refuse('points.cells', 'an even number is needed')

   contains

      subroutine check_list(list, range, required)
         character(*), intent(in) :: list
         character(*), intent(in) :: range
         logical, intent(in) :: required
         real(dp), allocatable :: numbers(:)

         if (input%is_faulty('points.'//list) .or. input%is_faulty('points.'//range)) return
         if (input%is_given('points.'//list) .and. input%is_given('points.'//range)) then
            call input%refuse('points.'//range, 'give either '//list//' or '//range)
         else if (input%is_given('points.'//range)) then
            numbers = input%numbers('points.'//range)
            if (size(numbers) /= 3) then
               call input%refuse('points.'//range, 'three numbers are needed: first, last, count')
            else if (.not. (numbers(3) >= 2.0_dp .and. numbers(3) <= most_points .and. &
                            abs(numbers(3) - anint(numbers(3))) <= 0.0_dp .and. numbers(2) > numbers(1))) then
               call input%refuse('points.'//range, 'last must exceed first, and count be an integer >= 2')
            else
               points = points*numbers(3)
            end if
         else if (required .and. .not. input%is_given('points.'//list)) then
            call input%refuse('points.'//list, 'give '//list//' or '//range)
         else
            points = points*real(max(1, size(input%numbers('points.'//list))), dp)
         end if
      end subroutine check_list

   end subroutine check_points

end module scene_checker
