!> Which keys the choices of an input make use of, after the rules in the key table.
module keys_in_use
   use key_table, only: find_key, keys, optional_groups
   use scene_input, only: scene_input_t
   implicit none(type, external)
   private

   !> How a rule begins that forbids a key
   character(*), parameter :: without = 'without '

   public :: in_use, reason_unused

contains

   !> Whether a key is in use. Where a deciding key is itself in doubt, yes.
   pure recursive logical function in_use(input, position) result(used)
      type(scene_input_t), intent(in) :: input
      !> Position in the key table
      integer, intent(in) :: position

      used = .true.
      if (any(optional_groups == keys(position)%group)) used = input%has_group(trim(keys(position)%group))
      if (keys(position)%given_by /= '') used = .not. input%has_group(trim(keys(position)%given_by))
      if (used) used = broken_rule(input, position) == ''
   end function in_use

   !> What keeps a key that is given from being used by a rule of the table, and what to do.
   pure function reason_unused(input, position) result(words)
      type(scene_input_t), intent(in) :: input
      !> Position in the key table
      integer, intent(in) :: position
      character(:), allocatable :: words

      words = broken_rule(input, position)
      if (index(words, without) == 1) then
         words = 'it excludes '//words(len(without) + 1:)//'; leave one of the two out'
      else
         words = 'this key is used only with '//words//'; leave it out'
      end if
   end function reason_unused

   !> The first rule of a key that does not hold; empty if all do.
   pure recursive function broken_rule(input, position) result(rule)
      type(scene_input_t), intent(in) :: input
      !> Position in the key table
      integer, intent(in) :: position
      character(:), allocatable :: rule
      character(:), allocatable :: rules
      integer :: conjunction

      rules = trim(keys(position)%used_when)
      do while (len(rules) > 0)
         conjunction = index(rules//' & ', ' & ')
         rule = rules(:conjunction - 1)
         if (.not. rule_holds(input, rule)) return
         rules = rules(min(len(rules), conjunction + 2) + 1:)
      end do
      rule = ''
   end function broken_rule

   !> Whether a rule holds; a deciding word counts only where its key is itself in use.
   pure recursive logical function rule_holds(input, rule) result(holds)
      type(scene_input_t), intent(in) :: input
      character(*), intent(in) :: rule
      integer :: equals, decider, first, last

      equals = index(rule, '=')
      if (equals > 0) then
         decider = find_key(rule(:equals - 1))
         holds = in_use(input, decider)
         if (.not. holds .or. .not. input%entries(decider)%present .or. input%entries(decider)%faulty) return
         holds = index('|'//rule(equals + 1:)//'|', '|'//input%entries(decider)%word//'|') > 0
      else if (index(rule, without) == 1) then
         holds = .not. input%entries(find_key(rule(len(without) + 1:)))%given
      else
         holds = .false.
         first = 1
         do while (first <= len(rule))
            last = first + index(rule(first:)//'|', '|') - 2
            holds = holds .or. input%entries(find_key(rule(first:last)))%given
            first = last + 2
         end do
      end if
   end function rule_holds

end module keys_in_use
