!> A block of lanes, one motion a lane: their scaled coefficients and states.
!>
!> Time is counted in periods of the force, x = f_exc t, within a period from 0 to 1, so the phase is as exact after hundreds of
!> periods as in the first. The film is scaled by the power of two next to the reference film: scaling costs no digit, and a motion
!> carried on from the state of its ending goes on as if never stopped.
module lane_block
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use, intrinsic :: iso_c_binding, only: c_f_pointer, c_ptr
   use engine, only: motion_state_t
   use film_law, only: overflow_load
   use force, only: force_t, largest_oscillation
   use kinds, only: dp
   use lane_force, only: lane_force_t, no_forces, set_force, start_force
   use lane_functions, only: lanes
   use load_expansion, only: load_expansion_t, squeeze_expansion_t
   use memory, only: allocate_lines
   use carried_loads, only: net_loads
   use problem, only: compression_count, contact_count, has_elastic_teeth, has_two_flanks, of_drive_compression, of_film, &
      of_velocity, problem_t, reference_film, reference_films, settling_of, settling_t, static_load, thinner_film
   use radau_nodes, only: stages
   use reynolds_piezo_expansion, only: reynolds_piezo_expansion_t
   use scene_status, only: status_complete, status_film_lost, status_overflow
   use scene_types, only: least_static_load
   use taylor_step_control, only: order
   implicit none(type, external)
   private

   !> Scenes of a block, lane by lane.
   type, public :: lane_block_t
      !> Load coefficient and damping of the film law, and static load, all scaled
      real(dp) :: strength(lanes), damping(lanes), static_load(lanes)
      !> Force that errors of the load are compared with, q + f
      real(dp) :: force(lanes)
      !> What counts as 1: film [m], velocity [m/s], force [N]
      real(dp) :: film_scale(lanes), velocity_scale(lanes), force_scale(lanes)
      !> Backlash, scaled; huge where there is one flank
      real(dp) :: backlash(lanes)
      !> Film of the drive flank at which that of the coast flank counts as lost; huge where there is none, or of elastic teeth
      real(dp) :: widest_film(lanes)
      !> Of elastic teeth: series of both films H and C
      real(dp) :: films(lanes, 0:order, 2)
      !> and compliance, scaled; series of the compressions d_1 and d_2, behind those of one or two flanks the deflections of damped
      !> teeth
      real(dp) :: compliance(lanes), compression(lanes, 4, 0:order)
      !> and of damped teeth tau [periods] and their share of the compliance; 0: not damped
      real(dp) :: retardation(lanes), damped_share(lanes)
      !> and of collocation, polynomials of both loads in the last step, as they count there (module elastic_trial)
      real(dp) :: load_polynomial(lanes, stages, 2)
      !> and the compressions that the step leads to, and the film of a coast flank that bends where the last step ended, near which
      !> the next one looks for it; 0: not known
      real(dp) :: next_compression(lanes, 4), coast_film(lanes)
      !> Accuracy [-]
      real(dp) :: accuracy(lanes)
      !> Series of H and of V, Lienard's variable or the velocity; coefficients 0 are the state
      real(dp) :: film(lanes, 0:order), lienard(lanes, 0:order)
      !> Phase of the state, next step, what is left of the period, longest step allowed [periods]
      real(dp) :: phase(lanes), step(lanes), remaining(lanes), limit(lanes)
      !> State that the step leads to, and whether the step is accepted (1) or not (0)
      real(dp) :: next_film(lanes), next_lienard(lanes), accepted(lanes)
      !> H' = V + slip (1/sqrt(H) - 1/sqrt(B - H)): 2 b in Lienard's form, 0 where V is H' itself
      real(dp) :: slip(lanes)
      !> Damping rate at the state [1/periods]
      real(dp) :: damping_rate(lanes)
      !> Of elastic teeth: fastest rate at which a film and its spring come to rest [1/periods]
      real(dp) :: rest_rate(lanes)
      !> Collocation: next step proposed, last step taken [periods], polynomial of the acceleration in that
      !> step, and whether the last try met a film that has no load
      real(dp) :: proposed(lanes), last_step(lanes), polynomial(lanes, stages)
      !> H'' at the start of the step
      real(dp) :: acceleration(lanes)
      logical :: no_load(lanes)
      !> Steps of this period
      real(dp) :: period_steps(lanes)
      !> Of films with rupture: the load expanded last, of both flanks
      type(load_expansion_t) :: expansion(2)
      !> and of elastic teeth the squeeze groups
      type(squeeze_expansion_t) :: squeeze(2)
      !> Of the Reynolds piezo-viscous film: b, where the pressure group is b H^(-3/2), and its load expanded last
      real(dp) :: pressing(lanes)
      type(reynolds_piezo_expansion_t) :: piezo_expansion(2)
      !> Force that oscillates, scaled
      type(lane_force_t) :: oscillation
   end type lane_block_t

   !> Force of a lane without a scene
   type(force_t), parameter :: no_force = force_t()

   !> First step of a period by collocation [periods]
   real(dp), parameter :: first_step = 1.0_dp/64.0_dp

   !> Scaled film that counts as lost [-]
   real(dp), parameter, public :: lost_film = 1.0e-9_dp

   public :: place_block, load_problem, rest_lane, start_period, slip_velocity, start_status, lane_accuracy, &
             given_way

contains

   !> Accuracy to which the periods of a motion are solved [-]. Where the film settles slowly, the errors of many periods add up
   !> before they are forgotten.
   elemental real(dp) function lane_accuracy(problem, accuracy)
      type(problem_t), intent(in) :: problem
      !> Relative accuracy of the film that is requested [-]
      real(dp), intent(in) :: accuracy
      !> No step is better than rounding
      real(dp), parameter :: best_accuracy = 1.0e-13_dp
      type(settling_t) :: settling
      real(dp) :: films(2)

      lane_accuracy = accuracy
      films = reference_films(problem)
      if (.not. (films(1) > 0.0_dp .and. ieee_is_finite(films(1)))) return
      settling = settling_of(problem, films, films)
      lane_accuracy = min(accuracy, max(accuracy*settling%rate, best_accuracy))
   end function lane_accuracy

   !> Whether the motion can start: `status_complete`, or why not.
   elemental integer function start_status(problem, start)
      type(problem_t), intent(in) :: problem
      !> Where it starts
      type(motion_state_t), intent(in) :: start
      real(dp) :: load(1)

      start_status = status_film_lost
      if (.not. all(ieee_is_finite(start%numbers))) return
      if (.not. abs(start%numbers(of_film)) > 0.0_dp) then
         ! Without a film to start from there never was one to lose.
         start_status = problem%contact%film%status_without_load
         return
      end if
      if (has_elastic_teeth(problem)) then
         if (start%numbers(of_film) <= 0.0_dp) return
         start_status = merge(status_complete, status_overflow, &
                              maxval(abs(start%numbers(of_drive_compression:of_velocity + contact_count(problem)))) &
                              < overflow_load*problem%contact%compliance)
         return
      end if
      if (thinner_film(problem, start%numbers(of_film)) <= 0.0_dp) return
      call net_loads(problem, reshape(start%numbers, [1, size(start%numbers)]), load)
      start_status = merge(status_complete, status_overflow, abs(load(1)) < overflow_load)
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
      block%squeeze = squeeze_expansion_t()
      block%piezo_expansion = reynolds_piezo_expansion_t()
      call no_forces(block%oscillation)
   end subroutine place_block

   !> Put a motion into a lane, at the start of its first period.
   pure subroutine load_problem(problem, start, accuracy, lane, block)
      type(problem_t), intent(in) :: problem
      !> Where it starts
      type(motion_state_t), intent(in) :: start
      !> Relative accuracy of the film [-]
      real(dp), intent(in) :: accuracy
      integer, intent(in) :: lane
      type(lane_block_t), intent(inout) :: block
      real(dp) :: force_scale, film_scale
      integer :: springs

      call rest_lane(lane, block)
      film_scale = 2.0_dp**nint(log(reference_film(problem))/log(2.0_dp))
      force_scale = problem%mass*film_scale*problem%frequency**2
      block%film_scale(lane) = film_scale
      if (has_two_flanks(problem)) block%backlash(lane) = problem%backlash/film_scale
      if (has_two_flanks(problem) .and. .not. has_elastic_teeth(problem)) block%widest_film(lane) = block%backlash(lane) - lost_film
      block%velocity_scale(lane) = film_scale*problem%frequency
      block%force_scale(lane) = force_scale
      block%static_load(lane) = static_load(problem)/force_scale
      call set_force(problem%force, force_scale, lane, block%oscillation)
      block%force(lane) = abs(block%static_load(lane)) + largest_oscillation(problem%force)/force_scale
      if (has_two_flanks(problem)) block%force(lane) = max(block%force(lane), least_static_load/force_scale)
      block%accuracy(lane) = lane_accuracy(problem, accuracy)
      block%film(lane, 0) = start%numbers(of_film)/film_scale
      block%lienard(lane, 0) = start%numbers(of_velocity)/block%velocity_scale(lane)
      if (start%carried_on) block%lienard(lane, 0) = start%lienard_variable
      block%compliance(lane) = problem%contact%compliance*(force_scale/film_scale)
      block%retardation(lane) = problem%contact%retardation*problem%frequency
      block%damped_share(lane) = problem%contact%damped_share
      block%compression(lane, :, 0) = 0.0_dp
      springs = compression_count(problem)
      block%compression(lane, :springs, 0) = start%numbers(of_drive_compression:of_velocity + springs)/film_scale
      block%next_compression(lane, :) = 0.0_dp
      call start_period(lane, block)
   end subroutine load_problem

   !> Let a lane rest without a motion: a film at its steady thickness that nothing moves.
   pure subroutine rest_lane(lane, block)
      integer, intent(in) :: lane
      type(lane_block_t), intent(inout) :: block

      block%film_scale(lane) = 1.0_dp
      block%backlash(lane) = huge(1.0_dp)
      block%widest_film(lane) = huge(1.0_dp)
      block%velocity_scale(lane) = 1.0_dp
      block%force_scale(lane) = 1.0_dp
      block%strength(lane) = 1.0_dp
      block%damping(lane) = 1.0_dp
      block%slip(lane) = 0.0_dp
      block%pressing(lane) = 0.0_dp
      block%static_load(lane) = 1.0_dp
      call set_force(no_force, 1.0_dp, lane, block%oscillation)
      block%force(lane) = 1.0_dp
      block%accuracy(lane) = 1.0_dp
      block%film(lane, :) = 0.0_dp
      block%lienard(lane, :) = 0.0_dp
      block%film(lane, 0) = 1.0_dp
      block%damping_rate(lane) = 0.0_dp
      block%rest_rate(lane) = 0.0_dp
      block%retardation(lane) = 0.0_dp
      block%damped_share(lane) = 0.0_dp
      block%compliance(lane) = 0.0_dp
      call start_period(lane, block)
      ! Springs that carry the static load
      block%compliance(lane) = 1.0_dp
      block%compression(lane, :, :) = 0.0_dp
      block%compression(lane, :, 0) = 1.0_dp
      block%next_compression(lane, :) = 0.0_dp
      ! Far from the end of a period, so that it never ends one.
      block%phase(lane) = -1.0e6_dp
   end subroutine rest_lane

   !> Start of a period: film and Lienard variable alone decide all that follows, nothing else of the period before.
   pure subroutine start_period(lane, block)
      integer, intent(in) :: lane
      type(lane_block_t), intent(inout) :: block

      block%phase(lane) = 0.0_dp
      call start_force(lane, block%oscillation)
      block%remaining(lane) = 1.0_dp
      block%limit(lane) = 1.0_dp
      block%period_steps(lane) = 0.0_dp
      block%proposed(lane) = first_step
      block%last_step(lane) = 0.0_dp
      block%polynomial(lane, :) = 0.0_dp
      block%acceleration(lane) = 0.0_dp
      block%no_load(lane) = .false.
      block%coast_film(lane) = 0.0_dp
      ! The velocity of a film on a spring is found by Newton's method: from that of the gear, not from where the last period ended.
      if (.not. block%compliance(lane) > 0.0_dp) return
      block%piezo_expansion(:)%film(lane) = 0.0_dp
      block%piezo_expansion(1)%lienard(lane) = block%lienard(lane, 0)
      block%piezo_expansion(2)%lienard(lane) = -block%lienard(lane, 0)
   end subroutine start_period

   !> By how much both contacts together stand compressed, but for what follows their width [-].
   pure real(dp) function given_way(compressions, lane, block)
      !> d_1 and d_2, and of damped teeth D_1 and D_2 [-]
      real(dp), intent(in) :: compressions(:)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block

      if (block%retardation(lane) > 0.0_dp) then
         given_way = (1.0_dp - block%damped_share(lane))*sum(compressions(:2)) + sum(compressions(3:4))
      else
         given_way = sum(compressions(:2))
      end if
   end function given_way

   !> H' less V at some film.
   pure real(dp) function slip_velocity(film, lane, block)
      !> H [-]
      real(dp), intent(in) :: film
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block

      slip_velocity = block%slip(lane)/sqrt(film)
      if (block%slip(lane) > 0.0_dp .and. block%backlash(lane) < huge(1.0_dp)) &
         slip_velocity = slip_velocity - block%slip(lane)/sqrt(block%backlash(lane) - film)
   end function slip_velocity

end module lane_block
