!> Files that an input names: they lie in its folder, so that an input and its data move together.
module input_path
   use errors, only: fault_list_t
   use file_system, only: lies_inside
   use scene_input, only: scene_input_t
   implicit none(type, external)
   private

   public :: path_of_file

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
      character(:), allocatable :: folder

      path = input%word(group, name)
      folder = input%file(:index(input%file, '/', back=.true.))
      if (index(path, '/') /= 1) path = folder//path
      if (lies_inside(path, folder)) return
      call input%add_fault(group, name, 'the file lies outside the folder of this input; bring it there', faults)
      path = ''
   end function path_of_file

end module input_path
