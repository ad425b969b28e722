!> What a window of the reference motion amounts to: extremes within the steps, lines and power by integrals over them.
module impact_window
   use impact_steps, only: has_coast, tooth_state_t, tooth_step_t, tooth_t, take_step
   use kinds, only: dp
   use lobatto_rule, only: legendre, lobatto_rule_t, nodes
   implicit none(type, external)
   private

   !> Lines of the force's frequency that are integrated, and the longest step for that [periods]. A step of a tenth of a
   !> period of its highest order is short enough for the force without a window.
   integer, parameter, public :: integrated_harmonics = 64
   real(dp), parameter :: longest_in_window = 1.0_dp/64.0_dp, longest = 0.1_dp
   !> More steps are not waited for.
   integer, parameter :: most_steps = 300000
   real(dp), parameter :: two_pi = 6.28318530717958647692_dp

   !> A window.
   type, public :: impact_window_t
      !> Whole periods
      integer :: periods = 0
      !> ln h, least and largest; z'' [m/s2]
      real(dp) :: logarithm(2) = [huge(1.0_dp), -huge(1.0_dp)], acceleration(2) = [huge(1.0_dp), -huge(1.0_dp)]
      !> and of the coast film
      real(dp) :: coast(2) = [huge(1.0_dp), -huge(1.0_dp)]
      !> Amplitudes of z'' at multiples of the frequency of the force over `divisions` [m/s2]
      integer :: divisions = 1
      real(dp), allocatable :: amplitudes(:)
      !> Twice the mean square of z'' about its mean, and its mean [m2/s4], [m/s2]
      real(dp) :: power = 0.0_dp, mean = 0.0_dp
      !> States at its start and after each period
      type(tooth_state_t), allocatable :: states(:)
   end type impact_window_t

   public :: solve_periods, solve_impact_window

contains

   !> Solve periods without looking at them.
   pure subroutine solve_periods(tooth, rule, tolerance, periods, state, solved)
      type(tooth_t), intent(in) :: tooth
      type(lobatto_rule_t), intent(in) :: rule
      !> Of take_step
      real(dp), intent(in) :: tolerance
      integer, intent(in) :: periods
      !> Carried on
      type(tooth_state_t), intent(inout) :: state
      logical, intent(out) :: solved
      type(tooth_step_t) :: step
      integer :: period, steps

      solved = .true.
      steps = 0
      do period = 1, periods
         state%phase = 0.0_dp
         do while (state%phase < 1.0_dp)
            call take_step(tooth, rule, tolerance, longest/real(size(tooth%amplitudes), dp), state, step, solved)
            steps = steps + 1
            solved = solved .and. steps <= most_steps
            if (.not. solved) return
         end do
      end do
   end subroutine solve_periods

   !> Solve periods and look at them.
   pure subroutine solve_impact_window(tooth, rule, tolerance, periods, divisions, state, window, solved)
      type(tooth_t), intent(in) :: tooth
      type(lobatto_rule_t), intent(in) :: rule
      real(dp), intent(in) :: tolerance
      integer, intent(in) :: periods
      !> 1: lines at multiples of the frequency only; the periods: all of the window
      integer, intent(in) :: divisions
      type(tooth_state_t), intent(inout) :: state
      type(impact_window_t), intent(out) :: window
      logical, intent(out) :: solved
      type(tooth_step_t) :: step
      complex(dp), allocatable :: lines(:)
      real(dp) :: square, gained
      integer :: period, steps, n

      window%periods = periods
      window%divisions = divisions
      allocate (window%states(0:periods))
      window%states(0) = state
      allocate (lines(integrated_harmonics*divisions), source=(0.0_dp, 0.0_dp))
      solved = .true.
      square = 0.0_dp
      steps = 0
      do period = 1, periods
         state%phase = 0.0_dp
         do while (state%phase < 1.0_dp)
            call take_step(tooth, rule, tolerance, min(longest_in_window, longest/real(size(tooth%amplitudes), dp)), state, step, &
                           solved)
            steps = steps + 1
            solved = solved .and. steps <= most_steps
            if (.not. solved) return
            call note_extremes(rule, log(step%film), window%logarithm)
            if (has_coast(tooth)) call note_extremes(rule, log(step%coast), window%coast)
            call note_extremes(rule, step%acceleration, window%acceleration)
            square = square + step%length*dot_product(rule%weight, step%acceleration**2)
            call add_lines(rule, step, real(period - 1, dp), divisions, lines)
         end do
         window%states(period) = state
      end do
      ! The line of z'' is that of v, times its angular frequency, and what v has gained over the window.
      gained = window%states(periods)%velocity - window%states(0)%velocity
      window%mean = gained*tooth%frequency/real(periods, dp)
      window%power = 2.0_dp*(square/real(periods, dp) - window%mean**2)
      allocate (window%amplitudes(size(lines)))
      do n = 1, size(lines)
         window%amplitudes(n) = 2.0_dp*tooth%frequency/real(periods, dp)* &
                                abs(gained + cmplx(0.0_dp, two_pi*real(n, dp)/real(divisions, dp), dp)*lines(n))
      end do
   end subroutine solve_impact_window

   !> Add the integral of v times the turning exponential of each line.
   pure subroutine add_lines(rule, step, whole, divisions, lines)
      type(lobatto_rule_t), intent(in) :: rule
      type(tooth_step_t), intent(in) :: step
      !> Periods before the one of the step
      real(dp), intent(in) :: whole
      integer, intent(in) :: divisions
      complex(dp), intent(inout) :: lines(:)
      complex(dp), dimension(nodes) :: turn, turned
      real(dp) :: angle(nodes)
      integer :: n

      angle = two_pi*(whole + step%phase + rule%node*step%length)/real(divisions, dp)
      turn = cmplx(cos(angle), -sin(angle), dp)
      turned = step%length*rule%weight*step%velocity
      do n = 1, size(lines)
         turned = turned*turn
         lines(n) = lines(n) + sum(turned)
      end do
   end subroutine add_lines

   !> Widen a range by the polynomial through the values at the nodes.
   pure subroutine note_extremes(rule, values, range)
      type(lobatto_rule_t), intent(in) :: rule
      real(dp), intent(in) :: values(nodes)
      real(dp), intent(inout) :: range(2)
      real(dp), parameter :: beyond = 0.2_dp
      real(dp) :: least, largest, margin

      least = minval(values)
      largest = maxval(values)
      margin = beyond*(largest - least)
      if (largest + margin > range(2)) range(2) = max(range(2), largest_within(rule, values))
      if (least - margin < range(1)) range(1) = min(range(1), -largest_within(rule, -values))
   end subroutine note_extremes

   !> Largest value of the polynomial through the values at the nodes.
   pure real(dp) function largest_within(rule, values) result(largest)
      type(lobatto_rule_t), intent(in) :: rule
      real(dp), intent(in) :: values(nodes)
      integer, parameter :: points = 32
      real(dp), parameter :: golden = 0.61803398874989485_dp
      real(dp) :: coefficients(nodes), scanned(0:points), left, right, inner(2), at(2)
      integer :: i, place

      coefficients = matmul(rule%to_legendre, values)
      do i = 0, points
         scanned(i) = value_at(coefficients, real(i, dp)/real(points, dp))
      end do
      place = maxloc(scanned, dim=1) - 1
      left = real(max(0, place - 1), dp)/real(points, dp)
      right = real(min(points, place + 1), dp)/real(points, dp)
      inner = [right - golden*(right - left), left + golden*(right - left)]
      at = [value_at(coefficients, inner(1)), value_at(coefficients, inner(2))]
      do i = 1, 36
         if (at(1) > at(2)) then
            right = inner(2)
            inner = [right - golden*(right - left), inner(1)]
            at = [value_at(coefficients, inner(1)), at(1)]
         else
            left = inner(1)
            inner = [inner(2), left + golden*(right - left)]
            at = [at(2), value_at(coefficients, inner(2))]
         end if
      end do
      largest = max(maxval(values), maxval(at))
   end function largest_within

   !> Value of a sum of Legendre polynomials.
   pure real(dp) function value_at(coefficients, c)
      real(dp), intent(in) :: coefficients(nodes)
      real(dp), intent(in) :: c
      real(dp) :: p(0:nodes)

      p = legendre(c)
      value_at = dot_product(coefficients, p(:nodes - 1))
   end function value_at

end module impact_window
