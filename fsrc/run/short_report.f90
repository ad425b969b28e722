!> What the terminal shows of a scene: the verdict first, a line for each thing that a reader asks next, at most 15 lines. The log
!> has all of it.
module short_report
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use coexisting_motions, only: motions_in_short
   use doubt, only: doubt_sentence
   use judged_scene, only: judged_scene_t, quantity_value
   use kinds, only: dp
   use log_file, only: log_t
   use node_extremes, only: seen_acceleration, seen_films
   use nodal_orbit, only: orbit_sentence
   use output_place, only: has_motions_table, log_path, summary_path
   use quantities, only: quantity_alpha_p_maximum, quantity_closure_range, quantity_code, quantity_damping_ratio, &
      quantity_deflection_share, quantity_drag_bearing, quantity_drag_churning, quantity_drag_synchroniser, quantity_drag_torque, &
      quantity_film_regime, quantity_inertia_ratio, quantity_load_maximum, quantity_model_limit, quantity_natural_frequency, &
      quantity_orbit_stability, quantity_steady_film, quantity_table, quantity_word
   use rattle_class, only: class_irregular, class_irregular_so_far
   use regime_check, only: fitting_law, gap_both, gap_too_narrow, gap_too_wide, outside_closure
   use scene_report, only: acceleration_in_short, deflects_in_words, film_force_in_short, has_coarse_series, is_warning, &
      note_in_short, operating_point, samples_key, steel_stiffness_in_words, value_words, verdict_in_short
   use scene_status, only: is_success, status_name, status_sentence
   use scene_types, only: scene_t
   use text, only: counted, error_text, integer_text, short_text
   use word_list, only: word_t
   implicit none(type, external)
   private

   !> Lines of warnings: fifteen in all, less the twelve that a scene has else; of a gear pair its drag takes one more.
   integer, parameter :: most_warnings = 3
   !> Significant digits of films and accelerations, as in the log, and of loads and velocities
   integer, parameter :: digits_of_extremes = 5, digits = 4

   public :: report_short

contains

   !> The verdict, how hard, how sure, from what, which files, which warnings. Of a pair of a gearbox no more than its table lacks.
   subroutine report_short(log, scene, judged)
      !> Log of the scene
      type(log_t), intent(in) :: log
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Its result
      type(judged_scene_t), intent(in) :: judged
      logical :: in_table

      in_table = scene%gearbox /= ''
      if (judged%judged) call log%row('verdict', verdict_in_short(judged))
      if (.not. in_table) call log%row('operating point', operating_point(scene))
      if (.not. is_success(judged%status)) then
         call log%row('ended', status_name(judged%status)//' at t = '//short_text(judged%ending%time, 6)//' s')
         call log%row('', status_sentence(judged%status))
      end if
      if (judged%judged) then
         if (.not. in_table) call report_strength(log, scene, judged)
         call log%row('impacts', impact_words(judged))
         if (.not. in_table) call report_film(log, judged)
         if (.not. in_table) call report_certainty(log, judged)
         if (motions_in_short(judged%coexisting) /= '') call log%row('motions', motions_in_short(judged%coexisting))
      end if
      if (.not. in_table) call report_rest(log, judged)
      call log%row('files', file_words(scene))
      call report_warnings(log, scene, judged)
   end subroutine report_short

   !> How hard the motion is for the bearings, and how it shakes.
   subroutine report_strength(log, scene, judged)
      type(log_t), intent(in) :: log
      type(scene_t), intent(in) :: scene
      type(judged_scene_t), intent(in) :: judged
      character(:), allocatable :: relative

      relative = ''
      if (scene%gear%given) relative = ', relative to the shaft'
      call log%row('film force', film_force_in_short(judged)//' N rms, largest load '// &
                   short_text(quantity_value(quantity_load_maximum, judged), digits)//' N')
      associate (lowest => judged%extremes%lowest(seen_acceleration), highest => judged%extremes%highest(seen_acceleration))
         call log%row('acceleration', acceleration_in_short(judged)//', '//short_text(lowest%value, digits_of_extremes)// &
                      ' to '//short_text(highest%value, digits_of_extremes)//' m/s2'//relative)
      end associate
   end subroutine report_strength

   !> Impacts a period of the force by flank, and the largest speed of approach.
   pure function impact_words(judged) result(words)
      type(judged_scene_t), intent(in) :: judged
      character(:), allocatable :: words
      character(*), parameter :: sides(2) = ['drive', 'coast']
      real(dp) :: rate, velocity, fastest
      integer :: i

      words = ''
      fastest = 0.0_dp
      do i = 1, size(sides)
         rate = quantity_value(quantity_code('impacts_per_period_'//sides(i)), judged)
         ! Of a side without impacts, or that is none, the rate is 0 or unknown.
         if (.not. rate > 0.0_dp) cycle
         velocity = quantity_value(quantity_code('impact_velocity_maximum_'//sides(i)), judged)
         if (len(words) > 0) then
            words = words//', '//short_text(rate, 3)
         else
            words = short_text(rate, 3)//' a period'
         end if
         words = words//' on the '//sides(i)//' flank'
         fastest = max(fastest, velocity)
      end do
      if (len(words) > 0) then
         words = words//', approach up to '//short_text(fastest, digits)//' m/s'
      else
         words = 'none'
      end if
   end function impact_words

   !> The film, and what its pressure makes of it.
   subroutine report_film(log, judged)
      type(log_t), intent(in) :: log
      type(judged_scene_t), intent(in) :: judged

      associate (lowest => judged%extremes%lowest(seen_films(1))%value, highest => judged%extremes%highest(seen_films(1))%value)
         call log%row('film', short_text(1.0e6_dp*lowest, digits_of_extremes)//' to '// &
                      short_text(1.0e6_dp*highest, digits_of_extremes)//' um, '// &
                      quantity_word(quantity_film_regime, nint(quantity_value(quantity_film_regime, judged)))// &
                      ' at alpha p up to '//short_text(quantity_value(quantity_alpha_p_maximum, judged), 3))
      end associate
   end subroutine report_film

   !> How far the numbers can be trusted, and whether the motion repeats.
   subroutine report_certainty(log, judged)
      type(log_t), intent(in) :: log
      type(judged_scene_t), intent(in) :: judged

      associate (verification => judged%verification, lowest => judged%extremes%lowest(seen_acceleration)%value, &
                 highest => judged%extremes%highest(seen_acceleration)%value)
         if (verification%exists .and. .not. verification%verified) then
            call log%row('doubt', doubt_sentence(verification%doubt))
         else if (verification%exists .and. size(verification%harmonic_errors) > 0 .and. .not. verification%by_statistics) then
            call log%row('errors', error_text(verification%film_error, 1.0_dp, digits_of_extremes)//' of the film, '// &
                         error_text(verification%acceleration_minimum_error, lowest, digits_of_extremes)//' and '// &
                         error_text(verification%acceleration_maximum_error, highest, digits_of_extremes)// &
                         ' m/s2 of the extremes of the acceleration')
         end if
      end associate
      associate (orbit => judged%orbit)
         if (orbit%period > 0) then
            call log%row('repeats', 'after '//counted(orbit%period, 'period')//', '//quantity_word(quantity_orbit_stability, &
                         nint(quantity_value(quantity_orbit_stability, judged)))//', largest Floquet multiplier '// &
                         short_text(abs(orbit%multipliers(1)), 3))
         else if (judged%statistics%periods > 0) then
            call log%row('repeats', 'not within '//counted(judged%statistics%periods, 'period')//'; +- are two standard errors')
         else if (any(judged%rattle%class == [class_irregular, class_irregular_so_far])) then
            call log%row('repeats', 'not within '//counted(judged%window_periods, 'period'))
         else if (orbit_sentence(judged%orbit_outcome) /= '') then
            call log%row('repeats', orbit_sentence(judged%orbit_outcome))
         end if
      end associate
   end subroutine report_certainty

   !> What the input amounts to before anything moves.
   subroutine report_rest(log, judged)
      type(log_t), intent(in) :: log
      type(judged_scene_t), intent(in) :: judged
      character(:), allocatable :: words

      words = 'no rigid piezo-viscous film carries the static load'
      if (judged%resolved%steady_film > 0.0_dp) then
         words = 'steady film '//known(quantity_steady_film)//', overdamped'
         if (judged%resolved%natural_frequency > 0.0_dp) words = 'steady film '//known(quantity_steady_film)// &
            ', natural frequency '//known(quantity_natural_frequency)//', damping ratio '//known(quantity_damping_ratio)
      end if
      call log%row('at rest', words)
      if (known(quantity_drag_torque) == '') return
      words = known(quantity_drag_torque)
      if (known(quantity_drag_bearing) /= '') words = words//': bearing '//number(quantity_drag_bearing)//', synchroniser '// &
         number(quantity_drag_synchroniser)//', churning '//number(quantity_drag_churning)
      if (known(quantity_inertia_ratio) /= '') words = words//'; inertia ratio '//known(quantity_inertia_ratio)
      call log%row('drag', words)

   contains

      !> A quantity with its unit; empty where it is unknown.
      pure function known(quantity) result(words)
         integer, intent(in) :: quantity
         character(:), allocatable :: words

         words = ''
         if (.not. ieee_is_nan(quantity_value(quantity, judged))) words = value_words(quantity, quantity_value(quantity, judged))
      end function known

      !> A quantity whose unit is clear.
      pure function number(quantity) result(words)
         integer, intent(in) :: quantity
         character(:), allocatable :: words

         words = short_text(quantity_value(quantity, judged), quantity_table(quantity)%digits)
      end function number

   end subroutine report_rest

   !> The summary by its path, the other files of the same name by their ends.
   pure function file_words(scene) result(words)
      type(scene_t), intent(in) :: scene
      character(:), allocatable :: words

      words = summary_path(scene)
      if (scene%output%series) words = words//', .rattle'
      if (has_motions_table(scene)) words = words//', .motions.rattle'
      if (scene%output%profiles) words = words//', .profiles.rattle'
      words = words//', .log'
   end function file_words

   !> What is doubtful about model and input, each by the quantity of the summary that says it and the key that changes it.
   subroutine report_warnings(log, scene, judged)
      type(log_t), intent(in) :: log
      type(scene_t), intent(in) :: scene
      type(judged_scene_t), intent(in) :: judged
      type(word_t), allocatable :: warnings(:)
      integer :: i, certain, shown, most

      allocate (warnings(0))
      ! What is left over is what matters least.
      do i = 1, size(scene%warnings)
         associate (note => scene%warnings(i)%text)
            if (is_warning(note)) call add(note_in_short(note))
         end associate
      end do
      if (judged%judged) call add_doubts()
      certain = size(warnings)
      do i = 1, size(scene%warnings)
         associate (note => scene%warnings(i)%text)
            if (.not. is_warning(note)) call add(note_in_short(note))
         end associate
      end do
      shown = size(warnings)
      most = most_warnings - merge(1, 0, scene%gear%given)
      if (shown > most) shown = most - 1
      do i = 1, shown
         call log%row(trim(merge('warning', 'input  ', i <= certain)), warnings(i)%text)
      end do
      if (size(warnings) > shown) call log%row('warning', integer_text(size(warnings) - shown)//' more in '//log_path(scene))

   contains

      subroutine add_doubts()
         select case (nint(quantity_value(quantity_model_limit, judged)))
         case (gap_too_wide)
            call add('model_limit: the film grows beyond a tenth of the radius, where a line contact ends')
         case (gap_too_narrow)
            call add('model_limit: the film falls below 1 nm, where no oil film is left')
         case (gap_both)
            call add('model_limit: the film grows beyond a tenth of the radius and falls below 1 nm')
         case default
            ! Within the model there is nothing to say.
         end select
         if (judged%regime%law_contradicted) &
            call add('law_contradicted: film.law does not fit this regime; '//fitting_law(judged%regime%regime))
         ! Of films that do not bend it is not a number.
         if (quantity_value(quantity_closure_range, judged) >= real(outside_closure, dp)) &
            call add("closure_range: the film is extrapolated; film.model = 'resolved' solves it")
         if (deflects_in_words(scene, quantity_value(quantity_deflection_share, judged)) /= '') &
            call add('stiffness_matters: steel deflects '// &
                     deflects_in_words(scene, quantity_value(quantity_deflection_share, judged))//' the film; '// &
                     steel_stiffness_in_words(scene))
         if (has_coarse_series(scene, judged)) &
            call add('series_coarse: there are too few samples for this motion; raise '//samples_key(scene))
      end subroutine add_doubts

      subroutine add(text)
         character(*), intent(in) :: text
         type(word_t), allocatable :: longer(:)
         integer :: k

         ! One by one: gfortran 12 loses the texts of a list that is built of function results.
         allocate (longer(size(warnings) + 1))
         do k = 1, size(warnings)
            longer(k)%text = warnings(k)%text
         end do
         longer(size(longer))%text = text
         call move_alloc(longer, warnings)
      end subroutine add

   end subroutine report_warnings

end module short_report
