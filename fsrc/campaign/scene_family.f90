!> The scenes of a trace as a family of period maps along the key of its threshold: every value of the key makes a scene anew, with
!> all that is derived from it. A motion is of the kind that is followed while it is on one side of the criterion.
module scene_family
   use campaign_axis, only: campaign_axis_t, scale_logarithmic
   use carried_loads, only: counts_as, sizes_of_state
   use engine, only: ending_t, motion_state_t, request_t
   use errors, only: error_t
   use kinds, only: dp
   use many_motions, only: solve_motions
   use motion_branch, only: motion_family_t
   use problem, only: problem_of, problem_t, state_size
   use quantities, only: quantity_code, quantity_table
   use scene_status, only: is_success, status_complete
   use scene_types, only: scene_t
   use signals, only: must_stop
   use judge_group, only: judgement_space_t
   use solve_chunk, only: solve_starts
   use threshold_search, only: known_side, new_point, point_t, side_unknown
   use varied_keys, only: is_valid_scene, set_varied_keys
   implicit none(type, external)
   private

   !> What a motion came to.
   type, public :: judged_start_t
      !> Side of the criterion, side_unknown where it is not known
      integer :: side = side_unknown
      !> Periods after which it repeats, 0: it was not seen to
      integer :: period = 0
      !> Numbers of its state at the end, where it did not fail
      real(dp), allocatable :: state(:)
   end type judged_start_t

   !> Scenes of a trace.
   type, extends(motion_family_t), public :: scene_family_t
      private
      !> Base scene, which records what the criterion looks at
      type(scene_t) :: scene
      !> Varied keys of the trace and the key of the threshold, by their positions in the key table, and the values of the first
      integer, allocatable :: positions(:)
      real(dp), allocatable :: values(:)
      !> Range of the key
      type(campaign_axis_t) :: axis
      !> Side that is followed
      integer :: side = side_unknown
      !> Work space
      type(judgement_space_t) :: space
      !> Set if there was no memory for the samples of a scene: nothing that was found is of use
      type(error_t), allocatable, public :: error
   contains
      procedure :: begin
      procedure :: follow_side
      procedure :: followed_side
      procedure :: scan_step
      procedure :: value_at
      procedure :: share_of
      procedure :: problem_at
      procedure :: has_size
      procedure :: judge
      procedure :: map => map_scenes
      procedure :: sizes => sizes_of_scene
      procedure :: keeps_kind => keeps_side
   end type scene_family_t

contains

   !> Make the family of a trace.
   subroutine begin(self, scene, axis, positions, values)
      class(scene_family_t), intent(inout) :: self
      !> Checked base scene
      type(scene_t), intent(in) :: scene
      !> Range of the key of the threshold
      type(campaign_axis_t), intent(in) :: axis
      !> Varied keys of the trace, by their positions in the key table
      integer, intent(in) :: positions(:)
      !> Their values
      real(dp), intent(in) :: values(:)
      integer :: bound

      self%scene = scene
      self%scene%resolved_input = ''
      self%scene%campaign%record = [scene%threshold%quantity]
      bound = quantity_code(trim(quantity_table(scene%threshold%quantity)%name)//'_is_bound')
      if (bound > 0) self%scene%campaign%record = [scene%threshold%quantity, bound]
      self%axis = axis
      self%positions = [positions, axis%position]
      self%values = values
   end subroutine begin

   !> Choose the side of the criterion that motions have to be on.
   subroutine follow_side(self, side)
      class(scene_family_t), intent(inout) :: self
      !> As of threshold_search
      integer, intent(in) :: side

      self%side = side
   end subroutine follow_side

   !> Side of the criterion that motions have to be on.
   pure integer function followed_side(self)
      class(scene_family_t), intent(in) :: self

      followed_side = self%side
   end function followed_side

   !> Step of the scan of the threshold, over the range [-].
   pure real(dp) function scan_step(self)
      class(scene_family_t), intent(in) :: self

      scan_step = 1.0_dp/real(self%scene%threshold%count - 1, dp)
   end function scan_step

   !> Value of the key [its unit].
   real(dp) function value_at(self, share)
      class(scene_family_t), intent(in) :: self
      !> Place in the range, from 0 to 1 [-]
      real(dp), intent(in) :: share

      if (.not. share > 0.0_dp) then
         value_at = self%axis%first
      else if (.not. share < 1.0_dp) then
         value_at = self%axis%last
      else if (self%axis%scale == scale_logarithmic) then
         value_at = self%axis%first*(self%axis%last/self%axis%first)**share
      else
         value_at = self%axis%first*(1.0_dp - share) + self%axis%last*share
      end if
   end function value_at

   !> Place in the range of a place of a search [-].
   real(dp) function share_of(self, place)
      class(scene_family_t), intent(in) :: self
      !> As of threshold_search
      integer, intent(in) :: place

      share_of = real(place, dp)/real(self%axis%count - 1, dp)
   end function share_of

   !> What moves at a place.
   subroutine problem_at(self, share, problem, is_scene)
      class(scene_family_t), intent(in) :: self
      !> Place in the range [-]
      real(dp), intent(in) :: share
      type(problem_t), intent(out) :: problem
      !> Whether the value makes a scene
      logical, intent(out) :: is_scene
      type(scene_t) :: scene
      real(dp) :: values(size(self%positions))

      scene = self%scene
      values = [self%values, self%value_at(share)]
      call set_varied_keys(scene, self%positions, values)
      is_scene = is_valid_scene(scene, self%positions, values)
      if (is_scene) problem = problem_of(scene)
   end subroutine problem_at

   !> Follow motions until they repeat, and find the sides that they are on.
   function judge(self, shares, starts) result(judged)
      class(scene_family_t), intent(inout) :: self
      !> Places in the range, start [-]
      real(dp), intent(in) :: shares(:)
      !> Where each motion starts; without numbers: where its scene says
      type(motion_state_t), intent(in) :: starts(:)
      type(judged_start_t), allocatable :: judged(:)
      real(dp) :: values(size(self%positions), size(shares)), quantities(size(self%scene%campaign%record), size(shares))
      type(ending_t) :: endings(size(shares))
      type(motion_state_t) :: own(size(shares))
      type(point_t) :: point
      integer :: i

      allocate (judged(size(shares)))
      if (allocated(self%error) .or. must_stop()) return
      do i = 1, size(shares)
         values(:, i) = [self%values, self%value_at(shares(i))]
         ! A state of damped teeth is none of teeth without damping, and the other way round: these start where their scene says.
         own(i) = starts(i)
         if (.not. allocated(own(i)%numbers)) cycle
         if (.not. self%has_size(shares(i), size(own(i)%numbers))) own(i) = motion_state_t()
      end do
      call solve_starts(self%scene, self%positions, values, own, self%space, quantities, endings, self%error)
      if (allocated(self%error) .or. must_stop()) return
      do i = 1, size(shares)
         if (size(quantities, 1) > 1) &
            quantities(1, i) = known_side(quantities(1, i), quantities(2, i), self%scene%threshold%level)
         point = new_point(self%scene%threshold, point, endings(i)%status, quantities(1, i))
         judged(i)%side = point%side
         if (.not. is_success(endings(i)%status)) cycle
         judged(i)%period = endings(i)%orbit
         judged(i)%state = endings(i)%numbers
      end do
   end function judge

   !> Whether the state of a scene has so many numbers.
   logical function has_size(self, share, numbers)
      class(scene_family_t), intent(in) :: self
      real(dp), intent(in) :: share
      integer, intent(in) :: numbers
      type(problem_t) :: problem

      call self%problem_at(share, problem, has_size)
      if (has_size) has_size = state_size(problem) == numbers
   end function has_size

   !> Images of states at places of their own; neighbours are solved together.
   subroutine map_scenes(self, periods, accuracy, shares, states, mapped)
      class(scene_family_t), intent(inout) :: self
      integer, intent(in) :: periods
      real(dp), intent(in) :: accuracy
      real(dp), intent(in) :: shares(:)
      real(dp), intent(inout) :: states(:, :)
      logical, intent(out) :: mapped
      type(problem_t) :: problems(size(shares))
      type(motion_state_t) :: starts(size(shares))
      type(ending_t) :: endings(size(shares))
      real(dp) :: none(0, 2, size(shares))
      integer :: i, before

      mapped = .false.
      if (must_stop()) return
      before = 1
      do i = 1, size(shares)
         starts(i)%numbers = states(:, i)
         if (i > 1 .and. .not. abs(shares(i) - shares(before)) > 0.0_dp) then
            problems(i) = problems(before)
         else
            call self%problem_at(shares(i), problems(i), mapped)
            if (mapped) mapped = size(states, 1) == state_size(problems(i))
            if (.not. mapped) return
            before = i
         end if
      end do
      call solve_motions(problems, starts, request_t(accuracy=accuracy, periods=periods), none, endings)
      mapped = all(endings%status == status_complete)
      do i = 1, size(endings)
         states(:, i) = endings(i)%numbers
      end do
   end subroutine map_scenes

   !> What the numbers of a state count as; no sizes where the value makes no scene.
   function sizes_of_scene(self, share, state) result(sizes)
      class(scene_family_t), intent(inout) :: self
      real(dp), intent(in) :: share
      real(dp), intent(in) :: state(:)
      real(dp) :: sizes(size(state))
      type(problem_t) :: problem
      logical :: is_scene

      sizes = 0.0_dp
      call self%problem_at(share, problem, is_scene)
      if (is_scene) sizes = sizes_of_state(problem, state, counts_as(problem, state))
   end function sizes_of_scene

   !> Whether a motion is on the side that is followed.
   logical function keeps_side(self, periods, share, state)
      class(scene_family_t), intent(inout) :: self
      integer, intent(in) :: periods
      real(dp), intent(in) :: share
      real(dp), intent(in) :: state(:)
      type(judged_start_t) :: judged(1)

      judged = self%judge([share], [motion_state_t(numbers=state)])
      keeps_side = judged(1)%side == self%side .and. periods > 0
   end function keeps_side

end module scene_family
