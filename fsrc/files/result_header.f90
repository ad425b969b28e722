!> The header of a result file, put together and taken apart; see result_format for its layout.
module result_header
   use checksum, only: checksum_of
   use errors, only: error_t, exit_bad_input, raise
   use kinds, only: int32, int64
   use random_access_file, only: random_access_file_t
   use result_format, only: alignment, byte_order_mark, campaign_table_magic, column_name_bytes, column_unit_bytes, &
                            fixed_header_bytes, result_format_version, result_magic, rows_unknown, seal_bytes, seal_offset, &
                            series_table_magic, table_start_bytes, word_bytes
   use text, only: integer_text
   use version, only: program_version
   implicit none(type, external)
   private

   integer, parameter :: version_bytes = 24
   !> Words of a chunk of a series: 4 MB, found damaged or sound in a millisecond; and most chunks of a series.
   integer(int64), parameter :: series_chunk_words = 524288_int64, most_series_chunks = 4096_int64

   !> What the checksums of a series cover so far.
   type, public :: result_seal_t
      integer(int64) :: rows = 0_int64
      integer(int32) :: extremes = 0_int32
      !> Whether the series is coarser than the motion
      logical :: coarse = .false.
      !> Checksums of the rows behind the last whole chunk, and of the extreme rows; 0: none
      integer(int64) :: rest_checksum = 0_int64
      integer(int64) :: extremes_checksum = 0_int64
   end type result_seal_t

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
      !> Checksum of the scenes of a CSV file; 0: none
      integer(int64) :: source_checksum = 0_int64
      !> Kind of the table of chunks, rows in a chunk, count of chunks, rows of the file at most
      character(8) :: table_magic = series_table_magic
      integer(int64) :: chunk_rows = 0_int64
      integer(int64) :: chunk_count = 0_int64
      integer(int64) :: row_limit = 0_int64
      type(result_seal_t) :: seal
   contains
      procedure :: lay_out
      procedure :: table_place
      procedure :: checksum_place
      procedure :: row_place
      procedure :: read_checksums
   end type result_header_t

   public :: header_text, seal_text, read_result_header, series_chunk_rows, int64_bytes

contains

   !> Rows in a chunk of a series.
   pure integer(int64) function series_chunk_rows(column_count, row_limit)
      !> Columns of the series
      integer, intent(in) :: column_count
      !> Rows that it has at most
      integer(int64), intent(in) :: row_limit

      series_chunk_rows = max(1_int64, series_chunk_words/int(column_count, int64), &
                              (row_limit - 1_int64)/most_series_chunks + 1_int64)
   end function series_chunk_rows

   !> Find the count of chunks and the place of the first row; all else of the header is known.
   pure subroutine lay_out(self)
      class(result_header_t), intent(inout) :: self

      self%chunk_count = max(1_int64, (self%row_limit - 1_int64)/self%chunk_rows + 1_int64)
      self%header_bytes = aligned(self%checksum_place(self%chunk_count + 1_int64))
   end subroutine lay_out

   !> Bytes before the table of chunks.
   pure integer(int64) function table_place(self)
      class(result_header_t), intent(in) :: self

      table_place = aligned(text_place(self) + len(self%input_text, int64))
   end function table_place

   !> Bytes before the checksum of a chunk.
   pure integer(int64) function checksum_place(self, chunk)
      class(result_header_t), intent(in) :: self
      !> From 1
      integer(int64), intent(in) :: chunk

      checksum_place = self%table_place() + table_start_bytes + word_bytes*(chunk - 1_int64)
   end function checksum_place

   !> Bytes before a row.
   pure integer(int64) function row_place(self, row)
      class(result_header_t), intent(in) :: self
      !> From 1
      integer(int64), intent(in) :: row

      row_place = self%header_bytes + word_bytes*size(self%names, kind=int64)*(row - 1_int64)
   end function row_place

   !> Read checksums of chunks that follow each other.
   subroutine read_checksums(self, file, first, checksums, complete)
      class(result_header_t), intent(in) :: self
      type(random_access_file_t), intent(in) :: file
      !> The first of them, from 1
      integer(int64), intent(in) :: first
      integer(int64), intent(out) :: checksums(:)
      !> Whether all of them were read
      logical, intent(out) :: complete
      character(:), allocatable :: bytes

      allocate (character(word_bytes*size(checksums, kind=int64)) :: bytes)
      call file%read_at(self%checksum_place(first), bytes, complete)
      if (complete) checksums = transfer(bytes, checksums)
   end subroutine read_checksums

   !> Bytes before the input text.
   pure integer(int64) function text_place(header)
      type(result_header_t), intent(in) :: header

      text_place = fixed_header_bytes + size(header%names, kind=int64)*(column_name_bytes + column_unit_bytes)
   end function text_place

   pure integer(int64) function aligned(place)
      integer(int64), intent(in) :: place

      aligned = ((place + alignment - 1_int64)/alignment)*alignment
   end function aligned

   !> Bytes of a header up to the checksums of its chunks, which are zeros in a new file.
   pure function header_text(header) result(bytes)
      !> Laid out
      type(result_header_t), intent(in) :: header
      character(:), allocatable :: bytes
      character(:), allocatable :: front, behind, table
      integer :: i

      front = result_magic//int32_bytes(result_format_version)//int32_bytes(byte_order_mark)//int64_bytes(header%header_bytes)
      behind = int32_bytes(size(header%names, kind=int32))//int32_bytes(len(header%input_text, int32))// &
               header%version//int64_bytes(header%source_checksum)
      table = header%table_magic//int64_bytes(header%chunk_rows)//int64_bytes(header%chunk_count)//int64_bytes(header%row_limit)
      bytes = ''
      do i = 1, size(header%names)
         bytes = bytes//header%names(i)//header%units(i)
      end do
      bytes = bytes//header%input_text
      bytes = front//int64_bytes(header%row_count)//behind//int64_bytes(checksum_of(front//behind//bytes//table))// &
              seal_text(header%seal)//repeat(achar(0), fixed_header_bytes - int(seal_offset) - seal_bytes)//bytes
      bytes = bytes//repeat(achar(0), int(header%table_place()) - len(bytes))//table
   end function header_text

   !> Bytes of a seal, with its own checksum.
   pure function seal_text(seal) result(bytes)
      !> What the checksums cover
      type(result_seal_t), intent(in) :: seal
      character(seal_bytes) :: bytes

      bytes = int64_bytes(seal%rows)//int32_bytes(seal%extremes)//int32_bytes(merge(1_int32, 0_int32, seal%coarse))// &
              int64_bytes(seal%rest_checksum)//int64_bytes(seal%extremes_checksum)
      bytes(seal_bytes - 7:) = int64_bytes(checksum_of(bytes(:seal_bytes - 8)))
   end function seal_text

   !> Read the header of an open file, and see that it is a result file of this format, sound in all its parts.
   subroutine read_result_header(file, path, header, error)
      type(random_access_file_t), intent(in) :: file
      !> Its path, for the error
      character(*), intent(in) :: path
      !> What its header says
      type(result_header_t), intent(out) :: header
      !> Set if it is no such file
      type(error_t), allocatable, intent(out) :: error
      character(fixed_header_bytes) :: fixed
      integer(int32) :: format_version
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
      call read_parts(file, fixed, header, complete)
      if (complete) then
         call read_seal(fixed(seal_offset + 1:seal_offset + seal_bytes), header%seal, complete)
         if (header%row_count == rows_unknown .and. .not. complete) then
            ! The disk was full while the seal was written: it covers nothing.
            header%seal = result_seal_t()
            complete = .true.
         end if
      end if
      if (complete .and. header%table_magic == series_table_magic) &
         complete = header%row_count == rows_unknown .or. header%row_count == header%seal%rows
      if (complete .and. header%table_magic == campaign_table_magic) &
         complete = header%row_count == rows_unknown .or. header%row_count == header%row_limit
      if (.not. complete) call raise(error, exit_bad_input, path//' has a damaged header: its parts contradict each other')
   end subroutine read_result_header

   !> Columns, input text and table, which the checksum of the header covers together with the fixed part.
   subroutine read_parts(file, fixed, header, sound)
      type(random_access_file_t), intent(in) :: file
      character(*), intent(in) :: fixed
      type(result_header_t), intent(inout) :: header
      logical, intent(out) :: sound
      integer, parameter :: width = column_name_bytes + column_unit_bytes
      character(:), allocatable :: columns
      character(table_start_bytes) :: table
      integer(int64) :: file_bytes
      integer :: i, column_count, text_bytes

      file_bytes = file%bytes()
      header%header_bytes = transfer(fixed(17:24), 0_int64)
      header%row_count = transfer(fixed(25:32), 0_int64)
      column_count = int(transfer(fixed(33:36), 0_int32))
      text_bytes = int(transfer(fixed(37:40), 0_int32))
      header%version = fixed(41:64)
      header%source_checksum = transfer(fixed(65:72), 0_int64)
      sound = column_count > 0 .and. text_bytes >= 0
      if (sound) sound = fixed_header_bytes + int(column_count, int64)*width + int(text_bytes, int64) <= header%header_bytes &
                         .and. header%header_bytes <= file_bytes
      if (.not. sound) return
      allocate (header%names(column_count), header%units(column_count))
      allocate (character(column_count*width) :: columns)
      allocate (character(text_bytes) :: header%input_text)
      call file%read_at(int(fixed_header_bytes, int64), columns, sound)
      if (sound) call file%read_at(text_place(header), header%input_text, sound)
      if (sound) call file%read_at(header%table_place(), table, sound)
      if (sound) sound = transfer(fixed(73:80), 0_int64) == checksum_of(fixed(:24)//fixed(33:72)//columns//header%input_text//table)
      if (.not. sound) return
      do i = 1, column_count
         header%names(i) = columns((i - 1)*width + 1:)
         header%units(i) = columns((i - 1)*width + column_name_bytes + 1:)
      end do
      header%table_magic = table(:8)
      header%chunk_rows = transfer(table(9:16), 0_int64)
      header%chunk_count = transfer(table(17:24), 0_int64)
      header%row_limit = transfer(table(25:32), 0_int64)
   end subroutine read_parts

   !> What the checksums of a series cover.
   pure subroutine read_seal(bytes, seal, sound)
      character(*), intent(in) :: bytes
      type(result_seal_t), intent(out) :: seal
      logical, intent(out) :: sound

      sound = transfer(bytes(seal_bytes - 7:), 0_int64) == checksum_of(bytes(:seal_bytes - 8))
      seal%rows = transfer(bytes(1:8), 0_int64)
      seal%extremes = transfer(bytes(9:12), 0_int32)
      seal%coarse = transfer(bytes(13:16), 0_int32) == 1_int32
      seal%rest_checksum = transfer(bytes(17:24), 0_int64)
      seal%extremes_checksum = transfer(bytes(25:32), 0_int64)
   end subroutine read_seal

   pure function int32_bytes(number) result(bytes)
      integer(int32), intent(in) :: number
      character(4) :: bytes

      bytes = transfer(number, bytes)
   end function int32_bytes

   !> A long integer in the byte order of the machine.
   pure function int64_bytes(number) result(bytes)
      integer(int64), intent(in) :: number
      character(8) :: bytes

      bytes = transfer(number, bytes)
   end function int64_bytes

end module result_header
