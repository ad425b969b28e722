!> The header of a result file, put together and taken apart; see result_format for its layout.
module result_header
   use errors, only: error_t, exit_bad_input, raise
   use kinds, only: int32, int64
   use random_access_file, only: random_access_file_t
   use result_format, only: alignment, byte_order_mark, column_name_bytes, column_unit_bytes, &
                            fixed_header_bytes, result_format_version, result_magic, rows_unknown
   use text, only: integer_text
   use version, only: program_version
   implicit none(type, external)
   private

   integer, parameter :: version_bytes = 24

   !> What a header says.
   type, public :: result_header_t
      !> Bytes before the first row
      integer(int64) :: header_bytes = 0_int64
      !> Rows of a closed file; rows_unknown: not closed
      integer(int64) :: row_count = rows_unknown
      !> Version of the program that wrote the file
      character(version_bytes) :: version = program_version
      !> Names and units of the columns
      character(column_name_bytes), allocatable :: names(:)
      character(column_unit_bytes), allocatable :: units(:)
      !> Resolved input as namelist text
      character(:), allocatable :: input_text
   end type result_header_t

   public :: header_text, aligned_text_end, read_result_header

contains

   !> Bytes up to the next multiple of 64 after the input text; there the rows begin, or what else the
   !> header holds.
   pure integer(int64) function aligned_text_end(header)
      !> Its columns and input text are set
      type(result_header_t), intent(in) :: header
      integer(int64) :: column_count, text_end

      column_count = size(header%names, kind=int64)
      text_end = fixed_header_bytes + column_count*(column_name_bytes + column_unit_bytes) + &
                 len(header%input_text, int64)
      aligned_text_end = ((text_end + alignment - 1_int64)/alignment)*alignment
   end function aligned_text_end

   !> Bytes of a header up to the end of its input text, without the padding.
   pure function header_text(header) result(bytes)
      !> All its parts are set
      type(result_header_t), intent(in) :: header
      character(:), allocatable :: bytes
      integer :: i

      bytes = result_magic//int32_bytes(result_format_version)//int32_bytes(byte_order_mark)// &
              int64_bytes(header%header_bytes)//int64_bytes(header%row_count)// &
              int32_bytes(size(header%names, kind=int32))//int32_bytes(len(header%input_text, int32))// &
              header%version
      do i = 1, size(header%names)
         bytes = bytes//header%names(i)//header%units(i)
      end do
      bytes = bytes//header%input_text
   end function header_text

   !> Read the header of an open file, and see that it is a result file of this version, of sound sizes.
   subroutine read_result_header(file, path, header, error)
      !> Open file
      type(random_access_file_t), intent(in) :: file
      !> Its path, for the error
      character(*), intent(in) :: path
      !> What its header says
      type(result_header_t), intent(out) :: header
      !> Set if it is no such file
      type(error_t), allocatable, intent(out) :: error
      character(fixed_header_bytes) :: fixed
      character(:), allocatable :: columns
      integer(int64) :: column_end, file_bytes
      integer(int32) :: format_version
      integer :: i, column_count, text_bytes, width
      logical :: complete

      call file%read_at(0_int64, fixed, complete)
      if (.not. complete .or. fixed(:len(result_magic)) /= result_magic) then
         call raise(error, exit_bad_input, path//' was not written by rattle, or only its beginning was')
         return
      end if
      format_version = transfer(fixed(9:12), 0_int32)
      if (format_version /= result_format_version .or. &
          transfer(fixed(13:16), 0_int32) /= byte_order_mark) then
         call raise(error, exit_bad_input, path//' has another format version or byte order than this '// &
                    'program; version '//integer_text(int(format_version))//' stands in it')
         return
      end if
      header%header_bytes = transfer(fixed(17:24), 0_int64)
      header%row_count = transfer(fixed(25:32), 0_int64)
      column_count = int(transfer(fixed(33:36), 0_int32))
      text_bytes = int(transfer(fixed(37:40), 0_int32))
      header%version = fixed(41:64)
      width = column_name_bytes + column_unit_bytes
      column_end = fixed_header_bytes + int(max(column_count, 0), int64)*width
      file_bytes = file%bytes()
      if (column_count < 1 .or. text_bytes < 0 .or. &
          modulo(header%header_bytes, int(alignment, int64)) /= 0_int64 .or. &
          header%header_bytes < column_end + text_bytes .or. header%header_bytes > file_bytes) then
         call raise(error, exit_bad_input, path//' has a damaged header: its sizes contradict each other')
         return
      end if
      allocate (header%names(column_count), header%units(column_count))
      allocate (character(column_count*width) :: columns)
      allocate (character(text_bytes) :: header%input_text)
      call file%read_at(int(fixed_header_bytes, int64), columns, complete)
      if (complete) call file%read_at(column_end, header%input_text, complete)
      if (.not. complete) then
         call raise(error, exit_bad_input, path//' cannot be read')
         return
      end if
      do i = 1, column_count
         header%names(i) = columns((i - 1)*width + 1:)
         header%units(i) = columns((i - 1)*width + column_name_bytes + 1:)
      end do
   end subroutine read_result_header

   pure function int32_bytes(number) result(bytes)
      integer(int32), intent(in) :: number
      character(4) :: bytes

      bytes = transfer(number, bytes)
   end function int32_bytes

   pure function int64_bytes(number) result(bytes)
      integer(int64), intent(in) :: number
      character(8) :: bytes

      bytes = transfer(number, bytes)
   end function int64_bytes

end module result_header
