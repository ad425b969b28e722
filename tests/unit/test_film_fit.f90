!> Tests of the least-squares film law on made and on Reynolds films, and of the printed coefficients of eq (32).
module test_film_fit
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use checks, only: check_list_t
   use film_fit, only: film_fit_t, film_window_t, fit_bad_points, fit_done, fit_film_law, fit_rank_deficient, judge_film_law, &
                       law_error_t, law_film_ratio, published_film_law, sample_film_window, thickness_law_t, window_is_valid
   use kinds, only: dp
   implicit none(type, external)
   private

   public :: run_film_fit_tests

   real(dp), parameter :: rounding = 1.0e-10_dp

contains

   !> Runs every test of this topic.
   subroutine run_film_fit_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('film_fit')
      call test_made_points(checks)
      call test_disturbed_points(checks)
      call test_inversion(checks)
      call test_window(checks)
      call test_published_law(checks)
      call test_exact_fit(checks)
      call test_rejections(checks)
   end subroutine run_film_fit_tests

   !> Points of a known law, on a grid in all three groups.
   subroutine made_points(law, speed_group, load_group, squeeze_ratio, film_ratio)
      type(thickness_law_t), intent(in) :: law       !> Law the points obey
      real(dp), intent(out) :: speed_group(60)       !> u* [-]
      real(dp), intent(out) :: load_group(60)        !> Wbar [-]
      real(dp), intent(out) :: squeeze_ratio(60)     !> w* [-]
      real(dp), intent(out) :: film_ratio(60)        !> h* [-]

      integer :: i

      do i = 0, 59
         speed_group(i + 1) = 1.0e-7_dp*1.5_dp**modulo(i, 5)
         load_group(i + 1) = 0.1_dp*1.3_dp**modulo(i/5, 4)
         squeeze_ratio(i + 1) = 1.0e-4_dp*real(i/20 - 1, dp)
      end do
      film_ratio = law_film_ratio(law, speed_group, load_group, squeeze_ratio)
   end subroutine made_points

   !> The printed law is found again from its own points.
   subroutine test_made_points(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), dimension(60) :: speed_group, load_group, squeeze_ratio, film_ratio
      type(film_fit_t) :: fit

      call made_points(published_film_law, speed_group, load_group, squeeze_ratio, film_ratio)
      call fit_film_law(speed_group, load_group, squeeze_ratio, film_ratio, fit)
      call checks%check(fit%status == fit_done, 'made points: status')
      call checks%check(fit%rank == 4, 'made points: rank')
      call checks%check_close(fit%law%factor, 0.787_dp, rounding, 'made points: factor')
      call checks%check_close(fit%law%speed_exponent, 0.7_dp, rounding, 'made points: speed exponent')
      call checks%check_close(fit%law%load_exponent, -0.4_dp, rounding, 'made points: load exponent')
      call checks%check_close(fit%law%squeeze_factor, -281.2_dp, 1.0e-7_dp, 'made points: squeeze factor')
      call checks%check(fit%error%rms < rounding .and. fit%error%maximum < rounding, 'made points: residuals')
      call checks%check_close(fit%error%r_squared, 1.0_dp, rounding, 'made points: R squared')
      call checks%check(all(fit%singular_values(1:3) >= fit%singular_values(2:4)), &
         'made points: singular values')
      call checks%check_close(sum(fit%singular_values**2), 4.0_dp, rounding, &
         'made points: columns of unit length')
      call checks%check_close(fit%condition*fit%singular_values(4)/fit%singular_values(1), 1.0_dp, rounding, &
         'made points: condition')
   end subroutine test_made_points

   !> A disturbance orthogonal to nothing: the residuals are orthogonal to every column, and no other law is
   !> better.
   subroutine test_disturbed_points(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), dimension(60) :: speed_group, load_group, squeeze_ratio, film_ratio, residual
      type(film_fit_t) :: fit
      type(thickness_law_t) :: other
      type(law_error_t) :: error
      integer :: i

      call made_points(published_film_law, speed_group, load_group, squeeze_ratio, film_ratio)
      film_ratio = film_ratio*exp([(0.1_dp*sin(real(i*i, dp)), i=1, 60)])
      call fit_film_law(speed_group, load_group, squeeze_ratio, film_ratio, fit)
      residual = log(law_film_ratio(fit%law, speed_group, load_group, squeeze_ratio)/film_ratio)
      call checks%check_close(sum(residual), 0.0_dp, rounding, 'disturbed points: mean residual')
      call checks%check_close(sum(residual*log(speed_group)), 0.0_dp, rounding, 'disturbed points: speed')
      call checks%check_close(sum(residual*log(load_group)), 0.0_dp, rounding, 'disturbed points: load')
      call checks%check_close(sum(residual*squeeze_ratio), 0.0_dp, rounding, 'disturbed points: squeeze')
      call checks%check_close(fit%error%rms, norm2(residual)/sqrt(60.0_dp), rounding, 'disturbed points: rms')
      call checks%check_close(fit%error%maximum, maxval(abs(residual)), rounding, 'disturbed points: maximum')
      other = fit%law
      other%load_exponent = 1.01_dp*other%load_exponent
      error = judge_film_law(other, speed_group, load_group, squeeze_ratio, film_ratio)
      call checks%check(error%rms > fit%error%rms .and. error%r_squared < fit%error%r_squared, &
         'disturbed points: another law is worse')
   end subroutine test_disturbed_points

   !> Eq (32), inverted with the load group of eq (20), has the constants and exponents of eq (37).
   subroutine test_inversion(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: radius = 0.0127_dp, length = 0.01_dp, viscosity = 0.3_dp, alpha = 2.0e-8_dp
      real(dp), parameter :: speed = 1.905_dp, film = 1.0e-6_dp, squeeze = -1.0e-4_dp
      real(dp) :: load, group

      load = 6.5935_dp*length*(speed*viscosity)**2.75_dp*(radius*alpha)**1.75_dp*film**(-3.5_dp) &
         *exp(-703.0_dp*squeeze/speed)
      group = load*film/(12.0_dp*length*speed*viscosity*radius)
      call checks%check_close( &
         law_film_ratio(published_film_law, speed*viscosity*alpha/radius, group, squeeze/speed)*radius/film, &
         1.0_dp, 1.0e-5_dp, 'inversion of eq (32) is eq (37)')
   end subroutine test_inversion

   !> Sampled films: number, limits, and the groups of one film with known Psi.
   subroutine test_window(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      type(film_window_t) :: window
      real(dp), allocatable, dimension(:) :: speed_group, load_group, squeeze_ratio, film_ratio

      window = film_window_t(film_count=3, squeeze_count=5, pressure_count=4)
      call sample_film_window(window, speed_group, load_group, squeeze_ratio, film_ratio)
      call checks%check(size(film_ratio) == 60, 'window: number of films')
      call checks%check_close(minval(film_ratio), 5.0e-5_dp, 1.0e-18_dp, 'window: thinnest film')
      call checks%check_close(maxval(film_ratio), 2.0e-4_dp, 1.0e-18_dp, 'window: thickest film')
      call checks%check_close(maxval(squeeze_ratio), 5.0e-4_dp, 1.0e-18_dp, 'window: fastest separation')
      call checks%check(all(speed_group > 0.0_dp) .and. all(load_group > 0.0_dp), 'window: positive groups')

      ! A = 0 and alpha p = 0.5, the middle of the window: Psi = 0.24725..., u* from B = 6 sqrt(2)
      ! u*/h*^(3/2).
      window = film_window_t(film_ratio=[1.0e-4_dp, 1.0e-4_dp], film_count=1, squeeze_ratio=[0.0_dp, &
         0.0_dp], &
         squeeze_count=1, pressure=[0.4_dp, 0.6_dp], pressure_count=1)
      call sample_film_window(window, speed_group, load_group, squeeze_ratio, film_ratio)
      call checks%check_close(load_group(1), 0.2472544472469768_dp, 1.0e-6_dp, 'window: load group')
      call checks%check_close(6.0_dp*sqrt(2.0_dp)*speed_group(1)/film_ratio(1)**1.5_dp, &
         0.5_dp*7.889828622697975_dp, 1.0e-9_dp, 'window: speed group')
      window%pressure_factor = 0.5_dp
      window%load_factor = 0.5_dp
      call sample_film_window(window, speed_group, load_group, squeeze_ratio, film_ratio)
      call checks%check_close(load_group(1), 0.1236272236234884_dp, 1.0e-6_dp, 'window: halved load group')
      call checks%check_close(6.0_dp*sqrt(2.0_dp)*speed_group(1)/film_ratio(1)**1.5_dp, &
         7.889828622697975_dp, &
         1.0e-9_dp, 'window: halved pressure')

      window%pressure = [0.5_dp, 1.1_dp]
      call checks%check(.not. window_is_valid(window), 'window: beyond the critical group')
      call sample_film_window(window, speed_group, load_group, squeeze_ratio, film_ratio)
      call checks%check(size(film_ratio) == 0, 'window: no films of an invalid window')
   end subroutine test_window

   !> The printed coefficients against Reynolds films. As printed the law is 38 to 44 % too thin; with the
   !> pressure halved the rms of ln h* is 0.20 over 0.3 < alpha p < 1 and 0.09 over 0.5 < alpha p < 1.
   subroutine test_published_law(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: tolerance = 0.01_dp

      call expect(film_window_t(pressure=[0.3_dp, 1.0_dp]), 0.605_dp, -0.577_dp, 'as printed, alpha p > 0.3')
      call expect(film_window_t(pressure=[0.5_dp, 1.0_dp]), 0.489_dp, -0.480_dp, 'as printed, alpha p > 0.5')
      call expect(film_window_t(pressure=[0.3_dp, 1.0_dp], pressure_factor=0.5_dp), 0.203_dp, -0.092_dp, &
         'halved, alpha p > 0.3')
      call expect(film_window_t(pressure=[0.5_dp, 1.0_dp], pressure_factor=0.5_dp), 0.094_dp, 0.005_dp, &
         'halved, alpha p > 0.5')
      call expect(film_window_t(pressure=[0.3_dp, 1.0_dp], pressure_factor=0.5_dp, load_factor=0.5_dp), &
         0.258_dp, 0.185_dp, 'pressure and load group halved, alpha p > 0.3')
      call expect(film_window_t(pressure=[0.5_dp, 1.0_dp], pressure_factor=0.5_dp, load_factor=0.5_dp), &
         0.297_dp, 0.282_dp, 'pressure and load group halved, alpha p > 0.5')

   contains

      !> Error of the printed law over one window.
      subroutine expect(window, rms, bias, message)
         type(film_window_t), intent(in) :: window  !> Range of Reynolds films
         real(dp), intent(in) :: rms                !> Expected rms of ln h*
         real(dp), intent(in) :: bias               !> Expected mean of ln h*
         character(len=*), intent(in) :: message    !> Name of the window

         real(dp), allocatable, dimension(:) :: speed_group, load_group, squeeze_ratio, film_ratio
         type(law_error_t) :: error

         call sample_film_window(window, speed_group, load_group, squeeze_ratio, film_ratio)
         error = judge_film_law(published_film_law, speed_group, load_group, squeeze_ratio, film_ratio)
         call checks%check_close(error%rms, rms, tolerance, 'printed law, rms: '//message)
         call checks%check_close(error%bias, bias, tolerance, 'printed law, bias: '//message)
         call checks%check(error%maximum >= error%rms, 'printed law, maximum: '//message)
      end subroutine expect

   end subroutine test_published_law

   !> Least squares of Reynolds films: the exponent of the load depends wholly on the window, and halving the
   !> pressure changes the factor only, by 2^-a.
   subroutine test_exact_fit(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: tolerance = 0.01_dp
      type(film_fit_t) :: wide, narrow, halved, near

      wide = fit_of(film_window_t(pressure=[0.3_dp, 1.0_dp]))
      narrow = fit_of(film_window_t(pressure=[0.5_dp, 1.0_dp]))
      near = fit_of(film_window_t(pressure=[0.9_dp, 1.0_dp]))
      halved = fit_of(film_window_t(pressure=[0.3_dp, 1.0_dp], pressure_factor=0.5_dp))
      call checks%check(wide%status == fit_done .and. narrow%status == fit_done, 'Reynolds films: status')
      call checks%check_close(wide%law%load_exponent, -1.222_dp, tolerance, &
         'Reynolds films: load exponent, wide')
      call checks%check_close(narrow%law%load_exponent, -0.845_dp, tolerance, &
         'Reynolds films: load exponent, narrow')
      call checks%check(near%law%load_exponent > narrow%law%load_exponent, &
         'Reynolds films: load exponent, near')
      call checks%check_close(wide%law%speed_exponent, 0.640_dp, tolerance, 'Reynolds films: speed exponent')
      call checks%check(wide%error%rms < 0.1_dp .and. narrow%error%rms < 0.06_dp, 'Reynolds films: residuals')
      call checks%check_close(halved%law%load_exponent, wide%law%load_exponent, rounding, &
         'halved: same exponent')
      call checks%check_close(halved%law%factor/wide%law%factor, 0.5_dp**wide%law%speed_exponent, rounding, &
         'halved: factor')
   end subroutine test_exact_fit

   !> Fit over one window of Reynolds films.
   function fit_of(window) result(fit)
      type(film_window_t), intent(in) :: window  !> Range of Reynolds films
      type(film_fit_t) :: fit

      real(dp), allocatable, dimension(:) :: speed_group, load_group, squeeze_ratio, film_ratio

      call sample_film_window(window, speed_group, load_group, squeeze_ratio, film_ratio)
      call fit_film_law(speed_group, load_group, squeeze_ratio, film_ratio, fit)
   end function fit_of

   !> Points that do not determine the law, and points that are none.
   subroutine test_rejections(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), dimension(60) :: speed_group, load_group, squeeze_ratio, film_ratio, wrong
      type(film_fit_t) :: fit

      call made_points(published_film_law, speed_group, load_group, squeeze_ratio, film_ratio)
      wrong = 0.0_dp
      film_ratio = law_film_ratio(published_film_law, speed_group, load_group, wrong)
      call fit_film_law(speed_group, load_group, wrong, film_ratio, fit)
      call checks%check(fit%status == fit_rank_deficient .and. fit%rank == 3, 'no squeeze: rank deficient')
      call checks%check_close(fit%law%load_exponent, -0.4_dp, rounding, &
         'no squeeze: other coefficients stand')
      call fit_film_law(speed_group(1:4), load_group(1:4), squeeze_ratio(1:4), film_ratio(1:4), fit)
      call checks%check(fit%status == fit_bad_points, 'four points')
      call fit_film_law(speed_group(1:8), load_group, squeeze_ratio, film_ratio, fit)
      call checks%check(fit%status == fit_bad_points, 'arrays of different size')
      wrong = film_ratio
      wrong(7) = -wrong(7)
      call fit_film_law(speed_group, load_group, squeeze_ratio, wrong, fit)
      call checks%check(fit%status == fit_bad_points, 'negative film')
      wrong(7) = ieee_value(0.0_dp, ieee_quiet_nan)
      call fit_film_law(speed_group, load_group, squeeze_ratio, wrong, fit)
      call checks%check(fit%status == fit_bad_points, 'film not a number')
   end subroutine test_rejections

end module test_film_fit
