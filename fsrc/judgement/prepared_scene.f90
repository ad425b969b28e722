!> A scene as it is solved and judged: what follows from it, the limits of its classes, and what its engine is asked.
module prepared_scene
   use constants, only: two_pi
   use collocation_basis, only: iteration_share
   use engine, only: request_t
   use film_pressure, only: pressure_scale
   use flank_elasticity, only: deflection_by_load
   use force, only: largest_oscillation
   use kinds, only: dp
   use linear_motion, only: natural_motion
   use problem, only: acceleration_by_lengths, films_at_rest, force_to_resolve, linearise, problem_of, problem_t
   use regime, only: steel_tooth
   use regime_check, only: steady_alpha_p
   use rupture, only: squeeze_group
   use scene_types, only: drag_t, excitation_t, iteration_newton, method_newmark, predictor_extrapolated, scene_t, &
      spectrum_choice_t, until_steady
   use taylor_step_control, only: film_weight, lienard_weight
   implicit none(type, external)
   private

   !> Acceleration by which films in nodes may be off without any motion, over the accuracy and what the force gives the mass [-]
   real(dp), parameter :: nodal_share = 0.02_dp

   !> What follows from a scene.
   type, public :: resolved_scene_t
      type(problem_t) :: problem = problem_t()
      !> Drag torque on a loose gear of &gear
      type(drag_t) :: drag = drag_t()
      !> Arm by which a force along the normal of the flanks turns the loose gear of &gear [m]; 0: there is none
      real(dp) :: gear_arm = 0.0_dp
      !> Revolutions of that gear [1/s]; 0: not known
      real(dp) :: gear_speed = 0.0_dp
      !> Film that carries Q + m g [m]; 0 where no rigid film does: then nothing that rests on it is known
      real(dp) :: steady_film = 0.0_dp
      !> Of small motions about it, with the total derivatives of the scene's own film; 0: they do not oscillate, or it is not known
      real(dp) :: natural_frequency = 0.0_dp
      real(dp) :: damping_ratio = 0.0_dp
      !> Squeeze group A at t = 0 [-]
      real(dp) :: initial_squeeze_group = 0.0_dp
      !> Pressure group B at the steady film [-]
      real(dp) :: pressure_group = 0.0_dp
      !> Largest alpha p at the steady film, exact [-]
      real(dp) :: alpha_p = 0.0_dp
      !> By how much a tooth deflects under a load; one that is taken for rigid as a steel tooth [m/N]
      real(dp) :: deflection_by_load = 0.0_dp
      !> Load of an impact without oil at the sum of the velocity amplitudes that the force gives the mass [N]
      real(dp) :: dry_impact = 0.0_dp
      !> Amplitude of acceleration that rounding and the accuracy of the scene's own method explain [m/s2]
      real(dp) :: noise_floor = 0.0_dp
      !> What of it rounding explains, and what an accuracy of one would [m/s2]
      real(dp), private :: rounding_noise = 0.0_dp, noise_by_accuracy = 0.0_dp
   contains
      procedure :: noise_floor_at
   end type resolved_scene_t

   !> A scene that is ready to be solved and judged.
   type, public :: prepared_scene_t
      type(resolved_scene_t) :: resolved
      !> Limits of its classes and impacts
      type(spectrum_choice_t) :: spectrum
      !> What its engine is asked
      type(request_t) :: request
      !> Code of its method
      integer :: method = 0
      !> Starts whose motions are looked for, and whether the verdicts of these are asked for
      integer :: starts = 1
      logical :: start_verdicts = .true.
      !> Nodes of pressure, where its films are solved in nodes
      integer :: nodes = 0
      !> Whether its film force is summed with those of the other pairs of a gearbox
      logical :: in_gearbox = .false.
   end type prepared_scene_t

   public :: prepare, with_accuracy, resolve, request_of

contains

   !> Prepare a scene for its solution.
   pure type(prepared_scene_t) function prepare(scene) result(prepared)
      !> Checked scene
      type(scene_t), intent(in) :: scene

      prepared%resolved = resolve(scene)
      prepared%spectrum = scene%spectrum
      prepared%request = request_of(scene)
      prepared%method = scene%solver%method
      prepared%starts = scene%solver%starts
      prepared%nodes = scene%film%nodes
      prepared%in_gearbox = scene%gearbox /= ''
   end function prepare

   !> A scene that is solved again with another accuracy of the error-controlled engine.
   elemental type(prepared_scene_t) function with_accuracy(scene, accuracy) result(again)
      type(prepared_scene_t), intent(in) :: scene
      !> Relative accuracy of the film [-]
      real(dp), intent(in) :: accuracy

      again = scene
      again%request%accuracy = accuracy
      again%resolved%noise_floor = scene%resolved%noise_floor_at(accuracy)
   end function with_accuracy

   !> Work out what follows from a scene.
   pure function resolve(scene) result(resolved)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      type(resolved_scene_t) :: resolved
      real(dp) :: static_load, stiffness, damping, rest(2), force

      resolved%problem = problem_of(scene)
      if (scene%gear%given) resolved%drag = scene%drag
      ! The mass of the contact is the inertia of the loose gear over the square of the arm.
      if (scene%gear%given) resolved%gear_arm = sqrt(scene%gear%loose_inertia/scene%excitation%mass)
      if (scene%gear%given) resolved%gear_speed = scene%shaft%speed_rpm/60.0_dp*real(scene%gear%teeth_1, dp)/ &
                                                  real(scene%gear%teeth_2, dp)
      resolved%deflection_by_load = deflection_by_load(scene%contact, steel_tooth)
      resolved%dry_impact = free_velocity(scene%excitation)*sqrt(scene%excitation%mass/resolved%deflection_by_load)
      static_load = scene%excitation%static_load()
      rest = films_at_rest(resolved%problem, static_load)
      resolved%steady_film = rest(1)
      associate (problem => resolved%problem, film => resolved%problem%contact%film, mass => resolved%problem%mass)
         if (problem%initial_film > 0.0_dp) resolved%initial_squeeze_group = &
            squeeze_group(film%radius, film%speed, problem%initial_film, problem%initial_velocity)
         resolved%rounding_noise = 1.0e-12_dp*(abs(static_load) + largest_oscillation(problem%force))/mass
         resolved%noise_floor = resolved%rounding_noise
         if (.not. resolved%steady_film > 0.0_dp) return
         call linearise(problem, rest, stiffness, damping)
         call natural_motion(problem, rest, resolved%natural_frequency, resolved%damping_ratio)
         force = force_to_resolve(problem, static_load)
         resolved%noise_by_accuracy = noise_of_steps(minval(rest), stiffness/mass, damping/mass, &
                                                     force/mass, problem%frequency)
         ! What is left over of the compression of contacts when the iterations of an implicit step end
        resolved%noise_by_accuracy = max(resolved%noise_by_accuracy, acceleration_by_lengths(problem, iteration_share*minval(rest)))
         ! Steps of films in nodes follow the loads that there are, to shares of them.
         if (film%in_nodes) resolved%noise_by_accuracy = nodal_share*force/mass
         ! Newmark's steps are not chosen by an accuracy, and at rest they stand still. What a loose tolerance makes of them
         ! is a motion that the verification doubts.
         if (scene%solver%method /= method_newmark) resolved%noise_floor = resolved%noise_floor_at(scene%solver%accuracy)
         resolved%pressure_group = film%pressure_viscosity* &
                                   pressure_scale(film%radius, film%speed, film%viscosity, minval(rest))
         resolved%alpha_p = steady_alpha_p(film, minval(rest))
      end associate
   end function resolve

   !> Sum of the amplitudes of velocity that all harmonics of the force give a mass that nothing holds [m/s].
   pure real(dp) function free_velocity(excitation)
      type(excitation_t), intent(in) :: excitation

      free_velocity = excitation%force_amplitude
      if (allocated(excitation%force_orders)) free_velocity = sum(excitation%force_amplitudes/real(excitation%force_orders, dp))
      free_velocity = excitation%force_scale*free_velocity/(two_pi*excitation%frequency*excitation%mass)
   end function free_velocity

   !> What a scene asks of its engine.
   pure type(request_t) function request_of(scene) result(request)
      !> Checked scene
      type(scene_t), intent(in) :: scene

      request%accuracy = scene%solver%accuracy
      request%periods = scene%solver%periods
      request%samples_per_period = scene%solver%samples_per_period()
      request%sampled_periods = scene%spectrum%periods
      request%until_steady = scene%solver%until == until_steady
      request%all_samples = scene%output%series
      request%impact_limit = scene%spectrum%impact_limit
      request%time_limit = scene%solver%time_limit
      request%tolerance = scene%solver%tolerance
      request%iteration_limit = scene%solver%iteration_limit
      request%by_newton = scene%solver%iteration == iteration_newton
      request%extrapolate = scene%solver%predictor == predictor_extrapolated
   end function request_of

   !> Amplitude of acceleration that rounding and the accuracy of a solution of the error-controlled engine explain [m/s2].
   elemental real(dp) function noise_floor_at(self, accuracy)
      !> A resolved scene
      class(resolved_scene_t), intent(in) :: self
      !> Relative accuracy of the film [-]
      real(dp), intent(in) :: accuracy

      noise_floor_at = max(self%rounding_noise, accuracy*self%noise_by_accuracy)
   end function noise_floor_at

   !> Acceleration by which the error-controlled engine may be off at the steady film, by an accuracy of one [m/s2]. Its
   !> step control holds errors of film and Lienard variable against one measure, that of the film as it is, that of the
   !> Lienard variable by its weight; the film error moves the load by the stiffness, the other by the damping.
   pure real(dp) function noise_of_steps(film, stiffness, damping, load, frequency)
      !> Steady film [m]
      real(dp), intent(in) :: film
      !> Stiffness [1/s2], damping [1/s] and load [m/s2] by mass
      real(dp), intent(in) :: stiffness
      real(dp), intent(in) :: damping
      real(dp), intent(in) :: load
      !> Frequency of the force [Hz], whose period is the unit of time of the step control
      real(dp), intent(in) :: frequency
      !> A step is held to the accuracy times its length and a share, 4 to 40 a period, and may be a quarter of one long:
      !> up to ten times the accuracy. So much may be there of the film errors, which add up over many steps, and of the
      !> load, which a long step of much damping changes; a Lienard variable is forgotten sooner.
      real(dp), parameter :: most_share = 10.0_dp
      real(dp) :: film_error, lienard_error

      film_error = film_weight(1.0_dp)
      lienard_error = film_error/lienard_weight(1.0_dp, damping/frequency, most_share*load/(film*frequency**2))
      noise_of_steps = film*(most_share*stiffness*film_error + damping*frequency*lienard_error)
   end function noise_of_steps

end module prepared_scene
