!> What the steps of a window tell, whatever samples are taken of it: the extremes of the motion, the sums by which the
!> window must close, and, where they are asked for, its Fourier integrals.
!>
!> An impact may be a millionth of a period long. The steps of the engine follow it, equidistant samples do not. With the
!> nodes of all steps (module step_nodes)
!>
!>     integral of z'' dt  =  change of z'                           (the mean of z'' of a periodic motion is zero)
!>     integral of W dh - integral of (F + m g) dh  =  change of m z'**2/2     (gears: dissipated energy = work of the force)
!>
!> hold within the errors of the steps, and the amplitude of z'' at n/p times the frequency, p the periods of the window, is
!>
!>     a_n = 2/(p T) |change of z' + i w_n integral of z' exp(-i w_n t) dt| ,   w_n = 2 pi n/(p T)
!>
!> by parts: the velocity of an impact is a step, and no integral misses it.
module window_record
   use constants, only: two_pi
   use film_law, only: film_loads
   use film_pressure, only: exact_pressure
   use forcing, only: applied_force
   use kinds, only: dp
   use lane_scenes, only: lane_scene_t
   use node_extremes, only: extreme_t, find_extremes, seen_acceleration, seen_film, seen_load, seen_pressure, seen_quantities, &
                            seen_velocity
   use step_nodes, only: node_place, node_weight, nodes_per_piece, step_nodes_t
   implicit none(type, external)
   private

   !> Pieces that are looked at together: their arrays stay in the cache.
   integer, parameter :: block_pieces = 64

   !> Record of a window.
   type, public :: window_record_t
      !> What is asked for: which extremes, by the codes of node_extremes; the highest multiple of the frequency that Fourier
      !> integrals are wanted for, 0: none, and the periods of the window, whose reciprocal is their spacing
      logical :: wants(seen_quantities) = .true.
      integer :: multiples = 0
      integer :: window_periods = 1
      !> Longest piece of a step [periods]
      real(dp) :: longest_piece = 1.0_dp
      !> Shortest piece met [periods]
      real(dp) :: shortest_piece = 1.0_dp
      !> Periods recorded: those of the window, but for what only repeats them to the last bit
      integer :: periods = 0
      !> State where the window begins: h [m], z' [m/s], scaled momentum, and whether the motion went on by the implicit method
      real(dp) :: start_film = 0.0_dp
      real(dp) :: start_velocity = 0.0_dp
      real(dp) :: start_momentum = 0.0_dp
      logical :: start_implicit = .false.
      !> z' where the recorded periods end [m/s]
      real(dp) :: end_velocity = 0.0_dp
      !> Smallest and largest values
      type(extreme_t) :: lowest(seen_quantities), highest(seen_quantities)
      !> Integrals of z'', |z''| and z''**2 over the time in periods [m/s2], [m/s2], [m2/s4]
      real(dp) :: acceleration_sum = 0.0_dp
      real(dp) :: acceleration_size = 0.0_dp
      real(dp) :: acceleration_square = 0.0_dp
      !> Integrals of W dh, of (F + m g) dh, and of the magnitudes of both [J]
      real(dp) :: film_work = 0.0_dp
      real(dp) :: force_work = 0.0_dp
      real(dp) :: work_size = 0.0_dp
      !> Integrals of z' exp(-i w_n t) over the time in periods, n from 1 to multiples*window_periods [m/s]
      complex(dp), allocatable :: velocity_integrals(:)
      !> Values of z'' at its turns from node to node, where Fourier integrals are wanted [m/s2]
      real(dp), allocatable :: turns(:)
      integer :: turn_count = 0
   end type window_record_t

   public :: start_record, record_period, momentum_gap, energy_gap

contains

   !> Start a record where its window begins. What is asked for stays.
   pure subroutine start_record(film, velocity, momentum, implicit, record)
      !> State: h [m], z' [m/s], scaled momentum [-]
      real(dp), intent(in) :: film
      real(dp), intent(in) :: velocity
      real(dp), intent(in) :: momentum
      !> Whether the motion goes on by the implicit method
      logical, intent(in) :: implicit
      !> The record
      type(window_record_t), intent(inout) :: record

      record = window_record_t(wants=record%wants, multiples=record%multiples, window_periods=record%window_periods, &
                               longest_piece=record%longest_piece, start_film=film, start_velocity=velocity, &
                               start_momentum=momentum, start_implicit=implicit)
      if (record%multiples > 0) allocate (record%velocity_integrals(record%multiples*record%window_periods), &
                                          source=(0.0_dp, 0.0_dp))
   end subroutine start_record

   !> Add a period, and forget its nodes.
   pure subroutine record_period(scene, end_velocity, nodes, record)
      !> The scene
      type(lane_scene_t), intent(in) :: scene
      !> z' at the end of the period [m/s]
      real(dp), intent(in) :: end_velocity
      !> Nodes of the period; none are left
      type(step_nodes_t), intent(inout) :: nodes
      type(window_record_t), intent(inout) :: record
      integer :: first, last

      do first = 1, nodes%pieces, block_pieces
         last = min(first + block_pieces - 1, nodes%pieces)
         call record_pieces(scene, nodes%start(first:last), nodes%length(first:last), &
                            nodes%films(nodes_per_piece*(first - 1) + 1:nodes_per_piece*last), &
                            nodes%velocities(nodes_per_piece*(first - 1) + 1:nodes_per_piece*last), record)
      end do
      nodes%pieces = 0
      record%periods = record%periods + 1
      record%end_velocity = end_velocity
   end subroutine record_period

   !> Add some pieces of steps.
   pure subroutine record_pieces(scene, start, length, films, velocities, record)
      type(lane_scene_t), intent(in) :: scene
      !> Phase where each begins, and its length [periods]
      real(dp), intent(in) :: start(:)
      real(dp), intent(in) :: length(:)
      !> h [m] and z' [m/s] at the nodes
      real(dp), contiguous, intent(in) :: films(:)
      real(dp), contiguous, intent(in) :: velocities(:)
      type(window_record_t), intent(inout) :: record
      real(dp), dimension(nodes_per_piece*block_pieces) :: phases, weights, values, loads, forces
      real(dp) :: sums(6), period
      integer :: n, i, before

      n = size(films)
      do i = 1, size(start)
         before = nodes_per_piece*(i - 1)
         phases(before + 1:before + nodes_per_piece) = start(i) + node_place*length(i)
         weights(before + 1:before + nodes_per_piece) = node_weight*length(i)
      end do
      call film_loads(scene%film, films, velocities, loads(:n))
      sums = 0.0_dp
      !$omp simd
      do i = 1, n
         forces(i) = applied_force(scene%steady_force, scene%force_amplitude, phases(i)) + scene%weight
         values(i) = (loads(i) - forces(i))/scene%mass
      end do
      !$omp simd reduction(+: sums)
      do i = 1, n
         sums(1) = sums(1) + weights(i)*values(i)
         sums(2) = sums(2) + weights(i)*abs(values(i))
         sums(3) = sums(3) + weights(i)*values(i)*values(i)
         sums(4) = sums(4) + weights(i)*loads(i)*velocities(i)
         sums(5) = sums(5) + weights(i)*forces(i)*velocities(i)
         sums(6) = sums(6) + weights(i)*(abs(loads(i)*velocities(i)) + abs(forces(i)*velocities(i)))
      end do
      period = 1.0_dp/scene%frequency
      record%shortest_piece = min(record%shortest_piece, minval(length))
      record%acceleration_sum = record%acceleration_sum + sums(1)
      record%acceleration_size = record%acceleration_size + sums(2)
      record%acceleration_square = record%acceleration_square + sums(3)
      record%film_work = record%film_work + sums(4)*period
      record%force_work = record%force_work + sums(5)*period
      record%work_size = record%work_size + sums(6)*period

      if (record%multiples > 0) then
         call add_integrals(real(record%periods, dp), phases(:n), weights(:n)*velocities, record)
         call add_turns(values(:n), record)
      end if
      call search(seen_film, films, record)
      call search(seen_velocity, velocities, record)
      call search(seen_acceleration, values(:n), record)
      call search(seen_load, loads(:n), record)
      if (record%wants(seen_pressure)) then
         values(:n) = exact_pressure(scene%film%radius, scene%film%speed, scene%film%viscosity, films, velocities)
         call search(seen_pressure, values(:n), record)
      end if

   contains

      !> Look for extremes of a quantity.
      pure subroutine search(quantity, numbers, record)
         integer, intent(in) :: quantity
         real(dp), contiguous, intent(in) :: numbers(:)
         type(window_record_t), intent(inout) :: record

         if (record%wants(quantity)) call find_extremes(scene, quantity, record%periods, start, length, films, velocities, &
                                                        numbers, record%lowest(quantity), record%highest(quantity))
      end subroutine search

   end subroutine record_pieces

   !> Add nodes to the Fourier integrals. The powers of exp(-2 pi i t/p) follow from each other by products.
   pure subroutine add_integrals(period, phases, weighted, record)
      !> Periods of the window before this one
      real(dp), intent(in) :: period
      !> Phases of the nodes [periods]
      real(dp), contiguous, intent(in) :: phases(:)
      !> z' times the weight of the node [m/s]
      real(dp), contiguous, intent(in) :: weighted(:)
      type(window_record_t), intent(inout) :: record
      real(dp), dimension(size(phases)) :: cosine, sine, real_part, imaginary_part
      real(dp) :: angle, next, real_sum, imaginary_sum
      integer :: i, n

      do i = 1, size(phases)
         angle = two_pi*(period + phases(i))/real(record%window_periods, dp)
         cosine(i) = cos(angle)
         sine(i) = -sin(angle)
      end do
      real_part = weighted
      imaginary_part = 0.0_dp
      do n = 1, size(record%velocity_integrals)
         real_sum = 0.0_dp
         imaginary_sum = 0.0_dp
         !$omp simd private(next) reduction(+: real_sum, imaginary_sum)
         do i = 1, size(phases)
            next = real_part(i)*cosine(i) - imaginary_part(i)*sine(i)
            imaginary_part(i) = real_part(i)*sine(i) + imaginary_part(i)*cosine(i)
            real_part(i) = next
            real_sum = real_sum + real_part(i)
            imaginary_sum = imaginary_sum + imaginary_part(i)
         end do
         record%velocity_integrals(n) = record%velocity_integrals(n) + cmplx(real_sum, imaginary_sum, dp)
      end do
   end subroutine add_integrals

   !> Note where z'' turns from node to node.
   pure subroutine add_turns(values, record)
      real(dp), intent(in) :: values(:)
      type(window_record_t), intent(inout) :: record
      real(dp), allocatable :: longer(:)
      integer :: i

      if (.not. allocated(record%turns)) allocate (record%turns(1024))
      do i = 1, size(values)
         ! A value on the way from the last turn to a farther one is no turn.
         if (record%turn_count >= 2) then
            associate (last => record%turns(record%turn_count), before => record%turns(record%turn_count - 1))
               if ((last - before)*(values(i) - last) >= 0.0_dp) record%turn_count = record%turn_count - 1
            end associate
         end if
         if (record%turn_count == size(record%turns)) then
            allocate (longer(2*record%turn_count))
            longer(:record%turn_count) = record%turns
            call move_alloc(longer, record%turns)
         end if
         record%turn_count = record%turn_count + 1
         record%turns(record%turn_count) = values(i)
      end do
   end subroutine add_turns

   !> By how much the integral of z'' misses the change of z', as a share of the integral of |z''| [-].
   pure real(dp) function momentum_gap(record, frequency) result(gap)
      !> A record of one or more periods
      type(window_record_t), intent(in) :: record
      !> Frequency of the force [Hz]
      real(dp), intent(in) :: frequency

      gap = 0.0_dp
      if (record%acceleration_size > 0.0_dp) &
         gap = abs(record%acceleration_sum - (record%end_velocity - record%start_velocity)*frequency)/record%acceleration_size
   end function momentum_gap

   !> By how much the works of film and force miss the change of kinetic energy, as a share of what went to and fro [-].
   pure real(dp) function energy_gap(record, mass) result(gap)
      !> A record of one or more periods
      type(window_record_t), intent(in) :: record
      !> Mass m [kg]
      real(dp), intent(in) :: mass
      real(dp) :: kinetic

      gap = 0.0_dp
      kinetic = 0.5_dp*mass*(record%end_velocity - record%start_velocity)*(record%end_velocity + record%start_velocity)
      if (record%work_size > 0.0_dp) gap = abs(record%film_work - record%force_work - kinetic)/record%work_size
   end function energy_gap

end module window_record
