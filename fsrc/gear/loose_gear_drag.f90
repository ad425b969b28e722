!> The drag torque on a loose gear at its speed and the temperature of its oil: as given, from a measured table, or computed from
!> drawing and oil. Bearing and synchroniser brake the gear against its own shaft, churning against the housing:
!>
!>    T_d = sign(n_rel) (T_bearing + T_synchroniser) + T_churning ,  n_rel = n (z_1/z_2 - kappa)
!>
!> Where its own shaft is faster than the gear it pulls the gear forward, and T_d may be negative. Gaps are taken as full, and a
!> cold bearing as not starved: an upper bound.
module loose_gear_drag
   use constants, only: pi, two_pi
   use drag_parts, only: churning_torque, largest_laminar, needle_bearing_torque, sheared_gap_torque, taylor_number
   use kinds, only: dp
   use oil_data, only: kinematic_viscosity, oil_density, oil_viscosity, viscosity_temperature_slope
   use scene_types, only: drag_computed, drag_given, drag_t, drag_tabulated, gear_t, oil_t
   use table_values, only: torque_of_table
   implicit none(type, external)
   private

   public :: drag_of_gear, reference_diameter, gap_is_turbulent

contains

   !> Drag torque of a pair.
   pure type(drag_t) function drag_of_gear(gear, speed_rpm, oil) result(drag)
      !> Its numbers need not be those of a gear that exists: then the drag is of no use, and rules say so
      type(gear_t), intent(in) :: gear
      !> Speed n of gear 1 [1/min]
      real(dp), intent(in) :: speed_rpm
      type(oil_t), intent(in) :: oil

      drag%known_by = gear%drag_known_by()
      select case (drag%known_by)
      case (drag_given)
         drag%torque = gear%drag_torque
      case (drag_tabulated)
         drag%torque = gear%drag_scale*torque_of_table(gear%drag_table, speed_rpm, oil%temperature_celsius)
      case (drag_computed)
         call compute(gear, speed_rpm, oil, drag)
      case default
         continue
      end select
   end function drag_of_gear

   !> From drawing and oil.
   pure subroutine compute(gear, speed_rpm, oil, drag)
      type(gear_t), intent(in) :: gear
      real(dp), intent(in) :: speed_rpm
      type(oil_t), intent(in) :: oil
      type(drag_t), intent(inout) :: drag
      real(dp), parameter :: degree = pi/180.0_dp, mm2 = 1.0e-6_dp
      real(dp) :: relative, nu, eta, beta, helix, forward

      nu = kinematic_viscosity(oil%viscosity_40_cst, oil%viscosity_100_cst, oil%temperature_celsius)
      eta = oil_viscosity(oil%viscosity_40_cst, oil%viscosity_100_cst, oil%density_15, oil%temperature_celsius)
      if (.not. min(eta, gear%normal_module, gear%face_width) > 0.0_dp .or. min(gear%teeth_1, gear%teeth_2) < 1) return
      beta = viscosity_temperature_slope(oil%viscosity_40_cst, oil%viscosity_100_cst, oil%density_15, oil%temperature_celsius)
      relative = relative_speed(gear, speed_rpm)
      forward = gear%drag_scale*sign(1.0_dp, relative)
      relative = abs(relative)
      if (has_plain_bearing(gear)) then
         drag%bearing = forward*sheared_gap_torque(gear%bearing_mean_diameter, gear%bearing_width, gear%bearing_clearance, &
                                                   eta, beta, two_pi/60.0_dp*relative)
      else
         drag%bearing = forward*needle_bearing_torque(gear%bearing_factor, gear%bearing_mean_diameter, nu, relative)
      end if
      if (gear%synchroniser_cones > 0 .and. gear%synchroniser_gap > 0.0_dp) &
         drag%synchroniser = forward*real(gear%synchroniser_cones, dp)* &
                             sheared_gap_torque(gear%synchroniser_diameter, gear%synchroniser_width, gear%synchroniser_gap, &
                                                eta, beta, two_pi/60.0_dp*relative)
      helix = degree*gear%helix_angle_deg
      drag%churning = gear%drag_scale* &
                      churning_torque(gear%teeth_2, gear%normal_module, atan(tan(degree*gear%pressure_angle_deg)/cos(helix)), &
                                      helix, gear%face_width, gear%immersion_depth, oil%volume, &
                                      oil_density(oil%density_15, oil%temperature_celsius), mm2*nu, &
                                      two_pi/60.0_dp*speed_rpm*real(gear%teeth_1, dp)/real(gear%teeth_2, dp))
      drag%torque = drag%bearing + drag%synchroniser + drag%churning
   end subroutine compute

   !> Speed n_rel of the loose gear against the shaft that carries it [1/min]. A ratio that is meant to be that of the pair may be
   !> off by rounding.
   pure real(dp) function relative_speed(gear, speed_rpm) result(relative)
      type(gear_t), intent(in) :: gear
      real(dp), intent(in) :: speed_rpm
      real(dp) :: ratio

      ratio = real(gear%teeth_1, dp)/real(gear%teeth_2, dp)
      relative = speed_rpm*(ratio - gear%own_shaft_ratio)
      if (abs(ratio - gear%own_shaft_ratio) <= 2.0_dp*spacing(ratio)) relative = 0.0_dp
   end function relative_speed

   !> Whether the gear turns on a plain bearing.
   pure logical function has_plain_bearing(gear)
      type(gear_t), intent(in) :: gear

      has_plain_bearing = gear%bearing_width > 0.0_dp .and. gear%bearing_clearance > 0.0_dp
   end function has_plain_bearing

   !> Reference diameter of the loose gear [m].
   pure real(dp) function reference_diameter(gear)
      type(gear_t), intent(in) :: gear

      reference_diameter = gear%normal_module*real(gear%teeth_2, dp)/cos(pi/180.0_dp*gear%helix_angle_deg)
   end function reference_diameter

   !> Whether oil whirls in a gap of the synchroniser or of a plain bearing, which then brakes more than is computed.
   pure logical function gap_is_turbulent(gear, speed_rpm, oil)
      !> A computed drag
      type(gear_t), intent(in) :: gear
      real(dp), intent(in) :: speed_rpm
      type(oil_t), intent(in) :: oil
      real(dp) :: speed, nu

      nu = 1.0e-6_dp*kinematic_viscosity(oil%viscosity_40_cst, oil%viscosity_100_cst, oil%temperature_celsius)
      speed = two_pi/60.0_dp*abs(relative_speed(gear, speed_rpm))
      gap_is_turbulent = .false.
      if (gear%synchroniser_cones > 0) gap_is_turbulent = &
         taylor_number(gear%synchroniser_diameter, gear%synchroniser_gap, nu, speed) > largest_laminar
      if (has_plain_bearing(gear)) gap_is_turbulent = gap_is_turbulent .or. &
         taylor_number(gear%bearing_mean_diameter, gear%bearing_clearance, nu, speed) > largest_laminar
   end function gap_is_turbulent

end module loose_gear_drag
