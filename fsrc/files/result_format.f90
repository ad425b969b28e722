!> Layout of a result file, NAME.rattle: unformatted stream, little-endian, self-describing.
!>
!>    byte 0   magic, 8 bytes
!>         8   format version, int32;  12  byte-order mark, int32
!>        16   bytes before the first row, int64, a multiple of 64
!>        24   count of rows, int64; -1 until the file is closed
!>        32   count of columns, int32;  36  bytes of the input text, int32
!>        40   program version, 24 characters
!>        64   per column: name (32 characters), unit (16 characters)
!>             input text, resolved, as a namelist; zeros up to the first row
!>             rows of float64, one value per column
module result_format
   use kinds, only: int32, int64
   implicit none(type, external)
   private

   character(8), parameter, public :: result_magic = 'RATTLE'//achar(13)//achar(10)
   integer(int32), parameter, public :: result_format_version = 1_int32
   integer(int32), parameter, public :: byte_order_mark = int(z'01020304', int32)
   integer, parameter, public :: alignment = 64, fixed_header_bytes = 64, column_name_bytes = 32, column_unit_bytes = 16
   !> Bytes before the count of rows
   integer(int64), parameter, public :: row_count_offset = 24_int64
   integer(int64), parameter, public :: rows_unknown = -1_int64

end module result_format
