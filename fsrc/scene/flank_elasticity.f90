!> What the elastic flanks of a scene have: equivalent radius and modulus of the contact, and the compliance behind its film.
module flank_elasticity
   use constants, only: pi
   use kinds, only: dp
   use scene_types, only: contact_t, law_elastohydrodynamic, scene_t
   implicit none(type, external)
   private

   public :: equivalent_radius, plane_strain_modulus, contact_radius, elastic_scale, roelands_logarithm, flank_compliance, &
             flattening_compliance, deflection_by_load, tooth_compliance

contains

   !> Radius of the cylinder that over a plane has the gap of two cylinders, eq (2): 1/R = 1/r1 + 1/r2.
   elemental function equivalent_radius(radius_1, radius_2) result(radius)
      !> r1 [m]; negative for a hollow surface
      real(dp), intent(in) :: radius_1
      !> r2 [m], r1 + r2 /= 0
      real(dp), intent(in) :: radius_2
      !> R [m]
      real(dp) :: radius

      radius = radius_1/(1.0_dp + radius_1/radius_2)
   end function equivalent_radius

   !> Modulus of plane strain, eq (3).
   elemental function plane_strain_modulus(young_modulus, poisson_ratio) result(modulus)
      !> E [Pa]
      real(dp), intent(in) :: young_modulus
      !> nu [-]
      real(dp), intent(in) :: poisson_ratio
      !> E* [Pa]
      real(dp) :: modulus

      modulus = young_modulus/(1.0_dp - poisson_ratio**2)
   end function plane_strain_modulus

   !> Equivalent radius of a contact [m]: the one given, else (2) of the two radii given.
   pure real(dp) function contact_radius(contact)
      !> Checked contact
      type(contact_t), intent(in) :: contact

      contact_radius = contact%radius
      if (.not. contact%radius > 0.0_dp) contact_radius = equivalent_radius(contact%radius_1, contact%radius_2)
   end function contact_radius

   !> Moes' eps = (eta0 u/(E* R))^(1/4): R eps^2 and R eps are the scales of film and width of an elastohydrodynamic contact [-].
   elemental real(dp) function elastic_scale(radius, modulus, speed, viscosity)
      !> R [m]
      real(dp), intent(in) :: radius
      !> E* [Pa]
      real(dp), intent(in) :: modulus
      !> u1 + u2 [m/s]
      real(dp), intent(in) :: speed
      !> eta0 [Pa s]
      real(dp), intent(in) :: viscosity

      elastic_scale = sqrt(sqrt(viscosity*speed/(modulus*radius)))
   end function elastic_scale

   !> ln eta0 + 9.67 of Roelands' law, ln of eta0 over 6.31e-5 Pa s; above 0 of every oil [-].
   elemental real(dp) function roelands_logarithm(viscosity)
      !> eta0 [Pa s]
      real(dp), intent(in) :: viscosity

      roelands_logarithm = log(viscosity) + 9.67_dp
   end function roelands_logarithm

   !> By how much the flanks of a contact flatten: the plane elastic contact of width R eps, counted as elastic to the depth R. The
   !> logarithm of a plane contact has no datum, so that a depth is part of what is meant [m/N].
   pure real(dp) function flattening_compliance(scene)
      !> Checked, derived scene
      type(scene_t), intent(in) :: scene
      real(dp) :: modulus

      associate (contact => scene%contact)
         modulus = plane_strain_modulus(contact%young_modulus, contact%poisson_ratio)
         flattening_compliance = -4.0_dp/pi*log(elastic_scale(contact_radius(contact), modulus, &
                                                              2.0_dp*scene%kinematics%entrainment_speed, &
                                                              scene%lubricant%viscosity))/(modulus*contact%length)
      end associate
   end function flattening_compliance

   !> Compliance of a flank with its tooth, in series with its film: that of the stiffness, with the flattening unless it is in
   !> there. Elastohydrodynamic flanks flatten on rigid teeth, too. 0: rigid [m/N].
   pure real(dp) function flank_compliance(scene)
      !> Checked, derived scene
      type(scene_t), intent(in) :: scene
      logical :: stiff

      flank_compliance = 0.0_dp
      stiff = .not. scene%contact%stiffness > 0.0_dp
      if (.not. stiff) flank_compliance = 1.0_dp/scene%contact%stiffness
      if (.not. scene%contact%flattening_included .or. (stiff .and. scene%film%law == law_elastohydrodynamic)) &
         flank_compliance = flank_compliance + flattening_compliance(scene)
   end function flank_compliance

   !> Compliance of a tooth alone, whose deflection is damped: that of the stiffness, without the flattening of elastohydrodynamic
   !> flanks that is in there. 0: rigid [m/N].
   pure real(dp) function tooth_compliance(scene)
      !> Checked, derived scene
      type(scene_t), intent(in) :: scene

      tooth_compliance = 0.0_dp
      if (.not. scene%contact%stiffness > 0.0_dp) return
      tooth_compliance = 1.0_dp/scene%contact%stiffness
      if (scene%contact%flattening_included .and. scene%film%law == law_elastohydrodynamic) &
         tooth_compliance = tooth_compliance - flattening_compliance(scene)
   end function tooth_compliance

   !> By how much a tooth deflects under a load; of teeth that are taken for rigid one of some stiffness [m/N].
   elemental real(dp) function deflection_by_load(contact, tooth_stiffness)
      !> Checked, derived contact
      type(contact_t), intent(in) :: contact
      !> Of rigid teeth, c' of ISO 6336-1 [N/m2]
      real(dp), intent(in) :: tooth_stiffness

      deflection_by_load = 1.0_dp/contact%stiffness_of_width(tooth_stiffness)
      if (contact%stiffness > 0.0_dp) deflection_by_load = 1.0_dp/contact%stiffness
   end function deflection_by_load

end module flank_elasticity
