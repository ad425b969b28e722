!> Finite-volume solution of the Reynolds equation for the parabolic film, a reference solution for the closed forms.
!>
!> The equation, its groups r, s and B and its scales v and P stand in module numerical_reynolds_grid. No closed
!> form of pressure, load or rupture is used, nor the groups of the other modules: a reference solution that shared a formula
!> would share its fault.
module numerical_reynolds
   use constants, only: half_pi
   use kinds, only: dp
   use numerical_reynolds_grid, only: film_grid, film_problem_t, grid_t, law_barus, law_constant, law_roelands, width
   use numerical_reynolds_rupture, only: locate_rupture, minimum_film_nodes, reynolds_bad_input, reynolds_converged, &
      reynolds_unresolved, solve_complementarity, start_pressure
   implicit none(type, external)
   private

   public :: film_solution_t, scale_film, solve_reynolds

   integer, parameter :: minimum_cells = 16
   integer, parameter :: outlet_cells = 3

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

contains

   !> Groups and scales of a film given in SI units. The speed scale is v = max(|u|, 4 |w|/sqrt(2 h0/R)), so
   !> neither group exceeds one and u may have either sign or vanish. Without motion all of them are zero.
   pure subroutine scale_film( &
      radius, film, speed_sum, squeeze_velocity, viscosity, pressure_viscosity, problem, pressure_scale, &
      load_scale)
      !> Equivalent radius R [m], eq (2)
      real(dp), intent(in) :: radius
      !> Thinnest film h0 [m]
      real(dp), intent(in) :: film
      !> u = u1 + u2 [m/s]
      real(dp), intent(in) :: speed_sum
      !> w = dh0/dt [m/s], negative on approach
      real(dp), intent(in) :: squeeze_velocity
      !> eta0 [Pa s]
      real(dp), intent(in) :: viscosity
      !> alpha [1/Pa]
      real(dp), intent(in) :: pressure_viscosity
      !> Groups and constants of both laws; set to Barus
      type(film_problem_t), intent(out) :: problem
      !> P [Pa]: q = P q*
      real(dp), intent(out) :: pressure_scale
      !> 12 v eta0 R/h0 [N/m]: W/l = this times the load group
      real(dp), intent(out) :: load_scale

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

   !> Solves one film on a uniform grid in xbar, second order in the step. With `extrapolate` the grid of half
   !> the cells is solved too, and load, maximum pressure and rupture angle are Richardson-extrapolated;
   !> the profile stays the fine grid's. Close to the critical group the step must be small against
   !> sqrt(1 - B/B_crit), because the grid's own critical group is off by the square of the step.
   pure subroutine solve_reynolds(problem, cells, extrapolate, solution)
      type(film_problem_t), intent(in) :: problem
      !> Cells [-]: even, at least 16, 32 to extrapolate
      integer, intent(in) :: cells
      !> Richardson's extrapolation from the half grid
      logical, intent(in) :: extrapolate
      !> Profile and integral results
      type(film_solution_t), intent(out) :: solution

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
      type(film_problem_t), intent(in) :: problem
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
      !> Groups and viscosity law, r >= 0
      type(film_problem_t), intent(in) :: problem
      !> Cells of the grid [-]
      integer, intent(in) :: cells
      !> Results
      type(film_solution_t), intent(out) :: solution

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

   !> Top of the parabola through three equidistant values, the middle one the largest.
   elemental function vertex(left, middle, right) result(top)
      !> Value before the largest
      real(dp), intent(in) :: left
      !> Largest value
      real(dp), intent(in) :: middle
      !> Value after the largest
      real(dp), intent(in) :: right
      real(dp) :: top

      real(dp) :: curvature

      curvature = 2.0_dp*middle - left - right
      top = middle
      if (curvature > 0.0_dp) top = middle + (right - left)**2/(8.0_dp*curvature)
   end function vertex

end module numerical_reynolds
