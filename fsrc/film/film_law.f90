!> A film ready for the motion: the law of a scene with its coefficients worked out once.
!>
!> To add a film law: write its kernel in a file of its own, give it a word in the key table and a code in
!> scene_types, add its coefficients to `film_t` and `new_film`, its wrapper to this file, and its line to
!> `film_load` below and to the choice in integrate_motion.
module film_law
   use kinds, only: dp
   use piezo_viscous_terms, only: piezo_viscous_terms_load
   use published_iso_viscous, only: half_pi_rupture_load, rolling_coefficient, solved_rupture_load, squeeze_coefficient
   use published_piezo_viscous, only: piezo_coefficient, published_piezo_viscous_load, squeeze_exponent_rate, squeeze_growth
   use regime, only: equivalent_radius, plane_strain_modulus
   use reynolds_iso_viscous, only: rupture_tangent_fast
   use reynolds_load, only: load_scale, pressure_rate, reynolds_iso_viscous_load, reynolds_piezo_viscous_load, squeeze_rate
   use rupture, only: rupture_tangent_successive, squeeze_group
   use scene_status, only: status_no_rigid_film, status_overflow
   use scene_types, only: contact_t, law_iso_viscous, model_reynolds, rupture_half_pi, rupture_solver_fast, scene_t
   use steady_reynolds_film, only: steady_iso_viscous_film, steady_piezo_viscous_film
   implicit none(type, external)
   private

   !> A load above this is no load: the exponential of the piezo-viscous law has overflown [N].
   real(dp), parameter, public :: overflow_load = 1.0e100_dp

   !> Kernel that the motion calls, chosen once per scene.
   integer, parameter, public :: kernel_half_pi = 1, kernel_solved_fast = 2, kernel_solved_successive = 3, kernel_piezo = 4, &
                                 kernel_reynolds_iso = 5, kernel_reynolds_piezo = 6

   !> Film of a scene.
   type, public :: film_t
      !> Which kernel
      integer :: kernel = kernel_half_pi
      !> Equivalent radius R of (2) [m]
      real(dp) :: radius = 0.0_dp
      !> Plane-strain modulus E* of (3) [Pa]
      real(dp) :: modulus = 0.0_dp
      !> Viscosity eta0 [Pa s]
      real(dp) :: viscosity = 0.0_dp
      !> Barus coefficient alpha [1/Pa]
      real(dp) :: pressure_viscosity = 0.0_dp
      !> The u of the formulas: U for the published model, u1 + u2 = 2 U for the exact one [m/s]
      real(dp) :: speed = 0.0_dp
      !> (23): coefficient of 1/h [N m]
      real(dp) :: rolling = 0.0_dp
      !> (24): coefficient of the squeeze term [N s m^(1/2)]
      real(dp) :: squeeze = 0.0_dp
      !> (37): coefficient of h^(-7/2) [N m^(7/2)]
      real(dp) :: piezo = 0.0_dp
      !> (37): 703/u [s/m]
      real(dp) :: rate = 0.0_dp
      !> Exact films: 12 l u eta0 R [N m]
      real(dp) :: scale = 0.0_dp
      !> Films that rupture by (18): A sqrt(h)/w [s m^(-1/2)]
      real(dp) :: squeeze_rate = 0.0_dp
      !> Exact piezo-viscous film: B h^(3/2) [m^(3/2)]
      real(dp) :: pressure_rate = 0.0_dp
      !> What it means if the kernel gives a load above `overflow_load`
      integer :: status_without_load = status_overflow
   end type film_t

   abstract interface
      !> Load and slopes of a film at one state.
      pure subroutine film_kernel(film, thickness, velocity, load, load_by_film, load_by_velocity)
         import :: dp, film_t
         !> The film
         type(film_t), intent(in) :: film
         !> Film thickness h > 0 [m]
         real(dp), intent(in) :: thickness
         !> Film velocity w = dh/dt [m/s]
         real(dp), intent(in) :: velocity
         !> Load W [N]
         real(dp), intent(out) :: load
         !> dW/dh [N/m]
         real(dp), intent(out) :: load_by_film
         !> dW/dw [N s/m]
         real(dp), intent(out) :: load_by_velocity
      end subroutine film_kernel
   end interface

   public :: new_film, contact_radius, film_load, film_loads, steady_film, film_kernel
   public :: load_half_pi, load_solved_fast, load_solved_successive, load_piezo, load_reynolds_iso, load_reynolds_piezo

contains

   !> Coefficients of the film of a scene.
   pure function new_film(scene) result(film)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      type(film_t) :: film

      associate (contact => scene%contact, lubricant => scene%lubricant)
         film%radius = contact_radius(contact)
         film%modulus = plane_strain_modulus(contact%young_modulus, contact%poisson_ratio)
         film%viscosity = lubricant%viscosity
         film%pressure_viscosity = lubricant%pressure_viscosity
         film%speed = scene%kinematics%entrainment_speed
         if (scene%film%model == model_reynolds) then
            film%speed = 2.0_dp*scene%kinematics%entrainment_speed
            film%scale = load_scale(contact%length, film%speed, film%viscosity, film%radius)
            film%squeeze_rate = squeeze_rate(film%speed, film%radius)
            film%kernel = kernel_reynolds_iso
            if (scene%film%law == law_iso_viscous) return
            film%kernel = kernel_reynolds_piezo
            film%pressure_rate = pressure_rate(film%speed, film%viscosity, film%radius, film%pressure_viscosity)
            film%status_without_load = status_no_rigid_film
         else if (scene%film%law == law_iso_viscous) then
            film%rolling = rolling_coefficient(contact%length, film%speed, film%viscosity, film%radius)
            film%squeeze = squeeze_coefficient(contact%length, film%viscosity, film%radius)
            film%squeeze_rate = squeeze_rate(film%speed, film%radius)
            film%kernel = kernel_solved_fast
            if (scene%film%rupture_solver /= rupture_solver_fast) film%kernel = kernel_solved_successive
            if (scene%film%rupture == rupture_half_pi) film%kernel = kernel_half_pi
         else
            film%piezo = piezo_coefficient(contact%length, film%speed, film%viscosity, film%radius, film%pressure_viscosity)
            film%rate = squeeze_exponent_rate(film%speed)
            film%kernel = kernel_piezo
         end if
      end associate
   end function new_film

   !> Equivalent radius of a contact [m]: the one given, else (2) of the two radii given.
   pure real(dp) function contact_radius(contact)
      !> Checked contact
      type(contact_t), intent(in) :: contact

      contact_radius = contact%radius
      if (.not. contact%radius > 0.0_dp) contact_radius = equivalent_radius(contact%radius_1, contact%radius_2)
   end function contact_radius

   !> Load and slopes of any film, for use outside the loops over time.
   pure subroutine film_load(film, thickness, velocity, load, load_by_film, load_by_velocity)
      !> The film
      type(film_t), intent(in) :: film
      !> Film thickness h > 0 [m]
      real(dp), intent(in) :: thickness
      !> Film velocity w = dh/dt [m/s]
      real(dp), intent(in) :: velocity
      !> Load W [N]
      real(dp), intent(out) :: load
      !> dW/dh [N/m]
      real(dp), intent(out) :: load_by_film
      !> dW/dw [N s/m]
      real(dp), intent(out) :: load_by_velocity

      select case (film%kernel)
      case (kernel_half_pi)
         call load_half_pi(film, thickness, velocity, load, load_by_film, load_by_velocity)
      case (kernel_solved_fast)
         call load_solved_fast(film, thickness, velocity, load, load_by_film, load_by_velocity)
      case (kernel_solved_successive)
         call load_solved_successive(film, thickness, velocity, load, load_by_film, load_by_velocity)
      case (kernel_piezo)
         call load_piezo(film, thickness, velocity, load, load_by_film, load_by_velocity)
      case (kernel_reynolds_iso)
         call load_reynolds_iso(film, thickness, velocity, load, load_by_film, load_by_velocity)
      case default
         call load_reynolds_piezo(film, thickness, velocity, load, load_by_film, load_by_velocity)
      end select
   end subroutine film_load

   !> Loads of many states of one film: which law it is, is asked once, and the published ones run in full registers. A state has
   !> the same bits in any place.
   pure subroutine film_loads(film, thicknesses, velocities, loads)
      !> The film
      type(film_t), intent(in) :: film
      !> Film thicknesses h > 0 [m]
      real(dp), intent(in) :: thicknesses(:)
      !> Film velocities w = dh/dt [m/s], as many
      real(dp), intent(in) :: velocities(:)
      !> Loads W [N], as many
      real(dp), intent(out) :: loads(:)
      real(dp) :: load_by_film, load_by_velocity
      integer :: i

      select case (film%kernel)
      case (kernel_half_pi)
         !$omp simd private(load_by_film, load_by_velocity)
         do i = 1, size(loads)
            call half_pi_rupture_load(film%rolling, film%squeeze, thicknesses(i), velocities(i), loads(i), load_by_film, &
                                      load_by_velocity)
         end do
      case (kernel_piezo)
         !$omp simd private(load_by_film, load_by_velocity)
         do i = 1, size(loads)
          call piezo_viscous_terms_load(film%piezo, film%rate, thicknesses(i), squeeze_growth(film%rate, velocities(i)), loads(i), &
                                          load_by_film, load_by_velocity)
         end do
      case default
         do i = 1, size(loads)
            call film_load(film, thicknesses(i), velocities(i), loads(i), load_by_film, load_by_velocity)
         end do
      end select
   end subroutine film_loads

   !> Film that carries a static load without squeeze [m]: (23), (37) or the exact load, solved for h.
   !> 0 where no rigid piezo-viscous film carries it.
   pure real(dp) function steady_film(film, load)
      !> The film
      type(film_t), intent(in) :: film
      !> Static load > 0 [N]
      real(dp), intent(in) :: load

      select case (film%kernel)
      case (kernel_piezo)
         steady_film = (film%piezo/load)**(2.0_dp/7.0_dp)
      case (kernel_reynolds_iso)
         steady_film = steady_iso_viscous_film(film%scale, load)
      case (kernel_reynolds_piezo)
         steady_film = steady_piezo_viscous_film(film%scale, film%pressure_rate, load)
      case default
         steady_film = film%rolling/load
      end select
   end function steady_film

   !> (35), rupture fixed at pi/2; interface film_kernel.
   pure subroutine load_half_pi(film, thickness, velocity, load, load_by_film, load_by_velocity)
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity
      real(dp), intent(out) :: load
      real(dp), intent(out) :: load_by_film
      real(dp), intent(out) :: load_by_velocity

      call half_pi_rupture_load(film%rolling, film%squeeze, thickness, velocity, load, load_by_film, load_by_velocity)
   end subroutine load_half_pi

   !> (24), rupture from the table of (18); interface film_kernel.
   pure subroutine load_solved_fast(film, thickness, velocity, load, load_by_film, load_by_velocity)
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity
      real(dp), intent(out) :: load
      real(dp), intent(out) :: load_by_film
      real(dp), intent(out) :: load_by_velocity
      real(dp) :: a

      a = squeeze_group(film%radius, film%speed, thickness, velocity)
      call solved_rupture_load(film%rolling, film%squeeze, thickness, velocity, a, rupture_tangent_fast(a), &
                               load, load_by_film, load_by_velocity)
   end subroutine load_solved_fast

   !> (24), rupture from (18) by successive substitution; interface film_kernel.
   pure subroutine load_solved_successive(film, thickness, velocity, load, load_by_film, load_by_velocity)
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity
      real(dp), intent(out) :: load
      real(dp), intent(out) :: load_by_film
      real(dp), intent(out) :: load_by_velocity
      real(dp) :: a

      a = squeeze_group(film%radius, film%speed, thickness, velocity)
      call solved_rupture_load(film%rolling, film%squeeze, thickness, velocity, a, rupture_tangent_successive(a), &
                               load, load_by_film, load_by_velocity)
   end subroutine load_solved_successive

   !> (37); interface film_kernel.
   pure subroutine load_piezo(film, thickness, velocity, load, load_by_film, load_by_velocity)
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity
      real(dp), intent(out) :: load
      real(dp), intent(out) :: load_by_film
      real(dp), intent(out) :: load_by_velocity

      call published_piezo_viscous_load(film%piezo, film%rate, thickness, velocity, load, load_by_film, load_by_velocity)
   end subroutine load_piezo

   !> Exact iso-viscous film; interface film_kernel.
   pure subroutine load_reynolds_iso(film, thickness, velocity, load, load_by_film, load_by_velocity)
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity
      real(dp), intent(out) :: load
      real(dp), intent(out) :: load_by_film
      real(dp), intent(out) :: load_by_velocity

      call reynolds_iso_viscous_load(film%scale, film%squeeze_rate, thickness, velocity, load, load_by_film, load_by_velocity)
   end subroutine load_reynolds_iso

   !> Exact piezo-viscous film; interface film_kernel.
   pure subroutine load_reynolds_piezo(film, thickness, velocity, load, load_by_film, load_by_velocity)
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity
      real(dp), intent(out) :: load
      real(dp), intent(out) :: load_by_film
      real(dp), intent(out) :: load_by_velocity

      call reynolds_piezo_viscous_load(film%scale, film%squeeze_rate, film%pressure_rate, thickness, velocity, load, &
                                       load_by_film, load_by_velocity)
   end subroutine load_reynolds_piezo

end module film_law
