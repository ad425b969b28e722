!> The state in which a motion starts, and what contacts keep of one while keys of its problem change.
module starting_state
   use film_law, only: overflow_load, width_compression
   use film_state, only: load_t
   use flank_contact, only: inner_at_rest, load_at_rest
   use kinds, only: dp
   use problem, only: compression_count, contact_count, deflection_places, has_damped_teeth, has_elastic_teeth, has_inner_numbers, &
      has_two_flanks, inner_places, of_drive_compression, of_film, of_velocity, problem_t, state_size
   implicit none(type, external)
   private

   public :: initial_state, kept_by_contacts, keep_by_contacts

contains

   !> State in which the motion of a problem starts: films of a state of their own have stood still for long.
   pure function initial_state(problem) result(state)
      type(problem_t), intent(in) :: problem
      real(dp) :: state(state_size(problem))
      real(dp) :: compressions(2), gaps(2)
      integer :: places(2), flank

      state = 0.0_dp
      state(of_film) = problem%initial_film
      state(of_velocity) = problem%initial_velocity
      if (.not. has_inner_numbers(problem)) return
      if (.not. problem%initial_film > 0.0_dp) return
      gaps = [problem%initial_film, problem%backlash - problem%initial_film]
      if (has_elastic_teeth(problem)) then
         call start_springs(problem, compressions)
         state(of_drive_compression:of_velocity + contact_count(problem)) = compressions(:contact_count(problem))
         places = deflection_places(problem)
         if (has_damped_teeth(problem)) &
            state(places(1):places(2)) = problem%contact%damped_share*compressions(:contact_count(problem))
         gaps(2) = gaps(2) + sum(compressions)
      end if
      do flank = 1, contact_count(problem)
         places = inner_places(problem, flank)
         state(places(1):places(2)) = inner_at_rest(problem%contact, gaps(flank))
      end do
   end function initial_state

   !> What the contacts keep of a state while keys of its problem change: loads of the springs, those that deflect
   !> damped teeth as they stand [N], states of the films.
   pure function kept_by_contacts(problem, state) result(kept)
      type(problem_t), intent(in) :: problem
      !> Its numbers
      real(dp), intent(in) :: state(:)
      real(dp), allocatable :: kept(:)

      associate (springs => compression_count(problem))
         kept = [state(of_drive_compression:of_velocity + springs)/problem%contact%compliance, &
                 state(of_drive_compression + springs:)]
      end associate
      ! Of teeth that are not damped loads and deflections are the same.
      if (has_elastic_teeth(problem) .and. .not. has_damped_teeth(problem)) kept = [kept(:contact_count(problem)), kept]
   end function kept_by_contacts

   !> Put into a state what contacts have kept; springs that were none before are not compressed.
   pure subroutine keep_by_contacts(problem, kept, state)
      type(problem_t), intent(in) :: problem
      !> As of kept_by_contacts
      real(dp), intent(in) :: kept(:)
      !> Its numbers
      real(dp), intent(inout) :: state(:)
      integer :: first, n, springs

      first = 1
      if (has_elastic_teeth(problem) .and. .not. has_damped_teeth(problem)) first = min(size(kept), contact_count(problem)) + 1
      n = min(size(kept) - first + 1, size(state) - of_velocity)
      springs = compression_count(problem)
      state(of_drive_compression:of_velocity + springs) = 0.0_dp
      state(of_drive_compression:of_velocity + n) = kept(first:first + n - 1)
      n = of_velocity + min(n, springs)
      state(of_drive_compression:n) = problem%contact%compliance*state(of_drive_compression:n)
   end subroutine keep_by_contacts

   !> Compressions of the springs at the start: the drive film carries the first one at the velocity of the gear, the coast film,
   !> whose gap grows by both, the other.
   pure subroutine start_springs(problem, compression)
      type(problem_t), intent(in) :: problem
      !> d_1 and d_2 [m]
      real(dp), intent(out) :: compression(2)
      type(load_t) :: drive, coast
      real(dp) :: low, high, gap, space, wider, by_film, by_load
      integer :: pass
      integer, parameter :: most_passes = 200
      real(dp), parameter :: thinnest = 1.0e-16_dp

      compression = 0.0_dp
      drive = load_at_rest(problem%contact, problem%initial_film, problem%initial_velocity)
      if (.not. abs(drive%load) < overflow_load) return
      compression(1) = problem%contact%compliance*drive%load
      if (.not. has_two_flanks(problem)) return
      call width_compression(problem%contact%film, problem%initial_film, drive%load, wider, by_film, by_load)
      space = problem%backlash - problem%initial_film + compression(1) + wider
      ! The gap is what backlash and drive film leave, and what the spring of the coast flank gives: its load falls as it grows.
      low = max(space, thinnest)
      high = huge(1.0_dp)
      gap = low
      do pass = 1, most_passes
         coast = load_at_rest(problem%contact, gap, -problem%initial_velocity)
         call width_compression(problem%contact%film, gap, coast%load, wider, by_film, by_load)
         if (gap - problem%contact%compliance*coast%load - wider > space) then
            high = gap
         else
            low = gap
         end if
         if (high < huge(1.0_dp)) then
            if (.not. (0.5_dp*(low + high) > low .and. 0.5_dp*(low + high) < high)) exit
            gap = 0.5_dp*(low + high)
         else
            gap = 2.0_dp*gap
         end if
      end do
      coast = load_at_rest(problem%contact, gap, -problem%initial_velocity)
      compression(2) = problem%contact%compliance*coast%load
   end subroutine start_springs

end module starting_state
