!> The command that makes a file that the input takes of a recording as it comes from a test bench.
module recording_command
   use scene_input, only: scene_input_t
   use text, only: integer_text, printable
   implicit none(type, external)
   private

   character(*), parameter :: script = 'scripts/recording.py '

   public :: command_of_cycle, command_of_run_up

contains

   !> Whole cycles, resampled and averaged.
   function command_of_cycle(input, group, path, option) result(command)
      type(scene_input_t), intent(in) :: input
      !> 'load' or 'shaft'
      character(*), intent(in) :: group
      !> Path of the recording
      character(*), intent(in) :: path
      !> A further option; absent: none
      character(*), intent(in), optional :: option
      character(:), allocatable :: command

      command = script//shown(path)
      if (len(input%word(group//'.signal_column')) > 0) command = command//" --channel '"//input%word(group//'.signal_column')//"'"
      if (group == 'shaft') command = command//' --revolutions '//integer_text(input%count('shaft.cycle_revolutions'))
      if (present(option)) command = command//' '//option
      command = command//' --output '//named(path, 'cycle')
   end function command_of_cycle

   !> A table of a run-up.
   function command_of_run_up(path) result(command)
      !> Path of the recording
      character(*), intent(in) :: path
      character(:), allocatable :: command

      command = script//'run-up '//shown(path)//' --output '//named(path, 'run_up')
   end function command_of_run_up

   !> A path as it is typed.
   function shown(path) result(words)
      character(*), intent(in) :: path
      character(:), allocatable :: words

      words = printable(path, .false.)
      if (scan(words, ' ()[]&;$*') > 0) words = "'"//words//"'"
   end function shown

   !> A file of another name beside a path.
   function named(path, what) result(words)
      character(*), intent(in) :: path
      character(*), intent(in) :: what
      character(:), allocatable :: words
      integer :: dot

      dot = index(path, '.', back=.true.)
      if (dot <= index(path, '/', back=.true.) + 1) dot = len(path) + 1
      words = shown(path(:dot - 1)//'_'//what//'.csv')
   end function named

end module recording_command
