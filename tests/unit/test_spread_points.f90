!> Tests of Sobol points: known points, and one point in each stratum.
module test_spread_points
   use checks, only: check_list_t
   use kinds, only: dp, int64
   use sobol_sequence, only: largest_sobol_size, new_sobol_sequence, sobol_point, sobol_sequence_t
   use text, only: integer_text
   implicit none(type, external)
   private

   public :: run_spread_points_tests

contains

   !> Runs every test of this topic.
   subroutine run_spread_points_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks

      call checks%start('sobol_sequence')
      call test_sobol_points(checks)
      call test_sobol_evenness(checks)
   end subroutine run_spread_points_tests

   !> The first points of eight dimensions and point 1000 of 32, from an independent program.
   subroutine test_sobol_points(checks)
      type(check_list_t), intent(inout) :: checks
      integer, parameter :: sixteenths(8, 9) = reshape([ &
                                                       0, 0, 0, 0, 0, 0, 0, 0, &
                                                       8, 8, 8, 8, 8, 8, 8, 8, &
                                                       12, 4, 4, 4, 12, 12, 4, 12, &
                                                       4, 12, 12, 12, 4, 4, 12, 4, &
                                                       6, 6, 10, 14, 6, 2, 6, 14, &
                                                       14, 14, 2, 6, 14, 10, 14, 6, &
                                                       10, 2, 14, 10, 10, 14, 2, 2, &
                                                       2, 10, 6, 2, 2, 6, 10, 10, &
                                                       3, 5, 15, 7, 9, 5, 7, 15], [8, 9])
      integer, parameter :: point_1000(32) = [225, 99, 531, 693, 287, 929, 47, 921, 513, 71, 87, 261, 165, &
                                              393, 147, 379, &
                                              737, 353, 1015, 743, 535, 563, 973, 553, 597, 929, 41, 1003, &
                                                 61, 349, 151, 149]
      type(sobol_sequence_t) :: sequence
      real(dp) :: point(32)
      integer :: i

      sequence = new_sobol_sequence(8, 0_int64)
      do i = 1, 9
         call sobol_point(sequence, int(i - 1, int64), point(:8))
         call checks%check(all(abs(16.0_dp*point(:8) - real(sixteenths(:, i), dp)) <= 0.0_dp), 'point '// &
                           integer_text(i - 1))
      end do
      sequence = new_sobol_sequence(32, 0_int64)
      call sobol_point(sequence, 1000_int64, point)
      call checks%check(all(abs(1024.0_dp*point - real(point_1000, dp)) <= 0.0_dp), 'point 1000')
      call sobol_point(sequence, largest_sobol_size - 1_int64, point)
      call checks%check(all(point >= 0.0_dp .and. point < 1.0_dp), 'the last point')
   end subroutine test_sobol_points

   !> The first 1024 points have one in each of 1024 strata of every dimension, and the first two dimensions
   !> one in each of 32 x 32 squares; a shift by a seed keeps both.
   subroutine test_sobol_evenness(checks)
      type(check_list_t), intent(inout) :: checks
      type(sobol_sequence_t) :: sequence
      real(dp) :: point(32), other(32)
      logical :: strata(0:1023, 32), squares(0:31, 0:31)
      integer(int64) :: index
      integer :: seed, i

      do seed = 0, 2
         sequence = new_sobol_sequence(32, int(seed, int64))
         strata = .false.
         squares = .false.
         do index = 0_int64, 1023_int64
            call sobol_point(sequence, index, point)
            do i = 1, 32
               strata(int(1024.0_dp*point(i)), i) = .true.
            end do
            squares(int(32.0_dp*point(1)), int(32.0_dp*point(2))) = .true.
         end do
         call checks%check(all(strata), 'one point in each stratum, seed '//integer_text(seed))
         call checks%check(all(squares), 'one point in each square, seed '//integer_text(seed))
      end do
      call sobol_point(new_sobol_sequence(32, 1_int64), 0_int64, other)
      call checks%check(all(abs(other) > 0.0_dp), 'shifted away from the origin')
   end subroutine test_sobol_evenness

end module test_spread_points
