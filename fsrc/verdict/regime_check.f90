!> Whether the film law of a scene may be believed: the exact pressure of its motion, computed afterwards.
module regime_check
   use film_law, only: film_t
   use film_pressure, only: barus_pressure, pressure_group_maximum, pressure_scale
   use kinds, only: dp
   use regime, only: contact_deflection, film_iso_viscous, film_piezo_viscous, film_regime
   use rupture, only: rupture_tangent_fast, squeeze_group
   use scene_types, only: law_iso_viscous
   implicit none (type, external)
   private

   !> What the exact film says of a motion.
   type, public :: regime_verdict_t
      !> Code of module regime
      integer :: regime = film_iso_viscous
      !> Largest alpha p of the exact iso-viscous film [-]
      real(dp) :: alpha_p_maximum = 0.0_dp
      !> Largest pressure [Pa]: p for an iso-viscous law, q of (31) for a piezo-viscous one
      real(dp) :: pressure_maximum = 0.0_dp
      !> Whether that pressure exists: q does not from alpha p = 1 on
      logical :: pressure_exists = .true.
      !> Deflection (4) at that pressure, at p where q does not exist: then a lower bound [m]
      real(dp) :: deflection = 0.0_dp
      !> Film at the place of the largest pressure [m]
      real(dp) :: film = 0.0_dp
      !> The film law of the scene does not fit the regime
      logical :: law_contradicted = .false.
   end type regime_verdict_t

   public :: check_regime, steady_alpha_p

contains

   !> Scan the samples of a window for the largest exact pressure and judge the law by it.
   pure function check_regime(film, law, films, velocities) result(verdict)
      !> Film of the scene
      type(film_t), intent(in) :: film
      !> Its law
      integer, intent(in) :: law
      !> Film thickness of the samples [m]
      real(dp), intent(in) :: films(:)
      !> Film velocity of the samples [m/s]
      real(dp), intent(in) :: velocities(:)
      type(regime_verdict_t) :: verdict
      real(dp) :: pressure, largest, alpha_q
      integer :: i, place

      largest = -1.0_dp
      place = 1
      do i = 1, size(films)
         pressure = exact_pressure(film, films(i), velocities(i))
         if (pressure <= largest) cycle
         largest = pressure
         place = i
      end do
      verdict%film = films(place)
      verdict%alpha_p_maximum = film%pressure_viscosity*largest
      verdict%pressure_maximum = largest
      if (law /= law_iso_viscous) then
         alpha_q = barus_pressure(verdict%alpha_p_maximum)
         verdict%pressure_exists = verdict%alpha_p_maximum < 1.0_dp
         if (verdict%pressure_exists) verdict%pressure_maximum = alpha_q/film%pressure_viscosity
      end if
      verdict%deflection = contact_deflection(film%radius, verdict%pressure_maximum, film%modulus)
      verdict%regime = film_regime(verdict%alpha_p_maximum, verdict%deflection, verdict%film)
      if (law == law_iso_viscous) then
         verdict%law_contradicted = verdict%regime /= film_iso_viscous
      else
         ! The published piezo-viscous film is a fit to films with alpha p well above zero.
         verdict%law_contradicted = verdict%regime /= film_piezo_viscous
      end if
   end function check_regime

   !> Largest alpha p of a film without squeeze [-].
   pure real(dp) function steady_alpha_p(film, thickness)
      !> The film
      type(film_t), intent(in) :: film
      !> Film thickness [m]
      real(dp), intent(in) :: thickness

      steady_alpha_p = film%pressure_viscosity*exact_pressure(film, thickness, 0.0_dp)
   end function steady_alpha_p

   !> Largest exact iso-viscous pressure [Pa] over the contact, with the speed of the scene's own model.
   pure real(dp) function exact_pressure(film, thickness, velocity)
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity
      real(dp) :: a

      a = squeeze_group(film%radius, film%speed, thickness, velocity)
      exact_pressure = pressure_scale(film%radius, film%speed, film%viscosity, thickness)* &
                       pressure_group_maximum(rupture_tangent_fast(a), a)
   end function exact_pressure

end module regime_check
