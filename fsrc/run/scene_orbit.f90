!> The periodic motion that a scene ends on.
module scene_orbit
   use engine, only: ending_t, motion_state_t
   use kinds, only: dp
   use known_motions, only: are_near
   use periodic_orbit, only: attracting_period, find_periodic_orbit, map_states, periodic_orbit_t
   use problem, only: problem_t
   use settled_motion, only: near_states
   use text_output, only: lock_texts, unlock_texts
   implicit none(type, external)
   private

   !> A periodic motion farther away than this is not that of the scene [-].
   real(dp), parameter, public :: orbit_nearness = 0.02_dp
   !> Longest period of a motion that one which settles slowly is led to [periods of the force]
   integer, parameter :: longest_ahead = 3
   !> Accuracy with which a periodic motion is followed through its periods [-]
   real(dp), parameter :: accuracy = 1.0e-10_dp

   public :: nearby_orbit, orbit_of, orbit_ahead

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

   !> The stable periodic motion of a short period that Newton's method leads to from the end of a motion which settles slowly, or
   !> none. How far that is away says nothing: next to an impact the film is a hundredth of what a state may be off.
   type(periodic_orbit_t) function orbit_ahead(problem, ending) result(orbit)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Where its motion ended
      class(motion_state_t), intent(in) :: ending

      call unlock_texts()
      orbit = find_periodic_orbit(problem, ending%numbers, huge(1.0_dp), longest_ahead)
      call lock_texts()
      if (attracting_period(orbit) == 0) orbit = periodic_orbit_t()
   end function orbit_ahead

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
