!> Arguments of the program.
module command_line
   use errors, only: fault_list_t
   use file_system, only: read_whole_file
   use input_key, only: list_kind, text_kind
   use key_table, only: find_key, keys
   use namelist_text, only: repeated_group
   use scene_reader, only: override_t
   use text, only: integer_text, lower, quoted, quoted_words
   use word_list, only: word_t
   use, intrinsic :: omp_lib, only: omp_get_num_procs
   implicit none(type, external)
   private

   !> What the arguments ask for.
   type, public :: command_t
      !> Names of the input files
      type(word_t), allocatable :: files(:)
      type(override_t), allocatable :: overrides(:)
      logical :: check = .false., template = .false., page = .false., quantities = .false., resume = .false., quiet = .false.
      logical :: verbose = .false., version = .false., help = .false.
      !> Threads of a campaign, scenes that run side by side; 0: as many as there are cores
      integer :: threads = 0
      !> What --template is to print: a ready input or a group, empty for all groups
      character(:), allocatable :: template_name
   end type command_t

   !> Largest file of settings
   integer, parameter :: most_bytes = 67108864

   public :: read_arguments, usage_text, most_threads

contains

   !> Read the arguments; faults are appended.
   subroutine read_arguments(command, faults)
      !> What they ask for
      type(command_t), intent(out) :: command
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      character(:), allocatable :: argument
      integer :: i
      logical :: options_over

      allocate (command%files(0), command%overrides(0))
      command%template_name = ''
      options_over = .false.
      i = 0
      do while (i < command_argument_count())
         i = i + 1
         argument = argument_text(i)
         if (len(argument) == 0) then
            call faults%add("''", 0, '', '', 'the name of an input file is empty')
         else if (options_over .or. argument == '-' .or. argument(1:1) /= '-') then
            command%files = [command%files, word_t(argument)]
         else if (argument == '--') then
            options_over = .true.
         else
            call read_option(argument, i, command, faults)
         end if
      end do
   end subroutine read_arguments

   !> Read one option, and the value that follows it.
   subroutine read_option(option, place, command, faults)
      character(*), intent(in) :: option
      !> Its place among the arguments; out: that of its value, where it has one
      integer, intent(inout) :: place
      type(command_t), intent(inout) :: command
      type(fault_list_t), intent(inout) :: faults
      character(:), allocatable :: value

      value = ''
      if (any(option == [character(9) :: '--threads', '--set', '--output'])) then
         if (place == command_argument_count()) then
            call faults%add(option, 0, '', '', 'a value must follow this option')
            return
         end if
         place = place + 1
         value = argument_text(place)
      end if
      select case (option)
      case ('--check')
         command%check = .true.
      case ('--quiet')
         command%quiet = .true.
      case ('--verbose')
         command%verbose = .true.
      case ('--version')
         command%version = .true.
      case ('--help', '-h')
         command%help = .true.
      case ('--keys')
         command%page = .true.
      case ('--quantities')
         command%quantities = .true.
      case ('--resume')
         command%resume = .true.
         ! What is carried on is replaced by what it becomes.
         call add_override('output.overwrite=.true.', option, command, faults)
      case ('--threads')
         call read_threads(value, command%threads, faults)
      case ('--overwrite')
         call add_override('output.overwrite=.true.', option, command, faults)
      case ('--template')
         command%template = .true.
         if (place < command_argument_count()) then
            place = place + 1
            command%template_name = lower(argument_text(place))
         end if
      case ('--set')
         if (index(value, '@') == 1) then
            call add_settings(value(2:), command, faults)
         else
            call add_override(value, option//' '//value, command, faults)
         end if
      case ('--output')
         call add_override('output.directory='//quoted(value), option//' '//value, command, faults)
      case default
         call faults%add(option, 0, '', '', 'unknown option; rattle --help lists all')
      end select
   end subroutine read_option

   !> A positive number of threads.
   subroutine read_threads(text, threads, faults)
      character(*), intent(in) :: text
      integer, intent(inout) :: threads
      type(fault_list_t), intent(inout) :: faults
      integer :: stat

      stat = merge(0, 1, verify(text, '0123456789') == 0 .and. len(text) > 0 .and. len(text) < 6)
      if (stat == 0) read (text, *, iostat=stat) threads
      if (stat /= 0 .or. threads < 1) then
         call faults%add('--threads '//text, 0, '', '', 'a positive number of threads is needed')
      else if (threads > most_threads()) then
         call faults%add('--threads '//text, 0, '', '', 'at most '//integer_text(most_threads())// &
                         ' threads are allowed on this machine')
      end if
   end subroutine read_threads

   !> Settings of a file, one in each line: lists may be longer than an argument.
   subroutine add_settings(path, command, faults)
      character(*), intent(in) :: path
      type(command_t), intent(inout) :: command
      type(fault_list_t), intent(inout) :: faults
      character(:), allocatable :: content, line
      integer :: stat, first, length

      call read_whole_file(path, most_bytes, content, stat)
      if (stat /= 0) then
         call faults%add('--set @'//path, 0, '', '', trim(merge('it cannot be read                ', &
                                                                'it is longer than settings can be', stat < 3)))
         return
      end if
      first = 1
      do while (first <= len(content))
         length = index(content(first:), new_line('a')) - 1
         if (length < 0) length = len(content) - first + 1
         line = content(first:first + length - 1)
         if (len_trim(line) > 0) call add_override(line, '--set '//shortened(line), command, faults)
         first = first + length + 1
      end do
   end subroutine add_settings

   !> Turn group.key=value into namelist text.
   subroutine add_override(setting, source, command, faults)
      character(*), intent(in) :: setting
      !> As faults name it
      character(*), intent(in) :: source
      type(command_t), intent(inout) :: command
      type(fault_list_t), intent(inout) :: faults
      character(:), allocatable :: group, key
      integer :: dot, equals, pair

      equals = index(setting, '=')
      dot = index(setting(:max(equals, 1)), '.')
      if (equals < 4 .or. dot < 2 .or. dot > equals - 2) then
         call faults%add(source, 0, '', '', 'write it as group.key=value')
         return
      end if
      group = setting(:dot - 1)
      key = setting(dot + 1:equals - 1)
      pair = pair_of(group)
      if (pair > 0) group = repeated_group
      command%overrides = [command%overrides, override_t( &
                           source, '&'//group//' '//key//'='//value_of(group//'.'//key, setting(equals + 1:))//new_line('a')//'/', &
                           pair)]
   end subroutine add_override

   !> The number of the gear pair that a setting is for, as in gear(2); 0 where it names none.
   pure integer function pair_of(group)
      character(*), intent(in) :: group
      integer, parameter :: first = len(repeated_group) + 2, most_digits = 6
      integer :: last

      pair_of = 0
      last = len(group) - 1
      if (last < first .or. last - first >= most_digits) return
      if (lower(group(:first - 1)) /= repeated_group//'(' .or. group(last + 1:) /= ')') return
      if (verify(group(first:last), '0123456789') == 0) read (group(first:last), *) pair_of
   end function pair_of

   !> A setting as it is reported in faults: no one reads thousands of numbers.
   pure function shortened(setting) result(short)
      character(*), intent(in) :: setting
      character(:), allocatable :: short
      integer, parameter :: longest = 200

      short = setting
      if (len(setting) > longest) short = setting(:longest)//' ...'
   end function shortened

   !> Most threads of a campaign: beyond a few for every core more of them only cost memory, up to a crash.
   integer function most_threads()
      integer, parameter :: always_allowed = 256, threads_per_core = 4

      most_threads = max(always_allowed, threads_per_core*omp_get_num_procs())
   end function most_threads

   !> Value of an override; quotes around a text may be left out, the shell has eaten them.
   pure function value_of(name, given) result(value)
      !> As group.key
      character(*), intent(in) :: name
      character(*), intent(in) :: given
      character(:), allocatable :: value
      integer :: position

      value = given
      ! An element of a list is a value like the list itself: vary(1) takes what vary takes.
      position = find_key(lower(name(:scan(name//'(', '(') - 1)))
      if (position == 0 .or. len(given) == 0) return
      if (scan(given(1:1), '''"') > 0) return
      if (keys(position)%kind == text_kind) value = quoted(given)
      if (keys(position)%kind == list_kind) value = quoted_words(given, ',')
   end function value_of

   !> One argument in its full length.
   function argument_text(position) result(text)
      integer, intent(in) :: position
      character(:), allocatable :: text
      integer :: length

      call get_command_argument(position, length=length)
      allocate (character(length) :: text)
      if (length > 0) call get_command_argument(position, text)
   end function argument_text

   !> What --help prints.
   pure function usage_text() result(text)
      character(:), allocatable :: text
      character(1), parameter :: end_of_line = new_line('a')

      text = 'rattle [options] FILE.nml [FILE.nml ...]      - reads standard input'//end_of_line// &
             '  --check                validate, show resolved and derived values, run nothing'//end_of_line// &
             '  --template [NAME]      commented input: gearbox, motion, film, sweep, campaign, threshold, or one &group'// &
             end_of_line// &
             '  --keys                 print tables of all keys and quantities, as in input/KEYS.md'//end_of_line// &
             '  --quantities           print the table of quantities as CSV'//end_of_line// &
             '  --set group.key=value  override a key in every file; may be repeated; @FILE has one in each line;'//end_of_line// &
             '                         gear(2).key is that of the second gear pair alone, gear.key that of all'//end_of_line// &
             '  --output DIR           folder of the output files'//end_of_line// &
             '  --resume               carry on an earlier run from its state, or begin it'//end_of_line// &
             '  --threads N            threads of a campaign; scenes that run side by side'//end_of_line// &
             '  --overwrite            replace output files of an earlier run'//end_of_line// &
             '  --quiet                nothing to the terminal but faults'//end_of_line// &
             '  --verbose              all of the log to the terminal, not the short report'//end_of_line// &
             '  --version              print the version'//end_of_line// &
             '  --help                 print this'//end_of_line// &
             'exit code: 0 complete; 1 a scene failed; 2 bad input, nothing was run; 3 system trouble;'//end_of_line// &
             '           128 + signal when interrupted'
   end function usage_text

end module command_line
