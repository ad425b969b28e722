!> How far the classes and impacts of some scenes, or of a single one, stand: all of them solved again, tighter and side by side, and
!> every window compared with the tighter one.
!>
!> A scene that is solved for a number of periods is compared with the same periods. Where both solutions go on until the motion
!> repeats, the tighter one within its own accuracy, their forecasts may save different periods: the orbits are compared with each
!> other, beginning with whichever of their periods fits best.
!>
!> Two solutions of an irregular motion part whatever their digits. It is verified by the periods that it was followed beside a
!> neighbour, without a second solution.
module verify_group
   use carried_loads, only: films_of
   use classify_group, only: classify_windows, complete_windows
   use doubt, only: doubt_samples, doubt_second_ending, doubt_t, is_doubted
   use engine, only: motion_state_t, start_of
   use errors, only: error_t
   use kinds, only: dp
   use node_extremes, only: seen_acceleration, seen_films, seen_loads, seen_net_load, seen_quantities
   use periodic_orbit, only: attracting_period, periodic_orbit_t
   use prepared_scene, only: prepared_scene_t, with_accuracy
   use problem, only: of_film
   use rattle_class, only: class_irregular, class_irregular_so_far, class_subharmonic, note_known, note_orbit, rattle_verdict_t
   use scene_group, only: goes_beyond, judged_record, scene_group_t, solve_group
   use scene_orbit, only: nearby_orbit, orbit_of
   use scene_status, only: is_success, status_steady
   use scene_types, only: method_newmark, method_taylor
   use signals, only: must_stop
   use verification, only: compare_windows, doubt_of_return, doubt_of_windows, films_of_ends, irregular_verification, &
      no_verification, note_impact_errors, note_severity_errors, verification_t
   use vibration_severity, only: severity_of_record, vibration_severity_t
   use window_extremes, only: extremes_of_record
   use window_impacts, only: agreement_of, impacts_of_record, window_impacts_t
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Accuracy of the tighter solution: this, or a hundredth of the scene's own.
   real(dp), parameter :: tight_accuracy = 1.0e-10_dp, tightest_accuracy = 1.0e-12_dp
   !> Extremes that windows are compared by
   integer, parameter, public :: compared(3) = [seen_films, seen_acceleration]

   !> What the scenes are verified by besides their windows.
   type, public :: verified_windows_t
      !> Severity of the scenes, and their impacts, where these are to be verified
      type(vibration_severity_t), allocatable :: severities(:)
      type(window_impacts_t), allocatable :: impacts(:)
      !> Whether the periodic motions are asked for that the scenes end on
      logical :: with_orbits = .false.
   end type verified_windows_t

   public :: verify_windows

contains

   !> Verify a group. After a signal to stop, and where the tighter solutions have an error, the answer is of no use.
   subroutine verify_windows(scenes, windows, group, tight, verifications, error)
      type(prepared_scene_t), intent(in) :: scenes(:)
      type(verified_windows_t), intent(in) :: windows
      !> The scenes with their classes; the periodic motions that they end on are added, where they are asked for
      type(scene_group_t), intent(inout) :: group
      !> Work space: the tighter solutions of the scenes that are worth one; with impacts, of all
      type(scene_group_t), intent(inout) :: tight
      type(verification_t), intent(out) :: verifications(:)
      !> Set if there is no memory for the samples that a class needs
      type(error_t), allocatable, intent(out) :: error
      type(prepared_scene_t), allocatable :: tighter(:)
      type(motion_state_t) :: starts(size(scenes))
      integer, allocatable :: tested(:)
      logical :: wants(seen_quantities), is_tested(size(scenes))
      integer :: i, k

      ! The class of what is irregular only so far cannot stand: its impacts alone are worth a tighter solution.
      is_tested = is_success(group%endings(:size(scenes))%status)
      if (.not. allocated(windows%impacts)) &
         is_tested = is_tested .and. group%verdicts(:size(scenes))%class /= class_irregular_so_far
      do i = 1, size(scenes)
         if (.not. is_tested(i) .or. group%verdicts(i)%class /= class_irregular) cycle
         is_tested(i) = .false.
         verifications(i) = irregular_verification(scenes(i)%resolved%problem, group%paths(i)%record, group%verdicts(i), &
                                                   group%statistics(i), scenes(i)%spectrum, scenes(i)%resolved%noise_floor)
      end do
      tested = pack([(i, i=1, size(scenes))], is_tested)
      if (size(tested) == 0) return
      starts = start_of(scenes%resolved%problem)
      starts%implicit = goes_by_collocation(scenes(1))
      wants = .false.
      wants(compared) = .true.
      wants([seen_loads(1), seen_net_load]) = allocated(windows%impacts)
      tighter = with_accuracy(scenes(tested), tighter_accuracy(scenes(tested)))
      if (.not. allocated(windows%impacts)) tighter%request%impact_limit = 0.0_dp
      call solve_group(tighter, starts(tested), wants, tight)
      call classify_windows(tighter, tight, error)
      if (allocated(error)) return
      do k = 1, size(tested)
         if (goes_beyond(group, tested(k)) .and. tight%repeat_after(k) == 0) tight%repeat_after(k) = group%repeat_after(tested(k))
      end do
      call complete_windows(tighter, tight)
      do k = 1, size(tested)
         i = tested(k)
         if (.not. is_success(tight%endings(k)%status)) then
            verifications(i) = no_verification(doubt_t(doubt_second_ending, counts=[tight%endings(k)%status, 0]))
            cycle
         end if
         if (must_stop()) return
         call verify_window(scenes(i), tighter(k), windows, i, k, group, tight, verifications(i))
      end do
   end subroutine verify_windows

   !> Verify the window of a scene by that of its tighter solution.
   subroutine verify_window(scene, tighter, windows, place, tight_place, group, tight, verification)
      type(prepared_scene_t), intent(in) :: scene
      type(prepared_scene_t), intent(in) :: tighter
      type(verified_windows_t), intent(in) :: windows
      !> Of the scene in its group, and in the tighter one
      integer, intent(in) :: place
      integer, intent(in) :: tight_place
      type(scene_group_t), intent(inout) :: group
      type(scene_group_t), intent(inout) :: tight
      type(verification_t), intent(out) :: verification
      type(periodic_orbit_t) :: orbit
      type(window_record_t) :: record, tight_record
      type(window_impacts_t) :: tight_impacts

      associate (problem => scene%resolved%problem, verdict => group%verdicts(place), &
                 tight_verdict => tight%verdicts(tight_place))
         record = judged_record(group, place)
         tight_record = judged_record(tight, tight_place)
         if (windows%with_orbits) then
            orbit = nearby_orbit(problem, tight%endings(tight_place))
            call note_orbit(tight_verdict, attracting_period(orbit))
            ! Newmark's method may be off by more than motions of a scene differ.
            if (scene%method == method_taylor) orbit = orbit_of(problem, group%endings(place), orbit)
            group%orbits(place) = orbit
         end if
         call note_known(tight_verdict, verdict)
         call compare(scene, tighter, place, tight_place, group, tight, record, tight_record, verification)
         if (allocated(windows%severities)) &
            call note_severity_errors(windows%severities(place), severity_of_record(tight_record, problem%frequency), &
                                      tighter%request%accuracy, verification)
         if (.not. allocated(windows%impacts)) return
         tight_impacts = impacts_of_record(tight_record, problem%frequency)
         verification%impacts = agreement_of(problem, extremes_of_record(record), windows%impacts(place), &
                                             extremes_of_record(tight_record), tight_impacts, &
                                             is_part(scene, group, place, tight, tight_place))
         call note_impact_errors(windows%impacts(place), tight_impacts, verification)
      end associate
   end subroutine verify_window

   !> Accuracy of the tighter solution of a scene [-].
   elemental real(dp) function tighter_accuracy(scene)
      type(prepared_scene_t), intent(in) :: scene

      tighter_accuracy = tight_accuracy
      if (scene%method == method_taylor) &
         tighter_accuracy = min(tight_accuracy, max(tightest_accuracy, 0.01_dp*scene%request%accuracy))
   end function tighter_accuracy

   !> Whether the tighter solution goes by the implicit method, whatever the film law: where there is no room for a tighter one, another
   !> method shows the errors.
   pure logical function goes_by_collocation(scene)
      type(prepared_scene_t), intent(in) :: scene

      goes_by_collocation = scene%method == method_taylor .and. tighter_accuracy(scene) > 0.05_dp*scene%request%accuracy
   end function goes_by_collocation

   !> Hold the window of a scene against that of its tighter solution.
   subroutine compare(scene, tighter, place, tight_place, group, tight, record, tight_record, verification)
      type(prepared_scene_t), intent(in) :: scene
      type(prepared_scene_t), intent(in) :: tighter
      !> Of the scene in its group, and in the tighter one
      integer, intent(in) :: place
      integer, intent(in) :: tight_place
      type(scene_group_t), intent(in) :: group
      type(scene_group_t), intent(in) :: tight
      !> What the steps show of both motions
      type(window_record_t), intent(in) :: record
      type(window_record_t), intent(in) :: tight_record
      type(verification_t), intent(out) :: verification
      type(doubt_t) :: unclosed
      integer, allocatable :: same(:)

      associate (window => group%records(place), tight_window => tight%records(tight_place), verdict => group%verdicts(place), &
                 tight_verdict => tight%verdicts(tight_place), problem => scene%resolved%problem, own => group%endings(place), &
                 tight_end => tight%endings(tight_place), noise => scene%resolved%noise_floor, &
                 tight_noise => tighter%resolved%noise_floor, choice => scene%spectrum, &
                 samples_per_period => scene%request%samples_per_period)
         unclosed = doubt_of_windows(problem, window, tight_window, noise, tight_noise, verdict, &
                                     doubt_of_samples(scene, verdict, tight_verdict, tight%classified_by(tight_place)), &
                                     own%samples/samples_per_period, tight_end%numbers, choice%verification_tolerance)
         same = same_phase(group%states(:own%samples, of_film, place), tight%states(:tight_end%samples, of_film, tight_place), &
                           samples_per_period, own%status == status_steady .or. tight_end%status == status_steady)
         call compare_windows(films_of(problem, group%states(:own%samples, :, place)), &
                              films_of(problem, tight%states(same, :, tight_place)), extremes_of_record(record), &
                              extremes_of_record(tight_record), verdict, tight_verdict, unclosed, choice, &
                              choice%verification_tolerance, tighter%request%accuracy, tight_noise, verification)
      end associate
   end subroutine compare

   !> Whether a window is but a part of its motion.
   pure logical function is_part(scene, group, place, tight, tight_place)
      type(prepared_scene_t), intent(in) :: scene
      !> The scene in its group, and its tighter solution
      type(scene_group_t), intent(in) :: group
      integer, intent(in) :: place
      type(scene_group_t), intent(in) :: tight
      integer, intent(in) :: tight_place
      integer :: periods

      periods = group%endings(place)%samples/scene%request%samples_per_period
      is_part = .false.
      if (goes_beyond(group, place)) return
      is_part = group%verdicts(place)%class == class_subharmonic .and. group%repeat_after(place) > periods
      if (is_part) return
      is_part = is_doubted(doubt_of_return(group%verdicts(place), periods, &
                                           films_of_ends(scene%resolved%problem, tight%records(tight_place), &
                                                         tight%endings(tight_place)%numbers), &
                                           scene%spectrum%verification_tolerance))
   end function is_part

   !> Whether the samples are too few, and how many would do.
   pure type(doubt_t) function doubt_of_samples(scene, verdict, tight_verdict, classified_by) result(doubt)
      type(prepared_scene_t), intent(in) :: scene
      !> Verdicts on the scene and on its tighter solution
      type(rattle_verdict_t), intent(in) :: verdict
      type(rattle_verdict_t), intent(in) :: tight_verdict
      !> Samples of a period that the latter is from
      integer, intent(in) :: classified_by
      logical :: would_do

      doubt = doubt_t()
      if (verdict%spectrum%sampling_sufficient .and. tight_verdict%spectrum%sampling_sufficient) return
      would_do = tight_verdict%spectrum%sampling_sufficient .and. classified_by > scene%request%samples_per_period
      doubt = doubt_t(doubt_samples, counts=[merge(classified_by, 0, would_do), merge(1, 0, scene%method == method_newmark)])
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

end module verify_group
