!> What is known of a threshold before anything is solved: its traces, the range of its key, its scan.
module prepared_threshold
   use campaign_axis, only: campaign_axis_t, check_axis, grid_value
   use campaign_plan, only: check_size, count_invalid, look_watcher_t
   use derived_scene, only: derive
   use errors, only: fault_list_t
   use input_key, only: allowed_text, in_range, is_computable, not_computable_text
   use key_table, only: find_key, key_name, keys
   use kinds, only: dp, int64
   use mistaken_units, only: meant_behind
   use prepared_campaign, only: campaign_t, prepare_campaign
   use sampling, only: plan_table, sample_plan_t, scene_values
   use scene_types, only: scene_t, set_number
   use signals, only: lift_time_limit, limit_time
   use threshold_search, only: finest_axis, scan_places
   use text, only: real_text
   use varied_keys, only: find_varied_key, is_whole
   implicit none(type, external)
   private

   !> What --check may take to look at the traces with the last value of the key [s]
   integer, parameter :: looking_limit = 1

   !> Traces, each a scene of &campaign, along which the key is varied.
   type, public :: prepared_threshold_t
      !> Its scenes are the traces
      type(campaign_t) :: traces
      !> Range of the key, as finely divided as the brackets become
      type(campaign_axis_t) :: axis
      !> Places of the scan
      integer, allocatable :: scan(:)
   end type prepared_threshold_t

   public :: prepare_threshold, points_plan

contains

   !> What is known before anything is solved. After a fault only the faults are of use.
   subroutine prepare_threshold(scene, file, hurried, threshold, faults, watcher)
      !> Checked base scene
      type(scene_t), intent(in) :: scene
      !> Its input, for the faults
      character(*), intent(in) :: file
      !> Whether to look at no more traces than there is time for
      logical, intent(in) :: hurried
      type(prepared_threshold_t), intent(out) :: threshold
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      class(look_watcher_t), optional, intent(inout) :: watcher
      integer(int64) :: seen, invalid, last
      integer :: before

      before = faults%count()
      call check_key(scene, file, threshold%axis, faults)
      if (faults%count() > before) then
         ! The faults of the axes are reported with those of the key.
         call prepare_campaign(scene, file, hurried, threshold%traces, faults)
         return
      end if
      call prepare_campaign(scene_at(scene, threshold%axis, 0), file, hurried, threshold%traces, faults, watcher)
      if (faults%count() > before) return
      associate (traces => threshold%traces, axis => threshold%axis)
         if (any(traces%plan%positions == axis%position)) &
            call add(scene, file, 'key', '&campaign varies '//key_name(axis%position)//' already; a threshold needs a key of '// &
                     'its own', faults)
         threshold%scan = scan_places(scene%threshold, axis)
         call check_size(scene, file, traces%plan%size*size(threshold%scan, kind=int64), faults)
         if (faults%count() > before) return
         last = traces%first + traces%layout%scene_count - 1_int64
         if (hurried) call limit_time(looking_limit)
         call count_invalid(scene_at(scene, axis, axis%count - 1), file, traces%plan, traces%first, last, seen, invalid, faults, &
                            watcher)
         if (hurried) call lift_time_limit()
      end associate
   end subroutine prepare_threshold

   !> The key is one that can be varied, and its range makes sense.
   subroutine check_key(scene, file, axis, faults)
      type(scene_t), intent(in) :: scene
      character(*), intent(in) :: file
      !> Range of the key; of use only if no fault was added
      type(campaign_axis_t), intent(out) :: axis
      type(fault_list_t), intent(inout) :: faults
      character(*), parameter :: ends(2) = ['first', 'last ']
      character(:), allocatable :: message
      real(dp) :: values(2)
      integer :: position, i

      associate (threshold => scene%threshold)
         call find_varied_key(threshold%key, position, message)
         if (len(message) > 0) then
            call add(scene, file, 'key', threshold%key//': '//message, faults)
            return
         end if
         if (.not. scene%campaign%in_base(position)) then
            call add(scene, file, 'key', threshold%key//': the base input does not use this key; give it there, or take the '// &
                     'one it uses', faults)
            return
         end if
         values = [threshold%first, threshold%last]
         do i = 1, size(ends)
            if (.not. in_range(keys(position), values(i))) then
               message = real_text(values(i))//' is not allowed for '//threshold%key//'; allowed: '//allowed_text(keys(position))
            else if (.not. is_computable(keys(position), values(i))) then
               message = not_computable_text(keys(position), values(i))
            else
               cycle
            end if
            call add(scene, file, trim(ends(i)), message//meant_behind(keys(position), values(i)), faults)
            return
         end do
         axis = campaign_axis_t(position=position, whole=is_whole(position), scale=threshold%scale, first=threshold%first, &
                                last=threshold%last, count=threshold%count)
         call check_axis(axis, .false., message)
         if (len(message) > 0) call add(scene, file, 'first', message, faults)
         if (len(message) == 0) axis = finest_axis(threshold, position, is_whole(position))
      end associate
   end subroutine check_key

   !> Add a fault at a key of &threshold.
   subroutine add(scene, file, key, message, faults)
      type(scene_t), intent(in) :: scene
      character(*), intent(in) :: file
      character(*), intent(in) :: key
      character(*), intent(in) :: message
      type(fault_list_t), intent(inout) :: faults

      call faults%add(file, scene%lines(find_key('threshold.'//key)), 'threshold', key, message)
   end subroutine add

   !> The base scene with a value of the key.
   function scene_at(scene, axis, place) result(at)
      type(scene_t), intent(in) :: scene
      type(campaign_axis_t), intent(in) :: axis
      integer, intent(in) :: place
      type(scene_t) :: at
      integer :: i

      at = scene
      if (allocated(scene%pairs)) then
         ! A key of a gear is one of each pair.
         do i = 1, size(scene%pairs)
            at%gear = scene%pairs(i)
            call set_number(at, keys(axis%position)%group, keys(axis%position)%name, grid_value(axis, place))
            at%pairs(i) = at%gear
         end do
         at%gear = scene%pairs(1)
      end if
      call set_number(at, keys(axis%position)%group, keys(axis%position)%name, grid_value(axis, place))
      call derive(at)
   end function scene_at

   !> The scenes at some places of some traces.
   subroutine points_plan(threshold, traces, places, plan)
      type(prepared_threshold_t), intent(in) :: threshold
      !> Trace of each scene, and its place there
      integer(int64), intent(in) :: traces(:)
      integer, intent(in) :: places(:)
      type(sample_plan_t), intent(out) :: plan
      real(dp), allocatable :: values(:, :)
      integer :: i, axes

      axes = size(threshold%traces%plan%positions)
      allocate (values(axes + 1, size(traces)))
      do i = 1, size(traces)
         call scene_values(threshold%traces%plan, traces(i), values(:axes, i))
         values(axes + 1, i) = grid_value(threshold%axis, places(i))
      end do
      call plan_table([threshold%traces%plan%positions, threshold%axis%position], values, plan)
   end subroutine points_plan

end module prepared_threshold
