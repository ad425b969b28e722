!> The film at which alpha p reaches 1: thinner, and no rigid piezo-viscous film exists (31).
module limiting_film
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use kinds, only: dp
   use reynolds_iso_viscous, only: peak_pressure_group
   use rupture, only: squeeze_group
   implicit none(type, external)
   private

   !> Thinnest film h* that is looked at.
   real(dp), parameter :: thinnest = 1.0e-15_dp

   public :: limiting_film_ratio

contains

   !> h* at which B max p* = 1 for given speed group u* and squeeze-roll ratio w*, by bisection in ln h*;
   !> NaN where the film separates so fast that alpha p stays below 1 at every thickness, and for a group that is NaN.
   elemental real(dp) function limiting_film_ratio(speed_group, squeeze_ratio) result(limit)
      !> u* = u eta0 alpha/R [-]
      real(dp), intent(in) :: speed_group
      !> w* = w/u [-]
      real(dp), intent(in) :: squeeze_ratio
      real(dp) :: thin, thick
      integer :: pass

      thin = log(thinnest)
      ! Of this film A is below 0.3 and B half of what it may be without squeeze, if it is no thinner than the radius.
      thick = log(max(1.0_dp, 100.0_dp*min(abs(squeeze_ratio), 1.0e100_dp)**2, 2.0_dp*speed_group**(2.0_dp/3.0_dp)))
      if (.not. (alpha_p(thin) >= 1.0_dp .and. alpha_p(thick) <= 1.0_dp)) then
         limit = ieee_value(limit, ieee_quiet_nan)
         return
      end if
      do pass = 1, 60
         if (alpha_p(0.5_dp*(thin + thick)) > 1.0_dp) then
            thin = 0.5_dp*(thin + thick)
         else
            thick = 0.5_dp*(thin + thick)
         end if
      end do
      limit = exp(0.5_dp*(thin + thick))

   contains

      !> alpha p of a film [-].
      pure real(dp) function alpha_p(log_film_ratio)
         real(dp), intent(in) :: log_film_ratio
         real(dp) :: film_ratio, peak, peak_by_a

         film_ratio = exp(log_film_ratio)
         call peak_pressure_group(squeeze_group(1.0_dp, 1.0_dp, film_ratio, squeeze_ratio), peak, peak_by_a)
         alpha_p = 6.0_dp*sqrt(2.0_dp)*speed_group*peak/(film_ratio*sqrt(film_ratio))
      end function alpha_p

   end function limiting_film_ratio

end module limiting_film
