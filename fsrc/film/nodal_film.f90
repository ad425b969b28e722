!> Film between elastic flanks, its pressure in nodes. In Moes' variables (module elastohydrodynamic_closure), with F = eta0/eta,
!>
!>     (H^3 F(P) P_X)_X/6 = H_X + H_T   where P > 0 ,      P >= 0 ,
!>     H = G + M c + X^2/2 - (4/pi) integral of P ln|X - X'| dX' ,      M = integral of P dX .
!>
!> Nodes stand at equal distances in xi, X = S (sigma + tan(xi) (1 + beta tan(xi)^2)), from -pi/2 to pi/2, so that no inlet is cut
!> off. In oil of constant viscosity the film is thinnest and ruptures at the outlet, where sigma > 0 has the nodes closer: a
!> rupture between two nodes is off by the square of their distance. Oil that pressure thickens needs them at its inlet as well.
!> Fluxes and films stand at the edges of cells between the nodes, and each cell balances what flows in, what flows out and what it
!> holds. Between nodes the pressure is a cubic in xi, whose deflection is integrated without any error of its own. Where the film
!> ruptures pressures are 0, and a cell there may lose oil but not gain any.
module nodal_film
   use constants, only: pi
   use elastohydrodynamic_closure, only: closure_t, thicken
   use film_pressure, only: pressure_group
   use kinds, only: dp
   use linear_equations, only: eliminate
   use reynolds_iso_viscous, only: rupture_tangent_fast
   use scene_types, only: viscosity_barus, viscosity_constant
   implicit none(type, external)
   private

   !> beta
   real(dp), parameter :: spread_of_nodes = 1.0_dp
   !> sigma in oil of constant viscosity
   real(dp), parameter, public :: outlet_shift = 0.3_dp

   !> Grid, with all that follows from it and from c.
   type, public :: nodal_grid_t
      integer :: nodes = 0
      !> Nodes, edges (from 0), and dX/dxi times the distance of two nodes in xi at the edges [-]
      real(dp), allocatable :: place(:), edge(:), stretch(:)
      !> Lengths of the cells, and what they hold of X^2/2
      real(dp), allocatable :: length(:), bowl(:)
      !> Integral of P dX over P
      real(dp), allocatable :: load(:)
      !> Film at the edges and what the cells hold, over P: edge or cell, node. c included
      real(dp), allocatable :: film(:, :), volume(:, :)
      !> Film at the nodes over P: node, node
      real(dp), allocatable :: film_at_nodes(:, :)
      !> c [-]
      real(dp) :: compliance = 0.0_dp
      !> X = 0: number of the node before it, and the share of the way to the next one
      real(dp) :: middle = 0.0_dp
   end type nodal_grid_t

   !> Balance of the cells at some pressures.
   type, public :: nodal_balance_t
      !> Residuals, their slopes in P (cell, node) and in G
      real(dp), allocatable :: residual(:), by_pressure(:, :), by_gap(:)
      !> Flow over the edges, from 0, over their share of fourth order
      real(dp), allocatable :: flow_by_fourth(:)
   end type nodal_balance_t

   !> Newton's correction of the pressures of a film whose gap is still to be corrected: dP = own + with_gap dG.
   type, public :: nodal_correction_t
      real(dp), allocatable :: own(:), with_gap(:)
      !> Load after the correction, and its slope in the gap
      real(dp) :: load = 0.0_dp, load_by_gap = 0.0_dp
      !> Whether nodes rupture or fill anew, and whether there is a correction at all
      logical :: changed = .false., exists = .false.
   end type nodal_correction_t

   !> Pressure behind an edge over that before it from which on its flow is of fourth order
   real(dp), parameter :: fallen = 0.25_dp

   !> Gauss's nodes and weights from 0 to 1, both ends of an interval alike.
   integer, parameter :: gauss = 16
   real(dp), parameter :: gauss_half(gauss/2) = [0.0950125098376374_dp, 0.2816035507792589_dp, 0.4580167776572274_dp, &
      0.6178762444026438_dp, 0.7554044083550030_dp, 0.8656312023878318_dp, 0.9445750230732326_dp, 0.9894009349916499_dp]
   real(dp), parameter :: gauss_share(gauss/2) = [0.1894506104550685_dp, 0.1826034150449236_dp, 0.1691565193950025_dp, &
      0.1495959888165767_dp, 0.1246289712555339_dp, 0.0951585116824928_dp, 0.0622535239386479_dp, 0.0271524594117541_dp]
   real(dp), parameter :: gauss_place(gauss) = 0.5_dp + 0.5_dp*[-gauss_half(gauss/2:1:-1), gauss_half]
   real(dp), parameter :: gauss_weight(gauss) = 0.5_dp*[gauss_share(gauss/2:1:-1), gauss_share]

   public :: grid_of, balance_of_cells, shares_of_fourth_order, changes_of_fourth_order, correct_pressures, solve_active, &
             smallest_film, films_along, &
             smallest_of_films, find_largest_pressure, film_at_place, films_at_nodes, central_film, volumes_of, &
             rigid_pressures, hertzian_pressure

contains

   !> Grid of some nodes.
   pure type(nodal_grid_t) function grid_of(nodes, scale, compliance, shift) result(grid)
      integer, intent(in) :: nodes
      !> S > 0 [-]
      real(dp), intent(in) :: scale
      !> c [-]
      real(dp), intent(in) :: compliance
      !> sigma [-]; absent: 0
      real(dp), intent(in), optional :: shift
      real(dp) :: step, bends(nodes), xi, centre
      integer :: i, k

      grid%nodes = nodes
      grid%compliance = compliance
      step = pi/real(nodes + 1, dp)
      centre = 0.0_dp
      if (present(shift)) centre = shift
      allocate (grid%place(nodes), grid%edge(0:nodes), grid%stretch(0:nodes), grid%length(nodes), grid%bowl(nodes))
      allocate (grid%load(nodes), grid%film(0:nodes, nodes), grid%volume(nodes, nodes), grid%film_at_nodes(nodes, nodes))
      do i = 1, nodes
         grid%place(i) = place_of(-0.5_dp*pi + real(i, dp)*step)
      end do
      do i = 0, nodes
         xi = -0.5_dp*pi + (real(i, dp) + 0.5_dp)*step
         grid%edge(i) = place_of(xi)
         grid%stretch(i) = step*stretch_of(xi)
      end do
      ! Newton's method for X = 0, which is exact to rounding after a few passes.
      xi = 0.0_dp
      do i = 1, 20
         xi = xi - place_of(xi)/stretch_of(xi)
      end do
      grid%middle = (xi + 0.5_dp*pi)/step
      grid%length = grid%edge(1:) - grid%edge(:nodes - 1)
      grid%bowl = (grid%edge(1:) - grid%edge(:nodes - 1))*(grid%edge(1:)**2 + grid%edge(1:)*grid%edge(:nodes - 1) &
                                                           + grid%edge(:nodes - 1)**2)/6.0_dp
      grid%load = integrals_of_cubics(huge(1.0_dp))
      do i = 0, nodes
         grid%film(i, :) = compliance*grid%load - 4.0_dp/pi*integrals_of_cubics(-0.5_dp*pi + (real(i, dp) + 0.5_dp)*step)
      end do
      do i = 1, nodes
         bends = compliance*grid%load - 4.0_dp/pi*integrals_of_cubics(-0.5_dp*pi + real(i, dp)*step)
         grid%film_at_nodes(i, :) = bends
         ! Simpson's rule in xi
         do k = 1, nodes
            grid%volume(i, k) = (grid%film(i - 1, k)*grid%stretch(i - 1) + grid%film(i, k)*grid%stretch(i) + &
                                 4.0_dp*bends(k)*step*stretch_of(-0.5_dp*pi + real(i, dp)*step))/6.0_dp
         end do
      end do

   contains

      !> X at xi.
      pure real(dp) function place_of(angle)
         real(dp), intent(in) :: angle
         real(dp) :: t

         t = tan(angle)
         place_of = scale*(centre + t*(1.0_dp + spread_of_nodes*t*t))
      end function place_of

      !> dX/dxi.
      pure real(dp) function stretch_of(angle)
         real(dp), intent(in) :: angle
         real(dp) :: t

         t = tan(angle)
         stretch_of = scale*(1.0_dp + t*t)*(1.0_dp + 3.0_dp*spread_of_nodes*t*t)
      end function stretch_of

      !> Integrals of the cubics of all nodes times ln|X - X'|, or without the logarithm where xi is huge.
      pure function integrals_of_cubics(angle) result(integrals)
         !> xi of X
         real(dp), intent(in) :: angle
         real(dp) :: integrals(nodes), from, middle
         integer :: interval
         logical :: has_logarithm

         has_logarithm = angle < huge(1.0_dp)
         integrals = 0.0_dp
         do interval = 1, nodes - 1
            from = -0.5_dp*pi + real(interval, dp)*step
            middle = 0.0_dp
            if (has_logarithm) middle = (angle - from)/step
            if (has_logarithm .and. middle > -0.25_dp .and. middle < 1.25_dp) then
               if (middle > 0.25_dp) call add_piece(interval, from, middle, 0.0_dp, has_logarithm, angle, integrals)
               if (middle < 0.75_dp) call add_piece(interval, from, middle, 1.0_dp, has_logarithm, angle, integrals)
            else
               call add_piece(interval, from, 0.0_dp, 1.0_dp, has_logarithm, angle, integrals)
            end if
         end do
      end function integrals_of_cubics

      !> Add a piece of an interval, from one place in it to another; with a logarithm that is singular at the first place when that
      !> is no end of the interval that lies apart.
      pure subroutine add_piece(interval, from, first, last, has_logarithm, angle, integrals)
         integer, intent(in) :: interval
         !> xi where the interval begins
         real(dp), intent(in) :: from
         !> Shares of the interval
         real(dp), intent(in) :: first
         real(dp), intent(in) :: last
         logical, intent(in) :: has_logarithm
         real(dp), intent(in) :: angle
         real(dp), intent(inout) :: integrals(nodes)
         real(dp) :: u, share, weight, xi_here, value, cubic(-1:2), near
         logical :: singular
         integer :: q, m

         near = 0.0_dp
         if (has_logarithm) near = (angle - from)/step
         singular = has_logarithm .and. abs(near - first) < 0.1_dp
         do q = 1, gauss
            u = gauss_place(q)
            weight = gauss_weight(q)
            if (singular) then
               ! u^4 takes the singularity away.
               weight = 4.0_dp*u**3*weight
               u = u**4
            end if
            share = first + (last - first)*u
            weight = weight*abs(last - first)
            xi_here = from + share*step
            value = weight*step*stretch_of(xi_here)
            if (has_logarithm) value = value*log(abs(place_of(angle) - place_of(xi_here)))
            cubic = [-share*(share - 1.0_dp)*(share - 2.0_dp)/6.0_dp, (share + 1.0_dp)*(share - 1.0_dp)*(share - 2.0_dp)/2.0_dp, &
                     -(share + 1.0_dp)*share*(share - 2.0_dp)/2.0_dp, (share + 1.0_dp)*share*(share - 1.0_dp)/6.0_dp]
            do m = -1, 2
               if (interval + m < 1 .or. interval + m > nodes) cycle
               integrals(interval + m) = integrals(interval + m) + value*cubic(m)
            end do
         end do
      end subroutine add_piece

   end function grid_of

   !> Difference of the integral of F(P) dP between two nodes, and its slopes in both pressures.
   elemental subroutine flow_between(oil, low, high, difference, by_low, by_high)
      type(closure_t), intent(in) :: oil
      !> P of the one and the next node [-]
      real(dp), intent(in) :: low
      real(dp), intent(in) :: high
      real(dp), intent(out) :: difference
      real(dp), intent(out) :: by_low
      real(dp), intent(out) :: by_high
      real(dp) :: at_low, at_high, middle, low_slope, high_slope, middle_slope, step

      select case (oil%viscosity_law)
      case (viscosity_constant)
         difference = high - low
         by_low = -1.0_dp
         by_high = 1.0_dp
      case (viscosity_barus)
         at_low = exp(-oil%material*low)
         at_high = exp(-oil%material*high)
         step = oil%material*(high - low)
         by_low = -at_low
         by_high = at_high
         if (abs(step) > 1.0e-3_dp) then
            difference = (at_low - at_high)/oil%material
         else
            difference = (high - low)*0.5_dp*(at_low + at_high)*(1.0_dp - step*step/12.0_dp)
         end if
      case default
         call thicken(oil, low, at_low, low_slope)
         call thicken(oil, high, at_high, high_slope)
         call thicken(oil, 0.5_dp*(low + high), middle, middle_slope)
         at_low = exp(-at_low)
         at_high = exp(-at_high)
         middle = exp(-middle)
         step = (high - low)/6.0_dp
         by_high = (at_low + 4.0_dp*middle + at_high)/6.0_dp
         difference = (high - low)*by_high
         by_low = -by_high - step*(2.0_dp*middle_slope*middle + low_slope*at_low)
         by_high = by_high - step*(2.0_dp*middle_slope*middle + high_slope*at_high)
      end select
   end subroutine flow_between

   !> Balance of all cells: what they gain beyond what flows in, 0 where there is pressure and at least 0 where there is none.
   pure subroutine balance_of_cells(grid, oil, gap, pressures, fourth, rate, past, balance, filled)
      type(nodal_grid_t), intent(in) :: grid
      type(closure_t), intent(in) :: oil
      !> G [-]
      real(dp), intent(in) :: gap
      !> P [-]
      real(dp), intent(in) :: pressures(:)
      !> Share of fourth order in the flow over each edge, as of shares_of_fourth_order
      real(dp), intent(in) :: fourth(0:)
      !> The rate of change of what the cells hold is this factor times it and the past; 0 and nothing: they are at rest
      real(dp), intent(in) :: rate
      real(dp), intent(in) :: past(:)
      type(nodal_balance_t), intent(inout) :: balance
      !> Whether there is a film all along
      logical, intent(out) :: filled
      real(dp), dimension(0:size(pressures)) :: film, flow, by_film, difference, by_low, by_high
      real(dp) :: conductance, slope(0:size(pressures)), by_node(0:size(pressures), -1:2)
      integer :: n, i, k

      n = grid%nodes
      film = gap + 0.5_dp*grid%edge**2
      do k = 1, n
         if (.not. abs(pressures(k)) > 0.0_dp) cycle
         film = film + grid%film(:, k)*pressures(k)
      end do
      filled = all(film > 0.0_dp)
      if (.not. filled) return
      call flow_between(oil, [0.0_dp, pressures], [pressures, 0.0_dp], difference, by_low, by_high)
      slope = difference
      if (.not. allocated(balance%flow_by_fourth)) allocate (balance%flow_by_fourth(0:n))
      balance%flow_by_fourth = 0.0_dp
      by_node(:, -1) = 0.0_dp
      by_node(:, 0) = by_low
      by_node(:, 1) = by_high
      by_node(:, 2) = 0.0_dp
      ! Differences of both neighbours make that of an edge one of fourth order.
      do i = 2, n - 2
         balance%flow_by_fourth(i) = 2.0_dp*difference(i) - difference(i - 1) - difference(i + 1)
         slope(i) = difference(i) + fourth(i)*balance%flow_by_fourth(i)
         by_node(i, :) = by_node(i, :) + fourth(i)*(2.0_dp*by_node(i, :) &
                                                    - [by_low(i - 1), by_high(i - 1), by_low(i + 1), by_high(i + 1)])
      end do
      do i = 0, n
         conductance = film(i)**3/(6.0_dp*grid%stretch(i))
         flow(i) = conductance*slope(i)
         by_film(i) = 1.0_dp - 3.0_dp*flow(i)/film(i)
         by_node(i, :) = conductance*by_node(i, :)
         balance%flow_by_fourth(i) = conductance*balance%flow_by_fourth(i)
      end do
      balance%residual = film(1:) - film(:n - 1) - (flow(1:) - flow(:n - 1)) + past
      if (rate > 0.0_dp) balance%residual = balance%residual + rate*volumes_of(grid, gap, pressures)
      balance%by_gap = by_film(1:) - by_film(:n - 1) + rate*grid%length
      if (.not. allocated(balance%by_pressure)) allocate (balance%by_pressure(n, n))
      do k = 1, n
         do i = 1, n
            balance%by_pressure(i, k) = grid%film(i, k)*by_film(i) - grid%film(i - 1, k)*by_film(i - 1) + rate*grid%volume(i, k)
         end do
      end do
      do i = 0, n
         do k = max(1, i - 1), min(n, i + 2)
            if (i > 0) balance%by_pressure(i, k) = balance%by_pressure(i, k) - by_node(i, k - i)
            if (i < n) balance%by_pressure(i + 1, k) = balance%by_pressure(i + 1, k) + by_node(i, k - i)
         end do
      end do
   end subroutine balance_of_cells

   !> Share of fourth order in the flow over each edge, 1/24 at most: 0 where one of four nodes is ruptured, and little where it
   !> nearly is, so that a film in motion does not jump when a node ruptures. It stays as it is while a step is solved.
   pure function shares_of_fourth_order(pressures) result(shares)
      !> P at the last time [-]
      real(dp), intent(in) :: pressures(:)
      real(dp) :: shares(0:size(pressures))
      integer :: i

      shares = 0.0_dp
      do i = 2, size(pressures) - 2
         if (.not. pressures(i - 1) > 0.0_dp) cycle
         shares(i) = min(1.0_dp, max(0.0_dp, pressures(i + 2))/(fallen*pressures(i - 1)))/24.0_dp
      end do
   end function shares_of_fourth_order

   !> How these shares differ of neighbouring pressures.
   pure function changes_of_fourth_order(pressures, changes) result(shares)
      !> P at the last time [-]
      real(dp), intent(in) :: pressures(:)
      !> By which the others differ from them [-]
      real(dp), intent(in) :: changes(:)
      real(dp) :: shares(0:size(pressures)), ratio
      integer :: i

      shares = 0.0_dp
      do i = 2, size(pressures) - 2
         if (.not. min(pressures(i - 1), pressures(i + 2)) > 0.0_dp) cycle
         ratio = pressures(i + 2)/pressures(i - 1)
         if (ratio < fallen) shares(i) = (changes(i + 2) - ratio*changes(i - 1))/(24.0_dp*fallen*pressures(i - 1))
      end do
   end function changes_of_fourth_order

   !> Newton's correction of pressures, those of ruptured nodes 0: which these are is decided anew.
   pure subroutine correct_pressures(grid, balance, pressures, one_node, active, correction)
      type(nodal_grid_t), intent(in) :: grid
      type(nodal_balance_t), intent(in) :: balance
      real(dp), intent(in) :: pressures(:)
      !> Let one node alone rupture or fill, the first one (Murty's rule), which never goes round in circles where the pressure of a
      !> node lowers what others need
      logical, intent(in) :: one_node
      !> Nodes under pressure, before and after
      logical, intent(inout) :: active(:)
      type(nodal_correction_t), intent(inout) :: correction
      real(dp) :: right(grid%nodes, 2)
      integer :: i, k
      logical :: is_active, solved

      correction%changed = .false.
      do i = 1, grid%nodes
         is_active = pressures(i)*balance%by_pressure(i, i) > balance%residual(i)
         if (one_node .and. correction%changed) is_active = active(i)
         correction%changed = correction%changed .or. (is_active .neqv. active(i))
         active(i) = is_active
      end do
      if (.not. allocated(correction%own)) allocate (correction%own(grid%nodes), correction%with_gap(grid%nodes))
      correction%own = 0.0_dp
      correction%with_gap = 0.0_dp
      right(:, 1) = -balance%residual
      right(:, 2) = -balance%by_gap
      do k = 1, grid%nodes
         if (active(k) .or. .not. abs(pressures(k)) > 0.0_dp) cycle
         correction%own(k) = -pressures(k)
         right(:, 1) = right(:, 1) + balance%by_pressure(:, k)*pressures(k)
      end do
      call solve_active(balance, active, right, solved)
      correction%exists = solved
      if (.not. solved) return
      correction%own = correction%own + right(:, 1)
      correction%with_gap = right(:, 2)
      correction%load = dot_product(grid%load, pressures + correction%own)
      correction%load_by_gap = dot_product(grid%load, correction%with_gap)
   end subroutine correct_pressures

   !> Pressures under which the cells of nodes under pressure balance what is given, linearly.
   pure subroutine solve_active(balance, active, right, solved)
      type(nodal_balance_t), intent(in) :: balance
      !> Nodes under pressure
      logical, intent(in) :: active(:)
      !> Right-hand sides, cell and number, and then the pressures, 0 where the film is ruptured
      real(dp), intent(inout) :: right(:, :)
      logical, intent(out) :: solved
      real(dp) :: table(size(active)*(size(active) + size(right, 2)))
      integer :: places(size(active)), m, i, k

      m = 0
      do i = 1, size(active)
         if (.not. active(i)) cycle
         m = m + 1
         places(m) = i
      end do
      do k = 1, m
         table((k - 1)*m + 1:k*m) = balance%by_pressure(places(:m), places(k))
      end do
      do k = 1, size(right, 2)
         table((m + k - 1)*m + 1:(m + k)*m) = right(places(:m), k)
      end do
      call eliminate(m, m + size(right, 2), table, solved)
      if (.not. solved) return
      right = 0.0_dp
      do k = 1, size(right, 2)
         right(places(:m), k) = table((m + k - 1)*m + 1:(m + k)*m)
      end do
   end subroutine solve_active

   !> What the cells hold.
   pure function volumes_of(grid, gap, pressures) result(volumes)
      type(nodal_grid_t), intent(in) :: grid
      !> G [-]
      real(dp), intent(in) :: gap
      !> P [-]
      real(dp), intent(in) :: pressures(:)
      real(dp) :: volumes(grid%nodes)
      integer :: k

      volumes = gap*grid%length + grid%bowl
      do k = 1, grid%nodes
         if (.not. abs(pressures(k)) > 0.0_dp) cycle
         volumes = volumes + grid%volume(:, k)*pressures(k)
      end do
   end function volumes_of

   !> Film at the node in the middle, which follows all pressures smoothly.
   pure real(dp) function central_film(grid, gap, pressures)
      type(nodal_grid_t), intent(in) :: grid
      !> G [-]
      real(dp), intent(in) :: gap
      !> P [-]
      real(dp), intent(in) :: pressures(:)
      integer :: middle

      middle = (grid%nodes + 1)/2
      central_film = gap + 0.5_dp*grid%place(middle)**2 + dot_product(grid%film_at_nodes(middle, :), pressures)
   end function central_film

   !> Films at the nodes.
   pure function films_at_nodes(grid, gap, pressures) result(films)
      type(nodal_grid_t), intent(in) :: grid
      !> G [-]
      real(dp), intent(in) :: gap
      !> P [-]
      real(dp), intent(in) :: pressures(:)
      real(dp) :: films(grid%nodes)

      films = gap + 0.5_dp*grid%place**2 + matmul(grid%film_at_nodes, pressures)
   end function films_at_nodes

   !> Films at edges and nodes in turn, from the first edge to the last.
   pure function films_along(grid, gap, pressures) result(films)
      type(nodal_grid_t), intent(in) :: grid
      !> G [-]
      real(dp), intent(in) :: gap
      !> P [-]
      real(dp), intent(in) :: pressures(:)
      real(dp) :: films(2*grid%nodes + 1)

      films(2::2) = films_at_nodes(grid, gap, pressures)
      films(1::2) = gap + 0.5_dp*grid%edge**2 + matmul(grid%film, pressures)
   end function films_along

   !> Minimum film thickness over X, between nodes and edges too.
   pure real(dp) function smallest_of_films(films)
      !> As of films_along [-]
      real(dp), intent(in) :: films(:)
      real(dp) :: top, place

      call find_top(-films, top, place)
      smallest_of_films = -top
   end function smallest_of_films

   !> Minimum film thickness over X.
   pure real(dp) function smallest_film(grid, gap, pressures)
      type(nodal_grid_t), intent(in) :: grid
      !> G [-]
      real(dp), intent(in) :: gap
      !> P [-]
      real(dp), intent(in) :: pressures(:)

      smallest_film = smallest_of_films(films_along(grid, gap, pressures))
   end function smallest_film

   !> Largest pressure over X, between nodes too, and where it is.
   pure subroutine find_largest_pressure(pressures, largest, place)
      !> P [-]
      real(dp), intent(in) :: pressures(:)
      !> P [-]
      real(dp), intent(out) :: largest
      !> Number of the node, and the share of the way to the next one
      real(dp), intent(out) :: place

      call find_top(pressures, largest, place)
      largest = max(0.0_dp, largest)
   end subroutine find_largest_pressure

   !> Film at a place: that of the cubic through four films.
   pure real(dp) function film_at_place(films, place) result(film)
      !> As of films_along [-]
      real(dp), intent(in) :: films(:)
      !> As of find_largest_pressure
      real(dp), intent(in) :: place
      real(dp) :: along, share
      integer :: i

      along = 2.0_dp*place
      i = min(max(int(along), 2), size(films) - 2)
      share = along - real(i, dp)
      film = -share*(share - 1.0_dp)*(share - 2.0_dp)/6.0_dp*films(i - 1) &
             + (share + 1.0_dp)*(share - 1.0_dp)*(share - 2.0_dp)/2.0_dp*films(i) &
             - (share + 1.0_dp)*share*(share - 2.0_dp)/2.0_dp*films(i + 1) &
             + (share + 1.0_dp)*share*(share - 1.0_dp)/6.0_dp*films(i + 2)
   end function film_at_place

   !> Largest value of a curve through points at equal distances, and where: that of the cubic through both points about the top and
   !> the next ones, which does not jump where the highest point becomes another one.
   pure subroutine find_top(values, top, at)
      real(dp), intent(in) :: values(:)
      real(dp), intent(out) :: top
      !> Number of the point, and the share of the way to the next one
      real(dp), intent(out) :: at
      real(dp) :: slope, bend, twist, place, root, between
      integer :: i

      top = -huge(top)
      i = maxloc(values, dim=1)
      at = real(i, dp)
      ! No list is empty, which compilers cannot know.
      if (i == 0) return
      top = values(i)
      if (i == 1 .or. i == size(values)) return
      if (values(i - 1) > values(i + 1)) i = i - 1
      if (i == 1 .or. i > size(values) - 2) return
      ! Of value + slope u + bend u^2/2 + twist u^3/6 from point i on
      slope = (-2.0_dp*values(i - 1) - 3.0_dp*values(i) + 6.0_dp*values(i + 1) - values(i + 2))/6.0_dp
      bend = values(i - 1) - 2.0_dp*values(i) + values(i + 1)
      twist = -values(i - 1) + 3.0_dp*values(i) - 3.0_dp*values(i + 1) + values(i + 2)
      root = bend*bend - 2.0_dp*twist*slope
      if (.not. root > 0.0_dp) return
      ! Of both places without slope the one where the curve bends down
      place = 2.0_dp*slope/(-bend + sqrt(root))
      if (.not. (place > 0.0_dp .and. place < 1.0_dp)) return
      between = values(i) + place*(slope + place*(bend/2.0_dp + place*twist/6.0_dp))
      if (.not. between > top) return
      top = between
      at = real(i, dp) + place
   end subroutine find_top

   !> Pressure of a dry contact under a load: B^2 = 8 M/pi, P = B/4 sqrt(1 - X^2/B^2).
   elemental real(dp) function hertzian_pressure(place, load)
      !> X [-]
      real(dp), intent(in) :: place
      !> M >= 0 [-]
      real(dp), intent(in) :: load

      hertzian_pressure = 0.25_dp*sqrt(max(0.0_dp, 8.0_dp/pi*load - place*place))
   end function hertzian_pressure

   !> Pressures of the rigid film in the nodes, scaled to a load.
   pure function rigid_pressures(grid, film, velocity, load) result(pressures)
      type(nodal_grid_t), intent(in) :: grid
      !> H and H' [-]
      real(dp), intent(in) :: film
      real(dp), intent(in) :: velocity
      !> M [-]
      real(dp), intent(in) :: load
      real(dp) :: pressures(grid%nodes), a, rupture
      integer :: i

      a = velocity*sqrt(2.0_dp/film)
      rupture = rupture_tangent_fast(a)
      do i = 1, grid%nodes
         pressures(i) = 0.0_dp
         if (grid%place(i) < rupture*sqrt(2.0_dp*film)) &
            pressures(i) = max(0.0_dp, pressure_group(grid%place(i)/sqrt(2.0_dp*film), rupture, a))
      end do
      if (sum(pressures) > 0.0_dp) pressures = load/dot_product(grid%load, pressures)*pressures
   end function rigid_pressures

end module nodal_film
