!> Writes a result file row by row, see result_format. A killed run leaves a readable file
!> whose count of rows is still unknown.
module result_writer
   use clock, only: wall_seconds
   use errors, only: error_t, exit_system, raise
   use kinds, only: dp, int32, int64
   use result_format, only: alignment, byte_order_mark, column_name_bytes, column_unit_bytes, fixed_header_bytes, &
                            result_format_version, result_magic, row_count_position, rows_unknown
   use version, only: program_version
   implicit none (type, external)
   private

   !> What a killed run may lose at most [s].
   real(dp), parameter :: flush_interval = 2.0_dp

   !> An open result file.
   type, public :: result_writer_t
      private
      integer :: unit = -1
      integer(int64) :: rows = 0
      real(dp) :: last_flush = 0.0_dp
      character(:), allocatable :: path
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
      character(column_name_bytes) :: name
      character(column_unit_bytes) :: unit_name
      character(24) :: version_text
      character(200) :: message
      integer(int64) :: header_bytes, text_end
      integer :: i, stat

      self%path = path
      self%rows = 0
      self%last_flush = wall_seconds()
      version_text = program_version
      text_end = int(fixed_header_bytes + size(names)*(column_name_bytes + column_unit_bytes) + len(input_text), int64)
      header_bytes = ((text_end + alignment - 1)/alignment)*alignment
      open (newunit=self%unit, file=path, access='stream', form='unformatted', status='replace', action='write', &
            iostat=stat, iomsg=message)
      if (stat == 0) write (self%unit, iostat=stat, iomsg=message) result_magic, result_format_version, byte_order_mark, &
         header_bytes, rows_unknown, int(size(names), int32), int(len(input_text), int32), version_text
      do i = 1, size(names)
         if (stat /= 0) exit
         name = names(i)
         unit_name = units(i)
         write (self%unit, iostat=stat, iomsg=message) name, unit_name
      end do
      if (stat == 0) write (self%unit, iostat=stat, iomsg=message) input_text, &
         repeat(achar(0), int(header_bytes - text_end))
      if (stat == 0) flush (self%unit, iostat=stat, iomsg=message)
      if (stat /= 0) call raise(error, exit_system, path//' cannot be written: '//trim(message))
   end subroutine open_result

   !> Append rows.
   subroutine write_rows(self, rows, error)
      class(result_writer_t), intent(inout) :: self
      !> One column of this array is one row of the file
      real(dp), contiguous, intent(in) :: rows(:, :)
      !> Set if the disk is full, say
      type(error_t), allocatable, intent(out) :: error
      character(200) :: message
      real(dp) :: now
      integer :: stat

      write (self%unit, iostat=stat, iomsg=message) rows
      if (stat == 0) then
         self%rows = self%rows + size(rows, 2)
         now = wall_seconds()
         if (now - self%last_flush > flush_interval) then
            flush (self%unit, iostat=stat, iomsg=message)
            self%last_flush = now
         end if
      end if
      if (stat /= 0) call raise(error, exit_system, self%path//' cannot be written: '//trim(message))
   end subroutine write_rows

   !> Enter the count of rows and close the file.
   subroutine close_result(self, error)
      class(result_writer_t), intent(inout) :: self
      !> Set if the file could not be completed
      type(error_t), allocatable, intent(out) :: error
      character(200) :: message
      integer :: stat, ignored

      if (self%unit == -1) return
      write (self%unit, pos=row_count_position, iostat=stat, iomsg=message) self%rows
      if (stat == 0) then
         close (self%unit, iostat=stat, iomsg=message)
      else
         close (self%unit, iostat=ignored)
      end if
      self%unit = -1
      if (stat /= 0) call raise(error, exit_system, self%path//' cannot be written: '//trim(message))
   end subroutine close_result

end module result_writer
