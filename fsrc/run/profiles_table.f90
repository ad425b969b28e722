!> NAME.profiles.rattle of a motion whose films are solved in nodes: pressure, film and viscosity over the contact at chosen times, a
!> row for each node, profile after profile in the order of time.
module profiles_table
   use elastohydrodynamic_closure, only: thicken
   use errors, only: error_t
   use judged_scene, only: judged_scene_t
   use kinds, only: dp, int64
   use nodal_film, only: hertzian_pressure
   use nodal_profiles, only: at_largest_loads, nodal_profile_t, nodal_profiles_t
   use output_place, only: profiles_path
   use problem, only: contact_count
   use result_format, only: column_name_bytes, column_unit_bytes
   use result_writer, only: result_writer_t
   use scene_types, only: scene_t
   implicit none(type, external)
   private

   !> Columns: when, which flank (1 drive, 2 coast) and its load; place, pressure, film and viscosity there, pressure of a dry contact
   !> under this load, and the length that the node counts for in an integral over the contact.
   character(*), parameter :: names(9) = [character(column_name_bytes) :: 'time', 'flank', 'film_load', 'position', 'pressure', &
                                          'film_thickness', 'viscosity', 'hertzian_pressure', 'weight']
   character(*), parameter :: units(9) = [character(column_unit_bytes) :: 's', '-', 'N', 'm', 'Pa', 'm', 'Pa s', 'Pa', 'm']

   public :: write_profiles

contains

   !> Write the profiles beside their place, for place_files to bring them there; without a judged scene there is no row.
   subroutine write_profiles(scene, judged, profiles, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> The scene judged
      type(judged_scene_t), intent(in) :: judged
      !> What was kept of its window
      type(nodal_profiles_t), intent(in) :: profiles
      !> Set if the file cannot be written
      type(error_t), allocatable, intent(out) :: error
      type(result_writer_t) :: writer
      type(nodal_profile_t), allocatable :: chosen(:)
      integer :: i, next

      allocate (chosen(0))
      if (judged%judged) chosen = chosen_profiles(judged, profiles)
      call writer%open(profiles_path(scene), scene%resolved_input, names, units, &
                       size(chosen, kind=int64)*int(judged%nodal%nodes, int64), .false., error)
      do i = 1, size(chosen)
         if (allocated(error)) exit
         next = minloc(chosen%time, dim=1)
         call writer%write_rows(rows_of(judged, profiles, chosen(next)), error)
         chosen(next)%time = huge(1.0_dp)
      end do
      if (.not. allocated(error)) call writer%close(error)
   end subroutine write_profiles

   !> Those at the phases that are asked for, or at the largest load of each impact, of a contact without impacts at its largest load.
   pure function chosen_profiles(judged, profiles) result(chosen)
      type(judged_scene_t), intent(in) :: judged
      type(nodal_profiles_t), intent(in) :: profiles
      type(nodal_profile_t), allocatable :: chosen(:)
      real(dp), allocatable :: times(:)
      integer :: contact

      if (allocated(profiles%phases)) then
         chosen = profiles%kept(:profiles%count)
         return
      end if
      allocate (chosen(0))
      do contact = 1, contact_count(judged%resolved%problem)
         allocate (times(0))
         if (allocated(judged%impacts%contacts(contact)%kept)) times = judged%impacts%contacts(contact)%kept%time
         chosen = [chosen, at_largest_loads(profiles, contact, times, judged%window_periods)]
         deallocate (times)
      end do
   end function chosen_profiles

   !> Rows of a profile.
   pure function rows_of(judged, profiles, profile) result(rows)
      type(judged_scene_t), intent(in) :: judged
      type(nodal_profiles_t), intent(in) :: profiles
      type(nodal_profile_t), intent(in) :: profile
      real(dp), allocatable :: rows(:, :)
      real(dp) :: thickening, slope, x_unit
      integer :: i

      allocate (rows(size(names), size(profile%pressures)))
      associate (grid => profiles%contact%grid, film => judged%resolved%problem%contact%film)
         ! x = R eps X and h = R eps^2 H
         x_unit = sqrt(film%radius*film%closure%film_unit)
         do i = 1, size(profile%pressures)
            call thicken(film%closure, profile%pressures(i), thickening, slope)
            rows(:, i) = [(real(judged%ending%periods - judged%window_periods, dp) + profile%time)/ &
                          judged%resolved%problem%frequency, &
                          real(profile%contact, dp), profile%load*film%closure%load_unit, grid%place(i)*x_unit, &
                          profile%pressures(i)*film%closure%pressure_unit, profile%films(i)*film%closure%film_unit, &
                          film%viscosity*exp(thickening), &
                          hertzian_pressure(grid%place(i), profile%load)*film%closure%pressure_unit, grid%load(i)*x_unit]
         end do
      end associate
   end function rows_of

end module profiles_table
