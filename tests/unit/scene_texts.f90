!> Scenes of inputs that stand in a test as texts.
module scene_texts
   use completed_scene, only: complete_scene
   use errors, only: fault_list_t
   use file_system, only: delete_file
   use scene_reader, only: override_t, read_scenes
   use scene_types, only: scene_t
   implicit none(type, external)
   private

   character(*), parameter, public :: input_path = 'unit_test_scene.nml'

   public :: read_text

contains

   !> Read a text as the program reads an input of this text; what follows from the scene is derived.
   subroutine read_text(text, scene, faults)
      character(*), intent(in) :: text
      !> The first scene of the text; of use only if no fault was found
      type(scene_t), intent(out) :: scene
      type(fault_list_t), intent(out) :: faults
      type(scene_t), allocatable :: scenes(:)
      type(override_t) :: none(0)
      integer :: unit

      open (newunit=unit, file=input_path, status='replace', action='write')
      write (unit, '(a)') text
      close (unit)
      call read_scenes(input_path, none, scenes, faults)
      call delete_file(input_path)
      if (faults%count() > 0) return
      scene = scenes(1)
      call complete_scene(scene, faults)
   end subroutine read_text

end module scene_texts
