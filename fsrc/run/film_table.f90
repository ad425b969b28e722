!> Tables of a film task: which columns a scene asks for and a row of it for a point, and the pressure over the contact, (16), (31).
module film_table
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use constants, only: half_pi
   use film_point, only: film_contact_t, film_peak, film_peak_t, film_point_t, film_response_t, iso_viscous_response, &
                         limit_of_point, piezo_viscous_response, published_response, solve_numerically
   use film_pressure, only: barus_pressure, pressure_group
   use kinds, only: dp
   use result_format, only: column_name_bytes, column_unit_bytes
   use scene_types, only: compute_damping, compute_limits, compute_load, compute_pressure, compute_rupture, compute_stiffness, &
                          scene_t, viscosity_roelands
   implicit none(type, external)
   private

   integer, parameter :: most_columns = 40

   !> Columns of a table, or the values of one row: both are made by the same walk, so they cannot part.
   type, public :: film_row_t
      integer :: count = 0
      character(column_name_bytes) :: names(most_columns) = ''
      character(column_unit_bytes) :: units(most_columns) = ''
      real(dp) :: values(most_columns) = 0.0_dp
   contains
      procedure, private :: put
   end type film_row_t

   !> Columns of NAME.profiles.rattle.
   character(*), parameter, public :: profile_names(8) = [character(24) :: 'film_ratio', 'squeeze_ratio', 'speed_group', &
                                                          'coordinate', 'position', 'pressure_group', 'reduced_pressure', &
                                                          'piezo_viscous_pressure']
   character(*), parameter, public :: profile_units(8) = [character(4) :: '-', '-', '-', 'rad', 'm', '-', 'Pa', 'Pa']

   !> The inlet lies at x = -infinity; the profile begins this much after it [rad].
   real(dp), parameter :: inlet_margin = 1.0e-6_dp

   public :: film_row, profile_rows

contains

   !> Row of a point, names and units included.
   pure function film_row(scene, contact, point) result(row)
      !> Checked scene with a film task
      type(scene_t), intent(in) :: scene
      !> Its contact and oil
      type(film_contact_t), intent(in) :: contact
      !> The point
      type(film_point_t), intent(in) :: point
      type(film_row_t) :: row

      call row%put('film_ratio', '-', point%film_ratio)
      call row%put('squeeze_ratio', '-', point%squeeze_ratio)
      call row%put('speed_group', '-', point%speed_group)
      call row%put('film_thickness', 'm', point%film)
      call row%put('squeeze_velocity', 'm/s', point%velocity)
      call row%put('speed', 'm/s', point%speed)
      call row%put('squeeze_group', '-', point%squeeze_group)
      call row%put('pressure_group', '-', point%pressure_group)
      if (scene%points%compute(compute_rupture)) call row%put('rupture_angle', 'rad', atan(point%rupture_tangent))
      call put_responses(scene, contact, point, row)
      call put_peak(scene, contact, point, row)
      if (scene%points%numerical) call put_numerical(scene, contact, point, row)
   end function film_row

   !> Load, stiffness and damping, published and exact side by side.
   pure subroutine put_responses(scene, contact, point, row)
      type(scene_t), intent(in) :: scene
      type(film_contact_t), intent(in) :: contact
      type(film_point_t), intent(in) :: point
      type(film_row_t), intent(inout) :: row
      type(film_response_t) :: published, iso_viscous, piezo_viscous

      associate (wanted => scene%points)
         if (.not. any(wanted%compute([compute_load, compute_stiffness, compute_damping]))) return
         if (wanted%published) published = published_response(contact, point)
         if (wanted%exact) iso_viscous = iso_viscous_response(contact, point)
         if (wanted%exact) piezo_viscous = piezo_viscous_response(contact, point)
         if (wanted%compute(compute_load)) then
            if (wanted%published) call row%put('load_published', 'N', published%load)
            if (wanted%exact) call row%put('load_iso_viscous', 'N', iso_viscous%load)
            if (wanted%exact) call row%put('load_piezo_viscous', 'N', piezo_viscous%load)
         end if
         if (wanted%compute(compute_stiffness)) then
            if (wanted%published) call row%put('stiffness_published', 'N/m', published%stiffness)
            if (wanted%exact) call row%put('stiffness_iso_viscous', 'N/m', iso_viscous%stiffness)
            if (wanted%exact) call row%put('stiffness_piezo_viscous', 'N/m', piezo_viscous%stiffness)
         end if
         if (wanted%compute(compute_damping)) then
            if (wanted%published) call row%put('damping_published', 'N s/m', published%damping)
            if (wanted%exact) call row%put('damping_iso_viscous', 'N s/m', iso_viscous%damping)
            if (wanted%exact) call row%put('damping_piezo_viscous', 'N s/m', piezo_viscous%damping)
         end if
      end associate
   end subroutine put_responses

   !> Pressure, deflection, regime, limiting film.
   pure subroutine put_peak(scene, contact, point, row)
      type(scene_t), intent(in) :: scene
      type(film_contact_t), intent(in) :: contact
      type(film_point_t), intent(in) :: point
      type(film_row_t), intent(inout) :: row
      type(film_peak_t) :: peak

      if (scene%points%compute(compute_pressure)) then
         peak = film_peak(contact, point)
         call row%put('alpha_p_maximum', '-', peak%alpha_p)
         call row%put('pressure_maximum', 'Pa', peak%pressure)
         call row%put('deflection', 'm', peak%deflection)
         call row%put('film_regime', '-', real(peak%regime, dp))
      end if
      if (scene%points%compute(compute_limits)) call row%put('limiting_film', 'm', limit_of_point(contact, point))
   end subroutine put_peak

   !> The finite-volume reference solution.
   pure subroutine put_numerical(scene, contact, point, row)
      type(scene_t), intent(in) :: scene
      type(film_contact_t), intent(in) :: contact
      type(film_point_t), intent(in) :: point
      type(film_row_t), intent(inout) :: row
      real(dp) :: load, rupture_angle, pressure

      call solve_numerically(contact, point, scene%lubricant%viscosity_law == viscosity_roelands, scene%points%cells, load, &
                             rupture_angle, pressure)
      call row%put('load_numerical', 'N', load)
      call row%put('rupture_angle_numerical', 'rad', rupture_angle)
      call row%put('pressure_numerical', 'Pa', pressure)
   end subroutine put_numerical

   !> Append a column with its value.
   pure subroutine put(self, name, unit, value)
      class(film_row_t), intent(inout) :: self
      character(*), intent(in) :: name
      character(*), intent(in) :: unit
      real(dp), intent(in) :: value

      self%count = self%count + 1
      self%names(self%count) = name
      self%units(self%count) = unit
      self%values(self%count) = value
   end subroutine put

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

end module film_table
