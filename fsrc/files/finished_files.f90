!> The files of a run come to their places together, once all of them are complete; see byte_file.
module finished_files
   use byte_file, only: new_path, put_in_place
   use errors, only: error_t
   use file_system, only: delete_file, path_exists
   use word_list, only: word_t
   implicit none(type, external)
   private

   public :: place_files

contains

   !> Put the files that stand beside their places there. After an error those of an earlier run stay as they were;
   !> the summary, which says what happened, takes no place but an empty one.
   subroutine place_files(results, summary, error)
      !> Paths of the results; one that stands in its place already is passed over
      type(word_t), intent(in) :: results(:)
      !> Path of the summary
      character(*), intent(in) :: summary
      !> In: what has failed so far; out: also if a file could not be put in its place
      type(error_t), allocatable, intent(inout) :: error
      integer :: i
      logical :: keep_summary, stands

      stands = path_exists(summary)
      keep_summary = allocated(error) .and. .not. stands
      do i = 1, size(results)
         stands = path_exists(new_path(results(i)%text))
         if (stands .and. .not. allocated(error)) call put_in_place(results(i)%text, error)
         if (allocated(error)) call delete_file(new_path(results(i)%text))
      end do
      if (.not. allocated(error)) then
         call put_in_place(summary, error)
      else if (keep_summary) then
         call place_silently(summary)
      else
         call delete_file(new_path(summary))
      end if
   end subroutine place_files

   !> Put a file in its place; that it cannot be done is no news after an error.
   subroutine place_silently(path)
      character(*), intent(in) :: path
      type(error_t), allocatable :: ignored

      call put_in_place(path, ignored)
   end subroutine place_silently

end module finished_files
