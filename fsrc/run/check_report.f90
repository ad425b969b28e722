!> What --check reports of an input: what follows from it before anything is solved.
module check_report
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use film_law, only: with_exact_film
   use film_pressure, only: exact_pressure
   use film_state, only: load_t
   use flank_contact, only: load_at_rest
   use force, only: inertia_ratio, largest_oscillation
   use kinds, only: dp
   use prepared_scene, only: resolve, resolved_scene_t
   use problem, only: reference_film
   use regime, only: contact_deflection, film_elastohydrodynamic, film_iso_viscous, film_regime, hertzian_pressure, &
      rigid_limit
   use regime_check, only: check_regime, fitting_law, model_limit, model_limit_sentence, regime_verdict_t, within_model
   use scene_report, only: speed_meaning, stiffness_warning
   use scene_types, only: drag_computed, scene_t
   use text, only: short_text
   implicit none(type, external)
   private

   public :: resolved_lines

contains

   !> What follows from a scene, for --check.
   pure function resolved_lines(scene, resolved) result(lines)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What follows from it
      type(resolved_scene_t), intent(in) :: resolved
      character(:), allocatable :: lines
      character(1), parameter :: end_of_line = new_line('a')
      character(:), allocatable :: warning
      type(load_t) :: load
      real(dp) :: share, thinner
      integer :: limit

      share = 0.0_dp
      if (resolved%steady_film > 0.0_dp) then
         thinner = reference_film(resolved%problem)
         load = load_at_rest(resolved%problem%contact, thinner, 0.0_dp)
         share = resolved%deflection_by_load*load%load/thinner
         lines = '! steady film                          '//short_text(resolved%steady_film, 10)//' m'//end_of_line
         if (resolved%natural_frequency > 0.0_dp) lines = lines// &
                 '! natural frequency                    '//short_text(resolved%natural_frequency, 6)//' Hz'//end_of_line// &
                 '! damping ratio                        '//short_text(resolved%damping_ratio, 5)//end_of_line
         if (.not. resolved%natural_frequency > 0.0_dp) lines = lines// &
                 '! no natural frequency: small motions about the steady film are overdamped'//end_of_line
         lines = lines// &
                 '! pressure group B at the steady film  '//short_text(resolved%pressure_group, 5)//end_of_line// &
                 '! largest alpha p at the steady film   '//short_text(resolved%alpha_p, 5)//end_of_line// &
                 '! deflection share at the steady film  '//short_text(share, 3)//end_of_line
      else
         lines = '! no rigid piezo-viscous film carries the static load'//end_of_line
      end if
      if (resolved%problem%initial_film > 0.0_dp) lines = lines// &
                 '! film at t = 0                        '//short_text(resolved%problem%initial_film, 10)//' m'//end_of_line// &
                 '! squeeze group A at t = 0             '//short_text(resolved%initial_squeeze_group, 5)//end_of_line
      limit = model_limit(min(resolved%steady_film, resolved%problem%initial_film), &
                          max(resolved%steady_film, resolved%problem%initial_film), &
                          resolved%problem%contact%film%radius)
      if (resolved%problem%initial_film > 0.0_dp .and. limit /= within_model) &
         lines = lines//'! warning: at rest '//model_limit_sentence(limit)//' (model_limit)'//end_of_line
      if (scene%gear%given) lines = lines//teeth_advice(scene)//drag_advice(resolved)
      lines = lines//law_advice(scene)
      warning = stiffness_warning(scene, 'at rest', share)
      if (len(warning) > 0) lines = lines//'! '//warning//end_of_line
      lines = lines//'! A, B and alpha p are those of the Reynolds film with u = '// &
              short_text(resolved%problem%contact%film%speed, 6)//' m/s, '//speed_meaning(scene)
   end function resolved_lines

   !> Profile shifts and contact ratios of a gear pair.
   pure function teeth_advice(scene) result(lines)
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: lines
      character(1), parameter :: end_of_line = new_line('a')

      associate (teeth => scene%teeth)
         lines = '! sum of profile shifts                '//short_text(teeth%shift_sum, 4)//' normal modules'//end_of_line// &
                 '! contact ratio, overlap ratio         '//short_text(teeth%contact_ratio, 4)//', '// &
                 short_text(teeth%overlap_ratio, 4)
         if (.not. teeth%tips_given) lines = lines//', of teeth as high as usual'
      end associate
      lines = lines//end_of_line
   end function teeth_advice

   !> What holds the teeth of a gear pair together, part by part, and whether inertia pulls them apart.
   pure function drag_advice(resolved) result(lines)
      type(resolved_scene_t), intent(in) :: resolved
      character(:), allocatable :: lines
      real(dp) :: ratio

      associate (drag => resolved%drag)
         lines = '! drag torque                          '//short_text(drag%torque, 4)//' N m'
         if (drag%known_by == drag_computed) lines = lines//': bearing '//short_text(drag%bearing, 4)//', synchroniser '// &
            short_text(drag%synchroniser, 4)//', churning '//short_text(drag%churning, 4)
      end associate
      ratio = inertia_ratio(resolved%problem%force)
      lines = lines//new_line('a')
      if (ieee_is_nan(ratio)) return
      lines = lines//'! inertia ratio Lambda                 '//short_text(ratio, 4)//': without oil the tooth '// &
              trim(merge('leaves its flank  ', 'stays on its flank', ratio > 1.0_dp))//new_line('a')
   end function drag_advice

   !> Which film law the film at rest asks for, by the pressure of the Reynolds film there; the motion may ask for more.
   pure function law_advice(scene) result(line)
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: line
      type(resolved_scene_t) :: exact
      type(regime_verdict_t) :: verdict
      real(dp) :: thinner

      exact = resolve(with_exact_film(scene))
      line = ''
      if (.not. exact%steady_film > 0.0_dp) return
      thinner = reference_film(exact%problem)
      associate (film => exact%problem%contact%film)
         verdict = check_regime(film, exact_pressure(film%radius, film%speed, film%viscosity, thinner, 0.0_dp), thinner)
      end associate
      line = '! Reynolds film at rest                '//short_text(exact%steady_film, 4)//' m, alpha p '// &
             short_text(exact%alpha_p, 3)//': '
      if (exact%alpha_p >= rigid_limit) then
         line = line//'no film of rigid flanks fits, '
      else if (verdict%regime == film_elastohydrodynamic) then
         line = line//'pressure bends the flanks, '
      else if (verdict%regime == film_iso_viscous) then
         line = line//'pressure hardly thickens the oil, '
      else
         line = line//'pressure thickens the oil, '
      end if
      line = line//fitting_law(verdict%regime)//new_line('a')//largest_load_advice(scene, exact, thinner)
   end function law_advice

   !> The largest load to be expected, and the film law that it asks for. Where the force lifts the tooth off its flank it is that
   !> of an impact without oil, an upper bound.
   pure function largest_load_advice(scene, exact, thinner) result(line)
      type(scene_t), intent(in) :: scene
      !> It with its Reynolds iso-viscous film
      type(resolved_scene_t), intent(in) :: exact
      !> The thinner of its films at rest [m]
      real(dp), intent(in) :: thinner
      character(:), allocatable :: line
      character(:), allocatable :: named, reason
      type(load_t) :: rest
      real(dp) :: load, pressure, static, deflection

      associate (film => exact%problem%contact%film, force => exact%problem%force)
         static = abs(scene%excitation%static_load())
         load = static + largest_oscillation(force)
         named = 'expected   '
         reason = 'as the force has it'
         if (largest_oscillation(force) > static .and. exact%dry_impact > load) then
            load = exact%dry_impact
            named = 'without oil'
            reason = 'an impact, which oil softens'
         end if
         rest = load_at_rest(exact%problem%contact, thinner, 0.0_dp)
         pressure = hertzian_pressure(film%radius, scene%contact%length, film%modulus, load)
         ! What the steady film of this load would have, if that is less: the pressure goes with the load to 3/2.
         pressure = min(pressure, exact_pressure(film%radius, film%speed, film%viscosity, thinner, 0.0_dp)* &
                        (load/rest%load)**1.5_dp)
         deflection = contact_deflection(film%radius, pressure, film%modulus)
         line = '! largest load '//named//'             '//short_text(load, 3)//' N, '//reason//': alpha p '// &
                short_text(film%pressure_viscosity*pressure, 3)//', '// &
                fitting_law(film_regime(film%pressure_viscosity*pressure, deflection, thinner*rest%load/load))//new_line('a')
      end associate
   end function largest_load_advice

end module check_report
