!> What the header of a campaign file holds, and the places that follow from it; see campaign_file.
module campaign_header
   use errors, only: error_t, exit_bad_input, raise
   use input_difference, only: first_difference
   use kinds, only: int64
   use random_access_file, only: random_access_file_t
   use result_format, only: alignment, column_name_bytes, column_unit_bytes
   use result_header, only: aligned_text_end, header_text, read_result_header, result_header_t
   use version, only: program_version
   implicit none(type, external)
   private

   character(8), parameter :: table_magic = 'CHUNKTAB'
   !> Bytes of a number, and of the table before its checksums
   integer(int64), parameter :: word_bytes = 8_int64, table_start_bytes = 24_int64

   !> What a campaign computes.
   type, public :: campaign_layout_t
      !> Resolved input as namelist text
      character(:), allocatable :: input_text
      !> Names and units of the columns
      character(column_name_bytes), allocatable :: names(:)
      character(column_unit_bytes), allocatable :: units(:)
      !> Number of scenes, 1 or more
      integer(int64) :: scene_count = 0_int64
      !> Scenes in a chunk, 1 or more
      integer(int64) :: chunk_rows = 0_int64
   end type campaign_layout_t

   !> Where everything stands, in bytes from the start of the file.
   type, public :: campaign_places_t
      !> Table of chunks, and its first checksum
      integer(int64) :: table = 0_int64
      integer(int64) :: checksums = 0_int64
      integer(int64) :: first_row = 0_int64
      integer(int64) :: chunk_rows = 0_int64
      integer(int64) :: chunk_count = 0_int64
      integer :: column_count = 0
   contains
      procedure :: checksum_place
      procedure :: row_place
      procedure :: table_start
   end type campaign_places_t

   public :: places_for, header_front, check_same_campaign, find_places

contains

   !> Places in a new file.
   pure function places_for(layout) result(places)
      !> What is computed
      type(campaign_layout_t), intent(in) :: layout
      type(campaign_places_t) :: places
      integer(int64) :: table_end

      places%column_count = size(layout%names)
      places%chunk_rows = layout%chunk_rows
      places%chunk_count = (layout%scene_count - 1_int64)/layout%chunk_rows + 1_int64
      places%table = aligned_text_end(header_for(layout))
      places%checksums = places%table + table_start_bytes
      table_end = places%checksums + word_bytes*places%chunk_count
      places%first_row = ((table_end + alignment - 1_int64)/alignment)*alignment
   end function places_for

   !> Header of a new file up to the end of the input text.
   pure function header_front(layout, places) result(bytes)
      !> What is computed
      type(campaign_layout_t), intent(in) :: layout
      !> Its places
      type(campaign_places_t), intent(in) :: places
      character(:), allocatable :: bytes
      type(result_header_t) :: header

      header = header_for(layout)
      header%header_bytes = places%first_row
      bytes = header_text(header)
   end function header_front

   pure function header_for(layout) result(header)
      type(campaign_layout_t), intent(in) :: layout
      type(result_header_t) :: header

      allocate (header%names, source=layout%names)
      allocate (header%units, source=layout%units)
      header%input_text = layout%input_text
   end function header_for

   !> See that a file was begun with the same input, columns and program.
   subroutine check_same_campaign(file, path, layout, error)
      !> Open file
      type(random_access_file_t), intent(in) :: file
      !> Its path, for the error
      character(*), intent(in) :: path
      !> What is computed now
      type(campaign_layout_t), intent(in) :: layout
      !> Set if the file belongs to another campaign; the first key that differs is named
      type(error_t), allocatable, intent(out) :: error
      type(result_header_t) :: header
      character(:), allocatable :: difference

      call read_result_header(file, path, header, error)
      if (allocated(error)) return
      if (header%input_text /= layout%input_text .or. len(header%input_text) /= len(layout%input_text)) then
         difference = first_difference(header%input_text, layout%input_text)
         if (len(difference) == 0) difference = 'the texts differ, though no key does'
         call raise(error, exit_bad_input, path//' was begun with another input: '//difference// &
                    '; --overwrite begins anew')
      else if (header%version /= program_version) then
         call raise(error, exit_bad_input, path//' was begun by version '//trim(header%version)// &
                    ' of the program, this is '//program_version//'; --overwrite begins anew')
      else if (size(header%names) /= size(layout%names)) then
         call raise(error, exit_bad_input, path//' was begun with other columns; --overwrite begins anew')
      else if (any(header%names /= layout%names) .or. any(header%units /= layout%units)) then
         call raise(error, exit_bad_input, path//' was begun with other columns; --overwrite begins anew')
      end if
   end subroutine check_same_campaign

   !> Places in a file whose header is that of the layout; the scenes in a chunk are read from its table.
   subroutine find_places(file, path, layout, places, error)
      !> Open file
      type(random_access_file_t), intent(in) :: file
      !> Its path, for the error
      character(*), intent(in) :: path
      !> What is computed
      type(campaign_layout_t), intent(in) :: layout
      !> The places
      type(campaign_places_t), intent(out) :: places
      !> Set if the table of chunks is damaged
      type(error_t), allocatable, intent(out) :: error
      type(campaign_layout_t) :: stored
      type(result_header_t) :: header
      character(len(table_magic)) :: magic
      integer(int64) :: counts(2)
      logical :: sound

      call read_result_header(file, path, header, error)
      if (allocated(error)) return
      places = places_for(layout)
      call file%read_at(places%table, magic, sound)
      if (sound) sound = magic == table_magic
      if (.not. sound) then
         call raise(error, exit_bad_input, path// &
                    ' is not the result of a campaign, it has no table of chunks')
         return
      end if
      call file%read_at(places%table + len(table_magic), counts, sound)
      if (sound) sound = counts(1) > 0_int64
      if (sound) then
         stored = layout
         stored%chunk_rows = counts(1)
         places = places_for(stored)
         sound = counts(2) == places%chunk_count .and. header%header_bytes == places%first_row
      end if
      if (.not. sound) &
         call raise(error, exit_bad_input, path//' has a damaged table of chunks; --overwrite begins anew')
   end subroutine find_places

   !> Place of the checksum of a chunk.
   pure integer(int64) function checksum_place(self, chunk)
      class(campaign_places_t), intent(in) :: self
      !> From 1
      integer(int64), intent(in) :: chunk

      checksum_place = self%checksums + word_bytes*(chunk - 1_int64)
   end function checksum_place

   !> Place of the row of a scene.
   pure integer(int64) function row_place(self, scene)
      class(campaign_places_t), intent(in) :: self
      !> From 1
      integer(int64), intent(in) :: scene

      row_place = self%first_row + word_bytes*int(self%column_count, int64)*(scene - 1_int64)
   end function row_place

   !> Table of chunks before its checksums.
   pure function table_start(self) result(bytes)
      class(campaign_places_t), intent(in) :: self
      character(table_start_bytes) :: bytes

      bytes = table_magic//transfer(self%chunk_rows, repeat(' ', 8))// &
              transfer(self%chunk_count, repeat(' ', 8))
   end function table_start

end module campaign_header
