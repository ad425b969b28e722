!> What a scene truly does, by the steps of impact_steps: extremes, lines, and the classes that its spectrum may have by
!> the rules of rattle_class. Lines are known up to a number, power to all; where that leaves more than one class
!> possible, all of them are.
module impact_reference
   use impact_steps, only: has_coast, tooth_state_t, tooth_t
   use impact_window, only: impact_window_t, integrated_harmonics, solve_impact_window, solve_periods
   use kinds, only: dp
   use lobatto_rule, only: lobatto_rule_t, nodes, solve_linear
   use scene_types, only: spectrum_choice_t
   implicit none(type, external)
   private

   !> Harmonics that are compared.
   integer, parameter, public :: compared_harmonics = 12
   character(*), parameter, public :: possible_classes(4) = [character(9) :: 'quiet', 'creep', 'idle', 'irregular']

   !> The true motion.
   type, public :: impact_reference_t
      logical :: solved = .false.
      !> film_minimum, film_maximum [m], acceleration_minimum, acceleration_maximum [m/s2], coast_film_minimum, coast_film_maximum
      !> [m]; the last two 0 where there is one flank
      real(dp) :: extremes(6) = 0.0_dp
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
      reference%extremes(:4) = [exp(window%logarithm), window%acceleration]
      if (has_coast(tooth)) reference%extremes(5:) = exp(window%coast)
      reference%harmonics = window%amplitudes(:compared_harmonics)
      periodic = .true.
      do period = 1, periods
         periodic = periodic .and. distance(tooth, window%states(period - 1), window%states(period)) < repeats
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
      real(dp) :: a(integrated_harmonics), forced, largest, harmonic, between, rest, fraction(2), distortion(2)
      real(dp) :: about(integrated_harmonics)
      logical :: is_forced(integrated_harmonics)
      integer :: most, fewest, n, multiple

      possible = .true.
      a = window%amplitudes(window%divisions::window%divisions)
      is_forced = .false.
      most = min(integrated_harmonics, size(choice%forced))
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
      distortion = sqrt(max(0.0_dp, [harmonic - forced, harmonic - forced + rest])/forced)
      possible(1) = distortion(1) < choice%quiet_limit*(1.0_dp + margin)
      possible(2:3) = .false.
      if (distortion(2) < choice%quiet_limit*(1.0_dp - margin)) return
      ! What is not forced belongs to the nearest multiple of the dominant order.
      about = 0.0_dp
      do n = 1, size(a)
         multiple = max(1, floor(real(n, dp)/real(choice%dominant_order, dp) + 0.5_dp))
         if (.not. is_forced(n)) about(multiple) = about(multiple) + a(n)**2
      end do
      about(1) = 0.0_dp
      fewest = 1 + count(sqrt(about) > choice%harmonic_threshold*largest*(1.0_dp + margin))
      most = 1 + count(sqrt(about) > choice%harmonic_threshold*largest*(1.0_dp - margin)) + &
             int(min(rest/(choice%harmonic_threshold*largest)**2, 1.0e6_dp))
      possible(3) = most >= choice%idle_harmonics
      possible(2) = fewest < choice%idle_harmonics
   end function classes_of

   !> How far two states are from each other, relative to film and velocity.
   pure real(dp) function distance(tooth, one, other)
      type(tooth_t), intent(in) :: tooth
      type(tooth_state_t), intent(in) :: one
      type(tooth_state_t), intent(in) :: other

      distance = max(abs(log(one%film/other%film)), abs(log(one%coast/other%coast)), &
                     abs(one%velocity - other%velocity)/velocity_unit(tooth, one))
   end function distance

   !> What a velocity is small against [m/s].
   pure real(dp) function velocity_unit(tooth, state)
      type(tooth_t), intent(in) :: tooth
      type(tooth_state_t), intent(in) :: state

      velocity_unit = abs(state%velocity) + two_pi*tooth%frequency*min(state%film, state%coast)
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
      type(tooth_state_t) :: ends(0:4), moved
      real(dp) :: slope(nodes, nodes), correction(nodes), unit
      integer :: pass, numbers, i, n
      logical :: solved

      found = .false.
      numbers = 2
      if (tooth%compliance > 0.0_dp) numbers = merge(4, 3, has_coast(tooth))
      do pass = 1, 8
         unit = velocity_unit(tooth, state)
         do i = 0, numbers
            correction = [(merge(offset, 0.0_dp, n == i), n=1, nodes)]
            call move(correction, state, ends(i))
            call solve_periods(tooth, rule, tolerance, periods, ends(i), solved)
            if (.not. solved) return
         end do
         slope = 0.0_dp
         do i = 1, nodes
            slope(i, i) = 1.0_dp
         end do
         correction = 0.0_dp
         correction(:numbers) = -apart(ends(0), state)
         do i = 1, numbers
            slope(:numbers, i) = apart(ends(i), ends(0))/offset
            slope(i, i) = slope(i, i) - 1.0_dp
         end do
         call solve_linear(slope, correction, solved)
         if (.not. (solved .and. maxval(abs(correction)) < farthest)) return
         call move(correction, state, moved)
         if (.not. min(moved%film, moved%coast) > 0.0_dp) return
         state = moved
         if (maxval(abs(correction)) < reached) then
            found = .true.
            return
         end if
      end do

   contains

      !> Differences of two states: films over the thinner one, velocities over their unit, compressions over themselves.
      pure function apart(one, other) result(differences)
         type(tooth_state_t), intent(in) :: one
         type(tooth_state_t), intent(in) :: other
         real(dp) :: differences(numbers), all_of_them(4)

         ! The thinner film has all digits.
         all_of_them(1) = (one%film - other%film)/min(state%film, state%coast)
         if (state%coast < state%film) all_of_them(1) = (other%coast - one%coast + &
            sum(one%compression - other%compression))/state%coast
         all_of_them(2) = (one%velocity - other%velocity)/unit
         all_of_them(3:) = (one%compression - other%compression)/max(abs(state%compression), tiny(1.0_dp))
         differences = all_of_them(:numbers)
      end function apart

      !> A state at such differences from another one.
      pure subroutine move(differences, from, there)
         real(dp), intent(in) :: differences(nodes)
         type(tooth_state_t), intent(in) :: from
         type(tooth_state_t), intent(out) :: there
         real(dp) :: change

         there = from
         change = differences(1)*min(from%film, from%coast)
         there%film = from%film + change
         there%velocity = from%velocity + differences(2)*unit
         there%compression = from%compression + differences(3:4)*abs(from%compression)
         if (has_coast(tooth)) there%coast = from%coast - change + sum(there%compression - from%compression)
      end subroutine move

   end subroutine find_orbit

end module impact_reference
