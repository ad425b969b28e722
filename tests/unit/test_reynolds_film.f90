!> Tests of the Reynolds films against 18-digit values, and of what must hold between them.
module test_reynolds_film
   use, intrinsic :: ieee_arithmetic, only: ieee_get_halting_mode, ieee_invalid, ieee_is_nan, &
      ieee_quiet_nan, ieee_set_halting_mode, ieee_support_halting, ieee_value
   use checks, only: check_list_t, same_bits
   use constants, only: half_pi, pi
   use iso_viscous_sums, only: film_block
   use kinds, only: dp
   use reynolds_iso_viscous, only: iso_viscous_load, iso_viscous_load_array, peak_pressure_group, &
      rupture_angle, rupture_tangent_fast, rupture_tangent_slope
   use reynolds_piezo_viscous, only: critical_pressure_group, piezo_viscous_load, piezo_viscous_load_array
   implicit none(type, external)
   private

   public :: run_reynolds_film_tests

   !> What the kernels promise, relative: iso-viscous quantities, the piezo-viscous load, its slopes.
   real(dp), parameter :: rounding = 20.0_dp*epsilon(1.0_dp)
   real(dp), parameter :: psi_rounding = 100.0_dp*epsilon(1.0_dp)
   real(dp), parameter :: slope_rounding = 5.0e-12_dp

   !> Squeeze groups A and the exact x_e [rad], Phi, dPhi/dA and B_crit.
   real(dp), parameter :: groups(11) = [ &
      -10000.0_dp, -100.0_dp, -10.0_dp, &
      -1.0_dp, -0.1_dp, 0.0_dp, &
      0.1_dp, 1.0_dp, 3.0_dp, &
      10.0_dp, 100.0_dp]
   real(dp), parameter :: angles(11) = [ &
      1.5706963267955634_dp, 1.560796993385947_dp, 1.4714554682297947_dp, &
      0.8957608739113226_dp, 0.4982418851719488_dp, 0.4435543342177832_dp, &
      0.3876174358753711_dp, -0.11252010822534393_dp, -0.7885418900975466_dp, &
      -1.3076577909841707_dp, -1.5441332712591276_dp]
   real(dp), parameter :: loads(11) = [ &
      3926.990816988908_dp, 39.269924834206115_dp, 3.928634511188594_dp, &
      0.4669361425852977_dp, 0.22401748550995373_dp, 0.20395702057972373_dp, &
      0.18542763773464224_dp, 0.0785102121900387_dp, 0.018364953622332363_dp, &
      0.0019399840201994936_dp, 1.9749475242007172e-5_dp]
   real(dp), parameter :: load_slopes(11) = [ &
      -0.3926990816983908_dp, -0.39269874845870223_dp, -0.3923748661860309_dp, &
      -0.3204131581695341_dp, -0.20827843276112773_dp, -0.1929304265305951_dp, &
      -0.17769494836967853_dp, -0.07145915006663865_dp, -0.010314236620789242_dp, &
      -0.0003810870280963257_dp, -3.9491729758508645e-7_dp]
   real(dp), parameter :: critical_groups(11) = [ &
      0.0003999999991111111_dp, 0.039999111089279366_dp, 0.3991093859271338_dp, &
      3.2999201630858637_dp, 7.1163551649670325_dp, 7.8898286226979755_dp, &
      8.773322678500321_dp, 24.45183655754417_dp, 174.945730938094_dp, &
      4745.377598839782_dp, 4579310.858774118_dp]

   !> Squeeze groups A, shares B/B_crit and the exact Psi.
   real(dp), parameter :: piezo_groups(12) = [ &
      -1.0_dp, -1.0_dp, -1.0_dp, &
      -1.0_dp, 0.0_dp, 0.0_dp, &
      0.0_dp, 0.0_dp, 1.0_dp, &
      1.0_dp, 1.0_dp, 1.0_dp]
   real(dp), parameter :: piezo_shares(12) = [ &
      0.1_dp, 0.5_dp, 0.9_dp, &
      0.99_dp, 0.1_dp, 0.5_dp, &
      0.9_dp, 0.99_dp, 0.1_dp, &
      0.5_dp, 0.9_dp, 0.99_dp]
   real(dp), parameter :: piezo_loads(12) = [ &
      0.48234093845849996_dp, 0.5686956034470299_dp, 0.7837156586546572_dp, &
      0.9756785868823309_dp, 0.21052104100960703_dp, 0.2472544472469768_dp, &
      0.3383676085470261_dp, 0.4194168244010132_dp, 0.08093436550373677_dp, &
      0.09444571414845139_dp, 0.1276297531683181_dp, 0.15684421089233347_dp]

contains

   !> Runs every test of this topic.
   subroutine run_reynolds_film_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('reynolds film')
      call test_references(checks)
      call test_asymptotes(checks)
      call test_joints(checks)
      call test_iso_viscous_curve(checks)
      call test_piezo_viscous_limits(checks)
      call test_piezo_viscous_slopes(checks)
      call test_arrays(checks)
      call test_no_answer(checks)
   end subroutine run_reynolds_film_tests

   !> Values of 18 digits.
   subroutine test_references(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      character(30) :: place
      real(dp) :: phi, dphi_da, psi, dpsi_da, dpsi_db, tangent, critical
      integer :: i

      do i = 1, size(groups)
         write (place, '(a, es10.2)') ' at A =', groups(i)
         tangent = tan(angles(i))
         call iso_viscous_load(groups(i), phi, dphi_da)
         call checks%check_close(rupture_angle(groups(i))/angles(i), 1.0_dp, rounding, 'rupture angle'//place)
         ! The tangent of an angle given in double precision is uncertain by epsilon (1 + t**2).
         call checks%check_close(rupture_tangent_fast(groups(i)), tangent, &
            rounding + epsilon(1.0_dp)*(1.0_dp + tangent**2), 'rupture tangent'//place)
         call checks%check_close(phi/loads(i), 1.0_dp, rounding, 'Phi'//place)
         call checks%check_close(dphi_da/load_slopes(i), 1.0_dp, rounding, 'slope of Phi'//place)
         call checks%check_close(critical_pressure_group(groups(i))/critical_groups(i), 1.0_dp, rounding, &
            'B_crit'//place)
      end do
      do i = 1, size(piezo_groups)
         write (place, '(2(a, f5.2))') ' at A =', piezo_groups(i), ', share', piezo_shares(i)
         critical = critical_pressure_group(piezo_groups(i))
         call piezo_viscous_load(piezo_groups(i), piezo_shares(i)*critical, psi, dpsi_da, dpsi_db)
         call checks%check_close(psi/piezo_loads(i), 1.0_dp, psi_rounding, 'Psi'//place)
      end do
   end subroutine test_references

   !> Leading terms far out, and every finite argument.
   subroutine test_asymptotes(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: far = 1.0e8_dp
      real(dp), parameter :: corners(8) = [0.0_dp, -0.0_dp, tiny(1.0_dp), -tiny(1.0_dp), 1.0e160_dp, &
         -1.0e160_dp, huge(1.0_dp), -huge(1.0_dp)]
      real(dp) :: phi, dphi_da, peak, dpeak_da, psi, dpsi_da, dpsi_db, critical
      integer :: i

      call iso_viscous_load(-far, phi, dphi_da)
      call checks%check_close(phi/far, pi/8.0_dp, rounding, 'Phi on fast approach')
      call checks%check_close(dphi_da, -pi/8.0_dp, rounding, 'slope of Phi on fast approach')
      call checks%check_close(rupture_tangent_fast(-far)/far, 1.0_dp, rounding, 'tangent on fast approach')
      call checks%check_close(rupture_tangent_slope(-far), -1.0_dp, rounding, 'its slope on fast approach')
      call iso_viscous_load(far, phi, dphi_da)
      call checks%check_close(phi*far**2, 16.0_dp/81.0_dp, rounding, 'Phi on fast separation')
      call checks%check_close(dphi_da*far**3, -32.0_dp/81.0_dp, rounding, 'slope of Phi, fast separation')
      call checks%check_close(rupture_tangent_fast(far)/far, -0.375_dp, rounding, 'tangent, fast separation')
      call checks%check_close(rupture_tangent_slope(far), -0.375_dp, rounding, 'its slope on fast separation')
      do i = 1, size(corners)
         call iso_viscous_load(corners(i), phi, dphi_da)
         call peak_pressure_group(corners(i), peak, dpeak_da)
         call checks%check(phi >= 0.0_dp .and. dphi_da <= 0.0_dp .and. phi <= huge(phi), 'Phi of any A')
         call checks%check(peak >= 0.0_dp .and. dpeak_da <= 0.0_dp .and. peak <= huge(phi), 'peak of any A')
         call checks%check(abs(rupture_angle(corners(i))) <= half_pi, 'rupture of any A')
         call checks%check(critical_pressure_group(corners(i)) > 0.0_dp, 'B_crit of any A')
      end do
      ! B_crit goes with A**3, to the largest number there is and not beyond.
      call checks%check_close(critical_pressure_group(3.39e102_dp)/critical_pressure_group(3.39e100_dp)*1.0e-6_dp, 1.0_dp, &
         rounding, 'B_crit below the largest number')
      call checks%check(critical_pressure_group(3.41e102_dp) > huge(1.0_dp), 'B_crit above the largest number')
      call piezo_viscous_load(3.41e102_dp, 1.7e308_dp, psi, dpsi_da, dpsi_db)
      call iso_viscous_load(3.41e102_dp, phi, dphi_da)
      call checks%check(psi > 1.5_dp*phi, 'Psi where B_crit is above the largest number')
      do i = 1, 5
         critical = min(critical_pressure_group(corners(i)), huge(1.0_dp))
         call piezo_viscous_load(corners(i), 0.5_dp*critical, psi, dpsi_da, dpsi_db)
         call checks%check(psi >= 0.0_dp .and. dpsi_da <= 0.0_dp .and. dpsi_db >= 0.0_dp, 'Psi far out')
      end do
   end subroutine test_asymptotes

   !> Value and slope across the joint of the tables, A = 0, and the end of the square root, |A| = 1e9.
   subroutine test_joints(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: joints(3) = [0.0_dp, -1.0e9_dp, 1.0e9_dp]
      real(dp) :: below, above, critical, low(3), high(3)
      integer :: i

      do i = 1, size(joints)
         below = nearest(joints(i), -1.0_dp)
         above = nearest(joints(i), 1.0_dp)
         call iso_viscous_load(below, low(1), low(2))
         call iso_viscous_load(above, high(1), high(2))
         call checks%check_close(low(1)/high(1), 1.0_dp, rounding, 'Phi across a joint')
         call checks%check_close(low(2)/high(2), 1.0_dp, rounding, 'slope of Phi across a joint')
         call checks%check_close(rupture_tangent_fast(below)/rupture_tangent_fast(above), 1.0_dp, rounding, &
            'rupture across a joint')
         call checks%check_close(rupture_tangent_slope(below), rupture_tangent_slope(above), rounding, &
            'slope of the rupture across a joint')
         critical = critical_pressure_group(joints(i))
         call checks%check_close(critical_pressure_group(below)/critical, 1.0_dp, rounding, &
            'B_crit across a joint')
         call piezo_viscous_load(below, 0.7_dp*critical, low(1), low(2), low(3))
         call piezo_viscous_load(above, 0.7_dp*critical, high(1), high(2), high(3))
         call checks%check_close(low(1)/high(1), 1.0_dp, psi_rounding, 'Psi across a joint')
         call checks%check_close(low(2)/high(2), 1.0_dp, slope_rounding, 'dPsi/dA across a joint')
         call checks%check_close(low(3)/high(3), 1.0_dp, slope_rounding, 'dPsi/dB across a joint')
      end do
   end subroutine test_joints

   !> A ruptured film never pulls, the rupture retreats as the teeth separate, slopes are those of the values.
   subroutine test_iso_viscous_curve(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: points = 400
      real(dp), parameter :: step = 1.0e-4_dp
      real(dp) :: a, width, phi, dphi_da, before, after, unused, angle, last_angle, slope_error, tangent_error
      logical :: pushes, falls
      integer :: i

      pushes = .true.
      falls = .true.
      last_angle = half_pi
      slope_error = 0.0_dp
      tangent_error = 0.0_dp
      do i = -points, points
         a = sinh(15.0_dp*real(i, dp)/points)
         angle = rupture_angle(a)
         falls = falls .and. angle < last_angle
         last_angle = angle
         call iso_viscous_load(a, phi, dphi_da)
         pushes = pushes .and. phi > 0.0_dp .and. dphi_da < 0.0_dp
         width = step*(1.0_dp + abs(a))
         call iso_viscous_load(a - width, before, unused)
         call iso_viscous_load(a + width, after, unused)
         slope_error = max(slope_error, abs((after - before)/(2.0_dp*width*dphi_da) - 1.0_dp))
         tangent_error = max(tangent_error, abs(rupture_tangent_slope(a) &
            - (rupture_tangent_fast(a + width) - rupture_tangent_fast(a - width))/(2.0_dp*width)))
      end do
      call checks%check(pushes, 'Phi is positive and falls')
      call checks%check(falls, 'the rupture angle falls')
      call checks%check_close(slope_error, 0.0_dp, 2.0e-7_dp, 'slope of Phi against differences')
      call checks%check_close(tangent_error, 0.0_dp, 2.0e-7_dp, 'slope of the rupture against differences')
   end subroutine test_iso_viscous_curve

   !> Without pressure dependence Psi is Phi; with a little, dPsi/dB makes the difference.
   subroutine test_piezo_viscous_limits(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: places(5) = [-50.0_dp, -1.0_dp, 0.0_dp, 2.0_dp, 300.0_dp]
      real(dp), parameter :: share = 1.0e-7_dp
      real(dp) :: phi, dphi_da, psi, dpsi_da, dpsi_db, critical
      integer :: i

      do i = 1, size(places)
         call iso_viscous_load(places(i), phi, dphi_da)
         call piezo_viscous_load(places(i), 0.0_dp, psi, dpsi_da, dpsi_db)
         call checks%check_close(psi/phi, 1.0_dp, 0.0_dp, 'Psi(A, 0) is Phi')
         call checks%check_close(dpsi_da/dphi_da, 1.0_dp, 0.0_dp, 'its slope is that of Phi')
         critical = critical_pressure_group(places(i))
         call piezo_viscous_load(places(i), share*critical, psi, dpsi_da, dpsi_db)
         call checks%check_close((psi - phi)/(share*critical*dpsi_db), 1.0_dp, 1.0e-6_dp, 'first order in B')
         call piezo_viscous_load(places(i), critical*(1.0_dp - 1.0e-12_dp), psi, dpsi_da, dpsi_db)
         call checks%check(psi < 2.4_dp*phi .and. psi > 1.5_dp*phi, 'Psi stays bounded at B_crit')
      end do
   end subroutine test_piezo_viscous_limits

   !> Slopes of Psi against central differences.
   subroutine test_piezo_viscous_slopes(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: shares(4) = [0.01_dp, 0.3_dp, 0.7_dp, 0.95_dp]
      real(dp), parameter :: step = 1.0e-5_dp
      real(dp) :: a, b, width, psi, dpsi_da, dpsi_db, before, after, unused(2), error_a, error_b
      integer :: i, j

      error_a = 0.0_dp
      error_b = 0.0_dp
      do i = -20, 20
         a = sinh(0.4_dp*real(i, dp))
         do j = 1, size(shares)
            b = shares(j)*critical_pressure_group(a)
            call piezo_viscous_load(a, b, psi, dpsi_da, dpsi_db)
            width = step*(1.0_dp + abs(a))
            call piezo_viscous_load(a - width, b, before, unused(1), unused(2))
            call piezo_viscous_load(a + width, b, after, unused(1), unused(2))
            error_a = max(error_a, abs((after - before)/(2.0_dp*width*dpsi_da) - 1.0_dp))
            width = step*b
            call piezo_viscous_load(a, b - width, before, unused(1), unused(2))
            call piezo_viscous_load(a, b + width, after, unused(1), unused(2))
            error_b = max(error_b, abs((after - before)/(2.0_dp*width*dpsi_db) - 1.0_dp))
         end do
      end do
      call checks%check_close(error_a, 0.0_dp, 1.0e-6_dp, 'dPsi/dA against differences')
      call checks%check_close(error_b, 0.0_dp, 1.0e-6_dp, 'dPsi/dB against differences')
   end subroutine test_piezo_viscous_slopes

   !> A film gets the same bits alone, in an array, and at another place of the array.
   subroutine test_arrays(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: n = 2*film_block + 13
      real(dp), dimension(n) :: a, b, phi, slope, psi, dpsi_da, dpsi_db
      real(dp) :: one(3)
      logical :: alone, moved
      integer :: i

      do i = 1, n
         a(i) = sinh(0.2_dp*(real(i, dp) - 0.5_dp*n))
         b(i) = critical_pressure_group(a(i))*(real(i, dp)/(n + 1))
      end do
      alone = .true.
      moved = .true.
      call iso_viscous_load_array(n, a, phi, slope)
      call piezo_viscous_load_array(n, a, b, psi, dpsi_da, dpsi_db)
      do i = 1, n
         call iso_viscous_load(a(i), one(1), one(2))
         alone = alone .and. same_bits(one(1), phi(i)) .and. same_bits(one(2), slope(i))
         call piezo_viscous_load(a(i), b(i), one(1), one(2), one(3))
         alone = alone .and. all(same_bits(one, [psi(i), dpsi_da(i), dpsi_db(i)]))
      end do
      call checks%check(alone, 'a film alone and in an array')
      do i = 2, n
         call piezo_viscous_load_array(1, a(i), b(i), one(1), one(2), one(3))
         moved = moved .and. all(same_bits(one, [psi(i), dpsi_da(i), dpsi_db(i)]))
      end do
      call checks%check(moved, 'a film elsewhere in an array')
   end subroutine test_arrays

   !> Arguments without an answer give NaN; the halting of debug builds is lifted meanwhile, NaN are compared.
   subroutine test_no_answer(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: nan, critical, a(5), b(5), psi(5), dpsi_da(5), dpsi_db(5), phi, dphi_da
      logical :: halting
      integer :: i

      nan = ieee_value(nan, ieee_quiet_nan)
      critical = critical_pressure_group(-1.0_dp)
      ! No exception may come of a B beyond the critical one: halting stays as the build has it.
      a(1:3) = -1.0_dp
      b(1:3) = [critical*(1.0_dp + 4.0_dp*epsilon(1.0_dp)), 1.0e300_dp, -1.0e-3_dp]
      call piezo_viscous_load_array(3, a, b, psi, dpsi_da, dpsi_db)
      do i = 1, 3
         call checks%check(ieee_is_nan(psi(i)) .and. ieee_is_nan(dpsi_da(i)) .and. ieee_is_nan(dpsi_db(i)), &
            'no rigid film: NaN')
         call piezo_viscous_load(a(i), b(i), psi(i), dpsi_da(i), dpsi_db(i))
         call checks%check(ieee_is_nan(psi(i)) .and. ieee_is_nan(dpsi_da(i)) .and. ieee_is_nan(dpsi_db(i)), &
            'no rigid film: NaN, scalar')
      end do

      halting = .false.
      if (ieee_support_halting(ieee_invalid)) then
         call ieee_get_halting_mode(ieee_invalid, halting)
         call ieee_set_halting_mode(ieee_invalid, .false.)
      end if
      a = [nan, -1.0_dp, -1.0_dp, 2.0_dp, nan]
      b = [0.1_dp, nan, 0.5_dp*critical, 0.1_dp, nan]
      call piezo_viscous_load_array(5, a, b, psi, dpsi_da, dpsi_db)
      do i = 1, 5
         call checks%check((ieee_is_nan(a(i)) .or. ieee_is_nan(b(i))) .eqv. ieee_is_nan(psi(i)), 'Psi of NaN')
         call checks%check(ieee_is_nan(psi(i)) .eqv. ieee_is_nan(dpsi_da(i)), 'dPsi/dA of NaN')
         call checks%check(ieee_is_nan(psi(i)) .eqv. ieee_is_nan(dpsi_db(i)), 'dPsi/dB of NaN')
      end do
      call iso_viscous_load(nan, phi, dphi_da)
      call checks%check(ieee_is_nan(phi) .and. ieee_is_nan(dphi_da), 'Phi of NaN')
      call checks%check(ieee_is_nan(rupture_angle(nan)), 'rupture angle of NaN')
      call checks%check(ieee_is_nan(rupture_tangent_slope(nan)), 'slope of the rupture at NaN')
      call checks%check(ieee_is_nan(critical_pressure_group(nan)), 'B_crit of NaN')
      if (ieee_support_halting(ieee_invalid)) call ieee_set_halting_mode(ieee_invalid, halting)
   end subroutine test_no_answer

end module test_reynolds_film
