! Thin layer between f2py and the kernels of spectrum and class, and the numerical Reynolds solver: plain arguments, explicit sizes,
! no derived types. The Python package checks shapes and types before it calls; nothing here repeats a formula.

! Single-sided amplitudes, m = n/2 + 1 of them.
subroutine wrap_amplitude_spectrum(n, samples, m, amplitudes)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use fourier, only: amplitude_spectrum
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: samples(n)
   integer(c_int), intent(in) :: m
   real(c_double), intent(out) :: amplitudes(m)
   real(c_double), allocatable :: spectrum(:)

   call amplitude_spectrum(samples, spectrum)
   amplitudes = spectrum(0:m - 1)
end subroutine wrap_amplitude_spectrum

! Class of n samples of `periods` whole periods; m = (n/periods - 1)/2 harmonics. ratios: distortion,
! irregular fraction, reversals a period, spectral reach; orders and amplitudes: those of the force; orbit: periods after which the motion is known
! to repeat, or 0; counts: class, harmonics, 1 if there is motion, 1 if the samples suffice.
subroutine wrap_classify(n, acceleration, periods, limits, idle_harmonics, orbit, k, orders, amplitudes, m, harmonics, &
   ratios, counts)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use rattle_class, only: classify, note_orbit, rattle_verdict_t
   use scene_types, only: note_orders, spectrum_choice_t
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: acceleration(n)
   integer(c_int), intent(in) :: periods
   real(c_double), intent(in) :: limits(4)
   integer(c_int), intent(in) :: idle_harmonics
   integer(c_int), intent(in) :: orbit
   integer(c_int), intent(in) :: k
   integer(c_int), intent(in) :: orders(k)
   real(c_double), intent(in) :: amplitudes(k)
   integer(c_int), intent(in) :: m
   real(c_double), intent(out) :: harmonics(m)
   real(c_double), intent(out) :: ratios(4)
   integer(c_int), intent(out) :: counts(5)
   type(rattle_verdict_t) :: verdict
   type(spectrum_choice_t) :: choice

   choice%periods = periods
   choice%harmonic_threshold = limits(1)
   choice%quiet_limit = limits(2)
   choice%irregular_limit = limits(3)
   choice%idle_harmonics = idle_harmonics
   call note_orders(orders, amplitudes, choice)
   call classify(acceleration, choice, limits(4), verdict)
   call note_orbit(verdict, orbit)
   harmonics = verdict%spectrum%harmonics
   ratios = [verdict%spectrum%harmonic_distortion, verdict%spectrum%irregular_fraction, verdict%reversals_per_period, &
             verdict%spectrum%spectral_reach]
   counts = [verdict%class, verdict%spectrum%harmonic_count, merge(1, 0, verdict%spectrum%moving), &
             merge(1, 0, verdict%spectrum%sampling_sufficient), verdict%spectrum%largest_forced]
end subroutine wrap_classify

! Groups of a film in SI units for the numerical Reynolds solver: u/v, squeeze group, B, alpha p_r, Roelands'
! logarithm; then the scales of pressure [Pa] and line load [N/m].
subroutine wrap_scale_film(si, groups, scales)
   use, intrinsic :: iso_c_binding, only: c_double
   use numerical_reynolds, only: scale_film
   use numerical_reynolds_grid, only: film_problem_t
   implicit none
   real(c_double), intent(in) :: si(6)
   real(c_double), intent(out) :: groups(5)
   real(c_double), intent(out) :: scales(2)
   type(film_problem_t) :: problem

   call scale_film(si(1), si(2), si(3), si(4), si(5), si(6), problem, scales(1), scales(2))
   groups = [problem%rolling, problem%squeeze, problem%pressure_group, problem%roelands_pressure, &
             problem%roelands_logarithm]
end subroutine wrap_scale_film

! Numerical solution of one film on m - 1 cells; groups as above. results: load, its correction, largest q*,
! rupture angle; counts: status, Newton steps. Without a solution the numbers are NaN.
subroutine wrap_solve_reynolds(groups, law, extrapolate, m, angle, pressure, results, counts)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use numerical_reynolds, only: film_solution_t, solve_reynolds
   use numerical_reynolds_grid, only: film_problem_t
   use numerical_reynolds_rupture, only: reynolds_converged
   implicit none
   real(c_double), intent(in) :: groups(5)
   integer(c_int), intent(in) :: law
   integer(c_int), intent(in) :: extrapolate
   integer(c_int), intent(in) :: m
   real(c_double), intent(out) :: angle(m)
   real(c_double), intent(out) :: pressure(m)
   real(c_double), intent(out) :: results(4)
   integer(c_int), intent(out) :: counts(2)
   type(film_solution_t) :: solution

   angle = ieee_value(1.0_c_double, ieee_quiet_nan)
   pressure = angle
   results = ieee_value(1.0_c_double, ieee_quiet_nan)
   call solve_reynolds(film_problem_t(groups(1), groups(2), groups(3), law, groups(4), groups(5)), m - 1, &
                       extrapolate /= 0, solution)
   counts = [solution%status, solution%iterations]
   if (allocated(solution%angle)) angle = solution%angle
   if (solution%status /= reynolds_converged) return
   pressure = solution%pressure
   results = [solution%load, solution%load_correction, solution%maximum_pressure, solution%rupture_angle]
end subroutine wrap_solve_reynolds
