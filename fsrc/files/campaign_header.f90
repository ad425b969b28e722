!> What the header of a campaign file holds; see campaign_file.
module campaign_header
   use errors, only: error_t, exit_bad_input, raise
   use input_difference, only: differing_keys
   use kinds, only: int64
   use random_access_file, only: random_access_file_t
   use result_format, only: campaign_table_magic, column_name_bytes, column_unit_bytes
   use result_header, only: read_result_header, result_header_t
   use text, only: integer_text
   use version, only: program_version
   implicit none(type, external)
   private

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
      !> Checksum of the scenes of a CSV file; 0: they come from the input
      integer(int64) :: source_checksum = 0_int64
   end type campaign_layout_t

   public :: header_for, check_same_campaign

contains

   !> Header of a new file, laid out.
   pure function header_for(layout) result(header)
      !> What is computed
      type(campaign_layout_t), intent(in) :: layout
      type(result_header_t) :: header

      allocate (header%names, source=layout%names)
      allocate (header%units, source=layout%units)
      header%input_text = layout%input_text
      header%source_checksum = layout%source_checksum
      header%table_magic = campaign_table_magic
      header%chunk_rows = layout%chunk_rows
      header%row_limit = layout%scene_count
      call header%lay_out()
   end function header_for

   !> Read the header of a file, and see that it was begun with the same input, scenes, columns and program. The scenes
   !> in a chunk are those of the file, whatever the layout says.
   subroutine check_same_campaign(file, path, layout, header, error)
      type(random_access_file_t), intent(in) :: file
      !> Its path, for the error
      character(*), intent(in) :: path
      !> What is computed now
      type(campaign_layout_t), intent(in) :: layout
      !> What the header of the file says
      type(result_header_t), intent(out) :: header
      !> Set if the file belongs to another campaign; the keys that differ are named
      type(error_t), allocatable, intent(out) :: error
      character(:), allocatable :: difference

      call read_result_header(file, path, header, error)
      if (allocated(error)) return
      if (header%table_magic /= campaign_table_magic) then
         call raise(error, exit_bad_input, path//' is not the result of a campaign, it has no table of chunks; '// &
                    '--overwrite begins anew')
      else if (header%input_text /= layout%input_text .or. len(header%input_text) /= len(layout%input_text)) then
         difference = differing_keys(header%input_text, layout%input_text)
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
      else if (header%source_checksum /= layout%source_checksum) then
         call raise(error, exit_bad_input, path//' was begun with other scenes: the CSV file has changed; '// &
                    '--overwrite begins anew')
      else if (header%row_limit /= layout%scene_count) then
         call raise(error, exit_bad_input, path//' holds '//integer_text(header%row_limit)//' scenes, this campaign has '// &
                    integer_text(layout%scene_count)//'; --overwrite begins anew')
      end if
   end subroutine check_same_campaign

end module campaign_header
