!> A judged scene, whether a single one, a value of a sweep or a row of a campaign, and the values of all quantities of it.
module judged_scene
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use coexisting_motions, only: coexisting_motions_t, loudest_motion, quietest_motion, unknown_verdict
   use verification, only: verification_t
   use engine, only: ending_t
   use force, only: inertia_ratio
   use force_signal, only: force_signal_t
   use impacts, only: impact_count_t
   use irregular_statistics, only: irregular_statistics_t
   use kinds, only: dp
   use vibration_severity, only: vibration_severity_t
   use nodal_step, only: nodal_choice_t
   use node_extremes, only: seen_acceleration, seen_films, seen_loads, seen_position, seen_pressure, seen_velocity
   use nodal_orbit, only: orbit_not_requested
   use periodic_orbit, only: orbit_stability, periodic_orbit_t
   use quantities
   use carried_loads, only: contact_film
   use flank_contact, only: is_elastic, of_central_film, of_film_at_pressure, of_pressure
   use problem, only: contact_count, has_damped_teeth, inner_places
   use rattle_class, only: rattle_verdict_t
   use regime, only: deflection_limit, film_elastohydrodynamic
   use regime_check, only: closure_range, model_limit, regime_verdict_t
   use prepared_scene, only: resolved_scene_t
   use scene_status, only: status_complete, status_no_rigid_film
   use scene_types, only: drag_computed, drag_t, drag_unknown
   use known_motions, only: settled_motion_t
   use window_extremes, only: window_extremes_t
   use window_impacts, only: double_sided_impacts, has_reversal, has_separation, impulse_mean, verdict_of, &
      window_impacts_t
   implicit none(type, external)
   private

   !> A judged scene. Parts that were not requested, or that its ending leaves unknown, are as they stand here.
   type, public :: judged_scene_t
      type(resolved_scene_t) :: resolved
      !> How it is followed where its films are solved in nodes
      type(nodal_choice_t) :: nodal
      !> Whether it is solved by the closure because films in nodes stopped
      logical :: nodes_stopped = .false.
      !> How its motion ended, the status of the scene, of scene_status, and whether there is a window that was judged
      type(ending_t) :: ending
      integer :: status = status_complete
      logical :: judged = .false.
      !> Periods after which its end was seen to repeat, by the engine or by a search there, else 0
      integer :: repeats_after = 0
      !> Whole periods of the window, samples of each, and whether its harmonics are integrals over the steps
      integer :: window_periods = 0, samples_per_period = 0
      logical :: harmonics_by_integrals = .false.
      !> Whether the samples of the scene are too few for its motion
      logical :: series_coarse = .false.
      !> Whether they miss extremes that a picture would show
      logical :: series_misses_extremes = .false.
      !> Extremes of the window
      type(window_extremes_t) :: extremes
      type(vibration_severity_t) :: severity
      !> Of a pair of a gearbox, whose pairs are summed
      type(force_signal_t) :: film_force
      type(window_impacts_t) :: impacts
      !> Of an irregular motion: what all these are known from, and their standard errors
      type(irregular_statistics_t) :: statistics
      type(rattle_verdict_t) :: rattle
      type(regime_verdict_t) :: regime
      type(verification_t) :: verification
      !> The periodic motion behind it, where one was looked for
      type(periodic_orbit_t) :: orbit
      !> Of films in nodes: whether one was found, and why not, as of module nodal_orbit
      integer :: orbit_outcome = orbit_not_requested
      !> The motions that all starts have led to, where others were followed
      type(coexisting_motions_t) :: coexisting
      !> The same ones with all their states
      type(settled_motion_t), allocatable :: settled(:)
   end type judged_scene_t

   !> Error of the largest pressure up to which it counts as resolved, twice its change by twice as many nodes [-]
   real(dp), parameter :: resolved_pressure = 0.04_dp

   !> Codes of film_model
   real(dp), parameter, public :: film_model_closure = 1.0_dp, film_model_nodes = 2.0_dp, film_model_stopped = 3.0_dp

   public :: quantity_value, quantity_list, quantity_numbers, largest_load

contains

   !> Value of a quantity, NaN where it is unknown; flags are 1 or 0.
   pure real(dp) function quantity_value(quantity, judged) result(value)
      !> Code of a quantity that is no list
      integer, intent(in) :: quantity
      type(judged_scene_t), intent(in) :: judged

      value = ieee_value(value, ieee_quiet_nan)
      select case (quantity)
      case (quantity_status)
         value = real(judged%status, dp)
      case (quantity_steady_film)
         if (judged%resolved%steady_film > 0.0_dp) value = judged%resolved%steady_film
      case (quantity_natural_frequency)
         if (judged%resolved%natural_frequency > 0.0_dp) value = judged%resolved%natural_frequency
      case (quantity_damping_ratio)
         if (judged%resolved%natural_frequency > 0.0_dp) value = judged%resolved%damping_ratio
      case (quantity_drag_torque, quantity_drag_bearing, quantity_drag_synchroniser, quantity_drag_churning)
         value = drag_value(quantity, judged%resolved%drag)
      case (quantity_inertia_ratio)
         if (judged%resolved%drag%known_by /= drag_unknown) value = inertia_ratio(judged%resolved%problem%force)
      case (quantity_orbit_period)
         value = real(merge(judged%orbit%period, judged%repeats_after, judged%orbit%period > 0), dp)
      case (quantity_periods_solved)
         value = real(judged%ending%periods, dp)
      case (quantity_evaluations)
         value = real(judged%ending%count%evaluations, dp)
      case (quantity_steps)
         value = real(judged%ending%count%steps, dp)
      case (quantity_steps_cut)
         value = real(judged%ending%count%cuts, dp)
      case (quantity_iterations_per_step)
         if (judged%ending%count%steps > 0) value = real(judged%ending%count%evaluations, dp)/real(judged%ending%count%steps, dp)
      case default
         if (judged%judged) value = window_value(quantity, judged)
         ! No film of the scene's own law carries its load: that much is known of a motion that never began.
         if (judged%status == status_no_rigid_film .and. quantity == quantity_film_regime) value = real(film_elastohydrodynamic, dp)
         if (judged%status == status_no_rigid_film .and. quantity == quantity_law_contradicted) value = flag(.true.)
      end select
   end function quantity_value

   !> Drag torque or a part of it; parts are known where it is computed.
   pure real(dp) function drag_value(quantity, drag) result(value)
      integer, intent(in) :: quantity
      type(drag_t), intent(in) :: drag

      value = ieee_value(value, ieee_quiet_nan)
      if (drag%known_by == drag_unknown) return
      if (quantity == quantity_drag_torque) value = drag%torque
      if (drag%known_by /= drag_computed) return
      select case (quantity)
      case (quantity_drag_bearing)
         value = drag%bearing
      case (quantity_drag_synchroniser)
         value = drag%synchroniser
      case (quantity_drag_churning)
         value = drag%churning
      case default
         continue
      end select
   end function drag_value

   !> Value of a quantity that rests on the window.
   pure real(dp) function window_value(quantity, judged) result(value)
      integer, intent(in) :: quantity
      type(judged_scene_t), intent(in) :: judged
      integer :: place(2)

      value = ieee_value(value, ieee_quiet_nan)
      associate (lowest => judged%extremes%lowest, highest => judged%extremes%highest, spectrum => judged%rattle%spectrum, &
                 regime => judged%regime, verification => judged%verification, problem => judged%resolved%problem)
         select case (quantity)
         case (quantity_window_periods)
            value = real(judged%window_periods, dp)
         case (quantity_samples_per_period)
            value = real(judged%samples_per_period, dp)
         case (quantity_series_coarse)
            value = flag(judged%series_coarse)
         case (quantity_harmonics_by_integrals)
            value = flag(judged%harmonics_by_integrals)
         case (quantity_velocity_minimum)
            value = lowest(seen_velocity)%value
         case (quantity_velocity_maximum)
            value = highest(seen_velocity)%value
         case (quantity_acceleration_minimum)
            value = lowest(seen_acceleration)%value
         case (quantity_acceleration_maximum)
            value = highest(seen_acceleration)%value
         case (quantity_load_minimum)
            value = lowest(seen_loads(1))%value
         case (quantity_acceleration_rms)
            value = judged%severity%acceleration_rms
         case (quantity_gear_acceleration_rms)
            if (judged%resolved%gear_arm > 0.0_dp) value = judged%severity%acceleration_rms/judged%resolved%gear_arm
         case (quantity_gear_acceleration_maximum)
            if (judged%resolved%gear_arm > 0.0_dp) &
               value = max(-lowest(seen_acceleration)%value, highest(seen_acceleration)%value)/judged%resolved%gear_arm
         case (quantity_crest_factor)
            if (judged%severity%acceleration_rms > judged%resolved%noise_floor) &
               value = max(abs(lowest(seen_acceleration)%value), abs(highest(seen_acceleration)%value)) &
                       /judged%severity%acceleration_rms
         case (quantity_acceleration_kurtosis)
            if (judged%severity%acceleration_rms > judged%resolved%noise_floor) value = judged%severity%acceleration_kurtosis
         case (quantity_film_force_rms)
            value = judged%severity%film_force_rms
         case (quantity_dissipated_energy)
            value = judged%severity%dissipated_energy
         case (quantity_dissipated_power)
            value = judged%severity%dissipated_energy*judged%resolved%problem%frequency
         case (quantity_film_dissipated_power)
            if (has_damped_teeth(problem)) &
               value = (judged%severity%dissipated_energy - judged%severity%tooth_energy)*problem%frequency
         case (quantity_tooth_dissipated_power)
            if (has_damped_teeth(problem)) value = judged%severity%tooth_energy*problem%frequency
         case (quantity_model_limit)
            value = minval(lowest(seen_films(:contact_count(problem)))%value)
            value = real(model_limit(value, highest(seen_films(1))%value, problem%contact%film%radius), dp)
         case (quantity_gear_position_minimum)
            if (is_elastic(problem%contact)) value = lowest(seen_position)%value
         case (quantity_gear_position_maximum)
            if (is_elastic(problem%contact)) value = highest(seen_position)%value
         case (quantity_reversals_per_period)
            value = judged%rattle%reversals_per_period
         case (quantity_reversals_per_second)
            value = judged%rattle%reversals_per_period*problem%frequency
         case (quantity_reversals_per_revolution)
            if (judged%resolved%gear_speed > 0.0_dp) &
               value = judged%rattle%reversals_per_period*problem%frequency/judged%resolved%gear_speed
         case (quantity_harmonic_count)
            if (spectrum%moving) value = real(spectrum%harmonic_count, dp)
         case (quantity_harmonic_count_is_bound)
            if (spectrum%moving) value = flag(spectrum%count_is_bound)
         case (quantity_spectral_reach)
            if (spectrum%moving .and. spectrum%spectral_reach > 0.0_dp) value = spectrum%spectral_reach
         case (quantity_harmonic_distortion)
            if (spectrum%moving) value = spectrum%harmonic_distortion
         case (quantity_harmonic_distortion_is_bound)
            if (spectrum%moving) value = flag(spectrum%distortion_is_bound)
         case (quantity_irregular_fraction)
            if (spectrum%moving) value = spectrum%irregular_fraction
         case (quantity_irregular_fraction_is_bound)
            if (spectrum%moving) value = flag(spectrum%irregular_is_bound)
         case (quantity_sampling_sufficient)
            if (spectrum%moving) value = flag(spectrum%sampling_sufficient)
         case (quantity_rattle_class)
            value = real(judged%rattle%class, dp)
         case (quantity_motions, quantity_starts_solved, quantity_unsettled_starts, quantity_start_periods, &
               quantity_loudest_class, &
               quantity_loudest_acceleration_rms, quantity_loudest_film_force_rms, quantity_loudest_film_minimum, &
               quantity_quietest_class, quantity_quietest_acceleration_rms, quantity_loudest_verdict)
            if (allocated(judged%coexisting%motions)) value = value_of_motions(quantity, judged%coexisting)
         case (quantity_lyapunov_exponent)
            if (judged%rattle%parting%periods > 0) value = judged%rattle%parting%exponent
         case (quantity_verified)
            if (verification%exists) value = flag(verification%verified)
         case (quantity_orbit_stability)
            if (judged%orbit%period > 0) value = real(orbit_stability(judged%orbit%multipliers), dp)
         case (quantity_floquet_modulus)
            if (judged%orbit%period > 0) value = abs(judged%orbit%multipliers(1))
         case (quantity_pressure_error)
            if (verification%exists .and. verification%pressure_error >= 0.0_dp) value = verification%pressure_error
         case (quantity_pressure_resolved)
            if (verification%exists .and. verification%pressure_error >= 0.0_dp) &
               value = flag(verification%pressure_error < resolved_pressure)
         case (quantity_pressure_maximum, quantity_film_at_pressure_maximum, quantity_central_film, quantity_alpha_p_maximum, &
               quantity_deflection, quantity_deflection_share, quantity_stiffness_matters, quantity_film_regime, &
               quantity_law_contradicted, quantity_film_model, quantity_closure_range)
            value = value_of_film(quantity, judged)
         case (quantity_verdict_verified)
            if (verification%exists .and. judged%impacts%exists) value = flag(verification%impacts%verdict)
         case (quantity_impacts_verified)
            if (verification%exists .and. judged%impacts%exists) value = flag(verification%impacts%numbers)
         case (quantity_followed_periods)
            if (judged%statistics%periods > 0) value = real(judged%statistics%periods, dp)
         case (quantity_batch_periods)
            if (judged%statistics%periods > 0) value = real(judged%statistics%batch_periods, dp)
         case (quantity_severity_error)
            if (allocated(verification%harmonic_errors) .and. spectrum%moving) value = error_value(quantity, verification)
         case (quantity_acceleration_rms_error, quantity_film_force_rms_error)
            if (allocated(verification%harmonic_errors)) value = error_value(quantity, verification)
         case (quantity_dissipated_power_error)
            if (allocated(verification%harmonic_errors)) value = error_value(quantity, verification)*problem%frequency
         case (quantity_film_error, quantity_film_minimum_error, quantity_film_maximum_error, quantity_acceleration_error, &
               quantity_acceleration_minimum_error, quantity_acceleration_maximum_error)
            if (allocated(verification%harmonic_errors)) value = error_value(quantity, verification)
         case default
            place = findloc(quantities_of_contacts, quantity)
            if (place(1) > 0) then
               if (place(1) <= contact_count(problem)) value = contact_value(place(2), place(1), judged)
            else if (judged%impacts%exists) then
               value = impact_value(quantity, judged)
            end if
         end select
      end associate
   end function window_value

   !> Value of a quantity of the pressures and the regime of the film.
   pure real(dp) function value_of_film(quantity, judged) result(value)
      integer, intent(in) :: quantity
      type(judged_scene_t), intent(in) :: judged

      value = ieee_value(value, ieee_quiet_nan)
      associate (regime => judged%regime, problem => judged%resolved%problem)
         select case (quantity)
         case (quantity_pressure_maximum)
            if (regime%pressure_exists) value = regime%pressure_maximum
         case (quantity_film_at_pressure_maximum)
            if (problem%contact%film%in_nodes) value = film_of_peak(judged, of_film_at_pressure)
         case (quantity_central_film)
            if (problem%contact%film%in_nodes) value = film_of_peak(judged, of_central_film)
         case (quantity_alpha_p_maximum)
            value = regime%alpha_p_maximum
         case (quantity_deflection)
            value = regime%deflection
         case (quantity_deflection_share)
            value = deflection_share(judged)
         case (quantity_stiffness_matters)
            value = flag(deflection_share(judged) > deflection_limit)
         case (quantity_film_regime)
            value = real(regime%regime, dp)
         case (quantity_law_contradicted)
            value = flag(regime%law_contradicted)
         case (quantity_film_model)
            if (problem%contact%film%bends) value = merge(film_model_stopped, film_model_closure, judged%nodes_stopped)
            if (problem%contact%film%in_nodes) value = film_model_nodes
         case default
            if (problem%contact%film%bends .and. .not. problem%contact%film%in_nodes) &
               value = real(closure_range(problem%contact%film, largest_load(judged), regime%pressure_maximum), dp)
         end select
      end associate
   end function value_of_film

   !> Value of a quantity of all motions of the starts.
   pure real(dp) function value_of_motions(quantity, coexisting) result(value)
      integer, intent(in) :: quantity
      !> With one motion at least
      type(coexisting_motions_t), intent(in) :: coexisting

      value = ieee_value(value, ieee_quiet_nan)
      associate (loudest => coexisting%motions(loudest_motion(coexisting)), &
                 quietest => coexisting%motions(quietest_motion(coexisting)))
         select case (quantity)
         case (quantity_motions)
            value = real(size(coexisting%motions), dp)
         case (quantity_starts_solved)
            value = real(coexisting%starts_solved, dp)
         case (quantity_unsettled_starts)
            value = real(coexisting%unsettled_starts, dp)
         case (quantity_start_periods)
            value = real(coexisting%extra_periods, dp)
         case (quantity_loudest_class)
            value = real(loudest%class, dp)
         case (quantity_loudest_verdict)
            if (loudest%verdict /= unknown_verdict) value = real(loudest%verdict, dp)
         case (quantity_loudest_acceleration_rms)
            value = loudest%acceleration_rms
         case (quantity_loudest_film_force_rms)
            value = loudest%film_force_rms
         case (quantity_loudest_film_minimum)
            value = loudest%film_minimum
         case (quantity_quietest_class)
            value = real(quietest%class, dp)
         case default
            value = quietest%acceleration_rms
         end select
      end associate
   end function value_of_motions

   !> Value of a quantity that rests on separation and impacts.
   pure real(dp) function impact_value(quantity, judged) result(value)
      integer, intent(in) :: quantity
      type(judged_scene_t), intent(in) :: judged

      value = ieee_value(value, ieee_quiet_nan)
      associate (impacts => judged%impacts, problem => judged%resolved%problem, extremes => judged%extremes)
         select case (quantity)
         case (quantity_reversal)
            value = flag(has_reversal(problem, extremes))
         case (quantity_unloaded_share)
            value = impacts%unloaded_share
         case (quantity_separation)
            value = flag(has_separation(problem, extremes, impacts))
         case (quantity_impact_periods)
            value = real(impacts%periods, dp)
         case (quantity_verdict)
            value = real(verdict_of(problem, extremes, impacts), dp)
         case (quantity_double_sided)
            if (contact_count(problem) > 1) value = flag(verdict_of(problem, extremes, impacts) == double_sided_impacts)
         case default
            continue
         end select
      end associate
   end function impact_value

   !> Value of a quantity of a contact.
   pure real(dp) function contact_value(part, contact, judged) result(value)
      !> What of the contact, by a code of module quantities
      integer, intent(in) :: part
      !> Number of a contact that there is
      integer, intent(in) :: contact
      type(judged_scene_t), intent(in) :: judged

      value = ieee_value(value, ieee_quiet_nan)
      select case (part)
      case (contact_film_minimum)
         value = judged%extremes%lowest(seen_films(contact))%value
      case (contact_film_maximum)
         value = judged%extremes%highest(seen_films(contact))%value
      case (contact_load_maximum)
         value = judged%extremes%highest(seen_loads(contact))%value
      case default
         if (.not. judged%impacts%exists) return
         select case (part)
         case (contact_impacts_per_period_error)
            if (allocated(judged%verification%harmonic_errors)) value = judged%verification%impacts_per_period_errors(contact)
         case (contact_impact_impulse_mean_error)
            if (allocated(judged%verification%harmonic_errors)) value = judged%verification%impulse_mean_errors(contact)
         case (contact_impacts_per_second, contact_impacts_per_revolution)
            associate (impacts => judged%impacts, frequency => judged%resolved%problem%frequency, &
                       speed => judged%resolved%gear_speed)
               if (part == contact_impacts_per_revolution .and. .not. speed > 0.0_dp) return
               value = value_of_impacts(contact_impacts_per_period, impacts%contacts(contact), impacts%periods)*frequency
               if (part == contact_impacts_per_revolution) value = value/speed
            end associate
         case default
            value = value_of_impacts(part, judged%impacts%contacts(contact), judged%impacts%periods)
         end select
      end select
   end function contact_value

   !> Value of a quantity of the impacts on a contact.
   pure real(dp) function value_of_impacts(part, impacts, periods) result(value)
      !> As of contact_value
      integer, intent(in) :: part
      type(impact_count_t), intent(in) :: impacts
      !> Periods that they were counted in
      integer, intent(in) :: periods

      value = ieee_value(value, ieee_quiet_nan)
      select case (part)
      case (contact_impacts)
         value = real(impacts%count, dp)
      case (contact_impacts_per_period)
         value = real(impacts%count, dp)/real(periods, dp)
      case (contact_impact_load_maximum)
         value = impacts%load_maximum
      case (contact_impact_velocity_maximum)
         value = impacts%velocity_maximum
      case (contact_impact_impulse_maximum)
         value = impacts%impulse_maximum
      case (contact_impact_impulse_mean)
         value = impulse_mean(impacts)
      case (contact_restitution)
         if (impacts%approach > 0.0_dp) value = impacts%departure/impacts%approach
      case default
         continue
      end select
   end function value_of_impacts

   !> Largest load of any contact over the window [N].
   pure real(dp) function largest_load(judged)
      type(judged_scene_t), intent(in) :: judged

      largest_load = maxval(judged%extremes%highest(seen_loads(:contact_count(judged%resolved%problem)))%value)
   end function largest_load

   !> A film of the contact under the largest pressure, at its time [m].
   pure real(dp) function film_of_peak(judged, which) result(film)
      !> Its films are in nodes
      type(judged_scene_t), intent(in) :: judged
      !> One of the numbers of module flank_contact
      integer, intent(in) :: which
      real(dp) :: pressure
      integer :: places(2), contact

      pressure = -1.0_dp
      film = 0.0_dp
      associate (state => judged%extremes%highest(seen_pressure)%state)
         do contact = 1, contact_count(judged%resolved%problem)
            places = inner_places(judged%resolved%problem, contact) - 1
            if (state(places(1) + of_pressure) <= pressure) cycle
            pressure = state(places(1) + of_pressure)
            film = state(places(1) + which)
         end do
      end associate
   end function film_of_peak

   !> By which share of the film a tooth deflects under the largest load of it, at the contact where that is more [-].
   pure real(dp) function deflection_share(judged) result(share)
      type(judged_scene_t), intent(in) :: judged
      integer :: contact

      share = -huge(1.0_dp)
      associate (resolved => judged%resolved)
         do contact = 1, contact_count(resolved%problem)
            associate (largest => judged%extremes%highest(seen_loads(contact)))
               share = max(share, largest%value/contact_film(resolved%problem, contact, largest%state))
            end associate
         end do
         share = resolved%deflection_by_load*share
      end associate
   end function deflection_share

   !> An error by the tighter solution, if there is one.
   pure real(dp) function error_value(quantity, verification) result(value)
      integer, intent(in) :: quantity
      type(verification_t), intent(in) :: verification

      value = ieee_value(value, ieee_quiet_nan)
      if (size(verification%harmonic_errors) == 0) return
      select case (quantity)
      case (quantity_film_error)
         value = verification%film_error
      case (quantity_film_minimum_error)
         value = verification%film_minimum_error
      case (quantity_film_maximum_error)
         value = verification%film_maximum_error
      case (quantity_acceleration_error)
         value = verification%acceleration_error
      case (quantity_acceleration_minimum_error)
         value = verification%acceleration_minimum_error
      case (quantity_acceleration_maximum_error)
         value = verification%acceleration_maximum_error
      case (quantity_severity_error)
         value = verification%severity_error
      case (quantity_acceleration_rms_error)
         value = verification%severity_errors%acceleration_rms
      case (quantity_film_force_rms_error)
         value = verification%severity_errors%film_force_rms
      case (quantity_dissipated_power_error)
         value = verification%severity_errors%dissipated_energy
      case default
         continue
      end select
   end function error_value

   !> Numbers of a quantity that is a list, none where they are unknown.
   pure function quantity_list(quantity, judged) result(list)
      !> Code of the quantity
      integer, intent(in) :: quantity
      type(judged_scene_t), intent(in) :: judged
      real(dp), allocatable :: list(:)
      !> Most numbers of a list
      integer, parameter :: most = 40
      integer :: place(2), i

      allocate (list(0))
      if (.not. judged%judged) return
      select case (quantity)
      case (quantity_harmonics)
         if (judged%rattle%spectrum%moving) list = judged%rattle%spectrum%harmonics(:min(most, &
            size(judged%rattle%spectrum%harmonics)))
      case (quantity_harmonic_errors)
         if (allocated(judged%verification%harmonic_errors)) &
            list = judged%verification%harmonic_errors(:min(most, size(judged%verification%harmonic_errors)))
      case (quantity_floquet_multipliers)
         if (judged%orbit%period > 0) list = [(judged%orbit%multipliers(i)%re, judged%orbit%multipliers(i)%im, &
                                               i=1, size(judged%orbit%multipliers))]
      case default
         place = findloc(quantities_of_contacts, quantity)
         if (place(1) > 0) list = impact_list(place(2), judged%impacts%contacts(place(1)), judged)
      end select
   end function quantity_list

   !> Numbers of quantities in a row, as columns_of names them; NaN where unknown.
   pure function quantity_numbers(quantities, judged) result(numbers)
      !> Codes
      integer, intent(in) :: quantities(:)
      type(judged_scene_t), intent(in) :: judged
      real(dp), allocatable :: numbers(:)
      real(dp) :: listed(numbers_in_a_row)
      integer :: i

      allocate (numbers(0))
      do i = 1, size(quantities)
         if (quantity_table(quantities(i))%kind == a_list) then
            associate (list => quantity_list(quantities(i), judged))
               listed = ieee_value(0.0_dp, ieee_quiet_nan)
               listed(:min(size(list), size(listed))) = list(:min(size(list), size(listed)))
            end associate
            numbers = [numbers, listed]
         else
            numbers = [numbers, quantity_value(quantities(i), judged)]
         end if
      end do
   end function quantity_numbers

   !> A number of each impact on a contact that is kept.
   pure function impact_list(part, impacts, judged) result(list)
      !> As of contact_value
      integer, intent(in) :: part
      type(impact_count_t), intent(in) :: impacts
      type(judged_scene_t), intent(in) :: judged
      real(dp), allocatable :: list(:)

      allocate (list(0))
      if (.not. allocated(impacts%kept)) return
      select case (part)
      case (contact_impact_times)
         list = (real(judged%ending%periods - judged%window_periods, dp) + impacts%kept%time)/judged%resolved%problem%frequency
      case (contact_impact_loads)
         list = impacts%kept%load
      case (contact_impact_velocities)
         list = impacts%kept%velocity
      case default
         list = impacts%kept%impulse
      end select
   end function impact_list

   !> 1 or 0.
   elemental real(dp) function flag(is_set)
      logical, intent(in) :: is_set

      flag = merge(1.0_dp, 0.0_dp, is_set)
   end function flag

end module judged_scene
