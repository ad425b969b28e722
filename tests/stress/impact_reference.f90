!> What a scene truly does, by the steps of impact_steps: extremes, lines, and the classes that its spectrum may have by
!> the rules of rattle_class. Lines are known up to a number, power to all; where that leaves more than one class
!> possible, all of them are.
module impact_reference
   use impact_steps, only: tooth_state_t, tooth_t
   use impact_window, only: impact_window_t, integrated_lines, solve_impact_window, solve_periods
   use kinds, only: dp
   use lobatto_rule, only: lobatto_rule_t
   use scene_types, only: spectrum_choice_t
   implicit none(type, external)
   private

   !> Harmonics that are compared.
   integer, parameter, public :: compared_harmonics = 12
   character(*), parameter, public :: possible_classes(4) = [character(9) :: 'quiet', 'creep', 'idle', 'irregular']

   !> The true motion.
   type, public :: impact_reference_t
      logical :: solved = .false.
      !> film_minimum, film_maximum [m], acceleration_minimum, acceleration_maximum [m/s2]
      real(dp) :: extremes(4) = 0.0_dp
      !> [m/s2]
      real(dp) :: harmonics(compared_harmonics) = 0.0_dp
      !> Which of `possible_classes` it may have
      logical :: possible(4) = .true.
      !> State at the start of the window
      type(tooth_state_t) :: start
   end type impact_reference_t

   !> A period repeats if its states differ by no more than this [-].
   real(dp), parameter :: repeats = 1.0e-7_dp
   real(dp), parameter :: two_pi = 6.28318530717958647692_dp

   public :: solve_reference, find_orbit, distance

contains

   !> Solve a window from the state where it starts.
   pure subroutine solve_reference(tooth, rule, tolerance, periods, choice, noise_floor, margin, start, reference)
      type(tooth_t), intent(in) :: tooth
      type(lobatto_rule_t), intent(in) :: rule
      !> Of take_step
      real(dp), intent(in) :: tolerance
      !> Of the window
      integer, intent(in) :: periods
      !> Limits of the classes
      type(spectrum_choice_t), intent(in) :: choice
      !> Amplitude below which nothing moves [m/s2]
      real(dp), intent(in) :: noise_floor
      !> How well the limits of the classes are known [-]
      real(dp), intent(in) :: margin
      type(tooth_state_t), intent(in) :: start
      type(impact_reference_t), intent(out) :: reference
      type(impact_window_t) :: window
      type(tooth_state_t) :: state
      logical :: periodic
      integer :: period

      reference%start = start
      state = start
      call solve_impact_window(tooth, rule, tolerance, periods, 1, state, window, reference%solved)
      if (.not. reference%solved) return
      reference%extremes = [exp(window%logarithm), window%acceleration]
      reference%harmonics = window%amplitudes(:compared_harmonics)
      periodic = .true.
      do period = 1, periods
         periodic = periodic .and. distance(tooth, tooth_state_t(film=window%films(period - 1), &
                                                                 velocity=window%velocities(period - 1)), &
                                            tooth_state_t(film=window%films(period), &
                                                          velocity=window%velocities(period))) < repeats
      end do
      if (.not. periodic) then
         state = start
         call solve_impact_window(tooth, rule, tolerance, periods, periods, state, window, reference%solved)
         if (.not. reference%solved) return
      end if
      reference%possible = classes_of(window, choice, noise_floor, margin)
   end subroutine solve_reference

   !> Classes that a window may have.
   pure function classes_of(window, choice, noise_floor, margin) result(possible)
      type(impact_window_t), intent(in) :: window
      type(spectrum_choice_t), intent(in) :: choice
      real(dp), intent(in) :: noise_floor
      real(dp), intent(in) :: margin
      logical :: possible(size(possible_classes))
      real(dp) :: a(integrated_lines), forced, largest, harmonic, between, rest, fraction(2), distortion(2)
      logical :: is_forced(integrated_lines)
      integer :: most, fewest

      possible = .true.
      a = window%amplitudes(window%divisions::window%divisions)
      is_forced = .false.
      most = min(integrated_lines, size(choice%forced))
      is_forced(:most) = choice%forced(:most)
      largest = maxval(a, mask=is_forced)
      forced = sum(a**2, mask=is_forced)
      harmonic = sum(a**2)
      between = max(0.0_dp, sum(window%amplitudes**2) - harmonic)
      rest = max(0.0_dp, window%power - harmonic - between)
      ! Below the noise floor nothing moves; near it much is possible.
      if (sqrt(window%power) < 0.3_dp*noise_floor) then
         possible = possible_classes == 'quiet'
         return
      end if
      if (sqrt(window%power) < 3.0_dp*noise_floor .or. largest < 30.0_dp*noise_floor) return
      fraction = [between, between + rest]/window%power
      if (window%divisions == 1) fraction = 0.0_dp
      possible(4) = fraction(2) > choice%irregular_limit*(1.0_dp - margin)
      if (fraction(1) > choice%irregular_limit*(1.0_dp + margin)) then
         possible(:3) = .false.
         return
      end if
      distortion = sqrt([harmonic - forced, harmonic - forced + rest]/forced)
      possible(1) = distortion(1) < choice%quiet_limit*(1.0_dp + margin)
      possible(2:3) = .false.
      if (distortion(2) < choice%quiet_limit*(1.0_dp - margin)) return
      fewest = 1 + count(.not. is_forced .and. a > choice%line_threshold*largest*(1.0_dp + margin))
      most = 1 + count(.not. is_forced .and. a > choice%line_threshold*largest*(1.0_dp - margin)) + &
             int(min(rest/(choice%line_threshold*largest)**2, 1.0e6_dp))
      possible(3) = most >= choice%idle_lines
      possible(2) = fewest < choice%idle_lines
   end function classes_of

   !> How far two states are from each other, relative to film and velocity.
   pure real(dp) function distance(tooth, one, other)
      type(tooth_t), intent(in) :: tooth
      type(tooth_state_t), intent(in) :: one
      type(tooth_state_t), intent(in) :: other

      distance = max(abs(log(one%film/other%film)), abs(one%velocity - other%velocity)/velocity_unit(tooth, one))
   end function distance

   !> What a velocity is small against [m/s].
   pure real(dp) function velocity_unit(tooth, state)
      type(tooth_t), intent(in) :: tooth
      type(tooth_state_t), intent(in) :: state

      velocity_unit = abs(state%velocity) + two_pi*tooth%frequency*state%film
   end function velocity_unit

   !> The motion that repeats after so many periods, by Newton's method from a state near it.
   pure subroutine find_orbit(tooth, rule, tolerance, periods, state, found)
      type(tooth_t), intent(in) :: tooth
      type(lobatto_rule_t), intent(in) :: rule
      real(dp), intent(in) :: tolerance
      !> Periods of the orbit
      integer, intent(in) :: periods
      !> On return a state of the orbit
      type(tooth_state_t), intent(inout) :: state
      logical, intent(out) :: found
      real(dp), parameter :: offset = 1.0e-6_dp, reached = 1.0e-10_dp, farthest = 0.5_dp
      type(tooth_state_t) :: ends(3), starts(3)
      real(dp) :: slope(2, 2), gap(2), correction(2), unit, determinant
      integer :: pass, i
      logical :: solved

      found = .false.
      do pass = 1, 8
         unit = velocity_unit(tooth, state)
         starts = state
         starts(2)%film = state%film*exp(offset)
         starts(3)%velocity = state%velocity + offset*unit
         do i = 1, 3
            ends(i) = starts(i)
            call solve_periods(tooth, rule, tolerance, periods, ends(i), solved)
            if (.not. solved) return
         end do
         gap = [log(ends(1)%film/state%film), (ends(1)%velocity - state%velocity)/unit]
         do i = 1, 2
            slope(:, i) = [log(ends(i + 1)%film/ends(1)%film), (ends(i + 1)%velocity - ends(1)%velocity)/unit]/offset
            slope(i, i) = slope(i, i) - 1.0_dp
         end do
         determinant = slope(1, 1)*slope(2, 2) - slope(1, 2)*slope(2, 1)
         if (.not. abs(determinant) > 1.0e-9_dp) return
         correction = -[slope(2, 2)*gap(1) - slope(1, 2)*gap(2), slope(1, 1)*gap(2) - slope(2, 1)*gap(1)]/determinant
         if (.not. maxval(abs(correction)) < farthest) return
         state%film = state%film*exp(correction(1))
         state%velocity = state%velocity + correction(2)*unit
         if (maxval(abs(correction)) < reached) then
            found = .true.
            return
         end if
      end do
   end subroutine find_orbit

end module impact_reference
