!> Least squares of the film-thickness law (32) and the error of any such law against given points (fsrc/THEORY.md, section 2).
!>
!> Points to be fitted are films of the Reynolds piezo-viscous law over a window of alpha p. The load Psi depends on
!> A = 4 w*/sqrt(2 h*) and B = f 6 sqrt(2) u*/h*^(3/2) alone, and alpha p_max = B/B_crit(A) with the p of eq (31). So a window is
!> sampled in h* (evenly in the logarithm), w* and alpha p (centres of equal parts, its ends are singular), and u* follows
!> without iteration: u* = alpha p B_crit(A) h*^(3/2)/(6 sqrt(2) f).
module film_fit
   use kinds, only: dp
   use reynolds_piezo_viscous, only: critical_pressure_group, piezo_viscous_load
   use rupture, only: squeeze_group
   implicit none(type, external)
   private

   public :: thickness_law_t, law_error_t, film_fit_t, law_film_ratio, judge_film_law, fit_film_law, film_window_t, &
             window_is_valid, sample_film_window

   !> Outcomes: unique coefficients; points that do not determine all four; arrays of different size, fewer
   !> than five points, or a group that is not positive and finite; the singular values did not converge.
   integer, parameter, public :: fit_done = 0, fit_rank_deficient = 1, fit_bad_points = 2, fit_failed = 3

   integer, parameter :: coefficients = 4

   !> Coefficients of the law.
   type :: thickness_law_t
      !> c [-]
      real(dp) :: factor = 1.0_dp
      !> a [-]
      real(dp) :: speed_exponent = 0.0_dp
      !> b [-]
      real(dp) :: load_exponent = 0.0_dp
      !> s [-]
      real(dp) :: squeeze_factor = 0.0_dp
   end type thickness_law_t

   !> The law as printed in eq (32).
   type(thickness_law_t), parameter, public :: published_film_law = &
      thickness_law_t(0.787_dp, 0.7_dp, -0.4_dp, -281.2_dp)

   !> How far a law is from given points. Residuals are ln h* of the law less ln h* of the point.
   type :: law_error_t
      !> Root mean square of the residuals [-]
      real(dp) :: rms = 0.0_dp
      !> Mean of the residuals [-]
      real(dp) :: bias = 0.0_dp
      !> Largest absolute residual [-]
      real(dp) :: maximum = 0.0_dp
      !> 1 - sum of squared residuals/sum of squared deviations of ln h* from its mean; negative for a law
      !> worse than the mean, zero where all points have one film
      real(dp) :: r_squared = 0.0_dp
   end type law_error_t

   !> Result of a fit.
   type :: film_fit_t
      !> Outcome, one of fit_...
      integer :: status = fit_bad_points
      !> Coefficients; those of least norm (of the scaled problem) where the rank is deficient
      type(thickness_law_t) :: law
      !> Error of the law on the points it was fitted to
      type(law_error_t) :: error
      !> Singular values, falling, of the design matrix with columns of unit length [-]
      real(dp) :: singular_values(coefficients) = 0.0_dp
      !> Condition number: ratio of the largest to the smallest singular value [-], huge where the latter is
      !> zero
      real(dp) :: condition = 0.0_dp
      !> Number of coefficients that the points determine
      integer :: rank = 0
   end type film_fit_t

   interface
      !> LAPACK: least squares of least norm by the divide-and-conquer singular value decomposition.
      pure subroutine dgelsd(m, n, nrhs, a, lda, b, ldb, s, rcond, rank, work, lwork, iwork, info)
         import :: dp
         implicit none(type, external)
         integer, intent(in) :: m, n, nrhs, lda, ldb, lwork
         real(dp), intent(inout) :: a(lda, *), b(ldb, *)
         real(dp), intent(out) :: s(*)
         real(dp), intent(in) :: rcond
         integer, intent(out) :: rank
         real(dp), intent(inout) :: work(*)
         integer, intent(inout) :: iwork(*)
         integer, intent(out) :: info
      end subroutine dgelsd
   end interface

   !> Range of Reynolds films.
   type :: film_window_t
      !> h* [-], least and largest, and number of values
      real(dp) :: film_ratio(2) = [5.0e-5_dp, 2.0e-4_dp]
      integer :: film_count = 9
      !> w* [-], least and largest, and number of values
      real(dp) :: squeeze_ratio(2) = [-5.0e-4_dp, 5.0e-4_dp]
      integer :: squeeze_count = 9
      !> alpha p_max [-], least and largest within 0 to 1, and number of values
      real(dp) :: pressure(2) = [0.3_dp, 1.0_dp]
      integer :: pressure_count = 16
      !> f: 1 for the pressure as printed in eq (6); 1/2 where u* is formed with u1 + u2 but the pressure with
      !> the mean
      real(dp) :: pressure_factor = 1.0_dp
      !> Wbar over Psi: 1 where Wbar is formed with the speed of the pressure; 1/2 where it is formed with
      !> twice that
      real(dp) :: load_factor = 1.0_dp
   end type film_window_t

contains

   !> Film of a law, h* = c u*^a Wbar^b exp(s w*).
   elemental function law_film_ratio(law, speed_group, load_group, squeeze_ratio) result(film_ratio)
      type(thickness_law_t), intent(in) :: law
      !> u* > 0 [-]
      real(dp), intent(in) :: speed_group
      !> Wbar > 0 [-]
      real(dp), intent(in) :: load_group
      !> w* [-]
      real(dp), intent(in) :: squeeze_ratio
      !> h* [-]
      real(dp) :: film_ratio

      film_ratio = exp(log_film(law, speed_group, load_group, squeeze_ratio))
   end function law_film_ratio

   !> ln h* of a law.
   elemental function log_film(law, speed_group, load_group, squeeze_ratio) result(logarithm)
      type(thickness_law_t), intent(in) :: law
      !> u* > 0 [-]
      real(dp), intent(in) :: speed_group
      !> Wbar > 0 [-]
      real(dp), intent(in) :: load_group
      !> w* [-]
      real(dp), intent(in) :: squeeze_ratio
      real(dp) :: logarithm

      logarithm = log(law%factor) + law%speed_exponent*log(speed_group) &
         + law%load_exponent*log(load_group) + law%squeeze_factor*squeeze_ratio
   end function log_film

   !> Error of a law on given points. All arrays have one size, at least one point, positive u*, Wbar, h*.
   pure function judge_film_law(law, speed_group, load_group, squeeze_ratio, film_ratio) result(error)
      type(thickness_law_t), intent(in) :: law
      !> u* [-]
      real(dp), intent(in) :: speed_group(:)
      !> Wbar [-]
      real(dp), intent(in) :: load_group(:)
      !> w* [-]
      real(dp), intent(in) :: squeeze_ratio(:)
      !> h* [-]
      real(dp), intent(in) :: film_ratio(:)
      type(law_error_t) :: error

      real(dp) :: residual(size(film_ratio)), points, spread

      points = real(size(film_ratio), dp)
      residual = log_film(law, speed_group, load_group, squeeze_ratio) - log(film_ratio)
      error%bias = sum(residual)/points
      error%rms = sqrt(sum(residual**2)/points)
      error%maximum = maxval(abs(residual))
      spread = sum((log(film_ratio) - sum(log(film_ratio))/points)**2)
      if (spread > 0.0_dp) error%r_squared = 1.0_dp - sum(residual**2)/spread
   end function judge_film_law

   !> Least-squares law of given points. The columns of the design matrix are brought to unit length first: w*
   !> is five orders of magnitude smaller than the logarithms, and the condition number would only show that.
   pure subroutine fit_film_law(speed_group, load_group, squeeze_ratio, film_ratio, fit)
      !> u* > 0 [-]
      real(dp), intent(in) :: speed_group(:)
      !> Wbar > 0 [-]
      real(dp), intent(in) :: load_group(:)
      !> w* [-]
      real(dp), intent(in) :: squeeze_ratio(:)
      !> h* > 0 [-]
      real(dp), intent(in) :: film_ratio(:)
      !> Coefficients, errors, rank
      type(film_fit_t), intent(out) :: fit

      !> Singular values below this share of the largest count as zero.
      real(dp), parameter :: negligible = 1.0e-10_dp
      real(dp) :: design(size(film_ratio), coefficients), logarithms(size(film_ratio), 1)
      real(dp) :: length(coefficients), solution(coefficients), work_size(1)
      real(dp), allocatable :: work(:)
      integer :: integer_size(1), points, info, i
      integer, allocatable :: integers(:)

      if (.not. points_are_valid(speed_group, load_group, squeeze_ratio, film_ratio)) return
      points = size(film_ratio)
      design(:, 1) = 1.0_dp
      design(:, 2) = log(speed_group)
      design(:, 3) = log(load_group)
      design(:, 4) = squeeze_ratio
      logarithms(:, 1) = log(film_ratio)
      do i = 1, coefficients
         length(i) = norm2(design(:, i))
         if (length(i) <= 0.0_dp) length(i) = 1.0_dp
         design(:, i) = design(:, i)/length(i)
      end do

      work_size = 0.0_dp
      integer_size = 0
      call dgelsd( &
         points, coefficients, 1, design, points, logarithms, points, fit%singular_values, negligible, &
         fit%rank, &
         work_size, -1, integer_size, info)
      allocate (work(nint(work_size(1))), source=0.0_dp)
      allocate (integers(integer_size(1)), source=0)
      call dgelsd( &
         points, coefficients, 1, design, points, logarithms, points, fit%singular_values, negligible, &
         fit%rank, &
         work, size(work), integers, info)
      fit%status = fit_failed
      if (info /= 0) return

      solution = logarithms(1:coefficients, 1)/length
      fit%law = thickness_law_t(exp(solution(1)), solution(2), solution(3), solution(4))
      fit%error = judge_film_law(fit%law, speed_group, load_group, squeeze_ratio, film_ratio)
      fit%condition = huge(1.0_dp)
      if (fit%singular_values(coefficients) > fit%singular_values(1)/huge(1.0_dp)) &
         fit%condition = fit%singular_values(1)/fit%singular_values(coefficients)
      fit%status = merge(fit_done, fit_rank_deficient, fit%rank == coefficients)
   end subroutine fit_film_law

   !> Arrays of one size, more points than coefficients, all numbers finite, groups positive.
   pure function points_are_valid(speed_group, load_group, squeeze_ratio, film_ratio) result(valid)
      use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
      !> u* [-]
      real(dp), intent(in) :: speed_group(:)
      !> Wbar [-]
      real(dp), intent(in) :: load_group(:)
      !> w* [-]
      real(dp), intent(in) :: squeeze_ratio(:)
      !> h* [-]
      real(dp), intent(in) :: film_ratio(:)
      logical :: valid

      valid = size(film_ratio) > coefficients &
         .and. all([size(speed_group), size(load_group), size(squeeze_ratio)] == size(film_ratio))
      if (valid) valid = all(ieee_is_finite(speed_group)) .and. all(ieee_is_finite(load_group)) &
         .and. all(ieee_is_finite(squeeze_ratio)) .and. all(ieee_is_finite(film_ratio))
      if (valid) valid = min(minval(speed_group), minval(load_group), minval(film_ratio)) > 0.0_dp
   end function points_are_valid

   !> Ranges in order and inside their limits, counts and factors positive.
   pure function window_is_valid(window) result(valid)
      !> Range of films
      type(film_window_t), intent(in) :: window
      logical :: valid

      valid = window%film_ratio(1) > 0.0_dp .and. window%film_ratio(2) >= window%film_ratio(1) &
         .and. window%film_ratio(2) <= huge(1.0_dp) &
         .and. window%squeeze_ratio(2) >= window%squeeze_ratio(1) &
         .and. maxval(abs(window%squeeze_ratio)) <= huge(1.0_dp) &
         .and. window%pressure(1) >= 0.0_dp .and. window%pressure(2) > window%pressure(1) &
         .and. window%pressure(2) <= 1.0_dp &
         .and. min(window%pressure_factor, window%load_factor) > 0.0_dp &
         .and. min(window%film_count, window%squeeze_count, window%pressure_count) > 0
   end function window_is_valid

   !> Samples a window. An invalid window gives arrays of size zero.
   pure subroutine sample_film_window(window, speed_group, load_group, squeeze_ratio, film_ratio)
      !> Range of films
      type(film_window_t), intent(in) :: window
      !> u* [-]
      real(dp), allocatable, intent(out) :: speed_group(:)
      !> Wbar of eq (20) [-]
      real(dp), allocatable, intent(out) :: load_group(:)
      !> w* [-]
      real(dp), allocatable, intent(out) :: squeeze_ratio(:)
      !> h* [-]
      real(dp), allocatable, intent(out) :: film_ratio(:)

      real(dp) :: film, squeeze, pressure, a, b, critical, psi, dpsi_da, dpsi_db
      integer :: points, i, j, k, n

      points = 0
      if (window_is_valid(window)) points = window%film_count*window%squeeze_count*window%pressure_count
      allocate (speed_group(points), load_group(points), squeeze_ratio(points), film_ratio(points))
      if (points == 0) return

      n = 0
      do i = 1, window%film_count
         film = exp(between(log(window%film_ratio), i, window%film_count))
         do j = 1, window%squeeze_count
            squeeze = between(window%squeeze_ratio, j, window%squeeze_count)
            a = squeeze_group(1.0_dp, 1.0_dp, film, squeeze)
            critical = critical_pressure_group(a)
            do k = 1, window%pressure_count
               pressure = window%pressure(1) + (window%pressure(2) - window%pressure(1)) &
                  *(real(k, dp) - 0.5_dp)/real(window%pressure_count, dp)
               b = pressure*critical
               call piezo_viscous_load(a, b, psi, dpsi_da, dpsi_db)
               n = n + 1
               speed_group(n) = b*film*sqrt(film)/(6.0_dp*sqrt(2.0_dp)*window%pressure_factor)
               load_group(n) = window%load_factor*psi
               squeeze_ratio(n) = squeeze
               film_ratio(n) = film
            end do
         end do
      end do
   end subroutine sample_film_window

   !> Value number `index` of `count` equidistant ones from the first limit to the second; the mean for a
   !> single one.
   pure function between(limits, index, count) result(value)
      !> First and last value
      real(dp), intent(in) :: limits(2)
      !> 1 to count
      integer, intent(in) :: index
      !> Number of values
      integer, intent(in) :: count
      real(dp) :: value

      value = 0.5_dp*(limits(1) + limits(2))
      if (count > 1) value = limits(1) + (limits(2) - limits(1))*real(index - 1, dp)/real(count - 1, dp)
   end function between

end module film_fit
