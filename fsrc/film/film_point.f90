!> A single film in the groups of the paper, with its loads, slopes, pressure and regime.
module film_point
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use film_pressure, only: barus_pressure, exact_pressure, limiting_film_ratio, pressure_scale
   use kinds, only: dp
   use numerical_reynolds, only: film_solution_t, scale_film, solve_reynolds
   use numerical_reynolds_grid, only: film_problem_t, law_barus, law_roelands
   use numerical_reynolds_rupture, only: reynolds_converged
   use published_iso_viscous, only: published_stiffness_damping, rolling_coefficient, solved_rupture_load, squeeze_coefficient
   use regime, only: contact_deflection, film_regime
   use reynolds_iso_viscous, only: rupture_tangent_fast
   use reynolds_load, only: load_scale, load_without_film, pressure_rate, reynolds_iso_viscous_load, &
                            reynolds_piezo_viscous_load, squeeze_rate
   use rupture, only: squeeze_group
   implicit none(type, external)
   private

   !> Contact and oil of a film task.
   type, public :: film_contact_t
      !> R [m], l [m], E* [Pa]
      real(dp) :: radius = 0.0_dp, length = 0.0_dp, modulus = 0.0_dp
      !> eta0 [Pa s], alpha [1/Pa]
      real(dp) :: viscosity = 0.0_dp, pressure_viscosity = 0.0_dp
   end type film_contact_t

   !> A point: the three groups of the paper and what they are in this contact.
   type, public :: film_point_t
      !> h*, w*, u* [-]
      real(dp) :: film_ratio = 0.0_dp, squeeze_ratio = 0.0_dp, speed_group = 0.0_dp
      !> h0 [m], w [m/s], u [m/s]
      real(dp) :: film = 0.0_dp, velocity = 0.0_dp, speed = 0.0_dp
      !> A, B [-]
      real(dp) :: squeeze_group = 0.0_dp, pressure_group = 0.0_dp
      !> t_e of (18) [-]
      real(dp) :: rupture_tangent = 0.0_dp
   end type film_point_t

   !> Load [N], stiffness -dW/dh0 [N/m] and damping -dW/dw [N s/m] of one film model; NaN: no such film.
   type, public :: film_response_t
      real(dp) :: load = 0.0_dp, stiffness = 0.0_dp, damping = 0.0_dp
   end type film_response_t

   !> Highest pressure and what it does.
   type, public :: film_peak_t
      !> alpha p of the iso-viscous film [-]
      real(dp) :: alpha_p = 0.0_dp
      !> q of (31) [Pa]; NaN where alpha p >= 1
      real(dp) :: pressure = 0.0_dp
      !> (4) at q, or at p where q does not exist [m]
      real(dp) :: deflection = 0.0_dp
      !> Code of module regime
      integer :: regime = 0
   end type film_peak_t

   public :: new_film_point, speed_group_of, published_response, iso_viscous_response, piezo_viscous_response, film_peak, &
             limit_of_point, solve_numerically

contains

   !> A point in its contact. The groups enter every film as given.
   elemental function new_film_point(contact, film_ratio, squeeze_ratio, speed_group) result(point)
      type(film_contact_t), intent(in) :: contact
      !> h* [-]
      real(dp), intent(in) :: film_ratio
      !> w* [-]
      real(dp), intent(in) :: squeeze_ratio
      !> u* [-]
      real(dp), intent(in) :: speed_group
      type(film_point_t) :: point

      point%film_ratio = film_ratio
      point%squeeze_ratio = squeeze_ratio
      point%speed_group = speed_group
      point%film = film_ratio*contact%radius
      point%speed = speed_group*contact%radius/(contact%viscosity*contact%pressure_viscosity)
      point%velocity = squeeze_ratio*point%speed
      point%squeeze_group = squeeze_group(contact%radius, point%speed, point%film, point%velocity)
      point%pressure_group = contact%pressure_viscosity* &
                             pressure_scale(contact%radius, point%speed, contact%viscosity, point%film)
      point%rupture_tangent = rupture_tangent_fast(point%squeeze_group)
   end function new_film_point

   !> u* = u eta0 alpha/R [-].
   elemental real(dp) function speed_group_of(contact, speed)
      type(film_contact_t), intent(in) :: contact
      !> u [m/s]
      real(dp), intent(in) :: speed

      speed_group_of = speed*contact%viscosity*contact%pressure_viscosity/contact%radius
   end function speed_group_of

   !> Published film: (24) with x_e of (18), (26) to (28).
   elemental function published_response(contact, point) result(response)
      type(film_contact_t), intent(in) :: contact
      type(film_point_t), intent(in) :: point
      type(film_response_t) :: response
      real(dp) :: rolling, squeeze, load_by_film, load_by_velocity

      rolling = rolling_coefficient(contact%length, point%speed, contact%viscosity, contact%radius)
      squeeze = squeeze_coefficient(contact%length, contact%viscosity, contact%radius)
      call solved_rupture_load(rolling, squeeze, point%film, point%velocity, point%squeeze_group, point%rupture_tangent, &
                               response%load, load_by_film, load_by_velocity)
      call published_stiffness_damping(rolling, squeeze, point%film, point%velocity, point%rupture_tangent, &
                                       response%stiffness, response%damping)
   end function published_response

   !> Reynolds iso-viscous film.
   elemental function iso_viscous_response(contact, point) result(response)
      type(film_contact_t), intent(in) :: contact
      type(film_point_t), intent(in) :: point
      type(film_response_t) :: response

      call reynolds_iso_viscous_load(load_scale(contact%length, point%speed, contact%viscosity, contact%radius), &
                                     squeeze_rate(point%speed, contact%radius), point%film, point%velocity, response%load, &
                                     response%stiffness, response%damping)
      response%stiffness = -response%stiffness
      response%damping = -response%damping
   end function iso_viscous_response

   !> Reynolds piezo-viscous film; NaN where no rigid one exists.
   elemental function piezo_viscous_response(contact, point) result(response)
      type(film_contact_t), intent(in) :: contact
      type(film_point_t), intent(in) :: point
      type(film_response_t) :: response

      call reynolds_piezo_viscous_load(load_scale(contact%length, point%speed, contact%viscosity, contact%radius), &
                                       squeeze_rate(point%speed, contact%radius), &
                                       pressure_rate(point%speed, contact%viscosity, contact%radius, &
                                                     contact%pressure_viscosity), point%film, point%velocity, &
                                       response%load, response%stiffness, response%damping)
      if (response%load < load_without_film) then
         response%stiffness = -response%stiffness
         response%damping = -response%damping
      else
         response%load = ieee_value(response%load, ieee_quiet_nan)
         response%stiffness = response%load
         response%damping = response%load
      end if
   end function piezo_viscous_response

   !> Highest pressure, deflection (4) and regime of a point.
   elemental function film_peak(contact, point) result(peak)
      type(film_contact_t), intent(in) :: contact
      type(film_point_t), intent(in) :: point
      type(film_peak_t) :: peak
      real(dp) :: pressure

      peak%alpha_p = alpha_p(contact, point)
      pressure = peak%alpha_p/contact%pressure_viscosity
      peak%pressure = ieee_value(peak%pressure, ieee_quiet_nan)
      if (peak%alpha_p < 1.0_dp) then
         peak%pressure = barus_pressure(peak%alpha_p)/contact%pressure_viscosity
         pressure = peak%pressure
      end if
      peak%deflection = contact_deflection(contact%radius, pressure, contact%modulus)
      peak%regime = film_regime(peak%alpha_p, peak%deflection, point%film)
   end function film_peak

   !> Film at which alpha p reaches 1 for the speed and squeeze ratio of a point [m]; NaN: at none.
   elemental real(dp) function limit_of_point(contact, point)
      type(film_contact_t), intent(in) :: contact
      type(film_point_t), intent(in) :: point

      limit_of_point = limiting_film_ratio(point%speed_group, point%squeeze_ratio)*contact%radius
   end function limit_of_point

   !> Reference solution: load [N], rupture angle [rad] and highest pressure [Pa] of the numerical solution; all NaN where this
   !> finds no film.
   pure subroutine solve_numerically(contact, point, roelands, cells, load, rupture_angle, pressure)
      type(film_contact_t), intent(in) :: contact
      type(film_point_t), intent(in) :: point
      !> Viscosity of Roelands instead of Barus
      logical, intent(in) :: roelands
      !> Cells, even
      integer, intent(in) :: cells
      !> Load W [N]
      real(dp), intent(out) :: load
      !> x_e [rad]
      real(dp), intent(out) :: rupture_angle
      !> Highest pressure [Pa]
      real(dp), intent(out) :: pressure
      type(film_problem_t) :: problem
      type(film_solution_t) :: solution
      real(dp) :: pressure_unit, load_unit

      call scale_film(contact%radius, point%film, point%speed, point%velocity, contact%viscosity, &
                      contact%pressure_viscosity, problem, pressure_unit, load_unit)
      problem%law = merge(law_roelands, law_barus, roelands)
      call solve_reynolds(problem, cells, .true., solution)
      load = ieee_value(load, ieee_quiet_nan)
      rupture_angle = load
      pressure = load
      if (solution%status /= reynolds_converged) return
      load = load_unit*contact%length*solution%load
      rupture_angle = solution%rupture_angle
      pressure = pressure_unit*solution%maximum_pressure
   end subroutine solve_numerically

   !> Highest alpha p of the iso-viscous film [-].
   elemental real(dp) function alpha_p(contact, point)
      type(film_contact_t), intent(in) :: contact
      type(film_point_t), intent(in) :: point

      alpha_p = contact%pressure_viscosity* &
                exact_pressure(contact%radius, point%speed, contact%viscosity, point%film, point%velocity)
   end function alpha_p

end module film_point
