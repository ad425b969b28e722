!> What a campaign can record of a scene, by the words of &campaign record: codes, units, and what each needs.
!> A unit test holds this table against the words that the key table allows.
module recorded_quantities
   implicit none(type, external)
   private

   !> What has to be computed for a quantity beyond the motion itself.
   integer, parameter, public :: needs_nothing = 0, needs_film_range = 1, needs_acceleration_range = 2, needs_spectrum = 3, &
                                 needs_regime = 4, needs_certificate = 5, needs_velocity_range = 6, needs_load_range = 7, &
                                 need_count = 7

   integer, parameter, public :: &
      record_film_minimum = 1, record_film_maximum = 2, record_acceleration_minimum = 3, record_acceleration_maximum = 4, &
      record_steady_film = 5, record_natural_frequency = 6, record_damping_ratio = 7, record_line_count = 8, &
      record_harmonic_distortion = 9, record_irregular_fraction = 10, record_reversals_per_period = 11, &
      record_rattle_class = 12, record_film_regime = 13, record_law_contradicted = 14, record_alpha_p_maximum = 15, &
      record_pressure_maximum = 16, record_deflection = 17, record_harmonics = 18, record_orbit_period = 19, &
      record_periods_solved = 20, record_sampling_sufficient = 21, record_certified = 22, &
      record_model_limit = 23, record_velocity_minimum = 24, record_velocity_maximum = 25, record_load_maximum = 26, &
      record_line_count_is_bound = 27

   !> One quantity.
   type, public :: quantity_t
      integer :: code
      character(24) :: name
      !> SI unit, '-' for a pure number
      character(8) :: unit
      integer :: need
   end type quantity_t

   !> All of them, each in the place of its code.
   type(quantity_t), parameter, public :: quantities(*) = [ &
      quantity_t(record_film_minimum, 'film_minimum', 'm', needs_film_range), &
      quantity_t(record_film_maximum, 'film_maximum', 'm', needs_film_range), &
      quantity_t(record_acceleration_minimum, 'acceleration_minimum', 'm/s2', needs_acceleration_range), &
      quantity_t(record_acceleration_maximum, 'acceleration_maximum', 'm/s2', needs_acceleration_range), &
      quantity_t(record_steady_film, 'steady_film', 'm', needs_nothing), &
      quantity_t(record_natural_frequency, 'natural_frequency', 'Hz', needs_nothing), &
      quantity_t(record_damping_ratio, 'damping_ratio', '-', needs_nothing), &
      quantity_t(record_line_count, 'line_count', '-', needs_spectrum), &
      quantity_t(record_harmonic_distortion, 'harmonic_distortion', '-', needs_spectrum), &
      quantity_t(record_irregular_fraction, 'irregular_fraction', '-', needs_spectrum), &
      quantity_t(record_reversals_per_period, 'reversals_per_period', '-', needs_spectrum), &
      quantity_t(record_rattle_class, 'rattle_class', '-', needs_spectrum), &
      quantity_t(record_film_regime, 'film_regime', '-', needs_regime), &
      quantity_t(record_law_contradicted, 'law_contradicted', '-', needs_regime), &
      quantity_t(record_alpha_p_maximum, 'alpha_p_maximum', '-', needs_regime), &
      quantity_t(record_pressure_maximum, 'pressure_maximum', 'Pa', needs_regime), &
      quantity_t(record_deflection, 'deflection', 'm', needs_regime), &
      quantity_t(record_harmonics, 'harmonics', 'm/s2', needs_spectrum), &
      quantity_t(record_orbit_period, 'orbit_period', '-', needs_nothing), &
      quantity_t(record_periods_solved, 'periods_solved', '-', needs_nothing), &
      quantity_t(record_sampling_sufficient, 'sampling_sufficient', '-', needs_spectrum), &
      quantity_t(record_certified, 'certified', '-', needs_certificate), &
      quantity_t(record_model_limit, 'model_limit', '-', needs_film_range), &
      quantity_t(record_velocity_minimum, 'velocity_minimum', 'm/s', needs_velocity_range), &
      quantity_t(record_velocity_maximum, 'velocity_maximum', 'm/s', needs_velocity_range), &
      quantity_t(record_load_maximum, 'load_maximum', 'N', needs_load_range), &
      quantity_t(record_line_count_is_bound, 'line_count_is_bound', '-', needs_spectrum)]

   public :: quantity_code

contains

   !> Code of a quantity, 0 if there is none of this name.
   pure integer function quantity_code(name)
      !> As the key table spells it
      character(*), intent(in) :: name

      do quantity_code = 1, size(quantities)
         if (quantities(quantity_code)%name == name) return
      end do
      quantity_code = 0
   end function quantity_code

end module recorded_quantities
