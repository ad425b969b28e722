!> Tests of what the name of a column says about an axis.
module test_axis_unit
   use axis_unit, only: angle_axis, axis_unit_t, no_axis, time_axis, unit_of_name
   use checks, only: check_list_t
   use kinds, only: dp
   implicit none(type, external)
   private

   public :: run_axis_unit_tests

contains

   !> Runs every test of this topic.
   subroutine run_axis_unit_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: radian = 57.29577951308232_dp
      character(*), parameter :: degree = char(194)//char(176), micro = char(194)//char(181), mu = char(206)//char(188)

      call checks%start('axis_unit')
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
      call hold(checks, 'time [h]', time_axis, '', 1.0_dp, strange=.true.)
      call hold(checks, 'force', no_axis, '', 1.0_dp)
      call hold(checks, 'force [N s]', no_axis, '', 1.0_dp)
      call hold(checks, 'speed rad/s', no_axis, '', 1.0_dp)
      call hold(checks, 'min', no_axis, '', 1.0_dp)
      call hold(checks, '', no_axis, '', 1.0_dp)
      call hold(checks, '[]', no_axis, '', 1.0_dp)
   end subroutine run_axis_unit_tests

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
      unit = unit_of_name(name)
      call checks%check(unit%kind == kind .and. unit%word == word .and. abs(unit%size - size) <= tolerance*size .and. &
                        (unit%is_strange .eqv. is_strange), "the name '"//name//"'")
   end subroutine hold

end module test_axis_unit
