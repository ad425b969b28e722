!> What brakes a loose gear, part by part: its bearing, the gaps of its synchroniser, the oil that it churns. Each torque is a
!> positive size; which way it pulls is decided in module loose_gear_drag.
module drag_parts
   use constants, only: pi, standard_gravity
   use kinds, only: dp
   implicit none(type, external)
   private

   !> Heat conductivity of oil [W/(m K)]
   real(dp), parameter :: conductivity = 0.14_dp
   !> Above this Taylor number the flow in a sheared gap is no longer laminar (Taylor 1923)
   real(dp), parameter, public :: largest_laminar = 41.0_dp

   public :: needle_bearing_torque, sheared_gap_torque, taylor_number, churning_torque

contains

   !> Needle bearing without load: 1e-10 f_0 (1000 d_m)^3 max(160, (nu n)^(2/3)) (Palmgren 1959; Harris, Rolling Bearing
   !> Analysis). Printed, 160 holds below nu n = 2000, where the power is 0.8 % less: the larger of both has no jump.
   elemental real(dp) function needle_bearing_torque(factor, diameter, viscosity, speed_rpm) result(torque)
      !> f_0: 6 oil mist, 12 oil bath or grease, 24 jet or vertical
      real(dp), intent(in) :: factor
      !> Mean diameter d_m [m]
      real(dp), intent(in) :: diameter
      !> Kinematic viscosity nu [mm2/s]
      real(dp), intent(in) :: viscosity
      !> Size of the speed of the gear against its shaft [1/min]; without any there is no torque
      real(dp), intent(in) :: speed_rpm
      real(dp), parameter :: least_power = 160.0_dp

      torque = 0.0_dp
      if (speed_rpm > 0.0_dp) torque = 1.0e-10_dp*factor*(1.0e3_dp*diameter)**3* &
                                       max(least_power, (viscosity*speed_rpm)**(2.0_dp/3.0_dp))
   end function needle_bearing_torque

   !> Oil that is sheared in a full gap between cylinder or cone and ring: 2 pi eta w (d/2)^3 b/s (Petrov 1883), less by the
   !> heating of the film between walls as warm as the oil: times asinh(q)/(q sqrt(1 + q^2)), q^2 = beta eta (w d/2)^2/(8 k)
   !> (Nahme 1940). The angle of a cone enters by 0.02 % only.
   elemental real(dp) function sheared_gap_torque(diameter, width, gap, viscosity, slope, speed) result(torque)
      !> Mean diameter d, width b, gap s normal to the wall [m]
      real(dp), intent(in) :: diameter
      real(dp), intent(in) :: width
      real(dp), intent(in) :: gap
      !> Dynamic viscosity eta [Pa s], and share beta by which it falls with a kelvin [1/K]
      real(dp), intent(in) :: viscosity
      real(dp), intent(in) :: slope
      !> Size of the speed w of one wall against the other [rad/s]
      real(dp), intent(in) :: speed
      real(dp) :: q

      torque = 2.0_dp*pi*viscosity*speed*(0.5_dp*diameter)**3*width/gap
      q = 0.5_dp*speed*diameter*sqrt(slope*viscosity/(8.0_dp*conductivity))
      if (q > 0.0_dp) torque = torque*asinh(q)/(q*sqrt(1.0_dp + q**2))
   end function sheared_gap_torque

   !> Taylor number of a sheared gap, w (d/2) s/nu sqrt(2 s/d).
   elemental real(dp) function taylor_number(diameter, gap, viscosity, speed) result(number)
      !> Mean diameter d and gap s [m]
      real(dp), intent(in) :: diameter
      real(dp), intent(in) :: gap
      !> Kinematic viscosity nu [m2/s]
      real(dp), intent(in) :: viscosity
      !> Size of the speed of one wall against the other [rad/s]
      real(dp), intent(in) :: speed

      number = 0.5_dp*speed*diameter*gap/viscosity*sqrt(2.0_dp*gap/diameter)
   end function taylor_number

   !> A gear that dips into oil: 0.5 rho w^2 R^3 S_m C_m (Changenet and Velex 2007, J. Mech. Des. 129, 128-133). Tested there on
   !> single gears of module 1.5 to 5 mm, D 96 to 159 mm, 1000 to 7000 1/min and some tens to 300 mm2/s.
   elemental real(dp) function churning_torque(teeth, normal_module, transverse_angle, helix_angle, width, depth, volume, density, &
                                               viscosity, speed) result(torque)
      !> Teeth z_2 and normal module m_n [m]
      integer, intent(in) :: teeth
      real(dp), intent(in) :: normal_module
      !> Transverse pressure angle alpha_t and helix angle beta [rad]
      real(dp), intent(in) :: transverse_angle
      real(dp), intent(in) :: helix_angle
      !> Face width b, depth h of the lowest point of the reference circle below the oil in motion [m], from 0 to its diameter
      real(dp), intent(in) :: width
      real(dp), intent(in) :: depth
      !> Volume V_0 of the oil [m3], its density [kg/m3] and kinematic viscosity nu [m2/s]
      real(dp), intent(in) :: volume
      real(dp), intent(in) :: density
      real(dp), intent(in) :: viscosity
      !> Size of the speed w_2 of the gear against the housing [rad/s]
      real(dp), intent(in) :: speed
      !> Reynolds numbers w_2 R b/nu between which one formula goes over into the other
      real(dp), parameter :: first_branch = 6.0e3_dp, second_branch = 9.0e3_dp
      real(dp) :: radius, diameter, t, surface, froude, slow, fast, share

      torque = 0.0_dp
      if (.not. (depth > 0.0_dp .and. speed > 0.0_dp)) return
      radius = 0.5_dp*normal_module*real(teeth, dp)/cos(helix_angle)
      diameter = 2.0_dp*radius
      t = acos(max(-1.0_dp, 1.0_dp - depth/radius))
      ! S_m: both faces, the rim, and the flanks of teeth that are H = 2.25 m_n high
      surface = radius**2*(2.0_dp*t - sin(2.0_dp*t)) + diameter*width*t &
                + 2.0_dp*real(teeth, dp)*t*2.25_dp*normal_module*width/(pi*cos(transverse_angle)*cos(helix_angle))
      froude = speed**2*radius/standard_gravity
      slow = 1.366_dp*(depth/diameter)**0.45_dp*(volume/diameter**3)**0.1_dp*froude**(-0.6_dp)* &
             (speed*radius**2/viscosity)**(-0.21_dp)
      fast = 3.644_dp*(depth/diameter)**0.1_dp*(volume/diameter**3)**(-0.35_dp)*froude**(-0.88_dp)*(width/diameter)**0.85_dp
      share = (speed*radius*width/viscosity - first_branch)/(second_branch - first_branch)
      share = min(1.0_dp, max(0.0_dp, share))
      torque = 0.5_dp*density*speed**2*radius**3*surface*((1.0_dp - share)*slow + share*fast)
   end function churning_torque

end module drag_parts
