!> The groups of tasks other than a single motion: &points, &sweep, &campaign, &threshold.
module task_reader
   use key_table, only: find_swept_key, keys
   use keys_in_use, only: in_use
   use kinds, only: dp
   use quantities, only: class_words, least_verdict_with_impacts, need_count, needs_of, needs_regime, quantity_closure_range, &
                         quantity_code, quantity_film_model, quantity_rattle_class, quantity_verdict
   use scene_input, only: scene_input_t
   use scene_types, only: campaign_choice_t, film_points_t, model_numerical, model_published, sweep_t, threshold_t
   use word_list, only: split_words, word_position, word_t
   implicit none(type, external)
   private

   public :: read_points, read_sweep, read_campaign, read_threshold

contains

   !> &points
   function read_points(input, model) result(points)
      type(scene_input_t), intent(in) :: input
      !> Code of the film model
      integer, intent(in) :: model
      type(film_points_t) :: points

      call take_list('film_ratios', 'film_ratio_range', .true., points%film_ratios)
      call take_list('squeeze_ratios', 'squeeze_ratio_range', .false., points%squeeze_ratios)
      call take_list('speed_groups', 'speed_group_range', .true., points%speed_groups)
      points%from_speeds = size(points%speed_groups) == 0
      points%speed_reading = input%choice('points.speed_reading')
      points%compute(input%choices('points.compute')) = .true.
      if (input%is_given('film.model')) then
         points%published = model == model_published
         points%exact = .not. points%published
         points%numerical = model == model_numerical
      end if
      points%profile_nodes = input%count('points.profile_nodes')
      points%cells = input%count('points.cells')

   contains

      !> A list as given, or spread over its range.
      subroutine take_list(list, range, logarithmic, numbers)
         character(*), intent(in) :: list
         character(*), intent(in) :: range
         logical, intent(in) :: logarithmic
         real(dp), allocatable, intent(out) :: numbers(:)
         real(dp), allocatable :: bounds(:)

         if (.not. input%is_given('points.'//range)) then
            allocate (numbers, source=input%numbers('points.'//list))
            return
         end if
         allocate (bounds, source=input%numbers('points.'//range))
         allocate (numbers, source=spread_between(bounds(1), bounds(2), nint(bounds(3)), logarithmic))
      end subroutine take_list

   end function read_points

   !> &sweep
   function read_sweep(input) result(sweep)
      type(scene_input_t), intent(in) :: input
      type(sweep_t) :: sweep
      real(dp), allocatable :: values(:)

      sweep%key = find_swept_key(input%word('sweep.key'))
      sweep%outward = input%count('sweep.count')
      allocate (values, source=spread_between(input%number('sweep.first'), input%number('sweep.last'), sweep%outward, &
                                              input%word('sweep.spacing') == 'logarithmic'))
      if (input%flag('sweep.turn')) then
         allocate (sweep%values, source=[values, values(sweep%outward - 1:1:-1)])
      else
         allocate (sweep%values, source=values)
      end if
   end function read_sweep

   !> &campaign
   function read_campaign(input) result(campaign)
      type(scene_input_t), intent(in) :: input
      type(campaign_choice_t) :: campaign
      type(word_t), allocatable :: recorded(:)
      integer, allocatable :: scales(:)
      logical :: needed(need_count)
      integer :: i, count

      allocate (campaign%vary, source=split_words(input%words('campaign.vary')))
      allocate (scales, source=input%choices('campaign.scale'))
      allocate (campaign%scale(size(campaign%vary)), source=1)
      count = min(size(scales), size(campaign%vary))
      campaign%scale(:count) = scales(:count)
      allocate (campaign%first, source=input%numbers('campaign.first'))
      allocate (campaign%last, source=input%numbers('campaign.last'))
      allocate (campaign%count, source=input%numbers('campaign.count'))
      allocate (campaign%values, source=input%columns('campaign.values'))
      campaign%sample = input%choice('campaign.sample')
      campaign%size = input%count('campaign.size')
      campaign%seed = input%count('campaign.seed')
      campaign%csv = input%path_beside(input%word('campaign.csv'))
      allocate (recorded, source=split_words(input%words('campaign.record')))
      allocate (campaign%record(size(recorded)))
      do i = 1, size(recorded)
         campaign%record(i) = quantity_code(recorded(i)%text)
      end do
      ! Which model a row is from is recorded.
      if (input%word('film.model') == 'automatic' .and. .not. any(campaign%record == quantity_film_model)) &
         campaign%record = [campaign%record, quantity_film_model]
      ! So is whether the closure is extrapolated, where the pressures that it takes are found anyway: alone they cost a tenth.
      needed = needs_of(campaign%record)
      if (input%word('film.law') == 'elastohydrodynamic' .and. needed(needs_regime) .and. &
          .not. any(campaign%record == quantity_closure_range)) campaign%record = [campaign%record, quantity_closure_range]
      campaign%samples_per_period = input%count('campaign.samples_per_period')
      campaign%neighbours = input%flag('campaign.neighbours')
      campaign%allow_invalid = input%flag('campaign.allow_invalid')
      campaign%confirm_size = input%flag('campaign.confirm_size')
      campaign%part = input%count('campaign.part')
      campaign%parts = input%count('campaign.parts')
      allocate (campaign%in_base(size(keys)))
      do i = 1, size(keys)
         campaign%in_base(i) = input%entries(i)%present .and. in_use(input, i)
      end do
   end function read_campaign

   !> &threshold
   function read_threshold(input) result(threshold)
      type(scene_input_t), intent(in) :: input
      type(threshold_t) :: threshold
      character(:), allocatable :: criterion

      threshold%key = input%word('threshold.key')
      threshold%first = input%number('threshold.first')
      threshold%last = input%number('threshold.last')
      threshold%scale = input%choice('threshold.scale')
      threshold%count = input%count('threshold.count')
      threshold%tolerance = input%number('threshold.tolerance')
      threshold%level = input%number('threshold.level')
      criterion = input%word('threshold.criterion')
      threshold%quantity = quantity_code(criterion)
      threshold%wanted = word_position(class_words, criterion)
      if (criterion == 'impacts') then
         threshold%quantity = quantity_verdict
         threshold%least_wanted = least_verdict_with_impacts
      end if
      if (threshold%quantity == 0) threshold%quantity = quantity_rattle_class
   end function read_threshold

   !> Numbers from first to last, both hit exactly.
   pure function spread_between(first, last, count, logarithmic) result(numbers)
      real(dp), intent(in) :: first
      real(dp), intent(in) :: last
      integer, intent(in) :: count
      logical, intent(in) :: logarithmic
      real(dp) :: numbers(count)
      real(dp) :: share
      integer :: n

      do n = 1, count - 1
         share = real(n - 1, dp)/real(count - 1, dp)
         if (logarithmic) then
            numbers(n) = first*(last/first)**share
         else
            numbers(n) = first + (last - first)*share
         end if
      end do
      numbers(count) = last
   end function spread_between

end module task_reader
