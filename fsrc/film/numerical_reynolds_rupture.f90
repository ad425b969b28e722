!> Free boundary of the finite-volume Reynolds equation: complementarity on nodes, then inside the cell.
module numerical_reynolds_rupture
   use constants, only: pi
   use kinds, only: dp
   use numerical_reynolds_grid, only: face_flux, film_grid, film_problem_t, grid_t, law_constant, &
      log_viscosity_ratio, opening, opening_rate
   implicit none(type, external)
   private

   public :: start_pressure, solve_complementarity, locate_rupture

   !> Fewer film nodes than this do not resolve a film.
   integer, parameter, public :: minimum_film_nodes = 12
   integer, parameter :: iteration_limit = 200

   !> Outcomes: converged; no rigid film, B is beyond the critical group; iteration limit, seen only just
   !> beyond the grid's critical group, where Newton's method may circle; film narrower than a dozen cells;
   !> input outside its range.
   integer, parameter, public :: reynolds_converged = 0, reynolds_no_rigid_film = 1, &
      reynolds_not_converged = 2, reynolds_unresolved = 3, reynolds_bad_input = 4

   !> ln(eta/eta0) at which a growing iterate counts as running away. Barus does
   !> at 1 - B/B_crit = e^-40.
   real(dp), parameter :: runaway_log_viscosity = 40.0_dp

   interface
      !> LAPACK: solves a general tridiagonal system by elimination with partial pivoting.
      pure subroutine dgtsv(n, nrhs, dl, d, du, b, ldb, info)
         import :: dp
         implicit none(type, external)
         integer, intent(in) :: n, nrhs, ldb
         real(dp), intent(inout) :: dl(*), d(*), du(*), b(ldb, *)
         integer, intent(out) :: info
      end subroutine dgtsv
   end interface

contains

   !> Starting pressure: the constant-viscosity film of half the cells, itself started from a quarter, and so
   !> on. From zero the rupture would travel one cell a step. The constant-viscosity pressure lies below the
   !> one sought, and from below Newton's method climbs monotonically.
   pure recursive subroutine start_pressure(problem, cells, pressure)
      !> Groups r and s
      type(film_problem_t), intent(in) :: problem
      !> Cells of the grid to start [-]
      integer, intent(in) :: cells
      !> q* at its nodes; zero on a grid that needs no help
      real(dp), intent(out) :: pressure(0:cells)

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
      type(film_problem_t), intent(in) :: problem
      type(grid_t), intent(in) :: grid
      !> q* at the nodes; a guess on entry
      real(dp), intent(inout) :: pressure(0:)
      !> Last film node before the rupture, 0 without a film
      integer, intent(out) :: last
      !> Newton steps
      integer, intent(out) :: iterations
      integer, intent(out) :: status

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
      !> Viscosity law and B
      type(film_problem_t), intent(in) :: problem
      !> Newton step of q*
      real(dp), intent(in) :: step(:)
      !> q* of the film nodes
      real(dp), intent(inout) :: pressure(:)
      !> Converged, running away, or unchanged
      integer, intent(inout) :: status

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
      type(film_problem_t), intent(in) :: problem
      type(grid_t), intent(in) :: grid
      !> q* at the nodes
      real(dp), intent(inout) :: pressure(0:)
      !> Last film node
      integer, intent(inout) :: last
      !> Rupture angle d = xbar + pi/2 [rad]
      real(dp), intent(out) :: rupture
      !> Newton steps so far
      integer, intent(inout) :: iterations
      integer, intent(out) :: status

      !> Share of a cell by which the rupture may stray outside; prevents changing cells to and fro.
      real(dp), parameter :: margin = 0.02_dp
      real(dp) :: position

      rupture = grid%step*(real(last, dp) + 0.5_dp)
      do
         call rupture_newton(problem, grid, last, pressure(0:last), rupture, iterations, status)
         if (status /= reynolds_converged) return
         position = rupture/grid%step - real(last, dp)
         if (position >= -margin .and. position <= 1.0_dp + margin) return
         last = last + merge(1, -1, position > 1.0_dp)
         pressure(last + 1:) = 0.0_dp
         status = reynolds_unresolved
         if (last < minimum_film_nodes .or. last >= grid%cells .or. iterations > iteration_limit) return
      end do
   end subroutine locate_rupture

   !> Newton with a given number of film nodes; the rupture is the last unknown of a tridiagonal system.
   pure subroutine rupture_newton(problem, grid, last, pressure, rupture, iterations, status)
      type(film_problem_t), intent(in) :: problem
      type(grid_t), intent(in) :: grid
      !> Last film node
      integer, intent(in) :: last
      !> q* of the inlet and of the film nodes
      real(dp), intent(inout) :: pressure(0:last)
      !> Rupture angle d [rad]
      real(dp), intent(inout) :: rupture
      !> Newton steps so far
      integer, intent(inout) :: iterations
      integer, intent(out) :: status

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

   !> Pressure that falls to zero between a node and the rupture behind it, by the midpoint rule.
   pure subroutine outlet_fall(problem, node, rupture, pressure, fall, dfall_dpressure, dfall_drupture)
      type(film_problem_t), intent(in) :: problem
      !> Angle d of the node [rad]
      real(dp), intent(in) :: node
      !> Angle d of the rupture [rad]
      real(dp), intent(in) :: rupture
      !> q* of the node, for the viscosity
      real(dp), intent(in) :: pressure
      !> Fall of q*
      real(dp), intent(out) :: fall
      !> d fall/d pressure
      real(dp), intent(out) :: dfall_dpressure
      !> d fall/d rupture [1/rad]
      real(dp), intent(out) :: dfall_drupture

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

end module numerical_reynolds_rupture
