!> The list of film laws that have a Taylor series of the motion: of what order, how good it is, its coefficients in a lane, its
!> expansion about the states of a block, and what its steps are checked for at their ends.
!>
!> A law that is not in this list is solved by collocation. To add one: write its series in a file of its own, and add it to every
!> choice here; a choice that has forgotten it rejects the steps.
module film_series
   use constants, only: pi
   use film_law, only: kernel_half_pi, kernel_piezo, kernel_reynolds_iso, kernel_reynolds_piezo, kernel_solved_fast
   use kinds, only: dp
   use lane_block, only: lane_block_t, slip_velocity
   use lane_force, only: force_derivatives, force_values, lane_phase_t, move_forces, turn_to
   use lane_functions, only: lanes
   use load_expansion, only: expand_load, expand_squeeze
   use load_pieces, only: exact_load, load_limit, published_load
   use problem, only: has_damped_teeth, has_elastic_teeth, has_two_flanks, problem_t
   use reynolds_piezo_expansion, only: expand_reynolds_piezo
   use taylor_iso_viscous, only: iso_viscous_series
   use taylor_piezo_viscous, only: piezo_viscous_series, reject_unresolved_growth
   use taylor_reynolds_piezo, only: expand_under_load, film_throughout, reynolds_piezo_series
   use taylor_rupture, only: equation_rounding, reject_large_defect, rupture_order, rupture_series
   use taylor_step_control, only: film_weight, order, rounding, unfollowable_rate
   implicit none(type, external)
   private

   !> Best accuracy of a motion by the cells of the Reynolds piezo-viscous film, whose loads are good to 6e-12.
   real(dp), parameter :: best_cell_accuracy = 1.0e-10_dp

   !> The series of a film law.
   type, public :: film_series_t
      !> Code of the law
      integer :: kernel = 0
      logical :: exists = .false.
      !> Whether it is that of a tooth between two flanks
      logical :: two_flanks = .false.
      !> Whether the teeth are elastic
      logical :: springs = .false.
      !> Whether its films carry positive loads only
      logical :: never_pulls = .false.
      !> Whether its steps are checked against the equation of motion at their ends, where the next expansion begins
      logical :: checked_at_end = .false.
      !> Load that a series with rupture by (18) takes from module load_pieces
      integer :: pieces = exact_load
      !> Order of its last coefficient
      integer :: last_order = order
      !> Share of the accuracy that a step of length x may use up is x times this; found by trial [1/periods]
      real(dp) :: share = 4.0_dp
      !> Relative accuracy of the film below which collocation is used [-]
      real(dp) :: best_accuracy = 0.0_dp
   end type film_series_t

   public :: series_of, has_series, set_coefficients, expand_motion, check_ends, check_springs

contains

   !> The series of a problem.
   elemental type(film_series_t) function series_of(problem) result(series)
      type(problem_t), intent(in) :: problem

      series%kernel = problem%contact%film%kernel
      series%two_flanks = has_two_flanks(problem)
      select case (problem%contact%film%kernel)
      case (kernel_half_pi, kernel_piezo)
         series%exists = .true.
      case (kernel_solved_fast, kernel_reynolds_iso)
         series%exists = .true.
         series%checked_at_end = .true.
         series%last_order = rupture_order
         series%share = 8.0_dp
         if (problem%contact%film%kernel == kernel_solved_fast) series%pieces = published_load
      case (kernel_reynolds_piezo)
         series%exists = .true.
         series%checked_at_end = .true.
         series%last_order = rupture_order
         ! Its long steps add up their errors where nothing damps.
         series%share = 2.0_dp
         series%best_accuracy = best_cell_accuracy
      case default
         series%exists = .false.
      end select
      series%never_pulls = problem%contact%film%kernel == kernel_piezo
      series%springs = has_elastic_teeth(problem)
      ! The velocity of a film beside a damped tooth is no function of its load alone.
      if (has_damped_teeth(problem)) series%exists = .false.
   end function series_of

   !> Whether a problem has a Taylor series that is good enough.
   elemental logical function has_series(problem, accuracy)
      type(problem_t), intent(in) :: problem
      !> Relative accuracy of the film that is requested [-]
      real(dp), intent(in) :: accuracy
      type(film_series_t) :: series

      series = series_of(problem)
      has_series = series%exists .and. accuracy >= series%best_accuracy
   end function has_series

   !> Scaled coefficients of the film in a lane that holds its motion, and the Lienard variable by which the series goes on.
   pure subroutine set_coefficients(problem, carried_on, lane, block)
      type(problem_t), intent(in) :: problem
      !> Whether the motion brings its Lienard variable along
      logical, intent(in) :: carried_on
      integer, intent(in) :: lane
      type(lane_block_t), intent(inout) :: block

      associate (film => problem%contact%film, film_scale => block%film_scale(lane), velocity_scale => block%velocity_scale(lane), &
                 force_scale => block%force_scale(lane))
         select case (film%kernel)
         case (kernel_half_pi)
            block%strength(lane) = film%rolling/film_scale/force_scale
            block%damping(lane) = 2.0_dp*pi*film%squeeze/sqrt(film_scale)*problem%frequency/force_scale
            ! Lienard's form, which elastic teeth do not take.
            if (.not. has_elastic_teeth(problem)) block%slip(lane) = block%damping(lane)
            if (.not. carried_on) block%lienard(lane, 0) = block%lienard(lane, 0) - slip_velocity(block%film(lane, 0), lane, block)
         case (kernel_solved_fast)
            block%strength(lane) = film%rolling/film_scale/force_scale
            block%damping(lane) = film%squeeze_rate*velocity_scale/sqrt(film_scale)
         case (kernel_piezo)
            block%strength(lane) = film%piezo/(film_scale**3*sqrt(film_scale))/force_scale
            block%damping(lane) = film%rate*velocity_scale
         case (kernel_reynolds_iso, kernel_reynolds_piezo)
            block%strength(lane) = film%scale/film_scale/force_scale
            block%damping(lane) = film%squeeze_rate*velocity_scale/sqrt(film_scale)
            block%pressing(lane) = film%pressure_rate/(film_scale*sqrt(film_scale))
         case default
            block%strength(lane) = 0.0_dp
         end select
      end associate
   end subroutine set_coefficients

   !> Series about the states of a block: film and Lienard variable, of elastic teeth both films and compressions too. A law without
   !> one has a damping rate that no step follows.
   pure subroutine expand_motion(series, block)
      type(film_series_t), intent(in) :: series
      type(lane_block_t), intent(inout) :: block
      real(dp) :: force(lanes, order)

      call force_derivatives(series%last_order, block%oscillation, force)
      if (series%springs) call expand_films(series, block)
      select case (series%kernel)
      case (kernel_piezo)
         call piezo_viscous_series(series%springs, series%two_flanks, force, block)
      case (kernel_half_pi)
         call iso_viscous_series(series%springs, series%two_flanks, force, block)
      case (kernel_reynolds_piezo)
         call reynolds_piezo_series(series%springs, series%two_flanks, force, block)
      case (kernel_solved_fast, kernel_reynolds_iso)
         call rupture_series(series%pieces, series%springs, series%two_flanks, force, block)
      case default
         block%film(:, 1:) = 0.0_dp
         block%films(:, 1:, :) = 0.0_dp
         block%lienard(:, 1:) = 0.0_dp
         block%compression(:, :, 1:) = 0.0_dp
         block%damping_rate = unfollowable_rate
      end select
      if (.not. series%springs) return
      block%film(:, 1:series%last_order) = block%films(:, 1:series%last_order, 1)
      ! The sums over all orders take no more than there are.
      block%film(:, series%last_order + 1:) = 0.0_dp
      block%lienard(:, series%last_order + 1:) = 0.0_dp
   end subroutine expand_motion

   !> Films of elastic teeth where a step begins: that of the coast flank is what backlash, drive film and springs leave. Films with
   !> rupture are expanded under the loads of their springs.
   pure subroutine expand_films(series, block)
      type(film_series_t), intent(in) :: series
      type(lane_block_t), intent(inout) :: block
      integer :: flank

      block%films(:, 0, 1) = block%film(:, 0)
      if (series%two_flanks) then
         block%films(:, 0, 2) = block%backlash - block%film(:, 0) + (block%compression(:, 1, 0) + block%compression(:, 2, 0))
         ! A lane that rests has no backlash.
         block%films(:, 0, 2) = merge(block%films(:, 0, 2), 1.0_dp, block%backlash < huge(1.0_dp))
      end if
      if (.not. series%checked_at_end) return
      block%damping_rate = 0.0_dp
      do flank = 1, merge(2, 1, series%two_flanks)
         call expand_under_spring(series, flank, block%films(:, 0, flank), &
                                  load_group(series, block%films(:, 0, flank), block%compression(:, flank, 0), block), &
                                  (block%piezo_expansion(flank)%lienard), block)
         block%damping_rate = merge(block%damping_rate, unfollowable_rate, block%squeeze(flank)%inside > 0.0_dp)
      end do
   end subroutine expand_films

   !> Expand a film with rupture under the load of its spring.
   pure subroutine expand_under_spring(series, flank, film, group, near, block)
      type(film_series_t), intent(in) :: series
      integer, intent(in) :: flank
      !> Film, its load group, and what its velocity is likely to be [-]
      real(dp), intent(in) :: film(lanes)
      real(dp), intent(in) :: group(lanes)
      real(dp), intent(in) :: near(lanes)
      type(lane_block_t), intent(inout) :: block

      if (series%kernel == kernel_reynolds_piezo) then
         call expand_under_load(film, group, near, series%share*block%accuracy, block%damping, block%pressing, &
                                block%squeeze(flank), block%piezo_expansion(flank))
      else
         call expand_squeeze(series%pieces, group, block%squeeze(flank))
      end if
   end subroutine expand_under_spring

   !> Load group W H/a of films with rupture under their springs, less its limit on separation [-].
   pure function load_group(series, film, compression, block) result(group)
      type(film_series_t), intent(in) :: series
      !> Film and its spring [-]
      real(dp), intent(in) :: film(lanes)
      real(dp), intent(in) :: compression(lanes)
      type(lane_block_t), intent(in) :: block
      real(dp) :: group(lanes)
      integer :: l

      !$omp simd
      do l = 1, lanes
         group(l) = compression(l)*film(l)/(block%compliance(l)*block%strength(l)) - load_limit(series%pieces)
      end do
   end function load_group

   !> Reject the steps of elastic teeth at whose end the series violates the film law. The squeeze group is expanded there, for the
   !> next step to begin with. The defect D of a film's velocity is that of the first terms left out, so D x/(n + 1) estimates the
   !> local error of the film: it must not exceed what the step control grants the last term.
   pure subroutine check_springs(series, next_films, block)
      type(film_series_t), intent(in) :: series
      !> H and C at the end of the step [-]
      real(dp), intent(in) :: next_films(lanes, 2)
      type(lane_block_t), intent(inout) :: block
      real(dp), dimension(lanes) :: place, start, rise, thinner, velocity, disturbance
      real(dp) :: defect, granted
      integer :: flank, k, l

      if (.not. series%checked_at_end) return
      thinner = next_films(:, 1)
      if (series%two_flanks) thinner = min(thinner, next_films(:, 2))
      do flank = 1, merge(2, 1, series%two_flanks)
         start = load_group(series, block%films(:, 0, flank), block%compression(:, flank, 0), block)
         place = load_group(series, next_films(:, flank), block%next_compression(:, flank), block)
         place = merge(place, start, block%accepted > 0.0_dp)
         rise = real(series%last_order, dp)*block%films(:, series%last_order, flank)
         do k = series%last_order - 1, 1, -1
            rise = rise*block%step + real(k, dp)*block%films(:, k, flank)
         end do
         if (series%kernel == kernel_reynolds_piezo) &
            block%accepted = block%accepted*film_throughout(block%piezo_expansion(flank)%sigma_series, block%step)
         call expand_under_spring(series, flank, merge(next_films(:, flank), block%films(:, 0, flank), block%accepted > 0.0_dp), &
                                  place, rise, block)
         ! What rounding of the load may move the velocity by
         if (series%kernel == kernel_reynolds_piezo) then
            associate (there => block%piezo_expansion(flank))
               velocity = there%lienard
               disturbance = (abs(there%group) + abs(place/there%load_slope))*there%film*there%root/block%damping
            end associate
         else
            associate (there => block%squeeze(flank))
               velocity = sqrt(max(next_films(:, flank), 0.0_dp))/block%damping
               disturbance = velocity*(abs(there%terms(:, 0)) + abs(there%terms(:, 1))*there%inverse_unit* &
                                       (place + load_limit(series%pieces)))
               velocity = velocity*there%terms(:, 0)
            end associate
         end if
         !$omp simd private(defect, granted)
         do l = 1, lanes
            defect = abs(velocity(l) - rise(l)) - equation_rounding*disturbance(l)
            granted = (real(series%last_order + 1, dp)*series%share) &
               *max(block%accuracy(l)*film_weight(thinner(l)), rounding*next_films(l, flank))
            block%accepted(l) = block%accepted(l)*block%squeeze(flank)%inside(l)*merge(1.0_dp, 0.0_dp, defect <= granted)
         end do
      end do
   end subroutine check_springs

   !> Reject the steps at whose end the series does not hold.
   pure subroutine check_ends(series, rise, block)
      type(film_series_t), intent(in) :: series
      !> V' at the ends by the series, where they are compared with the equation of motion [-]
      real(dp), intent(in) :: rise(lanes)
      type(lane_block_t), intent(inout) :: block

      select case (series%kernel)
      case (kernel_half_pi)
         ! Its load is smooth: the last terms show the error.
      case (kernel_piezo)
         call reject_unresolved_growth(block%film(:, 0), block%lienard(:, 0), block%next_film, block%next_lienard, block)
         if (series%two_flanks) call reject_unresolved_growth(block%backlash - block%film(:, 0), -block%lienard(:, 0), &
                                                              block%backlash - block%next_film, -block%next_lienard, block)
      case (kernel_solved_fast, kernel_reynolds_iso, kernel_reynolds_piezo)
         call check_forces(series, rise, block)
      case default
         block%accepted = 0.0_dp
      end select
   end subroutine check_ends

   !> Hold the ends of steps against the equation of motion. The load is expanded there, for the next step to begin with; where a
   !> step is rejected, it is expanded at its start again.
   pure subroutine check_forces(series, rise, block)
      type(film_series_t), intent(in) :: series
      !> V' at the ends by the series [-]
      real(dp), intent(in) :: rise(lanes)
      type(lane_block_t), intent(inout) :: block
      real(dp), dimension(lanes) :: phase, film, lienard, thinner, carried, largest, rate_of_damping
      type(lane_phase_t) :: circle

      carried = 0.0_dp
      largest = 0.0_dp
      rate_of_damping = 0.0_dp
      phase = block%phase + block%step
      call turn_to(phase, circle)
      film = merge(block%next_film, block%film(:, 0), block%accepted > 0.0_dp)
      lienard = merge(block%next_lienard, block%lienard(:, 0), block%accepted > 0.0_dp)
      thinner = film
      call load_at_end(series, 1, film, lienard, block, carried, largest, rate_of_damping)
      if (series%two_flanks) then
         thinner = min(film, block%backlash - film)
         call load_at_end(series, 2, block%backlash - film, -lienard, block, carried, largest, rate_of_damping)
      end if
      call reject_large_defect(series%share, block%static_load + force_values(block%oscillation, circle), carried, largest, &
                               rate_of_damping, thinner, lienard, rise, block)
      call move_forces(circle, block%accepted, block%oscillation)
   end subroutine check_forces

   !> Expand the load of one film at the ends of steps, and add it to what is carried.
   pure subroutine load_at_end(series, flank, film, lienard, block, carried, largest, rate_of_damping)
      type(film_series_t), intent(in) :: series
      !> 1 drive, 2 coast, whose load is subtracted
      integer, intent(in) :: flank
      !> Of the film [-]
      real(dp), intent(in) :: film(lanes)
      real(dp), intent(in) :: lienard(lanes)
      type(lane_block_t), intent(inout) :: block
      !> Net load, sum of the loads of all films, -dV'/dV of the films so far [-]
      real(dp), intent(inout) :: carried(lanes)
      real(dp), intent(inout) :: largest(lanes)
      real(dp), intent(inout) :: rate_of_damping(lanes)

      if (series%kernel == kernel_reynolds_piezo) then
         associate (there => block%piezo_expansion(flank))
            call expand_reynolds_piezo(film, lienard, block%damping, block%pressing, there)
            block%accepted = block%accepted*there%inside
            call add_load(there%inverse_film, there%root, there%terms(:, 0), there%load_slope, carried, largest, rate_of_damping)
         end associate
      else
         associate (there => block%expansion(flank))
            call expand_load(series%pieces, film, lienard, block%damping, there)
            call add_load(there%inverse_film, there%root, there%terms(:, 0), there%load_slope, carried, largest, rate_of_damping)
         end associate
      end if

   contains

      !> Add a load and its damping rate.
      pure subroutine add_load(inverse_film, root, group, slope, net, total, rate)
         !> p, r, Phi and dPhi/dA [-]
         real(dp), intent(in) :: inverse_film(lanes)
         real(dp), intent(in) :: root(lanes)
         real(dp), intent(in) :: group(lanes)
         real(dp), intent(in) :: slope(lanes)
         !> carried, largest and rate_of_damping
         real(dp), intent(inout) :: net(lanes)
         real(dp), intent(inout) :: total(lanes)
         real(dp), intent(inout) :: rate(lanes)
         real(dp) :: load, damping
         integer :: l

         !$omp simd private(load, damping)
         do l = 1, lanes
            load = block%strength(l)*inverse_film(l)*group(l)
            damping = -block%strength(l)*inverse_film(l)*block%damping(l)*root(l)*slope(l)
            net(l) = net(l) + merge(load, -load, flank == 1)
            total(l) = total(l) + abs(load)
            rate(l) = rate(l) + damping
         end do
      end subroutine add_load

   end subroutine load_at_end

end module film_series
