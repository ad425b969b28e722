!> Writes a result file row by row, see result_format. A run that is killed leaves a readable file whose count of
!> rows is still unknown, with checksums of what has gone to the disk.
module result_writer
   use byte_file, only: byte_file_t
   use checksum, only: checksum_of, checksum_t
   use clock, only: wall_seconds
   use errors, only: error_t
   use file_system, only: path_exists
   use kinds, only: dp, int32, int64
   use result_format, only: row_count_offset, seal_offset
   use result_header, only: header_text, result_header_t, result_seal_t, seal_text, series_chunk_rows
   implicit none(type, external)
   private

   !> What a killed run may lose at most [s].
   real(dp), parameter :: flush_interval = 2.0_dp

   !> An open result file.
   type, public :: result_writer_t
      private
      type(byte_file_t) :: file
      type(result_header_t) :: header
      integer(int64) :: rows = 0
      !> Checksum of the rows of the chunk that is being filled
      type(checksum_t) :: chunk_sum
      !> Checksums of the whole chunks that are not in the table yet, and how many are
      integer(int64), allocatable :: waiting(:)
      integer(int64) :: chunks_in_table = 0
      real(dp), allocatable :: extremes(:, :)
      logical :: coarse = .false.
      real(dp) :: last_flush = 0.0_dp
      logical :: sound = .false.
   contains
      procedure :: open => open_result
      procedure :: write_rows
      procedure :: write_extremes
      procedure :: mark_coarse
      procedure :: close => close_result
      procedure, private :: write_seal
   end type result_writer_t

contains

   !> Create the file with its header, beside its place (see byte_file).
   subroutine open_result(self, path, input_text, names, units, row_limit, show_at_once, error, source_checksum)
      class(result_writer_t), intent(inout) :: self
      character(*), intent(in) :: path
      !> Resolved input as namelist text
      character(*), intent(in) :: input_text
      !> Names of the columns
      character(*), intent(in) :: names(:)
      !> Their units
      character(*), intent(in) :: units(:)
      !> Rows that may come at most, the extreme ones not counted
      integer(int64), intent(in) :: row_limit
      !> Whether it comes to its place at once where nothing stands, for others to read along
      logical, intent(in) :: show_at_once
      !> Set if the file cannot be written
      type(error_t), allocatable, intent(out) :: error
      !> Checksum of the CSV file that the rows follow from
      integer(int64), optional, intent(in) :: source_checksum
      type(checksum_t) :: nothing
      character(:), allocatable :: text
      logical :: stands

      self%rows = 0
      self%chunk_sum = nothing
      self%chunks_in_table = 0
      self%waiting = [integer(int64) ::]
      self%coarse = .false.
      if (allocated(self%extremes)) deallocate (self%extremes)
      self%last_flush = wall_seconds()
      self%header = header_of(input_text, names, units, row_limit)
      if (present(source_checksum)) self%header%source_checksum = source_checksum
      text = header_text(self%header)
      text = text//repeat(achar(0), int(self%header%header_bytes) - len(text))
      call self%file%open(path, error)
      if (.not. allocated(error)) call self%file%put(text, error)
      if (.not. allocated(error)) then
         stands = path_exists(path)
         if (show_at_once .and. .not. stands) then
            call self%file%show(error)
         else
            call self%file%flush(error)
         end if
      end if
      self%sound = .not. allocated(error)
   end subroutine open_result

   !> Header of a new file.
   pure function header_of(input_text, names, units, row_limit) result(header)
      character(*), intent(in) :: input_text
      character(*), intent(in) :: names(:)
      character(*), intent(in) :: units(:)
      integer(int64), intent(in) :: row_limit
      type(result_header_t) :: header
      integer :: i

      allocate (header%names(size(names)), header%units(size(names)))
      do i = 1, size(names)
         header%names(i) = names(i)
         header%units(i) = units(i)
      end do
      header%input_text = input_text
      header%row_limit = row_limit
      header%chunk_rows = series_chunk_rows(size(names), row_limit)
      call header%lay_out()
   end function header_of

   !> Append rows.
   subroutine write_rows(self, rows, error)
      class(result_writer_t), intent(inout) :: self
      !> One column of this array is one row of the file
      real(dp), contiguous, intent(in) :: rows(:, :)
      !> Set if the disk is full, say
      type(error_t), allocatable, intent(out) :: error
      real(dp) :: now

      call add_to_chunks(self, rows)
      call self%file%put(rows, error)
      if (.not. allocated(error)) then
         self%rows = self%rows + size(rows, 2)
         now = wall_seconds()
         if (now - self%last_flush > flush_interval) then
            call self%write_seal(error)
            self%last_flush = now
         end if
      end if
      self%sound = self%sound .and. .not. allocated(error)
   end subroutine write_rows

   !> Carry the checksums on over rows that follow those of the file.
   subroutine add_to_chunks(self, rows)
      class(result_writer_t), intent(inout) :: self
      real(dp), contiguous, intent(in) :: rows(:, :)
      type(checksum_t) :: nothing
      integer(int64) :: done, part

      done = 0
      do while (done < size(rows, 2, int64))
         associate (filled => modulo(self%rows + done, self%header%chunk_rows))
            part = min(size(rows, 2, int64) - done, self%header%chunk_rows - filled)
            call self%chunk_sum%add(rows(:, done + 1:done + part))
            if (filled + part == self%header%chunk_rows) then
               self%waiting = [self%waiting, self%chunk_sum%value()]
               self%chunk_sum = nothing
            end if
         end associate
         done = done + part
      end do
   end subroutine add_to_chunks

   !> Rows at times of their own, the extremes between the others. They come behind all other rows when the file is
   !> closed; called at most once.
   subroutine write_extremes(self, rows)
      class(result_writer_t), intent(inout) :: self
      !> One column of this array is one row of the file, in the order of time
      real(dp), intent(in) :: rows(:, :)

      self%extremes = rows
   end subroutine write_extremes

   !> Say in the file that the series is coarser than the motion.
   subroutine mark_coarse(self)
      class(result_writer_t), intent(inout) :: self

      self%coarse = .true.
   end subroutine mark_coarse

   !> Bring the rows so far to the disk, then their checksums.
   subroutine write_seal(self, error, extremes)
      class(result_writer_t), intent(inout) :: self
      type(error_t), allocatable, intent(out) :: error
      !> The extreme rows that will follow; absent: rows may follow
      real(dp), contiguous, optional, intent(in) :: extremes(:, :)
      type(result_seal_t) :: seal

      if (size(self%waiting) > 0) then
         call self%file%put_at(self%header%checksum_place(self%chunks_in_table + 1_int64), &
                               transfer(self%waiting, repeat(' ', 8*size(self%waiting))), error)
         if (allocated(error)) return
         self%chunks_in_table = self%chunks_in_table + size(self%waiting, kind=int64)
         self%waiting = [integer(int64) ::]
      end if
      seal%rows = self%rows
      if (modulo(self%rows, self%header%chunk_rows) > 0_int64) seal%rest_checksum = self%chunk_sum%value()
      seal%coarse = self%coarse
      if (present(extremes)) then
         seal%extremes = size(extremes, 2, int32)
         if (seal%extremes > 0) seal%extremes_checksum = checksum_of(extremes)
      end if
      call self%file%put_at(seal_offset, seal_text(seal), error)
   end subroutine write_seal

   !> Enter the count of rows and close the file. A file that lost rows stays unclosed.
   subroutine close_result(self, error)
      class(result_writer_t), intent(inout) :: self
      !> Set if the file could not be completed
      type(error_t), allocatable, intent(out) :: error
      type(error_t), allocatable :: close_error

      if (.not. self%file%is_open()) return
      if (.not. allocated(self%extremes)) allocate (self%extremes(size(self%header%names), 0))
      if (self%sound) call self%write_seal(error, self%extremes)
      if (self%sound .and. .not. allocated(error)) call self%file%put(self%extremes, error)
      if (self%sound .and. .not. allocated(error)) &
         call self%file%put_at(row_count_offset, transfer(self%rows, repeat(' ', 8)), error)
      call self%file%close(close_error)
      if (.not. allocated(error) .and. allocated(close_error)) call move_alloc(close_error, error)
   end subroutine close_result

end module result_writer
