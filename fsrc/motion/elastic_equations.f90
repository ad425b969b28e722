!> Equations of films without a state in an implicit step (module elastic_step): by how much their laws miss at the nodes, and what
!> the loads change of that.
module elastic_equations
   use elastic_trial, only: sign_of, trial_t
   use flank_contact, only: equations_of_films, film_equations_t, flank_contact_t, most_films
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use radau_nodes, only: once_rows, rows, slope_rows, stages, twice_rows, weigh
   use step_elimination, only: most_columns, most_rows
   implicit none(type, external)
   private

   !> Slopes of the equations at the nodes, of one flank after the other: by the film, by its velocity and by its load [-]
   type, public :: slopes_t
      real(dp), dimension(most_films) :: by_film = 0.0_dp, by_velocity = 0.0_dp, by_load = 0.0_dp
      !> Whether the equation is that of velocities
      logical, dimension(most_films) :: of_velocities = .false.
   end type slopes_t

   !> Weight of a load at a node in the velocity of its film there, about: what the table of slopes has on its diagonal
   real(dp), parameter :: velocity_share = 10.0_dp

   public :: imbalances, newton_matrix

contains

   !> By how much the film laws miss at the nodes, and their slopes; none where a film has no load. A film without thickness is to
   !> be what it was at the start.
   pure subroutine imbalances(contact, lane, block, trial, right, slopes, found)
      type(flank_contact_t), intent(in) :: contact
      integer, intent(in) :: lane
      type(lane_block_t), intent(inout) :: block
      type(trial_t), intent(in) :: trial
      real(dp), intent(out) :: right(most_rows)
      type(slopes_t), intent(inout) :: slopes
      logical, intent(out) :: found
      type(film_equations_t) :: laws
      real(dp), dimension(rows, 2) :: films, loads, velocities
      integer :: n, flank, place, i

      n = rows*trial%flanks
      do flank = 1, trial%flanks
         films(:, flank) = merge(trial%film(:, flank), trial%start(flank), trial%film(:, flank) > 0.0_dp)*block%film_scale(lane)
         loads(:, flank) = trial%load(:, flank)*block%force_scale(lane)
         velocities(:, flank) = trial%velocity(:, flank)*block%velocity_scale(lane)
      end do
      call equations_of_films(contact, n, films, loads, velocities, velocity_share*block%compliance(lane)/block%step(lane)* &
                              (block%velocity_scale(lane)/block%force_scale(lane)), laws)
      slopes%of_velocities(:n) = laws%of_velocities(:n)
      right(n + 1:) = 0.0_dp
      call scale_laws(n, block%film_scale(lane), block%velocity_scale(lane), block%force_scale(lane), laws, trial%load, &
                      trial%velocity, right, slopes)
      found = .true.
      do flank = 1, trial%flanks
         do i = 1, stages
            place = rows*(flank - 1) + i
            if (trial%film(i, flank) > 0.0_dp) then
               block%no_load(lane) = laws%overloaded(place)
               found = laws%exists(place)
               if (.not. found) return
            else
               right(place) = trial%film(i, flank) - trial%start(flank)
               slopes%by_film(place) = -1.0_dp
               slopes%by_velocity(place) = 0.0_dp
               slopes%by_load(place) = 0.0_dp
            end if
         end do
         right(rows*flank) = 0.0_dp
      end do
   end subroutine imbalances

   !> The equations in scaled units.
   pure subroutine scale_laws(n, film_unit, velocity_unit, force_unit, laws, load, velocity, right, slopes)
      !> How many
      integer, intent(in) :: n
      !> What counts as 1 [m], [m/s], [N]
      real(dp), intent(in) :: film_unit
      real(dp), intent(in) :: velocity_unit
      real(dp), intent(in) :: force_unit
      type(film_equations_t), intent(in) :: laws
      !> W and H' [-]
      real(dp), intent(in) :: load(most_films)
      real(dp), intent(in) :: velocity(most_films)
      !> By how much the laws miss [-]
      real(dp), intent(inout) :: right(most_films)
      type(slopes_t), intent(inout) :: slopes
      integer :: i

      !$omp simd
      do i = 1, n
         right(i) = laws%value(i)*(1.0_dp/velocity_unit) - velocity(i)
         slopes%by_film(i) = -laws%by_film(i)*(film_unit/velocity_unit)
         slopes%by_velocity(i) = 1.0_dp
         slopes%by_load(i) = -laws%by_other(i)*(force_unit/velocity_unit)
      end do
      if (all(laws%of_velocities(:n))) return
      do i = 1, n
         if (laws%of_velocities(i)) cycle
         right(i) = laws%value(i)/force_unit - load(i)
         slopes%by_film(i) = -laws%by_film(i)*(film_unit/force_unit)
         slopes%by_velocity(i) = -laws%by_other(i)*(velocity_unit/force_unit)
         slopes%by_load(i) = 1.0_dp
      end do
   end subroutine scale_laws

   !> Newton's matrix: what the loads at the nodes change of the equations there.
   pure subroutine newton_matrix(bends, lane, block, trial, slopes, matrix)
      !> Whether flanks bend
      logical, intent(in) :: bends
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      type(trial_t), intent(in) :: trial
      type(slopes_t), intent(in) :: slopes
      real(dp), intent(out) :: matrix(most_rows, most_columns)
      real(dp), dimension(rows) :: by_film, by_velocity, by_load, by_gear, moved, rates
      real(dp) :: turn
      integer :: first, flank, other, column, j

      matrix(rows*trial%flanks + 1:, :) = 0.0_dp
      associate (s => block%step(lane), flanks => trial%flanks)
         do flank = 1, flanks
            first = rows*(flank - 1)
            ! The row that fills registers stays zero.
            by_film = slopes%by_film(first + 1:first + rows)
            by_velocity = slopes%by_velocity(first + 1:first + rows)
            by_load = slopes%by_load(first + 1:first + rows)
            by_film(rows) = 0.0_dp
            by_velocity(rows) = 0.0_dp
            do j = 1, stages
               by_gear = s*(by_film*s*twice_rows(:, j) + by_velocity*once_rows(:, j))
               if (bends) then
                  moved = trial%follows(:, flank)*twice_rows(:, j)
                  call weigh(slope_rows, moved, rates)
                  by_gear = by_gear + s*(by_film*s*moved + by_velocity*rates)
               end if
               do other = 1, flanks
                  turn = sign_of(flank)*sign_of(other)
                  matrix(first + 1:first + rows, stages*(other - 1) + j) = turn*by_gear
               end do
               column = stages*(flank - 1) + j
               matrix(first + 1:first + rows, column) = matrix(first + 1:first + rows, column) + &
                                                        (trial%compliance(j, flank)/s)*by_velocity*slope_rows(:, j)
               matrix(first + j, column) = matrix(first + j, column) + (by_load(j) + by_film(j)*trial%compliance(j, flank))
            end do
         end do
      end associate
   end subroutine newton_matrix

end module elastic_equations
