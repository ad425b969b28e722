!> From &campaign to a plan of scenes: which keys vary, which values they take, how many scenes that makes.
module campaign_plan
   use campaign_axis, only: campaign_axis_t
   use completed_scene, only: beyond_measured_speeds
   use csv_samples, only: csv_samples_t, read_csv_samples
   use errors, only: fault_list_t
   use key_table, only: key_name
   use kinds, only: dp, int64
   use odd_numbers, only: odd_numbers_of_list
   use sampling, only: chunk_values, cross_plan, method_grid, plan_grid, plan_sobol, &
                       plan_table, sample_plan_t
   use scene_types, only: scene_t
   use signals, only: must_stop
   use text, only: integer_text, printable
   use varied_keys, only: find_varied_key, is_valid_scene, is_whole, pair_position, set_varied_keys, why_invalid
   use word_list, only: word_t
   implicit none(type, external)
   private

   !> Campaigns beyond this must be meant.
   integer(int64), parameter :: unconfirmed_limit = 10000000_int64
   !> Scenes that are looked at together
   integer, parameter :: block = 4096
   !> Invalid scenes that are named one by one
   integer, parameter :: most_named = 20

   !> Gets a report of how far the look at the scenes of a campaign is.
   type, abstract, public :: look_watcher_t
      !> Whether there is a reason to look no further
      logical :: is_refused = .false.
   contains
      procedure(scenes_seen), deferred :: note_seen
   end type look_watcher_t

   abstract interface
      subroutine scenes_seen(self, seen, all)
         import :: int64, look_watcher_t
         class(look_watcher_t), intent(inout) :: self
         !> Scenes that were looked at
         integer(int64), intent(in) :: seen
         !> Scenes that will be looked at
         integer(int64), intent(in) :: all
      end subroutine scenes_seen
   end interface

   public :: plan_campaign, check_size, count_invalid

contains

   !> Plan of a campaign; faults are added with the place in the input.
   subroutine plan_campaign(scene, file, plan, warnings, faults)
      !> Checked base scene
      type(scene_t), intent(in) :: scene
      !> Its input, for the faults
      character(*), intent(in) :: file
      !> The plan; of use only if no fault was added
      type(sample_plan_t), intent(out) :: plan
      !> Columns of a table that hold numbers no engineer can mean, a line each; what stands in the input itself is known
      !> with it
      type(word_t), allocatable, intent(out) :: warnings(:)
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      type(campaign_axis_t), allocatable :: axes(:)
      type(csv_samples_t) :: samples
      character(:), allocatable :: message
      integer :: before, bad_axis, i
      type(campaign_axis_t) :: pair_axis

      before = faults%count()
      allocate (warnings(0))
      if (allocated(scene%pairs)) then
         pair_axis%position = pair_position()
         pair_axis%values = [(real(i, dp), i=1, size(scene%pairs))]
      end if
      if (len(scene%campaign%csv) > 0) then
         call read_csv_samples(scene%campaign%csv, samples, faults)
         if (faults%count() > before) return
         do i = 1, size(samples%positions)
            call check_position(scene, scene%campaign%csv, key_name(samples%positions(i)), samples%positions(i), faults)
         end do
         if (faults%count() > before) return
         warnings = samples%notes
         do i = 1, size(samples%positions)
            warnings = [warnings, odd_numbers_of_list(printable(scene%campaign%csv, .false.), 'column '//integer_text(i), &
                                                      samples%positions(i), samples%values(i, :samples%read), samples%first_line)]
            if (key_name(samples%positions(i)) == 'shaft.speed_rpm' .and. samples%read > 0_int64) &
               warnings = [warnings, beyond_measured_speeds(scene, minval(samples%values(i, :samples%read)), &
                                                            maxval(samples%values(i, :samples%read)))]
         end do
         call plan_table(samples%positions, samples%values, plan)
         plan%known = samples%read
         plan%first_line = samples%first_line
      else if (size(scene%campaign%vary) == 0) then
         ! A threshold without axes has one trace.
         allocate (samples%positions(0), samples%values(0, 1))
         call plan_table(samples%positions, samples%values, plan)
      else
         call form_axes(scene, file, axes, faults)
         if (faults%count() > before) return
         select case (scene%campaign%sample)
         case (method_grid)
            ! The pair is the first axis: what other keys say of a gear is said of each pair.
            if (allocated(scene%pairs)) axes = [pair_axis, axes]
            call plan_grid(axes, plan, bad_axis, message)
         case default
            call plan_sobol(axes, int(scene%campaign%size, int64), int(scene%campaign%seed, int64), plan, bad_axis, message)
         end select
         if (len(message) > 0) then
            if (bad_axis > 0) message = key_name(axes(bad_axis)%position)//': '//message
            call faults%add(file, 0, 'campaign', 'vary', message)
            return
         end if
      end if
      if (allocated(scene%pairs) .and. plan%method /= method_grid) call cross_plan(pair_axis, plan)
      call check_size(scene, file, plan%size, faults)
   end subroutine plan_campaign

   !> So many scenes must be meant.
   subroutine check_size(scene, file, scenes, faults)
      type(scene_t), intent(in) :: scene
      !> Its input, for the faults
      character(*), intent(in) :: file
      integer(int64), intent(in) :: scenes
      type(fault_list_t), intent(inout) :: faults

      if (scenes > unconfirmed_limit .and. .not. scene%campaign%confirm_size) &
         call faults%add(file, 0, 'campaign', 'confirm_size', integer_text(scenes)// &
                         ' scenes; set it to .true. if so many are meant')
   end subroutine check_size

   !> Axes of the varied keys.
   subroutine form_axes(scene, file, axes, faults)
      type(scene_t), intent(in) :: scene
      character(*), intent(in) :: file
      type(campaign_axis_t), allocatable, intent(out) :: axes(:)
      type(fault_list_t), intent(inout) :: faults
      character(:), allocatable :: message
      integer :: i

      associate (campaign => scene%campaign)
         allocate (axes(size(campaign%vary)))
         do i = 1, size(axes)
            call find_varied_key(campaign%vary(i)%text, axes(i)%position, message)
            if (len(message) > 0) then
               call faults%add(file, 0, 'campaign', 'vary', campaign%vary(i)%text//': '//message)
               cycle
            end if
            call check_position(scene, file, campaign%vary(i)%text, axes(i)%position, faults)
            axes(i)%whole = is_whole(axes(i)%position)
            axes(i)%scale = campaign%scale(i)
            if (i <= size(campaign%values)) then
               if (size(campaign%values(i)%numbers) > 0) then
                  axes(i)%values = campaign%values(i)%numbers
                  cycle
               end if
            end if
            if (i > size(campaign%first) .or. i > size(campaign%last) .or. &
                (campaign%sample == method_grid .and. i > size(campaign%count))) then
               call faults%add(file, 0, 'campaign', 'vary', campaign%vary(i)%text// &
                               ': give first('//integer_text(i)//'), last('//integer_text(i)//') and count('// &
                               integer_text(i)//'), or values(:, '//integer_text(i)//')')
               cycle
            end if
            axes(i)%first = campaign%first(i)
            axes(i)%last = campaign%last(i)
            if (i <= size(campaign%count)) axes(i)%count = nint(campaign%count(i))
         end do
         if (maxval([size(campaign%first), size(campaign%last), size(campaign%count), size(campaign%values)]) > size(axes)) &
            call faults%add(file, 0, 'campaign', 'vary', 'there are more ranges than varied keys')
      end associate
   end subroutine form_axes

   !> A varied key must have its value in the base.
   subroutine check_position(scene, file, name, position, faults)
      type(scene_t), intent(in) :: scene
      character(*), intent(in) :: file
      character(*), intent(in) :: name
      integer, intent(in) :: position
      type(fault_list_t), intent(inout) :: faults

      if (.not. scene%campaign%in_base(position)) &
         call faults%add(file, 0, 'campaign', 'vary', name// &
                         ': the base input does not use this key; give it there, or vary the one it uses')
   end subroutine check_position

   !> Scenes that are no valid scenes; the first ones are named as faults unless they are allowed. All scenes are looked at
   !> whose values are known, unless the work must stop.
   subroutine count_invalid(scene, file, plan, first, last, seen, invalid, faults, watcher)
      !> Checked base scene
      type(scene_t), intent(in) :: scene
      !> Its input, for the faults
      character(*), intent(in) :: file
      !> The plan
      type(sample_plan_t), intent(in) :: plan
      !> First and last scene to look at
      integer(int64), intent(in) :: first
      integer(int64), intent(in) :: last
      !> How many were looked at
      integer(int64), intent(out) :: seen
      !> How many of them are invalid
      integer(int64), intent(out) :: invalid
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      class(look_watcher_t), optional, intent(inout) :: watcher
      type(scene_t) :: trial
      real(dp), allocatable :: values(:, :)
      integer(int64) :: start
      integer :: i, count

      invalid = 0_int64
      trial = scene
      seen = 0_int64
      do start = first, min(last, plan%known), int(block, int64)
         count = int(min(int(block, int64), min(last, plan%known) - start + 1_int64))
         if (allocated(values)) deallocate (values)
         allocate (values(size(plan%positions), count))
         call chunk_values(plan, start, values)
         do i = 1, count
            call set_varied_keys(trial, plan%positions, values(:, i))
            if (is_valid_scene(trial, plan%positions, values(:, i))) cycle
            invalid = invalid + 1_int64
            if (scene%campaign%allow_invalid .or. invalid > int(most_named, int64)) cycle
            call name_invalid(start + int(i - 1, int64), why_invalid(trial, plan%positions, values(:, i)))
         end do
         seen = seen + int(count, int64)
         if (must_stop()) exit
         if (.not. present(watcher)) cycle
         call watcher%note_seen(seen, min(last, plan%known) - first + 1_int64)
         if (watcher%is_refused) exit
      end do
      if (invalid > int(most_named, int64) .and. .not. scene%campaign%allow_invalid) &
         call faults%add(file, 0, 'campaign', '', integer_text(invalid)//' scenes are not valid')

   contains

      !> A scene of a table is named by its line there.
      subroutine name_invalid(number, why)
         integer(int64), intent(in) :: number
         character(*), intent(in) :: why
         character(*), parameter :: remedy = '; &campaign allow_invalid = .true. records it as an invalid scene'

         if (len(scene%campaign%csv) > 0) then
            call faults%add(scene%campaign%csv, int(min(number + int(plan%first_line - 1, int64), int(huge(1), int64))), '', '', &
                            why//remedy)
         else
            call faults%add(file, 0, 'campaign', '', 'scene '//integer_text(number)//' is not valid: '//why//remedy)
         end if
      end subroutine name_invalid

   end subroutine count_invalid

end module campaign_plan
