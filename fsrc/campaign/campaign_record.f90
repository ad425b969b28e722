!> What is recorded of every scene of a campaign: columns, and the row of a scene. NaN: unknown.
module campaign_record
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use key_table, only: keys
   use kinds, only: dp, int64
   use lane_scenes, only: lane_ending_t
   use node_extremes, only: seen_acceleration, seen_film, seen_load, seen_velocity
   use rattle_class, only: rattle_verdict_t
   use recorded_quantities, only: quantities, record_acceleration_maximum, record_acceleration_minimum, record_alpha_p_maximum, &
                                  record_certified, record_damping_ratio, record_deflection, record_film_maximum, &
                                  record_film_minimum, record_film_regime, record_harmonic_distortion, record_harmonics, &
                                  record_irregular_fraction, record_law_contradicted, record_line_count, &
                                  record_line_count_is_bound, record_load_maximum, record_model_limit, record_natural_frequency, &
                                  record_orbit_period, record_periods_solved, record_pressure_maximum, record_rattle_class, &
                                  record_reversals_per_period, record_sampling_sufficient, record_steady_film, &
                                  record_velocity_maximum, record_velocity_minimum
   use regime_check, only: model_limit, regime_verdict_t
   use resolved_scene, only: resolved_scene_t
   use result_format, only: column_name_bytes, column_unit_bytes
   use scene_types, only: scene_t
   use text, only: integer_text
   use varied_keys, only: varied_key_name
   use window_extremes, only: window_extremes_t
   implicit none(type, external)
   private

   !> Harmonics that are recorded.
   integer, parameter :: recorded_harmonics = 8

   !> A judged scene. Parts that no column asks for, or that its ending leaves unknown, are those of the scene before.
   type, public :: judged_scene_t
      logical :: success = .false.
      type(lane_ending_t) :: ending
      type(resolved_scene_t) :: resolved
      type(rattle_verdict_t) :: rattle
      type(regime_verdict_t) :: regime
      !> Extremes of the window
      type(window_extremes_t) :: extremes
      !> Whether the class stands when the scene is solved tighter
      logical :: certified = .false.
   end type judged_scene_t

   public :: record_columns, record_row

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
         associate (quantity => quantities(scene%campaign%record(i)))
            if (quantity%code == record_harmonics) then
               do n = 1, recorded_harmonics
                  call put(names, units, 'harmonic_'//integer_text(n), quantity%unit)
               end do
            else
               call put(names, units, quantity%name, quantity%unit)
            end if
         end associate
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
         if (scene%campaign%record(i) == record_harmonics) then
            row(column + 1:column + recorded_harmonics) = unknown
            if (judged%success) row(column + 1:column + recorded_harmonics) = &
               judged%rattle%lines%harmonics(:recorded_harmonics)
            column = column + recorded_harmonics
         else
            column = column + 1
            row(column) = value_of(scene%campaign%record(i), judged, unknown)
         end if
      end do
   end subroutine record_row

   !> Value of a recorded quantity.
   pure real(dp) function value_of(code, judged, unknown) result(value)
      integer, intent(in) :: code
      type(judged_scene_t), intent(in) :: judged
      real(dp), intent(in) :: unknown

      value = unknown
      select case (code)
      case (record_steady_film)
         if (judged%resolved%steady_film > 0.0_dp) value = judged%resolved%steady_film
      case (record_natural_frequency)
         if (judged%resolved%steady_film > 0.0_dp) value = judged%resolved%natural_frequency
      case (record_damping_ratio)
         if (judged%resolved%steady_film > 0.0_dp) value = judged%resolved%damping_ratio
      case (record_periods_solved)
         value = real(judged%ending%periods, dp)
      case (record_orbit_period)
         value = real(judged%ending%orbit, dp)
      case default
         if (judged%success) value = window_value(code, judged, unknown)
      end select
   end function value_of

   !> Value of a quantity that rests on the window.
   pure real(dp) function window_value(code, judged, unknown) result(value)
      integer, intent(in) :: code
      type(judged_scene_t), intent(in) :: judged
      real(dp), intent(in) :: unknown

      value = unknown
      associate (lines => judged%rattle%lines, regime => judged%regime)
         select case (code)
         case (record_film_minimum)
            value = judged%extremes%lowest(seen_film)%value
         case (record_film_maximum)
            value = judged%extremes%highest(seen_film)%value
         case (record_acceleration_minimum)
            value = judged%extremes%lowest(seen_acceleration)%value
         case (record_acceleration_maximum)
            value = judged%extremes%highest(seen_acceleration)%value
         case (record_line_count)
            if (lines%moving) value = real(lines%line_count, dp)
         case (record_harmonic_distortion)
            if (lines%moving) value = lines%harmonic_distortion
         case (record_irregular_fraction)
            if (lines%moving) value = lines%irregular_fraction
         case (record_reversals_per_period)
            value = judged%rattle%reversals_per_period
         case (record_rattle_class)
            value = real(judged%rattle%class, dp)
         case (record_sampling_sufficient)
            value = merge(1.0_dp, 0.0_dp, lines%sampling_sufficient)
         case (record_film_regime)
            value = real(regime%regime, dp)
         case (record_law_contradicted)
            value = merge(1.0_dp, 0.0_dp, regime%law_contradicted)
         case (record_alpha_p_maximum)
            value = regime%alpha_p_maximum
         case (record_pressure_maximum)
            if (regime%pressure_exists) value = regime%pressure_maximum
         case (record_deflection)
            value = regime%deflection
         case (record_velocity_minimum)
            value = judged%extremes%lowest(seen_velocity)%value
         case (record_velocity_maximum)
            value = judged%extremes%highest(seen_velocity)%value
         case (record_load_maximum)
            value = judged%extremes%highest(seen_load)%value
         case (record_model_limit)
            value = real(model_limit(judged%extremes%lowest(seen_film)%value, judged%extremes%highest(seen_film)%value, &
                                     judged%resolved%film%radius), dp)
         case (record_line_count_is_bound)
            value = merge(1.0_dp, 0.0_dp, lines%count_is_bound)
         case (record_certified)
            value = merge(1.0_dp, 0.0_dp, judged%certified)
         case default
            continue
         end select
      end associate
   end function window_value

end module campaign_record
