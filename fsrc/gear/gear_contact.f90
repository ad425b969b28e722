!> From the data of a gear pair to the contact of two flanks: an involute pair with parallel axes and external teeth. Gear 1 is
!> on the shaft and drives, gear 2 is loose. Lengths along the line of action lie in the transverse plane. Radius and speeds at a
!> point agree with ISO/TR 15144-1 (normal radius of relative curvature, sum of the tangential velocities).
module gear_contact
   use constants, only: pi, two_pi
   use involute_teeth, only: find_teeth, mesh_t, pitch_share
   use kinds, only: dp
   use scene_rules, only: sentence_length
   use scene_types, only: gear_t, teeth_t
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
      !> The teeth, and the lines in contact: where tip diameters are given eps_alpha, since the mean length of all lines is
      !> eps_alpha b/cos beta_b whatever eps_beta is
      type(teeth_t) :: teeth
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
      !> Its contact; radii, angles, ends of the line of action and teeth are known too where only contact_position is wrong
      type(gear_contact_t), intent(out) :: contact
      !> Component of the pair that is wrong, empty if none is
      character(:), allocatable, intent(out) :: wrong
      !> What is wrong with it
      character(:), allocatable, intent(out) :: message
      type(mesh_t) :: mesh
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
      mesh = mesh_t(0.5_dp*transverse_module*real([pair%teeth_1, pair%teeth_2], dp), &
                    [contact%base_radius_1, contact%base_radius_2], contact%centre_distance, transverse_angle, working, helix)
      contact%teeth = find_teeth(pair, mesh)
      call find_wrong_teeth(pair, mesh, contact%teeth, wrong, message)
      if (len(wrong) > 0) return
      rho_1 = pair%contact_position - contact%first_position
      rho_2 = contact%last_position - pair%contact_position
      if (.not. min(rho_1, rho_2) > 0.0_dp) then
         wrong = 'contact_position'
         message = 'it lies beyond the line of action, which touches the base circles at its ends'
         return
      end if
      if (contact%teeth%tips_given .and. any([rho_1, rho_2] > contact%teeth%reach)) then
         wrong = 'contact_position'
         message = 'no teeth touch there: it lies beyond a tip'
         return
      end if
      contact%contact_lines = pair%contact_lines
      if (contact%teeth%tips_given) contact%contact_lines = contact%teeth%contact_ratio
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

   !> What is wrong with the teeth of a pair, empty if nothing is, with the name of the value that would have to change.
   pure subroutine find_wrong_teeth(pair, mesh, teeth, wrong, message)
      type(gear_t), intent(in) :: pair
      type(mesh_t), intent(in) :: mesh
      type(teeth_t), intent(in) :: teeth
      character(:), allocatable, intent(inout) :: wrong
      character(:), allocatable, intent(inout) :: message
      character(*), parameter :: names(2) = ['tip_diameter_1', 'tip_diameter_2']
      character(sentence_length) :: sentence
      character(12) :: numbers(3)
      real(dp) :: share
      integer :: i

      if (teeth%largest_ratio < 1.0_dp) then
         wrong = 'centre_distance'
         write (numbers, '(f12.5)') mesh%distance, mesh%working_angle/degree, sum(mesh%reference)
         numbers = adjustl(numbers)
         sentence = 'no teeth have a contact ratio of 1 at '//trim(numbers(1))//' m, a pressure angle of '//trim(numbers(2))// &
                    ' deg; without profile shift it is '//trim(numbers(3))//' m'
         if (.not. pair%centre_distance > 0.0_dp) then
            wrong = trim(merge('teeth_1           ', 'pressure_angle_deg', tan(mesh%working_angle) < 1.0_dp))
            sentence = 'no teeth of so many have a contact ratio of 1 at a transverse pressure angle of '//trim(numbers(2))//' deg'
         end if
         message = trim(sentence)
         return
      end if
      if (.not. teeth%tips_given) return
      do i = 1, 2
         if (.not. teeth%reach(i) > 0.0_dp) message = 'the tip lies within the base circle'
         if (teeth%reach(i) > mesh%distance*sin(mesh%working_angle)) &
            message = 'tips interfere: it reaches beyond the end of the line of action'
         if (len(message) > 0) then
            wrong = names(i)
            return
         end if
      end do
      share = pitch_share(pair, mesh, teeth%reach)
      if (share > 1.0_dp) then
         wrong = names(1)
         write (sentence, '(a, g0.3, a)') 'teeth are pointed below such tips, whatever their profile shifts: those of both '// &
            'gears would need ', share, ' of the pitch at the pitch circles'
         message = trim(sentence)
      else if (.not. teeth%contact_ratio > 0.0_dp) then
         wrong = names(1)
         message = 'the teeth of both gears do not reach each other'
      end if
   end subroutine find_wrong_teeth

end module gear_contact
