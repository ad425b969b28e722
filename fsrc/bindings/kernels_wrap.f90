! Thin layer between the kernels and f2py: plain arguments, explicit sizes, no derived types. The Python
! package checks shapes and types before it calls; nothing here repeats a formula.

! t_e(A) of (18); by_substitution /= 0: the paper's successive substitution.
subroutine wrap_rupture_tangent(n, a, by_substitution, t)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use rupture, only: rupture_tangent_fast, rupture_tangent_successive
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: a(n)
   integer(c_int), intent(in) :: by_substitution
   real(c_double), intent(out) :: t(n)

   if (by_substitution /= 0) then
      t = rupture_tangent_successive(a)
   else
      t = rupture_tangent_fast(a)
   end if
end subroutine wrap_rupture_tangent

! p*(xbar) of (16) at t = tan(xbar).
subroutine wrap_pressure_group(n, t, t_rupture, a, p)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use film_pressure, only: pressure_group
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: t(n)
   real(c_double), intent(in) :: t_rupture(n)
   real(c_double), intent(in) :: a(n)
   real(c_double), intent(out) :: p(n)

   p = pressure_group(t, t_rupture, a)
end subroutine wrap_pressure_group

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
! irregular fraction, reversals a period; counts: class, lines, 1 if there is motion, 1 if the samples suffice.
subroutine wrap_classify(n, acceleration, periods, limits, idle_lines, m, harmonics, ratios, counts)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use rattle_class, only: classify, rattle_verdict_t
   use scene_types, only: spectrum_choice_t
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: acceleration(n)
   integer(c_int), intent(in) :: periods
   real(c_double), intent(in) :: limits(4)
   integer(c_int), intent(in) :: idle_lines
   integer(c_int), intent(in) :: m
   real(c_double), intent(out) :: harmonics(m)
   real(c_double), intent(out) :: ratios(3)
   integer(c_int), intent(out) :: counts(4)
   type(rattle_verdict_t) :: verdict
   type(spectrum_choice_t) :: choice

   choice%periods = periods
   choice%line_threshold = limits(1)
   choice%quiet_limit = limits(2)
   choice%irregular_limit = limits(3)
   choice%idle_lines = idle_lines
   call classify(acceleration, choice, limits(4), verdict)
   harmonics = verdict%lines%harmonics
   ratios = [verdict%lines%harmonic_distortion, verdict%lines%irregular_fraction, verdict%reversals_per_period]
   counts = [verdict%class, verdict%lines%line_count, merge(1, 0, verdict%lines%moving), &
             merge(1, 0, verdict%lines%sampling_sufficient)]
end subroutine wrap_classify
