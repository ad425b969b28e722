!> A flank whose film is solved in nodes of pressure while the flank bends, and by the closed form of rigid flanks while it does
!> not.
!>
!> Its film is that of rigid flanks as long as s = max(4 M/(pi H), alpha p/10) stays below a bound, with H as its state,
!>
!>     H = G + M (c - (4/pi) ln(0.6 sqrt(2 H))) ,      M = (12/H) Psi(A, B) :
!>
!> the plane contact is that of the width of the film, and thickened oil counts to first order in alpha p. Beyond, its state are
!> the pressures of module nodal_film. A change from one to the other keeps gap and load at the last times, so that backward
!> differences go on through it. A film in nodes becomes rigid again below half of the bound while it opens.
module nodal_flank
   use constants, only: pi
   use elastohydrodynamic_closure, only: closure_t
   use kinds, only: dp
   use nodal_film, only: balance_of_cells, central_film, correct_pressures, film_at_place, films_along, find_largest_pressure, &
                         nodal_balance_t, nodal_correction_t, nodal_grid_t, rigid_pressures, shares_of_fourth_order, &
                         smallest_film, smallest_of_films, volumes_of
   use reynolds_iso_viscous, only: iso_viscous_load, peak_pressure_group, rupture_tangent_fast
   use reynolds_piezo_viscous, only: critical_pressure_group, piezo_viscous_load
   use scene_types, only: viscosity_constant
   implicit none(type, external)
   private

   !> Times that are kept: the last ones, of which backward differences take three and a prediction four.
   integer, parameter, public :: kept_times = 4, difference_times = 3

   !> What all flanks of a scene share.
   type, public :: nodal_contact_t
      type(closure_t) :: oil = closure_t()
      type(nodal_grid_t) :: grid
      !> c [-]
      real(dp) :: compliance = 0.0_dp
      !> Bound of s [-]
      real(dp) :: bound = 1.0e-2_dp
   end type nodal_contact_t

   !> Weights of a step: the rate of change at its end is the sum of weight times value over the end (0) and the last times, the
   !> prediction a sum over the last times.
   type, public :: step_weights_t
      real(dp) :: rate(0:difference_times) = 0.0_dp
      real(dp) :: guess(kept_times) = 0.0_dp
   end type step_weights_t

   !> Flank. Places of its histories: 0 the end of the step under way, 1 the present, 2 and on the times before.
   type, public :: nodal_flank_t
      logical :: in_nodes = .false.
      !> G, M, minimum film thickness H and its rate of change H'
      real(dp), dimension(0:kept_times) :: gap = 0.0_dp, load = 0.0_dp, film = 0.0_dp, velocity = 0.0_dp
      !> Film at the node in the middle, which errors are judged by, and what is predicted of it
      real(dp) :: centre(0:kept_times) = 0.0_dp, guessed_centre = 0.0_dp
      !> Largest pressure P, the film there, that where the gap is nearest without pressure, X = 0, and s, at the end of the step
      !> and at present
      real(dp), dimension(0:1) :: peak = 0.0_dp, film_at_peak = 0.0_dp, middle = 0.0_dp, bending = 0.0_dp
      !> Load predicted
      real(dp) :: guessed_load = 0.0_dp
      !> Pressures and what the cells hold: node, time
      real(dp), allocatable :: pressures(:, :), volumes(:, :)
      !> Nodes under pressure, and the share of fourth order in the flow over each edge
      logical, allocatable :: active(:)
      real(dp), allocatable :: fourth(:)
      !> What the cells held, or the film was, weighted for its rate of change
      real(dp), allocatable :: past(:)
      real(dp) :: past_film = 0.0_dp, rate = 0.0_dp
      type(nodal_balance_t) :: balance
      type(nodal_correction_t) :: correction
      !> Correction of a rigid film, on its own and with the gap
      real(dp) :: film_own = 0.0_dp, film_with_gap = 0.0_dp
   end type nodal_flank_t

   !> Factor of the width of the contact in sqrt(2 H)
   real(dp), parameter :: width_factor = 0.6_dp
   !> Largest B of a closed-form film over the one at which it ends, where Newton's method goes astray
   real(dp), parameter :: most_of_critical = 0.9_dp
   !> Share of the bound below which a film becomes rigid again, and share of alpha p in s
   real(dp), parameter :: return_share = 0.5_dp, pressure_share = 0.1_dp

   public :: begin_step, respond, correct_flank, finish_step, accept_step, stiffen, soften, may_soften, is_bent, rigid_gap, &
             rigid_give, rigid_gap_by_film, rigid_load, share_that_leaves_a_film

contains

   !> Take a step up: its prediction is the first iterate.
   pure subroutine begin_step(weights, flank)
      type(step_weights_t), intent(in) :: weights
      type(nodal_flank_t), intent(inout) :: flank
      integer :: j

      flank%rate = weights%rate(0)
      flank%guessed_load = max(dot_product(weights%guess, flank%load(1:)), 0.0_dp)
      flank%guessed_centre = dot_product(weights%guess, flank%centre(1:))
      flank%film(0) = max(dot_product(weights%guess, flank%film(1:)), 0.5_dp*flank%film(1))
      if (flank%in_nodes) then
         flank%past = matmul(flank%volumes, weights%rate(1:))
         flank%pressures(:, 0) = 0.0_dp
         do j = 1, kept_times
            flank%pressures(:, 0) = flank%pressures(:, 0) + weights%guess(j)*flank%pressures(:, j)
         end do
         where (.not. flank%pressures(:, 1) > 0.0_dp) flank%pressures(:, 0) = 0.0_dp
         flank%pressures(:, 0) = max(flank%pressures(:, 0), 0.0_dp)
         flank%active = flank%pressures(:, 0) > 0.0_dp
         flank%fourth = shares_of_fourth_order(flank%pressures(:, 1))
      else
         flank%past_film = dot_product(weights%rate(1:), flank%film(1:difference_times))
      end if
      flank%gap(0) = dot_product(weights%guess, flank%gap(1:))
   end subroutine begin_step

   !> Load that the film will carry once its state is right, and its slope in the gap.
   pure subroutine respond(contact, one_node, flank, load, by_gap, exists)
      type(nodal_contact_t), intent(in) :: contact
      !> Let one node alone rupture or fill
      logical, intent(in) :: one_node
      type(nodal_flank_t), intent(inout) :: flank
      !> [-]
      real(dp), intent(out) :: load
      real(dp), intent(out) :: by_gap
      logical, intent(out) :: exists
      real(dp) :: by_film, by_velocity, give, miss, slope

      load = 0.0_dp
      by_gap = 0.0_dp
      if (flank%in_nodes) then
         call balance_of_cells(contact%grid, contact%oil, flank%gap(0), flank%pressures(:, 0), flank%fourth, flank%rate, &
                               flank%past, flank%balance, exists)
         if (.not. exists) return
         call correct_pressures(contact%grid, flank%balance, flank%pressures(:, 0), one_node, flank%active, flank%correction)
         exists = flank%correction%exists
         load = flank%correction%load
         by_gap = flank%correction%load_by_gap
      else
         associate (film => flank%film(0))
            call rigid_load(contact, film, flank%rate*film + flank%past_film, flank%load(0), by_film, by_velocity, exists)
            if (.not. exists) return
            by_film = by_film + flank%rate*by_velocity
            give = rigid_give(contact, film)
            miss = film - flank%gap(0) - flank%load(0)*give
            slope = rigid_gap_by_film(film, flank%load(0)) - by_film*give
            flank%film_own = -miss/slope
            flank%film_with_gap = 1.0_dp/slope
            load = flank%load(0) + by_film*flank%film_own
            by_gap = by_film*flank%film_with_gap
         end associate
      end if
   end subroutine respond

   !> Load of a rigid film and its slopes.
   pure subroutine rigid_load(contact, film, velocity, load, by_film, by_velocity, exists)
      type(nodal_contact_t), intent(in) :: contact
      !> H > 0 and H' [-]
      real(dp), intent(in) :: film
      real(dp), intent(in) :: velocity
      !> M [-]
      real(dp), intent(out) :: load
      real(dp), intent(out) :: by_film
      real(dp), intent(out) :: by_velocity
      !> Whether there is such a film
      logical, intent(out) :: exists
      real(dp) :: a, b, psi, by_a, by_b

      a = velocity*sqrt(2.0_dp/film)
      by_b = 0.0_dp
      b = 0.0_dp
      exists = .true.
      if (contact%oil%viscosity_law == viscosity_constant) then
         call iso_viscous_load(a, psi, by_a)
      else
         b = contact%oil%material*pressure_unit(film)
         exists = b < most_of_critical*critical_pressure_group(a)
         if (exists) then
            call piezo_viscous_load(a, b, psi, by_a, by_b)
         else
            call iso_viscous_load(a, psi, by_a)
         end if
      end if
      load = 12.0_dp/film*psi
      by_film = -(load + 12.0_dp/film*(0.5_dp*a*by_a + 1.5_dp*b*by_b))/film
      by_velocity = 12.0_dp/film*by_a*sqrt(2.0_dp/film)
   end subroutine rigid_load

   !> P of p* = 1 of a rigid film [-].
   elemental real(dp) function pressure_unit(film)
      !> H [-]
      real(dp), intent(in) :: film

      pressure_unit = 6.0_dp*sqrt(2.0_dp)/(film*sqrt(film))
   end function pressure_unit

   !> Gap that a rigid film under a load leaves [-].
   pure real(dp) function rigid_gap(contact, film, load)
      type(nodal_contact_t), intent(in) :: contact
      !> H and M [-]
      real(dp), intent(in) :: film
      real(dp), intent(in) :: load

      rigid_gap = film - load*rigid_give(contact, film)
   end function rigid_gap

   !> Compliance of the contact of a rigid film, on its width [-].
   pure real(dp) function rigid_give(contact, film)
      type(nodal_contact_t), intent(in) :: contact
      !> H [-]
      real(dp), intent(in) :: film

      rigid_give = contact%compliance - 4.0_dp/pi*log(width_factor*sqrt(2.0_dp*film))
   end function rigid_give

   !> Slope of this gap in the film under a load [-].
   elemental real(dp) function rigid_gap_by_film(film, load)
      !> H and M [-]
      real(dp), intent(in) :: film
      real(dp), intent(in) :: load

      rigid_gap_by_film = 1.0_dp + 2.0_dp/pi*load/film
   end function rigid_gap_by_film

   !> Share of a correction of the gap after which there is still a film.
   pure real(dp) function share_that_leaves_a_film(flank, gap_change) result(share)
      type(nodal_flank_t), intent(in) :: flank
      !> dG [-]
      real(dp), intent(in) :: gap_change
      real(dp), parameter :: least_left = 0.3_dp
      real(dp) :: change

      share = 1.0_dp
      if (flank%in_nodes) return
      change = flank%film_own + flank%film_with_gap*gap_change
      if (change < -(1.0_dp - least_left)*flank%film(0)) share = -(1.0_dp - least_left)*flank%film(0)/change
   end function share_that_leaves_a_film

   !> Let gap and state follow a correction of the gap.
   pure subroutine correct_flank(contact, share, gap_change, flank, change)
      type(nodal_contact_t), intent(in) :: contact
      !> Share of the correction that is taken
      real(dp), intent(in) :: share
      !> Whole correction dG [-]
      real(dp), intent(in) :: gap_change
      type(nodal_flank_t), intent(inout) :: flank
      !> Relative change of the state; 1 or more where nodes rupture or fill
      real(dp), intent(out) :: change
      real(dp) :: changes(contact%grid%nodes)

      flank%gap(0) = flank%gap(0) + share*gap_change
      if (flank%in_nodes) then
         changes = share*(flank%correction%own + flank%correction%with_gap*gap_change)
         flank%pressures(:, 0) = flank%pressures(:, 0) + changes
         where (.not. flank%active) flank%pressures(:, 0) = 0.0_dp
         change = maxval(abs(changes))/(maxval(flank%pressures(:, 0)) + 1.0e-4_dp)
         if (flank%correction%changed) change = max(change, 1.0_dp)
      else
         change = share*(flank%film_own + flank%film_with_gap*gap_change)
         flank%film(0) = flank%film(0) + change
         change = abs(change)/flank%film(0)
      end if
   end subroutine correct_flank

   !> What follows from the state at the end of a step.
   pure subroutine finish_step(contact, weights, flank)
      type(nodal_contact_t), intent(in) :: contact
      type(step_weights_t), intent(in) :: weights
      type(nodal_flank_t), intent(inout) :: flank
      real(dp) :: peak, place, slope, by_film, by_velocity, films(2*contact%grid%nodes + 1)
      logical :: exists

      if (flank%in_nodes) then
         ! A node may be below 0 by rounding.
         flank%load(0) = dot_product(contact%grid%load, flank%pressures(:, 0))
         films = films_along(contact%grid, flank%gap(0), flank%pressures(:, 0))
         flank%film(0) = smallest_of_films(films)
         flank%centre(0) = films(2*((contact%grid%nodes + 1)/2))
         call find_largest_pressure(flank%pressures(:, 0), flank%peak(0), place)
         flank%film_at_peak(0) = film_at_place(films, place)
         flank%middle(0) = film_at_place(films, contact%grid%middle)
         flank%velocity(0) = dot_product(weights%rate, flank%film(0:difference_times))
      else
         flank%velocity(0) = dot_product(weights%rate, flank%film(0:difference_times))
         call rigid_load(contact, flank%film(0), flank%velocity(0), flank%load(0), by_film, by_velocity, exists)
         associate (a => flank%velocity(0)*sqrt(2.0_dp/flank%film(0)))
            call peak_pressure_group(a, peak, slope)
            ! Where as much flows through as at the rupture: t^2 + A t is the same at both places.
            place = rupture_tangent_fast(a) + a
         end associate
         flank%peak(0) = pressure_unit(flank%film(0))*peak
         flank%film_at_peak(0) = flank%film(0)*(1.0_dp + place*place)
         flank%middle(0) = flank%film(0)
         flank%centre(0) = flank%film(0)
      end if
      flank%bending(0) = 4.0_dp/pi*flank%load(0)/flank%film(0)
      if (contact%oil%viscosity_law /= viscosity_constant) &
         flank%bending(0) = max(flank%bending(0), pressure_share*contact%oil%material*flank%peak(0))
   end subroutine finish_step

   !> Whether a film bends its flank by more than a rigid one may.
   pure logical function is_bent(contact, flank)
      type(nodal_contact_t), intent(in) :: contact
      type(nodal_flank_t), intent(in) :: flank

      is_bent = flank%bending(0) > contact%bound
   end function is_bent

   !> Let the end of a step be the present.
   pure subroutine accept_step(contact, flank)
      type(nodal_contact_t), intent(in) :: contact
      type(nodal_flank_t), intent(inout) :: flank

      flank%gap(1:) = flank%gap(:kept_times - 1)
      flank%load(1:) = flank%load(:kept_times - 1)
      flank%film(1:) = flank%film(:kept_times - 1)
      flank%centre(1:) = flank%centre(:kept_times - 1)
      flank%velocity(1:) = flank%velocity(:kept_times - 1)
      flank%peak(1) = flank%peak(0)
      flank%film_at_peak(1) = flank%film_at_peak(0)
      flank%middle(1) = flank%middle(0)
      flank%bending(1) = flank%bending(0)
      if (.not. flank%in_nodes) return
      flank%pressures(:, 1:) = flank%pressures(:, :kept_times - 1)
      flank%volumes(:, 2:) = flank%volumes(:, :difference_times - 1)
      flank%volumes(:, 1) = volumes_of(contact%grid, flank%gap(0), flank%pressures(:, 0))
   end subroutine accept_step

   !> From the closed form to nodes: pressures of the closed form at the last times, scaled to the loads that they had.
   pure subroutine stiffen(contact, flank)
      type(nodal_contact_t), intent(in) :: contact
      type(nodal_flank_t), intent(inout) :: flank
      integer :: j, n

      n = contact%grid%nodes
      flank%in_nodes = .true.
      if (.not. allocated(flank%pressures)) then
         allocate (flank%pressures(n, 0:kept_times), flank%volumes(n, difference_times), flank%past(n), source=0.0_dp)
         allocate (flank%active(n), source=.false.)
      end if
      do j = 1, kept_times
         flank%pressures(:, j) = rigid_pressures(contact%grid, flank%film(j), flank%velocity(j), flank%load(j))
         flank%film(j) = smallest_film(contact%grid, flank%gap(j), flank%pressures(:, j))
         flank%centre(j) = central_film(contact%grid, flank%gap(j), flank%pressures(:, j))
         if (j <= difference_times) flank%volumes(:, j) = volumes_of(contact%grid, flank%gap(j), flank%pressures(:, j))
      end do
   end subroutine stiffen

   !> Whether a film in nodes may be followed by the closed form from the present on.
   pure logical function may_soften(contact, flank)
      type(nodal_contact_t), intent(in) :: contact
      type(nodal_flank_t), intent(in) :: flank

      may_soften = flank%in_nodes .and. flank%bending(1) < return_share*contact%bound .and. flank%velocity(1) > 0.0_dp
   end function may_soften

   !> From nodes to the closed form: films of the gaps and loads at the last times.
   pure subroutine soften(contact, flank)
      type(nodal_contact_t), intent(in) :: contact
      type(nodal_flank_t), intent(inout) :: flank
      integer, parameter :: most_passes = 50
      real(dp) :: film, step
      integer :: j, pass

      flank%in_nodes = .false.
      do j = 1, kept_times
         film = flank%film(j)
         do pass = 1, most_passes
            step = (flank%gap(j) - rigid_gap(contact, film, flank%load(j)))/rigid_gap_by_film(film, flank%load(j))
            film = max(film + step, 0.1_dp*film)
            if (abs(step) <= 1.0e-13_dp*film) exit
         end do
         flank%film(j) = film
         flank%centre(j) = film
      end do
   end subroutine soften

end module nodal_flank
