!> Random scenes over decades of every quantity. A scene depends on its number and the seed alone, so that any
!> one of them can be had again without the others. Scenes come in groups that share law, periods and
!> accuracy, as the engines that solve many scenes at once want it.
module random_scenes
   use constants, only: standard_gravity
   use film_law, only: film_load, film_t, new_film, overflow_load
   use kinds, only: dp, int64
   use random_walk, only: next_uniform, random_state_t
   use prepared_scene, only: resolve, resolved_scene_t
   use run_sweep, only: carried_state_t
   use scene_types, only: law_iso_viscous, law_piezo_viscous, model_published, model_reynolds, &
      rupture_half_pi, &
                          rupture_solved, rupture_solver_fast, rupture_solver_successive, scene_t
   implicit none(type, external)
   private

   !> Scenes of a group.
   integer, parameter, public :: group_size = 64

   !> Film laws, as the table of outcomes names them.
   integer, parameter, public :: laws = 6
   character(*), parameter, public :: law_names(laws) = [character(30) :: 'published iso, half-pi', &
      'published iso, solved', 'published iso, successive (18)', 'published piezo', 'reynolds iso', &
      'reynolds piezo']
   !> Law of a group, by turns. Successive substitution costs ten times the others and comes least.
   integer, parameter :: law_turns(16) = [1, 2, 4, 5, 6, 1, 4, 5, 2, 1, 4, 5, 2, 6, 4, 3]

   !> Ranges, each drawn evenly in the logarithm: R [m], U [m/s], film under the static load [m], eta0 [Pa s],
   !> alpha [1/Pa], static load [N], mass [kg], f_exc [Hz].
   real(dp), parameter :: radii(2) = [2.0e-3_dp, 0.1_dp], speeds(2) = [0.02_dp, 40.0_dp], films(2) = &
      [20.0e-9_dp, 50.0e-6_dp], &
                          viscosities(2) = [1.0e-3_dp, 3.0_dp], coefficients(2) = [1.0e-9_dp, 5.0e-8_dp], &
                          loads(2) = [1.0_dp, 1.0e4_dp], masses(2) = [0.01_dp, 30.0_dp], frequencies(2) = &
                          [10.0_dp, 5.0e3_dp]
   !> Accuracies of the error-controlled engines, by chance [-].
   real(dp), parameter :: accuracies(3) = [1.0e-4_dp, 1.0e-6_dp, 1.0e-8_dp]
   !> Largest amplitude of the force over the static load.
   real(dp), parameter :: largest_ratio = 10.0_dp
   !> Largest B of a steady piezo-viscous film.
   real(dp), parameter :: critical_group = 7.8898286226979752_dp

   !> What the scenes of a group share.
   type, public :: group_t
      integer(int64) :: number = 0
      integer :: law = 1
      integer :: periods = 0
      !> Accuracy of the error-controlled engines [-]
      real(dp) :: accuracy = 0.0_dp
      !> Long runs, in which a slow drift shows
      logical :: long = .false.
   end type group_t

   !> A scene ready for every engine.
   type, public :: drawn_scene_t
      integer(int64) :: number = 0
      type(scene_t) :: scene
      type(resolved_scene_t) :: resolved
      !> What the value before has left, where a sweep carries on
      type(carried_state_t) :: before
   end type drawn_scene_t

   public :: choose_law, draw, draw_group, draw_scene, group_of

contains

   !> Number of the group of a scene.
   elemental integer(int64) function group_of(number)
      !> Number of the scene, from 0 on
      integer(int64), intent(in) :: number

      group_of = number/int(group_size, int64)
   end function group_of

   !> What the scenes of a group share.
   pure function draw_group(seed, number) result(group)
      !> Any number
      integer(int64), intent(in) :: seed
      !> Number of the group, from 0 on
      integer(int64), intent(in) :: number
      type(group_t) :: group
      type(random_state_t) :: state
      real(dp) :: number_drawn

      state = random_state_t(seed=seed, stream=2_int64*number)
      group%number = number
      group%law = law_turns(1 + int(modulo(number, int(size(law_turns), int64))))
      call next_uniform(state, number_drawn)
      group%periods = 12 + int(13.0_dp*number_drawn)
      call next_uniform(state, number_drawn)
      group%accuracy = accuracies(1 + int(3.0_dp*number_drawn))
      call next_uniform(state, number_drawn)
      group%long = number_drawn < 1.0_dp/16.0_dp
      if (group%long) group%periods = 150
   end function draw_group

   !> A scene. The length of the contact is what lets the film come out that was drawn; it may come out
   !> absurd, but length, load and mass enter the motion by their ratios alone.
   pure function draw_scene(seed, number) result(drawn)
      !> Any number
      integer(int64), intent(in) :: seed
      !> Number of the scene, from 0 on
      integer(int64), intent(in) :: number
      type(drawn_scene_t) :: drawn
      type(group_t) :: group
      type(random_state_t) :: state
      type(film_t) :: law
      real(dp) :: film, load, by_film, by_velocity, static_load, share, unit_group

      group = draw_group(seed, group_of(number))
      state = random_state_t(seed=seed, stream=2_int64*number + 1_int64)
      drawn%number = number
      associate (scene => drawn%scene)
         call choose_law(group%law, scene)
         scene%contact%young_modulus = 205.66e9_dp
         scene%contact%poisson_ratio = 0.3_dp
         scene%excitation%gravity = standard_gravity
         call draw(state, radii, scene%contact%radius)
         call draw(state, speeds, scene%kinematics%entrainment_speed)
         call draw(state, films, film)
         call draw(state, viscosities, scene%lubricant%viscosity)
         call draw(state, coefficients, scene%lubricant%pressure_viscosity)
         if (scene%film%law == law_piezo_viscous .and. scene%film%model == model_reynolds) then
            ! Nearly all B would be far above the critical one: here it is drawn, and alpha follows.
            call draw(state, [0.005_dp, 1.05_dp], share)
            unit_group = 6.0_dp*sqrt(2.0_dp*scene%contact%radius)*scene%lubricant%viscosity* &
                         2.0_dp*scene%kinematics%entrainment_speed/(film*sqrt(film))
            scene%lubricant%pressure_viscosity = share*critical_group/unit_group
         end if
         call draw(state, loads, static_load)
         call draw(state, [masses(1), min(masses(2), 0.999_dp*static_load/standard_gravity)], scene%excitation%mass)
         scene%excitation%steady_force = static_load - scene%excitation%mass*standard_gravity
         call draw(state, frequencies, scene%excitation%frequency)
         call draw_amplitude(state, static_load, scene%excitation%force_amplitude)
         scene%contact%length = 1.0_dp
         law = new_film(scene)
         call film_load(law, film, 0.0_dp, load, by_film, by_velocity)
         if (load > 0.0_dp .and. load < overflow_load) scene%contact%length = static_load/load
         call draw_start(state, film, law%speed*sqrt(2.0_dp*film/scene%contact%radius)/4.0_dp, scene)
         scene%solver%periods = group%periods
         scene%solver%accuracy = group%accuracy
         scene%solver%tolerance = 1.0e-9_dp*film
         scene%solver%iteration_limit = 100
         scene%solver%steps_per_period = 512
         scene%spectrum%periods = 4
         drawn%resolved = resolve(scene)
      end associate
   end function draw_scene

   !> Film law of a scene.
   pure subroutine choose_law(law, scene)
      !> Place in `law_names`
      integer, intent(in) :: law
      !> Gets the law
      type(scene_t), intent(inout) :: scene

      scene%film%law = merge(law_piezo_viscous, law_iso_viscous, law == 4 .or. law == 6)
      scene%film%model = merge(model_reynolds, model_published, law >= 5)
      scene%film%rupture = merge(rupture_solved, rupture_half_pi, law == 2 .or. law == 3)
      scene%film%rupture_solver = merge(rupture_solver_successive, rupture_solver_fast, law == 3)
   end subroutine choose_law

   !> Amplitude of the force: none, small, or anything up to ten static loads.
   pure subroutine draw_amplitude(state, static_load, amplitude)
      type(random_state_t), intent(inout) :: state
      !> [N]
      real(dp), intent(in) :: static_load
      !> F0 [N]
      real(dp), intent(out) :: amplitude
      real(dp) :: kind, size_drawn

      call next_uniform(state, kind)
      call next_uniform(state, size_drawn)
      amplitude = largest_ratio*static_load*size_drawn
      if (kind < 0.5_dp) amplitude = largest_ratio*static_load*10.0_dp**(-4.0_dp*size_drawn)
      if (kind < 0.05_dp) amplitude = 0.0_dp
   end subroutine draw_amplitude

   !> Start: mostly at rest on the steady film, else off it or in motion.
   pure subroutine draw_start(state, film, velocity_unit, scene)
      type(random_state_t), intent(inout) :: state
      !> Film under the static load [m]
      real(dp), intent(in) :: film
      !> Velocity for which the squeeze group A is one [m/s]
      real(dp), intent(in) :: velocity_unit
      !> Gets the start
      type(scene_t), intent(inout) :: scene
      real(dp) :: kind, ratio

      call next_uniform(state, kind)
      call draw(state, [0.2_dp, 20.0_dp], ratio)
      if (kind < 0.3_dp) scene%film%initial_film = ratio*film
      call next_uniform(state, kind)
      call draw(state, [0.05_dp, 50.0_dp], ratio)
      if (kind < 0.1_dp) scene%film%initial_velocity = ratio*velocity_unit
      if (kind < 0.05_dp) scene%film%initial_velocity = -ratio*velocity_unit
   end subroutine draw_start

   !> A number between two limits, even in its logarithm.
   pure subroutine draw(state, limits, value)
      !> Where the numbers come from
      type(random_state_t), intent(inout) :: state
      !> Least and most
      real(dp), intent(in) :: limits(2)
      !> The number
      real(dp), intent(out) :: value
      real(dp) :: number

      call next_uniform(state, number)
      value = limits(1)*(limits(2)/limits(1))**number
   end subroutine draw

end module random_scenes
