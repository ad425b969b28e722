!> Rules between the numbers of a scene: read, swept or drawn by a campaign, they must hold.
module scene_rules
   use flank_elasticity, only: flattening_compliance, roelands_logarithm
   use kinds, only: dp
   use scene_types, only: drag_given, law_elastohydrodynamic, least_entrainment_speed, least_static_load, model_resolved, &
                          scene_t, viscosity_roelands
   implicit none(type, external)
   private

   integer, parameter, public :: sentence_length = 160

   !> A rule that a scene breaks.
   type, public :: rule_t
      !> The keys that it concerns, as group.name with a blank behind each; its fault is reported at the first
      character(64) :: keys
      character(sentence_length) :: sentence
   end type rule_t

   public :: broken_rules, broken_elastic_rules

contains

   !> The rules that a scene breaks.
   pure function broken_rules(scene) result(broken)
      !> Each of its numbers is one that can be computed with
      type(scene_t), intent(in) :: scene
      type(rule_t), allocatable :: broken(:)
      type(rule_t) :: rules(7)
      logical :: holds(7)

      associate (contact => scene%contact, excitation => scene%excitation, solver => scene%solver, spectrum => scene%spectrum)
         rules(1) = rule_t('load.steady_force load.mass load.gravity', &
                           'the static load steady_force + mass*gravity must be positive, at least 1e-12 N')
         holds(1) = contact%backlash > 0.0_dp .or. excitation%static_load() >= least_static_load
         rules(2) = rule_t('film.initial_film contact.backlash', &
                           'the film must be below the backlash, so that the coast flank has one')
         holds(2) = .not. (contact%backlash > 0.0_dp .and. scene%film%initial_film >= contact%backlash)
         rules(3) = rule_t('kinematics.surface_speed_1 kinematics.surface_speed_2', &
                           'the sum of both surface speeds must be positive, at least 2e-9 m/s')
         holds(3) = scene%kinematics%entrainment_speed >= least_entrainment_speed
         rules(4)%keys = 'solver.periods spectrum.periods'
         holds(4) = solver%periods >= spectrum%periods
         ! Not by integer_text: threads come here, and gfortran keeps the length of a text that a function allocates for all of
         ! them.
         if (.not. holds(4)) write (rules(4)%sentence, '(ss, a, i0, a)') 'at least &spectrum periods (', spectrum%periods, &
            ') must be solved'
         rules(5) = rule_t('oil.viscosity_100_cst oil.viscosity_40_cst', 'at 100 degC an oil is thinner than at 40 degC')
         holds(5) = .not. scene%oil%given .or. scene%oil%viscosity_100_cst < scene%oil%viscosity_40_cst
         rules(6) = rule_t('contact.damping_ratio', 'rigid teeth have no damping: give contact.stiffness too, or leave this out')
         holds(6) = .not. contact%damping_ratio > 0.0_dp .or. contact%stiffness > 0.0_dp
         rules(7) = rule_t('contact.damping_ratio', "films in nodes need teeth without damping; set film.model = 'closure'")
         holds(7) = .not. max(contact%damping_ratio, scene%gear%tooth_damping_ratio) > 0.0_dp .or. &
                    .not. (scene%film%automatic .or. scene%film%model == model_resolved)
         if (scene%gear%given) then
            rules(1) = rule_t('gear.drag_torque', 'without a backlash the drag torque must be positive')
            holds(1) = scene%gear%backlash > 0.0_dp .or. scene%gear%drag_torque > 0.0_dp &
                       .or. scene%gear%drag_known_by() /= drag_given
            rules(2)%keys = 'film.initial_film gear.backlash'
            holds(2) = .not. (scene%gear%backlash > 0.0_dp .and. scene%film%initial_film >= scene%gear%backlash)
            rules(6) = rule_t('gear.tooth_damping_ratio gear.tooth_stiffness', 'rigid teeth have no damping: give '// &
                              'gear.tooth_stiffness too, or leave this out')
            holds(6) = .not. scene%gear%tooth_damping_ratio > 0.0_dp .or. scene%gear%tooth_stiffness > 0.0_dp
            rules(7)%keys = 'gear.tooth_damping_ratio'
         end if
      end associate
      broken = pack(rules,.not. holds)
      ! Those of a drawing and a data sheet are compared with what follows from them.
      if (.not. (scene%gear%given .or. scene%oil%given)) broken = [broken, broken_elastic_rules(scene)]
   end function broken_rules

   !> The rules of elastic flanks that a scene breaks.
   pure function broken_elastic_rules(scene) result(broken)
      !> Derived
      type(scene_t), intent(in) :: scene
      type(rule_t), allocatable :: broken(:)
      character(*), parameter :: contact_keys = ' contact.length lubricant.viscosity '
      character(sentence_length) :: sentence
      character(64) :: keys
      real(dp) :: flattening

      allocate (broken(0))
      associate (contact => scene%contact, viscosity => scene%lubricant%viscosity)
         keys = 'lubricant.viscosity '
         if (scene%oil%given) keys = 'oil.temperature_celsius '
         if (scene%lubricant%viscosity_law == viscosity_roelands .and. viscosity > 0.0_dp) then
            if (.not. roelands_logarithm(viscosity) > 0.0_dp) broken = [rule_t(keys, &
               'Roelands'' law is for viscosities above 6.3e-5 Pa s, where ln(viscosity) + 9.67 is positive')]
         end if
         if (scene%film%law /= law_elastohydrodynamic .and. contact%flattening_included) return
         if (.not. min(contact%length, viscosity, scene%kinematics%entrainment_speed, contact%young_modulus) > 0.0_dp) return
         if (.not. (contact%radius > 0.0_dp .or. contact%radius_1*contact%radius_2 > 0.0_dp)) return
         flattening = flattening_compliance(scene)
         keys = 'contact.stiffness'//contact_keys
         if (scene%gear%given) keys = 'gear.tooth_stiffness '
         if (.not. flattening > 0.0_dp) then
            if (.not. contact%stiffness > 0.0_dp) keys = 'contact.length lubricant.viscosity '
            if (scene%gear%given) keys = 'gear.face_width '
            broken = [broken, rule_t(keys, 'the contact is wider than the radius at this viscosity and speed: its flanks '// &
                                     'are no plane contact')]
         else if (scene%film%law == law_elastohydrodynamic .and. contact%flattening_included &
                  .and. contact%stiffness*flattening > 1.0_dp) then
            write (sentence, '(ss, 2(a, es10.3), a)') 'the flanks alone have', 1.0_dp/flattening, ' N/m, less than the', &
               contact%stiffness, ' N/m with them; or set flattening_included = .false.'
            broken = [broken, rule_t(keys, sentence)]
         end if
      end associate
   end function broken_elastic_rules

end module scene_rules
