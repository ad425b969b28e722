!> From the text of an input to a scene: values are typed by the key table, checked together, and put
!> into the types group by group if there was no fault. All faults of an input are reported at once.
module scene_reader
   use errors, only: error_t, error_words, exit_system, fault_list_t, is_shortage, last_error, not_permitted, raise
   use file_system, only: read_whole_file
   use input_entry, only: numbers_text, place_of, value_text
   use input_key, only: name_limit, table_kind
   use key_table, only: find_key, keys, starts_group
   use keys_in_use, only: in_use
   use kinds, only: dp
   use namelist_text, only: assignment_t, repeated_group, scan_namelists
   use odd_numbers, only: mistaken_numbers, odd_numbers_of_input, odd_swings
   use scene_checker, only: check_together
   use scene_input, only: new_scene_input, scene_input_t
   use scene_types, only: model_resolved, note_orders, output_t, scene_t, task_campaign, task_motion, &
      task_sweep, task_threshold
   use signal_reader, only: take_signal
   use table_reader, only: take_drag_table, take_excitation_table
   use task_reader, only: read_campaign, read_points, read_sweep, read_threshold
   use text, only: integer_text, lower, quoted
   use word_list, only: word_t
   implicit none(type, external)
   private

   !> Inputs are small; a larger file is not one.
   integer, parameter :: size_limit = 16777216
   !> Starts of a scene where solver.starts is absent
   integer, parameter :: starts_of_motion = 29, starts_of_campaign = 3

   !> One key set on the command line.
   type, public :: override_t
      !> As the user wrote it, for the faults
      character(:), allocatable :: source
      !> As namelist text
      character(:), allocatable :: text
      !> Which of several gear pairs it is for; 0: all
      integer :: pair = 0
   end type override_t

   public :: read_scenes

contains

   !> Read the scene of a file, or standard input, with overrides from the command line. Where several gear pairs stand in it, each
   !> is a scene of its own.
   subroutine read_scenes(path, overrides, scenes, faults)
      !> Path; '-' is standard input
      character(*), intent(in) :: path
      !> Keys set on the command line
      type(override_t), intent(in) :: overrides(:)
      !> The scenes; of use only if no fault was added
      type(scene_t), allocatable, intent(out) :: scenes(:)
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      type(assignment_t), allocatable :: assignments(:)
      type(scene_input_t), allocatable :: inputs(:)
      type(error_t), allocatable :: error
      character(:), allocatable :: content, file
      integer :: stat, before, i
      logical :: is_input

      before = faults%count()
      allocate (scenes(0))
      file = input_name(path)
      call read_whole_file(path, size_limit, content, stat)
      select case (stat)
      case (0)
      case (1)
         if (last_error() == not_permitted) then
            call faults%add(file, 0, '', '', 'it may not be read')
         else if (is_shortage(last_error())) then
            call raise(error, exit_system, 'it cannot be opened: '//error_words(last_error()))
            call faults%add_error(file, '', '', error)
         else
            call faults%add(file, 0, '', '', 'there is no such file')
         end if
      case (2)
         call faults%add(file, 0, '', '', 'it cannot be read as a file')
      case default
         call faults%add(file, 0, '', '', 'it is larger than '//integer_text(size_limit)//' bytes, too large for an input')
      end select
      if (stat /= 0) return

      call scan_namelists(content, file, 1, assignments, faults)
      ! What holds no group at all is no input; a list of all that it lacks would help no one.
      is_input = size(assignments) > 0 .or. faults%count() == before
      call begin_inputs(assignments, file, inputs)
      do i = 1, size(overrides)
         if (overrides(i)%pair > size(inputs)) call faults%add( &
            overrides(i)%source, 0, '', '', 'there is no gear pair of this number; the input has '//integer_text(size(inputs)))
      end do
      deallocate (scenes)
      allocate (scenes(size(inputs)))
      do i = 1, size(inputs)
         call set_all_keys(inputs(i), assignments, file, overrides)
         allocate (scenes(i)%warnings(0))
         call inputs(i)%choose_defaults()
         call take_signal(inputs(i), 'load', scenes(i)%warnings)
         call take_signal(inputs(i), 'shaft', scenes(i)%warnings)
         call take_drag_table(inputs(i), scenes(i)%gear, scenes(i)%warnings)
         call take_excitation_table(inputs(i), scenes(i)%shaft, scenes(i)%warnings)
         if (is_input) call check_together(inputs(i))
         call read_name(inputs(i), path, scenes(i)%name)
         call read_pair_name(inputs(i), scenes(:i))
         scenes(i)%source = file
         ! What the pairs share is found wrong with each of them.
         call faults%take(inputs(i)%faults)
      end do
      call faults%sort_since(before)
      if (faults%count() > before) return
      do i = 1, size(inputs)
         call put_values(inputs(i), scenes(i))
      end do
   end subroutine read_scenes

   !> An input without values for each gear pair; one where none or one stands.
   subroutine begin_inputs(assignments, file, inputs)
      type(assignment_t), intent(in) :: assignments(:)
      character(*), intent(in) :: file
      type(scene_input_t), allocatable, intent(out) :: inputs(:)
      integer :: lines(size(assignments)), pairs, i

      pairs = 0
      do i = 1, size(assignments)
         if (assignments(i)%group /= repeated_group .or. len(assignments(i)%key) > 0) cycle
         pairs = pairs + 1
         lines(pairs) = assignments(i)%line
      end do
      allocate (inputs(max(1, pairs)))
      if (pairs < 2) inputs(1) = new_scene_input(file)
      do i = 1, merge(pairs, 0, pairs > 1)
         inputs(i) = new_scene_input(file, i, lines(i))
      end do
   end subroutine begin_inputs

   !> Set the keys of the file, and those of the command line over them.
   subroutine set_all_keys(input, assignments, file, overrides)
      type(scene_input_t), intent(inout) :: input
      !> Of the file
      type(assignment_t), intent(in) :: assignments(:)
      character(*), intent(in) :: file
      type(override_t), intent(in) :: overrides(:)
      type(assignment_t), allocatable :: set(:)
      integer :: i

      call input%set_all(assignments, file, .false.)
      do i = 1, size(overrides)
         if (all(overrides(i)%pair /= [0, input%pair])) cycle
         call scan_namelists(overrides(i)%text, overrides(i)%source, 0, set, input%faults)
         ! The group itself counts as one; a value that goes on with keys or groups of its own sets more.
         if (size(set) > 2) then
            call input%faults%add(overrides(i)%source, 0, '', '', 'one key is set at a time; give an option of its own to each')
            cycle
         end if
         call input%set_all(set, overrides(i)%source, .true.)
      end do
      call input%forget_replaced_ranges()
      call input%close_lists()
   end subroutine set_all_keys

   !> Put the values of an input without a fault into its scene, which has its names already.
   subroutine put_values(input, scene)
      type(scene_input_t), intent(in) :: input
      type(scene_t), intent(inout) :: scene

      scene%task = input%choice('scene.task')
      call input%put_numbers(scene)
      call input%put_laws(scene)
      call read_choices(input, scene)
      scene%points = read_points(input, scene%film%model)
      if (scene%task == task_sweep) scene%sweep = read_sweep(input)
      if (scene%task == task_campaign .or. scene%task == task_threshold) scene%campaign = read_campaign(input)
      if (scene%task == task_threshold) then
         scene%threshold = read_threshold(input)
         scene%campaign%record = [scene%threshold%quantity]
      end if
      scene%output = read_output(input)
      scene%lines = input%entries%line
      scene%resolved_input = resolved_text(input, trim(scene%name))//input%found
      scene%mistaken = mistaken_numbers(input)
      scene%warnings = [scene%warnings, odd_numbers_of_input(input), odd_swings(input, scene%shaft), &
                        published_film_of_gear(input)]
   end subroutine put_values

   !> That the paper's film is none for gears, where a pair has it.
   function published_film_of_gear(input) result(lines)
      type(scene_input_t), intent(in) :: input
      type(word_t), allocatable :: lines(:)

      allocate (lines(0))
      if (.not. input%has_group('gear') .or. input%word('film.model') /= 'published') return
      lines = [word_t('warning: '//place_of(input%entries(find_key('film.model')))//": the published films are those of the "// &
                      "paper's scenes, and off by factors for gear pairs; leave &film model out, or take 'reynolds'")]
   end function published_film_of_gear

   !> How faults call an input.
   pure function input_name(path) result(name)
      !> Path; '-' is standard input
      character(*), intent(in) :: path
      character(:), allocatable :: name

      name = path
      if (path == '-') name = 'standard input'
   end function input_name

   !> &scene name: as given, or the stem of the file.
   subroutine read_name(input, path, name)
      type(scene_input_t), intent(inout) :: input
      character(*), intent(in) :: path
      character(*), intent(out) :: name
      character(:), allocatable :: stem
      integer :: dot

      name = ''
      if (input%is_faulty('scene.name')) return
      if (input%is_given('scene.name')) then
         stem = input%word('scene.name')
      else if (path == '-') then
         stem = 'standard-input'
      else
         stem = trim(path(index(path, '/', back=.true.) + 1:))
         dot = index(stem, '.', back=.true.)
         if (dot > 1) stem = stem(:dot - 1)
      end if
      name = stem
      call check_name(input, 'scene', stem)
   end subroutine read_name

   !> A name of files is of plain letters.
   subroutine check_name(input, group, name)
      type(scene_input_t), intent(inout) :: input
      !> Whose name it is
      character(*), intent(in) :: group
      character(*), intent(in) :: name
      character(*), parameter :: legal = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-'

      if (len(name) > name_limit .or. verify(name, legal) > 0 .or. name == '.' .or. name == '..') &
         call input%refuse(group//'.name', quoted(name(:min(len(name), 80)))//' is not allowed; allowed: 1 to '// &
                           integer_text(name_limit)//' letters, digits, . _ -')
   end subroutine check_name

   !> &gear name. Several pairs need one each, which becomes the end of the names of their scenes; a campaign or threshold
   !> is one over all.
   subroutine read_pair_name(input, scenes)
      type(scene_input_t), intent(inout) :: input
      !> Scenes of all pairs up to this one, the last
      type(scene_t), intent(inout) :: scenes(:)
      character(:), allocatable :: name
      integer :: i
      logical :: is_one_of_several

      if (input%is_faulty('gear.name')) return
      is_one_of_several = input%line_of_pair > 0
      name = input%word('gear.name')
      if (len(name) == 0) then
         if (is_one_of_several) call input%refuse('gear.name', 'there are several &gear; each needs a name')
         return
      end if
      associate (scene => scenes(size(scenes)))
         call check_name(input, 'gear', name)
         scene%gear%name = name
         if (.not. is_one_of_several) return
         do i = 1, size(scenes) - 1
            ! There are file systems that know no case.
            if (lower(trim(scenes(i)%gear%name)) /= lower(name)) cycle
            call input%refuse('gear.name', quoted(name)//' is also the name of an earlier &gear')
            exit
         end do
         if (len_trim(scene%name) + 1 + len(name) > name_limit) call input%refuse('gear.name', 'the name of this pair, '// &
            trim(scene%name)//'.'//name//', is longer than '//integer_text(name_limit)//' letters')
         scene%gearbox = scene%name
         if (input%word('scene.task') /= 'campaign' .and. input%word('scene.task') /= 'threshold') &
            scene%name = trim(scene%name)//'.'//name
      end associate
   end subroutine read_pair_name

   !> Choices and lists of the groups that make a motion; their numbers are there already.
   subroutine read_choices(input, scene)
      type(scene_input_t), intent(in) :: input
      type(scene_t), intent(inout) :: scene

      associate (film => scene%film, solver => scene%solver, excitation => scene%excitation, spectrum => scene%spectrum)
         if (input%is_given('load.force_orders')) then
            excitation%force_orders = nint(input%numbers('load.force_orders'))
            excitation%force_amplitudes = input%numbers('load.force_amplitudes')
            excitation%force_phases = 0.0_dp*excitation%force_amplitudes
            if (input%is_given('load.force_phases')) excitation%force_phases = input%numbers('load.force_phases')
            call note_orders(excitation%force_orders, excitation%force_amplitudes, spectrum)
         end if
         if (allocated(scene%shaft%table)) then
            scene%shaft%orders = scene%shaft%table%orders
         else if (input%has_group('shaft')) then
            scene%shaft%orders = input%numbers('shaft.orders')
            if (input%is_given('shaft.accelerations')) scene%shaft%accelerations = input%numbers('shaft.accelerations')
            if (input%is_given('shaft.speed_amplitudes')) &
               scene%shaft%speed_amplitudes = input%numbers('shaft.speed_amplitudes')
            scene%shaft%phases = 0.0_dp*scene%shaft%orders
            if (input%is_given('shaft.phases')) scene%shaft%phases = input%numbers('shaft.phases')
            if (input%is_given('shaft.signal_speed_range')) &
               scene%shaft%signal_speed_range = input%numbers('shaft.signal_speed_range')
         end if
         scene%oil%base = input%choice('oil.base')
         film%nodes = input%count('film.nodes')
         film%rupture = input%choice('film.rupture')
         film%rupture_solver = input%choice('film.rupture_solver')
         solver%method = input%choice('solver.method')
         solver%iteration = input%choice('solver.iteration')
         solver%predictor = input%choice('solver.predictor')
         solver%tolerance = input%number('solver.tolerance')
         solver%iteration_limit = input%count('solver.iteration_limit')
         solver%steps_per_period = input%count('solver.steps_per_period')
         solver%kept_per_period = input%count('solver.samples_per_period')
         solver%until = input%choice('solver.until')
         solver%starts = 1
         if (in_use(input, find_key('solver.starts'))) then
            solver%starts = merge(starts_of_motion, starts_of_campaign, scene%task == task_motion)
            if (input%is_given('solver.starts')) solver%starts = input%count('solver.starts')
            if (film%model == model_resolved) solver%starts = 1
         end if
         solver%time_limit = input%number('solver.time_limit')
         spectrum%verify = input%flag('spectrum.verify')
         spectrum%verification_tolerance = input%number('spectrum.verification_tolerance')
      end associate
   end subroutine read_choices

   !> &output
   function read_output(input) result(output)
      type(scene_input_t), intent(in) :: input
      type(output_t) :: output
      integer :: i

      output%directory = input%word('output.directory')
      output%series = input%flag('output.series')
      output%overwrite = input%flag('output.overwrite')
      output%profiles = in_use(input, find_key('output.profiles')) .and. input%flag('output.profiles')
      if (input%is_given('output.profile_phases')) output%profile_phases = input%numbers('output.profile_phases')
      if (input%is_given('output.profile_count')) then
         associate (n => input%count('output.profile_count'))
            output%profile_phases = [(real(i, dp)/real(n, dp), i=1, n)]
         end associate
      end if
      allocate (output%columns, source=input%choices('output.columns'))
      output%stride = input%count('output.stride')
   end function read_output

   !> All keys that have a value and are in use, as namelist text. Where the files go is no property
   !> of the scene, so that the same scene gives the same bytes in any folder.
   function resolved_text(input, name) result(text)
      !> Typed values, without a fault
      type(scene_input_t), intent(in) :: input
      !> Name of the scene
      character(*), intent(in) :: name
      character(:), allocatable :: text
      character(:), allocatable :: body
      integer :: i, column

      text = ''
      body = ''
      do i = 1, size(keys)
         if (keys(i)%group == 'scene' .and. keys(i)%name == 'name') then
            body = body//'   name = '//quoted(name)//new_line('a')
         else if (keys(i)%kind == table_kind) then
            do column = 1, size(input%entries(i)%columns)
               if (size(input%entries(i)%columns(column)%numbers) == 0) cycle
               body = body//'   '//trim(keys(i)%name)//'(:, '//integer_text(column)//') = '// &
                      numbers_text(input%entries(i)%columns(column)%numbers)//new_line('a')
            end do
         else if (is_shown(i)) then
            body = body//'   '//trim(keys(i)%name)//' = '//value_text(keys(i), input%entries(i))//new_line('a')
         end if
         if (.not. starts_group(i + 1)) cycle
         if (len(body) > 0) text = text//'&'//trim(keys(i)%group)//new_line('a')//body//'/'//new_line('a')
         body = ''
      end do

   contains

      !> Whether a key belongs into the text: it has a value, is in use, and is no matter of this machine.
      pure logical function is_shown(i)
         integer, intent(in) :: i

         is_shown = input%entries(i)%present .and. in_use(input, i)
         if (keys(i)%group == 'output') is_shown = is_shown .and. keys(i)%name /= 'directory' .and. keys(i)%name /= 'overwrite'
         ! The key matters to elastic flanks.
         if (keys(i)%name == 'flattening_included') &
            is_shown = is_shown .and. (input%is_given('contact.stiffness') .or. input%word('film.law') == 'elastohydrodynamic' &
                                     .or. input%number('gear.tooth_stiffness') > 0.0_dp)
         if (keys(i)%name == 'damping_ratio' .or. keys(i)%name == 'tooth_damping_ratio') &
            is_shown = is_shown .and. input%entries(i)%number > 0.0_dp
         ! In a film task the absent model means more than its default.
         if (keys(i)%name == 'model') is_shown = is_shown .and. (input%entries(i)%given .or. input%word('scene.task') /= 'film')
      end function is_shown

   end function resolved_text

end module scene_reader
