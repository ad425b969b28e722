!> Whether what a summary reports is true.
!>
!> A verified summary is a silent failure if its class is none that the true motion can have, if an extreme of film or
!> acceleration or one of the first harmonics is farther off than the error that it states, if the motion that it
!> calls steady is not the one that repeats, or if a motion repeats after fewer periods than reported. What the reference may be off
!> itself, found by solving it with another tolerance, is allowed for. Where a disturbance of film and force by 1e-9 grows so far
!> that no verification could foresee the film (30 times the growth times the accuracy of a verification, 1e-10, beyond 1 %),
!> nothing can be asked for but that a motion called irregular is irregular, or was so before and has settled by chance. The same
!> holds where the reference itself comes to other films with another tolerance.
!>
!> A row of a campaign states no errors. It is right if its class is possible, its films are within 30 times its accuracy,
!> and its accelerations and harmonics within 1 % of the largest and the noise floor of the scene; where disturbances
!> grow, that times the growth, up to 10 %. A row that is not, and does not say that its samples are too few, is a silent
!> failure. Where a row was asked for a verification, a wrong class is one only if it is verified. A value of a sweep is held
!> against the truth as a row is.
module summary_outcomes
   use starting_state, only: keep_by_contacts
   use engine, only: motion_state_t, start_of
   use force, only: largest_oscillation
   use impact_reference, only: compared_harmonics, distance, find_orbit, impact_reference_t, possible_classes, solve_reference
   use impact_steps, only: disturb, start_of_tooth, tooth_of_lane, tooth_state_t, tooth_t
   use impact_window, only: solve_periods
   use kinds, only: dp
   use lobatto_rule, only: lobatto_rule_t
   use problem, only: problem_t
   use random_scenes, only: drawn_scene_t
   use text, only: integer_text, short_text
   use reported_summary, only: reported_t
   implicit none(type, external)
   private

   integer, parameter, public :: reported_right = 1, reported_irregular = 2, reported_sensitive = 3, reported_uncertain = 4, &
                                 reported_understated = 5, reported_status = 6, reported_unjudged = 7, reported_long = 8, &
                                 reported_silent = 9
   integer, parameter, public :: reported_outcomes = 9
   character(*), parameter, public :: reported_names(reported_outcomes) = [character(20) :: 'right', 'irregular', 'sensitive', &
      'uncertain', 'error understated', 'status', 'unjudged', 'too long', 'SILENT FAILURE']

   !> Quantities that are compared, and their names.
   integer, parameter :: quantities = 6 + compared_harmonics
   character(*), parameter :: extreme_names(6) = [character(20) :: 'film_minimum', 'film_maximum', 'acceleration_minimum', &
      'acceleration_maximum', 'coast_film_minimum', 'coast_film_maximum']

   !> Tolerances of the reference: the usual one, and that of the second look. What each may be off at least [-].
   real(dp), parameter :: usual = 1.0e-9_dp, second = 1.0e-11_dp, usual_error = 3.0e-9_dp, second_error = 1.0e-10_dp
   !> Disturbance, and how far it may grow [-]
   real(dp), parameter :: disturbance = 1.0e-9_dp, foreseeable_growth = 0.01_dp/(30.0_dp*1.0e-10_dp)
   !> A steady motion may be this many times its accuracy away from the one that repeats.
   real(dp), parameter :: steady_ratio = 30.0_dp
   !> A motion repeats where its state is as near as this, and may be the one looked for within that, relative to film and velocity.
   real(dp), parameter :: same_state = 1.0e-6_dp, nearby = 0.05_dp

   !> What became of a scene.
   type, public :: reported_outcome_t
      integer :: code = 0
      !> What is wrong
      character(:), allocatable :: fault
   end type reported_outcome_t

   !> What a row of a campaign may be off in films, over its accuracy, and in accelerations, over the largest [-].
   real(dp), parameter :: row_ratio = 30.0_dp, row_error = 0.01_dp, row_unforeseeable = 0.1_dp
   !> How well the limits of the classes are known to a verification, and to a row [-].
   real(dp), parameter :: verified_margin = 1.0e-3_dp, row_margin = 2.0e-2_dp

   public :: outcome_of_row, outcome_of_summary

contains

   !> Judge what was reported of a scene.
   subroutine outcome_of_summary(drawn, rule, reported, outcome)
      !> The scene
      type(drawn_scene_t), intent(in) :: drawn
      type(lobatto_rule_t), intent(in) :: rule
      !> What its summary says
      type(reported_t), intent(in) :: reported
      type(reported_outcome_t), intent(out) :: outcome
      type(impact_reference_t) :: reference, tight, disturbed
      real(dp) :: own_errors(quantities), grown
      character(:), allocatable :: fault

      outcome%fault = trim(reported%status)
      outcome%code = reported_status
      if (.not. reported%judged) return
      outcome%code = merge(reported_right, reported_uncertain, reported%verified)
      outcome%fault = trim(reported%reason)
      call reference_of(drawn, rule, reported, usual, 0.0_dp, verified_margin, reference)
      if (.not. reference%solved) then
         if (reported%verified) outcome%code = reported_unjudged
         return
      end if
      if (reported%verified .and. reported%class == 'irregular') then
         outcome%code = reported_irregular
         if (class_is_possible(reported, reference)) return
         if (settles_by_chance(drawn, rule, reported)) then
            outcome%code = reported_sensitive
         else
            call fail(class_fault(reported, reference))
         end if
         return
      end if
      own_errors = usual_error*abs(values_of(reference)) + noise(drawn)
      fault = fault_of(reported, reference, own_errors, reported%verified)
      if (len(fault) > 0) then
         call reference_of(drawn, rule, reported, second, 0.0_dp, verified_margin, tight)
         if (.not. tight%solved) then
            if (reported%verified) outcome%code = reported_unjudged
            return
         end if
         own_errors = second_error*abs(values_of(tight)) + noise(drawn) + 3.0_dp*abs(values_of(tight) - values_of(reference))
         fault = fault_of(reported, tight, own_errors, reported%verified)
      end if
      if (len(fault) > 0) then
         call reference_of(drawn, rule, reported, second, disturbance, verified_margin, disturbed)
         grown = huge(1.0_dp)
         if (disturbed%solved) grown = maxval(abs(log(disturbed%extremes(:2)/tight%extremes(:2))))/disturbance
         if (grown > foreseeable_growth .or. .not. is_known(tight, reference)) then
            if (reported%verified) outcome%code = reported_sensitive
            return
         end if
         if (reported%verified) then
            call fail(fault//', growth '//short_text(grown, 3))
         else
            outcome%code = reported_understated
            outcome%fault = fault//'; '//trim(reported%reason)
         end if
         return
      end if
      if (reported%orbit > 0 .and. reported%verified) then
         fault = fault_of_orbit(drawn, rule, reported, reference, own_errors)
         if (fault == '?') then
            outcome%code = reported_unjudged
         else if (len(fault) > 0) then
            call fail(fault)
         end if
      end if
      if (outcome%code == reported_right .and. reported%repeats > 1) then
         fault = fault_of_period(drawn, rule, reported, reference)
         if (len(fault) > 0) call fail(fault)
      end if

   contains

      !> A silent failure.
      subroutine fail(what)
         character(*), intent(in) :: what

         outcome%code = reported_silent
         outcome%fault = what
      end subroutine fail

   end subroutine outcome_of_summary

   !> Whether a motion that is not irregular any more was so before, and settled at a time that no solution foresees: a disturbance
   !> has grown a million times by some time before its window.
   logical function settles_by_chance(drawn, rule, reported) result(by_chance)
      type(drawn_scene_t), intent(in) :: drawn
      type(lobatto_rule_t), intent(in) :: rule
      type(reported_t), intent(in) :: reported
      real(dp), parameter :: grown = 1.0e6_dp*disturbance
      integer, parameter :: parts = 8
      type(impact_reference_t) :: before, disturbed
      type(reported_t) :: earlier
      integer :: part

      by_chance = .false.
      earlier = reported
      earlier%window = 1
      do part = 1, parts
         earlier%periods = 1 + ((reported%periods - reported%window)*part)/parts
         call reference_of(drawn, rule, earlier, usual, 0.0_dp, verified_margin, before)
         call reference_of(drawn, rule, earlier, usual, disturbance, verified_margin, disturbed)
         if (.not. (before%solved .and. disturbed%solved)) return
         by_chance = distance(tooth_of_lane(drawn%resolved%problem), before%start, disturbed%start) > grown
         if (by_chance) return
      end do
   end function settles_by_chance

   !> Judge a row of a campaign.
   subroutine outcome_of_row(drawn, rule, reported, outcome)
      !> The scene of the row
      type(drawn_scene_t), intent(in) :: drawn
      type(lobatto_rule_t), intent(in) :: rule
      !> What the row says
      type(reported_t), intent(in) :: reported
      type(reported_outcome_t), intent(out) :: outcome
      type(impact_reference_t) :: reference, tight, disturbed
      type(reported_t) :: row
      real(dp) :: allowed(quantities), grown
      character(:), allocatable :: fault

      outcome%fault = trim(reported%status)
      outcome%code = reported_status
      if (.not. reported%judged) return
      outcome%fault = ''
      outcome%code = reported_unjudged
      call row_reference(drawn, rule, reported, usual, 0.0_dp, reference)
      if (.not. reference%solved) return
      outcome%code = merge(reported_irregular, reported_right, index(reported%class, 'irregular') == 1 &
                           .and. class_is_possible(reported, reference))
      if (outcome%code == reported_irregular) return
      row = reported
      allowed = noise(drawn) + drawn%resolved%noise_floor
      allowed(:2) = row_ratio*drawn%scene%solver%accuracy*reference%extremes(:2)
      allowed(3:4) = allowed(3:4) + row_error*maxval(abs(reference%extremes(3:4)))
      allowed(5:6) = row_ratio*drawn%scene%solver%accuracy*reference%extremes(5:)
      allowed(7:) = allowed(7:) + row_error*maxval(reference%harmonics)
      row%extreme_errors = allowed(:6)
      row%harmonic_errors = allowed(7:)
      ! The lines of a window that holds a part of a longer orbit depend on which part.
      if (reported%class == 'subharmonic' .and. (reported%orbit == 0 .or. modulo(reported%window, max(1, reported%orbit)) /= 0)) &
         row%harmonic_errors = huge(1.0_dp)
      fault = fault_of(row, reference, 0.0_dp*allowed, .true.)
      if (len(fault) == 0) return
      outcome%fault = fault
      if (reported%verification_asked .and. .not. reported%verified) then
         outcome%code = reported_uncertain
         if (len(fault_of(row, reference, 0.0_dp*allowed, .false.)) == 0) return
      end if
      call row_reference(drawn, rule, reported, second, 0.0_dp, tight)
      call row_reference(drawn, rule, reported, usual, disturbance, disturbed)
      if (.not. tight%solved) return
      grown = huge(1.0_dp)
      if (disturbed%solved) grown = max(1.0_dp, maxval(abs(log(disturbed%extremes(:2)/reference%extremes(:2))))/disturbance)
      outcome%code = reported_sensitive
      if (row_ratio*drawn%scene%solver%accuracy*grown > row_unforeseeable .or. .not. is_known(tight, reference)) return
      row%extreme_errors(:2) = allowed(:2)*grown
      row%extreme_errors(5:) = allowed(5:6)*grown
      if (len(fault_of(row, reference, 0.0_dp*allowed, .true.)) == 0) return
      outcome%code = merge(reported_silent, reported_uncertain, reported%sampling_sufficient)
      outcome%fault = outcome%fault//', growth '//short_text(grown, 3)
   end subroutine outcome_of_row

   !> Solve the window of a row: of a steady motion its orbit, since a forecast may have saved the periods before it.
   subroutine row_reference(drawn, rule, reported, tolerance, offset, reference)
      type(drawn_scene_t), intent(in) :: drawn
      type(lobatto_rule_t), intent(in) :: rule
      type(reported_t), intent(in) :: reported
      real(dp), intent(in) :: tolerance
      !> Relative disturbance of film and force
      real(dp), intent(in) :: offset
      type(impact_reference_t), intent(out) :: reference
      type(tooth_t) :: tooth
      type(tooth_state_t) :: state
      logical :: found
      real(dp) :: margin

      margin = merge(verified_margin, row_margin, reported%verified)
      call reference_of(drawn, rule, reported, tolerance, offset, margin, reference)
      if (reported%orbit == 0 .or. .not. reference%solved) return
      tooth = tooth_of_lane(drawn%resolved%problem)
      call disturb(offset, tooth)
      state = reference%start
      call find_orbit(tooth, rule, tolerance, reported%orbit, state, found)
      reference%solved = .false.
      if (found) call solve_reference(tooth, rule, tolerance, reported%orbit, drawn%scene%spectrum, drawn%resolved%noise_floor, &
                                      margin, state, reference)
   end subroutine row_reference

   !> Solve the window of a summary.
   subroutine reference_of(drawn, rule, reported, tolerance, offset, margin, reference)
      type(drawn_scene_t), intent(in) :: drawn
      type(lobatto_rule_t), intent(in) :: rule
      type(reported_t), intent(in) :: reported
      real(dp), intent(in) :: tolerance
      !> Relative disturbance of film and force
      real(dp), intent(in) :: offset
      !> How well the limits of the classes are known
      real(dp), intent(in) :: margin
      type(impact_reference_t), intent(out) :: reference
      type(problem_t) :: problem
      type(tooth_t) :: tooth
      type(tooth_state_t) :: state
      type(motion_state_t) :: start
      logical :: solved

      tooth = tooth_of_lane(drawn%resolved%problem)
      call disturb(offset, tooth)
      start = start_of(drawn%resolved%problem)
      if (drawn%before%film > 0.0_dp) then
         problem = drawn%resolved%problem
         problem%contact%compliance = tooth%compliance
         start%numbers(:2) = [drawn%before%film, drawn%before%velocity]
         call keep_by_contacts(problem, drawn%before%kept, start%numbers)
      end if
      state = start_of_tooth(drawn%resolved%problem, start, offset)
      call solve_periods(tooth, rule, tolerance, reported%periods - reported%window, state, solved)
      if (solved) call solve_reference(tooth, rule, tolerance, reported%window, drawn%scene%spectrum, drawn%resolved%noise_floor, &
                                       margin, state, reference)
   end subroutine reference_of

   !> Amplitudes that rounding explains [m], [m/s2].
   pure function noise(drawn)
      type(drawn_scene_t), intent(in) :: drawn
      real(dp) :: noise(quantities)

      noise = 1.0e-11_dp*(abs(drawn%scene%excitation%static_load()) + largest_oscillation(drawn%resolved%problem%force))/ &
              drawn%scene%excitation%mass
      noise(:2) = 0.0_dp
      noise(5:6) = 0.0_dp
   end function noise

   !> Whether two solutions of the reference come to the same films.
   pure logical function is_known(one, other)
      type(impact_reference_t), intent(in) :: one
      type(impact_reference_t), intent(in) :: other
      real(dp), parameter :: known = 0.01_dp

      is_known = all(abs(log(one%extremes(:2)/other%extremes(:2))) < known)
   end function is_known

   !> All that is compared.
   pure function values_of(reference) result(values)
      type(impact_reference_t), intent(in) :: reference
      real(dp) :: values(quantities)

      values = [reference%extremes, reference%harmonics]
   end function values_of

   !> Whether the class reported is one that the true motion may have.
   pure logical function class_is_possible(reported, reference)
      type(reported_t), intent(in) :: reported
      type(impact_reference_t), intent(in) :: reference
      character(len(reported%class)) :: word

      word = reported%class
      ! What is off its harmonics and repeats has a name of its own.
      if (word == 'subharmonic' .or. word == 'irregular_so_far') word = 'irregular'
      class_is_possible = any(possible_classes == word .and. reference%possible)
   end function class_is_possible

   !> A wrong class in words.
   pure function class_fault(reported, reference) result(fault)
      type(reported_t), intent(in) :: reported
      type(impact_reference_t), intent(in) :: reference
      character(:), allocatable :: fault
      integer :: i

      fault = 'class '//trim(reported%class)//', truly'
      do i = 1, size(possible_classes)
         if (reference%possible(i)) fault = fault//' '//trim(possible_classes(i))
      end do
   end function class_fault

   !> First thing that is wrong, empty if nothing is.
   pure function fault_of(reported, reference, own_errors, with_class) result(fault)
      type(reported_t), intent(in) :: reported
      type(impact_reference_t), intent(in) :: reference
      !> Of the reference
      real(dp), intent(in) :: own_errors(quantities)
      !> Whether the class counts
      logical, intent(in) :: with_class
      character(:), allocatable :: fault
      real(dp) :: values(quantities), stated(quantities), true_values(quantities)
      integer :: i

      fault = ''
      if (with_class .and. .not. class_is_possible(reported, reference)) fault = class_fault(reported, reference)//'; '
      values = [reported%extremes, reported%harmonics]
      stated = [reported%extreme_errors, reported%harmonic_errors]
      true_values = values_of(reference)
      do i = 1, 6 + reported%harmonic_count
         if (abs(values(i) - true_values(i)) <= stated(i) + own_errors(i)) cycle
         if (i <= 6) then
            fault = fault//trim(extreme_names(i))
         else
            fault = fault//'harmonic '//integer_text(i - 6)
         end if
         fault = fault//' '//short_text(values(i), 9)//' +- '//short_text(stated(i), 3)//', truly '// &
                 short_text(true_values(i), 9)//' +- '//short_text(own_errors(i), 3)
         return
      end do
   end function fault_of

   !> Whether the motion that repeats is another than the one reported; '?' if it is not known.
   function fault_of_orbit(drawn, rule, reported, reference, own_errors) result(fault)
      type(drawn_scene_t), intent(in) :: drawn
      type(lobatto_rule_t), intent(in) :: rule
      type(reported_t), intent(in) :: reported
      type(impact_reference_t), intent(in) :: reference
      real(dp), intent(in) :: own_errors(quantities)
      character(:), allocatable :: fault
      type(impact_reference_t) :: orbit
      type(tooth_t) :: tooth
      type(tooth_state_t) :: state
      real(dp) :: away(2), allowed(2)
      logical :: found

      fault = '?'
      tooth = tooth_of_lane(drawn%resolved%problem)
      state = reference%start
      call find_orbit(tooth, rule, usual, reported%orbit, state, found)
      if (.not. found) return
      call solve_reference(tooth, rule, usual, reported%orbit, drawn%scene%spectrum, drawn%resolved%noise_floor, &
                           verified_margin, state, orbit)
      if (.not. orbit%solved) return
      fault = ''
      away = abs(log(reported%extremes(:2)/orbit%extremes(:2)))
      allowed = steady_ratio*drawn%scene%solver%accuracy + (reported%extreme_errors(:2) + own_errors(:2))/reported%extremes(:2)
      if (any(away > allowed)) &
         fault = 'steady too early: films '//short_text(reported%extremes(1), 9)//' to '//short_text(reported%extremes(2), 9)// &
                 ', in the end '//short_text(orbit%extremes(1), 9)//' to '//short_text(orbit%extremes(2), 9)//', '// &
                 short_text(maxval(away)/drawn%scene%solver%accuracy, 3)//' times the accuracy'
   end function fault_of_orbit

   !> Whether the motion repeats after fewer periods than reported; empty also where the reference finds no such motion.
   function fault_of_period(drawn, rule, reported, reference) result(fault)
      type(drawn_scene_t), intent(in) :: drawn
      type(lobatto_rule_t), intent(in) :: rule
      type(reported_t), intent(in) :: reported
      type(impact_reference_t), intent(in) :: reference
      character(:), allocatable :: fault
      type(tooth_t) :: tooth
      type(tooth_state_t) :: ended, state, later
      integer :: periods
      logical :: solved

      fault = ''
      tooth = tooth_of_lane(drawn%resolved%problem)
      ended = reference%start
      call solve_periods(tooth, rule, usual, reported%window, ended, solved)
      if (.not. solved) return
      state = ended
      call find_orbit(tooth, rule, usual, reported%repeats, state, solved)
      ! There may be another motion that repeats, farther away.
      if (.not. solved .or. distance(tooth, state, ended) > nearby) return
      later = state
      do periods = 1, reported%repeats - 1
         call solve_periods(tooth, rule, usual, 1, later, solved)
         if (.not. solved) return
         if (distance(tooth, state, later) > same_state) cycle
         fault = 'repeats after '//integer_text(periods)//' periods, not '//integer_text(reported%repeats)
         return
      end do
   end function fault_of_period

end module summary_outcomes
