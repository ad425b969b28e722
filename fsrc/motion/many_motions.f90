!> Motions of any number of problems by the controlled engine: Taylor series for the film laws that have one, collocation
!> for all others and for motions too stiff for explicit steps.
module many_motions
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use engine, only: ending_t, motion_state_t, request_t
   use film_law, only: overflow_load
   use film_state, only: load_t
   use flank_contact, only: load_at_rest
   use film_series, only: has_series
   use force, only: largest_oscillation
   use kinds, only: dp
   use known_motions, only: known_motions_t
   use lane_block, only: lane_accuracy
   use lane_integration, only: integrate_lanes
   use carried_loads, only: net_load
   use problem, only: has_elastic_teeth, has_inner_numbers, moving_numbers, of_film, of_velocity, problem_t, same_kind, &
      state_size, static_load, thinner_film
   use repetition, only: orbit_watch_t
   use scene_status, only: status_film_lost, status_not_converged
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   public :: solve_motions, has_tangents

contains

   !> Solve all problems. Their order decides only which share a block: those of like cost should be neighbours, the longest first.
   subroutine solve_motions(problems, starts, request, states, endings, watches, records, known, displacements)
      !> What moves
      type(problem_t), intent(in) :: problems(:)
      !> Where each motion starts
      type(motion_state_t), intent(in) :: starts(:)
      !> What is requested
      type(request_t), intent(in) :: request
      !> Samples: sample, number of its state, problem; at least sampled_periods*samples_per_period of a problem
      real(dp), contiguous, intent(inout) :: states(:, :, :)
      !> How the motions ended
      type(ending_t), intent(out) :: endings(:)
      !> What a search for repetition that is carried on looks back on, problem by problem; without it every search begins anew
      type(orbit_watch_t), optional, intent(inout) :: watches(:)
      !> Records of the steps of the sampled periods, problem by problem; a motion that is carried on within them adds to its own
      type(window_record_t), optional, intent(inout) :: records(:)
      !> Periodic motions that are known, problem by problem: a run until steady that comes to one of them ends there
      type(known_motions_t), optional, intent(in) :: known(:)
      !> Small displacements of the starts, where all motions have tangents, and on return of their ends: number of the state,
      !> displacement, problem; each in its unit times any number. Allocatable, since gfortran 12 works out bounds of other arrays
      !> that are absent
      real(dp), optional, allocatable, intent(inout) :: displacements(:, :, :)
      type(request_t) :: every
      type(motion_state_t), allocatable :: rest(:)
      logical, allocatable :: explicit(:), left(:), alike(:)
      integer, allocatable :: number(:)
      integer :: i, first

      allocate (explicit(size(problems)), left(size(problems)), alike(size(problems)), number(size(problems)))
      number(:) = [(i, i=1, size(problems))]
      every = request
      ! A period that is skipped, since the motion returns to the last bit, would move no displacement.
      if (present(displacements)) every%every_period = .true.
      explicit(:) = goes_by_series(problems, starts, request%accuracy)
      left(:) = explicit
      do while (any(left))
         first = findloc(left, .true., dim=1)
         alike(:) = same_kind(problems, problems(first))
         call integrate_lanes(.true., problems, starts, pack(number, left .and. alike), every, states, endings, watches, &
                              records, known)
         left(:) = left .and. .not. alike
      end do

      left(:) = .not. explicit .or. endings%status == status_not_converged .or. endings%status == status_film_lost
      if (.not. any(left)) return
      allocate (rest, source=starts)
      do i = 1, size(problems)
         ! The rest of a motion that Taylor series could not finish.
         if (left(i) .and. explicit(i)) &
            rest(i) = motion_state_t(periods=endings(i)%periods, numbers=endings(i)%numbers, implicit=.true.)
      end do
      ! Contacts with numbers of their own are followed by steps of their own.
      do i = 0, 1
         alike(:) = left .and. (has_inner_numbers(problems) .eqv. i == 1)
         if (any(alike)) &
            call integrate_lanes(.false., problems, rest, pack(number, alike), every, states, endings, watches, records, known, &
                                 displacements)
      end do
   end subroutine solve_motions

   !> Whether a motion from some start is followed with its displacements: by implicit steps alone, on springs, with films that have
   !> no state of their own.
   elemental logical function has_tangents(problem, start, accuracy)
      type(problem_t), intent(in) :: problem
      !> Where it starts
      type(motion_state_t), intent(in) :: start
      !> Relative accuracy of the film [-]
      real(dp), intent(in) :: accuracy

      has_tangents = has_elastic_teeth(problem) .and. state_size(problem) == moving_numbers(problem) .and. &
                     .not. goes_by_series(problem, start, accuracy)
   end function has_tangents

   !> Whether a motion from some start is followed by a series, as far as this leads.
   elemental logical function goes_by_series(problem, start, accuracy)
      type(problem_t), intent(in) :: problem
      !> Where it starts
      type(motion_state_t), intent(in) :: start
      !> Relative accuracy of the film [-]
      real(dp), intent(in) :: accuracy

      goes_by_series = has_series(problem, lane_accuracy(problem, accuracy)) .and. .not. start%implicit .and. &
                       .not. outgrows_series(problem, start)
   end function goes_by_series

   !> Whether the coefficients of a series about the start of a motion, in powers of time in periods, would overflow.
   elemental logical function outgrows_series(problem, start)
      type(problem_t), intent(in) :: problem
      !> Where it starts
      type(motion_state_t), intent(in) :: start
      !> Growth from one coefficient to the next [-]; a step would be some 1e-8 of a period
      real(dp), parameter :: largest_growth = 1.0e8_dp
      !> What is thinner is no film, which is found at the first step [m]
      real(dp), parameter :: thinnest = 1.0e-30_dp
      !> Rate at which a stiff spring and its film come to rest that no series is to follow [1/periods]
      real(dp), parameter :: largest_rate = 1.0e4_dp
      type(load_t) :: load
      real(dp) :: film, velocity, force, rate, thinner

      outgrows_series = .false.
      ! A motion that is carried on goes on as it went; one that cannot start is not for this procedure to refuse.
      if (start%carried_on) return
      if (.not. all(ieee_is_finite(start%numbers))) return
      film = start%numbers(of_film)
      velocity = start%numbers(of_velocity)
      if (has_elastic_teeth(problem)) then
         if (.not. film > 0.0_dp) return
         load = load_at_rest(problem%contact, film, velocity)
         outgrows_series = .not. abs(load%by_velocity)*(problem%contact%compliance*problem%frequency*largest_rate) > 1.0_dp
         return
      end if
      thinner = thinner_film(problem, film)
      if (.not. thinner > thinnest) return
      call net_load(problem, film, velocity, load)
      if (.not. abs(load%load) < overflow_load) return
      force = load%load + abs(static_load(problem)) + largest_oscillation(problem%force)
      rate = largest_growth*problem%frequency
      outgrows_series = abs(velocity) > rate*thinner .or. &
                        abs(load%by_velocity) > rate*problem%mass .or. abs(load%by_film) > rate**2*problem%mass .or. &
                        force > rate**2*problem%mass*thinner
   end function outgrows_series

end module many_motions
