!> From the data of a gear pair to the contact of two flanks: an involute pair with parallel axes and external teeth. Gear 1 is
!> on the shaft and drives, gear 2 is loose. Lengths along the line of action lie in the transverse plane. Radius and speeds at a
!> point agree with ISO/TR 15144-1 (normal radius of relative curvature, sum of the tangential velocities).
module gear_contact
   use constants, only: pi, two_pi
   use kinds, only: dp
   use scene_types, only: gear_t
   implicit none(type, external)
   private

   real(dp), parameter :: degree = pi/180.0_dp

   !> The contact of the flanks of a gear pair.
   type, public :: gear_contact_t
      !> Base radii r_b1 and r_b2, and centre distance a [m]
      real(dp) :: base_radius_1 = 0.0_dp
      real(dp) :: base_radius_2 = 0.0_dp
      real(dp) :: centre_distance = 0.0_dp
      !> Working pressure angle alpha_wt and base helix angle beta_b [degrees]
      real(dp) :: working_pressure_angle = 0.0_dp
      real(dp) :: base_helix_angle = 0.0_dp
      !> Ends of the line of action, where it touches the base circles [m]
      real(dp) :: first_position = 0.0_dp
      real(dp) :: last_position = 0.0_dp
      !> Equivalent radius R and length l of the contact, and width of all teeth in contact [m]
      real(dp) :: radius = 0.0_dp
      real(dp) :: length = 0.0_dp
      real(dp) :: tooth_width = 0.0_dp
      !> Contact ratios eps_alpha, by the tip diameters or those of teeth as high as usual, and eps_beta; lines in contact
      real(dp) :: contact_ratio = 0.0_dp
      real(dp) :: overlap_ratio = 0.0_dp
      real(dp) :: contact_lines = 0.0_dp
      !> Surface speeds u_1 and u_2, and entrainment speed U [m/s]
      real(dp) :: surface_speed_1 = 0.0_dp
      real(dp) :: surface_speed_2 = 0.0_dp
      real(dp) :: entrainment_speed = 0.0_dp
      !> Mass m of the loose gear at the flank [kg] and force Q of the drag torque [N]
      real(dp) :: mass = 0.0_dp
      real(dp) :: steady_force = 0.0_dp
      !> Force for each rad/s2 of angular acceleration of the shaft, m cos(beta_b) r_b1 [N s2/rad]
      real(dp) :: force_per_acceleration = 0.0_dp
   end type gear_contact_t

   public :: find_contact

contains

   !> The contact of a gear pair. What is wrong with it is reported with the name of the value that would have to change.
   pure subroutine find_contact(pair, drag_torque, shaft_speed, contact, wrong, message)
      !> The pair: teeth z_1 and z_2, normal module m_n, centre distance a, place xi on the line of action
      type(gear_t), intent(in) :: pair
      !> Drag torque T_d on the loose gear [N m]
      real(dp), intent(in) :: drag_torque
      !> Speed n/60 of the shaft [1/s]
      real(dp), intent(in) :: shaft_speed
      !> Its contact; radii, angles and ends of the line of action are known too where only contact_position is wrong
      type(gear_contact_t), intent(out) :: contact
      !> Component of the pair that is wrong, empty if none is
      character(:), allocatable, intent(out) :: wrong
      !> What is wrong with it
      character(:), allocatable, intent(out) :: message
      real(dp) :: transverse_module, helix, transverse_angle, base_helix, working, rho_1, rho_2

      wrong = ''
      message = ''
      helix = degree*pair%helix_angle_deg
      transverse_module = pair%normal_module/cos(helix)
      transverse_angle = atan(tan(degree*pair%pressure_angle_deg)/cos(helix))
      base_helix = asin(sin(helix)*cos(degree*pair%pressure_angle_deg))
      contact%base_helix_angle = base_helix/degree
      contact%base_radius_1 = 0.5_dp*transverse_module*real(pair%teeth_1, dp)*cos(transverse_angle)
      contact%base_radius_2 = 0.5_dp*transverse_module*real(pair%teeth_2, dp)*cos(transverse_angle)
      contact%centre_distance = pair%centre_distance
      if (.not. pair%centre_distance > 0.0_dp) &
         contact%centre_distance = 0.5_dp*transverse_module*real(pair%teeth_1 + pair%teeth_2, dp)
      if (.not. contact%base_radius_1 + contact%base_radius_2 < contact%centre_distance) then
         wrong = 'centre_distance'
         message = 'it must exceed the sum of the base radii'
         return
      end if
      working = acos((contact%base_radius_1 + contact%base_radius_2)/contact%centre_distance)
      contact%working_pressure_angle = working/degree
      contact%first_position = -contact%base_radius_1*tan(working)
      contact%last_position = contact%base_radius_2*tan(working)
      rho_1 = pair%contact_position - contact%first_position
      rho_2 = contact%last_position - pair%contact_position
      if (.not. min(rho_1, rho_2) > 0.0_dp) then
         wrong = 'contact_position'
         message = 'it lies beyond the line of action, which touches the base circles at its ends'
         return
      end if
      call find_contact_ratios(pair, transverse_module, transverse_angle, working, contact, wrong, message)
      if (len(wrong) > 0) return
      contact%radius = rho_1*rho_2/((rho_1 + rho_2)*cos(base_helix))
      contact%tooth_width = pair%face_width*contact%contact_lines
      contact%length = contact%tooth_width/cos(base_helix)
      contact%surface_speed_1 = two_pi*shaft_speed*rho_1
      contact%surface_speed_2 = two_pi*shaft_speed*rho_2*real(pair%teeth_1, dp)/real(pair%teeth_2, dp)
      contact%entrainment_speed = 0.5_dp*(contact%surface_speed_1 + contact%surface_speed_2)
      contact%mass = pair%loose_inertia/(contact%base_radius_2*cos(base_helix))**2
      contact%steady_force = drag_torque/(contact%base_radius_2*cos(base_helix))
      contact%force_per_acceleration = contact%mass*cos(base_helix)*contact%base_radius_1
   end subroutine find_contact

   !> Contact ratios, and the lines in contact: with tip diameters the transverse contact ratio, since the mean length of all lines
   !> is eps_alpha b/cos beta_b whatever eps_beta is. Without them the ratio is that of tips at r + m_n (1 + x), both
   !> gears with half of the sum of the profile shifts. ISO 21771.
   pure subroutine find_contact_ratios(pair, transverse_module, transverse_angle, working, contact, wrong, message)
      type(gear_t), intent(in) :: pair
      real(dp), intent(in) :: transverse_module
      !> alpha_t and alpha_wt [rad]
      real(dp), intent(in) :: transverse_angle
      real(dp), intent(in) :: working
      !> With base radii and centre distance
      type(gear_contact_t), intent(inout) :: contact
      character(:), allocatable, intent(inout) :: wrong
      character(:), allocatable, intent(inout) :: message
      character(*), parameter :: names(2) = ['tip_diameter_1', 'tip_diameter_2']
      real(dp) :: tips(2), bases(2), roots(2), line, shift, helix
      logical :: given
      integer :: i

      helix = degree*pair%helix_angle_deg
      given = pair%tip_diameter_1 > 0.0_dp .and. pair%tip_diameter_2 > 0.0_dp
      shift = 0.5_dp*real(pair%teeth_1 + pair%teeth_2, dp)*(involute(working) - involute(transverse_angle)) &
              /(2.0_dp*tan(degree*pair%pressure_angle_deg))
      tips = 0.5_dp*transverse_module*real([pair%teeth_1, pair%teeth_2], dp) + pair%normal_module*(1.0_dp + shift)
      if (given) tips = 0.5_dp*[pair%tip_diameter_1, pair%tip_diameter_2]
      bases = [contact%base_radius_1, contact%base_radius_2]
      line = contact%centre_distance*sin(working)
      roots = sqrt(max(0.0_dp, (tips - bases)*(tips + bases)))
      contact%contact_ratio = (sum(roots) - line)/(pi*transverse_module*cos(transverse_angle))
      contact%overlap_ratio = pair%face_width*sin(abs(helix))/(pi*pair%normal_module)
      contact%contact_lines = pair%contact_lines
      if (.not. given) return
      contact%contact_lines = contact%contact_ratio
      do i = 1, 2
         if (len(wrong) > 0) exit
         if (tips(i) <= bases(i)) message = 'the tip lies within the base circle'
         if (roots(i) > line) message = 'tips interfere: it reaches beyond the end of the line of action'
         if (len(message) > 0) wrong = names(i)
      end do
      if (len(wrong) > 0 .or. contact%contact_ratio > 0.0_dp) return
      wrong = names(1)
      message = 'the teeth of both gears do not reach each other'
   end subroutine find_contact_ratios

   !> inv alpha = tan alpha - alpha.
   pure real(dp) function involute(angle)
      !> [rad]
      real(dp), intent(in) :: angle

      involute = tan(angle) - angle
   end function involute

end module gear_contact
