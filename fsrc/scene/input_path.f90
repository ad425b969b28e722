!> Files that an input names: they lie in its folder, so that an input and its data move together.
module input_path
   use errors, only: fault_list_t
   use file_system, only: lies_inside
   use scene_input, only: scene_input_t
   implicit none(type, external)
   private

   public :: path_of_file
   public :: path_beside

contains

   !> Path of the file that a key names; empty, with a fault, if it lies elsewhere.
   function path_of_file(input, group, name, faults) result(path)
      type(scene_input_t), intent(in) :: input
      !> The key
      character(*), intent(in) :: group
      character(*), intent(in) :: name
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      character(:), allocatable :: path

      path = path_beside(input, input%word(group, name))
      if (lies_inside(path, folder_of(input))) return
      call input%add_fault(group, name, 'the file lies outside the folder of this input; bring it there', faults)
      path = ''
   end function path_of_file

   !> A path as it is if it begins with the root, else from the folder of the input; empty stays empty.
   pure function path_beside(input, given) result(path)
      type(scene_input_t), intent(in) :: input
      !> The path that the input names
      character(*), intent(in) :: given
      character(:), allocatable :: path

      path = given
      if (len(given) > 0 .and. index(given, '/') /= 1) path = folder_of(input)//given
   end function path_beside

   !> Folder of the input with a slash at its end; empty for the working folder.
   pure function folder_of(input) result(folder)
      type(scene_input_t), intent(in) :: input
      character(:), allocatable :: folder

      folder = input%file(:index(input%file, '/', back=.true.))
   end function folder_of

end module input_path
