!> How the numbers of a state stand in a lane: film, Lienard variable and compressions scaled in its block, states of films beside it.
!> No other place of the engine depends on which number is which.
module lane_state
   use engine, only: motion_state_t
   use kinds, only: dp
   use lane_block, only: lane_block_t, slip_velocity
   use lane_inner, only: lane_inner_t
   use problem, only: of_coast_compression, of_drive_compression, of_film, of_velocity
   use taylor_step_control, only: order
   implicit none(type, external)
   private

   public :: carried_numbers, numbers_of_lane, series_of_number, state_of_lane, velocity_of_lane, &
              take_state, place_state, films_of_lane, thinner_scaled_film

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

      films = [state(of_film), block%backlash(lane) - state(of_film) + &
               sum(state(of_drive_compression:of_velocity + carried_numbers(lane, block)))]
   end function films_of_lane

   !> The thinner one of them [-].
   pure real(dp) function thinner_scaled_film(state, lane, block) result(thinner)
      !> As of take_state
      real(dp), intent(in) :: state(:)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block

      thinner = minval(films_of_lane(state, lane, block))
   end function thinner_scaled_film

end module lane_state
