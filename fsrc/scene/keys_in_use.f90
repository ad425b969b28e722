!> Which keys the choices of an input make use of, after the rules in the key table.
module keys_in_use
   use key_table, only: find_key, keys, optional_groups
   use scene_input, only: scene_input_t
   implicit none(type, external)
   private

   public :: in_use

contains

   !> Whether a key is in use. Where a deciding key is itself in doubt, yes.
   pure recursive logical function in_use(input, position) result(used)
      type(scene_input_t), intent(in) :: input
      !> Position in the key table
      integer, intent(in) :: position
      character(:), allocatable :: rules
      integer :: conjunction

      used = .true.
      if (any(optional_groups == keys(position)%group)) used = input%has_group(trim(keys(position)%group))
      if (keys(position)%given_by /= '') used = .not. input%has_group(trim(keys(position)%given_by))
      rules = trim(keys(position)%used_when)
      do while (used .and. len(rules) > 0)
         conjunction = index(rules//' & ', ' & ')
         used = rule_holds(input, rules(:conjunction - 1))
         rules = rules(min(len(rules), conjunction + 2) + 1:)
      end do
   end function in_use

   !> Whether 'group.key=word|word' holds, and the deciding key is itself in use.
   pure recursive logical function rule_holds(input, rule) result(holds)
      type(scene_input_t), intent(in) :: input
      character(*), intent(in) :: rule
      integer :: dot, equals, decider

      dot = index(rule, '.')
      equals = index(rule, '=')
      decider = find_key(rule(:dot - 1), rule(dot + 1:equals - 1))
      holds = in_use(input, decider)
      if (.not. holds .or. .not. input%entries(decider)%present .or. input%entries(decider)%faulty) return
      holds = index('|'//rule(equals + 1:)//'|', '|'//input%entries(decider)%word//'|') > 0
   end function rule_holds

end module keys_in_use
