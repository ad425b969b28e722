!> Whether the film law of a scene may be believed: the exact pressure of its motion, computed afterwards, and its regime in words;
!> and where a motion leaves what the model can mean: a gap so wide that it is no line contact any more, or so narrow that no oil is
!> in it.
module regime_check
   use film_law, only: film_t
   use film_pressure, only: barus_pressure, exact_pressure
   use kinds, only: dp
   use quantities, only: quantity_film_regime, quantity_word
   use regime, only: contact_deflection, deflection_limit, film_iso_viscous, film_piezo_viscous, &
                     film_regime, iso_viscous_limit, rigid_limit
   use text, only: short_text
   implicit none(type, external)
   private

   !> What the Reynolds film says of a motion.
   type, public :: regime_verdict_t
      !> Code of module regime
      integer :: regime = film_iso_viscous
      !> Largest alpha p of the Reynolds iso-viscous film [-]
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

   !> Beyond this share of the radius the parabola h0 + x**2/(2 R), which stands for the round flank, ends [-].
   real(dp), parameter :: widest_share = 0.1_dp
   !> Below this film there is no oil film left: a few molecules [m].
   real(dp), parameter :: thinnest_film = 1.0e-9_dp
   !> Codes: within, too wide, too narrow, both at different times.
   integer, parameter, public :: within_model = 0, gap_too_wide = 1, gap_too_narrow = 2, gap_both = 3

   public :: check_regime, steady_alpha_p, regime_sentence, model_limit, model_limit_sentence

contains

   !> Judge the film law by the largest exact pressure of a motion.
   pure function check_regime(film, largest, thickness) result(verdict)
      type(film_t), intent(in) :: film
      !> Largest pressure of the Reynolds iso-viscous film [Pa]
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
         ! The Reynolds film holds for thin oil as well; the published one is a fit to films with alpha p well above zero.
         verdict%law_contradicted = verdict%regime /= film_piezo_viscous .and. &
                                    .not. (film%exact .and. verdict%regime == film_iso_viscous)
      else
         verdict%law_contradicted = verdict%regime /= film_iso_viscous
      end if
   end function check_regime

   !> Largest alpha p of a film without squeeze [-].
   pure real(dp) function steady_alpha_p(film, thickness)
      type(film_t), intent(in) :: film
      !> Film thickness [m]
      real(dp), intent(in) :: thickness

      steady_alpha_p = film%pressure_viscosity*exact_pressure(film%radius, film%speed, film%viscosity, thickness, 0.0_dp)
   end function steady_alpha_p

   !> Sentence for the log: the regime and the reason.
   pure function regime_sentence(verdict) result(sentence)
      !> Verdict of the regime check
      type(regime_verdict_t), intent(in) :: verdict
      character(:), allocatable :: sentence

      sentence = quantity_word(quantity_film_regime, verdict%regime)//': the Reynolds film reaches alpha p = '// &
                 short_text(verdict%alpha_p_maximum, 3)
      if (verdict%alpha_p_maximum >= rigid_limit) then
         sentence = sentence//'; from 1 on there is no piezo-viscous film of rigid flanks'
      else if (verdict%deflection > deflection_limit*verdict%film) then
         sentence = sentence//'; the flanks deflect by '//short_text(100.0_dp*verdict%deflection/verdict%film, 2)// &
                    ' % of the film, limit '//short_text(100.0_dp*deflection_limit, 2)//' %'
      else if (verdict%alpha_p_maximum < iso_viscous_limit) then
         sentence = sentence//'; below '//short_text(iso_viscous_limit, 1)//' pressure hardly thickens the oil'
      else
         sentence = sentence//'; from '//short_text(iso_viscous_limit, 1)//' on pressure thickens the oil'
      end if
   end function regime_sentence

   !> Which limits a motion has passed.
   elemental integer function model_limit(film_minimum, film_maximum, radius)
      !> Smallest and largest film [m]
      real(dp), intent(in) :: film_minimum
      real(dp), intent(in) :: film_maximum
      !> Equivalent radius R [m]
      real(dp), intent(in) :: radius

      model_limit = within_model
      if (film_maximum > widest_share*radius) model_limit = gap_too_wide
      if (film_minimum < thinnest_film) model_limit = model_limit + gap_too_narrow
   end function model_limit

   !> What it means, in a sentence; empty within the limits.
   pure function model_limit_sentence(limit) result(sentence)
      !> Code of a limit
      integer, intent(in) :: limit
      character(:), allocatable :: sentence
      character(*), parameter :: wide = 'the film grows beyond a tenth of the radius, where the parabolic gap of a harmonic '// &
                                         'contact ends'
      character(*), parameter :: narrow = 'the film falls below 1 nm, where no oil film is left'

      select case (limit)
      case (gap_too_wide)
         sentence = wide
      case (gap_too_narrow)
         sentence = narrow
      case (gap_both)
         sentence = wide//', and '//narrow
      case default
         sentence = ''
      end select
   end function model_limit_sentence

end module regime_check
