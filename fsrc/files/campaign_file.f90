!> The result file of a campaign: NAME.rattle as result_format describes it, one row for every scene in the
!> order of the scenes, and in its header a table of the chunks that are done.
!>
!> A chunk may be written at any time. Its rows go first, its checksum after them, so a run that is killed
!> at any moment leaves chunks that are whole or count as not done. The bytes of the finished file depend
!> neither on the order of the chunks nor on the number of runs that it took.
module campaign_file
   use, intrinsic :: iso_c_binding, only: c_int
   use byte_file, only: beside => new_path, raise_taken_away
   use campaign_header, only: campaign_layout_t, check_same_campaign, header_for
   use checksum, only: checksum_of
   use errors, only: error_t, error_words, exit_bad_input, exit_system, is_shortage, last_error, raise
   use file_system, only: delete_file, file_state_t, first_bytes, path_exists, rename_file, state_of_path
   use kinds, only: dp, int64
   use output_lock, only: expect_own_lock
   use random_access_file, only: lock_failed, lock_held, lock_refused, random_access_file_t
   use result_format, only: result_magic, row_count_offset, rows_unknown
   use result_header, only: header_text, int64_bytes, result_header_t
   use signals, only: must_stop
   use text, only: integer_text
   implicit none(type, external)
   private

   !> An open campaign file. Several threads may write chunks at once; all else is for one thread.
   type, public :: campaign_file_t
      private
      type(random_access_file_t) :: file
      character(:), allocatable :: path
      type(result_header_t) :: header
      integer(int64) :: scene_count = 0_int64
      !> Checksum of each chunk, 0: not done
      integer(int64), allocatable :: checksums(:)
      logical :: locked = .false.
   contains
      procedure :: create => create_campaign
      procedure :: resume => resume_campaign
      procedure :: join => join_campaign
      procedure :: chunk_count
      procedure :: chunk_bounds
      procedure :: is_done
      procedure :: done_flags
      procedure :: write_chunks
      procedure :: scenes_done
      procedure :: read_chunk
      procedure :: refresh
      procedure :: close => close_campaign
      procedure, private :: take_lock
      procedure, private :: attach
      procedure, private :: verify
      procedure, private :: give_up
      procedure, private :: expect_at_place
   end type campaign_file_t

contains

   !> Make the file, without any chunk done. It comes to its path in one step, with its whole header.
   subroutine create_campaign(self, path, layout, overwrite, error)
      class(campaign_file_t), intent(inout) :: self
      character(*), intent(in) :: path
      !> What is computed
      type(campaign_layout_t), intent(in) :: layout
      !> Whether a file that stands there may be replaced; never one that another run writes
      logical, intent(in) :: overwrite
      !> Set if the file stands already, is in use, or cannot be written
      type(error_t), allocatable, intent(out) :: error
      type(campaign_file_t) :: old
      type(error_t), allocatable :: ignored
      character(:), allocatable :: new_path
      character(len(result_magic)) :: magic
      type(file_state_t) :: state
      integer :: got
      integer(c_int) :: cause
      logical :: stood, overtaken, moved

      self%path = path
      ! An empty file holds nothing: a run was killed before it wrote there.
      state = state_of_path(path)
      stood = state%exists
      if (state%bytes > 0_int64 .and. .not. overwrite) then
         call raise(error, exit_bad_input, path//' exists; --resume continues it, --overwrite replaces it')
         return
      end if
      if (stood) then
         call first_bytes(path, magic, got, cause)
         if (is_shortage(cause)) then
            call raise(error, exit_system, path//' cannot be opened: '//error_words(cause))
            return
         end if
         if (state%bytes > 0_int64 .and. (got < len(magic) .or. magic /= result_magic)) then
            call raise(error, exit_bad_input, path// &
                       ' exists and was not written by rattle; it is never replaced')
            return
         end if
         old%path = path
         call old%file%open(path, .false., error)
         if (.not. allocated(error)) call old%take_lock(path, error)
      end if
      new_path = beside(path)
      if (.not. allocated(error)) then
         call self%file%open(new_path, .true., error)
         ! Nothing has run yet: a place that cannot be written is bad input.
         if (allocated(error)) call raise(error, merge(exit_system, exit_bad_input, is_shortage(last_error())), &
                                             path//' cannot be written: '//error_words(last_error()))
      end if
      if (.not. allocated(error)) call self%take_lock(new_path, error)
      overtaken = .false.
      if (self%locked .and. .not. stood) overtaken = path_exists(path)
      if (overtaken .and. .not. allocated(error)) call raise(error, exit_system, path//' is being written by another run')
      if (allocated(error)) then
         if (self%file%is_open()) call delete_file(new_path)
         call self%give_up()
         call old%give_up()
         return
      end if

      self%header = header_for(layout)
      self%scene_count = layout%scene_count
      if (allocated(self%checksums)) deallocate (self%checksums)
      allocate (self%checksums(self%header%chunk_count), source=0_int64)
      call self%file%set_size(0_int64, error)
      ! The header first: a run killed here leaves a file that is empty or known as ours.
      if (.not. allocated(error)) call self%file%write_at(0_int64, header_text(self%header), error)
      if (.not. allocated(error)) call self%file%set_size(self%header%header_bytes, error)
      if (.not. allocated(error)) call self%file%synchronise(error)
      if (.not. allocated(error)) call expect_own_lock(path(:index(path, '.rattle', back=.true.) - 1), error)
      if (.not. allocated(error)) then
         call rename_file(new_path, path, moved)
         if (.not. moved) call raise(error, exit_system, path//' cannot be written: '//new_path// &
                                     ' cannot be moved there')
      end if
      if (allocated(error)) then
         call delete_file(new_path)
         call self%give_up()
      else
         call self%file%rename_path(path)
      end if
      call old%file%close(ignored)
   end subroutine create_campaign

   !> Go on with a file. Each chunk that is marked as done is read back; one that is not what its checksum
   !> says is computed again. The scenes in a chunk are those of the file, whatever the layout says.
   subroutine resume_campaign(self, path, layout, spoilt_chunks, error)
      class(campaign_file_t), intent(inout) :: self
      character(*), intent(in) :: path
      !> What is computed; it must be what the file was begun with
      type(campaign_layout_t), intent(in) :: layout
      !> Chunks that were marked as done and are not
      integer(int64), intent(out) :: spoilt_chunks
      !> Set if there is no such file, it belongs to another input (the key is named), or is in use
      type(error_t), allocatable, intent(out) :: error

      spoilt_chunks = 0_int64
      if (.not. path_exists(path)) then
         call raise(error, exit_bad_input, path//' does not exist; there is nothing to resume')
         return
      end if
      self%path = path
      call self%file%open(path, .false., error)
      if (allocated(error)) error%exit_code = exit_bad_input
      if (.not. allocated(error)) call self%take_lock(path, error)
      if (.not. allocated(error)) call self%attach(layout, error)
      if (.not. allocated(error)) call self%verify(spoilt_chunks, error)
      if (allocated(error)) call self%give_up()
   end subroutine resume_campaign

   !> Take part in a file that another rank of this run has created or resumed, and has locked.
   subroutine join_campaign(self, path, layout, error)
      class(campaign_file_t), intent(inout) :: self
      character(*), intent(in) :: path
      !> What is computed
      type(campaign_layout_t), intent(in) :: layout
      !> Set if there is no such file, or it belongs to another input
      type(error_t), allocatable, intent(out) :: error

      self%path = path
      call self%file%open(path, .false., error)
      if (.not. allocated(error)) call self%attach(layout, error)
      if (allocated(error)) call self%give_up()
   end subroutine join_campaign

   !> Lock the open file against other runs.
   subroutine take_lock(self, path, error)
      class(campaign_file_t), intent(inout) :: self
      character(*), intent(in) :: path
      type(error_t), allocatable, intent(out) :: error
      character(:), allocatable :: why
      integer :: outcome

      call self%file%lock(outcome, why)
      self%locked = outcome == lock_held
      if (outcome == lock_refused) &
         call raise(error, exit_system, path//' is being written by another run; wait for its end, or '// &
                    'choose another name or output directory')
      if (outcome == lock_failed) call raise(error, exit_system, path//' cannot be locked: '//why)
   end subroutine take_lock

   !> See that the open file belongs to a layout, and read its table of chunks.
   subroutine attach(self, layout, error)
      class(campaign_file_t), intent(inout) :: self
      type(campaign_layout_t), intent(in) :: layout
      type(error_t), allocatable, intent(out) :: error

      call check_same_campaign(self%file, self%path, layout, self%header, error)
      if (allocated(error)) return
      self%scene_count = layout%scene_count
      if (allocated(self%checksums)) deallocate (self%checksums)
      allocate (self%checksums(self%header%chunk_count))
      call self%refresh(error)
   end subroutine attach

   !> Read the table of chunks again, to see what other ranks have done.
   subroutine refresh(self, error)
      class(campaign_file_t), intent(inout) :: self
      !> Set if it cannot be read
      type(error_t), allocatable, intent(out) :: error
      logical :: complete

      call self%header%read_checksums(self%file, 1_int64, self%checksums, complete)
      if (.not. complete) call raise(error, exit_system, self%path//' cannot be read')
   end subroutine refresh

   !> Read back every chunk that is marked as done, unless the work must stop.
   subroutine verify(self, spoilt_chunks, error)
      class(campaign_file_t), intent(inout) :: self
      integer(int64), intent(out) :: spoilt_chunks
      type(error_t), allocatable, intent(out) :: error
      real(dp), allocatable :: rows(:, :)
      integer(int64) :: chunk, first, last
      logical :: sound

      spoilt_chunks = 0_int64
      allocate (rows(size(self%header%names), min(self%header%chunk_rows, self%scene_count)))
      do chunk = 1_int64, self%header%chunk_count
         if (self%checksums(chunk) == 0_int64) cycle
         if (must_stop()) return
         call self%chunk_bounds(chunk, first, last)
         call self%read_chunk(chunk, rows(:, :last - first + 1_int64), sound)
         if (sound) cycle
         ! A closed file that turns out to be spoilt is open again.
         if (spoilt_chunks == 0_int64) call self%file%write_at(row_count_offset, int64_bytes(rows_unknown), error)
         if (.not. allocated(error)) call self%file%write_at(self%header%checksum_place(chunk), int64_bytes(0_int64), error)
         if (allocated(error)) return
         self%checksums(chunk) = 0_int64
         spoilt_chunks = spoilt_chunks + 1_int64
      end do
   end subroutine verify

   !> Number of chunks.
   pure integer(int64) function chunk_count(self)
      class(campaign_file_t), intent(in) :: self

      chunk_count = self%header%chunk_count
   end function chunk_count

   !> Scenes of a chunk.
   pure subroutine chunk_bounds(self, chunk, first, last)
      class(campaign_file_t), intent(in) :: self
      !> From 1 to chunk_count
      integer(int64), intent(in) :: chunk
      !> First scene, from 1
      integer(int64), intent(out) :: first
      !> Last scene
      integer(int64), intent(out) :: last

      first = (chunk - 1_int64)*self%header%chunk_rows + 1_int64
      last = min(first + self%header%chunk_rows - 1_int64, self%scene_count)
   end subroutine chunk_bounds

   !> Whether a chunk is done, as far as this rank knows.
   pure logical function is_done(self, chunk)
      class(campaign_file_t), intent(in) :: self
      !> From 1 to chunk_count
      integer(int64), intent(in) :: chunk

      is_done = self%checksums(chunk) /= 0_int64
   end function is_done

   !> Whether each chunk is done, as far as this rank knows.
   pure function done_flags(self) result(flags)
      class(campaign_file_t), intent(in) :: self
      logical, allocatable :: flags(:)

      flags = self%checksums /= 0_int64
   end function done_flags

   !> Write the rows of chunks that follow each other, then mark them as done. Threads may write different chunks at once.
   subroutine write_chunks(self, chunk, rows, error)
      class(campaign_file_t), intent(inout) :: self
      !> The first of them, from 1 to chunk_count
      integer(int64), intent(in) :: chunk
      !> One column of this array is the row of a scene; they end where a chunk ends
      real(dp), contiguous, intent(in) :: rows(:, :)
      !> Set if the disk is full, say; the chunks are not done then
      type(error_t), allocatable, intent(out) :: error
      integer(int64), allocatable :: sums(:)
      integer(int64) :: from, first, last, last_chunk, i

      call self%chunk_bounds(chunk, from, last)
      last_chunk = chunk + max(0_int64, size(rows, 2, int64) - 1_int64)/self%header%chunk_rows
      call self%chunk_bounds(last_chunk, first, last)
      if (size(rows, 1) /= size(self%header%names) .or. size(rows, 2, int64) /= last - from + 1_int64) then
         call raise(error, exit_system, self%path//': chunk '//integer_text(chunk)//' has the wrong size')
         return
      end if
      call self%expect_at_place(error)
      if (allocated(error)) return
      allocate (sums(chunk:last_chunk))
      do i = chunk, last_chunk
         call self%chunk_bounds(i, first, last)
         sums(i) = checksum_of(rows(:, first - from + 1_int64:last - from + 1_int64))
      end do
      call self%file%write_at(self%header%row_place(from), rows, error)
      if (.not. allocated(error)) &
         call self%file%write_at(self%header%checksum_place(chunk), transfer(sums, repeat(' ', 8*size(sums))), error)
      if (.not. allocated(error)) self%checksums(chunk:last_chunk) = sums
   end subroutine write_chunks

   !> Scenes that are done, by all ranks as far as the file shows.
   integer(int64) function scenes_done(self)
      class(campaign_file_t), intent(in) :: self
      integer(int64) :: checksums(self%header%chunk_count), chunk, first, last
      logical :: complete

      scenes_done = 0_int64
      call self%header%read_checksums(self%file, 1_int64, checksums, complete)
      if (.not. complete) return
      do chunk = 1_int64, self%header%chunk_count
         if (checksums(chunk) == 0_int64) cycle
         call self%chunk_bounds(chunk, first, last)
         scenes_done = scenes_done + last - first + 1_int64
      end do
   end function scenes_done

   !> Read the rows of a chunk back.
   subroutine read_chunk(self, chunk, rows, sound)
      class(campaign_file_t), intent(in) :: self
      !> From 1 to chunk_count
      integer(int64), intent(in) :: chunk
      !> Its rows, as many as chunk_bounds says
      real(dp), contiguous, intent(out) :: rows(:, :)
      !> Whether they are what its checksum says
      logical, intent(out) :: sound
      integer(int64) :: first, last

      call self%chunk_bounds(chunk, first, last)
      call self%file%read_at(self%header%row_place(first), rows, sound)
      if (sound) sound = checksum_of(rows) == self%checksums(chunk)
   end subroutine read_chunk

   !> Close the file. If all chunks are done, the count of rows is entered, and the file is finished.
   subroutine close_campaign(self, finished, error)
      class(campaign_file_t), intent(inout) :: self
      !> Whether all chunks are done
      logical, intent(out) :: finished
      !> Set if the file could not be completed
      type(error_t), allocatable, intent(out) :: error
      type(error_t), allocatable :: close_error

      finished = .false.
      if (.not. self%file%is_open()) return
      call self%expect_at_place(error)
      if (.not. allocated(error)) call self%refresh(error)
      if (.not. allocated(error)) call self%file%synchronise(error)
      if (.not. allocated(error)) then
         finished = all(self%checksums /= 0_int64)
         ! The rows stand on the disk before their count says so.
         if (finished) call self%file%write_at(row_count_offset, int64_bytes(self%scene_count), error)
         if (.not. allocated(error)) call self%file%synchronise(error)
      end if
      call self%file%close(close_error)
      self%locked = .false.
      if (.not. allocated(error) .and. allocated(close_error)) call move_alloc(close_error, error)
      finished = finished .and. .not. allocated(error)
   end subroutine close_campaign

   !> See that no one has taken the file away: what is written into a file without a name is lost.
   subroutine expect_at_place(self, error)
      class(campaign_file_t), intent(in) :: self
      !> Set if it does not stand at its path
      type(error_t), allocatable, intent(out) :: error
      logical :: stands

      stands = self%file%stands_at(self%path)
      if (.not. stands) call raise_taken_away(self%path, error)
   end subroutine expect_at_place

   !> Close the file after a failure that is an error already.
   subroutine give_up(self)
      class(campaign_file_t), intent(inout) :: self
      type(error_t), allocatable :: ignored

      call self%file%close(ignored)
      self%locked = .false.
   end subroutine give_up

end module campaign_file
