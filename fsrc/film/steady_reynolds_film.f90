!> The exact film that carries a static load.
module steady_reynolds_film
   use kinds, only: dp
   use reynolds_iso_viscous, only: iso_viscous_group => iso_viscous_load
   use reynolds_piezo_viscous, only: critical_pressure_group, piezo_viscous_group => piezo_viscous_load
   implicit none(type, external)
   private

   !> Bisection alone needs 60 passes for 53 bits; Newton's steps in between make it about 6.
   integer, parameter :: most_passes = 200

   public :: steady_iso_viscous_film, steady_piezo_viscous_film

contains

   !> h = 12 l u eta0 R Phi(0)/W [m].
   elemental real(dp) function steady_iso_viscous_film(scale, load) result(film)
      !> 12 l u eta0 R [N m]
      real(dp), intent(in) :: scale
      !> Static load > 0 [N]
      real(dp), intent(in) :: load
      real(dp) :: phi, phi_by_a

      call iso_viscous_group(0.0_dp, phi, phi_by_a)
      film = scale*phi/load
   end function steady_iso_viscous_film

   !> h of 12 l u eta0 R/h Psi(0, B(h)) = W [m]; 0 if even the thinnest rigid film carries less: then the
   !> contact is elastohydrodynamic. The load falls with h, so the root is bracketed by the film
   !> at B_crit below and doubled films above.
   elemental real(dp) function steady_piezo_viscous_film(scale, pressure_rate, load) result(film)
      !> 12 l u eta0 R [N m]
      real(dp), intent(in) :: scale
      !> B h^(3/2) [m^(3/2)]
      real(dp), intent(in) :: pressure_rate
      !> Static load > 0 [N]
      real(dp), intent(in) :: load
      real(dp) :: thin, thick, excess, slope
      integer :: pass

      thin = (pressure_rate/critical_pressure_group(0.0_dp))**(2.0_dp/3.0_dp)*(1.0_dp + 1.0e-12_dp)
      film = thin
      call load_excess(film, excess, slope)
      if (excess < 0.0_dp) then
         film = 0.0_dp
         return
      end if
      thick = max(thin, steady_iso_viscous_film(scale, load))
      do pass = 1, most_passes
         thick = 2.0_dp*thick
         call load_excess(thick, excess, slope)
         if (excess <= 0.0_dp) exit
      end do
      film = thick
      do pass = 1, most_passes
         call load_excess(film, excess, slope)
         if (abs(excess) <= 4.0_dp*epsilon(1.0_dp)*load .or. thick - thin <= 2.0_dp*epsilon(1.0_dp)*thick) return
         if (excess > 0.0_dp) then
            thin = film
         else
            thick = film
         end if
         film = film - excess/slope
         if (.not. (film > thin .and. film < thick)) film = 0.5_dp*(thin + thick)
      end do

   contains

      !> Load of a film above the one asked for [N], and its slope in the film [N/m].
      pure subroutine load_excess(trial, difference, difference_by_film)
         real(dp), intent(in) :: trial
         real(dp), intent(out) :: difference
         real(dp), intent(out) :: difference_by_film
         real(dp) :: b, psi, psi_by_a, psi_by_b

         b = pressure_rate/(trial*sqrt(trial))
         call piezo_viscous_group(0.0_dp, b, psi, psi_by_a, psi_by_b)
         difference = scale*psi/trial - load
         difference_by_film = -scale*(psi + 1.5_dp*b*psi_by_b)/(trial*trial)
      end subroutine load_excess

   end function steady_piezo_viscous_film

end module steady_reynolds_film
