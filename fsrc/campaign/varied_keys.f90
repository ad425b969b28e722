!> Which keys a campaign may vary: the numbers that describe a motion scene.
module varied_keys
   use input_key, only: integer_kind, real_kind
   use key_table, only: find_key, keys, known_group, nearest_group, nearest_key
   use text, only: lower
   implicit none(type, external)
   private

   public :: find_varied_key, varied_key_name, is_whole

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
      integer :: dot

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
      position = find_key(group, key)
      if (position == 0) then
         message = 'unknown key; '//nearest_key(group, key)
      else if (keys(position)%kind /= real_kind .and. keys(position)%kind /= integer_kind) then
         message = 'this key is not a number, so it cannot be varied'
      else if (group == 'points' .or. group == 'output') then
         message = 'this key does not describe the motion of a scene, so it cannot be varied'
      end if
      if (len(message) > 0) position = 0
   end subroutine find_varied_key

   !> Name of a key as 'group.key'.
   pure function varied_key_name(position) result(name)
      !> Position in the key table
      integer, intent(in) :: position
      character(:), allocatable :: name

      name = trim(keys(position)%group)//'.'//trim(keys(position)%name)
   end function varied_key_name

   !> Whether a key takes whole numbers only.
   pure logical function is_whole(position)
      !> Position in the key table
      integer, intent(in) :: position

      is_whole = keys(position)%kind == integer_kind
   end function is_whole

end module varied_keys
