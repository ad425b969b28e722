!> Result of a scene as the &summary group.
module scene_summary
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use coexisting_motions, only: motions_sentence
   use verification, only: verification_sentence, verification_word
   use errors, only: error_t
   use judged_scene, only: judged_scene_t, quantity_list, quantity_value
   use key_table, only: choice_word
   use kinds, only: dp, int64
   use nodal_orbit, only: orbit_sentence
   use quantities, only: a_code, a_count, a_flag, a_list, part_class, part_cost, part_errors, part_spectrum, part_orbit, &
      part_regime, part_scene, part_window, quantity_code, quantity_film_regime, quantity_harmonics, quantity_law_contradicted, &
      quantity_orbit_period, quantity_t, quantity_table, quantity_word
   use result_reader, only: checksum_of_new_result
   use scene_report, only: acceleration_words, speed_meaning, verdict_sentence
   use scene_status, only: is_success, status_name, status_no_rigid_film, status_not_written, status_sentence
   use scene_types, only: scene_t, task_film
   use summary_file, only: summary_t
   use text, only: stated_error
   use version, only: program_version
   use word_list, only: word_t
   implicit none(type, external)
   private

   public :: write_scene_summary, add_head, add_notes, add_results

contains

   !> Write the summary of a scene beside its place, for place_files to bring it there.
   subroutine write_scene_summary(path, scene, judged, results, seconds, error, motions, profiles)
      !> Path of the summary
      character(*), intent(in) :: path
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Its result
      type(judged_scene_t), intent(in) :: judged
      !> Paths of its series, if it has one
      type(word_t), intent(in) :: results(:)
      !> Wall time [s]
      real(dp), intent(in) :: seconds
      !> Set if the file cannot be written
      type(error_t), allocatable, intent(out) :: error
      !> Path of its table of motions, if it has one
      type(word_t), intent(in) :: motions(:)
      !> Path of its profiles, if it has any
      type(word_t), intent(in) :: profiles(:)
      type(summary_t) :: summary
      integer :: i

      if (judged%judged) call summary%add('verdict_text', verdict_sentence(judged))
      call add_head(summary, scene, judged%status, judged%ending%time)
      call add_results(summary, results, judged%status)
      do i = 1, merge(0, size(motions), judged%status == status_not_written)
         call summary%add('motions_checksum', checksum_of_new_result(motions(i)%text))
      end do
      do i = 1, merge(0, size(profiles), judged%status == status_not_written)
         call summary%add('profiles_checksum', checksum_of_new_result(profiles(i)%text))
      end do
      call summary%add('law', choice_word('film.law', scene%film%law))
      call summary%add('model', choice_word('film.model', scene%film%model))
      if (scene%film%model_words /= '') call summary%add('model_text', trim(scene%film%model_words))
      call summary%add('speed_used', judged%resolved%problem%contact%film%speed)
      call summary%add('speed_meaning', speed_meaning(scene))
      call add_derived(summary, scene)
      call add_part(summary, judged, part_scene)
      if (judged%judged) then
         call add_part(summary, judged, part_window)
         if (judged%rattle%spectrum%moving) call add_part(summary, judged, part_spectrum)
         call add_part(summary, judged, part_class)
         if (judged%verification%exists) then
            call summary%add('verification', verification_word(judged%verification))
            call summary%add('verification_text', verification_sentence(judged%verification))
         end if
         if (allocated(judged%coexisting%motions)) call summary%add('motions_text', motions_sentence(judged%coexisting))
         call add_part(summary, judged, part_errors)
         call add_part(summary, judged, part_orbit)
         if (orbit_sentence(judged%orbit_outcome) /= '') call summary%add('orbit_text', orbit_sentence(judged%orbit_outcome))
         call add_part(summary, judged, part_regime)
      end if
      if (.not. is_success(judged%status) .and. judged%ending%film > 0.0_dp) &
         call summary%add('film_at_status_time', judged%ending%film)
      if (judged%status == status_no_rigid_film) then
         call summary%add('film_regime', &
                          quantity_word(quantity_film_regime, nint(quantity_value(quantity_film_regime, judged))))
         call summary%add('law_contradicted', quantity_value(quantity_law_contradicted, judged) > 0.0_dp)
      end if
      call add_part(summary, judged, part_cost)
      call summary%add('wall_seconds', seconds)
      call summary%write_beside(path, error)
   end subroutine write_scene_summary

   !> What follows from &gear, &shaft and &oil, by the names of the keys that they stand for.
   subroutine add_derived(summary, scene)
      type(summary_t), intent(inout) :: summary
      type(scene_t), intent(in) :: scene

      if (scene%gear%given) then
         call summary%add('profile_shift_sum', scene%teeth%shift_sum)
         call summary%add('contact_ratio', scene%teeth%contact_ratio)
         call summary%add('overlap_ratio', scene%teeth%overlap_ratio)
         call summary%add('radius', scene%contact%radius)
         call summary%add('length', scene%contact%length)
         if (scene%contact%backlash > 0.0_dp) call summary%add('backlash', scene%contact%backlash)
         if (scene%contact%stiffness > 0.0_dp) call summary%add('stiffness', scene%contact%stiffness)
         call summary%add('entrainment_speed', scene%kinematics%entrainment_speed)
         call summary%add('mass', scene%excitation%mass)
         call summary%add('steady_force', scene%excitation%steady_force)
         call summary%add('force_orders', real(scene%excitation%force_orders, dp))
         call summary%add('force_amplitudes', scene%excitation%force_amplitudes)
         call summary%add('force_phases', scene%excitation%force_phases)
         call summary%add('frequency', scene%excitation%frequency)
      end if
      if (scene%oil%given) then
         call summary%add('viscosity', scene%lubricant%viscosity)
         call summary%add('pressure_viscosity', scene%lubricant%pressure_viscosity)
      end if
   end subroutine add_derived

   !> Add the known quantities of a part.
   subroutine add_part(summary, judged, part)
      type(summary_t), intent(inout) :: summary
      type(judged_scene_t), intent(in) :: judged
      !> Part of the summary, a code of module quantities
      integer, intent(in) :: part
      type(quantity_t) :: quantity
      character(:), allocatable :: name
      real(dp) :: value, number
      integer :: i

      do i = 1, size(quantity_table)
         quantity = quantity_table(i)
         if (quantity%part /= part .or. index(quantity%reported_in, 'summary') == 0) cycle
         name = trim(quantity%name)
         if (quantity%kind == a_list) then
            if (part == part_errors) then
               call summary%add(name, stated_errors(i, judged))
            else
               call summary%add(name, quantity_list(i, judged))
            end if
            cycle
         end if
         value = quantity_value(i, judged)
         if (ieee_is_nan(value) .or. (i == quantity_orbit_period .and. value < 1.0_dp)) cycle
         select case (quantity%kind)
         case (a_count)
            call summary%add(name, nint(value, int64))
         case (a_flag)
            call summary%add(name, value > 0.0_dp)
         case (a_code)
            call summary%add(name, quantity_word(i, nint(value)))
         case default
            if (part == part_errors) then
               ! Of a number that is 0 for certain there is no rounding.
               number = number_of_error(name, judged)
               if (max(value, abs(number)) > 0.0_dp) value = stated_error(value, 0.5_dp*spacing(number))
            end if
            call summary%add(name, value)
         end select
      end do
   end subroutine add_part

   !> The number that an error belongs to; 1 for a relative error, which is that of several numbers.
   pure real(dp) function number_of_error(name, judged) result(number)
      !> Name of the error: that of the quantity with _error behind it, where it is that of one quantity
      character(*), intent(in) :: name
      type(judged_scene_t), intent(in) :: judged
      integer :: quantity

      number = 1.0_dp
      quantity = quantity_code(name(:len(name) - len('_error')))
      if (quantity > 0) number = quantity_value(quantity, judged)
   end function number_of_error

   !> The errors of the harmonics, none below the rounding of its harmonic.
   pure function stated_errors(quantity, judged) result(errors)
      !> Code of the list of errors
      integer, intent(in) :: quantity
      type(judged_scene_t), intent(in) :: judged
      real(dp), allocatable :: errors(:)

      errors = quantity_list(quantity, judged)
      associate (numbers => quantity_list(quantity_harmonics, judged))
         errors = stated_error(errors, 0.5_dp*spacing(numbers(:size(errors))))
      end associate
   end function stated_errors

   !> What every summary of a scene begins with.
   subroutine add_head(summary, scene, status, time, sentence)
      !> An empty summary
      type(summary_t), intent(inout) :: summary
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Status of scene_status
      integer, intent(in) :: status
      !> When a motion got it [s]
      real(dp), intent(in), optional :: time
      !> What it means, where the status alone does not say it
      character(*), intent(in), optional :: sentence

      call summary%add('name', trim(scene%name))
      if (scene%gear%name /= '') call summary%add('gear', trim(scene%gear%name))
      call summary%add('program_version', program_version)
      call summary%add('status', status_name(status))
      if (present(time)) call summary%add('status_time', time)
      if (present(sentence)) then
         call summary%add('status_text', sentence)
      else
         call summary%add('status_text', status_sentence(status))
      end if
      call add_notes(summary, scene, scene%warnings)
   end subroutine add_head

   !> What is odd about the input, and what its accelerations are.
   subroutine add_notes(summary, scene, warnings)
      type(summary_t), intent(inout) :: summary
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Of this input; absent where none were looked for
      type(word_t), intent(in), optional :: warnings(:)

      if (present(warnings)) call summary%add('input_warnings', warnings)
      if (scene%gear%given .and. scene%task /= task_film) &
         call summary%add('acceleration_meaning', trim(adjustl(acceleration_words(scene))))
   end subroutine add_notes

   !> The checksums by which a reader knows the results that a summary belongs to: the first is that of NAME.rattle, 0 where the
   !> run has left none, and that of the profiles follows.
   subroutine add_results(summary, results, status)
      type(summary_t), intent(inout) :: summary
      !> Paths of the results that this run has written
      type(word_t), intent(in) :: results(:)
      !> Status of the run; one that could not write its files is known by that alone
      integer, intent(in) :: status
      character(*), parameter :: names(2) = [character(17) :: 'result_checksum', 'profiles_checksum']
      integer :: i

      if (status == status_not_written) return
      if (size(results) == 0) call summary%add(trim(names(1)), 0)
      do i = 1, size(results)
         call summary%add(trim(names(i)), checksum_of_new_result(results(i)%text))
      end do
   end subroutine add_results

end module scene_summary
