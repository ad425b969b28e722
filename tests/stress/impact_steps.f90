!> The motion itself, by steps of the method of lobatto_rule in ln h and v,
!>
!>     (ln h)' = v/h ,   v' = (W(h, v) - F(t))/m - g ,
!>
!> so that an impact down to films of less than a picometre is a matter of more steps and of nothing else. The
!> time is in periods of the force. A step keeps its values at the nodes: what happens within it is their polynomial.
module impact_steps
   use film_law, only: film_load, film_t, overflow_load
   use kinds, only: dp
   use lobatto_rule, only: lobatto_rule_t, nodes, solve_linear
   use problem, only: problem_t
   implicit none(type, external)
   private

   !> What moves.
   type, public :: tooth_t
      type(film_t) :: film
      !> Mass [kg], static load Q + m g [N], frequency of the force [Hz]
      real(dp) :: mass = 0.0_dp, static_load = 0.0_dp, frequency = 0.0_dp
      !> Orders of the force that oscillates, from the first on: amplitudes [N] and phases [rad]
      real(dp), allocatable :: amplitudes(:), phases(:)
   end type tooth_t

   !> Where it is, and how far the next step is likely to go.
   type, public :: tooth_state_t
      !> h [m], v [m/s]
      real(dp) :: film = 0.0_dp, velocity = 0.0_dp
      !> Time since the start of the period, and length of the next step [periods]
      real(dp) :: phase = 0.0_dp, step = 1.0e-4_dp
   end type tooth_state_t

   !> A step that was taken.
   type, public :: tooth_step_t
      !> Where it starts, and its length [periods]
      real(dp) :: phase = 0.0_dp, length = 0.0_dp
      !> At the nodes: h [m], v [m/s], z'' [m/s2]
      real(dp), dimension(nodes) :: film = 0.0_dp, velocity = 0.0_dp, acceleration = 0.0_dp
   end type tooth_step_t

   !> A film and its velocity may be off by the tolerance within a step; at its end they are far better.
   integer, parameter :: most_passes = 12
   real(dp), parameter :: converged = 1.0e-10_dp, shortest = 1.0e-15_dp, two_pi = 6.28318530717958647692_dp

   public :: take_step, tooth_of_lane, acceleration_of, disturb

contains

   !> What moves, of a lane of the engine.
   pure function tooth_of_lane(lane) result(tooth)
      !> A scene
      type(problem_t), intent(in) :: lane
      type(tooth_t) :: tooth
      integer :: n

      tooth%film = lane%film
      tooth%mass = lane%mass
      tooth%static_load = lane%force%steady + lane%weight
      allocate (tooth%amplitudes(lane%force%highest), tooth%phases(lane%force%highest))
      call set_order(1, lane%force%cosine, lane%force%sine)
      do n = 2, lane%force%highest
         call set_order(n, lane%force%others(1, n), lane%force%others(2, n))
      end do
      tooth%frequency = lane%frequency

   contains

      !> An order from its factors of cosine and sine [N].
      pure subroutine set_order(order, cosine, sine)
         integer, intent(in) :: order
         real(dp), intent(in) :: cosine
         real(dp), intent(in) :: sine

         tooth%amplitudes(order) = hypot(cosine, sine)
         tooth%phases(order) = 0.0_dp
         if (tooth%amplitudes(order) > 0.0_dp) tooth%phases(order) = atan2(-sine, cosine)
      end subroutine set_order

   end function tooth_of_lane

   !> Disturb the force by a share of all of it.
   pure subroutine disturb(offset, tooth)
      !> [-]
      real(dp), intent(in) :: offset
      type(tooth_t), intent(inout) :: tooth

      tooth%static_load = tooth%static_load + offset*(tooth%static_load + sum(tooth%amplitudes))
   end subroutine disturb

   !> Static load and force [N].
   elemental real(dp) function force_of_tooth(tooth, phase) result(force)
      type(tooth_t), intent(in) :: tooth
      !> [periods]
      real(dp), intent(in) :: phase
      integer :: n

      force = tooth%static_load
      do n = 1, size(tooth%amplitudes)
         if (tooth%amplitudes(n) > 0.0_dp) &
            force = force + tooth%amplitudes(n)*cos(two_pi*real(n, dp)*phase + tooth%phases(n))
      end do
   end function force_of_tooth

   !> z'' [m/s2].
   pure real(dp) function acceleration_of(tooth, phase, film, velocity) result(acceleration)
      !> The tooth
      type(tooth_t), intent(in) :: tooth
      !> Time [periods]
      real(dp), intent(in) :: phase
      !> h [m], v [m/s]
      real(dp), intent(in) :: film
      real(dp), intent(in) :: velocity
      real(dp) :: load, by_film, by_velocity

      call film_load(tooth%film, film, velocity, load, by_film, by_velocity)
      acceleration = (load - force_of_tooth(tooth, phase))/tooth%mass
   end function acceleration_of

   !> Take the next step, as long as the tolerance allows and not beyond the end of the period.
   pure subroutine take_step(tooth, rule, tolerance, longest, state, step, taken)
      type(tooth_t), intent(in) :: tooth
      type(lobatto_rule_t), intent(in) :: rule
      !> Relative error that a step may have between its ends [-]
      real(dp), intent(in) :: tolerance
      !> Longest step [periods]
      real(dp), intent(in) :: longest
      !> Carried on
      type(tooth_state_t), intent(inout) :: state
      !> On entry the step before (length 0: none), on return the one taken
      type(tooth_step_t), intent(inout) :: step
      !> Without it there is no step, however short
      logical, intent(out) :: taken
      type(tooth_step_t) :: trial
      real(dp) :: length, error
      logical :: solved

      length = min(state%step, longest)
      do
         if (state%phase + 1.01_dp*length > 1.0_dp) length = 1.0_dp - state%phase
         call solve_step(tooth, rule, length, state, step, trial, error, solved)
         taken = solved .and. error <= tolerance
         if (taken) exit
         if (solved) then
            length = length*max(0.1_dp, 0.85_dp*(tolerance/error)**(1.0_dp/real(nodes, dp)))
         else
            length = 0.25_dp*length
         end if
         if (length < shortest) return
      end do
      step = trial
      state%film = step%film(nodes)
      state%velocity = step%velocity(nodes)
      state%phase = state%phase + length
      if (1.0_dp - state%phase < shortest) state%phase = 1.0_dp
      length = length*min(4.0_dp, 0.85_dp*(tolerance/max(error, 1.0e-30_dp))**(1.0_dp/real(nodes, dp)))
      ! A step that the end of the period has cut says nothing of the next one.
      if (state%phase >= 1.0_dp) length = max(length, min(state%step, longest))
      state%step = length
   end subroutine take_step

   !> Solve the equations of a step by Newton's method, and estimate its error.
   pure subroutine solve_step(tooth, rule, length, state, before, step, error, solved)
      type(tooth_t), intent(in) :: tooth
      type(lobatto_rule_t), intent(in) :: rule
      !> [periods]
      real(dp), intent(in) :: length
      type(tooth_state_t), intent(in) :: state
      type(tooth_step_t), intent(in) :: before
      type(tooth_step_t), intent(out) :: step
      !> Relative error between the ends [-]
      real(dp), intent(out) :: error
      logical, intent(out) :: solved
      real(dp), dimension(nodes) :: growth, gain, force, load, by_film, by_velocity, residual, slope
      real(dp) :: matrix(nodes, nodes), seconds, unit, change, last_change
      integer :: pass, i, j
      logical :: regular

      solved = .false.
      error = huge(1.0_dp)
      step%phase = state%phase
      step%length = length
      seconds = length/tooth%frequency
      force = force_of_tooth(tooth, state%phase + rule%node*length)
      call first_iterate(rule, length, state, before, growth, gain)
      last_change = huge(1.0_dp)
      do pass = 1, most_passes
         step%film = state%film*exp(growth)
         step%velocity = state%velocity + gain
         do i = 1, nodes
            call film_load(tooth%film, step%film(i), step%velocity(i), load(i), by_film(i), by_velocity(i))
         end do
         if (.not. all(abs(load) < overflow_load) .or. .not. all(step%film > 0.0_dp)) return
         ! differentiate*growth = seconds*v/h is solved for the change of v; that goes into
         ! differentiate*gain = seconds*acceleration, which is left for the change of growth.
         residual = matmul(rule%differentiate, growth) - seconds*step%velocity/step%film
         slope = seconds*step%velocity/step%film
         do j = 1, nodes
            matrix(:, j) = rule%differentiate(:, j)*step%film/seconds
            matrix(j, j) = matrix(j, j) + slope(j)*step%film(j)/seconds
         end do
         residual = residual*step%film/seconds
         step%acceleration = (load - force)/tooth%mass
         call correct(rule, seconds, residual, matrix, matmul(rule%differentiate, gain) - seconds*step%acceleration, &
                      seconds*by_velocity/tooth%mass, seconds*by_film*step%film/tooth%mass, growth, gain, change, regular, &
                      unit_of_velocity(tooth, step))
         if (.not. regular) return
         if (change < converged .or. (change < 1.0e-7_dp .and. change > 0.3_dp*last_change)) then
            solved = .true.
            exit
         end if
         last_change = change
      end do
      if (.not. solved) return
      step%film = state%film*exp(growth)
      step%velocity = state%velocity + gain
      step%acceleration = matmul(rule%differentiate, gain)/seconds
      unit = unit_of_velocity(tooth, step)
      error = max(tail(rule, matmul(rule%differentiate, growth)), tail(rule, matmul(rule%differentiate, gain))/unit)
      solved = error < huge(1.0_dp)
   end subroutine solve_step

   !> What a velocity is small against [m/s]: the largest of the step, and what changes the film within a period, or the load
   !> of (37), whose exponent counts velocities.
   pure real(dp) function unit_of_velocity(tooth, step) result(unit)
      type(tooth_t), intent(in) :: tooth
      type(tooth_step_t), intent(in) :: step

      unit = two_pi*tooth%frequency*maxval(step%film)
      if (tooth%film%rate > 0.0_dp) unit = min(unit, 1.0_dp/tooth%film%rate)
      unit = unit + maxval(abs(step%velocity))
   end function unit_of_velocity

   !> Change by what the polynomial through the slopes at the nodes is likely to lack.
   pure real(dp) function tail(rule, slopes)
      type(lobatto_rule_t), intent(in) :: rule
      !> Slopes times the step
      real(dp), intent(in) :: slopes(nodes)
      real(dp) :: last(2)

      last = abs(matmul(rule%to_legendre(nodes - 1:, :), slopes))
      tail = max(last(2), 0.1_dp*last(1))/real(2*nodes, dp)
   end function tail

   !> One pass of Newton's method.
   pure subroutine correct(rule, seconds, residual, matrix, imbalance, damping, stiffness, growth, gain, change, regular, unit)
      type(lobatto_rule_t), intent(in) :: rule
      real(dp), intent(in) :: seconds
      !> Change of v is this and the matrix times the change of growth
      real(dp), intent(in) :: residual(nodes)
      real(dp), intent(in) :: matrix(nodes, nodes)
      !> What is left of the equation of motion, and its slopes
      real(dp), intent(in) :: imbalance(nodes)
      real(dp), intent(in) :: damping(nodes)
      real(dp), intent(in) :: stiffness(nodes)
      !> Corrected
      real(dp), intent(inout) :: growth(nodes)
      real(dp), intent(inout) :: gain(nodes)
      !> Largest relative correction
      real(dp), intent(out) :: change
      !> Whether there was one
      logical, intent(out) :: regular
      !> [m/s]
      real(dp), intent(in) :: unit
      real(dp) :: resistance(nodes, nodes), equations(nodes, nodes), unknown(nodes), gained(nodes), largest
      integer :: i

      resistance = rule%differentiate
      do i = 1, nodes
         resistance(i, i) = resistance(i, i) - damping(i)
      end do
      equations = matmul(resistance, matrix)
      do i = 1, nodes
         equations(i, i) = equations(i, i) - stiffness(i)
      end do
      unknown = -imbalance - matmul(resistance, residual)
      call solve_linear(equations, unknown, regular)
      largest = maxval(abs(unknown))
      regular = regular .and. largest < 1.0e3_dp .and. seconds > 0.0_dp
      if (.not. regular) return
      gained = residual + matmul(matrix, unknown)
      change = max(largest, maxval(abs(gained))/unit)
      if (largest > 2.0_dp) then
         unknown = unknown*2.0_dp/largest
         gained = gained*2.0_dp/largest
      end if
      growth = growth + unknown
      gain = gain + gained
   end subroutine correct

   !> The polynomial of the step before, carried on, or a standstill.
   pure subroutine first_iterate(rule, length, state, before, growth, gain)
      type(lobatto_rule_t), intent(in) :: rule
      real(dp), intent(in) :: length
      type(tooth_state_t), intent(in) :: state
      type(tooth_step_t), intent(in) :: before
      real(dp), intent(out) :: growth(nodes)
      real(dp), intent(out) :: gain(nodes)
      real(dp) :: logarithm(nodes), basis(nodes)
      integer :: i

      growth = 0.0_dp
      gain = 0.0_dp
      if (.not. before%length > 0.0_dp) return
      if (length > 1.5_dp*before%length) return
      logarithm = log(before%film/state%film)
      do i = 1, nodes
         basis = lagrange(rule, 1.0_dp + rule%node(i)*length/before%length)
         growth(i) = dot_product(basis, logarithm)
         gain(i) = dot_product(basis, before%velocity - state%velocity)
      end do
      if (maxval(abs(growth)) > 1.0_dp) then
         growth = 0.0_dp
         gain = 0.0_dp
      end if
   end subroutine first_iterate

   !> Values at c of the polynomials that are one at a node and zero at the others.
   pure function lagrange(rule, c) result(basis)
      type(lobatto_rule_t), intent(in) :: rule
      real(dp), intent(in) :: c
      real(dp) :: basis(nodes)
      integer :: i, j

      basis = 1.0_dp
      do i = 1, nodes
         do j = 1, nodes
            if (j /= i) basis(i) = basis(i)*(c - rule%node(j))/(rule%node(i) - rule%node(j))
         end do
      end do
   end function lagrange

end module impact_steps
