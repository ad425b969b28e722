!> Record of the steps of a window, whatever samples are taken of it: the extremes of the motion, the sums by which the
!> window must close, and, where they are requested, its Fourier integrals (fsrc/THEORY.md, sections 8 and 11).
!>
!> An impact may be a millionth of a period long. The steps of the engine follow it, equidistant samples do not; by parts, the
!> velocity of an impact is a step, and no integral misses it.
module window_record
   use constants, only: two_pi
   use engine, only: motion_state_t
   use flank_contact, only: is_elastic
   use force, only: forces_on_circle
   use kinds, only: dp
   use lane_functions, only: lane_cosine_sine, lanes
   use load_record, only: load_record_t, record_loads, start_loads
   use node_extremes, only: block_nodes, block_pieces, extreme_t, find_extremes, seen_acceleration, seen_films, seen_loads, &
      seen_net_load, seen_position, seen_pressure, seen_quantities, seen_velocity
   use carried_loads, only: contact_films, contact_loads, gear_positions, largest_pressures, tooth_powers
   use problem, only: contact_count, has_damped_teeth, most_contacts, of_velocity, problem_t, static_load
   use step_nodes, only: node_place, node_weight, nodes_per_piece, step_nodes_t
   implicit none(type, external)
   private

   !> Oscillations that the eight nodes of a piece of a step integrate to eight digits.
   real(dp), parameter :: oscillations_per_piece = 1.27_dp

   !> Record of a window.
   type, public :: window_record_t
      !> What is requested: which extremes, by the codes of node_extremes, and the highest multiple of the frequency that Fourier
      !> coefficients are wanted for, 0: none
      logical :: wants(seen_quantities) = .true.
      integer :: multiples = 0
      !> Impacts, where there is a limit for them, and for how long the drive film is unloaded
      type(load_record_t) :: loads = load_record_t()
      !> Longest piece of a step, by the multiples [periods]
      real(dp) :: longest_piece = 1.0_dp
      !> Shortest piece met [periods]
      real(dp) :: shortest_piece = 1.0_dp
      !> Periods recorded: those of the window, but for what only repeats them to the last bit
      integer :: periods = 0
      !> State where the window begins
      type(motion_state_t) :: start = motion_state_t()
      !> z' where the recorded periods end [m/s]
      real(dp) :: end_velocity = 0.0_dp
      !> Smallest and largest values
      type(extreme_t) :: lowest(seen_quantities) = extreme_t(), highest(seen_quantities) = extreme_t()
      !> Integrals of z'', |z''| and powers of z'' over the time in periods [m/s2], [m/s2], [m2/s4], [m3/s6], [m4/s8]
      real(dp) :: acceleration_sum = 0.0_dp
      real(dp) :: acceleration_size = 0.0_dp
      real(dp) :: acceleration_square = 0.0_dp
      real(dp) :: acceleration_cube = 0.0_dp
      real(dp) :: acceleration_fourth = 0.0_dp
      !> Integrals of W - Q - m g, of its square and of its power over the time in periods [N], [N2], [W]
      real(dp) :: beyond_static = 0.0_dp
      real(dp) :: beyond_static_square = 0.0_dp
      real(dp) :: power_beyond_static = 0.0_dp
      !> Integrals of W dh, of (F + m g) dh, and of the magnitudes of both [J]
      real(dp) :: film_work = 0.0_dp
      real(dp) :: force_work = 0.0_dp
      real(dp) :: work_size = 0.0_dp
      !> Energy that damped teeth lose [J]
      real(dp) :: tooth_loss = 0.0_dp
      !> Sums over the periods of T c_n and of |T c_n|**2, n from 0 to multiples [m/s], [m2/s2]
      complex(dp), allocatable :: harmonic_sums(:)
      real(dp), allocatable :: harmonic_squares(:)
      !> Integrals of z' exp(-2 pi i n t/T) over the time in periods, of the present period [m/s]
      complex(dp), allocatable :: integrals(:)
      !> Values of z'' at its turns from node to node, where Fourier integrals are wanted [m/s2]
      real(dp), allocatable :: turns(:)
      integer :: turn_count = 0
   end type window_record_t

   public :: start_record, record_period, sums_of_record, momentum_gap, energy_gap

   !> Places of sums_of_record: powers of z'' from the first to the fourth, what the film carries beyond the static load, its square
   !> and its power, time unloaded; of each contact its impacts, of each their impulse; from the last one on squares of harmonics.
   integer, parameter, public :: sum_of_powers = 1, sum_beyond = 5, sum_of_power = 7, sum_unloaded = 8, sum_of_impacts = 9, &
                                 sum_of_impulses = sum_of_impacts + most_contacts, &
                                 sum_of_squares = sum_of_impulses + most_contacts

contains

   !> Start a record where its window begins. What is requested stays.
   pure subroutine start_record(start, record)
      !> State there
      type(motion_state_t), intent(in) :: start
      type(window_record_t), intent(inout) :: record

      record = window_record_t(wants=record%wants, multiples=record%multiples, &
                               loads=load_record_t(impact_limit=record%loads%impact_limit), start=start, &
                               end_velocity=start%numbers(of_velocity))
      if (record%multiples == 0) return
      record%longest_piece = oscillations_per_piece/real(record%multiples, dp)
      allocate (record%harmonic_sums(0:record%multiples), record%integrals(record%multiples), source=(0.0_dp, 0.0_dp))
      allocate (record%harmonic_squares(0:record%multiples), source=0.0_dp)
   end subroutine start_record

   !> Add a period, and forget its nodes.
   pure subroutine record_period(problem, end_velocity, nodes, record)
      type(problem_t), intent(in) :: problem
      !> z' at the end of the period [m/s]
      real(dp), intent(in) :: end_velocity
      !> Nodes of the period; none are left
      type(step_nodes_t), intent(inout) :: nodes
      type(window_record_t), intent(inout) :: record
      integer :: first, last

      if (record%loads%impact_limit > 0.0_dp .and. record%periods == 0) call start_loads(problem, record%loads)
      do first = 1, nodes%pieces, block_pieces
         last = min(first + block_pieces - 1, nodes%pieces)
         call record_pieces(problem, nodes%start(first:last), nodes%length(first:last), &
                            nodes%states(nodes_per_piece*(first - 1) + 1:nodes_per_piece*last, :), record)
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

      record%harmonic_sums(0) = record%harmonic_sums(0) + cmplx(change, 0.0_dp, dp)
      record%harmonic_squares(0) = record%harmonic_squares(0) + change*change
      do n = 1, record%multiples
         coefficient = cmplx(change, 0.0_dp, dp) + cmplx(0.0_dp, two_pi*real(n, dp), dp)*record%integrals(n)
         record%harmonic_sums(n) = record%harmonic_sums(n) + coefficient
         record%harmonic_squares(n) = record%harmonic_squares(n) + coefficient%re**2 + coefficient%im**2
      end do
      record%integrals = (0.0_dp, 0.0_dp)
   end subroutine add_coefficients

   !> Add some pieces of steps.
   pure subroutine record_pieces(problem, start, length, states, record)
      type(problem_t), intent(in) :: problem
      !> Phase where each begins, and its length [periods]
      real(dp), intent(in) :: start(:)
      real(dp), intent(in) :: length(:)
      !> States at the nodes
      real(dp), intent(in) :: states(:, :)
      type(window_record_t), intent(inout) :: record
      real(dp), dimension(block_nodes) :: phases, weights, values, loads, forces, cosine, sine, velocities
      real(dp) :: carried(block_nodes, most_contacts)
      real(dp) :: sum_of, size_of, square_of, film_work, force_work, work_size, period
      real(dp) :: static, beyond, cube_of, fourth_of, beyond_sum, beyond_square, beyond_power
      integer :: n, i, before, contact

      n = size(states, 1)
      velocities(:n) = states(:, of_velocity)
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
      do contact = 1, contact_count(problem)
         call contact_loads(problem, contact, states, carried(:n, contact))
         if (record%loads%impact_limit > 0.0_dp) call record_loads(problem, contact, record%periods, start, length, states, &
                                                                   carried(:n, contact), record%loads)
         call search(seen_loads(contact), carried(:n, contact), record)
         if (record%wants(seen_films(contact))) call search(seen_films(contact), contact_films(problem, contact, states), record)
      end do
      loads(:n) = carried(:n, 1)
      do contact = 2, contact_count(problem)
         loads(:n) = loads(:n) - carried(:n, contact)
      end do
      if (contact_count(problem) > 1) call search(seen_net_load, loads(:n), record)
      if (is_elastic(problem%contact)) call search(seen_position, gear_positions(problem, states), record)
      call forces_on_circle(problem%force, cosine(:n), sine(:n), forces(:n))
      !$omp simd
      do i = 1, n
         forces(i) = forces(i) + problem%weight
         values(i) = (loads(i) - forces(i))/problem%mass
      end do
      sum_of = 0.0_dp; size_of = 0.0_dp; square_of = 0.0_dp
      film_work = 0.0_dp; force_work = 0.0_dp; work_size = 0.0_dp
      !$omp simd reduction(+: sum_of, size_of, square_of, film_work, force_work, work_size)
      do i = 1, n
         sum_of = sum_of + weights(i)*values(i)
         size_of = size_of + weights(i)*abs(values(i))
         square_of = square_of + weights(i)*values(i)*values(i)
         film_work = film_work + weights(i)*loads(i)*velocities(i)
         force_work = force_work + weights(i)*forces(i)*velocities(i)
         work_size = work_size + weights(i)*(abs(loads(i)*velocities(i)) + abs(forces(i)*velocities(i)))
      end do
      static = static_load(problem)
      cube_of = 0.0_dp; fourth_of = 0.0_dp
      beyond_sum = 0.0_dp; beyond_square = 0.0_dp; beyond_power = 0.0_dp
      !$omp simd private(beyond) reduction(+: cube_of, fourth_of, beyond_sum, beyond_square, beyond_power)
      do i = 1, n
         cube_of = cube_of + weights(i)*values(i)*values(i)*values(i)
         fourth_of = fourth_of + weights(i)*values(i)*values(i)*values(i)*values(i)
         beyond = loads(i) - static
         beyond_sum = beyond_sum + weights(i)*beyond
         beyond_square = beyond_square + weights(i)*beyond*beyond
         beyond_power = beyond_power + weights(i)*beyond*velocities(i)
      end do
      period = 1.0_dp/problem%frequency
      record%shortest_piece = min(record%shortest_piece, minval(length))
      record%acceleration_sum = record%acceleration_sum + sum_of
      record%acceleration_size = record%acceleration_size + size_of
      record%acceleration_square = record%acceleration_square + square_of
      record%acceleration_cube = record%acceleration_cube + cube_of
      record%acceleration_fourth = record%acceleration_fourth + fourth_of
      record%beyond_static = record%beyond_static + beyond_sum
      record%beyond_static_square = record%beyond_static_square + beyond_square
      record%power_beyond_static = record%power_beyond_static + beyond_power
      record%film_work = record%film_work + film_work*period
      record%force_work = record%force_work + force_work*period
      record%work_size = record%work_size + work_size*period
      if (has_damped_teeth(problem)) record%tooth_loss = record%tooth_loss + &
                                                         dot_product(weights(:n), tooth_powers(problem, states))*period

      if (record%multiples > 0) then
         call add_integrals(weights(:n)*velocities(:n), cosine, sine, record%integrals)
         call add_turns(values(:n), record)
      end if
      call search(seen_velocity, velocities(:n), record)
      call search(seen_acceleration, values(:n), record)
      if (record%wants(seen_pressure)) then
         call largest_pressures(problem, states, values(:n))
         call search(seen_pressure, values(:n), record)
      end if

   contains

      !> Look for extremes of a quantity.
      pure subroutine search(quantity, numbers, record)
         integer, intent(in) :: quantity
         real(dp), contiguous, intent(in) :: numbers(:)
         type(window_record_t), intent(inout) :: record

         if (record%wants(quantity)) call find_extremes(problem, quantity, record%periods, start, length, states, &
                                                        numbers, record%lowest(quantity), record%highest(quantity))
      end subroutine search

   end subroutine record_pieces

   !> Add nodes to the Fourier integrals. The cosines and sines of the multiples follow from those of the two before:
   !> cos (k + 1)t = 2 cos t cos kt - cos (k - 1)t. Rounding grows with k squared, to 1e-12 at a hundred multiples.
   pure subroutine add_integrals(weighted, cosine, sine, integrals)
      !> z' times the weight of the node [m/s]
      real(dp), intent(in) :: weighted(:)
      !> Of 2 pi times the phases of the nodes
      real(dp), intent(in) :: cosine(block_nodes)
      real(dp), intent(in) :: sine(block_nodes)
      complex(dp), intent(inout) :: integrals(:)
      !> Multiples that are summed while a node is at hand
      integer, parameter :: together = 4
      real(dp), dimension(block_nodes) :: even_real, odd_real, even_imaginary, odd_imaginary, twice_cosine
      real(dp) :: real_1, real_2, real_3, real_4, imaginary_1, imaginary_2, imaginary_3, imaginary_4
      complex(dp) :: sums(together)
      integer :: i, k, last

      do i = 1, size(weighted)
         even_real(i) = weighted(i)
         odd_real(i) = weighted(i)*cosine(i)
         even_imaginary(i) = 0.0_dp
         odd_imaginary(i) = -weighted(i)*sine(i)
         twice_cosine(i) = 2.0_dp*cosine(i)
      end do
      do k = 1, size(integrals), together
         ! Sums with names of their own: those in an array are not kept in registers.
         real_1 = 0.0_dp; real_2 = 0.0_dp; real_3 = 0.0_dp; real_4 = 0.0_dp
         imaginary_1 = 0.0_dp; imaginary_2 = 0.0_dp; imaginary_3 = 0.0_dp; imaginary_4 = 0.0_dp
         !$omp simd reduction(+: real_1, real_2, real_3, real_4, imaginary_1, imaginary_2, imaginary_3, imaginary_4)
         do i = 1, size(weighted)
            real_1 = real_1 + odd_real(i)
            imaginary_1 = imaginary_1 + odd_imaginary(i)
            even_real(i) = twice_cosine(i)*odd_real(i) - even_real(i)
            even_imaginary(i) = twice_cosine(i)*odd_imaginary(i) - even_imaginary(i)
            real_2 = real_2 + even_real(i)
            imaginary_2 = imaginary_2 + even_imaginary(i)
            odd_real(i) = twice_cosine(i)*even_real(i) - odd_real(i)
            odd_imaginary(i) = twice_cosine(i)*even_imaginary(i) - odd_imaginary(i)
            real_3 = real_3 + odd_real(i)
            imaginary_3 = imaginary_3 + odd_imaginary(i)
            even_real(i) = twice_cosine(i)*odd_real(i) - even_real(i)
            even_imaginary(i) = twice_cosine(i)*odd_imaginary(i) - even_imaginary(i)
            real_4 = real_4 + even_real(i)
            imaginary_4 = imaginary_4 + even_imaginary(i)
            odd_real(i) = twice_cosine(i)*even_real(i) - odd_real(i)
            odd_imaginary(i) = twice_cosine(i)*even_imaginary(i) - odd_imaginary(i)
         end do
         sums = cmplx([real_1, real_2, real_3, real_4], [imaginary_1, imaginary_2, imaginary_3, imaginary_4], dp)
         last = min(k + together - 1, size(integrals))
         integrals(k:last) = integrals(k:last) + sums(:last - k + 1)
      end do
   end subroutine add_integrals

   !> Note where z'' turns from node to node.
   pure subroutine add_turns(values, record)
      real(dp), intent(in) :: values(:)
      type(window_record_t), intent(inout) :: record
      real(dp), allocatable :: longer(:)
      real(dp) :: last, before
      integer :: i

      ! Room for as many turns as there are values.
      if (.not. allocated(record%turns)) allocate (record%turns(size(values)))
      if (record%turn_count + size(values) > size(record%turns)) then
         allocate (longer(2*size(record%turns) + size(values)))
         longer(:record%turn_count) = record%turns(:record%turn_count)
         call move_alloc(longer, record%turns)
      end if
      associate (n => record%turn_count, turns => record%turns)
         do i = 1, size(values)
            if (n >= 2) then
               last = turns(n)
               before = turns(n - 1)
               ! A value on the way from the last turn to a farther one is no turn.
               if ((last - before)*(values(i) - last) >= 0.0_dp) n = n - 1
            end if
            n = n + 1
            turns(n) = values(i)
         end do
      end associate
   end subroutine add_turns

   !> Sums over the periods of a record that means are made of, by the places above.
   pure function sums_of_record(record) result(sums)
      type(window_record_t), intent(in) :: record
      real(dp) :: sums(sum_of_squares + record%multiples - 1)

      associate (impacts => record%loads%contacts)
         sums(:sum_of_squares - 1) = [record%acceleration_sum, record%acceleration_square, record%acceleration_cube, &
                                      record%acceleration_fourth, record%beyond_static, record%beyond_static_square, &
                                      record%power_beyond_static, record%loads%unloaded, real(impacts%count, dp), &
                                      impacts%impulse_sum]
      end associate
      if (record%multiples > 0) sums(sum_of_squares:) = record%harmonic_squares(1:)
   end function sums_of_record

   !> By how much the integral of z'' misses the change of z', as a share of the integral of |z''| [-].
   pure real(dp) function momentum_gap(record, frequency) result(gap)
      !> A record of one or more periods
      type(window_record_t), intent(in) :: record
      !> Frequency of the force [Hz]
      real(dp), intent(in) :: frequency

      gap = 0.0_dp
      if (record%acceleration_size > 0.0_dp) &
         gap = abs(record%acceleration_sum - (record%end_velocity - record%start%numbers(of_velocity))*frequency) &
               /record%acceleration_size
   end function momentum_gap

   !> By how much the works of film and force miss the change of kinetic energy, as a share of what went to and fro [-].
   pure real(dp) function energy_gap(record, mass) result(gap)
      !> A record of one or more periods
      type(window_record_t), intent(in) :: record
      !> Mass m [kg]
      real(dp), intent(in) :: mass
      real(dp) :: kinetic

      gap = 0.0_dp
      kinetic = 0.5_dp*mass*(record%end_velocity - record%start%numbers(of_velocity)) &
                *(record%end_velocity + record%start%numbers(of_velocity))
      if (record%work_size > 0.0_dp) gap = abs(record%film_work - record%force_work - kinetic)/record%work_size
   end function energy_gap

end module window_record
