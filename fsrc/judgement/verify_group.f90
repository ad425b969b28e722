!> How far the classes and impacts of some scenes, or of a single one, stand: all of them solved again, tighter and side by side, and
!> every window held against the tighter one.
!>
!> A scene that is solved for a number of periods is held against the same periods. Where both solutions go on until the motion
!> repeats, the tighter one within its own accuracy, their forecasts may save different periods: the orbits are held against each
!> other, beginning with whichever of their periods fits best.
!>
!> Two solutions of an irregular motion part whatever their digits, so that one of another accuracy is another sample of it: one that
!> settles shows that the first one may. It is followed behind its window, where nothing but its class is asked for, which integrals
!> over the steps give, and the tighter solution is that of a window there.
module verify_group
   use carried_loads, only: films_of
   use classify_group, only: classify_finer, classify_windows, integral_record
   use doubt, only: doubt_class, doubt_class_behind, doubt_none, doubt_samples, doubt_second_ending, doubt_t, first_doubt, &
      is_doubted
   use engine, only: ending_t, motion_state_t, request_t, start_of
   use errors, only: error_t
   use kinds, only: dp
   use many_motions, only: solve_motions
   use node_extremes, only: seen_acceleration, seen_films, seen_loads, seen_net_load, seen_quantities
   use periodic_orbit, only: attracting_period, periodic_orbit_t
   use prepared_scene, only: prepared_scene_t, with_accuracy
   use problem, only: of_film, state_size
   use rattle_class, only: class_irregular, class_irregular_so_far, class_subharmonic, classify_steps, is_off_harmonics, &
      note_known, note_orbit, rattle_verdict_t
   use scene_group, only: scene_group_t, solve_group
   use scene_orbit, only: nearby_orbit, orbit_of
   use scene_status, only: is_success, status_steady
   use scene_types, only: method_newmark, method_taylor
   use signals, only: must_stop
   use text_output, only: lock_texts, unlock_texts
   use verification, only: compare_windows, doubt_behind, doubt_of_return, doubt_of_windows, films_of_ends, no_verification, &
      severity_error, verification_t, windows_behind
   use vibration_severity, only: severity_of_record, vibration_severity_t
   use window_extremes, only: extremes_of_record
   use window_impacts, only: agreement_of, impacts_of_record, window_impacts_t
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Accuracy of the tighter solution: this, or a hundredth of the scene's own.
   real(dp), parameter :: tight_accuracy = 1.0e-10_dp, tightest_accuracy = 1.0e-12_dp
   !> Accuracy of the other solution of an irregular motion: enough to tell motions apart, and another one where the scene has nearly
   !> this [-]
   real(dp), parameter :: usual_accuracy = 1.0e-6_dp, finer_accuracy = 1.0e-8_dp, nearly = 0.1_dp
   !> Extremes that windows are compared by
   integer, parameter, public :: compared(3) = [seen_films, seen_acceleration]

   !> What the scenes are verified by besides their windows.
   type, public :: verified_windows_t
      !> Impacts of the scenes, where these are to be verified, and their severity
      type(window_impacts_t), allocatable :: impacts(:)
      type(vibration_severity_t), allocatable :: severities(:)
      !> Whether the periodic motions are asked for that the scenes end on
      logical :: with_orbits = .false.
   end type verified_windows_t

   public :: verify_windows, follow_behind, other_accuracy

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
      type(doubt_t) :: doubts(size(scenes))
      integer, allocatable :: tested(:)
      logical :: wants(seen_quantities), is_tested(size(scenes))
      integer :: i, k

      ! The class of what is irregular only so far cannot stand: its impacts alone are worth a tighter solution.
      is_tested = is_success(group%endings(:size(scenes))%status)
      if (.not. allocated(windows%impacts)) &
         is_tested = is_tested .and. group%verdicts(:size(scenes))%class /= class_irregular_so_far
      tested = pack([(i, i=1, size(scenes))], is_tested)
      if (size(tested) == 0) return
      starts = start_of(scenes%resolved%problem)
      starts%implicit = goes_by_collocation(scenes(1))
      call go_behind(scenes, pack(tested, group%verdicts(tested)%class == class_irregular), starts, doubts, error)
      if (allocated(error)) return
      wants = .false.
      wants(compared) = .true.
      wants([seen_loads(1), seen_net_load]) = allocated(windows%impacts)
      tighter = with_accuracy(scenes(tested), tighter_accuracy(scenes(tested)))
      if (.not. allocated(windows%impacts)) tighter%request%impact_limit = 0.0_dp
      call solve_group(tighter, starts(tested), wants, tight)
      call classify_windows(tighter, tight, error)
      if (allocated(error)) return
      do k = 1, size(tested)
         i = tested(k)
         if (.not. is_success(tight%endings(k)%status)) then
            verifications(i) = no_verification(doubt_t(doubt_second_ending, counts=[tight%endings(k)%status, 0]))
            cycle
         end if
         if (must_stop()) return
         call verify_window(scenes(i), tighter(k), windows, i, k, doubts(i), group, tight, verifications(i))
      end do
   end subroutine verify_windows

   !> Verify the window of a scene by that of its tighter solution.
   subroutine verify_window(scene, tighter, windows, place, tight_place, behind, group, tight, verification)
      type(prepared_scene_t), intent(in) :: scene
      type(prepared_scene_t), intent(in) :: tighter
      type(verified_windows_t), intent(in) :: windows
      !> Of the scene in its group, and in the tighter one
      integer, intent(in) :: place
      integer, intent(in) :: tight_place
      !> Doubt behind the window, or none
      type(doubt_t), intent(in) :: behind
      type(scene_group_t), intent(inout) :: group
      type(scene_group_t), intent(inout) :: tight
      type(verification_t), intent(out) :: verification
      type(periodic_orbit_t) :: orbit

      associate (problem => scene%resolved%problem, verdict => group%verdicts(place), &
                 tight_verdict => tight%verdicts(tight_place), record => group%records(place), &
                 tight_record => tight%records(tight_place))
         if (windows%with_orbits .or. verdict%class == class_irregular .and. tight_verdict%class == class_irregular_so_far) then
            orbit = nearby_orbit(problem, tight%endings(tight_place))
            call note_orbit(tight_verdict, attracting_period(orbit))
            ! Newmark's method may be off by more than motions of a scene differ.
            if (windows%with_orbits .and. scene%method == method_taylor) orbit = orbit_of(problem, group%endings(place), orbit)
            if (windows%with_orbits) group%orbits(place) = orbit
         end if
         call note_known(tight_verdict, verdict)
         call compare(scene, tighter, place, tight_place, behind, group, tight, verification)
         if (allocated(windows%severities)) verification%severity_error = &
            severity_error(windows%severities(place), severity_of_record(tight_record, problem%frequency), tighter%request%accuracy)
         if (allocated(windows%impacts)) verification%impacts = &
            agreement_of(problem, extremes_of_record(record), windows%impacts(place), extremes_of_record(tight_record), &
                         impacts_of_record(tight_record, problem%frequency), is_part(scene, group, place, tight, tight_place))
      end associate
   end subroutine verify_window

   !> See that motions, solved again, stay irregular behind their windows, and start the tighter solutions there, where their last
   !> periods are sampled.
   subroutine go_behind(scenes, places, starts, doubts, error)
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> Of the motions
      integer, intent(in) :: places(:)
      !> Where the tighter solutions start; on return, of these, behind their windows
      type(motion_state_t), intent(inout) :: starts(:)
      !> None where a motion stays irregular
      type(doubt_t), intent(inout) :: doubts(:)
      !> Set if there is no memory for the samples that a class needs
      type(error_t), allocatable, intent(out) :: error
      type(motion_state_t) :: behind(size(places))
      type(doubt_t) :: found(size(places))

      if (size(places) == 0) return
      associate (request => scenes(1)%request)
         behind = start_of(scenes(places)%resolved%problem)
         call follow_behind(with_accuracy(scenes(places), other_accuracy(request%accuracy)), &
                            request%periods - request%sampled_periods, behind, found, error)
         behind%implicit = behind%implicit .or. starts(places)%implicit
         behind%periods = request%periods - request%sampled_periods
      end associate
      starts(places) = behind
      doubts(places) = found
   end subroutine go_behind

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

   !> Accuracy of another solution of an irregular motion [-].
   elemental real(dp) function other_accuracy(own_accuracy)
      !> That of the first one [-]
      real(dp), intent(in) :: own_accuracy

      other_accuracy = merge(usual_accuracy, finer_accuracy, own_accuracy <= nearly*usual_accuracy)
   end function other_accuracy

   !> Hold the window of a scene against that of its tighter solution.
   subroutine compare(scene, tighter, place, tight_place, behind, group, tight, verification)
      type(prepared_scene_t), intent(in) :: scene
      type(prepared_scene_t), intent(in) :: tighter
      !> Of the scene in its group, and in the tighter one
      integer, intent(in) :: place
      integer, intent(in) :: tight_place
      !> Doubt behind the window, or none
      type(doubt_t), intent(in) :: behind
      type(scene_group_t), intent(in) :: group
      type(scene_group_t), intent(in) :: tight
      type(verification_t), intent(out) :: verification
      type(doubt_t) :: unclosed
      integer, allocatable :: same(:)

      associate (record => group%records(place), tight_record => tight%records(tight_place), verdict => group%verdicts(place), &
                 tight_verdict => tight%verdicts(tight_place), problem => scene%resolved%problem, own => group%endings(place), &
                 tight_end => tight%endings(tight_place), noise => scene%resolved%noise_floor, &
                 tight_noise => tighter%resolved%noise_floor, choice => scene%spectrum, &
                 samples_per_period => scene%request%samples_per_period)
         ! That another solution settles says more than where this one went.
         unclosed = first_doubt([behind, doubt_of_windows(problem, record, tight_record, noise, tight_noise, verdict, &
                                                          tight_verdict, doubt_of_samples(scene, verdict, tight_verdict, &
                                                                           tight%classified_by(tight_place)), &
                                                          own%samples/samples_per_period, tight_end%numbers, &
                                                          choice%verification_tolerance)])
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

   !> Solve irregular motions again, side by side, and follow them behind their windows. After a signal to stop the answers are of no
   !> use.
   subroutine follow_behind(scenes, before, states, doubts, error)
      !> With the accuracy of this solution, the periods of a window, and the samples of each from which on more are taken where
      !> integrals leave the class open
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> Periods before the windows that were judged
      integer, intent(in) :: before
      !> Where the motions start; on return where the last window behind ends, or the last one that could be followed
      type(motion_state_t), intent(inout) :: states(:)
      !> None where a motion stays irregular
      type(doubt_t), intent(out) :: doubts(:)
      !> Set if there is no memory for the samples that a class needs; the doubts are of no use then
      type(error_t), allocatable, intent(out) :: error
      integer, allocatable :: left(:)
      integer :: i, passed

      if (before > 0) call go_to_windows(scenes, before, states, doubts)
      left = pack([(i, i=1, size(scenes))], doubts%code == doubt_none)
      do passed = 0, windows_behind(scenes(1)%request%sampled_periods)
         if (size(left) == 0 .or. must_stop() .or. allocated(error)) return
         call pass_window
      end do

   contains

      !> Follow those that are left through one more window.
      subroutine pass_window
         type(motion_state_t) :: starts(size(left))
         type(ending_t) :: endings(size(left))
         type(window_record_t) :: records(size(left))
         type(rattle_verdict_t) :: verdicts(size(left))
         real(dp) :: numbers(scenes(1)%request%sampled_periods, maxval(state_size(scenes(left)%resolved%problem)), size(left))
         logical :: followed(size(left))
         integer :: k

         starts = states(left)
         starts%periods = 0
         do k = 1, size(left)
            records(k) = integral_record(scenes(left(k))%spectrum)
         end do
         numbers = 0.0_dp
         associate (accuracy => scenes(1)%request%accuracy, periods => scenes(1)%request%sampled_periods)
            call unlock_texts()
            call solve_motions(scenes(left)%resolved%problem, starts, &
                               request_t(accuracy=accuracy, periods=periods, samples_per_period=1, sampled_periods=periods, &
                                         every_period=.true.), numbers, endings, records=records)
            call lock_texts()
         end associate
         followed = is_success(endings%status)
         do k = 1, size(left)
            if (.not. followed(k)) cycle
            associate (scene => scenes(left(k)))
               call classify_steps(records(k), scene%resolved%problem%frequency, scene%spectrum, scene%resolved%noise_floor, &
                                   verdicts(k))
            end associate
            states(left(k)) = endings(k)%motion_state_t
         end do
         call settle_bounds(pack([(k, k=1, size(left))], followed .and. verdicts%spectrum%irregular_is_bound .and. &
                                                         .not. is_off_harmonics(verdicts%class)), records, verdicts)
         if (allocated(error)) return
         do k = 1, size(left)
            doubts(left(k)) = doubt_behind(passed, endings(k)%status, verdicts(k))
            if (passed == 0 .and. doubts(left(k))%code == doubt_class_behind) doubts(left(k))%code = doubt_class
         end do
         left = pack(left, doubts(left)%code == doubt_none)
      end subroutine pass_window

      !> Classes where integrals give no more than a bound of what is off the harmonics: by samples, as many as it takes.
      subroutine settle_bounds(unsure, records, verdicts)
         !> Places of these among those that are left
         integer, intent(in) :: unsure(:)
         type(window_record_t), intent(in) :: records(:)
         type(rattle_verdict_t), intent(inout) :: verdicts(:)
         type(rattle_verdict_t) :: classes(size(unsure))
         integer :: classified_by(size(unsure))

         if (size(unsure) == 0) return
         classes = verdicts(unsure)
         classes%spectrum%sampling_sufficient = .false.
         call classify_finer(scenes(left(unsure)), spread(scenes(1)%request%sampled_periods, 1, size(unsure)), records(unsure), &
                             classes, classified_by, .true., error)
         verdicts(unsure) = classes
      end subroutine settle_bounds

   end subroutine follow_behind

   !> Follow motions to where their windows begin.
   subroutine go_to_windows(scenes, before, states, doubts)
      type(prepared_scene_t), intent(in) :: scenes(:)
      !> Periods
      integer, intent(in) :: before
      type(motion_state_t), intent(inout) :: states(:)
      !> Of those that could not be followed
      type(doubt_t), intent(inout) :: doubts(:)
      type(ending_t) :: endings(size(scenes))
      real(dp) :: none(0, 2, size(scenes))
      integer :: i

      call unlock_texts()
      call solve_motions(scenes%resolved%problem, states, request_t(accuracy=scenes(1)%request%accuracy, periods=before), none, &
                         endings)
      call lock_texts()
      do i = 1, size(scenes)
         if (is_success(endings(i)%status)) then
            states(i) = endings(i)%motion_state_t
         else
            doubts(i) = doubt_t(doubt_second_ending, counts=[endings(i)%status, 0])
         end if
      end do
   end subroutine go_to_windows

end module verify_group
