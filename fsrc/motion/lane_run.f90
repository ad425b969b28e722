!> A block of lanes at work: what has become of the scene of every lane, and what is taken of it on the way.
module lane_run
   use elastic_tangents, only: lane_tangents_t
   use engine, only: ending_t, request_t
   use flank_contact, only: flank_contact_t
   use film_series, only: film_series_t
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use lane_functions, only: lanes
   use lane_state, only: lane_inner_t
   use lane_sampling, only: lane_samples_t
   use repetition, only: orbit_watch_t, recurrence_t
   use step_nodes, only: step_nodes_t
   implicit none(type, external)
   private

   !> Where a motion was left for an excursion.
   type, public :: departure_t
      !> Period 0: it is on its own way
      integer :: period = 0
      !> Scaled [-]
      real(dp), allocatable :: state(:)
      type(orbit_watch_t) :: states = orbit_watch_t()
   end type departure_t

   !> What happened to the scene of a lane.
   type, public :: lane_watch_t
      !> Scene, 0: none
      integer :: scene = 0
      !> Periods done, to be done, and from which on to sample
      integer :: period = 0, last_period = 0, sample_from = 0
      !> Scaled state at the start of the present period [-]
      real(dp), allocatable :: state(:)
      !> Film that one of each number of the state counts as; that of the velocity is set at the end of every period [-]
      real(dp), allocatable :: weights(:)
      !> State at the end of the period before, where known motions are looked for
      real(dp), allocatable :: earlier(:)
      !> Films and velocities at the ends of all periods, where an irregular one is among these: number, period
      real(dp), allocatable :: path(:, :)
      !> Looks for repetition, and for return to the last bit
      type(orbit_watch_t) :: states = orbit_watch_t()
      type(recurrence_t) :: past = recurrence_t()
      !> Excursion under way, the period at which it has failed, its forecasts, and excursions made
      type(departure_t) :: departure = departure_t()
      integer :: back_at = 0, forecasts = 0, excursions = 0
      !> Phase in the period that was not finished, of a motion that failed [periods], and the film there [m]
      real(dp) :: phase = 0.0_dp, film = 0.0_dp
      type(ending_t) :: ending = ending_t()
   end type lane_watch_t

   !> A block at work.
   type, public :: lane_run_t
      type(request_t) :: request
      !> Taylor series, else collocation; and whose series; and whether contacts have numbers of their own
      logical :: by_series = .true., own_numbers = .false.
      type(film_series_t) :: series
      !> Most steps in a period, and largest damping rate [1/periods]
      real(dp) :: most_steps = 0.0_dp, largest_rate = 0.0_dp
      !> Contacts of the lanes
      type(flank_contact_t) :: contacts(lanes)
      !> Scenes of the queue taken, lanes with a scene
      integer :: taken = 0, active = lanes
      type(lane_block_t), pointer :: block => null()
      !> States of films, beside the block
      type(lane_inner_t) :: inner(lanes)
      !> Displacements that are carried along
      type(lane_tangents_t) :: tangents(lanes)
      type(lane_samples_t) :: samples
      type(lane_watch_t) :: watches(lanes)
      !> Nodes of the steps of the present period, where windows are recorded
      type(step_nodes_t) :: nodes(lanes)
   end type lane_run_t

end module lane_run
