!> How two neighbours of a motion in nodes of pressure part from it: each accepted step of module nodal_step, linearised about its
!> end. Times of the steps, nodes under pressure and what a film is followed by are those of the motion, so that a neighbour is a
!> smooth function of where it starts: differences of whole motions, whose steps are chosen anew, would be worth no more than the
!> tolerance of a step over the distance. Histories of films and pressures are those of the neighbours too, and a neighbour that
!> starts from pressures which do not belong to its gear has them right within a small part of a period.
module nodal_tangent
   use kinds, only: dp
   use nodal_film, only: balance_of_cells, central_film, changes_of_fourth_order, nodal_balance_t, rigid_pressures, &
                         smallest_film, solve_active, volumes_of
   use nodal_flank, only: difference_times, kept_times, nodal_contact_t, nodal_flank_t, rigid_gap_by_film, rigid_give, &
                          rigid_load, step_weights_t
   implicit none(type, external)
   private

   !> Neighbours that are followed
   integer, parameter, public :: neighbours = 2

   !> How the histories of a flank differ, place as in module nodal_flank, neighbour; and what its film does in a step.
   type, public :: flank_tangent_t
      !> Of G, M, H and H'
      real(dp), dimension(0:kept_times, neighbours) :: gap = 0.0_dp, load = 0.0_dp, film = 0.0_dp, velocity = 0.0_dp
      !> Of pressures and of what the cells hold: node, time, neighbour
      real(dp), allocatable :: pressures(:, :, :), volumes(:, :, :)
      !> Change of the state of the film on its own, neighbour by neighbour, and with the gap behind them
      real(dp), allocatable :: response(:, :)
   end type flank_tangent_t

   !> How neighbours differ from a motion, linearly.
   type, public :: nodal_tangent_t
      type(flank_tangent_t) :: flanks(2)
      !> Of Z and Z': place, neighbour
      real(dp), dimension(0:kept_times, neighbours) :: position = 0.0_dp, velocity = 0.0_dp
      !> Whether all steps could be linearised
      logical :: exists = .true.
   end type nodal_tangent_t

   !> Distance of two films whose difference is taken, over the film
   real(dp), parameter :: difference_step = 1.0e-6_dp

   public :: start_tangent, stiffen_tangent, advance_tangent, soften_tangent, combine, displace

contains

   !> Neighbours that start with the gear elsewhere, and with another velocity; loads are those of the motion.
   pure subroutine start_tangent(contact, flanks, times, tangent)
      type(nodal_contact_t), intent(in) :: contact
      !> One or two
      type(nodal_flank_t), intent(in) :: flanks(:)
      !> In the unit of Moes' time [-]
      real(dp), intent(in) :: times(0:)
      type(nodal_tangent_t), intent(out) :: tangent
      integer :: flank, j, k

      tangent%position(:, 1) = 1.0_dp
      tangent%position(:, 2) = times - times(1)
      tangent%velocity(:, 2) = 1.0_dp
      do flank = 1, size(flanks)
         associate (film => flanks(flank), change => tangent%flanks(flank))
            change%gap = merge(1.0_dp, -1.0_dp, flank == 1)*tangent%position
            if (film%in_nodes) then
               call make_room(contact%grid%nodes, change)
               do k = 1, neighbours
                  do j = 1, difference_times
                     change%volumes(:, j, k) = contact%grid%length*change%gap(j, k)
                  end do
               end do
            else
               do k = 1, neighbours
                  change%film(1:, k) = change%gap(1:, k)/rigid_gap_by_film(film%film(1:), film%load(1:))
               end do
            end if
         end associate
      end do
   end subroutine start_tangent

   !> Room for pressures and volumes.
   pure subroutine make_room(nodes, change)
      integer, intent(in) :: nodes
      type(flank_tangent_t), intent(inout) :: change

      if (.not. allocated(change%pressures)) &
         allocate (change%pressures(nodes, 0:kept_times, neighbours), change%volumes(nodes, difference_times, neighbours))
      change%pressures = 0.0_dp
      change%volumes = 0.0_dp
   end subroutine make_room

   !> From the closed form to nodes, before the flank of the motion goes there.
   pure subroutine stiffen_tangent(contact, flank, change)
      type(nodal_contact_t), intent(in) :: contact
      !> Still by the closed form
      type(nodal_flank_t), intent(in) :: flank
      type(flank_tangent_t), intent(inout) :: change
      real(dp), dimension(contact%grid%nodes) :: pressures, others
      real(dp) :: share
      integer :: j, k

      call make_room(contact%grid%nodes, change)
      do j = 1, kept_times
         pressures = rigid_pressures(contact%grid, flank%film(j), flank%velocity(j), flank%load(j))
         do k = 1, neighbours
            associate (film => change%film(j, k), velocity => change%velocity(j, k), load => change%load(j, k))
               share = difference_step/max(abs(film)/flank%film(j), abs(velocity)/(abs(flank%velocity(j)) + flank%film(j)), &
                                           tiny(1.0_dp)/difference_step)
               others = rigid_pressures(contact%grid, flank%film(j) + share*film, flank%velocity(j) + share*velocity, flank%load(j))
               ! Pressures are as large as their load.
               if (flank%load(j) > 0.0_dp) change%pressures(:, j, k) = (others - pressures)/share + load/flank%load(j)*pressures
               if (j <= difference_times) change%volumes(:, j, k) = change%gap(j, k)*contact%grid%length + &
                                                                    matmul(contact%grid%volume, change%pressures(:, j, k))
            end associate
         end do
      end do
   end subroutine stiffen_tangent

   !> From nodes to the closed form, after the flank of the motion has gone there.
   pure subroutine soften_tangent(contact, flank, change)
      type(nodal_contact_t), intent(in) :: contact
      !> By the closed form
      type(nodal_flank_t), intent(in) :: flank
      type(flank_tangent_t), intent(inout) :: change
      integer :: j

      do j = 1, kept_times
         change%film(j, :) = (change%gap(j, :) + rigid_give(contact, flank%film(j))*change%load(j, :)) &
                             /rigid_gap_by_film(flank%film(j), flank%load(j))
      end do
   end subroutine soften_tangent

   !> The next step: the films, each for a gap that is still to be found, the gear, and then what follows from it.
   pure subroutine advance_tangent(contact, flanks, mass, weights, tangent)
      type(nodal_contact_t), intent(in) :: contact
      !> One or two, at the end of a step that is accepted
      type(nodal_flank_t), intent(in) :: flanks(:)
      !> mu [-]
      real(dp), intent(in) :: mass
      type(step_weights_t), intent(in) :: weights
      type(nodal_tangent_t), intent(inout) :: tangent
      real(dp), dimension(neighbours) :: past_position, past_velocity, loads
      real(dp) :: by_gap
      integer :: flank

      loads = 0.0_dp
      by_gap = 0.0_dp
      do flank = 1, size(flanks)
         call respond(contact, flanks(flank), weights, merge(1.0_dp, -1.0_dp, flank == 1), tangent%flanks(flank), loads, by_gap, &
                      tangent%exists)
         if (.not. tangent%exists) return
      end do
      associate (a0 => weights%rate(0), position => tangent%position, velocity => tangent%velocity)
         past_position = matmul(weights%rate(1:), position(1:difference_times, :))
         past_velocity = matmul(weights%rate(1:), velocity(1:difference_times, :))
         position(0, :) = (loads - mass*(a0*past_position + past_velocity))/(mass*a0*a0 - by_gap)
         velocity(0, :) = a0*position(0, :) + past_position
         do flank = 1, size(flanks)
            tangent%flanks(flank)%gap(0, :) = merge(1.0_dp, -1.0_dp, flank == 1)*position(0, :)
            call finish(contact, flanks(flank), weights, tangent%flanks(flank))
         end do
         position(1:, :) = position(:kept_times - 1, :)
         velocity(1:, :) = velocity(:kept_times - 1, :)
      end associate
   end subroutine advance_tangent

   !> Changes of a film on its own and with its gap, and what its load adds to the force on the gear.
   pure subroutine respond(contact, flank, weights, sense, change, loads, by_gap, exists)
      type(nodal_contact_t), intent(in) :: contact
      type(nodal_flank_t), intent(in) :: flank
      type(step_weights_t), intent(in) :: weights
      !> 1 of the drive flank, -1 of the coast flank
      real(dp), intent(in) :: sense
      type(flank_tangent_t), intent(inout) :: change
      !> [-]
      real(dp), intent(inout) :: loads(:)
      !> Slope of all loads in Z [-]
      real(dp), intent(inout) :: by_gap
      logical, intent(out) :: exists
      type(nodal_balance_t) :: balance
      real(dp) :: load, by_film, by_velocity, give, slope, flow(0:contact%grid%nodes)
      integer :: k

      if (allocated(change%response)) deallocate (change%response)
      if (flank%in_nodes) then
         call balance_of_cells(contact%grid, contact%oil, flank%gap(0), flank%pressures(:, 0), flank%fourth, flank%rate, &
                               flank%past, balance, exists)
         if (.not. exists) return
         allocate (change%response(contact%grid%nodes, neighbours + 1))
         do k = 1, neighbours
            flow = balance%flow_by_fourth*changes_of_fourth_order(flank%pressures(:, 1), change%pressures(:, 1, k))
            change%response(:, k) = flow(1:) - flow(:contact%grid%nodes - 1) - matmul(change%volumes(:, :, k), weights%rate(1:))
         end do
         change%response(:, neighbours + 1) = -balance%by_gap
         call solve_active(balance, flank%active, change%response, exists)
         if (.not. exists) return
         loads = loads + sense*matmul(contact%grid%load, change%response(:, :neighbours))
         by_gap = by_gap + dot_product(contact%grid%load, change%response(:, neighbours + 1))
      else
         allocate (change%response(1, neighbours + 1))
         call rigid_load(contact, flank%film(0), flank%velocity(0), load, by_film, by_velocity, exists)
         if (.not. exists) return
         by_film = by_film + flank%rate*by_velocity
         give = rigid_give(contact, flank%film(0))
         slope = rigid_gap_by_film(flank%film(0), load) - by_film*give
         change%response(1, neighbours + 1) = 1.0_dp/slope
         do k = 1, neighbours
            associate (past => dot_product(weights%rate(1:), change%film(1:difference_times, k)))
               change%response(1, k) = give*by_velocity*past/slope
               loads(k) = loads(k) + sense*(by_film*change%response(1, k) + by_velocity*past)
            end associate
         end do
         by_gap = by_gap + by_film/slope
      end if
   end subroutine respond

   !> Histories of a flank after a step.
   pure subroutine finish(contact, flank, weights, change)
      type(nodal_contact_t), intent(in) :: contact
      type(nodal_flank_t), intent(in) :: flank
      type(step_weights_t), intent(in) :: weights
      !> Its gap at the end is known
      type(flank_tangent_t), intent(inout) :: change
      real(dp) :: share
      integer :: k

      do k = 1, neighbours
         associate (state => change%response(:, k) + change%response(:, neighbours + 1)*change%gap(0, k))
            if (flank%in_nodes) then
               change%pressures(:, 0, k) = state
               change%load(0, k) = dot_product(contact%grid%load, state)
               share = difference_step*flank%film(0)/max(abs(change%gap(0, k)), maxval(abs(state)), tiny(1.0_dp))
               change%film(0, k) = (smallest_film(contact%grid, flank%gap(0) + share*change%gap(0, k), &
                                                  flank%pressures(:, 0) + share*state) - flank%film(0))/share
            else
               change%film(0, k) = state(1)
               change%load(0, k) = (state(1)*rigid_gap_by_film(flank%film(0), flank%load(0)) - change%gap(0, k)) &
                                   /rigid_give(contact, flank%film(0))
            end if
         end associate
      end do
      change%velocity(0, :) = matmul(weights%rate, change%film(0:difference_times, :))
      change%gap(1:, :) = change%gap(:kept_times - 1, :)
      change%load(1:, :) = change%load(:kept_times - 1, :)
      change%film(1:, :) = change%film(:kept_times - 1, :)
      change%velocity(1:, :) = change%velocity(:kept_times - 1, :)
      if (.not. flank%in_nodes) return
      change%pressures(:, 1:, :) = change%pressures(:, :kept_times - 1, :)
      change%volumes(:, 2:, :) = change%volumes(:, :difference_times - 1, :)
      do k = 1, neighbours
         change%volumes(:, 1, k) = change%gap(0, k)*contact%grid%length + matmul(contact%grid%volume, change%pressures(:, 0, k))
      end do
   end subroutine finish

   !> Other neighbours: linear combinations of these.
   pure subroutine combine(matrix, tangent)
      !> Share of an old neighbour, old and new one
      real(dp), intent(in) :: matrix(neighbours, neighbours)
      type(nodal_tangent_t), intent(inout) :: tangent
      integer :: flank, j

      tangent%position = matmul(tangent%position, matrix)
      tangent%velocity = matmul(tangent%velocity, matrix)
      do flank = 1, size(tangent%flanks)
         associate (change => tangent%flanks(flank))
            change%gap = matmul(change%gap, matrix)
            change%load = matmul(change%load, matrix)
            change%film = matmul(change%film, matrix)
            change%velocity = matmul(change%velocity, matrix)
            if (.not. allocated(change%pressures)) cycle
            do j = 0, kept_times
               change%pressures(:, j, :) = matmul(change%pressures(:, j, :), matrix)
            end do
            do j = 1, difference_times
               change%volumes(:, j, :) = matmul(change%volumes(:, j, :), matrix)
            end do
         end associate
      end do
   end subroutine combine

   !> Let the histories of a flank be those of a neighbour.
   pure subroutine displace(contact, shares, change, flank)
      type(nodal_contact_t), intent(in) :: contact
      !> Of both neighbours
      real(dp), intent(in) :: shares(neighbours)
      type(flank_tangent_t), intent(in) :: change
      type(nodal_flank_t), intent(inout) :: flank
      integer :: j

      flank%gap(1:) = flank%gap(1:) + matmul(change%gap(1:, :), shares)
      flank%load(1:) = max(flank%load(1:) + matmul(change%load(1:, :), shares), 0.0_dp)
      flank%velocity(1:) = flank%velocity(1:) + matmul(change%velocity(1:, :), shares)
      flank%film(1:) = max(flank%film(1:) + matmul(change%film(1:, :), shares), 0.5_dp*flank%film(1:))
      if (.not. flank%in_nodes) then
         flank%centre(1:) = flank%film(1:)
         return
      end if
      do j = 1, kept_times
         flank%pressures(:, j) = max(flank%pressures(:, j) + matmul(change%pressures(:, j, :), shares), 0.0_dp)
         flank%load(j) = dot_product(contact%grid%load, flank%pressures(:, j))
         flank%centre(j) = central_film(contact%grid, flank%gap(j), flank%pressures(:, j))
         if (j <= difference_times) flank%volumes(:, j) = volumes_of(contact%grid, flank%gap(j), flank%pressures(:, j))
      end do
   end subroutine displace

end module nodal_tangent
