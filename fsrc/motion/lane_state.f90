!> How the numbers of a state stand in a lane: film, Lienard variable and compressions scaled in its block, states of films beside it,
!> as they never enter the rows that series go over. No other place of the engine depends on which number is which.
module lane_state
   use engine, only: motion_state_t
   use kinds, only: dp
   use lane_block, only: given_way, lane_block_t, slip_velocity
   use problem, only: of_drive_compression, of_film, of_velocity, contact_count, inner_places, problem_t, state_numbers
   use radau_nodes, only: stages
   use taylor_step_control, only: order
   implicit none(type, external)
   private

   !> States of the films in a lane, in the units of their law, of one flank and then of the other.
   type, public :: lane_inner_t
      !> Numbers of the film of one flank; 0: films have no state of their own
      integer :: count = 0
      !> Numbers now, where the step leads to, and series about the start of the step: number, power
      real(dp), allocatable :: now(:)
      real(dp), allocatable :: next(:)
      real(dp), allocatable :: series(:, :)
      !> Film that one of each counts as [m]
      real(dp), allocatable :: counts_as(:)
   end type lane_inner_t

   public :: place_inner, evaluate_inner, carried_numbers, numbers_of_lane, series_of_number, sum_series, state_of_lane, &
             velocity_of_lane, take_state, place_state, films_of_lane, thinner_scaled_film

contains

   !> State of a lane in units; the caller sets its period and method.
   pure type(motion_state_t) function state_of_lane(lane, block, inner) result(state)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      type(lane_inner_t), intent(in) :: inner
      integer :: last

      last = of_velocity + carried_numbers(lane, block)
      allocate (state%numbers(numbers_of_lane(lane, block, inner)))
      call take_state(lane, block, inner, state%numbers)
      state%lienard_variable = state%numbers(of_velocity)
      state%numbers(:last) = state%numbers(:last)*block%film_scale(lane)
      state%numbers(of_velocity) = velocity_of_lane(lane, block)
      state%carried_on = .true.
   end function state_of_lane

   !> Velocity of the tooth in a lane [m/s].
   pure real(dp) function velocity_of_lane(lane, block)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block

      velocity_of_lane = (block%lienard(lane, 0) + slip_velocity(block%film(lane, 0), lane, block))*block%velocity_scale(lane)
   end function velocity_of_lane

   !> Scaled state of a lane: all that a period follows from, the Lienard variable in place of the velocity [-], states of films in
   !> the units of their law.
   pure subroutine take_state(lane, block, inner, state)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      type(lane_inner_t), intent(in) :: inner
      !> As many numbers as the motion has
      real(dp), intent(inout) :: state(:)
      integer :: springs

      springs = carried_numbers(lane, block)
      state(of_film) = block%film(lane, 0)
      state(of_velocity) = block%lienard(lane, 0)
      state(of_drive_compression:of_velocity + springs) = block%compression(lane, :springs, 0)
      if (inner%count > 0) state(of_drive_compression + springs:) = inner%now
   end subroutine take_state

   !> Numbers of a state that the block carries beside film and velocity; they stand behind these.
   pure integer function carried_numbers(lane, block)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block

      carried_numbers = merge(flanks_of(lane, block), 0, block%compliance(lane) > 0.0_dp)
      if (block%retardation(lane) > 0.0_dp) carried_numbers = 2*carried_numbers
   end function carried_numbers

   !> Numbers of the state of the motion in a lane.
   pure integer function numbers_of_lane(lane, block, inner)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      type(lane_inner_t), intent(in) :: inner

      numbers_of_lane = of_velocity + carried_numbers(lane, block) + inner%count*flanks_of(lane, block)
   end function numbers_of_lane

   !> Series of one of the carried numbers about the start of the step, scaled like films [-].
   pure function series_of_number(lane, number, block) result(series)
      integer, intent(in) :: lane
      !> 1 to carried_numbers
      integer, intent(in) :: number
      type(lane_block_t), intent(in) :: block
      real(dp) :: series(0:order)

      series = block%compression(lane, number, :)
   end function series_of_number

   !> A series of a lane at some distances from its point of expansion.
   pure subroutine sum_series(count, series, x, values)
      integer, intent(in) :: count
      real(dp), intent(in) :: series(0:order)
      !> Distances [periods]
      real(dp), intent(in) :: x(count)
      real(dp), intent(out) :: values(count)
      integer :: i, k

      values = series(order)
      do k = order - 1, 0, -1
         !$omp simd
         do i = 1, count
            values(i) = values(i)*x(i) + series(k)
         end do
      end do
   end subroutine sum_series

   !> Flanks of the motion in a lane.
   pure integer function flanks_of(lane, block)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block

      flanks_of = merge(2, 1, block%backlash(lane) < huge(1.0_dp))
   end function flanks_of

   !> Put a scaled state into a lane.
   pure subroutine place_state(state, lane, block, inner)
      !> As of take_state
      real(dp), intent(in) :: state(:)
      integer, intent(in) :: lane
      type(lane_block_t), intent(inout) :: block
      type(lane_inner_t), intent(inout) :: inner
      integer :: springs

      springs = carried_numbers(lane, block)
      block%film(lane, 0) = state(of_film)
      block%lienard(lane, 0) = state(of_velocity)
      block%compression(lane, :springs, 0) = state(of_drive_compression:of_velocity + springs)
      if (inner%count > 0) inner%now = state(of_drive_compression + springs:)
   end subroutine place_state

   !> Scaled films of drive and coast flank in a state, the second huge where there is one flank [-].
   pure function films_of_lane(state, lane, block) result(films)
      !> As of take_state
      real(dp), intent(in) :: state(:)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      real(dp) :: films(2)

      films = [state(of_film), block%backlash(lane) - state(of_film)]
      if (flanks_of(lane, block) == 2 .and. block%compliance(lane) > 0.0_dp) &
         films(2) = films(2) + given_way(state(of_drive_compression:of_velocity + carried_numbers(lane, block)), lane, block)
   end function films_of_lane

   !> The thinner one of them [-].
   pure real(dp) function thinner_scaled_film(state, lane, block) result(thinner)
      !> As of take_state
      real(dp), intent(in) :: state(:)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block

      thinner = minval(films_of_lane(state, lane, block))
   end function thinner_scaled_film

   !> Put the films of a motion into a lane.
   pure subroutine place_inner(problem, start, inner)
      type(problem_t), intent(in) :: problem
      !> Where it starts
      type(motion_state_t), intent(in) :: start
      type(lane_inner_t), intent(out) :: inner
      integer :: first, last, places(2), i

      places = inner_places(problem, 1)
      inner%count = places(2) - places(1) + 1
      if (inner%count == 0) return
      first = places(1)
      places = inner_places(problem, contact_count(problem))
      last = places(2)
      allocate (inner%now(last - first + 1), source=start%numbers(first:last))
      allocate (inner%next(last - first + 1), source=start%numbers(first:last))
      allocate (inner%series(last - first + 1, 0:stages), source=0.0_dp)
      associate (numbers => state_numbers(problem))
         allocate (inner%counts_as(last - first + 1), source=[(numbers(i)%counts_as, i=first, last)])
      end associate
   end subroutine place_inner

   !> The states at some distances from the start of the step.
   pure subroutine evaluate_inner(inner, distances, values)
      type(lane_inner_t), intent(in) :: inner
      !> [periods]
      real(dp), intent(in) :: distances(:)
      !> Distance, number
      real(dp), intent(out) :: values(:, :)
      integer :: k, i

      do i = 1, size(values, 2)
         values(:, i) = inner%series(i, stages)
         do k = stages - 1, 0, -1
            values(:, i) = values(:, i)*distances + inner%series(i, k)
         end do
      end do
   end subroutine evaluate_inner

end module lane_state
