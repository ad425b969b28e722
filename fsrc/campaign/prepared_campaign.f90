!> What is known of a campaign before anything is solved: its plan, the share of this part, its columns, and that there is memory.
module prepared_campaign
   use campaign_header, only: campaign_layout_t
   use campaign_plan, only: count_invalid, look_watcher_t, plan_campaign
   use campaign_record, only: record_columns
   use errors, only: error_t, fault_list_t
   use kinds, only: dp, int64
   use memory, only: expect_memory
   use sampling, only: sample_plan_t
   use scene_types, only: scene_t, task_threshold
   use schedule, only: chunk_rows_for, most_scenes
   use signals, only: lift_time_limit, limit_time
   use solve_chunk, only: chunk_bytes, scenes_of_block
   use text, only: integer_text
   use word_list, only: word_t
   use, intrinsic :: omp_lib, only: omp_get_max_threads
   implicit none(type, external)
   private

   !> What --check may take to read the scenes, and to look at them [s]
   integer, parameter :: reading_limit = 2, looking_limit = 1

   !> A campaign, or one part of it.
   type, public :: campaign_t
      !> Plan of the whole campaign
      type(sample_plan_t) :: plan
      !> First scene of this part, how many of the part were looked at, and how many of these are invalid
      integer(int64) :: first = 0_int64
      integer(int64) :: seen = 0_int64
      integer(int64) :: invalid = 0_int64
      !> Scenes and columns of the result of this part
      type(campaign_layout_t) :: layout
      !> Numbers of a table that no engineer can mean
      type(word_t), allocatable :: warnings(:)
   end type campaign_t

   public :: prepare_campaign

contains

   !> What is known before anything is solved; the scenes are cut by the whole campaign, whatever part of it this is. Those of a
   !> threshold are its traces. After a fault only the faults are of use.
   subroutine prepare_campaign(scene, file, hurried, campaign, faults, watcher)
      !> Checked base scene
      type(scene_t), intent(in) :: scene
      !> Its input, for the faults
      character(*), intent(in) :: file
      !> Whether to look at no more scenes than there is time for
      logical, intent(in) :: hurried
      type(campaign_t), intent(out) :: campaign
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      class(look_watcher_t), optional, intent(inout) :: watcher
      integer(int64) :: last

      if (hurried) call limit_time(reading_limit)
      call plan_campaign(scene, file, campaign%plan, campaign%warnings, faults)
      if (hurried) call lift_time_limit()
      if (faults%count() > 0) return
      campaign%layout%chunk_rows = int(chunk_rows_for(campaign%plan%size, scenes_of_block(scene, campaign%plan)), int64)
      call share_of_part(scene, campaign%plan%size, merge(1_int64, campaign%layout%chunk_rows, scene%task == task_threshold), &
                         campaign%first, last)
      campaign%layout%input_text = scene%resolved_input
      campaign%layout%source_checksum = campaign%plan%table_checksum
      campaign%layout%scene_count = last - campaign%first + 1_int64
      call record_columns(scene, campaign%plan%positions, campaign%layout%names, campaign%layout%units)
      call expect_campaign_memory(scene, file, campaign, faults)
      if (faults%count() > 0) return
      if (hurried) call limit_time(looking_limit)
      call count_invalid(scene, file, campaign%plan, campaign%first, last, campaign%seen, campaign%invalid, faults, &
                         watcher)
      if (hurried) call lift_time_limit()
   end subroutine prepare_campaign

   !> See that there is memory for the threads of this process and for the table of chunks.
   subroutine expect_campaign_memory(scene, file, campaign, faults)
      type(scene_t), intent(in) :: scene
      character(*), intent(in) :: file
      type(campaign_t), intent(in) :: campaign
      type(fault_list_t), intent(inout) :: faults
      !> A thread beside its scenes, and a chunk in all lists of them
      real(dp), parameter :: thread_bytes = 10.0e6_dp, listed_bytes = 64.0_dp
      type(error_t), allocatable :: error
      integer(int64) :: together
      real(dp) :: chunks, row_bytes

      chunks = real((campaign%layout%scene_count + campaign%layout%chunk_rows - 1_int64)/campaign%layout%chunk_rows, dp)
      together = min(max(campaign%layout%chunk_rows, int(most_scenes, int64)), campaign%layout%scene_count)
      row_bytes = 8.0_dp*real(size(campaign%layout%names), dp)*real(together, dp)
      call expect_memory(real(omp_get_max_threads(), dp)*(thread_bytes + 2.0_dp*row_bytes + &
                                                          chunk_bytes(scene, campaign%plan, together)) &
                         + listed_bytes*chunks, &
                         'this campaign of '//integer_text(campaign%layout%scene_count)//' scenes, of which each of '// &
                         integer_text(omp_get_max_threads())//' threads (--threads) solves '// &
                         integer_text(together)//' at a time with windows of &spectrum periods and &campaign '// &
                         'samples_per_period = '//integer_text(scene%campaign%samples_per_period)//',', error)
      if (allocated(error)) call faults%add_error(file, '', '', error)
   end subroutine expect_campaign_memory

   !> Scenes of the whole campaign that this part solves, cut at the borders of chunks; traces of a threshold one by one.
   pure subroutine share_of_part(scene, scenes, chunk, first, last)
      type(scene_t), intent(in) :: scene
      !> Scenes of the campaign, and how many are not divided
      integer(int64), intent(in) :: scenes
      integer(int64), intent(in) :: chunk
      integer(int64), intent(out) :: first
      integer(int64), intent(out) :: last
      integer(int64) :: chunks, parts, part

      chunks = (scenes - 1_int64)/chunk + 1_int64
      parts = int(scene%campaign%parts, int64)
      part = int(scene%campaign%part, int64)
      first = chunk*(chunks*(part - 1_int64)/parts) + 1_int64
      last = min(scenes, chunk*(chunks*part/parts))
   end subroutine share_of_part

end module prepared_campaign
