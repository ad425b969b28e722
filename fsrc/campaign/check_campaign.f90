!> --check of a campaign or threshold: how many scenes, how large the result, how long it may take.
module check_campaign
   use clock, only: wall_seconds
   use errors, only: fault_list_t
   use kinds, only: dp, int64
   use prepared_campaign, only: campaign_t, prepare_campaign
   use prepared_threshold, only: points_plan, prepare_threshold, prepared_threshold_t
   use run_threshold, only: grid_scenes
   use scene_types, only: scene_t
   use signals, only: lift_time_limit, limit_time, must_stop
   use solve_chunk, only: chunk_space_t, solve_scenes
   use text, only: counted, integer_text, short_text
   implicit none(type, external)
   private

   !> What --check may take to solve some scenes [s]
   integer, parameter :: trial_limit = 1

   public :: check_one_campaign, check_one_threshold

contains

   !> --check of a campaign: how many scenes, how large the result, how long it may take. However large the campaign is,
   !> this takes a few seconds: what was not looked at by then is told.
   subroutine check_one_campaign(scene, file, lines, faults)
      !> Checked base scene
      type(scene_t), intent(in) :: scene
      !> Its input, for the faults
      character(*), intent(in) :: file
      !> What to tell
      character(:), allocatable, intent(out) :: lines
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      type(campaign_t) :: campaign
      integer(int64) :: chunks
      character(:), allocatable :: among
      integer :: i

      lines = ''
      call prepare_campaign(scene, file, .true., campaign, faults)
      if (faults%count() > 0) return
      chunks = (campaign%layout%scene_count + campaign%layout%chunk_rows - 1_int64)/campaign%layout%chunk_rows
      among = ''
      if (campaign%seen < campaign%layout%scene_count) among = ' among the first '//integer_text(campaign%seen)// &
                                                       '; there was no time to look at more'
      do i = 1, size(campaign%warnings)
         lines = lines//'! '//campaign%warnings(i)%text//new_line('a')
      end do
      ! Where a table is so long that its traces could not even be counted, none of its scenes was looked at.
      lines = lines//'! scenes             '//trim(merge(' at least', '         ', &
                                                           campaign%seen == 0_int64 .and. chunks > 0_int64))// &
              ' '//integer_text(campaign%layout%scene_count)//' ('//integer_text(campaign%invalid)// &
              ' invalid'//among//')'//new_line('a')//'! result size         '// &
              short_text(8.0e-6_dp*real(size(campaign%layout%names), dp)* &
                                                   real(campaign%layout%scene_count, dp), 3)//' MB'//new_line('a')// &
              '! chunks              '//integer_text(chunks)//' of at most '// &
              counted(campaign%layout%chunk_rows, 'scene')//new_line('a')// &
              '! core time, '//core_time_sentence(scene, campaign)
   end subroutine check_one_campaign

   !> --check of a threshold: how many traces and scenes, and how long the scan may take.
   subroutine check_one_threshold(scene, file, lines, faults)
      !> Checked base scene
      type(scene_t), intent(in) :: scene
      !> Its input, for the faults
      character(*), intent(in) :: file
      !> What to tell
      character(:), allocatable, intent(out) :: lines
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      type(prepared_threshold_t) :: threshold
      type(campaign_t) :: scan
      integer(int64) :: trace_count, looked_at, trace
      integer :: i, scanned

      lines = ''
      call prepare_threshold(scene, file, .true., threshold, faults)
      if (faults%count() > 0) return
      trace_count = threshold%traces%layout%scene_count
      scanned = size(threshold%scan)
      do i = 1, size(threshold%traces%warnings)
         lines = lines//'! '//threshold%traces%warnings(i)%text//new_line('a')
      end do
      scan = threshold%traces
      looked_at = min(trace_count, max(1_int64, 512_int64/scanned))
      scan%first = 1_int64
      scan%seen = looked_at*scanned
      call points_plan(threshold, threshold%traces%first + [((trace, i=1, scanned), trace=0_int64, looked_at - 1_int64)], &
                       [((threshold%scan(i), i=1, scanned), trace=1_int64, looked_at)], scan%plan)
      scan%layout%scene_count = trace_count*scanned
      scan%layout%names = [scan%layout%names, scan%layout%names(1)]
      lines = lines//'! traces              '//integer_text(trace_count)//new_line('a')// &
              '! scenes of the scan  '//integer_text(scan%layout%scene_count)//new_line('a')// &
              '! a grid as fine has  '//integer_text(nint(grid_scenes(scene, threshold), int64))//' scenes'//new_line('a')// &
              '! core time of the scan, '//core_time_sentence(scene, scan)
   end subroutine check_one_threshold

   !> How long the scenes may take, from trials of 8, 64 and 512 of them, as far as there is time.
   function core_time_sentence(scene, campaign) result(sentence)
      type(scene_t), intent(in) :: scene
      type(campaign_t), intent(in) :: campaign
      character(:), allocatable :: sentence
      type(chunk_space_t) :: space
      real(dp), allocatable :: rows(:, :)
      real(dp) :: started, seconds
      integer(int64) :: trial

      sentence = 'not estimated: no scene could be looked at'
      if (campaign%seen == 0_int64) return
      call limit_time(trial_limit)
      trial = min(8_int64, campaign%seen)
      do
         allocate (rows(size(campaign%layout%names), trial))
         started = wall_seconds()
         call solve_scenes(scene, campaign%plan, campaign%first + (campaign%seen - trial)/2_int64, space, rows)
         seconds = (wall_seconds() - started)/real(trial, dp)*real(campaign%layout%scene_count, dp)
         deallocate (rows)
         if (must_stop()) exit
         sentence = 'estimated '//short_text(seconds, 2)//' s, from '//integer_text(trial)//' scenes'
         if (trial == min(512_int64, campaign%seen)) exit
         trial = min(8_int64*trial, campaign%seen)
      end do
      if (must_stop() .and. trial == min(8_int64, campaign%seen)) &
         sentence = 'more than '//short_text(seconds, 2)//' s: '//integer_text(trial)//' scenes were not solved within '// &
                    integer_text(trial_limit)//' s'
      call lift_time_limit()
   end function core_time_sentence

end module check_campaign
