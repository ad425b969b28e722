!> The text that a checked input comes to: what a result file keeps, --check shows and a resumed run compares.
module resolved_input
   use input_entry, only: numbers_text, value_text
   use input_key, only: table_kind
   use key_table, only: keys, starts_group
   use keys_in_use, only: in_use
   use scene_input, only: scene_input_t
   use text, only: integer_text, quoted
   implicit none(type, external)
   private

   public :: resolved_text

contains

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
               body = body//'   '//trim(keys(i)%name)//'(:, '//integer_text(column)//') = '// &
                      numbers_text(input%entries(i)%columns(column)%numbers)//new_line('a')
            end do
         else if (is_told(i)) then
            body = body//'   '//trim(keys(i)%name)//' = '//value_text(keys(i), input%entries(i))//new_line('a')
         end if
         if (.not. starts_group(i + 1)) cycle
         if (len(body) > 0) text = text//'&'//trim(keys(i)%group)//new_line('a')//body//'/'//new_line('a')
         body = ''
      end do

   contains

      !> Whether a key belongs into the text: it has a value, is in use, and is no matter of this machine.
      pure logical function is_told(i)
         integer, intent(in) :: i

         is_told = input%entries(i)%present .and. in_use(input, i)
         if (keys(i)%group == 'output') is_told = is_told .and. keys(i)%name /= 'directory' .and. keys(i)%name /= 'overwrite'
         ! In a film task the absent model means more than its default.
         if (keys(i)%name == 'model') &
            is_told = is_told .and. (input%entries(i)%given .or. input%word('scene', 'task') /= 'film')
      end function is_told

   end function resolved_text

end module resolved_input
