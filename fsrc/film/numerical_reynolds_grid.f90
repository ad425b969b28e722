!> Problem, coefficients and fluxes of the finite-volume Reynolds equation for the parabolic film.
!>
!> With x = sqrt(2 R h0) tan(xbar), t = tan(xbar), h = h0 (1 + t^2), the equation
!> d/dx(h^3/eta dq/dx) = 6 u dh/dx + 12 w becomes
!>
!>     d/dxbar( sec^4(xbar) dq*/dxbar eta0/eta ) = dG/dxbar ,    G(t) = r t^2 + s t ,    q = P q* ,
!>     P = 6 sqrt(2 R) v eta0/h0^(3/2) ,   r = u/v ,   s = 4 (w/v)/sqrt(2 h0/R) ,   B = alpha P ,
!>
!> where u = u1 + u2, w = dh0/dt and v > 0 is any speed. With v = u this is r = 1, s = A, the paper's scaling;
!> v = |u| or a multiple of |w| lets u be negative or zero. The film ruptures by complementarity
!> (Swift-Stieber): q* >= 0 and left side <= right side, one of them an equality. The viscosity enters the flux
!> as it stands; the reduced pressure of eq (31) is not used.
module numerical_reynolds_grid
   use constants, only: pi
   use kinds, only: dp
   implicit none(type, external)
   private

   public :: film_problem_t, grid_t, film_grid, width, opening, opening_rate, face_flux, log_viscosity_ratio

   !> Viscosity laws: constant; Barus exp(alpha q); Roelands.
   integer, parameter, public :: law_constant = 0, law_barus = 1, law_roelands = 2

   !> One film in the groups of the module header.
   type :: film_problem_t
      !> r = u/v [-]
      real(dp) :: rolling = 1.0_dp
      !> s = 4 (w/v)/sqrt(2 h0/R) [-]; A where v = u
      real(dp) :: squeeze = 0.0_dp
      !> B = alpha P [-]
      real(dp) :: pressure_group = 0.0_dp
      !> Viscosity law, one of law_...
      integer :: law = law_constant
      !> alpha p_r [-], p_r = 1.96e8 Pa; read by Roelands only
      real(dp) :: roelands_pressure = 0.0_dp
      !> ln(eta0/(Pa s)) + 9.67 [-]; read by Roelands only
      real(dp) :: roelands_logarithm = 0.0_dp
   end type film_problem_t

   !> A grid for rolling r >= 0. Angles count from the inlet, d = xbar + pi/2, so that nothing cancels there.
   type :: grid_t
      integer :: cells = 0
      !> Step of the angle [rad]
      real(dp) :: step = 0.0_dp
      !> sec^4/step on face i, between the nodes i - 1 and i
      real(dp), allocatable :: mobility(:)
      !> G on the right face of node i less G on the left one
      real(dp), allocatable :: opening(:)
      !> cos^4 of node i, brings all rows to one size
      real(dp), allocatable :: row_scale(:)
   end type grid_t

contains

   !> ln(eta/eta0) of the chosen law, and its slope, at a pressure given as y = alpha q. Roelands (1966) reads
   !> c ((1 + y/g)^Z - 1) with c = ln eta0 + 9.67, g = alpha p_r, Z = g/c. Slope one at y = 0; Barus for
   !> Z = 1.
   elemental subroutine log_viscosity_ratio(problem, pressure, logarithm, slope)
      !> Law and constants
      type(film_problem_t), intent(in) :: problem
      !> y = alpha q >= 0 [-]
      real(dp), intent(in) :: pressure
      !> ln(eta/eta0) [-]
      real(dp), intent(out) :: logarithm
      !> its derivative with respect to y [-]
      real(dp), intent(out) :: slope

      real(dp) :: growth

      select case (problem%law)
      case (law_barus)
         logarithm = pressure
         slope = 1.0_dp
      case (law_roelands)
         associate (c => problem%roelands_logarithm, g => problem%roelands_pressure)
            growth = (1.0_dp + pressure/g)**(g/c)
            logarithm = c*(growth - 1.0_dp)
            slope = growth/(1.0_dp + pressure/g)
         end associate
      case default
         logarithm = 0.0_dp
         slope = 0.0_dp
      end select
   end subroutine log_viscosity_ratio

   !> Coefficients of the discrete Reynolds equation.
   pure function film_grid(problem, cells) result(grid)
      !> Groups r and s
      type(film_problem_t), intent(in) :: problem
      !> Cells [-]
      integer, intent(in) :: cells
      type(grid_t) :: grid

      real(dp) :: left
      integer :: i

      grid%cells = cells
      grid%step = pi/real(cells, dp)
      allocate (grid%mobility(cells), grid%opening(cells - 1), grid%row_scale(cells - 1))
      do i = 1, cells
         left = grid%step*(real(i, dp) - 0.5_dp)
         grid%mobility(i) = 1.0_dp/(grid%step*sin(left)**4)
         if (i == cells) exit
         grid%opening(i) = opening(problem, left, left + grid%step)
         grid%row_scale(i) = sin(grid%step*real(i, dp))**4
      end do
   end function film_grid

   !> tan(right) - tan(left) of two film angles: a length along the film over sqrt(2 R h0).
   elemental function width(left, right) result(length)
      !> d = xbar + pi/2 [rad]
      real(dp), intent(in) :: left
      !> d [rad], larger
      real(dp), intent(in) :: right
      real(dp) :: length

      length = sin(right - left)/(sin(left)*sin(right))
   end function width

   !> G(right) - G(left): what the moving surfaces withdraw from the oil between two film angles.
   elemental function opening(problem, left, right) result(difference)
      !> Groups r and s
      type(film_problem_t), intent(in) :: problem
      !> d [rad]
      real(dp), intent(in) :: left
      !> d [rad], larger
      real(dp), intent(in) :: right
      real(dp) :: difference

      difference = width(left, right) &
         *(problem%squeeze - problem%rolling*(cos(left)/sin(left) + cos(right)/sin(right)))
   end function opening

   !> dG/dxbar at a film angle.
   elemental function opening_rate(problem, angle) result(rate)
      !> Groups r and s
      type(film_problem_t), intent(in) :: problem
      !> d [rad]
      real(dp), intent(in) :: angle
      real(dp) :: rate

      rate = (problem%squeeze - 2.0_dp*problem%rolling*cos(angle)/sin(angle))/sin(angle)**2
   end function opening_rate

   !> Flux over one face and its derivatives with respect to the two nodal pressures.
   elemental subroutine face_flux(problem, mobility, left, right, flux, dflux_dleft, dflux_dright)
      !> Viscosity law and B
      type(film_problem_t), intent(in) :: problem
      !> sec^4/step of the face
      real(dp), intent(in) :: mobility
      !> q* before the face
      real(dp), intent(in) :: left
      !> q* behind the face
      real(dp), intent(in) :: right
      !> sec^4 dq*/dxbar eta0/eta
      real(dp), intent(out) :: flux
      !> d flux/d left
      real(dp), intent(out) :: dflux_dleft
      !> d flux/d right
      real(dp), intent(out) :: dflux_dright

      real(dp) :: logarithm, slope, conductance, thickening

      call log_viscosity_ratio(problem, 0.5_dp*problem%pressure_group*(left + right), logarithm, slope)
      conductance = mobility*exp(-logarithm)
      thickening = 0.5_dp*problem%pressure_group*slope*(right - left)
      flux = conductance*(right - left)
      dflux_dleft = -conductance*(1.0_dp + thickening)
      dflux_dright = conductance*(1.0_dp - thickening)
   end subroutine face_flux

end module numerical_reynolds_grid
