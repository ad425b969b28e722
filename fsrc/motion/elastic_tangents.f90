!> Small displacements of the motion in a lane, carried along its implicit steps (module elastic_step): the derivative of the step
!> itself, not a difference of motions beside each other. The matrix is that of Newton's method where this has ended, and every
!> displacement is one more right-hand side (fsrc/THEORY.md, section 6).
module elastic_tangents
   use elastic_newton, only: newton_matrix, slopes_t, residuals
   use elastic_trial, only: trial_t
   use film_law, only: width_compression
   use flank_contact, only: flank_contact_t
   use kinds, only: dp
   use lane_block, only: lane_block_t
   use problem, only: of_drive_compression, of_film, of_velocity
   use radau_nodes, only: node_rows, once_rows, rows, slope_rows, stages, twice_rows, weigh
   use step_elimination, only: factorise, factors_t, most_columns, most_rows, substitute
   use taylor_step_control, only: sign_of
   implicit none(type, external)
   private

   !> Displacements of the motion in a lane.
   type, public :: lane_tangents_t
      !> Scaled like the state: number of the state, displacement; not allocated where none are followed [-]
      real(dp), allocatable :: now(:, :)
   end type lane_tangents_t

   public :: place_tangents, tangents_in_units, carry_tangents

contains

   !> Put displacements into a lane that has its motion.
   pure subroutine place_tangents(displacements, lane, block, tangents)
      !> Number of the state, displacement, each in its unit times any number
      real(dp), intent(in) :: displacements(:, :)
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      type(lane_tangents_t), intent(out) :: tangents

      tangents%now = displacements/block%film_scale(lane)
      tangents%now(of_velocity, :) = displacements(of_velocity, :)/block%velocity_scale(lane)
   end subroutine place_tangents

   !> The displacements of a lane in the units that they were placed in.
   pure function tangents_in_units(tangents, lane, block) result(displacements)
      type(lane_tangents_t), intent(in) :: tangents
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      real(dp) :: displacements(size(tangents%now, 1), size(tangents%now, 2))

      displacements = tangents%now*block%film_scale(lane)
      displacements(of_velocity, :) = tangents%now(of_velocity, :)*block%velocity_scale(lane)
   end function tangents_in_units

   !> Carry the displacements of a lane to the end of a step that stands. Where a film has no load there, which no solved step has, the
   !> step is not accepted.
   pure subroutine carry_tangents(contact, lane, trial, block, tangents)
      type(flank_contact_t), intent(in) :: contact
      integer, intent(in) :: lane
      !> The solved step
      type(trial_t), intent(in) :: trial
      type(lane_block_t), intent(inout) :: block
      type(lane_tangents_t), intent(inout) :: tangents
      type(slopes_t) :: slopes
      type(factors_t) :: factors
      real(dp) :: matrix(most_rows, most_columns), right(most_rows), by_film(2), by_load(2)
      logical :: found
      integer :: i

      call residuals(contact, lane, block, trial, right, slopes, found)
      if (.not. found) then
         block%accepted(lane) = 0.0_dp
         return
      end if
      call newton_matrix(contact%film%bends, lane, block, trial, slopes, matrix)
      call factorise(trial%flanks, matrix, factors)
      call width_slopes(contact, lane, block, trial, by_film, by_load)
      do i = 1, size(tangents%now, 2)
         call carry(contact%film%bends, block%step(lane), block%compliance(lane), block%damped_share(lane), trial, slopes, &
                    factors, by_film, by_load, tangents%now(:, i))
      end do
   end subroutine carry_tangents

   !> What film and spring change of the compression of a flank by its width, where the step begins [-].
   pure subroutine width_slopes(contact, lane, block, trial, by_film, by_load)
      type(flank_contact_t), intent(in) :: contact
      integer, intent(in) :: lane
      type(lane_block_t), intent(in) :: block
      type(trial_t), intent(in) :: trial
      !> By the film, and by the compression of the spring, of each flank
      real(dp), intent(out) :: by_film(2)
      real(dp), intent(out) :: by_load(2)
      real(dp) :: width
      integer :: flank

      by_film = 0.0_dp
      by_load = 0.0_dp
      do flank = 1, trial%flanks
         call width_compression(contact%film, trial%start(flank)*block%film_scale(lane), &
                                block%compression(lane, flank, 0)/block%compliance(lane)*block%force_scale(lane), width, &
                                by_film(flank), by_load(flank))
         by_load(flank) = by_load(flank)*(block%force_scale(lane)/block%film_scale(lane))/block%compliance(lane)
      end do
   end subroutine width_slopes

   !> Carry one displacement.
   pure subroutine carry(bends, step, compliance, damped_share, trial, slopes, factors, by_film, by_load, tangent)
      !> Whether flanks bend
      logical, intent(in) :: bends
      !> [periods]
      real(dp), intent(in) :: step
      !> Of a spring, and the share of a damped tooth in it [-]
      real(dp), intent(in) :: compliance
      real(dp), intent(in) :: damped_share
      type(trial_t), intent(in) :: trial
      type(slopes_t), intent(in) :: slopes
      type(factors_t), intent(in) :: factors
      !> As of width_slopes
      real(dp), intent(in) :: by_film(2)
      real(dp), intent(in) :: by_load(2)
      !> Number of the state
      real(dp), intent(inout) :: tangent(:)
      real(dp), dimension(rows, 2) :: gap, film, loads, kept
      real(dp), dimension(rows) :: yielded, rate, acceleration, once, twice, moved
      real(dp) :: right(most_rows), solution(most_rows), start(2), springs(2), teeth(2), width(2), more
      integer :: flank, first

      springs = 0.0_dp
      springs(:trial%flanks) = tangent(of_drive_compression:of_velocity + trial%flanks)
      start(1) = tangent(of_film)
      width(1) = by_film(1)*start(1) + by_load(1)*springs(1)
      start(2) = (sum(springs) - start(1) + width(1) + by_load(2)*springs(2))/(1.0_dp - by_film(2))
      width(2) = by_film(2)*start(2) + by_load(2)*springs(2)
      if (trial%damped) then
         ! Contacts stand compressed by what teeth are deflected by, and keep a part of that if no load is left.
         teeth = 0.0_dp
         teeth(:trial%flanks) = tangent(of_drive_compression + trial%flanks:of_velocity + 2*trial%flanks)
         more = sum(teeth - damped_share*springs)/(1.0_dp - by_film(2))
         start(2) = start(2) + more
         width(2) = width(2) + by_film(2)*more
         call weigh(trial%retards, spread(1.0_dp, 1, rows), moved)
         do flank = 1, trial%flanks
            kept(:, flank) = damped_share*springs(flank) - moved*teeth(flank)
         end do
      end if
      ! What the laws miss if no load changes
      right = 0.0_dp
      do flank = 1, trial%flanks
         gap(:, flank) = start(flank) - width(flank) - springs(flank) + sign_of(flank)*step*node_rows*tangent(of_velocity)
         if (trial%damped) gap(:, flank) = gap(:, flank) + kept(:, flank)
         film(:, flank) = gap(:, flank)
         yielded = -springs(flank)
         if (trial%damped) yielded = yielded + kept(:, flank)
         if (bends) then
            film(:, flank) = gap(:, flank)*(1.0_dp + trial%follows(:, flank))
            yielded = yielded + (trial%follows(:, flank)*gap(:, flank) - width(flank))
         end if
         call weigh(slope_rows, yielded, rate)
         first = rows*(flank - 1)
         right(first + 1:first + rows) = -(slopes%by_film(first + 1:first + rows)*film(:, flank) + &
                                           slopes%by_velocity(first + 1:first + rows)* &
                                           (sign_of(flank)*tangent(of_velocity) + rate/step))
         right(first + rows) = 0.0_dp
      end do
      call substitute(trial%flanks, factors, right, solution)
      loads = 0.0_dp
      do flank = 1, trial%flanks
         loads(:stages, flank) = solution(rows*(flank - 1) + 1:rows*flank - 1)
      end do
      acceleration = loads(:, 1) - loads(:, 2)
      call weigh(once_rows, acceleration, once)
      call weigh(twice_rows, acceleration, twice)
      tangent(of_film) = film(stages, 1) + step**2*twice(stages) + trial%compliance(stages, 1)*loads(stages, 1)
      if (bends) tangent(of_film) = tangent(of_film) + trial%follows(stages, 1)*step**2*twice(stages)
      if (trial%damped) then
         call weigh(trial%yields, loads(:, 1), moved)
         tangent(of_film) = tangent(of_film) + (1.0_dp + trial%follows(stages, 1))*moved(stages)
         do flank = 1, trial%flanks
            ! Without a load the tooth goes back; loads deflect it anew.
            moved = damped_share*compliance*loads(:, flank) - teeth(flank)
            call weigh(trial%retards, moved, yielded)
            tangent(of_velocity + trial%flanks + flank) = teeth(flank) + yielded(stages)
         end do
      end if
      tangent(of_velocity) = tangent(of_velocity) + step*once(stages)
      tangent(of_drive_compression:of_velocity + trial%flanks) = compliance*loads(stages, :trial%flanks)
   end subroutine carry

end module elastic_tangents
