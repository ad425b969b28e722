!> The files of a run come to their places together, once all of them are complete; see byte_file.
!>
!> The summary goes first and comes last: a kill in between leaves results without a summary, never beside that of another run.
module finished_files
   use byte_file, only: new_path, old_path, put_in_place
   use errors, only: error_t, exit_system, raise
   use file_system, only: delete_file, path_exists, rename_file
   use output_lock, only: expect_own_lock
   use word_list, only: word_t
   implicit none(type, external)
   private

   public :: place_files, set_aside, bring_back, drop_aside

contains

   !> Put the files that stand beside their places there. Where the first of them cannot be put there those of an earlier run stay
   !> as they were; a summary that says what happened takes no place but an empty one.
   subroutine place_files(results, summary, error, table)
      !> Paths of the results; one that stands in its place already is passed over
      type(word_t), intent(in) :: results(:)
      !> Path of the summary
      character(*), intent(in) :: summary
      !> In: what has failed so far; out: also if a file could not be put in its place
      type(error_t), allocatable, intent(inout) :: error
      !> Path of the summary of all pairs of a gearbox that this one is part of
      character(*), optional, intent(in) :: table
      type(word_t), allocatable :: summaries(:)
      type(error_t), allocatable :: overtaken
      integer :: i, placed
      logical :: stands

      allocate (summaries(merge(2, 1, present(table))))
      summaries(1)%text = summary
      if (present(table)) summaries(2)%text = table
      placed = 0
      call expect_own_lock(summary(:index(summary, '.summary.nml', back=.true.) - 1), overtaken)
      stands = path_exists(summary)
      if (allocated(overtaken)) then
         ! Whatever stands there is that of the other run.
         call move_alloc(overtaken, error)
      else if (allocated(error)) then
         if (.not. stands) call place_silently(summary)
      else
         call set_aside(summaries)
         do i = 1, size(results)
            stands = path_exists(new_path(results(i)%text))
            if (stands) then
               call put_in_place(results(i)%text, error)
            else
               stands = path_exists(results(i)%text)
               if (.not. stands) call raise(error, exit_system, results(i)%text//' cannot be written: it was removed')
            end if
            if (allocated(error)) exit
            placed = placed + 1
         end do
         if (.not. allocated(error)) call put_in_place(summary, error)
         do i = 1, size(results)
            stands = path_exists(results(i)%text)
            if (.not. (stands .or. allocated(error))) call raise(error, exit_system, results(i)%text//' was removed')
         end do
         if (allocated(error) .and. placed == 0) call bring_back(summaries)
         call drop_aside(summaries)
      end if
      do i = 1, size(results)
         call delete_file(new_path(results(i)%text))
      end do
      call delete_file(new_path(summary))
   end subroutine place_files

   !> Take files away from their places, so that they can be brought back.
   subroutine set_aside(files)
      !> Paths; where nothing stands nothing is done
      type(word_t), intent(in) :: files(:)
      integer :: i
      logical :: ignored

      do i = 1, size(files)
         call rename_file(files(i)%text, old_path(files(i)%text), ignored)
      end do
   end subroutine set_aside

   !> Bring files back that were set aside.
   subroutine bring_back(files)
      type(word_t), intent(in) :: files(:)
      integer :: i
      logical :: ignored

      do i = 1, size(files)
         call rename_file(old_path(files(i)%text), files(i)%text, ignored)
      end do
   end subroutine bring_back

   !> Delete files that were set aside.
   subroutine drop_aside(files)
      type(word_t), intent(in) :: files(:)
      integer :: i

      do i = 1, size(files)
         call delete_file(old_path(files(i)%text))
      end do
   end subroutine drop_aside

   !> Put a file in its place; that it cannot be done is no news after an error.
   subroutine place_silently(path)
      character(*), intent(in) :: path
      type(error_t), allocatable :: ignored

      call put_in_place(path, ignored)
   end subroutine place_silently

end module finished_files
