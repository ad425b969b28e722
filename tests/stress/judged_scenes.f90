!> Random scenes as users have them judged: half of them those of random_scenes, over decades of every quantity, half of
!> them loose gears of a transmission at engine orders of 5 to 60 Hz, with forces up to 50 static loads. These
!> fly far and have hard impacts. The forces of half of all scenes have several orders, up to 32. Campaigns vary loose gears, sweeps
!> scenes of either kind. A scene depends on its number and the seed alone.
module judged_scenes
   use constants, only: standard_gravity
   use film_law, only: new_film, steady_film
   use kinds, only: dp, int64
   use random_walk, only: next_uniform, random_state_t
   use random_scenes, only: choose_law, draw, draw_scene, drawn_scene_t, laws
   use prepared_scene, only: resolve
   use scene_types, only: iteration_newton, iteration_successive, law_piezo_viscous, method_newmark, method_taylor, &
                          model_reynolds, note_orders, predictor_extrapolated, predictor_previous, scene_t, until_periods, &
                          until_steady
   implicit none(type, external)
   private

   !> Ranges of the loose gears, each drawn evenly in the logarithm: R, l [m], m [kg], Q [N], eta0 [Pa s], alpha [1/Pa],
   !> U [m/s], f_exc [Hz], amplitude of the force over the static load.
   real(dp), parameter :: radii(2) = [2.0e-3_dp, 4.0e-2_dp], lengths(2) = [2.0e-3_dp, 4.0e-2_dp], masses(2) = [0.01_dp, 5.0_dp], &
                          loads(2) = [0.5_dp, 300.0_dp], viscosities(2) = [5.0e-3_dp, 1.0_dp], &
                          coefficients(2) = [1.0e-8_dp, 3.0e-8_dp], speeds(2) = [0.1_dp, 20.0_dp], &
                          frequencies(2) = [5.0_dp, 60.0_dp], ratios(2) = [0.1_dp, 50.0_dp]
   real(dp), parameter :: accuracies(8) = [1.0e-8_dp, 1.0e-8_dp, 1.0e-8_dp, 1.0e-8_dp, 1.0e-6_dp, 1.0e-6_dp, 1.0e-4_dp, 1.0e-10_dp]
   integer, parameter :: windows(4) = [1, 4, 8, 16], samples(8) = [512, 512, 512, 512, 512, 512, 128, 2048]
   !> Law of a scene, by chance; successive substitution costs most and comes least.
   integer, parameter :: law_turns(16) = [1, 2, 4, 5, 6, 1, 5, 5, 2, 1, 4, 5, 2, 6, 5, 3]
   integer(int64), parameter :: gear_stream = 2_int64**40, order_stream = 2_int64**43, flank_stream = 2_int64**45
   !> Backlash [m] and stiffness of a tooth [N/m]
   real(dp), parameter :: backlashes(2) = [1.0e-6_dp, 5.0e-4_dp], stiffnesses(2) = [1.0e6_dp, 1.0e11_dp]
   !> Highest order of a force
   integer, parameter :: most_orders = 32

   !> Rows of a campaign, and the keys that it varies: forces, frequency and viscosity of a loose gear.
   integer, parameter, public :: campaign_rows = 32
   !> Values of a sweep.
   integer, parameter, public :: sweep_values = 8
   character(*), parameter, public :: campaign_keys(4) = [character(24) :: 'load.steady_force', 'load.force_scale', &
      'load.frequency', 'lubricant.viscosity']

   public :: draw_campaign, draw_judged_scene, draw_sweep, is_gear

contains

   !> Whether a scene is a loose gear.
   elemental logical function is_gear(number)
      !> Number of the scene, from 0 on
      integer(int64), intent(in) :: number

      is_gear = modulo(number, 2_int64) == 1_int64
   end function is_gear

   !> A scene with the solver that a user may have chosen.
   pure subroutine draw_judged_scene(seed, number, drawn, law)
      !> Any number
      integer(int64), intent(in) :: seed
      !> Number of the scene, from 0 on
      integer(int64), intent(in) :: number
      type(drawn_scene_t), intent(out) :: drawn
      !> Place in law_names
      integer, intent(out) :: law
      type(random_state_t) :: state

      state = random_state_t(seed=seed, stream=gear_stream + number)
      if (is_gear(number)) then
         call draw_gear(state, drawn%scene, law)
      else
         drawn = draw_scene(seed, number)
         law = law_of(drawn%scene)
      end if
      drawn%number = number
      call draw_solver(state, drawn%scene)
      call draw_orders(random_state_t(seed=seed, stream=order_stream + number), drawn%scene)
      call draw_flanks(random_state_t(seed=seed, stream=flank_stream + number), drawn%scene)
      drawn%resolved = resolve(drawn%scene)
   end subroutine draw_judged_scene

   !> A campaign: a loose gear, values of the varied keys, and the scenes that they make.
   pure subroutine draw_campaign(seed, number, base, law, values, drawn)
      !> Any number
      integer(int64), intent(in) :: seed
      !> Number of the campaign, from 0 on
      integer(int64), intent(in) :: number
      !> Base scene
      type(scene_t), intent(out) :: base
      !> Place in law_names
      integer, intent(out) :: law
      !> Varied key, row
      real(dp), intent(out) :: values(size(campaign_keys), campaign_rows)
      !> The scene of every row
      type(drawn_scene_t), intent(out) :: drawn(campaign_rows)
      integer(int64), parameter :: campaign_stream = 2_int64**41
      type(random_state_t) :: state
      real(dp) :: ratio
      logical :: turned
      integer :: i

      state = random_state_t(seed=seed, stream=campaign_stream + number)
      call draw_gear(state, base, law)
      call draw_solver(state, base)
      base%solver%method = method_taylor
      base%film%initial_film = 0.0_dp
      base%excitation%force_amplitude = 1.0_dp
      call draw_orders(random_state_t(seed=seed, stream=2_int64*order_stream + number), base)
      base%excitation%steady_force = 0.0_dp
      call draw_flanks(random_state_t(seed=seed, stream=2_int64*flank_stream + number), base, turned)
      do i = 1, campaign_rows
         call draw(state, loads, values(1, i))
         call draw(state, ratios, ratio)
         values(2, i) = ratio*(values(1, i) + base%excitation%weight())
         if (turned) values(1, i) = -values(1, i)
         call draw(state, frequencies, values(3, i))
         call draw(state, viscosities, values(4, i))
         associate (scene => drawn(i)%scene)
            scene = base
            scene%excitation%steady_force = values(1, i)
            scene%excitation%force_scale = values(2, i)
            scene%excitation%frequency = values(3, i)
            scene%lubricant%viscosity = values(4, i)
         end associate
         drawn(i)%number = number*int(campaign_rows, int64) + int(i - 1, int64)
         drawn(i)%resolved = resolve(drawn(i)%scene)
      end do
   end subroutine draw_campaign

   !> A sweep: a scene of either kind, and its values of frequency, amplitude of the force or static load.
   pure subroutine draw_sweep(seed, number, drawn, law)
      !> Any number
      integer(int64), intent(in) :: seed
      !> Number of the sweep, from 0 on
      integer(int64), intent(in) :: number
      !> The scene of every value, in their order; where it starts is left open
      type(drawn_scene_t), intent(out) :: drawn(sweep_values)
      !> Place in law_names
      integer, intent(out) :: law
      integer(int64), parameter :: sweep_stream = 2_int64**42
      real(dp), parameter :: spans(2) = [1.1_dp, 10.0_dp]
      type(random_state_t) :: state
      real(dp) :: number_of_key, span, factor
      integer :: i

      ! Far from the scenes of the summaries, and far apart: neighbours share their law.
      call draw_judged_scene(seed, sweep_stream + 61_int64*number, drawn(1), law)
      state = random_state_t(seed=seed, stream=sweep_stream + number)
      call next_uniform(state, number_of_key)
      call draw(state, spans, span)
      drawn(1)%scene%solver%method = method_taylor
      drawn(1)%scene%solver%until = until_steady
      drawn(1)%scene%solver%periods = 200
      drawn(1)%scene%film%initial_film = 0.0_dp
      drawn(1)%scene%film%initial_velocity = 0.0_dp
      do i = 1, sweep_values
         drawn(i) = drawn(1)
         drawn(i)%number = number*int(sweep_values, int64) + int(i - 1, int64)
         factor = span**(real(i - 1, dp)/real(sweep_values - 1, dp))
         associate (excitation => drawn(i)%scene%excitation)
            select case (int(3.0_dp*number_of_key))
            case (0)
               excitation%frequency = factor*excitation%frequency
            case (1)
               excitation%force_scale = factor
            case default
               excitation%steady_force = factor*excitation%steady_force
            end select
         end associate
         drawn(i)%resolved = resolve(drawn(i)%scene)
      end do
   end subroutine draw_sweep

   !> Place of the law of a scene in law_names.
   pure integer function law_of(scene) result(law)
      type(scene_t), intent(in) :: scene
      type(scene_t) :: other

      do law = 1, laws - 1
         call choose_law(law, other)
         if (other%film%law == scene%film%law .and. other%film%model == scene%film%model .and. &
             other%film%rupture == scene%film%rupture .and. other%film%rupture_solver == scene%film%rupture_solver) return
      end do
   end function law_of

   !> A loose gear.
   pure subroutine draw_gear(state, scene, law)
      type(random_state_t), intent(inout) :: state
      type(scene_t), intent(inout) :: scene
      integer, intent(out) :: law
      real(dp) :: number, ratio

      call next_uniform(state, number)
      law = law_turns(1 + int(real(size(law_turns), dp)*number))
      call choose_law(law, scene)
      scene%contact%young_modulus = 205.66e9_dp
      scene%contact%poisson_ratio = 0.3_dp
      call next_uniform(state, number)
      scene%excitation%gravity = merge(standard_gravity, 0.0_dp, number < 0.5_dp)
      call draw(state, radii, scene%contact%radius)
      call draw(state, lengths, scene%contact%length)
      call draw(state, masses, scene%excitation%mass)
      call draw(state, loads, scene%excitation%steady_force)
      call draw(state, viscosities, scene%lubricant%viscosity)
      call draw(state, coefficients, scene%lubricant%pressure_viscosity)
      call draw(state, speeds, scene%kinematics%entrainment_speed)
      call draw(state, frequencies, scene%excitation%frequency)
      call draw(state, ratios, ratio)
      scene%excitation%force_amplitude = ratio*scene%excitation%static_load()
      if (scene%film%law == law_piezo_viscous .and. scene%film%model == model_reynolds) then
         ! With an oil of today few of these films would stand the first impact.
         call draw(state, [1.0e-3_dp, 1.0_dp], ratio)
         scene%lubricant%pressure_viscosity = ratio*scene%lubricant%pressure_viscosity
      end if
      call next_uniform(state, number)
      call draw(state, [0.2_dp, 100.0_dp], ratio)
      scene%film%initial_film = 0.0_dp
      scene%film%initial_velocity = 0.0_dp
      if (number < 0.8_dp) return
      ! Without a steady film there is none to start off from, and the scene says so.
      scene%film%initial_film = max(0.0_dp, ratio*steady_film(new_film(scene), scene%excitation%static_load()))
   end subroutine draw_gear

   !> Share the amplitude of every other force out among orders: from the first on, or any, their amplitudes even or falling with
   !> the order.
   pure subroutine draw_orders(start, scene)
      !> Where the numbers come from
      type(random_state_t), intent(in) :: start
      type(scene_t), intent(inout) :: scene
      type(random_state_t) :: state
      real(dp) :: number, falls, weights(most_orders), phases(most_orders)
      logical :: is_there(most_orders)
      integer :: orders, i, n

      state = start
      call next_uniform(state, number)
      if (number < 0.5_dp .or. .not. scene%excitation%force_amplitude > 0.0_dp) return
      call draw(state, [2.0_dp, real(most_orders + 1, dp)], number)
      orders = min(int(number), most_orders)
      call next_uniform(state, number)
      is_there = [(i <= orders, i=1, most_orders)]
      if (number < 0.5_dp) then
         is_there = .false.
         do while (count(is_there) < orders)
            call next_uniform(state, number)
            is_there(1 + int(real(most_orders, dp)*number)) = .true.
         end do
      end if
      call next_uniform(state, falls)
      do n = 1, most_orders
         call next_uniform(state, number)
         weights(n) = merge((0.01_dp + number)/real(n, dp)**(2.0_dp*falls), 0.0_dp, is_there(n))
         call next_uniform(state, number)
         phases(n) = 6.28_dp*number
      end do
      associate (excitation => scene%excitation)
         excitation%force_orders = pack([(n, n=1, most_orders)], is_there)
         excitation%force_amplitudes = pack(weights, is_there)*(excitation%force_amplitude/sum(weights))
         excitation%force_phases = pack(phases, is_there)
         call note_orders(excitation%force_orders, excitation%force_amplitudes, scene%spectrum)
      end associate
   end subroutine draw_orders

   !> A coast flank in every other scene, half of these with the steady force turned, and elastic teeth in every other scene.
   pure subroutine draw_flanks(start, scene, turned)
      !> Where the numbers come from
      type(random_state_t), intent(in) :: start
      type(scene_t), intent(inout) :: scene
      !> Whether the steady force is
      logical, intent(out), optional :: turned
      type(random_state_t) :: state
      real(dp) :: number(3), backlash, stiffness
      integer :: i

      state = start
      do i = 1, size(number)
         call next_uniform(state, number(i))
      end do
      call draw(state, backlashes, backlash)
      call draw(state, stiffnesses, stiffness)
      if (present(turned)) turned = number(1) < 0.5_dp .and. number(2) < 0.5_dp
      if (number(1) < 0.5_dp) then
         scene%contact%backlash = backlash
         if (number(2) < 0.5_dp) scene%excitation%steady_force = -scene%excitation%steady_force
         ! A film to start from lies between the flanks.
         if (.not. scene%film%initial_film < backlash) scene%film%initial_film = 0.0_dp
      end if
      if (number(3) < 0.5_dp) then
         scene%contact%stiffness = stiffness
         scene%solver%method = method_taylor
      end if
   end subroutine draw_flanks

   !> Solver and window.
   pure subroutine draw_solver(state, scene)
      type(random_state_t), intent(inout) :: state
      type(scene_t), intent(inout) :: scene
      real(dp) :: number(9)
      integer :: i

      do i = 1, size(number)
         call next_uniform(state, number(i))
      end do
      associate (solver => scene%solver)
         solver%method = merge(method_newmark, method_taylor, number(1) < 1.0_dp/8.0_dp)
         solver%iteration = merge(iteration_newton, iteration_successive, number(7) < 0.75_dp)
         solver%predictor = merge(predictor_extrapolated, predictor_previous, number(8) < 0.5_dp)
         solver%until = merge(until_steady, until_periods, number(2) < 0.5_dp .and. solver%method == method_taylor)
         solver%accuracy = accuracies(1 + int(8.0_dp*number(3)))
         solver%kept_per_period = samples(1 + int(8.0_dp*number(4)))
         solver%steps_per_period = 512
         solver%tolerance = merge(1.0e-14_dp, 1.0e-7_dp*10.0_dp**(-4.0_dp*number(9)), number(9) < 0.5_dp)
         solver%iteration_limit = 100
         scene%spectrum%periods = windows(1 + int(4.0_dp*number(5)))
         solver%periods = scene%spectrum%periods + 8 + int(32.0_dp*number(6))
         if (solver%until == until_steady) solver%periods = 200
      end associate
      scene%output%series = .false.
   end subroutine draw_solver

end module judged_scenes
