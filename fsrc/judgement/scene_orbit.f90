!> The periodic motion that a scene ends on.
module scene_orbit
   use carried_loads, only: counts_as, thinnest_film
   use engine, only: ending_t, motion_state_t, request_t
   use kinds, only: dp
   use known_motions, only: are_near, distance_of, known_motions_t, near_states
   use many_motions, only: solve_motions
   use periodic_orbit, only: attracting_period, find_periodic_orbit, longest_period, longest_settled, map_states, orbit_of_period, &
      periodic_orbit_t
   use problem, only: problem_t
   use scene_status, only: status_complete
   use text_output, only: lock_texts, unlock_texts
   implicit none(type, external)
   private

   !> A periodic motion farther away than this is not that of the scene [-].
   real(dp), parameter, public :: orbit_nearness = 0.02_dp
   !> How far from the end of a motion that settles slowly the one may be that it comes to, relative to the film [-], and the longest
   !> period of one that is farther away [periods of the force]
   real(dp), parameter :: ahead_nearness = 2.0_dp
   integer, parameter :: longest_ahead = 3
   !> It is followed on with this accuracy, for so many parts of so many periods, and its distance falls at least to this share [-].
   real(dp), parameter :: ahead_accuracy = 1.0e-6_dp, least_fall = 0.7_dp
   integer, parameter :: parts = 6, part_periods = 10
   !> How close a motion has to come to where it was for a periodic one to be next to it, relative to the film [-]
   real(dp), parameter :: close_return = 0.005_dp
   !> How much nearer than after a short period a motion has to come after a long one [-]
   real(dp), parameter :: long_share = 0.1_dp
   !> Accuracy with which a periodic motion is followed through its periods [-]
   real(dp), parameter :: accuracy = 1.0e-10_dp

   public :: nearby_orbit, long_orbit, orbit_of, orbit_ahead

contains

   !> The periodic motion at the end of a run, if there is one.
   type(periodic_orbit_t) function nearby_orbit(problem, ending)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Where its motion ended
      class(motion_state_t), intent(in) :: ending

      call unlock_texts()
      nearby_orbit = find_periodic_orbit(problem, ending%numbers, orbit_nearness)
      call lock_texts()
   end function nearby_orbit

   !> The periodic motion at the end of one that settles, if it has a long period: if it comes far nearer to where it was after one.
   type(periodic_orbit_t) function long_orbit(problem, ending) result(orbit)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Where its motion ended
      class(motion_state_t), intent(in) :: ending
      real(dp) :: distances(longest_settled), scale(size(ending%numbers)), states(size(ending%numbers), 1)
      integer :: period
      logical :: mapped

      scale = counts_as(problem, ending%numbers)/thinnest_film(problem, ending%numbers)
      states(:, 1) = ending%numbers
      call unlock_texts()
      do period = 1, longest_settled
         call map_states(problem, 1, ahead_accuracy, states, mapped)
         if (.not. mapped) exit
         distances(period) = maxval(abs(states(:, 1) - ending%numbers)*scale)
      end do
      if (mapped) then
         period = longest_period + minloc(distances(longest_period + 1:), dim=1)
         if (distances(period) < min(orbit_nearness, long_share*minval(distances(:longest_period)))) &
            orbit = orbit_of_period(problem, period, ending%numbers, orbit_nearness)
      end if
      call lock_texts()
   end function long_orbit

   !> The stable periodic motion that one which settles slowly comes to, or none. It is followed on: where it comes back to where it was,
   !> a periodic motion may be next to it. Else Newton's method may lead to one from its end, however far that is, since next to an
   !> impact the film is a hundredth of what a state may be off; and followed on it nears that motion.
   type(periodic_orbit_t) function orbit_ahead(problem, ending, from_far) result(orbit)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Where its motion ended
      class(motion_state_t), intent(in) :: ending
      !> Whether a motion that is far from its end is looked for
      logical, intent(in) :: from_far
      type(ending_t) :: endings(1)
      real(dp) :: states(parts*part_periods, size(ending%numbers), 1)

      call unlock_texts()
      call solve_motions([problem], [motion_state_t(numbers=ending%numbers)], &
                         request_t(accuracy=ahead_accuracy, periods=size(states, 1), samples_per_period=1, &
                                   sampled_periods=size(states, 1)), states, endings)
      if (endings(1)%status == status_complete) then
         orbit = orbit_of_return(problem, states(:, :, 1))
         if (orbit%period == 0 .and. from_far) then
            orbit = find_periodic_orbit(problem, ending%numbers, ahead_nearness)
            if (attracting_period(orbit) == 0) orbit = find_periodic_orbit(problem, ending%numbers, huge(1.0_dp), longest_ahead)
            if (.not. comes_to(problem, states(:, :, 1), orbit)) orbit = periodic_orbit_t()
         end if
      end if
      call lock_texts()
   end function orbit_ahead

   !> The stable periodic motion next to the state from which a motion comes closest to where it is some periods later, or none.
   type(periodic_orbit_t) function orbit_of_return(problem, states) result(orbit)
      type(problem_t), intent(in) :: problem
      !> End of a period, number of the state
      real(dp), intent(in) :: states(:, :)
      real(dp) :: distance, nearest, scale(size(states, 2))
      integer :: i, period, after, place

      nearest = close_return
      after = 0
      place = 0
      do i = 1, size(states, 1)
         scale = counts_as(problem, states(i, :))/thinnest_film(problem, states(i, :))
         do period = 1, min(longest_settled, size(states, 1) - i)
            distance = maxval(abs(states(i + period, :) - states(i, :))*scale)
            if (distance >= merge(1.0_dp, long_share, period <= longest_period)*nearest) cycle
            nearest = distance
            after = period
            place = i
         end do
      end do
      if (after > longest_period) then
         orbit = orbit_of_period(problem, after, states(place, :), orbit_nearness)
      else if (after > 0) then
         orbit = find_periodic_orbit(problem, states(place, :), orbit_nearness)
      end if
      if (attracting_period(orbit) == 0) orbit = periodic_orbit_t()
   end function orbit_of_return

   !> Whether a motion nears a periodic one all the time: the largest distances of its successive parts fall.
   logical function comes_to(problem, states, orbit)
      type(problem_t), intent(in) :: problem
      !> End of a period, number of the state
      real(dp), intent(in) :: states(:, :)
      !> Stable, or none
      type(periodic_orbit_t), intent(in) :: orbit
      type(known_motions_t) :: measure
      real(dp) :: on_orbit(size(states, 2), 1), distances(size(states, 1)), farthest(parts)
      integer :: period, i
      logical :: mapped

      comes_to = .false.
      if (attracting_period(orbit) == 0) return
      measure = near_states(problem)
      distances = huge(1.0_dp)
      on_orbit(:, 1) = orbit%state
      do period = 1, orbit%period
         do i = 1, size(distances)
            distances(i) = min(distances(i), distance_of(problem, measure, states(i, :), on_orbit(:, 1)))
         end do
         call map_states(problem, 1, ahead_accuracy, on_orbit, mapped)
         if (.not. mapped) return
      end do
      farthest = maxval(reshape(distances, [part_periods, parts]), dim=1)
      comes_to = all(farthest(2:) <= max(1.0_dp, farthest(:parts - 1))) .and. &
                 farthest(parts) <= max(1.0_dp, least_fall*farthest(1))
   end function comes_to

   !> The periodic motion that a scene ends on: that of its tighter solution, which is nearer to it, unless this has come to another
   !> motion of the scene.
   type(periodic_orbit_t) function orbit_of(problem, own, tight) result(orbit)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> How the scene ended
      type(ending_t), intent(in) :: own
      !> Periodic motion of its tighter solution, or none
      type(periodic_orbit_t), intent(in) :: tight
      real(dp) :: states(size(own%numbers), 1)
      integer :: period
      logical :: mapped

      orbit = tight
      if (tight%period > 0) states(:, 1) = tight%state
      do period = 1, tight%period
         if (are_near(problem, near_states(problem), states(:, 1), own%numbers)) return
         call unlock_texts()
         call map_states(problem, 1, accuracy, states, mapped)
         call lock_texts()
      end do
      if (tight%period > 0) orbit = nearby_orbit(problem, own)
   end function orbit_of

end module scene_orbit
