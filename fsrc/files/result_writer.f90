!> Writes a result file row by row, see result_format. A killed run leaves a readable file
!> whose count of rows is still unknown.
module result_writer
   use byte_file, only: byte_file_t
   use clock, only: wall_seconds
   use errors, only: error_t
   use kinds, only: dp, int64
   use result_format, only: row_count_offset
   use result_header, only: aligned_text_end, header_text, result_header_t
   implicit none(type, external)
   private

   !> What a killed run may lose at most [s].
   real(dp), parameter :: flush_interval = 2.0_dp

   !> An open result file.
   type, public :: result_writer_t
      private
      type(byte_file_t) :: file
      integer(int64) :: rows = 0
      real(dp) :: last_flush = 0.0_dp
      logical :: sound = .false.
   contains
      procedure :: open => open_result
      procedure :: write_rows
      procedure :: close => close_result
   end type result_writer_t

contains

   !> Create the file and write its header.
   subroutine open_result(self, path, input_text, names, units, error)
      class(result_writer_t), intent(inout) :: self
      !> Path of the file; one that stands there is replaced
      character(*), intent(in) :: path
      !> Resolved input as namelist text
      character(*), intent(in) :: input_text
      !> Names of the columns
      character(*), intent(in) :: names(:)
      !> Their units
      character(*), intent(in) :: units(:)
      !> Set if the file cannot be written
      type(error_t), allocatable, intent(out) :: error

      self%rows = 0
      self%last_flush = wall_seconds()
      call self%file%open(path, error)
      if (.not. allocated(error)) call self%file%put(header_bytes(input_text, names, units), error)
      if (.not. allocated(error)) call self%file%flush(error)
      self%sound = .not. allocated(error)
   end subroutine open_result

   !> Everything before the first row.
   pure function header_bytes(input_text, names, units) result(bytes)
      character(*), intent(in) :: input_text
      character(*), intent(in) :: names(:)
      character(*), intent(in) :: units(:)
      character(:), allocatable :: bytes
      type(result_header_t) :: header
      integer :: i

      allocate (header%names(size(names)), header%units(size(names)))
      do i = 1, size(names)
         header%names(i) = names(i)
         header%units(i) = units(i)
      end do
      header%input_text = input_text
      header%header_bytes = aligned_text_end(header)
      bytes = header_text(header)
      bytes = bytes//repeat(achar(0), int(header%header_bytes) - len(bytes))
   end function header_bytes

   !> Append rows.
   subroutine write_rows(self, rows, error)
      class(result_writer_t), intent(inout) :: self
      !> One column of this array is one row of the file
      real(dp), contiguous, intent(in) :: rows(:, :)
      !> Set if the disk is full, say
      type(error_t), allocatable, intent(out) :: error
      real(dp) :: now

      call self%file%put(rows, error)
      if (.not. allocated(error)) then
         self%rows = self%rows + size(rows, 2)
         now = wall_seconds()
         if (now - self%last_flush > flush_interval) then
            call self%file%flush(error)
            self%last_flush = now
         end if
      end if
      self%sound = .not. allocated(error)
   end subroutine write_rows

   !> Enter the count of rows and close the file. A file that lost rows stays unclosed.
   subroutine close_result(self, error)
      class(result_writer_t), intent(inout) :: self
      !> Set if the file could not be completed
      type(error_t), allocatable, intent(out) :: error
      type(error_t), allocatable :: close_error

      if (.not. self%file%is_open()) return
      if (self%sound) call self%file%put_at(row_count_offset, self%rows, error)
      call self%file%close(close_error)
      if (.not. allocated(error) .and. allocated(close_error)) call move_alloc(close_error, error)
   end subroutine close_result

end module result_writer
