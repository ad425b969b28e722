!> Whether the film law of a scene may be believed: the exact pressure of its motion, computed afterwards.
module regime_check
   use film_law, only: film_t
   use film_pressure, only: barus_pressure, exact_pressure
   use kinds, only: dp
   use regime, only: contact_deflection, film_iso_viscous, film_piezo_viscous, film_regime
   implicit none(type, external)
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

   !> Judge the film law by the largest exact pressure of a motion.
   pure function check_regime(film, largest, thickness) result(verdict)
      !> Film of the scene
      type(film_t), intent(in) :: film
      !> Largest pressure of the exact iso-viscous film [Pa]
      real(dp), intent(in) :: largest
      !> Film thickness where it acts [m]
      real(dp), intent(in) :: thickness
      type(regime_verdict_t) :: verdict
      real(dp) :: alpha_q

      verdict%film = thickness
      verdict%alpha_p_maximum = film%pressure_viscosity*largest
      verdict%pressure_maximum = largest
      if (film%pressure_thickens) then
         alpha_q = barus_pressure(verdict%alpha_p_maximum)
         verdict%pressure_exists = verdict%alpha_p_maximum < 1.0_dp
         if (verdict%pressure_exists) verdict%pressure_maximum = alpha_q/film%pressure_viscosity
      end if
      verdict%deflection = contact_deflection(film%radius, verdict%pressure_maximum, film%modulus)
      verdict%regime = film_regime(verdict%alpha_p_maximum, verdict%deflection, verdict%film)
      if (film%pressure_thickens) then
         ! The exact film holds for thin oil as well; the published one is a fit to films with alpha p well above zero.
         verdict%law_contradicted = verdict%regime /= film_piezo_viscous .and. &
                                    .not. (film%exact .and. verdict%regime == film_iso_viscous)
      else
         verdict%law_contradicted = verdict%regime /= film_iso_viscous
      end if
   end function check_regime

   !> Largest alpha p of a film without squeeze [-].
   pure real(dp) function steady_alpha_p(film, thickness)
      !> The film
      type(film_t), intent(in) :: film
      !> Film thickness [m]
      real(dp), intent(in) :: thickness

      steady_alpha_p = film%pressure_viscosity*exact_pressure(film%radius, film%speed, film%viscosity, thickness, 0.0_dp)
   end function steady_alpha_p

end module regime_check
