!> Pressure over the contact, (16) and (31), for the points of a film task.
module film_profiles
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use constants, only: half_pi
   use film_point, only: film_contact_t, film_point_t
   use film_pressure, only: barus_pressure, pressure_group
   use kinds, only: dp
   implicit none(type, external)
   private

   !> Columns of NAME.profiles.rattle.
   character(*), parameter, public :: profile_names(8) = [character(24) :: 'film_ratio', 'squeeze_ratio', 'speed_group', &
                                                          'coordinate', 'position', 'pressure_group', 'reduced_pressure', &
                                                          'piezo_viscous_pressure']
   character(*), parameter, public :: profile_units(8) = [character(4) :: '-', '-', '-', 'rad', 'm', '-', 'Pa', 'Pa']

   !> The inlet lies at x = -infinity; the profile begins this much after it [rad].
   real(dp), parameter :: inlet_margin = 1.0e-6_dp

   public :: profile_rows

contains

   !> Nodes of one point, equally spaced in xbar from the inlet to the rupture; one column of `rows` per node.
   pure subroutine profile_rows(contact, point, rows)
      !> Contact and oil
      type(film_contact_t), intent(in) :: contact
      !> The point
      type(film_point_t), intent(in) :: point
      !> 8 values of each node
      real(dp), intent(out) :: rows(:, :)
      real(dp) :: angle, tangent, group, alpha_p, rupture_angle
      integer :: node, nodes

      nodes = size(rows, 2)
      rupture_angle = atan(point%rupture_tangent)
      do node = 1, nodes
         angle = -half_pi + inlet_margin + (rupture_angle + half_pi - inlet_margin)*real(node - 1, dp)/real(nodes - 1, dp)
         tangent = tan(angle)
         if (node == nodes) tangent = point%rupture_tangent
         ! At both ends the pressure is zero, and rounding may leave it below.
         group = max(0.0_dp, pressure_group(tangent, point%rupture_tangent, point%squeeze_group))
         alpha_p = point%pressure_group*group
         rows(:7, node) = [point%film_ratio, point%squeeze_ratio, point%speed_group, angle, &
                           tangent*sqrt(2.0_dp*contact%radius*point%film), group, alpha_p/contact%pressure_viscosity]
         if (alpha_p < 1.0_dp) then
            rows(8, node) = barus_pressure(alpha_p)/contact%pressure_viscosity
         else
            rows(8, node) = ieee_value(alpha_p, ieee_quiet_nan)
         end if
      end do
   end subroutine profile_rows

end module film_profiles
