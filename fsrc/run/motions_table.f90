!> NAME.motions.rattle: a row for each motion that the starts of a scene lead to, with the state to start it again.
module motions_table
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use coexisting_motions, only: motion_summary_t
   use errors, only: error_t
   use film_state, only: state_number_t
   use judged_scene, only: judged_scene_t
   use kinds, only: dp, int64
   use output_place, only: motions_path
   use problem, only: problem_of, state_numbers
   use result_format, only: column_name_bytes, column_unit_bytes
   use result_writer, only: result_writer_t
   use scene_types, only: scene_t
   implicit none(type, external)
   private

   !> Columns behind the numbers of the state, with their units.
   character(*), parameter :: names(10) = [character(column_name_bytes) :: 'rattle_class', 'orbit_period', 'floquet_modulus', &
                                           'starts', 'start_share', 'from_own_start', 'restarts', 'acceleration_rms', &
                                           'film_force_rms', 'film_minimum']
   character(*), parameter :: units(10) = [character(column_unit_bytes) :: '-', '-', '-', '-', '-', '-', '-', 'm/s2', 'N', 'm']

   public :: write_motions

contains

   !> Write the table beside its place, for place_files to bring it there; without a judged scene it has no row.
   subroutine write_motions(scene, judged, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> With all its motions
      type(judged_scene_t), intent(in) :: judged
      !> Set if the file cannot be written
      type(error_t), allocatable, intent(out) :: error
      type(result_writer_t) :: writer
      type(state_number_t), allocatable :: numbers(:)
      character(column_name_bytes), allocatable :: all_names(:)
      character(column_unit_bytes), allocatable :: all_units(:)
      real(dp), allocatable :: rows(:, :)
      integer :: i, n, states

      numbers = state_numbers(problem_of(scene))
      states = size(numbers)
      n = 0
      if (allocated(judged%coexisting%motions)) n = size(judged%coexisting%motions)
      allocate (all_names(states + size(names)), all_units(states + size(names)), rows(states + size(names), n))
      do i = 1, states
         all_names(i) = numbers(i)%name
         all_units(i) = numbers(i)%unit
      end do
      all_names(states + 1:) = names
      all_units(states + 1:) = units
      do i = 1, n
         rows(:, i) = row_of(judged%coexisting%motions(i), judged%coexisting%starts_solved)
      end do
      call writer%open(motions_path(scene), scene%resolved_input, all_names, all_units, int(n, int64), .false., error)
      if (.not. allocated(error) .and. n > 0) call writer%write_rows(rows, error)
      if (.not. allocated(error)) call writer%close(error)
   end subroutine write_motions

   !> A motion as a row.
   pure function row_of(motion, starts) result(row)
      type(motion_summary_t), intent(in) :: motion
      !> All starts that were solved
      integer, intent(in) :: starts
      real(dp), allocatable :: row(:)
      real(dp) :: modulus

      modulus = motion%floquet_modulus
      if (modulus < 0.0_dp) modulus = ieee_value(modulus, ieee_quiet_nan)
      row = [motion%state, real([motion%class, motion%period], dp), modulus, real(motion%starts, dp), &
             real(motion%starts, dp)/real(starts, dp), merge(1.0_dp, 0.0_dp, [motion%from_own_start, motion%restarts]), &
             motion%acceleration_rms, motion%film_force_rms, motion%film_minimum]
   end function row_of

end module motions_table
