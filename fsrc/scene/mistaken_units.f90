!> Numbers that were surely meant in another unit: the one table of such mistakes. A number is one where it is not what machines
!> have, and would be if it were in the other unit.
module mistaken_units
   use constants, only: pi
   use input_key, only: is_sensible, key_t, sensible_text
   use kinds, only: dp
   use text, only: real_text, short_text
   implicit none(type, external)
   private

   !> A unit that is taken for that of a key.
   type :: mistake_t
      character(12) :: group
      character(24) :: name
      !> What the number may have been meant in
      character(16) :: unit
      !> The number times this is in the unit of the key
      real(dp) :: factor
      !> What machines have, by size, in the unit of the key; 0 is no mistake
      real(dp) :: lower, upper
      !> Added behind the factor
      real(dp) :: offset = 0.0_dp
   end type mistake_t

   real(dp), parameter :: degree = pi/180.0_dp, turn_per_minute = pi/30.0_dp, milli = 1.0e-3_dp, micro = 1.0e-6_dp
   !> No phase needs to be larger [rad]
   real(dp), parameter :: whole_turn = 6.3_dp
   !> Density that turns a dynamic viscosity into that of a data sheet [kg/m3]
   real(dp), parameter :: usual_density = 870.0_dp

   type(mistake_t), parameter :: mistakes(*) = [ &
      mistake_t('contact', 'radius', 'mm', milli, 1.0e-4_dp, 1.0_dp), &
      mistake_t('contact', 'radius_1', 'mm', milli, 1.0e-4_dp, 10.0_dp), &
      mistake_t('contact', 'radius_2', 'mm', milli, 1.0e-4_dp, 10.0_dp), &
      mistake_t('contact', 'length', 'mm', milli, 1.0e-4_dp, 1.0_dp), &
      mistake_t('contact', 'young_modulus', 'GPa', 1.0e9_dp, 1.0e9_dp, 1.0e12_dp), &
      mistake_t('contact', 'young_modulus', 'MPa', 1.0e6_dp, 1.0e9_dp, 1.0e12_dp), &
      mistake_t('contact', 'backlash', 'um', micro, 1.0e-6_dp, 5.0e-3_dp), &
      mistake_t('contact', 'backlash', 'mm', milli, 1.0e-6_dp, 5.0e-3_dp), &
      mistake_t('contact', 'stiffness', 'N/um', 1.0e6_dp, 1.0e6_dp, 1.0e10_dp), &
      mistake_t('contact', 'stiffness', 'N/mm', 1.0e3_dp, 1.0e6_dp, 1.0e10_dp), &
      mistake_t('lubricant', 'viscosity', 'mPa s', milli, 1.0e-4_dp, 20.0_dp), &
      mistake_t('lubricant', 'pressure_viscosity', '1/GPa', 1.0e-9_dp, 1.0e-10_dp, 1.0e-7_dp), &
      mistake_t('lubricant', 'pressure_viscosity', '1/MPa', 1.0e-6_dp, 1.0e-10_dp, 1.0e-7_dp), &
      mistake_t('kinematics', 'entrainment_speed', 'mm/s', milli, 1.0e-3_dp, 300.0_dp), &
      mistake_t('kinematics', 'rolling_speed', 'mm/s', milli, 2.0e-3_dp, 600.0_dp), &
      mistake_t('kinematics', 'surface_speed_1', 'mm/s', milli, 1.0e-3_dp, 300.0_dp), &
      mistake_t('kinematics', 'surface_speed_2', 'mm/s', milli, 1.0e-3_dp, 300.0_dp), &
      mistake_t('load', 'mass', 'g', milli, 1.0e-4_dp, 1.0e3_dp), &
      mistake_t('load', 'force_phases', 'deg', degree, 0.0_dp, whole_turn), &
      mistake_t('load', 'gravity', 'mm/s2', milli, 0.0_dp, 100.0_dp), &
      mistake_t('film', 'initial_film', 'um', micro, 1.0e-10_dp, 1.0e-2_dp), &
      mistake_t('film', 'initial_velocity', 'mm/s', milli, 0.0_dp, 100.0_dp), &
      mistake_t('gear', 'normal_module', 'mm', milli, 3.0e-4_dp, 0.05_dp), &
      mistake_t('gear', 'pressure_angle_deg', 'rad', 1.0_dp/degree, 10.0_dp, 30.0_dp), &
      mistake_t('gear', 'helix_angle_deg', 'rad', 1.0_dp/degree, 2.0_dp, 50.0_dp), &
      mistake_t('gear', 'face_width', 'mm', milli, 1.0e-3_dp, 0.5_dp), &
      mistake_t('gear', 'centre_distance', 'mm', milli, 5.0e-3_dp, 2.0_dp), &
      mistake_t('gear', 'contact_position', 'mm', milli, 0.0_dp, 0.1_dp), &
      mistake_t('gear', 'tip_diameter_1', 'mm', milli, 5.0e-3_dp, 2.0_dp), &
      mistake_t('gear', 'tip_diameter_2', 'mm', milli, 5.0e-3_dp, 2.0_dp), &
      mistake_t('gear', 'loose_inertia', 'kg cm2', 1.0e-4_dp, 5.0e-6_dp, 0.1_dp), &
      mistake_t('gear', 'loose_inertia', 'kg mm2', micro, 5.0e-6_dp, 0.1_dp), &
      mistake_t('gear', 'drag_torque', 'N mm', milli, 0.0_dp, 10.0_dp), &
      mistake_t('gear', 'bearing_mean_diameter', 'mm', milli, 2.0e-3_dp, 1.0_dp), &
      mistake_t('gear', 'bearing_width', 'mm', milli, 1.0e-3_dp, 0.5_dp), &
      mistake_t('gear', 'bearing_clearance', 'um', micro, 1.0e-6_dp, 1.0e-3_dp), &
      mistake_t('gear', 'bearing_clearance', 'mm', milli, 1.0e-6_dp, 1.0e-3_dp), &
      mistake_t('gear', 'synchroniser_diameter', 'mm', milli, 5.0e-3_dp, 1.0_dp), &
      mistake_t('gear', 'synchroniser_width', 'mm', milli, 5.0e-4_dp, 0.2_dp), &
      mistake_t('gear', 'synchroniser_gap', 'um', micro, 1.0e-5_dp, 5.0e-3_dp), &
      mistake_t('gear', 'synchroniser_gap', 'mm', milli, 1.0e-5_dp, 5.0e-3_dp), &
      mistake_t('gear', 'immersion_depth', 'mm', milli, 0.0_dp, 1.0_dp), &
      mistake_t('gear', 'backlash', 'um', micro, 1.0e-6_dp, 5.0e-3_dp), &
      mistake_t('gear', 'backlash', 'mm', milli, 1.0e-6_dp, 5.0e-3_dp), &
      mistake_t('gear', 'tooth_stiffness', 'N/(mm um)', 1.0e9_dp, 1.0e8_dp, 1.0e11_dp), &
      mistake_t('gear', 'tooth_stiffness', 'N/mm2', 1.0e6_dp, 1.0e8_dp, 1.0e11_dp), &
      mistake_t('shaft', 'speed_rpm', 'Hz', 60.0_dp, 200.0_dp, 1.0e5_dp), &
      mistake_t('shaft', 'speed_rpm', 'rad/s', 1.0_dp/turn_per_minute, 200.0_dp, 1.0e5_dp), &
      mistake_t('shaft', 'phases', 'deg', degree, 0.0_dp, whole_turn), &
      mistake_t('oil', 'viscosity_40_cst', 'Pa s', 1.0e6_dp/usual_density, 2.0_dp, 2.0e3_dp), &
      mistake_t('oil', 'viscosity_40_cst', 'm2/s', 1.0e6_dp, 2.0_dp, 2.0e3_dp), &
      mistake_t('oil', 'viscosity_100_cst', 'Pa s', 1.0e6_dp/usual_density, 1.0_dp, 200.0_dp), &
      mistake_t('oil', 'viscosity_100_cst', 'm2/s', 1.0e6_dp, 1.0_dp, 200.0_dp), &
      mistake_t('oil', 'density_15', 'g/cm3', 1.0e3_dp, 600.0_dp, 1500.0_dp), &
      mistake_t('oil', 'temperature_celsius', 'K', 1.0_dp, 0.0_dp, 200.0_dp, -273.15_dp), &
      mistake_t('oil', 'volume', 'l', milli, 1.0e-4_dp, 0.1_dp), &
      mistake_t('oil', 'volume', 'cm3', micro, 1.0e-4_dp, 0.1_dp), &
      mistake_t('oil', 'pressure_viscosity', '1/GPa', 1.0e-9_dp, 1.0e-10_dp, 1.0e-7_dp), &
      mistake_t('oil', 'pressure_viscosity', '1/MPa', 1.0e-6_dp, 1.0e-10_dp, 1.0e-7_dp)]

   public :: is_odd, odd_words, meant_behind, mistaken_words, likely_reason, surely_meant, acceleration_meant, speed_meant

contains

   !> Whether no engineer can mean a number for a key, or another one is surely meant.
   pure logical function is_odd(key, number)
      type(key_t), intent(in) :: key
      !> Finite number
      real(dp), intent(in) :: number

      is_odd = .not. is_sensible(key, number) .or. len(meant_words(key, number)) > 0
   end function is_odd

   !> Why a number is odd: what machines have, and what it would be in the unit that was surely meant.
   pure function odd_words(key, number, for_whom) result(words)
      type(key_t), intent(in) :: key
      !> An odd one
      real(dp), intent(in) :: number
      !> The key in words, if the reader does not know it yet
      character(*), intent(in) :: for_whom
      character(:), allocatable :: words
      integer :: i

      words = sensible_text(key)
      do i = size(mistakes), 1, -1
         if (is_sensible(key, number) .and. fits(mistakes(i), key, number)) words = &
            real_text(mistakes(i)%lower)//' to '//real_text(mistakes(i)%upper)//' '//trim(key%unit)
      end do
      words = real_text(number)//' '//trim(key%unit)//' is not what machines have'//for_whom//' ('//words//')'
   end function odd_words

   !> What a number would be in the units that it was surely meant in; empty where there are none.
   pure function meant_words(key, number) result(words)
      type(key_t), intent(in) :: key
      !> Finite number
      real(dp), intent(in) :: number
      character(:), allocatable :: words
      integer :: i

      words = ''
      do i = 1, size(mistakes)
         if (.not. fits(mistakes(i), key, number)) cycle
         if (len(words) > 0) words = words//' or '
         words = words//short_text(meant(mistakes(i), number), 4)//' '//trim(key%unit)//' if it was meant in '// &
                 trim(mistakes(i)%unit)
      end do
   end function meant_words

   !> The same behind a sentence.
   pure function meant_behind(key, number) result(words)
      type(key_t), intent(in) :: key
      !> Finite number
      real(dp), intent(in) :: number
      character(:), allocatable :: words

      words = meant_words(key, number)
      if (len(words) > 0) words = '; it would be '//words
   end function meant_behind

   !> That a number was surely meant in another unit, as a sentence; empty where it was not.
   pure function mistaken_words(key, number) result(words)
      type(key_t), intent(in) :: key
      !> Finite number
      real(dp), intent(in) :: number
      character(:), allocatable :: words

      words = meant_behind(key, number)
      if (len(words) > 0) words = odd_words(key, number, '')//words
   end function mistaken_words

   !> The same behind what is wrong with a scene that has the number.
   pure function likely_reason(key, number) result(words)
      type(key_t), intent(in) :: key
      !> Finite number
      real(dp), intent(in) :: number
      character(:), allocatable :: words

      words = mistaken_words(key, number)
      if (len(words) > 0) words = '; the likely reason: '//trim(key%group)//'.'//trim(key%name)//' = '//words
   end function likely_reason

   !> What a number would be in the unit that it was surely meant in, the likeliest of them; the number itself where there is none.
   pure real(dp) function surely_meant(key, number)
      type(key_t), intent(in) :: key
      !> Finite number
      real(dp), intent(in) :: number
      integer :: i

      surely_meant = number
      do i = size(mistakes), 1, -1
         if (fits(mistakes(i), key, number)) surely_meant = meant(mistakes(i), number)
      end do
   end function surely_meant

   !> What an angular acceleration [rad/s2] would be that was meant in another unit.
   pure function acceleration_meant(number) result(words)
      real(dp), intent(in) :: number
      character(:), allocatable :: words

      words = short_text(degree*number, 4)//' rad/s2 if it was meant in deg/s2, '//short_text(turn_per_minute*number, 4)// &
              ' rad/s2 if it was meant in (1/min)/s'
   end function acceleration_meant

   !> What an angular speed [rad/s] would be that was meant in another unit.
   pure function speed_meant(number) result(words)
      real(dp), intent(in) :: number
      character(:), allocatable :: words

      words = short_text(turn_per_minute*number, 4)//' rad/s if it was meant in 1/min'
   end function speed_meant

   !> Whether a number is not what machines have, and would be in the other unit.
   pure logical function fits(mistake, key, number)
      type(mistake_t), intent(in) :: mistake
      type(key_t), intent(in) :: key
      real(dp), intent(in) :: number

      fits = mistake%group == key%group .and. mistake%name == key%name .and. abs(number) > 0.0_dp
      if (fits) fits = .not. is_usual(mistake, number) .and. is_usual(mistake, meant(mistake, number))
   end function fits

   !> Whether machines have a number in the unit of its key.
   pure logical function is_usual(mistake, number)
      type(mistake_t), intent(in) :: mistake
      real(dp), intent(in) :: number

      is_usual = abs(number) >= mistake%lower .and. abs(number) <= mistake%upper
   end function is_usual

   !> A number in the unit of its key, where it was meant in the other.
   pure real(dp) function meant(mistake, number)
      type(mistake_t), intent(in) :: mistake
      real(dp), intent(in) :: number

      meant = mistake%factor*number + mistake%offset
   end function meant

end module mistaken_units
