!> Rules between the numbers of a scene: read, swept or drawn by a campaign, they must hold.
module scene_rules
   use kinds, only: dp
   use scene_types, only: drag_given, least_entrainment_speed, least_static_load, scene_t
   implicit none(type, external)
   private

   integer, parameter, public :: sentence_length = 160

   !> A rule that a scene breaks.
   type, public :: rule_t
      !> The keys that it concerns, as group.name with a blank behind each; its fault is told at the first
      character(64) :: keys
      character(sentence_length) :: sentence
   end type rule_t

   public :: broken_rules

contains

   !> The rules that a scene breaks.
   pure function broken_rules(scene) result(broken)
      !> Each of its numbers is one that can be computed with
      type(scene_t), intent(in) :: scene
      type(rule_t), allocatable :: broken(:)
      type(rule_t) :: rules(5)
      logical :: holds(5)

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
         if (.not. holds(4)) write (rules(4)%sentence, '(a, i0, a)') 'at least &spectrum periods (', spectrum%periods, &
            ') must be solved'
         rules(5) = rule_t('oil.viscosity_100_cst oil.viscosity_40_cst', 'at 100 degC an oil is thinner than at 40 degC')
         holds(5) = .not. scene%oil%given .or. scene%oil%viscosity_100_cst < scene%oil%viscosity_40_cst
         if (scene%gear%given) then
            rules(1) = rule_t('gear.drag_torque', 'without a backlash the drag torque must be positive')
            holds(1) = scene%gear%backlash > 0.0_dp .or. scene%gear%drag_torque > 0.0_dp &
                       .or. scene%gear%drag_known_by() /= drag_given
            rules(2)%keys = 'film.initial_film gear.backlash'
            holds(2) = .not. (scene%gear%backlash > 0.0_dp .and. scene%film%initial_film >= scene%gear%backlash)
         end if
      end associate
      broken = pack(rules,.not. holds)
   end function broken_rules

end module scene_rules
