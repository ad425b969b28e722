!> Whether the film law of a scene may be believed: the exact pressure of its motion, computed afterwards, and its regime in words;
!> and where a motion leaves what the model can mean: a gap so wide that it is no line contact any more, or so narrow that no oil is
!> in it.
module regime_check
   use elastohydrodynamic_closure, only: is_fitted, largest_alpha_p, largest_load, largest_material
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
      !> Whether it is the pressure of flanks that keep their shape
      logical :: rigid = .true.
      !> The film law of the scene does not fit the regime
      logical :: law_contradicted = .false.
   end type regime_verdict_t

   !> Beyond this share of the radius the parabola h0 + x**2/(2 R), which stands for the round flank, ends [-].
   real(dp), parameter :: widest_share = 0.1_dp
   !> Below this film there is no oil film left: a few molecules [m].
   real(dp), parameter :: thinnest_film = 1.0e-9_dp
   !> Codes: within, too wide, too narrow, both at different times.
   integer, parameter, public :: within_model = 0, gap_too_wide = 1, gap_too_narrow = 2, gap_both = 3

   !> Codes of closure_range.
   integer, parameter, public :: within_closure = 0, outside_closure = 1

   public :: check_regime, steady_alpha_p, regime_sentence, fitting_law, closure_range, closure_range_sentence, model_limit, &
             model_limit_sentence, extrapolated_closure, outside_model

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
      verdict%rigid = .not. film%bends
      if (film%pressure_thickens .and. verdict%rigid) then
         alpha_q = barus_pressure(verdict%alpha_p_maximum)
         verdict%pressure_exists = verdict%alpha_p_maximum < 1.0_dp
         if (verdict%pressure_exists) verdict%pressure_maximum = alpha_q/film%pressure_viscosity
      end if
      verdict%deflection = contact_deflection(film%radius, verdict%pressure_maximum, film%modulus)
      verdict%regime = film_regime(verdict%alpha_p_maximum, verdict%deflection, verdict%film)
      ! Elastohydrodynamic films hold where the flanks hardly bend, too.
      if (film%bends) return
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

      sentence = quantity_word(quantity_film_regime, verdict%regime)//': the '//trim(merge('Reynolds film', 'film         ', &
                 verdict%rigid))//' reaches alpha p = '//short_text(verdict%alpha_p_maximum, 3)
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

   !> The film law that fits a regime, as keys of &film.
   pure function fitting_law(regime) result(words)
      !> Code of module regime
      integer, intent(in) :: regime
      character(:), allocatable :: words

      select case (regime)
      case (film_iso_viscous)
         words = 'iso-viscous with model = reynolds fits'
      case (film_piezo_viscous)
         words = 'piezo-viscous with model = reynolds fits'
      case default
         words = 'elastohydrodynamic fits'
      end select
   end function fitting_law

   !> Whether a closure was fitted to the loads and pressures of a motion.
   elemental integer function closure_range(film, load, pressure)
      !> Elastohydrodynamic
      type(film_t), intent(in) :: film
      !> Largest load [N] and pressure [Pa]
      real(dp), intent(in) :: load
      real(dp), intent(in) :: pressure

      closure_range = merge(within_closure, outside_closure, is_fitted(film%closure, load, pressure))
   end function closure_range

   !> Sentence for the log where it was not.
   pure function closure_range_sentence(film, load, pressure) result(sentence)
      !> Elastohydrodynamic
      type(film_t), intent(in) :: film
      !> Largest load [N] and pressure [Pa]
      real(dp), intent(in) :: load
      real(dp), intent(in) :: pressure
      character(:), allocatable :: sentence

      associate (closure => film%closure)
         sentence = 'the elastohydrodynamic film is extrapolated: its closure is fitted to films up to M = '// &
                    short_text(largest_load, 2)//', L = '//short_text(largest_material, 2)//', alpha p = '// &
                    short_text(largest_alpha_p, 2)//', and this one reaches '//short_text(load/closure%load_unit, 3)//', '// &
                    short_text(closure%material, 3)//', '// &
                    short_text(closure%material*pressure/closure%pressure_unit, 3)//' (closure_range)'
      end associate
   end function closure_range_sentence

   !> The same of the scenes of a campaign.
   pure function extrapolated_closure(which, all_scenes, automatic) result(words)
      !> How many, as '3', of how many, as '5 scenes'
      character(*), intent(in) :: which
      character(*), intent(in) :: all_scenes
      !> Whether films in nodes were tried there
      logical, intent(in) :: automatic
      character(:), allocatable :: words

      words = 'the film is extrapolated beyond what its closure is fitted to in '//which//' of '//all_scenes//' (closure_range); '
      if (automatic) then
         words = words//'films in nodes stopped there'
      else
         words = words//"film.model = 'automatic' solves these in nodes, as 'resolved' does a single scene"
      end if
   end function extrapolated_closure

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
      character(*), parameter :: wide = 'the film grows beyond a tenth of the radius, where the parabolic gap of a line '// &
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

   !> That some motions of a table are beyond the limits.
   pure function outside_model(which) result(words)
      !> How many: '3 scenes'
      character(*), intent(in) :: which
      character(:), allocatable :: words

      words = which//' outside the range of the model: films above a tenth of the radius or below 1 nm (model_limit)'
   end function outside_model

end module regime_check
