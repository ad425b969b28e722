!> Points of the exact piezo-viscous film over a window of alpha p, for fitting or judging eq (32).
!>
!> The load Psi depends on A = 4 w*/sqrt(2 h*) and B = f 6 sqrt(2) u*/h*^(3/2) alone, and alpha p_max =
!> B/B_crit(A) with the p of eq (31). So a window is sampled in h* (evenly in the logarithm), w* and alpha p
!> (centres of equal parts, its ends are singular), and u* follows without iteration: u* = alpha p B_crit(A)
!> h*^(3/2)/(6 sqrt(2) f).
module film_fit_window
   use kinds, only: dp
   use reynolds_piezo_viscous, only: critical_pressure_group, piezo_viscous_load
   use rupture, only: squeeze_group
   implicit none(type, external)
   private

   public :: film_window_t, window_is_valid, sample_film_window

   !> Range of exact films.
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

   !> Ranges in order and inside their limits, counts and factors positive.
   pure function window_is_valid(window) result(valid)
      type(film_window_t), intent(in) :: window  !> Range of films
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
      type(film_window_t), intent(in) :: window                !> Range of films
      real(dp), allocatable, intent(out) :: speed_group(:)     !> u* [-]
      real(dp), allocatable, intent(out) :: load_group(:)      !> Wbar of eq (20) [-]
      real(dp), allocatable, intent(out) :: squeeze_ratio(:)   !> w* [-]
      real(dp), allocatable, intent(out) :: film_ratio(:)      !> h* [-]

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
      real(dp), intent(in) :: limits(2)  !> First and last value
      integer, intent(in) :: index       !> 1 to count
      integer, intent(in) :: count       !> Number of values
      real(dp) :: value

      value = 0.5_dp*(limits(1) + limits(2))
      if (count > 1) value = limits(1) + (limits(2) - limits(1))*real(index - 1, dp)/real(count - 1, dp)
   end function between

end module film_fit_window
