!> Reads result files that this program wrote, see result_format.
module result_reader
   use errors, only: error_t, exit_bad_input, raise
   use kinds, only: dp, int32, int64
   use result_format, only: byte_order_mark, fixed_header_bytes, column_name_bytes, column_unit_bytes, result_format_version, &
                            result_magic
   implicit none(type, external)
   private

   !> An open result file.
   type, public :: result_reader_t
      character(:), allocatable :: input_text
      integer :: columns = 0
      !> -1: the file was not closed
      integer(int64) :: rows = 0
      integer(int64), private :: header_bytes = 0
      integer, private :: unit = -1
      character(:), allocatable, private :: path
   contains
      procedure :: open => open_result
      procedure :: read_rows
      procedure :: close => close_result
   end type result_reader_t

contains

   !> Open a file and read its header.
   subroutine open_result(self, path, error)
      class(result_reader_t), intent(inout) :: self
      !> Path of the file
      character(*), intent(in) :: path
      !> Set if it is no result file of this format
      type(error_t), allocatable, intent(out) :: error
      character(len(result_magic)) :: magic
      character(24) :: version
      integer(int32) :: format_version, mark, columns, input_bytes
      integer :: stat

      self%path = path
      open (newunit=self%unit, file=path, access='stream', form='unformatted', status='old', action='read', iostat=stat)
      if (stat /= 0) then
         call raise(error, exit_bad_input, path//' cannot be read')
         return
      end if
      read (self%unit, iostat=stat) magic, format_version, mark, self%header_bytes, self%rows, columns, input_bytes, version
      if (stat == 0) stat = merge(0, 1, magic == result_magic .and. format_version == result_format_version .and. &
                                  mark == byte_order_mark .and. columns > 0 .and. input_bytes >= 0)
      if (stat == 0) then
         self%columns = int(columns)
         allocate (character(int(input_bytes)) :: self%input_text)
         read (self%unit, pos=fixed_header_bytes + self%columns*(column_name_bytes + column_unit_bytes) + 1, iostat=stat) &
            self%input_text
      end if
      if (stat /= 0) call raise(error, exit_bad_input, path//' is no result file of this version of rattle')
   end subroutine open_result

   !> Read consecutive rows.
   subroutine read_rows(self, first, rows, error)
      class(result_reader_t), intent(in) :: self
      !> First row, counted from 1
      integer(int64), intent(in) :: first
      !> One column of this array is one row of the file
      real(dp), intent(out) :: rows(:, :)
      !> Set if the file ends before
      type(error_t), allocatable, intent(out) :: error
      integer :: stat

      read (self%unit, pos=self%header_bytes + (first - 1_int64)*8_int64*int(self%columns, int64) + 1_int64, iostat=stat) rows
      if (stat /= 0) call raise(error, exit_bad_input, self%path//' ends before its rows do')
   end subroutine read_rows

   !> Close the file.
   subroutine close_result(self)
      class(result_reader_t), intent(inout) :: self
      integer :: ignored

      if (self%unit /= -1) close (self%unit, iostat=ignored)
      self%unit = -1
   end subroutine close_result

end module result_reader
