!> Tests of the folder gear: the contact of a gear pair, an oil at a temperature, the base order of a shaft.
module test_gear
   use checks, only: check_list_t
   use derived_scene, only: base_order
   use gear_contact, only: find_contact, gear_contact_t
   use kinds, only: dp
   use oil_data, only: kinematic_viscosity, oil_density, oil_pressure_viscosity, oil_viscosity
   use scene_types, only: gear_t, oil_mineral, oil_pao, oil_polyglycol
   implicit none(type, external)
   private

   public :: run_gear_tests

   !> Of references that were computed apart from this program
   real(dp), parameter :: tolerance = 1.0e-9_dp

contains

   !> Runs every test of this topic.
   subroutine run_gear_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('gear')
      call test_shifted_pair(checks)
      call test_position(checks)
      call test_spur_pair(checks)
      call test_wrong_pairs(checks)
      call test_mineral_oil(checks)
      call test_other_bases(checks)
      call test_viscosity_line(checks)
      call test_base_order(checks)
   end subroutine run_gear_tests

   !> A pair with a centre distance of its own at the pitch point, 11 and 38 teeth.
   subroutine test_shifted_pair(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(gear_t) :: pair
      type(gear_contact_t) :: contact
      character(:), allocatable :: wrong, message

      pair = gear_t(teeth_1=11, teeth_2=38, normal_module=2.5e-3_dp, pressure_angle_deg=20.0_dp, helix_angle_deg=28.96_dp, &
                    face_width=0.016_dp, loose_inertia=1.715e-3_dp, drag_torque=0.1_dp)
      call find_contact(pair, pair%drag_torque, 800.0_dp/60.0_dp, contact, wrong, message)
      call check('wrong', real(len(wrong) + len(message), dp), 0.0_dp)
      call check('base radius 1', contact%base_radius_1, 0.01450969563_dp)
      call check('base radius 2', contact%base_radius_2, 0.05012440307_dp)
      call check('working pressure angle', contact%working_pressure_angle, 22.5866253_dp)
      call check('base helix angle', contact%base_helix_angle, 27.06481427_dp)
      call check('radius', contact%radius, 0.005256471216_dp)
      call check('entrainment speed', contact%entrainment_speed, 0.5056564966_dp)
      call check('length', contact%length, 0.01796758757_dp)
      call check('mass', contact%mass, 0.8608059738_dp)
      call check('steady force', contact%steady_force, 2.240374258_dp)
      call check('force of 600 rad/s2', 600.0_dp*contact%force_per_acceleration, 6.673367428_dp)
      call check('centre distance', contact%centre_distance, 0.07000336377_dp)

   contains

      subroutine check(what, actual, expected)
         character(*), intent(in) :: what
         real(dp), intent(in) :: actual
         real(dp), intent(in) :: expected

         call checks%check_close(actual, expected, tolerance*abs(expected), 'pair at its pitch point: '//what)
      end subroutine check

   end subroutine test_shifted_pair

   !> A pair that touches beside its pitch point with one line and a half, 33 and 32 teeth.
   subroutine test_position(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(gear_t) :: pair
      type(gear_contact_t) :: contact
      character(:), allocatable :: wrong, message

      pair = gear_t(teeth_1=33, teeth_2=32, normal_module=1.85e-3_dp, pressure_angle_deg=20.0_dp, helix_angle_deg=30.8_dp, &
                    face_width=0.016_dp, centre_distance=0.0702_dp, contact_position=1.0e-3_dp, contact_lines=1.5_dp, &
                    loose_inertia=2.8e-4_dp, drag_torque=0.05_dp)
      call find_contact(pair, pair%drag_torque, 800.0_dp/60.0_dp, contact, wrong, message)
      call check('working pressure angle', contact%working_pressure_angle, 23.35107601_dp)
      call check('base helix angle', contact%base_helix_angle, 28.76138053_dp)
      call check('radius', contact%radius, 0.007874713445_dp)
      call check('entrainment speed', contact%entrainment_speed, 1.182142875_dp)
      call check('sum of speeds', contact%surface_speed_1 + contact%surface_speed_2, 2.0_dp*1.182142875_dp)
      call check('length', contact%length, 0.02737753343_dp)
      call check('mass', contact%mass, 0.3619119942_dp)
      call check('steady force', contact%steady_force, 1.797597589_dp)
      call check('force of 600 rad/s2', 600.0_dp*contact%force_per_acceleration, 6.228675645_dp)

   contains

      subroutine check(what, actual, expected)
         character(*), intent(in) :: what
         real(dp), intent(in) :: actual
         real(dp), intent(in) :: expected

         call checks%check_close(actual, expected, tolerance*abs(expected), 'pair beside its pitch point: '//what)
      end subroutine check

   end subroutine test_position

   !> Spur gears by hand: all lies in one plane, both speeds are one at the pitch point.
   subroutine test_spur_pair(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(gear_t) :: pair
      type(gear_contact_t) :: contact
      character(:), allocatable :: wrong, message
      real(dp), parameter :: rounding = 1.0e-14_dp, sine = 0.3420201433256687_dp

      pair = gear_t(teeth_1=20, teeth_2=30, normal_module=2.0e-3_dp, face_width=0.02_dp, loose_inertia=1.0e-3_dp, &
                    pressure_angle_deg=20.0_dp)
      call find_contact(pair, pair%drag_torque, 10.0_dp, contact, wrong, message)
      call checks%check_close(contact%working_pressure_angle, 20.0_dp, 1.0e-13_dp, 'spur pair: working pressure angle')
      call checks%check_close(contact%centre_distance, 0.05_dp, rounding, 'spur pair: centre distance')
      call checks%check_close(contact%last_position - contact%first_position, 0.05_dp*sine, rounding, 'spur pair: line of action')
      call checks%check_close(contact%radius, 0.02_dp*0.03_dp/0.05_dp*sine, rounding, 'spur pair: radius')
      call checks%check_close(contact%surface_speed_1, contact%surface_speed_2, rounding, 'spur pair: pure rolling')
      call checks%check_close(contact%length, 0.02_dp, rounding, 'spur pair: length')
   end subroutine test_spur_pair

   !> Gears too close to mesh, and places beyond both ends of the line of action.
   subroutine test_wrong_pairs(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(gear_contact_t) :: contact
      type(gear_t) :: pair
      character(:), allocatable :: wrong, message
      real(dp) :: ends(2)
      integer :: i

      pair = gear_t(teeth_1=20, teeth_2=30, normal_module=2.0e-3_dp, face_width=0.02_dp, centre_distance=0.0469_dp, &
                    loose_inertia=1.0e-3_dp, pressure_angle_deg=20.0_dp)
      call find_contact(pair, pair%drag_torque, 10.0_dp, contact, wrong, message)
      call checks%check(wrong == 'centre_distance' .and. len(message) > 0, 'gears within their base circles are refused')
      ! 50 tan(alpha_wt) = 2 pi at 7.162 degrees, 47.355 mm: the line of action is one pitch long.
      pair%centre_distance = 0.0474_dp
      call find_contact(pair, pair%drag_torque, 10.0_dp, contact, wrong, message)
      call checks%check(wrong == '', 'gears that just mesh are taken')
      ends = [contact%first_position, contact%last_position]
      do i = 1, 2
         pair%contact_position = ends(i)*(1.0_dp + 1.0e-6_dp)
         call find_contact(pair, pair%drag_torque, 10.0_dp, contact, wrong, message)
         call checks%check(wrong == 'contact_position' .and. len(message) > 0, 'a contact beyond the line of action is refused')
         pair%contact_position = ends(i)*(1.0_dp - 1.0e-6_dp)
         call find_contact(pair, pair%drag_torque, 10.0_dp, contact, wrong, message)
         call checks%check(wrong == '' .and. contact%radius > 0.0_dp, 'a contact at the end of the line of action is taken')
      end do
   end subroutine test_wrong_pairs

   !> Viscosity and Barus coefficient of a mineral oil from -20 to 120 degC.
   subroutine test_mineral_oil(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      real(dp), parameter :: temperatures(6) = [-20.0_dp, 0.0_dp, 20.0_dp, 40.0_dp, 80.0_dp, 120.0_dp], &
                             viscosities(6) = [2.69145831_dp, 0.473715991_dp, 0.131045343_dp, 0.049445_dp, 0.0126951718_dp, &
                                               5.18465014e-3_dp], &
                             coefficients(6) = [2.47334058e-8_dp, 2.20584281e-8_dp, 1.97484482e-8_dp, 1.7733532e-8_dp, &
                                                1.4388366e-8_dp, 1.172389e-8_dp]
      integer :: i

      do i = 1, size(temperatures)
         ! Half a unit of the last digit that is known
         call checks%check_close(oil(temperatures(i))/viscosities(i), 1.0_dp, 4.0e-9_dp, 'mineral oil: viscosity')
         call checks%check_close(oil_pressure_viscosity(oil_mineral, oil(38.0_dp), temperatures(i))/coefficients(i), 1.0_dp, &
                                 merge(1.0e-8_dp, 5.0e-8_dp, i <= 3), 'mineral oil: pressure-viscosity coefficient')
      end do
   end subroutine test_mineral_oil

   !> The other base oils.
   subroutine test_other_bases(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%check_close(oil_pressure_viscosity(oil_pao, oil(38.0_dp), 40.0_dp)/1.25084897e-8_dp, 1.0_dp, 5.0e-9_dp, &
                              'PAO: pressure-viscosity coefficient')
      call checks%check_close(oil_pressure_viscosity(oil_polyglycol, oil(38.0_dp), 40.0_dp)/8.70226199e-9_dp, 1.0_dp, 5.0e-9_dp, &
                              'polyglycol: pressure-viscosity coefficient')
   end subroutine test_other_bases

   !> The data sheet's own values come back, and no temperature leads out of the range of the reals.
   subroutine test_viscosity_line(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%check_close(kinematic_viscosity(58.0_dp, 9.6_dp, 40.0_dp), 58.0_dp, 1.0e-12_dp, 'viscosity at 40 degC')
      call checks%check_close(kinematic_viscosity(58.0_dp, 9.6_dp, 100.0_dp), 9.6_dp, 1.0e-12_dp, 'viscosity at 100 degC')
      call checks%check(kinematic_viscosity(1.0e5_dp, 0.4_dp, -200.0_dp) < huge(1.0_dp), 'viscosity of frozen oil is a number')
      call checks%check(kinematic_viscosity(1.0e5_dp, 0.4_dp, 1.0e4_dp) >= 0.3_dp, 'viscosity of burnt oil is a number')
      call checks%check_close(oil_density(870.0_dp, 40.0_dp), 852.5_dp, 1.0e-12_dp, 'density')
   end subroutine test_viscosity_line

   !> Viscosity of the oil of the references [Pa s].
   elemental real(dp) function oil(temperature)
      real(dp), intent(in) :: temperature

      oil = oil_viscosity(58.0_dp, 9.6_dp, 870.0_dp, temperature)
   end function oil

   !> Greatest common divisors.
   subroutine test_base_order(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call check([2.0_dp, 4.0_dp, 6.0_dp], 2.0_dp, 'of a four-cylinder engine')
      call check([6.0_dp, 4.0_dp], 2.0_dp, 'where the smallest order is not the divisor')
      call check([2.0_dp, 0.5_dp, 1.5_dp], 0.5_dp, 'with halves')
      call check([1.5_dp], 1.5_dp, 'of one order')
      call check([0.3_dp, 0.2_dp, 33.7_dp], 0.1_dp, 'of decimals that no binary number is')
      call check([1.0_dp/3.0_dp, 1.0_dp, 0.25_dp], 1.0_dp/12.0_dp, 'of thirds and quarters')
      call check([1.0_dp, acos(-1.0_dp)], 0.0_dp, 'of numbers that have none')

   contains

      subroutine check(orders, expected, what)
         real(dp), intent(in) :: orders(:)
         real(dp), intent(in) :: expected
         character(*), intent(in) :: what

         call checks%check_close(base_order(orders), expected, 4.0_dp*epsilon(1.0_dp), 'base order '//what)
      end subroutine check

   end subroutine test_base_order

end module test_gear
