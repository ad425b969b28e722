!> Tests of the load of films with rupture as polynomials of the squeeze group: against the film tables, which were made from
!> other points, and the published load put together by hand.
module test_load_expansion
   use, intrinsic :: ieee_arithmetic, only: ieee_get_halting_mode, ieee_invalid, ieee_is_nan, ieee_quiet_nan, &
      ieee_set_halting_mode, ieee_support_halting, ieee_value
   use checks, only: check_list_t
   use kinds, only: dp
   use lane_functions, only: lanes
   use load_expansion, only: expand_load, highest_power, load_expansion_t
   use load_pieces, only: exact_load, published_load
   use reynolds_iso_viscous, only: iso_viscous_load, rupture_tangent_fast
   implicit none(type, external)
   private

   !> The last piece begins at |A| = 2**25 - 2.
   real(dp), parameter :: last_piece_start = 2.0_dp**25 - 2.0_dp
   !> Squeeze term of (24) over its rolling term and A (x_e + pi/2), A the squeeze group [-].
   real(dp), parameter :: squeeze_share = 3.0_dp/(4.0_dp*2.8_dp)

   public :: run_load_expansion_tests

contains

   !> Runs every test of this topic.
   subroutine run_load_expansion_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('load_expansion')
      call test_values(checks)
      call test_neighbours(checks)
      call test_no_number(checks)
   end subroutine run_load_expansion_tests

   !> Load and slope by other means.
   subroutine load_by_table(law, a, load, slope)
      integer, intent(in) :: law          !> Which load
      real(dp), intent(in) :: a           !> A [-]
      real(dp), intent(out) :: load       !> Phi [-]
      real(dp), intent(out) :: slope      !> dPhi/dA [-]
      real(dp) :: tangent

      call iso_viscous_load(a, load, slope)
      if (law == exact_load) return
      tangent = rupture_tangent_fast(a)
      ! x_e + pi/2 without cancellation where x_e is next to -pi/2
      load = 1.0_dp - squeeze_share*a*atan2(1.0_dp, -tangent)
   end subroutine load_by_table

   !> Expand about 16 values of A at once.
   subroutine expand_about(law, a, expansion)
      integer, intent(in) :: law                               !> Which load
      real(dp), intent(in) :: a(lanes)                         !> A [-]
      type(load_expansion_t), intent(out) :: expansion         !> The expansions
      real(dp) :: one(lanes)

      one = 1.0_dp
      call expand_load(law, one, a, one, expansion)
   end subroutine expand_about

   !> Values at both signs of A, over all powers of ten. Each piece is good to some epsilon of its largest value, which is at
   !> most twice its smallest one; the published load is a difference of numbers of order one. What is left out of a piece is
   !> worth 17**(-13) of the load; the film tables promise slopes to 1e-12.
   subroutine test_values(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(load_expansion_t) :: expansion
      real(dp) :: a(lanes), load, slope, tolerance
      integer :: law, block, l

      do law = exact_load, published_load
         do block = -40, 60
            do l = 1, lanes
               a(l) = sign(10.0_dp**(0.2_dp*real(block, dp) + 0.0125_dp*real(l, dp)), real(mod(l, 2), dp) - 0.5_dp)
            end do
            if (block == -40) a(:4) = [0.0_dp, -0.0_dp, tiny(1.0_dp), -tiny(1.0_dp)]
            call expand_about(law, a, expansion)
            do l = 1, lanes
               call load_by_table(law, a(l), load, slope)
               tolerance = 64.0_dp*epsilon(1.0_dp)*abs(load)
               ! On separation, beyond the pieces, the load has reached its limit: 0 for the Reynolds film.
               if (a(l) > last_piece_start) tolerance = 8.0_dp*epsilon(1.0_dp)
               if (law == published_load) tolerance = max(tolerance, 64.0_dp*epsilon(1.0_dp))
               call checks%check_close(expansion%terms(l, 0), load, tolerance, 'load')
               if (law == exact_load) call checks%check_close(expansion%load_slope(l), slope, &
                  2.0e-12_dp*merge(1.0_dp, abs(slope), a(l) > last_piece_start), 'slope of the load')
            end do
         end do
      end do
   end subroutine test_values

   !> The terms lead to the load at other A. A twentieth of the distance to the singularities at +-2i is half of half a piece:
   !> up to 1.5 half pieces from its centre the 13th Chebyshev polynomial grows to 1.4e5, and what is left out in the piece, 2 * 14
   !> * 17**(-13) of a load that falls with A**(-2), with it to 4e-10.
   subroutine test_neighbours(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(load_expansion_t) :: expansion
      real(dp) :: a(lanes), deviation, sum, load, slope, there, tolerance
      integer :: law, side, block, l, i

      do law = exact_load, published_load
         do block = -4, 20
            do l = 1, lanes
               a(l) = sign(10.0_dp**(0.25_dp*real(block, dp) + 0.0156_dp*real(l, dp)), real(mod(l, 2), dp) - 0.5_dp)
            end do
            call expand_about(law, a, expansion)
            do l = 1, lanes
               do side = -1, 1, 2
                  there = a(l) + real(side, dp)*0.05_dp*sqrt(4.0_dp + a(l)**2)
                  deviation = (there - a(l))*expansion%inverse_unit(l)
                  sum = 0.0_dp
                  do i = highest_power, 0, -1
                     sum = sum*deviation + expansion%terms(l, i)
                  end do
                  call load_by_table(law, there, load, slope)
                  tolerance = 1.0e-9_dp*max(abs(load), merge(0.0_dp, 1.0_dp, law == exact_load))
                  call checks%check_close(sum, load, tolerance, 'load in the neighbourhood')
               end do
            end do
         end do
      end do
   end subroutine test_neighbours

   !> What is no number has no load, and no other lane takes notice. The halting of debug builds is lifted meanwhile.
   subroutine test_no_number(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(load_expansion_t) :: expansion, calm
      real(dp) :: a(lanes)
      logical :: halting

      a = 1.0_dp
      call expand_about(exact_load, a, calm)
      halting = .false.
      if (ieee_support_halting(ieee_invalid)) then
         call ieee_get_halting_mode(ieee_invalid, halting)
         call ieee_set_halting_mode(ieee_invalid, .false.)
      end if
      a(3) = ieee_value(1.0_dp, ieee_quiet_nan)
      call expand_about(exact_load, a, expansion)
      if (halting) call ieee_set_halting_mode(ieee_invalid, .true.)
      call checks%check(ieee_is_nan(expansion%terms(3, 0)), 'no number: no load')
      call checks%check(all(abs(expansion%terms(4:, :) - calm%terms(4:, :)) <= 0.0_dp), 'no number: its neighbours')
   end subroutine test_no_number

end module test_load_expansion
