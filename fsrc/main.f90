!> rattle: transient oil film and tooth motion of a loose gear pair, and the class of its rattle.
program main
   use, intrinsic :: iso_fortran_env, only: compiler_version
   use batch, only: print_faults
   use command_line, only: command_t, read_arguments, usage_text
   use errors, only: error_t, exit_bad_input, exit_complete, exit_scene_failed, exit_system, fault_list_t
   use file_descriptor, only: reserve_standard_descriptors
   use key_page, only: page_text, quantities_text, template_text
   use key_table, only: nearest_group
   use ranks, only: parallel_words
   use lane_rows, only: wide_registers
   use ready_inputs, only: ready_input
   use run_tasks, only: run_all_tasks
   use stack, only: expect_stack
   use text_output, only: lost_text, put_error_line, put_line, put_text
   use unplanned_end, only: plan_end, watch_end
   use version, only: program_version
   implicit none(type, external)
   type(command_t) :: command
   type(fault_list_t) :: faults
   type(error_t), allocatable :: error
   integer :: exit_code = exit_complete
   logical :: output_is_closed

   call reserve_standard_descriptors(output_is_closed)
   call watch_end()
   call expect_stack(error)
   if (allocated(error)) call faults%add_error('rattle', '', '', error)
   if (.not. allocated(error)) call read_arguments(command, faults)
   if (command%template .and. len(template_of(command%template_name)) == 0) &
      call faults%add('--template', 0, command%template_name, '', &
                      'unknown group; the nearest known group is &'//nearest_group(command%template_name))
   if (faults%count() > 0) then
      call print_faults(faults)
      exit_code = faults%exit_code
   else if (command%help) then
      call put_line(usage_text())
   else if (command%version) then
      call put_line('rattle '//program_version)
      call put_line('built '//parallel_words//', for registers of '//trim(merge('eight', 'four ', wide_registers))// &
                    ' numbers, by '//compiler_version())
   else if (command%template) then
      call put_text(template_of(command%template_name))
   else if (command%page) then
      call put_text(page_text())
   else if (command%quantities) then
      call put_text(quantities_text())
   else if (size(command%files) == 0) then
      call faults%add('rattle', 0, '', '', 'no input file is given'//new_line('a')//usage_text())
      call print_faults(faults)
      exit_code = exit_bad_input
   else
      ! Who closes the standard output wants no words of a run; what --check prints is lost.
      command%quiet = command%quiet .or. (output_is_closed .and. .not. command%check)
      call run_all_tasks(command, exit_code)
   end if
   if (len(lost_text()) > 0) then
      call put_error_line(lost_text()//' could not be written; the disk may be full, the file removed, or the reader closed')
      if (exit_code == exit_complete .or. exit_code == exit_scene_failed) exit_code = exit_system
   end if
   call plan_end()
   stop exit_code, quiet = .true.

contains

   !> A ready input, or every key, or those of a group. A group that has the name of a ready input is distinguished by its &.
   function template_of(name) result(text)
      character(*), intent(in) :: name
      character(:), allocatable :: text

      text = ready_input(name)
      if (len(text) == 0) text = template_text(name(verify(name//' ', '&'):))
   end function template_of

end program main
