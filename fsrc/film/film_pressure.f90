!> Pressure of the Reynolds iso-viscous film, the corrected (16), the reduced-pressure relation (31), and the film at which it ends.
module film_pressure
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use iso_viscous_sums, only: film_block
   use kinds, only: dp
   use reynolds_iso_viscous, only: peak_block, peak_pressure_group
   use rupture, only: pressure_integrals, squeeze_group
   implicit none(type, external)
   private

   !> Thinnest film h* that is looked at.
   real(dp), parameter :: thinnest = 1.0e-15_dp

   public :: pressure_group, pressure_scale, exact_pressure, exact_pressures, barus_pressure, limiting_film_ratio

contains

   !> p*(xbar) of (16) between -pi/2 and x_e.
   elemental real(dp) function pressure_group(tangent, rupture_tangent, a) result(p)
      !> t = tan(xbar) [-]
      real(dp), intent(in) :: tangent
      !> t_e = tan(x_e) [-]
      real(dp), intent(in) :: rupture_tangent
      !> Squeeze group A [-]
      real(dp), intent(in) :: a
      real(dp) :: j, k

      call pressure_integrals(tangent, j, k)
      p = j - rupture_tangent*(rupture_tangent + a)*k - a/(4.0_dp*(1.0_dp + tangent*tangent)**2)
   end function pressure_group

   !> p/p* = 6 sqrt(2R) u eta0 h0^(-3/2) [Pa], the corrected scale of (12).
   elemental real(dp) function pressure_scale(radius, speed, viscosity, film) result(scale)
      !> Equivalent radius R [m]
      real(dp), intent(in) :: radius
      !> Speed u of the film's model [m/s]
      real(dp), intent(in) :: speed
      !> Viscosity at ambient pressure eta0 [Pa s]
      real(dp), intent(in) :: viscosity
      !> Film thickness h0 [m]
      real(dp), intent(in) :: film

      scale = 6.0_dp*sqrt(2.0_dp*radius)*speed*viscosity/(film*sqrt(film))
   end function pressure_scale

   !> Largest pressure p of the Reynolds iso-viscous film [Pa], wherever in the contact it acts.
   elemental real(dp) function exact_pressure(radius, speed, viscosity, film, velocity) result(pressure)
      !> Equivalent radius R [m]
      real(dp), intent(in) :: radius
      !> Speed u of the film's model [m/s]
      real(dp), intent(in) :: speed
      !> Viscosity at ambient pressure eta0 [Pa s]
      real(dp), intent(in) :: viscosity
      !> Film thickness h0 [m]
      real(dp), intent(in) :: film
      !> Film velocity w = dh0/dt [m/s]
      real(dp), intent(in) :: velocity
      real(dp) :: peak, peak_by_a

      call peak_pressure_group(squeeze_group(radius, speed, film, velocity), peak, peak_by_a)
      pressure = pressure_scale(radius, speed, viscosity, film)*peak
   end function exact_pressure

   !> Largest pressures of many films, in full registers.
   pure subroutine exact_pressures(radius, speed, viscosity, films, velocities, pressures)
      !> Equivalent radius R [m]
      real(dp), intent(in) :: radius
      !> Speed u of the film's model [m/s]
      real(dp), intent(in) :: speed
      !> Viscosity at ambient pressure eta0 [Pa s]
      real(dp), intent(in) :: viscosity
      !> Film thicknesses h0 [m]
      real(dp), intent(in) :: films(:)
      !> Film velocities w = dh0/dt, as many [m/s]
      real(dp), intent(in) :: velocities(:)
      !> Largest pressures p, as many [Pa]
      real(dp), intent(out) :: pressures(:)
      real(dp) :: a(film_block)
      integer :: first, last

      do first = 1, size(films), film_block
         last = min(first + film_block - 1, size(films))
         a(:last - first + 1) = squeeze_group(radius, speed, films(first:last), velocities(first:last))
         call peak_block(last - first + 1, a, pressures(first:last))
         pressures(first:last) = pressure_scale(radius, speed, viscosity, films(first:last))*pressures(first:last)
      end do
   end subroutine exact_pressures

   !> alpha q of (31) for alpha p < 1; huge where no rigid piezo-viscous film exists.
   elemental real(dp) function barus_pressure(alpha_p) result(alpha_q)
      !> Reduced pressure times Barus coefficient [-]
      real(dp), intent(in) :: alpha_p
      real(dp) :: remainder, rounded

      remainder = 1.0_dp - alpha_p
      rounded = 1.0_dp - remainder
      if (.not. alpha_p < 1.0_dp) then
         alpha_q = huge(1.0_dp)
      else if (abs(rounded) > 0.0_dp) then
         ! log(1 - x) of the rounded x, scaled to the true one: no digit of a small x is lost.
         alpha_q = -log(remainder)*(alpha_p/rounded)
      else
         alpha_q = alpha_p
      end if
   end function barus_pressure

   !> Film at which alpha p reaches 1: thinner, and no rigid piezo-viscous film exists (31). It is the h* at which B max p* = 1 for
   !> given speed group u* and squeeze-roll ratio w*, by bisection in ln h*; NaN where the film separates so fast that alpha p stays
   !> below 1 at every thickness, and for a group that is NaN.
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

end module film_pressure
