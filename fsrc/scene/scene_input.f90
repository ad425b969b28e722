!> The input of one scene as typed values, one per line of the key table, each with its place.
module scene_input
   use errors, only: fault_list_t
   use file_system, only: lies_inside
   use input_entry, only: close_list, entry_t, forget_elements, is_overridden, new_entry, rows_of, set_entry
   use input_key, only: integer_kind, key_t, real_kind
   use key_table, only: find_key, keys, known_group, nearest_group, nearest_key
   use kinds, only: dp
   use namelist_text, only: assignment_t, repeated_group
   use scene_types, only: model_automatic, model_closure, numbers_t, scene_t, set_number
   use text, only: integer_text
   use word_list, only: split_words, word_position, word_t
   implicit none(type, external)
   private

   !> All keys of one scene.
   type, public :: scene_input_t
      !> Name of the input for the faults
      character(:), allocatable :: file
      type(entry_t), allocatable :: entries(:)
      !> Which of several gear pairs it takes, from 1, and the line of its group; 0: there is one pair at most
      integer :: pair = 1
      integer :: line_of_pair = 0
      !> What was found on the way from its files to its keys, as comments of the resolved input
      character(:), allocatable :: found
      !> What is wrong with it
      type(fault_list_t) :: faults
   contains
      procedure :: set_all
      procedure :: forget_replaced_ranges
      procedure :: close_lists
      procedure :: put_numbers
      procedure :: put_laws
      procedure :: choose_defaults
      procedure :: is_given
      procedure :: has_group
      procedure :: is_faulty
      procedure :: number => number_of
      procedure :: count => count_of
      procedure :: choice => choice_of
      procedure :: choices => choices_of
      procedure :: flag => flag_of
      procedure :: word => word_of
      procedure :: words => words_of
      procedure :: numbers => numbers_of
      procedure :: columns => columns_of
      procedure :: file_path
      procedure :: path_beside
      procedure, private :: folder
      procedure :: refuse
      procedure :: report
   end type scene_input_t

   public :: new_scene_input

contains

   !> Input without any value but the defaults.
   function new_scene_input(file, pair, line) result(input)
      !> Name of the input for the faults
      character(*), intent(in) :: file
      !> Which of several gear pairs it takes, and the line of its group, for the faults; absent: there is one at most
      integer, optional, intent(in) :: pair
      integer, optional, intent(in) :: line
      type(scene_input_t) :: input
      integer :: i

      input%file = file
      input%found = ''
      allocate (input%entries(size(keys)))
      do i = 1, size(keys)
         input%entries(i) = new_entry(keys(i), file)
         if (present(line) .and. keys(i)%group == repeated_group) input%entries(i)%line = line
      end do
      if (present(pair)) input%pair = pair
      if (present(line)) input%line_of_pair = line
   end function new_scene_input

   !> Take the assignments of a text; later calls (overrides) replace earlier values.
   subroutine set_all(self, assignments, file, overriding)
      class(scene_input_t), intent(inout) :: self
      !> Assignments in their order
      type(assignment_t), intent(in) :: assignments(:)
      !> Name of their source for the faults
      character(*), intent(in) :: file
      !> Whether a key may be set that an earlier call has set
      logical, intent(in) :: overriding
      character(:), allocatable :: reported
      integer :: i, position

      reported = ''
      do i = 1, size(assignments)
         associate (assignment => assignments(i))
            if (.not. known_group(assignment%group)) then
               if (assignment%group /= reported) call self%faults%add(file, assignment%line, assignment%group, '', &
                                               'unknown group; the nearest known group is &'//nearest_group(assignment%group))
               reported = assignment%group
               cycle
            end if
            ! A key that is set on the command line is set in every pair.
            if (assignment%group == repeated_group .and. .not. overriding .and. assignment%occurrence /= self%pair) cycle
            if (len(assignment%key) == 0) cycle
            position = find_key(assignment%group//'.'//assignment%key)
            if (position == 0) then
               if (assignment%sound) call self%faults%add(file, assignment%line, assignment%group, assignment%key, &
                                                          'unknown key; '//nearest_key(assignment%group, assignment%key))
               cycle
            end if
            call set_entry(keys(position), assignment, overriding, self%entries(position), file, self%faults)
         end associate
      end do
   end subroutine set_all

   !> Where the command line says which keys vary, forget what the file says of others: what it gives behind the last one, values of
   !> one that gets a range, and a table of scenes.
   subroutine forget_replaced_ranges(self)
      class(scene_input_t), intent(inout) :: self
      character(*), parameter :: lists(*) = [character(14) :: 'campaign.scale', 'campaign.first', 'campaign.last', 'campaign.count']
      integer :: csv, varied, i

      associate (vary => self%entries(find_key('campaign.vary')), first => self%entries(find_key('campaign.first')), &
                 values => self%entries(find_key('campaign.values')))
         if (.not. is_overridden(vary, 1, 1)) return
         varied = rows_of(vary)
         do i = 1, size(lists)
            call forget_elements(self%entries(find_key(trim(lists(i)))), varied + 1, 1)
         end do
         do i = 1, size(values%elements, 2)
            if (i > varied .or. is_overridden(first, i, 1)) call forget_elements(values, 1, i)
         end do
      end associate
      csv = find_key('campaign.csv')
      if (self%entries(csv)%line > 0) self%entries(csv) = new_entry(keys(csv), self%file)
   end subroutine forget_replaced_ranges

   !> Put the lists together, once all their elements are known.
   subroutine close_lists(self)
      class(scene_input_t), intent(inout) :: self
      integer :: i

      do i = 1, size(keys)
         call close_list(keys(i), self%entries(i), self%faults)
      end do
   end subroutine close_lists

   !> Put all numbers that have a value into a scene.
   pure subroutine put_numbers(self, scene)
      class(scene_input_t), intent(in) :: self
      type(scene_t), intent(inout) :: scene
      integer :: i

      scene%gear%given = self%has_group('gear')
      scene%oil%given = self%has_group('oil')
      do i = 1, size(keys)
         if (.not. self%entries(i)%present .or. self%entries(i)%faulty) cycle
         if (keys(i)%kind == real_kind) call set_number(scene, keys(i)%group, keys(i)%name, self%entries(i)%number)
         if (keys(i)%kind == integer_kind) call set_number(scene, keys(i)%group, keys(i)%name, real(self%entries(i)%count, dp))
      end do
   end subroutine put_numbers

   !> Put the laws of film and oil into a scene, by which the rules between its numbers differ.
   pure subroutine put_laws(self, scene)
      class(scene_input_t), intent(in) :: self
      type(scene_t), intent(inout) :: scene

      scene%film%law = self%choice('film.law')
      scene%film%model = self%choice('film.model')
      scene%film%automatic = scene%film%model == model_automatic
      if (scene%film%automatic) scene%film%model = model_closure
      scene%lubricant%viscosity_law = self%choice('lubricant.viscosity_law')
      scene%contact%flattening_included = self%flag('contact.flattening_included')
   end subroutine put_laws

   !> Defaults that depend on other keys: gear pairs have their own, the elastohydrodynamic law its model, and no other law another
   !> law of viscosity than Barus'.
   subroutine choose_defaults(self)
      class(scene_input_t), intent(inout) :: self
      type(key_t) :: key
      integer :: i, line

      do i = 1, size(keys)
         if (keys(i)%with_gear == '' .or. self%entries(i)%given .or. .not. self%has_group('gear')) cycle
         key = keys(i)
         key%default = key%with_gear
         line = self%entries(i)%line
         self%entries(i) = new_entry(key, self%file)
         self%entries(i)%line = line
      end do
      if (self%word('film.law') == 'elastohydrodynamic') then
         if (.not. self%is_given('film.model')) self%entries(find_key('film.model'))%word = 'closure'
         if (self%word('film.model') == 'resolved') call choose_nodes(self)
      else
         i = find_key('lubricant.viscosity_law')
         if (.not. self%entries(i)%given) self%entries(i)%word = trim(keys(i)%default)
      end if
   end subroutine choose_defaults

   !> Accuracy of films in nodes unless given, and as many nodes as it needs unless given (tests/stress/NODAL_ACCURACY.md).
   subroutine choose_nodes(self)
      class(scene_input_t), intent(inout) :: self
      character(*), parameter :: names(*) = [character(3) :: '32', '48', '64', '128']
      real(dp), parameter :: least_accuracies(*) = [1.0e-2_dp, 3.0e-3_dp, 1.0e-3_dp, 0.0_dp]
      type(key_t) :: key
      integer :: accuracy, nodes

      accuracy = find_key('solver.accuracy')
      nodes = find_key('film.nodes')
      if (.not. self%entries(accuracy)%given) then
         key = keys(accuracy)
         key%default = '3.0e-3'
         self%entries(accuracy) = new_entry(key, self%file)
      end if
      if (self%entries(accuracy)%faulty .or. self%entries(nodes)%given) return
      key = keys(nodes)
      key%default = names(findloc(self%entries(accuracy)%number >= least_accuracies, .true., dim=1))
      self%entries(nodes) = new_entry(key, self%file)
   end subroutine choose_nodes

   !> Whether the user set a key.
   pure logical function is_given(self, key)
      class(scene_input_t), intent(in) :: self
      !> As group.name
      character(*), intent(in) :: key

      is_given = self%entries(find_key(key))%given
   end function is_given

   !> Whether the user set any key of a group.
   pure logical function has_group(self, group)
      class(scene_input_t), intent(in) :: self
      character(*), intent(in) :: group

      has_group = any(keys%group == group .and. self%entries%given) .or. (group == repeated_group .and. self%line_of_pair > 0)
   end function has_group

   !> Whether a key was set to something that could not be read, so that no rule can be applied to it.
   pure logical function is_faulty(self, key)
      class(scene_input_t), intent(in) :: self
      !> As group.name
      character(*), intent(in) :: key

      is_faulty = self%entries(find_key(key))%faulty
   end function is_faulty

   !> Value of a real key, 0 where it has none.
   pure real(dp) function number_of(self, key)
      class(scene_input_t), intent(in) :: self
      !> As group.name
      character(*), intent(in) :: key

      number_of = self%entries(find_key(key))%number
   end function number_of

   !> Value of an integer key.
   pure integer function count_of(self, key)
      class(scene_input_t), intent(in) :: self
      !> As group.name
      character(*), intent(in) :: key

      count_of = self%entries(find_key(key))%count
   end function count_of

   !> Value of a logical key.
   pure logical function flag_of(self, key)
      class(scene_input_t), intent(in) :: self
      !> As group.name
      character(*), intent(in) :: key

      flag_of = self%entries(find_key(key))%flag
   end function flag_of

   !> Value of a text key, empty where it has none.
   pure function word_of(self, key) result(word)
      class(scene_input_t), intent(in) :: self
      !> As group.name
      character(*), intent(in) :: key
      character(:), allocatable :: word

      word = self%entries(find_key(key))%word
   end function word_of

   !> Blank-separated words of a list key.
   pure function words_of(self, key) result(words)
      class(scene_input_t), intent(in) :: self
      !> As group.name
      character(*), intent(in) :: key
      character(:), allocatable :: words

      words = self%entries(find_key(key))%words
   end function words_of

   !> Numbers of a list key.
   pure function numbers_of(self, key) result(numbers)
      class(scene_input_t), intent(in) :: self
      !> As group.name
      character(*), intent(in) :: key
      real(dp), allocatable :: numbers(:)

      numbers = self%entries(find_key(key))%numbers
   end function numbers_of

   !> Columns of a table key.
   pure function columns_of(self, key) result(columns)
      class(scene_input_t), intent(in) :: self
      !> As group.name
      character(*), intent(in) :: key
      type(numbers_t), allocatable :: columns(:)

      allocate (columns, source=self%entries(find_key(key))%columns)
   end function columns_of

   !> Position of the word of a key among its choices in the table, from 1.
   pure integer function choice_of(self, key)
      class(scene_input_t), intent(in) :: self
      !> As group.name
      character(*), intent(in) :: key
      integer :: position

      position = find_key(key)
      choice_of = word_position(trim(keys(position)%choices), self%entries(position)%word)
   end function choice_of

   !> Positions of the words of a list key among its choices in the table, from 1.
   pure function choices_of(self, key) result(choices)
      class(scene_input_t), intent(in) :: self
      !> As group.name
      character(*), intent(in) :: key
      integer, allocatable :: choices(:)
      type(word_t), allocatable :: words(:)
      integer :: position, i

      position = find_key(key)
      allocate (words, source=split_words(self%entries(position)%words))
      choices = [(word_position(trim(keys(position)%choices), words(i)%text), i=1, size(words))]
   end function choices_of

   !> Path of the file that a key names; empty, with a fault, if it lies elsewhere than in the folder of the input: an input and its
   !> data move together.
   function file_path(self, key) result(path)
      class(scene_input_t), intent(inout) :: self
      !> As group.name
      character(*), intent(in) :: key
      character(:), allocatable :: path

      path = self%path_beside(self%word(key))
      if (lies_inside(path, self%folder())) return
      call self%refuse(key, 'the file lies outside the folder of this input; bring it there')
      path = ''
   end function file_path

   !> A path as it is if it begins with the root, else from the folder of the input; empty stays empty.
   pure function path_beside(self, given) result(path)
      class(scene_input_t), intent(in) :: self
      !> The path that the input names
      character(*), intent(in) :: given
      character(:), allocatable :: path

      path = given
      if (len(given) > 0 .and. index(given, '/') /= 1) path = self%folder()//given
   end function path_beside

   !> Folder of the input with a slash at its end; empty for the working folder.
   pure function folder(self)
      class(scene_input_t), intent(in) :: self
      character(:), allocatable :: folder

      folder = self%file(:index(self%file, '/', back=.true.))
   end function folder

   !> Add a fault at the place of a key: where it was set, or without a line if it was not.
   subroutine refuse(self, key, message)
      class(scene_input_t), intent(inout) :: self
      !> As group.name
      character(*), intent(in) :: key
      !> What is wrong and what is allowed
      character(*), intent(in) :: message
      integer :: position

      position = find_key(key)
      associate (entry => self%entries(position), known => keys(position))
         call self%faults%add(entry%file, entry%line, trim(known%group), trim(known%name), message)
      end associate
   end subroutine refuse

   !> Report what was found in a file.
   pure subroutine report(self, finding)
      class(scene_input_t), intent(inout) :: self
      !> As 'group.name = number'
      character(*), intent(in) :: finding

      self%found = self%found//'! derived: '//finding//new_line('a')
   end subroutine report

end module scene_input
