!> Impacts on a flank, counted while the points of the load W of its film come in from the beginning of a window to its end.
!>
!> An impact is a maximum of W above a limit, which lies above F_max, the largest force. Two maxima are one impact unless W falls
!> below half of the smaller one in between. The interval of an impact is the stretch about its largest maximum in which
!> W > F_max; two impacts in one stretch part where W is lowest between them. Where W > F_max all along there is no impact. Where
!> its interval begins the gear approaches the flank at some velocity, and the integral of W over the interval is the impulse.
!> Restitution is the velocity away from the flank where W falls to F_max after the largest impact over that of approach where W
!> rose past F_max before it.
!>
!> A window is taken as cyclic, since a motion that repeats goes on where it began: the points before W is low for the first
!> time are kept, and come once more behind the end.
module impacts
   use kinds, only: dp
   implicit none(type, external)
   private

   !> What a point of W(t) is: one on the way, W passing F_max upwards or downwards, or so low that every impact is over.
   integer, parameter, public :: point_passing = 0, point_rise = 1, point_fall = 2, point_low = 3

   !> Impacts of a flank that are kept one by one, the first ones.
   integer, parameter :: most_kept = 20

   !> A point of W(t).
   type, public :: load_point_t
      !> Since the window began [periods]
      real(dp) :: time = 0.0_dp
      !> W [N]
      real(dp) :: load = 0.0_dp
      !> Of the gear towards the flank [m/s]
      real(dp) :: velocity = 0.0_dp
      !> Integral of W over the time so far in which W > F_max [N periods]; right where an interval may begin or end
      real(dp) :: sum = 0.0_dp
      integer :: kind = point_passing
   end type load_point_t

   !> An impact: when W is largest [periods since the window began], W there [N], velocity of approach where the interval
   !> begins [m/s], impulse [N periods].
   type, public :: impact_t
      real(dp) :: time = 0.0_dp
      real(dp) :: load = 0.0_dp
      real(dp) :: velocity = 0.0_dp
      real(dp) :: impulse = 0.0_dp
   end type impact_t

   !> The impacts of a flank.
   type, public :: impact_count_t
      integer :: count = 0
      !> Largest load [N], impulse [N periods] and velocity [m/s], and sum of the impulses
      real(dp) :: load_maximum = 0.0_dp
      real(dp) :: impulse_maximum = 0.0_dp
      real(dp) :: velocity_maximum = 0.0_dp
      real(dp) :: impulse_sum = 0.0_dp
      !> Load of the largest impact whose stretch of W > F_max is over [N], and the velocities of approach where this began and away
      !> from the flank where it ended [m/s]; 0 of approach: not known, as it did not begin or end within the window
      real(dp) :: followed_load = 0.0_dp
      real(dp) :: approach = 0.0_dp
      real(dp) :: departure = 0.0_dp
      !> The first of them
      type(impact_t), allocatable :: kept(:)
   end type impact_count_t

   !> Watches the load of a flank.
   type, extends(impact_count_t), public :: impact_watch_t
      !> F_max, and the load above which a maximum is an impact [N]
      real(dp) :: level = huge(1.0_dp), limit = huge(1.0_dp)
      !> The last point, if there is one, and whether W > F_max there
      type(load_point_t) :: last = load_point_t()
      logical :: started = .false., above = .false.
      !> The points before W was low for the first time
      logical, private :: settled = .false.
      integer, private :: head_size = 0
      type(load_point_t), allocatable, private :: head(:)
      !> The impact under way, if there is one, and whether the stretch about its maximum goes on
      logical, private :: is_open = .false., in_its_stretch = .false.
      type(impact_t), private :: open = impact_t()
      !> Where its interval begins, where the present stretch does, and the lowest point since its maximum
      !> Largest load of the impacts of the present stretch [N], and velocity of approach where it began [m/s]
      real(dp), private :: stretch_load = 0.0_dp, rise_velocity = 0.0_dp
      type(load_point_t), private :: its_begin = load_point_t(), begin = load_point_t(), valley = load_point_t()
   end type impact_watch_t

   public :: take_point, impacts_of_watch

contains

   !> Take the next point.
   pure subroutine take_point(point, watch)
      type(load_point_t), intent(in) :: point
      type(impact_watch_t), intent(inout) :: watch

      watch%last = point
      watch%started = .true.
      watch%above = point%kind == point_rise .or. (point%kind == point_passing .and. point%load > watch%level)
      if (watch%settled) then
         call follow(point, watch)
      else
         call keep(point, watch)
         watch%settled = point%kind == point_low
      end if
   end subroutine take_point

   !> The impacts of a window.
   pure function impacts_of_watch(watch, periods) result(impacts)
      !> With the points of the whole window
      type(impact_watch_t), intent(in) :: watch
      !> Its length [periods]
      real(dp), intent(in) :: periods
      type(impact_count_t) :: impacts
      type(impact_watch_t) :: closed
      type(load_point_t) :: point
      integer :: first, i

      if (.not. watch%started) return
      closed = watch
      ! Without a low point the window is followed from its lowest point on.
      first = 1
      if (.not. watch%settled) then
         ! A load that never falls to F_max has no interval that begins: a gear held between both flanks has no impacts.
         if (all(watch%head(:watch%head_size)%load > watch%level)) return
         first = minloc(watch%head(:watch%head_size)%load, dim=1)
         closed%begin = watch%head(first)
         do i = first, watch%head_size
            call follow(watch%head(i), closed)
         end do
      end if
      do i = 1, merge(watch%head_size, first, watch%settled)
         point = watch%head(i)
         point%time = point%time + periods
         point%sum = point%sum + watch%last%sum
         if (i == 1) call join_ends(point, closed)
         call follow(point, closed)
      end do
      if (closed%is_open) call close_impact(closed%last, closed)
      impacts = closed%impact_count_t
      if (allocated(impacts%kept)) then
         impacts%kept = impacts%kept(:min(size(impacts%kept), impacts%count))
         impacts%kept%time = modulo(impacts%kept%time, periods)
         do i = 2, size(impacts%kept)
            first = count(impacts%kept(:i - 1)%time <= impacts%kept(i)%time)
            impacts%kept(first + 1:i) = [impacts%kept(i), impacts%kept(first + 1:i - 1)]
         end do
      end if
   end function impacts_of_watch

   !> Let a window begin anew with its first point. A stretch at one end alone, of a motion that does not repeat, ends there.
   pure subroutine join_ends(point, watch)
      type(load_point_t), intent(in) :: point
      type(impact_watch_t), intent(inout) :: watch
      type(load_point_t) :: seam

      if (watch%above .eqv. point%load > watch%level) return
      seam = watch%last
      seam%kind = point_fall
      watch%rise_velocity = 0.0_dp
      if (watch%above) call follow(seam, watch)
      watch%stretch_load = 0.0_dp
      watch%begin = point
   end subroutine join_ends

   !> Keep a point that may belong to the end of the window.
   pure subroutine keep(point, watch)
      type(load_point_t), intent(in) :: point
      type(impact_watch_t), intent(inout) :: watch
      type(load_point_t), allocatable :: longer(:)
      integer, parameter :: first_room = 16

      if (.not. allocated(watch%head)) allocate (watch%head(first_room))
      if (watch%head_size == size(watch%head)) then
         allocate (longer(2*watch%head_size))
         longer(:watch%head_size) = watch%head
         call move_alloc(longer, watch%head)
      end if
      watch%head_size = watch%head_size + 1
      watch%head(watch%head_size) = point
   end subroutine keep

   !> Follow the load to a point.
   pure subroutine follow(point, watch)
      type(load_point_t), intent(in) :: point
      type(impact_watch_t), intent(inout) :: watch

      select case (point%kind)
      case (point_low)
         if (watch%is_open) call close_impact(point, watch)
      case (point_rise)
         watch%begin = point
         watch%rise_velocity = point%velocity
         watch%stretch_load = 0.0_dp
      case (point_fall)
         if (watch%stretch_load > watch%followed_load) then
            watch%followed_load = watch%stretch_load
            watch%approach = watch%rise_velocity
            watch%departure = -point%velocity
         end if
         if (watch%in_its_stretch) call end_interval(point, watch)
         if (point%load < watch%valley%load) watch%valley = point
      case default
         if (.not. watch%is_open) then
            if (point%load > watch%limit) call open_impact(point, watch)
         else if (point%load > watch%limit .and. watch%valley%load < 0.5_dp*min(watch%open%load, point%load)) then
            if (watch%in_its_stretch) watch%begin = watch%valley
            call close_impact(watch%valley, watch)
            call open_impact(point, watch)
         else if (point%load > watch%open%load) then
            if (watch%in_its_stretch) watch%begin = watch%its_begin
            call open_impact(point, watch)
         else if (point%load < watch%valley%load) then
            watch%valley = point
         end if
      end select
   end subroutine follow

   !> Let a point be the maximum of an impact in the present stretch.
   pure subroutine open_impact(point, watch)
      type(load_point_t), intent(in) :: point
      type(impact_watch_t), intent(inout) :: watch

      watch%is_open = .true.
      watch%in_its_stretch = .true.
      watch%stretch_load = max(watch%stretch_load, point%load)
      watch%its_begin = watch%begin
      watch%open = impact_t(time=point%time, load=point%load, velocity=watch%begin%velocity)
      watch%valley = point
   end subroutine open_impact

   !> End the interval of the impact under way.
   pure subroutine end_interval(point, watch)
      type(load_point_t), intent(in) :: point
      type(impact_watch_t), intent(inout) :: watch

      watch%open%impulse = point%sum - watch%its_begin%sum
      watch%in_its_stretch = .false.
   end subroutine end_interval

   !> Count the impact under way, whose interval ends at a point at the latest.
   pure subroutine close_impact(point, watch)
      type(load_point_t), intent(in) :: point
      type(impact_watch_t), intent(inout) :: watch

      if (watch%in_its_stretch) call end_interval(point, watch)
      watch%is_open = .false.
      watch%count = watch%count + 1
      associate (impact => watch%open)
         watch%load_maximum = max(watch%load_maximum, impact%load)
         watch%impulse_maximum = max(watch%impulse_maximum, impact%impulse)
         watch%velocity_maximum = merge(impact%velocity, max(watch%velocity_maximum, impact%velocity), watch%count == 1)
         watch%impulse_sum = watch%impulse_sum + impact%impulse
         if (watch%count > most_kept) return
         if (.not. allocated(watch%kept)) allocate (watch%kept(most_kept))
         watch%kept(watch%count) = impact
      end associate
   end subroutine close_impact

end module impacts
