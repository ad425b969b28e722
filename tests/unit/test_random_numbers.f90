!> Tests of the random numbers: known answers of Philox, range, evenness.
module test_random_numbers
   use checks, only: check_list_t
   use kinds, only: dp, int64
   use random_numbers, only: philox_words, random_bit_count, random_bits
   implicit none(type, external)
   private

   public :: run_random_numbers_tests

contains

   !> Runs every test of this topic.
   subroutine run_random_numbers_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks

      call checks%start('random_numbers')
      call test_known_answers(checks)
      call test_uniform(checks)
   end subroutine run_random_numbers_tests

   !> The known answers that come with the published generator.
   subroutine test_known_answers(checks)
      type(check_list_t), intent(inout) :: checks
      integer(int64), parameter :: ones = int(z'FFFFFFFF', int64)

      call checks%check(all(philox_words([0_int64, 0_int64, 0_int64, 0_int64], [0_int64, 0_int64]) == &
                            [int(z'6627E8D5', int64), int(z'E169C58D', int64), int(z'BC57AC4C', int64), &
                             int(z'9B00DBD8', int64)]), 'zeros')
      call checks%check(all(philox_words([ones, ones, ones, ones], [ones, ones]) == &
                            [int(z'408F276D', int64), int(z'41C83B0E', int64), int(z'A20BC7C6', int64), &
                             int(z'6D5451FD', int64)]), 'ones')
      call checks%check(all(philox_words([int(z'243F6A88', int64), int(z'85A308D3', int64), int(z'13198A2E', &
                                                            int64), &
                                          int(z'03707344', int64)], [int(z'A4093822', int64), &
                                                            int(z'299F31D0', int64)]) == &
                            [int(z'D16CFE09', int64), int(z'94FDCCEB', int64), int(z'5001E420', int64), &
                             int(z'24126EA1', int64)]), 'digits of pi')
   end subroutine test_known_answers

   !> Between 0 and 1; mean, variance and neighbours as they should be.
   subroutine test_uniform(checks)
      type(check_list_t), intent(inout) :: checks
      integer, parameter :: count = 40000
      real(dp) :: numbers(count)
      real(dp), parameter :: deviation = 1.0_dp/sqrt(12.0_dp*count)
      integer :: i

      do i = 1, count
         numbers(i) = scale(real(random_bits(20080618_int64, 0_int64, int(i, int64)), dp) + 0.5_dp, -random_bit_count)
      end do
      call checks%check(minval(numbers) > 0.0_dp .and. maxval(numbers) < 1.0_dp, 'between 0 and 1')
      call checks%check_close(sum(numbers)/count, 0.5_dp, 4.0_dp*deviation, 'mean')
      call checks%check_close(sum((numbers - 0.5_dp)**2)/count, 1.0_dp/12.0_dp, 4.0_dp*deviation, 'variance')
      call checks%check_close(sum((numbers(2:) - 0.5_dp)*(numbers(:count - 1) - 0.5_dp))/count, 0.0_dp, &
                              deviation, 'neighbours')
      call checks%check(random_bits(1_int64, 0_int64, 7_int64) /= random_bits(2_int64, 0_int64, 7_int64), &
                        'seeds differ')
      call checks%check(random_bits(1_int64, 0_int64, 7_int64) /= random_bits(1_int64, 1_int64, 7_int64), &
                        'streams differ')
      call checks%check(random_bits(-1_int64, -1_int64, -1_int64) >= 0_int64, 'negative arguments')
      call checks%check(random_bits(shiftl(1_int64, 32), 0_int64, 0_int64) /= random_bits(0_int64, 0_int64, &
                                                            0_int64), &
                        'upper half of the seed counts')
   end subroutine test_uniform

end module test_random_numbers
