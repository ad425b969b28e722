!> The periodic motion next to a motion in nodes of pressure, and its Floquet multipliers.
!>
!> Two neighbours (module nodal_tangent) are followed through a period first, so that their pressures are those that belong to their
!> gears; then their positions and velocities at both ends of the next one, X(end) = J X(start), give the two multipliers that count
!> (fsrc/THEORY.md, section 10).
module nodal_orbit
   use constants, only: two_pi
   use engine, only: ending_t
   use kinds, only: dp
   use linear_equations, only: eigenvalues, solve_linear
   use nodal_engine, only: add_step
   use nodal_film, only: smallest_film
   use nodal_state, only: unpack_motion
   use nodal_step, only: begin_period, distance_of_states, gear_t, is_late, most_steps, motion_t, nodal_choice_t, set_up, &
      state_of, take_step
   use nodal_tangent, only: combine, displace, neighbours, nodal_tangent_t, start_tangent
   use periodic_orbit, only: longest_period, periodic_orbit_t
   use problem, only: of_velocity, problem_t
   use scene_status, only: status_complete, status_film_cycles
   use signals, only: must_stop
   use step_nodes, only: step_nodes_t
   use window_record, only: record_period, window_record_t
   implicit none(type, external)
   private

   !> Tolerance of the steps over that of the motion, and the least one: the correction of Newton's iterations is 1e-7
   real(dp), parameter :: tighter = 0.1_dp, least_tolerance = 1.0e-5_dp
   !> Correction with which a periodic motion is found, over the tolerance of the steps
   real(dp), parameter :: converged = 2.0_dp
   !> Share by which the multipliers of two periods running may differ, of themselves and of one
   real(dp), parameter :: same_share = 0.01_dp, same_rest = 1.0e-4_dp
   !> Periods of the motion until then
   integer, parameter :: most_rounds = 12

   !> Outcome of the search for a periodic motion next to another motion: none requested, it was found, or why it was not.
   integer, parameter, public :: orbit_not_requested = 0, orbit_found = 1, orbit_none_near = 2, orbit_not_followed = 3, &
                                 orbit_not_settled = 4, orbit_out_of_time = 5

   public :: find_nodal_orbit, follow_period, orbit_sentence, state_of_neighbours

contains

   !> Look for a periodic motion near the end of a motion, from period 1 on.
   subroutine find_nodal_orbit(problem, choice, numbers, nearness, orbit, outcome)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> How it was followed
      type(nodal_choice_t), intent(in) :: choice
      !> Where it ended, as of pack_motion
      real(dp), intent(in) :: numbers(:)
      !> Distance at which a periodic motion is another one [-]
      real(dp), intent(in) :: nearness
      type(periodic_orbit_t), intent(out) :: orbit
      !> One of those above
      integer, intent(out) :: outcome
      type(nodal_choice_t) :: tight
      type(gear_t) :: gear
      type(motion_t) :: start, motion
      type(ending_t) :: ending
      integer :: period

      tight = choice
      tight%tolerance = min(choice%tolerance, max(tighter*choice%tolerance, least_tolerance))
      call set_up(problem, tight, gear)
      call unpack_motion(problem, choice%nodes, numbers, start)
      outcome = orbit_none_near
      motion = start
      do period = 1, longest_period
         if (is_late(choice)) outcome = orbit_out_of_time
         if (outcome == orbit_out_of_time .or. must_stop()) return
         call follow_period(gear, motion, ending)
         if (ending%status /= status_complete) then
            outcome = orbit_not_followed
            return
         end if
         if (distance_of_states(gear, start, motion%states(1, :), start%states(1, :)) > nearness) cycle
         call newton(gear, period, start, nearness, orbit, outcome)
         if (outcome == orbit_found) return
      end do
   end subroutine find_nodal_orbit

   !> Why there are no Floquet multipliers, nothing where there are some or none were requested.
   pure function orbit_sentence(outcome) result(sentence)
      !> One of those above
      integer, intent(in) :: outcome
      character(:), allocatable :: sentence

      select case (outcome)
      case (orbit_none_near)
         sentence = 'no Floquet multipliers: no periodic motion is found near the end of the run'
      case (orbit_not_followed)
         sentence = 'no Floquet multipliers: neighbours of the motion cannot be followed for a period'
      case (orbit_out_of_time)
         sentence = 'no Floquet multipliers: solver.time_limit was over before a periodic motion was found'
      case (orbit_not_settled)
         sentence = 'no Floquet multipliers: those of successive periods differ by more than 1 %'
      case default
         sentence = ''
      end select
   end function orbit_sentence

   !> Newton's method on the map of some periods.
   subroutine newton(gear, period, start, nearness, orbit, outcome)
      type(gear_t), intent(in) :: gear
      integer, intent(in) :: period
      !> Where it begins
      type(motion_t), intent(in) :: start
      !> Distance from there at which a periodic motion is another one [-]
      real(dp), intent(in) :: nearness
      type(periodic_orbit_t), intent(out) :: orbit
      integer, intent(out) :: outcome
      type(motion_t) :: motion
      type(nodal_tangent_t) :: tangent
      type(ending_t) :: ending
      real(dp), dimension(neighbours, neighbours) :: before, after, map
      real(dp) :: left(neighbours, 1), first(neighbours), ended(size(start%states, 2)), moved
      complex(dp), allocatable :: multipliers(:), earlier(:)
      integer :: round, i
      logical :: solved

      motion = start
      call start_tangent(gear%contact, motion%flanks(:gear%flanks), motion%time*gear%period, tangent)
      allocate (earlier(0), multipliers(0))
      do round = 0, most_rounds
         before = state_of_neighbours(gear, tangent)
         first = [motion%position(1), motion%velocity(1)]
         do i = 1, period
            outcome = orbit_out_of_time
            if (is_late(gear%choice)) return
            outcome = orbit_not_followed
            if (must_stop()) return
            call follow_period(gear, motion, ending, tangent)
            if (ending%status /= status_complete .or. .not. tangent%exists) return
         end do
         after = state_of_neighbours(gear, tangent)
         outcome = orbit_not_settled
         ! The first period brings the pressures of the neighbours to their gears.
         if (round > 0) then
            call solve_from_right(after, before, map, solved)
            if (.not. solved) return
            multipliers = eigenvalues(map)
            if (size(multipliers) == 0) return
            left(:, 1) = ([motion%position(1), motion%velocity(1)] - first)/units_of(gear)
            call solve_linear(before - after, left, solved)
            if (.not. solved) return
            ended = motion%states(1, :)
            call move_to(gear, tangent, left(:, 1), motion)
            moved = distance_of_states(gear, motion, motion%states(1, :), ended)
            orbit%distance = distance_of_states(gear, motion, motion%states(1, :), start%states(1, :))
            if (max(moved, orbit%distance) > nearness) outcome = orbit_none_near
            if (outcome == orbit_none_near) return
            if (moved <= converged*gear%choice%tolerance .and. are_same(multipliers, earlier)) then
               orbit%period = period
               orbit%state = motion%states(1, :)
               orbit%multipliers = multipliers
               outcome = orbit_found
               return
            end if
            earlier = multipliers
         end if
         call renew(after, tangent, solved)
         if (.not. solved) return
      end do
   end subroutine newton

   !> Whether two lists of multipliers are the same within the errors of the steps.
   pure logical function are_same(some, others)
      complex(dp), intent(in) :: some(:)
      complex(dp), intent(in) :: others(:)

      are_same = size(some) == size(others)
      if (are_same) are_same = all(abs(some - others) <= same_share*abs(some) + same_rest)
   end function are_same

   !> J of X(end) = J X(start).
   pure subroutine solve_from_right(after, before, map, solved)
      real(dp), intent(in) :: after(:, :)
      real(dp), intent(in) :: before(:, :)
      real(dp), intent(out) :: map(:, :)
      logical, intent(out) :: solved
      real(dp) :: solution(size(after, 2), size(after, 1))

      solution = transpose(after)
      call solve_linear(transpose(before), solution, solved)
      map = transpose(solution)
   end subroutine solve_from_right

   !> Neighbours whose positions and velocities are a unit each.
   pure subroutine renew(state, tangent, solved)
      !> Of both neighbours: number, neighbour
      real(dp), intent(in) :: state(:, :)
      type(nodal_tangent_t), intent(inout) :: tangent
      logical, intent(out) :: solved
      real(dp) :: inverse(neighbours, neighbours)

      inverse = reshape([1.0_dp, 0.0_dp, 0.0_dp, 1.0_dp], [neighbours, neighbours])
      call solve_linear(state, inverse, solved)
      if (solved) call combine(inverse, tangent)
   end subroutine renew

   !> Units of positions and velocities: those of a free gear.
   pure function units_of(gear) result(units)
      type(gear_t), intent(in) :: gear
      real(dp) :: units(2)

      units = gear%free_velocity*[gear%period/two_pi, 1.0_dp]
   end function units_of

   !> Position and velocity of each neighbour at present, from those of the motion: number, neighbour.
   pure function state_of_neighbours(gear, tangent) result(state)
      type(gear_t), intent(in) :: gear
      type(nodal_tangent_t), intent(in) :: tangent
      real(dp) :: state(2, neighbours)
      real(dp) :: units(2)

      units = units_of(gear)
      state(1, :) = tangent%position(1, :)/units(1)
      state(2, :) = tangent%velocity(1, :)/units(2)
   end function state_of_neighbours

   !> Let a motion go on as a combination of its neighbours.
   pure subroutine move_to(gear, tangent, shares, motion)
      type(gear_t), intent(in) :: gear
      type(nodal_tangent_t), intent(in) :: tangent
      real(dp), intent(in) :: shares(neighbours)
      type(motion_t), intent(inout) :: motion
      integer :: flank

      motion%position(1:) = motion%position(1:) + matmul(tangent%position(1:, :), shares)
      motion%velocity(1:) = motion%velocity(1:) + matmul(tangent%velocity(1:, :), shares)
      do flank = 1, gear%flanks
         associate (film => motion%flanks(flank))
            call displace(gear%contact, shares, tangent%flanks(flank), film)
            if (film%in_nodes) film%film(1) = smallest_film(gear%contact%grid, film%gap(1), film%pressures(:, 1))
         end associate
      end do
      motion%states(1, :) = state_of(gear, motion, 1)
   end subroutine move_to

   !> A period, with neighbours or without; it is added to a record, if there is one.
   subroutine follow_period(gear, motion, ending, tangent, record)
      type(gear_t), intent(in) :: gear
      type(motion_t), intent(inout) :: motion
      type(ending_t), intent(out) :: ending
      type(nodal_tangent_t), intent(inout), optional :: tangent
      type(window_record_t), intent(inout), optional :: record
      type(step_nodes_t) :: nodes

      do while (motion%time(1) < 1.0_dp)
         call take_step(gear, motion, ending, tangent)
         ending%count%steps = ending%count%steps + 1
         if (ending%count%steps > most_steps) ending%status = status_film_cycles
         if (ending%status /= status_complete) return
         if (present(record)) call add_step(motion, record%longest_piece, nodes)
      end do
      if (present(record)) call record_period(gear%problem, motion%states(1, of_velocity), nodes, record)
      call begin_period(motion)
   end subroutine follow_period

end module nodal_orbit
