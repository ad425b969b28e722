!> How long many scenes may take, from trials.
module core_time
   use clock, only: wall_seconds
   use errors, only: error_t
   use kinds, only: dp, int64
   use prepared_campaign, only: campaign_t
   use scene_types, only: scene_t
   use signals, only: lift_time_limit, limit_time, must_stop
   use judge_group, only: judgement_space_t
   use solve_chunk, only: solve_scenes
   use text, only: integer_text, short_text
   implicit none(type, external)
   private

   !> What trials may take [s]
   integer, parameter :: trial_limit = 1

   public :: core_time_sentence

contains

   !> How long the scenes may take, from trials of 8, 64 and 512 of them, as far as there is time.
   function core_time_sentence(scene, campaign) result(sentence)
      !> Checked base scene
      type(scene_t), intent(in) :: scene
      !> Prepared
      type(campaign_t), intent(in) :: campaign
      character(:), allocatable :: sentence
      type(judgement_space_t) :: space
      type(error_t), allocatable :: error
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
         call solve_scenes(scene, campaign%plan, campaign%first + (campaign%seen - trial)/2_int64, space, rows, error)
         seconds = (wall_seconds() - started)/real(trial, dp)*real(campaign%layout%scene_count, dp)
         deallocate (rows)
         if (allocated(error)) sentence = 'not estimated: '//error%message
         if (must_stop() .or. allocated(error)) exit
         sentence = 'estimated '//short_text(seconds, 2)//' s, from '//integer_text(trial)//' scenes'
         if (trial == min(512_int64, campaign%seen)) exit
         trial = min(8_int64*trial, campaign%seen)
      end do
      if (must_stop() .and. trial == min(8_int64, campaign%seen)) &
         sentence = 'more than '//short_text(seconds, 2)//' s: '//integer_text(trial)//' scenes were not solved within '// &
                    integer_text(trial_limit)//' s'
      call lift_time_limit()
   end function core_time_sentence

end module core_time
