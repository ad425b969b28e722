!> Scenes as the lanes of a block: what is asked for, how it ends, and the scaled coefficients of every lane.
!>
!> Time is counted in periods of the force, x = f_exc t, within a period from 0 to 1, so the phase is as exact
!> after hundreds of periods as in the first. The film is scaled by the power of two next to the reference
!> film: scaling costs no digit, and a motion carried on from `film` and `momentum` of its ending goes on as
!> if never stopped.
module lane_scenes
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use, intrinsic :: iso_c_binding, only: c_f_pointer, c_ptr
   use constants, only: pi
   use film_law, only: film_load, film_t, kernel_piezo, kernel_reynolds_iso, kernel_reynolds_piezo, kernel_solved_fast, &
                       overflow_load, steady_film
   use kinds, only: dp, int64
   use lane_functions, only: lanes
   use load_expansion, only: load_expansion_t
   use memory, only: allocate_lines
   use radau_nodes, only: stages
   use reynolds_piezo_expansion, only: reynolds_piezo_expansion_t
   use scene_status, only: status_complete, status_film_lost, status_overflow
   use settling_rate, only: settling_of, settling_t
   use taylor_step_control, only: order
   implicit none(type, external)
   private

   !> One scene.
   type, public :: lane_scene_t
      !> Its film law
      type(film_t) :: film
      !> Mass m [kg] and weight m g [N]
      real(dp) :: mass = 0.0_dp
      real(dp) :: weight = 0.0_dp
      !> Steady force Q and amplitude F0 of (34) [N]
      real(dp) :: steady_force = 0.0_dp
      real(dp) :: force_amplitude = 0.0_dp
      !> Frequency f_exc [Hz]
      real(dp) :: frequency = 0.0_dp
      !> h [m] and z' [m/s] at the start, which is the start of a period
      real(dp) :: initial_film = 0.0_dp
      real(dp) :: initial_velocity = 0.0_dp
      !> A motion carried on: periods, momentum and method are those of its ending; the momentum stands for
      !> the velocity
      logical :: carried_on = .false.
      integer :: periods_done = 0
      logical :: implicit = .false.
      real(dp) :: initial_momentum = 0.0_dp
      !> Film by which the motion is scaled, carried on or not, where none carries the static load [m]; 0: initial_film
      real(dp) :: first_film = 0.0_dp
   end type lane_scene_t

   !> What is asked of all scenes of a call.
   type, public :: lane_request_t
      !> Relative accuracy of the film [-]
      real(dp) :: accuracy = 1.0e-8_dp
      !> Periods to solve, those done before included; the most if `until_steady`
      integer :: periods = 0
      !> Samples of a period, at phases 1/n, 2/n, ... 1
      integer :: samples_per_period = 0
      !> Periods sampled, the last ones, or one orbit of a motion found steady; 0: no samples
      integer :: sampled_periods = 0
      !> Stop when the motion is known to repeat
      logical :: until_steady = .false.
      !> Compute every period, those too that return to the last bit
      logical :: every_period = .false.
      !> Set out to where a slowly settling motion is forecast to come to rest. If it then repeats, the periods before the
      !> samples are fewer than those that follow from the start
      logical :: forecast = .false.
   end type lane_request_t

   !> How a scene ended.
   type, public :: lane_ending_t
      !> Status of scene_status
      integer :: status = status_complete
      !> Whole periods solved, those done before included
      integer :: periods = 0
      !> State at their end: h [m], z' [m/s]
      real(dp) :: film = 0.0_dp
      real(dp) :: velocity = 0.0_dp
      !> Scaled momentum there [-], to carry the motion on
      real(dp) :: momentum = 0.0_dp
      !> Phase in the period that was not finished, of a scene that failed [periods]
      real(dp) :: phase = 0.0_dp
      !> Periods after which a steady motion repeats, else 0
      integer :: orbit = 0
      !> Bound of the relative distance of the film from the motion that repeats [-]
      real(dp) :: distance = 0.0_dp
      !> Samples written
      integer :: samples = 0
      !> Steps of the motion, those of returning periods too
      integer(int64) :: steps = 0
      !> Whether the motion went on by the implicit method
      logical :: implicit = .false.
   end type lane_ending_t

   !> Scenes of a block, lane by lane.
   type, public :: lane_block_t
      !> Load coefficient and damping of the film law, static load, force amplitude, all scaled
      real(dp) :: strength(lanes), damping(lanes), load(lanes), amplitude(lanes)
      !> Force that errors of the load are held against, q + f
      real(dp) :: force(lanes)
      !> What counts as 1: film [m], velocity [m/s], force [N]
      real(dp) :: film_scale(lanes), velocity_scale(lanes), force_scale(lanes)
      !> Accuracy [-]
      real(dp) :: accuracy(lanes)
      !> Series of H and V; coefficients 0 are the state
      real(dp) :: film(lanes, 0:order), momentum(lanes, 0:order)
      !> Phase of the state, next step, what is left of the period, longest step allowed [periods]
      real(dp) :: phase(lanes), step(lanes), remaining(lanes), limit(lanes)
      !> State that the step leads to, and whether it is to be trusted (1) or not (0)
      real(dp) :: next_film(lanes), next_momentum(lanes), trust(lanes)
      !> H' = V + slip/sqrt(H): 2 b in Lienard's form, 0 where V is H' itself
      real(dp) :: slip(lanes)
      !> Damping rate at the state [1/periods]
      real(dp) :: damping_rate(lanes)
      !> Collocation: next step proposed, last step taken [periods], polynomial of the acceleration in that
      !> step, and whether the last try met a film that has no load
      real(dp) :: proposed(lanes), last_step(lanes), polynomial(lanes, stages)
      !> H'' at the start of the step
      real(dp) :: acceleration(lanes)
      logical :: no_load(lanes)
      !> Steps of this period
      real(dp) :: period_steps(lanes)
      !> Of films with rupture: cos and sin of 2 pi phase, and the load expanded last
      real(dp) :: cosine(lanes), sine(lanes)
      type(load_expansion_t) :: expansion
      !> Of the exact piezo-viscous film: b, where the pressure group is b H^(-3/2), and its load expanded last
      real(dp) :: pressing(lanes)
      type(reynolds_piezo_expansion_t) :: piezo_expansion
   end type lane_block_t

   !> First step of a period by collocation [periods]
   real(dp), parameter :: first_step = 1.0_dp/64.0_dp

   public :: carried_on_from, place_block, load_scene, rest_lane, start_period, state_of_lane, start_status, &
             reference_film, lane_accuracy

contains

   !> Film that carries the static load, or the first film where there is none [m].
   pure real(dp) function reference_film(scene)
      !> The scene
      type(lane_scene_t), intent(in) :: scene

      reference_film = 0.0_dp
      if (scene%steady_force + scene%weight > 0.0_dp) &
         reference_film = steady_film(scene%film, scene%steady_force + scene%weight)
      if (.not. reference_film > 0.0_dp) reference_film = scene%first_film
      if (.not. reference_film > 0.0_dp) reference_film = scene%initial_film
   end function reference_film

   !> Accuracy to which the periods of a motion are solved [-]. Where the film settles slowly, the errors of many periods add up
   !> before they are forgotten.
   elemental real(dp) function lane_accuracy(scene, accuracy)
      !> The scene
      type(lane_scene_t), intent(in) :: scene
      !> Relative accuracy of the film asked for [-]
      real(dp), intent(in) :: accuracy
      !> No step is better than rounding
      real(dp), parameter :: best_accuracy = 1.0e-13_dp
      type(settling_t) :: settling
      real(dp) :: film

      lane_accuracy = accuracy
      film = reference_film(scene)
      if (.not. (film > 0.0_dp .and. ieee_is_finite(film))) return
      settling = settling_of(scene%film, film, film, scene%mass, scene%frequency)
      lane_accuracy = min(accuracy, max(accuracy*settling%rate, best_accuracy))
   end function lane_accuracy

   !> A motion from the end of one of its periods on: the same steps as if it had never stopped there.
   pure function carried_on_from(scene, film, velocity, momentum, implicit, periods_done) result(rest)
      !> The scene
      type(lane_scene_t), intent(in) :: scene
      !> State there: h [m], z' [m/s], scaled momentum [-]
      real(dp), intent(in) :: film
      real(dp), intent(in) :: velocity
      real(dp), intent(in) :: momentum
      !> Whether the motion goes on by the implicit method
      logical, intent(in) :: implicit
      !> Periods that count as done
      integer, intent(in) :: periods_done
      type(lane_scene_t) :: rest

      rest = scene
      rest%carried_on = .true.
      rest%periods_done = periods_done
      rest%implicit = implicit
      rest%initial_film = film
      rest%initial_velocity = velocity
      rest%initial_momentum = momentum
   end function carried_on_from

   !> Whether the motion can start: `status_complete`, or why not.
   pure integer function start_status(scene)
      !> The scene
      type(lane_scene_t), intent(in) :: scene
      real(dp) :: load, load_by_film, load_by_velocity

      start_status = status_film_lost
      if (.not. (ieee_is_finite(scene%initial_film) .and. ieee_is_finite(scene%initial_velocity))) return
      if (scene%initial_film <= 0.0_dp) return
      call film_load(scene%film, scene%initial_film, scene%initial_velocity, load, load_by_film, &
         load_by_velocity)
      start_status = merge(status_complete, status_overflow, abs(load) < overflow_load)
   end function start_status

   !> A block that starts with a cache line, its lanes undefined. All its arrays fill whole lines, so each starts with one.
   subroutine place_block(room, block)
      !> Memory of the block
      real(dp), allocatable, target, intent(out) :: room(:)
      !> The block in it; lives as long as `room`, which has to be a target
      type(lane_block_t), pointer, intent(out) :: block
      type(c_ptr) :: place

      call allocate_lines(storage_size(block), room, place)
      call c_f_pointer(place, block)
      block%expansion = load_expansion_t()
      block%piezo_expansion = reynolds_piezo_expansion_t()
   end subroutine place_block

   !> Put a scene into a lane, at the start of its first period.
   pure subroutine load_scene(scene, by_series, accuracy, lane, block)
      !> The scene
      type(lane_scene_t), intent(in) :: scene
      !> Taylor series, else collocation
      logical, intent(in) :: by_series
      !> Relative accuracy of the film [-]
      real(dp), intent(in) :: accuracy
      !> Lane
      integer, intent(in) :: lane
      !> The block
      type(lane_block_t), intent(inout) :: block
      real(dp) :: force_scale, film_scale

      call rest_lane(lane, block)
      film_scale = 2.0_dp**nint(log(reference_film(scene))/log(2.0_dp))
      force_scale = scene%mass*film_scale*scene%frequency**2
      block%film_scale(lane) = film_scale
      block%velocity_scale(lane) = film_scale*scene%frequency
      block%force_scale(lane) = force_scale
      block%load(lane) = (scene%steady_force + scene%weight)/force_scale
      block%amplitude(lane) = scene%force_amplitude/force_scale
      block%force(lane) = abs(block%load(lane)) + abs(block%amplitude(lane))
      block%accuracy(lane) = lane_accuracy(scene, accuracy)
      block%film(lane, 0) = scene%initial_film/film_scale
      block%momentum(lane, 0) = scene%initial_velocity/block%velocity_scale(lane)
      if (by_series .and. scene%film%kernel == kernel_piezo) then
         block%strength(lane) = scene%film%piezo/(film_scale**3*sqrt(film_scale))/force_scale
         block%damping(lane) = scene%film%rate*block%velocity_scale(lane)
      else if (by_series .and. scene%film%kernel == kernel_reynolds_iso) then
         block%strength(lane) = scene%film%scale/film_scale/force_scale
         block%damping(lane) = scene%film%squeeze_rate*block%velocity_scale(lane)/sqrt(film_scale)
      else if (by_series .and. scene%film%kernel == kernel_reynolds_piezo) then
         block%strength(lane) = scene%film%scale/film_scale/force_scale
         block%damping(lane) = scene%film%squeeze_rate*block%velocity_scale(lane)/sqrt(film_scale)
         block%pressing(lane) = scene%film%pressure_rate/(film_scale*sqrt(film_scale))
      else if (by_series .and. scene%film%kernel == kernel_solved_fast) then
         block%strength(lane) = scene%film%rolling/film_scale/force_scale
         block%damping(lane) = scene%film%squeeze_rate*block%velocity_scale(lane)/sqrt(film_scale)
      else if (by_series) then
         block%strength(lane) = scene%film%rolling/film_scale/force_scale
         block%damping(lane) = 2.0_dp*pi*scene%film%squeeze/sqrt(film_scale)*scene%frequency/force_scale
         block%slip(lane) = block%damping(lane)
         block%momentum(lane, 0) = block%momentum(lane, 0) - block%slip(lane)/sqrt(block%film(lane, 0))
      end if
      if (scene%carried_on) block%momentum(lane, 0) = scene%initial_momentum
      call start_period(lane, block)
   end subroutine load_scene

   !> Let a lane rest without a scene: a film at its steady thickness that nothing moves.
   pure subroutine rest_lane(lane, block)
      !> Lane
      integer, intent(in) :: lane
      !> The block
      type(lane_block_t), intent(inout) :: block

      block%film_scale(lane) = 1.0_dp
      block%velocity_scale(lane) = 1.0_dp
      block%force_scale(lane) = 1.0_dp
      block%strength(lane) = 1.0_dp
      block%damping(lane) = 1.0_dp
      block%slip(lane) = 0.0_dp
      block%pressing(lane) = 0.0_dp
      block%load(lane) = 1.0_dp
      block%amplitude(lane) = 0.0_dp
      block%force(lane) = 1.0_dp
      block%accuracy(lane) = 1.0_dp
      block%film(lane, :) = 0.0_dp
      block%momentum(lane, :) = 0.0_dp
      block%film(lane, 0) = 1.0_dp
      block%damping_rate(lane) = 0.0_dp
      call start_period(lane, block)
      ! Far from the end of a period, so that nobody has to look after it.
      block%phase(lane) = -1.0e6_dp
   end subroutine rest_lane

   !> Start of a period: film and momentum alone decide all that follows, nothing else of the period before.
   pure subroutine start_period(lane, block)
      !> Lane
      integer, intent(in) :: lane
      !> The block
      type(lane_block_t), intent(inout) :: block

      block%phase(lane) = 0.0_dp
      block%cosine(lane) = 1.0_dp
      block%sine(lane) = 0.0_dp
      block%remaining(lane) = 1.0_dp
      block%limit(lane) = 1.0_dp
      block%period_steps(lane) = 0.0_dp
      block%proposed(lane) = first_step
      block%last_step(lane) = 0.0_dp
      block%polynomial(lane, :) = 0.0_dp
      block%acceleration(lane) = 0.0_dp
      block%no_load(lane) = .false.
   end subroutine start_period

   !> State of a lane in units.
   pure subroutine state_of_lane(lane, block, film, velocity, momentum)
      !> Lane
      integer, intent(in) :: lane
      !> The block
      type(lane_block_t), intent(in) :: block
      !> h [m]
      real(dp), intent(out) :: film
      !> z' [m/s]
      real(dp), intent(out) :: velocity
      !> Scaled momentum V [-]
      real(dp), intent(out) :: momentum

      film = block%film(lane, 0)*block%film_scale(lane)
      momentum = block%momentum(lane, 0)
      velocity = (momentum + block%slip(lane)/sqrt(block%film(lane, 0)))*block%velocity_scale(lane)
   end subroutine state_of_lane

end module lane_scenes
