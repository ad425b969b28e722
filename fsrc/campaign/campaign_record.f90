!> What is recorded of every scene of a campaign: columns, and the row of a scene. NaN: unknown.
module campaign_record
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use key_table, only: keys
   use kinds, only: dp, int64
   use lane_scenes, only: lane_ending_t
   use rattle_class, only: rattle_verdict_t
   use regime_check, only: regime_verdict_t
   use resolved_scene, only: resolved_scene_t
   use result_format, only: column_name_bytes, column_unit_bytes
   use scene_types, only: scene_t
   use text, only: integer_text
   use varied_keys, only: varied_key_name
   implicit none(type, external)
   private

   !> Harmonics that are recorded.
   integer, parameter :: recorded_harmonics = 8

   !> Quantities by their codes; the words stand in the key table.
   integer, parameter, public :: needs_nothing = 0, needs_spectrum = 1, needs_regime = 2

   !> A judged scene. Parts that no column asks for are left as they are.
   type, public :: judged_scene_t
      logical :: success = .false.
      type(lane_ending_t) :: ending
      type(resolved_scene_t) :: resolved
      type(rattle_verdict_t) :: rattle
      type(regime_verdict_t) :: regime
      !> Extremes of the window
      real(dp) :: film_minimum = 0.0_dp, film_maximum = 0.0_dp, acceleration_minimum = 0.0_dp, acceleration_maximum = 0.0_dp
   end type judged_scene_t

   public :: record_columns, record_row, need_of

contains

   !> Names and units of the columns: scene, varied keys, status, then what is recorded.
   pure subroutine record_columns(scene, positions, names, units)
      !> Checked base scene
      type(scene_t), intent(in) :: scene
      !> Varied keys by their position in the key table
      integer, intent(in) :: positions(:)
      !> Names
      character(column_name_bytes), allocatable, intent(out) :: names(:)
      !> Units
      character(column_unit_bytes), allocatable, intent(out) :: units(:)
      integer :: i, n

      allocate (names(0), units(0))
      call put(names, units, 'scene', '-')
      do i = 1, size(positions)
         call put(names, units, varied_key_name(positions(i)), keys(positions(i))%unit)
      end do
      call put(names, units, 'status', '-')
      do i = 1, size(scene%campaign%record)
         if (scene%campaign%record(i)%text == 'harmonics') then
            do n = 1, recorded_harmonics
               call put(names, units, 'harmonic_'//integer_text(n), 'm/s2')
            end do
         else
            call put(names, units, scene%campaign%record(i)%text, unit_of(scene%campaign%record(i)%text))
         end if
      end do

   end subroutine record_columns

   !> Append a column.
   pure subroutine put(names, units, name, unit)
      character(column_name_bytes), allocatable, intent(inout) :: names(:)
      character(column_unit_bytes), allocatable, intent(inout) :: units(:)
      character(*), intent(in) :: name
      character(*), intent(in) :: unit
      character(column_name_bytes) :: full_name
      character(column_unit_bytes) :: full_unit

      full_name = name
      full_unit = unit
      names = [names, full_name]
      units = [units, full_unit]
   end subroutine put

   !> Unit of a recorded quantity.
   pure function unit_of(name) result(unit)
      character(*), intent(in) :: name
      character(:), allocatable :: unit

      select case (name)
      case ('film_minimum', 'film_maximum', 'steady_film', 'deflection')
         unit = 'm'
      case ('acceleration_minimum', 'acceleration_maximum')
         unit = 'm/s2'
      case ('natural_frequency')
         unit = 'Hz'
      case ('pressure_maximum')
         unit = 'Pa'
      case default
         unit = '-'
      end select
   end function unit_of

   !> What has to be computed for a recorded quantity.
   pure integer function need_of(name)
      !> Name of the quantity
      character(*), intent(in) :: name

      select case (name)
      case ('line_count', 'harmonic_distortion', 'irregular_fraction', 'reversals_per_period', 'rattle_class', 'harmonics', &
            'sampling_sufficient')
         need_of = needs_spectrum
      case ('film_regime', 'law_contradicted', 'alpha_p_maximum', 'pressure_maximum', 'deflection')
         need_of = needs_regime
      case default
         need_of = needs_nothing
      end select
   end function need_of

   !> Row of a scene.
   pure subroutine record_row(scene, number, values, judged, row)
      !> Base scene, for the choice of columns
      type(scene_t), intent(in) :: scene
      !> Number of the scene, from 1
      integer(int64), intent(in) :: number
      !> Values of the varied keys
      real(dp), intent(in) :: values(:)
      !> The judged scene
      type(judged_scene_t), intent(in) :: judged
      !> The row
      real(dp), intent(out) :: row(:)
      real(dp) :: unknown
      integer :: i, column

      unknown = ieee_value(unknown, ieee_quiet_nan)
      row(1) = real(number, dp)
      row(2:1 + size(values)) = values
      column = 2 + size(values)
      row(column) = real(judged%ending%status, dp)
      do i = 1, size(scene%campaign%record)
         if (scene%campaign%record(i)%text == 'harmonics') then
            row(column + 1:column + recorded_harmonics) = unknown
            if (judged%success) row(column + 1:column + recorded_harmonics) = &
               judged%rattle%lines%harmonics(:recorded_harmonics)
            column = column + recorded_harmonics
         else
            column = column + 1
            row(column) = value_of(scene%campaign%record(i)%text, judged, unknown)
         end if
      end do
   end subroutine record_row

   !> Value of a recorded quantity.
   pure real(dp) function value_of(name, judged, unknown) result(value)
      character(*), intent(in) :: name
      type(judged_scene_t), intent(in) :: judged
      real(dp), intent(in) :: unknown

      value = unknown
      select case (name)
      case ('steady_film')
         if (judged%resolved%steady_film > 0.0_dp) value = judged%resolved%steady_film
      case ('natural_frequency')
         if (judged%resolved%steady_film > 0.0_dp) value = judged%resolved%natural_frequency
      case ('damping_ratio')
         if (judged%resolved%steady_film > 0.0_dp) value = judged%resolved%damping_ratio
      case ('periods_solved')
         value = real(judged%ending%periods, dp)
      case ('orbit_period')
         value = real(judged%ending%orbit, dp)
      case default
         if (judged%success) value = window_value(name, judged, unknown)
      end select
   end function value_of

   !> Value of a quantity that rests on the window.
   pure real(dp) function window_value(name, judged, unknown) result(value)
      character(*), intent(in) :: name
      type(judged_scene_t), intent(in) :: judged
      real(dp), intent(in) :: unknown

      value = unknown
      associate (lines => judged%rattle%lines, regime => judged%regime)
         select case (name)
         case ('film_minimum')
            value = judged%film_minimum
         case ('film_maximum')
            value = judged%film_maximum
         case ('acceleration_minimum')
            value = judged%acceleration_minimum
         case ('acceleration_maximum')
            value = judged%acceleration_maximum
         case ('line_count')
            if (lines%moving) value = real(lines%line_count, dp)
         case ('harmonic_distortion')
            if (lines%moving) value = lines%harmonic_distortion
         case ('irregular_fraction')
            if (lines%moving) value = lines%irregular_fraction
         case ('reversals_per_period')
            value = judged%rattle%reversals_per_period
         case ('rattle_class')
            value = real(judged%rattle%class, dp)
         case ('sampling_sufficient')
            value = merge(1.0_dp, 0.0_dp, lines%sampling_sufficient)
         case ('film_regime')
            value = real(regime%regime, dp)
         case ('law_contradicted')
            value = merge(1.0_dp, 0.0_dp, regime%law_contradicted)
         case ('alpha_p_maximum')
            value = regime%alpha_p_maximum
         case ('pressure_maximum')
            if (regime%pressure_exists) value = regime%pressure_maximum
         case ('deflection')
            value = regime%deflection
         case default
            value = unknown
         end select
      end associate
   end function window_value

end module campaign_record
