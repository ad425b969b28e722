!> A film task from input to files: every point of the lists, one after the other.
module run_film
   use clock, only: wall_seconds
   use errors, only: error_t
   use flank_elasticity, only: contact_radius, plane_strain_modulus
   use film_point, only: film_contact_t, film_point_t, new_film_point, speed_group_of
   use film_table, only: film_row, film_row_t, profile_names, profile_rows, profile_units
   use finished_files, only: place_files
   use kinds, only: dp, int64
   use log_file, only: log_t
   use output_place, only: log_path, profiles_path, result_path, summary_path
   use result_writer, only: result_writer_t
   use scene_report, only: law_sentence, report_head, speed_meaning
   use scene_status, only: status_complete, status_interrupted, status_not_written, status_sentence
   use scene_summary, only: add_head, add_results
   use scene_types, only: compute_profile, scene_t, speed_sum
   use signals, only: caught_signal
   use summary_file, only: summary_t
   use text, only: integer_text, short_text
   use word_list, only: word_t
   implicit none(type, external)
   private

   !> Rows that are written together.
   integer, parameter :: block = 256

   public :: run_film_task

contains

   !> Run a film task and write its files.
   subroutine run_film_task(scene, quiet, verbose, status, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Nothing to the terminal
      logical, intent(in) :: quiet
      !> All of the log to the terminal
      logical, intent(in) :: verbose
      !> Status of scene_status
      integer, intent(out) :: status
      !> Set if a file could not be written
      type(error_t), allocatable, intent(out) :: error
      type(film_contact_t) :: contact
      type(log_t) :: log
      type(error_t), allocatable :: summary_error
      real(dp) :: started
      integer :: points

      status = status_complete
      started = wall_seconds()
      call log%open(log_path(scene), quiet, error, verbose)
      if (allocated(error)) return
      contact = contact_of(scene)
      call report_head(log, scene, law_sentence(scene))
      call write_points(scene, contact, points, status, error)
      if (allocated(error)) status = status_not_written
      call write_film_summary(scene, points, wall_seconds() - started, status, summary_error)
      if (.not. allocated(error) .and. allocated(summary_error)) call move_alloc(summary_error, error)
      call place_files(result_files(scene), summary_path(scene), error)
      if (allocated(error)) status = status_not_written
      if (allocated(error)) then
         call log%item('error', error%message)
      else
         call log%item('points', integer_text(points)//' in '//short_text(wall_seconds() - started, 3)//' s: '// &
                       status_sentence(status))
         call log%item('files', summary_path(scene)//', .rattle'// &
                       trim(merge(', .profiles.rattle', '                  ', scene%points%compute(compute_profile)))//', .log')
      end if
      call log%close()
   end subroutine run_film_task

   !> All points into the table, and their profiles if asked for.
   subroutine write_points(scene, contact, done, status, error)
      type(scene_t), intent(in) :: scene
      type(film_contact_t), intent(in) :: contact
      integer, intent(out) :: done
      integer, intent(out) :: status
      type(error_t), allocatable, intent(out) :: error
      type(result_writer_t) :: table, profiles
      type(film_point_t) :: point
      type(film_row_t) :: row
      real(dp), allocatable :: rows(:, :), nodes(:, :), groups(:)
      type(error_t), allocatable :: close_error
      integer(int64) :: points
      integer :: i, j, k, filled

      done = 0
      filled = 0
      status = status_complete
      call form_speed_groups(scene, contact, groups)
      point = new_film_point(contact, scene%points%film_ratios(1), scene%points%squeeze_ratios(1), groups(1))
      row = film_row(scene, contact, point)
      allocate (rows(row%count, block), nodes(size(profile_names), scene%points%profile_nodes))
      points = size(groups, kind=int64)*size(scene%points%squeeze_ratios, kind=int64)*size(scene%points%film_ratios, kind=int64)
      call table%open(result_path(scene), scene%resolved_input, row%names(:row%count), row%units(:row%count), points, .true., error)
      if (.not. allocated(error) .and. scene%points%compute(compute_profile)) &
         call profiles%open(profiles_path(scene), scene%resolved_input, profile_names, profile_units, &
                            points*size(nodes, 2, int64), .true., error)
      speeds: do k = 1, size(groups)
         do j = 1, size(scene%points%squeeze_ratios)
            do i = 1, size(scene%points%film_ratios)
               if (allocated(error)) exit speeds
               if (caught_signal() /= 0) then
                  status = status_interrupted
                  exit speeds
               end if
               point = new_film_point(contact, scene%points%film_ratios(i), scene%points%squeeze_ratios(j), groups(k))
               row = film_row(scene, contact, point)
               filled = filled + 1
               rows(:, filled) = row%values(:row%count)
               done = done + 1
               if (filled == block) then
                  call table%write_rows(rows, error)
                  filled = 0
               end if
               if (.not. scene%points%compute(compute_profile) .or. allocated(error)) cycle
               call profile_rows(contact, point, nodes)
               call profiles%write_rows(nodes, error)
            end do
         end do
      end do speeds
      if (.not. allocated(error) .and. filled > 0) call table%write_rows(rows(:, :filled), error)
      call table%close(close_error)
      if (.not. allocated(error) .and. allocated(close_error)) call move_alloc(close_error, error)
      call profiles%close(close_error)
      if (.not. allocated(error) .and. allocated(close_error)) call move_alloc(close_error, error)
   end subroutine write_points

   !> The table, and the profiles if they are asked for.
   pure function result_files(scene) result(paths)
      type(scene_t), intent(in) :: scene
      type(word_t), allocatable :: paths(:)

      ! One by one: gfortran 12 loses the texts of a list that is built of function results.
      allocate (paths(merge(2, 1, scene%points%compute(compute_profile))))
      paths(1)%text = result_path(scene)
      if (size(paths) > 1) paths(2)%text = profiles_path(scene)
   end function result_files

   !> u* as given, or of the speeds.
   pure subroutine form_speed_groups(scene, contact, groups)
      type(scene_t), intent(in) :: scene
      type(film_contact_t), intent(in) :: contact
      real(dp), allocatable, intent(out) :: groups(:)
      real(dp) :: speed

      if (.not. scene%points%from_speeds) then
         groups = scene%points%speed_groups
         return
      end if
      speed = scene%kinematics%entrainment_speed
      if (scene%points%speed_reading == speed_sum) speed = 2.0_dp*speed
      groups = [speed_group_of(contact, speed)]
   end subroutine form_speed_groups

   !> Contact and oil of a scene.
   pure function contact_of(scene) result(contact)
      type(scene_t), intent(in) :: scene
      type(film_contact_t) :: contact

      contact%radius = contact_radius(scene%contact)
      contact%length = scene%contact%length
      contact%modulus = plane_strain_modulus(scene%contact%young_modulus, scene%contact%poisson_ratio)
      contact%viscosity = scene%lubricant%viscosity
      contact%pressure_viscosity = scene%lubricant%pressure_viscosity
   end function contact_of

   !> What the task did.
   subroutine write_film_summary(scene, points, seconds, status, error)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: points
      real(dp), intent(in) :: seconds
      integer, intent(in) :: status
      type(error_t), allocatable, intent(out) :: error
      type(summary_t) :: summary

      call add_head(summary, scene, status)
      call add_results(summary, result_files(scene), status)
      call summary%add('points', points)
      call summary%add('speed_meaning', speed_meaning(scene))
      call summary%add('sign_convention', 'stiffness -dW/dh0, damping -dW/dw: positive where the film resists')
      call summary%add('wall_seconds', seconds)
      call summary%write_beside(summary_path(scene), error)
   end subroutine write_film_summary

end module run_film
