!> Layout of a result file, NAME.rattle: unformatted stream, little-endian, self-describing.
!>
!>    byte 0   magic, 8 bytes
!>         8   format version, int32;  12  byte-order mark, int32
!>        16   bytes before the first row, int64, a multiple of 64
!>        24   count of rows, int64; -1 until the file is closed
!>        32   count of columns, int32;  36  bytes of the input text, int32
!>        40   program version, 24 characters
!>        64   checksum of the scenes that a campaign takes from a CSV file, int64; 0: it takes none
!>        72   checksum of the header, int64: bytes 0 to 23, 32 to 71, columns, input text, first 32 bytes of the table
!>        80   rows that the checksums of a series cover, int64; 0 in a campaign
!>        88   count of extreme rows, int32;  92  1: the series is coarser than the motion, else 0, int32
!>        96   checksum of the rows behind the last whole chunk, int64;  104  checksum of the extreme rows, int64
!>       112   checksum of the 32 bytes from 80 on, int64;  120  zeros
!>       128   per column: name (32 characters), unit (16 characters)
!>             input text, resolved, as a namelist; zeros up to a multiple of 64 bytes
!>             table of chunks: 'CHUNKTAB' in a campaign, else 'BLOCKTAB'; rows in a chunk, int64; count of chunks, int64;
!>             rows of a campaign, or rows that a series has at most, int64
!>             per chunk: checksum of its rows, int64; 0: not done, or not whole; zeros up to a multiple of 64 bytes
!>             rows of float64, one value per column
!>             extreme rows, of the same columns, between the times of the others
module result_format
   use kinds, only: int32, int64
   implicit none(type, external)
   private

   character(8), parameter, public :: result_magic = 'RATTLE'//achar(13)//achar(10)
   integer(int32), parameter, public :: result_format_version = 2_int32
   integer(int32), parameter, public :: byte_order_mark = int(z'01020304', int32)
   integer, parameter, public :: alignment = 64, fixed_header_bytes = 128, column_name_bytes = 32, column_unit_bytes = 16
   !> Bytes before the count of rows, and before the seal of a series: what its checksums cover
   integer(int64), parameter, public :: row_count_offset = 24_int64, seal_offset = 80_int64
   integer, parameter, public :: seal_bytes = 40
   integer(int64), parameter, public :: rows_unknown = -1_int64
   character(8), parameter, public :: campaign_table_magic = 'CHUNKTAB', series_table_magic = 'BLOCKTAB'
   !> Bytes of the table of chunks before its checksums, and of a word
   integer(int64), parameter, public :: table_start_bytes = 32_int64, word_bytes = 8_int64

end module result_format
