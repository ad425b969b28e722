!> The teeth of an involute pair with parallel axes and external teeth (ISO 21771): the profile shifts that its centre distance
!> needs, its tips, how thick teeth are there, and its contact ratios. All is transverse unless it is said to be normal.
module involute_teeth
   use constants, only: pi, two_pi
   use kinds, only: dp
   use scene_types, only: gear_t, teeth_t
   implicit none(type, external)
   private

   !> Where the pair meshes.
   type, public :: mesh_t
      !> Reference and base radii [m]
      real(dp) :: reference(2) = 0.0_dp
      real(dp) :: base(2) = 0.0_dp
      !> Centre distance a [m]
      real(dp) :: distance = 0.0_dp
      !> Pressure angles alpha_t at the reference circles and alpha_wt at the pitch circles, helix angle beta [rad]
      real(dp) :: pressure_angle = 0.0_dp
      real(dp) :: working_angle = 0.0_dp
      real(dp) :: helix_angle = 0.0_dp
   end type mesh_t

   real(dp), parameter :: degree = pi/180.0_dp
   !> Share of the addendum of the rack up to which undercut does no harm: 14 teeth of 20 degrees where theory has 17 (DIN 3960)
   real(dp), parameter :: undercut_share = 5.0_dp/6.0_dp

   public :: find_teeth, largest_contact_ratio, pitch_share, involute, inverse_involute

contains

   !> The teeth of a pair. Without tip diameters both gears have half of the sum of the profile shifts, addenda of a normal module,
   !> and tips shortened by k m_n as ISO 21771 has it, so that their clearance stays; no tip lies beyond where teeth are pointed,
   !> nor beyond the end of the line of action.
   pure type(teeth_t) function find_teeth(pair, mesh) result(teeth)
      type(gear_t), intent(in) :: pair
      type(mesh_t), intent(in) :: mesh
      real(dp) :: z(2), tips(2), reach(2), line, half_angle(2), shortening

      z = real([pair%teeth_1, pair%teeth_2], dp)
      associate (module_n => pair%normal_module, angle_n => degree*pair%pressure_angle_deg)
         teeth%tips_given = pair%tip_diameter_1 > 0.0_dp .and. pair%tip_diameter_2 > 0.0_dp
         teeth%shift_sum = 0.0_dp
         if (pair%centre_distance > 0.0_dp) teeth%shift_sum = &
            0.5_dp*sum(z)*(involute(mesh%working_angle) - involute(mesh%pressure_angle))/tan(angle_n)
         shortening = (mesh%distance - sum(mesh%reference))/module_n - teeth%shift_sum
         if (teeth%tips_given) then
            tips = 0.5_dp*[pair%tip_diameter_1, pair%tip_diameter_2]
            ! Equal addenda show how the sum is shared.
            associate (above => (tips - mesh%reference)/module_n)
               teeth%shifts = 0.5_dp*(teeth%shift_sum + [above(1) - above(2), above(2) - above(1)])
               teeth%addendum = 0.5_dp*(sum(above) - teeth%shift_sum) - shortening
            end associate
         else
            teeth%shifts = 0.5_dp*teeth%shift_sum
            teeth%addendum = 1.0_dp
            tips = mesh%reference + module_n*(teeth%addendum + teeth%shifts + shortening)
         end if
         half_angle = (0.5_dp*pi + 2.0_dp*teeth%shifts*tan(angle_n))/z + involute(mesh%pressure_angle)
         reach = sqrt(max(0.0_dp, (tips - mesh%base)*(tips + mesh%base)))
         line = mesh%distance*sin(mesh%working_angle)
         teeth%tip_thickness = 2.0_dp*tips*(half_angle - involute(atan2(reach, mesh%base))) &
                               *cos(atan(tan(mesh%helix_angle)*tips/mesh%reference))/module_n
         teeth%undercut = undercut_share*teeth%addendum - teeth%shifts &
                          - 0.5_dp*z*sin(mesh%pressure_angle)**2/cos(mesh%helix_angle)
         if (.not. teeth%tips_given) then
            teeth%is_cut_short = any(reach > line .or. teeth%tip_thickness < 0.0_dp)
            reach = min(reach, line, mesh%base*tan(inverse_involute(max(0.0_dp, half_angle))))
         end if
         teeth%reach = reach
         teeth%contact_ratio = (sum(reach) - line)*z(1)/(two_pi*mesh%base(1))
         teeth%overlap_ratio = pair%face_width*sin(abs(mesh%helix_angle))/(pi*module_n)
         teeth%largest_ratio = largest_contact_ratio(sum(z), mesh%working_angle)
      end associate
   end function find_teeth

   !> The largest transverse contact ratio that any teeth have at a working pressure angle. Their thicknesses at the pitch circles
   !> add up to the pitch at most; tips that are pointed then reach farthest along the line of action where both have the same
   !> pressure angle, inv alpha_a = inv alpha_wt + pi/(z_1 + z_2). And no contact lies beyond the ends of the line of action.
   elemental real(dp) function largest_contact_ratio(teeth, working_angle) result(ratio)
      !> z_1 + z_2
      real(dp), intent(in) :: teeth
      !> alpha_wt [rad]
      real(dp), intent(in) :: working_angle

      ratio = teeth/two_pi*min(tan(inverse_involute(involute(working_angle) + pi/teeth)) - tan(working_angle), tan(working_angle))
   end function largest_contact_ratio

   !> Share of the pitch that the teeth of both gears need at the pitch circles so as not to be pointed below their tips, whatever
   !> their profile shifts are; from 1 on there are no such teeth.
   pure real(dp) function pitch_share(pair, mesh, reach)
      type(gear_t), intent(in) :: pair
      type(mesh_t), intent(in) :: mesh
      !> sqrt(r_a**2 - r_b**2) of both tips [m]
      real(dp), intent(in) :: reach(2)

      pitch_share = sum(real([pair%teeth_1, pair%teeth_2], dp)*(involute(atan2(reach, mesh%base)) &
                                                                 - involute(mesh%working_angle)))/pi
   end function pitch_share

   !> inv alpha = tan alpha - alpha.
   elemental real(dp) function involute(angle)
      !> [rad]
      real(dp), intent(in) :: angle

      involute = tan(angle) - angle
   end function involute

   !> The angle of an involute function, by Newton's method for t = tan alpha: t - atan t, which is convex, is followed from above.
   elemental real(dp) function inverse_involute(value) result(angle)
      !> At least 0
      real(dp), intent(in) :: value
      integer, parameter :: most_iterations = 20
      real(dp) :: tangent, change
      integer :: i

      ! t - atan t >= t - pi/2, and = t**3/3 near 0 with t - atan t >= t**3/(3 (1 + t**2)).
      tangent = min(value + 0.5_dp*pi, 2.0_dp*value + 2.0_dp*value**(1.0_dp/3.0_dp))
      do i = 1, most_iterations
         if (.not. tangent > 0.0_dp) exit
         change = (tangent - atan(tangent) - value)*(1.0_dp + tangent**2)/tangent**2
         tangent = tangent - change
         if (abs(change) <= 1.0e-13_dp*tangent) exit
      end do
      angle = atan(tangent)
   end function inverse_involute

end module involute_teeth
