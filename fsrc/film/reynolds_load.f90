!> Load and slopes of the Reynolds films in physical units, u = u1 + u2 (the sum, as the Reynolds equation with
!> 6 eta0 u dh/dx asks):
!>
!>    W = 12 l u eta0 R/h Phi(A)     iso-viscous,      A = 4 w/(u sqrt(2 h/R))
!>    W = 12 l u eta0 R/h Psi(A, B)  piezo-viscous,    B = 6 sqrt(2R) alpha u eta0 h^(-3/2)
!>
!> The slopes are total: rupture moves with film and velocity.
module reynolds_load
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use kinds, only: dp
   use reynolds_iso_viscous, only: iso_viscous_group => iso_viscous_load
   use reynolds_piezo_viscous, only: critical_pressure_group, piezo_viscous_group => piezo_viscous_load, &
                                     piezo_viscous_groups => piezo_viscous_load_array
   use reynolds_stiffness, only: iso_viscous_stiffness, piezo_viscous_stiffness
   implicit none(type, external)
   private

   !> Stands for the load where no rigid piezo-viscous film exists; above every load that is one [N].
   real(dp), parameter, public :: load_without_film = 1.0e200_dp

   public :: load_scale, squeeze_rate, pressure_rate, reynolds_iso_viscous_load, reynolds_piezo_viscous_load, &
      reynolds_piezo_viscous_load_array, steady_iso_viscous_film, steady_piezo_viscous_film

   !> Bisection alone needs 60 iterations for 53 bits; Newton's steps in between make it about 6.
   integer, parameter :: most_passes = 200

contains

   !> 12 l u eta0 R [N m].
   elemental real(dp) function load_scale(length, speed, viscosity, radius)
      !> Contact length l [m]
      real(dp), intent(in) :: length
      !> Sum of the surface speeds u [m/s]
      real(dp), intent(in) :: speed
      !> Viscosity eta0 [Pa s]
      real(dp), intent(in) :: viscosity
      !> Equivalent radius R [m]
      real(dp), intent(in) :: radius

      load_scale = 12.0_dp*length*speed*viscosity*radius
   end function load_scale

   !> A sqrt(h)/w = 4 sqrt(R/2)/u [s m^(-1/2)].
   elemental real(dp) function squeeze_rate(speed, radius)
      !> Sum of the surface speeds u [m/s]
      real(dp), intent(in) :: speed
      !> Equivalent radius R [m]
      real(dp), intent(in) :: radius

      squeeze_rate = 4.0_dp*sqrt(0.5_dp*radius)/speed
   end function squeeze_rate

   !> B h^(3/2) = 6 sqrt(2R) alpha u eta0 [m^(3/2)].
   elemental real(dp) function pressure_rate(speed, viscosity, radius, pressure_viscosity)
      !> Sum of the surface speeds u [m/s]
      real(dp), intent(in) :: speed
      !> Viscosity eta0 [Pa s]
      real(dp), intent(in) :: viscosity
      !> Equivalent radius R [m]
      real(dp), intent(in) :: radius
      !> Barus coefficient alpha [1/Pa]
      real(dp), intent(in) :: pressure_viscosity

      pressure_rate = 6.0_dp*sqrt(2.0_dp*radius)*pressure_viscosity*speed*viscosity
   end function pressure_rate

   !> Load of the Reynolds iso-viscous film.
   elemental subroutine reynolds_iso_viscous_load(scale, rate, film, velocity, load, load_by_film, load_by_velocity)
      !> 12 l u eta0 R [N m]
      real(dp), intent(in) :: scale
      !> A sqrt(h)/w [s m^(-1/2)]
      real(dp), intent(in) :: rate
      !> Film thickness h > 0 [m]
      real(dp), intent(in) :: film
      !> Film velocity w = dh/dt [m/s]
      real(dp), intent(in) :: velocity
      !> Load W [N]
      real(dp), intent(out) :: load
      !> dW/dh [N/m]
      real(dp), intent(out) :: load_by_film
      !> dW/dw [N s/m]
      real(dp), intent(out) :: load_by_velocity
      real(dp) :: inverse, a_by_velocity, a, phi, phi_by_a

      inverse = 1.0_dp/film
      a_by_velocity = rate*inverse*sqrt(film)
      a = a_by_velocity*velocity
      call iso_viscous_group(a, phi, phi_by_a)
      load = scale*inverse*phi
      load_by_film = -scale*inverse*inverse*iso_viscous_stiffness(a, phi, phi_by_a)
      load_by_velocity = scale*inverse*phi_by_a*a_by_velocity
   end subroutine reynolds_iso_viscous_load

   !> Load of the Reynolds piezo-viscous film; where no rigid film exists, a load above every real one, without slopes.
   elemental subroutine reynolds_piezo_viscous_load(scale, rate, b_rate, film, velocity, load, load_by_film, load_by_velocity)
      !> 12 l u eta0 R [N m]
      real(dp), intent(in) :: scale
      !> A sqrt(h)/w [s m^(-1/2)]
      real(dp), intent(in) :: rate
      !> B h^(3/2) [m^(3/2)]
      real(dp), intent(in) :: b_rate
      !> Film thickness h > 0 [m]
      real(dp), intent(in) :: film
      !> Film velocity w = dh/dt [m/s]
      real(dp), intent(in) :: velocity
      !> Load W [N]
      real(dp), intent(out) :: load
      !> dW/dh [N/m]
      real(dp), intent(out) :: load_by_film
      !> dW/dw [N s/m]
      real(dp), intent(out) :: load_by_velocity
      real(dp) :: a, b, psi, psi_by_a, psi_by_b

      call groups_of_film(rate, b_rate, film, velocity, a, b)
      call piezo_viscous_group(a, b, psi, psi_by_a, psi_by_b)
      call load_of_groups(scale, rate, film, a, b, psi, psi_by_a, psi_by_b, load, load_by_film, &
                          load_by_velocity)
   end subroutine reynolds_piezo_viscous_load

   !> Loads of many Reynolds piezo-viscous films, each with coefficients of its own: the same as those of
   !> `reynolds_piezo_viscous_load`, at a fraction of the time.
   pure subroutine reynolds_piezo_viscous_load_array(n, scale, rate, b_rate, film, velocity, load, &
      load_by_film, load_by_velocity)
      !> Number of films
      integer, intent(in) :: n
      !> 12 l u eta0 R [N m]
      real(dp), intent(in) :: scale(n)
      !> A sqrt(h)/w [s m^(-1/2)]
      real(dp), intent(in) :: rate(n)
      !> B h^(3/2) [m^(3/2)]
      real(dp), intent(in) :: b_rate(n)
      !> Film thickness h > 0 [m]
      real(dp), intent(in) :: film(n)
      !> Film velocity w = dh/dt [m/s]
      real(dp), intent(in) :: velocity(n)
      !> Load W [N]
      real(dp), intent(out) :: load(n)
      !> dW/dh [N/m]
      real(dp), intent(out) :: load_by_film(n)
      !> dW/dw [N s/m]
      real(dp), intent(out) :: load_by_velocity(n)
      real(dp), dimension(n) :: a, b, psi, psi_by_a, psi_by_b
      integer :: i

      !$omp simd
      do i = 1, n
         call groups_of_film(rate(i), b_rate(i), film(i), velocity(i), a(i), b(i))
      end do
      call piezo_viscous_groups(n, a, b, psi, psi_by_a, psi_by_b)
      !$omp simd
      do i = 1, n
         call load_of_groups(scale(i), rate(i), film(i), a(i), b(i), psi(i), psi_by_a(i), psi_by_b(i), &
                             load(i), load_by_film(i), load_by_velocity(i))
      end do
   end subroutine reynolds_piezo_viscous_load_array

   !> A and B of a film.
   elemental subroutine groups_of_film(rate, b_rate, film, velocity, a, b)
      !> A sqrt(h)/w [s m^(-1/2)]
      real(dp), intent(in) :: rate
      !> B h^(3/2) [m^(3/2)]
      real(dp), intent(in) :: b_rate
      !> Film thickness h > 0 [m]
      real(dp), intent(in) :: film
      !> Film velocity w = dh/dt [m/s]
      real(dp), intent(in) :: velocity
      !> A [-]
      real(dp), intent(out) :: a
      !> B [-]
      real(dp), intent(out) :: b
      real(dp) :: inverse, root_inverse

      inverse = 1.0_dp/film
      root_inverse = inverse*sqrt(film)
      a = rate*root_inverse*velocity
      b = b_rate*inverse*root_inverse
   end subroutine groups_of_film

   !> Load and slopes from Psi and its slopes.
   elemental subroutine load_of_groups(scale, rate, film, a, b, psi, psi_by_a, psi_by_b, load, load_by_film, &
      load_by_velocity)
      !> 12 l u eta0 R [N m]
      real(dp), intent(in) :: scale
      !> A sqrt(h)/w [s m^(-1/2)]
      real(dp), intent(in) :: rate
      !> Film thickness h > 0 [m]
      real(dp), intent(in) :: film
      !> A [-]
      real(dp), intent(in) :: a
      !> B [-]
      real(dp), intent(in) :: b
      !> Psi, NaN where no rigid film exists [-]
      real(dp), intent(in) :: psi
      !> dPsi/dA [-]
      real(dp), intent(in) :: psi_by_a
      !> dPsi/dB [-]
      real(dp), intent(in) :: psi_by_b
      !> Load W [N]
      real(dp), intent(out) :: load
      !> dW/dh [N/m]
      real(dp), intent(out) :: load_by_film
      !> dW/dw [N s/m]
      real(dp), intent(out) :: load_by_velocity
      real(dp) :: inverse

      if (ieee_is_nan(psi)) then
         load = load_without_film
         load_by_film = 0.0_dp
         load_by_velocity = 0.0_dp
      else
         inverse = 1.0_dp/film
         load = scale*inverse*psi
         load_by_film = -scale*inverse*inverse*piezo_viscous_stiffness(a, b, psi, psi_by_a, psi_by_b)
         load_by_velocity = scale*inverse*psi_by_a*rate*(inverse*sqrt(film))
      end if
   end subroutine load_of_groups

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

end module reynolds_load
