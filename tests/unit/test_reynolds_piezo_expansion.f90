!> Tests of the load of the Reynolds piezo-viscous film as polynomials of A and sigma, against the film kernel, whose table is one
!> for all films.
module test_reynolds_piezo_expansion
   use checks, only: check_list_t
   use kinds, only: dp
   use lane_functions, only: lanes
   use reynolds_iso_viscous, only: iso_viscous_load
   use reynolds_piezo_expansion, only: expand_reynolds_piezo, first_term, highest_group_power, highest_sigma_power, &
      reynolds_piezo_expansion_t
   use reynolds_piezo_viscous, only: critical_pressure_group, piezo_viscous_load
   implicit none(type, external)
   private

   !> The generator measures 6e-12 of the load, or of a fifth of that of a film at rest, whichever is larger.
   real(dp), parameter :: cell_error = 1.0e-11_dp, least_load = 0.05_dp
   !> Where the cells end.
   real(dp), parameter :: last_group = 14.0_dp

   public :: run_reynolds_piezo_expansion_tests

contains

   !> Runs every test of this topic.
   subroutine run_reynolds_piezo_expansion_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('reynolds_piezo_expansion')
      call test_values(checks)
      call test_neighbours(checks)
      call test_borders(checks)
   end subroutine run_reynolds_piezo_expansion_tests

   !> Expand about 16 pairs of A and B at once.
   subroutine expand_about(a, b, expansion)
      real(dp), intent(in) :: a(lanes)                              !> A [-]
      real(dp), intent(in) :: b(lanes)                              !> B [-]
      type(reynolds_piezo_expansion_t), intent(out) :: expansion    !> The expansions
      real(dp) :: one(lanes)

      one = 1.0_dp
      call expand_reynolds_piezo(one, a, one, b, expansion)
   end subroutine expand_about

   !> Pairs of A, of both signs, and B/B_crit, that fill the cells; irrational strides leave no part of them out.
   pure subroutine choose(number, a, share)
      integer, intent(in) :: number        !> Of the pair
      real(dp), intent(out) :: a           !> A [-]
      real(dp), intent(out) :: share       !> B/B_crit [-]
      real(dp), parameter :: stride_a = 0.6180339887498949_dp, stride_b = 0.7548776662466927_dp

      a = sign(2.0_dp*8.0_dp**modulo(number*stride_a, 1.0_dp) - 2.0_dp, modulo(number, 2) - 0.5_dp)
      a = max(-last_group + 1.0e-6_dp, min(last_group - 1.0e-6_dp, a))
      share = 0.9999_dp*modulo(number*stride_b, 1.0_dp)
   end subroutine choose

   !> Load and slope everywhere in the cells; a slope is off by what the highest powers are worth at the border of a cell.
   subroutine test_values(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(reynolds_piezo_expansion_t) :: expansion
      real(dp) :: a(lanes), b(lanes), share(lanes), load, by_a, by_b, least
      integer :: block, l

      do block = 0, 249
         do l = 1, lanes
            call choose(block*lanes + l, a(l), share(l))
            b(l) = share(l)*critical_pressure_group(a(l))
         end do
         call expand_about(a, b, expansion)
         do l = 1, lanes
            call piezo_viscous_load(a(l), b(l), load, by_a, by_b)
            least = max(load, least_load)
            call checks%check(expansion%inside(l) > 0.0_dp, 'inside')
            call checks%check_close(expansion%terms(l, 0), load, cell_error*least, 'load')
            call checks%check_close(expansion%load_slope(l), by_a, 1.0e-9_dp*(least/(1.0_dp + abs(a(l))) &
               + abs(by_a))/sqrt(1.0_dp - share(l)), 'slope of the load')
         end do
      end do
   end subroutine test_values

   !> The terms lead to the load at other A and sigma, a twentieth of the distance to the singularities at +-2i and 0.03 away: the
   !> powers left out, A**2 sigma**5 and A**4 sigma**3 the lowest, are worth 1e-10.
   subroutine test_neighbours(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(reynolds_piezo_expansion_t) :: expansion
      real(dp) :: a(lanes), b(lanes), share(lanes), step_a, sigma, sum, inner, load, by_a, by_b
      integer :: block, l, i, j, side

      do block = 0, 49
         do l = 1, lanes
            call choose(block*lanes + l, a(l), share(l))
            b(l) = share(l)*critical_pressure_group(a(l))
         end do
         call expand_about(a, b, expansion)
         do l = 1, lanes
            do side = -1, 1, 2
               step_a = side*0.05_dp*sqrt(4.0_dp + a(l)**2)
               sigma = sqrt(1.0_dp - share(l)) - 0.03_dp
               if (sigma < 0.01_dp) sigma = sigma + 0.06_dp
               sum = 0.0_dp
               do j = highest_sigma_power, 0, -1
                  inner = 0.0_dp
                  do i = highest_group_power(j), 0, -1
                     inner = inner*step_a*expansion%inverse_unit(l) + expansion%terms(l, first_term(j) + i)
                  end do
                  sum = sum*(sigma - expansion%sigma(l)) + inner
               end do
               call piezo_viscous_load(a(l) + step_a, (1.0_dp - sigma**2)*critical_pressure_group(a(l) + step_a), load, by_a, by_b)
               call checks%check_close(sum, load, 1.0e-9_dp*max(load, least_load), 'load in the neighbourhood')
            end do
         end do
      end do
   end subroutine test_neighbours

   !> Beyond the cells, and without a rigid film, there is no expansion; without any effect of pressure it is that of the
   !> iso-viscous film.
   subroutine test_borders(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(reynolds_piezo_expansion_t) :: expansion
      real(dp) :: a(lanes), b(lanes), load, slope
      real(dp), parameter :: near = 1.0e-6_dp
      integer :: l

      a = 0.0_dp
      b = 0.5_dp
      a(:6) = last_group*[1.0_dp - near, -1.0_dp + near, 1.0_dp + near, -1.0_dp - near, 1.0e9_dp, -1.0e9_dp]
      a(7:12) = [-3.0_dp, -3.0_dp, 0.0_dp, 0.0_dp, 5.0_dp, 5.0_dp]
      do l = 7, 12
         b(l) = critical_pressure_group(a(l))*(1.0_dp + near*sign(1.0_dp, modulo(l, 2) - 0.5_dp))
      end do
      b(:6) = 0.01_dp
      b(13:) = 0.0_dp
      a(13:) = [-8.0_dp, -0.1_dp, 0.0_dp, 3.0_dp]
      call expand_about(a, b, expansion)
      call checks%check(all(expansion%inside(:2) > 0.0_dp), 'inside the border')
      call checks%check(all(expansion%inside(3:6) <= 0.0_dp), 'beyond the border')
      call checks%check(all(expansion%inside(7:12:2) <= 0.0_dp), 'no rigid film')
      call checks%check(all(expansion%inside(8:12:2) > 0.0_dp), 'the last rigid film')
      do l = 13, lanes
         call iso_viscous_load(a(l), load, slope)
         call checks%check_close(expansion%terms(l, 0), load, cell_error*max(load, least_load), 'no effect of pressure')
      end do
   end subroutine test_borders

end module test_reynolds_piezo_expansion
