!> The regime of a film in words.
module regime_words
   use kinds, only: dp
   use regime, only: deflection_limit, film_elastohydrodynamic, film_iso_viscous, film_piezo_viscous, iso_viscous_limit, &
                     rigid_limit
   use regime_check, only: regime_verdict_t
   use text, only: short_text
   implicit none(type, external)
   private

   public :: regime_name, regime_sentence

contains

   !> Word for the summary.
   pure function regime_name(regime) result(name)
      !> Code of module regime
      integer, intent(in) :: regime
      character(:), allocatable :: name

      select case (regime)
      case (film_iso_viscous)
         name = 'iso-viscous'
      case (film_piezo_viscous)
         name = 'piezo-viscous'
      case (film_elastohydrodynamic)
         name = 'elastohydrodynamic'
      case default
         name = 'unknown'
      end select
   end function regime_name

   !> Sentence for the log: the regime and the reason.
   pure function regime_sentence(verdict) result(sentence)
      !> Verdict of the regime check
      type(regime_verdict_t), intent(in) :: verdict
      character(:), allocatable :: sentence

      sentence = regime_name(verdict%regime)//': the exact film reaches alpha p = '//short_text(verdict%alpha_p_maximum, 3)
      if (verdict%alpha_p_maximum >= rigid_limit) then
         sentence = sentence//'; from 1 on there is no piezo-viscous film of rigid flanks'
      else if (verdict%deflection > deflection_limit*verdict%film) then
         sentence = sentence//'; the flanks give way by '//short_text(100.0_dp*verdict%deflection/verdict%film, 2)// &
                    ' % of the film, limit '//short_text(100.0_dp*deflection_limit, 2)//' %'
      else if (verdict%alpha_p_maximum < iso_viscous_limit) then
         sentence = sentence//'; below '//short_text(iso_viscous_limit, 1)//' pressure hardly thickens the oil'
      else
         sentence = sentence//'; from '//short_text(iso_viscous_limit, 1)//' on pressure thickens the oil'
      end if
   end function regime_sentence

end module regime_words
