!> Which classes of a group of scenes stand: all of them solved again, tighter and side by side, and every window held against the
!> tighter one by the verification of the single scene.
!>
!> A single scene that is solved until it is steady is held against the same periods from its start. In a campaign both solutions go
!> on until the motion repeats, the tighter one within its own accuracy, and their forecasts may save different periods: the
!> orbits are held against each other, beginning with whichever of their periods fits best.
!>
!> Two solutions of an irregular motion part whatever their digits. It is followed behind its window (module motion_behind), and the
!> tighter solution is that of a window there.
module campaign_verification
   use doubt, only: doubt_samples, doubt_t, first_doubt, is_doubted
   use motion_behind, only: follow_behind
   use verification, only: verification_t, compare_windows, doubt_of_windows
   use verify_scene, only: nearby_orbit, tighten
   use engine, only: motion_state_t, request_t, start_of
   use errors, only: error_t
   use kinds, only: dp
   use node_extremes, only: seen_acceleration, seen_films, seen_loads, seen_net_load, seen_quantities
   use periodic_orbit, only: attracting_period
   use carried_loads, only: films_of
   use problem, only: of_film, problem_t
   use rattle_class, only: class_irregular, class_irregular_so_far, note_known, note_orbit
   use resolved_scene, only: resolved_scene_t
   use scene_group, only: classify_group, scene_group_t, solve_group
   use scene_status, only: is_success, status_steady
   use scene_types, only: method_taylor, spectrum_choice_t
   use signals, only: must_stop
   use window_extremes, only: extremes_of_record
   use window_impacts, only: agreement_of, impact_agreement_t, impacts_of_record
   implicit none(type, external)
   private

   !> Extremes that windows are compared by
   integer, parameter, public :: compared(3) = [seen_films, seen_acceleration]

   public :: verify_group

contains

   !> Whether the classes of a group stand. After a signal to stop the answer is of no use.
   subroutine verify_group(resolved, choices, request, group, tight, stands, agree)
      !> What follows from the scenes, and the limits of their classes
      type(resolved_scene_t), intent(in) :: resolved(:)
      type(spectrum_choice_t), intent(in) :: choices(:)
      !> What was asked of the engine
      type(request_t), intent(in) :: request
      !> The scenes with their classes
      type(scene_group_t), intent(in) :: group
      !> Work space: the tighter solutions
      type(scene_group_t), intent(inout) :: tight
      logical, intent(out) :: stands(:)
      !> Whether impacts are the same, where they are asked for
      type(impact_agreement_t), intent(out), optional :: agree(:)
      type(request_t) :: tighter
      type(motion_state_t) :: starts(size(resolved))
      type(doubt_t) :: doubts(size(resolved))
      integer, allocatable :: tested(:)
      logical :: wants(seen_quantities)
      real(dp) :: noise(size(resolved))
      integer :: i, k

      stands = .false.
      ! The class of what is irregular only so far cannot stand: its impacts alone are worth a tighter solution.
      associate (n => size(resolved))
         tested = pack([(i, i=1, n)], is_success(group%endings(:n)%status) .and. &
                       (present(agree) .or. group%verdicts(:n)%class /= class_irregular_so_far))
      end associate
      if (size(tested) == 0) return
      tighter = request
      starts = start_of(resolved%problem)
      call tighten(method_taylor, request%accuracy, tighter%accuracy, starts(1)%implicit)
      call start_behind(resolved, choices, request, group, pack(tested, group%verdicts(tested)%class == class_irregular), starts, &
                        doubts, tight%error)
      if (must_stop() .or. allocated(tight%error)) return
      starts%implicit = starts%implicit .or. starts(1)%implicit
      noise = resolved%noise_floor_at(tighter%accuracy)
      wants = .false.
      wants(compared) = .true.
      if (present(agree)) then
         wants([seen_loads(1), seen_net_load]) = .true.
         call solve_group(resolved(tested)%problem, starts(tested), tighter, wants, tight, choices(tested)%impact_limit)
      else
         call solve_group(resolved(tested)%problem, starts(tested), tighter, wants, tight)
      end if
      call classify_group(resolved(tested)%problem, choices(tested), noise(tested), tighter, tight)
      if (allocated(tight%error)) return
      do k = 1, size(tested)
         if (must_stop()) return
         i = tested(k)
         if (.not. is_success(tight%endings(k)%status)) cycle
         if (group%verdicts(i)%class == class_irregular .and. tight%verdicts(k)%class == class_irregular_so_far) &
            call note_orbit(tight%verdicts(k), attracting_period(nearby_orbit(resolved(i)%problem, tight%endings(k))))
         call note_known(tight%verdicts(k), group%verdicts(i))
         if (present(agree)) &
            agree(i) = agreement_of(resolved(i)%problem, extremes_of_record(group%records(i)), &
                                    impacts_of_record(group%records(i), resolved(i)%problem%frequency), &
                                    extremes_of_record(tight%records(k)), &
                                    impacts_of_record(tight%records(k), resolved(i)%problem%frequency))
         stands(i) = class_stands(resolved(i), choices(i), tighter, i, k, noise(i), doubts(i), group, tight)
      end do
   end subroutine verify_group

   !> Starts of the tighter solutions of irregular motions: behind their windows, and where their last periods are sampled.
   subroutine start_behind(resolved, choices, request, group, irregular, starts, doubts, error)
      type(resolved_scene_t), intent(in) :: resolved(:)
      type(spectrum_choice_t), intent(in) :: choices(:)
      !> What was asked of the engine
      type(request_t), intent(in) :: request
      type(scene_group_t), intent(in) :: group
      !> Places of the irregular motions
      integer, intent(in) :: irregular(:)
      !> Those of the others stay
      type(motion_state_t), intent(inout) :: starts(:)
      !> None where a motion stays irregular, nor for the others
      type(doubt_t), intent(out) :: doubts(:)
      !> Set if there is no memory for the samples that a class needs
      type(error_t), allocatable, intent(out) :: error
      type(motion_state_t) :: behind(size(irregular))
      type(doubt_t) :: found(size(irregular))

      behind = group%endings(irregular)%motion_state_t
      call follow_behind(resolved(irregular), choices(irregular), request%sampled_periods, request%samples_per_period, behind, &
                         found, error)
      behind%periods = request%periods - request%sampled_periods
      starts(irregular) = behind
      doubts(irregular) = found
   end subroutine start_behind

   !> Whether the class of a scene stands as far as its window tells.
   logical function class_stands(resolved, choice, tighter, place, tight_place, tight_noise, behind, group, tight)
      type(resolved_scene_t), intent(in) :: resolved
      type(spectrum_choice_t), intent(in) :: choice
      !> What was asked of the tighter solution
      type(request_t), intent(in) :: tighter
      !> Of the scene in its group, and in the tighter one
      integer, intent(in) :: place
      integer, intent(in) :: tight_place
      !> Acceleration that the errors of the tighter solution explain [m/s2]
      real(dp), intent(in) :: tight_noise
      !> Doubt behind the window, or none
      type(doubt_t), intent(in) :: behind
      type(scene_group_t), intent(in) :: group
      type(scene_group_t), intent(in) :: tight
      type(verification_t) :: verification
      type(doubt_t) :: unclosed, too_few_samples
      integer, allocatable :: same(:)

      associate (record => group%records(place), tight_record => tight%records(tight_place), verdict => group%verdicts(place), &
                 tight_verdict => tight%verdicts(tight_place), problem => resolved%problem, &
                 samples => group%endings(place)%samples, tight_samples => tight%endings(tight_place)%samples)
         too_few_samples = doubt_t()
         if (.not. (verdict%spectrum%sampling_sufficient .and. tight_verdict%spectrum%sampling_sufficient)) &
            too_few_samples = doubt_t(doubt_samples)
         unclosed = doubt_of_windows(problem, record, tight_record, resolved%noise_floor, tight_noise, verdict, tight_verdict, &
                                     too_few_samples, samples/tighter%samples_per_period, tight%endings(tight_place)%numbers, &
                                     choice%verification_tolerance)
         class_stands = .not. is_doubted(first_doubt([unclosed, behind]))
         if (.not. class_stands) return
         same = same_phase(group%states(:samples, of_film, place), tight%states(:tight_samples, of_film, tight_place), &
                           tighter%samples_per_period, &
                           group%endings(place)%status == status_steady .or. tight%endings(tight_place)%status == status_steady)
         call compare_windows(films_of(problem, group%states(:samples, :, place)), &
                              films_of(problem, tight%states(same, :, tight_place)), extremes_of_record(record), &
                              extremes_of_record(tight_record), verdict, tight_verdict, unclosed, choice, &
                              choice%verification_tolerance, tighter%accuracy, tight_noise, verification)
         class_stands = verification%verified
      end associate
   end function class_stands

   !> Which samples of the tighter solution stand at the times of those of the scene.
   pure function same_phase(films, tight_films, samples_per_period, repeat) result(same)
      !> Films of both windows [m]
      real(dp), intent(in) :: films(:)
      real(dp), intent(in) :: tight_films(:)
      integer, intent(in) :: samples_per_period
      !> Whether one of the motions repeats: then its window begins with any period of its orbit
      logical, intent(in) :: repeat
      integer :: same(size(films)), shifted(size(films)), shift, i
      real(dp) :: nearest, distance

      nearest = huge(1.0_dp)
      do shift = 0, merge(size(tight_films)/samples_per_period - 1, 0, repeat)
         shifted = [(modulo(i - 1 + shift*samples_per_period, size(tight_films)) + 1, i=1, size(films))]
         distance = maxval(abs(films - tight_films(shifted)))
         if (shift > 0 .and. .not. distance < nearest) cycle
         nearest = distance
         same = shifted
      end do
   end function same_phase

end module campaign_verification
