! Thin layer between the film-thickness regression and f2py: plain arguments, explicit sizes, no derived
! types. The Python package checks shapes and types before it calls; nothing here repeats a formula.

! Coefficients c, a, b, s of (32) as printed.
subroutine wrap_published_film_law(law)
   use, intrinsic :: iso_c_binding, only: c_double
   use film_fit, only: published_film_law
   implicit none
   real(c_double), intent(out) :: law(4)

   law = [published_film_law%factor, published_film_law%speed_exponent, published_film_law%load_exponent, &
          published_film_law%squeeze_factor]
end subroutine wrap_published_film_law

! Error of a law c, a, b, s on given points: rms, mean and largest residual of ln h*, R squared.
subroutine wrap_judge_film_law(law, n, speed_group, load_group, squeeze_ratio, film_ratio, error)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use film_fit, only: judge_film_law, law_error_t, thickness_law_t
   implicit none
   real(c_double), intent(in) :: law(4)
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: speed_group(n)
   real(c_double), intent(in) :: load_group(n)
   real(c_double), intent(in) :: squeeze_ratio(n)
   real(c_double), intent(in) :: film_ratio(n)
   real(c_double), intent(out) :: error(4)
   type(law_error_t) :: found

   found = judge_film_law( &
      thickness_law_t(law(1), law(2), law(3), law(4)), speed_group, load_group, squeeze_ratio, film_ratio)
   error = [found%rms, found%bias, found%maximum, found%r_squared]
end subroutine wrap_judge_film_law

! Least-squares law of given points: status and rank; c, a, b, s; its error; singular values and condition.
subroutine wrap_fit_film_law( &
   n, speed_group, load_group, squeeze_ratio, film_ratio, counts, law, error, conditioning)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use film_fit, only: film_fit_t, fit_film_law
   implicit none
   integer(c_int), intent(in) :: n
   real(c_double), intent(in) :: speed_group(n)
   real(c_double), intent(in) :: load_group(n)
   real(c_double), intent(in) :: squeeze_ratio(n)
   real(c_double), intent(in) :: film_ratio(n)
   integer(c_int), intent(out) :: counts(2)
   real(c_double), intent(out) :: law(4)
   real(c_double), intent(out) :: error(4)
   real(c_double), intent(out) :: conditioning(5)
   type(film_fit_t) :: fit

   call fit_film_law(speed_group, load_group, squeeze_ratio, film_ratio, fit)
   counts = [fit%status, fit%rank]
   law = [fit%law%factor, fit%law%speed_exponent, fit%law%load_exponent, fit%law%squeeze_factor]
   error = [fit%error%rms, fit%error%bias, fit%error%maximum, fit%error%r_squared]
   conditioning = [fit%singular_values, fit%condition]
end subroutine wrap_fit_film_law

! Reynolds films of a window, n = product of the three counts. ranges: h*, w*, alpha p, each least and largest;
! factors: of the pressure and of the load group. valid = 0: no window, and no points.
subroutine wrap_sample_film_window( &
   ranges, counts, factors, n, speed_group, load_group, squeeze_ratio, film_ratio, valid)
   use, intrinsic :: iso_c_binding, only: c_double, c_int
   use film_fit, only: film_window_t, sample_film_window, window_is_valid
   implicit none
   real(c_double), intent(in) :: ranges(6)
   integer(c_int), intent(in) :: counts(3)
   real(c_double), intent(in) :: factors(2)
   integer(c_int), intent(in) :: n
   real(c_double), intent(out) :: speed_group(n)
   real(c_double), intent(out) :: load_group(n)
   real(c_double), intent(out) :: squeeze_ratio(n)
   real(c_double), intent(out) :: film_ratio(n)
   integer(c_int), intent(out) :: valid
   type(film_window_t) :: window
   real(c_double), allocatable :: u(:), load(:), w(:), h(:)

   window = film_window_t(film_ratio=ranges(1:2), film_count=counts(1), squeeze_ratio=ranges(3:4), &
                          squeeze_count=counts(2), pressure=ranges(5:6), pressure_count=counts(3), &
                          pressure_factor=factors(1), load_factor=factors(2))
   speed_group = 0.0_c_double
   load_group = 0.0_c_double
   squeeze_ratio = 0.0_c_double
   film_ratio = 0.0_c_double
   valid = merge(1, 0, window_is_valid(window) .and. product(counts) == n)
   if (valid == 0) return
   call sample_film_window(window, u, load, w, h)
   speed_group = u
   load_group = load
   squeeze_ratio = w
   film_ratio = h
end subroutine wrap_sample_film_window
