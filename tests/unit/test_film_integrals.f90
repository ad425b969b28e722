!> Tests of the integrals J and K against quadrature in arbitrary precision.
module test_film_integrals
   use checks, only: check_list_t
   use constants, only: pi
   use kinds, only: dp
   use rupture, only: pressure_integrals
   use rupture_reference, only: integral_table
   implicit none(type, external)
   private

   !> A dozen roundings, none of them enlarged by cancellation: J and K are good relative to themselves.
   real(dp), parameter :: rounding = 16.0_dp*epsilon(1.0_dp)

   public :: run_film_integrals_tests

contains

   !> Runs every test of this topic.
   subroutine run_film_integrals_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('film_integrals')
      call test_reference(checks)
      call test_switch(checks)
      call test_ends(checks)
   end subroutine run_film_integrals_tests

   !> The table, relative to the integrals themselves.
   subroutine test_reference(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: j, k
      character(12) :: place
      integer :: i

      do i = 1, size(integral_table, 2)
         call pressure_integrals(integral_table(1, i), j, k)
         write (place, '(es12.4)') integral_table(1, i)
         call checks%check_close(j/integral_table(2, i), 1.0_dp, rounding, 'J at t ='//place)
         call checks%check_close(k/integral_table(3, i), 1.0_dp, rounding, 'K at t ='//place)
      end do
   end subroutine test_reference

   !> Series and closed form meet: across the switch J and K rise by their slopes only.
   subroutine test_switch(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: switch = -0.97_dp
      real(dp) :: below, above, j_below, j_above, k_below, k_above, cos_squared

      below = nearest(switch, -1.0_dp)
      above = nearest(switch, 1.0_dp)
      call pressure_integrals(below, j_below, k_below)
      call pressure_integrals(above, j_above, k_above)
      cos_squared = 1.0_dp/(1.0_dp + switch*switch)
      call checks%check_close(j_above - j_below, switch**2*cos_squared**3*(above - below), rounding*j_above, &
         'J is continuous where the series begins')
      call checks%check_close(k_above - k_below, cos_squared**3*(above - below), rounding*k_above, &
         'K is continuous where the series begins')
   end subroutine test_switch

   !> Whole integrals pi/8 and 3 pi/8; both vanish at the other end.
   subroutine test_ends(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp) :: j, k

      call pressure_integrals(1.0e30_dp, j, k)
      call checks%check_close(j, pi/8.0_dp, rounding, 'whole J')
      call checks%check_close(k, 3.0_dp*pi/8.0_dp, rounding, 'whole K')
      call pressure_integrals(-1.0e30_dp, j, k)
      call checks%check_close(j/1.0e-90_dp, 1.0_dp/3.0_dp, rounding, 'J ~ d^3/3')
      call checks%check_close(k/1.0e-150_dp, 0.2_dp, rounding, 'K ~ d^5/5')
   end subroutine test_ends

end module test_film_integrals
