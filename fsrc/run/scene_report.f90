!> What the log of a scene reports, and the terminal where all of it is wanted there.
module scene_report
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use coexisting_motions, only: motions_sentence, own_start_words
   use verification, only: verified_in_brackets, verification_sentence
   use flank_contact, only: contact_words
   use judged_scene, only: judged_scene_t, largest_load, quantity_value
   use kinds, only: dp
   use log_file, only: log_magic, log_t
   use node_extremes, only: seen_acceleration, seen_films
   use nodal_orbit, only: orbit_sentence
   use output_place, only: has_motions_table, motions_path, profiles_path, result_path, summary_path
   use quantities, only: a_code, a_flag, part_cost, part_scene, part_window, quantity_closure_range, &
      quantity_deflection_share, quantity_iterations_per_step, quantity_model_limit, quantity_orbit_stability, &
      quantity_rattle_class, quantity_t, quantity_table, quantity_verdict, quantity_verdict_verified, quantity_word
   use key_table, only: choice_word
   use rattle_class, only: class_irregular, class_irregular_so_far, sounds
   use regime, only: deflection_limit, steel_tooth
   use regime_check, only: closure_range_sentence, fitting_law, model_limit, model_limit_sentence, outside_closure, &
      regime_sentence, within_model
   use scene_status, only: is_success, status_name, status_sentence
   use scene_types, only: method_newmark, model_published, scene_t, speed_mean, task_film
   use text, only: counted, error_text, integer_text, short_text, spaced
   use version, only: program_version
   use word_list, only: word_t
   implicit none(type, external)
   private

   !> What a note on an input begins with where it is a warning
   character(*), parameter :: note_label = 'warning: '
   !> Significant digits of films and accelerations
   integer, parameter :: digits_of_extremes = 5
   !> Acceleration of level 0 dB, by ISO 1683 [m/s2]
   real(dp), parameter :: level_reference = 1.0e-6_dp

   public :: acceleration_in_short, acceleration_words, deflects_in_words, film_force_in_short, has_coarse_series, is_warning, &
             law_sentence, note_in_short, operating_point, report_ending, report_head, report_notes, report_start, &
             samples_key, speed_meaning, steel_stiffness_in_words, stiffness_warning, value_words, verdict_in_short, &
             verdict_sentence

contains

   !> First line of a log.
   subroutine report_head(log, scene, words)
      !> Log of the scene
      type(log_t), intent(in) :: log
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What will be solved
      character(*), intent(in) :: words

      call log%line(log_magic//program_version//', scene '//trim(scene%name)//': '//words)
      call report_notes(log, scene%warnings)
   end subroutine report_head

   !> Notes on an input: all of them for the log, in short for the terminal.
   subroutine report_notes(log, notes)
      !> Log of the task
      type(log_t), intent(in) :: log
      !> The notes
      type(word_t), intent(in) :: notes(:)
      integer :: i

      do i = 1, size(notes)
         call log%detail('  '//notes(i)%text)
         call log%row(trim(merge('warning', 'input  ', is_warning(notes(i)%text))), note_in_short(notes(i)%text))
      end do
   end subroutine report_notes

   !> Whether a note on an input warns of something.
   pure logical function is_warning(note)
      character(*), intent(in) :: note

      is_warning = index(note, note_label) == 1
   end function is_warning

   !> A note behind its label; one that warns of nothing is cut at a blank where it is long, as the log has the rest.
   pure function note_in_short(note) result(words)
      character(*), intent(in) :: note
      character(:), allocatable :: words
      integer, parameter :: longest = 87

      words = note
      if (is_warning(note)) then
         words = note(len(note_label) + 1:)
      else if (len(words) > longest) then
         words = words(:index(words(:longest), ' ', back=.true.))//'...'
      end if
   end function note_in_short

   !> Head of a motion: what will be solved, and what is known beforehand.
   subroutine report_start(log, scene, judged)
      !> Log of the scene
      type(log_t), intent(in) :: log
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What follows from it
      type(judged_scene_t), intent(in) :: judged
      integer :: i

      call log%line(log_magic//program_version//', scene '//trim(scene%name)//': '//law_sentence(scene))
      do i = 1, size(scene%warnings)
         call log%detail('  '//scene%warnings(i)%text)
      end do
      call log%detail('  '//operating_point(scene))
      if (scene%gear%given) call log%detail('  profile shift sum '//short_text(scene%teeth%shift_sum, 3)//', contact ratio '// &
                                          short_text(scene%teeth%contact_ratio, 4)//', overlap ratio '// &
                                          short_text(scene%teeth%overlap_ratio, 4))
      if (judged%resolved%steady_film > 0.0_dp) then
         call report_part(log, judged, part_scene)
         if (.not. judged%resolved%natural_frequency > 0.0_dp) &
            call log%detail('  no natural frequency: small motions about the steady film are overdamped')
      else
         call log%detail('  no rigid piezo-viscous film carries the static load')
      end if
   end subroutine report_start

   !> Speed, oil and force of a scene.
   pure function operating_point(scene) result(words)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: words
      integer, parameter :: digits = 4

      if (scene%gear%given) then
         words = 'shaft '//short_text(scene%shaft%speed_rpm, digits)//' 1/min; oil '
      else
         words = 'entrainment speed '//short_text(scene%kinematics%entrainment_speed, digits)//' m/s; oil '
      end if
      if (scene%oil%given) words = words//short_text(scene%oil%temperature_celsius, digits)//' degC, '
      words = words//short_text(scene%lubricant%viscosity, digits)//' Pa s, '// &
              choice_word('lubricant.viscosity_law', scene%lubricant%viscosity_law)//'; force '
      associate (load => scene%excitation)
         if (allocated(load%force_orders)) then
            words = words//'of '//counted(size(load%force_orders), 'order')//' of '
         else
            words = words//short_text(load%force_scale*load%force_amplitude, digits)//' N at '
         end if
         words = words//short_text(load%frequency, digits)//' Hz'
      end associate
   end function operating_point

   !> A line with the quantities of a part that the log reports, by their names; without any there is no line.
   subroutine report_part(log, judged, part)
      type(log_t), intent(in) :: log
      type(judged_scene_t), intent(in) :: judged
      !> Part of the summary, a code of module quantities
      integer, intent(in) :: part
      character(:), allocatable :: words
      integer :: i

      words = ''
      do i = 1, size(quantity_table)
         if (quantity_table(i)%part /= part .or. index(quantity_table(i)%reported_in, 'log') == 0) cycle
         if (ieee_is_nan(quantity_value(i, judged))) cycle
         words = words//', '//trim(quantity_table(i)%name)//' '//value_words(i, quantity_value(i, judged))
      end do
      if (len(words) > 0) call log%detail('  '//spaced(words(3:)))
   end subroutine report_part

   !> A known value as a person says it.
   pure function value_words(quantity, value) result(words)
      !> Code of the quantity
      integer, intent(in) :: quantity
      real(dp), intent(in) :: value
      character(:), allocatable :: words
      type(quantity_t) :: row

      row = quantity_table(quantity)
      if (row%kind == a_code) then
         words = quantity_word(quantity, nint(value))
      else if (row%kind == a_flag) then
         words = trim(merge('yes', 'no ', value > 0.0_dp))
      else if (row%unit == 'm') then
         words = short_text(1.0e6_dp*value, row%digits)//' um'
      else
         words = short_text(value, row%digits)
         if (row%unit /= '-') words = words//' '//trim(row%unit)
      end if
   end function value_words

   !> The film law of a scene in words.
   pure function law_sentence(scene) result(sentence)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: sentence

      if (scene%task == task_film) then
         sentence = 'film task'
      else
         sentence = contact_words(scene%film)
      end if
   end function law_sentence

   !> What the acceleration of a gear pair is, behind a number; empty without a pair.
   pure function acceleration_words(scene) result(words)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: words

      words = ''
      if (scene%gear%given) words = ' relative to the shaft, along the line of action'
   end function acceleration_words

   !> Which u the formulas of a scene take.
   pure function speed_meaning(scene) result(words)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: words

      logical :: mean

      mean = scene%film%model == model_published
      if (scene%task == task_film) mean = scene%points%speed_reading == speed_mean
      if (scene%task == task_film .and. .not. scene%points%from_speeds) then
         words = 'the u of the given groups'
      else if (mean) then
         words = 'entrainment speed U = (u1 + u2)/2'
      else
         words = 'rolling speed u_r = u1 + u2'
      end if
   end function speed_meaning

   !> How the scene ended and what it amounts to.
   subroutine report_ending(log, scene, judged, solve_seconds)
      !> Log of the scene
      type(log_t), intent(in) :: log
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Its result
      type(judged_scene_t), intent(in) :: judged
      !> Wall time of its solution [s]
      real(dp), intent(in) :: solve_seconds
      character(:), allocatable :: film
      real(dp) :: iterations
      integer :: part

      iterations = 0.0_dp
      if (judged%ending%count%steps > 0) iterations = quantity_value(quantity_iterations_per_step, judged)
      if (judged%judged) call log%detail('  '//verdict_sentence(judged))
      call log%detail('  '//integer_text(judged%ending%count%steps)//' steps in '//short_text(solve_seconds, 3)//' s, '// &
                    short_text(iterations, 3)//' iterations a step, '//integer_text(judged%ending%count%cuts)// &
                    ' steps cut where the film law had no value')
      if (.not. is_success(judged%status)) then
         film = ', without a film to start from'
         if (judged%ending%film > 0.0_dp) film = ', film '//micrometres(judged%ending%film)//' um'
         if (judged%ending%lost_film > 0) film = film//' on the '//trim(merge('drive', 'coast', judged%ending%lost_film == 1))// &
            ' flank under M = '//short_text(judged%ending%lost_load/judged%resolved%problem%contact%film%closure%load_unit, 3)
         call log%detail('  '//status_name(judged%status)//' at t = '//short_text(judged%ending%time, 6)//' s'//film//': '// &
                       status_sentence(judged%status))
      end if
      if (judged%judged) call report_window(log, scene, judged)
      do part = part_window, part_cost
         call report_part(log, judged, part)
      end do
      if (scene%film%model_words /= '') call log%detail('  the film is solved '//trim(scene%film%model_words))
      if (scene%output%series) call log%detail('  '//result_path(scene))
      if (has_motions_table(scene)) call log%detail('  '//motions_path(scene))
      if (scene%output%profiles) call log%detail('  '//profiles_path(scene))
      call log%detail('  '//summary_path(scene))
   end subroutine report_ending

   !> The window: extremes, spectrum, class, regime.
   subroutine report_window(log, scene, judged)
      type(log_t), intent(in) :: log
      type(scene_t), intent(in) :: scene
      type(judged_scene_t), intent(in) :: judged
      character(:), allocatable :: warning
      integer :: limit

      associate (lowest => judged%extremes%lowest, highest => judged%extremes%highest)
         call log%detail('  film '//micrometres(lowest(seen_films(1))%value)//' to '//micrometres(highest(seen_films(1))%value)// &
                       ' um, acceleration '// &
                       short_text(lowest(seen_acceleration)%value, digits_of_extremes)//' to '// &
                       short_text(highest(seen_acceleration)%value, digits_of_extremes)//' m/s2'//acceleration_words(scene))
      end associate
      associate (rattle => judged%rattle, spectrum => judged%rattle%spectrum)
         if (spectrum%moving) then
            call log%detail('  '//at_least(spectrum%count_is_bound)//integer_text(spectrum%harmonic_count)//' harmonics, '// &
               'harmonic distortion '// &
                          at_least(spectrum%distortion_is_bound)//short_text(spectrum%harmonic_distortion, 3)//', '// &
                          short_text(rattle%reversals_per_period, 3)//' reversals a period: '// &
                          spaced(quantity_word(quantity_rattle_class, rattle%class))// &
                          certainty())
            if (judged%statistics%periods > 0) then
               call log%detail('  Extremes, rms, impacts and harmonics are those of '// &
                             counted(judged%statistics%periods, 'period')//' that the motion was followed, with standard '// &
                             'errors by batches of '//counted(judged%statistics%batch_periods, 'period')// &
                             '; extremes of an irregular motion grow with time.')
            else if (spectrum%sampling_sufficient .and. any(rattle%class == [class_irregular, class_irregular_so_far])) then
               call log%detail('  The motion does not repeat within its window of '//counted(scene%spectrum%periods, 'period')// &
                             ': other windows have other numbers; raise spectrum.periods for steadier ones.')
            end if
         else
            call log%detail('  no motion above rounding: '//spaced(quantity_word(quantity_rattle_class, rattle%class)))
         end if
         if (has_coarse_series(scene, judged)) &
            call log%detail('  warning: '//coarse_sentence(scene, judged))
      end associate
      limit = nint(quantity_value(quantity_model_limit, judged))
      if (limit /= within_model) call log%detail('  warning: '//model_limit_sentence(limit)//' (model_limit)')
      call report_verification(log, judged)
      if (allocated(judged%coexisting%motions)) call log%detail('  '//motions_sentence(judged%coexisting))
      if (judged%coexisting%starts_solved > 1) call log%detail('  '//integer_text(judged%coexisting%starts_solved - 1)// &
         ' further starts were followed for '//integer_text(judged%coexisting%extra_periods)//' periods')
      call log%detail('  '//regime_sentence(judged%regime))
      if (judged%regime%law_contradicted) &
         call log%detail('  warning: the film law of the scene does not fit this regime (law_contradicted); '// &
                       fitting_law(judged%regime%regime))
      ! Of films that do not bend it is not a number.
      if (judged%resolved%problem%contact%film%bends .and. .not. judged%resolved%problem%contact%film%in_nodes) then
         if (nint(quantity_value(quantity_closure_range, judged)) == outside_closure) &
            call log%detail('  warning: '//closure_range_sentence(judged%resolved%problem%contact%film, largest_load(judged), &
                                                                judged%regime%pressure_maximum))
      end if
      warning = stiffness_warning(scene, 'under its largest load', quantity_value(quantity_deflection_share, judged))
      if (len(warning) > 0) call log%detail('  '//warning)

   contains

      !> Words before a number that is a lower bound.
      pure function at_least(is_bound) result(words)
         logical, intent(in) :: is_bound
         character(:), allocatable :: words

         words = ''
         if (is_bound) words = 'at least '
      end function at_least

      !> Whether the class is verified, and of which motion it is, behind it.
      pure function certainty() result(words)
         character(:), allocatable :: words

         words = ''
         if (judged%verification%exists) words = verified_in_brackets(judged%verification%verified)
         if (.not. allocated(judged%coexisting%motions)) return
         if (size(judged%coexisting%motions) > 1) words = words//', '//own_start_words(judged%coexisting)
      end function certainty

   end subroutine report_window

   !> What the tooth does in its gap, what that sounds like, how sure both are, and how hard it is for the bearings.
   pure function verdict_sentence(judged) result(sentence)
      !> A scene that could be judged
      type(judged_scene_t), intent(in) :: judged
      character(:), allocatable :: sentence

      sentence = verdict_in_short(judged)//', '//trim(sounds(judged%rattle%class))//': film force rms '// &
                 film_force_in_short(judged)//' N, acceleration rms '//acceleration_in_short(judged, '')
   end function verdict_sentence

   !> Verdict and class, and whether each is verified.
   pure function verdict_in_short(judged) result(words)
      !> A scene that could be judged
      type(judged_scene_t), intent(in) :: judged
      character(:), allocatable :: words
      real(dp) :: verified

      words = quantity_word(quantity_verdict, nint(quantity_value(quantity_verdict, judged)))
      verified = quantity_value(quantity_verdict_verified, judged)
      if (.not. ieee_is_nan(verified)) words = words//verified_in_brackets(verified > 0.0_dp)
      words = words//'; '//spaced(quantity_word(quantity_rattle_class, judged%rattle%class))
      if (judged%verification%exists) words = words//verified_in_brackets(judged%verification%verified)
   end function verdict_in_short

   !> The rms of the film force [N].
   pure function film_force_in_short(judged) result(words)
      !> A scene that could be judged
      type(judged_scene_t), intent(in) :: judged
      character(:), allocatable :: words

      words = with_scatter(judged, judged%severity%film_force_rms, judged%statistics%severity%film_force_rms)
   end function film_force_in_short

   !> The rms of the acceleration with its unit, and as a level.
   pure function acceleration_in_short(judged, meaning) result(words)
      !> A scene that could be judged
      type(judged_scene_t), intent(in) :: judged
      !> Words behind the unit; absent: that it is the rms
      character(*), intent(in), optional :: meaning
      character(:), allocatable :: words

      associate (rms => judged%severity%acceleration_rms)
         words = with_scatter(judged, rms, judged%statistics%severity%acceleration_rms)//' m/s2'
         if (present(meaning)) then
            words = words//meaning
         else
            words = words//' rms'
         end if
         if (rms > 0.0_dp) words = words//' ('//short_text(20.0_dp*log10(rms/level_reference), 4)//' dB re 1e-6 m/s2)'
      end associate
   end function acceleration_in_short

   !> A number, of an irregular motion with two of its standard errors.
   pure function with_scatter(judged, number, standard_error) result(words)
      type(judged_scene_t), intent(in) :: judged
      real(dp), intent(in) :: number
      real(dp), intent(in) :: standard_error
      character(:), allocatable :: words

      words = short_text(number, 4)
      if (judged%statistics%periods > 0) words = words//' +- '//error_text(2.0_dp*standard_error, number, 4)
   end function with_scatter

   !> That rigid teeth are no fair assumption; empty where they are, or where the teeth have a stiffness.
   pure function stiffness_warning(scene, when, share) result(warning)
      type(scene_t), intent(in) :: scene
      !> Under which load
      character(*), intent(in) :: when
      !> Share of the film by which the tooth deflects then [-]
      real(dp), intent(in) :: share
      character(:), allocatable :: warning

      warning = ''
      if (deflects_in_words(scene, share) == '') return
      warning = 'warning: '//when//' a steel tooth deflects by '//deflects_in_words(scene, share)//' the film, while these '// &
                'teeth are rigid (stiffness_matters). Elastic teeth may move otherwise, and fall into another class: steel '// &
                'ones have '//steel_stiffness_in_words(scene)
   end function stiffness_warning

   !> By how much of the film a steel tooth would deflect; empty where that is little, or where the teeth have a stiffness.
   pure function deflects_in_words(scene, share) result(words)
      type(scene_t), intent(in) :: scene
      !> Share of the film [-]
      real(dp), intent(in) :: share
      character(:), allocatable :: words

      words = ''
      if (scene%contact%stiffness > 0.0_dp .or. share <= deflection_limit) return
      words = short_text(100.0_dp*share, 2)//' % of'
      if (share > 1.0_dp) words = short_text(share, 2)//' times'
   end function deflects_in_words

   !> The key that makes teeth elastic, with the value of steel.
   pure function steel_stiffness_in_words(scene) result(words)
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: words

      if (scene%gear%given) then
         words = 'gear.tooth_stiffness = '//short_text(steel_tooth, 2)//' N/m2'
      else
         words = 'contact.stiffness = '//short_text(scene%contact%stiffness_of_width(steel_tooth), 2)//' N/m'
      end if
   end function steel_stiffness_in_words

   !> Whether a reader is misled by the samples: by the harmonics where they are theirs, by a series that misses extremes.
   pure logical function has_coarse_series(scene, judged)
      type(scene_t), intent(in) :: scene
      type(judged_scene_t), intent(in) :: judged

      has_coarse_series = judged%series_coarse .and. (.not. judged%rattle%spectrum%sampling_sufficient .or. &
                                                      (scene%output%series .and. judged%series_misses_extremes))
   end function has_coarse_series

   !> The key that gives a series more samples.
   pure function samples_key(scene) result(key)
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: key

      key = 'solver.samples_per_period'
      if (scene%solver%method == method_newmark) key = 'solver.steps_per_period'
   end function samples_key

   !> What samples that are too few for the motion mean, and what to do about it.
   pure function coarse_sentence(scene, judged) result(sentence)
      type(scene_t), intent(in) :: scene
      type(judged_scene_t), intent(in) :: judged
      character(:), allocatable :: sentence
      character(:), allocatable :: key

      key = samples_key(scene)
      if (judged%rattle%spectrum%sampling_sufficient .and. judged%harmonics_by_integrals) then
         sentence = 'the samples of the series are too few for its motion: take peaks from its rows of the extremes, '// &
                    'and harmonics from here, where they are integrals over the steps (series_coarse), or raise '//key// &
                    ', which shows all but the shortest impacts'
         return
      end if
      sentence = 'the samples of the series are too few for its motion; '
      if (.not. judged%rattle%spectrum%sampling_sufficient) then
         sentence = sentence//'the harmonics are those of the samples: raise '//key
      else
         sentence = sentence//key//' = '//integer_text(judged%samples_per_period)//' would do, as many as gave the harmonics here'
      end if
      if (scene%output%series) &
         sentence = sentence//' (series_coarse; the rows of the extremes stand in the series)'
   end function coarse_sentence

   !> Errors by the tighter solution, and the periodic motion.
   subroutine report_verification(log, judged)
      type(log_t), intent(in) :: log
      type(judged_scene_t), intent(in) :: judged

      if (.not. judged%verification%exists) return
      call log%detail('  '//verification_sentence(judged%verification))
      if (size(judged%verification%harmonic_errors) > 0 .and. .not. judged%verification%by_statistics) &
         call log%detail('  error of the film at most '//error_text(judged%verification%film_error, 1.0_dp, digits_of_extremes)// &
                       ' of it, of the extremes of the acceleration '// &
                       error_text(judged%verification%acceleration_minimum_error, &
                                  judged%extremes%lowest(seen_acceleration)%value, digits_of_extremes)//' and '// &
                       error_text(judged%verification%acceleration_maximum_error, &
                                  judged%extremes%highest(seen_acceleration)%value, digits_of_extremes)//' m/s2')
      associate (orbit => judged%orbit)
         if (orbit%period > 0) call log%detail('  the motion repeats after '//integer_text(orbit%period)// &
            trim(merge(' period ', ' periods', orbit%period == 1))//': '//quantity_word(quantity_orbit_stability, &
               nint(quantity_value(quantity_orbit_stability, judged)))// &
                                             ', largest Floquet multiplier '//short_text(abs(orbit%multipliers(1)), 3))
      end associate
      if (orbit_sentence(judged%orbit_outcome) /= '') call log%detail('  '//orbit_sentence(judged%orbit_outcome))
   end subroutine report_verification

   !> A length [m] as a number of micrometres.
   pure function micrometres(length) result(words)
      real(dp), intent(in) :: length
      character(:), allocatable :: words

      words = short_text(1.0e6_dp*length, digits_of_extremes)
   end function micrometres

end module scene_report
