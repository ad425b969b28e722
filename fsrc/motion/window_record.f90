!> What the steps of a window tell, whatever samples are taken of it: the extremes of the motion, the sums by which the
!> window must close, and, where they are asked for, its Fourier integrals.
!>
!> An impact may be a millionth of a period long. The steps of the engine follow it, equidistant samples do not. With the
!> nodes of all steps (module step_nodes)
!>
!>     integral of z'' dt  =  change of z'                           (the mean of z'' of a periodic motion is zero)
!>     integral of W dh - integral of (F + m g) dh  =  change of m z'**2/2     (gears: dissipated energy = work of the force)
!>
!> hold within the errors of the steps, and the Fourier coefficients of z'' are
!>
!>     c_n = 1/T (change of z' + 2 pi i n/T integral of z' exp(-2 pi i n t/T) dt)
!>
!> for one period T, by parts: the velocity of an impact is a step, and no integral misses it. The line at n times the frequency
!> is 2 |mean of c_n over the periods|, and what the c_n vary by from period to period is power off the harmonics.
module window_record
   use constants, only: two_pi
   use film_law, only: film_loads
   use film_pressure, only: exact_pressures
   use kinds, only: dp
   use lane_functions, only: lane_cosine_sine, lanes
   use lane_scenes, only: lane_scene_t
   use node_extremes, only: extreme_t, find_extremes, seen_acceleration, seen_film, seen_load, seen_pressure, seen_quantities, &
                            seen_velocity
   use step_nodes, only: node_place, node_weight, nodes_per_piece, step_nodes_t
   implicit none(type, external)
   private

   !> Pieces that are looked at together: their arrays stay in the cache.
   integer, parameter :: block_pieces = 64, block_nodes = nodes_per_piece*block_pieces

   !> Record of a window.
   type, public :: window_record_t
      !> What is asked for: which extremes, by the codes of node_extremes, and the highest multiple of the frequency that Fourier
      !> coefficients are wanted for, 0: none
      logical :: wants(seen_quantities) = .true.
      integer :: multiples = 0
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
      !> Sums over the periods of T c_n and of |T c_n|**2, n from 0 to multiples [m/s], [m2/s2]
      complex(dp), allocatable :: line_sums(:)
      real(dp), allocatable :: line_squares(:)
      !> Integrals of z' exp(-2 pi i n t/T) over the time in periods, of the present period [m/s]
      complex(dp), allocatable :: integrals(:)
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

      record = window_record_t(wants=record%wants, multiples=record%multiples, longest_piece=record%longest_piece, &
                               start_film=film, start_velocity=velocity, start_momentum=momentum, start_implicit=implicit, &
                               end_velocity=velocity)
      if (record%multiples == 0) return
      allocate (record%line_sums(0:record%multiples), record%integrals(record%multiples), source=(0.0_dp, 0.0_dp))
      allocate (record%line_squares(0:record%multiples), source=0.0_dp)
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
      if (record%multiples > 0) call add_coefficients(end_velocity - record%end_velocity, record)
      record%periods = record%periods + 1
      record%end_velocity = end_velocity
   end subroutine record_period

   !> Add the Fourier coefficients of a period.
   pure subroutine add_coefficients(change, record)
      !> Change of z' over the period [m/s]
      real(dp), intent(in) :: change
      type(window_record_t), intent(inout) :: record
      complex(dp) :: coefficient
      integer :: n

      record%line_sums(0) = record%line_sums(0) + cmplx(change, 0.0_dp, dp)
      record%line_squares(0) = record%line_squares(0) + change*change
      do n = 1, record%multiples
         coefficient = cmplx(change, 0.0_dp, dp) + cmplx(0.0_dp, two_pi*real(n, dp), dp)*record%integrals(n)
         record%line_sums(n) = record%line_sums(n) + coefficient
         record%line_squares(n) = record%line_squares(n) + coefficient%re**2 + coefficient%im**2
      end do
      record%integrals = (0.0_dp, 0.0_dp)
   end subroutine add_coefficients

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
      real(dp), dimension(block_nodes) :: phases, weights, values, loads, forces, cosine, sine
      real(dp) :: sums(6), period
      integer :: n, i, before

      n = size(films)
      do i = 1, size(start)
         before = nodes_per_piece*(i - 1)
         phases(before + 1:before + nodes_per_piece) = start(i) + node_place*length(i)
         weights(before + 1:before + nodes_per_piece) = node_weight*length(i)
      end do
      ! Whole vectors: what fills them up weighs nothing.
      phases(n + 1:) = 0.0_dp
      weights(n + 1:) = 0.0_dp
      do i = 1, n, lanes
         call lane_cosine_sine(phases(i:i + lanes - 1), cosine(i:i + lanes - 1), sine(i:i + lanes - 1))
      end do
      call film_loads(scene%film, films, velocities, loads(:n))
      sums = 0.0_dp
      !$omp simd
      do i = 1, n
         forces(i) = scene%steady_force + scene%force_amplitude*cosine(i) + scene%weight
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
         call add_integrals(weights(:n)*velocities, cosine, sine, record%integrals)
         call add_turns(values(:n), record)
      end if
      call search(seen_film, films, record)
      call search(seen_velocity, velocities, record)
      call search(seen_acceleration, values(:n), record)
      call search(seen_load, loads(:n), record)
      if (record%wants(seen_pressure)) then
         call exact_pressures(scene%film%radius, scene%film%speed, scene%film%viscosity, films, velocities, values(:n))
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

   !> Add nodes to the Fourier integrals. The powers of exp(-2 pi i t/T) follow from each other by products.
   pure subroutine add_integrals(weighted, cosine, sine, integrals)
      !> z' times the weight of the node [m/s]
      real(dp), intent(in) :: weighted(:)
      !> Of 2 pi times the phases of the nodes
      real(dp), intent(in) :: cosine(block_nodes)
      real(dp), intent(in) :: sine(block_nodes)
      complex(dp), intent(inout) :: integrals(:)
      real(dp), dimension(block_nodes) :: real_part, imaginary_part
      real(dp) :: next, real_sum, imaginary_sum
      integer :: i, k

      real_part(:size(weighted)) = weighted
      imaginary_part = 0.0_dp
      do k = 1, size(integrals)
         real_sum = 0.0_dp
         imaginary_sum = 0.0_dp
         !$omp simd private(next) reduction(+: real_sum, imaginary_sum)
         do i = 1, size(weighted)
            next = real_part(i)*cosine(i) + imaginary_part(i)*sine(i)
            imaginary_part(i) = imaginary_part(i)*cosine(i) - real_part(i)*sine(i)
            real_part(i) = next
            real_sum = real_sum + real_part(i)
            imaginary_sum = imaginary_sum + imaginary_part(i)
         end do
         integrals(k) = integrals(k) + cmplx(real_sum, imaginary_sum, dp)
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
