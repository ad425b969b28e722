!> What becomes of motions that are off their harmonics: they repeat after several periods, they are irregular for good, or
!> nothing more is known of them than that they are irregular so far. One procedure for single scenes, sweeps and campaigns.
module irregular_motion
   use engine, only: ending_t
   use lyapunov, only: follow_neighbours, parting_t, path_t
   use periodic_orbit, only: attracting_period, periodic_orbit_t
   use problem, only: problem_t
   use rattle_class, only: class_irregular_so_far, note_orbit, note_parting, rattle_verdict_t
   use scene_orbit, only: nearby_orbit
   use scene_status, only: is_success
   use signals, only: must_stop
   use text_output, only: lock_texts, unlock_texts
   implicit none(type, external)
   private

   public :: follow_irregular

contains

   !> Look for a periodic motion at the ends of motions of which more has to be known, and follow those that are irregular still.
   !> After a signal to stop the answers are of no use.
   subroutine follow_irregular(problems, endings, verdicts, repeat_after, paths)
      !> What moves
      type(problem_t), intent(in) :: problems(:)
      !> How the motions ended
      type(ending_t), intent(in) :: endings(:)
      !> Verdicts on their windows
      type(rattle_verdict_t), intent(inout) :: verdicts(:)
      !> Periods after which motions near their ends repeat, 0 where none is known
      integer, intent(inout) :: repeat_after(:)
      !> Where those that prove to be irregular went
      type(path_t), intent(inout), optional :: paths(:)
      type(periodic_orbit_t) :: orbit
      type(parting_t), allocatable :: partings(:)
      type(path_t), allocatable :: passed(:)
      integer, allocatable :: left(:)
      integer :: i

      left = pack([(i, i=1, size(problems))], is_success(endings%status) .and. verdicts%class == class_irregular_so_far)
      do i = 1, size(left)
         if (must_stop()) return
         associate (place => left(i))
            orbit = nearby_orbit(problems(place), endings(place))
            call note_orbit(verdicts(place), attracting_period(orbit))
            if (orbit%period > 0) repeat_after(place) = orbit%period
         end associate
      end do
      left = pack(left, verdicts(left)%class == class_irregular_so_far)
      if (size(left) == 0) return
      allocate (partings(size(left)), passed(size(left)))
      call unlock_texts()
      call follow_neighbours(problems(left), endings(left)%motion_state_t, partings, passed)
      call lock_texts()
      do i = 1, size(left)
         call note_parting(verdicts(left(i)), partings(i))
         if (present(paths)) paths(left(i)) = passed(i)
      end do
   end subroutine follow_irregular

end module irregular_motion
