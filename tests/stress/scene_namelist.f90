!> The namelist of a scene, ready to run, so that what failed can be seen again.
module scene_namelist
   use input_entry, only: numbers_text
   use kinds, only: dp
   use random_scenes, only: drawn_scene_t
   use scene_types, only: iteration_successive, law_iso_viscous, method_newmark, &
      model_published, model_reynolds, predictor_previous, rupture_half_pi, &
                          rupture_solver_fast, &
                          scene_t, until_steady
   use text, only: integer_text, real_text
   implicit none(type, external)
   private

   public :: print_namelist

contains

   !> Write the scene with its solver.
   subroutine print_namelist(unit, drawn, remark)
      !> Open unit
      integer, intent(in) :: unit
      !> The scene
      type(drawn_scene_t), intent(in) :: drawn
      !> What happened
      character(*), intent(in) :: remark

      associate (scene => drawn%scene)
         write (unit, '(a)') '! '//remark
         write (unit, '(a)') "&scene task = 'motion' /"
         write (unit, '(a)') '&contact radius = '//real_text(scene%contact%radius)//', length = '// &
            real_text(scene%contact%length)//flank_keys(scene)//' /'
         write (unit, '(a)') '&lubricant viscosity = '//real_text(scene%lubricant%viscosity)// &
            ', pressure_viscosity = '// &
            real_text(scene%lubricant%pressure_viscosity)//' /'
         write (unit, '(a)') '&kinematics entrainment_speed = '// &
            real_text(scene%kinematics%entrainment_speed)//' /'
         write (unit, '(a)') '&load mass = '//real_text(scene%excitation%mass)//', steady_force = '// &
            real_text(scene%excitation%steady_force)//force_keys(scene)// &
            ', frequency = '//real_text(scene%excitation%frequency)//', gravity = '//real_text(scene%excitation%gravity)//' /'
         write (unit, '(a)') film_group(scene)
         write (unit, '(a)') solver_group(scene)
         write (unit, '(a)') '&spectrum periods = '//integer_text(scene%spectrum%periods)//' /'
         write (unit, '(a)') '&output overwrite = .true. /'
         write (unit, '(a)') ''
      end associate
   end subroutine print_namelist

   !> Keys of the coast flank and of elastic teeth.
   function flank_keys(scene) result(words)
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: words

      words = ''
      if (scene%contact%backlash > 0.0_dp) words = ', backlash = '//real_text(scene%contact%backlash)
      if (scene%contact%stiffness > 0.0_dp) words = words//', stiffness = '//real_text(scene%contact%stiffness)
   end function flank_keys

   !> Keys of the force that oscillates.
   function force_keys(scene) result(words)
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: words

      associate (excitation => scene%excitation)
         if (allocated(excitation%force_orders)) then
            words = ', force_orders = '//numbers_text(real(excitation%force_orders, dp))//', force_amplitudes = '// &
                    numbers_text(excitation%force_amplitudes)//', force_phases = '//numbers_text(excitation%force_phases)
         else
            words = ', force_amplitude = '//real_text(excitation%force_amplitude)
         end if
         words = words//', force_scale = '//real_text(excitation%force_scale)
      end associate
   end function force_keys

   !> &film
   function film_group(scene) result(line)
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: line

      line = '&film'
      if (scene%film%law == law_iso_viscous) then
         line = line//" law = 'iso-viscous'"
      else
         line = line//" law = 'piezo-viscous'"
      end if
      if (scene%film%model == model_reynolds) line = line//", model = 'reynolds'"
      if (scene%film%model == model_published .and. scene%film%law == law_iso_viscous) then
         if (scene%film%rupture == rupture_half_pi) then
            line = line//", rupture = 'half-pi'"
         else if (scene%film%rupture_solver == rupture_solver_fast) then
            line = line//", rupture = 'solved'"
         else
            line = line//", rupture = 'solved', rupture_solver = 'successive'"
         end if
      end if
      if (scene%film%initial_film > 0.0_dp) line = line//', initial_film = '// &
         real_text(scene%film%initial_film)
      line = line//', initial_velocity = '//real_text(scene%film%initial_velocity)//' /'
   end function film_group

   !> &solver
   function solver_group(scene) result(line)
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: line

      line = '&solver'
      associate (solver => scene%solver)
         if (solver%method == method_newmark) then
            line = line//" method = 'newmark'"
            if (solver%iteration == iteration_successive) line = line//", iteration = 'successive'"
            if (solver%predictor == predictor_previous) line = line//", predictor = 'previous'"
            line = line//', tolerance = '//real_text(solver%tolerance)//', steps_per_period = '// &
                   integer_text(solver%steps_per_period)
         else
            line = line//" method = 'taylor', accuracy = "//real_text(solver%accuracy)
         end if
         if (solver%method /= method_newmark .and. solver%kept_per_period > 0) &
            line = line//', samples_per_period = '//integer_text(solver%kept_per_period)
         if (solver%until == until_steady) line = line//", until = 'steady'"
         line = line//', periods = '//integer_text(solver%periods)//' /'
      end associate
   end function solver_group

end module scene_namelist
