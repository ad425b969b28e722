!> Tests of what the head of a column says: name, unit, and whether it is an axis.
module test_column_head
   use column_head, only: angle_axis, axis_of, axis_unit_t, column_head_t, conversion, head_of, no_axis, time_axis
   use checks, only: check_list_t
   use kinds, only: dp
   implicit none(type, external)
   private

   public :: run_column_head_tests

contains

   !> Runs every test of this topic.
   subroutine run_column_head_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: radian = 57.29577951308232_dp
      character(*), parameter :: degree = char(194)//char(176), micro = char(194)//char(181), mu = char(206)//char(188)

      call checks%start('column_head')
      call hold(checks, 't', time_axis, '', 1.0_dp)
      call hold(checks, 'Time [s]', time_axis, 's', 1.0_dp)
      call hold(checks, 'time_ms', time_axis, 'ms', 1.0e-3_dp)
      call hold(checks, 'Zeit in '//micro//'s', time_axis, 'us', 1.0e-6_dp)
      call hold(checks, 'time ('//mu//'s)', time_axis, 'us', 1.0e-6_dp)
      call hold(checks, 'elapsed time / min', time_axis, 'min', 60.0_dp)
      call hold(checks, 'ms', time_axis, 'ms', 1.0e-3_dp)
      call hold(checks, 'angle', angle_axis, '', 1.0_dp)
      call hold(checks, 'crank angle ['//degree//'CA]', angle_axis, 'deg', 1.0_dp)
      call hold(checks, 'shaft_angle_rad', angle_axis, 'rad', radian)
      call hold(checks, 'phase (rev)', angle_axis, 'rev', 360.0_dp)
      call hold(checks, 'angle [gon]', angle_axis, '', 1.0_dp, strange=.true.)
      call hold(checks, 'time [h]', time_axis, 'h', 3600.0_dp)
      call hold(checks, 'time [N]', time_axis, '', 1.0_dp, strange=.true.)
      call hold(checks, 'force', no_axis, '', 1.0_dp)
      call hold(checks, 'force [N s]', no_axis, '', 1.0_dp)
      call hold(checks, 'speed rad/s', no_axis, '', 1.0_dp)
      call hold(checks, 'min', no_axis, '', 1.0_dp)
      call hold(checks, '', no_axis, '', 1.0_dp)
      call hold(checks, '[]', no_axis, '', 1.0_dp)
      call test_units(checks)
   end subroutine run_column_head_tests

   !> Factors by hand from the definitions of the units.
   subroutine test_units(checks)
      type(check_list_t), intent(inout) :: checks
      character(*), parameter :: degree = char(194)//char(176), squared = char(194)//char(178), dot = char(194)//char(183), &
                                 raised_minus = char(226)//char(129)//char(187), raised_one = char(194)//char(185)
      real(dp), parameter :: pi = 3.141592653589793_dp

      call convert(checks, 'force_kN', '', 'N', 'force', 1.0e3_dp)
      call convert(checks, 'force [kN]', '', 'N', 'force', 1.0e3_dp)
      call convert(checks, 'F / kN', '', 'N', 'F', 1.0e3_dp)
      call convert(checks, 'force in N', '', 'N', 'force', 1.0_dp)
      call convert(checks, 'force', 'MN', 'N', 'force', 1.0e6_dp)
      call convert(checks, 'force (left)', '', 'N', 'force (left)', 1.0_dp)
      call convert(checks, 'force_lbf', '', 'N', 'force', 4.4482216152605_dp)
      call convert(checks, 'torque_Nm', '', 'N m', 'torque', 1.0_dp)
      call convert(checks, 'torque [N'//dot//'mm]', '', 'N m', 'torque', 1.0e-3_dp)
      call convert(checks, 'torque (N m)', '', 'N m', 'torque', 1.0_dp)
      call convert(checks, 'drag_N_m', '', 'N m', 'drag', 1.0_dp)
      call convert(checks, 'speed_rpm', '', '1/min', 'speed', 1.0_dp)
      call convert(checks, 'speed_rpm', '1/min', '1/min', 'speed', 1.0_dp)
      call convert(checks, 'n [min'//raised_minus//raised_one//']', '', 'rad/s', 'n', pi/30.0_dp)
      call convert(checks, 'speed', 'rad/s', '1/min', 'speed', 30.0_dp/pi)
      call convert(checks, 'speed [Hz]', '', '1/min', 'speed', 60.0_dp)
      call convert(checks, 'load.frequency', '1/min', 'Hz', 'load.frequency', 1.0_dp/60.0_dp)
      call convert(checks, 'a_rad_s2', '', 'rad/s2', 'a', 1.0_dp)
      call convert(checks, 'a [deg/s'//squared//']', '', 'rad/s2', 'a', pi/180.0_dp)
      call convert(checks, 'inertia [kg cm^2]', '', 'kg m2', 'inertia', 1.0e-4_dp)
      call convert(checks, 'stiffness [N/(mm um)]', '', 'N/m2', 'stiffness', 1.0e9_dp)
      call convert(checks, 'alpha [1/GPa]', '', '1/Pa', 'alpha', 1.0e-9_dp)
      call convert(checks, 'viscosity [mPa s]', '', 'Pa s', 'viscosity', 1.0e-3_dp)
      call convert(checks, 'nu_cSt', '', 'mm2/s', 'nu', 1.0_dp)
      call convert(checks, 'temperature_K', '', 'degC', 'temperature', 1.0_dp, -273.15_dp)
      call convert(checks, 'temperature ['//degree//'F]', '', 'degC', 'temperature', 5.0_dp/9.0_dp, -160.0_dp/9.0_dp)
      call convert(checks, 'phase_2_deg', '', 'rad', 'phase_2', pi/180.0_dp)
      call convert(checks, 'acceleration_1.5', '', 'rad/s2', 'acceleration_1.5', 1.0_dp)
      ! Endings that are no units
      call convert(checks, 'force_mean', '', 'N', 'force_mean', 1.0_dp)
      call convert(checks, 'speed_amplitudes', '', 'rad/s', 'speed_amplitudes', 1.0_dp)
      call convert(checks, 'mass', '', 'N', 'mass', 1.0_dp)
      call convert(checks, 'force_rad', '', 'N', 'force_rad', 1.0_dp)
      call convert(checks, 'force_A', '', 'N', 'force_A', 1.0_dp)
      call convert(checks, 'force_1', '', 'N', 'force_1', 1.0_dp)
      call convert(checks, 'force_s2', '', 'N', 'force_s2', 1.0_dp)
      ! What does not fit
      call refuse(checks, 'load_V', '', 'N', 'it is in V; N is needed')
      call refuse(checks, 'torque_Nm', '', 'N', 'it is in N m; N is needed')
      call refuse(checks, 'speed_rpm', '', 'rad/s2', 'it is in rpm; rad/s2 is needed')
      call refuse(checks, 'speed [1/s]', '', 'rad/s', 'it is in 1/s; rad/s is needed')
      call refuse(checks, 'force [kips]', '', 'N', 'its unit is not known; N is needed')
      call refuse(checks, 'force_kN', 'N', 'N', 'its unit is not known; N is needed')
   end subroutine test_units

   !> Whether the numbers of a column are brought into a unit.
   subroutine convert(checks, text, row, needed, name, factor, added)
      type(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: text
      character(*), intent(in) :: row
      character(*), intent(in) :: needed
      !> What is left of the head without its unit
      character(*), intent(in) :: name
      real(dp), intent(in) :: factor
      real(dp), intent(in), optional :: added
      real(dp), parameter :: tolerance = 1.0e-14_dp
      type(column_head_t) :: head
      character(:), allocatable :: message
      real(dp) :: found, offset, expected

      expected = 0.0_dp
      if (present(added)) expected = added
      head = head_of(text, row, needed)
      call conversion(head, needed, found, offset, message)
      call checks%check(len(message) == 0 .and. abs(found - factor) <= tolerance*factor .and. &
                        abs(offset - expected) <= tolerance*max(1.0_dp, abs(expected)) .and. head%name == name, &
                        "the unit of '"//text//"', "//head%name//', '//message)
   end subroutine convert

   !> Whether a column is refused.
   subroutine refuse(checks, text, row, needed, expected)
      type(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: text
      character(*), intent(in) :: row
      character(*), intent(in) :: needed
      character(*), intent(in) :: expected
      character(:), allocatable :: message
      real(dp) :: factor, added

      call conversion(head_of(text, row, needed), needed, factor, added, message)
      call checks%check(message == expected, "refused: '"//text//"': "//message)
   end subroutine refuse

   !> Whether a name is understood.
   subroutine hold(checks, name, kind, word, size, strange)
      type(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: name
      integer, intent(in) :: kind
      character(*), intent(in) :: word
      !> [s] or [deg]
      real(dp), intent(in) :: size
      logical, intent(in), optional :: strange
      real(dp), parameter :: tolerance = 1.0e-13_dp
      type(axis_unit_t) :: unit
      logical :: is_strange

      is_strange = .false.
      if (present(strange)) is_strange = strange
      unit = axis_of(name, '')
      call checks%check(unit%kind == kind .and. unit%word == word .and. abs(unit%size - size) <= tolerance*size .and. &
                        (unit%is_strange .eqv. is_strange), "the name '"//name//"'")
   end subroutine hold

end module test_column_head
