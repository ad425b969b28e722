!> The key table as text: a commented input (--template) and the tables of all keys and quantities (--keys), which
!> stand in input/KEYS.md; and the quantities as CSV (--quantities).
module key_page
   use input_key, only: allowed_text, key_t, list_kind, sensible_text, text_kind
   use key_table, only: find_key, keys, optional_groups, starts_group
   use quantities, only: a_code, kind_names, quantity_t, quantity_table
   use text, only: integer_text, quoted, quoted_words
   implicit none(type, external)
   private

   character(1), parameter :: end_of_line = new_line('a')
   !> How the rule of a key begins that names its tasks
   character(*), parameter :: by_task = 'scene.task='

   public :: template_text, page_text, quantities_text

contains

   !> A valid input with every key, its unit and its meaning; keys that need not be set are commented out.
   function template_text(group) result(text)
      !> One group, or empty for all
      character(*), intent(in) :: group
      character(:), allocatable :: text
      integer :: i

      text = ''
      do i = 1, size(keys)
         if (len(group) > 0 .and. keys(i)%group /= group) cycle
         if (starts_group(i)) text = text//'&'//trim(keys(i)%group)//end_of_line
         text = text//template_line(keys(i))
         if (starts_group(i + 1)) text = text//'/'//end_of_line//end_of_line
      end do
   end function template_text

   !> Meaning, then the assignment.
   function template_line(key) result(text)
      type(key_t), intent(in) :: key
      character(:), allocatable :: text
      character(:), allocatable :: value, unit

      value = trim(key%default)
      if (key%example /= '') value = trim(key%example)
      if (key%kind == list_kind) value = quoted_words(value, ' ')
      if (key%kind == text_kind .and. len(value) > 0) value = quoted(value)
      unit = trim(key%unit)
      if (unit == '-') unit = ''
      if (len(unit) > 0) unit = ' ['//unit//']'
      text = '   ! '//trim(key%sentence)//unit//' Allowed: '//allowed_text(key)//'.'
      if (key%with_gear /= '') text = text//' Default with &gear: '//trim(key%with_gear)//'.'
      text = text//end_of_line
      ! An example is there to be run; one of another task would contradict the motion that the template solves.
      if (key%example /= '' .and. all(optional_groups /= key%group) .and. &
          (key%used_when == '' .or. index(key%used_when, 'motion') > 0)) then
         text = text//'   '//trim(key%name)//' = '//value//end_of_line
      else
         text = text//'   ! '//trim(key%name)//' = '//value//end_of_line
      end if
   end function template_line

   !> Keys and quantities as tables in Markdown: the keys of a group by the tasks that use them.
   function page_text() result(text)
      character(:), allocatable :: text
      logical :: is_listed(size(keys))
      integer :: first, last, i

      text = ''
      is_listed = .false.
      last = 0
      do while (last < size(keys))
         first = last + 1
         last = first
         do while (.not. starts_group(last + 1))
            last = last + 1
         end do
         text = text//'## &'//trim(keys(first)%group)//end_of_line//end_of_line
         if (any([(len(tasks_of(keys(i))) == 0, i=first, last)])) call add_table(text, keys(first:last), '', is_listed(first:last))
         do i = first, last
            if (.not. is_listed(i)) call add_table(text, keys(first:last), tasks_of(keys(i)), is_listed(first:last))
         end do
      end do
      text = text//quantity_rows()
   end function page_text

   !> Add the keys of a group that certain tasks use.
   subroutine add_table(text, group, tasks, is_listed)
      character(:), allocatable, intent(inout) :: text
      !> All keys of the group
      type(key_t), intent(in) :: group(:)
      !> As words between bars; empty: all tasks
      character(*), intent(in) :: tasks
      !> Whether a key has its row
      logical, intent(inout) :: is_listed(:)
      character(:), allocatable :: column
      logical :: has_needs
      integer :: i

      has_needs = .false.
      do i = 1, size(group)
         if (tasks_of(group(i)) == tasks) has_needs = has_needs .or. len(needs_of(group(i))) > 0
      end do
      column = ''
      if (has_needs) column = ' used with |'
      if (len(tasks) > 0) text = text//'For `'//without_bars(tasks, '`, `')//'`:'//end_of_line//end_of_line
      text = text//'| key | unit | default | allowed | sensible |'//column//' meaning |'//end_of_line// &
             '|---|---|---|---|---|'//repeat('---|', merge(2, 1, has_needs))//end_of_line
      do i = 1, size(group)
         if (tasks_of(group(i)) /= tasks) cycle
         text = text//page_row(group(i), has_needs)
         is_listed(i) = .true.
      end do
      text = text//end_of_line
   end subroutine add_table

   !> The tasks that use a key, as words with bars between; empty: all do. A key that another decides on has the tasks of that one.
   pure recursive function tasks_of(key) result(tasks)
      type(key_t), intent(in) :: key
      character(:), allocatable :: tasks
      character(:), allocatable :: decider

      tasks = key%used_when(:index(trim(key%used_when)//' & ', ' & ') - 1)
      if (index(tasks, by_task) == 1) then
         tasks = tasks(len(by_task) + 1:)
      else if (len(tasks) > 0 .and. index(tasks, ' ') == 0) then
         decider = tasks(:scan(tasks//'=', '=|') - 1)
         tasks = tasks_of(keys(find_key(decider)))
      else
         tasks = ''
      end if
   end function tasks_of

   !> What else must stand in an input for a key to be used, or must not; empty: nothing.
   pure function needs_of(key) result(needs)
      type(key_t), intent(in) :: key
      character(:), allocatable :: needs
      character(*), parameter :: without = 'without '
      character(:), allocatable :: rules, rule
      integer :: behind

      needs = ''
      if (key%given_by /= '') needs = ', no `&'//trim(key%given_by)//'`'
      rules = trim(key%used_when)
      do while (len(rules) > 0)
         behind = index(rules//' & ', ' & ')
         rule = rules(:behind - 1)
         rules = rules(min(len(rules), behind + 2) + 1:)
         if (index(rule, by_task) == 1) cycle
         if (index(rule, without) == 1) then
            needs = needs//', no `'//rule(len(without) + 1:)//'`'
         else
            needs = needs//', `'//without_bars(rule, merge('` or `', ' or   ', index(rule, '=') == 0))//'`'
         end if
      end do
      needs = needs(min(len(needs), 2) + 1:)
   end function needs_of

   function page_row(key, has_needs) result(text)
      type(key_t), intent(in) :: key
      !> Whether the table has a column for what else is needed
      logical, intent(in) :: has_needs
      character(:), allocatable :: text
      character(:), allocatable :: default, sensible, needs

      sensible = sensible_text(key)
      if (len(sensible) == 0) sensible = '-'
      default = trim(key%default)
      if (default == 'required') default = '**required**'
      if (default == '') default = '-'
      if (key%with_gear /= '') default = default//'; with &gear '//trim(key%with_gear)
      needs = ''
      if (has_needs) needs = needs_of(key)//' | '
      text = '| `'//trim(key%name)//'` | '//trim(key%unit)//' | '//default//' | '//allowed_text(key)//' | '// &
             sensible//' | '//needs//trim(key%sentence)//' |'//end_of_line
   end function page_row

   !> Quantities for people: a table in Markdown.
   function quantity_rows() result(text)
      character(:), allocatable :: text
      type(quantity_t) :: quantity
      integer :: i

      text = '## Quantities'//end_of_line//end_of_line// &
             'What is reported of a scene. A summary has words where tables have codes, .true. and .false. where they have 1 '// &
    'and 0.'//end_of_line//end_of_line//'| quantity | unit | reported in | meaning |'//end_of_line//'|---|---|---|---|'//end_of_line
      do i = 1, size(quantity_table)
         quantity = quantity_table(i)
         text = text//'| `'//trim(quantity%name)//'` | '//trim(quantity%unit)//' | '//trim(quantity%reported_in)//' | '// &
                trim(quantity%meaning)
         if (quantity%kind == a_code) text = text//' '//without_bars(words_with_codes(quantity), '; ')//'.'
         text = text//' |'//end_of_line
      end do
   end function quantity_rows

   !> Words with another separator for each bar, which would end a cell of a table.
   pure function without_bars(words, separator) result(list)
      character(*), intent(in) :: words
      character(*), intent(in) :: separator
      character(:), allocatable :: list
      integer :: k

      list = ''
      do k = 1, len(words)
         if (words(k:k) == '|') then
            list = list//separator
         else
            list = list//words(k:k)
         end if
      end do
   end function without_bars

   !> Quantities for programs, as CSV.
   function quantities_text() result(text)
      character(:), allocatable :: text
      type(quantity_t) :: quantity
      integer :: i

      text = 'name,unit,kind,words,meaning'//end_of_line
      do i = 1, size(quantity_table)
         quantity = quantity_table(i)
         text = text//trim(quantity%name)//','//trim(quantity%unit)//','//trim(kind_names(quantity%kind))//',"'// &
                words_with_codes(quantity)//'","'//trim(quantity%meaning)//'"'//end_of_line
      end do
   end function quantities_text

   !> Words of the codes, each behind its code, a bar between two.
   pure function words_with_codes(quantity) result(words)
      type(quantity_t), intent(in) :: quantity
      character(:), allocatable :: words
      integer :: code, k

      words = ''
      if (quantity%kind /= a_code) return
      code = quantity%first_code
      words = integer_text(code)//' '
      do k = 1, len_trim(quantity%words)
         words = words//quantity%words(k:k)
         if (quantity%words(k:k) /= '|') cycle
         code = code + 1
         words = words//integer_text(code)//' '
      end do
   end function words_with_codes

end module key_page
