!> Record of the loads of both films over a window: impacts, and the share of it in which the drive film is unloaded.
!>
!> Module impacts takes the loads as points in the order of time: those of module load_points, and where W passes F_max. A
!> piece of a step in which W stays far below F_max is one low point.
module load_record
   use carried_loads, only: contact_loads
   use impacts, only: impact_watch_t, load_point_t, point_fall, point_low, point_passing, point_rise, take_point
   use kinds, only: dp
   use load_points, only: find_crossing, find_points, load_at, piece_points_t
   use problem, only: closing_velocity, contact_count, largest_applied_force, most_contacts, of_velocity, problem_t, static_load
   use scene_types, only: least_static_load
   use step_nodes, only: node_place, node_weight, nodes_per_piece
   use value_range, only: range_of
   implicit none(type, external)
   private

   !> How far W may leave the range of the nodes of its piece, as a share of this range.
   real(dp), parameter :: beyond_nodes = 0.5_dp
   !> A film is unloaded below this share of the static load, and the contact for which that is recorded: that of the drive flank.
   real(dp), parameter :: unloaded_share = 0.01_dp
   integer, parameter :: loaded_contact = 1

   !> Record of the loads.
   type, public :: load_record_t
      !> What is requested: loads above this multiple of F_max are impacts; 0: nothing is recorded
      real(dp) :: impact_limit = 0.0_dp
      type(impact_watch_t) :: contacts(most_contacts) = impact_watch_t()
      !> Load below which the drive film is unloaded [N], and for how long [periods]
      real(dp) :: unloaded_level = 0.0_dp
      real(dp) :: unloaded = 0.0_dp
   end type load_record_t

   public :: start_loads, record_loads, record_load_samples

contains

   !> Start a record. What is requested stays.
   pure subroutine start_loads(problem, record)
      type(problem_t), intent(in) :: problem
      type(load_record_t), intent(inout) :: record
      real(dp) :: largest_force

      record = load_record_t(impact_limit=record%impact_limit)
      largest_force = largest_applied_force(problem)
      ! Without a force there is nothing that a load could exceed.
      if (largest_force >= least_static_load) then
         record%contacts%level = largest_force
         record%contacts%limit = record%impact_limit*largest_force
      end if
      record%unloaded_level = unloaded_share*merge(abs(static_load(problem)), largest_force, &
                                                   abs(static_load(problem)) >= least_static_load)
   end subroutine start_loads

   !> Add some pieces of steps.
   pure subroutine record_loads(problem, contact, period, start, length, states, loads, record)
      type(problem_t), intent(in) :: problem
      !> Number of the contact
      integer, intent(in) :: contact
      !> Periods since the window began
      integer, intent(in) :: period
      !> Phase where each piece begins, and its length [periods]
      real(dp), intent(in) :: start(:)
      real(dp), intent(in) :: length(:)
      !> States at the nodes, eight a piece, and W there [N]
      real(dp), intent(in) :: states(:, :)
      real(dp), intent(in) :: loads(:)
      type(load_record_t), intent(inout) :: record
      type(piece_points_t) :: points
      real(dp) :: smallest, largest, room, low
      integer :: piece, before

      low = low_load(record%contacts(contact))
      do piece = 1, size(start)
         before = nodes_per_piece*(piece - 1)
         call range_of(loads(before + 1:before + nodes_per_piece), smallest, largest)
         room = beyond_nodes*(largest - smallest)
         points%count = 0
         if (largest + room < low) then
            call record_low(real(period, dp) + start(piece), record%contacts(contact))
         else
            call find_points(problem, contact, states, piece, loads(before + 1:before + nodes_per_piece), points)
            call record_piece(problem, contact, real(period, dp) + start(piece), length(piece), states, piece, &
                            loads(before + 1:before + nodes_per_piece), points, record%contacts(contact))
         end if
         if (contact /= loaded_contact) cycle
         if (largest + room < record%unloaded_level) then
            record%unloaded = record%unloaded + length(piece)
         else if (smallest - room < record%unloaded_level) then
            if (points%count == 0) &
               call find_points(problem, contact, states, piece, loads(before + 1:before + nodes_per_piece), points)
            record%unloaded = record%unloaded + length(piece)*share_below(problem, states, piece, points, record%unloaded_level)
         end if
      end do
   end subroutine record_loads

   !> Load below which every impact is over: it is below F_max, and below half of any impact's.
   pure real(dp) function low_load(watch)
      type(impact_watch_t), intent(in) :: watch

      low_load = min(watch%level, 0.5_dp*watch%limit)
   end function low_load

   !> Record that W is low.
   pure subroutine record_low(time, watch)
      real(dp), intent(in) :: time
      type(impact_watch_t), intent(inout) :: watch

      if (watch%started .and. watch%last%kind == point_low) return
      call take_point(load_point_t(time=time, sum=watch%last%sum, kind=point_low), watch)
   end subroutine record_low

   !> Record the points of a piece.
   pure subroutine record_piece(problem, contact, start, length, states, piece, loads, points, watch)
      type(problem_t), intent(in) :: problem
      integer, intent(in) :: contact
      !> Time where the piece begins, and its length [periods]
      real(dp), intent(in) :: start
      real(dp), intent(in) :: length
      real(dp), intent(in) :: states(:, :)
      integer, intent(in) :: piece
      real(dp), intent(in) :: loads(nodes_per_piece)
      type(piece_points_t), intent(in) :: points
      type(impact_watch_t), intent(inout) :: watch
      real(dp) :: total, summed, place, load, velocity, low
      integer :: i

      low = low_load(watch)
      total = watch%last%sum
      summed = 0.0_dp
      ! Rounding may put the end of one piece and the begin of the next on different sides of F_max.
      if (watch%started .and. (watch%above .neqv. points%load(1) > watch%level)) &
         call note(contact, merge(point_fall, point_rise, watch%above), start, watch%level, points%velocity(1), total, watch)
      call note(contact, merge(point_low, point_passing, points%load(1) < low), start, points%load(1), points%velocity(1), &
                total, watch)
      do i = 2, points%count
         if (points%load(i - 1) > watch%level .neqv. points%load(i) > watch%level) then
            call find_crossing(problem, contact, states, piece, points, i, watch%level, place, load, velocity)
            if (watch%above) call add_integral(place, summed, total)
            summed = place
            call note(contact, merge(point_fall, point_rise, watch%above), start + place*length, watch%level, velocity, &
                      total, watch)
         end if
         if (watch%above .and. (points%turns(i) .or. i == points%count)) call add_integral(points%place(i), summed, total)
         call note(contact, merge(point_low, point_passing, points%load(i) < low), start + points%place(i)*length, points%load(i), &
                   points%velocity(i), total, watch)
      end do

   contains

      !> Take the integral of W up to a place into the sum.
      pure subroutine add_integral(place, summed, total)
         real(dp), intent(in) :: place
         !> Place up to which it was taken before, and the sum
         real(dp), intent(inout) :: summed
         real(dp), intent(inout) :: total
         real(dp) :: load, velocity, part
         integer :: k

         part = 0.0_dp
         if (summed <= 0.0_dp .and. place >= 1.0_dp) then
            part = sum(node_weight*loads)
         else
            do k = 1, nodes_per_piece
               call load_at(problem, contact, states, piece, summed + (place - summed)*node_place(k), load, velocity)
               part = part + (place - summed)*node_weight(k)*load
            end do
         end if
         total = total + length*part
         summed = place
      end subroutine add_integral

   end subroutine record_piece

   !> Take a point of W into the impacts.
   pure subroutine note(contact, kind_of, time, load, velocity, total, watch)
      integer, intent(in) :: contact
      integer, intent(in) :: kind_of
      real(dp), intent(in) :: time
      real(dp), intent(in) :: load
      !> Of the gear [m/s]
      real(dp), intent(in) :: velocity
      !> Integral of W so far
      real(dp), intent(in) :: total
      type(impact_watch_t), intent(inout) :: watch

      call take_point(load_point_t(time=time, load=load, velocity=closing_velocity(contact, velocity), sum=total, &
                                   kind=kind_of), watch)
   end subroutine note

   !> Share of a piece in which the drive film carries less than a level.
   pure real(dp) function share_below(problem, states, piece, points, level) result(share)
      type(problem_t), intent(in) :: problem
      real(dp), intent(in) :: states(:, :)
      integer, intent(in) :: piece
      type(piece_points_t), intent(in) :: points
      !> [N]
      real(dp), intent(in) :: level
      real(dp) :: place, load, velocity
      integer :: i

      share = 0.0_dp
      do i = 2, points%count
         associate (x => points%place(i - 1:i), is_below => points%load(i - 1:i) < level)
            if (is_below(1) .neqv. is_below(2)) then
               call find_crossing(problem, loaded_contact, states, piece, points, i, level, place, load, velocity)
               share = share + merge(place - x(1), x(2) - place, is_below(1))
            else if (is_below(1)) then
               share = share + (x(2) - x(1))
            end if
         end associate
      end do
   end function share_below

   !> Record the samples of a window whose steps they are, as straight lines between them; the window begins with its last sample.
   pure subroutine record_load_samples(problem, samples_per_period, states, record)
      type(problem_t), intent(in) :: problem
      integer, intent(in) :: samples_per_period
      !> Sample, number of its state
      real(dp), intent(in) :: states(:, :)
      type(load_record_t), intent(inout) :: record
      real(dp) :: loads(0:size(states, 1))
      integer :: contact, n

      n = size(states, 1)
      do contact = 1, contact_count(problem)
         call contact_loads(problem, contact, states, loads(1:))
         loads(0) = loads(n)
         call record_samples(contact, loads, [states(n, of_velocity), states(:, of_velocity)], samples_per_period, &
                           record%contacts(contact))
         if (contact == loaded_contact) record%unloaded = time_below(loads, record%unloaded_level)/real(samples_per_period, dp)
      end do
   end subroutine record_load_samples

   !> Record samples of W.
   pure subroutine record_samples(contact, loads, velocities, samples_per_period, watch)
      integer, intent(in) :: contact
      !> The last one, and all of them
      real(dp), intent(in) :: loads(0:)
      real(dp), intent(in) :: velocities(0:)
      integer, intent(in) :: samples_per_period
      type(impact_watch_t), intent(inout) :: watch
      real(dp) :: total, step, share, low
      integer :: i

      step = 1.0_dp/real(samples_per_period, dp)
      low = low_load(watch)
      total = 0.0_dp
      call note(contact, point_passing, 0.0_dp, loads(0), velocities(0), total, watch)
      do i = 1, ubound(loads, 1)
         share = 0.0_dp
         if (loads(i - 1) > watch%level .neqv. loads(i) > watch%level) then
            share = (watch%level - loads(i - 1))/(loads(i) - loads(i - 1))
            if (watch%above) total = total + 0.5_dp*share*step*(loads(i - 1) + watch%level)
            call note(contact, merge(point_fall, point_rise, watch%above), (real(i - 1, dp) + share)*step, watch%level, &
                      velocities(i - 1) + share*(velocities(i) - velocities(i - 1)), total, watch)
            if (watch%above) total = total + 0.5_dp*(1.0_dp - share)*step*(watch%level + loads(i))
         else if (watch%above) then
            total = total + 0.5_dp*step*(loads(i - 1) + loads(i))
         end if
         call note(contact, merge(point_low, point_passing, loads(i) < low), real(i, dp)*step, loads(i), velocities(i), &
                   total, watch)
      end do
   end subroutine record_samples

   !> Time in which straight lines between numbers one apart are below a level.
   pure real(dp) function time_below(values, level) result(time)
      real(dp), intent(in) :: values(:)
      real(dp), intent(in) :: level
      real(dp) :: share
      integer :: i

      time = 0.0_dp
      do i = 2, size(values)
         if (values(i - 1) < level .neqv. values(i) < level) then
            share = (level - values(i - 1))/(values(i) - values(i - 1))
            time = time + merge(share, 1.0_dp - share, values(i - 1) < level)
         else if (values(i) < level) then
            time = time + 1.0_dp
         end if
      end do
   end function time_below

end module load_record
