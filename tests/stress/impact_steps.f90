!> The motion itself, by steps of the method of lobatto_rule in ln h and v,
!>
!>     (ln h)' = v/h ,   v' = (W(h, v) - F(t))/m - g ,
!>
!> so that an impact down to films of less than a picometre is a matter of more steps and of nothing else. Between two flanks
!> the variable is ln(h/(b - h)), so that both films have all their digits. The
!> time is in periods of the force. A step keeps its values at the nodes: what happens within it is their polynomial.
!>
!> With elastic teeth each film has its logarithm and its spring a compression d,
!>
!>     h' = w(h, d k) ,   (d + b(h, d k))' = h' - v ,   v' = (d_1 k - d_2 k - F(t))/m - g ,
!>
!> with w the velocity at which the film carries the load, or W(h, h') = d k where it may pull, and b what flanks that bend give by
!> their width beside the springs, 0 of others; at the coast flank the
!> velocity of the gear counts backwards. After each step the thicker film is what the thinner one, the springs and the backlash
!> leave of the backlash.
module impact_steps
   use engine, only: motion_state_t
   use film_law, only: film_load, film_over_gap, film_t, never_pulls, overflow_load, squeeze_velocity, width_compression
   use kinds, only: dp
   use lobatto_rule, only: lobatto_rule_t, nodes, solve_linear
   use problem, only: of_drive_compression, of_film, of_velocity, problem_t
   use squeeze_of_load, only: load_carried
   implicit none(type, external)
   private

   !> What moves.
   type, public :: tooth_t
      type(film_t) :: film
      !> Mass [kg], static load Q + m g [N], frequency of the force [Hz]
      real(dp) :: mass = 0.0_dp, static_load = 0.0_dp, frequency = 0.0_dp
      !> Backlash [m], huge: one flank; compliance of a tooth [m/N], 0: rigid
      real(dp) :: backlash = huge(1.0_dp), compliance = 0.0_dp
      !> Orders of the force that oscillates, from the first on: amplitudes [N] and phases [rad]
      real(dp), allocatable :: amplitudes(:), phases(:)
   end type tooth_t

   !> Where it is, and how far the next step is likely to go.
   type, public :: tooth_state_t
      !> h [m], v of the gear [m/s]
      real(dp) :: film = 0.0_dp, velocity = 0.0_dp
      !> Film of the coast flank, huge where there is none, and compressions of the springs [m]
      real(dp) :: coast = huge(1.0_dp), compression(2) = 0.0_dp
      !> Time since the start of the period, and length of the next step [periods]
      real(dp) :: phase = 0.0_dp, step = 1.0e-4_dp
   end type tooth_state_t

   !> A step that was taken.
   type, public :: tooth_step_t
      !> Where it starts, and its length [periods]
      real(dp) :: phase = 0.0_dp, length = 0.0_dp
      !> At the nodes: h [m], v [m/s], z'' [m/s2]
      real(dp), dimension(nodes) :: film = 0.0_dp, velocity = 0.0_dp, acceleration = 0.0_dp
      !> Film of the coast flank and compressions [m]
      real(dp) :: coast(nodes) = huge(1.0_dp), compression(nodes, 2) = 0.0_dp
   end type tooth_step_t

   !> A film and its velocity may be off by the tolerance within a step; at its end they are far better.
   integer, parameter :: most_passes = 12
   real(dp), parameter :: converged = 1.0e-10_dp, last_rise = 0.5_dp, shortest = 1.0e-15_dp, two_pi = 6.28318530717958647692_dp

   public :: take_step, tooth_of_lane, start_of_tooth, disturb, has_coast

contains

   !> What moves, of a lane of the engine.
   pure function tooth_of_lane(lane) result(tooth)
      !> A scene
      type(problem_t), intent(in) :: lane
      type(tooth_t) :: tooth
      integer :: n

      tooth%film = lane%contact%film
      tooth%mass = lane%mass
      tooth%static_load = lane%force%steady + lane%weight
      tooth%backlash = lane%backlash
      tooth%compliance = lane%contact%compliance
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

   !> Where a motion starts, its film disturbed.
   pure function start_of_tooth(lane, start, offset) result(state)
      !> A scene
      type(problem_t), intent(in) :: lane
      !> Film, velocity and compressions
      type(motion_state_t), intent(in) :: start
      !> [-]
      real(dp), intent(in) :: offset
      type(tooth_state_t) :: state

      state%film = start%numbers(of_film)*(1.0_dp + offset)
      state%velocity = start%numbers(of_velocity)
      state%compression = 0.0_dp
      state%compression(:size(start%numbers) - of_velocity) = start%numbers(of_drive_compression:)
      if (.not. lane%backlash < huge(1.0_dp)) return
      state%coast = lane%backlash - state%film
      if (lane%contact%compliance > 0.0_dp) state%coast = thicker_film(tooth_of_lane(lane), state%film, state%compression, 1)
   end function start_of_tooth

   !> Film of the other flank: what the backlash, the film of one flank and all that gives leave.
   pure real(dp) function thicker_film(tooth, thinner, compression, flank) result(film)
      type(tooth_t), intent(in) :: tooth
      !> [m]
      real(dp), intent(in) :: thinner
      !> Of the springs of both flanks [m]
      real(dp), intent(in) :: compression(2)
      !> That of the given film
      integer, intent(in) :: flank
      real(dp) :: width, by_film, by_load, gap

      call width_compression(tooth%film, thinner, compression(flank)/tooth%compliance, width, by_film, by_load)
      gap = tooth%backlash - thinner + sum(compression) + width
      film = film_over_gap(tooth%film, gap, compression(3 - flank)/tooth%compliance, gap)
   end function thicker_film

   !> Disturb the force by a share of all of it.
   pure subroutine disturb(offset, tooth)
      !> [-]
      real(dp), intent(in) :: offset
      type(tooth_t), intent(inout) :: tooth

      tooth%static_load = tooth%static_load + offset*(abs(tooth%static_load) + sum(tooth%amplitudes))
   end subroutine disturb

   !> Whether there is a coast flank.
   pure logical function has_coast(tooth)
      type(tooth_t), intent(in) :: tooth

      has_coast = tooth%backlash < huge(1.0_dp)
   end function has_coast

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
         if (tooth%compliance > 0.0_dp) then
            call solve_elastic_step(tooth, rule, length, state, step, trial, error, solved)
         else
            call solve_step(tooth, rule, length, state, step, trial, error, solved)
         end if
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
      state%coast = step%coast(nodes)
      state%compression = step%compression(nodes, :)
      if (has_coast(tooth) .and. tooth%compliance > 0.0_dp) then
         if (state%film > state%coast) then
            state%film = thicker_film(tooth, state%coast, state%compression, 2)
         else
            state%coast = thicker_film(tooth, state%film, state%compression, 1)
         end if
      end if
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
      real(dp), dimension(nodes) :: growth, gain, force, load, by_film, by_velocity, residual, slope, scale
      real(dp) :: coast_load, coast_by_film, coast_by_velocity
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
         call set_films(tooth, state, growth, step)
         step%velocity = state%velocity + gain
         scale = step%film
         if (has_coast(tooth)) scale = step%film*(step%coast/tooth%backlash)
         do i = 1, nodes
            call film_load(tooth%film, step%film(i), step%velocity(i), load(i), by_film(i), by_velocity(i))
            if (.not. has_coast(tooth)) cycle
            call film_load(tooth%film, step%coast(i), -step%velocity(i), coast_load, coast_by_film, coast_by_velocity)
            if (.not. (abs(coast_load) < overflow_load .and. abs(load(i)) < overflow_load)) return
            load(i) = load(i) - coast_load
            by_film(i) = by_film(i) + coast_by_film
            by_velocity(i) = by_velocity(i) + coast_by_velocity
         end do
         if (.not. all(abs(load) < overflow_load) .or. .not. all(step%film > 0.0_dp)) return
         ! differentiate*growth = seconds*v/h is solved for the change of v; that goes into
         ! differentiate*gain = seconds*acceleration, which is left for the change of growth.
         residual = matmul(rule%differentiate, growth) - seconds*step%velocity/scale
         slope = seconds*step%velocity/scale
         if (has_coast(tooth)) slope = slope*((step%coast - step%film)/tooth%backlash)
         do j = 1, nodes
            matrix(:, j) = rule%differentiate(:, j)*scale/seconds
            matrix(j, j) = matrix(j, j) + slope(j)*scale(j)/seconds
         end do
         residual = residual*scale/seconds
         step%acceleration = (load - force)/tooth%mass
         call correct(rule, seconds, residual, matrix, matmul(rule%differentiate, gain) - seconds*step%acceleration, &
                      seconds*by_velocity/tooth%mass, seconds*by_film*scale/tooth%mass, growth, gain, change, regular, &
                      unit_of_velocity(tooth, step, reshape([step%film, step%coast], [nodes, 2])))
         if (.not. regular) return
         if (change < converged .or. (change < 1.0e-7_dp .and. change > 0.3_dp*last_change)) then
            solved = .true.
            exit
         end if
         last_change = change
      end do
      if (.not. solved) return
      call set_films(tooth, state, growth, step)
      step%velocity = state%velocity + gain
      step%acceleration = matmul(rule%differentiate, gain)/seconds
      unit = unit_of_velocity(tooth, step, reshape([step%film, step%coast], [nodes, 2]))
      error = max(tail(rule, matmul(rule%differentiate, growth)), tail(rule, matmul(rule%differentiate, gain))/unit)
      solved = error < huge(1.0_dp)
   end subroutine solve_step

   !> Films of a rigid tooth, from what its variable has grown by.
   pure subroutine set_films(tooth, state, growth, step)
      type(tooth_t), intent(in) :: tooth
      type(tooth_state_t), intent(in) :: state
      real(dp), intent(in) :: growth(nodes)
      type(tooth_step_t), intent(inout) :: step
      real(dp) :: share(nodes)

      step%film = state%film*exp(growth)
      if (.not. has_coast(tooth)) return
      ! h/(b - h) grows by exp(growth).
      share = 1.0_dp/(state%film*exp(growth) + state%coast)
      step%film = tooth%backlash*(state%film*exp(growth)*share)
      step%coast = tooth%backlash*(state%coast*share)
   end subroutine set_films

   !> Solve the equations of a step of a elastic tooth by Newton's method, and estimate its error. The unknowns are, node by
   !> node, what has been added to v, to ln h and d of the drive flank, and to those of the coast flank; the changes of d follow from
   !> the others.
   pure subroutine solve_elastic_step(tooth, rule, length, state, before, step, error, solved)
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
      real(dp), allocatable :: added(:, :), correction(:)
      real(dp), allocatable, target :: matrix(:, :)
      real(dp), pointer :: place(:, :)
      real(dp), dimension(nodes) :: force, drift, wanted, by_film, by_load, right
      real(dp), dimension(nodes) :: width, width_by_film, width_by_load, share
      real(dp) :: pressed(nodes, 2), by_growth(nodes, nodes, 2), by_gain(nodes, nodes, 2), start_width(2), slopes(2, 2), turned
      real(dp) :: films(nodes, 2), loads(nodes, 2), starts(2), unit, seconds, change, last_change, turn, spring(2), largest, load, &
                  load_by_film, load_by_velocity
      integer :: flanks, flank, logarithm, compression, pass, i, outcome
      logical :: regular, failed, rising

      solved = .false.
      error = huge(1.0_dp)
      step%phase = state%phase
      step%length = length
      seconds = length/tooth%frequency
      flanks = merge(2, 1, has_coast(tooth))
      starts = [state%film, state%coast]
      start_width = 0.0_dp
      call width_compression(tooth%film, starts(:flanks), state%compression(:flanks)/tooth%compliance, start_width(:flanks), &
                             slopes(:flanks, 1), slopes(:flanks, 2))
      force = force_of_tooth(tooth, state%phase + rule%node*length)
      allocate (added(nodes, 1 + 2*flanks), source=0.0_dp)
      call first_added(rule, length, state, before, flanks, added)
      allocate (matrix(nodes*(1 + flanks), nodes*(1 + flanks)), correction(nodes*(1 + flanks)))
      last_change = huge(1.0_dp)
      do pass = 1, 2*most_passes
         step%velocity = state%velocity + added(:, 1)
         do flank = 1, flanks
            films(:, flank) = starts(flank)*exp(added(:, 2*flank))
            loads(:, flank) = (state%compression(flank) + added(:, 2*flank + 1))/tooth%compliance
         end do
         matrix = 0.0_dp
         right = seconds*(loads(:, 1) - force)/tooth%mass - matmul(rule%differentiate, added(:, 1))
         if (flanks == 2) right = right - seconds*loads(:, 2)/tooth%mass
         turned = seconds/(tooth%mass*tooth%compliance)
         matrix(:nodes, :nodes) = rule%differentiate
         do flank = 1, flanks
            turn = real(3 - 2*flank, dp)
            logarithm = 2*flank
            compression = 2*flank + 1
            ! Drift: h' of the polynomial.
            drift = films(:, flank)*matmul(rule%differentiate, added(:, logarithm))/seconds
            do i = 1, nodes
               if (never_pulls(tooth%film)) then
                  call squeeze_velocity(tooth%film, films(i, flank), loads(i, flank), drift(i), wanted(i), by_film(i), by_load(i), &
                                        outcome)
                  if (outcome /= load_carried) return
               else
                  call film_load(tooth%film, films(i, flank), drift(i), load, load_by_film, load_by_velocity)
                  if (.not. (abs(load) < overflow_load .and. load_by_velocity < 0.0_dp)) return
                  wanted(i) = drift(i) + (loads(i, flank) - load)/load_by_velocity
                  by_film(i) = -load_by_film/load_by_velocity
                  by_load(i) = 1.0_dp/load_by_velocity
               end if
            end do
            ! (d + b)' = h' - v gives the change of d by those of ln h and v: pressed + by_growth*(change of ln h) - by_gain*(that
            ! of v).
            call width_compression(tooth%film, films(:, flank), loads(:, flank), width, width_by_film, width_by_load)
            share = 1.0_dp/(1.0_dp + width_by_load/tooth%compliance)
            pressed(:, flank) = share*(matmul(rule%integrate, seconds*(drift - turn*step%velocity)) - added(:, compression) &
                                       - (width - start_width(flank)))
            do i = 1, nodes
               by_growth(i, :, flank) = films(i, flank)*rule%differentiate(i, :)
               by_growth(i, i, flank) = by_growth(i, i, flank) + seconds*drift(i)
            end do
            by_growth(:, :, flank) = matmul(rule%integrate, by_growth(:, :, flank))
            do i = 1, nodes
               by_growth(i, i, flank) = by_growth(i, i, flank) - width_by_film(i)*films(i, flank)
               by_growth(i, :, flank) = share(i)*by_growth(i, :, flank)
               by_gain(i, :, flank) = turn*seconds*share(i)*rule%integrate(i, :)
            end do
            matrix(:nodes, :nodes) = matrix(:nodes, :nodes) + turn*turned*by_gain(:, :, flank)
            right = right + turn*turned*pressed(:, flank)
            by_load = seconds*by_load/(films(:, flank)*tooth%compliance)
            correction(nodes*flank + 1:nodes*(flank + 1)) = seconds*wanted/films(:, flank) + by_load*pressed(:, flank) &
                                                            - matmul(rule%differentiate, added(:, logarithm))
            place => matrix(:nodes, nodes*flank + 1:nodes*(flank + 1))
            place = -turn*turned*by_growth(:, :, flank)
            place => matrix(nodes*flank + 1:nodes*(flank + 1), :nodes)
            do i = 1, nodes
               place(i, :) = by_load(i)*by_gain(i, :, flank)
            end do
            place => matrix(nodes*flank + 1:nodes*(flank + 1), nodes*flank + 1:nodes*(flank + 1))
            do i = 1, nodes
               place(i, :) = rule%differentiate(i, :) - by_load(i)*by_growth(i, :, flank)
               place(i, i) = place(i, i) + seconds*(drift(i)/films(i, flank) - by_film(i))
            end do
         end do
         correction(:nodes) = right
         if (.not. all(abs(correction) < huge(1.0_dp))) return
         call solve_dense(size(correction), matrix, correction, regular)
         if (.not. regular) return
         do flank = 1, flanks
            pressed(:, flank) = pressed(:, flank) + matmul(by_growth(:, :, flank), correction(nodes*flank + 1:nodes*(flank + 1))) &
                                - matmul(by_gain(:, :, flank), correction(:nodes))
         end do
         unit = unit_of_velocity(tooth, step, films)
         change = maxval(abs(correction(:nodes)))/unit
         largest = 1.0_dp
         rising = .false.
         do flank = 1, flanks
            spring(flank) = maxval(abs(loads(:, flank)))*tooth%compliance
            associate (grown => correction(nodes*flank + 1:nodes*(flank + 1)), pressed => pressed(:, flank))
               change = max(change, maxval(abs(grown)), maxval(abs(pressed))/max(spring(flank), 1.0e-12_dp*minval(films)))
               largest = min(largest, 2.0_dp/max(2.0_dp, maxval(abs(grown))))
               ! The load of a film that never pulls stays one, and a pass that has to raise it by much is not the last.
               if (never_pulls(tooth%film)) then
                  failed = any(loads(:, flank) <= 0.0_dp)
                  if (failed) return
                  rising = rising .or. any(pressed > last_rise*tooth%compliance*loads(:, flank))
                  largest = min(largest, 0.9_dp/max(0.9_dp, maxval(-pressed/(tooth%compliance*loads(:, flank)))))
               end if
            end associate
         end do
         if (.not. change < huge(1.0_dp)) return
         added(:, 1) = added(:, 1) + largest*correction(:nodes)
         do flank = 1, flanks
            added(:, 2*flank) = added(:, 2*flank) + largest*correction(nodes*flank + 1:nodes*(flank + 1))
            added(:, 2*flank + 1) = added(:, 2*flank + 1) + largest*pressed(:, flank)
         end do
         if (rising) cycle
         if (change < converged .or. (change < 1.0e-7_dp .and. change > 0.3_dp*last_change)) then
            solved = .true.
            exit
         end if
         if (pass > most_passes .and. change > 0.5_dp*last_change .and. largest >= 1.0_dp) return
         last_change = change
      end do
      if (.not. solved) return
      step%velocity = state%velocity + added(:, 1)
      step%acceleration = matmul(rule%differentiate, added(:, 1))/seconds
      do flank = 1, flanks
         films(:, flank) = starts(flank)*exp(added(:, 2*flank))
         step%compression(:, flank) = state%compression(flank) + added(:, 2*flank + 1)
      end do
      step%film = films(:, 1)
      if (flanks == 2) step%coast = films(:, 2)
      unit = unit_of_velocity(tooth, step, films)
      error = tail(rule, matmul(rule%differentiate, added(:, 1)))/unit
      do flank = 1, flanks
         error = max(error, tail(rule, matmul(rule%differentiate, added(:, 2*flank))), &
                     tail(rule, matmul(rule%differentiate, added(:, 2*flank + 1)))/minval(films(:, :flanks)))
      end do
      solved = error < huge(1.0_dp)
   end subroutine solve_elastic_step

   !> The polynomials of the step before, carried on, or a standstill.
   pure subroutine first_added(rule, length, state, before, flanks, added)
      type(lobatto_rule_t), intent(in) :: rule
      real(dp), intent(in) :: length
      type(tooth_state_t), intent(in) :: state
      type(tooth_step_t), intent(in) :: before
      integer, intent(in) :: flanks
      real(dp), intent(inout) :: added(:, :)
      real(dp) :: basis(nodes)
      integer :: i, flank

      if (.not. before%length > 0.0_dp) return
      if (length > 1.5_dp*before%length) return
      do i = 1, nodes
         basis = lagrange(rule, 1.0_dp + rule%node(i)*length/before%length)
         added(i, 1) = dot_product(basis, before%velocity - state%velocity)
         added(i, 2) = dot_product(basis, log(before%film/before%film(nodes)))
         if (flanks == 2) added(i, 4) = dot_product(basis, log(before%coast/before%coast(nodes)))
         do flank = 1, flanks
            added(i, 2*flank + 1) = dot_product(basis, before%compression(:, flank) - state%compression(flank))
         end do
      end do
      do flank = 1, flanks
         if (maxval(abs(added(:, 2*flank))) > 1.0_dp) added = 0.0_dp
         if (any(state%compression(flank) > 0.0_dp .and. added(:, 2*flank + 1) < -0.9_dp*state%compression(flank))) added = 0.0_dp
      end do
   end subroutine first_added

   !> Gauss's elimination with a search for the pivot, down columns, four rows at a time; rows are scaled by their largest number
   !> first.
   pure subroutine solve_dense(n, matrix, unknown, solved)
      !> Number of equations, a multiple of four
      integer, intent(in) :: n
      real(dp), intent(inout) :: matrix(n, n)
      !> Right-hand side, on return the solution
      real(dp), intent(inout) :: unknown(n)
      logical, intent(out) :: solved
      real(dp) :: scale(n), factor(n), held
      integer :: k, i, j, four, pivot

      solved = .false.
      scale = 0.0_dp
      do j = 1, n
         scale = max(scale, abs(matrix(:, j)))
      end do
      if (.not. (all(scale > 0.0_dp) .and. all(scale < huge(1.0_dp)))) return
      do j = 1, n
         matrix(:, j) = matrix(:, j)/scale
      end do
      unknown = unknown/scale
      do k = 1, n
         pivot = k
         do i = k + 1, n
            if (abs(matrix(i, k)) > abs(matrix(pivot, k))) pivot = i
         end do
         if (.not. abs(matrix(pivot, k)) > 0.0_dp) return
         if (pivot /= k) then
            do j = k, n
               held = matrix(k, j)
               matrix(k, j) = matrix(pivot, j)
               matrix(pivot, j) = held
            end do
            unknown([k, pivot]) = unknown([pivot, k])
         end if
         factor(:k) = 0.0_dp
         factor(k + 1:) = matrix(k + 1:, k)/matrix(k, k)
         do j = k + 1, n
            held = matrix(k, j)
            if (.not. abs(held) > 0.0_dp) cycle
            do four = 4*(k/4), n - 1, 4
               !$omp simd
               do i = 1, 4
                  matrix(four + i, j) = matrix(four + i, j) - held*factor(four + i)
               end do
            end do
         end do
         unknown = unknown - unknown(k)*factor
      end do
      do k = n, 1, -1
         unknown(k) = unknown(k)/matrix(k, k)
         unknown(:k - 1) = unknown(:k - 1) - unknown(k)*matrix(:k - 1, k)
      end do
      solved = .true.
   end subroutine solve_dense

   !> What a velocity is small against [m/s]: the largest of the step, and what changes the film within a period, or the load
   !> of (37), whose exponent counts velocities.
   pure real(dp) function unit_of_velocity(tooth, step, films) result(unit)
      type(tooth_t), intent(in) :: tooth
      type(tooth_step_t), intent(in) :: step
      !> Of both flanks [m]
      real(dp), intent(in) :: films(nodes, 2)

      unit = two_pi*tooth%frequency*maxval(films(:, 1))
      if (has_coast(tooth)) unit = two_pi*tooth%frequency*maxval(minval(films, dim=2))
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
      logarithm = log(before%film/state%film) - log(before%coast/state%coast)
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
