!> Finite-volume solution of the Reynolds equation for the parabolic film, a referee for the closed forms.
!>
!> With x = sqrt(2 R h0) tan(xbar), t = tan(xbar), h = h0 (1 + t^2), the equation
!> d/dx(h^3/eta dq/dx) = 6 u dh/dx + 12 w becomes
!>
!>     d/dxbar( sec^4(xbar) dq*/dxbar eta0/eta ) = dG/dxbar ,    G(t) = r t^2 + s t ,    q = P q* ,
!>     P = 6 sqrt(2 R) v eta0/h0^(3/2) ,   r = u/v ,   s = 4 (w/v)/sqrt(2 h0/R) ,   B = alpha P ,
!>
!> where u = u1 + u2, w = dh0/dt and v > 0 is any speed. With v = u this is r = 1, s = A, the paper's scaling;
!> v = |u| or a multiple of |w| lets u be negative or zero. The film ruptures by complementarity
!> (Swift-Stieber): q* >= 0 and left side <= right side, one of them an equality. No closed form of pressure,
!> load or rupture is used. The viscosity enters the flux as it stands;
!> the reduced pressure of eq (31) is not used.
module numerical_reynolds
   use constants, only: half_pi, pi
   use kinds, only: dp
   implicit none (type, external)
   private

   public :: film_problem_t, film_solution_t, scale_film, solve_reynolds, log_viscosity_ratio

   !> Viscosity laws: constant; Barus exp(alpha q); Roelands.
   integer, parameter, public :: law_constant = 0, law_barus = 1, law_roelands = 2

   !> Outcomes: converged; no rigid film, B is beyond the critical group; iteration limit, seen only just
   !> beyond the grid's critical group, where Newton's method may circle; film narrower than a dozen cells;
   !> input outside its range.
   integer, parameter, public :: reynolds_converged = 0, reynolds_no_rigid_film = 1, &
      reynolds_not_converged = 2, reynolds_unresolved = 3, reynolds_bad_input = 4

   !> ln(eta/eta0) at which a growing iterate counts as running away. Barus does
   !> at 1 - B/B_crit = e^-40.
   real(dp), parameter :: runaway_log_viscosity = 40.0_dp
   integer, parameter :: iteration_limit = 200
   integer, parameter :: minimum_cells = 16
   integer, parameter :: minimum_film_nodes = 12
   integer, parameter :: outlet_cells = 3

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

   !> What the grid found. Nodes are numbered from 0 at xbar = -pi/2 to `cells` at pi/2.
   type :: film_solution_t
      !> Outcome, one of reynolds_...; the other results hold only where it is reynolds_converged
      integer :: status = reynolds_bad_input
      !> Newton steps on the finest grid
      integer :: iterations = 0
      !> W h0/(12 l v eta0 R) [-]; Psi where v = u
      real(dp) :: load = 0.0_dp
      !> Difference between the extrapolated load and the grid's own [-]; zero without extrapolation
      real(dp) :: load_correction = 0.0_dp
      !> Largest q* [-]
      real(dp) :: maximum_pressure = 0.0_dp
      !> xbar of the rupture [rad]; good to a cell only where it lies in the three cells before the outlet
      real(dp) :: rupture_angle = half_pi
      !> xbar of the nodes [rad]
      real(dp), allocatable :: angle(:)
      !> q* at the nodes [-]
      real(dp), allocatable :: pressure(:)
   end type film_solution_t

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

   interface
      !> LAPACK: solves a general tridiagonal system by elimination with partial pivoting.
      pure subroutine dgtsv(n, nrhs, dl, d, du, b, ldb, info)
         import :: dp
         implicit none (type, external)
         integer, intent(in) :: n, nrhs, ldb
         real(dp), intent(inout) :: dl(*), d(*), du(*), b(ldb, *)
         integer, intent(out) :: info
      end subroutine dgtsv
   end interface

contains

   !> Groups and scales of a film given in SI units. The speed scale is v = max(|u|, 4 |w|/sqrt(2 h0/R)), so
   !> neither group exceeds one and u may have either sign or vanish. Without motion all of them are zero.
   pure subroutine scale_film( &
      radius, film, speed_sum, squeeze_velocity, viscosity, pressure_viscosity, problem, pressure_scale, &
      load_scale)
      real(dp), intent(in) :: radius              !> Equivalent radius R [m], eq (2)
      real(dp), intent(in) :: film                !> Thinnest film h0 [m]
      real(dp), intent(in) :: speed_sum           !> u = u1 + u2 [m/s]
      real(dp), intent(in) :: squeeze_velocity    !> w = dh0/dt [m/s], negative on approach
      real(dp), intent(in) :: viscosity           !> eta0 [Pa s]
      real(dp), intent(in) :: pressure_viscosity  !> alpha [1/Pa]
      type(film_problem_t), intent(out) :: problem  !> Groups and constants of both laws; set to Barus
      real(dp), intent(out) :: pressure_scale     !> P [Pa]: q = P q*
      real(dp), intent(out) :: load_scale         !> 12 v eta0 R/h0 [N/m]: W/l = this times the load group

      real(dp), parameter :: roelands_reference = 1.96e8_dp, roelands_constant = 9.67_dp
      real(dp) :: squeeze_speed, scale_speed

      squeeze_speed = 4.0_dp*squeeze_velocity/sqrt(2.0_dp*film/radius)
      scale_speed = max(abs(speed_sum), abs(squeeze_speed))
      pressure_scale = 6.0_dp*sqrt(2.0_dp*radius)*scale_speed*viscosity/(film*sqrt(film))
      load_scale = 12.0_dp*scale_speed*viscosity*radius/film
      problem%rolling = 0.0_dp
      problem%squeeze = 0.0_dp
      if (scale_speed > 0.0_dp) then
         problem%rolling = speed_sum/scale_speed
         problem%squeeze = squeeze_speed/scale_speed
      end if
      problem%pressure_group = pressure_viscosity*pressure_scale
      problem%law = law_barus
      problem%roelands_pressure = pressure_viscosity*roelands_reference
      problem%roelands_logarithm = log(viscosity) + roelands_constant
   end subroutine scale_film

   !> ln(eta/eta0) of the chosen law, and its slope, at a pressure given as y = alpha q. Roelands (1966) reads
   !> c ((1 + y/g)^Z - 1) with c = ln eta0 + 9.67, g = alpha p_r, Z = g/c. Slope one at y = 0; Barus for
   !> Z = 1.
   elemental subroutine log_viscosity_ratio(problem, pressure, logarithm, slope)
      type(film_problem_t), intent(in) :: problem  !> Law and constants
      real(dp), intent(in) :: pressure             !> y = alpha q >= 0 [-]
      real(dp), intent(out) :: logarithm           !> ln(eta/eta0) [-]
      real(dp), intent(out) :: slope               !> its derivative with respect to y [-]

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

   !> Solves one film on a uniform grid in xbar, second order in the step. With `extrapolate` the grid of half
   !> the cells is solved too, and load, maximum pressure and rupture angle are Richardson-extrapolated;
   !> the profile stays the fine grid's. Close to the critical group the step must be small against
   !> sqrt(1 - B/B_crit), because the grid's own critical group is off by the square of the step.
   pure subroutine solve_reynolds(problem, cells, extrapolate, solution)
      type(film_problem_t), intent(in) :: problem    !> Groups and viscosity law
      integer, intent(in) :: cells                   !> Cells [-]: even, at least 16, 32 to extrapolate
      logical, intent(in) :: extrapolate             !> Richardson's extrapolation from the half grid
      type(film_solution_t), intent(out) :: solution !> Profile and integral results

      type(film_problem_t) :: turned
      type(film_solution_t) :: coarse
      integer :: i

      if (.not. problem_is_valid(problem) .or. modulo(cells, 2) /= 0 &
         .or. cells < merge(2, 1, extrapolate)*minimum_cells) return

      ! Rolling backwards is rolling forwards seen in a mirror.
      turned = problem
      turned%rolling = abs(problem%rolling)
      call solve_grid(turned, cells, solution)
      if (extrapolate .and. solution%status == reynolds_converged) then
         call solve_grid(turned, cells/2, coarse)
         solution%status = coarse%status
         solution%load_correction = abs(solution%load - coarse%load)/3.0_dp
         solution%load = (4.0_dp*solution%load - coarse%load)/3.0_dp
         solution%maximum_pressure = (4.0_dp*solution%maximum_pressure - coarse%maximum_pressure)/3.0_dp
         solution%rupture_angle = (4.0_dp*solution%rupture_angle - coarse%rupture_angle)/3.0_dp
      end if
      allocate (solution%angle(0:cells))
      do i = 0, cells
         solution%angle(i) = real(2*i - cells, dp)/real(cells, dp)*half_pi
      end do
      if (problem%rolling < 0.0_dp) then
         solution%rupture_angle = -solution%rupture_angle
         solution%pressure = solution%pressure(cells:0:-1)
      end if
   end subroutine solve_reynolds

   !> Groups finite and far from overflow, the viscosity law known, its constants positive and Z <= 2.
   pure function problem_is_valid(problem) result(valid)
      use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
      type(film_problem_t), intent(in) :: problem  !> Groups and viscosity law
      logical :: valid

      real(dp), parameter :: largest_group = 1.0e100_dp

      valid = all(ieee_is_finite([problem%rolling, problem%squeeze, problem%pressure_group, &
         problem%roelands_pressure, problem%roelands_logarithm]))
      if (.not. valid) return
      valid = max(abs(problem%rolling), abs(problem%squeeze), problem%pressure_group) <= largest_group &
         .and. problem%pressure_group >= 0.0_dp &
         .and. any(problem%law == [law_constant, law_barus, law_roelands])
      if (problem%law == law_roelands) then
         valid = valid .and. min(problem%roelands_pressure, problem%roelands_logarithm) > 0.0_dp &
            .and. problem%roelands_pressure <= 2.0_dp*problem%roelands_logarithm
      end if
   end function problem_is_valid

   !> One grid: complementarity first, then the rupture inside its cell, then load and maximum.
   pure subroutine solve_grid(problem, cells, solution)
      type(film_problem_t), intent(in) :: problem    !> Groups and viscosity law, r >= 0
      integer, intent(in) :: cells                   !> Cells of the grid [-]
      type(film_solution_t), intent(out) :: solution !> Results

      type(grid_t) :: grid
      real(dp) :: rupture, left, right
      integer :: last, i, top

      grid = film_grid(problem, cells)
      allocate (solution%pressure(0:cells))
      call start_pressure(problem, cells, solution%pressure)
      call solve_complementarity(problem, grid, solution%pressure, last, solution%iterations, solution%status)
      if (last < minimum_film_nodes) then
         ! Without rolling a gap that opens, or rests, holds no film; with rolling there always is one.
         if (problem%rolling > 0.0_dp) solution%status = reynolds_unresolved
         solution%rupture_angle = -half_pi
         return
      end if
      if (solution%status /= reynolds_converged) return
      ! Within the last cells the stretched coordinate runs to infinity: there the rupture stays at its node.
      rupture = grid%step*real(last + 1, dp)
      if (last < cells - outlet_cells) then
         call locate_rupture( &
            problem, grid, solution%pressure, last, rupture, solution%iterations, solution%status)
         if (solution%status /= reynolds_converged) return
      end if

      ! Load = integral of q dx: every node carries its control volume. The last one ends in the middle of the
      ! partial cell, because q falls to zero over the whole of it.
      associate (q => solution%pressure)
         do i = 1, last
            left = grid%step*(real(i, dp) - 0.5_dp)
            right = left + grid%step
            if (i == last) right = 0.5_dp*(left + 0.5_dp*grid%step + rupture)
            solution%load = solution%load + q(i)*width(left, right)
         end do
         top = maxloc(q, dim=1) - 1
         solution%maximum_pressure = vertex(q(top - 1), q(top), q(top + 1))
      end associate
      solution%rupture_angle = rupture - half_pi
   end subroutine solve_grid

   !> Coefficients of the discrete Reynolds equation.
   pure function film_grid(problem, cells) result(grid)
      type(film_problem_t), intent(in) :: problem  !> Groups r and s
      integer, intent(in) :: cells                 !> Cells [-]
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
      real(dp), intent(in) :: left   !> d = xbar + pi/2 [rad]
      real(dp), intent(in) :: right  !> d [rad], larger
      real(dp) :: length

      length = sin(right - left)/(sin(left)*sin(right))
   end function width

   !> G(right) - G(left): what the moving surfaces withdraw from the oil between two film angles.
   elemental function opening(problem, left, right) result(difference)
      type(film_problem_t), intent(in) :: problem  !> Groups r and s
      real(dp), intent(in) :: left                 !> d [rad]
      real(dp), intent(in) :: right                !> d [rad], larger
      real(dp) :: difference

      difference = width(left, right) &
         *(problem%squeeze - problem%rolling*(cos(left)/sin(left) + cos(right)/sin(right)))
   end function opening

   !> Top of the parabola through three equidistant values, the middle one the largest.
   elemental function vertex(left, middle, right) result(top)
      real(dp), intent(in) :: left    !> Value before the largest
      real(dp), intent(in) :: middle  !> Largest value
      real(dp), intent(in) :: right   !> Value after the largest
      real(dp) :: top

      real(dp) :: curvature

      curvature = 2.0_dp*middle - left - right
      top = middle
      if (curvature > 0.0_dp) top = middle + (right - left)**2/(8.0_dp*curvature)
   end function vertex

   !> Flux over one face and its derivatives with respect to the two nodal pressures.
   elemental subroutine face_flux(problem, mobility, left, right, flux, dflux_dleft, dflux_dright)
      type(film_problem_t), intent(in) :: problem  !> Viscosity law and B
      real(dp), intent(in) :: mobility             !> sec^4/step of the face
      real(dp), intent(in) :: left                 !> q* before the face
      real(dp), intent(in) :: right                !> q* behind the face
      real(dp), intent(out) :: flux                !> sec^4 dq*/dxbar eta0/eta
      real(dp), intent(out) :: dflux_dleft         !> d flux/d left
      real(dp), intent(out) :: dflux_dright        !> d flux/d right

      real(dp) :: logarithm, slope, conductance, thickening

      call log_viscosity_ratio(problem, 0.5_dp*problem%pressure_group*(left + right), logarithm, slope)
      conductance = mobility*exp(-logarithm)
      thickening = 0.5_dp*problem%pressure_group*slope*(right - left)
      flux = conductance*(right - left)
      dflux_dleft = -conductance*(1.0_dp + thickening)
      dflux_dright = conductance*(1.0_dp - thickening)
   end subroutine face_flux

   !> Starting pressure: the constant-viscosity film of half the cells, itself started from a quarter, and so
   !> on. From zero the rupture would travel one cell a step. The constant-viscosity pressure lies below the
   !> one sought, and from below Newton's method climbs monotonically.
   pure recursive subroutine start_pressure(problem, cells, pressure)
      type(film_problem_t), intent(in) :: problem  !> Groups r and s
      integer, intent(in) :: cells                 !> Cells of the grid to start [-]
      real(dp), intent(out) :: pressure(0:cells)   !> q* at its nodes; zero on a grid that needs no help

      integer, parameter :: coarsest = 64
      type(film_problem_t) :: plain
      type(grid_t) :: grid
      real(dp) :: coarse(0:(cells + 1)/2), position
      integer :: half, last, iterations, status, i, left

      pressure = 0.0_dp
      if (cells <= coarsest) return
      half = (cells + 1)/2
      plain = problem
      plain%law = law_constant
      plain%pressure_group = 0.0_dp
      grid = film_grid(plain, half)
      call start_pressure(plain, half, coarse)
      call solve_complementarity(plain, grid, coarse, last, iterations, status)
      if (status /= reynolds_converged) return
      do i = 1, cells - 1
         position = real(i, dp)*real(half, dp)/real(cells, dp)
         left = min(int(position), half - 1)
         pressure(i) = coarse(left) + (position - real(left, dp))*(coarse(left + 1) - coarse(left))
      end do
   end subroutine start_pressure

   !> Semismooth Newton (primal-dual active set). Film nodes obey the flux balance, cavitated ones have no
   !> pressure; a film node that wants tension cavitates, a cavitated one that gets more oil than is withdrawn
   !> refills.
   pure subroutine solve_complementarity(problem, grid, pressure, last, iterations, status)
      type(film_problem_t), intent(in) :: problem   !> Groups and viscosity law
      type(grid_t), intent(in) :: grid              !> Coefficients
      real(dp), intent(inout) :: pressure(0:)       !> q* at the nodes; a guess on entry
      integer, intent(out) :: last                  !> Last film node before the rupture, 0 without a film
      integer, intent(out) :: iterations            !> Newton steps
      integer, intent(out) :: status                !> Outcome

      real(dp), dimension(0:grid%cells - 1) :: flux, dleft, dright
      real(dp), dimension(grid%cells - 1) :: residual, diagonal, step
      real(dp), dimension(grid%cells - 2) :: lower, upper
      logical :: film(grid%cells - 1), film_before(grid%cells - 1)
      integer :: n, info

      n = grid%cells - 1
      film = .true.
      status = reynolds_not_converged
      do iterations = 1, iteration_limit
         call face_flux(problem, grid%mobility, pressure(0:n), pressure(1:n + 1), flux, dleft, dright)
         residual = grid%row_scale*(flux(1:n) - flux(0:n - 1) - grid%opening)
         film_before = film
         film = pressure(1:n) > 0.0_dp .or. residual > 0.0_dp
         if (iterations == 1 .and. all(pressure <= 0.0_dp)) film = .true.
         lower = merge(-grid%row_scale(2:n)*dleft(1:n - 1), 0.0_dp, film(2:n))
         upper = merge(grid%row_scale(1:n - 1)*dright(1:n - 1), 0.0_dp, film(1:n - 1))
         diagonal = merge(grid%row_scale*(dleft(1:n) - dright(0:n - 1)), 1.0_dp, film)
         step = merge(-residual, -pressure(1:n), film)
         call dgtsv(n, 1, lower, diagonal, upper, step, n, info)
         if (info /= 0) status = reynolds_no_rigid_film
         if (info == 0) call advance(problem, step, pressure(1:n), status)
         if (status == reynolds_no_rigid_film) exit
         if (status == reynolds_converged .and. all(film .eqv. film_before)) exit
         status = reynolds_not_converged
      end do
      iterations = min(iterations, iteration_limit)
      last = findloc(pressure(1:n) > 0.0_dp, .true., dim=1, back=.true.)
   end subroutine solve_complementarity

   !> Adds a Newton step, keeps the pressure from turning negative, and says whether the iteration has settled
   !> or runs away: beyond the critical group the pressure grows without bound.
   pure subroutine advance(problem, step, pressure, status)
      type(film_problem_t), intent(in) :: problem  !> Viscosity law and B
      real(dp), intent(in) :: step(:)              !> Newton step of q*
      real(dp), intent(inout) :: pressure(:)       !> q* of the film nodes
      integer, intent(inout) :: status             !> Converged, running away, or unchanged

      real(dp), parameter :: settled = 1.0e-10_dp
      real(dp) :: logarithm, slope

      pressure = max(pressure + step, 0.0_dp)
      call log_viscosity_ratio(problem, problem%pressure_group*maxval(pressure), logarithm, slope)
      if (.not. logarithm < runaway_log_viscosity) then
         status = reynolds_no_rigid_film
      else if (all(abs(step) <= settled*maxval(pressure) .or. pressure <= 0.0_dp)) then
         status = reynolds_converged
      end if
   end subroutine advance

   !> Places the rupture inside its cell: unknowns are q*(1 .. last) and the rupture angle. The last control
   !> volume ends at the rupture, where no pressure drives oil, and the pressure of the last node falls to
   !> zero over the distance to it. The number of film nodes is corrected when the rupture leaves its cell.
   pure subroutine locate_rupture(problem, grid, pressure, last, rupture, iterations, status)
      type(film_problem_t), intent(in) :: problem   !> Groups and viscosity law
      type(grid_t), intent(in) :: grid              !> Coefficients
      real(dp), intent(inout) :: pressure(0:)       !> q* at the nodes
      integer, intent(inout) :: last                !> Last film node
      real(dp), intent(out) :: rupture              !> Rupture angle d = xbar + pi/2 [rad]
      integer, intent(inout) :: iterations          !> Newton steps so far
      integer, intent(out) :: status                !> Outcome

      !> Share of a cell by which the rupture may stray outside; prevents changing cells to and fro.
      real(dp), parameter :: play = 0.02_dp
      real(dp) :: position

      rupture = grid%step*(real(last, dp) + 0.5_dp)
      do
         call rupture_newton(problem, grid, last, pressure(0:last), rupture, iterations, status)
         if (status /= reynolds_converged) return
         position = rupture/grid%step - real(last, dp)
         if (position >= -play .and. position <= 1.0_dp + play) return
         last = last + merge(1, -1, position > 1.0_dp)
         pressure(last + 1:) = 0.0_dp
         status = reynolds_unresolved
         if (last < minimum_film_nodes .or. last >= grid%cells .or. iterations > iteration_limit) return
      end do
   end subroutine locate_rupture

   !> Newton with a given number of film nodes; the rupture is the last unknown of a tridiagonal system.
   pure subroutine rupture_newton(problem, grid, last, pressure, rupture, iterations, status)
      type(film_problem_t), intent(in) :: problem   !> Groups and viscosity law
      type(grid_t), intent(in) :: grid              !> Coefficients
      integer, intent(in) :: last                   !> Last film node
      real(dp), intent(inout) :: pressure(0:last)   !> q* of the inlet and of the film nodes
      real(dp), intent(inout) :: rupture            !> Rupture angle d [rad]
      integer, intent(inout) :: iterations          !> Newton steps so far
      integer, intent(out) :: status                !> Outcome

      !> Shares of a cell: change of the rupture that ends the iteration, distance kept from its limits.
      real(dp), parameter :: settled_share = 1.0e-7_dp, margin = 0.01_dp
      real(dp), dimension(0:last - 1) :: flux, dleft, dright
      real(dp) :: lower(last), diagonal(last + 1), upper(last), step(last + 1)
      real(dp) :: fall, dfall_dpressure, dfall_drupture, face, move
      integer :: m, first_iteration, info

      m = last
      face = grid%step*(real(last, dp) - 0.5_dp)
      first_iteration = iterations + 1
      status = reynolds_not_converged
      do iterations = first_iteration, first_iteration + iteration_limit
         call face_flux(problem, grid%mobility(1:m), pressure(0:m - 1), pressure(1:m), flux, dleft, dright)
         call outlet_fall( &
            problem, grid%step*real(m, dp), rupture, pressure(m), fall, dfall_dpressure, dfall_drupture)
         associate (scale => grid%row_scale(1:m))
            step(1:m - 1) = scale(1:m - 1)*(grid%opening(1:m - 1) - flux(1:m - 1) + flux(0:m - 2))
            step(m) = scale(m)*(opening(problem, face, rupture) + flux(m - 1))
            step(m + 1) = fall - pressure(m)
            lower(1:m - 1) = -scale(2:m)*dleft(1:m - 1)
            lower(m) = 1.0_dp - dfall_dpressure
            diagonal(1:m - 1) = scale(1:m - 1)*(dleft(1:m - 1) - dright(0:m - 2))
            diagonal(m) = -scale(m)*dright(m - 1)
            diagonal(m + 1) = -dfall_drupture
            upper(1:m - 1) = scale(1:m - 1)*dright(1:m - 1)
            upper(m) = -scale(m)*opening_rate(problem, rupture)
         end associate
         call dgtsv(m + 1, 1, lower, diagonal, upper, step, m + 1, info)
         if (info /= 0) return
         call advance(problem, step(1:m), pressure(1:m), status)
         if (status == reynolds_no_rigid_film) return
         ! Half a cell at most: the start is within a cell of the solution.
         move = sign(min(abs(step(m + 1)), 0.5_dp*grid%step), step(m + 1))
         rupture = min(max(rupture + move, face + margin*grid%step), pi - margin*grid%step)
         if (status == reynolds_converged .and. abs(move) <= settled_share*grid%step) return
         status = reynolds_not_converged
      end do
   end subroutine rupture_newton

   !> dG/dxbar at a film angle.
   elemental function opening_rate(problem, angle) result(rate)
      type(film_problem_t), intent(in) :: problem  !> Groups r and s
      real(dp), intent(in) :: angle                !> d [rad]
      real(dp) :: rate

      rate = (problem%squeeze - 2.0_dp*problem%rolling*cos(angle)/sin(angle))/sin(angle)**2
   end function opening_rate

   !> Pressure that falls to zero between a node and the rupture behind it, by the midpoint rule.
   pure subroutine outlet_fall(problem, node, rupture, pressure, fall, dfall_dpressure, dfall_drupture)
      type(film_problem_t), intent(in) :: problem  !> Groups and viscosity law
      real(dp), intent(in) :: node                 !> Angle d of the node [rad]
      real(dp), intent(in) :: rupture              !> Angle d of the rupture [rad]
      real(dp), intent(in) :: pressure             !> q* of the node, for the viscosity
      real(dp), intent(out) :: fall                !> Fall of q*
      real(dp), intent(out) :: dfall_dpressure     !> d fall/d pressure
      real(dp), intent(out) :: dfall_drupture      !> d fall/d rupture [1/rad]

      real(dp) :: middle, logarithm, slope, length, narrowing, gain

      call log_viscosity_ratio(problem, 0.5_dp*problem%pressure_group*pressure, logarithm, slope)
      length = rupture - node
      middle = node + 0.5_dp*length
      narrowing = sin(middle)**4*exp(logarithm)
      gain = opening(problem, middle, rupture)
      fall = length*narrowing*gain
      dfall_dpressure = 0.5_dp*problem%pressure_group*slope*fall
      dfall_drupture = narrowing*(gain + 2.0_dp*length*gain*cos(middle)/sin(middle) &
         + length*(opening_rate(problem, rupture) - 0.5_dp*opening_rate(problem, middle)))
   end subroutine outlet_fall

end module numerical_reynolds
