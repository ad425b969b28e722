!> Scenes as the lanes of a group, for Newmark's method: coefficients and states of all scenes, scene by
!> scene.
!>
!> Time is counted in steps and force in the film that it moves in a step, so that the formulas of Newmark's
!> method have no factors: with V = dt z', A = dt^2/4 z'' and the load L = dt^2/(4 m) W,
!>
!>    h_i = h_(i-1) + V_(i-1) + A_(i-1) + A_i ,   V_i = V_(i-1) + 2 (A_(i-1) + A_i) .
!>
!> The laws (35) and (37) keep their form, only their coefficients change. The film stays in metres.
module newmark_lane_group
   use, intrinsic :: iso_c_binding, only: c_f_pointer, c_ptr
   use aligned_memory, only: allocate_lines
   use film_law, only: film_t, kernel_half_pi, kernel_piezo, overflow_load
   use kinds, only: dp, int64
   use newmark, only: motion_state_t, newmark_t
   implicit none(type, external)
   private

   !> Scenes of a group. So many hide the latency of divisions and roots, and their data stay in the nearest
   !> cache. An odd number of cache lines: every array of a group starts with a line if the first one does,
   !> and no two at the same place in a page, where a store to one would hold up the loads of the other.
   integer, parameter, public :: group_lanes = 136
   !> Lanes are used in blocks of this many, a register at most, so that none is left to other instructions.
   integer, parameter, public :: block_lanes = 8

   !> A step at work. The iterate is the state of the group.
   type, public :: newmark_lane_step_t
      !> h and V at the end of the step were A zero there [m]
      real(dp) :: known_film(group_lanes) = 0.0_dp
      real(dp) :: known_velocity(group_lanes) = 0.0_dp
      !> Force at the end of the step, as L [m]
      real(dp) :: force(group_lanes) = 0.0_dp
      !> Iterate before the present one: h, never below `smallest`, and A [m]
      real(dp) :: film(group_lanes) = 1.0_dp
      real(dp) :: acceleration(group_lanes) = 0.0_dp
      !> Film that fails, and least film of all iterates [m]
      real(dp) :: smallest(group_lanes) = 0.0_dp
      real(dp) :: least(group_lanes) = 1.0_dp
      !> L [m] and its slopes dL/dh [-] and dL/dV [-] at the iterate, over a common denominator
      real(dp) :: load(group_lanes) = 0.0_dp
      real(dp) :: load_by_film(group_lanes) = 0.0_dp
      real(dp) :: load_by_velocity(group_lanes) = 0.0_dp
      real(dp) :: denominator(group_lanes) = 1.0_dp
      !> Exponential of (37) at the extrapolated iterate [-]
      real(dp) :: growth(group_lanes) = 1.0_dp
      !> Positive where the step has met the criterion of (36) and kept its film
      real(dp) :: margin(group_lanes) = 1.0_dp
   end type newmark_lane_step_t

   !> Group of scenes that share film law and steps per period.
   type, public :: newmark_lane_group_t
      !> h [m], V [m] and A [m]
      real(dp) :: film(group_lanes) = 1.0_dp
      real(dp) :: velocity(group_lanes) = 0.0_dp
      real(dp) :: acceleration(group_lanes) = 0.0_dp
      !> Coefficient of 1/h in (35) or of h^(-7/2) in (37), of L instead of W
      real(dp) :: strength(group_lanes) = 0.0_dp
      !> Coefficient of the squeeze term of (35), of L and V, or the factor of V in the exponent of (37)
      real(dp) :: squeeze(group_lanes) = 0.0_dp
      !> Factor of V in the exponent of (37) if its base is 2 [1/m]
      real(dp) :: doubling_rate(group_lanes) = 0.0_dp
      !> Q + m g and F0, as L [m]
      real(dp) :: mean_force(group_lanes) = 0.0_dp
      real(dp) :: force_amplitude(group_lanes) = 0.0_dp
      !> L above which the law has no value [m]
      real(dp) :: largest_load(group_lanes) = 1.0_dp
      !> eps of (36) [m]
      real(dp) :: tolerance(group_lanes) = 1.0_dp
      !> Most passes in a step
      integer :: pass_limit(group_lanes) = 2
      !> A step failed: the lane rests since
      logical :: failed(group_lanes) = .false.
      !> Passes beyond two, of all steps
      integer(int64) :: further_passes(group_lanes) = 0_int64
      !> The step at work
      type(newmark_lane_step_t) :: step
      !> Film law: kernel_half_pi or kernel_piezo of film_law
      integer :: kernel = kernel_half_pi
      !> Lanes in use, a multiple of `block_lanes`
      integer :: used = 0
   end type newmark_lane_group_t

   public :: place_group, has_lanes, load_lane, rest_group_lane, lane_state

contains

   !> A group of resting lanes that starts with a cache line.
   subroutine place_group(room, group)
      !> Memory of the group
      real(dp), allocatable, target, intent(out) :: room(:)
      !> The group in it; lives as long as `room`, which has to be a target
      type(newmark_lane_group_t), pointer, intent(out) :: group
      type(c_ptr) :: place

      call allocate_lines(storage_size(newmark_lane_group_t()), room, place)
      call c_f_pointer(place, group)
      group = newmark_lane_group_t()
   end subroutine place_group

   !> Whether a scene can be solved in a lane: published film with a load in closed form, Newton's iteration
   !> from the extrapolated state.
   elemental logical function has_lanes(film, method)
      !> Its film
      type(film_t), intent(in) :: film
      !> Its constants
      type(newmark_t), intent(in) :: method

      has_lanes = (film%kernel == kernel_half_pi .or. film%kernel == kernel_piezo) .and. &
         method%by_newton .and. method%extrapolate .and. method%iteration_limit >= 2
   end function has_lanes

   !> Put a scene into a lane.
   pure subroutine load_lane(group, lane, film, method, time_step, state)
      !> The group
      type(newmark_lane_group_t), intent(inout) :: group
      !> Lane
      integer, intent(in) :: lane
      !> Film of the scene, of the law of the group
      type(film_t), intent(in) :: film
      !> Constants of the scene
      type(newmark_t), intent(in) :: method
      !> Step [s]
      real(dp), intent(in) :: time_step
      !> State at its start
      type(motion_state_t), intent(in) :: state
      real(dp) :: film_by_force

      film_by_force = 0.25_dp*time_step*time_step/method%mass
      if (group%kernel == kernel_piezo) then
         group%strength(lane) = film%piezo*film_by_force
         group%squeeze(lane) = film%rate/time_step
         group%doubling_rate(lane) = group%squeeze(lane)/log(2.0_dp)
      else
         group%strength(lane) = film%rolling*film_by_force
         group%squeeze(lane) = film%squeeze*(film_by_force/time_step)
      end if
      group%mean_force(lane) = (method%steady_force + method%weight)*film_by_force
      group%force_amplitude(lane) = method%force_amplitude*film_by_force
      group%largest_load(lane) = overflow_load*film_by_force
      group%tolerance(lane) = method%tolerance
      group%pass_limit(lane) = method%iteration_limit
      group%failed(lane) = .false.
      call set_lane_state(group, lane, time_step, state)
   end subroutine load_lane

   !> Let a lane rest: a film of 1 m on which nothing acts.
   pure subroutine rest_group_lane(group, lane)
      !> The group
      type(newmark_lane_group_t), intent(inout) :: group
      !> Lane
      integer, intent(in) :: lane

      group%film(lane) = 1.0_dp
      group%velocity(lane) = 0.0_dp
      group%acceleration(lane) = 0.0_dp
      group%strength(lane) = 0.0_dp
      group%squeeze(lane) = 0.0_dp
      group%doubling_rate(lane) = 0.0_dp
      group%mean_force(lane) = 0.0_dp
      group%force_amplitude(lane) = 0.0_dp
      group%largest_load(lane) = 1.0_dp
      group%tolerance(lane) = 1.0_dp
   end subroutine rest_group_lane

   !> State of a lane from units.
   pure subroutine set_lane_state(group, lane, time_step, state)
      !> The group
      type(newmark_lane_group_t), intent(inout) :: group
      !> Lane
      integer, intent(in) :: lane
      !> Step [s]
      real(dp), intent(in) :: time_step
      !> The state
      type(motion_state_t), intent(in) :: state

      group%film(lane) = state%film
      group%velocity(lane) = state%velocity*time_step
      group%acceleration(lane) = state%acceleration*(0.25_dp*time_step*time_step)
   end subroutine set_lane_state

   !> State of a lane in units.
   pure type(motion_state_t) function lane_state(group, lane, time_step)
      !> The group
      type(newmark_lane_group_t), intent(in) :: group
      !> Lane
      integer, intent(in) :: lane
      !> Step [s]
      real(dp), intent(in) :: time_step

      lane_state%film = group%film(lane)
      lane_state%velocity = group%velocity(lane)/time_step
      lane_state%acceleration = group%acceleration(lane)/(0.25_dp*time_step*time_step)
   end function lane_state

end module newmark_lane_group
