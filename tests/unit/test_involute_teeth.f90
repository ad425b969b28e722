!> Tests of the teeth of a pair against tabulated gears, against formulas of ISO 21771 computed with 30 digits (mpmath), and
!> against searches that share no formula with the program.
module test_involute_teeth
   use checks, only: check_list_t
   use constants, only: pi
   use gear_contact, only: find_contact, gear_contact_t
   use involute_teeth, only: inverse_involute, involute, largest_contact_ratio
   use kinds, only: dp
   use scene_types, only: gear_t
   implicit none(type, external)
   private

   public :: run_involute_teeth_tests

contains

   !> Runs every test of this topic.
   subroutine run_involute_teeth_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('involute_teeth')
      call test_tabulated_pair(checks)
      call test_usual_tips(checks)
      call test_tip_thickness(checks)
      call test_lower_tips(checks)
      call test_undercut(checks)
      call test_inverse(checks)
      call test_largest_ratio(checks)
      call test_refused(checks)
   end subroutine run_involute_teeth_tests

   !> The contact of a spur pair with a module of 3 mm, in millimetres but for its teeth.
   function spur(teeth, distance, tips) result(contact)
      integer, intent(in) :: teeth(2)
      !> 0: that without profile shift
      real(dp), intent(in) :: distance
      !> Tip diameters; 0: not given
      real(dp), intent(in) :: tips(2)
      type(gear_contact_t) :: contact
      character(:), allocatable :: wrong, message

      call find_contact(gear_t(teeth_1=teeth(1), teeth_2=teeth(2), normal_module=3.0_dp, pressure_angle_deg=20.0_dp, &
                               face_width=20.0_dp, centre_distance=distance, loose_inertia=1.0_dp, tip_diameter_1=tips(1), &
                               tip_diameter_2=tips(2)), 0.0_dp, 1.0_dp, contact, wrong, message)
   end function spur

   !> The example of profile shifted spur gears of the technical reference of KHK: m 3, z 12 and 24, x 0.6 and 0.36, a 56.5.
   subroutine test_tabulated_pair(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(gear_contact_t) :: contact

      contact = spur([12, 24], 56.5_dp, [44.84_dp, 79.4_dp])
      call checks%check_close(contact%working_pressure_angle, 26.0888_dp, 5.0e-5_dp, '12/24: working pressure angle')
      associate (teeth => contact%teeth)
         call checks%check_close(teeth%shift_sum, 0.96_dp, 1.0e-4_dp, '12/24: sum of profile shifts')
         call checks%check_close(teeth%shifts(1), 0.6_dp, 1.0e-4_dp, '12/24: profile shift of gear 1')
         call checks%check_close(teeth%shifts(2), 0.36_dp, 1.0e-4_dp, '12/24: profile shift of gear 2')
         call checks%check_close(teeth%addendum, 1.0_dp, 1.0e-4_dp, '12/24: addendum before the tips are shortened')
         call checks%check_close(teeth%contact_ratio, 1.202_dp, 5.0e-4_dp, '12/24: contact ratio')
         call checks%check_close(teeth%contact_ratio, 1.202118639_dp, 5.0e-10_dp, '12/24: contact ratio by mpmath')
         call checks%check_close(teeth%shift_sum, 0.960055836928_dp, 5.0e-12_dp, '12/24: sum of profile shifts by mpmath')
         call checks%check(teeth%tips_given .and. .not. teeth%is_cut_short, '12/24: tips as given')
      end associate
   end subroutine test_tabulated_pair

   !> Without tip diameters both gears have half of the shift, and tips shortened by k = -0.1267 normal modules.
   subroutine test_usual_tips(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(gear_contact_t) :: contact
      real(dp) :: tips(2), clearances(2)

      contact = spur([12, 24], 56.5_dp, [0.0_dp, 0.0_dp])
      associate (teeth => contact%teeth)
         call checks%check_close(teeth%contact_ratio, 1.216240042621_dp, 5.0e-12_dp, 'usual tips: contact ratio')
         tips = sqrt(teeth%reach**2 + [contact%base_radius_1, contact%base_radius_2]**2)
         call checks%check_close(tips(1), 22.05991624_dp, 5.0e-9_dp, 'usual tips: of gear 1')
         call checks%check_close(tips(2), 40.05991624_dp, 5.0e-9_dp, 'usual tips: of gear 2')
         ! Roots 1.25 modules below a reference circle that is shifted by x: a quarter of a module is left.
         clearances = 56.5_dp - tips - ([36.0_dp, 18.0_dp] + 3.0_dp*(0.5_dp*teeth%shift_sum - 1.25_dp))
         call checks%check(all(abs(clearances - 0.75_dp) < 1.0e-12_dp), 'usual tips: clearance')
         call checks%check(.not. (teeth%tips_given .or. teeth%is_cut_short), 'usual tips: none lower')
      end associate
   end subroutine test_usual_tips

   !> Normal thickness of tips, spur and helical (KHK: m_n 3, z 12 and 60, beta 30, x_1 0.09809, a 125).
   subroutine test_tip_thickness(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(gear_contact_t) :: contact
      character(:), allocatable :: wrong, message

      contact = spur([12, 24], 56.5_dp, [44.84_dp, 79.4_dp])
      ! The shifts follow from tips that are rounded to 0.01 mm: 1e-4 of a module.
      call checks%check_close(contact%teeth%tip_thickness(1), 0.4212669081_dp, 5.0e-4_dp, '12/24: thickness of tip 1')
      call checks%check_close(contact%teeth%tip_thickness(2), 0.7377426962_dp, 5.0e-4_dp, '12/24: thickness of tip 2')
      call find_contact(gear_t(teeth_1=12, teeth_2=60, normal_module=3.0_dp, pressure_angle_deg=20.0_dp, helix_angle_deg=30.0_dp, &
                               face_width=20.0_dp, centre_distance=125.0_dp, loose_inertia=1.0_dp, tip_diameter_1=48.15390548_dp, &
                               tip_diameter_2=213.8422406_dp), 0.0_dp, 1.0_dp, contact, wrong, message)
      call checks%check_close(contact%working_pressure_angle, 23.1126323_dp, 5.0e-7_dp, '12/60: working pressure angle')
      call checks%check_close(contact%teeth%shift_sum, 0.09809_dp, 1.0e-6_dp, '12/60: sum of profile shifts')
      call checks%check_close(contact%teeth%shifts(1), 0.09809_dp, 1.0e-6_dp, '12/60: profile shift of gear 1')
      call checks%check_close(contact%teeth%contact_ratio, 1.29391056_dp, 1.0e-8_dp, '12/60: contact ratio')
      call checks%check_close(contact%teeth%tip_thickness(1), 0.6513179804_dp, 1.0e-7_dp, '12/60: normal thickness of tip 1')
      call checks%check_close(contact%teeth%tip_thickness(2), 0.8051772756_dp, 1.0e-7_dp, '12/60: normal thickness of tip 2')
      contact = spur([12, 24], 56.5_dp, [48.0_dp, 76.24_dp])
      call checks%check(contact%teeth%tip_thickness(1) < 0.0_dp, 'a pointed tooth has a tip of less than no thickness')
   end subroutine test_tip_thickness

   !> Tips as high as usual end where their teeth are pointed, or where the line of action does.
   subroutine test_lower_tips(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(gear_contact_t) :: contact
      real(dp) :: line, half_angle

      ! Gear 2 reaches below the base circle of 10 teeth without shift.
      contact = spur([10, 60], 0.0_dp, [0.0_dp, 0.0_dp])
      line = 105.0_dp*sin(pi/9.0_dp)
      call checks%check(contact%teeth%is_cut_short, '10/60: tips would interfere')
      call checks%check_close(contact%teeth%reach(2), line, 1.0e-12_dp, '10/60: tip 2 ends where the line of action does')
      call checks%check(contact%teeth%reach(1) < 0.5_dp*line, '10/60: tip 1 is as high as usual')
      ! Half of a large shift makes 8 teeth pointed.
      contact = spur([8, 100], 167.0_dp, [0.0_dp, 0.0_dp])
      half_angle = (0.5_dp*pi + contact%teeth%shift_sum*tan(pi/9.0_dp))/8.0_dp + tan(pi/9.0_dp) - pi/9.0_dp
      call checks%check(contact%teeth%is_cut_short .and. contact%teeth%tip_thickness(1) < 0.0_dp, '8/100: teeth would be pointed')
      associate (t => contact%teeth%reach(1)/contact%base_radius_1)
         call checks%check_close(t - atan(t), half_angle, 1.0e-13_dp, '8/100: both flanks meet in the tip')
      end associate
   end subroutine test_lower_tips

   !> 14 teeth of 20 degrees may go without shift, 17 by theory; 13 and 12 may not.
   subroutine test_undercut(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(gear_contact_t) :: contact

      contact = spur([15, 40], 0.0_dp, [51.0_dp, 126.0_dp])
      call checks%check(all(contact%teeth%undercut < 0.0_dp), '15 teeth are not undercut')
      contact = spur([13, 40], 0.0_dp, [45.0_dp, 126.0_dp])
      call checks%check_close(contact%teeth%undercut(1), 5.0_dp/6.0_dp - 6.5_dp*sin(pi/9.0_dp)**2, 1.0e-13_dp, '13 teeth are')
      call checks%check(contact%teeth%undercut(2) < 0.0_dp, '40 teeth are not undercut')
      contact = spur([13, 40], 0.0_dp, [46.0_dp, 125.0_dp])
      call checks%check(contact%teeth%undercut(1) < 0.0_dp, '13 teeth are not with a profile shift of a sixth')
   end subroutine test_undercut

   !> The inverse of the involute function.
   subroutine test_inverse(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      real(dp), parameter :: angles(6) = [0.02_dp, 0.1_dp, 0.35_dp, 0.8_dp, 1.3_dp, 1.55_dp]

      ! inv alpha is alpha**3/3 for small angles, and known to a rounding of alpha.
      call checks%check(all(abs(inverse_involute(involute(angles)) - angles) < 4.0_dp*epsilon(1.0_dp)/angles), 'inverse involute')
      call checks%check_close(inverse_involute(0.0_dp), 0.0_dp, 0.0_dp, 'inverse involute of 0')
      ! inv 20 degrees of every table
      call checks%check_close(inverse_involute(0.014904_dp)*180.0_dp/pi, 20.0_dp, 1.0e-3_dp, 'inverse involute of a table')
   end subroutine test_inverse

   !> The largest contact ratio of any teeth, against all shares of the pitch that both pointed teeth may have.
   subroutine test_largest_ratio(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call check(11, 38, 30.0_dp)
      call check(40, 60, 20.0_dp)
      call check(25, 25, 44.0_dp)
      ! At a small pressure angle the line of action is shorter than a pitch.
      call checks%check_close(largest_contact_ratio(50.0_dp, 5.0_dp*pi/180.0_dp), 50.0_dp*tan(5.0_dp*pi/180.0_dp)/(2.0_dp*pi), &
                              1.0e-14_dp, 'the whole line of action')

   contains

      subroutine check(first, second, degrees)
         integer, intent(in) :: first
         integer, intent(in) :: second
         real(dp), intent(in) :: degrees
         integer, parameter :: shares = 2000
         real(dp) :: z(2), alpha, share, ratio, best
         integer :: i

         z = real([first, second], dp)
         alpha = degrees*pi/180.0_dp
         best = 0.0_dp
         do i = 1, shares - 1
            share = real(i, dp)/real(shares, dp)
            ! Base radii z/2: the base pitch is pi.
            ratio = (0.5_dp*z(1)*pointed(z(1), alpha, share) + 0.5_dp*z(2)*pointed(z(2), alpha, 1.0_dp - share) &
                     - 0.5_dp*sum(z)*tan(alpha))/pi
            best = max(best, ratio)
         end do
         ! A maximum is missed by the square of the step.
         call checks%check(largest_contact_ratio(sum(z), alpha) > best - 1.0e-12_dp, 'no teeth have a larger contact ratio')
         call checks%check_close(largest_contact_ratio(sum(z), alpha), best, 1.0e-5_dp, 'some teeth have the largest')
      end subroutine check

      !> tan alpha_a where a tooth is pointed that has a share of the pitch at the pitch circle, by bisection.
      pure real(dp) function pointed(teeth, alpha, share) result(middle)
         real(dp), intent(in) :: teeth
         real(dp), intent(in) :: alpha
         real(dp), intent(in) :: share
         real(dp) :: low, high
         integer :: i

         low = tan(alpha)
         high = 100.0_dp
         do i = 1, 60
            middle = 0.5_dp*(low + high)
            ! Half the thickness as an angle: at the pitch circle, less what the flank turns by up to the tip.
            if (pi*share/teeth > (middle - atan(middle)) - (tan(alpha) - alpha)) then
               low = middle
            else
               high = middle
            end if
         end do
      end function pointed

   end subroutine test_largest_ratio

   !> Pairs that no teeth make, each with the value that would have to change.
   subroutine test_refused(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(gear_t) :: pair

      pair = gear_t(teeth_1=11, teeth_2=38, normal_module=2.5e-3_dp, pressure_angle_deg=20.0_dp, helix_angle_deg=28.96_dp, &
                    face_width=0.016_dp, loose_inertia=1.0e-3_dp)
      call check('as it is', '', '')
      pair%centre_distance = 0.088_dp
      call check('far apart', '', '')
      pair%centre_distance = 0.089_dp
      call check('too far apart', 'centre_distance', 'at 0.08900 m, a pressure angle of 43.4')
      pair%centre_distance = 0.70_dp
      call check('ten times as far apart', 'centre_distance', 'without profile shift it is 0.07000 m')
      ! 49 tan(alpha_wt) = 2 pi at 7.307 degrees, 65.163 mm
      pair%centre_distance = 0.06517_dp
      call check('close', '', '')
      pair%centre_distance = 0.06515_dp
      call check('too close', 'centre_distance', 'no teeth have a contact ratio of 1')
      pair%centre_distance = 0.0_dp
      pair%teeth_1 = 3
      pair%teeth_2 = 4
      call check('of few teeth', 'teeth_1', 'no teeth of so many')
      ! 2 modules of addendum: 1.16 pitches would be needed.
      pair = gear_t(teeth_1=40, teeth_2=60, normal_module=2.0e-3_dp, pressure_angle_deg=20.0_dp, face_width=0.02_dp, &
                    loose_inertia=1.0e-3_dp, tip_diameter_1=0.088_dp, tip_diameter_2=0.128_dp)
      call check('pointed', 'tip_diameter_1', 'would need 1.16 of the pitch')
      pair%tip_diameter_1 = 0.084_dp
      call check('one of them lower', '', '')
      pair%contact_position = 0.0055_dp
      call check('touching beyond a tip', 'contact_position', 'no teeth touch there')
      pair%contact_position = 0.0040_dp
      call check('touching below it', '', '')

   contains

      subroutine check(what, expected, words)
         character(*), intent(in) :: what
         character(*), intent(in) :: expected
         character(*), intent(in) :: words
         type(gear_contact_t) :: contact
         character(:), allocatable :: wrong, message

         call find_contact(pair, 0.0_dp, 10.0_dp, contact, wrong, message)
         call checks%check(wrong == expected .and. index(message, words) > 0, 'a pair '//what//': '//wrong//' '//message)
      end subroutine check

   end subroutine test_refused

end module test_involute_teeth
