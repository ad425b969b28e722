!> How far the classes of some scenes, or of a single one, stand: all of them solved again, tighter and side by side, and every window
!> held against the tighter one.
!>
!> A scene that is solved for a number of periods is held against the same periods. Where both solutions go on until the motion
!> repeats, the tighter one within its own accuracy, their forecasts may save different periods: the orbits are held against each
!> other, beginning with whichever of their periods fits best.
!>
!> Two solutions of an irregular motion part whatever their digits. Another one is followed behind its window (module motion_behind), and
!> the tighter one is that of a window there.
module group_verification
   use carried_loads, only: films_of
   use doubt, only: doubt_samples, doubt_t, doubt_second_ending, first_doubt, is_doubted
   use engine, only: motion_state_t, request_t, start_of
   use kinds, only: dp
   use motion_behind, only: follow_behind, other_accuracy
   use node_extremes, only: seen_acceleration, seen_films, seen_loads, seen_net_load, seen_quantities
   use periodic_orbit, only: attracting_period, periodic_orbit_t
   use problem, only: of_film
   use rattle_class, only: class_irregular, class_irregular_so_far, class_subharmonic, note_known, note_orbit, rattle_verdict_t
   use prepared_scene, only: resolved_scene_t
   use scene_group, only: classify_group, scene_group_t, solve_group
   use scene_orbit, only: nearby_orbit
   use scene_status, only: is_success, status_steady
   use scene_types, only: method_newmark, method_taylor, spectrum_choice_t
   use signals, only: must_stop
   use text_output, only: lock_texts, unlock_texts
   use verification, only: compare_windows, doubt_of_return, doubt_of_windows, films_of_ends, no_verification, verification_t
   use window_extremes, only: extremes_of_record
   use window_impacts, only: agreement_of, impacts_of_record, window_impacts_t
   implicit none(type, external)
   private

   !> Accuracy of the tighter solution: this, or a hundredth of the scene's own.
   real(dp), parameter :: tight_accuracy = 1.0e-10_dp, tightest_accuracy = 1.0e-12_dp
   !> Extremes that windows are compared by
   integer, parameter, public :: compared(3) = [seen_films, seen_acceleration]

   public :: verify_group, tighten

contains

   !> Verify a group. After a signal to stop, and where the tighter solutions have an error, the answer is of no use.
   subroutine verify_group(resolved, choices, method, request, group, tight, verifications, impacts, orbits)
      !> What follows from the scenes, and the limits of their classes
      type(resolved_scene_t), intent(in) :: resolved(:)
      type(spectrum_choice_t), intent(in) :: choices(:)
      !> Code of the method that they were solved by, and what was asked of the engine
      integer, intent(in) :: method
      type(request_t), intent(in) :: request
      !> The scenes with their classes
      type(scene_group_t), intent(in) :: group
      !> Work space: the tighter solutions of the scenes that are worth one; with impacts, of all
      type(scene_group_t), intent(inout) :: tight
      type(verification_t), intent(out) :: verifications(:)
      !> Impacts of the scenes, where these are to be verified
      type(window_impacts_t), intent(in), optional :: impacts(:)
      !> Periodic motions at the ends of the tighter solutions, where they are asked for
      type(periodic_orbit_t), intent(out), optional :: orbits(:)
      type(request_t) :: tighter
      type(periodic_orbit_t) :: orbit
      type(motion_state_t) :: starts(size(resolved))
      type(doubt_t) :: doubts(size(resolved))
      integer, allocatable :: tested(:), irregular(:)
      real(dp), allocatable :: impact_limits(:)
      logical :: wants(seen_quantities), implicit
      real(dp) :: noise(size(resolved))
      integer :: i, k

      ! The class of what is irregular only so far cannot stand: its impacts alone are worth a tighter solution.
      associate (n => size(resolved))
         tested = pack([(i, i=1, n)], is_success(group%endings(:n)%status) .and. &
                       (present(impacts) .or. group%verdicts(:n)%class /= class_irregular_so_far))
      end associate
      if (size(tested) == 0) return
      tighter = request
      starts = start_of(resolved%problem)
      call tighten(method, request%accuracy, tighter%accuracy, implicit)
      starts%implicit = implicit
      irregular = pack(tested, group%verdicts(tested)%class == class_irregular)
      call go_behind(irregular)
      if (allocated(tight%error)) return
      noise = resolved%noise_floor_at(tighter%accuracy)
      wants = .false.
      wants(compared) = .true.
      if (present(impacts)) then
         wants([seen_loads(1), seen_net_load]) = .true.
         impact_limits = choices(tested)%impact_limit
      end if
      call unlock_texts()
      call solve_group(resolved(tested)%problem, starts(tested), tighter, wants, tight, impact_limits)
      call classify_group(resolved(tested)%problem, choices(tested), noise(tested), tighter, tight)
      call lock_texts()
      if (allocated(tight%error)) return
      do k = 1, size(tested)
         i = tested(k)
         if (.not. is_success(tight%endings(k)%status)) then
            verifications(i) = no_verification(doubt_t(doubt_second_ending, counts=[tight%endings(k)%status, 0]))
            cycle
         end if
         if (must_stop()) return
         associate (problem => resolved(i)%problem, verdict => group%verdicts(i), tight_verdict => tight%verdicts(k))
            if (present(orbits) .or. &
                verdict%class == class_irregular .and. tight_verdict%class == class_irregular_so_far) then
               orbit = nearby_orbit(problem, tight%endings(k))
               call note_orbit(tight_verdict, attracting_period(orbit))
               if (present(orbits)) orbits(i) = orbit
            end if
            call note_known(tight_verdict, verdict)
            call compare(resolved(i), choices(i), method, tighter, i, k, noise(i), doubts(i), group, tight, verifications(i))
            if (present(impacts)) verifications(i)%impacts = &
               agreement_of(problem, extremes_of_record(group%records(i)), impacts(i), extremes_of_record(tight%records(k)), &
                            impacts_of_record(tight%records(k), problem%frequency), &
                            is_part(resolved(i), choices(i), group, i, tight, k, request%samples_per_period))
         end associate
      end do

   contains

      !> See that motions, solved again, stay irregular behind their windows, and start the tighter solutions there, where their last
      !> periods are sampled.
      subroutine go_behind(places)
         !> Of the motions
         integer, intent(in) :: places(:)
         type(motion_state_t) :: behind(size(places))
         type(doubt_t) :: found(size(places))

         behind = start_of(resolved(places)%problem)
         call unlock_texts()
         call follow_behind(resolved(places), choices(places), other_accuracy(request%accuracy), &
                            request%periods - request%sampled_periods, request%sampled_periods, request%samples_per_period, &
                            behind, found, tight%error)
         call lock_texts()
         behind%implicit = behind%implicit .or. implicit
         behind%periods = request%periods - request%sampled_periods
         starts(places) = behind
         doubts(places) = found
      end subroutine go_behind

   end subroutine verify_group

   !> How a scene is solved tighter.
   pure subroutine tighten(method, own_accuracy, accuracy, by_collocation)
      !> Code of its method
      integer, intent(in) :: method
      !> Relative accuracy that it was solved with [-]
      real(dp), intent(in) :: own_accuracy
      !> Relative accuracy of the tighter solution [-]
      real(dp), intent(out) :: accuracy
      !> Whether by the implicit method, whatever the film law
      logical, intent(out) :: by_collocation

      accuracy = tight_accuracy
      by_collocation = .false.
      if (method /= method_taylor) return
      accuracy = min(accuracy, max(tightest_accuracy, 0.01_dp*own_accuracy))
      ! Where there is no room for a tighter solution, another method tells the errors.
      by_collocation = accuracy > 0.05_dp*own_accuracy
   end subroutine tighten

   !> Hold the window of a scene against that of its tighter solution.
   subroutine compare(resolved, choice, method, tighter, place, tight_place, tight_noise, behind, group, tight, verification)
      type(resolved_scene_t), intent(in) :: resolved
      type(spectrum_choice_t), intent(in) :: choice
      !> Code of the method of the scene, and what was asked of the tighter solution
      integer, intent(in) :: method
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
      type(verification_t), intent(out) :: verification
      type(doubt_t) :: unclosed
      integer, allocatable :: same(:)

      associate (record => group%records(place), tight_record => tight%records(tight_place), verdict => group%verdicts(place), &
                 tight_verdict => tight%verdicts(tight_place), problem => resolved%problem, &
                 samples => group%endings(place)%samples, tight_samples => tight%endings(tight_place)%samples)
         ! That another solution settles says more than where this one went.
         unclosed = first_doubt([behind, &
                                 doubt_of_windows(problem, record, tight_record, resolved%noise_floor, tight_noise, verdict, &
                                                  tight_verdict, &
                                                  doubt_of_samples(method, tighter%samples_per_period, verdict, tight_verdict, &
                                                                   tight%classified_by(tight_place)), &
                                                  samples/tighter%samples_per_period, tight%endings(tight_place)%numbers, &
                                                  choice%verification_tolerance)])
         same = same_phase(group%states(:samples, of_film, place), tight%states(:tight_samples, of_film, tight_place), &
                           tighter%samples_per_period, &
                           group%endings(place)%status == status_steady .or. tight%endings(tight_place)%status == status_steady)
         call compare_windows(films_of(problem, group%states(:samples, :, place)), &
                              films_of(problem, tight%states(same, :, tight_place)), extremes_of_record(record), &
                              extremes_of_record(tight_record), verdict, tight_verdict, unclosed, choice, &
                              choice%verification_tolerance, tighter%accuracy, tight_noise, verification)
      end associate
   end subroutine compare

   !> Whether a window is but a part of its motion.
   pure logical function is_part(resolved, choice, group, place, tight, tight_place, samples_per_period)
      type(resolved_scene_t), intent(in) :: resolved
      type(spectrum_choice_t), intent(in) :: choice
      !> The scene in its group, and its tighter solution
      type(scene_group_t), intent(in) :: group
      integer, intent(in) :: place
      type(scene_group_t), intent(in) :: tight
      integer, intent(in) :: tight_place
      integer, intent(in) :: samples_per_period
      integer :: periods

      periods = group%endings(place)%samples/samples_per_period
      is_part = group%verdicts(place)%class == class_subharmonic .and. group%repeat_after(place) > periods
      if (is_part) return
      is_part = is_doubted(doubt_of_return(group%verdicts(place), periods, &
                                           films_of_ends(resolved%problem, tight%records(tight_place), &
                                                         tight%endings(tight_place)%numbers), choice%verification_tolerance))
   end function is_part

   !> Whether the samples are too few, and how many would do.
   pure type(doubt_t) function doubt_of_samples(method, samples_per_period, verdict, tight_verdict, classified_by) result(doubt)
      !> Code of the method of the scene, and samples of a period
      integer, intent(in) :: method
      integer, intent(in) :: samples_per_period
      !> Verdicts on the scene and on its tighter solution
      type(rattle_verdict_t), intent(in) :: verdict
      type(rattle_verdict_t), intent(in) :: tight_verdict
      !> Samples of a period that the latter is from
      integer, intent(in) :: classified_by
      logical :: would_do

      doubt = doubt_t()
      if (verdict%spectrum%sampling_sufficient .and. tight_verdict%spectrum%sampling_sufficient) return
      would_do = tight_verdict%spectrum%sampling_sufficient .and. classified_by > samples_per_period
      doubt = doubt_t(doubt_samples, counts=[merge(classified_by, 0, would_do), merge(1, 0, method == method_newmark)])
   end function doubt_of_samples

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

end module group_verification
