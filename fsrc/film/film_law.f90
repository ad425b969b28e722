!> A film ready for the motion: the law of a scene with its coefficients worked out once.
!>
!> To add a film law: write its kernel in a file of its own, give it a word in the key table and a code in
!> scene_types, add its coefficients to `film_t` and `new_film`, its wrapper to this file, and its line to
!> `film_load` below and to the choice in integrate_motion.
module film_law
   use kinds, only: dp
   use published_iso_viscous, only: half_pi_rupture_load, rolling_coefficient, solved_rupture_load, squeeze_coefficient
   use published_piezo_viscous, only: piezo_coefficient, piezo_viscous_load, squeeze_exponent_rate
   use regime, only: equivalent_radius, plane_strain_modulus
   use rupture, only: rupture_tangent_fast, rupture_tangent_successive, squeeze_group
   use scene_types, only: law_iso_viscous, rupture_half_pi, rupture_solver_fast, scene_t
   implicit none (type, external)
   private

   !> A load above this is no load: the exponential of the piezo-viscous law has overflown [N].
   real(dp), parameter, public :: overflow_load = 1.0e100_dp

   !> Kernel that the motion calls, chosen once per scene.
   integer, parameter, public :: kernel_half_pi = 1, kernel_solved_fast = 2, kernel_solved_successive = 3, kernel_piezo = 4

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
      !> The u of the formulas: the entrainment speed for the published model [m/s]
      real(dp) :: speed = 0.0_dp
      !> (23): coefficient of 1/h [N m]
      real(dp) :: rolling = 0.0_dp
      !> (24): coefficient of the squeeze term [N s m^(1/2)]
      real(dp) :: squeeze = 0.0_dp
      !> (37): coefficient of h^(-7/2) [N m^(7/2)]
      real(dp) :: piezo = 0.0_dp
      !> (37): 703/u [s/m]
      real(dp) :: rate = 0.0_dp
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

   public :: new_film, film_load, steady_film, film_kernel
   public :: load_half_pi, load_solved_fast, load_solved_successive, load_piezo

contains

   !> Coefficients of the film of a scene.
   pure function new_film(scene) result(film)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      type(film_t) :: film

      associate (contact => scene%contact, lubricant => scene%lubricant)
         film%radius = contact%radius
         if (.not. contact%radius > 0.0_dp) film%radius = equivalent_radius(contact%radius_1, contact%radius_2)
         film%modulus = plane_strain_modulus(contact%young_modulus, contact%poisson_ratio)
         film%viscosity = lubricant%viscosity
         film%pressure_viscosity = lubricant%pressure_viscosity
         film%speed = scene%kinematics%entrainment_speed
         if (scene%film%law == law_iso_viscous) then
            film%rolling = rolling_coefficient(contact%length, film%speed, film%viscosity, film%radius)
            film%squeeze = squeeze_coefficient(contact%length, film%viscosity, film%radius)
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
      case default
         call load_piezo(film, thickness, velocity, load, load_by_film, load_by_velocity)
      end select
   end subroutine film_load

   !> Film that carries a static load: (23) or (37) with w = 0, solved for h [m].
   pure real(dp) function steady_film(film, load)
      !> The film
      type(film_t), intent(in) :: film
      !> Static load > 0 [N]
      real(dp), intent(in) :: load

      if (film%kernel == kernel_piezo) then
         steady_film = (film%piezo/load)**(2.0_dp/7.0_dp)
      else
         steady_film = film%rolling/load
      end if
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

   !> (24), rupture from (18) by Newton's method; interface film_kernel.
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

      call piezo_viscous_load(film%piezo, film%rate, thickness, velocity, load, load_by_film, load_by_velocity)
   end subroutine load_piezo

end module film_law
