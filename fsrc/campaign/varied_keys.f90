!> The keys that a campaign varies: which may be, their values put into a scene, and whether these make one.
module varied_keys
   use derived_scene, only: derive, derived_rules
   use input_key, only: allowed_text, in_range, integer_kind, is_computable, not_computable_text, real_kind
   use key_table, only: find_key, key_name, keys, known_group, nearest_group, nearest_key
   use kinds, only: dp
   use mistaken_units, only: likely_reason, meant_behind
   use scene_rules, only: broken_rules, rule_t
   use scene_types, only: scene_t, set_number
   use text, only: lower, real_text
   implicit none(type, external)
   private

   public :: find_varied_key, pair_position, varied_name, is_whole, set_varied_keys, is_valid_scene, why_invalid

contains

   !> Position of 'group.key' in the key table.
   pure subroutine find_varied_key(name, position, message)
      !> As the user wrote it, without blanks around it
      character(*), intent(in) :: name
      !> Position, 0 if this key cannot be varied
      integer, intent(out) :: position
      !> Why not; empty if it can
      character(:), allocatable, intent(out) :: message
      character(:), allocatable :: group, key
      type(scene_t) :: scene
      integer :: dot
      logical :: known

      position = 0
      message = ''
      dot = index(name, '.')
      if (dot == 0) then
         message = "a key is named as group.key, such as load.mass"
         return
      end if
      group = lower(name(:dot - 1))
      key = lower(name(dot + 1:))
      if (.not. known_group(group)) then
         message = 'unknown group; the nearest known group is '//nearest_group(group)
         return
      end if
      position = find_key(lower(name))
      if (position == 0) then
         message = 'unknown key; '//nearest_key(group, key)
      else if (keys(position)%kind /= real_kind .and. keys(position)%kind /= integer_kind) then
         message = 'this key is not a number, so it cannot be varied'
      else
         call set_number(scene, keys(position)%group, keys(position)%name, 0.0_dp, known)
         if (.not. known) message = 'this key does not describe the motion of a scene, so it cannot be varied'
      end if
      if (len(message) > 0) position = 0
   end subroutine find_varied_key

   !> Position in the key table of the key that stands for a gear pair as a whole, by its number.
   pure integer function pair_position()
      pair_position = find_key('gear.name')
   end function pair_position

   !> What a varied key is called in results.
   pure function varied_name(position) result(name)
      !> Position in the key table
      integer, intent(in) :: position
      character(:), allocatable :: name

      name = key_name(position)
      if (position == pair_position()) name = 'gear'
   end function varied_name

   !> Whether a key takes whole numbers only.
   pure logical function is_whole(position)
      !> Position in the key table
      integer, intent(in) :: position

      is_whole = keys(position)%kind == integer_kind
   end function is_whole

   !> Set the varied keys of a scene, in their order.
   pure subroutine set_varied_keys(scene, positions, values)
      !> The scene
      type(scene_t), intent(inout) :: scene
      !> Keys by their positions in the key table
      integer, intent(in) :: positions(:)
      !> Their values, SI units
      real(dp), intent(in) :: values(:)
      integer :: i

      do i = 1, size(positions)
         call set_number(scene, keys(positions(i))%group, keys(positions(i))%name, values(i))
      end do
      call derive(scene)
   end subroutine set_varied_keys

   !> Whether every value is in the range of its key and the scene as a whole is one.
   pure logical function is_valid_scene(scene, positions, values)
      !> The scene with its values set
      type(scene_t), intent(in) :: scene
      !> Varied keys, by their positions in the key table
      integer, intent(in) :: positions(:)
      !> Their values
      real(dp), intent(in) :: values(:)
      integer :: i

      is_valid_scene = .true.
      do i = 1, size(positions)
         is_valid_scene = is_valid_scene .and. in_range(keys(positions(i)), values(i)) &
                          .and. is_computable(keys(positions(i)), values(i))
      end do
      ! A value that is not allowed may overflow together with another.
      if (is_valid_scene) is_valid_scene = size(broken_rules(scene)) == 0
      if (is_valid_scene) is_valid_scene = size(derived_rules(scene)) == 0
   end function is_valid_scene

   !> What is wrong with a scene that is not valid: the first of its varied keys whose value is not allowed, or the rule that the
   !> scene as a whole breaks, and values that were surely meant in another unit.
   pure function why_invalid(scene, positions, values) result(words)
      !> The scene with its values set
      type(scene_t), intent(in) :: scene
      !> Varied keys, by their positions in the key table
      integer, intent(in) :: positions(:)
      !> Their values
      real(dp), intent(in) :: values(:)
      character(:), allocatable :: words
      type(rule_t), allocatable :: broken(:)
      integer :: i

      do i = 1, size(positions)
         if (in_range(keys(positions(i)), values(i)) .and. is_computable(keys(positions(i)), values(i))) cycle
         words = key_name(positions(i))//': '//not_computable_text(keys(positions(i)), values(i))
         if (.not. in_range(keys(positions(i)), values(i))) words = key_name(positions(i))//': '//real_text(values(i))// &
                                                         ' is not allowed; allowed: '//allowed_text(keys(positions(i)))
         words = words//meant_behind(keys(positions(i)), values(i))
         return
      end do
      ! What is wrong with the data of a gear or an oil comes before what follows from it.
      allocate (broken, source=[derived_rules(scene), broken_rules(scene)])
      words = broken(1)%keys(:index(broken(1)%keys, ' ') - 1)//': '//trim(broken(1)%sentence)
      do i = 1, size(positions)
         words = words//likely_reason(keys(positions(i)), values(i))
      end do
   end function why_invalid

end module varied_keys
